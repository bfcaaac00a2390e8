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
// not kept of pl_run, follows from setup and options: job setup options n_q n_c order tol_raised
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
// not kept of pl_step_program, follows from the mode: code next size orders n_q n_c n_mass n_taken time
//   ratio rest Q V A L q_floor v_floor g g_size argument r r_size norms length end_q end_v end_a
//   off energy h pivot pivot_size move vector result matrix identity of_constraint index
//   inverse_up_to constants scales
// not kept of pl_step_program, of this process: compiled jit tried
// not kept of pl_radau, follows from setup and options: method n n_q n_c n_C tol tol_stage ready
//   fits shape friction_of
// not kept of pl_radau, lives within a step: lanes here at coupled coupled_scale coupled_rhs
//   coupled_work coupled_pivot real real_scale work pair pair_scale pivot sparse sparse_pair Z Q V
//   A L t F w error_q error_v rhs sc_q sc_v coefficient part watched watched_h bent first_g last_g
//   last_size end_a end_l save_a save_l
// not kept of pl_extended, follows from setup, options and mode: state fine by_doubles low top head
//   head_forces clock left grid drift t_0 q_0 v_0 a_0 l_0 end_a end_l tail_q tail_v tail_a tail_l
//   from to share way scratch energy_base rows watched floor held high next
// not kept of pl_extended, pl_step_program, lives within a step: digits arrived
// clang-format on
#include <limits.h>
#include <math.h>
#include <string.h>

#include "solve/stepper/taylor/step_program_impl.h"
#include "solve/stepper/radau/radau_impl.h"
#include "solve/stepper/taylor/extended_impl.h"

// ------------------------------------------------------------------------------------- whose state
// Counts go on from where they are, so there is room above.
static const long most_count = LONG_MAX / 8;
enum { LARGE_COUNT = 1 << 28 };

static void keep_fixed(pl_keeper* k, int x) { pl_keep_int(k, &x, x, x); }

// Dimensions: a state of another setup is not read as one of this.
static void keep_dimensions(pl_run* run, pl_keeper* k) {
  const pl_setup* s = run->setup;
  pl_keep_section(k, "dimensions");
  int of[] = {run->n_q,           run->n_c,
              run->order,         s->n_out,
              s->n_frictions,     s->n_attitudes,
              s->n_events,        s->n_watched,
              run->n_watch,       run->n_switches,
              run->kkt.dense,     run->sensitivity != NULL,
              run->radau != NULL, run->radau ? run->radau->method.s : 0};
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
  pl_keep_int(k, &s->order_implicit, 0, 2 * PL_RADAU_MOST);
  pl_keep_int(k, &s->rank, 0, run->n_c);
  pl_keep_int(k, &s->rank_start, 0, run->n_c);
  pl_keep_bool(k, &s->compiled);
  pl_keep_bool(k, &s->stored);
}

// ----------------------------------------------------------------------------- the implicit method
static void keep_radau(pl_run* run, pl_keeper* k) {
  pl_radau* r = run->radau;
  pl_keep_section(k, "implicit");
  pl_keep_bool(k, &run->implicit);
  if (r == NULL) {
    if (run->implicit) pl_keep_fail(k);
    return;
  }
  // the next step is predicted from the polynomial of the last one, and a look at stiffness reads
  // it too
  size_t rows = (size_t)run->order + 2;
  pl_keep_f64s(k, run->V_last, rows * (size_t)run->n_q);
  pl_keep_f64s(k, run->L_last, rows * (size_t)run->n_c);
  double* numbers[] = {&r->h_factored, &r->rounding, &r->h,           &r->h_last,
                       &r->error_last, &r->theta,    &r->cost_series, &r->h_dense};
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) pl_keep_f64(k, numbers[i]);
  bool* flags[] = {&r->couples, &r->has_jacobian, &r->has_factor, &r->has_last, &r->rejected};
  for (size_t i = 0; i < sizeof flags / sizeof *flags; i++) pl_keep_bool(k, flags[i]);
  long* counts[] = {&r->stay_next, &r->steps_in_row, &r->looks, &r->next_look};
  for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
    pl_keep_long(k, counts[i], 0, most_count);
  pl_keep_long(k, &r->stay, -1, most_count);
  pl_keep_int(k, &r->newton, 0, LARGE_COUNT);
  pl_keep_int(k, &r->newton_last, 0, LARGE_COUNT);
  pl_keep_int(k, &r->dear, 0, LARGE_COUNT);
}

// ----------------------------------------------------------------------------------- extended numbers
// Their memory holds the state, the time and the nodes at the point.
static void keep_extended(pl_run* run, pl_keeper* k) {
  pl_keep_section(k, "extended");
  if (k->reads && !k->wrong && run->extended && !pl_extended_of_mode(run)) pl_keep_fail(k);
  pl_extended* w = run->extended;
  keep_fixed(k, w ? w->o->size : 0);
  if (w == NULL) return;
  pl_keep_bytes(k, w->m, (size_t)w->o->size * w->fine->size);
  pl_keep_f64s(k, w->o->size_most, (size_t)w->o->n);
  pl_keep_f64(k, &w->o->fade_best);
  pl_keep_f64(k, &w->part);
}

