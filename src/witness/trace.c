// The run of a trace: a few steps, each with its state and what holds.
#include "witness/trace_impl.h"

#include <math.h>

enum { MOST_SAMPLES = 120, MOST_STEPS = 2000, STEPS_IN_SPAN = 40 };

typedef struct pl_tracer {
  pl_arena* arena;
  pl_trace* trace;
  const pl_run* run;
  bool changed;  // something happened in the step: set, state or both
  bool jumped;
  pl_event_kind kind;  // what it was, the first of it
  const char* label;
} pl_tracer;

// ----------------------------------------------------------------------------------------- samples
static const double* copied(pl_arena* a, const double* x, int n) {
  double* out = PL_ARRAY(a, double, n + 1);
  memcpy(out, x, (size_t)n * sizeof *out);
  return out;
}

static pl_trace_sample sample_of(pl_tracer* t, const pl_row* row) {
  const pl_setup* s = &t->trace->recording->setup;
  bool* unique = PL_ARRAY(t->arena, bool, s->n_c + 1);
  memcpy(unique, row->unique, (size_t)s->n_c * sizeof *unique);
  return (pl_trace_sample){.t = row->t,
                           .q = copied(t->arena, row->q, s->n_q),
                           .v = copied(t->arena, row->v, s->n_q),
                           .a = copied(t->arena, row->a, s->n_q),
                           .lambda = copied(t->arena, row->lambda, s->n_c),
                           .unique = unique,
                           .out = copied(t->arena, row->out, s->n_out),
                           .phase = t->trace->phases.n - 1};
}

static void add_sample(pl_tracer* t, const pl_row* row) {
  pl_trace_sample sample = sample_of(t, row);
  pl_push(t->arena, t->trace->samples, sample);
  pl_trace_phase* phase = &t->trace->phases.at[sample.phase];
  phase->n++;
  phase->t_end = row->t;
}

// ------------------------------------------------------------------------------------------ phases
static bool friction_differs(const pl_friction_report* a, const pl_friction_report* b) {
  return a->mode != b->mode
         || (a->mode == PL_FRICTION_SLIPS && (a->way != b->way || a->press != b->press));
}

static bool set_differs(const pl_tracer* t) {
  const pl_trace_phase* last = &t->trace->phases.at[t->trace->phases.n - 1];
  for (int i = 0; i < t->trace->recording->setup.n_frictions; i++) {
    pl_friction_report now = pl_run_friction(t->run, i);
    if (friction_differs(&now, &last->frictions[i])) return true;
  }
  for (int c = 0; c < t->trace->recording->setup.n_c; c++) {
    if (pl_run_is_active(t->run, c) != last->active[c]) return true;
  }
  return false;
}

static void open_phase(pl_tracer* t, double at) {
  int n_c = t->trace->recording->setup.n_c;
  bool *active = PL_ARRAY(t->arena, bool, n_c + 1), *released = PL_ARRAY(t->arena, bool, n_c + 1);
  for (int c = 0; c < n_c; c++) {
    active[c] = pl_run_is_active(t->run, c);
    released[c] = pl_run_is_released(t->run, c);
  }
  int n_frictions = t->trace->recording->setup.n_frictions;
  pl_friction_report* frictions = PL_ARRAY(t->arena, pl_friction_report, n_frictions + 1);
  for (int i = 0; i < n_frictions; i++) frictions[i] = pl_run_friction(t->run, i);
  pl_trace_phase phase = {.frictions = frictions,
                          .t_begin = at,
                          .t_end = at,
                          .first = t->trace->samples.n,
                          .active = active,
                          .released = released,
                          .begun_by = t->kind};
  phase.begun_label = t->label;
  phase.same_set = t->trace->phases.n > 0 && !set_differs(t);
  pl_push(t->arena, t->trace->phases, phase);
}

static pleuel_status on_row(void* user, const pl_row* row) {
  pl_tracer* t = user;
  if (t->trace->phases.n == 0 || t->jumped || set_differs(t)) open_phase(t, row->t);
  t->changed = t->jumped = false;
  t->label = NULL;
  if (!t->trace->singular) add_sample(t, row);
  return PLEUEL_OK;
}

static bool same_state(const pl_row* a, const pl_row* b, int n_q) {
  return memcmp(a->q, b->q, (size_t)n_q * sizeof(double)) == 0
         && memcmp(a->v, b->v, (size_t)n_q * sizeof(double)) == 0;
}

