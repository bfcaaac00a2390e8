// loops_text: the way from the constraints to the assemblies, and values in them.
#include <string.h>

#include "worked/worked_impl.h"

// ---------------------------------------------------------------------------------- which assembly
static bool signs_differ(const pl_loop* l) {
  for (int w = 0; w < l->n_ways; w++) {
    if (l->sign[w] == 0) return false;
    for (int v = 0; v < w; v++) {
      if (l->sign[v] == l->sign[w]) return false;
    }
  }
  return true;
}

// "sin(β - ψ) > 0"; where signs do not tell the ways apart, the value of the first coordinate.
static const pl_form* condition(pl_analysis* d, const pl_loop* l, int way) {
  if (!signs_differ(l))
    return pl_feq(d, pl_fs(d, d->q.at[l->coordinate[0]].q), pl_fe(d, l->value[way][0]));
  const pl_form* side = pl_f(d, l->side, PL_S_PLAIN);
  bool negative = side->kind == PL_F_NEG;
  return pl_frel(d, negative ? side->args[0] : side, (l->sign[way] > 0) != negative ? ">" : "<",
                 pl_form_leaf(d->arena, pl_int(d->pool, 0)));
}

static int digit(const pl_analysis* d, int assembly, int k) {
  for (int j = d->loops.n - 1; j > k; j--) assembly /= d->loops.at[j].n_ways;
  return assembly % d->loops.at[k].n_ways;
}

// The conditions of an assembly up to one of the loops; NULL when there is no choice.
static const char* branch_words(pl_analysis* d, int assembly, int last, pl_math math) {
  pl_text text = pl_text_make(d->arena);
  pl_notation how = {.math = math, .lang = d->job->lang};
  for (int k = 0; k <= last; k++) {
    const pl_loop* l = &d->loops.at[k];
    if (l->n_ways < 2) continue;
    const char* one = pl_notation_print(d->arena, d->pool, condition(d, l, digit(d, assembly, k)),
                                        how);
    pl_text_addf(&text, "%s%s", text.n ? ", " : "", one);
  }
  return text.n ? pl_text_string(&text) : NULL;
}

static const char* branch_text(pl_analysis* d, int assembly, int last) {
  return branch_words(d, assembly, last, PL_MATH_ASCII);
}

const char* pl_branch_text(pl_analysis* d, int assembly, pl_math math) {
  return branch_words(d, assembly, d->loops.n - 1, math);
}

// -------------------------------------------------------------------------------- a loop displayed
static const pl_form* zero_form(pl_analysis* d) {
  return pl_form_leaf(d->arena, pl_int(d->pool, 0));
}

static const pl_form* linear_pair(pl_analysis* d, const pl_loop* l) {
  pl_expr u = pl_sym(d->pool, d->q.at[l->coordinate[0]].q);
  const pl_form* term[3];
  for (int k = 0; k < l->names.n && k < 3; k++) {
    const pl_form* factor[2] = {pl_fs(d, l->names.at[k].symbol),
                                k == 2 ? NULL : pl_fe(d, pl_call(d->pool, k ? PL_SIN : PL_COS, u))};
    term[k] = k == 2 ? factor[0] : pl_form_product(d->arena, factor, 2);
  }
  return pl_form_sum(d->arena, term, l->names.n < 3 ? l->names.n : 3);
}

static void show_equation(pl_analysis* d, const pl_loop* l) {
  const pl_form* u = pl_fs(d, d->q.at[l->coordinate[0]].q);
  const pl_form* first = pl_fn(d, d->g.at[l->bond[0]].source->name.text);
  if (l->n == 1) {
    pl_say(d,
           PL_BOTH(l->n_ways > 1 ? "{1} determines {2}, in several ways:" : "{1} determines {2}:"),
           2, first, u);
    return;
  }
  const pl_form* v = pl_fs(d, d->q.at[l->coordinate[1]].q);
  pl_say(d, PL_BOTH("{1} and {2} close a loop and determine {3} and {4}. {4} eliminated:"), 4,
         first, pl_fn(d, d->g.at[l->bond[1]].source->name.text), u, v);
  if (!l->by_angle) {
    pl_show_numbered(d, pl_feq(d, pl_f(d, l->eliminated, PL_S_EQUATION), zero_form(d)));
    return;
  }
  pl_show_numbered(d, pl_feq(d, linear_pair(d, l), zero_form(d)));
}

