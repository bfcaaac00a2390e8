// Numbers of a recording (assembly.h): what is taken down while it is made, and other numbers put
// in.
#include <math.h>
#include <string.h>

#include "assembly/assembly_impl.h"

// ------------------------------------------------------------------------- while it is recorded
// The value with start values of elements as symbols, so that they may change.
static pl_expr with_symbols(pl_recorder* r, pl_expr e, const pl_coordinate* q) {
  if (pl_kind_of(r->pool, e) == PL_NUMBER) return e;
  pl_record_group* g = PL_NEW(r->arena, pl_record_group);
  g->atom_at = pl_map_make(r->arena);
  g->seen = pl_map_make(r->arena);
  bool time = r->explicit_time;
  pl_group_atoms(r, g, e);
  r->explicit_time = time;
  for (int i = 0; i < g->atoms.n; i++) {
    pl_expr atom = g->atoms.at[i];
    if (pl_kind_of(r->pool, atom) != PL_AT) continue;
    int at = pl_record_global(r, atom);
    if (at < 0 || !q[at].has_q) return pl_poison();
    const char* name = pl_format(r->arena, "start of %s", q[at].name);
    pl_symbol_info info = {.name = name, .ascii = name, .role = PL_R_LOCAL};
    e = pl_subst_expr(r->pool, e, atom, pl_sym(r->pool, pl_symbol_make(r->pool, &info)));
  }
  return e;
}

void pl_numbers_take_start(pl_recorder* r, const pl_start_value* s, const pl_coordinate* q) {
  pl_number_start n = {.at = s->at, .velocity = s->velocity, .guess = s->guess};
  n.value = with_symbols(r, s->value, q);
  n.instances = s->instances;
  n.instance = s->instance;
  pl_expr atom = r->out->flat.at[s->at];
  if (!s->guess && pl_kind_of(r->pool, atom) == PL_SYMBOL) {
    n.name = pl_symbol_of(r->pool, atom);
    if (s->velocity) n.name = pl_symbol_dot(r->pool, n.name);
  }
  pl_push(r->arena, r->starts, n);
}

// Elements whose start others speak of get the value as their name.
static void name_elements(pl_recorder* r) {
  for (int i = 0; i < r->starts.n; i++) {
    pl_number_start* s = &r->starts.at[i];
    if (s->name.id || s->velocity || s->guess) continue;
    const char* name = r->out->setup.coordinates[s->at].name;
    s->name = pl_symbol_find(r->pool, pl_format(r->arena, "start of %s", name));
  }
}

static const char* unit_of(pl_recorder* r, pl_symbol s) {
  const pl_symbol_info* info = pl_symbol_get(r->pool, s);
  if (!r->model->uses_units || !info->dimension_known) return "";
  if (pl_dimension_equal(info->dimension, pl_dimension_one())) return "";
  return pl_unit_of_symbol(r->arena, r->pool, s, info->dimension, true);
}

typedef PL_VEC(pl_number_given) pl_givens;

static bool is_listed(const pl_givens* list, pl_symbol s) {
  for (int i = 0; i < list->n; i++)
    if (list->at[i].symbol.id == s.id) return true;
  return false;
}

static bool needs_unlisted(pl_recorder* r, const pl_givens* list, const pl_expr* definition,
                           pl_expr e) {
  int n = pl_is_poison(e) ? 0 : pl_symbols_in(r->pool, e, NULL, 0);
  pl_symbol* symbol = PL_ARRAY(r->arena, pl_symbol, n + 1);
  if (n > 0) pl_symbols_in(r->pool, e, symbol, n);
  for (int i = 0; i < n; i++)
    if (!pl_is_poison(definition[symbol[i].id]) && !is_listed(list, symbol[i])) return true;
  return false;
}

static pl_number_given given_of(pl_recorder* r, pl_symbol s, pl_expr value, bool named) {
  const pl_symbol_info* info = pl_symbol_get(r->pool, s);
  return (pl_number_given){.symbol = s,
                           .value = value,
                           .ascii = info->ascii,
                           .shown = info->name,
                           .unit = unit_of(r, s),
                           .named = named,
                           .positive = info->sign == PL_SIGN_POSITIVE};
}

// Each behind those that it is defined by, otherwise in the order of the text.
static void list_given(pl_recorder* r, pl_givens* out) {
  const pl_model* m = r->model;
  const pl_expr* definition = pl_model_definitions(m, r->arena);
  pl_givens all = {0};
  for (int i = 0; i < m->params.n; i++) {
    const pl_param* p = &m->params.at[i];
    pl_number_given g = given_of(r, p->symbol, p->value, !p->literal);
    g.input = p->input;
    pl_push(r->arena, all, g);
  }
  for (int i = 0; i < m->lets.n; i++) {
    const pl_let* l = &m->lets.at[i];
    if (l->n_args == 0 && !l->inserted && l->symbol.id)
      pl_push(r->arena, all, given_of(r, l->symbol, l->value, true));
  }
  for (bool more = true; more;) {
    more = false;
    for (int i = 0; i < all.n; i++) {
      const pl_number_given* g = &all.at[i];
      if (is_listed(out, g->symbol) || needs_unlisted(r, out, definition, g->value)) continue;
      pl_push(r->arena, *out, *g);
      more = true;
    }
  }
}

