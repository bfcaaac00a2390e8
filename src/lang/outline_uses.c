// Where names stand: a walk over the trees with the indices and arguments that are in scope.  What
// a name means follows the rules of lower_scope.c: first what is local, then what is declared,
// then spellings of derivatives, multipliers, momenta.  Behind `on`, `between`, `of` and in pos(A)
// a name is a label first.
#include "lang/outline_impl.h"

#include <string.h>

#include "grammar.h"

static void walk(pl_outlining* w, const pl_ast* n);

// ------------------------------------------------------------------------------------ one name
static int local_of(const pl_outlining* w, const char* key) {
  for (int i = w->locals.n - 1; i >= 0; i--) {
    if (w->o->named.at[w->locals.at[i]].key == key) return w->locals.at[i];
  }
  return -1;
}

// x_dot, x_ddot, x_0, x_dot_0: the name is what stands before.
static int alias_of(const pl_outlining* w, const pl_ast* name, pl_span* span, int* dots) {
  static const struct {
    const char* suffix;
    int dots;
  } all[] = {{"_0", 0}, {"_ddot", 2}, {"_dot", 1}};
  char stem[128];
  size_t n = strlen(name->raw), cut = 0;
  if (n >= sizeof stem) return -1;
  memcpy(stem, name->raw, n + 1);
  for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
    size_t m = strlen(all[k].suffix);
    if (n <= cut + m || memcmp(stem + n - cut - m, all[k].suffix, m) != 0) continue;
    cut += m;
    stem[n - cut] = 0;
    *dots += all[k].dots;
  }
  pl_spelled s;
  size_t bad;
  if (cut == 0 || !pl_spell(w->arena, w->o->interned, stem, n - cut, &s, &bad)) return -1;
  int named = pl_outlining_find(w, PL_SPACE_VALUE, s.key);
  if (named < 0 || w->o->named.at[named].kind != PL_NAMED_COORDINATE) return -1;
  span->end -= (uint32_t)cut;
  return named;
}

// λ_rod is the multiplier of the constraint rod.
static int multiplier_of(const pl_outlining* w, const pl_ast* name, pl_span* span) {
  int named = pl_outlining_multiplier(w, name->key);
  if (named >= 0) return named;
  if (strncmp(name->key, "lambda", 6) != 0) return -1;
  const char* label = name->key + 6 + (name->key[6] == '_');
  named = pl_outlining_find(w, PL_SPACE_CONSTRAINT, pl_intern(w->o->interned, label));
  if (named < 0) return -1;
  const char* text = span->source->text + span->begin;
  uint32_t skip = strncmp(text, "lambda", 6) == 0 ? 6 : 2;
  skip += text[skip] == '_';
  if (span->begin + skip < span->end) span->begin += skip;
  return named;
}

static int momentum_of(const pl_outlining* w, const pl_ast* name, pl_span* span) {
  if (strncmp(name->key, "p_", 2) != 0) return -1;
  int named = pl_outlining_find(w, PL_SPACE_VALUE, pl_intern(w->o->interned, name->key + 2));
  if (named >= 0) span->begin += 2;
  return named;
}

static int meaning_of(const pl_outlining* w, const pl_ast* name, pl_span* span, int* dots) {
  int named = local_of(w, name->key);
  if (named < 0) named = pl_outlining_find(w, PL_SPACE_VALUE, name->key);
  if (named < 0) named = alias_of(w, name, span, dots);
  if (named < 0) named = multiplier_of(w, name, span);
  if (named < 0) named = momentum_of(w, name, span);
  if (named < 0) named = pl_outlining_find(w, PL_SPACE_REQUEST, name->key);
  return named;
}

static void name(pl_outlining* w, const pl_ast* n, int dots) {
  pl_span span = pl_ast_span(n);
  dots += n->number;
  int named = n->key ? meaning_of(w, n, &span, &dots) : -1;
  if (named < 0) return;
  pl_outlining_use(w, span, named, dots,
                   w->o->named.at[named].span.begin == n->begin
                       && w->o->named.at[named].span.source == n->source);
}

