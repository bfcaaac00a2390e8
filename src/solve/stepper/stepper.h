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

#include "solve/dae/dae.h"

typedef struct pl_stepper pl_stepper;
typedef struct pl_observer pl_observer;

// A step on its way.
typedef struct pl_stepper_step {
  double h;       // its length, signed
  double wanted;  // that of expand, before a root or a check shortened it
  double root;    // what ends it, in units of h: -1 nothing, 0 something at its start
  bool found;     // the state at its end stands in trial_q, trial_v
  double defect;  // what a longer attempt was off by, 0 none
  pl_projection projection;
} pl_stepper_step;

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
  pleuel_status (*expand)(pl_run* run, pl_stepper_step* s);
  // The end of the step, at s->root where that is not negative.  Sets found or a shorter s->h.
  pleuel_status (*state_at)(pl_run* run, pl_stepper_step* s);
  // Coefficients in units of the step of the watched quantity; returns how many.  NULL: those of
  // the series at the point.
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

// What events report to, without knowing who listens: rows, energies, records.
struct pl_observer {
  // Remembers the point before the motion changes.
  void (*before)(pl_run* run);
  // The point as a row.
  pleuel_status (*point)(pl_run* run, pl_row_kind kind);
  // Something happened at the point.
  pleuel_status (*event)(pl_run* run, pl_event_kind kind, int index, double impulse, bool at_start);
  // Something happened at time t, whose state, in row_q and row_v, is not that of the point.
  pleuel_status (*beside)(pl_run* run, pl_event_record e, double t, const double* a,
                          const double* lambda);
  // A contact after endless bounces, dt after the point.
  pleuel_status (*settled)(pl_run* run, pl_event_kind kind, int index, double dt, long bounces);
  // Energy at the point; anew: its drift counts from here.
  void (*energy)(pl_run* run, bool anew);
  // The energy of a state with the accelerations and multipliers of the point.
  double (*energy_of)(pl_run* run, const double* q, const double* v);
};

// where a run stops before its end
typedef struct pl_stop {
  bool early;
  double t, t_low;
} pl_stop;

// The control of steps: lengths, sizes that errors are measured by, the end that is tried.
typedef struct pl_control {
  double tol;
  bool tol_raised;
  // of which the step at work, the step before, uses so many: fewer in a leap
  int use_last;
  double t_last, h_last;    // where that starts, and its length
  double h_series;          // step that the series allowed last
  double h_plain, h_least;  // s: longest step, shortest
  double row_gap;           // s: longest between two rows without a grid
  long grid_n, grid_count;
  double grid_dt;
  const double* grid_times;  // instead: rows at these times, grid_count + 1 of them; NULL
  double *trial_q, *trial_v;
  // rows
  double *row_q, *row_v, *row_a, *row_l;
  // difference between these and those of the equations that shorter steps did not lessen
  double a_rough;
  int tiny;  // steps in a row that were almost nothing
  double energy_size, energy_base;
  double* energy_out;
  pl_stop stop;
  bool start_given;  // given start values are as they were written
  bool started, stopped;
} pl_control;

// A run: parts by the room that owns them.  What a pointer leads to is declared there.
struct pl_run {
  pl_job* job;
  const pl_setup* setup;
  pl_run_options options;
  int n_q, n_c, order;
  pl_dae dae;                               // the equations, at the point
  pl_batches observers, watched, branches;  // patterns beside the motion
  pl_control control;
  const pl_stepper* stepper;      // at work
  const pl_stepper* steppers[2];  // that the run has
  int n_steppers;
  struct pl_taylor* taylor;            // series in doubles, program of a step
  struct pl_extended* extended;        // series in extended precision; NULL: doubles
  struct pl_radau* radau;              // the implicit method, NULL without it
  struct pl_reference* reference;      // Runge-Kutta with fixed steps, NULL without it
  struct pl_events* event;             // what is watched, contacts, singular positions
  struct pl_output_state* output;      // rows
  const pl_observer* observer;         // where events report
  const struct pl_lead* lead;          // of one with derivatives, NULL without it
  struct pl_sensitivity* sensitivity;  // the lead run of one with derivatives, NULL without it
  double* branch_value;                // of the branches of the start  (n_branch_outputs)
  pl_start_report start;
  pl_stats stats;
};

// ---- stepper.c
double pl_run_left(const pl_run* run);           // to the end, or to where it stops before
double pl_grid_time(const pl_run* run, long n);  // of row n of the output grid
// Contacts or events changed the motion.
void pl_steppers_changed(pl_run* run, bool shaken);

#endif
