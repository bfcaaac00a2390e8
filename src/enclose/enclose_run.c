// The whole motion: passes of growing precision until the enclosure is as narrow as asked for.
//
// How much a motion and the arithmetic of balls widen an enclosure is not known beforehand. The
// first pass measures it in bits; the next has as many bits more. A pass that becomes wider than
// the motion itself is given up and its loss so far is extrapolated. What a pass has enclosed is
// proved whatever comes after it; the narrowest is kept.
#include "enclose/enclose_impl.h"

#include <math.h>
#include <string.h>

#include "algebra/algebra.h"

enum { MOST_PASSES = 6, FIRST_BITS = 96, MOST_BITS = 20000, MOST_STEPS = 200000 };
static const double default_budget = 6e9;  // 10 to 20 s

typedef struct pass {
  pl_system* s;
  pl_enclosure_stepper* e;
  pl_certified* out;
  double budget;
  arb_t t, t_end;
  double lost;  // bits at the end or where it was given up
  double part;  // of the way, 1 at the end
  double size_q, size_v, width;
  bool watches, stopped;
  int n_happened;
  pl_happening happened[PL_CERTIFY_HAPPENINGS];
  arb_ptr time, state;  // of each
} pass;

// ------------------------------------------------------------------------------------------- width
static double largest_radius(arb_srcptr x, const pl_system* s) {
  double most = 0;
  for (int i = 0; i < s->n_q; i++) most = fmax(most, mag_get_d(arb_radref(x + (slong)i * s->cap)));
  return most;
}

// Of those that are known to be other than zero.
static double largest_size(arb_srcptr x, const pl_system* s) {
  double most = 0;
  for (int i = 0; i < s->n_q; i++) {
    arb_srcptr y = x + (slong)i * s->cap;
    if (arb_rel_accuracy_bits(y) > 10) most = fmax(most, fabs(pl_ball_double(y)));
  }
  return most;
}

// A motion that rests at zero has no size: then the width is in SI units.
static double over(double x, double size) { return x == 0 ? 0 : size > 0 ? x / size : x; }

// Half width of the state relative to the largest coordinate, or velocity, met so far.
static double state_width(pass* z) {
  z->size_q = fmax(z->size_q, largest_size(z->s->q, z->s));
  z->size_v = fmax(z->size_v, largest_size(z->s->v, z->s));
  return fmax(over(largest_radius(z->s->q, z->s), z->size_q),
              over(largest_radius(z->s->v, z->s), z->size_v));
}

// ----------------------------------------------------------------------------------------- results
// The first pass that reaches a time fills it; later ones only where they are narrower.
static void keep(arb_ptr to, arb_srcptr x, bool fresh) {
  if (fresh || mag_cmp(arb_radref(x), arb_radref(to)) < 0) arb_set(to, x);
}

static void keep_state(pass* z, int time, bool is_stop) {
  pl_system* s = z->s;
  struct pl_certified_balls* b = z->out->balls;
  // what another pass took for the time of the grid may be that of an event that stops, or the
  // other way round
  bool fresh = time >= z->out->n_done || b->is_stop[time] != is_stop;
  b->is_stop[time] = is_stop;
  for (int i = 0; i < b->n_q; i++) {
    keep(b->q + (slong)time * b->n_q + i, s->q + (slong)i * s->cap, fresh);
    keep(b->v + (slong)time * b->n_q + i, s->v + (slong)i * s->cap, fresh);
  }
  for (int c = 0; c < b->n_c; c++) {
    b->determined[(size_t)time * (size_t)b->n_c + (size_t)c] = s->row_of[c] >= 0;
    if (s->row_of[c] >= 0) keep(b->l + (slong)time * b->n_c + c, s->l + (slong)c * s->cap, fresh);
  }
  if (fresh) z->out->n_done = time + 1;
  if (time + 1 == z->out->n_done) z->out->stopped = is_stop;
}

