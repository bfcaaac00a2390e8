// The reference stepper: the classical Runge-Kutta method of order 4 with steps of a given length,
// on the equations of index 1.  Each stage solves [M G^T; G 0] [a; -λ] = r for accelerations; the
// end of a step is projected on g = 0 and G v + dg/dt = 0.  See theory (9.5).
//
// It shares with the other steppers the equations and nothing else: no series, no control of
// errors, no events.  So it shows whether an error of a motion is one of its equations or of its
// integration, and it is the shortest example of a stepper.  It is for tests: a method of order 4
// with a fixed step is no choice that a user would make.
#include "solve/stepper/reference/reference.h"

#include <math.h>
#include <string.h>

enum { ORDER = 4 };  // of the method, and of the polynomial for velocities between its points

// State, accelerations and multipliers at both ends of a step; velocities and accelerations of
// stages.
struct pl_reference {
  double *q, *v, *a, *l;         // at the start                                  (n_q, n_c)
  double *stage_q, *stage_v[3];  // of stages 2 to 4                              (n_q)
  double* stage_a[3];            //                                               (n_q)
};
typedef struct pl_reference pl_reference;

// --------------------------------------------------------------------------------------- the slots
static double tolerance(const pl_run_options* o) { return o->tol > 0 ? o->tol : 1e-6; }

static void plan(pl_run* run) { run->order = ORDER; }

static bool has_contacts(const pl_setup* s) {
  for (int c = 0; c < s->n_c; c++)
    if (s->constraints[c].side != 0 || s->constraints[c].off) return true;
  return s->n_frictions > 0;
}

static pleuel_status open(pl_run* run) {
  const pl_setup* s = run->setup;
  pl_arena* a = run->job->arena;
  bool smooth = s->n_events == 0 && !has_contacts(s);
  if (!smooth || run->options.precision != PL_PRECISION_DOUBLE || !(run->options.h_max > 0))
    return pl_fail(run->job, PLEUEL_UNSUPPORTED,
                   "the reference method is for motions without contacts and events, in double, "
                   "with a given length of steps");
  pl_reference* r = run->reference = PL_NEW(a, pl_reference);
  double** of_q[] = {&r->q,          &r->v,          &r->a,          &r->stage_q,
                     &r->stage_v[0], &r->stage_v[1], &r->stage_v[2], &r->stage_a[0],
                     &r->stage_a[1], &r->stage_a[2]};
  for (size_t i = 0; i < sizeof of_q / sizeof *of_q; i++)
    *of_q[i] = PL_ARRAY(a, double, run->n_q + 1);
  r->l = PL_ARRAY(a, double, run->n_c + 1);
  return PLEUEL_OK;
}

static bool enter(pl_run* run) { return pl_point_enter(&run->dae); }

// ------------------------------------------------------------------------------------------ stages
// Velocities and accelerations of stage i at c h, from the slopes of the stage before.
static bool do_stage(pl_run* run, int i, double c, double h, const double* v, const double* a) {
  pl_reference* r = run->reference;
  for (int k = 0; k < run->n_q; k++) {
    r->stage_q[k] = r->q[k] + c * h * v[k];
    r->stage_v[i][k] = r->v[k] + c * h * a[k];
  }
  double t = run->dae.t + run->dae.t_low + c * h;
  run->dae.factored = false;
  if (!pl_point_enter_at(&run->dae, t, r->stage_q, r->stage_v[i])) return false;
  memcpy(r->stage_a[i], run->dae.A, (size_t)run->n_q * sizeof(double));
  return true;
}

static bool do_stages(pl_run* run, double h) {
  pl_reference* r = run->reference;
  return do_stage(run, 0, 0.5, h, r->v, r->a)
         && do_stage(run, 1, 0.5, h, r->stage_v[0], r->stage_a[0])
         && do_stage(run, 2, 1, h, r->stage_v[1], r->stage_a[1]);
}

