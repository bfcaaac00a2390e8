// The right side of a generated system as a shared library, for SciPy.
#include "peer_common.h"

int peer_size(void) { return N_Y; }
void peer_start(double* y) { start(y); }
void peer_slope(double t, const double* y, double* f) { slope(t, y, f); }
void peer_jacobian(double t, const double* y, double* J) {
#ifndef WITHOUT_JACOBIAN
  jacobian(t, y, J);
#else
  (void)t;
  (void)y;
  (void)J;
#endif
}
