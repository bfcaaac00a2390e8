// mechanics: from a model to its equations and what follows from them. Everything here is a value,
// an expression over the
// symbols of the model or a number; what is written about it is the work of `worked`, which this
// folder does not know.
//
// The units of an expression are those of its symbols: SI throughout, angles in rad. Index ranges:
// n_q coordinates of the model,
// n_g constraints that hold, n_gen generalized coordinates.
#ifndef PL_MECHANICS_H
#define PL_MECHANICS_H

#include "algebra/algebra.h"
#include "mechanics/stage.h"
#include "model/model.h"

// ------------------------------------------------------------------------------------- coordinates
typedef struct pl_variable {
  pl_symbol q, v, a;
  // appears in the physics, not only in `choose`: moves a mass or occurs in a force or constraint
  bool carries;
  bool chosen;      // named by `choose`
  bool follows;     // a proposed angle that a constraint gives
  int fixed_by;     // index of the constraint that makes it constant or f(t), -1
  bool by_contact;  // fixed_by is one-sided: fixed while the contact lasts
  pl_expr fixed;    // its value then
  // as a function of the generalized coordinates and t; poison while unresolved
  pl_expr map;
  bool by_branch;  // map is one of several roots
  // index of the constraint that map solves, -1: of `choose`, -2: generalized itself or fixed, -3:
  // its own equation, which contains
  // no acceleration
  int solved_by;
  // d(constraint)/dq where it was solved, with the maps of that moment; poison: not solved alone
  pl_expr solved_slope;
  bool by_combination;  // of several equations, rather
} pl_variable;

// A constraint that holds.  Forces along the coordinates: λ times push.
typedef struct pl_bond {
  const pl_constraint* source;
  pl_expr g;        // left - right
  pl_expr place;    // vanishes at the same places, without the root of a distance
  int fixes;        // coordinate that it fixes, -1
  bool contact;     // one-sided
  bool velocity;    // contains velocities (linear): nonholonomic
  bool implied;     // depends on the others: no equation of its own
  bool integrated;  // given for velocities; g is its integral
  bool shared;      // depends on others: its force is not determined (redundant.c)
  // forces along the coordinates for λ = 1: the gradient, and the friction that slips with it
  // (n_q), raw
  pl_expr* push;
  const pl_stage_rub* rub;  // friction that slips; NULL
  // dg/dq, of a nonholonomic one dg/dv; negative by `convention lambda-minus` (n_q), raw
  pl_expr* gradient;
  pl_symbol lambda;
  pl_expr lambda_value;  // solved, on the constraints; poison if not
  bool lambda_known;
} pl_bond;

// A constraint that is not in the equations: it is open, off or released.  Its multiplier is zero.
typedef struct pl_open {
  const pl_constraint* source;
  bool contact;   // one-sided
  bool released;  // nothing keeps its side
  bool off;       // from the beginning, as written
} pl_open;

typedef struct pl_particle {  // a point mass or the centre of a body
  const char* label;          // "m1"
  const char* ascii;
  pl_expr mass;
  pl_expr inertia, angle;  // bodies; else poison
  int n;
  pl_expr at[3];  // position along the axes
} pl_particle;

// ∇g_implied = sum over all constraints of c ∇g.
typedef struct pl_dependence {
  int implied;
  pl_expr* c;  // (n_g)
  bool there;  // only where the constraints hold
} pl_dependence;

// The constraints whose gradients combine to that of one that is implied; n = 0: no combination was
// found.
typedef struct pl_implication {
  int n, *by;
} pl_implication;

// The orthonormal frame that a position map implies: e_i along dX/dq_i.
typedef struct pl_frame {
  int n;
  int coordinate[3];  // indices of coordinates
  pl_expr scale[3];   // |dX/dq_i|
} pl_frame;

typedef struct pl_proposal pl_proposal;    // propose.h
typedef struct pl_structure pl_structure;  // structured.h

