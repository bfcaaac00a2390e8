// The mode automaton: contacts end where λ would pull, begin where a free body arrives; events do their deeds.
//
// A release leaves velocities alone.  An arrival is an impact in the mass metric: the velocity jump that makes the
// velocity along the new constraint zero (or reverses it times the restitution), with impulses only along constraints
// in force; a one-sided one whose impulse would pull takes no part and lets go.
#include "solve/solve_impl.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { MAX_CHANGES = 100 };  // of mode at one time

// ---------------------------------------------------------------------------------------------- entering a mode
static bool pulls(const pl_run* run, int c) {
  int side = run->setup->links[c].side;
  return side != 0 && run->active[c] && side * run->L[c] < -pl_watch_force_noise(run, c);
}

static void look_for_landings(pl_run* run) {
  run->watch_landings = false;
  for (int c = 0; c < run->n_c; c++)
    if (run->setup->links[c].side != 0 && !run->on[c] && !run->detached[c]) run->watch_landings = true;
}

// The point in the mode that now holds: projected, accelerations and multipliers known.
pleuel_status pl_modes_enter(pl_run* run) {
  pl_active_update(run);
  look_for_landings(run);
  pl_projection p = pl_project(run, run->t, run->q, run->v);
  if (!p.ok || !pl_point_enter(run)) return pl_run_undetermined(run);
  pl_assemble_row_sizes(run);
  pl_independent_unique(run);
  run->rank_mode = run->rank;
  return PLEUEL_OK;
}

static pleuel_status count_change(pl_run* run) {
  if (run->mode_change_t != run->t) run->mode_changes = 0;
  run->mode_change_t = run->t;
  if (++run->mode_changes <= MAX_CHANGES) return PLEUEL_OK;
  return pl_fail(run->job, PLEUEL_NUMERICAL, "contacts change without end at t = %.9g s", run->t);
}

static void let_go(pl_run* run, int c, int fresh) {
  run->on[c] = false;
  pl_watch* w = pl_watch_of(run, PL_WATCH_LANDING, c);
  if (w) w->fresh = fresh, w->side = 1;
}

static void hold(pl_run* run, int c) {
  run->on[c] = true;
  pl_watch* w = pl_watch_of(run, PL_WATCH_RELEASE, c);
  if (w) w->fresh = 0, w->side = 0;
}

// ---------------------------------------------------------------------------------------------- contacts that pull
// Releases the first one that pulls, again and again.  g and its first derivative are zero there; the second need not
// be.
pleuel_status pl_modes_check(pl_run* run, bool at_start) {
  for (;;) {
    int c = 0;
    while (c < run->n_c && !pulls(run, c)) c++;
    if (c == run->n_c) return PLEUEL_OK;
    PL_TRY(count_change(run));
    pl_rows_before(run);
    let_go(run, c, 2);
    PL_TRY(pl_modes_enter(run));
    PL_TRY(pl_rows_event(run, PL_EV_RELEASE, c, 0, at_start));
  }
}

// ---------------------------------------------------------------------------------------------- arrivals
// Which other contact would have to pull in the impact; -1 none.
static int pulled_by(const pl_run* run, int arrived) {
  double most = pl_norm(run->impulse, run->n_c);
  for (int c = 0; c < run->n_c; c++) {
    int side = run->setup->links[c].side;
    if (c != arrived && side != 0 && run->active[c] && side * run->impulse[c] < -1e-12 * most) return c;
  }
  return -1;
}

// The rebound is too short to be followed: the body stays.
static bool rebound_counts(const pl_run* run, int c, double speed) {
  return run->setup->links[c].restitution > 0 && speed > 1e-7 * run->v_size;
}

// Contacts that the impact opened.
static pleuel_status tell_releases(pl_run* run) {
  for (int c = 0; c < run->n_c; c++) {
    if (!run->let_go[c]) continue;
    run->let_go[c] = false;
    PL_TRY(pl_rows_event(run, PL_EV_RELEASE, c, 0, false));
  }
  return PLEUEL_OK;
}

static pleuel_status arrive(pl_run* run, int c) {
  memcpy(run->jump_v, run->v, (size_t)run->n_q * sizeof(double));
  pl_rows_before(run);
  hold(run, c);
  for (int round = 0; round <= run->n_c; round++) {
    pl_active_update(run);
    memcpy(run->v, run->jump_v, (size_t)run->n_q * sizeof(double));
    pl_point_evaluate(run, run->t, run->q, run->v);
    pl_independent_choose(run);
    if (!pl_point_factor(run, false)) return pl_run_undetermined(run);
    pl_impulse(run, run->v, 1, run->impulse);
    int other = pulled_by(run, c);
    if (other < 0) break;
    let_go(run, other, 1);
    run->let_go[other] = true;
  }
  double move = 0, approach = fabs(run->r[c]), size = run->r_size[c], e = run->setup->links[c].restitution;
  for (int i = 0; i < run->n_q; i++) move = fmax(move, fabs(run->v[i] - run->jump_v[i]));
  bool bounces = rebound_counts(run, c, e * move);
  bool impact = bounces || approach > 1e-10 * size;
  double impulse = run->impulse[c];
  if (bounces) {
    for (int i = 0; i < run->n_q; i++) run->v[i] += e * (run->v[i] - run->jump_v[i]);
    impulse *= 1 + e;
    let_go(run, c, 1);
  }
  run->factored = false;
  PL_TRY(pl_modes_enter(run));
  PL_TRY(pl_rows_event(run, impact ? PL_EV_IMPACT : PL_EV_CONTACT, c, impulse, false));
  return tell_releases(run);
}

