// Time on a clock that only goes forward, and the question whether a job was asked to stop.
#include "base/base.h"

#include <time.h>

double pl_clock(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

bool pl_interrupted(const pl_job* job) {
  return job->interrupted != NULL && *job->interrupted != 0;
}
