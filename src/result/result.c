// Results kept in memory: a sink that copies rows and events into columns.
#include "result/result_impl.h"

#include <limits.h>
#include <math.h>
#include <string.h>

// ----------------------------------------------------------------------------------------- columns
static int count_columns(const pl_setup* s) {
  int n = 1;
  for (int i = 0; i < s->n_q; i++) n += s->coordinates[i].hidden ? 0 : 2;
  for (int c = 0; c < s->n_c; c++) n += s->constraints[c].column != NULL;
  return n + s->n_out;
}

static void name_columns(const pl_setup* s, pl_result_column* column) {
  int n = 0;
  column[n++] = (pl_result_column){"t", "s"};
  for (int i = 0; i < s->n_q; i++)
    if (!s->coordinates[i].hidden)
      column[n++] = (pl_result_column){s->coordinates[i].name, s->coordinates[i].unit};
  for (int i = 0; i < s->n_q; i++)
    if (!s->coordinates[i].hidden)
      column[n++] = (pl_result_column){s->coordinates[i].v_name, s->coordinates[i].v_unit};
  for (int c = 0; c < s->n_c; c++)
    if (s->constraints[c].column)
      column[n++] = (pl_result_column){s->constraints[c].column, s->constraints[c].unit};
  for (int i = 0; i < s->n_out; i++)
    column[n++] = (pl_result_column){s->out[i].name, s->out[i].unit};
}

// ORDER COLUMNS: as name_columns.
void pl_result_flatten(const pl_setup* s, const pl_row* row, double* x) {
  int n = 0;
  x[n++] = row->t;
  for (int i = 0; i < s->n_q; i++)
    if (!s->coordinates[i].hidden) x[n++] = row->q[i];
  for (int i = 0; i < s->n_q; i++)
    if (!s->coordinates[i].hidden) x[n++] = row->v[i];
  for (int c = 0; c < s->n_c; c++)
    if (s->constraints[c].column)
      x[n++] = !row->unique[c]           ? (double)NAN
               : s->constraints[c].minus ? -row->lambda[c]
                                         : row->lambda[c];  // no number where none is determined
  for (int i = 0; i < s->n_out; i++) x[n++] = row->out[i];
}

// The decimal point of the locale, whatever it is, becomes a dot.
static void take_plain(char* text, void* user, void (*take)(void* user, const char* text)) {
  bool number = text[0] != 'n' && text[0] != 'i' && text[1] != 'i';
  for (char* c = text; number && *c; c++)
    if (!(*c >= '0' && *c <= '9') && *c != '-' && *c != '+' && *c != 'e') *c = '.';
  take(user, text);
}

// ORDER COLUMNS: as name_columns.
void pl_result_digits(const pl_setup* s, const pl_row* row, void* user,
                      void (*take)(void* user, const char* text)) {
  const pl_row_digits* d = row->digits;
  char text[PL_ROW_TEXT];
#define COLUMN(part, i, negative) \
  (d->text(d->user, part, i, negative, text), take_plain(text, user, take))
  COLUMN(PL_ROW_T, 0, false);
  for (int part = PL_ROW_Q; part <= PL_ROW_V; part++)
    for (int i = 0; i < s->n_q; i++)
      if (!s->coordinates[i].hidden) COLUMN((pl_row_part)part, i, false);
  for (int c = 0; c < s->n_c; c++) {
    if (s->constraints[c].column && row->unique[c])
      COLUMN(PL_ROW_LAMBDA, c, s->constraints[c].minus);
    else if (s->constraints[c].column) take(user, "nan");
  }
  for (int i = 0; i < s->n_out; i++) COLUMN(PL_ROW_OUT, i, false);
#undef COLUMN
}

static bool has_mode(const pl_setup* s) {
  for (int c = 0; c < s->n_c; c++)
    if (s->constraints[c].side != 0) return true;
  return s->n_frictions > 0;
}

void pl_result_columns(pl_arena* a, const pl_setup* s, const pl_result_column** columns, int* n,
                       bool* mode) {
  pl_result_column* column = PL_ARRAY(a, pl_result_column, count_columns(s) + 1);
  name_columns(s, column);
  *columns = column;
  *n = count_columns(s);
  *mode = has_mode(s);
}

