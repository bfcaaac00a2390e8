// worked, inside: the page of an analysis, what is written on it, and the files that write.
#ifndef PL_WORKED_IMPL_H
#define PL_WORKED_IMPL_H

#include "mechanics/mechanics.h"
#include "mechanics/sides.h"
#include "worked/worked.h"

// ---------------------------------------------------------------------- the page (solution_page.c)
typedef struct pl_structure_shown {  // a system with named entries
  bool told;
  int section;  // in which section, from 1
  int number;   // of the displayed system
} pl_structure_shown;

// What was written about one analysis: each thing is told once.
typedef struct pl_solution_page {
  const pl_derive_options* options;
  pl_solution* solution;
  pl_section* section;  // the one being written
  double began_ms;      // processor time at the beginning
  pl_claims claims;     // formulas that were displayed
  // of the first analysis: those of all sets of constraints that were made, itself first
  PL_VEC(pl_analysis*) sets;

  pl_analysis* first;  // the one of the start
  // in the coordinates of the model: itself, or for which this is proposed
  pl_analysis* base;
  int n_turns;       // of the first: sections for other sides
  bool has_section;  // of its own, or it is the first

  // numbers of equations; 0 none yet
  int number_lagrange1;  // the first of the first kind
  PL_VEC(int) lagrange1_numbers;
  int number_lambda, number_gdd, number_acceleration, number_lagrangian;
  PL_VEC(int) lagrange2_numbers;
  int* lambda_number;  // of the equation that shows λ                (n_g)

  // what was told
  pl_map* told;  // notes, by hash
  bool cases_told, loops_told, singular_told, open_told, proposal_told;
  bool* loop_told;                  // (n_loops)
  pl_structure_shown structure[2];  // of multipliers, of accelerations
} pl_solution_page;

void pl_page_open(pl_analysis* d, const pl_derive_options* options, pl_solution* solution);
// once the motion is derived: room for each constraint and loop
void pl_page_prepare(pl_analysis* d);
// pl_analysis_open, with a page.
pl_analysis* pl_page_analysis(pl_job* job, pl_model* whole, const pl_derive_options* options,
                              pl_solution* solution, const pl_stage* stage);
pl_analysis* pl_page_propose(pl_analysis* d);  // pl_propose, with a page
pl_analysis* pl_page_propose_for_rest(pl_analysis* d);

// -------------------------------------------------------------------------------- worked.c, sets.c
void pl_answer_one(pl_analysis* d, const pl_ask* ask);
// The analysis that answers: in the coordinates of the model, or with what is proposed.
pl_analysis* pl_serving(pl_analysis* d, const pl_ask* ask);
// that of the motion that is asked about; NULL: it failed
pl_analysis* pl_analysis_of(pl_analysis* first, const pl_ask* ask);
pl_analysis* pl_without_sticking(pl_analysis* first);  // energies do not know of friction

// ----------------------------------------------------------------------------------------- remarks
// the list of constraints, with notes (constraint_remarks.c)
void pl_describe_constraints(pl_analysis* d);
pleuel_status pl_report_contradiction(pl_analysis* d);  // E042
// once, before the first formula (stage_remarks.c)
void pl_tell_open(pl_analysis* d);
// contacts taken as closed, because nothing tells
void pl_note_undecided(pl_analysis* d);
// once, in the section that is open (proposal_remarks.c)
void pl_tell_proposal(pl_analysis* a);
// values over proposed angles get their definitions
void pl_define_proposed(pl_analysis* d);
// positions where the maps fail, once (singular_positions.c)
void pl_tell_singular(pl_analysis* d);
// the special case of this request (special_remarks.c)
void pl_say_special(pl_analysis* d);
void pl_tell_cases(pl_analysis* d);  // of all requests, once
// a formula that has no value for the given numbers
void pl_say_pole(pl_analysis* d, pl_expr e);
void pl_say_rank_at_start(pl_analysis* d);  // constraints that lose rank at the start
// a denominator that vanishes there
void pl_say_pole_at_start(pl_analysis* d, const pl_form* name, pl_expr e);
// false when the force of link is determined (shared_forces.c)
bool pl_say_shared(pl_analysis* d, int link);
// e still contains accelerations or multipliers: said (answer_value.c)
bool pl_say_unsolved(pl_analysis* d, pl_expr asked, pl_expr e);
// e changes with the sign of the velocity: which one is meant; > 0 then, or poison
pl_expr pl_say_way(pl_analysis* d, const pl_line* l, pl_expr e);
// why the start gives no velocities (motion_remarks.c)
void pl_say_from_unused(pl_analysis* d);
void pl_note_equilibrium_start(pl_analysis* d);  // remarks.c
void pl_note_attribution(pl_analysis* d, int link);
// of all analyses (assumptions.c)
void pl_list_assumptions(pl_analysis* d, pl_analysis** of, int n_of);

