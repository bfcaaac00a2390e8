// values: the answers of a section, as numbers with units and as text.
#include <math.h>
#include <string.h>

#include "worked/worked_impl.h"

static const char* display_in(pl_analysis* d, double x, const char* unit) {
  pl_notation how = {.math = PL_MATH_ASCII, .lang = d->job->lang};
  const char* number = pl_notation_number(d->arena, x, 6, how);
  return *unit && strcmp(unit, "1") != 0 ? pl_format(d->arena, "%s %s", number, unit) : number;
}

const char* pl_display(pl_analysis* d, double x, pl_dimension dim, bool angle) {
  if (isnan(x)) return NULL;
  pl_notation how = {.math = PL_MATH_ASCII, .lang = d->job->lang};
  if (angle)
    return pl_format(d->arena, "%s deg", pl_notation_number(d->arena, x * 180 / M_PI, 6, how));
  return display_in(d, x, pl_dimension_unit(d->arena, dim, true));
}

static void note_first_form(pl_analysis* d, pl_symbol name) {
  pl_role role = name.id ? pl_symbol_get(d->pool, name)->role : PL_R_LOCAL;
  if (d->page->solution->cpu_ms_first > 0 || (role != PL_R_ACCELERATION && role != PL_R_MULTIPLIER))
    return;
  d->page->solution->cpu_ms_first = pl_cpu_ms() - d->page->began_ms;
}

// Other programs get what people see, where that is shorter: a normal form is multiplied out, which
// costs digits too.
pl_expr pl_as_shown(pl_analysis* d, pl_expr e, const pl_form* form) {
  if (!form || pl_is_poison(e)) return e;
  pl_expr shown = pl_form_value(d->pool, form);
  if (pl_is_poison(shown) || pl_op_count(d->pool, shown) >= pl_op_count(d->pool, e)) return e;
  if (pl_has_role(d->pool, shown, PL_R_LOCAL) && !pl_has_role(d->pool, e, PL_R_LOCAL)) return e;
  return pl_alg_equal(d->tower, shown, e) == PL_YES ? shown : e;
}

pl_value* pl_answer(pl_analysis* d, const char* name, pl_expr e, const pl_form* form) {
  pl_value v = {.name = name,
                .expr = pl_as_shown(d, e, form),
                .form = form,
                .number = pl_number(d, e),
                .conserved = -1,
                .passed = -1,
                .order = -1};
  bool known = true;
  pl_dimension dim = pl_is_poison(e) ? pl_dimension_one() : pl_dimension_of_expr(d, e, &known);
  pl_symbol symbol = pl_symbol_find(d->pool, name);  // x1'' = 0 has the unit of x1''
  note_first_form(d, symbol);
  if (symbol.id && !pl_is_poison(e) && pl_is_number(d->pool, e)) {
    dim = pl_symbol_get(d->pool, symbol)->dimension;
    known = pl_symbol_get(d->pool, symbol)->dimension_known;
  }
  if (known) v.unit = pl_unit_of_symbol(d->arena, d->pool, symbol, dim, true);
  v.display = isnan(v.number) ? NULL
                              : display_in(d, v.number,
                                           pl_unit_of_symbol(d->arena, d->pool, symbol, dim, true));
  pl_push(d->arena, d->page->section->values, v);
  pl_say_pole(d, e);
  return &d->page->section->values.at[d->page->section->values.n - 1];
}