// -------------------------------------------------------------------------------------------- sink
typedef struct filling {
  pl_result* result;
  const pl_setup* setup;
  const char* last_mode;  // repeated texts are kept once
  double* spare;          // a row to reuse when rows are not kept
} filling;

static const char* keep_text(filling* f, const char* mode) {
  if (f->last_mode == NULL || strcmp(f->last_mode, mode) != 0)
    f->last_mode = pl_copy(f->result->arena, mode);
  return f->last_mode;
}

static double* keep_row(filling* f, const pl_row* row) {
  double* x = PL_ARRAY(f->result->arena, double, f->result->n_columns);
  pl_result_flatten(f->setup, row, x);
  return x;
}

// Memory that runs out while a run steps must not unwind through the run: it stops the run with a
// status.
static pleuel_status guarded(filling* f, void (*work)(filling* f, const void* what),
                             const void* what) {
  pl_guard guard;
  PL_GUARD(f->result->arena, guard) {
    work(f, what);
    guard.status = PLEUEL_OK;
  }
  pl_guard_end(f->result->arena, &guard);
  return guard.status;
}

static void add_columns(filling* f, const void* setup) {
  pl_result* r = f->result;
  pl_result_columns(r->arena, setup, &r->columns, &r->n_columns, &r->has_mode);
}

static pleuel_status on_begin(void* user, const pl_setup* setup) {
  filling* f = user;
  pl_result* r = f->result;
  f->setup = setup;
  PL_TRY(guarded(f, add_columns, setup));
  return r->next.begin ? r->next.begin(r->next.user, setup) : PLEUEL_OK;
}

static void add_row(filling* f, const void* what) {
  const pl_row* row = what;
  pl_result* r = f->result;
  if (!r->keep_rows && r->rows.n == 2) {
    pl_result_flatten(f->setup, row, r->rows.at[1]);
    r->modes.at[1] = keep_text(f, row->mode);
    r->kinds.at[1] = row->kind;
    return;
  }
  pl_push(r->arena, r->rows, keep_row(f, row));
  pl_push(r->arena, r->modes, keep_text(f, row->mode));
  pl_push(r->arena, r->kinds, row->kind);
}

static pleuel_status on_row(void* user, const pl_row* row) {
  filling* f = user;
  f->result->n_rows++;
  PL_TRY(guarded(f, add_row, row));
  return f->result->next.row ? f->result->next.row(f->result->next.user, row) : PLEUEL_OK;
}

typedef struct digits {
  pl_arena* arena;
  const char** text;
  int n;
} digits;

static void take_digits(void* user, const char* text) {
  digits* d = user;
  d->text[d->n++] = pl_copy(d->arena, text);
}

static void add_event(filling* f, const void* what) {
  const pl_event_record* e = what;
  pl_result* r = f->result;
  pl_result_event event = {.kind = e->kind,
                           .t = e->after.t,
                           .at_start = e->at_start,
                           .impulse = e->impulse,
                           .jump = e->jump,
                           .bounces = e->bounces};
  event.label = e->label ? pl_copy(r->arena, e->label) : NULL;
  event.before = keep_row(f, &e->before);
  event.after = keep_row(f, &e->after);
  if (e->after.digits) {
    digits d = {r->arena, PL_ARRAY(r->arena, const char*, r->n_columns + 1), 0};
    pl_result_digits(f->setup, &e->after, &d, take_digits);
    event.digits = d.text;
  }
  event.mode_before = pl_copy(r->arena, e->before.mode);
  event.mode_after = pl_copy(r->arena, e->after.mode);
  pl_push(r->arena, r->events, event);
}

static pleuel_status on_event(void* user, const pl_event_record* e) {
  filling* f = user;
  PL_TRY(guarded(f, add_event, e));
  return f->result->next.event ? f->result->next.event(f->result->next.user, e) : PLEUEL_OK;
}

static void keep_message(filling* f, const void* message) {
  f->result->message = pl_copy(f->result->arena, message);
}

static pleuel_status on_end(void* user, pleuel_status how, const char* message,
                            const pl_stats* stats) {
  filling* f = user;
  pl_result* r = f->result;
  r->complete = how == PLEUEL_OK;
  r->status = how;
  r->message = "";
  r->stats = *stats;
  PL_TRY(guarded(f, keep_message, message));
  return r->next.end ? r->next.end(r->next.user, how, message, stats) : PLEUEL_OK;
}

