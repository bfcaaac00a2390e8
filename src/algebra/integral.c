// Antiderivatives of sums of x^k exp(a x) cos(b x + c): products of sines and cosines become sums,
// powers of x go by repeated integration by parts. Also (a x + b)^-n. The result is differentiated
// and compared before it is returned.
#include "algebra/tower.h"

enum { PL_MAX_WAVES = 256, PL_MAX_INTEGRAL_DEGREE = 40 };

// coefficient * x^power * exp(exponent) * cos or sin (angle);  angle and exponent linear in x.
typedef struct pl_integral_wave {
  pl_expr coefficient, exponent, angle;
  int power;
  bool sine;
} pl_integral_wave;

typedef struct pl_integral_job {
  pl_expr e;
  pl_symbol x;
  pl_integral_wave at[PL_MAX_WAVES];
  int n;
  pl_expr reciprocal;  // when e is coefficient / linear^degree instead: the linear function
  pl_expr coefficient;
  int degree;
  bool found;
} pl_integral_job;

// ------------------------------------------------------------------------------------ taking apart

// Multiplies waves [from, n) by cos or sin of `angle`.
static void times_wave(pl_tower* t, pl_integral_job* j, int from, pl_expr angle, bool sine) {
  pl_pool* p = t->pool;
  int n = j->n;
  for (int i = from; i < n; i++) {
    pl_integral_wave w = j->at[i], plus = w, minus = w;
    if (j->n == PL_MAX_WAVES) pl_tower_give_up(t);
    pl_expr half = pl_mul(p, pl_ratio(p, 1, 2), w.coefficient);
    plus.angle = pl_add(p, w.angle, angle);
    minus.angle = pl_sub(p, w.angle, angle);
    plus.coefficient = minus.coefficient = half;
    // cos cos = (c- + c+)/2, cos sin = (s+ - s-)/2, sin cos = (s+ + s-)/2, sin sin = (c- - c+)/2
    plus.sine = minus.sine = w.sine != sine;
    if (!w.sine && sine) minus.coefficient = pl_neg(p, half);
    if (w.sine && sine) plus.coefficient = pl_neg(p, half);
    j->at[i] = plus;
    j->at[j->n++] = minus;
  }
}

static void wave_of_term(pl_tower* t, pl_integral_job* j, pl_frac f, slong i) {
  pl_pool* p = t->pool;
  ulong exponent[PL_MAX_GENERATORS];
  fmpz_mpoly_get_term_exp_ui(exponent, f.num, i, &t->ctx);
  if (j->n == PL_MAX_WAVES) pl_tower_give_up(t);
  int from = j->n;
  pl_integral_wave w = {.coefficient = pl_fmpz_expr(t, &f.num->coeffs[i]),
                        .exponent = pl_int(p, 0),
                        .angle = pl_int(p, 0)};
  for (int g = 0; g < t->gens.n; g++) {
    if (exponent[g] == 0) continue;
    const pl_gen* gen = &t->gens.at[g];
    if (gen->symbol.id == j->x.id && gen->kind == PL_G_SYMBOL) {
      if (exponent[g] > PL_MAX_INTEGRAL_DEGREE) pl_tower_give_up(t);
      w.power = (int)exponent[g];
    } else if (!pl_gen_contains(t, g, j->x)) {
      w.coefficient = pl_mul(p, w.coefficient, pl_pow_int(p, gen->expr, (long)exponent[g]));
    } else if (gen->kind == PL_G_EXP) {
      w.exponent = pl_add(p, w.exponent,
                          pl_mul(p, pl_int(p, (long)exponent[g]), pl_arg(p, gen->expr, 0)));
    } else if ((gen->kind != PL_G_COS && gen->kind != PL_G_SIN)
               || pl_kind_of(p, gen->expr) != PL_CALL) {
      pl_tower_give_up(t);
    }
  }
  j->at[j->n++] = w;
  for (int g = 0; g < t->gens.n; g++) {
    const pl_gen gen = t->gens.at[g];
    if ((gen.kind != PL_G_COS && gen.kind != PL_G_SIN) || !pl_gen_contains(t, g, j->x)) continue;
    for (ulong k = 0; k < exponent[g]; k++)
      times_wave(t, j, from, pl_arg(p, gen.expr, 0), gen.kind == PL_G_SIN);
  }
}

