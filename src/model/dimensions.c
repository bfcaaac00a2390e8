// Dimensions through every equation of a model. Each name has an unknown dimension; declared units
// fix some of them, every sum, relation, function and physical statement is an equation between
// them (dimension_system.c). Needs the names resolved and the units still in the expressions
// (units.c: base units as symbols).
//
// A model without any unit is walked too, silently: what would be a mass or a length decides how
// formulas are ordered.
#include "dimension_impl.h"

#include <math.h>
#include <string.h>

// ---------------------------------------------------------------------------- forms of expressions
static const pl_dim_form* form_of(pl_dim_pass* d, pl_expr e);

static const pl_dim_form* pure(pl_dim_pass* d) {
  return pl_dim_fixed(&d->system, pl_exponents_zero());
}

static const pl_dim_form* mechanical(pl_dim_pass* d, int m, int kg, int s) {
  pl_exponents e = pl_exponents_zero();
  e.e[0].num = m;
  e.e[1].num = kg;
  e.e[2].num = s;
  return pl_dim_fixed(&d->system, e);
}

static const pl_dim_form* times(pl_dim_pass* d, const pl_dim_form* a, int power,
                                const pl_dim_form* b) {
  return pl_dim_combine(&d->system, a, (pl_fraction){power, 1}, b);
}

static const pl_dim_form* energy(pl_dim_pass* d) { return pl_dim_unknown(&d->system, d->energy); }
static const pl_dim_form* duration(pl_dim_pass* d) { return pl_dim_unknown(&d->system, d->time); }

int pl_dim_symbol_var(pl_dim_pass* d, pl_symbol s) {
  uint64_t known = pl_map_get(d->var_of, s.id);
  if (known) return (int)known - 1;
  int var = pl_dim_var_add(&d->system, PL_DIM_SYMBOL);
  d->system.vars.at[var].symbol = s;
  pl_map_set(d->var_of, s.id, (uint64_t)var + 1);
  return var;
}

static const pl_dim_form* form_of_symbol(pl_dim_pass* d, pl_symbol s, int dots) {
  const pl_symbol_info* info = pl_symbol_get(d->pool, s);
  pl_symbol base = info->base;
  switch (info->role) {
    case PL_R_VELOCITY:
    case PL_R_ACCELERATION:
    case PL_R_START:
      if (base.id) return form_of_symbol(d, base, dots + info->dots);
      break;
    case PL_R_MOMENTUM:
      if (base.id)
        return times(d, times(d, energy(d), 1, duration(d)), -1, form_of_symbol(d, base, 0));
      break;
    case PL_R_TIME: return duration(d);
    case PL_R_INDEX: return pure(d);
    default: break;
  }
  if (pl_unit_is_symbol(d->pool, s))
    return pl_dim_fixed(&d->system, pl_exponents_of(info->dimension));
  const pl_dim_form* f = pl_dim_unknown(&d->system, pl_dim_symbol_var(d, s));
  return dots ? times(d, f, -dots, duration(d)) : f;
}

// What stands alone, as a term or a side: 0 fits everything (NULL), another bare number is free.
static const pl_dim_form* form_of_side(pl_dim_pass* d, pl_expr e) {
  if (pl_is_poison(e) || pl_is_zero_node(d->pool, e) || pl_kind_of(d->pool, e) == PL_INFINITY)
    return NULL;
  if (!pl_is_constant_known(d->pool, d->constant, e)) return form_of(d, e);
  int var = pl_dim_var_add(&d->system, PL_DIM_NUMBER);
  d->system.vars.at[var].number = e;
  d->system.vars.at[var].span = d->where;
  return pl_dim_unknown(&d->system, var);
}

static const pl_dim_form* anything(pl_dim_pass* d) {
  return pl_dim_unknown(&d->system, pl_dim_var_add(&d->system, PL_DIM_SYMBOL));
}

static void clash(pl_dim_pass* d, pl_dim_clash kind, pl_expr a, const pl_dim_form* fa, pl_expr b,
                  const pl_dim_form* fb) {
  pl_dim_report(d, &(pl_dim_conflict){
                       .kind = kind, .a = a, .b = b, .form_a = fa, .form_b = fb, .code = PL_E021});
}

