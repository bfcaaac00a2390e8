// What was proved, as it is handed out: decimal numbers with radii, and distances from the numbers
// of a run.
#include "enclose/enclose_impl.h"

#include <math.h>

void pl_certified_balls_make(pl_certified* out, pl_job* job, const pl_certify_problem* p) {
  struct pl_certified_balls* b = PL_NEW(job->arena, struct pl_certified_balls);
  *b = (struct pl_certified_balls){
      .n_q = p->setup->n_q, .n_c = p->setup->n_c, .n_times = p->n_times + 1};
  b->q = _arb_vec_init((slong)b->n_q * b->n_times);
  b->v = _arb_vec_init((slong)b->n_q * b->n_times);
  b->l = _arb_vec_init((slong)b->n_c * b->n_times);
  b->room = PL_CERTIFY_HAPPENINGS;
  b->time = _arb_vec_init(b->room);
  b->state = _arb_vec_init((slong)b->room * 2 * b->n_q);
  b->is_stop = PL_ARRAY(job->arena, bool, b->n_times);
  b->determined = PL_ARRAY(job->arena, bool, (size_t)b->n_c*(size_t)b->n_times + 1);
  out->balls = b;
}

void pl_certified_free(pl_certified* c) {
  struct pl_certified_balls* b = c->balls;
  if (!b) return;
  _arb_vec_clear(b->q, (slong)b->n_q * b->n_times);
  _arb_vec_clear(b->v, (slong)b->n_q * b->n_times);
  _arb_vec_clear(b->l, (slong)b->n_c * b->n_times);
  _arb_vec_clear(b->time, b->room);
  _arb_vec_clear(b->state, (slong)b->room * 2 * b->n_q);
  c->balls = NULL;
}

static arb_srcptr ball_of(const pl_certified* c, int time, pl_certify_kind kind, int i) {
  const struct pl_certified_balls* b = c->balls;
  if (!b || time < 0 || time >= c->n_done) return NULL;
  if (kind == PL_CERTIFY_Q) return b->q + (slong)time * b->n_q + i;
  if (kind == PL_CERTIFY_V) return b->v + (slong)time * b->n_q + i;
  bool known = b->determined[(size_t)time * (size_t)b->n_c + (size_t)i];
  return known ? b->l + (slong)time * b->n_c + i : NULL;
}

// The decimal is cut to the digits that the ball supports; the radius is measured from what was
// written.
static const char* decimal_of(pl_arena* a, arb_srcptr x, double* radius) {
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

const char* pl_certified_ball(const pl_certified* c, pl_arena* a, int time, pl_certify_kind kind,
                              int i, double* radius) {
  arb_srcptr x = ball_of(c, time, kind, i);
  return x ? decimal_of(a, x, radius) : NULL;
}

const char* pl_certified_state(const pl_certified* c, pl_arena* a, int happening,
                               pl_certify_kind kind, int i, double* radius) {
  int n_q = c->balls->n_q;
  return decimal_of(
      a, c->balls->state + (slong)happening * 2 * n_q + (kind == PL_CERTIFY_V ? n_q : 0) + i,
      radius);
}

const char* pl_certified_time(const pl_certified* c, pl_arena* a, int happening, double* radius) {
  return decimal_of(a, c->balls->time + happening, radius);
}

static double distance(arb_srcptr ball, double x, bool least) {
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
  return distance(ball_of(c, time, kind, i), x, false);
}

double pl_certified_error_least(const pl_certified* c, int time, pl_certify_kind kind, int i,
                                double x) {
  return distance(ball_of(c, time, kind, i), x, true);
}

double pl_certified_time_error(const pl_certified* c, int happening, double t) {
  return distance(c->balls->time + happening, t, false);
}
