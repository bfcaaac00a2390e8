// Products and powers: flat, like factors collected, sorted; numbers and their roots in one
// canonical form.
//
// Numbers: n^(k/q) is written c * N^(r/q) with an integer N > 1 and 0 < r/q < 1, so 1/sqrt(2) is
// sqrt(2)/2; roots of numbers with the same exponent are merged, so sqrt(2) sqrt(6) is 2 sqrt(3).
// In front of something else the number stays under the root, but for its squares: sqrt(12 x) is 2
// sqrt(3 x).
#include "expr/expr_impl.h"

#include <string.h>

typedef struct factor {
  pl_expr base, exponent;
  pl_expr whole;  // the factor as it was, poison when the exponent was changed
} factor;

typedef struct product {
  pl_pool* p;
  PL_TEMP(factor) factors;
  pl_expr number;
  pl_expr exp_argument;  // exp(a) exp(b) = exp(a + b): the sum so far
  int n_exp;             // factors that went into it
  bool infinite, poison;
} product;

// ---------------------------------------------------------------------------------------- products
static void product_put_number(product* f, pl_expr x) {
  f->number = pl_number_mul(f->p, f->number, x);
  if (f->number.id == 0) {
    f->poison = true;
    f->number = f->p->one;
  }
}

static bool is_exp(const pl_pool* p, pl_expr e) {
  return pl_kind_of(p, e) == PL_CALL && pl_function_of(p, e) == PL_EXP;
}

static void product_put(product* f, pl_expr e) {
  pl_pool* p = f->p;
  switch (pl_kind_of(p, e)) {
    case PL_POISON: f->poison = true; return;
    case PL_NUMBER: product_put_number(f, e); return;
    case PL_INFINITY: f->infinite = true; return;
    case PL_MUL:
      for (int i = 0, n = pl_n_args(p, e); i < n; i++) product_put(f, pl_arg(p, e, i));
      return;
    default: break;
  }
  if (is_exp(p, e)) {
    f->exp_argument = f->n_exp++ ? pl_add(p, f->exp_argument, pl_arg(p, e, 0)) : pl_arg(p, e, 0);
    return;
  }
  pl_temp_push(p, f->factors, (factor){pl_base_of(p, e), pl_exponent_of(p, e), e});
}

static bool factor_less(const void* a, const void* b, const void* user) {
  const factor *x = a, *y = b;
  return x->base.id != y->base.id && pl_compare_factors(user, &x->base, 1, &y->base, 1) < 0;
}

// Roots of two numbers with the same exponent: their bases may be multiplied.
static bool roots_match(const pl_pool* p, const factor* x, const factor* y) {
  return pl_is_number(p, x->base) && pl_is_number(p, y->base) && x->exponent.id == y->exponent.id
         && pl_is_number(p, x->exponent) && !pl_number_is_integer(p, x->exponent);
}

// Tells whether any were found: their products may have to be sorted and simplified once more.
static bool merge_roots(product* f) {
  pl_pool* p = f->p;
  bool merged = false;
  for (int i = 0; i < f->factors.n; i++) {
    for (int k = i + 1; k < f->factors.n && pl_is_number(p, f->factors.at[k].base); k++) {
      factor *x = &f->factors.at[i], *y = &f->factors.at[k];
      if (!roots_match(p, x, y)) continue;
      merged = true;
      x->base = pl_number_mul(p, x->base, y->base);
      x->whole = pl_poison();
      memmove(y, y + 1, (size_t)(f->factors.n - k - 1) * sizeof *y);
      f->factors.n--;
      k--;
      if (x->base.id == 0) {
        f->poison = true;
        x->base = p->one;
      }
    }
  }
  return merged;
}

