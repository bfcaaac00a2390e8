// Printing one diagnostic.
//
//   atwood.pleuel:9: E021  a length cannot equal an acceleration
//       9 | constraint g1: x1 + x2 = g
//         |                ^^^^^^^   ^ m/s²  (line 2)
//         |                m  (x1 from line 10: init x1 = 1 [m])
//         = did you mean l (line 4, m)?
//
// Marks on one line share one caret line: the text of the last stands beside its caret, the texts
// of the others below their own. Marks on other lines bring their line with them.
#include "base/base.h"

#include <string.h>

enum { MAX_MARKS = 32 };           // marks of one message; more would not be read
static const int max_cells = 160;  // a longer source line is cut to a window around its first mark

typedef struct mark {
  int line, column, width;  // from 1, in cells
  const char* text;         // beside or below the caret, or NULL
} mark;

typedef struct printer {
  pl_text* out;
  pl_print_style style;
  pl_severity severity;
} printer;

static const char* in_language(const char* const by_language[2], pl_language lang) {
  const char* s = by_language[lang == PL_GERMAN];
  return s ? s : by_language[PL_ENGLISH];
}

static void colour(const printer* pr, const char* on) {
  if (pr->style.colour) pl_text_add(pr->out, on);
}

static void colour_of_severity(const printer* pr) {
  static const char* const codes[] = {"\033[1;31m", "\033[1;33m", "\033[1;36m"};
  colour(pr, codes[pr->severity]);
}

static const char plain[] = "\033[0m", faint[] = "\033[2m", bold[] = "\033[1m";

// ------------------------------------------------------------------------------------------- marks
// Cells of the span on its first line; at least one caret.
static mark mark_of(pl_span s, const char* text) {
  pl_place at = pl_span_place(s);
  const pl_source* src = s.source;
  size_t line_end = at.line < src->n_lines ? src->lines[at.line] - 1 : src->size;
  size_t begin = s.begin < src->size ? s.begin : src->size;
  size_t end = s.end < line_end ? s.end : line_end;
  int width = end > begin ? pl_utf8_width_n(src->text + begin, end - begin) : 0;
  return (mark){at.line, at.column, width > 0 ? width : 1, text};
}

static bool is_before(const mark* x, const mark* y) {
  return x->line != y->line ? x->line < y->line : x->column < y->column;
}

// The marks that lie in the source of the message, in order of line and column. Marks elsewhere are
// returned by the labels themselves (see print_foreign_labels).
static int collect_marks(mark* marks, const pl_diagnostic* m, pl_language lang) {
  int n = 0;
  marks[n++] = mark_of(m->span, in_language(m->reason, lang));
  for (int i = 0; i < m->labels.n && n < MAX_MARKS; i++) {
    if (m->labels.at[i].span.source != m->span.source) continue;
    mark x = mark_of(m->labels.at[i].span, m->labels.at[i].text);
    int k = n++;
    for (; k > 0 && is_before(&x, &marks[k - 1]); k--) marks[k] = marks[k - 1];
    marks[k] = x;
  }
  return n;
}

// ------------------------------------------------------------------------------------------- lines
// One source line, from the cell `from` on; what a terminal would obey (tabs, escapes) becomes a
// blank or a mark.
static void print_line_text(const printer* pr, const char* s, int from) {
  const char* end = s + strlen(s);
  int cell = 0;
  while (s < end && cell < from + max_cells) {
    uint32_t c = 0;
    int step = pl_utf8_decode(s, end, &c);
    int width = pl_utf8_width_n(s, (size_t)(step ? step : 1));
    if (cell >= from) {
      if (c == '\t') pl_text_add(pr->out, " ");
      else if (step == 0) pl_text_add(pr->out, "\xef\xbf\xbd");
      else if (c < 0x20 || (c >= 0x7f && c < 0xa0)) pl_text_add(pr->out, "?");
      else pl_text_add_n(pr->out, s, (size_t)step);
    }
    cell += width;
    s += step ? step : 1;
  }
}

static void margin(const printer* pr, int line) {
  colour(pr, faint);
  if (line > 0) pl_text_addf(pr->out, "%5d | ", line);
  else pl_text_add(pr->out, "      | ");
  colour(pr, plain);
}

// The caret line of n marks on one line, with the text of the last beside it.
static void print_carets(const printer* pr, const mark* marks, int n, int from) {
  margin(pr, 0);
  int cell = 1 + from;
  for (int i = 0; i < n; i++) {
    pl_text_pad(pr->out, marks[i].column - cell);
    int begin = marks[i].column > cell ? marks[i].column : cell;
    int end = marks[i].column + marks[i].width;
    if (end > from + max_cells) end = from + max_cells + 1;
    colour_of_severity(pr);
    for (cell = begin; cell < end; cell++) pl_text_add(pr->out, "^");
    colour(pr, plain);
  }
  const char* text = marks[n - 1].text;
  if (text != NULL) pl_text_addf(pr->out, " %s", text);
  pl_text_add(pr->out, "\n");
}

