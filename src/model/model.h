// model: what a mechanical system is, whatever the syntax. A model is filled by a builder (lang is
// one, function calls are another), then checked once: names, units, families, rank of what can be
// told without a derivation. After pl_model_check it does not change.
//
// All expressions live in model->pool, all memory in the pool's arena.  Numbers are exact and SI.
#ifndef PL_MODEL_H
#define PL_MODEL_H

#include "units/units.h"
#include "expr/expr.h"

// An index range of a family: `for i in lo..hi`.  Blocks nest: outer points to the enclosing one.
typedef struct pl_block {
  struct pl_block* outer;  // NULL at the top
  pl_symbol index;         // role PL_R_INDEX
  pl_expr lo, hi, step;    // step poison: 1; bounds may use outer indices and integer params
  pl_span span;
} pl_block;

typedef struct pl_param {
  pl_symbol symbol;
  pl_expr value;          // exact, SI; poison if only declared
  bool has_unit;          // a unit was written
  const char* unit_text;  // as written, "m/s^2"; NULL
  bool literal;           // no name: a number with its unit that stands in a formula
  bool input;             // an `input`: given from outside while the motion goes on
  pl_span span;
} pl_param;

typedef struct pl_coord {
  pl_symbol symbol;  // PL_R_COORD, or PL_R_ARRAY for a family
  pl_expr lo, hi;    // bounds of a family (array), else poison
  bool has_unit;
  pl_span span;
} pl_coord;

// Abbreviations. One of given quantities only (no coordinate, no velocity, no t, no arguments: l =
// L - π R) STAYS in expressions as its symbol (role PL_R_PARAM, so that it is a given length like
// any other; its number is found by pl_model_values, its dimension by the check), and is displayed
// as a name. Any other is inserted while lowering.
typedef struct pl_let {
  // of a kept abbreviation: the symbol in expressions; of an inserted one: role PL_R_LOCAL, for
  // printing
  pl_symbol symbol;
  int n_args;
  bool inserted;  // its value was inserted wherever it was used
  // kept: in terms of params and earlier kept lets; inserted: with the inserted lets in it inserted
  pl_expr value;
  pl_span span;
} pl_let;

// Relation of an assumption, constraint, branch or condition: left rel right.
typedef enum pl_relation { PL_EQ, PL_GE, PL_LE, PL_GT, PL_LT, PL_NE } pl_relation;
typedef struct pl_condition {
  pl_expr left, right;
  pl_relation relation;
  pl_span span;
} pl_condition;

// r < l | e in 0..1 | N integer
typedef enum pl_assumption_kind { PL_A_RELATION, PL_A_IN, PL_A_INTEGER } pl_assumption_kind;
typedef struct pl_assumption {
  pl_assumption_kind kind;
  pl_condition condition;   // PL_A_RELATION
  pl_expr subject, lo, hi;  // PL_A_IN, PL_A_INTEGER
  pl_span span;
} pl_assumption;

// Axes: 1 to 3 of them, in the order of the components of points.
typedef struct pl_axis {
  const char* name;       // "x"
  const char* ascii;      // "x"
  const char* direction;  // "right" "left" "up" "down" "out", or NULL
  bool declared;
} pl_axis;

// A label: UTF-8 as shown, ASCII for machines, index expressions when it belongs to a family: c[i].
typedef struct pl_name {
  // "g1"; generated ones ("m1" for a mass without label, "1" for a constraint) are marked
  const char* text;
  const char* ascii;
  pl_expr index;  // poison, or the index of the label: c[i]
  bool generated;
} pl_name;

// components along the axes
typedef struct pl_point {
  int n;
  pl_expr at[3];
  pl_span span;
} pl_point;

typedef struct pl_mass {
  pl_name name;
  pl_expr mass;
  pl_point point;
  pl_block* block;  // the family it stands in, or NULL
  pl_span span;
} pl_mass;

// `point`
typedef struct pl_place_def {
  pl_name name;
  pl_point point;
  pl_block* block;
  pl_span span;
} pl_place_def;

// planar: centre, angle, mass, inertia about the axis through the centre
typedef struct pl_body {
  pl_name name;
  pl_expr mass, inertia, angle;
  pl_point centre;
  pl_block* block;
  pl_span span;
} pl_body;

