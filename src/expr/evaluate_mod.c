// Values modulo the prime P = PL_MOD_P at a random point: what is identically zero gives 0,
// anything else almost never does.
//
// A symbol is a random residue (a square if it is known to be positive). An angle is split into
// rational multiples of monomials, as 3/2 of "ω t"; each monomial stands for a random rotation, the
// multiples follow by addition of angles. The same is done for exponents. A monomial is known by
// its residue, so ω (t - t0) and ω t - ω t0 are one angle.
//   π           as an angle in parts 2^k 3^m 5^n (k <= 7, m and n <= 2), so down to tenths of a
//               degree; else ok = false
//   asin u ...  the rotation with that sine
//   ln          sums over factors; else random, by the residue of the argument; so are the
//               inverse functions as values
//   abs, sign   by "is a square", which is multiplicative (modular.c)
// So 0 at several points certifies an identity. A value other than 0 refutes it unless logarithms,
// inverse functions, symbolic exponents or sums with symbolic bounds take part: relations between
// these may go unseen.
#include "expr/expr_impl.h"
#include "expr/modular.h"

#include <string.h>

enum { MAX_LINEAR = 64, MAX_DEPTH = 64, MAX_STEPS = 20000, MAX_SUM = 10000, PAGE = 256 };

// A random unit of angle or exponent is taken so many times that it can be divided by 2, 3 and 5
// this often.
enum { DIVISIONS_BY_2 = 20, DIVISIONS_BY_3 = 5, DIVISIONS_BY_5 = 6 };

typedef struct memo {
  uint64_t value;
  uint32_t epoch;  // valid if it is the point's
  bool ok;
} memo;

typedef struct symbol_value {
  uint64_t value;
  bool known;
} symbol_value;

struct pl_mod_point {
  pl_arena* arena;
  const pl_pool* p;
  uint64_t seed;
  uint32_t epoch;
  memo** pages;  // by node id, made when touched (n_pages x PAGE)
  uint32_t n_pages;
  symbol_value* symbols;  // by symbol id                 (n_symbols)
  uint32_t n_symbols;
};

// One pass over a DAG; inside a sum with a value for its index.
typedef struct binding {
  pl_symbol index;
  uint64_t value;
  const struct binding* outer;
} binding;

typedef struct pass {
  pl_mod_point* m;
  const binding* bound;
  pl_walk w;
  uint64_t* value;  // by position
  bool* good;
  bool ok;    // of the node at hand
  int steps;  // taken to split its argument
} pass;

// ------------------------------------------------------------------------------------------- point
pl_mod_point* pl_mod_point_make(pl_arena* a, const pl_pool* p, uint64_t seed) {
  pl_mod_point* m = PL_NEW(a, pl_mod_point);
  *m = (pl_mod_point){.arena = a, .p = p, .seed = seed, .epoch = 1};
  return m;
}

// A residue that is not 0, by what it belongs to.
static uint64_t residue(const pl_mod_point* m, uint64_t kind, uint64_t key) {
  uint64_t h = pl_hash_mix(pl_hash_mix(m->seed, kind), key) % PL_MOD_P;
  return h ? h : 1;
}

enum { OF_SYMBOL = 1, OF_ANGLE, OF_EXPONENT, OF_CALL, OF_ELEMENT, OF_PATTERN, OF_PI };

static void widen_symbols(pl_mod_point* m, uint32_t id) {
  if (id < m->n_symbols) return;
  uint32_t n = id * 2 + 16;
  symbol_value* wider = PL_ARRAY(m->arena, symbol_value, n);
  if (m->n_symbols > 0) memcpy(wider, m->symbols, m->n_symbols * sizeof *wider);
  m->symbols = wider;
  m->n_symbols = n;
}

// Squares have square roots; cubic and fifth roots every residue has, as P - 1 is not divisible by
// 3 or 5.
static uint64_t positive_residue(uint64_t x) { return pl_mod_mul(x, x); }

