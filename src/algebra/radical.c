// Square roots, absolute values and logarithms: where the tower meets signs.
//
// sqrt(F) is taken factor by factor. Even powers come out, with their sign proven or assumed and
// recorded. What is left, P, becomes a generator w with w^2 = P only if it is independent of the
// roots that exist (Kummer): over the factor base (primes, irreducible polynomials, the sign) the
// exponent vectors mod 2 must be independent. If they are not, P times some of the older radicands
// is a square h^2 and sqrt(P) = |h| / (w_1 ... w_k). Nested roots are taken apart where A^2 - B^2 C
// is a square. There is never a generator with w^2 = x^2.
#include "algebra/tower.h"

#include <stdlib.h>

enum { PL_MAX_ABS_TERMS = 60 };  // |u| gets the relation a^2 = u^2 up to this length of u

// --------------------------------------------------------------------------------- absolute values
static pl_frac abs_generator(pl_tower* t, int base) {
  pl_expr e = pl_call(t->pool, PL_ABS, pl_base_expr(t, base));
  int gen = pl_tower_find(t, e);
  if (gen < 0) {
    const pl_poly* f = pl_base_poly(t, base);
    pl_gen g = {.kind = PL_G_ABS, .expr = e, .partner = -1, .class = PL_C_FUNCTION, .sign = 2};
    if (pl_poly_terms(f) <= PL_MAX_ABS_TERMS) {
      g.degree = 2;
      g.value = pl_poly_keep(t, pl_poly_mul(t, f, f));
    }
    gen = pl_tower_generator(t, &g);
  }
  return pl_frac_gen(t, gen);
}

// |base|^power, power of either sign.
static pl_frac abs_power(pl_tower* t, int base, int power, bool guess) {
  pl_frac f = pl_frac_poly(t, pl_base_poly(t, base));
  if (power % 2 != 0) {
    int sign = pl_base_sign(t, base, true, guess);
    if (sign == -1) f = pl_frac_neg(t, f);
    if (sign == PL_SIGN_OPEN) f = abs_generator(t, base);
  }
  return pl_frac_pow(t, f, power);
}

// num / den as powers of bases of either sign, and a rational unit.
typedef struct pl_split {
  fmpz* num;  // with sign
  fmpz* den;  // > 0
  PL_VEC(pl_power) at;
} pl_split;

static void split_add(pl_tower* t, pl_split* s, pl_factored f, int times) {
  for (int i = 0; i < f.n; i++) {
    int k = 0;
    while (k < s->at.n && s->at.at[k].base != f.at[i].base) k++;
    if (k == s->at.n) pl_push(t->arena, s->at, (pl_power){f.at[i].base, 0});
    s->at.at[k].power += times * f.at[i].power;
  }
}

static pl_split split_of(pl_tower* t, pl_frac a) {
  pl_split s = {.num = pl_int_new(t), .den = pl_int_new(t)};
  pl_factored num = pl_factored_merge_pairs(t, pl_poly_factor(t, a.num));
  pl_factored den = pl_factored_merge_pairs(t,
                                            (pl_factored){.unit = a.unit, .n = a.n, .at = a.den});
  fmpz_set(s.num, num.unit);
  fmpz_set(s.den, den.unit);
  split_add(t, &s, num, 1);
  split_add(t, &s, den, -1);
  return s;
}

pl_frac pl_frac_abs(pl_tower* t, pl_frac a) {
  if (pl_frac_is_zero(t, a)) return a;
  pl_split s = split_of(t, a);
  fmpz_abs(s.num, s.num);
  pl_frac r = pl_frac_ratio(t, s.num, s.den);
  for (int i = 0; i < s.at.n; i++)
    r = pl_frac_mul(t, r, abs_power(t, s.at.at[i].base, s.at.at[i].power, false));
  return r;
}

