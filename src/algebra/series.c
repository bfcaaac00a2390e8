// Power series and limits. Every node of the expression gets a truncated Laurent series in u = x -
// at (u = 1/x at infinity) with coefficients in normal form; leading coefficients are tested for
// zero, so poles and cancellations are seen. Powers of any rational exponent by Miller's
// recurrence, elementary functions by their differential equations.
#include "algebra/tower.h"

#include <string.h>

enum { PL_MAX_SERIES = 40, PL_SERIES_TRIES = 4 };

// sum_{k < n} c[k] u^(lead + k) + O(u^(lead + n)); c[0] is not zero, unless the series is zero to
// its order.
typedef struct pl_series {
  int lead, n;
  bool zero;
  pl_expr c[PL_MAX_SERIES];
} pl_series;  // zero: to all orders

typedef struct pl_expansion {
  pl_tower* t;
  pl_pool* p;
  pl_symbol x;
  pl_expr at;
  bool infinite, from_above;
  int n;  // terms to work with
  bool failed;
  pl_map* known;  // expression id -> index + 1
  PL_VEC(pl_series*) memo;
} pl_expansion;

static const pl_series* expand_node(pl_expansion* s, pl_expr e);

static pl_series* fresh(pl_expansion* s, int lead, int n) {
  pl_series* r = PL_NEW(s->t->arena, pl_series);
  r->lead = lead;
  r->n = n < s->n ? n : s->n;
  if (r->n < 0) r->n = 0;
  for (int k = 0; k < r->n; k++) r->c[k] = pl_int(s->p, 0);
  return r;
}

static pl_series* fail(pl_expansion* s) {
  s->failed = true;
  return fresh(s, 0, s->n);
}

static pl_expr normal(pl_expansion* s, pl_expr e) {
  pl_expr r = pl_alg_normal(s->t, e);
  if (pl_is_poison(r)) s->failed = true;
  return r;
}

static bool is_zero(pl_expansion* s, pl_expr e) {
  pl_answer3 zero = pl_alg_is_zero(s->t, e);
  if (zero == PL_UNKNOWN) s->failed = true;
  return zero == PL_YES;
}

static bool all_zero(const pl_expansion* s, const pl_series* a) {
  for (int k = 0; k < a->n; k++) {
    if (!pl_is_zero_node(s->p, a->c[k])) return false;
  }
  return true;
}

// Leading zeros go; the order of truncation stays.
static pl_series* strip(pl_expansion* s, pl_series* a) {
  int zeros = 0;
  while (zeros < a->n && is_zero(s, a->c[zeros])) zeros++;
  if (zeros == a->n) {
    for (int k = 0; k < a->n; k++) a->c[k] = pl_int(s->p, 0);
    return a;
  }
  memmove(a->c, a->c + zeros, (size_t)(a->n - zeros) * sizeof *a->c);
  a->lead += zeros;
  a->n -= zeros;
  return a;
}

static pl_series* constant(pl_expansion* s, pl_expr e) {
  pl_series* r = fresh(s, 0, s->n);
  if (r->n > 0) r->c[0] = normal(s, e);
  r->zero = r->n > 0 && pl_is_zero_node(s->p, r->c[0]);
  return r;
}

// -------------------------------------------------------------------------------------- arithmetic
static pl_series* add(pl_expansion* s, const pl_series* a, const pl_series* b) {
  if (a->zero || b->zero) {
    pl_series* copy = fresh(s, 0, 0);
    *copy = a->zero ? *b : *a;
    return copy;
  }
  int lead = a->lead < b->lead ? a->lead : b->lead;
  int end_a = a->lead + a->n, end_b = b->lead + b->n;
  int end = end_a < end_b ? end_a : end_b;
  pl_series* r = fresh(s, lead, end - lead);
  for (int k = 0; k < r->n; k++) {
    int i = lead + k - a->lead, j = lead + k - b->lead;
    pl_expr x = i >= 0 && i < a->n ? a->c[i] : pl_int(s->p, 0);
    pl_expr y = j >= 0 && j < b->n ? b->c[j] : pl_int(s->p, 0);
    r->c[k] = normal(s, pl_add(s->p, x, y));
  }
  return strip(s, r);
}

static pl_series* mul(pl_expansion* s, const pl_series* a, const pl_series* b) {
  if (a->zero || b->zero) return constant(s, pl_int(s->p, 0));
  pl_series* r = fresh(s, a->lead + b->lead, a->n < b->n ? a->n : b->n);
  for (int k = 0; k < r->n; k++) {
    pl_expr sum = pl_int(s->p, 0);
    for (int i = 0; i <= k; i++) sum = pl_add(s->p, sum, pl_mul(s->p, a->c[i], b->c[k - i]));
    r->c[k] = normal(s, sum);
  }
  return strip(s, r);
}

