// The implicit stepper: the slots of the interface.
#include "solve/stepper/radau/radau_impl.h"

#include <math.h>

static int stages_for(double tol) { return tol >= 1e-3 ? 3 : tol >= 1e-8 ? 5 : 7; }

static double tolerance(const pl_run_options* o) { return pl_radau_tol(o->tol); }

static pleuel_status open(pl_run* run) {
  double asked = run->options.tol;
  bool alone = run->options.method == PL_METHOD_RADAU;
  double tol = asked > 0 || alone ? pl_radau_tol(asked) : 1e-12;
  int s = stages_for(tol);
  pl_radau* r = run->radau = PL_NEW(run->job->arena, pl_radau);
  r->method.s = s;
  r->method.n_pairs = s / 2;
  r->tol = tol;
  r->stay_next = 16;
  r->tol_stage = 0.03 * pow(tol, (3 * s + 1) / (4.0 * s));
  return PLEUEL_OK;
}

static bool enter(pl_run* run) { return pl_point_enter(&run->dae); }

static void close(pl_run* run) { pl_radau_free(run->radau); }

const pl_stepper pl_stepper_radau = {.name = "radau",
                                     .tolerance = tolerance,
                                     .open = open,
                                     .poll = pl_stiff_poll,
                                     .enter = enter,
                                     .expand = pl_radau_expand,
                                     .state_at = pl_radau_state_at,
                                     .polynomial = pl_radau_polynomial,
                                     .changed = pl_radau_changed,
                                     .save_state = pl_radau_save,
                                     .close = close};
