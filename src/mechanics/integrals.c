// eliminate: velocities along a given motion, by the energy integral. One generalized coordinate q,
// E(q, q') conserved and quadratic in q': q'^2 follows from E(q, q') = E(q0, q0').
// See theory (6.4).
#include <math.h>

#include "mechanics/mechanics.h"

bool pl_scleronomic(pl_analysis* d) {
  pl_symbol t = pl_time(d->pool);
  if (pl_has_symbol(d->pool, d->L, t)) return false;
  for (int k = 0; k < d->g.n; k++) {
    if (!d->g.at[k].implied && pl_has_symbol(d->pool, d->g.at[k].g, t)) return false;
  }
  for (int k = 0; k < d->maps.n; k++) {
    if (pl_has_symbol(d->pool, d->maps.at[k].to, t)) return false;
  }
  return true;
}

bool pl_nonholonomic(const pl_analysis* d) {
  for (int k = 0; k < d->g.n; k++) {
    if (d->g.at[k].velocity) return true;
  }
  return false;
}

// A constraint linear in the velocities does no work when it is homogeneous: A(q) v = 0.
static bool works(pl_analysis* d) {
  pl_replace* zero = PL_ARRAY(d->arena, pl_replace, d->q.n + 1);
  for (int i = 0; i < d->q.n; i++) zero[i] = (pl_replace){d->q.at[i].v, pl_int(d->pool, 0)};
  for (int k = 0; k < d->g.n; k++) {
    if (d->g.at[k].velocity
        && pl_alg_is_zero(d->tower, pl_subst(d->pool, d->g.at[k].g, zero, d->q.n)) != PL_YES)
      return true;
  }
  return false;
}

// E = sum v dL/dv - L: the energy T + V when everything is scleronomic, else Jacobi's integral.
pl_expr pl_energy_integral(pl_analysis* d) {
  pl_expr L = d->reduced ? d->Lg : pl_on_contact(d, d->L);
  pl_expr sum = pl_neg(d->pool, L);
  for (int i = 0; i < d->q.n; i++) {
    pl_expr v = pl_sym(d->pool, d->q.at[i].v);
    sum = pl_add(d->pool, sum, pl_mul(d->pool, v, pl_diff(d->pool, L, d->q.at[i].v)));
  }
  return pl_alg_normal(d->tower, sum);
}

// The power of the forces without potential vanishes: a force across the velocity, as of a magnetic
// field.
static bool powerless(pl_analysis* d) {
  pl_expr power = pl_int(d->pool, 0);
  for (int i = 0; i < d->q.n; i++)
    power = pl_add(d->pool, power, pl_mul(d->pool, d->force[i], pl_sym(d->pool, d->q.at[i].v)));
  return pl_alg_is_zero(d->tower, pl_on_maps(d, power)) == PL_YES;
}

bool pl_dissipates(pl_analysis* d) { return d->dissipative && !powerless(d); }

// A function of (q, t) whose total time derivative is e = sum a_i v_i + b, by integration along one
// coordinate after the other; poison
// where there is none, or none was found. There is one when the Lagrange equations of e vanish
// identically.
static pl_expr primitive(pl_analysis* d, pl_expr e) {
  pl_pool* p = d->pool;
  pl_expr G = pl_int(p, 0);
  for (int k = 0; k < d->gen.n; k++) {
    const pl_variable* c = &d->q.at[d->gen.at[k]];
    pl_expr euler = pl_sub(p, pl_dt(p, pl_diff(p, e, c->v)), pl_diff(p, e, c->q));
    if (pl_alg_is_zero(d->tower, euler) != PL_YES) return pl_poison();
  }
  pl_expr rest = e;
  for (int k = 0; k < d->gen.n; k++) {
    const pl_variable* c = &d->q.at[d->gen.at[k]];
    pl_expr part = pl_alg_integral(d->tower, pl_alg_normal(d->tower, pl_diff(p, rest, c->v)), c->q);
    if (pl_is_poison(part)) return part;
    G = pl_add(p, G, part);
    rest = pl_alg_normal(d->tower, pl_sub(p, rest, pl_dt(p, part)));
  }
  if (pl_has_coordinates(d, rest)) return pl_poison();
  pl_expr part = pl_is_zero_node(p, rest) ? rest : pl_alg_integral(d->tower, rest, pl_time(p));
  return pl_add(p, G, part);
}

// dh/dt = -∂L/∂t for h = sum v ∂L/∂v - L.  Where ∂L/∂t is the total derivative of G,
// h + G is conserved. theory (6.1), [Arnold1989, sec. 20]
static pl_expr conserved_integral(pl_analysis* d) {
  if (pl_dissipates(d) || works(d)) return pl_poison();
  if (!d->reduced) return pl_scleronomic(d) ? pl_energy_integral(d) : pl_poison();
  pl_expr by_time = pl_alg_normal(d->tower, pl_by_coordinate(d, d->Lg, -1));
  if (pl_is_zero_node(d->pool, by_time)) return pl_energy_integral(d);
  return d->loops.n > 0 ? pl_poison()
                        : pl_alg_normal(d->tower, pl_add(d->pool, pl_energy_integral(d),
                                                         primitive(d, by_time)));
}

