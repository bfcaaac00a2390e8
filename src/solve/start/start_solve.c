// Solving the constraints with given values held.
//
// Positions: damped Gauss-Newton, each correction of least length. Velocities: linear, of least
// kinetic energy. Both use the linear system of the run with the rows and columns of held
// coordinates replaced by 1.
// See theory (12.1).
#include "solve/start/start_impl.h"

#include <float.h>
#include <math.h>

enum { MAX_ROUNDS = 60 };

// relative residual that counts as met; the projection does the rest
static const double met = 1e-9;
static const double done = 4 * DBL_EPSILON;

// --------------------------------------------------------------------------------------- residuals
static double largest(const pl_run* run, const double* g, const double* size, bool positions,
                      int* worst) {
  double most = 0;
  *worst = -1;
  for (int c = 0; c < run->n_c; c++) {
    if (!run->dae.active[c] || (positions && run->setup->constraints[c].velocity) || g[c] == 0)
      continue;
    double r = fabs(g[c]) / size[c];
    if (r <= most) continue;
    most = isnan(r) ? (double)INFINITY : r;
    *worst = c;
  }
  return most;
}

// row_v is zero throughout the start.
double pl_start_residual(pl_start* s, const double* q, int* worst) {
  pl_run* run = s->run;
  run->dae.q_size = 0;
  for (int i = 0; i < run->n_q; i++) run->dae.q_most[i] = 0;
  pl_sizes_note(&run->dae, q, run->control.row_v);
  pl_point_evaluate(&run->dae, run->options.t_0, q, s->v);
  pl_assemble_g(&run->dae, 0, run->dae.g, run->dae.g_size);
  return largest(run, run->dae.g, run->dae.g_size, true, worst);
}

static double pl_start_velocity_residual(pl_start* s, const double* v, int* worst) {
  pl_run* run = s->run;
  run->dae.v_size = 0;
  for (int i = 0; i < run->n_q; i++) run->dae.v_most[i] = 0;
  pl_sizes_note(&run->dae, run->control.row_v, v);
  pl_batches_load_v(&run->dae.motion, v, 0);
  pl_assemble_gdot(&run->dae, run->dae.r, run->dae.r_size);
  // relative to its terms alone: what rounding of large coordinates adds is without bound where the
  // terms of g cancel
  for (int c = 0; c < run->n_c; c++) run->dae.r_size[c] /= fmax(run->dae.argument[c], 1);
  return largest(run, run->dae.r, run->dae.r_size, false, worst);
}

// -------------------------------------------------------------------------------------------- rank
// Too many rows to compare: all are taken that have something left to move.
static int take_all_that_move(pl_run* run, const bool* held, bool positions) {
  int n = 0;
  for (int c = 0; c < run->n_c; c++) run->dae.taken[c] = false;
  for (int i = 0; i < run->dae.motion.n; i++) {
    const pl_batch* b = &run->dae.motion.at[i];
    for (int e = 0; e < b->pattern->n_G; e++) {
      const pl_pattern_entry* g = &b->pattern->G[e];
      const double* x = pl_jet_at(b->jet, b->pattern->tape->roots[g->root], 0);
      for (int l = 0; l < b->n; l++) {
        int c = b->c[g->row * b->lanes + l];
        if (x[l] == 0 || held[b->q[g->col * b->lanes + l]] || !run->dae.active[c]) continue;
        if (!positions || !run->setup->constraints[c].velocity) run->dae.taken[c] = true;
      }
    }
  }
  for (int c = 0; c < run->n_c; c++) n += run->dae.taken[c];
  return n;
}

// Rows of G without the columns of what is held.  Positions: velocity constraints say nothing.
static int choose(pl_start* s, const bool* held, bool positions) {
  pl_run* run = s->run;
  int n = run->n_q;
  if (run->dae.n_active > PL_RANK_UP_TO) return take_all_that_move(run, held, positions);
  pl_assemble_rows(&run->dae);
  for (int c = 0; c < run->n_c; c++) {
    if (run->dae.row_of[c] < 0) continue;
    double* row = run->dae.rows + (size_t)run->dae.row_of[c] * (size_t)n;
    bool none = positions && run->setup->constraints[c].velocity;
    double most = 0, most_free = 0;
    for (int j = 0; j < n; j++) {
      most = fmax(most, fabs(row[j]));
      if (held[j] || none) row[j] = 0;
      most_free = fmax(most_free, fabs(row[j]));
    }
    // what rounding leaves of a gradient that is zero
    for (int j = 0; j < n && most_free < 1e-13 * most; j++) row[j] = 0;
  }
  double smallest;
  int rank = pl_independent_rows(run->dae.rows, run->dae.priority, run->dae.row_taken,
                                 run->dae.rank_work, run->dae.n_active, n, 1e-9, &smallest);
  for (int c = 0; c < run->n_c; c++)
    run->dae.taken[c] = run->dae.row_of[c] >= 0 && run->dae.row_taken[run->dae.row_of[c]];
  return rank;
}

int pl_start_rank(pl_start* s, const bool* held) { return choose(s, held, true); }

// ----------------------------------------------------------------------------------- linear system
static bool is_held(const pl_run* run, const bool* held, int i) { return i < run->n_q && held[i]; }

static void edit(pl_run* run, const bool* held, int row, int col, double* x, bool plain) {
  bool both_q = row < run->n_q && col < run->n_q;
  if (is_held(run, held, row) || is_held(run, held, col)) *x = row == col;
  else if (both_q && plain) *x = row == col;
}

