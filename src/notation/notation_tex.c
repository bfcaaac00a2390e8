// Boxes -> LaTeX with amsmath.  \left and \right only around what is higher than a line.
#include "notation_impl.h"

#include <string.h>

static void write_box(pl_text* out, const pl_box* b);

// One UTF-8 text in math mode: Greek letters by name, signs that TeX reserves escaped, words
// upright.
static void write_letters(pl_text* out, const char* s) {
  const char* end = s + strlen(s);
  while (s < end) {
    uint32_t code = 0;
    int n = pl_utf8_decode(s, end, &code);
    if (n <= 0) {
      n = 1;
      code = '?';
    }
    const char* tex = pl_greek_tex(code);
    if (tex) {
      pl_text_add(out, tex);
      if (s + n < end) pl_text_add(out, " ");
    } else if (code == 0xB2 || code == 0xB3) {
      pl_text_addf(out, "^{%c}", code == 0xB2 ? '2' : '3');
    } else if (code == 0xB0) {
      pl_text_add(out, "^{\\circ}");
    } else if (code < 128 && code && strchr("#$%&_{}", (int)code)) {
      pl_text_addf(out, "\\%c", (char)code);
    } else if (code == '\\' || code == '^' || code == '~') {
      pl_text_add(out, "\\mathord{?}");
    } else {
      pl_text_add_n(out, s, (size_t)n);
    }
    s += n;
  }
}

static bool is_word(const char* s) {
  size_t n = strlen(s), ascii = 0;
  for (const char* c = s; *c; c++) ascii += (unsigned char)*c < 128;
  return n > 1 && ascii == n;
}

// "theta" as a name is the letter.
static const char* greek_word(const char* s) {
  static const uint32_t first = 0x391, last = 0x3C9;
  if (!is_word(s)) return NULL;
  for (uint32_t code = first; code <= last; code++) {
    const char* name = pl_greek_ascii(code);
    if (name && strcmp(name, s) == 0) return pl_greek_tex(code);
  }
  return NULL;
}

static void write_stem(pl_text* out, const char* s, int dots) {
  static const char* const accent[] = {"", "\\dot", "\\ddot", "\\dddot"};
  pl_text_add(out, accent[dots < 0 ? 0 : dots > 3 ? 3 : dots]);
  if (dots > 0) pl_text_add(out, "{");
  const char* greek = greek_word(s);
  if (greek) pl_text_add(out, greek);
  else if (is_word(s)) {
    pl_text_add(out, "\\mathit{");
    write_letters(out, s);
    pl_text_add(out, "}");
  } else write_letters(out, s);
  if (dots > 0) pl_text_add(out, "}");
}

// "g1": one letter and its number, an index of its own inside the index.
static bool is_numbered_letter(const char* s) {
  size_t digits = strspn(s + 1, "0123456789");
  return is_word(s) && digits > 0 && strlen(s) == 1 + digits && !strchr("0123456789", s[0]);
}

static void write_index(pl_text* out, const char* s) {
  if (is_numbered_letter(s)) {
    pl_text_addf(out, "%c_{%s}", s[0], s + 1);
  } else if (is_word(s) && strspn(s, "0123456789") != strlen(s)) {
    const char* greek = greek_word(s);
    if (greek) pl_text_add(out, greek);
    else {
      pl_text_add(out, "\\mathrm{");
      write_letters(out, s);
      pl_text_add(out, "}");
    }
  } else {
    write_letters(out, s);
  }
}

static void write_name(pl_text* out, const pl_box* b) {
  if (strcmp(b->text, "∞") == 0) {
    pl_text_add(out, "\\infty");
    return;
  }
  if (b->arrow) pl_text_add(out, "\\vec{");
  write_stem(out, b->text, b->dots);
  if (b->arrow) pl_text_add(out, "}");
  if (!b->sub && b->kind != PL_B_INDEXED) return;
  pl_text_add(out, "_{");
  if (b->sub) write_index(out, b->sub);
  if (b->sub && b->n) pl_text_add(out, ",");
  if (b->n) write_box(out, b->at[0]);
  pl_text_add(out, "}");
}

static void write_op(pl_text* out, const pl_box* b) {
  static const char* const table[][2] = {
      {"·", "\\cdot"},    {"±", "\\pm"},        {"≥", "\\ge"}, {"≤", "\\le"},  {"≠", "\\ne"},
      {"≈", "\\approx"},  {"->", "\\to"},       {"→", "\\to"}, {"∫", "\\int"}, {"∇", "\\nabla"},
      {"∂", "\\partial"}, {"d", "\\mathrm{d}"}, {"%", "\\%"},  {"−", "-"},     {"∞", "\\infty"},
      {"in", "\\in"},     {"&", "\\&"},         {"#", "\\#"},  {"_", "\\_"},   {"√", "\\surd"},
      {"°", "^{\\circ}"}, {"≫", "\\gg"},        {"≪", "\\ll"},
  };
  const char* s = b->text;
  for (size_t i = 0; i < sizeof table / sizeof *table; i++)
    if (strcmp(table[i][0], s) == 0) s = table[i][1];
  bool command = s[0] == '\\' && s[strlen(s) - 1] != '}' && s[1] != '%';
  if (b->role == PL_OP_INFIX) pl_text_addf(out, " %s ", s);
  else if (b->role == PL_OP_COMMA) pl_text_addf(out, "%s ", s);
  else pl_text_addf(out, "%s%s", s, command ? " " : "");
}

