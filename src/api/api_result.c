// Results: rows in one block, events, and what is said about a motion.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "api/system_impl.h"

// ------------------------------------------------------------------------------------------ memory
static void* take(const pleuel_result* r, size_t n) {
  const pleuel_allocator* a = &r->system->model->alloc;
  return a->take ? a->take(a->user, n) : malloc(n);
}

static void give(const pleuel_result* r, void* block) {
  const pleuel_allocator* a = &r->system->model->alloc;
  if (a->take) a->give(a->user, block);
  else free(block);
}

// Room for one more row; false: there is none.
static bool reserve(pleuel_result* r) {
  if (r->n_stored < r->room) return true;
  size_t room = r->room ? 2 * r->room : 64, row = r->width * sizeof(double);
  if (room > (size_t)-1 / (row ? row : 1)) return false;
  double* more = take(r, room * row);
  if (!more) return false;
  if (r->n_stored) memcpy(more, r->rows, r->n_stored * row);
  if (r->rows) give(r, r->rows);
  r->rows = more;
  r->room = room;
  return true;
}

pleuel_result* pl_result_open(pleuel_system* system, bool keeps) {
  const pleuel_allocator* alloc = system->model->alloc.take ? &system->model->alloc : NULL;
  pl_arena* arena = pl_arena_make(alloc);
  if (!arena) return NULL;
  pleuel_result* volatile made = NULL;
  pl_guard guard;
  PL_GUARD(arena, guard) {
    pleuel_result* r = PL_NEW(arena, pleuel_result);
    r->arena = arena;
    r->system = system;
    r->keeps = keeps;
    r->story = pl_result_make(arena, false);
    r->width = (size_t)system->columns.n;
    r->row = PL_ARRAY(arena, double, r->width + 1);
    made = r;
  }
  pl_guard_end(arena, &guard);
  if (made) pleuel_system_keep(system);
  else pl_arena_free(arena);
  return made;
}

void pleuel_result_free(pleuel_result* r) {
  if (!r) return;
  pleuel_system* system = r->system;
  if (r->rows) give(r, r->rows);
  if (r->text) pl_arena_free(r->text);
  pl_arena_free(r->arena);
  pleuel_system_free(system);
}

// -------------------------------------------------------------------------------------------- rows
static pleuel_status on_begin(void* user, const pl_setup* setup) {
  pleuel_result* r = user;
  r->setup = setup;
  return PLEUEL_OK;
}

static void keep_mode(pleuel_result* r, const char* mode) {
  const char* last = r->modes.n ? r->modes.at[r->modes.n - 1] : NULL;
  if (!last || strcmp(last, mode) != 0) last = pl_copy(r->arena, mode);
  pl_push(r->arena, r->modes, last);
}

// Memory that runs out stops the run with a status: it must not unwind through it.
static pleuel_status store(pleuel_result* r, const pl_row* row) {
  pl_guard guard;
  if (!reserve(r)) return PLEUEL_NO_MEMORY;
  PL_GUARD(r->arena, guard) {
    keep_mode(r, row->mode);
    guard.status = PLEUEL_OK;
  }
  pl_guard_end(r->arena, &guard);
  if (guard.status != PLEUEL_OK) return guard.status;
  memcpy(r->rows + r->n_stored * r->width, r->row, r->width * sizeof *r->row);
  r->n_stored++;
  return PLEUEL_OK;
}

static pleuel_status on_row(void* user, const pl_row* row) {
  pleuel_result* r = user;
  const pleuel_sim_options* o = r->options;
  if (r->refused) return PLEUEL_INTERRUPTED;
  pl_result_flatten(r->setup, row, r->row);
  if (r->keeps) PL_TRY(store(r, row));
  if (o && o->row) r->refused = o->row(o->user, r->width, r->row, row->mode) != 0;
  return r->refused ? PLEUEL_INTERRUPTED : PLEUEL_OK;
}

pl_sink pl_result_fill(pleuel_result* r, const pleuel_sim_options* o) {
  r->options = o;
  r->story->next = (pl_sink){.user = r, .begin = on_begin, .row = on_row};
  return pl_result_sink(r->story);
}

void pl_result_close(pleuel_result* r, pleuel_status status, const char* message) {
  r->status = status;
  snprintf(r->message, sizeof r->message, "%s", status == PLEUEL_OK ? "" : message);
  r->options = NULL;
  r->setup = NULL;
}

// ----------------------------------------------------------------------------------------- reading
pleuel_status pleuel_result_summary(const pleuel_result* r, pleuel_summary* out) {
  if (!r || !out) return PLEUEL_USAGE;
  const pl_result* s = r->story;
  bool started = s->rows.n > 0;
  pleuel_summary all = {.size = out->size,
                        .status = r->status,
                        .t_end = started ? s->rows.at[s->rows.n - 1][0] : (double)NAN,
                        .steps = s->stats.steps,
                        .rejected = s->stats.rejections,
                        .residual_g = s->stats.max_g,
                        .residual_gdot = s->stats.max_gdot,
                        .energy_drift = started ? s->stats.energy_drift : (double)NAN,
                        .n_events = (size_t)s->events.n,
                        .n_columns = r->width,
                        .n_rows = (size_t)s->n_rows,
                        .n_rows_stored = r->n_stored};
  return pl_api_give(out, &all, sizeof all);
}

pleuel_status pleuel_result_column(const pleuel_result* r, size_t i, pleuel_column* out) {
  if (!r || !out || i >= r->width) return PLEUEL_USAGE;
  const double* at = r->n_stored ? r->rows + i : NULL;
  return pl_column_give(&r->system->columns.at[i], at, r->width, r->n_stored, out);
}

static long find(const pl_quantities* list, const char* name) {
  for (int i = 0; name && i < list->n; i++)
    if (strcmp(list->at[i].name, name) == 0 || strcmp(list->at[i].shown, name) == 0) return i;
  return -1;
}

long pleuel_result_find(const pleuel_result* r, const char* name) {
  return r ? find(&r->system->columns, name) : -1;
}

const char* pleuel_result_mode(const pleuel_result* r, size_t row) {
  return r && row < r->n_stored ? r->modes.at[row] : "";
}

pleuel_status pl_event_give(const pl_event_kept* e, pleuel_event* out) {
  // ORDER EVENT KINDS: as pl_event_kind
  pleuel_event all = {.size = out->size,
                      .kind = (pleuel_event_kind)e->kind,
                      .label = e->label ? e->label : "",
                      .t = e->t,
                      .before = e->before,
                      .after = e->after,
                      .mode = e->mode ? e->mode : "",
                      .impulse = e->impulse,
                      .jump = e->jump,
                      .bounces = e->bounces};
  return pl_api_give(out, &all, sizeof all);
}

pleuel_status pleuel_result_event(const pleuel_result* r, size_t i, pleuel_event* out) {
  if (!r || !out || i >= (size_t)r->story->events.n) return PLEUEL_USAGE;
  const pl_result_event* e = &r->story->events.at[i];
  pl_event_kept kept = {.kind = e->kind,
                        .label = e->label,
                        .t = e->t,
                        .impulse = e->impulse,
                        .jump = e->jump,
                        .bounces = e->bounces,
                        .before = e->before,
                        .after = e->after,
                        .mode = e->mode_after};
  return pl_event_give(&kept, out);
}
