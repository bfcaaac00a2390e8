// solve: the motion. A setup (patterns, names, start values, contacts, events) becomes a run that
// steps.
//
//     M(q,t) a + h(q,v,t) = (G^T + W) λ,     g(q,t) = 0  (or A(q,t) v + b(q,t) = 0)
//
// is integrated as written (index 3) by Taylor series: order k of the series takes one solve with
// the one factorisation of a step, the constraint entering as G v + dg/dt = 0 at order k+1. Each
// step ends with a projection on g = 0 and G v + dg/dt = 0 in the mass metric and a check of the
// residuals. M may be singular on coordinates that carry no mass, constraints may be redundant:
// each step uses a maximal independent subset by priority.
//
// Use: pl_run_make, then pl_run_start, then pl_run_to_end (or pl_run_step), reading through a sink
// or pl_run_state. A setup is constant and shared; a run moves and belongs to one thread. Stepping
// allocates nothing.
// See theory (9.1) to (9.4).
#ifndef PL_SOLVE_H
#define PL_SOLVE_H

#include "program/jet.h"

// ------------------------------------------------------------------------------------------- setup
// A coordinate.  Names and units for columns and messages; start values are optional.
typedef struct pl_coordinate {
  const char *name, *unit;      // "theta", "rad"; "x[3]", "m".  unit NULL or "": none
  const char *v_name, *v_unit;  // "theta_dot", "rad/s"
  bool has_q, has_v;            // start value given: held
  double q, v;
  bool has_guess, has_v_guess;  // only steers the numerics
  double guess, v_guess;
  bool hidden;   // no column
  bool in_load;  // an energy or a force speaks of it: an equation has to
} pl_coordinate;

// A constraint row.
typedef struct pl_constraint_setup {
  const char* name;  // "g1", "c[3]": for messages, events and the mode text
  // of its multiplier: "lambda_g1", "N"; column NULL: no column (map equations)
  const char *column, *unit;
  bool velocity;  // nonholonomic: only on velocity level
  // 0 two-sided; +1: g >= 0, λ >= 0 in contact; -1: g <= 0, λ <= 0
  int side;
  // 0 declared, 1 map equations of `choose`; of dependent rows the lower is kept
  int priority;
  int contact;  // `while`: the one-sided constraint it goes with, or -1
  int n_needs;
  // of a map equation: constraints that it takes for granted; without one it does not hold
  const int* needs;
  bool off;            // starts inactive; an event may attach it
  bool minus;          // its column shows -λ: the sign convention of the model
  double restitution;  // of impacts on it, 0 inelastic
  bool rope;           // one-sided, a distance: it goes slack and taut
  // a component of a slip velocity (pl_friction_setup), no constraint of its own
  bool slip;
} pl_constraint_setup;

// Coulomb friction on a constraint, whose multiplier presses surfaces together. The slip velocity
// has one component in the plane and three in space (its part in the tangent plane); each is a
// constraint with velocity and friction set. While the surfaces stick, those rows are constraints;
// while they slip, their multipliers follow from that of the constraint. Coefficients are outputs
// of the motion patterns.
typedef struct pl_friction_setup {
  const char* name;  // of the constraint
  int constraint;    // whose multiplier presses
  int n_rows;        // 1 or 3
  int row[3];        // constraints of slip
  int limit;         // coefficient: |F| <= limit |λ| while it sticks
  int scale;         // |F| = scale |λ| while it slips
  int along[3];      // in space: scale times the direction of slip
  // in space: |F|² = sum P_ij m_i m_j of the multipliers; xx yy zz xy xz yz
  int metric[6];
} pl_friction_setup;

// An output column: sum of the contributions of all observer patterns.
typedef struct pl_column {
  const char *name, *unit;
} pl_column;

typedef enum pl_event_action_kind {
  PL_ACTION_STOP,
  PL_ACTION_RECORD,
  PL_ACTION_RELEASE,
  PL_ACTION_ATTACH,
  PL_ACTION_SET_Q,
  PL_ACTION_SET_V
} pl_event_action_kind;
typedef struct pl_event_action {
  pl_event_action_kind kind;
  int target;  // RELEASE, ATTACH: constraint; SET_*: coordinate
  int value;   // SET_*: index of the watched quantity that is the new value
} pl_event_action;

