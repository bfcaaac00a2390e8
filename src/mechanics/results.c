// results: names of results in a formula, T, V, E, force(label), and what they stand for.
#include <string.h>

#include "mechanics/mechanics.h"

// E(0), λ(0): on the motion, and there at its start.
static pl_expr start_of_result(pl_analysis* d, const pl_result_name* r) {
  pl_expr e = pl_on_motion(d, pl_with_results(d, r->of));
  pl_replace* start = PL_ARRAY(d->arena, pl_replace, 2 * d->q.n + 1);
  pl_motion init = {0};
  int n = 0;
  for (int k = 0; k < d->q.n; k++) {
    const pl_variable* c = &d->q.at[k];
    pl_expr q0, v0;
    pl_motion_start(d, &init, c, &q0, &v0);
    start[n++] = (pl_replace){c->q, q0};
    start[n++] = (pl_replace){c->v, v0};
  }
  start[n++] = (pl_replace){pl_time(d->pool), pl_int(d->pool, 0)};
  return pl_subst(d->pool, e, start, n);
}

// What a `lagrangian` says is split by degree in the velocities: its part of degree 0 is a
// potential with the other sign, and
// that of degree 2 is kinetic.
static pl_expr written_potential(pl_analysis* d) {
  pl_replace* rest = PL_ARRAY(d->arena, pl_replace, d->q.n + 1);
  for (int i = 0; i < d->q.n; i++) rest[i] = (pl_replace){d->q.at[i].v, pl_int(d->pool, 0)};
  return pl_neg(d->pool, pl_subst(d->pool, d->written, rest, d->q.n));
}

static pl_expr written_kinetic(pl_analysis* d) {
  pl_expr sum = pl_neg(d->pool, d->written);
  for (int i = 0; i < d->q.n; i++) {
    pl_symbol v = d->q.at[i].v;
    sum = pl_add(d->pool, sum,
                 pl_mul(d->pool, pl_sym(d->pool, v), pl_diff(d->pool, d->written, v)));
  }
  return pl_alg_normal(d->tower, pl_sub(d->pool, sum, written_potential(d)));
}

static pl_expr result_value(pl_analysis* d, const pl_result_name* r) {
  switch (r->kind) {
    case PL_RES_T: return pl_add(d->pool, d->T, written_kinetic(d));
    case PL_RES_V: return pl_add(d->pool, d->V, written_potential(d));
    case PL_RES_L: return d->L;
    case PL_RES_E:
      if (!pl_scleronomic(d)
          && pl_is_zero_node(d->pool, pl_sub(d->pool, d->L, pl_sub(d->pool, d->T, d->V)))) {
        return pl_add(d->pool, d->T, d->V);  // the integral is Jacobi's then
      }
      return pl_energy_integral(d);
    case PL_RES_H: return pl_energy_integral(d);
    case PL_RES_DT: return pl_dt(d->pool, pl_on_maps(d, pl_with_results(d, r->of)));
    case PL_RES_DIFF: return pl_diff(d->pool, pl_on_maps(d, pl_with_results(d, r->of)), r->by);
    case PL_RES_START: return start_of_result(d, r);
    case PL_RES_FORCE:
    case PL_RES_FORCE_NORM:
    case PL_RES_NORMAL: break;
  }
  for (int k = 0; k < d->g.n; k++) {
    const pl_bond* l = &d->g.at[k];
    if (!r->label || strcmp(l->source->name.text, r->label) != 0) continue;
    pl_expr scale = pl_force_scale(d, k);
    if (pl_is_poison(scale)) return scale;
    pl_expr size = pl_mul(d->pool, scale, pl_sym(d->pool, l->lambda));
    return r->kind == PL_RES_NORMAL && l->source->relation == PL_LE ? pl_neg(d->pool, size)
           : r->kind == PL_RES_NORMAL && l->source->relation == PL_GE
               ? size
               : pl_call(d->pool, PL_ABS, size);
  }
  for (int k = 0; k < d->open.n; k++) {
    if (r->label && strcmp(d->open.at[k].source->name.text, r->label) == 0)
      return pl_int(d->pool, 0);
  }
  return pl_poison();
}

pl_expr pl_with_results(pl_analysis* d, pl_expr e) {
  for (int k = 0; k < d->model->result_names.n; k++) {
    const pl_result_name* r = &d->model->result_names.at[k];
    if (pl_has_symbol(d->pool, e, r->symbol))
      e = pl_subst1(d->pool, e, r->symbol, result_value(d, r));
  }
  return e;
}
