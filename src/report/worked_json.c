// The JSON document, schema version 1. Keys stand in the order of the contract (docs/json.md);
// later versions add keys, never rename them. A wrong model, a contradiction and an answer have the
// same shape: what is missing is an empty list.
#include "report_impl.h"

#include <math.h>
#include <string.h>

enum { PL_JSON_VERSION = 1, PL_DISPLAY_DIGITS = 6 };

// Operators of one formula: beyond it nobody reads it, and a reader of the document would choke on
// it.
static const long pl_max_formula = 50000;

typedef struct pl_document {
  pl_json j;
  pl_arena* arena;
  pl_pool* pool;  // NULL without a model
  const pl_json_input* in;
} pl_document;

const char* pl_status_word(pleuel_status s) {
  switch (s) {
    case PLEUEL_OK: return "ok";
    case PLEUEL_EXPECT_FAILED: return "expect_failed";
    case PLEUEL_USAGE: return "usage";
    case PLEUEL_MODEL_ERROR: return "model_error";
    case PLEUEL_CONTRADICTION: return "contradiction";
    case PLEUEL_NO_CLOSED_FORM: return "no_closed_form";
    case PLEUEL_NUMERICAL: return "numerical";
    case PLEUEL_SINGULAR: return "singular";
    case PLEUEL_FILE: return "file";
    case PLEUEL_INTERRUPTED: return "interrupted";
    case PLEUEL_NO_MEMORY: return "no_memory";
    case PLEUEL_UNSUPPORTED: return "unsupported";
  }
  return "unknown";
}

// ---------------------------------------------------------------------------------------- printing
static const char* pl_doc_expr(pl_document* d, pl_expr e) {
  if (pl_is_poison(e) || !d->pool) return NULL;
  long n = pl_op_count(d->pool, e);
  if (n > pl_max_formula) return pl_format(d->arena, "<an expression of %ld operators>", n);
  return pl_expr_text(d->arena, d->pool, pl_without_measures(d->pool, e));
}

static const char* pl_doc_form(pl_document* d, const pl_form* f, pl_math math) {
  if (!f || !d->pool) return NULL;
  long n = pl_form_ops(f);
  if (n > pl_max_formula) return pl_format(d->arena, "…");
  return pl_notation_print(d->arena, d->pool, f, (pl_notation){math, d->in->lang});
}

static void pl_doc_optional(pl_document* d, const char* key, const char* s) {
  if (s) pl_json_string(&d->j, key, s);
}

static void pl_doc_expr_key(pl_document* d, const char* key, pl_expr e) {
  pl_doc_optional(d, key, pl_doc_expr(d, e));
}

static const char* pl_doc_words(const pl_document* d, const char* const words[2]) {
  return words[d->in->lang] ? words[d->in->lang] : words[PL_ENGLISH];
}

static void pl_doc_strings(pl_document* d, const char* key, const char* const* s, int n) {
  pl_json_list(&d->j, key);
  pl_json_flat(&d->j);
  for (int i = 0; i < n; i++) pl_json_string(&d->j, NULL, s[i]);
  pl_json_end_list(&d->j);
}

// --------------------------------------------------------------------------------------- the model
static void pl_doc_coords(pl_document* d) {
  pl_json_list(&d->j, "coords");
  pl_json_flat(&d->j);
  if (d->in->model) {
    pl_flat_coords c = pl_model_flat_coords(d->in->model, d->arena);
    for (int i = 0; i < c.n; i++) pl_json_string(&d->j, NULL, pl_doc_expr(d, c.at[i]));
  }
  pl_json_end_list(&d->j);
}

static void pl_doc_parameters(pl_document* d) {
  const pl_model* m = d->in->model;
  pl_json_object(&d->j, "parameters");
  const double* value = m ? pl_model_values(m, d->arena) : NULL;
  for (int i = 0; m && i < m->params.n; i++) {
    const pl_param* p = &m->params.at[i];
    if (p->literal) continue;
    const pl_symbol_info* s = pl_symbol_get(m->pool, p->symbol);
    pl_json_object(&d->j, s->ascii);
    pl_json_flat(&d->j);
    pl_json_number(&d->j, "number", value[p->symbol.id]);
    pl_json_string(&d->j, "unit",
                   s->dimension_known
                       ? pl_unit_of_symbol(d->arena, m->pool, p->symbol, s->dimension, true)
                       : NULL);
    pl_json_end_object(&d->j);
  }
  pl_json_end_object(&d->j);
}

