// at_start: what loses its meaning at the start of the run: constraints whose gradients become
// dependent there, and formulas whose
// denominator vanishes there.  Decided with the exact numbers of the model.
#include "mechanics/mechanics.h"

// e with the values of `init`, which may speak of each other, and the numbers of what is given.
static pl_expr at_start(pl_analysis* d, pl_expr e) {
  enum { rounds = 3 };
  for (int round = 0; round < rounds && pl_has_coordinates(d, e); round++) {
    for (int k = 0; k < d->model->inits.n; k++) {
      const pl_init* init = &d->model->inits.at[k];
      if (init->guess || pl_kind_of(d->pool, init->target) != PL_SYMBOL) continue;
      e = pl_subst1(d->pool, e, pl_symbol_of(d->pool, init->target), init->value);
    }
  }
  return pl_with_given_numbers(d, pl_subst1(d->pool, e, pl_time(d->pool), pl_int(d->pool, 0)));
}

// A contact takes part where it touches.
static bool takes_part(pl_analysis* d, const pl_bond* l) {
  if (l->implied || (l->fixes >= 0 && !l->contact)) return false;
  return !l->contact || pl_alg_is_zero(d->tower, at_start(d, l->g)) == PL_YES;
}

// The rank of the gradients at the start; -1 where their numbers are not known.
int pl_rank_at_start(pl_analysis* d, int* n_rows) {
  *n_rows = 0;
  if (d->g.n == 0 || d->model->inits.n == 0) return -1;
  int n = d->q.n, m = 0;
  pl_expr* A = PL_ARRAY(d->arena, pl_expr, d->g.n * n + 1);
  for (int k = 0; k < d->g.n; k++) {
    if (!takes_part(d, &d->g.at[k])) continue;
    for (int i = 0; i < n; i++) {
      pl_expr e = at_start(d, pl_on_fixed(d, d->g.at[k].gradient[i]));
      if (pl_is_poison(e) || !pl_is_constant(d->pool, e)) return -1;
      A[m * n + i] = e;
    }
    m++;
  }
  *n_rows = m;
  return pl_alg_rank(d->tower, m, n, A, NULL);
}

bool pl_divides_by_zero_at_start(pl_analysis* d, pl_expr e) {
  pl_expr top, bottom;
  if (pl_is_poison(e) || d->model->inits.n == 0) return false;
  pl_alg_fraction(d->tower, e, &top, &bottom);
  pl_expr there = at_start(d, bottom);
  return !pl_is_poison(there) && pl_is_constant(d->pool, there)
         && pl_alg_is_zero(d->tower, there) == PL_YES;
}
