// Programs on numbers wider than a double.  This file is compiled once for each type: PL_REAL_LONG is the 80-bit type of
// x86 processors, PL_REAL_QUAD has 113 bits, from the C library, libquadmath, or as long double where that is one.
//
// FMA is a product and a sum that are rounded each: an exact one is hundreds of times slower here.  What a program keeps in eight
// lanes for the sake of vector registers is computed in those lanes only that hold something.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "jit/jit.h"

// ---------------------------------------------------------------------------------------------- the type
#if defined(PL_REAL_LONG) || PL_QUAD == 3
typedef long double real;
#define FUNCTION(name) name##l
static int print(char* out, size_t n, int digits, real x) { return snprintf(out, n, "%.*Lg", digits, x); }
static real parse(const char* text) { return strtold(text, NULL); }
#else
typedef __float128 real;
#if PL_QUAD == 1
// Of the C library.  Its headers show them only to some compilers, so they are declared here.
#define FUNCTION(name) name##f128
#define DECLARE(name) extern real FUNCTION(name)(real);
#define DECLARE_2(name) extern real FUNCTION(name)(real, real);
extern int strfromf128(char*, size_t, const char*, real);
extern real strtof128(const char*, char**);
static int print(char* out, size_t n, int digits, real x) {
  char format[16];
  snprintf(format, sizeof format, "%%.%dg", digits);
  return strfromf128(out, n, format, x);
}
static real parse(const char* text) { return strtof128(text, NULL); }
#else
#define FUNCTION(name) name##q
#define DECLARE(name) extern real FUNCTION(name)(real);
#define DECLARE_2(name) extern real FUNCTION(name)(real, real);
extern int quadmath_snprintf(char*, size_t, const char*, ...);
extern real strtoflt128(const char*, char**);
static int print(char* out, size_t n, int digits, real x) { return quadmath_snprintf(out, n, "%.*Qg", digits, x); }
static real parse(const char* text) { return strtoflt128(text, NULL); }
#endif
#define DECLARE_CASE_1(name) DECLARE(name)
#define DECLARE_CASE_2(name) DECLARE_2(name)
#define DECLARE_CASE(name, reads) DECLARE_CASE_##reads(name)
PL_PROG_FUNCTIONS(DECLARE_CASE)
DECLARE(sqrt)
DECLARE(fabs)
extern real FUNCTION(fma)(real, real, real);
#endif

#define INLINE static inline __attribute__((always_inline))
#define LANES for (int l = 0; l < width; l++)

// ---------------------------------------------------------------------------------------------- sums
INLINE void add_row(real* s, const real* a, const real* b, int ja, int jb, bool weighted, int stride, int lanes) {
  a += ja * stride;
  b += jb * stride;
  for (int l = 0; l < lanes; l++) s[l] += weighted ? (real)ja * a[l] * b[l] : a[l] * b[l];
}

static void sum(const pl_prog* c, const pl_prog_sum* x, real* m, int K, int stride) {
  real s[8] = {0};
  int lanes = x->lanes > 0 ? x->lanes : stride;
  const pl_prog_pair* pairs = c->pairs.at + x->first;
  if (K >= 2 && K % 2 == 0)
    for (int p = 0; p < x->n; p++) add_row(s, m + pairs[p].a, m + pairs[p].b, K / 2, K / 2, x->weighted, stride, lanes);
  for (int j = (K - 1) / 2; j >= 1; j--)
    for (int p = 0; p < x->n; p++) {
      add_row(s, m + pairs[p].a, m + pairs[p].b, j, K - j, x->weighted, stride, lanes);
      add_row(s, m + pairs[p].a, m + pairs[p].b, K - j, j, x->weighted, stride, lanes);
    }
  for (int l = 0; l < lanes; l++) {
    if (x->scale >= 0) s[l] = s[l] * m[x->scale + K * stride + l] + s[l] * m[x->rest + K * stride + l];
    m[x->to + l] = s[l];
  }
}

static void block_sums(const pl_prog* c, const pl_prog_block* b, real* m, int k) {
  for (int i = b->first; i < b->first + b->n; i++) sum(c, &c->sums.at[i], m, k + b->shift, b->width);
}

