// A run begins: from the consistent start that is searched for, or from numbers that are known.
#include "solve/start/start.h"
#include "solve/driver_impl.h"

#include <math.h>
#include <string.h>

static void set_sizes(pl_run* run) {
  run->dae.q_size = run->dae.v_size = 0;
  for (int i = 0; i < run->n_q; i++) run->dae.q_most[i] = run->dae.v_most[i] = 0;
  pl_sizes_note(&run->dae, run->dae.q, run->dae.v);
  pl_sizes_keep(&run->dae);
}

static pleuel_status pl_run_begin_at(pl_run* run, double t) {
  run->dae.t = t;
  run->dae.t_low = 0;
  set_sizes(run);
  run->stats.energy_drift = (double)NAN;
  run->dae.factored = false;
  PL_TRY(pl_modes_enter(run));
  run->stats.rank_start = run->stats.rank = run->dae.rank;
  run->event->smallest_here = run->dae.smallest;
  run->control.started = true;
  PL_TRY(pl_output_open(run));
  PL_TRY(pl_modes_check(run, true));
  pl_modes_size_rest(run);
  if (run->lead) PL_TRY(run->lead->begin(run->sensitivity));
  for (int k = 0; k < run->n_steppers; k++)
    if (run->steppers[k]->begin) PL_TRY(run->steppers[k]->begin(run, t));
  pl_output_energy(run, true);
  return PLEUEL_OK;
}

// One-sided constraints are in contact where they are met.
static void decide_contacts(pl_run* run, double t) {
  set_sizes(run);
  pl_point_evaluate(&run->dae, t, run->dae.q, run->dae.v);
  pl_assemble_g(&run->dae, 0, run->dae.g, run->dae.g_size);
  for (int c = 0; c < run->n_c; c++) {
    const pl_constraint_setup* constraint = &run->setup->constraints[c];
    if (constraint->side != 0 && !constraint->velocity)
      run->dae.on[c] = !run->dae.detached[c] && fabs(run->dae.g[c]) <= 1e-9 * run->dae.g_size[c];
  }
}

pleuel_status pl_run_start_at(pl_run* run, double t, const double* q, const double* v) {
  for (int i = 0; i < run->n_q; i++) {
    run->dae.q[i] = q[i];
    run->dae.v[i] = v[i];
    if (!isfinite(q[i]) || !isfinite(v[i]))
      return pl_fail(run->job, PLEUEL_USAGE, "the start value of %s is not a number",
                     run->setup->coordinates[i].name);
  }
  pl_watch_forget(run);
  run->control.start_given = false;
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
  pl_point_evaluate(&run->dae, t, run->dae.q, run->dae.v);
  pl_assemble_g(&run->dae, 0, run->dae.g, run->dae.g_size);
  pl_assemble_rows(&run->dae);
  if (!pl_least_change(&run->dae, held, run->dae.g, run->dae.g_size, true, basis, change))
    return false;
  for (int i = 0; i < run->n_q; i++) run->dae.q[i] += change[i];
  return true;
}

static bool complete_velocities(pl_run* run, double t, const bool* held, double* basis,
                                double* change) {
  pl_point_evaluate(&run->dae, t, run->dae.q, run->dae.v);
  pl_assemble_g(&run->dae, 0, run->dae.g, run->dae.g_size);
  pl_assemble_gdot(&run->dae, run->dae.r, run->dae.r_size);
  pl_assemble_rows(&run->dae);
  if (!pl_least_change(&run->dae, held, run->dae.r, run->dae.r_size, false, basis, change))
    return false;
  for (int i = 0; i < run->n_q; i++) run->dae.v[i] += change[i];
  return true;
}

pleuel_status pl_run_start_partly(pl_run* run, double t, const double* q, const double* v,
                                  const bool* held_q, const bool* held_v) {
  size_t n = (size_t)run->n_q;
  if (run->dae.rows == NULL) return pl_run_start_at(run, t, q, v);
  pl_arena* a = run->job->arena;
  double *q_kept = PL_ARRAY(a, double, n + 1), *v_kept = PL_ARRAY(a, double, n + 1);
  pl_mark mark = pl_arena_mark(a);
  double *basis = PL_ARRAY(a, double, n*(size_t)(run->n_c + 1)),
         *change = PL_ARRAY(a, double, n + 1);
  memcpy(run->dae.q, q, n * sizeof(double));
  memcpy(run->dae.v, v, n * sizeof(double));
  pl_active_set_update(&run->dae);
  pl_sizes_note(&run->dae, q, v);
  if (!complete_positions(run, t, held_q, basis, change)) memcpy(run->dae.q, q, n * sizeof(double));
  if (!complete_velocities(run, t, held_v, basis, change))
    memcpy(run->dae.v, v, n * sizeof(double));
  memcpy(q_kept, run->dae.q, n * sizeof(double));
  memcpy(v_kept, run->dae.v, n * sizeof(double));
  pl_arena_rewind(a, mark);  // before the start, which makes programs that stay
  return pl_run_start_at(run, t, q_kept, v_kept);
}

// ------------------------------------------------------------------------------------- from angles
pleuel_status pl_run_start_from_angles(pl_run* run, double t, const double* q, const double* v) {
  pl_attitude_start(&run->dae, t, q, v, run->control.row_q, run->control.row_v);
  return pl_run_start_at(run, t, run->control.row_q, run->control.row_v);
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
