// Formulas in a page: MathML with the LaTeX beside it, in lines of text and on lines of their own.
// A browser does not break formulas, so wide ones are taken apart here: at relations, then at the
// signs of a sum; the parts are set in rows.
#include "html_impl.h"

#include <string.h>

enum {
  PL_HTML_ROOM = 92,  // letters that fit on a line of the derivation
  PL_HTML_LEFT = 18   // a left side up to this width gets a column of its own
};

// MathML without what browsers take for granted: brackets are fences.
static const char* mathml(pl_html* h, const pl_form* f) {
  static const char given[] = "fence=\"true\" ";
  const char* s = pl_notation_print(h->arena, h->pool, f, (pl_notation){PL_MATH_MATHML, h->lang});
  pl_text out = pl_text_make(h->arena);
  for (const char* at; (at = strstr(s, given)); s = at + strlen(given))
    pl_text_add_n(&out, s, (size_t)(at - s));
  pl_text_add(&out, s);
  return pl_text_string(&out);
}

int pl_html_cells(pl_html* h, const pl_form* f) {
  int above = 0, below = 0, widest = 0;
  const char* s = pl_notation_print_2d(h->arena, h->pool, f, (pl_notation){PL_MATH_2D, h->lang},
                                       &above, &below);
  while (*s) {
    size_t n = strcspn(s, "\n");
    int width = pl_utf8_width_n(s, n);
    if (width > widest) widest = width;
    s += n + (s[n] == '\n');
  }
  return widest;
}

void pl_html_inline(pl_html* h, const pl_form* f) {
  if (!f || !h->pool) return;
  pl_html_raw(h, "<math>");
  pl_html_raw(h, mathml(h, f));
  pl_html_raw(h, "</math>");
}

void pl_html_symbol(pl_html* h, pl_symbol s) {
  pl_html_inline(h, pl_form_leaf(h->arena, pl_sym(h->pool, s)));
}

bool pl_html_ends_in(const pl_form* whole, const pl_form* part) {
  for (const pl_form* f = whole; f; f = f->kind == PL_F_RELATION ? f->args[1] : NULL)
    if (f == part) return true;
  return false;
}

// -------------------------------------------------------------------------------------------- rows
// A part of a formula: what stands in front of it, and itself.
typedef struct pl_html_part_of {
  const char* sign;  // "", a relation, "+" or "−"
  const pl_form* form;
  bool relation;
  int cells;
} pl_html_part_of;
typedef PL_VEC(pl_html_part_of) pl_html_parts;

static void add_part(pl_html* h, pl_html_parts* out, const char* sign, const pl_form* f,
                     bool relation) {
  pl_html_part_of p = {sign, f, relation, pl_html_cells(h, f) + (*sign ? 3 : 0)};
  pl_push(h->arena, *out, p);
}

static const char* relation_shown(const char* s) {
  return strcmp(s, "->") == 0 ? "→" : strcmp(s, "in") == 0 ? "∈" : s;
}

static void take_apart(pl_html* h, pl_html_parts* out, const char* sign, const pl_form* f,
                       bool relation) {
  if (f->kind == PL_F_RELATION) {
    take_apart(h, out, sign, f->args[0], relation);
    take_apart(h, out, relation_shown(f->text), f->args[1], true);
    return;
  }
  if (f->kind != PL_F_SUM || f->n < 2 || pl_html_cells(h, f) <= PL_HTML_ROOM / 2) {
    add_part(h, out, sign, f, relation);
    return;
  }
  for (int i = 0; i < f->n; i++) {
    const pl_form* t = f->args[i];
    bool minus = i > 0 && t->kind == PL_F_NEG && t->args[0]->kind != PL_F_SUM;
    add_part(h, out, i == 0 ? sign : minus ? "−" : "+", minus ? t->args[0] : t, i == 0 && relation);
  }
}

static void put_part(pl_html* h, const pl_html_part_of* p) {
  if (*p->sign) pl_html_rawf(h, "<mo form=\"infix\">%s</mo>", pl_html_escaped(h->arena, p->sign));
  pl_html_raw(h, mathml(h, p->form));
}

