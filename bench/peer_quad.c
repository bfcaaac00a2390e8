// Reference for a generated system: extrapolation of the modified midpoint rule (Gragg, Bulirsch,
// Stoer) in __float128, order 2 x 14,
// with constant steps; the caller compares two step sizes.  Usage: peer_quad END STEPS.  Prints q,
// v and the multipliers.
#include <quadmath.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

typedef __float128 real;
#define K(p, q) ((real)p##.0Q / (real)q##.0Q)
#define SIN     sinq
#define COS     cosq
#define SQRT    sqrtq
#define LOG     logq
#include SYSTEM

enum { N = 2 * N_Q, COLUMNS = 14 };

static void slope(real t, const real* y, real* f) {
  for (int i = 0; i < N_Q; i++) f[i] = y[N_Q + i];
  accelerations(t, y, f + N_Q, NULL);
}

static void midpoint(real t, const real* y, real H, int n, real* out) {
  static real a[N], b[N], f[N];
  real h = H / n;
  slope(t, y, f);
  for (int i = 0; i < N; i++) {
    a[i] = y[i];
    b[i] = y[i] + h * f[i];
  }
  for (int k = 1; k < n; k++) {
    slope(t + k * h, b, f);
    for (int i = 0; i < N; i++) {
      real next = a[i] + 2 * h * f[i];
      a[i] = b[i];
      b[i] = next;
    }
  }
  for (int i = 0; i < N; i++) out[i] = b[i];
}

int main(int argc, char** argv) {
  if (argc < 3) return 1;
  static real y[N], rows[2][COLUMNS][N], lambda[N_C + 1];
  real end = strtoflt128(argv[1], NULL);
  int steps = atoi(argv[2]);
  start(y);
  for (int s = 0; s < steps; s++) {
    real H = end / steps, t = end * s / steps;
    for (int j = 0; j < COLUMNS; j++) {
      real(*now)[N] = rows[j % 2];
      real(*before)[N] = rows[1 - j % 2];
      midpoint(t, y, H, 2 * (j + 1), now[0]);
      for (int k = 1; k <= j; k++) {
        real inner = (real)(j - k + 1) * (j - k + 1), outer = (real)(j + 1) * (j + 1);
        for (int i = 0; i < N; i++)
          now[k][i] = now[k - 1][i] + (now[k - 1][i] - before[k - 1][i]) * inner / (outer - inner);
      }
      if (j == COLUMNS - 1)
        for (int i = 0; i < N; i++) y[i] = now[j][i];
    }
  }
  static real a[N_Q];
  accelerations(end, y, a, lambda);
  for (int i = 0; i < N + N_C; i++) {
    char text[64];
    quadmath_snprintf(text, sizeof text, "%.28Qe", i < N ? y[i] : lambda[i - N]);
    puts(text);
  }
  return 0;
}
