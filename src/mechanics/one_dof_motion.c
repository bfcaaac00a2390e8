// line: a motion reduced to one coordinate by every integral that is known. Of n generalized
// coordinates n - 1 are cyclic:
//   dL/dv_c = p_c (linear in the velocities) gives v_c in terms of q, v and the start;
//   E(q, v, v_c(q, v)) = E(start), quadratic in v without a linear term, gives v^2 as a
//   function of q. [Arnold1989, sec. 22]
// See theory (6.2), (6.4).
#include <math.h>

#include "mechanics/mechanics.h"

static bool is_cyclic(pl_analysis* d, int i) {
  return pl_alg_is_zero(d->tower, pl_diff(d->pool, d->Lg, d->q.at[i].q)) == PL_YES
         && !pl_pushed(d, i);
}

// All but one: the coordinate that is left is the one that occurs in the Lagrange function; of
// none, the first.
static bool choose_line(pl_analysis* d, pl_line* l) {
  l->i = -1;
  for (int k = 0; k < d->gen.n; k++) {
    if (is_cyclic(d, d->gen.at[k])) continue;
    if (l->i >= 0) return false;
    l->i = d->gen.at[k];
  }
  if (l->i < 0) l->i = d->gen.at[0];
  for (int k = 0; k < d->gen.n; k++) {
    if (d->gen.at[k] != l->i) l->cyclic[l->n++] = d->gen.at[k];
  }
  return true;
}

static int start_values(pl_analysis* d, const pl_motion* motion, pl_replace* out) {
  int n = 0;
  for (int k = 0; k < d->gen.n; k++) {
    const pl_variable* c = &d->q.at[d->gen.at[k]];
    pl_expr q0, v0;
    pl_motion_start(d, motion, c, &q0, &v0);
    out[n++] = (pl_replace){c->q, q0};
    out[n++] = (pl_replace){c->v, v0};
  }
  return n;
}

// v_c from the momenta.
static bool cyclic_velocities(pl_analysis* d, pl_line* l, const pl_replace* start, int n_start) {
  pl_expr A[pl_max_line * pl_max_line], b[pl_max_line], x[pl_max_line];
  pl_replace zero[pl_max_line];
  for (int a = 0; a < l->n; a++)
    zero[a] = (pl_replace){d->q.at[l->cyclic[a]].v, pl_int(d->pool, 0)};
  for (int a = 0; a < l->n; a++) {
    pl_expr p = pl_alg_normal(d->tower, pl_diff(d->pool, d->Lg, d->q.at[l->cyclic[a]].v));
    l->momentum[a] = p;
    l->momentum0[a] = pl_alg_normal(d->tower, pl_subst(d->pool, p, start, n_start));
    for (int c = 0; c < l->n; c++) {
      A[a * l->n + c] = pl_diff(d->pool, p, d->q.at[l->cyclic[c]].v);
      if (pl_has_symbol(d->pool, A[a * l->n + c], d->q.at[l->cyclic[c]].v)) return false;
    }
    b[a] = pl_sub(d->pool, l->momentum0[a], pl_subst(d->pool, p, zero, l->n));
  }
  if (l->n > 0 && pl_alg_solve(d->tower, l->n, A, b, x, 20000) != PL_YES) return false;
  for (int a = 0; a < l->n; a++) l->velocity[a] = (pl_replace){d->q.at[l->cyclic[a]].v, x[a]};
  return true;
}

static int sign_of_number(pl_analysis* d, pl_expr e) {
  double x = pl_number(d, e);
  return x > 0 ? 1 : x < 0 ? -1 : 0;
}

// The way the motion goes: its velocity, else its acceleration, else (rest in an equilibrium) the
// side on which `init` starts.
static int direction_of(pl_analysis* d, const pl_line* l, const pl_replace* start, int n_start) {
  int sign = sign_of_number(d, l->v0);
  if (sign == 0 && d->solved)
    sign = sign_of_number(d, pl_subst(d->pool, d->acceleration[l->i], start, n_start));
  if (sign == 0) {
    pl_motion init = {0};
    pl_expr q, v;
    pl_motion_start(d, &init, &d->q.at[l->i], &q, &v);
    sign = sign_of_number(d, pl_sub(d->pool, q, l->q0));
  }
  return sign < 0 ? -1 : 1;
}

bool pl_line_of(pl_analysis* d, const pl_motion* motion, pl_line* l) {
  *l = (pl_line){0};
  if (!d->reduced || d->gen.n == 0 || d->gen.n > pl_max_line || pl_nonholonomic(d)) return false;
  pl_expr E = pl_conserved_energy(d), c[3];
  if (pl_is_poison(E) || !choose_line(d, l)) return false;
  pl_replace start[2 * pl_max_line];
  int n = start_values(d, motion, start);
  pl_motion_start(d, motion, &d->q.at[l->i], &l->q0, &l->v0);
  if (!cyclic_velocities(d, l, start, n)) return false;
  pl_expr on = pl_subst(d->pool, E, l->velocity, l->n);
  if (pl_alg_coefficients(d->tower, on, d->q.at[l->i].v, c, 2) != 2
      || !pl_is_zero_node(d->pool, c[1]))
    return false;
  pl_expr left = pl_sub(d->pool, pl_subst(d->pool, E, start, n), c[0]);
  l->v2 = pl_alg_normal(d->tower, pl_div(d->pool, left, c[2]));
  l->direction = direction_of(d, l, start, n);
  return !pl_is_poison(l->v2);
}

