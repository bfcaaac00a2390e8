// The names that statements declare, as far as the syntax tells.  Statements with a syntax error
// have no tree: what they would have declared is read off their tokens, so that the rest of the
// text is not full of unknown names.
#include "lang/outline_impl.h"

#include <string.h>

#include "grammar.h"

// -------------------------------------------------------------------------------------- pieces
static const pl_parse* file_of(const pl_outlining* w, const pl_source* source) {
  for (int i = 0; i < w->o->files.n; i++) {
    if (w->o->files.at[i]->source == source) return w->o->files.at[i];
  }
  return NULL;
}

// The comment at the end of the line on which a place ends.
static const char* comment_behind(const pl_outlining* w, pl_span at) {
  const pl_parse* p = file_of(w, at.source);
  for (int i = 0; p && i < p->tokens->list.n; i++) {
    const pl_token* t = &p->tokens->list.at[i];
    if (t->begin < at.end) continue;
    if (t->kind == TOK_EOL || t->kind == 0) return NULL;
    if (t->kind != PL_TOKEN_COMMENT) continue;
    const char* text = t->text;
    while (*text == ' ' || *text == '\t') text++;
    return *text ? text : NULL;
  }
  return NULL;
}

static pl_named named_at(const pl_outlining* w, pl_named_kind kind, const pl_ast* name,
                         pl_span definition) {
  pl_span span = pl_ast_span(name);
  return (pl_named){.kind = kind,
                    .key = name->key,
                    .shown = name->shown,
                    .span = span,
                    .definition = definition,
                    .comment = comment_behind(w, span)};
}

static int define(pl_outlining* w, pl_named_kind kind, const pl_ast* name, pl_span definition) {
  return pl_outlining_define(w, named_at(w, kind, name, definition));
}

// A label: name, and index where it belongs to a family.
static void define_label(pl_outlining* w, pl_named_kind kind, const pl_ast* label,
                         const pl_ast* s) {
  if (!label) return;
  pl_named named = named_at(w, kind, pl_ast_kid(label, 0), pl_ast_span(s));
  named.family = pl_ast_kid(label, 1) != NULL || w->in_block;
  pl_outlining_define(w, named);
}

// -------------------------------------------------------------------------------- declarations
static void define_list(pl_outlining* w, pl_named_kind kind, const pl_ast* s) {
  const pl_ast* list = pl_ast_kid(s, 0);
  for (int i = 0; i < list->kids.n; i++) {
    const pl_ast *d = list->kids.at[i], *name = pl_ast_kid(d, 0), *unit = pl_ast_kid(d, 3);
    bool indexed = name->kind == PL_AST_INDEXED;
    pl_named named = named_at(w, kind, indexed ? pl_ast_kid(name, 0) : name, pl_ast_span(d));
    named.family = indexed && pl_ast_kid(name, 1)->kind == PL_AST_RANGE;
    if (kind == PL_NAMED_ABBREVIATION && pl_ast_kid(d, 1)) named.kind = PL_NAMED_FUNCTION;
    if (unit) named.unit = unit->text;
    else if (indexed && !named.family)
      named.unit = pl_source_text(w->arena, pl_ast_span(pl_ast_kid(name, 1)));
    pl_outlining_define(w, named);
  }
}

// A mass without label bears the name of its mass.
static void define_mass(pl_outlining* w, const pl_ast* s) {
  const pl_ast *label = pl_ast_kid(s, 0), *mass = pl_ast_kid(s, 1);
  if (label) {
    define_label(w, PL_NAMED_MASS, label, s);
    return;
  }
  while (mass && (mass->kind == PL_AST_PRODUCT || mass->kind == PL_AST_SUM) && mass->kids.n == 1) {
    mass = mass->kids.at[0];
  }
  if (!mass || mass->kind != PL_AST_NAME || mass->number) return;
  pl_named named = named_at(w, PL_NAMED_MASS, mass, pl_ast_span(s));
  named.unlabelled = true;
  pl_outlining_define(w, named);
}

