// Boxes: what stands between a form and its text.  Only for the files of this folder.
//
// One walk (notation_build.c) turns a form into boxes and decides where the language needs
// brackets; one writer for each manner (notation_line.c, notation_2d.c, notation_tex.c,
// notation_mathml.c) turns the boxes into text.
#ifndef PL_NOTATION_IMPL_H
#define PL_NOTATION_IMPL_H

#include "notation/notation.h"

typedef enum pl_box_kind {
  PL_B_NAME,  // letters, subscript, dots: m₁, ẋ₁                        .text .sub .dots
  // element of a family: x[i-1]'                            .text .sub .dots, index in .at[0]
  PL_B_INDEXED,
  PL_B_VECTOR,    // unit vector e_r                                         .text .sub
  PL_B_NUMBER,    // digits, perhaps a decimal point                         .text
  PL_B_WORD,      // name of a function                                      .text, .tex
  PL_B_UNIT,      // unit behind a number, upright                            .text
  PL_B_OP,        // operator or punctuation                                 .text .role
  PL_B_PROSE,     // words inside a formula                                  .text
  PL_B_ROW,       // boxes side by side                                      .at
  PL_B_PRODUCT,   // factors, a PL_B_OP "·" where a blank would be misread   .at
  PL_B_FRACTION,  // stacked: numerator, denominator                         .at[0] .at[1]
  PL_B_ROOT,      // square root                                             .at[0]
  PL_B_POWER,     // base, exponent                                          .at[0] .at[1]
  PL_B_APPLY,     // function (word, or power of a word), argument           .at[0] .at[1]
  PL_B_FENCE,     // brackets around .at[0]; .text is "(" or "|"
  PL_B_SUM_OVER,  // Σ: index, lower end, upper end, body                    .at[0..3]
  PL_B_CASES      // condition, then, otherwise                              .at[0..2]
} pl_box_kind;

typedef enum pl_op_role { PL_OP_INFIX, PL_OP_TIGHT, PL_OP_PREFIX, PL_OP_COMMA } pl_op_role;

// How tightly a box binds, in the precedence of the model language.
typedef enum pl_level {
  PL_LEVEL_LOOSE,
  PL_LEVEL_SUM,
  PL_LEVEL_PRODUCT,
  PL_LEVEL_POWER,
  PL_LEVEL_ATOM
} pl_level;

typedef struct pl_box pl_box;
struct pl_box {
  pl_box_kind kind;
  pl_op_role role;
  pl_level level;
  // its first sign is a digit, so a blank before it would glue it to what stands there
  bool starts_digit;
  // ends in a division by something that is no plain number: nothing may be multiplied to its right
  bool open_slash;
  bool has_sum;    // a sum is visible inside
  bool free_name;  // no symbol of the model: e_r, M
  bool tall;       // higher than a line when set in two dimensions
  bool arrow;      // names a vector: an arrow over the letter in LaTeX and MathML
  int dots;
  int n;
  pl_box** at;  // (n)
  const char* text;
  const char* sub;
  const char* tex;
};

// What the walk needs to know.
typedef struct pl_builder {
  pl_arena* arena;
  pl_pool* pool;
  pl_notation how;
  bool flat;  // fractions with a slash: LINE, ASCII, and exponents everywhere
  int depth;
} pl_builder;

pl_box* pl_box_make(pl_arena* a, pl_box_kind k, pl_level level, int n);
pl_box* pl_box_text(pl_arena* a, pl_box_kind k, const char* text);
pl_box* pl_box_op(pl_arena* a, const char* text, pl_op_role role);
pl_box* pl_box_fence(pl_arena* a, pl_box* inside, const char* text);

pl_box* pl_build(pl_builder* b, const pl_form* f);

// Names.
pl_box* pl_box_symbol(pl_arena* a, const pl_pool* p, pl_symbol s, pl_notation how);
pl_box* pl_box_array(pl_arena* a, const pl_pool* p, pl_symbol s, int dots, pl_box* index,
                     pl_notation how);
// PL_F_NAME: "M(φ)", "e_r"
pl_box* pl_box_free_name(pl_arena* a, const char* text, pl_notation how);
// "theta", or NULL
const char* pl_greek_ascii(uint32_t code_point);
// "\\vartheta", or NULL
const char* pl_greek_tex(uint32_t code_point);
// everything in ASCII letters
void pl_write_ascii(pl_text* out, const char* utf8);
// "-12" -> "⁻¹²", NULL if a sign has none
const char* pl_superscript(pl_arena* a, const char* s);
const char* pl_subscript(pl_arena* a, const char* s);
// "kg m²" -> "kg m^2", as the language reads it
const char* pl_unit_ascii(pl_arena* a, const char* unit);

// An exact number as it is shown: "3", "9.81", "1/2" as numerator and denominator. den is NULL for
// a plain number.
void pl_number_parts(pl_arena* a, const pl_pool* p, pl_expr e, pl_notation how, bool* negative,
                     const char** num, const char** den);

// "0.5" for 1/2: digits with a decimal point, NULL where they do not end. For numbers that are not
// negative.
const char* pl_number_decimal(pl_arena* a, const pl_pool* p, pl_expr e, pl_notation how);

// Writers.
void pl_write_line(pl_text* out, const pl_box* b, bool ascii);
void pl_write_tex(pl_text* out, const pl_box* b);
void pl_write_mathml(pl_text* out, const pl_box* b);
const char* pl_write_2d(pl_arena* a, const pl_box* b, int* above, int* below);

#endif