// left = right, or terms of a sum
static void equate(pl_dim_pass* d, pl_dim_clash kind, pl_expr a, pl_expr b) {
  const pl_dim_form* fa = form_of_side(d, a);
  const pl_dim_form* fb = form_of_side(d, b);
  if (fa && fb && !pl_dim_unify(&d->system, fa, fb, d->where)) clash(d, kind, a, fa, b, fb);
}

// e has to have the dimension `wanted`; what: how a message calls it.
static void need(pl_dim_pass* d, pl_expr e, const pl_dim_form* wanted, pl_code code, const char* en,
                 const char* de) {
  const pl_dim_form* f = form_of_side(d, e);
  if (!f || pl_dim_unify(&d->system, f, wanted, d->where)) return;
  pl_dim_report(d, &(pl_dim_conflict){.kind = PL_CLASH_NEED,
                                      .a = e,
                                      .b = pl_poison(),
                                      .form_a = f,
                                      .form_b = wanted,
                                      .what = {en, de},
                                      .code = code});
}

static const pl_dim_form* form_of_sum(pl_dim_pass* d, pl_expr e) {
  int n = pl_n_args(d->pool, e);
  // the first term that is no bare number sets what the others have to be
  pl_expr first = pl_poison();
  for (int i = 0; i < n && pl_is_poison(first); i++) {
    if (!pl_is_constant_known(d->pool, d->constant, pl_arg(d->pool, e, i)))
      first = pl_arg(d->pool, e, i);
  }
  if (pl_is_poison(first)) return pure(d);
  const pl_dim_form* f = form_of(d, first);
  bool broken = false;
  for (int i = 0; i < n; i++) {
    pl_expr term = pl_arg(d->pool, e, i);
    if (pl_same(term, first)) continue;
    const pl_dim_form* g = form_of_side(d, term);
    if (!g || pl_dim_unify(&d->system, f, g, d->where)) continue;
    if (!broken) clash(d, PL_CLASH_SUM, first, f, term, g);
    broken = true;
  }
  // a sum that does not fit in itself fits everything: one mistake, one message
  return broken ? anything(d) : f;
}

static const pl_dim_form* form_of_product(pl_dim_pass* d, pl_expr e) {
  const pl_dim_form* f = pure(d);
  for (int i = 0; i < pl_n_args(d->pool, e); i++)
    f = times(d, f, 1, form_of(d, pl_arg(d->pool, e, i)));
  return f;
}

// An exponent as a fraction: a number, or parameters with numbers that make a half or whole one.
static bool exponent_value(pl_dim_pass* d, pl_expr e, pl_fraction* out) {
  long num, den;
  if (pl_is_ratio(d->pool, e, &num, &den)) {
    *out = pl_fraction_make(num, den);
    return pl_fraction_valid(*out);
  }
  if (pl_is_number(d->pool, e)) return false;
  double twice = 2 * pl_eval(d->pool, e, d->values);
  if (!(fabs(twice) < 1000) || twice != floor(twice)) return false;
  *out = pl_fraction_make((int64_t)twice, 2);
  return true;
}

static const pl_dim_form* form_of_power(pl_dim_pass* d, pl_expr e) {
  pl_expr base = pl_arg(d->pool, e, 0), exponent = pl_arg(d->pool, e, 1);
  if (!pl_is_number(d->pool, exponent)) {
    need(d, exponent, pure(d), PL_E032, PL_BOTH("an exponent is a pure number"));
  }
  if (pl_is_constant_known(d->pool, d->constant, base)) return pure(d);
  pl_fraction f;
  const pl_dim_form* b = form_of(d, base);
  // beyond any physics
  if (pl_is_number(d->pool, exponent) && !exponent_value(d, exponent, &f)) return anything(d);
  if (exponent_value(d, exponent, &f)) return pl_dim_combine(&d->system, pure(d), f, b);
  need(d, base, pure(d), PL_E032,
       PL_BOTH("what is raised to a power that is not a number has to be a pure number"));
  return pure(d);
}

