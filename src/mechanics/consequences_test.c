// What follows from the equations: integrals, momenta, closed motions, transforms, oscillations,
// shared forces, named intermediates.
#include "equilibria.h"
#include "mechanics_test_kit.h"
#include "structured.h"

#define PENDULUM                                                                   \
  "param m = 1 [kg], l = 2 [m], g = 9.81 [m/s^2]\ncoord phi\naxes x right, y up\n" \
  "mass A: m at (l sin phi, -l cos phi)\ngravity g along -y\n"

// --------------------------------------------------------------------------------------- integrals
static void the_energy_gives_the_velocity_squared(void** state) {
  (void)state;
  kit* k = kit_open(PENDULUM "param a = 60°\ninit phi = a, phi' = 0\n");
  pl_expr v2, q0, v0;
  assert_true(pl_velocity_squared(k->d, &(pl_motion){0}, &v2, &q0, &v0));
  kit_is(k, v2, "2 g (cos phi - cos a)/l");
  kit_is(k, v0, "0");
  kit_is(k, pl_without_velocity(k->d, kit_expr(k, "phi'^2 + 1"), v2),
         "1 + 2 g (cos phi - cos a)/l");
  kit_free(k);
}

static void a_cyclic_velocity_follows_from_its_momentum(void** state) {
  (void)state;
  kit* k = kit_open(
      "param m = 1, k = 2, w = 3, R = 1\ncoord r, phi\naxes x, y up\nassume r > 0\n"
      "mass A: m at (r cos phi, r sin phi)\npotential -k/r\n"
      "init r = R, r' = 0, phi = 0, phi' = w\n");
  pl_line line;
  assert_true(pl_line_of(k->d, &(pl_motion){0}, &line));
  assert_int_equal(line.i, kit_coordinate(k, "r"));
  kit_is(k, line.velocity[0].to, "R^2 w/r^2");
  kit_is(k, line.v2, "R^2 w^2 - R^4 w^2/r^2 + 2 (k/m)*(1/r - 1/R)");
  kit_free(k);
}

static void friction_leaves_no_energy(void** state) {
  (void)state;
  kit* k = kit_open(PENDULUM "param c = 1 [N m s]\ntorque -c phi' on phi\n");
  assert_true(pl_dissipates(k->d));
  assert_true(pl_is_poison(pl_conserved_energy(k->d)));
  kit_free(k);
}

static void a_driven_frame_has_jacobis_integral(void** state) {
  (void)state;
  kit* k = kit_open(
      "param m = 1, R = 2, w = 3, g = 9.81\ncoord th\naxes x, y, z up\n"
      "mass A: m at (R sin th cos(w t), R sin th sin(w t), -R cos th)\ngravity g along -z\n");
  assert_true(pl_energy_conserved(k->d));
  kit_is(k, pl_jacobi_integral(k->d), "m R^2 th'^2/2 - m R^2 w^2 sin(th)^2/2 - m g R cos th");
  kit_free(k);
}

// ----------------------------------------------------------------------------------------- momenta
static void two_free_masses_keep_two_momenta_and_one_turn(void** state) {
  (void)state;
  kit* k = kit_open(
      "param m1 = 1, m2 = 2, k = 3\ncoord x1, y1, x2, y2\naxes x, y up\n"
      "mass A: m1 at (x1, y1)\nmass B: m2 at (x2, y2)\nspring k between A and B\n");
  pl_momentum m[PL_MAX_MOMENTA];
  assert_int_equal(pl_find_momenta(k->d, m), 3);
  kit_is(k, m[0].value, "m1 x1' + m2 x2'");
  kit_is(k, m[1].value, "m1 y1' + m2 y2'");
  assert_true(m[2].turn);
  kit_is(k, m[2].value, "m1 (x1 y1' - y1 x1') + m2 (x2 y2' - y2 x2')");
  for (int i = 0; i < 3; i++) kit_is(k, m[i].rate, "0");
  for (int i = 0; i < 3; i++) kit_is(k, pl_on_motion(k->d, pl_dt(k->d->pool, m[i].value)), "0");
  kit_free(k);
}

static void weight_keeps_the_momentum_across_it(void** state) {
  (void)state;
  kit* k = kit_open(
      "param m = 1, g = 9.81\ncoord x, y\naxes X, Y up\nmass A: m at (x, y)\ngravity g along -Y\n");
  pl_momentum m[PL_MAX_MOMENTA];
  assert_int_equal(pl_find_momenta(k->d, m), 1);
  assert_false(m[0].turn);
  kit_is(k, m[0].value, "m x'");
  kit_free(k);
}

