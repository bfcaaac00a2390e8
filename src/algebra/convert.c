// From expressions into the tower. Every node is converted once and remembered; arguments of
// functions are brought to normal form first, so that sin(2(a - b)) and sin(2a - 2b) meet.
//
// What has no algebra here (sums over an index, x^a, functions of two arguments) becomes a formal
// generator: two of them are equal when their normalised arguments are. That can miss a relation,
// never invent one.
#include "algebra/tower.h"

static pl_frac convert_node(pl_tower* t, pl_expr e);

pl_frac pl_convert(pl_tower* t, pl_expr e) {
  uint64_t known = pl_map_get(t->converted, e.id);
  if (known) return t->fractions.at[known - 1];
  if (++t->depth > PL_MAX_DEPTH) pl_tower_give_up(t);
  pl_tower_check(t);
  pl_frac f = pl_frac_keep(t, convert_node(t, e));
  t->depth--;
  pl_push(t->arena, t->fractions, f);
  pl_map_set(t->converted, e.id, (uint64_t)t->fractions.n);
  return f;
}

void pl_convert_known(pl_tower* t, pl_expr e, pl_frac f) {
  if (pl_is_poison(e) || pl_map_get(t->converted, e.id)) return;
  // with roots the way decides where they stand; a formula must not depend on what was asked before
  for (int g = 0; g < t->gens.n; g++)
    if (t->gens.at[g].kind == PL_G_ROOT) return;
  pl_frac kept = pl_frac_keep(t, f);
  pl_push(t->arena, t->fractions, kept);
  pl_map_set(t->converted, e.id, (uint64_t)t->fractions.n);
}

static pl_expr normal(pl_tower* t, pl_expr e) { return pl_frac_expr(t, pl_convert(t, e)); }

// ------------------------------------------------------------------------------------------ leaves
static pl_frac convert_number(pl_tower* t, pl_expr e) {
  long num = 0, den = 1;
  fmpz* n = pl_int_new(t);
  fmpz* d = pl_int_new(t);
  if (pl_is_ratio(t->pool, e, &num, &den)) {
    fmpz_set_si(n, num);
    fmpz_set_si(d, den);
  } else {
    fmpz_set_str(n, pl_number_num_text(t->arena, t->pool, e), 10);
    fmpz_set_str(d, pl_number_den_text(t->arena, t->pool, e), 10);
  }
  return pl_frac_ratio(t, n, d);
}

static int sign_of_info(pl_sign_known s) {
  switch (s) {
    case PL_SIGN_POSITIVE: return 1;
    case PL_SIGN_NONNEGATIVE: return 2;
    case PL_SIGN_NEGATIVE: return -1;
    case PL_SIGN_NONPOSITIVE: return -2;
    default: return 0;
  }
}

static pl_frac convert_symbol(pl_tower* t, pl_expr e) {
  int known = pl_tower_find(t, e);
  if (known >= 0) return pl_frac_gen(t, known);
  pl_gen g = {.kind = PL_G_SYMBOL, .expr = e, .partner = -1};
  const pl_symbol_info* info = pl_symbol_get(t->pool, pl_symbol_of(t->pool, e));
  g.class = info->class;
  if (pl_kind_of(t->pool, e) == PL_SYMBOL) {
    g.symbol = pl_symbol_of(t->pool, e);
    g.sign = sign_of_info(info->sign);
  }
  return pl_frac_gen(t, pl_tower_generator(t, &g));
}

pl_frac pl_formal(pl_tower* t, pl_expr e) {
  int known = pl_tower_find(t, e);
  if (known >= 0) return pl_frac_gen(t, known);
  pl_gen g = {.kind = PL_G_FORMAL, .expr = e, .partner = -1, .class = PL_C_FUNCTION};
  if (pl_kind_of(t->pool, e) == PL_PI) {
    g.sign = 1;
    g.class = PL_C_NUMBER;
  }
  return pl_frac_gen(t, pl_tower_generator(t, &g));
}

