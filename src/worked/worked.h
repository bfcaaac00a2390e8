// derive: from a checked model to equations and to the worked solution, each step with its reason.
//
// pl_derive answers the requests of the model (`ask`, or the standard ones when there is none) as
// sections of steps and
// values. Formulas are forms, ready for notation; values carry the expression too. Everything
// displayed is claimed, and
// each claim is certified against raw differentiation of the model (claims), never against the
// tower that produced it.
#ifndef PL_WORKED_H
#define PL_WORKED_H

#include "algebra/algebra.h"
#include "mechanics/claims.h"
#include "mechanics/stage.h"
#include "model/model.h"
#include "notation/notation.h"
#include "present/present.h"
#include "verify/verify.h"

// ------------------------------------------------------------------------------------------- steps
typedef enum pl_step_kind {
  PL_STEP_TEXT,  // a sentence; {1}, {2} ... stand for inserts
  // a displayed formula, maybe numbered, maybe with its number in SI on the right
  PL_STEP_EQUATION,
  // a row of a table: label, content, number at the right margin ("constraints g1 = ... -1")
  PL_STEP_ROW,
  PL_STEP_HEADING,  // a heading inside a section: "Limits"
  PL_STEP_NOTE      // a remark that belongs here (also among the notes when it has a code)
} pl_step_kind;

typedef struct pl_step {
  pl_step_kind kind;
  // TEXT, HEADING, NOTE, ROW label; by language. {1}.. are inserts
  const char* words[2];
  int n_inserts;
  const pl_form* const* inserts;  // (n_inserts)
  const pl_form* formula;         // EQUATION, ROW content; NULL if none
  const char* after[2];           // words after the formula: "solves g4", "unstable"; NULL if none
  int number;                     // (4); 0 unnumbered.  Numbers run through the whole solution
  int n_refs;
  int refs[4];     // numbers of the equations it follows from
  bool has_value;  // the right margin shows = value unit
  double value;
  const char* value_name;  // what the value is when it is not the left-hand side: "ω"; NULL
  const char* unit;        // Unicode; "" for pure numbers
  const char* margin;      // ROW: right margin text ("6", "-1"); NULL if none
  bool detail;             // shown only with --steps full
} pl_step;

// ------------------------------------------------------------------------------------------ values
typedef struct pl_component {
  const char* along;
  pl_expr expr;
  const pl_form* form;
  double number;
} pl_component;

// One answer in the sense of the JSON contract.  Absent parts: NULL, poison, NaN, n = 0.
typedef struct pl_value {
  // spelling of expr: "lambda_g1", "x1_ddot", "E", "equilibrium 1", "omega^2"
  const char* name;
  const char* of;  // constraint, mode, ...
  const char* on;  // mass
  const char* at;  // "equilibrium 1"
  // of a frequency and of a threshold: the position of rest that is meant, along the coordinates
  int n_place;
  pl_component* place;
  const char* branch;       // condition that picks it, as text
  pl_expr holds_while;      // > 0 where it holds; poison: everywhere
  const pl_form* form;      // as displayed (right-hand side)
  const pl_form* lhs_form;  // displayed left-hand side, when it is an equation
  pl_expr expr;             // right-hand side
  pl_expr lhs;              // left-hand side of an equation, or poison
  int n_components;
  pl_component* components;
  // SI at the model's parameters; NaN if it depends on the state or on free names
  double number;
  const char* unit;     // ASCII, "m/s^2", "rad", "1"
  const char* display;  // "48.1897 deg", "-23.544 N"; NULL
  int n_assuming;
  const char** assuming;  // texts "r < l"
  const char* stability;  // "stable" "unstable" "marginal"
  const char* exists_if;
  const char* stable_if;  // conditions as expr text, or NULL
  int n_free;
  const char** free_names;
  int conserved;           // -1 not said, 0 no, 1 yes
  const char* because[2];  // reason, by language
  int passed;              // expect: -1 not an expect, 0, 1
  pl_expr got;             // expect: what it is instead
  int order;               // series: terms up to this power are shown; -1 else
  // named intermediates in order of use
  int n_where;
  const char** where_name;
  pl_expr* where_expr;
  // the simulated motion contradicts it, or another formula of its section
  bool withdrawn;
} pl_value;

