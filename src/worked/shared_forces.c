// shared_forces: forces of constraints that depend on each other: which sums the motion determines,
// and the choice of smallest norm.
#include "worked/worked_impl.h"

static void show_sums(pl_analysis* d, const bool* in) {
  for (int a = 0; a < d->g.n; a++) {
    if (!in[a] || pl_dependence_of(d, a) || !d->g.at[a].lambda_known) continue;
    pl_expr sum, value;
    pl_determined_sum(d, a, &sum, &value);
    const pl_form* form = pl_f(d, value, PL_S_QUOTIENT);
    pl_step* step = pl_show_numbered(d, pl_feq(d, pl_fe(d, sum), form));
    pl_step_value(d, step, value, pl_dimension_of_expr(d, value, NULL));
    if (pl_dependences_hold_everywhere(d))
      pl_claim_that(d, PL_CLAIM_MOTION, pl_form_value(d->pool, form), sum);
    pl_answer(d, pl_expr_text(d->arena, d->pool, sum), value, form);
  }
}

static void show_smallest(pl_analysis* d, const bool* in) {
  pl_expr* lambda = PL_ARRAY(d->arena, pl_expr, d->g.n);
  if (!pl_smallest_multipliers(d, in, lambda)) return;
  pl_say(d,
         PL_BOTH("A choice is needed for more; the one with the smallest sum of squares (minimum "
                 "norm) is:"),
         0);
  for (int a = 0; a < d->g.n; a++) {
    if (!in[a] || !d->g.at[a].lambda_known) continue;
    const pl_form* form = pl_f(d, lambda[a], PL_S_QUOTIENT);
    pl_step* step = pl_show(d, pl_feq(d, pl_fs(d, d->g.at[a].lambda), form));
    pl_step_value(d, step, lambda[a], pl_dimension_of_expr(d, lambda[a], NULL));
    pl_value* v = pl_answer(d, pl_symbol_get(d->pool, d->g.at[a].lambda)->ascii, lambda[a], form);
    v->of = d->g.at[a].source->name.text;
    v->branch = "minimum norm";
  }
}

bool pl_say_shared(pl_analysis* d, int link) {
  if (!d->g.at[link].shared) return false;
  bool* in = PL_ARRAY(d->arena, bool, d->g.n);
  pl_group_sharing(d, link, in);
  const pl_form** name = PL_ARRAY(d->arena, const pl_form*, d->g.n);
  int n = 0, n_free = 0;
  for (int k = 0; k < d->g.n; k++) {
    if (!in[k]) continue;
    name[n++] = pl_fn(d, d->g.at[k].source->name.text);
    n_free += pl_dependence_of(d, k) != NULL;
  }
  pl_say(d,
         PL_BOTH_FORMAT(d->arena,
                        "The constraints {1} depend on each other (rank %d of %d): {2} is not "
                        "determined, only the sums",
                        n - n_free, n),
         2, pl_flist(d, name, n), pl_fs(d, d->g.at[link].lambda));
  show_sums(d, in);
  show_smallest(d, in);
  return true;
}
