// What is read of a run, and put into it: states, states between steps, accelerations elsewhere,
// linearisation, bytes; and the whole motion at once.
#include <limits.h>
#include <math.h>
#include <string.h>

#include "api/run_impl.h"

// ------------------------------------------------------------------------------------------ states
// The motion goes on from a state of its own: constraints and contacts are those met there.
static pleuel_status begin_at(pleuel_run* r, double t, const double* q, const double* v) {
  if (pl_api_run_is_turned(r)) {
    size_t all = (size_t)r->numbered.turned->setup.n_q, n = (size_t)r->system->n_q;
    double *q_all = PL_ARRAY(r->motion, double, all), *v_all = PL_ARRAY(r->motion, double, all);
    memcpy(q_all, q, n * sizeof *q);
    memcpy(v_all, v, n * sizeof *v);
    return pl_run_start_from_angles(r->run, t, q_all, v_all);
  }
  return pl_run_start_at(r->run, t, q, v);
}

static pleuel_status pl_api_run_need_plain(pleuel_run* r) {
  if (!r->system->plain) return PLEUEL_OK;
  return pl_fail(&r->job, PLEUEL_UNSUPPORTED,
                 "a motion with sensitivities goes on from no other state");
}

static pleuel_status pl_api_run_begin_from(pleuel_run* r, const pl_state_given* s) {
  pl_run_options how = pl_api_run_options_of(r);
  how.dt = 0;
  how.count = 0;
  how.t_0 = s->t;
  how.sink = pl_api_run_sink(r);
  if (how.t_0 == how.t_end) return pl_fail(&r->job, PLEUEL_USAGE, "the motion ends there");
  PL_TRY(pl_run_make(&r->job, pl_api_run_setup(r), &how, &r->run));
  return begin_at(r, s->t, s->q, s->v);
}

// The state outlives the memory of the motion that it comes from.
static void keep_origin(pleuel_run* r, const pl_state_given* s) {
  size_t n = (size_t)r->system->n_q;
  r->from_state = true;
  r->t_origin = s->t;
  memmove(r->q_origin, s->q, n * sizeof *r->q_origin);
  memmove(r->v_origin, s->v, n * sizeof *r->v_origin);
}

static pleuel_status set_state(pleuel_run* r, void* argument) {
  const pl_state_given* s = argument;
  PL_TRY(pl_api_run_need_plain(r));
  for (int i = 0; i < r->system->n_q; i++)
    if (!isfinite(s->q[i]) || !isfinite(s->v[i]))
      return pl_fail(&r->job, PLEUEL_USAGE, "the start value of %s is not a number",
                     r->system->recording->setup.coordinates[i].name);
  keep_origin(r, s);
  pl_state_given from = {r->t_origin, r->q_origin, r->v_origin, NULL, NULL};
  pleuel_status status = pl_api_run_clear(r);
  if (status == PLEUEL_OK) status = pl_api_run_begin_from(r, &from);
  if (status != PLEUEL_OK) pl_api_run_drop(r);
  return status;
}

pleuel_status pleuel_run_set_state(pleuel_run* r, double t, const double* q, const double* v) {
  if (!r || !q || !v) return PLEUEL_USAGE;
  return pl_api_run_guarded(r, set_state, &(pl_state_given){t, q, v, NULL, NULL});
}

pleuel_status pl_api_run_restart(pleuel_run* r) {
  pl_row row;
  PL_TRY(pl_api_run_need_plain(r));
  pl_run_row(r->run, &row);
  return set_state(r, &(pl_state_given){row.t, row.q, row.v, NULL, NULL});
}

static void give_lambda(const pleuel_run* r, const pl_row* row, double* out) {
  const pl_quantities* list = &r->system->of[PLEUEL_KIND_MULTIPLIER];
  for (int i = 0; i < list->n; i++) {
    int c = list->at[i].index;
    double x = r->numbered.setup.constraints[c].minus ? -row->lambda[c] : row->lambda[c];
    out[i] = row->unique[c] ? x : (double)NAN;
  }
}

static void pl_api_run_give_state(const pleuel_run* r, const pl_row* row, double* q, double* v,
                                  double* a, double* lambda) {
  size_t n = (size_t)r->system->n_q * sizeof(double);
  if (q) memcpy(q, row->q, n);
  if (v) memcpy(v, row->v, n);
  if (a) memcpy(a, row->a, n);
  if (lambda) give_lambda(r, row, lambda);
}

