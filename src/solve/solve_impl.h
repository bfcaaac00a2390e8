// Inside of a run: batches of instances with their jets, the linear system of a step, the series,
// contacts, events.
#ifndef PL_SOLVE_IMPL_H
#define PL_SOLVE_IMPL_H

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

// A decision at a moment of change: whether a contact holds, how a friction goes on.
typedef enum pl_choice {
  PL_CHOICE_OPEN,
  PL_CHOICE_CLOSED,
  PL_CHOICE_STICK,
  PL_CHOICE_SLIP  // with way and press: PL_CHOICE_SLIP + (way < 0) + 2 (press < 0)
} pl_choice;
enum {
  PL_FRICTION_AT_REST = 1 << 8
};  // beside the choices left to a friction: there is no slip now
typedef struct pl_decision {
  bool of_friction;
  int index;         // constraint or friction
  unsigned allowed;  // bits of the choices
  int choice;
} pl_decision;

// Something that is watched for a root on a step: a release, a landing or an event.
typedef enum pl_watch_kind {
  PL_WATCH_RELEASE,
  PL_WATCH_LANDING,
  PL_WATCH_STICK,  // the slip velocity of a friction reaches zero
  PL_WATCH_SLIP,   // the force that holds it reaches its limit
  PL_WATCH_PRESS,  // the multiplier that presses changes its sign while it slips
  PL_WATCH_EVENT
} pl_watch_kind;
typedef struct pl_watch {
  pl_watch_kind kind;
  int index;      // constraint, friction or event
  int direction;  // +1 rising, -1 falling, 0 both
  // so many leading coefficients are zero by construction: it has just happened
  int fresh;
  int side;  // sign on which it is known to be; 0 unknown
} pl_watch;

// how small the smallest pivot was, and when
typedef struct pl_fade {
  double t, smallest;
} pl_fade;

// How often an event has changed the motion in ever shorter time: when last, after how long, the
// longest of these times.
typedef struct pl_repeat {
  double t, gap, widest;
  long n;
} pl_repeat;

// A place in a program that has branches: node a (or a - b) changes sign at the switching point.
typedef struct pl_switch {
  const pl_batch* batch;
  int a, b, lane;
} pl_switch;

// Where the angles of a turn have been followed to.
typedef struct pl_attitude_state {
  double t;
  double angle[3];  // φ, ϑ, ψ
  double rate[2];   // of (φ + ψ)/2 and (φ - ψ)/2, where they were determined last
} pl_attitude_state;

typedef struct pl_stepper pl_stepper;    // stepper/stepper.h
typedef struct pl_observer pl_observer;  // below
typedef struct pl_indeterminate pl_indeterminate;
typedef struct pl_sensitivity pl_sensitivity;
// where a run stops before its end
typedef struct pl_stop {
  bool early;
  double t, t_low;
} pl_stop;

typedef struct pl_step_program pl_step_program;  // the step program: step_program_impl.h
typedef struct pl_extended pl_extended;          // the same on extended numbers: extended_impl.h

struct pl_run {
  pl_job* job;
  const pl_setup* setup;
  pl_run_options options;
  int n_q, n_c, order;  // v has coefficients 0 .. order
  // of which the step at work, the step before, uses so many: fewer in a leap
  int use, use_last;
  double tol;
  bool tol_raised;

  pl_batches motion, observers, watched, branches;
  pl_kkt kkt;
  bool has_W;             // some force depends on a multiplier
  bool mass_of_velocity;  // M depends on velocities
  bool watch_landings;    // some one-sided constraint is free
  // the factor and the nodes of q, t belong to run->t, q (left by a projection)
  bool factored;
  int* has_equation;  // structure of coordinates: 1 if the coordinate has an entry in M  (n_q)
  bool rests;         // some coordinate rests or some constraint is not used

