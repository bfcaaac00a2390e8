// pipeline: every arrow of the program on one page.
//
//     text -> lang -> model -> derive -> (a) notation -> report            worked solution, JSON
//                                     -> (b) program -> solve -> result -> report     motion
//
// Each step is taken once and remembered in the pleuel_model; asking for a later one takes those
// before it. A step that was interrupted is taken anew.
#include "api/editor.h"
#include "api/stages.h"
#include "api/system_impl.h"
#include "witness/witness.h"

#include <errno.h>
#include <math.h>
#include <string.h>

// The steps that are remembered are taken in memory that lives as long as they do.
static pl_arena* work_in(pleuel_model* m, pl_arena* arena) {
  pl_arena* before = m->job.arena;
  m->job.arena = arena;
  return before;
}

static void note_time(pleuel_model* m, int stage, double start_s) {
  m->stage_ms[stage] += 1e3 * (pl_clock() - start_s);
}

// Includes as they are read, all of them part of the text.
static const pl_source* read_hashed(void* user, pl_arena* a, const char* path,
                                    const pl_source* from) {
  pleuel_model* m = user;
  const pl_source* s = m->reader->read(m->reader->user, a, path, from);
  if (s) m->text_hash = pl_hash_bytes(s->text, s->size, m->text_hash);
  pl_included kept = {pl_copy(a, path), pl_copy(a, from ? from->name : ""), s};
  pl_push(a, m->included, kept);
  return s;
}

// text -> model
pleuel_status pl_pipeline_parse(pleuel_model* m) {
  pl_include_reader hashed = {read_hashed, m};
  m->text_hash = pl_hash_bytes(m->source->text, m->source->size, 0);
  m->parsed = pl_lang_parse(&m->job, m->source, m->reader ? &hashed : NULL, m->settings,
                            m->n_settings, &m->model);
  if (m->model && m->model->lang_given) m->job.lang = m->model->lang;
  pl_diagnostics_sort(&m->diagnostics);
  return m->parsed;
}

// Errors that say: the text is fine, but what it says cannot all be true.
static bool only_contradictions(const pl_diagnostics* d) {
  for (int i = 0; i < d->list.n; i++) {
    pl_code c = d->list.at[i].code;
    bool contradiction = c == PL_E041 || c == PL_E042 || c == PL_E043;
    if (pl_code_severity(c) == PL_ERROR && !contradiction) return false;
  }
  return d->n_errors > 0;
}

// A start violates constraints that contradict each other, whatever the start is: then that is the
// message.
static void find_contradiction(pleuel_model* m) {
  pl_solution* solution = NULL;
  pl_derive(&m->job, m->model, &(pl_derive_options){.structure = true}, &solution);
  pl_solution_close(solution);
  if (pl_diagnostics_have(&m->diagnostics, PL_E042)) pl_diagnostics_drop(&m->diagnostics, PL_E041);
}

// Of a text with errors what can be read: what is wrong with that may follow from what is missing,
// so nothing is reported.
static pleuel_status check_whole_part(pleuel_model* m) {
  pl_diagnostics unheard = {.arena = m->arena};
  m->job.diagnostics = &unheard;
  pleuel_status s = pl_model_check(&m->job, m->model);
  m->job.diagnostics = &m->diagnostics;
  return s == PLEUEL_OK && unheard.n_errors > 0 ? PLEUEL_MODEL_ERROR : s;
}

// model -> checked model
static pleuel_status check(pleuel_model* m) {
  if (m->is_checked) return m->checked;
  m->is_checked = true;
  m->checked = m->parsed;
  bool whole_part = m->tolerant && m->parsed == PLEUEL_MODEL_ERROR && m->model;
  if (whole_part) m->checked = check_whole_part(m);
  if (m->parsed != PLEUEL_OK || !m->model) return m->checked;
  double start = pl_clock();
  pl_api_stage(m->ctx, PLEUEL_STAGE_CHECK);
  m->checked = pl_model_check(&m->job, m->model);
  if (m->checked == PLEUEL_OK && m->diagnostics.n_errors > 0) m->checked = PLEUEL_MODEL_ERROR;
  if (m->checked == PLEUEL_MODEL_ERROR && only_contradictions(&m->diagnostics))
    m->checked = PLEUEL_CONTRADICTION;
  if (m->checked == PLEUEL_CONTRADICTION) find_contradiction(m);
  pl_diagnostics_sort(&m->diagnostics);
  note_time(m, PL_STAGE_CHECK, start);
  return m->checked;
}

