// UTF-8: decoding, encoding, the width that a terminal shows, and the distance between two names.
#include "base/base.h"

#include <string.h>

// Bytes that a first byte announces, 0 if it cannot be one.
static int announced(unsigned char c) {
  if (c < 0x80) return 1;
  if (c >= 0xc2 && c <= 0xdf) return 2;
  if (c >= 0xe0 && c <= 0xef) return 3;
  if (c >= 0xf0 && c <= 0xf4) return 4;
  return 0;
}

int pl_utf8_decode(const char* s, const char* end, uint32_t* code_point) {
  if (s >= end) return 0;
  unsigned char first = (unsigned char)*s;
  int n = announced(first);
  if (n == 0 || end - s < n) return 0;
  if (n == 1) {
    *code_point = first;
    return 1;
  }
  uint32_t c = first & (0x7fu >> n);
  for (int i = 1; i < n; i++) {
    unsigned char b = (unsigned char)s[i];
    if ((b & 0xc0) != 0x80) return 0;
    c = c << 6 | (b & 0x3f);
  }
  // overlong forms, surrogates and what lies beyond Unicode are malformed
  if ((n == 3 && c < 0x800) || (n == 4 && c < 0x10000) || c > 0x10ffff
      || (c >= 0xd800 && c <= 0xdfff))
    return 0;
  *code_point = c;
  return n;
}

int pl_utf8_encode(char out[4], uint32_t c) {
  if (c < 0x80) {
    out[0] = (char)c;
    return 1;
  }
  if (c < 0x800) {
    out[0] = (char)(0xc0 | c >> 6);
    out[1] = (char)(0x80 | (c & 0x3f));
    return 2;
  }
  if (c < 0x10000) {
    out[0] = (char)(0xe0 | c >> 12);
    out[1] = (char)(0x80 | (c >> 6 & 0x3f));
    out[2] = (char)(0x80 | (c & 0x3f));
    return 3;
  }
  out[0] = (char)(0xf0 | c >> 18);
  out[1] = (char)(0x80 | (c >> 12 & 0x3f));
  out[2] = (char)(0x80 | (c >> 6 & 0x3f));
  out[3] = (char)(0x80 | (c & 0x3f));
  return 4;
}

// ------------------------------------------------------------------------------------------- width
typedef struct range {
  uint32_t first, last;
} range;

// Marks that sit on the letter before them, and characters of no width.
static const range zero_width[] = {{0x0300, 0x036f}, {0x0483, 0x0489}, {0x1ab0, 0x1aff},
                                   {0x1dc0, 0x1dff}, {0x200b, 0x200f}, {0x20d0, 0x20ff},
                                   {0xfe00, 0xfe0f}, {0xfe20, 0xfe2f}, {0xfeff, 0xfeff}};
// East Asian wide and full-width characters, emoji.
static const range double_width[] = {{0x1100, 0x115f},   {0x2e80, 0x303e},  {0x3041, 0xa4cf},
                                     {0xac00, 0xd7a3},   {0xf900, 0xfaff},  {0xfe30, 0xfe6f},
                                     {0xff00, 0xff60},   {0xffe0, 0xffe6},  {0x1f300, 0x1f64f},
                                     {0x1f900, 0x1f9ff}, {0x20000, 0x3fffd}};

static bool in_ranges(uint32_t c, const range* r, size_t n) {
  for (size_t i = 0; i < n; i++) {
    if (c >= r[i].first && c <= r[i].last) return true;
  }
  return false;
}

static int cells(uint32_t c) {
  if (c < 0x300) return 1;
  if (in_ranges(c, zero_width, sizeof zero_width / sizeof *zero_width)) return 0;
  if (in_ranges(c, double_width, sizeof double_width / sizeof *double_width)) return 2;
  return 1;
}

int pl_utf8_width(const char* s) { return pl_utf8_width_n(s, strlen(s)); }

int pl_utf8_width_n(const char* s, size_t n) {
  const char* end = s + n;
  int width = 0;
  while (s < end) {
    uint32_t c = 0;
    int step = pl_utf8_decode(s, end, &c);
    width += step ? cells(c) : 1;  // a malformed byte is shown as one cell
    s += step ? step : 1;
  }
  return width;
}

// ----------------------------------------------------------------------------------- edit distance
enum { MAX_LETTERS = 64 };  // longer names are not misspelt names

static int letters_of(const char* s, uint32_t out[MAX_LETTERS]) {
  const char* end = s + strlen(s);
  int n = 0;
  while (s < end) {
    if (n == MAX_LETTERS) return -1;
    uint32_t c = 0;
    int step = pl_utf8_decode(s, end, &c);
    out[n++] = step ? c : (unsigned char)*s;
    s += step ? step : 1;
  }
  return n;
}

static int min_int(int a, int b) { return a < b ? a : b; }

// Optimal string alignment: insertion, deletion, replacement, and exchange of neighbours cost 1
// each.
int pl_edit_distance(const char* a, const char* b, int cap) {
  uint32_t x[MAX_LETTERS], y[MAX_LETTERS];
  int n = letters_of(a, x), m = letters_of(b, y);
  if (n < 0 || m < 0) return strcmp(a, b) == 0 ? 0 : cap + 1;

  int row[3][MAX_LETTERS + 1];
  int *before = row[0], *last = row[1], *now = row[2];
  for (int j = 0; j <= m; j++) last[j] = j;
  for (int i = 1; i <= n; i++) {
    now[0] = i;
    for (int j = 1; j <= m; j++) {
      int d = min_int(min_int(last[j] + 1, now[j - 1] + 1), last[j - 1] + (x[i - 1] != y[j - 1]));
      if (i > 1 && j > 1 && x[i - 1] == y[j - 2] && x[i - 2] == y[j - 1])
        d = min_int(d, before[j - 2] + 1);
      now[j] = d;
    }
    int* free_row = before;
    before = last;
    last = now;
    now = free_row;
  }
  return last[m] <= cap ? last[m] : cap + 1;
}
