// Time of the integration alone, without reading and preparing a model.
//
// Usage: motion_kernel MODEL.pleuel interpreter|compiled|general|radau|auto TOLERANCE [UNTIL
// [REPEATS]]
//
// Prints CPU microseconds of one run (best of the repeats), steps, order, and the state at the
// end: q and v of all
// coordinates with 17 digits.  Starting (consistent values, compiling) is not counted; a repeat
// starts from the same numbers.
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "api/api_impl.h"

static double cpu_us(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e6 * (double)t.tv_sec + 1e-3 * (double)t.tv_nsec;
}

static int fail(const char* what, const char* why) {
  fprintf(stderr, "%s: %s\n", what, why);
  return 1;
}

// One run from the consistent start values.  The first step of a compiled run, in which it is
// compiled or read from the store, is
// not timed; the mean of the others stands for it.
static double run_once(pleuel_model* m, const pl_run_options* how, pl_stats* stats) {
  pl_mark mark = pl_arena_mark(m->arena);
  pl_run* run;
  if (pl_run_make(&m->job, &m->recording->setup, how, &run) != PLEUEL_OK) return (double)NAN;
  pleuel_status s = pl_run_start(run);
  if (s != PLEUEL_OK) return (double)NAN;
  if (how->engine == PL_ENGINE_COMPILED) s = pl_run_step(run);
  double begin = cpu_us();
  if (s == PLEUEL_OK) s = pl_run_to_end(run);
  double us = cpu_us() - begin;
  *stats = *pl_run_stats(run);
  if (how->engine == PL_ENGINE_COMPILED && stats->steps > 1)
    us *= (double)stats->steps / (double)(stats->steps - 1);
  size_t n = (size_t)m->recording->setup.n_q;
  printf("%.3f us  %ld steps  order %d  rejected %ld  g %.1e  drift %.1e  %s%s", us, stats->steps,
         stats->order, stats->rejections, stats->max_g, stats->energy_drift,
         stats->compiled ? "compiled" : "interpreted", stats->stored ? " (stored)" : "");
  printf("  compile %.1f ms\n", 1e3 * stats->compile_s);
  for (size_t i = 0; i < n; i++) printf("  %.17g %.17g\n", pl_run_q(run)[i], pl_run_v(run)[i]);
  if (s != PLEUEL_OK) fprintf(stderr, "%s\n", m->job.message);
  pl_run_free(run);
  pl_arena_rewind(m->arena, mark);
  return us;
}

int main(int argc, char** argv) {
  if (argc < 4)
    return fail(argv[0],
                "MODEL interpreter|compiled|general|radau|auto TOLERANCE [UNTIL [REPEATS]]");
  pleuel* ctx = pleuel_open(NULL);
  pleuel_model* m = NULL;
  if (pleuel_load_file(ctx, &m, argv[1], NULL) != PLEUEL_OK || pl_pipeline_check(m) != PLEUEL_OK
      || pl_pipeline_record(m) != PLEUEL_OK)
    return fail(argv[1], "does not load");
  const pl_recording* r = m->recording;
  pl_run_options how = {.t_0 = r->t_0,
                        .t_end = argc > 4 ? atof(argv[4]) : r->t_end,
                        .tol = atof(argv[3]),
                        .count = 1};
  how.general = strcmp(argv[2], "general") == 0;
  how.engine = strcmp(argv[2], "compiled") == 0 ? PL_ENGINE_COMPILED : PL_ENGINE_INTERPRETER;
  how.method = strcmp(argv[2], "radau") == 0  ? PL_METHOD_RADAU
               : strcmp(argv[2], "auto") == 0 ? PL_METHOD_AUTO
                                              : PL_METHOD_TAYLOR;
  if (how.method != PL_METHOD_TAYLOR) how.engine = PL_ENGINE_AUTO;
  int repeats = argc > 5 ? atoi(argv[5]) : 1;
  pl_stats stats;
  double best = (double)INFINITY;
  for (int i = 0; i < repeats; i++) best = fmin(best, run_once(m, &how, &stats));
  printf("best %.1f us\n", best);
  pleuel_close(ctx);
  return 0;
}