  // the step program, for the mode at work and those before; NULL: the general way
  pl_step_program *program, *programs;
  double clock_begin, t_begin;  // when stepping with these began
  long considered;              // steps at which compiling was thought of last
  // their memory belongs to run->t, q, v, or to the end of the step that is tried
  bool at_point;

  pl_extended* extended;  // NULL: doubles
  bool start_given;       // given start values are as they were written

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
  double t_last, h_last;                      // where that starts, and its length

  // dense series of what is watched
  double* G_series;  // g of each constraint: coefficient k at k n_c
  double* W_series;  // watched quantities: coefficient k at k n_watched

  // active set and rank
  bool* on;  // switched on: in contact, for a one-sided one    (n_c)
  // off by declaration or by an event: does not come back by itself    (n_c)
  bool* detached;
  bool* active;  // on, and its contact too                    (n_c)
  bool* taken;   // in the independent subset                  (n_c)
  bool* unique;  // multiplier determined                      (n_c)
  int n_active, rank, rank_mode;
  // too large for a look at every point: the subset is chosen once a mode, pivots are watched
  bool by_pivots;
  double *rows, *rank_work;  // for independence: rows (n_c x n_q)
  double* column;            // largest scaled entry of each column so far (n_q)
  // longest that a row has been, part of it that it is now   (n_c)
  double *row_long, *row_part;
  int *priority, *row_of;
  bool *row_taken, *taken_kept;
  double smallest, best;  // smallest pivot of the independent rows; largest such so far
  double smallest_here, smallest_before, t_before;  // at the point, at the one before, its time
  pl_fade fade[2];
  double reach;      // from the point to the singular position that a leap passes
  double shrink;     // a step in units of the radius of the series, its logarithm
  double h_series;   // step that the series allowed last
  double h_regular;  // step that the series allowed last where the pivots were large
  double *dep, *dep_tau, *dep_norm;  // dependence of rows left out
  int* dep_jpvt;

  // step control
  double q_size, v_size;    // largest norms met
  double *q_most, *v_most;  // largest size of each coordinate and velocity met   (n_q)
  double *q_kept, *v_kept;  // the same at the point, without the trial
  double h_plain, h_least;  // s: longest step, shortest
  double row_gap;           // s: longest between two rows without a grid
  double *trial_q, *trial_v;
  // accelerations of the series at the end of the step that is tried   (n_q)
  double* end_a;
  bool end_by_program;  // they were computed by the step program
  // order 0 of that point is known: in Q_last and so on, until the step is taken
  bool arrived;
  // difference between these and those of the equations that shorter steps did not lessen
  double a_rough;
  double *save_q, *save_v, *save_a, *save_l;  // the point before a mode change
  bool* save_unique;
  double* impulse;          // (n_c)
  double *jump_v, *jump_q;  // (n_q)

  pl_indeterminate* indeterminate;  // NULL without contacts and friction
  bool* several;                    // multipliers that are one of several in this mode        (n_c)
  bool* ever_several;               // not determined at some time, for whatever reason        (n_c)
  pl_sensitivity* sensitivity;      // goes ahead of a run with derivatives, NULL without it
  pl_stop stop;
  // so far; of the last one the rows in force and the factor of their rebound   (n_c)
  long impacts;
  bool* impact_taken;
  double* impact_factor;

  const pl_stepper* stepper;      // at work
  const pl_stepper* steppers[2];  // that the run has
  int n_steppers;
  const pl_observer* observer;  // where events report
  struct pl_radau* radau;       // the implicit method, NULL without it

  // watching
  pl_watch* watch;
  int n_watch;
  double *poly, *root_work;
  bool* hit;       // (n_watch)
  double* root;    // (n_watch)
  bool* touch;     // the root only touches    (n_watch)
  bool undecided;  // what is watched may be zero just at the end of the step
  int sunk;        // constraint that the step went through, unseen; -1 none

