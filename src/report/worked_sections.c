// The lettered sections of the worked solution. Sections that belong under one heading are first
// laid in a row of steps; then runs of equations and runs of table rows are set together, so that
// their columns meet.
#include "report_impl.h"

#include <limits.h>
#include <math.h>
#include <string.h>

enum {
  PL_COLUMN_HEADING = 2,  // "  b) Degrees of freedom"
  PL_COLUMN_STEP = 5,     // everything below it
  PL_COLUMN_REMARK = 7,   // words that did not fit beside their formula
  PL_LABEL_WIDTH = 15,    // first column of tables, at least
  PL_GAP = 3,             // between a formula and the words after it
  PL_DIGITS = 6           // significant digits of numbers at the margin
};

typedef struct pl_stretch {  // the steps under one heading
  PL_VEC(const pl_step*) steps;
  PL_VEC(const pl_form*) results;  // displayed answers: bold
} pl_stretch;

bool pl_worked_wanted(const char* only, const char* letter) {
  if (!only || !*only) return true;
  if (!letter) return false;
  size_t n = strlen(letter);
  for (const char* s = only; *s;) {
    size_t k = strcspn(s, ", ");
    if (k == n && strncmp(s, letter, n) == 0) return true;
    s += k;
    s += strspn(s, ", ");
  }
  return false;
}

// ----------------------------------------------------------------------------- formulas and margin
static bool pl_is_result(const pl_stretch* b, const pl_form* f) {
  for (int i = 0; f && i < b->results.n; i++) {
    if (f == b->results.at[i]) return true;
    if (f->kind == PL_F_RELATION && f->args[1] == b->results.at[i]) return true;
  }
  return false;
}

// Room for a formula that begins at `column`.
static int pl_room(const pl_page* g, int column) {
  if (g->wrap == INT_MAX) return INT_MAX;
  return g->margin - column > 1 ? g->margin - column : 1;
}

// The rest of a line: blanks up to the margin, then `right`.
static void pl_put_margin(pl_page* g, int column, pl_ink ink, const char* right) {
  if (!*right) return;
  int gap = g->margin - column - pl_utf8_width(right);
  pl_text_pad(g->out, gap < 2 ? 2 : gap);
  pl_page_ink(g, ink, right);
}

// The value of a step in SI, as displayed: angles in degrees.
static const char* pl_step_value(pl_page* g, const pl_step* s) {
  bool angle = s->unit && (strcmp(s->unit, "rad") == 0 || strcmp(s->unit, "°") == 0);
  double x = s->unit && strcmp(s->unit, "rad") == 0 ? s->value * 180 / acos(-1) : s->value;
  const char* number = pl_notation_number(g->arena, x, PL_DIGITS, g->how);
  bool bare = !s->unit || !*s->unit || strcmp(s->unit, "1") == 0;
  const char* unit = bare ? "" : angle ? "°" : pl_format(g->arena, " %s", s->unit);
  const char* name = s->value_name ? pl_format(g->arena, "%s ", s->value_name) : "";
  return pl_page_plain(g, pl_format(g->arena, "%s= %s%s", name, number, unit));
}

// --------------------------------------------------------------------------------------- equations
static const char* pl_number_text_of(pl_page* g, const pl_step* s) {
  return s->number > 0 ? pl_format(g->arena, "(%d)", s->number) : "";
}

static bool pl_has_after(pl_page* g, const pl_step* s) { return *pl_page_words(g, s->after) != 0; }

// Words after a formula stand at `after_column` on its line, or below it when they do not fit.
static void pl_put_equation(pl_page* g, const pl_stretch* b, const pl_step* s, pl_lines f,
                            int after_column) {
  const char* after = pl_page_words(g, s->after);
  const char* number = pl_number_text_of(g, s);
  int reserve = *number ? pl_utf8_width(number) + 2 : 0;
  bool fits = after_column + pl_utf8_width(after) + reserve <= g->margin;
  bool beside = *after && (fits || g->wrap == INT_MAX);
  pl_ink ink = s->has_value || pl_is_result(b, s->formula) ? PL_INK_BOLD : PL_INK_PLAIN;
  for (int i = 0; i < f.n; i++) {
    pl_text_pad(g->out, PL_COLUMN_STEP);
    pl_page_ink(g, ink, f.at[i]);
    int column = PL_COLUMN_STEP + pl_utf8_width(f.at[i]);
    if (i == f.base && beside) {
      pl_text_pad(g->out, after_column - column);
      pl_page_ink(g, PL_INK_PLAIN, after);
      column = after_column + pl_utf8_width(after);
    }
    if (i == f.base) pl_put_margin(g, column, PL_INK_DIM, number);
    pl_page_newline(g);
  }
  if (*after && !beside)
    pl_page_sentence(g, PL_COLUMN_REMARK, PL_COLUMN_REMARK, PL_INK_PLAIN, after);
  if (s->has_value && isfinite(s->value)) {
    pl_put_margin(g, 0, PL_INK_BOLD, pl_step_value(g, s));
    pl_page_newline(g);
  }
}