// A body in space. Its mass, the energy of its turning and what holds between its axes stand in the
// lists of masses, loads and constraints; this is what they were made from.
typedef enum pl_axes_form {
  PL_AXES_NONE,
  PL_AXES_EULER,
  PL_AXES_QUATERNION,
  PL_AXES_VECTORS
} pl_axes_form;
typedef struct pl_spatial {
  pl_name name;
  pl_expr mass;
  pl_expr inertia[6];  // along the body axes: xx xy xz yy yz zz
  pl_axes_form form;
  pl_expr axes[9];  // three angles, four components of the quaternion, or three vectors
  pl_expr turn[9];  // component i in space of body axis j at 3 i + j
  pl_expr spin[3];  // angular velocity in space
  pl_point centre;
  pl_block* block;
  pl_span span, inertia_span;
} pl_spatial;

// acceleration g along sign * axis
typedef struct pl_gravity {
  pl_expr g;
  int axis;
  int sign;
  pl_span span;
} pl_gravity;

typedef enum pl_load_kind {
  PL_L_FORCE,       // vector on a point
  PL_L_TORQUE,      // on a body's angle or a coordinate
  PL_L_POTENTIAL,   // adds to V
  PL_L_KINETIC,     // adds to T
  PL_L_LAGRANGIAN,  // instead of T - V
  PL_L_RAYLEIGH,    // dissipation function
  PL_L_SPRING,      // stiffness, rest length, two points
  PL_L_DAMPER,      // coefficient, two points
  PL_L_DRAG,        // coefficient, point
  PL_L_COUPLE       // torque vector on a body in space: Q = vector · dω/dv
} pl_load_kind;
typedef struct pl_load {
  pl_load_kind kind;
  pl_name name;
  // force: unused; torque, potential, kinetic, lagrangian, rayleigh: the expression; spring k;
  // damper, drag c
  pl_expr value;
  pl_expr rest;          // spring: rest length, 0 if none
  pl_expr vector[3];     // force
  pl_point a, b;         // points of attack; a alone for force and drag
  pl_symbol coordinate;  // torque on a coordinate
  pl_expr spin[3];       // couple: the angular velocity ω of its body
  pl_block* block;
  pl_span span;
} pl_load;

typedef struct pl_constraint {
  pl_name name;
  pl_expr left, right;  // as written; g = left - right
  pl_expr g;
  pl_relation relation;    // PL_EQ, PL_GE, PL_LE
  const char* multiplier;  // name given by `with`, UTF-8, or NULL
  // its multiplier; ascii "lambda_g1", whatever letter `with` gives it on paper
  pl_symbol lambda;
  const char* while_label;  // contact it depends on, or NULL
  bool redundant_ok, off;
  bool has_velocity;  // contains velocities
  bool sticking;      // of the derivation: surfaces that stick to each other
  // it holds between the axes of this body in space, and is no constraint of its own; or NULL
  const char* body;
  pl_axes_form axes;  // which are given like this
  pl_block* block;
  pl_span span;
  pl_span relation_span;  // of left and right alone
} pl_constraint;

// `restitution e on label`: Newton's coefficient of impacts on a one-sided constraint.
typedef struct pl_restitution {
  pl_expr value;
  const char* label;  // of the constraint; "c[3]" for one member of a family, "c" for all
  pl_block* block;
  pl_span span;
} pl_restitution;

// `friction μ, static μs, surface v, at P on label`: Coulomb friction, its normal force that of the
// constraint.
typedef struct pl_friction {
  pl_expr kinetic, sticking;  // sticking: coefficient of static friction, poison: the kinetic one
  pl_point surface;           // velocity of the surface that it rubs against; n = 0: at rest
  pl_point at;                // where it acts on a body; n = 0: found from the constraint
  const char* label;
  pl_block* block;
  pl_span span;
} pl_friction;

typedef struct pl_choose {
  PL_VEC(pl_symbol) coords;
  // x1 = r cos φ; old is a coordinate as expression
  struct pl_map_equation {
    pl_expr old;
    pl_expr map;
    pl_span span;
  } * maps;
  int n_maps;
  pl_span span;
} pl_choose;

typedef struct pl_init {
  pl_expr time;    // `init at`; poison: the start of `simulate`
  pl_expr target;  // coordinate, velocity or element
  pl_expr value;   // exact
  bool guess;      // only steers the numerics
  pl_block* block;
  pl_span span;
} pl_init;

