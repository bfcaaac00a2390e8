// Systems, runs and results as a program meets them: through pleuel.h only.
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "pleuel.h"

static const char pendulum[] =
    "system \"Pendulum\"\n"
    "param m = 1 [kg], l = 1/2 [m], g = 9.81 [m/s^2], k = m g/l\n"
    "coord x, y\n"
    "axes x right, y up\n"
    "mass m at (x, y)\n"
    "gravity g along -y\n"
    "constraint rod: x^2 + y^2 = l^2   with λ\n"
    "init x = 0.6 l, x' = 0\n"
    "branch y < 0\n"
    "simulate 0..1 [s]\n";

static const char ball[] =
    "param m = 1 [kg], g = 9.81 [m/s^2], e = 0.5\n"
    "coord z\n"
    "axes z up\n"
    "mass m at (z)\n"
    "gravity g along -z\n"
    "constraint floor: z >= 0\n"
    "restitution e on floor\n"
    "init z = 1 [m], z' = 0\n"
    "simulate 0..1 [s]\n";

static const char cart[] =
    "param m = 2 [kg]\n"
    "input F [N]\n"
    "coord x\n"
    "axes x right\n"
    "mass A: m at (x)\n"
    "force F on A\n"
    "init x = 0 [m], x' = 0\n"
    "simulate 0..1 [s]\n";

typedef struct bench {
  pleuel* ctx;
  pleuel_model* model;
  pleuel_system* system;
  pleuel_run* run;
} bench;

static void open_bench(bench* b, const char* text, const pleuel_sim_options* o) {
  *b = (bench){.ctx = pleuel_open(NULL)};
  pleuel_status s = pleuel_load_text(b->ctx, &b->model, text, strlen(text), NULL);
  if (s == PLEUEL_OK) s = pleuel_system_make(b->model, &b->system, o);
  if (s == PLEUEL_OK) s = pleuel_run_open(b->system, &b->run, NULL);
  if (s != PLEUEL_OK) fail_msg("%s: %s", pleuel_status_name(s), pleuel_message(b->ctx));
}

static void close_bench(bench* b) {
  pleuel_run_close(b->run);
  pleuel_system_free(b->system);
  pleuel_close(b->ctx);
}

static void fine(const bench* b, pleuel_status s) {
  if (s != PLEUEL_OK) fail_msg("%s: %s", pleuel_status_name(s), pleuel_run_message(b->run));
}

static double number(const bench* b, const char* name) {
  double x = NAN;
  fine(b, pleuel_run_get(b->run, name, &x));
  return x;
}

// ---------------------------------------------------------------------------------------- numbers
static void a_number_that_is_set_takes_along_what_depends_on_it(void** state) {
  (void)state;
  bench b;
  open_bench(&b, pendulum, NULL);
  fine(&b, pleuel_run_start(b.run));
  assert_true(fabs(number(&b, "x") - 0.3) < 1e-15 && fabs(number(&b, "y") + 0.4) < 1e-15);
  fine(&b, pleuel_run_set(b.run, "l", 1));
  fine(&b, pleuel_run_start(b.run));
  assert_true(fabs(number(&b, "x") - 0.6) < 1e-15 && fabs(number(&b, "y") + 0.8) < 1e-15);
  assert_true(number(&b, "l") == 1);
  fine(&b, pleuel_run_set(b.run, "x", 0.8));
  fine(&b, pleuel_run_start(b.run));
  assert_true(fabs(number(&b, "y") + 0.6) < 1e-15);
  pleuel_run_reset(b.run);
  fine(&b, pleuel_run_start(b.run));
  assert_true(fabs(number(&b, "x") - 0.3) < 1e-15);
  close_bench(&b);
}

