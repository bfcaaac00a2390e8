// The equations of motion of a setup as numbers: instances of patterns in lanes, the linear system
// of a point, constraints in force, the series there.
//
//     M(q,t) a + h(q,v,t) = (G^T + W) λ,     g(q,t) = 0  (or A(q,t) v + b(q,t) = 0)
//
// Knows neither steps nor events: pl_dae is a point of a motion and what follows from it.
#ifndef PL_DAE_H
#define PL_DAE_H

#include <string.h>

#include "linalg/linalg.h"
#include "solve/solve.h"

enum {
  PL_FAMILY_LANES = 8,    // instances computed side by side: a multiple of this
  PL_FAMILY_GROUPS = 16,  // so many times as many in one batch at most
  PL_DENSE_UP_TO = 60,    // unknowns: dense below, KLU above
  // constraint rows whose independence is examined at all; above they must be independent
  PL_RANK_UP_TO = 400,
  // rows^2 columns up to which that is done at every point; above: once a mode
  PL_RANK_WORK = 200000
};

// Entries of one row of G that are multiples of one node u: their products with velocities and
// multipliers are those of u.
typedef struct pl_bundle {
  int node, c;   // u; slot of the constraint
  int first, n;  // entries bundle_q[first ..]
} pl_bundle;

// Up to `lanes` instances of one pattern. Unused lanes repeat the last instance and are not
// scattered.
typedef struct pl_batch {
  const pl_pattern* pattern;
  pl_jet* jet;
  int lanes, n;
  int *q, *c, *out;  // global index of slot s in lane l: q[s * lanes + l]
  // series of each slot, lane fastest: v[(s * orders + k) * lanes + l]; v only v[s * lanes + l]
  // without all_v
  double *v, *a, *lambda;
  int orders;               // room for coefficients 0 .. orders-1 of v, a, λ
  int *q_run, *c_run;       // of a slot whose indices follow each other: the first; else -1
  bool *needs_v, *needs_a;  // some series has to do with this slot                          (n_q)
  bool all_v;               // all orders of v are kept slot by slot, which slip reads
  pl_bundle* bundles;
  int n_bundles, *bundle_q;  // slots of coordinates
  double* bundle_factor;     // multiples of u, by lanes
  // series of the sum of multiples of velocities: (bundle orders + k) lanes + l
  double* bundle_v;
  // places in the values of the linear system, per entry and lane
  int *at_mass, *at_mass_t, *at_G, *at_Gt, *at_W;
} pl_batch;

typedef struct pl_batches {
  pl_batch* at;
  int n;
  bool lean;  // said before they are made: no contacts, no friction
} pl_batches;

// The linear system of a point: [M G^T + W; G 0] [a; -λ] = r. Rows of constraints not used hold 1
// on the diagonal.
typedef struct pl_kkt {
  int n;  // n_q + n_c
  bool dense;
  int n_values;
  double* value;                        // dense: (n x n) column-major; sparse: along the structure
  int *start, *row;                     // structure
  int* diagonal;                        // place of each diagonal entry  (n)
  double *lu, *scale, *balance, *work;  // dense factor
  int* pivot;
  pl_sparse* sparse;        // with pivoting
  pl_symmetric* symmetric;  // without; NULL: always with
  bool pivoted;             // the factor at hand is that with pivoting
  double trusted;           // part of a pivot that must be left for going without
  double ratio;             // of the pivots, a measure of how singular it is
  pl_arena* arena;
} pl_kkt;

// Friction as it is now.
typedef enum pl_friction_phase {
  PL_FRICTION_OFF,
  PL_FRICTION_STICK,
  PL_FRICTION_SLIP
} pl_friction_phase;
typedef struct pl_friction_state {
  pl_friction_phase state;
  int way;     // plane: sign of the slip velocity
  int press;   // sign of the multiplier that presses
  bool given;  // space: slips along d, because there is no slip velocity yet
  double d[3];
  double small;  // space: slip below this counts as none
} pl_friction_state;

