// Fractions of the tower: reduced numerator over an integer and powers of bases. Neither sines nor
// roots are rationalised out of denominators: that would make them 10 to 100 times larger.
//
// A base of a denominator is irreducible, so cancelling is trial division; only composite bases
// need a gcd.
#include "algebra/tower.h"

#include <string.h>

// A fraction under construction; den sorted by base.
typedef struct pl_frac_build {
  pl_tower* t;
  const pl_poly* num;
  fmpz* unit;
  PL_VEC(pl_power) den;
} pl_frac_build;

static void build_power(pl_frac_build* b, int base, int power) {
  int i = 0;
  while (i < b->den.n && b->den.at[i].base < base) i++;
  if (i < b->den.n && b->den.at[i].base == base) {
    b->den.at[i].power += power;
    return;
  }
  pl_power p = {base, power};
  pl_push(b->t->arena, b->den, p);
  memmove(&b->den.at[i + 1], &b->den.at[i], (size_t)(b->den.n - 1 - i) * sizeof p);
  b->den.at[i] = p;
}

static void build_factored(pl_frac_build* b, pl_factored f, int times) {
  for (int i = 0; i < f.n; i++) build_power(b, f.at[i].base, times * f.at[i].power);
}

// -------------------------------------------------------------------------------------- cancelling
// A composite base may share only a part with the numerator: split that part off.
static void cancel_composite(pl_frac_build* b, int i) {
  pl_tower* t = b->t;
  int base = b->den.at[i].base;
  const pl_poly* g = pl_poly_gcd(t, b->num, pl_base_poly(t, base));
  if (pl_poly_is_number(t, g)) return;
  const pl_poly *rest = NULL, *num = NULL;
  if (!pl_poly_divides(t, &rest, pl_base_poly(t, base), g) || !pl_poly_divides(t, &num, b->num, g))
    return;
  b->num = num;
  b->den.at[i].power--;
  pl_factored f = pl_poly_factor(t, rest);
  fmpz_mul(b->unit, b->unit, f.unit);
  build_factored(b, f, 1);
}

// w^2 = P is used on the denominator too: w^2k becomes P^k there, and w/P becomes 1/w. For a sine,
// P = (1 - c)(1 + c).
static void lower_powers(pl_frac_build* b) {
  pl_tower* t = b->t;
  for (int i = 0; i < b->den.n; i++) {
    int gen = t->bases.at[b->den.at[i].base].gen;
    if (gen < 0 || t->gens.at[gen].degree != 2 || b->den.at[i].power < 2) continue;
    int times = b->den.at[i].power / 2;
    b->den.at[i].power %= 2;
    pl_factored f = pl_poly_factor(t, t->gens.at[gen].value);
    fmpz* unit = pl_int_new(t);
    fmpz_pow_ui(unit, f.unit, (ulong)times);
    fmpz_mul(b->unit, b->unit, unit);
    build_factored(b, f, times);
    i = -1;  // the list has changed, and P may hold an older root
  }
}

static bool den_holds(const pl_frac_build* b, pl_factored f) {
  for (int i = 0; i < f.n; i++) {
    int have = 0;
    for (int k = 0; k < b->den.n; k++) {
      if (b->den.at[k].base == f.at[i].base) have = b->den.at[k].power;
    }
    if (have < f.at[i].power) return false;
  }
  return true;
}

static void lower_roots(pl_frac_build* b) {
  pl_tower* t = b->t;
  pl_poly* content = pl_poly_new(t);
  fmpz_mpoly_term_content(content, b->num, &t->ctx);
  for (int g = 0; g < t->gens.n; g++) {
    if (t->gens.at[g].degree != 2 || pl_poly_degree(t, content, g) < 1) continue;
    pl_factored f = pl_poly_factor(t, t->gens.at[g].value);
    if (f.n == 0 || !den_holds(b, f)) continue;
    const pl_poly* q = NULL;
    if (!pl_poly_divides(t, &q, b->num, pl_poly_gen(t, g))) continue;
    b->num = pl_poly_scale(t, q, f.unit);  // w/(P/unit) = unit/w
    build_factored(b, f, -1);
    build_power(b, pl_base_find(t, pl_poly_gen(t, g), false), 1);
  }
}

// P/w = w.
static void raise_roots(pl_frac_build* b) {
  pl_tower* t = b->t;
  for (int i = 0; i < b->den.n; i++) {
    int gen = t->bases.at[b->den.at[i].base].gen;
    if (gen < 0 || t->gens.at[gen].degree != 2 || b->den.at[i].power != 1) continue;
    const pl_poly* q = NULL;
    const pl_poly* value = t->gens.at[gen].value;
    fmpz* content = pl_int_new(t);
    pl_poly_content(t, content, value);
    if (!pl_poly_divides(t, &q, b->num, pl_poly_scale_down(t, value, content))) continue;
    b->num = pl_poly_mul(t, q, pl_poly_gen(t, gen));
    fmpz_mul(b->unit, b->unit, content);
    b->den.at[i].power = 0;
  }
}

