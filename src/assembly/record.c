// record: from a checked model to the setup of a simulation.
//
// What stands outside of families is one pattern with one instance; each `for` block is one pattern
// with an instance for each value of its index. Map equations of `choose` become constraints of
// lower priority, so the motion is integrated in all declared coordinates as written, and nothing
// here depends on what the derivation found.
#include <math.h>
#include <string.h>

#include "assembly/assembly_impl.h"

// ----------------------------------------------------------------------------------------- numbers
double pl_record_number(pl_recorder* r, pl_expr e) {
  return pl_is_poison(e) ? (double)NAN : pl_eval(r->pool, e, r->value);
}

bool pl_record_index(pl_recorder* r, pl_expr e, long* out) {
  double x = pl_record_number(r, e);
  if (!(fabs(x) < 1e9) || fabs(x - nearbyint(x)) > 1e-6) return false;
  *out = lround(x);
  return true;
}

static void set_indices(pl_recorder* r, const pl_instances* in, int instance) {
  for (int d = 0; d < in->depth; d++)
    r->value[in->symbol[d].id] = (double)in->index[instance * in->depth + d];
}

// -------------------------------------------------------------------------------- sums written out
enum { MAX_SUM_TERMS = 20000 };  // beyond this a sum belongs into a family

static pl_expr write_out(pl_recorder* r, pl_expr sum) {
  pl_pool* p = r->pool;
  long lo, hi;
  if (!pl_record_index(r, pl_arg(p, sum, 1), &lo) || !pl_record_index(r, pl_arg(p, sum, 2), &hi))
    return pl_poison();
  if (hi - lo >= MAX_SUM_TERMS) return pl_poison();
  int n = hi >= lo ? (int)(hi - lo + 1) : 0;
  pl_expr* term = PL_ARRAY(r->arena, pl_expr, n + 1);
  pl_expr body = pl_record_plain(r, pl_arg(p, sum, 3));
  for (int k = 0; k < n; k++) term[k] = pl_subst1(p, body, pl_symbol_of(p, sum), pl_int(p, lo + k));
  return pl_add_n(p, term, n);
}

// The first sum inside e, poison if there is none.
static pl_expr find_sum(pl_recorder* r, pl_map* seen, pl_expr e) {
  if (pl_is_poison(e) || pl_map_get(seen, e.id)) return pl_poison();
  pl_map_set(seen, e.id, 1);
  if (pl_kind_of(r->pool, e) == PL_SUM) return e;
  for (int i = 0; i < pl_n_args(r->pool, e); i++) {
    pl_expr found = find_sum(r, seen, pl_arg(r->pool, e, i));
    if (!pl_is_poison(found)) return found;
  }
  return pl_poison();
}

pl_expr pl_record_plain(pl_recorder* r, pl_expr e) {
  for (;;) {
    pl_expr sum = find_sum(r, pl_map_make(r->arena), e);
    if (pl_is_poison(sum)) return e;
    pl_expr written = write_out(r, sum);
    if (pl_is_poison(written)) return written;
    e = pl_subst_expr(r->pool, e, sum, written);
  }
}

// -------------------------------------------------------------------------- coordinates of a group
static void collect(pl_recorder* r, pl_record_group* g, pl_expr e) {
  pl_pool* p = r->pool;
  if (pl_is_poison(e) || pl_map_get(g->seen, e.id)) return;
  pl_map_set(g->seen, e.id, 1);
  pl_kind kind = pl_kind_of(p, e);
  pl_expr atom = pl_poison();
  if (kind == PL_SYMBOL) {
    const pl_symbol_info* info = pl_symbol_get(p, pl_symbol_of(p, e));
    if (info->role == PL_R_TIME) r->explicit_time = true;
    if (info->role == PL_R_COORD) atom = e;
    if (info->role == PL_R_VELOCITY || info->role == PL_R_ACCELERATION)
      atom = pl_sym(p, info->base);
    while (!pl_is_poison(atom) && pl_symbol_get(p, pl_symbol_of(p, atom))->role != PL_R_COORD) {
      atom = pl_sym(p, pl_symbol_get(p, pl_symbol_of(p, atom))->base);
    }
  } else if (kind == PL_AT) {
    if (pl_symbol_get(p, pl_symbol_of(p, e))->role == PL_R_ARRAY)
      atom = pl_at(p, pl_symbol_of(p, e), 0, pl_arg(p, e, 0));
  } else {
    for (int i = 0; i < pl_n_args(p, e); i++) collect(r, g, pl_arg(p, e, i));
  }
  if (pl_is_poison(atom) || pl_map_get(g->atom_at, atom.id)) return;
  pl_push(r->arena, g->atoms, atom);
  pl_map_set(g->atom_at, atom.id, (uint64_t)g->atoms.n);
}

void pl_group_atoms(pl_recorder* r, pl_record_group* g, pl_expr e) { collect(r, g, e); }

// Global index of an atom in an instance; -1 when there is no such coordinate.
int pl_record_global(pl_recorder* r, pl_expr atom) {
  pl_expr element = atom;
  if (pl_kind_of(r->pool, atom) == PL_AT) {
    long k;
    if (!pl_record_index(r, pl_arg(r->pool, atom, 0), &k)) return -1;
    element = pl_at(r->pool, pl_symbol_of(r->pool, atom), 0, pl_int(r->pool, k));
  }
  return (int)pl_map_get(r->flat_at, element.id) - 1;
}