static const pl_dim_form* form_of_call(pl_dim_pass* d, pl_expr e) {
  pl_expr a = pl_arg(d->pool, e, 0);
  pl_function function = pl_function_of(d->pool, e);
  switch (function) {
    case PL_ABS: return form_of(d, a);
    case PL_SIGN: form_of(d, a); return pure(d);
    case PL_ATAN2: equate(d, PL_CLASH_RELATION, a, pl_arg(d->pool, e, 1)); return pure(d);
    case PL_MIN:
    case PL_MAX: {
      pl_expr b = pl_arg(d->pool, e, 1);
      equate(d, PL_CLASH_RELATION, a, b);
      return form_of(d, pl_is_constant_known(d->pool, d->constant, a) ? b : a);
    }
    default: break;
  }
  const char* name = pl_function_name[function];
  need(d, a, pure(d), PL_E031, PL_BOTH_FORMAT(d->arena, "%s() takes a pure number", name));
  return pure(d);
}

static const pl_dim_form* form_of_choice(pl_dim_pass* d, pl_expr e) {
  form_of(d, pl_arg(d->pool, e, 0));
  pl_expr then = pl_arg(d->pool, e, 1), otherwise = pl_arg(d->pool, e, 2);
  equate(d, PL_CLASH_RELATION, then, otherwise);
  return form_of(d, pl_is_constant_known(d->pool, d->constant, then) ? otherwise : then);
}

static const pl_dim_form* compute_form(pl_dim_pass* d, pl_expr e) {
  switch (pl_kind_of(d->pool, e)) {
    case PL_SYMBOL: return form_of_symbol(d, pl_symbol_of(d->pool, e), 0);
    case PL_AT: return form_of_symbol(d, pl_symbol_of(d->pool, e), pl_dots_of(d->pool, e));
    case PL_ADD: return form_of_sum(d, e);
    case PL_MUL: return form_of_product(d, e);
    case PL_POW: return form_of_power(d, e);
    case PL_CALL: return form_of_call(d, e);
    case PL_IF: return form_of_choice(d, e);
    case PL_SUM: return form_of(d, pl_arg(d->pool, e, pl_n_args(d->pool, e) - 1));
    case PL_UNKNOWN_FUNCTION: return anything(d);
    default: return pure(d);
  }
}

// Each expression is looked at once, where it is met first: a mistake inside a `let` is told at the
// `let`.
static const pl_dim_form* form_of(pl_dim_pass* d, pl_expr e) {
  if (pl_is_poison(e) || pl_is_constant_known(d->pool, d->constant, e)) return pure(d);
  uint64_t known = pl_map_get(d->form_of, e.id);
  if (known) return (const pl_dim_form*)(uintptr_t)known;
  const pl_dim_form* f = compute_form(d, e);
  pl_map_set(d->form_of, e.id, (uint64_t)(uintptr_t)f);
  return f;
}

// ------------------------------------------------------------------------------------ declarations
static void declare(pl_dim_pass* d, pl_symbol s, bool has_unit, pl_span span) {
  if (!s.id) return;
  int var = pl_dim_symbol_var(d, s);
  pl_dim_var* v = &d->system.vars.at[var];
  v->span = span;
  if (!has_unit || v->solved || !pl_symbol_get(d->pool, s)->dimension_known) return;
  v->declared = v->solved = true;
  v->row = v->first = pl_dim_fixed(&d->system,
                                   pl_exponents_of(pl_symbol_get(d->pool, s)->dimension));
  d->system.vars.at[var].reason = span;
}

static void declare_time(pl_dim_pass* d) {
  pl_symbol t = pl_time(d->pool);
  d->time = pl_dim_symbol_var(d, t);
  pl_dim_var* v = &d->system.vars.at[d->time];
  v->declared = v->solved = true;
  v->row = v->first = mechanical(d, 0, 0, 1);
}

// A unit written in the text that the builder left as text.
static void read_unit_text(pl_dim_pass* d, const pl_param* p) {
  pl_symbol_info* info = pl_symbol_get(d->pool, p->symbol);
  if (!p->has_unit || !p->unit_text || info->dimension_known) return;
  pl_unit unit;
  if (!pl_unit_parse(d->pool, p->unit_text, strlen(p->unit_text), &unit, NULL, NULL, NULL)) return;
  info->dimension = unit.dimension;
  info->dimension_known = true;
}

