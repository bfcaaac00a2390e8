// condition_forms: conditions as they are displayed.
#include "worked/worked_impl.h"

pl_answer3 pl_condition_form(pl_analysis* d, pl_expr e, bool strict, const pl_form** form,
                             const char** text) {
  pl_inequality c;
  pl_answer3 answer = pl_holds_if(d, e, strict, &c);
  if (answer != PL_UNKNOWN) return answer;
  const pl_form *more = pl_f(d, c.more, PL_S_QUOTIENT), *less = pl_f(d, c.less, PL_S_QUOTIENT);
  *form = c.turned ? pl_frel(d, less, strict ? "<" : "≤", more)
                   : pl_frel(d, more, strict ? ">" : "≥", less);
  const char* op = c.turned ? (strict ? "<" : "<=") : (strict ? ">" : ">=");
  *text = pl_format(d->arena, "%s %s %s",
                    pl_expr_text(d->arena, d->pool, c.turned ? c.less : c.more), op,
                    pl_expr_text(d->arena, d->pool, c.turned ? c.more : c.less));
  return PL_UNKNOWN;
}

const pl_form* pl_conditions_form(pl_analysis* d, const pl_expr* e, int n, bool strict,
                                  const char** text) {
  const pl_form** form = PL_ARRAY(d->arena, const pl_form*, n + 1);
  pl_text words = pl_text_make(d->arena);
  int shown = 0;
  for (int k = 0; k < n; k++) {
    const char* one = NULL;
    if (pl_condition_form(d, e[k], strict, &form[shown], &one) != PL_UNKNOWN) continue;
    pl_text_addf(&words, "%s%s", shown ? " and " : "", one);
    shown++;
  }
  *text = pl_text_string(&words);
  return shown == 0 ? NULL : shown == 1 ? form[0] : pl_flist(d, form, shown);
}
