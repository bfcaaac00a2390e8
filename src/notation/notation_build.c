// Forms -> boxes: the walk that decides where brackets stand, in the precedence of the model
// language.
//
// Rule 5 of the language: after a division by anything but a plain number no blank product may
// follow, so such a quotient gets brackets inside a product, and m1/2 r² does not. Stacked
// fractions need no brackets at all.
#include "notation_impl.h"

#include <string.h>

// of nested forms; deeper ones are cut with "…" rather than exhaust the stack
enum { MAX_DEPTH = 400 };

// ------------------------------------------------------------------------------------------- boxes
pl_box* pl_box_make(pl_arena* a, pl_box_kind k, pl_level level, int n) {
  pl_box* b = PL_NEW(a, pl_box);
  b->kind = k;
  b->level = level;
  b->n = n;
  b->at = n ? PL_ARRAY(a, pl_box*, n) : NULL;
  b->text = "";
  return b;
}

pl_box* pl_box_text(pl_arena* a, pl_box_kind k, const char* text) {
  pl_box* b = pl_box_make(a, k, PL_LEVEL_ATOM, 0);
  b->text = text;
  b->starts_digit = k == PL_B_NUMBER;
  return b;
}

pl_box* pl_box_op(pl_arena* a, const char* text, pl_op_role role) {
  pl_box* b = pl_box_text(a, PL_B_OP, text);
  b->role = role;
  return b;
}

pl_box* pl_box_fence(pl_arena* a, pl_box* inside, const char* text) {
  pl_box* b = pl_box_make(a, PL_B_FENCE, PL_LEVEL_ATOM, 1);
  b->at[0] = inside;
  b->text = text;
  b->tall = inside->tall;
  b->has_sum = inside->has_sum;
  return b;
}

// Carries what is visible from the parts to the whole.
static pl_box* inherit(pl_box* b) {
  for (int i = 0; i < b->n; i++) {
    b->tall |= b->at[i]->tall;
    b->has_sum |= b->at[i]->has_sum;
  }
  if (b->n) b->starts_digit = b->at[0]->starts_digit;
  return b;
}

static pl_box* bracketed(pl_builder* b, pl_box* x) {
  return x->kind == PL_B_FENCE && strcmp(x->text, "(") == 0 ? x : pl_box_fence(b->arena, x, "(");
}

static pl_box* at_least(pl_builder* b, pl_box* x, pl_level level) {
  return x->level < level ? bracketed(b, x) : x;
}

static pl_box* row2(pl_builder* b, pl_level level, pl_box* x, pl_box* y) {
  pl_box* r = pl_box_make(b->arena, PL_B_ROW, level, 2);
  r->at[0] = x;
  r->at[1] = y;
  return inherit(r);
}

// Forms that need at least one argument and have none are cut short as unreadable.
static bool is_hollow(const pl_form* f) {
  static const int needed[] = {
      [PL_F_NEG] = 1,      [PL_F_QUOTIENT] = 2,  [PL_F_POWER] = 2,    [PL_F_ROOT] = 1,
      [PL_F_GROUP] = 1,    [PL_F_PLUSMINUS] = 1, [PL_F_RELATION] = 2, [PL_F_DERIVATIVE] = 1,
      [PL_F_INTEGRAL] = 1, [PL_F_ORDER] = 1,     [PL_F_TEXT] = 0,
  };
  return (size_t)f->kind >= sizeof needed / sizeof *needed || f->n < needed[f->kind];
}

// ------------------------------------------------------------------------------------- minus signs
static const pl_form* without_minus_below(pl_builder* b, const pl_form* f, bool* negative,
                                          int depth);

// The form without its leading minus; *negative is flipped when there was one.
static const pl_form* without_minus(pl_builder* b, const pl_form* f, bool* negative) {
  return without_minus_below(b, f, negative, 0);
}