// One source line with its n marks.
static void print_marked_line(const printer* pr, const pl_source* src, const mark* marks, int n) {
  int from = marks[0].column + marks[0].width > max_cells ? marks[0].column - 40 : 0;
  if (from < 0) from = 0;
  margin(pr, marks[0].line);
  print_line_text(pr, pl_source_line(pr->out->arena, src, marks[0].line), from);
  pl_text_add(pr->out, "\n");
  print_carets(pr, marks, n, from);

  // texts of the earlier marks, the rightmost first
  for (int i = n - 2; i >= 0; i--) {
    if (marks[i].text == NULL) continue;
    margin(pr, 0);
    pl_text_pad(pr->out, marks[i].column - 1 - from);
    pl_text_addf(pr->out, "%s\n", marks[i].text);
  }
}

// The line of the message itself first, then the others from top to bottom.
static void print_marks(const printer* pr, const pl_diagnostic* m) {
  mark marks[MAX_MARKS];
  int n = collect_marks(marks, m, pr->style.lang);
  int own = pl_span_place(m->span).line;
  for (int pass = 0; pass < 2; pass++) {
    for (int i = 0, k; i < n; i = k) {
      for (k = i + 1; k < n && marks[k].line == marks[i].line; k++) {}
      if ((marks[i].line == own) == (pass == 0))
        print_marked_line(pr, m->span.source, marks + i, k - i);
    }
  }
}

// Labels in another text (an included file): one marked line each, under the name of that text.
static void print_foreign_labels(const printer* pr, const pl_diagnostic* m) {
  for (int i = 0; i < m->labels.n; i++) {
    pl_label x = m->labels.at[i];
    if (x.span.source == m->span.source || x.span.source == NULL) continue;
    mark one = mark_of(x.span, x.text);
    pl_text_addf(pr->out, "      : %s:%d\n", x.span.source->name, one.line);
    print_marked_line(pr, x.span.source, &one, 1);
  }
}

static void print_without_place(const printer* pr, const pl_diagnostic* m) {
  const char* reason = in_language(m->reason, pr->style.lang);
  if (reason != NULL) pl_text_addf(pr->out, "      : %s\n", reason);
}

// A suggestion of several lines keeps its margin.
static void print_fix(const printer* pr, const char* fix) {
  bool first = true;
  while (fix != NULL) {
    const char* end = strchr(fix, '\n');
    pl_text_add(pr->out, first ? "      = " : "        ");
    pl_text_add_n(pr->out, fix, end ? (size_t)(end - fix) : strlen(fix));
    pl_text_add(pr->out, "\n");
    first = false;
    fix = end ? end + 1 : NULL;
  }
}

// ------------------------------------------------------------------------------------------- heads
static const char* sentence_of(const printer* pr, const pl_diagnostic* m) {
  const char* sentence = in_language(m->sentence, pr->style.lang);
  return sentence ? sentence : pl_code_title(m->code, pr->style.lang);
}

static void print_head(const printer* pr, const pl_diagnostic* m) {
  colour(pr, bold);
  if (m->span.source != NULL) {
    pl_text_addf(pr->out, "%s:%d: ", m->span.source->name, pl_span_place(m->span).line);
  }
  colour_of_severity(pr);
  pl_text_add(pr->out, pl_code_name(m->code));
  colour(pr, plain);
  pl_text_addf(pr->out, "  %s\n", sentence_of(pr, m));
}

static void print_terse(const printer* pr, const pl_diagnostic* m) {
  if (m->span.source != NULL) {
    pl_place at = pl_span_place(m->span);
    pl_text_addf(pr->out, "%s:%d:%d: ", m->span.source->name, at.line, at.column);
  }
  pl_text_addf(pr->out, "%s: %s\n", pl_code_name(m->code), sentence_of(pr, m));
}

void pl_diagnostic_print(pl_text* out, const pl_diagnostic* m, pl_print_style style) {
  printer pr = {out, style, pl_code_severity(m->code)};
  if (style.terse) {
    print_terse(&pr, m);
    return;
  }
  print_head(&pr, m);
  if (m->span.source != NULL) print_marks(&pr, m);
  else print_without_place(&pr, m);
  print_foreign_labels(&pr, m);
  print_fix(&pr, in_language(m->fix, style.lang));
}
