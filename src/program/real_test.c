// Numbers wider than doubles: arithmetic of each type against that of 128 bits or against exact
// cases, parts, text, and programs that give in every type what they give in doubles.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "program/program.h"

enum { TYPES = 3 };
static const pl_real* type_of(int i) {
  return i == 0 ? pl_real_long() : i == 1 ? pl_real_pair() : pl_real_quad();
}

// Room for some numbers of any type.
typedef struct t_memory {
  _Alignas(16) char bytes[64 * 16];
} t_memory;

static pl_parts random_parts(pl_random* r) {
  double x = ldexp(pl_random_between(r, 1, 2), (int)(pl_random_bits(r) % 40) - 20);
  if (pl_random_bits(r) & 1) x = -x;
  return (pl_parts){{x, x * ldexp(pl_random_between(r, -1, 1), -54), 0}};
}

// |x - y| relative to |y|, by parts.
static double apart(pl_parts x, pl_parts y) {
  double difference = (x.part[0] - y.part[0]) + ((x.part[1] - y.part[1]) + (x.part[2] - y.part[2]));
  return fabs(difference) / fabs(y.part[0]);
}

static pl_prog* operation(pl_arena* a, pl_prog_op op) {
  pl_prog* p = pl_prog_make(a, "one", 1);
  int x = pl_prog_load(p, 0, 0), y = pl_prog_load(p, 1, 0);
  int z = op == PL_PROG_SQRT  ? pl_prog_op1(p, op, pl_prog_op1(p, PL_PROG_ABS, x))
          : op == PL_PROG_FMA ? pl_prog_op3(p, op, x, y, pl_prog_load(p, 2, 0))
                              : pl_prog_op2(p, op, x, y);
  pl_prog_store(p, z, 3, 0);
  p->spill = 4;
  return p;
}

static void arithmetic_has_the_digits_of_its_type(void** state) {
  (void)state;
  static const pl_prog_op op[] = {PL_PROG_ADD, PL_PROG_SUB,  PL_PROG_MUL,
                                  PL_PROG_DIV, PL_PROG_SQRT, PL_PROG_FMA};
  const pl_real* quad = pl_real_quad();
  if (quad == NULL) skip();
  pl_arena* a = pl_arena_make(NULL);
  pl_random r = {20261121};
  for (size_t o = 0; o < sizeof op / sizeof *op; o++) {
    pl_prog* p = operation(a, op[o]);
    for (int times = 0; times < 2000; times++) {
      pl_parts in[3] = {random_parts(&r), random_parts(&r), random_parts(&r)};
      t_memory exact = {{0}};
      // what all types hold, so that the result alone is compared
      const pl_real* narrow = pl_real_long() ? pl_real_long() : quad;
      for (int i = 0; i < 3; i++) {
        narrow->set(exact.bytes, 8 + i, in[i]);
        in[i] = narrow->get(exact.bytes, 8 + i);
      }
      for (int i = 0; i < 3; i++) quad->set(exact.bytes, i, in[i]);
      quad->interpret(p, exact.bytes, 0, 1);
      pl_parts y = quad->get(exact.bytes, 3);
      double size = fabs(in[0].part[0]) + fabs(in[1].part[0]), most = fabs(y.part[0]);
      if (op[o] == PL_PROG_FMA) size = fabs(in[0].part[0] * in[1].part[0]) + fabs(in[2].part[0]);
      for (int t = 0; t < TYPES; t++) {
        t_memory m = {{0}};
        const pl_real* type = type_of(t);
        if (type == NULL) continue;
        for (int i = 0; i < 3; i++) type->set(m.bytes, i, in[i]);
        type->interpret(p, m.bytes, 0, 1);
        double limit = type->epsilon;
        if (op[o] == PL_PROG_FMA) limit *= 2 * fmax(1, size / most);
        if (type->bits == 106 && op[o] != PL_PROG_FMA) limit *= 8;
        if (apart(type->get(m.bytes, 3), y) > limit)
          fail_msg("%s %s: off by %g, seed 20261121", type->name, pl_prog_op_name[op[o]],
                   apart(type->get(m.bytes, 3), y));
      }
    }
  }
  pl_arena_free(a);
}

