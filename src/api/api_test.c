// The public interface as a program that embeds the library meets it: through pleuel.h only.
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdbool.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "pleuel.h"

static const char pendulum[] =
    "system \"Pendulum\"\n"
    "param m = 1 [kg], l = 1/2 [m], g = 9.81 [m/s^2]\n"
    "coord x, y\n"
    "axes x right, y up\n"
    "mass m at (x, y)\n"
    "gravity g along -y\n"
    "constraint rod: x^2 + y^2 = l^2\n"
    "init x = 0.3 [m], x' = 0\n"
    "branch y < 0\n"
    "ask dof, lagrange1\n"
    "simulate 0..1 [s]\n";

static pleuel_model* load(pleuel* ctx, const char* text, pleuel_status expected) {
  pleuel_model* m = NULL;
  assert_int_equal(pleuel_load_text(ctx, &m, text, strlen(text), NULL), expected);
  return m;
}

static void a_model_is_loaded_checked_and_solved(void** state) {
  (void)state;
  pleuel* ctx = pleuel_open(NULL);
  pleuel_model* m = load(ctx, pendulum, PLEUEL_OK);
  const char* text = NULL;
  assert_int_equal(pleuel_check(m, &text, NULL), PLEUEL_OK);
  assert_non_null(strstr(text, "1 degree of freedom"));
  assert_int_equal(pleuel_solve_text(m, &text, NULL), PLEUEL_OK);
  assert_non_null(strstr(text, "Pendulum"));
  assert_int_equal(pleuel_solve_json(m, &text, NULL), PLEUEL_OK);
  assert_non_null(strstr(text, "\"status\": \"ok\""));
  assert_string_equal(pleuel_message(ctx), "");
  pleuel_close(ctx);
}

static void errors_of_a_text_are_diagnostics(void** state) {
  (void)state;
  pleuel* ctx = pleuel_open(NULL);
  pleuel_model* m = load(ctx, "coord x\nmass m at (y)\n", PLEUEL_MODEL_ERROR);
  assert_non_null(m);
  assert_true(pleuel_diagnostic_count(m, PLEUEL_ERROR) >= 1);
  PLEUEL_OPTIONS(pleuel_text_options, how);
  how.terse = 1;
  const char* text = pleuel_diagnostics_text(m, 1u << PLEUEL_ERROR, &how);
  assert_non_null(strstr(text, "<text>:2:"));
  assert_int_equal(pleuel_solve_text(m, &text, NULL), PLEUEL_MODEL_ERROR);
  pleuel_close(ctx);
}

static void a_missing_file_is_a_status_with_a_sentence(void** state) {
  (void)state;
  pleuel* ctx = pleuel_open(NULL);
  pleuel_model* m = NULL;
  assert_int_equal(pleuel_load_file(ctx, &m, "/nowhere/at all.pleuel", NULL), PLEUEL_FILE);
  assert_null(m);
  assert_non_null(strstr(pleuel_message(ctx), "/nowhere/at all.pleuel"));
  pleuel_close(ctx);
}

static void arguments_without_sense_are_refused(void** state) {
  (void)state;
  pleuel* ctx = pleuel_open(NULL);
  pleuel_model* m = NULL;
  const char* text;
  assert_int_equal(pleuel_load_text(NULL, &m, "", 0, NULL), PLEUEL_USAGE);
  assert_int_equal(pleuel_load_text(ctx, &m, NULL, 0, NULL), PLEUEL_USAGE);
  assert_int_equal(pleuel_check(NULL, &text, NULL), PLEUEL_USAGE);
  assert_int_equal(pleuel_set_language(ctx, "fr"), PLEUEL_USAGE);
  m = load(ctx, pendulum, PLEUEL_OK);
  assert_int_equal(pleuel_dump(m, &text, "lunch"), PLEUEL_USAGE);
  PLEUEL_OPTIONS(pleuel_sim_options, how);
  how.has_tol = 1;
  how.tol = -1;
  assert_int_equal(pleuel_simulate(m, NULL, &how), PLEUEL_USAGE);
  pleuel_model_free(NULL);
  pleuel_close(ctx);
  pleuel_close(NULL);
}

