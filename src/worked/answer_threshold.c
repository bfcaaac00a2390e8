// answer_threshold: the values of a given quantity at which the stability of a position of rest
// changes: where one of its conditions
// changes its sign while the others hold.
#include <math.h>
#include <string.h>

#include "worked/equilibria_impl.h"

enum { max_thresholds = 16 };

typedef struct pl_thresholds {
  pl_symbol x;
  bool positive;  // x is
  pl_expr value[max_thresholds];
  int n;
  bool complete;  // every condition was solved for x, every position was judged
} pl_thresholds;

// With x at the threshold: can e be >= 0 there?  What has no sign and no number may be.
static bool may_hold(pl_analysis* d, const pl_thresholds* found, pl_expr e, pl_expr value) {
  e = pl_alg_normal(d->tower, pl_subst1(d->pool, e, found->x, value));
  int sign = 0;
  if (pl_alg_sign_proven(d->tower, e, true, &sign) == PL_YES) return sign >= 0;
  double x = pl_number(d, e);
  return isnan(x) || x >= -1e-12;
}

static bool is_value_of(pl_analysis* d, const pl_thresholds* found, const pl_root* root) {
  int sign = 0;
  bool negative = pl_alg_sign_proven(d->tower, root->value, true, &sign) == PL_YES && sign <= 0;
  if (found->positive && (negative || pl_number(d, root->value) < 0)) return false;
  if (!pl_is_poison(root->condition) && pl_number(d, root->condition) < 0) return false;
  for (int j = 0; j < found->n; j++) {
    if (pl_alg_equal(d->tower, found->value[j], root->value) == PL_YES) return false;
  }
  return found->n < max_thresholds;
}

static void show_threshold(pl_analysis* d, pl_thresholds* found, pl_expr e, const pl_root* root,
                           const pl_rest* r) {
  pl_expr value = root->value;
  found->value[found->n++] = value;
  const pl_form *form = pl_f(d, value, PL_S_QUOTIENT), *real = NULL;
  pl_step* step = pl_show_numbered(d, pl_feq(d, pl_fs(d, found->x), form));
  bool known;
  const char* text = NULL;
  pl_step_value(d, step, value, pl_dimension_of_expr(d, value, &known));
  pl_value* v = pl_answer(d, pl_symbol_get(d->pool, found->x)->ascii, value, form);
  pl_tell_place(d, r, v);
  pl_say(d, PL_BOTH("where the stability of {1} changes"), 1, pl_rest_form(d, r));
  if (!pl_is_poison(root->condition)
      && pl_condition_form(d, root->condition, false, &real, &text) == PL_UNKNOWN) {
    v->exists_if = text;
    pl_say(d, PL_BOTH("exists if {1}"), 1, real);
  }
  pl_claim_free(d, PL_CLAIM_INSERTED, pl_subst1(d->pool, e, found->x, value), pl_int(d->pool, 0));
}

// The roots in x of one condition: of its factors with odd powers, where its sign changes.
static void threshold_of(pl_analysis* d, const pl_verdict* judged, int which, const pl_rest* r,
                         pl_thresholds* found) {
  enum { most = 12 };
  pl_factor factor[most];
  pl_expr unit;
  int n = pl_alg_factors(d->tower, judged->condition[which], factor, most, &unit);
  for (int i = 0; i < n; i++) {
    if (factor[i].power % 2 == 0 || !pl_has_symbol(d->pool, factor[i].base, found->x)) continue;
    pl_root root[8];
    bool complete = false;
    int m = pl_alg_roots(d->tower, factor[i].base, found->x, root, 8, &complete);
    found->complete &= complete;
    for (int k = 0; k < m; k++) {
      bool holds = is_value_of(d, found, &root[k]);
      for (int j = 0; j < judged->n && holds; j++)
        holds = j == which || may_hold(d, found, judged->condition[j], root[k].value);
      for (int j = 0; j < r->n_conditions && holds; j++)
        holds = may_hold(d, found, r->condition[j], root[k].value);
      if (holds) show_threshold(d, found, factor[i].base, &root[k], r);
    }
  }
}

static void thresholds_of(pl_analysis* d, const pl_expr* f, const pl_rest* r,
                          pl_thresholds* found) {
  pl_linearised l;
  pl_verdict judged;
  pl_linearise(d, f, r, &l);
  pl_stability(d, f, &l, r, &judged);
  if (judged.doubt != PL_DOUBT_NONE) found->complete = false;
  for (int k = 0; k < judged.n && judged.doubt == PL_DOUBT_NONE; k++)
    threshold_of(d, &judged, k, r, found);
}

void pl_answer_threshold(pl_analysis* d, const pl_ask* ask) {
  pl_section_open(d, ask, PL_BOTH("Threshold"));
  pl_expr f[pl_max_gen];
  if (!ask->label || strcmp(ask->label, "stable") != 0 || !ask->variable.id) {
    pl_answer_pending(d, ask);
    return;
  }
  if (pl_rests_out_of_reach(d)) return;
  pl_at_rest_equations(d, f);
  if (pl_say_bends(d, f)) return;
  int sign = 0;
  pl_thresholds found = {.x = ask->variable, .complete = true};
  found.positive = pl_alg_sign_proven(d->tower, pl_sym(d->pool, found.x), false, &sign) == PL_YES
                   && sign > 0;
  found.positive |= pl_number(d, pl_sym(d->pool, found.x)) > 0;
  pl_rest named;
  pl_answer3 is_rest = pl_names_a_place(d, ask) ? pl_named_rest(d, ask, f, &named) : PL_UNKNOWN;
  if (is_rest == PL_NO) {
    pl_say_no_rest_named(d, ask, f);
    return;
  }
  if (is_rest == PL_YES) {
    thresholds_of(d, f, &named, &found);
  } else {
    pl_rests* rests = pl_find_rests(d, f);
    if (rests->special_case) pl_say_special(d);
    found.complete = rests->complete && !rests->by_numbers;
    for (int k = 0; k < rests->n; k++) {
      if (pl_rest_on_border(d, rests, &rests->at[k])) continue;
      if (!rests->at[k].numeric && pl_rest_is_named(d, ask, &rests->at[k]))
        thresholds_of(d, f, &rests->at[k], &found);
    }
  }
  if (found.n > 0) return;
  if (found.complete) {
    pl_say(d,
           PL_BOTH(is_rest == PL_YES ? "This position does not change its stability with {1}."
                                     : "No position of rest changes its stability with {1}."),
           1, pl_fs(d, found.x));
    return;
  }
  pl_say(d, PL_BOTH("None was found in closed form."), 0);
  d->page->section->not_found = true;
}
