// Systems: a recording with its names, which does not change and is shared between threads.
#include <math.h>
#include <string.h>

#include "api/system_impl.h"
#include "report/report.h"

// ------------------------------------------------------------------------------------------ owners
pleuel_system* pleuel_system_keep(pleuel_system* s) {
  if (s) atomic_fetch_add(&s->owners, 1);
  return s;
}

void pleuel_system_free(pleuel_system* s) {
  if (!s || atomic_fetch_sub(&s->owners, 1) != 1) return;
  pleuel_model* m = s->model;
  pl_arena_free(s->arena);
  pl_model_drop(m);
}

// ----------------------------------------------------------------------------------------- options
pleuel_status pl_sim_options_check(pl_job* job, const pleuel_sim_options* o) {
  if (o->has_until && !isfinite(o->until))
    return pl_fail(job, PLEUEL_USAGE, "the end of the run is no number");
  if (o->has_tol && !(o->tol > 0 && o->tol < 1))
    return pl_fail(job, PLEUEL_USAGE, "tol must lie between 0 and 1");
  if (o->has_dt && !(o->dt > 0)) return pl_fail(job, PLEUEL_USAGE, "dt must be positive");
  bool known = (unsigned)o->method <= PLEUEL_METHOD_RADAU
               && (unsigned)o->engine <= PLEUEL_ENGINE_COMPILED
               && (unsigned)o->precision <= PLEUEL_PRECISION_QUAD;
  if (!known) return pl_fail(job, PLEUEL_USAGE, "there is no such method, engine or precision");
  if (o->precision != PLEUEL_PRECISION_DOUBLE && o->sensitivities)
    return pl_fail(job, PLEUEL_UNSUPPORTED,
                   "wider numbers: sensitivities are computed in double only");
  return PLEUEL_OK;
}

void pl_sim_options_take(const pleuel_sim_options* o, pl_run_options* how) {
  static const pl_method method[] = {PL_METHOD_AUTO, PL_METHOD_TAYLOR, PL_METHOD_RADAU};
  static const pl_engine engine[] = {PL_ENGINE_AUTO, PL_ENGINE_INTERPRETER, PL_ENGINE_COMPILED};
  static const pl_precision precision[] = {PL_PRECISION_DOUBLE, PL_PRECISION_LONG,
                                           PL_PRECISION_QUAD};
  how->method = method[o->method];
  how->engine = engine[o->engine];
  how->precision = precision[o->precision];
  if (o->has_until) how->t_end = o->until;
  if (o->has_tol) how->tol = o->tol;
  if (!o->has_dt) return;
  how->dt = o->dt;
  how->count = 0;
}

static const char* copy_of(pl_arena* a, const char* text) { return text ? pl_copy(a, text) : NULL; }

void pl_sim_options_own(pl_arena* a, pleuel_sim_options* o) {
  o->sensitivities = copy_of(a, o->sensitivities);
  o->until_as_written = copy_of(a, o->until_as_written);
  o->dt_as_written = copy_of(a, o->dt_as_written);
  o->state = NULL;
  o->resume_command = NULL;
}

// ------------------------------------------------------------------------------------------- names
static void add(pleuel_system* s, pl_quantities* list, pleuel_kind kind, const char* name,
                const char* shown, const char* unit, int index) {
  pl_quantity q = {kind, name, shown, unit ? unit : "", index};
  pl_push(s->arena, *list, q);
}

static const char* shown_symbol(pleuel_system* s, pl_symbol symbol) {
  pl_notation how = {PL_MATH_LINE, PL_ENGLISH};
  return pl_notation_symbol(s->arena, s->model->model->pool, symbol, how);
}

static void name_coordinates(pleuel_system* s) {
  const pl_recording* r = s->recording;
  pl_pool* p = s->model->model->pool;
  for (int i = 0; i < s->n_q; i++) {
    const pl_coordinate* q = &r->setup.coordinates[i];
    pl_expr atom = r->flat.at[i];
    bool plain = pl_kind_of(p, atom) == PL_SYMBOL;
    pl_symbol x = pl_symbol_of(p, atom);
    const char* index = plain ? "" : q->name + strcspn(q->name, "[");
    const char* shown = pl_format(s->arena, "%s%s", shown_symbol(s, x), index);
    const char* rate = pl_format(s->arena, "%s%s", shown_symbol(s, pl_symbol_dot(p, x)), index);
    add(s, &s->of[PLEUEL_KIND_COORDINATE], PLEUEL_KIND_COORDINATE, q->name, shown, q->unit, i);
    add(s, &s->of[PLEUEL_KIND_VELOCITY], PLEUEL_KIND_VELOCITY, q->v_name, rate, q->v_unit, i);
  }
}

