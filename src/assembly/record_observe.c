// record, second half: what is looked at along the motion. Energies, forces on masses, outputs,
// events and branches become observer and watch patterns with slots of their own, since they may
// speak of any coordinate and multiplier.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "assembly/contact_geometry.h"
#include "assembly/assembly_impl.h"

// --------------------------------------------------------------------------------------- observers
// Energy as it is conserved: sum of v dL/dv - L, which is T + V for ordinary potentials.
static pl_expr without_velocity_part(pl_recorder* r, pl_record_group* g, pl_expr V) {
  pl_pool* p = r->pool;
  pl_expr sum = V;
  for (int i = 0; i < g->atoms.n; i++) {
    pl_expr v = pl_dt(p, g->atoms.at[i]);
    pl_expr slope = pl_kind_of(p, v) == PL_SYMBOL ? pl_diff(p, V, pl_symbol_of(p, v))
                                                  : pl_diff_at(p, V, v);
    sum = pl_sub(p, sum, pl_mul(p, v, slope));
  }
  return sum;
}

// Energies of a group. What a `lagrangian` says is split by degree in the velocities: its part of
// degree 2 is kinetic, that of degree 0 a potential with the other sign, and one of degree 1 does
// not enter.
typedef struct pl_energies {
  pl_expr T, V, E;
} pl_energies;

static pl_expr at_rest(pl_recorder* r, pl_record_group* g, pl_expr e) {
  for (int i = 0; i < g->atoms.n; i++)
    e = pl_subst_expr(r->pool, e, pl_dt(r->pool, g->atoms.at[i]), pl_int(r->pool, 0));
  return e;
}

// Whether something but squares of velocities may stand in T or L.
static bool has_written_energies(const pl_recorder* r) {
  for (int i = 0; i < r->model->loads.n; i++) {
    pl_load_kind kind = r->model->loads.at[i].kind;
    if (kind == PL_L_LAGRANGIAN || kind == PL_L_KINETIC) return true;
  }
  return false;
}

static bool has_lagrangian(const pl_recorder* r) {
  for (int i = 0; i < r->model->loads.n; i++)
    if (r->model->loads.at[i].kind == PL_L_LAGRANGIAN) return true;
  return false;
}

// E is Jacobi's integral, sum of v dL/dv - L, which is T2 - T0 + V. Where t stands in the places of
// masses or in constraints, T + V is the energy and that integral is another quantity; a
// `lagrangian` knows of no places.
static bool is_jacobis(const pl_recorder* r) {
  return has_written_energies(r) && (!r->explicit_time || has_lagrangian(r));
}

static pl_energies energies_of(pl_recorder* r, pl_record_group* g) {
  pl_pool* p = r->pool;
  pl_expr of_L = without_velocity_part(r, g, pl_neg(p, g->L)), still = at_rest(r, g, of_L);
  pl_energies e = {.V = without_velocity_part(r, g, g->V), .T = g->T};
  if (pl_is_poison(still)) still = of_L;
  e.T = pl_add(p, e.T, pl_sub(p, of_L, still));
  e.V = pl_add(p, e.V, still);
  e.E = pl_add(p, e.T, e.V);
  if (!is_jacobis(r)) return e;
  e.E = pl_add(p, pl_neg(p, without_velocity_part(r, g, g->T)),
               pl_add(p, pl_sub(p, of_L, still), e.V));
  return e;
}

static pleuel_status observe(pl_recorder* r, pl_record_group* g, const pl_expr* out,
                             const int* column, int n, const pl_expr* lambda,
                             const int* constraints, int n_c, pl_pattern* pattern) {
  int* where = PL_ARRAY(r->arena, int, (size_t)g->instances.n*(size_t)n + 1);
  int* c = PL_ARRAY(r->arena, int, (size_t)g->instances.n*(size_t)n_c + 1);
  for (int i = 0; i < g->instances.n; i++) {
    for (int k = 0; k < n; k++) where[i * n + k] = column[k];
    for (int k = 0; k < n_c; k++) c[i * n_c + k] = constraints[k];
  }
  PL_TRY(pl_record_check(r, out, n));
  pl_pattern_source s = {.n_outputs = n, .output = out, .n = g->instances.n, .out = where, .c = c};
  pl_record_slots(r, g, lambda, n_c, &s.slots);
  PL_TRY(pl_record_place(r, g, &s));
  return pl_pattern_record(r->job, r->pool, &s, pattern);
}