// Neighbours with the same base become one power.
static void collect_powers(product* f) {
  int n = 0;
  for (int i = 0, k; i < f->factors.n; i = k) {
    factor x = f->factors.at[i];
    for (k = i + 1; k < f->factors.n && f->factors.at[k].base.id == x.base.id; k++) {
      x.exponent = pl_add(f->p, x.exponent, f->factors.at[k].exponent);
      x.whole = pl_poison();
    }
    f->factors.at[n++] = x;
  }
  f->factors.n = n;
}

// A power that came out of the collection is what it was taken for: the same base, nothing more to
// flatten.
static bool is_settled(const pl_pool* p, pl_expr e, pl_expr base) {
  pl_kind k = pl_kind_of(p, e);
  if (k == PL_NUMBER || k == PL_MUL || k == PL_POISON || is_exp(p, e)) return false;
  return pl_base_of(p, e).id == base.id;
}

static pl_expr product_node(pl_pool* p, pl_expr number, const pl_exprs* factors) {
  if (factors->n == 0) return number;
  if (number.id == p->one.id && factors->n == 1) return factors->at[0];
  pl_exprs args = {0};
  if (number.id != p->one.id) pl_temp_push(p, args, number);
  for (int i = 0; i < factors->n; i++) pl_temp_push(p, args, factors->at[i]);
  pl_expr e = pl_node_make(p, PL_MUL, 0, 0, 0, args.at, args.n);
  pl_temp_free(p, args);
  return e;
}

static pl_expr product_value(product* f, bool again) {
  pl_pool* p = f->p;
  pl_exprs out = {0};
  for (int i = 0; i < f->factors.n; i++) {
    factor* x = &f->factors.at[i];
    pl_expr e = x->whole.id != 0 ? x->whole : pl_pow(p, x->base, x->exponent);
    again = again || (x->whole.id == 0 && !is_settled(p, e, x->base));
    pl_temp_push(p, out, e);
  }
  pl_expr e;
  if (again) {
    pl_temp_push(p, out, f->number);
    e = pl_mul_n(p, out.at, out.n);
  } else {
    e = product_node(p, f->number, &out);
  }
  pl_temp_free(p, out);
  return e;
}

static pl_expr infinite_product(product* f) {
  pl_pool* p = f->p;
  int sign = pl_number_sign(p, f->number);
  if (sign == 0) return pl_poison();
  if (f->factors.n == 0) f->number = sign > 0 ? p->one : p->minus_one;
  pl_expr infinity = pl_infinity(p);
  pl_temp_push(p, f->factors, (factor){infinity, p->one, infinity});
  pl_sort(p, f->factors.at, f->factors.n, sizeof *f->factors.at, factor_less, p);
  return product_value(f, false);
}

pl_expr pl_mul_n(pl_pool* p, const pl_expr* factors, int n) {
  product f = {.p = p, .number = p->one};
  for (int i = 0; i < n; i++) product_put(&f, factors[i]);
  if (f.n_exp > 0) {
    pl_expr e = pl_call(p, PL_EXP, f.exp_argument);
    if (is_exp(p, e)) pl_temp_push(p, f.factors, (factor){e, p->one, e});
    else product_put(&f, e);
  }
  pl_expr e = pl_poison();
  if (!f.poison && f.infinite) {
    e = infinite_product(&f);
  } else if (!f.poison && f.number.id == p->zero.id) {
    e = p->zero;
  } else if (!f.poison) {
    pl_sort(p, f.factors.at, f.factors.n, sizeof *f.factors.at, factor_less, p);
    collect_powers(&f);
    bool again = merge_roots(&f);
    if (!f.poison) e = product_value(&f, again);
  }
  pl_temp_free(p, f.factors);
  return e;
}

pl_expr pl_mul(pl_pool* p, pl_expr a, pl_expr b) {
  if (a.id == p->one.id) return b;
  if (b.id == p->one.id) return a;
  return pl_mul_n(p, (pl_expr[]){a, b}, 2);
}

pl_expr pl_div(pl_pool* p, pl_expr a, pl_expr b) {
  return pl_mul(p, a, pl_pow(p, b, p->minus_one));
}

