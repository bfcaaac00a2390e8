// Expressions of Euler angles as expressions of the quaternion of the same attitude, where that is
// possible without a denominator: sin ϑ sin φ becomes 2 (q1 q3 + q0 q2), φ' cos ϑ + ψ' the third
// component of the angular velocity, and so on.
//
// A polynomial in sines, cosines and rates is written as a sum of e^(i (a φ + b ψ)) f(ϑ) ω^d, rates
// replaced by the angular velocity, which divides by powers of sin ϑ. With A = a + b, B = a - b,
// z_1 = q0 + i q3 = cos(ϑ/2) e^(i (φ + ψ)/2) and z_2 = q1 + i q2 = sin(ϑ/2) e^(i (φ - ψ)/2),
//
//   e^(i (a φ + b ψ)) cos^|A|(ϑ/2) sin^|B|(ϑ/2) = z_1^A z_2^B        (conjugates for negative A, B)
//
// so the expression is smooth at every attitude exactly when each f is that product of half angles
// times a polynomial in cos ϑ = q0² + q3² - q1² - q2². As Laurent polynomials in u = e^(i ϑ) that
// is a division by (u - 1)^n (u + 1)^m without remainder, and a quotient that reads the same from
// both ends.
#include "smooth.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_TERMS = 1500, MOST_PRODUCTS = 60000, MOST_POWER = 12 };

typedef struct complex_expr {
  pl_expr re, im;
} complex_expr;

// coefficient e^(i (a φ + c ϑ + b ψ)) times powers of the rates, or of the components of ω.
typedef struct term {
  int a, c, b, d[3];
  complex_expr k;
} term;

typedef PL_VEC(term) terms;

typedef struct smoother {
  pl_arena* arena;
  pl_pool* p;
  const pl_triple* t;
  pl_mod_point* point[2];  // where zeros are recognised
  pl_map* talks;           // see speaks
  // id of an expression -> id of what it became + 1, 1: it is not smooth
  pl_map* done;
} smoother;

static pl_expr rewrite(smoother* s, pl_expr e);

// ------------------------------------------------------------------------------------------- zeros
static bool vanishes(const smoother* s, pl_expr e) {
  if (pl_is_zero_node(s->p, e)) return true;
  if (pl_is_number(s->p, e)) return false;
  for (int i = 0; i < 2; i++) {
    bool ok;
    uint64_t residue = pl_eval_mod(s->point[i], e, &ok);
    if (!ok || residue != 0) return false;
  }
  return true;
}

static complex_expr clean(const smoother* s, complex_expr k) {
  if (vanishes(s, k.re)) k.re = pl_int(s->p, 0);
  if (vanishes(s, k.im)) k.im = pl_int(s->p, 0);
  return k;
}

static bool is_zero(const smoother* s, complex_expr k) {
  return pl_is_zero_node(s->p, k.re) && pl_is_zero_node(s->p, k.im);
}

static complex_expr plus(const smoother* s, complex_expr x, complex_expr y) {
  return (complex_expr){pl_add(s->p, x.re, y.re), pl_add(s->p, x.im, y.im)};
}

static complex_expr times(const smoother* s, complex_expr x, complex_expr y) {
  return (complex_expr){pl_sub(s->p, pl_mul(s->p, x.re, y.re), pl_mul(s->p, x.im, y.im)),
                        pl_add(s->p, pl_mul(s->p, x.re, y.im), pl_mul(s->p, x.im, y.re))};
}

static complex_expr number(const smoother* s, pl_expr re, pl_expr im) {
  (void)s;
  return (complex_expr){re, im};
}

static complex_expr real(const smoother* s, pl_expr x) { return number(s, x, pl_int(s->p, 0)); }

// ----------------------------------------------------------------------------------- sums of terms
static bool add_term(smoother* s, terms* sum, term x) {
  for (int i = 0; i < sum->n; i++) {
    term* y = &sum->at[i];
    if (x.a != y->a || x.c != y->c || x.b != y->b || memcmp(x.d, y->d, sizeof x.d) != 0) continue;
    y->k = plus(s, x.k, y->k);
    return true;
  }
  if (sum->n >= MOST_TERMS) return false;
  pl_push(s->arena, *sum, x);
  return true;
}

