// Names as they are displayed: Greek letters, subscripts, dots, start values, unit vectors.
#include "notation_impl.h"

#include <ctype.h>
#include <string.h>

// One row a letter: code point, name in ASCII, name in TeX.
typedef struct pl_greek {
  uint32_t code;
  const char *ascii, *tex;
} pl_greek;

static const pl_greek greek[] = {
    {0x391, "Alpha", "\\mathrm{A}"},
    {0x392, "Beta", "\\mathrm{B}"},
    {0x393, "Gamma", "\\Gamma"},
    {0x394, "Delta", "\\Delta"},
    {0x395, "Epsilon", "\\mathrm{E}"},
    {0x396, "Zeta", "\\mathrm{Z}"},
    {0x397, "Eta", "\\mathrm{H}"},
    {0x398, "Theta", "\\Theta"},
    {0x399, "Iota", "\\mathrm{I}"},
    {0x39A, "Kappa", "\\mathrm{K}"},
    {0x39B, "Lambda", "\\Lambda"},
    {0x39C, "Mu", "\\mathrm{M}"},
    {0x39D, "Nu", "\\mathrm{N}"},
    {0x39E, "Xi", "\\Xi"},
    {0x39F, "Omicron", "\\mathrm{O}"},
    {0x3A0, "Pi", "\\Pi"},
    {0x3A1, "Rho", "\\mathrm{P}"},
    {0x3A3, "Sigma", "\\Sigma"},
    {0x3A4, "Tau", "\\mathrm{T}"},
    {0x3A5, "Upsilon", "\\Upsilon"},
    {0x3A6, "Phi", "\\Phi"},
    {0x3A7, "Chi", "\\mathrm{X}"},
    {0x3A8, "Psi", "\\Psi"},
    {0x3A9, "Omega", "\\Omega"},
    {0x3B1, "alpha", "\\alpha"},
    {0x3B2, "beta", "\\beta"},
    {0x3B3, "gamma", "\\gamma"},
    {0x3B4, "delta", "\\delta"},
    {0x3B5, "epsilon", "\\varepsilon"},
    {0x3B6, "zeta", "\\zeta"},
    {0x3B7, "eta", "\\eta"},
    {0x3B8, "theta", "\\theta"},
    {0x3B9, "iota", "\\iota"},
    {0x3BA, "kappa", "\\kappa"},
    {0x3BB, "lambda", "\\lambda"},
    {0x3BC, "mu", "\\mu"},
    {0x3BD, "nu", "\\nu"},
    {0x3BE, "xi", "\\xi"},
    {0x3BF, "omicron", "o"},
    {0x3C0, "pi", "\\pi"},
    {0x3C1, "rho", "\\rho"},
    {0x3C2, "sigma", "\\varsigma"},
    {0x3C3, "sigma", "\\sigma"},
    {0x3C4, "tau", "\\tau"},
    {0x3C5, "upsilon", "\\upsilon"},
    {0x3C6, "phi", "\\varphi"},
    {0x3C7, "chi", "\\chi"},
    {0x3C8, "psi", "\\psi"},
    {0x3C9, "omega", "\\omega"},
    {0x3D1, "theta", "\\vartheta"},
    {0x3D5, "phi", "\\phi"},
    {0x3D6, "pi", "\\varpi"},
    {0x3F0, "kappa", "\\varkappa"},
    {0x3F1, "rho", "\\varrho"},
    {0x3F5, "epsilon", "\\epsilon"},
};

static const pl_greek* greek_find(uint32_t code) {
  for (size_t i = 0; i < sizeof greek / sizeof *greek; i++)
    if (greek[i].code == code) return &greek[i];
  return NULL;
}

const char* pl_greek_ascii(uint32_t code) {
  const pl_greek* g = greek_find(code);
  return g ? g->ascii : NULL;
}

const char* pl_greek_tex(uint32_t code) {
  const pl_greek* g = greek_find(code);
  return g ? g->tex : NULL;
}

// ------------------------------------------------------------------------------------ small digits
static const char small_signs[] = "0123456789-+=()";
static const char* const superscripts[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷",
                                           "⁸", "⁹", "⁻", "⁺", "⁼", "⁽", "⁾"};
static const char* const subscripts[] = {"₀", "₁", "₂", "₃", "₄", "₅", "₆", "₇",
                                         "₈", "₉", "₋", "₊", "₌", "₍", "₎"};

static const char* small(pl_arena* a, const char* s, const char* const* table) {
  pl_text t = pl_text_make(a);
  for (; *s; s++) {
    const char* at = strchr(small_signs, *s);
    if (!at) return NULL;
    pl_text_add(&t, table[at - small_signs]);
  }
  return pl_text_string(&t);
}