// ------------------------------------------------------------------------------- sums and products
// Halving keeps the intermediate sums balanced: a sum of n terms costs n log n, not n^2.
static pl_frac convert_sum(pl_tower* t, pl_expr e, int from, int to) {
  if (to - from == 1) return pl_convert(t, pl_arg(t->pool, e, from));
  int middle = from + (to - from) / 2;
  pl_frac left = convert_sum(t, e, from, middle);
  return pl_frac_add(t, left, convert_sum(t, e, middle, to));
}

static pl_frac convert_product(pl_tower* t, pl_expr e, int from, int to) {
  if (to - from == 1) return pl_convert(t, pl_arg(t->pool, e, from));
  int middle = from + (to - from) / 2;
  pl_frac left = convert_product(t, e, from, middle);
  return pl_frac_mul(t, left, convert_product(t, e, middle, to));
}

// ------------------------------------------------------------------------------------------ powers
// base^(p/q), q > 2: a generator w with w^q = base.
static pl_frac convert_root(pl_tower* t, pl_frac base, long p, long q) {
  pl_expr w = pl_pow(t->pool, pl_frac_expr(t, base), pl_ratio(t->pool, 1, q));
  int gen = pl_tower_find(t, w);
  if (gen < 0) {
    if (base.n > 0 || !fmpz_is_one(base.unit) || q > PL_MAX_POWER
        || pl_kind_of(t->pool, w) != PL_POW) {
      return pl_frac_pow(t, pl_formal(t, w), p);
    }
    pl_gen g = {.kind = PL_G_ROOT, .expr = w, .partner = -1, .class = PL_C_FUNCTION, .sign = 2};
    g.degree = (int)q;
    g.value = pl_poly_keep(t, base.num);
    gen = pl_tower_generator(t, &g);
  }
  return pl_frac_pow(t, pl_frac_gen(t, gen), p);
}

static pl_frac convert_power(pl_tower* t, pl_expr e) {
  pl_expr base = pl_arg(t->pool, e, 0), exponent = pl_arg(t->pool, e, 1);
  long p = 0, q = 1;
  if (!pl_is_ratio(t->pool, exponent, &p, &q)) {
    pl_expr b = normal(t, base), x = normal(t, exponent);
    if (pl_is_number(t->pool, x)) {
      pl_expr simpler = pl_pow(t->pool, b, x);
      if (!pl_same(simpler, e)) return pl_convert(t, simpler);
    }
    return pl_formal(t, pl_pow(t->pool, b, x));
  }
  pl_frac b = pl_convert(t, base);
  if (q == 1) return pl_frac_pow(t, b, p);
  if (pl_frac_is_zero(t, b)) {
    if (p < 0) pl_tower_give_up(t);
    return b;
  }
  if (q == 2) return pl_frac_pow(t, pl_frac_sqrt(t, b), p);
  return convert_root(t, b, p, q);
}

// --------------------------------------------------------------------------------------- functions
static pl_frac one_plus_minus_abs(pl_tower* t, pl_frac a, pl_frac b, long sign) {
  // max, min = (a + b +- |a - b|)/2
  pl_frac size = pl_frac_abs(t, pl_frac_sub(t, a, b));
  pl_frac sum = pl_frac_add(t, pl_frac_add(t, a, b), sign > 0 ? size : pl_frac_neg(t, size));
  return pl_frac_div(t, sum, pl_frac_int(t, 2));
}

static pl_frac convert_sign(pl_tower* t, pl_frac a) {
  if (pl_frac_is_zero(t, a)) return a;
  return pl_frac_div(t, pl_frac_abs(t, a), a);
}

static pl_frac convert_call2(pl_tower* t, pl_function f, pl_expr a, pl_expr b) {
  if (f == PL_MAX) return one_plus_minus_abs(t, pl_convert(t, a), pl_convert(t, b), 1);
  if (f == PL_MIN) return one_plus_minus_abs(t, pl_convert(t, a), pl_convert(t, b), -1);
  pl_expr call = pl_call2(t->pool, f, normal(t, a), normal(t, b));
  return pl_kind_of(t->pool, call) == PL_CALL ? pl_formal(t, call) : pl_convert(t, call);
}

