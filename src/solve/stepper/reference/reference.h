// The reference stepper: fixed steps of the classical Runge-Kutta method.
#ifndef PL_REFERENCE_H
#define PL_REFERENCE_H

#include "solve/stepper/stepper.h"

extern const pl_stepper pl_stepper_reference;

#endif
