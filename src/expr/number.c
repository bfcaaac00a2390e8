// Exact rationals. Small ones (numerator and denominator fit 64 bits) are done by hand; larger ones
// by GMP.
//
// GMP takes its own memory and must give it back before the arena may unwind. So each large
// operation has three parts: reserve room for the largest possible result, compute with GMP
// temporaries, copy the limbs and clear the temporaries. Only then the node is made. Needs GMP.
#include "expr/expr_impl.h"

#include <assert.h>
#include <limits.h>
#include <math.h>
#include <string.h>

// ----------------------------------------------------------------------------------- small numbers
static uint64_t magnitude(int64_t x) { return x < 0 ? 0 - (uint64_t)x : (uint64_t)x; }

static unsigned __int128 gcd128(unsigned __int128 a, unsigned __int128 b) {
  while (b != 0) {
    unsigned __int128 r = a % b;
    a = b;
    b = r;
  }
  return a;
}

static uint64_t gcd64(uint64_t a, uint64_t b) {
  while (b != 0) {
    uint64_t r = a % b;
    a = b;
    b = r;
  }
  return a;
}

static bool fits(__int128 x) { return x > INT64_MIN && x <= INT64_MAX; }  // so that -x fits too

// num / den in lowest terms, if both fit.
static bool make_small(pl_pool* p, __int128 num, __int128 den, pl_expr* out) {
  if (den < 0) {
    num = -num;
    den = -den;
  }
  unsigned __int128 size = num < 0 ? -(unsigned __int128)num : (unsigned __int128)num;
  if (den != 1) {
    unsigned __int128 g = size <= UINT64_MAX && den <= (__int128)UINT64_MAX
                              ? gcd64((uint64_t)size, (uint64_t)den)
                              : gcd128(size, (unsigned __int128)den);
    if (g > 1) {
      num /= (__int128)g;
      den /= (__int128)g;
    }
  }
  if (!fits(num) || !fits(den)) return false;
  *out = pl_number_make(p, &(pl_number){.num = (int64_t)num, .den = (int64_t)den});
  return true;
}

// ----------------------------------------------------------------------------------- large numbers
typedef struct large {  // a rational on loan from a node or from its own two limbs
  mpz_t num, den;
  mp_limb_t own[2];
} large;

static void borrow(large* to, const pl_number* x) {
  if (x->limbs != NULL) {
    mpz_roinit_n(to->num, x->limbs, x->n_num);
    mpz_roinit_n(to->den, x->limbs + (x->n_num < 0 ? -x->n_num : x->n_num), x->n_den);
    return;
  }
  to->own[0] = magnitude(x->num);
  to->own[1] = magnitude(x->den);
  mpz_roinit_n(to->num, &to->own[0], x->num == 0 ? 0 : x->num < 0 ? -1 : 1);
  mpz_roinit_n(to->den, &to->own[1], 1);
}

static size_t limbs_of(const pl_number* x) {
  if (x->limbs == NULL) return 2;
  return (size_t)(x->n_num < 0 ? -x->n_num : x->n_num) + (size_t)x->n_den;
}

// Room for a result that is computed while GMP holds memory.
typedef struct room {
  mp_limb_t* limbs;
  size_t cap;
} room;

static room room_take(pl_pool* p, size_t limbs) {
  return (room){pl_scratch_take(p, limbs * sizeof(mp_limb_t)), limbs};
}

static void room_give(pl_pool* p, room r) {
  pl_scratch_give(p, r.limbs, r.cap * sizeof(mp_limb_t));
}

static bool mpz_small(const mpz_t z, int64_t* out) {
  if (!mpz_fits_slong_p(z) || mpz_get_si(z) == LONG_MIN) return false;
  *out = mpz_get_si(z);
  return true;
}

