// manifold_rank: constraints whose gradients depend on each other where all of them hold, and
// nowhere else: two bars beside a third one on the same coupler. The rank at a general place counts
// them as independent. Points that satisfy the constraints are found in numbers, by Newton's method
// from the start and from places around it, and the rank is taken there.
// See theory (4.1).
#include <math.h>
#include <string.h>

#include "mechanics/mechanics.h"

enum { max_rows = 40, max_columns = 60, n_points = 4, max_newton = 80 };
static const double solved_to = 1e-11;  // of a constraint, beside 1
// of a row of length 1, at points that are solved to 1e-11
static const double dependent_below = 1e-6;
static const double off_start = 0.1;  // how far beside the start other points are looked for

typedef struct pl_manifold_search {
  pl_analysis* d;
  int m, n;
  const int *row, *column;
  double* value;  // by symbol
  double J[max_rows * max_columns], g[max_rows];
} pl_manifold_search;

static void evaluate(pl_manifold_search* w) {
  pl_analysis* d = w->d;
  for (int a = 0; a < w->m; a++) {
    const pl_bond* l = &d->g.at[w->row[a]];
    w->g[a] = l->velocity ? 0 : pl_eval(d->pool, pl_on_fixed(d, l->g), w->value);
    for (int b = 0; b < w->n; b++)
      w->J[a * w->n + b] = pl_eval(d->pool, pl_on_fixed(d, l->gradient[w->column[b]]), w->value);
  }
}

// A x = b by elimination with the largest pivot; A (n x n) and b are overwritten.
static bool solve(double* A, double* b, int n) {
  for (int k = 0; k < n; k++) {
    int p = k;
    for (int i = k + 1; i < n; i++) p = fabs(A[i * n + k]) > fabs(A[p * n + k]) ? i : p;
    if (!(fabs(A[p * n + k]) > 0)) return false;
    for (int j = 0; j < n && p != k; j++) {
      double x = A[k * n + j];
      A[k * n + j] = A[p * n + j];
      A[p * n + j] = x;
    }
    double x = b[k];
    b[k] = b[p];
    b[p] = x;
    for (int i = k + 1; i < n; i++) {
      double f = A[i * n + k] / A[k * n + k];
      for (int j = k; j < n; j++) A[i * n + j] -= f * A[k * n + j];
      b[i] -= f * b[k];
    }
  }
  for (int k = n - 1; k >= 0; k--) {
    for (int j = k + 1; j < n; j++) b[k] -= A[k * n + j] * b[j];
    b[k] /= A[k * n + k];
  }
  return true;
}

// The least change of the coordinates that solves the linear equations; what depends is held by a
// small weight.
static bool newton_step(pl_manifold_search* w) {
  static const double weight = 1e-10;
  double N[max_rows * max_rows], y[max_rows], trace = 0;
  for (int a = 0; a < w->m; a++) {
    for (int b = 0; b < w->m; b++) {
      N[a * w->m + b] = 0;
      for (int j = 0; j < w->n; j++) N[a * w->m + b] += w->J[a * w->n + j] * w->J[b * w->n + j];
    }
    trace += N[a * w->m + a];
    y[a] = -w->g[a];
  }
  for (int a = 0; a < w->m; a++) N[a * w->m + a] += weight * trace;
  if (!isfinite(trace) || !solve(N, y, w->m)) return false;
  for (int j = 0; j < w->n; j++) {
    double change = 0;
    for (int a = 0; a < w->m; a++) change += w->J[a * w->n + j] * y[a];
    if (!isfinite(change)) return false;
    w->value[w->d->q.at[w->column[j]].q.id] += change;
  }
  return true;
}

static bool find_point(pl_manifold_search* w) {
  for (int k = 0; k < max_newton; k++) {
    double off = 0;
    evaluate(w);
    for (int a = 0; a < w->m; a++) off = fmax(off, fabs(w->g[a]));
    if (off < solved_to) return true;
    if (!isfinite(off) || !newton_step(w)) return false;
  }
  return false;
}

