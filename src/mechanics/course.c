// course: the way of a motion of one coordinate in numbers. With q'^2 = w(q) the motion runs
// between zeros of w: a simple zero turns it round, a double one is approached for ever. After two
// turns everything repeats, so that three legs tell the order in which
// places are met and the sign of the velocity there.                           [Arnold1989, sec. 4]
// See theory (6.4).
#include "mechanics/course.h"

#include <math.h>
#include <string.h>

static const double growth = 1.005;     // of the steps of a search away from the start
static const double first_step = 1e-6;  // of the scale
static const double farthest = 1e6;     // scales
// where a condition is looked at on a leg between two known ends
static const int points_of_a_leg = 1500;
// of an angle, that are searched where nothing repeats
static const int periods = 50;
static const double whole_period = 1.5;  // where all repeats after one
static const double steps_of_a_period = 300;
// of the largest value around: below it an extremum is a zero
static const double double_zero = 1e-11;
static const double vanishes = 1e-9;  // likewise, at the ends of a leg
// what gets smaller than this and then 0 has no zero: e^(-t)
static const double faded = 1e-250;
static const double at_the_end = 1e-7;  // of a leg: a zero there is one at the turn

double pl_course_value(const pl_course* c, pl_expr f, double q, int sign) {
  c->value[c->q.id] = q;
  if (c->v.id && sign != 2) {
    double w = pl_eval(c->d->pool, c->v2, c->value);
    c->value[c->v.id] = sign == 0 || w < 0 ? 0 : sign * sqrt(w);
  }
  return pl_eval(c->d->pool, f, c->value);
}

// ------------------------------------------------------------------------ one function on one line
// f at the parameter u of a line; a leg between two ends is bent so that roots of q'^2 are smooth
// at the ends.
typedef struct line_of {
  const pl_course* c;
  pl_expr f;
  int sign;
  double from, to;
  bool bent;
} line_of;

static double place(const line_of* l, double u) {
  return l->bent ? l->from + (l->to - l->from) * 0.5 * (1 - cos(M_PI * u)) : l->from + u;
}

static double at(const line_of* l, double u) {
  return pl_course_value(l->c, l->f, place(l, u), l->sign);
}

static double bisect(const line_of* l, double a, double b, double fa) {
  for (int k = 0; k < 200; k++) {
    double m = 0.5 * (a + b), fm = at(l, m);
    if (m == a || m == b) break;
    if (!isnan(fm) && (fm > 0) == (fa > 0)) a = m;
    else b = m;
  }
  return b;
}

// The least |f| between a and b, where f keeps its sign at the ends: golden section.
static double least(const line_of* l, double a, double b, double* u) {
  static const double ratio = 0.6180339887498949;
  double x1 = b - ratio * (b - a), x2 = a + ratio * (b - a), f1 = fabs(at(l, x1)),
         f2 = fabs(at(l, x2));
  for (int k = 0; k < 80; k++) {
    if (f1 < f2) {
      b = x2;
      x2 = x1;
      f2 = f1;
      f1 = fabs(at(l, x1 = b - ratio * (b - a)));
    } else {
      a = x1;
      x1 = x2;
      f1 = f2;
      f2 = fabs(at(l, x2 = a + ratio * (b - a)));
    }
  }
  *u = f1 < f2 ? x1 : x2;
  return at(l, *u);
}

// A walk along a line that stops at the first zero of f.
typedef enum zero_kind { NO_ZERO, CROSSES, TOUCHES, LEAVES_DOMAIN, HAS_POLE } zero_kind;
typedef struct walk {
  double u[3], f[3];
  int n;
  double size;
  zero_kind kind;
  double zero;
} walk;

static bool is_pole(const line_of* l, const walk* w, double u) {
  double near = fabs(at(l, u));
  return !isfinite(near) || near > 1e3 * (fabs(w->f[1]) + fabs(w->f[2]) + 1e-300);
}

// One more point; true: the walk ends.
static bool step(const line_of* l, walk* w, double u, bool domain_ends) {
  double f = at(l, u);
  if (!isfinite(f)) {
    if (domain_ends && w->n > 0) {
      w->kind = LEAVES_DOMAIN;
      w->zero = u;
      return true;
    }
    w->n = 0;
    return false;
  }
  w->u[0] = w->u[1];
  w->f[0] = w->f[1];
  w->u[1] = w->u[2];
  w->f[1] = w->f[2];
  w->u[2] = u;
  w->f[2] = f;
  w->n++;
  if (fabs(f) > w->size) w->size = fabs(f);
  bool underflows = f == 0 && fabs(w->f[1]) < faded;
  if (w->n >= 2 && (w->f[1] > 0) != (f > 0) && !underflows) {
    double zero = f == 0 ? u : bisect(l, w->u[1], u, w->f[1]);
    if (f != 0 && is_pole(l, w, zero)) {
      w->kind = HAS_POLE;
      w->zero = zero;
      if (domain_ends) return true;
      w->n = 0;
      return false;
    }
    w->kind = CROSSES;
    w->zero = zero;
    return true;
  }
  bool dips = w->n >= 3 && fabs(w->f[1]) <= fabs(w->f[0]) && fabs(w->f[1]) < fabs(f);
  if (!dips) return false;
  double low, value = least(l, w->u[0], u, &low);
  if ((value > 0) != (f > 0) && fabs(value) > double_zero * w->size) {
    w->kind = CROSSES;
    w->zero = bisect(l, w->u[0], low, w->f[0]);
    return true;
  }
  if (fabs(value) > double_zero * w->size) return false;
  w->kind = TOUCHES;
  w->zero = low;
  return true;
}