pleuel_status pl_pipeline_check(pleuel_model* m) {
  pl_arena* before = work_in(m, m->arena);
  pleuel_status s = check(m);
  m->job.arena = before;
  return s;
}

// checked model -> equations and steps
static pleuel_status derive_here(pleuel_model* m, const char* only, double seconds, bool structure,
                                 bool along) {
  double start = pl_clock();
  pl_editor_forget_solution(m);
  pl_solution_close(m->solution);
  m->solution = NULL;
  m->solved_only = only ? pl_copy(m->arena, only) : NULL;
  m->structure = structure;
  m->start_only = !along;
  pl_derive_options how = {.only = m->solved_only, .seconds = seconds, .structure = structure};
  pl_staging* staging = pl_staging_make(m, along && !only);
  how.n_stages = staging->n;
  how.stages = staging->stages;
  how.stage_from = pl_staging_from;
  how.leaves = pl_staging_leaves;
  how.user = staging;
  how.ready = m->ready;
  how.ready_user = m->ready_user;
  pl_api_stage(m->ctx, PLEUEL_STAGE_DERIVE);
  m->derived = pl_derive(&m->job, m->model, &how, &m->solution);
  m->is_derived = m->derived != PLEUEL_INTERRUPTED;
  pl_diagnostics_sort(&m->diagnostics);
  note_time(m, PL_STAGE_DERIVE, start);
  start = pl_clock();
  if (m->derived == PLEUEL_OK && !structure) pl_api_stage(m->ctx, PLEUEL_STAGE_WITNESS);
  if (m->derived == PLEUEL_OK && !structure)
    pl_witness_hold(&m->job, m->solution, m->solution->stages.at, m->solution->stages.n);
  note_time(m, PL_STAGE_WITNESS, start);
  return m->derived;
}

static pleuel_status derive(pleuel_model* m, const char* only, double seconds, bool structure,
                            bool along) {
  pl_arena* before = work_in(m, m->arena);
  pleuel_status s = derive_here(m, only, seconds, structure, along);
  m->job.arena = before;
  return s;
}

pleuel_status pl_pipeline_derive(pleuel_model* m, const char* only, double seconds, bool along) {
  PL_TRY(pl_pipeline_check(m));
  bool same = m->solved_only == only
              || (only && m->solved_only && strcmp(only, m->solved_only) == 0);
  if (m->is_derived && !m->structure && same && m->start_only == !along) return m->derived;
  return derive(m, only, seconds, false, along);
}

pleuel_status pl_pipeline_structure(pleuel_model* m) {
  PL_TRY(pl_pipeline_check(m));
  return m->is_derived ? m->derived : derive(m, NULL, 0, true, false);
}

// checked model -> setup of the motion: patterns, start values, events. The run that belongs to the
// recording before is forgotten with it.
static pleuel_status record(pleuel_model* m, const char* sensitivities) {
  double start = pl_clock();
  pl_api_stage(m->ctx, PLEUEL_STAGE_RECORD);
  m->result = NULL;
  pl_arena_rewind(m->recorded_in, m->recorded_empty);
  pl_arena* before = work_in(m, m->recorded_in);
  const char* copy = sensitivities ? pl_copy(m->recorded_in, sensitivities) : NULL;
  m->recorded = pl_record(&m->job, m->model, copy, m->exact && !copy, &m->recording);
  if (m->recorded == PLEUEL_OK) m->recording->sensitivities = copy;
  m->job.arena = before;
  note_time(m, PL_STAGE_RECORD, start);
  return m->recorded;
}

pleuel_status pl_pipeline_record(pleuel_model* m) {
  PL_TRY(pl_pipeline_check(m));
  if (m->is_recorded) return m->recorded;
  record(m, NULL);
  m->is_recorded = m->recorded != PLEUEL_INTERRUPTED;
  return m->recorded;
}

