// Functions of one and two arguments: what is always true of them. Parity, special angles, shifts
// by multiples of a quarter turn, inverse functions of special values, exact numbers.
#include "expr/expr_impl.h"

static pl_expr raw_call(pl_pool* p, pl_function f, pl_expr a) {
  return pl_node_make(p, PL_CALL, f, 0, 0, &a, 1);
}

static bool is_call(const pl_pool* p, pl_expr e, pl_function f) {
  return pl_kind_of(p, e) == PL_CALL && pl_function_of(p, e) == f;
}

// ------------------------------------------------------------------------------------------ parity
// One of x and -x is the one to write: a number by its sign, a product by its coefficient and the
// brackets in it, a sum by its first term that is no number. Brackets in brackets count down to the
// given depth.
static bool negative_to_depth(const pl_pool* p, pl_expr e, int depth) {
  pl_kind k = pl_kind_of(p, e);
  if (k == PL_NUMBER) return pl_number_sign(p, e) < 0;
  if (depth == 0) return false;
  if (k == PL_ADD)
    return negative_to_depth(p, pl_arg(p, e, pl_is_number(p, pl_arg(p, e, 0)) ? 1 : 0), depth - 1);
  if (k != PL_MUL) return false;
  bool negative = false;
  for (int i = 0, n = pl_n_args(p, e); i < n; i++) {
    pl_expr x = pl_arg(p, e, i);
    if ((pl_is_number(p, x) || pl_kind_of(p, x) == PL_ADD) && negative_to_depth(p, x, depth - 1))
      negative = !negative;
  }
  return negative;
}

static bool looks_negative(const pl_pool* p, pl_expr e) { return negative_to_depth(p, e, 6); }

static pl_expr opposite_sum(pl_pool* p, pl_expr e) {
  pl_exprs terms = {0};
  for (int i = 0, n = pl_n_args(p, e); i < n; i++)
    pl_temp_push(p, terms, pl_neg(p, pl_arg(p, e, i)));
  pl_expr sum = pl_add_n(p, terms.at, terms.n);
  pl_temp_free(p, terms);
  return sum;
}

// -e, the sign taken into a bracket rather than put before it.
static pl_expr opposite(pl_pool* p, pl_expr e) {
  pl_kind k = pl_kind_of(p, e);
  if (k == PL_ADD) return opposite_sum(p, e);
  if (k != PL_MUL || pl_number_sign(p, pl_arg(p, e, 0)) < 0) return pl_neg(p, e);
  pl_exprs factors = {0};
  bool done = false;
  for (int i = 0, n = pl_n_args(p, e); i < n; i++) {
    pl_expr x = pl_arg(p, e, i);
    bool turn = !done && pl_kind_of(p, x) == PL_ADD && looks_negative(p, x);
    done = done || turn;
    pl_temp_push(p, factors, turn ? opposite_sum(p, x) : x);
  }
  if (!done) pl_temp_push(p, factors, p->minus_one);
  pl_expr product = pl_mul_n(p, factors.at, factors.n);
  pl_temp_free(p, factors);
  return product;
}

// ------------------------------------------------------------------------------------------ angles
// The number c of a term c π; poison for any other.
static pl_expr multiple_of_pi(const pl_pool* p, pl_expr e) {
  pl_term t = pl_term_of(p, e);
  return t.n == 1 && t.one.id == p->pi.id ? t.coefficient : pl_poison();
}

// Splits e into c π + rest.
static void split_angle(pl_pool* p, pl_expr e, pl_expr* c, pl_expr* rest) {
  *c = multiple_of_pi(p, e);
  *rest = p->zero;
  if (c->id != 0) return;
  *c = p->zero;
  *rest = e;
  if (pl_kind_of(p, e) != PL_ADD) return;
  for (int i = 0, n = pl_n_args(p, e); i < n; i++) {
    pl_expr x = multiple_of_pi(p, pl_arg(p, e, i));
    if (x.id == 0) continue;
    *c = x;
    *rest = pl_sub(p, e, pl_arg(p, e, i));
    return;
  }
}

