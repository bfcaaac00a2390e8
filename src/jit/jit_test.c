// Programs: the lowered recurrences agree with the series of jet/, and what is compiled has the
// bits of what is interpreted. Without the plugin, or on a machine that cannot load it, the
// compiled half is skipped.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "jit/jit.h"

enum { ORDERS = 14, MOST_NODES = 220 };

typedef struct t_tape {
  pl_arena* arena;
  pl_tape tape;
  pl_tape_node node[MOST_NODES];
  int lanes, base_sum, size;
  bool means;  // weighted sums come divided by the order
  int scale;   // streams of 1/k and of what its rounding left
  pl_prog *value, *order;
  int start[MOST_NODES], now[MOST_NODES];
} t_tape;

// ------------------------------------------------------------------------------------ random tapes
static int add(t_tape* t, pl_op op, int a, int b, int c) {
  bool constant = (op == PL_OP_CONST || op == PL_OP_PARAM || op == PL_OP_INDEX);
  t->node[t->tape.n_nodes] = (pl_tape_node){.op = (uint8_t)op,
                                            .level = constant ? PL_LEVEL_CONST : PL_LEVEL_POSITION,
                                            .high = true,
                                            .a = a,
                                            .b = b,
                                            .c = c};
  return t->tape.n_nodes++;
}

static int any(pl_random* r, int from, int to) {
  return from + (int)(pl_random_bits(r) % (uint64_t)(to - from));
}

// The partner that the recurrence of a function reads.
static int add_function(t_tape* t, pl_op op, int a, int b) {
  int one = 0, self;
  switch (op) {
    case PL_OP_SIN:
    case PL_OP_COS:
    case PL_OP_SINH:
    case PL_OP_COSH: {
      pl_op other = op == PL_OP_SIN    ? PL_OP_COS
                    : op == PL_OP_COS  ? PL_OP_SIN
                    : op == PL_OP_SINH ? PL_OP_COSH
                                       : PL_OP_SINH;
      self = add(t, op, a, -1, -1);
      t->node[self].c = add(t, other, a, -1, self);
      return self;
    }
    case PL_OP_TAN:
    case PL_OP_TANH:
      self = add(t, op, a, -1, -1);
      t->node[self].c = add(t, PL_OP_SQR, self, -1, -1);
      return self;
    case PL_OP_ASIN:
    case PL_OP_ACOS:
      return add(
          t, op, a, -1,
          add(t, PL_OP_SQRT, add(t, PL_OP_SUB, one, add(t, PL_OP_SQR, a, -1, -1), -1), -1, -1));
    case PL_OP_ASINH:
      return add(
          t, op, a, -1,
          add(t, PL_OP_SQRT, add(t, PL_OP_ADD, one, add(t, PL_OP_SQR, a, -1, -1), -1), -1, -1));
    case PL_OP_ATAN:
      return add(t, op, a, -1, add(t, PL_OP_ADD, one, add(t, PL_OP_SQR, a, -1, -1), -1));
    case PL_OP_ATAN2:
      return add(t, op, a, b,
                 add(t, PL_OP_ADD, add(t, PL_OP_SQR, a, -1, -1), add(t, PL_OP_SQR, b, -1, -1), -1));
    default: return add(t, op, a, b, -1);
  }
}

// All operations of tape.def, each at least once, in random order; numbers that overflow or leave a
// domain are welcome.
static void random_tape(t_tape* t, pl_random* r) {
  add(t, PL_OP_CONST, -1, -1, -1);
  t->node[0].value = 1;
  for (int i = 1; i < 4; i++)
    t->node[add(t, PL_OP_CONST, -1, -1, -1)].value = pl_random_between(r, -2, 2);
  int n_const = t->tape.n_nodes;
  t->tape.level_end[PL_LEVEL_CONST] = n_const;
  for (int s = 0; s < 4; s++) t->node[add(t, PL_OP_Q, -1, -1, -1)].slot = s;
  add(t, PL_OP_TIME, -1, -1, -1);
  for (int op = PL_OP_ADD; op < PL_N_OPS; op++) {
    for (int times = any(r, 1, 3); times > 0 && t->tape.n_nodes < MOST_NODES - 12; times--) {
      int n = t->tape.n_nodes, a = any(r, n_const, n),
          b = any(r, pl_random_bits(r) % 4 ? n_const : 0, n);
      if (op == PL_OP_SCALE || op == PL_OP_RSCALE || op == PL_OP_POW) b = any(r, 0, n_const);
      if (op == PL_OP_IF) add(t, (pl_op)op, a, b, any(r, n_const, n));
      else add_function(t, (pl_op)op, a, pl_op_reads[op] > 1 ? b : -1);
    }
  }
  t->tape.nodes = t->node;
  for (int level = PL_LEVEL_POSITION; level < PL_N_LEVELS; level++)
    t->tape.level_end[level] = t->tape.n_nodes;
}

