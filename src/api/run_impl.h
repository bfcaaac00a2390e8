// A run, inside: api_run.c has its numbers and the way forward, api_run_state.c what is read of it.
#ifndef PL_RUN_IMPL_H
#define PL_RUN_IMPL_H

#include "api/system_impl.h"

struct pleuel_run {
  pl_arena* arena;   // of the run, and of what is set
  pl_arena* motion;  // of the motion at work; emptied at each start
  pl_mark empty;
  pleuel_system* system;  // kept
  pleuel_sim_options options;
  pl_job job;
  pl_interruption interruption;
  pl_diagnostics diagnostics;
  char message[512];
  // numbers that are set, and what the inputs are now
  PL_VEC(int) given;
  PL_VEC(double) given_value;
  PL_VEC(pl_number_start_set) starts;
  pl_recording numbered;  // with these numbers
  // the motion
  pl_run* run;            // NULL: not started
  pl_run* probe;          // for states that are asked about; NULL: none so far
  pleuel_status stopped;  // why it cannot go on
  // where it began: at the consistent start, or at a state that was given
  bool from_state;
  double t_origin, *q_origin, *v_origin;  // (n_q)
  double* row;                            // scratch (columns)
  bool has_event;
  pl_event_kept event;
  // rows at given times
  double* block;
  size_t block_stride, block_n, block_at;
  const double* block_t;
  // inputs by a function
  int (*input)(void* user, pleuel_run* run, double t, double* u);
  void* input_user;
  double input_dt, input_next;
  long input_count;
  double* u;  // (inputs)
};

typedef pleuel_status pl_api_run_work(pleuel_run* r, void* argument);
// Runs work under guards; the sentence of the job becomes that of the run.
pleuel_status pl_api_run_guarded(pleuel_run* r, pl_api_run_work* work, void* argument);

// A state that is given, and what is wanted of it.
typedef struct pl_state_given {
  double t;
  const double *q, *v;
  double *a, *lambda;
} pl_state_given;

void pl_api_run_drop(pleuel_run* r);  // the motion at work
pleuel_status pl_api_run_need_start(pleuel_run* r);
bool pl_api_run_is_turned(const pleuel_run* r);
const pl_setup* pl_api_run_setup(const pleuel_run* r);  // that is integrated
pl_run_options pl_api_run_options_of(const pleuel_run* r);
pl_sink pl_api_run_sink(pleuel_run* r);
// The memory of the motion is empty, and the numbers are put in.
pleuel_status pl_api_run_clear(pleuel_run* r);
pleuel_status pl_api_run_begin(pleuel_run* r, const pl_run_options* how, pl_run** out);
pleuel_status pl_api_run_restart(pleuel_run* r);  // from where it is, with other numbers

#endif
