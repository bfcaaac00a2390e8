// What the files of model share among themselves.
#ifndef PL_MODEL_IMPL_H
#define PL_MODEL_IMPL_H

#include "model/model.h"

#define PL_NAN __builtin_nan("")  // the macros of math.h are float, and warn
#define PL_INF __builtin_inf()

// ------------------------------------------------------------------------------------------ bare.c
void pl_dress_bare_numbers(pl_model* m);  // w - 0.5 with w a length: 0.5 m

// ----------------------------------------------------------------------------------------- visit.c
// Every expression of a model, with the kind of place it stands in.
typedef enum pl_slot_kind {
  PL_SLOT_PARAM,
  PL_SLOT_LET,
  PL_SLOT_BOUND,
  PL_SLOT_ASSUMPTION,
  PL_SLOT_POINT,
  PL_SLOT_MASS,
  PL_SLOT_LOAD,
  PL_SLOT_GRAVITY,
  PL_SLOT_CONSTRAINT,
  PL_SLOT_CHOOSE,
  PL_SLOT_BRANCH,
  PL_SLOT_INIT,
  PL_SLOT_EVENT,
  PL_SLOT_ASK,
  PL_SLOT_OUTPUT,
  PL_SLOT_PLOT,
  PL_SLOT_SIMULATE,
  PL_SLOT_LABEL_INDEX
} pl_slot_kind;
typedef struct pl_slot {
  pl_expr* at;  // never NULL; the expression may be poison ("none")
  pl_slot_kind kind;
  const pl_block* block;  // the family it stands in, or NULL
  pl_span span;
} pl_slot;
typedef void pl_slot_visit(void* user, const pl_slot* slot);
void pl_model_each_slot(pl_model* m, pl_slot_visit* visit, void* user);

// ---------------------------------------------------------------------------------------- occurs.c
bool pl_is_constant_known(const pl_pool* p, pl_map* known, pl_expr e);
// 1: velocities occur, 2: accelerations
int pl_max_dots(const pl_pool* p, pl_expr e, pl_arena* scratch);
// a coordinate or its derivatives occur
bool pl_has_coordinate(const pl_pool* p, pl_expr e, pl_arena* scratch);

// ----------------------------------------------------------------------------------------- words.c
// Looks for a name in the text of a span, in any of its spellings (θ, theta; m1, m_1, m₁). false:
// not there.
bool pl_span_find_name(pl_span where, const char* ascii, pl_span* out);
// How often the name occurs in the whole text.
int pl_source_count_name(const pl_source* s, const char* ascii);
// The two sides of the first relation sign in a span, without label and blanks around.
bool pl_span_split_relation(pl_span where, pl_span* left, pl_span* right);
// The span without blanks and comment at both ends, as text in one line, at most max characters.
const char* pl_span_text(pl_arena* a, pl_span s, int max);

// -------------------------------------------------------------------------------------- families.c
// An expression over indices and parameters as an integer. false: not an integer, not a number, or
// too large.
typedef struct pl_index_values {
  const pl_model* model;
  // by symbol id, parameters filled in                       (pl_symbol_count + 1)
  double* value;
} pl_index_values;
pl_index_values pl_index_values_make(const pl_model* m, pl_arena* a);
bool pl_index_eval(const pl_index_values* v, pl_expr e, long* out);
// Calls visit for every instance of a block, outer index slowest, with the indices set in v. Stops
// when visit says so. visit NULL: the instances are only counted off the budget.
typedef bool pl_instance_visit(void* user, pl_index_values* v);
typedef enum pl_walk_result {
  PL_WALK_DONE,
  PL_WALK_STOPPED,
  PL_WALK_BAD_BOUND,
  PL_WALK_ZERO_STEP,
  PL_WALK_TOO_MANY
} pl_walk_result;
pl_walk_result pl_block_walk(const pl_block* b, pl_index_values* v, pl_instance_visit* visit,
                             void* user, long* budget, const pl_block** culprit);
// more than this is refused: indices alone would take a gigabyte
enum { PL_MAX_INSTANCES = 20000000 };
// The same at the two ends of the innermost loop only.
pl_walk_result pl_block_walk_ends(const pl_block* b, pl_index_values* v, pl_instance_visit* visit,
                                  void* user, long* budget);
// Which members of a family were given: key names the family, owner who gives it. pl_index_sets_add
// returns the owner that gave one of them before, -1 if none did; index poison: the family is one
// thing without index.
typedef struct pl_index_sets {
  pl_arena* arena;
  pl_index_values values;
  pl_map* walked;
  PL_VEC(struct pl_index_run) runs;
} pl_index_sets;
pl_index_sets pl_index_sets_make(const pl_model* m, pl_arena* a);
int pl_index_sets_add(pl_index_sets* s, uint64_t key, pl_expr index, const pl_block* b, int owner,
                      long* clash_index);

// -------------------------------------------------------------------------------------- dimensions
void pl_check_dimensions(pl_job* job, pl_model* m);
void pl_find_torques(pl_model* m);  // among what is given: N m, not J         torques.c
void pl_classify_symbols(pl_model* m);
void pl_strip_units(pl_model* m);  // strip_units.c
// also before the check is over
bool pl_known_dimension(const pl_model* m, pl_expr e, pl_dimension* out);

// ------------------------------------------------------------------------------------ velocities.c
typedef enum pl_velocity_kind {
  PL_NO_VELOCITY,
  PL_ACCELERATION,
  PL_NOT_LINEAR,
  PL_INTEGRABLE,
  PL_NONHOLONOMIC
} pl_velocity_kind;
// What velocities do in a constraint g = 0. *integral: text of G with dG/dt = g where it can be
// written down, or NULL.
pl_velocity_kind pl_velocity_kind_of(pl_job* job, const pl_model* m, pl_expr g,
                                     const char** integral);

// ------------------------------------------------------------------------------------------- check
// false: some family has no size; it has been told
bool pl_check_sizes(pl_job* job, pl_model* m);
void pl_check_families(pl_job* job, pl_model* m);
void pl_check_names(pl_job* job, pl_model* m);
void pl_check_structure(pl_job* job, pl_model* m);
void pl_check_numbers(pl_job* job, pl_model* m);
void pl_check_inertia(pl_job* job, pl_model* m);
void pl_check_contacts(pl_job* job, pl_model* m);
void pl_check_start(pl_job* job, pl_model* m);
void pl_check_requests(pl_job* job, pl_model* m);
void pl_check_use(pl_job* job, pl_model* m);
void pl_check_reading(pl_job* job, pl_model* m);

// ------------------------------------------------------------------------------------------ tell.c
// An expression as a reader writes it, in one line: "x' sin φ".
const char* pl_expr_words(pl_arena* a, pl_pool* p, pl_expr e);
// Reports with sentences formatted in both languages.
pl_diagnostic* pl_tell(pl_job* job, pl_code code, pl_span span, const char* en, const char* de);
#define PL_F(job, ...) pl_format((job)->arena, __VA_ARGS__)

#endif
