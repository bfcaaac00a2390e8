// Arithmetic modulo P = 2^61 - 1, roots, and the rotations (c, s) with c^2 + s^2 = 1.
//
// P = 3 mod 4, so -1 has no root.  Exactly one of the two roots of a square is a square itself; that one is taken.  So
// sqrt(a) sqrt(b) = sqrt(a b), and "is a square" behaves like "is positive" in products: sign(a b) = sign(a) sign(b).
// The rotations form a cyclic group of order P + 1 = 2^61, in which every odd division can be carried out.
#include "expr/modular.h"

static const uint64_t prime = PL_MOD_P;

uint64_t pl_mod_add(uint64_t a, uint64_t b) {
  uint64_t s = a + b;
  return s >= prime ? s - prime : s;
}

uint64_t pl_mod_sub(uint64_t a, uint64_t b) { return a >= b ? a - b : a + prime - b; }

uint64_t pl_mod_mul(uint64_t a, uint64_t b) {
  unsigned __int128 x = (unsigned __int128)a * b;
  uint64_t r = ((uint64_t)x & prime) + (uint64_t)(x >> 61);
  return r >= prime ? r - prime : r;
}

uint64_t pl_mod_pow(uint64_t a, uint64_t n) {
  uint64_t r = 1;
  for (; n > 0; n >>= 1, a = pl_mod_mul(a, a)) {
    if (n & 1) r = pl_mod_mul(r, a);
  }
  return r;
}

uint64_t pl_mod_inv(uint64_t a) { return pl_mod_pow(a, prime - 2); }

uint64_t pl_mod_half(uint64_t a) { return a & 1 ? (a >> 1) + (prime >> 1) + 1 : a >> 1; }

int pl_mod_sign(uint64_t a) {
  if (a == 0) return 0;
  return pl_mod_pow(a, (prime - 1) / 2) == 1 ? 1 : -1;
}

uint64_t pl_mod_sqrt(uint64_t a, bool* ok) {
  uint64_t r = pl_mod_pow(a, (prime + 1) / 4);
  if (pl_mod_mul(r, r) != a) *ok = false;
  return r;
}

// ---------------------------------------------------------------------------------------------- rational powers
// x with a x = 1 modulo m, a and m coprime.
static uint64_t inverse_modulo(uint64_t a, uint64_t m) {
  __int128 r0 = m, r1 = a % m, t0 = 0, t1 = 1;
  while (r1 != 0) {
    __int128 q = r0 / r1, r = r0 - q * r1, t = t0 - q * t1;
    r0 = r1, r1 = r;
    t0 = t1, t1 = t;
  }
  return (uint64_t)(t0 < 0 ? t0 + m : t0);
}

static uint64_t gcd64(uint64_t a, uint64_t b) {
  while (b != 0) {
    uint64_t r = a % b;
    a = b;
    b = r;
  }
  return a;
}

static uint64_t exponent_modulo(int64_t n, uint64_t m) {
  uint64_t r = (n < 0 ? 0 - (uint64_t)n : (uint64_t)n) % m;
  return n < 0 && r != 0 ? m - r : r;
}

// The group of order P - 1 loses the primes of den; in the subgroup that is left the division by den is unique, and
// multiplicative.  For den = 2 these are the squares.
uint64_t pl_mod_pow_ratio(uint64_t a, int64_t num, int64_t den, bool* ok) {
  if (a == 0) {
    if (num <= 0) *ok = false;
    return 0;
  }
  uint64_t m = prime - 1;
  for (uint64_t g; (g = gcd64(m, (uint64_t)den)) > 1;) m /= g;
  if (den != 1 && pl_mod_pow(a, m) != 1) *ok = false;
  uint64_t n = exponent_modulo(num, m);
  if (den != 1) n = (uint64_t)((unsigned __int128)n * inverse_modulo((uint64_t)den % m, m) % m);
  return pl_mod_pow(a, n);
}

// ---------------------------------------------------------------------------------------------- rotations
pl_rotation pl_rotation_none(void) { return (pl_rotation){1, 0}; }

pl_rotation pl_rotation_mul(pl_rotation a, pl_rotation b) {
  return (pl_rotation){pl_mod_sub(pl_mod_mul(a.c, b.c), pl_mod_mul(a.s, b.s)),
                       pl_mod_add(pl_mod_mul(a.s, b.c), pl_mod_mul(a.c, b.s))};
}

pl_rotation pl_rotation_pow(pl_rotation a, uint64_t n) {
  pl_rotation r = pl_rotation_none();
  for (; n > 0; n >>= 1, a = pl_rotation_mul(a, a)) {
    if (n & 1) r = pl_rotation_mul(r, a);
  }
  return r;
}

// c = (1 - t^2)/(1 + t^2), s = 2t/(1 + t^2); 1 + t^2 is never 0
pl_rotation pl_rotation_from_tangent(uint64_t t) {
  uint64_t square = pl_mod_mul(t, t), scale = pl_mod_inv(pl_mod_add(1, square));
  return (pl_rotation){pl_mod_mul(pl_mod_sub(1, square), scale), pl_mod_mul(pl_mod_add(t, t), scale)};
}

// cos(x/2) = sqrt((1 + cos x)/2), sin(x/2) = sin x / (2 cos(x/2)): the half that lies between -90 and 90 degrees
pl_rotation pl_rotation_half(pl_rotation a, bool* ok) {
  uint64_t c = pl_mod_sqrt(pl_mod_half(pl_mod_add(1, a.c)), ok);
  if (c == 0) return (pl_rotation){0, 1};   // half of 180 degrees
  return (pl_rotation){c, pl_mod_mul(a.s, pl_mod_inv(pl_mod_add(c, c)))};
}

pl_rotation pl_rotation_ratio(pl_rotation a, int64_t num, int64_t den, bool* ok) {
  while (den % 2 == 0) {
    a = pl_rotation_half(a, ok);
    den /= 2;
  }
  const uint64_t order = 1ull << 61;
  uint64_t odd = den == 1 ? 1 : inverse_modulo((uint64_t)den, order);
  return pl_rotation_pow(a, (exponent_modulo(num, order) * odd) & (order - 1));
}
