// Series recurrences: laws in long double on random expressions, and closed forms.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "program/jet.h"

enum { ORDERS = 16 };

typedef struct bench {
  pl_arena* arena;
  pl_pool* pool;
  pl_job job;
  pl_diagnostics diagnostics;
  pl_expr x, y, t, a;
  double value[64];
} bench;

static bench* bench_open(void) {
  pl_arena* arena = pl_arena_make(NULL);
  bench* b = PL_NEW(arena, bench);
  b->arena = arena;
  b->pool = pl_pool_make(arena);
  b->diagnostics.arena = arena;
  b->job = (pl_job){.arena = arena, .diagnostics = &b->diagnostics};
  for (int i = 0; i < 64; i++) b->value[i] = (double)NAN;
  const char* name[] = {"x", "y", "a"};
  pl_expr* at[] = {&b->x, &b->y, &b->a};
  for (int i = 0; i < 3; i++) {
    pl_symbol_info info = {.name = name[i],
                           .ascii = name[i],
                           .role = i < 2 ? PL_R_COORD : PL_R_PARAM,
                           .dimension = pl_dimension_one()};
    *at[i] = pl_sym(b->pool, pl_symbol_make(b->pool, &info));
  }
  b->value[pl_symbol_of(b->pool, b->a).id] = 0.7;
  b->t = pl_sym(b->pool, pl_time(b->pool));
  return b;
}

// Series of e along x(t) = sum x_k t^k, y likewise, in every lane.
static void series_of(bench* b, pl_expr e, const double* x, const double* y, double t, int lanes,
                      double* out) {
  pl_tape* tape;
  const pl_expr q[] = {b->x, b->y};
  pl_tape_slots slots = {.n_q = 2, .q = q, .value_of_symbol = b->value};
  assert_int_equal(pl_tape_record(&b->job, b->pool, &slots, &e, NULL, 1, &tape), PLEUEL_OK);
  pl_jet* j = pl_jet_make(b->arena, tape, lanes, ORDERS);
  pl_jet_constants(j, NULL);
  pl_jet_time(j, t);
  for (int k = 0; k < ORDERS; k++) {
    for (int l = 0; l < lanes; l++) {
      if (tape->q_node[0] >= 0) pl_jet_at(j, tape->q_node[0], k)[l] = x[k];
      if (tape->q_node[1] >= 0) pl_jet_at(j, tape->q_node[1], k)[l] = y[k];
    }
    j->kernel(j, PL_LEVEL_POSITION, k, true);
  }
  for (int k = 0; k < ORDERS; k++) {
    int root = tape->roots[0];
    out[k] = k > 0 && root < tape->level_end[PL_LEVEL_CONST] ? 0 : pl_jet_at(j, root, k)[0];
    for (int l = 1; l < lanes; l++)
      assert_true(pl_jet_at(j, root, k)[l] == pl_jet_at(j, root, k)[0] || k > 0);
  }
}

// ------------------------------------------------------------------------------------ closed forms
static void check_series(const char* what, const double* got, const double* expect, int n) {
  for (int k = 0; k < n; k++) {
    double size = fmax(fabs(expect[k]), 1e-3);
    if (!(fabs(got[k] - expect[k]) <= 4e-15 * (k + 4) * size))
      print_message("# %s, order %d: %.17g, expected %.17g\n", what, k, got[k], expect[k]);
    assert_true(fabs(got[k] - expect[k]) <= 4e-15 * (k + 4) * size);
  }
}

