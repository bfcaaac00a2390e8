// The plain form of an expression, in the order of style rule K5: number, masses, g, lengths, other
// parameters, functions, coordinates, velocities, accelerations; names in natural order. -1, 1/2
// and negative powers become minus signs and fractions. No algebra is done, so the value of the
// form is the expression again.
#include "expr/expr_impl.h"

// What is known of a node when its users are formed.
typedef struct place {
  const pl_form* form;
  // the highest class of the names in it; brackets stand behind the names of that class
  int class;
} place;

typedef struct former {
  pl_arena* a;
  pl_pool* p;
  pl_walk w;
  place* places;  // by position
} former;

static const place* place_of(const former* f, pl_expr e) {
  return &f->places[pl_walk_position(&f->w, e)];
}

// ------------------------------------------------------------------------------------------- order
static int class_of_name(const pl_pool* p, pl_expr e) {
  const pl_symbol_info* s = pl_symbol_get(p, pl_symbol_of(p, e));
  if (pl_kind_of(p, e) != PL_AT || pl_dots_of(p, e) == 0) return (int)s->class;
  return pl_dots_of(p, e) == 1 ? PL_C_VELOCITY : PL_C_ACCELERATION;
}

static int class_of(const former* f, pl_expr e) {
  const pl_pool* p = f->p;
  pl_kind kind = pl_kind_of(p, e);
  if (kind == PL_SYMBOL || kind == PL_AT) return class_of_name(p, e);
  int highest = PL_C_NUMBER;
  for (int i = 0, n = pl_n_args(p, e); i < n; i++) {
    int c = place_of(f, pl_arg(p, e, i))->class;
    if (c > highest) highest = c;
  }
  // a function of anything that moves is a function; of parameters too
  return kind == PL_CALL && highest < PL_C_FUNCTION ? PL_C_FUNCTION : highest;
}

// Where a factor stands: by the class of its base; sums behind the names, functions among
// themselves.
typedef struct rank {
  int class, composed;
} rank;

static rank rank_of(const former* f, pl_expr e) {
  const pl_pool* p = f->p;
  pl_expr base = pl_base_of(p, e);
  switch (pl_kind_of(p, base)) {
    case PL_NUMBER:
    case PL_PI:
    case PL_INFINITY: return (rank){PL_C_NUMBER, 0};
    case PL_SYMBOL:
    case PL_AT: return (rank){class_of_name(p, base), 0};
    case PL_CALL: return (rank){PL_C_FUNCTION, 1};
    default: {
      int c = place_of(f, base)->class;
      if (c > PL_C_FUNCTION && c < PL_C_VELOCITY) c = PL_C_FUNCTION;
      return (rank){c, 2};
    }
  }
}

static int compare_bases(const former* f, pl_expr a, pl_expr b) {
  const pl_pool* p = f->p;
  if (pl_kind_of(p, a) == PL_SYMBOL && pl_kind_of(p, b) == PL_SYMBOL) {
    return pl_symbol_compare(p, pl_symbol_of(p, a), pl_symbol_of(p, b));
  }
  return pl_compare(p, a, b);
}

static int compare_factors(const former* f, pl_expr a, pl_expr b) {
  if (a.id == b.id) return 0;
  rank x = rank_of(f, a), y = rank_of(f, b);
  if (x.class != y.class) return x.class < y.class ? -1 : 1;
  if (x.composed != y.composed) return x.composed < y.composed ? -1 : 1;
  pl_expr s = pl_base_of(f->p, a), t = pl_base_of(f->p, b);
  return s.id != t.id ? compare_bases(f, s, t) : pl_compare(f->p, a, b);
}

static bool factor_less(const void* a, const void* b, const void* user) {
  return compare_factors(user, *(const pl_expr*)a, *(const pl_expr*)b) < 0;
}

// A term with its factors in the order they are written.
typedef struct sorted_term {
  pl_expr whole;
  pl_expr* factors;
  int n;
  bool negative;
} sorted_term;

static sorted_term sort_term(former* f, pl_expr e) {
  pl_term t = pl_term_of(f->p, e);
  sorted_term s = {.whole = e, .n = t.n, .negative = pl_number_sign(f->p, t.coefficient) < 0};
  s.factors = PL_ARRAY(f->a, pl_expr, t.n);
  for (int i = 0; i < t.n; i++) s.factors[i] = pl_term_factors(&t)[i];
  pl_sort(f->p, s.factors, s.n, sizeof *s.factors, factor_less, f);
  return s;
}

// Factor by factor; where one is the beginning of the other, the shorter first.
static bool term_less(const void* a, const void* b, const void* user) {
  const sorted_term *s = a, *t = b;
  int n = s->n < t->n ? s->n : t->n;
  for (int i = 0; i < n; i++) {
    int c = compare_factors(user, s->factors[i], t->factors[i]);
    if (c != 0) return c < 0;
  }
  return s->n < t->n;
}

// --------------------------------------------------------------------------------- numbers, powers
static const pl_form* form_of_size(former* f, pl_expr x) {
  pl_pool* p = f->p;
  const pl_form* den = pl_form_leaf(f->a, pl_number_den(p, x));
  pl_expr num = pl_number_num(p, x);
  if (pl_number_sign(p, num) < 0) num = pl_neg(p, num);
  const pl_form* above = pl_form_leaf(f->a, num);
  return pl_number_is_integer(p, x) ? above : pl_form_quotient(f->a, above, den);
}

