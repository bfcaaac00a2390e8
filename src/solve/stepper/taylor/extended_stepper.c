// The Taylor stepper in extended precision: the slots of the interface.
#include "solve/stepper/taylor/extended_impl.h"

#include <math.h>
#include <string.h>

// ------------------------------------------------------------------------------------- the numbers
static double floor_of(const pl_run* run) { return run->extended->floor; }
static double epsilon_of(const pl_run* run) { return run->extended->state->epsilon; }

static bool enter(pl_run* run) {
  run->dae.t_series = run->dae.t;
  size_t n = (size_t)run->n_q * sizeof(double);
  memcpy(run->dae.Q, run->dae.q, n);
  memcpy(run->dae.V, run->dae.v, n);
  return run->dae.at_point && pl_extended_enter(run);
}

static double length(pl_run* run) {
  const double *q, *v;
  pl_extended_norms(run, &q, &v);
  return pl_extended_vary(run, pl_series_length(run, q, v));
}

static void advance(pl_run* run, double h, bool at_root, pl_projection* p) {
  pl_extended_advance(run, h);
  if (at_root) pl_extended_refine(run, h);
  pl_extended_project(run, p);
}

static bool defect(pl_run* run, double h, double* off, double* size) {
  (void)h;
  return pl_extended_arrive(run, off, size);
}

// Extended numbers come closer to a singular position than doubles.
static const pl_taylor_numbers extended = {.floor = floor_of,
                                           .epsilon = epsilon_of,
                                           .near_singular = 1e-8,
                                           .refines_roots = true,
                                           .enter = enter,
                                           .expand = pl_extended_expand,
                                           .length = length,
                                           .advance = advance,
                                           .defect = defect};

// --------------------------------------------------------------------------------------- the slots
// The tolerance below which rounding, not truncation, decides. In long, what is cut off is to stay
// far below the rounding of the state, since it has a direction and that has none.
static double tolerance(const pl_run_options* o) {
  return fmax(o->tol, o->precision == PL_PRECISION_LONG ? 1e-23 : 1e-34);
}

static pleuel_status begin(pl_run* run, double t) {
  PL_TRY(pl_extended_begin(run, t));
  pl_step_program_update(run);
  return PLEUEL_OK;
}

static pleuel_status expand(pl_run* run, pl_stepper_step* s) {
  return pl_taylor_step_expand(run, s, &extended);
}

static pleuel_status state_at(pl_run* run, pl_stepper_step* s) {
  return pl_taylor_step_state_at(run, s, &extended);
}

static void row_between(pl_run* run, double t, long n, pl_row* r, double* out) {
  if (n >= 0) pl_extended_grid_row(run, n, r, out);
  else pl_extended_row_at(run, t, r, out);
}

const pl_stepper pl_stepper_extended = {.name = "taylor, extended precision",
                                        .tolerance = tolerance,
                                        .to_rounding = true,
                                        .plan = pl_extended_order,
                                        .open = pl_extended_check,
                                        .begin = begin,
                                        .enter = enter,
                                        .expand = expand,
                                        .state_at = state_at,
                                        .accept = pl_extended_accept,
                                        .row = pl_extended_row,
                                        .row_between = row_between,
                                        .energy = pl_extended_energy,
                                        .save_setup = pl_step_program_save,
                                        .save_state = pl_extended_save,
                                        .close = pl_step_program_free};
