// derive, inside: the state of one derivation, filled room by room in the order of this file.
#ifndef PL_WORKED_IMPL_H
#define PL_WORKED_IMPL_H

#include "worked/worked.h"

// ------------------------------------------------------------------------------------- coordinates
typedef struct pl_variable {
  pl_symbol q, v, a;
  // moves a mass or occurs in a force or constraint; false: only stands in `choose`
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
  // its own equation, which contains no acceleration
  int solved_by;
  // d(constraint)/dq where it was solved, with the maps of that moment; poison: not solved alone
  pl_expr solved_slope;
  bool by_combination;  // of several equations, rather
} pl_variable;

typedef struct pl_bond {  // a constraint at work
  const pl_constraint* source;
  pl_expr g;        // left - right
  pl_expr place;    // vanishes at the same places, without the root of a distance
  int fixes;        // coordinate that it fixes, -1
  bool contact;     // one-sided
  bool velocity;    // contains velocities (linear): nonholonomic
  bool implied;     // says nothing new
  bool integrated;  // given for velocities; g is its integral
  bool shared;      // depends on others: its force is not determined (redundant.c)
  // forces along the coordinates for λ = 1: the gradient and slipping friction   (n_q), raw
  pl_expr* push;
  const pl_stage_rub* rub;  // friction that slips; NULL
  // dg/dq, of a nonholonomic one dg/dv; negative by `convention lambda-minus`   (n_q), raw
  pl_expr* gradient;
  pl_symbol lambda;
  pl_expr lambda_value;  // solved, on the constraints; poison if not
  bool lambda_known;
  int number;  // of the equation that shows λ; 0 none yet
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
// c: (n_g); there: only where the constraints hold
typedef struct pl_dependence {
  int implied;
  pl_expr* c;
  bool there;
} pl_dependence;

// The orthonormal frame that a position map implies: e_i along dX/dq_i.
typedef struct pl_frame {
  int n;
  int coordinate[3];  // indices of coordinates
  pl_expr scale[3];   // |dX/dq_i|
} pl_frame;

// A formula that was displayed and must hold: shown == reference at every point of the motion's
// domain.
typedef enum pl_claim_kind {
  PL_CLAIM_MOTION,
  PL_CLAIM_ONE_TWO,
  PL_CLAIM_MAP,
  PL_CLAIM_ENERGY,
  PL_CLAIM_INSERTED,
  PL_CLAIM_OTHER,
  PL_N_CLAIMS
} pl_claim_kind;
typedef struct pl_claim {
  pl_claim_kind kind;
  pl_expr shown, reference;
  bool own_domain;  // compare for free symbols, not on the motion
} pl_claim;

// generalized coordinates that the constraints suggest, propose.c
typedef struct pl_proposal pl_proposal;
typedef struct pl_structure pl_structure;  // a linear system with named entries, structured_impl.h

// One or two coordinates that follow from others in several ways, the assemblies of a linkage. They
// keep their names; every formula holds in all assemblies (loops.c).
enum { pl_max_ways = 4, pl_max_assemblies = 8 };
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
  bool told;
} pl_loop;

// on a coordinate of `choose` alone, for each unit of dX/dq
typedef struct pl_chosen_force {
  int coordinate;
  pl_expr along;
} pl_chosen_force;

typedef struct pl_analysis pl_analysis;
struct pl_analysis {
  pl_job* job;
  pl_arena* arena;
  pl_pool* pool;
  pl_model* model;  // with the constraints that hold, and the maps that hold with them
  pl_tower* tower;
  pl_solution* solution;
  pl_section* section;  // the one being written
  const pl_derive_options* options;

  PL_VEC(pl_variable) q;
  PL_VEC(pl_bond) g;
  PL_VEC(pl_dependence) dependences;
  PL_VEC(pl_particle) particle;
  PL_VEC(pl_fact) facts;
  // numbers of parameters, start values; NaN unknown       (by symbol id)
  double* value;
  int n_value;  // symbols it was made for

