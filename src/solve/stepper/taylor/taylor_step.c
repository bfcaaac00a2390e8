// A step of the series: its length, the state at its end, and the checks that this must pass.
#include "solve/stepper/taylor/step_program_impl.h"

#include <float.h>
#include <math.h>

// What a step may be off by before it is tried again at half the length, in units of the tolerance.
static const double allowed_move = 1e4;  // correction by the projection, relative
// of velocities, by the accelerations at its end; a tenth is usual
static const double allowed_defect = 10;
static const double allowed_rounding = 450;  // the same in roundings
static const double not_less = 0.75;         // of what a step twice as long was off by: rounding
// |g| and |G v + dg/dt| after it, relative to their terms
static const double allowed_residual = 1e-12;

// -------------------------------------------------------------------------------------- the length
static double choose_length(pl_run* run, const pl_taylor_numbers* numbers) {
  double h = run->control.h_series = numbers->length(run), left = pl_run_left(run);
  if (run->options.h_max > 0) h = pl_smaller(h, run->options.h_max);
  else h = pl_smaller(h, run->control.h_plain);
  // not a last step that is almost nothing
  if (h >= fabs(left)) h = fabs(left);
  else if (h > 0.5 * fabs(left)) h = 0.5 * fabs(left);
  return copysign(h, left);
}

pleuel_status pl_taylor_step_expand(pl_run* run, pl_stepper_step* s,
                                    const pl_taylor_numbers* numbers) {
  run->dae.use = run->order;
  pl_step_program_update(run);
  numbers->expand(run);
  pl_watch_series(run);
  if (run->event->n_switches > 0) pl_switching_series(run);
  s->h = choose_length(run, numbers);
  if (run->event->n_watch > 0) s->h = pl_watch_reach(run, s->h);
  if (run->event->n_switches > 0) s->h = pl_switching_reach(run, s->h);
  s->wanted = s->h;
  if (numbers->leaps && pl_singular_leap(run, pl_run_left(run), &s->h, &s->projection)) {
    s->found = true;
    return pl_singular_record(run);
  }
  s->h = s->wanted;
  run->taylor->arrived = false;
  if (!(fabs(s->h) > run->control.h_least) && fabs(s->h) < fabs(pl_run_left(run)))
    return pl_run_too_small(run, s->h);
  return PLEUEL_OK;
}

// -------------------------------------------------------------------------------------- the checks
static bool is_acceptable(const pl_run* run, const pl_taylor_numbers* numbers,
                          const pl_projection* p) {
  double rounding = numbers->floor(run) / DBL_EPSILON;
  double move = pl_larger(allowed_move * run->control.tol, rounding * numbers->near_singular);
  double left = pl_larger(10 * run->control.tol, rounding * allowed_residual);
  return p->ok && p->move_q <= move && p->move_v <= move && p->g_after <= left
         && p->r_after <= left;
}

// A slip that ends here has another direction for what follows: accelerations are not those of the
// step.
static bool ends_slip(const pl_run* run) {
  for (int i = 0; i < run->event->n_watch; i++)
    if (run->event->hit[i] && run->event->watch[i].kind == PL_WATCH_STICK) return true;
  return false;
}

// Whether the equations at the end of a step give the accelerations of the series: one that is cut
// off at order p is off by (p + 1)/h times as much in acceleration as in velocity. What does not
// lessen with the step is rounding, and is allowed from then on; *before: what a longer step was
// off by, 0 none.  See theory (10.6).
static bool series_holds(pl_run* run, const pl_taylor_numbers* numbers, double h, double* before) {
  double off, size;
  // the reason is reported when the step is taken
  if (!numbers->defect(run, h, &off, &size)) return true;
  double part = allowed_defect * run->control.tol + allowed_rounding * numbers->epsilon(run),
         of_v = pl_larger(run->dae.v_size, fabs(h) * size);
  if (off * fabs(h) <= part * of_v * (run->order + 1) || off <= run->control.a_rough) return true;
  bool rough = *before > 0 && off > not_less * *before;
  *before = off;
  if (rough) run->control.a_rough = 2 * off;
  else run->taylor->arrived = false;
  return rough;
}

// ----------------------------------------------------------------------------------------- the end
pleuel_status pl_taylor_step_state_at(pl_run* run, pl_stepper_step* s,
                                      const pl_taylor_numbers* numbers) {
  double at = run->event->n_switches > 0 ? pl_switching_first(run, s->h) : -1;
  bool at_switch = at >= 0 && (s->root < 0 || at < s->root);
  if (at_switch) {
    s->root = -1;
    s->h *= pl_smaller(at, 1);
  }
  double reach = s->root >= 0 ? s->root * s->h : s->h;
  numbers->advance(run, reach, s->root >= 0, &s->projection);
  // accelerations jump there
  bool jumps = at_switch || (s->root >= 0 && ends_slip(run));
  bool located = s->root < 0 || numbers->refines_roots || pl_watch_holds(run, s->h, s->root);
  if (is_acceptable(run, numbers, &s->projection) && located
      && (jumps || series_holds(run, numbers, reach, &s->defect))) {
    s->h = reach;
    s->found = true;
    return PLEUEL_OK;
  }
  run->stats.rejections++;
  run->dae.at_point = false;  // the step program holds the end that was tried
  pl_sizes_forget(&run->dae);
  s->h = 0.5 * reach;
  return fabs(s->h) > run->control.h_least ? PLEUEL_OK : pl_run_too_small(run, s->h);
}
