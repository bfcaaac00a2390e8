// For the tests of this folder: a world (arena, pool, tower) and expressions written as text,
// "sqrt(l^2 - r^2*sin(x)^2)". Names that begin with one of x y z u v a b t p are coordinates
// without a sign; all others are positive parameters: m... masses, g gravity, the rest lengths.
#ifndef PL_ALGEBRA_TEST_TEXT_H
#define PL_ALGEBRA_TEST_TEXT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "algebra/algebra.h"

#define PL_TEST(name) static void name(void** state)

typedef struct pl_world {
  pl_arena* arena;
  pl_pool* pool;
  pl_job job;
  pl_tower* tower;
} pl_world;

// facts: texts of differences that are > 0, separated by commas; NULL for none.
pl_world* pl_world_make(const char* facts);
void pl_world_free(pl_world* w);

pl_expr pl_text_expr(pl_world* w, const char* text);
pl_symbol pl_text_symbol(pl_world* w, const char* name);
const char* pl_text_of(pl_world* w, pl_expr e);
const char* pl_text_normal(pl_world* w, const char* text);  // text of the normal form
void pl_assert_zero(pl_world* w, const char* text);
void pl_assert_not_zero(pl_world* w, const char* text);

// A random expression over x, y, m1, m2, l; depth 0 is a leaf.
pl_expr pl_random_expr(pl_world* w, pl_random* r, int depth);

#endif
