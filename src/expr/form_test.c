// The plain form: order of rule K5, signs and fractions. The forms are compared through a small
// printer of their own.
#include "expr/expr_test_kit.h"

static void show(pl_text* t, pl_pool* p, const pl_form* f);

static void show_all(pl_text* t, pl_pool* p, const pl_form* f, const char* between) {
  for (int i = 0; i < f->n; i++) {
    bool minus = f->kind == PL_F_SUM && i > 0 && f->args[i]->kind == PL_F_NEG;
    if (i > 0) pl_text_add(t, minus ? " - " : between);
    show(t, p, minus ? f->args[i]->args[0] : f->args[i]);
  }
}

static void show_between(pl_text* t, pl_pool* p, const pl_form* f, const char* open,
                         const char* between, const char* shut) {
  pl_text_add(t, open);
  show_all(t, p, f, between);
  pl_text_add(t, shut);
}

static void show(pl_text* t, pl_pool* p, const pl_form* f) {
  switch (f->kind) {
    case PL_F_EXPR: pl_text_add(t, pl_expr_text(pl_pool_arena(p), p, f->expr)); return;
    case PL_F_SUM: show_between(t, p, f, "(", " + ", ")"); return;
    case PL_F_NEG: show_between(t, p, f, "-", "", ""); return;
    case PL_F_PRODUCT: show_all(t, p, f, " "); return;
    case PL_F_QUOTIENT: show_between(t, p, f, "{", " | ", "}"); return;
    case PL_F_POWER: show_all(t, p, f, "^"); return;
    case PL_F_ROOT: show_between(t, p, f, "root[", "", "]"); return;
    case PL_F_CALL: show_between(t, p, f, pl_function_name[f->function], ", ", ""); return;
    default: pl_text_add(t, "?"); return;
  }
}

static void assert_form(pl_pool* p, pl_expr e, const char* wanted) {
  pl_text t = pl_text_make(pl_pool_arena(p));
  const pl_form* f = pl_form_of(pl_pool_arena(p), p, e);
  show(&t, p, f);
  assert_string_equal(pl_text_string(&t), wanted);
  assert_true(pl_same(pl_form_value(p, f), e));
}

typedef struct words {
  pl_expr m, m1, m2, m10, g, l, r, R, theta, phi, x, v;
} words;

static words make_words(pl_pool* p) {
  words w = {
      .m = kit_parameter(p, "m", PL_C_MASS),
      .m1 = kit_parameter(p, "m1", PL_C_MASS),
      .m2 = kit_parameter(p, "m2", PL_C_MASS),
      .m10 = kit_parameter(p, "m10", PL_C_MASS),
      .g = kit_parameter(p, "g", PL_C_GRAVITY),
      .l = kit_parameter(p, "l", PL_C_LENGTH),
      .r = kit_parameter(p, "r", PL_C_LENGTH),
      .R = kit_parameter(p, "R", PL_C_LENGTH),
      .theta = kit_coordinate(p, "theta"),
      .phi = kit_coordinate(p, "phi"),
      .x = kit_coordinate(p, "x"),
  };
  w.v = pl_sym(p, pl_symbol_dot(p, pl_symbol_of(p, w.x)));
  return w;
}

PL_TEST(factors_stand_in_the_order_of_the_blackboard) {
  words w = make_words(p);
  pl_expr lambda = pl_div(p, pl_mul_n(p, (pl_expr[]){pl_int(p, -2), w.g, w.m2, w.m1}, 4),
                          pl_add(p, w.m2, w.m1));
  assert_form(p, lambda, "-{2 m1 m2 g | (m1 + m2)}");
  pl_expr t = pl_mul_n(p,
                       (pl_expr[]){pl_ratio(p, 1, 2), pl_square(p, w.v), w.m, pl_square(p, w.r),
                                   pl_square(p, pl_call(p, PL_SIN, w.phi))},
                       5);
  assert_form(p, t, "{m r^2 sinphi^2 x_dot^2 | 2}");
  assert_form(p, pl_mul(p, pl_add(p, w.m1, w.m2), pl_mul(p, w.v, w.l)), "(m1 + m2) l x_dot");
}

