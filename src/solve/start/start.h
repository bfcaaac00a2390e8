// The consistent start: positions and velocities that meet the constraints.
#ifndef PL_START_H
#define PL_START_H

#include "solve/event/event.h"

typedef struct pl_start pl_start;

// Finds positions and velocities at t_0 and leaves them in the run: given values are held, the rest
// moves from its guess.
pleuel_status pl_start_find(pl_run* run, pl_start** out);
// Lists in the report what the start moved and which contacts it closed, when the motion has begun.
void pl_start_list(pl_start* s);

#endif
