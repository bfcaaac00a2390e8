// Runs: a motion under way, with memory and numbers of its own.  Nothing here looks at expressions;
// what is read of a system does not change.
#include <math.h>
#include <string.h>

#include "api/run_impl.h"

// ----------------------------------------------------------------------------------- guarded calls
void pl_api_run_drop(pleuel_run* r) {
  if (r->run) pl_run_free(r->run);
  if (r->probe) pl_run_free(r->probe);
  r->run = r->probe = NULL;
  r->has_event = false;
}

pleuel_status pl_api_run_guarded(pleuel_run* r, pl_api_run_work* work, void* argument) {
  volatile pleuel_status status = PLEUEL_NO_MEMORY;
  pl_guard outer, inner;
  r->message[0] = r->job.message[0] = '\0';
  r->interruption.stopped = false;
  PL_GUARD(r->arena, outer) {
    PL_GUARD(r->motion, inner) { status = work(r, argument); }
    else {
      pl_api_run_drop(r);
      pl_fail(&r->job, PLEUEL_NO_MEMORY, "memory ran out");
    }
    pl_guard_end(r->motion, &inner);
  }
  else {
    pl_fail(&r->job, PLEUEL_NO_MEMORY, "memory ran out");
  }
  pl_guard_end(r->arena, &outer);
  if (status != PLEUEL_OK) snprintf(r->message, sizeof r->message, "%s", r->job.message);
  return status;
}

const char* pleuel_run_message(const pleuel_run* r) { return r ? r->message : ""; }

void pleuel_run_interrupt(pleuel_run* r) {
  if (r) atomic_store(&r->interruption.asked, 1);
}

void pleuel_run_interrupt_clear(pleuel_run* r) {
  if (r) atomic_store(&r->interruption.asked, 0);
}

// ---------------------------------------------------------------------------------- open and close
static pleuel_run* make(pleuel_system* s, pl_arena* arena, pl_arena* motion,
                        const pleuel_sim_options* o) {
  pleuel_run* r = PL_NEW(arena, pleuel_run);
  r->arena = arena;
  r->motion = motion;
  r->empty = pl_arena_mark(motion);
  r->system = s;
  r->options = *o;
  pl_sim_options_own(arena, &r->options);
  r->diagnostics.arena = arena;
  r->job = (pl_job){.arena = motion,
                    .diagnostics = &r->diagnostics,
                    .interrupted = &r->interruption,
                    .lang = s->lang};
  r->row = PL_ARRAY(arena, double, s->columns.n + 1);
  r->u = PL_ARRAY(arena, double, s->recording->numbers->n_inputs + 1);
  r->q_origin = PL_ARRAY(arena, double, s->n_q + 1);
  r->v_origin = PL_ARRAY(arena, double, s->n_q + 1);
  r->numbered = *s->recording;
  return r;
}

// What belongs to a system is not another one's.
static pleuel_status check_options(pleuel_run* r, void* unused) {
  (void)unused;
  const pleuel_sim_options* of = &r->system->options;
  const char *mine = r->options.sensitivities, *its = of->sensitivities;
  bool same = mine == its || (mine && its && strcmp(mine, its) == 0);
  PL_TRY(pl_sim_options_check(&r->job, &r->options));
  if (!same || r->options.precision != of->precision)
    return pl_fail(&r->job, PLEUEL_USAGE, "precision and sensitivities are those of the system");
  return PLEUEL_OK;
}

pleuel_status pleuel_run_open(pleuel_system* s, pleuel_run** run,
                              const pleuel_sim_options* options) {
  if (run) *run = NULL;
  if (!s || !run || (options && options->size == 0)) return PLEUEL_USAGE;
  pleuel_sim_options o;
  if (options) pl_api_copy(&o, sizeof o, options);
  else o = s->options;
  const pleuel_allocator* alloc = s->model->alloc.take ? &s->model->alloc : NULL;
  pl_arena *arena = pl_arena_make(alloc), *motion = arena ? pl_arena_make(alloc) : NULL;
  pleuel_run* volatile made = NULL;
  pl_guard guard;
  if (motion) {
    PL_GUARD(arena, guard) made = make(s, arena, motion, &o);
    pl_guard_end(arena, &guard);
  }
  if (!made) {
    pl_arena_free(motion);
    pl_arena_free(arena);
    return PLEUEL_NO_MEMORY;
  }
  pleuel_system_keep(s);
  *run = made;
  return pl_api_run_guarded(made, check_options, NULL);
}

