// Dense LU and LDL^T with pivoting, in place, on arrays the caller reserved.  Needs nothing.
// Bunch and Kaufman, Math. Comp. 31 (1977) 163, for the symmetric case.
#include "linalg/linalg.h"

#include <float.h>
#include <math.h>
#include <string.h>

// ---------------------------------------------------------------------------------------------- LU
// Powers of two, so that scaling rounds nothing.
static double row_scale(const double* A, int i, int n) {
  double most = 0;
  for (int j = 0; j < n; j++) {
    double x = fabs(A[i + (size_t)j * n]);
    if (!(x <= DBL_MAX)) return 0;  // NaN or infinite
    if (x > most) most = x;
  }
  if (most == 0) return 0;
  int e;
  frexp(most, &e);
  return ldexp(1.0, -e);
}

static bool scale_rows(double* A, double* scale, int n) {
  for (int i = 0; i < n; i++) {
    scale[i] = row_scale(A, i, n);
    if (scale[i] == 0) return false;
  }
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++) A[i + (size_t)j * n] *= scale[i];
  return true;
}

static void swap_rows(double* A, int r, int s, int n) {
  if (r == s) return;
  for (int j = 0; j < n; j++) {
    double* col = A + (size_t)j * n;
    double x = col[r];
    col[r] = col[s];
    col[s] = x;
  }
}

double pl_lu_factor(double* A, int* p, double* scale, int n) {
  if (n == 0) return 1;
  if (!scale_rows(A, scale, n)) return 0;
  double least = DBL_MAX, most = 0;
  for (int k = 0; k < n; k++) {
    double* pivot_col = A + (size_t)k * n;
    int r = k;
    for (int i = k + 1; i < n; i++)
      if (fabs(pivot_col[i]) > fabs(pivot_col[r])) r = i;
    double d = fabs(pivot_col[r]);
    if (!(d > 0) || !(d <= DBL_MAX)) return 0;
    if (d < least) least = d;
    if (d > most) most = d;
    p[k] = r;
    swap_rows(A, k, r, n);
    double inverse = 1 / pivot_col[k];
    for (int i = k + 1; i < n; i++) pivot_col[i] *= inverse;
    for (int j = k + 1; j < n; j++) {
      double* restrict col = A + (size_t)j * n;
      double top = col[k];
      if (top == 0) continue;
      for (int i = k + 1; i < n; i++) col[i] -= pivot_col[i] * top;
    }
  }
  return least / most;
}

void pl_lu_solve(const double* LU, const int* p, const double* scale, double* b, double* work,
                 int n) {
  for (int i = 0; i < n; i++) work[i] = b[i] * scale[i];
  for (int k = 0; k < n; k++) {
    double x = work[p[k]];
    work[p[k]] = work[k];
    work[k] = x;
  }
  for (int k = 0; k < n; k++) {
    double x = work[k];
    if (x == 0) continue;
    const double* col = LU + (size_t)k * n;
    for (int i = k + 1; i < n; i++) work[i] -= col[i] * x;
  }
  for (int k = n - 1; k >= 0; k--) {
    const double* col = LU + (size_t)k * n;
    double x = work[k] / col[k];
    work[k] = x;
    for (int i = 0; i < k; i++) work[i] -= col[i] * x;
  }
  memcpy(b, work, (size_t)n * sizeof *b);
}

// ------------------------------------------------------------------------------------------- LDL^T
#define AT(i, j) A[(size_t)(i) + (size_t)(j) * (size_t)n]

// Swaps rows and columns r < s of the trailing symmetric matrix from k on. L to the left of it
// stays: the solve swaps as it goes.
static void swap_symmetric(double* A, int n, int k, int r, int s) {
  if (r == s) return;
  for (int j = k; j < r; j++) {
    double x = AT(r, j);
    AT(r, j) = AT(s, j);
    AT(s, j) = x;
  }
  for (int i = r + 1; i < s; i++) {
    double x = AT(i, r);
    AT(i, r) = AT(s, i);
    AT(s, i) = x;
  }
  for (int i = s + 1; i < n; i++) {
    double x = AT(i, r);
    AT(i, r) = AT(i, s);
    AT(i, s) = x;
  }
  double x = AT(r, r);
  AT(r, r) = AT(s, s);
  AT(s, s) = x;
}

