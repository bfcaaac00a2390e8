// A run as a program steps it: to a time and not beyond, with rows at times of its own.
#include "solve/driver_impl.h"

#include <math.h>
#include <string.h>

static bool is_behind(const pl_run* run, double t, double than) {
  return run->options.t_end < run->options.t_0 ? t < than : t > than;
}

static pleuel_status steps_to(pl_run* run, bool to_event) {
  long events = run->stats.n_events;
  while (!pl_run_done(run)) {
    PL_TRY(pl_run_step(run));
    if (to_event && run->stats.n_events > events) break;
  }
  return PLEUEL_OK;
}

pleuel_status pl_run_to(pl_run* run, double t, bool to_event) {
  if (!run->control.started) PL_TRY(pl_run_start(run));
  if (run->sensitivity)
    return pl_fail(
        run->job, PLEUEL_UNSUPPORTED,
        "a motion with sensitivities and contacts or events is computed as a whole only");
  if (isnan(t)) return pl_fail(run->job, PLEUEL_USAGE, "the time to advance to is not a number");
  if (is_behind(run, run->dae.t, t))
    return pl_fail(run->job, PLEUEL_USAGE, "the motion is at t = %.9g s already, behind %.9g s",
                   run->dae.t, t);
  PL_TRY(pl_output_begin(run));
  if (is_behind(run, run->options.t_end, t)) run->control.stop = (pl_stop){true, t, 0};
  pleuel_status s = steps_to(run, to_event);
  run->control.stop.early = false;
  return s;
}

void pl_run_rows_at(pl_run* run, const double* t, int n) {
  double way = n > 1 ? fabs(t[n - 1] - t[0]) / (n - 1) : 0;
  run->control.grid_times = t;
  run->control.grid_n = 0;
  run->control.grid_count = n - 1;
  run->control.grid_dt = way > 0 ? way : 1;
}

void pl_run_row(pl_run* run, pl_row* row) {
  *row = pl_output_row(run, PL_ROW_STEP, run->output->out_now, run->output->mode);
}

bool pl_run_dense_row(pl_run* run, double t, double* q, double* v, double* a, double* lambda) {
  double dt = t - run->control.t_last, slack = 1e-9 * fabs(run->control.h_last);
  bool inside = run->control.h_last != 0
                && dt * run->control.h_last >= -slack * fabs(run->control.h_last)
                && fabs(dt) <= fabs(run->control.h_last) + slack;
  if (!inside || run->stepper->row || run->setup->n_attitudes > 0) return false;
  pl_run_dense(run, t, q, v, lambda);
  if (a) pl_horner(run->dae.A_last, run->n_q, run->control.use_last - 1, dt, a);
  return true;
}

pleuel_status pl_run_point_as(pl_run* run, const pl_run* as, double t, const double* q,
                              const double* v) {
  size_t n = (size_t)run->n_q * sizeof(double), c = (size_t)run->n_c * sizeof(bool);
  memcpy(run->dae.q, q, n);
  memcpy(run->dae.v, v, n);
  memcpy(run->dae.on, as->dae.on, c);
  memcpy(run->dae.detached, as->dae.detached, c);
  for (int i = 0; i < run->setup->n_frictions; i++) run->dae.friction[i] = as->dae.friction[i];
  run->dae.t = t;
  run->dae.t_low = 0;
  run->dae.factored = false;
  pl_sizes_note(&run->dae, q, v);
  pl_sizes_keep(&run->dae);
  return pl_modes_enter(run);
}