// The same motion as with settings, bit for bit.
static void set_numbers_give_the_motion_of_settings(void** state) {
  (void)state;
  bench b;
  open_bench(&b, pendulum, NULL);
  fine(&b, pleuel_run_set(b.run, "l", 0.75));
  fine(&b, pleuel_run_start(b.run));
  fine(&b, pleuel_run_advance(b.run, 1, 0));
  double mine[4], its[4];
  fine(&b, pleuel_run_state(b.run, mine, mine + 2, NULL, NULL));
  PLEUEL_OPTIONS(pleuel_load_options, how);
  pleuel_setting set[] = {{"l", "0.75"}};
  how.settings = set;
  how.n_settings = 1;
  pleuel_model* other = NULL;
  pleuel_system* system = NULL;
  pleuel_run* run = NULL;
  assert_int_equal(pleuel_load_text(b.ctx, &other, pendulum, strlen(pendulum), &how), PLEUEL_OK);
  assert_int_equal(pleuel_system_make(other, &system, NULL), PLEUEL_OK);
  pleuel_model_free(other);  // the system lives on
  assert_int_equal(pleuel_run_open(system, &run, NULL), PLEUEL_OK);
  pleuel_system_free(system);
  assert_int_equal(pleuel_run_start(run), PLEUEL_OK);
  assert_int_equal(pleuel_run_advance(run, 1, 0), PLEUEL_OK);
  assert_int_equal(pleuel_run_state(run, its, its + 2, NULL, NULL), PLEUEL_OK);
  assert_memory_equal(mine, its, sizeof mine);
  pleuel_run_close(run);
  close_bench(&b);
}

static void what_cannot_be_set_is_said(void** state) {
  (void)state;
  bench b;
  open_bench(&b, pendulum, NULL);
  assert_int_equal(pleuel_run_set(b.run, "q", 1), PLEUEL_USAGE);
  assert_non_null(strstr(pleuel_run_message(b.run), "q"));
  assert_int_equal(pleuel_run_set(b.run, "l", (double)NAN), PLEUEL_USAGE);
  assert_int_equal(pleuel_run_advance(b.run, 1, 0), PLEUEL_USAGE);  // not started
  fine(&b, pleuel_run_set(b.run, "l", -1));
  assert_int_equal(pleuel_run_start(b.run), PLEUEL_USAGE);
  assert_non_null(strstr(pleuel_run_message(b.run), "positive"));
  fine(&b, pleuel_run_set(b.run, "l", 1));
  fine(&b, pleuel_run_set(b.run, "x", 2));  // farther than the rod is long
  assert_int_equal(pleuel_run_start(b.run), PLEUEL_CONTRADICTION);
  close_bench(&b);
  static const char chain[] =
      "param N = 3\ncoord x[1..N]\nfor i in 1..N { mass 1 at (x[i])\n init x[i] = i }\n"
      "simulate 0..1\n";
  open_bench(&b, chain, NULL);
  assert_int_equal(pleuel_run_set(b.run, "N", 4), PLEUEL_USAGE);
  assert_non_null(strstr(pleuel_run_message(b.run), "how large"));
  close_bench(&b);
}

static void families_take_start_values_from_each_other(void** state) {
  (void)state;
  bench b;
  static const char chain[] =
      "param N = 4, d = 2\ncoord x[1..N]\nfor i in 1..N { mass 1 at (x[i]) }\n"
      "init x[1] = d\nfor i in 2..N { init x[i] = x[i-1] + d }\nsimulate 0..1\n";
  open_bench(&b, chain, NULL);
  fine(&b, pleuel_run_set(b.run, "d", 5));
  fine(&b, pleuel_run_start(b.run));
  assert_true(number(&b, "x[4]") == 20);
  close_bench(&b);
}

