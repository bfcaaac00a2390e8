// Angles and exponents as lattices. An argument is split into rational multiples of atoms
// (monomials over a common denominator); each atom has one base, atom/den, and sin, cos or exp of
// the base are generators. When a multiple comes that the base is too coarse for (θ/2 after θ), the
// base is refined and the tower starts again, so that θ/2 and 2θ share it. A multiple that would
// need high powers of the base (19/20 θ beside θ) is an atom of its own, or shares the base of
// another such atom: cos(19 u) in powers of cos u loses nine digits, and nobody can read it.
//
// A number that stands beside an atom, as in sin(θ + 1/4), is no angle of its own: every power of
// the sine would have cos 1/4 and sin 1/4 in it.  The base is shifted instead: cos(θ + 1/4) and its
// sine are the generators, and where θ comes with another number, or with none, the difference is
// expanded.  The first angle that has no other atom tells the shift.
//
// Angles that are inverse functions have no base: cos(acos u) = u, sin(acos u) = sqrt(1 - u^2).
#include "algebra/tower.h"

#include <stdlib.h>

enum { PL_MAX_ANGLE_TERMS = 8, PL_MAX_EXPONENT_DEN = 720 };

// One term q * atom of an argument; q = num/den in lowest terms.
typedef struct pl_angle_term {
  long num, den;
  pl_expr atom;
} pl_angle_term;
typedef struct pl_angle {
  int n;
  pl_angle_term at[PL_MAX_ANGLE_TERMS];
} pl_angle;

// --------------------------------------------------------------------------------------- splitting
// Monomial i of the numerator, over the factors of the denominator but without its integer
// coefficient.
static pl_expr atom_of(pl_tower* t, pl_frac a, slong i) {
  ulong exponent[PL_MAX_GENERATORS];
  fmpz_mpoly_get_term_exp_ui(exponent, a.num, i, &t->ctx);
  pl_poly* monomial = pl_poly_new(t);
  fmpz_mpoly_set_coeff_si_ui(monomial, 1, exponent, &t->ctx);
  pl_frac f = a;
  fmpz* one = pl_int_new(t);
  fmpz_one(one);
  f.num = monomial;
  f.unit = one;
  return pl_frac_expr(t, f);
}

// The coefficient when it is a small rational; larger ones stay inside the atom, with their sign
// outside.
static pl_angle_term term_of(pl_tower* t, pl_frac a, slong i, long max_num, long max_den,
                             bool numbers_are_atoms) {
  fmpz* g = pl_int_new(t);
  fmpz* num = pl_int_new(t);
  fmpz* den = pl_int_new(t);
  fmpz_gcd(g, &a.num->coeffs[i], a.unit);
  fmpz_divexact(num, &a.num->coeffs[i], g);
  fmpz_divexact(den, a.unit, g);
  pl_angle_term term = {.num = fmpz_sgn(num), .den = 1, .atom = atom_of(t, a, i)};
  bool small = fmpz_cmp_si(den, max_den) <= 0 && fmpz_fits_si(num)
               && labs(fmpz_get_si(num)) <= max_num;
  // sin 7 is not written in powers of sin 1: a number is an atom as it is
  if (small && !(numbers_are_atoms && pl_is_number(t->pool, term.atom))) {
    term.num = fmpz_get_si(num);
    term.den = fmpz_get_si(den);
    return term;
  }
  term.num = fmpz_sgn(num);
  fmpz_abs(num, num);
  term.atom = pl_mul(t->pool, pl_fmpq_expr(t, num, den), term.atom);
  return term;
}

// An argument of too many terms is one atom.
static void split(pl_tower* t, pl_expr argument, bool exponent, pl_angle* out) {
  long max_num = exponent ? PL_MAX_DEGREE : PL_MAX_RATIO,
       max_den = exponent ? PL_MAX_EXPONENT_DEN : PL_MAX_RATIO;
  pl_frac a = pl_convert(t, argument);
  out->n = 0;
  if (a.num->length > PL_MAX_ANGLE_TERMS) {
    int sign = pl_poly_leading_sign(t, a.num);
    out->at[out->n++] = (pl_angle_term){sign, 1, pl_frac_expr(t, sign < 0 ? pl_frac_neg(t, a) : a)};
    return;
  }
  for (slong i = 0; i < a.num->length; i++)
    out->at[out->n++] = term_of(t, a, i, max_num, max_den, !exponent);
}

// ---------------------------------------------------------------------------------------- lattices
static long gcd_long(long a, long b) {
  while (b) {
    long r = a % b;
    a = b;
    b = r;
  }
  return a < 0 ? -a : a;
}