// The number num/den (canonical) as a pl_number whose limbs lie in the room.  Clears num and den.
static pl_number settle(room r, mpz_t num, mpz_t den) {
  pl_number x = {0};
  if (!mpz_small(num, &x.num) || !mpz_small(den, &x.den)) {
    size_t n = mpz_size(num), m = mpz_size(den);
    assert(n + m <= r.cap);
    mpn_copyi(r.limbs, mpz_limbs_read(num), (mp_size_t)n);
    mpn_copyi(r.limbs + n, mpz_limbs_read(den), (mp_size_t)m);
    x = (pl_number){.limbs = r.limbs,
                    .n_num = (int32_t)(mpz_sgn(num) < 0 ? -(long)n : (long)n),
                    .n_den = (int32_t)m};
  }
  mpz_clear(num);
  mpz_clear(den);
  return x;
}

static void reduce(mpz_t num, mpz_t den) {
  mpz_t g;
  mpz_init(g);
  mpz_gcd(g, num, den);
  if (mpz_cmp_ui(g, 1) != 0) {
    mpz_divexact(num, num, g);
    mpz_divexact(den, den, g);
  }
  mpz_clear(g);
  if (mpz_sgn(den) < 0) {
    mpz_neg(num, num);
    mpz_neg(den, den);
  }
}

typedef void (*large_op)(mpz_t num, mpz_t den, const large* a, const large* b);

static void large_add(mpz_t num, mpz_t den, const large* a, const large* b) {
  mpz_mul(num, a->num, b->den);
  mpz_addmul(num, b->num, a->den);
  mpz_mul(den, a->den, b->den);
}

static void large_mul(mpz_t num, mpz_t den, const large* a, const large* b) {
  mpz_mul(num, a->num, b->num);
  mpz_mul(den, a->den, b->den);
}

static pl_expr large_compute(pl_pool* p, large_op op, pl_expr a, pl_expr b) {
  const pl_number *x = pl_number_of(p, a), *y = pl_number_of(p, b);
  size_t bound = 2 * (limbs_of(x) + limbs_of(y)) + 4;
  if (bound > PL_NUMBER_LIMBS) return pl_poison();

  room r = room_take(p, bound);
  large u, v;
  borrow(&u, x);
  borrow(&v, y);
  mpz_t num, den;
  mpz_init(num);
  mpz_init(den);
  op(num, den, &u, &v);
  reduce(num, den);
  pl_number result = settle(r, num, den);
  pl_expr e = pl_number_make(p, &result);
  room_give(p, r);
  return e;
}

// -------------------------------------------------------------------------------------- arithmetic
pl_expr pl_int(pl_pool* p, long n) {
  pl_expr e;
  if (make_small(p, n, 1, &e)) return e;
  // LONG_MIN, whose negative is not small
  return pl_number_mul(p, pl_int(p, n / 2), pl_int(p, 2));
}

pl_expr pl_ratio(pl_pool* p, long num, long den) {
  if (den == 0) return pl_poison();
  pl_expr e;
  if (make_small(p, num, den, &e)) return e;
  return pl_number_mul(p, pl_int(p, num), pl_number_inv(p, pl_int(p, den)));
}

pl_expr pl_number_add(pl_pool* p, pl_expr a, pl_expr b) {
  if (a.id == 0 || b.id == 0) return pl_poison();
  const pl_number *x = pl_number_of(p, a), *y = pl_number_of(p, b);
  pl_expr e;
  if (x->limbs == NULL && y->limbs == NULL) {
    __int128 u = (__int128)x->num * y->den, v = (__int128)y->num * x->den, sum;
    if (!__builtin_add_overflow(u, v, &sum) && make_small(p, sum, (__int128)x->den * y->den, &e))
      return e;
  }
  return large_compute(p, large_add, a, b);
}

pl_expr pl_number_mul(pl_pool* p, pl_expr a, pl_expr b) {
  if (a.id == 0 || b.id == 0) return pl_poison();
  const pl_number *x = pl_number_of(p, a), *y = pl_number_of(p, b);
  pl_expr e;
  if (x->limbs == NULL && y->limbs == NULL
      && make_small(p, (__int128)x->num * y->num, (__int128)x->den * y->den, &e)) {
    return e;
  }
  return large_compute(p, large_mul, a, b);
}

