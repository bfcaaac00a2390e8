// Families: one pattern, many instances, in lanes.
#include "solve/setup_test.h"

#define P b->pool

// Chain of n rods: masses i = 1..n at (x[i], y[i]), rod i between i-1 and i, the first fixed at the
// origin. Two patterns: the first rod, and the others as a family with one tape.
typedef struct chain {
  t_bench* b;
  int n;
} chain;

static pl_pattern_source source_of(t_bench* b, const pl_expr* q, int n_q, const pl_expr* lambda) {
  return (pl_pattern_source){
      .slots = {.n_q = n_q, .q = q, .n_c = 1, .lambda = lambda, .value_of_symbol = b->value}};
}

static t_bench* chain_make(int n, double t_end) {
  t_bench* b = t_open();
  pl_symbol i_symbol = t_symbol(b, "i", PL_R_INDEX), x = t_symbol(b, "x", PL_R_ARRAY),
            y = t_symbol(b, "y", PL_R_ARRAY);
  pl_expr i = pl_sym(P, i_symbol), before = pl_sub(P, i, pl_int(P, 1));
  pl_expr m = t_param(b, "m", 1.0 / n), l = t_param(b, "l", 1.0 / n), g = t_param(b, "g", 1);
  pl_expr q[4] = {pl_at(P, x, 0, i), pl_at(P, y, 0, i), pl_at(P, x, 0, before),
                  pl_at(P, y, 0, before)};
  pl_expr v0 = pl_dt(P, q[0]), v1 = pl_dt(P, q[1]);
  pl_expr T = pl_mul(P, pl_ratio(P, 1, 2),
                     pl_mul(P, m, pl_add(P, pl_square(P, v0), pl_square(P, v1))));
  pl_expr V = pl_mul(P, m, pl_mul(P, g, q[1])), L = pl_sub(P, T, V);
  pl_expr rod = pl_sub(
      P, pl_add(P, pl_square(P, pl_sub(P, q[0], q[2])), pl_square(P, pl_sub(P, q[1], q[3]))),
      pl_square(P, l));
  pl_expr first = pl_sub(P, pl_add(P, pl_square(P, q[0]), pl_square(P, q[1])), pl_square(P, l));
  b->lambda[0] = pl_sym(P, t_symbol(b, "lambda", PL_R_MULTIPLIER));
  int *iq = PL_ARRAY(b->arena, int, 4 * (size_t)n), *ic = PL_ARRAY(b->arena, int, n),
      *out = PL_ARRAY(b->arena, int, 2 * (size_t)n);
  double* index = PL_ARRAY(b->arena, double, n);
  for (int k = 1; k < n; k++) {
    int* at = iq + 4 * (k - 1);
    at[0] = 2 * k;
    at[1] = 2 * k + 1;
    at[2] = 2 * k - 2;
    at[3] = 2 * k - 1;
    ic[k - 1] = k;
    index[k - 1] = k + 1;
  }
  for (int k = 0; k < n; k++) {
    out[2 * k] = 0;
    out[2 * k + 1] = 1;
  }
  pl_expr energy[2] = {T, V};
  pl_pattern_source s = source_of(b, q, 2, b->lambda);
  s.lagrangian = L;
  s.constraint = &first;
  s.n = 1;
  s.slots.n_index = 1;
  s.slots.index = &i_symbol;
  static const double one = 1;
  s.index = &one;
  s.q = b->identity;
  s.c = b->identity;
  assert_int_equal(pl_pattern_record(&b->job, b->pool, &s, &b->pattern[0]), PLEUEL_OK);
  pl_pattern_source f = source_of(b, q, 4, b->lambda);
  f.lagrangian = L;
  f.constraint = &rod;
  f.n = n - 1;
  f.slots.n_index = 1;
  f.slots.index = &i_symbol;
  f.index = index;
  f.q = iq;
  f.c = ic;
  assert_int_equal(pl_pattern_record(&b->job, b->pool, &f, &b->pattern[1]), PLEUEL_OK);
  // energies: all masses as instances of one observer
  pl_pattern_source o = {
      .slots = {.n_q = 2, .q = q, .n_index = 1, .index = &i_symbol, .value_of_symbol = b->value},
      .n_outputs = 2,
      .output = energy,
      .n = n,
      .q = PL_ARRAY(b->arena, int, 2 * (size_t)n),
      .out = out};
  int* oq = PL_ARRAY(b->arena, int, 2 * (size_t)n);
  double* oi = PL_ARRAY(b->arena, double, n);
  for (int k = 0; k < n; k++) {
    oq[2 * k] = 2 * k;
    oq[2 * k + 1] = 2 * k + 1;
    oi[k] = k + 1;
  }
  o.q = oq;
  o.index = oi;
  assert_int_equal(pl_pattern_record(&b->job, b->pool, &o, &b->observer), PLEUEL_OK);
  double a = 1;
  for (int k = 0; k < n; k++) {
    b->coordinate[2 * k] = (pl_coordinate){.name = pl_format(b->arena, "x[%d]", k + 1),
                                           .v_name = "v",
                                           .has_q = true,
                                           .has_v = true,
                                           .q = (k + 1) * sin(a) / n};
    b->coordinate[2 * k + 1] = (pl_coordinate){.name = pl_format(b->arena, "y[%d]", k + 1),
                                               .v_name = "v",
                                               .has_q = true,
                                               .has_v = true,
                                               .q = -(k + 1) * cos(a) / n};
    b->constraint[k] = (pl_constraint_setup){.name = pl_format(b->arena, "c[%d]", k + 1),
                                             .contact = -1};
  }
  b->column[0] = (pl_column){"T", "J"};
  b->column[1] = (pl_column){"V", "J"};
  b->n_q = 2 * n;
  b->setup = (pl_setup){.n_q = 2 * n,
                        .coordinates = b->coordinate,
                        .n_c = n,
                        .constraints = b->constraint,
                        .n_patterns = n > 1 ? 2 : 1,
                        .patterns = b->pattern,
                        .n_out = 2,
                        .out = b->column,
                        .n_observers = 1,
                        .observers = &b->observer,
                        .kinetic = 0,
                        .potential = 1,
                        .energy_conserved = true};
  b->options = (pl_run_options){.t_end = t_end, .sink = {.user = b, .row = t_on_row}};
  assert_int_equal(pl_run_make(&b->job, &b->setup, &b->options, &b->run), PLEUEL_OK);
  return b;
}

