// loads: the physics of masses and loads, once for the derivation and the simulation. Kinetic
// energy m v²/2, weight, springs, dissipation functions of dampers and drag, and the potential of a
// force that is the same everywhere.
#include "model/model_impl.h"

static pl_expr half(pl_pool* p, pl_expr a, pl_expr b) {
  return pl_mul_n(p, (pl_expr[]){pl_ratio(p, 1, 2), a, b}, 3);
}

static pl_expr squared_speed(pl_pool* p, const pl_expr* at, int n) {
  pl_expr sum = pl_int(p, 0);
  for (int j = 0; j < n; j++) sum = pl_add(p, sum, pl_square(p, pl_dt(p, at[j])));
  return sum;
}

pl_expr pl_mass_kinetic(pl_pool* p, pl_expr mass, const pl_expr* at, int n) {
  return half(p, mass, squared_speed(p, at, n));
}

pl_expr pl_body_kinetic(pl_pool* p, pl_expr inertia, pl_expr angle) {
  return half(p, inertia, pl_square(p, pl_dt(p, angle)));
}

pl_expr pl_mass_weight(const pl_model* m, pl_expr mass, const pl_expr* at, int n) {
  pl_pool* p = m->pool;
  pl_expr V = pl_int(p, 0);
  for (int j = 0; j < m->gravities.n; j++) {
    const pl_gravity* g = &m->gravities.at[j];
    if (g->axis >= n) continue;
    V = pl_add(p, V, pl_mul_n(p, (pl_expr[]){pl_int(p, -g->sign), mass, g->g, at[g->axis]}, 4));
  }
  return V;
}

// --------------------------------------------------------------------------------------- distances
int pl_points_apart(pl_pool* p, const pl_point* a, const pl_point* b, pl_expr* squared,
                    pl_expr* only) {
  int n = 0;
  *squared = *only = pl_int(p, 0);
  for (int j = 0; j < a->n; j++) {
    pl_expr difference = pl_sub(p, a->at[j], b->at[j]);
    if (pl_is_zero_node(p, difference)) continue;
    *squared = pl_add(p, *squared, pl_square(p, difference));
    *only = difference;
    n++;
  }
  return n;
}

pl_expr pl_spring_energy(pl_pool* p, const pl_load* l, pl_expr length) {
  pl_expr squared, only;
  bool relaxed_at_zero = pl_is_poison(l->rest) || pl_is_zero_node(p, l->rest);
  if (relaxed_at_zero) {
    pl_points_apart(p, &l->a, &l->b, &squared, &only);
  } else {
    squared = pl_square(p, pl_sub(p, length, l->rest));
  }
  return half(p, l->value, squared);
}

pl_expr pl_load_dissipation(pl_pool* p, const pl_load* l, pl_expr length) {
  pl_expr squared, only;
  switch (l->kind) {
    case PL_L_RAYLEIGH: return l->value;
    case PL_L_DRAG: return half(p, l->value, squared_speed(p, l->a.at, l->a.n));
    case PL_L_DAMPER: {  // on one line no absolute value is needed
      int n = pl_points_apart(p, &l->a, &l->b, &squared, &only);
      return half(p, l->value, pl_square(p, pl_dt(p, n == 1 ? only : length)));
    }
    default: return pl_poison();
  }
}

// --------------------------------------------------------------------------------- constant forces
// The same everywhere and always: names that are given, nothing that moves.
static bool is_uniform(pl_pool* p, pl_expr e) {
  static const pl_role moving[] = {PL_R_COORD,      PL_R_VELOCITY, PL_R_ACCELERATION,
                                   PL_R_MULTIPLIER, PL_R_START,    PL_R_LOCAL};
  for (size_t k = 0; k < sizeof moving / sizeof *moving; k++) {
    if (pl_has_role(p, e, moving[k])) return false;
  }
  return !pl_has_symbol(p, e, pl_time(p));
}

pl_expr pl_load_potential(pl_pool* p, const pl_load* l) {
  if (l->kind == PL_L_POTENTIAL) return l->value;
  pl_expr V = pl_int(p, 0);
  if (l->kind == PL_L_FORCE) {
    for (int j = 0; j < l->a.n; j++) {
      if (!is_uniform(p, l->vector[j])) return pl_poison();
      V = pl_sub(p, V, pl_mul(p, l->vector[j], l->a.at[j]));
    }
    return V;
  }
  if (l->kind != PL_L_TORQUE || !is_uniform(p, l->value)) return pl_poison();
  return pl_sub(p, V,
                pl_mul(p, l->value, l->coordinate.id ? pl_sym(p, l->coordinate) : l->a.at[0]));
}