// c as a multiple of 1/12 between 0 and 24, -1 when it is none: the angle in steps of 15 degrees.
static int steps_of_15_degrees(pl_pool* p, pl_expr c) {
  pl_expr twelve_c = pl_number_mul(p, c, pl_int(p, 12));
  if (twelve_c.id == 0 || !pl_number_is_integer(p, twelve_c)) return -1;
  pl_expr turns = pl_number_floor(p, pl_number_mul(p, twelve_c, pl_ratio(p, 1, 24)));
  pl_expr left = pl_number_add(p, twelve_c, pl_number_mul(p, turns, pl_int(p, -24)));
  long n;
  return pl_is_int(p, left, &n) ? (int)n : -1;
}

// sin(15° k), poison when it is not among 0, 30, 45, 60, 90 and so on.
static pl_expr sine_at(pl_pool* p, int k) {
  k = ((k % 24) + 24) % 24;
  if (k > 12) return pl_neg(p, sine_at(p, k - 12));
  if (k > 6) k = 12 - k;
  switch (k) {
    case 0: return p->zero;
    case 2: return p->half;
    case 3: return pl_mul(p, p->half, pl_sqrt(p, p->two));
    case 4: return pl_mul(p, p->half, pl_sqrt(p, pl_int(p, 3)));
    case 6: return p->one;
    default: return pl_poison();
  }
}

// sin(e + quarters * 90°) as plus or minus sin or cos of e.
static pl_expr shifted_sine(pl_pool* p, pl_expr e, int quarters) {
  switch (((quarters % 4) + 4) % 4) {
    case 0: return pl_call(p, PL_SIN, e);
    case 1: return pl_call(p, PL_COS, e);
    case 2: return pl_neg(p, pl_call(p, PL_SIN, e));
    default: return pl_neg(p, pl_call(p, PL_COS, e));
  }
}

// sqrt(1 - u^2): sin(acos u) and cos(asin u), both where acos and asin have values.
static pl_expr other_leg(pl_pool* p, pl_expr u) {
  return pl_sqrt(p, pl_sub(p, p->one, pl_square(p, u)));
}

// f(e) when the sign of e needs no more thought.
static pl_expr plain_trigonometric(pl_pool* p, pl_function f, pl_expr e) {
  pl_function inverse = f == PL_SIN ? PL_ASIN : f == PL_COS ? PL_ACOS : PL_ATAN;
  if (is_call(p, e, inverse)) return pl_arg(p, e, 0);
  if (f != PL_TAN && (is_call(p, e, PL_ASIN) || is_call(p, e, PL_ACOS)))
    return other_leg(p, pl_arg(p, e, 0));
  return raw_call(p, f, e);
}

static pl_expr sine_or_cosine(pl_pool* p, pl_function f, pl_expr e) {
  bool sine = f == PL_SIN;
  pl_expr c, rest;
  split_angle(p, e, &c, &rest);
  if (c.id != p->zero.id || rest.id == p->zero.id) {
    int k = steps_of_15_degrees(p, c);
    if (rest.id == p->zero.id && k >= 0) {
      pl_expr value = sine_at(p, sine ? k : k + 6);
      if (value.id != 0) return value;
    }
    if (rest.id != p->zero.id && k >= 0 && k % 6 == 0)
      return shifted_sine(p, rest, sine ? k / 6 : k / 6 + 1);
  }
  if (!looks_negative(p, e)) return plain_trigonometric(p, f, e);
  pl_expr turned = plain_trigonometric(p, f, opposite(p, e));
  return sine ? pl_neg(p, turned) : turned;
}

static pl_expr tangent(pl_pool* p, pl_function f, pl_expr e) {
  pl_expr c, rest;
  split_angle(p, e, &c, &rest);
  int k = steps_of_15_degrees(p, c);
  if (rest.id == p->zero.id && k >= 0) {
    pl_expr s = sine_at(p, k), t = sine_at(p, k + 6);
    if (s.id != 0 && t.id != 0) return pl_div(p, s, t);  // poison at 90°
  }
  if (rest.id != p->zero.id && c.id != p->zero.id && k >= 0 && k % 12 == 0)
    return pl_call(p, PL_TAN, rest);
  if (!looks_negative(p, e)) return plain_trigonometric(p, PL_TAN, e);
  return pl_neg(p, plain_trigonometric(p, PL_TAN, opposite(p, e)));
}

