// Laws of the factorisations on random matrices; a failure prints the seed.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "linalg/linalg.h"

enum { N = 24 };

static double uniform(pl_random* r) { return pl_random_between(r, -1, 1); }

static void random_matrix(pl_random* r, double* A, int m, int n) {
  for (int i = 0; i < m * n; i++) A[i] = uniform(r);
}

static double residual(const double* A, const double* x, const double* b, int n) {
  double most = 0;
  for (int i = 0; i < n; i++) {
    double s = -b[i];
    for (int j = 0; j < n; j++) s += A[i + j * n] * x[j];
    most = fmax(most, fabs(s));
  }
  return most;
}

static void check(uint64_t seed, int n, double found, double limit) {
  if (!(found <= limit))
    print_message("# seed %llu, n = %d: %g above %g\n", (unsigned long long)seed, n, found, limit);
  assert_true(found <= limit);
}

static void lu_solves_random_systems(void** state) {
  (void)state;
  for (uint64_t seed = 1; seed <= 200; seed++) {
    pl_random r = {seed};
    int n = 1 + (int)(pl_random_bits(&r) % N), p[N];
    double A[N * N], LU[N * N], b[N], x[N], scale[N], work[N];
    random_matrix(&r, A, n, n);
    for (int i = 0; i < n; i++) x[i] = b[i] = uniform(&r);
    memcpy(LU, A, sizeof A);
    double ratio = pl_lu_factor(LU, p, scale, n);
    assert_true(ratio > 0 && ratio <= 1);
    pl_lu_solve(LU, p, scale, x, work, n);
    check(seed, n, residual(A, x, b, n), 1e-12 / ratio * 1e-2 + 1e-13);
  }
}

static void ldlt_solves_random_symmetric_indefinite_systems(void** state) {
  (void)state;
  for (uint64_t seed = 1; seed <= 200; seed++) {
    pl_random r = {seed};
    int n = 1 + (int)(pl_random_bits(&r) % N), p[N];
    double A[N * N], F[N * N], b[N], x[N];
    random_matrix(&r, A, n, n);
    // the shape of an equation of motion: zeros on part of the diagonal
    for (int j = 0; j < n; j++)
      for (int i = 0; i <= j; i++) A[i + j * n] = A[j + i * n];
    for (int i = n / 2; n > 1 && i < n; i++) A[i + i * n] = 0;
    for (int i = 0; i < n; i++) x[i] = b[i] = uniform(&r);
    memcpy(F, A, sizeof A);
    double ratio = pl_ldlt_factor(F, p, n);
    assert_true(ratio > 0);
    pl_ldlt_solve(F, p, x, n);
    check(seed, n, residual(A, x, b, n), 1e-13 / ratio + 1e-13);
  }
}

static void singular_and_broken_matrices_are_told(void** state) {
  (void)state;
  double zero_row[] = {1, 0, 2, 0}, equal[] = {1, 1, 2, 2}, nan[] = {1, 0, (double)NAN, 1},
         scale[2];
  int p[2];
  assert_true(pl_lu_factor(zero_row, p, scale, 2) == 0);
  assert_true(pl_lu_factor(equal, p, scale, 2) == 0);
  assert_true(pl_lu_factor(nan, p, scale, 2) == 0);
  double ones[] = {1, 1, 1, 1}, nothing[] = {0, 0, 0, 0};
  assert_true(pl_ldlt_factor(ones, p, 2) == 0);
  assert_true(pl_ldlt_factor(nothing, p, 2) == 0);
}

