// Positions of rest of the equations as they stand:
//
//     dL/dq_i + Q_i + sum λ_c dg_c/dq_i = 0   at v = 0,      g = 0
//
// in all coordinates and multipliers, so without what the derivation chose or eliminated. A
// coordinate that one constraint drives alone, φ = Ω t, keeps its rate: rest is then rest beside
// it. Jacobians by central differences, steps by least squares (constraints may depend on each
// other).
#include <complex.h>
#include <math.h>

#include "witness/least_squares.h"
#include "witness/witness_impl.h"

enum { MOST_COORDINATES = PL_MOST_AT_REST, MOST_ROWS = PL_MOST_ROWS, MOST_ITERATIONS = 20 };
static const double solved = 1e-10;     // residual of a position of rest, in units of the terms
static const double difference = 1e-6;  // step of differences

struct pl_rest_field {
  pl_witness* w;
  const pl_trace* t;
  int n;    // coordinates that the motion knows
  int* at;  // of each: its place in the recording
  pl_symbol *q, *v, *a;
  int n_g, n_v;     // rows of coordinates; behind them rows of velocities
  pl_expr* g;       // (n_g + n_v)
  int* constraint;  // of each row, in the setup
  // dg/dq, of rows of velocities dg/dv: (n_g + n_v) x n, row after row
  pl_expr* slope;
  pl_expr* push;  // d/dt dL/dv - dL/dq - Q, at the accelerations in the table  (n)
  pl_expr* mass;  // d²L/dv dv  (n x n)
  double* drive;  // rate of each coordinate, 0 where nothing drives it  (n)
  // positions of rest are looked for: nothing but drives hangs on the time
  bool rests;
  pl_squares* squares;
  double *A, *b;  // its matrix and right side
};

int pl_rest_coordinates(const pl_rest_field* f) { return f->n; }
int pl_rest_place_of(const pl_rest_field* f, int at) {
  for (int i = 0; i < f->n; i++) {
    if (f->at[i] == at) return i;
  }
  return -1;
}
int pl_rest_constraint(const pl_rest_field* f, int row) { return f->constraint[row]; }
int pl_rest_rows(const pl_rest_field* f) { return f->n_g + f->n_v; }

// ----------------------------------------------------------------------------------- the equations
static void list_coordinates(pl_rest_field* f, const pl_recording* r) {
  pl_pool* p = f->w->pool;
  for (int i = 0; i < r->n_atoms && f->n >= 0; i++) {
    int at = -1;
    for (int k = 0; k < r->flat.n; k++) at = pl_same(r->flat.at[k], r->atom[i]) ? k : at;
    if (at < 0 || pl_kind_of(p, r->atom[i]) != PL_SYMBOL) {
      f->n = -1;
      return;
    }
    f->at[f->n] = at;
    f->q[f->n] = pl_symbol_of(p, r->atom[i]);
    f->v[f->n] = pl_symbol_dot(p, f->q[f->n]);
    f->a[f->n] = pl_symbol_dot(p, f->v[f->n]);
    f->n++;
  }
}

static void add_row(pl_rest_field* f, pl_expr g, int constraint, bool velocity) {
  pl_pool* p = f->w->pool;
  int k = f->n_g + f->n_v;
  f->g[k] = g;
  f->constraint[k] = constraint;
  for (int i = 0; i < f->n; i++)
    f->slope[k * f->n + i] = pl_diff(p, g, velocity ? f->v[i] : f->q[i]);
  if (velocity) f->n_v++;
  else f->n_g++;
}

