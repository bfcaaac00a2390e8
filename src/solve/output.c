// Rows and events on their way to the sink; observers; energy.
#include "solve/stepper/stepper.h"

#include <math.h>
#include <string.h>

const char* const pl_event_kind_name[] = {"event", "release", "impact", "contact", "singular",
                                          "stop",  "slack",   "taut",   "stick",   "slip"};

void pl_output_observe(pl_run* run, double t, const double* q, const double* v, const double* a,
                       const double* lambda, double* out) {
  pl_batches* b = &run->observers;
  if (run->setup->n_out == 0) return;
  pl_attitude_seen(run, t, &q, &v, &a);
  pl_batches_time(b, t);
  pl_batches_load_q(b, q, 0);
  pl_batches_load_v(b, v, 0);
  pl_batches_load_a(b, a, 0);
  pl_batches_load_lambda(b, lambda, 0);
  for (int level = PL_LEVEL_POSITION; level < PL_N_LEVELS; level++)
    pl_batches_sweep(b, (pl_tape_level)level, 0, true);
  pl_batches_outputs(b, out, run->setup->n_out, 0);
}

// ------------------------------------------------------------------------------------ mode as text
static bool has_modes(const pl_run* run) {
  for (int c = 0; c < run->n_c; c++)
    if (run->setup->constraints[c].side != 0) return true;
  return run->setup->n_frictions > 0;
}

// Adds "word(name)" at out[n]; mode_size holds all of them.  Returns the new length.
static size_t add_mode(const pl_run* run, char* out, size_t n, const char* word, const char* name) {
  int written = snprintf(out + n, run->mode_size - n, "%s%s(%s)", n ? " " : "", word, name);
  return written < 0 || (size_t)written >= run->mode_size - n ? n : n + (size_t)written;
}

void pl_output_mode(const pl_run* run, char* out) {
  size_t n = 0;
  out[0] = '\0';
  if (run->sensitivity) snprintf(out, run->mode_size, "%s", pl_sensitivity_mode(run->sensitivity));
  if (!has_modes(run)) return;
  for (int c = 0; c < run->n_c; c++) {
    const pl_constraint_setup* constraint = &run->setup->constraints[c];
    if (constraint->side != 0 && run->active[c])
      n = add_mode(run, out, n, constraint->rope ? "taut" : "contact", constraint->name);
  }
  for (int r = 0; r < run->setup->n_frictions; r++) {
    if (run->friction[r].state == PL_FRICTION_OFF) continue;
    n = add_mode(run, out, n, run->friction[r].state == PL_FRICTION_STICK ? "stick" : "slip",
                 run->setup->frictions[r].name);
  }
  if (n == 0) snprintf(out, run->mode_size, "free");
}

// -------------------------------------------------------------------------------------------- rows
pl_row pl_output_row(pl_run* run, pl_row_kind kind, double* out, char* mode) {
  bool digits = run->stepper->row != NULL;
  if (!digits) pl_output_observe(run, run->t, run->q, run->v, run->A, run->L, out);
  pl_output_mode(run, mode);
  pl_row row = {.t = run->t,
                .q = run->q,
                .v = run->v,
                .a = run->A,
                .lambda = run->L,
                .unique = run->unique,
                .out = out,
                .mode = mode,
                .kind = kind};
  pl_attitude_show(run, &row);
  if (digits) run->stepper->row(run, &row, out);
  return row;
}

static pleuel_status send(pl_run* run, const pl_row* row) {
  const pl_sink* s = &run->options.sink;
  run->last_row_t = row->kind == PL_ROW_BEFORE ? (double)NAN : row->t;
  pleuel_status how = s->row ? s->row(s->user, row) : PLEUEL_OK;
  run->refused |= how != PLEUEL_OK;
  return how;
}

pleuel_status pl_output_open(pl_run* run) {
  const pl_sink* s = &run->options.sink;
  if (run->opened) return PLEUEL_OK;
  run->opened = true;
  return s->begin ? s->begin(s->user, run->setup) : PLEUEL_OK;
}

pleuel_status pl_output_begin(pl_run* run) {
  if (run->begun) return PLEUEL_OK;
  run->begun = true;
  PL_TRY(pl_output_open(run));
  return pl_output_point(run, PL_ROW_START);
}

static double grid_time(const pl_run* run, long n) {
  if (run->grid_times) return n <= run->grid_count ? run->grid_times[n] : (double)INFINITY;
  // the last one exactly at the end, the others by one multiplication, so that nothing accumulates
  if (run->grid_count > 0 && n == run->grid_count) return run->options.t_end;
  return run->options.t_0 + (double)n * run->grid_dt;
}

