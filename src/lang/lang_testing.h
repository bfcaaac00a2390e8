// What the tests of lang share: a text becomes a model, or messages.
#ifndef PL_LANG_TESTING_H
#define PL_LANG_TESTING_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdlib.h>
#include <string.h>

#include "lang/lang.h"

typedef struct bench {
  pl_arena* arena;
  pl_diagnostics diagnostics;
  pl_job job;
  pl_model* m;
  pleuel_status status;
} bench;

static inline bench* bench_make(void) {
  pl_arena* a = pl_arena_make(NULL);
  bench* b = PL_NEW(a, bench);
  b->arena = a;
  b->diagnostics.arena = a;
  b->job = (pl_job){.arena = a, .diagnostics = &b->diagnostics};
  return b;
}

static inline bench* bench_with(const char* text, size_t n, const pl_setting* set, int n_set) {
  bench* b = bench_make();
  b->status = pl_lang_parse(
      &b->job, pl_source_make(b->arena, "test.pleuel", pl_copy_n(b->arena, text, n), n), NULL, set,
      n_set, &b->m);
  pl_diagnostics_sort(&b->diagnostics);
  return b;
}

static inline bench* bench_text(const char* text) {
  return bench_with(text, strlen(text), NULL, 0);
}
static inline void bench_free(bench* b) { pl_arena_free(b->arena); }

// "E011 5:29, E012 6:1": what was said.
static inline const char* bench_said(bench* b) {
  pl_text t = pl_text_make(b->arena);
  for (int i = 0; i < b->diagnostics.list.n; i++) {
    const pl_diagnostic* d = &b->diagnostics.list.at[i];
    pl_place at = d->span.source ? pl_span_place(d->span) : (pl_place){0, 0};
    pl_text_addf(&t, "%s%s %d:%d", i ? ", " : "", pl_code_name(d->code), at.line, at.column);
  }
  return pl_text_string(&t);
}

static inline char* read_file(const char* path, size_t* n) {
  FILE* f = fopen(path, "rb");
  if (f == NULL) return NULL;
  char* text = NULL;
  *n = 0;
  for (size_t got = 1; got;) {
    text = realloc(text, *n + 65537);
    got = fread(text + *n, 1, 65536, f);
    *n += got;
  }
  text[*n] = 0;
  fclose(f);
  return text;
}

#endif