void pleuel_run_close(pleuel_run* r) {
  if (!r) return;
  pleuel_system* s = r->system;
  pl_api_run_drop(r);
  pl_arena_free(r->motion);
  pl_arena_free(r->arena);
  pleuel_system_free(s);
}

// ----------------------------------------------------------------------------------------- numbers
static void set_given(pleuel_run* r, int i, double x) {
  for (int k = 0; k < r->given.n; k++) {
    if (r->given.at[k] != i) continue;
    r->given_value.at[k] = x;
    return;
  }
  pl_push(r->arena, r->given, i);
  pl_push(r->arena, r->given_value, x);
}

static void set_start(pleuel_run* r, int at, bool velocity, double x) {
  for (int k = 0; k < r->starts.n; k++) {
    pl_number_start_set* s = &r->starts.at[k];
    if (s->at != at || s->velocity != velocity) continue;
    s->value = x;
    return;
  }
  pl_push(r->arena, r->starts, (pl_number_start_set){at, velocity, x});
}

typedef struct pl_setting_number {
  const char* name;
  double x;
} pl_setting_number;

static pleuel_status set(pleuel_run* r, void* argument) {
  const pl_setting_number* a = argument;
  const pl_numbers* n = r->system->recording->numbers;
  if (!isfinite(a->x)) return pl_fail(&r->job, PLEUEL_USAGE, "%s: this is no number", a->name);
  if (n->fixed)
    return pl_fail(&r->job, PLEUEL_UNSUPPORTED,
                   "the numbers of this system are fixed: load its model with other settings");
  const pl_quantity* q = pl_api_quantity(r->system, PLEUEL_KIND_INPUT, a->name);
  if (q) {
    set_given(r, q->index, a->x);
    return r->run ? pl_api_run_restart(r) : PLEUEL_OK;
  }
  q = pl_api_quantity(r->system, PLEUEL_KIND_PARAMETER, a->name);
  if (q && n->given[q->index].size)
    return pl_fail(&r->job, PLEUEL_USAGE,
                   "%s decides how large the system is: load the model with another setting",
                   a->name);
  if (q) {
    set_given(r, q->index, a->x);
    return PLEUEL_OK;
  }
  q = pl_api_quantity(r->system, PLEUEL_KIND_COORDINATE, a->name);
  bool velocity = q == NULL;
  if (velocity) q = pl_api_quantity(r->system, PLEUEL_KIND_VELOCITY, a->name);
  if (!q)
    return pl_fail(&r->job, PLEUEL_USAGE, "no parameter, input, or start value is named %s",
                   a->name);
  set_start(r, q->index, velocity, a->x);
  return PLEUEL_OK;
}

pleuel_status pleuel_run_set(pleuel_run* r, const char* name, double si) {
  if (!r || !name) return PLEUEL_USAGE;
  return pl_api_run_guarded(r, set, &(pl_setting_number){name, si});
}

void pleuel_run_reset(pleuel_run* r) {
  if (r) r->given.n = r->given_value.n = r->starts.n = 0;
}

// ------------------------------------------------------------------------------------------ events
static pleuel_status on_begin(void* user, const pl_setup* setup) {
  (void)user;
  (void)setup;
  return PLEUEL_OK;
}

static double* flat(pleuel_run* r, const double* old, const pl_row* row) {
  double* x = (double*)(uintptr_t)old;
  if (!x) x = PL_ARRAY(r->motion, double, r->system->columns.n + 1);
  pl_result_flatten(&r->numbered.setup, row, x);
  return x;
}

static pleuel_status on_event(void* user, const pl_event_record* e) {
  pleuel_run* r = user;
  pl_event_kept* k = &r->event;
  k->kind = e->kind;
  k->label = e->label;
  k->t = e->after.t;
  k->impulse = e->impulse;
  k->jump = e->jump;
  k->bounces = e->bounces;
  k->before = flat(r, k->before, &e->before);
  k->after = flat(r, k->after, &e->after);
  r->has_event = true;
  return PLEUEL_OK;
}

// A row that is asked for.
static pleuel_status on_row(void* user, const pl_row* row) {
  pleuel_run* r = user;
  if (!r->block || r->block_at >= r->block_n || row->kind == PL_ROW_BEFORE) return PLEUEL_OK;
  if (row->t != r->block_t[r->block_at]) return PLEUEL_OK;
  pl_result_flatten(&r->numbered.setup, row, r->block + r->block_at++ * r->block_stride);
  return PLEUEL_OK;
}

pleuel_status pleuel_run_event(pleuel_run* r, pleuel_event* out) {
  if (!r || !out || !r->has_event) return PLEUEL_USAGE;
  return pl_event_give(&r->event, out);
}