static bool multiply(smoother* s, const terms* x, const terms* y, terms* out) {
  *out = (terms){0};
  if (x->n * y->n > MOST_PRODUCTS) return false;
  for (int i = 0; i < x->n; i++) {
    for (int j = 0; j < y->n; j++) {
      const term *m = &x->at[i], *n = &y->at[j];
      term z = {m->a + n->a,
                m->c + n->c,
                m->b + n->b,
                {m->d[0] + n->d[0], m->d[1] + n->d[1], m->d[2] + n->d[2]},
                times(s, m->k, n->k)};
      if (!add_term(s, out, z)) return false;
    }
  }
  return true;
}

static bool power(smoother* s, const terms* x, int n, terms* out) {
  *out = (terms){0};
  add_term(s, out, (term){.k = real(s, pl_int(s->p, 1))});
  for (int i = 0; i < n; i++) {
    terms next;
    if (!multiply(s, out, x, &next)) return false;
    *out = next;
  }
  return true;
}

// --------------------------------------------------------------------------- reading an expression
// Which of φ', ϑ', ψ' (rate) or φ, ϑ, ψ e is; -1 none.
static int which(const smoother* s, pl_expr e, bool rate) {
  for (int i = 0; i < 3; i++)
    if (pl_same(e, rate ? s->t->rate[i] : s->t->angle[i])) return i;
  return -1;
}

static bool is_of_triple(const pl_triple* t, pl_expr e) {
  for (int i = 0; i < 3; i++)
    if (pl_same(e, t->angle[i]) || pl_same(e, t->rate[i]) || pl_same(e, t->second[i])) return true;
  return false;
}

// Whether e speaks of the angles; talks remembers 1: no, 2: yes.
static bool speaks_of(const pl_pool* p, const pl_triple* t, pl_map* talks, pl_expr e) {
  if (pl_is_poison(e)) return false;
  uint64_t known = pl_map_get(talks, e.id);
  if (known) return known == 2;
  bool yes = is_of_triple(t, e);
  for (int i = 0; i < pl_n_args(p, e) && !yes; i++) yes = speaks_of(p, t, talks, pl_arg(p, e, i));
  pl_map_set(talks, e.id, yes ? 2 : 1);
  return yes;
}

static bool speaks(const smoother* s, pl_expr e) { return speaks_of(s->p, s->t, s->talks, e); }

// n φ + m ϑ + k ψ + rest, with whole n, m, k.
static bool linear(const smoother* s, pl_expr e, int n[3], pl_expr* rest) {
  int i = which(s, e, false);
  long k;
  if (i >= 0) {
    n[i]++;
    return true;
  }
  if (!speaks(s, e)) {
    *rest = pl_add(s->p, *rest, e);
    return true;
  }
  if (pl_kind_of(s->p, e) == PL_ADD) {
    for (int j = 0; j < pl_n_args(s->p, e); j++)
      if (!linear(s, pl_arg(s->p, e, j), n, rest)) return false;
    return true;
  }
  bool product = pl_kind_of(s->p, e) == PL_MUL && pl_n_args(s->p, e) == 2
                 && pl_is_int(s->p, pl_arg(s->p, e, 0), &k);
  i = product ? which(s, pl_arg(s->p, e, 1), false) : -1;
  if (i < 0 || labs(k) > MOST_POWER) return false;
  n[i] += (int)k;
  return true;
}

// cos X = (e^(iX) + e^(-iX))/2, sin X = (e^(iX) - e^(-iX))/(2i).
static bool read_sine(smoother* s, pl_expr e, terms* out) {
  int n[3] = {0};
  pl_expr rest = pl_int(s->p, 0), half = pl_ratio(s->p, 1, 2);
  bool cosine = pl_function_of(s->p, e) == PL_COS;
  if (!linear(s, pl_arg(s->p, e, 0), n, &rest)) return false;
  pl_expr c = pl_mul(s->p, half, pl_call(s->p, PL_COS, rest)),
          d = pl_mul(s->p, half, pl_call(s->p, PL_SIN, rest));
  complex_expr plus_k = cosine ? number(s, c, d) : number(s, d, pl_neg(s->p, c));
  complex_expr minus_k = number(s, plus_k.re, pl_neg(s->p, plus_k.im));
  return add_term(s, out, (term){.a = n[0], .c = n[1], .b = n[2], .k = plus_k})
         && add_term(s, out, (term){.a = -n[0], .c = -n[1], .b = -n[2], .k = minus_k});
}

static bool read(smoother* s, pl_expr e, terms* out);

