// Projection on the constraints in the mass metric: positions onto g = 0, then velocities onto G v
// + dg/dt = 0.
//
// Each correction is [M G^T; G 0] [δ; μ] = [0; -residual] with the rows that are independent; the
// residuals are measured on all active rows, so that what was left out is watched too.
// See theory (12.1).
#include "solve/solve_impl.h"

#include <float.h>
#include <math.h>

enum { MAX_NEWTON = 8 };

static void find_largest(double x, double* most) {
  if (!(x <= *most)) *most = x;  // NaN comes through
}

// The coarsest rounding among the rows that are taken, as a length of coordinates.
static double coarsest(const pl_run* run, const double* size, bool positions) {
  double most = 0;
  for (int c = 0; c < run->n_c; c++) {
    if (!run->taken[c] || !(run->row_most[c] > 0)
        || (positions && run->setup->constraints[c].velocity))
      continue;
    most = fmax(most, size[c] / run->row_most[c]);
  }
  return most;
}

// A row that was left out is met as exactly as those it follows from, not as exactly as its own
// terms would allow.
double pl_residual(const pl_run* run, const double* g, const double* size, bool positions) {
  double most = 0, rough = run->rank < run->n_active ? coarsest(run, size, positions) : 0;
  for (int c = 0; c < run->n_c; c++) {
    if (!run->active[c] || g[c] == 0 || (positions && run->setup->constraints[c].velocity))
      continue;
    most = pl_size_with(
        most, g[c] / (run->taken[c] ? size[c] : pl_larger(size[c], rough * run->row_most[c])));
  }
  return most;
}

static void solve_correction(pl_run* run, const double* residual, bool positions) {
  for (int i = 0; i < run->n_q; i++) run->rhs[i] = 0;
  for (int c = 0; c < run->n_c; c++) {
    bool counts = run->taken[c] && !(positions && run->setup->constraints[c].velocity);
    run->rhs[run->n_q + c] = counts ? -residual[c] : 0;
  }
  pl_kkt_solve(&run->kkt, run->rhs);
}

// Newton until the residual is rounding or no longer falls. The last factor belongs to the
// corrected point.
static bool project_positions(pl_run* run, double t, double* q, const double* v, pl_projection* p) {
  double before = (double)INFINITY;
  for (int round = 0; round < MAX_NEWTON; round++) {
    pl_point_evaluate(run, t, q, v);
    pl_assemble_g(run, 0, run->g, run->g_size);
    double g = pl_residual(run, run->g, run->g_size, true);
    if (round == 0) p->g_before = g;
    p->g_after = g;
    pl_active_set_choose(run);
    if (!isfinite(g) || !pl_point_factor(run, false)) return false;
    if (g == 0 || (round > 0 && (g <= 2 * DBL_EPSILON || g >= 0.5 * before))) return true;
    before = g;
    solve_correction(run, run->g, true);
    double move = pl_norm(run->rhs, run->n_q);
    if (!isfinite(move)) return false;
    for (int i = 0; i < run->n_q; i++) q[i] += run->rhs[i];
    find_largest(run->q_size > 0 ? move / run->q_size : move, &p->move_q);
  }
  return false;
}

static bool project_velocities(pl_run* run, double* v, pl_projection* p) {
  for (int round = 0;; round++) {
    pl_batches_load_v(&run->motion, v, 0);
    pl_assemble_gdot(run, run->r, run->r_size);
    double r = pl_residual(run, run->r, run->r_size, false);
    if (round == 0) p->r_before = r;
    p->r_after = r;
    if (!isfinite(r)) return false;
    if (round > 0 || r == 0) return true;
    solve_correction(run, run->r, false);
    double move = pl_norm(run->rhs, run->n_q);
    if (!isfinite(move)) return false;
    for (int i = 0; i < run->n_q; i++) v[i] += run->rhs[i];
    find_largest(run->v_size > 0 ? move / run->v_size : move, &p->move_v);
  }
}

pl_projection pl_project(pl_run* run, double t, double* q, double* v) {
  pl_projection p = {0};
  run->at_point = false;
  pl_sizes_note(run, q, v);
  p.ok = project_positions(run, t, q, v, &p) && project_velocities(run, v, &p);
  run->factored = p.ok && !run->has_W && !run->mass_of_velocity;
  return p;
}

// Velocity jump of an impact: the factor belongs to the point.  factor 1: inelastic.
void pl_impulse(pl_run* run, double* v, double factor, double* impulse) {
  pl_batches_load_v(&run->motion, v, 0);
  pl_assemble_gdot(run, run->r, run->r_size);
  solve_correction(run, run->r, false);
  for (int i = 0; i < run->n_q; i++) v[i] += factor * run->rhs[i];
  for (int c = 0; c < run->n_c; c++)
    impulse[c] = run->taken[c] || run->slips[c] ? -factor * run->rhs[run->n_q + c] : 0;
}
