// Values: in double precision at and beyond the edge of the domain, and modulo p, where identities
// must vanish.
#include "expr/expr_test_kit.h"

#define SIN(x)      pl_call(p, PL_SIN, (x))
#define COS(x)      pl_call(p, PL_COS, (x))
#define TIMES(n, x) pl_mul(p, pl_int(p, (n)), (x))
#define OVER(x, n)  pl_div(p, (x), pl_int(p, (n)))
#define SQ(x)       pl_square(p, (x))

static double value(pl_pool* p, pl_expr e, double x) {
  double at[64];
  for (int i = 0; i < 64; i++) at[i] = x;
  return pl_eval(p, e, at);
}

PL_TEST(values_outside_the_domain_are_nan) {
  pl_expr x = kit_coordinate(p, "x");
  assert_true(isnan(value(p, pl_sqrt(p, x), -1)));
  assert_true(isnan(value(p, pl_div(p, pl_int(p, 1), x), 0)));
  assert_true(isnan(value(p, pl_call(p, PL_LN, x), 0)));
  assert_true(isnan(value(p, pl_call(p, PL_ACOS, x), 1.5)));
  assert_true(isnan(value(p, pl_pow(p, x, pl_ratio(p, 1, 3)), -8)));
  assert_true(isnan(value(p, pl_call2(p, PL_ATAN2, x, TIMES(2, x)), 0)));
  assert_true(isnan(pl_eval(p, x, NULL)));
  assert_true(isnan(pl_eval(p, pl_poison(), NULL)));
}

PL_TEST(cases_look_at_the_sign_only) {
  pl_expr x = kit_coordinate(p, "x");
  pl_expr e = pl_if(p, x, pl_sqrt(p, x), pl_int(p, 7));
  assert_true(value(p, e, 4) == 2 && value(p, e, -4) == 7 && value(p, e, 0) == 7);
}

PL_TEST(sums_run_over_their_bounds) {
  pl_expr i = kit_index(p, "i"), k = kit_index(p, "k");
  pl_expr n = kit_parameter(p, "N", PL_C_OTHER);
  pl_expr inner = pl_sum_over(p, pl_symbol_of(p, k), pl_int(p, 1), i, pl_mul(p, i, k));
  pl_expr outer = pl_sum_over(p, pl_symbol_of(p, i), pl_int(p, 1), n, inner);
  assert_true(value(p, outer, 4) == 65);  // sum of i^2 (i+1)/2
  assert_true(isnan(value(p, outer, 1e9)));
  pl_expr fixed = pl_subst1(p, outer, pl_symbol_of(p, n), pl_int(p, 4));
  assert_true(kit_equal(p, fixed, pl_int(p, 65), 3));
}

// Each of these is zero for every x, y; the constructors do not see it.
PL_TEST(identities_of_angles_vanish) {
  pl_expr x = kit_coordinate(p, "x"), y = kit_coordinate(p, "y");
  pl_expr w = kit_parameter(p, "w", PL_C_OTHER), t = pl_sym(p, pl_time(p));
  assert_true(kit_equal(p, pl_add(p, SQ(SIN(x)), SQ(COS(x))), pl_int(p, 1), 1));
  assert_true(kit_equal(p, SIN(TIMES(2, x)), pl_mul(p, TIMES(2, SIN(x)), COS(x)), 2));
  pl_expr third = OVER(x, 3);
  assert_true(kit_equal(
      p, COS(x), pl_sub(p, TIMES(4, pl_pow_int(p, COS(third), 3)), TIMES(3, COS(third))), 3));
  pl_expr sum = pl_sub(p, pl_mul(p, COS(x), COS(y)), pl_mul(p, SIN(x), SIN(y)));
  assert_true(kit_equal(p, COS(pl_add(p, x, y)), sum, 4));
  pl_expr half = OVER(pl_add(p, x, y), 2);
  assert_true(
      kit_equal(p, SQ(SIN(half)), OVER(pl_sub(p, pl_int(p, 1), COS(pl_add(p, x, y))), 2), 5));
  pl_expr tangent = pl_call(p, PL_TAN, OVER(x, 2));
  assert_true(kit_equal(p, tangent, pl_div(p, SIN(x), pl_add(p, pl_int(p, 1), COS(x))), 6));
  // ω (t - y) and ω t - ω y are one angle
  pl_expr a1 = SIN(pl_mul(p, w, pl_sub(p, t, y))),
          a2 = SIN(pl_sub(p, pl_mul(p, w, t), pl_mul(p, w, y)));
  assert_true(kit_equal(p, a1, a2, 7));
  pl_expr slow = pl_mul(p, pl_number_from_text(p, "0.001", 5), x);
  assert_true(kit_equal(p, SIN(TIMES(2, slow)), pl_mul(p, TIMES(2, SIN(slow)), COS(slow)), 8));
}

