// Sums: flat, like terms collected, sorted.  And the constructors that need no thought.
#include "expr/expr_impl.h"

#include <string.h>

pl_expr pl_pi(pl_pool* p) { return p->pi; }
pl_expr pl_infinity(pl_pool* p) { return pl_node_make(p, PL_INFINITY, 0, 0, 0, NULL, 0); }

pl_expr pl_sym(pl_pool* p, pl_symbol s) {
  if (pl_symbol_get(p, s) == NULL) return pl_poison();
  return pl_node_make(p, PL_SYMBOL, 0, 0, s.id, NULL, 0);
}

pl_expr pl_at(pl_pool* p, pl_symbol array, int dots, pl_expr index) {
  if (pl_symbol_get(p, array) == NULL || index.id == 0 || dots < 0 || dots > 255)
    return pl_poison();
  return pl_node_make(p, PL_AT, 0, dots, array.id, &index, 1);
}

// -------------------------------------------------------------------------------------------- sums
typedef struct sum {
  pl_pool* p;
  PL_TEMP(pl_term) terms;
  pl_expr number;
  int infinite;  // sign of the infinities that were met; 2 when both signs were
  bool poison;
} sum;

static void sum_put(sum* s, pl_expr e, pl_expr scale);

// scale * (a + b + ...), term by term
static void sum_put_all(sum* s, pl_expr e, pl_expr scale) {
  for (int i = 0, n = pl_n_args(s->p, e); i < n; i++) sum_put(s, pl_arg(s->p, e, i), scale);
}

static void sum_put_infinity(sum* s, int sign) {
  s->infinite = s->infinite == 0 || s->infinite == sign ? sign : 2;
}

static void sum_put_number(sum* s, pl_expr x) {
  s->number = pl_number_add(s->p, s->number, x);
  if (s->number.id == 0) {
    s->poison = true;
    s->number = s->p->zero;
  }
}

static bool is_unit(const pl_pool* p, pl_expr x) {
  return x.id == p->one.id || x.id == p->minus_one.id;
}

// One term.  A bracket with the coefficient 1 or -1 is opened, any other stays.
static void sum_put(sum* s, pl_expr e, pl_expr scale) {
  pl_pool* p = s->p;
  if (e.id == 0) {
    s->poison = true;
    return;
  }
  if (pl_kind_of(p, e) == PL_ADD && is_unit(p, scale)) {
    sum_put_all(s, e, scale);
    return;
  }
  pl_term t = pl_term_of(p, e);
  if (scale.id != p->one.id) {
    t.coefficient = pl_number_mul(p, t.coefficient, scale);
    t.whole = pl_poison();
    if (t.coefficient.id == 0) s->poison = true;
  }
  if (t.coefficient.id == 0) return;
  if (t.n == 0) {
    sum_put_number(s, t.coefficient);
  } else if (t.n == 1 && is_unit(p, t.coefficient) && pl_kind_of(p, t.one) == PL_ADD) {
    sum_put_all(s, t.one, t.coefficient);
  } else if (t.n == 1 && pl_kind_of(p, t.one) == PL_INFINITY) {
    sum_put_infinity(s, pl_number_sign(p, t.coefficient));
  } else {
    pl_temp_push(p, s->terms, t);
  }
}

static bool term_less(const void* a, const void* b, const void* user) {
  const pl_term *s = a, *t = b;
  return pl_compare_factors(user, pl_term_factors(s), s->n, pl_term_factors(t), t->n) < 0;
}

static bool like(const pl_term* s, const pl_term* t) {
  return s->n == t->n
         && memcmp(pl_term_factors(s), pl_term_factors(t), (size_t)s->n * sizeof(pl_expr)) == 0;
}

// Neighbours with the same factors become one term. Tells whether a bracket came out with a unit
// coefficient, which must then be opened.
static bool sum_collect(sum* s) {
  pl_pool* p = s->p;
  bool opened = false;
  int n = 0;
  for (int i = 0, k; i < s->terms.n; i = k) {
    pl_term t = s->terms.at[i];
    for (k = i + 1; k < s->terms.n && like(&t, &s->terms.at[k]); k++) {
      t.coefficient = pl_number_add(p, t.coefficient, s->terms.at[k].coefficient);
      t.whole = pl_poison();
      if (t.coefficient.id == 0) {
        s->poison = true;
        return false;
      }
    }
    if (t.coefficient.id == p->zero.id) continue;
    opened = opened || (t.n == 1 && is_unit(p, t.coefficient) && pl_kind_of(p, t.one) == PL_ADD);
    s->terms.at[n++] = t;
  }
  s->terms.n = n;
  return opened;
}

