// Dragging.  Sought is the position q with g(q) = 0 whose point p(q) is nearest to a place c,
// followed from the present one: the way from p to c is cut into pieces that are short beside the
// system, and on each
//
//   min |P dq - (c - p)|² + μ |W dq|²   with   G dq = 0,      P = dp/dq, G = dg/dq
//
// is solved and corrected onto g = 0 until it stays (Levenberg and Marquardt, [More1978]).  W
// weighs a coordinate by how far the masses move with it, so of all ways the one that moves the
// masses least is taken.  With the rows of G W⁻¹ made orthonormal (Gram and Schmidt, twice), the
// system that is left has as many rows as the point has components.
#include "api/drag.h"

#include <math.h>
#include <string.h>

typedef struct pl_row_of {
  pl_expr g, rate;       // g(q, t); its derivative by time, or the constraint on velocities itself
  pl_expr *by_q, *by_v;  // derivatives                                               (n)
  bool positions;        // it restricts positions
  int wall;              // 0: holds; +1: g >= 0 has to stay, -1: g <= 0
} pl_row_of;

struct pl_manifold {
  pl_arena* arena;
  pl_pool* pool;
  int n;
  pl_symbol *q, *v;  // (n)
  double* value;     // by symbol id
  double* weight;    // m by unit of the coordinate                               (n)
  PL_VEC(pl_row_of) rows;
  double size;                   // m: of the system
  double *basis, *lower, *left;  // orthonormal rows, their coefficients, what is left
  int* of_row;
  int rank;
  bool* closed;  // walls that were met on the way                           (rows)
};

struct pl_hold {
  pl_manifold* m;
  int n;  // components
  pl_expr at[3], rate[3];
  pl_expr* by_q[3];  // (n of the manifold)
};

static const double met =
    1e-7;  // of the terms: a constraint that is so near to zero holds at the start
static const double kept = 1e-13;        // of the terms: constraints after a correction
static const double least_step = 1e-11;  // of the system: a shorter step is the last
static const double dependent = 1e-9;    // of its row: what is left of a row that depends on others

// ---------------------------------------------------------------------------------------- rows
static double number(const pl_manifold* m, pl_expr e) { return pl_eval(m->pool, e, m->value); }

static double terms(const pl_manifold* m, pl_expr e) {
  double x = pl_eval_terms(m->pool, e, m->value);
  return isfinite(x) && x > 0 ? x : 1;
}

static void add_row(pl_manifold* m, pl_expr g, bool positions, int side) {
  pl_pool* p = m->pool;
  pl_row_of r = {.g = g, .rate = positions ? pl_dt(p, g) : g, .positions = positions};
  double x = number(m, g);
  bool holds = fabs(x) <= met * terms(m, g);
  if (isnan(x) || pl_is_poison(r.rate) || (side == 0 && positions && !holds)) return;
  if (side && !holds) r.wall = side;
  r.by_q = PL_ARRAY(m->arena, pl_expr, m->n);
  r.by_v = PL_ARRAY(m->arena, pl_expr, m->n);
  for (int i = 0; i < m->n; i++) {
    r.by_q[i] = pl_diff(p, g, m->q[i]);
    r.by_v[i] = pl_diff(p, r.rate, m->v[i]);
  }
  pl_push(m->arena, m->rows, r);
}

static void add_rows(pl_manifold* m, const pl_model* model) {
  for (int i = 0; i < model->constraints.n; i++) {
    const pl_constraint* c = &model->constraints.at[i];
    if (c->off || pl_is_poison(c->g)) continue;
    int side = c->relation == PL_GE ? 1 : c->relation == PL_LE ? -1 : 0;
    if (c->while_label && fabs(number(m, c->g)) > met * terms(m, c->g)) continue;
    add_row(m, c->g, !c->has_velocity, side);
  }
  for (int i = 0; i < model->choose.n_maps; i++) {
    pl_expr g = pl_sub(m->pool, model->choose.maps[i].old, model->choose.maps[i].map);
    add_row(m, g, true, 0);
  }
}

// ---------------------------------------------------------------------------------------- weights
static void weigh_point(pl_manifold* m, const pl_point* at) {
  for (int c = 0; c < at->n; c++) {
    double x = number(m, at->at[c]);
    if (isfinite(x)) m->size = fmax(m->size, fabs(x));
    for (int i = 0; i < m->n; i++) {
      double d = number(m, pl_diff(m->pool, at->at[c], m->q[i]));
      if (isfinite(d)) m->weight[i] += d * d;
    }
  }
}

