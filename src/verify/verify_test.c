// Certificates: they agree with what is equal, separate what is not, and say so when they cannot
// tell.
#include "algebra/algebra_test_text.h"
#include "verify/verify.h"

PL_TEST(equal_expressions_are_certified_at_all_points) {
  pl_world* w = pl_world_make(NULL);
  pl_domain none = {0};
  pl_verifier* c = pl_verifier_make(&w->job, w->pool, &none);
  pl_verification r = pl_verify(c, pl_text_expr(w, "g*(m1 - m2)/(m1 + m2)"),
                                pl_text_expr(w, "g - 2*g*m2/(m2 + m1)"));
  assert_int_equal(r.equal, PL_YES);
  assert_int_equal(r.points_mod, 20);
  assert_int_equal(r.points_arb, 50);
  assert_true(r.worst < 1e-60);
  pl_world_free(w);
}

PL_TEST(a_wrong_sign_is_separated) {
  pl_world* w = pl_world_make(NULL);
  pl_domain none = {0};
  pl_verifier* c = pl_verifier_make(&w->job, w->pool, &none);
  assert_int_equal(pl_verify(c, pl_text_expr(w, "sin(x - y)"), pl_text_expr(w, "sin(y - x)")).equal,
                   PL_NO);
  assert_int_equal(pl_verify(c, pl_text_expr(w, "l"), pl_text_expr(w, "l + l/1000000000000")).equal,
                   PL_NO);
  assert_int_equal(pl_verify(c, pl_poison(), pl_text_expr(w, "l")).equal, PL_UNKNOWN);
  pl_world_free(w);
}

PL_TEST(the_points_decide_about_branches) {
  pl_world* w = pl_world_make(NULL);
  pl_domain none = {0};
  pl_verifier* c = pl_verifier_make(&w->job, w->pool, &none);
  assert_int_equal(pl_verify(c, pl_text_expr(w, "sqrt(l^2)"), pl_text_expr(w, "l")).equal, PL_YES);
  assert_int_equal(pl_verify(c, pl_text_expr(w, "sqrt(x^2)"), pl_text_expr(w, "x")).equal, PL_NO);
  // never real: nothing can be said
  pl_expr nowhere = pl_text_expr(w, "sqrt(-1 - x^2)");
  assert_int_equal(pl_verify(c, nowhere, nowhere).equal, PL_UNKNOWN);
  pl_world_free(w);
}

PL_TEST(the_points_lie_in_the_domain) {
  pl_world* w = pl_world_make(NULL);
  pl_fact facts[] = {{pl_text_expr(w, "l - r"), true},
                     {pl_text_expr(w, "d - l"), true},
                     {pl_text_expr(w, "2*r - d"), true}};
  pl_domain s = {.facts = facts, .n_facts = 3};
  pl_verifier* c = pl_verifier_make(&w->job, w->pool, &s);
  pl_verification r = pl_verify(c, pl_text_expr(w, "abs(l - r) + abs(2*r - d)"),
                                pl_text_expr(w, "l + r - d"));
  assert_int_equal(r.equal, PL_YES);
  assert_int_equal(r.points_arb, 50);
  pl_world_free(w);
}

// x2 = 6/5 - x1: the closed rope is zero but for rounding, at most points to the wrong side.
PL_TEST(a_fact_that_a_definition_makes_zero_holds) {
  pl_world* w = pl_world_make(NULL);
  pl_definition d = {pl_text_symbol(w, "x2"), pl_text_expr(w, "(6 - 5*x1)/5")};
  pl_fact facts[] = {{pl_text_expr(w, "-(x1 + x2 - 6/5)"), false},
                     {pl_text_expr(w, "-(x1 - 99/100)"), false},
                     {pl_text_expr(w, "5*x1 + 1"), false}};
  pl_domain s = {.definitions = &d, .n_definitions = 1, .facts = facts, .n_facts = 3};
  pl_verifier* c = pl_verifier_make(&w->job, w->pool, &s);
  pl_verification r = pl_verify(c, pl_text_expr(w, "abs(x2)"), pl_text_expr(w, "6/5 - x1"));
  assert_int_equal(r.equal, PL_YES);
  assert_int_equal(r.points_arb, 50);
  // a fact that has to be positive is not met
  facts[0].strict = true;
  pl_expr x1 = pl_text_expr(w, "x1");
  assert_int_equal(pl_verify(pl_verifier_make(&w->job, w->pool, &s), x1, x1).points_arb, 0);
  pl_world_free(w);
}