// One or two coordinates that follow from others in several ways, the assemblies of a linkage. They
// keep their names; every
// formula holds in all assemblies (loops.c).
enum { pl_max_ways = 4, pl_max_assemblies = 8 };
enum { pl_max_sides = 6 };  // signs that an analysis takes for granted
// A velocity coefficient K = du/dq of a loop has a name that moves: K' = sum L q' (+ L_t).
typedef struct pl_slope {
  pl_symbol of, name, dot;
  pl_expr value, rate;
} pl_slope;
typedef struct pl_loop {
  int n, coordinate[2], bond[2];  // unknowns, and the constraints that determine them
  int n_ways;
  // over names, generalized coordinates, coordinates of loops before it; [1] over [0] too
  pl_expr value[pl_max_ways][2];
  pl_expr rate[2];              // velocities, the same in all ways; over the slopes
  pl_expr written_out[2];       // the same without them
  PL_VEC(pl_slope) slopes;      // K
  PL_VEC(pl_definition) bends;  // L, over the slopes
  PL_VEC(pl_definition) names;  // A, B, C, w of the eliminated equation
  // that equation: vanishes; contains coordinate[0] alone
  pl_expr eliminated;
  bool by_angle;  // it is A cos u + B sin u + C
  pl_expr real;   // >= 0 where the ways are real; poison: everywhere
  // det dg/du without its positive factors; changes its sign from way to way
  pl_expr side;
  int sign[pl_max_ways];  // of side; 0 not found
  bool picked;            // one of several ways, by a branch or the start
} pl_loop;

// A force on a coordinate of `choose` alone, for each unit of dX/dq.
typedef struct pl_chosen_force {
  int coordinate;
  pl_expr along;
} pl_chosen_force;

// ------------------------------------------------------------------------------------ the analysis
// One model, one set of constraints that hold, one set of generalized coordinates; and whatever was
// computed of them. Groups of
// members are filled in the order in which they stand, each by the file that its heading names.
typedef struct pl_analysis pl_analysis;
struct pl_analysis {
  pl_job* job;
  pl_arena* arena;
  pl_pool* pool;
  pl_model* model;  // with the constraints that hold, and the maps that hold with them
  pl_tower* tower;
  pl_towers* towers;  // the tower joins them
  double effort_s;    // for the search of a short form, of each formula; see pl_present
  struct pl_solution_page*
      page;  // where `worked` writes about this analysis; never looked into here

  // contact_sets.c: which constraints hold
  pl_model* whole;  // the model with all its constraints
  // where this set holds; NULL: not known, contacts are taken as closed
  const pl_stage* stage;
  // what is computed now is about a later stretch: start values are those of its beginning
  bool later;
  PL_VEC(pl_open) open;
  // coordinates of `choose` that mean nothing here: their map went with its constraint
  PL_VEC(pl_symbol) unnamed;

  // setup.c
  PL_VEC(pl_variable) q;  // (n_q)
  PL_VEC(pl_bond) g;      // (n_g)
  PL_VEC(pl_particle) particle;
  PL_VEC(pl_fact) facts;
  PL_VEC(pl_replace) fixed;    // q -> f, v -> f', a -> f'' of the fixed coordinates
  PL_VEC(pl_replace) contact;  // of the ones fixed by contact

  // frames.c: signs that nothing but the directions of unit vectors needs
  PL_VEC(pl_fact) directions;

  // sides.c: signs of places and velocities that were taken for granted
  PL_VEC(pl_fact) sides;
  int n_looked_at;  // assumptions of the tower that were looked at for them

  // numbers.c
  // numbers of parameters, start values; NaN unknown (by symbol id)
  double* value;
  int n_value;  // symbols it was made for

  // energies.c
  pl_expr T, V, L;   // in all coordinates, raw
  pl_expr written;   // the part of L that stands in `lagrangian`
  pl_expr* force;    // generalized forces without potential                     (n_q)
  bool dissipative;  // some force has no potential or is a Rayleigh function
  // d/dt dL/dv - dL/dq - Q, equals sum of lambda dg/dq (n_q), raw
  pl_expr* euler;

  // reduce.c, loops.c
  // coordinates without inertia whose own equation gives them: constraints behind a singular mass
  // matrix
  PL_VEC(int) hidden;
  // and no constraint was found behind it: the equations do not determine all accelerations
  bool mass_is_singular;
  bool reduced;             // every coordinate has a map
  PL_VEC(int) gen;          // generalized coordinates                                  (n_gen)
  PL_VEC(pl_replace) maps;  // q -> map, v -> map', a -> map'' of all that are not generalized
  pl_expr Tg, Vg, Lg;       // in generalized coordinates
  PL_VEC(pl_loop) loops;    // in the order in which they can be computed