// Rows that are left when those before them are taken out, of the Jacobian with rows of length 1.
static int independent_rows(pl_manifold_search* w, int* rows) {
  double Q[max_rows * max_columns];
  int rank = 0;
  for (int a = 0; a < w->m; a++) {
    double* r = Q + rank * w->n;
    double size = 0, left = 0;
    for (int j = 0; j < w->n; j++) size += w->J[a * w->n + j] * w->J[a * w->n + j];
    for (int j = 0; j < w->n; j++) r[j] = size > 0 ? w->J[a * w->n + j] / sqrt(size) : 0;
    for (int twice = 0; twice < 2; twice++) {
      for (int k = 0; k < rank; k++) {
        double along = 0;
        for (int j = 0; j < w->n; j++) along += Q[k * w->n + j] * r[j];
        for (int j = 0; j < w->n; j++) r[j] -= along * Q[k * w->n + j];
      }
    }
    for (int j = 0; j < w->n; j++) left += r[j] * r[j];
    if (!(sqrt(left) > dependent_below) || rank == w->n) continue;
    for (int j = 0; j < w->n; j++) r[j] /= sqrt(left);
    rows[rank++] = a;
  }
  return rank;
}

// Numbers for everything: given ones, the start, others drawn.
static void draw(pl_manifold_search* w, int point) {
  pl_analysis* d = w->d;
  int n = pl_symbol_count(d->pool) + 1;
  const double* known = pl_model_values(d->model, d->arena);
  pl_random r = {(uint64_t)7919};  // parameters are the same at all points
  w->value = PL_ARRAY(d->arena, double, n);
  for (int i = 1; i < n; i++) {
    double unit = pl_random_unit(&r);
    bool given = pl_symbol_get(d->pool, (pl_symbol){(uint32_t)i})->role == PL_R_PARAM;
    w->value[i] = !isnan(known[i]) ? known[i] : given ? 0.5 + unit : (double)NAN;
  }
  for (int k = 0; k < d->model->lets.n; k++) {
    const pl_let* let = &d->model->lets.at[k];
    if (let->n_args == 0) w->value[let->symbol.id] = pl_eval(d->pool, let->value, w->value);
  }
  w->value[pl_time(d->pool).id] = 0;
  r.state = (uint64_t)point + 1;
  for (int i = 0; i < d->q.n; i++) {
    double start = pl_number(d, pl_sym(d->pool, pl_symbol_start(d->pool, d->q.at[i].q))),
           beside = 2 * pl_random_unit(&r) - 1;
    double at = isnan(start) ? 0.4 + 0.3 * pl_random_unit(&r) : start;
    w->value[d->q.at[i].q.id] =
        at + (point == 0 && !isnan(start) ? 0 : off_start * (1 + fabs(at)) * beside);
  }
}

int pl_rank_on_manifold(pl_analysis* d, const int* row, int m, const int* column, int n,
                        int* independent) {
  if (m > max_rows || n > max_columns) return -1;
  pl_manifold_search* w = PL_NEW(d->arena, pl_manifold_search);
  *w = (pl_manifold_search){.d = d, .m = m, .n = n, .row = row, .column = column};
  int best = -1, found = 0, here[max_rows];
  for (int point = 0; point < n_points; point++) {
    draw(w, point);
    if (!find_point(w)) continue;
    int rank = independent_rows(w, here);
    found += point > 0;  // the start itself may be singular
    if (rank <= best) continue;
    best = rank;
    memcpy(independent, here, (size_t)rank * sizeof *here);
  }
  return found >= 2 ? best : -1;
}

// Row k over the independent ones, from as many columns: right where the constraints hold.
void pl_depend_on_manifold(pl_analysis* d, int k, const int* independent, int rank,
                           const int* column, int n) {
  pl_expr* A = PL_ARRAY(d->arena, pl_expr, n * rank + 1);  // transposed: a row for each column
  for (int b = 0; b < n; b++) {
    for (int a = 0; a < rank; a++) A[b * rank + a] = d->g.at[independent[a]].gradient[column[b]];
  }
  int* of = PL_ARRAY(d->arena, int, n + 1);
  if (rank == 0 || pl_alg_rank(d->tower, n, rank, A, of) != rank) return;
  pl_expr *S = PL_ARRAY(d->arena, pl_expr, rank * rank), *b = PL_ARRAY(d->arena, pl_expr, rank),
          *c = PL_ARRAY(d->arena, pl_expr, rank);
  for (int i = 0; i < rank; i++) {
    for (int a = 0; a < rank; a++) S[i * rank + a] = A[of[i] * rank + a];
    b[i] = d->g.at[k].gradient[column[of[i]]];
  }
  if (pl_alg_solve(d->tower, rank, S, b, c, 3000) != PL_YES) return;
  int before = d->dependences.n;
  pl_depend(d, k, rank, independent, c, -1);
  if (d->dependences.n > before) d->dependences.at[before].there = true;
}
