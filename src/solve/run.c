// A run takes steps: series, roots on the step, projection, check, rows.
#include "solve/driver_impl.h"

#include <float.h>
#include <math.h>
#include <string.h>

// ------------------------------------------------------------------------------------- one attempt
static void note(pl_run* run, const pl_projection* p, double h) {
  pl_stats* s = &run->stats;
  s->steps++;
  s->max_g = pl_larger(s->max_g, p->g_after);
  s->max_gdot = pl_larger(s->max_gdot, p->r_after);
  s->max_projection = pl_larger(s->max_projection, pl_larger(p->move_q, p->move_v));
  if (h != 0) {
    s->h_min = s->h_min == 0 ? fabs(h) : pl_smaller(s->h_min, fabs(h));
    s->h_max = pl_larger(s->h_max, fabs(h));
  }
}

// t + h with the rounding error carried along.
static void advance_time(pl_run* run, double h, bool to_end) {
  double add = h + run->dae.t_low, t = run->dae.t + add;
  run->dae.t_low = add - (t - run->dae.t);
  run->dae.t = t;
  if (!to_end) return;
  run->dae.t = run->control.stop.early ? run->control.stop.t : run->options.t_end;
  run->dae.t_low = run->control.stop.early ? run->control.stop.t_low : 0;
}

// ------------------------------------------------------------------------------------------ a step
static void accept(pl_run* run, double h, bool to_end) {
  pl_series_swap(&run->dae);
  run->control.t_last = run->dae.t_series;
  run->dae.smallest_before = run->event->smallest_here;
  run->event->t_before = run->dae.t;
  run->control.h_last = h;
  run->control.use_last = run->dae.use;
  advance_time(run, h, to_end);
  if (run->stepper->accept) run->stepper->accept(run, to_end);
  memcpy(run->dae.q, run->control.trial_q, (size_t)run->n_q * sizeof(double));
  memcpy(run->dae.v, run->control.trial_v, (size_t)run->n_q * sizeof(double));
  pl_sizes_keep(&run->dae);
  run->control.a_rough *= 0.9;
}

static pleuel_status check_energy(pl_run* run) {
  double limit = pl_larger(1e-8, 1e5 * run->control.tol);
  if (!run->setup->energy_conserved || !(run->stats.energy_drift > limit)) return PLEUEL_OK;
  return pl_fail(
      run->job, PLEUEL_NUMERICAL,
      "the energy has drifted by %.2g of its size at t = %.9g s: the result cannot be trusted",
      run->stats.energy_drift, run->dae.t);
}

static pleuel_status arrive_at_point(pl_run* run) {
  if (!run->stepper->enter(run)) return pl_run_undetermined(run);
  if (!run->dae.at_point) pl_assemble_row_sizes(&run->dae);
  pl_singular_watch(run);
  if (pl_is_singular(run)) return pl_run_singular(run);
  if (run->dae.rank > run->dae.rank_mode) run->dae.rank_mode = run->dae.rank;
  if (run->dae.rank != run->dae.n_active) {
    if (run->dae.at_point) pl_point_evaluate(&run->dae, run->dae.t, run->dae.q, run->dae.v);
    pl_active_set_unique(&run->dae);
  }
  pl_output_energy(run, false);
  return check_energy(run);
}

// Steps of almost no length in a row: a switching point that the motion does not leave, as dry
// friction at rest.
static pleuel_status count_tiny(pl_run* run, double h) {
  enum { MOST = 200 };
  run->control.tiny = fabs(h) <= 100 * run->control.h_least ? run->control.tiny + 1 : 0;
  if (run->control.tiny <= MOST) return PLEUEL_OK;
  if (run->event->n_switches == 0) return pl_run_too_small(run, h);
  return pl_fail(
      run->job, PLEUEL_NUMERICAL,
      "the motion stays where a force changes its branch, at t = %.9g s: sticking is not computed",
      run->dae.t);
}

// The step that the motion allows, up to the first thing that happens on it.
static pleuel_status find_step(pl_run* run, pl_stepper_step* s) {
  PL_TRY(run->stepper->expand(run, s));
  while (!s->found) {
    s->root = run->event->n_watch > 0 ? pl_watch_first(run, s->h) : -1;
    if (s->root == 0) return PLEUEL_OK;
    PL_TRY(run->stepper->state_at(run, s));
  }
  return PLEUEL_OK;
}

// What is left behind by a step that is taken: rows, sides of what is watched, figures.
static pleuel_status pass(pl_run* run, const pl_stepper_step* s) {
  PL_TRY(pl_output_grid(run, run->dae.t, run->dae.t + s->h));
  if (run->event->n_watch > 0) pl_watch_passed(run, s->h);
  if (run->event->n_watch > 0 && run->event->sunk >= 0)
    return pl_fail(run->job, PLEUEL_NUMERICAL,
                   "%s was passed through near t = %.9g s without being met: the result cannot be "
                   "trusted",
                   run->setup->constraints[run->event->sunk].name, run->dae.t);
  note(run, &s->projection, s->h);
  PL_TRY(count_tiny(run, s->h));
  if (s->root > 0 && run->dae.n_slipping > 0) pl_watch_friction_directions(run);
  PL_TRY(pl_attitude_poles(&run->dae, s->h, run->control.trial_q, &run->stats.t_singular));
  pl_attitude_follow(&run->dae, run->dae.t + s->h);
  return PLEUEL_OK;
}

