// Inside of the implicit method: Radau IIA on the index-2 form, its coefficients, its linear systems, its steps.
#ifndef PL_RADAU_IMPL_H
#define PL_RADAU_IMPL_H

#include "solve/solve_impl.h"

enum {
  PL_RADAU_MOST = 7,        // stages
  PL_RADAU_PAIRS = 3        // of complex eigenvalues
};

// Coefficients of the method with s stages, order 2 s - 1.
typedef struct pl_radau_method {
  int s, n_pairs;
  double c[PL_RADAU_MOST];
  double A[PL_RADAU_MOST][PL_RADAU_MOST];            // Runge-Kutta matrix
  double inverse[PL_RADAU_MOST][PL_RADAU_MOST];      // of A
  double power_all[PL_RADAU_MOST + 1][PL_RADAU_MOST + 1];   // row k: coefficient k of the polynomial in t/h through
                                                            // values at 0 and all c_i
  double error[PL_RADAU_MOST];                       // of the increments in the estimate of the error
  // A^-1 = X diag(γ_0, γ_1, conj γ_1, ...) X^-1: of each pair one stands here, re and im
  double gamma[1 + PL_RADAU_PAIRS][2];
  double X[1 + PL_RADAU_PAIRS][PL_RADAU_MOST][2];    // columns of X
  double Y[1 + PL_RADAU_PAIRS][PL_RADAU_MOST][2];    // rows of X^-1
} pl_radau_method;

// Values of a motion batch at several stages, or its derivatives in several directions, side by side.
typedef struct pl_radau_wide {
  const pl_batch* batch;
  pl_jet* jet;              // of its own for a single instance: lanes are stages or directions.  Else that of the batch
} pl_radau_wide;

// Derivatives at a point; dense, column-major.
typedef struct pl_radau_slopes {
  double *M, *D, *K;        // mass, dF/dv, dF/dq                         (n_q x n_q)
  double *G, *S;            // constraint gradient, d(G v + dg/dt)/dq     (n_c x n_q)
  double* B;                // G^T + W                                    (n_q x n_c)
} pl_radau_slopes;

enum { PL_RADAU_COUPLED_UP_TO = 700 };   // unknowns of all stages together: above they are only split

struct pl_radau {
  pl_radau_method method;
  int n, n_q, n_c;
  double tol, tol_stage;    // asked for; of the estimate, which is of lower order than the step
  pl_radau_wide* wide;      // one for each batch of the motion
  pl_radau_slopes here;     // at the start of the step; for the way back onto the constraints, at its end
  pl_radau_slopes at[PL_RADAU_MOST];   // at each stage, for the coupled iteration
  double* coupled;          // its matrix (s n x s n), NULL when too large
  double *coupled_scale, *coupled_rhs, *coupled_work;
  int* coupled_pivot;
  bool couples;             // the iteration at work
  long stay;                // so many steps until the split one is tried again
  long stay_next;
  // factors of the transformed systems
  double *real, *real_scale, *work;
  double* pair[PL_RADAU_PAIRS];
  double* pair_scale[PL_RADAU_PAIRS];
  int* pivot[1 + PL_RADAU_PAIRS];
  double h_factored;
  bool has_jacobian, has_factor, has_last;
  // stages; stage i at i n_q, i n_c
  double *Z, *Q, *V, *A, *L, *t;     // increments of v, positions, velocities, accelerations, multipliers, times
  double* F;                // residuals: of motion (n_q), of constraints (n_c)          (s x n)
  double* w[1 + PL_RADAU_PAIRS];     // transformed residuals and corrections (n or 2 n)
  double *error_q, *error_v, *rhs;
  double *sc_q, *sc_v;      // what the error of a component is measured by, without the tolerance
  double rounding;          // of velocities at stages, absolute
  double h, h_last, error_last, theta;
  int newton, newton_last;
  bool rejected;            // the step before
  long steps_in_row;
  bool ready;               // coefficients computed
  long looks, next_look;    // at stiffness
  double cost_series;       // of the series per time, at the last look
  int dear;                 // implicit steps in a row that cost more
  double h_dense;           // step up to which the polynomial is as exact as the tolerance
};

// ---- radau_method.c
void pl_radau_method_make(pl_radau_method* m, int s);

// ---- radau_system.c
pl_radau* pl_radau_reserve(pl_run* run, int s);
void pl_radau_ready(pl_radau* r);                           // computes the coefficients when they are first needed
void pl_radau_slopes_at(pl_run* run, pl_radau* r, pl_radau_slopes* J, double t, const double* q, const double* v,
                        const double* a, const double* lambda);
bool pl_radau_factor(pl_radau* r, const pl_run* run, double h);
void pl_radau_residual(pl_run* run, pl_radau* r);           // F at the stages
void pl_radau_solve_real(pl_radau* r, double* b);
void pl_radau_correct(pl_radau* r, const pl_run* run);      // one simplified Newton step; F becomes the correction
bool pl_radau_couple(pl_run* run, pl_radau* r, double h);   // slopes at all stages, the coupled matrix and its factor
void pl_radau_correct_coupled(pl_radau* r, const pl_run* run);

// ---- radau_step.c
bool pl_radau_probe(pl_run* run, double h, double least, double* reach);

// ---- stiff_detect.c
void pl_stiff_review(pl_run* run, double h);

#endif
