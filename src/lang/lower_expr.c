// Expressions: sums, names, factors, relations.  Products have rules of their own: lower_product.c.
#include "lang/lower_impl.h"

#include <stdlib.h>
#include <string.h>

#include "grammar.h"

// -------------------------------------------------------------------------------------------- sums
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

// ----------------------------------------------------------------------------------- abbreviations
// Made of given quantities only?  Then it stays a name.
static bool only_given(pl_lower* l, pl_expr e) {
  e = pl_unit_to_si(l->pool, e);
  int n = pl_symbols_in(l->pool, e, NULL, 0);
  pl_symbol* s = PL_ARRAY(l->arena, pl_symbol, n + 1);
  pl_symbols_in(l->pool, e, s, n);
  for (int i = 0; i < n; i++) {
    if (pl_symbol_get(l->pool, s[i])->role != PL_R_PARAM) return false;
  }
  return !pl_has_role(l->pool, e, PL_R_ARRAY) && !pl_has_role(l->pool, e, PL_R_COORD);
}

static void circle(pl_lower* l, pl_entity* e) {
  pl_diagnostic* m = pl_lower_complain(l, PL_E018, e->span, PL_BOTH("%s leads back to itself"),
                                       e->shown);
  pl_suggest(l->job, m, NULL, PL_BOTH("write its right side without %s"), e->shown);
  e->broken = true;
}

void pl_scope_finish_let(pl_lower* l, pl_entity* e) {
  if (e->state == 2) return;
  if (e->state == 1) {
    if (!e->broken) circle(l, e);
    return;
  }
  enum { MAX_DEPTH = 300 };
  if (l->call_depth > MAX_DEPTH) {
    pl_lower_complain(l, PL_E006, e->span, PL_BOTH("abbreviations are nested too deeply"));
    e->broken = true;
    e->state = 2;
    return;
  }
  // its right side is read where it stands: no locals, no block
  e->state = 1;
  l->call_depth++;
  pl_block* block = l->block;
  int n_locals = l->locals.n;
  bool results = l->results, infinity = l->infinity;
  pl_local* locals = l->locals.at;
  l->block = NULL;
  l->locals.n = 0;
  l->locals.at = NULL;
  l->locals.cap = 0;
  l->results = true;
  l->infinity = false;
  l->mute += e->broken;
  int wrong = l->wrong;
  pl_quantity q = pl_lower_quantity(l, e->override ? e->override : pl_ast_kid(e->definition, 2));
  l->mute -= e->broken;
  l->locals.at = locals;
  l->locals.n = n_locals;
  l->locals.cap = n_locals;
  l->block = block;
  l->results = results;
  l->infinity = infinity;
  l->call_depth--;
  e->state = 2;
  if (l->wrong > wrong || pl_quantity_is_bad(&q)) e->broken = true;
  e->n = q.n;
  memcpy(e->at, q.at, sizeof e->at);
  e->value = q.at[0];
  e->inserted = e->broken || q.n > 0 || !only_given(l, e->value);
  const pl_ast* name = pl_ast_kid(e->definition, 0);
  e->symbol = pl_scope_symbol(l, name, e->inserted ? PL_R_LOCAL : PL_R_PARAM);
  pl_push(l->arena, l->m->lets,
          (pl_let){.symbol = e->symbol,
                   .inserted = e->inserted,
                   .value = e->value,
                   .span = pl_ast_span(e->definition)});
  if (!e->inserted) e->value = pl_sym(l->pool, e->symbol);
}

// ------------------------------------------------------------------------------------------- names
static pl_expr lower_index(pl_lower* l, const pl_ast* index) {
  if (index->kind == PL_AST_RANGE) {
    pl_lower_complain(l, PL_E025, pl_ast_span(index),
                      PL_BOTH("one index is needed here, not a range"));
    return pl_poison();
  }
  return pl_lower_scalar(l, index);
}

// An index where none belongs.  "g[m/s^2]" is a unit that lacks its blank.
static pl_quantity no_family(pl_lower* l, const pl_ast* name, const pl_ast* place,
                             const pl_ast* index) {
  pl_unit unit;
  size_t bad_at, bad_n;
  const char* near;
  const char* text = pl_source_text(l->arena, pl_ast_span(index));
  const pl_ast* one = pl_ast_single(index);
  bool is_index = !index || index->kind == PL_AST_SUM
                  || (one
                      && (one->kind == PL_AST_NUMBER
                          || (one->kind == PL_AST_NAME && pl_scope_local(l, one->key))));
  if (!is_index && pl_unit_parse(l->pool, text, strlen(text), &unit, &bad_at, &bad_n, &near)) {
    pl_diagnostic* m = pl_lower_complain(l, PL_E023, pl_ast_span(place),
                                         PL_BOTH("a unit belongs to a number or a declaration"));
    pl_suggest(l->job, m, name->shown, PL_BOTH("remove [%s]"), text);
    return pl_quantity_bad();
  }
  pl_diagnostic* m = pl_lower_complain(l, PL_E025, pl_ast_span(place),
                                       PL_BOTH("%s is not a family, so it takes no index"),
                                       name->shown);
  pl_suggest(l->job, m, NULL, PL_BOTH("declare  coord %s[1..N]"), name->shown);
  return pl_quantity_bad();
}

