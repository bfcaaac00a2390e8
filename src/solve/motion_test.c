// Motions with known answers: closed forms, conserved quantities, an independent integrator in long
// double.
#include "solve/setup_test.h"

#define P b->pool
static pl_expr sq(t_bench* b, pl_expr x) { return pl_square(P, x); }
static pl_expr mul(t_bench* b, pl_expr x, pl_expr y) { return pl_mul(P, x, y); }
static pl_expr half(t_bench* b, pl_expr x) { return pl_mul(P, pl_ratio(P, 1, 2), x); }

// ---------------------------------------------------------------------------------------- pendulum
// Mass 1 at (x, y), y down, x^2 + y^2 = 1, g = 1.
static t_bench* pendulum(double angle, double t_end) {
  t_bench* b = t_open();
  pl_expr x = t_coord(b, "x"), y = t_coord(b, "y"), m = t_param(b, "m", 1), g = t_param(b, "g", 1),
          l = t_param(b, "l", 1);
  pl_expr T = half(b, mul(b, m, pl_add(P, sq(b, b->v[0]), sq(b, b->v[1])))),
          V = pl_neg(P, mul(b, m, mul(b, g, y)));
  pl_expr L = t_energy(b, T, V);
  t_constraint(b, "rod", pl_sub(P, pl_add(P, sq(b, x), sq(b, y)), sq(b, l)));
  t_start(b, 0, sin(angle), 0);
  t_start(b, 1, cos(angle), 0);
  assert_int_equal(t_make(b, L, t_end, 0), PLEUEL_OK);
  return b;
}

// Period 4 K(sin(angle/2)) by the arithmetic-geometric mean.
static double pendulum_period(double angle) {
  long double a = 1, c = cosl((long double)angle / 2);
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
  printf(
      "# pendulum: dx %.2e dy %.2e steps %ld rejected %ld g %.2e gdot %.2e drift %.2e order %d\n",
      b->last[0] - sin(1.5), b->last[1] - cos(1.5), pl_run_stats(b->run)->steps,
      pl_run_stats(b->run)->rejections, pl_run_stats(b->run)->max_g, pl_run_stats(b->run)->max_gdot,
      pl_run_stats(b->run)->energy_drift, pl_run_stats(b->run)->order);
  assert_true(fabs(b->last[0] - sin(1.5)) < 1e-13 && fabs(b->last[1] - cos(1.5)) < 1e-13);
  assert_true(b->last[63] == pendulum_period(1.5));
  t_close(b);
}

static void a_pendulum_keeps_its_energy_over_a_hundred_periods(void** state) {
  (void)state;
  t_bench* b = pendulum(2, 100 * pendulum_period(2));
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  const pl_stats* s = pl_run_stats(b->run);
  printf("# 100 periods: drift %.2e g %.2e steps %ld wall %.3f\n", s->energy_drift, s->max_g,
         s->steps, s->wall_s);
  assert_true(s->energy_drift < 1e-13 && s->max_g < 1e-15 && s->max_gdot < 1e-14);
  t_close(b);
}