static const char* shown_multiplier(pleuel_system* s, const pl_constraint_setup* link) {
  const pl_model* m = s->model->model;
  const pl_constraint* c = pl_model_constraint(m, link->name);
  if (!c || !c->lambda.id || c->block) return link->column;
  return shown_symbol(s, c->lambda);
}

static bool is_of_motion(const pleuel_system* s, const char* column) {
  const pl_recording* plain = s->plain ? s->plain : s->recording;
  for (int c = 0; c < plain->setup.n_c; c++) {
    const char* name = plain->setup.constraints[c].column;
    if (name && strcmp(name, column) == 0) return true;
  }
  return false;
}

static void name_rest(pleuel_system* s) {
  const pl_recording* r = s->recording;
  for (int c = 0; c < r->setup.n_c; c++) {
    const pl_constraint_setup* link = &r->setup.constraints[c];
    if (!link->column || !is_of_motion(s, link->column)) continue;
    add(s, &s->of[PLEUEL_KIND_MULTIPLIER], PLEUEL_KIND_MULTIPLIER, link->column,
        shown_multiplier(s, link), link->unit, c);
  }
  for (int i = 0; i < r->setup.n_out; i++)
    add(s, &s->of[PLEUEL_KIND_OUTPUT], PLEUEL_KIND_OUTPUT, r->setup.out[i].name,
        r->setup.out[i].name, r->setup.out[i].unit, i);
  add(s, &s->of[PLEUEL_KIND_TIME], PLEUEL_KIND_TIME, "t", "t",
      s->model->model->uses_units ? "s" : "", 0);
  const pl_numbers* n = r->numbers;
  for (int i = 0; i < n->n_given; i++) {
    const pl_number_given* g = &n->given[i];
    pleuel_kind kind = g->input ? PLEUEL_KIND_INPUT : PLEUEL_KIND_PARAMETER;
    if (g->named) add(s, &s->of[kind], kind, g->ascii, g->shown, g->unit, i);
  }
}

// Kind and place of a column of results, by its name.
static pl_quantity quantity_of(const pleuel_system* s, const pl_result_column* c) {
  for (int kind = PLEUEL_KIND_TIME; kind <= PLEUEL_KIND_OUTPUT; kind++) {
    for (int i = 0; i < s->of[kind].n; i++)
      if (strcmp(s->of[kind].at[i].name, c->name) == 0) return s->of[kind].at[i];
  }
  return (pl_quantity){PLEUEL_KIND_OUTPUT, c->name, c->name, c->unit ? c->unit : "", -1};
}

static void name_columns(pleuel_system* s) {
  const pl_result_column* column;
  int n;
  bool mode;
  pl_result_columns(s->arena, &s->recording->setup, &column, &n, &mode);
  for (int i = 0; i < n; i++) pl_push(s->arena, s->columns, quantity_of(s, &column[i]));
}

// ------------------------------------------------------------------------------------------ making
static pleuel_status record(pleuel_system* s, pl_job* job) {
  pleuel_model* m = s->model;
  bool exact = s->options.precision != PLEUEL_PRECISION_DOUBLE;
  pl_recording* r;
  PL_TRY(pl_sim_options_check(job, &s->options));
  PL_TRY(pl_record(job, m->model, s->options.sensitivities, exact, &r));
  s->recording = r;
  if (!s->options.sensitivities) return PLEUEL_OK;
  PL_TRY(pl_record(job, m->model, NULL, false, &r));
  s->plain = r;
  return PLEUEL_OK;
}

static pleuel_status fill(pleuel_system* s, pl_job* job) {
  PL_TRY(record(s, job));
  s->n_q = s->plain ? s->plain->flat.n : s->recording->flat.n;
  name_coordinates(s);
  name_rest(s);
  name_columns(s);
  return PLEUEL_OK;
}

