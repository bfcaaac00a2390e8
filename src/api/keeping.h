// The file that a run keeps its state in, so that it can go on when it was interrupted: keeping.c,
// keeping_traits.c.
#ifndef PL_KEEPING_H
#define PL_KEEPING_H

#include "api/api_impl.h"

// What must be the same in the run that goes on. `flag` names it for the user; NULL: told in a
// sentence of its own.
typedef struct pl_trait {
  const char *name, *flag, *value;
} pl_trait;
typedef PL_VEC(pl_trait) pl_traits;
void pl_traits_of(pl_traits* list, const pleuel_model* m, const pleuel_sim_options* o,
                  const pl_run_options* how);
void pl_traits_keep(pl_keeper* k, pl_traits* list, pl_arena* a);
// Fails with the first that differs.
pleuel_status pl_traits_compare(pleuel_model* m, const char* path, const pl_traits* kept,
                                const pl_traits* now);

// Rows that were written: how many bytes of them there are, and their hash.
typedef struct pl_kept_rows {
  long bytes;
  uint64_t hash;
} pl_kept_rows;

struct pl_keeping {
  pleuel_model* m;
  const char* path;
  FILE* csv;  // NULL: rows go elsewhere, or nowhere
  bool resumes;
  pl_traits traits;
  pl_keeper state;    // resuming: what is to be read
  pl_kept_rows rows;  // resuming: those that stay
  // hash of the rows so far: of whole blocks, and how many bytes that are
  uint64_t block_hash;
  long block_bytes;
  // when it is written
  double every_s, last_s, look_s;
  long countdown, pace;
};

#endif