static uint64_t random_symbol(const pl_mod_point* m, const pl_symbol_info* info) {
  uint64_t x = residue(m, OF_SYMBOL, pl_hash_bytes(info->ascii, strlen(info->ascii), 0));
  switch (info->sign) {
    case PL_SIGN_POSITIVE:
    case PL_SIGN_NONNEGATIVE: return positive_residue(x);
    case PL_SIGN_NEGATIVE:
    case PL_SIGN_NONPOSITIVE: return pl_mod_sub(0, positive_residue(x));
    default: return x;
  }
}

static uint64_t symbol_residue(pl_mod_point* m, pl_symbol s) {
  widen_symbols(m, s.id);
  symbol_value* v = &m->symbols[s.id];
  if (!v->known) *v = (symbol_value){random_symbol(m, pl_symbol_get(m->p, s)), true};
  return v->value;
}

void pl_mod_point_set(pl_mod_point* m, pl_symbol s, uint64_t value) {
  if (s.id == 0) return;
  widen_symbols(m, s.id);
  m->symbols[s.id] = (symbol_value){value % PL_MOD_P, true};
  m->epoch++;
}

// --------------------------------------------------------------------------------------- arguments
static uint64_t at(pass* v, pl_expr e) {
  int i = pl_walk_position(&v->w, e);
  if (!v->good[i]) v->ok = false;
  return v->value[i];
}

static uint64_t arg(pass* v, pl_expr e, int i) { return at(v, pl_arg(v->m->p, e, i)); }

// ----------------------------------------------------------------------------- linear combinations
// An angle or exponent as a sum of num/den times a monomial.
typedef struct part {
  int64_t num, den;
  uint64_t key;  // residue of the monomial; 1 for a pure number
  pl_expr atom;  // the monomial, when it is one atom
  int n_atoms;
} part;

typedef struct linear {
  part at[MAX_LINEAR];
  int n;
} linear;

static int64_t gcd_positive(int64_t a, int64_t b) {
  while (b != 0) {
    int64_t r = a % b;
    a = b;
    b = r;
  }
  return a < 0 ? -a : a;
}

static void reduce(part* x, __int128 num, __int128 den, bool* ok) {
  if (num > INT64_MAX || num < -INT64_MAX || den > INT64_MAX) {
    *ok = false;
    return;
  }
  int64_t g = gcd_positive((int64_t)num, (int64_t)den);
  x->num = (int64_t)num / g;
  x->den = (int64_t)den / g;
}

static void linear_put(pass* v, linear* to, part x) {
  for (int i = 0; i < to->n; i++) {
    part* y = &to->at[i];
    if (y->key != x.key) continue;
    __int128 num = (__int128)y->num * x.den + (__int128)x.num * y->den;
    reduce(y, num, (__int128)y->den * x.den, &v->ok);
    return;
  }
  if (to->n == MAX_LINEAR) v->ok = false;
  else to->at[to->n++] = x;
}

static part part_product(pass* v, part x, part y) {
  part z = {.key = pl_mod_mul(x.key, y.key), .n_atoms = x.n_atoms + y.n_atoms, .den = 1};
  reduce(&z, (__int128)x.num * y.num, 1, &v->ok);
  part den = {.den = 1};
  reduce(&den, (__int128)x.den * y.den, 1, &v->ok);
  reduce(&z, z.num, den.num, &v->ok);
  if (z.n_atoms == 1) z.atom = x.n_atoms ? x.atom : y.atom;
  return z;
}

static void linear_product(pass* v, linear* to, const linear* by) {
  linear from = *to;
  to->n = 0;
  for (int i = 0; i < from.n; i++) {
    for (int k = 0; k < by->n && v->ok; k++)
      linear_put(v, to, part_product(v, from.at[i], by->at[k]));
  }
}

static void linear_of(pass* v, linear* to, pl_expr e, int depth);

