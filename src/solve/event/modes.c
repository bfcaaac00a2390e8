// The mode automaton: contacts end where λ would pull, begin where a free body arrives, bounce;
// surfaces stick and slip; events take place.
//
// At a moment of change all that happens together is decided together (contacts.c): first the
// impact, if something arrives, then the mode of the motion that follows. Bounces that follow each
// other ever faster end at the limit of their geometric sum: when one is so small that what it does
// is below rounding, the rest of them is summed and the contact holds.
#include "solve/event/event.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { MAX_CHANGES = 100 };  // of mode at one time

// --------------------------------------------------------------------------------- entering a mode
static void look_for_landings(pl_run* run) {
  run->dae.watch_landings = false;
  for (int c = 0; c < run->n_c; c++)
    if (run->setup->constraints[c].side != 0 && !run->dae.on[c] && !run->dae.detached[c])
      run->dae.watch_landings = true;
}

// The point in the mode that now holds: projected, accelerations and multipliers known.
pleuel_status pl_modes_enter(pl_run* run) {
  pl_active_set_update(&run->dae);
  PL_TRY(pl_run_left_open(run));
  look_for_landings(run);
  pl_projection p = pl_project(&run->dae, run->dae.t, run->dae.q, run->dae.v);
  if (!p.ok || !pl_point_enter(&run->dae)) return pl_run_undetermined(run);
  pl_assemble_row_sizes(&run->dae);
  pl_active_set_unique(&run->dae);
  run->dae.rank_mode = run->dae.rank;
  return PLEUEL_OK;
}

static pleuel_status count_change(pl_run* run) {
  if (run->event->mode_change_t != run->dae.t) run->event->mode_changes = 0;
  run->event->mode_change_t = run->dae.t;
  if (++run->event->mode_changes <= MAX_CHANGES) return PLEUEL_OK;
  return pl_fail(run->job, PLEUEL_NUMERICAL, "contacts change without end at t = %.9g s",
                 run->dae.t);
}

// -------------------------------------------------------------------------------- before and after
static void remember(pl_run* run) {
  run->observer->before(run);
  memcpy(run->event->on_before, run->dae.on, (size_t)run->n_c * sizeof(bool));
  for (int r = 0; r < run->setup->n_frictions; r++)
    run->event->friction_before[r] = run->dae.friction[r];
}

static bool is_contact(const pl_run* run, int c) {
  return run->setup->constraints[c].side != 0 && !run->setup->constraints[c].velocity;
}

// Contacts that take part: those that hold, and those that are met.
static void find_near(pl_run* run) {
  static const double met = 1e-11;  // of the terms of g: what an event is located to
  pl_point_evaluate(&run->dae, run->dae.t, run->dae.q, run->dae.v);
  pl_assemble_g(&run->dae, 0, run->dae.g, run->dae.g_size);
  for (int c = 0; c < run->n_c; c++) {
    const pl_constraint_setup* constraint = &run->setup->constraints[c];
    bool there = constraint->contact < 0 || run->dae.on[constraint->contact];
    run->dae.near_by[c] = is_contact(run, c) && !run->dae.detached[c] && there
                          && (run->dae.on[c]
                              || constraint->side * run->dae.g[c] <= met * run->dae.g_size[c]);
    run->event->met[c] = run->dae.near_by[c];
  }
  pl_maps_follow(&run->dae);
}

// ----------------------------------------------------------------------------------------- watches
static void set_landing(pl_run* run, int c, int fresh) {
  pl_watch* w = pl_watch_of(run, PL_WATCH_LANDING, c);
  if (w) {
    w->fresh = fresh;
    w->side = 1;
  }
}

static void forget(pl_run* run, pl_watch_kind kind, int index) {
  pl_watch* w = pl_watch_of(run, kind, index);
  if (w) {
    w->fresh = 0;
    w->side = 0;
  }
}

// How many derivatives of g are zero where a contact has opened: that many coefficients are no
// news.
static int zeros_of(const pl_run* run, int c) {
  static const double zero = 1e-9;
  int side = run->setup->constraints[c].side;
  double u = side * run->dae.r[c], a = side * run->event->second[c],
         a_zero = zero * run->event->second_size[c];
  // what bounced, however little, or falls back at once has left with a velocity
  if (run->event->jumped[c] || u > zero * run->dae.r_size[c] || (u > 0 && a < -a_zero)) return 1;
  return a > a_zero ? 2 : 3;
}

