// setup: what moves, what is heavy, what constrains; then the constraints of the form coordinate =
// constant or f(t), which
// are inserted and dropped (theorem T101: their multipliers remain available, see solve_motion.c).
#include <math.h>
#include <string.h>

#include "mechanics/propose.h"

// ----------------------------------------------------------------------------------- what there is
static void add_coordinates(pl_analysis* d) {
  for (int k = 0; k < d->model->coords.n; k++) {
    pl_variable c = {.q = d->model->coords.at[k].symbol, .fixed_by = -1, .solved_by = -2};
    c.follows = pl_follows_by_constraint(d, c.q);
    c.v = pl_symbol_dot(d->pool, c.q);
    c.a = pl_symbol_dot(d->pool, c.v);
    pl_symbol_start(d->pool, c.q);
    pl_symbol_start(d->pool, c.v);
    pl_push(d->arena, d->q, c);
  }
  for (int k = 0; k < d->model->choose.coords.n; k++) {
    int i = pl_variable_index(d, d->model->choose.coords.at[k]);
    if (i >= 0) d->q.at[i].chosen = true;
  }
}

static void add_particles(pl_analysis* d) {
  for (int k = 0; k < d->model->masses.n; k++) {
    const pl_mass* m = &d->model->masses.at[k];
    pl_particle p = {
        .label = m->name.text, .ascii = m->name.ascii, .mass = m->mass, .n = m->point.n};
    memcpy(p.at, m->point.at, sizeof p.at);
    pl_push(d->arena, d->particle, p);
  }
  for (int k = 0; k < d->model->bodies.n; k++) {
    const pl_body* b = &d->model->bodies.at[k];
    pl_particle p = {.label = b->name.text,
                     .ascii = b->name.ascii,
                     .mass = b->mass,
                     .inertia = b->inertia,
                     .angle = b->angle,
                     .n = b->centre.n};
    memcpy(p.at, b->centre.at, sizeof p.at);
    pl_push(d->arena, d->particle, p);
  }
}

// Where coordinate q starts: 0 if that is what init says, else the symbol q(0).
static pl_expr start_place(pl_analysis* d, pl_symbol q) {
  for (int k = 0; k < d->model->inits.n; k++) {
    const pl_init* init = &d->model->inits.at[k];
    if (!init->guess && pl_same(init->target, pl_sym(d->pool, q))
        && pl_is_zero_node(d->pool, init->value))
      return init->value;
  }
  return pl_start_value(d, q);
}

// Linear in the velocities with constant coefficients, s' - R φ' = 0: the integral s - R φ with the
// constant of the start, which
// restricts positions.  Poison for all others.
static pl_expr integrated(pl_analysis* d, const pl_constraint* c) {
  pl_expr sum = pl_int(d->pool, 0), rest = c->g;
  for (int i = 0; i < d->q.n; i++) {
    pl_expr slope = pl_diff(d->pool, c->g, d->q.at[i].v), q = pl_sym(d->pool, d->q.at[i].q);
    if (pl_has_coordinates(d, slope) || pl_has_symbol(d->pool, slope, pl_time(d->pool)))
      return pl_poison();
    // surfaces that stick may do so from a later moment on
    pl_expr from = c->sticking ? pl_sym(d->pool, pl_symbol_start(d->pool, d->q.at[i].q))
                               : start_place(d, d->q.at[i].q);
    pl_expr way = pl_sub(d->pool, q, from);
    sum = pl_add(d->pool, sum, pl_mul(d->pool, slope, way));
    rest = pl_subst1(d->pool, rest, d->q.at[i].v, pl_int(d->pool, 0));
  }
  if (pl_has_coordinates(d, rest) || pl_has_symbol(d->pool, rest, pl_time(d->pool)))
    return pl_poison();
  return pl_add(d->pool, sum, pl_mul(d->pool, rest, pl_sym(d->pool, pl_time(d->pool))));
}

// What slips on a constraint feels -way press scale λ along the slip.
static void add_friction(pl_analysis* d, pl_bond* l) {
  l->push = l->gradient;
  l->rub = pl_slipping_on(d, l->source);
  if (!l->rub) return;
  int sign = -l->rub->way * l->rub->press * (d->model->lambda_minus ? -1 : 1);
  l->push = PL_ARRAY(d->arena, pl_expr, d->q.n);
  for (int i = 0; i < d->q.n; i++) {
    pl_expr along = pl_mul(d->pool, l->rub->scale, pl_diff(d->pool, l->rub->slip, d->q.at[i].v));
    l->push[i] = pl_add(d->pool, l->gradient[i], sign > 0 ? along : pl_neg(d->pool, along));
  }
  d->dissipative = true;
}

