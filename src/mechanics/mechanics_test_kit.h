// For the tests of mechanics: a text becomes an analysis; its expressions are compared with texts,
// or with numbers at points where all symbols have values.
#ifndef PL_MECHANICS_TEST_KIT_H
#define PL_MECHANICS_TEST_KIT_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "lang/lang.h"
#include "mechanics/mechanics.h"

typedef struct kit {
  pl_arena* arena;
  pl_diagnostics diagnostics;
  pl_job job;
  pl_model* model;
  pl_towers towers;
  pl_analysis* d;
  pleuel_status status;  // of the derivation
} kit;

static inline void kit_must(kit* k, pleuel_status status, const char* text) {
  for (int i = 0; status != PLEUEL_OK && i < k->diagnostics.list.n; i++) {
    print_message("%s: %s\n", text, k->diagnostics.list.at[i].sentence[0]);
  }
  assert_int_equal(status, PLEUEL_OK);
}

static inline kit* kit_open(const char* text) {
  pl_arena* a = pl_arena_make(NULL);
  kit* k = PL_NEW(a, kit);
  k->arena = a;
  k->diagnostics.arena = a;
  k->job = (pl_job){.arena = a, .diagnostics = &k->diagnostics};
  pl_source* source = pl_source_make(a, "test.pleuel", text, strlen(text));
  pl_model* read = NULL;
  kit_must(k, pl_lang_parse(&k->job, source, NULL, NULL, 0, &read), text);
  kit_must(k, pl_model_check(&k->job, read), text);
  assert_int_equal(pl_model_expand(&k->job, read, 24, &k->model), PLEUEL_OK);
  k->d = pl_analysis_open(&k->job, k->model, NULL, &k->towers);
  k->d->effort_s = 0.02;
  k->status = pl_derive_motion(k->d, NULL);
  return k;
}

static inline void kit_free(kit* k) {
  for (int i = 0; i < k->towers.n; i++) pl_tower_free(k->towers.at[i]);
  pl_arena_free(k->arena);
}

static inline pl_expr kit_expr(kit* k, const char* text) {
  pl_expr e = pl_poison();
  kit_must(k, pl_lang_expression(&k->job, k->d->model, text, &e), text);
  return e;
}

static inline pl_symbol kit_name(kit* k, const char* name) {
  pl_symbol s = pl_symbol_find(k->d->pool, name);
  if (!s.id) print_message("no symbol %s\n", name);
  assert_true(s.id != 0);
  return s;
}

static inline int kit_coordinate(kit* k, const char* name) {
  return pl_variable_index(k->d, kit_name(k, name));
}

static inline void kit_equal(kit* k, pl_expr e, pl_expr want) {
  if (pl_alg_equal(k->d->tower, e, want) == PL_YES) return;
  print_message("%s, expected %s\n", pl_expr_text(k->arena, k->d->pool, e),
                pl_expr_text(k->arena, k->d->pool, want));
  fail();
}

// e is what this text says, in the names of the model.
static inline void kit_is(kit* k, pl_expr e, const char* text) {
  kit_equal(k, e, kit_expr(k, text));
}

// Numbers for all symbols, the same for the same seed: given quantities positive, all of size one.
static inline double* kit_point(kit* k, uint64_t seed) {
  int n = pl_symbol_count(k->d->pool) + 1;
  double* value = PL_ARRAY(k->arena, double, n);
  pl_random r = {seed};
  for (int i = 1; i < n; i++) {
    bool given = pl_symbol_get(k->d->pool, (pl_symbol){(uint32_t)i})->role == PL_R_PARAM;
    double unit = pl_random_unit(&r);
    value[i] = given ? 0.5 + unit : 2 * unit - 1;
  }
  return value;
}

static inline double kit_value(kit* k, pl_expr e, const double* point) {
  return pl_eval(k->d->pool, e, point);
}

// The slope of e along a symbol by central differences of fourth order.
static inline double kit_slope(kit* k, pl_expr e, pl_symbol s, double* point) {
  static const double h = 1e-3;
  double at = point[s.id], f[4];
  static const double step[4] = {-2, -1, 1, 2};
  for (int i = 0; i < 4; i++) {
    point[s.id] = at + step[i] * h;
    f[i] = pl_eval(k->d->pool, e, point);
  }
  point[s.id] = at;
  return (f[0] - 8 * f[1] + 8 * f[2] - f[3]) / (12 * h);
}

static inline void kit_close(double got, double want, double tolerance) {
  if (fabs(got - want) <= tolerance * (1 + fabs(want))) return;
  print_message("%.17g, expected %.17g\n", got, want);
  fail();
}

#endif