static bool jumps(const pl_run* run) {
  for (int i = 0; i < run->n_q; i++)
    if (fabs(run->dae.v[i] - run->event->save_v[i]) > 1e-12 * run->dae.v_size) return true;
  return false;
}

// What is watched after a change: contacts that opened and closed, frictions in another state,
// values that jumped.
static void renew_watches(pl_run* run) {
  pl_assemble_second(&run->dae, run->dae.A, run->event->second, run->event->second_size);
  for (int c = 0; c < run->n_c; c++) {
    if (!is_contact(run, c)) continue;
    if (!run->dae.on[c] && (run->event->met[c] || run->event->on_before[c]))
      set_landing(run, c, zeros_of(run, c));
    if (run->dae.on[c] && !run->event->on_before[c]) forget(run, PL_WATCH_RELEASE, c);
  }
  for (int r = 0; r < run->setup->n_frictions; r++) {
    const pl_friction_state *now = &run->dae.friction[r], *before = &run->event->friction_before[r];
    if (now->state == before->state && now->way == before->way && now->press == before->press)
      continue;
    for (int k = PL_WATCH_STICK; k <= PL_WATCH_PRESS; k++) forget(run, (pl_watch_kind)k, r);
  }
  for (int i = 0; i < run->event->n_watch && jumps(run); i++)
    if (run->event->watch[i].kind == PL_WATCH_EVENT && run->event->watch[i].fresh == 0)
      run->event->watch[i].side = 0;
}

// --------------------------------------------------------------------------------- endless bounces
// of the fastest arrival: its flight is then that part of the first one's
static const double tiny_bounce = 1e-8;

// Some steppers know velocities to their tolerance only.
static double tiny(const pl_run* run) {
  return run->stepper->to_rounding ? tiny_bounce : fmax(tiny_bounce, 10 * run->control.tol);
}

// Time until the last of endless bounces, counted from now; NaN when they do not come to an end
// here.
static double rest_of_bounces(const pl_run* run, int c) {
  const pl_constraint_setup* constraint = &run->setup->constraints[c];
  double u = constraint->side * run->dae.r[c], fall = -constraint->side * run->event->second[c];
  if (run->dae.on[c] || !(fall > 0) || !(u > 0) || !(u <= tiny(run) * run->event->fastest[c]))
    return (double)NAN;
  double flight = 2 * u / fall, ratio = constraint->restitution;
  // the ratio of the last flights, which knows of moving walls and of other bodies
  const double* t = run->event->bounce_t + 3 * (size_t)c;
  double last = run->dae.t - t[0], before = t[0] - t[1];
  if (run->event->bounces[c] >= 3 && last > 0 && before > 0 && last < before) ratio = flight / last;
  return ratio > 0 && ratio < 1 ? flight / (1 - ratio) : (double)NAN;
}

static void note_bounces(pl_run* run) {
  for (int c = 0; c < run->n_c; c++) {
    if (!is_contact(run, c) || !run->event->jumped[c]) continue;
    double* t = run->event->bounce_t + 3 * (size_t)c;
    t[2] = t[1];
    t[1] = t[0];
    t[0] = run->dae.t;
    run->event->bounces[c] = run->dae.on[c] ? 0 : run->event->bounces[c] + 1;
    run->event->fastest[c] = fmax(run->event->fastest[c], fabs(run->event->approach[c]));
  }
}

// Whether some rebound is too small to be followed; its contact then holds, and the impact is
// computed anew.
static bool drop_tiny_bounces(pl_run* run) {
  bool any = false;
  for (int c = 0; c < run->n_c; c++) {
    if (!is_contact(run, c) || !run->event->jumped[c] || run->dae.on[c]) continue;
    double rest = rest_of_bounces(run, c);
    if (isnan(rest)) continue;
    run->event->settled_t[c] = run->dae.t + rest;
    any = true;
  }
  return any;
}

// ------------------------------------------------------------------------------------ what follows
static bool any_fixed(pl_run* run) {
  unsigned any = 0;
  for (int c = 0; c < run->n_c; c++) any |= run->event->fixed[c];
  for (int r = 0; r < run->setup->n_frictions; r++) any |= run->event->friction_fixed[r];
  return any != 0;
}

static void clear_fixed(pl_run* run) {
  for (int c = 0; c < run->n_c; c++) run->event->fixed[c] = 0;
  for (int r = 0; r < run->setup->n_frictions; r++) run->event->friction_fixed[r] = 0;
}

