// Coefficients of Radau IIA with s stages: nodes, Runge-Kutta matrix, the eigenvectors that split
// the stages, weights of the error estimate. [HairerWanner1996, IV.5 and IV.8],
// [HairerWanner1999]. All computed here, in long double.
//
//   nodes      c_i are the zeros of P_s(2 c - 1) - P_{s-1}(2 c - 1), the last one is 1
//   matrix     sum_j a_ij c_j^{q-1} = c_i^q / q for q = 1..s
//   spectrum   det(I - z A) is the denominator of the Padé approximation (s-1, s) of e^z; its
//              zeros are the eigenvalues
//              γ of A^-1. The eigenvector is x_i = sum_k N^(k)(c_i) / γ^k with N(τ) = prod (τ -
//              c_j): the polynomial
//              u with u' - γ u = multiple of N and u(0) = 0.
//   estimate   weights b^ of order s with b^_0 = 1 / γ_0 at the start of the step, γ_0 being the
//              real eigenvalue
// See theory (11.3).
#include "solve/stepper/radau/radau_impl.h"

#include <complex.h>
#include <math.h>

typedef long double real;
typedef long double complex cplx;
enum { MOST = PL_RADAU_MOST };

// ------------------------------------------------------------------------------------------- nodes
static real legendre(int n, real x) {
  real a = 1, b = x;
  if (n == 0) return a;
  for (int k = 1; k < n; k++) {
    real c = ((2 * k + 1) * x * b - k * a) / (k + 1);
    a = b;
    b = c;
  }
  return b;
}

static real node_function(int s, real c) {
  return legendre(s, 2 * c - 1) - legendre(s - 1, 2 * c - 1);
}

static real between(int s, real lo, real hi) {
  bool rising = node_function(s, lo) < 0;
  for (int i = 0; i < 100; i++) {
    real mid = (lo + hi) / 2;
    if ((node_function(s, mid) < 0) == rising) lo = mid;
    else hi = mid;
  }
  return (lo + hi) / 2;
}

static void find_nodes(real* c, int s) {
  enum { GRID = 400 };
  int n = 0;
  for (int i = 0; i + 1 < GRID && n < s - 1; i++) {
    real lo = (real)i / GRID, hi = (real)(i + 1) / GRID;
    if ((node_function(s, lo) < 0) != (node_function(s, hi) < 0)) c[n++] = between(s, lo, hi);
  }
  c[s - 1] = 1;
}

// ----------------------------------------------------------------------------- small dense systems
// Solves M x = b for the columns of b by elimination with pivoting; M and b are overwritten.
static void solve(cplx M[MOST + 1][MOST + 1], cplx b[MOST + 1][MOST + 1], int n) {
  for (int k = 0; k < n; k++) {
    int r = k;
    for (int i = k + 1; i < n; i++)
      if (cabsl(M[i][k]) > cabsl(M[r][k])) r = i;
    for (int j = 0; j < n; j++) {
      cplx x = M[k][j];
      M[k][j] = M[r][j];
      M[r][j] = x;
      x = b[k][j];
      b[k][j] = b[r][j];
      b[r][j] = x;
    }
    for (int i = 0; i < n; i++) {
      if (i == k) continue;
      cplx f = M[i][k] / M[k][k];
      for (int j = 0; j < n; j++) M[i][j] -= f * M[k][j];
      for (int j = 0; j < n; j++) b[i][j] -= f * b[k][j];
    }
  }
  for (int k = 0; k < n; k++)
    for (int j = 0; j < n; j++) b[k][j] /= M[k][k];
}

// out = inverse of the matrix
static void invert(cplx out[MOST + 1][MOST + 1], cplx M[MOST + 1][MOST + 1], int n) {
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) out[i][j] = i == j;
  solve(M, out, n);
}

static void invert_powers(cplx out[MOST + 1][MOST + 1], const real* x, int n) {
  cplx M[MOST + 1][MOST + 1];
  for (int i = 0; i < n; i++)
    for (int k = 0; k < n; k++) M[i][k] = k == 0 ? 1 : powl(x[i], k);
  invert(out, M, n);
}

// ---------------------------------------------------------------------------------------- spectrum
static real factorial(int n) { return n < 2 ? 1 : n * factorial(n - 1); }

// Denominator of the Padé approximation: coefficient of z^i.
static void find_denominator(real* d, int s) {
  for (int i = 0; i <= s; i++)
    d[i] = factorial(2 * s - 1 - i) * factorial(s)
           / (factorial(2 * s - 1) * factorial(i) * factorial(s - i)) * (i % 2 ? -1 : 1);
}

// All zeros at once, after Durand and Kerner.
static void find_zeros(cplx* z, const real* d, int s) {
  for (int i = 0; i < s; i++) z[i] = s * cpowl(0.4L + 0.9L * I, i);
  real most = 1;
  for (int round = 0; round < 500 && most > 1e-18L; round++) {
    most = 0;
    for (int i = 0; i < s; i++) {
      cplx p = d[s], q = d[s];
      for (int k = s - 1; k >= 0; k--) p = p * z[i] + d[k];
      for (int j = 0; j < s; j++)
        if (j != i) q *= z[i] - z[j];
      z[i] -= p / q;
      most = fmaxl(most, cabsl(p / q) / cabsl(z[i]));
    }
  }
}

