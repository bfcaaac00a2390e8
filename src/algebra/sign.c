// Signs of polynomials under the assumptions, in the order of trust:
//   (i)   every term has a known sign, and all are the same
//   (ii)  factor by factor
//   (iii) the facts substituted away: r < l becomes l = r + δ, δ > 0, and then (i); sines and
//   cosines run to the
//   corners
//         of -1..1, since a polynomial that is linear in each of them is smallest in a corner;
//         bounds by Fourier sums
//   (iv') a square is completed: quadratic in one generator, with a discriminant of known sign
//   (iv)  the polynomial is one of the facts, or a radicand (w = sqrt(P) is real)
//   (v)   fifty sample points of the domain agree, or the probe (the start values) decides: an
//         assumption, recorded.
// What a proof has used is recorded too.
#include "algebra/tower.h"

#include <math.h>

enum {
  PL_MAX_CORNER_GENS = 4,
  PL_MAX_FACT_DEPTH = 3,
  PL_MAX_FACTS = 16,
  PL_MAX_SIGN_TERMS = 400,
  PL_MAX_SQUARE_TERMS = 40
};
// of the largest sample: smaller values do not count as having a sign
static const double sample_floor = 1e-9;

// ---------------------------------------------------------------------------------------- evidence
// What a proof may use beyond the signs of the generators: numbers in the place of sines, and δ in
// the place of a symbol.
typedef struct pl_proof {
  pl_tower* t;
  bool positive[PL_MAX_GENERATORS];  // generator stands for a positive difference now
  int n_facts, facts[PL_MAX_FACT_DEPTH];
} pl_proof;

static int generator_sign(const pl_proof* p, int g) {
  return p->positive[g] ? 1 : p->t->gens.at[g].sign;
}

// (i): sign of one term, 2 for >= 0, -2 for <= 0, 0 when open.
static int term_sign(const pl_proof* p, const pl_poly* a, slong i) {
  ulong exponent[PL_MAX_GENERATORS];
  fmpz_mpoly_get_term_exp_ui(exponent, a, i, &p->t->ctx);
  int sign = fmpz_sgn(&a->coeffs[i]), strict = 1;
  for (int g = 0; g < p->t->gens.n; g++) {
    if (exponent[g] == 0) continue;
    int s = generator_sign(p, g);
    if (s != 1 && s != -1) strict = 0;
    if (exponent[g] % 2 == 0) continue;
    if (s == 0) return 0;
    if (s < 0) sign = -sign;
  }
  return strict ? sign : 2 * sign;
}

// Sign when all terms agree: 1, -1 strict; 2, -2 not strict; 0 open.
static int definite(const pl_proof* p, const pl_poly* a) {
  int sign = 0;
  bool strict = false;
  for (slong i = 0; i < a->length; i++) {
    int s = term_sign(p, a, i);
    if (s == 0 || (sign != 0 && (s > 0) != (sign > 0))) return 0;
    sign = s > 0 ? 1 : -1;
    strict |= s == 1 || s == -1;
  }
  return strict ? sign : 2 * sign;
}

// ------------------------------------------------------------------------------------------- facts
static const pl_poly* fact_poly(pl_tower* t, int i) {
  pl_frac f = pl_convert(t, t->facts.at[i].difference);
  return pl_poly_mul(t, f.num, pl_frac_den(t, f));  // the same sign without a denominator
}

// D = c y + rest with a number c > 0: then y = (δ - rest)/c, and c^k p(y) has the sign of p. δ is
// written as y.
static bool substitute_fact(pl_tower* t, const pl_poly* D, int y, const pl_poly* a,
                            const pl_poly** out) {
  int degree = 0;
  const pl_poly** c = pl_poly_coefficients(t, D, y, &degree);
  if (degree != 1 || !pl_poly_is_number(t, c[1]) || fmpz_sgn(&c[1]->coeffs[0]) <= 0) return false;
  const pl_poly* y_now = pl_poly_sub(t, pl_poly_gen(t, y), c[0]);
  int n = 0;
  const pl_poly** k = pl_poly_coefficients(t, a, y, &n);
  if (n > 8) return false;
  const pl_poly* sum = pl_poly_int(t, 0);
  const pl_poly* scale = pl_poly_int(t, 1);
  // Horner in y_now, every step scaled by c
  for (int i = n; i >= 0; i--) {
    sum = pl_poly_add(t, pl_poly_mul(t, sum, y_now), pl_poly_mul(t, k[i], scale));
    scale = pl_poly_mul(t, scale, c[1]);
  }
  *out = sum;
  return true;
}