// Expressions outside of families, with multipliers: their own slots, since they may speak of any
// coordinate.
typedef struct pl_watching {
  pl_record_group* group;
  PL_VEC(pl_expr) output;
  PL_VEC(int) column;
  PL_VEC(pl_expr) lambda;
  PL_VEC(int) constraints;
} pl_watching;

static pl_watching* watching_make(pl_recorder* r) {
  pl_watching* w = PL_NEW(r->arena, pl_watching);
  w->group = PL_NEW(r->arena, pl_record_group);
  w->group->atom_at = pl_map_make(r->arena);
  w->group->seen = pl_map_make(r->arena);
  w->group->instances.n = 1;
  return w;
}

// The row of a multiplier: λ_g1 as a symbol, λ_c[3] as an element; -1 if there is none.
static int constraint_of_multiplier(pl_recorder* r, pl_expr atom) {
  pl_symbol lambda = pl_symbol_of(r->pool, atom);
  int slip = pl_record_friction_row(r, lambda);
  if (slip >= 0) return slip;
  long index = 0;
  bool element = pl_kind_of(r->pool, atom) == PL_AT;
  if (element && !pl_record_index(r, pl_arg(r->pool, atom, 0), &index)) return -1;
  for (int i = 0; i < r->model->constraints.n; i++) {
    const pl_constraint* c = &r->model->constraints.at[i];
    if (c->lambda.id != lambda.id) continue;
    if (!element) return c->block ? -1 : r->first_constraint[i];
    // a member that was written out has the name of the member
    const char* own = c->name.ascii ? c->name.ascii : c->name.text;
    const char* name = strchr(own, '[') ? own : pl_format(r->arena, "%s[%ld]", own, index);
    char* end = strchr(name, '[') + 1;
    if (strtol(end, NULL, 10) != index) continue;
    int last = i + 1 < r->model->constraints.n ? r->first_constraint[i + 1] : r->out->n_declared;
    for (int k = r->first_constraint[i]; k < last; k++) {
      if (strcmp(r->out->setup.constraints[k].name, name) == 0) return k;
    }
  }
  return -1;
}

// Adds the multipliers of e to the slots.  false: one of them belongs to no constraint.
static bool collect_multipliers(pl_recorder* r, pl_watching* w, pl_map* seen, pl_expr e) {
  if (pl_is_poison(e) || pl_map_get(seen, e.id)) return true;
  pl_map_set(seen, e.id, 1);
  pl_kind kind = pl_kind_of(r->pool, e);
  bool named = kind == PL_SYMBOL || kind == PL_AT;
  if (named && pl_symbol_get(r->pool, pl_symbol_of(r->pool, e))->role == PL_R_MULTIPLIER) {
    for (int i = 0; i < w->lambda.n; i++) {
      if (pl_same(w->lambda.at[i], e)) return true;
    }
    int constraint = constraint_of_multiplier(r, e);
    if (constraint < 0) return false;
    pl_push(r->arena, w->lambda, e);
    pl_push(r->arena, w->constraints, constraint);
    return true;
  }
  for (int i = 0; i < pl_n_args(r->pool, e); i++) {
    if (!collect_multipliers(r, w, seen, pl_arg(r->pool, e, i))) return false;
  }
  return true;
}

// Energies of the whole system as one expression: only without families.
static pl_expr energy_of(pl_recorder* r, pl_result_kind kind) {
  if (r->groups.n > 1) return pl_poison();
  pl_record_group* g = r->groups.at[0];
  pl_pool* p = r->pool;
  switch (kind) {
    case PL_RES_T: return energies_of(r, g).T;
    case PL_RES_V: return pl_add(p, g->V, at_rest(r, g, pl_neg(p, g->L)));
    case PL_RES_L: return pl_add(p, g->L, pl_sub(p, g->T, g->V));
    case PL_RES_E: return energies_of(r, g).E;
    default: return pl_poison();
  }
}

