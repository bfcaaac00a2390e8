// lang: the model language.  Text in, model out; all errors of a file at once.
#ifndef PL_LANG_H
#define PL_LANG_H

#include "model/model.h"

// Reads `include`d files for the parser. Returns NULL when the file cannot be read. The caller owns
// policy (the command line reads beside the including file; a server refuses).
typedef struct pl_include_reader {
  const pl_source* (*read)(void* user, pl_arena* a, const char* path, const pl_source* from);
  void* user;
} pl_include_reader;

// A `--set NAME=VALUE` of the command line, applied while lowering so that family sizes follow.
// NAME is a parameter, an abbreviation or a start value (x1, x1', x1_dot). VALUE is an expression
// in the names of the model, with unit: "500[g]", "2 m1"; a bare number for a parameter with a unit
// is in the unit of the file.
typedef struct pl_setting {
  const char* name;
  const char* value;
} pl_setting;  // value as text, with unit: "500[g]"

// pl_lang_parse reads a model. Diagnostics go to job->diagnostics; the model is made as far as
// possible even when there are errors (status PLEUEL_MODEL_ERROR). The model is lowered but not yet
// checked (pl_model_check). Conventions of what it leaves in the model:
//   E(0), T(0), ...      symbols of role PL_R_CONSTANT, ascii "E_0"; p_x the PL_R_MOMENTUM of x
//   labels in requests   "c[3]" for a member of a family, the index a number where it is known
//   a family's multiplier is one symbol; its members are PL_AT nodes of that symbol
//   `modes holding x`    the names are in pl_ask.frame; `expect A where C` has A in where[0]
//   `rod`                three masses, generated names label.start, label.middle, label.end
pleuel_status pl_lang_parse(pl_job* job, const pl_source* source, const pl_include_reader* reader,
                            const pl_setting* set, int n_set, pl_model** out);

// pl_lang_expression reads one expression in the names of a model: for --set, for tests and for
// expect from outside.
pleuel_status pl_lang_expression(pl_job* job, pl_model* m, const char* text, pl_expr* out);

// pl_lang_format writes the canonical layout: idempotent, keeps comments, changes no meaning.
typedef enum pl_spelling { PL_SPELL_KEEP, PL_SPELL_UNICODE, PL_SPELL_ASCII } pl_spelling;
pleuel_status pl_lang_format(pl_job* job, const pl_source* source, pl_spelling spelling,
                             const char** out);

#endif