// --------------------------------------------------------------------------- the factor base mod 2
// A set of keys: 2 base for a polynomial, odd numbers for primes (2 p + 1) and the sign (-1).
// Sorted, descending.
typedef struct pl_keys {
  PL_VEC(int64_t) at;
} pl_keys;

static void keys_flip(pl_tower* t, pl_keys* k, int64_t key) {
  int i = 0;
  while (i < k->at.n && k->at.at[i] > key) i++;
  bool there = i < k->at.n && k->at.at[i] == key;
  if (there) {
    for (int j = i; j + 1 < k->at.n; j++) k->at.at[j] = k->at.at[j + 1];
    k->at.n--;
    return;
  }
  pl_push(t->arena, k->at, key);
  for (int j = k->at.n - 1; j > i; j--) k->at.at[j] = k->at.at[j - 1];
  k->at.at[i] = key;
}

static void keys_flip_integer(pl_tower* t, pl_keys* k, const fmpz* c) {
  if (fmpz_sgn(c) < 0) keys_flip(t, k, -1);
  pl_primes f = pl_int_primes(t, c);
  for (int i = 0; i < f.n; i++) {
    if (f.at[i].power % 2)
      keys_flip(t, k, 2 * (int64_t)fmpz_fdiv_ui(f.at[i].p, 2305843009213693951u) + 1);
  }
}

static pl_keys keys_of(pl_tower* t, pl_factored f) {
  pl_keys k = {0};
  keys_flip_integer(t, &k, f.unit);
  for (int i = 0; i < f.n; i++) {
    if (f.at[i].power % 2) keys_flip(t, &k, 2 * (int64_t)f.at[i].base);
  }
  return k;
}

typedef struct pl_radical_row {
  pl_keys keys;
  PL_VEC(int) roots;
} pl_radical_row;  // a combination of the radicands roots[]

static void row_add(pl_tower* t, pl_radical_row* to, const pl_radical_row* from) {
  for (int i = 0; i < from->keys.at.n; i++) keys_flip(t, &to->keys, from->keys.at.at[i]);
  for (int i = 0; i < from->roots.n; i++) {
    int k = 0;
    while (k < to->roots.n && to->roots.at[k] != from->roots.at[i]) k++;
    if (k == to->roots.n) {
      pl_push(t->arena, to->roots, from->roots.at[i]);
    } else {
      to->roots.at[k] = to->roots.at[--to->roots.n];
    }
  }
}

// Eliminates the leading key of each known row; true when nothing is left: dependent.
static bool row_reduce(pl_tower* t, pl_radical_row* r, const pl_radical_row* rows, int n) {
  for (bool again = true; again && r->keys.at.n > 0;) {
    again = false;
    for (int i = 0; i < n; i++) {
      if (r->keys.at.n == 0 || rows[i].keys.at.n == 0) continue;
      if (rows[i].keys.at.at[0] != r->keys.at.at[0]) continue;
      row_add(t, r, &rows[i]);
      again = true;
    }
  }
  return r->keys.at.n == 0;
}

// Older square roots whose radicands make P a square; false when there are none.
static bool dependent_roots(pl_tower* t, pl_factored P, pl_radical_row* out) {
  pl_radical_row* rows = PL_ARRAY(t->arena, pl_radical_row, t->gens.n + 1);
  int n = 0;
  for (int g = 0; g < t->gens.n; g++) {
    if (t->gens.at[g].kind != PL_G_ROOT || t->gens.at[g].degree != 2) continue;
    pl_radical_row r = {.keys = keys_of(t, pl_poly_factor(t, t->gens.at[g].value))};
    pl_push(t->arena, r.roots, g);
    if (!row_reduce(t, &r, rows, n)) rows[n++] = r;
  }
  *out = (pl_radical_row){.keys = keys_of(t, P)};
  return row_reduce(t, out, rows, n);
}

