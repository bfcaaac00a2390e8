// Columns and CSV.
#include "result/result.h"

#include <stdlib.h>

#include "solve/setup_test.h"

static void numbers_are_short_and_read_back(void** state) {
  (void)state;
  char text[32];
  pl_double_text(text, 0.1);
  assert_string_equal(text, "0.1");
  pl_double_text(text, -2.5e-300);
  assert_string_equal(text, "-2.5e-300");
  pl_double_text(text, (double)NAN);
  assert_string_equal(text, "nan");
  pl_double_text(text, -(double)INFINITY);
  assert_string_equal(text, "-inf");
  pl_double_text(text, -0.0);
  assert_string_equal(text, "0");
  for (uint64_t seed = 1; seed <= 2000; seed++) {
    pl_random r = {seed};
    double x = ldexp(pl_random_between(&r, -1, 1), (int)(pl_random_bits(&r) % 2000) - 1000);
    int n = pl_double_text(text, x);
    assert_true(n == (int)strlen(text) && n < 32);
    assert_true(strtod(text, NULL) == x);
  }
}

// A bead on a table that drops off its edge.
static t_bench* bead(void) {
  t_bench* b = t_open();
  pl_expr x = t_coord(b, "x"), y = t_coord(b, "y");
  b->coordinate[0].unit = "m";
  b->coordinate[0].v_unit = "m/s";
  int c = t_constraint(b, "table, oak", y);
  b->constraint[c].side = 1;
  b->constraint[c].column = "lambda";
  b->constraint[c].unit = "N";
  pl_expr T = pl_mul(b->pool, pl_ratio(b->pool, 1, 2),
                     pl_add(b->pool, pl_square(b->pool, b->v[0]), pl_square(b->pool, b->v[1])));
  t_start(b, 0, 0, 2);
  t_start(b, 1, 0, 0);
  t_output(b, "twice", pl_mul(b->pool, pl_int(b->pool, 2), x));
  t_event(b, "edge", pl_sub(b->pool, x, pl_int(b->pool, 1)), 1, PL_ACTION_RELEASE, 0);
  assert_int_equal(t_make(b, pl_sub(b->pool, T, pl_mul(b->pool, pl_int(b->pool, 10), y)), 1, 0),
                   PLEUEL_OK);
  return b;
}

static void run_into(t_bench* b, pl_sink sink, pleuel_status expect) {
  pl_run_free(b->run);
  b->options.sink = sink;
  b->options.dt = 0.25;
  assert_int_equal(pl_run_make(&b->job, &b->setup, &b->options, &b->run), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), expect);
}

static void a_result_keeps_rows_modes_and_events(void** state) {
  (void)state;
  t_bench* b = bead();
  pl_result* r = pl_result_make(b->arena, true);
  run_into(b, pl_result_sink(r), PLEUEL_OK);
  assert_true(r->complete && r->has_mode && r->n_columns == 7);
  // 0, 0.25, before and after the edge at 0.5, 0.75, 1
  assert_int_equal(r->rows.n, 6);
  assert_string_equal(r->modes.at[0], "contact(table, oak)");
  assert_string_equal(r->modes.at[2], "contact(table, oak)");
  assert_string_equal(r->modes.at[3], "free");
  assert_true(r->kinds.at[2] == PL_ROW_BEFORE && r->kinds.at[3] == PL_ROW_AFTER);
  assert_true(r->events.n == 1 && r->events.at[0].kind == PL_EV_EVENT
              && strcmp(r->events.at[0].label, "edge") == 0);
  int lambda = pl_result_find(r, "lambda");
  assert_true(lambda == 5 && r->events.at[0].before[lambda] == 10
              && r->events.at[0].after[lambda] == 0);
  assert_true(pl_result_last(r, "t") == 1 && fabs(pl_result_last(r, "twice") - 4) < 1e-14);
  assert_true(isnan(pl_result_last(r, "absent")));
  t_close(b);
}

static char* slurp(FILE* file, char* text, size_t size) {
  rewind(file);
  size_t n = fread(text, 1, size - 1, file);
  text[n] = '\0';
  return text;
}

static void csv_has_header_rows_and_quotes_where_needed(void** state) {
  (void)state;
  char streamed[4000], written[4000];
  t_bench* b = bead();
  FILE *one = tmpfile(), *two = tmpfile();
  pl_result* r = pl_result_make(b->arena, true);
  r->next = pl_csv_sink(b->arena, one);
  run_into(b, pl_result_sink(r), PLEUEL_OK);
  assert_int_equal(pl_result_write_csv(r, two), PLEUEL_OK);
  slurp(one, streamed, sizeof streamed);
  slurp(two, written, sizeof written);
  assert_string_equal(streamed, written);
  assert_int_equal(strncmp(streamed,
                           "t [s],x [m],y,x_dot [m/s],y_dot,lambda "
                           "[N],twice,mode\n0,0,0,2,0,10,0,\"contact(table, oak)\"\n",
                           80),
                   0);
  assert_null(strstr(streamed, "incomplete"));
  fclose(one);
  fclose(two);
  t_close(b);
}

static void an_interrupted_run_is_marked_incomplete(void** state) {
  (void)state;
  char text[4000];
  t_bench* b = bead();
  FILE* file = tmpfile();
  b->options.max_steps = 1;
  run_into(b, pl_csv_sink(b->arena, file), PLEUEL_NUMERICAL);
  slurp(file, text, sizeof text);
  assert_non_null(strstr(text, "\n# incomplete: 1 steps were not enough"));
  fclose(file);
  t_close(b);
}

static void memory_that_runs_out_stops_the_run_with_a_status(void** state) {
  (void)state;
  t_bench* b = bead();
  pl_arena* small = pl_arena_make(NULL);
  pl_result* r = pl_result_make(small, true);
  pl_sink sink = pl_result_sink(r);
  pl_run_free(b->run);
  b->options.sink = sink;
  b->options.count = 200000;
  assert_int_equal(pl_run_make(&b->job, &b->setup, &b->options, &b->run), PLEUEL_OK);
  pl_arena_limit(small, pl_arena_total(small) + 100000);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_NO_MEMORY);
  pl_arena_free(small);
  t_close(b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(numbers_are_short_and_read_back),
      cmocka_unit_test(a_result_keeps_rows_modes_and_events),
      cmocka_unit_test(csv_has_header_rows_and_quotes_where_needed),
      cmocka_unit_test(an_interrupted_run_is_marked_incomplete),
      cmocka_unit_test(memory_that_runs_out_stops_the_run_with_a_status),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
