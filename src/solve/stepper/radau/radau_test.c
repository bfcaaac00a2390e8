// The implicit method against closed forms and against the series.
#include "solve/stepper/radau/radau_impl.h"
#include "solve/setup_test.h"

#define P b->pool
static pl_expr sq(t_bench* b, pl_expr x) { return pl_square(P, x); }
static pl_expr mul(t_bench* b, pl_expr x, pl_expr y) { return pl_mul(P, x, y); }
static pl_expr half(t_bench* b, pl_expr x) { return pl_mul(P, pl_ratio(P, 1, 2), x); }

// A pendulum, mass 1 at (x, y), y down, x² + y² = 1, g = 1, and a second mass on a spring of length
// 1 below it with stiffness K and damper c along the spring.
static double kick;  // speed of the second mass along the spring at the start

static t_bench* family(double K, double c, pl_method method, double t_end, double tol) {
  t_bench* b = t_open();
  pl_expr x = t_coord(b, "x"), y = t_coord(b, "y"), u = t_coord(b, "u"), w = t_coord(b, "w");
  pl_expr k = t_param(b, "K", K), d = t_param(b, "c", c);
  pl_expr dx = pl_sub(P, u, x), dy = pl_sub(P, w, y);
  pl_expr length = pl_sqrt(P, pl_add(P, sq(b, dx), sq(b, dy)));
  pl_expr stretch = pl_sub(P, length, pl_int(P, 1));
  pl_expr du = pl_sub(P, b->v[2], b->v[0]), dw = pl_sub(P, b->v[3], b->v[1]);
  pl_expr rate = pl_div(P, pl_add(P, mul(b, dx, du), mul(b, dy, dw)), length);
  pl_expr pull = mul(b, d, rate);
  b->force[0] = pl_div(P, mul(b, pull, dx), length);
  b->force[1] = pl_div(P, mul(b, pull, dy), length);
  b->force[2] = pl_neg(P, b->force[0]);
  b->force[3] = pl_neg(P, b->force[1]);
  pl_expr T = pl_int(P, 0);
  for (int i = 0; i < 4; i++) T = pl_add(P, T, half(b, sq(b, b->v[i])));
  pl_expr V = pl_sub(P, half(b, mul(b, k, sq(b, stretch))), pl_add(P, y, w));
  t_constraint(b, "rod", pl_sub(P, pl_add(P, sq(b, x), sq(b, y)), pl_int(P, 1)));
  t_start(b, 0, 1, 0);
  t_start(b, 1, 0, 0);
  t_start(b, 2, 1, 0);
  t_start(b, 3, 1, kick);
  b->options.method = method;
  assert_int_equal(t_make(b, pl_sub(P, T, V), t_end, tol), PLEUEL_OK);
  return b;
}

// ------------------------------------------------------------------------------------ coefficients
static void the_coefficients_meet_the_order_conditions(void** state) {
  (void)state;
  for (int s = 3; s <= PL_RADAU_MOST; s += 2) {
    pl_radau_method m;
    pl_radau_method_make(&m, s);
    double off = 0;
    for (int i = 0; i < s; i++) {
      for (int q = 1; q <= s; q++) {
        double sum = 0;
        for (int j = 0; j < s; j++) sum += m.A[i][j] * pow(m.c[j], q - 1);
        off = fmax(off, fabs(sum - pow(m.c[i], q) / q));
      }
    }
    // quadrature of order 2 s - 1
    for (int q = 1; q <= 2 * s - 1; q++) {
      double sum = 0;
      for (int j = 0; j < s; j++) sum += m.A[s - 1][j] * pow(m.c[j], q - 1);
      off = fmax(off, fabs(sum - 1.0 / q));
    }
    // X diag(γ) Y is the inverse
    double spectrum = 0;
    for (int i = 0; i < s; i++) {
      for (int j = 0; j < s; j++) {
        double x = m.gamma[0][0] * m.X[0][i][0] * m.Y[0][j][0];
        for (int k = 1; k <= m.n_pairs; k++) {
          double re = m.X[k][i][0] * m.Y[k][j][0] - m.X[k][i][1] * m.Y[k][j][1];
          double im = m.X[k][i][0] * m.Y[k][j][1] + m.X[k][i][1] * m.Y[k][j][0];
          x += 2 * (re * m.gamma[k][0] - im * m.gamma[k][1]);
        }
        spectrum = fmax(spectrum, fabs(x - m.inverse[i][j]));
      }
    }
    printf("# %d stages: conditions %.1e, spectrum %.1e\n", s, off, spectrum);
    assert_true(off < 1e-15 * s && spectrum < 1e-12);
  }
  // the three stages of [HairerWanner1996, IV.8]
  pl_radau_method m;
  pl_radau_method_make(&m, 3);
  double r = sqrt(6);
  assert_true(fabs(m.error[0] + (13 + 7 * r) / 3) < 1e-14
              && fabs(m.error[1] - (-13 + 7 * r) / 3) < 1e-14);
  assert_true(fabs(m.error[2] + 1 / 3.) < 1e-14 && fabs(m.A[0][0] - (88 - 7 * r) / 360) < 1e-16);
}

