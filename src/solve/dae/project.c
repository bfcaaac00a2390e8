// Projection on the constraints in the mass metric: positions onto g = 0, then velocities onto G v
// + dg/dt = 0.
//
// Each correction is [M G^T; G 0] [δ; μ] = [0; -residual] with the rows that are independent; the
// residuals are measured on all active rows, so that what was left out is watched too.
// See theory (12.1).
#include "solve/dae/dae.h"

#include <float.h>
#include <math.h>

enum { MAX_NEWTON = 8 };

static void find_largest(double x, double* most) {
  if (!(x <= *most)) *most = x;  // NaN comes through
}

// The coarsest rounding among the rows that are taken, as a length of coordinates.
static double coarsest(const pl_dae* dae, const double* size, bool positions) {
  double most = 0;
  for (int c = 0; c < dae->n_c; c++) {
    if (!dae->taken[c] || !(dae->row_most[c] > 0)
        || (positions && dae->setup->constraints[c].velocity))
      continue;
    most = fmax(most, size[c] / dae->row_most[c]);
  }
  return most;
}

// A row that was left out is met as exactly as those it follows from, not as exactly as its own
// terms would allow.
double pl_residual(const pl_dae* dae, const double* g, const double* size, bool positions) {
  double most = 0, rough = dae->rank < dae->n_active ? coarsest(dae, size, positions) : 0;
  for (int c = 0; c < dae->n_c; c++) {
    if (!dae->active[c] || g[c] == 0 || (positions && dae->setup->constraints[c].velocity))
      continue;
    most = pl_size_with(
        most, g[c] / (dae->taken[c] ? size[c] : pl_larger(size[c], rough * dae->row_most[c])));
  }
  return most;
}

static void solve_correction(pl_dae* dae, const double* residual, bool positions) {
  for (int i = 0; i < dae->n_q; i++) dae->rhs[i] = 0;
  for (int c = 0; c < dae->n_c; c++) {
    bool counts = dae->taken[c] && !(positions && dae->setup->constraints[c].velocity);
    dae->rhs[dae->n_q + c] = counts ? -residual[c] : 0;
  }
  pl_kkt_solve(&dae->kkt, dae->rhs);
}

// Newton until the residual is rounding or no longer falls. The last factor belongs to the
// corrected point.
static bool project_positions(pl_dae* dae, double t, double* q, const double* v, pl_projection* p) {
  double before = (double)INFINITY;
  for (int round = 0; round < MAX_NEWTON; round++) {
    pl_point_evaluate(dae, t, q, v);
    pl_assemble_g(dae, 0, dae->g, dae->g_size);
    double g = pl_residual(dae, dae->g, dae->g_size, true);
    if (round == 0) p->g_before = g;
    p->g_after = g;
    pl_active_set_choose(dae);
    if (!isfinite(g) || !pl_point_factor(dae, false)) return false;
    if (g == 0 || (round > 0 && (g <= 2 * DBL_EPSILON || g >= 0.5 * before))) return true;
    before = g;
    solve_correction(dae, dae->g, true);
    double move = pl_norm(dae->rhs, dae->n_q);
    if (!isfinite(move)) return false;
    for (int i = 0; i < dae->n_q; i++) q[i] += dae->rhs[i];
    find_largest(dae->q_size > 0 ? move / dae->q_size : move, &p->move_q);
  }
  return false;
}

static bool project_velocities(pl_dae* dae, double* v, pl_projection* p) {
  for (int round = 0;; round++) {
    pl_batches_load_v(&dae->motion, v, 0);
    pl_assemble_gdot(dae, dae->r, dae->r_size);
    double r = pl_residual(dae, dae->r, dae->r_size, false);
    if (round == 0) p->r_before = r;
    p->r_after = r;
    if (!isfinite(r)) return false;
    if (round > 0 || r == 0) return true;
    solve_correction(dae, dae->r, false);
    double move = pl_norm(dae->rhs, dae->n_q);
    if (!isfinite(move)) return false;
    for (int i = 0; i < dae->n_q; i++) v[i] += dae->rhs[i];
    find_largest(dae->v_size > 0 ? move / dae->v_size : move, &p->move_v);
  }
}

pl_projection pl_project(pl_dae* dae, double t, double* q, double* v) {
  pl_projection p = {0};
  dae->at_point = false;
  pl_sizes_note(dae, q, v);
  p.ok = project_positions(dae, t, q, v, &p) && project_velocities(dae, v, &p);
  dae->factored = p.ok && !dae->has_W && !dae->mass_of_velocity;
  return p;
}
