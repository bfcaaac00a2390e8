// What steppers and their driver share.
#include "solve/stepper/stepper.h"

#include <math.h>

double pl_run_left(const pl_run* run) {
  if (run->control.stop.early)
    return (run->control.stop.t - run->dae.t) + (run->control.stop.t_low - run->dae.t_low);
  return run->options.t_end - run->dae.t - run->dae.t_low;
}

void pl_steppers_changed(pl_run* run, bool shaken) {
  for (int i = 0; i < run->n_steppers; i++)
    if (run->steppers[i]->changed) run->steppers[i]->changed(run, shaken);
}

double pl_grid_time(const pl_run* run, long n) {
  if (run->control.grid_times)
    return n <= run->control.grid_count ? run->control.grid_times[n] : (double)INFINITY;
  // the last one exactly at the end, the others by one multiplication, so that nothing accumulates
  if (run->control.grid_count > 0 && n == run->control.grid_count) return run->options.t_end;
  return run->options.t_0 + (double)n * run->control.grid_dt;
}
