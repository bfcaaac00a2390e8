// Rows and events on their way to the sink; observers; energy.
#include "solve/driver_impl.h"

#include <math.h>
#include <string.h>

const char* const pl_event_kind_name[] = {"event", "release", "impact", "contact", "singular",
                                          "stop",  "slack",   "taut",   "stick",   "slip"};

void pl_output_make(pl_run* run) {
  pl_arena* a = run->job->arena;
  const pl_setup* s = run->setup;
  pl_output_state* o = run->output = PL_NEW(a, pl_output_state);
  o->out_now = PL_ARRAY(a, double, s->n_out + 1);
  o->out_before = PL_ARRAY(a, double, s->n_out + 1);
  o->mode_size = sizeof "free";
  for (int c = 0; c < s->n_c; c++)
    o->mode_size += strlen(s->constraints[c].name) + sizeof " contact()";
  for (int r = 0; r < s->n_frictions; r++)
    o->mode_size += strlen(s->frictions[r].name) + sizeof " stick()";
  o->mode = PL_ARRAY(a, char, o->mode_size);
  o->mode_before = PL_ARRAY(a, char, o->mode_size);
  o->last_row_t = (double)NAN;
}

static void pl_output_observe(pl_run* run, double t, const double* q, const double* v,
                              const double* a, const double* lambda, double* out) {
  pl_batches* b = &run->observers;
  if (run->setup->n_out == 0) return;
  pl_attitude_seen(&run->dae, t, &q, &v, &a);
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
  int written = snprintf(out + n, run->output->mode_size - n, "%s%s(%s)", n ? " " : "", word, name);
  return written < 0 || (size_t)written >= run->output->mode_size - n ? n : n + (size_t)written;
}

void pl_output_mode(const pl_run* run, char* out) {
  size_t n = 0;
  out[0] = '\0';
  if (run->sensitivity)
    snprintf(out, run->output->mode_size, "%s", run->lead->mode(run->sensitivity));
  if (!has_modes(run)) return;
  for (int c = 0; c < run->n_c; c++) {
    const pl_constraint_setup* constraint = &run->setup->constraints[c];
    if (constraint->side != 0 && run->dae.active[c])
      n = add_mode(run, out, n, constraint->rope ? "taut" : "contact", constraint->name);
  }
  for (int r = 0; r < run->setup->n_frictions; r++) {
    if (run->dae.friction[r].state == PL_FRICTION_OFF) continue;
    n = add_mode(run, out, n, run->dae.friction[r].state == PL_FRICTION_STICK ? "stick" : "slip",
                 run->setup->frictions[r].name);
  }
  if (n == 0) snprintf(out, run->output->mode_size, "free");
}

// -------------------------------------------------------------------------------------------- rows
pl_row pl_output_row(pl_run* run, pl_row_kind kind, double* out, char* mode) {
  bool digits = run->stepper->row != NULL;
  if (!digits)
    pl_output_observe(run, run->dae.t, run->dae.q, run->dae.v, run->dae.A, run->dae.L, out);
  pl_output_mode(run, mode);
  pl_row row = {.t = run->dae.t,
                .q = run->dae.q,
                .v = run->dae.v,
                .a = run->dae.A,
                .lambda = run->dae.L,
                .unique = run->dae.unique,
                .out = out,
                .mode = mode,
                .kind = kind};
  pl_attitude_show(&run->dae, &row);
  if (digits) run->stepper->row(run, &row, out);
  return row;
}

static pleuel_status send(pl_run* run, const pl_row* row) {
  const pl_sink* s = &run->options.sink;
  run->output->last_row_t = row->kind == PL_ROW_BEFORE ? (double)NAN : row->t;
  pleuel_status how = s->row ? s->row(s->user, row) : PLEUEL_OK;
  run->output->refused |= how != PLEUEL_OK;
  return how;
}

pleuel_status pl_output_open(pl_run* run) {
  const pl_sink* s = &run->options.sink;
  if (run->output->opened) return PLEUEL_OK;
  run->output->opened = true;
  return s->begin ? s->begin(s->user, run->setup) : PLEUEL_OK;
}

pleuel_status pl_output_begin(pl_run* run) {
  if (run->output->begun) return PLEUEL_OK;
  run->output->begun = true;
  PL_TRY(pl_output_open(run));
  return pl_output_point(run, PL_ROW_START);
}

static double grid_slack(const pl_run* run) { return 1e-9 * fabs(run->control.grid_dt); }

// A point in the middle of the run is a row of its own without a grid, and with one when it lies on
// it.
static bool point_is_due(pl_run* run, pl_row_kind kind) {
  if (kind != PL_ROW_STEP || run->control.grid_dt == 0) return true;
  return fabs(pl_grid_time(run, run->control.grid_n) - run->dae.t) <= grid_slack(run);
}

