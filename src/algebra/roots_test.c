// Roots of equations in one symbol, as models need them: elimination of constraints, positions of
// events.
#include "algebra/algebra_test_text.h"

// The roots as text, "a; b", with " if c" where a condition stays, and " ..." when there may be
// more.
static const char* roots(pl_world* w, const char* x, const char* text) {
  pl_root r[16];
  bool complete = false;
  int n = pl_alg_roots(w->tower, pl_text_expr(w, text), pl_text_symbol(w, x), r, 16, &complete);
  pl_text out = pl_text_make(w->arena);
  for (int i = 0; i < n; i++) {
    pl_text_addf(&out, "%s%s", i ? "; " : "", pl_text_of(w, r[i].value));
    if (!pl_is_poison(r[i].condition)) pl_text_addf(&out, " if %s", pl_text_of(w, r[i].condition));
  }
  if (!complete) pl_text_add(&out, " ...");
  return pl_text_string(&out);
}

#define ROOTS(w, x, in, out) assert_string_equal(roots(w, x, in), out)

PL_TEST(polynomials_are_solved) {
  pl_world* w = pl_world_make(NULL);
  ROOTS(w, "x", "m1*x + g", "-g/m1");
  ROOTS(w, "x", "x^2 - 3*x + 2", "1; 2");
  ROOTS(w, "x", "x^2 - l^2", "-l; l");
  ROOTS(w, "x", "x^4 - 5*x^2 + 6", "-sqrt(2); sqrt(2); -sqrt(3); sqrt(3)");
  ROOTS(w, "x", "x^2 + 1", "");
  ROOTS(w, "x", "x^3 - 3*x + 1", " ...");
  ROOTS(w, "x", "y", " ...");
  ROOTS(w, "x", "1/(x - 1)", "");
  ROOTS(w, "x", "(x^2 - 1)/(x - 1)", "-1");
  pl_world_free(w);
}

PL_TEST(the_slider_of_a_crank_has_two_places) {
  pl_world* w = pl_world_make("l - r");
  pl_root r[4];
  bool complete = false;
  pl_expr e = pl_text_expr(w, "(x - r*cos(u))^2 + r^2*sin(u)^2 - l^2");
  pl_symbol x = pl_text_symbol(w, "x");
  assert_int_equal(pl_alg_roots(w->tower, e, x, r, 4, &complete), 2);
  assert_true(complete);
  for (int i = 0; i < 2; i++) {
    assert_true(pl_is_poison(r[i].condition));  // l > r proves that both are real
    assert_int_equal(pl_alg_is_zero(w->tower, pl_subst1(w->pool, e, x, r[i].value)), PL_YES);
  }
  pl_world_free(w);
}

PL_TEST(the_skier_leaves_at_two_thirds) {
  pl_world* w = pl_world_make(NULL);
  ROOTS(w, "x", "m*g*(3*cos(x) - 2)", "acos(2/3); -acos(2/3)");
  ROOTS(w, "x", "3*cos(x) - 4", "");  // no angle has this cosine
  const char* text = roots(w, "x", "m*g*(3*cos(x) - 2) - m*z^2/r");
  assert_non_null(strstr(text, "acos((2*g*r + z^2)/(3*g*r)) if "));
  pl_world_free(w);
}

PL_TEST(angles_are_found_in_both_branches) {
  pl_world* w = pl_world_make(NULL);
  ROOTS(w, "x", "2*sin(x) - 1", "pi/6; 5*pi/6");
  ROOTS(w, "x", "sin(x) + cos(x)", "-pi/4; 3*pi/4");
  ROOTS(w, "x", "tan(x) - m", "atan(m); pi + atan(m)");
  ROOTS(w, "t", "cos(r*t) - 1/2", "pi/(3*r); -pi/(3*r)");
  ROOTS(w, "x", "sin(x)*cos(x) - 1/4", "pi/12; -7*pi/12; 13*pi/12; 5*pi/12");
  pl_world_free(w);
}

PL_TEST(every_root_satisfies_its_equation) {
  static const char* const texts[] = {
      "m1*cos(x) + g*sin(x) - l",
      "sin(2*x) - sin(x)",
      "cos(2*x) + cos(x)",
      "g*sin(x) - r*z^2*sin(x)*cos(x)",
      "2*sin(x)^2 - 3*sin(x) + 1",
      "exp(2*x) - 3*exp(x) + 2",
      "sqrt(x + l) - x",
      "sqrt(l^2 - x^2) - r",
      "ln(x) - 2",
      "x^6 - 1",
      "abs(x) - l",
      "m1*x^2 + g*x - l",
  };
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    pl_world* w = pl_world_make(NULL);
    pl_expr e = pl_text_expr(w, texts[i]);
    pl_symbol x = pl_text_symbol(w, "x");
    pl_root r[16];
    bool complete = false;
    int n = pl_alg_roots(w->tower, e, x, r, 16, &complete);
    if (n == 0) fail_msg("no root of %s", texts[i]);
    for (int k = 0; k < n; k++) {
      pl_answer3 zero = pl_alg_is_zero(w->tower, pl_subst1(w->pool, e, x, r[k].value));
      if (zero != PL_YES)
        fail_msg("%s at %s: answer %d", texts[i], pl_text_of(w, r[k].value), zero);
    }
    pl_world_free(w);
  }
}

PL_TEST(false_roots_of_the_square_are_dropped) {
  pl_world* w = pl_world_make(NULL);
  ROOTS(w, "x", "sqrt(x + 2) - x", "2");  // x = -1 solves the square only
  ROOTS(w, "x", "sqrt(x + 2) + x", "-1");
  ROOTS(w, "x", "exp(2*x) - m", "ln(m)/2");
  pl_world_free(w);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(polynomials_are_solved),
      cmocka_unit_test(the_slider_of_a_crank_has_two_places),
      cmocka_unit_test(the_skier_leaves_at_two_thirds),
      cmocka_unit_test(angles_are_found_in_both_branches),
      cmocka_unit_test(every_root_satisfies_its_equation),
      cmocka_unit_test(false_roots_of_the_square_are_dropped),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
