// The worked solution as text: title, sections, notes, checks, what was assumed. Laid out as a
// solution sheet: letters at column 2, steps at column 5, equation numbers and values at the right
// margin.
#include "report_impl.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PL_COLUMN_TAIL = 10 };  // "  checks  units ..."

// A difference below this is the rounding of a check in high precision and tells the reader
// nothing.
static const double pl_worst_told = 1e-30;

static void pl_put_title(pl_page* g, const pl_model* m) {
  if (!m || !m->title || !*m->title) return;
  pl_page_ink(g, PL_INK_BOLD, pl_page_plain(g, m->title));
  pl_page_newline(g);
}

// ------------------------------------------------------------------------------------------- notes
bool pl_worked_told(const pl_solution* s, const char* code) {
  for (int i = 0; i < s->sections.n; i++) {
    for (int k = 0; k < s->sections.at[i].steps.n; k++) {
      const pl_step* step = &s->sections.at[i].steps.at[k];
      bool note = step->kind == PL_STEP_NOTE && step->words[0];
      if (note && strncmp(step->words[0], code, strlen(code)) == 0) return true;
    }
  }
  return false;
}

static void pl_put_notes(pl_page* g, const pl_solution* s, const pl_diagnostics* notes) {
  const char* const note[2] = {PL_BOTH("note")};
  pl_language lang = g->how.lang;
  for (int i = 0; notes && i < notes->list.n; i++) {
    const pl_diagnostic* d = &notes->list.at[i];
    const char* code = pl_code_name(d->code);
    if (pl_code_severity(d->code) != PL_NOTE || pl_worked_told(s, code)) continue;
    pl_page_blank(g);
    const char* reason = d->reason[lang] ? d->reason[lang] : "";
    const char* lead = pl_format(g->arena, "%s\x01%s: %s%s%s", note[lang], code,
                                 pl_page_words(g, d->sentence), *reason ? ". " : "",
                                 pl_page_plain(g, reason));
    pl_page_sentence(g, 2, 2, PL_INK_YELLOW, lead);
  }
}

// ------------------------------------------------------------------------------------------ checks
static const char* pl_check_text(pl_page* g, const pl_check* c) {
  const char* name = pl_page_words(g, c->name);
  if (c->starts > 0) name = pl_format(g->arena, "%s (%d)", name, c->formulas);
  if (!(c->worst > pl_worst_told)) return name;
  return pl_format(g->arena, "%s %s", name, pl_notation_number(g->arena, c->worst, 1, g->how));
}

static int pl_count_failed(const pl_solution* s) {
  int n = 0;
  for (int i = 0; i < s->checks.n; i++) n += !s->checks.at[i].passed;
  return n;
}

static void pl_put_label(pl_page* g, const char* label) {
  pl_text_pad(g->out, 2);
  pl_page_ink(g, PL_INK_DIM, label);
  pl_text_pad(g->out, PL_COLUMN_TAIL - 2 - pl_utf8_width(label));
}

// Items in a row with a separator, broken between items; ends with the column reached.
static int pl_put_items(pl_page* g, const char* const* item, int n, const char* separator) {
  int column = PL_COLUMN_TAIL;
  for (int i = 0; i < n; i++) {
    int width = pl_utf8_width(item[i]);
    bool wrap = i > 0 && g->wrap != INT_MAX && column + pl_utf8_width(separator) + width > g->wrap;
    if (i > 0) pl_text_add(g->out, wrap && separator[0] == ' ' ? "" : separator);
    if (wrap) {
      pl_page_newline(g);
      pl_text_pad(g->out, PL_COLUMN_TAIL);
      column = PL_COLUMN_TAIL;
    } else if (i > 0) column += pl_utf8_width(separator);
    pl_text_add(g->out, item[i]);
    column += width;
  }
  return column;
}

static void pl_put_verdict(pl_page* g, int column, const char* verdict, bool passed) {
  int width = pl_utf8_width(verdict);
  if (column + 2 + width > g->margin && g->wrap != INT_MAX) {
    pl_page_newline(g);
    column = 0;
  }
  int gap = g->margin - column - width;
  pl_text_pad(g->out, gap < 4 && column > 0 ? 4 : gap);
  pl_page_ink(g, passed ? PL_INK_BOLD : PL_INK_RED, verdict);
  pl_page_newline(g);
}

static void pl_put_failures(pl_page* g, const pl_solution* s) {
  const char* const words = pl_in_language(g->how.lang, PL_KEY("failed: %s%s%s"));
  const char* const on = pl_in_language(g->how.lang, PL_KEY(", at "));
  for (int i = 0; i < s->checks.n; i++) {
    const pl_check* c = &s->checks.at[i];
    if (c->passed) continue;
    const char* where = c->failed_on ? pl_page_plain(g, c->failed_on) : "";
    const char* line = pl_format(g->arena, words, pl_page_words(g, c->name), *where ? on : "",
                                 where);
    pl_page_sentence(g, PL_COLUMN_TAIL, PL_COLUMN_TAIL + 2, PL_INK_RED, line);
  }
}

static void pl_put_checks(pl_page* g, const pl_solution* s) {
  const char* const label[2] = {PL_BOTH("checks")};
  const char* const passed[2] = {PL_BOTH("all passed")};
  const char* const failed[2] = {PL_BOTH("%d failed")};
  if (s->checks.n == 0) return;
  const char** item = PL_ARRAY(g->arena, const char*, s->checks.n);
  for (int i = 0; i < s->checks.n; i++) item[i] = pl_check_text(g, &s->checks.at[i]);
  int n = pl_count_failed(s);
  pl_put_label(g, label[g->how.lang]);
  int column = pl_put_items(g, item, s->checks.n, g->how.math == PL_MATH_ASCII ? ", " : " · ");
  pl_put_verdict(g, column,
                 n == 0 ? passed[g->how.lang] : pl_format(g->arena, failed[g->how.lang], n),
                 n == 0);
  pl_put_failures(g, s);
}

static void pl_put_used(pl_page* g, const pl_solution* s) {
  const char* const label[2] = {PL_BOTH("used")};
  if (s->used.n == 0) return;
  const char** item = PL_ARRAY(g->arena, const char*, s->used.n);
  for (int i = 0; i < s->used.n; i++) item[i] = pl_page_plain(g, s->used.at[i]);
  pl_put_label(g, label[g->how.lang]);
  pl_put_items(g, item, s->used.n, ", ");
  pl_page_newline(g);
}

static void pl_put_motion(pl_page* g, const char* motion) {
  if (!motion || !*motion) return;
  pl_page_blank(g);
  pl_text_add(g->out, pl_page_plain(g, motion));
  g->blank = false;
}

void pl_worked_text(pl_text* out, const pl_solution* s, const pl_diagnostics* notes,
                    const pl_worked_style* style) {
  pl_page g = pl_page_make(out, s->model ? s->model->pool : NULL, style);
  pl_put_title(&g, s->model);
  pl_worked_sections(&g, s);
  pl_put_notes(&g, s, notes);
  pl_put_motion(&g, style->motion);
  if (s->checks.n + s->used.n > 0) pl_page_blank(&g);
  pl_put_checks(&g, s);
  pl_put_used(&g, s);
}
