// Points and rods in large numbers: chains, trees and nets move alike however their coordinates are
// numbered, keep their energy, and tell rods that say nothing new.
#include "solve/setup_test.h"

#define P b->pool

typedef struct t_rod {
  int a, b;
} t_rod;  // b < 0: to the origin
typedef struct t_net {
  int n, n_rods;
  double x[256], y[256];
  t_rod rod[512];
  int place[256];  // point i has coordinates place[i] and place[i] + n
} t_net;

static t_net points(int n) {
  t_net t = {.n = n};
  for (int i = 0; i < n; i++) t.place[i] = i;
  return t;
}

static void add_rod(t_net* t, int a, int b) { t->rod[t->n_rods++] = (t_rod){a, b}; }

static t_net chain(int n) {
  t_net t = points(n);
  for (int i = 0; i < n; i++) {
    t.x[i] = (i + 1) * 0.6 / n;
    t.y[i] = (i + 1) * 0.8 / n + 0.1 / n * (i % 3);
    add_rod(&t, i, i - 1);
  }
  return t;
}

static t_net tree(int n, uint64_t seed) {
  t_net t = points(n);
  pl_random r = {seed};
  for (int i = 0; i < n; i++) {
    int before = i == 0 ? -1 : (int)(pl_random_bits(&r) % (uint64_t)i);
    double angle = pl_random_between(&r, 0, 6.28);
    t.x[i] = (before < 0 ? 0 : t.x[before]) + 0.1 * cos(angle);
    t.y[i] = (before < 0 ? 0 : t.y[before]) + 0.1 * sin(angle);
    add_rod(&t, i, before);
  }
  return t;
}

static t_net net(int n, int m) {
  t_net t = points(n * m);
  add_rod(&t, 0, -1);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < m; j++) {
      int k = i * m + j;
      t.x[k] = 0.05 + 0.1 * j + 0.013 * sin(3.0 * k);
      t.y[k] = 0.1 * i + 0.017 * cos(5.0 * k);
      if (j > 0) add_rod(&t, k, k - 1);
      if (i > 0) add_rod(&t, k, k - m);
    }
  return t;
}

static void shuffle(t_net* t, uint64_t seed) {
  pl_random r = {seed};
  for (int i = t->n - 1; i > 0; i--) {
    int j = (int)(pl_random_bits(&r) % (uint64_t)(i + 1)), x = t->place[i];
    t->place[i] = t->place[j];
    t->place[j] = x;
  }
}

// ----------------------------------------------------------------------------------------- the run
static pl_pattern_source source(t_bench* b, const pl_expr* q, int n_q, int n) {
  return (pl_pattern_source){
      .slots = {.n_q = n_q, .q = q, .n_c = 1, .lambda = b->lambda, .value_of_symbol = b->value},
      .n = n,
      .q = PL_ARRAY(b->arena, int, (size_t)n_q*(size_t)n + 1),
      .c = PL_ARRAY(b->arena, int, n + 1),
      .out = PL_ARRAY(b->arena, int, 2 * (size_t)n + 1)};
}

static void place(const t_net* t, pl_pattern_source* s, int instance, int slot, int point) {
  int* q = (int*)(uintptr_t)s->q + instance * s->slots.n_q + 2 * slot;
  q[0] = t->place[point];
  q[1] = t->place[point] + t->n;
}

static double length2(const t_net* t, t_rod r) {
  double x = t->x[r.a] - (r.b < 0 ? 0 : t->x[r.b]), y = t->y[r.a] - (r.b < 0 ? 0 : t->y[r.b]);
  return x * x + y * y;
}

// Rods of a length of their own: l² comes with the instance.
static void record_rods(t_bench* b, const t_net* t, const pl_expr* q, bool free, pl_symbol l2,
                        pl_pattern* out) {
  int n = 0;
  for (int r = 0; r < t->n_rods; r++) n += (t->rod[r].b >= 0) == free;
  pl_pattern_source s = source(b, q, free ? 4 : 2, n);
  double* index = PL_ARRAY(b->arena, double, n + 1);
  pl_expr dx = free ? pl_sub(P, q[0], q[2]) : q[0], dy = free ? pl_sub(P, q[1], q[3]) : q[1];
  pl_expr g = pl_sub(P, pl_add(P, pl_square(P, dx), pl_square(P, dy)), pl_sym(P, l2));
  n = 0;
  for (int r = 0; r < t->n_rods; r++) {
    if ((t->rod[r].b >= 0) != free) continue;
    place(t, &s, n, 0, t->rod[r].a);
    if (free) place(t, &s, n, 1, t->rod[r].b);
    ((int*)(uintptr_t)s.c)[n] = r;
    index[n++] = length2(t, t->rod[r]);
  }
  s.constraint = &g;
  s.slots.n_index = 1;
  s.slots.index = &l2;
  s.index = index;
  assert_int_equal(pl_pattern_record(&b->job, b->pool, &s, out), PLEUEL_OK);
}

