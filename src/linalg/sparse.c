// Sparse LU through KLU (Davis and Palamadai Natarajan, ACM TOMS 37 (2010) 36). The order of
// elimination is found once; the pivots of the first factorisation are kept while they serve, so
// that a step allocates nothing.
#include "linalg/linalg.h"

#include <float.h>
#include <math.h>

#if __has_include(<suitesparse/klu.h>)
#  include <suitesparse/klu.h>
#else
#  include <klu.h>
#endif

struct pl_sparse {
  int n;
  int *start, *row;  // KLU takes them without const
  klu_common common;
  klu_symbolic* symbolic;
  klu_numeric* numeric;
  double* value;  // KLU takes it without const  (start[n])
  double* first;  // those that the pivot order was found from  (start[n])
  double growth;  // reciprocal growth of entries there
};

// Pivots kept from an earlier factorisation serve while entries grow not much more with them than
// with pivots of their own: each power of ten that they grow costs a digit of the solution.
static const double part_of_growth = 0.05;

pl_sparse* pl_sparse_make(pl_arena* a, int n, const int* start, const int* row) {
  pl_sparse* s = PL_NEW(a, pl_sparse);
  int n_entries = start[n];
  s->n = n;
  s->start = PL_ARRAY(a, int, n + 1);
  s->row = PL_ARRAY(a, int, n_entries + 1);
  s->value = PL_ARRAY(a, double, n_entries + 1);
  s->first = PL_ARRAY(a, double, n_entries + 1);
  for (int j = 0; j <= n; j++) s->start[j] = start[j];
  for (int k = 0; k < n_entries; k++) s->row[k] = row[k];
  klu_defaults(&s->common);
  s->common.scale = 2;  // rows by their largest entry
  s->symbolic = klu_analyze(n, s->start, s->row, &s->common);
  if (s->symbolic == NULL) return NULL;
  if (s->symbolic->structural_rank >= 0 && s->symbolic->structural_rank < n) {
    pl_sparse_free(s);
    return NULL;
  }
  return s;
}

void pl_sparse_free(pl_sparse* s) {
  if (s == NULL) return;
  if (s->numeric) klu_free_numeric(&s->numeric, &s->common);
  if (s->symbolic) klu_free_symbolic(&s->symbolic, &s->common);
}

static double growth_of(pl_sparse* s, double* value) {
  bool known = klu_rgrowth(s->start, s->row, value, s->symbolic, s->numeric, &s->common);
  return known ? s->common.rgrowth : 0;
}

static bool refactor_serves(pl_sparse* s) {
  if (!klu_refactor(s->start, s->row, s->value, s->symbolic, s->numeric, &s->common)) return false;
  return s->common.status == KLU_OK && growth_of(s, s->value) > part_of_growth * s->growth;
}

// A factor with a pivot order of its own, from s->first.
static bool factor_anew(pl_sparse* s) {
  if (s->numeric) klu_free_numeric(&s->numeric, &s->common);
  s->numeric = klu_factor(s->start, s->row, s->first, s->symbolic, &s->common);
  if (s->numeric == NULL || s->common.status != KLU_OK) return false;
  s->growth = growth_of(s, s->first);
  return true;
}

bool pl_sparse_factor(pl_sparse* s, const double* value) {
  for (int k = 0; k < s->start[s->n]; k++) {
    if (!(fabs(value[k]) <= DBL_MAX)) return false;
    s->value[k] = value[k];
  }
  if (s->numeric && refactor_serves(s)) return true;
  for (int k = 0; k < s->start[s->n]; k++) s->first[k] = s->value[k];
  return factor_anew(s);
}

void pl_sparse_keep(pl_sparse* s, pl_keeper* k) {
  bool has = s->numeric != NULL;
  pl_keep_bool(k, &has);
  if (has) pl_keep_f64s(k, s->first, (size_t)s->start[s->n]);
  if (!k->reads || k->wrong) return;
  if (s->numeric) klu_free_numeric(&s->numeric, &s->common);
  if (has && !factor_anew(s)) pl_keep_fail(k);
}

void pl_sparse_solve(pl_sparse* s, double* b) {
  klu_solve(s->symbolic, s->numeric, s->n, 1, b, &s->common);
}

double pl_sparse_rcond(pl_sparse* s) {
  if (!s->numeric || !klu_rcond(s->symbolic, s->numeric, &s->common)) return 0;
  return s->common.rcond;
}

void pl_sparse_forget(pl_sparse* s) {
  if (s->numeric) klu_free_numeric(&s->numeric, &s->common);
}
