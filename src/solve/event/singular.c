// Singular positions: where the constraints lose rank for a moment.
//
// The smallest pivot of the independent rows fades linearly in time towards such a place. The
// motion itself is smooth there as a rule, but its coefficients are not computable: near the place
// order k carries rounding errors of size ε / d^k, d being the distance. So the last steps before
// it are replaced by one leap to the mirror point behind it, with a series cut at an order low
// enough for its errors and high enough for the distance. Velocities are continuous by
// construction. The leap counts only if the constraints at the far side are met almost without
// correction, if two orders agree and if the energy, where it is conserved, is the same; it is
// recorded as an event. Otherwise the run stops and says where.
// See theory (15.2).
#include "solve/event/event.h"

#include <float.h>
#include <math.h>
#include <string.h>

// part of its largest value at which the smallest pivot counts as zero
static const double faded = 1e-6;
static const double near = 0.1;  // part of it from which a leap is considered
// Correction that a leap may need, relative. Rounding is magnified across the branches, where the
// constraints are weak, and the projection removes it; another branch is as far away as the motion
// is large.
static const double off_branch = 1e-8;
// orders of a leap: 2^order rounding errors, and few enough
enum { LEAP_LEAST = 3, LEAP_MOST = 10 };

// ------------------------------------------------------------------------------------------- where
// How far ahead the smallest pivot, continued linearly from where it was twice as large, is zero; 0
// when that says nothing.
static double reach_of_singular(const pl_run* run) {
  double way = run->dae.t - run->event->fade[0].t,
         slope = (run->event->smallest_here - run->event->fade[0].smallest) / way;
  if (!isfinite(slope) || run->event->fade[0].smallest == 0) return 0;
  double reach = -run->event->smallest_here / slope;
  return isfinite(reach) && reach * way > 0 && fabs(reach) < 4 * fabs(way) ? reach : 0;
}

// Keeps two earlier points, each with at most 0.7 of the pivot of the one before.
void pl_singular_watch(pl_run* run) {
  run->event->smallest_here = run->dae.smallest;
  if (run->event->smallest_here >= 0.3 * run->dae.best)
    run->event->h_regular = run->control.h_series;
  if (run->event->smallest_here <= 0.7 * run->event->fade[1].smallest)
    run->event->fade[0] = run->event->fade[1];
  else if (run->event->smallest_here < run->event->fade[1].smallest) return;
  else run->event->fade[0] = (pl_fade){0, 0};
  run->event->fade[1] = (pl_fade){run->dae.t, run->event->smallest_here};
}

bool pl_is_singular(const pl_run* run) {
  if (run->dae.rank_mode >= 0 && run->dae.rank < run->dae.rank_mode) return true;
  return run->dae.best > 0 && run->event->smallest_here < faded * run->dae.best
         && run->event->smallest_here < run->dae.smallest_before;
}

// ---------------------------------------------------------------------------------- stopping there
static void place_in_words(const pl_run* run, double reach, char* where, size_t size) {
  size_t n = 0;
  where[0] = '\0';
  for (int i = 0; i < run->n_q && n < size - 64; i++) {
    if (run->setup->coordinates[i].hidden) continue;
    int w = snprintf(where + n, size - n, "%s%s = %.4g", n ? ", " : "",
                     run->setup->coordinates[i].name, run->dae.q[i] + reach * run->dae.v[i]);
    if (w < 0 || (size_t)w >= size - n) break;
    n += (size_t)w;
  }
}

// A coordinate that neither a mass nor a constraint in force accelerates; -1 none.
static int without_inertia(const pl_run* run) {
  const pl_kkt* k = &run->dae.kkt;
  for (int i = 0; i < run->n_q; i++)
    if (run->dae.has_equation[i] != 0 && k->value[k->diagonal[i]] == 0) return i;
  return -1;
}

static bool all_finite(const double* x, int n) {
  for (int i = 0; i < n; i++)
    if (!isfinite(x[i])) return false;
  return true;
}

// Whether masses, gradients and forces have numbers at what was evaluated last.
static bool has_numbers(pl_run* run) {
  if (!all_finite(run->dae.kkt.value, run->dae.kkt.n_values)) return false;
  pl_batches_sweep(&run->dae.motion, PL_LEVEL_POSITION, 1, true);
  pl_assemble_rhs(&run->dae, 0, run->dae.rhs);
  return all_finite(run->dae.rhs, run->n_q);
}

