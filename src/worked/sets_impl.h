// sets, inside: sets.c says which constraints an analysis has, later_sets.c tells of those that the
// motion comes to.
#ifndef PL_SETS_IMPL_H
#define PL_SETS_IMPL_H

#include "worked/worked_impl.h"

int pl_row_of(const pl_stage* s, const char* name);  // -1: not in it
const char* pl_label_of(const pl_constraint* c);     // as rows of a stage are named
// The analysis of a stage: one that is there, NULL; or else a new one, NULL when it is not derived.
pl_analysis* pl_analysis_find(pl_analysis* first, const pl_stage* s);
pl_analysis* pl_analysis_in(pl_analysis* first, const pl_stage* s);
pl_stage* pl_stage_like(pl_analysis* d);  // the set of constraints of d, as a stage of its own
// The same with the opposite of some signs: those that change come first.
pl_stage* pl_stage_turned(pl_analysis* d, const pl_fact* side, int n, const bool* through);
// A request for the force of an open constraint, or for the place where that vanishes.
bool pl_asks_about_open(const pl_analysis* d, const pl_ask* ask, const pl_open* o);
// It names what only a map explains whose constraint does not hold.
bool pl_speaks_of_unnamed(pl_analysis* d, const pl_ask* ask, pl_symbol* which);
const char* pl_seconds(pl_analysis* d, double t, pl_language lang);  // "t = 0.5 s"
// The equation that ends a stage: y = 0, λ = 0, or the condition of an event; NULL: none to show.
const pl_form* pl_end_form(pl_analysis* d, const pl_stage* s);
void pl_say_end(pl_analysis* d, const pl_stage* s);
void pl_tell_friction(pl_analysis* d);

#endif
