// Roots of e = 0 for one symbol. The numerator is factored; each factor is solved by what the
// symbol occurs in:
//   itself             linear, quadratic, biquadratic, a pure power
//   cos u, sin u       polynomial in one of them; A cos u + B sin u + C; quadratic forms
//                      through 2u; u = k x
//   exp u              polynomial in it
//   sqrt, |.|          isolated and squared, the roots of the square verified
//   ln, asin, ...      isolated and inverted, verified
// A root is kept only when it satisfies the equation (or cannot be refuted); a condition that is
// proven is dropped.
#include "algebra/tower.h"

#include <string.h>

enum { PL_MAX_ROOT_DEGREE = 12, PL_MAX_ROOTS = 64, PL_MAX_ROOT_DEPTH = 4, PL_MAX_OCCURRENCES = 8 };

typedef struct pl_occurrence {
  pl_gen_kind kind;
  pl_expr expr;
} pl_occurrence;

typedef struct pl_roots {
  pl_tower* t;
  pl_pool* p;
  pl_symbol x;
  pl_root at[PL_MAX_ROOTS];
  int n;
  bool complete;
  int depth;
} pl_roots;

static void solve_equation(pl_roots* r, pl_expr e);

// ----------------------------------------------------------------------------------- small helpers
static pl_expr normal(pl_roots* r, pl_expr e) { return pl_alg_normal(r->t, e); }

typedef struct pl_proof_job {
  pl_expr e;
  int sign;
} pl_proof_job;

static void proof_body(pl_tower* t, void* data) {
  pl_proof_job* j = data;
  pl_frac f = pl_convert(t, j->e);
  const pl_poly* whole = pl_poly_mul(t, f.num, pl_frac_den(t, f));
  j->sign = pl_poly_sign(t, whole, false, false);
  if (j->sign == PL_SIGN_OPEN && pl_poly_sign(t, whole, true, false) == 1) j->sign = 1;
}

// Proven sign: 1 for >= 0, -1 for < 0, 0 for open.
static int proven(pl_roots* r, pl_expr e) {
  pl_proof_job j = {.e = e, .sign = PL_SIGN_OPEN};
  if (!pl_tower_run(r->t, proof_body, &j) || j.sign == PL_SIGN_OPEN) return 0;
  return j.sign >= 0 ? 1 : -1;
}

static pl_expr both(pl_roots* r, pl_expr a, pl_expr b) {
  if (pl_is_poison(a)) return b;
  if (pl_is_poison(b) || pl_same(a, b)) return a;
  return pl_call2(r->p, PL_MIN, a, b);
}

// Adds a root under a condition (poison: none); a condition that is proven goes, a refuted one
// takes the root along.
static void add_root(pl_roots* r, pl_expr value, pl_expr condition) {
  if (pl_is_poison(value)) {
    r->complete = false;
    return;
  }
  if (!pl_is_poison(condition)) {
    int sign = proven(r, condition);
    if (sign < 0) return;
    if (sign > 0) condition = pl_poison();
  }
  for (int i = 0; i < r->n; i++) {
    if (pl_same(r->at[i].value, value)) return;
  }
  if (r->n == PL_MAX_ROOTS) {
    r->complete = false;
    return;
  }
  r->at[r->n++] = (pl_root){value, condition};
}

// ------------------------------------------------------------------------------- polynomials in an
// unknown Roots of sum c_k y^k, as values of y.
typedef struct pl_values {
  pl_expr value[PL_MAX_ROOT_DEGREE], condition[PL_MAX_ROOT_DEGREE];
  int n;
  bool complete;
} pl_values;

static void add_value(pl_values* v, pl_expr value, pl_expr condition) {
  if (v->n == PL_MAX_ROOT_DEGREE || pl_is_poison(value)) {
    v->complete = false;
    return;
  }
  v->value[v->n] = value;
  v->condition[v->n++] = condition;
}

static void quadratic(pl_roots* r, const pl_expr* c, pl_values* v) {
  pl_pool* p = r->p;
  pl_expr disc = normal(
      r, pl_sub(p, pl_square(p, c[1]), pl_mul_n(p, (pl_expr[]){pl_int(p, 4), c[0], c[2]}, 3)));
  int sign = proven(r, disc);
  if (sign < 0) return;
  pl_expr condition = sign > 0 ? pl_poison() : disc;
  pl_expr root = pl_sqrt(p, disc);
  pl_expr two_a = pl_mul(p, pl_int(p, 2), c[2]);
  add_value(v, normal(r, pl_div(p, pl_sub(p, root, c[1]), two_a)), condition);
  if (pl_is_zero_node(p, disc)) return;
  add_value(v, normal(r, pl_div(p, pl_sub(p, pl_neg(p, root), c[1]), two_a)), condition);
}