// The constraint of a label as one without a family, and its multiplier: of `c[3]` the member 3 of
// c. false: there is no such.
static bool single_constraint(pl_recorder* r, const char* label, pl_constraint* out,
                              pl_expr* lambda) {
  const pl_constraint* c = pl_model_constraint(r->model, label);
  if (!c || !c->lambda.id) return false;
  *out = *c;
  const char* open = strchr(label, '[');
  long member = open ? strtol(open + 1, NULL, 10) : 0, index = 0;
  pl_expr at = pl_int(r->pool, member);
  *lambda = open ? pl_at(r->pool, c->lambda, 0, at) : pl_sym(r->pool, c->lambda);
  if (!c->block) return true;
  pl_instances in;
  if (!open || pl_model_instances(r->job, r->model, c->block, &in) != PLEUEL_OK) return false;
  for (int k = 0; k < in.n; k++) {
    pl_expr name = c->name.index;
    out->g = c->g;
    for (int d = 0; d < in.depth; d++) {
      pl_expr value = pl_int(r->pool, in.index[k * in.depth + d]);
      name = pl_subst1(r->pool, name, in.symbol[d], value);
      out->g = pl_subst1(r->pool, out->g, in.symbol[d], value);
    }
    if (!pl_record_index(r, name, &index) || index != member) continue;
    out->block = NULL;
    return true;
  }
  return false;
}

// What a result name stands for: T, λ-dependent sizes of forces; poison when this version has no
// number for it.
static pl_expr result_value(pl_recorder* r, const pl_result_name* name) {
  if (name->kind != PL_RES_FORCE_NORM && name->kind != PL_RES_NORMAL)
    return energy_of(r, name->kind);
  pl_constraint c;
  pl_expr lambda;
  if (!single_constraint(r, name->label, &c, &lambda)) return pl_poison();
  return pl_mul(r->pool, pl_call(r->pool, PL_ABS, lambda), pl_force_length(r, &c));
}

static pl_expr with_results(pl_recorder* r, pl_expr e) {
  for (int i = 0; i < r->model->result_names.n; i++) {
    const pl_result_name* name = &r->model->result_names.at[i];
    if (pl_has_symbol(r->pool, e, name->symbol))
      e = pl_subst1(r->pool, e, name->symbol, result_value(r, name));
  }
  return e;
}

// Start values such as x(0) and E(0) in what is watched: found by looking for the start once,
// without anything watched.
static pleuel_status settle_start_values(pl_recorder* r) {
  if (r->start_settled) return PLEUEL_OK;
  r->start_settled = true;
  pl_setup bare = r->out->setup;
  bare.n_out = bare.n_observers = bare.n_events = bare.n_watched = bare.n_watch_patterns = 0;
  bare.kinetic = bare.potential = -1;
  bare.energy = 0;
  bare.energy_conserved = false;
  PL_TRY(pl_record_branches(r));
  bare.branches = r->out->setup.branches;
  bare.n_branches = r->out->setup.n_branches;
  bare.n_branch_outputs = r->out->setup.n_branch_outputs;
  bare.branch_patterns = r->out->setup.branch_patterns;
  bare.n_branch_patterns = r->out->setup.n_branch_patterns;
  pl_run_options how = {.t_0 = r->out->t_0, .t_end = r->out->t_0, .start_only = true};
  pl_run* run = NULL;
  PL_TRY(pl_run_make(r->job, &bare, &how, &run));
  pleuel_status s = pl_run_start(run);
  const double *q = pl_run_q(run), *v = pl_run_v(run);
  int n_symbols = pl_symbol_count(r->pool);
  double* value = PL_ARRAY(r->arena, double, n_symbols + 4 * r->out->flat.n + 4);
  memcpy(value, r->value, (size_t)r->n_value * sizeof *value);
  for (int i = 0; s == PLEUEL_OK && i < r->out->flat.n; i++) {
    pl_expr atom = r->out->flat.at[i];
    if (pl_kind_of(r->pool, atom) != PL_SYMBOL) continue;
    pl_symbol x = pl_symbol_of(r->pool, atom), x_dot = pl_symbol_dot(r->pool, x);
    value[x.id] = q[i];
    value[x_dot.id] = v[i];
    value[pl_symbol_start(r->pool, x).id] = q[i];
    value[pl_symbol_start(r->pool, x_dot).id] = v[i];
  }
  value[pl_time(r->pool).id] = r->out->t_0;
  for (int i = 0; s == PLEUEL_OK && i < r->model->result_names.n; i++) {
    const pl_result_name* name = &r->model->result_names.at[i];
    pl_symbol start = pl_symbol_find(
        r->pool, pl_format(r->arena, "%s_0", pl_symbol_get(r->pool, name->symbol)->name));
    pl_expr energy = start.id ? energy_of(r, name->kind) : pl_poison();
    if (!pl_is_poison(energy) && (int)start.id <= n_symbols)
      value[start.id] = pl_eval(r->pool, energy, value);
  }
  pl_run_free(run);
  value[pl_time(r->pool).id] = NAN;
  // coordinates move on: only their start values stay
  for (int i = 0; i < r->out->flat.n; i++) {
    if (pl_kind_of(r->pool, r->out->flat.at[i]) != PL_SYMBOL) continue;
    pl_symbol x = pl_symbol_of(r->pool, r->out->flat.at[i]);
    value[x.id] = value[pl_symbol_dot(r->pool, x).id] = NAN;
  }
  r->value = value;
  r->n_value = pl_symbol_count(r->pool) + 1;
  return s;
}

