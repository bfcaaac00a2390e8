// Requests: what is asked, events, and what is to be shown.
#include "lang/lower_impl.h"

#include <string.h>

#include "grammar.h"

// ------------------------------------------------------------------------------------------ pieces
#define PUSH_CONDITIONS(l, list, into)                                 \
  do {                                                                 \
    for (int i_ = 0; (list) && i_ < (list)->kids.n; i_++) {            \
      pl_condition c_;                                                 \
      if ((list)->kids.at[i_]->kind == PL_AST_RELATION) {              \
        for (int k_ = 0; k_ + 1 < (list)->kids.at[i_]->kids.n; k_++) { \
          if (pl_lower_relation((l), (list)->kids.at[i_], &c_, k_))    \
            pl_push((l)->arena, (into), c_);                           \
        }                                                              \
      } else {                                                         \
        not_a_condition((l), (list)->kids.at[i_]);                     \
      }                                                                \
    }                                                                  \
  } while (0)

static void not_a_condition(pl_lower* l, const pl_ast* node) {
  pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(node),
                                       PL_BOTH("an equation is needed here"));
  pl_suggest(l->job, m, NULL, PL_BOTH("write  name = value"));
}

static void lower_motion(pl_lower* l, const pl_ast* node, pl_motion* out) {
  if (node == NULL) return;
  out->given = true;
  out->at_rest = node->number == 1;
  out->span = pl_ast_span(node);
  PL_VEC(pl_condition) from = {0};
  PUSH_CONDITIONS(l, pl_ast_kid(node, 0), from);
  out->from = from.at;
  out->n_from = from.n;
}

static void lower_frame(pl_lower* l, const pl_ast* group, pl_ask* a) {
  for (int i = 0; group && i < group->kids.n; i++) {
    pl_expr e = pl_lower_scalar(l, group->kids.at[i]);
    if (pl_is_poison(e)) continue;
    bool symbol = pl_kind_of(l->pool, e) == PL_SYMBOL;
    if (symbol && pl_symbol_get(l->pool, pl_symbol_of(l->pool, e))->role == PL_R_COORD) {
      pl_push(l->arena, a->frame, pl_symbol_of(l->pool, e));
      continue;
    }
    pl_diagnostic* m = pl_lower_complain(l, PL_E030, pl_ast_span(group->kids.at[i]),
                                         PL_BOTH("%s is not a coordinate"),
                                         pl_source_text(l->arena, pl_ast_span(group->kids.at[i])));
    pl_suggest(l->job, m, NULL, PL_BOTH("write the coordinates, as in  in (r, φ)"));
  }
}

// The name that moves in a limit or series; a new name becomes a small quantity.
static pl_symbol lower_variable(pl_lower* l, const pl_ast* node, bool may_be_new) {
  const pl_ast* one = pl_ast_single(node);
  if (one && one->kind == PL_AST_NAME && one->number == 0 && may_be_new && !pl_scope_known(l, one)
      && !pl_scope_lost(l, one->key)) {
    pl_symbol s = pl_scope_symbol(l, one, PL_R_SMALL);
    pl_scope_declare(l, PL_ENTITY_SMALL, one, s);
    return s;
  }
  pl_expr e = pl_lower_scalar(l, node);
  if (pl_is_poison(e)) return (pl_symbol){0};
  if (pl_kind_of(l->pool, e) == PL_SYMBOL) return pl_symbol_of(l->pool, e);
  pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(node),
                                       PL_BOTH("a name is needed here"));
  pl_suggest(l->job, m, NULL, PL_BOTH("write a parameter or coordinate"));
  return (pl_symbol){0};
}

// of (expr | LETTER): a letter of an earlier request, unless a name is so declared.
static void lower_of(pl_lower* l, const pl_ast* node, pl_ask* a) {
  const pl_ast* one = pl_ast_single(node);
  if (one && one->kind == PL_AST_NAME && !pl_scope_find(l, one->key)) {
    for (int i = 0; i < l->letters.n; i++) {
      if (strcmp(l->letters.at[i], one->shown) != 0) continue;
      a->of_letter = one->shown;
      return;
    }
  }
  a->value = pl_lower_scalar(l, node);
}