// Words in front of an equation, when it has some, are a sentence of their own.
static void pl_put_lead(pl_page* g, const pl_step* s) {
  const char* words = pl_page_words(g, s->words);
  if (!*words) return;
  const char* full = pl_page_fill(g, words, s->n_inserts, s->inserts);
  pl_page_sentence(g, PL_COLUMN_STEP, PL_COLUMN_STEP, PL_INK_PLAIN, full);
}

// n equations that follow each other; the words after them begin in one column where that is
// possible.
static void pl_put_equations(pl_page* g, const pl_stretch* b, const pl_step* const* s, int n) {
  pl_lines* f = PL_ARRAY(g->arena, pl_lines, n);
  int after_column = 0;
  bool drawn = g->how.math == PL_MATH_2D;
  for (int i = 0; i < n; i++) {
    f[i] = pl_page_formula(g, s[i]->formula, pl_room(g, PL_COLUMN_STEP),
                           pl_utf8_width(pl_number_text_of(g, s[i])));
    int end = PL_COLUMN_STEP + f[i].width + PL_GAP;
    bool fits = end + pl_utf8_width(pl_page_words(g, s[i]->after)) <= g->margin;
    if (pl_has_after(g, s[i]) && fits && end > after_column) after_column = end;
  }
  for (int i = 0; i < n; i++) {
    int end = PL_COLUMN_STEP + f[i].width + PL_GAP;
    if (drawn && i > 0 && (f[i].n > 1 || f[i - 1].n > 1)) pl_page_blank(g);
    pl_put_lead(g, s[i]);
    int common = after_column + pl_utf8_width(pl_page_words(g, s[i]->after)) <= g->margin
                     ? after_column
                     : end;
    pl_put_equation(g, b, s[i], f[i], common > end ? common : end);
  }
}

// ------------------------------------------------------------------------------------------ tables
static const char* pl_row_label(pl_page* g, const pl_step* s) {
  const char* words = pl_page_fill(g, pl_page_words(g, s->words), s->n_inserts, s->inserts);
  char* label = pl_copy(g->arena, words);
  for (char* c = label; *c; c++)
    if (*c == '\x01') *c = ' ';
  return label;
}

static int pl_label_width(pl_page* g, const pl_step* const* s, int n) {
  int width = 0;
  for (int i = 0; i < n && s[i]->kind != PL_STEP_HEADING; i++) {
    int w = s[i]->kind == PL_STEP_ROW && s[i]->formula ? pl_utf8_width(pl_row_label(g, s[i])) : 0;
    if (w > width) width = w;
  }
  return width == 0 ? 0 : width + PL_GAP < PL_LABEL_WIDTH ? PL_LABEL_WIDTH : width + PL_GAP;
}

static void pl_put_row(pl_page* g, const pl_stretch* b, const pl_step* s, int label_width) {
  const char* label = pl_row_label(g, s);
  const char* right = pl_page_plain(g, s->margin);
  const char* after = pl_page_words(g, s->after);
  int column = PL_COLUMN_STEP + (s->formula ? label_width : 0);
  if (PL_COLUMN_STEP + pl_utf8_width(label) > column)
    column = PL_COLUMN_STEP + pl_utf8_width(label) + (s->formula ? 1 : 0);
  pl_lines f = pl_page_formula(g, s->formula, pl_room(g, column), pl_utf8_width(right));
  pl_ink ink = pl_is_result(b, s->formula) ? PL_INK_BOLD : PL_INK_PLAIN;
  bool beside = g->wrap == INT_MAX || column + f.width + PL_GAP + pl_utf8_width(after) <= g->wrap;
  for (int i = 0; i < f.n; i++) {
    // the label stands on the base line of a drawing, on the first line of a formula that was
    // broken
    bool label_here = i == (g->how.math == PL_MATH_2D ? f.base : 0);
    pl_text_pad(g->out, PL_COLUMN_STEP);
    pl_page_ink(g, PL_INK_DIM, label_here ? label : "");
    int at = PL_COLUMN_STEP + (label_here ? pl_utf8_width(label) : 0);
    if (*f.at[i]) {
      pl_text_pad(g->out, column - at);
      pl_page_ink(g, ink, f.at[i]);
      at = column + pl_utf8_width(f.at[i]);
    }
    if (i == f.base && *right) {
      pl_put_margin(g, at, PL_INK_PLAIN, right);
      at = g->margin;
    }
    if (i == f.base && *after && (beside || *right))
      pl_page_ink(g, PL_INK_PLAIN, pl_format(g->arena, "   %s", after));
    pl_page_newline(g);
  }
  if (*after && !beside && !*right) pl_page_sentence(g, column, column, PL_INK_PLAIN, after);
}