// `convention lambda-minus`: the λ of the text is the negative of the solver's, whose forces are λ
// ∇g.
static pl_expr minus_multipliers(pl_recorder* r, pl_expr e) {
  for (int i = 0; i < r->model->constraints.n; i++) {
    pl_symbol s = r->model->constraints.at[i].lambda;
    if (s.id && !r->model->constraints.at[i].block && pl_has_symbol(r->pool, e, s))
      e = pl_subst1(r->pool, e, s, pl_neg(r->pool, pl_sym(r->pool, s)));
  }
  return e;
}

// A size of a force in e that virtual work does not give (contact_geometry.h); NULL if there is
// none.
static const char* undetermined_force(pl_recorder* r, pl_expr e) {
  for (int i = 0; i < r->model->result_names.n; i++) {
    const pl_result_name* name = &r->model->result_names.at[i];
    bool of_force = name->kind == PL_RES_FORCE_NORM || name->kind == PL_RES_NORMAL;
    pl_constraint c;
    pl_expr lambda;
    if (!of_force || !pl_has_symbol(r->pool, e, name->symbol)) continue;
    if (!single_constraint(r, name->label, &c, &lambda)) continue;
    if (pl_is_poison(pl_force_length(r, &c))) return name->label;
  }
  return NULL;
}

static pleuel_status no_number(pl_recorder* r, pl_expr e, const char* what) {
  const char* label = undetermined_force(r, e);
  if (label) {
    return pl_fail(r->job, PLEUEL_UNSUPPORTED,
                   "%s: the coordinates of the masses do not determine the whole force of %s, or "
                   "it differs from mass to mass; give each mass a coordinate for each axis",
                   what, label);
  }
  return pl_fail(r->job, PLEUEL_UNSUPPORTED, "%s: this version cannot compute it along the motion",
                 what);
}

// Adds an expression; its place among the outputs is the next. PLEUEL_UNSUPPORTED when it has no
// number.
static pleuel_status watch(pl_recorder* r, pl_watching* w, pl_expr e, int column,
                           const char* what) {
  pl_expr plain = pl_record_plain(
      r, with_results(r, r->model->lambda_minus ? minus_multipliers(r, e) : e));
  bool known = !pl_is_poison(plain) && !pl_has_role(r->pool, plain, PL_R_LOCAL)
               && !pl_has_role(r->pool, plain, PL_R_MOMENTUM);
  if (known
      && (pl_has_role(r->pool, plain, PL_R_START) || pl_has_role(r->pool, plain, PL_R_CONSTANT)))
    PL_TRY(settle_start_values(r));
  if (known) known = collect_multipliers(r, w, pl_map_make(r->arena), plain);
  if (!known) return no_number(r, e, what);
  pl_group_atoms(r, w->group, plain);
  pl_push(r->arena, w->output, plain);
  pl_push(r->arena, w->column, column);
  return PLEUEL_OK;
}

static pleuel_status watching_record(pl_recorder* r, pl_watching* w, const pl_pattern** patterns,
                                     int* n) {
  *n = 0;
  if (w->output.n == 0) return PLEUEL_OK;
  pl_pattern* p = PL_NEW(r->arena, pl_pattern);
  PL_TRY(observe(r, w->group, w->output.at, w->column.at, w->output.n, w->lambda.at,
                 w->constraints.at, w->lambda.n, p));
  *patterns = p;
  *n = 1;
  return PLEUEL_OK;
}