PL_TEST(identities_at_fixed_angles_vanish) {
  pl_expr pi = pl_pi(p);
  assert_true(
      kit_equal(p, TIMES(2, SQ(COS(OVER(pi, 8)))), pl_add(p, pl_int(p, 1), COS(OVER(pi, 4))), 1));
  pl_expr root = OVER(pl_sqrt(p, pl_add(p, pl_int(p, 2), pl_sqrt(p, pl_int(p, 2)))), 2);
  assert_true(kit_equal(p, COS(OVER(pi, 8)), root, 2));
  assert_true(kit_equal(p, SIN(TIMES(3, OVER(pi, 8))), COS(OVER(pi, 8)), 3));
  // whole degrees, thirds and fifths of a turn
  pl_expr degree = OVER(pi, 180), s20 = SIN(TIMES(20, degree));
  assert_true(kit_equal(p, pl_sub(p, TIMES(3, s20), TIMES(4, pl_pow_int(p, s20, 3))),
                        SIN(TIMES(60, degree)), 4));
  assert_true(kit_equal(p, COS(OVER(pi, 5)),
                        OVER(pl_add(p, pl_int(p, 1), pl_sqrt(p, pl_int(p, 5))), 4), 5));
  assert_true(kit_equal(p, pl_call(p, PL_TAN, OVER(pi, 12)),
                        pl_sub(p, pl_int(p, 2), pl_sqrt(p, pl_int(p, 3))), 6));
  pl_expr x = kit_coordinate(p, "x"), third = OVER(TIMES(2, pi), 3);
  pl_expr phases = pl_add_n(
      p, (pl_expr[]){COS(x), COS(pl_add(p, x, third)), COS(pl_sub(p, x, third))}, 3);
  assert_true(kit_vanishes(p, phases, 7, 3));
  pl_expr nested = pl_sqrt(p, pl_add(p, pl_int(p, 5), TIMES(2, pl_sqrt(p, pl_int(p, 6)))));
  assert_true(
      kit_equal(p, nested, pl_add(p, pl_sqrt(p, pl_int(p, 2)), pl_sqrt(p, pl_int(p, 3))), 8));
}

PL_TEST(identities_of_inverse_functions_vanish) {
  pl_expr u = kit_coordinate(p, "u"), angle = pl_call(p, PL_ACOS, u);
  assert_true(kit_equal(p, COS(TIMES(2, angle)), pl_sub(p, TIMES(2, SQ(u)), pl_int(p, 1)), 1));
  assert_true(kit_equal(p, TIMES(2, SQ(COS(OVER(angle, 2)))), pl_add(p, u, pl_int(p, 1)), 2));
  assert_true(kit_equal(p, pl_add(p, pl_call(p, PL_ASIN, u), angle), OVER(pl_pi(p), 2), 3));
  pl_expr y = kit_coordinate(p, "y"), r = pl_sqrt(p, pl_add(p, SQ(u), SQ(y)));
  assert_true(kit_equal(p, COS(pl_call2(p, PL_ATAN2, y, u)), pl_div(p, u, r), 4));
}

PL_TEST(identities_of_exponentials_vanish) {
  pl_expr x = kit_coordinate(p, "x"), y = kit_coordinate(p, "y"), e = pl_call(p, PL_EXP, x);
  assert_true(
      kit_equal(p, pl_call(p, PL_COSH, x), OVER(pl_add(p, e, pl_div(p, pl_int(p, 1), e)), 2), 1));
  pl_expr c = pl_call(p, PL_COSH, pl_add(p, x, y));
  pl_expr sum = pl_add(p, pl_mul(p, pl_call(p, PL_COSH, x), pl_call(p, PL_COSH, y)),
                       pl_mul(p, pl_call(p, PL_SINH, x), pl_call(p, PL_SINH, y)));
  assert_true(kit_equal(p, c, sum, 2));
  pl_expr logs = pl_add(p, pl_call(p, PL_LN, x), TIMES(2, pl_call(p, PL_LN, y)));
  assert_true(kit_equal(p, pl_call(p, PL_LN, pl_mul(p, x, SQ(y))), logs, 3));
  assert_true(kit_equal(p, pl_call(p, PL_EXP, TIMES(2, pl_call(p, PL_LN, x))), SQ(x), 4));
  assert_true(
      kit_equal(p, pl_mul(p, pl_pow(p, x, y), x), pl_pow(p, x, pl_add(p, y, pl_int(p, 1))), 5));
}