static pleuel_status no_such(pl_recorder* r, pl_expr atom) {
  return pl_fail(r->job, PLEUEL_USAGE, "there is no coordinate %s",
                 pl_expr_text(r->arena, r->pool, atom));
}

// ------------------------------------------------------------------------------------------ groups
static pl_record_group* group_make(pl_recorder* r, const pl_block* block) {
  pl_record_group* g = PL_NEW(r->arena, pl_record_group);
  g->block = block;
  g->atom_at = pl_map_make(r->arena);
  g->seen = pl_map_make(r->arena);
  g->T = g->V = g->L = pl_int(r->pool, 0);
  g->instances.n = 1;
  pl_push(r->arena, r->groups, g);
  return g;
}

static pleuel_status group_for(pl_recorder* r, const pl_block* block, pl_record_group** out) {
  for (int i = 0; i < r->groups.n; i++) {
    *out = r->groups.at[i];
    if ((*out)->block == block) return PLEUEL_OK;
  }
  *out = group_make(r, block);
  return pl_model_instances(r->job, r->model, block, &(*out)->instances);
}

// --------------------------------------------------------------------- loads of chosen coordinates
static bool speaks_of(pl_recorder* r, pl_expr e, pl_symbol q) {
  return !pl_is_poison(e)
         && (pl_has_symbol(r->pool, e, q) || pl_has_symbol(r->pool, e, pl_symbol_dot(r->pool, q)));
}

// A torque, an inertia or a potential of a coordinate that stands in a map: it reaches the masses
// through the map.
static bool is_loaded(pl_recorder* r, pl_symbol q) {
  const pl_model* m = r->model;
  bool mapped = false, loaded = false;
  for (int k = 0; k < m->choose.n_maps; k++)
    mapped |= pl_has_symbol(r->pool, m->choose.maps[k].map, q);
  for (int i = 0; i < m->loads.n && mapped; i++) {
    const pl_load* l = &m->loads.at[i];
    loaded |= l->coordinate.id == q.id || speaks_of(r, l->value, q);
  }
  return loaded;
}

static int count_along(pl_recorder* r) {
  int n = 0;
  for (int k = 0; k < r->model->choose.coords.n; k++)
    n += is_loaded(r, r->model->choose.coords.at[k]);
  return n;
}

// Such a load acts along the map and not across it: the row sum dX/dφ (x - X) = 0 goes before the
// maps x = X, which say the same.
static pl_expr along_equation(pl_recorder* r, int k) {
  const pl_choose* choose = &r->model->choose;
  int at = 0;
  while (!is_loaded(r, choose->coords.at[at]) || k-- > 0) at++;
  pl_expr sum = pl_int(r->pool, 0);
  for (int j = 0; j < choose->n_maps; j++) {
    pl_expr gap = pl_sub(r->pool, choose->maps[j].old, choose->maps[j].map);
    sum = pl_add(
        r->pool, sum,
        pl_mul(r->pool, pl_diff(r->pool, choose->maps[j].map, choose->coords.at[at]), gap));
  }
  return sum;
}

static pleuel_status make_groups(pl_recorder* r) {
  const pl_model* m = r->model;
  pl_record_group* g;
  group_make(r, NULL);
  for (int i = 0; i < m->masses.n; i++) PL_TRY(group_for(r, m->masses.at[i].block, &g));
  for (int i = 0; i < m->bodies.n; i++) PL_TRY(group_for(r, m->bodies.at[i].block, &g));
  for (int i = 0; i < m->loads.n; i++) PL_TRY(group_for(r, m->loads.at[i].block, &g));
  r->first_constraint = PL_ARRAY(r->arena, int, m->constraints.n + 1);
  for (int i = 0; i < m->constraints.n; i++) {
    PL_TRY(group_for(r, m->constraints.at[i].block, &g));
    pl_push(r->arena, g->constraints, i);
    r->first_constraint[i] = r->n_constraints;
    r->n_constraints += g->instances.n;
  }
  r->out->n_declared = r->first_constraint[m->constraints.n] = r->n_constraints;
  r->out->first_constraint = r->first_constraint;
  r->n_constraints += m->choose.n_maps + count_along(r);

  pl_group_energies(r);
  for (int i = 0; i < r->groups.n; i++) {
    g = r->groups.at[i];
    g->T = pl_record_plain(r, g->T);
    g->V = pl_record_plain(r, g->V);
    g->L = pl_record_plain(r, g->L);
    if (pl_is_poison(g->T) || pl_is_poison(g->V) || pl_is_poison(g->L)) {
      return pl_fail(
          r->job, PLEUEL_UNSUPPORTED,
          "the energies cannot be written down (a sum without bounds, or a division by zero)");
    }
    collect(r, g, g->T);
    collect(r, g, g->V);
    collect(r, g, g->L);
    for (int k = 0; k < g->constraints.n; k++)
      collect(r, g, m->constraints.at[g->constraints.at[k]].g);
    if (i == 0) {
      for (int k = 0; k < m->choose.n_maps; k++) {
        collect(r, g, m->choose.maps[k].old);
        collect(r, g, m->choose.maps[k].map);
      }
    }
    PL_TRY(pl_group_friction(r, g));
    pl_group_forces(r, g);
  }
  return PLEUEL_OK;
}

