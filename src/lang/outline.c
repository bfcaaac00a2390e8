// The outline of a text: its files are read as by the parser, nothing is lowered, nothing is
// reported.
#include "lang/outline_impl.h"

#include <stdlib.h>
#include <string.h>

#include "grammar.h"

// ---------------------------------------------------------------------------------------- names
pl_space pl_named_space(pl_named_kind kind) {
  switch (kind) {
    case PL_NAMED_CONSTRAINT: return PL_SPACE_CONSTRAINT;
    case PL_NAMED_MASS:
    case PL_NAMED_BODY:
    case PL_NAMED_POINT: return PL_SPACE_PLACE;
    case PL_NAMED_MULTIPLIER: return PL_SPACE_MULTIPLIER;
    case PL_NAMED_FORCE: return PL_SPACE_FORCE;
    case PL_NAMED_EVENT: return PL_SPACE_EVENT;
    case PL_NAMED_AXIS: return PL_SPACE_AXIS;
    case PL_NAMED_REQUEST: return PL_SPACE_REQUEST;
    default: return PL_SPACE_VALUE;
  }
}

int pl_outlining_find(const pl_outlining* w, pl_space space, const char* key) {
  return (int)pl_map_get(w->by_key[space], (uint64_t)(uintptr_t)key) - 1;
}

int pl_outlining_define(pl_outlining* w, pl_named named) {
  pl_space space = pl_named_space(named.kind);
  pl_push(w->arena, w->o->named, named);
  int i = w->o->named.n - 1;
  if (pl_outlining_find(w, space, named.key) < 0) {
    pl_map_set(w->by_key[space], (uint64_t)(uintptr_t)named.key, (uint64_t)i + 1);
  }
  return i;
}

void pl_outlining_use(pl_outlining* w, pl_span span, int named, int dots, bool defines) {
  bool dotted = false;
  for (uint32_t i = span.begin; i + 1 < span.end; i++) {
    // combining dots, and letters that have theirs: whatever is dotted without a prime or a suffix
    unsigned char a = (unsigned char)span.source->text[i];
    unsigned char b = (unsigned char)span.source->text[i + 1];
    dotted |= a == 0xcc && (b == 0x87 || b == 0x88);
  }
  pl_push(w->arena, w->o->uses, (pl_use){span, named, defines, dotted, dots});
}

// The multiplier that `with` named; λ alone is the one of the only constraint.
int pl_outlining_multiplier(const pl_outlining* w, const char* key) {
  int named = pl_outlining_find(w, PL_SPACE_MULTIPLIER, key);
  if (named >= 0 || strcmp(key, "lambda") != 0 || w->n_constraints != 1) return named;
  for (int i = 0; i < w->o->named.n; i++) {
    if (w->o->named.at[i].kind == PL_NAMED_MULTIPLIER) return i;
  }
  for (int i = 0; i < w->o->named.n; i++) {
    if (w->o->named.at[i].kind == PL_NAMED_CONSTRAINT) return i;
  }
  return -1;
}

// ---------------------------------------------------------------------------------------- files
static void read_file(pl_outlining* w, const pl_source* source);

static void read_included(pl_outlining* w, const pl_ast* s, const pl_source* from) {
  enum { MOST_OPEN = 16 };
  const pl_ast* path = pl_ast_kid(s, 0);
  const pl_source* file = NULL;
  if (w->reader && w->reader->read && path->text) {
    file = w->reader->read(w->reader->user, w->arena, path->text, from);
  }
  for (int i = 0; file && i < w->open.n; i++) {
    if (strcmp(w->open.at[i], file->name) == 0) return;
  }
  if (file && w->open.n < MOST_OPEN) read_file(w, file);
}

static void read_file(pl_outlining* w, const pl_source* source) {
  pl_push(w->arena, w->open, source->name);
  pl_parse* p = PL_NEW(w->arena, pl_parse);
  pl_parse_text(p, w->job, w->o->interned, source);
  pl_push(w->arena, w->o->files, p);
  for (int i = 0; p->root && i < p->root->kids.n; i++) {
    pl_ast* s = p->root->kids.at[i];
    if (s->kind != PL_AST_STATEMENT) continue;
    if (s->token == TOK_INCLUDE) read_included(w, s, source);
    else pl_push(w->arena, w->statements, s);
  }
  w->open.n--;
}