// Where the angles of a turn have been followed to.
typedef struct pl_attitude_state {
  double t;
  double angle[3];  // φ, ϑ, ψ
  double rate[2];   // of (φ + ψ)/2 and (φ - ψ)/2, where they were determined last
} pl_attitude_state;

typedef struct pl_dae {
  pl_job* job;
  const pl_setup* setup;
  int n_q, n_c, order;  // v has coefficients 0 .. order
  pl_batches motion;
  pl_kkt kkt;
  bool has_W;             // some force depends on a multiplier
  bool mass_of_velocity;  // M depends on velocities
  bool watch_landings;    // some one-sided constraint is free
  // the factor and the nodes of q, t belong to run->t, q (left by a projection)
  bool factored;
  int* has_equation;  // structure of coordinates: 1 if the coordinate has an entry in M  (n_q)
  bool rests;         // some coordinate rests or some constraint is not used
  // their memory belongs to run->t, q, v, or to the end of the step that is tried
  bool at_point;
  // of which the step at work, the step before, uses so many: fewer in a leap
  int use;
  // the point
  double t, t_low;     // time and its rounding error
  double t_nodes;      // time of the nodes of q and t: that of the point but for its last bit
  double *q, *v;       // (n_q)
  bool ready;          // a_0, λ_0 and the factor belong to the point
  double *g, *g_size;  // constraint values, size of their terms     (n_c)
  double* argument;    // how much larger g_size is than the terms   (n_c)
  double *r, *r_size;  // G v + dg/dt and its terms                  (n_c)
  double* rhs;         // (n_q + n_c)
  double force_size;   // largest |h_i| met, for the rounding error of λ
  double* row_most;    // largest entry of each row of G       (n_c)
  // the series at the point
  double *Q, *V, *A, *L;                      // coefficient k: Q + k n_q, L + k n_c
  double t_series;                            // where it starts
  double *Q_last, *V_last, *A_last, *L_last;  // the series of the step that was taken last
  // active set and rank
  bool* on;  // switched on: in contact, for a one-sided one    (n_c)
  // off by declaration or by an event: does not come back by itself    (n_c)
  bool* detached;
  bool* active;  // on, and its contact too                    (n_c)
  bool* taken;   // in the independent subset                  (n_c)
  bool* unique;  // multiplier determined                      (n_c)
  // multipliers that are not unique in this mode (statically indeterminate)        (n_c)
  bool* several;
  bool* ever_several;  // not determined at some time, for whatever reason        (n_c)
  bool* near_by;       // contacts that take part in what happens now    (n_c)
  bool* rebounds;      // of them those that bounce: what goes with them is not in force   (n_c)
  int n_active, rank, rank_mode;
  // too large for a look at every point: the subset is chosen once a mode, pivots are watched
  bool by_pivots;
  double *rows, *rank_work;  // for independence: rows (n_c x n_q)
  double* column;            // largest scaled entry of each column so far (n_q)
  // longest that a row has been, part of it that it is now   (n_c)
  double *row_long, *row_part;
  int *priority, *row_of;
  bool *row_taken, *taken_kept;
  double smallest, best;             // smallest pivot of the independent rows; largest such so far
  double smallest_before;            // at the point, at the one before, its time
  double *dep, *dep_tau, *dep_norm;  // dependence of rows left out
  int* dep_jpvt;
  // step control
  double q_size, v_size;    // largest norms met
  double *q_most, *v_most;  // largest size of each coordinate and velocity met   (n_q)
  double *q_kept, *v_kept;  // the same at the point, without the trial
  // contacts and friction
  pl_friction_state* friction;  // (n_frictions)
  bool* slips;                  // this row of slip gives a force: it slips    (n_c)
  int* at_friction;             // place of its coupling to the multiplier that presses   (n_c)
  int n_slipping;
  bool impulsive;    // the system at work is that of an impact
  double* C_series;  // coefficients: order k at k n_coefficients
  // bodies declared in Euler angles
  pl_attitude_state* attitude;  // (n_attitudes)
  // q, v, a for observers and for rows   (n_q + 3 n_attitudes)
  double *seen[3], *shown[3], *shown_before[3];
} pl_dae;

