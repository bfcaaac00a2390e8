// A start of which part is given and exact, and the rest enters the constraints linearly: as the
// derivatives of a start that is known. What is not held moves by the least that meets the
// constraints, positions first, then velocities. Where what is held does not allow that, everything
// is left to the projection in the mass metric that begins a run.
#include <float.h>
#include <math.h>
#include <string.h>

#include "solve/solve_impl.h"

static const double dependent = 1e-10;  // of a row: what is left of it when it says nothing new
static const double met = 1e-9;         // residual of a constraint relative to its terms

// The least change of what is free that takes the residuals away: rows orthogonalised one by one,
// targets along.
bool pl_least_change(const pl_run* run, const bool* held, const double* residual,
                     const double* size, bool positions, double* basis, double* change) {
  int n = run->n_q, rank = 0;
  for (int i = 0; i < n; i++) change[i] = 0;
  for (int c = 0; c < run->n_c; c++) {
    if (run->row_of[c] < 0 || (positions && run->setup->constraints[c].velocity)) continue;
    double *w = basis + (size_t)rank * (size_t)n, left = -residual[c], length = 0, most = 0;
    const double* row = run->rows + (size_t)run->row_of[c] * (size_t)n;
    for (int i = 0; i < n; i++) {
      w[i] = held[i] ? 0 : row[i];
      most = fmax(most, fabs(row[i]));
    }
    for (int twice = 0; twice < 2; twice++) {
      for (int k = 0; k < rank; k++) {
        const double* u = basis + (size_t)k * (size_t)n;
        double along = 0;
        for (int i = 0; i < n; i++) along += u[i] * w[i];
        for (int i = 0; i < n; i++) w[i] -= along * u[i];
      }
    }
    // what the change so far does to this row
    for (int i = 0; i < n; i++) left -= held[i] ? 0 : row[i] * change[i];
    for (int i = 0; i < n; i++) length += w[i] * w[i];
    length = sqrt(length);
    if (length <= dependent * most) {
      if (fabs(left) > met * fmax(size[c], DBL_MIN)) return false;
      continue;
    }
    double along = 0;
    for (int i = 0; i < n; i++) along += w[i] * (held[i] ? 0 : row[i]);
    for (int i = 0; i < n; i++) change[i] += w[i] * left / along;
    for (int i = 0; i < n; i++) w[i] /= length;
    rank++;
  }
  return true;
}

static bool complete_positions(pl_run* run, double t, const bool* held, double* basis,
                               double* change) {
  pl_point_evaluate(run, t, run->q, run->v);
  pl_assemble_g(run, 0, run->g, run->g_size);
  pl_assemble_rows(run);
  if (!pl_least_change(run, held, run->g, run->g_size, true, basis, change)) return false;
  for (int i = 0; i < run->n_q; i++) run->q[i] += change[i];
  return true;
}

static bool complete_velocities(pl_run* run, double t, const bool* held, double* basis,
                                double* change) {
  pl_point_evaluate(run, t, run->q, run->v);
  pl_assemble_g(run, 0, run->g, run->g_size);
  pl_assemble_gdot(run, run->r, run->r_size);
  pl_assemble_rows(run);
  if (!pl_least_change(run, held, run->r, run->r_size, false, basis, change)) return false;
  for (int i = 0; i < run->n_q; i++) run->v[i] += change[i];
  return true;
}

pleuel_status pl_run_start_partly(pl_run* run, double t, const double* q, const double* v,
                                  const bool* held_q, const bool* held_v) {
  size_t n = (size_t)run->n_q;
  if (run->rows == NULL) return pl_run_start_at(run, t, q, v);
  pl_arena* a = run->job->arena;
  double *q_kept = PL_ARRAY(a, double, n + 1), *v_kept = PL_ARRAY(a, double, n + 1);
  pl_mark mark = pl_arena_mark(a);
  double *basis = PL_ARRAY(a, double, n*(size_t)(run->n_c + 1)),
         *change = PL_ARRAY(a, double, n + 1);
  memcpy(run->q, q, n * sizeof(double));
  memcpy(run->v, v, n * sizeof(double));
  pl_active_set_update(run);
  pl_sizes_note(run, q, v);
  if (!complete_positions(run, t, held_q, basis, change)) memcpy(run->q, q, n * sizeof(double));
  if (!complete_velocities(run, t, held_v, basis, change)) memcpy(run->v, v, n * sizeof(double));
  memcpy(q_kept, run->q, n * sizeof(double));
  memcpy(v_kept, run->v, n * sizeof(double));
  pl_arena_rewind(a, mark);  // before the start, which makes programs that stay
  return pl_run_start_at(run, t, q_kept, v_kept);
}