static void pl_doc_constraint(pl_document* d, const pl_constraint_info* c) {
  pl_json_object(&d->j, NULL);
  pl_json_string(&d->j, "label", c->label);
  pl_json_string(&d->j, "text", c->text);
  pl_json_string(&d->j, "kind", c->nonholonomic ? "nonholonomic" : "holonomic");
  pl_json_string(&d->j, "sided", c->one_sided ? "one" : "two");
  pl_json_bool(&d->j, "rheonomic", c->rheonomic);
  pl_json_bool(&d->j, "dropped", c->dropped);
  if (c->open) pl_json_bool(&d->j, "open", true);
  pl_doc_strings(d, "implied_by", c->implied_by, c->n_implied_by);
  pl_json_end_object(&d->j);
}

// A constraint of which only the text is known: the derivation did not get as far.
static void pl_doc_plain_constraint(pl_document* d, const pl_constraint* c) {
  static const char* const sign[] = {"=", ">=", "<=", ">", "<", "!="};
  const char* left = pl_doc_expr(d, c->left);
  const char* right = pl_doc_expr(d, c->right);
  pl_json_object(&d->j, NULL);
  pl_json_string(&d->j, "label", c->name.ascii);
  pl_json_string(
      &d->j, "text",
      left && right ? pl_format(d->arena, "%s %s %s", left, sign[c->relation], right) : NULL);
  pl_json_string(&d->j, "sided", c->relation == PL_EQ ? "two" : "one");
  pl_json_end_object(&d->j);
}

static void pl_doc_constraints(pl_document* d) {
  const pl_solution* s = d->in->solution;
  const pl_model* m = d->in->model;
  pl_json_list(&d->j, "constraints");
  for (int i = 0; s && i < s->constraints.n; i++) pl_doc_constraint(d, &s->constraints.at[i]);
  for (int i = 0; !s && m && i < m->constraints.n; i++)
    pl_doc_plain_constraint(d, &m->constraints.at[i]);
  pl_json_end_list(&d->j);
}

static void pl_doc_dof(pl_document* d) {
  const pl_solution* s = d->in->solution;
  if (!s) {
    pl_json_null(&d->j, "dof");
    return;
  }
  pl_json_object(&d->j, "dof");
  pl_json_flat(&d->j);
  pl_json_int(&d->j, "coordinates", s->dof.coordinates);
  pl_json_int(&d->j, "constraints", s->dof.constraints);
  if (s->dof.open > 0) pl_json_int(&d->j, "open", s->dof.open);
  pl_json_int(&d->j, "rank", s->dof.rank);
  pl_json_int(&d->j, "dof", s->dof.dof);
  pl_json_int(&d->j, "velocity_dof", s->dof.velocity_dof);
  pl_json_list(&d->j, "hidden");
  for (int k = 0; k < s->hidden.n; k++) {
    pl_json_object(&d->j, NULL);
    pl_json_string(&d->j, "expr", pl_expr_text(d->arena, s->model->pool, s->hidden.at[k]));
    pl_json_end_object(&d->j);
  }
  pl_json_end_list(&d->j);
  pl_json_end_object(&d->j);
}

// ------------------------------------------------------------------------------------------- steps
// A sentence with its formulas in place; in TeX they stand between dollar signs.
static const char* pl_doc_fill(pl_document* d, const char* words, const pl_step* s, pl_math math) {
  pl_text out = pl_text_make(d->arena);
  const char* quote = math == PL_MATH_TEX ? "$" : "";
  for (const char* c = words; c && *c; c++) {
    int k = *c == '{' && c[1] >= '1' && c[1] <= '9' && c[2] == '}' ? c[1] - '0' : 0;
    if (!k) {
      pl_text_add_n(&out, c, 1);
      continue;
    }
    const char* f = k <= s->n_inserts ? pl_doc_form(d, s->inserts[k - 1], math) : NULL;
    if (f) pl_text_addf(&out, "%s%s%s", quote, f, quote);
    c += 2;
  }
  return pl_text_string(&out);
}

