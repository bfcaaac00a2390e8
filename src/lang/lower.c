// Lowering: the steps from a text to a model, and the public calls.
//
//   parse (and what is included) -> names -> values of parameters, bounds, abbreviations ->
//   everything else
//
// A statement with a syntax error takes part silently, so that the names it declares are known.
#include "lang/lower_impl.h"

#include <string.h>

#include "grammar.h"

pl_lower* pl_lower_make(pl_job* job, pl_model* m, pl_names* names) {
  pl_lower* l = PL_NEW(job->arena, pl_lower);
  l->job = job;
  l->arena = pl_pool_arena(m->pool);
  l->pool = m->pool;
  l->m = m;
  l->names = names;
  l->by_key = pl_map_make(job->arena);
  return l;
}

// ------------------------------------------------------------------------------------------- files
typedef struct reading {
  pl_job* job;
  pl_names* names;
  const pl_include_reader* reader;
  pl_lower* l;
  PL_VEC(const char*) open;  // names of the files being read, against circles
  PL_VEC(pl_ast*) statements;
  bool theta, vartheta;
  pl_span theta_at, vartheta_at;
} reading;

static void read_file(reading* r, const pl_source* source);

static void keep_comments(reading* r, const pl_tokens* tokens) {
  for (int i = 0; i < tokens->list.n; i++) {
    const pl_token* t = &tokens->list.at[i];
    if (t->kind != PL_TOKEN_PRINTED) continue;
    const char* text = t->text;
    while (*text == ' ' || *text == '\t') text++;
    pl_push(r->l->arena, r->l->m->comments, pl_copy(r->l->arena, text));
  }
}

static bool contains(const char* s, size_t n, const char* letter) {
  size_t m = strlen(letter);
  for (size_t i = 0; i + m <= n; i++) {
    if (memcmp(s + i, letter, m) == 0) return true;
  }
  return false;
}

// θ and ϑ are one name in ASCII: a file that uses both means two things by it, or does not notice.
static void look_for_theta(reading* r, const pl_tokens* tokens) {
  for (int i = 0; i < tokens->list.n; i++) {
    const pl_token* t = &tokens->list.at[i];
    if (t->kind != TOK_NAME) continue;
    const char* s = tokens->source->text + t->begin;
    pl_span span = {tokens->source, t->begin, t->end};
    if (!r->theta && contains(s, t->end - t->begin, "θ")) {
      r->theta = true;
      r->theta_at = span;
    }
    if (!r->vartheta && contains(s, t->end - t->begin, "ϑ")) {
      r->vartheta = true;
      r->vartheta_at = span;
    }
  }
}

static void complain_theta(reading* r) {
  if (!r->theta || !r->vartheta) return;
  pl_diagnostic* m = pl_complain(r->job, PL_E059, r->vartheta_at,
                                 PL_BOTH("θ and ϑ are two letters, and both are theta in ASCII"));
  pl_report_label(r->job->diagnostics, m, r->theta_at, "θ");
  pl_suggest(r->job, m, NULL, PL_BOTH("use one of them throughout"));
}

static void cannot_include(reading* r, const pl_ast* s, const char* en, const char* de) {
  pl_diagnostic* m = pl_complain(r->job, PL_E010, pl_ast_span(pl_ast_kid(s, 0)), en, de,
                                 pl_ast_kid(s, 0)->text);
  pl_suggest(r->job, m, NULL, PL_BOTH("check the path, which counts from the including file"));
}

static void include(reading* r, const pl_ast* s, const pl_source* from) {
  enum { MAX_OPEN = 16 };
  const pl_source* file = NULL;
  if (r->reader && r->reader->read)
    file = r->reader->read(r->reader->user, r->job->arena, pl_ast_kid(s, 0)->text, from);
  if (file == NULL) {
    cannot_include(r, s, PL_BOTH("%s cannot be read"));
    return;
  }
  for (int i = 0; i < r->open.n; i++) {
    if (strcmp(r->open.at[i], file->name) != 0) continue;
    cannot_include(r, s, PL_BOTH("%s includes itself"));
    return;
  }
  if (r->open.n >= MAX_OPEN) cannot_include(r, s, PL_BOTH("%s is included too deeply"));
  else read_file(r, file);
}

