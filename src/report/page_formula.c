// Formulas that are wider than the page. In line notation a string is broken before a relation, a +
// or a -, if need be before a / or a bracket, the outermost ones first, and goes on with hanging
// indent behind the first relation. In two dimensions the form itself is taken apart at the same
// places, the parts are drawn and set side by side on a common base line.
#include "report_impl.h"

#include <string.h>

// cells: a left side up to this width is kept clear by the lines that follow
enum { PL_LEFT_SIDE = 14 };
// What a break costs against a line filled to the end: a level of brackets, a fraction or a product
// torn apart.
static const double pl_depth_price = 0.6, pl_slash_price = 0.2, pl_factor_price = 0.45;

// ---------------------------------------------------------------------------------------- one line
typedef struct pl_break {
  size_t at;     // byte where the next line would begin
  int cells;     // width of what comes before it
  int depth;     // brackets around it
  double price;  // of breaking here
  bool relation;
  bool torn;  // a product or fraction goes on
} pl_break;

static const char* const pl_relations[] = {"= ", "≥ ", "≤ ", ">= ", "<= ", "-> ",
                                           "→ ", "< ", "> ", "≈ ",  "≠ ",  NULL};

static bool pl_starts(const char* s, const char* with) {
  return strncmp(s, with, strlen(with)) == 0;
}

static bool pl_is_relation_at(const char* s) {
  for (int i = 0; pl_relations[i]; i++)
    if (pl_starts(s, pl_relations[i])) return true;
  return false;
}

static bool pl_is_sign_at(const char* s) {
  return pl_starts(s, "+ ") || pl_starts(s, "- ") || pl_starts(s, "− ") || pl_starts(s, "± ");
}

typedef PL_VEC(pl_break) pl_breaks;

// Relations, signs and commas cost nothing; -1: no place for a break.
static double pl_price_at(const char* s, size_t i) {
  if (pl_is_relation_at(s + i) || pl_is_sign_at(s + i) || (i >= 2 && s[i - 2] == ',')) return 0;
  if (pl_starts(s + i, "/ ")) return pl_slash_price;
  bool factor = s[i] == '(' || pl_starts(s + i, "√(") || pl_starts(s + i, "sqrt(");
  bool after_operator = i >= 2 && strchr("+-=/<>", s[i - 2]);
  return factor && !after_operator ? pl_factor_price : -1;
}

// All places where the string may be broken, in order.
static pl_breaks pl_find_breaks(pl_arena* a, const char* s) {
  pl_breaks list = {0};
  int depth = 0;
  for (size_t i = 0; s[i]; i++) {
    if (s[i] == '(' || s[i] == '[') depth++;
    if ((s[i] == ')' || s[i] == ']') && depth > 0) depth--;
    if (i == 0 || s[i - 1] != ' ') continue;
    double price = pl_price_at(s, i);
    if (price < 0) continue;
    int around = s[i] == '(' ? depth - 1 : depth;
    pl_break b = {i,
                  pl_utf8_width_n(s, i),
                  around,
                  price + pl_depth_price * around,
                  pl_is_relation_at(s + i),
                  price > 0};
    pl_push(a, list, b);
  }
  return list;
}

// Where lines after the first begin: behind the first relation when its left side is short.
static int pl_hang_of(const pl_breaks* b) {
  for (int i = 0; i < b->n; i++) {
    if (b->at[i].relation && b->at[i].depth == 0)
      return b->at[i].cells <= PL_LEFT_SIDE ? b->at[i].cells : 2;
  }
  return 2;
}

// The break that ends the line which began at `from`, or -1: the rest fits, or cannot be broken.
static int pl_best_break(const pl_breaks* b, size_t from, int from_cells, int total, int room) {
  if (total - from_cells <= room) return -1;
  int best = -1, first_relation = -1;
  double best_score = -1e9;
  for (int i = 0; i < b->n; i++) {
    const pl_break* k = &b->at[i];
    if (k->relation && k->depth == 0 && first_relation < 0) first_relation = i;
    if (k->at <= from) continue;
    int cells = k->cells - from_cells;
    if (cells > room && best >= 0) break;
    double score = (double)cells / room - k->price;
    if (k->relation && i != first_relation) score += 1;  // a chain a = b = c: one link a line
    if (i == first_relation && cells <= PL_LEFT_SIDE) score -= 1;
    if (score >= best_score) {
      best = i;
      best_score = score;
    }
  }
  return best;
}

static void pl_add_line(pl_page* g, pl_lines* out, const char* s) {
  const char** more = PL_ARRAY(g->arena, const char*, out->n + 1);
  for (int i = 0; i < out->n; i++) more[i] = out->at[i];
  more[out->n++] = s;
  out->at = more;
  int width = pl_utf8_width(s);
  if (width > out->width) out->width = width;
}

static const char* pl_slice(pl_page* g, const char* s, size_t from, size_t to, int indent) {
  while (to > from && s[to - 1] == ' ') to--;
  pl_text line = pl_text_make(g->arena);
  pl_text_pad(&line, indent);
  pl_text_add_n(&line, s + from, to - from);
  return pl_text_string(&line);
}

static pl_lines pl_break_line(pl_page* g, const char* s, int width) {
  pl_lines out = {0};
  pl_breaks breaks = pl_find_breaks(g->arena, s);
  int hang = pl_hang_of(&breaks), total = pl_utf8_width(s);
  size_t from = 0;
  int cells = 0, indent = 0;
  for (;;) {
    int k = pl_best_break(&breaks, from, cells, total, width - indent > 1 ? width - indent : 1);
    size_t to = k < 0 ? strlen(s) : breaks.at[k].at;
    pl_add_line(g, &out, pl_slice(g, s, from, to, indent));
    if (k < 0) break;
    const pl_break* b = &breaks.at[k];
    indent = hang + (b->relation ? 0 : b->torn ? 4 : 2) + 2 * b->depth;
    from = b->at;
    cells = b->cells;
  }
  out.base = out.n - 1;
  return out;
}