// --------------------------------------------------------------------------------- limits, series,
// thresholds
static void lower_limit(pl_lower* l, const pl_ast* i, pl_ask* a) {
  a->kind = PL_ASK_LIMIT;
  a->limit = i->number == '='        ? PL_LIMIT_EQUAL
             : i->number == TOK_MUCH ? PL_LIMIT_MUCH_GREATER
                                     : PL_LIMIT_TO;
  a->variable = lower_variable(l, pl_ast_kid(i, 0), false);
  l->infinity = a->limit == PL_LIMIT_TO;
  a->to = pl_lower_scalar(l, pl_ast_kid(i, 1));
  l->infinity = false;
  lower_of(l, pl_ast_kid(i, 2), a);
}

static void lower_series(pl_lower* l, const pl_ast* i, pl_ask* a) {
  a->kind = PL_ASK_SERIES;
  // the small name first: it stands in the substitution
  a->variable = lower_variable(l, pl_ast_kid(i, 2), true);
  l->infinity = true;
  a->to = pl_lower_scalar(l, pl_ast_kid(i, 3));
  l->infinity = false;
  if (pl_ast_kid(i, 0)) {
    a->substitution_left = pl_lower_scalar(l, pl_ast_kid(i, 0));
    a->substitution_right = pl_lower_scalar(l, pl_ast_kid(i, 1));
  }
  const pl_ast* order = pl_ast_kid(i, 4);
  long n = 0;
  if (order && (!pl_is_int(l->pool, pl_lower_scalar(l, order), &n) || n < 1 || n > 50)) {
    pl_lower_complain(l, PL_E017, pl_ast_span(order),
                      PL_BOTH("the order of a series is a number from 1 to 50"));
    n = 0;
  }
  a->order = (int)n;
  lower_of(l, pl_ast_kid(i, 5), a);
}

// `at θ = 0`, `at (u = 0, v = 0)`
static void lower_place(pl_lower* l, const pl_ast* at, pl_ask* a) {
  const pl_ast* group = at && at->kind != PL_AST_RELATION ? pl_ast_single(at) : NULL;
  pl_condition c;
  if (group && group->kind == PL_AST_GROUP) PUSH_CONDITIONS(l, group, a->where);
  else if (at && at->kind == PL_AST_RELATION) {
    if (pl_lower_relation(l, at, &c, 0)) pl_push(l->arena, a->where, c);
  } else if (at) not_a_condition(l, at);
}

static void lower_threshold(pl_lower* l, const pl_ast* i, pl_ask* a) {
  a->kind = PL_ASK_THRESHOLD;
  a->variable = lower_variable(l, pl_ast_kid(i, 0), false);
  const pl_ast* of = pl_ast_kid(i, 1);
  if (of->kind == PL_AST_RELATION) {
    pl_condition c;
    if (pl_lower_relation(l, of, &c, 0)) pl_push(l->arena, a->where, c);
    return;
  }
  const pl_ast* one = pl_ast_single(of);
  bool label = one && one->kind == PL_AST_NAME
               && (pl_scope_rule(l, one->key) || strcmp(one->key, "stable") == 0);
  lower_place(l, pl_ast_kid(i, 2), a);
  if (label) a->label = one->shown;
  else a->value = pl_lower_scalar(l, of);
}

// -------------------------------------------------------------------------- solve and plain values
// solve x1(t): the motion; solve x1'': the acceleration.
static void lower_solve(pl_lower* l, const pl_ast* i, pl_ask* a) {
  const pl_ast* what = pl_ast_kid(i, 0);
  a->kind = PL_ASK_SOLVE;
  if (what->kind == PL_AST_PRODUCT && what->kids.n == 2 && what->kids.at[1]->kind == PL_AST_GROUP
      && what->kids.at[1]->tight) {
    const pl_ast* group = what->kids.at[1];
    a->of_time = group->kids.n == 1 && pl_ast_is_name(group->kids.at[0], "t");
  }
  if (a->of_time) {  // λ(t), of a multiplier, is no product
    a->value = pl_lower_scalar(l, what->kids.at[0]);
    if (pl_is_poison(a->value) || pl_has_role(l->pool, a->value, PL_R_MULTIPLIER)) return;
  }
  a->value = pl_lower_scalar(l, what);
  if (pl_is_poison(a->value)) return;
  pl_kind kind = pl_kind_of(l->pool, a->value);
  if (kind == PL_SYMBOL || kind == PL_AT) return;
  pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(what),
                                       PL_BOTH("solve takes one name"));
  pl_suggest(l->job, m, NULL, PL_BOTH("write  solve λ,  solve x''  or  solve x(t)"));
}