typedef struct pl_state_wanted {
  double t;
  double *q, *v, *a, *lambda;
} pl_state_wanted;

static pleuel_status state(pleuel_run* r, void* argument) {
  const pl_state_wanted* s = argument;
  pl_row row;
  PL_TRY(pl_api_run_need_start(r));
  pl_run_row(r->run, &row);
  pl_api_run_give_state(r, &row, s->q, s->v, s->a, s->lambda);
  return PLEUEL_OK;
}

pleuel_status pleuel_run_state(pleuel_run* r, double* q, double* v, double* a, double* lambda) {
  return r ? pl_api_run_guarded(r, state, &(pl_state_wanted){0, q, v, a, lambda}) : PLEUEL_USAGE;
}

static pleuel_status dense(pleuel_run* r, void* argument) {
  const pl_state_wanted* s = argument;
  PL_TRY(pl_api_run_need_start(r));
  const pl_setup* setup = pl_api_run_setup(r);
  size_t n = (size_t)setup->n_q, c = (size_t)setup->n_c;
  pl_mark mark = pl_arena_mark(r->motion);
  double *q = PL_ARRAY(r->motion, double, n + 1), *v = PL_ARRAY(r->motion, double, n + 1);
  double *a = PL_ARRAY(r->motion, double, n + 1), *lambda = PL_ARRAY(r->motion, double, c + 1);
  pl_row row = {.q = q, .v = v, .a = a, .lambda = lambda, .unique = pl_run_unique(r->run)};
  bool inside = pl_run_dense_row(r->run, s->t, q, v, a, lambda);
  if (inside) pl_api_run_give_state(r, &row, s->q, s->v, s->a, s->lambda);
  pl_arena_rewind(r->motion, mark);
  if (inside) return PLEUEL_OK;
  if (pl_api_run_is_turned(r) || r->options.precision != PLEUEL_PRECISION_DOUBLE)
    return pl_fail(&r->job, PLEUEL_UNSUPPORTED,
                   "no states between steps here: pleuel_run_sample gives rows at any time");
  return pl_fail(&r->job, PLEUEL_USAGE, "t = %.9g s is not within the last step", s->t);
}

pleuel_status pleuel_run_dense(pleuel_run* r, double t, double* q, double* v, double* a,
                               double* lambda) {
  return r ? pl_api_run_guarded(r, dense, &(pl_state_wanted){t, q, v, a, lambda}) : PLEUEL_USAGE;
}

double pleuel_run_time(const pleuel_run* r) {
  return r && r->run ? pl_run_time(r->run) : (double)NAN;
}

int pleuel_run_done(const pleuel_run* r) { return r && r->run && pl_run_done(r->run); }

typedef struct pl_number_wanted {
  const char* name;
  double* x;
} pl_number_wanted;

static pleuel_status get(pleuel_run* r, void* argument) {
  const pl_number_wanted* w = argument;
  const pl_numbers* n = r->system->recording->numbers;
  for (int kind = PLEUEL_KIND_PARAMETER; kind <= PLEUEL_KIND_INPUT; kind++) {
    const pl_quantity* q = pl_api_quantity(r->system, (pleuel_kind)kind, w->name);
    if (!q) continue;
    *w->x = n->value[n->given[q->index].symbol.id];
    for (int k = 0; k < r->given.n; k++)
      if (r->given.at[k] == q->index) *w->x = r->given_value.at[k];
    return PLEUEL_OK;
  }
  const pl_quantities* columns = &r->system->columns;
  for (int i = 0; i < columns->n; i++) {
    const pl_quantity* q = &columns->at[i];
    if (strcmp(q->name, w->name) != 0 && strcmp(q->shown, w->name) != 0) continue;
    pl_row row;
    PL_TRY(pl_api_run_need_start(r));
    pl_run_row(r->run, &row);
    pl_result_flatten(&r->numbered.setup, &row, r->row);
    *w->x = r->row[i];
    return PLEUEL_OK;
  }
  return pl_fail(&r->job, PLEUEL_USAGE, "nothing is named %s", w->name);
}

pleuel_status pleuel_run_get(pleuel_run* r, const char* name, double* si) {
  return r && name && si ? pl_api_run_guarded(r, get, &(pl_number_wanted){name, si}) : PLEUEL_USAGE;
}