// --------------------------------------------------------------------------------------- forward
static void a_run_stops_at_times_and_events(void** state) {
  (void)state;
  bench b;
  open_bench(&b, ball, NULL);
  fine(&b, pleuel_run_start(b.run));
  fine(&b, pleuel_run_advance(b.run, 0.1, 1));
  assert_true(pleuel_run_time(b.run) == 0.1);
  assert_true(fabs(number(&b, "z") - (1 - 0.5 * 9.81 * 0.01)) < 1e-15);
  PLEUEL_OPTIONS(pleuel_event, e);
  assert_int_equal(pleuel_run_event(b.run, &e), PLEUEL_USAGE);
  fine(&b, pleuel_run_advance(b.run, 1, 1));
  double t = sqrt(2 / 9.81);
  assert_true(fabs(pleuel_run_time(b.run) - t) < 1e-15);
  fine(&b, pleuel_run_event(b.run, &e));
  assert_int_equal(e.kind, PLEUEL_EVENT_IMPACT);
  assert_string_equal(e.label, "floor");
  assert_true(e.jump && fabs(e.impulse - 1.5 * 9.81 * t) < 1e-13);
  assert_true(fabs(number(&b, "z_dot") - 0.5 * 9.81 * t) < 1e-13);
  assert_int_equal(pleuel_run_advance(b.run, 0.2, 0), PLEUEL_USAGE);  // that time has passed
  fine(&b, pleuel_run_advance(b.run, 7, 0));
  assert_true(pleuel_run_time(b.run) == 1 && pleuel_run_done(b.run));
  // the coefficient is a number like any other
  fine(&b, pleuel_run_set(b.run, "e", 1));
  fine(&b, pleuel_run_start(b.run));
  fine(&b, pleuel_run_advance(b.run, 2 * t, 0));
  assert_true(fabs(number(&b, "z") - 1) < 1e-13);
  close_bench(&b);
}

static void states_between_steps_join_them(void** state) {
  (void)state;
  bench b;
  open_bench(&b, pendulum, NULL);
  fine(&b, pleuel_run_start(b.run));
  double q[2], v[2], a[2], lambda, q_end[2], a_end[2], lambda_end;
  for (int i = 0; i < 5; i++) {
    double from = pleuel_run_time(b.run);
    fine(&b, pleuel_run_step(b.run));
    double to = pleuel_run_time(b.run);
    fine(&b, pleuel_run_state(b.run, q_end, NULL, a_end, &lambda_end));
    fine(&b, pleuel_run_dense(b.run, to, q, v, a, &lambda));
    assert_true(fabs(q[0] - q_end[0]) < 1e-15 && fabs(a[1] - a_end[1]) < 1e-11);
    assert_true(fabs(lambda - lambda_end) < 1e-11);
    fine(&b, pleuel_run_dense(b.run, 0.5 * (from + to), q, v, NULL, NULL));
    assert_true(fabs(q[0] * q[0] + q[1] * q[1] - 0.25) < 1e-14);
    assert_true(fabs(q[0] * v[0] + q[1] * v[1]) < 1e-13);
    assert_int_equal(pleuel_run_dense(b.run, to + 1, q, v, NULL, NULL), PLEUEL_USAGE);
  }
  close_bench(&b);
}

static void rows_at_given_times_fill_the_callers_block(void** state) {
  (void)state;
  bench b;
  PLEUEL_OPTIONS(pleuel_sim_options, how);
  how.has_dt = 1;
  how.dt = 0.125;
  open_bench(&b, pendulum, &how);
  pleuel_result* result = NULL;
  fine(&b, pleuel_run_complete(b.run, &result));
  PLEUEL_OPTIONS(pleuel_summary, s);
  assert_int_equal(pleuel_result_summary(result, &s), PLEUEL_OK);
  assert_true(s.n_rows_stored == 9 && s.t_end == 1 && s.residual_g < 1e-14);
  double t[9], block[9 * 16];
  for (int i = 0; i < 9; i++) t[i] = 0.125 * i;
  fine(&b, pleuel_run_start(b.run));
  fine(&b, pleuel_run_sample(b.run, t, 5, block, 16));
  fine(&b, pleuel_run_sample(b.run, t + 5, 4, block + 5 * 16, 16));
  assert_int_equal(pleuel_run_sample(b.run, t, 2, block, 1), PLEUEL_USAGE);
  for (size_t i = 0; i < s.n_columns; i++) {
    PLEUEL_OPTIONS(pleuel_column, c);
    assert_int_equal(pleuel_result_column(result, i, &c), PLEUEL_OK);
    assert_true(c.n == 9);
    for (size_t k = 0; k < 9; k++) {
      double off = fabs(c.at[k * c.stride] - block[k * 16 + i]);
      if (!(off <= 1e-12 * (1 + fabs(block[k * 16 + i]))))
        fail_msg("%s, row %zu: %.17g, %.17g", c.name, k, c.at[k * c.stride], block[k * 16 + i]);
    }
  }
  pleuel_result_free(result);
  close_bench(&b);
}

