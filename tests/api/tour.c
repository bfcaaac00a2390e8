// A tour of pleuel.h: this program is compiled and run, and docs/api.md shows it.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "pleuel.h"

static const char text[] =
    "system \"Pendulum\"\n"
    "param m = 1 [kg], l = 1/2 [m], g = 9.81 [m/s^2]\n"
    "coord x, y\n"
    "axes x right, y up\n"
    "mass m at (x, y)\n"
    "gravity g along -y\n"
    "constraint rod: x^2 + y^2 = l^2   with λ\n"
    "init x = 0.6 l, x' = 0\n"
    "branch y < 0\n"
    "event lowest: when x = 0 -> record\n"
    "ask solve λ\n"
    "simulate 0..2 [s]\n";

// a text, its messages and its solution
static int solve(pleuel* ctx, pleuel_model** model) {
  const char* answer;
  if (pleuel_load_text(ctx, model, text, strlen(text), NULL) != PLEUEL_OK
      || pleuel_solve_text(*model, &answer, NULL) != PLEUEL_OK) {
    puts(pleuel_message(ctx));
    return 1;
  }
  puts(answer);
  return 0;
}

// a motion as a whole: columns are arrays
static int whole(pleuel_run* run) {
  pleuel_result* result;
  if (pleuel_run_complete(run, &result) != PLEUEL_OK) return 1;
  PLEUEL_OPTIONS(pleuel_column, x);
  pleuel_result_column(result, (size_t)pleuel_result_find(result, "x"), &x);
  double widest = 0;
  for (size_t k = 0; k < x.n; k++) widest = fmax(widest, fabs(x.at[k * x.stride]));
  printf("%zu rows, |x| up to %.6g %s\n", x.n, widest, x.unit);
  pleuel_result_free(result);
  return fabs(widest - 0.3) > 1e-9;
}

// a sweep: other numbers, nothing is derived again; the quarter of a period by the event
static int sweep(pleuel_run* run) {
  for (double l = 0.25; l <= 1; l += 0.25) {
    PLEUEL_OPTIONS(pleuel_event, event);
    if (pleuel_run_set(run, "l", l) != PLEUEL_OK || pleuel_run_start(run) != PLEUEL_OK
        || pleuel_run_advance(run, 2, 1) != PLEUEL_OK
        || pleuel_run_event(run, &event) != PLEUEL_OK) {
      puts(pleuel_run_message(run));
      return 1;
    }
    printf("l = %.2f m: lowest after %.6f s\n", l, event.t);
  }
  pleuel_run_reset(run);
  return 0;
}

// step by step, with states between, and back to a state that was saved
static int steps(pleuel_run* run) {
  double q[2], lambda;
  unsigned char bytes[1 << 16];
  size_t n = sizeof bytes;
  if (pleuel_run_start(run) != PLEUEL_OK || pleuel_run_step(run) != PLEUEL_OK
      || pleuel_run_dense(run, 0.5 * pleuel_run_time(run), q, NULL, NULL, &lambda) != PLEUEL_OK
      || pleuel_run_save(run, bytes, &n) != PLEUEL_OK || pleuel_run_advance(run, 1, 0) != PLEUEL_OK
      || pleuel_run_restore(run, bytes, n) != PLEUEL_OK) {
    puts(pleuel_run_message(run));
    return 1;
  }
  printf("in the first step x = %.6f m, lambda = %.6f N/m\n", q[0], lambda);
  return 0;
}

int main(void) {
  pleuel* ctx = pleuel_open(NULL);
  pleuel_model* model = NULL;
  pleuel_system* system = NULL;
  pleuel_run* run = NULL;
  int bad = solve(ctx, &model);
  bad = bad || pleuel_system_make(model, &system, NULL) != PLEUEL_OK;
  bad = bad || pleuel_run_open(system, &run, NULL) != PLEUEL_OK;
  bad = bad || whole(run) || sweep(run) || steps(run);
  pleuel_run_close(run);
  pleuel_system_free(system);
  pleuel_close(ctx);
  return bad;
}
