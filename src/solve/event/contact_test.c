// Contacts: release at the root of the multiplier, landing, impacts, events on the way.
#include "solve/setup_test.h"

#define P b->pool
static pl_expr sq(t_bench* b, pl_expr x) { return pl_square(P, x); }
static pl_expr mul(t_bench* b, pl_expr x, pl_expr y) { return pl_mul(P, x, y); }
static pl_expr half(t_bench* b, pl_expr x) { return pl_mul(P, pl_ratio(P, 1, 2), x); }

// ---------------------------------------------------------------------------------------- ski jump
// Polar coordinates, r >= R one-sided, ϑ from the top.
static t_bench* ski(double angle, double t_end) {
  t_bench* b = t_open();
  pl_expr r = t_coord(b, "r"), theta = t_coord(b, "theta"), m = t_param(b, "m", 75),
          g = t_param(b, "g", 9.81);
  pl_expr R = t_param(b, "R", 20);
  pl_expr T = half(b, mul(b, m, pl_add(P, sq(b, b->v[0]), mul(b, sq(b, r), sq(b, b->v[1])))));
  pl_expr V = mul(b, m, mul(b, g, mul(b, r, pl_call(P, PL_COS, theta))));
  pl_expr L = t_energy(b, T, V);
  int h = t_constraint(b, "h", pl_sub(P, r, R));
  b->constraint[h].side = 1;
  b->coordinate[1].has_q = b->coordinate[1].has_v = true;
  b->coordinate[1].q = angle;
  // the ground, y = r cos ϑ = 0, stops it
  t_event(b, "ground", mul(b, r, pl_call(P, PL_COS, theta)), -1, PL_ACTION_STOP, 0);
  assert_int_equal(t_make(b, L, t_end, 0), PLEUEL_OK);
  return b;
}

typedef struct seen {
  double theta, t, lambda;
  int releases;
} seen;
static seen last_release;
static pleuel_status see(void* user, const pl_event_record* e) {
  if (e->kind == PL_EV_RELEASE) {
    last_release = (seen){e->before.q[1], e->before.t, e->before.lambda[0],
                          last_release.releases + 1};
    assert_string_equal(e->before.mode, "contact(h)");
    assert_string_equal(e->after.mode, "free");
  }
  return t_on_event(user, e);
}

static void a_ski_jumper_takes_off_at_two_thirds(void** state) {
  (void)state;
  double start[] = {0.017453292519943295, 0.3, 1e-3};
  for (int i = 0; i < 3; i++) {
    t_bench* b = ski(start[i], 60);
    b->options.sink.event = see;
    pl_run_free(b->run);
    assert_int_equal(pl_run_make(&b->job, &b->setup, &b->options, &b->run), PLEUEL_OK);
    last_release.releases = 0;
    pleuel_status how = pl_run_to_end(b->run);
    printf(
        "# ski: %s %s release %.15f off %.2e t %.6f lambda %.2e; end t %.6f x %.4f events %ld "
        "drift %.1e steps %ld\n",
        pleuel_status_name(how), b->job.message, last_release.theta,
        last_release.theta - acos(2.0 / 3 * cos(start[i])), last_release.t, last_release.lambda,
        pl_run_time(b->run), b->last[0] * sin(b->last[1]), b->events,
        pl_run_stats(b->run)->energy_drift, pl_run_stats(b->run)->steps);
    assert_int_equal(how, PLEUEL_OK);
    assert_int_equal(last_release.releases, 1);
    assert_true(fabs(last_release.theta - acos(2.0 / 3 * cos(start[i]))) < 1e-12);
    assert_int_equal(b->event_kind[b->events - 1], PL_EV_STOP);
    assert_true(fabs(b->last[0] * cos(b->last[1])) < 1e-12);
    t_close(b);
  }
}

// ------------------------------------------------------------------------------- falling, bouncing
// A ball above a table: y >= 0, moving sideways.
static t_bench* ball(double y, double vy, double restitution, double t_end) {
  t_bench* b = t_open();
  pl_expr x = t_coord(b, "x"), h = t_coord(b, "y"), m = t_param(b, "m", 2), g = t_param(b, "g", 10);
  (void)x;
  pl_expr T = half(b, mul(b, m, pl_add(P, sq(b, b->v[0]), sq(b, b->v[1]))));
  int c = t_constraint(b, "table", h);
  b->constraint[c].side = 1;
  b->constraint[c].restitution = restitution;
  t_start(b, 0, 0, 3);
  t_start(b, 1, y, vy);
  assert_int_equal(t_make(b, pl_sub(P, T, mul(b, m, mul(b, g, h))), t_end, 0), PLEUEL_OK);
  return b;
}