pl_lattice pl_lattice_of(pl_tower* t, pl_expr atom) {
  pl_expr none = pl_int(t->pool, 0);
  return (pl_lattice){
      .atom = atom, .shift = none, .num = 1, .den = 1, .gen = -1, .most = {0, 1}, .common = {0, 1}};
}

static pl_lattice* angle_lattice(pl_tower* t, pl_expr atom) {
  uint64_t known = pl_map_get(t->angle_of, atom.id);
  if (!known) {
    pl_push(t->arena, t->angles, pl_lattice_of(t, atom));
    known = (uint64_t)t->angles.n;
    pl_map_set(t->angle_of, atom.id, known);
  }
  return &t->angles.at[known - 1];
}

static pl_lattice* exponent_lattice(pl_tower* t, pl_expr atom) {
  uint64_t known = pl_map_get(t->exponent_of, atom.id);
  if (!known) {
    pl_push(t->arena, t->exponents, pl_lattice_of(t, atom));
    known = (uint64_t)t->exponents.n;
    pl_map_set(t->exponent_of, atom.id, known);
  }
  return &t->exponents.at[known - 1];
}

// Makes the base fine enough for a multiple with this denominator; false when it would become too
// fine.
static bool refine(pl_tower* t, pl_lattice* l, long den, long max_den) {
  long finer = l->den / gcd_long(l->den, den) * den;
  if (finer == l->den) return true;
  if (finer > max_den) return false;
  l->den = finer;
  t->tangled = true;
  if (l->gen >= 0) pl_tower_restart(t);
  return true;
}

// q in whole bases: *n of them; false when it is no whole number, or more than PL_MAX_MULTIPLE.
static bool in_bases(pl_multiple q, pl_multiple base, long* n) {
  long num = q.num * base.den, den = q.den * base.num;
  *n = num / den;
  return num % den == 0 && labs(*n) <= PL_MAX_MULTIPLE;
}

// The largest of which both are whole multiples.
static pl_multiple common_measure(pl_multiple a, pl_multiple b) {
  if (a.num == 0) return (pl_multiple){labs(b.num), b.den};
  long num = gcd_long(a.num * b.den, b.num * a.den), den = a.den * b.den,
       common = gcd_long(num, den);
  return (pl_multiple){num / common, den / common};
}

// The multiple q of the atom in bases of its lattice, *n of them. The base is an integer part of
// the atom, or, where that would need high powers, the common measure of all multiples met. false:
// q is too far from those met before.
static bool take(pl_tower* t, pl_lattice* l, pl_multiple q, long* n) {
  pl_multiple base = {l->num, l->den}, common = common_measure(l->common, q);
  bool more = labs(q.num) * l->most.den > l->most.num * q.den;
  pl_multiple most = more ? (pl_multiple){labs(q.num), q.den} : l->most, fine = {1, common.den};
  if (!in_bases(q, base, n) || !in_bases(most, base, n)) {
    base = in_bases(most, fine, n) ? fine : common;
    if (!in_bases(most, base, n)) return false;
  }
  bool new_base = base.num != l->num || base.den != l->den;
  if (new_base || more || common.num != l->common.num || common.den != l->common.den)
    t->tangled = true;
  l->num = base.num;
  l->den = base.den;
  l->most = most;
  l->common = common;
  if (new_base && l->gen >= 0) pl_tower_restart(t);
  return in_bases(q, base, n);
}

typedef pl_lattice* lattice_of(pl_tower* t, pl_expr atom);

// Among the multiples of an atom that are atoms of their own: the one whose base can serve for this
// multiple too.
static pl_lattice* lattice_apart(pl_tower* t, lattice_of* of, pl_angle_term a, long* n) {
  for (int k = 0; k < of(t, a.atom)->n_apart; k++) {
    const pl_multiple other = of(t, a.atom)->apart[k];
    long num = a.num * other.den, den = other.num * a.den, common = gcd_long(num, den);
    pl_expr atom = pl_mul(t->pool, pl_ratio(t->pool, other.num, other.den), a.atom);
    if (take(t, of(t, atom), (pl_multiple){num / common, den / common}, n)) return of(t, atom);
  }
  return NULL;
}