// -------------------------------------------------------------------------------------- labels
// The name of an expression that is nothing but a label, A or P[i-1].
static const pl_ast* label_name(const pl_ast* node, const pl_ast** index) {
  *index = NULL;
  while (node && (node->kind == PL_AST_PRODUCT || node->kind == PL_AST_SUM) && node->kids.n == 1) {
    node = node->kids.at[0];
  }
  if (!node) return NULL;
  if (node->kind == PL_AST_LABEL || node->kind == PL_AST_INDEXED) {
    *index = pl_ast_kid(node, 1);
    node = pl_ast_kid(node, 0);
  }
  return node && node->kind == PL_AST_NAME && node->number == 0 ? node : NULL;
}

// A label of the first space that knows it.
static bool label(pl_outlining* w, const pl_ast* node, const pl_space* spaces, int n) {
  const pl_ast* index;
  const pl_ast* at = label_name(node, &index);
  for (int k = 0; at && k < n; k++) {
    int named = pl_outlining_find(w, spaces[k], at->key);
    if (named < 0) continue;
    const pl_named* found = &w->o->named.at[named];
    int value = found->unlabelled ? pl_outlining_find(w, PL_SPACE_VALUE, at->key) : -1;
    bool defines = found->span.begin == at->begin && found->span.source == at->source;
    pl_outlining_use(w, pl_ast_span(at), value >= 0 ? value : named, 0, defines && value < 0);
    if (index) walk(w, index);
    return true;
  }
  return false;
}

static const pl_space place_first[] = {PL_SPACE_PLACE};
static const pl_space any_label[] = {PL_SPACE_CONSTRAINT, PL_SPACE_PLACE, PL_SPACE_EVENT,
                                     PL_SPACE_FORCE};

// Behind `on` and `between`: a label, or a point.
static void where(pl_outlining* w, const pl_ast* node) {
  if (node && !label(w, node, place_first, 1)) walk(w, node);
}

static void any(pl_outlining* w, const pl_ast* node) {
  if (node && !label(w, node, any_label, 4)) walk(w, node);
}

// --------------------------------------------------------------------------------- expressions
static const pl_ast* base_of(const pl_ast* n) {
  while (n
         && (n->kind == PL_AST_POWER || n->kind == PL_AST_PRIME || n->kind == PL_AST_UNIT
             || n->kind == PL_AST_DEGREE)) {
    n = pl_ast_kid(n, 0);
  }
  return n;
}

static bool is_one_of(const char* key, const char* const* words, int n) {
  for (int i = 0; i < n; i++) {
    if (strcmp(key, words[i]) == 0) return true;
  }
  return false;
}

static int define_local(pl_outlining* w, const pl_ast* at, pl_span scope) {
  pl_named named = {.kind = PL_NAMED_INDEX,
                    .key = at->key,
                    .shown = at->shown,
                    .span = pl_ast_span(at),
                    .definition = scope,
                    .scope = scope};
  pl_push(w->arena, w->o->named, named);
  pl_push(w->arena, w->locals, w->o->named.n - 1);
  pl_outlining_use(w, named.span, w->o->named.n - 1, 0, true);
  return w->o->named.n - 1;
}

// sum(i in 1..N, x[i])
static bool sum_group(pl_outlining* w, const pl_ast* group) {
  const pl_ast* first = group->kids.n == 2 ? group->kids.at[0] : NULL;
  if (!first || first->kind != PL_AST_IN) return false;
  const pl_ast* index;
  const pl_ast* at = label_name(pl_ast_kid(first, 0), &index);
  if (!at || index) return false;
  walk(w, pl_ast_kid(first, 1));
  define_local(w, at, pl_ast_span(group));
  walk(w, group->kids.at[1]);
  w->locals.n--;
  return true;
}

