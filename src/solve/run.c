// A run takes steps: series, roots on the step, projection, check, rows.
#include "solve/stepper/taylor/extended_impl.h"

#include <float.h>
#include <math.h>
#include <string.h>

// What a step may be off by before it is tried again at half the length, in units of the tolerance.
static const double allowed_move = 1e4;  // correction by the projection, relative
// and what rounding may do to it close to a singular position
static const double allowed_floor = 1e-11;
static const double allowed_floor_extended =
    1e-8;  // the same of extended numbers, which come closer to one
// of velocities, by what accelerations at its end tell; a tenth is usual
static const double allowed_defect = 10;
static const double allowed_rounding = 450;  // the same in roundings
static const double not_less = 0.75;         // of what a step twice as long was off by: rounding
// |g| and |G v + dg/dt| after it, relative to their terms
static const double allowed_residual = 1e-12;

// ------------------------------------------------------------------------------------- one attempt
static bool acceptable(const pl_run* run, const pl_projection* p) {
  double rounding = run->extended ? run->extended->floor / DBL_EPSILON : 1;
  double move = pl_larger(allowed_move * run->tol,
                          rounding * (run->extended ? allowed_floor_extended : allowed_floor));
  double left = pl_larger(10 * run->tol, rounding * allowed_residual);
  return p->ok && p->move_q <= move && p->move_v <= move && p->g_after <= left
         && p->r_after <= left;
}

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

double pl_run_left(const pl_run* run) {
  if (run->stop.early) return (run->stop.t - run->t) + (run->stop.t_low - run->t_low);
  return run->options.t_end - run->t - run->t_low;
}

static double choose_step(pl_run* run) {
  double h = run->h_series = pl_series_step(run), left = pl_run_left(run);
  if (run->options.h_max > 0) h = pl_smaller(h, run->options.h_max);
  else h = pl_smaller(h, run->h_plain);
  // not a last step that is almost nothing
  if (h >= fabs(left)) h = fabs(left);
  else if (h > 0.5 * fabs(left)) h = 0.5 * fabs(left);
  return copysign(h, left);
}

// t + h with the rounding error carried along.
static void advance_time(pl_run* run, double h, bool to_end) {
  double add = h + run->t_low, t = run->t + add;
  run->t_low = add - (t - run->t);
  run->t = t;
  if (!to_end) return;
  run->t = run->stop.early ? run->stop.t : run->options.t_end;
  run->t_low = run->stop.early ? run->stop.t_low : 0;
}

static pleuel_status too_small(pl_run* run, double h) {
  if (run->best > 0 && run->smallest_here < 1e-2 * run->best) return pl_run_singular(run);
  if (run->n_slipping > 0)
    return pl_fail(run->job, PLEUEL_NUMERICAL,
                   "no step is short enough at t = %.9g s (%.3g s tried): forces of contact grow "
                   "without bound while surfaces "
                   "slip, as on the way into Painlevé's paradox",
                   run->t, h);
  double way = pl_norm(run->q, run->n_q), speed = pl_norm(run->v, run->n_q),
         most = pl_norm(run->A, run->n_q);
  // x = c/(t_0 - t)^n: what is left of the time is n x/v, and less than n v/a
  if (speed * run->h_series > 0.02 * way && most * run->h_series > 0.02 * speed
      && speed > 1e6 * fabs(way) / fabs(run->t - run->options.t_0))
    return pl_fail(
        run->job, PLEUEL_NUMERICAL,
        "the motion runs away: positions and velocities grow without bound as t comes to %.9g s",
        run->t);
  return pl_fail(run->job, PLEUEL_NUMERICAL,
                 "no step is short enough at t = %.9g s (%.3g s tried): the motion leaves the "
                 "domain of a function, "
                 "or a force or the constraints jump there",
                 run->t, h);
}

// The state at the end of a step of this length, projected.
static void advance(pl_run* run, double h, bool at_root, pl_projection* p) {
  double t = run->t + run->t_low + h;
  if (run->extended) {
    pl_extended_advance(run, h);
    if (at_root) pl_extended_refine(run, h);
    pl_extended_project(run, p);
    return;
  }
  run->end_by_program = run->at_point && run->use == run->order;
  if (run->end_by_program) {
    pl_step_program_advance(run, h, run->trial_q, run->trial_v);
  } else {
    pl_series_at(run, h, run->trial_q, run->trial_v);
    pl_horner(run->A, run->n_q, run->use - 1, h, run->end_a);
  }
  // what follows a root changes the mode: it needs the general way
  if (at_root || !pl_step_program_project(run, t, run->trial_q, run->trial_v, p))
    *p = pl_project(run, t, run->trial_q, run->trial_v);
}

