// Time on a clock that only goes forward, and the question whether a job was asked to stop.
#include "base/base.h"

#include <time.h>

double pl_clock(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// ------------------------------------------------------------------------------------ interruption
static const double every_s = 0.1;         // `look` is called so often
static const double clock_every_s = 0.01;  // and the clock read so often, however often it is asked

// Calls until the clock is read again, from the time that the last ones took.
static void set_pace(pl_interruption* i, double now) {
  double a_call = (now - i->clock_s) / (double)(i->pace > 0 ? i->pace : 1);
  double wanted = a_call > 0 ? clock_every_s / a_call : 1e9;
  double most = 2.0 * (double)i->pace + 1;
  i->pace = wanted < 1 ? 1 : wanted > most ? (long)most : (long)wanted;
  i->countdown = i->pace;
  i->clock_s = now;
}

bool pl_interrupted(const pl_job* job) {
  pl_interruption* i = job->interrupted;
  if (i == NULL) return false;
  if (atomic_load_explicit(&i->asked, memory_order_relaxed) != 0) return true;
  if (i->stopped) return true;
  if (i->look == NULL || --i->countdown > 0) return false;
  double now = pl_clock();
  set_pace(i, now);
  if (now - i->look_s < every_s) return false;
  i->look_s = now;
  i->stopped = i->look(i->user);
  return i->stopped;
}

void pl_job_done(const pl_job* job, int done, int of) {
  if (job->interrupted == NULL) return;
  job->interrupted->done = done;
  job->interrupted->of = of;
}
