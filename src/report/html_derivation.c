// The derivation: lettered headings, sentences, numbered equations that can be linked to and
// copied, tables, and the steps that only answer "why?", closed until somebody asks.
#include "html_impl.h"

#include <math.h>
#include <string.h>

// a formula wider than this has its remark below it
enum { PL_HTML_DIGITS = 6, PL_HTML_ALONE = 56 };

// ---------------------------------------------------------------------------------------- headings
static bool same_text(const char* a, const char* b) {
  return a == b || (a && b && strcmp(a, b) == 0);
}

static bool wanted(const pl_html* h, int i) {
  return pl_worked_wanted(h->in->only, h->s->sections.at[i].letter);
}

static int before(const pl_html* h, int i) {
  for (int k = i - 1; k >= 0; k--)
    if (wanted(h, k)) return k;
  return -1;
}

// A section under the letter of the one before it opens no new block.
static bool joins(const pl_html* h, int i) {
  int k = before(h, i);
  if (k < 0) return false;
  const pl_section *a = &h->s->sections.at[k], *b = &h->s->sections.at[i];
  return b->continues || (b->letter && same_text(a->letter, b->letter));
}

int pl_html_head_of(const pl_html* h, int i) {
  while (joins(h, i)) i = before(h, i);
  return i;
}

const char* pl_html_part(const pl_html* h, int i) {
  return pl_format(h->arena, "part-%d", pl_html_head_of(h, i) + 1);
}

static void put_heading(pl_html* h, int i) {
  const pl_section* c = &h->s->sections.at[i];
  const char* title = pl_html_words(h, c->title);
  pl_html_rawf(h, "<h3 class=\"step\" id=\"%s\">", pl_html_part(h, i));
  if (c->letter) {
    pl_html_raw(h, "<span>");
    pl_html_text(h, c->letter);
    pl_html_raw(h, "</span>");
  }
  pl_html_text(h, *title ? title : c->item ? c->item : "");
  pl_html_raw(h, "</h3>\n");
}

// --------------------------------------------------------------------------------------- equations
// Does the formula end in what is the answer?
static bool is_result(const pl_section* c, const pl_form* f) {
  for (int i = 0; f && i < c->values.n; i++)
    if (c->values.at[i].form && pl_html_ends_in(f, c->values.at[i].form)) return true;
  return false;
}

static const char* value_of(const pl_html* h, const pl_step* s) {
  const char* name = s->value_name ? pl_format(h->arena, "%s ", s->value_name) : "";
  return pl_format(h->arena, "%s= %s", name,
                   pl_html_quantity(h, s->value, s->unit, PL_HTML_DIGITS));
}

static void put_beside(pl_html* h, const pl_step* s) {
  const char* after = pl_html_words(h, s->after);
  bool value = s->has_value && isfinite(s->value);
  if (!*after && !value) return;
  pl_html_raw(h, "<span class=\"after\">");
  pl_html_sentence(h, after, s->n_inserts, s->inserts);
  if (value) {
    pl_html_raw(h, *after ? " <b>" : "<b>");
    pl_html_text(h, value_of(h, s));
    pl_html_raw(h, "</b>");
  }
  pl_html_raw(h, "</span>");
}

static void put_equation(pl_html* h, const pl_section* c, const pl_step* s) {
  const char* words = pl_html_words(h, s->words);
  if (*words) {
    pl_html_raw(h, "<p>");
    pl_html_sentence(h, words, s->n_inserts, s->inserts);
    pl_html_raw(h, "</p>\n");
  }
  bool key = s->has_value || (s->number > 0 && is_result(c, s->formula));
  bool wide = s->formula && pl_html_cells(h, s->formula) > PL_HTML_ALONE
              && (s->has_value || *pl_html_words(h, s->after));
  pl_html_rawf(h, "<div class=\"eq%s%s\"", key ? " key" : "", wide ? " wide" : "");
  if (s->number > 0) pl_html_rawf(h, " id=\"eq-%d\"", s->number);
  pl_html_raw(h, "><div class=\"m\">");
  pl_html_display(h, s->formula);
  pl_html_raw(h, "</div>");
  put_beside(h, s);
  if (s->number > 0)
    pl_html_rawf(h, "<a class=\"no\" href=\"#eq-%d\">(%d)</a>", s->number, s->number);
  const char* copy = pl_html_say(h, PL_BOTH("Copy as LaTeX"));
  pl_html_rawf(h, "<button type=\"button\" class=\"cp\" aria-label=\"%s\">TeX</button></div>\n",
               copy);
}

// ------------------------------------------------------------------------------------------ tables
static void put_cell(pl_html* h, const char* class, const char* s) {
  pl_html_rawf(h, "<td%s>", class);
  pl_html_text(h, s);
  pl_html_raw(h, "</td>");
}

