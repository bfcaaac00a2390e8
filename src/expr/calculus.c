// Derivatives: partial, with respect to an element of a family, and total in time. One pass over
// the DAG, arguments first; a node that occurs twice is differentiated once.
#include "expr/expr_impl.h"

// What differs between the derivatives: the derivative of an atom (a symbol or an element).
typedef struct rule {
  pl_expr (*of_atom)(pl_pool* p, pl_expr atom, const struct rule* r);
  pl_symbol symbol;
  pl_expr element;
} rule;

// ------------------------------------------------------------------------------------ node by node
static pl_expr diff_sum(pl_pool* p, const pl_expr* d, int n) {
  pl_exprs terms = {0};
  for (int i = 0; i < n; i++) {
    if (d[i].id != p->zero.id) pl_temp_push(p, terms, d[i]);
  }
  pl_expr e = pl_add_n(p, terms.at, terms.n);
  pl_temp_free(p, terms);
  return e;
}

// sum over i of d_i times the other factors
static pl_expr diff_product(pl_pool* p, pl_expr e, const pl_expr* d, int n) {
  pl_exprs terms = {0}, factors = {0};
  for (int i = 0; i < n; i++) {
    if (d[i].id == p->zero.id) continue;
    factors.n = 0;
    for (int k = 0; k < n; k++) pl_temp_push(p, factors, k == i ? d[k] : pl_arg(p, e, k));
    pl_temp_push(p, terms, pl_mul_n(p, factors.at, factors.n));
  }
  pl_expr sum = pl_add_n(p, terms.at, terms.n);
  pl_temp_free(p, factors);
  pl_temp_free(p, terms);
  return sum;
}

//   (b^x)' = x b^(x-1) b' + b^x ln(b) x'
static pl_expr diff_power(pl_pool* p, pl_expr e, const pl_expr* d) {
  pl_expr b = pl_arg(p, e, 0), x = pl_arg(p, e, 1), left = p->zero, right = p->zero;
  if (d[0].id != p->zero.id)
    left = pl_mul_n(p, (pl_expr[]){x, pl_pow(p, b, pl_sub(p, x, p->one)), d[0]}, 3);
  if (d[1].id != p->zero.id) right = pl_mul_n(p, (pl_expr[]){e, pl_call(p, PL_LN, b), d[1]}, 3);
  return pl_add(p, left, right);
}

// The derivative of a call: f'(a) a', or the differential of a function of two arguments.
static pl_expr diff_call(pl_pool* p, pl_expr e, pl_expr da, pl_expr db) {
  pl_expr a = pl_arg(p, e, 0), b = pl_arg(p, e, pl_n_args(p, e) - 1), one = p->one;
  switch (pl_function_of(p, e)) {
#define SLOPE(x)        pl_mul(p, x, da)
#define DIFFERENTIAL(x) x
// clang-format off
#define PL_FUNCTION(name, text, n, tex, form, value, derivative, ...) \
  case PL_##name: return derivative;
#include "expr/functions.def"
      // clang-format on
    default: return pl_poison();
  }
}

pl_expr pl_call_slope(pl_pool* p, pl_expr e) { return diff_call(p, e, p->one, p->one); }

static bool all_zero(const pl_pool* p, const pl_expr* d, int n) {
  for (int i = 0; i < n; i++) {
    if (d[i].id != p->zero.id) return false;
  }
  return true;
}

// Does the body of a sum hold an element of the same family under the running index? Its derivative
// with respect to one element would be a Kronecker delta, which is not an expression here.
static bool runs_over(const pl_pool* p, pl_expr sum, pl_expr element) {
  pl_expr body = pl_arg(p, sum, 3);
  pl_walk w;
  pl_walk_begin(&w, p, &body, 1);
  bool found = false;
  for (int i = 0; i < w.nodes.n && !found; i++) {
    pl_expr x = w.nodes.at[i];
    found = pl_kind_of(p, x) == PL_AT && pl_symbol_of(p, x).id == pl_symbol_of(p, element).id
            && pl_dots_of(p, x) == pl_dots_of(p, element)
            && pl_has_symbol(p, pl_arg(p, x, 0), pl_symbol_of(p, sum));
  }
  pl_walk_end(&w);
  return found;
}

// Bounds are constants; so is the index.
static pl_expr diff_pattern(pl_pool* p, pl_expr e, const pl_expr* d, const rule* r) {
  if (r->element.id != 0 && runs_over(p, e, r->element)) return pl_poison();
  if (!all_zero(p, d, 3)) return pl_poison();
  return pl_sum_over(p, pl_symbol_of(p, e), pl_arg(p, e, 1), pl_arg(p, e, 2), d[3]);
}