  // implied.c: rank and contradictions
  pl_implication* implied_by;  // of each constraint                                       (n_g)
  // a constraint that no position satisfies together with the others; -1: none
  int contradicting;
  pl_expr contradiction;  // what it leaves, not zero
  pl_dof dof;

  // solve_motion.c
  PL_VEC(pl_chosen_force) chosen_forces;  // what acts on coordinates that only stand in `choose`
  bool solved;                            // accelerations and multipliers
  // q'' on the constraints, in q, v or generalized ones (n_q); poison where not
  pl_expr* acceleration;

  // redundant.c
  PL_VEC(pl_dependence) dependences;

  // structured.c: made when a closed form is too long; NULL if not found
  pl_structure *of_multipliers, *of_accelerations;
  bool multipliers_tried, accelerations_tried;

  // propose.c: generalized coordinates that the constraints suggest
  pl_proposal* proposal;           // what was found when nothing is chosen; NULL: not looked for
  pl_proposal* proposal_for_rest;  // the same where these coordinates fail at rest
  bool is_proposal;                // this is the analysis of the copy that chooses what is proposed

  // special.c, linearise.c: for the request that is answered now
  // given quantities in terms of others, k = b²/(4 m): the case that the given numbers are, of one
  // request
  PL_VEC(pl_replace) special;
  // the same for all requests: without it accelerations would divide by zero. Names that are seen
  // through
  PL_VEC(pl_replace) cases;
  // velocities that stay during the request: of equilibria for φ' = Ω, of modes holding φ
  PL_VEC(pl_replace) steady;
};

// -------------------------------------------------------------------------------------- analysis.c
// The analysis of one set of constraints of the model, nothing computed yet.
pl_analysis* pl_analysis_open(pl_job* job, pl_model* whole, const pl_stage* stage,
                              pl_towers* towers);
// Coordinates, energies, reduction, implied constraints.
pleuel_status pl_form_equations(pl_analysis* d);
// Everything up to accelerations and multipliers, in the special case that the given numbers are.
// PLEUEL_CONTRADICTION: see
// `contradicting`. ms: processor time of the equations and of their solution, added (2); may be
// NULL.
pleuel_status pl_derive_motion(pl_analysis* d, double* ms);
double pl_cpu_ms(void);  // processor time of this thread

// ---------------------------------------------------------------------------------- contact_sets.c
void pl_choose_set(pl_analysis* d, pl_model* whole, const pl_stage* stage);  // d->model, d->open
int pl_stage_row(const pl_stage* s, const char* name);  // -1: no such row, or s is NULL
const char* pl_stage_label(const pl_constraint* c);     // as the rows of a stage name it
pl_stage* pl_stage_like(pl_analysis* d);  // the set of constraints of d, as a stage of its own
// The same with the opposite of some signs: those that change come first.
pl_stage* pl_stage_turned(pl_analysis* d, const pl_fact* side, int n, const bool* through);
bool pl_is_same_set(const pl_analysis* d, const pl_stage* s);
// the set with every contact closed; NULL when none is open
pl_stage* pl_stage_all_closed(pl_analysis* d);
void pl_use_signs_of_open(pl_analysis* d);  // where signs decided, they are assumptions
// NULL: nothing slips on it
const pl_stage_rub* pl_slipping_on(const pl_analysis* d, const pl_constraint* c);
// what slips and what sticks is known, or nothing rubs
bool pl_knows_friction(const pl_analysis* d);
pl_expr pl_open_removed(pl_analysis* d, pl_expr e);  // multipliers of what is open are zero

// ----------------------------------------------------------------------------------------- setup.c
void pl_setup_facts(pl_analysis* d);  // the assumptions of the model
// over them; names of given quantities are seen through
pl_tower* pl_setup_tower(pl_analysis* d);
// coordinates, particles, links, facts, start numbers
pleuel_status pl_setup_coordinates(pl_analysis* d);
// coordinate = constant or f(t); contradictions; implied ones
pleuel_status pl_setup_trivial(pl_analysis* d);