static const char* why_fixed(const pl_recorder* r) {
  if (r->exact) return "in numbers wider than doubles";
  if (r->variation) return "of a system with sensitivities";
  if (r->start_settled) return "where events or outputs speak of values at the start, as E(0)";
  return NULL;
}

static const pl_expr* list_restitution(pl_recorder* r) {
  pl_expr* out = PL_ARRAY(r->arena, pl_expr, r->n_constraints + 1);
  for (int i = 0; i < r->model->constraints.n; i++) {
    const pl_restitution* e = pl_model_restitution(r->model, &r->model->constraints.at[i]);
    for (int k = r->first_constraint[i]; e && k < r->first_constraint[i + 1]; k++)
      out[k] = e->value;
  }
  return out;
}

static void list_positive(pl_recorder* r, pl_numbers* n) {
  const pl_model* m = r->model;
  pl_expr* list = PL_ARRAY(r->arena, pl_expr, m->masses.n + 2 * m->bodies.n + 1);
  for (int i = 0; i < m->masses.n; i++)
    if (!m->masses.at[i].block) list[n->n_positive++] = m->masses.at[i].mass;
  for (int i = 0; i < m->bodies.n; i++) {
    if (m->bodies.at[i].block) continue;
    list[n->n_positive++] = m->bodies.at[i].mass;
    list[n->n_positive++] = m->bodies.at[i].inertia;
  }
  n->positive = list;
}

void pl_numbers_make(pl_recorder* r) {
  pl_numbers* n = PL_NEW(r->arena, pl_numbers);
  pl_givens given = {0};
  list_given(r, &given);
  name_elements(r);
  const bool* size = pl_model_sizes(r->model, r->arena);
  int* inputs = PL_ARRAY(r->arena, int, given.n + 1);
  for (int i = 0; i < given.n; i++) {
    given.at[i].size = size[given.at[i].symbol.id];
    if (given.at[i].input) inputs[n->n_inputs++] = i;
  }
  n->given = given.at;
  n->n_given = given.n;
  n->inputs = inputs;
  n->starts = r->starts.at;
  n->n_starts = r->starts.n;
  n->restitution = list_restitution(r);
  n->n_c = r->n_constraints;
  list_positive(r, n);
  const pl_simulate* s = &r->model->simulate;
  if (s->given) {
    n->t_0 = s->from;
    n->t_end = s->to;
    n->dt = s->step;
    n->tol = s->tol;
  }
  n->fixed = why_fixed(r);
  n->n_symbols = pl_symbol_count(r->pool) + 1;
  double* value = PL_ARRAY(r->arena, double, n->n_symbols);
  for (int i = 0; i < n->n_symbols; i++) value[i] = i < r->n_value ? r->value[i] : (double)NAN;
  n->value = value;
  n->pool = pl_pool_view(r->arena, r->pool);
  r->out->numbers = n;
}

// -------------------------------------------------------------------------------- other numbers
typedef struct pl_applying {
  pl_job* job;
  pl_arena* arena;
  const pl_numbers* numbers;
  const pl_numbers_set* set;
  const pl_pool* pool;
  double* value;  // by symbol id
} pl_applying;

static const double* given_set(const pl_numbers_set* set, int i) {
  for (int k = 0; k < set->n_given; k++)
    if (set->given[k] == i) return &set->given_value[k];
  return NULL;
}

static const pl_number_start_set* start_set(const pl_numbers_set* set, int at, bool velocity) {
  for (int k = 0; k < set->n_starts; k++)
    if (set->starts[k].at == at && set->starts[k].velocity == velocity) return &set->starts[k];
  return NULL;
}

static pleuel_status apply_given(pl_applying* a) {
  for (int i = 0; i < a->numbers->n_given; i++) {
    const pl_number_given* g = &a->numbers->given[i];
    const double* set = given_set(a->set, i);
    double* x = &a->value[g->symbol.id];
    if (set) *x = *set;
    else if (!pl_is_poison(g->value)) *x = pl_eval(a->pool, g->value, a->value);
    if (g->positive && !(*x > 0) && a->numbers->value[g->symbol.id] > 0) {
      return pl_fail(
          a->job, PLEUEL_USAGE,
          "%s was positive when the system was made, and its forms rely on it: %.6g needs "
          "a system of its own",
          g->shown, *x);
    }
  }
  for (int i = 0; i < a->numbers->n_positive; i++) {
    double x = pl_eval(a->pool, a->numbers->positive[i], a->value);
    if (x > 0 || isnan(x)) continue;
    return pl_fail(a->job, PLEUEL_USAGE,
                   "a mass or moment of inertia would be %.6g: they are positive", x);
  }
  return PLEUEL_OK;
}

static void take(pl_coordinate* c, const pl_number_start* s, double x) {
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
}

