// What the tests of model share: a model built by calls, with a text so that messages have places.
#ifndef PL_MODEL_TEST_KIT_H
#define PL_MODEL_TEST_KIT_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "model/model_impl.h"

#define PL_TEST(name) static void name(void** state)

typedef struct kit {
  pl_arena* arena;
  pl_diagnostics diagnostics;
  pl_job job;
  pl_model* m;
  pl_source* source;
} kit;

static inline kit* kit_in(pl_arena* a, const char* text) {
  kit* k = PL_NEW(a, kit);
  k->arena = a;
  k->diagnostics.arena = a;
  k->job.arena = a;
  k->job.diagnostics = &k->diagnostics;
  k->m = pl_model_make(a);
  if (text) k->m->source = k->source = pl_source_make(a, "test.pleuel", text, strlen(text));
  return k;
}

static inline kit* kit_make(const char* text) { return kit_in(pl_arena_make(NULL), text); }

static inline void kit_free(kit* k) { pl_arena_free(k->arena); }

// The place of a part of the text.
static inline pl_span at(kit* k, const char* part) {
  if (!k->source || !part) return (pl_span){0};
  const char* found = strstr(k->source->text, part);
  if (!found) return (pl_span){0};
  uint32_t begin = (uint32_t)(found - k->source->text);
  return (pl_span){k->source, begin, begin + (uint32_t)strlen(part)};
}

static inline pl_unit unit_of(kit* k, const char* text) {
  pl_unit u = {0};
  assert_true(pl_unit_parse(k->m->pool, text, strlen(text), &u, NULL, NULL, NULL));
  return u;
}

// A number, with unit or without (NULL).
static inline pl_expr num(kit* k, const char* decimal, const char* unit) {
  pl_expr e = pl_number_from_text(k->m->pool, decimal, strlen(decimal));
  return unit ? pl_mul(k->m->pool, e, unit_of(k, unit).factor) : e;
}

static inline pl_symbol name_symbol(kit* k, const char* name, const char* ascii, pl_role role,
                                    const char* unit) {
  pl_symbol_info info = {.name = name,
                         .ascii = ascii,
                         .role = role,
                         .class = role == PL_R_COORD ? PL_C_COORD : PL_C_OTHER,
                         .dimension = pl_dimension_one()};
  if (unit) {
    info.dimension = unit_of(k, unit).dimension;
    info.dimension_known = true;
  }
  return pl_symbol_make(k->m->pool, &info);
}

static inline pl_expr param(kit* k, const char* name, const char* value, const char* unit,
                            const char* place) {
  pl_symbol s = name_symbol(k, name, name, PL_R_PARAM, unit);
  pl_param p = {.symbol = s,
                .value = value ? num(k, value, unit) : pl_poison(),
                .has_unit = unit != NULL,
                .unit_text = unit,
                .span = at(k, place)};
  pl_push(k->arena, k->m->params, p);
  return pl_sym(k->m->pool, s);
}

static inline pl_expr coord(kit* k, const char* name, const char* unit, const char* place) {
  pl_symbol s = name_symbol(k, name, name, PL_R_COORD, unit);
  pl_push(k->arena, k->m->coords,
          (pl_coord){.symbol = s, .has_unit = unit != NULL, .span = at(k, place)});
  return pl_sym(k->m->pool, s);
}

static inline pl_symbol family(kit* k, const char* name, pl_expr lo, pl_expr hi, const char* unit,
                               const char* place) {
  pl_symbol s = name_symbol(k, name, name, PL_R_ARRAY, unit);
  pl_push(
      k->arena, k->m->coords,
      (pl_coord){.symbol = s, .lo = lo, .hi = hi, .has_unit = unit != NULL, .span = at(k, place)});
  return s;
}

static inline pl_expr let_be(kit* k, const char* name, pl_expr value, const char* place) {
  pl_symbol s = name_symbol(k, name, name, PL_R_LOCAL, NULL);
  pl_push(k->arena, k->m->lets,
          (pl_let){.symbol = s, .value = value, .inserted = true, .span = at(k, place)});
  return value;
}

// An abbreviation of given quantities that stays as a name.
static inline pl_expr let_stay(kit* k, const char* name, pl_expr value, const char* place) {
  pl_symbol s = name_symbol(k, name, name, PL_R_PARAM, NULL);
  pl_push(k->arena, k->m->lets, (pl_let){.symbol = s, .value = value, .span = at(k, place)});
  return pl_sym(k->m->pool, s);
}

static inline pl_block* loop(kit* k, const char* index, pl_expr lo, pl_expr hi, pl_block* outer,
                             const char* place) {
  pl_block* b = PL_NEW(k->arena, pl_block);
  *b = (pl_block){outer,       name_symbol(k, index, index, PL_R_INDEX, NULL), lo, hi, pl_poison(),
                  at(k, place)};
  pl_push(k->arena, k->m->blocks, b);
  return b;
}

