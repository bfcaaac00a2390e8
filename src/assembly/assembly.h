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
  const int* first_link;
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
  const char* sensitivities;  // as asked for
  bool exact;                 // numbers as they are written, not their doubles
} pl_recording;

// pl_record translates a checked model.
//   sensitivities  names of parameters and start values ("m2,x0") whose derivatives are columns
//                  too; NULL: none
//   exact          for numbers with more digits than doubles
pleuel_status pl_record(pl_job* job, pl_model* model, const char* sensitivities, bool exact,
                        pl_recording** out);
void pl_record_dump(pl_text* out, const pl_model* model, const pl_recording* r);

#endif