static void a_ball_lands_and_stays(void** state) {
  (void)state;
  t_bench* b = ball(5, 0, 0, 3);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  printf("# landing at %.16g, y %.3e vy %.3e lambda %g events %ld\n", b->event_t[0], b->last[1],
         b->last[17], pl_run_lambda(b->run)[0], b->events);
  assert_int_equal(b->events, 1);
  assert_int_equal(b->event_kind[0], PL_EV_IMPACT);
  assert_true(fabs(b->event_t[0] - 1) < 1e-14);
  assert_true(fabs(b->last[1]) < 1e-15 && b->last[17] == 0 && fabs(b->last[0] - 9) < 1e-14);
  assert_true(fabs(pl_run_lambda(b->run)[0] - 20) < 1e-12);
  t_close(b);
}

static void a_ball_bounces_in_a_geometric_sequence_and_comes_to_rest(void** state) {
  (void)state;
  t_bench* b = ball(5, 0, 0.5, 6);
  pleuel_status how = pl_run_to_end(b->run);
  printf("# bounces: %s %s events %ld at %.15g %.15g %.15g last %.12g\n", pleuel_status_name(how),
         b->job.message, b->events, b->event_t[0], b->event_t[1], b->event_t[2],
         b->event_t[b->events - 1]);
  assert_int_equal(how, PLEUEL_OK);
  assert_true(fabs(b->event_t[0] - 1) < 1e-14 && fabs(b->event_t[1] - 2) < 1e-13
              && fabs(b->event_t[2] - 2.5) < 1e-13);
  // 1 + 2 (1/2 + 1/4 + ...) = 3
  assert_true(fabs(b->event_t[b->events - 1] - 3) < 1e-6);
  assert_true(fabs(b->last[1]) < 1e-12 && fabs(b->last[17]) < 1e-12);
  t_close(b);
}

static void a_ball_thrown_up_from_the_table_leaves_it(void** state) {
  (void)state;
  t_bench* b = ball(0, 5, 0, 2);
  pleuel_status how = pl_run_to_end(b->run);
  printf("# thrown: %s %s %ld %.15g kind %d\n", pleuel_status_name(how), b->job.message, b->events,
         b->event_t[0], b->event_kind[0]);
  assert_int_equal(how, PLEUEL_OK);
  assert_int_equal(b->events, 1);
  assert_int_equal(b->event_kind[0], PL_EV_IMPACT);
  assert_true(fabs(b->event_t[0] - 1) < 1e-14);
  t_close(b);
}

static void a_contact_that_would_pull_releases_at_the_start(void** state) {
  (void)state;
  // r <= R from inside, at rest at the top: gravity pulls away from the wall at once
  t_bench* b = t_open();
  pl_expr r = t_coord(b, "r"), theta = t_coord(b, "theta"), m = t_param(b, "m", 1),
          g = t_param(b, "g", 10), R = t_param(b, "R", 1);
  pl_expr T = half(b, mul(b, m, pl_add(P, sq(b, b->v[0]), mul(b, sq(b, r), sq(b, b->v[1])))));
  pl_expr V = mul(b, m, mul(b, g, mul(b, r, pl_call(P, PL_COS, theta))));
  int h = t_constraint(b, "wall", pl_sub(P, r, R));
  b->constraint[h].side = -1;
  t_start(b, 0, 1, 0);
  t_start(b, 1, 0.2, 0);
  assert_int_equal(t_make(b, pl_sub(P, T, V), 0.1, 0), PLEUEL_OK);
  pleuel_status how = pl_run_to_end(b->run);
  printf("# pull: %s %s events %ld r %.6f\n", pleuel_status_name(how), b->job.message, b->events,
         b->last[0]);
  assert_int_equal(how, PLEUEL_OK);
  assert_int_equal(b->events, 1);
  assert_int_equal(b->event_kind[0], PL_EV_RELEASE);
  assert_true(b->event_t[0] == 0);
  // free fall: x = sin 0.2, y = cos 0.2 - 5 t^2
  double x = sin(0.2), y = cos(0.2) - 0.05;
  assert_true(fabs(b->last[0] - sqrt(x * x + y * y)) < 1e-14);
  t_close(b);
}