static const pl_form* without_minus_below(pl_builder* b, const pl_form* f, bool* negative,
                                          int depth) {
  pl_arena* a = b->arena;
  if (is_hollow(f) || depth > MAX_DEPTH) return f;
  switch (f->kind) {
    case PL_F_NEG:
      *negative = !*negative;
      return without_minus_below(b, f->args[0], negative, depth + 1);
    case PL_F_EXPR:
      if (!pl_is_number(b->pool, f->expr) || pl_number_sign(b->pool, f->expr) >= 0) return f;
      *negative = !*negative;
      return pl_form_leaf(a, pl_neg(b->pool, f->expr));
    case PL_F_PRODUCT:
    case PL_F_QUOTIENT: {
      if (f->n < 1) return f;
      bool minus = false;
      const pl_form* first = without_minus_below(b, f->args[0], &minus, depth + 1);
      if (!minus) return f;
      *negative = !*negative;
      if (f->kind == PL_F_QUOTIENT) return pl_form_quotient(a, first, f->args[1]);
      const pl_form** args = PL_ARRAY(a, const pl_form*, f->n);
      memcpy(args, f->args, (size_t)f->n * sizeof *args);
      args[0] = first;
      return pl_form_product(a, args, f->n);
    }
    default: return f;
  }
}

static pl_box* minus_box(pl_builder* b, pl_box* x) {
  pl_box* r = row2(b, PL_LEVEL_SUM, pl_box_op(b->arena, "-", PL_OP_PREFIX),
                   at_least(b, x, PL_LEVEL_PRODUCT));
  r->starts_digit = false;
  r->open_slash = x->open_slash;
  return r;
}

// -------------------------------------------------------------------------------------------- sums
static bool is_measure_box(const pl_box* x) {
  return x->kind == PL_B_ROW && x->n == 2 && x->at[1]->kind == PL_B_UNIT;
}

// Does the model have a name like a part of this unit? On a line nothing else tells metres from a
// mass m.
static bool reads_like_a_name(pl_builder* b, const char* unit) {
  if (b->how.math == PL_MATH_TEX || b->how.math == PL_MATH_MATHML || b->how.math == PL_MATH_ASCII)
    return false;
  for (const char* s = unit; *s;) {
    size_t n = 0;
    while ((s[n] >= 'a' && s[n] <= 'z') || (s[n] >= 'A' && s[n] <= 'Z')) n++;
    if (n && pl_symbol_find(b->pool, pl_copy_n(b->arena, s, n)).id) return true;
    s += n ? n : 1;
  }
  return false;
}

static pl_box* build_sum(pl_builder* b, const pl_form* f) {
  if (f->n == 0) return pl_box_text(b->arena, PL_B_NUMBER, "0");
  if (f->n == 1) return pl_build(b, f->args[0]);
  PL_VEC(pl_box*) parts = {0};
  for (int i = 0; i < f->n; i++) {
    bool minus = false;
    const pl_form* term = without_minus(b, f->args[i], &minus);
    pl_box* x = pl_build(b, term);
    if (i > 0) pl_push(b->arena, parts, pl_box_op(b->arena, minus ? "-" : "+", PL_OP_INFIX));
    else if (minus) pl_push(b->arena, parts, pl_box_op(b->arena, "-", PL_OP_PREFIX));
    // a sum inside a sum keeps its brackets: the form wants to be read that way; 0.5 m beside a
    // mass m is no half of it
    if (is_measure_box(x) && reads_like_a_name(b, x->at[1]->text)) x = bracketed(b, x);
    pl_push(b->arena, parts, at_least(b, x, PL_LEVEL_PRODUCT));
  }
  pl_box* r = pl_box_make(b->arena, PL_B_ROW, PL_LEVEL_SUM, parts.n);
  memcpy(r->at, parts.at, (size_t)parts.n * sizeof *r->at);
  inherit(r);
  r->has_sum = true;
  return r;
}

// ---------------------------------------------------------------------------------------- products
typedef PL_VEC(const pl_form*) form_list;

// Products inside products are written as one.
static void flatten(pl_builder* b, const pl_form* f, form_list* out, int depth) {
  for (int i = 0; i < f->n; i++) {
    if (f->args[i]->kind == PL_F_PRODUCT && depth < MAX_DEPTH)
      flatten(b, f->args[i], out, depth + 1);
    else pl_push(b->arena, *out, f->args[i]);
  }
}