// The same with derivatives by parameters and start values, if they are asked for: another setup of
// the same model.
static pleuel_status record_varied(pleuel_model* m, const char* sensitivities) {
  if (m->is_recorded && m->recorded == PLEUEL_OK && m->recording->exact != m->exact)
    m->is_recorded = false;
  bool recorded = m->is_recorded && m->recorded == PLEUEL_OK;
  const char* known = recorded ? m->recording->sensitivities : NULL;
  bool same = known == sensitivities
              || (known && sensitivities && strcmp(known, sensitivities) == 0);
  if (recorded && !same) m->is_recorded = false;
  if (!sensitivities) return pl_pipeline_record(m);
  PL_TRY(pl_pipeline_check(m));
  if (m->is_recorded && same) return m->recorded;
  record(m, sensitivities);
  m->is_recorded = m->recorded == PLEUEL_OK;
  return m->recorded;
}

// ------------------------------------------------------------------------------------------ motion
// Hands the rows on to the functions of the caller.
typedef struct pl_relay {
  const pleuel_sim_options* options;
  pleuel_model* model;
  const pl_setup* setup;
  double* values;  // (n_columns)
  bool stopped;    // the caller wants no more
} pl_relay;

static pleuel_status relay_row(void* user, const pl_row* row) {
  pl_relay* r = user;
  const pl_setup* s = r->setup;
  int n = 0;
  r->values[n++] = row->t;
  for (int i = 0; i < s->n_q; i++) {
    if (!s->coordinates[i].hidden) r->values[n++] = row->q[i];
  }
  for (int i = 0; i < s->n_q; i++) {
    if (!s->coordinates[i].hidden) r->values[n++] = row->v[i];
  }
  for (int i = 0; i < s->n_c; i++) {
    if (s->constraints[i].column)
      r->values[n++] = s->constraints[i].minus ? -row->lambda[i] : row->lambda[i];
  }
  for (int i = 0; i < s->n_out; i++) r->values[n++] = row->out[i];
  if (!r->stopped)
    r->stopped = r->options->row(r->options->user, (size_t)n, r->values, row->mode) != 0;
  return r->stopped ? PLEUEL_INTERRUPTED : PLEUEL_OK;
}

static pleuel_status relay_columns(void* user, const pl_setup* setup) {
  pl_relay* r = user;
  const pl_result* result = r->model->result;
  if (!r->options->columns) return PLEUEL_OK;
  const char** names = PL_ARRAY(r->model->motion, const char*, result->n_columns);
  const char** units = PL_ARRAY(r->model->motion, const char*, result->n_columns);
  for (int i = 0; i < result->n_columns; i++) {
    names[i] = result->columns[i].name;
    units[i] = result->columns[i].unit ? result->columns[i].unit : "";
  }
  int stop = r->options->columns(r->options->user, (size_t)result->n_columns, names, units);
  return stop ? PLEUEL_INTERRUPTED : PLEUEL_OK;
}

// Numbers of a run for the one who looks: pl_interrupted calls it about ten times a second.
static void watch(void* user, double t, double t_end, double h, const pl_stats* stats) {
  pleuel_progress* where = user;
  where->t = t;
  where->t_end = t_end;
  where->step = h;
  where->energy_drift = stats->energy_drift;
  where->steps = stats->steps;
}

// What is proven is proven for the coordinates as declared.
static bool is_turned(const pl_recording* r, const pleuel_sim_options* o) {
  return r->turned && !o->certify;
}

static bool is_wide(const pleuel_sim_options* o) { return o->precision != PLEUEL_PRECISION_DOUBLE; }

// A time as it was written, in three doubles; NULL: it was given as a double.
static const double* exact_time(pleuel_model* m, const char* text) {
  double* part = PL_ARRAY(m->motion, double, 3);
  return text && pl_quantity_parts(m->motion, text, part) == NULL ? part : NULL;
}