// ---------------------------------------------------------------------------------------- patterns
// Slots of a pattern: atoms of its coordinates, multipliers of its constraints.
void pl_record_slots(pl_recorder* r, pl_record_group* g, const pl_expr* lambda, int n_c,
                     pl_tape_slots* out) {
  *out = (pl_tape_slots){.n_q = g->atoms.n,
                         .q = g->atoms.at,
                         .n_c = n_c,
                         .lambda = lambda,
                         .n_index = g->instances.depth,
                         .index = g->instances.symbol,
                         .value_of_symbol = r->value,
                         .definition = pl_wider_definitions(r)};
}

// Fills the global coordinates and the index values of each instance.
pleuel_status pl_record_place(pl_recorder* r, pl_record_group* g, pl_pattern_source* s) {
  int* q = PL_ARRAY(r->arena, int, (size_t)s->n*(size_t)g->atoms.n + 1);
  double* index = PL_ARRAY(r->arena, double, (size_t)s->n*(size_t)g->instances.depth + 1);
  for (int i = 0; i < s->n; i++) {
    set_indices(r, &g->instances, i);
    for (int k = 0; k < g->atoms.n; k++) {
      int at = pl_record_global(r, g->atoms.at[k]);
      if (at < 0) return no_such(r, g->atoms.at[k]);
      q[i * g->atoms.n + k] = at;
    }
    for (int d = 0; d < g->instances.depth; d++)
      index[i * g->instances.depth + d] = (double)g->instances.index[i * g->instances.depth + d];
  }
  for (int d = 0; d < g->instances.depth; d++) r->value[g->instances.symbol[d].id] = NAN;
  s->q = q;
  s->index = index;
  return PLEUEL_OK;
}

// A parameter without number is the usual reason why a simulation cannot start: say which.
pleuel_status pl_record_check(pl_recorder* r, const pl_expr* e, int n) {
  for (int i = 0; i < n; i++) {
    if (pl_is_poison(e[i])) continue;
    int n_symbols = pl_symbols_in(r->pool, e[i], NULL, 0);
    pl_symbol* s = PL_ARRAY(r->arena, pl_symbol, n_symbols + 1);
    pl_symbols_in(r->pool, e[i], s, n_symbols);
    for (int k = 0; k < n_symbols; k++) {
      const pl_symbol_info* info = pl_symbol_get(r->pool, s[k]);
      if (info->role == PL_R_PARAM && isnan(r->value[s[k].id])) {
        return pl_fail(
            r->job, PLEUEL_USAGE,
            "%s has no number. Give one in the file (param %s = ...) or with --set %s=...",
            info->name, info->name, info->ascii);
      }
    }
  }
  return PLEUEL_OK;
}

static pl_expr map_equation(pl_recorder* r, int k) {
  if (k >= r->model->choose.n_maps) return along_equation(r, k - r->model->choose.n_maps);
  return pl_sub(r->pool, r->model->choose.maps[k].old, r->model->choose.maps[k].map);
}

// The constraints of a group: declared ones, map equations, then the rows of slip.
typedef struct pl_rows_of_group {
  int n, n_declared, n_maps;
  pl_expr *constraint, *lambda;
  bool* velocity;
  int* c;  // link of each, instance by instance
} pl_rows_of_group;

static void list_slip(pl_recorder* r, const pl_record_group* g, pl_rows_of_group* rows, int k) {
  for (int i = 0; i < g->frictions.n; i++) {
    const pl_friction_source* s = r->frictions.at[g->frictions.at[i]];
    for (int j = 0; j < s->n_rows; j++, k++) {
      rows->constraint[k] = s->slip[j];
      rows->velocity[k] = true;
      rows->lambda[k] = pl_poison();
      for (int in = 0; in < g->instances.n; in++)
        rows->c[in * rows->n + k] = s->first_row + in * s->n_rows + j;
    }
  }
}

static void list_rows(pl_recorder* r, const pl_record_group* g, pl_rows_of_group* rows) {
  const pl_model* m = r->model;
  *rows = (pl_rows_of_group){.n_declared = g->constraints.n,
                             .n_maps = g->block ? 0 : m->choose.n_maps + count_along(r)};
  rows->n = rows->n_declared + rows->n_maps;
  for (int i = 0; i < g->frictions.n; i++) rows->n += r->frictions.at[g->frictions.at[i]]->n_rows;
  rows->constraint = PL_ARRAY(r->arena, pl_expr, rows->n + 1);
  rows->lambda = PL_ARRAY(r->arena, pl_expr, rows->n + 1);
  rows->velocity = PL_ARRAY(r->arena, bool, rows->n + 1);
  rows->c = PL_ARRAY(r->arena, int, (size_t)g->instances.n*(size_t)rows->n + 1);
  for (int k = 0; k < rows->n_declared + rows->n_maps; k++) {
    bool is_map = k >= g->constraints.n;
    const pl_constraint* source = is_map ? NULL : &m->constraints.at[g->constraints.at[k]];
    rows->constraint[k] = is_map ? map_equation(r, k - g->constraints.n)
                                 : pl_record_plain(r, source->g);
    rows->velocity[k] = !is_map && source->has_velocity;
    rows->lambda[k] = is_map || !source->lambda.id ? pl_poison() : pl_sym(r->pool, source->lambda);
    int first = is_map ? r->out->n_declared + k - g->constraints.n
                       : r->first_constraint[g->constraints.at[k]];
    for (int i = 0; i < g->instances.n; i++) rows->c[i * rows->n + k] = is_map ? first : first + i;
  }
  list_slip(r, g, rows, rows->n_declared + rows->n_maps);
}

