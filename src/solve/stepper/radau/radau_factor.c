// The implicit method: the systems of its Newton iteration.  The simplified matrix
//
//   A^-1/h ⊗ P0 + I ⊗ P1 + h A ⊗ P2        (radau_impl.h)
//
// splits along the eigenvectors of A^-1 into one real and some complex systems γ/h P0 + P1 + h/γ
// P2, dense or sparse; small ones also have all stages in one matrix, with slopes of their own.
#include <math.h>
#include <string.h>

#include "solve/stepper/radau/radau_impl.h"

static double* stage(double* x, int i, int n) { return pl_radau_stage(x, i, n); }

// Rows of what is not used hold 1 on the diagonal.
static bool rests(const pl_run* run, int i) {
  return i < run->n_q ? run->dae.has_equation[i] == 0 : !pl_radau_has_force(run, i - run->n_q);
}

// γ P0 + P1 + P2 / γ: entry at `at`, re and im.
static void combine(const pl_radau_slopes* J, size_t at, const double* g, const double* g_inverse,
                    double* z) {
  z[0] = g[0] * J->P0[at] + J->P1[at] + g_inverse[0] * J->P2[at];
  z[1] = g[1] * J->P0[at] + g_inverse[1] * J->P2[at];
}

static void fill(const pl_radau* r, const pl_run* run, int k, double h, double* N) {
  double g[2] = {r->method.gamma[k][0] / h, r->method.gamma[k][1] / h},
         norm = g[0] * g[0] + g[1] * g[1];
  double g_inverse[2] = {g[0] / norm, -g[1] / norm}, z[2];
  const pl_radau_shape* s = &r->shape;
  size_t parts = k > 0 ? 2 : 1;
  for (int col = 0; col < r->n; col++) {
    size_t from = s->start ? (size_t)s->start[col] : (size_t)col * (size_t)r->n;
    size_t to = s->start ? (size_t)s->start[col + 1] : from + (size_t)r->n;
    for (size_t at = from; at < to; at++) {
      int row = s->start ? s->row[at] : (int)(at - from);
      combine(&r->here, at, g, g_inverse, z);
      if (rests(run, row) || rests(run, col)) {
        z[0] = row == col;
        z[1] = 0;
      }
      for (size_t p = 0; p < parts; p++) N[at * parts + p] = z[p];
    }
  }
}

// Pivot orders are found anew each time, so that a step does not depend on those before.
static bool factor_one(pl_radau* r, int k) {
  if (k == 0 && r->sparse) {
    pl_sparse_forget(r->sparse);
    return pl_sparse_factor(r->sparse, r->real) && pl_sparse_rcond(r->sparse) > 0;
  }
  if (k == 0) return pl_lu_factor(r->real, r->pivot[0], r->real_scale, r->n) > 0;
  pl_zsparse* sparse = r->sparse_pair[k - 1];
  if (sparse) return pl_zsparse_factor(sparse, r->pair[k - 1]) && pl_zsparse_rcond(sparse) > 0;
  return pl_zlu_factor(r->pair[k - 1], r->pivot[k], r->pair_scale[k - 1], r->n) > 0;
}

bool pl_radau_factor(pl_radau* r, const pl_run* run, double h) {
  if (r->has_factor && r->h_factored == h) return true;
  r->has_factor = false;
  for (int k = 0; k <= r->method.n_pairs; k++) {
    fill(r, run, k, h, k == 0 ? r->real : r->pair[k - 1]);
    if (!factor_one(r, k)) return false;
  }
  r->h_factored = h;
  return r->has_factor = true;
}

void pl_radau_solve_real(pl_radau* r, double* b) {
  if (r->sparse) pl_sparse_solve(r->sparse, b);
  else pl_lu_solve(r->real, r->pivot[0], r->real_scale, b, r->work, r->n);
}

static void solve_pair(pl_radau* r, int k) {
  if (r->sparse_pair[k - 1]) pl_zsparse_solve(r->sparse_pair[k - 1], r->w[k]);
  else pl_zlu_solve(r->pair[k - 1], r->pivot[k], r->pair_scale[k - 1], r->w[k], r->n);
}

