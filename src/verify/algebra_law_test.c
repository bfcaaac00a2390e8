// Laws on random expressions: the axioms of a field through the tower, and the tower against
// independent evaluation.
#include "algebra/algebra_test_text.h"
#include "verify/verify.h"

enum { PL_ROUNDS = 60 };
static const uint64_t seed = 20240611;

static void assert_zero_expr(pl_world* w, pl_expr e, int round, const char* law) {
  pl_answer3 zero = pl_alg_is_zero(w->tower, e);
  if (zero != PL_YES) {
    fail_msg("%s fails (answer %d), seed %llu round %d: %s", law, zero, (unsigned long long)seed,
             round, pl_text_of(w, e));
  }
}

PL_TEST(sums_and_products_obey_the_axioms) {
  pl_world* w = pl_world_make(NULL);
  pl_pool* p = w->pool;
  pl_random r = {seed};
  for (int i = 0; i < PL_ROUNDS; i++) {
    pl_expr a = pl_alg_normal(w->tower, pl_random_expr(w, &r, 2));
    pl_expr b = pl_alg_normal(w->tower, pl_random_expr(w, &r, 2));
    pl_expr c = pl_alg_normal(w->tower, pl_random_expr(w, &r, 1));
    pl_expr sum = pl_alg_normal(w->tower, pl_add(p, a, b));
    assert_zero_expr(w, pl_sub(p, pl_sub(p, sum, b), a), i, "(a + b) - b = a");
    pl_expr left = pl_alg_normal(w->tower, pl_mul(p, c, sum));
    assert_zero_expr(w, pl_sub(p, left, pl_add(p, pl_mul(p, c, a), pl_mul(p, c, b))), i,
                     "c(a + b) = ca + cb");
    if (pl_alg_is_zero(w->tower, b) == PL_NO) {
      pl_expr quotient = pl_alg_normal(w->tower, pl_div(p, a, b));
      assert_zero_expr(w, pl_sub(p, pl_mul(p, quotient, b), a), i, "(a/b) b = a");
    }
  }
  pl_world_free(w);
}

// a b has at least the factors of a and b, however its factoring was found.
PL_TEST(a_product_is_never_taken_for_irreducible) {
  static const char* const factor[] = {"m1 + m2",      "x^2 + y^2 - l^2",     "m1*x + m2*y",
                                       "m1^2 - 3*x*y", "x*y + l*m2 + 1",      "x^3 + m1*y + 2*l",
                                       "x^2 + m1",     "m1*m2 + m1*l + m2*x", "y^2 - 2*x^2",
                                       "l + x^2*y"};
  int n = (int)(sizeof factor / sizeof *factor);
  pl_world* w = pl_world_make(NULL);
  for (int i = 0; i < n; i++) {
    for (int k = 0; k <= i; k++) {
      pl_expr product = pl_mul(w->pool, pl_text_expr(w, factor[i]), pl_text_expr(w, factor[k]));
      pl_factor found[8];
      pl_expr unit;
      int m = pl_alg_factors(w->tower, pl_expand(w->pool, product, 64), found, 8, &unit), total = 0;
      for (int j = 0; j < m; j++) total += found[j].power;
      if (total != 2) fail_msg("(%s)(%s): %d factors", factor[i], factor[k], total);
    }
  }
  pl_world_free(w);
}

PL_TEST(the_normal_form_of_a_normal_form_is_itself) {
  pl_world* w = pl_world_make(NULL);
  pl_random r = {seed + 1};
  for (int i = 0; i < PL_ROUNDS; i++) {
    pl_expr e = pl_random_expr(w, &r, 3);
    pl_expr once = pl_alg_normal(w->tower, e), twice = pl_alg_normal(w->tower, once);
    if (!pl_same(once, twice)) {
      fail_msg("seed %llu round %d: %s becomes %s", (unsigned long long)seed + 1, i,
               pl_text_of(w, once), pl_text_of(w, twice));
    }
  }
  pl_world_free(w);
}