static void a_result_has_columns_with_names_and_units(void** state) {
  (void)state;
  bench b;
  open_bench(&b, pendulum, NULL);
  pleuel_result* result = NULL;
  fine(&b, pleuel_run_complete(b.run, &result));
  close_bench(&b);  // the result lives on
  PLEUEL_OPTIONS(pleuel_column, c);
  long i = pleuel_result_find(result, "x_dot");
  assert_true(i > 0);
  assert_int_equal(pleuel_result_column(result, (size_t)i, &c), PLEUEL_OK);
  assert_string_equal(c.shown, "x'");
  assert_string_equal(c.unit, "m/s");
  assert_int_equal(c.kind, PLEUEL_KIND_VELOCITY);
  i = pleuel_result_find(result, "λ");
  assert_int_equal(pleuel_result_column(result, (size_t)i, &c), PLEUEL_OK);
  assert_int_equal(c.kind, PLEUEL_KIND_MULTIPLIER);
  assert_true(c.at[0] != 0);
  assert_true(pleuel_result_find(result, "nothing") == -1);
  pleuel_column none = {0};
  assert_int_equal(pleuel_result_column(result, 0, &none), PLEUEL_USAGE);
  pleuel_result_free(result);
}

// -------------------------------------------------------------------------------------- elsewhere
static void a_state_is_set_and_asked_about(void** state) {
  (void)state;
  bench b;
  open_bench(&b, pendulum, NULL);
  fine(&b, pleuel_run_start(b.run));
  double q[] = {0.4, -0.3}, v[] = {0.3, 0.4}, a[2], lambda, got[2];
  fine(&b, pleuel_run_rhs(b.run, 0, q, v, a, &lambda));
  // along the rod: a·r = -v²; m a = m g + 2 λ r
  double l2 = 0.25, v2 = 0.25;
  double expected = (-v2 + 9.81 * q[1]) / (2 * l2);
  assert_true(fabs(lambda - expected) < 1e-13);
  assert_true(fabs(a[0] - 2 * lambda * q[0]) < 1e-13);
  assert_true(fabs(number(&b, "x") - 0.3) < 1e-15);  // the motion was not touched
  fine(&b, pleuel_run_set_state(b.run, 0.25, q, v));
  assert_true(pleuel_run_time(b.run) == 0.25);
  fine(&b, pleuel_run_state(b.run, got, NULL, NULL, NULL));
  assert_true(got[0] == 0.4 && got[1] == -0.3);
  fine(&b, pleuel_run_advance(b.run, 1, 0));
  fine(&b, pleuel_run_state(b.run, got, NULL, NULL, NULL));
  assert_true(fabs(got[0] * got[0] + got[1] * got[1] - 0.25) < 1e-14);
  close_bench(&b);
}

static void the_linearisation_of_an_oscillator_is_exact(void** state) {
  (void)state;
  static const char text[] =
      "param m = 2, k = 8, c = 3, l = 1\ninput F\ncoord x\naxes x right\nmass A: m at (x)\n"
      "potential k/2 x^2 + k/4 x^4\nforce -c x' + F on A\ninit x = 0.5, x' = 0.25\nsimulate "
      "0..1\n";
  bench b;
  open_bench(&b, text, NULL);
  fine(&b, pleuel_run_start(b.run));
  double a_q, a_v, a_u;
  fine(&b, pleuel_run_linearise(b.run, &a_q, &a_v, &a_u));
  assert_true(fabs(a_q + 8 * (1 + 3 * 0.25) / 2) < 1e-10);
  assert_true(fabs(a_v + 1.5) < 1e-10);
  assert_true(fabs(a_u - 0.5) < 1e-10);
  close_bench(&b);
}