// Words, formula, margin and words after it, as far as they are there, with two blanks between
// them.
static const char* pl_doc_step(pl_document* d, const pl_step* s, pl_math math) {
  const char* formula = pl_doc_form(d, s->formula, math);
  if (formula && math == PL_MATH_TEX) formula = pl_format(d->arena, "$%s$", formula);
  const char* part[] = {pl_doc_fill(d, pl_doc_words(d, s->words), s, math), formula, s->margin,
                        pl_doc_words(d, s->after)};
  pl_text out = pl_text_make(d->arena);
  for (int i = 0; i < 4; i++) {
    if (!part[i] || !*part[i]) continue;
    if (out.n) pl_text_add(&out, "  ");
    pl_text_add(&out, part[i]);
  }
  return pl_text_string(&out);
}

const char* pl_worked_step(pl_arena* a, pl_pool* pool, const pl_step* s, pl_language lang,
                           pl_math math) {
  pl_json_input in = {.lang = lang};
  pl_document d = {.arena = a, .pool = pool, .in = &in};
  return pl_doc_step(&d, s, math);
}

static void pl_doc_one_step(pl_document* d, const pl_step* s) {
  static const char* const kind[] = {"text", "equation", "row", "heading", "note"};
  const char* words = pl_doc_words(d, s->words);
  bool equation = s->kind == PL_STEP_EQUATION && s->formula && (!words || !*words);
  pl_json_object(&d->j, NULL);
  pl_json_string(
      &d->j, "text",
      equation ? pl_doc_form(d, s->formula, PL_MATH_LINE) : pl_doc_step(d, s, PL_MATH_LINE));
  pl_json_string(
      &d->j, "tex",
      equation ? pl_doc_form(d, s->formula, PL_MATH_TEX) : pl_doc_step(d, s, PL_MATH_TEX));
  pl_json_list(&d->j, "refs");
  pl_json_flat(&d->j);
  for (int i = 0; i < s->n_refs && i < 4; i++) pl_json_int(&d->j, NULL, s->refs[i]);
  pl_json_end_list(&d->j);
  pl_json_string(&d->j, "kind", kind[s->kind]);
  if (s->number > 0) pl_json_int(&d->j, "number", s->number);
  if (equation) pl_doc_optional(d, "after", pl_doc_words(d, s->after));
  if (s->detail) pl_json_bool(&d->j, "detail", true);
  pl_json_end_object(&d->j);
}

// ------------------------------------------------------------------------------------------ values
static void pl_doc_components(pl_document* d, const pl_value* v) {
  if (v->n_components == 0) return;
  pl_json_list(&d->j, "components");
  for (int i = 0; i < v->n_components; i++) {
    const pl_component* c = &v->components[i];
    pl_json_object(&d->j, NULL);
    pl_json_string(&d->j, "along", c->along ? pl_ascii_of(d->arena, c->along) : NULL);
    pl_doc_expr_key(d, "expr", c->expr);
    pl_doc_optional(d, "text", pl_doc_form(d, c->form, PL_MATH_LINE));
    pl_doc_optional(d, "tex", pl_doc_form(d, c->form, PL_MATH_TEX));
    pl_json_number(&d->j, "number", c->number);
    pl_json_end_object(&d->j);
  }
  pl_json_end_list(&d->j);
}

// Abbreviations of the model that occur in the formulas of a value, in order of use.
static bool pl_doc_has(pl_document* d, const pl_value* v, pl_symbol s) {
  bool has = pl_has_symbol(d->pool, v->expr, s) || pl_has_symbol(d->pool, v->lhs, s)
             || pl_has_symbol(d->pool, v->got, s);
  for (int i = 0; i < v->n_components; i++)
    has = has || pl_has_symbol(d->pool, v->components[i].expr, s);
  for (int i = 0; i < v->n_where; i++) has = has || pl_has_symbol(d->pool, v->where_expr[i], s);
  return has;
}

// Marks the lets that a value needs; a let may speak of those before it.  Returns how many.
static int pl_doc_lets(pl_document* d, const pl_model* m, const pl_value* v, bool* needed) {
  int n = 0;
  for (int k = m->lets.n - 1; k >= 0; k--) {
    const pl_let* l = &m->lets.at[k];
    if (l->inserted || l->n_args > 0 || l->symbol.id == 0) continue;
    needed[k] = pl_doc_has(d, v, l->symbol);
    for (int i = k + 1; i < m->lets.n; i++)
      needed[k] = needed[k]
                  || (needed[i] && pl_has_symbol(d->pool, m->lets.at[i].value, l->symbol));
    n += needed[k];
  }
  return n;
}

