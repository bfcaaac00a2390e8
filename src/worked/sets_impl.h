// sets, inside: sets.c has the analyses, later_sets.c the sections of those sets that the motion
// comes
// to, stage_remarks.c the words for them.
#ifndef PL_SETS_IMPL_H
#define PL_SETS_IMPL_H

#include "worked/worked_impl.h"

// The analysis of a stage: one that is there, NULL; or else a new one, NULL when it is not derived.
pl_analysis* pl_analysis_find(pl_analysis* first, const pl_stage* s);
pl_analysis* pl_analysis_in(pl_analysis* first, const pl_stage* s);

// A request for the force of an open constraint, or for the place where that vanishes.
bool pl_is_about_open(const pl_analysis* d, const pl_ask* ask, const pl_open* o);
// It names what only a map explains whose constraint does not hold.
bool pl_speaks_of_unnamed(pl_analysis* d, const pl_ask* ask, pl_symbol* which);

bool pl_would_pull(const pl_analysis* d, const pl_open* o);
const pl_form* pl_form_apart(pl_analysis* d, const pl_constraint* c);      // y > 0
const char* pl_stage_seconds(pl_analysis* d, double t, pl_language lang);  // "t = 0.5 s"
// The equation that ends a stage: y = 0, λ = 0, or the condition of an event; NULL: none to show.
const pl_form* pl_form_end(pl_analysis* d, const pl_stage* s);
void pl_say_stage_end(pl_analysis* d, const pl_stage* s);
void pl_tell_friction(pl_analysis* d);  // what sticks, and what slips with which force

#endif
