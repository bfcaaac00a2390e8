// The lettered sections in LaTeX. Equations that follow each other form one `align`, rows of tables
// one `tabular`; numbers are those of LaTeX, so that a fragment counts on in the document that
// takes it in.
#include "tex_impl.h"
#include "report_impl.h"

#include <math.h>
#include <string.h>

static const char* words_of(const pl_tex_page* g, const char* const words[2]) {
  const char* w = words[g->how.lang] ? words[g->how.lang] : words[0];
  return w ? w : "";
}

static bool is_shown(const pl_tex_page* g, const pl_step* s) {
  return !s->detail || g->style->full;
}
static bool is_wanted(const pl_tex_page* g, const pl_section* s) {
  return pl_worked_wanted(g->style->only, s->letter);
}

// ------------------------------------------------------------------------------------------ labels
static bool is_taken(const pl_tex_page* g, const char* label) {
  for (int i = 0; i < g->labels.n; i++) {
    if (strcmp(g->labels.at[i].label, label) == 0) return true;
  }
  return false;
}

// eq:atwood-machine:lambda, after what stands on the left; with its number where that is taken or
// long.
static const char* label_for(pl_tex_page* g, const pl_step* s) {
  const pl_form* left = s->formula;
  while (left->kind == PL_F_RELATION && left->n == 2) left = left->args[0];
  const char* text = pl_notation_print(g->arena, g->pool, left,
                                       (pl_notation){PL_MATH_ASCII, PL_ENGLISH});
  pl_text dotted = pl_text_make(g->arena);
  for (const char* c = text; *c; c++)
    pl_text_add(&dotted, *c == '\'' ? "d" : (const char[]){*c, 0});
  const char* name = strlen(text) <= 12 ? pl_tex_slug(g->arena, pl_text_string(&dotted), "") : "";
  const char* label = pl_format(g->arena, "eq:%s:%s", g->slug, name);
  return *name && !is_taken(g, label) ? label : pl_format(g->arena, "eq:%s:%d", g->slug, s->number);
}

void pl_tex_gather_labels(pl_tex_page* g, const pl_solution* s) {
  for (int i = 0; i < s->sections.n; i++) {
    const pl_section* c = &s->sections.at[i];
    for (int k = 0; is_wanted(g, c) && k < c->steps.n; k++) {
      const pl_step* step = &c->steps.at[k];
      if (step->kind != PL_STEP_EQUATION || step->number <= 0 || !step->formula
          || !is_shown(g, step))
        continue;
      pl_tex_label l = {step->number, label_for(g, step)};
      pl_push(g->arena, g->labels, l);
    }
  }
}

// --------------------------------------------------------------------------------------- equations
static bool has_vector(const pl_form* f) {
  if (f->kind == PL_F_VECTOR) return true;
  return f->kind == PL_F_RELATION && f->n == 2
         && (has_vector(f->args[0]) || has_vector(f->args[1]));
}

static const double value_room = 20;  // letters that a number with its unit and name takes

// What stands behind a formula: its number in units, then words. They go on a line of their own
// when there is no room.
static void add_behind(pl_tex_page* g, const pl_step* s, double used) {
  if (s->has_value && isfinite(s->value)) {
    const char* value = pl_tex_value(g, s->value, s->unit);
    const char* name = s->value_name
                           ? pl_tex_math(g, pl_form_name(g->arena, s->value_name, pl_poison()))
                           : "";
    const char* gap = used > PL_TEX_LINE - value_room ? " \\notag\\\\\n  &\\quad{}"
                      : *name                         ? ",\\quad "
                                                      : "";
    bool aside = has_vector(s->formula) && !*name;
    pl_text_addf(g->out, aside ? "%s\\quad (%s%s)" : "%s%s = %s", gap, name, value);
    used = *gap == ' ' ? value_room : used + value_room;
  }
  const char* after = words_of(g, s->after);
  if (!*after) return;
  bool below = used + 0.9 * pl_utf8_width(after) > PL_TEX_LINE;
  pl_text_addf(g->out, "%s\\text{%s}", below ? " \\notag\\\\\n  &\\qquad " : "\\quad ",
               pl_tex_plain(g, after));
}

static void put_equation(pl_tex_page* g, const pl_step* s, const pl_tex_lines* lines, bool last) {
  for (int i = 0; i < lines->list.n; i++)
    pl_text_addf(g->out, "  %s%s", lines->list.at[i],
                 i + 1 < lines->list.n ? " \\notag\\\\\n" : "");
  add_behind(g, s, lines->last);
  const char* label = s->number > 0 ? pl_tex_label_of(g, s->number) : NULL;
  if (label) pl_text_addf(g->out, " \\label{%s}", label);
  else pl_text_add(g->out, " \\notag");
  pl_text_add(g->out, last ? "\n" : "\\\\\n");
}

// How many of n equations can be aligned with each other without leaving the line.
static int aligned_run(const pl_tex_lines* lines, int n) {
  double left = lines[0].left, right = lines[0].right;
  for (int k = 1; k < n; k++) {
    left = fmax(left, lines[k].left);
    right = fmax(right, lines[k].right);
    if (left + right > PL_TEX_LINE) return k;
  }
  return n;
}

static void put_equations(pl_tex_page* g, const pl_step* const* s, int n) {
  pl_tex_lines* lines = PL_ARRAY(g->arena, pl_tex_lines, n);
  for (int i = 0; i < n; i++) lines[i] = pl_tex_display(g, s[i]->formula);
  for (int i = 0; i < n;) {
    int run = aligned_run(lines + i, n - i);
    pl_text_add(g->out, "\\begin{align}\n");
    for (int k = i; k < i + run; k++) put_equation(g, s[k], &lines[k], k + 1 == i + run);
    pl_text_add(g->out, "\\end{align}\n");
    i += run;
  }
}

