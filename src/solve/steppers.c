// Which steppers a run has, by method and precision.  A new stepper is a line here.
#include "solve/driver_impl.h"
#include "solve/stepper/radau/radau.h"
#include "solve/stepper/reference/reference.h"
#include "solve/stepper/taylor/taylor.h"

static void add(pl_run* run, const pl_stepper* s) { run->steppers[run->n_steppers++] = s; }

void pl_steppers_choose(pl_run* run) {
  const pl_run_options* o = &run->options;
  run->n_steppers = 0;
  if (o->method == PL_METHOD_REFERENCE) {
    run->stepper = &pl_stepper_reference;
    add(run, &pl_stepper_reference);
    return;
  }
  bool extended = o->precision != PL_PRECISION_DOUBLE;
  run->stepper = extended                       ? &pl_stepper_extended
                 : o->method == PL_METHOD_RADAU ? &pl_stepper_radau
                                                : &pl_stepper_taylor;
  add(run, extended ? &pl_stepper_extended : &pl_stepper_taylor);
  // the implicit method takes its first step from the series
  if (!extended && o->method != PL_METHOD_TAYLOR) add(run, &pl_stepper_radau);
}
