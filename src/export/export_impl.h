// export_impl: what the rooms of the export share: how a target spells things, the names of symbols
// in it, the printer.
#ifndef PL_EXPORT_IMPL_H
#define PL_EXPORT_IMPL_H

#include "export/export.h"

// How a target spells what is no call.  Templates as in export.def; $0 is the name of a symbol.
typedef struct pl_dialect {
  const char* word;  // as asked for: "sympy"
  const char* power;
  const char* pi;
  const char* infinity;
  const char* root;       // square root of $1
  const char* condition;  // $2 if $1 > 0, else $3
  const char* sum;        // of $4 over the index $1 from $2 to $3
  const char* rational;   // $1 over $2
  bool rational_is_atom;  // holds together in any surroundings
  const char* whole;      // an integer that is a formula by itself
  const char* function[PL_N_FUNCTIONS];
  bool camel;              // names have no underscores: lambdaG1
  const char* reserved;    // names that mean something there, each between blanks
  const char* comment[2];  // before and after
} pl_dialect;
extern const pl_dialect pl_dialects[];  // ORDER EXPORTS; JSON has none

// ---- export_names.c A name for each symbol of a pool, and for the families three: positions,
// velocities, accelerations.
enum { PL_EXPORT_DOTS = 3 };
typedef struct pl_export_spelling {
  const char* name[PL_EXPORT_DOTS];
} pl_export_spelling;
// by id of the symbol  (pl_symbol_count + 1)
typedef struct pl_export_names {
  pl_export_spelling* of;
} pl_export_names;
pl_export_names pl_export_names_make(pl_arena* a, const pl_pool* p, const pl_dialect* d);
// x_dot of the family x
const char* pl_export_ascii(pl_arena* a, const pl_pool* p, pl_symbol s, int dots);

// ---- export_expr.c
// false: no formula, or too long to be written out
bool pl_export_can(pl_arena* a, const pl_pool* p, pl_expr e);
void pl_export_expr(pl_text* out, const pl_pool* p, const pl_dialect* d,
                    const pl_export_names* names, pl_expr e);
void pl_export_tree(pl_text* out, const pl_pool* p, pl_expr e);  // ["+", "x", ["*", -2, "g"]]

#endif
