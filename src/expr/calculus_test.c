// Derivatives, substitution and expansion, case by case; the laws on random input are in
// expr_laws_test.c.
#include "expr/expr_test_kit.h"

static pl_symbol name_of(pl_pool* p, pl_expr e) { return pl_symbol_of(p, e); }

PL_TEST(every_function_has_its_derivative) {
  pl_expr x = kit_coordinate(p, "x");
  const char* wanted[] = {"cos(x)",
                          "-sin(x)",
                          "1/cos(x)^2",
                          "1/sqrt(-x^2 + 1)",
                          "-1/sqrt(-x^2 + 1)",
                          "1/(x^2 + 1)",
                          NULL,
                          "cosh(x)",
                          "sinh(x)",
                          "1/cosh(x)^2",
                          "exp(x)",
                          "1/x",
                          "sign(x)",
                          "0",
                          NULL,
                          NULL,
                          "1/sqrt(x^2 + 1)"};
  assert_int_equal(sizeof wanted / sizeof *wanted, PL_N_FUNCTIONS);
  for (int f = 0; f < PL_N_FUNCTIONS; f++) {
    if (pl_function_arity[f] == 1)
      assert_text(pl_diff(p, pl_call(p, (pl_function)f, x), name_of(p, x)), wanted[f]);
  }
}

PL_TEST(functions_of_two_arguments_have_derivatives) {
  pl_expr x = kit_coordinate(p, "x"), y = kit_coordinate(p, "y");
  assert_text(pl_diff(p, pl_call2(p, PL_ATAN2, y, x), name_of(p, y)), "x/(x^2 + y^2)");
  assert_text(pl_diff(p, pl_call2(p, PL_MIN, x, y), name_of(p, x)), "if(-x + y > 0, 1, 0)");
  assert_text(pl_diff(p, pl_call2(p, PL_MAX, x, y), name_of(p, y)), "if(x - y > 0, 0, 1)");
  assert_text(pl_diff(p, pl_pow(p, x, y), name_of(p, y)), "x^y*ln(x)");
}

PL_TEST(a_case_is_differentiated_branch_by_branch) {
  pl_expr x = kit_coordinate(p, "x");
  assert_text(pl_diff(p, pl_if(p, x, pl_square(p, x), x), name_of(p, x)), "if(x > 0, 2*x, 1)");
}

PL_TEST(time_adds_dots) {
  pl_expr x = kit_coordinate(p, "x"), m = kit_parameter(p, "m", PL_C_MASS),
          t = pl_sym(p, pl_time(p));
  pl_expr rate = pl_dt(p, pl_mul(p, m, pl_square(p, x)));
  assert_text(rate, "2*m*x*x_dot");
  assert_text(pl_dt(p, rate), "2*m*x*x_ddot + 2*m*x_dot^2");
  assert_text(pl_dt(p, pl_mul(p, m, t)), "m");
}

PL_TEST(what_has_no_known_rate_is_poison_in_time) {
  pl_role roles[] = {PL_R_MULTIPLIER, PL_R_MOMENTUM, PL_R_LOCAL};
  for (int i = 0; i < 3; i++) {
    char name[8];
    snprintf(name, sizeof name, "u%d", i);
    assert_true(pl_is_poison(pl_dt(p, kit_symbol(p, name, roles[i], PL_C_OTHER, PL_SIGN_ANY))));
  }
}

PL_TEST(elements_of_families_are_atoms) {
  pl_expr x = kit_family(p, "x"), i = kit_index(p, "i");
  pl_expr here = pl_at(p, name_of(p, x), 0, i),
          before = pl_at(p, name_of(p, x), 0, pl_sub(p, i, pl_int(p, 1)));
  pl_expr d = pl_square(p, pl_sub(p, here, before));
  assert_true(
      kit_equal(p, pl_diff_at(p, d, here), pl_mul(p, pl_int(p, 2), pl_sub(p, here, before)), 1));
  assert_true(
      kit_equal(p, pl_diff_at(p, d, before), pl_mul(p, pl_int(p, 2), pl_sub(p, before, here)), 2));
  assert_text(pl_dt(p, here), "x[i]'");
  assert_text(pl_dt(p, pl_dt(p, before)), "x[i - 1]''");
  assert_true(pl_has_role(p, pl_dt(p, here), PL_R_VELOCITY));
  assert_text(pl_subst1(p, before, name_of(p, i), pl_int(p, 5)), "x[4]");
}

PL_TEST(a_sum_over_an_index_keeps_its_pattern) {
  pl_expr x = kit_family(p, "x"), i = kit_index(p, "i");
  pl_expr n = kit_parameter(p, "N", PL_C_OTHER), m = kit_parameter(p, "m", PL_C_MASS);
  pl_expr body = pl_mul(p, m, pl_square(p, pl_at(p, name_of(p, x), 0, i)));
  pl_expr s = pl_sum_over(p, name_of(p, i), pl_int(p, 1), n, body);
  assert_text(pl_dt(p, s), "sum(i in 1..N, 2*m*x[i]*x[i]')");
  assert_text(pl_diff(p, s, name_of(p, m)), "sum(i in 1..N, x[i]^2)");
  // one element of the family that the sum runs over would need a Kronecker delta
  assert_true(pl_is_poison(pl_diff_at(p, s, pl_at(p, name_of(p, x), 0, pl_int(p, 3)))));
}

