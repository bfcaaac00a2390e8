// The step that a series allows, after [JorbaZou2005], with separate norms for positions and
// velocities, which have different units.  See theory (10.4), (10.5).
#include "solve/stepper/taylor/taylor_impl.h"

#include <float.h>
#include <math.h>
#include <string.h>

// Binary logarithm to four digits, which is plenty for a step: exponent, and a cubic for the
// mantissa. Several at once, which takes little longer than one.
static void rough_log2(const double* x, double* log, int n) {
  for (int i = 0; i < n; i++) {
    uint64_t bits;
    memcpy(&bits, &x[i], sizeof bits);
    int exponent = (int)(bits >> 52) - 1023;
    bits = (bits & 0xfffffffffffffu) | 0x3ff0000000000000u;
    double m;
    memcpy(&m, &bits, sizeof m);
    double y = (m - 1) / (m + 1), z = y * y;  // ln m = 2 artanh y
    log[i] = exponent + 2.8853900817779268 * y * (1 + z * (1 / 3.0 + z * (0.2 + z * (1 / 7.0))));
  }
  for (int i = 0; i < n; i++)
    if (!(x[i] >= DBL_MIN) || x[i] > DBL_MAX)
      log[i] = x[i] > DBL_MAX ? (double)INFINITY : x[i] >= 0 ? -2000 : (double)NAN;
}

void pl_block_rows(int last, int row[PL_BLOCK_ROWS]) {
  for (int i = 0; i < 4; i++) row[i] = i;
  row[4] = last - 1;
  row[5] = last;
}

void pl_block_norms(const double* X, int n, int last, double* norm) {
  int row[PL_BLOCK_ROWS];
  pl_block_rows(last, row);
  for (int i = 0; i < PL_BLOCK_ROWS; i++) norm[i] = pl_norm(X + (size_t)row[i] * (size_t)n, n);
}

// Radius of a block from its last two coefficients: (|x| / |x_k|)^(1/k), as a logarithm. The size
// |x| is that of the block at the point, or what an early coefficient and the radius say when it is
// near zero there.
static double block_radius(const double* norm, int last) {
  double log[PL_BLOCK_ROWS], least = (double)INFINITY;
  rough_log2(norm, log, PL_BLOCK_ROWS);
  double size = log[0], before = log[4], top = log[5];
  if (isnan(top) || isnan(before)) return -(double)INFINITY;
  // beyond a double: lower orders decide
  if (isinf(top) || isinf(before)) return (double)INFINITY;
  if (top > -2000)
    for (int k = 1; k <= 3 && k < last; k++)
      size = pl_larger(size, log[k] + k * (log[k] - top) / (last - k));
  else if (size <= -2000) size = 0;
  if (before > -2000) least = (size - before) / (last - 1);
  if (top > -2000) least = pl_smaller(least, (size - top) / last);
  return least;
}

// A step twice as long as the one before is looked at closely: coefficients that are rounding make
// it three to seven times as long. What many orders say counts where it is clearly less: ordinary
// steps stay as they are.
static const double grown = 2, clearly = 1.3;

// Radius of a block from the norms of many orders, where the last two may be none or rounding:
// motions that start at rest or in a symmetric position have coefficients of every second or fourth
// order only, and others have wider gaps. The least of what orders of the upper half say, each as
// if it was the last; infinite where all of these are zero, as those of a fall are.
static double many_orders_radius(const double* X, int n, int last) {
  enum { EARLY = 3 };
  double least = (double)INFINITY, first[EARLY + 1];
  int top = 0;
  for (int k = last; k > last / 2 || (top == 0 && k > EARLY && k > last / 4); k--) {
    double norm = pl_norm(X + (size_t)k * (size_t)n, n), log;
    rough_log2(&norm, &log, 1);
    if (isnan(log)) return -(double)INFINITY;
    if (log <= -2000 || isinf(log)) continue;
    if (top == 0) {
      top = k;
      for (int j = 0; j <= EARLY; j++) {
        double early = pl_norm(X + (size_t)j * (size_t)n, n), of_early;
        rough_log2(&early, &of_early, 1);
        first[j] = of_early + j * (of_early - log) / (k - j);
        if (of_early <= -2000) first[j] = -(double)INFINITY;
        if (j > 0) first[0] = pl_larger(first[0], first[j]);
      }
      if (!isfinite(first[0])) first[0] = 0;
    }
    least = pl_smaller(least, (first[0] - log) / k);
  }
  return least;
}

double pl_series_length(const pl_run* run, const double* q, const double* v) {
  int p = run->order;
  // e^shrink of the radius makes p - 1 factors of tol together; the rest is their safety factor,
  // eq. (3-8) there
  double shrink = 1.4426950408889634 * (0.7 / (p - 1) - run->taylor->shrink);
  double radius = pl_smaller(block_radius(q, p + 1), block_radius(v, p)), h = exp2(radius - shrink);
  if (!(h <= grown * run->control.h_series) || isinf(run->control.h_series)) {
    double all = exp2(pl_smaller(many_orders_radius(run->dae.Q, run->n_q, p + 1),
                                 many_orders_radius(run->dae.V, run->n_q, p))
                      - shrink);
    if (!(h <= clearly * all)) h = all;
  }
  return h;
}
