// The earliest root of polynomials whose roots are known.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "linalg/linalg.h"

enum { MOST = 24 };
static double work[PL_ROOT_WORK(MOST)];

// Coefficients of scale (x - r_1) ... (x - r_n).
static void from_roots(double* c, const double* r, int n, double scale) {
  c[0] = scale;
  for (int i = 1; i <= n; i++) c[i] = 0;
  for (int k = 0; k < n; k++)
    for (int i = k + 1; i >= 0; i--) c[i] = (i > 0 ? c[i - 1] : 0) - r[k] * c[i];
}

static double first(const double* roots, int n, int direction) {
  double c[MOST + 1];
  from_roots(c, roots, n, 1);
  return pl_first_root(c, n, direction, work);
}

static void the_earliest_of_several_roots_is_found(void** state) {
  (void)state;
  double r[] = {0.7, 0.3, 0.55, 2, -1};
  assert_true(fabs(first(r, 5, 0) - 0.3) < 1e-14);
}

static void roots_outside_are_not_found(void** state) {
  (void)state;
  double r[] = {-0.2, 1.0001, 3, -5};
  assert_true(first(r, 4, 0) == -1);
}

static void a_root_at_the_start_does_not_count_and_one_at_the_end_does(void** state) {
  (void)state;
  double start[] = {0, 2}, end[] = {1, 2}, both[] = {0, 0.5};
  assert_true(first(start, 2, 0) == -1);
  assert_true(fabs(first(end, 2, 0) - 1) < 1e-15);
  assert_true(fabs(first(both, 2, 0) - 0.5) < 1e-15);
}

static void direction_chooses_the_crossing(void** state) {
  (void)state;
  double r[] = {0.25, 0.5, 0.75};  // negative before 0.25, rises there, falls at 0.5
  assert_true(fabs(first(r, 3, 1) - 0.25) < 1e-15);
  assert_true(fabs(first(r, 3, -1) - 0.5) < 1e-15);
}

static void a_close_pair_is_separated(void** state) {
  (void)state;
  double r[] = {0.5, 0.50001, 0.9};
  assert_true(fabs(first(r, 3, 0) - 0.5) < 1e-10);
  assert_true(fabs(first(r, 3, -1) - 0.50001) < 1e-10);
}

static void roots_on_binary_fractions_are_not_lost(void** state) {
  (void)state;
  for (int i = 1; i < 64; i++) {
    double r[] = {i / 64.0, 0.99, 1.7};
    double expect = fmin(r[0], 0.99);
    assert_true(fabs(first(r, 3, 0) - expect) < 1e-15 / fabs(r[0] - 0.99));
  }
}

static void random_polynomials_give_their_least_root(void** state) {
  (void)state;
  for (uint64_t seed = 1; seed <= 400; seed++) {
    pl_random g = {seed};
    int n = 1 + (int)(pl_random_bits(&g) % 8);
    double r[8], least = 2;
    for (int i = 0; i < n; i++) {
      r[i] = pl_random_between(&g, -1, 2);
      if (r[i] > 0 && r[i] <= 1 && r[i] < least) least = r[i];
    }
    double found = first(r, n, 0), expect = least > 1 ? -1 : least;
    double nearest = 1;
    for (int i = 0; i < n; i++)
      if (r[i] != least) nearest = fmin(nearest, fabs(r[i] - least));
    // close roots lose digits as the polynomial itself does
    double limit = 1e-12 / pow(fmin(nearest, 1), 3);
    if (!(fabs(found - expect) <= limit))
      print_message("# seed %llu: %.17g, expected %.17g\n", (unsigned long long)seed, found,
                    expect);
    assert_true(fabs(found - expect) <= limit);
  }
}

static void what_is_no_polynomial_has_no_root(void** state) {
  (void)state;
  double zero[3] = {0}, constant[] = {5}, nan[] = {1, (double)NAN, 2};
  assert_true(pl_first_root(zero, 2, 0, work) == -1);
  assert_true(pl_first_root(constant, 0, 0, work) == -1);
  assert_true(pl_first_root(nan, 2, 0, work) == -1);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_earliest_of_several_roots_is_found),
      cmocka_unit_test(roots_outside_are_not_found),
      cmocka_unit_test(a_root_at_the_start_does_not_count_and_one_at_the_end_does),
      cmocka_unit_test(direction_chooses_the_crossing),
      cmocka_unit_test(a_close_pair_is_separated),
      cmocka_unit_test(roots_on_binary_fractions_are_not_lost),
      cmocka_unit_test(random_polynomials_give_their_least_root),
      cmocka_unit_test(what_is_no_polynomial_has_no_root),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