// ------------------------------------------------------------------------------------ closed forms
// A bead on a circle, tied to a point that runs round it with speed w by a stiff spring and damper:
// it follows exactly, x = cos w t, y = sin w t, and λ (x² + y² - 1) with 2 λ = -w². The stiff
// direction turns.
static t_bench* follower(double K, double w, double phase, double t_end, double tol) {
  t_bench* b = t_open();
  pl_expr x = t_coord(b, "x"), y = t_coord(b, "y"), k = t_param(b, "K", K),
          c = t_param(b, "c", 2 * sqrt(K));
  pl_expr angle = mul(b, t_param(b, "w", w), pl_sym(P, pl_time(P)));
  pl_expr cosine = pl_call(P, PL_COS, angle), sine = pl_call(P, PL_SIN, angle);
  pl_expr speed = t_param(b, "speed", w);
  pl_expr L = half(b, pl_add(P, sq(b, b->v[0]), sq(b, b->v[1])));
  pl_expr away = pl_add(P, sq(b, pl_sub(P, x, cosine)), sq(b, pl_sub(P, y, sine)));
  L = pl_sub(P, L, half(b, mul(b, k, away)));
  b->force[0] = pl_neg(P, mul(b, c, pl_add(P, b->v[0], mul(b, speed, sine))));
  b->force[1] = pl_neg(P, mul(b, c, pl_sub(P, b->v[1], mul(b, speed, cosine))));
  t_constraint(b, "circle", pl_sub(P, pl_add(P, sq(b, x), sq(b, y)), pl_int(P, 1)));
  t_start(b, 0, cos(phase), -w * sin(phase));
  t_start(b, 1, sin(phase), w * cos(phase));
  b->options.method = PL_METHOD_RADAU;
  assert_int_equal(t_make(b, L, t_end, tol), PLEUEL_OK);
  return b;
}

static void a_stiff_spring_follows_a_turning_point(void** state) {
  (void)state;
  for (double K = 1e4; K < 1e13; K *= 1e4) {
    t_bench* b = follower(K, 1.5, 0, 4, 1e-11);
    assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
    const double *q = pl_run_q(b->run), *v = pl_run_v(b->run);
    double off = fmax(fabs(q[0] - cos(6)), fabs(q[1] - sin(6)));
    double off_v = fmax(fabs(v[0] + 1.5 * sin(6)), fabs(v[1] - 1.5 * cos(6)));
    double off_l = fabs(pl_run_lambda(b->run)[0] + 1.5 * 1.5 / 2);
    const pl_stats* s = pl_run_stats(b->run);
    printf("# K %.0e: %ld steps, q %.1e, v %.1e, λ %.1e, g %.1e, gdot %.1e\n", K, s->steps, off,
           off_v, off_l, s->max_g, s->max_gdot);
    assert_true(off < 1e-11 && off_v < 1e-11 && off_l < 1e-10 + 1e-15 * K);
    assert_true(s->max_g < 1e-15 && s->max_gdot < 1e-14 && s->steps < 200);
    assert_true(s->steps_implicit == s->steps);
    t_close(b);
  }
}

// It starts a little ahead of its place and is pulled back within the first steps; then it follows.
static void a_stiff_start_off_its_place_is_damped(void** state) {
  (void)state;
  t_bench* b = follower(1e8, 1.5, 1e-3, 4, 1e-9);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  const double* q = pl_run_q(b->run);
  double off = fmax(fabs(q[0] - cos(6)), fabs(q[1] - sin(6)));
  printf("# off its place: %ld steps, %ld rejected, q %.1e\n", pl_run_stats(b->run)->steps,
         pl_run_stats(b->run)->rejections, off);
  assert_true(off < 1e-9 && pl_run_stats(b->run)->steps < 400);
  t_close(b);
}

