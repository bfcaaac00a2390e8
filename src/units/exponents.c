// Small exact fractions and vectors of seven of them: the exponents of a dimension while it is
// being worked out. pl_dimension keeps its exponents in bytes; here there is room for what a long
// chain of products may need. An overflow gives a fraction with denominator 0, which spreads;
// whoever reads the result looks once.
#include "units/units.h"

static int64_t greatest_common_divisor(int64_t a, int64_t b) {
  if (a < 0) a = -a;
  if (b < 0) b = -b;
  while (b) {
    int64_t r = a % b;
    a = b;
    b = r;
  }
  return a;
}

static const pl_fraction undefined = {0, 0};
static const int64_t fraction_limit = (int64_t)1 << 62;  // beyond it a sign change could overflow

bool pl_fraction_valid(pl_fraction a) { return a.den > 0; }

pl_fraction pl_fraction_make(int64_t num, int64_t den) {
  if (den == 0 || num > fraction_limit || num < -fraction_limit || den > fraction_limit
      || den < -fraction_limit) {
    return undefined;
  }
  if (den < 0) {
    num = -num;
    den = -den;
  }
  int64_t d = greatest_common_divisor(num, den);
  return (pl_fraction){num / d, den / d};
}

pl_fraction pl_fraction_add(pl_fraction a, pl_fraction b) {
  if (!pl_fraction_valid(a) || !pl_fraction_valid(b)) return undefined;
  int64_t x, y, num, den;
  if (__builtin_mul_overflow(a.num, b.den, &x) || __builtin_mul_overflow(b.num, a.den, &y))
    return undefined;
  if (__builtin_add_overflow(x, y, &num) || __builtin_mul_overflow(a.den, b.den, &den))
    return undefined;
  return pl_fraction_make(num, den);
}

pl_fraction pl_fraction_mul(pl_fraction a, pl_fraction b) {
  if (!pl_fraction_valid(a) || !pl_fraction_valid(b)) return undefined;
  int64_t num, den;
  if (__builtin_mul_overflow(a.num, b.num, &num) || __builtin_mul_overflow(a.den, b.den, &den))
    return undefined;
  return pl_fraction_make(num, den);
}

pl_fraction pl_fraction_div(pl_fraction a, pl_fraction b) {
  if (!pl_fraction_valid(a) || !pl_fraction_valid(b) || b.num == 0) return undefined;
  return pl_fraction_mul(a, pl_fraction_make(b.den, b.num));
}

pl_exponents pl_exponents_zero(void) {
  pl_exponents d;
  for (int i = 0; i < PL_N_BASE_UNITS; i++) d.e[i] = (pl_fraction){0, 1};
  return d;
}

// a + f b: the exponents of A * B^f
pl_exponents pl_exponents_add(pl_exponents a, pl_fraction f, pl_exponents b) {
  for (int i = 0; i < PL_N_BASE_UNITS; i++)
    a.e[i] = pl_fraction_add(a.e[i], pl_fraction_mul(f, b.e[i]));
  return a;
}

bool pl_exponents_are_zero(pl_exponents a) {
  for (int i = 0; i < PL_N_BASE_UNITS; i++) {
    if (a.e[i].num != 0 || a.e[i].den == 0) return false;
  }
  return true;
}

pl_exponents pl_exponents_of(pl_dimension d) {
  pl_exponents a;
  for (int i = 0; i < PL_N_BASE_UNITS; i++) a.e[i] = pl_fraction_make(d.num[i], d.den[i]);
  return a;
}

bool pl_exponents_get_dimension(pl_exponents a, pl_dimension* out) {
  for (int i = 0; i < PL_N_BASE_UNITS; i++) {
    if (a.e[i].den <= 0 || a.e[i].den > 100 || a.e[i].num > 100 || a.e[i].num < -100) return false;
    out->num[i] = (int8_t)a.e[i].num;
    out->den[i] = (int8_t)a.e[i].den;
  }
  return true;
}
