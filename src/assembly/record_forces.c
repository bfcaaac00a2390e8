// Energies and forces of a model, group by group, as the simulation needs them: kinetic energy of
// masses and bodies, potentials of gravity and springs, generalized forces Q_i = F . dX/dq_i and
// Q_i = -dR/dv_i.
#include "assembly/assembly_impl.h"

static pl_record_group* group_of(pl_recorder* r, const pl_block* block) {
  for (int i = 0; i < r->groups.n; i++) {
    if (r->groups.at[i]->block == block) return r->groups.at[i];
  }
  return r->groups.at[0];
}

static void add_mass(pl_recorder* r, pl_record_group* g, pl_expr mass, const pl_point* at) {
  g->T = pl_add(r->pool, g->T, pl_mass_kinetic(r->pool, mass, at->at, at->n));
  g->V = pl_add(r->pool, g->V, pl_mass_weight(r->model, mass, at->at, at->n));
}

// Distance of two points; on one line it is |difference|.
static pl_expr distance(pl_recorder* r, const pl_point* a, const pl_point* b) {
  pl_expr squared, only;
  return pl_points_apart(r->pool, a, b, &squared, &only) == 1 ? pl_call(r->pool, PL_ABS, only)
                                                              : pl_sqrt(r->pool, squared);
}

static void add_potential(pl_recorder* r, pl_record_group* g, const pl_load* l) {
  pl_expr V = pl_load_potential(r->pool, l);
  if (pl_is_poison(V)) {
    r->dissipative = true;
  } else {
    g->V = pl_add(r->pool, g->V, V);
  }
}

static bool has_condition(const pl_model* m, const pl_spatial* b) {
  for (int i = 0; i < m->constraints.n; i++) {
    const pl_constraint* c = &m->constraints.at[i];
    if (c->body == b->name.text && c->block == b->block) return true;
  }
  return false;
}

// The energy of a turning quaternion knows nothing of the rate of |q|, so its matrix of masses is
// singular along q. 2 J (q·q')², with J the mean moment, makes it regular, and for a ball a
// multiple of 1; where |q| = 1 it is zero with all that it adds to the equations, so that neither
// motion nor multiplier changes.
static pl_expr steady_length(pl_recorder* r, const pl_spatial* b) {
  pl_pool* p = r->pool;
  pl_expr rate = pl_int(p, 0),
          J = pl_add(p, b->inertia[0], pl_add(p, b->inertia[3], b->inertia[5]));
  for (int i = 0; i < 4; i++) rate = pl_add(p, rate, pl_mul(p, b->axes[i], pl_dt(p, b->axes[i])));
  return pl_mul_n(p, (pl_expr[]){pl_ratio(p, 2, 3), J, pl_square(p, rate)}, 3);
}

void pl_group_energies(pl_recorder* r) {
  const pl_model* m = r->model;
  for (int i = 0; i < m->masses.n; i++)
    add_mass(r, group_of(r, m->masses.at[i].block), m->masses.at[i].mass, &m->masses.at[i].point);
  for (int i = 0; i < m->bodies.n; i++) {
    const pl_body* b = &m->bodies.at[i];
    pl_record_group* g = group_of(r, b->block);
    add_mass(r, g, b->mass, &b->centre);
    g->T = pl_add(r->pool, g->T, pl_body_kinetic(r->pool, b->inertia, b->angle));
  }
  for (int i = 0; i < m->spatials.n; i++) {
    const pl_spatial* b = &m->spatials.at[i];
    pl_record_group* g = group_of(r, b->block);
    if (b->form == PL_AXES_QUATERNION && has_condition(m, b))
      g->T = pl_add(r->pool, g->T, steady_length(r, b));
  }
  for (int i = 0; i < m->loads.n; i++) {
    const pl_load* l = &m->loads.at[i];
    pl_record_group* g = group_of(r, l->block);
    switch (l->kind) {
      case PL_L_POTENTIAL:
      case PL_L_FORCE:
      case PL_L_TORQUE: add_potential(r, g, l); break;
      case PL_L_KINETIC: g->T = pl_add(r->pool, g->T, l->value); break;
      case PL_L_LAGRANGIAN: g->L = pl_add(r->pool, g->L, l->value); break;
      case PL_L_SPRING:
        g->V = pl_add(r->pool, g->V, pl_spring_energy(r->pool, l, distance(r, &l->a, &l->b)));
        break;
      case PL_L_RAYLEIGH:
      case PL_L_DAMPER:
      case PL_L_DRAG:
      case PL_L_COUPLE: r->dissipative = true; break;
    }
  }
}