void pl_radau_multiply(const pl_radau_shape* s, double* b, double factor, const double* P,
                       const double* x, int n) {
  for (int col = 0; col < n; col++) {
    size_t from = s->start ? (size_t)s->start[col] : (size_t)col * (size_t)s->n;
    size_t to = s->start ? (size_t)s->start[col + 1] : from + (size_t)s->n;
    double f = factor * x[col];
    for (size_t at = from; at < to; at++) b[s->start ? s->row[at] : (int)(at - from)] += f * P[at];
  }
}

// ---------------------------------------------------------------------------------- one correction
// Adds the correction in F to the increments of v and to λ, stage by stage.
static void apply(pl_radau* r) {
  for (int i = 0; i < r->method.s; i++) {
    const double* d = stage(r->F, i, r->n);
    for (int e = 0; e < r->n_q; e++) stage(r->Z, i, r->n_q)[e] += d[e];
    for (int e = 0; e < r->n_c; e++) stage(r->L, i, r->n_c)[e] += d[r->n_q + e];
  }
}

// w = X^-1 (-F), component k: re (and im) of each entry
static void transform(const pl_radau* r, const pl_run* run, int k) {
  int parts = k > 0 ? 2 : 1;
  double* w = r->w[k];
  for (int e = 0; e < r->n; e++) {
    for (int p = 0; p < parts; p++) {
      double sum = 0;
      for (int i = 0; i < r->method.s; i++)
        sum -= r->method.Y[k][i][p] * r->F[(size_t)i * (size_t)r->n + (size_t)e];
      w[e * parts + p] = rests(run, e) ? 0 : sum;
    }
  }
}

void pl_radau_correct(pl_radau* r, const pl_run* run) {
  for (int k = 0; k <= r->method.n_pairs; k++) {
    transform(r, run, k);
    if (k == 0) pl_radau_solve_real(r, r->w[0]);
    else solve_pair(r, k);
  }
  // F becomes the correction
  for (int i = 0; i < r->method.s; i++) {
    double* d = stage(r->F, i, r->n);
    for (int e = 0; e < r->n; e++) {
      d[e] = r->method.X[0][i][0] * r->w[0][e];
      for (int k = 1; k <= r->method.n_pairs; k++)
        d[e] +=
            2 * (r->method.X[k][i][0] * r->w[k][2 * e] - r->method.X[k][i][1] * r->w[k][2 * e + 1]);
    }
  }
  apply(r);
}

// ------------------------------------------------------------------------------ all stages coupled
// Block (i, j) of the matrix of all stages with slopes of their own.
static void fill_block(const pl_radau* r, const pl_run* run, int i, int j, double h) {
  const pl_radau_slopes* J = &r->at[i];
  double turn = r->method.inverse[i][j] / h, way = r->method.A[i][j] * h, same = i == j;
  size_t n = (size_t)r->n, rows = n * (size_t)r->method.s;
  for (size_t col = 0; col < n; col++) {
    double* to = r->coupled + ((size_t)j * n + col) * rows + (size_t)i * n;
    for (size_t row = 0; row < n; row++) {
      size_t at = row + col * n;
      bool idle = rests(run, (int)row) || rests(run, (int)col);
      to[row] = idle ? i == j && row == col : turn * J->P0[at] + same * J->P1[at] + way * J->P2[at];
    }
  }
}

bool pl_radau_couple(pl_run* run, pl_radau* r, double h) {
  int s = r->method.s;
  for (int i = 0; i < s; i++)
    pl_radau_slopes_at(run, r, &r->at[i], r->t[i], stage(r->Q, i, r->n_q), stage(r->V, i, r->n_q),
                       stage(r->A, i, r->n_q), stage(r->L, i, r->n_c));
  for (int i = 0; i < s; i++)
    for (int j = 0; j < s; j++) fill_block(r, run, i, j, h);
  return pl_lu_factor(r->coupled, r->coupled_pivot, r->coupled_scale, s * r->n) > 0;
}

void pl_radau_correct_coupled(pl_radau* r, const pl_run* run) {
  int s = r->method.s;
  for (int i = 0; i < s; i++)
    for (int e = 0; e < r->n; e++) stage(r->F, i, r->n)[e] *= rests(run, e) ? 0 : -1;
  pl_lu_solve(r->coupled, r->coupled_pivot, r->coupled_scale, r->F, r->coupled_work, s * r->n);
  apply(r);
}
