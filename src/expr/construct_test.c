// What the constructors do, and what they leave alone.
#include "expr/expr_test_kit.h"

PL_TEST(equal_construction_gives_the_equal_handle) {
  pl_expr x = kit_coordinate(p, "x"), y = kit_coordinate(p, "y");
  pl_expr s = pl_add(p, pl_mul(p, x, y), pl_int(p, 1)),
          t = pl_add(p, pl_int(p, 1), pl_mul(p, y, x));
  assert_true(pl_same(s, t));
  assert_false(pl_same(s, pl_add(p, x, y)));
}

PL_TEST(sums_collect_like_terms) {
  pl_expr x = kit_coordinate(p, "x"), y = kit_coordinate(p, "y");
  assert_text(pl_add(p, pl_mul(p, pl_int(p, 2), x), x), "3*x");
  assert_text(pl_sub(p, pl_add(p, x, y), pl_add(p, x, y)), "0");
  assert_text(pl_sub(p, x, pl_sub(p, y, x)), "2*x - y");
  assert_text(pl_add(p, pl_mul(p, pl_ratio(p, 1, 2), x), pl_mul(p, pl_ratio(p, 1, 3), x)), "5*x/6");
}

PL_TEST(a_bracket_with_a_coefficient_stays) {
  pl_expr s = pl_add(p, kit_coordinate(p, "x"), kit_coordinate(p, "y"));
  pl_expr twice = pl_mul(p, pl_int(p, 2), s);
  assert_text(twice, "2*(x + y)");
  assert_text(pl_neg(p, s), "-(x + y)");
  assert_true(pl_same(pl_sub(p, pl_mul(p, pl_int(p, 3), s), twice), s));
}

PL_TEST(products_collect_like_factors) {
  pl_expr x = kit_coordinate(p, "x"), y = kit_coordinate(p, "y");
  assert_text(pl_mul(p, pl_mul(p, x, y), x), "x^2*y");
  assert_text(pl_div(p, pl_mul(p, x, y), x), "y");
  assert_true(pl_same(pl_mul(p, pl_sqrt(p, x), pl_sqrt(p, x)), x));
  assert_text(pl_pow_int(p, pl_mul(p, x, y), 3), "x^3*y^3");
  assert_text(pl_pow_int(p, pl_pow_int(p, x, 2), 3), "x^6");
  assert_text(pl_pow(p, x, pl_int(p, 0)), "1");
}

PL_TEST(powers_of_unknown_sign_are_not_simplified) {
  pl_expr x = kit_coordinate(p, "x"), y = kit_coordinate(p, "y");
  assert_text(pl_sqrt(p, pl_square(p, x)), "sqrt(x^2)");
  assert_text(pl_sqrt(p, pl_mul(p, x, y)), "sqrt(x*y)");
  assert_true(pl_same(pl_square(p, pl_sqrt(p, x)), x));
}

PL_TEST(roots_of_numbers_have_one_form) {
  assert_text(pl_sqrt(p, pl_int(p, 12)), "2*sqrt(3)");
  assert_text(pl_sqrt(p, pl_ratio(p, 4, 9)), "2/3");
  assert_text(pl_div(p, pl_int(p, 1), pl_sqrt(p, pl_int(p, 2))), "sqrt(2)/2");
  assert_text(pl_mul(p, pl_sqrt(p, pl_int(p, 2)), pl_sqrt(p, pl_int(p, 6))), "2*sqrt(3)");
  assert_text(pl_pow(p, pl_int(p, 54), pl_ratio(p, 1, 3)), "3*2^(1/3)");
  assert_text(pl_pow(p, pl_int(p, 2), pl_ratio(p, -7, 2)), "sqrt(2)/16");
  assert_true(pl_is_poison(pl_sqrt(p, pl_int(p, -4))));
}

PL_TEST(roots_of_products_give_up_their_squares) {
  pl_expr x = kit_coordinate(p, "x");
  assert_text(pl_sqrt(p, pl_mul(p, pl_int(p, 12), x)), "2*sqrt(3*x)");
  assert_text(pl_sqrt(p, pl_mul(p, pl_ratio(p, -3, 4), x)), "sqrt(-3*x)/2");
}

PL_TEST(merged_roots_are_in_order) {
  pl_expr cube = pl_pow(p, pl_int(p, 5), pl_ratio(p, 1, 3));
  pl_expr one = pl_mul_n(p, (pl_expr[]){pl_sqrt(p, pl_int(p, 2)), cube, pl_sqrt(p, pl_int(p, 3))},
                         3);
  assert_true(pl_same(one, pl_mul(p, pl_sqrt(p, pl_int(p, 6)), cube)));
}

PL_TEST(division_by_zero_is_poison_and_spreads) {
  pl_expr x = kit_coordinate(p, "x");
  pl_expr bad = pl_div(p, x, pl_sub(p, x, x));
  assert_true(pl_is_poison(bad));
  assert_true(pl_is_poison(pl_add(p, x, bad)));
  assert_true(pl_is_poison(pl_mul(p, pl_int(p, 0), bad)));
  assert_true(pl_is_poison(pl_pow(p, bad, pl_int(p, 0))));
  assert_true(pl_is_poison(pl_call(p, PL_SIN, bad)));
  assert_true(pl_is_poison(pl_ratio(p, 1, 0)));
  assert_true(pl_is_poison(pl_diff(p, bad, pl_symbol_of(p, x))));
}