// ---------------------------------------------------------------------------------- side_remarks.c
// |x - a| = x - a: formulas hold on the side that was taken.
const pl_form* pl_fact_form(pl_analysis* d, const pl_fact* f);  // a - b >= 0 as b <= a
const pl_form* pl_facts_form(pl_analysis* d, const pl_fact* fact, int n);
const pl_form* pl_border_form(pl_analysis* d, pl_expr e);  // e = 0, of either sign
const pl_form* pl_moment_form(pl_analysis* d, double t);   // t = 0.5 s
// The analysis of d on whose sides a named motion starts; a answers, d or what is proposed for it.
pl_analysis* pl_analysis_around(pl_analysis* d, pl_analysis* a, const pl_motion* motion);
// The set of d with the opposite of some of its signs (sets.c).  NULL: not derived.
pl_analysis* pl_analysis_beyond(pl_analysis* d, const pl_fact* side, int n, const bool* through);
// How long a closed motion holds.  Its values from number `from` on assume it.
void pl_say_while(pl_analysis* d, int from);
// The values of a section from number `from` on assume the sides of d.
void pl_assume_sides(pl_analysis* d, pl_section* s, int from);
// Where the simulated motion leaves some, between two times.  false: not known.
bool pl_leave(pl_analysis* d, const pl_fact* side, int n, double from, double to, pl_leaving* out);
// Within a stage the motion leaves one of these: where, and what is zero there.
bool pl_motion_changes_sides(pl_analysis* d);  // a closed form of it ends there
bool pl_leaves_first(pl_analysis* d, const pl_stage* s, pl_leaving* out, pl_expr* crossed);
double pl_end_of_stage(const pl_stage* s);  // s; infinity where it is not known

// ------------------------------------------------------------------------------- condition_forms.c
// see pl_holds_if
pl_answer3 pl_condition_form(pl_analysis* d, pl_expr e, bool strict, const pl_form** form,
                             const char** text);
// a list; NULL: all hold
const pl_form* pl_conditions_form(pl_analysis* d, const pl_expr* e, int n, bool strict,
                                  const char** text);

// ------------------------------------------------------------------------------------ loops_text.c
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
void pl_claim_loops(pl_analysis* d);

// ------------------------------------------------------------------------------- structured_text.c
// A multiplier or acceleration shown over the names, the system before it once, and answered; false
// when there
// is no structure that contains it.  closed: its closed form, or poison when none was found.
bool pl_show_structured(pl_analysis* d, pl_symbol u, pl_expr closed);
// The same without display: only the value.
bool pl_answer_structured(pl_analysis* d, pl_symbol u);
// e hangs on accelerations and multipliers that have no closed form: shown over the names.
bool pl_show_value_structured(pl_analysis* d, pl_expr asked, pl_expr e);
void pl_structure_where(pl_analysis* d, pl_value* v);  // the names that its formulas contain
// the system of the multipliers was displayed
bool pl_structure_is_told(const pl_analysis* d);

// ------------------------------------------------------------------------------- writing (steps.c)
pl_section* pl_section_open(pl_analysis* d, const pl_ask* ask, const char* en, const char* de);
// Claims about what is displayed, see verify.h: on the motion, and for free symbols.
void pl_claim_that(pl_analysis* d, pl_claim_kind kind, pl_expr shown, pl_expr reference);
void pl_claim_free(pl_analysis* d, pl_claim_kind kind, pl_expr shown, pl_expr reference);
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

// ------------------------------------------------------------------------ details (step_details.c)
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
void pl_why_linear_motion(pl_analysis* d, int i);
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
// part of the conserved quantities
void pl_answer_momenta(pl_analysis* d);
// positions of rest with all contacts closed (answer_stages.c)
void pl_answer_closed(pl_analysis* first, const pl_ask* ask);
// a section for each later set of the motion
void pl_answer_stages(pl_analysis* first);
bool pl_answer_open(pl_analysis* d, const pl_ask* ask);  // asked about what does not hold: said
// multipliers of what is open are zero
const pl_ask* pl_without_open(pl_analysis* d, const pl_ask* ask);
// by pattern, with index i (answer_family.c)
pleuel_status pl_derive_families(pl_analysis* d);
void pl_answer_pending(pl_analysis* d, const pl_ask* ask);
const char* pl_text_of(pl_analysis* d, pl_expr e);  // one line, as displayed

#endif
