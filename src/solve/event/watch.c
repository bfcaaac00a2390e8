// Watching for roots on a step: releases (λ of a contact), landings (g of a free one-sided
// constraint), slip that comes to rest, sticking that breaks, events.
//
// Each is a polynomial on the step, and all its roots there are isolated, touching ones included.
// What has just happened is zero at the start of the step by construction: those leading
// coefficients are dropped and the polynomial divided by its power of t, so that the same root is
// not found again; nor does a root count before the value has left the rounding error of that first
// one. A sign that differs at the start of a step from that at the end of the one before is a root
// that fell between them.
// See theory (15.1).
#include "solve/event/event.h"

#include <float.h>
#include <math.h>

static double sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

void pl_watch_make(pl_run* run) {
  pl_watch_friction_make(run);
  const pl_setup* s = run->setup;
  run->event->watch = PL_ARRAY(
      run->job->arena, pl_watch,
      2 * (size_t)s->n_c + 3 * (size_t)s->n_frictions + (size_t)s->n_events + 1);
  for (int c = 0; c < s->n_c; c++) {
    if (s->constraints[c].side == 0) continue;
    run->event->watch[run->event->n_watch++] = (pl_watch){
        .kind = PL_WATCH_RELEASE, .index = c, .direction = -1};
    run->event->watch[run->event->n_watch++] = (pl_watch){
        .kind = PL_WATCH_LANDING, .index = c, .direction = -1};
  }
  for (int r = 0; r < s->n_frictions; r++) {
    run->event->watch[run->event->n_watch++] = (pl_watch){
        .kind = PL_WATCH_STICK, .index = r, .direction = -1};
    run->event->watch[run->event->n_watch++] = (pl_watch){
        .kind = PL_WATCH_SLIP, .index = r, .direction = -1};
    run->event->watch[run->event->n_watch++] = (pl_watch){
        .kind = PL_WATCH_PRESS, .index = r, .direction = -1};
  }
  for (int e = 0; e < s->n_events; e++)
    run->event->watch[run->event->n_watch++] = (pl_watch){
        .kind = PL_WATCH_EVENT, .index = e, .direction = s->events[e].direction};
  run->event->repeat = PL_ARRAY(run->job->arena, pl_repeat, s->n_events + 1);
  run->event->hit = PL_ARRAY(run->job->arena, bool, run->event->n_watch + 1);
  run->event->root = PL_ARRAY(run->job->arena, double, run->event->n_watch + 1);
  run->event->touch = PL_ARRAY(run->job->arena, bool, run->event->n_watch + 1);
}

pl_watch* pl_watch_of(pl_run* run, pl_watch_kind kind, int index) {
  for (int i = 0; i < run->event->n_watch; i++)
    if (run->event->watch[i].kind == kind && run->event->watch[i].index == index)
      return &run->event->watch[i];
  return NULL;
}

void pl_watch_forget(pl_run* run) {
  for (int i = 0; i < run->event->n_watch; i++) {
    run->event->watch[i].side = 0;
    run->event->watch[i].fresh = 0;
  }
}

// ------------------------------------------------------------------------------------------ series
static void series_of_events(pl_run* run) {
  pl_batches* b = &run->watched;
  pl_batches_time(b, run->dae.t_series);
  for (int k = 0; k < run->order; k++) {
    pl_batches_load_q(b, run->dae.Q + (size_t)k * (size_t)run->n_q, k);
    pl_batches_load_v(b, run->dae.V + (size_t)k * (size_t)run->n_q, k);
    pl_batches_load_a(b, run->dae.A + (size_t)k * (size_t)run->n_q, k);
    pl_batches_load_lambda(b, run->dae.L + (size_t)k * (size_t)run->n_c, k);
    for (int level = PL_LEVEL_POSITION; level < PL_N_LEVELS; level++)
      pl_batches_sweep(b, (pl_tape_level)level, k, true);
    pl_batches_outputs(b, run->event->W_series + (size_t)k * (size_t)run->setup->n_watched,
                       run->setup->n_watched, k);
  }
}