static void product(const pl_prog_product* p, real* m) {
  enum { width = 8 };
  for (int block = 0; block < p->blocks; block++)
    LANES {
      real part = 0;
      for (int j = 0; j < p->n; j++) part += m[p->matrix + (j * p->blocks + block) * width + l] * m[p->vector + j];
      m[p->to + block * width + l] = part;
    }
}

// ---------------------------------------------------------------------------------------------- functions
static real call1(int fn, real x) {
  switch (fn) {
#define CASE_1(name) \
  case PL_FN_##name: return FUNCTION(name)(x);
#define CASE_2(name)
#define CASE(name, reads) CASE_##reads(name)
    PL_PROG_FUNCTIONS(CASE)
#undef CASE_1
#undef CASE_2
  }
  return (real)NAN;
}

static real call2(int fn, real x, real y) {
  switch (fn) {
#define CASE_1(name)
#define CASE_2(name) \
  case PL_FN_##name: return FUNCTION(name)(x, y);
    PL_PROG_FUNCTIONS(CASE)
  }
  return (real)NAN;
}

// ---------------------------------------------------------------------------------------------- lines
INLINE void run(const pl_prog* code, real* m, int k, int width) {
  real* r = m + code->spill;
  for (int i = 0; i < code->lines.n; i++) {
    const pl_prog_line* x = &code->lines.at[i];
    real* d = r + x->d * width;
    const real *a = r + x->a * width, *b = r + x->b * width, *c = r + x->c * width, *e = r + x->e * width;
    real* at = m + x->at + (long)x->by * k;
    switch ((pl_prog_op)x->op) {
      case PL_PROG_LOAD: LANES d[l] = at[l]; break;
      case PL_PROG_SPREAD: LANES d[l] = *at; break;
      case PL_PROG_STORE: LANES at[l] = a[l]; break;
      case PL_PROG_NUMBER: LANES d[l] = x->value; break;
      case PL_PROG_ORDER: LANES d[l] = k + x->at; break;
      case PL_PROG_ADD: LANES d[l] = a[l] + b[l]; break;
      case PL_PROG_SUB: LANES d[l] = a[l] - b[l]; break;
      case PL_PROG_MUL: LANES d[l] = a[l] * b[l]; break;
      case PL_PROG_DIV: LANES d[l] = a[l] / b[l]; break;
      case PL_PROG_FMA: LANES d[l] = a[l] * b[l] + c[l]; break;
      case PL_PROG_FNMA: LANES d[l] = c[l] - a[l] * b[l]; break;
      case PL_PROG_NEG: LANES d[l] = -a[l]; break;
      case PL_PROG_ABS: LANES d[l] = FUNCTION(fabs)(a[l]); break;
      case PL_PROG_SQRT: LANES d[l] = FUNCTION(sqrt)(a[l]); break;
      case PL_PROG_IF_MORE: LANES d[l] = a[l] > 0 ? b[l] : c[l]; break;
      case PL_PROG_IF_LESS: LANES d[l] = a[l] < 0 ? b[l] : c[l]; break;
      case PL_PROG_IF_LE: LANES d[l] = a[l] <= b[l] ? c[l] : e[l]; break;
      case PL_PROG_CALL1: LANES d[l] = call1(x->fn, a[l]); break;
      case PL_PROG_CALL2: LANES d[l] = call2(x->fn, a[l], b[l]); break;
      case PL_PROG_SUMS: block_sums(code, &code->blocks.at[x->at], m, k); break;
      case PL_PROG_PRODUCT: product(&code->products.at[x->at], m); break;
      case PL_N_PROG_OPS: break;
    }
  }
}

static void interpret(const pl_prog* c, void* memory, int from, int to) {
  for (int k = from; k < to; k++) {
    if (c->width == 8) run(c, memory, k, 8);
    else run(c, memory, k, 1);
  }
}

// ---------------------------------------------------------------------------------------------- numbers in and out
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

// ---------------------------------------------------------------------------------------------- text
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
const pl_real pl_real_of_long = {
    .name = "long", .size = sizeof(real), .bits = 64, .epsilon = 0x1p-63,
#else
const pl_real pl_real_of_quad = {
    .name = "quad", .size = sizeof(real), .bits = 113, .epsilon = 0x1p-112,
#endif
    .interpret = interpret, .read = read_numbers, .write = write_numbers, .get = get, .set = set, .move = move, .add = add,
    .round_to_long = round_numbers, .ratios = ratios, .text = text};