// x'' + c x' + K x = 0 with roots -1 and -10^6, both excited: x = e^-t and a fast part that the
// method must resolve.
static void a_fast_part_is_resolved_while_it_lasts(void** state) {
  (void)state;
  t_bench* b = t_open();
  pl_expr x = t_coord(b, "x"), c = t_param(b, "c", 1e6 + 1), k = t_param(b, "K", 1e6);
  pl_expr L = pl_sub(P, half(b, sq(b, b->v[0])), half(b, mul(b, k, sq(b, x))));
  b->force[0] = pl_neg(P, mul(b, c, b->v[0]));
  t_start(b, 0, 1, 1e6);  // x = 2 e^-t - e^(-10^6 t), up to the part that v fixes
  b->options.method = PL_METHOD_RADAU;
  assert_int_equal(t_make(b, L, 3, 1e-10), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  // x = A e^-t + B e^(-1e6 t): A + B = 1, -A - 1e6 B = 1e6
  double B = -(1e6 + 1) / (1e6 - 1), A = 1 - B, off = fabs(pl_run_q(b->run)[0] - A * exp(-3.0)) / A;
  printf("# two time scales: %ld steps, off %.1e\n", pl_run_stats(b->run)->steps, off);
  assert_true(off < 1e-9);
  t_close(b);
}

// ------------------------------------------------------------------------------ against the series
static void it_agrees_with_the_series_at_every_tolerance(void** state) {
  (void)state;
  double c = 2 * sqrt(1e5);
  t_bench* a = family(1e5, c, PL_METHOD_TAYLOR, 3, 0);
  assert_int_equal(pl_run_to_end(a->run), PLEUEL_OK);
  for (double tol = 1e-5; tol > 1e-13; tol *= 0.1) {
    t_bench* b = family(1e5, c, PL_METHOD_RADAU, 3, tol);
    assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
    double off = 0;
    for (int i = 0; i < 4; i++) {
      off = fmax(off, fabs(pl_run_q(b->run)[i] - pl_run_q(a->run)[i]));
      off = fmax(off, fabs(pl_run_v(b->run)[i] - pl_run_v(a->run)[i]));
    }
    printf("# tol %.0e: %ld steps, off %.1e, λ off %.1e, g %.1e\n", tol,
           pl_run_stats(b->run)->steps, off, pl_run_lambda(b->run)[0] - pl_run_lambda(a->run)[0],
           pl_run_stats(b->run)->max_g);
    assert_true(off < 20 * tol && pl_run_stats(b->run)->max_g < 1e-15);
    t_close(b);
  }
  t_close(a);
}

// Rows on a grid and events of one run, to be compared with those of another.
typedef struct rows {
  int n;
  double q[64][4], lambda[64];
} rows;
static rows seen;
static pleuel_status keep_row(void* user, const pl_row* row) {
  (void)user;
  if (seen.n >= 64) return PLEUEL_OK;
  memcpy(seen.q[seen.n], row->q, sizeof seen.q[0]);
  seen.lambda[seen.n++] = row->lambda[0];
  return PLEUEL_OK;
}

static rows rows_of(pl_method method, double dt, double tol, double* event_t, int* n_events) {
  t_bench* b = family(1e5, 2 * sqrt(1e5), method, 3, tol);
  pl_run_free(b->run);
  // the pendulum stands upright: x = 0
  b->n_watch = 0;
  t_event(b, "lowest", b->q[0], 0, PL_ACTION_RECORD, 0);
  t_record_list(b, b->watch, b->n_watch, &b->watcher);
  b->setup.n_events = b->setup.n_watched = b->setup.n_watch_patterns = 1;
  b->options.dt = dt;
  b->options.sink.row = keep_row;
  seen.n = 0;
  assert_int_equal(pl_run_make(&b->job, &b->setup, &b->options, &b->run), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  *n_events = (int)b->events;
  for (int i = 0; i < *n_events; i++) event_t[i] = b->event_t[i];
  t_close(b);
  return seen;
}

static void rows_between_and_events_are_as_exact_as_steps(void** state) {
  (void)state;
  double dts[] = {0.3, 0.05}, t_a[64], t_b[64];
  for (int i = 0; i < 2; i++) {
    int n_a, n_b;
    rows a = rows_of(PL_METHOD_TAYLOR, dts[i], 0, t_a, &n_a),
         b = rows_of(PL_METHOD_RADAU, dts[i], 1e-10, t_b, &n_b);
    assert_int_equal(a.n, b.n);
    assert_int_equal(n_a, n_b);
    assert_true(n_a >= 1);
    double off = 0, off_l = 0, off_t = 0;
    for (int k = 0; k < a.n; k++) {
      for (int j = 0; j < 4; j++) off = fmax(off, fabs(a.q[k][j] - b.q[k][j]));
      off_l = fmax(off_l, fabs(a.lambda[k] - b.lambda[k]));
    }
    for (int k = 0; k < n_a; k++) off_t = fmax(off_t, fabs(t_a[k] - t_b[k]));
    printf("# dt %g: %d rows off %.1e, λ %.1e, %d events off %.1e\n", dts[i], a.n, off, off_l, n_a,
           off_t);
    assert_true(off < 2e-9 && off_t < 2e-9 && off_l < 1e-6);
  }
}

static void it_runs_backwards(void** state) {
  (void)state;
  t_bench* b = t_open();
  pl_expr x = t_coord(b, "x"), y = t_coord(b, "y");
  pl_expr T = half(b, pl_add(P, sq(b, b->v[0]), sq(b, b->v[1])));
  pl_expr L = t_energy(b, T, pl_neg(P, y));
  t_constraint(b, "rod", pl_sub(P, pl_add(P, sq(b, x), sq(b, y)), pl_int(P, 1)));
  t_start(b, 0, sin(1), 0);
  t_start(b, 1, cos(1), 0);
  b->options.method = PL_METHOD_RADAU;
  assert_int_equal(t_make(b, L, -2.5, 1e-12), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  double back = pl_run_q(b->run)[0];
  pl_run_free(b->run);
  b->options.t_end = 2.5;
  b->options.method = PL_METHOD_TAYLOR;
  b->options.tol = 0;
  assert_int_equal(pl_run_make(&b->job, &b->setup, &b->options, &b->run), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  printf("# backwards: %.1e\n", back - pl_run_q(b->run)[0]);
  // released at rest: the motion is even in time
  assert_true(fabs(back - pl_run_q(b->run)[0]) < 1e-11);
  t_close(b);
}

// ---------------------------------------------------------------------------- choice of the method
static void a_stiff_motion_is_recognised(void** state) {
  (void)state;
  for (double K = 1e6; K < 1e11; K *= 1e2) {
    t_bench* a = family(K, 2 * sqrt(K), PL_METHOD_RADAU, 5, 1e-12);
    assert_int_equal(pl_run_to_end(a->run), PLEUEL_OK);
    for (double tol = 1e-6; tol > 1e-12; tol *= 1e-3) {
      t_bench* b = family(K, 2 * sqrt(K), PL_METHOD_AUTO, 5, tol);
      assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
      const pl_stats* s = pl_run_stats(b->run);
      double off = 0;
      for (int i = 0; i < 4; i++) off = fmax(off, fabs(pl_run_q(b->run)[i] - pl_run_q(a->run)[i]));
      printf("# K %.0e, tol %.0e: implicit from t = %.3g, %ld of %ld steps, off %.1e\n", K, tol,
             s->t_implicit, s->steps_implicit, s->steps, off);
      assert_true(s->steps_implicit > 10 && s->t_implicit < 1 && s->steps < 500
                  && off < 1000 * tol);
      t_close(b);
    }
    t_close(a);
  }
}

// Without damper the fast oscillation is part of the motion and must not be lost.
static void an_oscillation_is_not_taken_for_stiffness(void** state) {
  (void)state;
  kick = 1e-3;
  t_bench *a = family(1e6, 0, PL_METHOD_TAYLOR, 2, 0), *b = family(1e6, 0, PL_METHOD_AUTO, 2, 1e-9);
  kick = 0;
  assert_int_equal(pl_run_to_end(a->run), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  double off = 0;
  for (int i = 0; i < 4; i++) off = fmax(off, fabs(pl_run_v(b->run)[i] - pl_run_v(a->run)[i]));
  printf("# undamped: %ld implicit of %ld steps, v off %.1e\n",
         pl_run_stats(b->run)->steps_implicit, pl_run_stats(b->run)->steps, off);
  assert_true(pl_run_stats(b->run)->steps_implicit == 0 && off < 1e-7);
  t_close(a);
  t_close(b);
}

// ----------------------------------------------------------------------------------- large systems
// Masses on a line between hard springs and dampers, each in a potential -cos x; the first is held.
static t_bench* line(int n, pl_method method, double t_end, double tol) {
  t_bench* b = t_open();
  pl_expr K = t_param(b, "K", 1e6), c = t_param(b, "c", 2e3), L = pl_int(P, 0);
  for (int i = 0; i < n; i++) {
    pl_expr x = t_coord(b, pl_format(b->arena, "x%d", i));
    L = pl_add(P, L, pl_add(P, half(b, sq(b, b->v[i])), pl_call(P, PL_COS, x)));
    b->force[i] = pl_int(P, 0);
    t_start(b, i, 0.01 * i, 0.5 * sin(M_PI * i / (2 * n - 1)));  // its slowest oscillation
  }
  for (int i = 1; i < n; i++) {
    pl_expr stretch = pl_sub(P, b->q[i], b->q[i - 1]),
            pull = mul(b, c, pl_sub(P, b->v[i], b->v[i - 1]));
    L = pl_sub(P, L, half(b, mul(b, K, sq(b, pl_sub(P, stretch, pl_ratio(P, 1, 100))))));
    b->force[i - 1] = pl_add(P, b->force[i - 1], pull);
    b->force[i] = pl_sub(P, b->force[i], pull);
  }
  t_constraint(b, "held", b->q[0]);
  b->options.method = method;
  assert_int_equal(t_make(b, L, t_end, tol), PLEUEL_OK);
  return b;
}

static void a_long_line_of_hard_springs_agrees_with_the_series(void** state) {
  (void)state;
  enum { N = 150 };
  t_bench* a = line(N, PL_METHOD_TAYLOR, 0.3, 1e-13);
  assert_int_equal(pl_run_to_end(a->run), PLEUEL_OK);
  for (double tol = 1e-6; tol > 1e-12; tol *= 1e-3) {
    t_bench* b = line(N, PL_METHOD_RADAU, 0.3, tol);
    assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
    assert_true(b->run->radau->sparse != NULL);
    double off = 0;
    for (int i = 0; i < N; i++) off = fmax(off, fabs(pl_run_q(b->run)[i] - pl_run_q(a->run)[i]));
    printf("# line, tol %.0e: %ld and %ld steps, off %.1e, λ off %.1e\n", tol,
           pl_run_stats(a->run)->steps, pl_run_stats(b->run)->steps, off,
           pl_run_lambda(b->run)[0] - pl_run_lambda(a->run)[0]);
    assert_true(off < 20 * tol && pl_run_stats(b->run)->steps < 200);
    t_close(b);
  }
  t_close(a);
}

// A line of many is recognised as stiff, and nothing else follows from that.
static void a_long_stiff_line_is_recognised(void** state) {
  (void)state;
  t_bench *a = line(150, PL_METHOD_RADAU, 1, 1e-9), *b = line(150, PL_METHOD_AUTO, 1, 1e-8);
  assert_int_equal(pl_run_to_end(a->run), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  double off = 0;
  for (int i = 0; i < 150; i++) off = fmax(off, fabs(pl_run_q(b->run)[i] - pl_run_q(a->run)[i]));
  const pl_stats* s = pl_run_stats(b->run);
  printf("# long line: implicit from t = %.3g, %ld of %ld steps, off %.1e\n", s->t_implicit,
         s->steps_implicit, s->steps, off);
  assert_true(s->steps_implicit > 10 && off < 1e-6);
  t_close(a);
  t_close(b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_coefficients_meet_the_order_conditions),
      cmocka_unit_test(a_stiff_spring_follows_a_turning_point),
      cmocka_unit_test(a_stiff_start_off_its_place_is_damped),
      cmocka_unit_test(a_fast_part_is_resolved_while_it_lasts),
      cmocka_unit_test(it_agrees_with_the_series_at_every_tolerance),
      cmocka_unit_test(rows_between_and_events_are_as_exact_as_steps),
      cmocka_unit_test(it_runs_backwards),
      cmocka_unit_test(a_stiff_motion_is_recognised),
      cmocka_unit_test(a_long_line_of_hard_springs_agrees_with_the_series),
      cmocka_unit_test(a_long_stiff_line_is_recognised),
      cmocka_unit_test(an_oscillation_is_not_taken_for_stiffness),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