// The lattice of a multiple of an atom, with *n of its bases. A multiple that fits nowhere becomes
// an atom.
static pl_lattice* lattice_of_multiple(pl_tower* t, lattice_of* of, pl_angle_term a, long* n) {
  if (take(t, of(t, a.atom), (pl_multiple){a.num, a.den}, n)) return of(t, a.atom);
  pl_lattice* l = lattice_apart(t, of, a, n);
  if (l) return l;
  pl_multiple size = {labs(a.num), a.den};
  l = of(t, a.atom);
  // θ after 7 θ: the lattice of θ is for θ, and what it had goes apart
  bool whole = size.num == size.den;
  if (l->n_apart < PL_MAX_APART) l->apart[l->n_apart++] = whole ? l->common : size;
  if (whole) {
    l->num = l->den = 1;
    l->most = l->common = (pl_multiple){1, 1};
    t->tangled = true;
    if (l->gen >= 0) pl_tower_restart(t);
    *n = a.num;
    return l;
  }
  t->tangled = true;
  pl_expr atom = pl_mul(t->pool, pl_ratio(t->pool, size.num, size.den), a.atom);
  if (!take(t, of(t, atom), (pl_multiple){a.num < 0 ? -1 : 1, 1}, n)) pl_tower_give_up(t);
  return of(t, atom);
}

// ------------------------------------------------------------------------------------------- pairs
static int make_pair(pl_tower* t, pl_expr base, bool hyperbolic) {
  pl_gen first = {
      .kind = hyperbolic ? PL_G_SINH : PL_G_COS, .partner = t->gens.n + 1, .class = PL_C_FUNCTION};
  pl_gen second = {.kind = hyperbolic ? PL_G_COSH : PL_G_SIN,
                   .partner = t->gens.n,
                   .class = PL_C_FUNCTION,
                   .degree = 2};
  first.expr = pl_call(t->pool, hyperbolic ? PL_SINH : PL_COS, base);
  second.expr = pl_call(t->pool, hyperbolic ? PL_COSH : PL_SIN, base);
  if (hyperbolic) second.sign = 1;
  if (t->gens.n + 2 > t->capacity) {
    // both or none: let the first one ask for a larger context
    while (t->gens.n < t->capacity) pl_tower_generator(t, &first);
  }
  int gen = pl_tower_generator(t, &first);
  const pl_poly* one = pl_poly_int(t, 1);
  const pl_poly* square = pl_poly_gen_power(t, gen, 2);
  second.value = pl_poly_keep(
      t, hyperbolic ? pl_poly_add(t, one, square) : pl_poly_sub(t, one, square));
  pl_tower_generator(t, &second);
  return gen;
}

static pl_sincos product(pl_tower* t, pl_sincos a, pl_sincos b, bool hyperbolic) {
  pl_frac ss = pl_frac_mul(t, a.s, b.s);
  pl_frac cc = pl_frac_mul(t, a.c, b.c);
  pl_sincos r;
  r.s = pl_frac_add(t, pl_frac_mul(t, a.s, b.c), pl_frac_mul(t, a.c, b.s));
  r.c = hyperbolic ? pl_frac_add(t, cc, ss) : pl_frac_sub(t, cc, ss);
  return r;
}

// Pair of n times the angle, by repeated doubling.
static pl_sincos multiple(pl_tower* t, pl_sincos a, long n, bool hyperbolic) {
  if (n < 0) {
    a.s = pl_frac_neg(t, a.s);
    n = -n;
  }
  pl_sincos r = {pl_frac_int(t, 0), pl_frac_int(t, 1)};
  for (; n > 0; n >>= 1) {
    if (n & 1) r = product(t, r, a, hyperbolic);
    if (n > 1) a = product(t, a, a, hyperbolic);
  }
  return r;
}

// ------------------------------------------------------------------------------------------ angles
// cos and sin of an inverse function of u.
static bool inverse_pair(pl_tower* t, pl_expr atom, pl_sincos* out) {
  if (pl_kind_of(t->pool, atom) != PL_CALL) return false;
  pl_function f = pl_function_of(t->pool, atom);
  if (f != PL_ASIN && f != PL_ACOS && f != PL_ATAN && f != PL_ATAN2) return false;
  pl_frac u = pl_convert(t, pl_arg(t->pool, atom, 0));
  pl_frac x = f == PL_ATAN2 ? pl_convert(t, pl_arg(t->pool, atom, 1)) : pl_frac_int(t, 1);
  pl_frac u2 = pl_frac_mul(t, u, u);
  if (f == PL_ATAN || f == PL_ATAN2) {
    pl_frac r = pl_frac_inv(t, pl_frac_sqrt(t, pl_frac_add(t, pl_frac_mul(t, x, x), u2)));
    *out = (pl_sincos){pl_frac_mul(t, u, r), pl_frac_mul(t, x, r)};
    return true;
  }
  pl_frac other = pl_frac_sqrt(t, pl_frac_sub(t, x, u2));
  *out = f == PL_ASIN ? (pl_sincos){u, other} : (pl_sincos){other, u};
  return true;
}

