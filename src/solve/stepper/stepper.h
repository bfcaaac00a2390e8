// A stepper takes a run from one point to the next: the interface behind which the methods stand.
//
// The driver (run.c) knows steps, roots and rows; how the motion is continued from a point is the
// business of a stepper. A step goes through these slots, in this order:
//
//   poll       every stepper of the run that is not at work: may take over
//   expand     the motion ahead as a polynomial of time, and how long it holds
//   (driver)   the first root of what is watched on that length
//   state_at   the state at the root or at the end of the length, on the constraints; it may ask
//              for a shorter step
//   (driver)   rows between, bookkeeping of events
//   accept     the step counts
//   enter      accelerations and multipliers at the new point
//
// The polynomial is left in the series of the run: coefficient k of positions, velocities,
// accelerations and multipliers, from the point on. Rows, events and angles read it there.
// A new stepper is a file with such a table and a line in steppers.c.
#ifndef PL_STEPPER_H
#define PL_STEPPER_H

#include "solve/solve_impl.h"

// A step on its way.
typedef struct pl_step {
  double h;       // its length, signed
  double wanted;  // that of expand, before a root or a check shortened it
  double root;    // what ends it, in units of h: -1 nothing, 0 something at its start
  bool found;     // the state at its end stands in trial_q, trial_v
  double defect;  // what a longer attempt was off by, 0 none
  pl_projection projection;
} pl_step;

// Energies at the point.
typedef struct pl_energy {
  double kinetic, potential;
  double total;   // what is conserved
  double change;  // of that since it was last counted anew
} pl_energy;

struct pl_stepper {
  const char* name;
  // The tolerance that it works to, of the one that was asked for (0: none was).
  double (*tolerance)(const pl_run_options* options);
  // Whether roots of what is watched are known to rounding; else to the tolerance.
  bool to_rounding;

  // Order and lengths from options and tolerance.  May be NULL.
  void (*plan)(pl_run* run);
  // Reserves memory.  Fails with a sentence where it cannot compute this run.
  pleuel_status (*open)(pl_run* run);
  // From the consistent start on, whose accelerations are known.
  pleuel_status (*begin)(pl_run* run, double t);
  // Before a step of another stepper: takes over by setting run->stepper.  May be NULL.
  pleuel_status (*poll)(pl_run* run);
  // Accelerations and multipliers at the point; false: the equations do not determine them.
  bool (*enter)(pl_run* run);
  // The motion ahead.
  pleuel_status (*expand)(pl_run* run, pl_step* s);
  // The end of the step, at s->root where that is not negative.  Sets found or a shorter s->h.
  pleuel_status (*state_at)(pl_run* run, pl_step* s);
  // Coefficients in units of the step of the watched quantity; returns how many.  NULL: those of the
  // series at the point.
  int (*polynomial)(const pl_run* run, int watch, double* c);
  // The step counts; to_end: it ends where the run ends.  May be NULL.
  void (*accept)(pl_run* run, bool to_end);
  // Nodes and factor of the point by the patterns, as events need them.  May be NULL.
  void (*to_patterns)(pl_run* run);
  // Contacts or events changed the motion; shaken: velocities or forces jumped.  May be NULL.
  void (*changed)(pl_run* run, bool shaken);
  // A row with more digits than doubles: of the point; at time t of the step, which is grid time n
  // (-1 none).  NULL: doubles.
  void (*row)(pl_run* run, pl_row* row, double* out);
  void (*row_between)(pl_run* run, double t, long n, pl_row* row, double* out);
  // Energies at the point; anew: change counts from here.  false or NULL: by the observers.
  bool (*energy)(pl_run* run, bool anew, pl_energy* e);
  // What lasts from step to step, written or read.  setup comes once, before the state of the run;
  // state after it, and on reading once more after the point was entered.  May be NULL.
  void (*save_setup)(pl_run* run, pl_keeper* k);
  void (*save_state)(pl_run* run, pl_keeper* k);
  void (*close)(pl_run* run);
};

// ---- steppers.c: which steppers a run has
void pl_steppers_choose(pl_run* run);

#endif