  pl_expr T, V, L;   // in all coordinates, raw
  pl_expr written;   // the part of L that stands in `lagrangian`
  pl_expr* force;    // generalized forces without potential                     (n_q)
  bool dissipative;  // some force has no potential or is a Rayleigh function
  // d/dt dL/dv - dL/dq - Q, equals sum of lambda dg/dq        (n_q), raw
  pl_expr* euler;

  PL_VEC(pl_replace) fixed;    // q -> f, v -> f', a -> f'' of the fixed coordinates
  PL_VEC(pl_replace) contact;  // of the ones fixed by contact

  // coordinates without inertia whose own equation gives them: constraints behind a singular mass
  // matrix
  PL_VEC(int) hidden;
  // and no constraint was found behind it: the equations do not determine all accelerations
  bool mass_is_singular;
  bool reduced;             // every coordinate has a map
  PL_VEC(int) gen;          // generalized coordinates
  PL_VEC(pl_replace) maps;  // q -> map, v -> map', a -> map'' of all that are not generalized
  pl_expr Tg, Vg, Lg;       // in generalized coordinates

  // what acts on coordinates that only stand in `choose`, solve_motion.c
  PL_VEC(pl_chosen_force) chosen_forces;
  bool solved;  // accelerations and multipliers
  // q'' on the constraints, in q, v or generalized ones      (n_q); poison where not
  pl_expr* acceleration;

  int number_lagrange1;  // equation number of the first Lagrange I equation, 0 none
  PL_VEC(int) lagrange1_numbers;
  int number_lambda, number_gdd, number_acceleration, number_lagrangian;
  PL_VEC(int) lagrange2_numbers;
  PL_VEC(pl_claim) claims;
  // given quantities in terms of others, k = b²/(4 m): the case that the given numbers are, of one
  // request
  PL_VEC(pl_replace) special;
  // the same for all requests: without it accelerations would divide by zero. Names that are seen
  // through
  PL_VEC(pl_replace) cases;
  bool cases_told;
  // velocities that stay during the request: of equilibria for φ' = Ω, of modes holding φ
  PL_VEC(pl_replace) steady;
  pl_map* told;  // what has been said already (notes, definitions)
  bool multipliers_tried, accelerations_tried;
  double began_ms;  // processor time at the beginning
  // made when a closed form is too long; NULL if not found
  pl_structure *of_multipliers, *of_accelerations;
  PL_VEC(pl_loop) loops;  // in the order in which they can be computed
  bool loops_told;
  struct pl_proposal* proposal;  // what was found when nothing is chosen; NULL: not looked for
  struct pl_proposal* proposal_for_rest;  // the same where these coordinates fail at rest
  bool singular_told;                     // positions where the maps fail
  bool is_proposal;  // this is the analysis of the copy that chooses what is proposed

  // sets of constraints (sets.c)
  pl_model* whole;  // the model with all its constraints
  // where this set holds; NULL: not known, contacts are taken as closed
  const pl_stage* stage;
  PL_VEC(pl_open) open;
  // coordinates of `choose` that mean nothing here: their map went with its constraint
  PL_VEC(pl_symbol) unnamed;
  pl_dof dof;
  pl_analysis* first;  // the one of the start
  pl_analysis* base;   // in the coordinates of the model: itself, or for which this is proposed
  PL_VEC(pl_analysis*) sets;  // of the first analysis: all that were made, itself first
  // signs of places and velocities that were taken for granted (sides.c)
  PL_VEC(pl_fact) sides;
  int n_looked_at;   // assumptions of the tower that were looked at for them
  bool has_section;  // of its own, or it is the first
  int n_turns;       // of the first: sections for other sides
  bool open_told;
  // what is answered now is about a later stretch: start values are those of its beginning
  bool later;
};

