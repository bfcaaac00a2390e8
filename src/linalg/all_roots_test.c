// All roots of polynomials whose roots were planted in whole numbers: exact until the one rounding
// of each coefficient.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "linalg/linalg.h"

enum { MOST = 32 };
static double work[PL_ROOT_WORK(MOST)];

// ----------------------------------------------------------------------------------- whole numbers
typedef __int128 whole;
typedef struct planted {
  whole c[MOST + 1];
  int n;
  double x[MOST];  // roots in [0, 1], rising
  int times[MOST], n_x;
} planted;

// times (a x + b)
static void times(planted* p, long a, long b) {
  p->c[++p->n] = 0;
  for (int i = p->n; i >= 0; i--) p->c[i] = (i > 0 ? a * p->c[i - 1] : 0) + b * p->c[i];
}

// times (a x + b)^2 + e, which has no real root
static void times_positive(planted* p, long a, long b, long e) {
  whole f[3] = {(whole)b * b + e, 2 * (whole)a * b, (whole)a * a};
  whole old[MOST + 1];
  for (int i = 0; i <= p->n; i++) old[i] = p->c[i];
  p->n += 2;
  for (int i = 0; i <= p->n; i++) {
    p->c[i] = 0;
    for (int j = 0; j <= 2; j++)
      if (i - j >= 0 && i - j <= p->n - 2) p->c[i] += f[j] * old[i - j];
  }
}

static void plant(planted* p, long numerator, long denominator, int how_often) {
  for (int k = 0; k < how_often; k++) times(p, denominator, -numerator);
  double x = (double)numerator / (double)denominator;
  int i = p->n_x++;
  for (; i > 0 && p->x[i - 1] > x; i--) {
    p->x[i] = p->x[i - 1];
    p->times[i] = p->times[i - 1];
  }
  p->x[i] = x;
  p->times[i] = how_often;
}

static double value(const double* c, int n, double x) {
  double p = c[n];
  for (int i = n - 1; i >= 0; i--) p = p * x + c[i];
  return p;
}

static double size(const double* c, int n, double x) {
  double p = fabs(c[n]);
  for (int i = n - 1; i >= 0; i--) p = p * x + fabs(c[i]);
  return p;
}

// Whether doubles can tell the roots apart at all: between two of them the polynomial must rise
// above what is known.
static bool is_resolved(const planted* p, const double* c, double noise) {
  for (int i = 0; i + 1 < p->n_x; i++) {
    double most = 0;
    for (int k = 1; k < 16; k++) {
      double x = p->x[i] + k / 16.0 * (p->x[i + 1] - p->x[i]);
      most = fmax(most, fabs(value(c, p->n, x)) / size(c, p->n, x));
    }
    if (most < 4 * noise) return false;
  }
  return true;
}

// ----------------------------------------------------------------------------------------- the law
// How far a root of this multiplicity may be moved by noise: (noise S k! / |p^(k)|)^(1/k), with
// room for the next terms.
static double may_move(const double* c, int n, double x, int k, double noise) {
  double d[MOST + 1], factorial = 1;
  for (int i = 0; i <= n; i++) d[i] = c[i];
  for (int r = 1; r <= k; r++) {
    for (int i = 0; i + r <= n; i++) d[i] = (i + 1) * d[i + 1];
    factorial *= r;
  }
  return 2 * pow(noise * size(c, n, x) * factorial / fabs(value(d, n - k, x)), 1.0 / k) + 4e-16;
}

static planted random_event(pl_random* g) {
  planted p = {.c = {1}, .n = 0};
  long used[8];
  int n_used = 0, doubles = (int)(pl_random_bits(g) % 3), simple = (int)(pl_random_bits(g) % 3);
  int pair = pl_random_bits(g) % 3 == 0, end = (int)(pl_random_bits(g) % 6),
      triple = pl_random_bits(g) % 8 == 0;
  for (int k = 0; k < doubles + simple + triple; k++) {
    long r = 1 + (long)(pl_random_bits(g) % 31);
    bool again = false;
    for (int i = 0; i < n_used; i++) again |= used[i] == r;
    if (again) continue;
    used[n_used++] = r;
    plant(&p, r, 32, k < doubles ? 2 : k < doubles + simple ? 1 : 3);
  }
  if (pair) {
    // close together: 2^-13 apart
    long r = 8 * 32 * (1 + (long)(pl_random_bits(g) % 31)) + 101;
    plant(&p, r, 8192, 1);
    plant(&p, r + 1, 8192, 1);
  }
  if (end == 0) plant(&p, 0, 1, 1);
  if (end == 1) plant(&p, 1, 1, 1);
  if (end == 2) plant(&p, 1, 1, 2);
  for (int k = (int)(pl_random_bits(g) % 3); k > 0; k--)
    times(&p, 1 + (long)(pl_random_bits(g) % 3), 5);
  for (int k = (int)(pl_random_bits(g) % 3); k > 0; k--)
    times_positive(&p, 1 + (long)(pl_random_bits(g) % 5), -(long)(pl_random_bits(g) % 5), 1);
  return p;
}

