// Motions with known answers: closed forms, conserved quantities, an independent integrator in long double.
#include "solve/setup_test.h"

#define P b->pool
static pl_expr sq(t_bench* b, pl_expr x) { return pl_square(P, x); }
static pl_expr mul(t_bench* b, pl_expr x, pl_expr y) { return pl_mul(P, x, y); }
static pl_expr half(t_bench* b, pl_expr x) { return pl_mul(P, pl_ratio(P, 1, 2), x); }

// ---------------------------------------------------------------------------------------------- pendulum
// Mass 1 at (x, y), y down, x^2 + y^2 = 1, g = 1.
static t_bench* pendulum(double angle, double t_end) {
  t_bench* b = t_open();
  pl_expr x = t_coord(b, "x"), y = t_coord(b, "y"), m = t_param(b, "m", 1), g = t_param(b, "g", 1), l = t_param(b, "l", 1);
  pl_expr T = half(b, mul(b, m, pl_add(P, sq(b, b->v[0]), sq(b, b->v[1])))), V = pl_neg(P, mul(b, m, mul(b, g, y)));
  pl_expr L = t_energy(b, T, V);
  t_constraint(b, "rod", pl_sub(P, pl_add(P, sq(b, x), sq(b, y)), sq(b, l)));
  t_start(b, 0, sin(angle), 0);
  t_start(b, 1, cos(angle), 0);
  assert_int_equal(t_make(b, L, t_end, 0), PLEUEL_OK);
  return b;
}

// Period 4 K(sin(angle/2)) by the arithmetic-geometric mean.
static double pendulum_period(double angle) {
  long double a = 1, c = cosl(angle / 2);
  for (int i = 0; i < 8; i++) {
    long double mean = (a + c) / 2;
    c = sqrtl(a * c);
    a = mean;
  }
  return (double)(2 * 3.14159265358979323846264338327950288L / a);
}

static void a_pendulum_returns_after_its_period(void** state) {
  (void)state;
  t_bench* b = pendulum(1.5, pendulum_period(1.5));
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  printf("pendulum: dx %.2e dy %.2e steps %ld rejected %ld g %.2e gdot %.2e drift %.2e order %d\n", b->last[0] - sin(1.5),
         b->last[1] - cos(1.5), pl_run_stats(b->run)->steps, pl_run_stats(b->run)->rejections, pl_run_stats(b->run)->max_g,
         pl_run_stats(b->run)->max_gdot, pl_run_stats(b->run)->energy_drift, pl_run_stats(b->run)->order);
  assert_true(fabs(b->last[0] - sin(1.5)) < 1e-13 && fabs(b->last[1] - cos(1.5)) < 1e-13);
  assert_true(b->last[63] == pendulum_period(1.5));
  t_close(b);
}

static void a_pendulum_keeps_its_energy_over_a_hundred_periods(void** state) {
  (void)state;
  t_bench* b = pendulum(2, 100 * pendulum_period(2));
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  const pl_stats* s = pl_run_stats(b->run);
  printf("100 periods: drift %.2e g %.2e steps %ld wall %.3f\n", s->energy_drift, s->max_g, s->steps, s->wall_s);
  assert_true(s->energy_drift < 1e-13 && s->max_g < 1e-15 && s->max_gdot < 1e-14);
  t_close(b);
}

