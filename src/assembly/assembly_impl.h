// assembly, inside: the translation of a checked model into the setup of a simulation.
#ifndef PL_ASSEMBLY_IMPL_H
#define PL_ASSEMBLY_IMPL_H

#include "assembly/assembly.h"

// Friction on a constraint, as expressions of its group.
typedef struct pl_friction_source {
  int constraint;  // of the model
  struct pl_record_group* group;
  int n_rows, first_row;  // links of slip
  int n_coefficients, first_coefficient;
  pl_expr slip[3], limit, scale, along[3], metric[6];
} pl_friction_source;

// Everything that stands in one `for` block, or outside of all: one pattern.
typedef struct pl_record_group {
  const pl_block* block;    // NULL: outside
  pl_instances instances;   // of the block; one without indices for the outside
  PL_VEC(int) constraints;  // of the model
  PL_VEC(int) frictions;    // of the recorder
  // coordinates that occur, as written: symbols and elements such as x[i-1]
  PL_VEC(pl_expr) atoms;
  pl_map* atom_at;  // id of an atom -> place + 1
  pl_map* seen;     // ids of nodes looked at
  pl_expr T, V, L;  // L: what `lagrangian` lines add
  // generalized forces without potential        (atoms), made when the atoms are known
  pl_expr* force;
} pl_record_group;

// What the motion is varied with: a parameter, or a start value.
typedef struct pl_direction {
  const char* name;  // "m2", "x0", "x_dot0"
  const char* unit;
  pl_dimension dimension;
  bool dimension_known;
  pl_symbol parameter;  // id 0: a start value
  int at;               // of this coordinate, -1 a parameter
  bool velocity;
} pl_direction;

typedef struct pl_variation {
  int n;
  const pl_direction* direction;
  // id of a coordinate (or family, or multiplier) -> id of the symbol of its variation
  pl_map* delta;
  // variations of the start values given: direction d, coordinate i at d n_q + i
  double *q, *v;
  pl_pattern* watch;  // derivatives of what is watched
  int n_watch;
} pl_variation;

typedef struct pl_recorder {
  pl_job* job;
  pl_arena* arena;
  pl_model* model;
  pl_pool* pool;
  pl_recording* out;
  double* value;  // by symbol id: parameters, then start values of scalars
  int n_value;
  pl_map* flat_at;  // id of a coordinate atom with a number as index -> global index + 1
  PL_VEC(pl_record_group*) groups;  // the outside first
  int* first_constraint;            // global index of the first row of each constraint of the model
  int n_constraints;                // with the map equations and the rows of slip
  PL_VEC(pl_friction_source*) frictions;
  bool dissipative, explicit_time;
  bool start_settled;       // values of x(0), E(0) are there
  pl_variation* variation;  // NULL: the motion alone
  bool exact;               // for numbers wider than doubles
  // by symbol id: what is written down for a parameter; poison: its number
  pl_expr* definition;
  int n_definitions;
  pl_expr *start_q, *start_v;      // of the coordinates, as given
  PL_VEC(pl_number_start) starts;  // in the order in which they were taken
} pl_recorder;

// record.c, record_turn.c: the steps of a recording
void pl_record_begin(pl_recorder* r);  // coordinates, numbers, times
pleuel_status pl_record_model(pl_recorder* r);
void pl_record_poles(pl_recorder* r);  // where Euler angles end
// beside a finished one, the form that is integrated
pleuel_status pl_record_turned(const pl_recorder* as);

// record_forces.c: energies and generalized forces of the groups.
void pl_group_energies(pl_recorder* r);
void pl_group_forces(pl_recorder* r, pl_record_group* g);

// record.c
pl_expr pl_record_plain(pl_recorder* r, pl_expr e);  // sums over indices written out
void pl_group_atoms(pl_recorder* r, pl_record_group* g, pl_expr e);  // adds the coordinates of e
double pl_record_number(pl_recorder* r, pl_expr e);                  // NaN when it is none

typedef struct pl_start_value {
  int at;
  bool velocity, guess;
  pl_expr value;
  const pl_instances* instances;  // whose indices stand in the value
  int instance;
} pl_start_value;
bool pl_record_index(pl_recorder* r, pl_expr e, long* out);  // a whole number
// every parameter in them has a number
pleuel_status pl_record_check(pl_recorder* r, const pl_expr* e, int n);
void pl_record_slots(pl_recorder* r, pl_record_group* g, const pl_expr* lambda, int n_c,
                     pl_tape_slots* out);
// slots of each instance
pleuel_status pl_record_place(pl_recorder* r, pl_record_group* g, pl_pattern_source* s);
// row of a constraint, -1
int pl_record_constraint(pl_recorder* r, const char* label);
pleuel_status pl_record_target(pl_recorder* r, pl_expr target, pl_start_value* out);
// e with elements of families replaced by their start values; poison where one is not known.
pl_expr pl_record_with_elements(pl_recorder* r, pl_expr e, const pl_coordinate* q);
// of a coordinate atom, -1
int pl_record_global(pl_recorder* r, pl_expr atom);

// record_numbers.c: numbers that may change later.
void pl_numbers_take_start(pl_recorder* r, const pl_start_value* s, const pl_coordinate* q);
void pl_numbers_make(pl_recorder* r);

// record_variation.c: the motion and its derivatives by parameters and start values.
pleuel_status pl_variation_begin(pl_recorder* r, const char* list);
// patterns for each of the motion
int pl_variation_count(const pl_recorder* r);
pleuel_status pl_variation_record(pl_recorder* r, pl_record_group* g, const pl_pattern_source* s,
                                  pl_pattern* out);
void pl_variation_of_start(pl_recorder* r, const pl_start_value* s);
pleuel_status pl_variation_setup(pl_recorder* r);
pl_expr pl_variation_by_atom(pl_pool* p, pl_expr e, pl_expr atom);
pl_expr pl_variation_by_parameter(pl_recorder* r, pl_expr e, const pl_direction* d);
// the variation of a coordinate or multiplier
pl_expr pl_variation_delta(pl_recorder* r, pl_expr atom);

// record_variation_events.c: the same for what switches the motion.
pleuel_status pl_variation_watch(pl_recorder* r, const pl_record_group* g, const pl_expr* e, int n,
                                 const pl_expr* lambda, const int* constraints, int n_c);
// the setup, when it has both
void pl_variation_switch(pl_recorder* r);

// record_wider.c: what wider numbers need.  Nothing happens where they are not asked for.
void pl_wider_begin(pl_recorder* r);
const pl_expr* pl_wider_definitions(pl_recorder* r);  // NULL: none
// start value of a coordinate, poison where none is known
pl_expr pl_wider_element(const pl_recorder* r, int at);
void pl_wider_start(pl_recorder* r, const pl_start_value* s, pl_expr value);
pleuel_status pl_wider_setup(pl_recorder* r);

// record_friction.c: rows of slip and their coefficients.
pleuel_status pl_group_friction(pl_recorder* r,
                                pl_record_group* g);  // before the forces of the group
pl_expr pl_record_friction_coefficient(const pl_friction_source* s, int k);
void pl_record_frictions(pl_recorder* r, pl_constraint_setup* constraint);
void pl_record_friction_symbols(pl_recorder* r);
int pl_record_friction_row(pl_recorder* r, pl_symbol lambda);
pl_expr pl_record_friction_force(pl_recorder* r, const pl_friction_source* s, int j);

// record_observe.c: energies, forces and outputs; events; branches.
pleuel_status pl_record_observers(pl_recorder* r);
pleuel_status pl_record_events(pl_recorder* r);
pleuel_status pl_record_branches(pl_recorder* r);

#endif
