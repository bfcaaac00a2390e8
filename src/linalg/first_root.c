// The earliest root of a polynomial in (0, 1].
//
// Isolation: the Bernstein coefficients on an interval change sign at least as often as the polynomial has roots there
// (Descartes), so no change means no root and one change means exactly one.  Intervals are cut by de Casteljau's
// scheme until one of the two holds (Lane and Riesenfeld, BIT 21 (1981) 112).  Then Newton, kept inside by bisection.
// Coefficients below the rounding error of their computation count as zero.
#include "linalg/linalg.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { DEEPEST = 60 };  // cuts: the interval is then a rounding error wide

// b_j = sum_{i<=j} C(j,i)/C(n,i) c_i, built row by row: scaled coefficients c_i / C(n,i), then n rounds of sums.
static void to_bernstein(const double* c, int n, double* b) {
  double binomial = 1;
  for (int i = 0; i <= n; i++) {
    b[i] = c[i] / binomial;
    binomial = binomial * (n - i) / (i + 1);
  }
  for (int round = 1; round <= n; round++)
    for (int j = n; j >= round; j--) b[j] += b[j - 1];
}

static int sign_changes(const double* b, int n, double noise) {
  int changes = 0, last = 0;
  for (int j = 0; j <= n; j++) {
    int s = b[j] > noise ? 1 : b[j] < -noise ? -1 : 0;
    if (s == 0) continue;
    if (last != 0 && s != last) changes++;
    last = s;
  }
  return changes;
}

// Cuts at the fraction x of the interval: left gets the coefficients on the first part, b those on the second, where
// de Casteljau leaves them.
static void cut(double* b, double* left, int n, double x) {
  left[0] = b[0];
  for (int round = 1; round <= n; round++) {
    for (int j = 0; j <= n - round; j++) b[j] += x * (b[j + 1] - b[j]);
    left[round] = b[0];
  }
}

static double horner(const double* c, int n, double x, double* slope) {
  double p = c[n], d = 0;
  for (int i = n - 1; i >= 0; i--) {
    d = d * x + p;
    p = p * x + c[i];
  }
  *slope = d;
  return p;
}

// One root between lo and hi, where the signs differ.
static double polish(const double* c, int n, double lo, double hi, double sign_lo) {
  double x = 0.5 * (lo + hi);
  for (int i = 0; i < 200; i++) {
    double d, p = horner(c, n, x, &d);
    if (p == 0) return x;
    if ((p > 0) == (sign_lo > 0)) lo = x;
    else hi = x;
    double next = d != 0 ? x - p / d : lo;
    if (!(next > lo && next < hi)) next = 0.5 * (lo + hi);
    if (fabs(next - x) <= DBL_EPSILON * fabs(next) || next == lo || next == hi) return next;
    x = next;
  }
  return x;
}

typedef struct search {
  const double* c;
  int n, direction;
  double noise;
} search;

// Touching or a close pair: decided at the deepest level by the place alone.
static bool crosses(const search* s, double sign_before, double sign_after) {
  if (s->direction > 0) return sign_before < 0 && sign_after >= 0;
  if (s->direction < 0) return sign_before > 0 && sign_after <= 0;
  return true;
}

static double sign_of(double x, double noise) { return x > noise ? 1 : x < -noise ? -1 : 0; }

// Where to cut: near the middle, but not on a root, which would then belong to neither part.
static double cut_fraction(const search* s, double lo, double hi) {
  static const double fraction[] = {0.5, 0.453125, 0.546875, 0.40625, 0.59375};
  for (int i = 0; i < 5; i++) {
    double slope, p = horner(s->c, s->n, lo + fraction[i] * (hi - lo), &slope);
    if (fabs(p) > 4 * s->noise) return fraction[i];
  }
  return 0.5;
}

double pl_first_root(const double* c, int n, int direction, double* work) {
  double size = 0;
  while (n > 0 && c[n] == 0) n--;
  for (int i = 0; i <= n; i++) {
    if (!(fabs(c[i]) <= DBL_MAX)) return -1;
    size += fabs(c[i]);
  }
  if (n == 0 || size == 0) return -1;
  search s = {c, n, direction, 4 * DBL_EPSILON * size};
  // a stack of intervals, the leftmost on top; each level holds one waiting right half
  double lo[DEEPEST + 2], hi[DEEPEST + 2];
  int depth[DEEPEST + 2], top = 0;
  double* at = work;  // coefficients of stack entry k at at + k (n+1)
  size_t width = (size_t)n + 1;
  to_bernstein(c, n, at);
  lo[0] = 0;
  hi[0] = 1;
  depth[0] = 0;
  while (top >= 0) {
    double* b = at + (size_t)top * width;
    int changes = sign_changes(b, n, s.noise);
    if (changes == 0) {
      // a root exactly at the right end shows as a last coefficient within rounding
      double first = sign_of(b[0], s.noise), last = sign_of(b[n], s.noise);
      if (hi[top] == 1 && last == 0 && first != 0 && crosses(&s, first, last)) return 1;
      top--;
      continue;
    }
    double first = sign_of(b[0], s.noise), last = sign_of(b[n], s.noise);
    if (changes == 1 && first != 0 && last != 0) {
      if (crosses(&s, first, last)) return polish(c, n, lo[top], hi[top], first);
      top--;
      continue;
    }
    if (depth[top] >= DEEPEST - 2) {
      if (crosses(&s, first, last) && lo[top] > 0) return 0.5 * (lo[top] + hi[top]);
      top--;
      continue;
    }
    double x = cut_fraction(&s, lo[top], hi[top]), mid = lo[top] + x * (hi[top] - lo[top]);
    cut(b, b + width, n, x);  // the left part goes on top
    lo[top + 1] = lo[top];
    hi[top + 1] = mid;
    lo[top] = mid;
    depth[top]++;
    depth[top + 1] = depth[top];
    top++;
  }
  return -1;
}
