// Declarations: headers, parameters, coordinates, abbreviations, assumptions.
#include "lang/lower_impl.h"

#include <string.h>

#include "grammar.h"

// ----------------------------------------------------------------------------------------- headers
static void lower_version(pl_lower* l, const pl_ast* s) {
  const pl_ast* number = pl_ast_kid(s, 0);
  if (strcmp(number->text, "1") == 0) return;
  pl_diagnostic* m = pl_lower_complain(l, PL_E001, pl_ast_span(number),
                                       PL_BOTH("there is no language version %s"), number->text);
  pl_suggest(l->job, m, "1", PL_BOTH("write  pleuel 1"));
}

static void lower_language(pl_lower* l, const pl_ast* s) {
  const pl_ast* word = pl_ast_kid(s, 0);
  const char* text = word->kind == PL_AST_NAME ? word->raw : word->text;
  l->m->lang_given = true;
  if (strcmp(text, "de") == 0) l->m->lang = PL_GERMAN;
  else if (strcmp(text, "en") == 0) l->m->lang = PL_ENGLISH;
  else {
    pl_diagnostic* m = pl_lower_complain(l, PL_E001, pl_ast_span(word),
                                         PL_BOTH("there is no language %s"), text);
    pl_suggest(l->job, m, "en", PL_BOTH("write  lang en  or  lang de"));
  }
}

static void lower_axes(pl_lower* l, const pl_ast* s) {
  static const char* const directions[] = {"right", "left", "up", "down", "out"};
  const pl_ast* list = pl_ast_kid(s, 0);
  if (l->m->n_axes) {
    pl_diagnostic* m = pl_lower_complain(l, PL_E028, pl_ast_span(s),
                                         PL_BOTH("the axes are given twice"));
    pl_suggest(l->job, m, NULL, PL_BOTH("remove one of the lines"));
    return;
  }
  for (int i = 0; i < list->kids.n; i++) {
    const pl_ast *axis = list->kids.at[i], *name = pl_ast_kid(axis, 0), *way = pl_ast_kid(axis, 1);
    if (i >= 3) {
      pl_lower_complain(l, PL_E029, pl_ast_span(axis), PL_BOTH("there are at most three axes"));
      return;
    }
    const char* direction = NULL;
    for (int k = 0; way && k < 5; k++) {
      if (strcmp(directions[k], way->key) == 0) direction = directions[k];
    }
    if (way && !direction) {
      pl_diagnostic* m = pl_lower_complain(l, PL_E029, pl_ast_span(way),
                                           PL_BOTH("%s is not a direction"), way->shown);
      pl_suggest(l->job, m, NULL, PL_BOTH("directions are right, left, up, down, out"));
    }
    if (pl_axis_find(l, name->key) >= 0) {
      pl_lower_complain(l, PL_E028, pl_ast_span(name), PL_BOTH("axis %s is given twice"),
                        name->shown);
      continue;
    }
    l->m->axes[l->m->n_axes++] = (pl_axis){name->shown, name->key, direction, true};
  }
}

// lambda - minus is read as lambda-minus.
static const char* without_blanks(pl_lower* l, const char* s) {
  pl_text t = pl_text_make(l->arena);
  for (; *s; s++)
    if (*s != ' ' && *s != '\t') pl_text_add_n(&t, s, 1);
  return pl_text_string(&t);
}

static void lower_convention(pl_lower* l, const pl_ast* s) {
  const pl_ast* list = pl_ast_kid(s, 0);
  for (int i = 0; i < list->kids.n; i++) {
    pl_span span = pl_ast_span(list->kids.at[i]);
    const char* word = without_blanks(l, pl_source_text(l->arena, span));
    if (strcmp(word, "lambda-minus") == 0 || strcmp(word, "λ-minus") == 0)
      l->m->lambda_minus = true;
    else if (strncmp(word, "lambda", 6) == 0 && strcmp(word, "lambda-plus") != 0) {
      pl_diagnostic* m = pl_lower_complain(l, PL_E001, span, PL_BOTH("there is no convention %s"),
                                           word);
      pl_suggest(l->job, m, "lambda-minus", PL_BOTH("write lambda-minus"));
    }
    // other words are labels for the reader
  }
}