// ---------------------------------------------------------------------------------------- order
static int file_index(const pl_outline* o, const pl_source* source) {
  for (int i = 0; i < o->files.n; i++) {
    if (o->files.at[i]->source == source) return i;
  }
  return o->files.n;
}

static bool comes_before(const pl_outline* o, const pl_use* a, const pl_use* b) {
  if (a->span.source != b->span.source) {
    return file_index(o, a->span.source) < file_index(o, b->span.source);
  }
  return a->span.begin < b->span.begin;
}

// By place; what was met twice, as the body of a function, counts once.
static void sort_uses(pl_outline* o) {
  for (int gap = o->uses.n / 2; gap > 0; gap /= 2) {
    for (int i = gap; i < o->uses.n; i++) {
      pl_use u = o->uses.at[i];
      int k = i;
      for (; k >= gap && comes_before(o, &u, &o->uses.at[k - gap]); k -= gap) {
        o->uses.at[k] = o->uses.at[k - gap];
      }
      o->uses.at[k] = u;
    }
  }
  int kept = 0;
  for (int i = 0; i < o->uses.n; i++) {
    const pl_use *u = &o->uses.at[i], *last = kept ? &o->uses.at[kept - 1] : NULL;
    bool again = last && last->span.source == u->span.source && last->span.begin == u->span.begin;
    if (again) o->uses.at[kept - 1].defines |= u->defines;
    else o->uses.at[kept++] = *u;
  }
  o->uses.n = kept;
}

// ---------------------------------------------------------------------------------------- tokens
static pl_token_class class_of(const pl_parse* p, int i, bool begins) {
  const pl_token* t = &p->tokens->list.at[i];
  int kind = p->kinds[i] ? p->kinds[i] : t->kind;
  switch (t->kind) {
    case PL_TOKEN_COMMENT: return PL_CLASS_COMMENT;
    case PL_TOKEN_PRINTED: return PL_CLASS_PRINTED;
    case PL_TOKEN_WRONG: return PL_CLASS_WRONG;
    case TOK_NUMBER:
    case TOK_PI:
    case TOK_INFINITY: return PL_CLASS_NUMBER;
    case TOK_UNIT: return PL_CLASS_UNIT;
    case TOK_TEXT: return PL_CLASS_TEXT;
    case TOK_NAME: break;
    default: return PL_CLASS_SIGN;
  }
  if (kind == TOK_NAME) return pl_word_function(t->key) ? PL_CLASS_CALL : PL_CLASS_NAME;
  if (begins) return PL_CLASS_STATEMENT;
  return pl_word_of_item(kind) ? PL_CLASS_REQUEST : PL_CLASS_WORD;
}

static void classify(pl_outline* o) {
  const pl_parse* p = o->files.at[0];
  bool begins = true;
  for (int i = 0; i < p->tokens->list.n; i++) {
    const pl_token* t = &p->tokens->list.at[i];
    bool ends = t->kind == TOK_EOL || t->kind == '{' || t->kind == '}';
    if (t->kind == TOK_EOL || t->kind == 0) {
      begins = true;
      continue;
    }
    pl_classed c = {.span = {p->source, t->begin, t->end}, .use = -1, .token = p->kinds[i]};
    c.class = class_of(p, i, begins);
    if (c.class == PL_CLASS_NAME || c.class == PL_CLASS_CALL) {
      c.use = pl_outline_use_at(o, p->source, t->begin);
      // a use inside the name, rod in λ_rod
      if (c.use < 0) c.use = pl_outline_use_at(o, p->source, t->end);
      if (c.use >= 0) c.class = PL_CLASS_NAME;
    }
    if (t->end > t->begin) pl_push(o->arena, o->classed, c);
    if (t->kind > 0) begins = ends;
  }
}

// ---------------------------------------------------------------------------------------- whole
pl_outline* pl_outline_make(pl_arena* a, const pl_source* source, const pl_include_reader* reader) {
  pl_outline* o = PL_NEW(a, pl_outline);
  o->arena = a;
  o->interned = pl_names_make(a);
  pl_diagnostics* unheard = PL_NEW(a, pl_diagnostics);
  unheard->arena = a;
  pl_job* job = PL_NEW(a, pl_job);
  *job = (pl_job){.arena = a, .diagnostics = unheard};
  pl_outlining* w = PL_NEW(a, pl_outlining);
  *w = (pl_outlining){.o = o, .arena = a, .job = job, .reader = reader};
  for (int i = 0; i < PL_N_SPACES; i++) w->by_key[i] = pl_map_make(a);
  read_file(w, source);
  pl_outline_define_all(w);
  pl_outline_use_all(w);
  sort_uses(o);
  classify(o);
  return o;
}

