// jit: compiled programs.  The compiler is a plugin that links LLVM; it need not be there.
#ifndef PL_JIT_H
#define PL_JIT_H

#include "program/program.h"

bool pl_jit_available(const char** why,
                      const pl_jit_places* places);  // opens it; why: what stands in the way
typedef struct pl_jit_code pl_jit_code;              // must be freed
// came from disk; how long it took
typedef struct pl_jit_story {
  bool stored;
  double seconds;
} pl_jit_story;
// run[i] is the function of progs[i]; their names must differ.  NULL: pl_jit_available says why.
pl_jit_code* pl_jit_compile(pl_arena* a, const pl_prog* const* progs, int n, pl_prog_run** run,
                            pl_jit_story* story, const pl_jit_places* places);
void pl_jit_free(pl_jit_code* code);

#endif
