// Ball arithmetic for one node of the DAG; see arb_eval.h.
#include "algebra/arb_eval.h"

static void number_node(arb_t out, const pl_pool* p, pl_expr e, pl_arena* scratch, long precision) {
  long num = 0, den = 1;
  if (pl_is_ratio(p, e, &num, &den)) {
    arb_set_si(out, num);
    arb_div_si(out, out, den, precision);
    return;
  }
  const char* upper = pl_number_num_text(scratch, p, e);
  const char* lower = pl_number_den_text(scratch, p, e);
  fmpq_t q;
  fmpq_init(q);
  fmpz_set_str(fmpq_numref(q), upper, 10);
  fmpz_set_str(fmpq_denref(q), lower, 10);
  arb_set_fmpq(out, q, precision);
  fmpq_clear(q);
}

static void rational_power(arb_t out, arb_srcptr base, long num, long den, long precision) {
  if (den == 2) {
    arb_sqrt(out, base, precision);
  } else if (den != 1) {
    arb_root_ui(out, base, (ulong)den, precision);
  } else {
    arb_set(out, base);
  }
  bool invert = num < 0;
  arb_pow_ui(out, out, (ulong)(invert ? -num : num), precision);
  if (invert) arb_inv(out, out, precision);
}

static void power_node(arb_t out, const pl_pool* p, pl_expr e, const arb_srcptr* args,
                       long precision) {
  long num = 0, den = 1;
  if (pl_is_ratio(p, pl_arg(p, e, 1), &num, &den)) {
    rational_power(out, args[0], num, den, precision);
  } else {
    arb_pow(out, args[0], args[1], precision);
  }
}

// The one that is decided, else both: the ball is kept as it is, not widened to its end points.
static void choose(arb_t out, arb_srcptr a, arb_srcptr b, bool is_a, bool is_b, long precision) {
  if (is_a) {
    arb_set(out, a);
  } else if (is_b) {
    arb_set(out, b);
  } else {
    arb_union(out, a, b, precision);
  }
}

// Near the ends of its domain a ball may become indeterminate; then the point is not used.
static void call_node(arb_t out, pl_function f, const arb_srcptr* a, long precision) {
  switch (f) {
#define ARB_1(function) function(out, a[0], precision)
#define ARB_2(function) function(out, a[0], a[1], precision)
#define PL_FUNCTION(name, text, n, tex, form, value, derivative, library, ...) \
  case PL_##name:                                                              \
    ARB_##n(arb_##library);                                                    \
    break;
#define PL_PIECEWISE(...)
#include "expr/functions.def"
    case PL_ABS: arb_abs(out, a[0]); break;
    case PL_SIGN: arb_sgn(out, a[0]); break;
    case PL_MIN: choose(out, a[0], a[1], arb_lt(a[0], a[1]), arb_lt(a[1], a[0]), precision); break;
    case PL_MAX: choose(out, a[0], a[1], arb_gt(a[0], a[1]), arb_gt(a[1], a[0]), precision); break;
    default: arb_indeterminate(out);
  }
}

static void choice_node(arb_t out, const arb_srcptr* args) {
  if (arb_is_positive(args[0])) {
    arb_set(out, args[1]);
  } else if (arb_is_nonpositive(args[0])) {
    arb_set(out, args[2]);
  } else {
    arb_indeterminate(out);
  }
}

void pl_arb_node(arb_t out, const pl_pool* p, pl_expr e, const arb_srcptr* args, pl_arena* scratch,
                 long precision) {
  int n = pl_n_args(p, e);
  switch (pl_kind_of(p, e)) {
    case PL_NUMBER: number_node(out, p, e, scratch, precision); break;
    case PL_PI: arb_const_pi(out, precision); break;
    case PL_ADD:
      arb_set(out, args[0]);
      for (int i = 1; i < n; i++) arb_add(out, out, args[i], precision);
      break;
    case PL_MUL:
      arb_set(out, args[0]);
      for (int i = 1; i < n; i++) arb_mul(out, out, args[i], precision);
      break;
    case PL_POW: power_node(out, p, e, args, precision); break;
    case PL_CALL: call_node(out, pl_function_of(p, e), args, precision); break;
    case PL_IF: choice_node(out, args); break;
    default: arb_indeterminate(out);
  }
}
