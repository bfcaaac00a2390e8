// The reference stepper against the series, and what it refuses.
#include "solve/setup_test.h"

#define P b->pool

// A pendulum of length 1 and mass 1 as a mass at (x, y) on a circle, y down, from the side.
static pl_expr pendulum(t_bench* b, double h) {
  pl_expr x = t_coord(b, "x"), y = t_coord(b, "y");
  pl_expr square = pl_add(P, pl_square(P, x), pl_square(P, y));
  pl_expr v = pl_add(P, pl_square(P, b->v[0]), pl_square(P, b->v[1]));
  t_constraint(b, "rod", pl_sub(P, square, pl_int(P, 1)));
  t_start(b, 0, 1, 0);
  t_start(b, 1, 0, 0);
  b->options.method = h > 0 ? PL_METHOD_REFERENCE : PL_METHOD_TAYLOR;
  b->options.h_max = h;
  return pl_add(P, pl_mul(P, pl_ratio(P, 1, 2), v), y);
}

// x and the multiplier at time 3; h 0: by the series.
static void run_to_3(double h, double* x, double* lambda) {
  t_bench* b = t_open();
  assert_int_equal(t_make(b, pendulum(b, h), 3, h > 0 ? 1e-2 : 1e-13), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  *x = pl_run_q(b->run)[0];
  *lambda = pl_run_lambda(b->run)[0];
  t_close(b);
}

static void a_step_half_as_long_is_off_by_a_sixteenth(void** state) {
  (void)state;
  double x[3], lambda[3];
  run_to_3(0, &x[0], &lambda[0]);
  run_to_3(0.02, &x[1], &lambda[1]);
  run_to_3(0.01, &x[2], &lambda[2]);
  double off = fabs(x[1] - x[0]), half = fabs(x[2] - x[0]);
  printf("# x is off by %.2e, then by %.2e; λ by %.2e\n", off, half, fabs(lambda[2] - lambda[0]));
  assert_true(half < 1e-7 && off > 12 * half && off < 20 * half);
  assert_true(fabs(lambda[2] - lambda[0]) < 1e-6);
}

static void between_its_points_the_polynomial_holds(void** state) {
  (void)state;
  t_bench* b = t_open();
  assert_int_equal(t_make(b, pendulum(b, 0.01), 3, 1e-2), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  double q[2], v[2], lambda;
  pl_run_dense(b->run, 3 - 0.004, q, v, &lambda);
  // on the circle, along it, and the multiplier of the pendulum, λ = -(v² + y) / 2
  assert_true(fabs(q[0] * q[0] + q[1] * q[1] - 1) < 1e-9);
  assert_true(fabs(q[0] * v[0] + q[1] * v[1]) < 1e-8);
  assert_true(fabs(lambda + 0.5 * (v[0] * v[0] + v[1] * v[1] + q[1])) < 1e-4);
  t_close(b);
}

static void events_and_steps_without_a_length_are_refused(void** state) {
  (void)state;
  t_bench* b = t_open();
  pl_expr L = pendulum(b, 0.01);
  t_event(b, "low", b->q[0], 0, PL_ACTION_STOP, 0);
  assert_int_equal(t_make(b, L, 3, 1e-2), PLEUEL_UNSUPPORTED);
  t_close(b);
  b = t_open();
  L = pendulum(b, 0.01);
  b->options.h_max = 0;
  assert_int_equal(t_make(b, L, 3, 1e-2), PLEUEL_UNSUPPORTED);
  t_close(b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_step_half_as_long_is_off_by_a_sixteenth),
      cmocka_unit_test(between_its_points_the_polynomial_holds),
      cmocka_unit_test(events_and_steps_without_a_length_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
