// The implicit method through contacts, ropes, friction and events that switch constraints: against
// the series.
#include "solve/setup_test.h"

#define P b->pool
static pl_expr sq(t_bench* b, pl_expr x) { return pl_square(P, x); }
static pl_expr mul(t_bench* b, pl_expr x, pl_expr y) { return pl_mul(P, x, y); }
static pl_expr half(t_bench* b, pl_expr x) { return pl_mul(P, pl_ratio(P, 1, 2), x); }

// Two masses 1 at (x, y) and (u, w), y up, tied by a hard spring of length 1 with a damper along
// it; weight 10.
static pl_expr pair(t_bench* b, double K, double c) {
  pl_expr x = t_coord(b, "x"), y = t_coord(b, "y"), u = t_coord(b, "u"), w = t_coord(b, "w");
  pl_expr k = t_param(b, "K", K), d = t_param(b, "c", c), g = t_param(b, "g", 10);
  pl_expr dx = pl_sub(P, u, x), dy = pl_sub(P, w, y);
  pl_expr length = pl_sqrt(P, pl_add(P, sq(b, dx), sq(b, dy)));
  pl_expr stretch = pl_sub(P, length, pl_int(P, 1));
  pl_expr du = pl_sub(P, b->v[2], b->v[0]), dw = pl_sub(P, b->v[3], b->v[1]);
  pl_expr pull = mul(b, d, pl_div(P, pl_add(P, mul(b, dx, du), mul(b, dy, dw)), length));
  b->force[0] = pl_div(P, mul(b, pull, dx), length);
  b->force[1] = pl_div(P, mul(b, pull, dy), length);
  b->force[2] = pl_neg(P, b->force[0]);
  b->force[3] = pl_neg(P, b->force[1]);
  pl_expr T = pl_int(P, 0);
  for (int i = 0; i < 4; i++) T = pl_add(P, T, half(b, sq(b, b->v[i])));
  return pl_sub(P, T, pl_add(P, half(b, mul(b, k, sq(b, stretch))), mul(b, g, pl_add(P, y, w))));
}

static void start(t_bench* b, const double* q, const double* v) {
  for (int i = 0; i < 4; i++) t_start(b, i, q[i], v[i]);
}

typedef t_bench* make(pl_method method, double tol);
static t_bench* finish(t_bench* b, pl_expr L, pl_method method, double t_end, double tol) {
  b->options.method = method;
  assert_int_equal(t_make(b, L, t_end, tol), PLEUEL_OK);
  return b;
}

// Falls on the floor with the lower mass first and bounces, a little aslant.
static t_bench* falling(pl_method method, double tol) {
  t_bench* b = t_open();
  pl_expr L = pair(b, 1e7, 6e3);
  int c = t_constraint(b, "floor", b->q[3]);
  b->constraint[c].side = 1;
  b->constraint[c].restitution = 0.5;
  start(b, (double[]){0.1, 1 + sqrt(0.99), 0, 1}, (double[]){0.2, 0, 0.2, 0});
  return finish(b, L, method, 0.8, tol);
}

// On a road with waves: lifts off and lands without bouncing.
static t_bench* on_waves(pl_method method, double tol) {
  t_bench* b = t_open();
  pl_expr L = pair(b, 1e7, 6e3), wave = mul(b, t_param(b, "f", 6), pl_sym(P, pl_time(P)));
  int c = t_constraint(b, "road",
                       pl_sub(P, b->q[3], mul(b, t_param(b, "h", 0.3), pl_call(P, PL_SIN, wave))));
  b->constraint[c].side = 1;
  start(b, (double[]){0, 1, 0, 0}, (double[]){0, 1.8, 0, 1.8});
  return finish(b, L, method, 1.5, tol);
}

// Swings at a rope that goes slack.
static t_bench* at_a_rope(pl_method method, double tol) {
  t_bench* b = t_open();
  pl_expr L = pair(b, 1e7, 6e3);
  int c = t_constraint(b, "rope",
                       pl_sub(P, pl_add(P, sq(b, b->q[0]), sq(b, b->q[1])), pl_int(P, 1)));
  b->constraint[c].side = -1;
  b->constraint[c].rope = true;
  start(b, (double[]){0, -1, 0, -2}, (double[]){5, 0, 8, 0});
  return finish(b, L, method, 1.9, tol);
}