static void lower_value(pl_lower* l, const pl_ast* i, pl_ask* a) {
  a->kind = PL_ASK_VALUE;
  const pl_ast* what = pl_ast_kid(i, 0);
  pl_quantity q = pl_lower_quantity(l, what);
  if (q.n) {
    pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(what),
                                         PL_BOTH("a number is needed here, not a vector"));
    pl_suggest(l->job, m, NULL, PL_BOTH("ask for one component, as in x(A)"));
  }
  a->value = q.at[0];
  PUSH_CONDITIONS(l, pl_ast_kid(i, 1), a->where);
  lower_motion(l, pl_ast_kid(i, 2), &a->motion);
}

// max(a, b) at the start of a request is the function, max expr the largest value of a motion.
static void lower_extreme(pl_lower* l, const pl_ast* i, pl_ask* a) {
  const pl_ast* what = pl_ast_kid(i, 0);
  const pl_ast* group = pl_ast_single(what);
  lower_motion(l, pl_ast_kid(i, 1), &a->motion);
  if (group && group->kind == PL_AST_GROUP && group->kids.n > 1) {
    pl_spelled s;
    size_t bad;
    const char* word = i->token == TOK_MAXIMUM ? "max" : "min";
    pl_spell(l->arena, l->names, word, 3, &s, &bad);
    pl_ast name = {.kind = PL_AST_NAME,
                   .source = i->source,
                   .begin = i->begin,
                   .end = i->begin + 3,
                   .key = s.key,
                   .shown = s.shown,
                   .raw = s.raw};
    a->kind = PL_ASK_VALUE;
    a->value = pl_lower_call(l, &name, group).at[0];
    return;
  }
  a->kind = i->token == TOK_MAXIMUM ? PL_ASK_MAX : PL_ASK_MIN;
  a->value = pl_lower_scalar(l, what);
}

static void lower_modes(pl_lower* l, const pl_ast* i, pl_ask* a) {
  a->kind = PL_ASK_MODES;
  const pl_ast* holding = pl_ast_kid(i, 1);
  lower_place(l, pl_ast_kid(i, 0), a);
  // momenta that are held: their coordinates
  for (int k = 0; holding && k < holding->kids.n; k++) {
    pl_expr e = pl_lower_scalar(l, holding->kids.at[k]);
    if (pl_is_poison(e)) continue;
    if (pl_kind_of(l->pool, e) == PL_SYMBOL) pl_push(l->arena, a->frame, pl_symbol_of(l->pool, e));
    else
      pl_lower_complain(l, PL_E017, pl_ast_span(holding->kids.at[k]),
                        PL_BOTH("a name is needed here"));
  }
}

static void lower_expect(pl_lower* l, const pl_ast* i, pl_ask* a) {
  a->kind = PL_ASK_EXPECT;
  const pl_ast* r = pl_ast_kid(i, 0);
  pl_condition c;
  if (r->kids.n != 2 || r->ops.at[1] == '!') {
    pl_lower_complain(l, PL_E017, pl_ast_span(r), PL_BOTH("expect takes one equation"));
    return;
  }
  if (!pl_lower_relation(l, r, &c, 0)) return;
  pl_push(l->arena, a->where, c);
  a->value = c.left;
  PUSH_CONDITIONS(l, pl_ast_kid(i, 1), a->where);
  lower_motion(l, pl_ast_kid(i, 2), &a->motion);
}

// ------------------------------------------------------------------------------------------ forces
static void lower_force_item(pl_lower* l, const pl_ast* i, pl_ask* a) {
  a->kind = i->number == TOK_OF ? PL_ASK_FORCE_OF : PL_ASK_FORCE_ON;
  const pl_ast *label = pl_ast_kid(i, 0), *name = pl_ast_kid(label, 0);
  if (i->number == TOK_OF) {
    a->label = pl_constraint_label(l, label);
  } else {
    pl_point at;
    pl_site* place;
    if (pl_lower_label_point(l, name, pl_ast_kid(label, 1), &at, &place))
      a->label = pl_label_text(l, name, pl_ast_kid(label, 1));
  }
  lower_frame(l, pl_ast_kid(i, 1), a);
  lower_motion(l, pl_ast_kid(i, 2), &a->motion);
}

