// Coulomb friction inside of the equations of motion.
//
// The slip velocity s = A v + b of a friction is a set of rows like those of a nonholonomic
// constraint, and its force on the coordinates is A^T m. While the surfaces stick the rows hold as
// constraints and m is their multiplier. While they slip m follows from the multiplier λ that
// presses:
//
//     m = -μ ν |λ| s / |s|,      ν: force of the constraint per unit of λ
//
// so its row in the linear system reads m - κ λ = 0 with κ = -press μ ν s / |s|, and at order k of
// the series
//
//     m_k - κ_0 λ_k = sum_{j>=1} κ_j λ_{k-j}.
//
// The system is then no longer symmetric, and it may be singular or have the wrong sign: Painlevé's
// configurations, which the choice of the mode (contacts.c) finds.
// See theory (13.3), (13.4).
#include "solve/dae/dae.h"

#include <math.h>
#include <string.h>

void pl_friction_make(pl_dae* dae) {
  pl_arena* a = dae->job->arena;
  const pl_setup* s = dae->setup;
  size_t n = (size_t)s->n_frictions, orders = (size_t)dae->order + 2;
  dae->friction = PL_ARRAY(a, pl_friction_state, n + 1);
  dae->C_series = PL_ARRAY(a, double, (size_t)s->n_coefficients* orders + 1);
  for (int i = 0; i < s->n_frictions; i++)
    dae->friction[i].press = s->constraints[s->frictions[i].constraint].side < 0 ? -1 : 1;
  dae->has_W |= s->n_frictions > 0;  // the factor of a projection does not serve the accelerations
}

bool pl_friction_is_used(const pl_dae* dae, int r) {
  return dae->active[dae->setup->frictions[r].constraint];
}

void pl_friction_activate(pl_dae* dae) {
  dae->n_slipping = 0;
  for (int r = 0; r < dae->setup->n_frictions; r++) {
    const pl_friction_setup* friction = &dae->setup->frictions[r];
    if (!pl_friction_is_used(dae, r)) dae->friction[r].state = PL_FRICTION_OFF;
    for (int i = 0; i < friction->n_rows; i++) {
      int c = friction->row[i];
      dae->active[c] = dae->on[c] = dae->friction[r].state == PL_FRICTION_STICK;
      dae->slips[c] = dae->friction[r].state == PL_FRICTION_SLIP;
      dae->n_active += dae->active[c];
      dae->n_slipping += dae->slips[c];
    }
  }
}

void pl_friction_coefficients(pl_dae* dae, int k) {
  int n = dae->setup->n_coefficients;
  pl_batches_outputs(&dae->motion, dae->C_series + (size_t)k * (size_t)n, n, k);
}

// ---------------------------------------------------------------------------- in the linear system
double pl_friction_kappa(const pl_dae* dae, int r, int i, const double* C) {
  const pl_friction_setup* friction = &dae->setup->frictions[r];
  const pl_friction_state* now = &dae->friction[r];
  if (friction->n_rows == 1) return -now->press * now->way * C[friction->scale];
  return now->given ? -now->press * now->d[i] * C[friction->scale]
                    : -now->press * C[friction->along[i]];
}

// The derivative of κ by one coefficient.
double pl_friction_kappa_by(const pl_dae* dae, int r, int i, int coefficient) {
  const pl_friction_setup* friction = &dae->setup->frictions[r];
  const pl_friction_state* now = &dae->friction[r];
  bool by_scale = friction->n_rows == 1 || now->given;
  if (coefficient != (by_scale ? friction->scale : friction->along[i])) return 0;
  return -now->press * (friction->n_rows == 1 ? now->way : now->given ? now->d[i] : 1);
}

static double kappa(const pl_dae* dae, int r, int i, int k) {
  return pl_friction_kappa(dae, r, i,
                           dae->C_series + (size_t)k * (size_t)dae->setup->n_coefficients);
}

void pl_friction_matrix(pl_dae* dae) {
  for (int r = 0; r < dae->setup->n_frictions; r++) {
    const pl_friction_setup* friction = &dae->setup->frictions[r];
    for (int i = 0; i < friction->n_rows && dae->friction[r].state == PL_FRICTION_SLIP; i++)
      dae->kkt.value[dae->at_friction[friction->row[i]]] = -kappa(dae, r, i, 0);
  }
}

void pl_friction_rhs(pl_dae* dae, int k, double* rhs) {
  for (int r = 0; r < dae->setup->n_frictions; r++) {
    const pl_friction_setup* friction = &dae->setup->frictions[r];
    for (int i = 0; i < friction->n_rows && dae->friction[r].state == PL_FRICTION_SLIP; i++) {
      double sum = 0;
      for (int j = 1; j <= k; j++)
        sum += kappa(dae, r, i, j)
               * dae->L[(size_t)(k - j) * (size_t)dae->n_c + (size_t)friction->constraint];
      rhs[dae->n_q + friction->row[i]] = -sum;  // the unknowns are -λ
    }
  }
}

// ------------------------------------------------------------------------------------------- sizes
double pl_friction_force(const pl_dae* dae, int r, const double* m) {
  const pl_friction_setup* friction = &dae->setup->frictions[r];
  const double* P = dae->C_series;
  if (friction->n_rows == 1) return fabs(m[friction->row[0]]);
  double x = m[friction->row[0]], y = m[friction->row[1]], z = m[friction->row[2]];
  double square = P[friction->metric[0]] * x * x + P[friction->metric[1]] * y * y
                  + P[friction->metric[2]] * z * z
                  + 2
                        * (P[friction->metric[3]] * x * y + P[friction->metric[4]] * x * z
                           + P[friction->metric[5]] * y * z);
  return sqrt(fmax(square, 0));
}

double pl_friction_speed(const pl_dae* dae, int r, const double* rates, double* d) {
  const pl_friction_setup* friction = &dae->setup->frictions[r];
  double square = 0, most = 0;
  for (int i = 0; i < friction->n_rows; i++) most = fmax(most, fabs(rates[friction->row[i]]));
  if (most == 0) {
    for (int i = 0; i < friction->n_rows; i++) d[i] = 0;
    return 0;
  }
  for (int i = 0; i < friction->n_rows; i++)
    square += (rates[friction->row[i]] / most) * (rates[friction->row[i]] / most);
  double speed = most * sqrt(square);
  for (int i = 0; i < friction->n_rows; i++) d[i] = rates[friction->row[i]] / speed;
  return speed;
}