pleuel_status pl_run_undetermined(pl_run* run) {
  char where[320];
  place_in_words(run, 0, where, sizeof where);
  if (run->control.started && run->options.precision != PL_PRECISION_DOUBLE) {
    pl_point_evaluate(&run->dae, run->dae.t, run->dae.q, run->dae.v);
    pl_assemble_matrix(&run->dae, false);
  }
  if (!has_numbers(run))
    return pl_fail(run->job, PLEUEL_NUMERICAL,
                   "forces, masses or constraints have no number at t = %.9g s (%s): a root, a "
                   "logarithm or a quotient there",
                   run->dae.t, where);
  int idle = without_inertia(run);
  if (run->dae.rank == run->dae.n_active && idle >= 0)
    return pl_fail(run->job, PLEUEL_SINGULAR,
                   "%s carries no mass, and no constraint moves it: its equation contains no "
                   "acceleration, and what forces say "
                   "about its place is not simulated",
                   run->setup->coordinates[idle].name);
  if (run->dae.rank == run->dae.n_active && !run->control.started)
    return pl_fail(run->job, PLEUEL_SINGULAR,
                   "the mass matrix is singular at t = %.9g s (%s): the equations of motion do not "
                   "determine all accelerations",
                   run->dae.t, where);
  return pl_run_singular(run);
}

static bool in_constraint(const pl_run* run, int q) {
  for (int i = 0; i < run->dae.motion.n; i++) {
    const pl_batch* b = &run->dae.motion.at[i];
    for (int l = 0; l < b->n; l++) {
      for (int e = 0; e < b->pattern->n_G; e++)
        if (b->q[b->pattern->G[e].col * b->lanes + l] == q) return true;
    }
  }
  return false;
}

pleuel_status pl_run_left_open(pl_run* run) {
  for (int i = 0; i < run->n_q; i++) {
    if (run->dae.has_equation[i] != 0 || !run->setup->coordinates[i].in_load
        || in_constraint(run, i))
      continue;
    return pl_fail(run->job, PLEUEL_SINGULAR,
                   "the equations of motion do not contain %s: nothing determines how it moves",
                   run->setup->coordinates[i].name);
  }
  return PLEUEL_OK;
}

pleuel_status pl_run_singular(pl_run* run) {
  double reach = reach_of_singular(run);
  char where[320];
  place_in_words(run, reach, where, sizeof where);
  run->stats.t_singular = run->dae.t + reach;
  run->observer->before(run);
  if (run->control.started) PL_TRY(run->observer->event(run, PL_EV_SINGULAR, -1, 0, false));
  if (run->control.started && run->options.precision != PL_PRECISION_DOUBLE)
    return pl_fail(run->job, PLEUEL_SINGULAR,
                   "singular position at t = %.9g s (%s): the constraints lose rank there; "
                   "precision double leaps over it where the motion goes on smoothly",
                   run->stats.t_singular, where);
  return pl_fail(run->job, PLEUEL_SINGULAR,
                 "singular position at t = %.9g s (%s): the constraints lose rank and do not tell "
                 "how the motion goes on",
                 run->stats.t_singular, where);
}

pleuel_status pl_run_too_small(pl_run* run, double h) {
  if (run->dae.best > 0 && run->event->smallest_here < 1e-2 * run->dae.best)
    return pl_run_singular(run);
  if (run->dae.n_slipping > 0)
    return pl_fail(run->job, PLEUEL_NUMERICAL,
                   "no step is short enough at t = %.9g s (%.3g s tried): forces of contact grow "
                   "without bound while surfaces "
                   "slip, as on the way into Painlevé's paradox",
                   run->dae.t, h);
  double way = pl_norm(run->dae.q, run->n_q), speed = pl_norm(run->dae.v, run->n_q),
         most = pl_norm(run->dae.A, run->n_q);
  // x = c/(t_0 - t)^n: what is left of the time is n x/v, and less than n v/a
  if (speed * run->control.h_series > 0.02 * way && most * run->control.h_series > 0.02 * speed
      && speed > 1e6 * fabs(way) / fabs(run->dae.t - run->options.t_0))
    return pl_fail(
        run->job, PLEUEL_NUMERICAL,
        "the motion runs away: positions and velocities grow without bound as t comes to %.9g s",
        run->dae.t);
  return pl_fail(run->job, PLEUEL_NUMERICAL,
                 "no step is short enough at t = %.9g s (%.3g s tried): the motion leaves the "
                 "domain of a function, "
                 "or a force or the constraints jump there",
                 run->dae.t, h);
}

// --------------------------------------------------------------------------------- leaping over it
// The order at which what is cut off over this length is rounding; 0 when that takes too many
// orders.
static int order_of_leap(const pl_run* run, double length) {
  double radius = run->event->h_regular * exp(2), ratio = fabs(length) / radius;
  if (!(ratio > 0 && ratio < 0.1)) return 0;
  int order = (int)ceil(log(1e-15) / log(ratio));
  if (order < LEAP_LEAST) order = LEAP_LEAST;
  return order <= LEAP_MOST && order < run->order ? order : 0;
}

