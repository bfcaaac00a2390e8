// Writing JSON on a pl_text. Objects and lists are indented by two blanks a level; small ones may
// be kept on a line. Everything stays in the arena of the text, so a document costs no other memory
// and can be given up at any point.
#include "base/base.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool is_flat(const pl_json* j) { return (j->flat >> (j->depth < 63 ? j->depth : 63)) & 1; }

static void new_line(pl_json* j) {
  if (is_flat(j)) return;
  pl_text_add(j->out, "\n");
  pl_text_pad(j->out, 2 * j->depth);
}

static void add_escaped(pl_text* out, const char* s) {
  const char* end = s + strlen(s);
  pl_text_add(out, "\"");
  while (s < end) {
    unsigned char c = (unsigned char)*s;
    uint32_t code_point;
    int n = pl_utf8_decode(s, end, &code_point);
    if (n <= 0) {
      pl_text_add(out, "\\ufffd");
      s++;
      continue;
    }
    if (c == '"' || c == '\\') pl_text_addf(out, "\\%c", c);
    else if (c == '\n') pl_text_add(out, "\\n");
    else if (c == '\t') pl_text_add(out, "\\t");
    else if (c < 0x20 || c == 0x7f) pl_text_addf(out, "\\u%04x", c);
    else pl_text_add_n(out, s, (size_t)n);
    s += n;
  }
  pl_text_add(out, "\"");
}

// What comes before any value: comma, new line, key.
static void begin_value(pl_json* j, const char* key) {
  if (j->depth > 0) {
    if (!j->empty) pl_text_add(j->out, is_flat(j) ? ", " : ",");
    new_line(j);
  }
  j->empty = false;
  if (!key) return;
  add_escaped(j->out, key);
  pl_text_add(j->out, ": ");
}

static void open_bracket(pl_json* j, const char* key, const char* bracket) {
  bool flat = is_flat(j);
  begin_value(j, key);
  pl_text_add(j->out, bracket);
  j->depth++;
  if (j->depth < 63) j->flat = (j->flat & ~(1ull << j->depth)) | ((uint64_t)flat << j->depth);
  j->empty = true;
}

static void close_bracket(pl_json* j, const char* bracket) {
  bool empty = j->empty, flat = is_flat(j);
  j->depth--;
  if (!empty && !flat) {
    pl_text_add(j->out, "\n");
    pl_text_pad(j->out, 2 * j->depth);
  }
  pl_text_add(j->out, bracket);
  j->empty = false;
}

pl_json pl_json_make(pl_text* out) { return (pl_json){.out = out, .empty = true}; }
void pl_json_object(pl_json* j, const char* key) { open_bracket(j, key, "{"); }
void pl_json_list(pl_json* j, const char* key) { open_bracket(j, key, "["); }
void pl_json_end_object(pl_json* j) { close_bracket(j, "}"); }
void pl_json_end_list(pl_json* j) { close_bracket(j, "]"); }

void pl_json_flat(pl_json* j) {
  if (j->depth < 63) j->flat |= 1ull << j->depth;
}

void pl_json_string(pl_json* j, const char* key, const char* s) {
  begin_value(j, key);
  if (s) add_escaped(j->out, s);
  else pl_text_add(j->out, "null");
}

void pl_json_number(pl_json* j, const char* key, double x) {
  begin_value(j, key);
  pl_text_add(j->out, isfinite(x) ? pl_shortest_double(j->out->arena, x) : "null");
}

void pl_json_int(pl_json* j, const char* key, long n) {
  begin_value(j, key);
  pl_text_addf(j->out, "%ld", n);
}

void pl_json_bool(pl_json* j, const char* key, bool b) {
  begin_value(j, key);
  pl_text_add(j->out, b ? "true" : "false");
}

void pl_json_null(pl_json* j, const char* key) { pl_json_string(j, key, NULL); }

void pl_json_raw(pl_json* j, const char* key, const char* json) {
  begin_value(j, key);
  pl_text_add(j->out, json);
}

const char* pl_shortest_double(pl_arena* a, double x) {
  char text[40];
  if (x == 0) return "0";
  for (int digits = 1; digits <= 17; digits++) {
    snprintf(text, sizeof text, "%.*g", digits, x);
    if (strtod(text, NULL) != x) continue;
    // 20, not 2e+01: sizes that people read come without an exponent
    int exponent = (int)floor(log10(fabs(x)));
    if (exponent >= digits && exponent < 16) snprintf(text, sizeof text, "%.*g", exponent + 1, x);
    break;
  }
  // a program around us may have set a locale whose decimal sign is not the point
  for (char* c = text; *c; c++)
    if (!strchr("0123456789+-e", *c)) *c = '.';
  return pl_copy(a, text);
}
