// answer_positions: positions and velocities by the maps, where nothing is heavy and no force acts.
#include "worked/worked_impl.h"

static void show_mapped(pl_analysis* d, pl_symbol name, pl_expr e) {
  const pl_form* form = pl_f(d, e, PL_S_SOLUTION);
  pl_step* step = pl_show_numbered(d, pl_feq(d, pl_fs(d, name), form));
  bool known;
  pl_step_value(d, step, e, pl_dimension_of_expr(d, pl_sym(d->pool, name), &known));
  pl_claim_that(d, PL_CLAIM_MAP, pl_form_value(d->pool, form), pl_sym(d->pool, name));
  pl_answer(d, pl_symbol_get(d->pool, name)->ascii, e, form);
}

void pl_answer_positions(pl_analysis* d) {
  if (!d->reduced || (d->maps.n == 0 && d->loops.n == 0)) return;
  pl_ask ask = {.text = "positions"};
  pl_section_open(d, &ask, PL_BOTH("Positions and velocities"));
  pl_tell_loops(d);
  for (int i = 0; i < d->q.n; i++) {
    const pl_variable* c = &d->q.at[i];
    if (c->fixed_by < 0 && !pl_is_poison(c->map) && pl_follower(d, i) < 0)
      show_mapped(d, c->q, c->map);
  }
  for (int i = 0; i < d->q.n; i++) {
    const pl_variable* c = &d->q.at[i];
    if (c->fixed_by >= 0 || pl_is_poison(c->map) || pl_follower(d, i) >= 0) continue;
    show_mapped(d, c->v, pl_alg_normal(d->tower, pl_on_maps(d, pl_sym(d->pool, c->v))));
  }
}
