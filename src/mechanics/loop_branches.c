// loops_ways: two equations for two unknowns, or one for one, solved in closed form with all their
// solutions.
//
// An unknown is plain (polynomials of degree 2 at most) or an angle (its cosine and sine occur
// linearly).
//   angle v   p_i + q_i cos v + r_i sin v = 0, i = 1, 2, gives cos v = Nc/D, sin v = Ns/D;
//             then Nc^2 + Ns^2 - D^2 = 0
//   plain v   the squares are eliminated, l1 v + l0 = 0, and v = -l0/l1 inserted into the
//             other equation
// What is left contains u alone:
//   plain u   linear or quadratic; squares are taken out of the root without bars, so that each
//             way stays on its own branch
//   angle u   A cos u + B sin u + C = 0:   w = sqrt(A^2 + B^2 - C^2),
//             u = atan2(-B C ± A w, -A C -+ B w)
// See theory (5.5).
#include "mechanics/loops_impl.h"

enum { most_factors = 16 };
static const long longest_unnamed = 24;  // operations under a root; beyond them it gets a name

// ------------------------------------------------------------------------------------------ shapes
static bool is_zero(pl_analysis* d, pl_expr e) {
  return pl_is_zero_node(d->pool, e) || pl_alg_is_zero(d->tower, e) == PL_YES;
}

static pl_expr call(pl_analysis* d, pl_function f, pl_symbol q) {
  return pl_call(d->pool, f, pl_sym(d->pool, q));
}

// e = part[0] + part[1] cos q + part[2] sin q
static bool trigonometric(pl_analysis* d, pl_expr e, pl_symbol q, pl_expr* part) {
  pl_expr by_sine[2], by_cosine[2], none = pl_int(d->pool, 0);
  int n = pl_alg_coefficients_atom(d->tower, e, call(d, PL_SIN, q), by_sine, 1);
  if (n < 0) return false;
  part[2] = n == 1 ? by_sine[1] : none;
  n = pl_alg_coefficients_atom(d->tower, by_sine[0], call(d, PL_COS, q), by_cosine, 1);
  if (n < 0) return false;
  part[0] = by_cosine[0];
  part[1] = n == 1 ? by_cosine[1] : none;
  for (int k = 0; k < 3; k++) {
    if (pl_has_symbol(d->pool, part[k], q)) return false;
  }
  return !is_zero(d, part[1]) || !is_zero(d, part[2]);
}

static int polynomial(pl_analysis* d, pl_expr e, pl_symbol q, pl_expr* c) {
  c[0] = c[1] = c[2] = pl_int(d->pool, 0);
  int n = pl_alg_coefficients(d->tower, e, q, c, 2);
  for (int k = n + 1; k < 3 && n >= 0; k++) c[k] = pl_int(d->pool, 0);
  return n;
}

// ------------------------------------------------------------------------------------------- names
static bool name_is_taken(pl_analysis* d, const char* ascii) {
  return pl_symbol_find(d->pool, ascii).id != 0;
}

static pl_expr with_name(pl_analysis* d, pl_loop* l, const char* letter, pl_symbol of,
                         pl_expr value) {
  const pl_symbol_info* q = pl_symbol_get(d->pool, of);
  const char *name = pl_format(d->arena, "%s_%s", letter, q->name),
             *ascii = pl_format(d->arena, "%s_%s", letter, q->ascii);
  while (name_is_taken(d, ascii)) {
    name = pl_format(d->arena, "%s%s", letter, name);
    ascii = pl_format(d->arena, "%s%s", letter, ascii);
  }
  pl_symbol_info info = {.name = name, .ascii = ascii, .role = PL_R_LOCAL, .class = PL_C_OTHER};
  info.dimension = pl_dimension_of_expr(d, value, &info.dimension_known);
  pl_symbol s = pl_symbol_make(d->pool, &info);
  pl_push(d->arena, l->names, (pl_definition){s, value});
  return pl_sym(d->pool, s);
}

// ------------------------------------------------------------------------------------- one unknown
// sqrt(e) = outer * inner with the squares in e taken out, without bars.
void pl_take_squares_out(pl_analysis* d, pl_expr e, pl_expr* outer, pl_expr* rest) {
  pl_factor f[most_factors];
  pl_expr unit;
  *outer = pl_int(d->pool, 1);
  *rest = e;
  int n = pl_alg_factors(d->tower, e, f, most_factors, &unit);
  if (n <= 0) return;
  if (pl_is_number(d->pool, unit) && !pl_is_zero_node(d->pool, unit)) {
    pl_expr number = pl_sqrt(d->pool,
                             pl_number_sign(d->pool, unit) < 0 ? pl_neg(d->pool, unit) : unit);
    if (pl_is_number(d->pool, number)) *outer = number;
  }
  for (int k = 0; k < n; k++) {
    int half = f[k].power >= 0 ? f[k].power / 2 : -((1 - f[k].power) / 2);
    *outer = pl_mul(d->pool, *outer, pl_pow_int(d->pool, f[k].base, half));
  }
  *rest = pl_alg_normal(d->tower, pl_div(d->pool, e, pl_square(d->pool, *outer)));
}