static void set_indices(pl_applying* a, const pl_number_start* s, bool on) {
  const pl_instances* in = s->instances;
  for (int d = 0; in && d < in->depth; d++)
    a->value[in->symbol[d].id] = on ? (double)in->index[s->instance * in->depth + d] : (double)NAN;
}

// Start values that are set but that the text does not give come first: others may speak of them.
static void apply_set_starts(pl_applying* a, const pl_recording* from, pl_coordinate* q) {
  for (int k = 0; k < a->set->n_starts; k++) {
    const pl_number_start_set* set = &a->set->starts[k];
    pl_number_start s = {.at = set->at, .velocity = set->velocity};
    take(&q[set->at], &s, set->value);
    pl_expr atom = from->flat.at[set->at];
    if (pl_kind_of(a->pool, atom) != PL_SYMBOL) continue;
    pl_symbol name = pl_symbol_of(a->pool, atom);
    if (set->velocity) name = pl_symbol_get(a->pool, name)->up;
    if (name.id) a->value[name.id] = set->value;
  }
}

static pleuel_status apply_starts(pl_applying* a, const pl_recording* from, pl_coordinate* q) {
  apply_set_starts(a, from, q);
  for (int i = 0; i < a->numbers->n_starts; i++) {
    const pl_number_start* s = &a->numbers->starts[i];
    const pl_number_start_set* set = s->guess ? NULL : start_set(a->set, s->at, s->velocity);
    set_indices(a, s, true);
    double x = set ? set->value : pl_eval(a->pool, s->value, a->value);
    set_indices(a, s, false);
    if (!isfinite(x))
      return pl_fail(a->job, PLEUEL_USAGE, "the start value of %s is not a number", q[s->at].name);
    take(&q[s->at], s, x);
    if (s->name.id) a->value[s->name.id] = x;
  }
  return PLEUEL_OK;
}

static const pl_pattern* apply_patterns(pl_applying* a, const pl_pattern* from, int n) {
  pl_pattern* out = PL_ARRAY(a->arena, pl_pattern, n + 1);
  for (int i = 0; i < n; i++) {
    out[i] = from[i];
    pl_tape* tape = PL_NEW(a->arena, pl_tape);
    *tape = *from[i].tape;
    double* value = PL_ARRAY(a->arena, double, tape->n_param + 1);
    for (int k = 0; k < tape->n_param; k++) value[k] = a->value[tape->param_symbol[k].id];
    tape->param_value = value;
    out[i].tape = tape;
  }
  return out;
}

static void apply_programs(pl_applying* a, pl_setup* s) {
  s->patterns = apply_patterns(a, s->patterns, s->n_patterns);
  s->observers = apply_patterns(a, s->observers, s->n_observers);
  s->watch = apply_patterns(a, s->watch, s->n_watch_patterns);
  s->branch_patterns = apply_patterns(a, s->branch_patterns, s->n_branch_patterns);
}

static void apply_restitution(pl_applying* a, pl_setup* s) {
  pl_constraint_setup* constraint = PL_ARRAY(a->arena, pl_constraint_setup, s->n_c + 1);
  for (int c = 0; c < s->n_c; c++) {
    constraint[c] = s->constraints[c];
    if (c < a->numbers->n_c && !pl_is_poison(a->numbers->restitution[c]))
      constraint[c].restitution = pl_eval(a->pool, a->numbers->restitution[c], a->value);
  }
  s->constraints = constraint;
}

static double time_of(const pl_applying* a, pl_expr e, double otherwise) {
  double x = pl_is_poison(e) ? (double)NAN : pl_eval(a->pool, e, a->value);
  return isfinite(x) ? x : otherwise;
}

static void apply_times(const pl_applying* a, pl_recording* out) {
  out->t_0 = time_of(a, a->numbers->t_0, out->t_0);
  out->t_end = time_of(a, a->numbers->t_end, out->t_end);
  out->dt = time_of(a, a->numbers->dt, out->dt);
  out->tol = time_of(a, a->numbers->tol, out->tol);
}

pleuel_status pl_numbers_apply(pl_job* job, const pl_recording* from, const pl_numbers_set* set,
                               pl_recording* out) {
  const pl_numbers* n = from->numbers;
  pl_applying a = {job, job->arena, n, set, pl_pool_view(job->arena, n->pool), NULL};
  a.value = PL_ARRAY(job->arena, double, n->n_symbols);
  memcpy(a.value, n->value, (size_t)n->n_symbols * sizeof *a.value);
  *out = *from;
  PL_TRY(apply_given(&a));
  pl_coordinate* q = PL_ARRAY(job->arena, pl_coordinate, from->setup.n_q + 1);
  memcpy(q, from->setup.coordinates, (size_t)from->setup.n_q * sizeof *q);
  PL_TRY(apply_starts(&a, from, q));
  out->setup.coordinates = q;
  apply_programs(&a, &out->setup);
  apply_restitution(&a, &out->setup);
  apply_times(&a, out);
  if (from->turned) {
    out->turned = PL_NEW(job->arena, pl_recording);
    *out->turned = *from->turned;
    apply_programs(&a, &out->turned->setup);
    apply_restitution(&a, &out->turned->setup);
  }
  return PLEUEL_OK;
}
