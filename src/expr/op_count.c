// How large an expression is: nodes, and operators as a reader counts them.
#include "expr/expr_impl.h"

#include <limits.h>

long pl_dag_size(const pl_pool* p, pl_expr e) {
  pl_walk w;
  pl_walk_begin(&w, p, &e, 1);
  long n = w.nodes.n;
  pl_walk_end(&w);
  return n;
}

static long add_capped(long a, long b) {
  long sum;
  return __builtin_add_overflow(a, b, &sum) ? LONG_MAX : sum;
}

// Operators of every node so far, by position in the walk.
typedef struct counter {
  const pl_pool* p;
  pl_walk w;
  long* ops;
} counter;

static long ops_of(const counter* c, pl_expr e) { return c->ops[pl_walk_position(&c->w, e)]; }

static long ops_of_number(const pl_pool* p, pl_expr x) {
  return (pl_number_sign(p, x) < 0) + !pl_number_is_integer(p, x);
}

static bool is_below_line(const pl_pool* p, pl_expr e) {
  return pl_kind_of(p, e) == PL_POW && pl_number_sign(p, pl_arg(p, e, 1)) < 0;
}

// A factor above or below the line of a fraction, where the sign of its exponent is not written.
static long ops_of_factor(const counter* c, pl_expr e) {
  const pl_pool* p = c->p;
  if (pl_kind_of(p, e) != PL_POW) return ops_of(c, e);
  pl_expr x = pl_arg(p, e, 1);
  long base = ops_of(c, pl_arg(p, e, 0)), num, den;
  if (!pl_is_number(p, x)) return add_capped(add_capped(base, ops_of(c, x)), 1);
  bool small = pl_is_ratio(p, x, &num, &den);
  if (small && den == 1 && (num == 1 || num == -1)) return base;
  bool root = small && den == 2 && (num == 1 || num == -1);
  return add_capped(base, root ? 1 : 1 + !pl_number_is_integer(p, x));
}

static bool numerator_is_one(const pl_pool* p, pl_expr x) {
  const pl_number* n = pl_number_of(p, x);
  return n->limbs == NULL && (n->num == 1 || n->num == -1);
}

// Sign, factors above the line, factors below it.
static long ops_of_term(const counter* c, pl_expr e) {
  const pl_pool* p = c->p;
  pl_term t = pl_term_of(p, e);
  long above = !numerator_is_one(p, t.coefficient), below = !pl_number_is_integer(p, t.coefficient);
  long ops = pl_number_sign(p, t.coefficient) < 0;
  for (int i = 0; i < t.n; i++) {
    pl_expr x = pl_term_factors(&t)[i];
    if (is_below_line(p, x)) below++;
    else above++;
    ops = add_capped(ops, ops_of_factor(c, x));
  }
  return add_capped(ops, (above > 1 ? above - 1 : 0) + below);
}

// a - b is one operator; a minus sign in front of the first term is one of its own.
static long ops_of_sum(const counter* c, pl_expr e) {
  const pl_pool* p = c->p;
  int n = pl_n_args(p, e), negative = 0;
  long ops = n - 1;
  for (int i = 0; i < n; i++) {
    pl_expr x = pl_arg(p, e, i);
    negative += pl_number_sign(p, pl_term_of(p, x).coefficient) < 0;
    ops = add_capped(ops, ops_of(c, x));
  }
  return ops == LONG_MAX ? ops : ops - negative + (negative == n);
}

static long ops_of_node(const counter* c, pl_expr e) {
  const pl_pool* p = c->p;
  switch (pl_kind_of(p, e)) {
    case PL_NUMBER: return ops_of_number(p, e);
    case PL_ADD: return ops_of_sum(c, e);
    case PL_MUL:
    case PL_POW: return ops_of_term(c, e);
    case PL_CALL:
    case PL_IF:
    case PL_SUM: {
      long ops = 1;
      for (int i = 0, n = pl_n_args(p, e); i < n; i++)
        ops = add_capped(ops, ops_of(c, pl_arg(p, e, i)));
      return ops;
    }
    default: return 0;
  }
}

long pl_op_count(const pl_pool* p, pl_expr e) {
  counter c = {.p = p};
  pl_walk_begin(&c.w, p, &e, 1);
  size_t bytes = (size_t)c.w.nodes.n * sizeof *c.ops;
  c.ops = pl_scratch_take(p, bytes);
  for (int i = 0; i < c.w.nodes.n; i++) c.ops[i] = ops_of_node(&c, c.w.nodes.at[i]);
  long total = c.ops[c.w.nodes.n - 1];
  pl_scratch_give(p, c.ops, bytes);
  pl_walk_end(&c.w);
  return total;
}
