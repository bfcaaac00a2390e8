// Expressions: sums, factors, units, relations.  Products have rules of their own: lower_product.c.
#include "lang/lower_impl.h"

#include <stdlib.h>
#include <string.h>

#include "grammar.h"

pl_quantity pl_quantity_of(pl_expr e) { return (pl_quantity){.at = {e}}; }
pl_quantity pl_quantity_bad(void) { return (pl_quantity){0}; }

bool pl_quantity_is_bad(const pl_quantity* q) {
  for (int i = 0; i < (q->n ? q->n : 1); i++) {
    if (pl_is_poison(q->at[i])) return true;
  }
  return false;
}

// --------------------------------------------------------------------------------- shapes of trees
const pl_ast* pl_ast_single(const pl_ast* node) {
  while (node && (node->kind == PL_AST_PRODUCT || node->kind == PL_AST_SUM) && node->kids.n == 1) {
    if (node->kind == PL_AST_SUM && node->ops.at[0] == '-') return NULL;
    node = node->kids.at[0];
  }
  return node && node->kind != PL_AST_PRODUCT && node->kind != PL_AST_SUM ? node : NULL;
}

const pl_ast* pl_ast_base(const pl_ast* n) {
  while (n
         && (n->kind == PL_AST_POWER || n->kind == PL_AST_PRIME || n->kind == PL_AST_UNIT
             || n->kind == PL_AST_DEGREE))
    n = pl_ast_kid(n, 0);
  return n;
}

bool pl_ast_is_name(const pl_ast* node, const char* key) {
  const pl_ast* one = pl_ast_single(node);
  return one && one->kind == PL_AST_NAME && one->number == 0 && strcmp(one->key, key) == 0;
}

// -------------------------------------------------------------------------------------- arithmetic
static pl_quantity mixed(pl_lower* l, const pl_ast* where, const char* en, const char* de) {
  pl_lower_complain(l, PL_E017, pl_ast_span(where), en, de);
  return pl_quantity_bad();
}

pl_quantity pl_lower_add(pl_lower* l, pl_quantity a, pl_quantity b, bool minus,
                         const pl_ast* where) {
  if (pl_quantity_is_bad(&a) || pl_quantity_is_bad(&b)) return pl_quantity_bad();
  if (a.n != b.n) {
    return mixed(l, where, PL_BOTH("a vector and a number cannot be added"));
  }
  pl_quantity sum = {.n = a.n};
  for (int i = 0; i < (a.n ? a.n : 1); i++) {
    sum.at[i] = minus ? pl_sub(l->pool, a.at[i], b.at[i]) : pl_add(l->pool, a.at[i], b.at[i]);
  }
  return sum;
}

pl_quantity pl_lower_times(pl_lower* l, pl_quantity a, pl_quantity b, bool divide,
                           const pl_ast* where) {
  if (pl_quantity_is_bad(&a) || pl_quantity_is_bad(&b)) return pl_quantity_bad();
  if (b.n && divide) return mixed(l, where, PL_BOTH("nothing can be divided by a vector"));
  if (a.n && b.n) {
    pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(where),
                                         PL_BOTH("a product of two vectors"));
    pl_suggest(l->job, m, NULL, PL_BOTH("write dot(a, b) or cross(a, b)"));
    return pl_quantity_bad();
  }
  if (b.n) {
    pl_quantity swap = a;
    a = b;
    b = swap;
  }
  pl_quantity product = {.n = a.n};
  for (int i = 0; i < (a.n ? a.n : 1); i++) {
    product.at[i] = divide ? pl_div(l->pool, a.at[i], b.at[0]) : pl_mul(l->pool, a.at[i], b.at[0]);
    if (!pl_is_poison(product.at[i])) continue;
    pl_diagnostic* m = pl_lower_complain(l, PL_E040, pl_ast_span(where),
                                         PL_BOTH("this has no value"));
    if (divide) pl_because(l->job, m, PL_BOTH("division by zero"));
    return pl_quantity_bad();
  }
  return product;
}

