// Inside of the implicit method: Radau IIA on the index-2 form, its coefficients, its linear
// systems, its steps.
#ifndef PL_RADAU_IMPL_H
#define PL_RADAU_IMPL_H

#include "solve/event/event.h"
#include "solve/stepper/radau/radau.h"
#include "solve/stepper/taylor/taylor.h"

enum {
  PL_RADAU_MOST = 7,  // stages
  PL_RADAU_PAIRS = 3  // of complex eigenvalues
};

// Coefficients of the method with s stages, order 2 s - 1.
typedef struct pl_radau_method {
  int s, n_pairs;
  double c[PL_RADAU_MOST];
  double A[PL_RADAU_MOST][PL_RADAU_MOST];        // Runge-Kutta matrix
  double inverse[PL_RADAU_MOST][PL_RADAU_MOST];  // of A
  // row k: coefficient k of the polynomial in t/h through
  double power_all[PL_RADAU_MOST + 1][PL_RADAU_MOST + 1];
  // values at 0 and all c_i
  // of the increments in the estimate of the error
  double error[PL_RADAU_MOST];
  // A^-1 = X diag(γ_0, γ_1, conj γ_1, ...) X^-1: of each pair one stands here, re and im
  double gamma[1 + PL_RADAU_PAIRS][2];
  double X[1 + PL_RADAU_PAIRS][PL_RADAU_MOST][2];  // columns of X
  double Y[1 + PL_RADAU_PAIRS][PL_RADAU_MOST][2];  // rows of X^-1
} pl_radau_method;

// Values of a motion batch at several stages, or its derivatives in several directions, side by
// side.
typedef struct pl_radau_lanes {
  const pl_batch* batch;
  // of its own for a single instance: lanes are stages or directions.  Else that of the batch
  pl_jet* jet;
} pl_radau_lanes;

// Where the entries of an n x n matrix stand: dense and column-major, or along a structure.
typedef struct pl_radau_shape {
  int n, n_values;
  int *start, *row;  // compressed columns, rows ascending; NULL: dense
} pl_radau_shape;

// Derivatives of F (n_q rows) and C (n_c rows) at a point, by A^-1 (P0), directly (P1) and by A
// (P2), each n x n:
//
//   M 0      D  -B     K 0
//   0 0      G   E     S 0       G, S: of C by v, q;  B = G^T + W;  E: of C by λ (slip)
typedef struct pl_radau_slopes {
  double *P0, *P1, *P2;
} pl_radau_slopes;

enum {
  PL_RADAU_DENSE_UP_TO = 100,   // unknowns: dense systems below, sparse ones above
  PL_RADAU_COUPLED_UP_TO = 700  // unknowns of all stages together: above they are only split
};

typedef struct pl_radau pl_radau;
struct pl_radau {
  pl_radau_method method;
  int n, n_q, n_c, n_C;   // n_C: coefficients of friction
  double tol, tol_stage;  // asked for; of the estimate, which is of lower order than the step
  pl_radau_shape shape;
  pl_radau_lanes* lanes;  // one for each batch of the motion
  // at the start of the step; for the way back onto the constraints, at its end
  pl_radau_slopes here;
  pl_radau_slopes at[PL_RADAU_MOST];  // at each stage, for the coupled iteration
  double* coupled;                    // its matrix (s n x s n), NULL when too large
  double *coupled_scale, *coupled_rhs, *coupled_work;
  int* coupled_pivot;
  bool couples;  // the iteration at work
  long stay;     // so many steps until the split one is tried again
  long stay_next;
  double* coefficient;  // of friction at the stages                            (s x n_C)
  double* part;         // of C that the rows of one instance contribute         (n_C)
  int* friction_of;     // friction of each coefficient                          (n_C)
  // factors of the transformed systems
  double *real, *real_scale, *work;
  double* pair[PL_RADAU_PAIRS];
  double* pair_scale[PL_RADAU_PAIRS];
  int* pivot[1 + PL_RADAU_PAIRS];
  pl_sparse* sparse;  // the same for large systems
  pl_zsparse* sparse_pair[PL_RADAU_PAIRS];
  double h_factored;
  bool has_jacobian, has_factor, has_last;
  // stages; stage i at i n_q, i n_c
  // increments of v, positions, velocities, accelerations, multipliers, times
  double *Z, *Q, *V, *A, *L, *t;
  double* F;  // residuals: of motion (n_q), of constraints (n_c)          (s x n)
  double* w[1 + PL_RADAU_PAIRS];  // transformed residuals and corrections (n or 2 n)
  double *error_q, *error_v, *rhs;
  double *sc_q, *sc_v;  // what the error of a component is measured by, without the tolerance
  double rounding;      // of velocities at stages, absolute
  double h, h_last, error_last, theta;
  // of the step on its way: its error, the length that follows, the length chosen and that held
  double error, next, chosen, full;
  int newton, newton_last;
  bool rejected;  // the step before
  long steps_in_row;
  bool ready, fits;       // reserved, coefficients computed; the structure could be analysed
  long looks, next_look;  // at stiffness
  double cost_series;     // of the series per time, at the last look
  int dear;               // implicit steps in a row that cost more
  double h_dense;         // step up to which the polynomial is as exact as the tolerance
  // what is watched: values at the start and at the stages      (n_watch x (s + 1))
  double* watched;
  double watched_h;  // length of that step
  // the same of what changes its branch                    (n_switches x (s + 1))
  double* bent;
  double *first_g, *last_g, *last_size;  // g at both ends                         (n_c)
  // accelerations and multipliers at the end; those of the start
  double *end_a, *end_l, *save_a, *save_l;
};