// c_n y^n + c_0 = 0
static void pure_power(pl_roots* r, const pl_expr* c, int n, pl_values* v) {
  pl_pool* p = r->p;
  pl_expr q = normal(r, pl_neg(p, pl_div(p, c[0], c[n])));
  pl_expr exponent = pl_ratio(p, 1, n);
  if (n % 2) {
    int sign = proven(r, q);
    if (sign < 0)
      add_value(v, pl_neg(p, pl_pow(p, normal(r, pl_neg(p, q)), exponent)), pl_poison());
    else add_value(v, pl_pow(p, q, exponent), sign > 0 ? pl_poison() : q);
    if (sign == 0) v->complete = false;  // the branch of a negative q is not written
    return;
  }
  add_value(v, pl_pow(p, q, exponent), q);
  add_value(v, pl_neg(p, pl_pow(p, q, exponent)), q);
}

static void even_powers(pl_roots* r, const pl_expr* c, pl_values* v) {
  pl_pool* p = r->p;
  pl_values squares = {.complete = true};
  quadratic(r, (pl_expr[]){c[0], c[2], c[4]}, &squares);
  for (int i = 0; i < squares.n; i++) {
    pl_expr root = normal(r, pl_sqrt(p, squares.value[i]));
    pl_expr condition = both(r, squares.condition[i], squares.value[i]);
    add_value(v, root, condition);
    add_value(v, pl_neg(p, root), condition);
  }
}

static pl_values polynomial_roots(pl_roots* r, const pl_expr* c, int degree) {
  pl_pool* p = r->p;
  pl_values v = {.complete = true};
  bool middle = false;  // a coefficient between the first and the last
  for (int k = 1; k < degree; k++) middle |= !pl_is_zero_node(p, c[k]);
  bool biquadratic = degree == 4 && pl_is_zero_node(p, c[1]) && pl_is_zero_node(p, c[3]);
  if (degree == 1) {
    add_value(&v, normal(r, pl_neg(p, pl_div(p, c[0], c[1]))), pl_poison());
  } else if (degree == 2) {
    quadratic(r, c, &v);
  } else if (!middle && degree > 2) {
    pure_power(r, c, degree, &v);
  } else if (biquadratic) {
    even_powers(r, c, &v);
  } else if (degree > 0) {
    v.complete = false;
  }
  return v;
}

// --------------------------------------------------------------------------------- angles: u = k x
// x from u, u = base expression of a pair; false when u is not linear in x.
static bool angle_scale(pl_roots* r, pl_expr base, pl_expr* slope, pl_expr* offset) {
  pl_expr c[2];
  if (pl_alg_coefficients(r->t, base, r->x, c, 1) != 1) return false;
  *offset = c[0];
  *slope = c[1];
  return true;
}

static void add_angle(pl_roots* r, pl_expr u, pl_expr slope, pl_expr offset, pl_expr condition) {
  // a number stays apart, so that it goes where the root is inserted into θ + 1/4
  bool apart = pl_is_constant(r->p, offset) && !pl_is_constant(r->p, u);
  pl_expr x = pl_div(r->p, apart ? u : pl_sub(r->p, u, offset), slope);
  x = normal(r, x);
  add_root(r, apart ? pl_sub(r->p, x, normal(r, pl_div(r->p, offset, slope))) : x, condition);
}

static pl_expr within_one(pl_roots* r, pl_expr c) {
  return normal(r, pl_sub(r->p, pl_int(r->p, 1), pl_square(r->p, c)));
}

static void roots_from_cos(pl_roots* r, const pl_values* v, pl_expr slope, pl_expr offset) {
  for (int i = 0; i < v->n; i++) {
    pl_expr angle = pl_call(r->p, PL_ACOS, v->value[i]);
    pl_expr condition = both(r, v->condition[i], within_one(r, v->value[i]));
    add_angle(r, angle, slope, offset, condition);
    add_angle(r, pl_neg(r->p, angle), slope, offset, condition);
  }
}

static void roots_from_sin(pl_roots* r, const pl_values* v, pl_expr slope, pl_expr offset) {
  for (int i = 0; i < v->n; i++) {
    pl_expr angle = pl_call(r->p, PL_ASIN, v->value[i]);
    pl_expr condition = both(r, v->condition[i], within_one(r, v->value[i]));
    add_angle(r, angle, slope, offset, condition);
    add_angle(r, pl_sub(r->p, pl_pi(r->p), angle), slope, offset, condition);
  }
}

