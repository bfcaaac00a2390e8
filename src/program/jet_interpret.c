// The interpreter of tapes in doubles: the coefficients of each operation, in two phases.  For
// order k >= 1 and normalised coefficients, [JorbaZou2005, sec. 2], [Neidinger2010]:
//
//   c = a b        c_k = S + a_0 b_k + a_k b_0,                S = sum_{1..k-1} a_j b_{k-j}
//   c = a / b      c_k = (a_k - b_k c_0 - S) / b_0,            S = sum_{1..k-1} b_j c_{k-j}
//   c = sqrt a     c_k = (a_k - S) / (2 c_0),                  S = sum_{1..k-1} c_j c_{k-j}
//   c = a^r        c_k = (S + r a_k c_0) / a_0
//                  S = sum_{1..k-1} (r j - (k-j)) a_j c_{k-j} / k
//   c = atan2(a,b) c_k = (S + a_k b_0 - b_k a_0) / w_0, w = a^2 + b^2
//                  S = sum_{1..k-1} j (a_j b_{k-j} - b_j a_{k-j} - c_j w_{k-j}) / k
//
// and the elementary functions of one argument by recurrences.def.
//
// The first phase puts S where c_k will stand; the second completes it. At k = 0 S is not used.
// Lanes are the inner loop everywhere, in blocks of eight, so that a sum stays in a register; sums
// run upwards in j. This file is compiled for several kinds of processors (meson.build), with the
// same bits.
// See theory (10.1), (10.2).
#include "program/jet.h"

#include <math.h>

#ifndef PL_INTERPRET
#  define PL_INTERPRET pl_jet_interpret_plain
#endif
pl_kernel PL_INTERPRET;

// Lanes of different nodes never overlap.
#ifdef __clang__
#  define APART _Pragma("clang loop vectorize(assume_safety)")
#else
#  define APART _Pragma("GCC ivdep")
#endif
#define BLOCKS for (int first = 0; first < lanes; first += block)
#define BLOCK  APART for (int l = first; l < first + block; l++)
#define LANES  BLOCKS BLOCK
#define INLINE static inline __attribute__((always_inline))

// ------------------------------------------------------------------------------------- first phase
// The sum of a block of lanes.
#define SUM(what)        \
  BLOCKS {               \
    double sum[8] = {0}; \
    what                 \
  }
#define IN_BLOCK(i) sum[(i)-first]

// s = sum_{j=1..k-1} a_j b_{k-j}
INLINE void product_sum(double* restrict s, const double* a, const double* b, int k, int lanes,
                        int block) {
  SUM(for (int j = 1; j < k; j++) BLOCK IN_BLOCK(l) += a[j * lanes + l] * b[(k - j) * lanes + l];
      BLOCK s[l] = IN_BLOCK(l);)
}

// the same for a = b: pairs are added once and doubled
INLINE void square_sum(double* restrict s, const double* a, int k, int lanes, int block) {
  SUM(for (int j = 1; 2 * j < k; j++)
          BLOCK IN_BLOCK(l) += a[j * lanes + l] * a[(k - j) * lanes + l];
      BLOCK IN_BLOCK(l) += IN_BLOCK(l);
      if (k % 2 == 0) BLOCK IN_BLOCK(l) += a[k / 2 * lanes + l] * a[k / 2 * lanes + l];
      BLOCK s[l] = IN_BLOCK(l);)
}

// s = sum_{j=1..k-1} j a_j b_{k-j} / k
INLINE void derivative_sum(double* restrict s, const double* a, const double* b, int k, int lanes,
                           int block) {
  SUM(for (int j = 1; j < k; j++)
          BLOCK IN_BLOCK(l) += (double)j * a[j * lanes + l] * b[(k - j) * lanes + l];
      BLOCK s[l] = IN_BLOCK(l) / (double)k;)
}

INLINE void power_sum(double* restrict s, const double* a, const double* c, const double* r, int k,
                      int lanes, int block) {
  SUM(for (int j = 1; j < k; j++) BLOCK IN_BLOCK(l) += (r[l] * (double)j - (double)(k - j))
                                                       * a[j * lanes + l] * c[(k - j) * lanes + l];
      BLOCK s[l] = IN_BLOCK(l) / (double)k;)
}