static void a_turn_finds_its_centre(void** state) {
  (void)state;
  kit* k = kit_open(
      "param m = 1, a = 2, b = 3, k = 1\ncoord x, y\naxes X, Y up\nmass A: m at (x, y)\n"
      "potential k ((x - a)^2 + (y - b)^2)/2\n");
  pl_momentum m[PL_MAX_MOMENTA];
  assert_int_equal(pl_find_momenta(k->d, m), 1);
  assert_true(m[0].turn);
  kit_is(k, m[0].centre[0], "a");
  kit_is(k, m[0].centre[1], "b");
  kit_free(k);
}

// ------------------------------------------------------------------------------- closed motions
static void an_oscillator_moves_as_it_should(void** state) {
  (void)state;
  kit* k = kit_open(
      "param m = 1, k = 2, c = 0.1\ncoord x\naxes X\nmass A: m at (x)\npotential k x^2/2\n"
      "force (-c x') on A\n");
  pl_analysis* d = k->d;
  int i = kit_coordinate(k, "x");
  pl_expr x = pl_closed_motion(d, i, NULL);
  assert_false(pl_is_poison(x));
  double* at = kit_point(k, 2);
  at[kit_name(k, "c").id] = 0.1;
  pl_symbol t = pl_time(d->pool);
  pl_expr v = pl_diff(d->pool, x, t), a = pl_diff(d->pool, v, t);
  pl_replace r[2] = {{d->q.at[i].q, x}, {d->q.at[i].v, v}};
  pl_expr rest = pl_sub(d->pool, a, pl_subst(d->pool, d->acceleration[i], r, 2));
  kit_close(kit_value(k, rest, at), 0, 1e-9);
  kit_close(kit_value(k, v, at), kit_slope(k, x, t, at), 1e-8);
  at[t.id] = 0;
  kit_close(kit_value(k, x, at), at[pl_symbol_start(d->pool, d->q.at[i].q).id], 1e-12);
  kit_close(kit_value(k, v, at), at[pl_symbol_start(d->pool, d->q.at[i].v).id], 1e-12);
  kit_free(k);
}

static void transforms_come_back(void** state) {
  (void)state;
  kit* k = kit_open(PENDULUM "param a = 2 [1/s], b = 3 [1/s]\n");
  static const char* const f[] = {"1",
                                  "t",
                                  "t^3",
                                  "exp(-a t)",
                                  "sin(b t)",
                                  "t cos(b t)",
                                  "exp(-a t) sin(b t)",
                                  "cos(b t) + 2 sin(a t)"};
  pl_symbol_info info = {.name = "s", .ascii = "test_s", .role = PL_R_LOCAL, .class = PL_C_OTHER};
  pl_symbol s = pl_symbol_make(k->d->pool, &info);
  for (int i = 0; i < (int)(sizeof f / sizeof *f); i++) {
    pl_expr e = kit_expr(k, f[i]), F = pl_laplace(k->d, e, s);
    assert_false(pl_is_poison(F));
    pl_expr back = pl_laplace_back(k->d, F, s, NULL);
    for (uint64_t seed = 1; seed < 4; seed++) {
      double* at = kit_point(k, seed);
      kit_close(kit_value(k, back, at), kit_value(k, e, at), 1e-10);
    }
  }
  assert_true(pl_is_poison(pl_laplace(k->d, kit_expr(k, "sqrt(t)"), s)));
  kit_free(k);
}

// --------------------------------------------------------------------------------------- at rest
#define DOUBLE_PENDULUM                                                                      \
  "param m = 1, l = 1, g = 9.81\ncoord a, b\naxes x right, y up\n"                           \
  "mass A: m at (l sin a, -l cos a)\nmass B: m at (l sin a + l sin b, -l cos a - l cos b)\n" \
  "gravity g along -y\nassume m > 0, l > 0, g > 0\n"