// a^(num/den) by Miller:  s_k = 1/(k c_0) sum_{j=1..k} (α j - (k - j)) c_j s_{k-j}
static pl_series* power(pl_expansion* s, const pl_series* a, long num, long den) {
  pl_pool* p = s->p;
  if (all_zero(s, a)) return a->zero && num > 0 ? constant(s, pl_int(p, 0)) : fail(s);
  // u^(lead α) must be a whole power, and for even roots u must be positive unless it does not
  // occur
  long lead = (long)a->lead * num;
  if (lead % den != 0 || (den % 2 == 0 && a->lead != 0 && !s->from_above)) return fail(s);
  if (lead / den > 1000 || lead / den < -1000) return fail(s);
  pl_series* r = fresh(s, (int)(lead / den), a->n);
  pl_expr alpha = pl_ratio(p, num, den);
  if (r->n > 0) r->c[0] = normal(s, pl_pow(p, a->c[0], alpha));
  for (int k = 1; k < r->n && !s->failed; k++) {
    pl_expr sum = pl_int(p, 0);
    for (int j = 1; j <= k; j++) {
      pl_expr weight = pl_sub(p, pl_mul(p, alpha, pl_int(p, j)), pl_int(p, k - j));
      sum = pl_add(p, sum, pl_mul_n(p, (pl_expr[]){weight, a->c[j], r->c[k - j]}, 3));
    }
    r->c[k] = normal(s, pl_div(p, sum, pl_mul(p, pl_int(p, k), a->c[0])));
  }
  return r;
}

// --------------------------------------------------------------------------------------- functions
// The same series with lead 0 (a zero in front where needed); false when there is a pole.
static bool regular(pl_expansion* s, const pl_series* a, pl_series* out) {
  if (a->lead < 0) return false;
  if (a->zero) {
    *out = *a;
    return true;
  }
  pl_series* r = fresh(s, 0, a->lead + a->n);
  for (int k = a->lead; k < r->n; k++) r->c[k] = a->c[k - a->lead];
  *out = *r;
  return true;
}

// f' = g a' with a given g:  k f_k = sum_{j=1..k} j a_j g_{k-j}
static pl_series* integrate(pl_expansion* s, pl_expr start, const pl_series* a,
                            const pl_series* g) {
  pl_series ga;
  if (!regular(s, g, &ga)) return fail(s);
  pl_series* r = fresh(s, 0, a->n < ga.n + 1 ? a->n : ga.n + 1);
  if (r->n > 0) r->c[0] = normal(s, start);
  for (int k = 1; k < r->n; k++) {
    pl_expr sum = pl_int(s->p, 0);
    for (int j = 1; j <= k; j++)
      sum = pl_add(s->p, sum,
                   pl_mul_n(s->p, (pl_expr[]){pl_int(s->p, j), a->c[j], ga.c[k - j]}, 3));
    r->c[k] = normal(s, pl_div(s->p, sum, pl_int(s->p, k)));
  }
  return strip(s, r);
}

// Two functions with f' = a' g, g' = sign a' f: sin and cos (sign -1), sinh and cosh (sign 1).
static void pair(pl_expansion* s, pl_function f0, pl_function g0, int sign, const pl_series* a,
                 pl_series** f, pl_series** g) {
  pl_pool* p = s->p;
  *f = fresh(s, 0, a->n);
  *g = fresh(s, 0, a->n);
  if (a->n == 0) return;
  (*f)->c[0] = normal(s, pl_call(p, f0, a->c[0]));
  (*g)->c[0] = normal(s, pl_call(p, g0, a->c[0]));
  for (int k = 1; k < (*f)->n; k++) {
    pl_expr x = pl_int(p, 0), y = pl_int(p, 0);
    for (int j = 1; j <= k; j++) {
      pl_expr ja = pl_mul(p, pl_int(p, j), a->c[j]);
      x = pl_add(p, x, pl_mul(p, ja, (*g)->c[k - j]));
      y = pl_add(p, y, pl_mul(p, ja, (*f)->c[k - j]));
    }
    (*f)->c[k] = normal(s, pl_div(p, x, pl_int(p, k)));
    (*g)->c[k] = normal(s, pl_div(p, y, pl_int(p, sign * k)));
  }
}

static pl_series* exp_series(pl_expansion* s, const pl_series* a) {
  pl_pool* p = s->p;
  pl_series* r = fresh(s, 0, a->n);
  if (r->n > 0) r->c[0] = normal(s, pl_call(p, PL_EXP, a->c[0]));
  for (int k = 1; k < r->n; k++) {
    pl_expr sum = pl_int(p, 0);
    for (int j = 1; j <= k; j++)
      sum = pl_add(p, sum, pl_mul_n(p, (pl_expr[]){pl_int(p, j), a->c[j], r->c[k - j]}, 3));
    r->c[k] = normal(s, pl_div(p, sum, pl_int(p, k)));
  }
  return r;
}