static void linear_sum(pass* v, linear* to, pl_expr e, int depth) {
  to->n = 0;
  for (int i = 0, n = pl_n_args(v->m->p, e); i < n && v->ok; i++) {
    linear term;
    linear_of(v, &term, pl_arg(v->m->p, e, i), depth);
    for (int k = 0; k < term.n; k++) linear_put(v, to, term.at[k]);
  }
}

static void linear_factors(pass* v, linear* to, pl_expr e, int depth) {
  *to = (linear){.at = {{.num = 1, .den = 1, .key = 1}}, .n = 1};
  for (int i = 0, n = pl_n_args(v->m->p, e); i < n && v->ok; i++) {
    linear factor;
    linear_of(v, &factor, pl_arg(v->m->p, e, i), depth);
    linear_product(v, to, &factor);
  }
}

static void linear_power(pass* v, linear* to, pl_expr base, long n, int depth) {
  linear factor;
  linear_of(v, &factor, base, depth);
  *to = factor;
  for (long i = 1; i < n && v->ok; i++) linear_product(v, to, &factor);
}

static void linear_of(pass* v, linear* to, pl_expr e, int depth) {
  const pl_pool* p = v->m->p;
  to->n = 0;
  if (depth > MAX_DEPTH || v->steps++ > MAX_STEPS) v->ok = false;
  if (!v->ok) return;
  long n, d;
  switch (pl_kind_of(p, e)) {
    case PL_NUMBER:
      if (!pl_is_ratio(p, e, &n, &d)) v->ok = false;
      else *to = (linear){.at = {{.num = n, .den = d, .key = 1}}, .n = 1};
      return;
    case PL_ADD: linear_sum(v, to, e, depth + 1); return;
    case PL_MUL: linear_factors(v, to, e, depth + 1); return;
    case PL_POW:
      if (pl_kind_of(p, pl_arg(p, e, 0)) == PL_ADD && pl_is_int(p, pl_arg(p, e, 1), &n) && n > 1
          && n <= 8) {
        linear_power(v, to, pl_arg(p, e, 0), n, depth + 1);
        return;
      }
      break;
    default: break;
  }
  *to = (linear){.at = {{.num = 1, .den = 1, .key = at(v, e), .atom = e, .n_atoms = 1}}, .n = 1};
}

// ------------------------------------------------------------------------------------------ angles
// The rotation of asin(u), acos(u), atan(u), atan2(y, x); false for other atoms.
static bool rotation_of_inverse(pass* v, pl_expr atom, pl_rotation* out) {
  const pl_pool* p = v->m->p;
  if (pl_kind_of(p, atom) != PL_CALL) return false;
  pl_function f = pl_function_of(p, atom);
  if (f != PL_ASIN && f != PL_ACOS && f != PL_ATAN && f != PL_ATAN2) return false;
  uint64_t a = arg(v, atom, 0), b = f == PL_ATAN2 ? arg(v, atom, 1) : 1;
  if (f == PL_ASIN || f == PL_ACOS) {
    uint64_t other = pl_mod_sqrt(pl_mod_sub(1, pl_mod_mul(a, a)), &v->ok);
    *out = f == PL_ASIN ? (pl_rotation){other, a} : (pl_rotation){a, other};
    return true;
  }
  uint64_t r = pl_mod_sqrt(pl_mod_add(pl_mod_mul(a, a), pl_mod_mul(b, b)), &v->ok);
  if (r == 0) v->ok = false;
  uint64_t scale = pl_mod_inv(r);
  *out = (pl_rotation){pl_mod_mul(b, scale), pl_mod_mul(a, scale)};
  return true;
}

// Divides *den by q as often as it goes, at most n times; the divisions that are left over, as a
// factor.
static uint64_t left_over(int64_t* den, int64_t q, int n) {
  uint64_t factor = 1;
  for (int i = 0; i < n; i++) {
    if (*den % q == 0) *den /= q;
    else factor *= (uint64_t)q;
  }
  return factor;
}

