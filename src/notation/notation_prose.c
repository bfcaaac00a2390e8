// Sentences as LaTeX text: what TeX reserves is escaped, Greek letters and mathematical signs
// become math, what the usual fonts have stays as it is, anything else is named by its code point.
// So no text of a model can be read as a command.
#include "notation_impl.h"

#include <string.h>

// Characters that LaTeX text writes differently.
static const struct {
  uint32_t code;
  const char* tex;
} signs[] = {
    {'\\', "\\textbackslash{}"},
    {'^', "\\textasciicircum{}"},
    {'~', "\\textasciitilde{}"},
    {'<', "$<$"},
    {'>', "$>$"},
    {'|', "$|$"},
    {'"', "{''}"},
    {'`', "{`}"},
    {'-', "{-}"},
    {'\t', " "},
    {'\n', " "},
    {0xA0, "~"},
    {0xB0, "${}^{\\circ}$"},
    {0xB1, "$\\pm$"},
    {0xB2, "$^{2}$"},
    {0xB3, "$^{3}$"},
    {0xB7, "$\\cdot$"},
    {0xB9, "$^{1}$"},
    {0xD7, "$\\times$"},
    {0x2011, "-"},
    {0x2013, "--"},
    {0x2014, "---"},
    {0x2018, "`"},
    {0x2019, "'"},
    {0x201A, "{,}"},
    {0x201C, "``"},
    {0x201D, "''"},
    {0x201E, "{,}{,}"},
    {0x2026, "\\dots{}"},
    {0x2032, "$'$"},
    {0x2033, "$''$"},
    {0x2070, "$^{0}$"},
    {0x207B, "$^{-}$"},
    {0x2192, "$\\to$"},
    {0x2202, "$\\partial$"},
    {0x2207, "$\\nabla$"},
    {0x2212, "$-$"},
    {0x221A, "$\\surd$"},
    {0x221E, "$\\infty$"},
    {0x222B, "$\\int$"},
    {0x2248, "$\\approx$"},
    {0x2260, "$\\ne$"},
    {0x2264, "$\\le$"},
    {0x2265, "$\\ge$"},
    {0x2211, "$\\sum$"},
    {0x226A, "$\\ll$"},
    {0x226B, "$\\gg$"},
};

static const char* sign_of(uint32_t code) {
  for (size_t i = 0; i < sizeof signs / sizeof *signs; i++) {
    if (signs[i].code == code) return signs[i].tex;
  }
  return NULL;
}

static void write_character(pl_text* out, uint32_t code, const char* at, size_t n) {
  const char* sign = sign_of(code);
  const char* greek = pl_greek_tex(code);
  bool small = code >= 0x2074 && code <= 0x2079, low = code >= 0x2080 && code <= 0x2089;
  bool latin = code >= 0xC0 && code <= 0x17F;
  if (sign) pl_text_add(out, sign);
  else if (greek) pl_text_addf(out, "$%s$", greek);
  else if (small) pl_text_addf(out, "$^{%c}$", (char)('0' + (code - 0x2070)));
  else if (low) pl_text_addf(out, "$_{%c}$", (char)('0' + (code - 0x2080)));
  else if (code < 32) pl_text_add(out, " ");
  else if (code < 127 && strchr("#$%&_{}", (int)code)) pl_text_addf(out, "\\%c", (char)code);
  else if (code < 127 || latin) pl_text_add_n(out, at, n);
  else pl_text_addf(out, "[U+%04X]", (unsigned)code);
}

void pl_notation_words(pl_text* out, const char* words) {
  const char* end = words + strlen(words);
  for (const char* s = words; s < end;) {
    uint32_t code = 0;
    int n = pl_utf8_decode(s, end, &code);
    if (n <= 0) {
      n = 1;
      code = '?';
    }
    // a hyphen between letters stays one, two in a row must not become a dash
    bool hyphen = code == '-' && !(s > words && s[-1] == '-') && s[1] != '-';
    if (hyphen) pl_text_add(out, "-");
    else write_character(out, code, s, (size_t)n);
    s += n;
  }
}