static void walk_declarations(pl_dim_pass* d) {
  const pl_model* m = d->model;
  declare_time(d);
  for (int i = 0; i < m->params.n; i++) {
    read_unit_text(d, &m->params.at[i]);
    declare(d, m->params.at[i].symbol, m->params.at[i].has_unit, m->params.at[i].span);
  }
  for (int i = 0; i < m->coords.n; i++)
    declare(d, m->coords.at[i].symbol, m->coords.at[i].has_unit, m->coords.at[i].span);
  for (int i = 0; i < m->lets.n; i++) declare(d, m->lets.at[i].symbol, false, m->lets.at[i].span);

  for (int i = 0; i < m->params.n; i++) {
    const pl_param* p = &m->params.at[i];
    d->where = p->span;
    if (!pl_is_poison(p->value) && !pl_is_constant_known(d->pool, d->constant, p->value)) {
      equate(d, PL_CLASH_RELATION, pl_sym(d->pool, p->symbol), p->value);
    }
  }
  for (int i = 0; i < m->lets.n; i++) {
    const pl_let* l = &m->lets.at[i];
    d->where = l->span;
    if (l->n_args == 0 && l->symbol.id)
      equate(d, PL_CLASH_RELATION, pl_sym(d->pool, l->symbol), l->value);
  }
}

// ----------------------------------------------------------------------------------------- physics
static void walk_point(pl_dim_pass* d, const pl_point* p) {
  d->focus = p->span;
  for (int k = 0; k < p->n && k < 3; k++) {
    need(d, p->at[k], mechanical(d, 1, 0, 0), PL_E033,
         PL_BOTH("a component of a point is a length"));
  }
  d->focus = (pl_span){0};
}

static void joule(pl_dim_pass* d) {
  pl_dim_unify(&d->system, energy(d), mechanical(d, 2, 1, -2), d->where);
}

static void walk_masses(pl_dim_pass* d) {
  const pl_model* m = d->model;
  for (int i = 0; i < m->masses.n; i++) {
    const pl_mass* x = &m->masses.at[i];
    d->where = x->span;
    joule(d);
    need(d, x->mass, mechanical(d, 0, 1, 0), PL_E033,
         PL_BOTH("what stands after `mass` is a mass"));
    walk_point(d, &x->point);
  }
  for (int i = 0; i < m->bodies.n; i++) {
    const pl_body* x = &m->bodies.at[i];
    d->where = x->span;
    joule(d);
    need(d, x->mass, mechanical(d, 0, 1, 0), PL_E033,
         PL_BOTH("what stands after `mass` is a mass"));
    need(d, x->inertia, mechanical(d, 2, 1, 0), PL_E033,
         PL_BOTH("a moment of inertia is in kg m²"));
    need(d, x->angle, pure(d), PL_E033, PL_BOTH("the angle of a body is a pure number"));
    walk_point(d, &x->centre);
  }
  for (int i = 0; i < m->spatials.n; i++) {
    const pl_spatial* x = &m->spatials.at[i];
    d->where = x->span;
    for (int k = 0; k < 6; k++) {
      need(d, x->inertia[k], mechanical(d, 2, 1, 0), PL_E033,
           PL_BOTH("a moment of inertia is in kg m²"));
    }
    for (int k = 0; k < 9 && !pl_is_poison(x->axes[k]); k++) {
      need(d, x->axes[k], pure(d), PL_E033,
           PL_BOTH("what gives the axes of a body is a pure number"));
    }
  }
  for (int i = 0; i < m->points.n; i++) {
    d->where = m->points.at[i].span;
    walk_point(d, &m->points.at[i].point);
  }
  for (int i = 0; i < m->gravities.n; i++) {
    d->where = m->gravities.at[i].span;
    need(d, m->gravities.at[i].g, mechanical(d, 1, 0, -2), PL_E033,
         PL_BOTH("gravity is an acceleration"));
  }
}

// The energy of the model over a power of length and time: N, N/m, N s/m ...
static const pl_dim_form* energy_over(pl_dim_pass* d, int length, int time) {
  return times(d, times(d, energy(d), -length, mechanical(d, 1, 0, 0)), -time, duration(d));
}

