// frames: the orthonormal frame that a position map implies. When the columns dX/dq_i are
// orthogonal, e_i points along them, and the equation of q_i divided by |dX/dq_i| is the component
// of Newton's law along e_i.
// See theory (2.6).
#include "mechanics/equilibria.h"

const char* pl_unit_vector(pl_analysis* d, int i) {
  return pl_format(d->arena, "e_%s", pl_symbol_get(d->pool, d->q.at[i].q)->name);
}

static pl_expr dot_columns(pl_analysis* d, const pl_particle* k, int i, int j) {
  pl_expr sum = pl_int(d->pool, 0);
  for (int c = 0; c < k->n; c++) {
    pl_expr a = pl_diff(d->pool, k->at[c], d->q.at[i].q),
            b = pl_diff(d->pool, k->at[c], d->q.at[j].q);
    sum = pl_add(d->pool, sum, pl_mul(d->pool, a, b));
  }
  return sum;
}

// A constraint says r = -l.
static bool is_fixed_below_zero(pl_analysis* d, pl_expr e) {
  pl_expr value = pl_on_contact(d, e), other = pl_neg(d->pool, value);
  // no minus sign in it
  if (pl_same(value, e) || pl_op_count(d->pool, other) >= pl_op_count(d->pool, value)) return false;
  int sign = 0;
  return pl_alg_sign(d->tower, value, false, &sign) == PL_YES && sign < 0;
}

// |r| -> r with the assumption r >= 0 on record, factor by factor.
static pl_expr without_bars(pl_analysis* d, pl_expr e) {
  if (pl_kind_of(d->pool, e) == PL_CALL && pl_function_of(d->pool, e) == PL_ABS) {
    pl_expr inside = pl_arg(d->pool, e, 0);
    if (is_fixed_below_zero(d, inside)) return pl_neg(d->pool, inside);
    pl_tower_use(d->tower, (pl_fact){inside, false});
    return inside;
  }
  if (pl_kind_of(d->pool, e) != PL_MUL) return e;
  pl_expr product = pl_int(d->pool, 1);
  for (int j = 0; j < pl_n_args(d->pool, e); j++)
    product = pl_mul(d->pool, product, without_bars(d, pl_arg(d->pool, e, j)));
  return product;
}

// |dX/dq_i|, with the sign of a radius taken positive (sin θ of spherical coordinates too: recorded
// as assumption). What the energies need is assumed before, so that signs that are new belong to
// the directions of unit vectors only.
static pl_expr scale_of(pl_analysis* d, const pl_particle* k, int i) {
  pl_alg_normal(d->tower, pl_at_rest(d, d->L));
  int before = 0, after = 0;
  pl_tower_used(d->tower, &before);
  pl_expr square = pl_alg_normal(d->tower, dot_columns(d, k, i, i));
  pl_expr scale = without_bars(d, pl_alg_normal(d->tower, pl_sqrt(d->pool, square)));
  const pl_fact* used = pl_tower_used(d->tower, &after);
  for (int j = before; j < after; j++) pl_push(d->arena, d->directions, used[j]);
  return scale;
}

bool pl_frame_find(pl_analysis* d, const pl_particle* k, pl_frame* out) {
  out->n = 0;
  for (int i = 0; i < d->q.n; i++) {
    bool moves = false;
    for (int c = 0; c < k->n; c++) moves |= pl_has_symbol(d->pool, k->at[c], d->q.at[i].q);
    if (!moves) continue;
    if (out->n == 3 || out->n == k->n) return false;
    out->coordinate[out->n++] = i;
  }
  for (int a = 0; a < out->n; a++) {
    for (int b = 0; b < a; b++) {
      pl_expr dot = dot_columns(d, k, out->coordinate[a], out->coordinate[b]);
      if (pl_alg_is_zero(d->tower, dot) != PL_YES) return false;
    }
    out->scale[a] = scale_of(d, k, out->coordinate[a]);
    if (pl_is_poison(out->scale[a])) return false;
  }
  return out->n > 0;
}
