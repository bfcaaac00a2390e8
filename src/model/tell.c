// How the checks speak: a message in both languages, an expression as its reader writes it.
#include "model_impl.h"

#include "notation/notation.h"

pl_diagnostic* pl_tell(pl_job* job, pl_code code, pl_span span, const char* en, const char* de) {
  return pl_report(job->diagnostics, code, span, en, de);
}

const char* pl_expr_words(pl_arena* a, pl_pool* p, pl_expr e) {
  return pl_notation_print(a, p, pl_form_of(a, p, e), (pl_notation){PL_MATH_LINE, PL_ENGLISH});
}