// -------------------------------------------------------------------------------- loop in a circle
static void a_loop_too_slow_leaves_the_wall_and_comes_back(void** state) {
  (void)state;
  // ball inside a circle, x^2 + y^2 <= 1, started at the bottom; leaves where v^2 = g cos above the
  // middle
  t_bench* b = t_open();
  pl_expr x = t_coord(b, "x"), y = t_coord(b, "y"), m = t_param(b, "m", 1), g = t_param(b, "g", 1);
  pl_expr T = half(b, mul(b, m, pl_add(P, sq(b, b->v[0]), sq(b, b->v[1]))));
  pl_expr V = mul(b, m, mul(b, g, y));
  int h = t_constraint(b, "wall", pl_sub(P, pl_add(P, sq(b, x), sq(b, y)), pl_int(P, 1)));
  b->constraint[h].side = -1;
  t_start(b, 0, 0, 1.9);
  t_start(b, 1, -1, 0);
  assert_int_equal(t_make(b, t_energy(b, T, V), 20, 0), PLEUEL_OK);
  b->setup.energy_conserved = false;  // landings take energy
  pleuel_status how = pl_run_to_end(b->run);
  // v^2 = 3.61 - 2 (1 + y), leaves where v^2 = y: y = 1.61 / 3
  printf("# loop: %s %s events %ld kinds %d %d t %.9f %.9f\n", pleuel_status_name(how),
         b->job.message, b->events, b->event_kind[0], b->event_kind[1], b->event_t[0],
         b->event_t[1]);
  assert_int_equal(how, PLEUEL_OK);
  assert_true(b->events >= 2);
  assert_int_equal(b->event_kind[0], PL_EV_RELEASE);
  assert_int_equal(b->event_kind[1], PL_EV_IMPACT);
  // parabola from (-sqrt(1-y0^2)...) meets the circle again after t = 4 v sin / g with v along the
  // tangent there
  double y0 = 1.61 / 3, s = sqrt(1 - y0 * y0), v = sqrt(y0);
  assert_true(fabs(b->event_t[1] - b->event_t[0] - 4 * v * s) < 1e-11);
  t_close(b);
}

// ------------------------------------------------------------------------------------------ events
static void events_count_crossings_but_not_the_start(void** state) {
  (void)state;
  t_bench* b = t_open();
  pl_expr x = t_coord(b, "x");
  pl_expr L = pl_sub(P, half(b, sq(b, b->v[0])), half(b, sq(b, x)));
  t_start(b, 0, 0, 1);  // x = sin t
  t_event(b, "up", x, 1, PL_ACTION_RECORD, 0);
  t_event(b, "turn", b->v[0], 0, PL_ACTION_RECORD, 0);
  t_event(b, "accel", pl_dt(P, b->v[0]), -1, PL_ACTION_RECORD, 0);
  assert_int_equal(t_make(b, L, 12.6, 0), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  double pi = 3.14159265358979323846;
  long ups = 0, turns = 0, accels = 0;
  for (int i = 0; i < b->events; i++) {
    double t = b->event_t[i];
    if (b->event_index[i] == 0) assert_true(fabs(t - 2 * pi * ++ups) < 1e-13);
    else if (b->event_index[i] == 1) assert_true(fabs(t - pi * (0.5 + (double)turns++)) < 1e-13);
    // x'' = -sin t falls through zero at 0 (the start, not counted), 2 pi, 4 pi
    else assert_true(fabs(t - 2 * pi * ++accels) < 1e-13);
  }
  printf("# events: %ld %ld %ld\n", ups, turns, accels);
  assert_true(ups == 2 && turns == 4 && accels == 2);
  t_close(b);
}

static void an_event_releases_and_attaches(void** state) {
  (void)state;
  // a bead on a line y = 0 until x = 1, then free
  t_bench* b = t_open();
  pl_expr x = t_coord(b, "x"), y = t_coord(b, "y"), m = t_param(b, "m", 1), g = t_param(b, "g", 10);
  pl_expr T = half(b, mul(b, m, pl_add(P, sq(b, b->v[0]), sq(b, b->v[1]))));
  t_constraint(b, "line", y);
  t_start(b, 0, 0, 2);
  t_start(b, 1, 0, 0);
  t_event(b, "edge", pl_sub(P, x, pl_int(P, 1)), 1, PL_ACTION_RELEASE, 0);
  assert_int_equal(t_make(b, pl_sub(P, T, mul(b, m, mul(b, g, y))), 1.5, 0), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  assert_true(b->events == 1 && fabs(b->event_t[0] - 0.5) < 1e-15);
  assert_true(fabs(b->last[1] + 5) < 1e-13 && fabs(b->last[0] - 3) < 1e-14);
  t_close(b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_ski_jumper_takes_off_at_two_thirds),
      cmocka_unit_test(a_ball_lands_and_stays),
      cmocka_unit_test(a_ball_bounces_in_a_geometric_sequence_and_comes_to_rest),
      cmocka_unit_test(a_ball_thrown_up_from_the_table_leaves_it),
      cmocka_unit_test(a_contact_that_would_pull_releases_at_the_start),
      cmocka_unit_test(a_loop_too_slow_leaves_the_wall_and_comes_back),
      cmocka_unit_test(events_count_crossings_but_not_the_start),
      cmocka_unit_test(an_event_releases_and_attaches),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