  // contacts and friction
  pl_friction_state* friction;         // (n_frictions)
  pl_friction_state* friction_before;  // at the point before a mode change
  bool* slips;                         // this row of slip gives a force: it slips    (n_c)
  int* at_friction;  // place of its coupling to the multiplier that presses   (n_c)
  int n_slipping;
  bool impulsive;    // the system at work is that of an impact
  double* C_series;  // coefficients: order k at k n_coefficients
  double* S_series;  // G v + dg/dt of slip: order k at k n_c
  double* poly_2;    // for products of series
  bool* near_by;     // contacts that take part in what happens now    (n_c)
  // of them all that are met, also if they open at once                (n_c)
  bool* met;
  bool* rebounds;   // of them those that bounce: what goes with them is not in force   (n_c)
  bool* on_before;  // (n_c)
  unsigned* fixed;  // choices that an event leaves to a contact, 0: all   (n_c)
  unsigned* friction_fixed;      // the same for frictions                          (n_frictions)
  bool* jumped;                  // had an impact                                   (n_c)
  double* approach;              // velocity along g before an impact               (n_c)
  double *second, *second_size;  // g'' of constraints, derivative of slip   (n_c)
  double *hold_q, *hold_v;       // the point that decisions are tried at           (n_q)
  double* first_a;               // accelerations of the first consistent set       (n_q)
  pl_decision* decision;         // (n_c + n_frictions)
  int* choice_kept;
  int n_decisions;
  double* fastest;    // largest approach that a contact has seen        (n_c)
  double* bounce_t;   // times of its last three impacts                 (3 n_c)
  long* bounces;      // how many one after the other                    (n_c)
  pl_repeat* repeat;  // (n_events)
  double* settled_t;  // end of its infinitely many bounces, NaN         (n_c)

  pl_switch* switches;
  int n_switches;
  double* K_series;  // of what changes sign: coefficient k of switching point i at i order + k
  int tiny;          // steps in a row that were almost nothing

  // bodies declared in Euler angles
  pl_attitude_state* attitude;  // (n_attitudes)
  // q, v, a for observers and for rows   (n_q + 3 n_attitudes)
  double *seen[3], *shown[3], *shown_before[3];

  // rows
  double *out_now, *out_before, *row_q, *row_v, *row_a, *row_l;
  double* energy_out;
  char *mode, *mode_before;
  size_t mode_size;
  double t_grid;  // next grid time is t_0 + grid_n * grid_dt
  long grid_n, grid_count;
  double grid_dt;
  const double* grid_times;  // instead: rows at these times, grid_count + 1 of them; NULL
  bool opened, begun, ended, started, stopped;
  bool refused;       // the sink wants no more rows
  double last_row_t;  // of a row that was not one before an event; NaN
  int mode_changes;   // in a row without progress
  double mode_change_t;

  double* W_coef;        // values of watched quantities at a point   (n_watched)
  double* branch_value;  // (n_branch_outputs)
  pl_start_report start;
  pl_stats stats;
  double energy_size, energy_base;
  double wall_begin;
};

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