// ------------------------------------------------------------------------------------------- start
bool pl_api_run_is_turned(const pleuel_run* r) { return r->numbered.turned != NULL; }

const pl_setup* pl_api_run_setup(const pleuel_run* r) {
  return pl_api_run_is_turned(r) ? &r->numbered.turned->setup : &r->numbered.setup;
}

pl_run_options pl_api_run_options_of(const pleuel_run* r) {
  const pl_recording* n = &r->numbered;
  pl_run_options how = {
      .t_0 = n->t_0, .t_end = n->t_end, .tol = n->tol, .dt = n->dt, .count = n->count};
  pl_sim_options_take(&r->options, &how);
  return how;
}

pl_sink pl_api_run_sink(pleuel_run* r) {
  return (pl_sink){.user = r, .begin = on_begin, .row = on_row, .event = on_event};
}

static pleuel_status number(pleuel_run* r) {
  const pl_recording* from = r->system->recording;
  pl_numbers_set set = {r->given.n, r->starts.n, r->given.at, r->given_value.at, r->starts.at};
  r->numbered = *from;
  return r->given.n + r->starts.n ? pl_numbers_apply(&r->job, from, &set, &r->numbered) : PLEUEL_OK;
}

pleuel_status pl_api_run_clear(pleuel_run* r) {
  pl_api_run_drop(r);
  pl_arena_rewind(r->motion, r->empty);
  r->event = (pl_event_kept){0};
  r->stopped = PLEUEL_OK;
  r->block = NULL;
  return number(r);
}

static pleuel_status ask_inputs(pleuel_run* r, double t);

pleuel_status pl_api_run_begin(pleuel_run* r, const pl_run_options* how, pl_run** out) {
  pl_start_report report;
  const pl_recording* plain = r->system->plain;
  if (isnan(how->t_end))
    return pl_fail(&r->job, PLEUEL_USAGE,
                   "how long? The file has no `simulate` line; give the end of the run");
  PL_TRY(pl_run_make(&r->job, pl_api_run_setup(r), how, out));
  bool turned = pl_api_run_is_turned(r);
  return pl_start_motion(&r->job, &r->numbered, plain, turned, how, *out, &report);
}

static pleuel_status start(pleuel_run* r) {
  r->from_state = false;
  PL_TRY(pl_api_run_clear(r));
  r->input_count = 0;
  if (r->input) {
    PL_TRY(ask_inputs(r, pl_api_run_options_of(r).t_0));
    PL_TRY(pl_api_run_clear(r));
  }
  pl_run_options how = pl_api_run_options_of(r);
  how.dt = 0;
  how.count = 0;
  how.sink = pl_api_run_sink(r);
  return pl_api_run_begin(r, &how, &r->run);
}

static pleuel_status start_whole(pleuel_run* r, void* unused) {
  (void)unused;
  pleuel_status s = start(r);
  if (s != PLEUEL_OK) pl_api_run_drop(r);
  return s;
}

pleuel_status pl_api_run_need_start(pleuel_run* r) {
  if (r->run) return PLEUEL_OK;
  return pl_fail(&r->job, PLEUEL_USAGE, "the run was not started");
}

pleuel_status pleuel_run_start(pleuel_run* r) {
  return r ? pl_api_run_guarded(r, start_whole, NULL) : PLEUEL_USAGE;
}

// ------------------------------------------------------------------------------------------ inputs
pleuel_status pleuel_run_input(pleuel_run* r,
                               int (*input)(void* user, pleuel_run* run, double t, double* u),
                               void* user, double dt) {
  if (!r || (input && !(dt > 0))) return PLEUEL_USAGE;
  r->input = input;
  r->input_user = user;
  r->input_dt = dt;
  return PLEUEL_OK;
}

static pleuel_status ask_inputs(pleuel_run* r, double t) {
  const pl_numbers* n = r->system->recording->numbers;
  if (r->input(r->input_user, r, t, r->u) != 0)
    return pl_fail(&r->job, PLEUEL_INTERRUPTED, "interrupted at t = %.9g s", t);
  for (int i = 0; i < n->n_inputs; i++) {
    if (!isfinite(r->u[i]))
      return pl_fail(&r->job, PLEUEL_USAGE, "%s: this is no number", n->given[n->inputs[i]].ascii);
    set_given(r, n->inputs[i], r->u[i]);
  }
  r->input_count++;
  r->input_next = pl_api_run_options_of(r).t_0 + (double)r->input_count * r->input_dt;
  return PLEUEL_OK;
}

// ----------------------------------------------------------------------------------------- forward
typedef struct pl_run_way {
  double t;
  bool to_event;
} pl_run_way;