static void must_be_real(pl_analysis* d, pl_loop* l, pl_expr e) {
  int sign;
  if (pl_alg_sign(d->tower, e, true, &sign) == PL_YES && sign > 0) return;
  l->real = pl_is_poison(l->real) ? e : pl_call2(d->pool, PL_MIN, l->real, e);
}

static void add_way(pl_loop* l, pl_expr u) {
  if (l->n_ways < pl_max_ways) l->value[l->n_ways++][0] = u;
}

static bool plain_ways(pl_analysis* d, pl_loop* l, pl_expr F, pl_symbol u) {
  pl_pool* p = d->pool;
  pl_expr c[3], outer, rest;
  int n = polynomial(d, F, u, c);
  if (n == 1) add_way(l, pl_alg_normal(d->tower, pl_neg(p, pl_div(p, c[0], c[1]))));
  if (n != 2) return n == 1;
  pl_expr disc = pl_alg_normal(
      d->tower,
      pl_sub(p, pl_square(p, c[1]), pl_mul_n(p, (pl_expr[]){pl_int(p, 4), c[0], c[2]}, 3)));
  if (is_zero(d, disc)) return false;
  pl_take_squares_out(d, disc, &outer, &rest);
  must_be_real(d, l, rest);
  pl_expr w = pl_sqrt(p, rest);
  if (pl_op_count(p, rest) > longest_unnamed) w = with_name(d, l, "w", u, w);
  for (int sign = 1; sign >= -1; sign -= 2) {
    pl_expr root = pl_mul_n(p, (pl_expr[]){pl_int(p, sign), outer, w}, 3);
    add_way(l, pl_alg_normal(d->tower,
                             pl_div(p, pl_sub(p, root, c[1]), pl_mul(p, pl_int(p, 2), c[2]))));
  }
  return true;
}

// B sin u + C = 0 or A cos u + C = 0
static void half_ways(pl_analysis* d, pl_loop* l, pl_expr slope, pl_expr C, bool sine) {
  pl_pool* p = d->pool;
  pl_expr x = pl_alg_normal(d->tower, pl_neg(p, pl_div(p, C, slope)));
  pl_expr angle = pl_call(p, sine ? PL_ASIN : PL_ACOS, x);
  must_be_real(d, l, pl_alg_normal(d->tower, pl_sub(p, pl_square(p, slope), pl_square(p, C))));
  add_way(l, angle);
  add_way(l, sine ? pl_sub(p, pl_pi(p), angle) : pl_neg(p, angle));
}

static bool angle_ways(pl_analysis* d, pl_loop* l, pl_expr F, pl_symbol u) {
  pl_pool* p = d->pool;
  pl_expr k[3];
  if (!trigonometric(d, F, u, k)) return false;
  if (is_zero(d, k[1]) || is_zero(d, k[2])) {
    bool sine = is_zero(d, k[1]);
    half_ways(d, l, sine ? k[2] : k[1], k[0], sine);
    return true;
  }
  bool balanced = is_zero(d, k[0]);  // tan u = -A/B: two ways, a half turn apart
  pl_expr A = with_name(d, l, "A", u, k[1]), B = with_name(d, l, "B", u, k[2]);
  if (balanced) {
    add_way(l, pl_call2(p, PL_ATAN2, A, pl_neg(p, B)));
    add_way(l, pl_call2(p, PL_ATAN2, pl_neg(p, A), B));
    l->by_angle = true;
    return true;
  }
  pl_expr C = with_name(d, l, "C", u, k[0]);
  pl_expr square = pl_sub(p, pl_add(p, pl_square(p, A), pl_square(p, B)), pl_square(p, C));
  pl_expr inside = pl_sub(p, pl_add(p, pl_square(p, k[1]), pl_square(p, k[2])), pl_square(p, k[0]));
  must_be_real(d, l, pl_alg_normal(d->tower, inside));
  pl_expr w = with_name(d, l, "w", u, pl_sqrt(p, square));
  l->by_angle = true;
  for (int sign = 1; sign >= -1; sign -= 2) {
    pl_expr turn = pl_mul(p, pl_int(p, sign), w);
    pl_expr y = pl_sub(p, pl_mul(p, A, turn), pl_mul(p, B, C)),
            x = pl_neg(p, pl_add(p, pl_mul(p, B, turn), pl_mul(p, A, C)));
    add_way(l, pl_call2(p, PL_ATAN2, y, x));
  }
  return true;
}

