// The implicit method: what is watched, and steps that end on its roots.
//
// A watched quantity is known at the start of a step, at its stages and, with the accelerations and
// multipliers of the point reached, at its end. The polynomial through these values is searched for
// roots as that of a series is (watch.c); a landing has the integral of the velocity along g, so
// that a small bounce is seen in that velocity. The root found is then iterated on the end of the
// step, so that it is as exact as the step itself.
#include "solve/stepper/radau/radau_impl.h"

#include <float.h>
#include <math.h>
#include <string.h>

// ------------------------------------------------------------------------------- forces at the end
// Accelerations and multipliers of the state in trial_q, trial_v; the run stays where it is.
static void forces_at_end(pl_run* run, pl_radau* r, double h) {
  double t = run->dae.t, t_low = run->dae.t_low, *q = run->dae.q, *v = run->dae.v;
  memcpy(r->save_a, run->dae.A, (size_t)r->n_q * sizeof(double));
  memcpy(r->save_l, run->dae.L, (size_t)r->n_c * sizeof(double));
  run->dae.t = t + (t_low + h);
  run->dae.t_low = 0;
  run->dae.q = run->control.trial_q;
  run->dae.v = run->control.trial_v;
  bool fine = pl_point_enter(&run->dae);
  run->dae.t = t;
  run->dae.t_low = t_low;
  run->dae.q = q;
  run->dae.v = v;
  const double* a = fine ? run->dae.A : pl_radau_stage(r->A, r->method.s - 1, r->n_q);
  const double* l = fine ? run->dae.L : pl_radau_stage(r->L, r->method.s - 1, r->n_c);
  memcpy(r->end_a, a, (size_t)r->n_q * sizeof(double));
  memcpy(r->end_l, l, (size_t)r->n_c * sizeof(double));
  memcpy(run->dae.A, r->save_a, (size_t)r->n_q * sizeof(double));
  memcpy(run->dae.L, r->save_l, (size_t)r->n_c * sizeof(double));
  run->dae.ready = true;
}

// -------------------------------------------------------------------------------- values at a node
// Everything that is watched, at one point of the step.
typedef struct node {
  double t;
  const double *q, *v, *a, *lambda;
} node;

static node node_at(const pl_run* run, const pl_radau* r, double h, int i) {
  int s = r->method.s;
  if (i == 0)
    return (node){run->dae.t + run->dae.t_low, run->dae.q, run->dae.v, run->dae.A, run->dae.L};
  if (i == s)
    return (node){run->dae.t + (run->dae.t_low + h), run->control.trial_q, run->control.trial_v,
                  r->end_a, r->end_l};
  return (node){r->t[i - 1], pl_radau_stage(r->Q, i - 1, r->n_q),
                pl_radau_stage(r->V, i - 1, r->n_q), pl_radau_stage(r->A, i - 1, r->n_q),
                pl_radau_stage(r->L, i - 1, r->n_c)};
}

static void watch_quantities(pl_run* run, const node* n) {
  pl_batches* b = &run->watched;
  if (run->setup->n_watched == 0) return;
  pl_batches_time(b, n->t);
  pl_batches_load_q(b, n->q, 0);
  pl_batches_load_v(b, n->v, 0);
  pl_batches_load_a(b, n->a, 0);
  pl_batches_load_lambda(b, n->lambda, 0);
  for (int level = PL_LEVEL_POSITION; level < PL_N_LEVELS; level++)
    pl_batches_sweep(b, (pl_tape_level)level, 0, true);
  pl_batches_outputs(b, run->event->W_coef, run->setup->n_watched, 0);
}

static double force_left(const pl_run* run, int k, const double* lambda) {
  const pl_friction_setup* friction = &run->setup->frictions[k];
  double most = run->dae.C_series[friction->limit] * lambda[friction->constraint],
         F = pl_friction_force(&run->dae, k, lambda);
  return most * most - F * F;
}

static double slip_left(const pl_run* run, int k) {
  const pl_friction_setup* friction = &run->setup->frictions[k];
  const pl_friction_state* now = &run->dae.friction[k];
  double square = -now->small * now->small;
  if (friction->n_rows == 1) return now->way * run->dae.r[friction->row[0]];
  for (int i = 0; i < 3; i++) square += run->dae.r[friction->row[i]] * run->dae.r[friction->row[i]];
  return square;
}

