// A step on extended numbers: projection, order 0, series. As step_program_run.c, which has the
// same programs for doubles.
//
// The state is rounded to its type with each correction of the projection, and nowhere else: what
// is computed from it is more exact than that by the digits that the fine type has more, so that
// the rounding of the state is the only error that counts, and it has no direction. Then errors
// grow like a random walk: Brouwer's law [Brouwer1937].
#include <math.h>
#include <string.h>

#include "solve/stepper/taylor/extended_impl.h"

// Part of the largest sum ever subtracted at a pivot at which this is lost, compared with the best
// part: the digits that are left are still those of a double.
static const double sound = 1e-16;
// of what was subtracted there: below, it may be rounding
static const double least_sound = 1e-24;

static void fine(pl_run* run, const pl_prog* code, int from, int to) {
  run->extended->fine->interpret(code, run->extended->m, from, to);
}
static void fine_part(pl_run* run, pl_step_part part) {
  fine(run, run->extended->o->code[part], 0, 1);
}
static void read(const pl_run* run, int at, int n, double* out) {
  run->extended->fine->read(run->extended->m, at, n, out);
}

void pl_extended_copy(const pl_real* to_type, void* to, int at, const pl_real* from_type,
                      const void* from, int from_at, int n) {
  for (int i = 0; i < n; i++) to_type->set(to, at + i, from_type->get(from, from_at + i));
}

// -------------------------------------------------------------------------------------- projection
static bool pivots_are_sound(pl_run* run) {
  pl_step_program* o = run->extended->o;
  double least = (double)INFINITY;
  for (int u = o->n_mass; u < o->n; u++) {
    double size, pivot, part;
    read(run, o->pivot_size + u, 1, &size);
    read(run, o->pivot + u, 1, &pivot);
    if (size > o->size_most[u]) o->size_most[u] = size;
    part = fabs(pivot) / o->size_most[u];
    if (!(part >= least)) least = part;
  }
  if (o->n == o->n_mass) return true;
  run->extended->part = o->fade_best > 0 ? fmin(1, least / o->fade_best) : 1;
  run->dae.smallest = least > 0 && o->fade_best > 0
                          ? run->dae.best * sqrt(fmin(1, least / o->fade_best))
                          : run->dae.best;
  if (!(least > least_sound)) return false;
  if (least > o->fade_best) o->fade_best = least;
  return least > sound * o->fade_best;
}

static void note_largest(double x, double* most) {
  if (!(x <= *most)) *most = x;
}

static void set_floors(pl_run* run) {
  pl_extended* w = run->extended;
  for (int i = 0; i < run->n_q; i++) {
    double q = fmax(run->dae.q_most[i], 1e-6 * run->dae.q_size),
           v = fmax(run->dae.v_most[i], 1e-6 * run->dae.v_size);
    w->fine->write(w->m, w->o->q_floor + i, 1, &q);
    w->fine->write(w->m, w->o->v_floor + i, 1, &v);
  }
}

// Adds the correction to the state at x, which is then rounded; the size of the correction relative
// to that of the state.
static double correct(pl_run* run, pl_step_part part, int x, double size) {
  pl_extended* w = run->extended;
  int n = run->n_q;
  fine_part(run, part);
  read(run, w->o->move, n, run->dae.rhs);
  w->fine->add(w->m, x, w->o->move, n);
  if (w->state != w->fine) w->fine->round_to_long(w->m, x, n);
  double most = pl_norm(run->dae.rhs, n);
  return size > 0 ? most / size : most;
}

static bool is_done(const pl_run* run, double residual) {
  return residual == 0 && run->extended->state == run->extended->fine;
}

static bool project_positions(pl_run* run, pl_projection* p) {
  enum { MAX_NEWTON = 8 };
  const pl_step_program* o = run->extended->o;
  double before = (double)INFINITY;
  for (int round = 0; round < MAX_NEWTON; round++) {
    fine_part(run, PL_PART_POSITION);
    read(run, o->g, run->n_c, run->dae.g);
    read(run, o->g_size, run->n_c, run->dae.g_size);
    double g = pl_residual(&run->dae, run->dae.g, run->dae.g_size, true);
    if (round == 0) p->g_before = g;
    p->g_after = g;
    if (!isfinite(g) || !pivots_are_sound(run)) return false;
    if (is_done(run, g) || (round > 0 && (g <= run->extended->floor || g >= 0.5 * before)))
      return true;
    before = g;
    double move = correct(run, PL_PART_CORRECT_Q, o->Q, run->dae.q_size);
    if (!isfinite(move)) return false;
    note_largest(move, &p->move_q);
  }
  return false;
}

