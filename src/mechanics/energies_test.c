// Energies and Lagrange's equations: against hand results and against numeric differentiation.
#include "mechanics_test_kit.h"

#define PENDULUM                                                                   \
  "param m = 1 [kg], l = 2 [m], g = 9.81 [m/s^2]\ncoord phi\naxes x right, y up\n" \
  "mass A: m at (l sin phi, -l cos phi)\ngravity g along -y\n"

static void the_pendulum_has_its_energies(void** state) {
  (void)state;
  kit* k = kit_open(PENDULUM);
  kit_is(k, k->d->T, "m l^2 phi'^2/2");
  kit_is(k, k->d->V, "-m g l cos phi");
  kit_is(k, k->d->L, "m l^2 phi'^2/2 + m g l cos phi");
  assert_false(k->d->dissipative);
  kit_free(k);
}

static void a_spring_with_a_rest_length_has_its_energy(void** state) {
  (void)state;
  kit* k = kit_open(
      "param m = 1, k = 3, l = 2\ncoord x, y\naxes x, y up\nmass A: m at (x, y)\npoint O at (0, "
      "0)\n"
      "spring k, rest l between O and A\n");
  kit_is(k, k->d->V, "k (sqrt(x^2 + y^2) - l)^2/2");
  kit_free(k);
}

// E = d/dt dL/dv - dL/dq - Q, with d/dt f = sum f_q v + f_v a, every derivative by differences.
static void lagrange_rows_are_what_differences_give(void** state) {
  (void)state;
  kit* k = kit_open(
      "param m = 1, M = 2, l = 0.7, g = 9.81, c = 0.3, F = 2\ncoord x, phi\naxes X right, Y up\n"
      "mass A: M at (x, 0)\nmass B: m at (x + l sin phi, -l cos phi)\ngravity g along -Y\n"
      "force (F cos phi, 0) on B\ntorque -c phi' on phi\n");
  pl_analysis* d = k->d;
  double* at = kit_point(k, 11);
  for (int i = 0; i < d->q.n; i++) {
    pl_expr momentum = pl_diff(d->pool, d->L, d->q.at[i].v);
    double sum = -kit_slope(k, d->L, d->q.at[i].q, at) - kit_value(k, d->force[i], at);
    kit_close(kit_value(k, momentum, at), kit_slope(k, d->L, d->q.at[i].v, at), 1e-9);
    for (int j = 0; j < d->q.n; j++) {
      sum += kit_slope(k, momentum, d->q.at[j].q, at) * at[d->q.at[j].v.id];
      sum += kit_slope(k, momentum, d->q.at[j].v, at) * at[d->q.at[j].a.id];
    }
    kit_close(kit_value(k, d->euler[i], at), sum, 1e-8);
  }
  assert_true(d->dissipative);
  kit_is(k, d->force[kit_coordinate(k, "phi")], "F l cos(phi)^2 - c phi'");
  kit_free(k);
}

static void a_force_with_a_potential_joins_V(void** state) {
  (void)state;
  kit* k = kit_open(
      "param m = 1, k = 3\ncoord x, y\naxes X, Y up\nmass A: m at (x, y)\n"
      "force (-k x, -k y) on A\n");
  kit_is(k, k->d->V, "k (x^2 + y^2)/2");
  for (int i = 0; i < k->d->q.n; i++) kit_is(k, k->d->force[i], "0");
  kit_free(k);
}

static void masses_accelerate_as_newton_says(void** state) {
  (void)state;
  kit* k = kit_open(
      "param m1 = 1, m2 = 2, l = 3, g = 9.81\ncoord x1, x2\naxes x down\n"
      "mass A: m1 at (x1)\nmass B: m2 at (x2)\ngravity g along x\n"
      "constraint rope: x1 + x2 = l with λ\n");
  assert_int_equal(k->status, PLEUEL_OK);
  assert_true(k->d->solved);
  kit_is(k, k->d->acceleration[kit_coordinate(k, "x1")], "g (m1 - m2)/(m1 + m2)");
  kit_is(k, k->d->g.at[0].lambda_value, "-2 g m1 m2/(m1 + m2)");
  assert_int_equal(k->d->dof.dof, 1);
  kit_free(k);
}

static void a_kinetic_power_is_the_power_of_all_forces(void** state) {
  (void)state;
  kit* k = kit_open(PENDULUM);
  pl_analysis* d = k->d;
  pl_expr E = pl_conserved_energy(d);
  kit_is(k, E, "m l^2 phi'^2/2 - m g l cos phi");
  kit_is(k, pl_on_motion(d, pl_dt(d->pool, E)), "0");
  kit_free(k);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_pendulum_has_its_energies),
      cmocka_unit_test(a_spring_with_a_rest_length_has_its_energy),
      cmocka_unit_test(lagrange_rows_are_what_differences_give),
      cmocka_unit_test(a_force_with_a_potential_joins_V),
      cmocka_unit_test(masses_accelerate_as_newton_says),
      cmocka_unit_test(a_kinetic_power_is_the_power_of_all_forces),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
