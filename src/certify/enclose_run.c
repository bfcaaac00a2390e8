// The whole motion: passes of growing precision until the enclosure is as narrow as asked for.
//
// How much a motion and the arithmetic of balls widen an enclosure is not known beforehand.  The first pass measures it
// in bits; the next has as many bits more.  A pass that becomes wider than the motion itself is given up and its loss so far
// is extrapolated.  What a pass has enclosed is proved whatever comes after it; the narrowest is kept.
#include "certify/certify_impl.h"

#include <math.h>
#include <string.h>

#include "algebra/algebra.h"

enum { MOST_PASSES = 6, FIRST_BITS = 96, MOST_BITS = 20000, MOST_STEPS = 200000 };
static const double default_budget = 6e9;   // 10 to 20 s

typedef struct pass {
  pl_system* s;
  pl_stepper* e;
  pl_certified* out;
  double budget;
  arb_t t, t_end;
  double lost;         // bits at the end or where it was given up
  double part;         // of the way, 1 at the end
  double size_q, size_v, width;
} pass;

// ---------------------------------------------------------------------------------------------- results
static void make_balls(pl_certified* out, pl_job* job, const pl_certify_problem* p) {
  struct pl_certified_balls* b = PL_NEW(job->arena, struct pl_certified_balls);
  *b = (struct pl_certified_balls){p->setup->n_q, p->setup->n_c, p->n_times, NULL, NULL, NULL, NULL};
  b->q = _arb_vec_init((slong)b->n_q * b->n_times + 1);
  b->v = _arb_vec_init((slong)b->n_q * b->n_times + 1);
  b->l = _arb_vec_init((slong)b->n_c * b->n_times + 1);
  b->determined = PL_ARRAY(job->arena, bool, (size_t)b->n_c * (size_t)b->n_times + 1);
  out->balls = b;
}

void pl_certified_free(pl_certified* c) {
  struct pl_certified_balls* b = c->balls;
  if (!b) return;
  _arb_vec_clear(b->q, (slong)b->n_q * b->n_times + 1);
  _arb_vec_clear(b->v, (slong)b->n_q * b->n_times + 1);
  _arb_vec_clear(b->l, (slong)b->n_c * b->n_times + 1);
  c->balls = NULL;
}

// The first pass that reaches a time fills it; later ones only where they are narrower.
static void keep(arb_ptr to, arb_srcptr x, bool fresh) {
  if (fresh || mag_cmp(arb_radref(x), arb_radref(to)) < 0) arb_set(to, x);
}

static void keep_state(pass* z, int time) {
  pl_system* s = z->s;
  struct pl_certified_balls* b = z->out->balls;
  bool fresh = time >= z->out->n_done;
  for (int i = 0; i < b->n_q; i++) {
    keep(b->q + (slong)time * b->n_q + i, s->q + (slong)i * s->cap, fresh);
    keep(b->v + (slong)time * b->n_q + i, s->v + (slong)i * s->cap, fresh);
  }
  for (int c = 0; c < b->n_c; c++) {
    b->determined[(size_t)time * (size_t)b->n_c + (size_t)c] = s->row_of[c] >= 0;
    if (s->row_of[c] >= 0) keep(b->l + (slong)time * b->n_c + c, s->l + (slong)c * s->cap, fresh);
  }
  if (fresh) z->out->n_done = time + 1;
}

static arb_srcptr ball_of(const pl_certified* c, int time, pl_certify_kind kind, int i) {
  const struct pl_certified_balls* b = c->balls;
  if (!b || time < 0 || time >= c->n_done) return NULL;
  if (kind == PL_CERTIFY_Q) return b->q + (slong)time * b->n_q + i;
  if (kind == PL_CERTIFY_V) return b->v + (slong)time * b->n_q + i;
  bool known = b->determined[(size_t)time * (size_t)b->n_c + (size_t)i];
  return known ? b->l + (slong)time * b->n_c + i : NULL;
}