static inline pl_name named(const char* text) { return (pl_name){text, text, pl_poison(), false}; }
static inline pl_name indexed(const char* text, pl_expr index) {
  return (pl_name){text, text, index, false};
}

static inline pl_point point2(pl_expr x, pl_expr y) { return (pl_point){.n = 2, .at = {x, y}}; }
static inline pl_point point3(pl_expr x, pl_expr y, pl_expr z) {
  return (pl_point){.n = 3, .at = {x, y, z}};
}

static inline void mass(kit* k, const char* label, pl_expr m, pl_point p, const char* place) {
  pl_name n = label ? named(label) : (pl_name){"m", "m", pl_poison(), true};
  pl_push(k->arena, k->m->masses,
          (pl_mass){.name = n, .mass = m, .point = p, .span = at(k, place)});
}

static inline pl_symbol constraint(kit* k, pl_name n, pl_expr left, pl_relation rel, pl_expr right,
                                   pl_block* b, const char* place) {
  const char* ascii = pl_format(k->arena, "lambda_%s", n.text);
  pl_symbol lambda = name_symbol(k, ascii, ascii, PL_R_MULTIPLIER, NULL);
  pl_push(k->arena, k->m->constraints,
          (pl_constraint){.name = n,
                          .left = left,
                          .right = right,
                          .g = pl_sub(k->m->pool, left, right),
                          .relation = rel,
                          .lambda = lambda,
                          .block = b,
                          .span = at(k, place)});
  return lambda;
}

static inline void gravity(kit* k, pl_expr g, int axis, int sign, const char* place) {
  pl_push(k->arena, k->m->gravities, (pl_gravity){g, axis, sign, at(k, place)});
}

static inline void init(kit* k, pl_expr target, pl_expr value, const char* place) {
  pl_push(k->arena, k->m->inits, (pl_init){.target = target, .value = value, .span = at(k, place)});
}

static inline void load(kit* k, pl_load_kind kind, pl_expr value, const char* place) {
  pl_push(k->arena, k->m->loads,
          (pl_load){.kind = kind,
                    .name = {"1", "1", pl_poison(), true},
                    .value = value,
                    .span = at(k, place)});
}

static inline pl_expr dot(kit* k, pl_expr x) {
  return pl_sym(k->m->pool, pl_symbol_dot(k->m->pool, pl_symbol_of(k->m->pool, x)));
}

// How often a code was reported; the first message of it in *first.
static inline int told(kit* k, pl_code code, const pl_diagnostic** first) {
  int n = 0;
  for (int i = 0; i < k->diagnostics.list.n; i++) {
    if (k->diagnostics.list.at[i].code != code) continue;
    if (n++ == 0 && first) *first = &k->diagnostics.list.at[i];
  }
  return n;
}

static inline const char* printed(kit* k, const pl_diagnostic* d) {
  pl_text t = pl_text_make(k->arena);
  pl_diagnostic_print(&t, d, (pl_print_style){PL_ENGLISH, false, false});
  return pl_text_string(&t);
}

// All errors, for a failing test to show.
static inline void show(kit* k) {
  for (int i = 0; i < k->diagnostics.list.n; i++)
    print_message("%s", printed(k, &k->diagnostics.list.at[i]));
}

static inline void check_is_clean(kit* k) {
  pleuel_status s = pl_model_check(&k->job, k->m);
  if (s != PLEUEL_OK) show(k);
  assert_int_equal(s, PLEUEL_OK);
  assert_int_equal(k->diagnostics.n_errors, 0);
}

// The check finds exactly one error, of this code.
static inline const pl_diagnostic* check_tells(kit* k, pl_code code) {
  pleuel_status s = pl_model_check(&k->job, k->m);
  const pl_diagnostic* d = NULL;
  if (told(k, code, &d) != 1) show(k);
  assert_int_equal(told(k, code, NULL), 1);
  if (pl_code_severity(code) == PL_ERROR) {
    if (k->diagnostics.n_errors != 1) show(k);
    assert_int_equal(s, PLEUEL_MODEL_ERROR);
    assert_int_equal(k->diagnostics.n_errors, 1);
  }
  assert_non_null(d->sentence[0]);
  assert_non_null(d->sentence[1]);
  return d;
}

static inline void has_unit(kit* k, pl_expr e, const char* unit) {
  pl_dimension d;
  assert_true(pl_model_dimension(k->m, e, &d));
  const char* text = pl_dimension_unit(k->arena, d, true);
  assert_string_equal(text, unit);
}

#endif