static void settings_replace_parameters(void** state) {
  (void)state;
  pleuel* ctx = pleuel_open(NULL);
  PLEUEL_OPTIONS(pleuel_load_options, how);
  pleuel_setting set[] = {{"l", "100[cm]"}};
  how.settings = set;
  how.n_settings = 1;
  pleuel_model* m = NULL;
  assert_int_equal(pleuel_load_text(ctx, &m, pendulum, strlen(pendulum), &how), PLEUEL_OK);
  const char* text;
  assert_int_equal(pleuel_dump(m, &text, "record"), PLEUEL_OK);
  assert_int_equal(pleuel_check(m, &text, NULL), PLEUEL_OK);
  assert_non_null(strstr(text, "y = -0.953939"));  // -sqrt(1 - 0.09)
  pleuel_close(ctx);
}

// ------------------------------------------------------------------------------------ includes
typedef struct reading {
  int calls;
  const char* text;
} reading;
static const char* read_include(void* user, const char* path, const char* from) {
  (void)from;
  reading* r = user;
  r->calls++;
  return strcmp(path, "masses.pleuel") == 0 ? r->text : NULL;
}

static void includes_come_from_the_caller(void** state) {
  (void)state;
  pleuel* ctx = pleuel_open(NULL);
  reading r = {0, "param m = 2 [kg]\n"};
  PLEUEL_OPTIONS(pleuel_load_options, how);
  how.read = read_include;
  how.read_user = &r;
  const char* text = "include \"masses.pleuel\"\ncoord x\nmass m at (x)\n";
  pleuel_model* m = NULL;
  assert_int_equal(pleuel_load_text(ctx, &m, text, strlen(text), &how), PLEUEL_OK);
  assert_int_equal(r.calls, 1);
  const char* without = "include \"masses.pleuel\"\ncoord x\nmass 1 at (x)\n";
  assert_int_equal(pleuel_load_text(ctx, &m, without, strlen(without), NULL), PLEUEL_MODEL_ERROR);
  pleuel_close(ctx);
}

// ---------------------------------------------------------------------------------- simulation
typedef struct rows {
  size_t n_columns, E;
  long n;
  double first, last, energy;
  int stop_after;
} rows;

static int take_row(void* user, size_t n, const double* values, const char* mode) {
  rows* r = user;
  if (r->n_columns == 0) r->n_columns = n;
  r->E = 8;  // of this model
  assert_true(n == r->n_columns);
  assert_non_null(mode);
  if (r->n++ == 0) {
    r->first = values[0];
    r->energy = values[r->E];
  }
  r->last = values[0];
  assert_true(fabs(values[r->E] - r->energy) < 1e-13);
  return r->stop_after && r->n >= r->stop_after;
}

static void rows_reach_the_caller(void** state) {
  (void)state;
  pleuel* ctx = pleuel_open(NULL);
  pleuel_model* m = load(ctx, pendulum, PLEUEL_OK);
  rows r = {0};
  PLEUEL_OPTIONS(pleuel_sim_options, how);
  how.has_dt = 1;
  how.dt = 0.125;
  how.row = take_row;
  how.user = &r;
  PLEUEL_OPTIONS(pleuel_summary, s);
  assert_int_equal(pleuel_simulate(m, &s, &how), PLEUEL_OK);
  assert_true(r.n == 9 && r.first == 0 && r.last == 1 && s.t_end == 1);
  assert_true(s.residual_g < 1e-14 && s.energy_drift < 1e-13);
  assert_non_null(strstr(pleuel_simulation_json(m), "\"t_end\": 1"));
  assert_non_null(strstr(pleuel_simulation_text(m, NULL), "simulated"));
  pleuel_close(ctx);
}

static void a_row_may_stop_the_run(void** state) {
  (void)state;
  pleuel* ctx = pleuel_open(NULL);
  pleuel_model* m = load(ctx, pendulum, PLEUEL_OK);
  rows r = {.stop_after = 3};
  PLEUEL_OPTIONS(pleuel_sim_options, how);
  how.has_dt = 1;
  how.dt = 0.125;
  how.row = take_row;
  how.user = &r;
  assert_int_equal(pleuel_simulate(m, NULL, &how), PLEUEL_INTERRUPTED);
  assert_true(r.n == 3);
  pleuel_close(ctx);
}

// ----------------------------------------------------------------------------------- written out
typedef struct written {
  char* at;
  size_t n;
  long stop_after;  // calls; 0: never
} written;

