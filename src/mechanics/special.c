// special: given numbers for which a general formula has no value, resonance, critical damping,
// equal masses. What vanishes there is
// solved for one given quantity, which is inserted: the formula of the special case follows as any
// other one. Decided exactly, with
// the numbers as they were written.
#include "mechanics/mechanics.h"

enum { max_factors = 16 };

// A base of a negative power that vanishes for the given numbers, in nodes that were not looked at
// yet.
static bool pole_in(pl_analysis* d, pl_expr e, pl_map* seen, pl_expr* base) {
  pl_pool* p = d->pool;
  if (pl_n_args(p, e) == 0 || pl_map_get(seen, e.id)) return false;
  pl_map_set(seen, e.id, 1);
  if (pl_kind_of(p, e) == PL_POW) {
    pl_expr exponent = pl_arg(p, e, 1);
    bool divides = pl_is_number(p, exponent) && pl_number_sign(p, exponent) < 0;
    *base = pl_arg(p, e, 0);
    if (divides && pl_vanishes_at_numbers(d, *base)) return true;
  }
  for (int k = 0; k < pl_n_args(p, e); k++) {
    if (pole_in(d, pl_arg(p, e, k), seen, base)) return true;
  }
  return false;
}

bool pl_pole_at_numbers(pl_analysis* d, pl_expr e, pl_expr* base) {
  return !pl_is_poison(e) && d->model->params.n > 0 && pole_in(d, e, pl_map_make(d->arena), base);
}

// factor = 0 solved for x, which then has its given number.
static pl_expr solved_for(pl_analysis* d, pl_expr factor, pl_symbol x, bool linear) {
  pl_root root[8];
  bool complete;
  pl_expr c[2];
  if (linear) {
    bool fits = pl_alg_coefficients(d->tower, factor, x, c, 1) == 1
                && !pl_vanishes_at_numbers(d, c[1]);
    return fits ? pl_alg_normal(d->tower, pl_neg(d->pool, pl_div(d->pool, c[0], c[1])))
                : pl_poison();
  }
  int n = pl_alg_roots(d->tower, factor, x, root, 8, &complete);
  for (int k = 0; k < n; k++) {
    bool real = pl_is_poison(root[k].condition);
    if (real && pl_vanishes_at_numbers(d, pl_sub(d->pool, root[k].value, pl_sym(d->pool, x))))
      return root[k].value;
  }
  return pl_poison();
}

// Masses and gravity are what others are told through.
static bool is_basic(const pl_analysis* d, pl_symbol x) {
  pl_class class = pl_symbol_get(d->pool, x)->class;
  return class == PL_C_MASS || class == PL_C_GRAVITY;
}

static void add_special(pl_analysis* d, pl_symbol x, pl_expr value) {
  pl_replace r = {x, value};
  for (int j = 0; j < d->special.n; j++)
    d->special.at[j].to = pl_subst(d->pool, d->special.at[j].to, &r, 1);
  pl_push(d->arena, d->special, r);
}

static bool has_number(const pl_param* given) { return !pl_is_poison(given->value); }

// Several conditions at once, k1 = k2 and c = 0: one that the numbers fulfil is taken, and the
// others show next.
static bool take_coincidence(pl_analysis* d, pl_expr factor) {
  const pl_model* m = d->model;
  for (int k = m->params.n - 1; k >= 0; k--) {
    pl_symbol x = m->params.at[k].symbol;
    if (!has_number(&m->params.at[k]) || !pl_has_symbol(d->pool, factor, x)) continue;
    for (int j = 0; j <= k; j++) {  // another one with the same number, then 0
      pl_expr other = j < k ? pl_sym(d->pool, m->params.at[j].symbol) : pl_int(d->pool, 0);
      bool there = j == k
                   || (has_number(&m->params.at[j])
                       && pl_has_symbol(d->pool, factor, m->params.at[j].symbol));
      if (!there || !pl_vanishes_at_numbers(d, pl_sub(d->pool, pl_sym(d->pool, x), other)))
        continue;
      add_special(d, x, other);
      return true;
    }
  }
  return false;
}

static bool solve_factor(pl_analysis* d, pl_expr factor) {
  for (int pass = 0; pass < 4; pass++) {  // linear before roots, others before masses
    for (int k = d->model->params.n - 1; k >= 0; k--) {
      const pl_param* given = &d->model->params.at[k];
      if (pl_is_poison(given->value) || !pl_has_symbol(d->pool, factor, given->symbol)
          || is_basic(d, given->symbol) != (pass % 2))
        continue;
      pl_expr value = solved_for(d, factor, given->symbol, pass < 2);
      if (pl_is_poison(value)) continue;
      add_special(d, given->symbol, value);
      return true;
    }
  }
  return take_coincidence(d, factor);
}

bool pl_find_special(pl_analysis* d, pl_expr e) {
  enum { most = 4 };
  pl_factor factor[max_factors];
  pl_expr unit;
  e = pl_on_special(d, e);
  if (d->special.n >= most || !pl_vanishes_at_numbers(d, e)) return false;
  int n = pl_alg_factors(d->tower, e, factor, max_factors, &unit);
  for (int k = 0; k < n; k++) {
    if (factor[k].power > 0 && pl_vanishes_at_numbers(d, factor[k].base)
        && solve_factor(d, factor[k].base))
      return true;
  }
  return false;
}

pl_expr pl_on_special(pl_analysis* d, pl_expr e) {
  return d->special.n == 0
             ? e
             : pl_alg_normal(d->tower, pl_subst(d->pool, e, d->special.at, d->special.n));
}

// --------------------------------------------------------------------------------- of all requests
static bool divides_by_zero(pl_analysis* d, pl_expr e) {
  pl_expr base;
  d->special.n = 0;
  if (!pl_pole_at_numbers(d, e, &base) || !pl_find_special(d, base)) return false;
  for (int k = 0; k < d->special.n; k++) pl_push(d->arena, d->cases, d->special.at[k]);
  d->special.n = 0;
  return true;
}

bool pl_find_case(pl_analysis* d) {
  enum { most = 3 };
  if (!d->solved || d->cases.n >= most) return false;
  for (int i = 0; i < d->q.n; i++) {
    if (divides_by_zero(d, d->acceleration[i])) return true;
  }
  for (int k = 0; k < d->g.n; k++) {
    if (d->g.at[k].lambda_known && divides_by_zero(d, d->g.at[k].lambda_value)) return true;
  }
  return false;
}
