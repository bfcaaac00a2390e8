// Values in balls: one operation, and the exact expressions that stand behind numbers, parameters
// and start values.
//
// Arb's functions include the image of every point of their arguments; outside a domain they give a
// ball that is not finite, which spreads. A condition that the ball does not decide gives such a
// ball too.
#include "enclose/enclose_impl.h"

enum { MAX_DEPTH = 400 };  // names that are given by names

// -------------------------------------------------------------------------------------- operations
static void choose(arb_t out, arb_srcptr a, bool is_a, arb_srcptr b, bool is_b) {
  if (is_a) arb_set(out, a);
  else if (is_b) arb_set(out, b);
  else arb_indeterminate(out);
}

static void minimum(arb_t out, arb_srcptr a, arb_srcptr b) {
  choose(out, a, arb_le(a, b), b, arb_lt(b, a));
}
static void maximum(arb_t out, arb_srcptr a, arb_srcptr b) {
  choose(out, a, arb_ge(a, b), b, arb_gt(b, a));
}

static void absolute(arb_t out, arb_srcptr a) {
  if (arb_is_nonnegative(a)) arb_set(out, a);
  else if (arb_is_negative(a)) arb_neg(out, a);
  else arb_indeterminate(out);
}

static void sign_of(arb_t out, arb_srcptr a) {
  if (arb_contains_zero(a) && !arb_is_zero(a)) arb_indeterminate(out);
  else arb_set_si(out, arb_is_positive(a) ? 1 : arb_is_negative(a) ? -1 : 0);
}

void pl_ball_op(arb_t out, pl_op op, arb_srcptr a, arb_srcptr b, arb_srcptr c, slong prec) {
  switch (op) {
    case PL_OP_ADD: arb_add(out, a, b, prec); break;
    case PL_OP_SUB: arb_sub(out, a, b, prec); break;
    case PL_OP_NEG: arb_neg(out, a); break;
    case PL_OP_SCALE:
    case PL_OP_MUL: arb_mul(out, a, b, prec); break;
    case PL_OP_RSCALE:
    case PL_OP_DIV: arb_div(out, a, b, prec); break;
    case PL_OP_ABS: absolute(out, a); break;
    case PL_OP_SIGN: sign_of(out, a); break;
    case PL_OP_MIN: minimum(out, a, b); break;
    case PL_OP_MAX: maximum(out, a, b); break;
    case PL_OP_IF: choose(out, b, arb_is_positive(a), c, arb_is_nonpositive(a)); break;
    case PL_OP_SQR: arb_sqr(out, a, prec); break;
    case PL_OP_SQRT: arb_sqrt(out, a, prec); break;
    case PL_OP_POW: arb_pow(out, a, b, prec); break;
#define ARB_1(function) function(out, a, prec)
#define ARB_2(function) function(out, a, b, prec)
#define PL_FUNCTION(name, text, n, tex, form, value, derivative, library, ...) \
  case PL_OP_##name:                                                           \
    ARB_##n(arb_##library);                                                    \
    break;
#define PL_PIECEWISE(...)
#include "expr/functions.def"
    default: arb_indeterminate(out); break;
  }
}

double pl_ball_double(arb_srcptr x) { return arf_get_d(arb_midref(x), ARF_RND_NEAR); }

// ------------------------------------------------------------------------------- exact expressions
static bool evaluate(pl_exact* x, arb_t out, pl_expr e);

static bool number(pl_exact* x, arb_t out, pl_expr e) {
  fmpq_t q;
  fmpq_init(q);
  fmpz_set_str(fmpq_numref(q), pl_number_num_text(x->arena, x->p->pool, e), 10);
  fmpz_set_str(fmpq_denref(q), pl_number_den_text(x->arena, x->p->pool, e), 10);
  arb_set_fmpq(out, q, x->prec);
  fmpq_clear(q);
  return true;
}

// What a name stands for: a parameter, or the start value of a coordinate or velocity.
static pl_expr meaning(const pl_exact* x, pl_expr e) {
  uint64_t place = pl_map_get(x->place, e.id);
  if (place > 0) {
    int i = (int)place - 1, n_q = x->p->setup->n_q;
    return i < n_q ? x->p->q_start[i] : x->p->v_start[i - n_q];
  }
  if (pl_kind_of(x->p->pool, e) != PL_SYMBOL) return pl_poison();
  uint32_t id = pl_symbol_of(x->p->pool, e).id;
  return (int)id < x->p->n_symbols ? x->p->exact[id] : pl_poison();
}