// `event label: when expr = 0`. The expression is watched quantity number `watch` (output of a
// watch pattern).
typedef struct pl_event_setup {
  const char* name;
  int watch;
  int direction;  // +1 rising, -1 falling, 0 both
  int n_actions;
  const pl_event_action* actions;
  // 1 + the watched quantity that is the size of its terms, 0 none: its rounding error
  int size;
} pl_event_setup;

// `branch cond`: condition number `output` of the branch patterns has this sign.
typedef struct pl_branch_setup {
  const char* text;  // "x2 < x1", for messages
  int output;        // left - right
  // +1: > 0 (or >= 0), -1: < 0, 0: = 0 (checked, not made an equation)
  int relation;
} pl_branch_setup;

// A body in space whose attitude is declared by Euler angles and integrated as a unit quaternion,
// which has no singular attitude. The coordinates of its angles φ, ϑ, ψ hold q_1, q_2, q_3 while
// the motion is integrated, and the angles in rows. Observers find q_1 .. q_3 there and the angles
// behind all coordinates: those of body k at n_q + 3 k.
typedef struct pl_attitude_setup {
  int angle[3];  // coordinates of φ, ϑ, ψ
  int scalar;    // coordinate of q_0
} pl_attitude_setup;
// Numbers of a setup as they were written, for runs on extended precision: a tape of
// constants, and which of its roots is which; -1: the double in the setup is exact.
typedef struct pl_exact_setup {
  const pl_tape* tape;
  const int *q, *v;  // start values that are given  (n_q)
  int t_0, t_end, dt;
} pl_exact_setup;

// A motion with its derivatives by parameters and start values, where contacts or events change
// it. Coordinates stand in blocks of n_q, constraints in blocks of n_c, for each direction two: a
// copy of the motion and its variation. The rows of the first block of constraints are varied, with
// the multipliers λ; those of the second are the constraints, with dλ.
typedef struct pl_varied {
  int n_directions, n_q, n_c;
  // of the motion; then as many derivatives by time, then by each direction
  int n_watched;
  // derivatives of the coefficients                       (n_directions x n_c)
  const double* restitution_slope;
} pl_varied;

typedef struct pl_setup {
  int n_q;
  const pl_coordinate* coordinates;  // (n_q)
  int n_c;
  const pl_constraint_setup* constraints;  // (n_c)
  int n_patterns;
  const pl_pattern* patterns;  // M, h, G, g: the motion
  int n_out;
  const pl_column* out;  // (n_out)
  int n_observers;
  const pl_pattern* observers;  // outputs are columns 0 .. n_out-1
  int kinetic, potential;       // output columns of T and V, or -1
  // of what is conserved where that is not their sum, as T2 - T0 + V; 0: it is
  int energy;
  bool energy_conserved;  // said by the model: then its drift is checked
  int n_events;
  const pl_event_setup* events;
  int n_watched;  // quantities watched
  int n_watch_patterns;
  const pl_pattern* watch;  // outputs are watched quantities
  int n_frictions;
  const pl_friction_setup* frictions;  // (n_frictions)
  int n_coefficients;                  // outputs of the motion patterns
  int n_branches;
  const pl_branch_setup* branches;
  int n_branch_outputs;
  int n_branch_patterns;
  const pl_pattern* branch_patterns;
  int n_attitudes;
  const pl_attitude_setup* attitudes;  // (n_attitudes)
  int n_poles;
  // coordinates ϑ of bodies that are integrated in Euler angles: a motion stops at multiples of
  // 180°
  const int* poles;
  const pl_exact_setup* exact;  // or NULL
  const pl_varied* varied;      // NULL: the motion alone, or nothing changes it
} pl_setup;

// -------------------------------------------------------------------------------------------- sink
typedef enum pl_event_kind {
  PL_EV_EVENT,     // `event label`
  PL_EV_RELEASE,   // a contact ended
  PL_EV_IMPACT,    // a contact was made with a velocity jump
  PL_EV_CONTACT,   // a contact was made without one
  PL_EV_SINGULAR,  // the constraints lose rank here
  PL_EV_STOP,      // `event label -> stop`
  PL_EV_SLACK,     // a rope went slack
  PL_EV_TAUT,      // a rope went taut, with or without a velocity jump
  PL_EV_STICK,     // surfaces that slipped stick
  PL_EV_SLIP       // surfaces that stuck slip, or slip the other way
} pl_event_kind;
// "event", "release", "impact", ... as in the JSON contract
extern const char* const pl_event_kind_name[];