// setup -> run with a consistent start.  Without sink: to look at the start only.
static pleuel_status start(pleuel_model* m, const pleuel_sim_options* o, pl_run** out) {
  PL_TRY(record_varied(m, o->sensitivities));
  const pl_recording* r = m->recording;
  bool turned = is_turned(r, o);
  const pl_setup* setup = turned ? &r->turned->setup : &r->setup;
  pl_run_options how = {
      .t_0 = r->t_0, .t_end = r->t_end, .tol = r->tol, .dt = r->dt, .count = r->count};
  pl_sim_options_take(o, &how);
  if (isnan(how.t_end)) how.t_end = how.t_0;
  if (o->has_until && m->exact) how.t_end_exact = exact_time(m, o->until_as_written);
  if (o->has_dt && m->exact) how.dt_exact = exact_time(m, o->dt_as_written);
  if (m->result) {
    how.sink = pl_result_sink(m->result);
    if (m->csv)
      m->result->next = m->keeping && o->resume ? pl_csv_sink_behind(m->motion, m->csv)
                                                : pl_csv_sink(m->motion, m->csv);
    else if (o->csv) m->result->next = pl_csv_sink_to(m->motion, o->csv, o->csv_user);
    else if (o->row) {
      pl_relay* relay = PL_NEW(m->motion, pl_relay);
      *relay = (pl_relay){
          .options = o,
          .model = m,
          .setup = setup,
          .values = PL_ARRAY(m->motion, double, 1 + 2 * setup->n_q + setup->n_c + setup->n_out)};
      m->result->next = (pl_sink){.user = relay, .begin = relay_columns, .row = relay_row};
    }
  }
  pleuel* ctx = m->ctx;
  how.places = &ctx->places;
  how.progress = watch;
  how.progress_user = &ctx->where;
  // a run that goes on starts without a sink: what the start tells has been told
  pl_sink sink = how.sink;
  bool resumes = m->keeping && o->resume;
  if (m->keeping) {
    PL_TRY(pl_keeping_open(m->keeping, o, &how));
    how.keep = pl_keeping_step;
    how.keep_user = m->keeping;
    if (resumes) how.sink = (pl_sink){0};
  }
  pl_api_stage(ctx, PLEUEL_STAGE_RUN);
  ctx->where.t_begin = how.t_0;
  PL_TRY(pl_run_make(&m->job, setup, &how, out));
  pl_recording* plain = NULL;
  if (r->n_directions) PL_TRY(pl_record(&m->job, m->model, NULL, false, &plain));
  pleuel_status s = pl_start_motion(&m->job, r, plain, turned, &how, *out, &m->start);
  if (s == PLEUEL_OK && resumes) {
    s = pl_keeping_resume(m->keeping, *out, &sink);
    if (s != PLEUEL_OK) m->result->rows.n = m->result->events.n = 0;  // nothing was run
  }
  m->tol_raised = pl_run_tol_raised(*out);
  m->tol_used = pl_run_tol(*out);
  if (s == PLEUEL_CONTRADICTION) pl_start_report_trouble(m);
  if (s == PLEUEL_OK && !resumes) pl_start_report_choice(m);
  return s;
}

pleuel_status pl_pipeline_start(pleuel_model* m, const pleuel_sim_options* o, pl_run** out) {
  pl_arena* before = work_in(m, m->motion);
  pleuel_status s = start(m, o, out);
  m->job.arena = before;
  return s;
}

void pl_pipeline_forget_run(pleuel_model* m) {
  pl_arena_rewind(m->motion, m->motion_empty);
  m->result = NULL;
  m->start = (pl_start_report){0};
  m->certified = NULL;
  m->keeping = NULL;
  m->state = m->resume_command = NULL;
}

static pleuel_status check_times(pleuel_model* m, const pleuel_sim_options* o) {
  const pl_recording* r = m->recording;
  if (!o->has_until && isnan(r->t_end)) {
    return pl_fail(
        &m->job, PLEUEL_USAGE,
        "how long? The file has no `simulate` line; give --until, for example --until 10");
  }
  PL_TRY(pl_sim_options_check(&m->job, o));
  if (o->certify && !(o->certify_width >= 0 && o->certify_width < 1e-4)) {
    return pl_fail(&m->job, PLEUEL_USAGE, "the width of an enclosure lies between 0 and 1e-4");
  }
  if (o->state && !o->csv_file && o->csv)
    return pl_fail(&m->job, PLEUEL_USAGE, "a state goes with rows in a file: csv_file");
  if (o->certify && o->resume)
    return pl_fail(&m->job, PLEUEL_USAGE, "a run that goes on from a state cannot be certified");
  return PLEUEL_OK;
}