static void show_names(pl_analysis* d, const pl_loop* l) {
  if (l->names.n == 0) return;
  pl_say(d, PL_BOTH("with"), 0);
  for (int k = 0; k < l->names.n; k++) {
    const pl_definition* n = &l->names.at[k];
    bool root = pl_is_sqrt(d->pool, n->value);
    pl_expr inside = root ? pl_arg(d->pool, n->value, 0) : pl_poison();
    bool short_root = root && !pl_has_coordinates(d, inside)
                      && !pl_has_symbol(d->pool, inside, pl_time(d->pool));
    const pl_form* form = !root        ? pl_f(d, n->value, PL_S_PLAIN)
                          : short_root ? pl_fe(d, n->value)
                                       : pl_form_root(d->arena, pl_f(d, inside, PL_S_PLAIN));
    pl_show(d, pl_feq(d, pl_fs(d, n->symbol), form));
    if (!short_root)
      pl_claim_that(d, PL_CLAIM_OTHER, pl_form_value(d->pool, form), pl_sym(d->pool, n->symbol));
  }
}

static const pl_form* value_form(pl_analysis* d, pl_expr e) {
  return pl_kind_of(d->pool, e) == PL_CALL || pl_kind_of(d->pool, e) == PL_ADD
             ? pl_fe(d, e)
             : pl_f(d, e, PL_S_SOLUTION);
}

static void show_value(pl_analysis* d, const pl_loop* l, int way, int j, bool tell) {
  const pl_variable* c = &d->q.at[l->coordinate[j]];
  const pl_form* form = value_form(d, l->value[way][j]);
  pl_step* step = pl_show_numbered(d, pl_feq(d, pl_fs(d, c->q), form));
  bool known;
  pl_step_value(d, step, l->value[way][j], pl_dimension_of_expr(d, pl_sym(d->pool, c->q), &known));
  if (!tell) return;
  pl_notation how = {.math = PL_MATH_LINE, .lang = d->job->lang};
  const char* text = pl_notation_print(d->arena, d->pool, condition(d, l, way), how);
  if (signs_differ(l)) pl_step_after(step, PL_BOTH_FORMAT(d->arena, "for %s", text));
}

static bool same_in_all(const pl_loop* l, int j) {
  for (int w = 1; w < l->n_ways; w++) {
    if (!pl_same(l->value[0][j], l->value[w][j])) return false;
  }
  return true;
}

static void show_ways(pl_analysis* d, const pl_loop* l) {
  for (int j = 0; j < l->n; j++) {
    bool same = same_in_all(l, j);
    for (int w = 0; w < (same ? 1 : l->n_ways); w++) show_value(d, l, w, j, !same || l->picked);
  }
  if (pl_is_poison(l->real)) return;
  pl_expr real = l->real;
  while (pl_kind_of(d->pool, real) == PL_CALL && pl_function_of(d->pool, real) == PL_MIN)
    real = pl_arg(d->pool, real, 1);
  pl_say(d, PL_BOTH("real where {1}"), 1, pl_frel(d, pl_f(d, real, PL_S_PLAIN), "≥", zero_form(d)));
}

static void answer_place(pl_analysis* d, int k, int j) {
  const pl_loop* l = &d->loops.at[k];
  const pl_variable* c = &d->q.at[l->coordinate[j]];
  for (int a = 0; a < pl_assemblies(d); a++) {
    bool first = true;  // later loops do not matter
    for (int later = k + 1; later < d->loops.n; later++) first &= digit(d, a, later) == 0;
    if (!first) continue;
    pl_expr e = pl_on_assembly(d, pl_sym(d->pool, c->q), a);
    pl_value* v = pl_answer(d, pl_symbol_get(d->pool, c->q)->ascii, e,
                            value_form(d, l->value[digit(d, a, k)][j]));
    v->branch = branch_text(d, a, k);
    v->lhs = pl_sym(d->pool, c->q);
    v->lhs_form = pl_fs(d, c->q);
  }
}

void pl_show_loop(pl_analysis* d, int k) {
  const pl_loop* l = &d->loops.at[k];
  if (d->page->loop_told[k]) return;
  d->page->loop_told[k] = true;
  show_equation(d, l);
  show_names(d, l);
  show_ways(d, l);
  for (int j = 0; j < l->n; j++) answer_place(d, k, j);
}

// du/dq and its derivative along q.
static void show_coefficient(pl_analysis* d, pl_symbol name, pl_expr value) {
  const pl_form* form = pl_f(d, value, PL_S_QUOTIENT);
  pl_show(d, pl_feq(d, pl_fs(d, name), form));
  pl_claim_that(d, PL_CLAIM_OTHER, pl_form_value(d->pool, form), pl_sym(d->pool, name));
}

