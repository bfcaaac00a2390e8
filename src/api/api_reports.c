// What is made of a model: check, worked solution, LaTeX, pages, pictures, motion.  Each public
// function takes the steps of the pipeline that it needs and hands out a text or a status.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "api/api_impl.h"
#include "pleuel.h"

// --------------------------------------------------------------------------------------- check
typedef struct pl_asking {
  const pleuel_text_options* text;
  const pleuel_solve_options* solve;
  const pleuel_tex_options* tex;
  const char* answer;
  const char* word;
  pleuel_spelling spelling;
} pl_asking;

// Looks for the start, where the model has enough numbers for it.
static pleuel_status look_at_start(pleuel_model* m) {
  if (!m->model->simulate.given && m->model->inits.n == 0) return PLEUEL_OK;
  PLEUEL_OPTIONS(pleuel_sim_options, how);
  pl_run* run = NULL;
  pl_pipeline_forget_run(m);
  m->run = pl_pipeline_start(m, &how, &run);
  if (run) {
    m->result = pl_result_make(m->motion, false);
    m->result->stats = *pl_run_stats(run);
    pl_run_free(run);
  }
  // that numbers are missing is no fault of the model; that they contradict each other is
  if (m->run == PLEUEL_CONTRADICTION || m->run == PLEUEL_SINGULAR || m->run == PLEUEL_INTERRUPTED)
    return m->run;
  snprintf(m->run_message, sizeof m->run_message, "%s", m->job.message);
  m->job.message[0] = '\0';
  return PLEUEL_OK;
}

static pleuel_status check(pleuel_model* m) {
  PL_TRY(pl_pipeline_structure(m));
  return look_at_start(m);
}

static pleuel_status check_text(pleuel_model* m, void* argument) {
  pl_asking* a = argument;
  pleuel_status s = check(m);
  pl_text out = pl_text_make(m->work);
  if (s == PLEUEL_OK) pl_check_summary(&out, m, pl_api_language_of(m, a->text->lang));
  a->answer = pl_text_string(&out);
  return s;
}

static pleuel_status check_json(pleuel_model* m, void* argument) {
  pl_asking* a = argument;
  pleuel_status s = check(m);
  pl_text out = pl_text_make(m->work);
  pl_json_input in = {.file = m->name,
                      .model = m->model,
                      .solution = m->solution,
                      .diagnostics = &m->diagnostics,
                      .status = s,
                      .message = m->job.message,
                      .lang = pl_api_language(a->text->lang, m->job.lang)};
  pl_worked_json(&out, &in);
  a->answer = pl_text_string(&out);
  return s;
}

static pleuel_status ask_text(pleuel_model* m, const char** text,
                              const pleuel_text_options* options, pl_api_work* work) {
  if (text) *text = NULL;
  if (!m) return PLEUEL_USAGE;
  pleuel_text_options o;
  PL_TRY(pl_api_take(m->ctx, &o, sizeof o, options));
  pl_asking a = {.text = &o};
  pleuel_status s = pl_api_worked(m, work, &a);
  if (text) *text = a.answer;
  return s;
}

pleuel_status pleuel_check(pleuel_model* m, const char** summary,
                           const pleuel_text_options* options) {
  return ask_text(m, summary, options, check_text);
}

pleuel_status pleuel_check_json(pleuel_model* m, const char** json,
                                const pleuel_text_options* options) {
  return ask_text(m, json, options, check_json);
}

// --------------------------------------------------------------------------------------- solve
// The language of a solution: what was asked for, else the file's, else the context's.

// Simulation that the file asks for; a big family is left to `sim`.
enum { MAX_COORDINATES_IN_SOLUTION = 60 };

