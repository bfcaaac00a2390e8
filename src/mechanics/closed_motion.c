// closed_motion: coordinates as functions of time. x'' = A + B x + C x' with constant A, B, C: the
// general solution through x(0), x'(0) [Arnold1989, sec. 5]; else by the Laplace transform.
#include "mechanics/mechanics.h"

static bool is_parameter(pl_analysis* d, pl_expr e) {
  return !pl_has_coordinates(d, e) && !pl_has_symbol(d->pool, e, pl_time(d->pool));
}

bool pl_linear_equation_of(pl_analysis* d, int i, pl_linear_equation* out) {
  pl_expr a = pl_on_special(d, d->acceleration[i]), cx[2], cv[2];
  int nx = pl_alg_coefficients(d->tower, a, d->q.at[i].q, cx, 1);
  if (nx < 0) return false;
  out->B = nx == 1 ? cx[1] : pl_int(d->pool, 0);
  int nv = pl_alg_coefficients(d->tower, cx[0], d->q.at[i].v, cv, 1);
  if (nv < 0) return false;
  out->C = nv == 1 ? cv[1] : pl_int(d->pool, 0);
  out->A = cv[0];
  return is_parameter(d, out->A) && is_parameter(d, out->B) && is_parameter(d, out->C);
}

// The general solution keeps x(0) and x'(0) as names, whatever `init` says.
static pl_expr start_of(pl_analysis* d, pl_symbol s) {
  return pl_sym(d->pool, pl_symbol_start(d->pool, s));
}

static pl_expr uniform(pl_analysis* d, pl_expr A, pl_expr x0, pl_expr v0, pl_expr t) {
  pl_pool* p = d->pool;
  pl_expr fall = pl_mul_n(p, (pl_expr[]){pl_ratio(p, 1, 2), A, pl_square(p, t)}, 3);
  return pl_add_n(p, (pl_expr[]){x0, pl_mul(p, v0, t), fall}, 3);
}

static pl_expr in_parts(pl_analysis* d, pl_laplace_poles* parts, pl_expr steady, pl_expr rest) {
  if (parts) {
    parts->at[parts->n++].part = steady;
    parts->at[parts->n++].part = rest;
  }
  return pl_add(d->pool, steady, rest);
}

// x'' = A + C x':  x = x0 - c - A t/C + c e^{Ct} with c = (v0 + A/C)/C
static pl_expr with_friction(pl_analysis* d, const pl_linear_equation* l, pl_expr x0, pl_expr v0,
                             pl_expr t, pl_laplace_poles* parts) {
  pl_pool* p = d->pool;
  pl_expr terminal = pl_div(p, l->A, l->C), c = pl_div(p, pl_add(p, v0, terminal), l->C);
  pl_expr steady = pl_add_n(p, (pl_expr[]){x0, pl_neg(p, c), pl_neg(p, pl_mul(p, terminal, t))}, 3);
  return in_parts(d, parts, steady, pl_mul(p, c, pl_call(p, PL_EXP, pl_mul(p, l->C, t))));
}

// The discriminant is zero: critical damping, u = e^{Ct/2} (u0 + (v0 - C u0/2) t). Where only the
// given numbers make it zero, they are a
// special case, which is tried next.
static pl_expr critical(pl_analysis* d, pl_expr disc, pl_expr half, pl_expr rest, pl_expr x0,
                        pl_expr v0, pl_expr t, pl_laplace_poles* parts) {
  pl_pool* p = d->pool;
  if (pl_alg_is_zero(d->tower, disc) != PL_YES) {
    pl_find_special(d, disc);
    return pl_poison();
  }
  pl_expr u0 = pl_sub(p, x0, rest), slope = pl_sub(p, v0, pl_mul(p, half, u0));
  pl_expr swing = pl_mul(p, pl_call(p, PL_EXP, pl_mul(p, half, t)),
                         pl_add(p, u0, pl_mul(p, slope, t)));
  return in_parts(d, parts, rest, swing);
}

