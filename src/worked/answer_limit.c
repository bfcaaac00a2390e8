// answer_limit: limits and series of results in the parameters.
#include <math.h>
#include <string.h>

#include "worked/worked_impl.h"

// What the request speaks of, worked out: on the motion, abbreviations inserted where they contain
// the variable.
static pl_expr subject(pl_analysis* d, const pl_ask* ask, pl_expr e) {
  pl_expr value = pl_on_motion(d, pl_with_results(d, e));
  // a closed motion that ends says nothing of later times
  e = pl_motion_changes_sides(d) ? value : pl_as_function_of_time(d, value, e);
  for (int k = d->model->lets.n - 1; k >= 0; k--) {
    const pl_let* l = &d->model->lets.at[k];
    if (l->inserted || !pl_has_symbol(d->pool, e, l->symbol)) continue;
    bool hangs = pl_has_symbol(d->pool, l->value, ask->variable);
    if (hangs) e = pl_subst1(d->pool, e, l->symbol, l->value);
  }
  return pl_alg_normal(d->tower, e);
}

// A limit that still contains what it is the limit of says nothing.
static bool says_nothing(pl_analysis* d, pl_expr name, pl_expr value) {
  if (!pl_has_coordinates(d, name) || !pl_is_circular(d, name, value)) return false;
  pl_say(
      d,
      PL_BOTH(
          "{1} belongs to the state, and no closed form of its motion was found: there is nothing "
          "to take a limit of."),
      1, pl_fe(d, name));
  d->page->section->not_found = true;
  return true;
}

static const pl_form* name_of(pl_analysis* d, pl_expr e) {
  pl_symbol s = pl_kind_of(d->pool, e) == PL_SYMBOL ? pl_symbol_of(d->pool, e) : (pl_symbol){0};
  pl_role role = s.id ? pl_symbol_get(d->pool, s)->role : PL_R_LOCAL;
  if (role == PL_R_COORD || role == PL_R_VELOCITY) {  // of its motion
    return pl_fn(d, pl_format(d->arena, "%s%s(t)", pl_symbol_get(d->pool, s)->name,
                              role == PL_R_VELOCITY ? "'" : ""));
  }
  return pl_kind_of(d->pool, e) == PL_SYMBOL ? pl_fs(d, pl_symbol_of(d->pool, e))
                                             : pl_f(d, e, PL_S_PLAIN);
}

static const char* machine_name(pl_analysis* d, pl_expr e) {
  return pl_expr_text(d->arena, d->pool, e);
}

// ------------------------------------------------------------------------------------------ limits
// A row of the table of limits: the condition, then what becomes of the quantity.
static pl_step* show_case(pl_analysis* d, const pl_form* condition, const pl_form* result) {
  pl_step* row = pl_row(d, "{1}", "{1}", result, NULL);
  const pl_form** insert = PL_ARRAY(d->arena, const pl_form*, 1);
  insert[0] = condition;
  row->n_inserts = 1;
  row->inserts = insert;
  return row;
}

static bool is_acceleration(pl_analysis* d, pl_expr e) {
  return pl_kind_of(d->pool, e) == PL_SYMBOL
         && pl_symbol_get(d->pool, pl_symbol_of(d->pool, e))->role == PL_R_ACCELERATION;
}

static void show_limit(pl_analysis* d, const pl_form* condition, pl_expr subject_name,
                       pl_expr value, bool equality) {
  const pl_form* rhs = pl_f(d, value, PL_S_QUOTIENT);
  pl_step* row = show_case(d, condition,
                           pl_frel(d, name_of(d, subject_name), equality ? "=" : "->", rhs));
  if (is_acceleration(d, subject_name) && pl_is_zero_node(d->pool, value)) {
    pl_step_after(row, PL_BOTH("equilibrium, or uniform motion"));
  }
  pl_answer(d, machine_name(d, subject_name), value, rhs);
}

static void not_found(pl_analysis* d, const pl_form* condition) {
  pl_say(d, PL_BOTH("{1}: no limit was found."), 1, condition);
  d->page->section->not_found = true;
}