// Coefficients of friction are outputs of the pattern.
static void list_coefficients(pl_recorder* r, const pl_record_group* g, pl_pattern_source* s) {
  int n = 0;
  for (int i = 0; i < g->frictions.n; i++) n += r->frictions.at[g->frictions.at[i]]->n_coefficients;
  pl_expr* output = PL_ARRAY(r->arena, pl_expr, n + 1);
  int* out = PL_ARRAY(r->arena, int, (size_t)g->instances.n*(size_t)n + 1);
  int k = 0;
  for (int i = 0; i < g->frictions.n; i++) {
    const pl_friction_source* friction = r->frictions.at[g->frictions.at[i]];
    for (int j = 0; j < friction->n_coefficients; j++, k++) {
      output[k] = pl_record_plain(r, pl_record_friction_coefficient(friction, j));
      for (int in = 0; in < g->instances.n; in++)
        out[in * n + k] = friction->first_coefficient + in * friction->n_coefficients + j;
    }
  }
  s->n_outputs = n;
  s->output = output;
  s->out = out;
}

static pleuel_status record_group(pl_recorder* r, pl_record_group* g, pl_pattern* out) {
  pl_rows_of_group rows;
  list_rows(r, g, &rows);
  for (int k = 0; k < rows.n; k++)
    if (pl_is_poison(rows.constraint[k]))
      return pl_fail(r->job, PLEUEL_UNSUPPORTED, "a constraint has no value everywhere");
  pl_expr L = pl_add(r->pool, g->L, pl_sub(r->pool, g->T, g->V));
  if (r->groups.n == 1) {
    r->out->lagrangian = L;
    r->out->n_atoms = g->atoms.n;
    r->out->atom = g->atoms.at;
    r->out->force = g->force;
  }
  PL_TRY(pl_record_check(r, &L, 1));
  PL_TRY(pl_record_check(r, g->force, g->atoms.n));
  PL_TRY(pl_record_check(r, rows.constraint, rows.n));
  pl_pattern_source s = {.lagrangian = L,
                         .force = g->force,
                         .constraint = rows.constraint,
                         .velocity = rows.velocity,
                         .n = g->instances.n,
                         .c = rows.c};
  list_coefficients(r, g, &s);
  PL_TRY(pl_record_check(r, s.output, s.n_outputs));
  pl_record_slots(r, g, rows.lambda, rows.n, &s.slots);
  PL_TRY(pl_record_place(r, g, &s));
  return r->variation ? pl_variation_record(r, g, &s, out)
                      : pl_pattern_record(r->job, r->pool, &s, out);
}

static pleuel_status record_patterns(pl_recorder* r) {
  int each = pl_variation_count(r), n = 0;
  pl_pattern* p = PL_ARRAY(r->arena, pl_pattern, r->groups.n * each);
  for (int i = 0; i < r->groups.n; i++) {
    if (r->groups.at[i]->instances.n == 0) continue;
    PL_TRY(record_group(r, r->groups.at[i], &p[n]));
    n += each;
  }
  r->out->setup.patterns = p;
  r->out->setup.n_patterns = n;
  return PLEUEL_OK;
}

// ------------------------------------------------------------------------------------ names, units
// Angles have no unit of their own in the dimensions; a coordinate without dimension is shown in
// rad.
static const char* unit_of(pl_recorder* r, pl_symbol s, const char* plain) {
  const pl_symbol_info* info = pl_symbol_get(r->pool, s);
  if (!r->model->uses_units || !info->dimension_known) return "";
  return pl_dimension_equal(info->dimension, pl_dimension_one())
             ? plain
             : pl_unit_of_symbol(r->arena, r->pool, s, info->dimension, true);
}

static void name_coordinate(pl_recorder* r, pl_expr atom, pl_coordinate* out) {
  pl_symbol s = pl_symbol_of(r->pool, atom);
  pl_symbol dot = pl_symbol_dot(r->pool, s);
  bool element = pl_kind_of(r->pool, atom) == PL_AT;
  const char* ascii = pl_symbol_get(r->pool, s)->ascii;
  const char* index = element ? pl_format(r->arena, "[%s]",
                                          pl_expr_text(r->arena, r->pool, pl_arg(r->pool, atom, 0)))
                              : "";
  out->name = pl_format(r->arena, "%s%s", ascii, index);
  out->v_name = pl_format(r->arena, "%s_dot%s", ascii, index);
  out->unit = unit_of(r, s, "rad");
  pl_dimension d;
  bool angle = *out->unit && strcmp(out->unit, "rad") == 0;
  bool known = r->model->uses_units && pl_model_dimension(r->model, pl_sym(r->pool, dot), &d);
  out->v_unit = angle ? "rad/s" : known ? pl_dimension_unit(r->arena, d, true) : "";
}

