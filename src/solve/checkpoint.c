// The state of a run between two steps, written down and read back: a run that goes on from it
// takes the same steps, bit for bit, as one that was never interrupted.
//
// Everything that a later step looks at and that does not follow from the setup is named here,
// once, by functions that serve both ways (pl_keeper in base.h). What follows from the point alone
// (nodes, factor, order 0 of the series) is computed anew and must come out the same: that tells a
// machine or a library that rounds differently. Two things are kept although they could be
// computed: the memory of the compiled steps at the point, whose last digits depend on the way that
// led there, and the matrix from which the sparse solver took its pivot order.
//
// tools/check_state.py holds the structs of a run against this file: each member is kept below or
// stands in one of these lists.
//
// clang-format off
// not kept of pl_run, follows from setup and options: observer job setup options n_q n_c order tol_raised
//   motion observers watched branches has_W mass_of_velocity shrink h_plain h_least row_gap n_watch
//   at_friction switches n_switches mode_size grid_count grid_dt
// not kept of pl_run, follows from the point: Q V ready t_series rests
// not kept of pl_run, follows from how it was started: start_given
// not kept of pl_run, only when, never what: clock_begin t_begin considered wall_begin
// not kept of pl_run, lives within a step: impact_taken impact_factor rhs Q_last A_last G_series
//   W_series rows rank_work priority row_of row_taken taken_kept dep dep_tau dep_norm dep_jpvt
//   trial_q trial_v end_a end_by_program arrived save_q save_v save_a save_l save_unique impulse
//   jump_v jump_q poly root_work hit root touch undecided sunk friction_before impulsive C_series
//   S_series poly_2 on_before fixed friction_fixed approach second hold_q hold_v first_a decision
//   choice_kept n_decisions K_series out_now out_before row_q row_v row_a row_l energy_out mode
//   mode_before t_grid W_coef branch_value reach factored seen shown shown_before
// not kept of pl_run, lives within a moment: indeterminate
// not kept of pl_run, where the lead run waits it goes there again: stop impacts
// not kept of pl_run, of the start, which is found anew: start
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

#include "solve/stepper/stepper.h"

// ------------------------------------------------------------------------------------- whose state
// Counts go on from where they are, so there is room above.
static const long most_count = LONG_MAX / 8;
enum { LARGE_COUNT = 1 << 28 };

static void keep_fixed(pl_keeper* k, int x) { pl_keep_int(k, &x, x, x); }

// Dimensions: a state of another setup is not read as one of this.
static void keep_dimensions(pl_run* run, pl_keeper* k) {
  const pl_setup* s = run->setup;
  pl_keep_section(k, "dimensions");
  int of[] = {run->n_q,       run->n_c,        run->order,     s->n_out,
              s->n_frictions, s->n_attitudes,  s->n_events,    s->n_watched,
              run->n_watch,   run->n_switches, run->kkt.dense, run->sensitivity != NULL,
              run->n_steppers};
  for (size_t i = 0; i < sizeof of / sizeof *of; i++) keep_fixed(k, of[i]);
}

// --------------------------------------------------------------------------- the point, yardsticks
static void keep_point(pl_run* run, pl_keeper* k) {
  size_t q = (size_t)run->n_q, c = (size_t)run->n_c;
  pl_keep_section(k, "point");
  double* numbers[] = {&run->t,          &run->t_low,  &run->t_nodes, &run->tol,
                       &run->force_size, &run->t_last, &run->h_last};
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) pl_keep_f64(k, numbers[i]);
  double* of_q[] = {run->q, run->v, run->A};
  double* of_c[] = {run->L, run->g,      run->g_size,   run->argument,
                    run->r, run->r_size, run->row_most, run->second_size};
  for (size_t i = 0; i < sizeof of_q / sizeof *of_q; i++) pl_keep_f64s(k, of_q[i], q);
  for (size_t i = 0; i < sizeof of_c / sizeof *of_c; i++) pl_keep_f64s(k, of_c[i], c);
  pl_keep_bool(k, &run->at_point);
  pl_keep_int(k, &run->use, 1, run->order);
  pl_keep_int(k, &run->use_last, 1, run->order);
}

