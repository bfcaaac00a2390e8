// The most readable form of a fraction n/d: the smallest of
//   the form of n over the forms of the factors of d;
//   the same with square roots absorbed, (A - B w)^k / w^k = (A/w - B)^k;
//   the sum of the parts of n by some class of symbols, each cancelled against d on its own.
#include "present/present_impl.h"

#include <string.h>

enum { MAX_PARTS = 8, MAX_SPLIT_TERMS = 150 };

const pl_poly* pl_group_poly(pl_present_search* s, const pl_term_group* g) {
  pl_tower* t = s->t;
  pl_poly* key = pl_poly_new(t);
  fmpz_mpoly_set_coeff_si_ui(key, 1, g->key, &t->ctx);
  return pl_poly_mul_free(t, key, g->coefficient);
}

pl_frac pl_frac_part(pl_present_search* s, pl_frac f, const pl_poly* part) {
  if (f.n == 0 && fmpz_is_one(f.unit)) return pl_frac_poly(s->t, part);
  s->work += 2;
  return pl_frac_make(s->t, part, pl_frac_den(s->t, f));
}

// ------------------------------------------------------------------------------------ denominators
// The radicand that this base is: its root generator, or -1. l² - r² sin²φ beside √(l² - r² sin²φ).
static int root_of_base(pl_present_search* s, const pl_poly* base) {
  pl_tower* t = s->t;
  for (int g = 0; g < t->gens.n; g++) {
    const pl_gen* w = &t->gens.at[g];
    if (w->kind == PL_G_ROOT && w->degree == 2 && pl_poly_equal(t, w->value, base)) return g;
  }
  return -1;
}

static pl_prod denominator(pl_present_search* s, pl_frac f, int depth, bool as_roots) {
  pl_factored den = pl_factored_merge_pairs(s->t,
                                            (pl_factored){.unit = f.unit, .n = f.n, .at = f.den});
  pl_prod d = pl_prod_number(s, pl_fmpz_expr(s->t, den.unit));
  for (int i = 0; i < den.n; i++) {
    const pl_poly* base = pl_base_poly(s->t, den.at[i].base);
    int w = as_roots ? root_of_base(s, base) : -1;
    pl_prod x = w >= 0 ? pl_prod_of_gen(s, w, 2) : pl_present_poly(s, base, depth);
    d = pl_prod_mul(s, d, pl_prod_pow(s, x, den.at[i].power));
  }
  return d;
}

// ---------------------------------------------------------------------------------- roots absorbed
static int power_of_gen(pl_prod x, int gen) {
  for (int i = 0; i < x.n; i++)
    if (x.at[i].gen == gen) return x.at[i].power;
  return 0;
}

// (sum)^k with every term divided by w.
static pl_prod divided_sum(pl_present_search* s, const pl_piece* piece, int w) {
  const pl_sum_terms* sum = piece->sum;
  pl_prod* terms = PL_ARRAY(s->a, pl_prod, sum->n);
  for (int i = 0; i < sum->n; i++) terms[i] = pl_prod_mul(s, sum->at[i], pl_prod_of_gen(s, w, -1));
  return pl_prod_pow(s, pl_prod_sum(s, terms, sum->n), piece->power);
}

static bool sum_contains(const pl_piece* piece, int w) {
  for (int i = 0; piece->sum && i < piece->sum->n; i++)
    if (power_of_gen(piece->sum->at[i], w) > 0) return true;
  return false;
}

static pl_prod absorb_root(pl_present_search* s, pl_prod x, int w) {
  for (int i = 0; i < x.n; i++) {
    int k = x.at[i].power;
    if (k < 1 || !sum_contains(&x.at[i], w) || power_of_gen(x, w) > -k) continue;
    pl_prod inside = divided_sum(s, &x.at[i], w);
    pl_prod rest = pl_prod_mul(s, x, pl_prod_piece(s, x.at[i], -k));
    return pl_prod_mul(s, pl_prod_mul(s, rest, pl_prod_of_gen(s, w, k)), inside);
  }
  return x;
}

static pl_prod absorb_roots(pl_present_search* s, pl_prod x) {
  for (int w = 0; w < s->t->gens.n; w++)
    if (s->t->gens.at[w].kind == PL_G_ROOT && power_of_gen(x, w) < 0) x = absorb_root(s, x, w);
  return x;
}