// ---------------------------------------------------------------------------------------- insert.c
int pl_variable_index(const pl_analysis* d, pl_symbol q);  // of q, q' or q''; -1
// coordinates or velocities or accelerations
bool pl_has_coordinates(const pl_analysis* d, pl_expr e);
// with the dropped coordinates inserted (not contacts)
pl_expr pl_on_fixed(pl_analysis* d, pl_expr e);
pl_expr pl_on_contact(pl_analysis* d, pl_expr e);  // and with contacts closed
// and in generalized coordinates, if there are any
pl_expr pl_on_maps(pl_analysis* d, pl_expr e);
// The value of e (in coordinates, velocities, accelerations, multipliers) on the motion, in
// generalized coordinates.
pl_expr pl_on_motion(pl_analysis* d, pl_expr e);
pl_dimension pl_dimension_of_expr(pl_analysis* d, pl_expr e, bool* known);

// --------------------------------------------------------------------------------------- numbers.c
// parameters, abbreviations, start values (by symbol id)
double* pl_known_numbers(pl_analysis* d);
// at the parameters; NaN when it depends on more
double pl_number(pl_analysis* d, pl_expr e);
// proven, or that of the given numbers with the assumption on record; 0 open
int pl_sign_at_numbers(pl_analysis* d, pl_expr e);
// the same; where nothing decides, > 0 is assumed and on record
int pl_sign_or_positive(pl_analysis* d, pl_expr e);
// e = 0, as it stands or with the numbers of the parameters in it
pl_answer3 pl_zero_for_numbers(pl_analysis* d, pl_expr e);
// exact: parameters and abbreviations inserted
pl_expr pl_with_given_numbers(pl_analysis* d, pl_expr e);
// e over given quantities, not zero in general, is zero for their exact numbers
bool pl_vanishes_at_numbers(pl_analysis* d, pl_expr e);

// --------------------------------------------------------------------------------------- implied.c
// constraints that the others imply, by the rank of dg/dq
void pl_find_implied(pl_analysis* d);
pleuel_status pl_find_contradictions(pl_analysis* d);
// on record, and its status
pleuel_status pl_contradiction(pl_analysis* d, const pl_bond* l, pl_expr rest);
void pl_count_freedom(pl_analysis* d);     // d->dof
void pl_find_dependences(pl_analysis* d);  // d->implied_by, d->dependences
// manifold_rank.c: the rank of gradients where the constraints hold, in numbers; -1: no such points
// were found
int pl_rank_on_manifold(pl_analysis* d, const int* row, int m, const int* column, int n,
                        int* independent);
void pl_depend_on_manifold(pl_analysis* d, int k, const int* independent, int rank,
                           const int* column, int n);

// -------------------------------------------------------------------------------------- at_start.c
// of the gradients; -1 where their numbers are not known
int pl_rank_at_start(pl_analysis* d, int* n_rows);
bool pl_divides_by_zero_at_start(pl_analysis* d, pl_expr e);  // a denominator vanishes there

// --------------------------------------------------------------------------------------- special.c
// Given numbers for which a general formula has no value.
// a denominator inside e vanishes
bool pl_pole_at_numbers(pl_analysis* d, pl_expr e, pl_expr* base);
// such an e is solved for a given quantity, which joins d->special
bool pl_find_special(pl_analysis* d, pl_expr e);
pl_expr pl_on_special(pl_analysis* d, pl_expr e);  // with those inserted
// accelerations or multipliers that divide by zero: joins d->cases
bool pl_find_case(pl_analysis* d);

// ------------------------------------------------------------------------------------ conditions.c
// more > less, or more >= less; with `turned` it reads better the other way round, less < more.
typedef struct pl_inequality {
  pl_expr more, less;
  bool strict, turned;
} pl_inequality;
// e > 0 (strict) or e >= 0.  PL_YES: always, PL_NO: never; else the shortest condition.
pl_answer3 pl_holds_if(pl_analysis* d, pl_expr e, bool strict, pl_inequality* out);
// real >= 0 leaves no room for positive > 0
bool pl_conditions_exclude(pl_analysis* d, pl_expr real, pl_expr positive);