// ------------------------------------------------------------------------------------------ Atwood
static void atwood_equals_the_closed_form_to_rounding(void** state) {
  (void)state;
  t_bench* b = t_open();
  pl_expr x1 = t_coord(b, "x1"), x2 = t_coord(b, "x2");
  pl_expr m1 = t_param(b, "m1", 3), m2 = t_param(b, "m2", 2), g = t_param(b, "g", 9.81),
          l = t_param(b, "l", 3.7);
  pl_expr T = half(b, pl_add(P, mul(b, m1, sq(b, b->v[0])), mul(b, m2, sq(b, b->v[1]))));
  pl_expr V = pl_neg(P, mul(b, g, pl_add(P, mul(b, m1, x1), mul(b, m2, x2))));
  pl_expr L = t_energy(b, T, V);
  t_constraint(b, "g1", pl_sub(P, pl_add(P, x1, x2), l));
  b->coordinate[0].has_q = b->coordinate[0].has_v = true;
  b->coordinate[0].q = 1;
  assert_int_equal(t_make(b, L, 1.2, 0), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  double a = (3 - 2) * 9.81 / 5;
  printf("# atwood: %.2e %.2e lambda %.2e steps %ld\n", b->last[0] - (1 + a * 1.44 / 2),
         b->last[16] - a * 1.2, pl_run_lambda(b->run)[0] + 2 * 3 * 2 * 9.81 / 5,
         pl_run_stats(b->run)->steps);
  assert_true(fabs(b->last[0] - (1 + a * 1.44 / 2)) < 1e-15 * 4
              && fabs(b->last[16] - a * 1.2) < 4e-15);
  assert_true(fabs(pl_run_lambda(b->run)[0] + 2 * 3 * 2 * 9.81 / 5) < 1e-14 * 25);
  t_close(b);
}

// ------------------------------------------------------------------------------------------- crank
// Slider-crank in Cartesian coordinates with the angle as a coordinate that only its map equations
// determine. side +1: the slider is on the left, -1: on the right.
static t_bench* crank(double r, double l, double speed, double phi, double t_end, int side) {
  t_bench* b = t_open();
  pl_expr x1 = t_coord(b, "x1"), z1 = t_coord(b, "z1"), x2 = t_coord(b, "x2"),
          angle = t_coord(b, "phi");
  pl_expr m1 = t_param(b, "m1", 2), m2 = t_param(b, "m2", 1), g = t_param(b, "g", 9.81);
  pl_expr R = t_param(b, "r", r), rod = t_param(b, "l", l);
  pl_expr T = half(b, pl_add(P, mul(b, m1, pl_add(P, sq(b, b->v[0]), sq(b, b->v[1]))),
                             mul(b, m2, sq(b, b->v[2]))));
  pl_expr V = mul(b, m1, mul(b, g, z1));
  pl_expr L = t_energy(b, T, V);
  t_constraint(b, "g4", pl_sub(P, pl_add(P, sq(b, x1), sq(b, z1)), sq(b, R)));
  t_constraint(b, "g5", pl_sub(P, pl_add(P, sq(b, z1), sq(b, pl_sub(P, x2, x1))), sq(b, rod)));
  int k = t_constraint(b, "map x1", pl_sub(P, x1, mul(b, R, pl_call(P, PL_COS, angle))));
  b->constraint[k].priority = 1;
  k = t_constraint(b, "map z1", pl_sub(P, z1, mul(b, R, pl_call(P, PL_SIN, angle))));
  b->constraint[k].priority = 1;
  t_start(b, 3, phi, speed);
  b->branch[0] = pl_sub(P, x1, x2);
  b->branch_setup[0] = (pl_branch_setup){"x2 < x1", 0, side};
  b->n_branch = 1;
  assert_int_equal(t_make(b, L, t_end, 0), PLEUEL_OK);
  return b;
}

static void a_crank_turns_a_thousand_times(void** state) {
  (void)state;
  t_bench* b = crank(0.1, 0.3, 62.83185307179586, 0.3, 120, 1);
  pleuel_status how = pl_run_to_end(b->run);
  const pl_stats* s = pl_run_stats(b->run);
  printf("# crank: %s %s phi %.3f g %.2e gdot %.2e drift %.2e steps %ld rejected %ld wall %.3f\n",
         pleuel_status_name(how), b->job.message, b->last[3] / 6.283185307179586, s->max_g,
         s->max_gdot, s->energy_drift, s->steps, s->rejections, s->wall_s);
  assert_int_equal(how, PLEUEL_OK);
  assert_true(b->last[3] / 6.283185307179586 > 1000);
  assert_true(s->max_g < 1e-14 && s->energy_drift < 1e-12);
  t_close(b);
}

// With equal lengths the constraints lose rank whenever the crank stands upright: the slider could
// stay in the middle. Its velocity says that it does not, x2 = 2 r cos φ, and the energy tells φ'.
static double place[64], place_t[64];
static int n_places;
static pleuel_status see_place(void* user, const pl_event_record* e) {
  if (e->kind == PL_EV_SINGULAR && n_places < 64) {
    place[n_places] = e->after.q[3];
    place_t[n_places++] = e->after.t;
  }
  return t_on_event(user, e);
}

static void a_crank_with_equal_lengths_passes_its_singular_positions(void** state) {
  (void)state;
  t_bench* b = crank(0.1, 0.1, 30, 0.3, 1, -1);
  pl_run_free(b->run);
  b->options.sink.event = see_place;
  n_places = 0;
  assert_int_equal(pl_run_make(&b->job, &b->setup, &b->options, &b->run), PLEUEL_OK);
  pleuel_status how = pl_run_to_end(b->run);
  double phi = b->last[3], r = 0.1, s = sin(phi), turns = phi / 3.14159265358979323846;
  // T = r² φ'² (m1/2 + 2 m2 sin² φ) with m1 = 2, m2 = 1
  double E = r * r * 900 * (1 + 2 * sin(0.3) * sin(0.3)) + 2 * 9.81 * r * sin(0.3);
  double speed = sqrt((E - 2 * 9.81 * r * s) / (r * r * (1 + 2 * s * s)));
  printf(
      "# equal crank: %s %s, %d places, first φ = π/2 %+.1e, half turns %.3f, x2 off %.1e, speed "
      "off %.1e, drift "
      "%.1e\n",
      pleuel_status_name(how), b->job.message, n_places, place[0] - 1.5707963267948966, turns,
      b->last[2] - 2 * r * cos(phi), b->last[19] - speed, pl_run_stats(b->run)->energy_drift);
  assert_int_equal(how, PLEUEL_OK);
  assert_true(n_places >= 5);
  for (int i = 0; i < n_places; i++) {
    double half_turns = place[i] / 3.14159265358979323846 - 0.5;
    assert_true(fabs(half_turns - nearbyint(half_turns)) < 1e-7);
  }
  assert_true(fabs(b->last[2] - 2 * r * cos(phi)) < 1e-10 && fabs(b->last[19] - speed) < 1e-8);
  assert_true(pl_run_stats(b->run)->energy_drift < 1e-10);
  t_close(b);
}

// A bead that runs into the cusp of y² = x³: what comes after is not decided.
static void a_cusp_is_reported_with_its_place(void** state) {
  (void)state;
  t_bench* b = t_open();
  pl_expr x = t_coord(b, "x"), y = t_coord(b, "y");
  pl_expr T = half(b, pl_add(P, sq(b, b->v[0]), sq(b, b->v[1])));
  t_constraint(b, "curve", pl_sub(P, sq(b, y), pl_pow_int(P, x, 3)));
  t_start(b, 0, 1, -2);
  t_start(b, 1, 1, -3);
  assert_int_equal(t_make(b, t_energy(b, T, pl_int(P, 0)), 5, 0), PLEUEL_OK);
  pleuel_status how = pl_run_to_end(b->run);
  // arc length (13^(3/2) - 8)/27 at speed sqrt 13
  double t = (pow(13, 1.5) - 8) / 27 / sqrt(13);
  printf("# cusp: %s %s, t off %.1e\n", pleuel_status_name(how), b->job.message,
         pl_run_time(b->run) - t);
  assert_int_equal(how, PLEUEL_SINGULAR);
  assert_true(fabs(pl_run_stats(b->run)->t_singular - t) < 1e-3);
  assert_non_null(strstr(b->job.message, "singular position at t = "));
  assert_true(b->event_kind[b->events - 1] == PL_EV_SINGULAR);
  t_close(b);
}

// --------------------------------------------------------------------------------- double pendulum
// Reference: angles, accelerations by hand, Gragg's midpoint rule with Bulirsch-Stoer extrapolation
// in quad precision. It shares nothing with the solver: other coordinates, other formulas, other
// method, other arithmetic.
#ifdef __SIZEOF_FLOAT128__
typedef __float128 quad;
#else
typedef long double quad;  // as wide where there is no other name for it
#endif

static quad quad_sin(quad x);
static quad quad_cos(quad x) {
  quad h = quad_sin(x / 2);
  return 1 - 2 * h * h;
}

// Taylor after halving; |x| stays below 4 here.
static quad quad_sin(quad x) {
  if (10 * x > 3 || 10 * x < -3) {
    // sin 3a = 3 sin a - 4 sin^3 a
    quad s = quad_sin(x / 3);
    return s * (3 - 4 * s * s);
  }
  quad term = x, sum = x;
  for (int k = 1; k < 20; k++) {
    term *= -x * x / (quad)((2 * k) * (2 * k + 1));
    sum += term;
  }
  return sum;
}

// y = (a, b, a', b'); masses, lengths and g are 1
static void double_rhs(const quad* y, quad* f) {
  quad s = quad_sin(y[0] - y[1]), c = quad_cos(y[0] - y[1]), wa = y[2] * y[2], wb = y[3] * y[3];
  quad ra = -s * wb - 2 * quad_sin(y[0]), rb = s * wa - quad_sin(y[1]), det = 2 - c * c;
  f[0] = y[2];
  f[1] = y[3];
  f[2] = (ra - c * rb) / det;
  f[3] = (2 * rb - c * ra) / det;
}

static void midpoint(const quad* y, quad H, int n, quad* out) {
  quad h = H / n, a[4], b[4], f[4];
  double_rhs(y, f);
  for (int i = 0; i < 4; i++) {
    a[i] = y[i];
    b[i] = y[i] + h * f[i];
  }
  for (int k = 1; k < n; k++) {
    double_rhs(b, f);
    for (int i = 0; i < 4; i++) {
      quad next = a[i] + 2 * h * f[i];
      a[i] = b[i];
      b[i] = next;
    }
  }
  double_rhs(b, f);
  for (int i = 0; i < 4; i++) out[i] = (a[i] + b[i] + h * f[i]) / 2;
}

enum { COLUMNS = 9 };
static void double_pendulum_reference(quad* y, double T, int steps) {
  for (int s = 0; s < steps; s++) {
    quad table[COLUMNS][4], H = (quad)T / steps;
    for (int j = 0; j < COLUMNS; j++) {
      midpoint(y, H, 2 * (j + 1), table[j]);
      for (int k = j - 1; k >= 0; k--) {
        quad ratio = (quad)(j + 1) / (k + 1);
        for (int i = 0; i < 4; i++)
          table[k][i] = table[k + 1][i] + (table[k + 1][i] - table[k][i]) / (ratio * ratio - 1);
      }
    }
    for (int i = 0; i < 4; i++) y[i] = table[0][i];
  }
}

static void a_double_pendulum_agrees_with_an_independent_reference(void** state) {
  (void)state;
  double T = 10;
  quad y[4] = {(quad)1.2, (quad)0.7, 0, 0}, coarse[4] = {(quad)1.2, (quad)0.7, 0, 0};
  double_pendulum_reference(y, T, 400);
  double_pendulum_reference(coarse, T, 300);
  for (int i = 0; i < 4; i++)
    assert_true((double)(y[i] - coarse[i]) < 1e-15 && (double)(y[i] - coarse[i]) > -1e-15);
  t_bench* b = t_open();
  pl_expr x1 = t_coord(b, "x1"), y1 = t_coord(b, "y1"), x2 = t_coord(b, "x2"),
          y2 = t_coord(b, "y2");
  pl_expr T_ = half(
      b,
      pl_add_n(P, (pl_expr[]){sq(b, b->v[0]), sq(b, b->v[1]), sq(b, b->v[2]), sq(b, b->v[3])}, 4));
  pl_expr V = pl_neg(P, pl_add(P, y1, y2));
  t_constraint(b, "a", pl_sub(P, pl_add(P, sq(b, x1), sq(b, y1)), pl_int(P, 1)));
  t_constraint(
      b, "b",
      pl_sub(P, pl_add(P, sq(b, pl_sub(P, x2, x1)), sq(b, pl_sub(P, y2, y1))), pl_int(P, 1)));
  t_start(b, 0, sin(1.2), 0);
  t_start(b, 1, cos(1.2), 0);
  t_start(b, 2, sin(1.2) + sin(0.7), 0);
  t_start(b, 3, cos(1.2) + cos(0.7), 0);
  assert_int_equal(t_make(b, t_energy(b, T_, V), T, 0), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  double expect[4] = {(double)quad_sin(y[0]), (double)quad_cos(y[0]),
                      (double)(quad_sin(y[0]) + quad_sin(y[1])),
                      (double)(quad_cos(y[0]) + quad_cos(y[1]))};
  for (int i = 0; i < 4; i++) {
    printf("# double pendulum: %.17g off by %.2e\n", b->last[i], b->last[i] - expect[i]);
    assert_true(fabs(b->last[i] - expect[i]) < 1e-12);
  }
  t_close(b);
}

// ------------------------------------------------------------------------------------------ Kepler
static void an_ellipse_closes_after_ten_turns(void** state) {
  (void)state;
  t_bench* b = t_open();
  pl_expr x = t_coord(b, "x"), y = t_coord(b, "y");
  pl_expr T = half(b, pl_add(P, sq(b, b->v[0]), sq(b, b->v[1])));
  pl_expr V = pl_neg(P, pl_pow(P, pl_add(P, sq(b, x), sq(b, y)), pl_ratio(P, -1, 2)));
  double e = 0.6, pi = 3.14159265358979323846;
  t_start(b, 0, 1 - e, 0);
  t_start(b, 1, 0, sqrt((1 + e) / (1 - e)));
  assert_int_equal(t_make(b, t_energy(b, T, V), 20 * pi, 0), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  printf("# kepler: %.2e %.2e steps %ld drift %.2e\n", b->last[0] - (1 - e), b->last[1],
         pl_run_stats(b->run)->steps, pl_run_stats(b->run)->energy_drift);
  assert_true(fabs(b->last[0] - (1 - e)) < 1e-11 && fabs(b->last[1]) < 1e-11
              && pl_run_stats(b->run)->energy_drift < 1e-13);
  t_close(b);
}

// -------------------------------------------------------------------------------------- redundancy
static void a_redundant_constraint_changes_nothing_but_its_multiplier(void** state) {
  (void)state;
  double last[2][2];
  for (int twice = 0; twice < 2; twice++) {
    t_bench* b = t_open();
    pl_expr x = t_coord(b, "x"), y = t_coord(b, "y");
    pl_expr T = half(b, pl_add(P, sq(b, b->v[0]), sq(b, b->v[1])));
    pl_expr g = pl_sub(P, pl_add(P, sq(b, x), sq(b, y)), pl_int(P, 1));
    t_constraint(b, "rod", g);
    if (twice) t_constraint(b, "again", mul(b, pl_call(P, PL_EXP, x), g));
    t_start(b, 0, 0.6, 0);
    t_start(b, 1, -0.8, 0);
    assert_int_equal(t_make(b, t_energy(b, T, y), 10, 0), PLEUEL_OK);
    pleuel_status how = pl_run_to_end(b->run);
    printf("# redundant %d: %s %s rank %d g %.1e\n", twice, pleuel_status_name(how), b->job.message,
           pl_run_stats(b->run)->rank, pl_run_stats(b->run)->max_g);
    assert_int_equal(how, PLEUEL_OK);
    assert_int_equal(pl_run_stats(b->run)->rank, 1);
    for (int i = 0; i < 2; i++) last[twice][i] = b->last[i];
    assert_true(pl_run_unique(b->run)[0] == !twice);
    if (twice) assert_false(pl_run_unique(b->run)[1]);
    t_close(b);
  }
  assert_true(fabs(last[0][0] - last[1][0]) < 1e-12 && fabs(last[0][1] - last[1][1]) < 1e-12);
}

// ------------------------------------------------------------------------------------ nonholonomic
// A skate on an incline, x' sin φ = y' cos φ, turning with constant speed: the cycloid of
// Caratheodory.
static void a_skate_on_a_slope_moves_on_a_cycloid(void** state) {
  (void)state;
  t_bench* b = t_open();
  pl_expr x = t_coord(b, "x"), y = t_coord(b, "y"), phi = t_coord(b, "phi");
  pl_expr T = half(b, pl_add_n(P, (pl_expr[]){sq(b, b->v[0]), sq(b, b->v[1]), sq(b, b->v[2])}, 3));
  (void)y;
  int c = t_constraint(b, "skate",
                       pl_sub(P, mul(b, b->v[0], pl_call(P, PL_SIN, phi)),
                              mul(b, b->v[1], pl_call(P, PL_COS, phi))));
  b->velocity[c] = b->constraint[c].velocity = true;
  for (int i = 0; i < 3; i++) t_start(b, i, 0, i == 2 ? 2 : 0);
  // force 1 along x; with ω = 2 and rest at the origin: speed u = sin(ω t)/ω, x = (1 - cos 2ωt)/(4
  // ω²), y = (2ωt - sin 2ωt)/(4 ω²)
  assert_int_equal(t_make(b, pl_add(P, T, x), 3, 0), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  double w = 2, t = 3;
  printf("# skate: %.2e %.2e gdot %.1e\n", b->last[0] - (1 - cos(2 * w * t)) / (4 * w * w),
         b->last[1] - (2 * w * t - sin(2 * w * t)) / (4 * w * w), pl_run_stats(b->run)->max_gdot);
  assert_true(fabs(b->last[0] - (1 - cos(2 * w * t)) / (4 * w * w)) < 1e-14);
  assert_true(fabs(b->last[1] - (2 * w * t - sin(2 * w * t)) / (4 * w * w)) < 1e-13);
  t_close(b);
}

// ------------------------------------------------------------------------------ friction through λ
static void friction_proportional_to_a_multiplier_slows_a_block(void** state) {
  (void)state;
  t_bench* b = t_open();
  pl_expr x = t_coord(b, "x"), y = t_coord(b, "y"), m = t_param(b, "m", 3),
          g = t_param(b, "g", 9.81);
  pl_expr T = half(b, mul(b, m, pl_add(P, sq(b, b->v[0]), sq(b, b->v[1]))));
  (void)x;
  t_constraint(b, "table", y);
  b->force[0] = pl_neg(P, mul(b, pl_ratio(P, 1, 5), b->lambda[0]));  // μ = 1/5, moving to the right
  t_start(b, 0, 0, 4);
  t_start(b, 1, 0, 0);
  assert_int_equal(t_make(b, pl_sub(P, T, mul(b, m, mul(b, g, y))), 1.5, 0), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  assert_true(fabs(pl_run_lambda(b->run)[0] - 3 * 9.81) < 1e-13);
  assert_true(fabs(b->last[16] - (4 - 9.81 / 5 * 1.5)) < 1e-14);
  t_close(b);
}

// --------------------------------------------------------------------------------------- rheonomic
static void a_bead_on_a_turning_rod_flies_out_exponentially(void** state) {
  (void)state;
  t_bench* b = t_open();
  pl_expr x = t_coord(b, "x"), y = t_coord(b, "y"), w = t_param(b, "w", 1.5),
          t = pl_sym(P, pl_time(P));
  pl_expr T = half(b, pl_add(P, sq(b, b->v[0]), sq(b, b->v[1])));
  pl_expr angle = mul(b, w, t);
  t_constraint(
      b, "rod",
      pl_sub(P, mul(b, x, pl_call(P, PL_SIN, angle)), mul(b, y, pl_call(P, PL_COS, angle))));
  b->coordinate[0].has_q = b->coordinate[1].has_q = true;
  b->coordinate[0].q = 1;
  b->coordinate[0].has_v = true;
  assert_int_equal(t_make(b, T, 2, 0), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  double r = hypot(b->last[0], b->last[1]);
  printf("# bead: %.2e\n", r - cosh(3.0));
  assert_true(fabs(r - cosh(3.0)) < 1e-13);
  t_close(b);
}

// -------------------------------------------------------------------------------- switching points
// A spring that is four times as stiff on one side: half periods π and π/2.
static void a_step_ends_where_a_force_changes_its_branch(void** state) {
  (void)state;
  t_bench* b = t_open();
  pl_expr x = t_coord(b, "x");
  pl_expr V = pl_if(P, x, half(b, sq(b, x)), mul(b, pl_int(P, 2), sq(b, x)));
  t_start(b, 0, 1, 0);
  assert_int_equal(
      t_make(b, t_energy(b, half(b, sq(b, b->v[0])), V), 15 * 3.14159265358979323846, 0),
      PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  printf("# kinks: x off %.1e, v %.1e, drift %.1e\n", b->last[0] - 1, b->last[16],
         pl_run_stats(b->run)->energy_drift);
  assert_true(fabs(b->last[0] - 1) < 1e-13 && fabs(b->last[16]) < 1e-11);
  t_close(b);
}

// Dry friction 1/10 on a spring: each half swing from a to -(a - 1/5); it sticks when |x| <= 1/10.
static void dry_friction_swings_until_it_sticks(void** state) {
  (void)state;
  t_bench* b = t_open();
  pl_expr x = t_coord(b, "x");
  b->force[0] = pl_mul(P, pl_ratio(P, -1, 10), pl_call(P, PL_SIGN, b->v[0]));
  t_start(b, 0, 1, 0);
  t_event(b, "turn", b->v[0], 0, PL_ACTION_RECORD, 0);
  assert_int_equal(t_make(b, pl_sub(P, half(b, sq(b, b->v[0])), half(b, sq(b, x))), 30, 0),
                   PLEUEL_OK);
  pleuel_status how = pl_run_to_end(b->run);
  printf("# friction: %s %s, %.9f at %.9f\n", pleuel_status_name(how), b->job.message, b->last[0],
         b->last[63]);
  assert_int_equal(how, PLEUEL_NUMERICAL);
  assert_non_null(strstr(b->job.message, "sticking"));
  // 1, -0.8, 0.6, -0.4, 0.2, 0 after five half swings
  assert_true(fabs(b->last[0]) < 1e-9 && fabs(b->last[63] - 5 * 3.14159265358979323846) < 1e-6);
  t_close(b);
}

// ------------------------------------------------------------------------------- how a run behaves
static void stepping_allocates_nothing(void** state) {
  (void)state;
  t_bench* b = pendulum(1, 50);
  t_event(b, "never", b->q[0], 0, PL_ACTION_RECORD, 0);
  assert_int_equal(pl_run_step(b->run), PLEUEL_OK);
  unsigned long before = pl_arena_count(b->arena);
  for (int i = 0; i < 40; i++) assert_int_equal(pl_run_step(b->run), PLEUEL_OK);
  assert_true(pl_arena_count(b->arena) == before);
  t_close(b);
}

static void the_same_run_gives_the_same_bits(void** state) {
  (void)state;
  double last[2][2];
  for (int i = 0; i < 2; i++) {
    t_bench* b = pendulum(1.3, 20);
    assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
    memcpy(last[i], b->last, sizeof last[i]);
    t_close(b);
  }
  assert_memory_equal(last[0], last[1], sizeof last[0]);
}

static void a_run_goes_backwards_to_where_it_began(void** state) {
  (void)state;
  t_bench* b = pendulum(1.3, 7);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  double q[2] = {b->last[0], b->last[1]}, v[2] = {b->last[16], b->last[17]};
  pl_run_free(b->run);
  b->options.t_0 = 7;
  b->options.t_end = 0;
  assert_int_equal(pl_run_make(&b->job, &b->setup, &b->options, &b->run), PLEUEL_OK);
  assert_int_equal(pl_run_start_at(b->run, 7, q, v), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  assert_true(b->last[63] == 0 && fabs(b->last[0] - sin(1.3)) < 1e-13);
  t_close(b);
}

static void a_grid_of_rows_ends_exactly_at_the_end(void** state) {
  (void)state;
  t_bench* b = pendulum(1.3, 1);
  pl_run_free(b->run);
  b->options.dt = 0.03;
  assert_int_equal(pl_run_make(&b->job, &b->setup, &b->options, &b->run), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  assert_int_equal(b->rows, 35);  // 0, 0.03, ..., 0.99 and 1
  assert_true(b->last[63] == 1);
  pl_run_free(b->run);
  b->rows = 0;
  b->options.dt = 0;
  b->options.count = 10;
  assert_int_equal(pl_run_make(&b->job, &b->setup, &b->options, &b->run), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  assert_int_equal(b->rows, 11);
  t_close(b);
}

static void dense_output_joins_the_steps(void** state) {
  (void)state;
  t_bench* b = pendulum(1.3, 5);
  double q[2], v[2], lambda[1];
  assert_int_equal(pl_run_step(b->run), PLEUEL_OK);
  for (int i = 0; i < 20; i++) {
    assert_int_equal(pl_run_step(b->run), PLEUEL_OK);
    pl_run_dense(b->run, pl_run_time(b->run), q, v, lambda);
    assert_true(fabs(q[0] - pl_run_q(b->run)[0]) < 1e-15
                && fabs(v[1] - pl_run_v(b->run)[1]) < 4e-15);
    assert_true(fabs(lambda[0] - pl_run_lambda(b->run)[0]) < 1e-12);
  }
  t_close(b);
}

static void an_interrupted_run_says_so_and_keeps_its_rows(void** state) {
  (void)state;
  t_bench* b = pendulum(1.3, 50);
  pl_interruption stop = {0};
  b->job.interrupted = &stop;
  for (int i = 0; i < 5; i++) assert_int_equal(pl_run_step(b->run), PLEUEL_OK);
  stop.asked = 1;
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_INTERRUPTED);
  assert_true(b->rows == 6 && b->last[63] > 0);
  t_close(b);
}

static pleuel_status third_row_is_enough(void* user, const pl_row* row) {
  (void)row;
  return ++*(int*)user == 3 ? PLEUEL_INTERRUPTED : PLEUEL_OK;
}

static void a_sink_that_refuses_gets_no_more_rows(void** state) {
  (void)state;
  t_bench* b = pendulum(1.3, 50);
  int rows = 0;
  pl_run_free(b->run);
  b->options.sink = (pl_sink){.user = &rows, .row = third_row_is_enough};
  assert_int_equal(pl_run_make(&b->job, &b->setup, &b->options, &b->run), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_INTERRUPTED);
  assert_int_equal(rows, 3);
  t_close(b);
}

static void a_looser_tolerance_takes_a_lower_order(void** state) {
  (void)state;
  t_bench* b = pendulum(1.5, pendulum_period(1.5));
  pl_run_free(b->run);
  b->options.tol = 1e-12;
  assert_int_equal(pl_run_make(&b->job, &b->setup, &b->options, &b->run), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  int order = pl_run_stats(b->run)->order;
  long steps = pl_run_stats(b->run)->steps;
  pl_run_free(b->run);
  b->options.tol = 1e-6;
  assert_int_equal(pl_run_make(&b->job, &b->setup, &b->options, &b->run), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  assert_in_range(pl_run_stats(b->run)->order, 8, order - 1);
  assert_in_range(pl_run_stats(b->run)->steps, 1, steps);
  assert_true(fabs(b->last[0] - sin(1.5)) < 1e-4);
  pl_run_free(b->run);
  b->options.tol = 1e-18;
  assert_int_equal(pl_run_make(&b->job, &b->setup, &b->options, &b->run), PLEUEL_OK);
  assert_true(pl_run_tol_raised(b->run));
  t_close(b);
}

static void what_lacks_mass_or_numbers_is_named(void** state) {
  (void)state;
  t_bench* b = t_open();
  t_coord(b, "x");
  pl_expr y = t_coord(b, "y");
  t_start(b, 0, 1, 0);
  t_start(b, 1, 0, 0);
  assert_int_equal(t_make(b, pl_sub(P, half(b, sq(b, b->v[0])), sq(b, y)), 1, 0), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_SINGULAR);
  assert_non_null(strstr(b->job.message, "y carries no mass"));
  t_close(b);
  b = t_open();
  pl_expr x = t_coord(b, "x");
  t_start(b, 0, -1, 0);
  assert_int_equal(t_make(b, pl_sub(P, half(b, sq(b, b->v[0])), pl_sqrt(P, x)), 1, 0), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_NUMERICAL);
  assert_non_null(strstr(b->job.message, "no number at t = 0 s (x = -1)"));
  t_close(b);
}

static void a_motion_that_leaves_the_domain_stops_with_a_sentence(void** state) {
  (void)state;
  // falling along a potential sqrt(x) towards x = 0
  t_bench* b = t_open();
  pl_expr x = t_coord(b, "x");
  t_start(b, 0, 1, 0);
  assert_int_equal(t_make(b, pl_sub(P, half(b, sq(b, b->v[0])), pl_sqrt(P, x)), 10, 0), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_NUMERICAL);
  printf("# domain: %s\n", b->job.message);
  assert_true(strstr(b->job.message, "t = ") != NULL);
  t_close(b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_pendulum_returns_after_its_period),
      cmocka_unit_test(a_pendulum_keeps_its_energy_over_a_hundred_periods),
      cmocka_unit_test(atwood_equals_the_closed_form_to_rounding),
      cmocka_unit_test(a_crank_turns_a_thousand_times),
      cmocka_unit_test(a_crank_with_equal_lengths_passes_its_singular_positions),
      cmocka_unit_test(a_cusp_is_reported_with_its_place),
      cmocka_unit_test(a_double_pendulum_agrees_with_an_independent_reference),
      cmocka_unit_test(an_ellipse_closes_after_ten_turns),
      cmocka_unit_test(a_redundant_constraint_changes_nothing_but_its_multiplier),
      cmocka_unit_test(a_skate_on_a_slope_moves_on_a_cycloid),
      cmocka_unit_test(friction_proportional_to_a_multiplier_slows_a_block),
      cmocka_unit_test(a_bead_on_a_turning_rod_flies_out_exponentially),
      cmocka_unit_test(a_step_ends_where_a_force_changes_its_branch),
      cmocka_unit_test(dry_friction_swings_until_it_sticks),
      cmocka_unit_test(stepping_allocates_nothing),
      cmocka_unit_test(the_same_run_gives_the_same_bits),
      cmocka_unit_test(a_run_goes_backwards_to_where_it_began),
      cmocka_unit_test(a_grid_of_rows_ends_exactly_at_the_end),
      cmocka_unit_test(dense_output_joins_the_steps),
      cmocka_unit_test(an_interrupted_run_says_so_and_keeps_its_rows),
      cmocka_unit_test(a_sink_that_refuses_gets_no_more_rows),
      cmocka_unit_test(a_looser_tolerance_takes_a_lower_order),
      cmocka_unit_test(what_lacks_mass_or_numbers_is_named),
      cmocka_unit_test(a_motion_that_leaves_the_domain_stops_with_a_sentence),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
