// energies: T, V and the generalized forces of a model, and the left-hand sides of Lagrange's
// equations
//   E_i = d/dt dL/dv_i - dL/dq_i - Q_i  =  sum_c lambda_c dg_c/dq_i.
// See theory (2.1), (2.4).
#include <string.h>

#include "mechanics/mechanics.h"

static void add_to(pl_analysis* d, pl_expr* sum, pl_expr term) {
  *sum = pl_add(d->pool, *sum, term);
}

static void masses(pl_analysis* d) {
  for (int k = 0; k < d->particle.n; k++) {
    const pl_particle* m = &d->particle.at[k];
    add_to(d, &d->T, pl_mass_kinetic(d->pool, m->mass, m->at, m->n));
    if (!pl_is_poison(m->angle)) add_to(d, &d->T, pl_body_kinetic(d->pool, m->inertia, m->angle));
    add_to(d, &d->V, pl_mass_weight(d->model, m->mass, m->at, m->n));
  }
}

// sqrt(r² sin² + r² cos²) of a polar map is r, with the assumption r >= 0 on record.
static pl_expr plain_distance(pl_analysis* d, pl_expr e) {
  pl_expr normal = pl_alg_normal(d->tower, e);
  if (pl_kind_of(d->pool, normal) != PL_CALL || pl_function_of(d->pool, normal) != PL_ABS) return e;
  pl_expr inside = pl_arg(d->pool, normal, 0);
  if (pl_kind_of(d->pool, inside) != PL_SYMBOL || pl_kind_of(d->pool, e) == PL_CALL) return e;
  pl_tower_use(d->tower, (pl_fact){inside, false});
  return inside;
}

// Distance of two points; on one line with a known order there are no bars.
static pl_expr distance(pl_analysis* d, const pl_point* a, const pl_point* b) {
  pl_expr squared, only;
  if (pl_points_apart(d->pool, a, b, &squared, &only) != 1)
    return plain_distance(d, pl_sqrt(d->pool, squared));
  int sign;
  if (pl_alg_sign(d->tower, only, true, &sign) == PL_YES)
    return sign < 0 ? pl_neg(d->pool, only) : only;
  return pl_call(d->pool, PL_ABS, only);
}

static bool has_rest(const pl_analysis* d, const pl_load* l) {
  return !pl_is_poison(l->rest) && !pl_is_zero_node(d->pool, l->rest);
}

static void spring(pl_analysis* d, const pl_load* l) {
  add_to(d, &d->V,
         pl_spring_energy(d->pool, l, has_rest(d, l) ? distance(d, &l->a, &l->b) : pl_poison()));
}

// A force on a point does the work F . dX.
static void force(pl_analysis* d, const pl_load* l) {
  for (int i = 0; i < d->q.n; i++) {
    for (int j = 0; j < l->a.n; j++) {
      pl_expr lever = pl_diff(d->pool, l->a.at[j], d->q.at[i].q);
      add_to(d, &d->force[i], pl_mul(d->pool, l->vector[j], lever));
    }
  }
  d->dissipative = true;
}

// ---------------------------------------------------------------------------- potentials of forces
// Q_i as functions of the coordinates alone, with equal mixed derivatives.
static bool is_curl_free(pl_analysis* d, const pl_expr* Q) {
  for (int i = 0; i < d->q.n; i++) {
    if (pl_has_role(d->pool, Q[i], PL_R_VELOCITY) || pl_has_role(d->pool, Q[i], PL_R_MULTIPLIER)
        || pl_has_symbol(d->pool, Q[i], pl_time(d->pool)))
      return false;
  }
  for (int i = 0; i < d->q.n; i++) {
    for (int k = 0; k < i; k++) {
      pl_expr a = pl_diff(d->pool, Q[i], d->q.at[k].q), b = pl_diff(d->pool, Q[k], d->q.at[i].q);
      if (!pl_same(a, b) && pl_alg_equal(d->tower, a, b) != PL_YES) return false;
    }
  }
  return true;
}

