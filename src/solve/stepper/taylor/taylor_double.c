// The Taylor stepper in doubles: order by order through the patterns, or by the step program of the
// mode where there is one and its pivots are sound.  Both give the same motion; a point that the
// program cannot do goes through the patterns.
#include "solve/stepper/taylor/step_program_impl.h"

#include <float.h>
#include <math.h>
#include <string.h>

// ------------------------------------------------------------------------------------- the numbers
static double floor_of(const pl_run* run) {
  (void)run;
  return DBL_EPSILON;
}

// Order 0 at a point whose program may be there already, into the series at work.
static bool enter_at(pl_run* run, double t, const double* q, const double* v) {
  size_t n = (size_t)run->n_q * sizeof(double);
  if (run->dae.at_point) {
    memcpy(run->dae.Q, q, n);
    memcpy(run->dae.V, v, n);
    if (pl_step_program_enter(run)) return true;
  }
  run->dae.at_point = false;
  return pl_point_enter_at(&run->dae, t, q, v);
}

static bool enter(pl_run* run) {
  run->dae.t_series = run->dae.t;
  if (run->taylor->arrived) {
    run->taylor->arrived = false;
    return run->dae.ready;
  }
  return enter_at(run, run->dae.t, run->dae.q, run->dae.v);
}

void pl_taylor_expand(pl_run* run) {
  if (!run->dae.at_point || !pl_step_program_is_compiled(run)) run->stats.steps_interpreted++;
  if (run->dae.at_point) pl_step_program_expand(run);
  else
    for (int k = 1; k < run->order; k++) pl_point_order(&run->dae, k);
  // q gets one more coefficient without a solve
  const double* v = run->dae.V + (size_t)run->order * (size_t)run->n_q;
  double* q = run->dae.Q + (size_t)(run->order + 1) * (size_t)run->n_q;
  for (int i = 0; i < run->n_q; i++) q[i] = v[i] / (run->order + 1);
}

double pl_taylor_length(pl_run* run) {
  double of_q[PL_BLOCK_ROWS], of_v[PL_BLOCK_ROWS];
  const double *q = of_q, *v = of_v;
  if (run->dae.at_point) {
    pl_step_program_norms(run, &q, &v);
  } else {
    pl_block_norms(run->dae.Q, run->n_q, run->order + 1, of_q);
    pl_block_norms(run->dae.V, run->n_q, run->order, of_v);
  }
  return pl_series_length(run, q, v);
}

static void advance(pl_run* run, double h, bool at_root, pl_projection* p) {
  double t = run->dae.t + run->dae.t_low + h;
  run->taylor->end_by_program = run->dae.at_point && run->dae.use == run->order;
  if (run->taylor->end_by_program) {
    pl_step_program_advance(run, h, run->control.trial_q, run->control.trial_v);
  } else {
    pl_series_at(&run->dae, h, run->control.trial_q, run->control.trial_v);
    pl_horner(run->dae.A, run->n_q, run->dae.use - 1, h, run->taylor->end_a);
  }
  // what follows a root changes the mode: it needs the patterns
  if (at_root || !pl_step_program_project(run, t, run->control.trial_q, run->control.trial_v, p))
    *p = pl_project(&run->dae, t, run->control.trial_q, run->control.trial_v);
}

static bool defect(pl_run* run, double h, double* off, double* size) {
  if (run->dae.at_point && run->taylor->end_by_program) {
    pl_step_program_arrive(run, off, size);
    return isfinite(*off) && isfinite(*size);
  }
  if (run->taylor->end_by_program) pl_step_program_end_a(run, run->taylor->end_a);
  pl_series_swap(&run->dae);
  run->taylor->arrived = enter_at(run, run->dae.t + run->dae.t_low + h, run->control.trial_q,
                                  run->control.trial_v);
  pl_series_swap(&run->dae);
  for (int i = 0; i < run->n_q; i++) run->taylor->end_a[i] -= run->dae.A_last[i];
  *off = pl_norm(run->taylor->end_a, run->n_q);
  *size = pl_norm(run->dae.A_last, run->n_q);
  return run->taylor->arrived;
}

static const pl_taylor_numbers doubles = {.floor = floor_of,
                                          .epsilon = floor_of,
                                          .near_singular = 1e-11,
                                          .leaps = true,
                                          .enter = enter,
                                          .expand = pl_taylor_expand,
                                          .length = pl_taylor_length,
                                          .advance = advance,
                                          .defect = defect};

// --------------------------------------------------------------------------------------- the slots
// The tolerance below which rounding, not truncation, decides.
static double tolerance(const pl_run_options* o) { return fmax(o->tol, 2.3e-16); }

static pleuel_status begin(pl_run* run, double t) {
  (void)t;
  pl_step_program_update(run);
  return PLEUEL_OK;
}

static pleuel_status expand(pl_run* run, pl_stepper_step* s) {
  return pl_taylor_step_expand(run, s, &doubles);
}

static pleuel_status state_at(pl_run* run, pl_stepper_step* s) {
  return pl_taylor_step_state_at(run, s, &doubles);
}

static void to_patterns(pl_run* run) {
  if (!run->dae.at_point) return;
  run->dae.at_point = run->dae.factored = false;
  pl_point_evaluate(&run->dae, run->dae.t, run->dae.q, run->dae.v);
  pl_active_set_choose(&run->dae);
  pl_point_factor(&run->dae, true);
}

static bool energy(pl_run* run, bool anew, pl_energy* e) {
  if (!pl_step_program_energy(run, &e->kinetic, &e->potential, &e->total)) return false;
  e->change = anew ? 0 : e->total - run->control.energy_base;
  return true;
}

// A point that the step program holds needs a program.
static void save_state(pl_run* run, pl_keeper* k) {
  if (k->reads && run->dae.at_point && !(run->taylor->program && run->taylor->program->usable))
    pl_keep_fail(k);
}

const pl_stepper pl_stepper_taylor = {.name = "taylor",
                                      .tolerance = tolerance,
                                      .to_rounding = true,
                                      .plan = pl_taylor_plan,
                                      .begin = begin,
                                      .enter = enter,
                                      .expand = expand,
                                      .state_at = state_at,
                                      .to_patterns = to_patterns,
                                      .energy = energy,
                                      .save_setup = pl_step_program_save,
                                      .save_state = save_state,
                                      .close = pl_step_program_free};