int pl_record_constraint(pl_recorder* r, const char* label) {
  const pl_constraint* c = label ? pl_model_constraint(r->model, label) : NULL;
  return c ? r->first_constraint[c - r->model->constraints.at] : -1;
}

// Whether the left side of a constraint is a distance or its square: a sum of squares, or the root
// of one.
static bool is_distance(pl_recorder* r, const pl_constraint* c) {
  pl_pool* p = r->pool;
  pl_expr e = c->left;
  if (pl_kind_of(p, e) == PL_POW && !pl_is_int(p, pl_arg(p, e, 1), &(long){0})) e = pl_arg(p, e, 0);
  if (pl_kind_of(p, e) == PL_POW) return pl_is_int(p, pl_arg(p, e, 1), &(long){0});
  if (pl_kind_of(p, e) != PL_ADD) return false;
  for (int i = 0; i < pl_n_args(p, e); i++) {
    long n = 0;
    pl_expr term = pl_arg(p, e, i);
    if (pl_kind_of(p, term) != PL_POW || !pl_is_int(p, pl_arg(p, term, 1), &n) || n != 2)
      return false;
  }
  return true;
}

static void name_constraints(pl_recorder* r, int i, pl_constraint_setup* constraint) {
  const pl_constraint* c = &r->model->constraints.at[i];
  pl_record_group* g;
  if (group_for(r, c->block, &g) != PLEUEL_OK) return;
  for (int k = 0; k < g->instances.n; k++) {
    pl_constraint_setup* out = &constraint[r->first_constraint[i] + k];
    set_indices(r, &g->instances, k);
    long index;
    bool indexed = !pl_is_poison(c->name.index) && pl_record_index(r, c->name.index, &index);
    const char* suffix = indexed ? pl_format(r->arena, "[%ld]", index) : "";
    if (!indexed && c->block) suffix = pl_format(r->arena, "[%d]", k + 1);
    out->name = pl_format(r->arena, "%s%s", c->name.ascii ? c->name.ascii : c->name.text, suffix);
    // as in formulas, whatever letter `with` gives it on paper
    out->column = pl_format(r->arena, "lambda_%s", out->name);
    out->unit = c->lambda.id ? unit_of(r, c->lambda, "") : "";
    out->velocity = c->has_velocity;
    out->side = c->relation == PL_GE || c->relation == PL_GT   ? 1
                : c->relation == PL_LE || c->relation == PL_LT ? -1
                                                               : 0;
    out->contact = pl_record_constraint(r, c->while_label);
    out->off = c->off;
    const pl_restitution* bounce = pl_model_restitution(r->model, c);
    // what bounces or rubs is a surface
    out->rope = out->side < 0 && !bounce && !pl_model_friction(r->model, c) && is_distance(r, c);
    out->restitution = bounce ? pl_record_number(r, bounce->value) : 0;
    out->minus = r->model->lambda_minus;
  }
}

// ---------------------------------------------------------------------- what maps take for granted
// A constraint that may be missing: a contact, or what an event releases or attaches.
static bool may_be_missing(const pl_model* m, const pl_constraint* c) {
  if (c->block) return false;
  if (c->relation != PL_EQ || c->off || c->while_label) return true;
  for (int i = 0; i < m->events.n; i++) {
    const pl_event* e = &m->events.at[i];
    for (int k = 0; k < e->actions.n; k++) {
      bool action = e->actions.at[k].kind == PL_DO_RELEASE || e->actions.at[k].kind == PL_DO_ATTACH;
      if (action && e->actions.at[k].label && pl_model_constraint(m, e->actions.at[k].label) == c)
        return true;
    }
  }
  return false;
}

static bool vanishes(pl_recorder* r, pl_expr e) {
  for (uint64_t seed = 1; seed <= 3; seed++) {
    bool ok;
    uint64_t residue = pl_eval_mod(pl_mod_point_make(r->arena, r->pool, seed), e, &ok);
    if (!ok || residue != 0) return false;
  }
  return true;
}

// Whether g is zero identically with the maps that are marked.
static bool is_granted(pl_recorder* r, const pl_constraint* c, const bool* map) {
  const pl_choose* choose = &r->model->choose;
  pl_expr e = c->g;
  for (int k = 0; k < choose->n_maps; k++) {
    if (map[k]) e = pl_subst_expr(r->pool, e, choose->maps[k].old, choose->maps[k].map);
  }
  return vanishes(r, e);
}

// The fewest maps that make a constraint an identity; false: they do not.
static bool maps_granting(pl_recorder* r, const pl_constraint* c, bool* map) {
  int n = r->model->choose.n_maps;
  for (int k = 0; k < n; k++) map[k] = true;
  if (c->has_velocity || !is_granted(r, c, map)) return false;
  for (int k = 0; k < n; k++) {
    map[k] = false;
    if (!is_granted(r, c, map)) map[k] = true;
  }
  return true;
}

// Maps that go with constraint i: those that it is granted by, but for those that the others are
// granted by too.
static void list_own_maps(int i, int n_c, int n_maps, const bool* granted, const bool* map,
                          bool* own) {
  bool any = false;
  for (int k = 0; k < n_maps; k++) {
    own[k] = map[i * n_maps + k];
    for (int j = 0; j < n_c; j++)
      own[k] = own[k] && (j == i || !granted[j] || !map[j * n_maps + k]);
    any |= own[k];
  }
  for (int k = 0; k < n_maps && !any; k++) own[k] = map[i * n_maps + k];
}