// Q homogeneous of degree n != -1:  V = -sum q_i Q_i/(n + 1)   (Euler).  Poison if it is not.
static pl_expr homogeneous_potential(pl_analysis* d, const pl_expr* Q) {
  pl_pool* p = d->pool;
  pl_expr degree = pl_poison(), work = pl_int(p, 0);
  for (int j = 0; j < d->q.n; j++) {
    if (pl_is_zero_node(p, Q[j])) continue;
    pl_expr grown = pl_int(p, 0);
    for (int i = 0; i < d->q.n; i++)
      grown = pl_add(p, grown, pl_mul(p, pl_sym(p, d->q.at[i].q), pl_diff(p, Q[j], d->q.at[i].q)));
    pl_expr n = pl_alg_normal(d->tower, pl_div(p, grown, Q[j]));
    if (pl_is_poison(n) || !pl_is_number(p, n) || (!pl_is_poison(degree) && !pl_same(n, degree)))
      return pl_poison();
    degree = n;
    work = pl_add(p, work, pl_mul(p, pl_sym(p, d->q.at[j].q), Q[j]));
  }
  if (pl_is_poison(degree)) return degree;
  pl_expr next = pl_add(p, degree, pl_int(p, 1));
  return pl_is_zero_node(p, next) ? pl_poison()
                                  : pl_alg_normal(d->tower, pl_neg(p, pl_div(p, work, next)));
}

// One coordinate after the other:  V = -∫ (Q_i + dV/dq_i) dq_i.
static pl_expr integrated_potential(pl_analysis* d, const pl_expr* Q) {
  pl_pool* p = d->pool;
  pl_expr V = pl_int(p, 0);
  for (int i = 0; i < d->q.n && !pl_is_poison(V); i++) {
    pl_expr rest = pl_alg_normal(d->tower, pl_add(p, Q[i], pl_diff(p, V, d->q.at[i].q)));
    if (!pl_is_zero_node(p, rest)) V = pl_sub(p, V, pl_alg_integral(d->tower, rest, d->q.at[i].q));
  }
  return V;
}

// The potential of the forces `load` adds, found from them; false when there is none.
static bool find_potential(pl_analysis* d, const pl_expr* before) {
  pl_pool* p = d->pool;
  pl_expr* Q = PL_ARRAY(d->arena, pl_expr, d->q.n + 1);
  bool any = false;
  for (int i = 0; i < d->q.n; i++) {
    Q[i] = pl_alg_normal(d->tower, pl_sub(p, d->force[i], before[i]));
    any |= !pl_is_zero_node(p, Q[i]);
  }
  if (!any || !is_curl_free(d, Q)) return false;
  pl_expr V = homogeneous_potential(d, Q);
  if (pl_is_poison(V)) V = integrated_potential(d, Q);
  if (pl_is_poison(V)) return false;
  for (int i = 0; i < d->q.n; i++) {
    if (pl_alg_is_zero(d->tower, pl_add(p, Q[i], pl_diff(p, V, d->q.at[i].q))) != PL_YES)
      return false;
  }
  for (int i = 0; i < d->q.n; i++) d->force[i] = before[i];
  add_to(d, &d->V, pl_alg_normal(d->tower, V));
  return true;
}

static void torque(pl_analysis* d, const pl_load* l) {
  for (int i = 0; i < d->q.n; i++) {
    pl_expr lever = l->coordinate.id ? pl_int(d->pool, l->coordinate.id == d->q.at[i].q.id)
                                     : pl_diff(d->pool, l->a.at[0], d->q.at[i].q);
    add_to(d, &d->force[i], pl_mul(d->pool, l->value, lever));
  }
  d->dissipative = true;
}