// x'' = A + B x + C x', B != 0, around the rest position -A/B; the sign of the discriminant
// decides.
static pl_expr oscillation(pl_analysis* d, const pl_linear_equation* l, pl_expr x0, pl_expr v0,
                           pl_expr t, pl_laplace_poles* parts) {
  pl_pool* p = d->pool;
  pl_expr rest = pl_alg_normal(d->tower, pl_neg(p, pl_div(p, l->A, l->B)));
  pl_expr half = pl_div(p, l->C, pl_int(p, 2));
  pl_expr disc = pl_alg_normal(d->tower, pl_add(p, l->B, pl_square(p, half)));
  int sign = -pl_sign_or_positive(d, pl_neg(p, disc));
  if (sign == 0) return critical(d, disc, half, rest, x0, v0, t, parts);
  pl_expr w = pl_alg_normal(d->tower, pl_sqrt(p, sign > 0 ? disc : pl_neg(p, disc)));
  pl_expr wt = pl_mul(p, w, t), u0 = pl_sub(p, x0, rest);
  pl_expr even = pl_call(p, sign > 0 ? PL_COSH : PL_COS, wt),
          odd = pl_call(p, sign > 0 ? PL_SINH : PL_SIN, wt);
  pl_expr slope = pl_div(p, pl_sub(p, v0, pl_mul(p, half, u0)), w);
  pl_expr swing = pl_add(p, pl_mul(p, u0, even), pl_mul(p, slope, odd));
  if (!pl_is_zero_node(p, half)) swing = pl_mul(p, pl_call(p, PL_EXP, pl_mul(p, half, t)), swing);
  return in_parts(d, parts, rest, swing);
}

// poles: the parts that it is made of, where there are several; or NULL.
static pl_expr general_motion(pl_analysis* d, int i, pl_laplace_poles* poles) {
  pl_linear_equation l;
  if (pl_is_poison(d->acceleration[i])) return pl_poison();
  if (!pl_linear_equation_of(d, i, &l)) return pl_linear_motion(d, i, poles, NULL);
  pl_expr x0 = start_of(d, d->q.at[i].q), v0 = start_of(d, d->q.at[i].v),
          t = pl_sym(d->pool, pl_time(d->pool));
  if (!pl_is_zero_node(d->pool, l.B)) return oscillation(d, &l, x0, v0, t, poles);
  if (!pl_is_zero_node(d->pool, l.C)) return with_friction(d, &l, x0, v0, t, poles);
  return uniform(d, l.A, x0, v0, t);
}

// Where the given numbers make the general solution divide by zero, that of the special case.
pl_expr pl_closed_motion(pl_analysis* d, int i, pl_laplace_poles* poles) {
  for (;;) {
    int before = d->special.n;
    if (poles) poles->n = 0;
    pl_expr x = general_motion(d, i, poles), base;
    bool pole = pl_pole_at_numbers(d, x, &base);
    if (pole) pl_find_special(d, base);
    if (d->special.n == before) return pole ? pl_poison() : x;
  }
}

// The limit of a coordinate or velocity means that of its motion. Another quantity, or one without
// a closed motion, stays.
pl_expr pl_as_function_of_time(pl_analysis* d, pl_expr e, pl_expr name) {
  int i = pl_kind_of(d->pool, name) == PL_SYMBOL ? pl_variable_index(d, pl_symbol_of(d->pool, name))
                                                 : -1;
  if (i < 0 || !d->reduced) return e;
  pl_replace* r = PL_ARRAY(d->arena, pl_replace, 2 * d->gen.n + 1);
  int n = 0;
  for (int k = 0; k < d->gen.n; k++) {
    const pl_variable* c = &d->q.at[d->gen.at[k]];
    if (!pl_has_symbol(d->pool, e, c->q) && !pl_has_symbol(d->pool, e, c->v)) continue;
    pl_expr x = pl_closed_motion(d, d->gen.at[k], NULL);
    if (pl_is_poison(x)) return e;
    r[n++] = (pl_replace){c->q, x};
    r[n++] = (pl_replace){c->v, pl_diff(d->pool, x, pl_time(d->pool))};
  }
  return pl_subst(d->pool, e, r, n);
}