static pleuel_status leave(pl_run* run, int c) {
  pl_rows_before(run);
  let_go(run, c, 3);
  PL_TRY(pl_modes_enter(run));
  return pl_rows_event(run, PL_EV_RELEASE, c, 0, false);
}

// ---------------------------------------------------------------------------------------------- deeds
static pleuel_status attach(pl_run* run, int c) {
  run->detached[c] = false;
  if (run->on[c]) return PLEUEL_OK;
  pl_point_evaluate(run, run->t, run->q, run->v);
  pl_assemble_g(run, 0, run->g, run->g_size);
  const pl_link* link = &run->setup->links[c];
  // a one-sided one that is open waits for its landing
  if (link->side != 0 && link->side * run->g[c] > 1e-9 * run->g_size[c]) return PLEUEL_OK;
  if (!link->velocity && fabs(run->g[c]) > 1e-9 * run->g_size[c])
    return pl_fail(run->job, PLEUEL_CONTRADICTION, "%s cannot be attached at t = %.9g s: it is off by %.3g", link->name,
                   run->t, run->g[c]);
  return arrive(run, c);
}

static double watched_value(pl_run* run, int i) {
  pl_batches* b = &run->watched;
  pl_batches_time(b, run->t);
  pl_batches_load_q(b, run->save_q, 0);
  pl_batches_load_v(b, run->save_v, 0);
  pl_batches_load_a(b, run->save_a, 0);
  pl_batches_load_lambda(b, run->save_l, 0);
  for (int level = PL_LEVEL_PLACE; level < PL_N_LEVELS; level++) pl_batches_sweep(b, (pl_level)level, 0, true);
  pl_batches_outputs(b, run->W_coef, run->setup->n_watched, 0);
  return run->W_coef[i];
}

static pleuel_status do_deed(pl_run* run, const pl_event_deed* d) {
  switch (d->deed) {
    case PL_DEED_STOP: run->stopped = true; break;
    case PL_DEED_RECORD: break;
    case PL_DEED_RELEASE:
      run->detached[d->target] = true;
      let_go(run, d->target, 0);
      break;
    case PL_DEED_ATTACH: return attach(run, d->target);
    case PL_DEED_SET_Q: run->q[d->target] = watched_value(run, d->value); break;
    case PL_DEED_SET_V: run->v[d->target] = watched_value(run, d->value); break;
  }
  return PLEUEL_OK;
}

static pleuel_status happen(pl_run* run, int e) {
  const pl_event_setup* event = &run->setup->events[e];
  bool stops = false, changes = false;
  pl_rows_before(run);
  for (int i = 0; i < event->n_deeds; i++) {
    PL_TRY(do_deed(run, &event->deeds[i]));
    stops |= event->deeds[i].deed == PL_DEED_STOP;
    changes |= event->deeds[i].deed != PL_DEED_STOP && event->deeds[i].deed != PL_DEED_RECORD;
  }
  if (changes) {
    run->factored = false;
    PL_TRY(pl_modes_enter(run));
    pl_watch_forget(run);
  }
  pl_watch_of(run, PL_WATCH_EVENT, e)->fresh = 1;
  return pl_rows_event(run, stops ? PL_EV_STOP : PL_EV_EVENT, e, 0, false);
}

// ---------------------------------------------------------------------------------------------- all of them
// Whether the motion is another one afterwards: then the row is written twice, before and after.
static bool changes_motion(const pl_run* run) {
  for (int i = 0; i < run->n_watch; i++) {
    if (!run->hit[i]) continue;
    if (run->watch[i].kind != PL_WATCH_EVENT) return true;
    const pl_event_setup* e = &run->setup->events[run->watch[i].index];
    for (int d = 0; d < e->n_deeds; d++)
      if (e->deeds[d].deed != PL_DEED_STOP && e->deeds[d].deed != PL_DEED_RECORD) return true;
  }
  return false;
}

pleuel_status pl_modes_handle(pl_run* run) {
  if (changes_motion(run)) PL_TRY(pl_rows_point(run, PL_ROW_BEFORE));
  for (int i = 0; i < run->n_watch; i++) {
    if (!run->hit[i]) continue;
    const pl_watch w = run->watch[i];
    // an earlier one of the same moment may have changed what this one was about
    if (w.kind == PL_WATCH_RELEASE && !run->active[w.index]) continue;
    if (w.kind == PL_WATCH_LANDING && run->on[w.index]) continue;
    PL_TRY(count_change(run));
    if (w.kind == PL_WATCH_RELEASE) PL_TRY(leave(run, w.index));
    if (w.kind == PL_WATCH_LANDING) PL_TRY(arrive(run, w.index));
    if (w.kind == PL_WATCH_EVENT) PL_TRY(happen(run, w.index));
  }
  PL_TRY(pl_modes_check(run, false));
  pl_rows_energy(run, true);
  return pl_rows_point(run, PL_ROW_AFTER);
}
