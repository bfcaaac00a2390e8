// branch_points: positions where a constraint does not determine the coordinate that it was solved
// for: dg/dx = 0 on the map. There the rank
// of the constraints drops, the mechanism may branch (a crank whose rod is as long as the crank),
// and formulas divide by zero.
#include "mechanics/mechanics.h"

// g is the constraint as it was solved, with the coordinates inserted that others had given before:
// as it
// stands in the model it may not contain x.
pl_expr pl_branch_slope_squared(pl_analysis* d, int i) {
  const pl_variable* c = &d->q.at[i];
  if (c->solved_by < 0 || !c->by_branch || pl_is_poison(c->solved_slope)) return pl_poison();
  return pl_alg_normal(d->tower, pl_square(d->pool, pl_on_maps(d, c->solved_slope)));
}

bool pl_map_fails_at(pl_analysis* d, const pl_replace* at, int n) {
  for (int i = 0; i < d->q.n; i++) {
    pl_expr square = pl_branch_slope_squared(d, i);
    if (pl_is_poison(square)) continue;
    pl_expr there = pl_alg_normal(d->tower, pl_subst(d->pool, square, at, n));
    if (pl_alg_is_zero(d->tower, there) == PL_YES || pl_vanishes_at_numbers(d, there)) return true;
  }
  return false;
}