// A pendulum that is cut, and caught again by a stop.
static t_bench* cut(pl_method method, double tol) {
  t_bench* b = t_open();
  pl_expr L = pair(b, 1e7, 6e3);
  int c = t_constraint(b, "rod",
                       pl_sub(P, pl_add(P, sq(b, b->q[0]), sq(b, b->q[1])), pl_int(P, 1)));
  int f = t_constraint(b, "floor", pl_add(P, b->q[3], pl_int(P, 4)));
  b->constraint[f].side = 1;
  t_event(b, "cut", pl_sub(P, b->q[0], pl_ratio(P, 1, 2)), -1, PL_ACTION_RELEASE, c);
  start(b, (double[]){1, 0, 1, -1}, (double[]){0, 0, 0, 0});
  return finish(b, L, method, 1.4, tol);
}

typedef struct outcome {
  long events, steps, implicit;
  double event_t[64], q[4], v[4];
  pl_event_kind kind[64];
  double g;
} outcome;

static outcome run(make* of, pl_method method, double tol) {
  outcome o = {0};
  t_bench* b = of(method, tol);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  const pl_stats* s = pl_run_stats(b->run);
  o.events = b->events;
  o.steps = s->steps;
  o.implicit = s->steps_implicit;
  o.g = s->max_g;
  memcpy(o.event_t, b->event_t, sizeof o.event_t);
  memcpy(o.kind, b->event_kind, sizeof o.kind);
  memcpy(o.q, pl_run_q(b->run), sizeof o.q);
  memcpy(o.v, pl_run_v(b->run), sizeof o.v);
  t_close(b);
  return o;
}

static void compare(const char* name, make* of, double factor) {
  outcome a = run(of, PL_METHOD_TAYLOR, 1e-14);
  for (double tol = 1e-7; tol > 1e-12; tol *= 1e-2) {
    outcome b = run(of, PL_METHOD_RADAU, tol);
    double off = 0, off_t = 0;
    for (int i = 0; i < 4; i++) off = fmax(off, fmax(fabs(a.q[i] - b.q[i]), fabs(a.v[i] - b.v[i])));
    for (int i = 0; i < a.events && i < b.events && i < 64; i++)
      off_t = fmax(off_t, fabs(a.event_t[i] - b.event_t[i]));
    printf("# %s, tol %.0e: %ld and %ld steps, %ld and %ld events, off %.1e, events off %.1e\n",
           name, tol, a.steps, b.steps, a.events, b.events, off, off_t);
    assert_int_equal(b.implicit, b.steps);
    // how many bounces are followed depends on the tolerance; which end they come to does not
    assert_true(b.g < 1e-13 && off < factor * tol);
    if (tol > 1e-10) continue;
    assert_int_equal(a.events, b.events);
    for (int i = 0; i < a.events && i < 64; i++) assert_int_equal(a.kind[i], b.kind[i]);
    assert_true(off_t < factor * tol);
  }
}

static void a_hard_pair_bounces_to_rest(void** state) {
  (void)state;
  compare("bounces", falling, 100);
}
static void a_wheel_on_a_hard_spring_lifts_off_and_lands(void** state) {
  (void)state;
  compare("waves", on_waves, 100);
}
static void a_rope_with_a_hard_pair_goes_slack(void** state) {
  (void)state;
  compare("rope", at_a_rope, 100);
}
static void an_event_cuts_a_rod_and_a_stop_catches(void** state) {
  (void)state;
  compare("cut", cut, 100);
}

static void a_stiff_contact_is_recognised(void** state) {
  (void)state;
  outcome a = run(cut, PL_METHOD_TAYLOR, 1e-9), b = run(cut, PL_METHOD_AUTO, 1e-9);
  double off = 0;
  for (int i = 0; i < 4; i++) off = fmax(off, fabs(a.q[i] - b.q[i]));
  printf("# chosen: %ld steps, %ld of them implicit, instead of %ld; off %.1e\n", b.steps,
         b.implicit, a.steps, off);
  assert_true(b.implicit > 10 && b.steps < a.steps / 3 && off < 1e-6);
}

