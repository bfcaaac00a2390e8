// The prime modulo which identities are checked has the properties that modular.c relies on;
// arithmetic, roots, rotations.
#include "expr/modular.h"

#include "expr/expr_test_kit.h"

#include <gmp.h>

static uint64_t root(uint64_t n) {
  bool ok = true;
  uint64_t r = pl_mod_sqrt(n, &ok);
  assert_true(ok);
  return r;
}

static uint64_t signed_residue(long n) { return n < 0 ? pl_mod_sub(0, (uint64_t)-n) : (uint64_t)n; }

static void the_modulus_is_the_prime_that_is_described(void** state) {
  mpz_t p;
  mpz_init_set_ui(p, PL_MOD_P);
  assert_int_not_equal(mpz_probab_prime_p(p, 40), 0);
  mpz_clear(p);
  assert_true(PL_MOD_P < 1ull << 61 && PL_MOD_P > 1ull << 60);
  assert_int_equal(PL_MOD_P % 8, 7);
  assert_int_equal((PL_MOD_P + 1) % 57600, 0);
  const uint64_t orders[] = {3, 5, 7, 11, 13};
  for (int i = 0; i < 5; i++) assert_int_not_equal((PL_MOD_P - 1) % orders[i], 0);
}

static void small_positive_numbers_are_squares(void** state) {
  for (uint64_t n = 1; n <= 31; n++) assert_int_equal(pl_mod_sign(n), 1);
  assert_int_equal(pl_mod_sign(PL_MOD_P - 1), -1);
  struct {
    uint64_t d;
    long a, b;
  } ranges[] = {{2, 6, 3}, {3, 6, 3}, {5, 6, 3}, {6, 5, 2}, {7, 5, 2}, {10, 5, 2}};
  for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++) {
    uint64_t r = root(ranges[i].d);
    for (long a = -ranges[i].a; a <= ranges[i].a; a++) {
      for (long b = -ranges[i].b; b <= ranges[i].b; b++) {
        double value = (double)a + (double)b * sqrt((double)ranges[i].d);
        uint64_t x = pl_mod_add(signed_residue(a), pl_mod_mul(signed_residue(b), r));
        assert_int_equal(pl_mod_sign(x), (value > 0) - (value < 0));
      }
    }
  }
  uint64_t two = root(2), three = root(3), five = root(5);
  assert_int_equal(pl_mod_sign(pl_mod_add(two, three)), 1);
  assert_int_equal(pl_mod_sign(pl_mod_add(two, five)), 1);
  assert_int_equal(pl_mod_sign(pl_mod_add(three, five)), 1);
  assert_int_equal(pl_mod_sign(pl_mod_add(1, pl_mod_add(two, three))), 1);
}

static void arithmetic_agrees_with_wide_division(void** state) {
  pl_random r = {17};
  uint64_t edges[] = {0,         1, 2, PL_MOD_P - 1, PL_MOD_P - 2, PL_MOD_P / 2, (1ull << 60) - 1,
                      1ull << 60};
  for (int i = 0; i < 20000; i++) {
    uint64_t a = i < 64 ? edges[i % 8] : pl_random_bits(&r) % PL_MOD_P;
    uint64_t b = i < 64 ? edges[i / 8] : pl_random_bits(&r) % PL_MOD_P;
    assert_true(pl_mod_mul(a, b) == (uint64_t)((unsigned __int128)a * b % PL_MOD_P));
    assert_true(pl_mod_add(a, b) == (uint64_t)(((unsigned __int128)a + b) % PL_MOD_P));
    assert_true(pl_mod_add(pl_mod_sub(a, b), b) == a);
    if (i % 100 == 0 && a != 0) assert_true(pl_mod_mul(a, pl_mod_inv(a)) == 1);
    assert_true(pl_mod_add(pl_mod_half(a), pl_mod_half(a)) == a);
  }
}