static pleuel_status settle(pl_run* run) {
  pleuel_status how = pl_contacts_settle(run);
  if (how == PLEUEL_OK || !any_fixed(run)) return how;
  // what an event seemed to say does not fit: a root that only touched
  memcpy(run->dae.q, run->event->hold_q, (size_t)run->n_q * sizeof(double));
  memcpy(run->dae.v, run->event->hold_v, (size_t)run->n_q * sizeof(double));
  clear_fixed(run);
  run->job->message[0] = '\0';
  run->job->status = PLEUEL_OK;
  return pl_contacts_settle(run);
}

static pleuel_status impact_and_settle(pl_run* run) {
  bool any;
  find_near(run);
  PL_TRY(pl_contacts_impact(run, &any));
  run->dae.factored = false;
  PL_TRY(settle(run));
  pl_assemble_second(&run->dae, run->dae.A, run->event->second, run->event->second_size);
  pl_batches_load_v(&run->dae.motion, run->dae.v, 0);
  pl_contacts_rates(run, run->dae.r);
  return PLEUEL_OK;
}

// What rests may leave nothing but rounding of velocities, and of coordinates where they are zero:
// what counts as small is then what the forces would do on a thousandth of the way, or in a
// ten-thousandth of the time.
static void size_velocities(pl_run* run) {
  static const double part_of_time = 1e-4, nothing = 1e-6;
  double most = 0, T = part_of_time * fabs(run->options.t_end - run->options.t_0);
  for (int i = 0; i < run->n_q; i++) most = fmax(most, pl_free_size(&run->dae, i));
  double way = run->dae.q_size < nothing * most * T * T ? most * T * T : run->dae.q_size;
  bool rests = run->dae.v_size <= 1e-12 * sqrt(most * way);
  if (run->setup->n_frictions == 0 && !rests) return;
  run->dae.q_size = fmax(run->dae.q_size, way);
  if (rests) run->control.energy_size = fmax(run->control.energy_size, run->dae.force_size * way);
  for (int i = 0; i < run->n_q; i++) {
    run->dae.v_most[i] = fmax(run->dae.v_most[i], 1e-3 * sqrt(pl_free_size(&run->dae, i) * way));
    run->dae.v_size = fmax(run->dae.v_size, run->dae.v_most[i]);
    if (way > run->dae.q_most[i] && pl_free_size(&run->dae, i) > 0 && rests)
      run->dae.q_most[i] = fmax(run->dae.q_most[i], nothing * way);
  }
  pl_sizes_keep(&run->dae);
}

// A system that stays where it is, because nothing is free or because forces balance: rounding is
// all that moves it.
void pl_modes_size_rest(pl_run* run) {
  static const double rounding = 1e-12;
  double most = 0;
  for (int i = 0; i < run->n_q; i++) most = fmax(most, pl_free_size(&run->dae, i));
  if (run->dae.v_size == 0 && pl_norm(run->dae.A, run->n_q) == 0) return;
  if (pl_norm(run->dae.A, run->n_q) <= rounding * most) size_velocities(run);
}

// Whether velocities or forces are others than before, so that a stiff part is set going.
static bool is_shaken(const pl_run* run) {
  static const double same = 1e-3;
  double most = pl_norm(run->dae.A, run->n_q) + pl_norm(run->event->save_a, run->n_q);
  for (int i = 0; i < run->n_q; i++)
    if (fabs(run->dae.A[i] - run->event->save_a[i]) > same * most) return true;
  return jumps(run);
}

// The motion after this moment, from q and v as they are.
static pleuel_status follow(pl_run* run) {
  for (int c = 0; c < run->n_c; c++) run->dae.several[c] = false;
  memcpy(run->event->jump_v, run->dae.v, (size_t)run->n_q * sizeof(double));
  memcpy(run->event->jump_q, run->dae.q, (size_t)run->n_q * sizeof(double));
  PL_TRY(impact_and_settle(run));
  note_bounces(run);
  if (drop_tiny_bounces(run)) {
    memcpy(run->dae.v, run->event->jump_v, (size_t)run->n_q * sizeof(double));
    memcpy(run->dae.q, run->event->jump_q, (size_t)run->n_q * sizeof(double));
    PL_TRY(impact_and_settle(run));
  }
  renew_watches(run);
  pl_indeterminate_mark(run);
  size_velocities(run);
  clear_fixed(run);
  pl_steppers_changed(run, is_shaken(run));
  return PLEUEL_OK;
}

