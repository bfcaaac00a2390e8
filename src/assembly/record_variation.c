// Sensitivities: derivatives of the motion by parameters and start values, integrated along with
// it.
//
// The variational equations are again those of a mechanical system. With δ the derivative of q by p
// and
//
//   L^(q, δ, v, δ') = sum δ_i dL/dq_i + δ'_i dL/dv_i + dL/dp,      g = 0,      G δ + dg/dp = 0,
//
// the equation of Lagrange for δ is that of the motion, with the multiplier of the second
// constraint as its λ; the one for q is its derivative by p, with the multiplier of the first as
// dλ/dp [NunezYepez2001]. So each pattern of the motion becomes one of twice the coordinates and
// constraints, for each direction one with a copy of the motion of its own, and the integrator
// needs no more than it has: its projection on the constraints projects δ as the derivative of the
// projection. The mass matrix is [A M; M 0], which is not definite, but as regular as M. Forces and
// nonholonomic constraints f(q, v, t) = 0 are differentiated likewise: sum f_q δ + f_v δ' + f_p.
// See theory (16.1), (16.2).
#include <ctype.h>
#include <math.h>
#include <string.h>

#include "assembly/assembly_impl.h"

enum { MOST_DIRECTIONS = 64 };

// -------------------------------------------------------------------------------------- directions
static const char* atom_name(pl_recorder* r, pl_expr atom, bool velocity) {
  const char* ascii = pl_symbol_get(r->pool, pl_symbol_of(r->pool, atom))->ascii;
  const char* dot = velocity ? "_dot" : "";
  if (pl_kind_of(r->pool, atom) != PL_AT) return pl_format(r->arena, "%s%s", ascii, dot);
  return pl_format(r->arena, "%s%s[%s]", ascii, dot,
                   pl_expr_text(r->arena, r->pool, pl_arg(r->pool, atom, 0)));
}

static bool is_parameter(pl_recorder* r, const char* name, pl_direction* d) {
  for (int i = 0; i < r->model->params.n; i++) {
    const pl_symbol_info* info = pl_symbol_get(r->pool, r->model->params.at[i].symbol);
    if (r->model->params.at[i].literal) continue;
    if (strcmp(info->ascii, name) != 0 && strcmp(info->name, name) != 0) continue;
    *d = (pl_direction){.name = info->ascii, .parameter = r->model->params.at[i].symbol, .at = -1};
    d->dimension_known = info->dimension_known;
    d->dimension = info->dimension;
    return true;
  }
  return false;
}

// x0, x_dot0, x[3]0, and the same with the coordinate as it is displayed.
static bool is_start_value(pl_recorder* r, const char* name, pl_direction* d) {
  size_t n = strlen(name);
  if (n < 2 || name[n - 1] != '0') return false;
  for (int i = 0; i < r->out->flat.n; i++) {
    pl_expr atom = r->out->flat.at[i];
    const pl_symbol_info* info = pl_symbol_get(r->pool, pl_symbol_of(r->pool, atom));
    for (int velocity = 0; velocity < 2; velocity++) {
      const char* own = atom_name(r, atom, velocity);
      bool same = strlen(own) == n - 1 && strncmp(own, name, n - 1) == 0;
      bool displayed = !velocity && pl_kind_of(r->pool, atom) == PL_SYMBOL
                       && strlen(info->name) == n - 1 && strncmp(info->name, name, n - 1) == 0;
      if (!same && !displayed) continue;
      *d = (pl_direction){.name = pl_format(r->arena, "%s0", own), .at = i, .velocity = velocity};
      pl_expr e = velocity ? pl_dt(r->pool, atom) : atom;
      d->dimension_known = r->model->uses_units && pl_model_dimension(r->model, e, &d->dimension);
      return true;
    }
  }
  return false;
}

static pleuel_status read_direction(pl_recorder* r, const char* name, pl_direction* d) {
  if (is_parameter(r, name, d) || is_start_value(r, name, d)) return PLEUEL_OK;
  return pl_fail(
      r->job, PLEUEL_USAGE,
      "there is no sensitivity to %s: name a parameter (m2) or a start value (x0, x_dot0)", name);
}

