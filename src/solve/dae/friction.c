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
#include "solve/solve_impl.h"

#include <math.h>
#include <string.h>

void pl_friction_make(pl_run* run) {
  pl_arena* a = run->job->arena;
  const pl_setup* s = run->setup;
  size_t c = (size_t)run->n_c, n = (size_t)s->n_frictions, orders = (size_t)run->order + 2;
  run->friction = PL_ARRAY(a, pl_friction_state, n + 1);
  run->friction_before = PL_ARRAY(a, pl_friction_state, n + 1);
  run->friction_fixed = PL_ARRAY(a, unsigned, n + 1);
  run->C_series = PL_ARRAY(a, double, (size_t)s->n_coefficients* orders + 1);
  run->S_series = PL_ARRAY(a, double, n > 0 ? c * orders + 1 : 1);
  run->poly_2 = PL_ARRAY(a, double, 3 * orders + 1);
  for (int i = 0; i < s->n_frictions; i++)
    run->friction[i].press = s->constraints[s->frictions[i].constraint].side < 0 ? -1 : 1;
  run->has_W |= s->n_frictions > 0;  // the factor of a projection does not serve the accelerations
}

bool pl_friction_is_used(const pl_run* run, int r) {
  return run->active[run->setup->frictions[r].constraint];
}

void pl_friction_activate(pl_run* run) {
  run->n_slipping = 0;
  for (int r = 0; r < run->setup->n_frictions; r++) {
    const pl_friction_setup* friction = &run->setup->frictions[r];
    if (!pl_friction_is_used(run, r)) run->friction[r].state = PL_FRICTION_OFF;
    for (int i = 0; i < friction->n_rows; i++) {
      int c = friction->row[i];
      run->active[c] = run->on[c] = run->friction[r].state == PL_FRICTION_STICK;
      run->slips[c] = run->friction[r].state == PL_FRICTION_SLIP;
      run->n_active += run->active[c];
      run->n_slipping += run->slips[c];
    }
  }
}

void pl_friction_coefficients(pl_run* run, int k) {
  int n = run->setup->n_coefficients;
  pl_batches_outputs(&run->motion, run->C_series + (size_t)k * (size_t)n, n, k);
}

// In space a slip that ends at the end of this step has no direction there: it keeps the one it
// had.
void pl_friction_keep_directions(pl_run* run) {
  for (int i = 0; i < run->n_watch; i++) {
    if (!run->hit[i] || run->watch[i].kind != PL_WATCH_STICK) continue;
    int r = run->watch[i].index;
    pl_friction_state* now = &run->friction[r];
    now->given = run->setup->frictions[r].n_rows == 3
                 && pl_friction_speed(run, r, run->S_series, now->d) > 0;
  }
}

// ---------------------------------------------------------------------------- in the linear system
double pl_friction_kappa(const pl_run* run, int r, int i, const double* C) {
  const pl_friction_setup* friction = &run->setup->frictions[r];
  const pl_friction_state* now = &run->friction[r];
  if (friction->n_rows == 1) return -now->press * now->way * C[friction->scale];
  return now->given ? -now->press * now->d[i] * C[friction->scale]
                    : -now->press * C[friction->along[i]];
}

// The derivative of κ by one coefficient.
double pl_friction_kappa_by(const pl_run* run, int r, int i, int coefficient) {
  const pl_friction_setup* friction = &run->setup->frictions[r];
  const pl_friction_state* now = &run->friction[r];
  bool by_scale = friction->n_rows == 1 || now->given;
  if (coefficient != (by_scale ? friction->scale : friction->along[i])) return 0;
  return -now->press * (friction->n_rows == 1 ? now->way : now->given ? now->d[i] : 1);
}

static double kappa(const pl_run* run, int r, int i, int k) {
  return pl_friction_kappa(run, r, i,
                           run->C_series + (size_t)k * (size_t)run->setup->n_coefficients);
}

void pl_friction_matrix(pl_run* run) {
  for (int r = 0; r < run->setup->n_frictions; r++) {
    const pl_friction_setup* friction = &run->setup->frictions[r];
    for (int i = 0; i < friction->n_rows && run->friction[r].state == PL_FRICTION_SLIP; i++)
      run->kkt.value[run->at_friction[friction->row[i]]] = -kappa(run, r, i, 0);
  }
}

