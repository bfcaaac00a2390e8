// Sources and spans: where in a text something stands, in bytes inside, in lines and cells outside.
#include "base/base.h"

#include <string.h>

// Characters and UTF-16 units from one byte to another.  A byte that is no UTF-8 counts as one.
static pl_position count_from(const char* text, size_t from, size_t to) {
  pl_position n = {0};
  for (size_t i = from; i < to; n.column++) {
    uint32_t c = 0;
    int step = pl_utf8_decode(text + i, text + to, &c);
    i += step ? (size_t)step : 1;
    n.at16 += c > 0xffff ? 2 : 1;
  }
  return n;
}

pl_source* pl_source_make(pl_arena* a, const char* name, const char* text, size_t size) {
  pl_source* s = PL_NEW(a, pl_source);
  s->name = pl_copy(a, name ? name : "");
  s->text = pl_copy_n(a, text, size);
  s->size = size;

  // one line more than there are line ends
  int n = 1;
  for (size_t i = 0; i < size; i++) n += text[i] == '\n';
  size_t* lines = PL_ARRAY(a, size_t, n);
  int k = 1;
  for (size_t i = 0; i < size; i++) {
    if (text[i] == '\n') lines[k++] = i + 1;
  }
  s->lines = lines;
  s->n_lines = n;
  size_t* units = PL_ARRAY(a, size_t, n);
  for (k = 1; k < n; k++) {
    pl_position end = count_from(text, lines[k - 1], lines[k]);
    units[k] = units[k - 1] + end.at16;
  }
  s->units = units;
  return s;
}

// The last line that begins at or before the offset, from 1.
static int line_at(const pl_source* s, size_t offset) {
  int lo = 0, hi = s->n_lines - 1;
  while (lo < hi) {
    int mid = lo + (hi - lo + 1) / 2;
    if (s->lines[mid] <= offset) lo = mid;
    else hi = mid - 1;
  }
  return lo + 1;
}

pl_place pl_span_place(pl_span s) {
  if (s.source == NULL) return (pl_place){1, 1};
  size_t at = s.begin < s.source->size ? s.begin : s.source->size;
  int line = line_at(s.source, at);
  size_t start = s.source->lines[line - 1];
  return (pl_place){line, pl_utf8_width_n(s.source->text + start, at - start) + 1};
}

pl_position pl_source_position(const pl_source* s, size_t at) {
  if (s == NULL) return (pl_position){0};
  if (at > s->size) at = s->size;
  int line = line_at(s, at);
  size_t start = s->lines[line - 1];
  pl_position n = count_from(s->text, start, at);
  return (pl_position){.at = at,
                       .at16 = s->units[line - 1] + n.at16,
                       .line = (size_t)line,
                       .column = n.column + 1,
                       .column16 = n.at16 + 1};
}

pl_span pl_span_join(pl_span a, pl_span b) {
  if (a.source == NULL) return b;
  if (b.source != a.source) return a;
  if (b.begin < a.begin) a.begin = b.begin;
  if (b.end > a.end) a.end = b.end;
  return a;
}

const char* pl_source_line(pl_arena* a, const pl_source* s, int line) {
  if (s == NULL || line < 1 || line > s->n_lines) return "";
  size_t begin = s->lines[line - 1];
  size_t end = line < s->n_lines ? s->lines[line] - 1 : s->size;
  if (end > begin && s->text[end - 1] == '\r') end--;
  return pl_copy_n(a, s->text + begin, end - begin);
}