// ------------------------------------------------------------------------------------- as programs
// Memory: coefficient k of a node at (node ORDERS + k) lanes, then three sums a node.
static int place(const t_tape* t, int node) { return node * ORDERS * t->lanes; }
static int sum_place(const t_tape* t, int node, int i) {
  return t->base_sum + (node * 3 + i) * t->lanes;
}
static bool constant(const t_tape* t, int node) { return node < t->tape.level_end[PL_LEVEL_CONST]; }

static int start_of(void* user, int node) {
  t_tape* t = user;
  pl_prog* p = t->start[node] == -2 ? t->value : t->order;
  return pl_prog_load(p, place(t, node), 0);
}
static int now_of(void* user, int node) {
  t_tape* t = user;
  return constant(t, node) ? -1 : pl_prog_load(t->order, place(t, node), t->lanes);
}
static int sum_of(void* user, int node, int i) {
  t_tape* t = user;
  pl_recurrence_sum s[3];
  pl_recurrence_sums(&t->tape, node, s);
  return constant(t, s[i].a) || constant(t, s[i].b)
             ? -1
             : pl_prog_load(t->order, sum_place(t, node, i), 0);
}

static void write_sums(t_tape* t) {
  pl_recurrence_sum s[3];
  pl_prog_block_begin(t->order, t->lanes, 0);
  for (int i = 0; i < t->tape.n_nodes; i++) {
    int n = pl_recurrence_sums(&t->tape, i, s);
    for (int j = 0; j < n; j++) {
      if (constant(t, s[j].a) || constant(t, s[j].b)) continue;
      pl_prog_sum_begin(t->order, sum_place(t, i, j), s[j].weighted);
      if (t->means && s[j].weighted)
        pl_prog_sum_scale(t->order, t->scale, t->scale + ORDERS * t->lanes);
      pl_prog_sum_pair(t->order, place(t, s[j].a), place(t, s[j].b));
    }
  }
}

static void write_programs(t_tape* t) {
  t->value = pl_prog_make(t->arena, "value", t->lanes);
  t->order = pl_prog_make(t->arena, "order", t->lanes);
  pl_recurrence low = {.code = t->value,
                       .tape = &t->tape,
                       .user = t,
                       .start = start_of,
                       .now = now_of,
                       .sum = sum_of,
                       .means = t->means};
  for (int i = 0; i < t->tape.n_nodes; i++) t->start[i] = -2;
  for (int i = t->tape.level_end[PL_LEVEL_CONST]; i < t->tape.n_nodes; i++) {
    int x = pl_recurrence_value(&low, i);
    if (x >= 0) pl_prog_store(t->value, x, place(t, i), 0);
  }
  for (int i = 0; i < t->tape.n_nodes; i++) t->start[i] = -1;
  low.code = t->order;
  write_sums(t);
  for (int i = t->tape.level_end[PL_LEVEL_CONST]; i < t->tape.n_nodes; i++) {
    if (t->node[i].op == PL_OP_Q || t->node[i].op == PL_OP_TIME) continue;
    int x = pl_recurrence_coefficient(&low, i);
    pl_prog_store(t->order, x < 0 ? pl_prog_number(t->order, 0) : x, place(t, i), t->lanes);
  }
  t->size = t->scale + 2 * ORDERS * t->lanes;
  t->value->spill = t->size;
  t->size += t->value->n_registers * t->lanes;
  t->order->spill = t->size;
  t->size += t->order->n_registers * t->lanes;
}

static t_tape* make(pl_random* r, int lanes, bool means) {
  pl_arena* arena = pl_arena_make(NULL);
  t_tape* t = PL_NEW(arena, t_tape);
  t->arena = arena;
  t->lanes = lanes;
  t->means = means;
  random_tape(t, r);
  t->base_sum = t->tape.n_nodes * ORDERS * lanes;
  t->scale = t->base_sum + 3 * t->tape.n_nodes * lanes;
  write_programs(t);
  return t;
}