// ------------------------------------------------------------------------------- powers of numbers
static pl_expr raw_power(pl_pool* p, pl_expr base, pl_expr exponent) {
  if (exponent.id == p->one.id) return base;
  return pl_node_make(p, PL_POW, 0, 0, 0, (pl_expr[]){base, exponent}, 2);
}

// Roots beyond this order stay as they were written.
enum { MAX_ROOT = 64 };

// number^(k/q) with 0 < k/q < 1 and number > 0: outside * N^(k/q), N an integer.
//   (n/d)^(k/q) = (n d^(q-1))^(k/q) / d^k
static pl_expr root_of_number(pl_pool* p, pl_expr x, pl_expr exponent, long k, long q) {
  pl_expr d = pl_number_den(p, x);
  pl_expr widened = pl_number_pow(p, d, q - 1);
  if (widened.id != 0) widened = pl_number_mul(p, pl_number_num(p, x), widened);
  if (widened.id == 0) return raw_power(p, x, exponent);
  pl_expr outside, inside;
  pl_number_split_root(p, widened, (int)q, &outside, &inside);
  pl_expr factor_out = pl_number_mul(p, pl_number_pow(p, outside, k),
                                     pl_number_pow(p, pl_number_inv(p, d), k));
  if (factor_out.id == 0) return raw_power(p, x, exponent);
  if (inside.id == p->one.id) return factor_out;
  pl_expr root = raw_power(p, inside, exponent);
  if (factor_out.id == p->one.id) return root;
  return pl_node_make(p, PL_MUL, 0, 0, 0, (pl_expr[]){factor_out, root}, 2);
}

static pl_expr number_to_number(pl_pool* p, pl_expr base, pl_expr exponent) {
  long n, k, q;
  if (pl_is_int(p, exponent, &n)) {
    pl_expr e = pl_number_pow(p, base, n);
    // 0^-1 is poison; what is too large stays as written
    if (e.id != 0 || base.id == p->zero.id) return e;
    return raw_power(p, base, exponent);
  }
  int sign = pl_number_sign(p, base);
  if (sign < 0)
    return pl_number_is_integer(p, exponent) ? raw_power(p, base, exponent) : pl_poison();
  if (sign == 0) return pl_number_sign(p, exponent) > 0 ? base : pl_poison();
  if (base.id == p->one.id) return base;
  if (!pl_is_ratio(p, exponent, &k, &q) || q > MAX_ROOT) return raw_power(p, base, exponent);

  // the whole part of the exponent, then what is left between 0 and 1
  pl_expr whole = pl_number_floor(p, exponent);
  pl_expr left = pl_number_add(p, exponent, pl_number_mul(p, whole, p->minus_one));
  pl_expr power = pl_is_int(p, whole, &n) ? pl_number_pow(p, base, n) : pl_poison();
  if (power.id == 0 || !pl_is_ratio(p, left, &k, &q)) return raw_power(p, base, exponent);
  pl_expr root = root_of_number(p, base, left, k, q);
  if (pl_kind_of(p, root) == PL_POW && pl_arg(p, root, 0).id == base.id
      && !pl_number_is_integer(p, base)) {
    return raw_power(p, base, exponent);  // the base was too large to be made an integer
  }
  return pl_mul(p, power, root);
}

// ------------------------------------------------------------------------------ powers of products
static pl_expr power_of_each(pl_pool* p, pl_expr base, pl_expr n) {
  pl_exprs factors = {0};
  for (int i = 0, m = pl_n_args(p, base); i < m; i++)
    pl_temp_push(p, factors, pl_pow(p, pl_arg(p, base, i), n));
  pl_expr e = pl_mul_n(p, factors.at, factors.n);
  pl_temp_free(p, factors);
  return e;
}

