// A page of text: right margin, colours, wrapped sentences. Widths are counted in character cells;
// colour codes are written around strings after the layout is settled, so they never count.
#include "report_impl.h"

#include <limits.h>
#include <string.h>

enum { PL_PAGE_MARGIN = 78 };  // right edge of a page that is not wrapped, cells

pl_worked_style pl_worked_style_default(pl_language lang) {
  return (pl_worked_style){.math = PL_MATH_LINE, .lang = lang, .width = PL_PAGE_MARGIN};
}

pl_page pl_page_make(pl_text* out, pl_pool* pool, const pl_worked_style* style) {
  enum { PL_PAGE_NARROWEST = 40 };
  int width = style->width <= 0                  ? 0
              : style->width < PL_PAGE_NARROWEST ? PL_PAGE_NARROWEST
                                                 : style->width;
  pl_math math = style->math == PL_MATH_2D || style->math == PL_MATH_ASCII ? style->math
                                                                           : PL_MATH_LINE;
  return (pl_page){.out = out,
                   .arena = out->arena,
                   .pool = pool,
                   .style = style,
                   .how = {math, style->lang},
                   .margin = width && width < PL_PAGE_MARGIN ? width : PL_PAGE_MARGIN,
                   .wrap = width ? width : INT_MAX,
                   .blank = true};
}

const char* pl_page_plain(const pl_page* g, const char* s) {
  if (!s) return "";
  return g->how.math == PL_MATH_ASCII ? pl_ascii_of(g->arena, s) : s;
}

const char* pl_page_words(const pl_page* g, const char* const words[2]) {
  const char* s = words[g->how.lang] ? words[g->how.lang] : words[PL_ENGLISH];
  return pl_page_plain(g, s);
}

void pl_page_newline(pl_page* g) {
  pl_text_add(g->out, "\n");
  g->blank = false;
}

void pl_page_blank(pl_page* g) {
  if (!g->blank) pl_text_add(g->out, "\n");
  g->blank = true;
}

void pl_page_ink(pl_page* g, pl_ink ink, const char* s) {
  static const char* const code[] = {"", "\033[1m", "\033[2m", "\033[33m", "\033[31m"};
  bool colour = g->style->colour && ink != PL_INK_PLAIN && *s;
  if (colour) pl_text_add(g->out, code[ink]);
  pl_text_add(g->out, s);
  if (colour) pl_text_add(g->out, "\033[0m");
}

// The next word from s: bytes up to a blank.  \x01 belongs to the word.
static size_t pl_word_length(const char* s) { return strcspn(s, " "); }

static const char* pl_word_shown(pl_page* g, const char* s, size_t n) {
  char* word = pl_copy_n(g->arena, s, n);
  for (char* c = word; *c; c++)
    if (*c == '\x01') *c = ' ';
  return word;
}

void pl_page_sentence(pl_page* g, int indent, int hang, pl_ink ink, const char* s) {
  int column = indent;
  bool first = true;
  pl_text line = pl_text_make(g->arena);
  pl_text_pad(g->out, indent);
  for (;;) {
    s += strspn(s, " ");
    if (!*s) break;
    size_t n = pl_word_length(s);
    const char* word = pl_word_shown(g, s, n);
    int width = pl_utf8_width(word);
    if (!first && column + 1 + width > g->wrap) {
      pl_page_ink(g, ink, pl_text_string(&line));
      pl_page_newline(g);
      pl_text_pad(g->out, hang);
      line = pl_text_make(g->arena);
      column = hang;
      first = true;
    }
    if (!first) pl_text_add(&line, " ");
    pl_text_add(&line, word);
    column += width + !first;
    first = false;
    s += n;
  }
  pl_page_ink(g, ink, pl_text_string(&line));
  pl_page_newline(g);
}

// A formula inside a sentence stands on one line: a tall one is written in line notation.
static const char* pl_page_inline(pl_page* g, const pl_form* f) {
  if (!f || !g->pool) return "";
  const char* s = pl_notation_print(g->arena, g->pool, f, g->how);
  if (strchr(s, '\n'))
    s = pl_notation_print(g->arena, g->pool, f, (pl_notation){PL_MATH_LINE, g->how.lang});
  return pl_page_plain(g, s);
}

static void pl_page_add_insert(pl_page* g, pl_text* out, const pl_form* f) {
  const char* s = pl_page_inline(g, f);
  bool whole = pl_utf8_width(s) <= g->margin / 2;  // longer ones may break like words
  for (char before = 0; *s; before = *s++) {
    char c = whole && *s == ' ' && before != ',' ? '\x01' : *s;
    pl_text_add_n(out, &c, 1);
  }
}

const char* pl_page_fill(pl_page* g, const char* words, int n, const pl_form* const* inserts) {
  pl_text out = pl_text_make(g->arena);
  while (*words) {
    int digits = (int)strspn(*words == '{' ? words + 1 : "", "0123456789");
    bool insert = digits > 0 && digits < 4 && words[1 + digits] == '}';
    if (!insert) {
      pl_text_add_n(&out, words++, 1);
      continue;
    }
    int k = 0;
    for (int i = 1; i <= digits; i++) k = 10 * k + (words[i] - '0');
    if (k >= 1 && k <= n) pl_page_add_insert(g, &out, inserts[k - 1]);
    words += digits + 2;
  }
  return pl_text_string(&out);
}
