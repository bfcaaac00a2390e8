// Numbers of the symmetric solver: factor and solve. This file is compiled for several kinds of
// processors (meson.build); every sum has one order, and what is fused says so, so that all of them
// give the same bits.
#include <math.h>
#include <string.h>

#include "linalg/symmetric_impl.h"

#ifndef PL_SYMMETRIC
#  define PL_SYMMETRIC pl_symmetric_plain
#endif
#define INLINE static inline __attribute__((always_inline))
#define EIGHT  for (int l = 0; l < 8; l++)

// ------------------------------------------------------------------------------------- elimination
typedef double pl_eight __attribute__((vector_size(64), aligned(8), may_alias));

#define T       double
#define P       1
#define NAME(x) x##_1
#include "linalg/symmetric_loops.h"
#undef T
#undef P
#undef NAME
#define T       pl_eight
#define P       1
#define NAME(x) x##_8
#include "linalg/symmetric_loops.h"
#undef P
#undef NAME
#define P       2
#define NAME(x) x##_16
#include "linalg/symmetric_loops.h"
#undef P
#undef NAME
#define P       4
#define NAME(x) x##_32
#include "linalg/symmetric_loops.h"
#undef T
#undef P
#undef NAME

#define EACH_FRONT(f, what)       \
  switch ((f)->lanes) {           \
    case 8: what##_8(f); break;   \
    case 16: what##_16(f); break; \
    case 32: what##_32(f); break; \
    default: what##_1(f); break;  \
  }

static void forward_front(const pl_symmetric_front* f) { EACH_FRONT(f, forward) }
static void backward_front(const pl_symmetric_front* f) { EACH_FRONT(f, backward) }

// Returns the smallest part of a pivot that the subtractions have left.
static double eliminate_front(pl_symmetric_front* f) {
  int n = f->m * f->lanes;
  double least = 1, wrong = 0;
  memcpy(f->d, f->w, (size_t)n * sizeof *f->w);
  EACH_FRONT(f, eliminate)
  for (int i = 0; i < n; i++) {
    double before = fabs(f->d[i]), taken = fabs(f->d[i] - f->w[i]),
           size = before > taken ? before : taken;
    double part = fabs(f->w[i]);
    if (part < least * size) least = part / size;
    wrong += 0 * f->inverse[i];  // not a number once an inverse is none
  }
  return wrong == 0 ? least : 0;
}

static void fill_rows(pl_symmetric_rows* r, const double* value) {
  int n = 8 * r->first[r->n_groups];
  for (int i = 0; i < n; i++) r->value[i] = r->from[i] >= 0 ? value[r->from[i]] : 0;
}

static void assemble(pl_symmetric* s, const double* value) {
  double* w = s->memory;
  const int* to = s->schur_to;
  memset(w, 0, s->n_memory * sizeof *w);
  for (int i = 0; i < s->n_ones; i++) w[s->ones[i]] = 1;
  for (int i = 0; i < s->n_direct; i++) w[s->direct_to[i]] += value[s->direct_from[i]];
  for (int e = 0; e < s->n_early; e++) {
    double inverse = s->early_inverse[e] = 1 / value[s->early_from[e]];
    for (int i = s->schur_start[e]; i < s->schur_start[e + 1]; i++) {
      double x = value[s->schur_from[i]] * inverse;
      for (int j = s->schur_start[e]; j <= i; j++, to++)
        w[*to] = __builtin_fma(-x, value[s->schur_from[j]], w[*to]);
    }
  }
}

static double factor(pl_symmetric* s, const double* value) {
  assemble(s, value);
  fill_rows(&s->by_core, value);
  fill_rows(&s->by_early, value);
  double part = eliminate_front(&s->main), part_2 = 1;
  const pl_symmetric_front* f = &s->main;
  const double* product = f->w + (size_t)(f->m + f->n) * (size_t)f->lanes;
  for (int i = 0; i < s->n_products; i++)
    if (s->to_border[i] >= 0) s->border.w[s->to_border[i]] += product[i];
  if (s->border.m > 0) part_2 = eliminate_front(&s->border);
  for (int e = 0; e < s->n_early; e++)
    if (!(fabs(s->early_inverse[e]) <= 1e300)) return 0;
  return part < part_2 ? part : part_2;
}

