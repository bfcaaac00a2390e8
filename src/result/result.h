// result: columns with names and units, filled by a sink; CSV.
#ifndef PL_RESULT_H
#define PL_RESULT_H

#include "solve/solve.h"

// Columns of a result, in order: t, coordinates, velocities, multipliers, outputs; then the text
// column `mode` when the setup has one-sided constraints.
typedef struct pl_result_column {
  const char *name, *unit;
} pl_result_column;

typedef struct pl_result_event {
  pl_event_kind kind;
  const char* label;
  double t;
  bool at_start;
  double impulse;
  bool jump;  // velocities jumped
  // contact after so many bounces and the infinitely many that follow; else 0
  long bounces;
  const double *before, *after;  // (n_columns)
  const char *mode_before, *mode_after;
  // on wider numbers: `after` as text with all digits; NULL in doubles  (n_columns)
  const char* const* digits;
} pl_result_event;

typedef struct pl_result {
  pl_arena* arena;
  int n_columns;
  const pl_result_column* columns;  // (n_columns), without mode
  bool has_mode;
  PL_VEC(double*) rows;       // each (n_columns)
  PL_VEC(const char*) modes;  // one a row
  PL_VEC(pl_row_kind) kinds;
  PL_VEC(pl_result_event) events;
  long n_rows;     // so far, also those that are not kept here
  bool keep_rows;  // false: only first and last row and the events are kept
  bool complete;   // the run reached its end
  pleuel_status status;
  const char* message;
  pl_stats stats;
  // rows are passed on to here too (a CSV writer, say); may be all NULL
  pl_sink next;
} pl_result;

// pl_result_make makes an empty result; pl_result_sink is the sink that fills it.
pl_result* pl_result_make(pl_arena* a, bool keep_rows);
pl_sink pl_result_sink(pl_result* r);
// Rows and events so far, written down or read back (base.h); columns are those of `begin`.
void pl_result_keep(pl_result* r, pl_keeper* k);
int pl_result_find(const pl_result* r, const char* name);     // column, -1 if absent
double pl_result_last(const pl_result* r, const char* name);  // NaN if absent

// CSV: header `name [unit]`, comma, LF, shortest decimal that reads back to the same double; nan
// where a multiplier is not determined. A run that did not reach its end leaves a last line "#
// incomplete: ...". pl_csv_sink writes rows as they come. The file stays open; the caller checks
// ferror and closes it.
pl_sink pl_csv_sink(pl_arena* a, FILE* file);
// The same behind a header and rows that are there already.
// The same to a function of the caller, in blocks.
pl_sink pl_csv_sink_to(pl_arena* a, pleuel_write_function* write, void* user);
pl_sink pl_csv_sink_behind(pl_arena* a, FILE* file);
pleuel_status pl_result_write_csv(const pl_result* r, FILE* file);

// Columns of a setup, and a row as their numbers.  mode: rows name contacts.
void pl_result_columns(pl_arena* a, const pl_setup* s, const pl_result_column** columns, int* n,
                       bool* mode);
void pl_result_flatten(const pl_setup* s, const pl_row* row, double* x);

#endif