// ------------------------------------------------------------------------------------ square roots
// c = square^2 * free, free squarefree and with the sign of c.
static void integer_square_part(pl_tower* t, fmpz* square, fmpz* free, const fmpz* c) {
  fmpz_one(square);
  fmpz_set(free, c);
  if (fmpz_sgn(c) > 0 && fmpz_is_square(c)) {
    fmpz_sqrt(square, c);
    fmpz_one(free);
    return;
  }
  pl_primes f = pl_int_primes(t, c);
  fmpz* power = pl_int_new(t);
  for (int i = 0; i < f.n; i++) {
    fmpz_pow_ui(power, f.at[i].p, (ulong)f.at[i].power / 2);
    fmpz_mul(square, square, power);
  }
  fmpz_divexact(free, free, square);
  fmpz_divexact(free, free, square);
}

static pl_frac sqrt_of_poly(pl_tower* t, const pl_poly* P);

// sqrt of unit * prod base^power, powers of either sign: even parts come out, the rest goes on.
static pl_frac sqrt_of_split(pl_tower* t, pl_split s) {
  // sqrt(num/den) = sqrt(num den)/den
  fmpz* square = pl_int_new(t);
  fmpz* free = pl_int_new(t);
  fmpz_mul(free, s.num, s.den);
  fmpz* whole = pl_int_new(t);
  fmpz_set(whole, free);
  integer_square_part(t, square, free, whole);
  pl_frac outside = pl_frac_ratio(t, square, s.den);
  const pl_poly* rest = pl_poly_fmpz(t, free);
  for (int i = 0; i < s.at.n; i++) {
    int power = s.at.at[i].power;
    int odd = power % 2 != 0;
    int half = (power - odd) / 2;  // rounds down: power - odd is even
    if (half) outside = pl_frac_mul(t, outside, abs_power(t, s.at.at[i].base, half, true));
    if (odd) rest = pl_poly_mul(t, rest, pl_base_poly(t, s.at.at[i].base));
  }
  if (pl_poly_is_one(t, rest)) return outside;
  return pl_frac_mul(t, outside, sqrt_of_poly(t, rest));
}

pl_frac pl_frac_sqrt(pl_tower* t, pl_frac a) {
  if (pl_frac_is_zero(t, a)) return a;
  return sqrt_of_split(t, split_of(t, a));
}

static bool has_square(pl_factored f) {
  for (int i = 0; i < f.n; i++) {
    if (f.at[i].power > 1) return true;
  }
  return false;
}

// In another view of sin and cos the radicand may have square factors: 2 + 2 s - c^2 = (1 + s)^2.
static bool sqrt_in_other_view(pl_tower* t, const pl_poly* P, pl_frac* out) {
  for (int g = 0; g < t->gens.n; g++) {
    if (t->gens.at[g].kind != PL_G_COS || pl_poly_degree(t, P, g) < 2) continue;
    pl_factored f = pl_poly_factor(t, pl_poly_view(t, P, g));
    if (!has_square(f)) continue;
    pl_frac outside = pl_frac_int(t, 1);
    const pl_poly* rest = pl_poly_fmpz(t, f.unit);
    for (int i = 0; i < f.n; i++) {
      const pl_poly* base = pl_poly_reduce(t, pl_base_poly(t, f.at[i].base));
      if (f.at[i].power > 1) {
        pl_frac square = pl_frac_poly(t, pl_poly_mul(t, base, base));
        pl_split s = split_of(t, square);
        pl_frac size = pl_frac_int(t, 1);
        if (has_square((pl_factored){.unit = s.num, .n = s.at.n, .at = s.at.at})) {
          size = sqrt_of_split(t, s);
        } else {
          // the square of the factor does not factor in the reduced view: its own sign decides
          int sign = pl_poly_sign(t, base, true, true);
          if (sign == PL_SIGN_OPEN) return false;
          size = pl_frac_poly(t, sign < 0 ? pl_poly_neg(t, base) : base);
        }
        outside = pl_frac_mul(t, outside, pl_frac_pow(t, size, f.at[i].power / 2));
      }
      if (f.at[i].power % 2) rest = pl_poly_mul(t, rest, base);
    }
    *out = pl_frac_mul(t, outside, pl_frac_sqrt(t, pl_frac_poly(t, rest)));
    return true;
  }
  return false;
}