static void keep_yardsticks(pl_run* run, pl_keeper* k) {
  size_t q = (size_t)run->n_q, c = (size_t)run->n_c;
  pl_keep_section(k, "yardsticks");
  double* numbers[] = {
      &run->smallest,         &run->best,        &run->smallest_here,    &run->smallest_before,
      &run->t_before,         &run->fade[0].t,   &run->fade[0].smallest, &run->fade[1].t,
      &run->fade[1].smallest, &run->h_series,    &run->h_regular,        &run->q_size,
      &run->v_size,           &run->energy_size, &run->energy_base,      &run->a_rough};
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) pl_keep_f64(k, numbers[i]);
  double* of_q[] = {run->q_most, run->v_most, run->q_kept, run->v_kept, run->column};
  for (size_t i = 0; i < sizeof of_q / sizeof *of_q; i++) pl_keep_f64s(k, of_q[i], q);
  pl_keep_f64s(k, run->row_long, c);
  pl_keep_f64s(k, run->row_part, c);
  pl_keep_int(k, &run->tiny, 0, LARGE_COUNT);
}

// ---------------------------------------------------------------------------------------- the mode
static void keep_mode(pl_run* run, pl_keeper* k) {
  size_t c = (size_t)run->n_c;
  pl_keep_section(k, "mode");
  bool* of_c[] = {run->on,      run->detached, run->active,       run->taken,
                  run->unique,  run->several,  run->ever_several, run->slips,
                  run->near_by, run->met,      run->rebounds,     run->jumped};
  for (size_t i = 0; i < sizeof of_c / sizeof *of_c; i++) pl_keep_bools(k, of_c[i], c);
  for (int i = 0; i < run->n_q; i++) pl_keep_int(k, &run->has_equation[i], 0, 1);
  pl_keep_int(k, &run->n_active, 0, run->n_c);
  pl_keep_int(k, &run->rank, 0, run->n_c);
  pl_keep_int(k, &run->rank_mode, -1, run->n_c);
  pl_keep_bool(k, &run->by_pivots);
  pl_keep_bool(k, &run->watch_landings);
  pl_keep_int(k, &run->mode_changes, 0, LARGE_COUNT);
  pl_keep_f64(k, &run->mode_change_t);
}

static void keep_contacts(pl_run* run, pl_keeper* k) {
  size_t c = (size_t)run->n_c;
  pl_keep_section(k, "contacts");
  pl_keep_f64s(k, run->fastest, c);
  pl_keep_f64s(k, run->bounce_t, 3 * c);
  pl_keep_f64s(k, run->settled_t, c);
  for (size_t i = 0; i < c; i++) pl_keep_long(k, &run->bounces[i], 0, most_count);
  for (int e = 0; e < run->setup->n_events; e++) {
    pl_keep_f64(k, &run->repeat[e].t);
    pl_keep_f64(k, &run->repeat[e].gap);
    pl_keep_f64(k, &run->repeat[e].widest);
    pl_keep_long(k, &run->repeat[e].n, 0, most_count);
  }
  for (int i = 0; i < run->n_watch; i++) {
    pl_keep_int(k, &run->watch[i].fresh, 0, run->order);
    pl_keep_int(k, &run->watch[i].side, -1, 1);
  }
  for (int r = 0; r < run->setup->n_frictions; r++) {
    pl_friction_state* now = &run->friction[r];
    int state = (int)now->state;
    pl_keep_int(k, &state, PL_FRICTION_OFF, PL_FRICTION_SLIP);
    now->state = (pl_friction_phase)state;
    pl_keep_int(k, &now->way, -1, 1);
    pl_keep_int(k, &now->press, -1, 1);
    pl_keep_bool(k, &now->given);
    pl_keep_f64s(k, now->d, 3);
    pl_keep_f64(k, &now->small);
  }
  pl_keep_int(k, &run->n_slipping, 0, run->n_c);
}