pl_expr pl_number_inv(pl_pool* p, pl_expr a) {
  if (a.id == 0) return a;
  const pl_number* x = pl_number_of(p, a);
  if (pl_number_sign(p, a) == 0) return pl_poison();
  if (x->limbs == NULL) {
    int64_t sign = x->num < 0 ? -1 : 1;
    return pl_number_make(p, &(pl_number){.num = sign * x->den, .den = sign * x->num});
  }
  int32_t n = x->n_num < 0 ? -x->n_num : x->n_num;
  room r = room_take(p, (size_t)n + (size_t)x->n_den);
  mpn_copyi(r.limbs, x->limbs + n, x->n_den);
  mpn_copyi(r.limbs + x->n_den, x->limbs, n);
  pl_number y = {.limbs = r.limbs, .n_num = x->n_num < 0 ? -x->n_den : x->n_den, .n_den = n};
  pl_expr e = pl_number_make(p, &y);
  room_give(p, r);
  return e;
}

static size_t bits_of(const pl_number* x) {
  if (x->limbs != NULL) return limbs_of(x) * 64;
  size_t num = 64 - (size_t)__builtin_clzll(magnitude(x->num) | 1);
  size_t den = 64 - (size_t)__builtin_clzll((uint64_t)x->den | 1);
  return num > den ? num : den;
}

static bool is_unit(const pl_number* x) {
  return x->limbs == NULL && x->den == 1 && (x->num == 1 || x->num == -1);
}

pl_expr pl_number_pow(pl_pool* p, pl_expr a, long n) {
  if (a.id == 0) return a;
  const pl_number* x = pl_number_of(p, a);
  if (n == 0) return p->one;
  if (n < 0) {
    pl_expr inverse = pl_number_inv(p, a);
    return inverse.id == 0 || n == LONG_MIN ? pl_poison() : pl_number_pow(p, inverse, -n);
  }
  if (pl_number_sign(p, a) == 0) return a;
  if (is_unit(x)) return x->num == 1 || n % 2 == 0 ? p->one : a;
  if ((unsigned long)n > PL_POWER_BITS / bits_of(x) + 1) return pl_poison();

  room r = room_take(p, limbs_of(x) * (size_t)n + 4);
  large u;
  borrow(&u, x);
  mpz_t num, den;
  mpz_init(num);
  mpz_init(den);
  mpz_pow_ui(num, u.num, (unsigned long)n);
  mpz_pow_ui(den, u.den, (unsigned long)n);
  pl_number result = settle(r, num, den);
  pl_expr e = pl_number_make(p, &result);
  room_give(p, r);
  return e;
}

int pl_number_compare(const pl_pool* p, pl_expr a, pl_expr b) {
  if (a.id == b.id) return 0;
  const pl_number *x = pl_number_of(p, a), *y = pl_number_of(p, b);
  if (x->limbs == NULL && y->limbs == NULL) {
    __int128 u = (__int128)x->num * y->den, v = (__int128)y->num * x->den;
    return u < v ? -1 : u > v;
  }
  large u, v;
  borrow(&u, x);
  borrow(&v, y);
  mpz_t left, right;
  mpz_init(left);
  mpz_init(right);
  mpz_mul(left, u.num, v.den);
  mpz_mul(right, v.num, u.den);
  int c = mpz_cmp(left, right);
  mpz_clear(left);
  mpz_clear(right);
  return c;
}

int pl_number_sign(const pl_pool* p, pl_expr e) {
  if (!pl_is_number(p, e)) return 0;
  const pl_number* x = pl_number_of(p, e);
  if (x->limbs != NULL) return x->n_num < 0 ? -1 : 1;
  return (x->num > 0) - (x->num < 0);
}

bool pl_number_is_integer(const pl_pool* p, pl_expr a) {
  const pl_number* x = pl_number_of(p, a);
  return x->limbs == NULL ? x->den == 1
                          : x->n_den == 1 && x->limbs[x->n_num < 0 ? -x->n_num : x->n_num] == 1;
}

