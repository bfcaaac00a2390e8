// laplace: functions of time and their transforms, both ways, for linear equations with constant
// coefficients.
//
// There: sums of c t^n e^(a t) times cos(b t + f) or sin(b t + f). Back: rational functions whose
// denominator has factors of
// degree one, two, or four without odd powers, by partial fractions; a pair of poles stays
// together,
//   (α s + κ)/q,   q = s² + β s + γ,   α s + κ = N/R modulo q  for N/(R q),
// so that complex numbers never show.                                         [Doetsch1974, ch. 13]
#include "mechanics/mechanics.h"

enum { max_degree = 24, max_factors = 16, max_terms = 64 };

static pl_expr mul3(pl_pool* p, pl_expr a, pl_expr b, pl_expr c) {
  return pl_mul_n(p, (pl_expr[]){a, b, c}, 3);
}
static pl_expr tidy(pl_analysis* d, pl_expr e) { return pl_alg_normal(d->tower, e); }

static pl_expr factorial(pl_analysis* d, int n) {
  long f = 1;
  for (int k = 2; k <= n; k++) f *= k;
  return pl_int(d->pool, f);
}

// ------------------------------------------------------------------------------------------- there
// e = slope t + at_zero with constants.
static bool linear_in_time(pl_analysis* d, pl_expr e, pl_expr* slope, pl_expr* at_zero) {
  pl_expr c[2];
  int n = pl_alg_coefficients(d->tower, e, pl_time(d->pool), c, 1);
  if (n < 0) return false;
  *at_zero = c[0];
  *slope = n == 1 ? c[1] : pl_int(d->pool, 0);
  return true;
}

typedef struct pl_wave {  // c t^power e^(growth t) wave(rate t + phase)
  pl_expr c, growth, rate, phase;
  int power;
  pl_function wave;  // PL_SIN or PL_COS
  bool waves;
} pl_wave;

static bool take_factor(pl_analysis* d, pl_expr f, pl_wave* w) {
  pl_pool* p = d->pool;
  pl_symbol t = pl_time(p);
  pl_expr slope, at_zero;
  long n;
  if (!pl_has_symbol(p, f, t)) {
    w->c = pl_mul(p, w->c, f);
    return true;
  }
  pl_kind kind = pl_kind_of(p, f);
  if (kind == PL_SYMBOL) {
    w->power++;
    return true;
  }
  if (kind == PL_POW && pl_kind_of(p, pl_arg(p, f, 0)) == PL_SYMBOL
      && pl_is_int(p, pl_arg(p, f, 1), &n) && n > 0 && n <= 6) {
    w->power += (int)n;
    return true;
  }
  if (kind != PL_CALL || !linear_in_time(d, pl_arg(p, f, 0), &slope, &at_zero)) return false;
  pl_function function = pl_function_of(p, f);
  if (function == PL_EXP) {
    w->growth = pl_add(p, w->growth, slope);
    w->c = pl_mul(p, w->c, pl_call(p, PL_EXP, at_zero));
    return true;
  }
  if (w->waves || (function != PL_SIN && function != PL_COS)) return false;
  w->waves = true;
  w->wave = function;
  w->rate = slope;
  w->phase = at_zero;
  return true;
}

static pl_expr transform_of(pl_analysis* d, const pl_wave* w, pl_symbol s) {
  pl_pool* p = d->pool;
  pl_expr shifted = pl_sub(p, pl_sym(p, s), w->growth), F = pl_div(p, pl_int(p, 1), shifted);
  if (w->waves) {
    pl_expr c = pl_call(p, PL_COS, w->phase), z = pl_call(p, PL_SIN, w->phase);
    pl_expr top = w->wave == PL_COS ? pl_sub(p, pl_mul(p, shifted, c), pl_mul(p, w->rate, z))
                                    : pl_add(p, pl_mul(p, shifted, z), pl_mul(p, w->rate, c));
    F = pl_div(p, top, pl_add(p, pl_square(p, shifted), pl_square(p, w->rate)));
  }
  for (int k = 0; k < w->power; k++) F = pl_neg(p, pl_diff(p, F, s));
  return pl_mul(p, w->c, F);
}