static void limit_equal(pl_analysis* d, const pl_ask* ask, pl_expr name, pl_expr e) {
  const pl_form* condition = pl_feq(d, pl_fs(d, ask->variable), pl_fe(d, ask->to));
  pl_expr value = pl_alg_normal(d->tower, pl_subst1(d->pool, e, ask->variable, ask->to));
  if (pl_is_poison(value)) value = pl_alg_limit(d->tower, e, ask->variable, ask->to);
  if (pl_is_poison(value)) {
    not_found(d, condition);
    return;
  }
  if (!says_nothing(d, name, value)) show_limit(d, condition, name, value, true);
}

static void limit_to(pl_analysis* d, const pl_ask* ask, pl_expr name, pl_expr e) {
  const pl_form* condition = pl_frel(d, pl_fs(d, ask->variable), "->", pl_fe(d, ask->to));
  pl_expr value = pl_alg_limit(d->tower, e, ask->variable, ask->to);
  if (pl_is_poison(value)) {
    not_found(d, condition);
    return;
  }
  if (!says_nothing(d, name, value)) show_limit(d, condition, name, value, false);
}

// The small name ε with  small = ε large.
static pl_symbol ratio_symbol(pl_analysis* d, pl_expr small, pl_symbol large) {
  pl_symbol_info info = {.name = "ε",
                         .role = PL_R_SMALL,
                         .class = PL_C_OTHER,
                         .sign = PL_SIGN_POSITIVE,
                         .dimension = pl_dimension_one(),
                         .dimension_known = true};
  info.ascii = pl_format(d->arena, "ratio_%s_%s", pl_expr_text(d->arena, d->pool, small),
                         pl_symbol_get(d->pool, large)->ascii);
  return pl_symbol_make(d->pool, &info);
}

static const pl_form* power_form(pl_analysis* d, const pl_form* base, int k) {
  return k == 1 ? base : pl_form_power(d->arena, base, pl_form_leaf(d->arena, pl_int(d->pool, k)));
}

// c0 + c1 x + c2 x² + O(x³), each coefficient presented by itself; negative powers by 1/x, if it
// has a form of its own.
static const pl_form* series_form(pl_analysis* d, const pl_expr* c, int lead, int n,
                                  const pl_form* x, const pl_form* inverse, int order) {
  const pl_form** term = PL_ARRAY(d->arena, const pl_form*, n + 1);
  int m = 0;
  for (int k = 0; k < n; k++) {
    int power = lead + k;
    if (pl_is_zero_node(d->pool, c[k]) || power > order) continue;
    const pl_form* coefficient = pl_f(d, c[k], PL_S_QUOTIENT);
    bool negative = coefficient->kind == PL_F_NEG;
    if (negative) coefficient = coefficient->args[0];
    const pl_form* factor[2] = {coefficient, !power                 ? NULL
                                             : power < 0 && inverse ? power_form(d, inverse, -power)
                                                                    : power_form(d, x, power)};
    const pl_form* t = power == 0 ? coefficient
                       : pl_is_one_node(d->pool, pl_form_value(d->pool, coefficient))
                           ? factor[1]
                           : pl_form_product(d->arena, factor, 2);
    term[m++] = negative ? pl_form_neg(d->arena, t) : t;
  }
  const pl_form* rest = power_form(d, x, order + 1);
  term[m++] = pl_form_make(d->arena, PL_F_ORDER, 1, &rest);
  return pl_form_sum(d->arena, term, m);
}

static pl_expr truncated(pl_analysis* d, const pl_expr* c, int lead, int n, pl_expr x, int order) {
  pl_expr sum = pl_int(d->pool, 0);
  for (int k = 0; k < n && lead + k <= order; k++) {
    sum = pl_add(d->pool, sum, pl_mul(d->pool, c[k], pl_pow_int(d->pool, x, lead + k)));
  }
  return sum;
}

enum { max_order = 12 };