typedef enum pl_action_kind {
  PL_DO_STOP,
  PL_DO_RECORD,
  PL_DO_RELEASE,
  PL_DO_ATTACH,
  PL_DO_SET
} pl_action_kind;
typedef struct pl_action {
  pl_action_kind kind;
  const char* label;
  pl_expr target, value;
  pl_span span;
} pl_action;
typedef struct pl_event {
  pl_name name;
  pl_expr value;  // left - right of the condition
  int direction;  // +1 rising, -1 falling, 0 both
  PL_VEC(pl_action) actions;
  pl_span span;
} pl_event;

// What a request speaks of besides plain expressions of symbols: names of results such as T, V, E,
// λ, force(label). They stand in expressions as symbols of role PL_R_LOCAL made by
// pl_model_result_symbol.
typedef enum pl_result_kind {
  PL_RES_T,
  PL_RES_V,
  PL_RES_L,
  PL_RES_E,
  PL_RES_H,
  PL_RES_FORCE /* force(label), a vector */,
  PL_RES_FORCE_NORM /* norm(force(label)) */,
  PL_RES_NORMAL /* normal(label) */,
  PL_RES_DT /* dt(E) */,
  PL_RES_DIFF /* diff(T, φ') */,
  PL_RES_START /* E(0), λ(0), x''(0) */
} pl_result_kind;
typedef struct pl_result_name {
  pl_symbol symbol;
  pl_result_kind kind;
  const char* label;
  pl_expr of;    // DT, DIFF: an expression with names of results in it
  pl_symbol by;  // DIFF
} pl_result_name;

// Motion that a quantity belongs to: `from ϑ = 0 at rest`.
typedef struct pl_motion {
  bool given;
  pl_condition* from;
  int n_from;
  bool at_rest;
  pl_span span;
} pl_motion;

typedef enum pl_ask_kind {
  PL_ASK_DOF,
  PL_ASK_CONSTRAINTS,
  PL_ASK_LAGRANGE1,
  PL_ASK_LAGRANGE2,
  PL_ASK_LAGRANGIAN,
  PL_ASK_HAMILTONIAN,
  PL_ASK_NEWTON,
  PL_ASK_SOLVE,  // value: multiplier, x'' or x; of_time for x(t)
  PL_ASK_VALUE,  // a plain quantity, or its value where conditions hold
  PL_ASK_FORCE_OF,
  PL_ASK_FORCE_ON,
  PL_ASK_CONSERVED,
  PL_ASK_EQUILIBRIA,
  PL_ASK_MODES,
  PL_ASK_LIMIT,
  PL_ASK_SERIES,
  PL_ASK_THRESHOLD,
  PL_ASK_MAX,
  PL_ASK_MIN,
  PL_ASK_AVERAGE,
  PL_ASK_STABILITY,
  PL_ASK_EXPECT
} pl_ask_kind;
typedef enum pl_limit_kind {
  PL_LIMIT_TO /* m2 -> 0 */,
  PL_LIMIT_EQUAL /* m1 = m2 */,
  PL_LIMIT_MUCH_GREATER /* m1 >> m2 */
} pl_limit_kind;

typedef struct pl_ask {
  pl_ask_kind kind;
  const char* letter;  // "b", or NULL
  const char* text;    // the request as written: "solve λ"
  // what is asked, for SOLVE, VALUE, LIMIT, SERIES, MAX, MIN, EXPECT (left), AVERAGE
  pl_expr value;
  bool of_time;                // SOLVE x1(t)
  const char* label;           // FORCE_OF, FORCE_ON, EQUILIBRIA of, THRESHOLD
  const char* of_letter;       // LIMIT, SERIES of a letter
  PL_VEC(pl_symbol) frame;     // in (r, ϑ)
  PL_VEC(pl_condition) where;  // where, at, holding, for; EXPECT: element 0 is the claim
  pl_motion motion;
  pl_limit_kind limit;  // LIMIT
  pl_symbol variable;   // LIMIT, SERIES, THRESHOLD: the name that moves
  // LIMIT, SERIES: its target; for EQUAL and MUCH_GREATER the other name
  pl_expr to;
  pl_expr substitution_left, substitution_right;  // SERIES: m1 = m2 + δm; poison if none
  int order;                                      // SERIES: highest power shown; 0: default
  pl_span span;
} pl_ask;

