// Models: a text is read with its settings and includes; its messages are handed out.
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "api/api_impl.h"
#include "api/editor.h"
#include "pleuel.h"

// ------------------------------------------------------------------------------------- loading
typedef struct pl_reading {
  const char* text;
  size_t size;
  const pleuel_load_options* options;
  bool is_file;
} pl_reading;

// Includes of the caller.
static const pl_source* read_by_caller(void* user, pl_arena* a, const char* path,
                                       const pl_source* from) {
  const pleuel_load_options* o = user;
  const char* text = o->read(o->read_user, path, from ? from->name : "");
  return text ? pl_source_make(a, pl_copy(a, path), pl_copy(a, text), strlen(text)) : NULL;
}

// a model is kilobytes; this keeps a mistyped name from filling the memory
enum { MAX_FILE_BYTES = 64 << 20 };

// The whole of a file, NUL-terminated; NULL with errno set when it cannot be read.
static char* read_file(pl_arena* a, const char* path, size_t* size) {
  FILE* f = fopen(path, "rb");
  if (!f) return NULL;
  pl_text text = pl_text_make(a);
  char piece[1 << 14];
  size_t n;
  bool fits = true;
  while (fits && (n = fread(piece, 1, sizeof piece, f)) > 0) {
    pl_text_add_n(&text, piece, n);
    fits = text.n <= MAX_FILE_BYTES;
  }
  int why = fits ? errno : EFBIG;
  bool bad = ferror(f) || !fits;
  fclose(f);
  errno = why;
  if (bad) return NULL;
  *size = text.n;
  return text.at ? text.at : pl_copy(a, "");
}

// Includes of a file: what lies beside it.
static const pl_source* read_beside(void* user, pl_arena* a, const char* path,
                                    const pl_source* from) {
  (void)user;
  const char* slash = from ? strrchr(from->name, '/') : NULL;
  const char* full = path[0] == '/' || !slash
                         ? path
                         : pl_format(a, "%.*s/%s", (int)(slash - from->name), from->name, path);
  size_t size = 0;
  char* text = read_file(a, full, &size);
  return text ? pl_source_make(a, pl_copy(a, full), text, size) : NULL;
}

static pleuel_status load(pleuel_model* m, void* argument) {
  pl_reading* l = argument;
  const pleuel_load_options* o = l->options;
  if (l->is_file) {
    size_t size = 0;
    char* text = read_file(m->arena, l->text, &size);
    if (!text) return pl_fail(&m->job, PLEUEL_FILE, "%s: %s", l->text, strerror(errno));
    l->text = text;
    l->size = size;
  } else {
    l->text = pl_copy_n(m->arena, l->text, l->size);
  }
  m->source = pl_source_make(m->arena, m->name, l->text, l->size);

  pl_setting* set = PL_ARRAY(m->arena, pl_setting, o->n_settings);
  for (size_t i = 0; i < o->n_settings; i++) {
    set[i] = (pl_setting){pl_copy(m->arena, o->settings[i].name),
                          pl_copy(m->arena, o->settings[i].value)};
  }
  m->settings = set;
  m->tolerant = o->tolerant != 0;
  m->n_settings = (int)o->n_settings;

  pl_include_reader* reader = PL_NEW(m->arena, pl_include_reader);
  if (o->read) {
    pleuel_load_options* keep = PL_NEW(m->arena, pleuel_load_options);
    *keep = *o;
    *reader = (pl_include_reader){read_by_caller, keep};
  } else if (l->is_file) {
    *reader = (pl_include_reader){read_beside, NULL};
  }
  m->reader = reader->read ? reader : NULL;
  return pl_pipeline_parse(m);
}

void pl_model_keep(pleuel_model* m) { atomic_fetch_add(&m->owners, 1); }

void pl_model_drop(pleuel_model* m) {
  if (atomic_fetch_sub(&m->owners, 1) == 1) pl_arena_free(m->arena);
}

static void free_work(pleuel_model* m) {
  pl_arena_free(m->work);
  pl_arena_free(m->motion);
  pl_arena_free(m->recorded_in);
}

static bool make_work(pleuel_model* m, const pleuel* ctx) {
  m->work = pl_arena_make(ctx->alloc);
  m->motion = m->work ? pl_arena_make(ctx->alloc) : NULL;
  m->recorded_in = m->motion ? pl_arena_make(ctx->alloc) : NULL;
  if (!m->recorded_in) return false;
  pl_arena* all[] = {m->work, m->motion, m->recorded_in};
  for (int i = 0; ctx->limit && i < 3; i++) pl_arena_limit(all[i], ctx->limit);
  m->work_empty = pl_arena_mark(m->work);
  m->motion_empty = pl_arena_mark(m->motion);
  m->recorded_empty = pl_arena_mark(m->recorded_in);
  return true;
}

