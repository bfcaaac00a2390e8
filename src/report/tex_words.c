// Words for LaTeX: sentences with formulas in them, labels, numbers with units.
#include "tex_impl.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PL_TEX_DIGITS = 6 };  // significant digits of numbers beside formulas

const char* pl_tex_plain(pl_tex_page* g, const char* s) {
  pl_text out = pl_text_make(g->arena);
  pl_notation_words(&out, s ? s : "");
  return pl_text_string(&out);
}

const char* pl_tex_label_of(const pl_tex_page* g, int number) {
  for (int i = 0; i < g->labels.n; i++) {
    if (g->labels.at[i].number == number) return g->labels.at[i].label;
  }
  return NULL;
}

// The number of "(4)" at the begin of s and its length; 0: it is something else.
static int numbered(const char* s, size_t* length) {
  size_t digits = *s == '(' ? strspn(s + 1, "0123456789") : 0;
  *length = digits + 2;
  return digits > 0 && digits < 6 && s[1 + digits] == ')' ? atoi(s + 1) : 0;
}

// Words such as "(1) and (2)": what is printed under a label is referred to.
static void add_references(pl_tex_page* g, pl_text* out, const char* s) {
  const char* from = s;
  for (;; s++) {
    size_t length;
    int number = numbered(s, &length);
    const char* label = number > 0 ? pl_tex_label_of(g, number) : NULL;
    if (*s && !label) continue;
    pl_notation_words(out, pl_copy_n(g->arena, from, (size_t)(s - from)));
    if (!*s) return;
    pl_text_addf(out, "\\eqref{%s}", label);
    s += length - 1;
    from = s + 1;
  }
}

// A long formula inside a sentence may break after its commas.
static void add_inline(pl_tex_page* g, pl_text* out, const pl_form* f) {
  const char* math = pl_tex_math(g, f);
  size_t length;
  bool alone = numbered(math, &length) > 0 && !math[length];
  if (alone || f->kind == PL_F_TEXT) {
    const char* words = f->kind == PL_F_TEXT ? f->words[g->how.lang] : math;
    add_references(g, out, words ? words : "");
    return;
  }
  if (!*math) return;
  int depth = 0;
  pl_text_add(out, "$");
  for (const char* c = math; *c; c++) {
    depth += (*c == '{') - (*c == '}');
    pl_text_add_n(out, c, 1);
    if (*c == ',' && depth == 0 && c[1] == ' ') pl_text_add(out, "\\allowbreak ");
  }
  pl_text_add(out, "$");
}

const char* pl_tex_fill(pl_tex_page* g, const char* words, int n, const pl_form* const* inserts) {
  pl_text out = pl_text_make(g->arena);
  const char* from = words ? words : "";
  for (const char* s = from;; s++) {
    int digits = *s == '{' ? (int)strspn(s + 1, "0123456789") : 0;
    bool insert = digits > 0 && digits < 4 && s[1 + digits] == '}';
    if (*s && !insert) continue;
    pl_notation_words(&out, pl_copy_n(g->arena, from, (size_t)(s - from)));
    if (!*s) break;
    int k = atoi(s + 1);
    if (k >= 1 && k <= n && inserts[k - 1]) add_inline(g, &out, inserts[k - 1]);
    s += digits + 1;
    from = s + 1;
  }
  return pl_text_string(&out);
}

const char* pl_tex_slug(pl_arena* a, const char* s, const char* otherwise) {
  const char* ascii = pl_ascii_of(a, s ? s : "");
  pl_text out = pl_text_make(a);
  bool gap = false;
  for (const char* c = ascii; *c && out.n < 40; c++) {
    if (!isalnum((unsigned char)*c)) {
      gap = out.n > 0;
      continue;
    }
    char low = (char)tolower((unsigned char)*c);
    if (gap) pl_text_add(&out, "-");
    pl_text_add_n(&out, &low, 1);
    gap = false;
  }
  const char* slug = pl_text_string(&out);
  return *slug ? slug : otherwise;
}

const char* pl_tex_value(pl_tex_page* g, double x, const char* unit) {
  bool radians = unit && strcmp(unit, "rad") == 0,
       degrees = radians || (unit && strcmp(unit, "°") == 0);
  bool bare = !unit || !*unit || strcmp(unit, "1") == 0;
  const char* digits = pl_notation_number(g->arena, radians ? x * 180 / acos(-1) : x, PL_TEX_DIGITS,
                                          g->how);
  pl_text out = pl_text_make(g->arena);
  const char* power = strchr(digits, 'e');
  pl_text_add_n(&out, digits, power ? (size_t)(power - digits) : strlen(digits));
  if (power) pl_text_addf(&out, "\\cdot 10^{%d}", atoi(power + 1));
  if (degrees) pl_text_add(&out, "^{\\circ}");
  else if (!bare) pl_text_addf(&out, "\\,%s", pl_notation_unit_tex(g->arena, unit));
  return pl_text_string(&out);
}
