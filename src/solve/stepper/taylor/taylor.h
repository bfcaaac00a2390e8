// The Taylor steppers: series of the motion at a point [JorbaZou2005], in doubles or in extended
// precision.
#ifndef PL_TAYLOR_H
#define PL_TAYLOR_H

#include "solve/stepper/stepper.h"

extern const pl_stepper pl_stepper_taylor;    // doubles: by the patterns, or by a step program
extern const pl_stepper pl_stepper_extended;  // extended precision

// ---- taylor_double.c: what other steppers borrow
// The series at the point, whose order 0 is known, to all orders.
void pl_taylor_expand(pl_run* run);
// The step that the series allows.
double pl_taylor_length(pl_run* run);

#endif
