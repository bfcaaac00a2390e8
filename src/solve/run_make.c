// A run's workspace, from the dimensions of its setup.  After this nothing is allocated.
#include "solve/driver_impl.h"

#include <float.h>
#include <math.h>
#include <string.h>

// ------------------------------------------------------------------------------------------ checks
static pleuel_status check_constraints(pl_job* job, const pl_setup* s) {
  for (int c = 0; c < s->n_c; c++) {
    const pl_constraint_setup* l = &s->constraints[c];
    if (l->name == NULL) return pl_fail(job, PLEUEL_USAGE, "constraint %d has no name", c);
    if (l->side < -1 || l->side > 1)
      return pl_fail(job, PLEUEL_USAGE, "%s: side is -1, 0 or 1", l->name);
    if (l->contact >= s->n_c || l->contact == c
        || (l->contact >= 0 && s->constraints[l->contact].side == 0))
      return pl_fail(job, PLEUEL_USAGE, "%s goes with a contact that is none", l->name);
    for (int i = 0; i < l->n_needs; i++)
      if (l->needs[i] < 0 || l->needs[i] >= s->n_c || l->needs[i] == c)
        return pl_fail(job, PLEUEL_USAGE, "%s needs a constraint that is none", l->name);
    if (!(l->restitution >= 0 && l->restitution <= 1))
      return pl_fail(job, PLEUEL_USAGE, "%s: restitution is between 0 and 1", l->name);
  }
  return PLEUEL_OK;
}

static bool action_fits(const pl_setup* s, const pl_event_action* d) {
  switch (d->kind) {
    case PL_ACTION_STOP:
    case PL_ACTION_RECORD: return true;
    case PL_ACTION_RELEASE:
    case PL_ACTION_ATTACH: return d->target >= 0 && d->target < s->n_c;
    case PL_ACTION_SET_Q:
    case PL_ACTION_SET_V:
      return d->target >= 0 && d->target < s->n_q && d->value >= 0 && d->value < s->n_watched;
  }
  return false;
}

static pleuel_status check_events(pl_job* job, const pl_setup* s) {
  for (int e = 0; e < s->n_events; e++) {
    const pl_event_setup* event = &s->events[e];
    bool fits = event->watch >= 0 && event->watch < s->n_watched && event->name != NULL;
    for (int i = 0; i < event->n_actions; i++) fits = fits && action_fits(s, &event->actions[i]);
    if (!fits) return pl_fail(job, PLEUEL_USAGE, "event %d does not fit the setup", e);
  }
  for (int b = 0; b < s->n_branches; b++)
    if (s->branches[b].output < 0 || s->branches[b].output >= s->n_branch_outputs)
      return pl_fail(job, PLEUEL_USAGE, "branch %d does not fit the setup", b);
  return PLEUEL_OK;
}

static pleuel_status check_setup(pl_job* job, const pl_setup* s) {
  if (s->n_q <= 0 || s->n_c < 0) return pl_fail(job, PLEUEL_USAGE, "a run needs coordinates");
  if (s->kinetic >= s->n_out || s->potential >= s->n_out || s->energy < 0
      || (s->energy > 0 && s->energy >= s->n_out))
    return pl_fail(job, PLEUEL_USAGE, "no output column for the energy");
  for (int i = 0; i < s->n_q; i++)
    if (s->coordinates[i].name == NULL)
      return pl_fail(job, PLEUEL_USAGE, "coordinate %d has no name", i);
  for (int i = 0; i < s->n_attitudes; i++) {
    const pl_attitude_setup* t = &s->attitudes[i];
    const int of[4] = {t->scalar, t->angle[0], t->angle[1], t->angle[2]};
    for (int k = 0; k < 4; k++)
      if (of[k] < 0 || of[k] >= s->n_q)
        return pl_fail(job, PLEUEL_USAGE, "turn %d does not fit the setup", i);
  }
  for (int i = 0; i < s->n_poles; i++)
    if (s->poles[i] < 0 || s->poles[i] >= s->n_q)
      return pl_fail(job, PLEUEL_USAGE, "pole %d does not fit the setup", i);
  PL_TRY(check_constraints(job, s));
  return check_events(job, s);
}

static pleuel_status check_options(pl_job* job, const pl_run_options* o) {
  if (!isfinite(o->t_0) || !isfinite(o->t_end))
    return pl_fail(job, PLEUEL_USAGE, "the time range is not finite");
  if (!(o->tol >= 0 && o->tol < 1))
    return pl_fail(job, PLEUEL_USAGE, "the tolerance is a positive number below 1");
  if (!isfinite(o->dt) || o->dt < 0 || o->count < 0 || !isfinite(o->h_max) || o->h_max < 0)
    return pl_fail(job, PLEUEL_USAGE, "steps are positive");
  return PLEUEL_OK;
}