// ------------------------------------------------------------------------------------------- parts
// An integer from limbs that live in a node.
static pl_expr integer_of(pl_pool* p, const mpz_t z) {
  int64_t small;
  if (mpz_small(z, &small)) return pl_number_make(p, &(pl_number){.num = small, .den = 1});
  size_t n = mpz_size(z);
  room r = room_take(p, n + 1);
  mpn_copyi(r.limbs, mpz_limbs_read(z), (mp_size_t)n);
  r.limbs[n] = 1;
  pl_number x = {
      .limbs = r.limbs, .n_num = (int32_t)(mpz_sgn(z) < 0 ? -(long)n : (long)n), .n_den = 1};
  pl_expr e = pl_number_make(p, &x);
  room_give(p, r);
  return e;
}

pl_expr pl_number_num(pl_pool* p, pl_expr a) {
  large u;
  borrow(&u, pl_number_of(p, a));
  return integer_of(p, u.num);
}

pl_expr pl_number_den(pl_pool* p, pl_expr a) {
  large u;
  borrow(&u, pl_number_of(p, a));
  return integer_of(p, u.den);
}

pl_expr pl_number_floor(pl_pool* p, pl_expr a) {
  const pl_number* x = pl_number_of(p, a);
  if (x->limbs == NULL) {
    int64_t q = x->num / x->den;
    return pl_number_make(p, &(pl_number){.num = q - (x->num % x->den < 0), .den = 1});
  }
  room r = room_take(p, limbs_of(x) + 2);
  large u;
  borrow(&u, x);
  mpz_t num, den;
  mpz_init(num);
  mpz_init_set_ui(den, 1);
  mpz_fdiv_q(num, u.num, u.den);
  pl_number result = settle(r, num, den);
  pl_expr e = pl_number_make(p, &result);
  room_give(p, r);
  return e;
}

// ------------------------------------------------------------------------------------------- roots
// Primes up to here are divided out; what is left is looked at as a whole. Complete for 64-bit
// numbers below 2^48.
enum { TRIAL_SMALL = 1 << 16, TRIAL_LARGE = 1000 };

// Divides z by d as often as it goes: each d^q into out, the rest into in.
static void divide_out(mpz_t z, mpz_t out, mpz_t in, unsigned long d, int q) {
  int k = 0;
  while (mpz_divisible_ui_p(z, d)) {
    mpz_divexact_ui(z, z, d);
    k++;
  }
  for (int i = 0; i < k / q; i++) mpz_mul_ui(out, out, d);
  for (int i = 0; i < k % q; i++) mpz_mul_ui(in, in, d);
}

// Nothing new can be found beyond d: what is left is a prime, or (for square roots) two primes or a
// square.
static bool trial_is_done(const mpz_t z, unsigned long d, int q) {
  if (mpz_cmp_ui(z, d) < 0) return true;
  if (!mpz_fits_ulong_p(z)) return false;
  unsigned __int128 square = (unsigned __int128)d * d;
  return (q == 2 ? square * d : square) > mpz_get_ui(z);
}

void pl_number_split_root(pl_pool* p, pl_expr a, int q, pl_expr* outside, pl_expr* inside) {
  const pl_number* x = pl_number_of(p, a);
  room out_room = room_take(p, limbs_of(x) + 3), in_room = room_take(p, limbs_of(x) + 3);
  large u;
  borrow(&u, x);
  mpz_t rest, out, in, root, one, one_too;
  mpz_init_set(rest, u.num);
  mpz_init_set_ui(out, 1);
  mpz_init_set_ui(in, 1);
  mpz_init(root);
  mpz_init_set_ui(one, 1);
  mpz_init_set_ui(one_too, 1);

  unsigned long last = mpz_sizeinbase(rest, 2) <= 64 ? TRIAL_SMALL : TRIAL_LARGE;
  for (unsigned long d = 2; d <= last && mpz_cmp_ui(rest, 1) > 0; d += 1 + (d > 2)) {
    if (trial_is_done(rest, d, q)) break;
    if (mpz_divisible_ui_p(rest, d)) divide_out(rest, out, in, d, q);
  }
  // what is left: a q-th power as a whole, or nothing that is known
  if (mpz_root(root, rest, (unsigned long)q)) mpz_mul(out, out, root);
  else mpz_mul(in, in, rest);

  mpz_clear(rest);
  mpz_clear(root);
  pl_number s = settle(out_room, out, one), t = settle(in_room, in, one_too);
  *outside = pl_number_make(p, &s);
  *inside = pl_number_make(p, &t);
  room_give(p, out_room);
  room_give(p, in_room);
}

