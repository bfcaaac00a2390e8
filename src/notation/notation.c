// The front of the folder: builds the boxes of a form and hands them to the writer of the manner
// asked for.
#include "notation_impl.h"

static pl_box* boxes_of(pl_arena* a, pl_pool* p, const pl_form* f, pl_notation how) {
  bool flat = how.math == PL_MATH_LINE || how.math == PL_MATH_ASCII;
  pl_builder b = {.arena = a, .pool = p, .how = how, .flat = flat};
  return pl_build(&b, f);
}

static const char* write_boxes(pl_arena* a, const pl_box* box, pl_math math) {
  pl_text t = pl_text_make(a);
  switch (math) {
    case PL_MATH_LINE: pl_write_line(&t, box, false); break;
    case PL_MATH_ASCII: pl_write_line(&t, box, true); break;
    case PL_MATH_TEX: pl_write_tex(&t, box); break;
    case PL_MATH_MATHML: pl_write_mathml(&t, box); break;
    case PL_MATH_2D: return pl_write_2d(a, box, &(int){0}, &(int){0});
  }
  return pl_text_string(&t);
}

const char* pl_notation_print(pl_arena* a, pl_pool* p, const pl_form* f, pl_notation how) {
  return write_boxes(a, boxes_of(a, p, f, how), how.math);
}

const char* pl_notation_print_2d(pl_arena* a, pl_pool* p, const pl_form* f, pl_notation how,
                                 int* above, int* below) {
  how.math = PL_MATH_2D;
  int up = 0, down = 0;
  const char* s = pl_write_2d(a, boxes_of(a, p, f, how), &up, &down);
  if (above) *above = up;
  if (below) *below = down;
  return s;
}

const char* pl_notation_symbol(pl_arena* a, const pl_pool* p, pl_symbol s, pl_notation how) {
  return write_boxes(a, pl_box_symbol(a, p, s, how), how.math);
}