// How many random units 1/den of the whole is, and by what it must still be divided.
static uint64_t units_for(int64_t den, int64_t* rest) {
  uint64_t n = left_over(&den, 2, DIVISIONS_BY_2);
  n *= left_over(&den, 3, DIVISIONS_BY_3);
  n *= left_over(&den, 5, DIVISIONS_BY_5);
  *rest = den;
  return n;
}

static pl_rotation rotation_of_part(pass* v, const part* x) {
  pl_rotation r;
  if (x->n_atoms == 1 && x->atom.id == v->m->p->pi.id)
    return pl_rotation_of_pi(x->num, x->den, &v->ok);
  if (x->n_atoms == 1 && rotation_of_inverse(v, x->atom, &r))
    return pl_rotation_ratio(r, x->num, x->den, &v->ok);
  int64_t rest;
  uint64_t n = units_for(x->den, &rest);
  if (rest % 2 == 0) v->ok = false;
  if (!v->ok) return pl_rotation_none();
  r = pl_rotation_pow(pl_rotation_from_tangent(residue(v->m, OF_ANGLE, x->key)), n);
  return pl_rotation_ratio(r, x->num, rest, &v->ok);
}

static pl_rotation rotation_of(pass* v, pl_expr angle) {
  linear l;
  linear_of(v, &l, angle, 0);
  pl_rotation r = pl_rotation_none();
  for (int i = 0; i < l.n && v->ok; i++) {
    if (l.at[i].num != 0) r = pl_rotation_mul(r, rotation_of_part(v, &l.at[i]));
  }
  return r;
}

// --------------------------------------------------------------------------------------- exponents
// unit^(num/den), for a unit that is a random residue
static uint64_t unit_power(pass* v, uint64_t unit, const part* x) {
  int64_t rest;
  uint64_t n = units_for(x->den, &rest);
  if (rest % 2 == 0) v->ok = false;
  if (!v->ok) return 0;
  // twice as many, so that the result is a square, as powers are positive
  return pl_mod_pow_ratio(pl_mod_pow(unit, 2 * n), x->num, rest, &v->ok);
}

// base^exponent for a symbolic exponent; e^exponent when base is 0 (which has no powers)
static uint64_t symbolic_power(pass* v, uint64_t base, pl_expr exponent) {
  const pl_pool* p = v->m->p;
  linear l;
  linear_of(v, &l, exponent, 0);
  uint64_t r = 1;
  for (int i = 0; i < l.n && v->ok; i++) {
    const part* x = &l.at[i];
    bool logarithm = x->n_atoms == 1 && pl_kind_of(p, x->atom) == PL_CALL
                     && pl_function_of(p, x->atom) == PL_LN;
    uint64_t factor;
    if (x->num == 0) continue;
    if (base != 0 && x->n_atoms == 0) factor = pl_mod_pow_ratio(base, x->num, x->den, &v->ok);
    else if (base == 0 && logarithm)
      factor = pl_mod_pow_ratio(arg(v, x->atom, 0), x->num, x->den, &v->ok);
    else
      factor = unit_power(v, residue(v->m, OF_EXPONENT, base ? pl_hash_mix(base, x->key) : x->key),
                          x);
    r = pl_mod_mul(r, factor);
  }
  return r;
}

static uint64_t power_value(pass* v, pl_expr e) {
  const pl_pool* p = v->m->p;
  pl_expr exponent = pl_arg(p, e, 1);
  uint64_t base = arg(v, e, 0);
  long num, den;
  if (pl_is_ratio(p, exponent, &num, &den)) return pl_mod_pow_ratio(base, num, den, &v->ok);
  if (pl_is_number(p, exponent) && pl_number_is_integer(p, exponent)) {
    if (base == 0) v->ok = false;
    return pl_mod_pow(base, pl_number_mod(p, exponent, PL_MOD_P - 1, &v->ok));
  }
  if (pl_is_number(p, exponent) || base == 0) v->ok = false;
  return v->ok ? symbolic_power(v, base, exponent) : 0;
}

// -------------------------------------------------------------------------------------- logarithms
static uint64_t log_of(pass* v, pl_expr e, int depth);