// large >> small: the series in ε = small/large and its leading term.
static void limit_much_greater(pl_analysis* d, const pl_ask* ask, pl_expr name, pl_expr e) {
  const pl_form* condition = pl_frel(d, pl_fs(d, ask->variable), "≫", pl_fe(d, ask->to));
  if (pl_kind_of(d->pool, ask->to) != PL_SYMBOL) {
    not_found(d, condition);
    return;
  }
  pl_symbol small = pl_symbol_of(d->pool, ask->to), eps = ratio_symbol(d, ask->to, ask->variable);
  pl_expr inserted = pl_subst1(
      d->pool, e, small, pl_mul(d->pool, pl_sym(d->pool, eps), pl_sym(d->pool, ask->variable)));
  pl_expr c[3];
  int lead = 0;
  if (!pl_alg_series(d->tower, pl_alg_normal(d->tower, inserted), eps, pl_int(d->pool, 0), 3, &lead,
                     c)) {
    not_found(d, condition);
    return;
  }
  if (says_nothing(
          d, name,
          pl_alg_normal(d->tower, truncated(d, c, lead, 3, pl_sym(d->pool, eps), lead + 2))))
    return;
  const pl_form* ratio = pl_form_quotient(d->arena, pl_fe(d, ask->to), pl_fs(d, ask->variable));
  pl_why_series(d, pl_alg_normal(d->tower, inserted), eps, pl_int(d->pool, 0), lead, c, 3);
  const pl_form* grouped = pl_form_make(d->arena, PL_F_GROUP, 1, &ratio);
  const pl_form* form = series_form(d, c, lead, 3, grouped, NULL, lead + 1);
  show_case(d, condition, pl_feq(d, name_of(d, name), form));
  pl_expr real = pl_div(d->pool, ask->to, pl_sym(d->pool, ask->variable));
  pl_expr leading = pl_alg_normal(d->tower, truncated(d, c, lead, 1, real, lead));
  pl_value* v = pl_answer(d, machine_name(d, name), leading, pl_f(d, leading, PL_S_QUOTIENT));
  v = pl_answer(d, pl_format(d->arena, "%s series", machine_name(d, name)),
                truncated(d, c, lead, 3, real, lead + 1), form);
  v->order = lead + 1;
}

// The quantities a request means: its own expression, or the values of the section with its letter.
static int subjects(pl_analysis* d, const pl_ask* ask, pl_expr* name, pl_expr* e, int max) {
  if (!ask->of_letter) {
    name[0] = ask->value;
    e[0] = subject(d, ask, ask->value);
    return 1;
  }
  int n = 0;
  for (int s = 0; s < d->page->solution->sections.n; s++) {
    const pl_section* section = &d->page->solution->sections.at[s];
    if (!section->letter || strcmp(section->letter, ask->of_letter) != 0
        || section == d->page->section)
      continue;
    for (int k = 0; k < section->values.n && n < max; k++) {
      pl_symbol symbol = pl_symbol_find(d->pool, section->values.at[k].name);
      if (!symbol.id || pl_is_poison(section->values.at[k].expr)) continue;
      name[n] = pl_sym(d->pool, symbol);
      e[n++] = subject(d, ask, section->values.at[k].expr);
    }
  }
  return n;
}

void pl_answer_limit(pl_analysis* d, const pl_ask* ask) {
  pl_section_open(d, ask, PL_BOTH("Limits"));
  pl_expr name[16], e[16];
  int n = subjects(d, ask, name, e, 16);
  for (int k = 0; k < n; k++) {
    if (pl_say_unsolved(d, name[k], e[k])) continue;
    switch (ask->limit) {
      case PL_LIMIT_EQUAL: limit_equal(d, ask, name[k], e[k]); break;
      case PL_LIMIT_TO: limit_to(d, ask, name[k], e[k]); break;
      case PL_LIMIT_MUCH_GREATER: limit_much_greater(d, ask, name[k], e[k]); break;
    }
  }
  if (n == 0) pl_answer_pending(d, ask);
}

// ------------------------------------------------------------------------------------------ series
enum { max_poles = 12 };  // powers below zero that are shown

// A series in x: powers of the variable minus its target, or of one over the variable at infinity.
typedef struct series {
  pl_expr x;
  const pl_form* form;  // of x
  int lead, n, order;   // first power, how many coefficients, highest power shown
  pl_expr c[max_order + max_poles + 1];
} series;

static bool at_infinity(pl_analysis* d, const pl_ask* ask) {
  return pl_kind_of(d->pool, ask->to) == PL_INFINITY;
}

