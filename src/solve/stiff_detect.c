// Stiffness: when the series takes short steps although the motion is smooth, and the implicit method is cheaper.
//
// A stiff part that has died out still limits the series: its coefficients of high order are rounding errors times
// (stiffness)^k, so the step depends neither on the order nor on the tolerance, while the coefficients of low order
// tell a motion that goes on slowly.  Where these two disagree, now and then, the implicit method is asked what step
// it would take here at the tolerance of the run; what a step of each costs is counted, not timed, so that the same
// run takes the same decisions everywhere.  After a change the count goes on, and a motion that turns out not to be
// stiff any more goes back to the series.
#include <math.h>

#include "solve/radau_impl.h"

enum {
  FIRST_LOOK = 100,   // steps of the series before the first look; then always twice as many
  FEW_LEFT = 400,     // steps that would be left: too few to bother
  MANY_LEFT = 20000,  // where no tolerance was asked for, so that the series would be exact to rounding
  PATIENCE = 10       // implicit steps in a row that cost more, before the series takes over again
};
static const double slow_part = 40;   // radius of the low orders over the step: smooth motions have about e^2
static const double gain = 4;         // expected of a change
static const double gain_exact = 20;  // the same where no tolerance was asked for

// ---------------------------------------------------------------------------------------------- cost
// In units of one operation of a tape: what lies in the tapes, and n^3 of the linear systems at an eighth.
static double nodes_of(const pl_run* run) {
  double n = 0;
  for (int i = 0; i < run->motion.n; i++) {
    const pl_tape* tape = run->motion.at[i].pattern->tape;
    double wide = run->motion.at[i].lanes > 1 ? 2 : 1;
    n += (tape->level_end[PL_LEVEL_SPEED] - tape->level_end[PL_LEVEL_CONST]) * wide;
  }
  return n;
}

static double cost_of_series(const pl_run* run) {
  double p = run->order, n = run->n_q + run->n_c;
  return p * nodes_of(run) * (1 + p / 8) + p * n * n / 4 + n * n * n / 8;
}

static double cost_of_implicit(const pl_run* run) {
  const pl_radau* r = run->radau;
  double s = r->method.s, n = r->n, sweeps = 4 + (r->couples ? s : 1) * (1 + ceil(r->n_q / 4.0));
  double system = r->couples ? s * s * s : 2 * s;
  return 2 * nodes_of(run) * sweeps + system * n * n * n / 8 + 100 * s;
}

// ---------------------------------------------------------------------------------------------- the look
// Radius that the coefficients of low order of the last step tell, for velocities: the least of three.
static double slow_radius(const pl_run* run) {
  double radius = (double)INFINITY;
  for (int k = 1; k <= 3; k++) {
    double x = pl_norm(run->V_last + (size_t)k * (size_t)run->n_q, run->n_q);
    if (x > 0) radius = fmin(radius, pow(run->v_size / x, 1.0 / k));
  }
  return radius;
}

static bool worth_a_look(const pl_run* run, double left, double h) {
  bool exact = run->options.tol == 0;
  return left > (exact ? MANY_LEFT : FEW_LEFT) * h && slow_radius(run) > slow_part * h;
}

// Called before a step.  Status: that of entering the point again.
pleuel_status pl_stiff_look(pl_run* run) {
  pl_radau* r = run->radau;
  if (++r->looks < r->next_look) return PLEUEL_OK;
  r->next_look = r->next_look ? 2 * r->next_look : FIRST_LOOK;

  double left = fabs(run->options.t_end - run->t), h = fabs(run->h_last), reach;
  if (r->looks < FIRST_LOOK || !worth_a_look(run, left, h)) return PLEUEL_OK;
  bool holds = pl_radau_probe(run, copysign(fmin(slow_radius(run) / 4, left), run->options.t_end - run->t), h, &reach);
  // the jets were used for other points
  run->factored = false;
  if (!pl_point_enter(run)) return pl_run_undetermined(run);
  r->cost_series = cost_of_series(run) / h;
  double wanted = run->options.tol == 0 ? gain_exact : gain;
  if (!holds || r->cost_series < wanted * cost_of_implicit(run) / fabs(reach)) return PLEUEL_OK;
  run->implicit = true;
  run->tol = fmax(run->tol, r->tol);
  r->h = fabs(reach);
  r->dear = 0;
  return PLEUEL_OK;
}

// After an implicit step of length h that nothing cut short: whether the series would be cheaper by now.
void pl_stiff_review(pl_run* run, double h) {
  pl_radau* r = run->radau;
  bool dear = cost_of_implicit(run) / fabs(h) > 2 * r->cost_series;
  r->dear = dear ? r->dear + 1 : 0;
  if (r->dear < PATIENCE) return;
  run->implicit = false;
  r->h = 0;
  r->has_last = false;
  r->looks = 0;
}
