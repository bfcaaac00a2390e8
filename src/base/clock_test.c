// The wish to stop: from outside, and of the one who is asked now and then.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/base.h"

typedef struct looks {
  int n, stop_at;
} looks;

static bool look(void* user) {
  looks* l = user;
  return ++l->n == l->stop_at;
}

static void a_flag_from_outside_stops_until_it_is_cleared(void** state) {
  (void)state;
  pl_interruption i = {0};
  pl_job job = {.interrupted = &i};
  assert_false(pl_interrupted(&job));
  atomic_store(&i.asked, 1);
  assert_true(pl_interrupted(&job));
  atomic_store(&i.asked, 0);
  assert_false(pl_interrupted(&job));
  assert_false(pl_interrupted(&(pl_job){0}));
}

// However often a job asks, the caller is called about ten times a second; what it says holds.
static void the_caller_is_asked_now_and_then(void** state) {
  (void)state;
  looks l = {0, 3};
  pl_interruption i = {.look = look, .user = &l};
  pl_job job = {.interrupted = &i};
  double begin = pl_clock();
  long calls = 0;
  while (!pl_interrupted(&job) && pl_clock() - begin < 10) calls++;
  double took = pl_clock() - begin;
  assert_int_equal(l.n, 3);
  assert_true(took > 0.15 && took < 5);
  assert_true(calls > 1000);
  assert_true(pl_interrupted(&job));
  assert_int_equal(l.n, 3);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_flag_from_outside_stops_until_it_is_cleared),
      cmocka_unit_test(the_caller_is_asked_now_and_then),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