static void keep_state(pl_run* run, pl_keeper* k) {
  keep_point(run, k);
  keep_yardsticks(run, k);
  keep_mode(run, k);
  keep_contacts(run, k);
  keep_rows(run, k);
  keep_attitudes(run, k);
  keep_stats(run, k);
  keep_radau(run, k);
  keep_extended(run, k);
}

// ---------------------------------------------------------------------------------- compiled steps
static bool same_program(const pl_run* run, const pl_step_program* o, const bool* taken,
                         const bool* moves) {
  if (memcmp(o->taken, taken, (size_t)run->n_c * sizeof(bool)) != 0) return false;
  for (int i = 0; i < run->n_q && o->of_coordinate; i++)
    if ((o->of_coordinate[i] >= 0) != moves[i]) return false;
  return true;
}

// Codes for a mode, as pl_step_program_make makes them where it begins; those that the start made already
// are taken over.
static pl_step_program* program_for(pl_run* run, pl_step_program* made, const bool* taken,
                                    const bool* moves) {
  for (pl_step_program* o = made; o; o = o->next)
    if (same_program(run, o, taken, moves)) return o;
  memcpy(run->taken, taken, (size_t)run->n_c * sizeof(bool));
  for (int i = 0; i < run->n_q; i++) run->has_equation[i] = moves[i];
  pl_step_program* o = pl_step_program_make(run);
  return same_program(run, o, taken, moves) ? o : NULL;
}

static void keep_program(pl_run* run, pl_keeper* k, pl_step_program* o, bool here) {
  keep_fixed(k, o->usable);
  if (!o->usable) return;
  keep_fixed(k, o->n);
  keep_fixed(k, o->size);
  pl_keep_f64s(k, o->size_most, (size_t)o->n);
  pl_keep_f64(k, &o->fade_best);
  if (here) pl_keep_bytes(k, o->m, (size_t)o->size * sizeof *o->m);
}

static int count_programs(const pl_run* run) {
  int n = 0;
  for (const pl_step_program* o = run->programs; o; o = o->next) n++;
  return n;
}

static void write_programs(pl_run* run, pl_keeper* k) {
  int n = count_programs(run);
  pl_keep_count(k, &n, 1);
  for (pl_step_program* o = run->programs; o; o = o->next) {
    bool at_work = o == run->program, here = at_work && run->at_point;
    pl_keep_bool(k, &at_work);
    pl_keep_bool(k, &here);
    pl_keep_bools(k, o->taken, (size_t)run->n_c);
    for (int i = 0; i < run->n_q; i++) {
      bool moves = o->of_coordinate && o->of_coordinate[i] >= 0;
      pl_keep_bool(k, &moves);
    }
    keep_program(run, k, o, here);
  }
}

static void read_programs(pl_run* run, pl_keeper* k) {
  pl_step_program *made = run->programs, **last = &run->programs;
  bool *taken = PL_ARRAY(run->job->arena, bool, run->n_c + 1),
       *moves = PL_ARRAY(run->job->arena, bool, run->n_q + 1);
  int n = 0;
  pl_keep_count(k, &n, (size_t)run->n_c + (size_t)run->n_q + 2);
  run->programs = run->program = NULL;
  for (int i = 0; i < n; i++) {
    bool at_work = false, here = false;
    pl_keep_bool(k, &at_work);
    pl_keep_bool(k, &here);
    pl_keep_bools(k, taken, (size_t)run->n_c);
    pl_keep_bools(k, moves, (size_t)run->n_q);
    if (k->wrong) break;
    pl_step_program* o = program_for(run, made, taken, moves);
    if (o == NULL || (here && !o->usable)) {
      pl_keep_fail(k);
      break;
    }
    // one that was made at the start leaves that list
    for (pl_step_program** at = &made; *at; at = &(*at)->next)
      if (*at == o) {
        *at = o->next;
        break;
      }
    o->next = NULL;
    *last = o;
    last = &o->next;
    keep_program(run, k, o, here);
    if (at_work) run->program = o;
  }
  *last = made;  // so that they are freed with the others; a mode that comes later finds them
}

static void keep_programs(pl_run* run, pl_keeper* k) {
  pl_keep_section(k, "programs");
  if (k->reads) read_programs(run, k);
  else write_programs(run, k);
}

// --------------------------------------------------------------------------------------- all of it
void pl_run_save(pl_run* run, pl_keeper* k) {
  keep_dimensions(run, k);
  keep_programs(run, k);
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
  if (run->at_point && !(run->extended && !run->extended->by_doubles)
      && !(run->program && run->program->usable))
    return false;
  if (run->radau && !(run->radau->h >= 0 && isfinite(run->radau->h))) return false;
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
  return pl_point_enter(run) && run->at_point == at_point && memcmp(run->save_a, run->A, q) == 0
         && memcmp(run->save_l, run->L, c) == 0
         && memcmp(run->on_before, run->taken, (size_t)run->n_c * sizeof(bool)) == 0;
}

static pleuel_status unreadable(pl_run* run) {
  return pl_fail(run->job, PLEUEL_FILE, "the state that was kept is not one of this run");
}

pleuel_status pl_run_load(pl_run* run, pl_keeper* k, const pl_sink* sink) {
  keep_dimensions(run, k);
  if (k->wrong) return unreadable(run);
  keep_programs(run, k);
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
