// A run as a program steps it: to a time and not beyond, with rows at times of its own.
#include <math.h>

#include "solve/solve_impl.h"

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
  if (!run->started) PL_TRY(pl_run_start(run));
  if (run->sensitivity)
    return pl_fail(
        run->job, PLEUEL_UNSUPPORTED,
        "a motion with sensitivities and contacts or events is computed as a whole only");
  if (isnan(t)) return pl_fail(run->job, PLEUEL_USAGE, "the time to advance to is not a number");
  if (is_behind(run, run->t, t))
    return pl_fail(run->job, PLEUEL_USAGE, "the motion is at t = %.9g s already, behind %.9g s",
                   run->t, t);
  PL_TRY(pl_output_begin(run));
  if (is_behind(run, run->options.t_end, t)) run->stop = (pl_stop){true, t, 0};
  pleuel_status s = steps_to(run, to_event);
  run->stop.early = false;
  return s;
}

void pl_run_rows_at(pl_run* run, const double* t, int n) {
  double way = n > 1 ? fabs(t[n - 1] - t[0]) / (n - 1) : 0;
  run->grid_times = t;
  run->grid_n = 0;
  run->grid_count = n - 1;
  run->grid_dt = way > 0 ? way : 1;
}

void pl_run_row(pl_run* run, pl_row* row) {
  *row = pl_output_row(run, PL_ROW_STEP, run->out_now, run->mode);
}

bool pl_run_dense_row(pl_run* run, double t, double* q, double* v, double* a, double* lambda) {
  double dt = t - run->t_last, slack = 1e-9 * fabs(run->h_last);
  bool inside = run->h_last != 0 && dt * run->h_last >= -slack * fabs(run->h_last)
                && fabs(dt) <= fabs(run->h_last) + slack;
  if (!inside || run->extended || run->setup->n_attitudes > 0) return false;
  pl_run_dense(run, t, q, v, lambda);
  if (a) pl_horner(run->A_last, run->n_q, run->use_last - 1, dt, a);
  return true;
}

pleuel_status pl_run_point_as(pl_run* run, const pl_run* as, double t, const double* q,
                              const double* v) {
  size_t n = (size_t)run->n_q * sizeof(double), c = (size_t)run->n_c * sizeof(bool);
  memcpy(run->q, q, n);
  memcpy(run->v, v, n);
  memcpy(run->on, as->on, c);
  memcpy(run->detached, as->detached, c);
  for (int i = 0; i < run->setup->n_frictions; i++) run->friction[i] = as->friction[i];
  run->t = t;
  run->t_low = 0;
  run->factored = false;
  pl_sizes_note(run, q, v);
  pl_sizes_keep(run);
  return pl_modes_enter(run);
}
