// Lowering: the tree becomes a pl_model.  What the rooms of the lowering share.
//
// Names first, then places, then everything else, because lines may come in any order: a parameter,
// an abbreviation or the point of a mass is lowered when it is first needed.
#ifndef PL_LOWER_IMPL_H
#define PL_LOWER_IMPL_H

#include "lang/lang_impl.h"

// What a name stands for.
typedef enum pl_entity_kind {
  PL_ENTITY_PARAM,
  PL_ENTITY_INPUT,
  PL_ENTITY_COORD,
  PL_ENTITY_FAMILY,
  PL_ENTITY_LET,
  PL_ENTITY_FUNCTION,
  PL_ENTITY_INDEX,
  PL_ENTITY_SMALL
} pl_entity_kind;

typedef struct pl_entity {
  pl_entity_kind kind;
  const char *key, *shown;   // interned
  pl_symbol symbol;          // 0 for functions and inserted abbreviations until they are lowered
  const pl_ast* definition;  // let: PL_AST_DEFINITION
  const pl_ast* override;    // --set: the value instead
  int state;                 // let: 0 not lowered, 1 being lowered, 2 done
  bool inserted;             // let
  int broken;                // its statement has an error: its uses say nothing
  pl_expr value;             // let: inserted value, or its symbol
  pl_expr at[3];             // let of a vector
  int n;                     // its components, 0: a scalar
  int n_args;                // function of a finished model: its arguments
  const pl_symbol* arguments;
  pl_span span;
} pl_entity;

// A name that holds for a while only: index of a block or sum, argument of a function.
typedef struct pl_local {
  const char* key;
  pl_symbol symbol;
  pl_expr value;
  pl_expr at[3];
  int n;
} pl_local;

// The attitude of a body in space as it was given, and its turn: component i in space of body axis
// j at 3 i + j.
typedef struct pl_attitude {
  pl_axes_form form;
  pl_expr at[9];
  pl_expr turn[9];
} pl_attitude;

typedef enum pl_site_kind { PL_SITE_MASS, PL_SITE_BODY, PL_SITE_POINT } pl_site_kind;
typedef struct pl_site {
  pl_site_kind kind;
  const char *key, *shown;
  bool generated;
  const pl_ast* statement;   // NULL when it comes from a finished model
  const pl_ast* index_node;  // of the label, or NULL
  pl_block* block;
  int n_locals;  // locals that hold where it stands
  pl_local* locals;
  int state;
  pl_expr index;
  pl_point point;
  pl_expr angle;  // bodies
  bool in_space;  // a body with axes
  pl_attitude attitude;
} pl_site;

typedef struct pl_rule {  // a constraint, before it is lowered
  const char *key, *shown;
  bool generated, family;
  const char *with, *with_shown;
  pl_symbol lambda;
} pl_rule;

// A value: a number, a vector of 2 or 3, or the force of a constraint (a vector that is known
// later).
typedef struct pl_quantity {
  int n;  // 0: scalar in at[0]
  pl_expr at[3];
  const char* force_of;
} pl_quantity;

typedef struct pl_setting_node {
  const pl_ast *name, *value;
  bool done;
} pl_setting_node;  // --set

typedef struct pl_lower {
  pl_job* job;
  pl_arena* arena;
  pl_pool* pool;
  pl_model* m;
  pl_names* names;
  PL_VEC(pl_entity*) entities;
  pl_map* by_key;  // interned key -> entity + 1
  PL_VEC(pl_local) locals;
  PL_VEC(pl_site*) places;
  PL_VEC(pl_rule) rules;
  PL_VEC(const char*) lost;     // names that broken lines would have declared
  PL_VEC(const char*) missed;   // names that nothing declares: told once
  bool choosing;                // in `choose`, whose new names are coordinates
  PL_VEC(const char*) letters;  // of the requests so far
  PL_VEC(pl_setting_node) settings;
  pl_block* block;
  int mute;                 // > 0: count errors, report nothing
  int wrong;                // errors so far, reported or not
  bool results;             // T, V, λ, force(...) may stand here
  bool infinity;            // ∞ may stand here
  const pl_ast* component;  // bracket of the component read last, x(A): primes may follow it
  int n_rules_declared, n_rules_lowered;
  int n_guesses;  // names looked for in vain so far
  bool log_said;
  int call_depth;
} pl_lower;

