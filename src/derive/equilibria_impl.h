// equilibria, inside: positions of rest, what is linear around them, and the words for both.  answer_equilibria.c finds and shows
// them, linearise.c has the matrices, answer_modes.c the oscillations.
#ifndef PL_EQUILIBRIA_IMPL_H
#define PL_EQUILIBRIA_IMPL_H

#include "derive/derive_impl.h"

enum { pl_max_gen = 6, pl_max_found = 32 };

typedef struct pl_rest {
  pl_expr q[pl_max_gen];       // values of the generalized coordinates
  pl_expr condition;        // >= 0 for it to exist, or poison
} pl_rest;

typedef struct pl_rests {
  pl_rest at[pl_max_found];
  int n;
  bool complete;
  int n_singular;           // positions where the coordinates fail
  pl_rest singular;         // the last of them
} pl_rests;

//   M u'' + C u' + K u = 0,  C split by symmetry into damping and gyroscopic terms.
typedef struct pl_linearised {
  int n;
  pl_expr M[pl_max_gen * pl_max_gen], C[pl_max_gen * pl_max_gen], K[pl_max_gen * pl_max_gen];
  bool damped, gyroscopic;
} pl_linearised;

// linearise.c
pl_expr pl_at_rest(pl_analysis* d, pl_expr e);                              // velocities 0, or those of the steady motion; accelerations 0
pl_expr pl_insert_rest(pl_analysis* d, pl_expr e, const pl_rest* r);
bool pl_vanishes(pl_analysis* d, pl_expr e);
void pl_linearise(pl_analysis* d, const pl_expr* f, const pl_rest* r, pl_linearised* out);
const char* pl_stability(pl_analysis* d, const pl_linearised* l, const pl_rest* r, pl_expr* stable_if);
pl_symbol pl_omega_squared(pl_analysis* d);
int pl_small_oscillations(pl_analysis* d, const pl_linearised* l, pl_root* root, int max);
// answer_equilibria.c
bool pl_rests_out_of_reach(pl_analysis* d);                                 // said why
bool pl_at_rest_equations(pl_analysis* d, pl_expr* f);
pl_rests* pl_find_rests(pl_analysis* d, const pl_expr* f);
const pl_bond* pl_rest_pulls(pl_analysis* d, const pl_rest* r);             // a one-sided constraint that would have to pull; NULL
const pl_form* pl_rest_form(pl_analysis* d, const pl_rest* r);
void pl_say_velocity_terms(pl_analysis* d, const pl_linearised* l);

#endif