static void a_chain_of_two_hundred_rods_keeps_its_energy(void** state) {
  (void)state;
  t_bench* b = chain_make(200, 0.05);
  pleuel_status how = pl_run_to_end(b->run);
  const pl_stats* s = pl_run_stats(b->run);
  printf(
      "# chain 200: %s %s steps %ld rejected %ld drift %.2e g %.2e gdot %.2e wall %.2f rank %d\n",
      pleuel_status_name(how), b->job.message, s->steps, s->rejections, s->energy_drift, s->max_g,
      s->max_gdot, s->wall_s, s->rank);
  assert_int_equal(how, PLEUEL_OK);
  assert_true(s->energy_drift < 1e-13 && s->max_g < 1e-14);
  t_close(b);
}

// The same chain written as one pattern with one instance, all constraints spelled out, must move
// alike.
static void a_family_moves_like_its_members_written_out(void** state) {
  (void)state;
  enum { N = 11 };
  t_bench* family = chain_make(N, 0.8);
  assert_int_equal(pl_run_to_end(family->run), PLEUEL_OK);
  t_bench* b = t_open();
  pl_expr x[N], y[N], T = pl_int(P, 0), V = pl_int(P, 0);
  for (int k = 0; k < N; k++) {
    x[k] = t_coord(b, pl_format(b->arena, "x%d", k));
    y[k] = t_coord(b, pl_format(b->arena, "y%d", k));
    pl_expr m = pl_ratio(P, 1, N);
    T = pl_add(P, T,
               pl_mul(P, pl_mul(P, pl_ratio(P, 1, 2), m),
                      pl_add(P, pl_square(P, b->v[2 * k]), pl_square(P, b->v[2 * k + 1]))));
    V = pl_add(P, V, pl_mul(P, m, y[k]));
    pl_expr dx = k ? pl_sub(P, x[k], x[k - 1]) : x[k], dy = k ? pl_sub(P, y[k], y[k - 1]) : y[k];
    t_constraint(b, pl_format(b->arena, "c%d", k),
                 pl_sub(P, pl_add(P, pl_square(P, dx), pl_square(P, dy)), pl_ratio(P, 1, N * N)));
    t_start(b, 2 * k, (k + 1) * sin(1) / N, 0);
    t_start(b, 2 * k + 1, -(k + 1) * cos(1) / N, 0);
  }
  assert_int_equal(t_make(b, pl_sub(P, T, V), 0.8, 0), PLEUEL_OK);
  assert_int_equal(pl_run_to_end(b->run), PLEUEL_OK);
  double most = 0;
  for (int i = 0; i < 2 * N; i++)
    most = fmax(most, fabs(pl_run_q(b->run)[i] - pl_run_q(family->run)[i]));
  printf("# family against members: %.2e, steps %ld and %ld\n", most, pl_run_stats(b->run)->steps,
         pl_run_stats(family->run)->steps);
  assert_true(most < 1e-12);
  t_close(b);
  t_close(family);
}

static void a_large_run_allocates_nothing_while_stepping(void** state) {
  (void)state;
  t_bench* b = chain_make(60, 1);
  for (int i = 0; i < 3; i++) assert_int_equal(pl_run_step(b->run), PLEUEL_OK);
  unsigned long before = pl_arena_count(b->arena);
  for (int i = 0; i < 5; i++) assert_int_equal(pl_run_step(b->run), PLEUEL_OK);
  assert_true(pl_arena_count(b->arena) == before);
  t_close(b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_chain_of_two_hundred_rods_keeps_its_energy),
      cmocka_unit_test(a_family_moves_like_its_members_written_out),
      cmocka_unit_test(a_large_run_allocates_nothing_while_stepping),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