typedef struct pl_plot {
  PL_VEC(pl_expr) y;
  pl_expr x;
  PL_VEC(const char*) y_text;
  const char* x_text;
  pl_span span;
} pl_plot;
// What the picture shows: `animate` and `draw`.
typedef enum pl_draw_kind {
  PL_DRAW_ANIMATE,
  PL_DRAW_SHOW,
  PL_DRAW_HIDE,
  PL_DRAW_LINE
} pl_draw_kind;
typedef struct pl_drawn {
  pl_draw_kind kind;
  // "weight", "trail", "force", "axes" ...; "" for a label alone; LINE: "line", "rod", "rope",
  // "spring", "damper"
  const char* what;
  const char* of;  // label, or NULL: all of them
  pl_point a, b;   // LINE
  pl_span span;
} pl_drawn;
// optional: left out when it has no number
typedef struct pl_output {
  const char* name;
  pl_expr value;
  pl_span span;
  bool optional;
} pl_output;
typedef struct pl_simulate {
  bool given;
  pl_expr from, to, step, tol;
  long count;
  pl_span span;
} pl_simulate;

// A statement that was understood but that this version does not compute: reported with its own
// code, never silently.
typedef struct pl_pending {
  const char* what;
  pl_span span;
} pl_pending;

typedef struct pl_model {
  pl_pool* pool;
  const pl_source* source;  // NULL when built by calls
  const char* title;        // from `system`, or NULL
  pl_language lang;         // of the file; PL_ENGLISH unless said
  bool lang_given;
  bool lambda_minus;             // convention lambda-minus
  PL_VEC(const char*) comments;  // `#:` lines in order
  PL_VEC(pl_param) params;
  PL_VEC(pl_coord) coords;  // in order of declaration
  PL_VEC(pl_let) lets;
  PL_VEC(pl_assumption) assumptions;
  pl_axis axes[3];
  int n_axes;
  PL_VEC(pl_block*) blocks;
  PL_VEC(pl_mass) masses;
  PL_VEC(pl_body) bodies;
  PL_VEC(pl_spatial) spatials;
  PL_VEC(pl_place_def) points;
  PL_VEC(pl_gravity) gravities;
  PL_VEC(pl_load) loads;
  PL_VEC(pl_constraint) constraints;
  PL_VEC(pl_restitution) restitutions;
  PL_VEC(pl_friction) frictions;
  pl_choose choose;
  PL_VEC(pl_condition) branches;
  PL_VEC(pl_init) inits;
  PL_VEC(pl_event) events;
  PL_VEC(pl_ask) asks;
  PL_VEC(pl_result_name) result_names;
  PL_VEC(pl_output) outputs;
  PL_VEC(pl_drawn) draws;
  PL_VEC(pl_plot) plots;
  pl_simulate simulate;
  PL_VEC(pl_pending) pending;
  // set by pl_model_check: some quantity carries a unit, so dimensions are checked
  bool uses_units;
  bool checked;  // set by pl_model_check
} pl_model;

pl_model* pl_model_make(pl_arena* a);

// Lookups; NULL or 0 when absent.
const pl_param* pl_model_param(const pl_model* m, pl_symbol s);
const pl_constraint* pl_model_constraint(const pl_model* m, const char* label);
// The coefficient that a constraint was given, NULL if none. A label of a family stands for all its
// members.
const pl_restitution* pl_model_restitution(const pl_model* m, const pl_constraint* c);
const pl_friction* pl_model_friction(const pl_model* m, const pl_constraint* c);
const pl_mass* pl_model_mass(const pl_model* m, const char* label);
// The letter of a result, or, when a declared name hides it, another one: T_kin for T where T is a
// tension.
const char* pl_model_letter(const pl_model* m, pl_arena* a, const char* letter);
// The column of T, V or E: the letter itself, unless a coordinate has a column of that name.
const char* pl_model_column(const pl_model* m, pl_arena* a, const char* letter);
// made on first use
pl_symbol pl_model_result_symbol(pl_model* m, pl_result_kind kind, const char* label);
// DT, DIFF
pl_symbol pl_model_result_derivative(pl_model* m, pl_result_kind kind, pl_expr of, pl_symbol by);
const pl_result_name* pl_model_result_name(const pl_model* m, pl_symbol s);

// The coordinates that have elements, one by one: scalars as declared, families expanded in order
// of index. Elements are PL_AT nodes with a number as index. Order: as declared.
typedef struct pl_flat_coords {
  pl_expr* at;
  int n;
} pl_flat_coords;
pl_flat_coords pl_model_flat_coords(const pl_model* m, pl_arena* a);

