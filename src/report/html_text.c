// Text on its way into HTML. What comes from a model is shown as it is written, whatever it
// contains: markup is escaped, and characters that steer instead of being seen (controls, direction
// marks) are shown by their number.
#include "html_impl.h"

#include <math.h>
#include <string.h>

const char* pl_html_say(const pl_html* h, const char* en, const char* de) {
  return h->lang == PL_GERMAN ? de : en;
}

const char* pl_html_words(const pl_html* h, const char* const words[2]) {
  const char* s = words[h->lang] ? words[h->lang] : words[PL_ENGLISH];
  return s ? s : "";
}

void pl_html_raw(pl_html* h, const char* markup) { pl_text_add(h->out, markup); }

void pl_html_rawf(pl_html* h, const char* markup, ...) {
  va_list ap;
  va_start(ap, markup);
  pl_text_add(h->out, pl_vformat(h->arena, markup, ap));
  va_end(ap);
}

// Characters that change how others are shown, or that no document may contain.
static bool steers(uint32_t c) {
  bool control = (c < 0x20 && c != '\t' && c != '\n') || (c >= 0x7F && c <= 0x9F);
  bool direction = c == 0x061C || c == 0x200E || c == 0x200F || (c >= 0x202A && c <= 0x202E)
                   || (c >= 0x2066 && c <= 0x2069);
  bool unseen = c == 0x00AD || (c >= 0x200B && c <= 0x200D) || (c >= 0x2028 && c <= 0x2029)
                || (c >= 0x2060 && c <= 0x2064) || c == 0xFEFF || (c >= 0xFFF9 && c <= 0xFFFB)
                || (c >= 0xE0000 && c <= 0xE0FFF);
  bool none = (c & 0xFFFE) == 0xFFFE || (c >= 0xFDD0 && c <= 0xFDEF) || (c >= 0xD800 && c <= 0xDFFF)
              || c > 0x10FFFF;
  return control || direction || unseen || none;
}

static void add_escaped(pl_text* out, const char* s) {
  const char* end = s + strlen(s);
  while (s < end) {
    uint32_t c = 0;
    int n = pl_utf8_decode(s, end, &c);
    if (n <= 0) {
      pl_text_add(out, "\xEF\xBF\xBD");
      s++;
      continue;
    }
    if (c == '&') pl_text_add(out, "&amp;");
    else if (c == '<') pl_text_add(out, "&lt;");
    else if (c == '>') pl_text_add(out, "&gt;");
    else if (c == '"') pl_text_add(out, "&quot;");
    else if (c == '\'') pl_text_add(out, "&#39;");
    else if (c == '\r') pl_text_add(out, "");
    else if (steers(c)) pl_text_addf(out, "⟨U+%04X⟩", c);
    else pl_text_add_n(out, s, (size_t)n);
    s += n;
  }
}

const char* pl_html_escaped(pl_arena* a, const char* s) {
  pl_text out = pl_text_make(a);
  add_escaped(&out, s ? s : "");
  return pl_text_string(&out);
}

void pl_html_text(pl_html* h, const char* s) { add_escaped(h->out, s ? s : ""); }
void pl_html_attribute(pl_html* h, const char* s) { add_escaped(h->out, s ? s : ""); }

void pl_html_json_string(pl_html* h, const char* s) {
  const char* end = s + strlen(s);
  pl_text_add(h->out, "\"");
  while (s < end) {
    uint32_t c = 0;
    int n = pl_utf8_decode(s, end, &c);
    if (n <= 0) {
      n = 1;
      c = 0xFFFD;
    }
    bool plain = c >= 0x20 && c < 0x7F && !strchr("\"\\<>&", (int)c);
    if (plain || (c > 0xA0 && c < 0xFFFF && !steers(c))) pl_text_add_n(h->out, s, (size_t)n);
    else if (c < 0x10000) pl_text_addf(h->out, "\\u%04x", c);
    else
      pl_text_addf(h->out, "\\u%04x\\u%04x", 0xD800 + ((c - 0x10000) >> 10),
                   0xDC00 + ((c - 0x10000) & 0x3FF));
    s += n;
  }
  pl_text_add(h->out, "\"");
}

const char* pl_html_number(const pl_html* h, double x, int digits) {
  const char* s = pl_notation_number(h->arena, x, digits, (pl_notation){PL_MATH_LINE, h->lang});
  if (*s != '-') return s;
  return pl_format(h->arena, "−%s", s + 1);
}

const char* pl_html_quantity(const pl_html* h, double x, const char* unit, int digits) {
  bool angle = unit && (strcmp(unit, "rad") == 0 || strcmp(unit, "°") == 0);
  if (unit && strcmp(unit, "rad") == 0) x = x * 180 / M_PI;
  bool bare = !unit || !*unit || strcmp(unit, "1") == 0;
  return pl_format(h->arena, "%s%s%s", pl_html_number(h, x, digits),
                   angle  ? "°"
                   : bare ? ""
                          : "\u00A0",
                   angle || bare ? "" : unit);
}
