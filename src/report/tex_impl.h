// tex_impl: what the rooms of the LaTeX writer share.
#ifndef PL_TEX_IMPL_H
#define PL_TEX_IMPL_H

#include "report.h"

// A numbered equation and the label under which the text speaks of it.
typedef struct pl_tex_label {
  int number;
  const char* label;
} pl_tex_label;

typedef struct pl_tex_page {
  pl_text* out;
  pl_arena* arena;
  pl_pool* pool;
  const pl_tex_style* style;
  pl_notation how;
  const char* slug;             // "atwood_machine": begin of all labels
  PL_VEC(pl_tex_label) labels;  // of the equations that are printed
} pl_tex_page;

// ---- tex_formula.c
// How wide a form comes out, in widths of a letter of a line, and how many fit on one.
enum { PL_TEX_LINE = 76 };
double pl_tex_width(const pl_tex_page* g, const pl_form* f);
// in one piece, without dollar signs
const char* pl_tex_math(pl_tex_page* g, const pl_form* f);
// The lines of a displayed formula for `align`: "a &= b", "&\quad{}+ c".
typedef struct pl_tex_lines {
  PL_VEC(const char*) list;
  double last;         // width of the last line
  double left, right;  // widths on both sides of the place of alignment
} pl_tex_lines;
pl_tex_lines pl_tex_display(pl_tex_page* g, const pl_form* f);

// ---- tex_words.c
// a text as LaTeX text, nothing in it commands
const char* pl_tex_plain(pl_tex_page* g, const char* s);
// Words with {1}, {2} ... replaced by formulas, references to printed equations by \eqref.
const char* pl_tex_fill(pl_tex_page* g, const char* words, int n, const pl_form* const* inserts);
// lower-case ASCII letters, digits, _
const char* pl_tex_slug(pl_arena* a, const char* s, const char* otherwise);
// "-23.544\,\mathrm{N}"
const char* pl_tex_value(pl_tex_page* g, double x, const char* unit);
const char* pl_tex_label_of(const pl_tex_page* g, int number);  // NULL: not printed

// ---- tex_sections.c
void pl_tex_gather_labels(pl_tex_page* g, const pl_solution* s);
void pl_tex_sections(pl_tex_page* g, const pl_solution* s);

// ---- tex_figure.c
void pl_tex_figure(pl_tex_page* g, const pl_scene* scene);

#endif