// plain: the identity takes the place of M.
static bool factor(pl_start* s, const bool* held, bool plain) {
  pl_run* run = s->run;
  pl_kkt* k = &run->dae.kkt;
  pl_assemble_matrix(&run->dae, false);
  for (int col = 0; col < k->n; col++) {
    int from = k->dense ? col * k->n : k->start[col],
        to = k->dense ? from + k->n : k->start[col + 1];
    for (int e = from; e < to; e++)
      edit(run, held, k->dense ? e - from : k->row[e], col, &k->value[e], plain);
  }
  return pl_kkt_factor(k);
}

// --------------------------------------------------------------------------------------- positions
static bool correction(pl_start* s, const bool* held) {
  pl_run* run = s->run;
  choose(s, held, true);
  if (!factor(s, held, true)) return false;
  for (int i = 0; i < run->n_q; i++) run->dae.rhs[i] = 0;
  for (int c = 0; c < run->n_c; c++)
    run->dae.rhs[run->n_q + c] = run->dae.taken[c] ? -run->dae.g[c] : 0;
  pl_kkt_solve(&run->dae.kkt, run->dae.rhs);
  return isfinite(pl_norm(run->dae.rhs, run->n_q));
}

// Sum of squares of residuals, each in units of its terms at the start of the line search.
static double merit(const pl_run* run, const double* g, const double* size) {
  double sum = 0;
  for (int c = 0; c < run->n_c; c++)
    if (run->dae.active[c] && !run->setup->constraints[c].velocity && g[c] != 0)
      sum += (g[c] / size[c]) * (g[c] / size[c]);
  return sum;
}

// Halves the correction in run->dae.rhs until it helps; false when it never does.
static bool line_search(pl_start* s, double* residual, int* worst) {
  pl_run* run = s->run;
  double* size = run->control.row_l;  // free here
  double before;
  for (int c = 0; c < run->n_c; c++) size[c] = run->dae.g_size[c];
  before = merit(run, run->dae.g, size);
  for (double part = 1; part > 1e-5; part *= 0.5) {
    for (int i = 0; i < run->n_q; i++) s->try_q[i] = s->q[i] + part * run->dae.rhs[i];
    *residual = pl_start_residual(s, s->try_q, worst);
    double after = merit(run, run->dae.g, size);
    if (!(after < before * (1 - 0.2 * part))) continue;
    for (int i = 0; i < run->n_q; i++) s->q[i] = s->try_q[i];
    return true;
  }
  *residual = pl_start_residual(s, s->q, worst);
  return false;
}

bool pl_start_positions(pl_start* s, const bool* held) {
  double residual = pl_start_residual(s, s->q, &s->worst_constraint);
  for (int round = 0; round < MAX_ROUNDS && residual > done && isfinite(residual); round++) {
    if (!correction(s, held) || !line_search(s, &residual, &s->worst_constraint)) break;
  }
  s->worst = residual;
  return residual <= met;
}

// -------------------------------------------------------------------------------------- velocities
// [M G^T; G 0] [v; μ] = [M v_guess; -dg/dt] with held velocities in their places.
static bool solve_velocities(pl_start* s, const bool* held, bool plain) {
  pl_run* run = s->run;
  pl_kkt* k = &run->dae.kkt;
  int n = run->n_q;
  pl_assemble_matrix(&run->dae, false);
  for (int i = 0; i < k->n; i++) run->dae.rhs[i] = 0;
  for (int c = 0; c < run->n_c; c++) run->dae.rhs[n + c] = run->dae.taken[c] ? -run->dae.r[c] : 0;
  // held columns to the right; the guess enters through M
  for (int col = 0; col < n; col++) {
    int from = k->dense ? col * k->n : k->start[col],
        to = k->dense ? from + k->n : k->start[col + 1];
    double guess = run->setup->coordinates[col].has_v_guess ? run->setup->coordinates[col].v_guess
                                                            : 0;
    for (int e = from; e < to; e++) {
      int row = k->dense ? e - from : k->row[e];
      double x = row < n && plain ? row == col : k->value[e];
      if (held[col]) run->dae.rhs[row] -= x * s->v[col];
      if (row < n) run->dae.rhs[row] += x * guess;
    }
  }
  for (int i = 0; i < n; i++)
    if (held[i]) run->dae.rhs[i] = s->v[i];
  if (!factor(s, held, plain)) return false;
  pl_kkt_solve(k, run->dae.rhs);
  if (!isfinite(pl_norm(run->dae.rhs, n))) return false;
  for (int i = 0; i < n; i++)
    if (!held[i]) s->v[i] = run->dae.rhs[i];
  return true;
}

bool pl_start_velocities(pl_start* s, const bool* held) {
  pl_run* run = s->run;
  for (int i = 0; i < run->n_q; i++) run->control.row_v[i] = 0;
  // dg/dt alone
  pl_point_evaluate(&run->dae, run->options.t_0, s->q, run->control.row_v);
  pl_assemble_gdot(&run->dae, run->dae.r, run->dae.r_size);
  choose(s, held, false);
  bool solved = solve_velocities(s, held, false) || solve_velocities(s, held, true);
  pl_point_evaluate(&run->dae, run->options.t_0, s->q, s->v);
  s->worst = pl_start_velocity_residual(s, s->v, &s->worst_constraint);
  return solved && s->worst <= met;
}