// ---------------------------------------------------------------------------------------------- Atwood
static void atwood_equals_the_closed_form_to_rounding(void** state) {
  (void)state;
  t_bench* b = t_open();
  pl_expr x1 = t_coord(b, "x1"), x2 = t_coord(b, "x2");
  pl_expr m1 = t_param(b, "m1", 3), m2 = t_param(b, "m2", 2), g = t_param(b, "g", 9.81), l = t_param(b, "l", 3.7);
  pl_expr T = half(b, pl_add(P, mul(b, m1, sq(b, b->v[0])), mul(b, m2, sq(b, b->v[1]))));
  pl_expr V = pl_neg(P, mul(b, g, pl_add(P, mul(b, m1, x1), mul(b, m2, x2))));
  pl_expr L = t_energy(b, T, V);
  t_constraint(b, "g1", pl_sub(P, pl_add(P, x1, x2), l));
  b->coordinate[0].has_q = b->coordinate[0].has_v = true;
  b->coordinate[0].q = 1;
  assert_int_equal(t_make(b, L, 1.2, 0), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  double a = (3 - 2) * 9.81 / 5;
  printf("atwood: %.2e %.2e lambda %.2e steps %ld\n", b->last[0] - (1 + a * 1.44 / 2), b->last[16] - a * 1.2,
         pl_run_lambda(b->run)[0] + 2 * 3 * 2 * 9.81 / 5, pl_run_stats(b->run)->steps);
  assert_true(fabs(b->last[0] - (1 + a * 1.44 / 2)) < 1e-15 * 4 && fabs(b->last[16] - a * 1.2) < 4e-15);
  assert_true(fabs(pl_run_lambda(b->run)[0] + 2 * 3 * 2 * 9.81 / 5) < 1e-14 * 25);
  t_close(b);
}

// ---------------------------------------------------------------------------------------------- crank
// Slider-crank in Cartesian coordinates with the angle as a coordinate that only its map equations determine.
static t_bench* crank(double r, double l, double speed, double phi, double t_end) {
  t_bench* b = t_open();
  pl_expr x1 = t_coord(b, "x1"), z1 = t_coord(b, "z1"), x2 = t_coord(b, "x2"), angle = t_coord(b, "phi");
  pl_expr m1 = t_param(b, "m1", 2), m2 = t_param(b, "m2", 1), g = t_param(b, "g", 9.81);
  pl_expr R = t_param(b, "r", r), rod = t_param(b, "l", l);
  pl_expr T = half(b, pl_add(P, mul(b, m1, pl_add(P, sq(b, b->v[0]), sq(b, b->v[1]))), mul(b, m2, sq(b, b->v[2]))));
  pl_expr V = mul(b, m1, mul(b, g, z1));
  pl_expr L = t_energy(b, T, V);
  t_constraint(b, "g4", pl_sub(P, pl_add(P, sq(b, x1), sq(b, z1)), sq(b, R)));
  t_constraint(b, "g5", pl_sub(P, pl_add(P, sq(b, z1), sq(b, pl_sub(P, x2, x1))), sq(b, rod)));
  int k = t_constraint(b, "map x1", pl_sub(P, x1, mul(b, R, pl_call(P, PL_COS, angle))));
  b->link[k].priority = 1;
  k = t_constraint(b, "map z1", pl_sub(P, z1, mul(b, R, pl_call(P, PL_SIN, angle))));
  b->link[k].priority = 1;
  t_start(b, 3, phi, speed);
  // the slider is on the left
  b->branch[0] = pl_sub(P, x1, x2);
  b->branch_setup[0] = (pl_branch_setup){"x2 < x1", 0, 1};
  b->n_branch = 1;
  assert_int_equal(t_make(b, L, t_end, 0), PLEUEL_OK);
  return b;
}

static void a_crank_turns_a_thousand_times(void** state) {
  (void)state;
  t_bench* b = crank(0.1, 0.3, 62.83185307179586, 0.3, 120);
  pleuel_status how = pl_run_to_end(b->run);
  const pl_stats* s = pl_run_stats(b->run);
  printf("crank: %s %s phi %.3f g %.2e gdot %.2e drift %.2e steps %ld rejected %ld wall %.3f\n", pleuel_status_name(how),
         b->job.message, b->last[3] / 6.283185307179586, s->max_g, s->max_gdot, s->energy_drift, s->steps, s->rejections, s->wall_s);
  assert_int_equal(how, PLEUEL_OK);
  assert_true(b->last[3] / 6.283185307179586 > 1000);
  assert_true(s->max_g < 1e-14 && s->energy_drift < 1e-12);
  t_close(b);
}

static void a_crank_with_equal_lengths_is_reported_singular(void** state) {
  (void)state;
  t_bench* b = crank(0.1, 0.1, 30, 0.3, 1);
  pleuel_status how = pl_run_to_end(b->run);
  printf("singular crank: %s %s\n  phi %.9f t %.9f steps %ld rejected %ld\n", pleuel_status_name(how), b->job.message, b->last[3],
         pl_run_stats(b->run)->t_singular, pl_run_stats(b->run)->steps, pl_run_stats(b->run)->rejections);
  assert_int_equal(how, PLEUEL_SINGULAR);
  assert_true(fabs(b->last[3] - 1.5707963267948966) < 1e-3);
  assert_true(strstr(b->job.message, "singular position at t = ") != NULL);
  assert_true(b->event_kind[b->events - 1] == PL_EV_SINGULAR);
  t_close(b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_pendulum_returns_after_its_period),
      cmocka_unit_test(a_pendulum_keeps_its_energy_over_a_hundred_periods),
      cmocka_unit_test(atwood_equals_the_closed_form_to_rounding),
      cmocka_unit_test(a_crank_turns_a_thousand_times),
      cmocka_unit_test(a_crank_with_equal_lengths_is_reported_singular),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
