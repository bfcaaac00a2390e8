// All roots of a polynomial on [0, 1].
//
// Isolation: the Bernstein coefficients on an interval enclose the polynomial, and those of its
// derivative change sign at least as often as it has extrema there (Descartes). Intervals are cut
// until the polynomial has no zero on them, is monotone, or has one extremum, at which it is cut
// again (Lane and Riesenfeld, BIT 21 (1981) 112). So a double root needs no luck with its sign: it
// is an extremum whose value is zero within what is known of the polynomial.
//
// Coefficients on an interval come from those at 0 by a Taylor shift, not from the interval around
// it: their rounding error then stays below a few ulps of sum |c_k| hi^k, however deep the cuts go.
#include "linalg/linalg.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum {
  DEEPEST = 48,      // cuts: the interval is then a rounding error wide
  CLOSE = 10,        // cuts after which an uncertain end is believed
  MOST_PARTS = 4096  // intervals looked at; noise between many roots makes more
};

double pl_root_noise(int n) { return (4 * n + 4) * DBL_EPSILON; }

// -------------------------------------------------------------------------------------- evaluation
static double horner(const double* c, int n, double x, double* slope) {
  double p = c[n], d = 0;
  for (int i = n - 1; i >= 0; i--) {
    d = d * x + p;
    p = p * x + c[i];
  }
  *slope = d;
  return p;
}

// c(lo + w s) = sum of a_i s^i, then Bernstein: b_j = sum_{i<=j} C(j,i)/C(n,i) a_i, built row by
// row.
static void to_bernstein(const double* c, int n, double lo, double w, double* b) {
  memcpy(b, c, ((size_t)n + 1) * sizeof *b);
  for (int i = 0; i < n && lo != 0; i++)
    for (int j = n - 1; j >= i; j--) b[j] += lo * b[j + 1];
  double power = 1, binomial = 1;
  for (int i = 0; i <= n; i++) {
    b[i] *= power / binomial;
    power *= w;
    binomial = binomial * (n - i) / (i + 1);
  }
  for (int round = 1; round <= n; round++)
    for (int j = n; j >= round; j--) b[j] += b[j - 1];
}

// The sign change between lo and hi, where the sign is `before` at lo.
static double polish(const double* c, int n, double lo, double hi, int before) {
  double x = 0.5 * (lo + hi);
  for (int i = 0; i < 200; i++) {
    double d, p = horner(c, n, x, &d);
    if (p == 0) return x;
    if ((p > 0) == (before > 0)) lo = x;
    else hi = x;
    double next = d != 0 ? x - p / d : lo;
    if (!(next > lo && next < hi)) next = 0.5 * (lo + hi);
    if (fabs(next - x) <= DBL_EPSILON * fabs(next) || next == lo || next == hi) return next;
    x = next;
  }
  return x;
}

// ---------------------------------------------------------------------------- what is known so far
// The walk from 0 to 1: the last place with a certain sign, and whether what follows it is zero
// within the noise.
typedef struct walk {
  const double* c;
  const double* slope;  // coefficients of the derivative
  double* b;
  int n, direction;  // direction: only crossings this way, 0: all roots
  double noise, floor;
  double firm;  // last place with a certain sign
  int sign;     // that sign, 0: none yet
  bool zero;    // between firm and here it is not certain
  double zero_from, zero_to;
  int parts;
  pl_real_root* out;
  int found, room;
} walk;

static double size_at(const walk* w, double x) {
  double size = 0;
  for (int k = w->n; k >= 0; k--) size = size * x + fabs(w->c[k]);
  return size;
}

static double known_to(const walk* w, double x) { return fmax(w->noise * size_at(w, x), w->floor); }

static int sign_of(double x, double noise) { return x > noise ? 1 : x < -noise ? -1 : 0; }

static bool is_wanted(const walk* w, int before, int after) {
  if (w->direction == 0) return true;
  // one side may be unknown: at an end
  return w->direction > 0 ? before <= 0 && after >= 0 && before != after
                          : before >= 0 && after <= 0 && before != after;
}

static void give(walk* w, double x, int before, int after) {
  if (w->found < w->room && is_wanted(w, before, after))
    w->out[w->found++] = (pl_real_root){x, before, after};
}

// Where the polynomial is nearest to zero, between two places; `otherwise` when it has no extremum
// of this kind there.
static double touching_place(const walk* w, double from, double to, int sign, double otherwise) {
  double d, slope_from = horner(w->slope, w->n - 1, from, &d),
            slope_to = horner(w->slope, w->n - 1, to, &d);
  if (sign * slope_from < 0 && sign * slope_to > 0)
    return polish(w->slope, w->n - 1, from, to, -sign);
  return otherwise;
}

