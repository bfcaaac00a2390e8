// Laws on random expressions.  A failure prints the seed and the operands.
#include "expr/expr_test_kit.h"

enum { N_ROUNDS = 300 };
static const uint64_t first_seed = 20240;

#define EACH_SEED(seed) for (uint64_t seed = first_seed; seed < first_seed + N_ROUNDS; seed++)

static const char* text(pl_pool* p, pl_expr e) { return pl_expr_text(pl_pool_arena(p), p, e); }

static void check(bool holds, uint64_t seed, pl_pool* p, pl_expr x, pl_expr y) {
  if (!holds)
    print_message("seed %llu\n  %s\n  %s\n", (unsigned long long)seed, text(p, x), text(p, y));
  assert_true(holds);
}

// The value that was computed beside the constructors, wherever it is tame.
PL_TEST(constructors_keep_the_value) {
  int compared = 0;
  EACH_SEED(seed) {
    kit k = kit_make(p, seed);
    kit_pair x = kit_random(&k, 4);
    if (!isfinite(x.value) || fabs(x.value) > 1e5) continue;
    compared++;
    double value = pl_eval(p, x.e, k.values);
    if (!kit_close(value, x.value)) print_message("%.17g, wanted %.17g\n", value, x.value);
    check(kit_close(value, x.value), seed, p, x.e, x.e);
  }
  assert_true(compared > N_ROUNDS / 2);
}

PL_TEST(sums_and_products_do_not_depend_on_order_or_grouping) {
  EACH_SEED(seed) {
    kit k = kit_make(p, seed);
    pl_expr x[5];
    for (int i = 0; i < 5; i++) x[i] = kit_random(&k, 2).e;
    pl_expr sum = pl_add_n(p, x, 5), product = pl_mul_n(p, x, 5), sum2 = x[4], product2 = x[4];
    for (int i = 3; i >= 0; i--) {
      sum2 = pl_add(p, x[i], sum2);
      product2 = pl_mul(p, product2, x[i]);
    }
    check(pl_same(sum, sum2), seed, p, sum, sum2);
    check(pl_same(product, product2) || kit_equal(p, product, product2, seed), seed, p, product,
          product2);
    pl_expr back[5];
    for (int i = 0; i < 5; i++) back[i] = x[4 - i];
    check(pl_same(sum, pl_add_n(p, back, 5)), seed, p, sum, pl_add_n(p, back, 5));
    check(pl_same(product, pl_mul_n(p, back, 5)), seed, p, product, pl_mul_n(p, back, 5));
  }
}

PL_TEST(a_rebuilt_expression_is_the_same_handle) {
  EACH_SEED(seed) {
    kit k = kit_make(p, seed);
    pl_expr e = kit_random(&k, 4).e, x = k.names[0], other = kit_coordinate(p, "other");
    pl_expr there = pl_subst1(p, e, pl_symbol_of(p, x), other);
    pl_expr back = pl_subst1(p, there, pl_symbol_of(p, other), x);
    // the sign that parity puts outside may depend on the names; the value may not
    check(pl_same(e, back) || pl_is_poison(e) || kit_equal(p, e, back, seed), seed, p, e, back);
  }
}

PL_TEST(the_derivative_obeys_the_product_rule) {
  EACH_SEED(seed) {
    kit k = kit_make(p, seed);
    k.rational = seed % 2 == 0;
    pl_expr f = kit_random(&k, 2).e, g = kit_random(&k, 2).e;
    if (pl_is_poison(f) || pl_is_poison(g)) continue;
    pl_symbol x = pl_symbol_of(p, k.names[0]);
    pl_expr left = pl_diff(p, pl_mul(p, f, g), x);
    pl_expr right = pl_add(p, pl_mul(p, pl_diff(p, f, x), g), pl_mul(p, f, pl_diff(p, g, x)));
    if (pl_is_poison(left) || pl_is_poison(right)) continue;
    pl_expr gap = pl_sub(p, left, right);
    bool ok = false;
    for (uint64_t n = 0; n < 40 && !ok; n++) {
      uint64_t value = pl_eval_mod(pl_mod_point_make(a, p, seed * 64 + n), gap, &ok);
      if (ok) check(value == 0, seed, p, f, g);
    }
  }
}

PL_TEST(the_derivative_is_the_slope) {
  int compared = 0;
  EACH_SEED(seed) {
    kit k = kit_make(p, seed);
    pl_expr f = kit_random(&k, 3).e;
    pl_symbol x = pl_symbol_of(p, k.names[0]);
    pl_expr df = pl_diff(p, f, x);
    const double h = 1e-5;
    double at = k.values[x.id], y[4];
    for (int i = 0; i < 4; i++) {
      k.values[x.id] = at + (i < 2 ? i - 2 : i - 1) * h;
      y[i] = pl_eval(p, f, k.values);
    }
    k.values[x.id] = at;
    double slope = (8 * (y[2] - y[1]) - (y[3] - y[0])) / (12 * h), value = pl_eval(p, df, k.values);
    if (!isfinite(slope) || fabs(slope) > 1e3 || fabs(y[1]) > 1e3 || pl_is_poison(f)) continue;
    compared++;
    check(fabs(slope - value) < 1e-4 * (1 + fabs(slope)), seed, p, f, df);
  }
  assert_true(compared > N_ROUNDS / 2);
}

