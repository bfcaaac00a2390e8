// second_kind: Lagrange's equations of the second kind, and the generalized forces in them.
#include "mechanics/mechanics.h"

// Q of generalized coordinate i: sum of Q_j dq_j/dq_i over the map.
static pl_expr generalized_force(pl_analysis* d, int i) {
  pl_expr sum = pl_on_maps(d, d->force[i]);
  for (int j = 0; j < d->q.n; j++) {
    const pl_variable* c = &d->q.at[j];
    if (c->fixed_by >= 0 || pl_is_poison(c->map) || pl_is_zero_node(d->pool, d->force[j])) continue;
    sum = pl_add(d->pool, sum,
                 pl_mul(d->pool, pl_on_maps(d, d->force[j]), pl_by_coordinate(d, c->map, i)));
  }
  return sum;
}

pl_expr pl_second_kind(pl_analysis* d, int i) {
  const pl_variable* c = &d->q.at[i];
  pl_expr momentum = pl_dt(d->pool, pl_diff(d->pool, d->Lg, c->v));
  // velocities of the coordinates that follow
  if (d->loops.n > 0) momentum = pl_on_maps(d, momentum);
  pl_expr e = pl_sub(d->pool, momentum, pl_by_coordinate(d, d->Lg, i));
  return pl_sub(d->pool, e, generalized_force(d, i));
}

// Is the generalized force along coordinate i not zero, so that a cyclic momentum is not conserved?
bool pl_pushed(pl_analysis* d, int i) {
  bool none = true;
  for (int j = 0; j < d->q.n; j++) none &= pl_is_zero_node(d->pool, d->force[j]);
  return !none && pl_alg_is_zero(d->tower, generalized_force(d, i)) != PL_YES;
}
