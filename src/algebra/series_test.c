// Series, limits and antiderivatives.
#include "algebra/algebra_test_text.h"

// "lead: c0, c1, ..." of the first n terms around `at` ("inf" for infinity); "none" when not found.
static const char* series(pl_world* w, const char* text, const char* at, int n) {
  int lead = 0;
  pl_expr c[8];
  pl_expr point = strcmp(at, "inf") == 0 ? pl_infinity(w->pool) : pl_text_expr(w, at);
  if (!pl_alg_series(w->tower, pl_text_expr(w, text), pl_text_symbol(w, "x"), point, n, &lead, c))
    return "none";
  pl_text out = pl_text_make(w->arena);
  pl_text_addf(&out, "%d:", lead);
  for (int i = 0; i < n; i++) pl_text_addf(&out, "%s %s", i ? "," : "", pl_text_of(w, c[i]));
  return pl_text_string(&out);
}

static const char* limit(pl_world* w, const char* text, const char* to) {
  pl_expr point = strcmp(to, "inf") == 0 ? pl_infinity(w->pool) : pl_text_expr(w, to);
  return pl_text_of(w,
                    pl_alg_limit(w->tower, pl_text_expr(w, text), pl_text_symbol(w, "x"), point));
}

#define SERIES(w, in, at, n, out) assert_string_equal(series(w, in, at, n), out)
#define LIMIT(w, in, to, out)     assert_string_equal(limit(w, in, to), out)

PL_TEST(atwood_in_powers_of_the_mass_ratio) {
  pl_world* w = pl_world_make(NULL);
  // g (m1 - m2)/(m1 + m2) with m2 = x m1
  SERIES(w, "g*(m1 - x*m1)/(m1 + x*m1)", "0", 4, "0: g, -2*g, 2*g, -2*g");
  // m1 = m2 + x
  SERIES(w, "g*x/(2*m2 + x)", "0", 2, "1: g/(2*m2), -g/(4*m2^2)");
  pl_world_free(w);
}

PL_TEST(elementary_functions_have_their_series) {
  pl_world* w = pl_world_make(NULL);
  SERIES(w, "sin(x)", "0", 3, "1: 1, 0, -1/6");
  SERIES(w, "tan(x)", "0", 5, "1: 1, 0, 1/3, 0, 2/15");
  SERIES(w, "exp(sin(x))", "0", 5, "0: 1, 1, 1/2, 0, -1/8");
  SERIES(w, "ln(1 + x)", "0", 3, "1: 1, -1/2, 1/3");
  SERIES(w, "asin(x)", "0", 5, "1: 1, 0, 1/6, 0, 3/40");
  SERIES(w, "asinh(x)", "0", 5, "1: 1, 0, -1/6, 0, 3/40");
  SERIES(w, "cosh(x)", "0", 3, "0: 1, 0, 1/2");
  SERIES(w, "1/x", "l", 3, "0: 1/l, -1/l^2, 1/l^3");
  pl_world_free(w);
}

PL_TEST(poles_and_cancellations_are_seen) {
  pl_world* w = pl_world_make(NULL);
  SERIES(w, "1/sin(x)", "0", 3, "-1: 1, 0, 1/6");
  SERIES(w, "1/(x^2 - x^3)", "0", 3, "-2: 1, 1, 1");
  SERIES(w, "cos(x) - 1 + x^2/2", "0", 2, "4: 1/24, 0");
  SERIES(w, "x - x", "0", 2, "0: 0, 0");
  SERIES(w, "ln(x)", "0", 2, "none");
  SERIES(w, "sqrt(x)", "0", 2, "none");
  pl_world_free(w);
}

PL_TEST(roots_are_expanded) {
  pl_world* w = pl_world_make("l - r");
  SERIES(w, "sqrt(l^2 - r^2*sin(x)^2)", "0", 3, "0: l, 0, -r^2/(2*l)");
  SERIES(w, "sqrt(x^2 + 1)", "inf", 4, "-1: 1, 0, 1/2, 0");
  pl_world_free(w);
}