static pl_expr transform_term(pl_analysis* d, pl_expr term, pl_symbol s) {
  pl_pool* p = d->pool;
  pl_expr zero = pl_int(p, 0);
  pl_wave w = {.c = pl_int(p, 1), .growth = zero, .rate = zero, .phase = zero};
  bool product = pl_kind_of(p, term) == PL_MUL;
  int n = product ? pl_n_args(p, term) : 1;
  for (int k = 0; k < n; k++)
    if (!take_factor(d, product ? pl_arg(p, term, k) : term, &w)) return pl_poison();
  return transform_of(d, &w, s);
}

// The sum with products over sums multiplied out, as far as time stands in them.
static pl_expr transform_sum(pl_analysis* d, pl_expr f, pl_symbol s) {
  pl_pool* p = d->pool;
  bool is_sum = pl_kind_of(p, f) == PL_ADD;
  int n = is_sum ? pl_n_args(p, f) : 1;
  pl_expr sum = pl_int(p, 0);
  if (n > max_terms) return pl_poison();
  for (int k = 0; k < n; k++) {
    pl_expr term = transform_term(d, is_sum ? pl_arg(p, f, k) : f, s);
    if (pl_is_poison(term)) return term;
    sum = pl_add(p, sum, term);
  }
  return sum;
}

pl_expr pl_laplace(pl_analysis* d, pl_expr f, pl_symbol s) {
  pl_expr F = transform_sum(d, f, s);
  if (!pl_is_poison(F)) return F;
  pl_expr num, den;
  pl_alg_fraction(d->tower, f, &num, &den);  // multiplied out
  if (pl_has_symbol(d->pool, den, pl_time(d->pool))) return pl_poison();
  F = transform_sum(d, num, s);
  return pl_is_poison(F) ? F : pl_div(d->pool, F, den);
}

// ------------------------------------------------------------------------------ modulo a quadratic
typedef struct pl_pair {
  pl_expr beta, gamma;
} pl_pair;  // q = s² + β s + γ
typedef struct pl_residue {
  pl_expr alpha, kappa;
} pl_residue;  // α s + κ

// A polynomial in s modulo q, by Horner's rule.
static bool residue_of(pl_analysis* d, pl_expr e, pl_symbol s, pl_pair q, pl_residue* out) {
  pl_pool* p = d->pool;
  pl_expr c[max_degree + 1];
  int n = pl_alg_coefficients(d->tower, e, s, c, max_degree);
  if (n < 0) return false;
  *out = (pl_residue){pl_int(p, 0), pl_int(p, 0)};
  for (int k = n; k >= 0; k--) {  // (α s + κ) s + c = (κ - α β) s + (c - α γ)
    pl_expr alpha = pl_sub(p, out->kappa, pl_mul(p, out->alpha, q.beta)),
            kappa = pl_sub(p, c[k], pl_mul(p, out->alpha, q.gamma));
    *out = (pl_residue){tidy(d, alpha), tidy(d, kappa)};
  }
  return true;
}

// (α s + κ) (b s + c) = a s + e modulo q, for α and κ.
static bool divide_residues(pl_analysis* d, pl_residue a, pl_residue b, pl_pair q,
                            pl_residue* out) {
  pl_pool* p = d->pool;
  pl_expr A[4] = {pl_sub(p, b.kappa, pl_mul(p, b.alpha, q.beta)), b.alpha,
                  pl_neg(p, pl_mul(p, b.alpha, q.gamma)), b.kappa};
  pl_expr right[2] = {a.alpha, a.kappa}, x[2];
  if (pl_alg_solve(d->tower, 2, A, right, x, 20000) != PL_YES) return false;
  *out = (pl_residue){x[0], x[1]};
  return true;
}

// -------------------------------------------------------------------------------------------- back
typedef struct pl_partial {  // F = num/(prod of base^power)
  pl_expr F, num;
  pl_expr base[max_factors];
  int power[max_factors], n;
  pl_symbol s;
  pl_expr t, sum;
  pl_laplace_poles* poles;  // what is told of them; or NULL
} pl_partial;

static bool note_pole(pl_analysis* d, pl_partial* f, pl_pole_kind kind, pl_expr value,
                      pl_expr part) {
  pl_laplace_poles* poles = f->poles;
  f->sum = pl_add(d->pool, f->sum, part);
  if (!poles) return true;
  if (poles->n == PL_MAX_POLES) return false;
  poles->at[poles->n++] = (pl_laplace_pole){.kind = kind, .s = f->s, .value = value, .part = part};
  return true;
}