static void the_double_pendulum_oscillates_with_two_frequencies(void** state) {
  (void)state;
  kit* k = kit_open(DOUBLE_PENDULUM);
  pl_analysis* d = k->d;
  pl_expr f[pl_max_gen];
  pl_at_rest_equations(d, f);
  pl_rest down = {.q = {pl_int(d->pool, 0), pl_int(d->pool, 0)}};
  pl_linearised l;
  pl_linearise(d, f, &down, &l);
  kit_is(k, l.M[0], "2 m l^2");
  kit_is(k, l.K[0], "2 m g l");
  kit_is(k, l.K[1], "0");
  pl_root w2[4];
  bool complete = false;
  assert_int_equal(pl_small_oscillations(d, &l, w2, 4, &complete), 2);
  assert_true(complete);
  double* at = kit_point(k, 1);
  double unit = at[kit_name(k, "g").id] / at[kit_name(k, "l").id];
  double x = kit_value(k, w2[0].value, at), y = kit_value(k, w2[1].value, at);
  kit_close(fmin(x, y), (2 - sqrt(2)) * unit, 1e-12);
  kit_close(fmax(x, y), (2 + sqrt(2)) * unit, 1e-12);
  kit_free(k);
}

static void only_hanging_down_is_stable(void** state) {
  (void)state;
  kit* k = kit_open(DOUBLE_PENDULUM);
  pl_expr f[pl_max_gen];
  pl_at_rest_equations(k->d, f);
  pl_rests* found = pl_find_rests(k->d, f);
  assert_int_equal(found->n, 4);
  int stable = 0;
  for (int i = 0; i < found->n; i++) {
    pl_linearised l;
    pl_verdict verdict;
    pl_linearise(k->d, f, &found->at[i], &l);
    pl_stability(k->d, f, &l, &found->at[i], &verdict);
    assert_non_null(verdict.word);
    bool is_stable = strcmp(verdict.word, "stable") == 0;
    bool down = pl_is_zero_node(k->d->pool, found->at[i].q[0])
                && pl_is_zero_node(k->d->pool, found->at[i].q[1]);
    assert_int_equal(is_stable, down);
    stable += is_stable;
  }
  assert_int_equal(stable, 1);
  kit_free(k);
}

// --------------------------------------------------------------------------------- shared forces
static void a_constraint_that_is_written_twice_shares_its_force(void** state) {
  (void)state;
  kit* k = kit_open(
      "param m = 1, l = 2, g = 9.81\ncoord x, y\naxes X, Y up\nmass A: m at (x, y)\n"
      "gravity g along -Y\nconstraint p: x^2 + y^2 = l^2\n"
      "constraint q: 2 x^2 + 2 y^2 = 2 l^2, redundant ok\n");
  pl_analysis* d = k->d;
  assert_int_equal(d->dof.dof, 1);
  assert_int_equal(d->dependences.n, 1);
  int implied = d->dependences.at[0].implied, kept = 1 - implied;
  assert_true(d->g.at[implied].implied && d->g.at[kept].shared);
  kit_is(k, d->dependences.at[0].c[kept], implied == 1 ? "2" : "1/2");
  bool in[2];
  pl_group_sharing(d, kept, in);
  assert_true(in[0] && in[1]);
  pl_expr sum, value, lambda[2];
  pl_determined_sum(d, kept, &sum, &value);
  // minimum norm of (a, b) with a + c b = v: b = c v/(1 + c²), a = v/(1 + c²)
  assert_true(pl_smallest_multipliers(d, in, lambda));
  pl_expr c = d->dependences.at[0].c[kept];
  pl_expr norm = pl_add(d->pool, pl_int(d->pool, 1), pl_square(d->pool, c));
  kit_equal(k, lambda[kept], pl_div(d->pool, value, norm));
  kit_equal(k, lambda[implied], pl_div(d->pool, pl_mul(d->pool, c, value), norm));
  kit_free(k);
}

// -------------------------------------------------------------------------- named intermediates
static void named_entries_solve_the_raw_system(void** state) {
  (void)state;
  kit* k = kit_open(
      "param m = 1, l = 1, g = 9.81\ncoord x[1..4], y[1..4]\naxes X right, Y up\n"
      "for i in 1..4 { mass A[i]: m at (x[i], y[i]) }\ngravity g along -Y\n"
      "constraint c1: x[1]^2 + y[1]^2 = l^2\n"
      "constraint c2: (x[2] - x[1])^2 + (y[2] - y[1])^2 = l^2\n"
      "constraint c3: (x[3] - x[2])^2 + (y[3] - y[2])^2 = l^2\n"
      "constraint c4: (x[4] - x[3])^2 + (y[4] - y[3])^2 = l^2\n");
  pl_structure* s = pl_structure_of_multipliers(k->d);
  assert_non_null(s);
  assert_int_equal(s->n, 4);
  assert_true(s->chain);
  double* at = kit_point(k, 9);
  for (int i = 0; i < s->lines.n; i++) {  // in the order in which they can be computed
    at[s->lines.at[i].name.id] = kit_value(k, s->lines.at[i].exact, at);
  }
  for (int r = 0; r < s->n; r++) {
    double sum = -kit_value(k, s->R[r], at);
    for (int c = 0; c < s->n; c++) sum += kit_value(k, s->S[r * s->n + c], at) * at[s->u[c].id];
    kit_close(sum, 0, 1e-9);
  }
  kit_free(k);
}