// ---------------------------------------------------------------------------------------- one pass
static bool exact_time(pass* z, arb_t t, pl_expr e) { return pl_exact_ball(&z->s->exact, t, e); }

static int direction_of(pass* z) { return arb_lt(z->t_end, z->t) ? -1 : 1; }

static void tell(pass* z, double h) {
  const pl_certify_problem* p = z->s->p;
  if (p->progress)
    p->progress(p->progress_user, pl_ball_double(z->t), pl_ball_double(z->t_end), h, z->out->steps);
}

// A step's length as a number of few bits: exact.
static double short_number(double h) {
  int exponent;
  double m = frexp(h, &exponent);
  return ldexp(floor(m * 4096) / 4096, exponent);
}

// ------------------------------------------------------------------------------------ what happens
static void note(pass* z, pl_happening_kind kind, int index) {
  if (z->n_happened == PL_CERTIFY_HAPPENINGS) return;
  arb_set(z->time + z->n_happened, z->t);
  arb_ptr state = z->state + (slong)z->n_happened * 2 * z->s->n_q;
  for (int i = 0; i < z->s->n_q; i++) {
    arb_set(state + i, z->s->q + (slong)i * z->s->cap);
    arb_set(state + z->s->n_q + i, z->s->v + (slong)i * z->s->cap);
  }
  z->happened[z->n_happened++] = (pl_happening){kind, index};
}

static const char* name_of(const pl_system* s, const pl_monitor* m) {
  return m->kind == PL_MONITOR_EVENT ? s->setup->events[m->index].name
                                     : s->setup->constraints[m->index].name;
}

static bool stops(const pl_event_setup* event) {
  for (int i = 0; i < event->n_actions; i++)
    if (event->actions[i].kind == PL_ACTION_STOP) return true;
  return false;
}

// An event releases constraints, or stops the motion.
static void do_actions(pass* z, const pl_event_setup* event) {
  pl_system* s = z->s;
  for (int i = 0; i < event->n_actions; i++) {
    if (event->actions[i].kind == PL_ACTION_RELEASE) s->held[event->actions[i].target] = false;
    if (event->actions[i].kind == PL_ACTION_STOP) z->stopped = true;
  }
  pl_system_hold(s);
  pl_monitors_reset(s, false, -1);
}

// The function of an event is zero here, once: its next sign is the other one.
static void pass_event(pass* z, pl_monitor* m) {
  const pl_event_setup* event = &z->s->setup->events[m->index];
  bool happens = event->direction == 0 || event->direction == -m->sign;
  m->sign = -m->sign;
  m->fresh = 1;
  if (!happens) return;
  note(z, PL_HAPPENED_EVENT, m->index);
  do_actions(z, event);
  if (z->stopped) z->happened[z->n_happened - 1].kind = PL_HAPPENED_STOP;
}

static pl_certify_end happen(pass* z, pl_monitor* m) {
  pl_system* s = z->s;
  int index = m->index;
  z->out->what = name_of(s, m);
  switch (m->kind) {
    case PL_MONITOR_EVENT: pass_event(z, m); return PL_CERTIFIED;
    case PL_MONITOR_GAP: note(z, PL_HAPPENED_IMPACT, index); return PL_CERTIFY_IMPACT;
    case PL_MONITOR_FORCE: break;
  }
  note(z, PL_HAPPENED_RELEASE, index);
  s->held[index] = false;
  pl_system_hold(s);
  pl_monitors_reset(s, false, index);
  return PL_CERTIFIED;
}

