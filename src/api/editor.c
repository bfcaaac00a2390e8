// The editor of a model, and the arenas of its answers.
#include "api/editor.h"

#include <string.h>

// ---------------------------------------------------------------------------------------- memory
static pl_arena* arena_for(pleuel_model* m) {
  pl_arena* a = pl_arena_make(m->ctx->alloc);
  if (a && m->ctx->limit) pl_arena_limit(a, m->ctx->limit);
  return a;
}

void pl_editor_free(pl_editor* e) {
  if (!e) return;
  for (int i = 0; i < PL_N_ANSWERS; i++) {
    if (e->answer[i]) pl_arena_free(e->answer[i]);
  }
  if (e->formula_arena) pl_arena_free(e->formula_arena);
  pl_arena_free(e->arena);
}

// Includes as the parser was given them, which were kept.
static const pl_source* read_kept(void* user, pl_arena* a, const char* path,
                                  const pl_source* from) {
  const pleuel_model* m = user;
  for (int i = 0; i < m->included.n; i++) {
    const pl_included* f = &m->included.at[i];
    bool same = from ? strcmp(f->from, from->name) == 0 : !*f->from;
    if (same && strcmp(f->path, path) == 0) return f->source;
  }
  return NULL;
}

pl_editor* pl_editor_of(pleuel_model* m) {
  if (m->editor) return m->editor;
  pl_arena* arena = m->broken || !m->source ? NULL : arena_for(m);
  if (!arena) return NULL;
  pl_guard guard;
  pl_editor* volatile made = NULL;
  PL_GUARD(arena, guard) {
    pl_editor* e = PL_NEW(arena, pl_editor);
    e->arena = arena;
    pl_include_reader reader = {read_kept, m};
    e->outline = pl_outline_make(arena, m->source, &reader);
    made = e;
  }
  pl_guard_end(arena, &guard);
  if (!made) pl_arena_free(arena);
  m->editor = made;
  return made;
}

// ---------------------------------------------------------------------------------------- answers
pleuel_status pl_editor_guarded_in(pleuel_model* m, pl_arena* a, pl_editor_work* work,
                                   void* argument) {
  m->ctx->message[0] = '\0';
  volatile pleuel_status status = PLEUEL_NO_MEMORY;
  pl_guard guard;
  PL_GUARD(a, guard) { status = work(m, a, argument); }
  else {
    status = guard.status;
  }
  pl_guard_end(a, &guard);
  if (status == PLEUEL_NO_MEMORY) return pl_api_fail(m->ctx, status, "memory ran out");
  return status;
}

static pl_arena* pl_editor_fresh(pleuel_model* m, pl_answer_kind kind) {
  pl_editor* e = pl_editor_of(m);
  if (!e) return NULL;
  if (e->answer[kind]) pl_arena_free(e->answer[kind]);
  e->answer[kind] = arena_for(m);
  return e->answer[kind];
}

pleuel_status pl_editor_answer(pleuel_model* m, pl_answer_kind kind, pl_editor_work* work,
                               void* argument) {
  pl_arena* a = pl_editor_fresh(m, kind);
  return a ? pl_editor_guarded_in(m, a, work, argument)
           : pl_api_fail(m->ctx, PLEUEL_NO_MEMORY, "memory ran out");
}

pleuel_status pl_editor_keep(pleuel_model* m, pl_editor_work* work, void* argument) {
  pl_editor* e = pl_editor_of(m);
  return e ? pl_editor_guarded_in(m, e->arena, work, argument)
           : pl_api_fail(m->ctx, PLEUEL_NO_MEMORY, "memory ran out");
}

pleuel_status pl_editor_keep_formulas(pleuel_model* m, pl_editor_work* work) {
  pl_editor* e = pl_editor_of(m);
  if (e && !e->formula_arena) e->formula_arena = arena_for(m);
  bool ready = e && e->formula_arena;
  return ready ? pl_editor_guarded_in(m, e->formula_arena, work, NULL)
               : pl_api_fail(m->ctx, PLEUEL_NO_MEMORY, "memory ran out");
}

// ---------------------------------------------------------------------------------------- values
pleuel_span pl_api_span(pl_span s) {
  if (!s.source) return (pleuel_span){0};
  pl_position b = pl_source_position(s.source, s.begin), e = pl_source_position(s.source, s.end);
  return (pleuel_span){.file = s.source->name,
                       .begin = b.at,
                       .end = e.at,
                       .begin16 = b.at16,
                       .end16 = e.at16,
                       .line = b.line,
                       .column = b.column,
                       .column16 = b.column16,
                       .end_line = e.line,
                       .end_column = e.column,
                       .end_column16 = e.column16};
}