// A slip that ends here has another direction for what follows: accelerations are not those of the
// step.
static bool ends_slip(const pl_run* run) {
  for (int i = 0; i < run->n_watch; i++)
    if (run->hit[i] && run->watch[i].kind == PL_WATCH_STICK) return true;
  return false;
}

// Whether the equations at the end of a step give the accelerations that the series says: one that
// is cut off at order p is off by (p + 1)/h times as much in acceleration as in velocity. What does
// not lessen with the step is rounding, and is allowed from then on; *before: what a longer step
// was off by, 0 none.
static bool series_holds(pl_run* run, double h, double* before) {
  double off, size, rounding = run->extended ? run->extended->state->epsilon : DBL_EPSILON;
  // what stands in the way is told when the step is taken
  if (!pl_point_arrive(run, h, &off, &size)) return true;
  double part = allowed_defect * run->tol + allowed_rounding * rounding,
         of_v = pl_larger(run->v_size, fabs(h) * size);
  if (off * fabs(h) <= part * of_v * (run->order + 1) || off <= run->a_rough) return true;
  bool rough = *before > 0 && off > not_less * *before;
  *before = off;
  if (rough) run->a_rough = 2 * off;
  else run->arrived = false;
  return rough;
}

// The longest step up to h whose end passes the checks; the state there is in trial_q, trial_v.
static pleuel_status try_steps(pl_run* run, double* h, double* root, pl_projection* p) {
  double off = 0;
  run->arrived = false;
  for (;;) {
    *root = run->n_watch > 0 ? pl_watch_first(run, *h) : -1;
    if (*root == 0) return PLEUEL_OK;
    double at_switch = run->n_switches > 0 ? pl_switching_first(run, *h) : -1;
    bool behind_switch = at_switch >= 0 && (*root < 0 || at_switch < *root);
    if (behind_switch) {
      *root = -1;
      *h *= pl_smaller(at_switch, 1);
    }
    double reach = *root >= 0 ? *root * *h : *h;
    advance(run, reach, *root >= 0, p);
    bool open = behind_switch || (*root >= 0 && ends_slip(run));  // accelerations jump there
    bool found = *root < 0 || run->extended || pl_watch_holds(run, *h, *root);
    if (acceptable(run, p) && found && (open || series_holds(run, reach, &off))) {
      *h = reach;
      return PLEUEL_OK;
    }
    run->stats.rejections++;
    run->at_point = false;  // what the programs keep is the end that was tried
    pl_sizes_forget(run);
    *h = 0.5 * reach;
    if (!(fabs(*h) > run->h_least)) return too_small(run, *h);
  }
}

// ------------------------------------------------------------------------------------------ a step
static void accept(pl_run* run, double h, bool to_end) {
  pl_series_swap(run);
  run->t_last = run->t_series;
  run->smallest_before = run->smallest_here;
  run->t_before = run->t;
  run->h_last = h;
  run->use_last = run->use;
  advance_time(run, h, to_end);
  if (run->extended) pl_extended_accept(run, to_end);
  memcpy(run->q, run->trial_q, (size_t)run->n_q * sizeof(double));
  memcpy(run->v, run->trial_v, (size_t)run->n_q * sizeof(double));
  pl_sizes_keep(run);
  run->a_rough *= 0.9;
}

static pleuel_status check_energy(pl_run* run) {
  double limit = pl_larger(1e-8, 1e5 * run->tol);
  if (!run->setup->energy_conserved || !(run->stats.energy_drift > limit)) return PLEUEL_OK;
  return pl_fail(
      run->job, PLEUEL_NUMERICAL,
      "the energy has drifted by %.2g of its size at t = %.9g s: the result cannot be trusted",
      run->stats.energy_drift, run->t);
}