static bool read_product(smoother* s, pl_expr e, terms* out) {
  terms product = {0};
  add_term(s, &product, (term){.k = real(s, pl_int(s->p, 1))});
  for (int i = 0; i < pl_n_args(s->p, e); i++) {
    terms factor = {0}, next;
    if (!read(s, pl_arg(s->p, e, i), &factor) || !multiply(s, &product, &factor, &next))
      return false;
    product = next;
  }
  *out = product;
  return true;
}

// Adds e to out as a polynomial; false when it is none.
static bool read(smoother* s, pl_expr e, terms* out) {
  long n = 0;
  int rate = which(s, e, true);
  pl_kind kind = pl_kind_of(s->p, e);
  if (rate >= 0) {
    term x = {.k = real(s, pl_int(s->p, 1))};
    x.d[rate] = 1;
    return add_term(s, out, x);
  }
  if (!speaks(s, e)) return add_term(s, out, (term){.k = real(s, e)});
  terms part = {0}, all = {0};
  if (kind == PL_ADD) {
    for (int i = 0; i < pl_n_args(s->p, e); i++)
      if (!read(s, pl_arg(s->p, e, i), out)) return false;
    return true;
  }
  if (kind == PL_MUL) {
    if (!read_product(s, e, &all)) return false;
  } else if (kind == PL_POW && pl_is_int(s->p, pl_arg(s->p, e, 1), &n) && n > 0
             && n <= MOST_POWER) {
    if (!read(s, pl_arg(s->p, e, 0), &part) || !power(s, &part, (int)n, &all)) return false;
  } else if (kind == PL_CALL
             && (pl_function_of(s->p, e) == PL_COS || pl_function_of(s->p, e) == PL_SIN)) {
    if (!read_sine(s, e, &all)) return false;
  } else {
    // something else is a coefficient when it is smooth itself
    pl_expr smooth = rewrite(s, e);
    return !pl_is_poison(smooth) && add_term(s, out, (term){.k = real(s, smooth)});
  }
  for (int i = 0; i < all.n; i++)
    if (!add_term(s, out, all.at[i])) return false;
  return true;
}

// -------------------------------------------------------------------------------------- rates by ω
// A sum of sines and cosines of one angle times a component of ω: k_i ω_i e^(± i angle)/2 ...
static void add_wave(smoother* s, terms* out, int of, bool cosine, int component, int sign) {
  pl_expr half = pl_ratio(s->p, sign, 2), none = pl_int(s->p, 0);
  for (int way = 1; way >= -1; way -= 2) {
    term x = {.k = cosine ? number(s, half, none)
                          : number(s, none, pl_mul(s->p, pl_int(s->p, -way), half))};
    if (of == 0) x.a = way;
    if (of == 1) x.c = way;
    if (of == 2) x.b = way;
    if (component >= 0) x.d[component] = 1;
    add_term(s, out, x);
  }
}

// The rates times sin ϑ (the nutation: itself) by ω along the body axes or in space:
//   body:   ϑ' = ω1 cos ψ - ω2 sin ψ,  φ' sin ϑ = ω1 sin ψ + ω2 cos ψ,  ψ' = ω3 - φ' cos ϑ
//   space:  ϑ' = ω1 cos φ + ω2 sin φ,  ψ' sin ϑ = ω1 sin φ - ω2 cos φ,  φ' = ω3 - ψ' cos ϑ
static bool rates_by_spin(smoother* s, bool in_space, terms rate[3], terms* sine) {
  int about = in_space ? 0 : 2, sign = in_space ? 1 : -1, far = 2 - about;
  terms cosine = {0}, third = {0}, product;
  add_wave(s, &rate[1], about, true, 0, 1);
  add_wave(s, &rate[1], about, false, 1, sign);
  add_wave(s, &rate[far], about, false, 0, 1);
  add_wave(s, &rate[far], about, true, 1, -sign);
  add_wave(s, sine, 1, false, -1, 1);
  add_wave(s, &cosine, 1, true, -1, -1);
  add_wave(s, &third, 1, false, 2, 1);
  if (!multiply(s, &cosine, &rate[far], &product)) return false;
  for (int i = 0; i < product.n; i++) add_term(s, &third, product.at[i]);
  rate[about] = third;
  return true;
}