static void show_rates(pl_analysis* d, const pl_loop* l) {
  for (int j = 0; j < l->n; j++) {
    const pl_variable* c = &d->q.at[l->coordinate[j]];
    const pl_form* form = pl_f(d, l->rate[j], PL_S_EQUATION);
    pl_show_numbered(d, pl_feq(d, pl_fs(d, c->v), form));
    pl_claim_that(d, PL_CLAIM_ENERGY, pl_form_value(d->pool, form), pl_sym(d->pool, c->v));
    pl_value* v = pl_answer(d, pl_symbol_get(d->pool, c->v)->ascii, l->written_out[j],
                            pl_f(d, l->written_out[j], PL_S_QUOTIENT));
    v->lhs = pl_sym(d->pool, c->v);
    v->lhs_form = pl_fs(d, c->v);
  }
}

void pl_show_loop_velocities(pl_analysis* d) {
  if (d->loops.n == 0) return;
  pl_say(d, PL_BOTH("The constraints differentiated are linear in the velocities:"), 0);
  for (int k = 0; k < d->loops.n; k++) {
    const pl_loop* l = &d->loops.at[k];
    show_rates(d, l);
    for (int j = 0; j < l->slopes.n; j++)
      show_coefficient(d, l->slopes.at[j].name, l->slopes.at[j].value);
  }
  bool bends = false;
  for (int k = 0; k < d->loops.n; k++) bends |= d->loops.at[k].bends.n > 0;
  if (!bends) return;
  pl_say(d, PL_BOTH("and the coefficients change at the rates"), 0);
  for (int k = 0; k < d->loops.n; k++) {
    const pl_loop* l = &d->loops.at[k];
    for (int j = 0; j < l->slopes.n; j++) {
      pl_show(d, pl_feq(d, pl_fs(d, l->slopes.at[j].dot),
                        pl_f(d, l->slopes.at[j].rate, PL_S_EQUATION)));
      pl_claim_that(d, PL_CLAIM_OTHER, pl_dt(d->pool, l->slopes.at[j].value),
                    pl_sym(d->pool, l->slopes.at[j].dot));
    }
    for (int j = 0; j < l->bends.n; j++)
      show_coefficient(d, l->bends.at[j].symbol, l->bends.at[j].value);
  }
}

void pl_tell_loops(pl_analysis* d) {
  if (d->loops.n == 0 || d->page->loops_told) return;
  d->page->loops_told = true;
  for (int k = 0; k < d->loops.n; k++) pl_show_loop(d, k);
  pl_show_loop_velocities(d);
}

bool pl_speaks_of_loops(const pl_ask* ask) {
  switch (ask->kind) {
    case PL_ASK_LAGRANGIAN:
    case PL_ASK_LAGRANGE2:
    case PL_ASK_HAMILTONIAN:
    case PL_ASK_SOLVE:
    case PL_ASK_CONSERVED:
    case PL_ASK_FORCE_OF:
    case PL_ASK_FORCE_ON: return true;
    default: return false;
  }
}

pl_expr pl_without_slopes(pl_analysis* d, pl_expr e) {
  for (int k = d->loops.n - 1; k >= 0; k--) {
    const pl_loop* l = &d->loops.at[k];
    for (int j = 0; j < l->slopes.n; j++)
      e = pl_subst1(d->pool, e, l->slopes.at[j].name, l->slopes.at[j].value);
  }
  return e;
}

// A velocity over the coordinates.
static void answer_velocity(pl_analysis* d, int k, int j) {
  const pl_loop* l = &d->loops.at[k];
  const pl_variable* c = &d->q.at[l->coordinate[j]];
  const pl_form* form = pl_f(d, l->written_out[j], PL_S_QUOTIENT);
  pl_step* step = pl_show_numbered(d, pl_feq(d, pl_fs(d, c->v), form));
  bool known;
  pl_step_value(d, step, l->written_out[j], pl_dimension_of_expr(d, pl_sym(d->pool, c->v), &known));
  pl_claim_that(d, PL_CLAIM_ENERGY, pl_form_value(d->pool, form), pl_sym(d->pool, c->v));
  pl_answer(d, pl_symbol_get(d->pool, c->v)->ascii, l->written_out[j], form);
}

bool pl_answer_follower(pl_analysis* d, pl_symbol q) {
  int i = pl_variable_index(d, q), k = i >= 0 ? pl_follower(d, i) : -1;
  if (k >= 0 && d->q.at[i].v.id == q.id) {
    answer_velocity(d, k, d->loops.at[k].coordinate[0] == i ? 0 : 1);
    return true;
  }
  if (k < 0 || d->q.at[i].q.id != q.id) return false;
  const pl_loop* l = &d->loops.at[k];
  for (int before = 0; before < k; before++) {  // what its formulas contain
    if (!d->page->loop_told[before]) pl_show_loop(d, before);
  }
  if (!d->page->loop_told[k]) {
    show_equation(d, l);
    show_names(d, l);
    d->page->loop_told[k] = true;
    show_ways(d, l);
  } else {
    int j = l->coordinate[0] == i ? 0 : 1;
    bool same = same_in_all(l, j);
    for (int w = 0; w < (same ? 1 : l->n_ways); w++) show_value(d, l, w, j, !same || l->picked);
  }
  answer_place(d, k, l->coordinate[0] == i ? 0 : 1);
  return true;
}

