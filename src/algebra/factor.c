// Factoring: every polynomial that is factored is remembered, every irreducible factor is entered
// once in the table of bases. Denominators are products of bases, so that the common denominator of
// a sum needs no gcd.
//
// FLINT's factoring is fast on the few variables that a factor really has and slow in a wide
// context, so it is done in a compact one. Monomial and integer contents are split off before.
#include "algebra/tower.h"

#include <stdlib.h>

// ------------------------------------------------------------------------------ the table of bases
int pl_base_find(pl_tower* t, const pl_poly* f, bool composite) {
  uint64_t key = pl_poly_hash(t, f);
  for (;; key += 2) {
    uint64_t found = pl_map_get(t->base_of, key);
    if (!found) break;
    if (pl_poly_equal(t, t->bases.at[found - 1].poly, f)) return (int)found - 1;
  }
  pl_base b = {.poly = pl_poly_keep(t, f), .composite = composite, .gen = -1};
  for (int g = 0; g < t->gens.n && f->length == 1; g++) {
    if (pl_poly_equal(t, f, pl_poly_gen(t, g))) b.gen = g;
  }
  pl_push(t->arena, t->bases, b);
  pl_map_set(t->base_of, key, (uint64_t)t->bases.n);
  return t->bases.n - 1;
}

const pl_poly* pl_base_poly(const pl_tower* t, int base) { return t->bases.at[base].poly; }

pl_expr pl_base_expr(pl_tower* t, int base) {
  if (t->bases.at[base].expr.id == 0) {
    pl_expr e = pl_poly_expr(t, t->bases.at[base].poly);
    t->bases.at[base].expr = e;
  }
  return t->bases.at[base].expr;
}

// ------------------------------------------------------------------------------ collecting factors
typedef struct pl_collect {
  pl_tower* t;
  fmpz* unit;
  PL_VEC(pl_power) at;
} pl_collect;

static void collect(pl_collect* c, int base, int power) {
  for (int i = 0; i < c->at.n; i++) {
    if (c->at.at[i].base != base) continue;
    c->at.at[i].power += power;
    return;
  }
  pl_power p = {base, power};
  pl_push(c->t->arena, c->at, p);
}

// Enters a primitive polynomial with its sign normalised; the sign goes into the unit.
static void collect_poly(pl_collect* c, const pl_poly* f, int power, bool composite) {
  pl_tower* t = c->t;
  if (pl_poly_is_number(t, f)) {
    fmpz* value = pl_int_new(t);
    fmpz_mpoly_get_fmpz(value, f, &t->ctx);
    fmpz_pow_ui(value, value, (ulong)power);
    fmpz_mul(c->unit, c->unit, value);
    return;
  }
  if (pl_poly_leading_sign(t, f) < 0) {
    f = pl_poly_neg(t, f);
    if (power % 2) fmpz_neg(c->unit, c->unit);
  }
  collect(c, pl_base_find(t, f, composite), power);
}

// f without its integer and monomial contents, which are collected.
static const pl_poly* collect_contents(pl_collect* c, const pl_poly* f) {
  pl_tower* t = c->t;
  pl_poly* content = pl_poly_new(t);
  fmpz_mpoly_term_content(content, f, &t->ctx);
  pl_poly* rest = pl_poly_new(t);
  if (!fmpz_mpoly_divides(rest, f, content, &t->ctx)) pl_tower_give_up(t);
  fmpz_mul(c->unit, c->unit, &content->coeffs[0]);
  ulong exponent[PL_MAX_GENERATORS];
  fmpz_mpoly_get_term_exp_ui(exponent, content, 0, &t->ctx);
  for (int g = 0; g < t->gens.n; g++) {
    if (exponent[g] > PL_MAX_DEGREE) pl_tower_give_up(t);
    if (exponent[g]) collect_poly(c, pl_poly_gen(t, g), (int)exponent[g], false);
  }
  return rest;
}

static bool too_large_to_factor(pl_tower* t, const pl_poly* f) {
  if (f->length > PL_MAX_FACTOR_TERMS) return true;
  long degree[PL_MAX_GENERATORS], total = 0;
  pl_poly_degrees(t, f, degree);
  for (int g = 0; g < t->gens.n; g++) total += degree[g];
  return total > PL_MAX_FACTOR_DEGREE;
}