// f = h^2 for a fraction-free h.
static bool square_of(pl_tower* t, const pl_poly* f, pl_frac* h) {
  if (pl_poly_is_zero(t, f)) {
    *h = pl_frac_int(t, 0);
    return true;
  }
  const pl_poly* root = NULL;
  if (pl_poly_square_root(t, &root, f)) {
    *h = pl_frac_poly(t, root);
    return true;
  }
  return false;
}

// sqrt(A + B w) = sqrt((A + h)/2) + sign(B) sqrt((A - h)/2)  with  h^2 = A^2 - B^2 w^2.
static bool denest(pl_tower* t, const pl_poly* P, pl_frac* out) {
  for (int g = t->gens.n - 1; g >= 0; g--) {
    if (t->gens.at[g].kind != PL_G_ROOT || t->gens.at[g].degree != 2
        || pl_poly_degree(t, P, g) != 1)
      continue;
    int degree = 0;
    const pl_poly** c = pl_poly_coefficients(t, P, g, &degree);
    const pl_poly *A = c[0], *B = c[1];
    const pl_poly* norm = pl_poly_sub(t, pl_poly_mul(t, A, A),
                                      pl_poly_mul(t, pl_poly_mul(t, B, B), t->gens.at[g].value));
    pl_frac h;
    if (!square_of(t, pl_poly_reduce(t, norm), &h)) continue;
    int sign = pl_poly_sign(t, B, true, true);
    if (sign == PL_SIGN_OPEN) continue;
    pl_frac half = pl_frac_inv(t, pl_frac_int(t, 2));
    pl_frac plus = pl_frac_sqrt(t, pl_frac_mul(t, half, pl_frac_add(t, pl_frac_poly(t, A), h)));
    pl_frac minus = pl_frac_sqrt(t, pl_frac_mul(t, half, pl_frac_sub(t, pl_frac_poly(t, A), h)));
    pl_frac r = pl_frac_add(t, plus, sign < 0 ? pl_frac_neg(t, minus) : minus);
    // h may have either sign: what comes out must be positive
    int positive = pl_poly_sign(t, pl_poly_mul(t, r.num, pl_frac_den(t, r)), true, true);
    if (positive == PL_SIGN_OPEN) continue;
    *out = positive < 0 ? pl_frac_neg(t, r) : r;
    return true;
  }
  return false;
}

static pl_frac sqrt_by_older_roots(pl_tower* t, pl_factored P, const pl_radical_row* row) {
  pl_split s = {.num = pl_int_new(t), .den = pl_int_new(t)};
  fmpz_set(s.num, P.unit);
  fmpz_one(s.den);
  split_add(t, &s, P, 1);
  pl_frac roots = pl_frac_int(t, 1);
  for (int i = 0; i < row->roots.n; i++) {
    pl_factored f = pl_poly_factor(t, t->gens.at[row->roots.at[i]].value);
    fmpz_mul(s.num, s.num, f.unit);
    split_add(t, &s, f, 1);
    roots = pl_frac_mul(t, roots, pl_frac_gen(t, row->roots.at[i]));
  }
  t->radicand = pl_factored_expand(t, P);
  t->tangled = true;
  pl_frac h = sqrt_of_split(t, s);  // all powers are even now
  t->radicand = NULL;
  return pl_frac_div(t, h, roots);
}

// > 0 where the radicand is proven so, else >= 0; a negative number has no real root.
static int sign_of_root(pl_tower* t, const pl_poly* P) {
  bool was = t->silent;
  t->silent = true;
  int sign = pl_poly_sign(t, P, false, false);
  t->silent = was;
  return sign == 1 ? 1 : sign == PL_SIGN_OPEN ? 2 : 0;
}

