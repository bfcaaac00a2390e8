// Boxes -> a picture of several lines: stacked fractions, drawn roots, dots over letters, raised
// exponents.
//
// A picture is a list of rows of equal width in cells, with a base line. Pictures are never
// changed, only combined: side by side on their base lines, or one over the other.
#include "notation_impl.h"

#include <string.h>

typedef struct picture {
  int width, height, base;  // base: index of the row that carries the line of writing
  const char** row;         // (height), each `width` cells wide
} picture;

static picture draw(pl_arena* a, const pl_box* b);

// --------------------------------------------------------------------------------------- combining
static picture blank(pl_arena* a, int width, int height, int base) {
  picture p = {width, height, base, PL_ARRAY(a, const char*, height)};
  pl_text t = pl_text_make(a);
  pl_text_pad(&t, width);
  for (int i = 0; i < height; i++) p.row[i] = pl_text_string(&t);
  return p;
}

static picture text(pl_arena* a, const char* s) {
  picture p = blank(a, 0, 1, 0);
  p.width = pl_utf8_width(s);
  p.row[0] = s;
  return p;
}

static picture beside_n(pl_arena* a, const picture* parts, int n) {
  int above = 0, below = 0, width = 0;
  for (int i = 0; i < n; i++) {
    if (parts[i].base > above) above = parts[i].base;
    if (parts[i].height - parts[i].base - 1 > below) below = parts[i].height - parts[i].base - 1;
    width += parts[i].width;
  }
  picture r = blank(a, width, above + below + 1, above);
  for (int y = 0; y < r.height; y++) {
    pl_text t = pl_text_make(a);
    for (int i = 0; i < n; i++) {
      int k = y - above + parts[i].base;
      if (k >= 0 && k < parts[i].height) pl_text_add(&t, parts[i].row[k]);
      else pl_text_pad(&t, parts[i].width);
    }
    r.row[y] = pl_text_string(&t);
  }
  return r;
}

static picture beside(pl_arena* a, picture l, picture r) {
  return beside_n(a, (picture[]){l, r}, 2);
}

// The same picture in the middle of a wider one.
static picture centred(pl_arena* a, picture p, int width) {
  if (width <= p.width) return p;
  int left = (width - p.width) / 2;
  picture r = blank(a, width, p.height, p.base);
  for (int y = 0; y < p.height; y++) {
    pl_text t = pl_text_make(a);
    pl_text_pad(&t, left);
    pl_text_add(&t, p.row[y]);
    pl_text_pad(&t, width - left - p.width);
    r.row[y] = pl_text_string(&t);
  }
  return r;
}

// top over bottom; the base line is that of row `base` of the whole.
static picture over(pl_arena* a, picture top, picture bottom, int base) {
  int width = top.width > bottom.width ? top.width : bottom.width;
  top = centred(a, top, width);
  bottom = centred(a, bottom, width);
  picture r = blank(a, width, top.height + bottom.height, base);
  memcpy(r.row, top.row, (size_t)top.height * sizeof *r.row);
  memcpy(r.row + top.height, bottom.row, (size_t)bottom.height * sizeof *r.row);
  return r;
}

static const char* repeat(pl_arena* a, const char* s, int n) {
  pl_text t = pl_text_make(a);
  for (int i = 0; i < n; i++) pl_text_add(&t, s);
  return pl_text_string(&t);
}

// ------------------------------------------------------------------------------------------- names
// Length in bytes of the last letter of s.
static size_t last_letter(const char* s) {
  size_t n = strlen(s), k = n;
  while (k > 0 && ((unsigned char)s[k - 1] & 0xC0) == 0x80) k--;
  return k > 0 ? n - k + 1 : n;
}

// Letters that exist with their dots; for all others a combining sign follows the letter.
static const char* dotted(pl_arena* a, const char* letter, int dots) {
  static const char* const table[][3] = {
      {"x", "ẋ", "ẍ"},  {"y", "ẏ", "ÿ"},  {"z", "ż", NULL},  {"r", "ṙ", NULL}, {"s", "ṡ", NULL},
      {"a", "ȧ", "ä"},  {"h", "ḣ", "ḧ"},  {"u", NULL, "ü"},  {"w", "ẇ", "ẅ"},  {"X", "Ẋ", "Ẍ"},
      {"Y", "Ẏ", "Ÿ"},  {"e", "ė", "ë"},  {"o", "ȯ", "ö"},   {"b", "ḃ", NULL}, {"c", "ċ", NULL},
      {"d", "ḋ", NULL}, {"f", "ḟ", NULL}, {"g", "ġ", NULL},  {"m", "ṁ", NULL}, {"n", "ṅ", NULL},
      {"p", "ṗ", NULL}, {"t", "ṫ", "ẗ"},  {"v", NULL, NULL},
  };
  for (size_t i = 0; i < sizeof table / sizeof *table; i++)
    if (strcmp(table[i][0], letter) == 0 && table[i][dots]) return table[i][dots];
  return pl_format(a, "%s%s", letter, dots == 1 ? "\u0307" : "\u0308");
}