static void lower_header(pl_lower* l, const pl_ast* s) {
  switch (s->token) {
    case TOK_PLEUEL: lower_version(l, s); break;
    case TOK_SYSTEM:
      if (l->m->title) {
        pl_diagnostic* m = pl_lower_complain(l, PL_E028, pl_ast_span(s),
                                             PL_BOTH("the system has a title already"));
        pl_suggest(l->job, m, NULL, PL_BOTH("remove one of the lines"));
      } else l->m->title = pl_ast_kid(s, 0)->text;
      break;
    case TOK_LANG: lower_language(l, s); break;
    case TOK_AXES: lower_axes(l, s); break;
    case TOK_CONVENTION: lower_convention(l, s); break;
    default: break;
  }
}

// ------------------------------------------------------------------------------- names, first pass
static const pl_ast* declared_name(const pl_ast* definition) {
  const pl_ast* d = pl_ast_kid(definition, 0);
  return d->kind == PL_AST_INDEXED ? pl_ast_kid(d, 0) : d;
}

// coord x[m] without a blank: what stands between the brackets is a unit unless it is a range.
static const pl_ast* declared_range(const pl_ast* definition) {
  const pl_ast* d = pl_ast_kid(definition, 0);
  return d->kind == PL_AST_INDEXED && pl_ast_kid(d, 1)->kind == PL_AST_RANGE ? pl_ast_kid(d, 1)
                                                                             : NULL;
}

static bool only_coordinates_are_families(pl_lower* l, const pl_ast* definition) {
  const pl_ast* range = declared_range(definition);
  if (range == NULL) return false;
  const pl_ast* name = declared_name(definition);
  pl_diagnostic* m = pl_lower_complain(l, PL_E025, pl_ast_span(pl_ast_kid(definition, 0)),
                                       PL_BOTH("only coordinates can be families"));
  pl_suggest(l->job, m, NULL, PL_BOTH("write a function:  let %s(i) = ..."), name->shown);
  return true;
}

static void declare_names(pl_lower* l, const pl_ast* s) {
  const pl_ast* list = pl_ast_kid(s, 0);
  for (int i = 0; i < list->kids.n; i++) {
    const pl_ast* d = list->kids.at[i];
    const pl_ast* name = declared_name(d);
    bool coord = s->token == TOK_COORD, family = coord && declared_range(d);
    if (!coord && only_coordinates_are_families(l, d)) {
      pl_push(l->arena, l->lost, name->key);
      continue;
    }
    pl_entity_kind kind = s->token == TOK_PARAM   ? PL_ENTITY_PARAM
                          : s->token == TOK_INPUT ? PL_ENTITY_INPUT
                          : s->token == TOK_LET
                              ? (pl_ast_kid(d, 1) ? PL_ENTITY_FUNCTION : PL_ENTITY_LET)
                          : family ? PL_ENTITY_FAMILY
                                   : PL_ENTITY_COORD;
    pl_symbol symbol = {0};
    bool new_name = pl_scope_find(l, name->key) == NULL;
    if (s->token != TOK_LET && new_name) {
      symbol = pl_scope_symbol(l, name, coord ? (family ? PL_R_ARRAY : PL_R_COORD) : PL_R_PARAM);
    }
    pl_entity* e = pl_scope_declare(l, kind, name, symbol);
    e->definition = d;
    if (s->token == TOK_PARAM && pl_word_reserved(name->key)) e->broken = true;
  }
}

// `choose φ with x = l sin φ` names a coordinate of its own: one that the file does not declare is
// declared here.
void pl_lower_declare_chosen(pl_lower* l, const pl_ast* s) {
  const pl_ast *names = pl_ast_kid(s, 0), *maps = pl_ast_kid(s, 1);
  for (int i = 0; maps && i < names->kids.n; i++) {
    const pl_ast* name = pl_ast_single(names->kids.at[i]);
    bool plain = name && name->kind == PL_AST_NAME && !name->number;
    if (!plain || pl_scope_find(l, name->key) || strcmp(name->key, "t") == 0) continue;
    if (pl_word_reserved(name->key) || pl_word_function(name->key)) continue;
    pl_scope_declare(l, PL_ENTITY_COORD, name, pl_scope_symbol(l, name, PL_R_COORD))->definition =
        name;
  }
}

void pl_lower_chosen(pl_lower* l, const pl_ast* s) {
  const pl_ast* names = pl_ast_kid(s, 0);
  for (int i = 0; i < names->kids.n; i++) {
    const pl_ast* name = pl_ast_single(names->kids.at[i]);
    pl_entity* e = name && name->kind == PL_AST_NAME ? pl_scope_find(l, name->key) : NULL;
    if (e && e->definition == name)
      pl_push(l->arena, l->m->coords, (pl_coord){.symbol = e->symbol, .span = pl_ast_span(name)});
  }
}

