// Multiplying out: products of sums and positive integer powers of sums. What stands inside
// functions, roots and denominators stays as it is.
#include "expr/expr_impl.h"

// pairs that may be formed per term that is allowed in the end
enum { ROOM_FOR_CANCELLATION = 16 };

typedef struct expansion {
  pl_pool* p;
  int max_terms;
  bool too_large;
} expansion;

static int n_terms(const pl_pool* p, pl_expr e) {
  return pl_kind_of(p, e) == PL_ADD ? pl_n_args(p, e) : 1;
}
static pl_expr term_at(const pl_pool* p, pl_expr e, int i) {
  return pl_kind_of(p, e) == PL_ADD ? pl_arg(p, e, i) : e;
}

static pl_expr checked(expansion* x, pl_expr e) {
  if (n_terms(x->p, e) > x->max_terms) x->too_large = true;
  return e;
}

// (a + b)(c + d), both already multiplied out.
static pl_expr multiply(expansion* x, pl_expr a, pl_expr b) {
  pl_pool* p = x->p;
  long n = n_terms(p, a), m = n_terms(p, b);
  if (n * m > (long)x->max_terms * ROOM_FOR_CANCELLATION) x->too_large = true;
  if (x->too_large) return a;
  pl_exprs terms = {0};
  for (int i = 0; i < n; i++) {
    for (int k = 0; k < m; k++)
      pl_temp_push(p, terms, pl_mul(p, term_at(p, a, i), term_at(p, b, k)));
  }
  pl_expr e = pl_add_n(p, terms.at, terms.n);
  pl_temp_free(p, terms);
  return checked(x, e);
}

static pl_expr multiply_power(expansion* x, pl_expr base, long n) {
  pl_expr e = x->p->one;
  for (long i = 0; i < n && !x->too_large; i++) e = multiply(x, e, base);
  return e;
}

// Is there a bracket to open in the product of these factors?
static bool has_sum(const pl_pool* p, const pl_expr* factors, int n) {
  for (int i = 0; i < n; i++) {
    if (pl_kind_of(p, factors[i]) == PL_ADD) return true;
  }
  return false;
}

// Factors that are no sums first, in one product; then bracket by bracket.
static pl_expr expand_product(expansion* x, const pl_expr* factors, int n) {
  pl_pool* p = x->p;
  if (!has_sum(p, factors, n)) return pl_mul_n(p, factors, n);
  pl_exprs plain = {0};
  for (int i = 0; i < n; i++) {
    if (pl_kind_of(p, factors[i]) != PL_ADD) pl_temp_push(p, plain, factors[i]);
  }
  pl_expr e = pl_mul_n(p, plain.at, plain.n);
  pl_temp_free(p, plain);
  for (int i = 0; i < n && !x->too_large; i++) {
    if (pl_kind_of(p, factors[i]) == PL_ADD) e = multiply(x, e, factors[i]);
  }
  return e;
}

// The nodes through which sums are multiplied out; everything else is an atom.
static bool is_open(const pl_pool* p, pl_expr e) {
  long n;
  pl_kind k = pl_kind_of(p, e);
  return k == PL_ADD || k == PL_MUL || (k == PL_POW && pl_is_int(p, pl_arg(p, e, 1), &n) && n > 1);
}

static pl_expr expand_node(expansion* x, pl_expr e, const pl_expr* args) {
  pl_pool* p = x->p;
  long n;
  switch (pl_kind_of(p, e)) {
    case PL_ADD: return checked(x, pl_add_n(p, args, pl_n_args(p, e)));
    case PL_MUL: return expand_product(x, args, pl_n_args(p, e));
    default:
      if (!pl_is_int(p, pl_arg(p, e, 1), &n) || pl_kind_of(p, args[0]) != PL_ADD)
        return pl_rebuild(p, e, args);
      if (n > x->max_terms) x->too_large = true;  // a sum of two has n + 1 terms already
      return multiply_power(x, args[0], n);
  }
}

// Brackets that the opening of others brought to light (a power of a product that held a sum) need
// another round.
static pl_expr expand_once(expansion* x, pl_expr e) {
  pl_pool* p = x->p;
  pl_walk w;
  pl_walk_begin(&w, p, &e, 1);
  pl_expr* to = pl_scratch_take(p, (size_t)w.nodes.n * sizeof *to);
  pl_exprs args = {0};
  for (int i = 0; i < w.nodes.n && !x->too_large; i++) {
    pl_expr y = w.nodes.at[i];
    to[i] = y;
    if (!is_open(p, y)) continue;
    args.n = 0;
    for (int k = 0, n = pl_n_args(p, y); k < n; k++)
      pl_temp_push(p, args, to[pl_walk_position(&w, pl_arg(p, y, k))]);
    to[i] = expand_node(x, y, args.at);
  }
  pl_expr result = to[w.nodes.n - 1];
  pl_temp_free(p, args);
  pl_scratch_give(p, to, (size_t)w.nodes.n * sizeof *to);
  pl_walk_end(&w);
  return result;
}

pl_expr pl_expand(pl_pool* p, pl_expr e, int max_terms) {
  if (!is_open(p, e)) return e;
  expansion x = {.p = p, .max_terms = max_terms};
  pl_expr now = e;
  for (;;) {
    pl_expr next = expand_once(&x, now);
    if (x.too_large) return e;
    if (next.id == now.id || next.id == 0) return next;
    now = next;
  }
}