bool pl_energy_conserved(pl_analysis* d) { return !pl_is_poison(conserved_integral(d)); }

pl_expr pl_jacobi_integral(pl_analysis* d) { return conserved_integral(d); }

// One that contains t does not give velocities from a place.
pl_expr pl_conserved_energy(pl_analysis* d) {
  pl_expr E = conserved_integral(d);
  return !pl_is_poison(E) && pl_has_symbol(d->pool, E, pl_time(d->pool)) ? pl_poison() : E;
}

// ------------------------------------------------------------------------------------------ starts
pl_expr pl_start_value(pl_analysis* d, pl_symbol s) {
  for (int k = 0; k < d->model->inits.n; k++) {
    const pl_init* init = &d->model->inits.at[k];
    if (init->guess || !pl_same(init->target, pl_sym(d->pool, s))) continue;
    if (pl_is_zero_node(d->pool, init->value) && pl_symbol_get(d->pool, s)->role == PL_R_VELOCITY)
      return init->value;
    if (!pl_is_constant(d->pool, init->value)) return init->value;
  }
  return pl_sym(d->pool, pl_symbol_start(d->pool, s));
}

// Where a coordinate starts: a zero of `init` is inserted too.
static pl_expr start_place(pl_analysis* d, pl_symbol q) {
  for (int k = 0; k < d->model->inits.n; k++) {
    const pl_init* init = &d->model->inits.at[k];
    if (!init->guess && pl_same(init->target, pl_sym(d->pool, q))
        && pl_is_zero_node(d->pool, init->value))
      return init->value;
  }
  return pl_start_value(d, q);
}

// The value that `from` gives for s; poison if it does not speak of it.
static pl_expr from_value(pl_analysis* d, const pl_motion* motion, pl_symbol s) {
  for (int k = 0; k < motion->n_from; k++) {
    const pl_condition* c = &motion->from[k];
    if (pl_same(c->left, pl_sym(d->pool, s))) return c->right;
    if (pl_same(c->right, pl_sym(d->pool, s))) return c->left;
  }
  return pl_poison();
}

void pl_motion_start(pl_analysis* d, const pl_motion* motion, const pl_variable* c, pl_expr* q0,
                     pl_expr* v0) {
  *q0 = *v0 = pl_poison();
  if (motion->given) {
    *q0 = from_value(d, motion, c->q);
    *v0 = motion->at_rest ? pl_int(d->pool, 0) : from_value(d, motion, c->v);
  }
  if (pl_is_poison(*q0)) *q0 = start_place(d, c->q);
  if (pl_is_poison(*v0)) *v0 = pl_start_value(d, c->v);
}

bool pl_velocity_squared(pl_analysis* d, const pl_motion* motion, pl_expr* v2, pl_expr* start_q,
                         pl_expr* start_v) {
  if (!d->reduced || d->gen.n != 1) return false;
  pl_expr E = pl_conserved_energy(d);
  if (pl_is_poison(E)) return false;
  const pl_variable* c = &d->q.at[d->gen.at[0]];
  pl_expr coefficient[3];
  if (pl_alg_coefficients(d->tower, E, c->v, coefficient, 2) != 2) return false;
  if (!pl_is_zero_node(d->pool, coefficient[1])) return false;
  pl_motion_start(d, motion, c, start_q, start_v);
  pl_replace start[2] = {{c->q, *start_q}, {c->v, *start_v}};
  pl_expr left = pl_sub(d->pool, pl_subst(d->pool, E, start, 2), coefficient[0]);
  *v2 = pl_alg_normal(d->tower, pl_div(d->pool, left, coefficient[2]));
  return !pl_is_poison(*v2);
}

// e with q'^2 inserted: even powers of q' become rational; an odd one stays as a root.
pl_expr pl_without_velocity(pl_analysis* d, pl_expr e, pl_expr v2) {
  pl_symbol v = d->q.at[d->gen.at[0]].v;
  pl_expr c[9];
  int n = pl_alg_coefficients(d->tower, e, v, c, 8);
  if (n < 0) return pl_alg_normal(d->tower, pl_subst1(d->pool, e, v, pl_sqrt(d->pool, v2)));
  pl_expr sum = pl_int(d->pool, 0);
  for (int k = 0; k <= n; k++) {
    pl_expr power = pl_pow_int(d->pool, v2, k / 2);
    if (k % 2) power = pl_mul(d->pool, power, pl_sqrt(d->pool, v2));
    sum = pl_add(d->pool, sum, pl_mul(d->pool, c[k], power));
  }
  return pl_alg_normal(d->tower, sum);
}

// Is the start an equilibrium: at rest with vanishing acceleration?
pl_answer3 pl_starts_in_equilibrium(pl_analysis* d, pl_expr q0, pl_expr v0) {
  if (!d->solved || d->gen.n != 1 || !pl_is_zero_node(d->pool, v0)) return PL_NO;
  int i = d->gen.at[0];
  pl_replace start[2] = {{d->q.at[i].q, q0}, {d->q.at[i].v, v0}};
  return pl_alg_is_zero(d->tower, pl_subst(d->pool, d->acceleration[i], start, 2));
}