static void list_rows(pl_rest_field* f) {
  const pl_model* m = f->t->model;
  const pl_trace_phase* start = &f->t->phases.at[0];
  for (int velocity = 0; velocity < 2; velocity++) {
    for (int i = 0; i < m->constraints.n; i++) {
      const pl_constraint* c = &m->constraints.at[i];
      if (c->has_velocity == (velocity == 1) && pl_trace_holds(f->t, start, i))
        add_row(f, c->g, pl_trace_constraint(f->t, i, 0), velocity == 1);
    }
    for (int k = 0; velocity == 0 && k < m->choose.n_maps; k++) {
      int constraint = f->t->recording->n_declared + k;
      if (!start->active[constraint]) continue;
      add_row(f, pl_sub(f->w->pool, m->choose.maps[k].old, m->choose.maps[k].map), constraint,
              false);
    }
  }
}

static void list_equations(pl_rest_field* f, const pl_recording* r) {
  pl_pool* p = f->w->pool;
  for (int i = 0; i < f->n; i++) {
    pl_expr momentum = pl_diff(p, r->lagrangian, f->v[i]);
    f->push[i] = pl_sub(p, pl_dt(p, momentum), pl_diff(p, r->lagrangian, f->q[i]));
    if (!pl_is_poison(r->force[i])) f->push[i] = pl_sub(p, f->push[i], r->force[i]);
    for (int j = 0; j < f->n; j++) f->mass[i * f->n + j] = pl_diff(p, momentum, f->v[j]);
  }
}

// φ = Ω t: the only coordinate in its row, and in no other row.  false: a row moves otherwise.
static bool find_drives(pl_rest_field* f) {
  pl_pool* p = f->w->pool;
  pl_symbol time = pl_time(p);
  for (int k = 0; k < f->n_g + f->n_v; k++) {
    if (!pl_has_symbol(p, f->g[k], time)) continue;
    int only = -1, rows = 0, columns = 0;
    for (int i = 0; i < f->n; i++) {
      if (!pl_is_zero_node(p, f->slope[k * f->n + i])) {
        columns++;
        only = i;
      }
    }
    for (int j = 0; j < f->n_g + f->n_v && only >= 0; j++)
      rows += !pl_is_zero_node(p, f->slope[j * f->n + only]);
    if (columns != 1 || rows != 1 || k >= f->n_g) return false;
    pl_expr rate = pl_neg(p, pl_div(p, pl_diff(p, f->g[k], time), f->slope[k * f->n + only]));
    if (!pl_is_zero_node(p, pl_diff(p, pl_diff(p, f->g[k], time), time))) return false;
    f->drive[only] = pl_eval(p, rate, f->t->value);
    if (!isfinite(f->drive[only])) return false;
  }
  for (int i = 0; i < f->n; i++) {
    if (pl_has_symbol(p, f->push[i], time)) return false;
  }
  return true;
}

pl_rest_field* pl_rest_make(pl_witness* w, const pl_trace* t) {
  const pl_recording* r = t->recording;
  int n = r->n_atoms, rows = t->model->constraints.n + t->model->choose.n_maps;
  if (!t->started || pl_is_poison(r->lagrangian) || n == 0 || n > MOST_COORDINATES
      || rows > MOST_ROWS)
    return NULL;
  pl_rest_field* f = PL_NEW(w->arena, pl_rest_field);
  *f = (pl_rest_field){.w = w, .t = t, .at = PL_ARRAY(w->arena, int, n)};
  f->q = PL_ARRAY(w->arena, pl_symbol, n);
  f->v = PL_ARRAY(w->arena, pl_symbol, n);
  f->a = PL_ARRAY(w->arena, pl_symbol, n);
  f->g = PL_ARRAY(w->arena, pl_expr, rows + 1);
  f->slope = PL_ARRAY(w->arena, pl_expr, (rows + 1) * n);
  f->constraint = PL_ARRAY(w->arena, int, rows + 1);
  f->push = PL_ARRAY(w->arena, pl_expr, n);
  f->mass = PL_ARRAY(w->arena, pl_expr, n * n);
  f->drive = PL_ARRAY(w->arena, double, n);
  list_coordinates(f, r);
  if (f->n < 0) return NULL;
  list_rows(f);
  list_equations(f, r);
  f->squares = pl_squares_make(w->arena, 2 * n + 2 * rows + 2);
  f->A = pl_squares_matrix(f->squares);
  f->b = pl_squares_right(f->squares);
  pl_state_open(w);
  f->rests = find_drives(f) && t->model->frictions.n == 0;
  return f;
}

