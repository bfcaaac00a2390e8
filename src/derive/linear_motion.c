// linear_motion: the motion of several generalized coordinates whose equations are linear with constant coefficients,
//   M q'' + C q' + K q = c,
// by the Laplace transform:  (s² M + s C + K) Q(s) = c/s + M (s q0 + v0) + C q0.  Each Q_i(s) is a fraction whose denominator
// is even in s when nothing is damped; with σ = s² it falls into partial fractions
//   1/(s² - σ_k) -> sin, sinh,   s/(s² - σ_k) -> cos, cosh,   1/s^n -> t^(n-1)/(n-1)!            [Doetsch 1974, ch. 13]
#include "derive/derive_impl.h"

enum { max_size = 5, max_degree = 24 };

typedef struct pl_transform {   // of one coordinate: (even(σ) + s odd(σ)) / (σ^zeros rest(σ))
  pl_expr even, odd, rest;
  int zeros;
} pl_transform;

static pl_symbol helper(pl_analysis* d, const char* name) {
  pl_symbol_info info = {.name = name, .ascii = pl_format(d->arena, "laplace_%s", name), .role = PL_R_LOCAL, .class = PL_C_OTHER};
  return pl_symbol_make(d->pool, &info);
}

static bool constant(pl_analysis* d, pl_expr e) {
  return !pl_is_poison(e) && !pl_has_coordinates(d, e) && !pl_has_symbol(d->pool, e, pl_time(d->pool));
}

// The transformed system A Q = b; false when an equation is not linear with constant coefficients.
static bool transform_system(pl_analysis* d, pl_expr s, pl_expr* A, pl_expr* b) {
  pl_pool* p = d->pool;
  int n = d->gen.n;
  pl_replace* rest = PL_ARRAY(d->arena, pl_replace, 3 * n);
  for (int j = 0; j < n; j++) {
    const pl_variable* c = &d->q.at[d->gen.at[j]];
    rest[3 * j] = (pl_replace){c->q, pl_int(p, 0)};
    rest[3 * j + 1] = (pl_replace){c->v, pl_int(p, 0)};
    rest[3 * j + 2] = (pl_replace){c->a, pl_int(p, 0)};
  }
  for (int i = 0; i < n; i++) {
    pl_expr f = pl_second_kind(d, d->gen.at[i]);
    pl_expr c = pl_neg(p, pl_subst(p, f, rest, 3 * n));
    b[i] = pl_div(p, c, s);
    if (!constant(d, c)) return false;
    for (int j = 0; j < n; j++) {
      const pl_variable* q = &d->q.at[d->gen.at[j]];
      pl_expr M = pl_alg_normal(d->tower, pl_diff(p, f, q->a)), C = pl_alg_normal(d->tower, pl_diff(p, f, q->v));
      pl_expr K = pl_alg_normal(d->tower, pl_diff(p, f, q->q));
      if (!constant(d, M) || !constant(d, C) || !constant(d, K)) return false;
      pl_expr q0 = pl_sym(p, pl_symbol_start(p, q->q)), v0 = pl_sym(p, pl_symbol_start(p, q->v));
      A[i * n + j] = pl_add_n(p, (pl_expr[]){pl_mul(p, M, pl_square(p, s)), pl_mul(p, C, s), K}, 3);
      pl_expr kick = pl_mul(p, M, pl_add(p, pl_mul(p, s, q0), v0));
      b[i] = pl_add_n(p, (pl_expr[]){b[i], kick, pl_mul(p, C, q0)}, 3);
    }
  }
  return true;
}

// Coefficients c[0], c[2], ... (from 0) or c[1], c[3], ... (from 1) as a polynomial in σ.
static pl_expr half_of(pl_analysis* d, const pl_expr* c, int degree, int from, pl_expr sigma) {
  pl_expr sum = pl_int(d->pool, 0);
  for (int k = from; k <= degree; k += 2) {
    sum = pl_add(d->pool, sum, pl_mul(d->pool, c[k], pl_pow_int(d->pool, sigma, k / 2)));
  }
  return sum;
}

// Splits Q(s) into even and odd parts over a denominator in σ; false when the denominator is not even (damping).
static bool split_transform(pl_analysis* d, pl_expr Q, pl_symbol s, pl_expr sigma, pl_transform* out) {
  pl_expr num, den, a[max_degree + 2], b[max_degree + 2];
  pl_alg_fraction(d->tower, Q, &num, &den);
  int na = pl_alg_coefficients(d->tower, num, s, a, max_degree), nb = pl_alg_coefficients(d->tower, den, s, b, max_degree);
  if (na < 0 || nb < 0) return false;
  if (nb % 2) {   // s times an even polynomial: multiply both by s
    for (int k = na; k >= 0; k--) a[k + 1] = a[k];
    for (int k = nb; k >= 0; k--) b[k + 1] = b[k];
    a[0] = b[0] = pl_int(d->pool, 0);
    na++;
    nb++;
  }
  for (int k = 1; k <= nb; k += 2) {
    if (!pl_is_zero_node(d->pool, b[k])) return false;
  }
  out->zeros = 0;
  while (2 * out->zeros < nb && pl_is_zero_node(d->pool, b[2 * out->zeros])) out->zeros++;
  out->even = half_of(d, a, na, 0, sigma);
  out->odd = half_of(d, a, na, 1, sigma);
  out->rest = half_of(d, b + 2 * out->zeros, nb - 2 * out->zeros, 0, sigma);
  return true;
}