static pleuel_status read_list(pl_recorder* r, const char* list, pl_variation* v) {
  pl_direction* d = PL_ARRAY(r->arena, pl_direction, MOST_DIRECTIONS);
  for (const char* at = list; *at;) {
    size_t n = strcspn(at, ",");
    const char* from = at;
    at += n + (at[n] == ',');
    while (n > 0 && isspace((unsigned char)*from)) {
      from++;
      n--;
    }
    while (n > 0 && isspace((unsigned char)from[n - 1])) n--;
    if (n == 0) continue;
    if (v->n == MOST_DIRECTIONS)
      return pl_fail(r->job, PLEUEL_USAGE, "at most %d sensitivities at once", MOST_DIRECTIONS);
    PL_TRY(read_direction(r, pl_copy_n(r->arena, from, n), &d[v->n]));
    for (int i = 0; i < v->n; i++)
      if (strcmp(d[i].name, d[v->n].name) == 0)
        return pl_fail(r->job, PLEUEL_USAGE, "%s is asked for twice", d[i].name);
    v->n++;
  }
  v->direction = d;
  return v->n ? PLEUEL_OK
              : pl_fail(r->job, PLEUEL_USAGE,
                        "sensitivity to what? Name parameters or start values: m2,x0");
}

// Where surfaces begin to slip or stick, the derivatives have jumps that are not known here.
static pleuel_status check_smooth(pl_recorder* r) {
  const pl_model* m = r->model;
  if (m->frictions.n == 0) return PLEUEL_OK;
  return pl_fail(r->job, PLEUEL_UNSUPPORTED, "%s: sensitivities are not carried through friction",
                 m->frictions.at[0].label);
}

// The symbol of a variation; colons cannot stand in names of a model.
static void make_delta(pl_recorder* r, pl_symbol of) {
  pl_symbol_info info = *pl_symbol_get(r->pool, of);
  if (pl_map_get(r->variation->delta, of.id)) return;
  info.ascii = pl_format(r->arena, "d:%s", info.ascii);
  info.name = pl_format(r->arena, "δ%s", info.name);
  info.base = info.up = (pl_symbol){0};
  info.dots = 0;
  info.dimension_known = false;
  pl_symbol s = pl_symbol_make(r->pool, &info);
  pl_map_set(r->variation->delta, of.id, s.id);
  pl_symbol_dot(r->pool, pl_symbol_dot(r->pool, s));  // so that the values have room
}

pleuel_status pl_variation_begin(pl_recorder* r, const char* list) {
  pl_variation* v = PL_NEW(r->arena, pl_variation);
  PL_TRY(check_smooth(r));
  PL_TRY(read_list(r, list, v));
  v->delta = pl_map_make(r->arena);
  r->variation = v;
  for (int i = 0; i < r->out->flat.n; i++) make_delta(r, pl_symbol_of(r->pool, r->out->flat.at[i]));
  for (int i = 0; i < r->model->constraints.n; i++)
    if (r->model->constraints.at[i].lambda.id) make_delta(r, r->model->constraints.at[i].lambda);
  v->q = PL_ARRAY(r->arena, double, v->n * r->out->flat.n + 1);
  v->v = PL_ARRAY(r->arena, double, v->n * r->out->flat.n + 1);
  return PLEUEL_OK;
}

int pl_variation_count(const pl_recorder* r) { return r->variation ? r->variation->n : 1; }

// ------------------------------------------------------------------------------------- derivatives
pl_expr pl_variation_by_atom(pl_pool* p, pl_expr e, pl_expr atom) {
  return pl_kind_of(p, atom) == PL_SYMBOL ? pl_diff(p, e, pl_symbol_of(p, atom))
                                          : pl_diff_at(p, e, atom);
}

pl_expr pl_variation_delta(pl_recorder* r, pl_expr atom) {
  pl_pool* p = r->pool;
  pl_symbol s = {(uint32_t)pl_map_get(r->variation->delta, pl_symbol_of(p, atom).id)};
  return pl_kind_of(p, atom) == PL_SYMBOL ? pl_sym(p, s) : pl_at(p, s, 0, pl_arg(p, atom, 0));
}