static void pl_doc_where(pl_document* d, const pl_value* v) {
  const pl_model* m = d->in->solution->model;
  bool* needed = PL_ARRAY(d->arena, bool, m->lets.n + 1);
  if (pl_doc_lets(d, m, v, needed) + v->n_where == 0) return;
  pl_json_object(&d->j, "where");
  for (int k = 0; k < m->lets.n; k++) {
    if (needed[k])
      pl_json_string(&d->j, pl_symbol_get(d->pool, m->lets.at[k].symbol)->ascii,
                     pl_doc_expr(d, m->lets.at[k].value));
  }
  for (int i = 0; i < v->n_where; i++)
    pl_json_string(&d->j, v->where_name[i], pl_doc_expr(d, v->where_expr[i]));
  pl_json_end_object(&d->j);
}

// The display of a number that derive left to us: "-23.544 N", "48.1897 deg".
static const char* pl_doc_display(pl_document* d, const pl_value* v) {
  if (v->display || !isfinite(v->number)) return v->display;
  bool angle = v->unit && strcmp(v->unit, "rad") == 0,
       bare = !v->unit || !*v->unit || strcmp(v->unit, "1") == 0;
  pl_notation how = {PL_MATH_ASCII, PL_ENGLISH};
  const char* number = pl_notation_number(d->arena, angle ? v->number * 180 / acos(-1) : v->number,
                                          PL_DISPLAY_DIGITS, how);
  return bare ? number : pl_format(d->arena, "%s %s", number, angle ? "deg" : v->unit);
}

static const pl_form* pl_doc_shown(pl_document* d, const pl_value* v) {
  if (!v->form || !v->lhs_form) return v->form;
  return pl_form_relation(d->arena, v->lhs_form, "=", v->form);
}

// How an answer is written: text, TeX and MathML.
static void pl_doc_spellings(pl_document* d, const pl_value* v) {
  const pl_form* f = pl_doc_shown(d, v);
  pl_doc_optional(d, "text", pl_doc_form(d, f, PL_MATH_LINE));
  pl_doc_optional(d, "tex", pl_doc_form(d, f, PL_MATH_TEX));
  const char* mathml = pl_doc_form(d, f, PL_MATH_MATHML);
  if (!mathml) return;
  bool wrapped = strncmp(mathml, "<math", 5) == 0;
  pl_json_string(&d->j, "mathml",
                 wrapped ? mathml : pl_format(d->arena, "<math>%s</math>", mathml));
}

// What is said about an answer besides its formula.
static void pl_doc_claims(pl_document* d, const pl_value* v) {
  pl_doc_optional(d, "stability", v->stability);
  pl_doc_optional(d, "exists_if", v->exists_if);
  pl_doc_optional(d, "stable_if", v->stable_if);
  if (v->stability || v->n_free) pl_doc_strings(d, "free", v->free_names, v->n_free);
  if (v->conserved >= 0) pl_json_bool(&d->j, "conserved", v->conserved == 1);
  pl_doc_optional(d, "because", pl_doc_words(d, v->because));
  if (v->passed >= 0) pl_json_bool(&d->j, "passed", v->passed == 1);
  pl_doc_expr_key(d, "got", v->got);
  if (v->order >= 0) pl_json_int(&d->j, "order", v->order);
}

static void pl_doc_value(pl_document* d, const pl_value* v) {
  pl_json_object(&d->j, NULL);
  pl_json_string(&d->j, "name", v->name);
  pl_doc_optional(d, "of", v->of);
  pl_doc_optional(d, "on", v->on);
  pl_doc_optional(d, "at", v->at);
  pl_doc_optional(d, "branch", v->branch);
  pl_doc_expr_key(d, "lhs", v->lhs);
  if (v->withdrawn) pl_json_null(&d->j, "expr");
  else pl_doc_expr_key(d, "expr", v->expr);
  pl_doc_where(d, v);
  pl_doc_components(d, v);
  pl_doc_spellings(d, v);
  pl_json_number(&d->j, "number", v->number);
  pl_json_string(&d->j, "unit", v->unit);
  pl_json_string(&d->j, "display", pl_doc_display(d, v));
  pl_doc_claims(d, v);
  pl_doc_strings(d, "assuming", v->assuming, v->n_assuming);
  if (v->withdrawn) pl_json_bool(&d->j, "withdrawn", true);
  pl_json_end_object(&d->j);
}