static void roots_multiply_like_positive_numbers(void** state) {
  pl_random r = {18};
  int squares = 0;
  for (int i = 0; i < 300; i++) {
    uint64_t a = pl_random_bits(&r) % PL_MOD_P, b = pl_random_bits(&r) % PL_MOD_P;
    bool ok_a = true, ok_b = true, ok = true;
    uint64_t x = pl_mod_sqrt(a, &ok_a), y = pl_mod_sqrt(b, &ok_b),
             z = pl_mod_sqrt(pl_mod_mul(a, b), &ok);
    squares += ok_a;
    if (ok_a && ok_b) assert_true(ok && z == pl_mod_mul(x, y));
    bool third = true;
    uint64_t c = pl_mod_pow_ratio(a, 1, 3, &third);
    assert_true(third && pl_mod_pow(c, 3) == a);
    if (ok_a) assert_true(pl_mod_pow_ratio(a, -3, 2, &ok_a) == pl_mod_inv(pl_mod_pow(x, 3)));
  }
  assert_true(squares > 100 && squares < 200);
}

// Every special angle, against its roots; and all parts that exist, against the whole.
static void parts_of_a_turn_fit_together(void** state) {
  bool ok = true;
  uint64_t half = pl_mod_half(1), quarter = pl_mod_half(half);
  assert_true(pl_rotation_of_pi(1, 3, &ok).c == half);
  assert_true(pl_rotation_of_pi(1, 3, &ok).s == pl_mod_mul(half, root(3)));
  assert_true(pl_rotation_of_pi(1, 4, &ok).c == pl_mod_mul(half, root(2)));
  assert_true(pl_rotation_of_pi(1, 5, &ok).c == pl_mod_mul(quarter, pl_mod_add(1, root(5))));
  assert_true(pl_rotation_of_pi(1, 12, &ok).c == pl_mod_mul(quarter, pl_mod_add(root(6), root(2))));
  assert_true(pl_rotation_of_pi(5, 12, &ok).c == pl_mod_mul(quarter, pl_mod_sub(root(6), root(2))));
  assert_true(pl_rotation_of_pi(1, 10, &ok).s == pl_mod_mul(quarter, pl_mod_sub(root(5), 1)));
  assert_true(pl_rotation_of_pi(-7, 2, &ok).s == 1);

  const int64_t parts[] = {1, 2, 3, 5, 9, 10, 15, 25, 45, 128, 180, 360, 1800, 28800};
  for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
    pl_rotation part = pl_rotation_of_pi(1, parts[i], &ok),
                whole = pl_rotation_pow(part, (uint64_t)parts[i]);
    assert_true(whole.c == PL_MOD_P - 1 && whole.s == 0);
    pl_rotation twice = pl_rotation_mul(part, part), other = pl_rotation_of_pi(2, parts[i], &ok);
    assert_true(twice.c == other.c && twice.s == other.s);
    for (size_t k = 0; k <= i; k++) {
      if (parts[i] % parts[k] != 0) continue;
      other = pl_rotation_of_pi(1, parts[k], &ok);
      assert_true(pl_rotation_pow(part, (uint64_t)(parts[i] / parts[k])).s == other.s);
    }
  }
  assert_true(ok);
  pl_rotation_of_pi(1, 7, &ok);
  assert_false(ok);
}

static void angles_are_divided(void** state) {
  pl_random r = {19};
  int seen = 0;
  for (int i = 0; i < 400; i++) {
    pl_rotation a = pl_rotation_from_tangent(pl_random_bits(&r) % PL_MOD_P);
    int64_t den = 1 + (int64_t)(pl_random_bits(&r) % 14);
    bool ok = true;
    pl_rotation part = pl_rotation_ratio(a, 1, den, &ok);
    if (!ok) continue;
    seen++;
    pl_rotation back = pl_rotation_pow(part, (uint64_t)den);
    assert_true(back.c == a.c && back.s == a.s);
  }
  assert_true(seen > 100);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_modulus_is_the_prime_that_is_described),
      cmocka_unit_test(small_positive_numbers_are_squares),
      cmocka_unit_test(arithmetic_agrees_with_wide_division),
      cmocka_unit_test(roots_multiply_like_positive_numbers),
      cmocka_unit_test(parts_of_a_turn_fit_together),
      cmocka_unit_test(angles_are_divided),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