static void define_constraint(pl_outlining* w, const pl_ast* s) {
  const pl_ast *label = pl_ast_kid(s, 0), *options = pl_ast_kid(s, 2), *with = NULL;
  const char* number = pl_intern(w->o->interned, pl_format(w->arena, "%d", ++w->n_constraints));
  define_label(w, PL_NAMED_CONSTRAINT, label, s);
  for (int i = 0; options && i < options->kids.n; i++) {
    if (strcmp(options->kids.at[i]->text, "with") == 0) with = pl_ast_kid(options->kids.at[i], 0);
  }
  if (!with) return;
  pl_named named = named_at(w, PL_NAMED_MULTIPLIER, with, pl_ast_span(s));
  named.label = label ? pl_ast_kid(label, 0)->key : number;
  named.family = (label && pl_ast_kid(label, 1)) || w->in_block;
  pl_outlining_define(w, named);
}

static void define_axes(pl_outlining* w, const pl_ast* s) {
  const pl_ast* list = pl_ast_kid(s, 0);
  for (int i = 0; i < list->kids.n; i++) {
    define(w, PL_NAMED_AXIS, pl_ast_kid(list->kids.at[i], 0), pl_ast_span(list->kids.at[i]));
  }
}

// `choose φ with ...` declares φ where nothing else does.
static void define_chosen(pl_outlining* w, const pl_ast* s) {
  const pl_ast* names = pl_ast_kid(s, 0);
  for (int i = 0; pl_ast_kid(s, 1) && i < names->kids.n; i++) {
    const pl_ast* name = names->kids.at[i];
    while (name && (name->kind == PL_AST_PRODUCT || name->kind == PL_AST_SUM)
           && name->kids.n == 1) {
      name = name->kids.at[0];
    }
    if (!name || name->kind != PL_AST_NAME || name->number) continue;
    if (pl_outlining_find(w, PL_SPACE_VALUE, name->key) >= 0) continue;
    define(w, PL_NAMED_COORDINATE, name, pl_ast_span(s));
  }
}

static void define_statement(pl_outlining* w, const pl_ast* s) {
  const pl_ast* first = pl_ast_kid(s, 0);
  switch (s->token) {
    case TOK_PARAM: define_list(w, PL_NAMED_PARAMETER, s); break;
    case TOK_COORD: define_list(w, PL_NAMED_COORDINATE, s); break;
    case TOK_INPUT: define_list(w, PL_NAMED_INPUT, s); break;
    case TOK_LET: define_list(w, PL_NAMED_ABBREVIATION, s); break;
    case TOK_OUTPUT: define(w, PL_NAMED_OUTPUT, first, pl_ast_span(s)); break;
    case TOK_MASS: define_mass(w, s); break;
    case TOK_BODY:
    case TOK_ROD: define_label(w, PL_NAMED_BODY, first, s); break;
    case TOK_POINT: define_label(w, PL_NAMED_POINT, first, s); break;
    case TOK_FORCE:
    case TOK_TORQUE:
    case TOK_POTENTIAL:
    case TOK_KINETIC:
    case TOK_SPRING:
    case TOK_DAMPER:
    case TOK_DRAG: define_label(w, PL_NAMED_FORCE, first, s); break;
    case TOK_CONSTRAINT: define_constraint(w, s); break;
    case TOK_EVENT: define_label(w, PL_NAMED_EVENT, first, s); break;
    case TOK_AXES: define_axes(w, s); break;
    case TOK_ASK:
      if (first) define(w, PL_NAMED_REQUEST, first, pl_ast_span(s));
      break;
    default: break;
  }
}

static void define_in(pl_outlining* w, const pl_ast* s) {
  if (s->kind != PL_AST_STATEMENT) return;
  if (s->token != TOK_FOR) {
    define_statement(w, s);
    return;
  }
  bool outer = w->in_block;
  w->in_block = true;
  const pl_ast* lines = pl_ast_kid(s, 2);
  for (int i = 0; lines && i < lines->kids.n; i++) define_in(w, lines->kids.at[i]);
  w->in_block = outer;
}

