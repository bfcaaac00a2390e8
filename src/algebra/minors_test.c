// Linear systems of mechanics: what comes out, that it satisfies the equations, how large it may
// become.
#include "algebra/algebra_test_text.h"

enum { MAX_N = 12 };

typedef struct pl_system {
  int n;
  pl_expr A[MAX_N * MAX_N], b[MAX_N], x[MAX_N];
} pl_system;

static pl_system read_system(pl_world* w, int n, const char* const* A, const char* const* b) {
  pl_system s = {.n = n};
  for (int i = 0; i < n * n; i++) s.A[i] = pl_text_expr(w, A[i]);
  for (int i = 0; i < n; i++) s.b[i] = pl_text_expr(w, b[i]);
  return s;
}

static void assert_solves(pl_world* w, const pl_system* s) {
  for (int i = 0; i < s->n; i++) {
    pl_expr rest = pl_neg(w->pool, s->b[i]);
    for (int j = 0; j < s->n; j++)
      rest = pl_add(w->pool, rest, pl_mul(w->pool, s->A[i * s->n + j], s->x[j]));
    if (pl_alg_is_zero(w->tower, rest) != PL_YES) fail_msg("row %d is not satisfied", i);
  }
}

PL_TEST(atwood_comes_out_as_in_the_textbook) {
  pl_world* w = pl_world_make(NULL);
  static const char* const A[] = {"m1", "0", "-1", "0", "m2", "-1", "1", "1", "0"};
  static const char* const b[] = {"m1*g", "m2*g", "0"};
  pl_system s = read_system(w, 3, A, b);
  assert_int_equal(pl_alg_solve(w->tower, 3, s.A, s.b, s.x, 100), PL_YES);
  assert_string_equal(pl_text_of(w, s.x[2]), "-2*g*m1*m2/(m1 + m2)");
  assert_string_equal(pl_text_of(w, s.x[0]), "(g*m1 - g*m2)/(m1 + m2)");
  assert_solves(w, &s);
  pl_world_free(w);
}

PL_TEST(the_double_pendulum_is_solved) {
  pl_world* w = pl_world_make(NULL);
  static const char* const A[] = {"(m1 + m2)*l1^2", "m2*l1*l2*cos(a - b)", "m2*l1*l2*cos(a - b)",
                                  "m2*l2^2"};
  static const char* const b[] = {"-m2*l1*l2*sin(a - b)*y^2 - (m1 + m2)*g*l1*sin(a)",
                                  "m2*l1*l2*sin(a - b)*x^2 - m2*g*l2*sin(b)"};
  pl_system s = read_system(w, 2, A, b);
  assert_int_equal(pl_alg_solve(w->tower, 2, s.A, s.b, s.x, 1000), PL_YES);
  assert_solves(w, &s);
  pl_expr det = pl_alg_det(w->tower, 2, s.A, 1000);
  pl_expr known = pl_text_expr(w, "m2*l1^2*l2^2*(m1 + m2*sin(a - b)^2)");
  assert_int_equal(pl_alg_equal(w->tower, det, known), PL_YES);
  pl_world_free(w);
}

PL_TEST(a_system_with_roots_is_solved) {
  pl_world* w = pl_world_make("l - r");
  static const char* const A[] = {"m1",   "0",    "0",
                                  "-2*x", "0",    "m2",
                                  "0",    "-2*y", "0",
                                  "0",    "1/l",  "sqrt(l^2 - r^2*sin(a)^2)",
                                  "2*x",  "2*y",  "sqrt(l^2 - r^2*sin(a)^2)",
                                  "0"};
  static const char* const b[] = {"x", "g*m2", "u", "v"};
  pl_system s = read_system(w, 4, A, b);
  assert_int_equal(pl_alg_solve(w->tower, 4, s.A, s.b, s.x, 1000), PL_YES);
  assert_solves(w, &s);
  pl_world_free(w);
}

PL_TEST(a_singular_system_is_recognised) {
  pl_world* w = pl_world_make(NULL);
  // the second row is the first times cos(y)/(1 - sin(y)), written otherwise
  static const char* const A[] = {"x*(1 - sin(y))", "1 - sin(y)", "x*cos(y)", "cos(y)"};
  static const char* const b[] = {"1", "2"};
  pl_system s = read_system(w, 2, A, b);
  assert_int_equal(pl_alg_solve(w->tower, 2, s.A, s.b, s.x, 100), PL_NO);
  assert_true(pl_is_zero_node(w->pool, pl_alg_det(w->tower, 2, s.A, 100)));
  assert_int_equal(pl_alg_rank(w->tower, 2, 2, s.A, NULL), 1);
  pl_world_free(w);
}