static void read_file(reading* r, const pl_source* source) {
  pl_push(r->job->arena, r->open, source->name);
  pl_parse* p = PL_NEW(r->job->arena, pl_parse);
  pl_parse_text(p, r->job, r->names, source);
  keep_comments(r, p->tokens);
  look_for_theta(r, p->tokens);
  for (int i = 0; i < p->lost.n; i++) pl_push(r->job->arena, r->l->lost, p->lost.at[i]);
  for (int i = 0; p->root && i < p->root->kids.n; i++) {
    pl_ast* s = p->root->kids.at[i];
    if (s->kind != PL_AST_STATEMENT) continue;
    if (s->token == TOK_INCLUDE) include(r, s, source);
    else pl_push(r->job->arena, r->statements, s);
  }
  r->open.n--;
}

// ----------------------------------------------------------------------------- names inside blocks
static void declare_rule(pl_lower* l, const pl_ast* s) {
  const pl_ast *label = pl_ast_kid(s, 0), *options = pl_ast_kid(s, 2);
  pl_rule r = {.generated = label == NULL};
  const char* number = pl_format(l->arena, "%d", ++l->n_rules_declared);
  r.key = label ? pl_ast_kid(label, 0)->key : pl_intern(l->names, number);
  r.shown = label ? pl_ast_kid(label, 0)->shown : number;
  r.family = (label && pl_ast_kid(label, 1)) || l->block;
  pl_rule* same = pl_scope_rule(l, r.key);
  const pl_ast* with = NULL;
  for (int i = 0; i < options->kids.n; i++) {
    if (strcmp(options->kids.at[i]->text, "with") == 0) with = pl_ast_kid(options->kids.at[i], 0);
  }
  if (with) {
    const pl_entity* taken = pl_scope_find(l, with->key);
    bool twice = false;
    for (int i = 0; i < l->rules.n; i++)
      twice |= l->rules.at[i].with == with->key && &l->rules.at[i] != same;
    if (taken || twice) {
      pl_diagnostic* m = pl_lower_complain(l, PL_E012, pl_ast_span(with),
                                           PL_BOTH("%s is declared twice"), with->shown);
      if (taken && !l->mute)
        pl_report_label(l->job->diagnostics, m, taken->span,
                        l->job->lang == PL_GERMAN ? pl_german("first here") : "first here");
      pl_suggest(l->job, m, NULL, PL_BOTH("choose another name, such as %s1"), with->shown);
      with = NULL;
    }
  }
  if (with) {
    r.with = with->key;
    r.with_shown = with->shown;
  }
  pl_symbol_info info = {.name = with ? with->shown : pl_format(l->arena, "λ_%s", r.shown),
                         .ascii = pl_format(l->arena, "lambda_%s", r.key),
                         .role = PL_R_MULTIPLIER,
                         .class = PL_C_MULTIPLIER,
                         .dimension = pl_dimension_one()};
  r.lambda = same ? same->lambda : pl_symbol_make(l->pool, &info);
  if (!same) pl_push(l->arena, l->rules, r);
  else same->family |= r.family;
}