INLINE void angle_sum(double* restrict s, const double* a, const double* b, const double* c,
                      const double* w, int k, int lanes, int block) {
  SUM(for (int j = 1; j < k; j++) BLOCK IN_BLOCK(l) +=
      (double)j
      * (a[j * lanes + l] * b[(k - j) * lanes + l] - b[j * lanes + l] * a[(k - j) * lanes + l]
         - c[j * lanes + l] * w[(k - j) * lanes + l]);
      BLOCK s[l] = IN_BLOCK(l) / (double)k;)
}

INLINE void known_part(pl_jet* jet, int i, int k, int lanes, int block) {
  const pl_tape_node* node = &jet->tape->nodes[i];
  double* c = pl_jet_at(jet, i, 0);
  const double* a = pl_jet_at(jet, node->a, 0);
  const double* b = node->b >= 0 ? pl_jet_at(jet, node->b, 0) : a;
  const double* w = node->c >= 0 ? pl_jet_at(jet, node->c, 0) : a;
  double* s = c + k * lanes;
  switch (node->op) {
    case PL_OP_MUL: product_sum(s, a, b, k, lanes, block); break;
    case PL_OP_SQR: square_sum(s, a, k, lanes, block); break;
    case PL_OP_DIV: product_sum(s, b, c, k, lanes, block); break;
    case PL_OP_SQRT: square_sum(s, c, k, lanes, block); break;
    case PL_OP_POW: power_sum(s, a, c, b, k, lanes, block); break;
    case PL_OP_ATAN2: angle_sum(s, a, b, c, w, k, lanes, block); break;
    default: {
      const double* x = pl_jet_at(jet, pl_op_weighted(node, i), 0);
      w = pl_jet_at(jet, pl_op_partner(node, i), 0);
      derivative_sum(s, x, w, k, lanes, block);
    }
  }
}

// ------------------------------------------------------------------------------------ second phase
// Order 0: the functions themselves.
INLINE void value(pl_jet* jet, int i, int lanes, int block) {
  const pl_tape_node* node = &jet->tape->nodes[i];
  double* c = pl_jet_at(jet, i, 0);
  const double* a = node->a >= 0 ? pl_jet_at(jet, node->a, 0) : c;
  const double* b = node->b >= 0 ? pl_jet_at(jet, node->b, 0) : a;
  switch (node->op) {
    case PL_OP_ADD: LANES c[l] = a[l] + b[l]; break;
    case PL_OP_SUB: LANES c[l] = a[l] - b[l]; break;
    case PL_OP_NEG: LANES c[l] = -a[l]; break;
    case PL_OP_SCALE:
    case PL_OP_MUL: LANES c[l] = a[l] * b[l]; break;
    case PL_OP_RSCALE:
    case PL_OP_DIV: LANES c[l] = a[l] / b[l]; break;
    case PL_OP_ABS: LANES c[l] = fabs(a[l]); break;
    case PL_OP_SIGN: LANES c[l] = a[l] > 0 ? 1 : a[l] < 0 ? -1 : a[l]; break;  // zero and NaN stay
    case PL_OP_MIN: LANES c[l] = a[l] <= b[l] ? a[l] : b[l]; break;
    case PL_OP_MAX: LANES c[l] = a[l] >= b[l] ? a[l] : b[l]; break;
    case PL_OP_IF: {
      const double* other = pl_jet_at(jet, node->c, 0);
      LANES c[l] = a[l] > 0 ? b[l] : other[l];
      break;
    }
    case PL_OP_SQR: LANES c[l] = a[l] * a[l]; break;
    case PL_OP_SQRT: LANES c[l] = sqrt(a[l]); break;
    case PL_OP_POW: LANES c[l] = pow(a[l], b[l]); break;
#define CALL_1(function) function(a[l])
#define CALL_2(function) function(a[l], b[l])
#define PL_FUNCTION(name, text, n, tex, form, value, derivative, library, ...) \
  case PL_OP_##name:                                                           \
    LANES c[l] = CALL_##n(library);                                            \
    break;
#define PL_PIECEWISE(...)
#include "expr/functions.def"
    default: break;  // inputs are there
  }
}

// Order k >= 1 of an elementary function; c holds S.
INLINE void function_coefficient(pl_recurrence_kind kind, double* c, const double* a,
                                 const double* w, int lanes, int block) {
#define S           c[l]
#define A           a[l]
#define W           w[l]
#define ONE         1
#define NEG(x)      (-(x))
#define ADD(x, y)   ((x) + (y))
#define SUB(x, y)   ((x) - (y))
#define MUL(x, y)   ((x) * (y))
#define MA(x, y, s) ((s) + (x) * (y))
#define OVER_W(x)   ((x) / W)
  switch (kind) {
// clang-format off
#define PL_RECURRENCE(name, x, coefficient, equation) \
  case PL_RECURRENCE_##name: LANES c[l] = coefficient; break;
#include "program/recurrences.def"
      // clang-format on
    default: break;
  }
}

