// trace: the motion of a model looked at for its own sake, beside the run that a user asked for. It
// reads the model the way `sim` does (raw constraints, contacts by their sign), so what a
// derivation found can be held against it.
#ifndef PL_TRACE_H
#define PL_TRACE_H

#include "assembly/assembly.h"

// A state of the motion.  Arrays are indexed as in the setup of the recording.
typedef struct pl_trace_sample {
  double t;
  const double *q, *v, *a;  // (n_q)
  const double* lambda;     // (n_c), 0 where inactive
  const bool* unique;       // false: this multiplier is not determined  (n_c)
  const double* out;        // (n_out): T, V, outputs
  int phase;
} pl_trace_sample;

// A stretch of the motion between two changes: of what holds, or of the state by an impact or a
// action.
typedef struct pl_trace_phase {
  double t_begin, t_end;  // s; equal when the motion only touches it
  int first, n;           // samples
  // rows that hold: contacts that touch, surfaces that stick, what is attached  (n_c)
  const bool* active;
  const bool* released;                 // rows that an event released, or that are off  (n_c)
  const pl_friction_report* frictions;  // how each friction goes on  (n_frictions)
  bool same_set;                        // rows as in the phase before: only the state jumped
  pl_event_kind begun_by;               // with the label, NULL for the first phase
  const char* begun_label;
} pl_trace_phase;

typedef struct pl_trace {
  pl_model* model;  // with a number for every parameter
  const pl_recording* recording;
  // numbers of parameters, by symbol id; NaN else     (pl_symbol_count + 1 when made)
  double* value;
  int n_value;
  // how the run ended; PLEUEL_OK also when it was cut short by the budget
  pleuel_status status;
  const char* message;     // its sentence when it failed, else ""
  bool started;            // there is a consistent start: at least one phase and one sample
  bool whole;              // the span was covered
  double t_end;            // s, how far it came
  const char* stopped_by;  // the event that ended it before; NULL
  // contacts that are met at the start but would have to pull: they let go at once  (n_c)
  bool* pulls;
  // it ends at a singular position, behind which another assembly may go on
  bool singular;
  PL_VEC(pl_trace_sample) samples;
  PL_VEC(pl_trace_phase) phases;
  PL_VEC(pl_trace_sample) marks;  // where the quantity to be met was zero, in order
  int n_free;                     // positions that nothing determined
  // how far given start values were moved, relative: from another start beyond rounding
  double moved;
  long steps;   // of the integration
  double work;  // counted: steps times the size of the system
} pl_trace;

typedef struct pl_trace_options {
  uint64_t seed;          // 0: the start of `init`; else a random consistent start beside it
  const pl_motion* from;  // the start that this names, instead; NULL
  // of `from`: velocities of this size beside it, so that the motion leaves a position of rest
  double push;
  // a quantity: the run ends where it is zero the first time; poison: none
  pl_expr meet;
  // of seed > 0: the trace from `init`, for its position and contacts; NULL: anywhere
  const pl_trace* beside;
  long most_samples;  // 0: 120
  // s; 0: as `simulate` says, else a few times the time scale of the start
  double span;
  // coordinates that nothing is said of start as in a run, not anywhere
  int n_watched;           // quantities whose zeros are marks, behind which the run goes on
  const pl_expr* watched;  // (n_watched)
  bool as_run;
} pl_trace_options;

// pl_trace_model gives the model with random positive numbers, within the assumptions, for
// parameters without any: the same for the same seed. The model itself where every parameter has
// one; NULL when none were found.
pl_model* pl_trace_model(pl_job* job, pl_model* m, uint64_t seed);

// pl_trace_copy gives a model of its own: lists of parameters, constraints, start values, events,
// outputs can be written.
pl_model* pl_trace_copy(pl_arena* a, const pl_model* m);

// pl_trace_number gives a double as an expression, with its shortest decimal.
pl_expr pl_trace_number(pl_pool* p, double x);

// pl_trace_make runs a model whose parameters have numbers. The trace is there whatever happens;
// its status tells how it went. Nothing is reported, and no other run is disturbed.
pl_trace* pl_trace_make(pl_job* job, pl_model* numbered, const pl_trace_options* options);

// The row of a constraint, by its place in the model (instance 0 outside of families); -1 when
// there is none.
int pl_trace_constraint(const pl_trace* t, int constraint, int instance);
// Whether a constraint holds during a phase: all instances of it do.
bool pl_trace_holds(const pl_trace* t, const pl_trace_phase* phase, int constraint);
// Whether surfaces stick during a phase: those of friction number k of the model.
bool pl_trace_sticks(const pl_trace* t, const pl_trace_phase* phase, int friction);

#endif
