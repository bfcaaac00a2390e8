// What is independent of what: QR with column pivoting (Businger and Golub, Numer. Math. 7 (1965)
// 269) and a maximal independent subset of rows by priority.
#include "linalg/linalg.h"

#include <float.h>
#include <math.h>

// Column j of the remaining rows, scaled against overflow.
static double length_from(const double* col, int from, int m) {
  double s = 0;
  for (int i = from; i < m; i++) s += col[i] * col[i];
  return sqrt(s);
}

static void swap_columns(double* A, int m, int j, int k) {
  for (int i = 0; i < m; i++) {
    double x = A[i + (size_t)j * m];
    A[i + (size_t)j * m] = A[i + (size_t)k * m];
    A[i + (size_t)k * m] = x;
  }
}

// Householder vector of column k (its first entry 1 is implied); returns tau.
static double reflector(double* col, int k, int m) {
  double length = length_from(col, k, m);
  if (length == 0) return 0;
  double alpha = col[k] > 0 ? -length : length, first = col[k] - alpha;
  for (int i = k + 1; i < m; i++) col[i] /= first;
  col[k] = alpha;
  return -first / alpha;
}

static void reflect(const double* v, double tau, double* x, int k, int m) {
  double s = x[k];
  for (int i = k + 1; i < m; i++) s += v[i] * x[i];
  s *= tau;
  x[k] -= s;
  for (int i = k + 1; i < m; i++) x[i] -= s * v[i];
}

int pl_qr_factor(double* A, int* jpvt, double* tau, double* norm, int m, int n, double rel) {
  int steps = m < n ? m : n, rank = 0;
  for (int j = 0; j < n; j++) jpvt[j] = j;
  for (int k = 0; k < steps; k++) {
    // lengths are recomputed: the update formula loses digits where rank decisions need them
    int best = k;
    for (int j = k; j < n; j++) {
      norm[j] = length_from(A + (size_t)j * m, k, m);
      if (norm[j] > norm[best]) best = j;
    }
    if (best != k) {
      swap_columns(A, m, k, best);
      int p = jpvt[k];
      jpvt[k] = jpvt[best];
      jpvt[best] = p;
    }
    double* col = A + (size_t)k * m;
    tau[k] = reflector(col, k, m);
    for (int j = k + 1; j < n; j++) reflect(col, tau[k], A + (size_t)j * m, k, m);
    if (fabs(col[k]) > rel * fabs(A[0]) && fabs(col[k]) <= DBL_MAX) rank = rank == k ? k + 1 : rank;
  }
  return rank;
}

// b := Q^T b with k reflectors
static void apply_qt(const double* A, const double* tau, double* b, int m, int k) {
  for (int j = 0; j < k; j++) reflect(A + (size_t)j * m, tau[j], b, j, m);
}

void pl_qr_least_squares(const double* A, const double* tau, double* b, int m, int k) {
  apply_qt(A, tau, b, m, k);
  for (int j = k - 1; j >= 0; j--) {
    const double* col = A + (size_t)j * m;
    b[j] /= col[j];
    for (int i = 0; i < j; i++) b[i] -= col[i] * b[j];
  }
}

// -------------------------------------------------------------------------------- independent rows
static double row_length(const double* a, int n) {
  double s = 0, most = 0;
  for (int j = 0; j < n; j++) s += a[j] * a[j];
  if (s > 1e-290 && s < 1e290) return sqrt(s);
  // squares leave the range: with a scale
  for (int j = 0; j < n; j++) most = fabs(a[j]) > most ? fabs(a[j]) : most;
  if (most == 0 || !(most <= DBL_MAX) || isnan(s)) return 0;
  s = 0;
  for (int j = 0; j < n; j++) s += (a[j] / most) * (a[j] / most);
  return most * sqrt(s);
}

static void take_out(double* a, const double* unit, int n) {
  double s = 0;
  for (int j = 0; j < n; j++) s += a[j] * unit[j];
  for (int j = 0; j < n; j++) a[j] -= s * unit[j];
}

// The row of this priority of which most is left; -1 when none has more than rel.
static int most_left(const double* A, const int* priority, const bool* taken, const double* left,
                     int m, int level, double rel) {
  int best = -1;
  (void)A;
  for (int r = 0; r < m; r++) {
    if (taken[r] || priority[r] != level || !(left[r] > rel)) continue;
    // a clear lead is needed to overtake an earlier row, so that the choice does not hang on
    // rounding
    if (best < 0 || left[r] > left[best] * (1 + 1e-6)) best = r;
  }
  return best;
}

static int next_priority(const int* priority, int m, int after) {
  int next = INT32_MAX;
  for (int r = 0; r < m; r++)
    if (priority[r] > after && priority[r] < next) next = priority[r];
  return next;
}

int pl_independent_rows(double* A, const int* priority, bool* taken, double* work, int m, int n,
                        double rel, double* smallest) {
  int count = 0;
  *smallest = 1;
  for (int r = 0; r < m; r++) {
    double* a = A + (size_t)r * n;
    double length = row_length(a, n);
    taken[r] = false;
    work[r] = length > 0 ? 1 : 0;
    for (int j = 0; j < n && length > 0; j++) a[j] /= length;
  }
  for (int level = next_priority(priority, m, INT32_MIN); level != INT32_MAX;
       level = next_priority(priority, m, level)) {
    for (int r; (r = most_left(A, priority, taken, work, m, level, rel)) >= 0;) {
      double* unit = A + (size_t)r * n;
      taken[r] = true;
      count++;
      if (work[r] < *smallest) *smallest = work[r];
      double length = row_length(unit, n);
      for (int j = 0; j < n; j++) unit[j] /= length;
      for (int s = 0; s < m; s++) {
        if (taken[s] || work[s] == 0) continue;
        double before = work[s];
        take_out(A + (size_t)s * n, unit, n);
        work[s] = row_length(A + (size_t)s * n, n);
        if (work[s] > 0.5 * before) continue;
        // much was taken out: what rounding left of it goes too (twice is enough, [Parlett1980])
        take_out(A + (size_t)s * n, unit, n);
        work[s] = row_length(A + (size_t)s * n, n);
      }
    }
  }
  return count;
}