// Some factor of D vanishes with f: no solution of the two equations.
static bool divides(pl_analysis* d, pl_expr f, pl_expr D) {
  pl_factor of[most_factors];
  pl_expr unit;
  int n = pl_is_poison(D) ? 0 : pl_alg_factors(d->tower, D, of, most_factors, &unit);
  for (int k = 0; k < n; k++) {
    if (pl_alg_is_zero(d->tower, pl_sub(d->pool, f, of[k].base)) == PL_YES
        || pl_alg_is_zero(d->tower, pl_add(d->pool, f, of[k].base)) == PL_YES)
      return true;
  }
  return false;
}

// All solutions of F = 0 for u, factor by factor.
static bool ways_of(pl_analysis* d, pl_loop* l, pl_expr F, const pl_unknown* u, pl_expr D) {
  pl_factor f[most_factors];
  pl_expr unit, c[3];
  int n = pl_alg_factors(d->tower, F, f, most_factors, &unit), solved = 0;
  for (int k = 0; k < n; k++) {
    if (f[k].power <= 0 || !pl_has_symbol(d->pool, f[k].base, u->q) || divides(d, f[k].base, D))
      continue;
    bool plain = polynomial(d, f[k].base, u->q, c) > 0;
    if (plain == u->angle || solved++ > 0) return false;
    l->eliminated = f[k].base;
    if (!(plain ? plain_ways(d, l, f[k].base, u->q) : angle_ways(d, l, f[k].base, u->q)))
      return false;
  }
  return solved > 0 && l->n_ways > 0;
}

// ------------------------------------------------------------------------------- the other unknown
static bool angle_from_both(pl_analysis* d, pl_loop* l, const pl_expr* e, const pl_unknown* u,
                            const pl_unknown* v) {
  pl_pool* p = d->pool;
  pl_expr a[3], b[3];
  if (!trigonometric(d, e[0], v->q, a) || !trigonometric(d, e[1], v->q, b)) return false;
  pl_expr D = pl_alg_normal(d->tower, pl_sub(p, pl_mul(p, a[1], b[2]), pl_mul(p, b[1], a[2])));
  if (is_zero(d, D)) return false;
  pl_expr Nc = pl_alg_normal(d->tower, pl_sub(p, pl_mul(p, b[0], a[2]), pl_mul(p, a[0], b[2])));
  pl_expr Ns = pl_alg_normal(d->tower, pl_sub(p, pl_mul(p, a[0], b[1]), pl_mul(p, b[0], a[1])));
  pl_expr F = pl_alg_normal(
      d->tower, pl_sub(p, pl_add(p, pl_square(p, Nc), pl_square(p, Ns)), pl_square(p, D)));
  if (!ways_of(d, l, F, u, D)) return false;
  int sign;
  bool known = pl_alg_sign(d->tower, D, false, &sign) == PL_YES;
  pl_expr by = known ? pl_int(p, sign) : D;  // only the direction counts
  pl_expr y = pl_alg_normal(d->tower, pl_div(p, Ns, by)),
          x = pl_alg_normal(d->tower, pl_div(p, Nc, by));
  if (known) {  // a common positive factor goes
    pl_expr ratio = pl_alg_normal(d->tower, pl_div(p, Ns, Nc)), upper, lower;
    pl_alg_fraction(d->tower, ratio, &upper, &lower);
    if (!pl_is_poison(upper) && !is_zero(d, upper)) {
      pl_expr common = pl_alg_normal(d->tower, pl_div(p, y, upper));
      int s;
      if (pl_alg_sign(d->tower, common, false, &s) == PL_YES) {
        y = pl_mul(p, pl_int(p, s), upper);
        x = pl_mul(p, pl_int(p, s), lower);
      }
    }
  }
  for (int k = 0; k < l->n_ways; k++) l->value[k][1] = pl_call2(p, PL_ATAN2, y, x);
  return true;
}