static pleuel_status step(pl_run* run) {
  pl_stepper_step s = {.root = -1};
  for (int i = 0; i < run->n_steppers; i++)
    if (run->steppers[i] != run->stepper && run->steppers[i]->poll)
      PL_TRY(run->steppers[i]->poll(run));
  PL_TRY(find_step(run, &s));
  if (s.root == 0) {
    if (run->stepper->to_patterns) run->stepper->to_patterns(run);
    return pl_modes_handle(run);
  }
  bool to_end = s.h == s.wanted && s.root < 0 && fabs(s.wanted) == fabs(pl_run_left(run));
  PL_TRY(pass(run, &s));
  accept(run, s.h, to_end);
  PL_TRY(arrive_at_point(run));
  if (s.root > 0) return pl_modes_handle(run);
  // a row of the grid that falls together with a root is written when that is known
  bool waits = run->event->n_watch > 0 && run->event->undecided && run->control.grid_dt != 0
               && run->stepper->to_rounding;
  return pl_run_done(run) || waits ? PLEUEL_OK : pl_output_point(run, PL_ROW_STEP);
}

static pleuel_status limits(pl_run* run) {
  bool interrupted = run->job->interrupted && pl_interrupted(run->job);
  if (run->options.keep) run->options.keep(run->options.keep_user, run, interrupted);
  if (interrupted)
    return pl_fail(run->job, PLEUEL_INTERRUPTED, "interrupted at t = %.9g s", run->dae.t);
  if (run->options.max_steps > 0 && run->stats.steps >= run->options.max_steps)
    return pl_fail(run->job, PLEUEL_NUMERICAL, "%ld steps were not enough: t = %.9g s",
                   run->options.max_steps, run->dae.t);
  return PLEUEL_OK;
}

pleuel_status pl_run_step(pl_run* run) {
  if (!run->control.started) PL_TRY(pl_run_start(run));
  PL_TRY(pl_output_begin(run));
  if (pl_run_done(run)) return PLEUEL_OK;
  PL_TRY(limits(run));
  PL_TRY(run->lead ? run->lead->step(run->sensitivity, step) : step(run));
  run->stats.rank = run->dae.rank;
  if (run->options.progress)
    run->options.progress(run->options.progress_user, run->dae.t, run->options.t_end,
                          run->control.h_last, &run->stats);
  return PLEUEL_OK;
}

static pleuel_status steps_to_end(pl_run* run) {
  if (!run->control.started) PL_TRY(pl_run_start(run));
  PL_TRY(pl_output_begin(run));
  while (!pl_run_done(run)) PL_TRY(pl_run_step(run));
  return PLEUEL_OK;
}

pleuel_status pl_run_to_end(pl_run* run) {
  double begin = pl_clock();
  const pl_sink* s = &run->options.sink;
  pleuel_status how = steps_to_end(run);
  if (run->output->begun && !run->output->ended) {
    // the last row is written whatever happened, unless it stands there already
    pleuel_status last = run->dae.ready && !run->output->refused ? pl_output_point(run, PL_ROW_END)
                                                                 : PLEUEL_OK;
    if (how == PLEUEL_OK) how = last;
    run->output->ended = true;
  }
  run->stats.wall_s += pl_clock() - begin;
  pl_indeterminate_report(run);
  if (run->output->opened && s->end) {
    pleuel_status end = s->end(s->user, how, how == PLEUEL_OK ? "" : run->job->message,
                               &run->stats);
    if (how == PLEUEL_OK) how = end;
  }
  return how;
}

// ----------------------------------------------------------------------------------------- reading
double pl_run_time(const pl_run* run) { return run->dae.t; }
bool pl_run_done(const pl_run* run) {
  bool waits = run->lead && run->lead->waits(run->sensitivity);
  return run->control.stopped || (run->control.started && pl_run_left(run) == 0 && !waits);
}
const double* pl_run_q(const pl_run* run) { return run->dae.q; }
const double* pl_run_v(const pl_run* run) { return run->dae.v; }
const double* pl_run_a(const pl_run* run) { return run->dae.A; }
const double* pl_run_lambda(const pl_run* run) { return run->dae.L; }
const bool* pl_run_unique(const pl_run* run) { return run->dae.unique; }
const pl_stats* pl_run_stats(const pl_run* run) { return &run->stats; }
double pl_run_tol(const pl_run* run) { return run->control.tol; }
bool pl_run_tol_raised(const pl_run* run) { return run->control.tol_raised; }
bool pl_run_is_active(const pl_run* run, int constraint) { return run->dae.active[constraint]; }
bool pl_run_is_released(const pl_run* run, int constraint) { return run->dae.detached[constraint]; }

void pl_run_dense(const pl_run* run, double t, double* q, double* v, double* lambda) {
  double dt = t - run->control.t_last;
  if (q) pl_horner(run->dae.Q_last, run->n_q, run->control.use_last + 1, dt, q);
  if (v) pl_horner(run->dae.V_last, run->n_q, run->control.use_last, dt, v);
  if (lambda) pl_horner(run->dae.L_last, run->n_c, run->control.use_last - 1, dt, lambda);
}

pl_friction_report pl_run_friction(const pl_run* run, int friction) {
  const pl_friction_state* now = &run->dae.friction[friction];
  static const pl_friction_mode mode[] = {[PL_FRICTION_OFF] = PL_FRICTION_NONE,
                                          [PL_FRICTION_STICK] = PL_FRICTION_STICKS,
                                          [PL_FRICTION_SLIP] = PL_FRICTION_SLIPS};
  return (pl_friction_report){
      pl_friction_is_used(&run->dae, friction) ? mode[now->state] : PL_FRICTION_NONE, now->way,
      now->press};
}
