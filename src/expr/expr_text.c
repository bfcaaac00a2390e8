// The text of an expression for machines: ASCII, explicit * and ^, brackets where they are needed,
// names as in pl_symbol_info.ascii, numbers with units as their value in SI. It reads back with the
// model language and depends on structure and names only.
//   -2*g*m1*m2/(m1 + m2)      sqrt(l^2 - r^2*sin(phi)^2)      3*cos(theta) - 2
#include "expr/expr_impl.h"

enum { MAX_DEPTH = 4000 };                    // of brackets in brackets
static const long max_operators = 20l << 20;  // a text of some hundred megabytes

typedef struct writer {
  pl_text text;
  const pl_pool* p;
} writer;

// How tightly the text of a node holds together.
typedef enum binding { SUM, PRODUCT, POWER, ATOM } binding;

static void write(writer* w, pl_expr e);
static void write_in(writer* w, pl_expr e, binding outer);

static void add(writer* w, const char* s) { pl_text_add(&w->text, s); }

// ----------------------------------------------------------------------------------------- numbers
// The size of a number, without its sign.
static const char* unsigned_num(writer* w, pl_expr x) {
  const char* s = pl_number_num_text(w->text.arena, w->p, x);
  return *s == '-' ? s + 1 : s;
}

static bool num_is_one(writer* w, pl_expr x) {
  const char* s = unsigned_num(w, x);
  return s[0] == '1' && s[1] == '\0';
}

static void write_number(writer* w, pl_expr x) {
  if (pl_number_sign(w->p, x) < 0) add(w, "-");
  add(w, unsigned_num(w, x));
  if (!pl_number_is_integer(w->p, x))
    pl_text_addf(&w->text, "/%s", pl_number_den_text(w->text.arena, w->p, x));
}

// ------------------------------------------------------------------------------------------ powers
static bool is_below_line(const pl_pool* p, pl_expr factor) {
  return pl_kind_of(p, factor) == PL_POW && pl_number_sign(p, pl_arg(p, factor, 1)) < 0;
}

// base^|x|: with x a number whose sign was already written as a fraction, or any other exponent.
static void write_power(writer* w, pl_expr base, pl_expr x, bool inverse) {
  const pl_pool* p = w->p;
  long num, den;
  bool small = pl_is_ratio(p, x, &num, &den);
  if (small && inverse) num = -num;
  if (small && num == 1 && den == 1) {
    write_in(w, base, POWER);
  } else if (small && num == 1 && den == 2) {
    add(w, "sqrt(");
    write(w, base);
    add(w, ")");
  } else {
    write_in(w, base, ATOM);
    bool bare = pl_is_number(p, x)
                    ? pl_number_is_integer(p, x) && (inverse || pl_number_sign(p, x) > 0)
                    : pl_kind_of(p, x) == PL_SYMBOL || pl_kind_of(p, x) == PL_PI;
    add(w, bare ? "^" : "^(");
    if (inverse) {
      add(w, unsigned_num(w, x));
      if (!pl_number_is_integer(p, x))
        pl_text_addf(&w->text, "/%s", pl_number_den_text(w->text.arena, p, x));
    } else {
      write(w, x);
    }
    if (!bare) add(w, ")");
  }
}

static void write_factor(writer* w, pl_expr e, bool inverse) {
  if (pl_kind_of(w->p, e) == PL_POW)
    write_power(w, pl_arg(w->p, e, 0), pl_arg(w->p, e, 1), inverse);
  else write_in(w, e, POWER);
}

// ---------------------------------------------------------------------------------------- products
// Numerator, and behind one stroke the denominator; the sign of the coefficient is the caller's.
static void write_product(writer* w, const pl_term* t) {
  const pl_pool* p = w->p;
  const pl_expr* factors = pl_term_factors(t);
  bool whole = pl_number_is_integer(p, t->coefficient);
  int n_above = 0, n_below = !whole;
  if (!num_is_one(w, t->coefficient)) {
    add(w, unsigned_num(w, t->coefficient));
    n_above++;
  }
  for (int i = 0; i < t->n; i++) {
    if (is_below_line(p, factors[i])) {
      n_below++;
      continue;
    }
    if (n_above++ > 0) add(w, "*");
    write_factor(w, factors[i], false);
  }
  if (n_above == 0) add(w, "1");
  if (n_below == 0) return;

  add(w, n_below > 1 ? "/(" : "/");
  int written = 0;
  if (!whole) {
    add(w, pl_number_den_text(w->text.arena, p, t->coefficient));
    written++;
  }
  for (int i = 0; i < t->n; i++) {
    if (!is_below_line(p, factors[i])) continue;
    if (written++ > 0) add(w, "*");
    write_factor(w, factors[i], true);
  }
  if (n_below > 1) add(w, ")");
}