// ------------------------------------------------------------------------------- inverse functions
// The first-quadrant angle whose sine is the non-negative u, in steps of 15 degrees; -1 if it is
// not a special one.
static int special_arcsine(pl_pool* p, pl_expr u) {
  static const int steps[] = {0, 2, 3, 4, 6};
  for (int i = 0; i < 5; i++) {
    if (sine_at(p, steps[i]).id == u.id) return steps[i];
  }
  return -1;
}

static int special_arctangent(pl_pool* p, pl_expr u) {
  static const int steps[] = {0, 2, 3, 4};
  for (int i = 0; i < 4; i++) {
    if (pl_div(p, sine_at(p, steps[i]), sine_at(p, steps[i] + 6)).id == u.id) return steps[i];
  }
  return -1;
}

static pl_expr steps_angle(pl_pool* p, int steps) {
  return pl_mul(p, pl_ratio(p, steps, 12), p->pi);
}

static pl_expr arc_function(pl_pool* p, pl_function f, pl_expr u) {
  bool negative = looks_negative(p, u);
  pl_expr v = negative ? opposite(p, u) : u;
  int k = f == PL_ATAN ? special_arctangent(p, v) : special_arcsine(p, v);
  if (f == PL_ACOS) {
    if (k < 0) return raw_call(p, f, u);
    return steps_angle(p, negative ? 6 + k : 6 - k);
  }
  pl_expr angle = k < 0 ? raw_call(p, f, v) : steps_angle(p, k);
  return negative ? pl_neg(p, angle) : angle;
}

// atan2(y, x) on the axes; undefined at the origin.
static pl_expr arctangent2(pl_pool* p, pl_function f, pl_expr y, pl_expr x) {
  if (y.id == p->zero.id && x.id == p->zero.id) return pl_poison();
  int sx = pl_number_sign(p, x), sy = pl_number_sign(p, y);
  if (y.id == p->zero.id && sx != 0) return sx > 0 ? p->zero : p->pi;
  if (x.id == p->zero.id && sy != 0) return pl_mul(p, pl_ratio(p, sy, 2), p->pi);
  if (sx != 0 && sy != 0) {
    pl_expr angle = pl_call(p, PL_ATAN, pl_div(p, y, x));
    return sx > 0 ? angle : pl_add(p, angle, sy > 0 ? p->pi : pl_neg(p, p->pi));
  }
  return pl_node_make(p, PL_CALL, PL_ATAN2, 0, 0, (pl_expr[]){y, x}, 2);
}

// -------------------------------------------------------------------------------- exp and the like
static pl_expr hyperbolic(pl_pool* p, pl_function f, pl_expr e) {
  if (e.id == p->zero.id) return f == PL_COSH ? p->one : p->zero;
  if (!looks_negative(p, e)) return raw_call(p, f, e);
  pl_expr turned = raw_call(p, f, opposite(p, e));
  return f == PL_COSH ? turned : pl_neg(p, turned);
}

static pl_expr exponential(pl_pool* p, pl_function f, pl_expr e) {
  if (e.id == p->zero.id) return p->one;
  if (is_call(p, e, PL_LN)) return pl_arg(p, e, 0);
  pl_term t = pl_term_of(p, e);
  if (t.n == 1 && pl_kind_of(p, t.one) == PL_INFINITY) {
    return pl_number_sign(p, t.coefficient) > 0 ? pl_infinity(p) : p->zero;
  }
  return raw_call(p, PL_EXP, e);
}

static pl_expr logarithm(pl_pool* p, pl_function f, pl_expr e) {
  if (e.id == p->one.id) return p->zero;
  if (is_call(p, e, PL_EXP)) return pl_arg(p, e, 0);
  if (pl_is_number(p, e) && pl_number_sign(p, e) <= 0) return pl_poison();
  return raw_call(p, PL_LN, e);
}

// ----------------------------------------------------------------------------------- size and sign
// What cannot be negative whatever the symbols are: even powers, roots, exp, abs, positive numbers,
// and products of these.
static bool never_negative(const pl_pool* p, pl_expr e) {
  long n;
  switch (pl_kind_of(p, e)) {
    case PL_NUMBER: return pl_number_sign(p, e) >= 0;
    case PL_PI: return true;
    case PL_INFINITY: return true;
    case PL_POW:
      if (pl_is_int(p, pl_arg(p, e, 1), &n))
        return n % 2 == 0 || never_negative(p, pl_arg(p, e, 0));
      return pl_is_number(p, pl_arg(p, e, 1)) && !pl_number_is_integer(p, pl_arg(p, e, 1));
    case PL_CALL: {
      pl_function f = pl_function_of(p, e);
      return f == PL_EXP || f == PL_ABS || f == PL_COSH || f == PL_ACOS;
    }
    default: return false;
  }
}

