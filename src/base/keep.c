// States on their way to bytes and back. Numbers stand as the machine has them, eight bytes each,
// flags one byte; what surrounds them (whose state, which machine, a checksum) is the business of
// the caller.
#include <string.h>

#include "base/base.h"

pl_keeper pl_keeper_to_write(pl_arena* a) { return (pl_keeper){.arena = a}; }

pl_keeper pl_keeper_to_read(pl_arena* a, const void* bytes, size_t n) {
  return (pl_keeper){.reads = true, .arena = a, .at = (unsigned char*)(uintptr_t)bytes, .size = n};
}

void pl_keep_fail(pl_keeper* k) {
  if (k->wrong == NULL) k->wrong = k->section ? k->section : "";
}

bool pl_keep_is_whole(const pl_keeper* k) { return k->wrong == NULL && k->next == k->size; }

// ------------------------------------------------------------------------------------------- bytes
static void write_bytes(pl_keeper* k, const void* x, size_t n) {
  if (n > k->size - k->next) {
    size_t size = k->size < 4096 ? 4096 : k->size;
    while (n > size - k->next) size *= 2;
    unsigned char* more = pl_alloc(k->arena, size);
    if (k->next > 0) memcpy(more, k->at, k->next);
    k->at = more;
    k->size = size;
  }
  memcpy(k->at + k->next, x, n);
  k->next += n;
}

void pl_keep_bytes(pl_keeper* k, void* x, size_t n) {
  if (n == 0) return;
  if (!k->reads) {
    write_bytes(k, x, n);
    return;
  }
  if (n > k->size - k->next) pl_keep_fail(k);
  if (k->wrong) return;
  memcpy(x, k->at + k->next, n);
  k->next += n;
}

// ----------------------------------------------------------------------------------------- numbers
void pl_keep_f64(pl_keeper* k, double* x) { pl_keep_bytes(k, x, sizeof *x); }

void pl_keep_f64s(pl_keeper* k, double* x, size_t n) {
  if (n > SIZE_MAX / sizeof *x) pl_keep_fail(k);
  else pl_keep_bytes(k, x, n * sizeof *x);
}

void pl_keep_long(pl_keeper* k, long* x, long least, long most) {
  int64_t value = k->reads ? 0 : *x;
  pl_keep_bytes(k, &value, sizeof value);
  if (!k->reads || k->wrong) return;
  if (value < least || value > most) pl_keep_fail(k);
  else *x = (long)value;
}

void pl_keep_int(pl_keeper* k, int* x, int least, int most) {
  long value = *x;
  pl_keep_long(k, &value, least, most);
  *x = (int)value;
}

// A flag of another value than 0 and 1 must not even be looked at as one.
void pl_keep_bool(pl_keeper* k, bool* x) {
  unsigned char value = k->reads ? 0 : *x ? 1 : 0;
  pl_keep_bytes(k, &value, 1);
  if (!k->reads || k->wrong) return;
  if (value > 1) pl_keep_fail(k);
  else *x = value == 1;
}

void pl_keep_bools(pl_keeper* k, bool* x, size_t n) {
  for (size_t i = 0; i < n && k->wrong == NULL; i++) pl_keep_bool(k, &x[i]);
}

void pl_keep_count(pl_keeper* k, int* n, size_t bytes_each) {
  pl_keep_int(k, n, 0, INT32_MAX);
  if (k->reads && k->wrong == NULL && bytes_each > 0
      && (size_t)*n > (k->size - k->next) / bytes_each)
    pl_keep_fail(k);
  if (k->wrong) *n = 0;
}

// ------------------------------------------------------------------------------------------- texts
void pl_keep_text(pl_keeper* k, const char** text) {
  int n = 0;
  if (!k->reads) n = *text ? (int)strlen(*text) + 1 : 0;
  pl_keep_count(k, &n, 1);
  if (!k->reads) {
    if (*text) write_bytes(k, *text, (size_t)n - 1);
    return;
  }
  if (n > 0 && (size_t)(n - 1) > k->size - k->next) pl_keep_fail(k);
  if (k->wrong) return;
  *text = n > 0 ? pl_copy_n(k->arena, (const char*)k->at + k->next, (size_t)n - 1) : NULL;
  if (n > 0) k->next += (size_t)n - 1;
}

void pl_keep_section(pl_keeper* k, const char* name) {
  char here[16] = {0};
  size_t n = strlen(name);
  k->section = name;
  memcpy(here, name, n < sizeof here ? n : sizeof here);
  char found[sizeof here];
  memcpy(found, here, sizeof here);
  pl_keep_bytes(k, found, sizeof found);
  if (k->reads && k->wrong == NULL && memcmp(found, here, sizeof here) != 0) pl_keep_fail(k);
}