static void lower_equilibria(pl_lower* l, const pl_ast* i, pl_ask* a) {
  a->kind = PL_ASK_EQUILIBRIA;
  const pl_ast* label = pl_ast_kid(i, 0);
  if (label) a->label = pl_ast_kid(label, 0)->shown;
  PUSH_CONDITIONS(l, pl_ast_kid(i, 1), a->where);
}

static void lower_stability(pl_lower* l, const pl_ast* i, pl_ask* a) {
  a->kind = PL_ASK_STABILITY;
  pl_condition c;
  if (pl_lower_relation(l, pl_ast_kid(i, 0), &c, 0)) pl_push(l->arena, a->where, c);
  a->to = pl_lower_scalar(l, pl_ast_kid(i, 1));
}

// ------------------------------------------------------------------------------------------- items
static bool is_display(int token) {
  return token == TOK_SIMULATE || token == TOK_PLOT || token == TOK_ANIMATE || token == TOK_SWEEP
         || token == TOK_POINCARE;
}

static void lower_item(pl_lower* l, const pl_ast* i, const char* letter) {
  if (is_display(i->token)) {
    pl_lower_display(l, i);
    return;
  }
  int wrong = l->wrong;
  pl_ask a = {
      .letter = letter, .text = pl_source_text(l->arena, pl_ast_span(i)), .span = pl_ast_span(i)};
  switch (i->token) {
    case TOK_DOF: a.kind = PL_ASK_DOF; break;
    case TOK_CONSTRAINTS: a.kind = PL_ASK_CONSTRAINTS; break;
    case TOK_CONSERVED: a.kind = PL_ASK_CONSERVED; break;
    case TOK_LAGRANGE1:
      a.kind = PL_ASK_LAGRANGE1;
      lower_frame(l, pl_ast_kid(i, 0), &a);
      break;
    case TOK_LAGRANGE2:
      a.kind = PL_ASK_LAGRANGE2;
      lower_frame(l, pl_ast_kid(i, 0), &a);
      break;
    case TOK_LAGRANGIAN:
      a.kind = PL_ASK_LAGRANGIAN;
      lower_frame(l, pl_ast_kid(i, 0), &a);
      break;
    case TOK_HAMILTONIAN:
      a.kind = PL_ASK_HAMILTONIAN;
      lower_frame(l, pl_ast_kid(i, 0), &a);
      break;
    case TOK_NEWTON:
      a.kind = PL_ASK_NEWTON;
      lower_frame(l, pl_ast_kid(i, 0), &a);
      break;
    case TOK_SOLVE: lower_solve(l, i, &a); break;
    case TOK_NAME: lower_value(l, i, &a); break;
    case TOK_FORCE: lower_force_item(l, i, &a); break;
    case TOK_EQUILIBRIA: lower_equilibria(l, i, &a); break;
    case TOK_MODES: lower_modes(l, i, &a); break;
    case TOK_LIMIT: lower_limit(l, i, &a); break;
    case TOK_SERIES: lower_series(l, i, &a); break;
    case TOK_THRESHOLD: lower_threshold(l, i, &a); break;
    case TOK_MAXIMUM:
    case TOK_MINIMUM: lower_extreme(l, i, &a); break;
    case TOK_AVERAGE:
      a.kind = PL_ASK_AVERAGE;
      a.value = pl_lower_scalar(l, pl_ast_kid(i, 0));
      break;
    case TOK_STABILITY: lower_stability(l, i, &a); break;
    case TOK_EXPECT: lower_expect(l, i, &a); break;
    default: return;
  }
  if (l->wrong == wrong) pl_push(l->arena, l->m->asks, a);
}

void pl_lower_ask(pl_lower* l, const pl_ast* s) {
  const pl_ast *letter = pl_ast_kid(s, 0), *items = pl_ast_kid(s, 1);
  l->mute += s->broken;
  l->results = true;
  if (letter) pl_push(l->arena, l->letters, letter->shown);
  for (int i = 0; i < items->kids.n; i++)
    lower_item(l, items->kids.at[i], letter ? letter->shown : NULL);
  l->results = false;
  l->mute -= s->broken;
}