// A cos u + B sin u + C = 0
static void roots_of_linear_pair(pl_roots* r, pl_expr A, pl_expr B, pl_expr C, pl_expr slope,
                                 pl_expr offset) {
  pl_pool* p = r->p;
  if (pl_is_zero_node(p, C)) {
    pl_expr angle = pl_call(p, PL_ATAN, normal(r, pl_neg(p, pl_div(p, A, B))));
    add_angle(r, angle, slope, offset, pl_poison());
    add_angle(r, pl_add(p, angle, pl_pi(p)), slope, offset, pl_poison());
    return;
  }
  pl_expr square = normal(r, pl_add(p, pl_square(p, A), pl_square(p, B)));
  pl_expr start = pl_call2(p, PL_ATAN2, B, A);
  pl_expr width = pl_call(p, PL_ACOS, normal(r, pl_neg(p, pl_div(p, C, pl_sqrt(p, square)))));
  pl_expr condition = normal(r, pl_sub(p, square, pl_square(p, C)));
  add_angle(r, pl_add(p, start, width), slope, offset, condition);
  add_angle(r, pl_sub(p, start, width), slope, offset, condition);
}

// f0 + f1 sin u with f0, f1 polynomials in cos u, f1 not zero, and not a polynomial in sin u
// either.
static void roots_of_pair(pl_roots* r, pl_expr e, pl_expr cosine, pl_expr sine, pl_expr slope,
                          pl_expr offset) {
  pl_pool* p = r->p;
  pl_expr none = pl_int(p, 0), a[3] = {none, none, none}, b[3] = {none, none, none};
  pl_expr by_sine[PL_MAX_ROOT_DEGREE + 1];
  int d = pl_alg_coefficients_atom(r->t, e, sine, by_sine, PL_MAX_ROOT_DEGREE);
  if (d < 0) {
    r->complete = false;
    return;
  }
  // the view by sines: sum_k (a_k + b_k cos) sin^k
  bool known = d <= 2;
  for (int k = 0; k <= d && k < 3; k++) {
    pl_expr g[2] = {pl_int(p, 0), pl_int(p, 0)};
    if (pl_alg_coefficients_atom(r->t, by_sine[k], cosine, g, 1) < 0) known = false;
    a[k] = g[0];
    b[k] = g[1];
  }
  bool zero[6];
  for (int k = 0; k < 3; k++) {
    zero[k] = pl_is_zero_node(p, a[k]);
    zero[3 + k] = pl_is_zero_node(p, b[k]);
  }
  if (known && zero[2] && zero[4] && zero[5]) {
    roots_of_linear_pair(r, b[0], a[1], a[0], slope, offset);
  } else if (known && zero[1] && zero[3] && zero[5]) {
    // a0 + a2 sin^2 + b1 sin cos = (a0 + a2/2) - a2/2 cos 2u + b1/2 sin 2u; with 2u also 2u + 2π
    pl_expr half = pl_ratio(p, 1, 2), two = pl_int(p, 2);
    pl_expr A = normal(r, pl_neg(p, pl_mul(p, half, a[2]))), B = normal(r, pl_mul(p, half, b[1]));
    pl_expr C = normal(r, pl_sub(p, a[0], A)), slope2 = pl_mul(p, two, slope),
            offset2 = pl_mul(p, two, offset);
    roots_of_linear_pair(r, A, B, C, slope2, offset2);
    roots_of_linear_pair(r, A, B, C, slope2, pl_sub(p, offset2, pl_mul(p, two, pl_pi(p))));
  } else {
    r->complete = false;
  }
}

static void roots_of_angle(pl_roots* r, pl_expr e, pl_expr cosine, pl_expr sine) {
  pl_expr slope, offset;
  if (!angle_scale(r, pl_arg(r->p, cosine, 0), &slope, &offset)) {
    r->complete = false;
    return;
  }
  pl_expr c[PL_MAX_ROOT_DEGREE + 1];
  // polynomial in cos alone, or in sin alone?
  int d = pl_alg_coefficients_atom(r->t, e, cosine, c, PL_MAX_ROOT_DEGREE);
  bool alone = d > 0;
  for (int k = 0; k <= d; k++) alone = alone && !pl_has_symbol(r->p, c[k], r->x);
  if (alone) {
    pl_values v = polynomial_roots(r, c, d);
    roots_from_cos(r, &v, slope, offset);
    r->complete &= v.complete;
    return;
  }
  d = pl_alg_coefficients_atom(r->t, e, sine, c, PL_MAX_ROOT_DEGREE);
  alone = d > 0;
  for (int k = 0; k <= d; k++) alone = alone && !pl_has_symbol(r->p, c[k], r->x);
  if (alone) {
    pl_values v = polynomial_roots(r, c, d);
    roots_from_sin(r, &v, slope, offset);
    r->complete &= v.complete;
    return;
  }
  roots_of_pair(r, e, cosine, sine, slope, offset);
}

