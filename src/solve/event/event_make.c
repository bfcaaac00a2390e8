// The workspace of events.
#include "solve/event/event.h"

#include <math.h>

static void reserve_contacts(pl_arena* a, pl_events* e, size_t q, size_t c, size_t frictions) {
  double** of_q[] = {&e->save_q, &e->save_v, &e->save_a, &e->jump_q,
                     &e->jump_v, &e->hold_q, &e->hold_v, &e->first_a};
  double** of_c[] = {&e->save_l, &e->impulse,     &e->impact_factor, &e->approach,
                     &e->second, &e->second_size, &e->fastest,       &e->settled_t};
  bool** flags[] = {&e->save_unique, &e->on_before, &e->jumped, &e->met, &e->impact_taken};
  for (size_t i = 0; i < sizeof of_q / sizeof *of_q; i++) *of_q[i] = PL_ARRAY(a, double, q + 1);
  for (size_t i = 0; i < sizeof of_c / sizeof *of_c; i++) *of_c[i] = PL_ARRAY(a, double, c + 1);
  for (size_t i = 0; i < sizeof flags / sizeof *flags; i++) *flags[i] = PL_ARRAY(a, bool, c + 1);
  for (size_t i = 0; i < c; i++) e->settled_t[i] = (double)NAN;
  e->decision = PL_ARRAY(a, pl_decision, c + frictions + 1);
  e->choice_kept = PL_ARRAY(a, int, c + frictions + 1);
  e->fixed = PL_ARRAY(a, unsigned, c + 1);
  e->bounce_t = PL_ARRAY(a, double, 3 * c + 1);
  e->bounces = PL_ARRAY(a, long, c + 1);
}

static void reserve_series(pl_arena* a, pl_events* e, const pl_setup* s, size_t orders) {
  e->G_series = PL_ARRAY(a, double, (size_t)s->n_c* orders + 1);
  e->W_series = PL_ARRAY(a, double, (size_t)s->n_watched* orders + 1);
  e->W_coef = PL_ARRAY(a, double, s->n_watched + 1);
  e->poly = PL_ARRAY(a, double, orders + 1);
  e->root_work = PL_ARRAY(a, double, PL_ROOT_WORK(orders));
}

void pl_events_make(pl_run* run) {
  pl_arena* a = run->job->arena;
  const pl_setup* s = run->setup;
  pl_events* e = run->event = PL_NEW(a, pl_events);
  reserve_contacts(a, e, (size_t)s->n_q, (size_t)s->n_c, (size_t)s->n_frictions);
  reserve_series(a, e, s, (size_t)run->order + 2);
  pl_indeterminate_make(run);
  pl_watch_make(run);
  pl_switching_make(run);
}