// The force of a constraint on a mass whose position is given by coordinates of its own, along one
// axis: λ dg/dx. Poison where there is none, or where it is λ itself.
static pl_expr force_along(pl_recorder* r, const pl_constraint* c, const pl_mass* m, int axis) {
  pl_pool* p = r->pool;
  if (c->block || m->block || !c->lambda.id || pl_kind_of(p, m->point.at[axis]) != PL_SYMBOL)
    return pl_poison();
  pl_symbol x = pl_symbol_of(p, m->point.at[axis]);
  if (pl_symbol_get(p, x)->role != PL_R_COORD) return pl_poison();
  for (int i = 0; i < r->model->masses.n; i++) {
    const pl_mass* other = &r->model->masses.at[i];
    for (int j = 0; other != m && j < other->point.n; j++) {
      if (pl_has_symbol(p, other->point.at[j], x)) return pl_poison();
    }
  }
  pl_expr slope = pl_diff(p, c->g, c->has_velocity ? pl_symbol_dot(p, x) : x);
  long n;
  if (pl_is_zero_node(p, slope) || (pl_is_int(p, slope, &n) && (n == 1 || n == -1)))
    return pl_poison();
  pl_expr force = pl_mul(p, pl_sym(p, c->lambda), slope);
  return r->model->lambda_minus ? pl_neg(p, force) : force;
}

typedef PL_VEC(pl_column) pl_columns;

// Friction in space: the components of its force.
static pleuel_status watch_friction(pl_recorder* r, pl_watching* w, pl_columns* columns) {
  for (int i = 0; i < r->frictions.n; i++) {
    const pl_friction_source* s = r->frictions.at[i];
    if (s->n_rows != 3 || s->group->block) continue;
    for (int j = 0; j < 3; j++) {
      const char* name = pl_format(r->arena, "friction_%s_%s",
                                   r->model->constraints.at[s->constraint].name.ascii,
                                   r->model->axes[j].ascii);
      PL_TRY(watch(r, w, pl_record_friction_force(r, s, j), columns->n, name));
      pl_push(r->arena, *columns, (pl_column){name, r->model->uses_units ? "N" : ""});
    }
  }
  return PLEUEL_OK;
}

static pleuel_status watch_forces(pl_recorder* r, pl_watching* w, pl_columns* columns) {
  const pl_model* m = r->model;
  for (int i = 0; i < m->constraints.n; i++) {
    for (int k = 0; k < m->masses.n; k++) {
      for (int axis = 0; axis < m->masses.at[k].point.n; axis++) {
        pl_expr force = force_along(r, &m->constraints.at[i], &m->masses.at[k], axis);
        if (pl_is_poison(force)) continue;
        const char* name = pl_format(r->arena, "force_%s_%s_%s", m->constraints.at[i].name.ascii,
                                     m->masses.at[k].name.ascii, m->axes[axis].ascii);
        PL_TRY(watch(r, w, force, columns->n, name));
        pl_push(r->arena, *columns, (pl_column){name, m->uses_units ? "N" : ""});
      }
    }
  }
  return PLEUEL_OK;
}

// What is only looked at may have no number: then it has no column, and the run goes on without it.
static bool can_watch(pl_recorder* r, pl_watching* w, const pl_output* o, int column) {
  pl_expr plain = pl_record_plain(r, with_results(r, o->value));
  bool known = !pl_is_poison(plain) && pl_record_check(r, &plain, 1) == PLEUEL_OK;
  known = known && watch(r, w, o->value, column, o->name) == PLEUEL_OK;
  if (known) return true;
  r->job->message[0] = '\0';
  r->job->status = PLEUEL_OK;
  return false;
}

static const char* unit_of_output(pl_recorder* r, pl_expr value, pl_dimension d) {
  pl_symbol named = pl_kind_of(r->pool, value) == PL_SYMBOL ? pl_symbol_of(r->pool, value)
                                                            : (pl_symbol){0};
  return pl_unit_of_symbol(r->arena, r->pool, named, d, true);
}