PL_TEST(angles_at_special_places_are_exact) {
  pl_expr pi = pl_pi(p);
  assert_text(pl_call(p, PL_COS, pl_mul(p, pl_ratio(p, 1, 3), pi)), "1/2");
  assert_text(pl_call(p, PL_SIN, pl_mul(p, pl_ratio(p, -7, 4), pi)), "sqrt(2)/2");
  assert_text(pl_call(p, PL_TAN, pl_mul(p, pl_ratio(p, 5, 6), pi)), "-sqrt(3)/3");
  assert_true(pl_is_poison(pl_call(p, PL_TAN, pl_mul(p, pl_ratio(p, 3, 2), pi))));
  assert_text(pl_call(p, PL_SIN, pl_mul(p, pl_ratio(p, 1, 5), pi)), "sin(pi/5)");
  assert_text(pl_call(p, PL_ACOS, pl_ratio(p, -1, 2)), "2*pi/3");
  assert_text(pl_call(p, PL_ACOS, pl_ratio(p, 2, 3)), "acos(2/3)");
  assert_text(pl_call(p, PL_ATAN, pl_neg(p, pl_sqrt(p, pl_int(p, 3)))), "-pi/3");
}

PL_TEST(functions_know_their_parity) {
  pl_expr x = kit_coordinate(p, "x"), y = kit_coordinate(p, "y");
  pl_expr d = pl_sub(p, x, y), e = pl_sub(p, y, x);
  assert_true(pl_same(pl_call(p, PL_COS, d), pl_call(p, PL_COS, e)));
  assert_true(pl_same(pl_call(p, PL_SIN, d), pl_neg(p, pl_call(p, PL_SIN, e))));
  assert_true(pl_same(pl_call(p, PL_ABS, d), pl_call(p, PL_ABS, e)));
  assert_true(pl_same(pl_call(p, PL_SIN, pl_mul(p, pl_int(p, 2), d)),
                      pl_neg(p, pl_call(p, PL_SIN, pl_mul(p, pl_int(p, 2), e)))));
  assert_text(pl_call(p, PL_ABS, pl_mul(p, pl_int(p, -2), x)), "2*abs(x)");
  assert_text(pl_call(p, PL_SIGN, pl_mul(p, pl_int(p, -2), x)), "-sign(x)");
}

PL_TEST(functions_undo_their_inverses) {
  pl_expr x = kit_coordinate(p, "x");
  pl_function pairs[][2] = {
      {PL_SIN, PL_ASIN}, {PL_COS, PL_ACOS}, {PL_TAN, PL_ATAN}, {PL_EXP, PL_LN}};
  for (int i = 0; i < 4; i++) assert_text(pl_call(p, pairs[i][0], pl_call(p, pairs[i][1], x)), "x");
  assert_text(pl_call(p, PL_TAN, pl_call(p, PL_ATAN, pl_neg(p, x))), "-x");
  assert_text(pl_call(p, PL_COS, pl_call(p, PL_ASIN, pl_neg(p, x))), "sqrt(-x^2 + 1)");
  assert_text(pl_call(p, PL_SIN, pl_neg(p, pl_call(p, PL_ACOS, x))), "-sqrt(-x^2 + 1)");
}

PL_TEST(shifts_by_quarter_turns_are_taken_out) {
  pl_expr x = kit_coordinate(p, "x"), quarter = pl_mul(p, pl_ratio(p, 1, 2), pl_pi(p));
  assert_text(pl_call(p, PL_COS, pl_add(p, x, quarter)), "-sin(x)");
  assert_text(pl_call(p, PL_SIN, pl_sub(p, pl_pi(p), x)), "sin(x)");
  assert_text(pl_call(p, PL_TAN, pl_add(p, x, pl_pi(p))), "tan(x)");
}

PL_TEST(infinity_behaves_as_in_limits) {
  pl_expr inf = pl_infinity(p), x = kit_coordinate(p, "x");
  assert_true(pl_same(pl_add(p, inf, x), inf));
  assert_true(pl_is_poison(pl_sub(p, inf, inf)));
  assert_true(pl_is_poison(pl_mul(p, pl_int(p, 0), inf)));
  assert_text(pl_mul(p, pl_int(p, -3), inf), "-infinity");
  assert_text(pl_div(p, x, inf), "0");
  assert_text(pl_call(p, PL_EXP, pl_neg(p, inf)), "0");
}