static bool project_velocities(pl_run* run, pl_projection* p) {
  const pl_step_program* o = run->extended->o;
  for (int round = 0;; round++) {
    fine_part(run, PL_PART_VELOCITY);
    read(run, o->r, run->n_c, run->dae.r);
    read(run, o->r_size, run->n_c, run->dae.r_size);
    double r = pl_residual(&run->dae, run->dae.r, run->dae.r_size, false);
    if (round == 0) p->r_before = r;
    p->r_after = r;
    if (!isfinite(r)) return false;
    if (round > 0 || is_done(run, r)) return true;
    double move = correct(run, PL_PART_CORRECT_V, o->V, run->dae.v_size);
    if (!isfinite(move)) return false;
    note_largest(move, &p->move_v);
  }
}

bool pl_extended_project(pl_run* run, pl_projection* p) {
  pl_extended* w = run->extended;
  run->dae.at_point = w->arrived = false;
  *p = (pl_projection){0};
  pl_sizes_note(&run->dae, run->control.trial_q, run->control.trial_v);
  set_floors(run);
  w->fine->move(w->m, w->o->Q, w->o->end_q, run->n_q);
  w->fine->move(w->m, w->o->V, w->o->end_v, run->n_q);
  fine(run, w->clock, 0, 1);
  p->ok = project_positions(run, p) && project_velocities(run, p);
  if (!p->ok) return false;
  read(run, w->o->Q, run->n_q, run->control.trial_q);
  read(run, w->o->V, run->n_q, run->control.trial_v);
  run->dae.at_point = true;
  run->dae.factored = false;
  return true;
}

void pl_extended_accept(pl_run* run, bool to_end) {
  if (to_end) return;
  pl_parts t = run->extended->fine->get(run->extended->m, run->extended->o->time);
  run->dae.t = t.part[0];
  run->dae.t_low = t.part[1];
}

// ----------------------------------------------------------------------------------------- order 0
static void read_orders(pl_run* run, int first, int last) {
  const pl_step_program* o = run->extended->o;
  size_t n_q = (size_t)o->n_q, n_c = (size_t)o->n_c, k = (size_t)first;
  int n = last - first + 1;
  read(run, o->Q + first * o->n_q, (n + 1) * o->n_q, run->dae.Q + k * n_q);
  read(run, o->V + first * o->n_q, (n + 1) * o->n_q, run->dae.V + k * n_q);
  read(run, o->A + first * o->n_q, n * o->n_q, run->dae.A + k * n_q);
  read(run, o->L + first * o->n_c, n * o->n_c, run->dae.L + k * n_c);
}

// Of dependent rows others may be better conditioned by now than those that were chosen.
static bool look_at_rows(pl_run* run) {
  static const double faded = 1e-4;
  const pl_extended* w = run->extended;
  if (run->dae.rank == run->dae.n_active || !(w->part < faded)) return true;
  pl_extended_change_rows(run);
  if (run->extended == w) return true;
  set_floors(run);
  fine_part(run, PL_PART_POSITION);
  fine_part(run, PL_PART_VELOCITY);
  return pivots_are_sound(run);
}

bool pl_extended_enter(pl_run* run) {
  const pl_extended* before = run->extended;
  bool arrived = before->arrived;
  run->extended->arrived = false;
  if (!look_at_rows(run)) return false;
  pl_extended* w = run->extended;
  const pl_step_program* o = w->o;
  w->fine->move(w->m, w->t_0, o->time, 1);
  if (!arrived || w != before) fine_part(run, PL_PART_START);
  w->fine->move(w->m, w->q_0, o->Q, 2 * o->n_q);
  w->fine->move(w->m, w->v_0, o->V, 2 * o->n_q);
  w->fine->move(w->m, w->a_0, o->A, o->n_q);
  w->fine->move(w->m, w->l_0, o->L, o->n_c);
  if (w->by_doubles) pl_step_program_enter_at(run, run->dae.t, run->dae.q, run->dae.v);
  read_orders(run, 0, 0);
  read(run, o->h, o->n_q, run->dae.rhs);
  run->dae.force_size = fmax(run->dae.force_size, pl_norm(run->dae.rhs, o->n_q));
  run->dae.ready = isfinite(pl_norm(run->dae.A, o->n_q)) && isfinite(pl_norm(run->dae.L, o->n_c));
  return run->dae.ready;
}

