// Products: what a blank means.
//
// A product is a list of factors. A function takes the bracket after it, or exactly one factor. A
// bracket that touches a coordinate is its value at a time, one that touches an axis is the
// component of a body, one that touches anything else is a factor. After a division by anything but
// a plain number a blank could go on above or below the fraction line: that is refused, with both
// readings. language.md, rules 4 and 5.
#include "lang/lower_impl.h"

#include <stdlib.h>
#include <string.h>

#include "grammar.h"

typedef struct product {
  pl_lower* l;
  const pl_ast* node;
  int at;                  // factor being read
  int run_start, run_end;  // factors of the run read last
} product;

static const pl_ast* factor(const product* p, int i) {
  return i < p->node->kids.n ? p->node->kids.at[i] : NULL;
}
static char op(const product* p, int i) { return i < p->node->ops.n ? p->node->ops.at[i] : 0; }
static bool blank_before(const product* p, int i) { return op(p, i) == ' '; }

static const char* text_between(const product* p, int from, int to) {
  pl_span s = pl_span_join(pl_ast_span(factor(p, from)), pl_ast_span(factor(p, to)));
  return pl_source_text(p->l->arena, s);
}

static pl_span span_between(const product* p, int from, int to) {
  return pl_span_join(pl_ast_span(factor(p, from)), pl_ast_span(factor(p, to)));
}

// --------------------------------------------------------------------------------------- functions
static bool is_function_factor(const product* p, int i) {
  const pl_ast* f = factor(p, i);
  if (f == NULL) return false;
  if (f->kind == PL_AST_POWER) f = pl_ast_kid(f, 0);
  return f->kind == PL_AST_NAME && pl_lower_is_function(p->l, f->key);
}

static const char* inverse_of(const char* key) {
  static const char* const pairs[][2] = {{"sin", "asin"}, {"cos", "acos"}, {"tan", "atan"},
                                         {"exp", "ln"},   {"ln", "exp"},   {"log", "exp"}};
  for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
    if (strcmp(pairs[i][0], key) == 0) return pairs[i][1];
  }
  return NULL;
}

// sin^2 θ is fine, sin^-1 means two things.
static bool refuse_exponent(product* p, const pl_ast* f) {
  if (f->kind != PL_AST_POWER) return false;
  const pl_ast* e = pl_ast_kid(f, 1);
  const pl_ast* name = pl_ast_kid(f, 0);
  bool minus = e->kind == PL_AST_NEG || (e->kind == PL_AST_NUMBER && e->text[0] == '-');
  if (!minus) return false;
  pl_diagnostic* m = pl_lower_complain(p->l, PL_E015, pl_ast_span(f),
                                       PL_BOTH("%s can mean the inverse function or one over it"),
                                       pl_source_text(p->l->arena, pl_ast_span(f)));
  const char* inverse = inverse_of(name->key);
  int next = p->at + 1;
  const char* argument = factor(p, next) && blank_before(p, next) ? text_between(p, next, next)
                                                                  : "x";
  if (inverse)
    pl_suggest(p->l->job, m, inverse, PL_BOTH("write %1$s %3$s  or  1/%2$s %3$s"), inverse,
               name->shown, argument);
  else pl_suggest(p->l->job, m, NULL, PL_BOTH("write 1/%s %s"), name->shown, argument);
  return true;
}

static void needs_brackets(product* p, int from, int to, const char* name, const char* argument,
                           const char* rest) {
  const char* whole = text_between(p, from, to);
  const char* fixed = pl_format(p->l->arena, "%s(%s)", name,
                                rest ? pl_format(p->l->arena, "%s %s", argument, rest) : argument);
  pl_diagnostic* m = pl_lower_complain(p->l, PL_E015, span_between(p, from, to),
                                       PL_BOTH("%s needs brackets"), whole);
  pl_because(p->l->job, m, PL_BOTH("without them a function takes one factor"));
  pl_suggest(p->l->job, m, fixed, PL_BOTH("write %s"), fixed);
}