// ----------------------------------------------------------------------------------- questions
int pl_outline_use_at(const pl_outline* o, const pl_source* source, size_t at) {
  for (int i = 0; i < o->uses.n; i++) {
    const pl_use* u = &o->uses.at[i];
    if (u->span.source != source || at < u->span.begin || at > u->span.end) continue;
    // between two names the one that begins here
    const pl_use* next = i + 1 < o->uses.n ? &o->uses.at[i + 1] : NULL;
    if (at == u->span.end && next && next->span.source == source && next->span.begin == at)
      continue;
    return i;
  }
  return -1;
}

int pl_outline_find(const pl_outline* o, const char* spelling) {
  pl_spelled s;
  size_t bad;
  if (!pl_spell(o->arena, o->interned, spelling, strlen(spelling), &s, &bad)) return -1;
  for (int i = 0; i < o->named.n; i++) {
    const pl_named* n = &o->named.at[i];
    if (n->key == s.key && n->kind != PL_NAMED_INDEX && !n->unlabelled) return i;
  }
  return -1;
}

const char* pl_spelled_key(pl_arena* a, const char* spelling) {
  pl_spelled s;
  size_t bad;
  bool fine = pl_spell(a, pl_names_make(a), spelling, strlen(spelling), &s, &bad);
  return fine && s.dots == 0 ? s.key : NULL;
}

const char* pl_spell_shown(pl_arena* a, const char* ascii) { return pl_spell_unicode(a, ascii); }

bool pl_spelled_same(pl_arena* a, const char* s, const char* t) {
  pl_names* names = pl_names_make(a);
  pl_spelled u, v;
  size_t bad;
  bool fine = pl_spell(a, names, s, strlen(s), &u, &bad)
              && pl_spell(a, names, t, strlen(t), &v, &bad);
  return fine && u.key == v.key && u.dots == v.dots;
}

bool pl_outline_name_is_free(const pl_outline* o, const char* spelling, const char* why[2]) {
  pl_spelled s;
  size_t bad, n = strlen(spelling);
  bool starts = n > 0 && !(spelling[0] >= '0' && spelling[0] <= '9') && spelling[0] != '_';
  why[PL_ENGLISH] = "this is no name: letters, then letters, digits and _";
  why[PL_GERMAN] = pl_german("this is no name: letters, then letters, digits and _");
  if (!starts || strpbrk(spelling, " \t\n\r#\"'()[]{}+-*/^=<>,;:.!")) return false;
  if (!pl_spell(o->arena, o->interned, spelling, n, &s, &bad) || s.dots) return false;
  why[PL_ENGLISH] = "this is a word of the language";
  why[PL_GERMAN] = pl_german("this is a word of the language");
  if (pl_word_reserved(s.key) || pl_word_function(s.key) || strcmp(s.key, "t") == 0) return false;
  if (strcmp(s.key, "pi") == 0) return false;
  why[PL_ENGLISH] = "another thing has this name";
  why[PL_GERMAN] = pl_german("another thing has this name");
  for (int i = 0; i < o->named.n; i++) {
    if (o->named.at[i].key == s.key) return false;
  }
  return true;
}

const char* pl_outline_help_at(const pl_outline* o, size_t at, pl_language lang, pl_span* span) {
  for (int i = 0; i < o->classed.n; i++) {
    const pl_classed* c = &o->classed.at[i];
    if (at < c->span.begin || at >= c->span.end) continue;
    const char* word = pl_copy_n(o->arena, c->span.source->text + c->span.begin,
                                 c->span.end - c->span.begin);
    const pl_word_help* help = NULL;
    if (c->class == PL_CLASS_STATEMENT) help = pl_help_statement(word);
    if (c->class == PL_CLASS_REQUEST) help = pl_help_request(word);
    if (c->class == PL_CLASS_CALL) help = pl_help_function(word);
    if (!help) return NULL;
    *span = c->span;
    return pl_format(o->arena, "%s\n%s", help->form, help->words[lang == PL_GERMAN]);
  }
  return NULL;
}