// ------------------------------------------------------------------------------------------ sets.c
void pl_choose_set(pl_analysis* d, pl_model* whole, const pl_stage* stage);  // d->model, d->open
// that of the motion that is asked about; NULL: it failed
pl_analysis* pl_analysis_of(pl_analysis* first, const pl_ask* ask);
pl_analysis* pl_without_sticking(pl_analysis* first);  // energies do not know of friction
// positions of rest with all contacts closed
// The set of d with the opposite of some of its signs (sets.c).  NULL: not derived.
pl_analysis* pl_analysis_beyond(pl_analysis* d, const pl_fact* side, int n, const bool* through);
void pl_answer_closed(pl_analysis* first, const pl_ask* ask);
// a section for each later set of the motion
void pl_answer_stages(pl_analysis* first);
bool pl_answer_open(pl_analysis* d, const pl_ask* ask);  // asked about what does not hold: said
// multipliers of what is open are zero
const pl_ask* pl_without_open(pl_analysis* d, const pl_ask* ask);
// what slips and what sticks is known, or nothing rubs
bool pl_knows_friction(const pl_analysis* d);
// NULL: nothing slips on it
const pl_stage_rub* pl_slipping_on(const pl_analysis* d, const pl_constraint* c);
void pl_tell_open(pl_analysis* d);  // once, before the first formula
// contacts taken as closed, because nothing tells
void pl_note_undecided(pl_analysis* d);
pl_expr pl_open_removed(pl_analysis* d, pl_expr e);
const pl_form* pl_border_form(pl_analysis* d, pl_expr e);  // e = 0, of either sign
const pl_form* pl_moment_form(pl_analysis* d, double t);   // t = 0.5 s

// ----------------------------------------------------------------------------------------- sides.c
// |x - a| = x - a: formulas hold on the side that was taken.
enum { pl_max_sides = 6 };
int pl_taken_sides(pl_analysis* d, const pl_fact** out);  // of this analysis, so far
// It does not speak of velocities.
bool pl_side_is_of_place(const pl_analysis* d, const pl_fact* f);
const pl_form* pl_fact_form(pl_analysis* d, const pl_fact* f);  // a - b >= 0 as b <= a
const pl_form* pl_facts_form(pl_analysis* d, const pl_fact* fact, int n);
// The analysis of d on whose sides a named motion starts; a answers, d or what is proposed for it.
pl_analysis* pl_analysis_around(pl_analysis* d, pl_analysis* a, const pl_motion* motion);
// How long a closed motion holds.  Its values from number `from` on assume it.
void pl_say_while(pl_analysis* d, int from);
// The values of a section from number `from` on assume the sides of d.
void pl_assume_sides(pl_analysis* d, pl_section* s, int from);
// The sides of an analysis and of what is proposed beside it, over names that the simulation knows;
// at most 2 pl_max_sides.
int pl_known_sides(pl_analysis* d, pl_fact* out);
// Where the simulated motion leaves some, between two times.  false: not known.
bool pl_leave(pl_analysis* d, const pl_fact* side, int n, double from, double to, pl_leaving* out);
// Within a stage the motion leaves one of these: where, and what is zero there.
bool pl_leaves_first(pl_analysis* d, const pl_stage* s, pl_leaving* out, pl_expr* crossed);
double pl_end_of_stage(const pl_stage* s);  // s; infinity where it is not known
bool pl_same_sides(pl_analysis* d,
                   const pl_stage* s);  // what the stage takes for granted d does too
// worked.c
// derived as far as the motion
pl_analysis* pl_analysis_make(const pl_analysis* like, const pl_stage* stage);
void pl_answer_one(pl_analysis* d, const pl_ask* ask);
// The analysis that answers: in the coordinates of the model, or with what is proposed.
pl_analysis* pl_serving(pl_analysis* d, const pl_ask* ask);