void pl_watch_series(pl_run* run) {
  if (run->dae.watch_landings)
    for (int k = 0; k <= run->order; k++)
      pl_assemble_g(&run->dae, k, run->event->G_series + (size_t)k * (size_t)run->n_c,
                    k == 0 ? run->dae.g_size : NULL);
  if (run->dae.n_slipping > 0)
    for (int k = 0; k <= run->order; k++)
      pl_assemble_slip(&run->dae, k, run->event->S_series + (size_t)k * (size_t)run->n_c);
  if (run->setup->n_events > 0) series_of_events(run);
}

// ---------------------------------------------------------------------------------------- one item
static bool is_of_friction(const pl_watch* w) {
  return w->kind >= PL_WATCH_STICK && w->kind <= PL_WATCH_PRESS;
}

static bool is_watched(const pl_run* run, const pl_watch* w) {
  if (w->kind == PL_WATCH_EVENT) return true;
  if (is_of_friction(w)) {
    const pl_constraint_setup* pressed =
        &run->setup->constraints[run->setup->frictions[w->index].constraint];
    if (w->kind == PL_WATCH_SLIP) return run->dae.friction[w->index].state == PL_FRICTION_STICK;
    return run->dae.friction[w->index].state == PL_FRICTION_SLIP
           && (w->kind == PL_WATCH_STICK || pressed->side == 0);
  }
  const pl_constraint_setup* constraint = &run->setup->constraints[w->index];
  if (w->kind == PL_WATCH_RELEASE) return run->dae.active[w->index];
  return !run->dae.on[w->index] && !run->dae.detached[w->index] && !constraint->velocity
         && (constraint->contact < 0 || run->dae.on[constraint->contact]);
}

static bool pl_event_sets(const pl_run* run, int e) {
  const pl_event_setup* event = &run->setup->events[e];
  for (int i = 0; i < event->n_actions; i++)
    if (event->actions[i].kind == PL_ACTION_SET_Q || event->actions[i].kind == PL_ACTION_SET_V)
      return true;
  return false;
}

double pl_watch_force_noise(const pl_run* run, int c) {
  static const double rounding = 1e-13;  // of the forces that λ balances
  return run->dae.row_most[c] > 0 ? rounding * run->dae.force_size / run->dae.row_most[c] : 0;
}

double pl_watch_noise(const pl_run* run, const pl_watch* w, double h) {
  if (w->kind == PL_WATCH_LANDING) return 1e-14 * run->dae.g_size[w->index];
  if (w->kind == PL_WATCH_RELEASE) return pl_watch_force_noise(run, w->index);
  if (w->kind == PL_WATCH_EVENT) {
    int size = run->setup->events[w->index].size;
    return size > 0 ? 4 * DBL_EPSILON * fabs(run->event->W_series[size - 1]) : 0;
  }
  const pl_friction_setup* friction = &run->setup->frictions[w->index];
  double force = pl_watch_force_noise(run, friction->row[0]);
  if (w->kind == PL_WATCH_PRESS) return pl_watch_force_noise(run, friction->constraint);
  if (w->kind == PL_WATCH_SLIP) return force * force;
  // slip: rounding of velocities, and of the forces that change them on the step
  return friction->n_rows == 1 ? 1e-14 * run->dae.r_size[friction->row[0]]
                                     + 1e-12 * fabs(h) * run->event->second_size[friction->row[0]]
                               : 0;
}

// Coefficients in units of the step; returns how many.
static int polynomial(const pl_run* run, const pl_watch* w, double h, double* c) {
  const double* X;
  size_t stride;
  double factor = 1, power = 1;
  int n = run->dae.use;
  if (run->stepper->polynomial)
    return run->stepper->polynomial(run, (int)(w - run->event->watch), c);
  if (is_of_friction(w)) {
    n = pl_watch_friction(run, w->index, w->kind, c, run->dae.use + 1);
    for (int k = 0; k < n; k++, power *= h) c[k] *= power;
    return n;
  }
  if (w->kind == PL_WATCH_EVENT) {
    X = run->event->W_series + run->setup->events[w->index].watch;
    stride = (size_t)run->setup->n_watched;
  } else {
    X = (w->kind == PL_WATCH_RELEASE ? run->dae.L : run->event->G_series) + w->index;
    stride = (size_t)run->n_c;
    factor = run->setup->constraints[w->index].side;
    if (w->kind == PL_WATCH_LANDING) n = run->dae.use + 1;
  }
  for (int k = 0; k < n; k++, power *= h) c[k] = factor * power * X[(size_t)k * stride];
  return n;
}