// x with rates replaced, times sin^*depth ϑ.
static bool replace_rates(smoother* s, const terms* x, bool in_space, terms* out, int* depth) {
  terms rate[3] = {0}, sine = {0};
  *depth = 0;
  for (int i = 0; i < x->n; i++) {
    int n = x->at[i].d[0] + x->at[i].d[2];
    if (n > *depth) *depth = n;
  }
  if (!rates_by_spin(s, in_space, rate, &sine)) return false;
  for (int i = 0; i < x->n; i++) {
    const term* t = &x->at[i];
    terms product = {0}, factor, next;
    add_term(s, &product, (term){.a = t->a, .c = t->c, .b = t->b, .k = t->k});
    for (int k = 0; k < 4; k++) {
      int n = k < 3 ? t->d[k] : *depth - t->d[0] - t->d[2];
      if (!power(s, k < 3 ? &rate[k] : &sine, n, &factor) || !multiply(s, &product, &factor, &next))
        return false;
      product = next;
    }
    for (int j = 0; j < product.n; j++)
      if (!add_term(s, out, product.at[j])) return false;
  }
  return true;
}

// ---------------------------------------------------------------------------------------- division
enum { MOST_DEGREE = 64 };
// of u, from the lowest power up
typedef struct laurent {
  int lowest, n;
  complex_expr k[2 * MOST_DEGREE + 1];
} laurent;

// Exact division by u - r; false: a remainder is left.
static bool divide(smoother* s, laurent* f, int r) {
  if (f->n == 0) return true;
  complex_expr carry = real(s, pl_int(s->p, 0)), root = real(s, pl_int(s->p, r));
  for (int i = f->n - 1; i >= 0; i--) {
    complex_expr here = clean(s, plus(s, f->k[i], times(s, root, carry)));
    f->k[i] = carry;
    carry = here;
  }
  f->n--;
  return is_zero(s, carry);
}

// f(u) of the terms with these a, b and powers of ω.
static bool collect(smoother* s, const terms* x, const term* like, laurent* f) {
  int low = MOST_DEGREE, high = -MOST_DEGREE;
  *f = (laurent){0};
  for (int i = 0; i < x->n; i++) {
    const term* t = &x->at[i];
    if (t->a != like->a || t->b != like->b || memcmp(t->d, like->d, sizeof t->d) != 0) continue;
    if (t->c < low) low = t->c;
    if (t->c > high) high = t->c;
  }
  if (high < low || low < -MOST_DEGREE || high > MOST_DEGREE) return false;
  f->lowest = low;
  f->n = high - low + 1;
  for (int i = 0; i < f->n; i++) f->k[i] = real(s, pl_int(s->p, 0));
  for (int i = 0; i < x->n; i++) {
    const term* t = &x->at[i];
    if (t->a == like->a && t->b == like->b && memcmp(t->d, like->d, sizeof t->d) == 0)
      f->k[t->c - low] = clean(s, t->k);
  }
  while (f->n > 0 && is_zero(s, f->k[f->n - 1])) f->n--;
  return true;
}

// f / (sin^depth ϑ cos^|A|(ϑ/2) sin^|B|(ϑ/2)) as a Laurent polynomial in u.
static bool quotient(smoother* s, laurent* f, int A, int B, int depth) {
  int m = abs(B) + depth, n = abs(A) + depth;
  for (int i = 0; i < m; i++)
    if (!divide(s, f, 1)) return false;
  for (int i = 0; i < n; i++)
    if (!divide(s, f, -1)) return false;
  // sin(ϑ/2) = (u - 1)/(2 i u^(1/2)), cos(ϑ/2) = (u + 1)/(2 u^(1/2)), sin ϑ = 2 sin(ϑ/2) cos(ϑ/2)
  f->lowest += (m + n) / 2;
  complex_expr scale = real(s, pl_pow_int(s->p, pl_int(s->p, 2), m + n - depth)),
               turn = number(s, pl_int(s->p, 0), pl_int(s->p, 1));
  for (int i = 0; i < m; i++) scale = times(s, scale, turn);
  for (int i = 0; i < f->n; i++) f->k[i] = times(s, f->k[i], scale);
  return true;
}

