// The hostile allocator: the n-th allocation fails, for every n. The work unwinds to the guard with
// PLEUEL_NO_MEMORY, the tower can be freed, and nothing is left (looked for by the leak checker of
// the sanitizer build).
#include "algebra/algebra_test_text.h"
#include "verify/verify.h"

#include <stdlib.h>

typedef struct pl_hostile {
  long left;
  long live;
} pl_hostile;

static void* take(void* user, size_t size) {
  pl_hostile* h = user;
  if (h->left-- <= 0) return NULL;
  h->live++;
  return malloc(size);
}

static void give(void* user, void* block) {
  pl_hostile* h = user;
  if (block) h->live--;
  free(block);
}

// What is alive when memory runs out, so that it can be freed.
typedef struct pl_alive {
  pl_tower* tower;
} pl_alive;

static void work(pl_arena* a, pl_job* job, pl_pool* p, volatile pl_alive* alive) {
  alive->tower = pl_tower_make(job, p, NULL, 0);
  pl_world w = {.arena = a, .pool = p, .job = *job, .tower = alive->tower};
  pl_alg_normal(
      w.tower, pl_text_expr(&w, "sqrt(l^2 - r^2*sin(x)^2)/(m1 + m2*cos(x/2)^2) + ln(12*l)*exp(x)"));
  pl_assert_zero(&w, "sqrt(m1*m2)*sqrt(m2) - m2*sqrt(m1)");
  pl_root r[4];
  bool complete = false;
  pl_alg_roots(w.tower, pl_text_expr(&w, "m1*cos(x) + g*sin(x) - l"), pl_text_symbol(&w, "x"), r, 4,
               &complete);
  pl_expr A[4], b[2], x[2];
  for (int i = 0; i < 4; i++) A[i] = pl_text_expr(&w, i % 3 ? "cos(a - b)" : "m1 + m2");
  for (int i = 0; i < 2; i++) b[i] = pl_text_expr(&w, "m1*g");
  assert_int_equal(pl_alg_solve(w.tower, 2, A, b, x, 0), PL_YES);
  pl_domain none = {0};
  pl_verifier* c = pl_verifier_make(job, p, &none);
  assert_int_equal(
      pl_verify(c, pl_text_expr(&w, "(l + r)^2"), pl_text_expr(&w, "l^2 + 2*l*r + r^2")).equal,
      PL_YES);
}

// Some padding first, so that the arena's blocks end elsewhere in the work.
static bool attempt(long n, size_t padding) {
  pl_hostile h = {.left = n};
  pleuel_allocator alloc = {take, give, &h};
  pl_arena* a = pl_arena_make(&alloc);
  if (!a) return false;
  volatile pl_alive alive = {0};
  volatile bool done = false;
  pl_job job = {.arena = a};
  pl_guard guard;
  PL_GUARD(a, guard) {
    if (padding) pl_alloc(a, padding);
    work(a, &job, pl_pool_make(a), &alive);
    done = true;
  }
  else {
    assert_int_equal(guard.status, PLEUEL_NO_MEMORY);
  }
  pl_guard_end(a, &guard);
  pl_tower_free(alive.tower);
  pl_arena_free(a);
  assert_int_equal(h.live, 0);
  return done;
}

PL_TEST(every_allocation_may_fail) {
  pl_random r = {3};
  for (int k = 0; k < 40; k++) {
    long n = 0;
    size_t padding = k ? pl_random_bits(&r) % 60000 : 0;
    while (!attempt(n, padding)) {
      n++;
      assert_true(n < 10000);
    }
    assert_true(n > 3);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_allocation_may_fail)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
