// For the tests of base: cmocka, and an arena that lives as long as one test.
#ifndef PL_BASE_TEST_KIT_H
#define PL_BASE_TEST_KIT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/base.h"

#define PL_TEST(name)                   \
  static void name##_body(pl_arena* a); \
  static void name(void** state) {      \
    pl_arena* a = pl_arena_make(NULL);  \
    name##_body(a);                     \
    pl_arena_free(a);                   \
  }                                     \
  static void name##_body(pl_arena* a)

#endif
