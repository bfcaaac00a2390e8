// analysis: the steps from a model to its motion, in their order.
#include <time.h>

#include "mechanics/mechanics.h"

double pl_cpu_ms(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

// The time since *since goes to *ms.
static void pass(double* ms, double* since) {
  double now = pl_cpu_ms();
  if (ms) *ms += now - *since;
  *since = now;
}

pl_analysis* pl_analysis_open(pl_job* job, pl_model* whole, const pl_stage* stage,
                              pl_towers* towers) {
  pl_analysis* d = PL_NEW(job->arena, pl_analysis);
  *d = (pl_analysis){.job = job,
                     .arena = job->arena,
                     .pool = whole->pool,
                     .model = whole,
                     .towers = towers,
                     .contradicting = -1};
  pl_setup_facts(d);
  pl_choose_set(d, whole, stage);
  return d;
}

// From the beginning, with the special case known that the given numbers are.
static void begin_again(pl_analysis* d) {
  pl_analysis fresh = {.job = d->job,
                       .arena = d->arena,
                       .pool = d->pool,
                       .towers = d->towers,
                       .effort_s = d->effort_s,
                       .page = d->page,
                       .contradicting = -1};
  fresh.cases = d->cases;
  fresh.model = d->whole;
  pl_setup_facts(&fresh);
  pl_choose_set(&fresh, d->whole, d->stage);
  *d = fresh;
}

pleuel_status pl_form_equations(pl_analysis* d) {
  PL_TRY(pl_setup_coordinates(d));
  PL_TRY(pl_setup_trivial(d));
  PL_TRY(pl_energies(d));
  PL_TRY(pl_reduce(d));
  pl_start_in_generalized(d);
  pl_find_implied(d);
  return PLEUEL_OK;
}

static pleuel_status solve_equations(pl_analysis* d, double* ms, double* since) {
  pleuel_status status = pl_form_equations(d);
  if (status == PLEUEL_OK) status = pl_find_contradictions(d);
  pass(ms ? &ms[0] : NULL, since);
  PL_TRY(status);
  status = pl_solve_motion(d);
  pass(ms ? &ms[1] : NULL, since);
  return status;
}

pleuel_status pl_derive_motion(pl_analysis* d, double* ms) {
  double since = pl_cpu_ms();
  PL_TRY(solve_equations(d, ms, &since));
  while (pl_find_case(d)) {
    begin_again(d);
    PL_TRY(solve_equations(d, ms, &since));
  }
  pl_count_freedom(d);
  pl_find_dependences(d);
  pl_share_forces(d);
  return PLEUEL_OK;
}
