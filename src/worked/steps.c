// steps: writing the worked solution. Sentences, equations, claims; short hands for forms.
#include <math.h>
#include <string.h>

#include "worked/worked_impl.h"

// ---------------------------------------------------------------------------------------- sections
static pl_step* add_step(pl_analysis* d, pl_step_kind kind) {
  pl_push(d->arena, d->page->section->steps, (pl_step){.kind = kind});
  return &d->page->section->steps.at[d->page->section->steps.n - 1];
}

pl_step* pl_say(pl_analysis* d, const char* en, const char* de, int n, ...) {
  pl_step* s = add_step(d, PL_STEP_TEXT);
  s->words[0] = en;
  s->words[1] = de;
  const pl_form** inserts = PL_ARRAY(d->arena, const pl_form*, n);
  va_list ap;
  va_start(ap, n);
  for (int i = 0; i < n; i++) inserts[i] = va_arg(ap, const pl_form*);
  va_end(ap);
  s->n_inserts = n;
  s->inserts = inserts;
  return s;
}

pl_step* pl_show(pl_analysis* d, const pl_form* formula) {
  pl_step* s = add_step(d, PL_STEP_EQUATION);
  s->formula = formula;
  return s;
}

pl_step* pl_show_numbered(pl_analysis* d, const pl_form* formula) {
  pl_step* s = pl_show(d, formula);
  s->number = ++d->page->solution->n_equations;
  return s;
}

pl_step* pl_row(pl_analysis* d, const char* en, const char* de, const pl_form* formula,
                const char* margin) {
  pl_step* s = add_step(d, PL_STEP_ROW);
  s->words[0] = en;
  s->words[1] = de;
  s->formula = formula;
  s->margin = margin;
  return s;
}

void pl_step_after(pl_step* s, const char* en, const char* de) {
  s->after[0] = en;
  s->after[1] = de;
}

void pl_step_refs(pl_step* s, int n, ...) {
  va_list ap;
  va_start(ap, n);
  for (int i = 0; i < n; i++) {
    int number = va_arg(ap, int);
    if (number > 0 && s->n_refs < 4) s->refs[s->n_refs++] = number;
  }
  va_end(ap);
}

// The name on the left of an equation.
static pl_symbol named_by(pl_analysis* d, const pl_form* f) {
  bool named = f && f->kind == PL_F_RELATION && f->args[0]->kind == PL_F_EXPR
               && pl_kind_of(d->pool, f->args[0]->expr) == PL_SYMBOL;
  return named ? pl_symbol_of(d->pool, f->args[0]->expr) : (pl_symbol){0};
}

void pl_step_value(pl_analysis* d, pl_step* s, pl_expr e, pl_dimension dim) {
  double x = pl_number(d, e);
  if (isnan(x) || pl_is_number(d->pool, e)) return;
  s->has_value = true;
  s->value = x;
  s->unit = pl_unit_of_symbol(d->arena, d->pool, named_by(d, s->formula), dim, false);
}

// ------------------------------------------------------------------------------------------ claims
void pl_claim_that(pl_analysis* d, pl_claim_kind kind, pl_expr shown, pl_expr reference) {
  pl_push(d->arena, d->page->claims,
          (pl_claim){.kind = kind, .shown = shown, .reference = reference});
}

void pl_claim_free(pl_analysis* d, pl_claim_kind kind, pl_expr shown, pl_expr reference) {
  pl_push(d->arena, d->page->claims,
          (pl_claim){.kind = kind, .shown = shown, .reference = reference, .own_domain = true});
}

// ------------------------------------------------------------------------------------------- forms
const pl_form* pl_f(pl_analysis* d, pl_expr e, pl_style style) {
  return pl_present(d->tower, e, style, d->effort_s);
}
const pl_form* pl_fs(pl_analysis* d, pl_symbol s) {
  return pl_form_leaf(d->arena, pl_sym(d->pool, s));
}
const pl_form* pl_fe(pl_analysis* d, pl_expr e) { return pl_form_of(d->arena, d->pool, e); }
const pl_form* pl_fn(pl_analysis* d, const char* name) {
  return pl_form_name(d->arena, name, pl_poison());
}
const char* pl_letter(pl_analysis* d, const char* letter) {
  return pl_model_letter(d->model, d->arena, letter);
}
const pl_form* pl_fl(pl_analysis* d, const char* letter) { return pl_fn(d, pl_letter(d, letter)); }
const pl_form* pl_feq(pl_analysis* d, const pl_form* l, const pl_form* r) {
  return pl_form_relation(d->arena, l, "=", r);
}
const pl_form* pl_frel(pl_analysis* d, const pl_form* l, const char* op, const pl_form* r) {
  return pl_form_relation(d->arena, l, op, r);
}
const pl_form* pl_flist(pl_analysis* d, const pl_form* const* f, int n) {
  return pl_form_make(d->arena, PL_F_LIST, n, f);
}
const pl_form* pl_fref(pl_analysis* d, int number) {
  return pl_fn(d, pl_format(d->arena, "(%d)", number));
}

// Terms of a plain form, each with the sign it has in left - right.
static void add_terms(pl_analysis* d, pl_expr e, bool minus, const pl_form** out, int* n) {
  const pl_form* f = pl_fe(d, e);
  const pl_form* const* term = f->kind == PL_F_SUM ? f->args : &f;
  int count = f->kind == PL_F_SUM ? f->n : 1;
  for (int k = 0; k < count; k++) {
    bool negative = term[k]->kind == PL_F_NEG;
    const pl_form* size = negative ? term[k]->args[0] : term[k];
    out[(*n)++] = negative != minus ? pl_form_neg(d->arena, size) : size;
  }
}

const pl_form* pl_difference_form(pl_analysis* d, pl_expr left, pl_expr right) {
  if (pl_is_zero_node(d->pool, right)) return pl_fe(d, left);
  int cap = pl_n_args(d->pool, left) + pl_n_args(d->pool, right) + 2, n = 0;
  const pl_form** term = PL_ARRAY(d->arena, const pl_form*, cap);
  add_terms(d, left, false, term, &n);
  add_terms(d, right, true, term, &n);
  return pl_form_sum(d->arena, term, n);
}

const pl_form* pl_positive_first(pl_analysis* d, const pl_form* f) {
  return pl_form_positive_first(d->arena, f);
}

// A potential as it came from the model when that is shorter than what presentation finds: -m1 g x1
// - m2 g (l - x1).
const pl_form* pl_potential_form(pl_analysis* d, pl_expr raw, pl_expr normal) {
  const pl_form *plain = pl_fe(d, raw), *found = pl_f(d, normal, PL_S_ENERGY);
  return pl_form_ops(plain) < pl_form_ops(found) ? plain : found;
}

const pl_form* pl_joined_sum(pl_analysis* d, const pl_form* const* part, int n) {
  int cap = 0, m = 0;
  for (int k = 0; k < n; k++) cap += part[k]->kind == PL_F_SUM ? part[k]->n : 1;
  const pl_form** term = PL_ARRAY(d->arena, const pl_form*, cap + 1);
  for (int k = 0; k < n; k++) {
    if (part[k]->kind != PL_F_SUM) {
      bool zero = part[k]->kind == PL_F_EXPR && pl_is_zero_node(d->pool, part[k]->expr);
      if (!zero) term[m++] = part[k];
      continue;
    }
    for (int j = 0; j < part[k]->n; j++) term[m++] = part[k]->args[j];
  }
  if (m == 0) return pl_form_leaf(d->arena, pl_int(d->pool, 0));
  return m == 1 ? term[0] : pl_form_sum(d->arena, term, m);
}
