// momenta: conserved total momenta and angular momenta. A motion of the whole system, every mass
// shifted along an axis or turned
// about one, displaces the coordinates by η_i. If neither the Lagrange function nor a constraint
// changes, and no force without
// potential works along it,
//   sum η_i dL/dq_i + η_i' dL/dv_i = 0,   sum η_i dg/dq_i = 0,   sum η_i Q_i = 0,
// then  I = sum η_i dL/dv_i  is conserved (Noether), whatever the multipliers are.
// [Arnold1989, sec. 20]
// See theory (6.3).
#include "mechanics/mechanics.h"

typedef struct pl_symmetry {
  pl_expr* eta;       // (n_q)
  pl_expr* residual;  // of L, of Q, of each constraint: all vanish       (2 + n_g)
} pl_symmetry;

// ----------------------------------------------------------------------------------- displacements
// Coordinate i is displaced by e wherever it is component j of a mass; false when two masses
// disagree.
static bool displace(pl_analysis* d, pl_symmetry* s, pl_expr coordinate, pl_expr e) {
  if (pl_kind_of(d->pool, coordinate) != PL_SYMBOL) return true;
  int i = pl_variable_index(d, pl_symbol_of(d->pool, coordinate));
  if (i < 0) return true;
  if (pl_is_poison(s->eta[i])) s->eta[i] = e;
  return pl_alg_is_zero(d->tower, pl_sub(d->pool, s->eta[i], e)) == PL_YES;
}

// A turn about an axis displaces the axes of a body in space: its quaternion by n q/2, its vectors
// by n x e, and Euler angles so
// that their rates give the angular velocity n.
static void turn_of_axes(pl_analysis* d, const pl_spatial* b, int about, pl_expr* e) {
  pl_pool* p = d->pool;
  pl_expr zero = pl_int(p, 0), n[3] = {zero, zero, zero};
  int first = (about + 1) % 3, second = (about + 2) % 3;
  n[about] = pl_int(p, 1);
  if (b->form == PL_AXES_QUATERNION) {
    const pl_expr *q = b->axes, half = pl_ratio(p, 1, 2);
    e[0] = pl_neg(p, pl_mul(p, half, q[1 + about]));
    e[1 + about] = pl_mul(p, half, q[0]);
    e[1 + first] = pl_neg(p, pl_mul(p, half, q[1 + second]));
    e[1 + second] = pl_mul(p, half, q[1 + first]);
  } else if (b->form == PL_AXES_VECTORS) {
    for (int k = 0; k < 3; k++) {
      e[3 * k + about] = zero;
      e[3 * k + first] = pl_neg(p, b->axes[3 * k + second]);
      e[3 * k + second] = b->axes[3 * k + first];
    }
  } else {
    pl_expr c = pl_call(p, PL_COS, b->axes[0]), z = pl_call(p, PL_SIN, b->axes[0]);
    pl_expr across = pl_sub(p, pl_mul(p, z, n[0]), pl_mul(p, c, n[1]));
    e[1] = pl_add(p, pl_mul(p, c, n[0]), pl_mul(p, z, n[1]));
    e[2] = pl_div(p, across, pl_call(p, PL_SIN, b->axes[1]));
    e[0] = pl_sub(p, n[2], pl_mul(p, pl_call(p, PL_COS, b->axes[1]), e[2]));
  }
}

static bool turn_bodies(pl_analysis* d, pl_symmetry* s, int about) {
  for (int k = 0; k < d->model->spatials.n; k++) {
    const pl_spatial* b = &d->model->spatials.at[k];
    int n = b->form == PL_AXES_QUATERNION ? 4 : b->form == PL_AXES_VECTORS ? 9 : 3;
    pl_expr e[9];
    turn_of_axes(d, b, about, e);
    for (int j = 0; j < n; j++) {
      bool symbol = pl_kind_of(d->pool, b->axes[j]) == PL_SYMBOL
                    && pl_variable_index(d, pl_symbol_of(d->pool, b->axes[j])) >= 0;
      if (symbol ? !displace(d, s, b->axes[j], e[j]) : pl_alg_is_zero(d->tower, e[j]) != PL_YES)
        return false;
    }
  }
  return true;
}