// Rows as long as the room allows; a chain of relations starts a row at each of them.
static int put_rows(pl_html* h, const pl_html_parts* parts) {
  bool column = parts->n > 1 && parts->at[1].relation && parts->at[0].cells <= PL_HTML_LEFT;
  int room = PL_HTML_ROOM - (column ? parts->at[0].cells : 0), used = 0, widest = 0,
      first = column ? 1 : 0;
  pl_html_raw(h, "<mtable class=\"al\" displaystyle=\"true\"><mtr>");
  if (column) {
    pl_html_raw(h, "<mtd>");
    put_part(h, &parts->at[0]);
    pl_html_raw(h, "</mtd>");
  }
  pl_html_raw(h, "<mtd><mrow>");
  for (int i = first; i < parts->n; i++) {
    const pl_html_part_of* p = &parts->at[i];
    bool starts = i > first && ((column && p->relation) || used + p->cells > room);
    if (starts) {
      pl_html_raw(h, column ? "</mrow></mtd></mtr><mtr><mtd></mtd><mtd><mrow>"
                            : "</mrow></mtd></mtr><mtr><mtd><mrow>");
      if (!p->relation || !column) pl_html_raw(h, "<mspace width=\"2em\"/>");
      used = p->relation ? 0 : 4;
    }
    put_part(h, p);
    used += p->cells;
    if (used > widest) widest = used;
  }
  pl_html_raw(h, "</mrow></mtd></mtr></mtable>");
  return widest + (column ? parts->at[0].cells : 0);
}

// The annotation is what "copy as LaTeX" copies.
void pl_html_display(pl_html* h, const pl_form* f) {
  if (!f || !h->pool) return;
  int cells = pl_html_cells(h, f);
  pl_text* page = h->out;
  pl_text body = pl_text_make(h->arena);
  h->out = &body;
  pl_html_parts parts = {0};
  if (cells > PL_HTML_ROOM) take_apart(h, &parts, "", f, false);
  if (parts.n > 1) cells = put_rows(h, &parts);
  else pl_html_rawf(h, "<mrow>%s</mrow>", mathml(h, f));
  h->out = page;
  // a formula that is still too wide is set smaller, as far as the style allows
  if (cells > PL_HTML_ROOM - 30)
    pl_html_rawf(h, "<math display=\"block\" style=\"--w:%d\">", cells);
  else pl_html_raw(h, "<math display=\"block\">");
  const char* tex = pl_notation_print(h->arena, h->pool, f, (pl_notation){PL_MATH_TEX, h->lang});
  pl_html_rawf(
      h,
      "<semantics>%s<annotation encoding=\"application/x-tex\">%s</annotation></semantics></math>",
      pl_text_string(&body), pl_html_escaped(h->arena, tex));
}

// --------------------------------------------------------------------------------------- sentences
// "(12)" when there is an equation of this number; bytes taken, 0 otherwise.
static int equation_constraint(pl_html* h, const char* s) {
  int digits = (int)strspn(s + 1, "0123456789");
  if (digits < 1 || digits > 4 || s[1 + digits] != ')') return 0;
  int number = 0;
  for (int i = 1; i <= digits; i++) number = 10 * number + (s[i] - '0');
  if (number < 1 || number > h->s->n_equations) return 0;
  pl_html_rawf(h, "<a href=\"#eq-%d\">(%d)</a>", number, number);
  return digits + 2;
}

static int insert_of(const char* s, int* k) {
  int digits = (int)strspn(s + 1, "0123456789");
  if (digits < 1 || digits > 3 || s[1 + digits] != '}') return 0;
  *k = 0;
  for (int i = 1; i <= digits; i++) *k = 10 * *k + (s[i] - '0');
  return digits + 2;
}

// Words among the inserts are words, not formulas: "(1) and (2)".
static void put_insert(pl_html* h, const pl_form* f) {
  if (f && f->kind == PL_F_TEXT) pl_html_sentence(h, pl_html_words(h, f->words), 0, NULL);
  else pl_html_inline(h, f);
}

void pl_html_sentence(pl_html* h, const char* words, int n, const pl_form* const* inserts) {
  const char* from = words;
  while (*words) {
    int k = 0, taken = *words == '{' ? insert_of(words, &k) : 0;
    if (taken || *words == '(') {
      pl_html_text(h, pl_copy_n(h->arena, from, (size_t)(words - from)));
      from = words;
      if (*words == '(') taken = equation_constraint(h, words);
      else if (k >= 1 && k <= n) put_insert(h, inserts[k - 1]);
      if (taken) {
        words += taken;
        from = words;
        continue;
      }
    }
    words++;
  }
  pl_html_text(h, from);
}