// A coordinate counts by the way of the masses; turning bodies by their radius of gyration.
static void weigh(pl_manifold* m, const pl_model* model) {
  for (int k = 0; k < model->masses.n; k++) weigh_point(m, &model->masses.at[k].point);
  for (int k = 0; k < model->spatials.n; k++) weigh_point(m, &model->spatials.at[k].centre);
  for (int k = 0; k < model->bodies.n; k++) {
    const pl_body* b = &model->bodies.at[k];
    weigh_point(m, &b->centre);
    double gyration = number(m, pl_div(m->pool, b->inertia, b->mass));
    for (int i = 0; isfinite(gyration) && i < m->n; i++) {
      double d = number(m, pl_diff(m->pool, b->angle, m->q[i]));
      if (isfinite(d)) m->weight[i] += gyration * d * d;
    }
  }
  double most = 0;
  for (int i = 0; i < m->n; i++) most = fmax(most, m->weight[i]);
  // what moves no mass is free to follow
  for (int i = 0; i < m->n; i++)
    m->weight[i] = sqrt(fmax(m->weight[i], 1e-4 * (most > 0 ? most : 1)));
  if (!(m->size > 0)) m->size = 1;
}

pl_manifold* pl_manifold_make(pl_arena* a, pl_model* model, double* value) {
  int n = model->coords.n;
  if (n == 0 || n > PL_MOST_DRAGGED || model->constraints.n > PL_MOST_DRAGGED) return NULL;
  pl_manifold* m = PL_NEW(a, pl_manifold);
  *m = (pl_manifold){.arena = a, .pool = model->pool, .n = n, .value = value};
  m->q = PL_ARRAY(a, pl_symbol, n);
  m->v = PL_ARRAY(a, pl_symbol, n);
  m->weight = PL_ARRAY(a, double, n);
  for (int i = 0; i < n; i++) {
    m->q[i] = model->coords.at[i].symbol;
    m->v[i] = pl_symbol_dot(m->pool, m->q[i]);
  }
  add_rows(m, model);
  weigh(m, model);
  int rows = m->rows.n + 1;
  m->basis = PL_ARRAY(a, double, rows* n);
  m->lower = PL_ARRAY(a, double, rows* rows);
  m->left = PL_ARRAY(a, double, rows);
  m->of_row = PL_ARRAY(a, int, rows);
  m->closed = PL_ARRAY(a, bool, rows);
  return m;
}

pl_symbol pl_manifold_coordinate(const pl_manifold* m, int i) { return m->q[i]; }
pl_symbol pl_manifold_velocity(const pl_manifold* m, int i) { return m->v[i]; }

// ------------------------------------------------------------------------------- tangent space
static double dot(const double* a, const double* b, int n) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

static bool counts(const pl_manifold* m, int k, bool velocities, const bool* closed) {
  const pl_row_of* r = &m->rows.at[k];
  if (!velocities && !r->positions) return false;
  return r->wall == 0 || (closed && closed[k]);
}

// Orthonormal rows of G W⁻¹ at the present numbers; what depends on those before is left out.
static void open_tangent(pl_manifold* m, bool velocities, const bool* closed) {
  int n = m->n;
  m->rank = 0;
  for (int k = 0; k < m->rows.n; k++) {
    if (!counts(m, k, velocities, closed)) continue;
    const pl_row_of* r = &m->rows.at[k];
    double *e = m->basis + m->rank * n, *l = m->lower + m->rank * (m->rows.n + 1);
    for (int i = 0; i < n; i++)
      e[i] = number(m, velocities ? r->by_v[i] : r->by_q[i]) / m->weight[i];
    double whole = sqrt(dot(e, e, n));
    memset(l, 0, (size_t)(m->rank + 1) * sizeof *l);
    for (int pass = 0; pass < 2; pass++) {
      for (int j = 0; j < m->rank; j++) {
        double part = dot(e, m->basis + j * n, n);
        l[j] += part;
        for (int i = 0; i < n; i++) e[i] -= part * m->basis[j * n + i];
      }
    }
    double rest = sqrt(dot(e, e, n));
    if (!(rest > dependent * whole)) continue;
    l[m->rank] = rest;
    for (int i = 0; i < n; i++) e[i] /= rest;
    m->of_row[m->rank++] = k;
  }
}

// The part of a weighted direction along which no constraint changes.
static void into_tangent(const pl_manifold* m, double* x) {
  for (int pass = 0; pass < 2; pass++) {
    for (int j = 0; j < m->rank; j++) {
      double part = dot(x, m->basis + j * m->n, m->n);
      for (int i = 0; i < m->n; i++) x[i] -= part * m->basis[j * m->n + i];
    }
  }
}