// What a parameter or a kept abbreviation is, in terms of others; poison for a plain number.
static pl_expr definition(const pl_recorder* r, pl_symbol s) {
  for (int i = 0; i < r->model->params.n; i++)
    if (r->model->params.at[i].symbol.id == s.id) return r->model->params.at[i].value;
  for (int i = 0; i < r->model->lets.n; i++) {
    const pl_let* l = &r->model->lets.at[i];
    if (l->symbol.id == s.id && !l->inserted && l->n_args == 0) return l->value;
  }
  return pl_poison();
}

enum { DEEPEST = 100 };  // parameters given by parameters

// Derivative by the parameter of the direction, through parameters that are given by it.
static pl_expr by_parameter(pl_recorder* r, pl_expr e, const pl_direction* d, int depth) {
  pl_pool* p = r->pool;
  if (d->at >= 0 || pl_is_poison(e) || depth > DEEPEST) return pl_int(p, 0);
  pl_expr sum = pl_diff(p, e, d->parameter);
  int n = pl_symbols_in(p, e, NULL, 0);
  pl_symbol* s = PL_ARRAY(r->arena, pl_symbol, n + 1);
  pl_symbols_in(p, e, s, n);
  for (int i = 0; i < n; i++) {
    if (s[i].id == d->parameter.id || pl_symbol_get(p, s[i])->role != PL_R_PARAM) continue;
    pl_expr given = definition(r, s[i]);
    if (pl_is_poison(given) || pl_kind_of(p, given) == PL_NUMBER) continue;
    pl_expr inner = by_parameter(r, given, d, depth + 1);
    if (!pl_is_zero_node(p, inner)) sum = pl_add(p, sum, pl_mul(p, pl_diff(p, e, s[i]), inner));
  }
  return sum;
}

pl_expr pl_variation_by_parameter(pl_recorder* r, pl_expr e, const pl_direction* d) {
  return by_parameter(r, e, d, 0);
}

// sum e_q δ + e_v δ' + e_p
static pl_expr vary(pl_recorder* r, const pl_record_group* g, pl_expr e, const pl_direction* d) {
  pl_pool* p = r->pool;
  if (pl_is_poison(e)) return e;
  pl_expr sum = by_parameter(r, e, d, 0);
  for (int i = 0; i < g->atoms.n; i++) {
    pl_expr atom = g->atoms.at[i], delta = pl_variation_delta(r, atom);
    sum = pl_add(p, sum, pl_mul(p, pl_variation_by_atom(p, e, atom), delta));
    sum = pl_add(p, sum, pl_mul(p, pl_variation_by_atom(p, e, pl_dt(p, atom)), pl_dt(p, delta)));
  }
  return sum;
}

// ---------------------------------------------------------------------------------------- patterns
// Constraints of the pattern: the varied ones first, whose multipliers are those of the motion,
// then the others.
static void vary_constraints(pl_recorder* r, const pl_record_group* g, const pl_pattern_source* s,
                             const pl_direction* d, pl_pattern_source* out) {
  int n = s->slots.n_c;
  pl_expr* constraint = PL_ARRAY(r->arena, pl_expr, 2 * n + 1);
  pl_expr* lambda = PL_ARRAY(r->arena, pl_expr, 2 * n + 1);
  bool* velocity = PL_ARRAY(r->arena, bool, 2 * n + 1);
  for (int k = 0; k < n; k++) {
    constraint[k] = vary(r, g, s->constraint[k], d);
    constraint[n + k] = s->constraint[k];
    lambda[k] = s->slots.lambda[k];
    lambda[n + k] = pl_is_poison(lambda[k]) ? lambda[k] : pl_variation_delta(r, lambda[k]);
    velocity[k] = velocity[n + k] = s->velocity[k];
  }
  out->constraint = constraint;
  out->velocity = velocity;
  out->slots.n_c = 2 * n;
  out->slots.lambda = lambda;
}

// Forces: δQ on q, Q on δ; the multipliers in Q vary too.
static void vary_forces(pl_recorder* r, const pl_record_group* g, const pl_pattern_source* s,
                        const pl_direction* d, pl_pattern_source* out) {
  int n = g->atoms.n;
  pl_expr* force = PL_ARRAY(r->arena, pl_expr, 2 * n + 1);
  for (int i = 0; i < n; i++) {
    force[i] = force[n + i] = s->force ? s->force[i] : pl_poison();
    if (pl_is_poison(force[i])) continue;
    force[i] = vary(r, g, force[n + i], d);
    for (int c = 0; c < s->slots.n_c; c++) {
      pl_expr lambda = s->slots.lambda[c];
      if (pl_is_poison(lambda)) continue;
      force[i] = pl_add(r->pool, force[i],
                        pl_mul(r->pool, pl_variation_by_atom(r->pool, force[n + i], lambda),
                               pl_variation_delta(r, lambda)));
    }
  }
  out->force = force;
}