typedef struct pl_system_making {
  const pleuel_sim_options* options;
  pl_arena* arena;
  pleuel_system* made;
} pl_system_making;

static pleuel_status make(pleuel_model* m, void* argument) {
  pl_system_making* k = argument;
  PL_TRY(pl_pipeline_check(m));
  pleuel_system* s = PL_NEW(k->arena, pleuel_system);
  s->arena = k->arena;
  s->model = m;
  s->options = *k->options;
  pl_sim_options_own(k->arena, &s->options);
  s->lang = m->job.lang;
  pl_job job = m->job;
  job.arena = k->arena;
  pleuel_status status = fill(s, &job);
  memcpy(m->job.message, job.message, sizeof job.message);
  if (status != PLEUEL_OK) return status;
  atomic_init(&s->owners, 1);
  k->made = s;
  return PLEUEL_OK;
}

// Two arenas, each with its guard: memory that runs out in one must not pass the other.
static pleuel_status make_guarded(pleuel_model* m, void* argument) {
  pl_system_making* k = argument;
  volatile pleuel_status status = PLEUEL_NO_MEMORY;
  pl_guard guard;
  PL_GUARD(k->arena, guard) { status = make(m, argument); }
  else {
    pl_fail(&m->job, PLEUEL_NO_MEMORY, "memory ran out");
  }
  pl_guard_end(k->arena, &guard);
  return status;
}

pleuel_status pleuel_system_make(pleuel_model* m, pleuel_system** system,
                                 const pleuel_sim_options* options) {
  if (system) *system = NULL;
  if (!m || !system) return PLEUEL_USAGE;
  pleuel_sim_options o;
  PL_TRY(pl_api_take(m->ctx, &o, sizeof o, options));
  pl_system_making k = {&o, pl_arena_make(m->alloc.take ? &m->alloc : NULL), NULL};
  if (!k.arena) return pl_api_fail(m->ctx, PLEUEL_NO_MEMORY, "memory ran out");
  if (m->ctx->limit) pl_arena_limit(k.arena, m->ctx->limit);
  pleuel_status s = pl_api_guarded(m, make_guarded, &k);
  if (!k.made) {
    pl_arena_free(k.arena);
    return s == PLEUEL_OK ? PLEUEL_NO_MEMORY : s;
  }
  pl_model_keep(m);
  *system = k.made;
  return PLEUEL_OK;
}

// ----------------------------------------------------------------------------------------- reading
const pl_quantity* pl_api_quantity(const pleuel_system* s, pleuel_kind kind, const char* name) {
  const pl_quantities* list = &s->of[kind];
  for (int i = 0; i < list->n; i++)
    if (strcmp(list->at[i].name, name) == 0 || strcmp(list->at[i].shown, name) == 0)
      return &list->at[i];
  return NULL;
}

size_t pleuel_system_count(const pleuel_system* s, pleuel_kind kind) {
  return s && (unsigned)kind < (unsigned)PL_N_KINDS ? (size_t)s->of[kind].n : 0;
}

pleuel_status pl_column_give(const pl_quantity* q, const double* at, size_t stride, size_t n,
                             pleuel_column* out) {
  pleuel_column c = {.size = out->size,
                     .kind = q->kind,
                     .name = q->name,
                     .shown = q->shown,
                     .unit = q->unit,
                     .at = at,
                     .stride = stride,
                     .n = n};
  return pl_api_give(out, &c, sizeof c);
}

pleuel_status pleuel_system_quantity(const pleuel_system* s, pleuel_kind kind, size_t i,
                                     pleuel_column* out) {
  if (!s || !out || i >= pleuel_system_count(s, kind)) return PLEUEL_USAGE;
  const pl_quantity* q = &s->of[kind].at[i];
  const pl_numbers* n = s->recording->numbers;
  bool number = kind == PLEUEL_KIND_PARAMETER || kind == PLEUEL_KIND_INPUT;
  const double* at = number ? &n->value[n->given[q->index].symbol.id] : NULL;
  return pl_column_give(q, at, 0, number, out);
}