static void add_links(pl_analysis* d) {
  for (int k = 0; k < d->model->constraints.n; k++) {
    const pl_constraint* c = &d->model->constraints.at[k];
    pl_bond l = {.source = c,
                 .g = c->g,
                 .fixes = -1,
                 .contact = c->relation != PL_EQ,
                 .velocity = c->has_velocity,
                 .lambda = c->lambda};
    l.gradient = PL_ARRAY(d->arena, pl_expr, d->q.n);
    for (int i = 0; i < d->q.n; i++) {
      pl_expr slope = pl_diff(d->pool, c->g, l.velocity ? d->q.at[i].v : d->q.at[i].q);
      // Z = -λ ∇g by `convention lambda-minus`
      l.gradient[i] = d->model->lambda_minus && !c->sticking ? pl_neg(d->pool, slope) : slope;
    }
    add_friction(d, &l);
    pl_expr whole = l.velocity && !l.contact ? integrated(d, c) : pl_poison();
    if (!pl_is_poison(whole)) {
      l.g = whole;
      l.velocity = false;
      l.integrated = true;
    }
    pl_push(d->arena, d->g, l);
  }
}

void pl_setup_facts(pl_analysis* d) {
  pl_pool* p = d->pool;
  for (int k = 0; k < d->model->assumptions.n; k++) {
    const pl_assumption* a = &d->model->assumptions.at[k];
    if (a->kind == PL_A_IN) {
      pl_push(d->arena, d->facts, (pl_fact){pl_sub(p, a->subject, a->lo), false});
      pl_push(d->arena, d->facts, (pl_fact){pl_sub(p, a->hi, a->subject), false});
    } else if (a->kind == PL_A_RELATION) {
      const pl_condition* c = &a->condition;
      bool less = c->relation == PL_LT || c->relation == PL_LE;
      if (c->relation == PL_EQ || c->relation == PL_NE) continue;
      pl_expr difference = less ? pl_sub(p, c->right, c->left) : pl_sub(p, c->left, c->right);
      pl_push(d->arena, d->facts,
              (pl_fact){difference, c->relation == PL_LT || c->relation == PL_GT});
    }
  }
}

static void add_contact_fact(pl_analysis* d, const pl_constraint* c) {
  if (c->relation == PL_EQ || c->has_velocity) return;
  pl_expr apart = c->relation == PL_GE ? c->g : pl_neg(d->pool, c->g),
          other = pl_neg(d->pool, apart);
  // y >= 0 and y <= 0: an equality, in which no sample lies
  for (int k = 0; k < d->facts.n; k++) {
    if (pl_same(d->facts.at[k].difference, other)) return;
  }
  pl_push(d->arena, d->facts, (pl_fact){apart, false});
}

// In contact or above it, a one-sided constraint is a fact too: r >= R.
static void add_contact_facts(pl_analysis* d) {
  for (int k = 0; k < d->g.n; k++) add_contact_fact(d, d->g.at[k].source);
  for (int k = 0; k < d->open.n; k++) {
    if (!d->open.at[k].released) add_contact_fact(d, d->open.at[k].source);
  }
  for (int k = 0; d->stage && k < d->stage->n_sides; k++)
    pl_push(d->arena, d->facts, d->stage->sides[k]);
}

static bool mentions(const pl_analysis* d, pl_expr e, const pl_variable* c) {
  return !pl_is_poison(e) && (pl_has_symbol(d->pool, e, c->q) || pl_has_symbol(d->pool, e, c->v));
}

// A name for the place of masses: `choose φ with x = l sin φ`.
static bool stands_in_map(const pl_analysis* d, const pl_variable* c) {
  const pl_choose* choose = &d->model->choose;
  for (int k = 0; c->chosen && k < choose->n_maps; k++) {
    if (mentions(d, choose->maps[k].map, c)) return true;
  }
  return false;
}

// A coordinate that only stands in `choose` moves nothing by itself, even when a torque or a
// potential acts on it.
static bool carries(const pl_analysis* d, const pl_variable* c) {
  for (int k = 0; k < d->particle.n; k++) {
    const pl_particle* m = &d->particle.at[k];
    for (int j = 0; j < m->n; j++) {
      if (mentions(d, m->at[j], c)) return true;
    }
    if (mentions(d, m->angle, c)) return true;
  }
  for (int k = 0; k < d->model->loads.n && !stands_in_map(d, c); k++) {
    const pl_load* l = &d->model->loads.at[k];
    if (mentions(d, l->value, c) || l->coordinate.id == c->q.id) return true;
    for (int j = 0; j < 3; j++) {
      if (mentions(d, l->vector[j], c) || mentions(d, l->a.at[j], c) || mentions(d, l->b.at[j], c))
        return true;
    }
  }
  for (int k = 0; k < d->g.n; k++) {
    if (mentions(d, d->g.at[k].g, c)) return true;
  }
  return false;
}