// ----------------------------------------------------------------------------------------- modular
uint64_t pl_number_mod(const pl_pool* p, pl_expr a, uint64_t modulus, bool* ok) {
  large u;
  borrow(&u, pl_number_of(p, a));
  uint64_t num = mpz_fdiv_ui(u.num, modulus), den = mpz_fdiv_ui(u.den, modulus);
  if (den == 0) *ok = false;
  return den == 0 ? 0 : pl_mod_mul(num, den == 1 ? 1 : pl_mod_inv(den));
}

// ------------------------------------------------------------------------------------------ double
// The nearest double: quotient to 64 bits and a sticky bit, then one rounding. (Through long double
// where that has 64 bits; elsewhere a result below the normal range may be rounded twice.)
static double large_double(const large* u) {
  mpz_t num, quotient, rest;
  mpz_init(num);
  mpz_init(quotient);
  mpz_init(rest);
  long shift = 66 - (long)mpz_sizeinbase(u->num, 2) + (long)mpz_sizeinbase(u->den, 2);
  mpz_abs(num, u->num);
  if (shift > 0) {
    mpz_mul_2exp(num, num, (mp_bitcnt_t)shift);
    mpz_tdiv_qr(quotient, rest, num, u->den);
  } else {
    mpz_mul_2exp(rest, u->den, (mp_bitcnt_t)-shift);
    mpz_tdiv_qr(quotient, rest, num, rest);
  }
  bool sticky = mpz_sgn(rest) != 0;

  // keep 62 bits and the sticky bit below them
  long drop = (long)mpz_sizeinbase(quotient, 2) - 62;
  if (drop > 0) {
    sticky = sticky || mpz_scan1(quotient, 0) < (mp_bitcnt_t)drop;
    mpz_tdiv_q_2exp(quotient, quotient, (mp_bitcnt_t)drop);
  }
  uint64_t m = mpz_get_ui(quotient) << 1 | (sticky ? 1 : 0);
  mpz_clear(num);
  mpz_clear(quotient);
  mpz_clear(rest);
  long exponent = drop - shift - 1;
  if (exponent > 4000) exponent = 4000;
  if (exponent < -4000) exponent = -4000;
  long double x = ldexpl((long double)m, (int)exponent);
  return (double)(mpz_sgn(u->num) < 0 ? -x : x);
}

double pl_number_double(const pl_pool* p, pl_expr e) {
  if (!pl_is_number(p, e)) return (double)NAN;
  const pl_number* x = pl_number_of(p, e);
  const uint64_t exact = 1ull << 53;
  if (x->limbs == NULL && magnitude(x->num) <= exact && (uint64_t)x->den <= exact) {
    return (double)x->num / (double)x->den;
  }
  large u;
  borrow(&u, x);
  return large_double(&u);
}

// The rational u minus x, exactly.
static void large_subtract_double(large* u, double x) {
  mpq_t of;
  mpq_init(of);
  mpq_set_d(of, x);
  mpz_mul(u->num, u->num, mpq_denref(of));
  mpz_submul(u->num, mpq_numref(of), u->den);
  mpz_mul(u->den, u->den, mpq_denref(of));
  mpq_clear(of);
}

void pl_number_doubles(const pl_pool* p, pl_expr e, double out[3]) {
  out[0] = pl_number_double(p, e);
  out[1] = out[2] = 0;
  if (!isfinite(out[0])) return;
  large u, rest;
  borrow(&u, pl_number_of(p, e));
  mpz_init_set(rest.num, u.num);
  mpz_init_set(rest.den, u.den);
  for (int i = 1; i < 3; i++) {
    large_subtract_double(&rest, out[i - 1]);
    if (mpz_sgn(rest.num) == 0) break;
    out[i] = large_double(&rest);
  }
  mpz_clear(rest.num);
  mpz_clear(rest.den);
}

