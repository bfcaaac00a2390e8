// Back from the tower: polynomials and fractions as expressions. A polynomial is written in the
// view with the fewest terms (m1 + m2 sin^2, not m1 + m2 - m2 cos^2), a denominator as its factors,
// with (1 - c)(1 + c) as s^2.
#include "algebra/tower.h"

#include <string.h>

pl_expr pl_fmpz_expr(pl_tower* t, const fmpz* c) {
  if (fmpz_fits_si(c)) return pl_int(t->pool, fmpz_get_si(c));
  char* text = PL_ARRAY(t->arena, char, fmpz_sizeinbase(c, 10) + 2);
  fmpz_get_str(text, 10, c);
  return pl_number_from_text(t->pool, text, strlen(text));
}

pl_expr pl_fmpq_expr(pl_tower* t, const fmpz* num, const fmpz* den) {
  return pl_div(t->pool, pl_fmpz_expr(t, num), pl_fmpz_expr(t, den));
}

static pl_expr term_expr(pl_tower* t, const pl_poly* a, slong i) {
  ulong exponent[PL_MAX_GENERATORS];
  pl_expr factors[PL_MAX_GENERATORS + 1];
  int n = 0;
  fmpz_mpoly_get_term_exp_ui(exponent, a, i, &t->ctx);
  factors[n++] = pl_fmpz_expr(t, &a->coeffs[i]);
  for (int g = 0; g < t->gens.n; g++) {
    if (exponent[g]) factors[n++] = pl_pow_int(t->pool, t->gens.at[g].expr, (long)exponent[g]);
  }
  return pl_mul_n(t->pool, factors, n);
}

static pl_expr expanded(pl_tower* t, const pl_poly* a) {
  if (a->length == 0) return pl_int(t->pool, 0);
  if (a->length > PL_MAX_WRITTEN_TERMS) pl_tower_give_up(t);
  pl_tower_charge(t, PL_WORK_OF_WRITTEN_TERM * a->length);
  pl_expr* terms = PL_ARRAY(t->arena, pl_expr, a->length);
  for (slong i = 0; i < a->length; i++) terms[i] = term_expr(t, a, i);
  return pl_add_n(t->pool, terms, (int)a->length);
}

pl_expr pl_poly_expr(pl_tower* t, const pl_poly* a) {
  return expanded(t, pl_poly_shortest_view(t, a));
}

static pl_expr den_expr(pl_tower* t, pl_frac a) {
  pl_factored f = pl_factored_merge_pairs(t, (pl_factored){.unit = a.unit, .n = a.n, .at = a.den});
  pl_expr product = pl_fmpz_expr(t, f.unit);
  for (int i = 0; i < f.n; i++) {
    product = pl_mul(t->pool, product,
                     pl_pow_int(t->pool, pl_base_expr(t, f.at[i].base), f.at[i].power));
  }
  return product;
}

pl_expr pl_frac_expr(pl_tower* t, pl_frac a) {
  return pl_div(t->pool, pl_poly_expr(t, a.num), den_expr(t, a));
}