// axis < 0: a turn about axis -1 - axis, (first, second) -> (-second, first).  Bodies turn along.
static bool displacement(pl_analysis* d, pl_symmetry* s, int axis) {
  int first = axis < 0 ? (-axis) % 3 : axis, second = (first + 1) % 3;
  bool turn = axis < 0;
  s->eta = PL_ARRAY(d->arena, pl_expr, d->q.n + 1);
  for (int i = 0; i < d->q.n; i++) s->eta[i] = pl_poison();
  for (int k = 0; k < d->particle.n; k++) {
    const pl_particle* m = &d->particle.at[k];
    for (int c = 0; c < m->n; c++) {
      pl_expr e = pl_int(d->pool, !turn && c == first);
      if (turn && c == first && second < m->n) e = pl_neg(d->pool, m->at[second]);
      if (turn && c == second && first < m->n) e = m->at[first];
      if (!displace(d, s, m->at[c], e)) return false;
    }
    if (!pl_is_poison(m->angle) && !displace(d, s, m->angle, pl_int(d->pool, turn))) return false;
  }
  if (turn && !turn_bodies(d, s, -1 - axis)) return false;
  for (int i = 0; i < d->q.n; i++) {
    if (pl_is_poison(s->eta[i])) s->eta[i] = pl_int(d->pool, 0);
  }
  return true;
}

static void find_residuals(pl_analysis* d, pl_symmetry* s) {
  pl_pool* p = d->pool;
  s->residual = PL_ARRAY(d->arena, pl_expr, 2 + d->g.n);
  for (int k = 0; k < 2 + d->g.n; k++) s->residual[k] = pl_int(p, 0);
  for (int i = 0; i < d->q.n; i++) {
    if (pl_is_zero_node(p, s->eta[i])) continue;
    pl_expr change = pl_mul(p, s->eta[i], pl_diff(p, d->L, d->q.at[i].q));
    change = pl_add(p, change, pl_mul(p, pl_dt(p, s->eta[i]), pl_diff(p, d->L, d->q.at[i].v)));
    s->residual[0] = pl_add(p, s->residual[0], change);
    s->residual[1] = pl_add(p, s->residual[1], pl_mul(p, s->eta[i], d->force[i]));
    for (int k = 0; k < d->g.n; k++)
      s->residual[2 + k] = pl_add(p, s->residual[2 + k],
                                  pl_mul(p, s->eta[i], d->g.at[k].gradient[i]));
  }
  for (int k = 0; k < 2 + d->g.n; k++) s->residual[k] = pl_alg_normal(d->tower, s->residual[k]);
}

// e with small numbers for the coordinates and velocities, the same ones for each e.
static pl_expr at_point(pl_analysis* d, pl_expr e, int point) {
  pl_random r = {(uint64_t)point + 1};
  for (int i = 0; i < d->q.n; i++) {
    long of_q = 1 + (long)(pl_random_bits(&r) % 17), of_v = 1 + (long)(pl_random_bits(&r) % 17);
    e = pl_subst1(d->pool, e, d->q.at[i].q, pl_ratio(d->pool, of_q, 7));
    e = pl_subst1(d->pool, e, d->q.at[i].v, pl_ratio(d->pool, of_v, 5));
  }
  return e;
}

// A constraint may turn into others (x = h e_x into y = h e_y): its change is then a sum of
// constraints with constant
// coefficients, which follow from as many points as there are constraints, and is zero where these
// hold.
static bool follows(pl_analysis* d, pl_expr change) {
  enum { most = 10 };
  pl_pool* p = d->pool;
  int n = d->g.n;
  if (n == 0 || n > most) return false;
  pl_expr A[most * most] = {0}, b[most] = {0}, c[most];
  for (int i = 0; i < n; i++) {
    for (int k = 0; k < n; k++)
      A[i * n + k] = pl_alg_normal(d->tower, at_point(d, d->g.at[k].g, i));
    b[i] = pl_alg_normal(d->tower, at_point(d, change, i));
  }
  if (pl_alg_solve(d->tower, n, A, b, c, 400) != PL_YES) return false;
  for (int k = 0; k < n; k++) {
    if (pl_has_coordinates(d, c[k]) || pl_has_symbol(p, c[k], pl_time(p))) return false;
    change = pl_sub(p, change, pl_mul(p, c[k], d->g.at[k].g));
  }
  return pl_alg_is_zero(d->tower, change) == PL_YES;
}

static bool vanishes(pl_analysis* d, const pl_symmetry* s) {
  for (int k = 0; k < 2 + d->g.n; k++) {
    pl_expr r = s->residual[k];
    if (pl_is_poison(r)) return false;
    if (pl_alg_is_zero(d->tower, r) != PL_YES && (k < 2 || !follows(d, r))) return false;
  }
  return true;
}

enum { most_rows = 16 };