static pl_quantity no_derivative(pl_lower* l, const pl_ast* place, const char* shown) {
  pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(place),
                                       PL_BOTH("%s does not move, so it has no derivative"), shown);
  pl_suggest(l->job, m, NULL, PL_BOTH("declare  coord %s  if it moves"), shown);
  return pl_quantity_bad();
}

static pl_quantity name_of_entity(pl_lower* l, pl_entity* e, const pl_ast* name,
                                  const pl_ast* index, int dots, const pl_ast* place) {
  if (e->broken && e->kind != PL_ENTITY_COORD && e->kind != PL_ENTITY_PARAM
      && e->kind != PL_ENTITY_FAMILY) {
    l->wrong++;
    return pl_quantity_bad();
  }
  if (e->kind == PL_ENTITY_FAMILY) {
    if (index == NULL) {
      pl_diagnostic* m = pl_lower_complain(l, PL_E025, pl_ast_span(place),
                                           PL_BOTH("%s is a family, so it needs an index"),
                                           e->shown);
      pl_suggest(l->job, m, pl_format(l->arena, "%s[1]", e->shown),
                 PL_BOTH("write %s[1] or, inside for, %s[i]"), e->shown, e->shown);
      return pl_quantity_bad();
    }
    pl_expr i = lower_index(l, index);
    return pl_is_poison(i) ? pl_quantity_bad() : pl_quantity_of(pl_at(l->pool, e->symbol, dots, i));
  }
  if (index) return no_family(l, name, place, index);
  switch (e->kind) {
    case PL_ENTITY_COORD:
      return pl_quantity_of(pl_sym(l->pool, pl_scope_dotted(l, e->symbol, dots)));
    case PL_ENTITY_LET: {
      pl_scope_finish_let(l, e);
      if (e->broken) {
        l->wrong++;
        return pl_quantity_bad();
      }
      if (dots && !e->inserted) return no_derivative(l, place, e->shown);
      pl_quantity q = {.n = e->n};
      memcpy(q.at, e->at, sizeof q.at);
      if (e->n == 0) q.at[0] = e->value;
      for (; dots > 0; dots--) {
        for (int k = 0; k < (q.n ? q.n : 1); k++) q.at[k] = pl_dt(l->pool, q.at[k]);
      }
      return q;
    }
    case PL_ENTITY_FUNCTION: {
      pl_diagnostic* m = pl_lower_complain(l, PL_E015, pl_ast_span(place),
                                           PL_BOTH("%s needs an argument"), e->shown);
      pl_suggest(l->job, m, NULL, PL_BOTH("write %s(...)"), e->shown);
      return pl_quantity_bad();
    }
    default:
      if (dots) return no_derivative(l, place, e->shown);
      return pl_quantity_of(pl_sym(l->pool, e->symbol));
  }
}

static pl_quantity name_of_multiplier(pl_lower* l, const pl_rule* r, const pl_ast* index, int dots,
                                      const pl_ast* place) {
  if (dots) {
    pl_lower_complain(l, PL_E017, pl_ast_span(place),
                      PL_BOTH("multipliers have no derivative here"));
    return pl_quantity_bad();
  }
  if (r->family && index == NULL) {
    pl_diagnostic* m = pl_lower_complain(
        l, PL_E025, pl_ast_span(place),
        PL_BOTH("%s is a family of constraints, so its multiplier needs an index"), r->shown);
    pl_suggest(l->job, m, pl_format(l->arena, "λ_%s[1]", r->shown), PL_BOTH("write λ_%s[1]"),
               r->shown);
    return pl_quantity_bad();
  }
  if (!r->family && index) {
    pl_lower_complain(l, PL_E025, pl_ast_span(place),
                      PL_BOTH("%s is not a family, so it takes no index"), r->shown);
    return pl_quantity_bad();
  }
  if (index == NULL) return pl_quantity_of(pl_sym(l->pool, r->lambda));
  pl_expr i = lower_index(l, index);
  return pl_is_poison(i) ? pl_quantity_bad() : pl_quantity_of(pl_at(l->pool, r->lambda, 0, i));
}

