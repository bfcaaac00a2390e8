// The state of a run between two steps, written down and read back: a run that goes on from it
// takes the same steps, bit for bit, as one that was never interrupted.
//
// Everything that a later step looks at and that does not follow from the setup is named here,
// once, by functions that serve both ways (pl_keeper in base.h). What follows from the point alone
// (nodes, factor, order 0 of the series) is computed anew and must come out the same: so a machine
// or a library that rounds differently is found out. Two things are kept although they could be
// computed: the memory of the compiled steps at the point, whose last digits depend on the way that
// led there, and the matrix from which the sparse solver took its pivot order.
//
// tools/check_state.py holds the structs of a run against this file: each member is kept below or
// stands in one of these lists.
//
// clang-format off
// not kept of pl_control, follows from setup and options: tol_raised h_plain h_least row_gap
//   grid_count grid_dt grid_times
// not kept of pl_control, follows from how it was started: start_given
// not kept of pl_control, lives within a step: trial_q trial_v row_q row_v row_a row_l energy_out
// not kept of pl_control, where the lead run waits it goes there again: stop
// not kept of pl_dae, follows from setup and options: motion has_W mass_of_velocity at_friction job
//   setup n_q n_c order
// not kept of pl_dae, follows from the point: Q V ready t_series rests
// not kept of pl_dae, lives within a step: rhs Q_last A_last rows rank_work priority row_of
//   row_taken taken_kept dep dep_tau dep_norm dep_jpvt impulsive C_series factored seen shown
//   shown_before
// not kept of pl_events, follows from setup and options: n_watch switches n_switches
// not kept of pl_events, lives within a step: impact_taken impact_factor G_series W_series save_q
//   save_v save_a save_l save_unique impulse jump_v jump_q poly root_work hit root touch undecided
//   sunk friction_before S_series poly_2 on_before fixed friction_fixed approach second hold_q
//   hold_v first_a decision choice_kept n_decisions K_series W_coef reach
// not kept of pl_events, lives within a moment: indeterminate
// not kept of pl_events, where the lead run waits it goes there again: impacts
// not kept of pl_output_state, follows from setup and options: mode_size
// not kept of pl_output_state, lives within a step: out_now out_before mode mode_before
// not kept of pl_run, follows from setup and options: observer job setup options n_q n_c order
//   observers watched branches
// not kept of pl_run, lives within a step: branch_value reference
// not kept of pl_run, of the start, which is found anew: start
// not kept of pl_taylor, follows from setup and options: shrink
// not kept of pl_taylor, only when, never what: clock_begin t_begin considered
// not kept of pl_taylor, lives within a step: end_a end_by_program arrived
// not kept of pl_run, parts with lists of their own: dae control event output taylor sensitivity
// not kept of pl_stats, follows from the options: precision
// not kept of pl_stats, a word about this process: why_interpreted
// not kept of pl_stats, made at the end: undetermined
// not kept of pl_kkt, follows from setup and point: n dense n_values value start row diagonal lu
//   scale balance work pivot ratio
// not kept of pl_watch, pl_friction_state, follows from the setup: kind index direction
// clang-format on
#include <limits.h>
#include <math.h>
#include <string.h>

#include "solve/driver_impl.h"

// ------------------------------------------------------------------------------------- whose state
// Counts go on from where they are, so there is room above.
static const long most_count = LONG_MAX / 8;
enum { LARGE_COUNT = 1 << 28 };

static void keep_fixed(pl_keeper* k, int x) { pl_keep_int(k, &x, x, x); }

// Dimensions: a state of another setup is not read as one of this.
static void keep_dimensions(pl_run* run, pl_keeper* k) {
  const pl_setup* s = run->setup;
  pl_keep_section(k, "dimensions");
  int of[] = {run->n_q,
              run->n_c,
              run->order,
              s->n_out,
              s->n_frictions,
              s->n_attitudes,
              s->n_events,
              s->n_watched,
              run->event->n_watch,
              run->event->n_switches,
              run->dae.kkt.dense,
              run->sensitivity != NULL,
              run->n_steppers};
  for (size_t i = 0; i < sizeof of / sizeof *of; i++) keep_fixed(k, of[i]);
}

