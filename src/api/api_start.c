// From a recording to a run with a consistent start: as it stands, with derivatives, or with bodies
// whose attitude is integrated as a quaternion.
#include <string.h>

#include "api/system_impl.h"

static pleuel_status start_plain(pl_run* run, pl_start_report* report) {
  pleuel_status s = pl_run_start(run);
  *report = *pl_run_start_report(run);
  return s;
}

// Positions and velocities of all blocks: the motion, and what is known of its variation.
static pleuel_status start_blocks(pl_job* job, const pl_recording* r, pl_run* run, double t,
                                  const double* q, const double* v) {
  size_t n = (size_t)r->flat.n, all = (size_t)r->setup.n_q;
  double *q_all = PL_ARRAY(job->arena, double, all), *v_all = PL_ARRAY(job->arena, double, all);
  bool *held_q = PL_ARRAY(job->arena, bool, all), *held_v = PL_ARRAY(job->arena, bool, all);
  for (size_t k = 0; k < (size_t)r->n_directions; k++) {
    for (size_t i = 0; i < n; i++) {
      size_t of = 2 * k * n + i, delta = of + n;
      q_all[of] = q[i];
      v_all[of] = v[i];
      held_q[of] = held_v[of] = true;
      q_all[delta] = r->varied_q[k * n + i];
      v_all[delta] = r->varied_v[k * n + i];
      held_q[delta] = r->setup.coordinates[delta].has_q;
      held_v[delta] = r->setup.coordinates[delta].has_v;
    }
  }
  return pl_run_start_partly(run, t, q_all, v_all, held_q, held_v);
}

static pl_run_options quiet_of(const pl_run_options* how) {
  pl_run_options quiet = *how;
  quiet.sink = (pl_sink){0};
  quiet.progress = NULL;
  quiet.keep = NULL;
  return quiet;
}

// The consistent start is found without variations, which follow from it.
static pleuel_status start_varied(pl_job* job, const pl_recording* r, const pl_recording* plain,
                                  const pl_run_options* how, pl_run* run, pl_start_report* report) {
  pl_run* first = NULL;
  pl_run_options quiet = quiet_of(how);
  bool switched = r->setup.varied != NULL;
  struct pl_sensitivity* ahead = NULL;
  if (switched) ahead = pl_sensitivity_make(job, run, &plain->setup, &quiet.sink);
  pleuel_status s = pl_run_make(job, &plain->setup, &quiet, &first);
  if (s == PLEUEL_OK) s = start_plain(first, report);
  bool goes_ahead = s == PLEUEL_OK && ahead;  // and is freed with the run
  if (goes_ahead) pl_sensitivity_attach(ahead, run, first);
  if (s == PLEUEL_OK)
    s = start_blocks(job, r, run, pl_run_time(first), pl_run_q(first), pl_run_v(first));
  if (!goes_ahead) pl_run_free(first);
  return s;
}

// Bodies in space are integrated as quaternions from the start that was found in their angles.
static pleuel_status start_turned(pl_job* job, const pl_recording* r, const pl_run_options* how,
                                  pl_run* run, pl_start_report* report) {
  pl_run* first = NULL;
  pl_run_options quiet = quiet_of(how);
  quiet.start_only = true;  // the angles may tell no accelerations there
  pleuel_status s = pl_run_make(job, &r->setup, &quiet, &first);
  if (s == PLEUEL_OK) s = start_plain(first, report);
  size_t n = (size_t)r->flat.n, all = (size_t)r->turned->setup.n_q;
  double *q = PL_ARRAY(job->arena, double, all), *v = PL_ARRAY(job->arena, double, all);
  if (s == PLEUEL_OK) {
    memcpy(q, pl_run_q(first), n * sizeof *q);
    memcpy(v, pl_run_v(first), n * sizeof *v);
    s = pl_run_start_from_angles(run, pl_run_time(first), q, v);
  }
  pl_run_free(first);
  return s;
}

pleuel_status pl_start_motion(pl_job* job, const pl_recording* r, const pl_recording* plain,
                              bool turned, const pl_run_options* how, pl_run* run,
                              pl_start_report* report) {
  if (r->n_directions) return start_varied(job, r, plain, how, run, report);
  if (turned) return start_turned(job, r, how, run, report);
  return start_plain(run, report);
}