PL_TEST(the_normal_form_has_the_value_of_the_input) {
  pl_world* w = pl_world_make(NULL);
  pl_random r = {seed + 2};
  pl_domain none = {0};
  pl_text_expr(w, "x + y + m1 + m2 + l");
  pl_verifier* c = pl_verifier_make(&w->job, w->pool, &none);
  int decided = 0;
  for (int i = 0; i < PL_ROUNDS; i++) {
    pl_expr e = pl_random_expr(w, &r, 3);
    pl_verification s = pl_verify(c, pl_alg_normal(w->tower, e), e);
    if (s.equal == PL_NO)
      fail_msg("seed %llu round %d: %s", (unsigned long long)seed + 2, i, pl_text_of(w, e));
    decided += s.equal == PL_YES;
    pl_verification changed = pl_verify(c, pl_add(w->pool, e, pl_int(w->pool, 1)), e);
    assert_true(changed.equal != PL_YES);
  }
  assert_true(decided > PL_ROUNDS * 9 / 10);
  pl_world_free(w);
}

PL_TEST(factors_multiply_to_the_whole) {
  pl_world* w = pl_world_make(NULL);
  pl_random r = {seed + 3};
  for (int i = 0; i < PL_ROUNDS; i++) {
    pl_expr e = pl_random_expr(w, &r, 2);
    pl_factor f[32];
    pl_expr product;
    int n = pl_alg_factors(w->tower, e, f, 32, &product);
    for (int k = 0; k < n; k++)
      product = pl_mul(w->pool, product, pl_pow_int(w->pool, f[k].base, f[k].power));
    assert_zero_expr(w, pl_sub(w->pool, product, e), i, "product of factors");
  }
  pl_world_free(w);
}

PL_TEST(the_derivative_commutes_with_the_normal_form) {
  pl_world* w = pl_world_make(NULL);
  pl_random r = {seed + 4};
  pl_symbol x = pl_text_symbol(w, "x");
  for (int i = 0; i < PL_ROUNDS; i++) {
    pl_expr e = pl_random_expr(w, &r, 2);
    pl_expr first = pl_diff(w->pool, pl_alg_normal(w->tower, e), x);
    assert_zero_expr(w, pl_sub(w->pool, first, pl_diff(w->pool, e, x)), i, "d normal(e) = d e");
  }
  pl_world_free(w);
}

PL_TEST(what_is_solved_satisfies_the_system) {
  pl_world* w = pl_world_make(NULL);
  pl_pool* p = w->pool;
  pl_random r = {seed + 5};
  for (int i = 0; i < 12; i++) {
    enum { N = 3 };
    pl_expr A[N * N], b[N], x[N];
    for (int k = 0; k < N * N; k++)
      A[k] = pl_random_bits(&r) % 3 ? pl_random_expr(w, &r, 1) : pl_int(p, 0);
    for (int k = 0; k < N; k++) b[k] = pl_random_expr(w, &r, 1);
    pl_answer3 answer = pl_alg_solve(w->tower, N, A, b, x, 10000);
    pl_expr det = pl_alg_det(w->tower, N, A, 10000);
    assert_int_equal(answer == PL_NO, pl_alg_is_zero(w->tower, det) == PL_YES);
    int rank = pl_alg_rank(w->tower, N, N, A, NULL);
    if ((answer == PL_YES) != (rank == N)) {
      fail_msg("seed %llu round %d: answer %d, rank %d", (unsigned long long)seed + 5, i, answer,
               rank);
    }
    for (int k = 0; k < N && answer == PL_YES; k++) {
      pl_expr rest = pl_neg(p, b[k]);
      for (int j = 0; j < N; j++) rest = pl_add(p, rest, pl_mul(p, A[k * N + j], x[j]));
      assert_zero_expr(w, rest, i, "A x = b");
    }
  }
  pl_world_free(w);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sums_and_products_obey_the_axioms),
      cmocka_unit_test(a_product_is_never_taken_for_irreducible),
      cmocka_unit_test(the_normal_form_of_a_normal_form_is_itself),
      cmocka_unit_test(the_normal_form_has_the_value_of_the_input),
      cmocka_unit_test(factors_multiply_to_the_whole),
      cmocka_unit_test(the_derivative_commutes_with_the_normal_form),
      cmocka_unit_test(what_is_solved_satisfies_the_system),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