// --------------------------------------------------------------------------- the point, yardsticks
static void keep_point(pl_run* run, pl_keeper* k) {
  size_t q = (size_t)run->n_q, c = (size_t)run->n_c;
  pl_keep_section(k, "point");
  double* numbers[] = {&run->dae.t,         &run->dae.t_low,      &run->dae.t_nodes,
                       &run->control.tol,   &run->dae.force_size, &run->control.t_last,
                       &run->control.h_last};
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) pl_keep_f64(k, numbers[i]);
  double* of_q[] = {run->dae.q, run->dae.v, run->dae.A};
  double* of_c[] = {run->dae.L, run->dae.g,      run->dae.g_size,   run->dae.argument,
                    run->dae.r, run->dae.r_size, run->dae.row_most, run->event->second_size};
  for (size_t i = 0; i < sizeof of_q / sizeof *of_q; i++) pl_keep_f64s(k, of_q[i], q);
  for (size_t i = 0; i < sizeof of_c / sizeof *of_c; i++) pl_keep_f64s(k, of_c[i], c);
  pl_keep_bool(k, &run->dae.at_point);
  pl_keep_int(k, &run->dae.use, 1, run->order);
  pl_keep_int(k, &run->control.use_last, 1, run->order);
}

static void keep_yardsticks(pl_run* run, pl_keeper* k) {
  size_t q = (size_t)run->n_q, c = (size_t)run->n_c;
  pl_keep_section(k, "yardsticks");
  double* numbers[] = {&run->dae.smallest,
                       &run->dae.best,
                       &run->event->smallest_here,
                       &run->dae.smallest_before,
                       &run->event->t_before,
                       &run->event->fade[0].t,
                       &run->event->fade[0].smallest,
                       &run->event->fade[1].t,
                       &run->event->fade[1].smallest,
                       &run->control.h_series,
                       &run->event->h_regular,
                       &run->dae.q_size,
                       &run->dae.v_size,
                       &run->control.energy_size,
                       &run->control.energy_base,
                       &run->control.a_rough};
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) pl_keep_f64(k, numbers[i]);
  double* of_q[] = {run->dae.q_most, run->dae.v_most, run->dae.q_kept, run->dae.v_kept,
                    run->dae.column};
  for (size_t i = 0; i < sizeof of_q / sizeof *of_q; i++) pl_keep_f64s(k, of_q[i], q);
  pl_keep_f64s(k, run->dae.row_long, c);
  pl_keep_f64s(k, run->dae.row_part, c);
  pl_keep_int(k, &run->control.tiny, 0, LARGE_COUNT);
}

// ---------------------------------------------------------------------------------------- the mode
static void keep_mode(pl_run* run, pl_keeper* k) {
  size_t c = (size_t)run->n_c;
  pl_keep_section(k, "mode");
  bool* of_c[] = {run->dae.on,      run->dae.detached, run->dae.active,       run->dae.taken,
                  run->dae.unique,  run->dae.several,  run->dae.ever_several, run->dae.slips,
                  run->dae.near_by, run->event->met,   run->dae.rebounds,     run->event->jumped};
  for (size_t i = 0; i < sizeof of_c / sizeof *of_c; i++) pl_keep_bools(k, of_c[i], c);
  for (int i = 0; i < run->n_q; i++) pl_keep_int(k, &run->dae.has_equation[i], 0, 1);
  pl_keep_int(k, &run->dae.n_active, 0, run->n_c);
  pl_keep_int(k, &run->dae.rank, 0, run->n_c);
  pl_keep_int(k, &run->dae.rank_mode, -1, run->n_c);
  pl_keep_bool(k, &run->dae.by_pivots);
  pl_keep_bool(k, &run->dae.watch_landings);
  pl_keep_int(k, &run->event->mode_changes, 0, LARGE_COUNT);
  pl_keep_f64(k, &run->event->mode_change_t);
}