enum { PL_MAX_GUESSES = 100 };

// -------------------------------------------------------------------------------------- complaints
// Like pl_complain, but counts, and is silent while l->mute. The result may be written to, also
// when silent.
pl_diagnostic* pl_lower_complain(pl_lower* l, pl_code code, pl_span span, const char* en,
                                 const char* de, ...);
void pl_lower_pending(pl_lower* l, pl_code code, const char* what, pl_span span, const char* en,
                      const char* de);

// ------------------------------------------------------------------------------------------- scope
pl_entity* pl_scope_find(const pl_lower* l, const char* key);
pl_entity* pl_scope_declare(pl_lower* l, pl_entity_kind kind, const pl_ast* name, pl_symbol symbol);
void pl_scope_add(pl_lower* l, pl_entity* e);
const pl_local* pl_scope_local(const pl_lower* l, const char* key);
pl_rule* pl_scope_multiplier(pl_lower* l, const char* key);  // λ, λ_label; NULL
bool pl_scope_is_result(const char* key);                    // T, V, L, E, H and their words
bool pl_scope_result(const char* key, pl_result_kind* kind);
// x_dot, x_0: a coordinate under another name, its derivative, its start
bool pl_scope_alias(pl_lower* l, const pl_ast* name, pl_entity** e, int* dots, bool* start);
pl_expr pl_scope_output(const pl_lower* l, const char* key);  // of `output F = ...`, or poison
bool pl_scope_momentum(pl_lower* l, const char* key, pl_entity** coordinate);  // p_x
// would pl_lower_name find something?
bool pl_scope_known(pl_lower* l, const pl_ast* name);
pl_diagnostic* pl_scope_unknown(pl_lower* l, const pl_ast* name);  // E011 with the nearest name
void pl_scope_unknown_label(pl_lower* l, const pl_ast* label, const char* en, const char* de,
                            const char* const* known, int n);
bool pl_scope_lost(const pl_lower* l, const char* key);
pl_symbol pl_scope_symbol(pl_lower* l, const pl_ast* name, pl_role role);  // makes one
pl_symbol pl_scope_dotted(pl_lower* l, pl_symbol s, int dots);
void pl_scope_finish_let(pl_lower* l, pl_entity* e);
pl_rule* pl_scope_rule(pl_lower* l, const char* key);

// ------------------------------------------------------------------------------------- expressions
pl_quantity pl_quantity_of(pl_expr e);
pl_quantity pl_quantity_bad(void);
bool pl_quantity_is_bad(const pl_quantity* q);
pl_quantity pl_lower_quantity(pl_lower* l, const pl_ast* node);
// a vector is an error; poison has been reported
pl_expr pl_lower_scalar(pl_lower* l, const pl_ast* node);
pl_quantity pl_lower_product(pl_lower* l, const pl_ast* node);
pl_quantity pl_lower_factor(pl_lower* l, const pl_ast* node, const pl_ast* base,
                            const pl_quantity* base_value);
pl_quantity pl_lower_name(pl_lower* l, const pl_ast* name, const pl_ast* index, int dots,
                          const pl_ast* place);
pl_quantity pl_lower_add(pl_lower* l, pl_quantity a, pl_quantity b, bool minus,
                         const pl_ast* where);
pl_quantity pl_lower_times(pl_lower* l, pl_quantity a, pl_quantity b, bool divide,
                           const pl_ast* where);
// pair `at` of a chain
bool pl_lower_relation(pl_lower* l, const pl_ast* node, pl_condition* out, int at);
pl_relation pl_relation_of(char op);
bool pl_lower_unit(pl_lower* l, const pl_ast* node, pl_unit* out);
const pl_ast* pl_ast_single(const pl_ast* node);  // the one factor of an expression, or NULL
const pl_ast* pl_ast_base(const pl_ast* factor);  // below powers, primes, units
bool pl_ast_is_name(const pl_ast* node, const char* key);

