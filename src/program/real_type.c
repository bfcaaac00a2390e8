// Programs on numbers wider than a double. This file is compiled once for each type: PL_REAL_LONG
// is the 80-bit type of x86 processors, PL_REAL_QUAD has 113 bits, from the C library, libquadmath,
// or as long double where that is one.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "program/program.h"

// ---------------------------------------------------------------------------------------- the type
#if defined(PL_REAL_LONG) || PL_QUAD == 3
typedef long double real;
#  define FUNCTION(name) name##l
static int print(char* out, size_t n, int digits, real x) {
  return snprintf(out, n, "%.*Lg", digits, x);
}
static real parse(const char* text) { return strtold(text, NULL); }
#else
typedef __float128 real;
#  include "program/real_quad_impl.h"
#  define FUNCTION(name) QUAD(name)
#endif

#define TO_REAL(x)    ((real)(x))
#define ADD(a, b)     ((a) + (b))
#define SUB(a, b)     ((a) - (b))
#define MUL(a, b)     ((a) * (b))
#define DIV(a, b)     ((a) / (b))
#define NEG(a)        (-(a))
#define MORE(a, b)    ((a) > (b))
#define AT_MOST(a, b) ((a) <= (b))
#include "program/real_run_impl.h"

// ------------------------------------------------------------------------------ numbers in and out
static void read_numbers(const void* memory, int at, int n, double* out) {
  const real* m = (const real*)memory + at;
  for (int i = 0; i < n; i++) out[i] = (double)m[i];
}

static void write_numbers(void* memory, int at, int n, const double* x) {
  real* m = (real*)memory + at;
  for (int i = 0; i < n; i++) m[i] = x[i];
}

static pl_parts get(const void* memory, int at) {
  real x = ((const real*)memory)[at];
  pl_parts p = {{(double)x}};
  for (int i = 1; i < 3 && isfinite(p.part[i - 1]); i++) {
    x -= p.part[i - 1];
    p.part[i] = (double)x;
  }
  return p;
}

// From the smallest part up: one rounding that counts.
static void set(void* memory, int at, pl_parts x) {
  ((real*)memory)[at] = (real)x.part[0] + ((real)x.part[1] + (real)x.part[2]);
}

static void move(void* memory, int to, int from, int n) {
  memmove((real*)memory + to, (real*)memory + from, (size_t)n * sizeof(real));
}

static void add(void* memory, int to, int from, int n) {
  real* m = memory;
  for (int i = 0; i < n; i++) m[to + i] += m[from + i];
}

// To the digits of the 80-bit type.
static void round_numbers(void* memory, int at, int n) {
  real* m = (real*)memory + at;
  for (int i = 0; i < n; i++) m[i] = (long double)m[i];
}

static void ratios(void* memory, int ratio, int rest, int n) {
  real* m = memory;
  for (int i = 1; i < n; i++) {
    m[ratio + i] = 1 / (real)i;
    m[rest + i] = FUNCTION(fma)(-(real)i, m[ratio + i], 1) / i;
  }
}

// -------------------------------------------------------------------------------------------- text
static int text(char out[PL_REAL_TEXT], const void* memory, int at, bool negative) {
  static const int most =
#if defined(PL_REAL_LONG)
      21;
#else
      36;
#endif
  real x = negative ? -((const real*)memory)[at] : ((const real*)memory)[at];
  if (x != x) return snprintf(out, PL_REAL_TEXT, "nan");
  if (x - x != 0) return snprintf(out, PL_REAL_TEXT, "%s", x > 0 ? "inf" : "-inf");
  if (x == 0) return snprintf(out, PL_REAL_TEXT, "0");
  char shorter[PL_REAL_TEXT];
  int n = print(out, PL_REAL_TEXT, most, x);
  for (int digits = most - 1; digits >= most - 3; digits--) {
    int m = print(shorter, sizeof shorter, digits, x);
    if (parse(shorter) != x) break;
    memcpy(out, shorter, sizeof shorter);
    n = m;
  }
  return n;
}

#if defined(PL_REAL_LONG)
const pl_real pl_real_of_long = {.name = "long",
                                 .size = sizeof(real),
                                 .bits = 64,
                                 .epsilon = 0x1p-63,
#else
const pl_real pl_real_of_quad = {.name = "quad",
                                 .size = sizeof(real),
                                 .bits = 113,
                                 .epsilon = 0x1p-112,
#endif
                                 .interpret = interpret,
                                 .read = read_numbers,
                                 .write = write_numbers,
                                 .get = get,
                                 .set = set,
                                 .move = move,
                                 .add = add,
                                 .round_to_long = round_numbers,
                                 .ratios = ratios,
                                 .text = text};