// ----------------------------------------------------------------------------------------- telling
static pl_event_kind opened(const pl_constraint_setup* constraint) {
  return constraint->rope ? PL_EV_SLACK : PL_EV_RELEASE;
}
static pl_event_kind closed(const pl_constraint_setup* constraint, bool impact) {
  return constraint->rope ? PL_EV_TAUT : impact ? PL_EV_IMPACT : PL_EV_CONTACT;
}

// Contact after infinitely many bounces: reported at the limit of their times, with the state
// there.
static pleuel_status report_settled(pl_run* run, int c) {
  double t = run->event->settled_t[c], dt = t - run->dae.t;
  long bounces = run->event->bounces[c];
  run->event->settled_t[c] = (double)NAN;
  run->event->bounces[c] = 0;
  return run->observer->settled(run, closed(&run->setup->constraints[c], false), c, dt, bounces);
}

static pleuel_status report_contact(pl_run* run, int c, bool grazed, bool at_start) {
  const pl_constraint_setup* constraint = &run->setup->constraints[c];
  if (isfinite(run->event->settled_t[c]) && run->dae.on[c]) return report_settled(run, c);
  run->event->settled_t[c] = (double)NAN;
  if (run->event->jumped[c])
    return run->observer->event(run, closed(constraint, true), c, run->event->impulse[c], at_start);
  if (run->dae.on[c] && !run->event->on_before[c])
    return run->observer->event(run, closed(constraint, false), c, 0, at_start);
  if (run->event->on_before[c] && !run->dae.on[c] && !run->dae.detached[c])
    return run->observer->event(run, opened(constraint), c, 0, at_start);
  return grazed ? run->observer->event(run, closed(constraint, false), c, 0, at_start) : PLEUEL_OK;
}

static pleuel_status report_friction(pl_run* run, int r) {
  const pl_friction_state *now = &run->dae.friction[r], *before = &run->event->friction_before[r];
  int c = run->setup->frictions[r].constraint;
  if (before->state == PL_FRICTION_OFF || now->state == PL_FRICTION_OFF) return PLEUEL_OK;
  if (now->state == PL_FRICTION_STICK)
    return before->state == PL_FRICTION_SLIP ? run->observer->event(run, PL_EV_STICK, c, 0, false)
                                             : PLEUEL_OK;
  bool turned = run->setup->frictions[r].n_rows == 1 && now->way != before->way;
  if (before->state == PL_FRICTION_SLIP && !turned) return PLEUEL_OK;
  return run->observer->event(run, PL_EV_SLIP, c, 0, false);
}

static bool is_grazed(const pl_run* run, int c) {
  for (int i = 0; i < run->event->n_watch; i++)
    if (run->event->hit[i] && run->event->touch[i] && run->event->watch[i].kind == PL_WATCH_LANDING
        && run->event->watch[i].index == c)
      return true;
  return false;
}

static pleuel_status report_changes(pl_run* run, bool at_start) {
  for (int c = 0; c < run->n_c; c++)
    if (is_contact(run, c))
      PL_TRY(report_contact(run, c, !at_start && is_grazed(run, c), at_start));
  for (int r = 0; r < run->setup->n_frictions && !at_start; r++) PL_TRY(report_friction(run, r));
  return PLEUEL_OK;
}

// --------------------------------------------------------------------------------------- the start
static void no_hits(pl_run* run) {
  for (int i = 0; i < run->event->n_watch; i++) run->event->hit[i] = run->event->touch[i] = false;
}

pleuel_status pl_modes_check(pl_run* run, bool at_start) {
  bool any = run->setup->n_frictions > 0;
  for (int c = 0; c < run->n_c; c++) any |= is_contact(run, c);
  if (!any) return PLEUEL_OK;
  no_hits(run);
  clear_fixed(run);
  remember(run);
  PL_TRY(follow(run));
  return report_changes(run, at_start);
}