static int definite_with_facts(pl_proof* p, const pl_poly* a, const pl_poly* const* D, int n_D,
                               int depth) {
  int sign = definite(p, a);
  if (sign || depth == PL_MAX_FACT_DEPTH || a->length > PL_MAX_SIGN_TERMS) return sign;
  pl_tower* t = p->t;
  for (int i = 0; i < n_D; i++) {
    for (int y = 0; y < t->gens.n; y++) {
      if (t->gens.at[y].kind != PL_G_SYMBOL || p->positive[y] || pl_poly_degree(t, a, y) == 0)
        continue;
      const pl_poly* next = NULL;
      if (pl_poly_degree(t, D[i], y) != 1 || !substitute_fact(t, D[i], y, a, &next)) continue;
      const pl_poly* others[PL_MAX_FACTS];
      for (int k = 0; k < n_D; k++) {
        others[k] = D[k];
        if (k != i) substitute_fact(t, D[i], y, D[k], &others[k]);
      }
      bool was = p->positive[y];
      p->positive[y] = true;
      p->facts[depth] = i;
      p->n_facts = depth + 1;
      sign = definite_with_facts(p, next, others, n_D, depth + 1);
      if (sign) return sign;
      p->positive[y] = was;
      p->n_facts = depth;
    }
  }
  return 0;
}

// ----------------------------------------------------------------------------------------- corners
// a with generator g set to value, or (even) with g^2 set to it.
static const pl_poly* at_corner(pl_tower* t, const pl_poly* a, int g, bool even, int value) {
  int degree = 0;
  const pl_poly** c = pl_poly_coefficients(t, a, g, &degree);
  const pl_poly* sum = c[0];
  if (even) {
    for (int k = 2; k <= degree && value; k += 2) sum = pl_poly_add(t, sum, c[k]);
    return sum;
  }
  for (int k = 1; k <= degree; k++)
    sum = value > 0 || k % 2 == 0 ? pl_poly_add(t, sum, c[k]) : pl_poly_sub(t, sum, c[k]);
  return sum;
}

// Sines and cosines of a, and whether only their squares occur; false if one occurs otherwise than
// linearly.
static bool corner_gens(pl_tower* t, const pl_poly* a, int* gen, bool* even, int* n) {
  *n = 0;
  for (int g = 0; g < t->gens.n; g++) {
    pl_gen_kind kind = t->gens.at[g].kind;
    if (kind != PL_G_COS && kind != PL_G_SIN) continue;
    int degree = 0;
    const pl_poly** c = pl_poly_coefficients(t, a, g, &degree);
    if (degree == 0) continue;
    if (*n == PL_MAX_CORNER_GENS || degree > 2) return false;
    bool odd = !pl_poly_is_zero(t, c[1]);
    if (odd && degree > 1) return false;
    gen[*n] = g;
    even[(*n)++] = !odd;
  }
  return true;
}

static int definite_in_corners(pl_proof* p, const pl_poly* a, const pl_poly* const* D, int n_D) {
  int gen[PL_MAX_CORNER_GENS], n = 0;
  bool even[PL_MAX_CORNER_GENS];
  if (!corner_gens(p->t, a, gen, even, &n)) return 0;
  int sign = 0;
  bool strict = true;
  for (int corner = 0; corner < 1 << n; corner++) {
    const pl_poly* f = a;
    for (int k = 0; k < n; k++)
      f = at_corner(p->t, f, gen[k], even[k], corner >> k & 1 ? 1 : even[k] ? 0 : -1);
    if (pl_poly_is_zero(p->t, f)) {
      strict = false;
      continue;
    }
    // a proof per corner; the facts that the last one used stand for all
    pl_proof here = {.t = p->t};
    int s = definite_with_facts(&here, f, D, n_D, 0);
    if (s == 0 || (sign && (s > 0) != (sign > 0))) return 0;
    if (here.n_facts > p->n_facts) *p = here;
    sign = s > 0 ? 1 : -1;
    strict &= s == 1 || s == -1;
  }
  return strict ? sign : 2 * sign;
}