static void keep_contacts(pl_run* run, pl_keeper* k) {
  size_t c = (size_t)run->n_c;
  pl_keep_section(k, "contacts");
  pl_keep_f64s(k, run->event->fastest, c);
  pl_keep_f64s(k, run->event->bounce_t, 3 * c);
  pl_keep_f64s(k, run->event->settled_t, c);
  for (size_t i = 0; i < c; i++) pl_keep_long(k, &run->event->bounces[i], 0, most_count);
  for (int e = 0; e < run->setup->n_events; e++) {
    pl_keep_f64(k, &run->event->repeat[e].t);
    pl_keep_f64(k, &run->event->repeat[e].gap);
    pl_keep_f64(k, &run->event->repeat[e].widest);
    pl_keep_long(k, &run->event->repeat[e].n, 0, most_count);
  }
  for (int i = 0; i < run->event->n_watch; i++) {
    pl_keep_int(k, &run->event->watch[i].fresh, 0, run->order);
    pl_keep_int(k, &run->event->watch[i].side, -1, 1);
  }
  for (int r = 0; r < run->setup->n_frictions; r++) {
    pl_friction_state* now = &run->dae.friction[r];
    int state = (int)now->state;
    pl_keep_int(k, &state, PL_FRICTION_OFF, PL_FRICTION_SLIP);
    now->state = (pl_friction_phase)state;
    pl_keep_int(k, &now->way, -1, 1);
    pl_keep_int(k, &now->press, -1, 1);
    pl_keep_bool(k, &now->given);
    pl_keep_f64s(k, now->d, 3);
    pl_keep_f64(k, &now->small);
  }
  pl_keep_int(k, &run->dae.n_slipping, 0, run->n_c);
}

// ----------------------------------------------------------------------------------- rows, figures
static void keep_rows(pl_run* run, pl_keeper* k) {
  pl_keep_section(k, "rows");
  pl_keep_long(k, &run->control.grid_n, 0, most_count);
  pl_keep_f64(k, &run->output->last_row_t);
  bool* flags[] = {&run->output->opened,  &run->output->begun,   &run->output->ended,
                   &run->control.started, &run->control.stopped, &run->output->refused};
  for (size_t i = 0; i < sizeof flags / sizeof *flags; i++) pl_keep_bool(k, flags[i]);
}

static void keep_attitudes(pl_run* run, pl_keeper* k) {
  pl_keep_section(k, "attitudes");
  for (int i = 0; i < run->setup->n_attitudes; i++) {
    pl_keep_f64(k, &run->dae.attitude[i].t);
    pl_keep_f64s(k, run->dae.attitude[i].angle, 3);
    pl_keep_f64s(k, run->dae.attitude[i].rate, 2);
  }
}

static void keep_stats(pl_run* run, pl_keeper* k) {
  pl_stats* s = &run->stats;
  pl_keep_section(k, "statistics");
  long* counts[] = {&s->steps, &s->rejections, &s->n_events, &s->steps_implicit,
                    &s->steps_interpreted};
  for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
    pl_keep_long(k, counts[i], 0, most_count);
  double* numbers[] = {&s->h_min,          &s->h_max,    &s->max_g,        &s->max_gdot,
                       &s->max_projection, &s->energy_0, &s->energy_drift, &s->t_singular,
                       &s->t_implicit,     &s->wall_s,   &s->compile_s};
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) pl_keep_f64(k, numbers[i]);
  pl_keep_int(k, &s->order, 0, run->order);
  pl_keep_int(k, &s->order_implicit, 0, LARGE_COUNT);
  pl_keep_int(k, &s->rank, 0, run->n_c);
  pl_keep_int(k, &s->rank_start, 0, run->n_c);
  pl_keep_bool(k, &s->compiled);
  pl_keep_bool(k, &s->stored);
}

