// Stiffness: when the series takes short steps although the motion is smooth, and the implicit
// method is cheaper.
//
// A stiff part that has died out still limits the series: its coefficients of high order are
// rounding errors times (stiffness)^k, so the step depends neither on the order nor on the
// tolerance, while the coefficients of low order belong to a slow motion. Where these two
// disagree, now and then, the implicit method is asked what step it would take here at the
// tolerance of the run; what a step of each costs is counted, not timed, so that the same run takes
// the same decisions everywhere. After a change the count goes on, and a motion that turns out not
// to be stiff any more goes back to the series.
#include <math.h>

#include "solve/stepper/radau/radau_impl.h"

enum {
  FIRST_LOOK = 100,  // steps of the series before the first look; then always twice as many
  FEW_LEFT = 400,    // steps that would be left: too few to bother
  // where no tolerance was asked for, so that the series would be exact to rounding
  MANY_LEFT = 20000,
  PATIENCE = 10  // implicit steps in a row that cost more, before the series takes over again
};
// radius of the low orders over the step: smooth motions have about e^2
static const double slow_part = 40;
static const double gain = 4;         // expected of a change
static const double gain_exact = 20;  // the same where no tolerance was asked for

// -------------------------------------------------------------------------------------------- cost
// In units of one operation of a tape: what lies in the tapes, and n^3 of dense systems at an
// eighth. Sparse systems by their entries and by what the analysis of KLU expects; an indirect
// operation counts as half of one of a tape.
static double nodes_of_batch(const pl_batch* b) {
  const pl_tape* tape = b->pattern->tape;
  return (tape->level_end[PL_LEVEL_VELOCITY] - tape->level_end[PL_LEVEL_CONST])
         * (b->lanes > 1 ? 2.0 : 1.0);
}

static double nodes_of(const pl_run* run) {
  double n = 0;
  for (int i = 0; i < run->dae.motion.n; i++) n += nodes_of_batch(&run->dae.motion.at[i]);
  return n;
}

static double cost_of_series(const pl_run* run) {
  double p = run->order, n = run->n_q + run->n_c, entries = run->dae.kkt.n_values;
  double system = run->dae.kkt.dense ? p * n * n / 4 + n * n * n / 8 : (8 * p + 60) * entries;
  return p * nodes_of(run) * (1 + p / 8) + system;
}

// Sweeps of a step: four rounds, and the slopes along each direction at the start, or at all
// stages. Instances of a family stand in the lanes, else stages and directions do.
static double cost_of_sweeps(const pl_run* run) {
  const pl_radau* r = run->radau;
  double sum = 0, stages = r->method.s, often = r->couples ? stages : 1;
  for (int i = 0; i < run->dae.motion.n; i++) {
    const pl_batch* b = &run->dae.motion.at[i];
    double n_q = b->pattern->n_q;
    double sweeps = b->lanes > 1 ? 4 * stages / 2 + often * (1 + n_q)
                                 : 4 + often * (1 + ceil(n_q / 4.0));
    sum += 2 * nodes_of_batch(b) * sweeps;
  }
  return sum;
}

static double cost_of_systems(const pl_run* run) {
  const pl_radau* r = run->radau;
  double s = r->method.s, n = r->n;
  if (r->sparse)
    return (1 + 4 * r->method.n_pairs)
           * (pl_zsparse_work(r->sparse_pair[0]) / 2 + 10.0 * r->shape.n_values);
  return (r->couples ? s * s * s : 2 * s) * n * n * n / 8;
}

static double cost_of_implicit(const pl_run* run) {
  return cost_of_sweeps(run) + cost_of_systems(run) + 100 * run->radau->method.s;
}

// ---------------------------------------------------------------------------------------- the look
// Radius of convergence by the coefficients of low order of the last step, for velocities: the
// least of three.
static double slow_radius(const pl_run* run) {
  double radius = (double)INFINITY;
  for (int k = 1; k <= 3; k++) {
    double x = pl_norm(run->dae.V_last + (size_t)k * (size_t)run->n_q, run->n_q);
    if (x > 0) radius = fmin(radius, pow(run->dae.v_size / x, 1.0 / k));
  }
  return radius;
}

static bool worth_a_look(const pl_run* run, double left, double h) {
  bool exact = run->options.tol == 0;
  return left > (exact ? MANY_LEFT : FEW_LEFT) * h && slow_radius(run) > slow_part * h;
}

// Called before a step.  Status: that of entering the point again.
pleuel_status pl_stiff_poll(pl_run* run) {
  pl_radau* r = run->radau;
  if (++r->looks < r->next_look) return PLEUEL_OK;
  r->next_look = r->next_look ? 2 * r->next_look : FIRST_LOOK;

  // the step that the series allowed: what ended it, an event or a bounce, is not stiffness
  double left = fabs(run->options.t_end - run->dae.t),
         h = fmax(fabs(run->control.h_last), run->control.h_series), reach;
  if (r->looks < FIRST_LOOK || !worth_a_look(run, left, h)) return PLEUEL_OK;
  bool holds = pl_radau_probe(
      run, copysign(fmin(slow_radius(run) / 4, left), run->options.t_end - run->dae.t), h, &reach);
  // the jets were used for other points
  run->dae.factored = false;
  if (!run->stepper->enter(run)) return pl_run_undetermined(run);
  r->cost_series = cost_of_series(run) / h;
  double wanted = run->options.tol == 0 ? gain_exact : gain;
  if (!holds || r->cost_series < wanted * cost_of_implicit(run) / fabs(reach)) return PLEUEL_OK;
  run->stepper = &pl_stepper_radau;
  run->control.tol = fmax(run->control.tol, r->tol);
  r->h = fabs(reach);
  r->dear = 0;
  return PLEUEL_OK;
}

// After an implicit step of length h that nothing cut short: whether the series would be cheaper by
// now.
void pl_stiff_review(pl_run* run, double h) {
  pl_radau* r = run->radau;
  bool dear = cost_of_implicit(run) / fabs(h) > 2 * r->cost_series;
  r->dear = dear ? r->dear + 1 : 0;
  if (r->dear < PATIENCE) return;
  run->stepper = &pl_stepper_taylor;
  r->h = 0;
  r->has_last = false;
  r->looks = 0;
}
