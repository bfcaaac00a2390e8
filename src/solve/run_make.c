// A run's workspace, from the dimensions of its setup.  After this nothing is allocated.
#include "solve/solve_impl.h"
#include "solve/stepper/stepper.h"

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
  run->tol = run->stepper->tolerance(o);
  run->tol_raised = o->tol > 0 && o->tol < run->tol;
  for (int i = 0; i < run->n_steppers; i++)
    if (run->steppers[i]->plan) run->steppers[i]->plan(run);
  run->stats.precision = o->precision;
  run->stats.order = run->use = run->use_last = run->order;
  run->grid_count = o->count;
  run->grid_dt = o->count > 0 ? (o->t_end - o->t_0) / (double)o->count
                              : copysign(o->dt, o->t_end - o->t_0);
  if (o->dt == 0 && o->count == 0) run->grid_dt = 0;
  // a series sees the equations at the ends of its steps only: not fewer than this, whatever it
  // says
  run->h_plain = length / 16;
  run->row_gap = length / 50;
  static const double least[] = {
      [PL_PRECISION_DOUBLE] = 1e-13, [PL_PRECISION_LONG] = 1e-16, [PL_PRECISION_QUAD] = 1e-25};
  double of_t = o->precision == PL_PRECISION_DOUBLE ? 4 * DBL_EPSILON : least[o->precision];
  run->h_least = fmax(least[o->precision] * length, of_t * fmax(fabs(o->t_0), fabs(o->t_end)));
  run->stats.energy_drift = run->stats.energy_0 = run->stats.t_singular = run->stats.t_implicit =
      (double)NAN;
  run->last_row_t = (double)NAN;
}

// --------------------------------------------------------------------------------------- workspace
static void reserve_state(pl_run* run) {
  pl_arena* a = run->job->arena;
  size_t q = (size_t)run->n_q, c = (size_t)run->n_c, orders = (size_t)run->order + 2;
  double** of_q[] = {&run->q,       &run->v,      &run->trial_q, &run->trial_v, &run->save_q,
                     &run->save_v,  &run->save_a, &run->row_q,   &run->row_v,   &run->row_a,
                     &run->jump_v,  &run->column, &run->jump_q,  &run->hold_q,  &run->hold_v,
                     &run->first_a, &run->end_a,  &run->q_most,  &run->v_most,  &run->q_kept,
                     &run->v_kept};
  double** of_c[] = {&run->g,
                     &run->g_size,
                     &run->r,
                     &run->r_size,
                     &run->save_l,
                     &run->row_l,
                     &run->impulse,
                     &run->row_most,
                     &run->argument,
                     &run->row_long,
                     &run->row_part,
                     &run->rank_work,
                     &run->impact_factor};
  bool** flags[] = {&run->on,          &run->detached,    &run->active,       &run->taken,
                    &run->unique,      &run->save_unique, &run->row_taken,    &run->taken_kept,
                    &run->slips,       &run->near_by,     &run->rebounds,     &run->on_before,
                    &run->jumped,      &run->met,         &run->impact_taken, &run->several,
                    &run->ever_several};
  for (size_t i = 0; i < sizeof of_q / sizeof *of_q; i++) *of_q[i] = PL_ARRAY(a, double, q + 1);
  for (size_t i = 0; i < sizeof of_c / sizeof *of_c; i++) *of_c[i] = PL_ARRAY(a, double, c + 1);
  for (size_t i = 0; i < sizeof flags / sizeof *flags; i++) *flags[i] = PL_ARRAY(a, bool, c + 1);
  double** series_q[] = {&run->Q, &run->V, &run->A, &run->Q_last, &run->V_last, &run->A_last};
  double** series_c[] = {&run->L, &run->L_last, &run->G_series};
  for (size_t i = 0; i < sizeof series_q / sizeof *series_q; i++)
    *series_q[i] = PL_ARRAY(a, double, q* orders + 1);
  for (size_t i = 0; i < sizeof series_c / sizeof *series_c; i++)
    *series_c[i] = PL_ARRAY(a, double, c* orders + 1);
  double** of_contacts[] = {&run->approach, &run->second, &run->second_size, &run->fastest,
                            &run->settled_t};
  for (size_t i = 0; i < sizeof of_contacts / sizeof *of_contacts; i++)
    *of_contacts[i] = PL_ARRAY(a, double, c + 1);
  for (size_t i = 0; i < c; i++) run->settled_t[i] = (double)NAN;
  size_t decisions = c + (size_t)run->setup->n_frictions + 1;
  run->decision = PL_ARRAY(a, pl_decision, decisions);
  run->choice_kept = PL_ARRAY(a, int, decisions);
  run->fixed = PL_ARRAY(a, unsigned, c + 1);
  run->bounce_t = PL_ARRAY(a, double, 3 * c + 1);
  run->bounces = PL_ARRAY(a, long, c + 1);
  run->at_friction = PL_ARRAY(a, int, c + 1);
  run->rhs = PL_ARRAY(a, double, q + c + 1);
  run->has_equation = PL_ARRAY(a, int, q + 1);
}