// A hard pair on a line that a force -3 |x| drives: the branch changes now and then.
static t_bench* bent(pl_method method, double tol) {
  t_bench* b = t_open();
  pl_expr x = t_coord(b, "x"), u = t_coord(b, "u"), w = t_coord(b, "w"), z = t_coord(b, "z");
  pl_expr k = t_param(b, "K", 1e7), c = t_param(b, "c", 6e3), stretch = pl_sub(P, u, x);
  pl_expr pull = mul(b, c, pl_sub(P, b->v[1], b->v[0]));
  b->force[0] = pl_sub(P, pull,
                       mul(b, pl_int(P, 3), pl_call(P, PL_ABS, pl_sub(P, x, pl_ratio(P, 1, 2)))));
  b->force[1] = pl_sub(P, pl_neg(P, pull), u);
  pl_expr T = pl_int(P, 0);
  for (int i = 0; i < 4; i++) T = pl_add(P, T, half(b, sq(b, b->v[i])));
  start(b, (double[]){1, 1, 0, 0}, (double[]){0, 0, 1, 1});
  return finish(
      b,
      pl_sub(P, T,
             pl_add(P, half(b, mul(b, k, sq(b, stretch))), half(b, pl_add(P, sq(b, w), sq(b, z))))),
      method, 6, tol);
}

static void forces_that_change_their_branch_keep_the_order(void** state) {
  (void)state;
  outcome a = run(bent, PL_METHOD_RADAU, 1e-13);
  for (double tol = 1e-6; tol > 1e-12; tol *= 1e-2) {
    outcome b = run(bent, PL_METHOD_RADAU, tol);
    double off = 0;
    for (int i = 0; i < 4; i++) off = fmax(off, fmax(fabs(a.q[i] - b.q[i]), fabs(a.v[i] - b.v[i])));
    printf("# bent, tol %.0e: %ld steps, off %.1e\n", tol, b.steps, off);
    assert_true(off < 100 * tol && b.steps < 200);
  }
}

// y'' = -10 from height 5: bounces at 1, 2, 2.5, ... and rest from 3 on.
static void a_ball_bounces_as_its_closed_form(void** state) {
  (void)state;
  t_bench* b = t_open();
  pl_expr y = t_coord(b, "y");
  int c = t_constraint(b, "floor", y);
  b->constraint[c].side = 1;
  b->constraint[c].restitution = 0.5;
  t_start(b, 0, 5, 0);
  pl_expr L = pl_sub(P, half(b, sq(b, b->v[0])), mul(b, t_param(b, "g", 10), y));
  finish(b, L, PL_METHOD_RADAU, 6, 1e-10);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  double last = b->event_t[b->events - 1];
  printf("# ball: %ld events, at %.15g %.15g %.15g, last %.15g, λ %.15g\n", b->events,
         b->event_t[0], b->event_t[1], b->event_t[2], last, pl_run_lambda(b->run)[0]);
  assert_true(b->events > 20 && b->events < 64);
  for (int i = 0; i < b->events - 1; i++)
    assert_true(fabs(b->event_t[i] - (3 - ldexp(2, -i))) < 1e-9);
  assert_true(fabs(last - 3) < 1e-9 && fabs(pl_run_lambda(b->run)[0] - 10) < 1e-9);
  assert_true(fabs(b->last[0]) < 1e-15 && fabs(b->last[16]) < 1e-15);
  t_close(b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_ball_bounces_as_its_closed_form),
      cmocka_unit_test(a_hard_pair_bounces_to_rest),
      cmocka_unit_test(a_wheel_on_a_hard_spring_lifts_off_and_lands),
      cmocka_unit_test(a_rope_with_a_hard_pair_goes_slack),
      cmocka_unit_test(an_event_cuts_a_rod_and_a_stop_catches),
      cmocka_unit_test(forces_that_change_their_branch_keep_the_order),
      cmocka_unit_test(a_stiff_contact_is_recognised),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