// d/dt f(x, y, phi, t) = f_x x' + f_y y' + f_phi phi' + f_t
PL_TEST(the_rate_in_time_is_the_chain_rule) {
  EACH_SEED(seed) {
    kit k = kit_make(p, seed);
    pl_expr f = kit_random(&k, 3).e;
    pl_expr chain = pl_diff(p, f, pl_time(p));
    for (int i = 0; i < 3; i++) {
      pl_symbol x = pl_symbol_of(p, k.names[i]);
      chain = pl_add(p, chain, pl_mul(p, pl_diff(p, f, x), pl_sym(p, pl_symbol_dot(p, x))));
    }
    pl_expr rate = pl_dt(p, f);
    if (pl_is_poison(f) || pl_is_poison(chain)) continue;
    bool ok = false;
    uint64_t value = pl_eval_mod(pl_mod_point_make(a, p, seed), pl_sub(p, rate, chain), &ok);
    if (ok) check(value == 0, seed, p, rate, chain);
    check(pl_is_poison(rate) == pl_is_poison(chain), seed, p, rate, chain);
  }
}

PL_TEST(expansion_keeps_the_value) {
  EACH_SEED(seed) {
    kit k = kit_make(p, seed);
    k.rational = true;
    pl_expr e = kit_random(&k, 4).e, expanded = pl_expand(p, e, 2000);
    if (pl_is_poison(e)) continue;
    check(kit_equal(p, e, expanded, seed), seed, p, e, expanded);
    check(pl_same(pl_expand(p, expanded, 2000), expanded), seed, p, e, expanded);
  }
}

PL_TEST(substitution_is_evaluation_with_other_values) {
  EACH_SEED(seed) {
    kit k = kit_make(p, seed);
    pl_expr e = kit_random(&k, 3).e;
    kit_pair u = kit_random(&k, 1), v = kit_random(&k, 1);
    if (!isfinite(u.value) || !isfinite(v.value)) continue;
    pl_symbol x = pl_symbol_of(p, k.names[0]), y = pl_symbol_of(p, k.names[1]);
    pl_expr put = pl_subst(p, e, (pl_replace[]){{x, u.e}, {y, v.e}}, 2);
    double left = pl_eval(p, put, k.values);
    k.values[x.id] = u.value;
    k.values[y.id] = v.value;
    double right = pl_eval(p, e, k.values);
    if (!isfinite(right) || !isfinite(left) || fabs(right) > 1e5) continue;
    check(kit_close(left, right), seed, p, e, put);
  }
}

PL_TEST(a_form_has_the_value_of_its_expression) {
  EACH_SEED(seed) {
    kit k = kit_make(p, seed);
    pl_expr e = kit_random(&k, 4).e;
    pl_form* f = pl_form_of(a, p, e);
    check(pl_same(pl_form_value(p, f), e), seed, p, e, pl_form_value(p, f));
    if (pl_form_ops(f) != pl_op_count(p, e))
      print_message("%ld, %ld\n", pl_form_ops(f), pl_op_count(p, e));
    check(pl_form_ops(f) == pl_op_count(p, e), seed, p, e, e);
  }
}

PL_TEST(residues_add_and_multiply) {
  EACH_SEED(seed) {
    kit k = kit_make(p, seed);
    pl_expr x = kit_random(&k, 3).e, y = kit_random(&k, 3).e;
    pl_mod_point* m = pl_mod_point_make(a, p, seed);
    bool ok[4];
    uint64_t u = pl_eval_mod(m, x, &ok[0]), v = pl_eval_mod(m, y, &ok[1]);
    uint64_t sum = pl_eval_mod(m, pl_add(p, x, y), &ok[2]),
             product = pl_eval_mod(m, pl_mul(p, x, y), &ok[3]);
    if (ok[0] && ok[1] && ok[2]) check(sum == pl_mod_add(u, v), seed, p, x, y);
    if (ok[0] && ok[1] && ok[3]) check(product == pl_mod_mul(u, v), seed, p, x, y);
  }
}

PL_TEST(what_is_not_zero_is_not_zero_modulo_p) {
  int refuted = 0, asked = 0;
  EACH_SEED(seed) {
    kit k = kit_make(p, seed);
    kit_pair x = kit_random(&k, 3), y = kit_random(&k, 3);
    if (!isfinite(x.value) || !isfinite(y.value) || kit_close(x.value, y.value)) continue;
    bool ok = false;
    uint64_t value = pl_eval_mod(pl_mod_point_make(a, p, seed), pl_sub(p, x.e, y.e), &ok);
    asked += ok;
    refuted += ok && value != 0;
  }
  assert_true(asked > 50);
  assert_int_equal(refuted, asked);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(constructors_keep_the_value),
      cmocka_unit_test(sums_and_products_do_not_depend_on_order_or_grouping),
      cmocka_unit_test(a_rebuilt_expression_is_the_same_handle),
      cmocka_unit_test(the_derivative_obeys_the_product_rule),
      cmocka_unit_test(the_derivative_is_the_slope),
      cmocka_unit_test(the_rate_in_time_is_the_chain_rule),
      cmocka_unit_test(expansion_keeps_the_value),
      cmocka_unit_test(substitution_is_evaluation_with_other_values),
      cmocka_unit_test(a_form_has_the_value_of_its_expression),
      cmocka_unit_test(residues_add_and_multiply),
      cmocka_unit_test(what_is_not_zero_is_not_zero_modulo_p),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