static void elementary_functions_have_their_taylor_series(void** state) {
  (void)state;
  bench* b = bench_open();
  double x[ORDERS] = {0, 1}, y[ORDERS] = {0}, got[ORDERS], factorial[ORDERS] = {1}, expect[ORDERS];
  for (int k = 1; k < ORDERS; k++) factorial[k] = factorial[k - 1] * k;
  for (int k = 0; k < ORDERS; k++) expect[k] = 1 / factorial[k];
  series_of(b, pl_call(b->pool, PL_EXP, b->x), x, y, 0, 1, got);
  check_series("exp", got, expect, ORDERS);
  for (int k = 0; k < ORDERS; k++)
    expect[k] = k % 2 == 0 ? 0 : (k % 4 == 1 ? 1 : -1) / factorial[k];
  series_of(b, pl_call(b->pool, PL_SIN, b->x), x, y, 0, 1, got);
  check_series("sin", got, expect, ORDERS);
  for (int k = 0; k < ORDERS; k++) expect[k] = k % 2 ? 0 : 1 / factorial[k];
  series_of(b, pl_call(b->pool, PL_COSH, b->x), x, y, 0, 1, got);
  check_series("cosh", got, expect, ORDERS);
  for (int k = 0; k < ORDERS; k++) expect[k] = k % 2 == 0 ? 0 : (k % 4 == 1 ? 1.0 : -1.0) / k;
  series_of(b, pl_call(b->pool, PL_ATAN, b->x), x, y, 0, 1, got);
  check_series("atan", got, expect, ORDERS);
  const double tangent[] = {0, 1,          0, 1.0 / 3,     0, 2.0 / 15,
                            0, 17.0 / 315, 0, 62.0 / 2835, 0, 1382.0 / 155925};
  series_of(b, pl_call(b->pool, PL_TAN, b->x), x, y, 0, 1, got);
  check_series("tan", got, tangent, 12);
  for (int k = 0; k < 12; k++) expect[k] = tangent[k] * (k % 4 == 3 ? -1 : 1);
  series_of(b, pl_call(b->pool, PL_TANH, b->x), x, y, 0, 1, got);
  check_series("tanh", got, expect, 12);
  const double arcsine[] = {0, 1, 0, 1.0 / 6, 0, 3.0 / 40, 0, 15.0 / 336, 0, 105.0 / 3456};
  series_of(b, pl_call(b->pool, PL_ASIN, b->x), x, y, 0, 1, got);
  check_series("asin", got, arcsine, 10);
  x[0] = 1;
  for (int k = 0; k < ORDERS; k++) expect[k] = k == 0 ? 0 : (k % 2 ? 1.0 : -1.0) / k;
  series_of(b, pl_call(b->pool, PL_LN, b->x), x, y, 0, 1, got);
  check_series("ln", got, expect, ORDERS);
  for (int k = 0; k < ORDERS; k++) expect[k] = k % 2 ? -1 : 1;
  series_of(b, pl_pow_int(b->pool, b->x, -1), x, y, 0, 1, got);
  check_series("1/x", got, expect, ORDERS);
  double binomial = 1;
  for (int k = 0; k < ORDERS; binomial *= (-1.5 - k) / (k + 1), k++) expect[k] = binomial;
  series_of(b, pl_pow(b->pool, b->x, pl_ratio(b->pool, -3, 2)), x, y, 0, 1, got);
  check_series("x^(-3/2)", got, expect, ORDERS);
  pl_arena_free(b->arena);
}

// -------------------------------------------------------------------------------------- identities
static void random_path(pl_random* r, double* x, double centre) {
  x[0] = centre;
  double size = 0.5;
  for (int k = 1; k < ORDERS; k++, size *= 0.5) x[k] = size * pl_random_between(r, -1, 1);
}

// Two ways to write the same thing give the same series.
static void check_identity(bench* b, const char* what, pl_expr left, pl_expr right, double cx,
                           double cy) {
  for (uint64_t seed = 1; seed <= 20; seed++) {
    pl_random r = {seed};
    double x[ORDERS], y[ORDERS], l[ORDERS], rr[ORDERS];
    random_path(&r, x, cx + 0.1 * pl_random_between(&r, -1, 1));
    random_path(&r, y, cy + 0.1 * pl_random_between(&r, -1, 1));
    series_of(b, left, x, y, 0.3, 1, l);
    series_of(b, right, x, y, 0.3, 8, rr);
    double size = 0;
    for (int k = 0; k < ORDERS; k++) size = fmax(size, fabs(l[k]));
    for (int k = 0; k < ORDERS; k++) {
      if (!(fabs(l[k] - rr[k]) <= 1e-11 * size + 1e-13))
        print_message("# %s, seed %llu, order %d: %.17g and %.17g\n", what,
                      (unsigned long long)seed, k, l[k], rr[k]);
      assert_true(fabs(l[k] - rr[k]) <= 1e-11 * size + 1e-13);
    }
  }
}