// q + h/6 (k_1 + 2 k_2 + 2 k_3 + k_4), projected.
static bool do_end(pl_run* run, double h, pl_projection* p) {
  pl_reference* r = run->reference;
  double *q = run->control.trial_q, *v = run->control.trial_v;
  for (int i = 0; i < run->n_q; i++) {
    double of_q = r->v[i] + 2 * (r->stage_v[0][i] + r->stage_v[1][i]) + r->stage_v[2][i];
    double of_v = r->a[i] + 2 * (r->stage_a[0][i] + r->stage_a[1][i]) + r->stage_a[2][i];
    q[i] = r->q[i] + h / 6 * of_q;
    v[i] = r->v[i] + h / 6 * of_v;
  }
  double t = run->dae.t + run->dae.t_low + h;
  *p = pl_project(&run->dae, t, q, v);
  return p->ok && pl_point_enter_at(&run->dae, t, q, v);
}

// -------------------------------------------------------------------------------------- polynomial
// Between the ends: the polynomial of degree 5 through position, velocity and acceleration of both
// (quintic Hermite); multipliers linear.  A and L hold those of the end.
static void fill_series(pl_run* run, double h) {
  pl_reference* r = run->reference;
  pl_dae* d = &run->dae;
  size_t n = (size_t)run->n_q, c = (size_t)run->n_c;
  for (size_t i = 0; i < n; i++) {
    double q = r->q[i], v = r->v[i] * h, a = r->a[i] * h * h / 2;
    // what the first three terms miss of position, velocity and acceleration at the end
    double x = run->control.trial_q[i] - q - v - a;
    double y = run->control.trial_v[i] * h - v - 2 * a;
    double z = d->A[i] * h * h - 2 * a;
    double k[] = {q, v, a, 10 * x - 4 * y + z / 2, -15 * x + 7 * y - z, 6 * x - 3 * y + z / 2};
    double power = 1;
    for (size_t o = 0; o <= ORDER + 1; o++, power *= h) {
      d->Q[o * n + i] = k[o] / power;
      if (o > 0) d->V[(o - 1) * n + i] = (double)o * k[o] / power;
      if (o > 1) d->A[(o - 2) * n + i] = (double)(o * (o - 1)) * k[o] / power;
    }
  }
  for (size_t i = 0; i < c; i++) {
    double end = d->L[i];
    for (size_t o = 0; o < ORDER; o++) d->L[o * c + i] = 0;
    d->L[i] = r->l[i];
    d->L[c + i] = (end - r->l[i]) / h;
  }
  d->t_series = d->t;
  d->use = ORDER;
}

// ------------------------------------------------------------------------------------------ a step
static pleuel_status expand(pl_run* run, pl_stepper_step* s) {
  pl_reference* r = run->reference;
  const pl_dae* d = &run->dae;
  size_t n = (size_t)run->n_q * sizeof(double);
  double left = pl_run_left(run), steps = ceil(fabs(left) / run->options.h_max * (1 - 1e-9));
  s->h = s->wanted = left / fmax(steps, 1);
  memcpy(r->q, d->q, n);
  memcpy(r->v, d->v, n);
  memcpy(r->a, d->A, n);
  memcpy(r->l, d->L, (size_t)run->n_c * sizeof(double));
  if (!do_stages(run, s->h) || !do_end(run, s->h, &s->projection))
    return pl_fail(run->job, PLEUEL_NUMERICAL,
                   "the reference method has no accelerations on the step from t = %.9g s", d->t);
  fill_series(run, s->h);
  run->stats.steps_interpreted++;
  run->control.h_series = fabs(s->h);
  return PLEUEL_OK;
}

// The end stands there already: nothing shortens a step of this method.
static pleuel_status state_at(pl_run* run, pl_stepper_step* s) {
  (void)run;
  s->found = true;
  return PLEUEL_OK;
}

const pl_stepper pl_stepper_reference = {.name = "reference",
                                         .tolerance = tolerance,
                                         .plan = plan,
                                         .open = open,
                                         .enter = enter,
                                         .expand = expand,
                                         .state_at = state_at};