// The shortest weighted step that takes the residuals `left` of the rows away.
static void correction(const pl_manifold* m, double* x) {
  double z[PL_MOST_DRAGGED + 1];
  memset(x, 0, (size_t)m->n * sizeof *x);
  for (int j = 0; j < m->rank; j++) {
    const double* l = m->lower + j * (m->rows.n + 1);
    z[j] = (-m->left[j] - dot(l, z, j)) / l[j];
    for (int i = 0; i < m->n; i++) x[i] += z[j] * m->basis[j * m->n + i];
  }
}

static void step(pl_manifold* m, const pl_symbol* s, const double* x, double factor) {
  for (int i = 0; i < m->n; i++) m->value[s[i].id] += factor * x[i] / m->weight[i];
}

// Onto g = 0; false: it does not come there.
static bool correct(pl_manifold* m, const bool* closed) {
  enum { MOST = 30 };
  double x[PL_MOST_DRAGGED];
  for (int k = 0; k < MOST; k++) {
    double worst = 0;
    open_tangent(m, false, closed);
    for (int j = 0; j < m->rank; j++) {
      pl_expr g = m->rows.at[m->of_row[j]].g;
      m->left[j] = number(m, g);
      worst = fmax(worst, fabs(m->left[j]) / terms(m, g));
    }
    if (isnan(worst)) return false;
    correction(m, x);
    step(m, m->q, x, 1);
    if (worst <= kept) return true;
    if (sqrt(dot(x, x, m->n)) > 10 * m->size) return false;
  }
  return false;
}

// Velocities move by the least that the constraints ask for; they are linear in them.
static void correct_velocities(pl_manifold* m, const bool* closed) {
  double x[PL_MOST_DRAGGED];
  for (int k = 0; k < 2; k++) {
    open_tangent(m, true, closed);
    for (int j = 0; j < m->rank; j++) m->left[j] = number(m, m->rows.at[m->of_row[j]].rate);
    correction(m, x);
    step(m, m->v, x, 1);
  }
}

// ---------------------------------------------------------------------------------------- a point
pl_hold* pl_hold_make(pl_arena* a, pl_manifold* m, const pl_point* point) {
  pl_hold* h = PL_NEW(a, pl_hold);
  *h = (pl_hold){.m = m, .n = point->n};
  for (int c = 0; c < h->n; c++) {
    h->at[c] = point->at[c];
    h->rate[c] = pl_dt(m->pool, point->at[c]);
    h->by_q[c] = PL_ARRAY(a, pl_expr, m->n);
    for (int i = 0; i < m->n; i++) h->by_q[c][i] = pl_diff(m->pool, point->at[c], m->q[i]);
  }
  return h;
}

void pl_hold_place(const pl_hold* h, double* place) {
  for (int c = 0; c < h->n; c++) place[c] = number(h->m, h->at[c]);
}

// Rows of P W⁻¹ within the tangent space.
static void open_hold(const pl_hold* h, double* B) {
  const pl_manifold* m = h->m;
  for (int c = 0; c < h->n; c++) {
    double* b = B + c * m->n;
    for (int i = 0; i < m->n; i++) b[i] = number(m, h->by_q[c][i]) / m->weight[i];
    into_tangent(m, b);
  }
}

// (B Bᵀ + μ) y = r for at most three rows, by Gauss with pivots.
static void small_solve(const double* B, int rows, int n, double mu, const double* r, double* y) {
  double A[3][4];
  for (int i = 0; i < rows; i++) {
    for (int j = 0; j < rows; j++) A[i][j] = dot(B + i * n, B + j * n, n) + (i == j ? mu : 0);
    A[i][rows] = r[i];
  }
  for (int k = 0; k < rows; k++) {
    int pivot = k;
    for (int i = k + 1; i < rows; i++) {
      if (fabs(A[i][k]) > fabs(A[pivot][k])) pivot = i;
    }
    for (int j = 0; j <= rows; j++) {
      double swap = A[k][j];
      A[k][j] = A[pivot][j];
      A[pivot][j] = swap;
    }
    for (int i = k + 1; i < rows; i++) {
      double f = A[i][k] / A[k][k];
      for (int j = k; j <= rows; j++) A[i][j] -= f * A[k][j];
    }
  }
  for (int k = rows - 1; k >= 0; k--) {
    y[k] = A[k][rows];
    for (int j = k + 1; j < rows; j++) y[k] -= A[k][j] * y[j];
    y[k] /= A[k][k];
  }
}