// --------------------------------------------------------------------------------- writing it down
// sum f_k u^k = f_0 + 2 sum f_k T_k(cos ϑ); false when f is not symmetric.
static bool by_cosine(smoother* s, const laurent* f, complex_expr* out) {
  pl_pool* p = s->p;
  pl_expr x = s->t->cosine, before = pl_int(p, 1), now = x;
  int high = f->lowest + f->n - 1, most = high > -f->lowest ? high : -f->lowest;
  *out = real(s, pl_int(p, 0));
  for (int k = 0; k <= most; k++) {
    complex_expr up = real(s, pl_int(p, 0)), down = up;
    if (k >= f->lowest && k <= high) up = f->k[k - f->lowest];
    if (-k >= f->lowest && -k <= high) down = f->k[-k - f->lowest];
    complex_expr difference = plus(s, up, times(s, real(s, pl_int(p, -1)), down));
    if (!is_zero(s, clean(s, difference))) return false;
    pl_expr T = k == 0 ? pl_int(p, 1) : now;
    *out = plus(s, *out, times(s, clean(s, up), real(s, k == 0 ? T : pl_mul(p, pl_int(p, 2), T))));
    if (k == 0) continue;
    pl_expr next = pl_sub(p, pl_mul(p, pl_int(p, 2), pl_mul(p, x, now)), before);
    before = now;
    now = next;
  }
  return true;
}

static complex_expr power_of_half(smoother* s, pl_expr re, pl_expr im, int n) {
  complex_expr base = number(s, re, n < 0 ? pl_neg(s->p, im) : im), out = real(s, pl_int(s->p, 1));
  for (int i = 0; i < abs(n); i++) out = times(s, out, base);
  return out;
}

static bool seen_before(const terms* x, int i) {
  for (int k = 0; k < i; k++)
    if (x->at[k].a == x->at[i].a && x->at[k].b == x->at[i].b
        && memcmp(x->at[k].d, x->at[i].d, sizeof x->at[i].d) == 0)
      return true;
  return false;
}

static pl_expr write(smoother* s, const terms* x, int depth, const pl_expr spin[3]) {
  pl_pool* p = s->p;
  const pl_expr* q = s->t->q;
  pl_expr sum = pl_int(p, 0);
  for (int i = 0; i < x->n; i++) {
    const term* t = &x->at[i];
    laurent f;
    complex_expr value;
    int A = t->a + t->b, B = t->a - t->b;
    if (seen_before(x, i)) continue;
    if (!collect(s, x, t, &f)) return pl_poison();
    if (f.n == 0) continue;
    if (!quotient(s, &f, A, B, depth) || !by_cosine(s, &f, &value)) return pl_poison();
    value = times(s, value,
                  times(s, power_of_half(s, q[0], q[3], A), power_of_half(s, q[1], q[2], B)));
    pl_expr product = value.re;  // the sum is real
    for (int k = 0; k < 3; k++) product = pl_mul(p, product, pl_pow_int(p, spin[k], t->d[k]));
    sum = pl_add(p, sum, product);
  }
  return sum;
}

static pl_expr shorter(const smoother* s, pl_expr a, pl_expr b) {
  if (pl_is_poison(a) || pl_is_poison(b)) return pl_is_poison(a) ? b : a;
  return pl_op_count(s->p, b) < pl_op_count(s->p, a) ? b : a;
}

// e as a whole; poison when it is not smooth.
static pl_expr expand(smoother* s, pl_expr e) {
  terms x = {0};
  if (!read(s, e, &x)) return pl_poison();
  bool moves = false;
  for (int i = 0; i < x.n; i++) moves |= x.at[i].d[0] + x.at[i].d[1] + x.at[i].d[2] > 0;
  if (!moves) return write(s, &x, 0, s->t->spin[0]);
  pl_expr best = pl_poison();
  for (int in_space = 0; in_space < 2; in_space++) {
    terms y = {0};
    int depth;
    if (replace_rates(s, &x, in_space, &y, &depth))
      best = shorter(s, best, write(s, &y, depth, s->t->spin[in_space]));
  }
  return best;
}

// ------------------------------------------------------------------------------ from the leaves up
// A sum: what is smooth by itself stays as it is written, the rest together.
static pl_expr rewrite_sum(smoother* s, pl_expr e) {
  int n = pl_n_args(s->p, e);
  pl_expr smooth = pl_int(s->p, 0), rest = pl_int(s->p, 0);
  bool none = true;
  for (int i = 0; i < n; i++) {
    pl_expr part = pl_arg(s->p, e, i), better = rewrite(s, part);
    if (pl_is_poison(better)) {
      rest = pl_add(s->p, rest, part);
      none = false;
    } else smooth = pl_add(s->p, smooth, better);
  }
  if (none) return smooth;
  pl_expr others = expand(s, rest);
  return pl_is_poison(others) ? expand(s, e) : pl_add(s->p, smooth, others);
}