const char* pl_superscript(pl_arena* a, const char* s) { return small(a, s, superscripts); }
const char* pl_subscript(pl_arena* a, const char* s) { return small(a, s, subscripts); }

// Replacement in ASCII of signs that are no letters.
static const char* sign_ascii(uint32_t code) {
  static const struct {
    uint32_t code;
    const char* ascii;
  } signs[] = {
      {0xB7, "*"},       {0x2212, "-"},    {0x221A, "sqrt"}, {0x221E, "inf"}, {0x2265, ">="},
      {0x2264, "<="},    {0x2260, "!="},   {0x2248, "~="},   {0x2192, "->"},  {0xB1, "+-"},
      {0x2207, "grad "}, {0x222B, "int "}, {0x2032, "'"},    {0x2202, "d"},   {0xB0, " deg"},
      {0x2011, "-"},     {0x2026, "..."},
  };
  for (size_t i = 0; i < sizeof signs / sizeof *signs; i++)
    if (signs[i].code == code) return signs[i].ascii;
  return NULL;
}

// The digit that a small sign stands for, 0 if it is none.
static char small_to_ascii(const char* at, size_t n, const char* const* table) {
  for (size_t i = 0; i + 1 < sizeof small_signs; i++)
    if (strlen(table[i]) == n && memcmp(table[i], at, n) == 0) return small_signs[i];
  return 0;
}

void pl_write_ascii(pl_text* out, const char* s) {
  const char* end = s + strlen(s);
  bool raised = false;
  while (s < end) {
    uint32_t code = 0;
    int n = pl_utf8_decode(s, end, &code);
    if (n <= 0) {
      n = 1;
      code = (unsigned char)*s < 128 ? (uint32_t)*s : '?';
    }
    char up = small_to_ascii(s, (size_t)n, superscripts),
         down = small_to_ascii(s, (size_t)n, subscripts);
    if (up && !raised) pl_text_add(out, "^");
    raised = up != 0;
    const char* name = pl_greek_ascii(code);
    if (!name) name = sign_ascii(code);
    if (up || down) pl_text_add_n(out, up ? &up : &down, 1);
    else if (name) pl_text_add(out, name);
    else if (code < 128) pl_text_add_n(out, s, 1);
    else pl_text_addf(out, "u%04x", (unsigned)code);
    s += n;
  }
}

// --------------------------------------------------------------------------------- splitting names
// "m1" -> "m", "1";  "λ_g1" -> "λ", "g1";  "mass" -> "mass", NULL.
static void split(pl_arena* a, const char* name, const char** letters, const char** sub) {
  const char* bar = strchr(name, '_');
  size_t n = strlen(name);
  *sub = NULL;
  if (bar && bar > name && bar[1]) {
    *letters = pl_copy_n(a, name, (size_t)(bar - name));
    *sub = pl_copy(a, bar + 1);
    return;
  }
  size_t k = n;
  while (k > 0 && isdigit((unsigned char)name[k - 1])) k--;
  *letters = pl_copy_n(a, name, k ? k : n);
  if (k > 0 && k < n) *sub = pl_copy(a, name + k);
}

// Name of the quantity whose dots are counted separately: x1' is the x1 with one dot.
static const char* stem(const pl_pool* p, pl_symbol s, bool ascii) {
  const pl_symbol_info* i = pl_symbol_get(p, s);
  bool dotted = i->role == PL_R_VELOCITY || i->role == PL_R_ACCELERATION || i->role == PL_R_START;
  if (dotted && i->base.id) i = pl_symbol_get(p, i->base);
  const char* name = ascii ? i->ascii : i->name;
  if (!name) name = i->ascii;
  return name ? name : "?";
}

static pl_box* name_box(pl_arena* a, pl_box_kind kind, const char* name, int dots,
                        pl_notation how) {
  pl_box* b = pl_box_make(a, kind, PL_LEVEL_ATOM, 0);
  b->dots = dots;
  if (how.math == PL_MATH_LINE || how.math == PL_MATH_ASCII) b->text = name;
  else split(a, name, &b->text, &b->sub);
  return b;
}

pl_box* pl_box_symbol(pl_arena* a, const pl_pool* p, pl_symbol s, pl_notation how) {
  const pl_symbol_info* i = pl_symbol_get(p, s);
  bool set_in_parts = how.math != PL_MATH_LINE && how.math != PL_MATH_ASCII;
  if (set_in_parts && i->role == PL_R_LOCAL && i->dots == 0 && i->name && strchr(i->name, '(')) {
    return pl_box_free_name(a, i->name, how);  // x1(t): a letter with its argument
  }
  pl_box* name = name_box(a, PL_B_NAME, stem(p, s, how.math == PL_MATH_ASCII), i->dots, how);
  if (i->role != PL_R_START) return name;
  pl_box* row = pl_box_make(a, PL_B_ROW, PL_LEVEL_ATOM, 2);
  row->at[0] = name;
  row->at[1] = pl_box_fence(a, pl_box_text(a, PL_B_NUMBER, "0"), "(");
  return row;
}

