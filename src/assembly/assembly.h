// assembly: from a checked model to the system that is integrated: patterns with their instances,
// start values, constraints, friction, events, observed quantities.
#ifndef PL_ASSEMBLY_H
#define PL_ASSEMBLY_H

#include "model/model.h"
#include "solve/solve.h"

// A start value as written: its expression, in which the indices of an instance may stand. Poison:
// none given.
typedef struct pl_exact_start {
  pl_expr value;
  const pl_instances* instances;
  int instance;
} pl_exact_start;

// The slip of a friction and its coefficients: |F| <= limit |λ| while it sticks, = scale |λ| while
// it slips.
typedef struct pl_friction_law {
  pl_expr slip, limit, scale;
} pl_friction_law;

// What the simulation needs, translated from the model (record.c).
typedef struct pl_recording {
  pl_setup setup;
  double t_0, t_end, tol, dt;  // of `simulate`; NaN t_end without it, 0 tol and dt without them
  long count;
  pl_flat_coords flat;  // coordinate of each index of the setup
  int n_declared;       // constraints before the map equations
  // the equations as they stand, of a model without families: L = T - V and more (poison else), and
  // the forces without potential along n_atoms coordinates, poison where there is none
  pl_expr lagrangian;
  int n_atoms;
  const pl_expr *atom, *force;
  // of each friction of the setup, where it stands outside of families and in the plane; slip
  // poison else
  const pl_friction_law* laws;
  // row of the first instance of each constraint of the model, then n_declared
  const int* first_constraint;
  // bodies with Euler angles are integrated with quaternions: the same columns, other coordinates
  // behind them; NULL: as it stands
  struct pl_recording* turned;
  // an expression for which some body keeps its Euler angles, NULL none
  const char* angles_kept;
  // of each coordinate                                          (flat.n)
  pl_exact_start *exact_q, *exact_v;
  // with sensitivities: coordinates stand in blocks of flat.n, the motion and its variation by
  // turns
  int n_directions;
  // variations of the start values that are given  (n_directions x flat.n)
  const double *varied_q, *varied_v;
  const char* sensitivities;         // as asked for
  bool exact;                        // numbers as they are written, not their doubles
  const struct pl_numbers* numbers;  // that may change without recording again
} pl_recording;

// pl_record translates a checked model.
//   sensitivities  names of parameters and start values ("m2,x0") whose derivatives are columns
//                  too; NULL: none
//   exact          for numbers with more digits than doubles
pleuel_status pl_record(pl_job* job, pl_model* model, const char* sensitivities, bool exact,
                        pl_recording** out);
void pl_record_dump(pl_text* out, const pl_model* model, const pl_recording* r);

// ----------------------------------------------------------------------------------------- numbers
// Parameters and start values of a recording that can be given other values, without recording
// again. What depends on them follows in the order in which the recording found it. A pl_numbers
// does not change once it is made, and reads the pool as it was then: several threads may evaluate
// it at the same time, each with an arena of its own.

// A parameter or a kept abbreviation; each stands behind those that it is defined by.
typedef struct pl_number_given {
  pl_symbol symbol;
  pl_expr value;  // poison: none
  const char *ascii, *shown, *unit;
  bool named;     // may be set; false: a number with its unit in a formula
  bool input;     // an `input`: 0 until it is set
  bool size;      // decides how large the system is
  bool positive;  // was positive, and forms rely on it
} pl_number_given;

typedef struct pl_number_start {
  int at;  // coordinate
  bool velocity, guess;
  pl_expr value;                  // elements of families as symbols
  const pl_instances* instances;  // whose indices stand in the value
  int instance;
  pl_symbol name;  // that later values may speak of; id 0: none
} pl_number_start;

typedef struct pl_numbers {
  const pl_pool* pool;
  int n_symbols;        // of the arrays by symbol id
  const double* value;  // as recorded                            (n_symbols)
  int n_given, n_inputs;
  const pl_number_given* given;
  const int* inputs;  // of `given`                             (n_inputs)
  int n_starts;
  const pl_number_start* starts;
  const pl_expr* restitution;  // of each constraint row, poison where none is given (n_c)
  int n_c;
  int n_positive;
  const pl_expr* positive;      // masses
  pl_expr t_0, t_end, dt, tol;  // of `simulate`, poison where not given
  const char* fixed;            // why no number can be changed, in English; NULL: they can
} pl_numbers;

// What a run says otherwise than the text.
typedef struct pl_number_start_set {
  int at;
  bool velocity;
  double value;
} pl_number_start_set;
typedef struct pl_numbers_set {
  int n_given, n_starts;
  const int* given;  // of pl_numbers.given                    (n_given)
  const double* given_value;
  const pl_number_start_set* starts;  //                                    (n_starts)
} pl_numbers_set;

// pl_numbers_apply gives the setups of a recording with these numbers; *t holds t_0, t_end, dt,
// tol. Status PLEUEL_USAGE with the sentence in the job where a number is none, or not allowed.
pleuel_status pl_numbers_apply(pl_job* job, const pl_recording* recording,
                               const pl_numbers_set* set, pl_recording* out);

#endif