static double size_of(const double* c, int n) {
  double s = 0;
  for (int k = 0; k < n; k++) s += fabs(c[k]);
  return s;
}

// The sign just after the start, of what is left when the first m coefficients are zero.
static double first_sign(const double* c, int n, double noise) {
  for (int k = 0; k < n; k++)
    if (fabs(c[k]) > noise) return sign(c[k]);
  return 0;
}

// Part of the size of its terms to which the series of n coefficients are known.
static double known_part(int n) { return fmax(pl_root_noise(n), 4e-15); }

// Whether a root with these signs before and behind it counts; 0 behind it: at the end of the step.
static bool is_wanted(const pl_watch* w, double h, int before, int after, bool at_end) {
  double d = w->direction * sign(h);
  bool touches = before == after;
  // a landing grazes; slip in space is watched by its square
  if ((w->kind == PL_WATCH_LANDING || w->kind == PL_WATCH_STICK) && touches) return before > 0;
  if (touches) return w->direction == 0;
  // else it is seen at the start of the next step
  if (after == 0) return at_end && (d == 0 || d * before < 0);
  return d == 0 || d * after > 0;
}

static double value_at(const double* c, int n, double x) {
  double p = 0;
  for (int k = n - 1; k >= 0; k--) p = p * x + c[k];
  return p;
}

// Whether the polynomial has not been away from zero before x.
static bool is_still_there(const double* c, int n, double x, double zero) {
  for (int i = 1; i < 8; i++)
    if (fabs(value_at(c, n, x * i / 8)) > zero) return false;
  return true;
}

enum { MOST_ROOTS = 16 };

// The first root that counts, in units of the step; -1 none.  m leading coefficients are zero.
static double first_that_counts(pl_run* run, const pl_watch* w, double h, const double* c, int n,
                                int m, double noise, bool* touches) {
  pl_real_root root[MOST_ROOTS];
  // known from its own velocity, however small it is
  bool bounced = w->fresh == 1
                 && (w->kind == PL_WATCH_LANDING
                     || (w->kind == PL_WATCH_EVENT && pl_event_sets(run, w->index)));
  double zero = bounced ? 0 : fmax(noise, 1e-14 * size_of(c, n));
  bool to_end = fabs(h) >= fabs(pl_run_left(run));
  // an event may be known to the tolerance: one that only touches is found to that
  double known = !run->stepper->to_rounding && w->kind == PL_WATCH_EVENT && w->direction == 0
                     ? fmax(known_part(n - m), run->control.tol)
                     : known_part(n - m);
  int found = pl_roots(c + m, n - 1 - m, known, m == 0 ? noise : 0, root, MOST_ROOTS,
                       run->event->root_work);
  for (int i = 0; i < found; i++) {
    int before = root[i].before, after = root[i].after;
    if (before == 0 && after == 0) continue;
    if (before == 0) {
      // at the very start: what happened there has been seen, unless it fell between the steps
      if (m > 0 || w->side == 0) continue;
      before = w->side;
    }
    if (m > 0 && is_still_there(c, n, root[i].x, zero)) continue;
    if (!is_wanted(w, h, before, after, to_end)) continue;
    *touches = before == after;
    return root[i].before == 0 ? 0 : root[i].x;
  }
  return -1;
}

