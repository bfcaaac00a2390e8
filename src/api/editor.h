// editor: what is kept of a model for those who ask about its text.  Made when it is first asked
// for.
#ifndef PL_EDITOR_H
#define PL_EDITOR_H

#include "api/api_impl.h"
#include "lang/outline.h"

// Texts that live until the same function is called again.
typedef enum pl_answer_kind {
  PL_ANSWER_DIAGNOSTICS,
  PL_ANSWER_EDITED,
  PL_ANSWER_USES,
  PL_ANSWER_RENAME,
  PL_ANSWER_HOVER,
  PL_ANSWER_OFFERS,
  PL_ANSWER_STEPS,
  PL_ANSWER_TRIAL,
  PL_N_ANSWERS
} pl_answer_kind;

typedef struct pl_editor {
  pl_arena* arena;  // the outline and what is kept
  pl_outline* outline;
  pleuel_name* names;  // (n_names)
  size_t n_names;
  pleuel_status named_after;  // how the model was checked when the names were listed
  pleuel_token* tokens;
  size_t n_tokens;
  pl_arena* answer[PL_N_ANSWERS];
  pleuel_diagnostic* diagnostics;
  uint64_t diagnostics_hash;     // of the messages that they show
  pl_arena* formula_arena;       // of what goes with the solution
  struct pl_formulas* formulas;  // NULL: not listed
} pl_editor;

// The editor of a model; NULL when memory ran out.
pl_editor* pl_editor_of(pleuel_model* m);
void pl_editor_free(pl_editor* e);

typedef pleuel_status pl_editor_work(pleuel_model* m, pl_arena* a, void* argument);
// Runs work whose answer lives in an arena of its own until the same is asked again.
pleuel_status pl_editor_answer(pleuel_model* m, pl_answer_kind kind, pl_editor_work* work,
                               void* argument);
// The same for what goes with the solution of the model.
pleuel_status pl_editor_keep_formulas(pleuel_model* m, pl_editor_work* work);
// The solution is about to go: formulas go with it.
void pl_editor_forget_solution(pleuel_model* m);
// Runs work whose answer is kept.
pleuel_status pl_editor_keep(pleuel_model* m, pl_editor_work* work, void* argument);

// Runs work with the memory of an arena.
pleuel_status pl_editor_guarded_in(pleuel_model* m, pl_arena* a, pl_editor_work* work,
                                   void* argument);

pleuel_span pl_api_span(pl_span s);

#endif
