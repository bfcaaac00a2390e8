// Recording: sharing, levels, refusals, patterns.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "program/tape.h"

typedef struct bench {
  pl_arena* arena;
  pl_pool* pool;
  pl_job job;
  pl_diagnostics diagnostics;
  pl_expr x, y, m, k, lambda;
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
  const char* name[] = {"x", "y", "m", "k", "lambda"};
  const pl_role role[] = {PL_R_COORD, PL_R_COORD, PL_R_PARAM, PL_R_PARAM, PL_R_MULTIPLIER};
  pl_expr* at[] = {&b->x, &b->y, &b->m, &b->k, &b->lambda};
  for (int i = 0; i < 5; i++) {
    pl_symbol_info info = {
        .name = name[i], .ascii = name[i], .role = role[i], .dimension = pl_dimension_one()};
    *at[i] = pl_sym(b->pool, pl_symbol_make(b->pool, &info));
  }
  b->value[pl_symbol_of(b->pool, b->m).id] = 2;
  return b;  // k has no value
}

static pleuel_status record(bench* b, const pl_expr* e, int n, pl_tape** tape) {
  static pl_expr q[2];
  q[0] = b->x;
  q[1] = b->y;
  pl_tape_slots slots = {
      .n_q = 2, .q = q, .n_c = 1, .lambda = &b->lambda, .value_of_symbol = b->value};
  return pl_tape_record(&b->job, b->pool, &slots, e, NULL, n, tape);
}

static int count(const pl_tape* tape, pl_op op) {
  int n = 0;
  for (int i = 0; i < tape->n_nodes; i++) n += tape->nodes[i].op == op;
  return n;
}

static void common_subexpressions_are_computed_once(void** state) {
  (void)state;
  bench* b = bench_open();
  pl_pool* p = b->pool;
  pl_expr s = pl_call(p, PL_SIN, pl_add(p, b->x, b->y));
  pl_expr e[] = {pl_mul(p, s, b->x), pl_mul(p, s, b->y), pl_call(p, PL_COS, pl_add(p, b->x, b->y))};
  pl_tape* tape;
  assert_int_equal(record(b, e, 3, &tape), PLEUEL_OK);
  assert_true(count(tape, PL_OP_SIN) == 1 && count(tape, PL_OP_COS) == 1
              && count(tape, PL_OP_ADD) == 1);
  assert_true(count(tape, PL_OP_MUL) == 2);
  pl_arena_free(b->arena);
}

static void products_with_constants_need_no_convolution(void** state) {
  (void)state;
  bench* b = bench_open();
  pl_pool* p = b->pool;
  pl_expr e = pl_div(p, pl_mul(p, b->m, b->x), pl_add(p, b->m, pl_int(p, 1)));
  pl_tape* tape;
  assert_int_equal(record(b, &e, 1, &tape), PLEUEL_OK);
  for (int i = tape->level_end[PL_LEVEL_CONST]; i < tape->n_nodes; i++)
    assert_false(pl_op_series[tape->nodes[i].op]);
  pl_arena_free(b->arena);
}

static void nodes_are_sorted_by_what_they_depend_on(void** state) {
  (void)state;
  bench* b = bench_open();
  pl_pool* p = b->pool;
  pl_expr v = pl_dt(p, b->x), t = pl_sym(p, pl_time(p));
  pl_expr e[] = {pl_mul(p, b->lambda, b->x), pl_mul(p, v, b->x), pl_mul(p, t, b->y),
                 pl_square(p, b->m), pl_dt(p, v)};
  pl_tape_level level[] = {PL_LEVEL_FORCE, PL_LEVEL_VELOCITY, PL_LEVEL_POSITION, PL_LEVEL_CONST,
                           PL_LEVEL_FORCE};
  pl_tape* tape;
  assert_int_equal(record(b, e, 5, &tape), PLEUEL_OK);
  for (int i = 0; i < 5; i++) assert_int_equal(tape->nodes[tape->roots[i]].level, level[i]);
  for (int i = 1; i < tape->n_nodes; i++)
    assert_true(tape->nodes[i - 1].level <= tape->nodes[i].level);
  for (int i = 0; i < tape->n_nodes; i++) assert_true(tape->nodes[i].a < i && tape->nodes[i].b < i);
  pl_arena_free(b->arena);
}