static void simulate_for_solution(pleuel_model* m, const pleuel_solve_options* o) {
  m->is_run = false;
  m->result = NULL;
  if (o->no_simulation || !m->model->simulate.given) return;
  int n = pl_model_flat_coords(m->model, m->work).n;
  if (n > MAX_COORDINATES_IN_SOLUTION) {
    m->is_run = true;
    m->run = PLEUEL_UNSUPPORTED;
    snprintf(m->run_message, sizeof m->run_message,
             m->job.lang == PL_GERMAN ? pl_german("%d coordinates are a matter for pleuel sim")
                                      : "%d coordinates are a matter for pleuel sim",
             n);
    return;
  }
  PLEUEL_OPTIONS(pleuel_sim_options, how);
  char sentence[sizeof m->job.message];
  memcpy(sentence, m->job.message, sizeof sentence);
  pl_pipeline_run(m, &how);
  memcpy(m->job.message, sentence, sizeof sentence);
}

static bool any_not_found(const pl_solution* s) {
  for (int i = 0; i < s->sections.n; i++) {
    if (s->sections.at[i].not_found) return true;
  }
  return false;
}

static bool all_passed(const pl_solution* s) {
  for (int i = 0; i < s->checks.n; i++) {
    if (!s->checks.at[i].passed) return false;
  }
  return !s->expect_failed;
}

// The verdict on a solution: what went wrong first counts.
static pleuel_status verdict(pleuel_model* m, pleuel_status derived) {
  if (derived != PLEUEL_OK) return derived;
  if (m->is_run && m->run != PLEUEL_OK && m->run != PLEUEL_UNSUPPORTED && m->run != PLEUEL_USAGE) {
    pl_fail(&m->job, m->run, "%s", m->run_message);
    return m->run;
  }
  if (m->solution && !all_passed(m->solution)) {
    return pl_fail(&m->job, PLEUEL_EXPECT_FAILED,
                   m->solution->expect_failed ? "an `expect` of the model is false"
                                              : "a check of the solution failed");
  }
  if (m->solution && any_not_found(m->solution)) {
    return pl_fail(&m->job, PLEUEL_NO_CLOSED_FORM,
                   "a closed form that was asked for was not found");
  }
  return PLEUEL_OK;
}

static pl_math math_of(pleuel_math m) {
  return m == PLEUEL_MATH_2D ? PL_MATH_2D : m == PLEUEL_MATH_ASCII ? PL_MATH_ASCII : PL_MATH_LINE;
}

// The solution does not hang on the start values, but a start that contradicts the constraints has
// to be said. That several positions fit, or that numbers are missing, matters to the motion alone.
static pleuel_status contradictory_start(pleuel_model* m) {
  if (m->is_run || pl_model_flat_coords(m->model, m->work).n > MAX_COORDINATES_IN_SOLUTION)
    return PLEUEL_OK;
  char sentence[sizeof m->job.message];
  memcpy(sentence, m->job.message, sizeof sentence);
  bool reported = m->start_reported;
  m->start_reported = true;  // said below, if at all
  pleuel_status s = look_at_start(m);
  m->start_reported = reported;
  if (s == PLEUEL_CONTRADICTION && m->start.trouble == PL_START_VIOLATED) {
    pl_start_report_trouble(m);
    return s;
  }
  memcpy(m->job.message, sentence, sizeof sentence);
  return PLEUEL_OK;
}

static pleuel_status solve_text(pleuel_model* m, void* argument) {
  pl_asking* a = argument;
  const pleuel_solve_options* o = a->solve;
  pleuel_status s = pl_pipeline_derive(m, o->only, o->seconds, !o->no_simulation);
  if (!m->solution) return s;
  simulate_for_solution(m, o);
  if (s == PLEUEL_OK) s = contradictory_start(m);
  pl_worked_style style = {.math = math_of(o->math),
                           .lang = pl_api_language_of(m, o->lang),
                           .colour = o->colour,
                           .full = o->full,
                           .width = o->width,
                           .only = o->only};
  pl_text motion = pl_text_make(m->work);
  if (m->is_run) pl_motion_text(&motion, m, style.lang, style.math == PL_MATH_ASCII, false);
  if (m->is_run) style.motion = pl_text_string(&motion);
  pl_text out = pl_text_make(m->work);
  pl_worked_text(&out, m->solution, &m->diagnostics, &style);
  a->answer = pl_text_string(&out);
  return verdict(m, s);
}