static void series_obey_identities_along_random_paths(void** state) {
  (void)state;
  bench* b = bench_open();
  pl_pool* p = b->pool;
  pl_expr x = b->x, y = b->y, one = pl_int(p, 1);
  pl_expr r2 = pl_add(p, pl_square(p, x), pl_square(p, y));
  check_identity(b, "sin^2 + cos^2",
                 pl_add(p, pl_square(p, pl_call(p, PL_SIN, pl_mul(p, x, y))),
                        pl_square(p, pl_call(p, PL_COS, pl_mul(p, x, y)))),
                 one, 1, 2);
  check_identity(b, "tan", pl_call(p, PL_TAN, x),
                 pl_div(p, pl_call(p, PL_SIN, x), pl_call(p, PL_COS, x)), 0.7, 0);
  check_identity(b, "tanh", pl_call(p, PL_TANH, x),
                 pl_div(p, pl_call(p, PL_SINH, x), pl_call(p, PL_COSH, x)), 0.7, 0);
  check_identity(b, "asin", pl_call(p, PL_SIN, pl_call(p, PL_ASIN, x)), x, 0.2, 0);
  check_identity(b, "asinh", pl_call(p, PL_SINH, pl_call(p, PL_ASINH, x)), x, 1.7, 0);
  check_identity(b, "acos", pl_call(p, PL_COS, pl_call(p, PL_ACOS, x)), x, 0.2, 0);
  check_identity(b, "atan", pl_call(p, PL_TAN, pl_call(p, PL_ATAN, x)), x, 0.4, 0);
  check_identity(b, "atan2", pl_call(p, PL_TAN, pl_call2(p, PL_ATAN2, y, x)), pl_div(p, y, x), 2,
                 1);
  check_identity(b, "exp ln", pl_call(p, PL_EXP, pl_call(p, PL_LN, r2)), r2, 2, 1);
  check_identity(b, "sqrt", pl_square(p, pl_add(p, one, pl_sqrt(p, r2))),
                 pl_add(p, pl_add(p, one, r2), pl_mul(p, pl_int(p, 2), pl_sqrt(p, r2))), 2, 1);
  check_identity(b, "powers", pl_pow(p, r2, pl_ratio(p, -3, 2)),
                 pl_div(p, one, pl_mul(p, r2, pl_sqrt(p, r2))), 2, 1);
  check_identity(b, "power of parameter", pl_pow(p, x, b->a),
                 pl_call(p, PL_EXP, pl_mul(p, b->a, pl_call(p, PL_LN, x))), 2, 1);
  check_identity(b, "power of variable", pl_pow(p, x, y),
                 pl_call(p, PL_EXP, pl_mul(p, y, pl_call(p, PL_LN, x))), 2, 1);
  check_identity(b, "product", pl_expand(p, pl_mul(p, pl_add(p, x, y), pl_sub(p, x, y)), 10),
                 pl_sub(p, pl_square(p, x), pl_square(p, y)), 2, 1);
  check_identity(
      b, "seventh power", pl_pow_int(p, pl_add(p, x, y), 7),
      pl_mul(p, pl_pow_int(p, pl_add(p, x, y), 3), pl_square(p, pl_square(p, pl_add(p, x, y)))),
      0.2, 0.3);
  check_identity(b, "abs", pl_call(p, PL_ABS, x), pl_neg(p, x), -2, 0);
  check_identity(b, "min, max", pl_add(p, pl_call2(p, PL_MIN, x, y), pl_call2(p, PL_MAX, x, y)),
                 pl_add(p, x, y), 2, 1);
  check_identity(b, "if", pl_if(p, pl_sub(p, x, y), pl_square(p, x), y), pl_square(p, x), 2, 1);
  check_identity(b, "time", pl_square(p, pl_add(p, b->t, x)),
                 pl_add_n(p,
                          (pl_expr[]){pl_square(p, b->t), pl_square(p, x),
                                      pl_mul(p, pl_int(p, 2), pl_mul(p, b->t, x))},
                          3),
                 2, 1);
  pl_arena_free(b->arena);
}

// --------------------------------------------------------------------------------------- the point
// Order 0 is the value that the algebra computes, and the sum of the series its value along the
// path.
static void the_sum_of_a_series_is_the_value_along_the_path(void** state) {
  (void)state;
  bench* b = bench_open();
  pl_pool* p = b->pool;
  pl_expr e = pl_div(
      p, pl_call(p, PL_SIN, pl_mul(p, b->a, b->x)),
      pl_add(p, pl_sqrt(p, pl_add(p, pl_int(p, 2), pl_square(p, b->y))), pl_call(p, PL_EXP, b->x)));
  for (uint64_t seed = 1; seed <= 20; seed++) {
    pl_random r = {seed};
    double x[ORDERS], y[ORDERS], s[ORDERS], h = 0.02;
    random_path(&r, x, 0.5);
    random_path(&r, y, 0.8);
    series_of(b, e, x, y, 0, 1, s);
    double sum = 0, xs = 0, ys = 0;
    for (int k = ORDERS - 1; k >= 0; k--) {
      sum = sum * h + s[k];
      xs = xs * h + x[k];
      ys = ys * h + y[k];
    }
    b->value[pl_symbol_of(p, b->x).id] = xs;
    b->value[pl_symbol_of(p, b->y).id] = ys;
    double direct = pl_eval(p, e, b->value);
    if (!(fabs(sum - direct) < 1e-15))
      print_message("# seed %llu: %.17g and %.17g\n", (unsigned long long)seed, sum, direct);
    assert_true(fabs(sum - direct) < 1e-15);
  }
  pl_arena_free(b->arena);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(elementary_functions_have_their_taylor_series),
      cmocka_unit_test(series_obey_identities_along_random_paths),
      cmocka_unit_test(the_sum_of_a_series_is_the_value_along_the_path),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