// The bounds over all angles have a sign.
static int definite_by_bounds(pl_proof* p, const pl_poly* a, const pl_poly* const* D, int n_D) {
  const pl_poly *low = NULL, *high = NULL;
  if (!pl_poly_trig_bounds(p->t, a, &low, &high)) return 0;
  pl_proof lower = {.t = p->t}, upper = {.t = p->t};
  if (pl_poly_is_zero(p->t, low)) return 2;
  if (pl_poly_is_zero(p->t, high)) return -2;
  int sign = definite_with_facts(&lower, low, D, n_D, 0);
  if (sign > 0) {
    *p = lower;
    return sign;
  }
  sign = definite_with_facts(&upper, high, D, n_D, 0);
  if (sign >= 0) return 0;
  *p = upper;
  return sign;
}

// ------------------------------------------------------------------------------------ whole proofs
static void record_symbols(pl_tower* t, const pl_poly* a) {
  long degree[PL_MAX_GENERATORS];
  pl_poly_degrees(t, a, degree);
  for (int g = 0; g < t->gens.n; g++) {
    const pl_gen* gen = &t->gens.at[g];
    if (degree[g] == 0 || gen->kind != PL_G_SYMBOL || gen->sign == 0) continue;
    pl_expr e = gen->sign > 0 ? gen->expr : pl_neg(t->pool, gen->expr);
    pl_tower_use(t, (pl_fact){e, gen->sign == 1 || gen->sign == -1});
  }
}

// (iv): a is, up to a positive factor, the difference of a fact or a radicand.
static int sign_as_fact(pl_tower* t, const pl_poly* a, const pl_poly* const* D, int n_D,
                        int* fact) {
  pl_factored f = pl_poly_factor(t, a);
  for (int i = 0; i < n_D; i++) {
    pl_factored d = pl_poly_factor(t, D[i]);
    if (d.n != f.n) continue;
    bool same = true;
    for (int k = 0; k < f.n; k++)
      same &= d.at[k].base == f.at[k].base && d.at[k].power % 2 == f.at[k].power % 2;
    if (!same) continue;
    *fact = i;
    return fmpz_sgn(f.unit) * fmpz_sgn(d.unit) * (t->facts.at[i].strict ? 1 : 2);
  }
  for (int g = -1; g < t->gens.n; g++) {
    if (g < 0 && !t->radicand) continue;
    if (g >= 0 && (t->gens.at[g].kind != PL_G_ROOT || t->gens.at[g].degree != 2)) continue;
    pl_factored d = pl_poly_factor(t, g < 0 ? t->radicand : t->gens.at[g].value);
    if (d.n != 1 || f.n != 1 || d.at[0].base != f.at[0].base || d.at[0].power % 2 == 0) continue;
    return 2 * fmpz_sgn(f.unit) * fmpz_sgn(d.unit);
  }
  return 0;
}

static int prove_by_squares(pl_tower* t, const pl_poly* a, int depth);

