// Arenas: alignment, zeroes, mark and rewind, guards, limits, growth.
#include "base/base_test_kit.h"

PL_TEST(memory_is_aligned_and_zeroed_also_after_a_rewind) {
  pl_mark m = pl_arena_mark(a);
  for (int round = 0; round < 3; round++) {
    for (size_t size = 0; size < 3000; size += 37) {
      char* at = pl_alloc(a, size);
      assert_int_equal((uintptr_t)at % 64, 0);
      for (size_t i = 0; i < size; i++) assert_int_equal(at[i], 0);
      memset(at, 0xff, size);
    }
    pl_arena_rewind(a, m);
  }
}

PL_TEST(a_rewind_makes_the_next_pass_free) {
  pl_mark m = pl_arena_mark(a);
  for (int i = 0; i < 100; i++) pl_alloc(a, 5000);
  size_t total = pl_arena_total(a);
  for (int round = 0; round < 5; round++) {
    pl_arena_rewind(a, m);
    for (int i = 0; i < 100; i++) pl_alloc(a, 5000);
  }
  assert_int_equal(pl_arena_total(a), total);
}

PL_TEST(what_was_taken_before_the_mark_survives) {
  int* kept = PL_ARRAY(a, int, 100);
  for (int i = 0; i < 100; i++) kept[i] = i;
  pl_mark m = pl_arena_mark(a);
  memset(pl_alloc(a, 1 << 20), 7, 1 << 20);
  pl_arena_rewind(a, m);
  memset(pl_alloc(a, 1 << 16), 9, 1 << 16);
  for (int i = 0; i < 100; i++) assert_int_equal(kept[i], i);
}

PL_TEST(the_limit_unwinds_to_the_innermost_guard) {
  pl_guard outer, inner;
  volatile int reached = 0;
  pl_arena_limit(a, 1 << 20);
  PL_GUARD(a, outer) {
    PL_GUARD(a, inner) {
      for (;;) pl_alloc(a, 1000);
    }
    else {
      reached = 1;
      assert_int_equal(inner.status, PLEUEL_NO_MEMORY);
    }
    pl_guard_end(a, &inner);
    pl_unwind(a, PLEUEL_INTERRUPTED);
  }
  else {
    reached += 2;
    assert_int_equal(outer.status, PLEUEL_INTERRUPTED);
  }
  pl_guard_end(a, &outer);
  assert_int_equal(reached, 3);
  assert_true(pl_arena_total(a) <= 1 << 20);
}

PL_TEST(absurd_sizes_unwind) {
  size_t absurd[][2] = {{SIZE_MAX, 1}, {SIZE_MAX / 2, 3}, {1, SIZE_MAX - 10}, {(size_t)1 << 62, 1}};
  for (volatile size_t i = 0; i < 4; i++) {
    pl_guard g;
    volatile bool fell = false;
    PL_GUARD(a, g) { pl_alloc_array(a, absurd[i][0], absurd[i][1]); }
    else {
      fell = true;
    }
    pl_guard_end(a, &g);
    assert_true(fell);
  }
}

PL_TEST(arrays_grow_and_keep_what_they_hold) {
  PL_VEC(int) v = {0};
  PL_VEC(int) w = {0};
  for (int i = 0; i < 10000; i++) {
    pl_push(a, v, i);
    if (i % 3 == 0) pl_push(a, w, -i);  // so that v cannot always grow in place
  }
  for (int i = 0; i < v.n; i++) assert_int_equal(v.at[i], i);
  for (int i = 0; i < w.n; i++) assert_int_equal(w.at[i], -3 * i);
}

PL_TEST(allocations_are_counted) {
  unsigned long before = pl_arena_count(a);
  pl_alloc(a, 1);
  pl_alloc(a, 100000);
  assert_int_equal(pl_arena_count(a), before + 2);
}

static void* take_nothing(void* user, size_t size) { return NULL; }
static void give_nothing(void* user, void* block) {}

PL_TEST(an_arena_without_memory_is_null) {
  pleuel_allocator none = {take_nothing, give_nothing, NULL};
  assert_null(pl_arena_make(&none));
  pl_arena_free(NULL);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(memory_is_aligned_and_zeroed_also_after_a_rewind),
      cmocka_unit_test(a_rewind_makes_the_next_pass_free),
      cmocka_unit_test(what_was_taken_before_the_mark_survives),
      cmocka_unit_test(the_limit_unwinds_to_the_innermost_guard),
      cmocka_unit_test(absurd_sizes_unwind),
      cmocka_unit_test(arrays_grow_and_keep_what_they_hold),
      cmocka_unit_test(allocations_are_counted),
      cmocka_unit_test(an_arena_without_memory_is_null),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
