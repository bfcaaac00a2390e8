// witness: what a derivation states, held against the motion that the simulation makes of the same
// text.
//
// The derivation is certified against the model as it understood it (worked/claims.c). Here the
// model is read on another way: raw constraints at index 3, contacts by their sign. What disagrees
// is withdrawn: a sentence stands in its place.
#ifndef PL_WITNESS_H
#define PL_WITNESS_H

#include "worked/worked.h"
#include "witness/trace.h"

// pl_witness_hold tests the answers of a solution. Adds the check "formulas against the motion" and
// withdraws sections that disagree. Needs the solution's towers. stages: those that it was derived
// with, NULL if none were known.
void pl_witness_hold(pl_job* job, pl_solution* solution, const pl_stage* stages, int n_stages);

#endif