static pleuel_status advance(pleuel_run* r, void* argument) {
  const pl_run_way* w = argument;
  PL_TRY(pl_api_run_need_start(r));
  if (r->stopped != PLEUEL_OK)
    return pl_fail(&r->job, r->stopped, "the motion has ended: start it again");
  if (!r->input) return r->stopped = pl_run_to(r->run, w->t, w->to_event);
  while (!pl_run_done(r->run) && pl_run_time(r->run) < w->t) {
    double to = fmin(w->t, r->input_next);
    bool before = r->has_event;
    r->has_event = false;
    PL_TRY(r->stopped = pl_run_to(r->run, to, w->to_event));
    bool happened = r->has_event;
    r->has_event |= before;
    if (happened && w->to_event) return PLEUEL_OK;
    if (pl_run_time(r->run) < r->input_next || pl_run_done(r->run)) continue;
    PL_TRY(ask_inputs(r, pl_run_time(r->run)));
    PL_TRY(pl_api_run_restart(r));
  }
  return PLEUEL_OK;
}

// What stops a motion for good; a wish to stop and a wrong argument do not.
static pleuel_status moved(pleuel_run* r, pleuel_status s) {
  if (s == PLEUEL_INTERRUPTED || s == PLEUEL_USAGE || s == PLEUEL_UNSUPPORTED)
    r->stopped = PLEUEL_OK;
  return s;
}

pleuel_status pleuel_run_advance(pleuel_run* r, double t, int to_event) {
  return r ? moved(r, pl_api_run_guarded(r, advance, &(pl_run_way){t, to_event != 0}))
           : PLEUEL_USAGE;
}

static pleuel_status step(pleuel_run* r, void* unused) {
  (void)unused;
  PL_TRY(pl_api_run_need_start(r));
  if (r->stopped != PLEUEL_OK)
    return pl_fail(&r->job, r->stopped, "the motion has ended: start it again");
  if (r->input)
    return pl_fail(&r->job, PLEUEL_USAGE, "a run with inputs by a function advances to a time");
  return r->stopped = pl_run_step(r->run);
}

pleuel_status pleuel_run_step(pleuel_run* r) {
  return r ? moved(r, pl_api_run_guarded(r, step, NULL)) : PLEUEL_USAGE;
}

// ----------------------------------------------------------------------------- rows at given times
typedef struct pl_sampling {
  const double* t;
  size_t n, stride;
  double* block;
} pl_sampling;

static pleuel_status check_times(pleuel_run* r, const pl_sampling* s) {
  if (s->stride < (size_t)r->system->columns.n || s->n > 1u << 30)
    return pl_fail(&r->job, PLEUEL_USAGE, "a row has %d columns", r->system->columns.n);
  for (size_t i = 1; i < s->n; i++)
    if (!(s->t[i] > s->t[i - 1]))
      return pl_fail(&r->job, PLEUEL_USAGE, "times of rows follow each other");
  return PLEUEL_OK;
}

static void fill_here(pleuel_run* r, const pl_sampling* s) {
  pl_row row;
  if (r->block_at >= s->n || pl_run_time(r->run) != s->t[r->block_at]) return;
  pl_run_row(r->run, &row);
  pl_result_flatten(&r->numbered.setup, &row, s->block + r->block_at++ * s->stride);
}

static pleuel_status sample(pleuel_run* r, void* argument) {
  const pl_sampling* s = argument;
  PL_TRY(pl_api_run_need_start(r));
  PL_TRY(check_times(r, s));
  if (s->n == 0) return PLEUEL_OK;
  r->block = s->block;
  r->block_stride = s->stride;
  r->block_n = s->n;
  r->block_at = 0;
  r->block_t = s->t;
  fill_here(r, s);
  pl_run_rows_at(r->run, s->t, (int)s->n);
  pleuel_status status = PLEUEL_OK;
  if (r->block_at < s->n) status = advance(r, &(pl_run_way){s->t[s->n - 1], false});
  if (status == PLEUEL_OK) fill_here(r, s);
  r->block = NULL;
  if (status == PLEUEL_OK && r->block_at < s->n)
    return pl_fail(&r->job, PLEUEL_NUMERICAL, "the motion ended at t = %.9g s, before the last row",
                   pl_run_time(r->run));
  return status;
}

pleuel_status pleuel_run_sample(pleuel_run* r, const double* t, size_t n, double* block,
                                size_t stride) {
  if (!r || (n && (!t || !block))) return PLEUEL_USAGE;
  return moved(r, pl_api_run_guarded(r, sample, &(pl_sampling){t, n, stride, block}));
}