// ----------------------------------------------------------------------------- values, second pass
// The unit that a value is written in: that of the last factor.
static const pl_ast* unit_of_value(const pl_ast* value) {
  while (value && (value->kind == PL_AST_PRODUCT || value->kind == PL_AST_SUM)) {
    if (value->kind == PL_AST_SUM && value->kids.n > 1) return NULL;
    value = value->kids.at[value->kids.n - 1];
  }
  return value && value->kind == PL_AST_UNIT ? value : NULL;
}

static bool has_own_unit(const pl_ast* value) {
  const pl_ast* one = pl_ast_single(value);
  return unit_of_value(value) || (one && one->kind == PL_AST_DEGREE);
}

static const pl_ast* unit_of_definition(pl_lower* l, const pl_ast* d) {
  if (pl_ast_kid(d, 3)) return pl_ast_kid(d, 3);
  const pl_ast* name = pl_ast_kid(d, 0);
  if (name->kind == PL_AST_INDEXED && pl_ast_kid(name, 1)->kind != PL_AST_RANGE) {
    pl_ast* unit = PL_NEW(l->arena, pl_ast);
    *unit = *pl_ast_kid(name, 1);
    unit->kind = PL_AST_UNIT;
    unit->text = pl_source_text(l->arena, pl_ast_span(unit));
    unit->end++;
    return unit;
  }
  return pl_ast_kid(d, 2) ? unit_of_value(pl_ast_kid(d, 2)) : NULL;
}

static void give_dimension(pl_lower* l, pl_symbol s, const pl_unit* unit) {
  pl_symbol_info* info = pl_symbol_get(l->pool, s);
  info->dimension = unit->dimension;
  info->dimension_known = true;
}

static pl_expr value_with_unit(pl_lower* l, const pl_ast* d, const pl_ast* value,
                               const pl_unit* unit, bool declared) {
  pl_expr e = pl_lower_scalar(l, value);
  if (pl_is_poison(e) || !declared || pl_unit_occurs(l->pool, e)) return e;
  if (pl_is_constant(l->pool, e)) return pl_mul(l->pool, e, unit->factor);
  pl_diagnostic* m = pl_lower_complain(l, PL_E023, pl_ast_span(pl_ast_kid(d, 3)),
                                       PL_BOTH("a unit belongs to a number"));
  pl_suggest(l->job, m, NULL, PL_BOTH("remove it; the unit follows from the formula"));
  return e;
}

// l = 0.5 m with m a mass: half of it; a metre has its brackets.
static void hint_unit(pl_lower* l, const pl_ast* value) {
  if (!value || (value->kind == PL_AST_SUM && value->kids.n != 1)) return;
  const pl_ast* v = value->kind == PL_AST_SUM ? value->kids.at[0] : value;
  if (v->kind != PL_AST_PRODUCT || v->kids.n != 2 || v->ops.at[1] != ' ') return;
  const pl_ast *number = v->kids.at[0], *name = v->kids.at[1];
  if (number->kind != PL_AST_NUMBER || name->kind != PL_AST_NAME || name->number
      || !pl_scope_find(l, name->key))
    return;
  pl_unit unit;
  size_t at, n;
  const char* near;
  if (!pl_unit_parse(l->pool, name->raw, strlen(name->raw), &unit, &at, &n, &near)) return;
  pl_diagnostic* m = pl_lower_complain(l, PL_W071, pl_ast_span(value),
                                       PL_BOTH("%1$s %2$s is read as %1$s times %2$s"),
                                       number->text, name->shown);
  pl_suggest(l->job, m, pl_format(l->arena, "%s [%s]", number->text, name->raw),
             PL_BOTH("write %1$s [%2$s] if the unit is meant"), number->text, name->raw);
}