// Beyond a pole: exp(-1/u) is smaller than every power, atan and tanh have limits.
static pl_series* at_pole(pl_expansion* s, pl_function f, const pl_series* a) {
  int sign = 0;
  if (a->n == 0 || !s->from_above || pl_alg_sign(s->t, a->c[0], false, &sign) != PL_YES
      || sign == 0)
    return fail(s);
  if (f == PL_EXP && sign < 0) return constant(s, pl_int(s->p, 0));
  if (f == PL_TANH) return constant(s, pl_int(s->p, sign));
  if (f != PL_ATAN) return fail(s);
  // atan(v) = ±π/2 - atan(1/v)
  pl_series inverse;
  if (!regular(s, power(s, a, -1, 1), &inverse)) return fail(s);
  pl_series* one = constant(s, pl_int(s->p, 1));
  pl_series* g = power(s, add(s, one, mul(s, &inverse, &inverse)), -1, 1);
  pl_series* r = integrate(s, pl_int(s->p, 0), &inverse, g);
  pl_series* half_turn = constant(s, pl_mul(s->p, pl_ratio(s->p, sign, 2), pl_pi(s->p)));
  return add(s, half_turn, mul(s, constant(s, pl_int(s->p, -1)), r));
}

static pl_series* inverse_function(pl_expansion* s, pl_function f, const pl_series* a) {
  pl_pool* p = s->p;
  pl_series* one = constant(s, pl_int(p, 1));
  pl_series* square = mul(s, a, a);
  pl_series* minus = mul(s, constant(s, pl_int(p, -1)), square);
  pl_expr start = pl_call(p, f, a->n ? a->c[0] : pl_int(p, 0));
  if (f == PL_ATAN) return integrate(s, start, a, power(s, add(s, one, square), -1, 1));
  pl_series* g = power(s, add(s, one, minus), -1, 2);
  if (f == PL_ACOS) g = mul(s, constant(s, pl_int(p, -1)), g);
  return integrate(s, start, a, g);
}

// Any other function of one argument: the integral of f'(a) a'.
static pl_series* by_slope(pl_expansion* s, pl_expr e, const pl_series* a) {
  if (pl_n_args(s->p, e) != 1) return fail(s);
  pl_expr start = pl_call(s->p, pl_function_of(s->p, e), a->n ? a->c[0] : pl_int(s->p, 0));
  return integrate(s, start, a, expand_node(s, pl_call_slope(s->p, e)));
}

static pl_series* abs_series(pl_expansion* s, const pl_series* a, bool only_sign) {
  int sign = 0;
  if (a->lead != 0 && !s->from_above) return fail(s);
  if (all_zero(s, a) || pl_alg_sign(s->t, a->c[0], false, &sign) != PL_YES || sign == 0)
    return fail(s);
  pl_series* factor = constant(s, pl_int(s->p, sign));
  return only_sign ? factor : mul(s, factor, a);
}

static pl_series* call_series(pl_expansion* s, pl_expr e) {
  pl_function f = pl_function_of(s->p, e);
  const pl_series* arg = expand_node(s, pl_arg(s->p, e, 0));
  if (f == PL_ABS || f == PL_SIGN) return abs_series(s, arg, f == PL_SIGN);
  pl_series a;
  if (!regular(s, arg, &a)) return at_pole(s, f, arg);
  pl_series *sine = NULL, *cosine = NULL;
  switch (f) {
    case PL_SIN: pair(s, PL_SIN, PL_COS, -1, &a, &sine, &cosine); return strip(s, sine);
    case PL_COS: pair(s, PL_SIN, PL_COS, -1, &a, &sine, &cosine); return strip(s, cosine);
    case PL_TAN:
      pair(s, PL_SIN, PL_COS, -1, &a, &sine, &cosine);
      return mul(s, strip(s, sine), power(s, strip(s, cosine), -1, 1));
    case PL_SINH: pair(s, PL_SINH, PL_COSH, 1, &a, &sine, &cosine); return strip(s, sine);
    case PL_COSH: pair(s, PL_SINH, PL_COSH, 1, &a, &sine, &cosine); return strip(s, cosine);
    case PL_TANH:
      pair(s, PL_SINH, PL_COSH, 1, &a, &sine, &cosine);
      return mul(s, strip(s, sine), power(s, strip(s, cosine), -1, 1));
    case PL_EXP: return exp_series(s, &a);
    case PL_LN:
      if (arg->lead != 0 || all_zero(s, arg)) return fail(s);
      return integrate(s, pl_call(s->p, PL_LN, a.c[0]), &a, power(s, &a, -1, 1));
    case PL_ASIN:
    case PL_ACOS:
    case PL_ATAN: return inverse_function(s, f, &a);
    default: return by_slope(s, e, &a);
  }
}