static double* memory_of(t_tape* t, pl_random* r) {
  double* m = PL_ARRAY(t->arena, double, t->size);
  for (int k = 1; k < ORDERS; k++)
    for (int l = 0; l < t->lanes; l++) {
      m[t->scale + k * t->lanes + l] = 1.0 / k;
      m[t->scale + (ORDERS + k) * t->lanes + l] = fma(-k, 1.0 / k, 1) / k;
    }
  for (int i = 0; i < t->tape.n_nodes; i++)
    for (int k = 0; k < ORDERS; k++)
      for (int l = 0; l < t->lanes; l++) {
        double* x = m + place(t, i) + k * t->lanes + l;
        if (t->node[i].op == PL_OP_Q) *x = pl_random_between(r, 0.1, 0.9) / (1 + k * k);
        if (t->node[i].op == PL_OP_TIME) *x = k == 0 ? 0.3 : k == 1;
        if (t->node[i].op == PL_OP_CONST && k == 0) *x = t->node[i].value;
      }
  return m;
}

// ------------------------------------------------------------------------------------------- tests
static uint64_t seed_of(const char* name) {
  const char* given = getenv("PL_SEED");
  uint64_t seed = given ? strtoull(given, NULL, 10) : 20261121;
  print_message("# %s: seed %llu\n", name, (unsigned long long)seed);
  return seed;
}

static void lowered_recurrences_agree_with_the_series(void** state) {
  (void)state;
  pl_random r = {seed_of("series")};
  int compared = 0;
  for (int round = 0; round < 20; round++) {
    t_tape* t = make(&r, round % 2 ? 8 : 1, round % 4 < 2);
    double* m = memory_of(t, &r);
    pl_jet* j = pl_jet_make(t->arena, &t->tape, t->lanes, ORDERS);
    for (int i = 0; i < t->tape.n_nodes; i++)
      for (int k = 0; k < (constant(t, i) ? 1 : ORDERS); k++)
        memcpy(pl_jet_at(j, i, k), m + place(t, i) + k * t->lanes, (size_t)t->lanes * sizeof *m);
    for (int k = 0; k < ORDERS; k++) j->kernel(j, PL_LEVEL_POSITION, k, true);
    pl_prog_interpret(t->value, m, 0, 1);
    pl_prog_interpret(t->order, m, 1, ORDERS);
    // rounding grows along a series and with what a node stands on: low orders of tame nodes tell a
    // wrong recurrence
    double scale[MOST_NODES] = {0};
    for (int i = t->tape.level_end[PL_LEVEL_CONST]; i < t->tape.n_nodes; i++) {
      const int operand[] = {t->node[i].a, t->node[i].b, t->node[i].c};
      for (int o = 0; o < 3; o++)
        if (operand[o] >= 0 && !(scale[operand[o]] <= scale[i])) scale[i] = scale[operand[o]];
      for (int k = 0; k < 4; k++) {
        double x = pl_jet_at(j, i, k)[0], y = m[place(t, i) + k * t->lanes];
        if (!(fabs(x) <= scale[i])) scale[i] = fabs(x);
        if (!(scale[i] < 1e3)) continue;
        compared++;
        if (!(fabs(x - y) <= 1e-9 * fmax(1, scale[i])))
          print_message("# node %d %s order %d: %.17g and %.17g\n", i, pl_op_name[t->node[i].op], k,
                        x, y);
        assert_true(fabs(x - y) <= 1e-9 * fmax(1, scale[i]));
      }
    }
    pl_arena_free(t->arena);
  }
  print_message("# %d coefficients\n", compared);
  assert_true(compared > 500);
}

static bool same_bits(double a, double b) {
  return memcmp(&a, &b, sizeof a) == 0 || (isnan(a) && isnan(b));
}

static void compile_and_compare(pl_random* r, int lanes, bool means) {
  t_tape* t = make(r, lanes, means);
  double *m = memory_of(t, r), *n = PL_ARRAY(t->arena, double, t->size);
  memcpy(n, m, (size_t)t->size * sizeof *m);
  const pl_prog* progs[] = {t->value, t->order};
  pl_prog_run* run[2];
  pl_jit_code* code = pl_jit_compile(t->arena, progs, 2, run, NULL, NULL);
  assert_non_null(code);
  pl_prog_interpret(t->value, m, 0, 1);
  pl_prog_interpret(t->order, m, 1, ORDERS);
  run[0](n, 0, 1);
  run[1](n, 1, ORDERS);
  for (int i = 0; i < t->base_sum; i++) {
    if (!same_bits(m[i], n[i]))
      print_message("# lanes %d node %s order %d: %a and %a\n", lanes,
                    pl_op_name[t->node[i / (ORDERS * lanes)].op], i / lanes % ORDERS, m[i], n[i]);
    assert_true(same_bits(m[i], n[i]));
  }
  pl_jit_free(code);
  pl_arena_free(t->arena);
}