// The numerator with a factor w taken out for a radicand w² that is in the denominator.
static bool cancel_root(pl_present_search* s, pl_frac f, pl_prod den, int depth, pl_prod* out) {
  for (int i = 0; i < f.n; i++) {
    int w = root_of_base(s, pl_base_poly(s->t, f.den[i].base));
    const pl_poly* rest;
    if (w < 0 || !pl_poly_root_divides(s, f.num, w, &rest)) continue;
    pl_prod n = pl_prod_mul(s, pl_present_poly(s, rest, depth), pl_prod_of_gen(s, w, 1));
    *out = absorb_roots(s, pl_prod_mul(s, n, den));
    return true;
  }
  return false;
}

// ------------------------------------------------------------------------------------------- parts
static bool cancels(pl_frac whole, pl_frac part) {
  long before = 0, after = 0;
  for (int i = 0; i < whole.n; i++) before += whole.den[i].power;
  for (int i = 0; i < part.n; i++) after += part.den[i].power;
  return after < before;
}

// The sum of the parts of f by the generators of one class, if at least one of them cancels.
static bool split(pl_present_search* s, pl_frac f, pl_key_set set, int depth, pl_prod* out) {
  bool in[PL_MAX_GENERATORS] = {false};
  pl_key_mask(s, set, in);
  pl_term_group* groups;
  int n = pl_poly_group(s, f.num, in, &groups);
  if (n < 2 || n > MAX_PARTS) return false;
  pl_frac part[MAX_PARTS];
  bool any = false;
  for (int i = 0; i < n; i++) {
    part[i] = pl_frac_part(s, f, pl_group_poly(s, &groups[i]));
    any |= cancels(f, part[i]);
  }
  if (!any) return false;
  pl_prod terms[MAX_PARTS * PL_OPENED_TERMS];
  int n_terms = 0;
  for (int i = 0; i < n; i++)
    pl_terms_put(s, pl_present_quotient(s, part[i], depth - 1), terms, &n_terms);
  *out = pl_prod_sum(s, terms, n_terms);
  return true;
}

// -------------------------------------------------------------------------------------- whole part
// The generators and numbers that divide the numerator, in *outside, and the one factor that is
// left; NULL if there are several.
static const pl_poly* split_content(pl_present_search* s, const pl_poly* num, pl_prod* outside) {
  pl_tower* t = s->t;
  pl_factored f = pl_poly_factor(t, num);
  const pl_poly* rest = NULL;
  *outside = pl_prod_number(s, pl_fmpz_expr(t, f.unit));
  for (int i = 0; i < f.n; i++) {
    int gen = t->bases.at[f.at[i].base].gen;
    if (gen >= 0) *outside = pl_prod_mul(s, *outside, pl_prod_of_gen(s, gen, f.at[i].power));
    else if (rest || f.at[i].power != 1) return NULL;
    else rest = pl_base_poly(t, f.at[i].base);
  }
  return rest;
}

// Term i of a over term j of b, if it is an integer times a monomial; NULL.
static const pl_poly* term_ratio(pl_present_search* s, const pl_poly* a, slong i, const pl_poly* b,
                                 slong j) {
  pl_tower* t = s->t;
  ulong x[PL_MAX_GENERATORS] = {0}, y[PL_MAX_GENERATORS] = {0};
  if (!fmpz_divisible(&a->coeffs[i], &b->coeffs[j])) return NULL;
  fmpz_mpoly_get_term_exp_ui(x, a, i, &t->ctx);
  fmpz_mpoly_get_term_exp_ui(y, b, j, &t->ctx);
  for (int g = 0; g < t->gens.n; g++) {
    if (x[g] < y[g]) return NULL;
    x[g] -= y[g];
  }
  fmpz* c = pl_int_new(t);
  fmpz_divexact(c, &a->coeffs[i], &b->coeffs[j]);
  pl_poly* q = pl_poly_new(t);
  fmpz_mpoly_push_term_fmpz_ui(q, c, x, &t->ctx);
  return q;
}

enum { MAX_DIVIDED_TERMS = 12 };

// (D - 2 B)/D = 1 - 2 B/D: the one-term multiple of the denominator that leaves the least of the
// numerator stands by itself.
static bool whole_part(pl_present_search* s, pl_frac f, int depth, pl_prod* out) {
  pl_tower* t = s->t;
  pl_prod outside;
  const pl_poly* num = split_content(s, f.num, &outside);
  const pl_poly* den = pl_factored_expand(
      t, (pl_factored){.unit = pl_poly_int(t, 1)->coeffs, .n = f.n, .at = f.den});
  if (!num || num->length < 3 || den->length < 3 || num->length > MAX_DIVIDED_TERMS
      || den->length > MAX_DIVIDED_TERMS)
    return false;
  const pl_poly *q = NULL, *rest = num;
  for (slong k = 0; k < num->length * den->length; k++) {
    const pl_poly* ratio = term_ratio(s, num, k / den->length, den, k % den->length);
    const pl_poly* left = ratio ? pl_poly_sub(t, num, pl_poly_mul(t, ratio, den)) : num;
    s->work += ratio != NULL;
    if (left->length < rest->length) {
      q = ratio;
      rest = left;
    }
  }
  if (!q || rest->length == 0) return false;
  pl_prod terms[2] = {pl_present_poly(s, q, 0),
                      pl_present_quotient(s, pl_frac_over(t, rest, f), depth - 1)};
  terms[0] = pl_prod_scale(s, terms[0], pl_fmpq_expr(t, pl_poly_int(t, 1)->coeffs, f.unit));
  *out = pl_prod_mul(s, outside, pl_prod_sum(s, terms, 2));
  return true;
}