void pl_friction_rhs(pl_run* run, int k, double* rhs) {
  for (int r = 0; r < run->setup->n_frictions; r++) {
    const pl_friction_setup* friction = &run->setup->frictions[r];
    for (int i = 0; i < friction->n_rows && run->friction[r].state == PL_FRICTION_SLIP; i++) {
      double sum = 0;
      for (int j = 1; j <= k; j++)
        sum += kappa(run, r, i, j)
               * run->L[(size_t)(k - j) * (size_t)run->n_c + (size_t)friction->constraint];
      rhs[run->n_q + friction->row[i]] = -sum;  // the unknowns are -λ
    }
  }
}

// ------------------------------------------------------------------------------------------- sizes
double pl_friction_force(const pl_run* run, int r, const double* m) {
  const pl_friction_setup* friction = &run->setup->frictions[r];
  const double* P = run->C_series;
  if (friction->n_rows == 1) return fabs(m[friction->row[0]]);
  double x = m[friction->row[0]], y = m[friction->row[1]], z = m[friction->row[2]];
  double square = P[friction->metric[0]] * x * x + P[friction->metric[1]] * y * y
                  + P[friction->metric[2]] * z * z
                  + 2
                        * (P[friction->metric[3]] * x * y + P[friction->metric[4]] * x * z
                           + P[friction->metric[5]] * y * z);
  return sqrt(fmax(square, 0));
}

double pl_friction_speed(const pl_run* run, int r, const double* rates, double* d) {
  const pl_friction_setup* friction = &run->setup->frictions[r];
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

// ----------------------------------------------------------------------- series of what is watched
// c += f a b for series of n coefficients with their strides.
static void add_product(double* c, double f, const double* a, size_t at_a, const double* b,
                        size_t at_b, int n) {
  for (int k = 0; k < n; k++) {
    double sum = 0;
    for (int j = 0; j <= k; j++) sum += a[(size_t)j * at_a] * b[(size_t)(k - j) * at_b];
    c[k] += f * sum;
  }
}

static void clear(double* c, int n) { memset(c, 0, (size_t)n * sizeof *c); }

// limit² λ² - |F|²
static void force_left(const pl_run* run, const pl_friction_setup* friction, double* c, int n) {
  double *u = run->poly_2, *w = u + run->order + 2;
  size_t n_c = (size_t)run->n_c, n_C = (size_t)run->setup->n_coefficients;
  clear(u, n);
  add_product(u, 1, run->C_series + friction->limit, n_C, run->L + friction->constraint, n_c, n);
  clear(c, n);
  add_product(c, 1, u, 1, u, 1, n);
  if (friction->n_rows == 1) {
    add_product(c, -1, run->L + friction->row[0], n_c, run->L + friction->row[0], n_c, n);
    return;
  }
  static const int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
  for (int p = 0; p < 6; p++) {
    clear(w, n);
    add_product(w, 1, run->L + friction->row[pair[p][0]], n_c, run->L + friction->row[pair[p][1]],
                n_c, n);
    add_product(c, p < 3 ? -1 : -2, run->C_series + friction->metric[p], n_C, w, 1, n);
  }
}

int pl_friction_slip(const pl_run* run, int r, pl_watch_kind kind, double* c, int n) {
  const pl_friction_setup* friction = &run->setup->frictions[r];
  const pl_friction_state* now = &run->friction[r];
  size_t n_c = (size_t)run->n_c;
  if (kind == PL_WATCH_SLIP) {
    force_left(run, friction, c, n - 1);
    return n - 1;
  }
  if (kind == PL_WATCH_PRESS) {
    for (int k = 0; k < n - 1; k++)
      c[k] = now->press * run->L[(size_t)k * n_c + (size_t)friction->constraint];
    return n - 1;
  }
  if (friction->n_rows == 1) {
    for (int k = 0; k < n; k++)
      c[k] = now->way * run->S_series[(size_t)k * n_c + (size_t)friction->row[0]];
    return n;
  }
  clear(c, n);
  for (int i = 0; i < 3; i++)
    add_product(c, 1, run->S_series + friction->row[i], n_c, run->S_series + friction->row[i], n_c,
                n);
  c[0] -= now->small * now->small;
  return n;
}