static pl_sincos pair_of_base(pl_tower* t, pl_lattice* l) {
  if (l->gen < 0) {
    pl_expr atom = l->atom, part = pl_ratio(t->pool, l->num, l->den);
    int gen = make_pair(
        t, pl_add(t->pool, pl_mul(t->pool, part, atom), pl_mul(t->pool, part, l->shift)), false);
    angle_lattice(t, atom)->gen = gen;
    l = angle_lattice(t, atom);
  }
  return (pl_sincos){pl_frac_gen(t, l->gen + 1), pl_frac_gen(t, l->gen)};
}

// Multiples of π that have a value in square roots; false for the others.
static bool special_pair(pl_tower* t, pl_angle_term a, pl_sincos* out) {
  if (pl_kind_of(t->pool, a.atom) != PL_PI) return false;
  if (a.den == 12) {
    // a/12 = a/3 - a/4
    pl_sincos third, quarter;
    if (!special_pair(t, (pl_angle_term){a.num, 3, a.atom}, &third)) return false;
    if (!special_pair(t, (pl_angle_term){-a.num, 4, a.atom}, &quarter)) return false;
    *out = product(t, third, quarter, false);
    return true;
  }
  if (a.den != 1 && a.den != 2 && a.den != 3 && a.den != 4 && a.den != 6) return false;
  pl_expr angle = pl_mul(t->pool, pl_ratio(t->pool, a.num, a.den), a.atom);
  pl_expr s = pl_call(t->pool, PL_SIN, angle), c = pl_call(t->pool, PL_COS, angle);
  if (!pl_is_constant(t->pool, s) || pl_kind_of(t->pool, s) == PL_CALL
      || pl_kind_of(t->pool, c) == PL_CALL)
    return false;
  *out = (pl_sincos){pl_convert(t, s), pl_convert(t, c)};
  return true;
}

static pl_expr term_expr(pl_tower* t, pl_angle_term a) {
  return pl_mul(t->pool, pl_ratio(t->pool, a.num, a.den), a.atom);
}

static bool has_base(pl_tower* t, pl_angle_term a) {
  pl_sincos known;
  return !special_pair(t, a, &known)
         && !(labs(a.num) <= PL_MAX_MULTIPLE && a.den == 1 && inverse_pair(t, a.atom, &known));
}

// The sum of the numbers in an angle, which are taken out of it.  Those whose sine is known in
// square roots stay, and so do all of them where there is nothing else.
static pl_expr take_offset(pl_tower* t, pl_angle* angle) {
  pl_expr offset = pl_int(t->pool, 0);
  pl_angle rest = {0};
  for (int i = 0; i < angle->n; i++) {
    pl_angle_term a = angle->at[i];
    if (pl_is_constant(t->pool, a.atom) && has_base(t, a)) {
      offset = pl_add(t->pool, offset, term_expr(t, a));
    } else {
      rest.at[rest.n++] = a;
    }
  }
  if (rest.n == 0) return pl_int(t->pool, 0);
  *angle = rest;
  return offset;
}

// The first angle of this atom alone tells how its base is shifted.
static void settle_shift(pl_tower* t, pl_lattice* l, long n, pl_expr offset) {
  if (!pl_is_zero_node(t->pool, offset)) pl_tower_start_empty(t);
  if (l->settled || n == 0) return;
  l->settled = true;
  pl_expr shift = pl_mul(t->pool, pl_ratio(t->pool, l->den, l->num * n), offset);
  if (pl_same(shift, l->shift)) return;
  l->shift = shift;
  if (l->gen >= 0) pl_tower_restart(t);
}

// The pair of one term; where its base is shifted, *offset becomes less by as much.
static pl_sincos pair_of_term(pl_tower* t, pl_angle_term a, bool alone, pl_expr* offset) {
  pl_sincos r;
  if (special_pair(t, a, &r)) return r;
  if (a.den == 1 && labs(a.num) <= PL_MAX_MULTIPLE && inverse_pair(t, a.atom, &r))
    return multiple(t, r, a.num, false);
  long n = 0;
  pl_lattice* l = lattice_of_multiple(t, angle_lattice, a, &n);
  if (alone) settle_shift(t, l, n, *offset);
  pl_expr taken = pl_mul(t->pool, pl_ratio(t->pool, l->num * n, l->den), l->shift);
  *offset = pl_sub(t->pool, *offset, taken);
  return multiple(t, pair_of_base(t, l), n, false);
}