// The lines of a JSON value one level further in.
static const char* indented(pl_arena* a, const char* json) {
  pl_text out = pl_text_make(a);
  for (const char* c = json; *c; c++) {
    pl_text_add_n(&out, c, 1);
    if (*c == '\n') pl_text_pad(&out, 2);
  }
  return pl_text_string(&out);
}

static pleuel_status solve_json(pleuel_model* m, void* argument) {
  pl_asking* a = argument;
  const pleuel_solve_options* o = a->solve;
  static const char* const stages[] = {"check", "derive", "witness", "record", "simulate"};
  pleuel_status s = pl_pipeline_derive(m, o->only, o->seconds, !o->no_simulation);
  if (m->solution) simulate_for_solution(m, o);
  if (m->solution && s == PLEUEL_OK) s = contradictory_start(m);
  pl_text simulation = pl_text_make(m->work);
  if (m->is_run) pl_motion_json(&simulation, m);
  s = verdict(m, s);
  pl_json_input in = {
      .file = m->name,
      .model = m->model,
      .solution = m->solution,
      .diagnostics = &m->diagnostics,
      .status = s,
      .message = m->job.message,
      .lang = pl_api_language_of(m, o->lang),
      .only = o->only,
      .simulation = m->is_run ? indented(m->work, pl_text_string(&simulation)) : NULL,
      .n_timing = o->timing ? PL_N_STAGES : 0,
      .timing_name = stages,
      .timing_ms = m->stage_ms};
  pl_text out = pl_text_make(m->work);
  pl_worked_json(&out, &in);
  a->answer = pl_text_string(&out);
  return s;
}

static pleuel_status ask_solution(pleuel_model* m, const char** text,
                                  const pleuel_solve_options* options, pl_api_work* work) {
  if (text) *text = NULL;
  if (!m) return PLEUEL_USAGE;
  pleuel_solve_options o;
  PL_TRY(pl_api_take(m->ctx, &o, sizeof o, options));
  if ((unsigned)o.math > PLEUEL_MATH_ASCII || o.width < 0)
    return pl_api_fail(m->ctx, PLEUEL_USAGE, "unknown manner of writing formulas");
  pl_asking a = {.solve = &o};
  pleuel_status s = pl_api_worked(m, work, &a);
  if (text) *text = a.answer;
  return s;
}

pleuel_status pleuel_solve_text(pleuel_model* m, const char** text,
                                const pleuel_solve_options* options) {
  return ask_solution(m, text, options, solve_text);
}

pleuel_status pleuel_solve_json(pleuel_model* m, const char** json,
                                const pleuel_solve_options* options) {
  return ask_solution(m, json, options, solve_json);
}

static pleuel_status export(pleuel_model* m, void* argument) {
  pl_asking* a = argument;
  pl_export_input in = {.file = m->name, .only = a->solve->only};
  if (!pl_export_target_find(a->word, &in.target)) {
    return pl_fail(&m->job, PLEUEL_USAGE,
                   "there is no export to `%s`: sympy, mathematica, maxima, julia, python, json",
                   a->word);
  }
  pleuel_status s = pl_pipeline_derive(m, a->solve->only, a->solve->seconds, false);
  if (!m->solution || s != PLEUEL_OK) return s;
  in.solution = m->solution;
  pl_text out = pl_text_make(m->work);
  pl_export(&out, &in);
  a->answer = pl_text_string(&out);
  bool is_run = m->is_run;
  m->is_run = false;  // a motion of before has no say in this
  s = verdict(m, s);
  m->is_run = is_run;
  return s;
}

pleuel_status pleuel_export(pleuel_model* m, const char** text, const char* target,
                            const pleuel_solve_options* options) {
  if (text) *text = NULL;
  if (!m || !target) return PLEUEL_USAGE;
  pleuel_solve_options o;
  PL_TRY(pl_api_take(m->ctx, &o, sizeof o, options));
  pl_asking a = {.solve = &o, .word = target};
  pleuel_status s = pl_api_worked(m, export, &a);
  if (text) *text = a.answer;
  return s;
}