static void vary_places(pl_recorder* r, const pl_record_group* g, const pl_pattern_source* s,
                        int direction, pl_pattern_source* out) {
  int n = g->atoms.n, n_c = s->slots.n_c, all = r->out->flat.n, rows = r->n_constraints;
  int* q = PL_ARRAY(r->arena, int, (size_t)s->n * 2 * (size_t)n + 1);
  int* c = PL_ARRAY(r->arena, int, (size_t)s->n * 2 * (size_t)n_c + 1);
  for (int i = 0; i < s->n; i++) {
    for (int k = 0; k < n; k++) {
      q[2 * i * n + k] = s->q[i * n + k] + 2 * direction * all;
      q[2 * i * n + n + k] = s->q[i * n + k] + (2 * direction + 1) * all;
    }
    for (int k = 0; k < n_c; k++) {
      c[2 * i * n_c + k] = s->c[i * n_c + k] + 2 * direction * rows;
      c[2 * i * n_c + n_c + k] = s->c[i * n_c + k] + (2 * direction + 1) * rows;
    }
  }
  out->q = q;
  out->c = c;
}

// One pattern for each direction, from that of the motion.
pleuel_status pl_variation_record(pl_recorder* r, pl_record_group* g, const pl_pattern_source* s,
                                  pl_pattern* out) {
  int n = g->atoms.n;
  pl_expr* atoms = PL_ARRAY(r->arena, pl_expr, 2 * n + 1);
  for (int i = 0; i < n; i++) {
    atoms[i] = g->atoms.at[i];
    atoms[n + i] = pl_variation_delta(r, atoms[i]);
  }
  for (int k = 0; k < r->variation->n; k++) {
    const pl_direction* d = &r->variation->direction[k];
    pl_pattern_source varied = *s;
    varied.slots.n_q = 2 * n;
    varied.slots.q = atoms;
    varied.lagrangian = vary(r, g, s->lagrangian, d);
    vary_constraints(r, g, s, d, &varied);
    vary_forces(r, g, s, d, &varied);
    vary_places(r, g, s, k, &varied);
    PL_TRY(pl_pattern_record(r->job, r->pool, &varied, &out[k]));
  }
  return PLEUEL_OK;
}

// ------------------------------------------------------------------------------------ start values
// Derivative of one start value; those that it is given by were taken before it.
static double derivative_of_start(pl_recorder* r, const pl_start_value* s, int k) {
  const pl_direction* d = &r->variation->direction[k];
  const pl_coordinate* q = r->out->setup.coordinates;
  if (d->at == s->at && d->velocity == s->velocity) return 1;
  double sum = pl_record_number(r, pl_record_with_elements(r, by_parameter(r, s->value, d, 0), q));
  pl_record_group* g = PL_NEW(r->arena, pl_record_group);
  g->atom_at = pl_map_make(r->arena);
  g->seen = pl_map_make(r->arena);
  bool time = r->explicit_time;
  pl_group_atoms(r, g, s->value);
  r->explicit_time = time;
  for (int i = 0; i < g->atoms.n; i++) {
    pl_expr atom = g->atoms.at[i];
    int at = pl_record_global(r, atom);
    if (at < 0) continue;
    size_t place = (size_t)k * (size_t)r->out->flat.n + (size_t)at;
    for (int velocity = 0; velocity < 2; velocity++) {
      double x = velocity ? r->variation->v[place] : r->variation->q[place];
      if (x == 0) continue;
      pl_expr slope = pl_variation_by_atom(r->pool, s->value,
                                           velocity ? pl_dt(r->pool, atom) : atom);
      sum += x * pl_record_number(r, pl_record_with_elements(r, slope, q));
    }
  }
  return sum;
}

void pl_variation_of_start(pl_recorder* r, const pl_start_value* s) {
  for (int k = 0; k < r->variation->n; k++) {
    double* to = s->velocity ? r->variation->v : r->variation->q;
    to[k * r->out->flat.n + s->at] = derivative_of_start(r, s, k);
  }
}

