// A run begins: from the consistent start that is searched for, or from numbers that are known.
#include "solve/start/start.h"
#include "solve/stepper/stepper.h"

#include <math.h>
#include <string.h>

static void set_sizes(pl_run* run) {
  run->q_size = run->v_size = 0;
  for (int i = 0; i < run->n_q; i++) run->q_most[i] = run->v_most[i] = 0;
  pl_sizes_note(run, run->q, run->v);
  pl_sizes_keep(run);
}

pleuel_status pl_run_begin_at(pl_run* run, double t) {
  run->t = t;
  run->t_low = 0;
  set_sizes(run);
  run->stats.energy_drift = (double)NAN;
  run->factored = false;
  PL_TRY(pl_modes_enter(run));
  run->stats.rank_start = run->stats.rank = run->rank;
  run->smallest_here = run->smallest;
  run->started = true;
  PL_TRY(pl_output_open(run));
  PL_TRY(pl_modes_check(run, true));
  pl_modes_size_rest(run);
  if (run->sensitivity) PL_TRY(pl_sensitivity_begin(run->sensitivity));
  for (int k = 0; k < run->n_steppers; k++)
    if (run->steppers[k]->begin) PL_TRY(run->steppers[k]->begin(run, t));
  pl_output_energy(run, true);
  return PLEUEL_OK;
}

// One-sided constraints are in contact where they are met.
static void decide_contacts(pl_run* run, double t) {
  set_sizes(run);
  pl_point_evaluate(run, t, run->q, run->v);
  pl_assemble_g(run, 0, run->g, run->g_size);
  for (int c = 0; c < run->n_c; c++) {
    const pl_constraint_setup* constraint = &run->setup->constraints[c];
    if (constraint->side != 0 && !constraint->velocity)
      run->on[c] = !run->detached[c] && fabs(run->g[c]) <= 1e-9 * run->g_size[c];
  }
}

pleuel_status pl_run_start_at(pl_run* run, double t, const double* q, const double* v) {
  for (int i = 0; i < run->n_q; i++) {
    run->q[i] = q[i];
    run->v[i] = v[i];
    if (!isfinite(q[i]) || !isfinite(v[i]))
      return pl_fail(run->job, PLEUEL_USAGE, "the start value of %s is not a number",
                     run->setup->coordinates[i].name);
  }
  pl_watch_forget(run);
  run->start_given = false;
  decide_contacts(run, t);
  return pl_run_begin_at(run, t);
}

// ------------------------------------------------------------------------------- from what is held
// A start of which part is given and exact, and the rest enters the constraints linearly: as the
// derivatives of a start that is known. What is not held moves by the least that meets the
// constraints, positions first, then velocities. Where what is held does not allow that, everything
// is left to the projection in the mass metric that begins a run.
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

// ------------------------------------------------------------------------------------- from angles
pleuel_status pl_run_start_from_angles(pl_run* run, double t, const double* q, const double* v) {
  pl_attitude_start(run, t, q, v, run->row_q, run->row_v);
  return pl_run_start_at(run, t, run->row_q, run->row_v);
}

// --------------------------------------------------------------------------------------- by search
pleuel_status pl_run_start(pl_run* run) {
  pl_start* start;
  PL_TRY(pl_start_find(run, &start));
  if (!run->options.start_only) PL_TRY(pl_run_begin_at(run, run->options.t_0));
  pl_start_list(start);
  return PLEUEL_OK;
}

const pl_start_report* pl_run_start_report(const pl_run* run) { return &run->start; }