static pl_expr rebuild(smoother* s, pl_expr e, const pl_expr* arg, int n) {
  pl_pool* p = s->p;
  switch (pl_kind_of(p, e)) {
    case PL_ADD: return pl_add_n(p, arg, n);
    case PL_MUL: return pl_mul_n(p, arg, n);
    case PL_POW: return pl_pow(p, arg[0], arg[1]);
    case PL_CALL:
      return n == 2 ? pl_call2(p, pl_function_of(p, e), arg[0], arg[1])
                    : pl_call(p, pl_function_of(p, e), arg[0]);
    case PL_IF: return pl_if(p, arg[0], arg[1], arg[2]);
    case PL_SUM: return pl_sum_over(p, pl_symbol_of(p, e), arg[1], arg[2], arg[3]);
    default: return pl_poison();
  }
}

static pl_expr rewrite_node(smoother* s, pl_expr e) {
  pl_kind kind = pl_kind_of(s->p, e);
  if (kind == PL_ADD) return rewrite_sum(s, e);
  int n = pl_n_args(s->p, e);
  pl_expr* arg = PL_ARRAY(s->arena, pl_expr, n + 1);
  bool fine = n > 0 && kind != PL_AT;
  for (int i = kind == PL_SUM ? 1 : 0; fine && i < n; i++) {
    arg[i] = rewrite(s, pl_arg(s->p, e, i));
    fine = !pl_is_poison(arg[i]);
  }
  if (fine) return rebuild(s, e, arg, n);
  bool whole = kind == PL_MUL || (kind == PL_POW && pl_is_int(s->p, pl_arg(s->p, e, 1), NULL))
               || (kind == PL_CALL
                   && (pl_function_of(s->p, e) == PL_COS || pl_function_of(s->p, e) == PL_SIN));
  return whole ? expand(s, e) : pl_poison();
}

static pl_expr rewrite(smoother* s, pl_expr e) {
  uint64_t known = pl_map_get(s->done, e.id);
  if (known) return known == 1 ? pl_poison() : (pl_expr){(uint32_t)(known - 1)};
  pl_map_set(s->done, e.id, 1);  // what needs itself is not smooth
  pl_expr out = speaks(s, e) ? rewrite_node(s, e) : e;
  pl_map_set(s->done, e.id, pl_is_poison(out) ? 1 : (uint64_t)out.id + 1);
  return out;
}

// -------------------------------------------------------------------------------------- the triple
pl_triple pl_triple_make(pl_pool* p, const pl_expr angle[3], const pl_expr q[4]) {
  pl_triple t = {0};
  pl_expr v[4], along = pl_add(p, pl_square(p, q[0]), pl_square(p, q[3])),
                across = pl_add(p, pl_square(p, q[1]), pl_square(p, q[2]));
  t.cosine = pl_sub(p, along, across);
  for (int i = 0; i < 4; i++) {
    t.q[i] = q[i];
    v[i] = pl_dt(p, q[i]);
  }
  for (int i = 0; i < 3; i++) {
    t.angle[i] = angle[i];
    t.rate[i] = pl_dt(p, angle[i]);
    t.second[i] = pl_dt(p, t.rate[i]);
  }
  for (int i = 0; i < 3; i++) {
    int j = 1 + (i + 1) % 3, k = 1 + (i + 2) % 3;
    pl_expr straight = pl_sub(p, pl_mul(p, q[0], v[1 + i]), pl_mul(p, v[0], q[1 + i]));
    pl_expr bent = pl_sub(p, pl_mul(p, q[j], v[k]), pl_mul(p, q[k], v[j]));
    t.spin[0][i] = pl_mul(p, pl_int(p, 2), pl_sub(p, straight, bent));
    t.spin[1][i] = pl_mul(p, pl_int(p, 2), pl_add(p, straight, bent));
  }
  return t;
}

bool pl_triple_in(const pl_pool* p, pl_arena* scratch, const pl_triple* t, pl_expr e) {
  return speaks_of(p, t, pl_map_make(scratch), e);
}

pl_expr pl_smooth(pl_arena* scratch, pl_pool* p, const pl_triple* t, pl_expr e) {
  smoother s = {.arena = scratch,
                .p = p,
                .t = t,
                .talks = pl_map_make(scratch),
                .done = pl_map_make(scratch)};
  for (int i = 0; i < 2; i++) s.point[i] = pl_mod_point_make(scratch, p, 71 + (uint64_t)i);
  return rewrite(&s, e);
}