static pl_quantity read_run(product* p);

// The exponent between a function and its argument.
static pl_quantity raise(product* p, const pl_ast* f, pl_quantity q) {
  return f->kind == PL_AST_POWER ? pl_lower_factor(p->l, f, pl_ast_kid(f, 0), &q) : q;
}

static bool starts_operand(const pl_ast* n) {
  const pl_ast* base = pl_ast_base(n);
  return base
         && (base->kind == PL_AST_NAME || base->kind == PL_AST_NUMBER || base->kind == PL_AST_PI
             || base->kind == PL_AST_INDEXED);
}

// After `sin θ`: a blank and t, or a number, is meant for the argument more likely than not.
static bool check_after_argument(product* p, int from, const pl_ast* name, int argument) {
  const pl_ast* next = factor(p, argument + 1);
  if (next == NULL || !blank_before(p, argument + 1) || is_function_factor(p, argument + 1))
    return true;
  const pl_ast* base = pl_ast_base(next);
  bool number_first = pl_ast_base(factor(p, argument))->kind == PL_AST_NUMBER;
  bool time = base->kind == PL_AST_NAME && strcmp(base->key, "t") == 0
              && !pl_scope_find(p->l, base->key);
  if ((number_first && (starts_operand(next) || base->kind == PL_AST_GROUP)) || time
      || base->kind == PL_AST_NUMBER) {
    needs_brackets(p, from, argument + 1, name->shown, text_between(p, argument, argument),
                   text_between(p, argument + 1, argument + 1));
    p->at = argument + 2;
    return false;
  }
  bool moving = next->kind == PL_AST_PRIME || (base->kind == PL_AST_NAME && base->number > 0);
  if (base->kind == PL_AST_NAME && !moving && next->kind == PL_AST_NAME) {
    const char* run = text_between(p, from, argument);
    pl_diagnostic* m = pl_lower_complain(p->l, PL_W071, span_between(p, from, argument + 1),
                                         PL_BOTH("%1$s is read as (%2$s) %3$s"),
                                         text_between(p, from, argument + 1), run, next->shown);
    pl_suggest(p->l->job, m, NULL, PL_BOTH("write %2$s %1$s, or %3$s(%4$s %2$s) if that is meant"),
               run, next->shown, name->shown, text_between(p, argument, argument));
  }
  return true;
}

static pl_quantity read_function(product* p) {
  pl_lower* l = p->l;
  int from = p->at;
  const pl_ast* f = factor(p, from);
  const pl_ast* name = f->kind == PL_AST_POWER ? pl_ast_kid(f, 0) : f;
  if (refuse_exponent(p, f)) {
    p->at = from + (factor(p, from + 1) && blank_before(p, from + 1) ? 2 : 1);
    return pl_quantity_bad();
  }
  const pl_ast* next = factor(p, from + 1);
  if (next == NULL || !blank_before(p, from + 1)) {
    p->at = from + 1;
    return pl_lower_call(l, name, NULL);
  }
  const pl_ast* base = pl_ast_base(next);
  if (base->kind == PL_AST_GROUP) {
    p->at = from + 2;
    pl_quantity value = pl_lower_call(l, name, base);
    bool bare = f == name;
    if (pl_quantity_is_bad(&value)) return value;
    if (next == base) return raise(p, f, value);
    return bare ? pl_lower_factor(l, next, base, &value)
                : raise(p, f, pl_lower_factor(l, next, base, &value));
  }
  // one factor, which may be a function again
  p->at = from + 1;
  bool nested = is_function_factor(p, from + 1);
  pl_quantity argument = read_run(p);
  int last = p->at - 1;
  if (!nested && !check_after_argument(p, from, name, last)) return pl_quantity_bad();
  pl_quantity value = pl_lower_apply(l, name, argument, f);
  return pl_quantity_is_bad(&value) ? value : raise(p, f, value);
}

