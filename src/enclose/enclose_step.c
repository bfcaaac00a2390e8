// One proved step.
//
// Existence. Let Y be the product of the disks |q_i - q_i(t)| <= reach_q, |v_i - v_i(t)| <= reach_v
// and A_i a bound of |a_i| over Y and the disk of times of radius R. If R A_i <= reach_v and R
// |v_i| + R² A_i/2 <= reach_q, Picard's operator q -> q + v t + double integral of a, v -> v +
// integral of a, along the radius to each complex time, maps the analytic functions with values in
// Y to themselves, so the motion exists for |s - t| < R, is analytic there and stays in Y
// [HairerNorsettWanner1993, I.7], [Tucker2011, ch. 6].
//
// Tail. By Cauchy's estimate coefficient k of q_i is at most reach_q R^-k, so that what is left of
// the series after order p at |h| = x R is at most reach_q x^(p+1)/(1-x). Likewise v.
// See theory (18.1), (18.2).
#include "enclose/enclose_impl.h"

#include <math.h>

static const double shrink = 0.8;   // of the radius when it is not proved
static const double stretch = 1.4;  // tried beyond the last one
// radius over the longest one: below it the motion runs into a singular position
static const double smallest = 1e-9;
// step over radius: least work for p^2 operations of a step, near exp(-2)
static const double natural = 0.14;
enum { MOST_TRIES = 140, MOST_BOUNDS = 8 };

void pl_stepper_make(pl_enclosure_stepper* e, pl_system* s, int direction) {
  *e = (pl_enclosure_stepper){
      .s = s, .direction = direction, .growth = natural, .highest = PL_CERTIFY_ORDER};
  e->reach_q = _mag_vec_init(s->n_q + 1);
  e->reach_v = _mag_vec_init(s->n_q + 1);
  e->pull = _mag_vec_init(s->n_q + 1);
  mag_init(e->x);
}

void pl_stepper_free(pl_enclosure_stepper* e) {
  if (!e->reach_q) return;
  _mag_vec_clear(e->reach_q, e->s->n_q + 1);
  _mag_vec_clear(e->reach_v, e->s->n_q + 1);
  _mag_vec_clear(e->pull, e->s->n_q + 1);
  mag_clear(e->x);
}

// --------------------------------------------------------------------------------------- existence
static void reach(pl_enclosure_stepper* e, double radius) {
  pl_system* s = e->s;
  mag_t R, half, m;
  mag_init(R);
  mag_init(half);
  mag_init(m);
  mag_set_d(R, radius);
  mag_mul(half, R, R);
  mag_mul_2exp_si(half, half, -1);
  for (int i = 0; i < s->n_q; i++) {
    mag_mul(e->reach_v + i, R, e->pull + i);
    arb_get_mag(m, s->v + (slong)i * s->cap);
    mag_mul(e->reach_q + i, m, R);
    mag_addmul(e->reach_q + i, half, e->pull + i);
    pl_disk_set_ball(&s->q_disk[i], s->q + (slong)i * s->cap);
    pl_disk_set_ball(&s->v_disk[i], s->v + (slong)i * s->cap);
    mag_set(&s->q_disk[i].r, e->reach_q + i);
    mag_set(&s->v_disk[i].r, e->reach_v + i);
  }
  mag_clear(R);
  mag_clear(half);
  mag_clear(m);
}

// Whether the bounds of |a| that were assumed hold; where not, they are enlarged.
static bool bounds_hold(pl_enclosure_stepper* e) {
  bool hold = true;
  mag_t m, wider;
  mag_init(m);
  mag_init(wider);
  mag_set_d(wider, 1.15);
  for (int i = 0; i < e->s->n_q; i++) {
    pl_disk_bound(m, &e->s->a_disk[i]);
    if (mag_cmp(m, e->pull + i) <= 0) continue;
    mag_mul(e->pull + i, m, wider);
    hold = false;
  }
  mag_clear(m);
  mag_clear(wider);
  return hold;
}