static double grid_slack(const pl_run* run) { return 1e-9 * fabs(run->grid_dt); }

// A point in the middle of the run is a row of its own without a grid, and with one when it lies on
// it.
static bool point_is_due(pl_run* run, pl_row_kind kind) {
  if (kind != PL_ROW_STEP || run->grid_dt == 0) return true;
  return fabs(grid_time(run, run->grid_n) - run->t) <= grid_slack(run);
}

pleuel_status pl_output_point(pl_run* run, pl_row_kind kind) {
  if (!point_is_due(run, kind) || (kind == PL_ROW_END && run->last_row_t == run->t))
    return PLEUEL_OK;
  double direction = run->options.t_end < run->options.t_0 ? -1 : 1;
  while (run->grid_dt != 0 && kind != PL_ROW_BEFORE
         && direction * (grid_time(run, run->grid_n) - run->t) <= grid_slack(run)
         && (run->grid_count == 0 || run->grid_n <= run->grid_count))
    run->grid_n++;
  pl_row row = pl_output_row(run, kind, run->out_now, run->mode);
  return send(run, &row);
}

// A row between the ends of a step: at grid time n, or without a grid where n is -1.
static pleuel_status row_between(pl_run* run, double t, long n) {
  bool digits = run->stepper->row_between != NULL;
  if (!digits) {
    pl_attitude_follow(run, t);
    pl_series_at(run, t - run->t_series, run->row_q, run->row_v);
    pl_series_lambda_at(run, t - run->t_series, run->row_a, run->row_l);
    pl_output_observe(run, t, run->row_q, run->row_v, run->row_a, run->row_l, run->out_now);
  }
  pl_output_mode(run, run->mode);
  pl_row row = {.t = t,
                .q = run->row_q,
                .v = run->row_v,
                .a = run->row_a,
                .lambda = run->row_l,
                .unique = run->unique,
                .out = run->out_now,
                .mode = run->mode,
                .kind = PL_ROW_STEP};
  pl_attitude_show(run, &row);
  if (digits) run->stepper->row_between(run, t, n, &row, run->out_now);
  return send(run, &row);
}

// Without a grid every step is a row; long ones have rows between, so that a motion that few steps
// follow still shows its shape.
static pleuel_status rows_of_step(pl_run* run, double t_from, double t_to) {
  long n = (long)ceil((1 - 1e-9) * fabs(t_to - t_from) / run->row_gap);
  for (long i = 1; i < n; i++)
    PL_TRY(row_between(run, t_from + (t_to - t_from) * ((double)i / (double)n), -1));
  return PLEUEL_OK;
}

pleuel_status pl_output_grid(pl_run* run, double t_from, double t_to) {
  double direction = run->options.t_end < run->options.t_0 ? -1 : 1;
  if (run->grid_dt == 0) return rows_of_step(run, t_from, t_to);
  for (;; run->grid_n++) {
    double t = grid_time(run, run->grid_n);
    if (run->grid_count > 0 && run->grid_n > run->grid_count) return PLEUEL_OK;
    if (direction * (t_to - t) <= grid_slack(run)) return PLEUEL_OK;
    if (direction * (t - t_from) < -grid_slack(run)) continue;
    PL_TRY(row_between(run, t, run->grid_n));
  }
}

// ------------------------------------------------------------------------------------------ events
void pl_output_before(pl_run* run) {
  size_t q = (size_t)run->n_q * sizeof(double), c = (size_t)run->n_c;
  memcpy(run->save_q, run->q, q);
  memcpy(run->save_v, run->v, q);
  memcpy(run->save_a, run->A, q);
  memcpy(run->save_l, run->L, c * sizeof(double));
  memcpy(run->save_unique, run->unique, c * sizeof(bool));
  pl_output_observe(run, run->t, run->q, run->v, run->A, run->L, run->out_before);
  pl_output_mode(run, run->mode_before);
}