static int bang(void* user, pleuel_run* run, double t, double* u) {
  (void)run;
  ++*(int*)user;
  u[0] = t < 0.499 ? 1 : -1;
  return 0;
}

static void inputs_are_held_from_sample_to_sample(void** state) {
  (void)state;
  bench b;
  int calls = 0;
  open_bench(&b, cart, NULL);
  assert_true(pleuel_system_count(b.system, PLEUEL_KIND_INPUT) == 1);
  fine(&b, pleuel_run_set(b.run, "F", 4));
  fine(&b, pleuel_run_start(b.run));
  fine(&b, pleuel_run_advance(b.run, 0.5, 0));
  assert_true(fabs(number(&b, "x") - 0.25) < 1e-15);
  fine(&b, pleuel_run_set(b.run, "F", 0));  // at once
  fine(&b, pleuel_run_advance(b.run, 1, 0));
  assert_true(fabs(number(&b, "x") - 0.75) < 1e-15);
  fine(&b, pleuel_run_input(b.run, bang, &calls, 0.25));
  fine(&b, pleuel_run_start(b.run));
  fine(&b, pleuel_run_advance(b.run, 1, 0));
  assert_int_equal(calls, 4);
  assert_true(fabs(number(&b, "x") - 0.125) < 1e-14 && fabs(number(&b, "x_dot")) < 1e-14);
  close_bench(&b);
}

static void a_saved_run_goes_on_bit_for_bit(void** state) {
  (void)state;
  bench b;
  pleuel_run* other = NULL;
  open_bench(&b, ball, NULL);
  fine(&b, pleuel_run_start(b.run));
  for (int i = 0; i < 3; i++) fine(&b, pleuel_run_step(b.run));
  size_t n = 0, few = 8;
  fine(&b, pleuel_run_save(b.run, NULL, &n));
  unsigned char* bytes = malloc(n);
  assert_int_equal(pleuel_run_save(b.run, bytes, &few), PLEUEL_USAGE);
  fine(&b, pleuel_run_save(b.run, bytes, &n));
  assert_int_equal(pleuel_run_open(b.system, &other, NULL), PLEUEL_OK);
  assert_int_equal(pleuel_run_restore(other, bytes, n), PLEUEL_OK);
  double x[2], y[2];
  while (!pleuel_run_done(b.run)) {
    fine(&b, pleuel_run_step(b.run));
    assert_int_equal(pleuel_run_step(other), PLEUEL_OK);
    fine(&b, pleuel_run_state(b.run, x, x + 1, NULL, NULL));
    assert_int_equal(pleuel_run_state(other, y, y + 1, NULL, NULL), PLEUEL_OK);
    assert_memory_equal(x, y, sizeof x);
    assert_true(pleuel_run_time(b.run) == pleuel_run_time(other));
  }
  bytes[0] ^= 1;
  assert_int_equal(pleuel_run_restore(other, bytes, n), PLEUEL_FILE);
  bytes[0] ^= 1;
  assert_int_equal(pleuel_run_set(other, "e", 0.25), PLEUEL_OK);
  assert_int_equal(pleuel_run_restore(other, bytes, n), PLEUEL_FILE);
  free(bytes);
  pleuel_run_close(other);
  close_bench(&b);
}

static void structures_without_size_are_refused(void** state) {
  (void)state;
  bench b;
  open_bench(&b, pendulum, NULL);
  pleuel_sim_options o = {0};
  pleuel_summary s = {0};
  pleuel_run* run = NULL;
  pleuel_system* system = NULL;
  o.has_until = 1;
  o.until = 1;
  assert_int_equal(pleuel_system_make(b.model, &system, &o), PLEUEL_USAGE);
  assert_int_equal(pleuel_run_open(b.system, &run, &o), PLEUEL_USAGE);
  pleuel_result* result = NULL;
  fine(&b, pleuel_run_complete(b.run, &result));
  assert_int_equal(pleuel_result_summary(result, &s), PLEUEL_USAGE);
  pleuel_result_free(result);
  close_bench(&b);
}