// ----------------------------------------------------------------------------------------- setup.c
void pl_setup_facts(pl_analysis* d);  // the assumptions of the model
// over them; names of given quantities are seen through
pl_tower* pl_setup_tower(pl_analysis* d);
// coordinates, particles, links, facts, start numbers
pleuel_status pl_setup_coordinates(pl_analysis* d);
// coordinate = constant or f(t); contradictions; implied ones
pleuel_status pl_setup_trivial(pl_analysis* d);
pleuel_status pl_contradiction(pl_analysis* d, const pl_bond* l, pl_expr rest);  // reports E042
int pl_variable_index(const pl_analysis* d, pl_symbol q);  // of q, q' or q''; -1
// coordinates or velocities or accelerations
bool pl_has_coordinates(const pl_analysis* d, pl_expr e);
// with the dropped coordinates inserted (not contacts)
pl_expr pl_on_fixed(pl_analysis* d, pl_expr e);
pl_expr pl_on_contact(pl_analysis* d, pl_expr e);  // and with contacts closed
// and in generalized coordinates, if there are any
pl_expr pl_on_maps(pl_analysis* d, pl_expr e);
// proven, or that of the given numbers with the assumption on record; 0 open
int pl_sign_at_numbers(pl_analysis* d, pl_expr e);
// the same; where nothing tells, > 0 is assumed and told
int pl_sign_or_positive(pl_analysis* d, pl_expr e);
// at the parameters; NaN when it depends on more
double pl_number(pl_analysis* d, pl_expr e);
// e = 0, as it stands or with the numbers of the parameters in it
pl_answer3 pl_zero_for_numbers(pl_analysis* d, pl_expr e);

// manifold_rank.c: the rank of gradients where the constraints hold, in numbers; -1: no such points
// were found
int pl_rank_on_manifold(pl_analysis* d, const int* row, int m, const int* column, int n,
                        int* independent);
void pl_depend_on_manifold(pl_analysis* d, int k, const int* independent, int rank,
                           const int* column, int n);
// start_rank.c
// exact: parameters and abbreviations inserted
pl_expr pl_with_given_numbers(pl_analysis* d, pl_expr e);
void pl_say_rank_at_start(pl_analysis* d);  // constraints that lose rank at the start
// a denominator that vanishes there
void pl_say_pole_at_start(pl_analysis* d, const pl_form* name, pl_expr e);
// special.c: given numbers for which a general formula has no value
// e over given quantities, not zero in general, is zero for their exact numbers
bool pl_vanishes_at_numbers(pl_analysis* d, pl_expr e);
bool pl_pole_at_numbers(pl_analysis* d, pl_expr e, pl_expr* base);  // a denominator inside e does
// such an e is solved for a given quantity, which joins d->special
bool pl_find_special(pl_analysis* d, pl_expr e);
pl_expr pl_on_special(pl_analysis* d, pl_expr e);  // with those inserted
void pl_say_special(pl_analysis* d);
// a formula that has no value for the given numbers
void pl_say_pole(pl_analysis* d, pl_expr e);
// accelerations or multipliers that divide by zero: joins d->cases
bool pl_find_case(pl_analysis* d);
void pl_tell_cases(pl_analysis* d);  // once
// conditions.c: e > 0 (strict) or e >= 0. PL_YES: always, PL_NO: never; else the shortest form of
// the condition and its text.
pl_answer3 pl_holds_if(pl_analysis* d, pl_expr e, bool strict, const pl_form** form,
                       const char** text);
// a list; NULL: all hold
const pl_form* pl_conditions_form(pl_analysis* d, const pl_expr* e, int n, bool strict,
                                  const char** text);
