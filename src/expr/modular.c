// Arithmetic modulo P = 2^61 - 9265983825153, roots, and the rotations (c, s) with c^2 + s^2 = 1.
//
// The prime is chosen so that residues behave like real numbers where formulas need it:
//   P = 7 mod 8: -1 has no root. Exactly one of the two roots of a square is a square itself; that
//   one is taken. So
//     sqrt(a) sqrt(b) = sqrt(a b), and "is a square" behaves like "is positive" in products:
//     sign(a b) = sign(a) sign(b).
//   P = -1 mod 57600 = 2^8 3^2 5^2: the rotations form a cyclic group of order P + 1, so it has the
//   angles π/n for all
//     n that divide 28800, tenths of a degree among them; and 2, 3 and 5 are squares.
//   The primes up to 31 are squares, and so are the positive ones among the numbers a + b sqrt(d)
//   with d = 2, 3, 5 and
//     |a| <= 6, |b| <= 3, or d = 6, 7, 10 and |a| <= 5, |b| <= 2; so are sqrt(2) + sqrt(3), sqrt(2)
//     + sqrt(5),
//     sqrt(3) + sqrt(5) and 1 + sqrt(2) + sqrt(3). So nested roots such as sqrt(3 + 2 sqrt(2)) = 1
//     + sqrt(2) come out
//     right.
//   3, 5, 7, 11 and 13 do not divide P - 1, so every residue has exactly one root of each of these
//   orders.
// It is the largest prime below 2^61 of this kind; modular_test.c looks at every point.
#include "expr/modular.h"

static const uint64_t prime = PL_MOD_P;

uint64_t pl_mod_add(uint64_t a, uint64_t b) {
  uint64_t s = a + b;
  return s >= prime ? s - prime : s;
}

uint64_t pl_mod_sub(uint64_t a, uint64_t b) { return a >= b ? a - b : a + prime - b; }