// -------------------------------------------------------------------------------------------- sums
static void write_term(writer* w, pl_expr e, bool first) {
  pl_term t = pl_term_of(w->p, e);
  bool negative = pl_number_sign(w->p, t.coefficient) < 0;
  add(w, negative ? (first ? "-" : " - ") : (first ? "" : " + "));
  write_product(w, &t);
}

// In the order of the node, the number last.
static void write_sum(writer* w, pl_expr e) {
  const pl_pool* p = w->p;
  int n = pl_n_args(p, e);
  bool number = pl_is_number(p, pl_arg(p, e, 0));
  for (int i = number; i < n; i++) write_term(w, pl_arg(p, e, i), i == number);
  if (number) write_term(w, pl_arg(p, e, 0), false);
}

// --------------------------------------------------------------------------------- calls, patterns
static void write_arguments(writer* w, pl_expr e, int first) {
  for (int i = first, n = pl_n_args(w->p, e); i < n; i++) {
    if (i > first) add(w, ", ");
    write(w, pl_arg(w->p, e, i));
  }
  add(w, ")");
}

static void write_element(writer* w, pl_expr e) {
  pl_text_addf(&w->text, "%s[", pl_symbol_get(w->p, pl_symbol_of(w->p, e))->ascii);
  write(w, pl_arg(w->p, e, 0));
  add(w, "]");
  for (int i = 0; i < pl_dots_of(w->p, e); i++) add(w, "'");
}

static void write_if(writer* w, pl_expr e) {
  add(w, "if(");
  write(w, pl_arg(w->p, e, 0));
  add(w, " > 0, ");
  write_arguments(w, e, 1);
}

static void write_pattern(writer* w, pl_expr e) {
  pl_text_addf(&w->text, "sum(%s in ", pl_symbol_get(w->p, pl_symbol_of(w->p, e))->ascii);
  write(w, pl_arg(w->p, e, 1));
  add(w, "..");
  write(w, pl_arg(w->p, e, 2));
  add(w, ", ");
  write_arguments(w, e, 3);
}

// --------------------------------------------------------------------------------------------- all
static void write(writer* w, pl_expr e) {
  const pl_pool* p = w->p;
  switch (pl_kind_of(p, e)) {
    case PL_POISON: add(w, "undefined"); return;
    case PL_NUMBER: write_number(w, e); return;
    case PL_PI: add(w, "pi"); return;
    case PL_INFINITY: add(w, "infinity"); return;
    case PL_SYMBOL:
      if (pl_is_measure(p, e)) write(w, pl_symbol_get(p, pl_symbol_of(p, e))->number);
      else add(w, pl_symbol_get(p, pl_symbol_of(p, e))->ascii);
      return;
    case PL_AT: write_element(w, e); return;
    case PL_ADD: write_sum(w, e); return;
    case PL_MUL:
    case PL_POW: write_term(w, e, true); return;
    case PL_CALL:
    case PL_UNKNOWN_FUNCTION:
      pl_text_addf(&w->text, "%s(", pl_function_name[pl_function_of(p, e)]);
      write_arguments(w, e, 0);
      return;
    case PL_IF: write_if(w, e); return;
    case PL_SUM: write_pattern(w, e); return;
  }
}

static binding binding_of(const pl_pool* p, pl_expr e) {
  if (pl_is_measure(p, e)) e = pl_symbol_get(p, pl_symbol_of(p, e))->number;
  switch (pl_kind_of(p, e)) {
    case PL_ADD: return SUM;
    case PL_MUL: return PRODUCT;
    case PL_NUMBER: return pl_number_is_integer(p, e) && pl_number_sign(p, e) >= 0 ? ATOM : PRODUCT;
    case PL_POW:
      if (pl_is_sqrt(p, e)) return ATOM;
      return pl_number_sign(p, pl_arg(p, e, 1)) < 0 ? PRODUCT : POWER;
    default: return ATOM;
  }
}

static void write_in(writer* w, pl_expr e, binding outer) {
  bool brackets = binding_of(w->p, e) < outer;
  if (brackets) add(w, "(");
  write(w, e);
  if (brackets) add(w, ")");
}

const char* pl_expr_text(pl_arena* a, const pl_pool* p, pl_expr e) {
  long n = pl_op_count(p, e);
  if (n > max_operators) return pl_format(a, "<an expression of %ld operators>", n);
  if (pl_node_at(p, e)->height > MAX_DEPTH)
    return pl_copy(a, "<an expression of very many nested brackets>");
  writer w = {pl_text_make(a), p};
  write(&w, e);
  return pl_text_string(&w.text);
}