// Makes an empty model; NULL when memory is short.
static pleuel_model* model_make(pleuel* ctx, const char* name) {
  pl_arena* arena = pl_arena_make(ctx->alloc);
  if (!arena) return NULL;
  if (ctx->limit) pl_arena_limit(arena, ctx->limit);
  pleuel_model* volatile made = NULL;
  pl_guard guard;
  PL_GUARD(arena, guard) {
    pleuel_model* m = PL_NEW(arena, pleuel_model);
    m->ctx = ctx;
    m->arena = arena;
    atomic_init(&m->owners, 1);
    if (ctx->alloc) m->alloc = *ctx->alloc;
    m->diagnostics.arena = arena;
    m->job = (pl_job){.arena = arena,
                      .diagnostics = &m->diagnostics,
                      .interrupted = &ctx->interrupted,
                      .lang = ctx->lang};
    m->name = pl_copy(arena, name);
    made = m;
  }
  pl_guard_end(arena, &guard);
  pleuel_model* m = made;
  if (!m || !make_work(m, ctx)) {
    if (m) free_work(m);
    pl_arena_free(arena);
    return NULL;
  }
  m->next = ctx->first;
  if (m->next) m->next->before = m;
  ctx->first = m;
  return m;
}

static pleuel_status load_model(pleuel* ctx, pleuel_model** model, pl_reading* l,
                                const char* name) {
  pleuel_model* m = model_make(ctx, name);
  if (!m) return pl_api_fail(ctx, PLEUEL_NO_MEMORY, "memory ran out");
  pleuel_status s = pl_api_guarded(m, load, l);
  if (s == PLEUEL_FILE || m->broken) {
    char sentence[sizeof ctx->message];
    memcpy(sentence, ctx->message, sizeof sentence);
    pleuel_model_free(m);
    memcpy(ctx->message, sentence, sizeof sentence);
    return s;
  }
  if (s == PLEUEL_MODEL_ERROR && !ctx->message[0]) pl_api_fail(ctx, s, "the model has errors");
  *model = m;
  return s;
}

pleuel_status pleuel_load_text(pleuel* ctx, pleuel_model** model, const char* text, size_t size,
                               const pleuel_load_options* options) {
  if (!ctx || !model) return PLEUEL_USAGE;
  *model = NULL;
  ctx->message[0] = '\0';
  if (!text) return pl_api_fail(ctx, PLEUEL_USAGE, "there is no text");
  if (size > MAX_FILE_BYTES)
    return pl_api_fail(ctx, PLEUEL_FILE, "the text is too long for a model");
  pleuel_load_options o;
  PL_TRY(pl_api_take(ctx, &o, sizeof o, options));
  pl_reading l = {text, size, &o, false};
  return load_model(ctx, model, &l, o.name ? o.name : "<text>");
}

pleuel_status pleuel_load_file(pleuel* ctx, pleuel_model** model, const char* path,
                               const pleuel_load_options* options) {
  if (!ctx || !model) return PLEUEL_USAGE;
  *model = NULL;
  ctx->message[0] = '\0';
  if (!path) return pl_api_fail(ctx, PLEUEL_USAGE, "there is no file name");
  pleuel_load_options o;
  PL_TRY(pl_api_take(ctx, &o, sizeof o, options));
  pl_reading l = {path, 0, &o, true};
  return load_model(ctx, model, &l, o.name ? o.name : path);
}

void pleuel_model_free(pleuel_model* m) {
  if (!m || !m->ctx) return;
  if (m->solution) pl_solution_close(m->solution);
  pl_editor_free(m->editor);
  m->editor = NULL;
  m->solution = NULL;
  if (m->before) m->before->next = m->next;
  else m->ctx->first = m->next;
  if (m->next) m->next->before = m->before;
  m->ctx = NULL;
  free_work(m);
  pl_model_drop(m);
}

// ------------------------------------------------------------------------------------ messages
size_t pleuel_diagnostic_count(const pleuel_model* m, pleuel_severity severity) {
  size_t n = 0;
  for (int i = 0; m && i < m->diagnostics.list.n; i++)
    n += (int)pl_code_severity(m->diagnostics.list.at[i].code) == (int)severity;
  return n;
}

enum { MOST_MESSAGES = 50 };  // of one kind of text; a file that is no model has thousands

typedef struct pl_telling {
  unsigned severities;
  pl_print_style style;
  const char* text;
} pl_telling;

static pleuel_status tell(pleuel_model* m, void* argument) {
  pl_telling* t = argument;
  pl_text out = pl_text_make(m->arena);
  int n = 0;
  for (int i = 0; i < m->diagnostics.list.n; i++) {
    const pl_diagnostic* d = &m->diagnostics.list.at[i];
    if (!(t->severities >> pl_code_severity(d->code) & 1) || ++n > MOST_MESSAGES) continue;
    if (out.n > 0 && !t->style.terse) pl_text_add(&out, "\n");
    pl_diagnostic_print(&out, d, t->style);
  }
  if (n > MOST_MESSAGES) {
    pl_text_addf(
        &out,
        t->style.lang == PL_GERMAN ? pl_german("and %d more messages\n") : "and %d more messages\n",
        n - MOST_MESSAGES);
  }
  t->text = pl_text_string(&out);
  return PLEUEL_OK;
}

const char* pleuel_diagnostics_text(pleuel_model* m, unsigned severities,
                                    const pleuel_text_options* options) {
  if (!m) return NULL;
  pleuel_text_options o;
  char sentence[sizeof m->ctx->message];
  // telling about a failure must not hide its sentence
  memcpy(sentence, m->ctx->message, sizeof sentence);
  if (pl_api_take(m->ctx, &o, sizeof o, options) != PLEUEL_OK) return NULL;
  pl_telling t = {severities, {pl_api_language_of(m, o.lang), o.colour, o.terse}, NULL};
  pl_api_guarded(m, tell, &t);
  if (!m->broken) memcpy(m->ctx->message, sentence, sizeof sentence);
  return t.text;
}
