// conditions: e > 0 or e >= 0 in its shortest form. What is positive anyway is divided out,
// negative terms go to the other side:
//   m R (g - R ω²) > 0  becomes  ω² < g/R,    1 - M²/(m² g² r²) >= 0  becomes  |M| <= m g r.
#include "mechanics/mechanics.h"

enum { max_factors = 16, max_terms = 64 };

// Two sides without negative signs: more > less, or more >= less.
typedef struct pl_two_sides {
  pl_expr more, less;
  int n_more, n_less;
} pl_two_sides;

static bool is_positive(pl_analysis* d, pl_expr e) {
  int sign = 0;
  return pl_alg_sign_proven(d->tower, e, false, &sign) == PL_YES && sign > 0;
}

static bool is_negative_term(pl_pool* p, pl_expr term) {
  pl_expr first = pl_kind_of(p, term) == PL_MUL ? pl_arg(p, term, 0) : term;
  return pl_is_number(p, first) && pl_number_sign(p, first) < 0;
}

static pl_two_sides sides_of(pl_analysis* d, pl_expr e) {
  pl_pool* p = d->pool;
  e = pl_expand(p, e, max_terms);
  bool is_sum = pl_kind_of(p, e) == PL_ADD;
  int n = is_sum ? pl_n_args(p, e) : 1;
  pl_two_sides s = {pl_int(p, 0), pl_int(p, 0), 0, 0};
  for (int k = 0; k < n; k++) {
    pl_expr term = is_sum ? pl_arg(p, e, k) : e;
    if (is_negative_term(p, term)) {
      s.less = pl_add(p, s.less, pl_neg(p, term));
      s.n_less++;
    } else {
      s.more = pl_add(p, s.more, term);
      s.n_more++;
    }
  }
  return s;
}

// What is left of e when factors of known sign are divided out: its sign, or *sign = 0 where it
// vanishes.
static pl_expr open_part(pl_analysis* d, pl_expr e, bool strict, int* sign) {
  pl_factor factor[max_factors];
  pl_expr unit, rest = pl_int(d->pool, 1);
  int n = pl_alg_factors(d->tower, e, factor, max_factors, &unit);
  *sign = pl_is_number(d->pool, unit) ? pl_number_sign(d->pool, unit) : 1;
  for (int k = 0; k < n; k++) {
    int own = 0;
    bool even = factor[k].power % 2 == 0;
    if (even && (!strict || factor[k].power < 0)) continue;
    bool known = pl_alg_sign_proven(d->tower, factor[k].base, factor[k].power < 0, &own) == PL_YES;
    if (known && !even) *sign *= own;
    // √P > 0 where P > 0
    pl_expr base = pl_is_sqrt(d->pool, factor[k].base) ? pl_arg(d->pool, factor[k].base, 0)
                                                       : factor[k].base;
    if (!known) rest = pl_mul(d->pool, rest, even ? pl_square(d->pool, base) : base);
  }
  return rest;
}

// The root of a product of even powers and a square number; poison of anything else. Signs go with
// |.|.
static pl_expr root_of_square(pl_analysis* d, pl_expr e) {
  pl_pool* p = d->pool;
  pl_expr root = pl_int(p, 1);
  int n = pl_kind_of(p, e) == PL_MUL ? pl_n_args(p, e) : 1;
  for (int k = 0; k < n; k++) {
    pl_expr factor = pl_kind_of(p, e) == PL_MUL ? pl_arg(p, e, k) : e;
    long power = 0;
    if (pl_is_number(p, factor)) {
      pl_expr own = pl_sqrt(p, factor);
      if (!pl_is_number(p, own)) return pl_poison();
      root = pl_mul(p, root, own);
    } else if (pl_kind_of(p, factor) == PL_POW && pl_is_int(p, pl_arg(p, factor, 1), &power)
               && power % 2 == 0) {
      pl_expr half = pl_pow_int(p, pl_arg(p, factor, 0), power / 2);
      root = pl_mul(p, root,
                    power / 2 % 2 == 0 || is_positive(d, half) ? half : pl_call(p, PL_ABS, half));
    } else {
      return pl_poison();
    }
  }
  return root;
}

// The highest power of a symbol in a single term: its exponent.
static int highest_power(pl_pool* p, pl_expr term, pl_expr* base) {
  int best = 1, n = pl_kind_of(p, term) == PL_MUL ? pl_n_args(p, term) : 1;
  for (int k = 0; k < n; k++) {
    pl_expr factor = pl_kind_of(p, term) == PL_MUL ? pl_arg(p, term, k) : term;
    long power = 0;
    bool is_power = pl_kind_of(p, factor) == PL_POW
                    && pl_kind_of(p, pl_arg(p, factor, 0)) == PL_SYMBOL;
    if (!is_power || !pl_is_int(p, pl_arg(p, factor, 1), &power) || power <= best) continue;
    best = (int)power;
    *base = pl_arg(p, factor, 0);
  }
  return best;
}

// a > b with one term on each side, all positive: the highest power alone, R ω² > g as ω² > g/R.
static bool isolate(pl_analysis* d, pl_expr* a, pl_expr* b) {
  pl_pool* p = d->pool;
  pl_expr base = pl_poison();
  int power = highest_power(p, *a, &base);
  if (power < 2 || pl_has_symbol(p, *b, pl_symbol_of(p, base))) return false;
  pl_expr alone = pl_pow_int(p, base, power), others = pl_div(p, *a, alone);
  if (!is_positive(d, others)) return false;
  *a = alone;
  *b = pl_div(p, *b, others);
  return true;
}

pl_answer3 pl_holds_if(pl_analysis* d, pl_expr e, bool strict, pl_inequality* out) {
  pl_pool* p = d->pool;
  int sign = 0;
  pl_expr rest = open_part(d, pl_alg_normal(d->tower, e), strict, &sign);
  if (pl_is_one_node(p, rest) || sign == 0)
    return sign > 0 || (sign == 0 && !strict) ? PL_YES : PL_NO;
  pl_two_sides s = sides_of(d, sign > 0 ? rest : pl_neg(p, rest));
  bool turned = false;
  if (s.n_more == 1 && s.n_less == 1) {
    pl_expr more = root_of_square(d, s.more), less = root_of_square(d, s.less);
    if (!pl_is_poison(more) && !pl_is_poison(less)) {
      s.more = more;
      s.less = less;
      turned = pl_kind_of(p, less) == PL_CALL || pl_has_coordinates(d, less);
    } else if (!isolate(d, &s.more, &s.less)) {
      turned = isolate(d, &s.less, &s.more);
    }
  }
  if (s.n_more == 0) turned = true;
  *out = (pl_inequality){.more = s.more, .less = s.less, .strict = strict, .turned = turned};
  return PL_UNKNOWN;
}

bool pl_conditions_exclude(pl_analysis* d, pl_expr real, pl_expr positive) {
  int sign_real = 0, sign_positive = 0;
  pl_expr a = open_part(d, real, true, &sign_real),
          b = open_part(d, positive, true, &sign_positive);
  if (sign_real == 0 || sign_positive == 0) return false;
  pl_expr sum = pl_add(d->pool, pl_mul(d->pool, pl_int(d->pool, sign_real), a),
                       pl_mul(d->pool, pl_int(d->pool, sign_positive), b));
  return pl_alg_is_zero(d->tower, sum) == PL_YES;
}