typedef enum pl_row_kind {
  PL_ROW_START,
  PL_ROW_STEP,
  PL_ROW_BEFORE,
  PL_ROW_AFTER,
  PL_ROW_END
} pl_row_kind;

// The digits of a row whose numbers are wider than doubles: text writes number i of a part, or its
// negative, as short as it reads back, and returns the length.
typedef enum pl_row_part { PL_ROW_T, PL_ROW_Q, PL_ROW_V, PL_ROW_LAMBDA, PL_ROW_OUT } pl_row_part;
enum { PL_ROW_TEXT = 64 };
typedef struct pl_row_digits {
  void* user;
  int (*text)(void* user, pl_row_part part, int i, bool negative, char out[PL_ROW_TEXT]);
} pl_row_digits;

// A row of results; pointers are valid during the call.
typedef struct pl_row {
  double t;              // s
  const double *q, *v;   // (n_q)
  const double* a;       // accelerations (n_q)
  const double* lambda;  // (n_c), 0 where inactive or left out
  // false: this multiplier is not determined (redundant set)  (n_c)
  const bool* unique;
  const double* out;  // (n_out)
  const char* mode;   // "contact(h)", "free", "" without one-sided constraints
  pl_row_kind kind;
  const pl_row_digits* digits;  // NULL: the doubles are all there is
} pl_row;

typedef struct pl_event_record {
  pl_event_kind kind;
  const char* label;     // name of the event or constraint
  int index;             // of the event or constraint in the setup
  pl_row before, after;  // equal except for impacts, releases and SET
  double impulse;        // of an impact, N s along the gradient
  bool at_start;         // a contact that never held: wrong sign at the start
  bool jump;             // velocities jumped: before and after differ
  // CONTACT after infinitely many: those that were followed; else 0
  long bounces;
} pl_event_record;

// The numbers that a run computes with.
typedef enum pl_precision {
  PL_PRECISION_DOUBLE,
  // the state has 64 binary digits, rounded once a step; what is between is more exact
  PL_PRECISION_LONG,
  PL_PRECISION_QUAD  // 113 binary digits
} pl_precision;

typedef struct pl_stats {
  pl_precision precision;  // of the numbers
  long steps, rejections;
  int order;
  double h_min, h_max;  // s
  // largest |g| relative to the sum of its terms' sizes, after projection
  double max_g;
  // largest |G v + dg/dt| relative to its terms, after projection
  double max_gdot;
  double max_projection;  // largest relative correction of a projection
  // energy at the start; largest |E - E_0| relative to max(|T| + |V|); NaN unknown
  double energy_0, energy_drift;
  long n_events;
  int rank, rank_start;  // independent active constraints
  double t_singular;     // where the run met a singular position; NaN: nowhere
  long steps_implicit;   // of steps, those by the implicit method
  int order_implicit;    // its order, 0 where it was not used
  double t_implicit;     // when it was first used; NaN: never
  // columns of multipliers that were not determined at some time, "a, b"; NULL none
  const char* undetermined;
  double wall_s;  // this and what follows is not reproducible
  // steps were compiled; what was compiled before was found on disk
  bool compiled, stored;
  double compile_s;
  long steps_interpreted;  // steps before that, or all
  // what stood in the way of compiling; NULL: nothing, or it was not tried
  const char* why_interpreted;
} pl_stats;

// pl_sink: where results go. Any call may be NULL. A status other than PLEUEL_OK stops the run and
// is returned.
typedef struct pl_sink {
  void* user;
  pleuel_status (*begin)(void* user, const pl_setup* setup);
  pleuel_status (*row)(void* user, const pl_row* row);
  pleuel_status (*event)(void* user, const pl_event_record* event);
  pleuel_status (*end)(void* user, pleuel_status how, const char* message, const pl_stats* stats);
} pl_sink;

// --------------------------------------------------------------------------------------------- run
typedef enum pl_method {
  PL_METHOD_TAYLOR,    // series
  PL_METHOD_RADAU,     // implicit, for stiff motions
  PL_METHOD_AUTO,      // series; implicit where that is far cheaper
  PL_METHOD_REFERENCE  // Runge-Kutta with fixed steps of h_max, for tests
} pl_method;