// A factor as it may stand at place i of n.
static pl_box* factor_box(pl_builder* b, pl_box* x, int i, int n) {
  if (x->level < PL_LEVEL_PRODUCT) return bracketed(b, x);
  bool last = i == n - 1;
  bool quotient = x->level == PL_LEVEL_PRODUCT;
  if (n > 1 && is_measure_box(x)) return bracketed(b, x);                          // (0.5 m) k
  if (quotient && i > 0 && x->starts_digit) return bracketed(b, x);                // m (1/2)
  if (quotient && x->open_slash && (!last || x->has_sum)) return bracketed(b, x);  // (g/R) cos ϑ
  return x;
}

static bool is_bare(const pl_box* x, pl_box_kind kind, int argument) {
  return x->kind == kind && x->at[argument]->kind != PL_B_FENCE && x->level == PL_LEVEL_ATOM;
}

static pl_box* with_clear_argument(pl_builder* b, pl_box* application) {
  pl_box* clear = pl_box_make(b->arena, PL_B_APPLY, PL_LEVEL_ATOM, 2);
  *clear = *application;
  clear->at = PL_ARRAY(b->arena, pl_box*, 2);
  clear->at[0] = application->at[0];
  clear->at[1] = pl_box_fence(b->arena, application->at[1], "(");
  return clear;
}

static bool is_plain_name(const pl_box* x) {
  if (x->kind == PL_B_POWER) x = x->at[0];
  if (x->kind == PL_B_ROW && x->level == PL_LEVEL_ATOM) x = x->at[0];  // x1(0)
  return (x->kind == PL_B_NAME || x->kind == PL_B_INDEXED) && x->dots == 0 && !x->free_name;
}

// What a blank after `cos φ` or `√2` would be misread as: cos φ l is cos(φ) l, √2 l is √2·l.
static bool needs_dot(pl_builder* b, pl_box** before, const pl_box* x) {
  if (is_bare(*before, PL_B_APPLY, 1) && is_plain_name(x))
    *before = with_clear_argument(b, *before);
  bool root = b->how.math == PL_MATH_LINE && is_bare(*before, PL_B_ROOT, 0);
  return x->starts_digit || (root && x->kind != PL_B_APPLY);
}

static pl_box* build_product(pl_builder* b, const pl_form* f) {
  form_list factors = {0};
  flatten(b, f, &factors, 0);
  if (factors.n == 0) return pl_box_text(b->arena, PL_B_NUMBER, "1");
  if (factors.n == 1) return pl_build(b, factors.at[0]);
  PL_VEC(pl_box*) parts = {0};
  for (int i = 0; i < factors.n; i++) {
    pl_box* x = factor_box(b, pl_build(b, factors.at[i]), i, factors.n);
    if (i > 0 && needs_dot(b, &parts.at[parts.n - 1], x))
      pl_push(b->arena, parts, pl_box_op(b->arena, "·", PL_OP_TIGHT));
    pl_push(b->arena, parts, x);
  }
  pl_box* r = pl_box_make(b->arena, PL_B_PRODUCT, PL_LEVEL_PRODUCT, parts.n);
  memcpy(r->at, parts.at, (size_t)parts.n * sizeof *r->at);
  inherit(r);
  r->open_slash = r->at[r->n - 1]->open_slash;
  return r;
}

// --------------------------------------------------------------------------------------- quotients
static pl_box* fraction(pl_builder* b, pl_box* num, pl_box* den) {
  pl_box* r = pl_box_make(b->arena, PL_B_FRACTION, PL_LEVEL_PRODUCT, 2);
  r->at[0] = num;
  r->at[1] = den;
  inherit(r);
  // a stacked fraction is one piece: it needs brackets only under an exponent
  r->tall = true;
  r->starts_digit = false;
  r->has_sum = false;
  return r;
}

// 2 m1 m2 g / (m1 + m2), but (m1 - m2)/(m1 + m2), x1'²/2, δm g/(2 m2): blanks around the slash
// where the parts are long.
static bool wide_slash(const pl_box* num, const pl_box* den) {
  if (!den->has_sum) return false;
  bool short_num = num->level >= PL_LEVEL_POWER;
  bool short_den = (den->kind == PL_B_FENCE && den->at[0]->level == PL_LEVEL_SUM)
                   || den->kind == PL_B_ROOT;
  return !(short_num && short_den);
}

