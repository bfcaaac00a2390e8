// L D L^T of a sparse symmetric system in a static order, written out as code.
//
// The order: first coordinates with a mass, where the matrix is positive, then constraints whose
// diagonal has filled in by then (negative), then coordinates without a mass whose constraints are
// done (positive), and so on; each time the one with the fewest neighbours left (minimum degree).
// There is no pivoting; pivots and the sums of what was subtracted from the diagonal come out, so
// that cancellation is seen.
#include "solve/stepper/taylor/step_program_impl.h"

// ------------------------------------------------------------------------------------------- order
typedef struct pl_order {
  bool *pattern, *done, *pivots;  // pivots: the diagonal is there, or filled in
  int n, n_mass, n_coordinates;
} pl_order;

static int degree(const pl_order* o, int i) {
  int d = 0;
  for (int j = 0; j < o->n; j++)
    d += !o->done[j] && j != i && o->pattern[(size_t)i * (size_t)o->n + (size_t)j];
  return d;
}

static int fewest(const pl_order* o, int from, int to) {
  int best = -1, least = 0;
  for (int i = from; i < to; i++) {
    if (o->done[i] || !o->pivots[i]) continue;
    int d = degree(o, i);
    if (best < 0 || d < least) {
      best = i;
      least = d;
    }
  }
  return best;
}

static int choose(const pl_order* o) {
  int i = fewest(o, 0, o->n_mass);
  if (i < 0) i = fewest(o, o->n_coordinates, o->n);
  return i < 0 ? fewest(o, o->n_mass, o->n_coordinates) : i;
}

static void fill_in(pl_order* o, int pivot) {
  size_t n = (size_t)o->n, p = (size_t)pivot;
  for (size_t i = 0; i < n; i++) {
    if (o->done[i] || !o->pattern[p * n + i]) continue;
    o->pivots[i] = true;
    for (size_t j = 0; j < n; j++)
      if (!o->done[j] && o->pattern[p * n + j]) o->pattern[i * n + j] = true;
  }
}

pl_step_elimination* pl_step_elimination_make(pl_arena* a, const bool* entry, int n, int n_mass,
                                              int n_coordinates, int* memory) {
  pl_step_elimination* e = PL_NEW(a, pl_step_elimination);
  size_t nn = (size_t)n * (size_t)n;
  pl_order o = {PL_ARRAY(a, bool, nn + 1),
                PL_ARRAY(a, bool, n + 1),
                PL_ARRAY(a, bool, n + 1),
                n,
                n_mass,
                n_coordinates};
  e->n = n;
  e->order = PL_ARRAY(a, int, n + 1);
  e->cell = PL_ARRAY(a, int, nn + 1);
  for (size_t i = 0; i < nn; i++) {
    o.pattern[i] = entry[i];
    e->cell[i] = -1;
  }
  for (int i = 0; i < n_mass; i++) o.pivots[i] = true;
  e->inverse_d = *memory;
  *memory += n;
  for (int step = 0; step < n; step++) {
    int pivot = choose(&o);
    if (pivot < 0) return NULL;
    o.done[pivot] = true;
    fill_in(&o, pivot);
    e->order[step] = pivot;
  }
  for (int j = 0; j < n; j++)
    for (int i = j + 1; i < n; i++)
      if (o.pattern[(size_t)e->order[i] * (size_t)n + (size_t)e->order[j]])
        e->cell[(size_t)i * (size_t)n + (size_t)j] = (*memory)++;
  return e;
}

// ------------------------------------------------------------------------------------------ factor
void pl_step_elimination_factor(const pl_step_elimination* e, pl_prog* c, const int* entry,
                                int* pivot, int* size) {
  size_t n = (size_t)e->n;
  // what is left of the matrix, in order of elimination
  int* K = PL_ARRAY(c->arena, int, n* n + 1);
  int* scaled = PL_ARRAY(c->arena, int, n + 1);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++)
      K[i * n + j] = entry[(size_t)e->order[i] * n + (size_t)e->order[j]];
  for (size_t i = 0; i < n; i++) size[e->order[i]] = -1;
  for (size_t j = 0; j < n; j++) {
    int d = K[j * n + j] >= 0 ? K[j * n + j] : pl_prog_number(c, 0);
    int inverse = pl_prog_op2(c, PL_PROG_DIV, pl_prog_number(c, 1), d);
    pivot[e->order[j]] = d;
    pl_prog_store(c, inverse, e->inverse_d + (int)j, 0);
    for (size_t i = j + 1; i < n; i++) {
      if (e->cell[i * n + j] < 0) continue;
      if (K[i * n + j] < 0) K[i * n + j] = pl_prog_number(c, 0);
      scaled[i] = pl_prog_op2(c, PL_PROG_MUL, K[i * n + j], inverse);
      pl_prog_store(c, scaled[i], e->cell[i * n + j], 0);
    }
    for (size_t i = j + 1; i < n; i++) {
      if (e->cell[i * n + j] < 0) continue;
      for (size_t k = j + 1; k < i; k++) {
        if (e->cell[k * n + j] < 0) continue;
        int *x = &K[i * n + k], u = K[k * n + j];
        if (*x < 0) *x = pl_prog_op1(c, PL_PROG_NEG, pl_prog_op2(c, PL_PROG_MUL, scaled[i], u));
        else *x = pl_prog_op3(c, PL_PROG_FNMA, scaled[i], u, *x);
      }
      int *x = &K[i * n + i], u = K[i * n + j], *most = &size[e->order[i]];
      int part = pl_prog_op2(c, PL_PROG_MUL, scaled[i], u), way = pl_prog_op1(c, PL_PROG_ABS, part);
      *most = *most < 0 ? way : pl_prog_op2(c, PL_PROG_ADD, *most, way);
      *x = *x < 0 ? pl_prog_op1(c, PL_PROG_NEG, part)
                  : pl_prog_op3(c, PL_PROG_FNMA, scaled[i], u, *x);
    }
  }
}

// ------------------------------------------------------------------------------------------- solve
static int factor_at(pl_prog* c, int cell) {
  return c->width == 1 ? pl_prog_load(c, cell, 0) : pl_prog_spread(c, cell, 0);
}

static void subtract(pl_prog* c, int l, int y, int* x) {
  if (*x < 0) *x = pl_prog_op1(c, PL_PROG_NEG, pl_prog_op2(c, PL_PROG_MUL, l, y));
  else *x = pl_prog_op3(c, PL_PROG_FNMA, l, y, *x);
}

void pl_step_elimination_solve(const pl_step_elimination* e, pl_prog* c, int* x) {
  size_t n = (size_t)e->n;
  for (size_t j = 0; j < n; j++) {
    int y = x[e->order[j]];
    if (y < 0) continue;
    for (size_t i = j + 1; i < n; i++)
      if (e->cell[i * n + j] >= 0)
        subtract(c, factor_at(c, e->cell[i * n + j]), y, &x[e->order[i]]);
  }
  for (size_t j = 0; j < n; j++) {
    int* y = &x[e->order[j]];
    if (*y >= 0) *y = pl_prog_op2(c, PL_PROG_MUL, *y, factor_at(c, e->inverse_d + (int)j));
  }
  for (size_t j = n; j-- > 0;)
    for (size_t i = n; i-- > j + 1;)
      if (e->cell[i * n + j] >= 0 && x[e->order[i]] >= 0)
        subtract(c, factor_at(c, e->cell[i * n + j]), x[e->order[i]], &x[e->order[j]]);
}
