// Torques and energies have one dimension and two units, N m and J.  A given quantity is in N m
// where its unit was written so, where it is a torque, and where it is what a torsion spring has in
// front of squares of angles: V = 1/2 k φ².
#include <string.h>

#include "model/model_impl.h"

static bool is_energy(const pl_model* m, pl_symbol s) {
  const pl_symbol_info* info = pl_symbol_get(m->pool, s);
  return info->dimension_known && pl_dimension_equal(info->dimension, pl_dimension_of(2, 1, -2));
}

static bool is_pure(const pl_model* m, pl_symbol s) {
  const pl_symbol_info* info = pl_symbol_get(m->pool, s);
  return info->dimension_known && pl_dimension_equal(info->dimension, pl_dimension_one());
}

// Of degree two at most in the angles of the model, and of degree zero in no case.
static bool is_square_of_angles(const pl_model* m, pl_expr e) {
  bool any = false;
  for (int i = 0; i < m->coords.n; i++) {
    pl_symbol q = m->coords.at[i].symbol;
    if (!pl_has_symbol(m->pool, e, q)) continue;
    pl_expr twice = pl_diff(m->pool, pl_diff(m->pool, e, q), q);
    if (!is_pure(m, q) || pl_has_symbol(m->pool, twice, q)) return false;
    any = true;
  }
  return any;
}

static bool is_of_spring(const pl_model* m, pl_symbol s) {
  for (int i = 0; i < m->loads.n; i++) {
    const pl_load* l = &m->loads.at[i];
    if (l->kind != PL_L_POTENTIAL && l->kind != PL_L_LAGRANGIAN) continue;
    if (!pl_has_symbol(m->pool, l->value, s)) continue;
    return is_square_of_angles(m, pl_diff(m->pool, l->value, s));
  }
  return false;
}

static bool is_a_torque(const pl_model* m, pl_symbol s) {
  for (int i = 0; i < m->loads.n; i++) {
    const pl_load* l = &m->loads.at[i];
    if (l->kind == PL_L_TORQUE && pl_same(l->value, pl_sym(m->pool, s))) return true;
    for (int j = 0; l->kind == PL_L_COUPLE && j < 3; j++) {
      if (pl_same(l->vector[j], pl_sym(m->pool, s))) return true;
    }
  }
  return false;
}

void pl_find_torques(pl_model* m) {
  for (int i = 0; i < m->params.n; i++) {
    const pl_param* p = &m->params.at[i];
    if (!p->symbol.id || !is_energy(m, p->symbol)) continue;
    pl_symbol_get(m->pool, p->symbol)->torque = p->unit_text ? strchr(p->unit_text, 'N') != NULL
                                                             : is_a_torque(m, p->symbol)
                                                                   || is_of_spring(m, p->symbol);
  }
}
