// Arenas: memory by lifetime. Blocks form a list; allocation walks along it and never goes back,
// except by a rewind, which keeps the later blocks for the next pass. When the system, or the
// limit, gives no more, the arena unwinds to its innermost guard, so that no caller needs an error
// path for memory. Method: QBE util.c (alloc/freeall), MuJoCo engine_memory.h (mark and rewind).
#include "base/base.h"

#include <assert.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

static const size_t alignment = 64;          // a cache line, a vector of eight doubles
static const size_t first_block = 16 << 10;  // bytes; most tests never need a second one
static const size_t largest_step = 8 << 20;  // bytes; blocks double up to here

// Under the address sanitizer the place that a growing array has left must not be touched any more.
#ifndef __has_feature
#  define __has_feature(x) 0
#endif
#if defined(__SANITIZE_ADDRESS__) || __has_feature(address_sanitizer)
#  include <sanitizer/asan_interface.h>
static const bool checked = true;
#else
#  define ASAN_POISON_MEMORY_REGION(at, size)   ((void)(at), (void)(size))
#  define ASAN_UNPOISON_MEMORY_REGION(at, size) ((void)(at), (void)(size))
static const bool checked = false;
#endif

typedef struct pl_arena_block {
  struct pl_arena_block* next;
  char* data;   // aligned
  size_t size;  // bytes at data
  size_t used;  // bytes handed out
} pl_arena_block;

struct pl_arena {
  pleuel_allocator alloc;
  pl_arena_block* first;
  pl_arena_block* current;
  pl_guard* guard;      // innermost
  size_t total, limit;  // bytes taken; 0: no limit
  unsigned long count;
};

static void* take_malloc(void* user, size_t size) { return malloc(size); }
static void give_free(void* user, void* block) { free(block); }

static size_t align_up(size_t n) { return (n + alignment - 1) & ~(alignment - 1); }

// One block from the system, NULL when there is none.
static pl_arena_block* take_block(const pleuel_allocator* alloc, size_t size, size_t* taken) {
  size_t whole = sizeof(pl_arena_block) + alignment + size;
  char* raw = alloc->take(alloc->user, whole);
  if (raw == NULL) return NULL;
  pl_arena_block* b = (pl_arena_block*)(void*)raw;
  uintptr_t start = (uintptr_t)(raw + sizeof(pl_arena_block));
  *b = (pl_arena_block){.data = raw + sizeof(pl_arena_block) + (align_up(start) - start),
                        .size = size};
  *taken = whole;
  return b;
}

pl_arena* pl_arena_make(const pleuel_allocator* alloc) {
  pleuel_allocator from = alloc ? *alloc : (pleuel_allocator){take_malloc, give_free, NULL};
  size_t taken = 0;
  pl_arena_block* b = take_block(&from, first_block, &taken);
  if (b == NULL) return NULL;

  // the arena lives at the head of its own first block
  pl_arena* a = (pl_arena*)(void*)b->data;
  *a = (pl_arena){.alloc = from, .first = b, .current = b, .total = taken};
  b->used = align_up(sizeof(pl_arena));
  return a;
}

void pl_arena_free(pl_arena* a) {
  if (a == NULL) return;
  pleuel_allocator alloc = a->alloc;
  for (pl_arena_block *b = a->first, *next; b != NULL; b = next) {
    next = b->next;
    alloc.give(alloc.user, b);
  }
}

// The next block with room for size: one that a rewind left behind, or a new one.
static void next_block(pl_arena* a, size_t size) {
  pl_arena_block* spare = a->current->next;
  if (spare != NULL && spare->size >= size) {
    spare->used = 0;
    a->current = spare;
    return;
  }
  size_t want = a->current->size * 2;
  if (want > largest_step) want = largest_step;
  if (want < size) want = size;
  if (a->limit != 0 && a->total + want + sizeof(pl_arena_block) + alignment > a->limit) want = size;
  if (a->limit != 0 && a->total + want + sizeof(pl_arena_block) + alignment > a->limit)
    pl_unwind(a, PLEUEL_NO_MEMORY);

  size_t taken = 0;
  pl_arena_block* b = take_block(&a->alloc, want, &taken);
  if (b == NULL) pl_unwind(a, PLEUEL_NO_MEMORY);
  a->total += taken;
  b->next = spare;
  a->current->next = b;
  a->current = b;
}

void* pl_alloc(pl_arena* a, size_t size) {
  if (size > SIZE_MAX / 4) pl_unwind(a, PLEUEL_NO_MEMORY);
  size_t n = align_up(size ? size : 1);
  if (n > a->current->size - a->current->used) next_block(a, n);
  char* at = a->current->data + a->current->used;
  a->current->used += n;
  a->count++;
  ASAN_UNPOISON_MEMORY_REGION(at, n);
  return memset(at, 0, n);
}

void* pl_alloc_array(pl_arena* a, size_t n, size_t size) {
  size_t bytes = 0;
  if (__builtin_mul_overflow(n, size, &bytes)) pl_unwind(a, PLEUEL_NO_MEMORY);
  return pl_alloc(a, bytes);
}

// --------------------------------------------------------------------------------- mark and rewind
pl_mark pl_arena_mark(pl_arena* a) { return (pl_mark){a->current, a->current->used}; }

void pl_arena_rewind(pl_arena* a, pl_mark m) {
  a->current = m.block;
  a->current->used = m.used;
}

// ------------------------------------------------------------------------------------------ guards
void pl_guard_begin(pl_arena* a, pl_guard* g) {
  g->outer = a->guard;
  g->status = PLEUEL_OK;
  a->guard = g;
}

void pl_guard_end(pl_arena* a, pl_guard* g) { a->guard = g->outer; }

_Noreturn void pl_unwind(pl_arena* a, pleuel_status why) {
  pl_guard* g = a->guard;
  assert(g != NULL && "memory ran out and nobody guards the arena");
  if (g == NULL) abort();
  a->guard = g->outer;
  g->status = why;
  longjmp(g->at, 1);
}

// ---------------------------------------------------------------------------------------- counting
size_t pl_arena_total(const pl_arena* a) { return a->total; }
void pl_arena_limit(pl_arena* a, size_t bytes) { a->limit = bytes; }
unsigned long pl_arena_count(const pl_arena* a) { return a->count; }

// --------------------------------------------------------------------------------- growable arrays
// When the array is the last thing in its block it grows in place.
static bool grow_in_place(pl_arena* a, void* at, size_t old_bytes, size_t new_bytes) {
  pl_arena_block* b = a->current;
  char* end = (char*)at + align_up(old_bytes);
  if (end != b->data + b->used) return false;
  size_t more = align_up(new_bytes) - align_up(old_bytes);
  if (more > b->size - b->used) return false;
  memset(end, 0, more);
  b->used += more;
  return true;
}

void* pl_vec_grow(pl_arena* a, void* at, int n, int* cap, size_t size) {
  if (*cap > INT_MAX / 2) pl_unwind(a, PLEUEL_NO_MEMORY);
  int wider = *cap < 4 ? 8 : *cap * 2;
  if (at != NULL && !checked && grow_in_place(a, at, (size_t)*cap * size, (size_t)wider * size)) {
    *cap = wider;
    return at;
  }
  void* to = pl_alloc_array(a, (size_t)wider, size);
  if (n > 0) memcpy(to, at, (size_t)n * size);
  if (at != NULL) ASAN_POISON_MEMORY_REGION(at, (size_t)*cap * size);
  *cap = wider;
  return to;
}
