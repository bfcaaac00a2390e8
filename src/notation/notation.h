// notation: forms -> text. One walk over the form builds boxes, then a writer turns them into a
// line, a 2-D picture, ASCII, LaTeX or MathML.
#ifndef PL_NOTATION_H
#define PL_NOTATION_H

#include "expr/expr.h"

typedef enum pl_math {
  // -2 m1 m2 g/(m1 + m2), x1'', √(l² - r² sin²φ), φ'²: Unicode in one line, as on the command-line
  // page
  PL_MATH_LINE,
  PL_MATH_2D,     // fractions and roots drawn over several lines, dots over letters
  PL_MATH_ASCII,  // the model language in ASCII, blank products: parses back
  PL_MATH_TEX,    // amsmath
  PL_MATH_MATHML  // content of <math>, with the advice of report.md
} pl_math;

typedef struct pl_notation {
  pl_math math;
  pl_language lang;  // words inside formulas, decimal comma in German display
} pl_notation;

// pl_notation_print returns the text of a form, possibly of several lines (2-D), without a final
// newline.
const char* pl_notation_print(pl_arena* a, pl_pool* p, const pl_form* f, pl_notation how);
// The same with the height and the base line of a 2-D text: rows above the base line in *above,
// below in *below.
const char* pl_notation_print_2d(pl_arena* a, pl_pool* p, const pl_form* f, pl_notation how,
                                 int* above, int* below);

// Names: θ, x1, x1'', λ as they are displayed.
const char* pl_notation_symbol(pl_arena* a, const pl_pool* p, pl_symbol s, pl_notation how);

// pl_notation_words writes a sentence as LaTeX text; nothing in it can act as a command.
void pl_notation_words(pl_text* out, const char* words);

// A unit as it is displayed, "kg m²/s", upright in LaTeX: "\mathrm{kg\,m^{2}/s}".
const char* pl_notation_unit_tex(pl_arena* a, const char* unit);

// A number for display with `digits` significant digits, decimal comma in German, no trailing
// zeros: "-23.544", "1.962", "3.2e-7".
const char* pl_notation_number(pl_arena* a, double x, int digits, pl_notation how);

#endif