static void put_row(pl_html* h, const pl_step* s) {
  const char* label = pl_html_words(h, s->words);
  // a formula alone is no name of a row for a screen reader
  bool words = *label && *label != '{';
  pl_html_raw(h, words ? "<tr><th scope=\"row\">" : "<tr><td>");
  pl_html_sentence(h, label, s->n_inserts, s->inserts);
  pl_html_raw(h, words ? "</th><td>" : "</td><td>");
  if (s->formula) pl_html_inline(h, s->formula);
  pl_html_raw(h, "</td>");
  const char* value = s->has_value && isfinite(s->value) ? value_of(h, s)
                      : s->margin                        ? s->margin
                                                         : "";
  const char* shown = *value == '-' ? pl_format(h->arena, "−%s", value + 1) : value;
  put_cell(h, " class=\"r\"", shown);
  put_cell(h, "", pl_html_words(h, s->after));
  pl_html_raw(h, "</tr>\n");
}

static int run_of(const pl_section* c, int i, pl_step_kind kind, bool detail) {
  int n = 0;
  while (i + n < c->steps.n && c->steps.at[i + n].kind == kind
         && c->steps.at[i + n].detail == detail)
    n++;
  return n;
}

static int put_rows(pl_html* h, const pl_section* c, int i) {
  int n = run_of(c, i, PL_STEP_ROW, c->steps.at[i].detail);
  pl_html_raw(h, "<div class=\"scroll\"><table class=\"rows\">\n");
  for (int k = 0; k < n; k++) put_row(h, &c->steps.at[i + k]);
  pl_html_raw(h, "</table></div>\n");
  return n;
}

// ------------------------------------------------------------------------------------------- steps
static void put_words(pl_html* h, const char* open, const pl_step* s, const char* close) {
  pl_html_raw(h, open);
  pl_html_sentence(h, pl_html_words(h, s->words), s->n_inserts, s->inserts);
  pl_html_raw(h, close);
}

static void put_note(pl_html* h, const pl_step* s) {
  pl_html_rawf(h, "<p class=\"note\"><b>%s</b> ", pl_html_say(h, PL_BOTH("Note.")));
  put_words(h, "", s, "</p>\n");
}

static int put_step(pl_html* h, const pl_section* c, int i) {
  const pl_step* s = &c->steps.at[i];
  switch (s->kind) {
    case PL_STEP_TEXT: put_words(h, "<p>", s, "</p>\n"); return 1;
    case PL_STEP_NOTE: put_note(h, s); return 1;
    case PL_STEP_HEADING: put_words(h, "<h4>", s, "</h4>\n"); return 1;
    case PL_STEP_EQUATION: put_equation(h, c, s); return 1;
    case PL_STEP_ROW: return put_rows(h, c, i);
  }
  return 1;
}

// Steps that are only details stand in a box of their own.
static void put_steps(pl_html* h, const pl_section* c) {
  bool open = false;
  for (int i = 0; i < c->steps.n;) {
    bool detail = c->steps.at[i].detail;
    if (detail && !open) {
      pl_html_rawf(h, "<details><summary>%s</summary>\n", pl_html_say(h, PL_BOTH("Why?")));
    }
    if (!detail && open) pl_html_raw(h, "</details>\n");
    open = detail;
    i += put_step(h, c, i);
  }
  if (open) pl_html_raw(h, "</details>\n");
}

// ------------------------------------------------------------------------------------------- notes
static bool told_by_step(const pl_solution* s, const char* code) {
  for (int i = 0; i < s->sections.n; i++) {
    for (int k = 0; k < s->sections.at[i].steps.n; k++) {
      const pl_step* step = &s->sections.at[i].steps.at[k];
      bool note = step->kind == PL_STEP_NOTE && step->words[0];
      if (note && strncmp(step->words[0], code, strlen(code)) == 0) return true;
    }
  }
  return false;
}

static void put_notes(pl_html* h) {
  const pl_diagnostics* notes = h->in->notes;
  for (int i = 0; notes && i < notes->list.n; i++) {
    const pl_diagnostic* d = &notes->list.at[i];
    if (pl_code_severity(d->code) == PL_ERROR || told_by_step(h->s, pl_code_name(d->code)))
      continue;
    const char* reason = d->reason[h->lang];
    pl_html_rawf(h, "<p class=\"note\"><b>%s %s.</b> ", pl_html_say(h, PL_BOTH("Note")),
                 pl_code_name(d->code));
    pl_html_text(h, d->sentence[h->lang]);
    if (reason && *reason) {
      pl_html_raw(h, ". ");
      pl_html_text(h, reason);
    }
    pl_html_raw(h, "</p>\n");
  }
}

void pl_html_derivation(pl_html* h) {
  pl_html_rawf(h, "<section id=\"derivation\"><h2>%s</h2>\n",
               pl_html_say(h, PL_BOTH("Derivation")));
  for (int i = 0; i < h->s->sections.n; i++) {
    const pl_section* c = &h->s->sections.at[i];
    if (!wanted(h, i)) continue;
    int k = before(h, i);
    if (!joins(h, i)) put_heading(h, i);
    else if (!c->continues && *pl_html_words(h, c->title)
             && !same_text(h->s->sections.at[k].title[0], c->title[0])) {
      pl_html_raw(h, "<h4>");
      pl_html_text(h, pl_html_words(h, c->title));
      pl_html_raw(h, "</h4>\n");
    }
    put_steps(h, c);
  }
  put_notes(h);
  pl_html_raw(h, "</section>\n");
}