static void pl_doc_section(pl_document* d, const pl_section* s) {
  pl_json_object(&d->j, NULL);
  pl_json_string(&d->j, "item", s->item);
  if (s->stage > 0) pl_json_int(&d->j, "stage", s->stage + 1);
  pl_json_list(&d->j, "steps");
  for (int i = 0; i < s->steps.n; i++) pl_doc_one_step(d, &s->steps.at[i]);
  pl_json_end_list(&d->j);
  pl_json_list(&d->j, "values");
  for (int i = 0; i < s->values.n; i++) pl_doc_value(d, &s->values.at[i]);
  pl_json_end_list(&d->j);
  if (s->not_found) pl_json_bool(&d->j, "not_found", true);
  pl_json_end_object(&d->j);
}

// The key of each section: its letter, or a running number without one.
static const char** pl_doc_keys(pl_document* d, const pl_solution* s) {
  const char** key = PL_ARRAY(d->arena, const char*, s->sections.n);
  int running = 0;
  for (int i = 0; i < s->sections.n; i++) {
    const char* letter = s->sections.at[i].letter;
    key[i] = letter ? letter : pl_format(d->arena, "%d", ++running);
  }
  return key;
}

// Requests under one letter make one list, wherever they stand in the file.
static void pl_doc_answers(pl_document* d) {
  const pl_solution* s = d->in->solution;
  pl_json_object(&d->j, "answers");
  const char** key = s ? pl_doc_keys(d, s) : NULL;
  for (int i = 0; s && i < s->sections.n; i++) {
    if (!key[i] || !pl_worked_wanted(d->in->only, s->sections.at[i].letter)) continue;
    const char* here = key[i];
    pl_json_list(&d->j, here);
    for (int k = i; k < s->sections.n; k++) {
      if (!key[k] || strcmp(key[k], here) != 0) continue;
      pl_doc_section(d, &s->sections.at[k]);
      key[k] = NULL;
    }
    pl_json_end_list(&d->j);
  }
  pl_json_end_object(&d->j);
}

// ----------------------------------------------------------------------------------- checks, notes
static void pl_doc_checks(pl_document* d) {
  const pl_solution* s = d->in->solution;
  pl_json_list(&d->j, "checks");
  for (int i = 0; s && i < s->checks.n; i++) {
    const pl_check* c = &s->checks.at[i];
    pl_json_object(&d->j, NULL);
    pl_json_string(&d->j, "name", c->name[PL_ENGLISH]);
    pl_json_bool(&d->j, "passed", c->passed);
    pl_json_number(&d->j, "worst", c->worst);
    pl_json_int(&d->j, "points", c->points);
    pl_json_int(&d->j, "formulas", c->formulas);
    if (c->starts > 0) pl_json_int(&d->j, "starts", c->starts);
    pl_doc_optional(d, "failed_on", c->failed_on);
    pl_json_end_object(&d->j);
  }
  pl_json_end_list(&d->j);
}

// A place: lines and columns in cells, bytes, UTF-16 units.
static void pl_doc_place(pl_document* d, pl_span span) {
  pl_place place = pl_span_place(span);
  pl_place last = pl_span_place((pl_span){span.source, span.end, span.end});
  pl_json_int(&d->j, "line", place.line);
  pl_json_int(&d->j, "col", place.column);
  pl_json_int(&d->j, "end_line", last.line);
  pl_json_int(&d->j, "end_col", last.column);
  pl_json_string(&d->j, "file", span.source->name);
  pl_json_int(&d->j, "begin", (long)span.begin);
  pl_json_int(&d->j, "end", (long)span.end);
  pl_json_int(&d->j, "begin16", (long)pl_source_position(span.source, span.begin).at16);
  pl_json_int(&d->j, "end16", (long)pl_source_position(span.source, span.end).at16);
}

static void pl_doc_labels(pl_document* d, const pl_diagnostic* m) {
  if (m->labels.n == 0) return;
  pl_json_list(&d->j, "labels");
  for (int i = 0; i < m->labels.n; i++) {
    pl_json_object(&d->j, NULL);
    pl_json_flat(&d->j);
    pl_doc_place(d, m->labels.at[i].span);
    pl_json_string(&d->j, "text", m->labels.at[i].text);
    pl_json_end_object(&d->j);
  }
  pl_json_end_list(&d->j);
}