static int take_bytes(void* user, const void* bytes, size_t n) {
  written* w = user;
  if (w->stop_after && --w->stop_after == 0) return 1;
  w->at = realloc(w->at, w->n + n);
  memcpy(w->at + w->n, bytes, n);
  w->n += n;
  return 0;
}

static void the_same_run_gives_the_same_bytes(void** state) {
  (void)state;
  written w[2] = {{0}};
  for (int i = 0; i < 2; i++) {
    pleuel* ctx = pleuel_open(NULL);
    pleuel_model* m = load(ctx, pendulum, PLEUEL_OK);
    PLEUEL_OPTIONS(pleuel_sim_options, how);
    how.csv = take_bytes;
    how.csv_user = &w[i];
    assert_int_equal(pleuel_simulate(m, NULL, &how), PLEUEL_OK);
    pleuel_close(ctx);
  }
  assert_true(w[0].n == w[1].n && memcmp(w[0].at, w[1].at, w[0].n) == 0);
  assert_int_equal(strncmp(w[0].at, "t [s],x [m],y [m],", 18), 0);
  free(w[0].at);
  free(w[1].at);
}

static void bytes_that_are_not_taken_are_a_status(void** state) {
  (void)state;
  pleuel* ctx = pleuel_open(NULL);
  pleuel_model* m = load(ctx, pendulum, PLEUEL_OK);
  written w = {.stop_after = 1};
  PLEUEL_OPTIONS(pleuel_sim_options, how);
  how.has_dt = 1;
  how.dt = 1e-4;
  how.csv = take_bytes;
  how.csv_user = &w;
  assert_int_equal(pleuel_simulate(m, NULL, &how), PLEUEL_FILE);
  pleuel_close(ctx);
}

// ------------------------------------------------------------------------------ progress and poll
typedef struct asked {
  int calls, stop_at;
  unsigned stages;  // seen
} asked;

static int on_progress(void* user, const pleuel_progress* where) {
  asked* a = user;
  assert_true(where->size == sizeof *where);
  a->stages |= 1u << where->stage;
  return ++a->calls == a->stop_at;
}

static int on_poll(void* user) {
  asked* a = user;
  return ++a->calls == a->stop_at;
}

static void progress_is_told_of_every_stage_and_may_stop_each(void** state) {
  (void)state;
  asked all = {0};
  pleuel* ctx = pleuel_open(NULL);
  pleuel_set_progress(ctx, on_progress, &all);
  const char* text;
  assert_int_equal(pleuel_solve_text(load(ctx, pendulum, PLEUEL_OK), &text, NULL), PLEUEL_OK);
  unsigned expected = 1u << PLEUEL_STAGE_CHECK | 1u << PLEUEL_STAGE_DERIVE
                      | 1u << PLEUEL_STAGE_WITNESS | 1u << PLEUEL_STAGE_RECORD
                      | 1u << PLEUEL_STAGE_RUN;
  assert_int_equal(all.stages, expected);
  // a run is stopped by either
  asked one = {.stop_at = 1};
  pleuel_model* m = load(ctx, pendulum, PLEUEL_OK);
  assert_int_equal(pleuel_check(m, &text, NULL), PLEUEL_OK);
  pleuel_set_progress(ctx, on_progress, &one);
  assert_int_equal(pleuel_simulate(m, NULL, NULL), PLEUEL_INTERRUPTED);
  pleuel_set_progress(ctx, NULL, NULL);
  asked poll = {.stop_at = 1};
  pleuel_set_poll(ctx, on_poll, &poll);
  assert_int_equal(pleuel_simulate(m, NULL, NULL), PLEUEL_INTERRUPTED);
  // the wish of a poll ends with the call
  assert_int_equal(pleuel_simulate(m, NULL, NULL), PLEUEL_OK);
  pleuel_close(ctx);
}