// --------------------------------------------------------------------------------------- sentences
// A formula that ends a sentence goes on lines of its own when it is tall, or too wide to stand
// beside the words.
static const pl_form* pl_long_ending(pl_page* g, const pl_step* s, const char* words) {
  size_t n = strlen(words);
  if (n < 3 || s->n_inserts == 0 || s->n_inserts > 9) return NULL;
  const char* last = pl_format(g->arena, "{%d}", s->n_inserts);
  if (strcmp(words + n - 3, last) != 0) return NULL;
  const pl_form* f = s->inserts[s->n_inserts - 1];
  if (!f) return NULL;
  pl_lines lines = pl_page_formula(g, f, INT_MAX, 0);
  bool wide = g->wrap != INT_MAX && lines.width > g->margin / 2
              && pl_utf8_width(pl_page_fill(g, words, s->n_inserts, s->inserts))
                     > g->wrap - PL_COLUMN_STEP;
  return wide || lines.n > 1 ? f : NULL;
}

static void pl_put_ending_below(pl_page* g, const pl_step* s, const char* words, const pl_form* f) {
  const char* before = pl_copy_n(g->arena, words, strlen(words) - 3);
  pl_page_sentence(g, PL_COLUMN_STEP, PL_COLUMN_STEP, PL_INK_PLAIN,
                   pl_page_fill(g, before, s->n_inserts, s->inserts));
  pl_lines lines = pl_page_formula(g, f, pl_room(g, PL_COLUMN_STEP), 0);
  for (int i = 0; i < lines.n; i++) {
    pl_text_pad(g->out, PL_COLUMN_STEP);
    pl_page_ink(g, PL_INK_PLAIN, lines.at[i]);
    pl_page_newline(g);
  }
  if (g->how.math == PL_MATH_2D) pl_page_blank(g);
}

static void pl_put_text(pl_page* g, const pl_step* s) {
  const pl_form* ending = pl_long_ending(g, s, pl_page_words(g, s->words));
  if (ending) {
    pl_put_ending_below(g, s, pl_page_words(g, s->words), ending);
    return;
  }
  const char* words = pl_page_fill(g, pl_page_words(g, s->words), s->n_inserts, s->inserts);
  pl_page_sentence(g, PL_COLUMN_STEP, PL_COLUMN_STEP, PL_INK_PLAIN, words);
}

static void pl_put_note(pl_page* g, const pl_step* s) {
  const char* const note[2] = {PL_BOTH("note")};
  const char* words = pl_page_fill(g, pl_page_words(g, s->words), s->n_inserts, s->inserts);
  // a code in front of the sentence belongs to the word "note": note N055: ...
  bool coded = words[0] == 'N' && strspn(words + 1, "0123456789") == 3;
  const char* lead = coded ? pl_format(g->arena, "%s\x01%s", note[g->how.lang], words)
                           : pl_format(g->arena, "%s: %s", note[g->how.lang], words);
  pl_page_sentence(g, PL_COLUMN_STEP, PL_COLUMN_STEP, PL_INK_YELLOW, lead);
}

static void pl_put_heading(pl_page* g, const pl_step* s) {
  const char* words = pl_page_fill(g, pl_page_words(g, s->words), s->n_inserts, s->inserts);
  pl_page_blank(g);
  pl_page_sentence(g, PL_COLUMN_STEP, PL_COLUMN_STEP, PL_INK_PLAIN, words);
}

// --------------------------------------------------------------------------------------- a stretch
static bool pl_rows_follow(const pl_stretch* b, int i) {
  for (; i < b->steps.n && b->steps.at[i]->kind != PL_STEP_HEADING; i++) {
    if (b->steps.at[i]->kind == PL_STEP_ROW) return true;
  }
  return false;
}

