// linear_motion: the motion of several generalized coordinates whose equations are linear with
// constant coefficients,
//   M q'' + C q' + K q = c(t),
// or whose solved accelerations are, where the coordinates are not reduced or constraints hold
// between velocities, by the Laplace transform: (s² M + s C + K) Q(s) = C(s) + M (s q0 + v0) + C
// q0. Each Q_i(s) is a fraction, and laplace.c brings it back.
// See theory (7.3).
#include "mechanics/mechanics.h"

enum { max_size = 5 };

static pl_symbol transform_variable(pl_analysis* d) {
  pl_symbol_info info = {
      .name = "s", .ascii = "laplace_s", .role = PL_R_LOCAL, .class = PL_C_OTHER};
  return pl_symbol_make(d->pool, &info);
}

static bool constant(pl_analysis* d, pl_expr e) {
  return !pl_is_poison(e) && !pl_has_coordinates(d, e)
         && !pl_has_symbol(d->pool, e, pl_time(d->pool));
}

// Equations that vanish, one for each of some coordinates.
typedef struct pl_linear_system {
  int n, coordinate[max_size];
  pl_expr equation[max_size];
} pl_linear_system;

// The transformed system A Q = b; false when an equation is not linear with constant coefficients.
static bool transform_system(pl_analysis* d, const pl_linear_system* sys, pl_symbol variable,
                             pl_expr* A, pl_expr* b) {
  pl_pool* p = d->pool;
  int n = sys->n;
  pl_expr s = pl_sym(p, variable);
  pl_replace rest[3 * max_size];
  for (int j = 0; j < n; j++) {
    const pl_variable* c = &d->q.at[sys->coordinate[j]];
    rest[3 * j] = (pl_replace){c->q, pl_int(p, 0)};
    rest[3 * j + 1] = (pl_replace){c->v, pl_int(p, 0)};
    rest[3 * j + 2] = (pl_replace){c->a, pl_int(p, 0)};
  }
  for (int i = 0; i < n; i++) {
    pl_expr f = pl_on_special(d, sys->equation[i]);
    pl_expr c = pl_neg(p, pl_subst(p, f, rest, 3 * n));
    if (pl_has_coordinates(d, c)) return false;
    pl_expr left = pl_add(p, f, c);  // without its linear terms
    b[i] = pl_laplace(d, c, variable);
    if (pl_is_poison(b[i])) return false;
    for (int j = 0; j < n; j++) {
      const pl_variable* q = &d->q.at[sys->coordinate[j]];
      pl_expr M = pl_alg_normal(d->tower, pl_diff(p, f, q->a)),
              C = pl_alg_normal(d->tower, pl_diff(p, f, q->v));
      pl_expr K = pl_alg_normal(d->tower, pl_diff(p, f, q->q));
      if (!constant(d, M) || !constant(d, C) || !constant(d, K)) return false;
      left = pl_sub(p, left, pl_mul(p, M, pl_sym(p, q->a)));
      left = pl_sub(p, left, pl_mul(p, C, pl_sym(p, q->v)));
      left = pl_sub(p, left, pl_mul(p, K, pl_sym(p, q->q)));
      pl_expr q0 = pl_sym(p, pl_symbol_start(p, q->q)), v0 = pl_sym(p, pl_symbol_start(p, q->v));
      A[i * n + j] = pl_add_n(p, (pl_expr[]){pl_mul(p, M, pl_square(p, s)), pl_mul(p, C, s), K}, 3);
      pl_expr kick = pl_mul(p, M, pl_add(p, pl_mul(p, s, q0), v0));
      b[i] = pl_add_n(p, (pl_expr[]){b[i], kick, pl_mul(p, C, q0)}, 3);
    }
    // the slope of |x|/x is zero, and yet it is not constant
    if (pl_alg_is_zero(d->tower, left) != PL_YES) return false;
  }
  return true;
}

static bool has_place(const pl_linear_system* sys, int i) {
  for (int k = 0; k < sys->n; k++) {
    if (sys->coordinate[k] == i) return true;
  }
  return false;
}

// The equations of the second kind; false when they are not those of coordinate i.
static bool of_second_kind(pl_analysis* d, int i, pl_linear_system* out) {
  *out = (pl_linear_system){.n = d->gen.n};
  if (!d->reduced || d->gen.n > max_size || pl_nonholonomic(d)) return false;
  for (int k = 0; k < d->gen.n; k++) {
    out->coordinate[k] = d->gen.at[k];
    out->equation[k] = pl_second_kind(d, d->gen.at[k]);
  }
  return has_place(out, i);
}

// The accelerations of i and of all coordinates that these hang on, constraints between velocities
// taken in: a ball that rolls on a
// turntable has x'' = -2/7 Ω y', y'' = 2/7 Ω x'.
static bool of_accelerations(pl_analysis* d, int i, pl_linear_system* out) {
  *out = (pl_linear_system){.n = 1, .coordinate = {i}};
  for (int k = 0; k < out->n; k++) {
    pl_expr a = d->solved ? d->acceleration[out->coordinate[k]] : pl_poison();
    if (pl_is_poison(a)) return false;
    out->equation[k] = pl_sub(d->pool, pl_sym(d->pool, d->q.at[out->coordinate[k]].a), a);
    for (int j = 0; j < d->q.n; j++) {
      bool hangs = pl_has_symbol(d->pool, a, d->q.at[j].q)
                   || pl_has_symbol(d->pool, a, d->q.at[j].v);
      if (!hangs || has_place(out, j)) continue;
      if (out->n == max_size) return false;
      out->coordinate[out->n++] = j;
    }
  }
  return true;
}

// Coordinates of closed loops are no linear functions.
pl_expr pl_linear_motion(pl_analysis* d, int i, pl_laplace_poles* poles, pl_expr* transform) {
  pl_linear_system sys;
  pl_expr A[max_size * max_size], b[max_size], Q[max_size];
  if (transform) *transform = pl_poison();
  if (d->loops.n > 0) return pl_poison();
  if (!of_second_kind(d, i, &sys) && !of_accelerations(d, i, &sys)) return pl_poison();
  pl_symbol s = transform_variable(d);
  if (!transform_system(d, &sys, s, A, b)) return pl_poison();
  if (pl_alg_solve(d->tower, sys.n, A, b, Q, 20000) != PL_YES) return pl_poison();
  int place = 0;
  while (sys.coordinate[place] != i) place++;
  if (transform) *transform = pl_alg_normal(d->tower, Q[place]);
  return pl_laplace_back(d, Q[place], s, poles);
}
