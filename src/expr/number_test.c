// Exact numbers: against GMP on random operands of all sizes, reading, rounding, roots.
#include "expr/expr_test_kit.h"

#include <gmp.h>
#include <limits.h>

static void random_integer(mpz_t z, pl_random* r) {
  int words = (int)(pl_random_bits(r) % 4);
  mpz_set_ui(z, 0);
  for (int i = 0; i < words; i++) {
    mpz_mul_2exp(z, z, 64);
    mpz_add_ui(z, z, pl_random_bits(r) >> (pl_random_bits(r) % 64));
  }
  if (pl_random_bits(r) & 1) mpz_neg(z, z);
}

static void random_rational(mpq_t q, pl_random* r) {
  random_integer(mpq_numref(q), r);
  do random_integer(mpq_denref(q), r);
  while (mpz_sgn(mpq_denref(q)) == 0);
  mpq_canonicalize(q);
}

static pl_expr from_gmp(pl_pool* p, mpq_t q) {
  char* s = mpq_get_str(NULL, 10, q);
  pl_expr e = pl_number_from_text(p, s, strlen(s));
  free(s);
  return e;
}

static void assert_gmp(pl_pool* p, pl_expr e, mpq_t q, uint64_t seed) {
  char* s = mpq_get_str(NULL, 10, q);
  const char* t = pl_number_text(pl_pool_arena(p), p, e);
  if (strcmp(s, t) != 0) print_message("seed %llu\n", (unsigned long long)seed);
  assert_string_equal(t, s);
  free(s);
}

PL_TEST(arithmetic_agrees_with_gmp) {
  mpq_t x, y, z;
  mpq_inits(x, y, z, NULL);
  for (uint64_t seed = 1; seed <= 500; seed++) {
    pl_random r = {seed};
    random_rational(x, &r);
    random_rational(y, &r);
    pl_expr u = from_gmp(p, x), v = from_gmp(p, y);
    assert_gmp(p, u, x, seed);
    mpq_add(z, x, y);
    assert_gmp(p, pl_add(p, u, v), z, seed);
    mpq_sub(z, x, y);
    assert_gmp(p, pl_sub(p, u, v), z, seed);
    mpq_mul(z, x, y);
    assert_gmp(p, pl_mul(p, u, v), z, seed);
    if (mpq_sgn(y) != 0) {
      mpq_div(z, x, y);
      assert_gmp(p, pl_div(p, u, v), z, seed);
    }
    mpq_mul(z, x, x);
    mpq_mul(z, z, x);
    assert_gmp(p, pl_pow_int(p, u, 3), z, seed);
    assert_int_equal(pl_number_sign(p, u), mpq_sgn(x));
    assert_true(pl_same(pl_call2(p, PL_MIN, u, v), mpq_cmp(x, y) < 0 ? u : v));
    assert_true(pl_same(pl_sub(p, pl_add(p, u, v), v), u));
  }
  mpq_clears(x, y, z, NULL);
}

PL_TEST(the_ends_of_the_small_range_hold) {
  pl_expr lowest = pl_int(p, LONG_MIN), highest = pl_int(p, LONG_MAX);
  assert_text(lowest, "-9223372036854775808");
  assert_text(pl_neg(p, lowest), "9223372036854775808");
  assert_text(pl_add(p, highest, pl_int(p, 1)), "9223372036854775808");
  assert_true(pl_same(pl_neg(p, lowest), pl_add(p, highest, pl_int(p, 1))));
  assert_text(pl_ratio(p, 3, LONG_MIN), "-3/9223372036854775808");
  assert_text(pl_ratio(p, LONG_MIN, LONG_MIN), "1");
  assert_true(pl_same(pl_mul(p, lowest, pl_div(p, pl_int(p, 1), lowest)), pl_int(p, 1)));
}

PL_TEST(decimals_are_read_exactly) {
  struct {
    const char *text, *wanted;
  } cases[] = {{"9.81", "981/100"},
               {"1e-3", "1/1000"},
               {"3/4", "3/4"},
               {"-2.50", "-5/2"},
               {"1.5e3", "1500"},
               {".5", "1/2"},
               {"7.", "7"},
               {"0.1/0.3", "1/3"},
               {"6/4", "3/2"},
               {"00012", "12"},
               {"123456789012345678901234567890", "123456789012345678901234567890"}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    assert_text(pl_number_from_text(p, cases[i].text, strlen(cases[i].text)), cases[i].wanted);
  }
  const char* bad[] = {"",    "-",  ".",  "1e",  "1e99999999", "1x",
                       "1/0", "1/", "e5", "1e+", "--1",        "1.2.3"};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    assert_true(pl_is_poison(pl_number_from_text(p, bad[i], strlen(bad[i]))));
  }
}

PL_TEST(doubles_are_the_nearest) {
  const char* texts[] = {"0.1",
                         "9.81",
                         "1e22",
                         "1e23",
                         "123456789012345678",
                         "2.2250738585072011e-308",
                         "5e-324",
                         "0.3333333333333333333333333333333333333",
                         "9007199254740993",
                         "1.7976931348623157e308",
                         "1e-400",
                         "-6.02214076e23"};
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    double wanted = strtod(texts[i], NULL);
    assert_true(pl_number_double(p, pl_number_from_text(p, texts[i], strlen(texts[i]))) == wanted);
  }
  pl_random r = {5};
  for (int i = 0; i < 500; i++) {
    char s[64];
    unsigned long long whole = pl_random_bits(&r), part = pl_random_bits(&r);
    snprintf(s, sizeof s, "%llu.%llue%d", whole, part, (int)(pl_random_bits(&r) % 600) - 300);
    double value = pl_number_double(p, pl_number_from_text(p, s, strlen(s)));
    if (value != strtod(s, NULL)) print_message("%s\n", s);
    assert_true(value == strtod(s, NULL));
  }
}

PL_TEST(powers_that_are_too_large_stay_symbolic) {
  pl_expr big = pl_pow_int(p, pl_int(p, 2), 1000000);
  assert_text(big, "2^1000000");
  assert_text(pl_div(p, big, pl_pow_int(p, pl_int(p, 2), 999999)), "2");
  assert_text(pl_pow_int(p, pl_int(p, -1), 1000001), "-1");
  assert_text(pl_pow(p, pl_int(p, 3), pl_number_from_text(p, "1e30", 4)),
              "3^1000000000000000000000000000000");
}

// s^q n under a root of order q
PL_TEST(roots_multiply_back) {
  for (uint64_t seed = 1; seed <= 300; seed++) {
    pl_random r = {seed};
    long num = 1 + (long)(pl_random_bits(&r) % 100000), den = 1 + (long)(pl_random_bits(&r) % 1000);
    long q = 2 + (long)(pl_random_bits(&r) % 4);
    pl_expr x = pl_ratio(p, num, den), root = pl_pow(p, x, pl_ratio(p, 1, q));
    bool back = pl_same(pl_pow_int(p, root, q), x);
    if (!back) print_message("seed %llu: %ld/%ld, %ld\n", (unsigned long long)seed, num, den, q);
    assert_true(back);
    double value = pow((double)num / (double)den, 1.0 / (double)q);
    assert_true(fabs(pl_eval(p, root, NULL) - value) < 1e-12 * value);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(arithmetic_agrees_with_gmp),
      cmocka_unit_test(the_ends_of_the_small_range_hold),
      cmocka_unit_test(decimals_are_read_exactly),
      cmocka_unit_test(doubles_are_the_nearest),
      cmocka_unit_test(powers_that_are_too_large_stay_symbolic),
      cmocka_unit_test(roots_multiply_back),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
