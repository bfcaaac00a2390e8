// The symmetric solver on chains, trees, nets of rods: residuals, redundancy, the same bits on
// every processor.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "linalg/symmetric_impl.h"

// ----------------------------------------------------------------------------------------- systems
typedef struct t_system {
  pl_arena* a;
  int n, n_q;
  double* K;  // dense (n x n)
  int *start, *row;
  double* value;
  unsigned char* kind;
  uint64_t seed;
} t_system;

static double noise(t_system* s) {
  s->seed = s->seed * 6364136223846793005u + 1442695040888963407u;
  return (double)(s->seed >> 11) / 4503599627370496.0 - 1;
}

static t_system open_system(int points, int rods, uint64_t seed) {
  t_system s = {.a = pl_arena_make(0), .n_q = 2 * points, .n = 2 * points + rods, .seed = seed};
  s.K = PL_ARRAY(s.a, double, (size_t)s.n*(size_t)s.n);
  s.kind = PL_ARRAY(s.a, unsigned char, s.n);
  for (int i = 0; i < s.n_q; i++) s.K[i + i * s.n] = 1.5 + noise(&s);
  for (int i = s.n_q; i < s.n; i++) s.kind[i] = PL_UNKNOWN_CONSTRAINT;
  return s;
}

static void set(t_system* s, int i, int j, double x) {
  s->K[i + j * s->n] = s->K[j + i * s->n] = x;
}

// A rod between points a and b; b < 0: to a fixed point.  Coordinates: all x, then all y.
static void rod(t_system* s, int r, int a, int b) {
  double x = noise(s), y = noise(s);
  int points = s->n_q / 2, c = s->n_q + r;
  set(s, c, a, x);
  set(s, c, points + a, y);
  if (b >= 0) {
    set(s, c, b, -x);
    set(s, c, points + b, -y);
  }
}

static pl_symmetric* close_system(t_system* s) {
  int n = 0;
  s->start = PL_ARRAY(s->a, int, s->n + 1);
  s->row = PL_ARRAY(s->a, int, (size_t)s->n*(size_t)s->n + 1);
  s->value = PL_ARRAY(s->a, double, (size_t)s->n*(size_t)s->n + 1);
  for (int j = 0; j < s->n; j++) {
    for (int i = 0; i < s->n; i++)
      if (i == j || s->K[i + j * s->n] != 0) {
        s->row[n] = i;
        s->value[n++] = s->K[i + j * s->n];
      }
    s->start[j + 1] = n;
  }
  return pl_symmetric_make(s->a, s->n, s->start, s->row, s->kind);
}

static void expect_solved(t_system* s, const char* what) {
  pl_symmetric* x = close_system(s);
  assert_non_null(x);
  double part = pl_symmetric_factor(x, s->value), most = 0, size = 0;
  double *b = PL_ARRAY(s->a, double, s->n), *r = PL_ARRAY(s->a, double, s->n);
  for (int round = 0; round < 2; round++) {  // the second time nothing is left of the first
    for (int i = 0; i < s->n; i++) b[i] = r[i] = noise(s);
    pl_symmetric_solve(x, b);
    most = size = 0;
    for (int j = 0; j < s->n; j++) {
      size = fmax(size, fabs(b[j]));
      for (int e = s->start[j]; e < s->start[j + 1]; e++) r[s->row[e]] -= s->value[e] * b[j];
    }
    for (int i = 0; i < s->n; i++) most = fmax(most, fabs(r[i]));
  }
  printf(
      "# %s, seed %llu: lanes %d, steps %d, entries %d, border %d; part %.1e, residual %.1e of "
      "%.1e\n",
      what, (unsigned long long)s->seed, x->main.lanes, x->main.m, x->main.n, x->border.m, part,
      most, size);
  assert_true(part > 1e-9);
  assert_true(most < 1e-12 * (1 + size) / fmin(1, sqrt(part)));
  pl_arena_free(s->a);
}

static t_system chain(int n, uint64_t seed) {
  t_system s = open_system(n, n, seed);
  for (int i = 0; i < n; i++) rod(&s, i, i, i - 1);
  return s;
}

static t_system tree(int n, uint64_t seed) {
  t_system s = open_system(n, n, seed);
  for (int i = 0; i < n; i++) rod(&s, i, i, i == 0 ? -1 : (int)((double)i * 0.5 * (1 + noise(&s))));
  return s;
}

// Rods along both directions of a net with fewer rods than coordinates.
static t_system net(int n, int m, uint64_t seed) {
  t_system s = open_system(n * m, n * (m - 1) + (n - 1) * m, seed);
  int r = 0;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < m; j++) {
      if (j > 0) rod(&s, r++, i * m + j, i * m + j - 1);
      if (i > 0) rod(&s, r++, i * m + j, (i - 1) * m + j);
    }
  return s;
}