// real >= 0 leaves no room for positive > 0
bool pl_conditions_exclude(pl_analysis* d, pl_expr real, pl_expr positive);
// energies.c
pleuel_status pl_energies(pl_analysis* d);  // T, V, L, forces, euler
// frames.c
bool pl_frame_find(pl_analysis* d, const pl_particle* k, pl_frame* out);
const char* pl_unit_vector(pl_analysis* d, int coordinate);  // "e_r"
// reduce.c
void pl_collect_generalized(pl_analysis* d);  // what is neither fixed nor mapped
pleuel_status pl_reduce(pl_analysis* d);      // generalized coordinates and maps
// while maps are made: with those that there are
pl_expr pl_mapped(pl_analysis* d, pl_expr e);
// constraints without the roots of distances
void pl_find_places(pl_analysis* d);
bool pl_open_coordinate(const pl_variable* c);  // neither fixed, chosen nor mapped
// propose.c
// the analysis with what the constraints suggest; NULL: nothing was found
pl_analysis* pl_propose(pl_analysis* d);
pl_analysis* pl_propose_for_rest(pl_analysis* d);  // the same for positions of rest
// a new angle that does not lead
bool pl_follows_by_constraint(const pl_analysis* a, pl_symbol q);
void pl_tell_proposal(pl_analysis* a);  // once, in the section that is open
// values over proposed angles get their definitions
void pl_define_proposed(pl_analysis* d);
// branch_points.c
// at these places a constraint does not determine what it was solved for
bool pl_map_fails_at(pl_analysis* d, const pl_replace* at, int n);
void pl_tell_singular(pl_analysis* d);  // such places, once
// samples.c
bool pl_is_turned(pl_analysis* d, pl_expr e, pl_symbol q);    // q stands inside a function
void pl_draw_place(pl_analysis* d, pl_random* r, double* x);  // numbers by symbol id
// at all places drawn, and is real there
bool pl_keeps_sign(pl_analysis* d, pl_expr e);
// places.c Conditions on coordinates that are mapped, as conditions on generalized ones; -1: none
// speaks of such.
int pl_in_generalized(pl_analysis* d, const pl_condition* c, int n, pl_condition** out);
void pl_start_in_generalized(pl_analysis* d);  // `init` too
// worked.c
// coordinates, energies, reduction, implied constraints
pleuel_status pl_form_equations(pl_analysis* d);
// loops.c
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
void pl_claim_loops(pl_analysis* d);
// loops_text.c
void pl_show_loop(pl_analysis* d, int loop);
void pl_show_loop_velocities(pl_analysis* d);
void pl_tell_loops(pl_analysis* d);  // positions and velocities, once
// formulas of this request are over the names of loops
bool pl_speaks_of_loops(const pl_ask* ask);
pl_expr pl_without_slopes(pl_analysis* d, pl_expr e);  // coefficients written out
// a position: shown, one value for each assembly
bool pl_answer_follower(pl_analysis* d, pl_symbol q);
void pl_answer_positions(pl_analysis* d);  // kinematics without requests
// what picks an assembly; NULL: there is one
const char* pl_branch_text(pl_analysis* d, int assembly, pl_math math);
// values over followers get their definitions, one value for each assembly
void pl_spread_assemblies(pl_analysis* d);
// solve_motion.c
pleuel_status pl_solve_motion(pl_analysis* d);  // accelerations and multipliers
// |Z| = scale |λ| on each mass it acts on; poison when they differ (answer_force.c)
pl_expr pl_force_scale(pl_analysis* d, int link);
// e still contains accelerations or multipliers: said (answer_value.c)
bool pl_say_unsolved(pl_analysis* d, pl_expr asked, pl_expr e);
// sum of dX/dφ (x - X) over the maps x = X of `choose`: vanishes with them
pl_expr pl_along_map(pl_analysis* d, pl_symbol chosen);
// a coordinate of `choose` alone on which a force or potential acts; -1
int pl_loaded_by_name(const pl_analysis* d);
pl_expr pl_bond_acceleration(pl_analysis* d, int link);  // twice differentiated constraint, raw
// The equation of one coordinate solved for multiplier k, accelerations and other multipliers left
// as names: short where the closed form is long. The row with the fewest other multipliers is
// taken; its coordinate in *coordinate. Poison if there is none.
pl_expr pl_multiplier_by_row(pl_analysis* d, int link, int* coordinate);
// momenta.c: of the whole system, beside those of cyclic coordinates
void pl_conserved_momenta(pl_analysis* d);
// escape.c
// at rest where the force has an unbounded slope: the motion is not unique
bool pl_escapes(pl_analysis* d);
// a motion that leaves after the time `wait`; poison
pl_expr pl_escape_motion(pl_analysis* d, pl_symbol* wait);
// redundant.c
void pl_depend(pl_analysis* d, int implied, int m, const int* row, const pl_expr* c, int place);
void pl_share_forces(pl_analysis* d);
// of the same constraints in other coordinates
void pl_inherit_dependences(pl_analysis* a, const pl_analysis* from);
// e contains a multiplier that nothing determines
bool pl_not_determined(pl_analysis* d, pl_expr e);
// false when the force of link is determined
bool pl_say_shared(pl_analysis* d, int link);
// structured.c: what is too long to be written out, in named intermediates. NULL when there is no
// such system.
pl_structure* pl_structure_of_multipliers(pl_analysis* d);
pl_structure* pl_structure_of_accelerations(pl_analysis* d);
// structured_text.c. A multiplier or acceleration shown over the names, the system before it once,
// and answered; false when there is no structure that contains it. closed: its closed form, or
// poison when none was found.
bool pl_show_structured(pl_analysis* d, pl_symbol u, pl_expr closed);
// The same without display: only the value.
bool pl_answer_structured(pl_analysis* d, pl_symbol u);
// e hangs on accelerations and multipliers that have no closed form: shown over the names.
bool pl_show_value_structured(pl_analysis* d, pl_expr asked, pl_expr e);
void pl_structure_where(pl_analysis* d, pl_value* v);  // the names that its formulas contain
// the system of the multipliers was displayed
bool pl_structure_is_told(const pl_analysis* d);
// names in order, for the points of the motion
int pl_structure_definitions(pl_analysis* d, pl_definition* out, int max);
// claims.c
void pl_claim_that(pl_analysis* d, pl_claim_kind kind, pl_expr shown, pl_expr reference);
void pl_claim_free(pl_analysis* d, pl_claim_kind kind, pl_expr shown, pl_expr reference);
void pl_claims_check(pl_analysis* d);