bool pl_rest_is_possible(const pl_rest_field* f) { return f->rests; }

// Names of a map that does not hold: no mass, no force, no row.
int pl_rest_idle(const pl_rest_field* f) {
  const pl_pool* p = f->w->pool;
  int n = 0;
  for (int i = 0; i < f->n; i++) {
    bool idle = pl_is_zero_node(p, f->push[i]);
    for (int k = 0; k < f->n_g + f->n_v; k++) idle &= pl_is_zero_node(p, f->slope[k * f->n + i]);
    n += idle;
  }
  return n;
}

// ----------------------------------------------------------------------------------------- numbers
static void put(pl_rest_field* f, const double* q, const double* v) {
  pl_witness* w = f->w;
  for (int i = 0; i < w->n_value; i++)
    w->value[i] = i < f->t->n_value ? f->t->value[i] : (double)NAN;
  w->value[pl_time(w->pool).id] = 0;
  for (int i = 0; i < f->n; i++) {
    w->value[f->q[i].id] = q[i];
    w->value[f->v[i].id] = f->drive[i] + (v ? v[i] : 0);
    w->value[f->a[i].id] = 0;
  }
}

static double number(const pl_rest_field* f, pl_expr e) {
  return pl_eval(f->w->pool, e, f->w->value);
}

// The residual of everything: n equations of rest, then n_g constraints.
static void residual(pl_rest_field* f, const double* q, const double* lambda, double* out) {
  put(f, q, NULL);
  for (int i = 0; i < f->n; i++) {
    out[i] = -number(f, f->push[i]);
    for (int k = 0; k < f->n_g + f->n_v; k++)
      out[i] += lambda[k] * number(f, f->slope[k * f->n + i]);
  }
  for (int k = 0; k < f->n_g; k++) out[f->n + k] = number(f, f->g[k]);
}

static double size(const double* x, int n) {
  double most = 0;
  for (int i = 0; i < n; i++) most = isfinite(x[i]) ? fmax(most, fabs(x[i])) : (double)INFINITY;
  return most;
}

int pl_rest_rank(pl_rest_field* f, const double* q, bool with_velocities) {
  int m = f->n_g + (with_velocities ? f->n_v : 0);
  if (m == 0) return 0;
  put(f, q, NULL);
  for (int k = 0; k < m; k++) {
    double length = 0;
    for (int i = 0; i < f->n; i++) {
      double x = f->A[k + i * m] = number(f, f->slope[k * f->n + i]);
      if (!isfinite(x)) return -1;
      length = hypot(length, x);
    }
    for (int i = 0; i < f->n && length > 0; i++) f->A[k + i * m] /= length;
  }
  return pl_squares_rank(f->squares, m, f->n, 1e-9);
}

// One step of least squares with a matrix (m x n) in A and the residual in b: the unknowns in x
// move by -A⁺ b.
static void step(pl_rest_field* f, int m, int n, double* x) {
  pl_squares_solve(f->squares, m, n, x);
  for (int j = 0; j < n; j++) x[j] = -x[j];
}

// ---------------------------------------------------------------------------------------- searches
bool pl_rest_place(pl_rest_field* f, double* q, const bool* held) {
  double x[MOST_COORDINATES];
  int m = f->n_g;
  for (int it = 0; it < MOST_ITERATIONS; it++) {
    put(f, q, NULL);
    for (int k = 0; k < m; k++) f->b[k] = number(f, f->g[k]);
    double left = size(f->b, m);
    if (!isfinite(left)) return false;
    if (left < 1e-12 * (1 + size(q, f->n))) return true;
    int n = 0, of[MOST_COORDINATES];
    for (int i = 0; i < f->n; i++) {
      if (held && held[i]) continue;
      for (int k = 0; k < m; k++) f->A[k + n * m] = number(f, f->slope[k * f->n + i]);
      of[n++] = i;
    }
    if (n == 0) return false;
    step(f, m, n, x);
    double limit = 1 + size(q, f->n), most = size(x, n), part = most > limit ? limit / most : 1;
    for (int j = 0; j < n; j++) q[of[j]] += part * x[j];
  }
  return false;
}

