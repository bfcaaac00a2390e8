// Functions of 128-bit numbers: of the C library, or of libquadmath.
#ifndef PL_REAL_QUAD_IMPL_H
#define PL_REAL_QUAD_IMPL_H

#include <stdio.h>

#include "program/program.h"

#if PL_QUAD == 1
// Of the C library.  Its headers show them only to some compilers, so they are declared here.
#  define QUAD(name) name##f128
extern int strfromf128(char*, size_t, const char*, __float128);
extern __float128 strtof128(const char*, char**);
static inline int print(char* out, size_t n, int digits, __float128 x) {
  char format[16];
  snprintf(format, sizeof format, "%%.%dg", digits);
  return strfromf128(out, n, format, x);
}
static inline __float128 parse(const char* text) { return strtof128(text, NULL); }
#else
#  define QUAD(name) name##q
extern int quadmath_snprintf(char*, size_t, const char*, ...);
extern __float128 strtoflt128(const char*, char**);
static inline int print(char* out, size_t n, int digits, __float128 x) {
  return quadmath_snprintf(out, n, "%.*Qg", digits, x);
}
static inline __float128 parse(const char* text) { return strtoflt128(text, NULL); }
#endif
#define DECLARE(name)       extern __float128 QUAD(name)(__float128);
#define DECLARE_2(name)     extern __float128 QUAD(name)(__float128, __float128);
#define DECLARE_1(name)     DECLARE(name)
#define PL_LIBRARY(name, n) DECLARE_##n(name)
#include "program/library.def"
DECLARE(sqrt)
DECLARE(fabs)
extern __float128 QUAD(fma)(__float128, __float128, __float128);

#endif
