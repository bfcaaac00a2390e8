// Units as each manner writes them.  They come as they are displayed: "kg m²/s", "µm", "1/(N m)".
#include "notation_impl.h"

#include <string.h>

typedef struct sign {
  const char *from, *to;
} sign;

static const char* replaced(pl_arena* a, const char* unit, const sign* table, size_t n) {
  pl_text out = pl_text_make(a);
  while (*unit) {
    size_t k = 0;
    while (k < n && strncmp(unit, table[k].from, strlen(table[k].from)) != 0) k++;
    if (k < n) pl_text_add(&out, table[k].to);
    else pl_text_add_n(&out, unit, 1);
    unit += k < n ? strlen(table[k].from) : 1;
  }
  return pl_text_string(&out);
}

const char* pl_notation_unit_tex(pl_arena* a, const char* unit) {
  static const sign table[] = {
      {" ", "\\,"},      {"⁻¹", "^{-1}"},    {"⁻²", "^{-2}"},  {"⁻³", "^{-3}"}, {"²", "^{2}"},
      {"³", "^{3}"},     {"⁴", "^{4}"},      {"·", "\\cdot "}, {"µ", "\\mu "},  {"μ", "\\mu "},
      {"Ω", "\\Omega "}, {"°", "^{\\circ}"}, {"%", "\\%"},
  };
  return pl_format(a, "\\mathrm{%s}", replaced(a, unit, table, sizeof table / sizeof *table));
}

// The reader of units takes "u" for the prefix of a millionth and "Ohm"; a raised digit is a power.
const char* pl_unit_ascii(pl_arena* a, const char* unit) {
  static const sign table[] = {
      {"⁻¹", "^-1"}, {"⁻²", "^-2"}, {"⁻³", "^-3"}, {"²", "^2"},  {"³", "^3"},  {"⁴", "^4"},
      {"·", " "},    {"µ", "u"},    {"μ", "u"},    {"Ω", "Ohm"}, {"°", "deg"},
  };
  return replaced(a, unit, table, sizeof table / sizeof *table);
}