static bool is_odd(pl_pool* p, pl_function f, pl_expr a) {
  return pl_same(pl_call(p, f, pl_neg(p, a)), pl_neg(p, pl_call(p, f, a)));
}

// Functions without relations to others (asin, acos, atan) of a normalised argument; the odd ones
// with a normalised sign, acos(-u) = π - acos(u).
static pl_frac convert_formal(pl_tower* t, pl_function f, pl_expr argument) {
  pl_frac u = pl_convert(t, argument);
  bool flip = pl_poly_leading_sign(t, u.num) < 0 && (f == PL_ACOS || is_odd(t->pool, f, argument));
  pl_expr call = pl_call(t->pool, f, pl_frac_expr(t, flip ? pl_frac_neg(t, u) : u));
  pl_frac value = pl_kind_of(t->pool, call) == PL_CALL ? pl_formal(t, call) : pl_convert(t, call);
  if (!flip) return value;
  value = pl_frac_neg(t, value);
  return f == PL_ACOS ? pl_frac_add(t, pl_formal(t, pl_pi(t->pool)), value) : value;
}

static pl_frac convert_call(pl_tower* t, pl_expr e) {
  pl_function f = pl_function_of(t->pool, e);
  pl_expr a = pl_arg(t->pool, e, 0);
  pl_sincos pair;
  switch (f) {
    case PL_SIN: return pl_convert_sincos(t, a).s;
    case PL_COS: return pl_convert_sincos(t, a).c;
    case PL_TAN: pair = pl_convert_sincos(t, a); return pl_frac_div(t, pair.s, pair.c);
    case PL_SINH: return pl_convert_sinhcosh(t, a).s;
    case PL_COSH: return pl_convert_sinhcosh(t, a).c;
    case PL_TANH: pair = pl_convert_sinhcosh(t, a); return pl_frac_div(t, pair.s, pair.c);
    case PL_EXP: return pl_convert_exp(t, a);
    case PL_LN: return pl_frac_ln(t, pl_convert(t, a));
    case PL_ABS: return pl_frac_abs(t, pl_convert(t, a));
    case PL_SIGN: return convert_sign(t, pl_convert(t, a));
    case PL_ATAN2:
    case PL_MIN:
    case PL_MAX: return convert_call2(t, f, a, pl_arg(t->pool, e, 1));
    default: return convert_formal(t, f, a);
  }
}

// if: decided when the sign of the condition is known.
static pl_frac convert_if(pl_tower* t, pl_expr e) {
  pl_expr condition = pl_arg(t->pool, e, 0);
  pl_frac c = pl_convert(t, condition);
  const pl_poly* signed_part = pl_poly_mul(t, c.num, pl_frac_den(t, c));
  int sign = pl_poly_sign(t, signed_part, true, false);
  if (sign == 0 || sign == -1) return pl_convert(t, pl_arg(t->pool, e, 2));
  if (pl_poly_sign(t, signed_part, false, false) == 1) return pl_convert(t, pl_arg(t->pool, e, 1));
  pl_expr then = normal(t, pl_arg(t->pool, e, 1)), otherwise = normal(t, pl_arg(t->pool, e, 2));
  pl_expr choice = pl_if(t->pool, pl_frac_expr(t, c), then, otherwise);
  return pl_kind_of(t->pool, choice) == PL_IF ? pl_formal(t, choice) : pl_convert(t, choice);
}

static pl_frac convert_node(pl_tower* t, pl_expr e) {
  switch (pl_kind_of(t->pool, e)) {
    case PL_NUMBER: return convert_number(t, e);
    case PL_SYMBOL:
    case PL_AT: return convert_symbol(t, e);
    case PL_PI: return pl_formal(t, e);
    case PL_ADD: return convert_sum(t, e, 0, pl_n_args(t->pool, e));
    case PL_MUL: return convert_product(t, e, 0, pl_n_args(t->pool, e));
    case PL_POW: return convert_power(t, e);
    case PL_CALL: return convert_call(t, e);
    case PL_IF: return convert_if(t, e);
    case PL_UNKNOWN_FUNCTION:
    case PL_SUM: return pl_formal(t, e);
    default: pl_tower_give_up(t);
  }
}