// Terms of the equations of rest: what their residual is compared with.
static double force_size(pl_rest_field* f, const double* q, const double* lambda) {
  put(f, q, NULL);
  double most = 0;
  for (int i = 0; i < f->n; i++) {
    most = fmax(most, fabs(number(f, f->push[i])));
    for (int k = 0; k < f->n_g + f->n_v; k++)
      most = fmax(most, fabs(lambda[k] * number(f, f->slope[k * f->n + i])));
  }
  // forces that vanish at rest: their size beside it
  double beside[MOST_COORDINATES];
  for (int i = 0; i < f->n; i++) beside[i] = q[i] + 0.1 * (1 + fabs(q[i]));
  put(f, beside, NULL);
  for (int i = 0; i < f->n; i++) {
    double x = fabs(number(f, f->push[i]));
    if (isfinite(x)) most = fmax(most, 1e-3 * x);
  }
  return most;
}

// Least squares for the multipliers of some rows, the others zero; what is left of the equations.
static double left_with(pl_rest_field* f, const double* q, double* lambda, const int* row, int n) {
  double x[MOST_ROWS], out[2 * MOST_COORDINATES + MOST_ROWS];
  put(f, q, NULL);
  for (int i = 0; i < f->n; i++) {
    f->b[i] = -number(f, f->push[i]);
    for (int k = 0; k < n; k++) f->A[i + k * f->n] = number(f, f->slope[row[k] * f->n + i]);
  }
  if (n > 0) step(f, f->n, n, x);
  for (int k = 0; k < f->n_g + f->n_v; k++) lambda[k] = 0;
  for (int k = 0; k < n; k++) lambda[row[k]] = x[k];
  residual(f, q, lambda, out);
  double terms = force_size(f, q, lambda);
  return terms > 0 ? size(out, f->n) / terms : size(out, f->n);
}

// Maps of `choose` carry a force only where the constraints alone do not.
double pl_rest_left(pl_rest_field* f, const double* q, double* lambda) {
  int row[MOST_ROWS], n = 0, all = f->n_g + f->n_v;
  for (int k = 0; k < all; k++) {
    if (f->constraint[k] < f->t->recording->n_declared) row[n++] = k;
  }
  double left = left_with(f, q, lambda, row, n);
  if (left < 1e-6 || n == all) return left;
  for (int k = 0; k < all; k++) row[k] = k;
  return left_with(f, q, lambda, row, all);
}

static void jacobian(pl_rest_field* f, const double* q, const double* lambda, const int* of, int n,
                     int m) {
  double above[2 * MOST_COORDINATES + MOST_ROWS], below[2 * MOST_COORDINATES + MOST_ROWS],
      at[MOST_COORDINATES];
  for (int i = 0; i < f->n; i++) at[i] = q[i];
  for (int j = 0; j < n; j++) {
    double h = difference * (1 + fabs(q[of[j]]));
    at[of[j]] = q[of[j]] + h;
    residual(f, at, lambda, above);
    at[of[j]] = q[of[j]] - h;
    residual(f, at, lambda, below);
    at[of[j]] = q[of[j]];
    for (int k = 0; k < m; k++) f->A[k + j * m] = (above[k] - below[k]) / (2 * h);
  }
  put(f, q, NULL);
  for (int c = 0; c < f->n_g + f->n_v; c++) {
    for (int i = 0; i < f->n; i++) f->A[i + (n + c) * m] = number(f, f->slope[c * f->n + i]);
    for (int k = 0; k < f->n_g; k++) f->A[f->n + k + (n + c) * m] = 0;
  }
}