// ----------------------------------------------------------------------------------------- actions
static pleuel_status attach(pl_run* run, int c) {
  run->dae.detached[c] = false;
  if (run->dae.on[c]) return PLEUEL_OK;
  pl_point_evaluate(&run->dae, run->dae.t, run->dae.q, run->dae.v);
  pl_assemble_g(&run->dae, 0, run->dae.g, run->dae.g_size);
  const pl_constraint_setup* constraint = &run->setup->constraints[c];
  bool met = constraint->velocity || fabs(run->dae.g[c]) <= 1e-9 * run->dae.g_size[c];
  // a one-sided one that is open waits for its landing
  if (constraint->side != 0 && !met && constraint->side * run->dae.g[c] > 0) return PLEUEL_OK;
  if (!met)
    return pl_fail(run->job, PLEUEL_CONTRADICTION,
                   "%s cannot be attached at t = %.9g s: it is off by %.3g", constraint->name,
                   run->dae.t, run->dae.g[c]);
  run->dae.on[c] = constraint->side
                   == 0;  // whether a one-sided one holds is decided with the others
  return PLEUEL_OK;
}

static double watched_value(pl_run* run, int i) {
  pl_batches* b = &run->watched;
  pl_batches_time(b, run->dae.t);
  pl_batches_load_q(b, run->event->save_q, 0);
  pl_batches_load_v(b, run->event->save_v, 0);
  pl_batches_load_a(b, run->event->save_a, 0);
  pl_batches_load_lambda(b, run->event->save_l, 0);
  for (int level = PL_LEVEL_POSITION; level < PL_N_LEVELS; level++)
    pl_batches_sweep(b, (pl_tape_level)level, 0, true);
  pl_batches_outputs(b, run->event->W_coef, run->setup->n_watched, 0);
  return run->event->W_coef[i];
}

static pleuel_status do_action(pl_run* run, const pl_event_action* d) {
  switch (d->kind) {
    case PL_ACTION_STOP: run->control.stopped = true; break;
    case PL_ACTION_RECORD: break;
    case PL_ACTION_RELEASE:
      run->dae.detached[d->target] = true;
      run->dae.on[d->target] = false;
      break;
    case PL_ACTION_ATTACH: return attach(run, d->target);
    case PL_ACTION_SET_Q: run->dae.q[d->target] = watched_value(run, d->value); break;
    case PL_ACTION_SET_V: run->dae.v[d->target] = watched_value(run, d->value); break;
  }
  return PLEUEL_OK;
}

// Events that follow each other ever faster come to an end that they never reach, as bounces do;
// what the motion does then, only a contact says. Long before that the events would be lost in
// rounding.
static pleuel_status count_repeats(pl_run* run, int e) {
  enum { FEW = 8 };
  // times shorter than this part of the longest: heights are 1e-12 of the first
  static const double close = 1e-6;
  pl_repeat *r = &run->event->repeat[e], before = *r;
  double gap = fabs(run->dae.t - before.t);
  bool faster = before.n > 0 && (before.n == 1 || gap < before.gap);
  *r = (pl_repeat){run->dae.t, gap, faster ? fmax(before.widest, gap) : gap,
                   faster ? before.n + 1 : 1};
  if (r->n < FEW || !(gap < close * r->widest)) return PLEUEL_OK;
  double ratio = gap / before.gap,
         end = run->dae.t + copysign(gap * ratio / (1 - ratio), pl_run_left(run));
  return pl_fail(run->job, PLEUEL_NUMERICAL,
                 "%s happens without end: %ld times in ever shorter time, the last after %.2g s; "
                 "they come to an end at "
                 "t = %.9g s, and the model does not say what follows (a one-sided constraint with "
                 "restitution would)",
                 run->setup->events[e].name, r->n, gap, end);
}

static pleuel_status happen(pl_run* run, int e, bool touches) {
  const pl_event_setup* event = &run->setup->events[e];
  bool stops = false, changes = false;
  remember(run);
  for (int i = 0; i < event->n_actions; i++) {
    PL_TRY(do_action(run, &event->actions[i]));
    stops |= event->actions[i].kind == PL_ACTION_STOP;
    changes |= event->actions[i].kind != PL_ACTION_STOP
               && event->actions[i].kind != PL_ACTION_RECORD;
  }
  if (changes) {
    run->dae.factored = false;
    pl_watch_forget(run);
    PL_TRY(follow(run));
  }
  pl_watch* w = pl_watch_of(run, PL_WATCH_EVENT, e);
  w->fresh = touches ? 2 : 1;
  if (!touches) w->side = -w->side;
  PL_TRY(run->observer->event(run, stops ? PL_EV_STOP : PL_EV_EVENT, e, 0, false));
  if (changes) PL_TRY(count_repeats(run, e));
  return changes ? report_changes(run, false) : PLEUEL_OK;
}

