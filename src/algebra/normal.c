// Normal forms: one reduced fraction, its factors, its coefficients in a symbol or in an atom of
// the tower.
#include "algebra/tower.h"

#include <stdlib.h>
#include <string.h>

// ------------------------------------------------------------------------------------ one fraction
typedef struct pl_normal_job {
  pl_expr e, out, num, den;
} pl_normal_job;

static void normal_body(pl_tower* t, void* data) {
  pl_normal_job* j = data;
  pl_frac f = pl_convert(t, j->e);
  pl_frac upper = f, lower = pl_frac_int(t, 1);
  upper.n = 0;
  upper.unit = lower.unit;
  lower.n = f.n;
  lower.den = f.den;
  lower.unit = f.unit;
  j->out = pl_frac_expr(t, f);
  pl_convert_known(t, j->out, f);
  j->num = pl_frac_expr(t, upper);
  j->den = pl_div(t->pool, pl_int(t->pool, 1), pl_frac_expr(t, lower));
  if (pl_is_poison(j->out) || pl_is_poison(j->num) || pl_is_poison(j->den)) pl_tower_give_up(t);
}

// Zero once the names that stand for other quantities are seen through: g - a with a := g.
static bool vanishes_when_seen(pl_tower* t, pl_expr e) {
  pl_expr seen = pl_tower_see(t, e);
  if (pl_same(seen, e) || pl_is_poison(seen)) return false;
  pl_normal_job j = {.e = seen};
  return pl_tower_run(t, normal_body, &j) && pl_is_zero_node(t->pool, j.out);
}

pl_expr pl_alg_normal(pl_tower* t, pl_expr e) {
  if (pl_is_poison(e)) return e;
  pl_normal_job j = {.e = e};
  if (!pl_tower_run(t, normal_body, &j)) return e;
  return vanishes_when_seen(t, j.out) ? pl_int(t->pool, 0) : j.out;
}

void pl_alg_fraction(pl_tower* t, pl_expr e, pl_expr* num, pl_expr* den) {
  pl_normal_job j = {.e = e};
  *num = e;
  *den = pl_int(t->pool, 1);
  if (pl_is_poison(e) || !pl_tower_run(t, normal_body, &j)) return;
  *num = j.num;
  *den = j.den;
}

// ----------------------------------------------------------------------------------------- factors
typedef struct pl_factors_job {
  pl_expr e;
  pl_factor* out;
  int max, n;
  pl_expr unit;
} pl_factors_job;

static void put_factors(pl_tower* t, pl_factors_job* j, pl_factored f, int times) {
  for (int i = 0; i < f.n; i++) {
    if (j->n == j->max) pl_tower_give_up(t);
    j->out[j->n++] = (pl_factor){pl_base_expr(t, f.at[i].base), times * f.at[i].power};
  }
}

static void factors_body(pl_tower* t, void* data) {
  pl_factors_job* j = data;
  j->n = 0;
  pl_frac f = pl_convert(t, j->e);
  if (pl_frac_is_zero(t, f)) {
    j->unit = pl_int(t->pool, 0);
    return;
  }
  pl_factored num = pl_factored_merge_pairs(t, pl_poly_factor(t, f.num));
  pl_factored den = pl_factored_merge_pairs(t,
                                            (pl_factored){.unit = f.unit, .n = f.n, .at = f.den});
  put_factors(t, j, num, 1);
  put_factors(t, j, den, -1);
  j->unit = pl_fmpq_expr(t, num.unit, den.unit);
}

typedef struct pl_sort_key {
  long size;
  const char* text;
  pl_factor factor;
} pl_sort_key;

static int compare_keys(const void* a, const void* b) {
  const pl_sort_key *x = a, *y = b;
  if (x->size != y->size) return x->size < y->size ? -1 : 1;
  return strcmp(x->text, y->text);
}

// Small ones first, then by text: an order that does not depend on history.
static void sort_factors(pl_tower* t, pl_factor* f, int n) {
  pl_sort_key* keys = PL_ARRAY(t->arena, pl_sort_key, n + 1);
  for (int i = 0; i < n; i++) {
    keys[i] = (pl_sort_key){pl_op_count(t->pool, f[i].base),
                            pl_expr_text(t->arena, t->pool, f[i].base), f[i]};
  }
  qsort(keys, (size_t)n, sizeof *keys, compare_keys);
  for (int i = 0; i < n; i++) f[i] = keys[i].factor;
}

