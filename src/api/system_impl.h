// Systems, runs and results, inside.
#ifndef PL_SYSTEM_IMPL_H
#define PL_SYSTEM_IMPL_H

#include "api/api_impl.h"

enum { PL_N_KINDS = PLEUEL_KIND_INPUT + 1 };

// A quantity with a name: place in the setup of the recording, or in its numbers.
typedef struct pl_quantity {
  pleuel_kind kind;
  const char *name, *shown, *unit;
  int index;
} pl_quantity;
typedef PL_VEC(pl_quantity) pl_quantities;

struct pleuel_system {
  atomic_int owners;
  pl_arena* arena;
  pleuel_model* model;         // kept: expressions and names lie in its arena
  pleuel_sim_options options;  // of runs that give none; texts are ours
  pl_language lang;
  const pl_recording* recording;
  const pl_recording* plain;  // without derivatives, where the recording has them; else NULL
  int n_q;                    // coordinates of the motion
  pl_quantities of[PL_N_KINDS];
  pl_quantities columns;  // of results
};

pleuel_status pl_sim_options_check(pl_job* job, const pleuel_sim_options* o);
void pl_sim_options_take(const pleuel_sim_options* o, pl_run_options* how);
void pl_sim_options_own(pl_arena* a, pleuel_sim_options* o);  // texts are copied
// By either spelling; NULL.
const pl_quantity* pl_api_quantity(const pleuel_system* s, pleuel_kind kind, const char* name);
pleuel_status pl_column_give(const pl_quantity* q, const double* at, size_t stride, size_t n,
                             pleuel_column* out);

// An event with its rows.
typedef struct pl_event_kept {
  pl_event_kind kind;
  const char* label;
  double t, impulse;
  bool jump;
  long bounces;
  const double *before, *after;  // (columns)
  const char* mode;
} pl_event_kept;
pleuel_status pl_event_give(const pl_event_kept* e, pleuel_event* out);

// ---- api_result.c
// Rows follow each other in one block; first and last row and the events are in `story` too.
struct pleuel_result {
  pl_arena* arena;
  pleuel_system* system;  // kept
  pl_result* story;
  const pl_setup* setup;  // of the run at work
  pleuel_status status;
  char message[512];
  double* rows;  // (n_stored x width); from `alloc`
  size_t n_stored, room, width;
  bool keeps;  // all rows; false: none in the block
  PL_VEC(const char*) modes;
  double* row;                        // scratch (width)
  const pleuel_sim_options* options;  // of the run at work
  bool refused;
  pl_arena* text;  // of the text that was handed out last
};
pleuel_result* pl_result_open(pleuel_system* system, bool keeps);  // NULL: memory is short
pl_sink pl_result_fill(pleuel_result* r,
                       const pleuel_sim_options* o);  // under a guard of its arena
void pl_result_close(pleuel_result* r, pleuel_status status, const char* message);

// ---- api_start.c
// plain: of a recording with derivatives; turned: bodies are integrated as quaternions.
pleuel_status pl_start_motion(pl_job* job, const pl_recording* r, const pl_recording* plain,
                              bool turned, const pl_run_options* how, pl_run* run,
                              pl_start_report* report);

#endif
