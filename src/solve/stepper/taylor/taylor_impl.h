// Inside of the Taylor steppers: what doubles and extended precision share.
#ifndef PL_TAYLOR_IMPL_H
#define PL_TAYLOR_IMPL_H

#include "solve/event/event.h"
#include "solve/stepper/taylor/taylor.h"

typedef struct pl_step_program pl_step_program;  // step_program_impl.h

// What the series keep from step to step.
typedef struct pl_taylor {
  // the step program, for the mode at work and those before; NULL: by the patterns
  pl_step_program *program, *programs;
  double clock_begin, t_begin;  // when stepping with these began
  long considered;              // steps at which compiling was thought of last
  double shrink;                // a step in units of the radius of the series, its logarithm
  // accelerations of the series at the end of the step that is tried   (n_q)
  double* end_a;
  bool end_by_program;  // they were computed by the step program
  // order 0 of that point is known: in Q_last and so on, until the step is taken
  bool arrived;
} pl_taylor;

// The numbers in which the series is computed.
typedef struct pl_taylor_numbers {
  double (*floor)(const pl_run* run);  // what rounding of the state leaves of a residual, relative
  double (*epsilon)(const pl_run* run);  // of the state
  // what rounding may do to a projection close to a singular position, in units of the floor
  double near_singular;
  bool leaps;          // over singular positions where the motion goes on smoothly
  bool refines_roots;  // roots found in doubles are moved to the digits of the state
  // Order 0 into the series at work.
  bool (*enter)(pl_run* run);
  // Orders 1 and up.
  void (*expand)(pl_run* run);
  // The step that the series allows.
  double (*length)(pl_run* run);
  // The state at h into trial_q, trial_v, projected.
  void (*advance)(pl_run* run, double h, bool at_root, pl_projection* p);
  // How large the accelerations at that state are, and what those of the series are off by.
  bool (*defect)(pl_run* run, double h, double* off, double* size);
} pl_taylor_numbers;

// ---- taylor_step.c: slots of both steppers
pleuel_status pl_taylor_step_expand(pl_run* run, pl_stepper_step* s,
                                    const pl_taylor_numbers* numbers);
pleuel_status pl_taylor_step_state_at(pl_run* run, pl_stepper_step* s,
                                      const pl_taylor_numbers* numbers);

// ---- taylor_series.c
enum { PL_BLOCK_ROWS = 6 };
// coefficients whose norms give the radius: 0, 1, 2, 3, last - 1, last
void pl_block_rows(int last, int row[PL_BLOCK_ROWS]);
// Norms of these rows of X, whose last coefficient is `last`.
void pl_block_norms(const double* X, int n, int last, double* norm);
// The step that the series at the point allows, from the norms of blocks of q and v.
double pl_series_length(const pl_run* run, const double* q, const double* v);

// ---- taylor_plan.c
void pl_taylor_make(pl_run* run);
void pl_taylor_plan(pl_run* run);

#endif