// In the free ring, which is quick, or modulo the relations: s^2 may have been rewritten in the
// product.
static bool divides(pl_tower* t, const pl_poly** q, const pl_poly* num, int base) {
  const pl_poly* den = pl_base_poly(t, base);
  if (pl_poly_divides(t, q, num, den)) return true;
  return t->bases.at[base].gen < 0 && pl_poly_divides_reduced(t, q, num, den);
}

static void cancel_bases(pl_frac_build* b) {
  pl_tower* t = b->t;
  for (int i = 0; i < b->den.n; i++) {
    int base = b->den.at[i].base;
    const pl_poly* q = NULL;
    while (b->den.at[i].power > 0 && divides(t, &q, b->num, base)) {
      b->num = q;
      b->den.at[i].power--;
    }
    if (b->den.at[i].power > 0 && t->bases.at[base].composite) cancel_composite(b, i);
  }
  int n = 0;
  for (int i = 0; i < b->den.n; i++) {
    if (b->den.at[i].power) b->den.at[n++] = b->den.at[i];
  }
  b->den.n = n;
}

static void cancel_content(pl_frac_build* b) {
  pl_tower* t = b->t;
  if (fmpz_sgn(b->unit) < 0) {
    fmpz_neg(b->unit, b->unit);
    b->num = pl_poly_neg(t, b->num);
  }
  if (fmpz_is_one(b->unit)) return;
  fmpz* c = pl_int_new(t);
  pl_poly_content(t, c, b->num);
  fmpz_gcd(c, c, b->unit);
  if (fmpz_is_one(c)) return;
  b->num = pl_poly_scale_down(t, b->num, c);
  fmpz_divexact(b->unit, b->unit, c);
}

static pl_frac built(pl_frac_build* b) {
  if (pl_poly_is_zero(b->t, b->num)) return pl_frac_int(b->t, 0);
  if (b->den.n) {
    lower_powers(b);
    cancel_bases(b);
    raise_roots(b);
    lower_roots(b);
    cancel_bases(b);
  }
  cancel_content(b);
  return (pl_frac){.num = b->num, .unit = b->unit, .n = b->den.n, .den = b->den.at};
}

static pl_frac_build build_begin(pl_tower* t, const pl_poly* num) {
  pl_frac_build b = {.t = t, .num = num, .unit = pl_int_new(t)};
  fmpz_one(b.unit);
  return b;
}

// ------------------------------------------------------------------------------------------ making
pl_frac pl_frac_poly(pl_tower* t, const pl_poly* num) {
  fmpz* unit = pl_int_new(t);
  fmpz_one(unit);
  return (pl_frac){.num = num, .unit = unit};
}

pl_frac pl_frac_int(pl_tower* t, long c) { return pl_frac_poly(t, pl_poly_int(t, c)); }

pl_frac pl_frac_ratio(pl_tower* t, const fmpz* num, const fmpz* den) {
  if (fmpz_is_zero(den)) pl_tower_give_up(t);
  pl_frac_build b = build_begin(t, pl_poly_fmpz(t, num));
  fmpz_set(b.unit, den);
  return built(&b);
}

pl_frac pl_frac_gen(pl_tower* t, int gen) { return pl_frac_poly(t, pl_poly_gen(t, gen)); }

pl_frac pl_frac_make(pl_tower* t, const pl_poly* num, const pl_poly* den) {
  den = pl_poly_reduce(t, den);
  if (pl_poly_is_zero(t, den)) pl_tower_give_up(t);
  pl_frac_build b = build_begin(t, pl_poly_reduce(t, num));
  pl_factored f = pl_poly_factor(t, den);
  fmpz_set(b.unit, f.unit);
  build_factored(&b, f, 1);
  return built(&b);
}

pl_frac pl_frac_over(pl_tower* t, const pl_poly* num, pl_frac like) {
  pl_frac_build b = build_begin(t, pl_poly_reduce(t, num));
  fmpz_set(b.unit, like.unit);
  for (int i = 0; i < like.n; i++) pl_push(t->arena, b.den, like.den[i]);
  return built(&b);
}

pl_frac pl_frac_keep(pl_tower* t, pl_frac a) {
  pl_frac f = {
      .num = pl_poly_keep(t, a.num), .unit = pl_int_keep(t, a.unit), .n = a.n, .den = a.den};
  return f;
}

// --------------------------------------------------------------------------------------- questions
bool pl_frac_is_zero(const pl_tower* t, pl_frac a) { return pl_poly_is_zero(t, a.num); }

const pl_poly* pl_frac_den(pl_tower* t, pl_frac a) {
  return pl_factored_expand(t, (pl_factored){.unit = a.unit, .n = a.n, .at = a.den});
}