PL_TEST(indices_ascend_in_natural_order) {
  words w = make_words(p);
  assert_form(p, pl_add_n(p, (pl_expr[]){w.m10, w.m2, w.m1}, 3), "(m1 + m2 + m10)");
}

PL_TEST(a_positive_term_goes_first) {
  words w = make_words(p);
  pl_expr c = pl_call(p, PL_COS, w.theta);
  assert_form(p, pl_sub(p, pl_mul(p, pl_int(p, 3), c), pl_int(p, 2)), "(3 costheta - 2)");
  assert_form(p, pl_sub(p, pl_int(p, 1), c), "(1 - costheta)");
  assert_form(p, pl_sub(p, w.v, w.m), "(x_dot - m)");
  assert_form(p, pl_add(p, pl_neg(p, w.v), pl_neg(p, w.m)), "(-m - x_dot)");
  pl_expr s = pl_square(p, pl_call(p, PL_SIN, w.phi));
  pl_expr under = pl_sub(p, pl_square(p, w.l), pl_mul(p, pl_square(p, w.r), s));
  assert_form(p, pl_sqrt(p, under), "root[(l^2 - r^2 sinphi^2)]");
}

PL_TEST(negative_powers_stand_below_the_line) {
  words w = make_words(p);
  assert_form(p, pl_div(p, w.g, w.l), "{g | l}");
  assert_form(p, pl_pow_int(p, w.x, -2), "{1 | x^2}");
  assert_form(p, pl_pow(p, w.x, pl_ratio(p, -1, 2)), "{1 | root[x]}");
  assert_form(p, pl_pow(p, w.x, pl_ratio(p, 3, 2)), "x^{3 | 2}");
  assert_form(p, pl_mul(p, pl_ratio(p, -3, 4), w.x), "-{3 x | 4}");
  assert_form(p, pl_ratio(p, -3, 4), "-{3 | 4}");
  assert_form(p, pl_sqrt(p, pl_ratio(p, 1, 2)), "{root[2] | 2}");
}

PL_TEST(statements_have_no_value) {
  words w = make_words(p);
  const pl_form *x = pl_form_leaf(a, w.x), *y = pl_form_leaf(a, w.v);
  assert_true(pl_is_poison(pl_form_value(p, pl_form_relation(a, x, "=", y))));
  assert_true(pl_is_poison(pl_form_value(p, pl_form_words(a, "at rest", "in Ruhe"))));
  assert_true(pl_is_poison(pl_form_value(p, pl_form_neg(a, pl_form_relation(a, x, "=", y)))));
  assert_true(pl_same(pl_form_value(p, pl_form_name(a, "T", w.m)), w.m));
}

PL_TEST(operators_are_counted_as_written) {
  words w = make_words(p);
  pl_expr d = pl_sub(p, w.m1, w.m2), s = pl_add(p, w.m1, w.m2);
  assert_int_equal(pl_op_count(p, d), 1);
  assert_int_equal(pl_op_count(p, pl_div(p, pl_mul(p, w.g, d), s)), 4);
  assert_int_equal(pl_op_count(p, pl_neg(p, w.x)), 1);
  assert_int_equal(pl_op_count(p, pl_mul(p, pl_ratio(p, 1, 2), pl_mul(p, w.m, pl_square(p, w.v)))),
                   3);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(factors_stand_in_the_order_of_the_blackboard),
      cmocka_unit_test(indices_ascend_in_natural_order),
      cmocka_unit_test(a_positive_term_goes_first),
      cmocka_unit_test(negative_powers_stand_below_the_line),
      cmocka_unit_test(statements_have_no_value),
      cmocka_unit_test(operators_are_counted_as_written),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