// cos α/2 could be cos(α/2): the argument of what stands right before a slash gets its brackets.
static pl_box* clear_before_slash(pl_builder* b, pl_box* num, const pl_box* den) {
  if (den->kind != PL_B_NUMBER && den->kind != PL_B_NAME) return num;
  if (is_bare(num, PL_B_APPLY, 1)) return with_clear_argument(b, num);
  if (num->kind != PL_B_PRODUCT || !is_bare(num->at[num->n - 1], PL_B_APPLY, 1)) return num;
  pl_box* r = pl_box_make(b->arena, PL_B_PRODUCT, num->level, num->n);
  pl_box** at = r->at;
  *r = *num;
  r->at = at;
  memcpy(at, num->at, (size_t)num->n * sizeof *at);
  at[num->n - 1] = with_clear_argument(b, num->at[num->n - 1]);
  return r;
}

static pl_box* slash(pl_builder* b, pl_box* num, pl_box* den) {
  bool again = num->level == PL_LEVEL_PRODUCT && num->open_slash;  // (a/b)/c, (m g/l)/c
  num = again ? bracketed(b, num) : at_least(b, num, PL_LEVEL_PRODUCT);
  den = at_least(b, den, PL_LEVEL_POWER);
  num = clear_before_slash(b, num, den);
  pl_box* r = pl_box_make(b->arena, PL_B_ROW, PL_LEVEL_PRODUCT, 3);
  r->at[0] = num;
  r->at[2] = den;
  r->at[1] = pl_box_op(b->arena, "/", wide_slash(num, den) ? PL_OP_INFIX : PL_OP_TIGHT);
  inherit(r);
  r->open_slash = den->kind != PL_B_NUMBER;
  return r;
}

static pl_box* quotient(pl_builder* b, pl_box* num, pl_box* den) {
  return b->flat ? slash(b, num, den) : fraction(b, num, den);
}

// ----------------------------------------------------------------------------------- powers, roots
// Exponents are always written flat: x^(3/2), also where fractions are stacked.
static pl_box* build_exponent(pl_builder* b, const pl_form* f) {
  bool flat = b->flat;
  b->flat = true;
  pl_box* x = pl_build(b, f);
  b->flat = flat;
  return x;
}

static bool is_positive_integer(pl_builder* b, const pl_form* f) {
  return f->kind == PL_F_EXPR && pl_is_int(b->pool, f->expr, NULL)
         && pl_number_sign(b->pool, f->expr) > 0;
}

// sin²φ is written for these only; ln²x would not be read back.
static bool takes_power(pl_function f) {
  return f == PL_SIN || f == PL_COS || f == PL_TAN || f == PL_SINH || f == PL_COSH || f == PL_TANH;
}

static pl_box* build_call(pl_builder* b, const pl_form* f, pl_box* exponent);

static pl_box* power_box(pl_builder* b, pl_box* base, pl_box* exponent) {
  pl_box* r = pl_box_make(b->arena, PL_B_POWER, PL_LEVEL_POWER, 2);
  r->at[0] = base;
  r->at[1] = exponent;
  r->tall = base->tall;
  r->has_sum = base->has_sum;
  r->starts_digit = base->starts_digit;
  return r;
}

static pl_box* build_power(pl_builder* b, const pl_form* f) {
  const pl_form* base = f->args[0];
  pl_box* exponent = build_exponent(b, f->args[1]);
  if (base->kind == PL_F_CALL && takes_power(base->function) && base->n == 1
      && is_positive_integer(b, f->args[1]))
    return build_call(b, base, exponent);
  pl_box* x = pl_build(b, base);
  bool plain = x->level == PL_LEVEL_ATOM && x->kind != PL_B_APPLY && x->kind != PL_B_ROOT
               && x->kind != PL_B_SUM_OVER && x->kind != PL_B_CASES;
  return power_box(b, plain ? x : bracketed(b, x), exponent);
}

static pl_box* build_root(pl_builder* b, const pl_form* f) {
  pl_box* x = pl_build(b, f->args[0]);
  bool bare = (x->kind == PL_B_NUMBER || x->kind == PL_B_NAME) && x->dots == 0;
  if (b->flat && !bare) x = bracketed(b, x);
  pl_box* r = pl_box_make(b->arena, PL_B_ROOT, PL_LEVEL_ATOM, 1);
  r->at[0] = x;
  inherit(r);
  r->tall = true;
  r->starts_digit = false;
  return r;
}