// Functions: built in, special, and those of `let f(x)`.
bool pl_lower_is_function(const pl_lower* l, const char* key);
pl_quantity pl_lower_call(pl_lower* l, const pl_ast* function, const pl_ast* group);
// the constraint of `force(label)`; NULL for all else
const char* pl_force_label(const pl_lower* l, pl_expr e);
pl_quantity pl_lower_apply(pl_lower* l, const pl_ast* function, pl_quantity argument,
                           const pl_ast* where);

// ------------------------------------------------------------------------------------------ places
int pl_axis_find(const pl_lower* l, const char* key);  // -1
pl_site* pl_site_find(const pl_lower* l, const char* key);
bool pl_site_finish(pl_lower* l, pl_site* p);
bool pl_lower_point(pl_lower* l, const pl_ast* node, pl_point* out);

// ---- lower_attitude.c: the attitude of bodies in space
pl_axes_form pl_attitude_form(const pl_ast* axes);  // as far as the text shows
void pl_attitude_turn(pl_pool* p, pl_attitude* a);  // from what was given
void pl_attitude_spin(pl_pool* p, const pl_attitude* a, pl_expr w[3]);
pl_expr pl_attitude_energy(pl_pool* p, const pl_attitude* a, const pl_expr J[6]);
bool pl_attitude_condition(pl_pool* p, const pl_attitude* a, int k, pl_expr* left, pl_expr* right,
                           const char** name);

// ---- lower_space.c: bodies in space, and torques on them
// the names of what holds between their axes
void pl_space_declare(pl_lower* l, const pl_ast* body);
void pl_space_body(pl_lower* l, const pl_ast* s, pl_site* p, pl_name name);
// false: a complaint was made
bool pl_space_torque(pl_lower* l, const pl_ast* s, pl_load* out);
// the body in space that a label names, or NULL
pl_site* pl_space_of(pl_lower* l, const pl_ast* on);

bool pl_lower_where(pl_lower* l, const pl_ast* node, pl_point* out, pl_site** place);
bool pl_lower_label_point(pl_lower* l, const pl_ast* name, const pl_ast* index, pl_point* out,
                          pl_site** place);
// name of a label, NULL if node is none
const pl_ast* pl_ast_label(const pl_ast* node, const pl_ast** index);
const char* pl_label_text(pl_lower* l, const pl_ast* name, const pl_ast* index);  // "c[3]"
// checked; NULL if unknown
const char* pl_constraint_label(pl_lower* l, const pl_ast* label);
void pl_site_declare(pl_lower* l, const pl_ast* statement);
void pl_axes_settle(pl_lower* l, const pl_ast* file);
void pl_axes_trim(pl_lower* l, const pl_ast* file);
int pl_ast_components(const pl_ast* point);

// -------------------------------------------------------------------------------------- statements
void pl_lower_declare(pl_lower* l, const pl_ast* statement);  // first pass: names
// likewise of `choose ... with`, after all other names
void pl_lower_declare_chosen(pl_lower* l, const pl_ast* statement);
// second pass: they join the coordinates
void pl_lower_chosen(pl_lower* l, const pl_ast* statement);
void pl_lower_statement(pl_lower* l, const pl_ast* statement);  // second pass
void pl_lower_physics(pl_lower* l, const pl_ast* statement);
void pl_lower_contact(pl_lower* l, const pl_ast* statement);  // restitution, friction
void pl_lower_start(pl_lower* l, const pl_ast* statement);
void pl_lower_ask(pl_lower* l, const pl_ast* statement);
void pl_lower_draw(pl_lower* l, const pl_ast* node);     // draw, animate
void pl_lower_display(pl_lower* l, const pl_ast* node);  // simulate, plot, animate, sweep, poincare
void pl_lower_event(pl_lower* l, const pl_ast* statement);

pl_lower* pl_lower_make(pl_job* job, pl_model* m, pl_names* names);
void pl_lower_from_model(pl_lower* l);  // scope of a finished model

#endif