static pl_quantity lower_sum(pl_lower* l, const pl_ast* node) {
  // n-ary at once, so that a sum of thousands of terms stays linear
  bool scalar = true;
  pl_expr* terms = PL_ARRAY(l->arena, pl_expr, node->kids.n);
  pl_quantity* all = PL_ARRAY(l->arena, pl_quantity, node->kids.n);
  bool bad = false;
  for (int i = 0; i < node->kids.n; i++) {
    all[i] = pl_lower_quantity(l, node->kids.at[i]);
    bad |= pl_quantity_is_bad(&all[i]);
    scalar &= all[i].n == 0;
  }
  if (bad) return pl_quantity_bad();
  if (scalar) {
    pl_expr minus_one = pl_int(l->pool, -1);
    for (int i = 0; i < node->kids.n; i++) {
      // a product with -1: -(a + b) stays as written
      terms[i] = node->ops.at[i] == '-' ? pl_mul(l->pool, minus_one, all[i].at[0]) : all[i].at[0];
    }
    if (node->kids.n == 1) return pl_quantity_of(terms[0]);
    return pl_quantity_of(pl_measure_join(l->pool, pl_add_n(l->pool, terms, node->kids.n)));
  }
  pl_quantity sum = all[0];
  if (node->ops.at[0] == '-')
    sum = pl_lower_times(l, sum, pl_quantity_of(pl_int(l->pool, -1)), false, node);
  for (int i = 1; i < node->kids.n; i++)
    sum = pl_lower_add(l, sum, all[i], node->ops.at[i] == '-', node);
  return sum;
}

// ------------------------------------------------------------------------------------------- units
bool pl_lower_unit(pl_lower* l, const pl_ast* node, pl_unit* out) {
  size_t bad_at = 0, bad_n = 0;
  const char* near = NULL;
  size_t n = strlen(node->text);
  if (pl_unit_parse(l->pool, node->text, n, out, &bad_at, &bad_n, &near)) return true;
  pl_span span = pl_ast_span(node);
  uint32_t start = span.end - 1 - (uint32_t)n;
  span.begin = start + (uint32_t)bad_at;
  span.end = span.begin + (uint32_t)(bad_n ? bad_n : 1);
  const char* shown = pl_copy_n(l->arena, node->text + bad_at, bad_n);
  pl_diagnostic* m = bad_n ? pl_lower_complain(l, PL_E022, span, PL_BOTH("%s is not a unit"), shown)
                           : pl_lower_complain(l, PL_E022, span, PL_BOTH("a unit is missing"));
  if (near) pl_suggest(l->job, m, near, PL_BOTH("did you mean %s?"), near);
  else pl_suggest(l->job, m, NULL, PL_BOTH("units are written as in [m/s^2], [kN m], [rad/s]"));
  return false;
}

static pl_quantity lower_with_unit(pl_lower* l, const pl_ast* node, pl_quantity q) {
  pl_unit unit;
  if (!pl_lower_unit(l, node, &unit) || pl_quantity_is_bad(&q)) return pl_quantity_bad();
  bool number = q.n == 0 && pl_is_constant(l->pool, q.at[0]);
  if (number) return pl_quantity_of(pl_measure_make(l->pool, q.at[0], &unit, node->text));
  pl_diagnostic* m = pl_lower_complain(l, PL_E023, pl_ast_span(node),
                                       PL_BOTH("a unit belongs to a number or a declaration"));
  const char* text = pl_source_text(l->arena, pl_ast_span(pl_ast_kid(node, 0)));
  pl_suggest(l->job, m, text, PL_BOTH("write %s; its unit follows from its names"), text);
  return pl_quantity_bad();
}

static pl_quantity lower_degree(pl_lower* l, const pl_ast* node, pl_quantity q) {
  if (pl_quantity_is_bad(&q)) return q;
  if (q.n || !pl_is_constant(l->pool, q.at[0]) || pl_unit_occurs(l->pool, q.at[0])) {
    pl_diagnostic* m = pl_lower_complain(l, PL_E023, pl_ast_span(node),
                                         PL_BOTH("° belongs to a number"));
    pl_because(l->job, m, PL_BOTH("angles are in radians"));
    const char* text = pl_source_text(l->arena, pl_ast_span(pl_ast_kid(node, 0)));
    pl_suggest(l->job, m, text, PL_BOTH("write %s"), text);
    return pl_quantity_bad();
  }
  return pl_quantity_of(
      pl_mul(l->pool, q.at[0], pl_div(l->pool, pl_pi(l->pool), pl_int(l->pool, 180))));
}

// ----------------------------------------------------------------------------------------- factors
static pl_quantity lower_number(pl_lower* l, const pl_ast* node) {
  return pl_quantity_of(pl_number_from_text(l->pool, node->text, strlen(node->text)));
}

