// insert: expressions with what is known inserted: fixed coordinates, closed contacts, maps,
// accelerations and multipliers; and the
// dimension of an expression.
#include "mechanics/mechanics.h"

int pl_variable_index(const pl_analysis* d, pl_symbol s) {
  for (int i = 0; i < d->q.n; i++) {
    const pl_variable* c = &d->q.at[i];
    if (c->q.id == s.id || c->v.id == s.id || c->a.id == s.id) return i;
  }
  return -1;
}

bool pl_has_coordinates(const pl_analysis* d, pl_expr e) {
  return pl_has_role(d->pool, e, PL_R_COORD) || pl_has_role(d->pool, e, PL_R_VELOCITY)
         || pl_has_role(d->pool, e, PL_R_ACCELERATION);
}

pl_expr pl_on_fixed(pl_analysis* d, pl_expr e) {
  return pl_subst(d->pool, e, d->fixed.at, d->fixed.n);
}

pl_expr pl_on_contact(pl_analysis* d, pl_expr e) {
  return pl_subst(d->pool, pl_on_fixed(d, e), d->contact.at, d->contact.n);
}

pl_expr pl_on_maps(pl_analysis* d, pl_expr e) {
  e = pl_on_contact(d, e);
  return d->reduced ? pl_subst(d->pool, e, d->maps.at, d->maps.n) : e;
}

pl_expr pl_open_removed(pl_analysis* d, pl_expr e) {
  for (int k = 0; k < d->open.n; k++) {
    pl_symbol lambda = d->open.at[k].source->lambda;
    if (lambda.id && pl_has_symbol(d->pool, e, lambda))
      e = pl_subst1(d->pool, e, lambda, pl_int(d->pool, 0));
  }
  return e;
}

pl_expr pl_on_motion(pl_analysis* d, pl_expr e) {
  e = pl_on_maps(d, pl_open_removed(d, e));
  pl_replace* r = PL_ARRAY(d->arena, pl_replace, d->q.n + d->g.n);
  int n = 0;
  for (int i = 0; i < d->q.n; i++) {
    if (!pl_is_poison(d->acceleration[i])) r[n++] = (pl_replace){d->q.at[i].a, d->acceleration[i]};
  }
  for (int k = 0; k < d->g.n; k++) {
    if (d->g.at[k].lambda_known) r[n++] = (pl_replace){d->g.at[k].lambda, d->g.at[k].lambda_value};
  }
  return pl_subst(d->pool, e, r, n);
}

// -------------------------------------------------------------------------- dimensions of formulas
static pl_dimension dimension_of(pl_analysis* d, pl_expr e, bool* known);

static pl_dimension dimension_of_product(pl_analysis* d, pl_expr e, bool* known) {
  pl_dimension dim = pl_dimension_one();
  for (int i = 0; i < pl_n_args(d->pool, e); i++) {
    dim = pl_dimension_mul(dim, dimension_of(d, pl_arg(d->pool, e, i), known));
  }
  return dim;
}

static pl_dimension dimension_of(pl_analysis* d, pl_expr e, bool* known) {
  switch (pl_kind_of(d->pool, e)) {
    case PL_SYMBOL: {
      const pl_symbol_info* info = pl_symbol_get(d->pool, pl_symbol_of(d->pool, e));
      if (!info->dimension_known) *known = false;
      return info->dimension_known ? info->dimension : pl_dimension_one();
    }
    case PL_ADD: {  // of the first term that is not a bare number
      pl_expr term = pl_arg(d->pool, e, 0);
      for (int i = 0; i < pl_n_args(d->pool, e) && pl_is_constant(d->pool, term); i++)
        term = pl_arg(d->pool, e, i);
      return dimension_of(d, term, known);
    }
    case PL_MUL: return dimension_of_product(d, e, known);
    case PL_POW: {
      long num, den;
      if (!pl_is_ratio(d->pool, pl_arg(d->pool, e, 1), &num, &den)) return pl_dimension_one();
      return pl_dimension_pow(dimension_of(d, pl_arg(d->pool, e, 0), known), (int)num, (int)den);
    }
    case PL_CALL: {
      pl_function f = pl_function_of(d->pool, e);
      bool keeps = f == PL_ABS || f == PL_MIN || f == PL_MAX;
      return keeps ? dimension_of(d, pl_arg(d->pool, e, 0), known) : pl_dimension_one();
    }
    case PL_IF: {  // of the branch that is not a bare number
      pl_expr then = pl_arg(d->pool, e, 1);
      return dimension_of(d, pl_is_constant(d->pool, then) ? pl_arg(d->pool, e, 2) : then, known);
    }
    default: return pl_dimension_one();
  }
}

pl_dimension pl_dimension_of_expr(pl_analysis* d, pl_expr e, bool* known) {
  bool all = true;
  pl_dimension dim = dimension_of(d, e, &all);
  if (known) *known = all;
  return dim;
}