// ------------------------------------------------------------------------------------------- nodes
static pl_series* variable(pl_expansion* s) {
  if (s->infinite) {
    pl_series* r = fresh(s, -1, s->n);
    if (r->n > 0) r->c[0] = pl_int(s->p, 1);
    return r;
  }
  pl_series* r = constant(s, s->at);
  if (r->n > 1) r->c[1] = pl_int(s->p, 1);
  r->zero = false;
  if (r->n > 0 && pl_is_zero_node(s->p, r->c[0])) {
    r->lead = 1;
    for (int k = 0; k + 1 < r->n; k++) r->c[k] = r->c[k + 1];
    r->c[r->n - 1] = pl_int(s->p, 0);  // exact: the next coefficient is zero too
  }
  return r;
}

static pl_series* expand_now(pl_expansion* s, pl_expr e) {
  pl_pool* p = s->p;
  if (!pl_has_symbol(p, e, s->x)) return constant(s, e);
  pl_series* r = NULL;
  long num = 0, den = 1;
  switch (pl_kind_of(p, e)) {
    case PL_SYMBOL: return variable(s);
    case PL_ADD:
      r = constant(s, pl_int(p, 0));
      for (int i = 0; i < pl_n_args(p, e); i++) r = add(s, r, expand_node(s, pl_arg(p, e, i)));
      return r;
    case PL_MUL:
      r = constant(s, pl_int(p, 1));
      for (int i = 0; i < pl_n_args(p, e); i++) r = mul(s, r, expand_node(s, pl_arg(p, e, i)));
      return r;
    case PL_POW:
      if (!pl_is_ratio(p, pl_arg(p, e, 1), &num, &den)) return fail(s);
      return power(s, expand_node(s, pl_arg(p, e, 0)), num, den);
    case PL_CALL: return call_series(s, e);
    default: return fail(s);
  }
}

static const pl_series* expand_node(pl_expansion* s, pl_expr e) {
  uint64_t known = pl_map_get(s->known, e.id);
  if (known) return s->memo.at[known - 1];
  pl_series* r = s->failed || pl_interrupted(s->t->job) ? fail(s) : expand_now(s, e);
  pl_push(s->t->arena, s->memo, r);
  pl_map_set(s->known, e.id, (uint64_t)s->memo.n);
  return r;
}

// ---------------------------------------------------------------------------------------- services
// More terms are carried along than asked for, and more still when the leading ones cancel.
static bool expand_to(pl_tower* t, pl_expr e, pl_symbol x, pl_expr at, int n, bool from_above,
                      pl_series* out) {
  if (pl_is_poison(e) || pl_is_poison(at) || n < 1) return false;
  bool infinite = pl_kind_of(t->pool, at) == PL_INFINITY;
  for (int k = 0; k < PL_SERIES_TRIES; k++) {
    int terms = n + 1 + k * (n + 3);
    if (terms > PL_MAX_SERIES) terms = PL_MAX_SERIES;
    pl_expansion s = {.t = t, .p = t->pool, .x = x, .at = at, .infinite = infinite, .n = terms};
    s.from_above = from_above || infinite;
    s.known = pl_map_make(t->arena);
    const pl_series* r = expand_node(&s, e);
    bool vanishes = !s.failed && all_zero(&s, r) && !r->zero;
    if (vanishes && pl_alg_is_zero(t, e) == PL_YES) vanishes = false;
    if (!s.failed && !vanishes && r->n >= n) {
      *out = *r;
      return true;
    }
    if (terms == PL_MAX_SERIES) return false;
  }
  return false;
}

bool pl_alg_series(pl_tower* t, pl_expr e, pl_symbol x, pl_expr at, int n, int* lead,
                   pl_expr* coefficient) {
  pl_series s;
  if (n > PL_MAX_SERIES || !expand_to(t, e, x, at, n, false, &s)) return false;
  *lead = s.lead;
  memcpy(coefficient, s.c, (size_t)n * sizeof *coefficient);
  return true;
}

pl_expr pl_alg_limit(pl_tower* t, pl_expr e, pl_symbol x, pl_expr to) {
  pl_series s;
  if (!expand_to(t, e, x, to, 1, true, &s)) return pl_poison();
  if (s.lead > 0 || pl_is_zero_node(t->pool, s.c[0])) return pl_int(t->pool, 0);
  if (s.lead == 0) return s.c[0];
  int sign = 0;
  if (pl_alg_sign(t, s.c[0], false, &sign) != PL_YES || sign == 0) return pl_poison();
  return sign > 0 ? pl_infinity(t->pool) : pl_neg(t->pool, pl_infinity(t->pool));
}