// ---- radau_method.c
void pl_radau_method_make(pl_radau_method* m, int s);

static inline double* pl_radau_stage(double* x, int i, int n) { return x + (size_t)i * (size_t)n; }
// Whether a row has a multiplier: it holds, or it is a slip whose force follows from another.
static inline bool pl_radau_has_force(const pl_run* run, int c) {
  return run->dae.taken[c] || run->dae.slips[c];
}

// ---- radau_system.c
// reserves everything when it is first needed
bool pl_radau_ready(pl_run* run);
void pl_radau_residual(pl_run* run, pl_radau* r);  // F at the stages
void pl_radau_sweep(pl_jet* jet, int k);           // what M, h, G, W need
void pl_radau_load_instances(const pl_radau_lanes* w, double t, const double* q, const double* v);

// ---- radau_shape.c
void pl_radau_shape_make(pl_run* run, pl_radau* r);
static inline size_t pl_radau_place(const pl_radau_shape* s, int row, int col) {
  if (s->start == NULL) return (size_t)row + (size_t)col * (size_t)s->n;
  int lo = s->start[col], hi = s->start[col + 1] - 1;
  while (lo < hi) {
    int mid = (lo + hi) / 2;
    if (s->row[mid] < row) lo = mid + 1;
    else hi = mid;
  }
  return (size_t)lo;
}

// ---- radau_slopes.c
void pl_radau_slopes_at(pl_run* run, pl_radau* r, pl_radau_slopes* J, double t, const double* q,
                        const double* v, const double* a, const double* lambda);

// ---- radau_factor.c
bool pl_radau_factor(pl_radau* r, const pl_run* run, double h);
void pl_radau_solve_real(pl_radau* r, double* b);
void pl_radau_multiply(const pl_radau_shape* s, double* b, double factor, const double* P,
                       const double* x,
                       // b += factor P x for the first n columns
                       int n);
// one simplified Newton step; F becomes the correction
void pl_radau_correct(pl_radau* r, const pl_run* run);
// slopes at all stages, the coupled matrix and its factor
bool pl_radau_couple(pl_run* run, pl_radau* r, double h);
void pl_radau_correct_coupled(pl_radau* r, const pl_run* run);

// ---- radau_events.c
// values of what is watched on the step held, end_a, end_l
// coefficients of what is watched on the step, in units of it
int pl_radau_polynomial(const pl_run* run, int watch, double* c);
void pl_radau_watch(pl_run* run, pl_radau* r, double h);
pleuel_status pl_radau_stop_at_switches(pl_run* run, pl_radau* r, double* h, pl_projection* p);
pleuel_status pl_radau_land(pl_run* run, pl_radau* r, double* h, double* root, pl_projection* p);

// ---- radau_step.c
pleuel_status pl_radau_hold(pl_run* run, pl_radau* r, double* h, double* error, double* next,
                            pl_projection* p);
void pl_radau_series(pl_run* run, pl_radau* r, double h);
bool pl_radau_probe(pl_run* run, double h, double least, double* reach);

double pl_radau_tol(double asked);  // the tolerance that it works to
pleuel_status pl_radau_expand(pl_run* run, pl_stepper_step* s);
pleuel_status pl_radau_state_at(pl_run* run, pl_stepper_step* s);
void pl_radau_changed(pl_run* run, bool shaken);

// ---- radau_system.c
void pl_radau_free(pl_radau* r);

// ---- radau_save.c
void pl_radau_save(pl_run* run, pl_keeper* k);

// ---- stiff_detect.c
pleuel_status pl_stiff_poll(pl_run* run);
void pl_stiff_review(pl_run* run, double h);

#endif