// Polynomials of two terms that share no variable, of degree 1 in one of them, are irreducible at
// sight.
static bool irreducible_at_sight(pl_tower* t, const pl_poly* f) {
  if (f->length < 2) return true;
  for (int g = 0; g < t->gens.n; g++) {
    if (pl_poly_degree(t, f, g) != 1) continue;
    // linear in g with a monomial coefficient: a factor free of g divides that monomial, but
    // monomials were split off
    ulong exponent[PL_MAX_GENERATORS];
    int n = 0;
    for (slong i = 0; i < f->length && n < 2; i++) {
      fmpz_mpoly_get_term_exp_ui(exponent, f, i, &t->ctx);
      n += exponent[g] == 1;
    }
    if (n == 1) return true;
  }
  return false;
}

// FLINT's list of factors stands in the tower: what is collected from it may unwind.
static void drop_flint_factors(pl_tower* t) {
  if (t->flint_factors_context)
    fmpz_mpoly_factor_clear(&t->flint_factors, t->flint_factors_context);
  t->flint_factors_context = NULL;
}

void pl_factor_free(pl_tower* t) {
  drop_flint_factors(t);
  if (t->has_flint_integer_factors) fmpz_factor_clear(&t->flint_integer_factors);
  t->has_flint_integer_factors = false;
}

static bool factor_with_flint(pl_tower* t, const pl_poly* f, const int* use, int n) {
  drop_flint_factors(t);
  const fmpz_mpoly_ctx_struct* small = pl_poly_small_context(t, n);
  fmpz_mpoly_factor_init(&t->flint_factors, small);
  t->flint_factors_context = small;
  fmpz_mpoly_t packed;
  fmpz_mpoly_init(packed, small);
  pl_poly_pack(t, packed, small, f, use, n);
  bool found = fmpz_mpoly_factor(&t->flint_factors, packed, small);
  fmpz_mpoly_clear(packed, small);
  return found;
}

// f = a x + b is the common factor of a and b times what is left, which has no factors. The factor
// that may have some; NULL if there is none.
static const pl_poly* split_linear(pl_collect* c, const pl_poly* f, int x) {
  pl_tower* t = c->t;
  int degree = 0;
  const pl_poly** coefficient = pl_poly_coefficients(t, f, x, &degree);
  const pl_poly* g = pl_poly_gcd(t, coefficient[0], coefficient[1]);
  const pl_poly* rest = f;
  if (!pl_poly_is_number(t, g) && !pl_poly_divides(t, &rest, f, g)) pl_tower_give_up(t);
  collect_poly(c, rest, 1, false);
  return pl_poly_is_number(t, g) ? NULL : g;
}

static void collect_factors_of(pl_collect* c, const pl_poly* f) {
  pl_tower* t = c->t;
  int use[PL_MAX_GENERATORS], n = 0, linear = -1;
  pl_poly_used(t, f, use, &n);
  if (pl_poly_proven_irreducible(t, f, use, n, &linear)) {
    collect_poly(c, f, 1, false);
    return;
  }
  if (linear >= 0) {
    const pl_poly* g = split_linear(c, f, linear);
    if (g) collect_factors_of(c, g);
    return;
  }
  if (!factor_with_flint(t, f, use, n)) {
    collect_poly(c, f, 1, true);
    return;
  }
  fmpz_mul(c->unit, c->unit, t->flint_factors.constant);
  for (slong i = 0; i < t->flint_factors.num; i++) {
    pl_poly* one = pl_poly_new(t);
    pl_poly_unpack(t, one, &t->flint_factors.poly[i], t->flint_factors_context, use, n);
    collect_poly(c, one, (int)fmpz_get_si(&t->flint_factors.exp[i]), false);
  }
  drop_flint_factors(t);
}

// ---------------------------------------------------------------------------------------- integers
pl_primes pl_int_primes(pl_tower* t, const fmpz* c) {
  pl_primes list = {0};
  if (fmpz_is_zero(c) || fmpz_is_pm1(c)) return list;
  if (fmpz_bits(c) > PL_MAX_INTEGER_BITS) {
    pl_prime whole = {pl_int_new(t), 1};
    fmpz_abs(whole.p, c);
    pl_push(t->arena, list, whole);
    return list;
  }
  if (t->has_flint_integer_factors) fmpz_factor_clear(&t->flint_integer_factors);
  fmpz_factor_init(&t->flint_integer_factors);
  t->has_flint_integer_factors = true;
  fmpz_factor(&t->flint_integer_factors, c);
  for (slong i = 0; i < t->flint_integer_factors.num; i++) {
    pl_prime one = {pl_int_new(t), (long)t->flint_integer_factors.exp[i]};
    fmpz_set(one.p, t->flint_integer_factors.p + i);
    pl_push(t->arena, list, one);
  }
  return list;
}