// How the programs of a step are run.  The results are the same.
typedef enum pl_engine {
  PL_ENGINE_AUTO,  // interpreted, compiled as soon as the work that is left pays for it
  PL_ENGINE_INTERPRETER,
  PL_ENGINE_COMPILED  // compiled before the first step
} pl_engine;

struct pl_run;
typedef struct pl_run_options {
  double t_0, t_end;  // s; t_end may lie before t_0 (backwards)
  // relative local error; 0: what the arithmetic can do, which is the least
  double tol;
  double dt;       // output grid, s; 0: every step
  long count;      // output grid with this many intervals; 0: none
  double h_max;    // longest step, s; 0: none
  long max_steps;  // 0: none
  // PL_METHOD_RADAU: PLEUEL_UNSUPPORTED where a model has contacts or is too large
  pl_method method;
  pl_sink sink;
  // after every step; or NULL
  void (*progress)(void* user, double t, double t_end, double h, const pl_stats* stats);
  void* progress_user;
  pl_engine engine;
  // stop after the consistent start; accelerations are not computed
  bool start_only;
  bool general;  // use the patterns only; no step program is recorded
  // between two steps, and when it is interrupted; or NULL:
  void (*keep)(void* user, struct pl_run* run, bool interrupted);
  // pl_run_save may be called there
  void* keep_user;
  // PLEUEL_UNSUPPORTED where the model or the machine does not allow it
  pl_precision precision;
  // in three parts, for extended numbers; NULL: as the setup says, or the double
  const double *t_end_exact, *dt_exact;
  const pl_jit_places* places;  // of compiled steps; NULL: the usual ones
} pl_run_options;

typedef struct pl_run pl_run;

// pl_run_make reserves everything a run needs. Status PLEUEL_USAGE for a setup whose indices do not
// fit together, PLEUEL_NO_MEMORY. Free with pl_run_free (the sparse solver holds memory of its own;
// the rest goes with the arena).
pleuel_status pl_run_make(pl_job* job, const pl_setup* setup, const pl_run_options* options,
                          pl_run** out);
void pl_run_free(pl_run* run);

// ---- consistent start
typedef struct pl_start_move {  // a number that the constraints moved or chose
  int coordinate;
  bool velocity;
  // it was a given start value (moved by less than 1e-9 of the terms)
  bool given;
  double from, to;
} pl_start_move;

typedef enum pl_start_trouble {
  PL_START_FINE,
  PL_START_SEVERAL,   // several solutions fit: candidates lists them
  PL_START_NONE,      // none fits the constraints (and branches)
  PL_START_VIOLATED,  // given values violate constraint `constraint`
  PL_START_SINGULAR   // the start is a singular position
} pl_start_trouble;

typedef struct pl_start_report {
  pl_start_trouble trouble;
  int n_moves;
  const pl_start_move* moves;  // in order of coordinate, positions first
  int n_free;                  // positions that nothing determines: taken from guess or 0
  const int* free;             // their coordinates
  int n_candidates;            // distinct solutions that fit
  const double* candidates;    // (n_candidates x n_q), solution after solution
  int taken;                   // the candidate that is the start
  int constraint;              // VIOLATED: which constraint, else -1
  bool constraint_velocity;    // VIOLATED: on velocity level
  double residual;             // VIOLATED: |g| relative to its terms
  // VIOLATED: the coordinate that would have to move, -1 if no single one does
  int move_coordinate;
  bool move_velocity;
  double move_to;  // VIOLATED: to this value
  // one-sided constraints that closed the start without being given
  int n_sitting;
  const int* sitting;
  double largest_move;  // relative, of given values
} pl_start_report;

// pl_run_start finds consistent positions and velocities at t_0: given values are held, the rest
// moves from its guess. Status PLEUEL_CONTRADICTION for SEVERAL, NONE and VIOLATED,
// PLEUEL_SINGULAR, with the sentence in the job.
pleuel_status pl_run_start(pl_run* run);
const pl_start_report* pl_run_start_report(const pl_run* run);

// pl_run_start_at starts from these numbers, which must be consistent to 1e-9; they are projected.
pleuel_status pl_run_start_at(pl_run* run, double t, const double* q, const double* v);

// pl_run_start_from_angles does so where coordinates of angles hold these, and what stands for
// scalars of quaternions is ignored.
pleuel_status pl_run_start_from_angles(pl_run* run, double t, const double* q, const double* v);