// What the steppers keep, and which of them is at work.
static void keep_steppers(pl_run* run, pl_keeper* k, bool setup) {
  int at_work = 0;
  for (int i = 0; i < run->n_steppers; i++) {
    const pl_stepper* s = run->steppers[i];
    void (*save)(pl_run * run, pl_keeper * k) = setup ? s->save_setup : s->save_state;
    if (save) save(run, k);
    if (s == run->stepper) at_work = i;
  }
  if (setup) return;
  pl_keep_int(k, &at_work, 0, run->n_steppers - 1);
  run->stepper = run->steppers[at_work];
}

static void keep_state(pl_run* run, pl_keeper* k) {
  keep_point(run, k);
  keep_yardsticks(run, k);
  keep_mode(run, k);
  keep_contacts(run, k);
  keep_rows(run, k);
  keep_attitudes(run, k);
  keep_stats(run, k);
  keep_steppers(run, k, false);
}

// --------------------------------------------------------------------------------------- all of it
void pl_run_save(pl_run* run, pl_keeper* k) {
  keep_dimensions(run, k);
  keep_steppers(run, k, true);
  pl_keep_section(k, "pivots");
  pl_kkt_keep(&run->dae.kkt, k);
  keep_state(run, k);
  pl_keep_section(k, "lead");
  if (run->lead) run->lead->save(run->sensitivity, k);
}

// What a run that is whole cannot have, whatever its numbers.
static bool makes_sense(const pl_run* run) {
  double from = run->options.t_0, to = run->options.t_end;
  bool inside = run->dae.t >= fmin(from, to) && run->dae.t <= fmax(from, to);
  if (!(run->control.tol > 0 && run->control.tol < 1)) return false;
  if (!inside || !run->control.started || run->output->ended || run->output->refused) return false;
  return isfinite(run->dae.t_low) && isfinite(pl_norm(run->dae.q, run->n_q))
         && isfinite(pl_norm(run->dae.v, run->n_q));
}

// Order 0 of the series and the factor at the point, which must be the numbers that were kept.
static bool enter_again(pl_run* run) {
  size_t q = (size_t)run->n_q * sizeof(double), c = (size_t)run->n_c * sizeof(double);
  memcpy(run->event->save_a, run->dae.A, q);
  memcpy(run->event->save_l, run->dae.L, c);
  memcpy(run->event->on_before, run->dae.taken, (size_t)run->n_c * sizeof(bool));
  bool at_point = run->dae.at_point;
  if (!at_point) {
    pl_point_evaluate(&run->dae, run->dae.t_nodes, run->dae.q, run->dae.v);
    pl_active_set_choose(&run->dae);
    if (!pl_point_factor(&run->dae, true)) return false;
    run->dae.factored = true;
  }
  return run->stepper->enter(run) && run->dae.at_point == at_point
         && memcmp(run->event->save_a, run->dae.A, q) == 0
         && memcmp(run->event->save_l, run->dae.L, c) == 0
         && memcmp(run->event->on_before, run->dae.taken, (size_t)run->n_c * sizeof(bool)) == 0;
}

static pleuel_status unreadable(pl_run* run) {
  return pl_fail(run->job, PLEUEL_FILE, "the state that was kept is not one of this run");
}

pleuel_status pl_run_load(pl_run* run, pl_keeper* k, const pl_sink* sink) {
  keep_dimensions(run, k);
  if (k->wrong) return unreadable(run);
  keep_steppers(run, k, true);
  pl_keep_section(k, "pivots");
  pl_kkt_keep(&run->dae.kkt, k);
  size_t at = k->next;
  keep_state(run, k);
  if (k->wrong || !makes_sense(run)) return unreadable(run);
  if (!enter_again(run))
    return pl_fail(run->job, PLEUEL_FILE,
                   "accelerations at t = %.9g s come out with other last digits than those that "
                   "were kept: another processor or "
                   "another library",
                   run->dae.t);
  // entering moved yardsticks that had moved already
  k->next = at;
  keep_state(run, k);
  pl_keep_section(k, "lead");
  if (run->lead) PL_TRY(run->lead->load(run->sensitivity, k));
  if (k->wrong) return unreadable(run);
  run->options.sink = *sink;
  return sink->begin ? sink->begin(sink->user, run->setup) : PLEUEL_OK;
}
