// samples: places of the generalized coordinates drawn at random, with the given numbers where
// there are any, for questions that only
// doubt: is a map real everywhere, can a coefficient vanish.
#include <math.h>

#include "mechanics/mechanics.h"

static const int n_samples = 60, most_draws = 50;
static const double longest_place = 100;  // of places that are drawn, in SI

bool pl_is_turned(pl_analysis* d, pl_expr e, pl_symbol q) {
  bool here = pl_kind_of(d->pool, e) == PL_CALL && pl_has_symbol(d->pool, e, q);
  for (int k = 0; k < pl_n_args(d->pool, e) && !here; k++)
    here = pl_is_turned(d, pl_arg(d->pool, e, k), q);
  return here;
}

// In a sine or cosine of some constraint or map.
static bool is_an_angle(pl_analysis* d, int i) {
  bool turned = false;
  for (int k = 0; k < d->g.n; k++) turned |= pl_is_turned(d, d->g.at[k].g, d->q.at[i].q);
  for (int k = 0; k < d->q.n; k++)
    turned |= !pl_is_poison(d->q.at[k].map) && pl_is_turned(d, d->q.at[k].map, d->q.at[i].q);
  return turned;
}

static bool facts_hold(pl_analysis* d, const double* x) {
  for (int k = 0; k < d->facts.n; k++) {
    double y = pl_eval(d->pool, d->facts.at[k].difference, x);
    if (!isnan(y) && y < 0) return false;
  }
  return true;
}

static void draw(pl_analysis* d, pl_random* r, double* x) {
  for (int k = 1; k <= pl_symbol_count(d->pool); k++) {
    pl_role role = pl_symbol_get(d->pool, (pl_symbol){(uint32_t)k})->role;
    double known = k <= d->n_value ? d->value[k] : (double)NAN;
    x[k] = isnan(known) && role == PL_R_PARAM ? pl_random_between(r, 0.3, 3)
           : role == PL_R_TIME                ? pl_random_between(r, 0, 10)
                                              : known;
  }
  for (int k = 0; k < d->gen.n; k++) {
    int i = d->gen.at[k];
    double wide = is_an_angle(d, i) ? M_PI : pow(longest_place, pl_random_between(r, -1, 1));
    x[d->q.at[i].q.id] = pl_random_between(r, -wide, wide);
  }
}

void pl_draw_place(pl_analysis* d, pl_random* r, double* x) {
  pl_number(d, pl_int(d->pool, 0));  // numbers are up to date
  draw(d, r, x);
  for (int tries = 0; tries < most_draws && !facts_hold(d, x); tries++) draw(d, r, x);
}

bool pl_keeps_sign(pl_analysis* d, pl_expr e) {
  double* x = PL_ARRAY(d->arena, double, pl_symbol_count(d->pool) + 1);
  pl_random r = {1618};
  int above = 0, below = 0;
  for (int s = 0; s < n_samples; s++) {
    pl_draw_place(d, &r, x);
    double y = pl_eval(d->pool, e, x);
    above += y > 0;
    below += !(y > 0);  // not real counts too
  }
  return above == 0 || below == 0;
}