// Earliest root of one item, in units of the step; -1 none.
static double find_root(pl_run* run, pl_watch* w, double h, bool* touches) {
  double* c = run->event->poly;
  int n = polynomial(run, w, h, c), m = w->fresh;
  double size = size_of(c, n), noise = fmax(pl_watch_noise(run, w, h), 1e-15 * size);
  *touches = false;
  if (m == 0 && w->side == 0) {
    // nothing known: at the start, or after a jump
    if (fabs(c[0]) <= fmax(noise, 1e-12 * size)) m = w->fresh = 1;
    else w->side = (int)sign(c[0]);
  }
  if (m == 0 && fabs(c[0]) > noise && sign(c[0]) == -w->side)
    return is_wanted(w, h, w->side, -w->side, true) ? 0 : -1;
  if (m > 0 && w->kind != PL_WATCH_EVENT) {
    // a contact that pulls at once, or a free one that sinks at once
    while (m < n && m < 3 && fabs(c[m]) <= noise) m++;
    if (first_sign(c + m, n - m, noise) < 0) return 0;
  }
  if (w->kind == PL_WATCH_LANDING && w->fresh == 1) noise = 0;
  if (m >= n || size_of(c + m, n - m) <= noise) return -1;
  for (int k = 0; k < m; k++) c[k] = 0;
  return first_that_counts(run, w, h, c, n, m, noise, touches);
}

// -------------------------------------------------------------------------- how far they are known
// Part of the step on which a polynomial in units of it is cut off below this part of its size:
// each order of the upper half as if it was the last. What is below the noise says nothing.
double pl_watch_known(double* c, int n, double noise, double part) {
  enum { ROUNDS = 60 };
  double all = 1, margin = n > 1 ? pow(part, 1.0 / (n - 1)) : 1;
  for (int round = 0; round < ROUNDS; round++) {
    double size = fmax(size_of(c, n), noise), least = 1, power = 1;
    for (int k = n - 1; k > n / 2; k--)
      if (fabs(c[k]) > 1e-3 * noise) least = fmin(least, margin * pow(size / fabs(c[k]), 1.0 / k));
    if (!(least < 0.9)) return all;
    for (int k = 0; k < n; k++, power *= least) c[k] *= power;
    all *= least;
  }
  return all;
}

double pl_watch_reach(pl_run* run, double h) {
  // roots are found to some 1e-14 of the step; where the motion is known less, so is what is
  // watched
  double part = fmax(100 * run->control.tol, 1e-14);
  for (int i = 0; i < run->event->n_watch; i++) {
    const pl_watch* w = &run->event->watch[i];
    if (is_of_friction(w) || !is_watched(run, w)) continue;
    int n = polynomial(run, w, h, run->event->poly);
    h *= pl_watch_known(run->event->poly, n, pl_watch_noise(run, w, h), part);
  }
  return h;
}

// The value of an event from its own equations, not from its series.
static double event_at(pl_run* run, int e, double t, const double* q, const double* v) {
  pl_batches* b = &run->watched;
  pl_batches_time(b, t);
  pl_batches_load_q(b, q, 0);
  pl_batches_load_v(b, v, 0);
  pl_batches_load_a(b, run->control.row_a, 0);
  pl_batches_load_lambda(b, run->control.row_l, 0);
  for (int l = PL_LEVEL_POSITION; l < PL_N_LEVELS; l++)
    pl_batches_sweep(b, (pl_tape_level)l, 0, true);
  pl_batches_outputs(b, run->event->W_coef, run->setup->n_watched, 0);
  return run->event->W_coef[run->setup->events[e].watch];
}

// Whether what is watched is as its polynomial says, at x of the step h: to this much, to its
// noise, and to the rounding of the time. The polynomial is in run->event->poly.
static bool is_as_predicted(pl_run* run, const pl_watch* w, double h, int n, double x, double value,
                            double most) {
  double t = run->dae.t + run->dae.t_low + x * h, slope = 0;
  for (int k = n - 1; k >= 1; k--) slope = slope * x + k * run->event->poly[k];
  double rounding = pl_watch_noise(run, w, h) + 16 * DBL_EPSILON * fabs(t * slope / h);
  return fabs(value - value_at(run->event->poly, n, x)) <= most + rounding;
}

