// An expression with other arguments, brought into canonical form again.
#include "expr/expr_impl.h"

#include <string.h>

static pl_expr rebuild_call(pl_pool* p, pl_expr e, const pl_expr* args) {
  pl_function f = pl_function_of(p, e);
  return pl_n_args(p, e) == 2 ? pl_call2(p, f, args[0], args[1]) : pl_call(p, f, args[0]);
}

pl_expr pl_rebuild(pl_pool* p, pl_expr e, const pl_expr* args) {
  int n = pl_n_args(p, e);
  if (n == 0 || memcmp(args, pl_node_at(p, e)->u.args, (size_t)n * sizeof *args) == 0) return e;
  switch (pl_kind_of(p, e)) {
    case PL_ADD: return pl_add_n(p, args, n);
    case PL_MUL: return pl_mul_n(p, args, n);
    case PL_POW: return pl_pow(p, args[0], args[1]);
    case PL_CALL: return rebuild_call(p, e, args);
    case PL_IF: return pl_if(p, args[0], args[1], args[2]);
    case PL_SUM: return pl_sum_over(p, pl_symbol_of(p, e), args[1], args[2], args[3]);
    case PL_AT: return pl_at(p, pl_symbol_of(p, e), pl_dots_of(p, e), args[0]);
    default: return e;
  }
}