bool pl_rest_find(pl_rest_field* f, double* q, double* lambda, const bool* held) {
  int m = f->n + f->n_g, rows = f->n_g + f->n_v, n = 0, of[MOST_COORDINATES];
  for (int i = 0; i < f->n; i++) {
    if (!held || !held[i]) of[n++] = i;
  }
  for (int it = 0; it < MOST_ITERATIONS; it++) {
    double r[2 * MOST_COORDINATES + MOST_ROWS], x[2 * MOST_COORDINATES + MOST_ROWS];
    residual(f, q, lambda, r);
    double terms = force_size(f, q, lambda);
    if (!isfinite(size(r, m)) || !(terms > 0)) return false;
    bool placed = size(r + f->n, f->n_g) < 1e-11 * (1 + size(q, f->n));
    if (placed && size(r, f->n) < solved * terms) return true;
    jacobian(f, q, lambda, of, n, m);
    for (int k = 0; k < m; k++) f->b[k] = r[k];
    step(f, m, n + rows, x);
    double limit = 0.5 * (1 + size(q, f->n)), most = size(x, n),
           part = most > limit ? limit / most : 1;
    if (!isfinite(most)) return false;
    for (int j = 0; j < n; j++) q[of[j]] += part * x[j];
    for (int c = 0; c < rows; c++) lambda[c] += part * x[n + c];
  }
  return false;
}

// What is left of the equations a little beside a position, in their own units.
static double left_beside(pl_rest_field* f, const double* q, int i, double shift) {
  double at[MOST_COORDINATES], lambda[MOST_ROWS];
  for (int k = 0; k < f->n; k++) at[k] = q[k];
  at[i] += shift;
  if (!pl_rest_place(f, at, NULL)) return 0;
  double left = pl_rest_left(f, at, lambda), terms = force_size(f, at, lambda);
  return terms > 0 ? left * terms : left;
}

// Forces that vanish at a place of rest do so in proportion to the distance from it.
bool pl_rest_is_kink(pl_rest_field* f, const double* q) {
  static const double beside = 1e-5, nearer = 0.01, small = 1e-9;
  double lambda[MOST_ROWS];
  pl_rest_left(f, q, lambda);
  double terms = force_size(f, q, lambda);
  for (int i = 0; i < f->n; i++) {
    for (int side = -1; side <= 1; side += 2) {
      double h = side * beside * (1 + fabs(q[i])), far = left_beside(f, q, i, h);
      if (far > small * terms && left_beside(f, q, i, nearer * h) > 0.5 * far) return true;
    }
  }
  return false;
}

// --------------------------------------------------------------------------------------- stability
// Accelerations at (q, v), from the linear system of the equations and the constraints twice
// differentiated at rest.
static bool accelerations(pl_rest_field* f, const double* q, const double* v, double* a) {
  int rows = f->n_g + f->n_v, m = f->n + rows;
  put(f, q, v);
  for (int i = 0; i < f->n; i++) {
    f->b[i] = number(f, f->push[i]);
    for (int j = 0; j < f->n; j++) f->A[i + j * m] = number(f, f->mass[i * f->n + j]);
    for (int k = 0; k < rows; k++) {
      double g = number(f, f->slope[k * f->n + i]);
      f->A[i + (f->n + k) * m] = -g;
      f->A[f->n + k + i * m] = g;
    }
  }
  for (int k = 0; k < rows; k++) {
    for (int j = 0; j < rows; j++) f->A[f->n + k + (f->n + j) * m] = 0;
    f->b[f->n + k] = 0;  // terms of second order in v beside rest
  }
  double x[2 * MOST_COORDINATES + MOST_ROWS];
  step(f, m, m, x);
  for (int i = 0; i < f->n; i++) a[i] = x[i];
  return isfinite(size(a, f->n));
}