// ------------------------------------------------------------------------- accelerations elsewhere
static pleuel_status make_probe(pleuel_run* r) {
  if (r->probe) return PLEUEL_OK;
  pl_run_options how = pl_api_run_options_of(r);
  how.dt = 0;
  how.count = 0;
  how.general = true;
  how.method = PL_METHOD_TAYLOR;
  return pl_run_make(&r->job, &r->numbered.setup, &how, &r->probe);
}

// At any state, with the constraints that are met there; as: with those in force in this motion.
static pleuel_status accelerations(pleuel_run* r, const pl_state_given* s, const pl_run* as) {
  PL_TRY(make_probe(r));
  if (as) PL_TRY(pl_run_point_as(r->probe, as, s->t, s->q, s->v));
  else PL_TRY(pl_run_start_at(r->probe, s->t, s->q, s->v));
  pl_row row = {.q = s->q, .v = s->v, .a = pl_run_a(r->probe), .lambda = pl_run_lambda(r->probe)};
  row.unique = pl_run_unique(r->probe);
  pl_api_run_give_state(r, &row, NULL, NULL, s->a, s->lambda);
  return PLEUEL_OK;
}

static pleuel_status rhs(pleuel_run* r, void* argument) {
  PL_TRY(pl_api_run_need_start(r));
  PL_TRY(pl_api_run_need_plain(r));
  return accelerations(r, argument, NULL);
}

pleuel_status pleuel_run_rhs(pleuel_run* r, double t, const double* q, const double* v, double* a,
                             double* lambda) {
  if (!r || !q || !v) return PLEUEL_USAGE;
  return pl_api_run_guarded(r, rhs, &(pl_state_given){t, q, v, a, lambda});
}

// ----------------------------------------------------------------------------------- linearisation
// Central differences of sixth order: the best step is the seventh root of a rounding.
static const double part_of_size = 0.0058;
static const double weight[] = {45.0 / 60, -9.0 / 60, 1.0 / 60};

typedef struct pl_linear {
  double *a_q, *a_v, *a_u;
  double *q, *v, *plus, *minus;
  double t;
} pl_linear;

// The largest number beside it says how large a coordinate may be.
static double size_of(const double* x, int n, int i) {
  double most = 0;
  for (int k = 0; k < n; k++) most = fmax(most, fabs(x[k]));
  double own = fabs(x[i]);
  return own > 1e-3 * most ? own : most > 0 ? most : 1;
}

// The derivative of all accelerations by *x, which is one of q or v.
static pleuel_status derivative(pleuel_run* r, const pl_linear* l, double* x, double size,
                                double* column) {
  int n = r->system->n_q;
  double middle = *x, h = part_of_size * size;
  const pl_run* as = pl_api_run_is_turned(r) ? NULL : r->run;
  for (int i = 0; i < n; i++) column[i] = 0;
  for (int k = 1; k <= 3; k++) {
    *x = middle + k * h;
    PL_TRY(accelerations(r, &(pl_state_given){l->t, l->q, l->v, l->plus, NULL}, as));
    *x = middle - k * h;
    PL_TRY(accelerations(r, &(pl_state_given){l->t, l->q, l->v, l->minus, NULL}, as));
    for (int i = 0; i < n; i++) column[i] += weight[k - 1] * (l->plus[i] - l->minus[i]) / h;
  }
  *x = middle;
  return PLEUEL_OK;
}

static pl_symbol input_symbol(const pl_numbers* n, int i) { return n->given[n->inputs[i]].symbol; }

// Another number for a parameter in programs that are this run's own.
static void put(const pl_setup* s, pl_symbol symbol, double x) {
  for (int i = 0; i < s->n_patterns; i++) {
    const pl_tape* tape = s->patterns[i].tape;
    for (int k = 0; k < tape->n_param; k++)
      if (tape->param_symbol[k].id == symbol.id) ((double*)(uintptr_t)tape->param_value)[k] = x;
  }
}

static double number_now(const pleuel_run* r, int given) {
  const pl_numbers* n = r->system->recording->numbers;
  for (int k = 0; k < r->given.n; k++)
    if (r->given.at[k] == given) return r->given_value.at[k];
  return n->value[n->given[given].symbol.id];
}