// ---------------------------------------------------------------------------------- two dimensions
static pl_lines pl_split_lines(pl_page* g, const char* s, int base) {
  pl_lines out = {.base = base};
  for (;;) {
    size_t n = strcspn(s, "\n");
    pl_add_line(g, &out, pl_copy_n(g->arena, s, n));
    if (!s[n]) break;
    s += n + 1;
  }
  return out;
}

static pl_lines pl_draw(pl_page* g, const pl_form* f) {
  int above = 0, below = 0;
  const char* s = pl_notation_print_2d(g->arena, g->pool, f, g->how, &above, &below);
  pl_lines out = pl_split_lines(g, s, above);
  if (out.base >= out.n) out.base = out.n - 1;
  return out;
}

// a, then the sign, then b, on one base line.
static pl_lines pl_beside(pl_page* g, pl_lines a, const char* sign, pl_lines b) {
  int above = a.base > b.base ? a.base : b.base;
  int below_a = a.n - 1 - a.base, below_b = b.n - 1 - b.base;
  int n = above + 1 + (below_a > below_b ? below_a : below_b);
  pl_lines out = {.base = above};
  for (int i = 0; i < n; i++) {
    int ia = i - above + a.base, ib = i - above + b.base;
    const char* left = ia >= 0 && ia < a.n ? a.at[ia] : "";
    const char* right = ib >= 0 && ib < b.n ? b.at[ib] : "";
    pl_text line = pl_text_make(g->arena);
    pl_text_add(&line, left);
    if (*right || i == above) {
      pl_text_pad(&line, a.width - pl_utf8_width(left));
      if (i == above) pl_text_add(&line, sign);
      else pl_text_pad(&line, pl_utf8_width(sign));
      pl_text_add(&line, right);
    }
    pl_add_line(g, &out, pl_text_string(&line));
  }
  return out;
}

static pl_lines pl_below(pl_page* g, pl_lines a, int indent, pl_lines b) {
  int last = a.n;
  for (int i = 0; i < b.n; i++)
    pl_add_line(g, &a, pl_slice(g, b.at[i], 0, strlen(b.at[i]), indent));
  a.base = last + b.base;
  return a;
}

// A part of a formula and the sign in front of it.
typedef struct pl_part {
  const char* sign;
  const pl_form* form;
  bool relation;
} pl_part;
typedef PL_VEC(pl_part) pl_parts;

static void pl_take_apart(pl_page* g, pl_parts* out, const char* sign, const pl_form* f,
                          bool relation) {
  if (f->kind == PL_F_RELATION) {
    pl_take_apart(g, out, sign, f->args[0], relation);
    pl_take_apart(g, out, pl_format(g->arena, " %s ", f->text), f->args[1], true);
    return;
  }
  if (f->kind != PL_F_SUM || f->n < 2) {
    pl_part p = {sign, f, relation};
    pl_push(g->arena, *out, p);
    return;
  }
  for (int i = 0; i < f->n; i++) {
    const pl_form* t = f->args[i];
    bool minus = i > 0 && t->kind == PL_F_NEG && t->args[0]->kind != PL_F_SUM;
    pl_part p = {i == 0 ? sign : minus ? " − " : " + ", minus ? t->args[0] : t, i == 0 && relation};
    pl_push(g->arena, *out, p);
  }
}

static pl_lines pl_break_drawing(pl_page* g, const pl_form* f, int width) {
  pl_parts parts = {0};
  pl_take_apart(g, &parts, "", f, false);
  pl_lines done = {0}, row = {0};
  int indent = 0, hang = 2;
  for (int i = 0; i < parts.n; i++) {
    const pl_part* p = &parts.at[i];
    pl_lines part = pl_draw(g, p->form);
    if (p->relation && i == 1 && row.width <= PL_LEFT_SIDE) hang = row.width;
    bool fits = row.n == 0 || indent + row.width + pl_utf8_width(p->sign) + part.width <= width;
    if (fits) {
      row = row.n == 0 ? part : pl_beside(g, row, p->sign, part);
      continue;
    }
    done = done.n ? pl_below(g, done, indent, row) : row;
    row = pl_beside(g, (pl_lines){.at = (const char*[]){""}, .n = 1}, p->sign + (*p->sign == ' '),
                    part);
    indent = hang + (p->relation ? 1 : 3);
  }
  return done.n ? pl_below(g, done, indent, row) : row;
}

// -------------------------------------------------------------------------------------------- both
static pl_lines pl_formula_in(pl_page* g, const pl_form* f, int width) {
  if (g->how.math == PL_MATH_2D) {
    pl_lines whole = pl_draw(g, f);
    return whole.width <= width ? whole : pl_break_drawing(g, f, width);
  }
  const char* s = pl_page_plain(g, pl_notation_print(g->arena, g->pool, f, g->how));
  return pl_utf8_width(s) <= width ? pl_split_lines(g, s, 0) : pl_break_line(g, s, width);
}

// Only the base line has to leave room at the margin; when it does not, all lines are set narrower.
pl_lines pl_page_formula(pl_page* g, const pl_form* f, int width, int right) {
  if (!f || !g->pool) return pl_split_lines(g, "", 0);
  pl_lines lines = pl_formula_in(g, f, width);
  bool fits = right == 0 || width - pl_utf8_width(lines.at[lines.base]) >= right + 2;
  return fits || width <= right + 3 ? lines : pl_formula_in(g, f, width - right - 2);
}
