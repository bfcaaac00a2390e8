// equilibria, inside: the words for positions of rest. answer_equilibria.c shows them,
// answer_modes.c the oscillations,
// answer_threshold.c where the stability changes.
#ifndef PL_EQUILIBRIA_IMPL_H
#define PL_EQUILIBRIA_IMPL_H

#include "mechanics/equilibria.h"
#include "worked/worked_impl.h"

// The position of rest that a frequency or a threshold belongs to; of steady motions nothing.
void pl_tell_place(pl_analysis* d, const pl_rest* r, pl_value* v);
bool pl_rests_out_of_reach(pl_analysis* d);  // said why
const pl_form* pl_rest_form(pl_analysis* d, const pl_rest* r);
// A sign that was taken for granted is zero there: what is linear around it holds on one side.
bool pl_rest_on_border(pl_analysis* d, const pl_rests* found, const pl_rest* r);
bool pl_say_bends(pl_analysis* d, const pl_expr* f);  // |u| is left in the equations: said
// ω² = ..., or ω² ≈ ... in numbers
const pl_form* pl_square_form(pl_analysis* d, pl_expr w2, bool numeric);
void pl_say_velocity_terms(pl_analysis* d, const pl_linearised* l);
void pl_say_no_rest_named(pl_analysis* d, const pl_ask* ask, const pl_expr* f);
void pl_say_rests_missing(pl_analysis* d, const pl_expr* f, const pl_rests* found);

#endif