// (c x)^(k/q), c a number: the q-th powers in c come out.  Poison when nothing comes out.
static pl_expr power_of_scaled(pl_pool* p, pl_expr base, pl_expr exponent) {
  long k, q;
  pl_term t = pl_term_of(p, base);
  if (t.coefficient.id == p->one.id || !pl_is_ratio(p, exponent, &k, &q) || q > MAX_ROOT)
    return pl_poison();
  pl_expr sign = pl_number_sign(p, t.coefficient) < 0 ? p->minus_one : p->one;
  pl_expr c = pl_number_mul(p, t.coefficient, sign);
  pl_expr top_out, top_in, low_out, low_in;
  pl_number_split_root(p, pl_number_num(p, c), (int)q, &top_out, &top_in);
  pl_number_split_root(p, pl_number_den(p, c), (int)q, &low_out, &low_in);
  pl_expr outside = pl_number_mul(p, top_out, pl_number_inv(p, low_out));
  if (outside.id == p->one.id) return pl_poison();
  pl_expr power = pl_number_pow(p, outside, k);
  if (power.id == 0) return power;
  pl_expr inside = pl_number_mul(p, pl_number_mul(p, top_in, pl_number_inv(p, low_in)), sign);
  pl_expr rest = pl_mul(p, inside, pl_mul(p, base, pl_number_inv(p, t.coefficient)));
  return pl_mul(p, power, pl_pow(p, rest, exponent));
}

// (b^x)^y = b^(x y) holds when y is an integer, when b > 0, and when -1 <= x <= 1 (both sides then
// ask for b >= 0).
static bool exponents_multiply(const pl_pool* p, pl_expr base, pl_expr y) {
  if (!pl_is_number(p, y)) return false;
  if (pl_number_is_integer(p, y)) return true;
  pl_expr b = pl_arg(p, base, 0), x = pl_arg(p, base, 1);
  if (pl_is_number(p, b) && pl_number_sign(p, b) > 0) return true;
  return pl_is_number(p, x) && pl_number_compare(p, x, p->one) <= 0
         && pl_number_compare(p, x, p->minus_one) >= 0;
}

static pl_expr power_of_infinity(pl_pool* p, pl_expr base, pl_expr exponent) {
  int sign = pl_number_sign(p, exponent);
  if (!pl_is_number(p, exponent)) return raw_power(p, base, exponent);
  return sign > 0 ? base : sign < 0 ? p->zero : pl_poison();
}

pl_expr pl_pow(pl_pool* p, pl_expr base, pl_expr exponent) {
  if (base.id == 0 || exponent.id == 0) return pl_poison();
  if (exponent.id == p->one.id) return base;
  pl_kind kind = pl_kind_of(p, base);
  if (kind == PL_INFINITY) return power_of_infinity(p, base, exponent);
  if (exponent.id == p->zero.id || base.id == p->one.id) return p->one;
  bool numeric = pl_is_number(p, exponent);
  if (kind == PL_NUMBER && numeric) return number_to_number(p, base, exponent);
  if (kind == PL_POW && exponents_multiply(p, base, exponent)) {
    return pl_pow(p, pl_arg(p, base, 0), pl_mul(p, pl_arg(p, base, 1), exponent));
  }
  if (kind == PL_MUL && numeric && pl_number_is_integer(p, exponent))
    return power_of_each(p, base, exponent);
  if (kind == PL_MUL && numeric) {
    pl_expr e = power_of_scaled(p, base, exponent);
    if (e.id != 0) return e;
  }
  if (is_exp(p, base) && numeric)
    return pl_call(p, PL_EXP, pl_mul(p, exponent, pl_arg(p, base, 0)));
  return raw_power(p, base, exponent);
}

pl_expr pl_pow_int(pl_pool* p, pl_expr base, long n) { return pl_pow(p, base, pl_int(p, n)); }
pl_expr pl_square(pl_pool* p, pl_expr a) { return pl_pow(p, a, p->two); }
pl_expr pl_sqrt(pl_pool* p, pl_expr a) { return pl_pow(p, a, p->half); }