static pleuel_status arrive_at_point(pl_run* run) {
  if (!pl_point_enter(run)) return pl_run_undetermined(run);
  if (!run->at_point) pl_assemble_row_sizes(run);
  pl_singular_watch(run);
  if (pl_is_singular(run)) return pl_run_singular(run);
  if (run->rank > run->rank_mode) run->rank_mode = run->rank;
  if (run->rank != run->n_active) {
    if (run->at_point) pl_point_evaluate(run, run->t, run->q, run->v);
    pl_active_set_unique(run);
  }
  pl_output_energy(run, false);
  return check_energy(run);
}

// Steps that get nowhere, one after the other: switching points that the motion does not leave, as dry
// friction at rest.
static pleuel_status count_tiny(pl_run* run, double h) {
  enum { MOST = 200 };
  run->tiny = fabs(h) <= 100 * run->h_least ? run->tiny + 1 : 0;
  if (run->tiny <= MOST) return PLEUEL_OK;
  if (run->n_switches == 0) return too_small(run, h);
  return pl_fail(
      run->job, PLEUEL_NUMERICAL,
      "the motion stays where a force changes its branch, at t = %.9g s: sticking is not computed",
      run->t);
}

// A step of the series: its length, the length wanted, and the root that ended it, -1 none.
static pleuel_status step_by_series(pl_run* run, double* h, double* wanted, double* root,
                                    pl_projection* p) {
  run->use = run->order;
  pl_step_program_update(run);
  pl_series_expand(run);
  pl_watch_series(run);
  if (run->n_switches > 0) pl_switching_series(run);
  *h = choose_step(run);
  if (run->n_watch > 0) *h = pl_watch_reach(run, *h);
  if (run->n_switches > 0) *h = pl_switching_reach(run, *h);
  *wanted = *h;
  *root = -1;
  if (!run->extended && pl_singular_leap(run, pl_run_left(run), h, p))
    return pl_singular_record(run);
  *h = *wanted;
  if (!(fabs(*h) > run->h_least) && fabs(*h) < fabs(pl_run_left(run))) return too_small(run, *h);
  return try_steps(run, h, root, p);
}

static pleuel_status step_implicitly(pl_run* run, double* h, double* wanted, double* root,
                                     pl_projection* p) {
  pl_point_general(run);
  PL_TRY(pl_radau_step(run, h, root, p));
  *wanted = *h;
  if (*root != 0) run->stats.steps_implicit++;
  return PLEUEL_OK;
}

static pleuel_status step(pl_run* run) {
  double h, wanted, root;
  pl_projection p = {0};
  if (run->radau && !run->implicit) PL_TRY(pl_stiff_look(run));
  PL_TRY((run->implicit ? step_implicitly : step_by_series)(run, &h, &wanted, &root, &p));
  if (root == 0) {
    if (!run->extended) pl_point_general(run);
    return pl_modes_handle(run);
  }
  bool to_end = h == wanted && root < 0 && fabs(wanted) == fabs(pl_run_left(run));
  PL_TRY(pl_output_grid(run, run->t, run->t + h));
  if (run->n_watch > 0) pl_watch_passed(run, h);
  if (run->n_watch > 0 && run->sunk >= 0)
    return pl_fail(
        run->job, PLEUEL_NUMERICAL,
        "%s was passed through near t = %.9g s without being met: the result cannot be trusted",
        run->setup->constraints[run->sunk].name, run->t);
  note(run, &p, h);
  PL_TRY(count_tiny(run, h));
  if (root > 0 && run->n_slipping > 0) pl_friction_keep_directions(run);
  PL_TRY(pl_attitude_poles(run, h));
  pl_attitude_follow(run, run->t + h);
  accept(run, h, to_end);
  PL_TRY(arrive_at_point(run));
  if (root > 0) return pl_modes_handle(run);
  // a row of the grid that falls together with a root is written when that is known
  bool waits = run->n_watch > 0 && run->undecided && run->grid_dt != 0 && !run->implicit;
  return pl_run_done(run) || waits ? PLEUEL_OK : pl_output_point(run, PL_ROW_STEP);
}

static pleuel_status limits(pl_run* run) {
  bool interrupted = run->job->interrupted && pl_interrupted(run->job);
  if (run->options.keep) run->options.keep(run->options.keep_user, run, interrupted);
  if (interrupted)
    return pl_fail(run->job, PLEUEL_INTERRUPTED, "interrupted at t = %.9g s", run->t);
  if (run->options.max_steps > 0 && run->stats.steps >= run->options.max_steps)
    return pl_fail(run->job, PLEUEL_NUMERICAL, "%ld steps were not enough: t = %.9g s",
                   run->options.max_steps, run->t);
  return PLEUEL_OK;
}