pleuel_status pl_output_event(pl_run* run, pl_event_kind kind, int index, double impulse,
                              bool at_start) {
  const pl_sink* s = &run->options.sink;
  bool of_event = kind == PL_EV_EVENT || kind == PL_EV_STOP;
  run->stats.n_events++;
  if (!s->event) return PLEUEL_OK;
  pl_event_record e = {.kind = kind, .index = index, .impulse = impulse, .at_start = at_start};
  for (int i = 0; i < run->n_q; i++)
    e.jump |= fabs(run->v[i] - run->save_v[i]) > 1e-12 * run->v_size;
  if (index >= 0)
    e.label = of_event ? run->setup->events[index].name : run->setup->constraints[index].name;
  e.before = (pl_row){.t = run->t,
                      .q = run->save_q,
                      .v = run->save_v,
                      .a = run->save_a,
                      .lambda = run->save_l,
                      .unique = run->save_unique,
                      .out = run->out_before,
                      .mode = run->mode_before,
                      .kind = PL_ROW_BEFORE};
  pl_attitude_show(run, &e.before);
  e.after = pl_output_row(run, PL_ROW_AFTER, run->out_now, run->mode);
  pleuel_status how = s->event(s->user, &e);
  run->refused |= how != PLEUEL_OK;
  return how;
}

pleuel_status pl_output_event_beside(pl_run* run, pl_event_record e, double t, const double* a,
                                     const double* lambda) {
  const pl_sink* s = &run->options.sink;
  pl_output_observe(run, t, run->row_q, run->row_v, a, lambda, run->out_now);
  pl_output_mode(run, run->mode);
  e.after = (pl_row){.t = t,
                     .q = run->row_q,
                     .v = run->row_v,
                     .a = a,
                     .lambda = lambda,
                     .unique = run->unique,
                     .out = run->out_now,
                     .mode = run->mode,
                     .kind = PL_ROW_AFTER};
  pl_attitude_show(run, &e.after);
  e.before = e.after;
  pleuel_status how = s->event(s->user, &e);
  run->refused |= how != PLEUEL_OK;
  return how;
}

pleuel_status pl_output_settled(pl_run* run, pl_event_kind kind, int index, double dt,
                                long bounces) {
  const pl_sink* s = &run->options.sink;
  run->stats.n_events++;
  if (!s->event) return PLEUEL_OK;
  for (int i = 0; i < run->n_q; i++) {
    run->row_q[i] = run->q[i] + dt * (run->v[i] + 0.5 * dt * run->A[i]);
    run->row_v[i] = run->v[i] + dt * run->A[i];
  }
  pl_event_record e = {.kind = kind,
                       .index = index,
                       .label = run->setup->constraints[index].name,
                       .bounces = bounces};
  return pl_output_event_beside(run, e, run->t + dt, run->A, run->L);
}

// ------------------------------------------------------------------------------------------ energy
double pl_output_conserved(const pl_run* run, const double* out) {
  const pl_setup* s = run->setup;
  return s->energy > 0 ? out[s->energy] : out[s->kinetic] + out[s->potential];
}

static double energy_of(pl_run* run, const double* q, const double* v) {
  pl_output_observe(run, run->t, q, v, run->A, run->L, run->energy_out);
  return pl_output_conserved(run, run->energy_out);
}

static pl_energy energy_by_observers(pl_run* run) {
  pl_output_observe(run, run->t, run->q, run->v, run->A, run->L, run->energy_out);
  pl_energy e = {.kinetic = run->energy_out[run->setup->kinetic],
                 .potential = run->energy_out[run->setup->potential],
                 .total = pl_output_conserved(run, run->energy_out)};
  e.change = e.total - run->energy_base;
  return e;
}

void pl_output_energy(pl_run* run, bool anew) {
  const pl_setup* s = run->setup;
  const pl_stepper* m = run->stepper;
  pl_energy e;
  if (s->kinetic < 0 || s->potential < 0) return;
  if (m->energy == NULL || !m->energy(run, anew, &e)) e = energy_by_observers(run);
  run->energy_size = pl_larger(run->energy_size, fabs(e.kinetic) + fabs(e.potential));
  if (anew) {
    // an impact or an action has changed it: drift is counted from here
    run->energy_base = e.total;
    if (isnan(run->stats.energy_drift)) {
      run->stats.energy_0 = e.total;
      run->stats.energy_drift = 0;
    }
    return;
  }
  double drift = run->energy_size > 0 ? fabs(e.change) / run->energy_size : 0;
  if (!(drift <= run->stats.energy_drift)) run->stats.energy_drift = drift;
}

const pl_observer pl_output_observer = {.before = pl_output_before,
                                        .point = pl_output_point,
                                        .event = pl_output_event,
                                        .beside = pl_output_event_beside,
                                        .settled = pl_output_settled,
                                        .energy = pl_output_energy,
                                        .energy_of = energy_of};
