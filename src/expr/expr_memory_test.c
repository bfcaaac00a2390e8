// The hostile allocator: the n-th request fails, for every n. Each time the guard is reached with a
// clean status, everything that was taken is given back, and the pool can still be used.
#include "expr/expr_test_kit.h"

typedef struct hostile {
  long left;  // requests that still succeed
  long open;  // blocks not given back
} hostile;

static void* take(void* user, size_t size) {
  hostile* h = user;
  if (h->left-- <= 0) return NULL;
  h->open++;
  return malloc(size);
}

static void give(void* user, void* block) {
  hostile* h = user;
  h->open--;
  free(block);
}

// Work of every kind, with numbers beyond 64 bits.
static void work(pl_arena* a) {
  pl_pool* p = pl_pool_make(a);
  kit k = kit_make(p, 7);
  pl_symbol x = pl_symbol_of(p, k.names[0]);
  for (int i = 0; i < 12; i++) {
    pl_expr e = kit_random(&k, 4).e;
    pl_expr big = pl_pow_int(p, pl_ratio(p, 10 + i, 7), 150 + i);
    e = pl_add(p, e, pl_mul(p, big, pl_add(p, big, pl_ratio(p, 1, 3))));
    pl_dt(p, pl_diff(p, e, x));
    pl_expand(p, pl_pow_int(p, pl_add(p, e, k.names[1]), 3), 500);
    pl_form_value(p, pl_form_of(a, p, e));
    pl_expr_text(a, p, pl_subst1(p, e, x, pl_sqrt(p, pl_mul(p, big, k.names[2]))));
    bool ok;
    pl_eval_mod(pl_mod_point_make(a, p, 3), e, &ok);
    pl_eval(p, e, k.values);
  }
}

// Does the work get done when all requests after the n-th fail? The filler moves the ends of the
// blocks, so that the failure falls on another allocation.
static bool done_with(long n, size_t filler) {
  hostile h = {.left = n};
  pleuel_allocator alloc = {take, give, &h};
  pl_arena* a = pl_arena_make(&alloc);
  volatile bool done = false;
  if (a != NULL) {
    pl_guard guard;
    PL_GUARD(a, guard) {
      pl_alloc(a, filler);
      work(a);
      done = true;
    }
    else {
      assert_int_equal(guard.status, PLEUEL_NO_MEMORY);
    }
    pl_guard_end(a, &guard);
    pl_arena_free(a);
  }
  assert_int_equal(h.open, 0);
  return done;
}

static void every_failing_request_ends_cleanly(void** state) {
  long failures = 0;
  for (size_t filler = 64; filler < 15000; filler += 64 * 11) {
    for (long n = 0; !done_with(n, filler); n++) failures++;
  }
  assert_true(failures > 60);
}

// With the limit on bytes in place of requests the failure can fall between any two blocks;
// afterwards the same construction gives the same text.
static void a_pool_survives_the_limit(void** state) {
  pl_arena* a = pl_arena_make(NULL);
  pl_guard guard;
  pl_pool* volatile p = NULL;
  PL_GUARD(a, guard) { p = pl_pool_make(a); }
  pl_guard_end(a, &guard);
  assert_non_null(p);

  volatile int unwound = 0;
  for (volatile int round = 0; round < 60; round++) {
    pl_arena_limit(a, pl_arena_total(a) + 1);
    PL_GUARD(a, guard) {
      kit k = kit_make(p, (uint64_t)round);
      for (int i = 0; i < 40; i++) pl_expand(p, pl_pow_int(p, kit_random(&k, 3).e, 4), 200);
    }
    else {
      unwound++;
      pl_arena_limit(a, 0);
      PL_GUARD(a, guard) {
        kit k = kit_make(p, (uint64_t)round);
        pl_expr e = kit_random(&k, 4).e;
        pl_pool* fresh = pl_pool_make(a);
        kit f = kit_make(fresh, (uint64_t)round);
        pl_expr again = kit_random(&f, 4).e;
        assert_string_equal(pl_expr_text(a, p, e), pl_expr_text(a, fresh, again));
      }
      pl_guard_end(a, &guard);
      continue;
    }
    pl_guard_end(a, &guard);
  }
  pl_arena_free(a);
  assert_true(unwound > 3);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_failing_request_ends_cleanly),
      cmocka_unit_test(a_pool_survives_the_limit),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