// --------------------------------------------------------------------------------------- LaTeX
static pleuel_status tex(pleuel_model* m, void* argument) {
  pl_asking* a = argument;
  const pleuel_tex_options* o = a->tex;
  pleuel_status s = pl_pipeline_derive(m, o->only, o->seconds, !o->no_simulation);
  if (!m->solution) return s;
  pl_tex_style style = {.lang = pl_api_language_of(m, o->lang),
                        .standalone = o->standalone,
                        .plain = o->plain,
                        .full = o->full,
                        .only = o->only,
                        .name = m->name};
  if (!o->no_figure) style.scene = pl_picture_scene(m, style.lang);
  PLEUEL_OPTIONS(pleuel_solve_options, how);
  how.no_simulation = o->no_simulation;
  simulate_for_solution(m, &how);
  pl_text motion = pl_text_make(m->work);
  if (m->is_run) pl_motion_text(&motion, m, style.lang, false, false);
  if (m->is_run) style.motion = pl_text_string(&motion);
  pl_text out = pl_text_make(m->work);
  pl_tex(&out, m->solution, &m->diagnostics, &style);
  a->answer = pl_text_string(&out);
  return verdict(m, s);
}

pleuel_status pleuel_tex(pleuel_model* m, const char** text, const pleuel_tex_options* options) {
  if (text) *text = NULL;
  if (!m) return PLEUEL_USAGE;
  pleuel_tex_options o;
  PL_TRY(pl_api_take(m->ctx, &o, sizeof o, options));
  pl_asking a = {.tex = &o};
  pleuel_status s = pl_api_worked(m, tex, &a);
  if (text) *text = a.answer;
  return s;
}

// -------------------------------------------------------------------------------------- report
typedef struct pl_reporting {
  const pleuel_report_options* options;
  const char* html;
} pl_reporting;

static pleuel_status report(pleuel_model* m, void* argument) {
  pl_reporting* r = argument;
  pleuel_status s = pl_pipeline_derive(m, r->options->only, r->options->seconds, true);
  if (!m->solution) return s;
  PL_TRY(pl_report_page(m, pl_api_language_of(m, r->options->lang), r->options, &r->html));
  return verdict(m, s);
}

pleuel_status pleuel_report(pleuel_model* m, const char** html,
                            const pleuel_report_options* options) {
  if (html) *html = NULL;
  if (!m) return PLEUEL_USAGE;
  pleuel_report_options o;
  PL_TRY(pl_api_take(m->ctx, &o, sizeof o, options));
  if ((unsigned)o.data > PLEUEL_DATA_FULL)
    return pl_api_fail(m->ctx, PLEUEL_USAGE, "data of a report: thin, none or full");
  pl_reporting r = {&o, NULL};
  pleuel_status s = pl_api_worked(m, report, &r);
  if (html) *html = r.html;
  return s;
}

// ------------------------------------------------------------------------------------ pictures
enum { LARGEST_PICTURE = 8192 };
static bool size_fits(int width, int height) {
  return width >= 0 && height >= 0 && width <= LARGEST_PICTURE && height <= LARGEST_PICTURE
         && (width == 0 || width >= 64) && (height == 0 || height >= 64);
}

typedef struct pl_picturing {
  const pleuel_plot_options* plot;
  const pleuel_animate_options* animate;
  const char* bytes;
  size_t n;
} pl_picturing;

static pleuel_status plot(pleuel_model* m, void* argument) {
  pl_picturing* p = argument;
  return pl_picture_plot(m, pl_api_language_of(m, p->plot->lang), p->plot, &p->bytes, &p->n);
}