// ẋ₁ where one letter carries the dots, alpha' where a word does.
static const char* name_text(pl_arena* a, const pl_box* b) {
  pl_text t = pl_text_make(a);
  bool letter = last_letter(b->text) == strlen(b->text);
  bool over_letter = letter && (b->dots == 1 || b->dots == 2);
  pl_text_add(&t, over_letter ? dotted(a, b->text, b->dots) : b->text);
  if (b->sub) {
    const char* small = pl_subscript(a, b->sub);
    if (small) pl_text_add(&t, small);
    else pl_text_addf(&t, "_%s", b->sub);
  }
  for (int i = 0; !over_letter && i < b->dots; i++) pl_text_add(&t, "'");
  return pl_text_string(&t);
}

static picture draw_indexed(pl_arena* a, const pl_box* b) {
  picture parts[] = {text(a, name_text(a, b)), text(a, "["), draw(a, b->at[0]), text(a, "]")};
  return beside_n(a, parts, 4);
}

// ---------------------------------------------------------------------------------------- brackets
static picture column(pl_arena* a, picture like, const char* const sign[4]) {
  // sign: alone, top, middle, bottom
  if (like.height == 1) return text(a, sign[0]);
  picture p = blank(a, 1, like.height, like.base);
  for (int y = 0; y < p.height; y++)
    p.row[y] = y == 0 ? sign[1] : y == p.height - 1 ? sign[3] : sign[2];
  return p;
}

static picture draw_fence(pl_arena* a, const pl_box* b) {
  static const char* const left[] = {"(", "⎛", "⎜", "⎝"};
  static const char* const right[] = {")", "⎞", "⎟", "⎠"};
  static const char* const bar[] = {"|", "│", "│", "│"};
  bool bars = strcmp(b->text, "|") == 0;
  picture in = draw(a, b->at[0]);
  picture parts[] = {column(a, in, bars ? bar : left), in, column(a, in, bars ? bar : right)};
  return beside_n(a, parts, 3);
}

// --------------------------------------------------------------------------- fraction, root, power
static picture draw_fraction(pl_arena* a, const pl_box* b) {
  picture num = draw(a, b->at[0]), den = draw(a, b->at[1]);
  int width = (num.width > den.width ? num.width : den.width) + 2;
  picture bar = text(a, repeat(a, "─", width));
  picture top = over(a, num, bar, 0);
  return over(a, top, den, num.height);
}

//    ┌───────────       for one line:   ______
//    │ 2 (E - V)                       √l² - x²
//  ╲ │ ─────────
//   ╲│     M
static picture draw_root(pl_arena* a, const pl_box* b) {
  picture in = draw(a, b->at[0]);
  if (in.height == 1 && in.width <= 2) return beside(a, text(a, "√"), in);
  if (in.height == 1) {
    picture roof = text(a, repeat(a, "_", in.width));
    return beside(a, text(a, "√"), over(a, roof, in, 1));
  }
  picture stem = blank(a, 3, in.height, in.base);
  for (int y = 0; y < in.height; y++)
    stem.row[y] = y == in.height - 1 ? " ╲│" : y == in.height - 2 ? "╲ │" : "  │";
  picture roof = text(a, repeat(a, "─", in.width + 1));
  picture lid = beside(a, text(a, "  ┌"), roof);
  picture body = beside(a, stem, beside(a, blank(a, 1, 1, 0), in));
  return over(a, lid, body, in.base + 1);
}

// r², (...)² with the digit at the upper end of a tall bracket, e^(-γ t) with the exponent on a
// line of its own.
static picture draw_power(pl_arena* a, const pl_box* b) {
  picture base = draw(a, b->at[0]), exponent = draw(a, b->at[1]);
  const char* small = exponent.height == 1 ? pl_superscript(a, exponent.row[0]) : NULL;
  if (!small && exponent.height == 1 && strncmp(exponent.row[0], "−", strlen("−")) == 0)
    small = pl_superscript(a, pl_format(a, "-%s", exponent.row[0] + strlen("−")));
  if (small) {
    picture e = text(a, small);
    e.base = 0;
    picture top = blank(a, e.width, base.height, base.base);
    top.row[0] = small;
    return beside(a, base, top);
  }
  int height = exponent.height + base.height;
  picture up = blank(a, exponent.width, height, exponent.height + base.base);
  memcpy(up.row, exponent.row, (size_t)exponent.height * sizeof *up.row);
  return beside(a, base, up);
}