static void numbers_come_back_from_their_parts(void** state) {
  (void)state;
  pl_random r = {7};
  for (int t = 0; t < TYPES; t++) {
    const pl_real* type = type_of(t);
    for (int times = 0; type && times < 2000; times++) {
      t_memory m = {{0}};
      type->set(m.bytes, 0, random_parts(&r));
      type->set(m.bytes, 1, type->get(m.bytes, 0));
      assert_memory_equal(m.bytes, m.bytes + type->size, type->bits == 64 ? 10 : type->size);
      type->set(m.bytes, 2, (pl_parts){{1, ldexp(1, 1 - type->bits), 0}});
      assert_true(type->get(m.bytes, 2).part[1] == ldexp(1, 1 - type->bits));
    }
  }
}

static void text_reads_back_and_is_short(void** state) {
  (void)state;
  char text[PL_REAL_TEXT];
  t_memory m = {{0}};
  for (int t = 0; t < TYPES; t += 2) {
    const pl_real* type = type_of(t);
    if (type == NULL) continue;
    const double simple[] = {0, 0.5, -3, 1e100};
    const char* const written[] = {"0", "0.5", "-3"};
    for (int i = 0; i < 3; i++) {
      type->write(m.bytes, 0, 1, &simple[i]);
      int length = type->text(text, m.bytes, 0, false);
      assert_int_equal(length, (int)strlen(text));
      assert_string_equal(text, written[i]);
    }
    // a tenth in parts is a tenth
    type->set(m.bytes, 0, (pl_parts){{0.1, -5.5511151231257827e-18, 3.0814879110195774e-34}});
    type->text(text, m.bytes, 0, true);
    assert_string_equal(text, "-0.1");
    type->set(m.bytes, 0, (pl_parts){{(double)NAN, 0, 0}});
    type->text(text, m.bytes, 0, false);
    assert_string_equal(text, "nan");
  }
}

static void rounding_to_the_state_leaves_64_digits(void** state) {
  (void)state;
  const pl_real *pair = pl_real_pair(), *narrow = pl_real_long();
  if (pair == NULL || narrow == NULL) skip();
  pl_random r = {11};
  for (int times = 0; times < 2000; times++) {
    t_memory m = {{0}}, n = {{0}};
    pair->set(m.bytes, 0, random_parts(&r));
    narrow->set(n.bytes, 0, pair->get(m.bytes, 0));
    pair->round_to_long(m.bytes, 0, 1);
    pl_parts x = pair->get(m.bytes, 0), y = narrow->get(n.bytes, 0);
    assert_true(x.part[0] == y.part[0] && x.part[1] == y.part[1]);
  }
}

// Sums over orders and calls, in all types against doubles.
static void programs_agree_with_doubles(void** state) {
  (void)state;
  pl_arena* a = pl_arena_make(NULL);
  pl_prog* p = pl_prog_make(a, "sums", 1);
  pl_prog_block_begin(p, 8, 0);
  pl_prog_sum_begin(p, 200, true);
  pl_prog_sum_lanes(p, 3);
  pl_prog_sum_scale(p, -1, -1);
  pl_prog_sum_pair(p, 0, 80);
  pl_prog_store(p,
                pl_prog_call2(p, PL_FN_atan2, pl_prog_call1(p, PL_FN_sin, pl_prog_load(p, 200, 0)),
                              pl_prog_load(p, 201, 0)),
                208, 0);
  p->spill = 210;
  enum { SIZE = 240 };
  double x[SIZE] = {0}, out[3], wide[3];
  pl_random r = {3};
  for (int i = 0; i < 160; i++) x[i] = pl_random_between(&r, -1, 1);
  double* plain = PL_ARRAY(a, double, SIZE);
  memcpy(plain, x, sizeof x);
  pl_prog_interpret(p, plain, 7, 8);
  out[0] = plain[200];
  out[1] = plain[202];
  out[2] = plain[208];
  for (int t = 0; t < TYPES; t++) {
    const pl_real* type = type_of(t);
    if (type == NULL) continue;
    char* m = PL_ARRAY(a, char, SIZE * type->size);
    type->write(m, 0, SIZE, x);
    type->interpret(p, m, 7, 8);
    type->read(m, 200, 1, &wide[0]);
    type->read(m, 202, 1, &wide[1]);
    type->read(m, 208, 1, &wide[2]);
    for (int i = 0; i < 3; i++) assert_true(fabs(wide[i] - out[i]) < 1e-14);
  }
  pl_arena_free(a);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(arithmetic_has_the_digits_of_its_type),
      cmocka_unit_test(numbers_come_back_from_their_parts),
      cmocka_unit_test(text_reads_back_and_is_short),
      cmocka_unit_test(rounding_to_the_state_leaves_64_digits),
      cmocka_unit_test(programs_agree_with_doubles),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