static pleuel_status check_starts(pl_recorder* r) {
  const pl_coordinate* q = r->out->setup.coordinates;
  const pl_variation* v = r->variation;
  for (int k = 0; k < v->n; k++) {
    const pl_direction* d = &v->direction[k];
    if (d->at >= 0 && !(d->velocity ? q[d->at].has_v : q[d->at].has_q))
      return pl_fail(r->job, PLEUEL_USAGE,
                     "no sensitivity to %s: the model gives no start value for it", d->name);
    if (d->at < 0 && isnan(r->value[d->parameter.id]))
      return pl_fail(r->job, PLEUEL_USAGE, "no sensitivity to %s: it has no number", d->name);
  }
  for (int i = 0; i < v->n * r->out->flat.n; i++)
    if (!isfinite(v->q[i]) || !isfinite(v->v[i]))
      return pl_fail(r->job, PLEUEL_UNSUPPORTED, "a start value has no derivative by %s",
                     v->direction[i / r->out->flat.n].name);
  return PLEUEL_OK;
}

// ------------------------------------------------------------------------------------------- names
static const char* unit_of_quotient(pl_recorder* r, pl_expr of, const pl_direction* d) {
  pl_dimension upper;
  if (!r->model->uses_units || !d->dimension_known || !pl_model_dimension(r->model, of, &upper))
    return "";
  pl_dimension q = pl_dimension_div(upper, d->dimension);
  if (pl_dimension_equal(q, pl_dimension_one())) return "";
  return pl_dimension_unit(r->arena, q, true);
}

static void name_block(pl_recorder* r, int k, const pl_coordinate* from, pl_coordinate* to) {
  const pl_direction* d = &r->variation->direction[k];
  int n = r->out->flat.n;
  for (int i = 0; i < n; i++) {
    pl_expr atom = r->out->flat.at[i];
    to[i] = from[i];
    to[i].hidden |= k > 0;  // copies of the motion
    to[n + i] = (pl_coordinate){.hidden = from[i].hidden};
    to[n + i].name = pl_format(r->arena, "d(%s)/d(%s)", from[i].name, d->name);
    to[n + i].v_name = pl_format(r->arena, "d(%s)/d(%s)", from[i].v_name, d->name);
    to[n + i].unit = unit_of_quotient(r, atom, d);
    to[n + i].v_unit = unit_of_quotient(r, pl_dt(r->pool, atom), d);
    to[n + i].has_q = from[i].has_q;
    to[n + i].has_v = from[i].has_v;
  }
}

static void name_rows(pl_recorder* r, int k, const pl_constraint_setup* from,
                      pl_constraint_setup* to) {
  const pl_direction* d = &r->variation->direction[k];
  int n = r->n_constraints;
  for (int c = 0; c < n; c++) {
    to[c] = to[n + c] = from[c];
    if (k > 0) to[c].column = NULL;
    if (from[c].column == NULL) continue;
    to[n + c].column = pl_format(r->arena, "d(%s)/d(%s)", from[c].column, d->name);
    to[n + c].unit = "";
  }
}

// The setup of the motion becomes that of the motion and its variations.
pleuel_status pl_variation_setup(pl_recorder* r) {
  pl_setup* s = &r->out->setup;
  const pl_variation* v = r->variation;
  PL_TRY(check_starts(r));
  pl_coordinate* q = PL_ARRAY(r->arena, pl_coordinate, 2 * v->n * r->out->flat.n + 1);
  pl_constraint_setup* constraint = PL_ARRAY(r->arena, pl_constraint_setup,
                                             2 * v->n * r->n_constraints + 1);
  for (int k = 0; k < v->n; k++) {
    name_block(r, k, s->coordinates, q + 2 * k * r->out->flat.n);
    name_rows(r, k, s->constraints, constraint + 2 * k * r->n_constraints);
  }
  s->coordinates = q;
  s->constraints = constraint;
  s->n_q = 2 * v->n * r->out->flat.n;
  s->n_c = 2 * v->n * r->n_constraints;
  pl_variation_switch(r);
  r->out->n_directions = v->n;
  r->out->varied_q = v->q;
  r->out->varied_v = v->v;
  return PLEUEL_OK;
}