// Parameter values by symbol id, NaN where none is given: input of pl_eval.  (pl_symbol_count + 1)
double* pl_model_values(const pl_model* m, pl_arena* a);
// What is written behind the names of parameters and kept abbreviations, by symbol id; poison where
// nothing is.
pl_expr* pl_model_definitions(const pl_model* m, pl_arena* a);

// Names whose numbers decide how large the system is: bounds of families and sums, indices; and
// what
// those are defined by.  By symbol id.                                     (pl_symbol_count + 1)
bool* pl_model_sizes(pl_model* m, pl_arena* a);

// Instances of a block: the values of its indices, outer first.      n tuples of depth numbers
typedef struct pl_instances {
  int n, depth;
  long* index;
  pl_symbol* symbol;
} pl_instances;
pleuel_status pl_model_instances(pl_job* job, const pl_model* m, const pl_block* b,
                                 pl_instances* out);

// Expansion of small families: a copy of the model without blocks, each instance written out,
// elements turned into scalar coordinates named x1, x2, ... (ascii x_1, ...; CSV uses x[1]). Used
// by the derivation below `max_coords`.
pleuel_status pl_model_expand(pl_job* job, const pl_model* m, int max_coords, pl_model** out);

// pl_model_write_sums gives a copy in which masses, bodies, points, loads and constraints of
// families that contain a sum over j in 1..i are written out, one for each index; x[3] stays an
// element of its family. A model without such sums is only copied.
pleuel_status pl_model_write_sums(pl_job* job, pl_model* m, pl_model** out);

// pl_model_check infers dimensions through every equation, resolves families, and reports
// everything it finds wrong. Status PLEUEL_MODEL_ERROR when there is an error among the
// diagnostics.
pleuel_status pl_model_check(pl_job* job, pl_model* m);

// --------------------------------------------------------------------------------------- attitudes
// Where the angles of a body in space stood among the coordinates one by one, there stand q1, q2,
// q3 of its quaternion now. scalar: q0, behind them all
typedef struct pl_turned_place {
  pl_expr angle[3];
  int at[3];
  int scalar;
} pl_turned_place;
typedef struct pl_turned {
  pl_model* model;  // in the same pool; without start values, branches and requests
  PL_VEC(pl_turned_place) places;
  const char* why;  // an expression for which a body keeps its angles; NULL: none had to
} pl_turned;
// pl_model_turned gives a checked model with unit quaternions instead of the Euler angles of bodies
// in space. Outputs may still speak of angles. false: there is no such body, or the motion depends
// on the angles in a way that is singular itself.
bool pl_model_turned(pl_job* job, pl_model* m, pl_turned* out);

// -------------------------------------------------------------------------------------- dimensions
// pl_model_dimension gives the dimension of an expression over the symbols of a checked model
// (velocities, start values and elements of families follow from their coordinate). false: not
// known, or the model uses no units.
bool pl_model_dimension(const pl_model* m, pl_expr e, pl_dimension* out);

// ---------------------------------------------------------------------- physics of loads (loads.c)
pl_expr pl_mass_kinetic(pl_pool* p, pl_expr mass, const pl_expr* at, int n);  // m v²/2
pl_expr pl_body_kinetic(pl_pool* p, pl_expr inertia, pl_expr angle);          // J α'²/2
// potential in all the gravities
pl_expr pl_mass_weight(const pl_model* m, pl_expr mass, const pl_expr* at, int n);
// Along how many axes two points differ; the sum of the squares, and the difference along the last
// of them.
int pl_points_apart(pl_pool* p, const pl_point* a, const pl_point* b, pl_expr* squared,
                    pl_expr* only);
// length: distance of its ends
pl_expr pl_spring_energy(pl_pool* p, const pl_load* l, pl_expr length);
// Rayleigh's function R of a damper, of drag, or as given: Q = -dR/dv; poison for other loads.
pl_expr pl_load_dissipation(pl_pool* p, const pl_load* l, pl_expr length);
// The potential of a load: as given, or of a force or torque that is the same everywhere and
// always; poison if it is none.
pl_expr pl_load_potential(pl_pool* p, const pl_load* l);

// --set NAME=VALUE[unit]: replaces a parameter's value; NAME=EXPR over other parameters stays
// symbolic.
pleuel_status pl_model_set(pl_job* job, pl_model* m, const char* name, pl_expr value);

// pl_model_dump prints the checked model as text: what `pleuel dump --after=check` shows.
void pl_model_dump(pl_text* out, const pl_model* m);

#endif