// --------------------------------------------------------------------------- brackets that touch a
// name
static bool is_zero_number(const pl_ast* node) {
  const pl_ast* one = pl_ast_single(node);
  return one && one->kind == PL_AST_NUMBER && strtod(one->text, NULL) == 0;
}

static pl_quantity start_of(product* p, const pl_ast* place, pl_quantity q, const pl_ast* group) {
  pl_lower* l = p->l;
  if (pl_quantity_is_bad(&q)) return q;
  pl_span span = pl_span_join(pl_ast_span(place), pl_ast_span(group));
  bool symbol = pl_kind_of(l->pool, q.at[0]) == PL_SYMBOL;
  pl_symbol s = symbol ? pl_symbol_of(l->pool, q.at[0]) : (pl_symbol){0};
  pl_role role = symbol ? pl_symbol_get(l->pool, s)->role : PL_R_ARRAY;
  if (role == PL_R_COORD || role == PL_R_VELOCITY)
    return pl_quantity_of(pl_sym(l->pool, pl_symbol_start(l->pool, s)));
  bool result = role == PL_R_MULTIPLIER || role == PL_R_ACCELERATION
                || (role == PL_R_LOCAL && pl_model_result_name(l->m, s));
  if (result && l->results)
    return pl_quantity_of(
        pl_sym(l->pool, pl_model_result_derivative(l->m, PL_RES_START, q.at[0], (pl_symbol){0})));
  const char* text = pl_source_text(l->arena, pl_ast_span(place));
  pl_diagnostic* m = pl_lower_complain(l, PL_E016, span,
                                       PL_BOTH("the start value of %s cannot be named"), text);
  pl_because(
      l->job, m,
      PL_BOTH("only coordinates and velocities have one, and results where they are asked for"));
  return pl_quantity_bad();
}

// Names whose value at a time can be asked: coordinates, velocities, T V L E H, multipliers.
static bool has_moments(product* p, const pl_ast* f) {
  const pl_ast* base = pl_ast_base(f);
  if (f->kind != PL_AST_NAME && f->kind != PL_AST_PRIME && f->kind != PL_AST_INDEXED) return false;
  if (base->kind == PL_AST_INDEXED) base = pl_ast_kid(base, 0);
  if (base->kind != PL_AST_NAME || pl_scope_local(p->l, base->key)) return false;
  pl_entity* e = pl_scope_find(p->l, base->key);
  if (e) return e->kind == PL_ENTITY_COORD || e->kind == PL_ENTITY_FAMILY;
  if (p->l->results && pl_scope_multiplier(p->l, base->key)) return true;
  return p->l->results && pl_scope_is_result(base->key);
}

// E(0) where E is declared: not the energy at the start, and as a product it would be nothing.
static bool hides_a_result(product* p, const pl_ast* f, const pl_ast* group) {
  const pl_ast* only = group->kids.n == 1 ? group->kids.at[0] : NULL;
  return p->l->results && f->kind == PL_AST_NAME && only && is_zero_number(only)
         && pl_scope_is_result(f->key) && pl_scope_find(p->l, f->key);
}

static pl_quantity hidden_result(product* p, const pl_ast* f, const pl_ast* group) {
  static const char* const words[][2] = {{"T", "kinetic"},
                                         {"V", "potential"},
                                         {"L", "lagrangian"},
                                         {"E", "energy"},
                                         {"H", "hamiltonian"}};
  const char* word = f->key;
  for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
    if (strcmp(words[i][0], f->key) == 0) word = words[i][1];
  }
  pl_span span = pl_span_join(pl_ast_span(f), pl_ast_span(group));
  pl_diagnostic* m = pl_lower_complain(
      p->l, PL_E016, span, PL_BOTH("%1$s is declared here, and %1$s(0) is no start value of it"),
      f->shown);
  pl_suggest(p->l->job, m, pl_format(p->l->arena, "%s(0)", word),
             PL_BOTH("write %s(0) for the value at the start"), word);
  p->at += 2;
  return pl_quantity_bad();
}