// The polynomial has the sign s at x for certain.
static void firm(walk* w, double x, int s) {
  if (w->zero && w->sign == 0) give(w, w->zero_from, 0, s);
  else if (w->zero && w->sign == s)
    give(w, touching_place(w, w->firm, x, s, 0.5 * (w->zero_from + w->zero_to)), s, s);
  else if (w->sign != 0 && w->sign != s)
    give(w, polish(w->c, w->n, w->firm, x, w->sign), w->sign, s);
  w->firm = x;
  w->sign = s;
  w->zero = false;
}

static void unsure(walk* w, double from, double to) {
  if (!w->zero) w->zero_from = from;
  w->zero = true;
  w->zero_to = to;
}

static void point(walk* w, double x, int s) {
  if (s != 0) firm(w, x, s);
  else unsure(w, x, x);
}

// ------------------------------------------------------------------------------------- an interval
static int sign_changes(const double* b, int n, double noise) {
  int changes = 0, last = 0;
  for (int j = 0; j <= n; j++) {
    int s = sign_of(b[j], noise);
    if (s == 0) continue;
    if (last != 0 && s != last) changes++;
    last = s;
  }
  return changes;
}

static int slope_changes(double* b, int n, double noise) {
  for (int j = 0; j < n; j++) b[j] = b[j + 1] - b[j];
  return sign_changes(b, n - 1, noise);
}

// One extremum inside: monotone on both sides of it.
static void visit_extremum(walk* w, double lo, double hi, int s_lo, int s_hi) {
  double d, from = horner(w->slope, w->n - 1, lo, &d);
  double x = polish(w->slope, w->n - 1, lo, hi, from > 0 ? 1 : -1);
  point(w, lo, s_lo);
  point(w, x, sign_of(horner(w->c, w->n, x, &d), known_to(w, x)));
  point(w, hi, s_hi);
}

static void visit(walk* w, double lo, double hi, int depth) {
  int n = w->n;
  double* b = w->b;
  if (w->found >= w->room || ++w->parts > MOST_PARTS) return;
  to_bernstein(w->c, n, lo, hi - lo, b);
  double known = known_to(w, hi), rounding = fmin(known, DBL_EPSILON * size_at(w, hi));
  double known_lo = known_to(w, lo);
  int s_lo = sign_of(b[0], known_lo), s_hi = sign_of(b[n], known);
  bool above = true, below = true, zero = true;
  for (int j = 0; j <= n; j++) {
    above &= b[j] > known;
    below &= b[j] < -known;
    zero &= fabs(b[j]) <= known;
  }
  if (above || below) {
    firm(w, lo, above ? 1 : -1);
    firm(w, hi, above ? 1 : -1);
    return;
  }
  // what is known at the far end is not much less than at the near one
  if (zero && (known <= 2 * known_lo || depth >= DEEPEST)) {
    unsure(w, lo, hi);
    return;
  }
  int turns = slope_changes(b, n, 2 * rounding);
  double d, from = horner(w->slope, n - 1, lo, &d), to = horner(w->slope, n - 1, hi, &d);
  // rounding may hide a turn where the ends are not certain: looked at more closely
  bool plain = (s_lo != 0 && s_hi != 0) || (depth >= CLOSE && !zero);
  if ((turns == 0 && plain) || depth >= DEEPEST) {
    point(w, lo, s_lo);
    point(w, hi, s_hi);
  } else if (turns == 1 && !zero && from * to < 0) {
    visit_extremum(w, lo, hi, s_lo, s_hi);
  } else {
    double mid = lo + 0.5 * (hi - lo);
    visit(w, lo, mid, depth + 1);
    visit(w, mid, hi, depth + 1);
  }
}

static int search(const double* c, int n, int direction, double noise, double floor,
                  pl_real_root* out, int room, double* work) {
  while (n > 0 && c[n] == 0) n--;
  for (int i = 0; i <= n; i++)
    if (!(fabs(c[i]) <= DBL_MAX)) return 0;
  if (n <= 0 || room <= 0) return 0;
  double *b = work, *slope = work + n + 1;
  for (int i = 1; i <= n; i++) slope[i - 1] = i * c[i];
  walk w = {.c = c,
            .slope = slope,
            .b = b,
            .n = n,
            .direction = direction,
            .noise = fmax(noise, DBL_EPSILON),
            .floor = floor,
            .out = out,
            .room = room};
  visit(&w, 0, 1, 0);
  if (w.zero && w.sign != 0) give(&w, touching_place(&w, w.firm, 1, w.sign, 1), w.sign, 0);
  else if (w.zero) give(&w, 0, 0, 0);
  return w.found;
}

int pl_roots(const double* c, int n, double noise, double floor, pl_real_root* out, int room,
             double* work) {
  return search(c, n, 0, noise, floor, out, room, work);
}

double pl_first_root(const double* c, int n, int direction, double* work) {
  pl_real_root root[2];
  int found = search(c, n, direction, pl_root_noise(n), 0, root, 2, work);
  for (int i = 0; i < found; i++)
    if (root[i].x > 0 && root[i].before != 0) return root[i].x;
  return -1;
}
