// Expressions in the syntax of other programs: what the whole-program tests do not meet.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "export/export_impl.h"

typedef struct desk {
  pl_arena* a;
  pl_pool* p;
  pl_symbol x, y, i;
} desk;

static desk make(void) {
  pl_arena* a = pl_arena_make(NULL);
  pl_pool* p = pl_pool_make(a);
  pl_symbol_info x = {.name = "x", .ascii = "x", .role = PL_R_ARRAY},
                 y = {.name = "λ", .ascii = "lambda", .role = PL_R_PARAM};
  pl_symbol_info i = {.name = "i", .ascii = "i", .role = PL_R_INDEX};
  return (desk){a, p, pl_symbol_make(p, &x), pl_symbol_make(p, &y), pl_symbol_make(p, &i)};
}

static void writes(const desk* d, pl_expr e, const char* const expected[PL_EXPORT_JSON]) {
  for (int k = 0; k < PL_EXPORT_JSON; k++) {
    pl_export_names names = pl_export_names_make(d->a, d->p, &pl_dialects[k]);
    pl_text out = pl_text_make(d->a);
    pl_export_expr(&out, d->p, &pl_dialects[k], &names, e);
    assert_string_equal(pl_text_string(&out), expected[k]);
  }
}

static void elements_of_families_have_an_index(void** state) {
  desk d = make();
  pl_expr e = pl_at(d.p, d.x, 1, pl_sub(d.p, pl_sym(d.p, d.i), pl_int(d.p, 1)));
  writes(&d, e,
         (const char*[]){"x_dot[i - 1]", "xDot[i - 1]", "x_dot[i - 1]", "x_dot[i - 1]",
                         "x_dot[i - 1]"});
  pl_arena_free(d.a);
}

static void sums_name_index_and_bounds(void** state) {
  desk d = make();
  pl_expr e = pl_sum_over(d.p, d.i, pl_int(d.p, 1), pl_sym(d.p, d.y),
                          pl_at(d.p, d.x, 0, pl_sym(d.p, d.i)));
  writes(
      &d, e,
      (const char*[]){"sp.Sum(x[i], (i, 1, lambda_))", "Sum[x[i], {i, 1, lambda}]",
                      "sum(x[i], i, 1, lambda_)", "sum(x[i] for i in Int(1):Int(lambda); init = 0)",
                      "sum(x[i] for i in range(int(1), int(lambda_) + 1))"});
  pl_arena_free(d.a);
}

static void broken_powers_stay_exact(void** state) {
  desk d = make();
  pl_expr e = pl_pow(d.p, pl_sym(d.p, d.y), pl_ratio(d.p, -2, 3));
  writes(&d, e,
         (const char*[]){"1/lambda_**(sp.Rational(2, 3))", "1/lambda^(2/3)", "1/lambda_^(2/3)",
                         "1/lambda^((2//3))", "1/lambda_**((2/3))"});
  pl_arena_free(d.a);
}

static void a_negative_base_has_brackets(void** state) {
  desk d = make();
  pl_expr e = pl_pow(d.p, pl_neg(d.p, pl_sym(d.p, d.i)), pl_sym(d.p, d.y));
  writes(&d, e,
         (const char*[]){"(-i)**lambda_", "(-i)^lambda", "(-i)^lambda_", "(-i)^lambda",
                         "(-i)**lambda_"});
  pl_arena_free(d.a);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(elements_of_families_have_an_index),
                                     cmocka_unit_test(sums_name_index_and_bounds),
                                     cmocka_unit_test(broken_powers_stay_exact),
                                     cmocka_unit_test(a_negative_base_has_brackets)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
