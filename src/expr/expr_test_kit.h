// For the tests of expr: a pool with some names, random expressions, and comparison that prints
// what differs.
#ifndef PL_EXPR_TEST_KIT_H
#define PL_EXPR_TEST_KIT_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "expr/expr.h"

// PL_TEST(a_sentence_that_may_be_false) { ... }     inside, p is the pool and a its arena
#define PL_TEST(name)                               \
  static void name##_body(pl_pool* p, pl_arena* a); \
  static void name(void** state) {                  \
    pl_arena* a = pl_arena_make(NULL);              \
    pl_guard guard;                                 \
    bool fell = true;                               \
    PL_GUARD(a, guard) {                            \
      name##_body(pl_pool_make(a), a);              \
      fell = false;                                 \
    }                                               \
    pl_guard_end(a, &guard);                        \
    pl_arena_free(a);                               \
    assert_false(fell);                             \
  }                                                 \
  static void name##_body(pl_pool* p, pl_arena* a)

static inline pl_expr kit_symbol(pl_pool* p, const char* name, pl_role role, pl_class class,
                                 pl_sign_known sign) {
  pl_symbol_info info = {.name = name, .ascii = name, .role = role, .class = class, .sign = sign};
  return pl_sym(p, pl_symbol_make(p, &info));
}
static inline pl_expr kit_coordinate(pl_pool* p, const char* name) {
  return kit_symbol(p, name, PL_R_COORD, PL_C_COORD, PL_SIGN_ANY);
}
static inline pl_expr kit_parameter(pl_pool* p, const char* name, pl_class class) {
  return kit_symbol(p, name, PL_R_PARAM, class, PL_SIGN_POSITIVE);
}
static inline pl_expr kit_index(pl_pool* p, const char* name) {
  return kit_symbol(p, name, PL_R_INDEX, PL_C_OTHER, PL_SIGN_ANY);
}
static inline pl_expr kit_family(pl_pool* p, const char* name) {
  return kit_symbol(p, name, PL_R_ARRAY, PL_C_COORD, PL_SIGN_ANY);
}

#define assert_text(e, wanted) assert_string_equal(pl_expr_text(a, p, (e)), (wanted))

// Zero at `wanted` random points; points without value are passed over. Prints e if it is not zero.
static inline bool kit_vanishes(pl_pool* p, pl_expr e, uint64_t seed, int wanted) {
  int seen = 0;
  for (uint64_t k = 0; seen < wanted && k < 400; k++) {
    bool ok = false;
    pl_mod_point* m = pl_mod_point_make(pl_pool_arena(p), p, seed + k);
    uint64_t value = pl_eval_mod(m, e, &ok);
    if (!ok) continue;
    seen++;
    if (value != 0) {
      print_message("seed %llu: not zero: %s\n", (unsigned long long)(seed + k),
                    pl_expr_text(pl_pool_arena(p), p, e));
      return false;
    }
  }
  if (seen == 0) print_message("no good point: %s\n", pl_expr_text(pl_pool_arena(p), p, e));
  return seen > 0;
}

static inline bool kit_equal(pl_pool* p, pl_expr a, pl_expr b, uint64_t seed) {
  return kit_vanishes(p, pl_sub(p, a, b), seed, 3);
}

// ------------------------------------------------------------------------------ random expressions
// An expression together with its value, computed beside the constructors in plain double
// arithmetic.
typedef struct kit_pair {
  pl_expr e;
  double value;
} kit_pair;

typedef struct kit {
  pl_pool* p;
  pl_random random;
  pl_expr names[6];
  double values[64];  // by symbol id
  bool rational;      // no functions and no roots
} kit;

static inline kit kit_make(pl_pool* p, uint64_t seed) {
  kit k = {.p = p, .random = {seed}};
  k.names[0] = kit_coordinate(p, "x");
  k.names[1] = kit_coordinate(p, "y");
  k.names[2] = kit_coordinate(p, "phi");
  k.names[3] = kit_parameter(p, "m", PL_C_MASS);
  k.names[4] = kit_parameter(p, "l", PL_C_LENGTH);
  k.names[5] = pl_sym(p, pl_time(p));
  for (int i = 0; i < 64; i++) k.values[i] = pl_random_between(&k.random, 0.5, 1.5);
  return k;
}

static inline int kit_below(kit* k, int n) {
  return (int)(pl_random_bits(&k->random) % (uint64_t)n);
}

static inline kit_pair kit_leaf(kit* k) {
  if (kit_below(k, 4) == 0) {
    long num = kit_below(k, 13) - 6, den = 1 + kit_below(k, 4);
    return (kit_pair){pl_ratio(k->p, num, den), (double)num / (double)den};
  }
  pl_expr e = k->names[kit_below(k, 6)];
  return (kit_pair){e, k->values[pl_symbol_of(k->p, e).id]};
}

static inline kit_pair kit_random(kit* k, int depth);

static inline kit_pair kit_function(kit* k, int depth) {
  kit_pair x = kit_random(k, depth - 1);
  switch (kit_below(k, 8)) {
    case 0: return (kit_pair){pl_call(k->p, PL_COS, x.e), cos(x.value)};
    case 1: return (kit_pair){pl_call(k->p, PL_SIN, x.e), sin(x.value)};
    case 2: return (kit_pair){pl_call(k->p, PL_TAN, x.e), tan(x.value)};
    case 3: return (kit_pair){pl_sqrt(k->p, x.e), sqrt(x.value)};
    case 4: return (kit_pair){pl_call(k->p, PL_ABS, x.e), fabs(x.value)};
    case 5: return (kit_pair){pl_call(k->p, PL_EXP, x.e), exp(x.value)};
    case 6: return (kit_pair){pl_call(k->p, PL_ATAN, x.e), atan(x.value)};
    default: return (kit_pair){pl_call(k->p, PL_COSH, x.e), cosh(x.value)};
  }
}

static inline kit_pair kit_operation(kit* k, int depth) {
  kit_pair x = kit_random(k, depth - 1), y = kit_random(k, depth - 1 - kit_below(k, 2));
  switch (kit_below(k, k->rational ? 7 : 9)) {
    case 0:
    case 1: return (kit_pair){pl_add(k->p, x.e, y.e), x.value + y.value};
    case 2: return (kit_pair){pl_sub(k->p, x.e, y.e), x.value - y.value};
    case 3:
    case 4: return (kit_pair){pl_mul(k->p, x.e, y.e), x.value * y.value};
    case 5: return (kit_pair){pl_div(k->p, x.e, y.e), x.value / y.value};
    case 6: {
      long n = kit_below(k, 5) - 1;
      return (kit_pair){pl_pow_int(k->p, x.e, n),
                        isnan(x.value) ? x.value : pow(x.value, (double)n)};
    }
    default: return kit_function(k, depth);
  }
}

// What has left the domain once stays outside, as poison does.
static inline kit_pair kit_random(kit* k, int depth) {
  if (depth <= 0) return kit_leaf(k);
  kit_pair x = kit_operation(k, depth);
  if (!isfinite(x.value)) x.value = (double)NAN;
  return x;
}

// Close in relation to the sizes that may have cancelled; only moderate values are compared.
static inline bool kit_close(double x, double y) {
  return fabs(x - y) <= 1e-7 * (1 + fabs(x) + fabs(y));
}

#endif