// --------------------------------------------------------------------------------------- functions
static pl_box* comma_row(pl_builder* b, const pl_form* const* args, int n) {
  PL_VEC(pl_box*) parts = {0};
  for (int i = 0; i < n; i++) {
    if (i) pl_push(b->arena, parts, pl_box_op(b->arena, ",", PL_OP_COMMA));
    pl_push(b->arena, parts, pl_build(b, args[i]));
  }
  pl_box* r = pl_box_make(b->arena, PL_B_ROW, PL_LEVEL_LOOSE, parts.n);
  if (parts.n) memcpy(r->at, parts.at, (size_t)parts.n * sizeof *r->at);
  return inherit(r);
}

static pl_box* word(pl_builder* b, const char* text, const char* tex) {
  pl_box* w = pl_box_text(b->arena, PL_B_WORD, text);
  w->tex = tex;
  return w;
}

static pl_box* apply(pl_builder* b, pl_box* head, pl_box* argument) {
  pl_box* r = pl_box_make(b->arena, PL_B_APPLY, PL_LEVEL_ATOM, 2);
  r->at[0] = head;
  r->at[1] = argument;
  r->tall = argument->tall;
  r->has_sum = argument->has_sum;
  return r;
}

// cos φ, cos ϑ(0), but cos(2 φ), cos(φ'), exp(x).
static bool may_stand_bare(pl_function f, const pl_box* x) {
  if (f == PL_EXP || f == PL_ABS || f == PL_SIGN) return false;
  if (x->kind == PL_B_ROW && x->level == PL_LEVEL_ATOM) x = x->at[0];  // cos ϑ(0)
  return x->kind == PL_B_NAME && x->dots == 0;
}

static pl_box* build_call(pl_builder* b, const pl_form* f, pl_box* exponent) {
  bool stacked = !b->flat;
  if (f->function == PL_EXP && stacked && f->n == 1)
    return power_box(b, pl_box_text(b->arena, PL_B_NAME, "e"), build_exponent(b, f->args[0]));
  if (f->function == PL_ABS && stacked && f->n == 1)
    return pl_box_fence(b->arena, pl_build(b, f->args[0]), "|");
  pl_box* x = comma_row(b, f->args, f->n);
  if (x->n == 1) x = x->at[0];
  pl_box* head = word(b, pl_function_name[f->function], pl_function_tex[f->function]);
  if (exponent) head = power_box(b, head, exponent);
  return apply(b, head, may_stand_bare(f->function, x) ? x : bracketed(b, x));
}

// ------------------------------------------------------------------------------------------ leaves
static pl_box* build_if(pl_builder* b, pl_expr e) {
  pl_arena* a = b->arena;
  const pl_form* arg[3];
  for (int i = 0; i < 3; i++) arg[i] = pl_form_of(a, b->pool, pl_arg(b->pool, e, i));
  const pl_form* zero = pl_form_leaf(a, pl_int(b->pool, 0));
  arg[0] = pl_form_relation(a, arg[0], ">", zero);
  if (b->flat)
    return apply(b, word(b, "if", "\\operatorname{if}"), bracketed(b, comma_row(b, arg, 3)));
  pl_box* r = pl_box_make(a, PL_B_CASES, PL_LEVEL_SUM, 3);
  for (int i = 0; i < 3; i++) r->at[i] = pl_build(b, arg[i]);
  r->tall = true;
  return r;
}

