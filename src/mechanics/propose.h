// propose: generalized coordinates that the constraints suggest, for a model that chooses none.
#ifndef PL_PROPOSE_H
#define PL_PROPOSE_H

#include "mechanics/mechanics.h"

enum { PL_MAX_PROPOSED = 12 };  // angles

// Letters that were made, and how many the present trial has taken.
typedef struct pl_angle_names {
  pl_symbol at[PL_MAX_PROPOSED];
  int n, next;
} pl_angle_names;

struct pl_proposal {
  pl_analysis* analysis;         // of the copy; NULL: nothing was found
  PL_VEC(pl_definition) angles;  // the new ones, over the coordinates of the model
  PL_VEC(pl_definition) tried;   // the same, of the present trial
  pl_angle_names plain, numbered, polar;
  int n_trials, flaws;     // of the analysis that is kept
  bool on_sphere, across;  // it has a sphere; whose axis lies across the force
};

// the analysis with what the constraints suggest; NULL: nothing was found
pl_analysis* pl_propose(pl_analysis* d);
pl_analysis* pl_propose_for_rest(pl_analysis* d);  // the same for positions of rest
// a new angle that does not lead
bool pl_follows_by_constraint(const pl_analysis* a, pl_symbol q);
// The definition of a new angle over the coordinates of the model, or the value of the constraint
// that gives it.
pl_expr pl_proposed_value(pl_analysis* a, const pl_definition* angle);

#endif