static pl_block* make_block(pl_lower* l, const pl_ast* s) {
  const pl_ast *name = pl_ast_kid(s, 0), *range = pl_ast_kid(s, 1);
  pl_block* b = PL_NEW(l->arena, pl_block);
  b->outer = l->block;
  b->span = pl_span_join(pl_ast_span(name), pl_ast_span(range));
  pl_entity* e = pl_scope_find(l, name->key);
  if (e || pl_scope_local(l, name->key) || strcmp(name->key, "t") == 0) {
    pl_diagnostic* m = pl_lower_complain(l, PL_E012, pl_ast_span(name),
                                         PL_BOTH("%s is declared twice"), name->shown);
    pl_because(l->job, m, PL_BOTH("an index needs a name of its own"));
    if (e && !l->mute)
      pl_report_label(l->job->diagnostics, m, e->span,
                      l->job->lang == PL_GERMAN ? pl_german("first here") : "first here");
    pl_suggest(l->job, m, NULL, PL_BOTH("choose another index"));
  }
  pl_symbol old = pl_symbol_find(l->pool, name->key);
  bool reuse = old.id && pl_symbol_get(l->pool, old)->role == PL_R_INDEX;
  b->index = reuse ? old : pl_scope_symbol(l, name, PL_R_INDEX);
  b->lo = pl_lower_scalar(l, pl_ast_kid(range, 0));
  b->hi = pl_lower_scalar(l, pl_ast_kid(range, 1));
  b->step = pl_ast_kid(range, 2) ? pl_lower_scalar(l, pl_ast_kid(range, 2)) : pl_poison();
  if (pl_ast_kid(range, 3)) {
    pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(pl_ast_kid(range, 3)),
                                         PL_BOTH("an index runs in steps, not by a count"));
    pl_suggest(l->job, m, NULL, PL_BOTH("write  for i in 1..N"));
  }
  pl_push(l->arena, l->m->blocks, b);
  return b;
}

static bool may_stand_in_block(int token) {
  switch (token) {
    case TOK_MASS:
    case TOK_BODY:
    case TOK_POINT:
    case TOK_ROD:
    case TOK_FORCE:
    case TOK_TORQUE:
    case TOK_POTENTIAL:
    case TOK_KINETIC:
    case TOK_RAYLEIGH:
    case TOK_SPRING:
    case TOK_DAMPER:
    case TOK_DRAG:
    case TOK_CONSTRAINT:
    case TOK_INIT:
    case TOK_GUESS:
    case TOK_FRICTION:
    case TOK_RESTITUTION:
    case TOK_FOR: return true;
    default: return false;
  }
}

// One walk over the statements that may stand in blocks; enter and leave keep block and locals.
typedef void visit_statement(pl_lower* l, const pl_ast* s);

typedef struct walk {
  visit_statement* visit;
  pl_map* blocks;  // node of for -> pl_block
  bool first;
} walk;

static void walk_statement(pl_lower* l, walk* w, const pl_ast* s);

static void walk_block(pl_lower* l, walk* w, const pl_ast* s) {
  uint64_t key = (uint64_t)(uintptr_t)s;
  if (w->first) pl_map_set(w->blocks, key, (uint64_t)(uintptr_t)make_block(l, s));
  pl_block* b = (pl_block*)(uintptr_t)pl_map_get(w->blocks, key);
  pl_block* outer = l->block;
  l->block = b;
  pl_push(l->arena, l->locals, (pl_local){.key = pl_ast_kid(s, 0)->key, .symbol = b->index});
  const pl_ast* lines = pl_ast_kid(s, 2);
  for (int i = 0; i < lines->kids.n; i++) {
    const pl_ast* inner = lines->kids.at[i];
    if (inner->kind != PL_AST_STATEMENT) continue;
    if (may_stand_in_block(inner->token)) {
      walk_statement(l, w, inner);
    } else if (w->first && !inner->broken) {
      const char* word = pl_word_of_statement(inner->token);
      pl_diagnostic* m = pl_lower_complain(l, PL_E027, pl_ast_span(inner),
                                           PL_BOTH("%s does not belong inside for"),
                                           word ? word : "this");
      pl_suggest(l->job, m, NULL, PL_BOTH("move the line out of the block"));
    }
  }
  l->locals.n--;
  l->block = outer;
}

static void walk_statement(pl_lower* l, walk* w, const pl_ast* s) {
  if (s->token == TOK_FOR) walk_block(l, w, s);
  else w->visit(l, s);
}

static void visit_names(pl_lower* l, const pl_ast* s) {
  l->mute += s->broken;
  if (s->token == TOK_MASS || s->token == TOK_BODY || s->token == TOK_POINT) pl_site_declare(l, s);
  if (s->token == TOK_CONSTRAINT) declare_rule(l, s);
  if (s->token == TOK_BODY) pl_space_declare(l, s);
  l->mute -= s->broken;
}