static pl_expr diff_node(pl_pool* p, pl_expr e, const pl_expr* d, const rule* r) {
  pl_kind kind = pl_kind_of(p, e);
  int n = pl_n_args(p, e);
  if (kind == PL_SYMBOL || kind == PL_AT) return r->of_atom(p, e, r);
  if (kind == PL_SUM) return diff_pattern(p, e, d, r);
  if (kind == PL_POISON) return e;
  if (all_zero(p, d, n)) return p->zero;
  switch (kind) {
    case PL_ADD: return diff_sum(p, d, n);
    case PL_MUL: return diff_product(p, e, d, n);
    case PL_POW: return diff_power(p, e, d);
    case PL_CALL: return diff_call(p, e, d[0], d[n - 1]);
    // a jump has no derivative of its own
    case PL_IF: return pl_if(p, pl_arg(p, e, 0), d[1], d[2]);
    default: return pl_poison();
  }
}

static pl_expr differentiate(pl_pool* p, pl_expr e, const rule* r) {
  if (pl_n_args(p, e) == 0) return diff_node(p, e, NULL, r);
  pl_walk w;
  pl_walk_begin(&w, p, &e, 1);
  pl_expr* d = pl_scratch_take(p, (size_t)w.nodes.n * sizeof *d);
  pl_exprs args = {0};
  for (int i = 0; i < w.nodes.n; i++) {
    pl_expr x = w.nodes.at[i];
    args.n = 0;
    for (int k = 0, n = pl_n_args(p, x); k < n; k++) {
      pl_temp_push(p, args, d[pl_walk_position(&w, pl_arg(p, x, k))]);
    }
    d[i] = diff_node(p, x, args.at, r);
  }
  pl_expr result = d[w.nodes.n - 1];
  pl_temp_free(p, args);
  pl_scratch_give(p, d, (size_t)w.nodes.n * sizeof *d);
  pl_walk_end(&w);
  return result;
}

// ----------------------------------------------------------------------------- partial derivatives
static pl_expr atom_by_symbol(pl_pool* p, pl_expr atom, const rule* r) {
  return pl_kind_of(p, atom) == PL_SYMBOL && pl_symbol_of(p, atom).id == r->symbol.id ? p->one
                                                                                      : p->zero;
}

static pl_expr atom_by_element(pl_pool* p, pl_expr atom, const rule* r) {
  return atom.id == r->element.id ? p->one : p->zero;
}

pl_expr pl_diff(pl_pool* p, pl_expr e, pl_symbol x) {
  return differentiate(p, e, &(rule){.of_atom = atom_by_symbol, .symbol = x});
}

pl_expr pl_diff_at(pl_pool* p, pl_expr e, pl_expr element) {
  if (pl_kind_of(p, element) == PL_SYMBOL) return pl_diff(p, e, pl_symbol_of(p, element));
  if (pl_kind_of(p, element) != PL_AT) return pl_poison();
  return differentiate(p, e, &(rule){.of_atom = atom_by_element, .element = element});
}

// -------------------------------------------------------------------------------------------- time
// What moves gets one more dot. What has no known rate (multipliers, momenta, named intermediates)
// is poison: an expression that holds one must be resolved before it is differentiated in time.
static pl_expr atom_in_time(pl_pool* p, pl_expr atom, const rule* r) {
  pl_symbol s = pl_symbol_of(p, atom);
  bool element = pl_kind_of(p, atom) == PL_AT;
  switch (pl_symbol_get(p, s)->role) {
    case PL_R_COORD:
    case PL_R_VELOCITY:
    case PL_R_ACCELERATION:
      return element ? pl_at(p, s, pl_dots_of(p, atom) + 1, pl_arg(p, atom, 0))
                     : pl_sym(p, pl_symbol_dot(p, s));
    case PL_R_ARRAY:
      return element ? pl_at(p, s, pl_dots_of(p, atom) + 1, pl_arg(p, atom, 0)) : pl_poison();
    case PL_R_TIME: return p->one;
    case PL_R_MULTIPLIER:
    case PL_R_MOMENTUM:
    case PL_R_LOCAL: return pl_poison();
    // parameters, start values, constants of the motion, indices, small numbers
    default: return p->zero;
  }
}

pl_expr pl_dt(pl_pool* p, pl_expr e) {
  return differentiate(p, e, &(rule){.of_atom = atom_in_time});
}