bool pl_extended_arrive(pl_run* run, double* off, double* size) {
  pl_extended* w = run->extended;
  pl_extended_sum(run);
  fine_part(run, PL_PART_START);
  w->arrived = true;
  *off = *size = 0;
  for (int i = 0; i < run->n_q; i++) {
    pl_parts a = w->fine->get(w->m, w->end_a + i), b = w->fine->get(w->m, w->o->A + i);
    *off = pl_size_with(*off, (a.part[0] - b.part[0]) + (a.part[1] - b.part[1]));
    *size = pl_size_with(*size, b.part[0]);
  }
  return isfinite(*size);
}

// ------------------------------------------------------------------------------------------ series
void pl_extended_expand(pl_run* run) {
  pl_extended* w = run->extended;
  fine(run, w->o->code[PL_PART_ORDER], 1, w->low);
  if (w->by_doubles) {
    if (!pl_step_program_is_compiled(run)) run->stats.steps_interpreted++;
    pl_step_program_expand(run);
    return;
  }
  run->stats.steps_interpreted++;
  fine(run, w->top, 0, 1);
  read_orders(run, 1, run->order - 1);
  read(run, w->o->Q + (run->order + 1) * run->n_q, run->n_q,
       run->dae.Q + (size_t)(run->order + 1) * (size_t)run->n_q);
}

void pl_extended_norms(pl_run* run, const double** q, const double** v) {
  pl_step_program* o = run->extended->o;
  if (run->extended->by_doubles) {
    pl_step_program_norms(run, q, v);
    return;
  }
  fine_part(run, PL_PART_NORMS);
  read(run, o->norms, 2 * PL_BLOCK_ROWS, o->m + o->norms);
  *q = o->m + o->norms;
  *v = *q + PL_BLOCK_ROWS;
}

// Lengths that depend on the state alone fall into step with a periodic motion: step ends then come
// to lie at the same places in every period, the same roundings come again, and errors go on in one
// direction or in circles. So each length is shortened by up to a tenth, by the multiples of the
// golden section, which keep no time with anything.
double pl_extended_vary(const pl_run* run, double h) {
  static const double golden = 0.61803398874989485, most = 0.1;
  double turns = golden * (double)run->stats.steps;
  return run->extended->state == run->extended->fine ? h : h * (1 - most * (turns - floor(turns)));
}

// The sum of rows first .. last of a series in doubles, divided by dt^first.
static void sum_tail(pl_run* run, int to, const double* X, int n, int first, int last) {
  double dt;
  read(run, run->extended->o->length, 1, &dt);
  for (int i = 0; i < n; i++) {
    double x = X[(size_t)last * (size_t)n + (size_t)i];
    for (int k = last - 1; k >= first; k--) x = x * dt + X[(size_t)k * (size_t)n + (size_t)i];
    run->extended->fine->write(run->extended->m, to + i, 1, &x);
  }
}

static void sum_state(pl_run* run) {
  pl_extended* w = run->extended;
  if (w->by_doubles) {
    sum_tail(run, w->tail_q, run->dae.Q, run->n_q, w->low + 1, run->order + 1);
    sum_tail(run, w->tail_v, run->dae.V, run->n_q, w->low + 1, run->order);
  }
  fine(run, w->head, 0, 1);
}

void pl_extended_sum(pl_run* run) {
  pl_extended* w = run->extended;
  sum_state(run);
  if (w->by_doubles) {
    sum_tail(run, w->tail_a, run->dae.A, run->n_q, w->low, run->order - 1);
    sum_tail(run, w->tail_l, run->dae.L, run->n_c, w->low, run->order - 1);
  }
  fine(run, w->head_forces, 0, 1);
}