PL_TEST(a_bound_index_is_not_replaced_and_catches_nothing) {
  pl_expr i = kit_index(p, "i"), n = kit_parameter(p, "N", PL_C_OTHER), x = kit_coordinate(p, "x");
  pl_expr s = pl_sum_over(p, name_of(p, i), pl_int(p, 1), n, pl_mul(p, i, x));
  assert_true(pl_same(pl_subst1(p, s, name_of(p, i), pl_int(p, 7)), s));
  assert_text(pl_subst1(p, s, name_of(p, n), pl_int(p, 3)), "sum(i in 1..3, i*x)");
  assert_true(pl_is_poison(pl_subst1(p, s, name_of(p, x), i)));
  pl_replace numbers[] = {{name_of(p, n), pl_int(p, 4)}, {name_of(p, x), pl_int(p, 3)}};
  assert_true(pl_eval(p, pl_subst(p, s, numbers, 2), NULL) == 30);
}

PL_TEST(substitution_is_simultaneous) {
  pl_expr x = kit_coordinate(p, "x"), y = kit_coordinate(p, "y");
  pl_expr e = pl_sub(p, x, pl_mul(p, pl_int(p, 2), y));
  assert_text(pl_subst(p, e, (pl_replace[]){{name_of(p, x), y}, {name_of(p, y), x}}, 2),
              "-2*x + y");
}

PL_TEST(a_node_is_replaced_wherever_it_stands) {
  pl_expr x = kit_coordinate(p, "x"), c = pl_call(p, PL_COS, x), u = kit_coordinate(p, "u");
  pl_expr e = pl_add(p, pl_mul(p, c, x), pl_call(p, PL_SIN, c));
  assert_text(pl_subst_expr(p, e, c, u), "u*x + sin(u)");
}

PL_TEST(a_substitution_that_divides_by_zero_is_poison) {
  pl_expr x = kit_coordinate(p, "x"), y = kit_coordinate(p, "y");
  assert_true(pl_is_poison(
      pl_subst1(p, pl_div(p, y, pl_sub(p, x, pl_int(p, 1))), name_of(p, x), pl_int(p, 1))));
}

PL_TEST(expansion_multiplies_out) {
  pl_expr x = kit_coordinate(p, "x"), y = kit_coordinate(p, "y"), s = pl_add(p, x, y),
          d = pl_sub(p, x, y);
  assert_text(pl_expand(p, pl_square(p, s), 100), "x^2 + 2*x*y + y^2");
  assert_text(pl_expand(p, pl_mul(p, s, d), 100), "x^2 - y^2");
  assert_text(pl_expand(p, pl_sub(p, pl_square(p, s), pl_expand(p, pl_square(p, s), 100)), 100),
              "0");
  assert_text(pl_expand(p, pl_mul(p, pl_int(p, 2), s), 100), "2*x + 2*y");
  assert_text(pl_expand(p, pl_mul(p, x, pl_square(p, pl_mul(p, y, s))), 100),
              "x^3*y^2 + 2*x^2*y^3 + x*y^4");
}

PL_TEST(expansion_beyond_the_limit_changes_nothing) {
  pl_expr x = kit_coordinate(p, "x"), y = kit_coordinate(p, "y"),
          e = pl_pow_int(p, pl_add(p, x, y), 20);
  assert_true(pl_same(pl_expand(p, e, 20), e));
  assert_int_equal(pl_n_args(p, pl_expand(p, e, 21)), 21);
  pl_expr huge = pl_pow_int(p, pl_add(p, x, y), 1000000000);
  assert_true(pl_same(pl_expand(p, huge, 1000), huge));
}

PL_TEST(expansion_leaves_functions_and_denominators_alone) {
  pl_expr x = kit_coordinate(p, "x"), y = kit_coordinate(p, "y"), s = pl_add(p, x, y);
  pl_expr angle = pl_call(p, PL_COS, pl_mul(p, pl_int(p, 2), s));
  assert_true(pl_same(pl_expand(p, angle, 100), angle));
  assert_text(pl_expand(p, pl_div(p, s, pl_square(p, s)), 100), "1/(x + y)");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_function_has_its_derivative),
      cmocka_unit_test(functions_of_two_arguments_have_derivatives),
      cmocka_unit_test(a_case_is_differentiated_branch_by_branch),
      cmocka_unit_test(time_adds_dots),
      cmocka_unit_test(what_has_no_known_rate_is_poison_in_time),
      cmocka_unit_test(elements_of_families_are_atoms),
      cmocka_unit_test(a_sum_over_an_index_keeps_its_pattern),
      cmocka_unit_test(a_bound_index_is_not_replaced_and_catches_nothing),
      cmocka_unit_test(substitution_is_simultaneous),
      cmocka_unit_test(a_node_is_replaced_wherever_it_stands),
      cmocka_unit_test(a_substitution_that_divides_by_zero_is_poison),
      cmocka_unit_test(expansion_multiplies_out),
      cmocka_unit_test(expansion_beyond_the_limit_changes_nothing),
      cmocka_unit_test(expansion_leaves_functions_and_denominators_alone),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