// ------------------------------------------------------------------------------ rows, what is told
static void keep_rows(pl_run* run, pl_keeper* k) {
  pl_keep_section(k, "rows");
  pl_keep_long(k, &run->grid_n, 0, most_count);
  pl_keep_f64(k, &run->last_row_t);
  bool* flags[] = {&run->opened,  &run->begun,   &run->ended,
                   &run->started, &run->stopped, &run->refused};
  for (size_t i = 0; i < sizeof flags / sizeof *flags; i++) pl_keep_bool(k, flags[i]);
}

static void keep_attitudes(pl_run* run, pl_keeper* k) {
  pl_keep_section(k, "attitudes");
  for (int i = 0; i < run->setup->n_attitudes; i++) {
    pl_keep_f64(k, &run->attitude[i].t);
    pl_keep_f64s(k, run->attitude[i].angle, 3);
    pl_keep_f64s(k, run->attitude[i].rate, 2);
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
  pl_kkt_keep(&run->kkt, k);
  keep_state(run, k);
  pl_keep_section(k, "lead");
  if (run->sensitivity) pl_sensitivity_write(run->sensitivity, k);
}

// What a run that is whole cannot have, whatever its numbers.
static bool makes_sense(const pl_run* run) {
  double from = run->options.t_0, to = run->options.t_end;
  bool inside = run->t >= fmin(from, to) && run->t <= fmax(from, to);
  if (!(run->tol > 0 && run->tol < 1)) return false;
  if (!inside || !run->started || run->ended || run->refused) return false;
  return isfinite(run->t_low) && isfinite(pl_norm(run->q, run->n_q))
         && isfinite(pl_norm(run->v, run->n_q));
}

// Order 0 of the series and the factor at the point, which must be the numbers that were kept.
static bool enter_again(pl_run* run) {
  size_t q = (size_t)run->n_q * sizeof(double), c = (size_t)run->n_c * sizeof(double);
  memcpy(run->save_a, run->A, q);
  memcpy(run->save_l, run->L, c);
  memcpy(run->on_before, run->taken, (size_t)run->n_c * sizeof(bool));
  bool at_point = run->at_point;
  if (!at_point) {
    pl_point_evaluate(run, run->t_nodes, run->q, run->v);
    pl_active_set_choose(run);
    if (!pl_point_factor(run, true)) return false;
    run->factored = true;
  }
  return run->stepper->enter(run) && run->at_point == at_point
         && memcmp(run->save_a, run->A, q) == 0 && memcmp(run->save_l, run->L, c) == 0
         && memcmp(run->on_before, run->taken, (size_t)run->n_c * sizeof(bool)) == 0;
}

static pleuel_status unreadable(pl_run* run) {
  return pl_fail(run->job, PLEUEL_FILE, "the state that was kept is not one of this run");
}

pleuel_status pl_run_load(pl_run* run, pl_keeper* k, const pl_sink* sink) {
  keep_dimensions(run, k);
  if (k->wrong) return unreadable(run);
  keep_steppers(run, k, true);
  pl_keep_section(k, "pivots");
  pl_kkt_keep(&run->kkt, k);
  size_t at = k->next;
  keep_state(run, k);
  if (k->wrong || !makes_sense(run)) return unreadable(run);
  if (!enter_again(run))
    return pl_fail(run->job, PLEUEL_FILE,
                   "accelerations at t = %.9g s come out with other last digits than those that "
                   "were kept: another processor or "
                   "another library",
                   run->t);
  // entering moved yardsticks that had moved already
  k->next = at;
  keep_state(run, k);
  run->considered = 0;
  pl_keep_section(k, "lead");
  if (run->sensitivity) PL_TRY(pl_sensitivity_read(run->sensitivity, k));
  if (k->wrong) return unreadable(run);
  run->options.sink = *sink;
  return sink->begin ? sink->begin(sink->user, run->setup) : PLEUEL_OK;
}