bool pl_watch_holds(pl_run* run, double h, double x) {
  double part = fmax(1e3 * run->control.tol, 1e-9);
  for (int i = 0; i < run->event->n_watch; i++) {
    const pl_watch* w = &run->event->watch[i];
    if (!run->event->hit[i] || w->kind != PL_WATCH_EVENT) continue;
    pl_series_lambda_at(&run->dae, x * h, run->control.row_a, run->control.row_l);
    double value = event_at(run, w->index, run->dae.t + run->dae.t_low + x * h,
                            run->control.trial_q, run->control.trial_v);
    int n = polynomial(run, w, h, run->event->poly);
    if (!is_as_predicted(run, w, h, n, x, value, part * size_of(run->event->poly, n))) return false;
  }
  return true;
}

bool pl_watch_is_followed(pl_run* run, double h) {
  // of the values; what is faster than the step is off by all of them
  static const double place[] = {0.31, 0.83}, part = 0.02;
  for (size_t k = 0; k < sizeof place / sizeof *place; k++) {
    pl_series_at(&run->dae, place[k] * h, run->control.row_q, run->control.row_v);
    pl_series_lambda_at(&run->dae, place[k] * h, run->control.row_a, run->control.row_l);
    for (int i = 0; i < run->event->n_watch; i++) {
      const pl_watch* w = &run->event->watch[i];
      if (w->kind != PL_WATCH_EVENT) continue;
      double t = run->dae.t + run->dae.t_low + place[k] * h,
             value = event_at(run, w->index, t, run->control.row_q, run->control.row_v);
      int n = polynomial(run, w, h, run->event->poly);
      double size = fabs(value) + fabs(run->event->poly[0])
                    + fabs(value_at(run->event->poly, n, 1));
      if (!is_as_predicted(run, w, h, n, place[k], value, part * size)) return false;
    }
  }
  return true;
}

// -------------------------------------------------------------------------------- the first of all
double pl_watch_first(pl_run* run, double h) {
  static const double together = 1e-12;  // of the step: roots closer than this happen at once
  double first = -1;
  for (int i = 0; i < run->event->n_watch; i++) {
    run->event->touch[i] = false;
    run->event->root[i] = is_watched(run, &run->event->watch[i])
                              ? find_root(run, &run->event->watch[i], h, &run->event->touch[i])
                              : -1;
    if (run->event->root[i] >= 0 && (first < 0 || run->event->root[i] < first))
      first = run->event->root[i];
  }
  for (int i = 0; i < run->event->n_watch; i++)
    run->event->hit[i] = run->event->root[i] >= 0 && run->event->root[i] <= first + together;
  return first < 0 ? -1 : first;
}

// -------------------------------------------------------------------------------------- afterwards
void pl_watch_passed(pl_run* run, double h) {
  run->event->sunk = -1;
  run->event->undecided = false;
  for (int i = 0; i < run->event->n_watch; i++) {
    pl_watch* w = &run->event->watch[i];
    if (!is_watched(run, w)) continue;
    int n = polynomial(run, w, h, run->event->poly);
    double x = 0;
    for (int k = n - 1; k >= 0; k--) x += run->event->poly[k];
    // a step of the implicit method may be so short that what has happened is not yet clear of
    // rounding
    bool clear = run->stepper->to_rounding || fabs(x) > pl_watch_noise(run, w, h);
    if (h != 0 && clear) w->fresh = 0;
    if (w->kind == PL_WATCH_LANDING && x < -1e-9 * run->dae.g_size[w->index])
      run->event->sunk = w->index;
    // what the roots leave open at the end is decided at the start of the next step
    bool decided = fabs(x) > fmax(pl_watch_noise(run, w, h),
                                  2 * known_part(n) * size_of(run->event->poly, n));
    if (decided) w->side = (int)sign(x);
    run->event->undecided |= !decided;
  }
  // slip in space that has become clear of rounding counts as none only far below that again
  for (int r = 0; r < run->setup->n_frictions; r++) {
    pl_friction_state* now = &run->dae.friction[r];
    double d[3], least = 1e-12 * run->dae.v_size;
    if (run->setup->frictions[r].n_rows == 3 && now->state == PL_FRICTION_SLIP
        && now->small != least && pl_friction_speed(&run->dae, r, run->dae.r, d) > 1e3 * least)
      now->small = least;
  }
}
