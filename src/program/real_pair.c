// Programs on numbers that are a sum of two doubles, 106 bits: several times faster than 128-bit
// numbers in software, where the processor has fused multiply-add; it is compiled a second time for
// those that have not, with the same bits.
//
// Arithmetic after [Dekker1971] and [JoldesMullerPopescu2017]: errors below 2^-102 of the result.
// Elementary functions are those of 128 bits.
// See theory (17.1), (17.2).
#include <float.h>
#include <math.h>
#include <string.h>

#include "program/program.h"
#include "program/real_quad_impl.h"

typedef struct real {
  double h, l;
} real;

#define INLINE_PAIR static inline __attribute__((always_inline))

// -------------------------------------------------------------------------------------- arithmetic
// a + b, |a| >= |b|
INLINE_PAIR real quick(double a, double b) {
  double s = a + b;
  return (real){s, b - (s - a)};
}

INLINE_PAIR real two_sum(double a, double b) {
  double s = a + b, t = s - a;
  return (real){s, (a - (s - t)) + (b - t)};
}

INLINE_PAIR real add_pair(real a, real b) {
  real s = two_sum(a.h, b.h), t = two_sum(a.l, b.l);
  s = quick(s.h, s.l + t.h);
  return quick(s.h, s.l + t.l);
}

INLINE_PAIR real negative(real a) { return (real){-a.h, -a.l}; }

INLINE_PAIR real times(real a, real b) {
  double p = a.h * b.h, e = __builtin_fma(a.h, b.h, -p);
  return quick(p, __builtin_fma(a.h, b.l, __builtin_fma(a.l, b.h, e)));
}

INLINE_PAIR real times_double(real a, double b) {
  double p = a.h * b;
  return quick(p, __builtin_fma(a.l, b, __builtin_fma(a.h, b, -p)));
}

static real over(real a, real b) {
  double x = a.h / b.h;
  real rest = add_pair(a, negative(times_double(b, x)));
  double y = rest.h / b.h;
  rest = add_pair(rest, negative(times_double(b, y)));
  real q = quick(x, y);
  return add_pair(q, (real){rest.h / b.h, 0});
}

static real root(real a) {
  if (!(a.h > 0)) return (real){sqrt(a.h), 0};
  double x = sqrt(a.h);
  real square = {x * x, 0};
  square.l = __builtin_fma(x, x, -square.h);
  real rest = add_pair(a, negative(square)), y = quick(x, rest.h / (2 * x));
  rest = add_pair(a, negative(times(y, y)));
  return add_pair(y, (real){rest.h / (2 * x), 0});
}

INLINE_PAIR real of_double(double x) { return (real){x, 0}; }
INLINE_PAIR bool is_more(real a, real b) { return a.h > b.h || (a.h == b.h && a.l > b.l); }
INLINE_PAIR bool is_at_most(real a, real b) { return a.h < b.h || (a.h == b.h && a.l <= b.l); }
INLINE_PAIR real size(real a) { return a.h < 0 ? negative(a) : a; }

// --------------------------------------------------------------------------------------- functions
static __float128 wide(real a) { return (__float128)a.h + a.l; }

static real narrow(__float128 x) {
  double h = (double)x;
  return (real){h, isfinite(h) ? (double)(x - h) : 0};
}

#define PAIR_1(name) \
  static real name##_pair(real x) { return narrow(QUAD(name)(wide(x))); }
#define PAIR_2(name) \
  static real name##_pair(real x, real y) { return narrow(QUAD(name)(wide(x), wide(y))); }
#define PL_LIBRARY(name, n) PAIR_##n(name)
#include "program/library.def"
static real sqrt_pair(real a) { return root(a); }
static real fabs_pair(real a) { return size(a); }

#define FUNCTION(name) name##_pair
#define TO_REAL(x)     of_double(x)
#define ADD(a, b)      add_pair(a, b)
#define SUB(a, b)      add_pair(a, negative(b))
#define MUL(a, b)      times(a, b)
#define DIV(a, b)      over(a, b)
#define NEG(a)         negative(a)
#define MORE(a, b)     is_more(a, b)
#define AT_MOST(a, b)  is_at_most(a, b)
#include "program/real_run_impl.h"

// ------------------------------------------------------------------------------ numbers in and out
static void read_numbers(const void* memory, int at, int n, double* out) {
  const real* m = (const real*)memory + at;
  for (int i = 0; i < n; i++) out[i] = m[i].h;
}

static void write_numbers(void* memory, int at, int n, const double* x) {
  real* m = (real*)memory + at;
  for (int i = 0; i < n; i++) m[i] = of_double(x[i]);
}

static pl_parts get(const void* memory, int at) {
  const real* m = (const real*)memory + at;
  return (pl_parts){{m->h, m->l}};
}

static void set(void* memory, int at, pl_parts x) {
  ((real*)memory)[at] = add_pair(of_double(x.part[0]), two_sum(x.part[1], x.part[2]));
}

static void move(void* memory, int to, int from, int n) {
  memmove((real*)memory + to, (real*)memory + from, (size_t)n * sizeof(real));
}

static void add(void* memory, int to, int from, int n) {
  real* m = memory;
  for (int i = 0; i < n; i++) m[to + i] = add_pair(m[to + i], m[from + i]);
}

static void round_numbers(void* memory, int at, int n) {
  real* m = (real*)memory + at;
  for (int i = 0; i < n; i++) {
    long double x = (long double)m[i].h + (long double)m[i].l;
    m[i].h = (double)x;
    m[i].l = (double)(x - m[i].h);
  }
}

static void ratios(void* memory, int ratio, int rest, int n) {
  real* m = memory;
  for (int i = 1; i < n; i++) {
    m[ratio + i] = over(of_double(1), of_double(i));
    m[rest + i] = of_double(0);
  }
}

static int text(char out[PL_REAL_TEXT], const void* memory, int at, bool negated) {
  __float128 x = wide(((const real*)memory)[at]);
  return print(out, PL_REAL_TEXT, 32, negated ? -x : x);
}

#ifndef PL_REAL_PAIR
#  define PL_REAL_PAIR pl_real_of_pair_plain
#endif
extern const pl_real PL_REAL_PAIR;
const pl_real PL_REAL_PAIR = {.name = "pair",
                              .size = sizeof(real),
                              .bits = 106,
                              .epsilon = 0x1p-104,
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
