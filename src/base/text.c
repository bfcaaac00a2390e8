// Text: copies, formatted strings and texts under construction, all in an arena.
#include "base/base.h"

#include <string.h>

char* pl_copy(pl_arena* a, const char* s) { return pl_copy_n(a, s, strlen(s)); }

char* pl_copy_n(pl_arena* a, const char* s, size_t n) {
  char* to = pl_alloc(a, n + 1);
  if (n > 0) memcpy(to, s, n);
  return to;
}

char* pl_format(pl_arena* a, const char* fmt, ...) {
  va_list ap;
  va_start(ap, fmt);
  char* s = pl_vformat(a, fmt, ap);
  va_end(ap);
  return s;
}

char* pl_vformat(pl_arena* a, const char* fmt, va_list ap) {
  va_list again;
  va_copy(again, ap);
  int n = vsnprintf(NULL, 0, fmt, again);
  va_end(again);
  if (n < 0) return pl_copy(a, "");
  char* s = pl_alloc(a, (size_t)n + 1);
  vsnprintf(s, (size_t)n + 1, fmt, ap);
  return s;
}

// ------------------------------------------------------------------------------ under construction
pl_text pl_text_make(pl_arena* a) { return (pl_text){.arena = a}; }

// Room for n more bytes and the final NUL.
static void reserve(pl_text* t, size_t n) {
  if (t->at != NULL && n < t->cap - t->n) return;
  size_t need = t->n + n + 1;
  size_t wider = t->cap < 32 ? 64 : t->cap * 2;
  if (wider < need) wider = need;
  char* to = pl_alloc(t->arena, wider);
  if (t->n > 0) memcpy(to, t->at, t->n);
  t->at = to;
  t->cap = wider;
}

void pl_text_add(pl_text* t, const char* s) { pl_text_add_n(t, s, strlen(s)); }

void pl_text_add_n(pl_text* t, const char* s, size_t n) {
  reserve(t, n);
  if (n > 0) memcpy(t->at + t->n, s, n);
  t->n += n;
  t->at[t->n] = '\0';
}

void pl_text_addf(pl_text* t, const char* fmt, ...) {
  va_list ap, again;
  va_start(ap, fmt);
  va_copy(again, ap);
  int n = vsnprintf(NULL, 0, fmt, again);
  va_end(again);
  if (n >= 0) {
    reserve(t, (size_t)n);
    vsnprintf(t->at + t->n, (size_t)n + 1, fmt, ap);
    t->n += (size_t)n;
  }
  va_end(ap);
}

void pl_text_pad(pl_text* t, int n) {
  if (n <= 0) return;
  reserve(t, (size_t)n);
  memset(t->at + t->n, ' ', (size_t)n);
  t->n += (size_t)n;
  t->at[t->n] = '\0';
}

const char* pl_text_string(pl_text* t) { return t->at ? t->at : ""; }