pleuel_status pleuel_plot(pleuel_model* m, const char** bytes, size_t* n,
                          const pleuel_plot_options* options) {
  if (bytes) *bytes = NULL;
  if (n) *n = 0;
  if (!m || !bytes || !n) return PLEUEL_USAGE;
  pleuel_plot_options o;
  PL_TRY(pl_api_take(m->ctx, &o, sizeof o, options));
  if (!size_fits(o.width, o.height) || (unsigned)o.style > PLEUEL_FOR_PRINT
      || (unsigned)o.format > PLEUEL_PDF || (unsigned)o.panels > PLEUEL_PANELS_DRAWING) {
    return pl_api_fail(m->ctx, PLEUEL_USAGE,
                       "a plot is SVG, PNG or PDF, at most 8192 pixels wide and high");
  }
  pl_picturing p = {.plot = &o};
  pleuel_status s = pl_api_worked(m, plot, &p);
  *bytes = p.bytes;
  *n = p.n;
  return s;
}

static pleuel_status animate(pleuel_model* m, void* argument) {
  pl_picturing* p = argument;
  return pl_picture_animate(m, pl_api_language_of(m, p->animate->lang), p->animate, &p->bytes,
                            &p->n);
}

pleuel_status pleuel_animate(pleuel_model* m, const char** bytes, size_t* n,
                             const pleuel_animate_options* options) {
  if (bytes) *bytes = NULL;
  if (n) *n = 0;
  if (!m || !bytes || !n) return PLEUEL_USAGE;
  pleuel_animate_options o;
  PL_TRY(pl_api_take(m->ctx, &o, sizeof o, options));
  if (!size_fits(o.width, o.height) || (unsigned)o.style > PLEUEL_FOR_PRINT || o.fps < 0
      || o.fps > 100 || o.seconds < 0 || (o.format != PLEUEL_SVG && o.format != PLEUEL_GIF)) {
    return pl_api_fail(
        m->ctx, PLEUEL_USAGE,
        "an animation is SVG or GIF, at most 8192 pixels wide and high, at most 100 frames "
        "per second");
  }
  pl_picturing p = {.animate = &o};
  pleuel_status s = pl_api_worked(m, animate, &p);
  *bytes = p.bytes;
  *n = p.n;
  return s;
}

// ------------------------------------------------------------------------------------ simulate
static pleuel_status simulate(pleuel_model* m, void* argument) {
  const pleuel_sim_options* o = argument;
  pleuel_status s = pl_pipeline_run(m, o);
  pl_diagnostics_sort(&m->diagnostics);
  return s;
}

static void sum_up(const pleuel_model* m, pleuel_status s, pleuel_summary* out) {
  const pl_result* r = m->broken ? NULL : m->result;
  *out = (pleuel_summary){.status = s, .t_end = (double)NAN, .energy_drift = (double)NAN};
  if (!r) return;
  out->t_end = r->rows.n ? r->rows.at[r->rows.n - 1][0] : (double)NAN;
  out->steps = r->stats.steps;
  out->rejected = r->stats.rejections;
  out->residual_g = r->stats.max_g;
  out->residual_gdot = r->stats.max_gdot;
  out->energy_drift = r->stats.energy_drift;
  out->n_events = (size_t)r->events.n;
  out->n_columns = (size_t)r->n_columns;
  out->n_rows = (size_t)r->n_rows;
  out->rows_kept = (size_t)m->rows_kept;
}

pleuel_status pleuel_simulate(pleuel_model* m, pleuel_summary* summary,
                              const pleuel_sim_options* options) {
  if (!m) return PLEUEL_USAGE;
  if (summary && summary->size == 0)
    return pl_api_fail(m->ctx, PLEUEL_USAGE,
                       "options without their size: declare them with PLEUEL_OPTIONS");
  pleuel_sim_options o;
  PL_TRY(pl_api_take(m->ctx, &o, sizeof o, options));
  pleuel_status s = pl_api_worked(m, simulate, &o);
  if (!summary) return s;
  pleuel_summary all;
  sum_up(m, s, &all);
  all.size = summary->size;
  pl_api_give(summary, &all, sizeof all);
  return s;
}