// ------------------------------------------------------------------------------------ exponentials
static void roots_of_exp(pl_roots* r, pl_expr e, pl_expr atom) {
  pl_expr slope, offset, c[PL_MAX_ROOT_DEGREE + 1];
  int d = pl_alg_coefficients_atom(r->t, e, atom, c, PL_MAX_ROOT_DEGREE);
  if (d < 1 || !angle_scale(r, pl_arg(r->p, atom, 0), &slope, &offset)) {
    r->complete = false;
    return;
  }
  pl_values v = polynomial_roots(r, c, d);
  for (int i = 0; i < v.n; i++) {
    if (pl_is_zero_node(r->p, v.value[i])) continue;
    pl_expr u = pl_call(r->p, PL_LN, v.value[i]);
    add_angle(r, u, slope, offset, both(r, v.condition[i], v.value[i]));
  }
  r->complete &= v.complete;
}

// ------------------------------------------------------------------------------ isolate and invert
// Solves `other` = 0 and keeps of its roots those that satisfy e = 0.
static void roots_that_verify(pl_roots* r, pl_expr e, pl_expr other) {
  int from = r->n;
  solve_equation(r, other);
  int n = from;
  for (int i = from; i < r->n; i++) {
    pl_expr inserted = pl_subst1(r->p, e, r->x, r->at[i].value);
    if (pl_alg_is_zero(r->t, inserted) == PL_NO) continue;
    r->at[n++] = r->at[i];
  }
  r->n = n;
}

// A + B w = 0 with w^2 = P:  A^2 = B^2 P
static void roots_of_radical(pl_roots* r, pl_expr e, pl_expr atom) {
  pl_pool* p = r->p;
  pl_expr c[2];
  if (pl_alg_coefficients_atom(r->t, e, atom, c, 1) != 1) {
    r->complete = false;
    return;
  }
  pl_expr other = pl_sub(p, pl_square(p, c[0]), pl_mul(p, pl_square(p, c[1]), pl_square(p, atom)));
  roots_that_verify(r, e, normal(r, other));
}

// v = f(u)  ->  u = f^-1(v)
static void roots_of_inverse(pl_roots* r, pl_expr e, pl_expr atom) {
  pl_pool* p = r->p;
  pl_expr c[2];
  bool isolated = pl_kind_of(p, atom) == PL_CALL
                  && pl_alg_coefficients_atom(r->t, e, atom, c, 1) == 1;
  if (!isolated || pl_has_symbol(p, c[0], r->x) || pl_has_symbol(p, c[1], r->x)) {
    r->complete = false;
    return;
  }
  pl_expr v = normal(r, pl_neg(p, pl_div(p, c[0], c[1])));
  pl_expr u = pl_arg(p, atom, 0);
  pl_function inverse;
  switch (pl_function_of(p, atom)) {
    case PL_LN: inverse = PL_EXP; break;
    case PL_ASIN: inverse = PL_SIN; break;
    case PL_ACOS: inverse = PL_COS; break;
    case PL_ATAN: inverse = PL_TAN; break;
    default: r->complete = false; return;
  }
  roots_that_verify(r, e, pl_sub(p, u, pl_call(p, inverse, v)));
}

// -------------------------------------------------------------------------------------- one factor
typedef struct pl_occur_job {
  pl_expr e;
  pl_symbol x;
  pl_occurrence at[PL_MAX_OCCURRENCES];
  int n;
} pl_occur_job;

static void occur_body(pl_tower* t, void* data) {
  pl_occur_job* j = data;
  j->n = 0;
  pl_frac f = pl_convert(t, j->e);
  for (int g = 0; g < t->gens.n; g++) {
    if (pl_poly_degree(t, f.num, g) == 0 || !pl_gen_contains(t, g, j->x)) continue;
    if (j->n == PL_MAX_OCCURRENCES) pl_tower_give_up(t);
    j->at[j->n++] = (pl_occurrence){t->gens.at[g].kind, t->gens.at[g].expr};
  }
}