// ------------------------------------------------------------------------------- writing (steps.c)
pl_section* pl_section_open(pl_analysis* d, const pl_ask* ask, const char* en, const char* de);
void pl_heading(pl_analysis* d, const char* en, const char* de);
// Sentences; {1}.. are inserts.
// inserts: const pl_form*
pl_step* pl_say(pl_analysis* d, const char* en, const char* de, int n, ...);
pl_step* pl_show(pl_analysis* d, const pl_form* formula);  // unnumbered
// next number
pl_step* pl_show_numbered(pl_analysis* d, const pl_form* formula);
pl_step* pl_row(pl_analysis* d, const char* en, const char* de, const pl_form* formula,
                const char* margin);
void pl_step_after(pl_step* s, const char* en, const char* de);
// number at the parameters, if there is one
void pl_step_value(pl_analysis* d, pl_step* s, pl_expr e, pl_dimension dim);
void pl_step_refs(pl_step* s, int n, ...);
// value of the section, number and unit filled
pl_value* pl_answer(pl_analysis* d, const char* name, pl_expr e, const pl_form* form);
// the shorter of the two, if they are equal
pl_expr pl_as_shown(pl_analysis* d, pl_expr e, const pl_form* form);
double pl_cpu_ms(void);  // processor time of this thread
pl_dimension pl_dimension_of_expr(pl_analysis* d, pl_expr e, bool* known);
const char* pl_display(pl_analysis* d, double x, pl_dimension dim, bool angle);

// Short hands for forms
const pl_form* pl_f(pl_analysis* d, pl_expr e, pl_style style);  // presented
const pl_form* pl_fs(pl_analysis* d, pl_symbol s);               // a symbol
// plain form
const pl_form* pl_fe(pl_analysis* d, pl_expr e);
// of a result, unless a declared name hides it: then another
const char* pl_letter(pl_analysis* d, const char* letter);
const pl_form* pl_fl(pl_analysis* d, const char* letter);  // the same as a form
// a name: T, Z1
const pl_form* pl_fn(pl_analysis* d, const char* name);
const pl_form* pl_feq(pl_analysis* d, const pl_form* l, const pl_form* r);  // l = r
const pl_form* pl_frel(pl_analysis* d, const pl_form* l, const char* op, const pl_form* r);
const pl_form* pl_flist(pl_analysis* d, const pl_form* const* f, int n);
// left - right in the order written
const pl_form* pl_difference_form(pl_analysis* d, pl_expr left, pl_expr right);
// a sum that begins without a minus, if it can
const pl_form* pl_positive_first(pl_analysis* d, const pl_form* f);
const pl_form* pl_potential_form(pl_analysis* d, pl_expr raw, pl_expr normal);
// one flat sum of sums
const pl_form* pl_joined_sum(pl_analysis* d, const pl_form* const* part, int n);
const pl_form* pl_fref(pl_analysis* d, int number);  // "(4)"