// pl_run_start_partly starts from numbers of which those held are right; the others, in which the
// constraints must be linear, move by the least that meets the constraints.
pleuel_status pl_run_start_partly(pl_run* run, double t, const double* q, const double* v,
                                  const bool* held_q, const bool* held_v);

// A run whose setup has `varied` follows one of the motion alone. pl_sensitivity_make gives the
// sink for that run; started, it is handed over before the other is started, and goes with it.
struct pl_sensitivity* pl_sensitivity_make(pl_job* job, const pl_run* follower,
                                           const pl_setup* plain, pl_sink* sink);
void pl_sensitivity_attach(struct pl_sensitivity* p, pl_run* follower, pl_run* plain);

// pl_run_step takes one accepted step, not beyond t_end, with everything that happens in it.
// Status: PLEUEL_SINGULAR, PLEUEL_NUMERICAL, PLEUEL_INTERRUPTED (job->interrupted), or what the
// sink returned.
pleuel_status pl_run_step(pl_run* run);
// pl_run_to_end steps to t_end, writing rows; end of the sink is called, and begin if it was not.
// Calls pl_run_start when that was not done.
pleuel_status pl_run_to_end(pl_run* run);

// pl_run_save writes the state between two steps down, or reads it back: base.h, checkpoint.c.
void pl_run_save(pl_run* run, pl_keeper* k);
// pl_run_load goes on from a state that was kept of a run with the same setup and options but for
// the sink. The run was made without one and started; `sink` is that of what follows, whose begin
// is called. Status PLEUEL_FILE for bytes that are no such state, or when this machine computes
// other digits.
pleuel_status pl_run_load(pl_run* run, pl_keeper* k, const pl_sink* sink);

// Reading.  Arrays belong to the run and change with the next step.
double pl_run_time(const pl_run* run);
bool pl_run_done(const pl_run* run);             // t_end reached, or an event stopped it
const double* pl_run_q(const pl_run* run);       // (n_q)
const double* pl_run_v(const pl_run* run);       // (n_q)
const double* pl_run_a(const pl_run* run);       // (n_q)
const double* pl_run_lambda(const pl_run* run);  // (n_c)
const bool* pl_run_unique(const pl_run* run);    // (n_c)
const pl_stats* pl_run_stats(const pl_run* run);
double pl_run_tol(const pl_run* run);  // tolerance in use
// the one asked for was below what the arithmetic can do
bool pl_run_tol_raised(const pl_run* run);
bool pl_run_is_active(const pl_run* run, int constraint);
// Friction: whether it sticks, slips or is not there, and the signs of slip and pressing
// multiplier.
typedef enum pl_friction_mode {
  PL_FRICTION_NONE,
  PL_FRICTION_STICKS,
  PL_FRICTION_SLIPS
} pl_friction_mode;
typedef struct pl_friction_report {
  pl_friction_mode mode;
  int way, press;
} pl_friction_report;
pl_friction_report pl_run_friction(const pl_run* run, int friction);
// by an event, or off: it is not watched either
bool pl_run_is_released(const pl_run* run, int constraint);

// pl_run_dense evaluates the series of the last step at time t (within it). Any pointer may be
// NULL.
void pl_run_dense(const pl_run* run, double t, double* q, double* v, double* lambda);

// ---- run_to.c: a run as a program steps it
// pl_run_to steps to time t exactly, or to t_end where that comes first; with to_event it stops
// behind the first event.  Status as pl_run_step; PLEUEL_USAGE for a time that has passed.
pleuel_status pl_run_to(pl_run* run, double t, bool to_event);
// From here on rows are those of n times (kept by pointer), and those beside events.
void pl_run_rows_at(pl_run* run, const double* t, int n);
// The point as a row; pointers are valid until the run moves.
void pl_run_row(pl_run* run, pl_row* row);
// pl_run_dense with accelerations; false outside of the last step, and where the coordinates that
// are integrated are not those of the setup.
bool pl_run_dense_row(pl_run* run, double t, double* q, double* v, double* a, double* lambda);

// Accelerations and multipliers (pl_run_a, pl_run_lambda) at a state, with the constraints that are
// in force in another run of the same setup.
pleuel_status pl_run_point_as(pl_run* run, const pl_run* as, double t, const double* q,
                              const double* v);

#endif