static void lower_param(pl_lower* l, const pl_ast* d, bool broken) {
  const pl_ast *name = declared_name(d), *value = pl_ast_kid(d, 2);
  pl_entity* e = pl_scope_find(l, name->key);
  if (e == NULL || e->definition != d) return;
  const pl_ast* unit_node = unit_of_definition(l, d);
  bool declared = unit_node && (pl_ast_kid(d, 3) == unit_node || value == NULL);
  pl_unit unit = {0};
  bool unit_fine = false;
  if (unit_node && declared) unit_fine = pl_lower_unit(l, unit_node, &unit);
  pl_expr v = pl_poison();
  int wrong = l->wrong;
  if (e->override) {
    v = pl_lower_scalar(l, e->override);
    // a bare number is in the unit of the file: --set l=300 for l [mm]
    pl_unit own;
    bool bare = !pl_is_poison(v) && pl_is_constant(l->pool, v) && !pl_unit_occurs(l->pool, v)
                && !has_own_unit(e->override);
    if (bare && unit_node && pl_lower_unit(l, unit_node, &own)) v = pl_mul(l->pool, v, own.factor);
  } else if (value) {
    hint_unit(l, value);
    v = value_with_unit(l, d, value, &unit, declared && unit_fine);
  }
  if (l->wrong > wrong || broken) e->broken = true;
  if (unit_fine) give_dimension(l, e->symbol, &unit);
  const pl_ast* single = value ? pl_ast_single(value) : NULL;
  bool degrees = single && single->kind == PL_AST_DEGREE;  // 30° is 30 [deg]
  bool has_unit = unit_node != NULL || degrees || (!pl_is_poison(v) && pl_unit_occurs(l->pool, v));
  pl_param p = {.symbol = e->symbol,
                .value = v,
                .has_unit = has_unit,
                .unit_text = unit_node ? unit_node->text
                             : degrees ? "deg"
                                       : NULL,
                .span = pl_ast_span(d)};
  pl_push(l->arena, l->m->params, p);
}

static void lower_coord(pl_lower* l, const pl_ast* d) {
  const pl_ast *name = declared_name(d), *range = declared_range(d);
  pl_entity* e = pl_scope_find(l, name->key);
  if (e == NULL || e->definition != d) return;
  pl_coord c = {.symbol = e->symbol, .span = pl_ast_span(d)};
  if (range) {
    c.lo = pl_lower_scalar(l, pl_ast_kid(range, 0));
    c.hi = pl_lower_scalar(l, pl_ast_kid(range, 1));
    if (pl_is_poison(c.lo) || pl_is_poison(c.hi)) {
      e->broken = true;
      c.lo = c.hi = pl_int(l->pool, 1);
    }
  }
  const pl_ast* unit_node = unit_of_definition(l, d);
  pl_unit unit;
  if (unit_node && pl_lower_unit(l, unit_node, &unit)) {
    c.has_unit = true;
    give_dimension(l, e->symbol, &unit);
  }
  pl_push(l->arena, l->m->coords, c);
}

static void lower_let(pl_lower* l, const pl_ast* d) {
  const pl_ast* name = declared_name(d);
  pl_entity* e = pl_scope_find(l, name->key);
  if (e == NULL || e->definition != d) return;
  if (e->kind == PL_ENTITY_LET) {
    pl_scope_finish_let(l, e);
    return;
  }
  // a function: its body is read once with its arguments as names, so that mistakes show without a
  // call
  const pl_ast* arguments = pl_ast_kid(d, 1);
  int n = l->locals.n, wrong = l->wrong;
  for (int i = 0; i < arguments->kids.n; i++) {
    const pl_ast* a = pl_ast_single(arguments->kids.at[i]);
    if (a == NULL || a->kind != PL_AST_NAME || a->number) {
      pl_lower_complain(l, PL_E017, pl_ast_span(arguments->kids.at[i]),
                        PL_BOTH("an argument of a function is a name"));
      continue;
    }
    pl_symbol_info info = {.name = a->shown,
                           .ascii = pl_format(l->arena, "%s_of_%s", a->key, name->key),
                           .role = PL_R_LOCAL,
                           .class = PL_C_OTHER,
                           .dimension = pl_dimension_one()};
    pl_push(l->arena, l->locals,
            (pl_local){.key = a->key, .symbol = pl_symbol_make(l->pool, &info)});
  }
  bool results = l->results;
  l->results = true;
  e->state = 1;
  l->mute += e->broken;
  pl_quantity value = pl_lower_quantity(l, pl_ast_kid(d, 2));
  l->mute -= e->broken;
  e->state = 0;
  l->results = results;
  l->locals.n = n;
  if (l->wrong > wrong) e->broken = true;
  e->symbol = pl_scope_symbol(l, name, PL_R_LOCAL);
  pl_push(l->arena, l->m->lets,
          (pl_let){.symbol = e->symbol,
                   .n_args = arguments->kids.n,
                   .inserted = true,
                   .value = value.at[0],
                   .span = pl_ast_span(d)});
}