static void options_without_their_size_are_refused(void** state) {
  (void)state;
  pleuel* ctx = pleuel_open(NULL);
  pleuel_model* m = load(ctx, pendulum, PLEUEL_OK);
  const char* text;
  pleuel_sim_options sim = {.has_until = 1, .until = 1};
  assert_int_equal(pleuel_simulate(m, NULL, &sim), PLEUEL_USAGE);
  assert_non_null(strstr(pleuel_message(ctx), "PLEUEL_OPTIONS"));
  pleuel_solve_options solve = {.full = 1};
  assert_int_equal(pleuel_solve_text(m, &text, &solve), PLEUEL_USAGE);
  pleuel_text_options how = {.terse = 1};
  assert_int_equal(pleuel_check(m, &text, &how), PLEUEL_USAGE);
  assert_null(pleuel_diagnostics_text(m, 7, &how));
  pleuel_load_options load_how = {.name = "x"};
  pleuel_model* none = NULL;
  assert_int_equal(pleuel_load_text(ctx, &none, pendulum, strlen(pendulum), &load_how),
                   PLEUEL_USAGE);
  pleuel_summary summary = {0};
  assert_int_equal(pleuel_simulate(m, &summary, NULL), PLEUEL_USAGE);
  pleuel_close(ctx);
}

// ---------------------------------------------------------------------------------- repeated work
static long resident_kb(void) {
  long size = 0, resident = 0;
  FILE* f = fopen("/proc/self/statm", "r");
  if (!f) return -1;
  int n = fscanf(f, "%ld %ld", &size, &resident);
  fclose(f);
  return n == 2 ? resident * (sysconf(_SC_PAGESIZE) / 1024) : -1;
}

static void repeated_work_takes_no_more_memory(void** state) {
  (void)state;
  pleuel* ctx = pleuel_open(NULL);
  pleuel_model* m = load(ctx, pendulum, PLEUEL_OK);
  const char* text;
  long after_some = 0;
  for (int i = 0; i < 220; i++) {
    assert_int_equal(pleuel_simulate(m, NULL, NULL), PLEUEL_OK);
    assert_non_null(pleuel_simulation_json(m));
    assert_int_equal(pleuel_solve_text(m, &text, NULL), PLEUEL_OK);
    if (i == 20) after_some = resident_kb();
  }
  if (after_some > 0) assert_true(resident_kb() <= after_some + after_some / 100);
  pleuel_close(ctx);
}

static void an_interrupted_context_stops_and_can_go_on(void** state) {
  (void)state;
  pleuel* ctx = pleuel_open(NULL);
  pleuel_model* m = load(ctx, pendulum, PLEUEL_OK);
  pleuel_interrupt(ctx);
  assert_int_equal(pleuel_simulate(m, NULL, NULL), PLEUEL_INTERRUPTED);
  pleuel_interrupt_clear(ctx);
  assert_int_equal(pleuel_simulate(m, NULL, NULL), PLEUEL_OK);
  pleuel_close(ctx);
}

// -------------------------------------------------------------------------------------- memory
// An allocator that fails at the n-th call and counts what is out.
typedef struct hostile {
  long calls, fail_at, out;
} hostile;
static void* hostile_take(void* user, size_t size) {
  hostile* h = user;
  if (++h->calls >= h->fail_at) return NULL;
  h->out++;
  return malloc(size);
}
static void hostile_give(void* user, void* block) {
  hostile* h = user;
  if (block) h->out--;
  free(block);
}

// All numbers of all rows, and a wish to stop after some of them.
typedef struct pl_collected {
  double x[20000];
  size_t n, width;
  pleuel* ctx;
  long stop_at;
} pl_collected;

static int collect(void* user, size_t n, const double* values, const char* mode) {
  pl_collected* c = user;
  (void)mode;
  c->width = n;
  for (size_t i = 0; i < n && c->n < 20000; i++) c->x[c->n++] = values[i];
  if (c->stop_at > 0 && (long)(c->n / n) >= c->stop_at) pleuel_interrupt(c->ctx);
  return 0;
}

