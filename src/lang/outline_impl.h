// outline, inside.
#ifndef PL_OUTLINE_IMPL_H
#define PL_OUTLINE_IMPL_H

#include "lang/lang_impl.h"
#include "lang/outline.h"

// Names of one space exclude each other; the same name may stand in several.
typedef enum pl_space {
  PL_SPACE_VALUE,  // what expressions are made of
  PL_SPACE_PLACE,  // masses, bodies, points
  PL_SPACE_CONSTRAINT,
  PL_SPACE_MULTIPLIER,  // named by `with`
  PL_SPACE_FORCE,
  PL_SPACE_EVENT,
  PL_SPACE_AXIS,
  PL_SPACE_REQUEST,
  PL_N_SPACES
} pl_space;

typedef struct pl_outlining {
  pl_outline* o;
  pl_arena* arena;
  pl_job* job;
  const pl_include_reader* reader;
  pl_map* by_key[PL_N_SPACES];  // interned key -> named + 1
  PL_VEC(pl_ast*) statements;   // of all files, in order
  PL_VEC(int) locals;           // indices and arguments in scope, innermost last
  PL_VEC(const char*) open;     // files being read, against circles
  const pl_ast* statement;
  int n_constraints;
  bool in_block;
} pl_outlining;

pl_space pl_named_space(pl_named_kind kind);
int pl_outlining_find(const pl_outlining* w, pl_space space, const char* key);  // -1
int pl_outlining_define(pl_outlining* w, pl_named named);  // the first of a name counts
void pl_outlining_use(pl_outlining* w, pl_span span, int named, int dots, bool defines);
int pl_outlining_multiplier(const pl_outlining* w, const char* key);

// outline_define.c: what statements declare; of broken ones from their tokens.
void pl_outline_define_all(pl_outlining* w);
// outline_uses.c: where names stand.
void pl_outline_use_all(pl_outlining* w);

#endif