// x(A): a component of a point.  The name is an axis and the only thing in the bracket is a label.
static bool is_component(product* p, const pl_ast* f, const pl_ast* group) {
  if (f->kind != PL_AST_NAME || f->number || group->kids.n != 1 || pl_axis_find(p->l, f->key) < 0)
    return false;
  const pl_ast* index;
  const pl_ast* label = pl_ast_label(group->kids.at[0], &index);
  if (label == NULL) return false;
  if (pl_site_find(p->l, label->key)) return true;
  return pl_scope_find(p->l, f->key) == NULL && pl_scope_local(p->l, f->key) == NULL;
}

static pl_quantity component(product* p, const pl_ast* f, const pl_ast* group) {
  const pl_ast* index;
  const pl_ast* label = pl_ast_label(group->kids.at[0], &index);
  pl_point at;
  if (!pl_lower_label_point(p->l, label, index, &at, NULL)) return pl_quantity_bad();
  int axis = pl_axis_find(p->l, f->key);
  if (axis < at.n) return pl_quantity_of(at.at[axis]);
  pl_lower_complain(p->l, PL_E029, pl_ast_span(f), PL_BOTH("%s has no %s component"), label->shown,
                    f->shown);
  return pl_quantity_bad();
}

static pl_quantity coordinate_bracket(product* p, const pl_ast* f, const pl_ast* next) {
  pl_lower* l = p->l;
  const pl_ast* group = pl_ast_base(next);
  p->at += 2;
  const pl_ast* only = group->kids.n == 1 ? group->kids.at[0] : NULL;
  pl_quantity q;
  if (only && is_zero_number(only)) q = start_of(p, f, pl_lower_quantity(l, f), group);
  else if (only && pl_ast_is_name(only, "t")) q = pl_lower_quantity(l, f);
  else {
    const char* name = pl_source_text(l->arena, pl_ast_span(f));
    const char* inner = pl_source_text(l->arena, pl_ast_span(group));
    pl_span span = pl_span_join(pl_ast_span(f), pl_ast_span(group));
    pl_diagnostic* m = pl_lower_complain(
        l, PL_E016, span,
        PL_BOTH("a bracket that touches a coordinate is its value at a time: %1$s(0) or %1$s(t)"),
        name);
    pl_suggest(l->job, m, pl_format(l->arena, "%s %s", name, inner),
               PL_BOTH("write %s %s  for the product"), name, inner);
    return pl_quantity_bad();
  }
  return next == group ? q : pl_lower_factor(l, next, group, &q);
}

// ---------------------------------------------------------------------------- numbers side by side
static bool is_plain_number(const pl_ast* n) {
  if (n->kind == PL_AST_NUMBER) return true;
  return n->kind == PL_AST_POWER && pl_ast_kid(n, 0)->kind == PL_AST_NUMBER
         && pl_ast_kid(n, 1)->kind == PL_AST_NUMBER;
}

static bool is_number_with_unit(const pl_ast* n) {
  return (n->kind == PL_AST_UNIT || n->kind == PL_AST_DEGREE) && pl_ast_kid(n, 0)
         && pl_ast_kid(n, 0)->kind == PL_AST_NUMBER;
}

