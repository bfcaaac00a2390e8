// Names and maps: interned strings (equal text, equal pointer), and a map from 64-bit keys to
// 64-bit values. Both are open-addressing tables with linear probing; order of insertion never
// depends on addresses.
#include "base/base.h"

#include <string.h>

// ----------------------------------------------------------------------------------------- hashing
// Finaliser of splitmix64 [SteeleLeaFlood2014].
static uint64_t scramble(uint64_t x) {
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ x >> 27) * 0x94d049bb133111ebull;
  return x ^ x >> 31;
}

uint64_t pl_hash_mix(uint64_t h, uint64_t x) {
  return scramble(h * 0x9e3779b97f4a7c15ull + x + 0x632be59bd9b4e019ull);
}

uint64_t pl_hash_bytes(const void* p, size_t n, uint64_t seed) {
  const unsigned char* at = p;
  uint64_t h = pl_hash_mix(seed, n);
  while (n > 0) {
    size_t step = n < 8 ? n : 8;
    uint64_t word = 0;
    // the same on every machine
    for (size_t i = 0; i < step; i++) word |= (uint64_t)at[i] << (8 * i);
    h = pl_hash_mix(h, word);
    at += step;
    n -= step;
  }
  return h;
}

// ------------------------------------------------------------------------------------------- names
typedef struct name {
  const char* text;
  size_t size;
  uint64_t hash;
} name;

struct pl_names {
  pl_arena* arena;
  name* table;    // (cap), text NULL when empty
  size_t n, cap;  // cap is a power of two
};

pl_names* pl_names_make(pl_arena* a) {
  pl_names* s = PL_NEW(a, pl_names);
  s->arena = a;
  s->cap = 64;
  s->table = PL_ARRAY(a, name, s->cap);
  return s;
}

static size_t name_slot(const name* table, size_t cap, const char* s, size_t n, uint64_t hash) {
  size_t i = hash & (cap - 1);
  while (table[i].text != NULL) {
    if (table[i].hash == hash && table[i].size == n && memcmp(table[i].text, s, n) == 0) return i;
    i = (i + 1) & (cap - 1);
  }
  return i;
}

static void names_widen(pl_names* s) {
  size_t cap = s->cap * 2;
  name* table = PL_ARRAY(s->arena, name, cap);
  for (size_t i = 0; i < s->cap; i++) {
    name* x = &s->table[i];
    if (x->text != NULL) table[name_slot(table, cap, x->text, x->size, x->hash)] = *x;
  }
  s->table = table;
  s->cap = cap;
}

const char* pl_intern(pl_names* names, const char* s) { return pl_intern_n(names, s, strlen(s)); }

const char* pl_intern_n(pl_names* names, const char* s, size_t n) {
  uint64_t hash = pl_hash_bytes(s, n, 0);
  size_t i = name_slot(names->table, names->cap, s, n, hash);
  if (names->table[i].text != NULL) return names->table[i].text;
  if (names->n * 2 >= names->cap) {
    names_widen(names);
    i = name_slot(names->table, names->cap, s, n, hash);
  }
  const char* text = pl_copy_n(names->arena, s, n);
  names->table[i] = (name){text, n, hash};
  names->n++;
  return text;
}

// --------------------------------------------------------------------------------------------- map
typedef struct entry {
  uint64_t key, value;
  bool used;
} entry;

struct pl_map {
  pl_arena* arena;
  entry* table;   // (cap)
  size_t n, cap;  // keys ever set; cap is a power of two
  int present;    // keys whose value is not 0
};

pl_map* pl_map_make(pl_arena* a) {
  pl_map* m = PL_NEW(a, pl_map);
  m->arena = a;
  m->cap = 16;
  m->table = PL_ARRAY(a, entry, m->cap);
  return m;
}

static entry* map_slot(entry* table, size_t cap, uint64_t key) {
  size_t i = scramble(key) & (cap - 1);
  while (table[i].used && table[i].key != key) i = (i + 1) & (cap - 1);
  return &table[i];
}

uint64_t pl_map_get(const pl_map* m, uint64_t key) {
  return map_slot(m->table, m->cap, key)->value;
}

static void map_widen(pl_map* m) {
  size_t cap = m->cap * 2;
  entry* table = PL_ARRAY(m->arena, entry, cap);
  for (size_t i = 0; i < m->cap; i++) {
    if (m->table[i].used) *map_slot(table, cap, m->table[i].key) = m->table[i];
  }
  m->table = table;
  m->cap = cap;
}

void pl_map_set(pl_map* m, uint64_t key, uint64_t value) {
  entry* e = map_slot(m->table, m->cap, key);
  if (!e->used) {
    if (m->n * 2 >= m->cap) {
      map_widen(m);
      e = map_slot(m->table, m->cap, key);
    }
    *e = (entry){key, 0, true};
    m->n++;
  }
  m->present += (value != 0) - (e->value != 0);
  e->value = value;
}

int pl_map_count(const pl_map* m) { return m->present; }