// ------------------------------------------------------------------------------------- reciprocals
// m1 m2 m3/(m1 m2 + m1 m3 + m2 m3) = 1/(1/m1 + 1/m2 + 1/m3), m2 m3/(...) = 1/(m1/m2 + m1/m3 + 1),
// for three terms and more: of two masses one writes the product over the sum.
static bool reciprocals(pl_present_search* s, pl_frac f, pl_prod whole, pl_prod* out) {
  pl_tower* t = s->t;
  const pl_poly* den = f.n == 1 && f.den[0].power == 1 ? pl_base_poly(t, f.den[0].base) : NULL;
  if (!den || den->length < 3 || den->length > 6 || f.num->length != 1) return false;
  pl_prod taken = pl_prod_number(s, pl_int(s->p, 1));
  for (int i = 0; i < whole.n; i++) {
    const pl_piece* m = &whole.at[i];
    if (m->power == 1 && m->gen >= 0 && m->bucket == PL_K_MASS)
      taken = pl_prod_mul(s, taken, pl_prod_piece(s, *m, 1));
  }
  if (taken.n < 2) return false;
  int use[PL_MAX_GENERATORS], n_use = 0;
  pl_poly_used(t, den, use, &n_use);
  for (int i = 0; i < n_use; i++)
    // cos²α/m is no ratio of masses
    if (pl_piece_of_gen(s, use[i]).bucket != PL_K_MASS) return false;
  pl_prod under = pl_prod_pow(s, taken, -1), terms[6];
  ulong exponent[PL_MAX_GENERATORS];
  for (slong i = 0; i < den->length; i++) {
    fmpz_mpoly_get_term_exp_ui(exponent, den, i, &t->ctx);
    terms[i] = pl_prod_mul(s, pl_prod_of_exponents(s, pl_fmpz_expr(t, &den->coeffs[i]), exponent),
                           under);
  }
  pl_prod above = pl_prod_mul(s, pl_present_poly(s, f.num, 0), under);
  pl_prod below = pl_prod_scale(s, pl_prod_sum(s, terms, (int)den->length),
                                pl_fmpz_expr(t, f.unit));
  *out = pl_prod_mul(s, above, pl_prod_pow(s, below, -1));
  return true;
}

static pl_prod smaller(pl_prod x, pl_prod y) { return y.cost < x.cost ? y : x; }

pl_prod pl_present_quotient(pl_present_search* s, pl_frac f, int depth) {
  pl_prod n = pl_present_poly(s, f.num, depth);
  pl_prod best = pl_prod_tidy(
      s, pl_prod_mul(s, n, pl_prod_pow(s, denominator(s, f, depth, false), -1)));
  if (f.n == 0) return best;
  pl_prod root_den = pl_prod_pow(s, denominator(s, f, depth, true), -1);
  pl_prod rooted = pl_prod_mul(s, n, root_den), cancelled;
  best = smaller(best, rooted);
  if (cancel_root(s, f, root_den, depth, &cancelled)) best = smaller(best, cancelled);
  best = smaller(best, absorb_roots(s, rooted));
  pl_prod inverted;
  if (reciprocals(s, f, n, &inverted)) best = smaller(best, inverted);
  if (depth < 1 || f.num->length > MAX_SPLIT_TERMS || f.num->length < 2) return best;
  static const pl_key_set sets[] = {PL_KEY_MASS, PL_KEY_MOTION, PL_KEY_GRAVITY, PL_KEY_OTHER,
                                    PL_KEY_ROOT};
  for (size_t i = 0; i < sizeof sets / sizeof *sets && s->work < s->limit; i++) {
    pl_prod x;
    if (split(s, f, sets[i], depth, &x)) best = smaller(best, x);
  }
  pl_prod divided;
  if (s->style == PL_S_QUOTIENT && f.num->length >= 3 && s->work < s->limit
      && whole_part(s, f, depth, &divided))
    best = smaller(best, divided);
  return best;
}