// ------------------------------------------------------------------------------------------ forces
static pl_expr by_atom(pl_pool* p, pl_expr e, pl_expr atom) {
  return pl_kind_of(p, atom) == PL_SYMBOL ? pl_diff(p, e, pl_symbol_of(p, atom))
                                          : pl_diff_at(p, e, atom);
}

static void add_force(pl_recorder* r, pl_record_group* g, int i, pl_expr Q) {
  g->force[i] = pl_is_poison(g->force[i]) ? Q : pl_add(r->pool, g->force[i], Q);
}

// Rayleigh's dissipation function R: Q_i = -dR/dv_i.
static void dissipate(pl_recorder* r, pl_record_group* g, pl_expr R) {
  for (int i = 0; i < g->atoms.n; i++) {
    pl_expr Q = pl_neg(r->pool, by_atom(r->pool, R, pl_dt(r->pool, g->atoms.at[i])));
    if (!pl_is_zero_node(r->pool, Q)) add_force(r, g, i, Q);
  }
}

static void work(pl_recorder* r, pl_record_group* g, const pl_expr* force, const pl_expr* at,
                 int n) {
  for (int i = 0; i < g->atoms.n; i++) {
    for (int j = 0; j < n; j++) {
      pl_expr Q = pl_mul(r->pool, force[j], by_atom(r->pool, at[j], g->atoms.at[i]));
      if (!pl_is_zero_node(r->pool, Q)) add_force(r, g, i, Q);
    }
  }
}

// A torque works on the angular velocity: Q_i = vector . dω/dv_i.
static void twist(pl_recorder* r, pl_record_group* g, const pl_load* l) {
  for (int i = 0; i < g->atoms.n; i++) {
    pl_expr v = pl_dt(r->pool, g->atoms.at[i]);
    for (int j = 0; j < 3; j++) {
      pl_expr Q = pl_mul(r->pool, l->vector[j], by_atom(r->pool, l->spin[j], v));
      if (!pl_is_zero_node(r->pool, Q)) add_force(r, g, i, Q);
    }
  }
}

static void add_load(pl_recorder* r, pl_record_group* g, const pl_load* l) {
  pl_pool* p = r->pool;
  if (!pl_is_poison(pl_load_potential(p, l))) return;  // among the potentials
  switch (l->kind) {
    case PL_L_FORCE: work(r, g, l->vector, l->a.at, l->a.n); break;
    case PL_L_COUPLE: twist(r, g, l); break;
    case PL_L_TORQUE: {
      pl_expr angle = l->coordinate.id ? pl_sym(p, l->coordinate) : l->a.at[0];
      work(r, g, &l->value, &angle, 1);
      break;
    }
    case PL_L_RAYLEIGH:
    case PL_L_DAMPER:
    case PL_L_DRAG:
      dissipate(r, g,
                pl_load_dissipation(
                    p, l, l->kind == PL_L_DAMPER ? distance(r, &l->a, &l->b) : pl_poison()));
      break;
    case PL_L_POTENTIAL:
    case PL_L_KINETIC:
    case PL_L_LAGRANGIAN:
    case PL_L_SPRING: break;
  }
}

void pl_group_forces(pl_recorder* r, pl_record_group* g) {
  // the coordinates that loads speak of
  for (int i = 0; i < r->model->loads.n; i++) {
    const pl_load* l = &r->model->loads.at[i];
    if (group_of(r, l->block) != g) continue;
    pl_group_atoms(r, g, l->value);
    if (l->coordinate.id) pl_group_atoms(r, g, pl_sym(r->pool, l->coordinate));
    for (int j = 0; j < 3; j++) pl_group_atoms(r, g, l->vector[j]);
    for (int j = 0; j < 3; j++) pl_group_atoms(r, g, l->spin[j]);
    for (int j = 0; j < l->a.n; j++) pl_group_atoms(r, g, l->a.at[j]);
    for (int j = 0; j < l->b.n; j++) pl_group_atoms(r, g, l->b.at[j]);
  }
  g->force = PL_ARRAY(r->arena, pl_expr, g->atoms.n);
  for (int i = 0; i < r->model->loads.n; i++) {
    if (group_of(r, r->model->loads.at[i].block) == g) add_load(r, g, &r->model->loads.at[i]);
  }
}