// Order k >= 1; c holds S for series operations.
INLINE void coefficient(pl_jet* jet, int i, int k, int lanes, int block) {
  const pl_tape_node* node = &jet->tape->nodes[i];
  double* c0 = pl_jet_at(jet, i, 0);
  double* c = c0 + k * lanes;
  const double* a0 = node->a >= 0 ? pl_jet_at(jet, node->a, 0) : c0;
  const double* b0 = node->b >= 0 ? pl_jet_at(jet, node->b, 0) : a0;
  const double* w0 = node->c >= 0 ? pl_jet_at(jet, node->c, 0) : a0;
  // constants have order 0 only
  static const double zero[PL_JET_LANES] = {0};
  int n_const = jet->tape->level_end[PL_LEVEL_CONST];
  const double* a = node->a >= n_const ? a0 + k * lanes : zero;
  const double* b = node->b >= n_const ? b0 + k * lanes : zero;
  const double* w = node->c >= n_const ? w0 + k * lanes : zero;
  switch (node->op) {
    case PL_OP_ADD: LANES c[l] = a[l] + b[l]; break;
    case PL_OP_SUB: LANES c[l] = a[l] - b[l]; break;
    case PL_OP_NEG: LANES c[l] = -a[l]; break;
    case PL_OP_SCALE: LANES c[l] = a[l] * b0[l]; break;
    case PL_OP_RSCALE: LANES c[l] = a[l] / b0[l]; break;
    case PL_OP_ABS: LANES c[l] = a0[l] < 0 ? -a[l] : a[l]; break;
    case PL_OP_SIGN: LANES c[l] = 0; break;
    case PL_OP_MIN: LANES c[l] = a0[l] <= b0[l] ? a[l] : b[l]; break;
    case PL_OP_MAX: LANES c[l] = a0[l] >= b0[l] ? a[l] : b[l]; break;
    case PL_OP_IF: LANES c[l] = a0[l] > 0 ? b[l] : w[l]; break;
    case PL_OP_MUL: LANES c[l] += a0[l] * b[l] + a[l] * b0[l]; break;
    case PL_OP_SQR: LANES c[l] += 2 * a0[l] * a[l]; break;
    case PL_OP_DIV: LANES c[l] = (a[l] - b[l] * c0[l] - c[l]) / b0[l]; break;
    // a power of zero has no series: it goes on as if it stayed zero, and what that is off by
    // shortens the step
    case PL_OP_SQRT: LANES c[l] = c0[l] != 0 ? (a[l] - c[l]) / (2 * c0[l]) : 0; break;
    case PL_OP_POW: LANES c[l] = a0[l] != 0 ? (c[l] + b0[l] * a[l] * c0[l]) / a0[l] : 0; break;
    case PL_OP_ATAN2: LANES c[l] = (c[l] + a[l] * b0[l] - b[l] * a0[l]) / w0[l]; break;
    default:
      if (!pl_op_recurrence[node->op]) break;  // inputs are there
      w0 = pl_jet_at(jet, pl_op_partner(node, i), 0);
      function_coefficient((pl_recurrence_kind)pl_op_recurrence[node->op], c, a, w0, lanes, block);
  }
}

// ------------------------------------------------------------------------------------------- sweep
INLINE void sweep(pl_jet* jet, pl_tape_level level, int k, bool all, int lanes, int block) {
  const pl_tape_node* nodes = jet->tape->nodes;
  int from = level == PL_LEVEL_CONST ? 0 : jet->tape->level_end[level - 1],
      to = jet->tape->level_end[level];
  if (k == 0) {
    for (int i = from; i < to; i++) value(jet, i, lanes, block);
    return;
  }
  int n = all ? jet->n_series[level] : jet->n_series_high[level];
  for (int i = 0; i < n; i++) known_part(jet, jet->series[level][i], k, lanes, block);
  for (int i = from; i < to; i++)
    if (all || nodes[i].high) coefficient(jet, i, k, lanes, block);
}

void PL_INTERPRET(pl_jet* jet, pl_tape_level level, int k, bool all) {
  if (jet->lanes == 1) sweep(jet, level, k, all, 1, 1);
  else sweep(jet, level, k, all, jet->lanes, 8);
}