static pleuel_status watch_outputs(pl_recorder* r, pl_watching* w, pl_columns* columns) {
  const pl_model* m = r->model;
  // that something looked at contains t says nothing about the motion
  bool explicit_time = r->explicit_time;
  for (int i = 0; i < m->outputs.n; i++) {
    const pl_output* o = &m->outputs.at[i];
    if (o->optional && !can_watch(r, w, o, columns->n)) continue;
    if (!o->optional)
      PL_TRY(watch(r, w, o->value, columns->n, pl_format(r->arena, "output %s", o->name)));
    pl_dimension d;
    bool known = m->uses_units && pl_model_dimension(m, o->value, &d)
                 && !pl_dimension_equal(d, pl_dimension_one());
    pl_push(
        r->arena, *columns,
        (pl_column){pl_ascii_of(r->arena, o->name), known ? unit_of_output(r, o->value, d) : ""});
  }
  r->explicit_time = explicit_time;
  return PLEUEL_OK;
}

// A constraint on velocities does no work when it is homogeneous in them: nothing is left at rest.
static bool constraints_work(pl_recorder* r) {
  pl_pool* p = r->pool;
  for (int i = 0; i < r->model->constraints.n; i++) {
    const pl_constraint* c = &r->model->constraints.at[i];
    if (!c->has_velocity) continue;
    pl_watching* w = watching_make(r);
    pl_group_atoms(r, w->group, c->g);
    pl_expr rest = c->g;
    for (int k = 0; k < w->group->atoms.n; k++)
      rest = pl_subst_expr(p, rest, pl_dt(p, w->group->atoms.at[k]), pl_int(p, 0));
    for (uint64_t seed = 1; seed <= 3; seed++) {
      bool ok;
      uint64_t residue = pl_eval_mod(pl_mod_point_make(r->arena, p, seed), rest, &ok);
      if (!ok || residue != 0) return true;
    }
  }
  return false;
}

pleuel_status pl_record_observers(pl_recorder* r) {
  const pl_model* m = r->model;
  pl_setup* s = &r->out->setup;
  const char* joule = m->uses_units ? "J" : "";
  pl_columns columns = {0};
  pl_pattern* pattern = PL_ARRAY(r->arena, pl_pattern, r->groups.n + 1);
  s->kinetic = 0;
  s->potential = 1;
  s->energy = is_jacobis(r) ? 2 : 0;
  pl_push(r->arena, columns, (pl_column){pl_model_column(m, r->arena, "T"), joule});
  pl_push(r->arena, columns, (pl_column){pl_model_column(m, r->arena, "V"), joule});
  pl_push(r->arena, columns, (pl_column){pl_model_column(m, r->arena, "E"), joule});
  for (int i = 0; i < r->groups.n; i++) {
    pl_record_group* g = r->groups.at[i];
    if (g->instances.n == 0) continue;
    pl_energies e = energies_of(r, g);
    pl_expr* out = PL_ARRAY(r->arena, pl_expr, 3);
    out[0] = e.T;
    out[1] = e.V;
    out[2] = e.E;
    static const int column[3] = {0, 1, 2};
    PL_TRY(observe(r, g, out, column, 3, NULL, NULL, 0, &pattern[s->n_observers++]));
  }

  pl_watching* w = watching_make(r);
  PL_TRY(watch_forces(r, w, &columns));
  PL_TRY(watch_friction(r, w, &columns));
  PL_TRY(watch_outputs(r, w, &columns));
  const pl_pattern* more;
  int n;
  PL_TRY(watching_record(r, w, &more, &n));
  if (n) pattern[s->n_observers++] = *more;
  s->observers = pattern;
  s->out = columns.at;
  s->n_out = columns.n;
  s->energy_conserved = !r->dissipative && !r->explicit_time && !constraints_work(r);
  return PLEUEL_OK;
}

// -------------------------------------------------------------------------------- events, branches
static pleuel_status make_action(pl_recorder* r, pl_watching* w, const pl_action* a,
                                 pl_event_action* out) {
  *out = (pl_event_action){.target = -1};
  pl_start_value target = {0};
  switch (a->kind) {
    case PL_DO_STOP: out->kind = PL_ACTION_STOP; return PLEUEL_OK;
    case PL_DO_RECORD: out->kind = PL_ACTION_RECORD; return PLEUEL_OK;
    case PL_DO_RELEASE:
    case PL_DO_ATTACH:
      out->kind = a->kind == PL_DO_RELEASE ? PL_ACTION_RELEASE : PL_ACTION_ATTACH;
      out->target = pl_record_constraint(r, a->label);
      return out->target < 0 ? pl_fail(r->job, PLEUEL_USAGE, "there is no constraint %s", a->label)
                             : PLEUEL_OK;
    case PL_DO_SET:
      PL_TRY(pl_record_target(r, a->target, &target));
      out->kind = target.velocity ? PL_ACTION_SET_V : PL_ACTION_SET_Q;
      out->target = target.at;
      out->value = w->output.n;
      return watch(r, w, a->value, w->output.n, "the new value of an event");
  }
  return PLEUEL_OK;
}

