// Dimension inference: what dimension_system.c, dimensions.c and dimension_report.c share.
#ifndef PL_DIMENSION_IMPL_H
#define PL_DIMENSION_IMPL_H

#include "model_impl.h"

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