static void find_needs(pl_recorder* r, pl_constraint_setup* map_constraint) {
  const pl_model* m = r->model;
  int n_c = m->constraints.n, n_maps = m->choose.n_maps;
  if (n_maps == 0) return;
  bool *granted = PL_ARRAY(r->arena, bool, n_c + 1),
       *map = PL_ARRAY(r->arena, bool, n_c*n_maps + 1), *own = PL_ARRAY(r->arena, bool, n_maps);
  bool any = false;
  for (int i = 0; i < n_c; i++) any |= may_be_missing(m, &m->constraints.at[i]);
  for (int i = 0; i < n_c && any; i++) {
    const pl_constraint* c = &m->constraints.at[i];
    granted[i] = !c->block && maps_granting(r, c, &map[i * n_maps]);
  }
  for (int i = 0; i < n_c && any; i++) {
    if (!granted[i] || !may_be_missing(m, &m->constraints.at[i])) continue;
    list_own_maps(i, n_c, n_maps, granted, map, own);
    for (int k = 0; k < n_maps; k++) {
      if (!own[k]) continue;
      int* needs = PL_ARRAY(r->arena, int, map_constraint[k].n_needs + 1);
      for (int j = 0; j < map_constraint[k].n_needs; j++) needs[j] = map_constraint[k].needs[j];
      needs[map_constraint[k].n_needs++] = r->first_constraint[i];
      map_constraint[k].needs = needs;
    }
  }
}

// The row along the maps goes with them.
static void along_constraints(pl_recorder* r, const pl_constraint_setup* map,
                              pl_constraint_setup* out) {
  int n_maps = r->model->choose.n_maps, n = 0;
  for (int k = 0; k < n_maps; k++) n += map[k].n_needs;
  for (int k = 0; k < count_along(r); k++) {
    int* needs = PL_ARRAY(r->arena, int, n + 1);
    out[k] = (pl_constraint_setup){
        .name = pl_format(r->arena, "choose along %d", k + 1), .priority = 1, .contact = -1};
    for (int j = 0; j < n_maps; j++) {
      for (int i = 0; i < map[j].n_needs; i++) needs[out[k].n_needs++] = map[j].needs[i];
    }
    out[k].needs = needs;
  }
}

static void make_constraints(pl_recorder* r) {
  pl_constraint_setup* constraint = PL_ARRAY(r->arena, pl_constraint_setup, r->n_constraints + 1);
  for (int i = 0; i < r->model->constraints.n; i++) name_constraints(r, i, constraint);
  for (int k = 0; k < r->model->choose.n_maps; k++) {
    pl_constraint_setup* out = &constraint[r->out->n_declared + k];
    out->name = pl_format(r->arena, "choose %s",
                          pl_expr_text(r->arena, r->pool, r->model->choose.maps[k].old));
    out->priority = count_along(r) > 0 ? 2 : 1;
    out->contact = -1;
  }
  pl_constraint_setup* maps = constraint + r->out->n_declared;
  find_needs(r, maps);
  along_constraints(r, maps, maps + r->model->choose.n_maps);
  pl_record_frictions(r, constraint);
  r->out->setup.constraints = constraint;
  r->out->setup.n_c = r->n_constraints;
}

// ------------------------------------------------------------------------------------ start values

// The value with elements of families replaced by their start values where they are known.
pl_expr pl_record_with_elements(pl_recorder* r, pl_expr e, const pl_coordinate* q) {
  // most start values of a large family: nothing to look up
  if (pl_kind_of(r->pool, e) == PL_NUMBER) return e;
  pl_record_group* g = PL_NEW(r->arena, pl_record_group);
  g->atom_at = pl_map_make(r->arena);
  g->seen = pl_map_make(r->arena);
  bool time = r->explicit_time;
  collect(r, g, e);
  r->explicit_time = time;
  for (int i = 0; i < g->atoms.n; i++) {
    if (pl_kind_of(r->pool, g->atoms.at[i]) != PL_AT) continue;
    int at = pl_record_global(r, g->atoms.at[i]);
    if (at < 0 || !q[at].has_q) return pl_poison();
    pl_expr given = pl_wider_element(r, at);
    if (!pl_is_poison(given)) {
      e = pl_subst_expr(r->pool, e, g->atoms.at[i], given);
      continue;
    }
    char text[32];
    pl_double_text(text, q[at].q);
    pl_expr number = text[0] == '-'
                         ? pl_neg(r->pool, pl_number_from_text(r->pool, text + 1, strlen(text) - 1))
                         : pl_number_from_text(r->pool, text, strlen(text));
    e = pl_subst_expr(r->pool, e, g->atoms.at[i], number);
  }
  return e;
}