// The size of the terms of a sum: what its rounding error is relative to.  Poison when it is none.
static pl_expr size_of_terms(pl_recorder* r, pl_expr e) {
  if (pl_kind_of(r->pool, e) != PL_ADD) return pl_poison();
  pl_expr size = pl_int(r->pool, 0);
  for (int i = 0; i < pl_n_args(r->pool, e); i++)
    size = pl_add(r->pool, size, pl_call(r->pool, PL_ABS, pl_arg(r->pool, e, i)));
  return size;
}

pleuel_status pl_record_events(pl_recorder* r) {
  const pl_model* m = r->model;
  pl_setup* s = &r->out->setup;
  pl_event_setup* events = PL_ARRAY(r->arena, pl_event_setup, m->events.n + 1);
  pl_watching* w = watching_make(r);
  for (int i = 0; i < m->events.n; i++) {
    const pl_event* e = &m->events.at[i];
    pl_event_action* actions = PL_ARRAY(r->arena, pl_event_action, e->actions.n + 1);
    const char* name = e->name.ascii ? e->name.ascii : e->name.text;
    events[i] = (pl_event_setup){.name = name,
                                 .watch = w->output.n,
                                 .direction = e->direction,
                                 .n_actions = e->actions.n,
                                 .actions = actions};
    PL_TRY(watch(r, w, e->value, w->output.n, pl_format(r->arena, "event %s", name)));
    pl_expr size = size_of_terms(r, e->value);
    if (!pl_is_poison(size)) {
      events[i].size = w->output.n + 1;
      PL_TRY(watch(r, w, size, w->output.n, pl_format(r->arena, "event %s", name)));
    }
    for (int k = 0; k < e->actions.n; k++)
      PL_TRY(make_action(r, w, &e->actions.at[k], &actions[k]));
  }
  if (r->variation)
    PL_TRY(pl_variation_watch(r, w->group, w->output.at, w->output.n, w->lambda.at,
                              w->constraints.at, w->lambda.n));
  s->events = events;
  s->n_events = m->events.n;
  s->n_watched = w->output.n;
  return watching_record(r, w, &s->watch, &s->n_watch_patterns);
}

static const char* relation_text(pl_relation relation) {
  static const char* const text[] = {
      [PL_EQ] = "=", [PL_GE] = ">=", [PL_LE] = "<=", [PL_GT] = ">", [PL_LT] = "<", [PL_NE] = "!="};
  return text[relation];
}

pleuel_status pl_record_branches(pl_recorder* r) {
  const pl_model* m = r->model;
  pl_setup* s = &r->out->setup;
  pl_branch_setup* branches = PL_ARRAY(r->arena, pl_branch_setup, m->branches.n + 1);
  pl_watching* w = watching_make(r);
  for (int i = 0; i < m->branches.n; i++) {
    const pl_condition* c = &m->branches.at[i];
    const char* text = pl_format(r->arena, "%s %s %s", pl_expr_text(r->arena, r->pool, c->left),
                                 relation_text(c->relation),
                                 pl_expr_text(r->arena, r->pool, c->right));
    int relation = c->relation == PL_GT || c->relation == PL_GE   ? 1
                   : c->relation == PL_LT || c->relation == PL_LE ? -1
                                                                  : 0;
    branches[i] = (pl_branch_setup){text, i, relation};
    if (pl_has_role(r->pool, c->left, PL_R_START) || pl_has_role(r->pool, c->right, PL_R_START)) {
      return pl_fail(r->job, PLEUEL_UNSUPPORTED,
                     "branch %s speaks of the start that it is to choose", text);
    }
    PL_TRY(watch(r, w, pl_sub(r->pool, c->left, c->right), i, text));
  }
  s->branches = branches;
  s->n_branches = m->branches.n;
  s->n_branch_outputs = m->branches.n;
  return watching_record(r, w, &s->branch_patterns, &s->n_branch_patterns);
}
