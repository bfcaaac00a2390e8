// The implicit stepper: Radau IIA, for stiff motions.
#ifndef PL_RADAU_H
#define PL_RADAU_H

#include "solve/stepper/stepper.h"

extern const pl_stepper pl_stepper_radau;

#endif