// -------------------------------------------------------------------------------------------- text
static const char* integer_text(pl_arena* a, const mpz_t z) {
  char* s = pl_alloc(a, mpz_sizeinbase(z, 10) + 2);
  return mpz_get_str(s, 10, z);
}

const char* pl_number_num_text(pl_arena* a, const pl_pool* p, pl_expr e) {
  if (!pl_is_number(p, e)) return "?";
  large u;
  borrow(&u, pl_number_of(p, e));
  return integer_text(a, u.num);
}

const char* pl_number_den_text(pl_arena* a, const pl_pool* p, pl_expr e) {
  if (!pl_is_number(p, e)) return "?";
  large u;
  borrow(&u, pl_number_of(p, e));
  return integer_text(a, u.den);
}

const char* pl_number_text(pl_arena* a, const pl_pool* p, pl_expr e) {
  const char* num = pl_number_num_text(a, p, e);
  if (!pl_is_number(p, e) || pl_number_is_integer(p, e)) return num;
  return pl_format(a, "%s/%s", num, pl_number_den_text(a, p, e));
}

// Digits that a number may have in a text, and the size of its exponent of ten.
enum { MAX_DIGITS = 5000, MAX_EXPONENT = 5000 };

// [0-9]+ [. [0-9]*] [e [+-] [0-9]+]: digits without the point, and the power of ten that belongs to
// them.
static bool read_decimal(const char** s, const char* end, char* digits, int* n_digits,
                         long* power) {
  int n = 0, after_point = 0;
  bool point = false;
  const char* at = *s;
  for (; at < end && ((*at >= '0' && *at <= '9') || (*at == '.' && !point)); at++) {
    if (*at == '.') {
      point = true;
      continue;
    }
    if (n == MAX_DIGITS) return false;
    digits[n++] = *at;
    after_point += point;
  }
  if (n == 0) return false;
  long e = 0;
  if (at < end && (*at == 'e' || *at == 'E')) {
    const char* begin = ++at;
    bool minus = at < end && *at == '-';
    if (at < end && (*at == '+' || *at == '-')) begin = ++at;
    for (; at < end && *at >= '0' && *at <= '9'; at++) {
      if (e <= MAX_EXPONENT) e = e * 10 + (*at - '0');
    }
    if (at == begin || e > MAX_EXPONENT) return false;
    if (minus) e = -e;
  }
  digits[n] = '\0';
  *n_digits = n;
  *power = e - after_point;
  *s = at;
  return true;
}

static pl_expr decimal(pl_pool* p, const char* digits, int n, long power) {
  room r = room_take(p, (size_t)(n + (power < 0 ? -power : power)) / 16 + 8);
  mpz_t num, den, scale;
  mpz_init(num);
  mpz_init_set_ui(den, 1);
  mpz_init(scale);
  mpz_set_str(num, digits, 10);
  mpz_ui_pow_ui(scale, 10, (unsigned long)(power < 0 ? -power : power));
  mpz_mul(power < 0 ? den : num, power < 0 ? den : num, scale);
  mpz_clear(scale);
  reduce(num, den);
  pl_number x = settle(r, num, den);
  pl_expr e = pl_number_make(p, &x);
  room_give(p, r);
  return e;
}

pl_expr pl_number_from_text(pl_pool* p, const char* text, size_t n) {
  const char *at = text, *end = text + n;
  bool minus = at < end && *at == '-';
  if (at < end && (*at == '+' || *at == '-')) at++;
  char digits[MAX_DIGITS + 1];
  int n_digits = 0;
  long power = 0;
  if (!read_decimal(&at, end, digits, &n_digits, &power)) return pl_poison();
  pl_expr e = decimal(p, digits, n_digits, power);
  if (at < end && *at == '/') {
    at++;
    if (!read_decimal(&at, end, digits, &n_digits, &power)) return pl_poison();
    e = pl_number_mul(p, e, pl_number_inv(p, decimal(p, digits, n_digits, power)));
  }
  if (at != end) return pl_poison();
  return minus ? pl_number_mul(p, p->minus_one, e) : e;
}