// ------------------------------------------------------------------------------------------ events
static void lower_action(pl_lower* l, const pl_ast* node, pl_event* e) {
  static const struct {
    const char* word;
    pl_action_kind kind;
  } kinds[] = {{"stop", PL_DO_STOP},
               {"record", PL_DO_RECORD},
               {"release", PL_DO_RELEASE},
               {"attach", PL_DO_ATTACH},
               {"set", PL_DO_SET}};
  pl_action a = {.span = pl_ast_span(node)};
  int wrong = l->wrong;
  for (int k = 0; k < 5; k++) {
    if (strcmp(kinds[k].word, node->text) == 0) a.kind = kinds[k].kind;
  }
  if (a.kind == PL_DO_RELEASE || a.kind == PL_DO_ATTACH)
    a.label = pl_constraint_label(l, pl_ast_kid(node, 0));
  if (a.kind == PL_DO_SET) {
    a.target = pl_lower_scalar(l, pl_ast_kid(node, 0));
    a.value = pl_lower_scalar(l, pl_ast_kid(node, 1));
  }
  if (l->wrong == wrong) pl_push(l->arena, e->actions, a);
}

void pl_lower_event(pl_lower* l, const pl_ast* s) {
  l->mute += s->broken;
  l->results = true;
  const pl_ast *label = pl_ast_kid(s, 0), *when = pl_ast_kid(s, 1), *way = pl_ast_kid(s, 2),
               *actions = pl_ast_kid(s, 3);
  pl_event e = {.span = pl_ast_span(s)};
  const pl_ast* name = pl_ast_kid(label, 0);
  e.name = (pl_name){.text = name->shown, .ascii = name->key};
  if (pl_ast_kid(label, 1))
    pl_lower_complain(l, PL_E025, pl_ast_span(label), PL_BOTH("events are not families"));
  pl_condition c;
  bool fine = false;
  if (when->kids.n != 2 || when->ops.at[1] != '=') {
    pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(when),
                                         PL_BOTH("an event happens when an equation holds"));
    pl_suggest(l->job, m, NULL, PL_BOTH("write = ; add rising or falling for a direction"));
  } else {
    fine = pl_lower_relation(l, when, &c, 0);
  }
  e.direction = way == NULL ? 0 : way->token == TOK_RISING ? 1 : -1;
  for (int i = 0; i < actions->kids.n; i++) lower_action(l, actions->kids.at[i], &e);
  if (fine) {
    e.value = pl_sub(l->pool, c.left, c.right);
    pl_push(l->arena, l->m->events, e);
  }
  l->results = false;
  l->mute -= s->broken;
}

// ---------------------------------------------------------------------------------------- simulate
// 1..5 [min]: the unit at the end holds for all that have none.
static void unit_nodes(const pl_ast* node, const pl_ast** unit, int* bare) {
  const pl_ast* n = node;
  while (n && (n->kind == PL_AST_PRODUCT || n->kind == PL_AST_SUM) && n->kids.n >= 1)
    n = n->kids.at[n->kids.n - 1];
  if (n && n->kind == PL_AST_UNIT) *unit = n;
  else *bare += 1;
}

static void lower_range(pl_lower* l, const pl_ast* range, pl_expr* lo, pl_expr* hi, pl_expr* step,
                        long* count) {
  const pl_ast* parts[3] = {pl_ast_kid(range, 0), pl_ast_kid(range, 1), pl_ast_kid(range, 2)};
  pl_expr* values[3] = {lo, hi, step};
  const pl_ast* unit_node = NULL;
  int bare = 0;
  for (int i = 0; i < 3; i++) {
    if (parts[i]) unit_nodes(parts[i], &unit_node, &bare);
  }
  pl_unit unit;
  bool spread = unit_node && bare && pl_lower_unit(l, unit_node, &unit);
  for (int i = 0; i < 3; i++) {
    *values[i] = parts[i] ? pl_lower_scalar(l, parts[i]) : pl_poison();
    bool number = parts[i] && !pl_is_poison(*values[i]) && pl_is_constant(l->pool, *values[i])
                  && !pl_unit_occurs(l->pool, *values[i]);
    const pl_ast* own = NULL;
    int none = 0;
    if (parts[i]) unit_nodes(parts[i], &own, &none);
    if (spread && number && own == NULL) *values[i] = pl_mul(l->pool, *values[i], unit.factor);
  }
  const pl_ast* number = pl_ast_kid(range, 3);
  if (count == NULL) return;
  *count = 0;
  if (number && (!pl_is_int(l->pool, pl_lower_scalar(l, number), count) || *count < 1)) {
    pl_lower_complain(l, PL_E017, pl_ast_span(number),
                      PL_BOTH("a count is a whole number above 0"));
    *count = 0;
  }
}

