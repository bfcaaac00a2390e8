// Sparse LU of a complex matrix through KLU, as in sparse.c.
#include "linalg/linalg.h"

#include <float.h>
#include <math.h>

#if __has_include(<suitesparse/klu.h>)
#  include <suitesparse/klu.h>
#else
#  include <klu.h>
#endif

struct pl_zsparse {
  int n;
  int *start, *row;
  klu_common common;
  klu_symbolic* symbolic;
  klu_numeric* numeric;
  double* value;  // (2 start[n])
};

pl_zsparse* pl_zsparse_make(pl_arena* a, int n, const int* start, const int* row) {
  pl_zsparse* s = PL_NEW(a, pl_zsparse);
  int n_entries = start[n];
  s->n = n;
  s->start = PL_ARRAY(a, int, n + 1);
  s->row = PL_ARRAY(a, int, n_entries + 1);
  s->value = PL_ARRAY(a, double, 2 * (size_t)n_entries + 1);
  for (int j = 0; j <= n; j++) s->start[j] = start[j];
  for (int k = 0; k < n_entries; k++) s->row[k] = row[k];
  klu_defaults(&s->common);
  s->common.scale = 2;  // rows by their largest entry
  s->symbolic = klu_analyze(n, s->start, s->row, &s->common);
  return s->symbolic ? s : NULL;
}

void pl_zsparse_free(pl_zsparse* s) {
  if (s == NULL) return;
  if (s->numeric) klu_z_free_numeric(&s->numeric, &s->common);
  if (s->symbolic) klu_free_symbolic(&s->symbolic, &s->common);
}

// A new pivot order each time: the result then depends on the values alone, and a step of the
// implicit method factors seldom.
bool pl_zsparse_factor(pl_zsparse* s, const double* value) {
  for (int k = 0; k < 2 * s->start[s->n]; k++) {
    if (!(fabs(value[k]) <= DBL_MAX)) return false;
    s->value[k] = value[k];
  }
  if (s->numeric) klu_z_free_numeric(&s->numeric, &s->common);
  s->numeric = klu_z_factor(s->start, s->row, s->value, s->symbolic, &s->common);
  return s->numeric != NULL && s->common.status == KLU_OK;
}

void pl_zsparse_solve(pl_zsparse* s, double* b) {
  klu_z_solve(s->symbolic, s->numeric, s->n, 1, b, &s->common);
}

double pl_zsparse_rcond(pl_zsparse* s) {
  if (!s->numeric || !klu_z_rcond(s->symbolic, s->numeric, &s->common)) return 0;
  return s->common.rcond;
}

double pl_zsparse_work(const pl_zsparse* s) {
  double flops = s->symbolic->est_flops, n = s->n;
  if (flops >= 0) return flops;
  // the order of elimination was not asked: as for a band
  double width = s->symbolic->lnz > 0 ? s->symbolic->lnz / n : n;
  return 2 * n * width * width;
}