// pos(A), force(rod), x(A), sum(i in ...): the bracket behind a name that takes a label.  Returns
// whether it was read.
static bool call(pl_outlining* w, const pl_ast* function, const pl_ast* group) {
  static const char* const of_place[] = {"pos", "vel"};
  static const char* const of_constraint[] = {"force", "normal"};
  if (function->kind != PL_AST_NAME || !function->key || group->kids.n < 1) return false;
  bool declared = local_of(w, function->key) >= 0
                  || pl_outlining_find(w, PL_SPACE_VALUE, function->key) >= 0;
  const pl_ast* only = group->kids.n == 1 ? group->kids.at[0] : NULL;
  if (!declared && strcmp(function->key, "sum") == 0) return sum_group(w, group);
  if (!declared && only && is_one_of(function->key, of_place, 2))
    return label(w, only, place_first, 1);
  if (!declared && only && is_one_of(function->key, of_constraint, 2))
    return label(w, only, any_label, 1);
  int axis = pl_outlining_find(w, PL_SPACE_AXIS, function->key);
  bool usual = strcmp(function->key, "x") == 0 || strcmp(function->key, "y") == 0
               || strcmp(function->key, "z") == 0;
  const pl_ast* index;
  const pl_ast* at = only && (axis >= 0 || usual) ? label_name(only, &index) : NULL;
  if (!at || pl_outlining_find(w, PL_SPACE_PLACE, at->key) < 0) return false;
  if (axis >= 0) pl_outlining_use(w, pl_ast_span(function), axis, 0, false);
  return label(w, only, place_first, 1);
}

static void product(pl_outlining* w, const pl_ast* n) {
  for (int i = 0; i < n->kids.n; i++) {
    const pl_ast *f = n->kids.at[i], *next = i + 1 < n->kids.n ? base_of(n->kids.at[i + 1]) : NULL;
    bool bracket = next && next->kind == PL_AST_GROUP && n->ops.at[i + 1] == ' ';
    int uses = w->o->uses.n;
    if (bracket && call(w, base_of(f), next)) {
      // the name before the bracket is a function, or an axis that was noted
      i++;
      continue;
    }
    w->o->uses.n = uses;
    walk(w, f);
  }
}

static void kids(pl_outlining* w, const pl_ast* n, int from) {
  for (int i = from; i < n->kids.n; i++) walk(w, n->kids.at[i]);
}

// ------------------------------------------------------------------------ pieces of statements
static void option(pl_outlining* w, const pl_ast* n) {
  const pl_ast* value = pl_ast_kid(n, 0);
  if (!value) return;
  if (strcmp(n->text, "with") == 0) {
    int named = pl_outlining_multiplier(w, value->key);
    if (named >= 0)
      pl_outlining_use(w, pl_ast_span(value), named, 0,
                       w->o->named.at[named].span.begin == value->begin);
  } else if (value->kind == PL_AST_LABEL) {
    any(w, value);
  } else {
    walk(w, value);
  }
}

// A request: labels behind `of` and `on` stand as labels in the tree.
static void item(pl_outlining* w, const pl_ast* n) {
  if (n->token == TOK_FORCE && n->number == TOK_ON) {
    if (!label(w, pl_ast_kid(n, 0), place_first, 1)) any(w, pl_ast_kid(n, 0));
    kids(w, n, 1);
    return;
  }
  kids(w, n, 0);
}

static void axis(pl_outlining* w, const pl_ast* n) {
  const pl_ast* at = pl_ast_kid(n, 0);
  int named = pl_outlining_find(w, PL_SPACE_AXIS, at->key);
  if (named >= 0) pl_outlining_use(w, pl_ast_span(at), named, 0, n->kind == PL_AST_AXIS);
}

static void walk(pl_outlining* w, const pl_ast* n) {
  if (!n) return;
  switch (n->kind) {
    case PL_AST_NAME: name(w, n, 0); break;
    case PL_AST_INDEXED:
      name(w, pl_ast_kid(n, 0), 0);
      walk(w, pl_ast_kid(n, 1));
      break;
    case PL_AST_PRIME: {
      const pl_ast* inner = pl_ast_kid(n, 0);
      if (inner->kind == PL_AST_NAME) name(w, inner, n->number);
      else if (inner->kind == PL_AST_INDEXED) {
        name(w, pl_ast_kid(inner, 0), n->number);
        walk(w, pl_ast_kid(inner, 1));
      } else walk(w, inner);
      break;
    }
    case PL_AST_PRODUCT: product(w, n); break;
    case PL_AST_LABEL:
      if (!label(w, n, any_label, 4)) walk(w, pl_ast_kid(n, 1));
      break;
    case PL_AST_OPTION: option(w, n); break;
    case PL_AST_ITEM: item(w, n); break;
    case PL_AST_AXIS:
    case PL_AST_DIRECTION: axis(w, n); break;
    default: kids(w, n, 0);
  }
}

