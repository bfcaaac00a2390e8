// Forms: an expression as it is to be written.  The makers, the value of a form, and its size.
#include "expr/expr_impl.h"

#include <limits.h>
#include <string.h>

// ------------------------------------------------------------------------------------------ makers
pl_form* pl_form_make(pl_arena* a, pl_form_kind k, int n, const pl_form* const* args) {
  pl_form* f = PL_NEW(a, pl_form);
  f->kind = k;
  f->n = n;
  if (n > 0) {
    const pl_form** copy = PL_ARRAY(a, const pl_form*, n);
    memcpy(copy, args, (size_t)n * sizeof *copy);
    f->args = copy;
  }
  return f;
}

pl_form* pl_form_leaf(pl_arena* a, pl_expr e) {
  pl_form* f = pl_form_make(a, PL_F_EXPR, 0, NULL);
  f->expr = e;
  return f;
}

pl_form* pl_form_sum(pl_arena* a, const pl_form* const* terms, int n) {
  return pl_form_make(a, PL_F_SUM, n, terms);
}

pl_form* pl_form_product(pl_arena* a, const pl_form* const* factors, int n) {
  return pl_form_make(a, PL_F_PRODUCT, n, factors);
}

pl_form* pl_form_neg(pl_arena* a, const pl_form* x) { return pl_form_make(a, PL_F_NEG, 1, &x); }

pl_form* pl_form_quotient(pl_arena* a, const pl_form* num, const pl_form* den) {
  return pl_form_make(a, PL_F_QUOTIENT, 2, (const pl_form* const[]){num, den});
}

pl_form* pl_form_power(pl_arena* a, const pl_form* base, const pl_form* exponent) {
  return pl_form_make(a, PL_F_POWER, 2, (const pl_form* const[]){base, exponent});
}

pl_form* pl_form_root(pl_arena* a, const pl_form* x) { return pl_form_make(a, PL_F_ROOT, 1, &x); }

pl_form* pl_form_call(pl_arena* a, pl_function f, const pl_form* const* args, int n) {
  pl_form* x = pl_form_make(a, PL_F_CALL, n, args);
  x->function = f;
  return x;
}

pl_form* pl_form_relation(pl_arena* a, const pl_form* lhs, const char* op, const pl_form* rhs) {
  pl_form* x = pl_form_make(a, PL_F_RELATION, 2, (const pl_form* const[]){lhs, rhs});
  x->text = op;
  return x;
}

pl_form* pl_form_name(pl_arena* a, const char* text, pl_expr value) {
  pl_form* x = pl_form_make(a, PL_F_NAME, 0, NULL);
  x->text = text;
  x->expr = value;
  return x;
}

pl_form* pl_form_vector(pl_arena* a, const pl_form* const* components,
                        const char* const* unit_vectors, int n) {
  pl_form* x = pl_form_make(a, PL_F_VECTOR, n, components);
  const char** names = PL_ARRAY(a, const char*, n);
  for (int i = 0; i < n; i++) names[i] = unit_vectors[i];
  x->names = names;
  return x;
}

pl_form* pl_form_words(pl_arena* a, const char* en, const char* de) {
  pl_form* x = pl_form_make(a, PL_F_TEXT, 0, NULL);
  x->words[PL_ENGLISH] = en;
  x->words[PL_GERMAN] = de;
  return x;
}

// ------------------------------------------------------------------------------------------- value
enum { MAX_DEPTH = 4000 };

static pl_expr value_at(pl_pool* p, const pl_form* f, int depth);

static pl_expr value_of_all(pl_pool* p, const pl_form* f, int depth) {
  pl_exprs args = {0};
  for (int i = 0; i < f->n; i++) pl_temp_push(p, args, value_at(p, f->args[i], depth + 1));
  pl_expr e = f->kind == PL_F_SUM ? pl_add_n(p, args.at, args.n) : pl_mul_n(p, args.at, args.n);
  pl_temp_free(p, args);
  return e;
}

static pl_expr value_at(pl_pool* p, const pl_form* f, int depth) {
  if (depth > MAX_DEPTH) return pl_poison();
  if (f->kind == PL_F_SUM || f->kind == PL_F_PRODUCT) return value_of_all(p, f, depth);
  pl_expr x = f->n > 0 ? value_at(p, f->args[0], depth + 1) : pl_poison();
  pl_expr y = f->n > 1 ? value_at(p, f->args[1], depth + 1) : pl_poison();
  switch (f->kind) {
    case PL_F_EXPR: return f->expr;
    case PL_F_NAME: return f->expr;
    case PL_F_NEG: return pl_neg(p, x);
    case PL_F_QUOTIENT: return pl_div(p, x, y);
    case PL_F_POWER: return pl_pow(p, x, y);
    case PL_F_ROOT: return pl_sqrt(p, x);
    case PL_F_CALL: return f->n == 2 ? pl_call2(p, f->function, x, y) : pl_call(p, f->function, x);
    case PL_F_GROUP: return x;
    case PL_F_DERIVATIVE:
      return pl_kind_of(p, f->expr) == PL_SYMBOL ? pl_diff(p, x, pl_symbol_of(p, f->expr))
                                                 : pl_diff_at(p, x, f->expr);
    // statements, vectors, words; two values at once; what was left open
    default: return pl_poison();
  }
}

pl_expr pl_form_value(pl_pool* p, const pl_form* f) { return value_at(p, f, 0); }

// -------------------------------------------------------------------------------------------- size
static long ops_at(const pl_form* f, int depth) {
  if (depth > MAX_DEPTH) return 0;
  long n = 0;
  for (int i = 0; i < f->n; i++) {
    // a - b is one operator
    bool minus = f->kind == PL_F_SUM && i > 0 && f->args[i]->kind == PL_F_NEG;
    long of_arg = ops_at(f->args[i], depth + 1) - minus;
    if (__builtin_add_overflow(n, of_arg, &n)) return LONG_MAX / 2;
  }
  switch (f->kind) {
    case PL_F_SUM:
    case PL_F_PRODUCT:
    case PL_F_LIST: return n + (f->n > 0 ? f->n - 1 : 0);
    case PL_F_VECTOR: return n + 2l * f->n - 1;
    case PL_F_NEG:
    case PL_F_QUOTIENT:
    case PL_F_POWER:
    case PL_F_ROOT:
    case PL_F_CALL:
    case PL_F_PLUSMINUS:
    case PL_F_RELATION:
    case PL_F_DERIVATIVE:
    case PL_F_INTEGRAL:
    case PL_F_ORDER: return n + 1;
    default: return n;
  }
}

long pl_form_ops(const pl_form* f) { return ops_at(f, 0); }

const pl_form* pl_form_positive_first(pl_arena* a, const pl_form* f) {
  if (f->kind != PL_F_SUM || f->args[0]->kind != PL_F_NEG) return f;
  const pl_form** term = PL_ARRAY(a, const pl_form*, f->n);
  int n = 0;
  for (int k = 0; k < f->n; k++) {
    if (f->args[k]->kind != PL_F_NEG) term[n++] = f->args[k];
  }
  if (n == 0) return f;
  for (int k = 0; k < f->n; k++) {
    if (f->args[k]->kind == PL_F_NEG) term[n++] = f->args[k];
  }
  return pl_form_sum(a, term, n);
}