// Takes over one start value if everything that it depends on is known.
static bool take_start(pl_recorder* r, const pl_start_value* s, pl_coordinate* q) {
  pl_expr value = pl_record_with_elements(r, s->value, q);
  double x = pl_record_number(r, value);
  if (!isfinite(x)) return false;
  if (!s->guess)
    (s->velocity ? r->out->exact_v : r->out->exact_q)[s->at] = (pl_exact_start){
        s->value, s->instances, s->instance};
  pl_coordinate* c = &q[s->at];
  if (s->guess && s->velocity) {
    c->has_v_guess = true;
    c->v_guess = x;
  } else if (s->guess) {
    c->has_guess = true;
    c->guess = x;
  } else if (s->velocity) {
    c->has_v = true;
    c->v = x;
  } else {
    c->has_q = true;
    c->q = x;
  }
  if (r->variation && !s->guess) pl_variation_of_start(r, s);
  pl_expr atom = r->out->flat.at[s->at];
  if (!s->guess && pl_kind_of(r->pool, atom) == PL_SYMBOL) {
    pl_symbol name = s->velocity ? pl_symbol_dot(r->pool, pl_symbol_of(r->pool, atom))
                                 : pl_symbol_of(r->pool, atom);
    if ((int)name.id < r->n_value) r->value[name.id] = x;
  }
  pl_wider_start(r, s, value);
  pl_numbers_take_start(r, s, q);
  return true;
}

pleuel_status pl_record_target(pl_recorder* r, pl_expr target, pl_start_value* out) {
  pl_pool* p = r->pool;
  pl_expr atom = target;
  if (pl_kind_of(p, target) == PL_AT) {
    out->velocity = pl_dots_of(p, target) == 1;
    atom = pl_at(p, pl_symbol_of(p, target), 0, pl_arg(p, target, 0));
  } else if (pl_kind_of(p, target) == PL_SYMBOL) {
    const pl_symbol_info* info = pl_symbol_get(p, pl_symbol_of(p, target));
    out->velocity = info->role == PL_R_VELOCITY;
    if (out->velocity) atom = pl_sym(p, info->base);
  }
  out->at = pl_record_global(r, atom);
  return out->at < 0 ? no_such(r, atom) : PLEUEL_OK;
}

static pleuel_status make_starts(pl_recorder* r, pl_coordinate* q) {
  const pl_model* m = r->model;
  // values of elements are looked up while the indices of their block are set, so one by one in
  // order of declaration; what depends on a later one waits for the next round
  PL_VEC(pl_start_value) waiting = {0};
  for (int i = 0; i < m->inits.n; i++) {
    const pl_init* init = &m->inits.at[i];
    double at = pl_record_number(r, init->time);
    if (!isnan(at) && at != r->out->t_0) {
      return pl_fail(r->job, PLEUEL_UNSUPPORTED,
                     "start values at t = %g s, but the simulation begins at t = %g s", at,
                     r->out->t_0);
    }
    pl_record_group* g;
    PL_TRY(group_for(r, init->block, &g));
    for (int k = 0; k < g->instances.n; k++) {
      set_indices(r, &g->instances, k);
      pl_start_value s = {
          .guess = init->guess, .value = init->value, .instances = &g->instances, .instance = k};
      PL_TRY(pl_record_check(r, &init->value, 1));
      PL_TRY(pl_record_target(r, init->target, &s));
      if (take_start(r, &s, q)) continue;
      for (int d = 0; d < g->instances.depth; d++) {
        s.value = pl_subst1(r->pool, s.value, g->instances.symbol[d],
                            pl_int(r->pool, g->instances.index[k * g->instances.depth + d]));
      }
      pl_push(r->arena, waiting, s);
    }
  }
  for (bool moved = true; moved && waiting.n > 0;) {
    moved = false;
    for (int i = 0; i < waiting.n; i++) {
      if (!take_start(r, &waiting.at[i], q)) continue;
      waiting.at[i--] = waiting.at[--waiting.n];
      moved = true;
    }
  }
  if (waiting.n == 0) return PLEUEL_OK;
  return pl_fail(r->job, PLEUEL_UNSUPPORTED, "the start value of %s, %s, is no number",
                 q[waiting.at[0].at].name, pl_expr_text(r->arena, r->pool, waiting.at[0].value));
}

// T, V or L was written with this coordinate.
static bool is_in_load(const pl_recorder* r, pl_expr atom) {
  if (pl_kind_of(r->pool, atom) != PL_SYMBOL) return false;
  pl_symbol q = pl_symbol_of(r->pool, atom), v = pl_symbol_dot(r->pool, q);
  for (int i = 0; i < r->model->loads.n; i++) {
    pl_expr value = r->model->loads.at[i].value;
    if (!pl_is_poison(value)
        && (pl_has_symbol(r->pool, value, q) || pl_has_symbol(r->pool, value, v)))
      return true;
  }
  return false;
}

static pleuel_status make_coordinates(pl_recorder* r) {
  pl_coordinate* q = PL_ARRAY(r->arena, pl_coordinate, r->out->flat.n + 1);
  for (int i = 0; i < r->out->flat.n; i++) {
    name_coordinate(r, r->out->flat.at[i], &q[i]);
    q[i].in_load = is_in_load(r, r->out->flat.at[i]);
  }
  r->out->setup.coordinates = q;
  r->out->exact_q = PL_ARRAY(r->arena, pl_exact_start, r->out->flat.n + 1);
  r->out->exact_v = PL_ARRAY(r->arena, pl_exact_start, r->out->flat.n + 1);
  PL_TRY(make_starts(r, q));
  r->out->setup.n_q = r->out->flat.n;
  return PLEUEL_OK;
}