static pleuel_status simulation_text(pleuel_model* m, void* argument) {
  pl_asking* a = argument;
  pl_text out = pl_text_make(m->work);
  if (m->is_run)
    pl_motion_text(&out, m, pl_api_language_of(m, a->text->lang), false, a->text->terse);
  a->answer = pl_text_string(&out);
  return PLEUEL_OK;
}

static pleuel_status simulation_engine(pleuel_model* m, void* argument) {
  pl_asking* a = argument;
  pl_text out = pl_text_make(m->work);
  if (m->is_run) pl_engine_text(&out, m, pl_api_language_of(m, a->text->lang));
  a->answer = pl_text_string(&out);
  return PLEUEL_OK;
}

static pleuel_status simulation_json(pleuel_model* m, void* argument) {
  pl_asking* a = argument;
  pl_text out = pl_text_make(m->work);
  pl_motion_json(&out, m);
  pl_text_add(&out, "\n");
  a->answer = pl_text_string(&out);
  return PLEUEL_OK;
}

// Telling about a run keeps the sentence of the run.
static const char* tell_run(pleuel_model* m, const pleuel_text_options* options,
                            pl_api_work* work) {
  if (!m) return NULL;
  char sentence[sizeof m->ctx->message];
  memcpy(sentence, m->ctx->message, sizeof sentence);
  const char* text = NULL;
  ask_text(m, &text, options, work);
  if (!m->broken) memcpy(m->ctx->message, sentence, sizeof sentence);
  return text;
}

const char* pleuel_simulation_text(pleuel_model* m, const pleuel_text_options* options) {
  return tell_run(m, options, simulation_text);
}

const char* pleuel_simulation_engine(pleuel_model* m, const pleuel_text_options* options) {
  return tell_run(m, options, simulation_engine);
}

const char* pleuel_simulation_json(pleuel_model* m) { return tell_run(m, NULL, simulation_json); }

// -------------------------------------------------------------------------------- format, dump
static pleuel_status format(pleuel_model* m, void* argument) {
  pl_asking* a = argument;
  if (m->parsed != PLEUEL_OK) return m->parsed;
  static const pl_spelling spelling[] = {PL_SPELL_KEEP, PL_SPELL_UNICODE, PL_SPELL_ASCII};
  return pl_lang_format(&m->job, m->source, spelling[a->spelling], &a->answer);
}

pleuel_status pleuel_format(pleuel_model* m, const char** text, pleuel_spelling spelling) {
  if (text) *text = NULL;
  if (!m || (unsigned)spelling > PLEUEL_SPELL_ASCII) return PLEUEL_USAGE;
  pl_asking a = {.spelling = spelling};
  pleuel_status s = pl_api_worked(m, format, &a);
  if (text && s == PLEUEL_OK) *text = a.answer;
  return s;
}

static pleuel_status dump(pleuel_model* m, void* argument) {
  pl_asking* a = argument;
  pl_text out = pl_text_make(m->work);
  pleuel_status s;
  if (strcmp(a->word, "check") == 0) {
    s = pl_pipeline_check(m);
    if (m->model) pl_model_dump(&out, m->model);
  } else if (strcmp(a->word, "derive") == 0) {
    s = pl_pipeline_derive(m, NULL, 0, false);
    if (m->solution) pl_derive_dump(&out, m->solution);
  } else if (strcmp(a->word, "record") == 0) {
    s = pl_pipeline_record(m);
    if (s == PLEUEL_OK) pl_record_dump(&out, m->model, m->recording);
  } else {
    return pl_fail(&m->job, PLEUEL_USAGE, "there is no arrow `%s`: check, derive, record", a->word);
  }
  a->answer = pl_text_string(&out);
  return s;
}

pleuel_status pleuel_dump(pleuel_model* m, const char** text, const char* after) {
  if (text) *text = NULL;
  if (!m || !after) return PLEUEL_USAGE;
  pl_asking a = {.word = after};
  pleuel_status s = pl_api_worked(m, dump, &a);
  if (text) *text = a.answer;
  return s;
}
