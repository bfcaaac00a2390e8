// Fuzz harness: any bytes as a model text. Parse, check, format; memory is limited, so that only a
// hang, a crash or a broken promise is a finding.
#include <stdlib.h>
#include <string.h>

#include "lang/lang.h"

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

static void require(bool promise) {
  if (!promise) abort();
}

static void work(pl_job* job, const char* text, size_t size) {
  pl_source* source = pl_source_make(job->arena, "fuzz", text, size);
  pl_model* m = NULL;
  pleuel_status status = pl_lang_parse(job, source, NULL, NULL, 0, &m);
  require((status == PLEUEL_OK) == (job->diagnostics->n_errors == 0));
  if (status == PLEUEL_OK) pl_model_check(job, m);
  pl_diagnostics_sort(job->diagnostics);
  pl_text out = pl_text_make(job->arena);
  for (int i = 0; i < job->diagnostics->list.n && i < 50; i++) {
    pl_diagnostic_print(&out, &job->diagnostics->list.at[i],
                        (pl_print_style){.lang = i % 2 ? PL_GERMAN : PL_ENGLISH});
  }
  // what the formatter accepts it accepts again, unchanged
  const char *once = NULL, *twice = NULL;
  if (pl_lang_format(job, source, PL_SPELL_KEEP, &once) != PLEUEL_OK) return;
  require(pl_lang_format(job, pl_source_make(job->arena, "fuzz", once, strlen(once)), PL_SPELL_KEEP,
                         &twice)
          == PLEUEL_OK);
  require(strcmp(once, twice) == 0);
}

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  pl_arena* a = pl_arena_make(NULL);
  if (a == NULL) return 0;
  pl_arena_limit(a, (size_t)256 << 20);
  pl_guard guard;
  PL_GUARD(a, guard) {
    pl_diagnostics* diagnostics = PL_NEW(a, pl_diagnostics);
    diagnostics->arena = a;
    pl_job* job = PL_NEW(a, pl_job);
    job->arena = a;
    job->diagnostics = diagnostics;
    work(job, pl_copy_n(a, (const char*)data, size), size);
  }
  else {
    require(guard.status == PLEUEL_NO_MEMORY);
  }
  pl_guard_end(a, &guard);
  pl_arena_free(a);
  return 0;
}