static bool split(pl_analysis* d, pl_partial* f) {
  pl_factor factor[max_factors];
  pl_expr unit;
  int n = pl_alg_factors(d->tower, f->F, factor, max_factors, &unit);
  if (n >= max_factors) return false;
  f->num = f->F;
  for (int k = 0; k < n; k++) {
    if (factor[k].power >= 0 || !pl_has_symbol(d->pool, factor[k].base, f->s)) continue;
    f->base[f->n] = factor[k].base;
    f->power[f->n++] = -factor[k].power;
    f->num = pl_mul(d->pool, f->num, pl_pow_int(d->pool, factor[k].base, -factor[k].power));
  }
  f->num = tidy(d, f->num);
  return true;
}

static pl_expr all_but(pl_analysis* d, const pl_partial* f, int which) {
  pl_expr product = pl_int(d->pool, 1);
  for (int k = 0; k < f->n; k++)
    if (k != which)
      product = pl_mul(d->pool, product, pl_pow_int(d->pool, f->base[k], f->power[k]));
  return product;
}

// A real pole r of any order: c/(s - r)^n -> c t^(n-1) e^(r t)/(n-1)!
static bool real_pole(pl_analysis* d, pl_partial* f, int which, pl_expr root) {
  pl_pool* p = d->pool;
  enum { most = 8 };
  pl_expr c[most], part = pl_int(p, 0);
  int lead = 0, order = f->power[which];
  if (order > most || !pl_alg_series(d->tower, f->F, f->s, root, order, &lead, c)) return false;
  pl_expr grown = pl_is_zero_node(p, root) ? pl_int(p, 1)
                                           : pl_call(p, PL_EXP, pl_mul(p, root, f->t));
  for (int k = 0; k < order; k++) {
    int n = -(lead + k);
    if (n < 1 || pl_is_zero_node(p, c[k])) continue;
    part = pl_add(p, part,
                  pl_div(p, mul3(p, c[k], pl_pow_int(p, f->t, n - 1), grown), factorial(d, n - 1)));
  }
  return note_pole(d, f, PL_POLE_REAL, root, part);
}

// (α s + κ)/q^order in time, order 1 or 2; q = (s + δ)² ± w². Where nothing tells whether the
// damping is weak, it is taken to be.
static bool in_time(pl_analysis* d, const pl_partial* f, pl_pair q, pl_residue r, int order,
                    pl_expr* sum) {
  pl_pool* p = d->pool;
  pl_expr delta = pl_div(p, q.beta, pl_int(p, 2)),
          square = tidy(d, pl_sub(p, q.gamma, pl_square(p, delta)));
  int sign = pl_sign_or_positive(d, square);
  if (sign == 0) {  // for the given numbers the pair is a double pole
    pl_find_special(d, square);
    return false;
  }
  pl_expr w = tidy(d, pl_sqrt(p, sign > 0 ? square : pl_neg(p, square)));
  if (pl_is_poison(w)) return false;
  pl_expr wt = pl_mul(p, w, f->t), odd = pl_call(p, sign > 0 ? PL_SIN : PL_SINH, wt),
          even = pl_call(p, sign > 0 ? PL_COS : PL_COSH, wt);
  pl_expr along = r.alpha, across = tidy(d, pl_sub(p, r.kappa, pl_mul(p, r.alpha, delta))), swing;
  if (order == 1) {
    swing = pl_add(p, pl_mul(p, along, even), pl_mul(p, tidy(d, pl_div(p, across, w)), odd));
  } else {  // (s + δ)/q² -> t sin(w t)/(2 w),  1/q² -> (sin(w t) - w t cos(w t))/(2 w³)
    pl_expr two_w = pl_mul(p, pl_int(p, 2), w), grows = mul3(p, pl_div(p, along, two_w), f->t, odd);
    pl_expr rest = pl_sub(p, odd, pl_mul(p, wt, even));
    if (sign < 0) rest = pl_neg(p, rest);
    swing = pl_add(p, grows, pl_mul(p, pl_div(p, across, pl_mul(p, two_w, pl_square(p, w))), rest));
  }
  if (!pl_is_zero_node(p, delta))
    swing = pl_mul(p, pl_call(p, PL_EXP, pl_neg(p, pl_mul(p, delta, f->t))), swing);
  *sum = pl_add(p, *sum, swing);
  return true;
}

