// Traces of small motions whose phases are known.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "api/api_impl.h"
#include "witness/trace.h"

typedef struct bench {
  pleuel* ctx;
  pleuel_model* m;
  pl_trace* trace;
} bench;

static bench traced(const char* text, const pl_trace_options* how) {
  bench b = {.ctx = pleuel_open(NULL)};
  assert_int_equal(pleuel_load_text(b.ctx, &b.m, text, strlen(text), NULL), PLEUEL_OK);
  pleuel_check(b.m, &(const char*){NULL}, NULL);  // also of models whose start does not fit
  pl_model* numbered = pl_trace_model(&b.m->job, b.m->model, 1);
  assert_non_null(numbered);
  b.trace = pl_trace_make(&b.m->job, numbered, how);
  return b;
}

static const pl_trace_phase* phase(const bench* b, int k) { return &b->trace->phases.at[k]; }
static const pl_trace_sample* sample(const bench* b, int k) { return &b->trace->samples.at[k]; }

static const char ball[] =
    "param m = 1 [kg], g = 9.81 [m/s^2]\n"
    "coord y\n"
    "axes y up\n"
    "mass m at (y)\n"
    "gravity g along -y\n"
    "constraint floor: y >= 0\n"
    "restitution 0 on floor\n"
    "init y = 2 [m], y' = 0\n"
    "simulate 0..1 [s]\n";

static void a_contact_that_the_start_leaves_open_is_open(void** state) {
  (void)state;
  bench b = traced(ball, NULL);
  assert_int_equal(b.trace->status, PLEUEL_OK);
  assert_true(b.trace->whole);
  assert_int_equal(b.trace->phases.n, 2);
  assert_false(pl_trace_holds(b.trace, phase(&b, 0), 0));
  assert_true(pl_trace_holds(b.trace, phase(&b, 1), 0));
  assert_string_equal(phase(&b, 1)->begun_label, "floor");
  assert_true(fabs(phase(&b, 0)->t_end - sqrt(4 / 9.81)) < 1e-12);
  // the last sample of the fall is the moment before the impact
  const pl_trace_sample* last = sample(&b, phase(&b, 0)->n - 1);
  assert_true(fabs(last->a[0] + 9.81) < 1e-12 && fabs(last->v[0] + sqrt(4 * 9.81)) < 1e-11
              && last->lambda[0] == 0);
  const pl_trace_sample* rest = sample(&b, phase(&b, 1)->first);
  assert_true(rest->a[0] == 0 && fabs(rest->lambda[0] - 9.81) < 1e-12);
  pleuel_close(b.ctx);
}

static void a_jump_of_the_state_begins_a_phase_with_the_same_set(void** state) {
  (void)state;
  bench b = traced(
      "param m = 1 [kg], g = 9.81 [m/s^2]\ncoord y\naxes y up\nmass m at (y)\ngravity g along -y\n"
      "constraint floor: y >= 0\nrestitution 0.5 on floor\ninit y = 2 [m], y' = 0\nsimulate 0..1 "
      "[s]\n",
      NULL);
  assert_true(b.trace->phases.n >= 2);
  assert_true(phase(&b, 1)->same_set);
  assert_true(phase(&b, 1)->begun_by == PL_EV_IMPACT);
  pleuel_close(b.ctx);
}

static void surfaces_slip_and_then_stick(void** state) {
  (void)state;
  bench b = traced(
      "param m = 1 [kg], g = 10 [m/s^2]\ncoord x, y\naxes x right, y up\nmass m at (x, y)\n"
      "gravity g along -y\nconstraint floor: y >= 0\nfriction 0.2 on floor\n"
      "init x = 0, y = 0, x' = 1 [m/s], y' = 0\nsimulate 0..1 [s]\n",
      NULL);
  assert_int_equal(b.trace->phases.n, 2);
  assert_false(pl_trace_sticks(b.trace, phase(&b, 0), 0));
  assert_true(pl_trace_sticks(b.trace, phase(&b, 1), 0));
  assert_true(fabs(phase(&b, 1)->t_begin - 0.5) < 1e-12);
  pleuel_close(b.ctx);
}

static void parameters_without_numbers_get_some_within_the_assumptions(void** state) {
  (void)state;
  const char text[] =
      "param m, l, r, g\nassume r < l\ncoord x, y\naxes x right, y up\nmass m at (x, y)\ngravity g "
      "along -y\n"
      "constraint rod: x^2 + y^2 = l^2\n";
  bench b = traced(text, NULL), c = traced(text, NULL);
  const pl_symbol l = pl_symbol_find(b.m->model->pool, "l"),
                  r = pl_symbol_find(b.m->model->pool, "r");
  assert_true(b.trace->value[r.id] > 0 && b.trace->value[r.id] < b.trace->value[l.id]);
  assert_true(b.trace->started && b.trace->samples.n > 10);
  // the same text, the same numbers
  assert_true(b.trace->samples.n == c.trace->samples.n);
  for (int i = 0; i < b.trace->samples.n; i++)
    assert_true(sample(&b, i)->q[0] == sample(&c, i)->q[0]);
  // the model of the user keeps none
  assert_true(isnan(pl_model_values(b.m->model, b.m->arena)[l.id]));
  pleuel_close(b.ctx);
  pleuel_close(c.ctx);
}

static void random_starts_differ_and_keep_the_contacts(void** state) {
  (void)state;
  bench b = traced(ball, NULL);
  pl_trace* one = pl_trace_make(
      &b.m->job, b.m->model, &(pl_trace_options){.seed = 1, .beside = b.trace, .most_samples = 5});
  pl_trace* two = pl_trace_make(
      &b.m->job, b.m->model, &(pl_trace_options){.seed = 2, .beside = b.trace, .most_samples = 5});
  assert_true(one->started && two->started);
  assert_true(one->samples.at[0].q[0] != two->samples.at[0].q[0]);
  assert_false(pl_trace_holds(one, &one->phases.at[0], 0));
  pleuel_close(b.ctx);
}

static void a_start_that_cannot_be_had_is_told(void** state) {
  (void)state;
  bench b = traced("coord x\nmass 1 at (x)\nconstraint wall: x^2 = -1\n", NULL);
  assert_false(b.trace->started);
  assert_int_not_equal(b.trace->status, PLEUEL_OK);
  assert_true(strlen(b.trace->message) > 0);
  pleuel_close(b.ctx);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_contact_that_the_start_leaves_open_is_open),
      cmocka_unit_test(a_jump_of_the_state_begins_a_phase_with_the_same_set),
      cmocka_unit_test(surfaces_slip_and_then_stick),
      cmocka_unit_test(parameters_without_numbers_get_some_within_the_assumptions),
      cmocka_unit_test(random_starts_differ_and_keep_the_contacts),
      cmocka_unit_test(a_start_that_cannot_be_had_is_told),
  };
  return cmocka_run_group_tests_name("trace", tests, NULL, NULL);
}