// Roots are multiplicative, and a name that is known to be positive is a square.
PL_TEST(roots_choose_one_branch) {
  pl_expr x = kit_coordinate(p, "x"), y = kit_coordinate(p, "y"),
          m = kit_parameter(p, "m", PL_C_MASS);
  assert_true(
      kit_equal(p, pl_mul(p, pl_sqrt(p, x), pl_sqrt(p, y)), pl_sqrt(p, pl_mul(p, x, y)), 1));
  assert_true(kit_equal(p, pl_sqrt(p, SQ(m)), m, 2));
  assert_true(kit_equal(p, pl_sqrt(p, SQ(x)), pl_call(p, PL_ABS, x), 3));
  assert_true(kit_equal(p, pl_mul(p, pl_call(p, PL_SIGN, x), pl_call(p, PL_ABS, x)), x, 4));
  assert_true(
      kit_equal(p, pl_pow(p, pl_mul(p, pl_pow_int(p, m, 3), SQ(m)), pl_ratio(p, 1, 5)), m, 5));
  pl_expr l = kit_parameter(p, "l", PL_C_LENGTH);
  assert_true(
      kit_equal(p, pl_mul(p, pl_sqrt(p, pl_int(p, 3)), pl_sqrt(p, l)), pl_sqrt(p, TIMES(3, l)), 7));
  pl_expr one = pl_call2(p, PL_MAX, x, y), other = pl_call2(p, PL_MIN, x, y);
  assert_true(kit_equal(p, pl_add(p, one, other), pl_add(p, x, y), 6));
}

PL_TEST(what_is_not_zero_is_refuted) {
  pl_expr x = kit_coordinate(p, "x"), y = kit_coordinate(p, "y");
  pl_expr wrong[] = {
      pl_sub(p, SQ(SIN(x)), SQ(COS(x))),         pl_sub(p, SIN(TIMES(2, x)), TIMES(2, SIN(x))),
      pl_sub(p, pl_sqrt(p, SQ(x)), x),           pl_sub(p, SIN(x), x),
      pl_sub(p, pl_call(p, PL_COSH, x), COS(x)), pl_sub(p, pl_add(p, x, y), pl_mul(p, x, y))};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    bool refuted = false;
    for (uint64_t seed = 1; seed < 40 && !refuted; seed++) {
      bool ok = false;
      refuted = pl_eval_mod(pl_mod_point_make(a, p, seed), wrong[i], &ok) != 0 && ok;
    }
    assert_true(refuted);
  }
}

PL_TEST(bad_points_are_reported) {
  pl_expr x = kit_coordinate(p, "x");
  pl_mod_point* m = pl_mod_point_make(a, p, 11);
  bool ok = true;
  pl_mod_point_set(m, pl_symbol_of(p, x), 0);
  pl_eval_mod(m, pl_div(p, pl_int(p, 1), x), &ok);
  assert_false(ok);
  pl_eval_mod(m, pl_infinity(p), &ok);
  assert_false(ok);
  pl_eval_mod(m, pl_poison(), &ok);
  assert_false(ok);
  pl_eval_mod(m, pl_pow_int(p, pl_int(p, 3), 5), &ok);
  assert_true(ok);
}

PL_TEST(a_value_that_is_set_is_used_at_once) {
  pl_expr x = kit_coordinate(p, "x"), e = pl_add(p, SQ(x), pl_int(p, 1));
  pl_mod_point* m = pl_mod_point_make(a, p, 12);
  bool ok = false;
  pl_eval_mod(m, e, &ok);
  pl_mod_point_set(m, pl_symbol_of(p, x), 5);
  assert_int_equal(pl_eval_mod(m, e, &ok), 26);
  pl_mod_point_set(m, pl_symbol_of(p, x), 6);
  assert_int_equal(pl_eval_mod(m, e, &ok), 37);
}

PL_TEST(a_point_knows_names_that_come_later) {
  pl_mod_point* m = pl_mod_point_make(a, p, 13);
  bool ok = false;
  uint64_t last = 0;
  for (int i = 0; i < 200; i++) {
    char name[16];
    snprintf(name, sizeof name, "q%d", i);
    uint64_t value = pl_eval_mod(m, kit_coordinate(p, name), &ok);
    assert_true(ok && value != last);
    last = value;
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(values_outside_the_domain_are_nan),
      cmocka_unit_test(cases_look_at_the_sign_only),
      cmocka_unit_test(sums_run_over_their_bounds),
      cmocka_unit_test(identities_of_angles_vanish),
      cmocka_unit_test(identities_at_fixed_angles_vanish),
      cmocka_unit_test(identities_of_inverse_functions_vanish),
      cmocka_unit_test(identities_of_exponentials_vanish),
      cmocka_unit_test(roots_choose_one_branch),
      cmocka_unit_test(what_is_not_zero_is_refuted),
      cmocka_unit_test(bad_points_are_reported),
      cmocka_unit_test(a_value_that_is_set_is_used_at_once),
      cmocka_unit_test(a_point_knows_names_that_come_later),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