void pl_extended_advance(pl_run* run, double dt) {
  pl_extended* w = run->extended;
  // to the end as it is exactly
  if (dt == run->options.t_end - run->dae.t - run->dae.t_low) fine(run, w->left, 0, 1);
  else w->fine->write(w->m, w->o->length, 1, &dt);
  sum_state(run);
  read(run, w->o->end_q, run->n_q, run->control.trial_q);
  read(run, w->o->end_v, run->n_q, run->control.trial_v);
}

// ------------------------------------------------------------------------------------------ events
static int event_hit(const pl_run* run) {
  for (int i = 0; i < run->event->n_watch; i++)
    if (run->event->hit[i] && !run->event->touch[i] && run->event->watch[i].kind == PL_WATCH_EVENT)
      return run->setup->events[run->event->watch[i].index].watch;
  return -1;
}

// Derivative of watched quantity i on the step.
static double slope_at(const pl_run* run, int i, double dt) {
  double slope = 0;
  for (int k = run->order - 1; k >= 1; k--)
    slope = slope * dt
            + k * run->event->W_series[(size_t)k * (size_t)run->setup->n_watched + (size_t)i];
  return slope;
}

static double watched_value(pl_run* run, int i) {
  pl_extended* w = run->extended;
  pl_sheet* s = w->watched;
  const pl_step_program* o = w->o;
  pl_extended_sum(run);
  fine(run, w->clock, 0, 1);
  pl_extended_copy(s->real, s->m, s->time, w->fine, w->m, o->time, 1);
  pl_extended_copy(s->real, s->m, s->Q, w->fine, w->m, o->end_q, o->n_q);
  pl_extended_copy(s->real, s->m, s->V, w->fine, w->m, o->end_v, o->n_q);
  pl_extended_copy(s->real, s->m, s->A, w->fine, w->m, w->end_a, o->n_q);
  pl_extended_copy(s->real, s->m, s->L, w->fine, w->m, w->end_l, o->n_c);
  pl_sheet_run(s);
  double x;
  s->real->read(s->m, s->out + i, 1, &x);
  return x;
}

void pl_extended_refine(pl_run* run, double dt) {
  enum { MAX_NEWTON = 6 };
  static const double most = 1e-8;  // of the step, that a root found in doubles may be off
  pl_extended* w = run->extended;
  int i = event_hit(run);
  if (i < 0) return;
  double slope = slope_at(run, i, dt), before = most * fabs(dt);
  for (int round = 0; round < MAX_NEWTON; round++) {
    double move = -watched_value(run, i) / slope;
    if (!(fabs(move) <= before)) return;
    w->fine->write(w->m, w->scratch, 1, &move);
    w->fine->add(w->m, w->o->length, w->scratch, 1);
    if (fabs(move) <= w->state->epsilon * fabs(dt)) break;
    before = 0.5 * fabs(move);
  }
  sum_state(run);
  read(run, w->o->end_q, run->n_q, run->control.trial_q);
  read(run, w->o->end_v, run->n_q, run->control.trial_v);
}

// ------------------------------------------------------------------------------------------ energy
static void evaluate_energies(pl_run* run) {
  pl_extended* w = run->extended;
  const pl_setup* s = run->setup;
  if (w->o->code[PL_PART_ENERGY]) {
    fine_part(run, PL_PART_ENERGY);
    return;
  }
  pl_row row;
  pl_extended_row(run, &row, run->control.energy_out);
  pl_extended_copy(w->fine, w->m, w->o->energy, w->rows->real, w->rows->m,
                   w->rows->out + s->kinetic, 1);
  pl_extended_copy(w->fine, w->m, w->o->energy + 1, w->rows->real, w->rows->m,
                   w->rows->out + s->potential, 1);
  if (s->energy > 0)
    pl_extended_copy(w->fine, w->m, w->o->energy + 2, w->rows->real, w->rows->m,
                     w->rows->out + s->energy, 1);
}

bool pl_extended_energy(pl_run* run, bool anew, pl_energy* e) {
  pl_extended* w = run->extended;
  double part[2], change[2];
  evaluate_energies(run);
  fine(run, w->drift, 0, 1);
  read(run, w->o->energy, 2, part);
  read(run, w->scratch, 2, change);
  if (anew) w->fine->move(w->m, w->energy_base, w->scratch + 1, 1);
  *e = (pl_energy){
      .kinetic = part[0], .potential = part[1], .total = change[1], .change = change[0]};
  return true;
}