static t_bench* net_make(const t_net* t, double t_end) {
  t_bench* b = t_open();
  pl_expr q[4] = {t_coord(b, "x"), t_coord(b, "y"), t_coord(b, "u"), t_coord(b, "w")};
  pl_symbol l2 = t_symbol(b, "l2", PL_R_INDEX);
  b->lambda[0] = pl_sym(P, t_symbol(b, "lambda", PL_R_MULTIPLIER));
  pl_expr m = t_param(b, "m", 1.0 / t->n);
  pl_expr T = pl_mul(P, pl_mul(P, pl_ratio(P, 1, 2), m),
                     pl_add(P, pl_square(P, b->v[0]), pl_square(P, b->v[1])));
  pl_expr V = pl_neg(P, pl_mul(P, m, q[1])), energy[2] = {T, V};
  pl_pattern_source masses = source(b, q, 2, t->n), observer = masses;
  masses.slots.n_c = observer.slots.n_c = 0;
  for (int i = 0; i < t->n; i++) {
    place(t, &masses, i, 0, i);
    ((int*)(uintptr_t)masses.out)[2 * i + 1] = 1;
  }
  masses.lagrangian = pl_sub(P, T, V);
  observer.n_outputs = 2;
  observer.output = energy;
  assert_int_equal(pl_pattern_record(&b->job, b->pool, &masses, &b->pattern[0]), PLEUEL_OK);
  assert_int_equal(pl_pattern_record(&b->job, b->pool, &observer, &b->observer), PLEUEL_OK);
  record_rods(b, t, q, false, l2, &b->pattern[1]);
  record_rods(b, t, q, true, l2, &b->pattern[2]);
  for (int i = 0; i < t->n; i++)
    for (int k = 0; k < 2; k++)
      b->coordinate[t->place[i] + k * t->n] = (pl_coordinate){
          .name = "q", .v_name = "v", .has_q = true, .has_v = true, .q = k ? t->y[i] : t->x[i]};
  for (int r = 0; r < t->n_rods; r++)
    b->constraint[r] = (pl_constraint_setup){.name = "rod", .contact = -1};
  b->column[0] = (pl_column){"T", "J"};
  b->column[1] = (pl_column){"V", "J"};
  b->setup = (pl_setup){.n_q = 2 * t->n,
                        .coordinates = b->coordinate,
                        .n_c = t->n_rods,
                        .constraints = b->constraint,
                        .n_patterns = 3,
                        .patterns = b->pattern,
                        .n_out = 2,
                        .out = b->column,
                        .n_observers = 1,
                        .observers = &b->observer,
                        .kinetic = 0,
                        .potential = 1,
                        .energy_conserved = true};
  b->options = (pl_run_options){.t_end = t_end, .general = true};
  assert_int_equal(pl_run_make(&b->job, &b->setup, &b->options, &b->run), PLEUEL_OK);
  return b;
}

static t_bench* moved(const t_net* t, double t_end, const char* what) {
  t_bench* b = net_make(t, t_end);
  pleuel_status how = pl_run_to_end(b->run);
  const pl_stats* s = pl_run_stats(b->run);
  printf("# %s: %s %s, %ld steps, drift %.1e, g %.1e, rank %d of %d\n", what,
         pleuel_status_name(how), b->job.message, s->steps, s->energy_drift, s->max_g, s->rank,
         t->n_rods);
  assert_int_equal(how, PLEUEL_OK);
  assert_true(s->energy_drift < 1e-12 && s->max_g < 1e-14);
  return b;
}

static double difference(const t_net* t, const t_bench* b, const t_net* u, const t_bench* c) {
  double most = 0;
  for (int i = 0; i < t->n; i++)
    for (int k = 0; k < 2; k++)
      most = fmax(most, fabs(pl_run_q(b->run)[t->place[i] + k * t->n]
                             - pl_run_q(c->run)[u->place[i] + k * u->n]));
  return most;
}

// ------------------------------------------------------------------------------------------- tests
static void expect_the_same_shuffled(const t_net* t, double t_end, const char* what) {
  t_net other = *t;
  shuffle(&other, 11);
  t_bench *b = moved(t, t_end, what), *c = moved(&other, t_end, "shuffled");
  double off = difference(t, b, &other, c);
  printf("#   apart: %.1e\n", off);
  assert_true(off < 1e-11);
  t_close(b);
  t_close(c);
}

static void numbering_does_not_matter(void** state) {
  (void)state;
  t_net a = chain(130), c = tree(110, 3), d = net(7, 8);
  expect_the_same_shuffled(&a, 0.1, "chain");
  expect_the_same_shuffled(&c, 0.1, "tree");
  expect_the_same_shuffled(&d, 0.1, "net");
}

static void a_rod_said_twice_changes_nothing(void** state) {
  (void)state;
  t_net once = chain(130), twice = once;
  add_rod(&twice, 60, 59);
  t_bench *b = moved(&once, 0.05, "chain"), *c = moved(&twice, 0.05, "a rod twice");
  assert_int_equal(pl_run_stats(c->run)->rank, 130);
  assert_true(difference(&once, b, &twice, c) < 1e-12);
  for (int r = 0; r < twice.n_rods; r++)
    assert_int_equal(pl_run_unique(c->run)[r], r != 60 && r != 130);
  t_close(b);
  t_close(c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(numbering_does_not_matter),
      cmocka_unit_test(a_rod_said_twice_changes_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