// The value of one item; of a landing the velocity along g.
static double value_of(const pl_run* run, const pl_watch* w, const node* n) {
  switch (w->kind) {
    case PL_WATCH_RELEASE: return run->setup->constraints[w->index].side * n->lambda[w->index];
    case PL_WATCH_LANDING: return run->setup->constraints[w->index].side * run->dae.r[w->index];
    case PL_WATCH_STICK: return slip_left(run, w->index);
    case PL_WATCH_SLIP: return force_left(run, w->index, n->lambda);
    case PL_WATCH_PRESS:
      return run->dae.friction[w->index].press
             * n->lambda[run->setup->frictions[w->index].constraint];
    case PL_WATCH_EVENT: return run->event->W_coef[run->setup->events[w->index].watch];
  }
  return 0;
}

static double* values_of(const pl_radau* r, int watch) {
  return r->watched + (size_t)watch * (PL_RADAU_MOST + 1);
}

void pl_radau_watch(pl_run* run, pl_radau* r, double h) {
  bool contacts = run->dae.watch_landings || run->setup->n_frictions > 0;
  int s = r->method.s;
  if (run->event->n_watch == 0 && run->event->n_switches == 0) return;
  if (run->event->n_watch > 0) forces_at_end(run, r, h);
  r->watched_h = h;
  for (int i = 0; i <= s; i++) {
    node n = node_at(run, r, h, i);
    watch_quantities(run, &n);
    // sizes of terms
    if (i == 0)
      memcpy(run->event->W_series, run->event->W_coef,
             (size_t)run->setup->n_watched * sizeof(double));
    if (contacts || run->event->n_switches > 0) pl_point_evaluate(&run->dae, n.t, n.q, n.v);
    for (int k = 0; k < run->event->n_switches; k++)
      r->bent[(size_t)k * (PL_RADAU_MOST + 1) + (size_t)i] = pl_switching_value(run, k);
    if (contacts) {
      // the sizes of the start are what the search for roots reads
      pl_assemble_g(&run->dae, 0, i == 0 ? r->first_g : r->last_g, i == 0 ? run->dae.g_size : NULL);
      pl_assemble_gdot(&run->dae, run->dae.r, run->dae.r_size);
      if (run->setup->n_frictions > 0) pl_friction_coefficients(&run->dae, 0);
    }
    if (i == 0 && run->setup->n_frictions > 0)
      memcpy(run->event->S_series, run->dae.r, (size_t)r->n_c * sizeof(double));
    for (int k = 0; k < run->event->n_watch; k++)
      values_of(r, k)[i] = value_of(run, &run->event->watch[k], &n);
  }
  if (contacts || run->event->n_switches > 0) run->dae.factored = false;
}

// ------------------------------------------------------------------------------------- polynomials
static double through(const pl_radau* r, const double* value, int k) {
  double sum = 0;
  for (int i = 0; i <= r->method.s; i++) sum += r->method.power_all[k][i] * value[i];
  return sum;
}

// g from its rate; what that misses at the end goes to the highest power, unless it is rounding.
static int landing(const pl_run* run, const pl_radau* r, const pl_watch* w, const double* rate,
                   double* c) {
  int s = r->method.s, side = run->setup->constraints[w->index].side;
  double sum = c[0] = side * r->first_g[w->index];
  for (int k = 0; k <= s; k++) {
    c[k + 1] = r->watched_h * (k == 0 ? rate[0] : through(r, rate, k)) / (k + 1);
    sum += c[k + 1];
  }
  double off = side * r->last_g[w->index] - sum;
  if (fabs(off) > pl_watch_noise(run, w, r->watched_h)) c[s + 1] += off;
  return s + 2;
}

int pl_radau_polynomial(const pl_run* run, int watch, double* c) {
  const pl_radau* r = run->radau;
  const double* value = values_of(r, watch);
  if (run->event->watch[watch].kind == PL_WATCH_LANDING)
    return landing(run, r, &run->event->watch[watch], value, c);
  c[0] = value[0];
  for (int k = 1; k <= r->method.s; k++) c[k] = through(r, value, k);
  return r->method.s + 1;
}