// ---- taylor_order.c: what each order of a series costs, compiled for several processors with the
// same bits
typedef enum pl_series_kind { PL_IS_Q, PL_IS_V, PL_IS_A, PL_IS_LAMBDA } pl_series_kind;
typedef struct pl_taylor_order {
  void (*load)(pl_batches* b, pl_series_kind what, const double* x, int k);
  void (*rhs)(pl_run* run, int k, double* rhs);
  void (*take)(pl_run* run, int k);                             // a_k, λ_k, v_{k+1} from run->rhs
  void (*over)(double* to, const double* from, int by, int n);  // to = from / by
  void (*horner)(const double* X, int n, int last, double dt, double* x);
  double (*norm)(const double* x, int n);  // largest size; NaN comes through
  // most[i] at least |x[i]|; the largest of all
  double (*note)(double* most, const double* x, int n);
  void (*g)(pl_run* run, int k, double* g, double* size);  // as pl_assemble_g and so on
  void (*gdot)(pl_run* run, double* r, double* size);
  void (*row_sizes)(pl_run* run);
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
void pl_assemble_matrix(pl_run* run, bool with_W);
void pl_assemble_rows(pl_run* run);       // active rows of G into run->rows, run->row_of
void pl_assemble_row_sizes(pl_run* run);  // run->row_most
void pl_assemble_g(pl_run* run, int k, double* g, double* size);  // size NULL: values only
void pl_assemble_gdot(pl_run* run, double* r, double* size);      // G v + dg/dt at order 0
void pl_assemble_rhs(pl_run* run, int k, double* rhs);
// acceleration of a coordinate by the largest force met
double pl_free_size(const pl_run* run, int i);
void pl_assemble_slip(pl_run* run, int k, double* speed);  // order k of G v + dg/dt of slip
// d/dt (G v + dg/dt), all rows
void pl_assemble_second(pl_run* run, const double* a, double* second, double* size);

// ---- kkt.c
pleuel_status pl_kkt_make(pl_run* run);
bool pl_kkt_factor(pl_kkt* k);
void pl_kkt_solve(pl_kkt* k, double* b);
void pl_kkt_free(pl_kkt* k);
void pl_kkt_keep(pl_kkt* k, pl_keeper* keeper);  // what its pivoting remembers; checkpoint.c

// ---- active_set.c: which constraints are used, what is determined
// at every point; once a mode for large systems
void pl_active_set_choose(pl_run* run);
// The smallest pivot at what was evaluated last, 0 where a row is lost, without choosing anything;
// false: too many.
bool pl_active_set_pivot(pl_run* run, double* smallest);
void pl_sizes_note(pl_run* run, const double* q, const double* v);  // q_size, q_most and so on
void pl_sizes_keep(pl_run* run);                                    // what was noted counts
void pl_sizes_forget(pl_run* run);  // back to what was kept: a step was rejected
void pl_active_set_unique(pl_run* run);
void pl_active_set_update(pl_run* run);  // active from on; orphans rest

// ---- least_change.c The least change of what is not held that takes the residuals away, for the
// rows at hand; false: there is none.
bool pl_least_change(const pl_run* run, const bool* held, const double* residual,
                     const double* size, bool positions, double* basis, double* change);

// ---- point.c
// levels POSITION and VELOCITY at order 0
void pl_point_evaluate(pl_run* run, double t, const double* q, const double* v);
bool pl_point_factor(pl_run* run, bool with_W);  // choose, assemble, factor
// Order k of the series at the point, after those below.
void pl_point_order(pl_run* run, int k);
// Order 0 by the patterns, into the series at work; at run->t, q, v.
bool pl_point_enter_at(pl_run* run, double t, const double* q, const double* v);
bool pl_point_enter(pl_run* run);
void pl_horner(const double* X, int n, int last, double dt, double* x);  // sum of X_k dt^k
void pl_series_at(const pl_run* run, double dt, double* q, double* v);
void pl_series_lambda_at(const pl_run* run, double dt, double* a, double* lambda);
// the series at work and that of the step before
void pl_series_swap(pl_run* run);

double pl_run_left(const pl_run* run);  // to the end, or to where it stops before

// ---- project.c
pl_projection pl_project(pl_run* run, double t, double* q, double* v);
// velocities onto G v + dg/dt = 0; (n_c)
void pl_impulse(pl_run* run, double* v, double factor, double* impulse);
// Largest |g| (or |G v + dg/dt|) of the active constraints, relative to the size of their terms.
double pl_residual(const pl_run* run, const double* g, const double* size, bool positions);
double pl_norm(const double* x, int n);

// ---- watch.c
void pl_watch_make(pl_run* run);
void pl_watch_series(pl_run* run);  // after pl_series_expand
// earliest root in (0, h], hit[] says who; -1 none
double pl_watch_first(pl_run* run, double h);
// up to h, where the series of all that is watched are known
double pl_watch_reach(pl_run* run, double h);
double pl_watch_known(double* c, int n, double noise, double part);
// events that end the step that is tried at x h are zero there
bool pl_watch_holds(pl_run* run, double h, double x);
// events between the stages of an implicit step are as they say
bool pl_watch_is_followed(pl_run* run, double h);
void pl_watch_forget(pl_run* run);            // all sides unknown: after a start or a jump
void pl_watch_passed(pl_run* run, double h);  // the step h was taken: sides at its end
pl_watch* pl_watch_of(pl_run* run, pl_watch_kind kind, int index);
// an event gives places or velocities new values
bool pl_event_sets(const pl_run* run, int e);
double pl_watch_force_noise(const pl_run* run, int c);  // rounding error of λ_c
// what of a watched value is rounding
double pl_watch_noise(const pl_run* run, const pl_watch* w, double h);

// ---- switching.c
void pl_switching_make(pl_run* run);
void pl_switching_series(pl_run* run);  // after pl_series_expand
double pl_switching_value(const pl_run* run, int i);
double pl_switching_reach(pl_run* run, double h);  // as pl_watch_reach
// just behind the first switching point, in units of h; -1 none on the step
double pl_switching_first(pl_run* run, double h);

// ---- map_equations.c
// coordinates that only a map determines, where it begins to hold
void pl_maps_follow(pl_run* run);

// ---- friction.c
void pl_friction_make(pl_run* run);
void pl_friction_keep_directions(pl_run* run);  // before the point at a root
// rows of slip: which are constraints, which forces
void pl_friction_activate(pl_run* run);
void pl_friction_coefficients(pl_run* run, int k);  // order k, after the sweeps of the motion
void pl_friction_matrix(pl_run* run);               // the rows of those that slip
void pl_friction_rhs(pl_run* run, int k, double* rhs);
// |F| from multipliers or impulses
double pl_friction_force(const pl_run* run, int r, const double* m);
// series of what is watched
int pl_friction_slip(const pl_run* run, int r, pl_watch_kind kind, double* c, int n);
// |slip|, its direction
double pl_friction_speed(const pl_run* run, int r, const double* rates, double* d);
bool pl_friction_is_used(const pl_run* run, int r);  // its constraint is in force
// multiplier of slip by that which presses
double pl_friction_kappa(const pl_run* run, int r, int i, const double* C);
double pl_friction_kappa_by(const pl_run* run, int r, int i, int coefficient);

// ---- contacts.c: which contacts hold, which surfaces stick
// velocities along g and of slip; r_size
void pl_contacts_rates(pl_run* run, double* rates);
// velocities after an impact, if something arrives
pleuel_status pl_contacts_impact(pl_run* run, bool* any);
// the mode whose accelerations and forces fit together
pleuel_status pl_contacts_settle(pl_run* run);

// ---- indeterminate.c: forces that are one of several
void pl_indeterminate_make(pl_run* run);
void pl_indeterminate_mark(pl_run* run);    // at the begin of a mode
void pl_indeterminate_note(pl_run* run);    // what unique[] says
void pl_indeterminate_report(pl_run* run);  // in the statistics

// ---- modes.c
pleuel_status pl_modes_enter(pl_run* run);                 // the point in the mode that on[] says
pleuel_status pl_modes_check(pl_run* run, bool at_start);  // contacts that pull are released
pleuel_status pl_modes_handle(pl_run* run);                // what hit[] says, at the point
// what counts as small where the start rests
void pl_modes_size_rest(pl_run* run);
void pl_output_mode(const pl_run* run, char* out);

// ---- sensitivity.c: derivatives through contacts and events
void pl_sensitivity_free(pl_sensitivity* p);
const char* pl_sensitivity_mode(const pl_sensitivity* p);
bool pl_sensitivity_waits(const pl_sensitivity* p);
pleuel_status pl_sensitivity_begin(pl_sensitivity* p);  // tells what happened at the start
pleuel_status pl_sensitivity_step(pl_sensitivity* p, pleuel_status (*of)(pl_run* run));
void pl_sensitivity_write(pl_sensitivity* p, pl_keeper* k);  // for checkpoint.c
pleuel_status pl_sensitivity_read(pl_sensitivity* p, pl_keeper* k);

// ---- run.c
pleuel_status pl_run_begin_at(pl_run* run, double t);  // from run->q, v

// ---- singular.c
void pl_singular_watch(pl_run* run);  // at every point
bool pl_is_singular(const pl_run* run);
pleuel_status pl_run_singular(pl_run* run);  // fails with the place
// fails where a coordinate of the energies has no equation: L = x x'
pleuel_status pl_run_left_open(pl_run* run);
// fails with the reason why there are no accelerations
pleuel_status pl_run_undetermined(pl_run* run);
// fails with the reason why no step is short enough; h was tried
pleuel_status pl_run_too_small(pl_run* run, double h);
bool pl_singular_leap(pl_run* run, double left, double* length, pl_projection* p);
pleuel_status pl_singular_record(pl_run* run);

// ---- attitude.c: angles of bodies that are integrated as quaternions
void pl_attitude_make(pl_run* run);
// Angles and their rates in q, v become quaternions in q_run, v_run.
void pl_attitude_start(pl_run* run, double t, const double* q, const double* v, double* q_run,
                       double* v_run);
void pl_attitude_follow(pl_run* run, double t);  // along the series at work
// as observers need them
void pl_attitude_seen(pl_run* run, double t, const double** q, const double** v, const double** a);
void pl_attitude_show(pl_run* run, pl_row* row);  // coordinates as they were declared
// fails when the step to trial_q passes a pole
pleuel_status pl_attitude_poles(pl_run* run, double h);

// What events report to, without knowing who listens: rows, energies, records.
struct pl_observer {
  // Remembers the point before the motion changes.
  void (*before)(pl_run* run);
  // The point as a row.
  pleuel_status (*point)(pl_run* run, pl_row_kind kind);
  // Something happened at the point.
  pleuel_status (*event)(pl_run* run, pl_event_kind kind, int index, double impulse, bool at_start);
  // Something happened at time t, whose state, in row_q and row_v, is not that of the point.
  pleuel_status (*beside)(pl_run* run, pl_event_record e, double t, const double* a,
                          const double* lambda);
  // A contact after endless bounces, dt after the point.
  pleuel_status (*settled)(pl_run* run, pl_event_kind kind, int index, double dt, long bounces);
  // Energy at the point; anew: its drift counts from here.
  void (*energy)(pl_run* run, bool anew);
  // The energy of a state with the accelerations and multipliers of the point.
  double (*energy_of)(pl_run* run, const double* q, const double* v);
};

// ---- output.c
extern const pl_observer pl_output_observer;
pleuel_status pl_output_open(pl_run* run);  // begin of the sink
pleuel_status pl_output_begin(pl_run* run);
pleuel_status pl_output_point(pl_run* run, pl_row_kind kind);  // the point itself
// grid times in (t_from, t_to)
pleuel_status pl_output_grid(pl_run* run, double t_from, double t_to);
pl_row pl_output_row(pl_run* run, pl_row_kind kind, double* out, char* mode);
void pl_output_observe(pl_run* run, double t, const double* q, const double* v, const double* a,
                       const double* lambda, double* out);
// remembers the point before a mode change
void pl_output_before(pl_run* run);
pleuel_status pl_output_event(pl_run* run, pl_event_kind kind, int index, double impulse,
                              bool at_start);
// An event whose state, in row_q and row_v, is not that of the point.
pleuel_status pl_output_event_beside(pl_run* run, pl_event_record e, double t, const double* a,
                                     const double* lambda);
// A contact after endless bounces, dt after the point.
pleuel_status pl_output_settled(pl_run* run, pl_event_kind kind, int index, double dt,
                                long bounces);
// T + V, or what the setup says
double pl_output_conserved(const pl_run* run, const double* out);
// energy at the point, drift
void pl_output_energy(pl_run* run, bool anew);

#endif