// Directions that the constraints leave, orthonormal: (n x d), column after column. -1: more than
// `most`.
static int free_directions(pl_rest_field* f, const double* q, int most, double* T) {
  int rows = f->n_g + f->n_v, n = f->n;
  put(f, q, NULL);
  double basis[MOST_COORDINATES][MOST_COORDINATES];
  int have = 0, d = 0;
  for (int k = 0; k < rows + n; k++) {
    double x[MOST_COORDINATES], length = 0, before = 0;
    for (int i = 0; i < n; i++) x[i] = k < rows ? number(f, f->slope[k * n + i]) : (i == k - rows);
    for (int i = 0; i < n; i++) before = hypot(before, x[i]);
    for (int pass = 0; pass < 2; pass++) {
      for (int b = 0; b < have; b++) {
        double dot = 0;
        for (int i = 0; i < n; i++) dot += x[i] * basis[b][i];
        for (int i = 0; i < n; i++) x[i] -= dot * basis[b][i];
      }
    }
    for (int i = 0; i < n; i++) length = hypot(length, x[i]);
    if (!(length > 1e-8 * before) || have == n) continue;
    for (int i = 0; i < n; i++) basis[have][i] = x[i] / length;
    if (k >= rows) {
      if (d == most) return -1;
      for (int i = 0; i < n; i++) T[d * n + i] = basis[have][i];
      d++;
    }
    have++;
  }
  return d;
}

static bool slopes(pl_rest_field* f, const double* q, const double* T, int d, double near,
                   bool of_velocity, double* out) {
  double h = of_velocity ? near : near * (1 + size(q, f->n)), a[2][MOST_COORDINATES];
  for (int j = 0; j < d; j++) {
    for (int side = 0; side < 2; side++) {
      double at[MOST_COORDINATES], v[MOST_COORDINATES];
      for (int i = 0; i < f->n; i++) {
        double shift = (side ? -h : h) * T[j * f->n + i];
        at[i] = q[i] + (of_velocity ? 0 : shift);
        v[i] = of_velocity ? shift : 0;
      }
      if (!of_velocity && !pl_rest_place(f, at, NULL)) return false;
      if (!accelerations(f, at, v, a[side])) return false;
    }
    for (int k = 0; k < d; k++) {
      out[k * d + j] = 0;
      for (int i = 0; i < f->n; i++)
        out[k * d + j] += T[k * f->n + i] * (a[0][i] - a[1][i]) / (2 * h);
    }
  }
  return true;
}

static int stability_near(pl_rest_field* f, const double* q, double near) {
  double T[2 * MOST_COORDINATES], K[4], C[4];
  int d = free_directions(f, q, 2, T);
  if (d < 1 || !slopes(f, q, T, d, near, false, K) || !slopes(f, q, T, d, near, true, C)) return 0;
  double tiny = 1e-6 * (size(K, d * d) + 1e-300);
  if (d == 1) return K[0] > tiny ? -1 : K[0] < -tiny && C[0] < 1e-6 * sqrt(-K[0]) ? 1 : 0;
  // without forces that hang on velocities: y'' = K y, stable where both eigenvalues are negative
  if (size(C, 4) > 1e-6 * sqrt(size(K, 4))) return 0;
  double trace = K[0] + K[3], det = K[0] * K[3] - K[1] * K[2], small = tiny * size(K, 4);
  if (det < -small) return -1;
  if (det > small) return trace < -tiny ? 1 : trace > tiny ? -1 : 0;
  return 0;
}

// A kink of a force beside the place (a spring of no length, a stop) is in the differences of one
// step and not of a smaller one.
int pl_rest_stability(pl_rest_field* f, const double* q) {
  int far = stability_near(f, q, 1e-4);
  return far != 0 && far == stability_near(f, q, 1e-5) ? far : 0;
}