// coefficient * factors, which are in order
static pl_expr term_value(pl_pool* p, const pl_term* t) {
  if (t->whole.id != 0) return t->whole;
  if (t->coefficient.id == p->one.id && t->n == 1) return t->one;
  pl_exprs args = {0};
  if (t->coefficient.id != p->one.id) pl_temp_push(p, args, t->coefficient);
  for (int i = 0; i < t->n; i++) pl_temp_push(p, args, pl_term_factors(t)[i]);
  pl_expr e = pl_node_make(p, PL_MUL, 0, 0, 0, args.at, args.n);
  pl_temp_free(p, args);
  return e;
}

static pl_expr sum_value(sum* s, bool again) {
  pl_pool* p = s->p;
  pl_exprs args = {0};
  if (s->number.id != p->zero.id) pl_temp_push(p, args, s->number);
  for (int i = 0; i < s->terms.n; i++) pl_temp_push(p, args, term_value(p, &s->terms.at[i]));
  pl_expr e = args.n == 0             ? p->zero
              : args.n == 1 && !again ? args.at[0]
              : again                 ? pl_add_n(p, args.at, args.n)
                                      : pl_node_make(p, PL_ADD, 0, 0, 0, args.at, args.n);
  pl_temp_free(p, args);
  return e;
}

static pl_expr infinite_value(pl_pool* p, int sign) {
  if (sign == 2) return pl_poison();
  pl_expr infinity = pl_infinity(p);
  return sign > 0 ? infinity
                  : pl_node_make(p, PL_MUL, 0, 0, 0, (pl_expr[]){p->minus_one, infinity}, 2);
}

pl_expr pl_add_n(pl_pool* p, const pl_expr* terms, int n) {
  sum s = {.p = p, .number = p->zero};
  for (int i = 0; i < n; i++) sum_put(&s, terms[i], p->one);
  pl_expr e = pl_poison();
  if (!s.poison && s.infinite != 0) {
    e = infinite_value(p, s.infinite);
  } else if (!s.poison) {
    pl_sort(p, s.terms.at, s.terms.n, sizeof *s.terms.at, term_less, p);
    bool again = sum_collect(&s);
    if (!s.poison) e = sum_value(&s, again);
  }
  pl_temp_free(p, s.terms);
  return e;
}

pl_expr pl_add(pl_pool* p, pl_expr a, pl_expr b) {
  if (a.id == p->zero.id) return b;
  if (b.id == p->zero.id) return a;
  return pl_add_n(p, (pl_expr[]){a, b}, 2);
}

pl_expr pl_sub(pl_pool* p, pl_expr a, pl_expr b) {
  if (b.id == p->zero.id) return a;
  return pl_add(p, a, pl_neg(p, b));
}

pl_expr pl_neg(pl_pool* p, pl_expr a) { return pl_mul(p, p->minus_one, a); }

// --------------------------------------------------------------------------------- cases, patterns
pl_expr pl_if(pl_pool* p, pl_expr positive, pl_expr then, pl_expr otherwise) {
  if (positive.id == 0 || then.id == 0 || otherwise.id == 0) return pl_poison();
  if (pl_is_number(p, positive)) return pl_number_sign(p, positive) > 0 ? then : otherwise;
  if (then.id == otherwise.id) return then;
  return pl_node_make(p, PL_IF, 0, 0, 0, (pl_expr[]){positive, then, otherwise}, 3);
}

pl_expr pl_sum_over(pl_pool* p, pl_symbol index, pl_expr lo, pl_expr hi, pl_expr body) {
  pl_expr i = pl_sym(p, index);
  if (i.id == 0 || lo.id == 0 || hi.id == 0 || body.id == 0) return pl_poison();
  if (body.id == p->zero.id) return body;
  if (pl_is_number(p, lo) && pl_is_number(p, hi) && pl_number_compare(p, lo, hi) > 0)
    return p->zero;
  return pl_node_make(p, PL_SUM, 0, 0, index.id, (pl_expr[]){i, lo, hi, body}, 4);
}