// --------------------------------------------------------------------------- broken statements
static bool declares_list(int keyword, pl_named_kind* kind) {
  switch (keyword) {
    case TOK_PARAM: *kind = PL_NAMED_PARAMETER; return true;
    case TOK_COORD: *kind = PL_NAMED_COORDINATE; return true;
    case TOK_INPUT: *kind = PL_NAMED_INPUT; return true;
    case TOK_LET: *kind = PL_NAMED_ABBREVIATION; return true;
    case TOK_OUTPUT: *kind = PL_NAMED_OUTPUT; return true;
    default: return false;
  }
}

static bool declares_label(int keyword, pl_named_kind* kind) {
  switch (keyword) {
    case TOK_MASS: *kind = PL_NAMED_MASS; return true;
    case TOK_BODY:
    case TOK_ROD: *kind = PL_NAMED_BODY; return true;
    case TOK_POINT: *kind = PL_NAMED_POINT; return true;
    case TOK_FORCE:
    case TOK_TORQUE:
    case TOK_POTENTIAL:
    case TOK_KINETIC:
    case TOK_SPRING:
    case TOK_DAMPER:
    case TOK_DRAG: *kind = PL_NAMED_FORCE; return true;
    case TOK_CONSTRAINT: *kind = PL_NAMED_CONSTRAINT; return true;
    case TOK_EVENT: *kind = PL_NAMED_EVENT; return true;
    default: return false;
  }
}

static void define_token(pl_outlining* w, const pl_parse* p, const pl_token* t,
                         pl_named_kind kind) {
  pl_span span = {p->source, t->begin, t->end};
  if (pl_outlining_find(w, pl_named_space(kind), t->key) >= 0) return;
  pl_named named = {
      .kind = kind, .key = t->key, .shown = t->shown, .span = span, .definition = span};
  named.comment = comment_behind(w, span);
  pl_outlining_define(w, named);
}

static void define_broken(pl_outlining* w, const pl_parse* p, const pl_parsed_statement* s) {
  pl_named_kind kind;
  bool list = declares_list(s->keyword, &kind), label = !list && declares_label(s->keyword, &kind);
  int depth = 0, before = s->keyword;
  for (int i = s->first + 1; i < s->end && (list || label); i++) {
    const pl_token* t = &p->tokens->list.at[i];
    if (t->kind < 0) continue;
    depth += t->kind == '(' || t->kind == '[' ? 1 : t->kind == ')' || t->kind == ']' ? -1 : 0;
    bool at_start = i == s->first + 1 || (before == ',' && depth == 0);
    bool is_name = t->kind == TOK_NAME && t->number == 0 && !pl_word_reserved(t->key);
    int next = p->tokens->list.at[i + 1].kind;
    bool ends = next == '=' || next == ',' || next == TOK_UNIT || next == TOK_EOL || next == '('
                || next == 0;
    if (list && at_start && is_name && ends) define_token(w, p, t, kind);
    if (label && i == s->first + 1 && is_name && (next == ':' || kind == PL_NAMED_POINT))
      define_token(w, p, t, kind);
    if (before == TOK_WITH && is_name && s->keyword == TOK_CONSTRAINT)
      define_token(w, p, t, PL_NAMED_MULTIPLIER);
    before = p->kinds[i]                                          ? p->kinds[i]
             : t->kind == TOK_NAME && strcmp(t->key, "with") == 0 ? TOK_WITH
                                                                  : t->kind;
  }
}

void pl_outline_define_all(pl_outlining* w) {
  for (int i = 0; i < w->statements.n; i++) define_in(w, w->statements.at[i]);
  for (int i = 0; i < w->statements.n; i++) {
    if (w->statements.at[i]->token == TOK_CHOOSE) define_chosen(w, w->statements.at[i]);
  }
  for (int f = 0; f < w->o->files.n; f++) {
    const pl_parse* p = w->o->files.at[f];
    for (int i = 0; i < p->statements.n; i++) {
      if (p->statements.at[i].broken) define_broken(w, p, &p->statements.at[i]);
    }
  }
}
