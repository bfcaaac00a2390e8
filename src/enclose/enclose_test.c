// One step of an oscillator x'' = -x and of x'' = x'^2, whose motion ends in a pole: the bounds of
// the proof against closed forms at complex times, and tails that matter because the order is low.
#include "solve/setup_test.h"

#include "enclose/enclose_impl.h"

typedef struct bench {
  t_bench* b;
  pl_certify_problem p;
  pl_expr q, v, time;
  double q_run, v_run;
  bool none;
  pl_system s;
  pl_enclosure_stepper e;
  arb_t t, h;
} bench;

// V'(x) = -a, or the force Q; x(0) = 1, x'(0) = v.
static bench* open_bench(bool pole, long v) {
  t_bench* b = t_open();
  pl_pool* pool = b->pool;
  pl_expr x = t_coord(b, "x");
  if (pole) b->force[0] = pl_square(pool, b->v[0]);
  pl_expr half = pl_ratio(pool, 1, 2), T = pl_mul(pool, half, pl_square(pool, b->v[0]));
  pl_expr V = pole ? pl_int(pool, 0) : pl_mul(pool, half, pl_square(pool, x));
  t_start(b, 0, 1, (double)v);
  assert_int_equal(t_make(b, t_energy(b, T, V), 1, 0), PLEUEL_OK);
  bench* k = PL_NEW(b->arena, bench);
  k->b = b;
  k->q = pl_int(pool, 1);
  k->v = pl_int(pool, v);
  k->time = pl_int(pool, 0);
  k->q_run = 1;
  k->v_run = (double)v;
  k->p = (pl_certify_problem){.pool = pool,
                              .setup = &b->setup,
                              .coordinates = &x,
                              .q_start = &k->q,
                              .v_start = &k->v,
                              .q_run = &k->q_run,
                              .v_run = &k->v_run,
                              .active = &k->none,
                              .implied = &k->none,
                              .t_0 = k->time,
                              .n_times = 1,
                              .times = &k->time};
  assert_int_equal(pl_system_make(&k->s, &b->job, &k->p), PL_CERTIFIED);
  k->p.coordinates = NULL;
  pl_system_hold(&k->s);
  pl_system_reserve(&k->s, 64);
  pl_stepper_make(&k->e, &k->s, 1);
  arb_init(k->t);
  arb_init(k->h);
  assert_true(pl_system_precision(&k->s, 200));
  arb_one(k->s.q);
  arb_set_si(k->s.v, v);
  assert_true(pl_system_point(&k->s, k->t));
  return k;
}

static void close_bench(bench* k) {
  arb_clear(k->t);
  arb_clear(k->h);
  pl_stepper_free(&k->e);
  pl_system_free(&k->s);
  t_close(k->b);
}

// A step of a low order: what the polynomial misses is in the tail.
static double step(bench* k, int order) {
  k->e.highest = order;
  assert_true(pl_step_prove(&k->e, k->t, 1));
  double h = ldexp(floor(ldexp(k->e.radius * 0.3, 20)), -20);
  arb_set_d(k->h, h);
  assert_true(pl_step_series(&k->e, k->t, k->h));
  assert_int_equal(k->e.order, order);
  pl_step_take(&k->e, k->h);
  return h;
}

// The ball of q holds the exact value, and its middle alone does not: the tail is needed, and no
// wider than `widest`.
static void holds(bench* k, arb_srcptr exact, double widest) {
  arb_t middle, off;
  arb_init(middle);
  arb_init(off);
  assert_true(arb_contains(k->s.q, exact));
  arb_get_mid_arb(middle, k->s.q);
  arb_sub(off, middle, exact, 200);
  double missed = fabs(pl_ball_double(off)), radius = mag_get_d(arb_radref(k->s.q));
  assert_true(missed > 1e-12 && radius < widest && missed <= radius);
  arb_clear(middle);
  arb_clear(off);
}

static void the_tail_covers_what_the_polynomial_misses(void** state) {
  (void)state;
  for (int order = 5; order < 9; order++) {
    bench* k = open_bench(false, 0);
    step(k, order);
    arb_t exact;
    arb_init(exact);
    arb_cos(exact, k->h, 200);
    holds(k, exact, 1e-2);
    arb_clear(exact);
    close_bench(k);
  }
}

// x' = v/(1 - v t): x = 1 - ln(1 - v t), a pole at t = 1/v.
static void the_disk_of_times_ends_before_a_pole(void** state) {
  (void)state;
  bench* k = open_bench(true, 2);
  step(k, 7);
  assert_true(k->e.radius > 0.05 && k->e.radius < 0.5);
  arb_t exact;
  arb_init(exact);
  arb_mul_si(exact, k->h, -2, 200);
  arb_add_si(exact, exact, 1, 200);
  arb_log(exact, exact, 200);
  arb_sub_si(exact, exact, 1, 200);
  arb_neg(exact, exact);
  holds(k, exact, 1e-3);
  arb_clear(exact);
  close_bench(k);
}

// On the rim of the disk, at i R, cos is cosh R: within the proven reach, and that is not far
// beyond it.
static void the_reach_holds_at_complex_times(void** state) {
  (void)state;
  bench* k = open_bench(false, 0);
  assert_true(pl_step_prove(&k->e, k->t, 1));
  double R = k->e.radius, reach = mag_get_d(k->e.reach_q);
  assert_true(cosh(R) - 1 <= reach && reach < 5 * (cosh(R) - 1));
  assert_true(sinh(R) <= mag_get_d(k->e.reach_v));
  close_bench(k);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_tail_covers_what_the_polynomial_misses),
      cmocka_unit_test(the_disk_of_times_ends_before_a_pole),
      cmocka_unit_test(the_reach_holds_at_complex_times),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