// -------------------------------------------------------------------------- where the motion turns
// From a place on to one side, up to the first zero of q'^2.
static pl_leg leg_from(const pl_course* c, double from, int sign, bool from_turn) {
  line_of l = {.c = c, .f = c->v2, .sign = 2, .from = from};
  pl_leg out = {.from = from, .sign = sign, .from_turn = from_turn, .end = PL_END_OPEN};
  walk w = {.size = c->speed * c->speed};
  double way = 0;
  for (double h = c->first; way < c->most; h = h * growth < c->longest ? h * growth : c->longest) {
    way += h;
    if (step(&l, &w, sign * way, true)) break;
  }
  out.to = from + sign * way;
  if (w.kind == NO_ZERO) return out;
  out.to = from + w.zero;
  out.end = w.kind == CROSSES ? PL_END_TURN : w.kind == TOUCHES ? PL_END_REST : PL_END_EDGE;
  return out;
}

// Every sin(k q), cos(k q) sets a scale.
static void look_for_rates(const pl_course* c, pl_expr e, double* low, double* high) {
  pl_pool* p = c->d->pool;
  if (pl_kind_of(p, e) == PL_CALL
      && (pl_function_of(p, e) == PL_SIN || pl_function_of(p, e) == PL_COS
          || pl_function_of(p, e) == PL_TAN)) {
    double k = fabs(pl_eval(p, pl_diff(p, pl_arg(p, e, 0), c->q), c->value));
    if (!(k > 0) || !isfinite(k)) return;
    if (*low == 0 || k < *low) *low = k;
    if (k > *high) *high = k;
    return;
  }
  if (!pl_has_symbol(p, e, c->q)) return;
  for (int i = 0; i < pl_n_args(p, e); i++) look_for_rates(c, pl_arg(p, e, i), low, high);
}

static void set_steps(pl_course* c, pl_expr f, double scale) {
  double low = 0, high = 0;
  c->value[c->q.id] = c->start;
  look_for_rates(c, f, &low, &high);
  c->rate = low;
  if (high > 0 && 1 / high < scale) scale = 1 / high;
  c->first = first_step * scale;
  if (c->first < 1e-12 * fabs(c->start)) c->first = 1e-12 * fabs(c->start);
  c->most = farthest * scale;
  c->longest = c->most;
  if (high == 0) return;
  c->longest = 2 * M_PI / high / steps_of_a_period;
  c->most = (pl_course_repeats(c, f) ? whole_period : periods) * 2 * M_PI / low;
}

// From rest: to the side where q'^2 grows; an equilibrium is left to the side that is named.
static int side_from_rest(const pl_course* c, int side, bool* either) {
  double right = pl_course_value(c, c->v2, c->start + 16 * c->first, 2),
         left = pl_course_value(c, c->v2, c->start - 16 * c->first, 2);
  *either = right > 0 && left > 0 && side == 0;
  if (right > 0 && left > 0) return side;
  return right > 0 ? 1 : left > 0 ? -1 : 0;
}

bool pl_course_make(pl_analysis* d, double* value, pl_symbol q, pl_expr v2, double q0, double v0,
                    int side, pl_course* out) {
  pl_course* c = out;
  *c = (pl_course){.d = d,
                   .value = value,
                   .q = q,
                   .v = pl_symbol_dot(d->pool, q),
                   .v2 = v2,
                   .start = q0,
                   .speed = fabs(v0)};
  if (!isfinite(q0) || !isfinite(v0)) return false;
  value[q.id] = q0;
  double pull = pl_eval(d->pool, pl_diff(d->pool, v2, q), value) / 2,
         scale = q0 != 0 ? fabs(q0) : 1;
  if (isfinite(pull) && pull != 0 && v0 != 0 && v0 * v0 / fabs(pull) < scale)
    scale = v0 * v0 / fabs(pull);
  set_steps(c, v2, scale);
  int sign = v0 > 0   ? 1
             : v0 < 0 ? -1
             : isfinite(pull)
                     && fabs(pull) > 1e-9 * fabs(pl_course_value(c, v2, q0 + c->most / farthest, 2))
                 ? (pull > 0 ? 1 : -1)
                 : 0;
  if (sign == 0) sign = side_from_rest(c, side, &c->either);
  c->stays = sign == 0;
  if (c->stays) return true;
  c->leg[c->n_legs++] = leg_from(c, q0, sign, v0 == 0);
  while (c->n_legs < pl_max_legs && c->leg[c->n_legs - 1].end == PL_END_TURN) {
    const pl_leg* last = &c->leg[c->n_legs - 1];
    pl_leg next = leg_from(c, last->to, -last->sign, true);
    if (c->n_legs == 2) {
      next.to = c->leg[0].to;
      next.end = PL_END_TURN;
    }  // back to the first turn
    c->leg[c->n_legs++] = next;
  }
  return true;
}