// The larger and the smaller of two numbers, the first where one is none: without a branch, and
// without the call that fmax is.
static inline double pl_larger(double a, double b) { return b > a ? b : a; }
static inline double pl_smaller(double a, double b) { return b < a ? b : a; }
// The larger of a size and of |x|, where what is no number counts as larger: sizes are ordered as
// their bits are.
static inline double pl_size_with(double most, double x) {
  uint64_t a, b;
  memcpy(&a, &most, sizeof a);
  memcpy(&b, &x, sizeof b);
  b &= INT64_MAX;
  a = b > a ? b : a;
  memcpy(&most, &a, sizeof most);
  return most;
}

typedef struct pl_projection {
  double g_before, g_after, r_before, r_after, move_q, move_v;
  bool ok;
} pl_projection;

// ---- dae_make.c
pleuel_status pl_dae_make(pl_dae* dae, pl_job* job, const pl_setup* setup, int order);

// ---- taylor_order.c: what each order of a series costs, compiled for several processors with the
// same bits
typedef enum pl_series_kind { PL_IS_Q, PL_IS_V, PL_IS_A, PL_IS_LAMBDA } pl_series_kind;
typedef struct pl_taylor_order {
  void (*load)(pl_batches* b, pl_series_kind what, const double* x, int k);
  void (*rhs)(pl_dae* dae, int k, double* rhs);
  void (*take)(pl_dae* dae, int k);                             // a_k, λ_k, v_{k+1} from dae->rhs
  void (*over)(double* to, const double* from, int by, int n);  // to = from / by
  void (*horner)(const double* X, int n, int last, double dt, double* x);
  double (*norm)(const double* x, int n);  // largest size; NaN comes through
  // most[i] at least |x[i]|; the largest of all
  double (*note)(double* most, const double* x, int n);
  void (*g)(pl_dae* dae, int k, double* g, double* size);  // as pl_assemble_g and so on
  void (*gdot)(pl_dae* dae, double* r, double* size);
  void (*row_sizes)(pl_dae* dae);
} pl_taylor_order;
const pl_taylor_order* pl_taylor_order_here(void);  // batches.c

// ---- batches.c: instances in lanes
pleuel_status pl_batches_make(pl_job* job, pl_batches* b, const pl_pattern* patterns, int n,
                              int orders, int n_q, int n_c, int n_out);
void pl_batches_time(pl_batches* b, double t);
void pl_batches_load_q(pl_batches* b, const double* q, int k);
void pl_batches_load_v(pl_batches* b, const double* v, int k);
void pl_batches_load_a(pl_batches* b, const double* a, int k);
void pl_batches_load_lambda(pl_batches* b, const double* lambda, int k);
void pl_batches_sweep(pl_batches* b, pl_tape_level level, int k, bool all);
// sums of contributions
void pl_batches_outputs(const pl_batches* b, double* out, int n_out, int k);

// ---- assemble.c: from jets to the linear system
void pl_assemble_matrix(pl_dae* dae, bool with_W);
void pl_assemble_rows(pl_dae* dae);       // active rows of G into dae->rows, dae->row_of
void pl_assemble_row_sizes(pl_dae* dae);  // dae->row_most
void pl_assemble_g(pl_dae* dae, int k, double* g, double* size);  // size NULL: values only
void pl_assemble_gdot(pl_dae* dae, double* r, double* size);      // G v + dg/dt at order 0
void pl_assemble_rhs(pl_dae* dae, int k, double* rhs);
// acceleration of a coordinate by the largest force met
double pl_free_size(const pl_dae* dae, int i);
void pl_assemble_slip(pl_dae* dae, int k, double* speed);  // order k of G v + dg/dt of slip
// d/dt (G v + dg/dt), all rows
void pl_assemble_second(pl_dae* dae, const double* a, double* second, double* size);

// ---- kkt.c
pleuel_status pl_kkt_make(pl_dae* dae);
bool pl_kkt_factor(pl_kkt* k);
void pl_kkt_solve(pl_kkt* k, double* b);
void pl_kkt_free(pl_kkt* k);
void pl_kkt_keep(pl_kkt* k, pl_keeper* keeper);  // what its pivoting remembers; checkpoint.c