// A turn about another point: shifts are added until nothing changes. turn + a shift1 + b shift2
// with constant a, b, which follow
// from the residuals at two points; whether they do it everywhere is proven afterwards.
static bool move_centre(pl_analysis* d, pl_symmetry* turn, const pl_symmetry* shift1,
                        const pl_symmetry* shift2, pl_expr* a, pl_expr* b) {
  pl_expr left[2][most_rows], right[most_rows];
  int n = 0;
  for (int k = 0; k < 2 + d->g.n; k++) {
    for (int point = 0; point < 2 && n < most_rows; point++) {
      left[0][n] = pl_alg_normal(d->tower, at_point(d, shift1->residual[k], point));
      left[1][n] = pl_alg_normal(d->tower, at_point(d, shift2->residual[k], point));
      right[n] = pl_alg_normal(d->tower, pl_neg(d->pool, at_point(d, turn->residual[k], point)));
      n += !pl_is_zero_node(d->pool, left[0][n]) || !pl_is_zero_node(d->pool, left[1][n]);
    }
  }
  bool one = vanishes(d, shift1) || vanishes(d, shift2);
  // with one shift a symmetry itself, only the other one is looked for
  int free = vanishes(d, shift1) ? 1 : 0;
  pl_expr x[2] = {pl_int(d->pool, 0), pl_int(d->pool, 0)};
  bool solved = one && n > 0
                && pl_alg_solve(d->tower, 1, &left[free][0], &right[0], &x[free], 200) == PL_YES;
  for (int r = 0; r < n && !one && !solved; r++) {
    for (int s = r + 1; s < n && !solved; s++) {
      pl_expr A[4] = {left[0][r], left[1][r], left[0][s], left[1][s]}, y[2] = {right[r], right[s]};
      solved = pl_alg_solve(d->tower, 2, A, y, x, 200) == PL_YES;
    }
  }
  if (!solved || pl_has_coordinates(d, x[0]) || pl_has_coordinates(d, x[1])) return false;
  if (pl_has_symbol(d->pool, x[0], pl_time(d->pool))
      || pl_has_symbol(d->pool, x[1], pl_time(d->pool)))
    return false;
  *a = x[0];
  *b = x[1];
  for (int i = 0; i < d->q.n; i++) {
    pl_expr more = pl_add(d->pool, pl_mul(d->pool, *a, shift1->eta[i]),
                          pl_mul(d->pool, *b, shift2->eta[i]));
    turn->eta[i] = pl_add(d->pool, turn->eta[i], more);
  }
  find_residuals(d, turn);
  return vanishes(d, turn);
}

// ------------------------------------------------------------------------------- what is conserved
static pl_expr integral(pl_analysis* d, const pl_symmetry* s) {
  pl_expr sum = pl_int(d->pool, 0);
  for (int i = 0; i < d->q.n; i++) {
    pl_expr p = pl_diff(d->pool, d->L, d->q.at[i].v);
    sum = pl_add(d->pool, sum, pl_mul(d->pool, s->eta[i], p));
  }
  return pl_alg_normal(d->tower, pl_on_maps(d, sum));
}

// dI/dt = sum of λ times the changes of the constraints, which vanish where these hold.
static pl_expr rate_of(pl_analysis* d, const pl_symmetry* s) {
  pl_expr rate = pl_int(d->pool, 0);
  for (int k = 0; k < d->g.n; k++) {
    rate = pl_add(d->pool, rate,
                  pl_mul(d->pool, pl_sym(d->pool, d->g.at[k].lambda), s->residual[2 + k]));
  }
  return rate;
}

static pl_momentum momentum_of(pl_analysis* d, const pl_symmetry* s, int axis, bool turn) {
  pl_expr zero = pl_int(d->pool, 0);
  return (pl_momentum){.axis = axis,
                       .turn = turn,
                       .centre = {zero, zero},
                       .value = integral(d, s),
                       .rate = rate_of(d, s)};
}

int pl_find_momenta(pl_analysis* d, pl_momentum* out) {
  pl_symmetry shift[3];
  bool shifted[3] = {0};
  int n = d->model->n_axes, found = 0;
  if (pl_loaded_by_name(d) >= 0 || d->particle.n == 0) return 0;
  for (int c = 0; c < n; c++) {
    shifted[c] = displacement(d, &shift[c], c);
    if (!shifted[c]) continue;
    find_residuals(d, &shift[c]);
    if (vanishes(d, &shift[c])) out[found++] = momentum_of(d, &shift[c], c, false);
  }
  for (int about = n == 2 ? 2 : 0; about < 3 && n > 1; about++) {
    int first = (about + 1) % 3, second = (about + 2) % 3;
    pl_expr a = pl_int(d->pool, 0), b = a;
    pl_symmetry turn;
    if (!displacement(d, &turn, -1 - about)) continue;
    find_residuals(d, &turn);
    bool done = vanishes(d, &turn);
    if (!done && shifted[first] && shifted[second])
      done = move_centre(d, &turn, &shift[first], &shift[second], &a, &b);
    if (!done) continue;
    // (x, y) -> (-(y - y0), x - x0): the shift along the first axis is y0, along the second -x0
    out[found] = momentum_of(d, &turn, about, true);
    out[found].centre[0] = pl_neg(d->pool, b);
    out[found++].centre[1] = a;
  }
  return found;
}