int pl_alg_factors(pl_tower* t, pl_expr e, pl_factor* out, int max, pl_expr* unit) {
  pl_factors_job j = {.e = e, .out = out, .max = max};
  if (!pl_is_poison(e) && pl_tower_run(t, factors_body, &j)) {
    sort_factors(t, out, j.n);
    if (unit) *unit = j.unit;
    return j.n;
  }
  if (unit) *unit = pl_int(t->pool, 1);
  if (max < 1 || pl_is_poison(e)) return 0;
  out[0] = (pl_factor){e, 1};
  return 1;
}

// ------------------------------------------------------------------------------------ coefficients
typedef struct pl_coefficients_job {
  pl_expr e, atom;
  pl_symbol x;
  pl_expr* out;
  int max, degree;
} pl_coefficients_job;

static bool depends(pl_tower* t, const pl_poly* f, int gen, pl_symbol x) {
  for (int g = 0; g < t->gens.n; g++) {
    if (g != gen && pl_poly_degree(t, f, g) > 0 && pl_gen_contains(t, g, x)) return true;
  }
  return false;
}

static void put_coefficients(pl_tower* t, pl_coefficients_job* j, pl_frac f, const pl_poly* num,
                             int gen) {
  int degree = 0;
  const pl_poly** c = pl_poly_coefficients(t, num, gen, &degree);
  if (degree > j->max) return;
  for (int k = 0; k <= degree; k++) j->out[k] = pl_frac_expr(t, pl_frac_over(t, c[k], f));
  j->degree = degree;
}

static void coefficients_body(pl_tower* t, void* data) {
  pl_coefficients_job* j = data;
  j->degree = -1;
  int gen = pl_convert(t, j->atom).num->length ? pl_tower_find(t, j->atom) : -1;
  pl_frac f = pl_convert(t, j->e);
  if (gen < 0 || depends(t, f.num, gen, j->x)) return;
  for (int i = 0; i < f.n; i++) {
    const pl_poly* base = pl_base_poly(t, f.den[i].base);
    if (pl_poly_degree(t, base, gen) > 0 || depends(t, base, gen, j->x)) return;
  }
  put_coefficients(t, j, f, f.num, gen);
}

int pl_alg_coefficients(pl_tower* t, pl_expr e, pl_symbol x, pl_expr* coefficient, int max_degree) {
  pl_coefficients_job j = {
      .e = e, .x = x, .atom = pl_sym(t->pool, x), .out = coefficient, .max = max_degree};
  if (pl_is_poison(e) || max_degree < 0 || !pl_tower_run(t, coefficients_body, &j)) return -1;
  return j.degree;
}

static void atom_body(pl_tower* t, void* data) {
  pl_coefficients_job* j = data;
  j->degree = -1;
  pl_frac atom = pl_convert(t, j->atom);
  pl_frac f = pl_convert(t, j->e);
  if (atom.n > 0 || !fmpz_is_one(atom.unit)) return;
  int gen = -1;
  for (int g = 0; g < t->gens.n; g++) {
    if (pl_poly_equal(t, atom.num, pl_poly_gen(t, g))) gen = g;
  }
  if (gen < 0) return;
  const pl_poly* num = f.num;
  if (t->gens.at[gen].kind == PL_G_SIN || t->gens.at[gen].kind == PL_G_COSH)
    num = pl_poly_view(t, num, t->gens.at[gen].partner);
  for (int i = 0; i < f.n; i++) {
    if (pl_poly_degree(t, pl_base_poly(t, f.den[i].base), gen) > 0) return;
  }
  put_coefficients(t, j, f, num, gen);
}

int pl_alg_coefficients_atom(pl_tower* t, pl_expr e, pl_expr atom, pl_expr* coefficient,
                             int max_degree) {
  pl_coefficients_job j = {.e = e, .atom = atom, .out = coefficient, .max = max_degree};
  if (pl_is_poison(e) || pl_is_poison(atom) || max_degree < 0 || !pl_tower_run(t, atom_body, &j))
    return -1;
  return j.degree;
}