static pl_frac sqrt_of_poly(pl_tower* t, const pl_poly* P) {
  for (int g = 0; g < t->gens.n; g++) {
    bool same = t->gens.at[g].kind == PL_G_ROOT && t->gens.at[g].degree == 2
                && pl_poly_equal(t, t->gens.at[g].value, P);
    if (same) return pl_frac_gen(t, g);
  }
  pl_factored f = pl_poly_factor(t, P);
  if (has_square(f)) return pl_frac_sqrt(t, pl_frac_poly(t, P));  // reduction has made one appear
  pl_frac r;
  if (sqrt_in_other_view(t, P, &r) || denest(t, P, &r)) return r;
  pl_radical_row row;
  if (dependent_roots(t, f, &row)) return sqrt_by_older_roots(t, f, &row);
  pl_expr e = pl_sqrt(t->pool, pl_poly_expr(t, P));
  int gen = pl_tower_find(t, e);
  if (gen < 0) {
    pl_gen g = {.kind = PL_G_ROOT,
                .expr = e,
                .partner = -1,
                .class = PL_C_FUNCTION,
                .sign = 2,
                .degree = 2};
    g.sign = sign_of_root(t, P);
    g.value = pl_poly_keep(t, P);
    gen = pl_tower_generator(t, &g);
  }
  return pl_frac_gen(t, gen);
}

// -------------------------------------------------------------------------------------- logarithms
static pl_frac ln_formal(pl_tower* t, pl_expr argument) {
  pl_expr e = pl_call(t->pool, PL_LN, argument);
  return pl_kind_of(t->pool, e) == PL_CALL ? pl_formal(t, e) : pl_convert(t, e);
}

// ln of a positive integer as a sum over its primes.
static pl_frac ln_integer(pl_tower* t, const fmpz* c) {
  pl_frac sum = pl_frac_int(t, 0);
  if (fmpz_is_one(c)) return sum;
  pl_primes f = pl_int_primes(t, c);
  for (int i = 0; i < f.n; i++) {
    pl_frac term = ln_formal(t, pl_fmpz_expr(t, f.at[i].p));
    sum = pl_frac_add(t, sum, pl_frac_mul(t, pl_frac_int(t, f.at[i].power), term));
  }
  return sum;
}

static pl_frac ln_of_base(pl_tower* t, int base) {
  int gen = t->bases.at[base].gen;
  if (gen >= 0 && t->gens.at[gen].kind == PL_G_EXP)
    return pl_convert(t, pl_arg(t->pool, t->gens.at[gen].expr, 0));
  if (gen >= 0 && t->gens.at[gen].kind == PL_G_ROOT) {
    pl_frac inner = pl_frac_ln(t, pl_frac_poly(t, t->gens.at[gen].value));
    return pl_frac_div(t, inner, pl_frac_int(t, t->gens.at[gen].degree));
  }
  return ln_formal(t, pl_base_expr(t, base));
}

pl_frac pl_frac_ln(pl_tower* t, pl_frac a) {
  if (pl_frac_is_zero(t, a)) pl_tower_give_up(t);
  pl_split s = split_of(t, a);
  bool positive = fmpz_sgn(s.num) > 0;
  for (int i = 0; i < s.at.n; i++)
    positive = positive && pl_base_sign(t, s.at.at[i].base, true, false) == 1;
  if (!positive) return ln_formal(t, pl_frac_expr(t, a));
  pl_frac sum = pl_frac_sub(t, ln_integer(t, s.num), ln_integer(t, s.den));
  for (int i = 0; i < s.at.n; i++) {
    pl_frac term = pl_frac_mul(t, pl_frac_int(t, s.at.at[i].power), ln_of_base(t, s.at.at[i].base));
    sum = pl_frac_add(t, sum, term);
  }
  return sum;
}
