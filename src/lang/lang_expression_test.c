// The rules for expressions, one by one: what a blank means, what is refused, how names may be
// spelled.
#include "lang_testing.h"

static const char* const model =
    "param m = 1, m1 = 2, m2 = 3, g = 9.81, l = 2, R = 3, a = 4, b = 5, ω = 2, Öl = 1\n"
    "let f(u) = u^2, half = l/2\n"
    "coord x, y, θ, φ, r, q[1..4]\n"
    "axes x right, y up\n"
    "mass A: m at (x + a, y)\n"
    "for i in 1..4 {\n  mass P[i]: m at (q[i], i)\n}\n"
    "constraint g1: x = l with λ\n"
    "constraint c: y = 0\n";

// Reads one expression in the names of the model and compares with an expression written out in
// full.
static void means(const char* text, const char* full) {
  bench* b = bench_text(model);
  assert_string_equal(bench_said(b), "");
  pl_expr e;
  pleuel_status s = pl_lang_expression(&b->job, b->m, text, &e);
  if (s != PLEUEL_OK) print_message("%s: %s\n", text, bench_said(b));
  assert_int_equal(s, PLEUEL_OK);
  const char* got = pl_expr_text(b->arena, b->m->pool, e);
  pl_expr want;
  assert_int_equal(pl_lang_expression(&b->job, b->m, full, &want), PLEUEL_OK);
  if (!pl_same(e, want)) print_message("%s is %s, expected %s\n", text, got, full);
  assert_true(pl_same(e, want));
  bench_free(b);
}

static void refused(const char* text, const char* code) {
  bench* b = bench_text(model);
  pl_expr e;
  assert_int_equal(pl_lang_expression(&b->job, b->m, text, &e), PLEUEL_MODEL_ERROR);
  const char* said = bench_said(b);
  bool found = strstr(said, code) == said;
  if (!found || strchr(said, ','))
    print_message("%s: said %s, expected %s once\n", text, said, code);
  assert_true(found);
  assert_null(strchr(said, ','));
  bench_free(b);
}

static void a_blank_is_a_product(void** state) {
  (void)state;
  means("m g l", "m*g*l");
  means("m·g×l", "m*g*l");
  means("2 a b", "2*a*b");
  means("2a", "2*a");
  means("2π a", "2*pi*a");
  means("(a + b) (a - b)", "(a + b)*(a - b)");
  means("a(b + 1)", "a*(b + 1)");
  means("m g cos θ", "m*g*cos(θ)");
  means("-a b", "-(a*b)");
  means("a −b", "a - b");
}

static void numbers_divide_first(void** state) {
  (void)state;
  means("1/2 m a^2", "(1/2)*m*a^2");
  means("l/2 cos θ", "(l/2)*cos(θ)");
  means("m l^2/12", "(m*l^2)/12");
  means("1/2(a + b)", "(a + b)/2");
  means("a/b/l", "(a/b)/l");
  means("a/b*l", "(a/b)*l");
  means("m g/(a b)", "(m*g)/(a*b)");
  means("g/sin θ", "g/sin(θ)");
  means("a/2^2 b", "(a/4)*b");
}

static void two_readings_are_refused(void** state) {
  (void)state;
  refused("g/R cos θ", "E014");
  refused("(m1 - m2)/(m1 + m2) g", "E014");
  refused("a/b l", "E014");
  refused("a^2/2m", "E014");
  refused("ω/2π", "E014");
  refused("a/b (l + 1)", "E014");
  refused("a/sin θ cos φ", "E014");
}

static void functions_take_one_factor(void** state) {
  (void)state;
  means("sin θ cos φ", "sin(θ)*cos(φ)");
  means("r sin θ cos φ", "r*sin(θ)*cos(φ)");
  means("sin^2 θ", "sin(θ)^2");
  means("sin²θ", "sin(θ)^2");
  means("sin(θ)^2", "(sin(θ))*(sin(θ))");
  means("cos θ^2", "cos(θ^2)");
  means("cos (θ + φ)", "cos(θ + φ)");
  means("sin q[2]", "sin(q[2])");
  means("ln sin θ", "ln(sin(θ))");
  means("√(l² - R²)", "sqrt(l^2 - R^2)");
  means("√2", "sqrt(2)");
  means("cos 0", "1");
  means("sin φ φ'", "sin(φ)*φ'");
  means("max(a, b, l)", "max(max(a, b), l)");
  means("log(a)", "ln(a)");
}

static void arguments_that_are_unclear_are_refused(void** state) {
  (void)state;
  refused("cos 2θ", "E015");
  refused("cos 2 θ", "E015");
  refused("sin ω t", "E015");
  refused("sin^-1 θ", "E015");
  refused("sin⁻¹ θ", "E015");
  refused("cos", "E015");
  refused("a sin", "E015");
  refused("atan2(a)", "E017");
  refused("sin(a, b)", "E017");
  refused("sin(0,5)", "E003");
}

