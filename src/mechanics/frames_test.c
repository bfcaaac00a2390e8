// Orthonormal frames of position maps: scale factors by hand, orthogonality by numbers.
#include "mechanics_test_kit.h"

#define POLAR                                                              \
  "param m = 1 [kg], g = 9.81 [m/s^2]\ncoord r, phi\naxes x right, y up\n" \
  "mass A: m at (r cos phi, r sin phi)\ngravity g along -y\nassume r > 0\n"

static void polar_coordinates_have_scales_one_and_r(void** state) {
  (void)state;
  kit* k = kit_open(POLAR);
  pl_frame f;
  assert_true(pl_frame_find(k->d, &k->d->particle.at[0], &f));
  assert_int_equal(f.n, 2);
  kit_is(k, f.scale[0], "1");
  kit_is(k, f.scale[1], "r");
  assert_string_equal(pl_unit_vector(k->d, f.coordinate[1]), "e_φ");
  kit_free(k);
}

static void scales_are_lengths_of_the_columns(void** state) {
  (void)state;
  kit* k = kit_open(
      "param m = 1\ncoord r, theta, phi\naxes x, y, z up\nassume r > 0, 0 < theta < pi\n"
      "mass A: m at (r sin theta cos phi, r sin theta sin phi, r cos theta)\n");
  pl_frame f;
  const pl_particle* p = &k->d->particle.at[0];
  assert_true(pl_frame_find(k->d, p, &f));
  assert_int_equal(f.n, 3);
  double* at = kit_point(k, 3);
  at[kit_name(k, "r").id] = 1.3;
  at[kit_name(k, "theta").id] = 0.7;
  for (int j = 0; j < 3; j++) {
    double square = 0;
    for (int c = 0; c < 3; c++) {
      double slope = kit_slope(k, p->at[c], k->d->q.at[f.coordinate[j]].q, at);
      square += slope * slope;
    }
    kit_close(kit_value(k, f.scale[j], at), sqrt(square), 1e-9);
  }
  kit_free(k);
}

static void oblique_coordinates_have_no_frame(void** state) {
  (void)state;
  kit* k = kit_open("param m = 1\ncoord u, v\naxes x, y up\nmass A: m at (u + v, v)\n");
  pl_frame f;
  assert_false(pl_frame_find(k->d, &k->d->particle.at[0], &f));
  kit_free(k);
}

static void a_constraint_pushes_along_the_frame(void** state) {
  (void)state;
  kit* k = kit_open(POLAR "param R = 2 [m]\nconstraint h: r >= R with λ\ninit phi = 80°\n");
  pl_force f;
  assert_true(pl_force_on(k->d, 0, 0, &f));
  assert_int_equal(f.n, 1);
  assert_string_equal(f.along[0], "e_r");
  kit_is(k, f.factor[0], "1");
  kit_is(k, pl_force_scale(k->d, 0), "1");
  kit_free(k);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(polar_coordinates_have_scales_one_and_r),
      cmocka_unit_test(scales_are_lengths_of_the_columns),
      cmocka_unit_test(oblique_coordinates_have_no_frame),
      cmocka_unit_test(a_constraint_pushes_along_the_frame),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