static void an_interrupted_run_goes_on_in_another_context(void** state) {
  (void)state;
  static pl_collected all, parts;
  char file[] = "/tmp/pleuel-state-XXXXXX";
  int fd = mkstemp(file);
  assert_true(fd >= 0);
  close(fd);
  PLEUEL_OPTIONS(pleuel_sim_options, how);
  how.dt = 0.01;
  how.has_dt = 1;
  how.row = collect;
  all = parts = (pl_collected){0};
  pleuel* ctx = pleuel_open(NULL);
  how.user = &all;
  assert_int_equal(pleuel_simulate(load(ctx, pendulum, PLEUEL_OK), NULL, &how), PLEUEL_OK);
  pleuel_close(ctx);
  how.user = &parts;
  how.state = file;
  how.state_every = -1;
  pleuel_status s = PLEUEL_INTERRUPTED;
  for (long stop = 2; s == PLEUEL_INTERRUPTED && stop < 40; stop += 2) {
    ctx = parts.ctx = pleuel_open(NULL);
    parts.stop_at = stop;
    PLEUEL_OPTIONS(pleuel_summary, summary);
    s = pleuel_simulate(load(ctx, pendulum, PLEUEL_OK), &summary, &how);
    assert_true(s == PLEUEL_OK || strstr(pleuel_message(ctx), "interrupted"));
    // the row of the interruption is not one of those that stay
    if (s == PLEUEL_INTERRUPTED) parts.n = summary.rows_kept * parts.width;
    how.resume = 1;
    pleuel_close(ctx);
  }
  assert_int_equal(s, PLEUEL_OK);
  assert_true(parts.stop_at > 4);
  assert_int_equal(parts.n, all.n);
  assert_memory_equal(parts.x, all.x, all.n * sizeof(double));
  remove(file);
}

static void memory_that_runs_out_is_a_status(void** state) {
  (void)state;
  bool done = false;
  for (long n = 1; !done && n < 400; n++) {
    hostile h = {.fail_at = n};
    pleuel_allocator alloc = {hostile_take, hostile_give, &h};
    pleuel* ctx = pleuel_open(&alloc);
    if (ctx) {
      pleuel_model* m = NULL;
      const char* text = NULL;
      pleuel_status s = pleuel_load_text(ctx, &m, pendulum, strlen(pendulum), NULL);
      if (s == PLEUEL_OK) s = pleuel_simulate(m, NULL, NULL);
      if (s == PLEUEL_OK) s = pleuel_solve_json(m, &text, NULL);
      done = s == PLEUEL_OK;
      if (!done) {
        assert_int_equal(s, PLEUEL_NO_MEMORY);
        assert_true(*pleuel_message(ctx) != '\0');
      }
      pleuel_close(ctx);
    }
    assert_int_equal(h.out, 0);
  }
  assert_true(done);
}

static void a_memory_limit_is_kept(void** state) {
  (void)state;
  pleuel* ctx = pleuel_open(NULL);
  pleuel_set_memory_limit(ctx, 300000);
  static const char many[] =
      "param N = 100000\ncoord x[1..N]\nfor i in 1..N {\n  mass 1 at (x[i])\n  init x[i] = "
      "i\n}\nsimulate 0..1\n";
  pleuel_model* m = NULL;
  pleuel_status s = pleuel_load_text(ctx, &m, many, strlen(many), NULL);
  if (s == PLEUEL_OK) s = pleuel_simulate(m, NULL, NULL);
  assert_int_equal(s, PLEUEL_NO_MEMORY);
  pleuel_close(ctx);
}

// ----------------------------------------------------------------------------- without a model
static void quantities_carry_units(void** state) {
  (void)state;
  pleuel* ctx = pleuel_open(NULL);
  double x = 0;
  assert_int_equal(pleuel_quantity(ctx, &x, "500[ms]"), PLEUEL_OK);
  assert_true(x == 0.5);
  assert_int_equal(pleuel_quantity(ctx, &x, "-2.5e-1 [m]"), PLEUEL_OK);
  assert_true(x == -0.25);
  assert_int_equal(pleuel_quantity(ctx, &x, "1e-3"), PLEUEL_OK);
  assert_true(x == 1e-3);
  static const char* const wrong[] = {"",     "-",          "soon", "5 s", "5[",
                                      "5[]x", "5[furlong]", "nan",  "[s]", "1e999999999"};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    x = 7;
    if (pleuel_quantity(ctx, &x, wrong[i]) != PLEUEL_USAGE)
      fail_msg("`%s` was read as %g", wrong[i], x);
    assert_true(*pleuel_message(ctx) != '\0');
  }
  pleuel_close(ctx);
}

