// Dimension inference: what dimension_system.c, dimensions.c and dimension_report.c share.
#ifndef PL_DIMENSION_IMPL_H
#define PL_DIMENSION_IMPL_H

#include "model_impl.h"

// The dimension of something that is not yet known: fixed exponents plus rational multiples of
// unknown dimensions.
typedef struct pl_dim_part {
  int var;
  pl_fraction f;
} pl_dim_part;
typedef struct pl_dim_form {
  pl_exponents fixed;
  int n;
  pl_dim_part* part;  // by rising var, no zero factors                              (n)
} pl_dim_form;

typedef enum pl_dim_var_kind { PL_DIM_SYMBOL, PL_DIM_NUMBER, PL_DIM_ENERGY } pl_dim_var_kind;
typedef struct pl_dim_var {
  pl_dim_var_kind kind;
  pl_symbol symbol;  // PL_DIM_SYMBOL
  pl_expr number;    // PL_DIM_NUMBER: a bare number
  pl_span span;      // where it is declared, or where the number stands
  bool declared;     // its unit is written down
  bool solved;
  bool tainted;              // took part in a conflict: later ones are echoes
  const pl_dim_form* row;    // solved: what it equals, shortened as more gets known
  const pl_dim_form* first;  // solved: the same as first found
  pl_span reason;            // solved: the statement that settled it
} pl_dim_var;

typedef struct pl_dim_system {
  pl_arena* arena;
  PL_VEC(pl_dim_var) vars;
} pl_dim_system;

int pl_dim_var_add(pl_dim_system* s, pl_dim_var_kind kind);
const pl_dim_form* pl_dim_fixed(pl_dim_system* s, pl_exponents d);
const pl_dim_form* pl_dim_unknown(pl_dim_system* s, int var);
const pl_dim_form* pl_dim_combine(pl_dim_system* s, const pl_dim_form* a, pl_fraction f,
                                  const pl_dim_form* b);  // a B^f
const pl_dim_form* pl_dim_resolve(pl_dim_system* s, const pl_dim_form* a);
// Makes a and b equal.  false: they cannot be.
bool pl_dim_unify(pl_dim_system* s, const pl_dim_form* a, const pl_dim_form* b, pl_span reason);
// resolves; false: still unknown
bool pl_dim_known(pl_dim_system* s, const pl_dim_form* a, pl_dimension* out);

// ---------------------------------------------------------------------------------------- the walk
typedef struct pl_dim_pass {
  pl_job* job;
  pl_model* model;
  pl_pool* pool;
  pl_arena* arena;
  pl_dim_system system;
  pl_map* form_of;       // expression id -> const pl_dim_form*
  pl_map* constant;      // expression id -> whether it contains no name (pl_is_constant_known)
  pl_map* var_of;        // symbol id -> var + 1
  const double* values;  // of parameters, for exponents that are parameters
  int energy;            // var of the energy: what T, V and every potential have in common
  int time;              // var of t
  pl_span where;         // the statement at work
  // the part of it at work, when it has a place of its own; else no source
  pl_span focus;
  bool silent;  // only classify: report nothing
} pl_dim_pass;

typedef enum pl_dim_clash { PL_CLASH_RELATION, PL_CLASH_SUM, PL_CLASH_NEED } pl_dim_clash;
int pl_dim_symbol_var(pl_dim_pass* d, pl_symbol s);
// One conflict: expressions a and b with their forms. For NEED: b is poison and `what` names the
// role of a.
typedef struct pl_dim_conflict {
  pl_dim_clash kind;
  pl_expr a, b;
  const pl_dim_form* form_a;
  const pl_dim_form* form_b;
  const char* what[2];  // NEED: "a mass" in both languages, or "sin() takes a pure number"
  pl_code code;
} pl_dim_conflict;
void pl_dim_report(pl_dim_pass* d, const pl_dim_conflict* c);
void pl_dim_report_bare_numbers(pl_dim_pass* d);

#endif