// Signs that nothing proves are probed at the start.
static void probe_start(pl_analysis* d) {
  double* value = pl_known_numbers(d);
  for (int i = 0; i < d->q.n; i++) {
    double x = value[pl_symbol_start(d->pool, d->q.at[i].q).id];
    double v = value[pl_symbol_start(d->pool, d->q.at[i].v).id];
    bool held = d->q.at[i].fixed_by >= 0;  // wherever `init` has it
    double place = held ? pl_number(d, d->q.at[i].fixed) : (double)NAN;
    value[d->q.at[i].q.id] = isnan(place) ? x : place;
    value[d->q.at[i].v.id] = isnan(place) ? v : 0;
  }
  value[pl_time(d->pool).id] = 0;
  pl_tower_probe(d->tower, value);
}

// Abbreviations of given quantities are a way of printing: what is asked of formulas sees through
// them.
static void define_names(pl_analysis* d, pl_tower* t) {
  for (int k = 0; k < d->model->lets.n; k++) {
    const pl_let* let = &d->model->lets.at[k];
    if (let->inserted || let->n_args > 0 || pl_has_coordinates(d, let->value)) continue;
    pl_tower_define(t, &(pl_replace){let->symbol, let->value}, 1);
  }
  pl_tower_define(t, d->cases.at, d->cases.n);
}

pl_tower* pl_setup_tower(pl_analysis* d) {
  pl_tower* t = pl_tower_make(d->job, d->pool, d->facts.at, d->facts.n);
  define_names(d, t);
  return t;
}

pleuel_status pl_setup_coordinates(pl_analysis* d) {
  add_coordinates(d);
  add_particles(d);
  add_links(d);
  add_contact_facts(d);
  for (int i = 0; i < d->q.n; i++) d->q.at[i].carries = carries(d, &d->q.at[i]);
  d->tower = pl_setup_tower(d);
  if (d->towers) pl_push(d->arena, *d->towers, d->tower);
  probe_start(d);
  return PLEUEL_OK;
}

// --------------------------------------------------------------------------- coordinate = constant
// The only coordinate in e, -1 if there is none, -2 if there are several or a velocity.
static int only_coordinate(const pl_analysis* d, pl_expr e) {
  int found = -1;
  for (int i = 0; i < d->q.n; i++) {
    const pl_variable* c = &d->q.at[i];
    if (pl_has_symbol(d->pool, e, c->v)) return -2;
    if (!pl_has_symbol(d->pool, e, c->q)) continue;
    if (found >= 0) return -2;
    found = i;
  }
  return found;
}

static void fix_coordinate(pl_analysis* d, int i, int link, pl_expr value) {
  pl_variable* c = &d->q.at[i];
  c->fixed_by = link;
  c->by_contact = d->g.at[link].contact;
  c->fixed = value;
  d->g.at[link].fixes = i;
  pl_expr v = pl_dt(d->pool, value), a = pl_dt(d->pool, v);
  pl_replace r[3] = {{c->q, value}, {c->v, v}, {c->a, a}};
  for (int k = 0; k < 3; k++) {
    if (c->by_contact) {
      pl_push(d->arena, d->contact, r[k]);
    } else {
      pl_push(d->arena, d->fixed, r[k]);
    }
  }
}

// y² + 3 l² has one sign for all y: no position satisfies it.
static bool never_zero(pl_analysis* d, pl_expr e) {
  int sign = 0;
  return pl_alg_sign(d->tower, e, false, &sign) == PL_YES && sign != 0;
}

// What is left of a constraint when the fixed coordinates are in: nothing (implied), a
// contradiction, or one coordinate.
static pleuel_status try_link(pl_analysis* d, int k, bool* changed) {
  pl_bond* l = &d->g.at[k];
  if (l->fixes >= 0 || l->implied || l->velocity || l->rub) return PLEUEL_OK;
  pl_expr e = l->contact ? pl_on_contact(d, l->g) : pl_on_fixed(d, l->g);
  int i = only_coordinate(d, e);
  if (i == -1) {
    if (l->contact) return PLEUEL_OK;
    pl_answer3 zero = pl_zero_for_numbers(d, e);
    if (zero == PL_NO) return pl_contradiction(d, l, e);
    l->implied = zero == PL_YES;
    *changed |= l->implied;
    return PLEUEL_OK;
  }
  if (i < 0 || d->q.at[i].fixed_by >= 0) return PLEUEL_OK;
  if (!l->contact && never_zero(d, e)) return pl_contradiction(d, l, e);
  pl_expr c[2];
  if (pl_alg_coefficients(d->tower, e, d->q.at[i].q, c, 1) != 1) return PLEUEL_OK;
  if (pl_has_coordinates(d, c[1]) || pl_has_symbol(d->pool, c[1], pl_time(d->pool)))
    return PLEUEL_OK;
  fix_coordinate(d, i, k, pl_alg_normal(d->tower, pl_neg(d->pool, pl_div(d->pool, c[0], c[1]))));
  *changed = true;
  return PLEUEL_OK;
}

pleuel_status pl_setup_trivial(pl_analysis* d) {
  bool changed = true;
  while (changed) {
    changed = false;
    for (int k = 0; k < d->g.n; k++) PL_TRY(try_link(d, k, &changed));
  }
  probe_start(d);
  return PLEUEL_OK;
}