static void qr_finds_the_rank_and_least_squares(void** state) {
  (void)state;
  for (uint64_t seed = 1; seed <= 100; seed++) {
    pl_random r = {seed};
    int m = 4 + (int)(pl_random_bits(&r) % 16), k = 1 + (int)(pl_random_bits(&r) % 4), n = k + 2,
        jpvt[N];
    double A[N * N], Q[N * N], b[N], x[N] = {0}, tau[N], norm[2 * N];
    // n columns, the last two are combinations of the first k
    random_matrix(&r, A, m, k);
    for (int c = k; c < n; c++)
      for (int i = 0; i < m; i++) A[i + c * m] = A[i] - 2 * A[i + (k - 1) * m] * (c - k + 1);
    memcpy(Q, A, sizeof A);
    assert_int_equal(pl_qr_factor(Q, jpvt, tau, norm, m, n, 1e-10), k);
    // b in the range: the residual is rounding
    for (int i = 0; i < m; i++) b[i] = 0;
    for (int c = 0; c < k; c++)
      for (int i = 0; i < m; i++) b[i] += (c + 1) * A[i + c * m];
    double rhs[N];
    memcpy(rhs, b, sizeof rhs);
    pl_qr_least_squares(Q, tau, rhs, m, k);
    for (int j = 0; j < k; j++) x[jpvt[j]] = rhs[j];
    double most = 0;
    for (int i = 0; i < m; i++) {
      double s = -b[i];
      for (int j = 0; j < n; j++) s += A[i + j * m] * x[j];
      most = fmax(most, fabs(s));
    }
    check(seed, m, most, 1e-11);
  }
}

static void rows_are_taken_by_priority_and_dependent_ones_left_out(void** state) {
  (void)state;
  // rows: a, b, a + b (declared), then c and 2 b as equations of lower priority
  double rows[] = {1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 5, 0, 2, 0}, work[5], smallest;
  int priority[] = {0, 0, 0, 1, 1};
  bool taken[5];
  assert_int_equal(pl_independent_rows(rows, priority, taken, work, 5, 3, 1e-10, &smallest), 3);
  assert_true(taken[0] + taken[1] + taken[2] == 2 && taken[3] && !taken[4]);
  assert_true(smallest > 0.5);
}

static void a_faint_row_shows_in_the_smallest_remainder(void** state) {
  (void)state;
  double rows[] = {1, 0, 1, 1e-7}, work[2], smallest;
  int priority[] = {0, 0};
  bool taken[2];
  assert_int_equal(pl_independent_rows(rows, priority, taken, work, 2, 2, 1e-10, &smallest), 2);
  assert_true(fabs(smallest - 1e-7) < 1e-12);
}

static void sparse_lu_solves_and_refactors(void** state) {
  (void)state;
  pl_arena* a = pl_arena_make(NULL);
  enum { n = 200 };
  int start[n + 1], row[3 * n], at = 0;
  double value[3 * n], b[n], x[n];
  for (int j = 0; j < n; j++) {
    start[j] = at;
    for (int i = j - 1; i <= j + 1; i++)
      if (i >= 0 && i < n) row[at++] = i;
  }
  start[n] = at;
  pl_sparse* s = pl_sparse_make(a, n, start, row);
  assert_non_null(s);
  for (uint64_t seed = 1; seed <= 5; seed++) {
    pl_random r = {seed};
    for (int k = 0; k < at; k++) value[k] = uniform(&r);
    for (int j = 0; j < n; j++) x[j] = b[j] = uniform(&r);
    assert_true(pl_sparse_factor(s, value));
    pl_sparse_solve(s, x);
    double most = 0, size = 0;
    for (int j = 0; j < n; j++) size = fmax(size, fabs(x[j]));
    double left[n];
    memcpy(left, b, sizeof left);
    for (int j = 0; j < n; j++)
      for (int k = start[j]; k < start[j + 1]; k++) left[row[k]] -= value[k] * x[j];
    for (int j = 0; j < n; j++) most = fmax(most, fabs(left[j]));
    check(seed, n, most, 1e-10 * size);
  }
  for (int k = 0; k < at; k++) value[k] = 0;
  assert_false(pl_sparse_factor(s, value));
  value[0] = (double)NAN;
  assert_false(pl_sparse_factor(s, value));
  pl_sparse_free(s);
  pl_arena_free(a);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lu_solves_random_systems),
      cmocka_unit_test(ldlt_solves_random_symmetric_indefinite_systems),
      cmocka_unit_test(singular_and_broken_matrices_are_told),
      cmocka_unit_test(qr_finds_the_rank_and_least_squares),
      cmocka_unit_test(rows_are_taken_by_priority_and_dependent_ones_left_out),
      cmocka_unit_test(a_faint_row_shows_in_the_smallest_remainder),
      cmocka_unit_test(sparse_lu_solves_and_refactors),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