// An input: the probe is made anew for each value, as programs take their constants when made.
static pleuel_status by_input(pleuel_run* r, const pl_linear* l, int u, double* column) {
  const pl_numbers* n = r->system->recording->numbers;
  const pl_run* as = pl_api_run_is_turned(r) ? NULL : r->run;
  double middle = number_now(r, n->inputs[u]), h = part_of_size * fmax(fabs(middle), 1);
  pleuel_status s = PLEUEL_OK;
  for (int i = 0; i < r->system->n_q; i++) column[i] = 0;
  for (int k = -3; k <= 3 && s == PLEUEL_OK; k++) {
    if (k == 0) continue;
    pl_run_free(r->probe);
    r->probe = NULL;
    put(&r->numbered.setup, input_symbol(n, u), middle + k * h);
    s = accelerations(r, &(pl_state_given){l->t, l->q, l->v, l->plus, NULL}, as);
    double part = weight[(k < 0 ? -k : k) - 1] / (k < 0 ? -h : h);
    for (int i = 0; i < r->system->n_q; i++) column[i] += part * l->plus[i];
  }
  put(&r->numbered.setup, input_symbol(n, u), middle);
  pl_run_free(r->probe);
  r->probe = NULL;
  return s;
}

static pleuel_status all_columns(pleuel_run* r, pl_linear* l) {
  int n = r->system->n_q;
  for (int i = 0; i < n && l->a_q; i++)
    PL_TRY(derivative(r, l, &l->q[i], size_of(l->q, n, i), l->a_q + (size_t)i * (size_t)n));
  for (int i = 0; i < n && l->a_v; i++)
    PL_TRY(derivative(r, l, &l->v[i], size_of(l->v, n, i), l->a_v + (size_t)i * (size_t)n));
  for (int i = 0; i < r->system->recording->numbers->n_inputs && l->a_u; i++)
    PL_TRY(by_input(r, l, i, l->a_u + (size_t)i * (size_t)n));
  return PLEUEL_OK;
}

static pleuel_status linearise(pleuel_run* r, void* argument) {
  pl_linear* l = argument;
  pl_row row;
  PL_TRY(pl_api_run_need_start(r));
  PL_TRY(pl_api_run_need_plain(r));
  PL_TRY(make_probe(r));
  pl_run_row(r->run, &row);
  size_t n = (size_t)r->system->n_q;
  double** room[] = {&l->q, &l->v, &l->plus, &l->minus};
  for (int i = 0; i < 4; i++) *room[i] = PL_ARRAY(r->motion, double, n + 1);
  pl_api_run_give_state(r, &row, l->q, l->v, NULL, NULL);
  l->t = row.t;
  return all_columns(r, l);
}

pleuel_status pleuel_run_linearise(pleuel_run* r, double* a_q, double* a_v, double* a_u) {
  if (!r) return PLEUEL_USAGE;
  return pl_api_run_guarded(r, linearise, &(pl_linear){.a_q = a_q, .a_v = a_v, .a_u = a_u});
}

// ---------------------------------------------------------------------------------------- as bytes
// What must be the same in the run that goes on: text, settings, numbers, options, version.
static uint64_t identity(const pleuel_run* r) {
  const pleuel_model* m = r->system->model;
  const pleuel_sim_options* o = &r->options;
  uint64_t h = pl_hash_bytes(PLEUEL_VERSION, sizeof PLEUEL_VERSION, m->text_hash);
  for (int i = 0; i < m->n_settings; i++) {
    h = pl_hash_bytes(m->settings[i].name, strlen(m->settings[i].name) + 1, h);
    h = pl_hash_bytes(m->settings[i].value, strlen(m->settings[i].value) + 1, h);
  }
  double numbers[] = {o->has_until ? o->until : -1, o->has_tol ? o->tol : -1, (double)o->method,
                      (double)o->precision};
  h = pl_hash_bytes(numbers, sizeof numbers, h);
  for (int i = 0; i < r->given.n; i++) h = pl_hash_mix(h, (uint64_t)r->given.at[i]);
  h = pl_hash_bytes(r->given_value.at, (size_t)r->given.n * sizeof(double), h);
  for (int i = 0; i < r->starts.n; i++) {
    h = pl_hash_mix(h, (uint64_t)r->starts.at[i].at * 2 + r->starts.at[i].velocity);
    h = pl_hash_bytes(&r->starts.at[i].value, sizeof(double), h);
  }
  return h;
}

static void keep_head(pleuel_run* r, pl_keeper* k, uint64_t* whose) {
  size_t n = (size_t)r->system->n_q;
  pl_keep_section(k, "run");
  pl_keep_bytes(k, whose, sizeof *whose);
  pl_keep_bool(k, &r->from_state);
  pl_keep_f64(k, &r->t_origin);
  pl_keep_f64s(k, r->q_origin, n);
  pl_keep_f64s(k, r->v_origin, n);
  pl_keep_long(k, &r->input_count, 0, LONG_MAX / 8);
  pl_keep_f64(k, &r->input_next);
}