void pl_course_of_time(pl_analysis* d, double* value, pl_expr f, pl_course* out) {
  *out = (pl_course){.d = d, .value = value, .q = pl_time(d->pool), .n_legs = 1};
  set_steps(out, f, 1);
  out->first *= 1e-3;
  out->leg[0] = (pl_leg){.to = out->most, .sign = 1, .end = PL_END_OPEN};
}

// ------------------------------------------------------------------------------------- what is met
bool pl_course_repeats(const pl_course* c, pl_expr f) {
  static const double aside[] = {0.3, 1.1, 2.3};  // rad of the slowest angle, anywhere
  if (c->rate == 0) return false;
  for (int k = 0; k < 3; k++) {
    double q = c->start + aside[k] / c->rate, next = q + 2 * M_PI / c->rate;
    double w = pl_course_value(c, c->v2, q, 2), w_next = pl_course_value(c, c->v2, next, 2);
    if (!(fabs(w - w_next) <= vanishes * (fabs(w) + fabs(w_next)))) return false;
    double y = pl_course_value(c, f, q, 1), y_next = pl_course_value(c, f, next, 1);
    if (!(fabs(y - y_next) <= vanishes * (fabs(y) + fabs(y_next)))) return false;
  }
  return true;
}

// On one leg.  The start itself does not count, a turn at the end does.
static bool meets_on(const pl_course* c, int k, pl_expr f, pl_meeting* out) {
  const pl_leg* g = &c->leg[k];
  line_of l = {
      .c = c, .f = f, .sign = g->sign, .from = g->from, .to = g->to, .bent = g->end != PL_END_OPEN};
  walk w = {0};
  double begin = at(&l, 0);
  if (l.bent) {
    // other ends are not reached
    int last = g->end == PL_END_TURN ? points_of_a_leg : points_of_a_leg - 1;
    for (int i = 1; i <= last; i++) {
      if (step(&l, &w, (double)i / points_of_a_leg, false)) break;
    }
  } else {
    double way = 0, end = fabs(g->to - g->from),
           turn = c->rate > 0 ? whole_period * 2 * M_PI / c->rate : end;
    if (turn < end && pl_course_repeats(c, f)) end = turn;
    for (double h = c->first; way < end; h = h * growth < c->longest ? h * growth : c->longest) {
      way += h;
      if (step(&l, &w, g->sign * way, false)) break;
    }
  }
  if (fabs(begin) > w.size && isfinite(begin)) w.size = fabs(begin);
  *out = (pl_meeting){.leg = k, .sign = g->sign};
  if (w.kind == CROSSES || w.kind == TOUCHES) {
    out->at = place(&l, w.zero);
    out->touches = w.kind == TOUCHES;
    if (g->end == PL_END_TURN && w.zero > 1 - at_the_end) {
      out->at = g->to;
      out->sign = 0;
    }
    return true;
  }
  if (g->end != PL_END_TURN) return false;
  double end = pl_course_value(c, f, g->to, 0);
  if (!(fabs(end) <= vanishes * w.size)) return false;
  out->at = g->to;
  out->sign = 0;
  return true;
}

bool pl_course_meets(const pl_course* c, pl_expr f, pl_meeting* out) {
  for (int k = 0; k < c->n_legs; k++) {
    if (meets_on(c, k, f, out)) return true;
  }
  return false;
}

bool pl_course_reaches(const pl_course* c, double q, pl_meeting* out) {
  double near = 1e-10 * (fabs(q) + fabs(c->start)) + 1e-3 * c->first;
  *out = (pl_meeting){.at = q, .sign = c->n_legs > 0 && c->speed > 0 ? c->leg[0].sign : 0};
  if (fabs(q - c->start) <= near) return true;
  for (int k = 0; k < c->n_legs; k++) {
    const pl_leg* g = &c->leg[k];
    double beyond = (q - g->to) * g->sign, before = (g->from - q) * g->sign;
    if (before > near || (g->end == PL_END_OPEN ? false : beyond > near)) continue;
    if (g->end == PL_END_REST && fabs(beyond) <= near) continue;
    *out = (pl_meeting){
        .leg = k, .at = q, .sign = g->end == PL_END_TURN && fabs(beyond) <= near ? 0 : g->sign};
    return true;
  }
  return false;
}

bool pl_meets_before(const pl_meeting* a, const pl_meeting* b, const pl_course* c) {
  if (a->leg != b->leg) return a->leg < b->leg;
  return (b->at - a->at) * c->leg[a->leg].sign > 0;
}