// ---------------------------------------------------------------------------------------- threads
enum { RUNS = 1000, THREADS = 2 };
typedef struct share {
  pleuel_system* system;
  int first;
  double* x;  // (RUNS)
  int failed;
} share;

static void* run_share(void* argument) {
  share* s = argument;
  pleuel_run* run = NULL;
  if (pleuel_run_open(s->system, &run, NULL) != PLEUEL_OK) s->failed++;
  for (int i = s->first; i < RUNS && run; i += THREADS) {
    pleuel_status status = pleuel_run_set(run, "l", 0.25 + 0.001 * i);
    if (status == PLEUEL_OK) status = pleuel_run_start(run);
    if (status == PLEUEL_OK) status = pleuel_run_advance(run, 0.3, 0);
    if (status == PLEUEL_OK) status = pleuel_run_get(run, "x", &s->x[i]);
    s->failed += status != PLEUEL_OK;
  }
  pleuel_run_close(run);
  return NULL;
}

// While the model is worked with in its own thread.
static void a_system_is_shared_between_threads(void** state) {
  (void)state;
  bench b;
  static double x[RUNS];
  open_bench(&b, pendulum, NULL);
  share part[THREADS];
  pthread_t thread[THREADS];
  for (int k = 0; k < THREADS; k++) {
    part[k] = (share){b.system, k, x, 0};
    assert_int_equal(pthread_create(&thread[k], NULL, run_share, &part[k]), 0);
  }
  const char* text = NULL;
  assert_int_equal(pleuel_solve_text(b.model, &text, NULL), PLEUEL_OK);
  for (int k = 0; k < THREADS; k++) pthread_join(thread[k], NULL);
  for (int k = 0; k < THREADS; k++) assert_int_equal(part[k].failed, 0);
  for (int i = 0; i < RUNS; i += 97) {
    double alone;
    fine(&b, pleuel_run_set(b.run, "l", 0.25 + 0.001 * i));
    fine(&b, pleuel_run_start(b.run));
    fine(&b, pleuel_run_advance(b.run, 0.3, 0));
    fine(&b, pleuel_run_get(b.run, "x", &alone));
    assert_true(alone == x[i]);
  }
  close_bench(&b);
}

static void an_interrupted_run_can_go_on(void** state) {
  (void)state;
  bench b;
  open_bench(&b, pendulum, NULL);
  fine(&b, pleuel_run_start(b.run));
  pleuel_run_interrupt(b.run);
  assert_int_equal(pleuel_run_advance(b.run, 1, 0), PLEUEL_INTERRUPTED);
  pleuel_run_interrupt_clear(b.run);
  fine(&b, pleuel_run_advance(b.run, 1, 0));
  close_bench(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_number_that_is_set_takes_along_what_depends_on_it),
      cmocka_unit_test(set_numbers_give_the_motion_of_settings),
      cmocka_unit_test(what_cannot_be_set_is_said),
      cmocka_unit_test(families_take_start_values_from_each_other),
      cmocka_unit_test(a_run_stops_at_times_and_events),
      cmocka_unit_test(states_between_steps_join_them),
      cmocka_unit_test(rows_at_given_times_fill_the_callers_block),
      cmocka_unit_test(a_result_has_columns_with_names_and_units),
      cmocka_unit_test(a_state_is_set_and_asked_about),
      cmocka_unit_test(the_linearisation_of_an_oscillator_is_exact),
      cmocka_unit_test(inputs_are_held_from_sample_to_sample),
      cmocka_unit_test(a_saved_run_goes_on_bit_for_bit),
      cmocka_unit_test(structures_without_size_are_refused),
      cmocka_unit_test(a_system_is_shared_between_threads),
      cmocka_unit_test(an_interrupted_run_can_go_on),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