PL_TEST(the_rank_prefers_the_first_rows) {
  pl_world* w = pl_world_make(NULL);
  static const char* const A[] = {"x",       "y", "0", "2*x",         "2*y",   "0",
                                  "sqrt(3)", "1", "0", "x + sqrt(3)", "y + 1", "0"};
  pl_expr M[12];
  for (int i = 0; i < 12; i++) M[i] = pl_text_expr(w, A[i]);
  int rows[4] = {-1, -1, -1, -1};
  assert_int_equal(pl_alg_rank(w->tower, 4, 3, M, rows), 2);
  assert_int_equal(rows[0], 0);
  assert_int_equal(rows[1], 2);
  pl_world_free(w);
}

PL_TEST(a_dependency_is_found_and_verified) {
  pl_world* w = pl_world_make(NULL);
  static const char* const A[] = {
      "x", "y", "u", "y", "0", "1", "x^2 + y*cos(z)", "x*y", "x*u + cos(z)", "1", "0", "0"};
  pl_expr M[12], c[4];
  for (int i = 0; i < 12; i++) M[i] = pl_text_expr(w, A[i]);
  assert_int_equal(pl_alg_dependency(w->tower, 3, 3, M, 2, c), PL_YES);
  assert_string_equal(pl_text_of(w, c[0]), "x");
  assert_string_equal(pl_text_of(w, c[1]), "cos(z)");
  M[8] = pl_text_expr(w, "x*u");
  assert_int_equal(pl_alg_dependency(w->tower, 3, 3, M, 2, c), PL_NO);
  pl_world_free(w);
}

// The n-pendulum in Cartesian coordinates: rods d_k = (x_k - x_{k-1}, y_k - y_{k-1}), unknowns λ_k.
static pl_system pendulum(pl_world* w, int n) {
  pl_system s = {.n = n};
  pl_pool* p = w->pool;
  pl_expr d[MAX_N][2];
  for (int k = 0; k < n; k++) {
    d[k][0] = pl_text_expr(w, pl_format(w->arena, "x%d - x%d", k + 1, k));
    d[k][1] = pl_text_expr(w, pl_format(w->arena, "y%d - y%d", k + 1, k));
  }
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < n; j++) {
      pl_expr dot = pl_add(p, pl_mul(p, d[i][0], d[j][0]), pl_mul(p, d[i][1], d[j][1]));
      pl_expr m = pl_int(p, 0);
      if (i == j) m = pl_text_expr(w, pl_format(w->arena, i ? "1/m%d + 1/m%d" : "1/m%d", i + 1, i));
      if (i == j + 1) m = pl_text_expr(w, pl_format(w->arena, "-1/m%d", i));
      if (j == i + 1) m = pl_text_expr(w, pl_format(w->arena, "-1/m%d", j));
      s.A[i * n + j] = pl_mul(p, dot, m);
    }
    s.b[i] = pl_text_expr(w, pl_format(w->arena, "u%d", i + 1));
  }
  return s;
}

PL_TEST(the_tridiagonal_system_of_a_chain_stays_small) {
  pl_world* w = pl_world_make(NULL);
  pl_system s = pendulum(w, 3);
  double start = pl_clock();
  assert_int_equal(pl_alg_solve(w->tower, 3, s.A, s.b, s.x, 50000), PL_YES);
  assert_true(pl_clock() - start < 5.0);
  assert_solves(w, &s);
  pl_world_free(w);
}

PL_TEST(too_large_is_said_not_suffered) {
  pl_world* w = pl_world_make(NULL);
  pl_system s = pendulum(w, 5);
  pl_expr before = pl_int(w->pool, 7);
  s.x[0] = before;
  assert_int_equal(pl_alg_solve(w->tower, 5, s.A, s.b, s.x, 20), PL_UNKNOWN);
  assert_true(pl_same(s.x[0], before));
  assert_true(pl_is_poison(pl_alg_det(w->tower, 5, s.A, 20)));
  pl_world_free(w);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(atwood_comes_out_as_in_the_textbook),
      cmocka_unit_test(the_double_pendulum_is_solved),
      cmocka_unit_test(a_system_with_roots_is_solved),
      cmocka_unit_test(a_singular_system_is_recognised),
      cmocka_unit_test(the_rank_prefers_the_first_rows),
      cmocka_unit_test(a_dependency_is_found_and_verified),
      cmocka_unit_test(the_tridiagonal_system_of_a_chain_stays_small),
      cmocka_unit_test(too_large_is_said_not_suffered),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
