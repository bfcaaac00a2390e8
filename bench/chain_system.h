// The chain of N_CHAIN unit masses on unit rods, by hand: x and y of mass i at 2i and 2i + 1.  The
// tensions solve a tridiagonal
// system, which takes 20 operations a mass.  What bench/straight.py generates for small systems,
// in loops.
enum { N_LINKS = N_CHAIN, N_Q = 2 * N_LINKS, N_C = N_LINKS };
#define WITHOUT_JACOBIAN

static void start(real* y) {
  for (int i = 0; i < 2 * N_Q; i++) y[i] = i < N_Q && i % 2 == 0 ? i / 2 + 1 : 0;
}

// Rods and their rates.
static inline void rods(const real* restrict y, real* restrict s) {
  s[0] = y[0];
  s[1] = y[1];
  for (int i = 2; i < N_Q; i++) s[i] = y[i] - y[i - 2];
}

static void accelerations(real t, const real* restrict y, real* restrict a, real* restrict lambda) {
  (void)t;
  const real g = K(981, 100);
  real s[N_Q], w[N_Q], d[N_LINKS], f[N_LINKS], z[N_LINKS + 1];
  rods(y, s);
  rods(y + N_Q, w);
  // T_i |s_i|² (2, first 1) - T_{i-1} s_i s_{i-1} - T_{i+1} s_i s_{i+1} = |w_i|², the first less g
  // s_y
  for (int i = 0; i < N_LINKS; i++) {
    d[i] = (i ? 2 : 1) * (s[2 * i] * s[2 * i] + s[2 * i + 1] * s[2 * i + 1]);
    z[i] = w[2 * i] * w[2 * i] + w[2 * i + 1] * w[2 * i + 1];
    f[i] = i ? -(s[2 * i] * s[2 * i - 2] + s[2 * i + 1] * s[2 * i - 1]) : 0;
  }
  z[0] -= g * s[1];
  d[0] = 1 / d[0];
  for (int i = 1; i < N_LINKS; i++) {
    real ratio = f[i] * d[i - 1];
    d[i] = 1 / (d[i] - ratio * f[i]);
    z[i] -= ratio * z[i - 1];
  }
  z[N_LINKS - 1] *= d[N_LINKS - 1];
  z[N_LINKS] = 0;
  for (int i = N_LINKS - 2; i >= 0; i--) z[i] = (z[i] - f[i + 1] * z[i + 1]) * d[i];
  for (int i = 0; i < N_LINKS; i++) {
    a[2 * i] = (i + 1 < N_LINKS ? z[i + 1] * s[2 * i + 2] : 0) - z[i] * s[2 * i];
    a[2 * i + 1] = (i + 1 < N_LINKS ? z[i + 1] * s[2 * i + 3] : 0) - z[i] * s[2 * i + 1] - g;
  }
  if (lambda)
    for (int i = 0; i < N_LINKS; i++) lambda[i] = -z[i] / 2;
}

// GGL: unknowns q, v, λ, μ; rows q' - v - Gᵀμ, v' - F - Gᵀλ, |s|² - 1, 2 s·w.
enum { N_GGL = 2 * N_Q + 2 * N_C, N_ENTRIES = 2 * 7 * N_Q + 10 * N_Q + 24 * N_C };

static void ggl_residual(real t, const real* restrict y, const real* restrict yp,
                         real* restrict r) {
  (void)t;
  real s[N_Q], w[N_Q];
  const real *lambda = y + 2 * N_Q, *mu = lambda + N_C;
  rods(y, s);
  rods(y + N_Q, w);
  for (int k = 0; k < N_Q; k++) {
    int i = k / 2;
    bool more = i + 1 < N_LINKS;
    r[k] = yp[k] - y[N_Q + k] - 2 * mu[i] * s[k] + (more ? 2 * mu[i + 1] * s[k + 2] : 0);
    r[N_Q + k] = yp[N_Q + k] + (k % 2 ? K(981, 100) : 0) - 2 * lambda[i] * s[k]
                 + (more ? 2 * lambda[i + 1] * s[k + 2] : 0);
  }
  for (int i = 0; i < N_LINKS; i++) {
    r[2 * N_Q + i] = s[2 * i] * s[2 * i] + s[2 * i + 1] * s[2 * i + 1] - 1;
    r[2 * N_Q + N_C + i] = 2 * (s[2 * i] * w[2 * i] + s[2 * i + 1] * w[2 * i + 1]);
  }
}

static int ggl_rows[N_ENTRIES], ggl_columns[N_GGL + 1];

// Column by column; the pattern is written along.
static void ggl_jacobian(real t, real cj, const real* restrict y, const real* restrict yp,
                         real* restrict entries) {
  (void)t;
  (void)yp;
  real s[N_Q], w[N_Q];
  const real *lambda = y + 2 * N_Q, *mu = lambda + N_C;
  int n = 0;
#define PUT(row, value) (ggl_rows[n] = (row), entries[n++] = (value))
  rods(y, s);
  rods(y + N_Q, w);
  for (int level = 0; level < 2; level++) {  // columns of q, then of v
    for (int k = 0; k < N_Q; k++) {
      int i = k / 2;
      bool more = i + 1 < N_LINKS;
      ggl_columns[level * N_Q + k] = n;
      for (int of = 0; of < 2 && level == 0; of++) {  // Gᵀμ and Gᵀλ by q
        const real* l = of ? lambda : mu;
        if (i > 0) PUT(of * N_Q + k - 2, 2 * l[i]);
        PUT(of * N_Q + k, -2 * l[i] - (more ? 2 * l[i + 1] : 0) + (of == 0 ? cj : 0));
        if (more) PUT(of * N_Q + k + 2, 2 * l[i + 1]);
      }
      if (level == 1) {
        PUT(k, -1);
        PUT(N_Q + k, cj);
      }
      if (level == 0) {
        PUT(2 * N_Q + i, 2 * s[k]);
        if (more) PUT(2 * N_Q + i + 1, -2 * s[k + 2]);
      }
      const real* by = level == 0 ? w : s;
      PUT(2 * N_Q + N_C + i, 2 * by[k]);
      if (more) PUT(2 * N_Q + N_C + i + 1, -2 * by[k + 2]);
    }
  }
  for (int of = 1; of >= 0; of--) {  // columns of λ, then of μ
    for (int i = 0; i < N_LINKS; i++) {
      ggl_columns[2 * N_Q + (1 - of) * N_C + i] = n;
      for (int k = 2 * i - 2; k < 2 * i + 2; k++)
        if (k >= 0) PUT(of * N_Q + k, k < 2 * i ? 2 * s[k + 2] : -2 * s[k]);
    }
  }
  ggl_columns[N_GGL] = n;
#undef PUT
}