static bool prove_radius(pl_enclosure_stepper* e, arb_srcptr t, double radius) {
  pl_system* s = e->s;
  pl_disk* times = &s->scratch[1];
  // begin with the pull at the centre
  for (int i = 0; i < s->n_q; i++) {
    arb_get_mag(e->pull + i, s->a + (slong)i * s->cap);
    mag_mul_2exp_si(e->pull + i, e->pull + i, 1);
  }
  for (int round = 0; round < MOST_BOUNDS; round++) {
    reach(e, radius);
    pl_disk_set_ball(times, t);
    mag_set_d(&times->r, radius);
    e->work += (double)s->n_nodes * 6 + pow(s->n_q + s->n_rows, 3);
    if (!pl_system_disks(s, times)) return false;
    if (bounds_hold(e)) return true;
  }
  return false;
}

bool pl_step_prove(pl_enclosure_stepper* e, arb_srcptr t, double longest) {
  double radius = e->radius > 0 ? e->radius * stretch : longest / e->growth;
  double whole = longest / e->growth;  // enough for what is left
  if (radius > whole) radius = whole;
  double least = smallest * fmin(fmax(e->longest, radius), whole);
  for (int i = 0; i < MOST_TRIES && radius > least; i++) {
    if (prove_radius(e, t, radius)) {
      e->radius = radius;
      e->longest = fmax(e->longest, radius);
      return true;
    }
    radius *= i < 3 ? shrink * 1.1 : shrink;
  }
  return false;
}

// ------------------------------------------------------------------------------------------ series
// Smallest order whose tail is below the rounding of the working precision.
static int order_for(const pl_enclosure_stepper* e, double x) {
  double p = ceil((double)(e->s->prec + 4) / -log2(x));
  return p < 4 ? 4 : p > e->highest ? e->highest : (int)p;
}

// reach x^(p+1)/(1-x)
void pl_series_tail(mag_t out, mag_srcptr reach_i, const mag_t x, int p) {
  mag_t one, gap;
  mag_init(one);
  mag_init(gap);
  mag_one(one);
  mag_sub_lower(gap, one, x);
  mag_pow_ui(out, x, (ulong)p + 1);
  mag_mul(out, out, reach_i);
  mag_div(out, out, gap);
  mag_clear(one);
  mag_clear(gap);
}

static void evaluate(arb_ptr series, arb_srcptr h, int p, const mag_t rest, slong prec) {
  arb_t y;
  arb_init(y);
  arb_set(y, series + p);
  for (int k = p - 1; k >= 0; k--) {
    arb_mul(y, y, h, prec);
    arb_add(y, y, series + k, prec);
  }
  arb_add_error_mag(y, rest);
  arb_swap(series, y);
  arb_clear(y);
}

void pl_step_take(pl_enclosure_stepper* e, arb_srcptr part) {
  pl_system* s = e->s;
  mag_t rest;
  mag_init(rest);
  for (int i = 0; i < s->n_q; i++) {
    pl_series_tail(rest, e->reach_q + i, e->x, e->order);
    evaluate(s->q + (slong)i * s->cap, part, e->order, rest, s->prec);
    pl_series_tail(rest, e->reach_v + i, e->x, e->order);
    evaluate(s->v + (slong)i * s->cap, part, e->order, rest, s->prec);
  }
  mag_clear(rest);
}

// x >= |h|/R
static void set_ratio(pl_enclosure_stepper* e, arb_srcptr h) {
  mag_t R;
  mag_init(R);
  arb_get_mag(e->x, h);
  mag_set_d_lower(R, e->radius);
  mag_div(e->x, e->x, R);
  // a little more: ends of intervals are rounded
  mag_set_ui_2exp_si(R, 1, -40);
  mag_addmul(e->x, e->x, R);
  mag_clear(R);
}

bool pl_step_series(pl_enclosure_stepper* e, arb_srcptr t, arb_srcptr h) {
  pl_system* s = e->s;
  set_ratio(e, h);
  if (mag_cmp_2exp_si(e->x, -1) >= 0) return false;
  double x = mag_get_d(e->x);
  e->order = order_for(e, x);
  if (e->order + 2 > s->cap) {
    pl_system_reserve(s, e->order + 16);
    pl_system_values(s, t, PL_FOR_MOTION);
  }
  pl_system_series(s, e->order, -log2(x));
  double limbs = (double)s->prec / 64 + 2;
  e->work += ((double)s->n_nodes + s->n_q * 4.0) * e->order * e->order / 4 * limbs;
  return true;
}