static pl_quantity lower_power(pl_lower* l, const pl_ast* node, pl_quantity base) {
  const pl_ast* e = pl_ast_kid(node, 1);
  pl_expr exponent = pl_lower_scalar(l, e);
  if (pl_quantity_is_bad(&base) || pl_is_poison(exponent)) return pl_quantity_bad();
  if (base.n) {
    pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(node),
                                         PL_BOTH("a power of a vector"));
    pl_suggest(l->job, m, NULL, PL_BOTH("write dot(a, a) or norm(a)^2"));
    return pl_quantity_bad();
  }
  // exact numbers: a power with thousands of digits is not what anybody wants
  enum { MOST = 1000 };
  long n = 0;
  bool whole = pl_is_int(l->pool, exponent, &n);
  if (pl_is_constant(l->pool, base.at[0]) && pl_is_number(l->pool, exponent)
      && (whole ? labs(n) : 0) > MOST) {
    pl_lower_complain(l, PL_E007, pl_ast_span(node), PL_BOTH("this number has too many digits"));
    return pl_quantity_bad();
  }
  pl_expr value = pl_pow(l->pool, base.at[0], exponent);
  if (pl_is_poison(value)) {
    pl_lower_complain(l, PL_E040, pl_ast_span(node), PL_BOTH("this has no value"));
    return pl_quantity_bad();
  }
  return pl_quantity_of(value);
}

static pl_quantity lower_prime(pl_lower* l, const pl_ast* node) {
  const pl_ast* inner = pl_ast_kid(node, 0);
  int dots = node->number;
  while (inner->kind == PL_AST_PRIME) {
    dots += inner->number;
    inner = pl_ast_kid(inner, 0);
  }
  if (inner->kind == PL_AST_NAME && pl_lower_is_function(l, inner->key)) {
    pl_diagnostic* m = pl_lower_complain(
        l, PL_E015, pl_ast_span(node),
        PL_BOTH("a prime is a time derivative, not that of a function"));
    pl_suggest(l->job, m, NULL, PL_BOTH("write diff(%s(x), x)"), inner->shown);
    return pl_quantity_bad();
  }
  if (inner->kind == PL_AST_NAME) return pl_lower_name(l, inner, NULL, dots, node);
  if (inner->kind == PL_AST_INDEXED)
    return pl_lower_name(l, pl_ast_kid(inner, 0), pl_ast_kid(inner, 1), dots, node);
  pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(node),
                                       PL_BOTH("a prime belongs to a name"));
  const char* text = pl_source_text(l->arena, pl_ast_span(inner));
  pl_suggest(l->job, m, pl_format(l->arena, "dt%s", text), PL_BOTH("write dt%s"), text);
  return pl_quantity_bad();
}

static pl_quantity lower_group(pl_lower* l, const pl_ast* node) {
  int n = node->kids.n;
  for (int i = 0; i < n; i++) {
    pl_ast_kind k = node->kids.at[i]->kind;
    if (k != PL_AST_RELATION && k != PL_AST_IN) continue;
    pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(node->kids.at[i]),
                                         PL_BOTH("a condition cannot be a value"));
    pl_suggest(l->job, m, NULL, PL_BOTH("write if(condition, a, b) to choose between values"));
    return pl_quantity_bad();
  }
  if (n == 1) return pl_lower_quantity(l, node->kids.at[0]);
  if (n > 3) {
    pl_lower_complain(l, PL_E017, pl_ast_span(node),
                      PL_BOTH("a vector has at most three components"));
    return pl_quantity_bad();
  }
  pl_quantity v = {.n = n};
  bool bad = false;
  for (int i = 0; i < n; i++) {
    v.at[i] = pl_lower_scalar(l, node->kids.at[i]);
    bad |= pl_is_poison(v.at[i]);
  }
  return bad ? pl_quantity_bad() : v;
}

// A factor with what hangs on it. When base is met on the way down its value is base_value: sin
// (x)^2 is (sin (x))^2.
pl_quantity pl_lower_factor(pl_lower* l, const pl_ast* node, const pl_ast* base,
                            const pl_quantity* base_value) {
  if (node == base) return *base_value;
  switch (node->kind) {
    case PL_AST_POWER:
      return lower_power(l, node, pl_lower_factor(l, pl_ast_kid(node, 0), base, base_value));
    case PL_AST_UNIT:
      return lower_with_unit(l, node, pl_lower_factor(l, pl_ast_kid(node, 0), base, base_value));
    case PL_AST_DEGREE:
      return lower_degree(l, node, pl_lower_factor(l, pl_ast_kid(node, 0), base, base_value));
    case PL_AST_PRIME:
      if (base && base == l->component) {  // x(K)' is dt(x(K))
        pl_quantity q = pl_lower_factor(l, pl_ast_kid(node, 0), base, base_value);
        for (int i = 0; i < node->number && !pl_quantity_is_bad(&q); i++)
          q.at[0] = pl_dt(l->pool, q.at[0]);
        return q;
      }
      if (base && pl_ast_base(node) == base) {
        pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(node),
                                             PL_BOTH("a prime belongs to a name"));
        pl_suggest(l->job, m, NULL, PL_BOTH("write dt(...)"));
        return pl_quantity_bad();
      }
      return lower_prime(l, node);
    default: return pl_lower_quantity(l, node);
  }
}

