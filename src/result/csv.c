// CSV: `name [unit]` in the header, comma, LF, the shortest decimals that read back to the same
// number.
#include "result/result_impl.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---------------------------------------------------------------------------------------- where to
// A file, or a function of the caller, which is handed blocks.
typedef struct outlet {
  FILE* file;
  pleuel_write_function* write;
  void* user;
  bool failed;
  size_t n;
  char block[1 << 14];
} outlet;

static void flush(outlet* to) {
  if (to->file) fflush(to->file);
  else if (to->n > 0 && !to->failed) to->failed = to->write(to->user, to->block, to->n) != 0;
  to->n = 0;
}

static void put_char(outlet* to, char c) {
  if (to->file) {
    fputc(c, to->file);
    return;
  }
  if (to->n == sizeof to->block) flush(to);
  to->block[to->n++] = c;
}

static void put(outlet* to, const char* s) {
  if (to->file) {
    fputs(s, to->file);
    return;
  }
  for (; *s; s++) put_char(to, *s);
}

static pleuel_status state_of(const outlet* to) {
  return to->failed || (to->file && ferror(to->file)) ? PLEUEL_FILE : PLEUEL_OK;
}

// -------------------------------------------------------------------------------------------- text
// Quoted when a comma, a quote or a line end is in it.
static void write_text(outlet* to, const char* s) {
  if (strpbrk(s, ",\"\r\n") == NULL) {
    put(to, s);
    return;
  }
  put_char(to, '"');
  for (; *s; s++) {
    if (*s == '"') put_char(to, '"');
    put_char(to, *s);
  }
  put_char(to, '"');
}

static void write_header(outlet* to, const pl_result_column* column, int n, bool mode,
                         pl_text* text) {
  for (int i = 0; i < n; i++) {
    text->n = 0;
    pl_text_add(text, column[i].name);
    if (column[i].unit && column[i].unit[0]) pl_text_addf(text, " [%s]", column[i].unit);
    if (i > 0) put_char(to, ',');
    write_text(to, pl_text_string(text));
  }
  if (mode) put(to, ",mode");
  put_char(to, '\n');
}

static void write_row(outlet* to, const double* x, int n, const char* mode) {
  char text[32];
  for (int i = 0; i < n; i++) {
    pl_double_text(text, x[i]);
    if (i > 0) put_char(to, ',');
    put(to, text);
  }
  if (mode) {
    put_char(to, ',');
    write_text(to, mode);
  }
  put_char(to, '\n');
}

static void write_incomplete(outlet* to, const char* message) {
  put(to, "# incomplete: ");
  for (; *message; message++) put_char(to, *message == '\n' ? ' ' : *message);
  put_char(to, '\n');
}

// ------------------------------------------------------------------------------------- as it comes
typedef struct csv {
  pl_arena* arena;
  outlet to;
  const pl_setup* setup;
  const pl_result_column* columns;
  int n_columns;
  bool has_mode;
  double* x;
  int column;  // of the row that is written
} csv;

static pleuel_status csv_begin_behind(void* user, const pl_setup* setup) {
  csv* w = user;
  w->setup = setup;
  pl_result_columns(w->arena, setup, &w->columns, &w->n_columns, &w->has_mode);
  w->x = PL_ARRAY(w->arena, double, w->n_columns + 1);
  return state_of(&w->to);
}

static pleuel_status csv_begin(void* user, const pl_setup* setup) {
  csv* w = user;
  PL_TRY(csv_begin_behind(user, setup));
  pl_text text = pl_text_make(w->arena);
  write_header(&w->to, w->columns, w->n_columns, w->has_mode, &text);
  return state_of(&w->to);
}

static void write_column(void* user, const char* text) {
  csv* w = user;
  if (w->column++ > 0) put_char(&w->to, ',');
  put(&w->to, text);
}

static void write_digits(csv* w, const pl_row* row) {
  w->column = 0;
  pl_result_digits(w->setup, row, w, write_column);
  if (w->has_mode) {
    put_char(&w->to, ',');
    write_text(&w->to, row->mode);
  }
  put_char(&w->to, '\n');
}

static pleuel_status csv_row(void* user, const pl_row* row) {
  csv* w = user;
  if (row->digits) {
    write_digits(w, row);
    return state_of(&w->to);
  }
  pl_result_flatten(w->setup, row, w->x);
  write_row(&w->to, w->x, w->n_columns, w->has_mode ? row->mode : NULL);
  return state_of(&w->to);
}

static pleuel_status csv_end(void* user, pleuel_status how, const char* message,
                             const pl_stats* stats) {
  csv* w = user;
  (void)stats;
  if (how != PLEUEL_OK) write_incomplete(&w->to, message);
  flush(&w->to);
  return state_of(&w->to);
}

pl_sink pl_csv_sink(pl_arena* a, FILE* file) {
  csv* w = PL_NEW(a, csv);
  w->arena = a;
  w->to.file = file;
  return (pl_sink){.user = w, .begin = csv_begin, .row = csv_row, .end = csv_end};
}

pl_sink pl_csv_sink_to(pl_arena* a, pleuel_write_function* write, void* user) {
  pl_sink sink = pl_csv_sink(a, NULL);
  csv* w = sink.user;
  w->to.write = write;
  w->to.user = user;
  return sink;
}

pl_sink pl_csv_sink_behind(pl_arena* a, FILE* file) {
  pl_sink sink = pl_csv_sink(a, file);
  sink.begin = csv_begin_behind;
  return sink;
}

// ------------------------------------------------------------------------------------- from memory
pleuel_status pl_result_write_csv(const pl_result* r, FILE* file) {
  outlet* to = PL_NEW(r->arena, outlet);
  to->file = file;
  pl_text text = pl_text_make(r->arena);
  write_header(to, r->columns, r->n_columns, r->has_mode, &text);
  for (int i = 0; i < r->rows.n; i++)
    write_row(to, r->rows.at[i], r->n_columns, r->has_mode ? r->modes.at[i] : NULL);
  if (!r->complete) write_incomplete(to, r->message ? r->message : "");
  flush(to);
  return state_of(to);
}