typedef struct pl_run_bytes {
  void* to;
  const void* from;
  size_t n;
} pl_run_bytes;

static pleuel_status save(pleuel_run* r, void* argument) {
  pl_run_bytes* b = argument;
  PL_TRY(pl_api_run_need_start(r));
  pl_mark mark = pl_arena_mark(r->motion);
  pl_keeper k = pl_keeper_to_write(r->motion);
  uint64_t whose = identity(r);
  keep_head(r, &k, &whose);
  pl_run_save(r->run, &k);
  bool fits = !b->to || b->n >= k.next;
  if (b->to && fits) memcpy(b->to, k.at, k.next);
  b->n = k.next;
  pl_arena_rewind(r->motion, mark);
  return fits ? PLEUEL_OK : pl_fail(&r->job, PLEUEL_USAGE, "the state takes %zu bytes", b->n);
}

pleuel_status pleuel_run_save(pleuel_run* r, void* bytes, size_t* n) {
  if (!r || !n) return PLEUEL_USAGE;
  pl_run_bytes b = {bytes, NULL, *n};
  pleuel_status s = pl_api_run_guarded(r, save, &b);
  *n = b.n;
  return s;
}

static pleuel_status none_of_this(pleuel_run* r) {
  pl_api_run_drop(r);
  return pl_fail(&r->job, PLEUEL_FILE, "the state that was kept is not one of this run");
}

static pleuel_status begin_again(pleuel_run* r) {
  pl_run_options how = pl_api_run_options_of(r);
  how.dt = 0;
  how.count = 0;
  if (!r->from_state) return pl_api_run_begin(r, &how, &r->run);
  pl_state_given from = {r->t_origin, r->q_origin, r->v_origin, NULL, NULL};
  return pl_api_run_begin_from(r, &from);
}

static pleuel_status restore(pleuel_run* r, void* argument) {
  const pl_run_bytes* b = argument;
  uint64_t whose = 0;
  pl_keeper k = pl_keeper_to_read(r->motion, b->from, b->n);
  PL_TRY(pl_api_run_clear(r));
  keep_head(r, &k, &whose);
  if (k.wrong || whose != identity(r)) return none_of_this(r);
  PL_TRY(begin_again(r));
  pl_sink sink = pl_api_run_sink(r);
  pleuel_status s = pl_run_load(r->run, &k, &sink);
  if (s == PLEUEL_OK && !pl_keep_is_whole(&k)) s = none_of_this(r);
  if (s != PLEUEL_OK) pl_api_run_drop(r);
  return s;
}

pleuel_status pleuel_run_restore(pleuel_run* r, const void* bytes, size_t n) {
  if (!r || !bytes) return PLEUEL_USAGE;
  return pl_api_run_guarded(r, restore, &(pl_run_bytes){NULL, bytes, n});
}

// ----------------------------------------------------------------------------------------- at once
static pleuel_status whole(pleuel_run* r, pleuel_result* result) {
  if (r->input)
    return pl_fail(&r->job, PLEUEL_USAGE, "a run with inputs by a function advances to a time");
  PL_TRY(pl_api_run_clear(r));
  pl_run_options how = pl_api_run_options_of(r);
  how.sink = pl_result_fill(result, &r->options);
  PL_TRY(pl_api_run_begin(r, &how, &r->run));
  return pl_run_to_end(r->run);
}

static pleuel_status complete(pleuel_run* r, void* argument) {
  pleuel_result* result = argument;
  pl_guard guard;
  volatile pleuel_status s = PLEUEL_NO_MEMORY;
  PL_GUARD(result->arena, guard) { s = whole(r, result); }
  else {
    pl_fail(&r->job, PLEUEL_NO_MEMORY, "memory ran out");
  }
  pl_guard_end(result->arena, &guard);
  pl_api_run_drop(r);
  return s;
}

pleuel_status pleuel_run_complete(pleuel_run* r, pleuel_result** result) {
  if (!r || !result) return PLEUEL_USAGE;
  *result = pl_result_open(r->system, !r->options.no_rows);
  if (!*result) return PLEUEL_NO_MEMORY;
  pleuel_status s = pl_api_run_guarded(r, complete, *result);
  pl_result_close(*result, s, r->message);
  return s;
}