// The fix as an edit.
static void pl_doc_edits(pl_document* d, const pl_diagnostic* m) {
  pl_span span = pl_diagnostic_fix_span(m);
  if (!m->replacement || !span.source) return;
  pl_json_list(&d->j, "edits");
  pl_json_object(&d->j, NULL);
  pl_json_flat(&d->j);
  pl_doc_place(d, span);
  pl_json_string(&d->j, "text", m->replacement);
  pl_json_end_object(&d->j);
  pl_json_end_list(&d->j);
}

static void pl_doc_note(pl_document* d, const pl_diagnostic* m) {
  static const char* const severity[] = {"error", "warning", "note"};
  pl_json_object(&d->j, NULL);
  pl_json_string(&d->j, "code", pl_code_name(m->code));
  pl_json_string(&d->j, "severity", severity[pl_code_severity(m->code)]);
  if (m->span.source) {
    pl_doc_place(d, m->span);
  } else {
    pl_json_null(&d->j, "line");
    pl_json_null(&d->j, "col");
  }
  pl_json_string(&d->j, "text", pl_doc_words(d, m->sentence));
  pl_json_string(&d->j, "fix", pl_doc_words(d, m->fix));
  pl_doc_optional(d, "reason", pl_doc_words(d, m->reason));
  pl_doc_optional(d, "replacement", m->replacement);
  pl_doc_labels(d, m);
  pl_doc_edits(d, m);
  pl_json_end_object(&d->j);
}

static void pl_doc_notes(pl_document* d) {
  const pl_diagnostics* list = d->in->diagnostics;
  pl_json_list(&d->j, "notes");
  for (int i = 0; list && i < list->list.n; i++) pl_doc_note(d, &list->list.at[i]);
  pl_json_end_list(&d->j);
}

// Stages of the derivation in processor time, which other work on the machine does not lengthen.
static void pl_doc_derive_timing(pl_document* d) {
  static const char* const name[PL_N_DERIVE_STAGES] = {"cpu_equations", "cpu_solution",
                                                       "cpu_presentation", "cpu_certificates"};
  const pl_solution* s = d->in->solution;
  for (int i = 0; s && i < PL_N_DERIVE_STAGES; i++) pl_json_number(&d->j, name[i], s->cpu_ms[i]);
  if (s && s->cpu_ms_first > 0) pl_json_number(&d->j, "cpu_first_form", s->cpu_ms_first);
}

static void pl_doc_timing(pl_document* d) {
  pl_json_object(&d->j, "timing_ms");
  pl_json_flat(&d->j);
  for (int i = 0; i < d->in->n_timing; i++)
    pl_json_number(&d->j, d->in->timing_name[i], d->in->timing_ms[i]);
  if (d->in->n_timing > 0) pl_doc_derive_timing(d);
  pl_json_end_object(&d->j);
}

void pl_worked_json(pl_text* out, const pl_json_input* in) {
  const pl_solution* s = in->solution;
  pl_document d = {pl_json_make(out), out->arena, in->model ? in->model->pool : NULL, in};
  pl_json_object(&d.j, NULL);
  pl_json_int(&d.j, "pleuel", PL_JSON_VERSION);
  pl_json_string(&d.j, "file", in->file);
  pl_json_string(&d.j, "system", in->model ? in->model->title : NULL);
  pl_doc_coords(&d);
  pl_doc_parameters(&d);
  // the derivation may have gone on with an expanded copy
  if (s && s->model) d.pool = s->model->pool;
  pl_doc_constraints(&d);
  pl_doc_dof(&d);
  pl_doc_answers(&d);
  pl_doc_checks(&d);
  pl_doc_strings(&d, "assumptions", s ? s->used.at : NULL, s ? s->used.n : 0);
  pl_doc_notes(&d);
  pl_json_string(&d.j, "status", pl_status_word(in->status));
  if (in->message && *in->message) pl_json_string(&d.j, "message", in->message);
  if (in->simulation) pl_json_raw(&d.j, "simulation", in->simulation);
  pl_doc_timing(&d);
  pl_json_end_object(&d.j);
  pl_text_add(out, "\n");
}