static const pl_form* form_of_number(former* f, pl_expr x) {
  const pl_form* size = form_of_size(f, x);
  return pl_number_sign(f->p, x) < 0 ? pl_form_neg(f->a, size) : size;
}

// base^|exponent|, the exponent a number if inverse.
static const pl_form* form_of_factor(former* f, pl_expr e, bool inverse) {
  pl_pool* p = f->p;
  if (pl_kind_of(p, e) != PL_POW) return place_of(f, e)->form;
  const pl_form* base = place_of(f, pl_arg(p, e, 0))->form;
  pl_expr exponent = pl_arg(p, e, 1);
  if (inverse) exponent = pl_neg(p, exponent);
  if (exponent.id == p->one.id) return base;
  if (exponent.id == p->half.id) return pl_form_root(f->a, base);
  const pl_form* x = pl_is_number(p, exponent) ? form_of_number(f, exponent)
                                               : place_of(f, exponent)->form;
  return pl_form_power(f->a, base, x);
}

static bool is_below_line(const pl_pool* p, pl_expr e) {
  return pl_kind_of(p, e) == PL_POW && pl_number_sign(p, pl_arg(p, e, 1)) < 0;
}

// ---------------------------------------------------------------------------------- products, sums
typedef PL_VEC(const pl_form*) forms;

static const pl_form* as_product(former* f, const forms* x) {
  if (x->n == 0) return pl_form_leaf(f->a, f->p->one);
  return x->n == 1 ? x->at[0] : pl_form_product(f->a, x->at, x->n);
}

static const pl_form* form_of_term(former* f, pl_expr e) {
  pl_pool* p = f->p;
  pl_expr coefficient = pl_term_of(p, e).coefficient;
  if (pl_is_number(p, e)) return form_of_number(f, e);
  sorted_term t = sort_term(f, e);
  forms above = {0}, below = {0};
  pl_expr num = pl_number_num(p, coefficient), den = pl_number_den(p, coefficient);
  if (t.negative) num = pl_neg(p, num);
  if (num.id != p->one.id) pl_push(f->a, above, pl_form_leaf(f->a, num));
  if (den.id != p->one.id) pl_push(f->a, below, pl_form_leaf(f->a, den));
  for (int i = 0; i < t.n; i++) {
    bool inverse = is_below_line(p, t.factors[i]);
    const pl_form* x = form_of_factor(f, t.factors[i], inverse);
    if (inverse) pl_push(f->a, below, x);
    else pl_push(f->a, above, x);
  }
  const pl_form* x = as_product(f, &above);
  if (below.n > 0) x = pl_form_quotient(f->a, x, as_product(f, &below));
  return t.negative ? pl_form_neg(f->a, x) : x;
}

// A positive term goes first if there is one.
static const pl_form* form_of_sum(former* f, pl_expr e) {
  pl_pool* p = f->p;
  int n = pl_n_args(p, e);
  sorted_term* terms = PL_ARRAY(f->a, sorted_term, n);
  for (int i = 0; i < n; i++) terms[i] = sort_term(f, pl_arg(p, e, i));
  pl_sort(p, terms, n, sizeof *terms, term_less, f);
  int first = 0;
  while (first < n && terms[first].negative) first++;
  if (first == n) first = 0;
  forms out = {0};
  pl_push(f->a, out, place_of(f, terms[first].whole)->form);
  for (int i = 0; i < n; i++) {
    if (i != first) pl_push(f->a, out, place_of(f, terms[i].whole)->form);
  }
  return pl_form_sum(f->a, out.at, out.n);
}

static const pl_form* form_of_call(former* f, pl_expr e) {
  forms args = {0};
  for (int i = 0, n = pl_n_args(f->p, e); i < n; i++)
    pl_push(f->a, args, place_of(f, pl_arg(f->p, e, i))->form);
  return pl_form_call(f->a, pl_function_of(f->p, e), args.at, args.n);
}

static const pl_form* form_of_node(former* f, pl_expr e) {
  switch (pl_kind_of(f->p, e)) {
    case PL_NUMBER: return form_of_number(f, e);
    case PL_ADD: return form_of_sum(f, e);
    case PL_MUL:
    case PL_POW: return form_of_term(f, e);
    case PL_CALL: return form_of_call(f, e);
    default: return pl_form_leaf(f->a, e);  // names, π, ∞; cases and patterns as they are
  }
}

// A node that occurs twice has one form, used twice.
pl_form* pl_form_of(pl_arena* a, pl_pool* p, pl_expr e) {
  former f = {.a = a, .p = p};
  pl_walk_begin(&f.w, p, &e, 1);
  size_t bytes = (size_t)f.w.nodes.n * sizeof *f.places;
  f.places = pl_scratch_take(p, bytes);
  for (int i = 0; i < f.w.nodes.n; i++) {
    pl_expr x = f.w.nodes.at[i];
    f.places[i].class = class_of(&f, x);
    f.places[i].form = form_of_node(&f, x);
  }
  pl_form* form = pl_form_make(a, PL_F_EXPR, 0, NULL);
  *form = *f.places[f.w.nodes.n - 1].form;
  pl_scratch_give(p, f.places, bytes);
  pl_walk_end(&f.w);
  return form;
}