static pl_sincos pair_of_number(pl_tower* t, pl_expr number) {
  pl_angle angle;
  split(t, number, false, &angle);
  pl_sincos r = {pl_frac_int(t, 0), pl_frac_int(t, 1)};
  pl_expr none = pl_int(t->pool, 0);
  for (int i = 0; i < angle.n; i++)
    r = product(t, r, pair_of_term(t, angle.at[i], false, &none), false);
  return r;
}

pl_sincos pl_convert_sincos(pl_tower* t, pl_expr argument) {
  pl_angle angle;
  split(t, argument, false, &angle);
  pl_expr offset = take_offset(t, &angle);
  pl_sincos r = {pl_frac_int(t, 0), pl_frac_int(t, 1)};
  for (int i = 0; i < angle.n; i++) {
    r = product(t, r, pair_of_term(t, angle.at[i], angle.n == 1, &offset), false);
  }
  return pl_is_zero_node(t->pool, offset) ? r : product(t, r, pair_of_number(t, offset), false);
}

// --------------------------------------------------------------------------------------- exponents
static pl_sincos hyperbolic_pair(pl_tower* t, pl_lattice* l) {
  if (l->gen < 0) {
    pl_expr atom = l->atom;
    int gen = make_pair(t, pl_mul(t->pool, pl_ratio(t->pool, l->num, l->den), atom), true);
    l = exponent_lattice(t, atom);
    l->gen = gen;
  }
  return (pl_sincos){pl_frac_gen(t, l->gen), pl_frac_gen(t, l->gen + 1)};
}

pl_sincos pl_convert_sinhcosh(pl_tower* t, pl_expr argument) {
  pl_angle angle;
  split(t, argument, false, &angle);
  pl_sincos r = {pl_frac_int(t, 0), pl_frac_int(t, 1)};
  for (int i = 0; i < angle.n; i++) {
    long n = 0;
    pl_lattice* l = lattice_of_multiple(t, exponent_lattice, angle.at[i], &n);
    bool changed = !l->hyperbolic && l->gen >= 0;
    l->hyperbolic = true;
    t->tangled = true;
    if (changed) pl_tower_restart(t);
    r = product(t, r, multiple(t, hyperbolic_pair(t, l), n, true), true);
  }
  return r;
}

// exp(q ln u) = u^q for integers and halves.
static bool power_of_logarithm(pl_tower* t, pl_angle_term a, pl_frac* out) {
  if (a.den > 2 || pl_kind_of(t->pool, a.atom) != PL_CALL
      || pl_function_of(t->pool, a.atom) != PL_LN)
    return false;
  pl_frac u = pl_convert(t, pl_arg(t->pool, a.atom, 0));
  *out = pl_frac_pow(t, a.den == 2 ? pl_frac_sqrt(t, u) : u, a.num);
  return true;
}

static pl_frac exp_of_term(pl_tower* t, pl_angle_term a) {
  pl_frac r;
  if (power_of_logarithm(t, a, &r)) return r;
  pl_lattice* l = exponent_lattice(t, a.atom);
  long n = 0;
  if (l->hyperbolic || l->n_apart > 0) {
    l = lattice_of_multiple(t, exponent_lattice, a, &n);
  } else {
    if (!refine(t, l, a.den, PL_MAX_EXPONENT_DEN)) pl_tower_give_up(t);
    n = a.num * (l->den / a.den);
  }
  if (l->hyperbolic) {
    pl_sincos pair = multiple(t, hyperbolic_pair(t, l), n, true);
    return pl_frac_add(t, pair.c, pair.s);
  }
  if (l->gen < 0) {
    pl_gen g = {.kind = PL_G_EXP, .partner = -1, .class = PL_C_FUNCTION, .sign = 1};
    g.expr = pl_call(t->pool, PL_EXP, pl_mul(t->pool, pl_ratio(t->pool, l->num, l->den), l->atom));
    int gen = pl_tower_generator(t, &g);
    l->gen = gen;
  }
  return pl_frac_pow(t, pl_frac_gen(t, l->gen), n);
}

pl_frac pl_convert_exp(pl_tower* t, pl_expr argument) {
  pl_angle exponent;
  split(t, argument, true, &exponent);
  pl_frac r = pl_frac_int(t, 1);
  for (int i = 0; i < exponent.n; i++) r = pl_frac_mul(t, r, exp_of_term(t, exponent.at[i]));
  return r;
}