static void compiled_random_tapes_have_the_bits_of_the_interpreter(void** state) {
  (void)state;
  const char* why;
  if (!pl_jit_available(&why, NULL)) {
    print_message("# SKIP: %s\n", why);
    skip();
  }
  pl_random r = {seed_of("bits")};
  for (int round = 0; round < 3; round++) {
    compile_and_compare(&r, 1, round > 0);
    compile_and_compare(&r, 8, round < 2);
  }
}

static void products_and_rows_of_sums_have_the_same_bits(void** state) {
  (void)state;
  if (!pl_jit_available(NULL, NULL)) skip();
  enum { N = 13, SIZE = 4096 };
  pl_arena* a = pl_arena_make(NULL);
  pl_random r = {seed_of("products")};
  pl_prog* p = pl_prog_make(a, "product", 1);
  pl_prog_product_add(p, 0, 64, 32, N, 5, 2);
  pl_prog_product_add(p, 16, 64, 32, N, 1, 2);
  pl_prog_block_begin(p, 8, 1);
  for (int i = 0; i < 11; i++) {
    pl_prog_sum_begin(p, 512 + 8 * i, i == 5);
    if (i % 4 == 2) pl_prog_sum_scale(p, 3200 + 8 * i, 3400 + 8 * i);
    for (int q = 0; q <= i % 5; q++)
      pl_prog_sum_pair(p, 1024 + 64 * (i + q), 2048 + 64 * (i + 2 * q));
  }
  p->spill = 4000;
  double *m = PL_ARRAY(a, double, SIZE), *n = PL_ARRAY(a, double, SIZE);
  for (int i = 0; i < SIZE; i++) m[i] = n[i] = pl_random_between(&r, -1, 1);
  const pl_prog* progs[] = {p};
  pl_prog_run* run;
  pl_jit_code* code = pl_jit_compile(a, progs, 1, &run, NULL, NULL);
  assert_non_null(code);
  pl_prog_interpret(p, m, 0, 7);
  run(n, 0, 7);
  assert_memory_equal(m, n, SIZE * sizeof *m);
  pl_jit_free(code);
  pl_arena_free(a);
}

// A series of six numbers: sums over two streams, of which the second holds what the order before
// has found, and a product.
static pl_prog* write_series(pl_arena* a, int orders) {
  enum {
    N = 6,
    A = 0,
    B = 128,
    C = 256,
    SCALE = 384,
    REST = 512,
    TO = 640,
    MATRIX = 704,
    X = 800,
    Y = 816,
    OUT = 832
  };
  pl_prog* p = pl_prog_make(a, "series", 1);
  pl_prog_block_begin(p, 8, 1);
  for (int s = 0; s < 3; s++) {
    pl_prog_sum_begin(p, TO + 8 * s, false);
    for (int i = 0; i <= 2 * s; i++) pl_prog_sum_pair(p, i % 2 ? C : A, i == 2 ? A : B);
    if (s == 1) pl_prog_sum_scale(p, SCALE, REST);
  }
  for (int i = 0; i < N; i++) {
    int x = pl_prog_op2(p, PL_PROG_ADD, pl_prog_load(p, TO + i, 0),
                        pl_prog_load(p, TO + 8 + i % 3, 0));
    x = pl_prog_op3(p, PL_PROG_FMA, pl_prog_load(p, OUT + (i + 1) % N, N),
                    pl_prog_load(p, SCALE, 8), x);
    pl_prog_store(p, x, X + i, 0);
    pl_prog_store(p, x, A + 8 + i, 8);
    if (i < 3) pl_prog_store(p, x, C + 8 + i, 8);
  }
  pl_prog_product_add(p, Y, MATRIX, X, N, 2, 1);
  for (int i = 0; i < N; i++) {
    int y = pl_prog_op2(p, PL_PROG_SUB, pl_prog_load(p, Y + i, 0), pl_prog_load(p, TO + 16 + i, 0));
    pl_prog_store(p, y, OUT + N + i, N);
    // one lane is written an order later
    if (i != 4) pl_prog_store(p, y, B + (i == 2 ? 0 : 8) + i, 8);
  }
  p->spill = OUT + N * (orders + 2);
  return p;
}