// -------------------------------------------------------------------------------------- energies.c
pleuel_status pl_energies(pl_analysis* d);  // T, V, L, forces, euler
// a force without potential acts along coordinate i
bool pl_pushed(pl_analysis* d, int i);
// Lagrange II of generalized coordinate i, raw; vanishes on the motion
pl_expr pl_second_kind(pl_analysis* d, int i);
// Names of results in e (T, V, E, force(label)) replaced by what they stand for; poison where that
// is unknown.
pl_expr pl_with_results(pl_analysis* d, pl_expr e);

// ------------------------------------------------------------------------------ frames.c, forces.c
bool pl_frame_find(pl_analysis* d, const pl_particle* k, pl_frame* out);
const char* pl_unit_vector(pl_analysis* d, int coordinate);  // "e_r"
// Force of one constraint on one particle: component = λ factor.
typedef struct pl_force {
  int n;
  // the coordinates of the mass span its space, so that no part of the force is missing
  bool whole;
  int reaction_to;       // particle whose force is the opposite of this one, -1
  const char* along[3];  // name of the unit vector, "e_x"
  pl_expr factor[3];
} pl_force;
// along the axes or the frame of the mass; false: neither
bool pl_force_on(pl_analysis* d, int link, int particle, pl_force* out);
// On each particle (n_particles), missing parts by reaction. Answers how many it acts on; *first:
// the first of them, -1.
int pl_forces_of(pl_analysis* d, int link, pl_force* out, int* first);
// |Z| = scale |λ| on each mass it acts on; poison when they differ
pl_expr pl_force_scale(pl_analysis* d, int link);

// ------------------------------------------------------------------------------ reduce.c, places.c
void pl_collect_generalized(pl_analysis* d);  // what is neither fixed nor mapped
pleuel_status pl_reduce(pl_analysis* d);      // generalized coordinates and maps
// while maps are made: with those that there are
pl_expr pl_mapped(pl_analysis* d, pl_expr e);
bool pl_open_coordinate(const pl_variable* c);  // neither fixed, chosen nor mapped
// Conditions on coordinates that are mapped, as conditions on generalized ones; -1: none speaks of
// such.
int pl_in_generalized(pl_analysis* d, const pl_condition* c, int n, pl_condition** out);
void pl_start_in_generalized(pl_analysis* d);  // `init` too

// --------------------------------------------------------------------------------- branch_points.c
// (dg/dx)² on the map, for a coordinate that is one of several roots: where it vanishes the
// constraint does not determine the
// coordinate; poison for others.
pl_expr pl_branch_slope_squared(pl_analysis* d, int i);
// at these places a constraint does not determine what it was solved for
bool pl_map_fails_at(pl_analysis* d, const pl_replace* at, int n);

// --------------------------------------------------------------------------------------- samples.c
bool pl_is_turned(pl_analysis* d, pl_expr e, pl_symbol q);    // q stands inside a function
void pl_draw_place(pl_analysis* d, pl_random* r, double* x);  // numbers by symbol id
// at all places drawn, and is real there
bool pl_keeps_sign(pl_analysis* d, pl_expr e);

// ----------------------------------------------------------------------------------------- loops.c
// with another one for two coordinates, or alone in several ways
bool pl_solve_loop(pl_analysis* d, int bond, bool pair);
bool pl_in_loop(const pl_analysis* d, int bond);
int pl_follower(const pl_analysis* d, int coordinate);  // the loop that determines it, -1
// sqrt(e) = outer sqrt(rest), without bars
void pl_take_squares_out(pl_analysis* d, pl_expr e, pl_expr* outer, pl_expr* rest);
bool pl_has_followers(const pl_analysis* d, pl_expr e);  // a coordinate of a loop occurs
int pl_assemblies(const pl_analysis* d);
// names, coordinates, velocities; out NULL: how many
int pl_loop_definitions(pl_analysis* d, int assembly, pl_definition* out);
// positions in generalized coordinates
pl_expr pl_on_assembly(pl_analysis* d, pl_expr e, int assembly);
// de/dq_i of generalized coordinate i, coordinates of loops following; i < 0: de/dt
pl_expr pl_by_coordinate(pl_analysis* d, pl_expr e, int i);
// in all assemblies, by points
pl_answer3 pl_holds_on_loops(pl_analysis* d, pl_expr left, pl_expr right);