// Barrett: the quotient is estimated by a product and is at most 2 too small.
uint64_t pl_mod_mul(uint64_t a, uint64_t b) {
  const uint64_t reciprocal = (uint64_t)(((unsigned __int128)1 << 123) / PL_MOD_P);
  unsigned __int128 x = (unsigned __int128)a * b;
  uint64_t q = (uint64_t)((unsigned __int128)(uint64_t)(x >> 60) * reciprocal >> 63);
  uint64_t r = (uint64_t)x - q * prime;
  if (r >= prime) r -= prime;
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

// --------------------------------------------------------------------------------- rational powers
// x with a x = 1 modulo m, a and m coprime.
static uint64_t inverse_modulo(uint64_t a, uint64_t m) {
  __int128 r0 = m, r1 = a % m, t0 = 0, t1 = 1;
  while (r1 != 0) {
    __int128 q = r0 / r1, r = r0 - q * r1, t = t0 - q * t1;
    r0 = r1;
    r1 = r;
    t0 = t1;
    t1 = t;
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

// The group of order P - 1 loses the primes of den; in the subgroup that is left the division by
// den is unique, and multiplicative. For den = 2 these are the squares.
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

// --------------------------------------------------------------------------------------- rotations
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
  return (pl_rotation){pl_mod_mul(pl_mod_sub(1, square), scale),
                       pl_mod_mul(pl_mod_add(t, t), scale)};
}

// cos(x/2) = sqrt((1 + cos x)/2), sin(x/2) = sin x / (2 cos(x/2)): the half that lies between -90
// and 90 degrees
static pl_rotation half_rotation(pl_rotation a, bool* ok) {
  uint64_t c = pl_mod_sqrt(pl_mod_half(pl_mod_add(1, a.c)), ok);
  if (c == 0) return (pl_rotation){0, 1};  // half of 180 degrees
  return (pl_rotation){c, pl_mod_mul(a.s, pl_mod_inv(pl_mod_add(c, c)))};
}

// num/den times an angle.  An odd den is divided by in the subgroup whose
// order is prime to it, where the quotient is unique; an angle outside has no quotient here.
static pl_rotation odd_ratio(pl_rotation a, int64_t num, int64_t den, bool* ok) {
  // a whole multiple, the usual case, has a short exponent
  if (den == 1)
    return pl_rotation_pow(num < 0 ? (pl_rotation){a.c, pl_mod_sub(0, a.s)} : a,
                           num < 0 ? 0 - (uint64_t)num : (uint64_t)num);
  uint64_t m = PL_MOD_P + 1;
  for (uint64_t g; (g = gcd64(m, (uint64_t)den)) > 1;) m /= g;
  pl_rotation whole = pl_rotation_pow(a, m);
  if (den != 1 && (whole.c != 1 || whole.s != 0)) *ok = false;
  uint64_t n = exponent_modulo(num, m);
  if (den != 1) n = (uint64_t)((unsigned __int128)n * inverse_modulo((uint64_t)den % m, m) % m);
  return pl_rotation_pow(a, n);
}

pl_rotation pl_rotation_ratio(pl_rotation a, int64_t num, int64_t den, bool* ok) {
  while (den % 2 == 0) {
    a = half_rotation(a, ok);
    den /= 2;
  }
  return odd_ratio(a, num, den, ok);
}

// ---------------------------------------------------------------------------- parts of a full turn
// A rotation whose order is exactly q^2, for q = 3 and 5.
static pl_rotation rotation_of_order_square(uint64_t q) {
  for (uint64_t t = 2;; t++) {
    pl_rotation r = pl_rotation_pow(pl_rotation_from_tangent(t), (PL_MOD_P + 1) / (q * q));
    if (pl_rotation_pow(r, q).c != 1) return r;
  }
}

// 1/q^2 of a turn. Which of the rotations of that order it is, is settled by a q-th of a turn,
// whose sine and cosine are roots: c = -1/2, s = sqrt(3)/2 for a third; c = (sqrt(5) - 1)/4, s
// positive for a fifth.
static pl_rotation part_of_turn(uint64_t q, bool* ok) {
  pl_rotation r = rotation_of_order_square(q), a = r;
  uint64_t c = q == 3 ? pl_mod_half(prime - 1)
                      : pl_mod_half(pl_mod_half(pl_mod_sub(pl_mod_sqrt(5, ok), 1)));
  for (uint64_t k = 1; k < q; k++, a = pl_rotation_mul(a, r)) {
    pl_rotation qth = pl_rotation_pow(a, q);
    if (qth.c == c && pl_mod_sign(qth.s) > 0) return a;
  }
  *ok = false;
  return r;
}

// num/den of a half turn.  With den = 2^k n9 n25:  num/(2 den) = A/2^(k+1) + B/9 + C/25 of a turn.
pl_rotation pl_rotation_of_pi(int64_t num, int64_t den, bool* ok) {
  int bits = 0;
  for (; den % 2 == 0; bits++) den /= 2;
  if (bits > 7 || 225 % den != 0) *ok = false;
  if (!*ok) return pl_rotation_none();

  // the whole as a fraction of the denominator 2^(k+1) 225
  uint64_t two = 2ull << bits,
           n = exponent_modulo(num, two * (uint64_t)den) * (uint64_t)(225 / den) % (two * 225);
  pl_rotation small = {PL_MOD_P - 1, 0};  // a half turn, halved k times: 1/2^(k+1) of a turn
  for (int i = 0; i < bits; i++) small = half_rotation(small, ok);
  pl_rotation r = pl_rotation_pow(small, n % two * inverse_modulo(225 % two, two) % two);
  uint64_t ninths = n % 9 * inverse_modulo(two * 25 % 9, 9) % 9;
  uint64_t parts_of_25 = n % 25 * inverse_modulo(two * 9 % 25, 25) % 25;
  if (ninths != 0) r = pl_rotation_mul(r, pl_rotation_pow(part_of_turn(3, ok), ninths));
  if (parts_of_25 != 0) r = pl_rotation_mul(r, pl_rotation_pow(part_of_turn(5, ok), parts_of_25));
  return r;
}