// ------------------------------------------------------------------------------------------ tables
static void put_rows(pl_tex_page* g, const pl_step* const* s, int n) {
  pl_text_add(g->out,
              "\\par\\smallskip\\noindent\n"
              "\\begin{tabular*}{\\linewidth}{@{}l@{\\quad}p{0.6\\linewidth}@{\\extracolsep{\\fill}"
              "}r@{}}\n");
  for (int i = 0; i < n; i++) {
    const char* after = words_of(g, s[i]->after);
    pl_text_addf(g->out, "  %s & \\raggedright ",
                 pl_tex_fill(g, words_of(g, s[i]->words), s[i]->n_inserts, s[i]->inserts));
    if (s[i]->formula) pl_text_add(g->out, pl_tex_fill(g, "{1}", 1, &s[i]->formula));
    if (*after) pl_text_addf(g->out, "\\quad %s", pl_tex_plain(g, after));
    pl_text_addf(g->out, " & $%s$ \\\\[2pt]\n", s[i]->margin ? s[i]->margin : "");
  }
  pl_text_add(g->out, "\\end{tabular*}\\par\\smallskip\n");
}

// --------------------------------------------------------------------------------------- sentences
static void put_sentence(pl_tex_page* g, const pl_step* s, const char* lead) {
  const char* words = words_of(g, s->words);
  size_t length = strlen(words);
  const pl_form* last = s->n_inserts > 0 ? s->inserts[s->n_inserts - 1] : NULL;
  const char* mark = pl_format(g->arena, "{%d}", s->n_inserts);
  bool ends = last && length >= strlen(mark) && strcmp(words + length - strlen(mark), mark) == 0;
  // a wide formula at the end of a sentence is displayed
  if (ends && pl_tex_width(g, last) > PL_TEX_LINE / 2) {
    const char* before = pl_copy_n(g->arena, words, length - strlen(mark));
    pl_text_addf(g->out, "\n%s%s\n", lead, pl_tex_fill(g, before, s->n_inserts, s->inserts));
    pl_step shown = {.kind = PL_STEP_EQUATION, .formula = last};
    const pl_step* list = &shown;
    put_equations(g, &list, 1);
    return;
  }
  pl_text_addf(g->out, "\n%s%s\n", lead, pl_tex_fill(g, words, s->n_inserts, s->inserts));
}

static void put_heading(pl_tex_page* g, const pl_step* s) {
  pl_text_addf(g->out, "\n\\plheading{%s}\n",
               pl_tex_fill(g, words_of(g, s->words), s->n_inserts, s->inserts));
}

// --------------------------------------------------------------------------------------- a section
static int run_of(const pl_step* const* s, int n) {
  int k = 1;
  bool table = s[0]->kind == PL_STEP_ROW;
  while (k < n && s[k]->kind == s[0]->kind && (table || (s[k]->formula && !s[k]->words[0]))) k++;
  return k;
}

static void put_steps(pl_tex_page* g, const pl_step* const* s, int n) {
  const char* const note[2] = {PL_BOTH("\\emph{Note.} ")};
  for (int i = 0; i < n;) {
    int run = 1;
    if (s[i]->kind == PL_STEP_EQUATION && s[i]->formula) {
      if (*words_of(g, s[i]->words)) put_sentence(g, s[i], "");
      run = run_of(s + i, n - i);
      put_equations(g, s + i, run);
    } else if (s[i]->kind == PL_STEP_ROW) {
      run = run_of(s + i, n - i);
      put_rows(g, s + i, run);
    } else if (s[i]->kind == PL_STEP_HEADING) put_heading(g, s[i]);
    else put_sentence(g, s[i], s[i]->kind == PL_STEP_NOTE ? note[g->how.lang] : "");
    i += run;
  }
}

// The steps under one heading, from all sections that belong there.
typedef PL_VEC(const pl_step*) pl_stretch;

static void gather(pl_tex_page* g, pl_stretch* to, const pl_section* s) {
  for (int i = 0; i < s->steps.n; i++) {
    if (is_shown(g, &s->steps.at[i])) pl_push(g->arena, *to, &s->steps.at[i]);
  }
}

static void flush(pl_tex_page* g, pl_stretch* steps) {
  put_steps(g, steps->at, steps->n);
  *steps = (pl_stretch){0};
}

static bool same(const char* a, const char* b) { return a == b || (a && b && strcmp(a, b) == 0); }

// The heading that a section opens, if it opens one.
static const char* heading_of(pl_tex_page* g, const pl_section* s, const pl_section* before) {
  const char* title = words_of(g, s->title);
  if (!*title) title = s->item ? s->item : "";
  bool joins = before && (s->continues || (s->letter && same(s->letter, before->letter)));
  if (!joins)
    return pl_format(g->arena, "\n\\plsection{%s}{%s}\n", s->letter ? s->letter : "",
                     pl_tex_plain(g, title));
  bool other = !s->continues && !same(s->title[0], before->title[0]);
  return other ? pl_format(g->arena, "\n\\plheading{%s}\n", pl_tex_plain(g, title)) : NULL;
}

void pl_tex_sections(pl_tex_page* g, const pl_solution* s) {
  const pl_section* before = NULL;
  pl_stretch steps = {0};
  for (int i = 0; i < s->sections.n; i++) {
    const pl_section* c = &s->sections.at[i];
    if (!is_wanted(g, c)) continue;
    const char* heading = heading_of(g, c, before);
    if (heading) flush(g, &steps);
    if (heading) pl_text_add(g->out, heading);
    gather(g, &steps, c);
    before = c;
  }
  flush(g, &steps);
}
