// answer_momenta: momenta and angular momenta of the whole system among the conserved quantities.
#include <string.h>

#include "worked/worked_impl.h"

// Stated already, as a momentum or up to its sign and a number; or no motion at all.
static bool is_known(pl_analysis* d, pl_expr I) {
  if (pl_is_poison(I) || !pl_has_role(d->pool, I, PL_R_VELOCITY)) return true;
  for (int k = 0; k < d->page->section->values.n; k++) {
    const pl_value* v = &d->page->section->values.at[k];
    if (v->conserved != 1 || pl_is_poison(v->expr)) continue;
    pl_expr ratio = pl_alg_normal(d->tower, pl_div(d->pool, I, v->expr));
    if (!pl_is_poison(ratio) && !pl_has_coordinates(d, ratio)) return true;
  }
  return false;
}

static bool name_is_taken(pl_analysis* d, const char* name) {
  for (int k = 0; k < d->page->section->values.n; k++) {
    if (strcmp(d->page->section->values.at[k].name, name) == 0) return true;
  }
  return false;
}

static void say_shift(pl_analysis* d, const pl_momentum* m) {
  pl_say(
      d,
      PL_BOTH(
          "conserved: nothing changes when all masses are shifted along {1}, and no force without "
          "potential works along it."),
      1, pl_fn(d, d->model->axes[m->axis].name));
}

static void say_turn(pl_analysis* d, const pl_momentum* m) {
  const pl_form* axis = pl_fn(d, m->axis < d->model->n_axes ? d->model->axes[m->axis].name : "z");
  if (pl_is_zero_node(d->pool, m->centre[0]) && pl_is_zero_node(d->pool, m->centre[1])) {
    pl_say(
        d,
        PL_BOTH(
            "conserved: nothing changes when the whole system is turned about the {1} axis, and no "
            "force without potential works along it."),
        1, axis);
    return;
  }
  const pl_form* place[2];
  for (int k = 0; k < 2; k++) {
    const char* along = d->model->axes[(m->axis + 1 + k) % 3].name;
    place[k] = pl_feq(d, pl_fn(d, along), pl_f(d, m->centre[k], PL_S_PLAIN));
  }
  pl_say(
      d,
      PL_BOTH(
          "conserved: nothing changes when the whole system is turned about the line along {1} at "
          "{2}, and no force without potential works "
          "along it."),
      2, axis, pl_flist(d, place, 2));
}

static void answer_momentum(pl_analysis* d, const pl_momentum* m) {
  if (is_known(d, m->value)) return;
  const char* name = pl_format(d->arena, m->turn ? "L_%s" : "p_%s",
                               m->axis < d->model->n_axes ? d->model->axes[m->axis].ascii : "z");
  for (int k = 1; name_is_taken(d, name); k++) name = pl_format(d->arena, "I%d", k);
  const pl_form* form = pl_f(d, m->value, PL_S_ENERGY);
  pl_show(d, pl_feq(d, pl_fn(d, name), form));
  if (m->turn) say_turn(d, m);
  else say_shift(d, m);
  pl_value* v = pl_answer(d, name, m->value, form);
  v->conserved = 1;
  v->because[0] = "symmetry of the whole system (Noether)";
  v->because[1] = pl_german("symmetry of the whole system (Noether)");
  pl_claim_that(d, PL_CLAIM_MOTION, pl_dt(d->pool, pl_form_value(d->pool, form)), m->rate);
}

void pl_answer_momenta(pl_analysis* d) {
  pl_momentum m[PL_MAX_MOMENTA];
  int n = pl_find_momenta(d, m);
  for (int k = 0; k < n; k++) answer_momentum(d, &m[k]);
}
