// The interpreter of codes. This file is compiled twice where the compiler can: for processors with
// a fused multiply-add instruction, and for those without, where the C library computes the same
// bits more slowly.
#include <math.h>

#include "program/program.h"

#ifndef PL_INTERPRET
#  define PL_INTERPRET pl_prog_interpret_plain
#endif
void PL_INTERPRET(const pl_prog* c, double* memory, int from, int to);

#define INLINE static inline __attribute__((always_inline))
#define LANES  for (int l = 0; l < width; l++)

// -------------------------------------------------------------------------------------------- sums
INLINE void add_row(double* s, const double* a, const double* b, int ja, int jb, bool weighted,
                    int width) {
  a += ja * width;
  b += jb * width;
  if (weighted) LANES s[l] = __builtin_fma((double)ja * a[l], b[l], s[l]);
  else LANES s[l] = __builtin_fma(a[l], b[l], s[l]);
}

// Rows i and K - i of a pair, to their two parts.
INLINE void add_rows(double part[2][8], const double* a, const double* b, int j, int K,
                     bool weighted, int width) {
  add_row(part[0], a, b, j, K - j, weighted, width);
  if (2 * j != K) add_row(part[1], a, b, K - j, j, weighted, width);
}

INLINE void sum(const pl_prog* c, const pl_prog_sum* x, double* m, int K, int width) {
  double part[PL_PROG_PARTS][8] = {{0}};
  const pl_prog_pair* pairs = c->pairs.at + x->first;
  for (int j = K / 2; j >= 1; j--)
    for (int p = 0; p < x->n; p += 2) {
      add_rows(part, m + pairs[p].a, m + pairs[p].b, j, K, x->weighted, width);
      if (p + 1 < x->n)
        add_rows(part + 2, m + pairs[p + 1].a, m + pairs[p + 1].b, j, K, x->weighted, width);
    }
  LANES {
    double s = part[0][l] + part[1][l];
    if (x->n > 1) s += part[2][l] + part[3][l];
    if (x->scale >= 0)
      s = __builtin_fma(s, m[x->rest + K * width + l], s * m[x->scale + K * width + l]);
    m[x->to + l] = s;
  }
}

static void block_sums(const pl_prog* c, const pl_prog_block* b, double* m, int k) {
  for (int i = b->first; i < b->first + b->n; i++) {
    if (b->width == 8) sum(c, &c->sums.at[i], m, k + b->shift, 8);
    else sum(c, &c->sums.at[i], m, k + b->shift, 1);
  }
}

INLINE void add_column(double* s, const pl_prog_product* p, const double* m, int j, int block) {
  enum { width = 8 };
  const double* column = m + p->matrix + (j * p->blocks + block) * width;
  double x = m[p->vector + j];
  LANES s[l] = __builtin_fma(column[l], x, s[l]);
}

static void product(const pl_prog_product* p, double* m) {
  enum { width = 8 };
  for (int block = 0; block < p->blocks; block++) {
    double part[4][8] = {{0}}, last[2][8] = {{0}};
    for (int j = 0; j < p->n - p->late; j++) add_column(part[j % 4], p, m, j, block);
    LANES last[0][l] = (part[0][l] + part[1][l]) + (part[2][l] + part[3][l]);
    for (int i = 0; i < p->late; i++) add_column(last[i % 2], p, m, p->n - p->late + i, block);
    LANES m[p->to + block * width + l] = p->late > 1 ? last[0][l] + last[1][l] : last[0][l];
  }
}

// --------------------------------------------------------------------------------------- functions
static double call1(int fn, double x) {
  switch (fn) {
#define CASE_1(name) \
  case PL_FN_##name: \
    return name(x);
#define CASE_2(name)
#define CASE(name, reads) CASE_##reads(name)
    PL_PROG_FUNCTIONS(CASE)
#undef CASE_1
#undef CASE_2
  }
  return (double)NAN;
}

static double call2(int fn, double x, double y) {
  switch (fn) {
#define CASE_1(name)
#define CASE_2(name) \
  case PL_FN_##name: return name(x, y);
    PL_PROG_FUNCTIONS(CASE)
  }
  return (double)NAN;
}

// ------------------------------------------------------------------------------------------- lines
INLINE void run(const pl_prog* code, double* m, int k, int width) {
  double* r = m + code->spill;
  for (int i = 0; i < code->lines.n; i++) {
    const pl_prog_line* x = &code->lines.at[i];
    double* d = r + x->d * width;
    const double *a = r + x->a * width, *b = r + x->b * width, *c = r + x->c * width,
                 *e = r + x->e * width;
    double* at = m + x->at + (long)x->by * k;
    switch ((pl_prog_op)x->op) {
      case PL_PROG_LOAD: LANES d[l] = at[l]; break;
      case PL_PROG_SPREAD: LANES d[l] = *at; break;
      case PL_PROG_STORE: LANES at[l] = a[l]; break;
      case PL_PROG_NUMBER: LANES d[l] = x->value; break;
      case PL_PROG_ORDER: LANES d[l] = (double)(k + x->at); break;
      case PL_PROG_ADD: LANES d[l] = a[l] + b[l]; break;
      case PL_PROG_SUB: LANES d[l] = a[l] - b[l]; break;
      case PL_PROG_MUL: LANES d[l] = a[l] * b[l]; break;
      case PL_PROG_DIV: LANES d[l] = a[l] / b[l]; break;
      case PL_PROG_FMA: LANES d[l] = __builtin_fma(a[l], b[l], c[l]); break;
      case PL_PROG_FNMA: LANES d[l] = __builtin_fma(-a[l], b[l], c[l]); break;
      case PL_PROG_NEG: LANES d[l] = -a[l]; break;
      case PL_PROG_ABS: LANES d[l] = fabs(a[l]); break;
      case PL_PROG_SQRT: LANES d[l] = sqrt(a[l]); break;
      case PL_PROG_IF_MORE: LANES d[l] = a[l] > 0 ? b[l] : c[l]; break;
      case PL_PROG_IF_LESS: LANES d[l] = a[l] < 0 ? b[l] : c[l]; break;
      case PL_PROG_IF_LE: LANES d[l] = a[l] <= b[l] ? c[l] : e[l]; break;
      case PL_PROG_CALL1: LANES d[l] = call1(x->fn, a[l]); break;
      case PL_PROG_CALL2: LANES d[l] = call2(x->fn, a[l], b[l]); break;
      case PL_PROG_SUMS: block_sums(code, &code->blocks.at[x->at], m, k); break;
      case PL_PROG_PRODUCT: product(&code->products.at[x->at], m); break;
      case PL_N_PROG_OPS: break;
    }
  }
}

void PL_INTERPRET(const pl_prog* c, double* memory, int from, int to) {
  for (int k = from; k < to; k++) {
    if (c->width == 8) run(c, memory, k, 8);
    else run(c, memory, k, 1);
  }
}