// --------------------------------------------------------------------------------- details (why.c)
// Lines in front of the one that they explain, shown with `--steps full`.
void pl_why_first_kind(pl_analysis* d, int i);
void pl_why_differentiated(pl_analysis* d, int link);
// inserted: linear in the multipliers, vanishes on the motion
void pl_why_multiplier(pl_analysis* d, int link, pl_expr inserted);
void pl_why_frame(pl_analysis* d, const pl_particle* k, const pl_frame* f);
void pl_why_second_kind(pl_analysis* d, int i);
void pl_why_energy(pl_analysis* d, pl_expr E);
void pl_why_cyclic(pl_analysis* d, int i);
void pl_why_uniform(pl_analysis* d, int i, pl_expr x);
// x'' = A + B x + C x'
void pl_why_linear(pl_analysis* d, int i, pl_expr A, pl_expr B, pl_expr C);
void pl_why_linear_motion(pl_analysis* d, int i);  // linear_motion.c
void pl_why_oscillations(pl_analysis* d, const pl_expr* M, const pl_expr* K, int n);
void pl_why_series(pl_analysis* d, pl_expr f, pl_symbol variable, pl_expr to, int lead,
                   const pl_expr* c, int n);

// ---------------------------------------------------------------------------------------- sections
// Each answers one kind of request and writes into d->section.
void pl_answer_dof(pl_analysis* d, const pl_ask* ask);
void pl_answer_constraints(pl_analysis* d, const pl_ask* ask);
void pl_answer_lagrange1(pl_analysis* d, const pl_ask* ask);
void pl_answer_lagrangian(pl_analysis* d, const pl_ask* ask);
void pl_answer_lagrange2(pl_analysis* d, const pl_ask* ask);
void pl_answer_hamiltonian(pl_analysis* d, const pl_ask* ask);
void pl_answer_solve(pl_analysis* d, const pl_ask* ask);
void pl_answer_conserved(pl_analysis* d, const pl_ask* ask);
void pl_answer_force(pl_analysis* d, const pl_ask* ask);
void pl_answer_equilibria(pl_analysis* d, const pl_ask* ask);
void pl_answer_modes(pl_analysis* d, const pl_ask* ask);
void pl_answer_threshold(pl_analysis* d, const pl_ask* ask);
void pl_answer_limit(pl_analysis* d, const pl_ask* ask);
void pl_answer_series(pl_analysis* d, const pl_ask* ask);
void pl_answer_value(pl_analysis* d, const pl_ask* ask);
void pl_answer_expect(pl_analysis* d, const pl_ask* ask);
// a quantity where conditions hold (answer_where.c)
void pl_answer_where(pl_analysis* d, const pl_ask* ask);
// the value contains what it is the value of
bool pl_is_circular(pl_analysis* d, pl_expr name, pl_expr value);
// in numbers, with closed loops; false: not possible, nothing is said
bool pl_where_in_loops(pl_analysis* d, const pl_ask* ask);
typedef struct pl_line pl_line;
// with the velocities that the motion gives
pl_expr pl_value_on(pl_analysis* d, const pl_motion* motion, pl_expr e, pl_line* line,
                    bool* eliminated);
// by pattern, with index i (answer_family.c)
pleuel_status pl_derive_families(pl_analysis* d);
void pl_answer_pending(pl_analysis* d, const pl_ask* ask);

// Lagrange II of generalized coordinate i, raw; vanishes on the motion
pl_expr pl_second_kind(pl_analysis* d, int i);
// exact zero or expression if `init` says so, else the symbol x(0)
pl_expr pl_start_value(pl_analysis* d, pl_symbol s);

