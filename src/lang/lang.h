// lang: the model language.  Text in, model out; all errors of a file at once.
#ifndef PL_LANG_H
#define PL_LANG_H

#include "model/model.h"

// Reads `include`d files for the parser.  Returns NULL when the file cannot be read.  The caller owns policy (the
// command line reads beside the including file; a server refuses).
typedef struct pl_include_reader {
  const pl_source* (*read)(void* user, pl_arena* a, const char* path, const pl_source* from);
  void* user;
} pl_include_reader;

// A `--set NAME=VALUE` of the command line, applied while lowering so that family sizes follow.
typedef struct pl_setting { const char* name; const char* value; } pl_setting;   // value as text, with unit: "500[g]"

// pl_lang_parse reads a model.  Diagnostics go to job->diagnostics; the model is made as far as possible even when
// there are errors (status PLEUEL_MODEL_ERROR).  The model is lowered but not yet checked (pl_model_check).
pleuel_status pl_lang_parse(pl_job* job, const pl_source* source, const pl_include_reader* reader, const pl_setting* set,
                            int n_set, pl_model** out);

// pl_lang_expression reads one expression in the names of a model: for --set, for tests and for expect from outside.
pleuel_status pl_lang_expression(pl_job* job, pl_model* m, const char* text, pl_expr* out);

// pl_lang_format writes the canonical layout: idempotent, keeps comments, changes no meaning.
typedef enum pl_spelling { PL_SPELL_KEEP, PL_SPELL_UNICODE, PL_SPELL_ASCII } pl_spelling;
pleuel_status pl_lang_format(pl_job* job, const pl_source* source, pl_spelling spelling, const char** out);

#endif