static void walk_load(pl_dim_pass* d, const pl_load* x) {
  switch (x->kind) {
    case PL_L_FORCE:
      joule(d);
      for (int k = 0; k < x->a.n && k < 3; k++) {
        need(d, x->vector[k], energy_over(d, 1, 0), PL_E033,
             PL_BOTH("a component of a force is in N"));
      }
      walk_point(d, &x->a);
      return;
    case PL_L_COUPLE:
      joule(d);
      for (int k = 0; k < 3; k++) {
        need(d, x->vector[k], energy(d), PL_E033, PL_BOTH("a component of a torque is in N m"));
        need(d, x->spin[k], times(d, pure(d), -1, duration(d)), PL_E033,
             PL_BOTH("an angular velocity is an angle over time"));
      }
      return;
    case PL_L_TORQUE: {
      const pl_dim_form* wanted = energy(d);
      if (x->coordinate.id) wanted = times(d, wanted, -1, form_of_symbol(d, x->coordinate, 0));
      need(d, x->value, wanted, PL_E033, PL_BOTH("torque times its coordinate is an energy"));
      return;
    }
    case PL_L_POTENTIAL:
    case PL_L_KINETIC:
    case PL_L_LAGRANGIAN:
      need(d, x->value, energy(d), PL_E033, PL_BOTH("this is an energy"));
      return;
    case PL_L_RAYLEIGH:
      need(d, x->value, energy_over(d, 0, 1), PL_E033,
           PL_BOTH("a dissipation function is a power"));
      return;
    case PL_L_SPRING:
      joule(d);
      need(d, x->value, energy_over(d, 2, 0), PL_E033,
           PL_BOTH("the stiffness of a spring is in N/m"));
      need(d, x->rest, mechanical(d, 1, 0, 0), PL_E033, PL_BOTH("a rest length is a length"));
      break;
    case PL_L_DAMPER:
    case PL_L_DRAG:
      joule(d);
      need(d, x->value, energy_over(d, 2, -1), PL_E033,
           PL_BOTH("a damping coefficient is in N s/m"));
      break;
  }
  walk_point(d, &x->a);
  walk_point(d, &x->b);
}

static void walk_condition(pl_dim_pass* d, const pl_condition* c) {
  if (c->span.source) d->where = c->span;
  equate(d, PL_CLASH_RELATION, c->left, c->right);
}

// How many more time derivatives than coordinates a constraint carries: 1 when velocities stand in
// it.
static void walk_constraints(pl_dim_pass* d) {
  const pl_model* m = d->model;
  for (int i = 0; i < m->constraints.n; i++) {
    const pl_constraint* c = &m->constraints.at[i];
    d->where = c->span;
    equate(d, PL_CLASH_RELATION, c->left, c->right);
    if (!c->lambda.id) continue;
    // λ ∂g/∂q is a generalised force: [λ] = energy / [g], and for velocity constraints λ ∂g/∂q'
    // gives energy / ([g] s)
    pl_expr side = pl_is_constant_known(d->pool, d->constant, c->left) ? c->right : c->left;
    const pl_dim_form* g = form_of_side(d, side);
    if (!g) continue;
    const pl_dim_form* lambda = times(d, energy(d), -1, g);
    if (pl_has_role(d->pool, c->g, PL_R_VELOCITY) || c->has_velocity)
      lambda = times(d, lambda, -1, duration(d));
    pl_dim_unify(&d->system, pl_dim_unknown(&d->system, pl_dim_symbol_var(d, c->lambda)), lambda,
                 c->span);
  }
  for (int i = 0; i < m->choose.n_maps; i++) {
    d->where = m->choose.maps[i].span;
    equate(d, PL_CLASH_RELATION, m->choose.maps[i].old, m->choose.maps[i].map);
  }
}

static void walk_inits(pl_dim_pass* d, bool with_unit) {
  const pl_model* m = d->model;
  for (int i = 0; i < m->inits.n; i++) {
    const pl_init* x = &m->inits.at[i];
    if (pl_is_poison(x->value) || pl_is_poison(x->target)
        || pl_unit_occurs(d->pool, x->value) != with_unit)
      continue;
    d->where = x->span;
    equate(d, PL_CLASH_RELATION, x->target, x->value);
  }
}

static void walk_simulate(pl_dim_pass* d) {
  const pl_model* m = d->model;
  d->where = m->simulate.span;
  const pl_expr times_of[] = {m->simulate.from, m->simulate.to, m->simulate.step};
  for (int i = 0; i < 3 && m->simulate.given; i++) {
    need(d, times_of[i], duration(d), PL_E033, PL_BOTH("a simulation runs over time"));
  }
  for (int i = 0; i < m->inits.n; i++) {
    d->where = m->inits.at[i].span;
    need(d, m->inits.at[i].time, duration(d), PL_E033,
         PL_BOTH("what stands after `init at` is a time"));
  }
}