static void every_example_is_built_in_and_checks(void** state) {
  (void)state;
  pleuel* ctx = pleuel_open(NULL);
  const char *name = NULL, *text;
  size_t n = 0;
  for (; (text = pleuel_example(n, &name)) != NULL; n++) {
    pleuel_model* m = NULL;
    const char* summary = NULL;
    pleuel_status s = pleuel_load_text(ctx, &m, text, strlen(text), NULL);
    if (s == PLEUEL_OK) s = pleuel_check(m, &summary, NULL);
    if (s != PLEUEL_OK)
      fail_msg("%s: %s %s", name, pleuel_message(ctx), pleuel_diagnostics_text(m, 7, NULL));
    pleuel_model_free(m);
  }
  assert_true(n >= 8);
  pleuel_close(ctx);
}

static void contexts_do_not_know_of_each_other(void** state) {
  (void)state;
  pleuel *a = pleuel_open(NULL), *b = pleuel_open(NULL);
  pleuel_model *m = load(a, pendulum, PLEUEL_OK), *n = load(b, pendulum, PLEUEL_OK);
  const char *x, *y;
  assert_int_equal(pleuel_solve_json(m, &x, NULL), PLEUEL_OK);
  pleuel_model* other = load(b, "coord z\nmass 1 at (z)\n", PLEUEL_OK);
  assert_non_null(other);
  assert_int_equal(pleuel_solve_json(n, &y, NULL), PLEUEL_OK);
  assert_string_equal(x, y);
  pleuel_close(a);
  pleuel_close(b);
}

// ------------------------------------------------------------------------------------- threads
enum { N_THREADS = 4 };
typedef struct job {
  const char* text;
  char* answer;
} job;

static void* solve_in_thread(void* argument) {
  job* j = argument;
  pleuel* ctx = pleuel_open(NULL);
  pleuel_model* m = NULL;
  const char* json = NULL;
  if (pleuel_load_text(ctx, &m, j->text, strlen(j->text), NULL) == PLEUEL_OK)
    pleuel_solve_json(m, &json, NULL);
  j->answer = strdup(json ? json : "");
  pleuel_close(ctx);
  pleuel_thread_end();
  return NULL;
}

static void threads_with_their_own_contexts_agree(void** state) {
  (void)state;
  const char* name = NULL;
  for (size_t i = 0; i < 3; i++) {
    job jobs[N_THREADS];
    pthread_t thread[N_THREADS];
    for (int k = 0; k < N_THREADS; k++) {
      jobs[k] = (job){pleuel_example(i, &name), NULL};
      assert_int_equal(pthread_create(&thread[k], NULL, solve_in_thread, &jobs[k]), 0);
    }
    for (int k = 0; k < N_THREADS; k++) pthread_join(thread[k], NULL);
    for (int k = 0; k < N_THREADS; k++) {
      assert_string_equal(jobs[k].answer, jobs[0].answer);
      assert_true(strlen(jobs[k].answer) > 1000);
    }
    for (int k = 0; k < N_THREADS; k++) free(jobs[k].answer);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_model_is_loaded_checked_and_solved),
      cmocka_unit_test(errors_of_a_text_are_diagnostics),
      cmocka_unit_test(a_missing_file_is_a_status_with_a_sentence),
      cmocka_unit_test(arguments_without_sense_are_refused),
      cmocka_unit_test(settings_replace_parameters),
      cmocka_unit_test(includes_come_from_the_caller),
      cmocka_unit_test(rows_reach_the_caller),
      cmocka_unit_test(a_row_may_stop_the_run),
      cmocka_unit_test(the_same_run_gives_the_same_bytes),
      cmocka_unit_test(bytes_that_are_not_taken_are_a_status),
      cmocka_unit_test(progress_is_told_of_every_stage_and_may_stop_each),
      cmocka_unit_test(options_without_their_size_are_refused),
      cmocka_unit_test(repeated_work_takes_no_more_memory),
      cmocka_unit_test(an_interrupted_context_stops_and_can_go_on),
      cmocka_unit_test(an_interrupted_run_goes_on_in_another_context),
      cmocka_unit_test(memory_that_runs_out_is_a_status),
      cmocka_unit_test(a_memory_limit_is_kept),
      cmocka_unit_test(quantities_carry_units),
      cmocka_unit_test(every_example_is_built_in_and_checks),
      cmocka_unit_test(contexts_do_not_know_of_each_other),
      cmocka_unit_test(threads_with_their_own_contexts_agree),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