// Laplace transforms: of sums of c t^n e^(a t) cos(b t + f), and back from fractions; poison where
// there is none of this kind.
enum { PL_MAX_POLES = 16 };
typedef struct pl_laplace_poles {
  int n;
  const pl_form* at[PL_MAX_POLES];  // equation that a pole or a pair of them solves
  pl_expr part[PL_MAX_POLES];       // what it contributes to the function of time
} pl_laplace_poles;
pl_expr pl_laplace(pl_analysis* d, pl_expr f, pl_symbol s);
// poles: NULL or zeroed
pl_expr pl_laplace_back(pl_analysis* d, pl_expr F, pl_symbol s, pl_laplace_poles* poles);
// coordinate i as a function of time, over x(0), x'(0); poison (answer_solve.c)
pl_expr pl_closed_motion(pl_analysis* d, int i);
// e, the value of `name`, on its closed motion if name is of the state
pl_expr pl_as_function_of_time(pl_analysis* d, pl_expr e, pl_expr name);
void pl_why_transform(pl_analysis* d, int i, pl_expr transform, const pl_laplace_poles* poles);
// coordinate i of a linear system as a function of t; poison if it is none
pl_expr pl_linear_motion(pl_analysis* d, int i, pl_laplace_poles* poles);

// motion along an energy integral (eliminate.c) The velocity of the single generalized coordinate
// squared, from the conserved energy and the start of `motion`; false when there is none. start_q,
// start_v: the start used.
bool pl_velocity_squared(pl_analysis* d, const pl_motion* motion, pl_expr* v2, pl_expr* start_q,
                         pl_expr* start_v);
// A motion reduced to one coordinate by every integral that is known: the velocities of cyclic
// coordinates follow from their momenta, the last velocity from the energy.
enum { pl_max_line = 8 };
struct pl_line {
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
};
// eliminate.c
void pl_motion_start(pl_analysis* d, const pl_motion* motion, const pl_variable* c, pl_expr* q0,
                     pl_expr* v0);
bool pl_line_of(pl_analysis* d, const pl_motion* motion, pl_line* out);
// the same, or with drag as the square of the velocity
bool pl_line_from(pl_analysis* d, const pl_motion* motion, pl_line* out);
// e changes with the sign of the velocity: which one is meant; > 0 then, or poison
pl_expr pl_say_way(pl_analysis* d, const pl_line* l, pl_expr e);
void pl_say_from_unused(pl_analysis* d);  // why the start gives no velocities
pl_expr pl_along_line(pl_analysis* d, const pl_line* l, pl_expr e);  // velocities inserted
// coordinate i is a pure number under sin or cos
bool pl_is_angle(pl_analysis* d, int i);
// a force without potential acts along coordinate i (answer_conserved.c)
bool pl_pushed(pl_analysis* d, int i);
// E in generalized coordinates if it is conserved, else poison
pl_expr pl_conserved_energy(pl_analysis* d);
// The value of e (in coordinates, velocities, accelerations, multipliers) on the motion, in
// generalized coordinates.
pl_expr pl_on_motion(pl_analysis* d, pl_expr e);
pl_expr pl_energy_integral(pl_analysis* d);  // sum v dL/dv - L, conserved or not
bool pl_energy_conserved(pl_analysis* d);    // the energy, or Jacobi's integral
// what is conserved then: sum v dL/dv - L, up to a total time derivative; or poison
pl_expr pl_jacobi_integral(pl_analysis* d);
bool pl_dissipates(pl_analysis* d);  // forces without potential do work
// those along generalized coordinate i (energies.c)
pl_expr pl_generalized_force(pl_analysis* d, int i);
bool pl_scleronomic(pl_analysis* d);
bool pl_nonholonomic(const pl_analysis* d);  // some constraint contains velocities
pl_expr pl_without_velocity(pl_analysis* d, pl_expr e, pl_expr v2);  // q'^2 inserted
pl_answer3 pl_starts_in_equilibrium(pl_analysis* d, pl_expr q0, pl_expr v0);
// Names of results in e (T, V, E, force(label)) replaced by what they stand for; poison where that
// is unknown.
pl_expr pl_with_results(pl_analysis* d, pl_expr e);
const char* pl_text_of(pl_analysis* d, pl_expr e);  // one line, as displayed
// Notes on the start and on force attribution (notes.c)
void pl_note_equilibrium_start(pl_analysis* d);
void pl_note_attribution(pl_analysis* d, int link);

#endif