// ---------------------------------------------------------------------------------------- one step
// The series of a step that is proved, towards `target`. *there: it ends on it; then signs are
// looked at some way further, since a zero may lie on the target.
static pl_certify_end prepare(pass* z, arb_srcptr target, arb_t h, arb_t sight, bool* there) {
  pl_enclosure_stepper* e = z->e;
  arb_sub(h, target, z->t, z->s->prec);
  double left = fabs(pl_ball_double(h));
  if (pl_interrupted(z->s->job)) return PL_CERTIFY_INTERRUPTED;
  if (e->work > z->budget || z->out->steps >= MOST_STEPS) return PL_CERTIFY_BUDGET;
  if (!pl_system_point(z->s, z->t) || !pl_step_prove(e, z->t, left)) return PL_CERTIFY_STEP;
  double reach = e->radius * e->growth;
  *there = left <= reach * (1 + 1e-9);
  // two equal steps rather than a long one and a short one
  if (!*there) arb_set_d(h, e->direction * short_number(left < 2 * reach ? left / 2 : reach));
  arb_set(sight, h);
  if (*there && z->watches) arb_set_d(sight, e->direction * short_number(left * 1.5));
  return pl_step_series(e, z->t, sight) ? PL_CERTIFIED : PL_CERTIFY_STEP;
}

// A zero that was found beyond the target does not count yet. One that may lie on it counts when it
// ends the motion; otherwise the state at the target would be that of two modes.
static pl_monitor_look before_target(const pass* z, pl_monitor_look look, arb_srcptr h, arb_t part,
                                     const pl_monitor* hit) {
  if (look == PL_LOOK_CLEAR || look == PL_LOOK_LOST || arb_gt(part, h)) {
    arb_set(part, h);
    return look == PL_LOOK_LOST ? PL_LOOK_LOST : PL_LOOK_CLEAR;
  }
  if (look != PL_LOOK_HIT || arb_lt(part, h) || hit->kind == PL_MONITOR_GAP) return look;
  return hit->kind == PL_MONITOR_EVENT && stops(&z->s->setup->events[hit->index]) ? look
                                                                                  : PL_LOOK_LOST;
}

// As far as no function that decides the mode changes its sign.
static pl_certify_end move(pass* z, arb_srcptr target, arb_srcptr h, arb_srcptr sight,
                           bool* there) {
  pl_monitor* hit = NULL;
  arb_t part;
  arb_init(part);
  pl_monitor_look look = z->watches ? pl_monitors_look(z->e, sight, part, &hit) : PL_LOOK_CLEAR;
  look = before_target(z, look, h, part, hit);
  if (look != PL_LOOK_CLEAR) *there = false;
  if (look != PL_LOOK_LOST) {
    pl_step_take(z->e, part);
    if (*there) arb_set(z->t, target);
    else arb_add(z->t, z->t, part, z->s->prec);
    if (z->watches) pl_monitors_moved(z->s);
  }
  arb_clear(part);
  if (look == PL_LOOK_LOST) return PL_CERTIFY_UNDECIDED;
  return look == PL_LOOK_HIT ? happen(z, hit) : PL_CERTIFIED;
}

static pl_certify_end one_step(pass* z, arb_srcptr target, bool* there) {
  arb_t h, sight;
  arb_init(h);
  arb_init(sight);
  pl_certify_end end = prepare(z, target, h, sight, there);
  if (end == PL_CERTIFIED) end = move(z, target, h, sight, there);
  arb_clear(h);
  arb_clear(sight);
  return end;
}

// To the exact time `target` in one or more steps, or to the event that stops the motion.
static pl_certify_end go_to(pass* z, arb_srcptr target) {
  pl_enclosure_stepper* e = z->e;
  for (bool there = false; !there && !z->stopped;) {
    pl_certify_end end = one_step(z, target, &there);
    if (end != PL_CERTIFIED) return end;
    z->out->steps++;
    if (e->order > z->out->order) z->out->order = e->order;
    double width = state_width(z);
    z->lost = log2(fmax(width, 1e-300)) + (double)z->s->prec;
    if (!(width < 1e-4)) return PL_CERTIFY_WIDE;
    tell(z, e->radius * e->growth);
  }
  return PL_CERTIFIED;
}