// ------------------------------------------------------------------------------------ conditions
static void conditions_are_shortened(void** state) {
  (void)state;
  kit* k = kit_open(PENDULUM "param R = 1 [m], w = 2 [1/s]\nassume m > 0, R > 0, g > 0\n");
  pl_inequality c;
  assert_int_equal(pl_holds_if(k->d, kit_expr(k, "m R (g - R w^2)"), true, &c), PL_UNKNOWN);
  kit_is(k, c.turned ? c.less : c.more, c.turned ? "w^2" : "g/R");
  assert_int_equal(pl_holds_if(k->d, kit_expr(k, "m g + m"), true, &c), PL_YES);
  assert_int_equal(pl_holds_if(k->d, kit_expr(k, "-m g"), false, &c), PL_NO);
  kit_free(k);
}

// ------------------------------------------------------------------------------- starts, numbers
static void a_dome_has_more_than_one_motion(void** state) {
  (void)state;
  kit* k = kit_open(
      "param c = 2\ncoord r\naxes x\nassume r >= 0\nmass A: 1 at (r)\npotential -2 c r^(3/2)/3\n"
      "init r = 0, r' = 0\n");
  assert_true(pl_escapes(k->d));
  pl_symbol wait;
  pl_expr r = pl_escape_motion(k->d, &wait);
  assert_false(pl_is_poison(r));
  double* at = kit_point(k, 4);
  pl_symbol t = pl_time(k->d->pool);
  at[t.id] = 2;
  at[wait.id] = 0.5;
  pl_expr a = pl_diff(k->d->pool, pl_diff(k->d->pool, r, t), t);
  double c = at[kit_name(k, "c").id];
  kit_close(kit_value(k, a, at), c * sqrt(kit_value(k, r, at)), 1e-12);
  kit_free(k);
}

static void numbers_that_make_a_special_case_are_found(void** state) {
  (void)state;
  kit* k = kit_open(
      "param m = 1, k = 4, c = 4\ncoord x\naxes X\nmass A: m at (x)\npotential k x^2/2\n"
      "force (-c x') on A\n");
  pl_expr disc = kit_expr(k, "c^2 - 4 m k");
  assert_true(pl_vanishes_at_numbers(k->d, disc));
  assert_true(pl_find_special(k->d, disc));
  assert_int_equal(k->d->special.n, 1);
  kit_is(k, pl_on_special(k->d, disc), "0");
  kit_close(pl_number(k->d, kit_expr(k, "k/m")), 4, 0);
  kit_free(k);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_energy_gives_the_velocity_squared),
      cmocka_unit_test(a_cyclic_velocity_follows_from_its_momentum),
      cmocka_unit_test(friction_leaves_no_energy),
      cmocka_unit_test(a_driven_frame_has_jacobis_integral),
      cmocka_unit_test(two_free_masses_keep_two_momenta_and_one_turn),
      cmocka_unit_test(weight_keeps_the_momentum_across_it),
      cmocka_unit_test(a_turn_finds_its_centre),
      cmocka_unit_test(an_oscillator_moves_as_it_should),
      cmocka_unit_test(transforms_come_back),
      cmocka_unit_test(the_double_pendulum_oscillates_with_two_frequencies),
      cmocka_unit_test(only_hanging_down_is_stable),
      cmocka_unit_test(a_constraint_that_is_written_twice_shares_its_force),
      cmocka_unit_test(named_entries_solve_the_raw_system),
      cmocka_unit_test(conditions_are_shortened),
      cmocka_unit_test(a_dome_has_more_than_one_motion),
      cmocka_unit_test(numbers_that_make_a_special_case_are_found),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