// The real zero first, then those above the axis.
static int sort_zeros(cplx* z, int s) {
  cplx sorted[MOST];
  int n = 1;
  for (int i = 0; i < s; i++)
    if (fabsl(cimagl(z[i])) < 1e-9L) sorted[0] = creall(z[i]);
  for (int i = 0; i < s; i++)
    if (cimagl(z[i]) > 1e-9L) sorted[n++] = z[i];
  for (int i = 0; i < n; i++) z[i] = sorted[i];
  return n;
}

// x_i = sum_k N^(k)(c_i) / γ^k, scaled to a largest component of one
static void find_vector(cplx* x, cplx gamma, const real* c, int s) {
  real N[MOST + 2] = {1};
  for (int j = 0; j < s; j++)
    for (int k = j + 1; k >= 0; k--) N[k] = (k > 0 ? N[k - 1] : 0) - c[j] * N[k];
  for (int i = 0; i < s; i++) x[i] = 0;
  cplx scale = 1;
  for (int order = 0; order <= s; order++, scale /= gamma) {
    for (int i = 0; i < s; i++) {
      real value = 0;
      for (int k = s; k >= order; k--)
        value = value * c[i] + N[k] * factorial(k) / factorial(k - order);
      x[i] += scale * value;
    }
  }
  cplx most = 0;
  for (int i = 0; i < s; i++)
    if (cabsl(x[i]) > cabsl(most)) most = x[i];
  for (int i = 0; i < s; i++) x[i] /= most;
}

static void put(double* to, cplx z) {
  to[0] = (double)creall(z);
  to[1] = (double)cimagl(z);
}

static real find_spectrum(pl_radau_method* m, const real* c) {
  int s = m->s;
  real d[MOST + 1];
  cplx z[MOST], x[MOST], X[MOST + 1][MOST + 1], Y[MOST + 1][MOST + 1];
  find_denominator(d, s);
  find_zeros(z, d, s);
  int n = sort_zeros(z, s), col = 0;
  m->n_pairs = n - 1;
  for (int k = 0; k < n; k++) {
    find_vector(x, z[k], c, s);
    put(m->gamma[k], z[k]);
    for (int i = 0; i < s; i++) {
      put(m->X[k][i], x[i]);
      X[i][col] = x[i];
      if (k > 0) X[i][col + 1] = conjl(x[i]);
    }
    col += k > 0 ? 2 : 1;
  }
  invert(Y, X, s);
  for (int k = 0; k < n; k++)
    for (int i = 0; i < s; i++) put(m->Y[k][i], Y[k == 0 ? 0 : 2 * k - 1][i]);
  return creall(z[0]);
}

// --------------------------------------------------------------------------------------------- all
// error = γ_0 (b^ - b) A^-1, where b is the last row of A.
static void find_estimate(pl_radau_method* m, cplx moments[MOST + 1][MOST + 1],
                          cplx inverse[MOST + 1][MOST + 1], cplx A[MOST + 1][MOST + 1],
                          real gamma) {
  int s = m->s;
  real b[MOST];
  // sum_i b^_i c_i^{q-1} = 1/q, less b^_0 for q = 1: moments is the inverse of the matrix c_i^{q-1}
  for (int i = 0; i < s; i++) {
    b[i] = -creall(moments[0][i]) / gamma;
    for (int q = 0; q < s; q++) b[i] += creall(moments[q][i]) / (q + 1);
    b[i] -= creall(A[s - 1][i]);
  }
  for (int j = 0; j < s; j++) {
    real e = 0;
    for (int i = 0; i < s; i++) e += b[i] * creall(inverse[i][j]);
    m->error[j] = (double)(gamma * e);
  }
}

void pl_radau_method_make(pl_radau_method* m, int s) {
  real c[MOST], with_zero[MOST + 1] = {0};
  cplx moments[MOST + 1][MOST + 1], powers[MOST + 1][MOST + 1], A[MOST + 1][MOST + 1],
      copy[MOST + 1][MOST + 1], inverse[MOST + 1][MOST + 1];
  m->s = s;
  find_nodes(c, s);
  for (int i = 0; i < s; i++) m->c[i] = (double)(with_zero[i + 1] = c[i]);
  // row q of `moments` gives coefficient q of the polynomial through values at the nodes
  invert_powers(moments, c, s);
  for (int i = 0; i < s; i++) {
    for (int j = 0; j < s; j++) {
      A[i][j] = 0;
      for (int q = 0; q < s; q++) A[i][j] += powl(c[i], q + 1) / (q + 1) * moments[q][j];
      copy[i][j] = A[i][j];
      m->A[i][j] = (double)creall(A[i][j]);
    }
  }
  invert(inverse, copy, s);
  for (int i = 0; i < s; i++)
    for (int j = 0; j < s; j++) m->inverse[i][j] = (double)creall(inverse[i][j]);
  invert_powers(powers, with_zero, s + 1);
  for (int k = 0; k <= s; k++)
    for (int i = 0; i <= s; i++) m->power_all[k][i] = (double)creall(powers[k][i]);
  real gamma = find_spectrum(m, c);
  find_estimate(m, moments, inverse, A, gamma);
}