static void brackets_after_names_follow_the_declaration(void** state) {
  (void)state;
  means("m(a + 1)", "m*(a + 1)");
  means("f(a + b)", "(a + b)^2");
  means("f (a)", "a^2");
  means("f(f(a))", "a^4");
  means("f(a)^2", "a^4");
  means("x(t)", "x");
  means("x (a + b)", "x*(a + b)");
  means("x(A)", "x + a");
  means("y(A)", "y");
  means("x(P[3])", "q[3]");
  means("y(P[3])", "3");
  refused("x(a + b)", "E016");
  refused("θ(a)", "E016");
  bench* b = bench_text(model);
  pl_expr e;
  assert_int_equal(pl_lang_expression(&b->job, b->m, "x(0) + x'(0)", &e), PLEUEL_OK);
  assert_string_equal(pl_expr_text(b->arena, b->m->pool, e), "x_0 + x_dot_0");
  bench_free(b);
}

static void spellings_of_one_name(void** state) {
  (void)state;
  means("m_1", "m1");
  means("m₁", "m1");
  means("theta", "θ");
  means("ẋ", "x'");          // one code point
  means("x\xcc\x87", "x'");  // x and a combining dot
  means("θ\xcc\x87", "theta'");
  means("ẍ", "x''");
  means("x\xcc\x88", "x''");
  means("x′", "x'");
  means("x″", "x''");
  means("x''", "x_ddot");
  means("x_dot", "x'");
  means("x_0", "x(0)");
  means("x_dot_0", "x'(0)");
  means("q[2]'", "q_dot[2]");
  means("omega", "ω");
  means("Oel", "Öl");
  means("O\xcc\x88l", "Öl");  // O and a diaeresis are the umlaut, not a derivative
  means("lambda", "λ");
  means("λ_g1", "λ");
  means("λg1", "lambda_g1");
  means("a²", "a^2");
  means("a⁻¹", "1/a");
  means("a¹⁰", "a^10");
}

static void powers_and_primes_bind_tightest(void** state) {
  (void)state;
  means("x'^2", "(x')^2");
  means("φ'²", "φ'*φ'");
  means("2^3^2", "512");
  means("a^-b", "1/(a^b)");
  means("-a^2", "-(a^2)");
  means("2*-3", "-6");
  means("a b^2 l", "a*(b^2)*l");
}

static void forms_and_calculus(void** state) {
  (void)state;
  means("norm((a, b))", "sqrt(a^2 + b^2)");
  means("dot((a, b), (x, y))", "a*x + b*y");
  means("cross((a, b), (x, y))", "a*y - b*x");
  means("norm(pos(A))", "sqrt((x + a)^2 + y^2)");
  means("dot(vel(A), vel(A))", "x'^2 + y'^2");
  means("diff(x^2 y, x)", "2*x*y");
  means("dt(x^2)", "2*x*x'");
  means("dt(q[2])", "q[2]'");
  means("half", "half");
  means("if(a > b, 1, 2)", "if(b < a, 1, 2)");
  means("90°", "π/2");
  means("1/2°", "π/360");
  refused("a°", "E023");
  refused("(a, b) (x, y)", "E017");
  refused("pos(A)", "E017");
  refused("A", "E011");
  refused("q", "E025");
  refused("x[1]", "E025");
  refused("x3", "E011");
  refused("1 000", "E001");
  refused("3 kg", "E024");
  refused("1/0", "E040");
  refused("m'", "E017");
  refused("x'''", "E001");
}

static void numbers_are_exact(void** state) {
  (void)state;
  means("9.81", "981/100");
  means("1e-3", "1/1000");
  means("0.1 + 0.2", "3/10");
  means("2.5e2", "250");
  refused("1e999999999", "E007");
  refused("2^99999999", "E007");
}

static void decimal_comma_in_a_list_of_start_values(void** state) {
  (void)state;
  bench* b = bench_text("coord x\nparam m = 1\nmass m at (x)\ninit x = 0,5, x' = 0\n");
  assert_string_equal(bench_said(b), "E003 4:10");
  bench_free(b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_blank_is_a_product),
      cmocka_unit_test(numbers_divide_first),
      cmocka_unit_test(two_readings_are_refused),
      cmocka_unit_test(functions_take_one_factor),
      cmocka_unit_test(arguments_that_are_unclear_are_refused),
      cmocka_unit_test(brackets_after_names_follow_the_declaration),
      cmocka_unit_test(spellings_of_one_name),
      cmocka_unit_test(powers_and_primes_bind_tightest),
      cmocka_unit_test(forms_and_calculus),
      cmocka_unit_test(numbers_are_exact),
      cmocka_unit_test(decimal_comma_in_a_list_of_start_values),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
