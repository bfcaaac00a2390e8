// What a run in extended precision keeps when it is written down (checkpoint.c).
//
// clang-format off
// not kept of pl_extended, follows from setup, options and mode: state fine by_doubles low top head
//   head_forces clock left grid drift t_0 q_0 v_0 a_0 l_0 end_a end_l tail_q tail_v tail_a tail_l
//   from to share way scratch energy_base rows watched floor held high next
// not kept of pl_extended, pl_step_program, lives within a step: digits arrived
// clang-format on
#include "solve/stepper/taylor/extended_impl.h"

static void keep_fixed(pl_keeper* k, int x) { pl_keep_int(k, &x, x, x); }

// Their memory holds the state, the time and the nodes at the point.
void pl_extended_save(pl_run* run, pl_keeper* k) {
  pl_keep_section(k, "extended");
  if (k->reads && !k->wrong && run->extended && !pl_extended_of_mode(run)) pl_keep_fail(k);
  pl_extended* w = run->extended;
  bool needs_program = run->dae.at_point && w && w->by_doubles;
  if (k->reads && needs_program && !(run->taylor->program && run->taylor->program->usable))
    pl_keep_fail(k);
  keep_fixed(k, w ? w->o->size : 0);
  if (w == NULL) return;
  pl_keep_bytes(k, w->m, (size_t)w->o->size * w->fine->size);
  pl_keep_f64s(k, w->o->size_most, (size_t)w->o->n);
  pl_keep_f64(k, &w->o->fade_best);
  pl_keep_f64(k, &w->part);
}
