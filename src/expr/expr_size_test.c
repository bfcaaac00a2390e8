// Large and deep expressions: no stack, no quadratic passes, and answers within the patience of a
// reader.
#include "expr/expr_test_kit.h"

// generous: the passes take tenths; quadratic ones would take minutes
static const double patience_s = 20;

static pl_expr* make_row(pl_pool* p, pl_arena* a, int n) {
  pl_expr* x = PL_ARRAY(a, pl_expr, n);
  for (int i = 0; i < n; i++) x[i] = kit_coordinate(p, pl_format(a, "x%d", i));
  return x;
}

PL_TEST(a_hundred_thousand_nodes_are_differentiated_at_once) {
  enum { N = 20000 };
  double start = pl_clock();
  pl_expr *x = make_row(p, a, N + 1), *terms = PL_ARRAY(a, pl_expr, N);
  for (int i = 0; i < N; i++) {
    terms[i] = pl_mul(p, pl_square(p, pl_sub(p, x[i + 1], x[i])), pl_call(p, PL_COS, x[i]));
  }
  pl_expr e = pl_add_n(p, terms, N);
  assert_true(pl_dag_size(p, e) > 100000);
  pl_expr d = pl_diff(p, e, pl_symbol_of(p, x[N / 2]));
  assert_true(pl_dag_size(p, d) < 30);
  pl_expr rate = pl_dt(p, e);
  bool ok = false;
  pl_eval_mod(pl_mod_point_make(a, p, 1), rate, &ok);
  assert_true(ok);
  assert_true(pl_same(pl_form_value(p, pl_form_of(a, p, e)), e));
  assert_true(strlen(pl_expr_text(a, p, e)) > 100000);
  assert_true(pl_clock() - start < patience_s);
}

PL_TEST(depth_costs_no_stack) {
  pl_expr x = kit_coordinate(p, "x"), y = kit_coordinate(p, "y"), e = x, f = y;
  for (int i = 0; i < 30000; i++) {
    e = pl_call(p, PL_SIN, pl_add(p, pl_call(p, PL_COS, e), pl_int(p, 1)));
    f = pl_call(p, PL_SIN, pl_add(p, pl_call(p, PL_COS, f), pl_int(p, 1)));
  }
  pl_expr s = pl_add(p, e, f);
  assert_int_equal(pl_n_args(p, s), 2);
  assert_true(pl_same(pl_subst1(p, f, pl_symbol_of(p, y), x), e));
  assert_true(pl_has_symbol(p, s, pl_symbol_of(p, y)));
  double values[3] = {0, 1, 2};
  assert_true(isfinite(pl_eval(p, s, values)));
  assert_non_null(pl_form_of(a, p, s));
  assert_non_null(strstr(pl_expr_text(a, p, s), "nested"));
}

// x -> x^2 + x, forty times: a trillion operators as a tree, a hundred nodes as a DAG.
PL_TEST(sharing_is_kept_in_every_pass) {
  pl_expr x = kit_coordinate(p, "x"), e = x;
  for (int i = 0; i < 40; i++) e = pl_mul(p, pl_add(p, e, pl_int(p, 1)), pl_call(p, PL_COS, e));
  double start = pl_clock(), values[2] = {0, 0.5};
  assert_true(pl_dag_size(p, e) < 200);
  assert_true(pl_op_count(p, e) > 1000000000);
  assert_true(pl_dag_size(p, pl_diff(p, e, pl_symbol_of(p, x))) < 4000);
  assert_true(isfinite(pl_eval(p, e, values)));
  assert_int_equal(pl_n_args(p, pl_expand(p, e, 100)), 41);
  assert_true(pl_same(pl_expand(p, e, 40), e));
  assert_non_null(strstr(pl_expr_text(a, p, e), "operators"));
  assert_int_equal(pl_form_of(a, p, e)->kind, PL_F_PRODUCT);
  bool ok;
  pl_eval_mod(pl_mod_point_make(a, p, 1), pl_call(p, PL_SIN, e), &ok);
  assert_true(pl_clock() - start < patience_s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_hundred_thousand_nodes_are_differentiated_at_once),
      cmocka_unit_test(depth_costs_no_stack),
      cmocka_unit_test(sharing_is_kept_in_every_pass),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
