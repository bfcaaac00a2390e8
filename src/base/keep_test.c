// A state that is written down reads back as it was; one that does not fit is seen, whatever it
// holds.
#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

#include "base/base.h"

typedef struct state {
  double x, list[5];
  int way;
  long steps;
  bool on, flags[3];
  const char *name, *none;
} state;

static void visit(pl_keeper* k, state* s) {
  pl_keep_section(k, "first");
  pl_keep_f64(k, &s->x);
  pl_keep_f64s(k, s->list, 5);
  pl_keep_int(k, &s->way, -1, 1);
  pl_keep_section(k, "a second one with a long name");
  pl_keep_long(k, &s->steps, 0, 1000);
  pl_keep_bool(k, &s->on);
  pl_keep_bools(k, s->flags, 3);
  pl_keep_text(k, &s->name);
  pl_keep_text(k, &s->none);
}

static const state example = {0.1,  {1, 2, 3, -0.0, 1e300}, -1,        77,
                              true, {true, false, true},    "ϑ = 90°", NULL};

static void a_state_reads_back_as_it_was(void** unused) {
  (void)unused;
  pl_arena* a = pl_arena_make(NULL);
  state s = example, back = {.way = 5, .none = "gone"};
  pl_keeper out = pl_keeper_to_write(a);
  visit(&out, &s);
  pl_keeper in = pl_keeper_to_read(a, out.at, out.next);
  visit(&in, &back);
  assert_true(pl_keep_is_whole(&in));
  assert_memory_equal(back.list, s.list, sizeof s.list);
  assert_true(back.x == s.x && back.way == -1 && back.steps == 77 && back.on && !back.flags[1]
              && back.flags[2]);
  assert_string_equal(back.name, s.name);
  assert_null(back.none);
  pl_arena_free(a);
}

static void what_is_cut_off_or_goes_on_is_seen(void** unused) {
  (void)unused;
  pl_arena* a = pl_arena_make(NULL);
  state s = example;
  pl_keeper out = pl_keeper_to_write(a);
  visit(&out, &s);
  for (size_t n = 0; n < out.next; n++) {
    unsigned char* part = pl_alloc(a, n + 1);
    memcpy(part, out.at, n);
    pl_keeper in = pl_keeper_to_read(a, part, n);
    state back = {0};
    visit(&in, &back);
    assert_false(pl_keep_is_whole(&in));
  }
  pl_keep_bool(&out, &s.on);
  pl_keeper in = pl_keeper_to_read(a, out.at, out.next);
  state back = {0};
  visit(&in, &back);
  assert_true(in.wrong == NULL && !pl_keep_is_whole(&in));
  pl_arena_free(a);
}

static void no_bytes_are_trusted(void** unused) {
  (void)unused;
  for (uint64_t seed = 1; seed <= 2000; seed++) {
    pl_arena* a = pl_arena_make(NULL);
    pl_random r = {seed};
    state s = example, back = {0};
    pl_keeper out = pl_keeper_to_write(a);
    visit(&out, &s);
    for (int i = 0; i < 4; i++)
      out.at[pl_random_bits(&r) % out.next] = (unsigned char)pl_random_bits(&r);
    pl_keeper in = pl_keeper_to_read(a, out.at, out.next);
    visit(&in, &back);
    assert_true(back.way >= -1 && back.way <= 1 && back.steps >= 0 && back.steps <= 1000);
    pl_arena_free(a);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_state_reads_back_as_it_was),
      cmocka_unit_test(what_is_cut_off_or_goes_on_is_seen),
      cmocka_unit_test(no_bytes_are_trusted),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