static void a_name_without_value_is_refused_by_name(void** state) {
  (void)state;
  bench* b = bench_open();
  pl_expr e = pl_mul(b->pool, b->k, b->x);
  pl_tape* tape;
  assert_int_equal(record(b, &e, 1, &tape), PLEUEL_USAGE);
  assert_non_null(strstr(b->job.message, "k has no value"));
  e = pl_poison();
  assert_int_equal(record(b, &e, 1, &tape), PLEUEL_NUMERICAL);
  e = pl_infinity(b->pool);
  assert_int_equal(record(b, &e, 1, &tape), PLEUEL_UNSUPPORTED);
  pl_arena_free(b->arena);
}

static void nesting_beyond_reason_is_refused(void** state) {
  (void)state;
  bench* b = bench_open();
  pl_expr e = b->x;
  for (int i = 0; i < 20000; i++) e = pl_call(b->pool, PL_SIN, pl_add(b->pool, e, b->y));
  pl_tape* tape;
  assert_int_equal(record(b, &e, 1, &tape), PLEUEL_UNSUPPORTED);
  pl_arena_free(b->arena);
}

static void sums_over_an_index_are_written_out(void** state) {
  (void)state;
  bench* b = bench_open();
  pl_pool* p = b->pool;
  pl_symbol i = pl_symbol_make(
      p, &(pl_symbol_info){
             .name = "i", .ascii = "i", .role = PL_R_INDEX, .dimension = pl_dimension_one()});
  pl_expr e = pl_sum_over(p, i, pl_int(p, 1), pl_int(p, 3), pl_mul(p, pl_sym(p, i), b->x));
  pl_tape* tape;
  assert_int_equal(record(b, &e, 1, &tape), PLEUEL_OK);
  e = pl_sum_over(p, i, pl_int(p, 1), b->x, pl_sym(p, i));
  assert_int_equal(record(b, &e, 1, &tape), PLEUEL_UNSUPPORTED);
  pl_arena_free(b->arena);
}

// ---------------------------------------------------------------------------------------- patterns
static pleuel_status record_pattern(bench* b, pl_expr L, pl_expr force, pl_expr constraint,
                                    bool velocity, pl_pattern* out) {
  pl_expr* q = PL_ARRAY(b->arena, pl_expr, 2);
  q[0] = b->x;
  q[1] = b->y;
  pl_expr* Q = PL_ARRAY(b->arena, pl_expr, 2);
  Q[0] = force;
  static const int zero[] = {0, 1};
  pl_pattern_source s = {.slots = {.n_q = 2,
                                   .q = q,
                                   .n_c = constraint.id ? 1 : 0,
                                   .lambda = &b->lambda,
                                   .value_of_symbol = b->value},
                         .lagrangian = L,
                         .force = Q,
                         .constraint = &constraint,
                         .velocity = &velocity,
                         .n = 1,
                         .q = zero,
                         .c = zero};
  return pl_pattern_record(&b->job, b->pool, &s, out);
}

static void a_pattern_has_the_entries_that_are_not_zero(void** state) {
  (void)state;
  bench* b = bench_open();
  pl_pool* p = b->pool;
  pl_expr T = pl_mul(p, b->m,
                     pl_add(p, pl_square(p, pl_dt(p, b->x)), pl_square(p, pl_dt(p, b->y))));
  pl_expr g = pl_sub(p, pl_square(p, b->x), pl_int(p, 4));
  pl_pattern pattern;
  assert_int_equal(record_pattern(b, pl_sub(p, T, b->y), pl_neg(p, b->x), g, false, &pattern),
                   PLEUEL_OK);
  assert_true(pattern.n_mass == 2 && pattern.n_h == 2 && pattern.n_G == 1 && pattern.n_gt == 0
              && pattern.n_g == 1 && pattern.n_W == 0);
  pl_arena_free(b->arena);
}