// ------------------------------------------------------------------------------------------- solve
// The sums of a group of rows.
INLINE void rows_times(const pl_symmetric_rows* r, int g, const double* x, double* restrict to) {
  pl_eight sum = {0};
  for (int e = r->first[g]; e < r->first[g + 1]; e++) {
    const pl_eight* c = (const pl_eight*)(r->value + 8 * (size_t)e);
    if (r->base[e] >= 0) {
      sum += *c * *(const pl_eight*)(x + r->base[e]);
    } else {
      const int* at = r->index + 8 * (size_t)e;
      pl_eight from = {x[at[0]], x[at[1]], x[at[2]], x[at[3]],
                       x[at[4]], x[at[5]], x[at[6]], x[at[7]]};
      sum += *c * from;
    }
  }
  *(pl_eight*)to = sum;
}

static void solve_fronts(pl_symmetric* s) {
  const pl_symmetric_front *f = &s->main, *b = &s->border;
  int lanes = f->lanes;
  double* y = f->y + (size_t)f->m * (size_t)lanes;
  for (int i = 0; i < f->nb * lanes; i++) y[i] = 0;
  forward_front(f);
  for (int i = 0; i < f->nb * lanes; i++)
    if (s->slot_border[i] >= 0) b->y[s->slot_border[i]] += y[i];
  if (b->m > 0) {
    forward_front(b);
    backward_front(b);
  }
  for (int i = 0; i < f->nb * lanes; i++)
    y[i] = s->slot_border[i] >= 0 ? b->y[s->slot_border[i]] : 0;
  backward_front(f);
}

// Unknowns that follow each other are copied in a row.
static void take(double* restrict to, const double* restrict b, const int* index, int run, int n) {
  if (run >= 0) memcpy(to, b + run, (size_t)n * sizeof *b);
  else
    for (int i = 0; i < n; i++) to[i] = b[index[i]];
}

static void give(double* restrict b, const double* restrict from, const int* index, int run,
                 int n) {
  if (run >= 0) memcpy(b + run, from, (size_t)n * sizeof *b);
  else
    for (int i = 0; i < n; i++) b[index[i]] = from[i];
}

static void solve(pl_symmetric* s, double* b) {
  double sum[8];
  const int* restrict to = s->of_core;
  double* restrict z = s->z, * restrict x = s->x, * restrict y = s->solution;
  const double* restrict inverse = s->early_inverse;
  take(z, b, s->early, s->early_run, s->n_early);
  take(x, b, s->core, s->core_run, s->n_core);
  for (int e = 0; e < s->n_early; e++) z[e] *= inverse[e];
  for (int i = 0; i < s->n_ones; i++) y[s->ones[i]] = 0;
  for (int g = 0; g < s->by_core.n_groups; g++) {
    rows_times(&s->by_core, g, z, sum);
    EIGHT sum[l] = x[8 * g + l] - sum[l];
    int n = s->n_core - 8 * g < 8 ? s->n_core - 8 * g : 8;
    for (int l = 0; l < n; l++) y[to[8 * g + l]] = sum[l];
  }
  solve_fronts(s);
  for (int i = 0; i < s->n_core; i++) x[i] = y[to[i]];
  give(b, x, s->core, s->core_run, s->n_core);
  for (int g = 0; g < s->by_early.n_groups; g++) {
    rows_times(&s->by_early, g, x, sum);
    EIGHT z[8 * g + l] = __builtin_fma(-inverse[8 * g + l], sum[l], z[8 * g + l]);
  }
  give(b, z, s->early, s->early_run, s->n_early);
}

const pl_symmetric_kernels PL_SYMMETRIC = {factor, solve};