static void walk_results(pl_dim_pass* d) {
  const pl_model* m = d->model;
  for (int i = 0; i < m->result_names.n; i++) {
    const pl_result_name* r = &m->result_names.at[i];
    if (r->kind == PL_RES_DT || r->kind == PL_RES_DIFF) {
      const pl_dim_form* over = r->kind == PL_RES_DT ? duration(d) : form_of_symbol(d, r->by, 0);
      const pl_dim_form* f = form_of_side(d, r->of);
      if (f)
        pl_dim_unify(&d->system, pl_dim_unknown(&d->system, pl_dim_symbol_var(d, r->symbol)),
                     times(d, f, -1, over), (pl_span){0});
      continue;
    }
    if (r->kind == PL_RES_START) {
      const pl_dim_form* f = form_of_side(d, r->of);
      if (f)
        pl_dim_unify(&d->system, pl_dim_unknown(&d->system, pl_dim_symbol_var(d, r->symbol)), f,
                     (pl_span){0});
      continue;
    }
    bool force = r->kind == PL_RES_FORCE || r->kind == PL_RES_FORCE_NORM
                 || r->kind == PL_RES_NORMAL;
    pl_dim_unify(&d->system, pl_dim_unknown(&d->system, pl_dim_symbol_var(d, r->symbol)),
                 force ? energy_over(d, 1, 0) : energy(d), (pl_span){0});
  }
}

static void walk_events(pl_dim_pass* d) {
  const pl_model* m = d->model;
  for (int i = 0; i < m->events.n; i++) {
    const pl_event* e = &m->events.at[i];
    d->where = e->span;
    form_of(d, e->value);
    for (int k = 0; k < e->actions.n; k++) {
      const pl_action* a = &e->actions.at[k];
      if (a->kind != PL_DO_SET) continue;
      if (a->span.source) d->where = a->span;
      equate(d, PL_CLASH_RELATION, a->target, a->value);
    }
  }
}

static void walk_ask(pl_dim_pass* d, const pl_ask* a) {
  d->where = a->span;
  form_of(d, a->value);
  for (int k = 0; k < a->where.n; k++) walk_condition(d, &a->where.at[k]);
  for (int k = 0; k < a->motion.n_from; k++) walk_condition(d, &a->motion.from[k]);
  d->where = a->span;
  if (a->variable.id && !pl_is_poison(a->to))
    equate(d, PL_CLASH_RELATION, pl_sym(d->pool, a->variable), a->to);
  if (!pl_is_poison(a->substitution_left))
    equate(d, PL_CLASH_RELATION, a->substitution_left, a->substitution_right);
}

// Coefficients of contacts are numbers, the velocity of a surface is one.
static void walk_contacts(pl_dim_pass* d) {
  const pl_model* m = d->model;
  for (int i = 0; i < m->restitutions.n; i++) {
    d->where = m->restitutions.at[i].span;
    need(d, m->restitutions.at[i].value, pure(d), PL_E033,
         PL_BOTH("a coefficient of restitution is a number"));
  }
  for (int i = 0; i < m->frictions.n; i++) {
    const pl_friction* f = &m->frictions.at[i];
    d->where = f->span;
    need(d, f->kinetic, pure(d), PL_E033, PL_BOTH("a coefficient of friction is a number"));
    need(d, f->sticking, pure(d), PL_E033, PL_BOTH("a coefficient of friction is a number"));
    for (int k = 0; k < f->surface.n; k++)
      need(d, f->surface.at[k], mechanical(d, 1, 0, -1), PL_E033,
           PL_BOTH("a surface has a velocity"));
    walk_point(d, &f->at);
  }
}