pleuel_status pl_output_point(pl_run* run, pl_row_kind kind) {
  if (!point_is_due(run, kind) || (kind == PL_ROW_END && run->output->last_row_t == run->dae.t))
    return PLEUEL_OK;
  double direction = run->options.t_end < run->options.t_0 ? -1 : 1;
  while (run->control.grid_dt != 0 && kind != PL_ROW_BEFORE
         && direction * (pl_grid_time(run, run->control.grid_n) - run->dae.t) <= grid_slack(run)
         && (run->control.grid_count == 0 || run->control.grid_n <= run->control.grid_count))
    run->control.grid_n++;
  pl_row row = pl_output_row(run, kind, run->output->out_now, run->output->mode);
  return send(run, &row);
}

// A row between the ends of a step: at grid time n, or without a grid where n is -1.
static pleuel_status row_between(pl_run* run, double t, long n) {
  bool digits = run->stepper->row_between != NULL;
  if (!digits) {
    pl_attitude_follow(&run->dae, t);
    pl_series_at(&run->dae, t - run->dae.t_series, run->control.row_q, run->control.row_v);
    pl_series_lambda_at(&run->dae, t - run->dae.t_series, run->control.row_a, run->control.row_l);
    pl_output_observe(run, t, run->control.row_q, run->control.row_v, run->control.row_a,
                      run->control.row_l, run->output->out_now);
  }
  pl_output_mode(run, run->output->mode);
  pl_row row = {.t = t,
                .q = run->control.row_q,
                .v = run->control.row_v,
                .a = run->control.row_a,
                .lambda = run->control.row_l,
                .unique = run->dae.unique,
                .out = run->output->out_now,
                .mode = run->output->mode,
                .kind = PL_ROW_STEP};
  pl_attitude_show(&run->dae, &row);
  if (digits) run->stepper->row_between(run, t, n, &row, run->output->out_now);
  return send(run, &row);
}

// Without a grid every step is a row; long ones have rows between, so that a motion that few steps
// follow still shows its shape.
static pleuel_status rows_of_step(pl_run* run, double t_from, double t_to) {
  long n = (long)ceil((1 - 1e-9) * fabs(t_to - t_from) / run->control.row_gap);
  for (long i = 1; i < n; i++)
    PL_TRY(row_between(run, t_from + (t_to - t_from) * ((double)i / (double)n), -1));
  return PLEUEL_OK;
}

pleuel_status pl_output_grid(pl_run* run, double t_from, double t_to) {
  double direction = run->options.t_end < run->options.t_0 ? -1 : 1;
  if (run->control.grid_dt == 0) return rows_of_step(run, t_from, t_to);
  for (;; run->control.grid_n++) {
    double t = pl_grid_time(run, run->control.grid_n);
    if (run->control.grid_count > 0 && run->control.grid_n > run->control.grid_count)
      return PLEUEL_OK;
    if (direction * (t_to - t) <= grid_slack(run)) return PLEUEL_OK;
    if (direction * (t - t_from) < -grid_slack(run)) continue;
    PL_TRY(row_between(run, t, run->control.grid_n));
  }
}

// ------------------------------------------------------------------------------------------ events
void pl_output_before(pl_run* run) {
  size_t q = (size_t)run->n_q * sizeof(double), c = (size_t)run->n_c;
  memcpy(run->event->save_q, run->dae.q, q);
  memcpy(run->event->save_v, run->dae.v, q);
  memcpy(run->event->save_a, run->dae.A, q);
  memcpy(run->event->save_l, run->dae.L, c * sizeof(double));
  memcpy(run->event->save_unique, run->dae.unique, c * sizeof(bool));
  pl_output_observe(run, run->dae.t, run->dae.q, run->dae.v, run->dae.A, run->dae.L,
                    run->output->out_before);
  pl_output_mode(run, run->output->mode_before);
}