// `3 kg` where kg is not a name: the unit lacks its brackets.
static bool unit_without_brackets(product* p, int i) {
  const pl_ast* f = factor(p, i);
  const pl_ast* base = pl_ast_base(f);
  if (base->kind != PL_AST_NAME || !blank_before(p, i) || i == 0
      || !is_plain_number(factor(p, i - 1)))
    return false;
  // m in 9.81 m/s^2 may be a mass; s is not a name, and the whole reads as a unit
  bool unknown = false;
  for (int k = i; k < p->node->kids.n; k++) {
    const pl_ast* b = pl_ast_base(factor(p, k));
    unknown |= b->kind == PL_AST_NAME && !pl_scope_known(p->l, b) && !pl_scope_lost(p->l, b->key);
  }
  if (!unknown) return false;
  for (int last = p->node->kids.n - 1; last >= i; last--) {
    pl_span span = span_between(p, i, last);
    const char* text = pl_source_text(p->l->arena, span);
    pl_unit unit;
    size_t bad_at, bad_n;
    const char* near;
    if (!pl_unit_parse(p->l->pool, text, strlen(text), &unit, &bad_at, &bad_n, &near)) continue;
    bool has_unknown = false;
    for (int k = i; k <= last; k++) {
      const pl_ast* b = pl_ast_base(factor(p, k));
      has_unknown |= b->kind == PL_AST_NAME && !pl_scope_known(p->l, b);
    }
    if (!has_unknown) continue;
    pl_diagnostic* m = pl_lower_complain(p->l, PL_E024, span,
                                         PL_BOTH("%s looks like a unit without brackets"), text);
    pl_suggest(p->l->job, m, pl_format(p->l->arena, "[%s]", text), PL_BOTH("write %s [%s]"),
               text_between(p, i - 1, i - 1), text);
    p->at = last + 1;
    return true;
  }
  return false;
}

static bool numbers_side_by_side(product* p, int i) {
  if (!blank_before(p, i) || i == 0) return false;
  const pl_ast *a = pl_ast_base(factor(p, i - 1)), *b = pl_ast_base(factor(p, i));
  if (a->kind != PL_AST_NUMBER || b->kind != PL_AST_NUMBER || factor(p, i - 1)->kind == PL_AST_UNIT)
    return false;
  pl_span span = pl_span_join(pl_ast_span(a), pl_ast_span(b));
  pl_diagnostic* m = pl_lower_complain(p->l, PL_E001, span, PL_BOTH("two numbers side by side"));
  // 1 000 is a thousand with a blank
  bool thousand = strlen(b->text) == 3 && strlen(a->text) <= 3 && !strpbrk(a->text, ".e")
                  && !strpbrk(b->text, ".e");
  const char* fixed = pl_format(p->l->arena, thousand ? "%s%s" : "%s*%s", a->text, b->text);
  pl_suggest(p->l->job, m, fixed, PL_BOTH("write %s"), fixed);
  return true;
}

// -------------------------------------------------------------------------------------------- runs
// A run is a factor together with the bracket or argument that it takes.
static pl_quantity read_run(product* p) {
  pl_lower* l = p->l;
  p->run_start = p->at;
  const pl_ast* f = factor(p, p->at);
  if (is_function_factor(p, p->at)) return read_function(p);
  const pl_ast* next = factor(p, p->at + 1);
  const pl_ast* group = next && blank_before(p, p->at + 1) ? pl_ast_base(next) : NULL;
  if (group && group->kind == PL_AST_GROUP && group->tight) {
    if (is_component(p, f, group)) {
      p->at += 2;
      pl_quantity q = component(p, f, group);
      l->component = group;
      return next == group || pl_quantity_is_bad(&q) ? q : pl_lower_factor(l, next, group, &q);
    }
    if (has_moments(p, f)) return coordinate_bracket(p, f, next);
    if (hides_a_result(p, f, group)) return hidden_result(p, f, group);
  }
  p->at++;
  return pl_lower_factor(l, f, NULL, NULL);
}

// ------------------------------------------------------------------------------------------ rule 5
// After  numerator / divisor : may a blank product follow?
static bool blank_is_clear(const product* p, int numerator, int divisor) {
  const pl_ast *d = factor(p, divisor), *next = factor(p, p->at);
  if (!is_plain_number(d)) return false;
  if (!pl_ast_base(next)->tight) return true;
  // 1/2(a + b) is half of it; p^2/2m could be anything
  return pl_ast_base(next)->kind == PL_AST_GROUP && is_plain_number(factor(p, numerator));
}