pl_box* pl_box_array(pl_arena* a, const pl_pool* p, pl_symbol s, int dots, pl_box* index,
                     pl_notation how) {
  pl_box* name = name_box(a, PL_B_INDEXED, stem(p, s, how.math == PL_MATH_ASCII), dots, how);
  pl_box* b = pl_box_make(a, PL_B_INDEXED, PL_LEVEL_ATOM, 1);
  b->text = name->text;
  b->sub = name->sub;
  b->dots = dots;
  b->at[0] = index;
  return b;
}

// -------------------------------------------------------------------------------------- free names
static bool is_letter(uint32_t code) {
  return (code < 128 && (isalpha((int)code) || code == '_'))
         || (code >= 0xC0 && code < 0x2000 && code != 0xD7 && code != 0xF7);
}

// Takes one identifier with its primes from *s.
static pl_box* take_identifier(pl_arena* a, const char** s, const char* end, pl_notation how) {
  const char *begin = *s, *at = begin;
  uint32_t code = 0;
  for (int n; at < end && (n = pl_utf8_decode(at, end, &code)) > 0; at += n)
    if (!is_letter(code) && !(code < 128 && isdigit((int)code))) break;
  const char* name = pl_copy_n(a, begin, (size_t)(at - begin));
  int dots = 0;
  while (at < end && *at == '\'') {
    at++;
    dots++;
  }
  *s = at;
  bool vector = strncmp(name, "e_", 2) == 0 && name[2] && dots == 0;
  return name_box(a, vector ? PL_B_VECTOR : PL_B_NAME, name, dots, how);
}

// Takes superscript digits from *s: NULL if there are none.
static pl_box* take_superscript(pl_arena* a, const char** s, const char* end) {
  pl_text digits = pl_text_make(a);
  uint32_t code = 0;
  for (int n; *s < end && (n = pl_utf8_decode(*s, end, &code)) > 0; *s += n) {
    char c = small_to_ascii(*s, (size_t)n, superscripts);
    if (!c) break;
    pl_text_add_n(&digits, &c, 1);
  }
  return digits.n ? pl_box_text(a, PL_B_NUMBER, pl_text_string(&digits)) : NULL;
}

static pl_box* take_sign(pl_arena* a, const char** s, const char* end) {
  uint32_t code = 0;
  int n = pl_utf8_decode(*s, end, &code);
  if (n <= 0) n = 1;
  const char* text = pl_copy_n(a, *s, (size_t)n);
  *s += n;
  if (code < 128 && isdigit((int)code)) return pl_box_text(a, PL_B_NUMBER, text);
  bool infix = code < 128 && code && strchr("+=<>", (int)code);
  return pl_box_op(a, text, code == ',' ? PL_OP_COMMA : infix ? PL_OP_INFIX : PL_OP_TIGHT);
}

// A name that is not a symbol. In a line it stays as it is; elsewhere its parts are set like
// symbols.
pl_box* pl_box_free_name(pl_arena* a, const char* text, pl_notation how) {
  if (!text) text = "?";
  if (how.math == PL_MATH_LINE || how.math == PL_MATH_ASCII) {
    pl_text ascii = pl_text_make(a);
    if (how.math == PL_MATH_ASCII) pl_write_ascii(&ascii, text);
    pl_box* b = pl_box_text(a, PL_B_NAME,
                            how.math == PL_MATH_ASCII ? pl_text_string(&ascii) : text);
    b->free_name = true;
    return b;
  }
  PL_VEC(pl_box*) parts = {0};
  const char *s = text, *end = text + strlen(text);
  while (s < end) {
    uint32_t code = 0;
    int n = pl_utf8_decode(s, end, &code);
    if (n > 0 && is_letter(code)) {
      pl_push(a, parts, take_identifier(a, &s, end, how));
    } else if (*s == ' ') {
      s++;
    } else {
      pl_box* raised = take_superscript(a, &s, end);
      if (raised && parts.n > 0) {
        pl_box* power = pl_box_make(a, PL_B_POWER, PL_LEVEL_POWER, 2);
        power->at[0] = parts.at[parts.n - 1];
        power->at[1] = raised;
        parts.at[parts.n - 1] = power;
      } else {
        pl_push(a, parts, raised ? raised : take_sign(a, &s, end));
      }
    }
  }
  if (parts.n == 1) return parts.at[0];
  pl_box* row = pl_box_make(a, PL_B_ROW, PL_LEVEL_ATOM, parts.n);
  for (int i = 0; i < parts.n; i++) row->at[i] = parts.at[i];
  return row;
}