static void walk_rest(pl_dim_pass* d) {
  const pl_model* m = d->model;
  for (int i = 0; i < m->assumptions.n; i++) {
    const pl_assumption* a = &m->assumptions.at[i];
    d->where = a->span;
    if (a->kind == PL_A_RELATION) walk_condition(d, &a->condition);
    if (a->kind == PL_A_IN) {
      equate(d, PL_CLASH_RELATION, a->subject, a->lo);
      equate(d, PL_CLASH_RELATION, a->subject, a->hi);
    }
  }
  for (int i = 0; i < m->branches.n; i++) walk_condition(d, &m->branches.at[i]);
  walk_events(d);
  for (int i = 0; i < m->asks.n; i++) walk_ask(d, &m->asks.at[i]);
  for (int i = 0; i < m->outputs.n; i++) {
    d->where = m->outputs.at[i].span;
    form_of(d, m->outputs.at[i].value);
  }
  for (int i = 0; i < m->plots.n; i++) {
    d->where = m->plots.at[i].span;
    for (int k = 0; k < m->plots.at[i].y.n; k++) form_of(d, m->plots.at[i].y.at[k]);
    form_of(d, m->plots.at[i].x);
  }
}

static void walk_model(pl_dim_pass* d) {
  d->energy = pl_dim_var_add(&d->system, PL_DIM_ENERGY);
  walk_declarations(d);
  walk_inits(d, true);
  walk_masses(d);
  walk_simulate(d);
  walk_constraints(d);
  walk_inits(d, false);
  walk_results(d);
  for (int i = 0; i < d->model->loads.n; i++) {
    d->where = d->model->loads.at[i].span;
    walk_load(d, &d->model->loads.at[i]);
  }
  walk_contacts(d);
  walk_rest(d);
}

// ---------------------------------------------------------------------------------- what was found
// The class decides the order of factors and terms in formulas.
static pl_class class_of(pl_dimension x, pl_class otherwise) {
  if (pl_dimension_equal(x, pl_dimension_of(0, 1, 0))) return PL_C_MASS;
  if (pl_dimension_equal(x, pl_dimension_of(1, 0, -2))) return PL_C_GRAVITY;
  if (pl_dimension_equal(x, pl_dimension_of(1, 0, 0))) return PL_C_LENGTH;
  return otherwise;
}

static void settle_symbol(pl_dim_pass* d, pl_symbol s) {
  if (!s.id) return;
  pl_symbol_info* info = pl_symbol_get(d->pool, s);
  pl_dimension x;
  if (!pl_dim_known(&d->system, form_of_symbol(d, s, 0), &x)) return;
  if (!d->silent) {
    info->dimension = x;
    info->dimension_known = true;
  }
  if (info->role == PL_R_PARAM || info->role == PL_R_LOCAL) info->class = class_of(x, info->class);
}

static void settle(pl_dim_pass* d) {
  int n = pl_symbol_count(d->pool);
  for (int id = 1; id <= n; id++) {
    pl_symbol s = {(uint32_t)id};
    pl_role role = pl_symbol_get(d->pool, s)->role;
    if (role == PL_R_INDEX || pl_unit_is_symbol(d->pool, s)) continue;
    settle_symbol(d, s);
  }
}

static void see_unit(void* user, const pl_slot* slot) {
  pl_model* m = user;
  if (!pl_is_poison(*slot->at) && pl_unit_occurs(m->pool, *slot->at)) m->uses_units = true;
}

static bool has_dimension(const pl_model* m, pl_symbol s) {
  const pl_symbol_info* info = pl_symbol_get(m->pool, s);
  return info->dimension_known && !pl_dimension_equal(info->dimension, pl_dimension_one());
}

// Some quantity with a unit that is not a pure number: an angle alone does not switch the checks
// on.
static void look_for_units(pl_dim_pass* d) {
  pl_model* m = d->model;
  for (int i = 0; i < m->params.n; i++) {
    read_unit_text(d, &m->params.at[i]);
    if (m->params.at[i].has_unit && has_dimension(m, m->params.at[i].symbol)) m->uses_units = true;
  }
  for (int i = 0; i < m->coords.n; i++) {
    if (m->coords.at[i].has_unit && has_dimension(m, m->coords.at[i].symbol)) m->uses_units = true;
  }
  pl_model_each_slot(m, see_unit, m);
}

// Velocities and accelerations exist for every coordinate from here on, with their dimension.
static void make_derivatives(pl_model* m) {
  for (int i = 0; i < m->coords.n; i++) {
    pl_symbol q = m->coords.at[i].symbol;
    if (q.id && pl_symbol_get(m->pool, q)->role == PL_R_COORD)
      pl_symbol_dot(m->pool, pl_symbol_dot(m->pool, q));
  }
}