// The weighted direction x = Bᵀ (B Bᵀ + μ)⁻¹ r.
static void direction(const double* B, int rows, int n, double mu, const double* r, double* x) {
  double y[3] = {0};
  small_solve(B, rows, n, mu, r, y);
  for (int i = 0; i < n; i++) {
    x[i] = 0;
    for (int c = 0; c < rows; c++) x[i] += B[c * n + i] * y[c];
  }
}

static double trace_of(const double* B, int rows, int n) { return dot(B, B, rows * n); }

bool pl_hold_can_move(pl_hold* h) {
  double B[3 * PL_MOST_DRAGGED];
  open_tangent(h->m, false, NULL);
  open_hold(h, B);
  return trace_of(B, h->n, h->m->n) > 1e-16;
}

static double distance(const pl_hold* h, const double* place, double* r) {
  double sum = 0;
  for (int c = 0; c < h->n; c++) {
    r[c] = place[c] - number(h->m, h->at[c]);
    sum += r[c] * r[c];
  }
  return sqrt(sum);
}

static void keep_q(const pl_manifold* m, double* q) {
  for (int i = 0; i < m->n; i++) q[i] = m->value[m->q[i].id];
}

static void restore_q(pl_manifold* m, const double* q) {
  for (int i = 0; i < m->n; i++) m->value[m->q[i].id] = q[i];
}

// Walls that were run through are closed; true when one was.
static bool close_walls(const pl_manifold* m, bool* closed) {
  bool any = false;
  for (int k = 0; k < m->rows.n; k++) {
    const pl_row_of* r = &m->rows.at[k];
    if (r->wall == 0 || closed[k] || r->wall * number(m, r->g) >= -kept * terms(m, r->g)) continue;
    closed[k] = any = true;
  }
  return any;
}

// One step of the search; false: it got no nearer.
static bool approach(pl_hold* h, const double* place, double* mu, bool* closed) {
  pl_manifold* m = h->m;
  double B[3 * PL_MOST_DRAGGED], x[PL_MOST_DRAGGED], q[PL_MOST_DRAGGED], r[3], then[3];
  open_tangent(m, false, closed);
  open_hold(h, B);
  double before = distance(h, place, r), scale = trace_of(B, h->n, m->n);
  if (!(before > 1e-14 * m->size) || !(scale > 0)) return false;
  keep_q(m, q);
  for (; *mu < 1e6; *mu *= 8) {
    direction(B, h->n, m->n, *mu * scale, r, x);
    step(m, m->q, x, 1);
    bool fine = correct(m, closed);
    if (fine && close_walls(m, closed)) {
      // back, and along the wall
      restore_q(m, q);
      return true;
    }
    if (fine && distance(h, place, then) < before) {
      *mu = fmax(*mu / 8, 1e-14);
      return sqrt(dot(x, x, m->n)) > least_step * m->size;
    }
    restore_q(m, q);
  }
  return false;
}

bool pl_hold_move(pl_hold* h, const double* place) {
  enum { SHORTEST = 1, MOST_PIECES = 400, MOST_STEPS = 40 };
  pl_manifold* m = h->m;
  double from[3], part[3], r[3], start[PL_MOST_DRAGGED];
  bool* closed = m->closed;
  memset(closed, 0, (size_t)m->rows.n * sizeof *closed);
  pl_hold_place(h, from);
  keep_q(m, start);
  double way = distance(h, place, r);
  int pieces = (int)fmin(MOST_PIECES, SHORTEST + ceil(way / (0.05 * m->size)));
  for (int k = 1; k <= pieces; k++) {
    double mu = 1e-8;
    for (int c = 0; c < h->n; c++) part[c] = from[c] + (place[c] - from[c]) * k / pieces;
    int most = k == pieces ? 3 * MOST_STEPS : MOST_STEPS;
    for (int i = 0; i < most && approach(h, part, &mu, closed); i++) continue;
  }
  if (!correct(m, closed)) {
    restore_q(m, start);
    return false;
  }
  correct_velocities(m, closed);
  return true;
}

void pl_hold_throw(pl_hold* h, const double* velocity) {
  pl_manifold* m = h->m;
  double B[3 * PL_MOST_DRAGGED], x[PL_MOST_DRAGGED], r[3];
  correct_velocities(m, NULL);
  open_hold(h, B);  // in the tangent space of the velocities
  for (int c = 0; c < h->n; c++) r[c] = velocity[c] - number(m, h->rate[c]);
  direction(B, h->n, m->n, 1e-14 * trace_of(B, h->n, m->n), r, x);
  step(m, m->v, x, 1);
  correct_velocities(m, NULL);
}