typedef struct pl_section {  // one request
  const char* letter;        // NULL without letter
  // the request as written: "solve λ"; the canonical words for standard requests
  const char* item;
  const char* title[2];  // "Degrees of freedom"
  // same letter and same title as the section before: no new heading
  bool continues;
  PL_VEC(pl_step) steps;
  PL_VEC(pl_value) values;
  const pl_ask* ask;  // what it answers; of standard requests one without expressions
  // its formulas and the simulated motion disagree: nothing is claimed (witness)
  bool withdrawn;
  bool complete;   // of positions of rest: these are all
  bool all_sides;  // of positions of rest: whatever signs the formulas took
  // a closed form was asked for and not found (exit 5 with --strict)
  bool not_found;
  // of contacts that the motion of `init` need not come to: all of them closed
  bool beside;
  int stage;                     // of the motion; 0: where the solution begins
  const struct pl_analysis* by;  // who wrote it, inside of derive
  pl_tower* tower;               // with the assumptions that its formulas rest on
  const pl_model* model;         // whose coordinates they are in: with those that were proposed
} pl_section;

// ----------------------------------------------------------------------------------------- leaving
// Where a motion leaves the side on which some expressions are positive.
typedef struct pl_leaving {
  bool leaves;    // false: not up to t
  double t;       // s
  bool* through;  // which expressions change their sign there
  int n_q;
  const char *const *q_name, *const *q_unit;  // the state, as of a stage
  const double *q, *v;                        // (n_q)
} pl_leaving;

// -------------------------------------------------------------------------------- constraints, dof
typedef struct pl_constraint_info {
  const pl_constraint* source;
  const char* label;  // "g1"
  const char* text;   // "x1 + x2 = l" as expr text relation
  bool nonholonomic, one_sided, rheonomic;
  bool dropped;  // coordinate = constant or f(t): taken out
  bool implied;  // follows from the others
  // does not hold where the solution begins: a contact that is open, a constraint that is off
  bool open;
  int n_implied_by;
  const char** implied_by;
} pl_constraint_info;

// Where the processor time of a derivation went: forming the equations, solving them, writing and
// searching forms,
// holding what is shown against the model.
typedef enum pl_derive_stage {
  PL_D_EQUATIONS,
  PL_D_SOLUTION,
  PL_D_PRESENTATION,
  PL_D_CERTIFICATES,
  PL_N_DERIVE_STAGES
} pl_derive_stage;

typedef struct pl_solution {
  const pl_model* model;
  pl_towers towers;  // of all sets of constraints and coordinates that were tried
  PL_VEC(pl_section) sections;
  // that the sections speak of: those of the options, and where the motion changes sides
  PL_VEC(pl_stage) stages;
  PL_VEC(pl_constraint_info) constraints;
  pl_dof dof;
  // constraints found behind a singular mass matrix: each vanishes; counted in dof
  PL_VEC(pl_expr) hidden;
  pl_checks checks;
  // assumptions used, as text in the language's notation: "0 < r < l", "m1 > 0"
  PL_VEC(const char*) used;
  int n_equations;  // numbered so far
  bool expect_failed;
  double cpu_ms[PL_N_DERIVE_STAGES];
  // until the first acceleration or multiplier stood in a readable form; 0: none
  double cpu_ms_first;
} pl_solution;

typedef struct pl_derive_options {
  const char* only;  // letters, comma separated; NULL: all
  double seconds;    // presentation budget for each quantity; 0: 0.02
  // constraints, freedoms and notes only: no sections, nothing to certify
  bool structure;
  // The sets of constraints that hold along the motion of `init`, in order, each once; the first is
  // that of the start.
  // n_stages = 0: not known, then contacts are taken as closed.
  int n_stages;
  const pl_stage* stages;
  // of a motion that starts elsewhere; NULL: not known called after each request that is answered,
  // with the sections so far; false: stop.  NULL: nobody waits
  bool (*ready)(void* user, const struct pl_solution* solution);
  void* ready_user;
  const pl_stage* (*stage_from)(void* user, const pl_motion* from);
  // Whether the motion of `init` leaves the side on which n expressions are positive, between two
  // times.  false: not known; NULL too.
  bool (*leaves)(void* user, const pl_expr* side, int n, double from, double to, pl_leaving* out);
  void* user;
} pl_derive_options;

// pl_derive works the model out. The solution lives in the job's arena; the tower inside it is
// freed with
// pl_solution_close. Status: PLEUEL_CONTRADICTION when the constraints contradict each other;
// PLEUEL_INTERRUPTED keeps the
// sections that are done.  Diagnostics (notes) go to the job.
pleuel_status pl_derive(pl_job* job, pl_model* model, const pl_derive_options* options,
                        pl_solution** out);
void pl_solution_close(pl_solution* s);

// pl_derive_dump prints equations as text: what `pleuel dump --after=derive` shows.
void pl_derive_dump(pl_text* out, const pl_solution* s);

#endif