void pl_check_dimensions(pl_job* job, pl_model* m) {
  pl_dim_pass d = {.job = job, .model = m, .pool = m->pool, .arena = pl_pool_arena(m->pool)};
  d.system.arena = d.arena;
  d.form_of = pl_map_make(d.arena);
  d.var_of = pl_map_make(d.arena);
  d.constant = pl_map_make(d.arena);
  make_derivatives(m);
  d.values = pl_model_values(m, d.arena);
  look_for_units(&d);
  d.silent = !m->uses_units;
  walk_model(&d);
  settle(&d);
  if (d.silent) return;
  pl_dim_report_bare_numbers(&d);
  pl_find_torques(m);
}

// -------------------------------------------------------------------------------- asked afterwards
static bool known_symbol(const pl_model* m, pl_symbol s, int dots, pl_dimension* out) {
  const pl_symbol_info* info = pl_symbol_get(m->pool, s);
  if (info->dimension_known) {
    *out = info->dimension;
  } else if (info->role == PL_R_TIME) {
    *out = pl_dimension_of(0, 0, 1);
  } else if (info->role == PL_R_INDEX) {
    *out = pl_dimension_one();
  } else if (info->base.id
             && (info->role == PL_R_VELOCITY || info->role == PL_R_ACCELERATION
                 || info->role == PL_R_START)) {
    return known_symbol(m, info->base, dots + info->dots, out);
  } else {
    return false;
  }
  if (dots) *out = pl_dimension_mul(*out, pl_dimension_of(0, 0, -dots));
  return true;
}

// A sum or a choice has the dimension of the first part that is no bare number.
static bool known_first(const pl_model* m, pl_expr e, int from, pl_dimension* out) {
  *out = pl_dimension_one();
  for (int i = from; i < pl_n_args(m->pool, e); i++) {
    pl_expr x = pl_arg(m->pool, e, i);
    if (!pl_is_constant(m->pool, x)) return pl_known_dimension(m, x, out);
  }
  return true;
}

static bool known_product(const pl_model* m, pl_expr e, pl_dimension* out) {
  pl_exponents sum = pl_exponents_zero();
  for (int i = 0; i < pl_n_args(m->pool, e); i++) {
    pl_dimension x;
    if (!pl_known_dimension(m, pl_arg(m->pool, e, i), &x)) return false;
    sum = pl_exponents_add(sum, (pl_fraction){1, 1}, pl_exponents_of(x));
  }
  return pl_exponents_get_dimension(sum, out);
}

static bool known_power(const pl_model* m, pl_expr e, pl_dimension* out) {
  long num, den;
  pl_dimension base;
  if (!pl_known_dimension(m, pl_arg(m->pool, e, 0), &base)) return false;
  if (pl_dimension_equal(base, pl_dimension_one())) {
    *out = base;
    return true;
  }
  if (!pl_is_ratio(m->pool, pl_arg(m->pool, e, 1), &num, &den)) return false;
  pl_exponents x = pl_exponents_add(pl_exponents_zero(), pl_fraction_make(num, den),
                                    pl_exponents_of(base));
  return pl_exponents_get_dimension(x, out);
}

bool pl_known_dimension(const pl_model* m, pl_expr e, pl_dimension* out) {
  *out = pl_dimension_one();
  switch (pl_kind_of(m->pool, e)) {
    case PL_POISON: return false;
    case PL_SYMBOL: return known_symbol(m, pl_symbol_of(m->pool, e), 0, out);
    case PL_AT: return known_symbol(m, pl_symbol_of(m->pool, e), pl_dots_of(m->pool, e), out);
    case PL_ADD: return known_first(m, e, 0, out);
    case PL_MUL: return known_product(m, e, out);
    case PL_POW: return known_power(m, e, out);
    case PL_IF: return known_first(m, e, 1, out);
    case PL_SUM: return pl_known_dimension(m, pl_arg(m->pool, e, pl_n_args(m->pool, e) - 1), out);
    case PL_UNKNOWN_FUNCTION: return false;
    case PL_CALL: {
      pl_function f = pl_function_of(m->pool, e);
      return f == PL_ABS || f == PL_MIN || f == PL_MAX ? known_first(m, e, 0, out) : true;
    }
    default: return true;
  }
}

bool pl_model_dimension(const pl_model* m, pl_expr e, pl_dimension* out) {
  *out = pl_dimension_one();
  return m->uses_units && pl_known_dimension(m, e, out);
}
