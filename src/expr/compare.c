// The order in which terms and factors are kept: by structure and names, never by age or address.
//
// Terms are compared without their coefficients, factor by factor; factors by base, then by
// exponent, the higher first. Two different handles differ in structure, so the first pair that
// differs decides, and the comparison is one loop down to that pair: depth costs no stack.
#include "expr/expr_impl.h"

#include <string.h>

pl_term pl_term_of(const pl_pool* p, pl_expr e) {
  const pl_node* x = pl_node_at(p, e);
  pl_term t = {.coefficient = p->one, .one = e, .whole = e, .n = 1};
  if (x->kind == PL_NUMBER) {
    t.coefficient = e;
    t.n = 0;
  } else if (x->kind == PL_MUL) {
    bool number = pl_is_number(p, x->u.args[0]);
    if (number) t.coefficient = x->u.args[0];
    t.factors = x->u.args + number;
    t.n = (int)x->n - number;
    if (t.n == 1) {
      t.one = t.factors[0];
      t.factors = NULL;
    }
  }
  return t;
}

// Kinds of bases from the simplest to the most composed.
static int rank(int kind) {
  switch (kind) {
    case PL_NUMBER: return 1;
    case PL_PI: return 2;
    case PL_INFINITY: return 3;
    case PL_SYMBOL: return 4;
    case PL_AT: return 5;
    case PL_CALL: return 6;
    case PL_UNKNOWN_FUNCTION: return 7;
    case PL_ADD: return 8;
    case PL_IF: return 9;
    case PL_SUM: return 10;
    case PL_POW: return 11;  // as a base only: (x^y)^z
    case PL_MUL: return 12;  // as a base only: sqrt(x y)
    default: return 0;
  }
}

typedef struct pair {
  pl_expr a, b;
} pair;

// Decided here, or to be decided by the pair that is left.
static int compare_names(const pl_pool* p, uint32_t a, uint32_t b) {
  if (a == b) return 0;
  const pl_symbol_info *x = pl_symbol_get(p, (pl_symbol){a}), *y = pl_symbol_get(p, (pl_symbol){b});
  if (x == NULL || y == NULL) return a < b ? -1 : 1;
  return pl_natural_compare(x->ascii, y->ascii);
}

static int first_difference(const pl_expr* a, int n_a, const pl_expr* b, int n_b, pair* left) {
  int n = n_a < n_b ? n_a : n_b;
  for (int i = 0; i < n; i++) {
    if (a[i].id != b[i].id) {
      *left = (pair){a[i], b[i]};
      return 0;
    }
  }
  return n_a < n_b ? -1 : 1;
}

// Two different bases that are neither powers nor products.
static int compare_bases(const pl_pool* p, pl_expr a, pl_expr b, pair* left) {
  const pl_node *x = pl_node_at(p, a), *y = pl_node_at(p, b);
  if (x->kind == PL_NUMBER) return pl_number_compare(p, a, b);
  int c = compare_names(p, x->symbol, y->symbol);
  if (c != 0) return c;
  if (x->dots != y->dots) return x->dots < y->dots ? -1 : 1;
  if (x->function != y->function) return x->function < y->function ? -1 : 1;
  // the simpler first; spares deep descents
  if (x->height != y->height) return x->height < y->height ? -1 : 1;
  return first_difference(x->u.args, (int)x->n, y->u.args, (int)y->n, left);
}

// Exponents of the same base: numbers before the rest, the larger first.
static int compare_exponents(const pl_pool* p, pl_expr a, pl_expr b, pair* left) {
  bool x = pl_is_number(p, a), y = pl_is_number(p, b);
  if (x && y) return -pl_number_compare(p, a, b);
  if (x != y) return x ? -1 : 1;
  *left = (pair){a, b};
  return 0;
}

// Two different factors.
static int compare_factor(const pl_pool* p, pl_expr a, pl_expr b, pair* left) {
  pl_expr ba = pl_base_of(p, a), bb = pl_base_of(p, b);
  if (ba.id == bb.id) return compare_exponents(p, pl_exponent_of(p, a), pl_exponent_of(p, b), left);
  int ra = rank(pl_kind_of(p, ba)), rb = rank(pl_kind_of(p, bb));
  if (ra != rb) return ra < rb ? -1 : 1;
  if (ra >= rank(PL_POW)) {
    *left = (pair){ba, bb};
    return 0;
  }
  return compare_bases(p, ba, bb, left);
}

// Two different terms: factors, then length, then coefficients.
static int compare_terms(const pl_pool* p, pl_expr a, pl_expr b, pair* left) {
  pl_term s = pl_term_of(p, a), t = pl_term_of(p, b);
  const pl_expr *x = pl_term_factors(&s), *y = pl_term_factors(&t);
  int n = s.n < t.n ? s.n : t.n;
  for (int i = 0; i < n; i++) {
    if (x[i].id != y[i].id) return compare_factor(p, x[i], y[i], left);
  }
  if (s.n != t.n) return s.n < t.n ? -1 : 1;
  return pl_number_compare(p, s.coefficient, t.coefficient);
}

int pl_compare(const pl_pool* p, pl_expr a, pl_expr b) {
  pair left = {a, b};
  while (left.a.id != left.b.id) {
    pair now = left;
    left = (pair){0};
    int c = compare_terms(p, now.a, now.b, &left);
    if (c != 0) return c;
  }
  return 0;
}

int pl_compare_factors(const pl_pool* p, const pl_expr* a, int n_a, const pl_expr* b, int n_b) {
  int n = n_a < n_b ? n_a : n_b;
  for (int i = 0; i < n; i++) {
    if (a[i].id == b[i].id) continue;
    pair left = {0};
    int c = compare_factor(p, a[i], b[i], &left);
    return c != 0 ? c : pl_compare(p, left.a, left.b);
  }
  return (n_a > n_b) - (n_a < n_b);
}
