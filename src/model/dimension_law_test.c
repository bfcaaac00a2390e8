// Laws of dimension inference on random input.
//   What fits is never reported, and what is inferred is what was meant.
//   A sum of two different dimensions is always reported.
// Each name has a dimension that the generator knows; for some the model is told, the others have
// to be found.
#include "model/model_test_kit.h"

static const uint64_t seed = 0x9d1e;
enum { N_DECLARED = 6, N_HIDDEN = 4, N_ROUNDS = 400 };

typedef struct world {
  kit* k;
  pl_pool* p;
  pl_random r;
  pl_expr name[N_DECLARED + N_HIDDEN];
  pl_dimension meant[N_DECLARED + N_HIDDEN];
  int n_names;  // that expressions may use
} world;

static int pick(world* w, int n) { return (int)(pl_random_bits(&w->r) % (uint64_t)n); }

static pl_dimension random_dimension(world* w) {
  return pl_dimension_of(pick(w, 5) - 2, pick(w, 3) - 1, pick(w, 5) - 2);
}

static world world_make(uint64_t round, bool hidden) {
  static const char* const names[] = {"a", "b", "c", "d", "f", "h", "p", "q", "r", "s"};
  static const char* const units[] = {"m", "kg", "s", "m/s", "N", "1"};
  world w = {.k = kit_make(NULL), .r = {seed + round * 1000003}};
  w.p = w.k->m->pool;
  w.n_names = hidden ? N_DECLARED + N_HIDDEN : N_DECLARED;
  for (int i = 0; i < w.n_names; i++) {
    bool declared = i < N_DECLARED;
    w.name[i] = param(w.k, names[i], NULL, declared ? units[i] : NULL, NULL);
    w.meant[i] = declared ? unit_of(w.k, units[i]).dimension : random_dimension(&w);
  }
  return w;
}

// Product of powers of a (m), b (kg), c (s), and sometimes a hidden name, that has the dimension d.
static pl_expr leaf(world* w, pl_dimension d) {
  pl_expr e = pl_int(w->p, 1 + pick(w, 3));
  if (pick(w, 2)) {
    int i = pick(w, w->n_names);
    e = pl_mul(w->p, e, w->name[i]);
    d = pl_dimension_div(d, w->meant[i]);
  }
  for (int i = 0; i < 3; i++) {
    if (d.num[i]) e = pl_mul(w->p, e, pl_pow(w->p, w->name[i], pl_ratio(w->p, d.num[i], d.den[i])));
  }
  return e;
}

static pl_expr fitting(world* w, pl_dimension d, int depth) {
  if (depth == 0) return leaf(w, d);
  switch (pick(w, 6)) {
    case 0: return pl_add(w->p, fitting(w, d, depth - 1), fitting(w, d, depth - 1));
    case 1: {
      pl_dimension x = random_dimension(w);
      return pl_mul(w->p, fitting(w, x, depth - 1), fitting(w, pl_dimension_div(d, x), depth - 1));
    }
    case 2: return pl_sqrt(w->p, fitting(w, pl_dimension_pow(d, 2, 1), depth - 1));
    case 3: return pl_square(w->p, fitting(w, pl_dimension_pow(d, 1, 2), depth - 1));
    case 4: {
      pl_expr angle = fitting(w, pl_dimension_one(), depth - 1);
      return pl_mul(w->p, leaf(w, d), pl_call(w->p, pick(w, 2) ? PL_SIN : PL_ATAN, angle));
    }
    default: return pl_sub(w->p, fitting(w, d, depth - 1), leaf(w, d));
  }
}

static void claim(world* w, pl_expr left, pl_expr right) {
  pl_condition c = {left, right, PL_LE, {0}};
  pl_push(w->k->arena, w->k->m->assumptions,
          (pl_assumption){.kind = PL_A_RELATION, .condition = c});
}

static int complaints(const world* w) { return w->k->diagnostics.n_errors; }

static void show_claims(world* w, uint64_t round) {
  print_message("seed %#lx round %lu\n", (unsigned long)seed, (unsigned long)round);
  for (int i = 0; i < w->k->m->assumptions.n; i++) {
    const pl_condition* c = &w->k->m->assumptions.at[i].condition;
    print_message("  %s <= %s\n", pl_expr_text(w->k->arena, w->p, c->left),
                  pl_expr_text(w->k->arena, w->p, c->right));
  }
  show(w->k);
}