// Those of the pass that came furthest; of equal ones, of the last.
static void keep_happenings(pass* z) {
  if (z->n_happened < z->out->n_happened) return;
  pl_happening* kept = PL_ARRAY(z->s->arena, pl_happening, PL_CERTIFY_HAPPENINGS);
  for (int i = 0; i < z->n_happened; i++) {
    kept[i] = z->happened[i];
    arb_set(z->out->balls->time + i, z->time + i);
  }
  _arb_vec_set(z->out->balls->state, z->state, (slong)z->n_happened * 2 * z->s->n_q);
  z->out->happened = kept;
  z->out->n_happened = z->n_happened;
}

static double part_done(const pass* z, double t_0) {
  double all = pl_ball_double(z->t_end) - t_0;
  return all == 0 ? 1 : (pl_ball_double(z->t) - t_0) / all;
}

static pl_certify_end to_times(pass* z) {
  const pl_certify_problem* p = z->s->p;
  arb_t target;
  arb_init(target);
  pl_certify_end end = PL_CERTIFIED;
  z->width = 0;
  for (int i = 0; i < p->n_times && end == PL_CERTIFIED && !z->stopped; i++) {
    if (!exact_time(z, target, p->times[i])) end = PL_CERTIFY_NO_EXACT;
    if (end == PL_CERTIFIED && !arb_equal(target, z->t)) end = go_to(z, target);
    if (end == PL_CERTIFIED && !pl_system_point(z->s, z->t)) end = PL_CERTIFY_STEP;
    if (end != PL_CERTIFIED) break;
    z->width = fmax(z->width, state_width(z));
    keep_state(z, i, z->stopped);
  }
  arb_clear(target);
  return end;
}

static pl_certify_end one_pass(pass* z, slong prec) {
  pl_system* s = z->s;
  z->out->steps = 0;
  z->out->bits = prec;
  z->lost = z->part = z->size_q = z->size_v = 0;
  z->stopped = false;
  z->n_happened = 0;
  for (int c = 0; c < s->n_c; c++) s->held[c] = s->p->active[c];
  pl_system_hold(s);
  if (!pl_system_precision(s, prec)) return PL_CERTIFY_NO_EXACT;
  if (!exact_time(z, z->t, s->p->t_0)) return PL_CERTIFY_NO_EXACT;
  if (!exact_time(z, z->t_end, s->p->times[s->p->n_times - 1])) return PL_CERTIFY_NO_EXACT;
  pl_certify_end end = pl_enclose_start(s, z->out, z->t);
  if (end != PL_CERTIFIED) return end;
  pl_monitors_reset(s, true, -1);
  double t_0 = pl_ball_double(z->t);
  z->e->direction = direction_of(z);
  z->e->radius = z->e->longest = 0;
  end = to_times(z);
  keep_happenings(z);
  z->part = end == PL_CERTIFIED || end == PL_CERTIFY_IMPACT ? 1 : part_done(z, t_0);
  double t = arf_get_d(arb_midref(z->t), z->e->direction > 0 ? ARF_RND_FLOOR : ARF_RND_CEIL);
  if (isnan(z->out->t_reached) || (t - z->out->t_reached) * z->e->direction > 0)
    z->out->t_reached = t;
  return end;
}

// ------------------------------------------------------------------------------------------ passes
// Bits that the next pass needs.
static slong next_precision(const pass* z, slong prec) {
  double needed = -log2(z->s->p->width) + 8,
         whole = z->part > 1e-6 ? z->lost / z->part : (double)MOST_BITS;
  double bits = needed + fmax(whole, 0) * (z->part < 1 ? 1.1 : 1) + 8;
  if (bits < (double)prec + 32) bits = (double)prec + 32;
  return bits > MOST_BITS ? MOST_BITS : (slong)bits;
}