// The pair that the occurrences belong to, if they are one or both of cos u and sin u.
static bool one_pair(pl_roots* r, const pl_occur_job* j, pl_expr* cosine, pl_expr* sine) {
  if (j->n < 1 || j->n > 2) return false;
  for (int i = 0; i < j->n; i++) {
    if (j->at[i].kind != PL_G_COS && j->at[i].kind != PL_G_SIN) return false;
    if (pl_kind_of(r->p, j->at[i].expr) != PL_CALL) return false;
  }
  pl_expr u = pl_arg(r->p, j->at[0].expr, 0);
  if (j->n == 2 && !pl_same(u, pl_arg(r->p, j->at[1].expr, 0))) return false;
  *cosine = pl_call(r->p, PL_COS, u);
  *sine = pl_call(r->p, PL_SIN, u);
  return true;
}

static void solve_factor(pl_roots* r, pl_expr e) {
  pl_occur_job j = {.e = e, .x = r->x};
  if (!pl_tower_run(r->t, occur_body, &j)) {
    r->complete = false;
    return;
  }
  pl_expr c[PL_MAX_ROOT_DEGREE + 1], cosine, sine;
  if (j.n == 1 && j.at[0].kind == PL_G_SYMBOL) {
    int d = pl_alg_coefficients(r->t, e, r->x, c, PL_MAX_ROOT_DEGREE);
    pl_values v = {.complete = false};
    if (d > 0) v = polynomial_roots(r, c, d);
    for (int i = 0; i < v.n; i++) add_root(r, v.value[i], v.condition[i]);
    r->complete &= v.complete;
    return;
  }
  // roots and absolute values first: the newest generator is the outermost
  for (int i = j.n - 1; i >= 0; i--) {
    bool square = pl_is_sqrt(r->p, j.at[i].expr) || j.at[i].kind == PL_G_ABS;
    if ((j.at[i].kind != PL_G_ROOT && j.at[i].kind != PL_G_ABS) || !square) continue;
    roots_of_radical(r, e, j.at[i].expr);
    return;
  }
  if (one_pair(r, &j, &cosine, &sine)) {
    roots_of_angle(r, e, cosine, sine);
  } else if (j.n == 1 && j.at[0].kind == PL_G_EXP) {
    roots_of_exp(r, e, j.at[0].expr);
  } else if (j.n == 1 && j.at[0].kind == PL_G_FORMAL) {
    roots_of_inverse(r, e, j.at[0].expr);
  } else {
    r->complete = false;
  }
}

static void solve_equation(pl_roots* r, pl_expr e) {
  if (++r->depth > PL_MAX_ROOT_DEPTH) {
    r->complete = false;
    r->depth--;
    return;
  }
  pl_factor f[PL_MAX_ROOTS];
  int n = pl_alg_factors(r->t, e, f, PL_MAX_ROOTS, NULL);
  for (int i = 0; i < n; i++) {
    if (f[i].power > 0 && pl_has_symbol(r->p, f[i].base, r->x)) solve_factor(r, f[i].base);
  }
  r->depth--;
}

// ------------------------------------------------------------------------------------- the service
// What does not satisfy the equation, or is a pole, goes.
static void verify(pl_roots* r, pl_expr e) {
  pl_expr num, den;
  pl_alg_fraction(r->t, e, &num, &den);
  int n = 0;
  for (int i = 0; i < r->n; i++) {
    pl_expr at_num = pl_subst1(r->p, num, r->x, r->at[i].value);
    pl_expr at_den = pl_subst1(r->p, den, r->x, r->at[i].value);
    if (pl_is_poison(at_num) || pl_is_poison(at_den)) continue;
    if (pl_alg_is_zero(r->t, at_num) == PL_NO) {
      r->complete = false;
      continue;
    }
    if (pl_alg_is_zero(r->t, at_den) == PL_YES) continue;
    r->at[n++] = r->at[i];
  }
  r->n = n;
}

int pl_alg_roots(pl_tower* t, pl_expr e, pl_symbol x, pl_root* out, int max, bool* complete) {
  pl_roots* r = PL_NEW(t->arena, pl_roots);
  *r = (pl_roots){.t = t, .p = t->pool, .x = x, .complete = true};
  if (complete) *complete = false;
  if (pl_is_poison(e) || !pl_has_symbol(t->pool, e, x)) return 0;
  solve_equation(r, e);
  verify(r, e);
  if (r->n > max) {
    r->n = max;
    r->complete = false;
  }
  memcpy(out, r->at, (size_t)r->n * sizeof *out);
  if (complete) *complete = r->complete;
  return r->n;
}