// Even powers of the velocity become rational; an odd one is a root, with the sign of the motion.
pl_expr pl_along_line(pl_analysis* d, const pl_line* l, pl_expr e) {
  pl_symbol v = d->q.at[l->i].v;
  pl_expr c[9];
  e = pl_subst(d->pool, e, l->velocity, l->n);
  if (!pl_has_symbol(d->pool, e, v)) return pl_alg_normal(d->tower, e);
  pl_expr root = pl_mul(d->pool, pl_int(d->pool, l->direction), pl_sqrt(d->pool, l->v2));
  int n = pl_alg_coefficients(d->tower, e, v, c, 8);
  if (n < 0) return pl_alg_normal(d->tower, pl_subst1(d->pool, e, v, root));
  pl_expr sum = pl_int(d->pool, 0);
  for (int k = 0; k <= n; k++) {
    pl_expr power = pl_pow_int(d->pool, l->v2, k / 2);
    if (k % 2) power = pl_mul(d->pool, power, root);
    sum = pl_add(d->pool, sum, pl_mul(d->pool, c[k], power));
  }
  return pl_alg_normal(d->tower, sum);
}

// -------------------------------------------------------------------------------------------- drag
// Drag with the square of the velocity, while the motion goes one way: q'' = a(q) + b q'^2 with
// constant b is linear in u = q'^2,
//   du/dq = 2 a + 2 b u,   u = e^{2 b q} (u0 e^{-2 b q0} + ∫ 2 a e^{-2 b q} dq from q0).
static bool drag_line(pl_analysis* d, const pl_motion* motion, pl_line* l) {
  *l = (pl_line){.drag = true};
  if (!d->reduced || !d->solved || d->gen.n != 1 || d->loops.n > 0 || pl_nonholonomic(d))
    return false;
  pl_pool* p = d->pool;
  l->i = d->gen.at[0];
  const pl_variable* c = &d->q.at[l->i];
  pl_motion_start(d, motion, c, &l->q0, &l->v0);
  pl_replace start[2] = {{c->q, l->q0}, {c->v, l->v0}};
  l->direction = direction_of(d, l, start, 2);
  pl_expr v = pl_sym(p, c->v), along = pl_mul(p, pl_int(p, l->direction), v), part[3],
          q = pl_sym(p, c->q);
  pl_expr a = pl_subst_expr(p, pl_alg_normal(d->tower, d->acceleration[l->i]),
                            pl_call(p, PL_ABS, v), along);
  if (pl_has_symbol(p, a, pl_time(p)) || pl_alg_coefficients(d->tower, a, c->v, part, 2) != 2)
    return false;
  if (!pl_is_zero_node(p, part[1]) || pl_has_coordinates(d, part[2])) return false;
  pl_expr twice_b = pl_mul(p, pl_int(p, 2), part[2]),
          fade = pl_call(p, PL_EXP, pl_neg(p, pl_mul(p, twice_b, q)));
  pl_expr F = pl_alg_integral(
      d->tower, pl_alg_normal(d->tower, pl_mul_n(p, (pl_expr[]){pl_int(p, 2), part[0], fade}, 3)),
      c->q);
  if (pl_is_poison(F)) return false;
  pl_expr grown = pl_sub(p, F, pl_subst1(p, F, c->q, l->q0));
  pl_expr kept = pl_mul(p, pl_square(p, l->v0), pl_subst1(p, fade, c->q, l->q0));
  l->v2 = pl_alg_normal(d->tower, pl_div(p, pl_add(p, grown, kept), fade));
  return !pl_is_poison(l->v2);
}

bool pl_line_from(pl_analysis* d, const pl_motion* motion, pl_line* l) {
  return pl_line_of(d, motion, l) || drag_line(d, motion, l);
}

bool pl_line_has_way(pl_analysis* d, const pl_line* l, pl_expr e) {
  pl_symbol v = d->q.at[l->i].v;
  pl_expr on = pl_subst(d->pool, e, l->velocity, l->n),
          back = pl_subst1(d->pool, on, v, pl_neg(d->pool, pl_sym(d->pool, v)));
  return l->drag || pl_alg_equal(d->tower, on, back) != PL_YES;
}

// e on the motion; where a motion is meant, its velocities inserted.
pl_expr pl_value_on(pl_analysis* d, const pl_motion* motion, pl_expr e, pl_line* line,
                    bool* eliminated) {
  e = pl_alg_normal(d->tower, pl_on_motion(d, pl_with_results(d, e)));
  *eliminated = pl_has_role(d->pool, e, PL_R_VELOCITY) && pl_line_from(d, motion, line);
  return *eliminated ? pl_along_line(d, line, e) : e;
}