// depth: how often squares may be completed still.
static int prove_to(pl_tower* t, const pl_poly* a, int depth) {
  pl_proof p = {.t = t};
  int sign = definite(&p, a);
  const pl_poly* D[PL_MAX_FACTS];
  int n_D = 0;
  if (!sign && !t->facts_busy) {
    t->facts_busy = true;
    for (int i = 0; i < t->facts.n && n_D < PL_MAX_FACTS; i++) D[n_D++] = fact_poly(t, i);
    t->facts_busy = false;
  }
  int fact = -1;
  if (!sign) sign = sign_as_fact(t, a, D, n_D, &fact);
  if (fact >= 0) {
    if (!t->silent) pl_tower_use(t, t->facts.at[fact]);
    return sign;
  }
  if (!sign) sign = definite_in_corners(&p, a, D, n_D);
  if (!sign) sign = definite_in_corners(&p, pl_poly_shortest_view(t, a), D, n_D);
  if (!sign) sign = definite_by_bounds(&p, a, D, n_D);
  if (!sign && depth > 0) return prove_by_squares(t, a, depth);
  if (!sign || t->silent) return sign;
  record_symbols(t, a);
  for (int i = 0; i < p.n_facts; i++) pl_tower_use(t, t->facts.at[p.facts[i]]);
  return sign;
}

// f2 x^2 + f1 x + f0 with f2 > 0 and 4 f0 f2 - f1^2 >= 0 is a sum of squares, for every real
// generator x; with f2 < 0 minus one.
static int square_completed(pl_tower* t, const pl_poly* a, int g, int depth) {
  int degree = 0;
  const pl_poly** f = pl_poly_coefficients(t, a, g, &degree);
  if (pl_poly_is_zero(t, f[1])) return 0;  // nothing is completed
  int lead = prove_to(t, f[2], 0);
  if (lead != 1 && lead != -1) return 0;
  const pl_poly* product = pl_poly_mul(t, pl_poly_mul(t, f[0], f[2]), pl_poly_int(t, 4));
  const pl_poly* rest = pl_poly_sub(t, product, pl_poly_mul(t, f[1], f[1]));
  int sign = pl_poly_is_zero(t, rest) ? 2 : prove_to(t, rest, depth - 1);
  return sign > 0 ? lead * sign : 0;
}

// What attempts use that fail is no assumption.
static int prove_by_squares(pl_tower* t, const pl_poly* a, int depth) {
  bool silent = t->silent;
  int sign = 0;
  t->silent = true;
  for (int g = 0; g < t->gens.n && a->length <= PL_MAX_SQUARE_TERMS && !sign; g++) {
    if (pl_poly_degree(t, a, g) == 2) sign = square_completed(t, a, g, depth);
  }
  t->silent = silent;
  if (sign && !silent) record_symbols(t, a);
  return sign;
}

static int prove(pl_tower* t, const pl_poly* a) { return prove_to(t, a, 2); }

// (v)
static int sampled(pl_tower* t, pl_expr e) {
  int plus = 0, minus = 0;
  double largest = 0;
  pl_points* points = pl_tower_points(t);
  for (int i = 0; i < PL_POINT_COUNT; i++)
    largest = fmax(largest, fabs(pl_points_double(points, i, e)));
  for (int i = 0; i < PL_POINT_COUNT; i++) {
    double v = pl_points_double(points, i, e);
    plus += v > sample_floor * largest;
    minus += v < -sample_floor * largest;
  }
  if (plus + minus >= PL_POINT_COUNT / 5 && (plus == 0 || minus == 0)) return plus ? 1 : -1;
  return 0;
}

static int probed(pl_tower* t, pl_expr e) {
  if (!t->probe) return 0;
  int n = pl_symbol_count(t->pool);
  double* value = PL_ARRAY(t->arena, double, n + 1);
  for (int i = 0; i <= n; i++) value[i] = i <= t->n_probe ? t->probe[i] : (double)NAN;
  double v = pl_eval(t->pool, e, value);
  return v > 0 ? 1 : v < 0 ? -1 : 0;
}

// A number: one ball decides, and that is a proof.
static int sign_of_constant(pl_tower* t, pl_expr e) {
  arb_srcptr v;
  if (!pl_is_constant(t->pool, e)) return 0;
  if (!pl_points_value(pl_tower_points(t), 0, e, &v) || arb_contains_zero(v)) return 0;
  return arb_is_positive(v) ? 1 : -1;
}

