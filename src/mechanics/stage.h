// stage: which constraints hold along a stretch of the motion, and the degrees of freedom that they
// leave.
#ifndef PL_STAGE_H
#define PL_STAGE_H

#include "algebra/algebra.h"

// How a stretch of the motion ends.
typedef enum pl_stage_end {
  PL_END_UNKNOWN,  // not looked at further
  PL_END_OF_RUN,   // the simulation ends
  PL_END_OPENS,    // a contact: its multiplier is zero
  PL_END_CLOSES,   // a contact: its constraint is met
  PL_END_STICKS,   // friction: the slip has come to rest
  PL_END_SLIPS,    // friction: its force has come to the limit
  PL_END_EVENT,    // of the model
  PL_END_SIDE      // an expression is zero whose sign was taken for granted: |x|
} pl_stage_end;

// Friction in the plane on a constraint. It slips with the velocity `slip` and feels -way press
// scale λ along it, or sticks.
typedef struct pl_stage_rub {
  const char* on;              // name of the row of the constraint
  const char* name;            // of the row of the slip, "friction floor"
  pl_expr slip, limit, scale;  // |F| <= limit |λ| while it sticks, = scale |λ| while it slips
  bool sticks, slips;
  int way, press;  // signs of the slip and of the multiplier
} pl_stage_rub;

// A set of constraints that hold together, and the first stretch of the motion on which it does.
// Rows are named as in the simulation: "floor", "c[3]", and "choose x" for the map of x. Who calls
// derive finds out; derive does not guess.
typedef struct pl_stage {
  int n;
  const char* const* name;  // (n)
  const bool* holds;        // (n)
  const bool* released;     // by an event, or `off`: nothing keeps its side either  (n)
  const bool* pulls;        // met at the beginning, but would have to pull          (n)
  const bool* rope;         // taut or slack, not closed or open                     (n)
  int n_rubs;
  const pl_stage_rub* rubs;  // (n_rubs)
  bool rubs_known;           // all friction of the model is among them
  double from, to;           // s
  int n_q;
  // coordinates where the stretch begins, units as text, "rad" for angles
  const char *const *q_name, *const *q_unit;
  const double *q, *v;  // (n_q)
  bool later;           // not the first stretch of the motion
  pl_stage_end end;
  const char* ended_by;  // label of the contact or event; NULL
  // signs that hold on this stretch, where the formulas of another one took the opposite ones
  int n_sides;
  const pl_fact* sides;  // (n_sides)
  int n_crossed;         // the first of them: their change begins the stretch
  pl_expr crossed;       // PL_END_SIDE: what is zero
} pl_stage;

// ------------------------------------------------------------------------------ degrees of freedom
typedef struct pl_dof {
  int coordinates, constraints;  // constraints that hold
  int rank, dof, velocity_dof;
  int open;  // contacts that are open
  int free;  // degrees of freedom with all contacts open
} pl_dof;

// All towers of a derivation: whoever owns the list frees them.
typedef PL_VEC(pl_tower*) pl_towers;

#endif