// The same expression over names that were made first to last, or last to first.
static const char* text_over_names(pl_arena* a, bool backwards) {
  static const char* const names[] = {"m10", "b", "m2", "a", "zeta", "m1"};
  pl_pool* q = pl_pool_make(a);
  pl_expr e[6];
  for (int i = 0; i < 6; i++) {
    int k = backwards ? 5 - i : i;
    e[k] = kit_parameter(q, names[k], PL_C_OTHER);
  }
  pl_expr s = pl_add_n(q, e, 6);
  return pl_expr_text(a, q, pl_mul(q, pl_call(q, PL_SIN, pl_mul(q, s, e[0])), pl_pow(q, s, e[3])));
}

PL_TEST(order_depends_on_names_and_not_on_age) {
  const char* text = text_over_names(a, false);
  assert_string_equal(text, text_over_names(a, true));
  assert_non_null(strstr(text, "a + b + m1 + m2 + m10 + zeta"));
}

PL_TEST(cases_and_patterns_fold_when_they_are_decided) {
  pl_expr x = kit_coordinate(p, "x"), i = kit_index(p, "i");
  assert_true(pl_same(pl_if(p, pl_int(p, 1), x, i), x));
  assert_true(pl_same(pl_if(p, pl_int(p, 0), x, i), i));
  assert_text(pl_if(p, x, pl_int(p, 1), pl_int(p, 2)), "if(x > 0, 1, 2)");
  assert_text(pl_sum_over(p, pl_symbol_of(p, i), pl_int(p, 3), pl_int(p, 2), x), "0");
  assert_text(pl_sum_over(p, pl_symbol_of(p, i), pl_int(p, 1), x, pl_square(p, i)),
              "sum(i in 1..x, i^2)");
}

PL_TEST(names_that_belong_to_a_coordinate_avoid_names_that_are_taken) {
  pl_expr taken = kit_parameter(p, "x_dot", PL_C_OTHER), x = kit_coordinate(p, "x");
  pl_symbol v = pl_symbol_dot(p, pl_symbol_of(p, x));
  assert_int_not_equal(v.id, pl_symbol_of(p, taken).id);
  assert_string_equal(pl_symbol_get(p, v)->ascii, "x_dot_");
  assert_int_equal(pl_symbol_get(p, v)->role, PL_R_VELOCITY);
  assert_int_equal(pl_symbol_dot(p, pl_symbol_of(p, x)).id, v.id);
  pl_symbol start = pl_symbol_start(p, v);
  assert_int_equal(pl_symbol_get(p, start)->base.id, pl_symbol_of(p, x).id);
  assert_int_equal(pl_symbol_get(p, start)->dots, 1);
  assert_int_equal(pl_symbol_start(p, v).id, start.id);
}

PL_TEST(text_reads_back_in_every_corner) {
  pl_expr x = kit_coordinate(p, "x"), y = kit_coordinate(p, "y"), s = pl_add(p, x, y);
  assert_text(pl_pow(p, pl_int(p, -2), x), "(-2)^x");
  assert_text(pl_pow(p, pl_ratio(p, 3, 4), x), "(3/4)^x");
  assert_text(pl_pow(p, x, pl_neg(p, y)), "x^(-y)");
  assert_text(pl_pow(p, x, pl_ratio(p, -2, 3)), "1/x^(2/3)");
  assert_text(pl_pow(p, pl_pow(p, x, y), pl_ratio(p, 2, 3)), "(x^y)^(2/3)");
  assert_text(pl_div(p, x, pl_mul(p, pl_int(p, 2), s)), "x/(2*(x + y))");
  assert_text(pl_div(p, pl_int(p, 3), pl_mul(p, x, y)), "3/(x*y)");
  assert_text(pl_pow_int(p, s, -2), "1/(x + y)^2");
  assert_text(pl_pow(p, pl_mul(p, x, y), pl_ratio(p, -1, 2)), "1/sqrt(x*y)");
  assert_text(pl_sub(p, pl_square(p, x), pl_ratio(p, 3, 4)), "x^2 - 3/4");
  assert_text(pl_square(p, pl_pi(p)), "pi^2");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(equal_construction_gives_the_equal_handle),
      cmocka_unit_test(sums_collect_like_terms),
      cmocka_unit_test(a_bracket_with_a_coefficient_stays),
      cmocka_unit_test(products_collect_like_factors),
      cmocka_unit_test(powers_of_unknown_sign_are_not_simplified),
      cmocka_unit_test(roots_of_numbers_have_one_form),
      cmocka_unit_test(roots_of_products_give_up_their_squares),
      cmocka_unit_test(merged_roots_are_in_order),
      cmocka_unit_test(division_by_zero_is_poison_and_spreads),
      cmocka_unit_test(angles_at_special_places_are_exact),
      cmocka_unit_test(functions_know_their_parity),
      cmocka_unit_test(functions_undo_their_inverses),
      cmocka_unit_test(shifts_by_quarter_turns_are_taken_out),
      cmocka_unit_test(infinity_behaves_as_in_limits),
      cmocka_unit_test(order_depends_on_names_and_not_on_age),
      cmocka_unit_test(cases_and_patterns_fold_when_they_are_decided),
      cmocka_unit_test(names_that_belong_to_a_coordinate_avoid_names_that_are_taken),
      cmocka_unit_test(text_reads_back_in_every_corner),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