// ----------------------------------------------------------------------------------------- options
static void set_options(pl_run* run, const pl_run_options* o) {
  double length = fabs(o->t_end - o->t_0);
  run->options = *o;
  pl_steppers_choose(run);
  run->control.tol = run->stepper->tolerance(o);
  run->control.tol_raised = o->tol > 0 && o->tol < run->control.tol;
  for (int i = 0; i < run->n_steppers; i++)
    if (run->steppers[i]->plan) run->steppers[i]->plan(run);
  run->stats.precision = o->precision;
  run->stats.order = run->dae.use = run->control.use_last = run->order;
  run->control.grid_count = o->count;
  run->control.grid_dt = o->count > 0 ? (o->t_end - o->t_0) / (double)o->count
                                      : copysign(o->dt, o->t_end - o->t_0);
  if (o->dt == 0 && o->count == 0) run->control.grid_dt = 0;
  // a series sees the equations at the ends of its steps only: not fewer than this, whatever it
  // says
  run->control.h_plain = length / 16;
  run->control.row_gap = length / 50;
  static const double least[] = {
      [PL_PRECISION_DOUBLE] = 1e-13, [PL_PRECISION_LONG] = 1e-16, [PL_PRECISION_QUAD] = 1e-25};
  double of_t = o->precision == PL_PRECISION_DOUBLE ? 4 * DBL_EPSILON : least[o->precision];
  run->control.h_least = fmax(least[o->precision] * length,
                              of_t * fmax(fabs(o->t_0), fabs(o->t_end)));
  run->stats.energy_drift = run->stats.energy_0 = run->stats.t_singular = run->stats.t_implicit =
      (double)NAN;
}

// --------------------------------------------------------------------------------------- workspace
static void reserve_control(pl_run* run) {
  pl_arena* a = run->job->arena;
  pl_control* c = &run->control;
  double** of_q[] = {&c->trial_q, &c->trial_v, &c->row_q, &c->row_v, &c->row_a};
  for (size_t i = 0; i < sizeof of_q / sizeof *of_q; i++)
    *of_q[i] = PL_ARRAY(a, double, run->n_q + 1);
  c->row_l = PL_ARRAY(a, double, run->n_c + 1);
  c->energy_out = PL_ARRAY(a, double, run->setup->n_out + 1);
  run->branch_value = PL_ARRAY(a, double, run->setup->n_branch_outputs + 1);
}

static pleuel_status reserve_batches(pl_run* run) {
  const pl_setup* s = run->setup;
  int n_q = s->n_q, n_c = s->n_c;
  PL_TRY(pl_batches_make(run->job, &run->observers, s->observers, s->n_observers, 1,
                         n_q + 3 * s->n_attitudes, n_c, s->n_out));
  PL_TRY(pl_batches_make(run->job, &run->watched, s->watch, s->n_watch_patterns, run->order + 2,
                         n_q, n_c, s->n_watched));
  return pl_batches_make(run->job, &run->branches, s->branch_patterns, s->n_branch_patterns, 1, n_q,
                         n_c, s->n_branch_outputs);
}

static pleuel_status open_steppers(pl_run* run) {
  for (int i = 0; i < run->n_steppers; i++)
    if (run->steppers[i]->open) PL_TRY(run->steppers[i]->open(run));
  return PLEUEL_OK;
}

pleuel_status pl_run_make(pl_job* job, const pl_setup* setup, const pl_run_options* options,
                          pl_run** out) {
  PL_TRY(check_setup(job, setup));
  PL_TRY(check_options(job, options));
  pl_run* run = PL_NEW(job->arena, pl_run);
  run->job = job;
  run->setup = setup;
  run->n_q = setup->n_q;
  run->n_c = setup->n_c;
  set_options(run, options);
  run->observer = &pl_output_observer;
  reserve_control(run);
  PL_TRY(pl_dae_make(&run->dae, job, setup, run->order));
  PL_TRY(reserve_batches(run));
  pl_events_make(run);
  pl_output_make(run);
  pleuel_status how = open_steppers(run);
  if (how == PLEUEL_OK) *out = run;
  else pl_run_free(run);
  return how;
}

void pl_run_free(pl_run* run) {
  if (run == NULL) return;
  pl_kkt_free(&run->dae.kkt);
  for (int i = 0; i < run->n_steppers; i++)
    if (run->steppers[i]->close) run->steppers[i]->close(run);
  if (run->lead) run->lead->close(run->sensitivity);
}