static void orders_written_out_have_the_same_bits(void** state) {
  (void)state;
  if (!pl_jit_available(NULL, NULL)) skip();
  enum { ORDERS_HERE = 13, SIZE = 4096, STREAMS = 384, OUTPUTS = 832 };
  pl_arena* a = pl_arena_make(NULL);
  pl_random r = {seed_of("written out")};
  pl_prog* p = write_series(a, ORDERS_HERE);
  double *m = PL_ARRAY(a, double, SIZE), *n = PL_ARRAY(a, double, SIZE);
  for (int i = 384; i < SIZE; i++) m[i] = pl_random_between(&r, -1, 1);
  for (int i = 0; i < 16; i++)  // the first rows of what is written
    for (int s = 0; s < 3; s++)
      if (i % 8 < (s == 2 ? 3 : 6) && !(s == 1 && i % 8 == 4))
        m[128 * s + i] = pl_random_between(&r, -1, 1);
  memcpy(n, m, SIZE * sizeof *m);
  pl_prog_interpret(p, m, 1, ORDERS_HERE);
  p->first_order = 1;
  p->orders = ORDERS_HERE;
  const pl_prog* progs[] = {p};
  pl_prog_run* run;
  pl_jit_code* code = pl_jit_compile(a, progs, 1, &run, NULL, NULL);
  assert_non_null(code);
  run(n, 1, ORDERS_HERE);
  assert_memory_equal(m, n, STREAMS * sizeof *m);
  assert_memory_equal(m + OUTPUTS, n + OUTPUTS, (size_t)(p->spill - OUTPUTS) * sizeof *m);
  assert_true(isfinite(m[p->spill - 7]) && m[p->spill - 7] != 0);
  pl_jit_free(code);
  pl_arena_free(a);
}

// --------------------------------------------------------------------------------------- the store
static void damage(const char* folder) {
  char command[512];
  snprintf(
      command, sizeof command,
      "for f in %s/pleuel/*.o; do printf x | dd of=$f bs=1 seek=200 conv=notrunc 2>/dev/null; done",
      folder);
  assert_int_equal(system(command), 0);
}

static bool compile_small(pl_jit_story* story) {
  pl_arena* a = pl_arena_make(NULL);
  pl_prog* p = pl_prog_make(a, "small", 1);
  pl_prog_store(p, pl_prog_op2(p, PL_PROG_ADD, pl_prog_load(p, 0, 0), pl_prog_load(p, 1, 0)), 2, 0);
  p->spill = 3;
  double m[16] = {1.5, 2.25};
  const pl_prog* progs[] = {p};
  pl_prog_run* run = NULL;
  pl_jit_code* code = pl_jit_compile(a, progs, 1, &run, story, NULL);
  if (code) run(m, 0, 1);
  pl_jit_free(code);
  pl_arena_free(a);
  return m[2] == 3.75;
}

static void a_damaged_object_is_compiled_again(void** state) {
  (void)state;
  if (!pl_jit_available(NULL, NULL)) skip();
  char folder[] = "/tmp/pleuel-store-XXXXXX", command[64];
  assert_non_null(mkdtemp(folder));
  setenv("XDG_CACHE_HOME", folder, 1);
  unsetenv("PLEUEL_CACHE");
  pl_jit_story story;
  assert_true(compile_small(&story) && !story.stored);
  assert_true(compile_small(&story) && story.stored);
  damage(folder);
  assert_true(compile_small(&story) && !story.stored);
  assert_true(compile_small(&story) && story.stored);
  setenv("PLEUEL_CACHE", "off", 1);
  assert_true(compile_small(&story) && !story.stored);
  snprintf(command, sizeof command, "rm -r %s", folder);
  assert_int_equal(system(command), 0);
}

int main(void) {
  setenv("PLEUEL_CACHE", "off", 1);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lowered_recurrences_agree_with_the_series),
      cmocka_unit_test(compiled_random_tapes_have_the_bits_of_the_interpreter),
      cmocka_unit_test(products_and_rows_of_sums_have_the_same_bits),
      cmocka_unit_test(orders_written_out_have_the_same_bits),
      cmocka_unit_test(a_damaged_object_is_compiled_again),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