static uint64_t log_of_atom(const pass* v, uint64_t x) {
  return residue(v->m, OF_CALL + 16 * PL_LN, x);
}

// ln of a positive number, as a sum over the primes that are found
static uint64_t log_of_number(pass* v, pl_expr e) {
  const pl_pool* p = v->m->p;
  long part_of[2];
  uint64_t sum = 0;
  bool small = pl_is_ratio(p, e, &part_of[0], &part_of[1]) && part_of[0] > 0;
  if (!small) return log_of_atom(v, at(v, e));
  for (int k = 0; k < 2; k++) {
    long n = part_of[k];
    for (long d = 2; n > 1; d++) {
      if (d > 1000 || d * d > n) d = n;
      for (; n % d == 0; n /= d) {
        uint64_t x = log_of_atom(v, (uint64_t)d);
        sum = k == 0 ? pl_mod_add(sum, x) : pl_mod_sub(sum, x);
      }
    }
  }
  return sum;
}

static uint64_t log_of_product(pass* v, pl_expr e, int depth) {
  const pl_pool* p = v->m->p;
  if (pl_number_sign(p, pl_arg(p, e, 0)) < 0) return log_of_atom(v, at(v, e));
  uint64_t sum = 0;
  for (int i = 0, n = pl_n_args(p, e); i < n; i++)
    sum = pl_mod_add(sum, log_of(v, pl_arg(p, e, i), depth + 1));
  return sum;
}

static uint64_t log_of(pass* v, pl_expr e, int depth) {
  const pl_pool* p = v->m->p;
  pl_kind kind = pl_kind_of(p, e);
  if (depth > MAX_DEPTH) v->ok = false;
  if (kind == PL_NUMBER) return log_of_number(v, e);
  if (kind == PL_MUL) return log_of_product(v, e, depth);
  if (kind == PL_POW) return pl_mod_mul(arg(v, e, 1), log_of(v, pl_arg(p, e, 0), depth + 1));
  if (kind == PL_CALL && pl_function_of(p, e) == PL_EXP) return arg(v, e, 0);
  return log_of_atom(v, at(v, e));
}

// ------------------------------------------------------------------------------------------- calls
static uint64_t divide(pass* v, uint64_t a, uint64_t b) {
  if (b == 0) v->ok = false;
  return b == 0 ? 0 : pl_mod_mul(a, pl_mod_inv(b));
}

// x = e^a: sinh = (x - 1/x)/2, cosh = (x + 1/x)/2
static uint64_t hyperbolic_value(pass* v, pl_function f, pl_expr a) {
  uint64_t x = symbolic_power(v, 0, a);
  if (!v->ok) return 0;
  uint64_t y = pl_mod_inv(x), sinh2 = pl_mod_sub(x, y), cosh2 = pl_mod_add(x, y);
  if (f == PL_TANH) return divide(v, sinh2, cosh2);
  return pl_mod_half(f == PL_SINH ? sinh2 : cosh2);
}

