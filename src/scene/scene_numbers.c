// Small linear algebra of the picture: null spaces and least squares of a handful of unknowns.
#include <math.h>
#include <string.h>

#include "scene/scene_impl.h"

// Gauss-Jordan with full pivoting; null vectors are orthonormal.  Returns how many.
int pl_null_space(double* A, int m, int n, double null[8][8]) {
  int col[8], rank = 0;
  double largest = 0;
  for (int k = 0; k < n; k++) col[k] = k;
  for (int i = 0; i < m; i++) {  // rows of length 1
    double norm = 0;
    for (int k = 0; k < n; k++) norm += A[i * n + k] * A[i * n + k];
    norm = sqrt(norm);
    for (int k = 0; norm > 0 && k < n; k++) A[i * n + k] /= norm;
  }
  for (; rank < m && rank < n; rank++) {
    int pi = rank, pk = rank;
    for (int i = rank; i < m; i++)
      for (int k = rank; k < n; k++)
        if (fabs(A[i * n + col[k]]) > fabs(A[pi * n + col[pk]])) {
          pi = i;
          pk = k;
        }
    double pivot = A[pi * n + col[pk]];
    if (rank == 0) largest = fabs(pivot);
    if (!(fabs(pivot) > 1e-9 * fmax(largest, 1e-300)) || !isfinite(pivot)) break;
    int c = col[pk];
    col[pk] = col[rank];
    col[rank] = c;
    for (int k = 0; k < n; k++) {
      double x = A[pi * n + k];
      A[pi * n + k] = A[rank * n + k];
      A[rank * n + k] = x / pivot;
    }
    for (int i = 0; i < m; i++) {
      double f = A[i * n + c];
      if (i == rank || f == 0) continue;
      for (int k = 0; k < n; k++) A[i * n + k] -= f * A[rank * n + k];
    }
  }
  int d = n - rank;
  for (int z = 0; z < d; z++) {
    for (int k = 0; k < n; k++) null[z][k] = 0;
    null[z][col[rank + z]] = 1;
    for (int i = 0; i < rank; i++) null[z][col[i]] = -A[i * n + col[rank + z]];
    for (int y = 0; y < z; y++) {
      double dot = 0;
      for (int k = 0; k < n; k++) dot += null[z][k] * null[y][k];
      for (int k = 0; k < n; k++) null[z][k] -= dot * null[y][k];
    }
    double norm = 0;
    for (int k = 0; k < n; k++) norm += null[z][k] * null[z][k];
    for (int k = 0; k < n; k++) null[z][k] /= sqrt(norm);
  }
  return d;
}

enum { MOST = 400 };

// x = A^T (A A^T + ε)^-1 b for few equations, (A^T A + ε)^-1 A^T b for few unknowns; ε keeps
// dependent rows harmless.
bool pl_least(const double* A, const double* b, int m, int n, double* x) {
  bool wide = m <= n;
  int k = wide ? m : n, inner = wide ? n : m;
  for (int i = 0; i < n; i++) x[i] = 0;
  if (k == 0) return true;
  if (k > MOST) return false;
  double N[64 * 64], y[64];
  if (k > 64) return false;
  double trace = 0;
  for (int i = 0; i < k; i++) {
    for (int j = 0; j < k; j++) {
      double sum = 0;
      for (int l = 0; l < inner; l++)
        sum += wide ? A[i * n + l] * A[j * n + l] : A[l * n + i] * A[l * n + j];
      N[i * k + j] = sum;
    }
    trace += N[i * k + i];
    y[i] = wide ? b[i] : 0;
    for (int l = 0; !wide && l < m; l++) y[i] += A[l * n + i] * b[l];
  }
  for (int i = 0; i < k; i++) N[i * k + i] += 1e-13 * trace + 1e-300;
  for (int i = 0; i < k; i++) {  // Cholesky in place
    for (int j = 0; j <= i; j++) {
      double sum = N[i * k + j];
      for (int l = 0; l < j; l++) sum -= N[i * k + l] * N[j * k + l];
      if (i == j && !(sum > 0)) return false;
      N[i * k + j] = i == j ? sqrt(sum) : sum / N[j * k + j];
    }
  }
  for (int i = 0; i < k; i++) {
    for (int l = 0; l < i; l++) y[i] -= N[i * k + l] * y[l];
    y[i] /= N[i * k + i];
  }
  for (int i = k - 1; i >= 0; i--) {
    for (int l = i + 1; l < k; l++) y[i] -= N[l * k + i] * y[l];
    y[i] /= N[i * k + i];
  }
  for (int j = 0; j < n; j++) {
    x[j] = wide ? 0 : y[j];
    for (int i = 0; wide && i < m; i++) x[j] += A[i * n + j] * y[i];
    if (!isfinite(x[j])) return false;
  }
  return true;
}
