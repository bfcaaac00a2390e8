// Dense LU of a complex matrix with partial pivoting and row scaling, in place. Re and im
// alternate, column-major: entry (i, j) at A[2 (i + j n)]. Written out in real numbers, so that no
// library call handles infinities.
#include "linalg/linalg.h"

#include <float.h>
#include <math.h>

static double size_of(const double* z) { return fabs(z[0]) + fabs(z[1]); }

// Powers of two, so that scaling rounds nothing.
static bool scale_rows(double* A, double* scale, int n) {
  for (int i = 0; i < n; i++) {
    double most = 0;
    for (int j = 0; j < n; j++) {
      double x = size_of(A + 2 * ((size_t)i + (size_t)j * (size_t)n));
      if (!(x <= DBL_MAX)) return false;
      if (x > most) most = x;
    }
    if (most == 0) return false;
    int e;
    frexp(most, &e);
    scale[i] = ldexp(1.0, -e);
  }
  for (int j = 0; j < n; j++) {
    for (int i = 0; i < n; i++) {
      double* z = A + 2 * ((size_t)i + (size_t)j * (size_t)n);
      z[0] *= scale[i];
      z[1] *= scale[i];
    }
  }
  return true;
}

static void swap(double* a, double* b) {
  for (int k = 0; k < 2; k++) {
    double x = a[k];
    a[k] = b[k];
    b[k] = x;
  }
}

static int find_pivot(const double* col, int k, int n) {
  int r = k;
  for (int i = k + 1; i < n; i++)
    if (size_of(col + 2 * i) > size_of(col + 2 * r)) r = i;
  return r;
}

// y -= f x over rows first .. n-1
static void subtract(double* restrict y, const double* restrict x, double re, double im, int first,
                     int n) {
  for (int i = first; i < n; i++) {
    y[2 * i] -= re * x[2 * i] - im * x[2 * i + 1];
    y[2 * i + 1] -= re * x[2 * i + 1] + im * x[2 * i];
  }
}

double pl_zlu_factor(double* A, int* p, double* scale, int n) {
  if (n == 0) return 1;
  if (!scale_rows(A, scale, n)) return 0;
  double least = DBL_MAX, most = 0;
  for (int k = 0; k < n; k++) {
    double* col = A + 2 * (size_t)k * (size_t)n;
    int r = p[k] = find_pivot(col, k, n);
    double d = size_of(col + 2 * r);
    if (!(d > 0) || !(d <= DBL_MAX)) return 0;
    least = fmin(least, d);
    most = fmax(most, d);
    for (int j = 0; j < n && r != k; j++) {
      double* other = A + 2 * (size_t)j * (size_t)n;
      swap(other + 2 * k, other + 2 * r);
    }
    double norm = col[2 * k] * col[2 * k] + col[2 * k + 1] * col[2 * k + 1];
    double re = col[2 * k] / norm, im = -col[2 * k + 1] / norm;
    for (int i = k + 1; i < n; i++) {
      double a = col[2 * i], b = col[2 * i + 1];
      col[2 * i] = a * re - b * im;
      col[2 * i + 1] = a * im + b * re;
    }
    for (int j = k + 1; j < n; j++) {
      double* other = A + 2 * (size_t)j * (size_t)n;
      if (other[2 * k] != 0 || other[2 * k + 1] != 0)
        subtract(other, col, other[2 * k], other[2 * k + 1], k + 1, n);
    }
  }
  return least / most;
}

void pl_zlu_solve(const double* LU, const int* p, const double* scale, double* b, int n) {
  for (int i = 0; i < n; i++) {
    b[2 * i] *= scale[i];
    b[2 * i + 1] *= scale[i];
  }
  for (int k = 0; k < n; k++)
    if (p[k] != k) swap(b + 2 * k, b + 2 * p[k]);
  for (int k = 0; k < n; k++)
    subtract(b, LU + 2 * (size_t)k * (size_t)n, b[2 * k], b[2 * k + 1], k + 1, n);
  for (int k = n - 1; k >= 0; k--) {
    const double* col = LU + 2 * (size_t)k * (size_t)n;
    double norm = col[2 * k] * col[2 * k] + col[2 * k + 1] * col[2 * k + 1], x = b[2 * k],
           y = b[2 * k + 1];
    b[2 * k] = (x * col[2 * k] + y * col[2 * k + 1]) / norm;
    b[2 * k + 1] = (y * col[2 * k] - x * col[2 * k + 1]) / norm;
    subtract(b, col, b[2 * k], b[2 * k + 1], 0, k);
  }
}