static pleuel_status pl_output_event(pl_run* run, pl_event_kind kind, int index, double impulse,
                                     bool at_start) {
  const pl_sink* s = &run->options.sink;
  bool of_event = kind == PL_EV_EVENT || kind == PL_EV_STOP;
  run->stats.n_events++;
  if (!s->event) return PLEUEL_OK;
  pl_event_record e = {.kind = kind, .index = index, .impulse = impulse, .at_start = at_start};
  for (int i = 0; i < run->n_q; i++)
    e.jump |= fabs(run->dae.v[i] - run->event->save_v[i]) > 1e-12 * run->dae.v_size;
  if (index >= 0)
    e.label = of_event ? run->setup->events[index].name : run->setup->constraints[index].name;
  e.before = (pl_row){.t = run->dae.t,
                      .q = run->event->save_q,
                      .v = run->event->save_v,
                      .a = run->event->save_a,
                      .lambda = run->event->save_l,
                      .unique = run->event->save_unique,
                      .out = run->output->out_before,
                      .mode = run->output->mode_before,
                      .kind = PL_ROW_BEFORE};
  pl_attitude_show(&run->dae, &e.before);
  e.after = pl_output_row(run, PL_ROW_AFTER, run->output->out_now, run->output->mode);
  pleuel_status how = s->event(s->user, &e);
  run->output->refused |= how != PLEUEL_OK;
  return how;
}

pleuel_status pl_output_event_beside(pl_run* run, pl_event_record e, double t, const double* a,
                                     const double* lambda) {
  const pl_sink* s = &run->options.sink;
  pl_output_observe(run, t, run->control.row_q, run->control.row_v, a, lambda,
                    run->output->out_now);
  pl_output_mode(run, run->output->mode);
  e.after = (pl_row){.t = t,
                     .q = run->control.row_q,
                     .v = run->control.row_v,
                     .a = a,
                     .lambda = lambda,
                     .unique = run->dae.unique,
                     .out = run->output->out_now,
                     .mode = run->output->mode,
                     .kind = PL_ROW_AFTER};
  pl_attitude_show(&run->dae, &e.after);
  e.before = e.after;
  pleuel_status how = s->event(s->user, &e);
  run->output->refused |= how != PLEUEL_OK;
  return how;
}

static pleuel_status pl_output_settled(pl_run* run, pl_event_kind kind, int index, double dt,
                                       long bounces) {
  const pl_sink* s = &run->options.sink;
  run->stats.n_events++;
  if (!s->event) return PLEUEL_OK;
  for (int i = 0; i < run->n_q; i++) {
    run->control.row_q[i] = run->dae.q[i] + dt * (run->dae.v[i] + 0.5 * dt * run->dae.A[i]);
    run->control.row_v[i] = run->dae.v[i] + dt * run->dae.A[i];
  }
  pl_event_record e = {.kind = kind,
                       .index = index,
                       .label = run->setup->constraints[index].name,
                       .bounces = bounces};
  return pl_output_event_beside(run, e, run->dae.t + dt, run->dae.A, run->dae.L);
}

// ------------------------------------------------------------------------------------------ energy
static double pl_output_conserved(const pl_run* run, const double* out) {
  const pl_setup* s = run->setup;
  return s->energy > 0 ? out[s->energy] : out[s->kinetic] + out[s->potential];
}

static double energy_of(pl_run* run, const double* q, const double* v) {
  pl_output_observe(run, run->dae.t, q, v, run->dae.A, run->dae.L, run->control.energy_out);
  return pl_output_conserved(run, run->control.energy_out);
}

static pl_energy energy_by_observers(pl_run* run) {
  pl_output_observe(run, run->dae.t, run->dae.q, run->dae.v, run->dae.A, run->dae.L,
                    run->control.energy_out);
  pl_energy e = {.kinetic = run->control.energy_out[run->setup->kinetic],
                 .potential = run->control.energy_out[run->setup->potential],
                 .total = pl_output_conserved(run, run->control.energy_out)};
  e.change = e.total - run->control.energy_base;
  return e;
}

void pl_output_energy(pl_run* run, bool anew) {
  const pl_setup* s = run->setup;
  const pl_stepper* m = run->stepper;
  pl_energy e;
  if (s->kinetic < 0 || s->potential < 0) return;
  if (m->energy == NULL || !m->energy(run, anew, &e)) e = energy_by_observers(run);
  run->control.energy_size = pl_larger(run->control.energy_size,
                                       fabs(e.kinetic) + fabs(e.potential));
  if (anew) {
    // an impact or an action has changed it: drift is counted from here
    run->control.energy_base = e.total;
    if (isnan(run->stats.energy_drift)) {
      run->stats.energy_0 = e.total;
      run->stats.energy_drift = 0;
    }
    return;
  }
  double drift = run->control.energy_size > 0 ? fabs(e.change) / run->control.energy_size : 0;
  if (!(drift <= run->stats.energy_drift)) run->stats.energy_drift = drift;
}

const pl_observer pl_output_observer = {.before = pl_output_before,
                                        .point = pl_output_point,
                                        .event = pl_output_event,
                                        .beside = pl_output_event_beside,
                                        .settled = pl_output_settled,
                                        .energy = pl_output_energy,
                                        .energy_of = energy_of};