// ---------------------------------------------------------------------------------- statements
static void declared_list(pl_outlining* w, const pl_ast* s) {
  const pl_ast* list = pl_ast_kid(s, 0);
  for (int i = 0; i < list->kids.n; i++) {
    const pl_ast *d = list->kids.at[i], *at = pl_ast_kid(d, 0), *arguments = pl_ast_kid(d, 1);
    bool indexed = at->kind == PL_AST_INDEXED;
    name(w, indexed ? pl_ast_kid(at, 0) : at, 0);
    if (indexed && pl_ast_kid(at, 1)->kind == PL_AST_RANGE) walk(w, pl_ast_kid(at, 1));
    int before = w->locals.n;
    for (int k = 0; arguments && k < arguments->kids.n; k++) {
      const pl_ast* index;
      const pl_ast* argument = label_name(arguments->kids.at[k], &index);
      if (argument && !index) define_local(w, argument, pl_ast_span(d));
    }
    walk(w, pl_ast_kid(d, 2));
    w->locals.n = before;
  }
}

static void starts(pl_outlining* w, const pl_ast* s) {
  const pl_ast* list = pl_ast_kid(s, 1);
  walk(w, pl_ast_kid(s, 0));
  for (int i = 0; i < list->kids.n; i++) {
    const pl_ast* r = list->kids.at[i];
    int before = w->o->uses.n;
    walk(w, r);
    if (r->kids.n != 2 || r->ops.at[1] != '=' || w->o->uses.n == before) continue;
    const pl_use* target = &w->o->uses.at[before];
    const pl_ast* index;
    const pl_ast* base = base_of(pl_ast_kid(r, 0));
    while (base && (base->kind == PL_AST_PRODUCT || base->kind == PL_AST_SUM) && base->kids.n == 1)
      base = base_of(base->kids.at[0]);
    label_name(base, &index);
    pl_written_start start = {.named = target->named,
                              .dots = target->dots,
                              .indexed = index != NULL,
                              .in_block = w->in_block,
                              .guess = s->token == TOK_GUESS,
                              .at = pl_ast_kid(s, 0) != NULL,
                              .value = pl_ast_span(pl_ast_kid(r, 1)),
                              .relation = pl_ast_span(r),
                              .statement = pl_ast_span(s)};
    if (target->span.begin < start.value.begin) pl_push(w->arena, w->o->starts, start);
  }
}

static void items(pl_outlining* w, const pl_ast* s) {
  const pl_ast *letter = pl_ast_kid(s, 0), *list = pl_ast_kid(s, 1);
  if (letter) {
    int named = pl_outlining_find(w, PL_SPACE_REQUEST, letter->key);
    if (named >= 0) pl_outlining_use(w, pl_ast_span(letter), named, 0, true);
  }
  for (int i = 0; list && i < list->kids.n; i++) {
    const pl_ast* n = list->kids.at[i];
    pl_written_item one = {.letter = letter ? letter->shown : NULL,
                           .text = pl_source_text(w->arena, pl_ast_span(n)),
                           .span = pl_ast_span(n)};
    pl_push(w->arena, w->o->items, one);
    walk(w, n);
  }
}

static void statement(pl_outlining* w, const pl_ast* s);

static void block(pl_outlining* w, const pl_ast* s) {
  walk(w, pl_ast_kid(s, 1));
  bool outer = w->in_block;
  w->in_block = true;
  define_local(w, pl_ast_kid(s, 0), pl_ast_span(s));
  const pl_ast* lines = pl_ast_kid(s, 2);
  for (int i = 0; lines && i < lines->kids.n; i++) {
    if (lines->kids.at[i]->kind == PL_AST_STATEMENT) statement(w, lines->kids.at[i]);
  }
  w->locals.n--;
  w->in_block = outer;
}

// Children from `from` on that are places.
static void with_places(pl_outlining* w, const pl_ast* s, int label_at, int from) {
  any(w, pl_ast_kid(s, label_at));
  for (int i = label_at + 1; i < from; i++) walk(w, pl_ast_kid(s, i));
  for (int i = from; i < s->kids.n; i++) where(w, pl_ast_kid(s, i));
}

static void own_label(pl_outlining* w, const pl_ast* s, pl_space space) {
  if (pl_ast_kid(s, 0)) label(w, pl_ast_kid(s, 0), &space, 1);
  kids(w, s, 1);
}