// -------------------------------------------------------------------------------------------- rows
static picture draw_op(pl_arena* a, const pl_box* b) {
  const char* s = b->text;
  if (strcmp(s, "-") == 0) s = "−";
  if (strcmp(s, "->") == 0) s = "→";
  if (b->role == PL_OP_INFIX) s = pl_format(a, " %s ", s);
  if (b->role == PL_OP_COMMA) s = pl_format(a, "%s ", s);
  return text(a, s);
}

static bool is_tight(const pl_box* b) { return b->kind == PL_B_OP && b->role == PL_OP_TIGHT; }

static picture draw_row(pl_arena* a, const pl_box* b) {
  picture* parts = PL_ARRAY(a, picture, 2 * b->n);
  int n = 0;
  for (int i = 0; i < b->n; i++) {
    bool gap = b->kind == PL_B_PRODUCT && i > 0 && !is_tight(b->at[i]) && !is_tight(b->at[i - 1]);
    // "− ─────": a sign before a fraction stands off
    gap |= i > 0 && b->at[i - 1]->kind == PL_B_OP && b->at[i - 1]->role == PL_OP_PREFIX
           && b->at[i]->tall;
    if (gap) parts[n++] = text(a, " ");
    parts[n++] = draw(a, b->at[i]);
  }
  return beside_n(a, parts, n);
}

static picture draw_apply(pl_arena* a, const pl_box* b) {
  picture head = draw(a, b->at[0]), argument = draw(a, b->at[1]);
  if (b->at[1]->kind == PL_B_FENCE || b->at[0]->kind == PL_B_POWER)
    return beside(a, head, argument);
  return beside_n(a, (picture[]){head, text(a, " "), argument}, 3);
}

static picture draw_sum_over(pl_arena* a, const pl_box* b) {
  picture from = beside_n(a, (picture[]){draw(a, b->at[0]), text(a, "="), draw(a, b->at[1])}, 3);
  picture sign = over(a, draw(a, b->at[2]), text(a, "Σ"), 0);
  int base = sign.height - 1;
  sign = over(a, sign, from, base);
  return beside_n(a, (picture[]){sign, text(a, " "), draw(a, b->at[3])}, 3);
}

static picture draw_cases(pl_arena* a, const pl_box* b) {
  picture parts[] = {text(a, "if "),    draw(a, b->at[0]),  text(a, ": "),
                     draw(a, b->at[1]), text(a, "; else "), draw(a, b->at[2])};
  return beside_n(a, parts, 6);
}

static picture draw(pl_arena* a, const pl_box* b) {
  switch (b->kind) {
    case PL_B_NAME: return text(a, name_text(a, b));
    case PL_B_VECTOR: return text(a, pl_format(a, "%s_%s", b->text, b->sub ? b->sub : ""));
    case PL_B_INDEXED: return draw_indexed(a, b);
    case PL_B_NUMBER:
    case PL_B_WORD:
    case PL_B_PROSE: return text(a, b->text);
    case PL_B_UNIT: return text(a, pl_format(a, " %s", b->text));
    case PL_B_OP: return draw_op(a, b);
    case PL_B_ROW:
    case PL_B_PRODUCT: return draw_row(a, b);
    case PL_B_FRACTION: return draw_fraction(a, b);
    case PL_B_ROOT: return draw_root(a, b);
    case PL_B_POWER: return draw_power(a, b);
    case PL_B_APPLY: return draw_apply(a, b);
    case PL_B_FENCE: return draw_fence(a, b);
    case PL_B_SUM_OVER: return draw_sum_over(a, b);
    case PL_B_CASES: return draw_cases(a, b);
  }
  return text(a, "?");
}

const char* pl_write_2d(pl_arena* a, const pl_box* b, int* above, int* below) {
  picture p = draw(a, b);
  *above = p.base;
  *below = p.height - 1 - p.base;
  pl_text t = pl_text_make(a);
  for (int y = 0; y < p.height; y++) {
    size_t n = strlen(p.row[y]);
    while (n > 0 && p.row[y][n - 1] == ' ') n--;  // no blanks at the ends of lines
    if (y) pl_text_add(&t, "\n");
    pl_text_add_n(&t, p.row[y], n);
  }
  return pl_text_string(&t);
}