// ---------------------------------------------------------------------------------- solve_motion.c
pleuel_status pl_solve_motion(pl_analysis* d);  // accelerations and multipliers
// sum of dX/dφ (x - X) over the maps x = X of `choose`: vanishes with them
pl_expr pl_along_map(pl_analysis* d, pl_symbol chosen);
// a coordinate of `choose` alone on which a force or potential acts; -1
int pl_loaded_by_name(const pl_analysis* d);
pl_expr pl_bond_acceleration(pl_analysis* d, int link);  // twice differentiated constraint, raw
// The equation of one coordinate solved for multiplier k, accelerations and other multipliers left
// as names: short where the closed
// form is long. The row with the fewest other multipliers is taken; its coordinate in *coordinate.
// Poison if there is none.
pl_expr pl_multiplier_by_row(pl_analysis* d, int link, int* coordinate);

// ------------------------------------------------------------------------------------- redundant.c
void pl_depend(pl_analysis* d, int implied, int m, const int* row, const pl_expr* c, int place);
// a multiplier that is not determined contains the free ones
void pl_share_forces(pl_analysis* d);
// of the same constraints in other coordinates
void pl_inherit_dependences(pl_analysis* a, const pl_analysis* from);
// e contains a multiplier that nothing determines
bool pl_not_determined(pl_analysis* d, pl_expr e);
const pl_dependence* pl_dependence_of(const pl_analysis* d, int link);  // NULL: it is independent
// the constraints that share a force with link (n_g)
void pl_group_sharing(const pl_analysis* d, int link, bool* in);
// λ_a + sum c_ka λ_k, which the motion determines, and its value.
void pl_determined_sum(pl_analysis* d, int a, pl_expr* sum, pl_expr* value);
// not only where the constraints hold
bool pl_dependences_hold_everywhere(const pl_analysis* d);
// Multipliers of the group with the smallest sum of squares: poison outside of it. False where
// there is none: too many, a contact
// among them, not solvable.
bool pl_smallest_multipliers(pl_analysis* d, const bool* in, pl_expr* lambda);  // (n_g)

// --------------------------------------------------------------------------------------- momenta.c
// Conserved total momenta (about < 0) and angular momenta of the whole system.
enum { PL_MAX_MOMENTA = 6 };
typedef struct pl_momentum {
  int axis;  // shifted along it, or turned about it
  bool turn;
  pl_expr centre[2];  // of a turn: on the two axes that follow; zero nodes at the origin
  pl_expr value;      // of the momentum
  pl_expr rate;       // its derivative: a combination of the constraints, zero where these hold
} pl_momentum;
int pl_find_momenta(pl_analysis* d, pl_momentum* out);  // (PL_MAX_MOMENTA)

// ------------------------------------------------------------------------------------- integrals.c
// exact zero or expression if `init` says so, else the symbol x(0)
pl_expr pl_start_value(pl_analysis* d, pl_symbol s);
void pl_motion_start(pl_analysis* d, const pl_motion* motion, const pl_variable* c, pl_expr* q0,
                     pl_expr* v0);
bool pl_scleronomic(pl_analysis* d);
bool pl_nonholonomic(const pl_analysis* d);  // some constraint contains velocities
bool pl_dissipates(pl_analysis* d);          // forces without potential do work
pl_expr pl_energy_integral(pl_analysis* d);  // sum v dL/dv - L, conserved or not
bool pl_energy_conserved(pl_analysis* d);    // the energy, or Jacobi's integral
// what is conserved then: sum v dL/dv - L, up to a total time derivative; or poison
pl_expr pl_jacobi_integral(pl_analysis* d);
// E in generalized coordinates if it is conserved, else poison
pl_expr pl_conserved_energy(pl_analysis* d);
// The velocity of the single generalized coordinate squared, from the conserved energy and the
// start of `motion`;
// false when there is none.  start_q, start_v: the start used.
bool pl_velocity_squared(pl_analysis* d, const pl_motion* motion, pl_expr* v2, pl_expr* start_q,
                         pl_expr* start_v);