static void none_is_missed_and_none_invented(void** state) {
  (void)state;
  int tried = 0, doubles = 0, singles = 0, pairs = 0, ends = 0, triples = 0, empty = 0, skipped = 0;
  for (uint64_t seed = 1; tried < 1000; seed++) {
    pl_random g = {seed};
    planted p = random_event(&g);
    if (p.n == 0) continue;
    double c[MOST + 1], noise = pl_root_noise(p.n);
    for (int i = 0; i <= p.n; i++) c[i] = (double)p.c[i];
    if (!is_resolved(&p, c, noise)) {
      skipped++;
      continue;
    }
    tried++;
    empty += p.n_x == 0;
    pl_real_root found[MOST];
    int n = pl_roots(c, p.n, noise, 0, found, MOST, work);
    if (n != p.n_x)
      print_message("# seed %llu: %d roots, planted %d\n", (unsigned long long)seed, n, p.n_x);
    assert_int_equal(n, p.n_x);
    for (int i = 0; i < n; i++) {
      bool inside = p.x[i] > 0 && p.x[i] < 1;
      double off = fabs(found[i].x - p.x[i]), most = may_move(c, p.n, p.x[i], p.times[i], noise);
      if (off > most)
        print_message("# seed %llu: %.17g, planted %.17g\n", (unsigned long long)seed, found[i].x,
                      p.x[i]);
      assert_true(off <= most);
      if (inside) assert_int_equal(found[i].before == found[i].after, p.times[i] % 2 == 0);
      doubles += inside && p.times[i] == 2;
      singles += inside && p.times[i] == 1;
      triples += p.times[i] == 3;
      ends += !inside;
      pairs += i > 0 && p.x[i] - p.x[i - 1] < 2e-4;
    }
  }
  printf(
      "# double %d, simple %d, triple %d, close pairs %d, at the ends %d, without roots %d; %d "
      "beyond double skipped\n",
      doubles, singles, triples, pairs, ends, empty, skipped);
  assert_true(doubles > 500 && singles > 500 && pairs > 100 && ends > 100 && triples > 50
              && skipped < 300);
}

// A double root lifted or lowered: by half of what is known it stays one, by ten times it is none
// or two.
static void what_is_known_decides_about_a_lifted_double_root(void** state) {
  (void)state;
  for (int k = 1; k < 32; k++) {
    double r = k / 32.0, c[] = {r * r, -2 * r, 1}, known = pl_root_noise(2) * size(c, 2, r);
    pl_real_root out[4];
    for (int sign = -1; sign <= 1; sign++) {
      double moved[] = {c[0] + sign * 0.5 * known, c[1], c[2]};
      assert_int_equal(pl_roots(moved, 2, pl_root_noise(2), 0, out, 4, work), 1);
      assert_true(out[0].before == 1 && out[0].after == 1 && fabs(out[0].x - r) < 1e-15);
    }
    double lifted[] = {c[0] + 10 * known, c[1], c[2]}, lowered[] = {c[0] - 10 * known, c[1], c[2]};
    assert_int_equal(pl_roots(lifted, 2, pl_root_noise(2), 0, out, 4, work), 0);
    assert_int_equal(pl_roots(lowered, 2, pl_root_noise(2), 0, out, 4, work), 2);
    assert_true(out[0].before == 1 && out[0].after == -1 && out[1].after == 1);
  }
}

static void a_floor_hides_what_is_below_it(void** state) {
  (void)state;
  double c[] = {0.25 + 1e-9, -1, 1};  // (x - 1/2)^2 + 1e-9
  pl_real_root out[4];
  assert_int_equal(pl_roots(c, 2, 1e-15, 0, out, 4, work), 0);
  assert_int_equal(pl_roots(c, 2, 1e-15, 1e-8, out, 4, work), 1);
  assert_true(fabs(out[0].x - 0.5) < 1e-12);
}

static void only_as_many_as_there_is_room_for_are_given(void** state) {
  (void)state;
  double c[] = {-0.1171875, 0.6875, -1.25, 0.6875};
  double roots[] = {0.25, 0.5, 0.75};
  c[0] = -roots[0] * roots[1] * roots[2];
  c[1] = roots[0] * roots[1] + roots[0] * roots[2] + roots[1] * roots[2];
  c[2] = -(roots[0] + roots[1] + roots[2]);
  c[3] = 1;
  pl_real_root out[3];
  assert_int_equal(pl_roots(c, 3, pl_root_noise(3), 0, out, 3, work), 3);
  assert_int_equal(pl_roots(c, 3, pl_root_noise(3), 0, out, 1, work), 1);
  assert_true(fabs(out[0].x - 0.25) < 1e-15);
}

static void a_zero_polynomial_has_no_place_of_its_own(void** state) {
  (void)state;
  double zero[4] = {0}, tiny[] = {1e-20, 1e-21, 0, 1e-20};
  pl_real_root out[4];
  assert_int_equal(pl_roots(zero, 3, 1e-15, 0, out, 4, work), 0);
  assert_int_equal(pl_roots(tiny, 3, 1e-15, 1e-12, out, 4, work), 1);
  assert_true(out[0].before == 0 && out[0].after == 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(none_is_missed_and_none_invented),
      cmocka_unit_test(what_is_known_decides_about_a_lifted_double_root),
      cmocka_unit_test(a_floor_hides_what_is_below_it),
      cmocka_unit_test(only_as_many_as_there_is_room_for_are_given),
      cmocka_unit_test(a_zero_polynomial_has_no_place_of_its_own),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