// ------------------------------------------------------------------------------------- frequencies
// The smallest pivot of A (d x d, row after row) when the largest one is taken each time.
static double smallest_pivot(double complex* A, int d) {
  double smallest = (double)INFINITY;
  for (int k = 0; k < d; k++) {
    int row = k, column = k;
    for (int i = k; i < d; i++) {
      for (int j = k; j < d; j++) {
        if (cabs(A[i * d + j]) > cabs(A[row * d + column])) {
          row = i;
          column = j;
        }
      }
    }
    for (int j = 0; j < d; j++) {
      double complex x = A[k * d + j];
      A[k * d + j] = A[row * d + j];
      A[row * d + j] = x;
    }
    for (int i = 0; i < d; i++) {
      double complex x = A[i * d + k];
      A[i * d + k] = A[i * d + column];
      A[i * d + column] = x;
    }
    double pivot = cabs(A[k * d + k]);
    smallest = fmin(smallest, pivot);
    for (int i = k + 1; i < d && pivot > 0; i++) {
      double complex part = A[i * d + k] / A[k * d + k];
      for (int j = k; j < d; j++) A[i * d + j] -= part * A[k * d + j];
    }
  }
  return smallest;
}

// B = M A, all d x d.
static void times_mass(const double* M, const double* A, int d, double* B) {
  for (int i = 0; i < d; i++) {
    for (int j = 0; j < d; j++) {
      B[i * d + j] = 0;
      for (int k = 0; k < d; k++) B[i * d + j] += M[i * d + k] * A[k * d + j];
    }
  }
}

// The masses along the directions that are free.
static void mass_along(pl_rest_field* f, const double* q, const double* T, int d, double* M) {
  put(f, q, NULL);
  for (int a = 0; a < d; a++) {
    for (int b = 0; b < d; b++) {
      M[a * d + b] = 0;
      for (int i = 0; i < f->n; i++) {
        for (int j = 0; j < f->n; j++)
          M[a * d + b] += T[a * f->n + i] * T[b * f->n + j] * number(f, f->mass[i * f->n + j]);
      }
    }
  }
}

// How far s² M - s G - K is from singular at s² = -square, as a part of its entries, and of `most`.
static double off_with(const double* M, const double* G, const double* K, int d, double square,
                       double most) {
  double complex A[MOST_COORDINATES * MOST_COORDINATES], s = csqrt((double complex) - square);
  for (int k = 0; k < d * d; k++) {
    A[k] = -square * M[k] - s * G[k] - K[k];
    most = fmax(most, fmax(fabs(K[k]), fabs(square * M[k])));
  }
  return most > 0 ? smallest_pivot(A, d) / most : 0;
}

// Of damped motions the frequency without damping is told: the forces that hang on velocities and
// do no work are kept.
static double off_near(pl_rest_field* f, const double* q, double square, double near) {
  enum { ALL = MOST_COORDINATES * MOST_COORDINATES };
  double T[ALL], M[ALL], slope[ALL], K[ALL], C[ALL], G[ALL], far[ALL];
  int d = free_directions(f, q, MOST_COORDINATES, T);
  if (d < 1) return (double)NAN;
  mass_along(f, q, T, d, M);
  if (!slopes(f, q, T, d, near, false, slope)) return (double)NAN;
  times_mass(M, slope, d, K);
  if (!slopes(f, q, T, d, near, true, slope)) return (double)NAN;
  times_mass(M, slope, d, C);
  for (int i = 0; i < d; i++) {
    for (int j = 0; j < d; j++) G[i * d + j] = (C[i * d + j] - C[j * d + i]) / 2;
  }
  // where forces vanish with their slopes, what they are farther away
  double most = 0;
  if (slopes(f, q, T, d, 0.1, false, slope)) {
    times_mass(M, slope, d, far);
    most = size(far, d * d);
  }
  return off_with(M, G, K, d, square, most);
}

double pl_rest_frequency_off(pl_rest_field* f, const double* q, double square) {
  return fmin(off_near(f, q, square, 1e-4), off_near(f, q, square, 1e-5));
}