// ------------------------------------------------------------------------------------- all of them
// Whether the motion is another one afterwards: then the row is written twice, before and after.
static bool changes_motion(const pl_run* run) {
  for (int i = 0; i < run->event->n_watch; i++) {
    if (!run->event->hit[i]) continue;
    if (run->event->watch[i].kind != PL_WATCH_EVENT) return true;
    const pl_event_setup* e = &run->setup->events[run->event->watch[i].index];
    for (int d = 0; d < e->n_actions; d++)
      if (e->actions[d].kind != PL_ACTION_STOP && e->actions[d].kind != PL_ACTION_RECORD)
        return true;
  }
  return false;
}

static unsigned slips(int way, bool other_press, int press) {
  int bit = (way < 0) + 2 * ((other_press ? -press : press) < 0);
  return 1u << (PL_CHOICE_SLIP + bit);
}

// The square of a slip velocity in space is zero within rounding before the velocity is.
static bool is_at_rest(pl_run* run, int r) {
  static const double at_rest = 1e-9;
  double d[3];
  if (run->setup->frictions[r].n_rows == 1) return true;
  pl_batches_load_v(&run->dae.motion, run->dae.v, 0);
  pl_contacts_rates(run, run->dae.r);
  return pl_friction_speed(&run->dae, r, run->dae.r, d) <= at_rest * run->dae.v_size;
}

// What a hit leaves open.
static void fix_choices(pl_run* run, int i) {
  const pl_watch* w = &run->event->watch[i];
  const pl_friction_state* now = w->kind >= PL_WATCH_STICK && w->kind <= PL_WATCH_PRESS
                                     ? &run->dae.friction[w->index]
                                     : NULL;
  const pl_friction_setup* friction = now ? &run->setup->frictions[w->index] : NULL;
  switch (w->kind) {
    case PL_WATCH_RELEASE:
      if (!run->event->touch[i]) run->event->fixed[w->index] = 1u << PL_CHOICE_OPEN;
      break;
    case PL_WATCH_LANDING:
      // it would sink at once
      if (run->event->root[i] == 0 && w->fresh > 1)
        run->event->fixed[w->index] = 1u << PL_CHOICE_CLOSED;
      break;
    case PL_WATCH_STICK:
      if (!is_at_rest(run, w->index)) {
        run->event->watch[i].fresh = 2;  // it only came near
        break;
      }
      run->event->friction_fixed[w->index] |= PL_FRICTION_AT_REST;
      if (run->event->root[i] == 0 && w->fresh > 0 && friction->n_rows == 1)
        run->event->friction_fixed[w->index] |=
            0xffu & ~(slips(now->way, false, 1) | slips(now->way, true, 1));
      break;
    case PL_WATCH_SLIP: {
      // against the force that held it
      int way = friction->n_rows == 1 && run->dae.L[friction->row[0]] > 0 ? -1 : 1;
      run->event->friction_fixed[w->index] |= PL_FRICTION_AT_REST | slips(way, false, 1)
                                              | slips(way, true, 1);
      break;
    }
    case PL_WATCH_PRESS:
      run->event->friction_fixed[w->index] |= slips(now->way, true, now->press);
      break;
    case PL_WATCH_EVENT: break;
  }
}

pleuel_status pl_modes_handle(pl_run* run) {
  bool changes = changes_motion(run), contacts = false;
  if (changes) PL_TRY(run->observer->point(run, PL_ROW_BEFORE));
  clear_fixed(run);
  for (int i = 0; i < run->event->n_watch; i++) {
    if (!run->event->hit[i] || run->event->watch[i].kind == PL_WATCH_EVENT) continue;
    fix_choices(run, i);
    contacts = true;
  }
  if (contacts) {
    PL_TRY(count_change(run));
    remember(run);
    PL_TRY(follow(run));
    PL_TRY(report_changes(run, false));
  }
  for (int i = 0; i < run->event->n_watch; i++) {
    if (!run->event->hit[i] || run->event->watch[i].kind != PL_WATCH_EVENT) continue;
    PL_TRY(count_change(run));
    PL_TRY(happen(run, run->event->watch[i].index, run->event->touch[i]));
  }
  run->observer->energy(run, true);
  return run->observer->point(run, PL_ROW_AFTER);
}