static int base_sign_now(pl_tower* t, int base, bool guess) {
  int sign = prove(t, pl_base_poly(t, base));
  if (!sign) sign = sign_of_constant(t, pl_base_expr(t, base));
  if (sign || !guess) return sign;
  pl_expr e = pl_base_expr(t, base);
  sign = sampled(t, e);
  if (!sign) sign = probed(t, e);
  if (!sign) return 0;
  pl_tower_use(t, (pl_fact){sign > 0 ? e : pl_neg(t->pool, e), false});
  return 2 * sign;
}

int pl_base_sign(pl_tower* t, int base, bool or_zero, bool guess) {
  int sign = base_sign_now(t, base, guess);
  if (sign == 1 || sign == -1) return sign;
  if (or_zero && sign) return sign / 2;
  return PL_SIGN_OPEN;
}

int pl_poly_sign(pl_tower* t, const pl_poly* a, bool or_zero, bool guess) {
  if (pl_poly_is_zero(t, a)) return 0;
  if (pl_poly_is_number(t, a)) return fmpz_sgn(&a->coeffs[0]);
  // as a whole first: a sum of positive terms needs no factors
  int whole = prove(t, a);
  if (!whole) whole = sign_of_constant(t, pl_poly_expr(t, a));
  if (whole == 1 || whole == -1) return whole;
  if (or_zero && whole) return whole / 2;
  pl_factored f = pl_factored_merge_pairs(t, pl_poly_factor(t, a));
  int sign = fmpz_sgn(f.unit);
  for (int i = 0; i < f.n; i++) {
    bool odd = f.at[i].power % 2;
    if (!odd && or_zero) continue;
    int s = pl_base_sign(t, f.at[i].base, or_zero, guess);
    if (s == PL_SIGN_OPEN) return PL_SIGN_OPEN;
    if (odd) sign *= s;
  }
  return sign;
}

// ------------------------------------------------------------------------------------- the service
typedef struct pl_sign_job {
  pl_expr e;
  bool or_zero, guess;
  int sign;
} pl_sign_job;

static void sign_body(pl_tower* t, void* data) {
  pl_sign_job* j = data;
  pl_frac f = pl_convert(t, j->e);
  int num = pl_poly_sign(t, f.num, j->or_zero, j->guess);
  if (num == 0 || num == PL_SIGN_OPEN) {
    j->sign = num;
    return;
  }
  int sign = num;
  for (int i = 0; i < f.n; i++) {
    if (f.den[i].power % 2 == 0) continue;
    int s = pl_base_sign(t, f.den[i].base, true, j->guess);  // not zero, since it divides
    if (s == PL_SIGN_OPEN) sign = PL_SIGN_OPEN;
    if (sign != PL_SIGN_OPEN) sign *= s;
  }
  j->sign = sign;
}

static pl_answer3 sign_of(pl_tower* t, pl_expr e, bool or_zero, bool guess, int* sign) {
  pl_sign_job j = {.e = e, .or_zero = or_zero, .guess = guess, .sign = PL_SIGN_OPEN};
  *sign = 0;
  if (pl_is_poison(e)) return PL_UNKNOWN;
  if (!pl_tower_run(t, sign_body, &j) || j.sign == PL_SIGN_OPEN) return PL_UNKNOWN;
  *sign = j.sign;
  return PL_YES;
}

// A name that stands for something else is looked through when the names alone prove nothing.
pl_answer3 pl_alg_sign_proven(pl_tower* t, pl_expr e, bool or_zero, int* sign) {
  pl_expr seen = pl_tower_see(t, e);
  pl_answer3 known = sign_of(t, e, or_zero, false, sign);
  if (pl_same(seen, e)) return known;
  return known == PL_YES && *sign != 0 ? known : sign_of(t, seen, or_zero, false, sign);
}

pl_answer3 pl_alg_sign(pl_tower* t, pl_expr e, bool or_zero, int* sign) {
  pl_expr seen = pl_tower_see(t, e);
  if (pl_same(seen, e)) return sign_of(t, e, or_zero, true, sign);
  if (pl_alg_sign_proven(t, e, or_zero, sign) == PL_YES) return PL_YES;
  return sign_of(t, seen, or_zero, true, sign);
}