// ---------------------------------------------------------------------------- values in assemblies
static bool mentions(pl_analysis* d, const pl_value* v, pl_symbol s) {
  bool has = !pl_is_poison(v->expr) && pl_has_symbol(d->pool, v->expr, s);
  for (int c = 0; c < v->n_components; c++)
    has |= !pl_is_poison(v->components[c].expr) && pl_has_symbol(d->pool, v->components[c].expr, s);
  for (int c = 0; c < v->n_where; c++) has |= pl_has_symbol(d->pool, v->where_expr[c], s);
  return has;
}

// Adds the definitions of loops that a value contains in front of its other names: last ones first,
// then turned round.
static void add_where(pl_analysis* d, pl_value* v, int assembly) {
  int n_all = pl_loop_definitions(d, assembly, NULL), n = 0;
  pl_definition* all = PL_ARRAY(d->arena, pl_definition, n_all + 1);
  pl_loop_definitions(d, assembly, all);
  bool* needed = PL_ARRAY(d->arena, bool, n_all + 1);
  for (int k = n_all - 1; k >= 0; k--) {
    needed[k] = mentions(d, v, all[k].symbol);
    for (int later = k + 1; later < n_all && !needed[k]; later++)
      needed[k] = needed[later] && pl_has_symbol(d->pool, all[later].value, all[k].symbol);
    n += needed[k];
  }
  const char** name = PL_ARRAY(d->arena, const char*, n + v->n_where + 1);
  pl_expr* expr = PL_ARRAY(d->arena, pl_expr, n + v->n_where + 1);
  n = 0;
  for (int k = 0; k < n_all; k++) {
    if (!needed[k]) continue;
    name[n] = pl_symbol_get(d->pool, all[k].symbol)->ascii;
    expr[n++] = all[k].value;
  }
  for (int c = 0; c < v->n_where; c++) {
    name[n] = v->where_name[c];
    expr[n++] = v->where_expr[c];
  }
  v->where_name = name;
  v->where_expr = expr;
  v->n_where = n;
}

static bool hangs_on_loops(pl_analysis* d, const pl_value* v) {
  int n = pl_loop_definitions(d, 0, NULL);
  pl_definition* all = PL_ARRAY(d->arena, pl_definition, n + 1);
  pl_loop_definitions(d, 0, all);
  for (int k = 0; k < n; k++) {
    if (mentions(d, v, all[k].symbol)) return true;
  }
  return false;
}

static void spread(pl_analysis* d, pl_section* s) {
  pl_value* old = s->values.at;
  int n = s->values.n;
  bool any = false;
  for (int k = 0; k < n; k++) any |= hangs_on_loops(d, &old[k]);
  // conditions between all coordinates stand as written
  if (!any || (s->item && strcmp(s->item, "constraints") == 0)) return;
  s->values.at = NULL;
  s->values.n = s->values.cap = 0;
  for (int k = 0; k < n; k++) {
    if (!hangs_on_loops(d, &old[k])) {
      pl_push(d->arena, s->values, old[k]);
      continue;
    }
    for (int a = 0; a < pl_assemblies(d); a++) {
      pl_value v = old[k];
      add_where(d, &v, a);
      v.branch = branch_text(d, a, d->loops.n - 1);
      pl_push(d->arena, s->values, v);
    }
  }
}

void pl_spread_assemblies(pl_analysis* d) {
  for (int k = 0; k < d->page->solution->sections.n && d->loops.n > 0; k++) {
    if (d->page->solution->sections.at[k].by == d) spread(d, &d->page->solution->sections.at[k]);
  }
}

void pl_claim_loops(pl_analysis* d) {
  for (int k = 0; k < d->loops.n; k++) {
    const pl_loop* l = &d->loops.at[k];
    for (int j = 0; j < l->n; j++) {
      pl_claim_that(d, PL_CLAIM_MAP, pl_on_contact(d, d->g.at[l->bond[j]].g), pl_int(d->pool, 0));
      pl_claim_that(d, PL_CLAIM_MAP, pl_on_contact(d, pl_dt(d->pool, d->g.at[l->bond[j]].g)),
                    pl_int(d->pool, 0));
    }
  }
}
