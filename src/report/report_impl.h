// report_impl: what the rooms of report share. A page is text under construction with a right
// margin; formulas come to it as blocks of lines with a base line, sentences as strings that are
// wrapped.
#ifndef PL_REPORT_IMPL_H
#define PL_REPORT_IMPL_H

#include "report.h"

typedef enum pl_ink { PL_INK_PLAIN, PL_INK_BOLD, PL_INK_DIM, PL_INK_YELLOW, PL_INK_RED } pl_ink;

typedef struct pl_page {
  pl_text* out;
  pl_arena* arena;
  pl_pool* pool;  // NULL when the model has none: then no formulas
  const pl_worked_style* style;
  pl_notation how;
  int margin;  // right edge, cells: equation numbers end here
  int wrap;    // cells that a line may have; INT_MAX when nothing is wrapped
  bool blank;  // the last line written is empty
} pl_page;

// Lines of a formula.  In line notation one line, or several when it was wrapped.
typedef struct pl_lines {
  const char** at;  // (n)
  int n;
  int base;   // the line that carries equation number and label
  int width;  // of the widest line
} pl_lines;

// ---- page.c
pl_page pl_page_make(pl_text* out, pl_pool* pool, const pl_worked_style* style);
// by language, ASCII where asked for; never NULL
const char* pl_page_words(const pl_page* g, const char* const words[2]);
// the string as the page can show it
const char* pl_page_plain(const pl_page* g, const char* s);
// an empty line, never two
void pl_page_blank(pl_page* g);
void pl_page_ink(pl_page* g, pl_ink ink, const char* s);
void pl_page_newline(pl_page* g);
// A sentence, wrapped: first line at column `indent`, the others at `hang`. `\x01` is a blank that
// does not break.
void pl_page_sentence(pl_page* g, int indent, int hang, pl_ink ink, const char* s);
// Words with {1}, {2} ... replaced by formulas; blanks inside short formulas do not break.
const char* pl_page_fill(pl_page* g, const char* words, int n, const pl_form* const* inserts);

// ---- page_formula.c A formula in at most `width` cells where that is possible: broken at
// relations, then at + and -, with hanging indent. `right` cells are kept free at the end of its
// base line, for what stands at the margin.
pl_lines pl_page_formula(pl_page* g, const pl_form* f, int width, int right);

// ---- worked_sections.c
void pl_worked_sections(pl_page* g, const pl_solution* s);

// ---- worked_text.c
// does a step of the solution tell this note already
bool pl_worked_told(const pl_solution* s, const char* code);

#endif