static void lower_simulate(pl_lower* l, const pl_ast* s) {
  pl_simulate* m = &l->m->simulate;
  if (m->given) {
    pl_diagnostic* d = pl_lower_complain(l, PL_E028, pl_ast_span(s),
                                         PL_BOTH("simulate is given twice"));
    if (!l->mute)
      pl_report_label(l->job->diagnostics, d, m->span,
                      l->job->lang == PL_GERMAN ? pl_german("first here") : "first here");
    pl_suggest(l->job, d, NULL, PL_BOTH("keep one of them"));
    return;
  }
  int wrong = l->wrong;
  m->span = pl_ast_span(s);
  lower_range(l, pl_ast_kid(s, 0), &m->from, &m->to, &m->step, &m->count);
  m->tol = pl_ast_kid(s, 1) ? pl_lower_scalar(l, pl_ast_kid(s, 1)) : pl_poison();
  m->given = l->wrong == wrong;
}

// ---------------------------------------------------------------------------------------- pictures
// A force is drawn by its size.
static pl_expr plotted(pl_lower* l, const pl_ast* node) {
  pl_expr e = pl_lower_scalar(l, node);
  const char* label = pl_force_label(l, e);
  return label ? pl_sym(l->pool, pl_model_result_symbol(l->m, PL_RES_FORCE_NORM, label)) : e;
}

static void lower_plot(pl_lower* l, const pl_ast* s) {
  const pl_ast *y = pl_ast_kid(s, 0), *x = pl_ast_kid(s, 1);
  int wrong = l->wrong;
  pl_plot plot = {.span = pl_ast_span(s)};
  for (int i = 0; i < y->kids.n; i++) {
    pl_expr e = plotted(l, y->kids.at[i]);
    pl_push(l->arena, plot.y, e);
    pl_push(l->arena, plot.y_text, pl_source_text(l->arena, pl_ast_span(y->kids.at[i])));
  }
  plot.x = x ? plotted(l, x) : pl_sym(l->pool, pl_time(l->pool));
  plot.x_text = x ? pl_source_text(l->arena, pl_ast_span(x)) : "t";
  if (l->wrong == wrong) pl_push(l->arena, l->m->plots, plot);
}

static void lower_sweep(pl_lower* l, const pl_ast* s) {
  const pl_ast *sweeps = pl_ast_kid(s, 0), *of = pl_ast_kid(s, 1);
  for (int i = 0; i < sweeps->kids.n; i++) {
    pl_expr lo, hi, step;
    long count;
    pl_lower_quantity(l, pl_ast_kid(sweeps->kids.at[i], 0));
    lower_range(l, pl_ast_kid(sweeps->kids.at[i], 1), &lo, &hi, &step, &count);
  }
  for (int i = 0; of && i < of->kids.n; i++) pl_lower_quantity(l, of->kids.at[i]);
  pl_lower_pending(l, PL_N091, "sweep", pl_ast_span(s),
                   PL_BOTH("sweeps are not computed by this version"));
}

static void lower_poincare(pl_lower* l, const pl_ast* s) {
  const pl_ast* of = pl_ast_kid(s, 2);
  pl_condition c;
  pl_lower_relation(l, pl_ast_kid(s, 0), &c, 0);
  for (int i = 0; i < of->kids.n; i++) pl_lower_quantity(l, of->kids.at[i]);
  pl_lower_pending(l, PL_N091, "poincare", pl_ast_span(s),
                   PL_BOTH("Poincaré sections are not computed by this version"));
}

void pl_lower_display(pl_lower* l, const pl_ast* s) {
  l->mute += s->broken;
  bool results = l->results;
  l->results = true;
  switch (s->token) {
    case TOK_SIMULATE: lower_simulate(l, s); break;
    case TOK_PLOT: lower_plot(l, s); break;
    case TOK_ANIMATE:
    case TOK_DRAW: pl_lower_draw(l, s); break;
    case TOK_SWEEP: lower_sweep(l, s); break;
    case TOK_POINCARE: lower_poincare(l, s); break;
    default: break;
  }
  l->results = results;
  l->mute -= s->broken;
}