static pl_expr quadratic(pl_analysis* d, pl_pair q, pl_symbol symbol) {
  pl_pool* p = d->pool;
  pl_expr s = pl_sym(p, symbol);
  return pl_add_n(p, (pl_expr[]){pl_square(p, s), pl_mul(p, q.beta, s), q.gamma}, 3);
}

// A pair of poles: F = N/(R q^order).
static bool pair_of_poles(pl_analysis* d, pl_partial* f, pl_pair q, pl_expr R, int order) {
  pl_pool* p = d->pool;
  pl_expr N = f->num, part = pl_int(p, 0);
  pl_residue below, top, r;
  if (order > 2 || !residue_of(d, R, f->s, q, &below)) return false;
  for (int left = order; left > 0; left--) {
    if (!residue_of(d, N, f->s, q, &top) || !divide_residues(d, top, below, q, &r)
        || !in_time(d, f, q, r, left, &part))
      return false;
    if (left == 1) break;
    pl_expr taken = pl_mul(p, pl_add(p, pl_mul(p, r.alpha, pl_sym(p, f->s)), r.kappa), R);
    N = tidy(d, pl_div(p, pl_sub(p, N, taken), quadratic(d, q, f->s)));
  }
  if (pl_is_zero_node(p, q.beta)) return note_pole(d, f, PL_POLE_SQUARE, pl_neg(p, q.gamma), part);
  return note_pole(d, f, PL_POLE_QUADRATIC, quadratic(d, q, f->s), part);
}

// a s⁴ + b s² + c = a (s² - σ1) (s² - σ2)
static bool two_pairs(pl_analysis* d, pl_partial* f, int which, const pl_expr* c) {
  pl_pool* p = d->pool;
  pl_symbol_info info = {
      .name = "σ", .ascii = "laplace_square", .role = PL_R_LOCAL, .class = PL_C_OTHER};
  pl_symbol sigma = pl_symbol_make(p, &info);
  pl_expr x = pl_sym(p, sigma),
          P = pl_add_n(p, (pl_expr[]){mul3(p, c[4], x, x), pl_mul(p, c[2], x), c[0]}, 3);
  pl_root root[4];
  bool complete = false;
  int n = pl_alg_roots(d->tower, P, sigma, root, 4, &complete);
  if (!complete || n != 2 || f->power[which] != 1) return false;
  pl_expr slope = pl_diff(p, P, sigma), rest = all_but(d, f, which);
  for (int k = 0; k < 2; k++) {
    pl_pair q = {pl_int(p, 0), tidy(d, pl_neg(p, root[k].value))};
    if (!pair_of_poles(d, f, q, pl_mul(p, rest, pl_subst1(p, slope, sigma, root[k].value)), 1))
      return false;
  }
  return true;
}

static bool part_of(pl_analysis* d, pl_partial* f, int which) {
  pl_pool* p = d->pool;
  pl_expr c[5];
  int degree = pl_alg_coefficients(d->tower, f->base[which], f->s, c, 4);
  if (degree == 1) return real_pole(d, f, which, tidy(d, pl_neg(p, pl_div(p, c[0], c[1]))));
  if (degree == 2) {
    pl_pair q = {tidy(d, pl_div(p, c[1], c[2])), tidy(d, pl_div(p, c[0], c[2]))};
    return pair_of_poles(d, f, q,
                         pl_mul(p, all_but(d, f, which), pl_pow_int(p, c[2], f->power[which])),
                         f->power[which]);
  }
  bool even = degree == 4 && pl_is_zero_node(p, c[1]) && pl_is_zero_node(p, c[3]);
  return even && two_pairs(d, f, which, c);
}

pl_expr pl_laplace_back(pl_analysis* d, pl_expr F, pl_symbol s, pl_laplace_poles* poles) {
  pl_partial f = {.F = tidy(d, F),
                  .s = s,
                  .t = pl_sym(d->pool, pl_time(d->pool)),
                  .sum = pl_int(d->pool, 0),
                  .poles = poles};
  if (pl_is_poison(f.F) || !split(d, &f)) return pl_poison();
  for (int k = 0; k < f.n; k++)
    if (!part_of(d, &f, k)) return pl_poison();
  return f.sum;
}
