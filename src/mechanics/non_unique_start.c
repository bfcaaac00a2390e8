// escape: starts from which a motion is not unique. At rest in an equilibrium u = q - q0 = 0 of one
// coordinate with
//   u'' = C u^p + ...,  0 < p < 1,  C > 0
// the force has an unbounded slope (it is not Lipschitz), and besides rest every u = A (t - T)^k
// with k = 2/(1 - p) and
// A^(1-p) = C/(k (k - 1)) leaves it, T as late as one likes. [Norton2003],
// [CoddingtonLevinson1955, chapter 1]
// See theory (6.5).
#include <math.h>

#include "mechanics/mechanics.h"

// The start of the only generalized coordinate, at rest and free of force; false when it is none.
static bool rest_at(pl_analysis* d, pl_expr* q0) {
  if (!d->solved || !d->reduced || d->gen.n != 1) return false;
  const pl_variable* c = &d->q.at[d->gen.at[0]];
  pl_expr v0;
  bool given = false;
  for (int k = 0; k < d->model->inits.n; k++) {
    const pl_init* init = &d->model->inits.at[k];
    if (init->guess || !pl_same(init->target, pl_sym(d->pool, c->q))) continue;
    given = true;
    *q0 = init->value;
  }
  pl_expr start;
  pl_motion_start(d, &(pl_motion){0}, c, &start, &v0);
  return given && pl_starts_in_equilibrium(d, *q0, v0) == PL_YES;
}

// p and C of u'' = C u^p, exact; false when the force has another form at the start.
static bool power_law(pl_analysis* d, pl_expr q0, pl_expr* p, pl_expr* C) {
  pl_pool* pool = d->pool;
  const pl_variable* c = &d->q.at[d->gen.at[0]];
  pl_expr a = d->acceleration[d->gen.at[0]], u = pl_sub(pool, pl_sym(pool, c->q), q0);
  *p = pl_alg_normal(d->tower, pl_div(pool, pl_mul(pool, u, pl_diff(pool, a, c->q)), a));
  if (pl_is_poison(*p) || !pl_is_number(pool, *p)) return false;
  double x = pl_number_double(pool, *p);
  if (!(x > 0 && x < 1)) return false;
  *C = pl_alg_normal(d->tower, pl_div(pool, a, pl_pow(pool, u, *p)));
  return !pl_is_poison(*C) && !pl_has_coordinates(d, *C);
}

// The slope of the force at the start is unbounded: u a'/a stays below 1 while u shrinks. By
// numbers.
static bool unbounded_slope(pl_analysis* d, pl_expr q0) {
  const pl_variable* c = &d->q.at[d->gen.at[0]];
  pl_expr a = d->acceleration[d->gen.at[0]], slope = pl_diff(d->pool, a, c->q);
  double at = pl_number(d, q0);
  pl_number(d, pl_add(d->pool, a, slope));
  if (isnan(at)) return false;
  double kept = d->value[c->q.id];
  bool all = true;
  for (int k = 6; k <= 12 && all; k += 3) {
    double u = pow(10, -k);
    d->value[c->q.id] = at + u;
    double f = pl_eval(d->pool, a, d->value), df = pl_eval(d->pool, slope, d->value),
           ratio = u * df / f;
    all = f > 0 && ratio > 0 && ratio < 0.999;  // a smooth force has a ratio of 1 or more
  }
  d->value[c->q.id] = kept;
  return all;
}

bool pl_escapes(pl_analysis* d) {
  pl_expr q0, p, C;
  if (d->loops.n > 0 || !rest_at(d, &q0)) return false;
  return power_law(d, q0, &p, &C) || unbounded_slope(d, q0);
}

// A name for the waiting time that the model does not use.
static pl_symbol waiting_time(pl_analysis* d) {
  bool taken = pl_symbol_find(d->pool, "T0").id != 0
               && pl_symbol_get(d->pool, pl_symbol_find(d->pool, "T0"))->role == PL_R_PARAM;
  const char* name = taken ? "T_wait" : "T0";
  pl_symbol_info info = {
      .name = taken ? "T_wait" : "T₀",
      .ascii = name,
      .role = PL_R_LOCAL,
      .class = PL_C_OTHER,
      .dimension = pl_symbol_get(d->pool, pl_time(d->pool))->dimension,
      .dimension_known = pl_symbol_get(d->pool, pl_time(d->pool))->dimension_known};
  return pl_symbol_make(d->pool, &info);
}

pl_expr pl_escape_motion(pl_analysis* d, pl_symbol* wait) {
  pl_expr q0, p, C;
  pl_pool* pool = d->pool;
  if (!rest_at(d, &q0) || !power_law(d, q0, &p, &C)) return pl_poison();
  int sign = 0;
  if (pl_alg_sign(d->tower, C, false, &sign) != PL_YES || sign <= 0) return pl_poison();
  pl_expr rest = pl_sub(pool, pl_int(pool, 1), p), k = pl_div(pool, pl_int(pool, 2), rest);
  pl_expr root = pl_div(pool, C, pl_mul(pool, k, pl_sub(pool, k, pl_int(pool, 1))));
  *wait = waiting_time(d);
  pl_expr since = pl_sub(pool, pl_sym(pool, pl_time(pool)), pl_sym(pool, *wait));
  pl_expr A = pl_pow(pool, root, pl_div(pool, pl_int(pool, 1), rest));
  return pl_add(pool, q0, pl_mul(pool, A, pl_pow(pool, since, k)));
}