// The state before the first event of a moment belongs to the phase that ends; that after the last
// is the next row.
static pleuel_status on_event(void* user, const pl_event_record* e) {
  pl_tracer* t = user;
  if (t->trace->phases.n == 0) {  // at the start: nothing ends
    bool lets_go = e->kind == PL_EV_RELEASE || e->kind == PL_EV_SLACK;
    if (lets_go && e->at_start) t->trace->pulls[e->index] = true;
    return PLEUEL_OK;
  }
  if (e->kind == PL_EV_EVENT && e->label && strcmp(e->label, PL_TRACE_MARK) == 0)
    pl_push(t->arena, t->trace->marks, sample_of(t, &e->before));
  if (e->kind == PL_EV_STOP) t->trace->stopped_by = e->label;
  bool settles = e->bounces > 0;  // behind endless bounces: nothing is before
  bool first = !t->changed && e->kind != PL_EV_SINGULAR && !settles && !t->trace->singular;
  t->trace->singular |= e->kind == PL_EV_SINGULAR;
  if (first) {
    t->kind = e->kind;
    t->label = e->label;
    add_sample(t, &e->before);
  }
  t->changed = true;
  t->jumped |= e->jump || !same_state(&e->before, &e->after, t->trace->recording->setup.n_q);
  return PLEUEL_OK;
}

// ---------------------------------------------------------------------------------------- the span
static double norm(const double* x, int n) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += x[i] * x[i];
  return sqrt(sum);
}

// A few times the shortest time in which the start changes by its own size.
static double natural_span(pl_job* job, const pl_recording* r) {
  pl_run* run = NULL;
  pl_run_options how = {.t_0 = r->t_0, .t_end = r->t_0 + 1, .engine = PL_ENGINE_INTERPRETER};
  double span = 1;
  if (pl_run_make(job, &r->setup, &how, &run) == PLEUEL_OK && pl_run_start(run) == PLEUEL_OK) {
    int n = r->setup.n_q;
    double q = fmax(norm(pl_run_q(run), n), 1), v = norm(pl_run_v(run), n),
           a = norm(pl_run_a(run), n);
    double by_v = v > 0 ? q / v : (double)INFINITY, by_a = a > 0 ? sqrt(q / a) : (double)INFINITY;
    span = 3 * fmin(by_v, by_a);
  }
  pl_run_free(run);
  return isfinite(span) && span > 0 ? span : 1;
}

static double span_of(pl_job* job, const pl_recording* r, const pl_trace_options* o) {
  if (o->span > 0) return o->span;
  double given = r->t_end - r->t_0;
  if (o->seed == 0 && isfinite(given) && given > 0) return given;
  double span = natural_span(job, r);
  return isfinite(given) && given > 0 ? fmin(span, given) : span;
}

// ----------------------------------------------------------------------------------------- the run
// Of several assemblies that fit, one is as good as the other: the first.
static pleuel_status start(pl_run* run, double t_0, int n_q, pl_job* job) {
  pleuel_status s = pl_run_start(run);
  const pl_start_report* report = pl_run_start_report(run);
  if (s == PLEUEL_OK || report->trouble != PL_START_SEVERAL || report->n_candidates == 0) return s;
  bool* held = PL_ARRAY(job->arena, bool, 2 * n_q + 1);
  for (int i = 0; i < n_q; i++) held[i] = true;
  return pl_run_start_partly(run, t_0, report->candidates, copied(job->arena, pl_run_v(run), n_q),
                             held, held + n_q);
}

static void steps(pl_tracer* t, pl_run* run, long most, bool goes_on) {
  pl_trace* out = t->trace;
  while (!pl_run_done(run) && !out->singular && (out->marks.n == 0 || goes_on)
         && out->samples.n < most && out->steps < MOST_STEPS && out->status == PLEUEL_OK) {
    out->status = pl_run_step(run);
    out->steps++;
  }
  out->whole = out->status == PLEUEL_OK && pl_run_done(run);
  out->t_end = pl_run_time(run);
  bool failed = out->status != PLEUEL_OK && out->phases.n > 0;
  pl_trace_phase* last = failed ? &out->phases.at[out->phases.n - 1] : NULL;
  if (last && out->samples.n > 1 && last->n > 1) {
    out->samples.n--;
    last->n--;
  }  // where it failed nothing is sure
}