static void two_readings(product* p, int numerator, int divisor) {
  int last = p->at;
  while (factor(p, last + 1) && blank_before(p, last + 1)) last++;
  const char* above = text_between(p, numerator, divisor - 1);
  const char* below = text_between(p, divisor, p->at - 1);
  const char* rest = text_between(p, p->at, last);
  const char* all = text_between(p, numerator, last);
  const char* first = pl_format(p->l->arena, "(%s/%s) %s", above, below, rest);
  pl_span span = span_between(p, numerator, last);
  pl_diagnostic* m = pl_lower_complain(p->l, PL_E014, span, PL_BOTH("%s can be read in two ways"),
                                       all);
  pl_suggest(p->l->job, m, first, PL_BOTH("write %1$s  or  %2$s/(%3$s %4$s)"), first, above, below,
             rest);
  p->at = p->node->kids.n;
}

// 1/2 [m] is (1/2) m; after any other numerator the unit could belong to the divisor alone.
static bool unit_of_fraction(product* p, int numerator, int divisor, pl_quantity* q) {
  const pl_ast* d = factor(p, divisor);
  if (!is_number_with_unit(d)) return false;
  const pl_ast* n = factor(p, numerator);
  if (is_number_with_unit(n)) return false;
  pl_lower* l = p->l;
  if (!is_plain_number(n)) {
    const char* number = pl_source_text(l->arena, pl_ast_span(pl_ast_kid(d, 0)));
    const char* unit = d->kind == PL_AST_DEGREE ? "°" : pl_format(l->arena, " [%s]", d->text);
    const char* above = text_between(p, numerator, divisor - 1);
    pl_span span = span_between(p, numerator, divisor);
    pl_diagnostic* m = pl_lower_complain(l, PL_E014, span, PL_BOTH("%s can be read in two ways"),
                                         pl_source_text(l->arena, span));
    pl_suggest(l->job, m, NULL,
               PL_BOTH("write %1$s/(%2$s%3$s)  or  give %1$s its unit where it is declared"), above,
               number, unit);
    *q = pl_quantity_bad();
    return true;
  }
  pl_quantity bottom = pl_lower_quantity(l, pl_ast_kid(d, 0));
  pl_quantity fraction = pl_lower_times(l, *q, bottom, true, p->node);
  *q = pl_quantity_is_bad(&fraction) ? fraction
                                     : pl_lower_factor(l, d, pl_ast_kid(d, 0), &fraction);
  return true;
}

pl_quantity pl_lower_product(pl_lower* l, const pl_ast* node) {
  product p = {.l = l, .node = node};
  if (node->kids.n == 1) return read_run(&p);
  pl_quantity value = read_run(&p);
  int numerator = 0, divisor = -1;  // of the quotient that a blank would extend
  while (p.at < node->kids.n) {
    int i = p.at;
    char sign = op(&p, i);
    if (divisor >= 0 && sign == ' ' && !blank_is_clear(&p, numerator, divisor)) {
      two_readings(&p, numerator, divisor);
      return pl_quantity_bad();
    }
    if (numbers_side_by_side(&p, i)) return pl_quantity_bad();
    if (unit_without_brackets(&p, i)) return pl_quantity_bad();
    int before = p.run_start;
    if (sign == '/' && unit_of_fraction(&p, before, i, &value)) {
      p.run_start = p.at;
      p.at++;
      divisor = -1;
      continue;
    }
    pl_quantity next = read_run(&p);
    value = pl_lower_times(l, value, next, sign == '/', node);
    if (sign == '/') {
      numerator = before;
      divisor = i;
    } else divisor = -1;
    if (pl_quantity_is_bad(&next)) value = pl_quantity_bad();
  }
  if (value.n == 0) value.at[0] = pl_measure_join(l->pool, value.at[0]);  // 2 π [rad/s]
  return value;
}