// -------------------------------------------------------------------------------------- arithmetic
pl_frac pl_frac_neg(pl_tower* t, pl_frac a) {
  a.num = pl_poly_neg(t, a.num);
  return a;
}

// num times what its own denominator lacks to the common one.
static const pl_poly* raise_num(pl_frac_build* common, pl_frac a) {
  pl_tower* t = common->t;
  fmpz* factor = pl_int_new(t);
  fmpz_divexact(factor, common->unit, a.unit);
  const pl_poly* num = pl_poly_scale(t, a.num, factor);
  for (int i = 0, k = 0; i < common->den.n; i++) {
    int have = 0;
    if (k < a.n && a.den[k].base == common->den.at[i].base) have = a.den[k++].power;
    int lacks = common->den.at[i].power - have;
    if (lacks > 0)
      num = pl_poly_mul(t, num, pl_poly_pow(t, pl_base_poly(t, common->den.at[i].base), lacks));
  }
  return num;
}

static bool same_den(pl_frac a, pl_frac b) {
  if (a.n != b.n || !fmpz_equal(a.unit, b.unit)) return false;
  return a.n == 0 || memcmp(a.den, b.den, (size_t)a.n * sizeof *a.den) == 0;
}

static pl_frac add_same(pl_tower* t, pl_frac a, pl_frac b) {
  pl_frac_build s = build_begin(t, pl_poly_add(t, a.num, b.num));
  fmpz_set(s.unit, a.unit);
  for (int i = 0; i < a.n; i++) pl_push(t->arena, s.den, a.den[i]);
  return built(&s);
}

pl_frac pl_frac_add(pl_tower* t, pl_frac a, pl_frac b) {
  if (pl_frac_is_zero(t, a)) return b;
  if (pl_frac_is_zero(t, b)) return a;
  if (same_den(a, b)) return add_same(t, a, b);
  pl_frac_build s = build_begin(t, NULL);
  fmpz_lcm(s.unit, a.unit, b.unit);
  for (int i = 0; i < a.n; i++) pl_push(t->arena, s.den, a.den[i]);
  for (int i = 0; i < b.n; i++) {
    int have = 0;
    for (int k = 0; k < a.n; k++) {
      if (a.den[k].base == b.den[i].base) have = a.den[k].power;
    }
    if (b.den[i].power > have) build_power(&s, b.den[i].base, b.den[i].power - have);
  }
  s.num = pl_poly_add(t, raise_num(&s, a), raise_num(&s, b));
  return built(&s);
}

pl_frac pl_frac_sub(pl_tower* t, pl_frac a, pl_frac b) {
  return pl_frac_add(t, a, pl_frac_neg(t, b));
}

pl_frac pl_frac_mul(pl_tower* t, pl_frac a, pl_frac b) {
  if (pl_frac_is_zero(t, a)) return a;
  if (pl_frac_is_zero(t, b)) return b;
  pl_frac_build p = build_begin(t, NULL);
  fmpz_mul(p.unit, a.unit, b.unit);
  for (int i = 0; i < a.n; i++) build_power(&p, a.den[i].base, a.den[i].power);
  for (int i = 0; i < b.n; i++) build_power(&p, b.den[i].base, b.den[i].power);
  // cancel crosswise before multiplying: the numerators are smaller
  if (p.den.n) {
    p.num = a.num;
    cancel_bases(&p);
    const pl_poly* left = p.num;
    p.num = b.num;
    cancel_bases(&p);
    p.num = pl_poly_mul(t, left, p.num);
  } else {
    p.num = pl_poly_mul(t, a.num, b.num);
  }
  return built(&p);
}

pl_frac pl_frac_inv(pl_tower* t, pl_frac a) {
  if (pl_frac_is_zero(t, a)) pl_tower_give_up(t);
  pl_frac_build q = build_begin(t, pl_frac_den(t, a));
  pl_factored f = pl_poly_factor(t, a.num);
  fmpz_set(q.unit, f.unit);
  build_factored(&q, f, 1);
  return built(&q);
}

pl_frac pl_frac_div(pl_tower* t, pl_frac a, pl_frac b) {
  return pl_frac_mul(t, a, pl_frac_inv(t, b));
}

pl_frac pl_frac_pow(pl_tower* t, pl_frac a, long n) {
  if (n < 0) return pl_frac_pow(t, pl_frac_inv(t, a), -n);
  if (n > PL_MAX_DEGREE) pl_tower_give_up(t);
  pl_frac_build p = build_begin(t, pl_poly_pow(t, a.num, n));
  fmpz_pow_ui(p.unit, a.unit, (ulong)n);
  for (int i = 0; i < a.n && n > 0; i++) {
    pl_power power = {a.den[i].base, a.den[i].power * (int)n};
    pl_push(t->arena, p.den, power);
  }
  return built(&p);
}