// The decimal is cut to the digits that the ball supports; the radius is measured from what was written.
const char* pl_certified_ball(const pl_certified* c, pl_arena* a, int time, pl_certify_kind kind, int i, double* radius) {
  arb_srcptr x = ball_of(c, time, kind, i);
  if (!x) return NULL;
  slong bits = arb_rel_accuracy_bits(x);
  slong digits = bits < 0 ? 1 : bits > 3000 ? 900 : (slong)((double)bits * 0.30103) + 2;
  char* text = arb_get_str(x, digits, ARB_STR_MORE | ARB_STR_NO_RADIUS);
  char* copy = pl_copy(a, text);
  flint_free(text);
  arb_t written;
  mag_t m;
  arb_init(written);
  mag_init(m);
  arb_set_str(written, copy, arb_bits(x) + 128);
  arb_sub(written, x, written, 64);
  arb_get_mag(m, written);
  *radius = mag_get_d(m);
  arb_clear(written);
  mag_clear(m);
  return copy;
}

static double distance(const pl_certified* c, int time, pl_certify_kind kind, int i, double x, bool least) {
  arb_srcptr ball = ball_of(c, time, kind, i);
  if (!ball || isnan(x)) return (double)NAN;
  arb_t d;
  mag_t m;
  arb_init(d);
  mag_init(m);
  arb_set_d(d, x);
  arb_sub(d, ball, d, 64);
  if (least) arb_get_mag_lower(m, d);
  else arb_get_mag(m, d);
  double answer = mag_get_d(m);
  arb_clear(d);
  mag_clear(m);
  return answer;
}

double pl_certified_error(const pl_certified* c, int time, pl_certify_kind kind, int i, double x) {
  return distance(c, time, kind, i, x, false);
}

double pl_certified_error_least(const pl_certified* c, int time, pl_certify_kind kind, int i, double x) {
  return distance(c, time, kind, i, x, true);
}

// ---------------------------------------------------------------------------------------------- width
static double largest(arb_srcptr x, const pl_system* s, bool radius) {
  double most = 0;
  mag_t m;
  mag_init(m);
  for (int i = 0; i < s->n_q; i++) {
    arb_srcptr y = x + (slong)i * s->cap;
    if (radius) mag_set(m, arb_radref(y));
    else arb_get_mag(m, y);
    most = fmax(most, mag_get_d(m));
  }
  mag_clear(m);
  return most;
}

static double over(double x, double size) { return x == 0 ? 0 : size > 0 ? x / size : x; }

// Half width of the state relative to the largest coordinate, or velocity, met so far.
static double state_width(pass* z) {
  z->size_q = fmax(z->size_q, largest(z->s->q, z->s, false));
  z->size_v = fmax(z->size_v, largest(z->s->v, z->s, false));
  return fmax(over(largest(z->s->q, z->s, true), z->size_q), over(largest(z->s->v, z->s, true), z->size_v));
}

// ---------------------------------------------------------------------------------------------- one pass
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

// To the exact time `target` in one or more steps.
static pl_certify_end go_to(pass* z, arb_srcptr target) {
  pl_system* s = z->s;
  pl_stepper* e = z->e;
  arb_t h;
  arb_init(h);
  pl_certify_end end = PL_CERTIFIED;
  for (bool there = false; !there && end == PL_CERTIFIED;) {
    arb_sub(h, target, z->t, s->prec);
    double left = fabs(pl_ball_double(h));
    if (pl_interrupted(s->job)) end = PL_CERTIFY_INTERRUPTED;
    else if (e->work > z->budget || z->out->steps >= MOST_STEPS) end = PL_CERTIFY_BUDGET;
    else if (!pl_system_point(s, z->t) || !pl_step_prove(e, z->t, left)) end = PL_CERTIFY_STEP;
    if (end != PL_CERTIFIED) break;
    double reach = e->radius * e->growth;
    there = left <= reach * (1 + 1e-9);
    // two equal steps rather than a long one and a short one
    if (!there) arb_set_d(h, e->direction * short_number(left < 2 * reach ? left / 2 : reach));
    if (!pl_step_advance(e, z->t, h)) end = PL_CERTIFY_STEP;
    if (end != PL_CERTIFIED) break;
    if (there) arb_set(z->t, target);
    else arb_add(z->t, z->t, h, s->prec);
    z->out->steps++;
    if (e->order > z->out->order) z->out->order = e->order;
    double width = state_width(z);
    z->lost = log2(fmax(width, 1e-300)) + (double)s->prec;
    if (!(width < 1e-4)) end = PL_CERTIFY_WIDE;
    tell(z, e->radius * e->growth);
  }
  arb_clear(h);
  return end;
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
  for (int i = 0; i < p->n_times && end == PL_CERTIFIED; i++) {
    if (!exact_time(z, target, p->times[i])) end = PL_CERTIFY_NO_EXACT;
    if (end == PL_CERTIFIED && !arb_equal(target, z->t)) end = go_to(z, target);
    if (end == PL_CERTIFIED && !pl_system_point(z->s, z->t)) end = PL_CERTIFY_STEP;
    if (end != PL_CERTIFIED) break;
    z->width = fmax(z->width, state_width(z));
    keep_state(z, i);
  }
  arb_clear(target);
  return end;
}