static void visit_values(pl_lower* l, const pl_ast* s) {
  if (s->token == TOK_INIT || s->token == TOK_GUESS) {
    l->mute += s->broken;
    pl_lower_start(l, s);
    l->mute -= s->broken;
  } else {
    pl_lower_physics(l, s);
  }
}

// ------------------------------------------------------------------------------- requests in order
static void lower_rest(pl_lower* l, walk* w, const pl_ast* s) {
  switch (s->token) {
    case TOK_PARAM:
    case TOK_COORD:
    case TOK_LET:
    case TOK_PLEUEL:
    case TOK_SYSTEM:
    case TOK_LANG:
    case TOK_AXES:
    case TOK_CONVENTION: break;  // done
    case TOK_ASSUME:
    case TOK_INPUT:
    case TOK_OUTPUT: pl_lower_statement(l, s); break;
    case TOK_ASK: pl_lower_ask(l, s); break;
    case TOK_EVENT: pl_lower_event(l, s); break;
    case TOK_SIMULATE:
    case TOK_PLOT:
    case TOK_ANIMATE:
    case TOK_DRAW:
    case TOK_SWEEP:
    case TOK_POINCARE: pl_lower_display(l, s); break;
    default: walk_statement(l, w, s);
  }
}

static bool in_second_round(int token) {
  return token == TOK_ASK || token == TOK_EVENT || token == TOK_PLOT || token == TOK_ANIMATE
         || token == TOK_DRAW || token == TOK_SWEEP || token == TOK_POINCARE || token == TOK_OUTPUT
         || token == TOK_SIMULATE;
}

// ------------------------------------------------------------------------------------------- --set
static const pl_ast* parse_piece(pl_lower* l, const char* title, const char* text) {
  pl_source* source = pl_source_make(l->arena, title, pl_copy(l->arena, text), strlen(text));
  pl_parse* p = PL_NEW(l->arena, pl_parse);
  return pl_parse_expression(p, l->job, l->names, source);
}

static void parse_settings(pl_lower* l, const pl_setting* set, int n) {
  for (int i = 0; i < n; i++) {
    const char* title = pl_format(l->arena, "--set %s", set[i].name);
    pl_setting_node node = {.name = pl_ast_single(parse_piece(l, title, set[i].name)),
                            .value = parse_piece(l, title, set[i].value)};
    if (node.name && node.value) pl_push(l->arena, l->settings, node);
  }
}

// Parameters and abbreviations get their new value before anything is lowered, so that families
// follow.
static void set_names(pl_lower* l) {
  for (int i = 0; i < l->settings.n; i++) {
    pl_setting_node* s = &l->settings.at[i];
    pl_entity* e = s->name->kind == PL_AST_NAME && !s->name->number ? pl_scope_find(l, s->name->key)
                                                                    : NULL;
    s->done = e && (e->kind == PL_ENTITY_PARAM || e->kind == PL_ENTITY_LET);
    if (s->done) e->override = s->value;
  }
}

// Start values, after the file's own: x1=0, x1'=0, x1_dot=0.
static void set_start(pl_lower* l, const pl_setting_node* s) {
  pl_expr target = pl_lower_scalar(l, s->name), value = pl_lower_scalar(l, s->value);
  if (pl_is_poison(target) || pl_is_poison(value)) return;
  bool symbol = pl_kind_of(l->pool, target) == PL_SYMBOL;
  pl_role role = symbol ? pl_symbol_get(l->pool, pl_symbol_of(l->pool, target))->role : PL_R_PARAM;
  if (role != PL_R_COORD && role != PL_R_VELOCITY) {
    pl_diagnostic* m = pl_lower_complain(
        l, PL_E030, pl_ast_span(s->name),
        PL_BOTH("only parameters, abbreviations and start values can be set"));
    pl_suggest(l->job, m, NULL, PL_BOTH("write --set m=2 or --set x=1"));
    return;
  }
  for (int i = 0; i < l->m->inits.n; i++) {
    if (!pl_same(l->m->inits.at[i].target, target) || l->m->inits.at[i].guess) continue;
    l->m->inits.at[i].value = value;
    return;
  }
  pl_push(l->arena, l->m->inits,
          (pl_init){.target = target, .value = value, .span = pl_ast_span(s->value)});
}