static void run(pl_job* job, pl_trace* out, const pl_trace_options* o) {
  const pl_recording* r = out->recording;
  pl_tracer t = {.arena = job->arena, .trace = out};
  double span = span_of(job, r, o);
  pl_run_options how = {.t_0 = r->t_0,
                        .t_end = r->t_0 + span,
                        .h_max = span / STEPS_IN_SPAN,
                        .engine = PL_ENGINE_INTERPRETER};
  how.method = PL_METHOD_AUTO;
  how.sink = (pl_sink){.user = &t, .row = on_row, .event = on_event};
  pl_run* made = NULL;
  out->pulls = PL_ARRAY(job->arena, bool, r->setup.n_c + 1);
  out->status = pl_run_make(job, &r->setup, &how, &made);
  t.run = made;
  if (out->status == PLEUEL_OK) out->status = start(made, r->t_0, r->setup.n_q, job);
  out->n_free = made ? pl_run_start_report(made)->n_free : 0;
  out->moved = made ? pl_run_start_report(made)->largest_move : 0;
  if (out->status == PLEUEL_OK)
    steps(&t, made, o->most_samples > 0 ? o->most_samples : MOST_SAMPLES, o->n_watched > 0);
  out->started = out->samples.n > 0;
  int n = r->setup.n_q + r->setup.n_c;
  out->work = (double)out->steps * (double)n * (double)n;
  pl_run_free(made);
}

static void attempt(pl_job* job, pl_trace* out, pl_model* model, const pl_trace_options* o) {
  if (!pl_is_poison(o->meet)) model = pl_trace_marked(job, model, o->meet);
  for (int k = 0; k < o->n_watched; k++) model = pl_trace_marked(job, model, o->watched[k]);
  *out = (pl_trace){.model = model};
  pl_recording* recording = NULL;
  out->status = pl_record(job, model, NULL, false, &recording);
  out->recording = out->status == PLEUEL_OK ? recording : NULL;
  if (out->recording) run(job, out, o);
  out->message = out->status == PLEUEL_OK ? "" : pl_copy(job->arena, job->message);
}

// The start of `init` as `sim` finds it; where that leaves something open, or finds none,
// coordinates that are not given start somewhere.
static void attempt_init(pl_job* job, pl_trace* out, pl_model* m, const pl_trace_options* o) {
  attempt(job, out, m, o);
  bool open = !out->started || (out->n_free > 0 && !m->simulate.given);
  if (!open || !out->recording) return;
  pl_trace first = *out;
  attempt(job, out, pl_trace_open_start(job, m), o);
  if (!out->started) *out = first;
}

pl_trace* pl_trace_make(pl_job* job, pl_model* numbered, const pl_trace_options* options) {
  pl_diagnostics quiet = {.arena = job->arena};
  pl_job mine = {.arena = job->arena,
                 .diagnostics = &quiet,
                 .interrupted = job->interrupted,
                 .lang = job->lang};
  pl_trace* out = PL_NEW(job->arena, pl_trace);
  pl_trace_options o = options ? *options : (pl_trace_options){0};
  if (o.from && o.from->given)
    attempt(&mine, out, pl_trace_named_start(job, numbered, o.from, o.push), &o);
  else if (o.seed) attempt(&mine, out, pl_trace_random_start(job, numbered, o.beside, o.seed), &o);
  else if (o.as_run) attempt(&mine, out, numbered, &o);
  else attempt_init(&mine, out, pl_trace_closed(job, numbered), &o);
  out->value = pl_model_values(out->model, job->arena);
  out->n_value = pl_symbol_count(out->model->pool) + 1;
  return out;
}

// ----------------------------------------------------------------------------------------- reading
int pl_trace_constraint(const pl_trace* t, int constraint, int instance) {
  if (!t->recording || constraint < 0 || constraint >= t->model->constraints.n) return -1;
  int at = t->recording->first_constraint[constraint] + instance;
  return at < t->recording->first_constraint[constraint + 1] ? at : -1;
}

bool pl_trace_holds(const pl_trace* t, const pl_trace_phase* phase, int constraint) {
  int at = pl_trace_constraint(t, constraint, 0);
  if (at < 0) return false;
  for (int k = 1; at >= 0; at = pl_trace_constraint(t, constraint, k++)) {
    if (!phase->active[at]) return false;
  }
  return true;
}

bool pl_trace_sticks(const pl_trace* t, const pl_trace_phase* phase, int friction) {
  const pl_setup* s = &t->recording->setup;
  const pl_constraint* on = pl_model_constraint(t->model, t->model->frictions.at[friction].label);
  if (!on) return false;
  int constraint = pl_trace_constraint(t, (int)(on - t->model->constraints.at), 0);
  for (int i = 0; i < s->n_frictions; i++) {
    if (s->frictions[i].constraint == constraint) return phase->active[s->frictions[i].row[0]];
  }
  return false;
}