// A torque on a body in space works on its angular velocity: Q_i = vector . dω/dv_i.
static void couple(pl_analysis* d, const pl_load* l) {
  for (int i = 0; i < d->q.n; i++) {
    for (int k = 0; k < 3; k++) {
      pl_expr lever = pl_diff(d->pool, l->spin[k], d->q.at[i].v);
      add_to(d, &d->force[i], pl_mul(d->pool, l->vector[k], lever));
    }
  }
  d->dissipative = true;
}

// Rayleigh's dissipation function R: Q_i = -dR/dv_i.
static void dissipate(pl_analysis* d, pl_expr R) {
  for (int i = 0; i < d->q.n; i++)
    add_to(d, &d->force[i], pl_neg(d->pool, pl_diff(d->pool, R, d->q.at[i].v)));
  d->dissipative = true;
}

// A force that is the same everywhere has a potential.
static bool uniform(pl_analysis* d, const pl_load* l) {
  pl_expr V = pl_load_potential(d->pool, l);
  if (pl_is_poison(V)) return false;
  add_to(d, &d->V, V);
  return true;
}

// On one line the rate needs no absolute value, and no sign is assumed for it.
static void damper(pl_analysis* d, const pl_load* l) {
  pl_expr squared, only;
  bool line = pl_points_apart(d->pool, &l->a, &l->b, &squared, &only) == 1;
  dissipate(d, pl_load_dissipation(d->pool, l, line ? pl_poison() : distance(d, &l->a, &l->b)));
}

// A force or torque that depends on the place; it has a potential when the work does not depend on
// the way.
static void push(pl_analysis* d, const pl_load* l) {
  bool dissipative = d->dissipative;
  pl_expr* before = PL_ARRAY(d->arena, pl_expr, d->q.n + 1);
  for (int i = 0; i < d->q.n; i++) before[i] = d->force[i];
  if (l->kind == PL_L_FORCE) force(d, l);
  else if (l->kind == PL_L_COUPLE) couple(d, l);
  else torque(d, l);
  if (find_potential(d, before)) d->dissipative = dissipative;
}

static void load(pl_analysis* d, const pl_load* l) {
  switch (l->kind) {
    case PL_L_FORCE:
    case PL_L_COUPLE:
    case PL_L_TORQUE:
      if (!uniform(d, l)) push(d, l);
      break;
    case PL_L_POTENTIAL: add_to(d, &d->V, l->value); break;
    case PL_L_KINETIC: add_to(d, &d->T, l->value); break;
    case PL_L_LAGRANGIAN: add_to(d, &d->written, l->value); break;
    case PL_L_SPRING: spring(d, l); break;
    case PL_L_RAYLEIGH:
    case PL_L_DRAG: dissipate(d, pl_load_dissipation(d->pool, l, pl_poison())); break;
    case PL_L_DAMPER: damper(d, l); break;
  }
}

pleuel_status pl_energies(pl_analysis* d) {
  pl_pool* p = d->pool;
  d->T = d->V = d->written = pl_int(p, 0);
  d->force = PL_ARRAY(d->arena, pl_expr, d->q.n);
  d->euler = PL_ARRAY(d->arena, pl_expr, d->q.n);
  for (int i = 0; i < d->q.n; i++) d->force[i] = pl_int(p, 0);
  masses(d);
  for (int k = 0; k < d->model->loads.n; k++) load(d, &d->model->loads.at[k]);
  d->L = pl_add(p, d->written, pl_sub(p, d->T, d->V));
  for (int i = 0; i < d->q.n; i++) {
    pl_expr momentum = pl_dt(p, pl_diff(p, d->L, d->q.at[i].v));
    d->euler[i] = pl_sub(p, pl_sub(p, momentum, pl_diff(p, d->L, d->q.at[i].q)), d->force[i]);
    if (pl_is_poison(d->euler[i])) {
      return pl_fail(d->job, PLEUEL_UNSUPPORTED, "the Lagrange equation of %s cannot be formed",
                     pl_symbol_get(p, d->q.at[i].q)->ascii);
    }
  }
  return PLEUEL_OK;
}
