// Quantities, and questions about trees that need no names: what the other rooms of the lowering
// stand on.
#include <string.h>

#include "lang/lower_impl.h"

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