static int compare_power(const void* a, const void* b) {
  const pl_power *x = a, *y = b;
  return (x->base > y->base) - (x->base < y->base);
}

static pl_factored collected(pl_collect* c) {
  if (c->at.n > 1) qsort(c->at.at, (size_t)c->at.n, sizeof *c->at.at, compare_power);
  return (pl_factored){.unit = c->unit, .n = c->at.n, .at = c->at.at};
}

static pl_factored factor_now(pl_tower* t, const pl_poly* a) {
  pl_collect c = {.t = t, .unit = pl_int_new(t)};
  fmpz_one(c.unit);
  const pl_poly* f = collect_contents(&c, a);
  if (pl_poly_is_number(t, f) || irreducible_at_sight(t, f)) {
    collect_poly(&c, f, 1, false);
  } else if (too_large_to_factor(t, f)) {
    collect_poly(&c, f, 1, true);
  } else {
    collect_factors_of(&c, f);
  }
  return collected(&c);
}

pl_factored pl_poly_factor(pl_tower* t, const pl_poly* a) {
  if (pl_poly_is_zero(t, a)) pl_tower_give_up(t);
  uint64_t key = pl_poly_hash(t, a);
  for (;; key += 2) {
    uint64_t found = pl_map_get(t->factored_of, key);
    if (!found) break;
    if (pl_poly_equal(t, t->factorings.at[found - 1].poly, a))
      return t->factorings.at[found - 1].factors;
  }
  pl_tower_check(t);
  pl_factored f = factor_now(t, a);
  f.unit = pl_int_keep(t, f.unit);
  pl_factoring known = {pl_poly_keep(t, a), f};
  pl_push(t->arena, t->factorings, known);
  pl_map_set(t->factored_of, key, (uint64_t)t->factorings.n);
  return f;
}

// ------------------------------------------------------------------------------- products of bases
const pl_poly* pl_factored_expand(pl_tower* t, pl_factored f) {
  const pl_poly* product = pl_poly_fmpz(t, f.unit);
  for (int i = 0; i < f.n; i++) {
    product = pl_poly_mul(t, product, pl_poly_pow(t, pl_base_poly(t, f.at[i].base), f.at[i].power));
  }
  return product;
}

static int* power_of(pl_collect* c, int base) {
  for (int i = 0; i < c->at.n; i++) {
    if (c->at.at[i].base == base) return &c->at.at[i].power;
  }
  return NULL;
}

// The power of a base that is exactly 1 + sign * gen, or NULL.
static int* power_of_one_plus(pl_collect* c, int gen, int sign) {
  pl_tower* t = c->t;
  const pl_poly* g = pl_poly_gen(t, gen);
  const pl_poly* one = pl_poly_int(t, 1);
  const pl_poly* f = sign > 0 ? pl_poly_add(t, one, g) : pl_poly_sub(t, one, g);
  for (int i = 0; i < c->at.n; i++) {
    if (pl_poly_equal(t, pl_base_poly(t, c->at.at[i].base), f))
      return power_of(c, c->at.at[i].base);
  }
  return NULL;
}

pl_factored pl_factored_merge_pairs(pl_tower* t, pl_factored f) {
  pl_collect c = {.t = t, .unit = pl_int_new(t)};
  fmpz_set(c.unit, f.unit);
  for (int i = 0; i < f.n; i++) collect(&c, f.at[i].base, f.at[i].power);
  int binomials = 0;
  for (int i = 0; i < c.at.n; i++) binomials += pl_base_poly(t, c.at.at[i].base)->length == 2;
  for (int g = 0; g < t->gens.n; g++) {
    if (t->gens.at[g].kind != PL_G_COS || binomials < 2) continue;
    int* minus = power_of_one_plus(&c, g, -1);
    int* plus = power_of_one_plus(&c, g, 1);
    if (!minus || !plus || (*minus > 0) != (*plus > 0)) continue;
    int both = *minus > 0 ? (*minus < *plus ? *minus : *plus) : (*minus > *plus ? *minus : *plus);
    *minus -= both;
    *plus -= both;
    collect(&c, pl_base_find(t, pl_poly_gen(t, t->gens.at[g].partner), false), 2 * both);
  }
  int n = 0;
  for (int i = 0; i < c.at.n; i++) {
    if (c.at.at[i].power) c.at.at[n++] = c.at.at[i];
  }
  c.at.n = n;
  return collected(&c);
}