static void statement(pl_outlining* w, const pl_ast* s) {
  w->statement = s;
  switch (s->token) {
    case TOK_PARAM:
    case TOK_COORD:
    case TOK_INPUT:
    case TOK_LET: declared_list(w, s); break;
    case TOK_FOR: block(w, s); break;
    case TOK_INIT:
    case TOK_GUESS: starts(w, s); break;
    case TOK_ASK: items(w, s); break;
    case TOK_MASS:
    case TOK_BODY: own_label(w, s, PL_SPACE_PLACE); break;
    case TOK_POINT:
      label(w, pl_ast_kid(s, 0), place_first, 1);
      walk(w, pl_ast_kid(s, 1));
      where(w, pl_ast_kid(s, 2));
      break;
    case TOK_ROD:
      if (pl_ast_kid(s, 0)) label(w, pl_ast_kid(s, 0), place_first, 1);
      walk(w, pl_ast_kid(s, 1));
      where(w, pl_ast_kid(s, 2));
      where(w, pl_ast_kid(s, 3));
      break;
    case TOK_FORCE:
    case TOK_TORQUE:
    case TOK_DRAG: with_places(w, s, 0, 2); break;
    case TOK_SPRING: with_places(w, s, 0, 3); break;
    case TOK_DAMPER: with_places(w, s, 0, 2); break;
    case TOK_CONSTRAINT: own_label(w, s, PL_SPACE_CONSTRAINT); break;
    case TOK_EVENT: own_label(w, s, PL_SPACE_EVENT); break;
    case TOK_FRICTION:
    case TOK_RESTITUTION:
      for (int i = 0; i + 1 < s->kids.n; i++) walk(w, pl_ast_kid(s, i));
      any(w, pl_ast_kid(s, s->kids.n - 1));
      break;
    case TOK_DRAW:
      walk(w, pl_ast_kid(s, 1));
      where(w, pl_ast_kid(s, 2));
      where(w, pl_ast_kid(s, 3));
      break;
    case TOK_POTENTIAL:
    case TOK_KINETIC: own_label(w, s, PL_SPACE_FORCE); break;
    case TOK_SYSTEM:
    case TOK_LANG:
    case TOK_CONVENTION:
    case TOK_PLEUEL: break;
    default: kids(w, s, 0);
  }
}

// --------------------------------------------------------------------------- broken statements
static bool has_use(const pl_outlining* w, const pl_parse* p, const pl_token* t) {
  for (int i = 0; i < w->o->uses.n; i++) {
    const pl_use* u = &w->o->uses.at[i];
    if (u->span.source == p->source && u->span.begin >= t->begin && u->span.end <= t->end)
      return true;
  }
  return false;
}

// Without a tree there is no scope: what is declared under this name is meant.
static void broken(pl_outlining* w, const pl_parse* p, const pl_parsed_statement* s) {
  static const pl_space order[] = {PL_SPACE_VALUE,      PL_SPACE_PLACE, PL_SPACE_CONSTRAINT,
                                   PL_SPACE_MULTIPLIER, PL_SPACE_EVENT, PL_SPACE_FORCE};
  for (int i = s->first + 1; i < s->end; i++) {
    const pl_token* t = &p->tokens->list.at[i];
    if (t->kind != TOK_NAME || (p->kinds[i] && p->kinds[i] != TOK_NAME) || has_use(w, p, t))
      continue;
    for (size_t k = 0; k < sizeof order / sizeof *order; k++) {
      int named = pl_outlining_find(w, order[k], t->key);
      if (named < 0) continue;
      pl_span span = {p->source, t->begin, t->end};
      const pl_span* at = &w->o->named.at[named].span;
      pl_outlining_use(w, span, named, t->number,
                       at->source == span.source && at->begin == span.begin);
      break;
    }
  }
}

void pl_outline_use_all(pl_outlining* w) {
  for (int i = 0; i < w->statements.n; i++) statement(w, w->statements.at[i]);
  for (int f = 0; f < w->o->files.n; f++) {
    const pl_parse* p = w->o->files.at[f];
    for (int i = 0; i < p->statements.n; i++) {
      if (p->statements.at[i].broken) broken(w, p, &p->statements.at[i]);
    }
  }
}