pleuel_status pl_run_step(pl_run* run) {
  if (!run->started) PL_TRY(pl_run_start(run));
  PL_TRY(pl_output_begin(run));
  if (pl_run_done(run)) return PLEUEL_OK;
  PL_TRY(limits(run));
  PL_TRY(run->sensitivity ? pl_sensitivity_step(run->sensitivity, step) : step(run));
  run->stats.rank = run->rank;
  if (run->options.progress)
    run->options.progress(run->options.progress_user, run->t, run->options.t_end, run->h_last,
                          &run->stats);
  return PLEUEL_OK;
}

static pleuel_status steps_to_end(pl_run* run) {
  if (!run->started) PL_TRY(pl_run_start(run));
  PL_TRY(pl_output_begin(run));
  while (!pl_run_done(run)) PL_TRY(pl_run_step(run));
  return PLEUEL_OK;
}

pleuel_status pl_run_to_end(pl_run* run) {
  double begin = pl_clock();
  const pl_sink* s = &run->options.sink;
  pleuel_status how = steps_to_end(run);
  if (run->begun && !run->ended) {
    // the last row is written whatever happened, unless it stands there already
    pleuel_status last = run->ready && !run->refused ? pl_output_point(run, PL_ROW_END) : PLEUEL_OK;
    if (how == PLEUEL_OK) how = last;
    run->ended = true;
  }
  run->stats.wall_s += pl_clock() - begin;
  pl_indeterminate_report(run);
  if (run->opened && s->end) {
    pleuel_status end = s->end(s->user, how, how == PLEUEL_OK ? "" : run->job->message,
                               &run->stats);
    if (how == PLEUEL_OK) how = end;
  }
  return how;
}

// --------------------------------------------------------------------------- starting from numbers
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
  run->extended = NULL;
  PL_TRY(pl_modes_enter(run));
  run->stats.rank_start = run->stats.rank = run->rank;
  run->smallest_here = run->smallest;
  run->started = true;
  PL_TRY(pl_output_open(run));
  PL_TRY(pl_modes_check(run, true));
  pl_modes_size_rest(run);
  if (run->sensitivity) PL_TRY(pl_sensitivity_begin(run->sensitivity));
  if (run->options.precision != PL_PRECISION_DOUBLE) PL_TRY(pl_extended_begin(run, t));
  pl_output_energy(run, true);
  pl_step_program_update(run);
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

// ----------------------------------------------------------------------------------------- reading
double pl_run_time(const pl_run* run) { return run->t; }
bool pl_run_done(const pl_run* run) {
  bool waits = run->sensitivity && pl_sensitivity_waits(run->sensitivity);
  return run->stopped || (run->started && pl_run_left(run) == 0 && !waits);
}
const double* pl_run_q(const pl_run* run) { return run->q; }
const double* pl_run_v(const pl_run* run) { return run->v; }
const double* pl_run_a(const pl_run* run) { return run->A; }
const double* pl_run_lambda(const pl_run* run) { return run->L; }
const bool* pl_run_unique(const pl_run* run) { return run->unique; }
const pl_stats* pl_run_stats(const pl_run* run) { return &run->stats; }
double pl_run_tol(const pl_run* run) { return run->tol; }
bool pl_run_tol_raised(const pl_run* run) { return run->tol_raised; }
bool pl_run_is_active(const pl_run* run, int constraint) { return run->active[constraint]; }
bool pl_run_is_released(const pl_run* run, int constraint) { return run->detached[constraint]; }

void pl_run_dense(const pl_run* run, double t, double* q, double* v, double* lambda) {
  double dt = t - run->t_last;
  if (q) pl_horner(run->Q_last, run->n_q, run->use_last + 1, dt, q);
  if (v) pl_horner(run->V_last, run->n_q, run->use_last, dt, v);
  if (lambda) pl_horner(run->L_last, run->n_c, run->use_last - 1, dt, lambda);
}

const char* pl_run_mode(const pl_run* run) {
  pl_output_mode(run, run->mode);
  return run->mode;
}
