// All zeros in a range, proven; and signs by completed squares.
#include <math.h>

#include "algebra/algebra_test_text.h"

static int zeros(pl_world* w, const char* text, double lo, double hi, pl_zero* out,
                 bool* complete) {
  return pl_alg_zeros(w->tower, pl_text_expr(w, text), pl_text_symbol(w, "x"), lo, hi, out, 32,
                      complete);
}

PL_TEST(zeros_are_all_found) {
  pl_world* w = pl_world_make(NULL);
  pl_zero z[32];
  bool complete = false;
  assert_int_equal(zeros(w, "x^2 - 2", -1e9, 1.1e9, z, &complete), 2);
  assert_true(complete && z[0].proven && z[1].proven);
  assert_true(fabs(z[0].value + sqrt(2)) < 1e-14 && fabs(z[1].value - sqrt(2)) < 1e-14);
  assert_int_equal(zeros(w, "5*x - 9*sin(x)", -1e9, 1.1e9, z, &complete), 3);
  assert_true(complete);
  assert_int_equal(zeros(w, "sin(x)", -10.1, 10.2, z, &complete), 7);
  assert_true(complete);
  assert_int_equal(zeros(w, "x - 2*sqrt(x)", -5.1, 20, z, &complete), 2);  // not real below 0
  pl_world_free(w);
}

PL_TEST(no_zero_is_proven) {
  pl_world* w = pl_world_make(NULL);
  pl_zero z[32];
  bool complete = false;
  assert_int_equal(zeros(w, "x^2 + 1/1000000", -1e9, 1.1e9, z, &complete), 0);
  assert_true(complete);
  assert_int_equal(zeros(w, "exp(-x)", -10.1, 11, z, &complete), 0);
  assert_true(complete);
  assert_int_equal(zeros(w, "2 + sin(x) + cos(3*x)/2", -1e3, 1.1e3, z, &complete), 0);
  assert_true(complete);
  pl_world_free(w);
}

PL_TEST(what_is_not_decided_is_said) {
  pl_world* w = pl_world_make(NULL);
  pl_zero z[32];
  bool complete = false;
  assert_int_equal(zeros(w, "x^2", -3.1, 4, z, &complete), 1);  // a double zero touches
  assert_false(z[0].proven);
  zeros(w, "sin(x)", -1e9, 1.1e9, z, &complete);  // more than can be listed
  assert_false(complete);
  assert_int_equal(zeros(w, "x - l", -3.1, 4, z, &complete), 0);  // a letter without number
  assert_false(complete);
  pl_world_free(w);
}

static int proven_sign(pl_world* w, const char* text, bool or_zero) {
  int sign = 0;
  return pl_alg_sign_proven(w->tower, pl_text_expr(w, text), or_zero, &sign) == PL_YES ? sign : 7;
}

PL_TEST(completed_squares_have_a_sign) {
  pl_world* w = pl_world_make(NULL);
  assert_int_equal(proven_sign(w, "x^2 + x*y + y^2", true), 1);
  assert_int_equal(proven_sign(w, "x^2 + x*y + y^2 + l^2", false), 1);
  assert_int_equal(proven_sign(w, "-3*x^2 + 2*x*y - y^2", true), -1);
  assert_int_equal(proven_sign(w, "(x*l - y*r)^2 + 2*x*y*l*r + l*r", false), 1);
  assert_int_equal(proven_sign(w, "m1^2*x^2 + 2*m1*m2*x*sin(y) + m2^2", true), 1);
  assert_int_equal(proven_sign(w, "x^2 + 3*x*y + y^2", true), 7);  // indefinite
  assert_int_equal(proven_sign(w, "x^2 - 4*x + 3", true), 7);
  pl_world_free(w);
}

PL_TEST(a_proof_takes_no_sample_for_one) {
  pl_world* w = pl_world_make(NULL);
  // at all points that are drawn it is positive
  assert_int_equal(proven_sign(w, "100*l - r", false), 7);
  pl_world_free(w);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(zeros_are_all_found),
      cmocka_unit_test(no_zero_is_proven),
      cmocka_unit_test(what_is_not_decided_is_said),
      cmocka_unit_test(completed_squares_have_a_sign),
      cmocka_unit_test(a_proof_takes_no_sample_for_one),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