// ---- active_set.c: which constraints are used, what is determined
// at every point; once a mode for large systems
void pl_active_set_choose(pl_dae* dae);
// The smallest pivot at what was evaluated last, 0 where a row is lost, without choosing anything;
// false: too many.
bool pl_active_set_pivot(pl_dae* dae, double* smallest);
void pl_sizes_note(pl_dae* dae, const double* q, const double* v);  // q_size, q_most and so on
void pl_sizes_keep(pl_dae* dae);                                    // what was noted counts
void pl_sizes_forget(pl_dae* dae);  // back to what was kept: a step was rejected
void pl_active_set_unique(pl_dae* dae);
void pl_active_set_note(pl_dae* dae);    // ever_several, from unique
void pl_active_set_update(pl_dae* dae);  // active from on; orphans rest

// ---- least_change.c Minimum-norm correction of the free components that removes the residuals of
// the rows at hand; false: there is none.
bool pl_least_change(const pl_dae* dae, const bool* held, const double* residual,
                     const double* size, bool positions, double* basis, double* change);

// ---- point.c
// levels POSITION and VELOCITY at order 0
void pl_point_evaluate(pl_dae* dae, double t, const double* q, const double* v);
bool pl_point_factor(pl_dae* dae, bool with_W);  // choose, assemble, factor
// Order k of the series at the point, after those below.
void pl_point_order(pl_dae* dae, int k);
// Order 0 by the patterns, into the series at work; at dae->t, q, v.
bool pl_point_enter_at(pl_dae* dae, double t, const double* q, const double* v);
bool pl_point_enter(pl_dae* dae);
void pl_horner(const double* X, int n, int last, double dt, double* x);  // sum of X_k dt^k
void pl_series_at(const pl_dae* dae, double dt, double* q, double* v);
void pl_series_lambda_at(const pl_dae* dae, double dt, double* a, double* lambda);
// the series at work and that of the step before
void pl_series_swap(pl_dae* dae);

// ---- project.c
pl_projection pl_project(pl_dae* dae, double t, double* q, double* v);
// Largest |g| (or |G v + dg/dt|) of the active constraints, relative to the size of their terms.
double pl_residual(const pl_dae* dae, const double* g, const double* size, bool positions);
double pl_norm(const double* x, int n);

// ---- map_equations.c
// coordinates that only a map determines, where it begins to hold
void pl_maps_follow(pl_dae* dae);

// ---- friction.c
void pl_friction_make(pl_dae* dae);
// rows of slip: which are constraints, which forces
void pl_friction_activate(pl_dae* dae);
void pl_friction_coefficients(pl_dae* dae, int k);  // order k, after the sweeps of the motion
void pl_friction_matrix(pl_dae* dae);               // the rows of those that slip
void pl_friction_rhs(pl_dae* dae, int k, double* rhs);
// |F| from multipliers or impulses
double pl_friction_force(const pl_dae* dae, int r, const double* m);
// |slip|, its direction
double pl_friction_speed(const pl_dae* dae, int r, const double* rates, double* d);
bool pl_friction_is_used(const pl_dae* dae, int r);  // its constraint is in force
// multiplier of slip by that which presses
double pl_friction_kappa(const pl_dae* dae, int r, int i, const double* C);
double pl_friction_kappa_by(const pl_dae* dae, int r, int i, int coefficient);

// ---- attitude.c: angles of bodies that are integrated as quaternions
void pl_attitude_make(pl_dae* dae);
// Angles and their rates in q, v become quaternions in q_run, v_run.
void pl_attitude_start(pl_dae* dae, double t, const double* q, const double* v, double* q_run,
                       double* v_run);
void pl_attitude_follow(pl_dae* dae, double t);  // along the series at work
// as observers need them
void pl_attitude_seen(pl_dae* dae, double t, const double** q, const double** v, const double** a);
void pl_attitude_show(pl_dae* dae, pl_row* row);  // coordinates as they were declared
// fails when the step to q_end passes a pole, at *t_pole
pleuel_status pl_attitude_poles(pl_dae* dae, double h, const double* q_end, double* t_pole);

#endif