PL_TEST(limits_are_leading_terms) {
  pl_world* w = pl_world_make(NULL);
  LIMIT(w, "(m1 - x)/(m1 + x)", "inf", "-1");
  LIMIT(w, "(m1 - x)/(m1 + x)", "0", "1");
  LIMIT(w, "sin(x)/x", "0", "1");
  LIMIT(w, "(1 - cos(x))/x^2", "0", "1/2");
  LIMIT(w, "sqrt(x^2 + x) - x", "inf", "1/2");
  LIMIT(w, "sqrt(x^2)/x", "0", "1");
  LIMIT(w, "m1/x", "0", "infinity");
  LIMIT(w, "-m1*x", "inf", "-infinity");
  LIMIT(w, "exp(-m1*x)*l + g", "inf", "g");
  LIMIT(w, "tanh(m1*x)", "inf", "1");
  LIMIT(w, "atan(m1*x)", "inf", "pi/2");
  LIMIT(w, "sin(x)", "inf", "poison");
  pl_world_free(w);
}

PL_TEST(antiderivatives_differentiate_back) {
  static const char* const texts[] = {
      "m1*x^2 + 3",          "x*sin(l*x)",
      "exp(-m1*x)*cos(l*x)", "sin(x)^2",
      "1/(m1*x + l)",        "cos(l*x + r)",
      "x*exp(-x/l)",         "x^3*exp(x)*sin(x)",
      "cos(x)^3*sin(x)^2",   "g",
      "1/(x + l)^3",         "x^2*cos(x)*cos(2*x)",
      "exp(x)/(m1 + m2)",
  };
  pl_world* w = pl_world_make(NULL);
  pl_symbol x = pl_text_symbol(w, "x");
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    pl_expr e = pl_text_expr(w, texts[i]);
    pl_expr integral = pl_alg_integral(w->tower, e, x);
    if (pl_is_poison(integral)) fail_msg("no antiderivative of %s", texts[i]);
    pl_answer3 same = pl_alg_equal(w->tower, pl_diff(w->pool, integral, x), e);
    if (same != PL_YES) fail_msg("%s: %s", texts[i], pl_text_of(w, integral));
  }
  assert_true(pl_is_poison(pl_alg_integral(w->tower, pl_text_expr(w, "exp(x^2)"), x)));
  assert_true(pl_is_poison(pl_alg_integral(w->tower, pl_text_expr(w, "1/sin(x)"), x)));
  pl_world_free(w);
}

PL_TEST(a_series_agrees_with_the_function_to_its_order) {
  pl_world* w = pl_world_make(NULL);
  pl_random r = {7};
  pl_symbol x = pl_text_symbol(w, "x");
  int found = 0;
  for (int i = 0; i < 30; i++) {
    pl_expr e = pl_random_expr(w, &r, 2), c[4];
    int lead = 0;
    if (!pl_alg_series(w->tower, e, x, pl_int(w->pool, 0), 3, &lead, c)) continue;
    found++;
    // what is left, divided by the last power kept, goes to zero
    for (int k = 0; k < 3; k++) {
      e = pl_sub(w->pool, e,
                 pl_mul(w->pool, c[k], pl_pow_int(w->pool, pl_sym(w->pool, x), lead + k)));
    }
    pl_expr rest = pl_div(w->pool, e, pl_pow_int(w->pool, pl_sym(w->pool, x), lead + 2));
    pl_expr end = pl_alg_limit(w->tower, rest, x, pl_int(w->pool, 0));
    if (!pl_is_zero_node(w->pool, end)) fail_msg("seed 7 round %d: %s", i, pl_text_of(w, rest));
  }
  assert_true(found > 20);
  pl_world_free(w);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(atwood_in_powers_of_the_mass_ratio),
      cmocka_unit_test(elementary_functions_have_their_series),
      cmocka_unit_test(poles_and_cancellations_are_seen),
      cmocka_unit_test(roots_are_expanded),
      cmocka_unit_test(limits_are_leading_terms),
      cmocka_unit_test(antiderivatives_differentiate_back),
      cmocka_unit_test(a_series_agrees_with_the_function_to_its_order),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
