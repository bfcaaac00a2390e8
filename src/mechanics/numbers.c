// numbers: given quantities in numbers, as doubles and exactly, and what they decide: signs, zeros.
#include <math.h>

#include "mechanics/mechanics.h"

pl_expr pl_with_given_numbers(pl_analysis* d, pl_expr e) {
  const pl_model* m = d->model;
  for (int k = m->lets.n - 1; k >= 0; k--) {
    if (!m->lets.at[k].inserted && m->lets.at[k].n_args == 0)
      e = pl_subst1(d->pool, e, m->lets.at[k].symbol, m->lets.at[k].value);
  }
  for (int k = m->params.n - 1; k >= 0; k--) {
    if (!pl_is_poison(m->params.at[k].value))
      e = pl_subst1(d->pool, e, m->params.at[k].symbol, m->params.at[k].value);
  }
  return e;
}

// Over given quantities alone.
static bool is_given(pl_analysis* d, pl_expr e) {
  return !pl_is_poison(e) && !pl_has_coordinates(d, e)
         && !pl_has_symbol(d->pool, e, pl_time(d->pool)) && !pl_has_role(d->pool, e, PL_R_START)
         && !pl_has_role(d->pool, e, PL_R_LOCAL);
}

bool pl_vanishes_at_numbers(pl_analysis* d, pl_expr e) {
  if (!is_given(d, e) || pl_is_number(d->pool, e)) return false;
  pl_expr there = pl_with_given_numbers(d, e);
  return !pl_same(there, e) && pl_alg_is_zero(d->tower, there) == PL_YES
         && pl_alg_is_zero(d->tower, e) != PL_YES;
}

// A later set of constraints begins elsewhere: the places of its beginning decide on signs there.
static void know_later_start(pl_analysis* d, double* value, int n) {
  const pl_stage* s = d->stage;
  bool later = s && (s->later || s->n_sides > 0);
  for (int i = 0; later && i < s->n_q; i++) {
    pl_symbol q = pl_symbol_find(d->pool, s->q_name[i]);
    if (!q.id || pl_symbol_get(d->pool, q)->role != PL_R_COORD) continue;
    pl_symbol start = pl_symbol_start(d->pool, q),
              speed = pl_symbol_start(d->pool, pl_symbol_dot(d->pool, q));
    if ((int)start.id <= n) value[start.id] = s->q[i];
    if ((int)speed.id <= n) value[speed.id] = s->n_sides > 0 ? s->v[i] : (double)NAN;
  }
}

// Numbers known by symbol id: parameters, abbreviations of parameters, start values.
double* pl_known_numbers(pl_analysis* d) {
  double* value = pl_model_values(d->model, d->arena);
  int n = pl_symbol_count(d->pool);
  for (int k = 0; k < d->model->inits.n; k++) {
    const pl_init* init = &d->model->inits.at[k];
    if (init->guess || pl_kind_of(d->pool, init->target) != PL_SYMBOL) continue;
    double x = pl_eval(d->pool, init->value, value);
    if (isnan(x)) continue;
    pl_symbol s = pl_symbol_start(d->pool, pl_symbol_of(d->pool, init->target));
    if ((int)s.id <= n) value[s.id] = x;
  }
  know_later_start(d, value, n);
  return value;
}

// e with the given numbers in it, exactly.
static pl_expr with_numbers(pl_analysis* d, pl_expr e) {
  const pl_model* m = d->model;
  for (int k = m->lets.n - 1; k >= 0; k--) {
    if (!m->lets.at[k].inserted && m->lets.at[k].n_args == 0)
      e = pl_subst1(d->pool, e, m->lets.at[k].symbol, m->lets.at[k].value);
  }
  pl_replace* r = PL_ARRAY(d->arena, pl_replace, m->params.n + 1);
  int n = 0;
  for (int k = 0; k < m->params.n; k++) {
    if (!pl_is_poison(m->params.at[k].value))
      r[n++] = (pl_replace){m->params.at[k].symbol, m->params.at[k].value};
  }
  return pl_subst(d->pool, e, r, n);
}

pl_answer3 pl_zero_for_numbers(pl_analysis* d, pl_expr e) {
  pl_answer3 zero = pl_alg_is_zero(d->tower, e);
  return zero == PL_NO ? pl_alg_is_zero(d->tower, with_numbers(d, e)) : zero;
}

// Parameters are exact numbers: where inserting them leaves a rational, its double is the nearest
// one, 1.962 and not
// 1.9619999999999997.  Otherwise x stands.
static double exact_number(pl_analysis* d, pl_expr e, double x) {
  enum { small = 200 };
  if (pl_op_count(d->pool, e) > small) return x;
  e = with_numbers(d, e);
  return !pl_is_poison(e) && pl_is_number(d->pool, e) ? pl_number_double(d->pool, e) : x;
}

double pl_number(pl_analysis* d, pl_expr e) {
  if (pl_is_poison(e)) return (double)NAN;
  if (d->n_value != pl_symbol_count(d->pool)) {  // names were made since
    d->value = pl_known_numbers(d);
    d->n_value = pl_symbol_count(d->pool);
  }
  // another moment is meant
  if (d->later && pl_has_role(d->pool, e, PL_R_START)) return (double)NAN;
  double x = pl_eval(d->pool, e, d->value);
  return isnan(x) ? x : exact_number(d, e, x);
}

int pl_sign_at_numbers(pl_analysis* d, pl_expr e) {
  int sign = 0;
  if (pl_vanishes_at_numbers(d, e)) return 0;  // exactly; rounding would give it a sign
  if (pl_alg_sign(d->tower, e, false, &sign) == PL_YES) return sign;
  double x = pl_number(d, e);
  if (isnan(x) || x == 0) return 0;
  pl_tower_use(d->tower, (pl_fact){x > 0 ? e : pl_neg(d->pool, e), true});
  return x > 0 ? 1 : -1;
}

int pl_sign_or_positive(pl_analysis* d, pl_expr e) {
  int sign = pl_sign_at_numbers(d, e);
  if (sign != 0 || !isnan(pl_number(d, e)) || pl_vanishes_at_numbers(d, e)
      || pl_alg_is_zero(d->tower, e) == PL_YES)
    return sign;
  pl_tower_use(d->tower, (pl_fact){e, true});
  return 1;
}