static uint64_t call_value(pass* v, pl_expr e) {
  const pl_pool* p = v->m->p;
  pl_function f = pl_function_of(p, e);
  pl_expr a = pl_arg(p, e, 0);
  uint64_t x = arg(v, e, 0), y = pl_n_args(p, e) == 2 ? arg(v, e, 1) : 0;
  if (!v->ok) return 0;
  switch (f) {
    case PL_SIN: return rotation_of(v, a).s;
    case PL_COS: return rotation_of(v, a).c;
    case PL_TAN: {
      pl_rotation r = rotation_of(v, a);
      return divide(v, r.s, r.c);
    }
    case PL_SINH:
    case PL_COSH:
    case PL_TANH: return hyperbolic_value(v, f, a);
    case PL_EXP: return symbolic_power(v, 0, a);
    case PL_LN: return log_of(v, a, 0);
    case PL_ABS: return pl_mod_sign(x) < 0 ? pl_mod_sub(0, x) : x;
    case PL_SIGN: return pl_mod_sign(x) < 0 ? PL_MOD_P - 1 : (uint64_t)pl_mod_sign(x);
    case PL_MIN: return pl_mod_sign(pl_mod_sub(y, x)) > 0 ? x : y;
    case PL_MAX: return pl_mod_sign(pl_mod_sub(x, y)) > 0 ? x : y;
    default: break;
  }
  // odd functions: asin(-x) = -asin(x); acos(x) = π/2 - asin(x)
  bool negative = pl_mod_sign(x) < 0;
  if (negative && f != PL_ATAN2) x = pl_mod_sub(0, x);
  uint64_t z = residue(v->m, OF_CALL + 16 * (uint64_t)(f == PL_ACOS ? PL_ASIN : f),
                       pl_hash_mix(x, y));
  if (negative && f != PL_ATAN2) z = pl_mod_sub(0, z);
  return f == PL_ACOS ? pl_mod_sub(pl_mod_half(residue(v->m, OF_PI, 0)), z) : z;
}

// ------------------------------------------------------------------------------------ node by node
static uint64_t run_body(pl_mod_point* m, pl_expr body, const binding* b, bool* ok);

static bool is_bound(const pass* v, pl_symbol s) {
  for (const binding* b = v->bound; b != NULL; b = b->outer) {
    if (b->index.id == s.id) return true;
  }
  return false;
}

// A bound of a sum as a whole number: a number, or an expression of outer indices that have values.
static bool whole_bound(const pass* v, pl_expr e, uint64_t value, long* out) {
  const pl_pool* p = v->m->p;
  if (pl_is_int(p, e, out)) return true;
  pl_symbol names[8];
  int n = pl_symbols_in(p, e, names, 8);
  if (n == 0 || n > 8) return false;
  for (int i = 0; i < n; i++) {
    if (!is_bound(v, names[i])) return false;
  }
  const uint64_t small = 1ull << 40;
  if (value >= small && value <= PL_MOD_P - small) return false;
  *out = value < small ? (long)value : -(long)(PL_MOD_P - value);
  return true;
}

// With whole numbers as bounds term by term; else the body at one random index, times a factor that
// stands for the range.
static uint64_t pattern_value(pass* v, pl_expr e) {
  const pl_pool* p = v->m->p;
  pl_symbol index = pl_symbol_of(p, e);
  uint64_t from = arg(v, e, 1), to = arg(v, e, 2);
  long lo, hi;
  if (!whole_bound(v, pl_arg(p, e, 1), from, &lo) || !whole_bound(v, pl_arg(p, e, 2), to, &hi)) {
    uint64_t range = pl_hash_mix(pl_hash_mix(from, to), symbol_residue(v->m, index));
    return pl_mod_mul(arg(v, e, 3), residue(v->m, OF_PATTERN, range));
  }
  if ((__int128)hi - lo > MAX_SUM) v->ok = false;
  uint64_t sum = 0;
  for (long k = lo; k <= hi && v->ok; k++) {
    binding b = {index, k < 0 ? pl_mod_sub(0, (uint64_t)-k % PL_MOD_P) : (uint64_t)k % PL_MOD_P,
                 v->bound};
    sum = pl_mod_add(sum, run_body(v->m, pl_arg(p, e, 3), &b, &v->ok));
  }
  return sum;
}

static uint64_t element_value(pass* v, pl_expr e) {
  const pl_symbol_info* info = pl_symbol_get(v->m->p, pl_symbol_of(v->m->p, e));
  uint64_t key = pl_hash_bytes(info->ascii, strlen(info->ascii), (uint64_t)pl_dots_of(v->m->p, e));
  return residue(v->m, OF_ELEMENT, pl_hash_mix(key, arg(v, e, 0)));
}

static uint64_t if_value(pass* v, pl_expr e) {
  uint64_t condition = arg(v, e, 0);
  return v->ok ? arg(v, e, pl_mod_sign(condition) > 0 ? 1 : 2) : 0;
}

