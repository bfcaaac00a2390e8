// witness, inside.
#ifndef PL_WITNESS_IMPL_H
#define PL_WITNESS_IMPL_H

#include "witness/witness.h"

enum { PL_SEED_OF_NUMBERS = 1 };  // of parameters without a number
#define PL_SMALL_PUSH 1e-5        // of the natural velocity: what leaves a position of rest

// A start, with the motion from it.
typedef enum pl_start_kind { PL_FROM_INIT, PL_FROM_NAMED, PL_FROM_RANDOM } pl_start_kind;
typedef struct pl_witnessed {
  pl_start_kind kind;
  const pl_motion* from;  // FROM_NAMED
  bool pushed;            // beside a position of rest
  pl_trace* trace;
} pl_witnessed;

// What is stated of the motion.
typedef enum pl_statement_kind {
  PL_EQUALS,    // shown = left
  PL_VANISHES,  // shown is zero
  PL_STAYS,     // shown is a constant of the motion
  PL_FOLLOWS    // left(t) = shown, along the motion from its start
} pl_statement_kind;
typedef struct pl_statement {
  pl_statement_kind kind;
  int section, stage;     // stage: whose constraints hold; 0 those of the start
  const pl_value* value;  // whose definitions are needed; NULL
  pl_expr shown, left;
  const char* name;  // of what is stated, as text
  // holds on the motion from this start only; NULL: on every motion
  const pl_motion* from;
  double most;  // largest value that the motion had so far
  // of several statements with the same number one has to hold (assemblies)
  int group;
} pl_statement;

// Where formula and motion disagree.
typedef struct pl_contradiction_found {
  double t, shown, motion;
  pl_start_kind start;
} pl_contradiction_found;

// A section that a search contradicts, and the sentence that stands in its place; {1} is `name`.
typedef struct pl_refusal {
  int section;
  const char* words[2];
  const pl_form* name;
  const char* of;  // as text
} pl_refusal;

typedef struct pl_witness {
  pl_job* job;
  pl_arena* arena;
  pl_pool* pool;
  pl_solution* solution;
  const pl_stage* stages;  // (n_stages)
  int n_stages;
  pl_model* model;  // with numbers
  pl_expr* rate;    // g'' of each constraint of the model, g' of those on velocities
  PL_VEC(pl_witnessed) starts;
  PL_VEC(pl_statement) statements;
  PL_VEC(pl_refusal) refusals;
  int n_searched;  // statements that were tried by a search
  // numbers by symbol id, and the same with inputs moved by the noise of a run
  double *value, *shifted;
  double q_size, v_size, a_size, l_size, e_size;  // largest numbers of each kind at the starts
  int n_value;
} pl_witness;

// witness_state.c: numbers at a sample.
void pl_state_open(pl_witness* w);
void pl_state_sizes(pl_witness* w);  // of the starts so far
// Fills the tables with the state of a sample. origin: the sample whose state x(0) speaks of; time
// counts from `t_0`.
void pl_state_set(pl_witness* w, const pl_trace* t, const pl_trace_sample* s,
                  const pl_trace_sample* origin, double t_0);
void pl_state_define(pl_witness* w, const pl_value* v);  // named intermediates of an answer
double pl_state_value(const pl_witness* w, pl_expr e);
// How far e may be off because the state is known to so many digits only; includes what cancels.
double pl_state_noise(const pl_witness* w, pl_expr e);
// the assumptions that were used hold
bool pl_state_is_valid(const pl_witness* w, const pl_tower* tower);

// witness_where.c: values at the place that a motion meets first.
// appends refusals, counts in w->n_searched
void pl_meet(pl_witness* w);

// witness_search.c: statements of the kind "none", "all", "stable", degrees of freedom.
// appends refusals, counts in w->n_searched
void pl_search(pl_witness* w);

// witness_rest.c: positions of rest of the equations as they stand, in all coordinates and
// multipliers.
enum { PL_MOST_AT_REST = 16, PL_MOST_ROWS = 48 };
typedef struct pl_rest_field pl_rest_field;
// with what holds at its start; NULL: too large, or by pattern
pl_rest_field* pl_rest_make(pl_witness* w, const pl_trace* t);
// nothing but drives of one coordinate hangs on the time
bool pl_rest_is_possible(const pl_rest_field* f);
int pl_rest_coordinates(const pl_rest_field* f);
// of these, names of a map that does not hold at the start
int pl_rest_idle(const pl_rest_field* f);
// of a coordinate of the recording; -1
int pl_rest_place_of(const pl_rest_field* f, int at);
int pl_rest_rows(const pl_rest_field* f);                 // constraints that hold, maps too
int pl_rest_constraint(const pl_rest_field* f, int row);  // in the setup
// The rank of the rows at a position, of those of coordinates only or all; -1: no number.
int pl_rest_rank(pl_rest_field* f, const double* q, bool with_velocities);
// Newton from q; `held` coordinates stay.  true: q and lambda are a position of rest.
bool pl_rest_find(pl_rest_field* f, double* q, double* lambda, const bool* held);
// The constraints alone: q moves to the nearest position, `held` coordinates stay.
bool pl_rest_place(pl_rest_field* f, double* q, const bool* held);
// What is left of the equations at a position of the constraints, as a part of the forces there;
// lambda as good as can be.
double pl_rest_left(pl_rest_field* f, const double* q, double* lambda);
// The forces jump there, as that of a spring of no length: no place of rest of the equations
// beside.
bool pl_rest_is_kink(pl_rest_field* f, const double* q);
// 1 stable, -1 unstable, 0 not decided: by the eigenvalues of the motion beside a position of rest,
// of at most two freedoms.
int pl_rest_stability(pl_rest_field* f, const double* q);

// How far the motion beside a position of rest is from one with this square of a frequency: near 0
// if it has it, NaN if that is not known.
double pl_rest_frequency_off(pl_rest_field* f, const double* q, double square);
// A position of rest where the coordinates that are known have their values, the others follow from
// the constraints; false: none was found.  *left: what is left of the forces then, NaN if it could
// not be put there.
bool pl_search_rest_at(pl_rest_field* f, const pl_trace* t, const double* at, const bool* known,
                       double* q, double* left);

// witness_near.c: limits, series, thresholds, frequencies; appends refusals, counts in
// w->n_searched.
void pl_search_near(pl_witness* w);

// witness_list.c: the statements of a solution.
void pl_statements_collect(pl_witness* w);
void pl_statement_add(pl_witness* w, pl_statement s);  // unless it shows nothing
// The symbol that a value is named after, when it is one of the motion; poison.
pl_expr pl_statement_subject(const pl_witness* w, const pl_value* v);
const pl_motion* pl_statement_motion(const pl_ask* ask);  // that `from` names; NULL

// witness_force.c: components of constraint forces.
void pl_statements_of_forces(pl_witness* w, int section);

#endif