static void what_cannot_be_moved_is_refused(void** state) {
  (void)state;
  bench* b = bench_open();
  pl_pool* p = b->pool;
  pl_expr v = pl_dt(p, b->x), T = pl_square(p, v);
  pl_pattern pattern;
  // not linear in the velocity, a force that squares its multiplier, a velocity in a constraint of
  // positions
  assert_int_equal(
      record_pattern(b, T, pl_poison(), pl_sub(p, pl_square(p, v), b->y), true, &pattern),
      PLEUEL_UNSUPPORTED);
  assert_int_equal(record_pattern(b, T, pl_square(p, b->lambda), b->x, false, &pattern),
                   PLEUEL_UNSUPPORTED);
  assert_int_equal(record_pattern(b, T, pl_poison(), pl_mul(p, v, b->y), false, &pattern),
                   PLEUEL_UNSUPPORTED);
  assert_int_equal(record_pattern(b, T, pl_dt(p, v), b->x, false, &pattern), PLEUEL_UNSUPPORTED);
  pl_arena_free(b->arena);
}

static void a_tape_can_be_read(void** state) {
  (void)state;
  bench* b = bench_open();
  pl_expr e = pl_mul(b->pool, b->m, pl_call(b->pool, PL_SIN, b->x));
  pl_tape* tape;
  assert_int_equal(record(b, &e, 1, &tape), PLEUEL_OK);
  pl_text text = pl_text_make(b->arena);
  pl_tape_dump(&text, b->pool, tape);
  assert_non_null(strstr(pl_text_string(&text), "PARAM m = 2"));
  assert_non_null(strstr(pl_text_string(&text), "SIN"));
  pl_arena_free(b->arena);
}

// Two decimals that round to the same double are two constants, each with its exact value; whole
// numbers need none.
static void numbers_keep_what_they_are_exactly(void** state) {
  (void)state;
  bench* b = bench_open();
  pl_pool* p = b->pool;
  pl_expr fine = pl_number_from_text(p, "0.1000000000000000000001", 24), tenth = pl_ratio(p, 1, 10);
  pl_expr terms[] = {pl_mul(p, fine, b->x), pl_mul(p, tenth, b->y),
                     pl_mul(p, pl_int(p, 3), pl_mul(p, b->x, b->y)), pl_pi(p)};
  pl_expr e = pl_add_n(p, terms, 4);
  pl_tape* tape;
  assert_int_equal(record(b, &e, 1, &tape), PLEUEL_OK);
  int n_exact = 0, n_whole = 0;
  for (int i = 0; i < tape->n_nodes; i++) {
    if (tape->nodes[i].op != PL_OP_CONST) continue;
    pl_expr exact = tape->constant[i];
    n_exact += exact.id
               && (pl_same(exact, fine) || pl_same(exact, tenth) || pl_same(exact, pl_pi(p)));
    n_whole += !exact.id && tape->nodes[i].value == 3;
  }
  assert_int_equal(n_exact, 3);
  assert_int_equal(n_whole, 1);
  pl_arena_free(b->arena);
}

// The list of nodes moves when it is full: every number of nodes before the function is tried, so
// that each place is.
static void a_function_has_its_square_wherever_the_list_of_nodes_ends(void** state) {
  (void)state;
  for (int before = 0; before < 140; before++) {
    bench* b = bench_open();
    pl_pool* p = b->pool;
    pl_expr e[2] = {b->x, pl_call(p, before % 2 ? PL_TAN : PL_TANH, b->y)};
    for (int i = 0; i < before; i++) e[0] = pl_call(p, PL_EXP, e[0]);
    pl_tape* tape;
    assert_int_equal(record(b, e, 2, &tape), PLEUEL_OK);
    const pl_tape_node* f = &tape->nodes[tape->roots[1]];
    assert_true(f->c >= 0);
    assert_int_equal(tape->nodes[f->c].op, PL_OP_SQR);
    assert_int_equal(tape->nodes[f->c].a, tape->roots[1]);
    pl_arena_free(b->arena);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(common_subexpressions_are_computed_once),
      cmocka_unit_test(products_with_constants_need_no_convolution),
      cmocka_unit_test(nodes_are_sorted_by_what_they_depend_on),
      cmocka_unit_test(a_name_without_value_is_refused_by_name),
      cmocka_unit_test(nesting_beyond_reason_is_refused),
      cmocka_unit_test(sums_over_an_index_are_written_out),
      cmocka_unit_test(a_pattern_has_the_entries_that_are_not_zero),
      cmocka_unit_test(what_cannot_be_moved_is_refused),
      cmocka_unit_test(a_tape_can_be_read),
      cmocka_unit_test(numbers_keep_what_they_are_exactly),
      cmocka_unit_test(a_function_has_its_square_wherever_the_list_of_nodes_ends),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