static pl_box* build_sum_over(pl_builder* b, pl_expr e) {
  pl_arena* a = b->arena;
  pl_notation how = b->how;
  int n = pl_n_args(b->pool, e);
  pl_box* index = pl_box_symbol(a, b->pool, pl_symbol_of(b->pool, e), how);
  pl_box* lo = pl_build(b, pl_form_of(a, b->pool, pl_arg(b->pool, e, n - 3)));
  pl_box* hi = pl_build(b, pl_form_of(a, b->pool, pl_arg(b->pool, e, n - 2)));
  pl_box* body = pl_build(b, pl_form_of(a, b->pool, pl_arg(b->pool, e, n - 1)));
  if (!b->flat) {
    pl_box* r = pl_box_make(a, PL_B_SUM_OVER, PL_LEVEL_PRODUCT, 4);
    r->at[0] = index;
    r->at[1] = lo;
    r->at[2] = hi;
    r->at[3] = at_least(b, body, PL_LEVEL_PRODUCT);
    r->tall = true;
    r->open_slash = true;
    return r;
  }
  pl_box* in = pl_box_make(a, PL_B_ROW, PL_LEVEL_LOOSE, 7);
  in->at[0] = index;
  in->at[2] = lo;
  in->at[4] = hi;
  in->at[6] = body;
  in->at[1] = pl_box_op(a, "in", PL_OP_INFIX);
  in->at[3] = pl_box_op(a, "..", PL_OP_TIGHT);
  in->at[5] = pl_box_op(a, ",", PL_OP_COMMA);
  return apply(b, word(b, "sum", "\\sum"), bracketed(b, in));
}

static pl_box* build_number(pl_builder* b, pl_expr e) {
  bool negative;
  const char *num, *den;
  pl_number_parts(b->arena, b->pool, e, b->how, &negative, &num, &den);
  pl_box* x = pl_box_text(b->arena, PL_B_NUMBER, num);
  if (den) x = quotient(b, x, pl_box_text(b->arena, PL_B_NUMBER, den));
  return negative ? minus_box(b, x) : x;
}

// 0.5 m, (1/3) m, √2 m: the number as written, and its unit. As a factor it gets brackets, so that
// m can be a mass beside it.
static pl_box* build_measure(pl_builder* b, const pl_symbol_info* info) {
  const char* digits = pl_is_number(b->pool, info->written)
                           ? pl_number_decimal(b->arena, b->pool, info->written, b->how)
                           : NULL;
  pl_box* number = digits ? pl_box_text(b->arena, PL_B_NUMBER, digits) : NULL;
  bool flat = b->flat;
  b->flat = true;
  if (!number)
    number = at_least(b, pl_build(b, pl_form_of(b->arena, b->pool, info->written)),
                      PL_LEVEL_PRODUCT);
  b->flat = flat;
  if (number->kind == PL_B_ROW) number = bracketed(b, number);
  pl_box* r = row2(b, PL_LEVEL_PRODUCT, number, pl_box_text(b->arena, PL_B_UNIT, info->unit));
  r->open_slash = true;
  return r;
}

static pl_box* build_leaf(pl_builder* b, pl_expr e) {
  pl_arena* a = b->arena;
  if (pl_is_measure(b->pool, e))
    return build_measure(b, pl_symbol_get(b->pool, pl_symbol_of(b->pool, e)));
  switch (pl_kind_of(b->pool, e)) {
    case PL_POISON:
      return pl_box_text(a, PL_B_PROSE,
                         b->how.lang == PL_GERMAN ? pl_german("undefined") : "undefined");
    case PL_NUMBER: return build_number(b, e);
    case PL_PI: return pl_box_text(a, PL_B_NAME, b->how.math == PL_MATH_ASCII ? "pi" : "π");
    case PL_INFINITY: return pl_box_text(a, PL_B_NAME, b->how.math == PL_MATH_ASCII ? "inf" : "∞");
    case PL_SYMBOL: return pl_box_symbol(a, b->pool, pl_symbol_of(b->pool, e), b->how);
    case PL_AT: {
      pl_box* index = build_exponent(b, pl_form_of(a, b->pool, pl_arg(b->pool, e, 0)));
      return pl_box_array(a, b->pool, pl_symbol_of(b->pool, e), pl_dots_of(b->pool, e), index,
                          b->how);
    }
    case PL_IF: return build_if(b, e);
    case PL_SUM: return build_sum_over(b, e);
    default: {
      const pl_form* f = pl_form_of(a, b->pool, e);
      if (f->kind == PL_F_EXPR && pl_same(f->expr, e))
        return pl_box_text(a, PL_B_PROSE, pl_expr_text(a, b->pool, e));
      return pl_build(b, f);
    }
  }
}