// ------------------------------------------------------------------------------------------- tests
static void chains_trees_and_nets_are_solved(void** state) {
  (void)state;
  static const int lengths[] = {1, 2, 7, 63, 64, 65, 100, 128, 257, 450};
  for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++) {
    t_system s = chain(lengths[i], 17 + i);
    expect_solved(&s, "chain");
  }
  for (uint64_t seed = 1; seed <= 3; seed++) {
    t_system s = tree((int)(100 * seed), seed), t = net(9, 8 + (int)seed, seed),
             u = net(3, 60, seed);
    expect_solved(&s, "tree");
    expect_solved(&t, "net");
    expect_solved(&u, "ladder");
  }
}

static void separate_pendulums_need_no_separators(void** state) {
  (void)state;
  t_system s = open_system(200, 200, 5);
  for (int i = 0; i < 200; i++) rod(&s, i, i, -1);
  expect_solved(&s, "pendulums");
}

static void coupled_masses_are_solved(void** state) {
  (void)state;
  t_system s = chain(120, 3);
  for (int i = 0; i < 120; i++) set(&s, i, 120 + i, 0.1 * noise(&s));  // x and y of a mass
  expect_solved(&s, "coupled masses");
}

static void coordinates_without_mass_come_last(void** state) {
  (void)state;
  t_system s = chain(90, 4);
  for (int i = 80; i < 90; i++) {
    s.K[i + i * s.n] = 0;
    s.kind[i] = PL_UNKNOWN_OTHER;
  }
  expect_solved(&s, "without mass");
}

static void a_redundant_rod_leaves_nothing_of_a_pivot(void** state) {
  (void)state;
  t_system s = chain(150, 6);
  int c = s.n - 1, d = s.n - 2;
  for (int i = 0; i < s.n_q; i++) set(&s, c, i, 2 * s.K[i + d * s.n]);
  pl_symmetric* x = close_system(&s);
  double part = pl_symmetric_factor(x, s.value);
  printf("# redundant: %.1e\n", part);
  assert_true(part < 1e-14);
  pl_arena_free(s.a);
}

// Eliminating the hub first would couple all its rods with each other.
static void a_hub_of_many_rods_is_left_to_another_order(void** state) {
  (void)state;
  t_system s = open_system(301, 300, 12);
  for (int i = 0; i < 300; i++) rod(&s, i, i + 1, 0);
  assert_null(close_system(&s));
  pl_arena_free(s.a);
}

static void no_number_is_told(void** state) {
  (void)state;
  t_system s = chain(100, 7);
  pl_symmetric* x = close_system(&s);
  s.value[s.start[150]] = (double)NAN;
  assert_true(pl_symmetric_factor(x, s.value) == 0);
  pl_arena_free(s.a);
}

static void every_processor_computes_the_same_bits(void** state) {
  (void)state;
#ifdef PL_KERNELS_BY_PROCESSOR
  const pl_symmetric_kernels* kernels[] = {&pl_symmetric_plain, &pl_symmetric_avx2,
                                           &pl_symmetric_avx512};
  bool can[] = {true, __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"),
                __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl")
                    && __builtin_cpu_supports("avx512dq")};
  t_system systems[] = {chain(150, 8), tree(150, 9), net(12, 12, 10)};
  for (int i = 0; i < 3; i++) {
    t_system* s = &systems[i];
    pl_symmetric* x = close_system(s);
    double *b = PL_ARRAY(s->a, double, 3 * s->n), part[3];
    for (int j = 0; j < s->n; j++) b[j] = b[j + s->n] = b[j + 2 * s->n] = noise(s);
    for (int k = 0; k < 3; k++) {
      if (!can[k]) continue;
      part[k] = kernels[k]->factor(x, s->value);
      kernels[k]->solve(x, b + k * s->n);
      assert_memory_equal(&part[k], &part[0], sizeof *part);
      assert_memory_equal(b + k * s->n, b, (size_t)s->n * sizeof *b);
    }
    pl_arena_free(s->a);
  }
#endif
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(chains_trees_and_nets_are_solved),
      cmocka_unit_test(separate_pendulums_need_no_separators),
      cmocka_unit_test(coupled_masses_are_solved),
      cmocka_unit_test(coordinates_without_mass_come_last),
      cmocka_unit_test(a_redundant_rod_leaves_nothing_of_a_pivot),
      cmocka_unit_test(a_hub_of_many_rods_is_left_to_another_order),
      cmocka_unit_test(no_number_is_told),
      cmocka_unit_test(every_processor_computes_the_same_bits),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