static pl_expr factorial(pl_analysis* d, int n) {
  long f = 1;
  for (int k = 2; k <= n; k++) f *= k;
  return pl_int(d->pool, f);
}

// The part at σ = 0: c/s^n -> c t^(n-1)/(n-1)!
static bool powers_of_time(pl_analysis* d, pl_expr part, const pl_transform* q, bool odd, pl_symbol sigma, pl_expr t, pl_expr* sum) {
  pl_expr c[max_degree];
  int lead = 0;
  if (q->zeros == 0 || pl_is_zero_node(d->pool, part)) return true;
  if (!pl_alg_series(d->tower, pl_div(d->pool, part, q->rest), sigma, pl_int(d->pool, 0), q->zeros, &lead, c)) return false;
  for (int k = 0; k < q->zeros; k++) {
    int power = 2 * (q->zeros - lead - k) - (odd ? 1 : 0);   // 1/s^power
    if (power < 1 || pl_is_zero_node(d->pool, c[k])) continue;
    *sum = pl_add(d->pool, *sum, pl_div(d->pool, pl_mul(d->pool, c[k], pl_pow_int(d->pool, t, power - 1)), factorial(d, power - 1)));
  }
  return true;
}

// The part at a simple root σ_k: residues of even/(σ^zeros rest) and odd/(...).
static bool swing(pl_analysis* d, const pl_transform* q, pl_symbol sigma, pl_expr root, pl_expr t, pl_expr* sum) {
  pl_pool* p = d->pool;
  int sign = pl_sign_at_numbers(d, root);
  if (sign == 0) return false;
  pl_expr slope = pl_mul(p, pl_pow_int(p, pl_sym(p, sigma), q->zeros), pl_diff(p, q->rest, sigma));
  pl_expr even = pl_alg_normal(d->tower, pl_subst1(p, pl_div(p, q->even, slope), sigma, root));
  pl_expr odd = pl_alg_normal(d->tower, pl_subst1(p, pl_div(p, q->odd, slope), sigma, root));
  pl_expr w = pl_alg_normal(d->tower, pl_sqrt(p, sign > 0 ? root : pl_neg(p, root)));
  if (pl_is_poison(even) || pl_is_poison(odd) || pl_is_poison(w)) return false;
  pl_expr wt = pl_mul(p, w, t);
  pl_expr first = pl_div(p, pl_mul(p, even, pl_call(p, sign > 0 ? PL_SINH : PL_SIN, wt)), w);
  *sum = pl_add_n(p, (pl_expr[]){*sum, first, pl_mul(p, odd, pl_call(p, sign > 0 ? PL_COSH : PL_COS, wt))}, 3);
  return true;
}

static pl_expr back(pl_analysis* d, const pl_transform* q, pl_symbol sigma) {
  pl_expr t = pl_sym(d->pool, pl_time(d->pool)), sum = pl_int(d->pool, 0), c[max_degree + 1];
  if (!powers_of_time(d, q->even, q, false, sigma, t, &sum) || !powers_of_time(d, q->odd, q, true, sigma, t, &sum)) return pl_poison();
  int degree = pl_alg_coefficients(d->tower, q->rest, sigma, c, max_degree);
  if (degree == 0) return sum;
  pl_root root[max_degree];
  bool complete = false;
  int n = pl_alg_roots(d->tower, q->rest, sigma, root, max_degree, &complete);
  if (!complete || n != degree) return pl_poison();   // multiple or not found
  for (int k = 0; k < n; k++) {
    if (!swing(d, q, sigma, root[k].value, t, &sum)) return pl_poison();
  }
  return sum;
}

static void explain_transform(pl_analysis* d, int i, pl_expr Q, const pl_transform* q, pl_symbol sigma) {
  pl_root root[max_degree];
  bool complete = false;
  int n = pl_alg_roots(d->tower, q->rest, sigma, root, max_degree, &complete);
  pl_why_transform(d, i, pl_alg_normal(d->tower, Q), root, n > 0 ? n : 0);
}

static pl_expr motion(pl_analysis* d, int i, bool explain) {
  int n = d->gen.n, place = -1;
  for (int k = 0; k < n; k++) {
    if (d->gen.at[k] == i) place = k;
  }
  if (!d->reduced || place < 0 || n > max_size) return pl_poison();
  pl_symbol s = helper(d, "s"), sigma = helper(d, "σ");
  pl_expr A[max_size * max_size], b[max_size], Q[max_size];
  if (!transform_system(d, pl_sym(d->pool, s), A, b)) return pl_poison();
  if (pl_alg_solve(d->tower, n, A, b, Q, 20000) != PL_YES) return pl_poison();
  pl_transform q;
  if (!split_transform(d, Q[place], s, pl_sym(d->pool, sigma), &q)) return pl_poison();
  if (explain) explain_transform(d, i, Q[place], &q, sigma);
  return back(d, &q, sigma);
}

// Coordinates of closed loops are no linear functions.
pl_expr pl_linear_motion(pl_analysis* d, int i) { return d->loops.n > 0 ? pl_poison() : motion(d, i, false); }

void pl_why_linear_motion(pl_analysis* d, int i) { motion(d, i, true); }