static bool name(pl_exact* x, arb_t out, pl_expr e) {
  pl_expr value = meaning(x, e);
  if (!pl_is_poison(value)) return evaluate(x, out, value);
  if (!x->missing) x->missing = pl_expr_text(x->arena, x->p->pool, e);
  return false;
}

static bool power(pl_exact* x, arb_t out, arb_srcptr base, arb_srcptr exponent, pl_expr e) {
  long num, den;
  if (!pl_is_ratio(x->p->pool, e, &num, &den) || den > 1000000) {
    arb_pow(out, base, exponent, x->prec);
    return true;
  }
  if (den == 1) {
    arb_set(out, base);
  } else {
    arb_root_ui(out, base, (ulong)den, x->prec);
  }
  arb_pow_ui(out, out, (ulong)(num < 0 ? -num : num), x->prec);
  if (num < 0) arb_inv(out, out, x->prec);
  return true;
}

static bool call(pl_exact* x, arb_t out, const arb_srcptr* a, int n, pl_expr e) {
  pl_op op = pl_op_of_function[pl_function_of(x->p->pool, e)];
  pl_ball_op(out, op, a[0], n > 1 ? a[1] : a[0], a[0], x->prec);
  return true;
}

static bool with_arguments(pl_exact* x, arb_t out, pl_expr e, const arb_srcptr* a, int n) {
  const pl_pool* p = x->p->pool;
  switch (pl_kind_of(p, e)) {
    case PL_ADD:
      arb_set(out, a[0]);
      for (int i = 1; i < n; i++) arb_add(out, out, a[i], x->prec);
      return true;
    case PL_MUL:
      arb_set(out, a[0]);
      for (int i = 1; i < n; i++) arb_mul(out, out, a[i], x->prec);
      return true;
    case PL_POW: return power(x, out, a[0], a[1], pl_arg(p, e, 1));
    case PL_CALL: return call(x, out, a, n, e);
    case PL_IF: pl_ball_op(out, PL_OP_IF, a[0], a[1], a[2], x->prec); return true;
    default: return false;
  }
}

static arb_ptr keep(pl_exact* x) {
  arb_ptr b = flint_malloc(sizeof(arb_struct));
  arb_init(b);
  pl_push(x->arena, x->balls, b);
  return b;
}

static bool inner(pl_exact* x, arb_t out, pl_expr e) {
  int n = pl_n_args(x->p->pool, e);
  if (n == 0) return false;
  arb_srcptr* a = PL_ARRAY(x->arena, arb_srcptr, n);
  for (int i = 0; i < n; i++) {
    arb_ptr b = keep(x);
    if (!evaluate(x, b, pl_arg(x->p->pool, e, i))) return false;
    a[i] = b;
  }
  return with_arguments(x, out, e, a, n);
}

static bool evaluate_new(pl_exact* x, arb_t out, pl_expr e) {
  switch (pl_kind_of(x->p->pool, e)) {
    case PL_NUMBER: return number(x, out, e);
    case PL_PI: arb_const_pi(out, x->prec); return true;
    case PL_SYMBOL:
    case PL_AT: return name(x, out, e);
    default: return inner(x, out, e);
  }
}

static bool evaluate(pl_exact* x, arb_t out, pl_expr e) {
  if (pl_is_poison(e)) return false;
  uint64_t known = pl_map_get(x->done, e.id);
  if (known) {
    arb_set(out, x->balls.at[known - 1]);
    return true;
  }
  if (x->depth >= MAX_DEPTH) return false;
  x->depth++;
  bool ok = evaluate_new(x, out, e);
  x->depth--;
  if (!ok) return false;
  arb_set(keep(x), out);
  pl_map_set(x->done, e.id, (uint64_t)x->balls.n);
  return true;
}

void pl_exact_begin(pl_exact* x, slong prec) {
  pl_exact_free(x);
  x->prec = prec;
  x->done = pl_map_make(x->arena);
}

void pl_exact_free(pl_exact* x) {
  for (int i = 0; i < x->balls.n; i++) {
    arb_clear(x->balls.at[i]);
    flint_free(x->balls.at[i]);
  }
  x->balls.n = 0;
}

bool pl_exact_ball(pl_exact* x, arb_t out, pl_expr e) {
  return evaluate(x, out, e) && arb_is_finite(out);
}
