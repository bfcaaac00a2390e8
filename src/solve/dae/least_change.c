// The least change of positions or velocities that meets linear constraints: rows of G are made
// orthogonal one by one, what is held stays.
#include <float.h>
#include <math.h>
#include <string.h>

#include "solve/dae/dae.h"

static const double dependent = 1e-10;  // of a row: what is left of it when it says nothing new
static const double met = 1e-9;         // residual of a constraint relative to its terms

// Minimum-norm correction of the free components that removes the residuals: Gram-Schmidt on the
// rows.
bool pl_least_change(const pl_dae* dae, const bool* held, const double* residual,
                     const double* size, bool positions, double* basis, double* change) {
  int n = dae->n_q, rank = 0;
  for (int i = 0; i < n; i++) change[i] = 0;
  for (int c = 0; c < dae->n_c; c++) {
    if (dae->row_of[c] < 0 || (positions && dae->setup->constraints[c].velocity)) continue;
    double *w = basis + (size_t)rank * (size_t)n, left = -residual[c], length = 0, most = 0;
    const double* row = dae->rows + (size_t)dae->row_of[c] * (size_t)n;
    for (int i = 0; i < n; i++) {
      w[i] = held[i] ? 0 : row[i];
      most = fmax(most, fabs(row[i]));
    }
    for (int twice = 0; twice < 2; twice++) {
      for (int k = 0; k < rank; k++) {
        const double* u = basis + (size_t)k * (size_t)n;
        double along = 0;
        for (int i = 0; i < n; i++) along += u[i] * w[i];
        for (int i = 0; i < n; i++) w[i] -= along * u[i];
      }
    }
    // what the change so far does to this row
    for (int i = 0; i < n; i++) left -= held[i] ? 0 : row[i] * change[i];
    for (int i = 0; i < n; i++) length += w[i] * w[i];
    length = sqrt(length);
    if (length <= dependent * most) {
      if (fabs(left) > met * fmax(size[c], DBL_MIN)) return false;
      continue;
    }
    double along = 0;
    for (int i = 0; i < n; i++) along += w[i] * (held[i] ? 0 : row[i]);
    for (int i = 0; i < n; i++) change[i] += w[i] * left / along;
    for (int i = 0; i < n; i++) w[i] /= length;
    rank++;
  }
  return true;
}