static pl_quantity name_of_momentum(pl_lower* l, const pl_ast* name, const pl_entity* coordinate) {
  pl_symbol_info info = {.name = pl_format(l->arena, "p_%s", coordinate->shown),
                         .ascii = name->key,
                         .role = PL_R_MOMENTUM,
                         .class = PL_C_OTHER,
                         .dimension = pl_dimension_one(),
                         .base = coordinate->symbol};
  return pl_quantity_of(pl_sym(l->pool, pl_symbol_make(l->pool, &info)));
}

static pl_quantity several_multipliers(pl_lower* l, const pl_ast* name) {
  pl_text all = pl_text_make(l->arena);
  for (int i = 0; i < l->rules.n && i < 6; i++)
    pl_text_addf(&all, "%sλ_%s", i ? ", " : "", l->rules.at[i].shown);
  pl_diagnostic* m = pl_lower_complain(
      l, PL_E011, pl_ast_span(name),
      PL_BOTH(l->rules.n ? "there are several multipliers"
                         : "λ is not declared: there is no constraint"));
  if (l->rules.n)
    pl_suggest(l->job, m, NULL, PL_BOTH("write %1$s, or name one in its constraint: with λ"),
               pl_text_string(&all));
  return pl_quantity_bad();
}

pl_quantity pl_lower_name(pl_lower* l, const pl_ast* name, const pl_ast* index, int dots,
                          const pl_ast* place) {
  dots += name->number;
  if (dots > 2) {
    pl_lower_complain(l, PL_E017, pl_ast_span(place),
                      PL_BOTH("only first and second derivatives can be written"));
    return pl_quantity_bad();
  }
  const pl_local* local = pl_scope_local(l, name->key);
  if (local) {
    if (index) return no_family(l, name, place, index);
    pl_quantity q = {.n = local->n};
    memcpy(q.at, local->at, sizeof q.at);
    if (local->n == 0) q.at[0] = local->symbol.id ? pl_sym(l->pool, local->symbol) : local->value;
    for (int d = 0; d < dots; d++) {
      for (int k = 0; k < (q.n ? q.n : 1); k++) q.at[k] = pl_dt(l->pool, q.at[k]);
    }
    return q;
  }
  pl_entity* e = pl_scope_find(l, name->key);
  if (e) return name_of_entity(l, e, name, index, dots, place);
  int more;
  bool start;
  if (pl_scope_alias(l, name, &e, &more, &start)) {
    if (!start) return name_of_entity(l, e, name, index, dots + more, place);
    if (e->kind == PL_ENTITY_COORD && dots == 0 && more <= 1) {
      return pl_quantity_of(
          pl_sym(l->pool, pl_symbol_start(l->pool, pl_scope_dotted(l, e->symbol, more))));
    }
  }
  if (strcmp(name->key, "t") == 0 && !index)
    return dots ? no_derivative(l, place, "t") : pl_quantity_of(pl_sym(l->pool, pl_time(l->pool)));
  pl_rule* rule = pl_scope_multiplier(l, name->key);
  if (rule) return name_of_multiplier(l, rule, index, dots, place);
  pl_result_kind kind;
  pl_expr output = l->results && !index ? pl_scope_output(l, name->key) : pl_poison();
  for (int d = 0; d < dots && !pl_is_poison(output); d++) output = pl_dt(l->pool, output);
  if (!pl_is_poison(output)) return pl_quantity_of(output);
  if (l->results && !index && dots == 0 && pl_scope_result(name->key, &kind)) {
    return pl_quantity_of(pl_sym(l->pool, pl_model_result_symbol(l->m, kind, NULL)));
  }
  if (!index && dots == 0 && pl_scope_momentum(l, name->key, &e))
    return name_of_momentum(l, name, e);
  if (strcmp(name->key, "lambda") == 0 && !pl_scope_lost(l, name->key))
    return several_multipliers(l, name);
  if (l->infinity && (strcmp(name->key, "inf") == 0 || strcmp(name->key, "infinity") == 0))
    return pl_quantity_of(pl_infinity(l->pool));
  if (!l->results && pl_scope_result(name->key, &kind) && !pl_scope_lost(l, name->key)) {
    pl_diagnostic* m = pl_scope_unknown(l, name);
    pl_because(l->job, m, PL_BOTH("as a result it can stand in ask, plot and event only"));
    return pl_quantity_bad();
  }
  pl_scope_unknown(l, name);
  return pl_quantity_bad();
}

// ------------------------------------------------------------------------------------------- units
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