// --------------------------------------------------------------------------------------------- all
static void read_times(pl_recorder* r) {
  const pl_simulate* s = &r->model->simulate;
  pl_recording* out = r->out;
  double from = pl_record_number(r, s->from), step = pl_record_number(r, s->step),
         tol = pl_record_number(r, s->tol);
  out->t_0 = s->given && isfinite(from) ? from : 0;
  out->t_end = s->given ? pl_record_number(r, s->to) : (double)NAN;
  out->dt = s->given && step > 0 ? step : 0;
  out->tol = s->given && tol > 0 ? tol : 0;
  out->count = s->given ? s->count : 0;
}

static void list_coordinates(pl_recorder* r) {
  r->out->flat = pl_model_flat_coords(r->model, r->arena);
  r->flat_at = pl_map_make(r->arena);
  for (int i = 0; i < r->out->flat.n; i++) {
    pl_map_set(r->flat_at, r->out->flat.at[i].id, (uint64_t)i + 1);
    // so that the values have room
    pl_symbol_dot(r->pool, pl_symbol_dot(r->pool, pl_symbol_of(r->pool, r->out->flat.at[i])));
  }
}

static void list_values(pl_recorder* r) {
  pl_record_friction_symbols(r);
  r->value = pl_model_values(r->model, r->arena);
  r->n_value = pl_symbol_count(r->pool) + 1;
  // nobody has said anything yet
  for (int i = 0; i < r->model->params.n; i++) {
    const pl_param* p = &r->model->params.at[i];
    if (p->input && isnan(r->value[p->symbol.id])) r->value[p->symbol.id] = 0;
  }
  read_times(r);
  pl_wider_begin(r);
}

void pl_record_begin(pl_recorder* r) {
  list_coordinates(r);
  list_values(r);
}

pleuel_status pl_record_model(pl_recorder* r) {
  PL_TRY(make_groups(r));
  PL_TRY(record_patterns(r));
  PL_TRY(make_coordinates(r));
  make_constraints(r);
  pl_record_poles(r);
  PL_TRY(pl_record_observers(r));
  PL_TRY(pl_record_events(r));
  return pl_record_branches(r);
}

// The form that is integrated is a second one; where it cannot be had, the first serves.
static void record_turned(const pl_recorder* r) {
  if (pl_record_turned(r) == PLEUEL_OK) return;
  r->job->message[0] = '\0';
  r->job->status = PLEUEL_OK;
}

pleuel_status pl_record(pl_job* job, pl_model* model, const char* sensitivities, bool exact,
                        pl_recording** out) {
  PL_TRY(pl_model_write_sums(job, model, &model));
  pl_recorder r = {.exact = exact,
                   .job = job,
                   .arena = job->arena,
                   .model = model,
                   .pool = model->pool,
                   .out = PL_NEW(job->arena, pl_recording)};
  list_coordinates(&r);
  if (sensitivities) PL_TRY(pl_variation_begin(&r, sensitivities));
  list_values(&r);
  PL_TRY(pl_record_model(&r));
  if (r.variation) PL_TRY(pl_variation_setup(&r));
  else if (!exact) record_turned(&r);
  PL_TRY(pl_wider_setup(&r));
  r.out->exact = exact;
  pl_numbers_make(&r);
  *out = r.out;
  return PLEUEL_OK;
}

void pl_record_dump(pl_text* out, const pl_model* model, const pl_recording* r) {
  const pl_setup* s = &r->setup;
  pl_text_addf(out, "coordinates %d, constraints %d (%d of them maps), patterns %d\n", s->n_q,
               s->n_c, s->n_c - r->n_declared, s->n_patterns);
  for (int i = 0; i < s->n_q; i++) {
    const pl_coordinate* q = &s->coordinates[i];
    pl_text_addf(out, "  q%-3d %s", i, q->name);
    if (q->unit && *q->unit) pl_text_addf(out, " [%s]", q->unit);
    if (q->has_q) pl_text_addf(out, "  start %.17g", q->q);
    if (q->has_v) pl_text_addf(out, "  velocity %.17g", q->v);
    if (q->has_guess) pl_text_addf(out, "  guess %.17g", q->guess);
    pl_text_add(out, "\n");
  }
  for (int i = 0; i < s->n_c; i++) {
    const pl_constraint_setup* c = &s->constraints[i];
    pl_text_addf(out, "  g%-3d %s%s", i, c->name,
                 c->side > 0   ? "  >= 0"
                 : c->side < 0 ? "  <= 0"
                               : "");
    if (c->priority) pl_text_add(out, "  (map)");
    if (c->contact >= 0) pl_text_addf(out, "  while %s", s->constraints[c->contact].name);
    for (int k = 0; k < c->n_needs; k++)
      pl_text_addf(out, "  while %s", s->constraints[c->needs[k]].name);
    pl_text_add(out, "\n");
  }
  for (int i = 0; i < s->n_patterns; i++) {
    pl_text_addf(out, "pattern %d: %d instances, %d slots, %d constraints\n", i + 1,
                 s->patterns[i].n, s->patterns[i].n_q, s->patterns[i].n_c);
    pl_tape_dump(out, model->pool, s->patterns[i].tape);
  }
}