static pl_certify_end one_pass(pass* z, slong prec) {
  pl_system* s = z->s;
  z->out->steps = 0;
  z->out->bits = prec;
  z->lost = z->part = z->size_q = z->size_v = 0;
  if (!pl_system_precision(s, prec)) return PL_CERTIFY_NO_EXACT;
  if (!exact_time(z, z->t, s->p->t_0)) return PL_CERTIFY_NO_EXACT;
  if (!exact_time(z, z->t_end, s->p->times[s->p->n_times - 1])) return PL_CERTIFY_NO_EXACT;
  pl_certify_end end = pl_enclose_start(s, z->out, z->t);
  if (end != PL_CERTIFIED) return end;
  double t_0 = pl_ball_double(z->t);
  z->e->direction = direction_of(z);
  z->e->radius = z->e->longest = 0;
  end = to_times(z);
  z->part = end == PL_CERTIFIED ? 1 : part_done(z, t_0);
  double t = arf_get_d(arb_midref(z->t), z->e->direction > 0 ? ARF_RND_FLOOR : ARF_RND_CEIL);
  if (isnan(z->out->t_reached) || (t - z->out->t_reached) * z->e->direction > 0) z->out->t_reached = t;
  return end;
}

// ---------------------------------------------------------------------------------------------- passes
// Bits that the next pass needs.
static slong next_precision(const pass* z, slong prec) {
  double needed = -log2(z->s->p->width) + 8, whole = z->part > 1e-6 ? z->lost / z->part : (double)MOST_BITS;
  double bits = needed + fmax(whole, 0) * (z->part < 1 ? 1.1 : 1) + 8;
  if (bits < (double)prec + 32) bits = (double)prec + 32;
  return bits > MOST_BITS ? MOST_BITS : (slong)bits;
}

static void passes(pass* z) {
  pl_certified* out = z->out;
  double wanted = z->s->p->width;
  slong prec = (slong)(-log2(wanted)) + 40;
  if (prec < FIRST_BITS) prec = FIRST_BITS;
  for (int i = 0; i < MOST_PASSES; i++) {
    out->passes++;
    out->end = one_pass(z, prec);
    bool again = out->end == PL_CERTIFY_WIDE || (out->end == PL_CERTIFY_STEP && z->lost > (double)prec / 2);
    if (out->end == PL_CERTIFIED) {
      out->width = z->width;
      out->bits_lost = z->lost;
      again = out->width > wanted;
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
  pl_stepper e;
  pl_guard guard;         // here, because FLINT's abort leaves without ending it
  pleuel_status memory;   // PLEUEL_NO_MEMORY when the arena unwound
} whole;

static void work(whole* w) {
  w->out->end = pl_system_make(&w->s, w->job, w->p);
  if (w->out->end != PL_CERTIFIED) return;
  make_balls(w->out, w->job, w->p);
  pl_system_reserve(&w->s, 64);
  pl_stepper_make(&w->e, &w->s, 1);
  pass z = {.s = &w->s, .e = &w->e, .out = w->out, .budget = w->p->budget > 0 ? (double)w->p->budget : default_budget};
  arb_init(z.t);
  arb_init(z.t_end);
  passes(&z);
  if (w->s.exact.missing) w->out->what = w->s.exact.missing;
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
  *out = (pl_certified){.end = PL_CERTIFY_TOO_LARGE, .t_reached = (double)NAN, .width = (double)NAN};
  if (p->n_times < 1) return pl_fail(job, PLEUEL_USAGE, "there is no time at which to enclose the motion");
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