static int pl_run_length(const pl_stretch* b, int i) {
  int n = 1;
  while (i + n < b->steps.n && b->steps.at[i + n]->kind == b->steps.at[i]->kind) n++;
  return n;
}

// Sentences get air in front of them after a finished table, and everywhere between drawn formulas.
static bool pl_needs_air(const pl_page* g, const pl_stretch* b, int i) {
  if (i == 0) return false;
  pl_step_kind before = b->steps.at[i - 1]->kind, here = b->steps.at[i]->kind;
  if (before == PL_STEP_ROW && here != PL_STEP_ROW) return !pl_rows_follow(b, i);
  return g->how.math == PL_MATH_2D && before == PL_STEP_EQUATION && here != PL_STEP_EQUATION;
}

static void pl_put_steps(pl_page* g, const pl_stretch* b) {
  for (int i = 0; i < b->steps.n;) {
    const pl_step* s = b->steps.at[i];
    int n = 1;
    if (pl_needs_air(g, b, i)) pl_page_blank(g);
    if (s->kind == PL_STEP_TEXT) pl_put_text(g, s);
    else if (s->kind == PL_STEP_NOTE) pl_put_note(g, s);
    else if (s->kind == PL_STEP_HEADING) pl_put_heading(g, s);
    else if (s->kind == PL_STEP_EQUATION) {
      n = pl_run_length(b, i);
      pl_put_equations(g, b, b->steps.at + i, n);
    } else {
      n = pl_run_length(b, i);
      int first = i;
      while (first > 0 && b->steps.at[first - 1]->kind != PL_STEP_HEADING) first--;
      int width = pl_label_width(g, b->steps.at + first, b->steps.n - first);
      for (int k = 0; k < n; k++) pl_put_row(g, b, b->steps.at[i + k], width);
    }
    i += n;
  }
}

// ---------------------------------------------------------------------------------------- headings
static bool pl_same_text(const char* a, const char* b) {
  return a == b || (a && b && strcmp(a, b) == 0);
}

static void pl_put_section_heading(pl_page* g, const pl_section* s) {
  const char* dash = g->how.math == PL_MATH_ASCII ? "-" : "–";
  const char* letter = s->letter ? s->letter : dash;
  const char* title = pl_page_words(g, s->title);
  if (!*title) title = pl_page_plain(g, s->item);
  pl_page_blank(g);
  pl_text_pad(g->out, PL_COLUMN_HEADING);
  pl_page_ink(g, PL_INK_BOLD, pl_format(g->arena, "%s) %s", letter, title));
  pl_page_newline(g);
  if (g->how.math == PL_MATH_2D) pl_page_blank(g);
}

static void pl_gather(pl_page* g, pl_stretch* b, const pl_section* s, bool subheading) {
  if (subheading) {
    pl_step* h = PL_NEW(g->arena, pl_step);
    h->kind = PL_STEP_HEADING;
    h->words[0] = s->title[0];
    h->words[1] = s->title[1];
    pl_push(g->arena, b->steps, h);
  }
  for (int i = 0; i < s->steps.n; i++) {
    const pl_step* step = &s->steps.at[i];
    if (!step->detail || g->style->full) pl_push(g->arena, b->steps, step);
  }
  for (int i = 0; i < s->values.n; i++) {
    if (s->values.at[i].form) pl_push(g->arena, b->results, s->values.at[i].form);
  }
}

// A section under the same letter as the one before it opens no new block: another title becomes a
// heading inside.
static bool pl_joins(const pl_section* before, const pl_section* s) {
  if (!before) return false;
  if (s->continues) return true;
  return s->letter && pl_same_text(before->letter, s->letter);
}

void pl_worked_sections(pl_page* g, const pl_solution* s) {
  const pl_section* before = NULL;
  pl_stretch block = {0};
  for (int i = 0; i < s->sections.n; i++) {
    const pl_section* c = &s->sections.at[i];
    if (!pl_worked_wanted(g->style->only, c->letter)) continue;
    bool joins = pl_joins(before, c);
    if (!joins) {
      pl_put_steps(g, &block);
      block = (pl_stretch){0};
      pl_put_section_heading(g, c);
    }
    bool new_title = joins && !c->continues && c->title[0]
                     && !pl_same_text(before->title[0], c->title[0]);
    pl_gather(g, &block, c, new_title);
    before = c;
  }
  pl_put_steps(g, &block);
}
