// Values in double precision: one pass over the DAG, arguments first. NaN where a symbol is unknown
// or the point lies outside the domain; a division by zero is outside.
#include "expr/expr_impl.h"

#include <math.h>
#include <stdlib.h>

// The running index of a sum that is being evaluated; inner sums see the outer ones.
typedef struct binding {
  pl_symbol index;
  double value;
  const struct binding* outer;
} binding;

typedef struct evaluation {
  const pl_pool* p;
  const double* values;  // by symbol id, may be NULL
  const binding* bound;
} evaluation;

static const double no_value = (double)NAN;
static const double max_sum = 1e7;  // terms of one sum; beyond it NaN

// ------------------------------------------------------------------------------------ node by node
static double symbol_value(const evaluation* v, pl_symbol s) {
  for (const binding* b = v->bound; b != NULL; b = b->outer) {
    if (b->index.id == s.id) return b->value;
  }
  return v->values ? v->values[s.id] : no_value;
}

static double integer_power(double x, long n) {
  if (n < 0) return x == 0 ? no_value : 1 / integer_power(x, -n);
  double y = 1;
  for (; n > 0; n >>= 1, x *= x) {
    if (n & 1) y *= x;
  }
  return y;
}

static double power_value(const pl_pool* p, pl_expr exponent, double base, double x) {
  long k, q;
  if (pl_is_ratio(p, exponent, &k, &q) && labs(k) < 1024) {
    if (q == 1) return integer_power(base, k);
    if (q == 2) return base < 0 ? no_value : integer_power(sqrt(base), k);
  }
  if (base == 0 && x <= 0) return x == 0 ? 1 : no_value;
  return pow(base, x);
}

static double call_value(pl_function f, double a, double b) {
  switch (f) {
// clang-format off
#define PL_FUNCTION(name, text, n, tex, form, value, ...) \
  case PL_##name: return value;
#include "expr/functions.def"
      // clang-format on
    default: return no_value;
  }
}

static double fold(pl_kind kind, const pl_walk* w, const double* value, pl_expr e) {
  double x = kind == PL_ADD ? 0 : 1;
  for (int i = 0, n = pl_n_args(w->p, e); i < n; i++) {
    double y = value[pl_walk_position(w, pl_arg(w->p, e, i))];
    x = kind == PL_ADD ? x + y : x * y;
  }
  return x;
}

static double sum_value(const evaluation* v, pl_expr e, double lo, double hi);

static double node_value(const evaluation* v, const pl_walk* w, const double* value, pl_expr e) {
  const pl_pool* p = v->p;
  pl_kind kind = pl_kind_of(p, e);
  double a[4] = {0};
  if (kind != PL_ADD && kind != PL_MUL) {
    for (int i = 0, n = pl_n_args(p, e); i < n && i < 4; i++)
      a[i] = value[pl_walk_position(w, pl_arg(p, e, i))];
  }
  switch (kind) {
    case PL_NUMBER: return pl_number_double(p, e);
    case PL_PI: return M_PI;
    case PL_INFINITY: return (double)INFINITY;
    case PL_SYMBOL: return symbol_value(v, pl_symbol_of(p, e));
    case PL_ADD:
    case PL_MUL: return fold(kind, w, value, e);
    case PL_POW: return power_value(p, pl_arg(p, e, 1), a[0], a[1]);
    case PL_CALL: return call_value(pl_function_of(p, e), a[0], a[1]);
    case PL_IF: return isnan(a[0]) ? no_value : a[0] > 0 ? a[1] : a[2];
    case PL_SUM: return sum_value(v, e, a[1], a[2]);
    default: return no_value;  // poison, elements of families
  }
}

// ------------------------------------------------------------------------------------------ passes
static void run(const evaluation* v, const pl_walk* w, double* value) {
  for (int i = 0; i < w->nodes.n; i++) value[i] = node_value(v, w, value, w->nodes.at[i]);
}

// Whole bounds; the body once for each value of the index, in rising order.
static double sum_value(const evaluation* v, pl_expr e, double lo, double hi) {
  if (!(hi - lo < max_sum) || lo != floor(lo) || hi != floor(hi)) return no_value;
  pl_expr body = pl_arg(v->p, e, 3);
  binding b = {.index = pl_symbol_of(v->p, e), .outer = v->bound};
  evaluation inner = {v->p, v->values, &b};
  pl_walk w;
  pl_walk_begin(&w, v->p, &body, 1);
  double* value = pl_scratch_take(v->p, (size_t)w.nodes.n * sizeof *value);
  double sum = 0;
  for (double k = lo; k <= hi; k++) {
    b.value = k;
    run(&inner, &w, value);
    sum += value[w.nodes.n - 1];
  }
  pl_scratch_give(v->p, value, (size_t)w.nodes.n * sizeof *value);
  pl_walk_end(&w);
  return sum;
}

double pl_eval(const pl_pool* p, pl_expr e, const double* value_of_symbol) {
  evaluation v = {p, value_of_symbol, NULL};
  pl_walk w;
  pl_walk_begin(&w, p, &e, 1);
  double* value = pl_scratch_take(p, (size_t)w.nodes.n * sizeof *value);
  run(&v, &w, value);
  double result = value[w.nodes.n - 1];
  pl_scratch_give(p, value, (size_t)w.nodes.n * sizeof *value);
  pl_walk_end(&w);
  return result;
}

double pl_eval_terms(const pl_pool* p, pl_expr e, const double* value_of_symbol) {
  pl_kind kind = pl_kind_of(p, e);
  if (kind != PL_ADD && kind != PL_MUL) return fabs(pl_eval(p, e, value_of_symbol));
  double size = kind == PL_ADD ? 0 : 1;
  for (int i = 0; i < pl_n_args(p, e); i++) {
    double part = pl_eval_terms(p, pl_arg(p, e, i), value_of_symbol);
    size = kind == PL_ADD ? size + part : size * part;
  }
  return size;
}