// -------------------------------------------------------------------------------- switching points
// Values at the stages as a series, for pl_switching_first.
static void bend(pl_run* run, const pl_radau* r, double h) {
  size_t order = (size_t)run->order;
  memset(run->event->K_series, 0, (size_t)run->event->n_switches * order * sizeof(double));
  for (int i = 0; i < run->event->n_switches; i++) {
    const double* value = r->bent + (size_t)i * (PL_RADAU_MOST + 1);
    double power = 1;
    for (int k = 0; k <= r->method.s && k < run->order; k++, power *= h)
      run->event->K_series[(size_t)i * order + (size_t)k] =
          (k == 0 ? value[0] : through(r, value, k)) / power;
  }
}

// A force that changes its branch within the step costs the order: a step ends behind the switching
// point.
pleuel_status pl_radau_stop_at_switches(pl_run* run, pl_radau* r, double* h, pl_projection* p) {
  enum { MOST = 8 };
  double error, next;
  for (int round = 0; run->event->n_switches > 0 && round < MOST; round++) {
    bend(run, r, *h);
    double at_switch = pl_switching_first(run, *h);
    if (at_switch < 0 || at_switch > 1 - 1e-9 || !(at_switch * fabs(*h) > run->control.h_least))
      break;
    *h *= at_switch;
    pl_sizes_forget(&run->dae);
    PL_TRY(pl_radau_hold(run, r, h, &error, &next, p));
    pl_radau_watch(run, r, *h);
    pl_radau_series(run, r, *h);
  }
  return PLEUEL_OK;
}

// ------------------------------------------------------------------------------- landing on a root
// The one of those that are hit which comes first.
static int first_hit(const pl_run* run) {
  int first = -1;
  for (int i = 0; i < run->event->n_watch; i++)
    if (run->event->hit[i] && (first < 0 || run->event->root[i] < run->event->root[first]))
      first = i;
  return first;
}

// How far the end of the step held is before the root, by the value there and the slope of the
// polynomial; 0 on it.
static double way_to_root(const pl_run* run, const pl_radau* r, int watch, double h, double* c) {
  const pl_watch* w = &run->event->watch[watch];
  int n = pl_radau_polynomial(run, watch, c), s = r->method.s;
  double slope = 0, value = w->kind == PL_WATCH_LANDING
                                ? run->setup->constraints[w->index].side * r->last_g[w->index]
                                : values_of(r, watch)[s];
  for (int k = 1; k < n; k++) slope += k * c[k];
  if (w->kind == PL_WATCH_LANDING) slope = h * values_of(r, watch)[s];
  return fabs(value) <= pl_watch_noise(run, w, h) ? 0 : -value / slope * h;
}

// Slip in space is watched by its square, which hardly changes its sign: a double root.
static bool is_square(const pl_run* run, int watch) {
  const pl_watch* w = &run->event->watch[watch];
  return w->kind == PL_WATCH_STICK && run->setup->frictions[w->index].n_rows == 3;
}

// Steps of the length at which what is hit is zero at the end, by Newton on the length. *root stays
// where it is reached; else it is looked for again behind the shorter step that was taken: -1.
pleuel_status pl_radau_land(pl_run* run, pl_radau* r, double* h, double* root, pl_projection* p) {
  enum { MOST = 8 };
  int watch = first_hit(run);
  double error, next, landed = *root, change_before = (double)INFINITY;
  *h *= landed;
  *root = -1;
  for (int round = 0; round < MOST; round++) {
    double length = *h;
    if (!(fabs(length) > run->control.h_least)) {
      *root = 0;
      return PLEUEL_OK;
    }
    PL_TRY(pl_radau_hold(run, r, h, &error, &next, p));
    pl_radau_watch(run, r, *h);
    pl_radau_series(run, r, *h);
    if (*h != length) return PLEUEL_OK;
    if (run->event->touch[watch] && !is_square(run, watch)) break;  // it has no slope there
    double change = way_to_root(run, r, watch, *h, run->event->poly);
    if (is_square(run, watch)) change *= 2;
    if (!isfinite(change) || fabs(change) > 0.5 * fabs(*h)) return PLEUEL_OK;
    if (fabs(change) <= 4 * DBL_EPSILON * fmax(fabs(run->dae.t), fabs(*h)) || round + 1 == MOST)
      break;
    // rounding decides
    if (round > 2 && fabs(change) >= 0.5 * change_before) break;
    change_before = fabs(change);
    *h += change;
    pl_sizes_forget(&run->dae);
  }
  *root = landed;
  return PLEUEL_OK;
}