// Splits |e| into what is known not to be negative, and the rest.
static void split_size(pl_pool* p, pl_expr e, pl_expr* known, pl_expr* rest) {
  pl_exprs sure = {0}, open = {0};
  bool product = pl_kind_of(p, e) == PL_MUL;
  for (int i = 0, n = product ? pl_n_args(p, e) : 1; i < n; i++) {
    pl_expr x = product ? pl_arg(p, e, i) : e;
    if (pl_number_sign(p, x) < 0) x = pl_neg(p, x);
    if (never_negative(p, x)) pl_temp_push(p, sure, x);
    else pl_temp_push(p, open, x);
  }
  *known = pl_mul_n(p, sure.at, sure.n);
  *rest = pl_mul_n(p, open.at, open.n);
  pl_temp_free(p, sure);
  pl_temp_free(p, open);
}

static pl_expr absolute(pl_pool* p, pl_function f, pl_expr e) {
  pl_expr known, rest;
  split_size(p, e, &known, &rest);
  if (rest.id == p->one.id) return known;
  if (looks_negative(p, rest)) rest = opposite(p, rest);
  return pl_mul(p, known, raw_call(p, PL_ABS, rest));
}

static pl_expr signum(pl_pool* p, pl_function f, pl_expr e) {
  if (pl_is_number(p, e)) return pl_int(p, pl_number_sign(p, e));
  if (pl_kind_of(p, e) == PL_INFINITY) return p->one;
  pl_term t = pl_term_of(p, e);
  int sign = pl_number_sign(p, t.coefficient);
  pl_expr rest = pl_div(p, e, t.coefficient);
  if (rest.id == p->pi.id || is_call(p, rest, PL_EXP)) return pl_int(p, sign);
  if (pl_kind_of(p, rest) == PL_ADD && looks_negative(p, rest)) {
    rest = opposite(p, rest);
    sign = -sign;
  }
  pl_expr s = raw_call(p, PL_SIGN, rest);
  return sign < 0 ? pl_neg(p, s) : s;
}

static pl_expr smaller_or_larger(pl_pool* p, pl_function f, pl_expr a, pl_expr b) {
  if (a.id == b.id) return a;
  if (pl_is_number(p, a) && pl_is_number(p, b))
    return (pl_number_compare(p, a, b) < 0) == (f == PL_MIN) ? a : b;
  if (pl_compare(p, a, b) > 0) {
    pl_expr c = a;
    a = b;
    b = c;
  }
  return pl_node_make(p, PL_CALL, f, 0, 0, (pl_expr[]){a, b}, 2);
}

// ------------------------------------------------------------------------------------------- calls
pl_expr pl_call(pl_pool* p, pl_function f, pl_expr a) {
  if (a.id == 0 || (int)f < 0 || f >= PL_N_FUNCTIONS || pl_function_arity[f] != 1)
    return pl_poison();
  switch (f) {
#define FORM_1(form) return form(p, f, a)
#define FORM_2(form) break
#define PL_FUNCTION(name, text, n, tex, form, ...) \
  case PL_##name:                                  \
    FORM_##n(form);
#include "expr/functions.def"
#undef FORM_1
#undef FORM_2
    default: break;
  }
  return pl_poison();
}

pl_expr pl_call2(pl_pool* p, pl_function f, pl_expr a, pl_expr b) {
  if (a.id == 0 || b.id == 0 || (int)f < 0 || f >= PL_N_FUNCTIONS || pl_function_arity[f] != 2)
    return pl_poison();
  switch (f) {
#define FORM_1(form) break
#define FORM_2(form) return form(p, f, a, b)
// clang-format off
#define PL_FUNCTION(name, text, n, tex, form, ...) \
  case PL_##name: FORM_##n(form);
#include "expr/functions.def"
      // clang-format on
    default: break;
  }
  return pl_poison();
}