static void reserve_ranks(pl_run* run) {
  pl_arena* a = run->job->arena;
  size_t q = (size_t)run->n_q, c = (size_t)run->n_c;
  run->priority = PL_ARRAY(a, int, c + 1);
  run->row_of = PL_ARRAY(a, int, c + 1);
  if (c > PL_RANK_UP_TO) return;
  run->rows = PL_ARRAY(a, double, q* c + 1);
  run->dep = PL_ARRAY(a, double, q* c + 1);
  run->dep_tau = PL_ARRAY(a, double, c + 1);
  run->dep_norm = PL_ARRAY(a, double, 2 * c + q + 1);
  run->dep_jpvt = PL_ARRAY(a, int, 2 * c + 1);
}

static void reserve_rows(pl_run* run) {
  pl_arena* a = run->job->arena;
  const pl_setup* s = run->setup;
  size_t orders = (size_t)run->order + 2;
  double** of_out[] = {&run->out_now, &run->out_before, &run->energy_out};
  for (size_t i = 0; i < sizeof of_out / sizeof *of_out; i++)
    *of_out[i] = PL_ARRAY(a, double, s->n_out + 1);
  run->W_series = PL_ARRAY(a, double, (size_t)s->n_watched* orders + 1);
  run->W_coef = PL_ARRAY(a, double, s->n_watched + 1);
  run->branch_value = PL_ARRAY(a, double, s->n_branch_outputs + 1);
  run->poly = PL_ARRAY(a, double, orders + 1);
  run->root_work = PL_ARRAY(a, double, PL_ROOT_WORK(orders));
  run->mode_size = sizeof "free";
  for (int c = 0; c < s->n_c; c++)
    run->mode_size += strlen(s->constraints[c].name) + sizeof " contact()";
  for (int r = 0; r < s->n_frictions; r++)
    run->mode_size += strlen(s->frictions[r].name) + sizeof " stick()";
  run->mode = PL_ARRAY(a, char, run->mode_size);
  run->mode_before = PL_ARRAY(a, char, run->mode_size);
}

static pleuel_status reserve_batches(pl_run* run) {
  const pl_setup* s = run->setup;
  int n_q = s->n_q, n_c = s->n_c;
  run->motion.lean = s->n_frictions == 0;
  for (int c = 0; c < n_c; c++) run->motion.lean &= s->constraints[c].side == 0;
  PL_TRY(pl_batches_make(run->job, &run->motion, s->patterns, s->n_patterns, run->order + 2, n_q,
                         n_c, INT32_MAX));
  PL_TRY(pl_batches_make(run->job, &run->observers, s->observers, s->n_observers, 1,
                         n_q + 3 * s->n_attitudes, n_c, s->n_out));
  PL_TRY(pl_batches_make(run->job, &run->watched, s->watch, s->n_watch_patterns, run->order + 2,
                         n_q, n_c, s->n_watched));
  return pl_batches_make(run->job, &run->branches, s->branch_patterns, s->n_branch_patterns, 1, n_q,
                         n_c, s->n_branch_outputs);
}

// -------------------------------------------------------------------------- what the patterns hold
static pleuel_status check_rows(pl_run* run) {
  int* owner = PL_ARRAY(run->job->arena, int, run->n_c + 1);
  for (int i = 0; i < run->motion.n; i++) {
    const pl_batch* b = &run->motion.at[i];
    const pl_pattern* p = b->pattern;
    run->has_W |= p->n_W > 0;
    for (int e = 0; e < p->n_mass; e++)
      run->mass_of_velocity |= p->tape->roots[p->mass[e].root]
                               >= p->tape->level_end[PL_LEVEL_POSITION];
    for (int e = 0; e < p->n_g; e++)
      for (int l = 0; l < b->n; l++)
        if (owner[b->c[p->g[e].row * b->lanes + l]]++)
          return pl_fail(run->job, PLEUEL_USAGE, "constraint %s stands in two places",
                         run->setup->constraints[b->c[p->g[e].row * b->lanes + l]].name);
  }
  return PLEUEL_OK;
}

static void first_mode(pl_run* run) {
  for (int c = 0; c < run->n_c; c++) {
    run->detached[c] = run->setup->constraints[c].off || run->setup->constraints[c].slip;
    run->on[c] = !run->detached[c];
  }
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
  reserve_state(run);
  reserve_ranks(run);
  reserve_rows(run);
  pl_attitude_make(run);
  PL_TRY(reserve_batches(run));
  PL_TRY(check_rows(run));
  PL_TRY(pl_kkt_make(run));
  run->observer = &pl_output_observer;
  pl_friction_make(run);
  pl_indeterminate_make(run);
  pl_watch_make(run);
  pl_switching_make(run);
  first_mode(run);
  pleuel_status how = open_steppers(run);
  if (how == PLEUEL_OK) *out = run;
  else pl_run_free(run);
  return how;
}

void pl_run_free(pl_run* run) {
  if (run == NULL) return;
  pl_kkt_free(&run->kkt);
  for (int i = 0; i < run->n_steppers; i++)
    if (run->steppers[i]->close) run->steppers[i]->close(run);
  pl_sensitivity_free(run->sensitivity);
}