// 981/100 is the number 9.81, any other quotient is a quotient.
static bool is_decimal(pl_builder* b, const pl_form* num, const pl_form* den) {
  if (num->kind != PL_F_EXPR || den->kind != PL_F_EXPR) return false;
  if (!pl_is_int(b->pool, num->expr, NULL) || !pl_is_int(b->pool, den->expr, NULL)) return false;
  if (pl_number_sign(b->pool, den->expr) <= 0) return false;
  bool negative;
  const char *above, *below;
  pl_number_parts(b->arena, b->pool, pl_div(b->pool, num->expr, den->expr), b->how, &negative,
                  &above, &below);
  return below == NULL && strpbrk(above, ".,") != NULL;
}

static pl_box* build_quotient(pl_builder* b, const pl_form* f) {
  const pl_form *num = f->args[0], *den = f->args[1];
  if (is_decimal(b, num, den)) return build_number(b, pl_div(b->pool, num->expr, den->expr));
  return quotient(b, pl_build(b, num), pl_build(b, den));
}

// -------------------------------------------------------------------------------------- statements
static pl_box* infix(pl_builder* b, pl_box* l, const char* op, pl_box* r) {
  pl_box* row = pl_box_make(b->arena, PL_B_ROW, PL_LEVEL_LOOSE, 3);
  row->at[0] = l;
  row->at[1] = pl_box_op(b->arena, op, PL_OP_INFIX);
  row->at[2] = r;
  return inherit(row);
}

static bool says_vector(const pl_form* f) {
  if (f->kind == PL_F_VECTOR) return true;
  return f->kind == PL_F_RELATION && f->n == 2
         && (says_vector(f->args[0]) || says_vector(f->args[1]));
}

// A name that is said to be a vector gets its arrow: Z = λ e_r.
static pl_box* build_relation(pl_builder* b, const pl_form* f) {
  pl_box *left = pl_build(b, f->args[0]), *right = pl_build(b, f->args[1]);
  if (f->args[0]->kind == PL_F_NAME && left->kind == PL_B_NAME && says_vector(f->args[1]))
    left->arrow = true;
  return infix(b, left, f->text ? f->text : "=", right);
}

static pl_box* build_plusminus(pl_builder* b, const pl_form* f) {
  pl_arena* a = b->arena;
  pl_box* last = at_least(b, pl_build(b, f->args[f->n - 1]), PL_LEVEL_PRODUCT);
  pl_box* r = f->n == 1 ? row2(b, PL_LEVEL_SUM, pl_box_op(a, "±", PL_OP_PREFIX), last)
                        : infix(b, pl_build(b, f->args[0]), "±", last);
  r->level = PL_LEVEL_SUM;
  r->has_sum = true;
  return r;
}

// λ e_x, -m g cos ϑ e_r + m g sin ϑ e_ϑ: a sum of products with the unit vectors, zero components
// left out.
static pl_box* build_vector(pl_builder* b, const pl_form* f) {
  pl_arena* a = b->arena;
  form_list terms = {0};
  for (int i = 0; i < f->n; i++) {
    const pl_form* c = f->args[i];
    if (c->kind == PL_F_EXPR && pl_is_zero_node(b->pool, c->expr)) continue;
    const pl_form* unit = pl_form_name(a, f->names ? f->names[i] : "e", pl_poison());
    bool minus = false;
    c = without_minus(b, c, &minus);
    if (c->kind == PL_F_EXPR && pl_is_one_node(b->pool, c->expr)) c = unit;
    else c = pl_form_product(a, (const pl_form* const[]){c, unit}, 2);
    pl_push(a, terms, minus ? pl_form_neg(a, c) : c);
  }
  if (terms.n == 0) return pl_box_text(a, PL_B_NUMBER, "0");
  return pl_build(b, pl_form_sum(a, terms.at, terms.n));
}