// After a function without brackets the next factor stands off, unless TeX does so by itself.
static bool needs_space(const pl_box* left, const pl_box* right) {
  bool bare = left->kind == PL_B_APPLY && left->at[1]->kind != PL_B_FENCE;
  bool operator= left->kind == PL_B_OP && left->role == PL_OP_PREFIX;  // ∫
  bool differential = left->kind == PL_B_ROW && left->level == PL_LEVEL_ATOM
                      && left->at[0]->kind == PL_B_OP;
  bool vector = right->kind == PL_B_VECTOR;
  return ((bare || vector) && right->kind != PL_B_APPLY) || operator|| differential;
}

static void write_product(pl_text* out, const pl_box* b) {
  for (int i = 0; i < b->n; i++) {
    bool spaced = out->n > 0 && out->at[out->n - 1] == ' ';
    if (i > 0 && needs_space(b->at[i - 1], b->at[i])) pl_text_add(out, "\\, ");
    else if (i > 0 && !spaced) pl_text_add(out, " ");
    write_box(out, b->at[i]);
  }
}

static void write_fence(pl_text* out, const pl_box* b) {
  bool bars = strcmp(b->text, "|") == 0, tall = b->at[0]->tall;
  pl_text_add(out, bars ? (tall ? "\\left|" : "\\lvert ") : (tall ? "\\left(" : "("));
  write_box(out, b->at[0]);
  pl_text_add(out, bars ? (tall ? "\\right|" : "\\rvert ") : (tall ? "\\right)" : ")"));
}

static void write_apply(pl_text* out, const pl_box* b) {
  write_box(out, b->at[0]);
  if (b->at[1]->kind != PL_B_FENCE) pl_text_add(out, " ");
  write_box(out, b->at[1]);
}

static void write_braced(pl_text* out, const char* command, const pl_box* b) {
  pl_text_addf(out, "%s{", command);
  write_box(out, b);
  pl_text_add(out, "}");
}

static void write_sum_over(pl_text* out, const pl_box* b) {
  pl_text_add(out, "\\sum_{");
  write_box(out, b->at[0]);
  pl_text_add(out, "=");
  write_box(out, b->at[1]);
  write_braced(out, "}^", b->at[2]);
  pl_text_add(out, " ");
  write_box(out, b->at[3]);
}

static void write_cases(pl_text* out, const pl_box* b) {
  pl_text_add(out, "\\begin{cases}");
  write_box(out, b->at[1]);
  pl_text_add(out, " & ");
  write_box(out, b->at[0]);
  pl_text_add(out, " \\\\ ");
  write_box(out, b->at[2]);
  pl_text_add(out, " & \\text{else}\\end{cases}");
}

static void write_prose(pl_text* out, const char* s) {
  pl_text_add(out, "\\text{");
  for (; *s; s++) {
    if (strchr("#$%&_{}", *s)) pl_text_add(out, "\\");
    if (*s == '\\' || *s == '^' || *s == '~') pl_text_add(out, "?");
    else pl_text_add_n(out, s, 1);
  }
  pl_text_add(out, "}");
}

static void write_box(pl_text* out, const pl_box* b) {
  switch (b->kind) {
    case PL_B_NAME:
    case PL_B_INDEXED: write_name(out, b); break;
    case PL_B_VECTOR:
      pl_text_add(out, "\\vec{");
      write_letters(out, b->text);
      pl_text_add(out, "}_{");
      write_index(out, b->sub ? b->sub : "");
      pl_text_add(out, "}");
      break;
    case PL_B_NUMBER: pl_text_add(out, b->text); break;
    case PL_B_WORD: pl_text_add(out, b->tex ? b->tex : b->text); break;
    case PL_B_UNIT: pl_text_addf(out, "\\,%s", pl_notation_unit_tex(out->arena, b->text)); break;
    case PL_B_OP: write_op(out, b); break;
    case PL_B_PROSE: write_prose(out, b->text); break;
    case PL_B_ROW:
      for (int i = 0; i < b->n; i++) write_box(out, b->at[i]);
      break;
    case PL_B_PRODUCT: write_product(out, b); break;
    case PL_B_FRACTION:
      write_braced(out, "\\frac", b->at[0]);
      write_braced(out, "", b->at[1]);
      break;
    case PL_B_ROOT: write_braced(out, "\\sqrt", b->at[0]); break;
    case PL_B_POWER:
      write_box(out, b->at[0]);
      write_braced(out, "^", b->at[1]);
      break;
    case PL_B_APPLY: write_apply(out, b); break;
    case PL_B_FENCE: write_fence(out, b); break;
    case PL_B_SUM_OVER: write_sum_over(out, b); break;
    case PL_B_CASES: write_cases(out, b); break;
  }
}

void pl_write_tex(pl_text* out, const pl_box* b) { write_box(out, b); }