// Powers of exp(u) in the denominator are exp(-k u); other factors must be free of x.
static pl_expr constant_den(pl_tower* t, pl_integral_job* j, pl_frac f, pl_expr* exponent) {
  pl_pool* p = t->pool;
  pl_expr den = pl_fmpz_expr(t, f.unit);
  *exponent = pl_int(p, 0);
  for (int i = 0; i < f.n; i++) {
    pl_expr base = pl_base_expr(t, f.den[i].base);
    int gen = t->bases.at[f.den[i].base].gen;
    if (!pl_has_symbol(p, base, j->x)) {
      den = pl_mul(p, den, pl_pow_int(p, base, f.den[i].power));
    } else if (gen >= 0 && t->gens.at[gen].kind == PL_G_EXP) {
      *exponent = pl_sub(p, *exponent, pl_mul(p, pl_int(p, f.den[i].power), pl_arg(p, base, 0)));
    } else {
      pl_tower_give_up(t);
    }
  }
  return den;
}

static void waves_body(pl_tower* t, void* data) {
  pl_integral_job* j = data;
  j->n = 0;
  pl_frac f = pl_convert(t, j->e);
  pl_expr exponent;
  pl_expr den = constant_den(t, j, f, &exponent);
  for (slong i = 0; i < f.num->length; i++) wave_of_term(t, j, f, i);
  for (int i = 0; i < j->n; i++) {
    j->at[i].coefficient = pl_div(t->pool, j->at[i].coefficient, den);
    j->at[i].exponent = pl_add(t->pool, j->at[i].exponent, exponent);
  }
  j->found = true;
}

static void reciprocal_body(pl_tower* t, void* data) {
  pl_integral_job* j = data;
  pl_frac f = pl_convert(t, j->e);
  if (pl_has_symbol(t->pool, pl_poly_expr(t, f.num), j->x)) return;
  pl_expr den = pl_fmpz_expr(t, f.unit);
  j->degree = 0;
  for (int i = 0; i < f.n; i++) {
    pl_expr base = pl_base_expr(t, f.den[i].base);
    if (!pl_has_symbol(t->pool, base, j->x)) {
      den = pl_mul(t->pool, den, pl_pow_int(t->pool, base, f.den[i].power));
    } else if (j->degree == 0) {
      j->reciprocal = base;
      j->degree = f.den[i].power;
    } else {
      return;
    }
  }
  j->coefficient = pl_div(t->pool, pl_poly_expr(t, f.num), den);
  j->found = j->degree > 0;
}

// ------------------------------------------------------------------------------------- integrating
static pl_expr trig(pl_pool* p, pl_expr angle, bool sine) {
  return pl_call(p, sine ? PL_SIN : PL_COS, angle);
}

// a = slope of a linear function of x; false if it is not linear.
static bool slope_of(pl_tower* t, pl_expr e, pl_symbol x, pl_expr* slope) {
  pl_expr c[2] = {pl_int(t->pool, 0), pl_int(t->pool, 0)};
  int d = pl_alg_coefficients(t, e, x, c, 1);
  *slope = d == 1 ? c[1] : pl_int(t->pool, 0);
  return d >= 0;
}