// -------------------------------------------------------------------------------------- the passes
// Declarations inside blocks are refused, but what they name is known, so that it is not missed.
static void declare_inside(pl_lower* l, const pl_ast* s) {
  if (s->token != TOK_FOR) {
    pl_lower_declare(l, s);
    return;
  }
  const pl_ast* lines = pl_ast_kid(s, 2);
  for (int i = 0; i < lines->kids.n; i++) {
    int token = lines->kids.at[i]->kind == PL_AST_STATEMENT ? lines->kids.at[i]->token : 0;
    if (token == TOK_FOR || token == TOK_PARAM || token == TOK_COORD || token == TOK_LET)
      declare_inside(l, lines->kids.at[i]);
  }
}

static void lower_all(pl_lower* l, pl_ast** s, int n) {
  walk w = {.blocks = pl_map_make(l->arena), .first = true};
  pl_ast file = {.kind = PL_AST_FILE};
  file.kids.at = s;
  file.kids.n = n;
  // headers and names
  for (int i = 0; i < n; i++) declare_inside(l, s[i]);
  for (int i = 0; i < n; i++) {
    if (s[i]->token == TOK_CHOOSE) pl_lower_declare_chosen(l, s[i]);
  }
  set_names(l);
  pl_axes_settle(l, &file);
  // parameters first: they size families; then coordinates, then what is abbreviated
  static const int order[] = {TOK_PARAM, TOK_COORD, TOK_LET};
  w.visit = visit_names;
  for (int k = 0; k < 2; k++) {
    for (int i = 0; i < n; i++) {
      if (s[i]->token == order[k]) pl_lower_statement(l, s[i]);
    }
  }
  for (int i = 0; i < n; i++) {
    if (s[i]->token == TOK_CHOOSE) pl_lower_chosen(l, s[i]);
  }
  for (int i = 0; i < n; i++) {
    if (s[i]->token == TOK_FOR || may_stand_in_block(s[i]->token)) walk_statement(l, &w, s[i]);
  }
  for (int i = 0; i < n; i++) {
    if (s[i]->token == TOK_LET) pl_lower_statement(l, s[i]);
  }
  // the physics, then what is asked about it; outputs first, whose names can be asked for
  w.first = false;
  w.visit = visit_values;
  for (int i = 0; i < n; i++) {
    if (!in_second_round(s[i]->token)) lower_rest(l, &w, s[i]);
  }
  for (int i = 0; i < n; i++) {
    if (s[i]->token == TOK_OUTPUT) lower_rest(l, &w, s[i]);
  }
  for (int i = 0; i < n; i++) {
    if (in_second_round(s[i]->token) && s[i]->token != TOK_OUTPUT) lower_rest(l, &w, s[i]);
  }
  pl_axes_trim(l, &file);
  for (int i = 0; i < l->settings.n; i++) {
    if (!l->settings.at[i].done) set_start(l, &l->settings.at[i]);
  }
}

// ------------------------------------------------------------------------------------------ public
pleuel_status pl_lang_parse(pl_job* job, const pl_source* source, const pl_include_reader* reader,
                            const pl_setting* set, int n_set, pl_model** out) {
  int before = job->diagnostics->n_errors;
  pl_model* m = pl_model_make(job->arena);
  *out = m;
  m->source = source;
  pl_names* names = pl_names_make(job->arena);
  pl_lower* l = pl_lower_make(job, m, names);
  reading* r = PL_NEW(job->arena, reading);
  *r = (reading){.job = job, .names = names, .reader = reader, .l = l};
  read_file(r, source);
  complain_theta(r);
  parse_settings(l, set, n_set);
  lower_all(l, r->statements.at, r->statements.n);
  return job->diagnostics->n_errors > before ? PLEUEL_MODEL_ERROR : PLEUEL_OK;
}
