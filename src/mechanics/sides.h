// sides: signs of places and velocities that an analysis took for granted, |x - a| = x - a.
#ifndef PL_SIDES_H
#define PL_SIDES_H

#include "mechanics/mechanics.h"

int pl_taken_sides(pl_analysis* d, const pl_fact** out);  // of this analysis, so far
// It does not speak of velocities.
bool pl_side_is_of_place(const pl_analysis* d, const pl_fact* f);
// The sides of an analysis and of what is proposed beside it, over names that the simulation knows;
// at most 2 pl_max_sides.
int pl_known_sides(pl_analysis* d, pl_fact* out);
// what the stage takes for granted d does too
bool pl_same_sides(pl_analysis* d, const pl_stage* s);

#endif