static bool is_told(const pl_diagnostic* d, const pl_constraint* c) {
  return d->code == PL_N068 && d->span.begin == c->span.begin;
}

// An impact on a contact for which no `restitution` is given was taken as inelastic: said once for
// each, with the request for a law.
static void tell_inelastic(pleuel_model* m) {
  int before = m->diagnostics.list.n;
  for (int i = 0; i < m->result->events.n; i++) {
    const pl_result_event* e = &m->result->events.at[i];
    const pl_constraint* c = e->kind == PL_EV_IMPACT && e->label
                                 ? pl_model_constraint(m->model, e->label)
                                 : NULL;
    if (!c || pl_model_restitution(m->model, c)) continue;
    bool told = false;
    for (int k = 0; k < m->diagnostics.list.n; k++) told |= is_told(&m->diagnostics.list.at[k], c);
    if (told) continue;
    pl_diagnostic* d = pl_report(
        &m->diagnostics, PL_N068, c->span,
        PL_BOTH_FORMAT(m->arena,
                       "%s has no restitution: its impact at t = %.6g s was taken as inelastic",
                       e->label, e->t));
    pl_report_fix(
        d, PL_BOTH_FORMAT(m->arena, "give the law of the impact: restitution 0 on %s", e->label),
        NULL);
  }
  if (m->diagnostics.list.n > before) pl_diagnostics_sort(&m->diagnostics);
}

// setup -> motion
static pleuel_status run_whole(pleuel_model* m, const pleuel_sim_options* o) {
  m->is_run = true;
  pl_pipeline_forget_run(m);
  m->run_message[0] = '\0';
  m->kept = PL_KEPT_NO;
  m->rows_kept = 0;
  m->resumed_at = (double)NAN;
  m->state = o->state ? pl_copy(m->motion, o->state) : NULL;
  m->resume_command = o->resume_command ? pl_copy(m->motion, o->resume_command) : NULL;
  m->exact = is_wide(o);
  m->run = record_varied(m, o->sensitivities);
  if (m->run == PLEUEL_OK) m->run = check_times(m, o);
  if (m->run != PLEUEL_OK) {
    snprintf(m->run_message, sizeof m->run_message, "%s", m->job.message);
    return m->run;
  }
  double start = pl_clock();
  // with all rows: each is compared with its enclosure
  m->result = pl_result_make(m->motion, o->certify);
  m->keeping = pl_keeping_make(m, o);
  pl_run* run = NULL;
  m->run = pl_pipeline_start(m, o, &run);
  if (m->run == PLEUEL_OK) pl_certify_begin(m, o, run);
  if (m->run == PLEUEL_OK) m->run = pl_run_to_end(run);
  if (run) pl_run_free(run);
  m->keeping = NULL;
  tell_inelastic(m);
  if (m->run != PLEUEL_OK) snprintf(m->run_message, sizeof m->run_message, "%s", m->job.message);
  note_time(m, PL_STAGE_RUN, start);
  pleuel_status proved = pl_certify_end_of_run(m, o);
  return m->run == PLEUEL_OK ? proved : m->run;
}

// With the file of rows open.
static pleuel_status run(pleuel_model* m, const pleuel_sim_options* o) {
  m->csv = NULL;
  if (!o->csv_file) return run_whole(m, o);
  m->csv = fopen(o->csv_file, o->resume ? "r+" : "w+");
  if (!m->csv) return pl_fail(&m->job, PLEUEL_FILE, "%s: %s", o->csv_file, strerror(errno));
  pleuel_status s = run_whole(m, o);
  bool bad = fclose(m->csv) != 0;
  m->csv = NULL;
  if (!bad || s != PLEUEL_OK) return s;
  return pl_fail(&m->job, PLEUEL_FILE, "%s: %s", o->csv_file, strerror(errno));
}

pleuel_status pl_pipeline_run(pleuel_model* m, const pleuel_sim_options* o) {
  pl_arena* before = work_in(m, m->motion);
  pleuel_status s = run(m, o);
  m->job.arena = before;
  return s;
}