pl_quantity pl_lower_quantity(pl_lower* l, const pl_ast* node) {
  switch (node->kind) {
    case PL_AST_NUMBER: return lower_number(l, node);
    case PL_AST_PI: return pl_quantity_of(pl_pi(l->pool));
    case PL_AST_INFINITY:
      if (l->infinity) return pl_quantity_of(pl_infinity(l->pool));
      pl_lower_complain(l, PL_E017, pl_ast_span(node),
                        PL_BOTH("∞ can only be the target of a limit"));
      return pl_quantity_bad();
    case PL_AST_NAME:
      if (pl_lower_is_function(l, node->key)) return pl_lower_call(l, node, NULL);
      return pl_lower_name(l, node, NULL, 0, node);
    case PL_AST_INDEXED: return pl_lower_name(l, pl_ast_kid(node, 0), pl_ast_kid(node, 1), 0, node);
    case PL_AST_GROUP: return lower_group(l, node);
    case PL_AST_PRODUCT: return pl_lower_product(l, node);
    case PL_AST_SUM: return lower_sum(l, node);
    case PL_AST_NEG:
      return pl_lower_times(l, pl_lower_quantity(l, pl_ast_kid(node, 0)),
                            pl_quantity_of(pl_int(l->pool, -1)), false, node);
    case PL_AST_POWER:
    case PL_AST_UNIT:
    case PL_AST_DEGREE:
    case PL_AST_PRIME: return pl_lower_factor(l, node, NULL, NULL);
    case PL_AST_RELATION:
    case PL_AST_IN:
      pl_lower_complain(l, PL_E017, pl_ast_span(node), PL_BOTH("a condition cannot be a value"));
      return pl_quantity_bad();
    default: l->wrong++; return pl_quantity_bad();
  }
}

pl_expr pl_lower_scalar(pl_lower* l, const pl_ast* node) {
  int wrong = l->wrong;
  pl_quantity q = pl_lower_quantity(l, node);
  if (q.n) {
    pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(node),
                                         PL_BOTH("a number is needed here, not a vector"));
    pl_suggest(l->job, m, NULL, PL_BOTH("take a component, x(A), or norm(...)"));
    return pl_poison();
  }
  if (pl_is_poison(q.at[0]) && l->wrong == wrong) {
    pl_lower_complain(l, PL_E040, pl_ast_span(node), PL_BOTH("this has no value"));
  }
  return q.at[0];
}

// --------------------------------------------------------------------------------------- relations
pl_relation pl_relation_of(char op) {
  switch (op) {
    case 'g': return PL_GE;
    case 'l': return PL_LE;
    case '>': return PL_GT;
    case '<': return PL_LT;
    case '!': return PL_NE;
    default: return PL_EQ;
  }
}

// Pair `at` of a chain: 0 < r < l has the pairs 0 and 1.
bool pl_lower_relation(pl_lower* l, const pl_ast* node, pl_condition* out, int at) {
  const pl_ast *left = node->kids.at[at], *right = node->kids.at[at + 1];
  pl_quantity a = pl_lower_quantity(l, left), b = pl_lower_quantity(l, right);
  if (pl_quantity_is_bad(&a) || pl_quantity_is_bad(&b)) return false;
  if (a.n || b.n) {
    pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(node),
                                         PL_BOTH("vectors cannot be compared"));
    pl_suggest(l->job, m, NULL, PL_BOTH("write one relation for each component"));
    return false;
  }
  pl_span span = at == 0 && node->kids.n == 2 ? pl_ast_span(node)
                                              : pl_span_join(pl_ast_span(left), pl_ast_span(right));
  *out = (pl_condition){a.at[0], b.at[0], pl_relation_of(node->ops.at[at + 1]), span};
  return true;
}