// -------------------------------------------------------------------------------------- the object
pl_result* pl_result_make(pl_arena* a, bool keep_rows) {
  pl_result* r = PL_NEW(a, pl_result);
  r->arena = a;
  r->keep_rows = keep_rows;
  return r;
}

pl_sink pl_result_sink(pl_result* r) {
  filling* f = PL_NEW(r->arena, filling);
  f->result = r;
  return (pl_sink){.user = f, .begin = on_begin, .row = on_row, .event = on_event, .end = on_end};
}

// ------------------------------------------------------------------------------------- interrupted
static void keep_numbers(pl_result* r, pl_keeper* k, double** x) {
  if (k->reads) *x = PL_ARRAY(r->arena, double, r->n_columns);
  pl_keep_f64s(k, *x, (size_t)r->n_columns);
}

static void keep_digits(pl_result* r, pl_keeper* k, pl_result_event* e) {
  bool any = e->digits != NULL;
  pl_keep_bool(k, &any);
  if (!any) return;
  const char** text = PL_ARRAY(r->arena, const char*, r->n_columns + 1);
  for (int i = 0; i < r->n_columns; i++) {
    if (e->digits) text[i] = e->digits[i];
    pl_keep_text(k, &text[i]);
    if (k->reads && text[i] == NULL) pl_keep_fail(k);
  }
  e->digits = text;
}

static void keep_event(pl_result* r, pl_keeper* k, pl_result_event* e) {
  int kind = (int)e->kind;
  double *before = (double*)(uintptr_t)e->before, *after = (double*)(uintptr_t)e->after;
  pl_keep_int(k, &kind, PL_EV_EVENT, PL_EV_SLIP);
  pl_keep_text(k, &e->label);
  pl_keep_f64(k, &e->t);
  pl_keep_bool(k, &e->at_start);
  pl_keep_f64(k, &e->impulse);
  pl_keep_bool(k, &e->jump);
  pl_keep_long(k, &e->bounces, 0, INT64_MAX);
  pl_keep_text(k, &e->mode_before);
  pl_keep_text(k, &e->mode_after);
  keep_digits(r, k, e);
  keep_numbers(r, k, &before);
  keep_numbers(r, k, &after);
  e->kind = (pl_event_kind)kind;
  e->before = before;
  e->after = after;
}

void pl_result_keep(pl_result* r, pl_keeper* k) {
  int columns = r->n_columns, rows = r->rows.n, events = r->events.n;
  size_t width = (size_t)columns * sizeof(double);
  pl_keep_section(k, "result");
  pl_keep_int(k, &columns, columns, columns);
  pl_keep_long(k, &r->n_rows, 0, LONG_MAX / 8);
  pl_keep_count(k, &rows, width);
  for (int i = 0; i < rows && k->wrong == NULL; i++) {
    double* x = k->reads ? NULL : r->rows.at[i];
    const char* mode = k->reads ? NULL : r->modes.at[i];
    int kind = k->reads ? 0 : (int)r->kinds.at[i];
    keep_numbers(r, k, &x);
    pl_keep_text(k, &mode);
    pl_keep_int(k, &kind, PL_ROW_START, PL_ROW_END);
    if (!k->reads || k->wrong) continue;
    pl_push(r->arena, r->rows, x);
    pl_push(r->arena, r->modes, mode);
    pl_push(r->arena, r->kinds, (pl_row_kind)kind);
  }
  pl_keep_count(k, &events, 2 * width);
  for (int i = 0; i < events && k->wrong == NULL; i++) {
    pl_result_event e = k->reads ? (pl_result_event){0} : r->events.at[i];
    keep_event(r, k, &e);
    if (k->reads && k->wrong == NULL) pl_push(r->arena, r->events, e);
  }
}

int pl_result_find(const pl_result* r, const char* name) {
  for (int i = 0; i < r->n_columns; i++)
    if (r->columns[i].name && strcmp(r->columns[i].name, name) == 0) return i;
  return -1;
}

double pl_result_last(const pl_result* r, const char* name) {
  int column = pl_result_find(r, name);
  return column < 0 || r->rows.n == 0 ? (double)NAN : r->rows.at[r->rows.n - 1][column];
}