// ∫ x^k F' = x^k F - k ∫ x^(k-1) F, with F = e^u (α cos φ + a sin φ)/(α² + a²) for F' = e^u cos φ,
// and likewise for sin.
static pl_expr integrate_wave(pl_tower* t, pl_integral_wave w, pl_expr alpha, pl_expr a,
                              pl_symbol x) {
  pl_pool* p = t->pool;
  pl_expr X = pl_sym(p, x);
  bool flat = pl_is_zero_node(p, alpha) && pl_is_zero_node(p, a);
  if (flat) {
    pl_expr constant = pl_mul_n(
        p, (pl_expr[]){w.coefficient, pl_call(p, PL_EXP, w.exponent), trig(p, w.angle, w.sine)}, 3);
    return pl_div(p, pl_mul(p, constant, pl_pow_int(p, X, w.power + 1)), pl_int(p, w.power + 1));
  }
  pl_expr size = pl_add(p, pl_square(p, alpha), pl_square(p, a));
  pl_integral_wave same = w, other = w;
  same.coefficient = pl_div(p, pl_mul(p, w.coefficient, alpha), size);
  other.coefficient = pl_div(p, pl_mul(p, w.coefficient, w.sine ? pl_neg(p, a) : a), size);
  other.sine = !w.sine;
  pl_expr envelope = pl_mul(p, pl_pow_int(p, X, w.power), pl_call(p, PL_EXP, w.exponent));
  pl_expr F = pl_add(p, pl_mul(p, same.coefficient, trig(p, w.angle, same.sine)),
                     pl_mul(p, other.coefficient, trig(p, w.angle, other.sine)));
  pl_expr result = pl_mul(p, envelope, F);
  if (w.power == 0) return result;
  pl_expr factor = pl_int(p, -w.power);
  same.power = other.power = w.power - 1;
  same.coefficient = pl_mul(p, factor, same.coefficient);
  other.coefficient = pl_mul(p, factor, other.coefficient);
  if (!pl_is_zero_node(p, same.coefficient))
    result = pl_add(p, result, integrate_wave(t, same, alpha, a, x));
  if (!pl_is_zero_node(p, other.coefficient))
    result = pl_add(p, result, integrate_wave(t, other, alpha, a, x));
  return result;
}

static pl_expr integrate_waves(pl_tower* t, pl_integral_job* j) {
  pl_expr sum = pl_int(t->pool, 0);
  for (int i = 0; i < j->n; i++) {
    pl_integral_wave w = j->at[i];
    pl_expr alpha, a;
    w.angle = pl_alg_normal(t, w.angle);
    if (w.sine && pl_is_zero_node(t->pool, w.angle)) continue;
    if (!slope_of(t, w.exponent, j->x, &alpha) || !slope_of(t, w.angle, j->x, &a))
      return pl_poison();
    // by parts doubles the number of terms each time when both slopes are there
    bool doubles = !pl_is_zero_node(t->pool, alpha) && !pl_is_zero_node(t->pool, a);
    if (doubles && w.power > 8) return pl_poison();
    sum = pl_add(t->pool, sum, integrate_wave(t, w, alpha, a, j->x));
  }
  return sum;
}

// c / (a x + b)^n
static pl_expr integrate_reciprocal(pl_tower* t, const pl_integral_job* j) {
  pl_pool* p = t->pool;
  pl_expr a;
  pl_expr c[2];
  if (pl_alg_coefficients(t, j->reciprocal, j->x, c, 1) != 1) return pl_poison();
  a = c[1];
  pl_expr factor = pl_div(p, j->coefficient, a);
  if (j->degree == 1)
    return pl_mul(p, factor, pl_call(p, PL_LN, pl_call(p, PL_ABS, j->reciprocal)));
  return pl_mul(p, pl_div(p, factor, pl_int(p, 1 - j->degree)),
                pl_pow_int(p, j->reciprocal, 1 - j->degree));
}

pl_expr pl_alg_integral(pl_tower* t, pl_expr e, pl_symbol x) {
  if (pl_is_poison(e)) return e;
  pl_expr X = pl_sym(t->pool, x);
  if (!pl_has_symbol(t->pool, e, x)) return pl_mul(t->pool, e, X);
  pl_integral_job* j = PL_NEW(t->arena, pl_integral_job);
  *j = (pl_integral_job){.e = e, .x = x};
  pl_expr result = pl_poison();
  if (pl_tower_run(t, waves_body, j) && j->found) {
    result = pl_alg_normal(t, integrate_waves(t, j));
  } else if (pl_tower_run(t, reciprocal_body, j) && j->found) {
    result = integrate_reciprocal(t, j);
  }
  if (pl_is_poison(result)) return result;
  return pl_alg_equal(t, pl_diff(t->pool, result, x), e) == PL_NO ? pl_poison() : result;
}