// Nothing but more precision could be gained.
static bool came_to_its_end(pl_certify_end end) {
  return end == PL_CERTIFIED || end == PL_CERTIFY_IMPACT || end == PL_CERTIFY_UNDECIDED
         || end == PL_CERTIFY_STEP;
}

static void passes(pass* z) {
  pl_certified* out = z->out;
  double wanted = z->s->p->width;
  slong prec = (slong)(-log2(wanted)) + 40;
  if (prec < FIRST_BITS) prec = FIRST_BITS;
  for (int i = 0; i < MOST_PASSES; i++) {
    out->passes++;
    out->end = one_pass(z, prec);
    bool again = out->end == PL_CERTIFY_WIDE
                 || (out->end == PL_CERTIFY_STEP && z->lost > (double)prec / 2);
    if (came_to_its_end(out->end)) {
      out->width = z->width;
      out->bits_lost = z->lost;
      again = again || out->width > wanted;
    }
    if (!again || prec >= MOST_BITS) break;
    prec = next_precision(z, prec);
    if (out->end == PL_CERTIFIED) out->end = PL_CERTIFY_WIDE;
  }
}

typedef struct whole {
  pl_job* job;
  const pl_certify_problem* p;
  pl_certified* out;
  pl_system s;
  pl_enclosure_stepper e;
  pl_guard guard;        // here, because FLINT's abort leaves without ending it
  pleuel_status memory;  // PLEUEL_NO_MEMORY when the arena unwound
} whole;

static void work(whole* w) {
  w->out->end = pl_system_make(&w->s, w->job, w->p);
  w->out->what = w->s.exact.missing;
  if (w->out->end != PL_CERTIFIED) return;
  pl_certified_balls_make(w->out, w->job, w->p);
  pl_system_reserve(&w->s, 64);
  pl_stepper_make(&w->e, &w->s, 1);
  pass z = {.s = &w->s,
            .e = &w->e,
            .out = w->out,
            .budget = w->p->budget > 0 ? (double)w->p->budget : default_budget};
  z.watches = pl_monitors_any(&w->s);
  z.time = _arb_vec_init(PL_CERTIFY_HAPPENINGS);
  z.state = _arb_vec_init((slong)PL_CERTIFY_HAPPENINGS * 2 * w->s.n_q);
  arb_init(z.t);
  arb_init(z.t_end);
  passes(&z);
  if (w->s.exact.missing) w->out->what = w->s.exact.missing;
  _arb_vec_clear(z.time, PL_CERTIFY_HAPPENINGS);
  _arb_vec_clear(z.state, (slong)PL_CERTIFY_HAPPENINGS * 2 * w->s.n_q);
  arb_clear(z.t);
  arb_clear(z.t_end);
}

// Memory that runs out in the arena comes back here; what FLINT holds is freed in either case.
static void guarded(void* data) {
  whole* w = data;
  PL_GUARD(w->job->arena, w->guard) {
    work(w);
    w->guard.status = PLEUEL_OK;
  }
  pl_guard_end(w->job->arena, &w->guard);
  w->memory = w->guard.status;
  pl_stepper_free(&w->e);
  pl_system_free(&w->s);
}

pleuel_status pl_certify_motion(pl_job* job, const pl_certify_problem* p, pl_certified* out) {
  *out = (pl_certified){
      .end = PL_CERTIFY_TOO_LARGE, .t_reached = (double)NAN, .width = (double)NAN};
  if (p->n_times < 1)
    return pl_fail(job, PLEUEL_USAGE, "there is no time at which to enclose the motion");
  whole* w = PL_NEW(job->arena, whole);
  *w = (whole){.job = job, .p = p, .out = out};
  if (!pl_algebra_guarded(guarded, w)) {
    pl_guard_end(job->arena, &w->guard);
    out->end = PL_CERTIFY_TOO_LARGE;
  } else if (w->memory != PLEUEL_OK) {
    pl_unwind(job->arena, w->memory);
  }
  return PLEUEL_OK;
}
