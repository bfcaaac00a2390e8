// The components of constraint forces, by virtual work: along each coordinate q of the model that
// turns no body,
//
//     sum over the masses  Z . dX/dq = λ dg/dq,
//
// with λ and g of the model as it stands.  A section that does not speak of every mass that q moves
// says nothing of q.
#include <string.h>

#include "witness/witness_impl.h"

typedef struct pl_pushed {  // a mass, and the force on it
  const char* name;
  const pl_point* at;
  const pl_value* force;  // NULL: nothing is said of it
} pl_pushed;

typedef struct pl_pushed_masses {
  pl_pushed* of;
  int n;
  bool twice;  // one of them has two forces, or two have one name
} pl_pushed_masses;

// ------------------------------------------------------------------------------------------ masses
static void add_mass(pl_pushed_masses* m, const pl_section* s, const char* of, const pl_name* name,
                     const pl_point* at) {
  pl_pushed p = {.name = name->text, .at = at};
  for (int i = 0; i < s->values.n; i++) {
    const pl_value* v = &s->values.at[i];
    if (v->n_components == 0 || !v->of || !v->on) continue;
    if (strcmp(v->of, of) != 0 || strcmp(v->on, name->text) != 0) continue;
    m->twice |= p.force != NULL;
    p.force = v;
  }
  for (int i = 0; i < m->n; i++) m->twice |= strcmp(m->of[i].name, p.name) == 0;
  m->of[m->n++] = p;
}

static pl_pushed_masses masses_of(pl_witness* w, const pl_section* s, const char* of) {
  const pl_model* m = w->solution->model;
  pl_pushed_masses out = {.of = PL_ARRAY(w->arena, pl_pushed, m->masses.n + m->bodies.n + 1)};
  for (int i = 0; i < m->masses.n; i++)
    add_mass(&out, s, of, &m->masses.at[i].name, &m->masses.at[i].point);
  for (int i = 0; i < m->bodies.n; i++)
    add_mass(&out, s, of, &m->bodies.at[i].name, &m->bodies.at[i].centre);
  return out;
}

// ------------------------------------------------------------------------------------ virtual work
// The axis of "e_x"; -1: another direction.
static int axis_named(const pl_model* m, const char* name) {
  for (int c = 0; c < m->n_axes; c++) {
    if (strcmp(m->axes[c].name, name) == 0) return c;
  }
  return -1;
}

// e . dX/dq for the direction `along`: an axis, or that of dX/dr, of length one. poison: unknown.
static pl_expr along_direction(pl_witness* w, const pl_point* at, const char* along, pl_symbol q) {
  pl_pool* p = w->pool;
  int axis = axis_named(w->solution->model, along + 2);
  if (axis >= 0) return axis < at->n ? pl_diff(p, at->at[axis], q) : pl_poison();
  pl_symbol r = pl_symbol_find(p, pl_ascii_of(w->arena, along + 2));
  if (!r.id) return pl_poison();
  pl_expr dot = pl_int(p, 0), square = dot;
  for (int c = 0; c < at->n; c++) {
    pl_expr to = pl_diff(p, at->at[c], r);
    dot = pl_add(p, dot, pl_mul(p, to, pl_diff(p, at->at[c], q)));
    square = pl_add(p, square, pl_square(p, to));
  }
  return pl_is_zero_node(p, square) ? pl_poison() : pl_div(p, dot, pl_sqrt(p, square));
}

static bool moves(const pl_witness* w, const pl_point* at, pl_symbol q) {
  for (int c = 0; c < at->n; c++) {
    if (pl_has_symbol(w->pool, at->at[c], q)) return true;
  }
  return false;
}

// The work of all forces along q; poison: something of it is not known, or q moves no mass.
static pl_expr work_along(pl_witness* w, const pl_pushed_masses* m, pl_symbol q) {
  pl_pool* p = w->pool;
  pl_expr sum = pl_int(p, 0);
  bool any = false;
  for (int i = 0; i < m->n; i++) {
    const pl_pushed* mass = &m->of[i];
    if (!moves(w, mass->at, q)) continue;
    if (!mass->force) return pl_poison();
    any = true;
    for (int j = 0; j < mass->force->n_components; j++) {
      const pl_component* c = &mass->force->components[j];
      pl_expr way = along_direction(w, mass->at, c->along, q);
      if (pl_is_poison(way)) return way;
      sum = pl_add(p, sum, pl_mul(p, c->expr, way));
    }
  }
  return any ? sum : pl_poison();
}

static bool turns_a_body(const pl_witness* w, pl_symbol q) {
  const pl_model* m = w->solution->model;
  for (int i = 0; i < m->bodies.n; i++) {
    if (pl_has_symbol(w->pool, m->bodies.at[i].angle, q)) return true;
  }
  return false;
}

// -------------------------------------------------------------------------------------- statements
static void state_forces_of(pl_witness* w, int section, const pl_constraint* c) {
  const pl_section* s = &w->solution->sections.at[section];
  const pl_model* model = w->solution->model;
  pl_pushed_masses m = masses_of(w, s, c->name.text);
  if (m.twice || c->has_velocity) return;
  for (int i = 0; i < model->coords.n; i++) {
    pl_symbol q = model->coords.at[i].symbol;
    if (turns_a_body(w, q)) continue;
    pl_expr shown = work_along(w, &m, q), slope = pl_diff(w->pool, c->g, q);
    bool nothing = pl_is_zero_node(w->pool, shown) && pl_is_zero_node(w->pool, slope);
    if (pl_is_poison(shown) || nothing) continue;
    pl_expr left = pl_mul(w->pool, pl_sym(w->pool, c->lambda), slope);
    const pl_value* any = NULL;  // for the names that its formulas stand over
    for (int k = 0; k < m.n; k++) any = m.of[k].force ? m.of[k].force : any;
    pl_statement_add(w, (pl_statement){.kind = PL_EQUALS,
                                       .section = section,
                                       .value = any,
                                       .shown = shown,
                                       .left = model->lambda_minus ? pl_neg(w->pool, left) : left,
                                       .name = pl_format(w->arena, "force(%s)", c->name.text),
                                       .from = pl_statement_motion(s->ask)});
  }
}

void pl_statements_of_forces(pl_witness* w, int section) {
  const pl_model* m = w->solution->model;
  if (m->spatials.n > 0) return;
  for (int i = 0; i < m->constraints.n; i++) {
    const pl_constraint* c = &m->constraints.at[i];
    if (c->lambda.id && !c->block && !pl_is_poison(c->g)) state_forces_of(w, section, c);
  }
}