static uint64_t fold(pass* v, pl_expr e, bool sum) {
  uint64_t x = sum ? 0 : 1;
  for (int i = 0, n = pl_n_args(v->m->p, e); i < n; i++) {
    uint64_t y = arg(v, e, i);
    x = sum ? pl_mod_add(x, y) : pl_mod_mul(x, y);
  }
  return x;
}

static uint64_t name_value(pass* v, pl_symbol s) {
  for (const binding* b = v->bound; b != NULL; b = b->outer) {
    if (b->index.id == s.id) return b->value;
  }
  return symbol_residue(v->m, s);
}

static uint64_t node_value(pass* v, pl_expr e) {
  const pl_pool* p = v->m->p;
  switch (pl_kind_of(p, e)) {
    case PL_NUMBER: return pl_number_mod(p, e, PL_MOD_P, &v->ok);
    case PL_PI: return residue(v->m, OF_PI, 0);
    case PL_SYMBOL: return name_value(v, pl_symbol_of(p, e));
    case PL_AT: return element_value(v, e);
    case PL_ADD: return fold(v, e, true);
    case PL_MUL: return fold(v, e, false);
    case PL_POW: return power_value(v, e);
    case PL_CALL: return call_value(v, e);
    case PL_IF: return if_value(v, e);
    case PL_SUM: return pattern_value(v, e);
    default: v->ok = false; return 0;  // poison, infinity
  }
}

// ------------------------------------------------------------------------------------------ passes
static memo* memo_at(pl_mod_point* m, pl_expr e) {
  uint32_t page = e.id / PAGE;
  if (page >= m->n_pages) {
    uint32_t n = m->p->n_nodes / PAGE * 2 + 16;
    memo** wider = PL_ARRAY(m->arena, memo*, n);
    if (m->n_pages > 0) memcpy(wider, m->pages, m->n_pages * sizeof *wider);
    m->pages = wider;
    m->n_pages = n;
  }
  if (m->pages[page] == NULL) m->pages[page] = PL_ARRAY(m->arena, memo, PAGE);
  return &m->pages[page][e.id % PAGE];
}

// Values that do not depend on a bound index are remembered in the point.
static void run_node(pass* v, int i) {
  pl_expr e = v->w.nodes.at[i];
  memo* known = v->bound == NULL ? memo_at(v->m, e) : NULL;
  if (known != NULL && known->epoch == v->m->epoch) {
    v->value[i] = known->value;
    v->good[i] = known->ok;
    return;
  }
  v->ok = true;
  v->steps = 0;
  uint64_t x = node_value(v, e);
  v->value[i] = v->ok ? x : 0;
  v->good[i] = v->ok;
  if (known != NULL) *known = (memo){v->value[i], v->m->epoch, v->ok};
}

static uint64_t run_body(pl_mod_point* m, pl_expr body, const binding* b, bool* ok) {
  pass v = {.m = m, .bound = b};
  pl_walk_begin(&v.w, m->p, &body, 1);
  size_t n = (size_t)v.w.nodes.n;
  v.value = pl_scratch_take(m->p, n * sizeof *v.value);
  v.good = pl_scratch_take(m->p, n * sizeof *v.good);
  for (int i = 0; i < v.w.nodes.n; i++) run_node(&v, i);
  uint64_t result = v.value[n - 1];
  if (!v.good[n - 1]) *ok = false;
  pl_scratch_give(m->p, v.value, n * sizeof *v.value);
  pl_scratch_give(m->p, v.good, n * sizeof *v.good);
  pl_walk_end(&v.w);
  return result;
}

uint64_t pl_eval_mod(pl_mod_point* m, pl_expr e, bool* ok) {
  const memo* known = memo_at(m, e);
  bool good = true;
  uint64_t value;
  if (known->epoch == m->epoch) {
    value = known->value;
    good = known->ok;
  } else {
    value = run_body(m, e, NULL, &good);
  }
  if (ok != NULL) *ok = good;
  return value;
}
