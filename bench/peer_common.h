// What the C peers share: the generated system in doubles, the clock, and runs that are repeated
// and timed.
#ifndef PEER_COMMON_H
#define PEER_COMMON_H

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef double real;
#define K(p, q) ((real)p##.0 / (real)q##.0)
#define SIN     sin
#define COS     cos
#define SQRT    sqrt
#define LOG     log
#include SYSTEM

enum { N_Y = 2 * N_Q };

static double cpu_us(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e6 * (double)t.tv_sec + 1e-3 * (double)t.tv_nsec;
}

static inline void slope(double t, const double* y, double* f) {
  memcpy(f, y + N_Q, N_Q * sizeof(double));
  accelerations(t, y, f + N_Q, NULL);
}

// Runs `once` until 60 ms are spent, five times at least, at most 2 s; prints the best time, the
// steps and the state.
// once(&us, y) leaves its time and the state; it returns the steps or a negative number where the
// peer gave up.
static int report(long (*once)(double* us, double* y)) {
  double best = (double)INFINITY, spent = 0, y[N_Y];
  long steps = 0;
  for (int i = 0; (i < 5 || spent < 60e3) && spent < 2e6; i++) {
    double us;
    steps = once(&us, y);
    if (steps < 0) {
      printf("failed %ld\n", steps);
      return 2;
    }
    spent += us;
    best = fmin(best, us);
  }
  printf("us %.3f\nsteps %ld\n", best, steps);
  for (int i = 0; i < N_Y; i++) printf("%.17g\n", y[i]);
  return 0;
}

#endif