// Each value of u takes the two roots of a quadratic in v.
static bool quadratic_in_each(pl_analysis* d, pl_loop* l, const pl_expr* c, const pl_unknown* u) {
  pl_pool* p = d->pool;
  int n = l->n_ways;
  if (2 * n > pl_max_ways) return false;
  for (int k = n - 1; k >= 0; k--) {
    pl_expr at[3], value = l->value[k][0];
    for (int j = 0; j < 3; j++) at[j] = pl_alg_normal(d->tower, pl_subst1(p, c[j], u->q, value));
    pl_expr disc = pl_alg_normal(
        d->tower,
        pl_sub(p, pl_square(p, at[1]), pl_mul_n(p, (pl_expr[]){pl_int(p, 4), at[0], at[2]}, 3)));
    pl_expr outer, rest;
    pl_take_squares_out(d, disc, &outer, &rest);
    must_be_real(d, l, rest);
    for (int s = 0; s < 2; s++) {
      pl_expr root = pl_mul_n(p, (pl_expr[]){pl_int(p, s ? -1 : 1), outer, pl_sqrt(p, rest)}, 3);
      l->value[2 * k + s][0] = value;
      l->value[2 * k + s][1] = pl_alg_normal(
          d->tower, pl_div(p, pl_sub(p, root, at[1]), pl_mul(p, pl_int(p, 2), at[2])));
    }
  }
  l->n_ways = 2 * n;
  return true;
}

static bool plain_from_both(pl_analysis* d, pl_loop* l, const pl_expr* e, const pl_unknown* u,
                            const pl_unknown* v) {
  pl_pool* p = d->pool;
  pl_expr a[3], b[3], low[3];
  int n = polynomial(d, e[0], v->q, a), m = polynomial(d, e[1], v->q, b);
  if (n < 1 || m < 1) return false;
  const pl_expr *linear = n == 1 ? a : b, *other = n == 1 ? b : a;
  if (n == 2 && m == 2) {
    for (int k = 0; k < 2; k++)
      low[k] = pl_alg_normal(d->tower, pl_sub(p, pl_mul(p, b[2], a[k]), pl_mul(p, a[2], b[k])));
    linear = low;
  }
  if (is_zero(d, linear[1]))
    return ways_of(d, l, linear[0], u, pl_poison()) && n == 2 && quadratic_in_each(d, l, other, u);
  pl_expr minus = pl_neg(p, linear[0]), F = pl_int(p, 0);
  int degree = is_zero(d, other[2]) ? 1 : 2;
  for (int k = 0; k <= degree; k++) {
    pl_expr term = pl_mul_n(
        p, (pl_expr[]){other[k], pl_pow_int(p, minus, k), pl_pow_int(p, linear[1], degree - k)}, 3);
    F = pl_add(p, F, term);
  }
  if (!ways_of(d, l, pl_alg_normal(d->tower, F), u, linear[1])) return false;
  pl_expr value = pl_alg_normal(d->tower, pl_div(p, minus, linear[1])), upper, lower;
  pl_alg_fraction(d->tower, value, &upper, &lower);
  bool moves = pl_has_coordinates(d, lower) || pl_has_symbol(p, lower, pl_time(p));
  for (int k = 0; k < l->n_ways; k++) {
    // a denominator that moves cancels when u is inserted
    pl_replace names[8];
    int n_names = 0;
    for (int j = 0; j < l->names.n && j < 8; j++)
      names[n_names++] = (pl_replace){l->names.at[j].symbol, l->names.at[j].value};
    pl_expr inserted = pl_subst(p, pl_subst1(p, value, u->q, l->value[k][0]), names, n_names);
    l->value[k][1] = moves && !u->angle ? pl_alg_normal(d->tower, inserted) : value;
  }
  return true;
}

// ----------------------------------------------------------------------------------- what is there
bool pl_unknown_of(pl_analysis* d, int i, const pl_expr* e, int n, pl_unknown* out) {
  *out = (pl_unknown){i, d->q.at[i].q, false};
  pl_expr c[3];
  int plain = 0, angle = 0, present = 0;
  for (int k = 0; k < n; k++) {
    if (!pl_has_symbol(d->pool, e[k], out->q)) continue;
    present++;
    if (polynomial(d, e[k], out->q, c) > 0) plain++;
    else if (trigonometric(d, e[k], out->q, c)) angle++;
  }
  out->angle = angle > 0;
  return present > 0 && (plain == present || angle == present);
}

bool pl_ways_of_one(pl_analysis* d, pl_loop* l, pl_expr e, const pl_unknown* u) {
  return ways_of(d, l, pl_alg_normal(d->tower, e), u, pl_poison());
}

bool pl_ways_of_two(pl_analysis* d, pl_loop* l, const pl_expr* e, const pl_unknown* u,
                    const pl_unknown* v) {
  return v->angle ? angle_from_both(d, l, e, u, v) : plain_from_both(d, l, e, u, v);
}