// Size and place of the largest entry below row k in column k of the symmetric matrix.
static double largest_below(const double* A, int n, int k, int* where) {
  double most = 0;
  *where = k;
  for (int i = k + 1; i < n; i++)
    if (fabs(AT(i, k)) > most) {
      most = fabs(AT(i, k));
      *where = i;
    }
  return most;
}

static double largest_in_row(const double* A, int n, int k, int r) {
  double most = 0;
  for (int j = k; j < r; j++) most = fmax(most, fabs(AT(r, j)));
  for (int i = r + 1; i < n; i++) most = fmax(most, fabs(AT(i, r)));
  return most;
}

// Which pivot Bunch and Kaufman take at k: size 1 or 2, and the row that comes to its place.
static int choose_pivot(const double* A, int n, int k, int* row) {
  static const double alpha = 0.6403882032022076;  // (1 + sqrt 17)/8 bounds the growth
  int r;
  double lambda = largest_below(A, n, k, &r), d = fabs(AT(k, k));
  *row = k;
  if (d >= alpha * lambda) return 1;
  double sigma = largest_in_row(A, n, k, r);
  if (d * sigma >= alpha * lambda * lambda) return 1;
  *row = r;
  return fabs(AT(r, r)) >= alpha * sigma ? 1 : 2;
}

static void eliminate_one(double* A, int n, int k) {
  double inverse = 1 / AT(k, k);
  for (int j = k + 1; j < n; j++) {
    double l = AT(j, k) * inverse;
    for (int i = j; i < n; i++) AT(i, j) -= AT(i, k) * l;
  }
  for (int i = k + 1; i < n; i++) AT(i, k) *= inverse;
}

static double eliminate_two(double* A, int n, int k) {
  double a = AT(k, k), b = AT(k + 1, k), c = AT(k + 1, k + 1), det = a * c - b * b;
  for (int j = k + 2; j < n; j++) {
    double x = AT(j, k), y = AT(j, k + 1);
    double l = (c * x - b * y) / det, m = (a * y - b * x) / det;
    for (int i = j; i < n; i++) AT(i, j) -= AT(i, k) * l + AT(i, k + 1) * m;
    AT(j, k) = l;  // row j of L; columns left of j are no longer read as A
    AT(j, k + 1) = m;
  }
  return det;
}

double pl_ldlt_factor(double* A, int* p, int n) {
  double least = DBL_MAX, most = 0;
  for (int k = 0; k < n;) {
    int row, size = choose_pivot(A, n, k, &row);
    double d;
    swap_symmetric(A, n, k, k + size - 1, row);
    if (size == 1) {
      d = fabs(AT(k, k));
      if (!(d > 0) || !(d <= DBL_MAX)) return 0;
      eliminate_one(A, n, k);
      p[k] = row;
    } else {
      // columns k and k+1 are both needed unchanged for all rows below, so L is written row by row
      d = sqrt(fabs(eliminate_two(A, n, k)));
      if (!(d > 0) || !(d <= DBL_MAX)) return 0;
      p[k] = p[k + 1] = -row - 1;
    }
    least = fmin(least, d);
    most = fmax(most, d);
    k += size;
  }
  return n == 0 ? 1 : least / most;
}

static void swap_entries(double* b, int i, int j) {
  double x = b[i];
  b[i] = b[j];
  b[j] = x;
}

void pl_ldlt_solve(const double* A, const int* p, double* b, int n) {
  int k = 0;
  while (k < n) {
    int size = p[k] < 0 ? 2 : 1, row = p[k] < 0 ? -p[k] - 1 : p[k];
    swap_entries(b, k + size - 1, row);
    for (int i = k + size; i < n; i++)
      for (int j = k; j < k + size; j++) b[i] -= AT(i, j) * b[j];
    k += size;
  }
  for (k = 0; k < n; k += p[k] < 0 ? 2 : 1) {
    if (p[k] >= 0) {
      b[k] /= AT(k, k);
      continue;
    }
    double a = AT(k, k), o = AT(k + 1, k), c = AT(k + 1, k + 1), det = a * c - o * o, x = b[k],
           y = b[k + 1];
    b[k] = (c * x - o * y) / det;
    b[k + 1] = (a * y - o * x) / det;
  }
  k = n - 1;
  while (k >= 0) {
    int size = p[k] < 0 ? 2 : 1, first = k - size + 1, row = p[k] < 0 ? -p[k] - 1 : p[k];
    for (int j = first; j <= k; j++)
      for (int i = k + 1; i < n; i++) b[j] -= AT(i, j) * b[i];
    swap_entries(b, k, row);
    k = first - 1;
  }
}