static pl_box* build_derivative(pl_builder* b, const pl_form* f) {
  pl_arena* a = b->arena;
  const pl_form* x = pl_form_leaf(a, f->expr);
  if (b->flat) {
    const pl_form* args[] = {f->args[0], x};
    return apply(b, word(b, "diff", "\\operatorname{diff}"), bracketed(b, comma_row(b, args, 2)));
  }
  const char* d = f->text && strcmp(f->text, "∂") == 0 ? "∂" : "d";
  pl_box *what = pl_build(b, f->args[0]), *by = pl_build(b, x);
  pl_box* below = row2(b, PL_LEVEL_ATOM, pl_box_op(a, d, PL_OP_TIGHT), by);
  if (what->level == PL_LEVEL_ATOM && !what->tall)
    return fraction(b, row2(b, PL_LEVEL_ATOM, pl_box_op(a, d, PL_OP_TIGHT), what), below);
  pl_box* r = pl_box_make(a, PL_B_PRODUCT, PL_LEVEL_PRODUCT, 2);
  r->at[0] = fraction(b, pl_box_op(a, d, PL_OP_TIGHT), below);
  r->at[1] = at_least(b, what, PL_LEVEL_POWER);
  return inherit(r);
}

// ∫ dφ √(...), the variable first, as in a table of integrals
static pl_box* build_integral(pl_builder* b, const pl_form* f) {
  pl_arena* a = b->arena;
  const pl_form* x = pl_form_leaf(a, f->expr);
  if (b->how.math == PL_MATH_ASCII) {
    const pl_form* args[] = {f->args[0], x};
    return apply(b, word(b, "integral", ""), bracketed(b, comma_row(b, args, 2)));
  }
  pl_box* r = pl_box_make(a, PL_B_PRODUCT, PL_LEVEL_PRODUCT, 3);
  r->at[0] = pl_box_op(a, "∫", PL_OP_PREFIX);
  r->at[1] = row2(b, PL_LEVEL_ATOM, pl_box_op(a, "d", PL_OP_TIGHT), pl_build(b, x));
  r->at[2] = at_least(b, pl_build(b, f->args[0]), PL_LEVEL_PRODUCT);
  inherit(r);
  r->open_slash = true;
  r->tall = !b->flat;
  return r;
}

static pl_box* build_order(pl_builder* b, const pl_form* f) {
  pl_box* o = pl_box_text(b->arena, PL_B_NAME, "O");
  return row2(b, PL_LEVEL_ATOM, o, bracketed(b, pl_build(b, f->args[0])));
}

static pl_box* build_words(pl_builder* b, const pl_form* f) {
  const char* s = f->words[b->how.lang == PL_GERMAN];
  if (!s) s = f->words[PL_ENGLISH];
  pl_box* r = pl_box_text(b->arena, PL_B_PROSE, s ? s : "");
  return r;
}

static pl_box* build_kind(pl_builder* b, const pl_form* f) {
  switch (f->kind) {
    case PL_F_EXPR: return build_leaf(b, f->expr);
    case PL_F_SUM: return build_sum(b, f);
    case PL_F_NEG: return minus_box(b, pl_build(b, f->args[0]));
    case PL_F_PRODUCT: return build_product(b, f);
    case PL_F_QUOTIENT: return build_quotient(b, f);
    case PL_F_POWER: return build_power(b, f);
    case PL_F_ROOT: return build_root(b, f);
    case PL_F_CALL: return build_call(b, f, NULL);
    case PL_F_GROUP: return bracketed(b, pl_build(b, f->args[0]));
    case PL_F_PLUSMINUS: return build_plusminus(b, f);
    case PL_F_RELATION: return build_relation(b, f);
    case PL_F_VECTOR: return build_vector(b, f);
    case PL_F_NAME: return pl_box_free_name(b->arena, f->text, b->how);
    case PL_F_DERIVATIVE: return build_derivative(b, f);
    case PL_F_INTEGRAL: return build_integral(b, f);
    case PL_F_ORDER: return build_order(b, f);
    case PL_F_LIST: return comma_row(b, f->args, f->n);
    case PL_F_TEXT: return build_words(b, f);
  }
  return pl_box_text(b->arena, PL_B_PROSE, "?");
}

pl_box* pl_build(pl_builder* b, const pl_form* f) {
  if (!f || is_hollow(f)) return pl_box_text(b->arena, PL_B_PROSE, "?");
  if (b->depth >= MAX_DEPTH) return pl_box_text(b->arena, PL_B_PROSE, "…");
  b->depth++;
  bool negative = false;
  const pl_form* positive = f->kind == PL_F_EXPR ? f : without_minus(b, f, &negative);
  pl_box* r = build_kind(b, positive);
  if (negative) r = minus_box(b, r);
  b->depth--;
  return r;
}