// ------------------------------------------------------------------------------------- assumptions
static void lower_assume_one(pl_lower* l, const pl_ast* c) {
  pl_assumption a = {.span = pl_ast_span(c)};
  if (c->kind == PL_AST_RELATION) {
    for (int i = 0; i + 1 < c->kids.n; i++) {
      a.kind = PL_A_RELATION;
      if (pl_lower_relation(l, c, &a.condition, i)) pl_push(l->arena, l->m->assumptions, a);
    }
    return;
  }
  a.subject = pl_lower_scalar(l, pl_ast_kid(c, 0));
  a.kind = PL_A_INTEGER;
  if (c->kind == PL_AST_IN) {
    const pl_ast* range = pl_ast_kid(c, 1);
    a.kind = PL_A_IN;
    a.lo = pl_lower_scalar(l, pl_ast_kid(range, 0));
    a.hi = pl_lower_scalar(l, pl_ast_kid(range, 1));
    if (pl_is_poison(a.lo) || pl_is_poison(a.hi)) return;
  }
  if (!pl_is_poison(a.subject)) pl_push(l->arena, l->m->assumptions, a);
}

static void lower_output(pl_lower* l, const pl_ast* s) {
  const pl_ast* name = pl_ast_kid(s, 0);
  bool results = l->results;
  l->results = true;
  pl_expr value = pl_lower_scalar(l, pl_ast_kid(s, 1));
  l->results = results;
  if (pl_force_label(l, value)) {
    pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(pl_ast_kid(s, 1)),
                                         PL_BOTH("a number is needed here, not a force"));
    pl_suggest(l->job, m, NULL, PL_BOTH("take its size, norm(force(...))"));
    return;
  }
  for (int i = 0; i < l->m->outputs.n; i++) {
    if (strcmp(l->m->outputs.at[i].name, name->key) != 0) continue;
    pl_diagnostic* m = pl_lower_complain(l, PL_E028, pl_ast_span(name),
                                         PL_BOTH("output %s is given twice"), name->shown);
    pl_suggest(l->job, m, NULL, PL_BOTH("choose another name"));
    return;
  }
  if (!pl_is_poison(value))
    pl_push(l->arena, l->m->outputs,
            (pl_output){.name = name->key, .value = value, .span = pl_ast_span(s)});
}

// ---------------------------------------------------------------------------------------- dispatch
void pl_lower_declare(pl_lower* l, const pl_ast* s) {
  l->mute += s->broken;
  switch (s->token) {
    case TOK_PARAM:
    case TOK_COORD:
    case TOK_LET:
    case TOK_INPUT: declare_names(l, s); break;
    default: lower_header(l, s);
  }
  l->mute -= s->broken;
}

static void each(pl_lower* l, const pl_ast* s, void (*go)(pl_lower*, const pl_ast*)) {
  const pl_ast* list = pl_ast_kid(s, 0);
  for (int i = 0; i < list->kids.n; i++) go(l, list->kids.at[i]);
}

void pl_lower_statement(pl_lower* l, const pl_ast* s) {
  l->mute += s->broken;
  const pl_ast* list = pl_ast_kid(s, 0);
  switch (s->token) {
    case TOK_PARAM:
      for (int i = 0; i < list->kids.n; i++) lower_param(l, list->kids.at[i], s->broken);
      break;
    case TOK_COORD: each(l, s, lower_coord); break;
    case TOK_LET: each(l, s, lower_let); break;
    case TOK_ASSUME: each(l, s, lower_assume_one); break;
    case TOK_OUTPUT: lower_output(l, s); break;
    case TOK_INPUT:
      pl_lower_pending(l, PL_N091, "input", pl_ast_span(s),
                       PL_BOTH("inputs are given quantities in formulas and 0 in a motion; a "
                               "program gives them values "
                               "(pleuel.h)"));
      for (int i = 0; i < list->kids.n; i++) {
        pl_entity* e = pl_scope_find(l, declared_name(list->kids.at[i])->key);
        if (e && e->definition == list->kids.at[i])
          pl_push(l->arena, l->m->params,
                  (pl_param){.symbol = e->symbol, .input = true, .span = e->span});
      }
      break;
    default: break;
  }
  l->mute -= s->broken;
}