// Atwood: x2 = L - x1 by definition, accelerations and the force from the linear system.
PL_TEST(definitions_and_unknowns_take_their_values) {
  pl_world* w = pl_world_make(NULL);
  pl_definition d = {pl_text_symbol(w, "x2"), pl_text_expr(w, "l - x1")};
  pl_symbol unknowns[] = {pl_text_symbol(w, "a1"), pl_text_symbol(w, "a2"), pl_text_symbol(w, "p")};
  static const char* const A[] = {"m1", "0", "-1", "0", "m2", "-1", "1", "1", "0"};
  static const char* const b[] = {"m1*g", "m2*g", "0"};
  pl_expr M[9], rhs[3];
  for (int i = 0; i < 9; i++) M[i] = pl_text_expr(w, A[i]);
  for (int i = 0; i < 3; i++) rhs[i] = pl_text_expr(w, b[i]);
  pl_domain s = {.definitions = &d,
                 .n_definitions = 1,
                 .n_unknowns = 3,
                 .unknowns = unknowns,
                 .A = M,
                 .b = rhs};
  pl_verifier* c = pl_verifier_make(&w->job, w->pool, &s);
  pl_verification r = pl_verify(c, pl_text_expr(w, "-2*g*m1*m2/(m1 + m2)"), pl_text_expr(w, "p"));
  assert_int_equal(r.equal, PL_YES);
  assert_int_equal(r.points_mod, 20);
  assert_int_equal(pl_verify(c, pl_text_expr(w, "x1 + x2"), pl_text_expr(w, "l")).equal, PL_YES);
  assert_int_equal(pl_verify(c, pl_text_expr(w, "a1 - a2"), pl_text_expr(w, "0")).equal, PL_NO);
  pl_world_free(w);
}

PL_TEST(an_impossible_domain_is_unknown) {
  pl_world* w = pl_world_make(NULL);
  pl_fact facts[] = {{pl_text_expr(w, "l - r"), true}, {pl_text_expr(w, "r - l"), true}};
  pl_domain s = {.facts = facts, .n_facts = 2};
  pl_verifier* c = pl_verifier_make(&w->job, w->pool, &s);
  assert_int_equal(pl_verify(c, pl_text_expr(w, "l"), pl_text_expr(w, "l")).equal, PL_UNKNOWN);
  pl_world_free(w);
}

// One sign in eight is right for all three; the points are looked for where the functions have
// values.
PL_TEST(points_are_found_where_functions_have_values) {
  pl_world* w = pl_world_make(NULL);
  pl_domain s = {0};
  pl_verifier* c = pl_verifier_make(&w->job, w->pool, &s);
  const char* sum = "asin(x)/2 + ln(y)^(1/3) + acos(z/4)*sqrt(r)";
  pl_verification same = pl_verify(
      c, pl_text_expr(w, "(asin(x) + 2*ln(y)^(1/3))/2 + acos(z/4)*sqrt(r)"), pl_text_expr(w, sum));
  assert_int_equal(same.equal, PL_YES);
  assert_true(same.points_arb >= 40);
  assert_int_equal(
      pl_verify(c, pl_text_expr(w, sum), pl_text_expr(w, "asin(x)/2 + ln(y)^(1/3)")).equal, PL_NO);
  pl_world_free(w);
}

PL_TEST(sixty_formulas_cost_milliseconds) {
  pl_world* w = pl_world_make("l - r");
  pl_fact fact = {pl_text_expr(w, "l - r"), true};
  pl_domain s = {.facts = &fact, .n_facts = 1};
  pl_verifier* c = pl_verifier_make(&w->job, w->pool, &s);
  double start = pl_clock();
  for (int i = 0; i < 60; i++) {
    pl_expr shown = pl_text_expr(
        w,
        pl_format(w->arena, "(%d*m1*sqrt(l^2 - r^2*sin(x)^2) + r*cos(x))^2/(m1 + m2*sin(x)^2)", i));
    pl_expr same = pl_text_expr(
        w, pl_format(w->arena,
                     "(r*cos(x) + %d*m1*sqrt(l^2 - r^2*sin(x)^2))^2/(m1 + m2 - m2*cos(x)^2)", i));
    assert_int_equal(pl_verify(c, shown, same).equal, PL_YES);
  }
  double seconds = pl_clock() - start;
  assert_true(seconds < 2.0);  // a few ten ms; the bound allows for sanitizers on a busy machine
  pl_world_free(w);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(equal_expressions_are_certified_at_all_points),
      cmocka_unit_test(a_wrong_sign_is_separated),
      cmocka_unit_test(the_points_decide_about_branches),
      cmocka_unit_test(the_points_lie_in_the_domain),
      cmocka_unit_test(a_fact_that_a_definition_makes_zero_holds),
      cmocka_unit_test(definitions_and_unknowns_take_their_values),
      cmocka_unit_test(an_impossible_domain_is_unknown),
      cmocka_unit_test(points_are_found_where_functions_have_values),
      cmocka_unit_test(sixty_formulas_cost_milliseconds),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