static bool same(const double* a, const double* b, int n, double limit) {
  for (int i = 0; i < n; i++)
    if (!(fabs(a[i] - b[i]) <= limit)) return false;
  return true;
}

// The state at the far side, from two orders.
static bool orders_agree(pl_run* run, double length, int order) {
  run->dae.use = order - 1;
  pl_series_at(&run->dae, length, run->control.row_q, run->control.row_v);
  run->dae.use = order;
  pl_series_at(&run->dae, length, run->control.trial_q, run->control.trial_v);
  return same(run->control.row_q, run->control.trial_q, run->n_q, off_branch * run->dae.q_size)
         && same(run->control.row_v, run->control.trial_v, run->n_q,
                 100 * off_branch * run->dae.v_size);
}

// The smallest pivot on the way, from the series alone; NaN when it is too much work.
static double pivot_at(pl_run* run, double dt) {
  double smallest;
  pl_series_at(&run->dae, dt, run->control.row_q, run->control.row_v);
  pl_point_evaluate(&run->dae, run->dae.t + run->dae.t_low + dt, run->control.row_q,
                    run->control.row_v);
  return pl_active_set_pivot(&run->dae, &smallest) ? smallest : (double)NAN;
}

// The place from a guess: the pivot is linear on both sides of it. First from its slope on this
// side, then by closer and closer chords around it. 0: it is not where it was thought to be.
static double find_place(pl_run* run, double guess) {
  double here = pivot_at(run, 0), there = pivot_at(run, 0.3 * guess);
  if (isnan(here)) return guess;
  double place = 0.3 * guess * here / (here - there);
  if (!(here > there) || !(fabs(place) < 4 * fabs(guess))) return 0;
  double half = 0.2 * place;
  for (int i = 0; i < 4; i++, half *= 0.05) {
    double before = pivot_at(run, place - half), after = pivot_at(run, place + half);
    double next = place + half * (before - after) / (before + after);
    if (!isfinite(next)) break;
    place = next;
  }
  return place;
}

static bool energy_agrees(pl_run* run) {
  const pl_setup* s = run->setup;
  if (!s->energy_conserved || s->kinetic < 0 || s->potential < 0) return true;
  double E = run->observer->energy_of(run, run->control.trial_q, run->control.trial_v);
  return fabs(E - run->control.energy_base)
         <= run->stats.energy_drift * run->control.energy_size + 1e-10 * run->control.energy_size;
}

static bool leap_fails(pl_run* run) {
  pl_sizes_forget(&run->dae);
  run->dae.use = run->order;
  return false;
}

// Whether the step is replaced by a leap of *length; the state behind it is then in trial_q,
// trial_v, projected.
bool pl_singular_leap(pl_run* run, double left, double* length, pl_projection* p) {
  if (!(run->event->smallest_here < near * run->dae.best) || !(run->event->h_regular > 0))
    return false;
  double reach = reach_of_singular(run);
  run->dae.use = order_of_leap(run, 2 * reach);
  if (reach == 0 || run->dae.use == 0) return leap_fails(run);
  run->event->reach = find_place(run, reach);
  *length = 2 * run->event->reach;
  int order = order_of_leap(run, *length);
  if (run->event->reach == 0 || order == 0 || fabs(*length) > 0.9 * fabs(left))
    return leap_fails(run);
  bool fine = orders_agree(run, *length, order)
              && (run->event->n_watch == 0 || pl_watch_first(run, *length) < 0);
  if (fine) {
    *p = pl_project(&run->dae, run->dae.t + run->dae.t_low + *length, run->control.trial_q,
                    run->control.trial_v);
    fine = p->ok && p->move_q <= off_branch && p->move_v <= 100 * off_branch && p->g_after <= 1e-12
           && p->r_after <= 1e-12 && energy_agrees(run);
  }
  return fine || leap_fails(run);
}

// The event: the state at the place, from the series in use.
pleuel_status pl_singular_record(pl_run* run) {
  double reach = run->event->reach;
  const pl_sink* s = &run->options.sink;
  run->stats.t_singular = run->dae.t + reach;
  run->stats.n_events++;
  if (s->event == NULL) return PLEUEL_OK;
  pl_series_at(&run->dae, reach, run->control.row_q, run->control.row_v);
  pl_series_lambda_at(&run->dae, reach, run->control.row_a, run->control.row_l);
  pl_event_record e = {.kind = PL_EV_SINGULAR, .index = -1};
  return run->observer->beside(run, e, run->stats.t_singular, run->control.row_a,
                               run->control.row_l);
}