// Every power up to `order`, and at least the first one.
static bool expand(pl_analysis* d, const pl_ask* ask, pl_expr e, int order, series* s) {
  if (!pl_alg_series(d->tower, e, ask->variable, ask->to, 1, &s->lead, s->c)) return false;
  s->order = order > s->lead ? order : s->lead;
  s->n = s->order - s->lead + 1;
  if (s->n > max_order + max_poles + 1) return false;
  if (s->n > 1 && !pl_alg_series(d->tower, e, ask->variable, ask->to, s->n, &s->lead, s->c))
    return false;
  pl_expr variable = pl_sym(d->pool, ask->variable);
  if (at_infinity(d, ask)) {
    const pl_form* ratio = pl_form_quotient(d->arena, pl_form_leaf(d->arena, pl_int(d->pool, 1)),
                                            pl_fs(d, ask->variable));
    s->x = pl_div(d->pool, pl_int(d->pool, 1), variable);
    s->form = pl_form_make(d->arena, PL_F_GROUP, 1, &ratio);
    return true;
  }
  s->x = pl_sub(d->pool, variable, ask->to);
  s->form = pl_is_zero_node(d->pool, ask->to) ? pl_fs(d, ask->variable) : pl_fe(d, s->x);
  if (s->form->kind == PL_F_SUM) s->form = pl_form_make(d->arena, PL_F_GROUP, 1, &s->form);
  return true;
}

static void explain(pl_analysis* d, const pl_ask* ask, pl_expr e, const series* s) {
  if (!at_infinity(d, ask)) {
    pl_why_series(d, e, ask->variable, ask->to, s->lead, s->c, s->n);
    return;
  }
  pl_symbol_info info = *pl_symbol_get(d->pool, ask->variable);
  info.name = "ε";
  info.ascii = pl_format(d->arena, "inverse_%s", info.ascii);
  info.role = PL_R_SMALL;
  info.dimension_known = false;
  pl_symbol u = pl_symbol_make(d->pool, &info);
  pl_expr inserted = pl_subst1(d->pool, e, ask->variable,
                               pl_div(d->pool, pl_int(d->pool, 1), pl_sym(d->pool, u)));
  pl_say(d, PL_BOTH("With {1}:"), 1, pl_feq(d, pl_fs(d, u), pl_fe(d, s->x)))->detail = true;
  pl_why_series(d, pl_alg_normal(d->tower, inserted), u, pl_int(d->pool, 0), s->lead, s->c, s->n);
}

static void show_series(pl_analysis* d, const pl_ask* ask, pl_expr name, pl_expr e) {
  pl_expr about = e;
  const pl_form* condition = pl_frel(d, pl_fs(d, ask->variable), "->", pl_fe(d, ask->to));
  if (!pl_is_poison(ask->substitution_left)) {
    about = pl_subst_expr(d->pool, about, ask->substitution_left, ask->substitution_right);
    condition = pl_feq(d, pl_fe(d, ask->substitution_left), pl_fe(d, ask->substitution_right));
  }
  if (says_nothing(d, name, e)) return;
  about = pl_alg_normal(d->tower, about);
  int order = ask->order > 0 ? ask->order : 2;
  series* s = PL_NEW(d->arena, series);
  if (!expand(d, ask, about, order < max_order ? order : max_order, s)) {
    not_found(d, condition);
    return;
  }
  explain(d, ask, about, s);
  const pl_form* form = series_form(d, s->c, s->lead, s->n, s->form,
                                    at_infinity(d, ask) ? pl_fs(d, ask->variable) : NULL, s->order);
  show_case(d, condition, pl_feq(d, name_of(d, name), form));
  pl_value* v = pl_answer(d, machine_name(d, name),
                          truncated(d, s->c, s->lead, s->n, s->x, s->order), form);
  v->order = s->order;
}

void pl_answer_series(pl_analysis* d, const pl_ask* ask) {
  pl_section_open(d, ask, PL_BOTH("Limits"));
  pl_expr name[16], e[16];
  int n = subjects(d, ask, name, e, 16);
  for (int k = 0; k < n; k++) {
    if (!pl_say_unsolved(d, name[k], e[k])) show_series(d, ask, name[k], e[k]);
  }
  if (n == 0) pl_answer_pending(d, ask);
}
