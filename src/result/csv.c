// CSV: `name [unit]` in the header, comma, LF, the shortest decimals that read back to the same
// number.
#include "result/result_impl.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// -------------------------------------------------------------------------------------------- text
// Quoted when a comma, a quote or a line end is in it.
static void write_text(FILE* file, const char* s) {
  if (strpbrk(s, ",\"\r\n") == NULL) {
    fputs(s, file);
    return;
  }
  fputc('"', file);
  for (; *s; s++) {
    if (*s == '"') fputc('"', file);
    fputc(*s, file);
  }
  fputc('"', file);
}

static void write_header(FILE* file, const pl_result_column* column, int n, bool mode,
                         pl_text* text) {
  for (int i = 0; i < n; i++) {
    text->n = 0;
    pl_text_add(text, column[i].name);
    if (column[i].unit && column[i].unit[0]) pl_text_addf(text, " [%s]", column[i].unit);
    if (i > 0) fputc(',', file);
    write_text(file, pl_text_string(text));
  }
  if (mode) fputs(",mode", file);
  fputc('\n', file);
}

static void write_row(FILE* file, const double* x, int n, const char* mode) {
  char text[32];
  for (int i = 0; i < n; i++) {
    pl_double_text(text, x[i]);
    if (i > 0) fputc(',', file);
    fputs(text, file);
  }
  if (mode) {
    fputc(',', file);
    write_text(file, mode);
  }
  fputc('\n', file);
}

static void write_incomplete(FILE* file, const char* message) {
  fputs("# incomplete: ", file);
  for (; *message; message++) fputc(*message == '\n' ? ' ' : *message, file);
  fputc('\n', file);
}

// ------------------------------------------------------------------------------------- as it comes
typedef struct csv {
  pl_arena* arena;
  FILE* file;
  const pl_setup* setup;
  const pl_result_column* columns;
  int n_columns;
  bool has_mode;
  double* x;
  int column;  // of the row that is written
} csv;

static pleuel_status state_of(const csv* w) { return ferror(w->file) ? PLEUEL_FILE : PLEUEL_OK; }

static pleuel_status csv_begin_behind(void* user, const pl_setup* setup) {
  csv* w = user;
  w->setup = setup;
  pl_result_columns(w->arena, setup, &w->columns, &w->n_columns, &w->has_mode);
  w->x = PL_ARRAY(w->arena, double, w->n_columns + 1);
  return state_of(w);
}

static pleuel_status csv_begin(void* user, const pl_setup* setup) {
  csv* w = user;
  PL_TRY(csv_begin_behind(user, setup));
  pl_text text = pl_text_make(w->arena);
  write_header(w->file, w->columns, w->n_columns, w->has_mode, &text);
  return state_of(w);
}

static void write_column(void* user, const char* text) {
  csv* w = user;
  if (w->column++ > 0) fputc(',', w->file);
  fputs(text, w->file);
}

static void write_digits(csv* w, const pl_row* row) {
  w->column = 0;
  pl_result_digits(w->setup, row, w, write_column);
  if (w->has_mode) {
    fputc(',', w->file);
    write_text(w->file, row->mode);
  }
  fputc('\n', w->file);
}

static pleuel_status csv_row(void* user, const pl_row* row) {
  csv* w = user;
  if (row->digits) {
    write_digits(w, row);
    return state_of(w);
  }
  pl_result_flatten(w->setup, row, w->x);
  write_row(w->file, w->x, w->n_columns, w->has_mode ? row->mode : NULL);
  return state_of(w);
}

static pleuel_status csv_end(void* user, pleuel_status how, const char* message,
                             const pl_stats* stats) {
  csv* w = user;
  (void)stats;
  if (how != PLEUEL_OK) write_incomplete(w->file, message);
  fflush(w->file);
  return state_of(w);
}

pl_sink pl_csv_sink(pl_arena* a, FILE* file) {
  csv* w = PL_NEW(a, csv);
  w->arena = a;
  w->file = file;
  return (pl_sink){.user = w, .begin = csv_begin, .row = csv_row, .end = csv_end};
}

pl_sink pl_csv_sink_behind(pl_arena* a, FILE* file) {
  pl_sink sink = pl_csv_sink(a, file);
  sink.begin = csv_begin_behind;
  return sink;
}

// ------------------------------------------------------------------------------------- from memory
pleuel_status pl_result_write_csv(const pl_result* r, FILE* file) {
  pl_text text = pl_text_make(r->arena);
  write_header(file, r->columns, r->n_columns, r->has_mode, &text);
  for (int i = 0; i < r->rows.n; i++)
    write_row(file, r->rows.at[i], r->n_columns, r->has_mode ? r->modes.at[i] : NULL);
  if (!r->complete) write_incomplete(file, r->message ? r->message : "");
  fflush(file);
  return ferror(file) ? PLEUEL_FILE : PLEUEL_OK;
}