pl_expr pl_without_velocity(pl_analysis* d, pl_expr e, pl_expr v2);  // q'^2 inserted
pl_answer3 pl_starts_in_equilibrium(pl_analysis* d, pl_expr q0, pl_expr v0);

// -------------------------------------------------------------------------------- one_dof_motion.c
// A motion reduced to one coordinate by every integral that is known: the velocities of cyclic
// coordinates follow from their momenta,
// the last velocity from the energy.
enum { pl_max_line = 8 };
typedef struct pl_line {
  int i;           // the coordinate that is left
  pl_expr v2;      // its velocity squared, in terms of it alone
  pl_expr q0, v0;  // its start
  int n;           // cyclic velocities, each in terms of q_i and v_i
  int cyclic[pl_max_line];
  pl_replace velocity[pl_max_line];
  pl_expr momentum[pl_max_line];  // the momentum, and its value at the start
  pl_expr momentum0[pl_max_line];
  int direction;  // of the motion after the start: +1, -1
  bool drag;      // not by the energy, and only while the motion goes this way
} pl_line;
bool pl_line_of(pl_analysis* d, const pl_motion* motion, pl_line* out);
// the same, or with drag as the square of the velocity
bool pl_line_from(pl_analysis* d, const pl_motion* motion, pl_line* out);
pl_expr pl_along_line(pl_analysis* d, const pl_line* l, pl_expr e);  // velocities inserted
// e changes with the sign of the velocity
bool pl_line_has_way(pl_analysis* d, const pl_line* l, pl_expr e);
// e with the velocities that the motion gives.  line, eliminated: how.
pl_expr pl_value_on(pl_analysis* d, const pl_motion* motion, pl_expr e, pl_line* line,
                    bool* eliminated);

// ------------------------------------------------------------------------------ non_unique_start.c
// at rest where the force has an unbounded slope: the motion is not unique
bool pl_escapes(pl_analysis* d);
// a motion that leaves after the time `wait`; poison
pl_expr pl_escape_motion(pl_analysis* d, pl_symbol* wait);

// ---------------------------------------------------------------------- laplace.c, linear_motion.c
// Laplace transforms: of sums of c t^n e^(a t) cos(b t + f), and back from fractions; poison where
// there is none of this kind.
enum { PL_MAX_POLES = 16 };
// s = value, s² = value, value(s) = 0
typedef enum pl_pole_kind { PL_POLE_REAL, PL_POLE_SQUARE, PL_POLE_QUADRATIC } pl_pole_kind;
typedef struct pl_laplace_pole {
  pl_pole_kind kind;
  pl_symbol s;
  pl_expr value;
  pl_expr part;  // what it contributes to the function of time
} pl_laplace_pole;
typedef struct pl_laplace_poles {
  int n;
  pl_laplace_pole at[PL_MAX_POLES];
} pl_laplace_poles;
pl_expr pl_laplace(pl_analysis* d, pl_expr f, pl_symbol s);
// poles: NULL or zeroed
pl_expr pl_laplace_back(pl_analysis* d, pl_expr F, pl_symbol s, pl_laplace_poles* poles);
// Coordinate i of a linear system as a function of t; poison if it is none. transform: its Laplace
// transform, may be NULL.
pl_expr pl_linear_motion(pl_analysis* d, int i, pl_laplace_poles* poles, pl_expr* transform);

// --------------------------------------------------------------------------------- closed_motion.c
typedef struct pl_linear_equation {
  pl_expr A, B, C;
} pl_linear_equation;  // x'' = A + B x + C x'
// false: A, B or C is not constant
bool pl_linear_equation_of(pl_analysis* d, int i, pl_linear_equation* out);
// Coordinate i as a function of time, over x(0), x'(0); poison. parts: the summands that it is made
// of, NULL or zeroed.
pl_expr pl_closed_motion(pl_analysis* d, int i, pl_laplace_poles* parts);
// e, the value of `name`, on its closed motion if name is of the state
pl_expr pl_as_function_of_time(pl_analysis* d, pl_expr e, pl_expr name);

#endif
