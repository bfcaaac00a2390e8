// GSL, Prince and Dormand's method of order 8 (rk8pd) on the reduced equations.  Usage: peer_gsl
// rk8pd TOLERANCE END
#include "peer_common.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

static double tolerance, end;

static int right_side(double t, const double y[], double f[], void* user) {
  (void)user;
  slope(t, y, f);
  return GSL_SUCCESS;
}

static long once(double* us, double* y) {
  gsl_odeiv2_system system = {right_side, NULL, N_Y, NULL};
  gsl_odeiv2_driver* d = gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, 1e-3 * end,
                                                       tolerance, tolerance);
  double t = 0;
  start(y);
  double begin = cpu_us();
  int failed = gsl_odeiv2_driver_apply(d, &t, end, y);
  *us = cpu_us() - begin;
  long steps = (long)d->n;
  gsl_odeiv2_driver_free(d);
  return failed ? -1 : steps;
}

int main(int argc, char** argv) {
  if (argc < 4) return 1;
  gsl_set_error_handler_off();
  tolerance = atof(argv[2]);
  end = atof(argv[3]);
  return report(once);
}