PL_TEST(what_fits_is_never_reported) {
  for (uint64_t round = 0; round < N_ROUNDS; round++) {
    world w = world_make(round, true);
    for (int i = 0; i < 4; i++) {
      pl_dimension d = random_dimension(&w);
      pl_expr left = fitting(&w, d, 3), right = fitting(&w, d, 3);
      if (pl_is_poison(left) || pl_is_poison(right)) continue;
      claim(&w, left, right);
    }
    pl_check_dimensions(&w.k->job, w.k->m);
    if (complaints(&w)) show_claims(&w, round);
    assert_int_equal(complaints(&w), 0);
    kit_free(w.k);
  }
}

PL_TEST(what_is_inferred_is_what_was_meant) {
  int found = 0;
  for (uint64_t round = 0; round < N_ROUNDS; round++) {
    world w = world_make(round, true);
    for (int i = 0; i < 5; i++) {
      pl_dimension d = random_dimension(&w);
      pl_expr left = fitting(&w, d, 2), right = fitting(&w, d, 2);
      if (!pl_is_poison(left) && !pl_is_poison(right)) claim(&w, left, right);
    }
    pl_check_dimensions(&w.k->job, w.k->m);
    for (int i = 0; i < w.n_names; i++) {
      const pl_symbol_info* info = pl_symbol_get(w.p, pl_symbol_of(w.p, w.name[i]));
      if (!info->dimension_known) continue;
      found += i >= N_DECLARED;
      if (!pl_dimension_equal(info->dimension, w.meant[i])) show_claims(&w, round);
      assert_true(pl_dimension_equal(info->dimension, w.meant[i]));
    }
    kit_free(w.k);
  }
  assert_true(found > N_ROUNDS);  // most hidden names are found: the law is not empty
}

// A sum of one dimension with another, somewhere deep in a claim.
PL_TEST(what_does_not_fit_is_always_reported) {
  int tried = 0;
  for (uint64_t round = 0; round < N_ROUNDS; round++) {
    world w = world_make(round, false);
    pl_dimension d = random_dimension(&w), other = random_dimension(&w);
    pl_expr left = fitting(&w, d, 2), right = fitting(&w, other, 2);
    bool usable = !pl_dimension_equal(d, other) && !pl_is_poison(left) && !pl_is_poison(right)
                  && !pl_is_constant(w.p, left) && !pl_is_constant(w.p, right);
    if (usable) {
      tried++;
      pl_expr sum = pl_add(w.p, left, right);
      if (pick(&w, 2))
        sum = pl_mul(w.p, leaf(&w, pl_dimension_one()),
                     pl_sqrt(w.p, pl_square(w.p, pl_add(w.p, sum, left))));
      claim(&w, sum, leaf(&w, d));
      pl_check_dimensions(&w.k->job, w.k->m);
      if (!complaints(&w)) show_claims(&w, round);
      assert_true(complaints(&w) > 0);
    }
    kit_free(w.k);
  }
  assert_true(tried > N_ROUNDS / 2);
}

// Sides of two different dimensions, with names whose dimension is not declared but fixed by
// another claim.
PL_TEST(a_wrong_relation_through_hidden_names_is_reported) {
  for (uint64_t round = 0; round < N_ROUNDS; round++) {
    world w = world_make(round, true);
    int i = N_DECLARED + pick(&w, N_HIDDEN);
    pl_dimension d = w.meant[i], other = random_dimension(&w);
    w.n_names = N_DECLARED;
    claim(&w, w.name[i], leaf(&w, d));
    pl_expr right = leaf(&w, other);
    bool constant = pl_is_constant(w.p, right)
                    || pl_is_constant(w.p, w.k->m->assumptions.at[0].condition.right);
    if (!constant && !pl_dimension_equal(d, other)) {
      claim(&w, w.name[i], right);
      pl_check_dimensions(&w.k->job, w.k->m);
      if (complaints(&w) != 1) show_claims(&w, round);
      assert_int_equal(complaints(&w), 1);
    }
    kit_free(w.k);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_fits_is_never_reported),
      cmocka_unit_test(what_is_inferred_is_what_was_meant),
      cmocka_unit_test(what_does_not_fit_is_always_reported),
      cmocka_unit_test(a_wrong_relation_through_hidden_names_is_reported),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
