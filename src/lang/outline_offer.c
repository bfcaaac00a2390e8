// Completion: the text up to the place is given to the parser, which tells what tokens fit there;
// those become words, and where a name fits, the names that can be meant.  What stands behind the
// place plays no part, so a line that is still being written completes like a whole one.
#include "lang/outline_impl.h"

#include <ctype.h>
#include <string.h>

#include "grammar.h"

typedef struct pl_offering {
  pl_arena* arena;
  const pl_outline* o;
  const pl_source* source;
  const pl_parse* p;
  const pl_parse_place* place;
  size_t at;
  pl_offers* out;
} pl_offering;

// ----------------------------------------------------------------------------------- the place
static bool in_name(unsigned char c) { return isalnum(c) || c == '_' || c >= 0x80; }

// Letters before the place: a name that begins there.  Signs beyond ASCII, √ and the like, are
// taken as letters too.
static uint32_t word_begin(const pl_source* s, size_t at) {
  size_t begin = at;
  while (begin > 0 && in_name((unsigned char)s->text[begin - 1])) begin--;
  while (begin < at && isdigit((unsigned char)s->text[begin])) begin++;  // 2m: the 2 is a number
  return (uint32_t)begin;
}

typedef enum pl_inside {
  PL_INSIDE_NOTHING,
  PL_INSIDE_COMMENT,
  PL_INSIDE_TEXT,
  PL_INSIDE_UNIT
} pl_inside;

// Comments, texts and units are one token each: within them the grammar has no say.
static pl_inside inside(const pl_source* s, size_t at) {
  size_t line = at;
  while (line > 0 && s->text[line - 1] != '\n') line--;
  pl_inside in = PL_INSIDE_NOTHING;
  for (size_t i = line; i < at; i++) {
    char c = s->text[i];
    if (in == PL_INSIDE_TEXT) in = c == '"' ? PL_INSIDE_NOTHING : in;
    else if (in == PL_INSIDE_UNIT) in = c == ']' ? PL_INSIDE_NOTHING : in;
    else if (c == '"') in = PL_INSIDE_TEXT;
    else if (c == '#') return PL_INSIDE_COMMENT;
    else if (c == '[' && (i == line || !in_name((unsigned char)s->text[i - 1])))
      in = PL_INSIDE_UNIT;
  }
  return in;
}

// ---------------------------------------------------------------------------------------- offers
static bool offered(const pl_offering* w, const char* text) {
  for (int i = 0; i < w->out->list.n; i++) {
    if (strcmp(w->out->list.at[i].text, text) == 0) return true;
  }
  return false;
}

static void offer(pl_offering* w, pl_offer_kind kind, const char* text, int named,
                  const pl_word_help* help) {
  if (!text || offered(w, text)) return;
  pl_offer one = {.kind = kind, .text = text, .named = named};
  if (help) one = (pl_offer){kind, text, named, help->form, {help->words[0], help->words[1]}};
  pl_push(w->arena, w->out->list, one);
}

static bool expects(const pl_offering* w, int token) {
  for (int i = 0; i < w->place->expected.n; i++) {
    if (w->place->expected.at[i] == token) return true;
  }
  return false;
}

// ---------------------------------------------------------------------------------------- names
static bool is_value(pl_named_kind k) {
  return k == PL_NAMED_PARAMETER || k == PL_NAMED_COORDINATE || k == PL_NAMED_INPUT
         || k == PL_NAMED_ABBREVIATION || k == PL_NAMED_FUNCTION;
}

static bool in_scope(const pl_offering* w, const pl_named* n) {
  return n->scope.source == w->source && w->at >= n->scope.begin && w->at <= n->scope.end;
}

static const char* index_in_scope(const pl_offering* w) {
  for (int i = w->o->named.n - 1; i >= 0; i--) {
    const pl_named* n = &w->o->named.at[i];
    if (n->kind == PL_NAMED_INDEX && in_scope(w, n)) return n->shown;
  }
  return "1";
}

static void offer_name(pl_offering* w, int i) {
  const pl_named* n = &w->o->named.at[i];
  if (pl_word_reserved(n->key)) return;  // a keyword where no label stands
  const char* text = n->family ? pl_format(w->arena, "%s[%s]", n->shown, index_in_scope(w))
                               : n->shown;
  offer(w, PL_OFFER_NAME, text, i, NULL);
}

// Results can be spoken of where something is asked or written down.
static bool results_may_stand(const pl_offering* w) {
  switch (w->place->statement) {
    case TOK_ASK:
    case TOK_PLOT:
    case TOK_EVENT:
    case TOK_OUTPUT:
    case TOK_LET:
    case TOK_SWEEP:
    case TOK_POINCARE: return true;
    default: return false;
  }
}

static void offer_values(pl_offering* w) {
  bool results = results_may_stand(w);
  for (int i = 0; i < w->o->named.n; i++) {
    const pl_named* n = &w->o->named.at[i];
    bool fits = is_value(n->kind)
                || (results && (n->kind == PL_NAMED_OUTPUT || n->kind == PL_NAMED_MULTIPLIER));
    if (n->kind == PL_NAMED_INDEX) fits = in_scope(w, n);
    if (fits) offer_name(w, i);
  }
  offer(w, PL_OFFER_NAME, "t", -1, NULL);
  static const char* const energies[] = {"T", "V", "L", "E", "H"};
  for (int i = 0; results && i < 5; i++) offer(w, PL_OFFER_NAME, energies[i], -1, NULL);
#define PL_HELP_FUNCTION(word, form, en, de) \
  offer(w, PL_OFFER_FUNCTION, word, -1, pl_help_function(word));
#define PL_HELP(list, word, form, en, de)
#include "lang/word_help.def"
}

static void offer_labels(pl_offering* w, bool places, bool constraints) {
  for (int i = 0; i < w->o->named.n; i++) {
    const pl_named* n = &w->o->named.at[i];
    pl_space space = pl_named_space(n->kind);
    if ((places && space == PL_SPACE_PLACE) || (constraints && n->kind == PL_NAMED_CONSTRAINT))
      offer_name(w, i);
  }
}

// The bracket around the place belongs to a name that takes a label.
static bool label_bracket(const pl_offering* w, bool* places) {
  int b = w->place->bracket;
  if (b < 1) return false;
  const pl_token *open = &w->p->tokens->list.at[b], *t = open - 1;
  bool first = b == w->p->tokens->list.n - 1 || w->place->last == '(';
  if (t->kind != TOK_NAME || !first || open->kind != '(') return false;
  *places = strcmp(t->key, "pos") == 0 || strcmp(t->key, "vel") == 0;
  return *places || strcmp(t->key, "force") == 0 || strcmp(t->key, "normal") == 0;
}

// A name that is new here, or one of a few words.  Returns whether it is not a name that is
// declared.
static bool other_name(pl_offering* w) {
  static const char *const languages[] = {"en", "de", NULL}, *const axes[] = {"x", "y", "z", NULL};
  static const char* const directions[] = {"right", "left", "up", "down", "out", NULL};
  static const char* const things[] = {"axes", "angles", "weight", "trail", "velocity", NULL};
  static const char* const drawings[] = {"line",   "rod",  "rope", "spring",
                                         "damper", "show", "hide", NULL};
  static const char *const minus[] = {"lambda-minus", NULL}, *const lambda[] = {"λ", NULL};
  const char* const* words = NULL;
  int last = w->place->last, statement = w->place->statement;
  bool top = w->place->depth == 0;
  switch (statement) {
    case TOK_PARAM:
    case TOK_COORD:
    case TOK_INPUT:
    case TOK_LET:
    case TOK_OUTPUT:
      if (top
          && (last == statement
              || (last == ',' && expects(w, TOK_NAME) && !expects(w, TOK_NUMBER))))
        return true;
      break;
    case TOK_LANG: words = languages; break;
    case TOK_AXES: words = last == TOK_NAME ? directions : axes; break;
    case TOK_CONVENTION: words = minus; break;
    case TOK_DRAW:
      words = last == TOK_DRAW ? drawings : last == TOK_NAME || last == ',' ? things : NULL;
      break;
    case TOK_ANIMATE: words = last == TOK_ANIMATE || last == ',' ? things + 2 : NULL; break;
    case TOK_GRAVITY:
      if (last == TOK_ALONG || !expects(w, TOK_NUMBER)) words = axes;
      break;
    case TOK_FOR:
      if (last == TOK_FOR) return true;
      break;
    case TOK_BODY:
    case TOK_EVENT:
    case TOK_POINT:
      if (last == statement) return true;
      break;
    default: break;
  }
  if (last == TOK_WITH && statement == TOK_CONSTRAINT) words = lambda;
  for (int i = 0; words && words[i]; i++) offer(w, PL_OFFER_WORD, words[i], -1, NULL);
  return words != NULL && statement != TOK_DRAW && statement != TOK_ANIMATE;
}

static void offer_names(pl_offering* w) {
  bool places = false;
  if (other_name(w)) return;
  if (label_bracket(w, &places)) {
    offer_labels(w, places, !places);
    return;
  }
  switch (w->place->last) {
    case TOK_ON:
    case TOK_BETWEEN:
    case TOK_AND: offer_labels(w, true, true); break;
    case TOK_OF:
    case TOK_WHILE:
    case TOK_WORD_RELEASE:
    case TOK_WORD_ATTACH: offer_labels(w, false, true); break;
    default: break;
  }
  if (w->place->statement == TOK_DRAW || w->place->statement == TOK_ANIMATE)
    offer_labels(w, true, true);
  if (expects(w, TOK_NUMBER)) offer_values(w);
}

// ---------------------------------------------------------------------------------------- words
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

static void offer_statements(pl_offering* w) {
#define PL_STATEMENT(token, word)                             \
  if (!w->place->in_block || may_stand_in_block(TOK_##token)) \
    offer(w, PL_OFFER_STATEMENT, word, -1, pl_help_statement(word));
#include "lang/keywords.def"
}

static void offer_words(pl_offering* w) {
#define PL_ITEM(token, word) \
  if (expects(w, TOK_##token)) offer(w, PL_OFFER_REQUEST, word, -1, pl_help_request(word));
#define PL_RESERVED(token, word) \
  if (expects(w, TOK_##token))   \
    offer(w, PL_OFFER_WORD, TOK_##token == TOK_REDUNDANT ? "redundant ok" : word, -1, NULL);
#include "lang/keywords.def"
  static const struct {
    int token;
    const char* word;
  } own[] = {
      {TOK_WORD_MASS, "mass"},       {TOK_WORD_INERTIA, "inertia"}, {TOK_WORD_ANGLE, "angle"},
      {TOK_WORD_AXES, "axes"},       {TOK_WORD_STATIC, "static"},   {TOK_WORD_SURFACE, "surface"},
      {TOK_WORD_INTEGER, "integer"}, {TOK_WORD_STOP, "stop"},       {TOK_WORD_RECORD, "record"},
      {TOK_WORD_RELEASE, "release"}, {TOK_WORD_ATTACH, "attach"}};
  for (size_t i = 0; i < sizeof own / sizeof *own; i++) {
    if (expects(w, own[i].token)) offer(w, PL_OFFER_WORD, own[i].word, -1, NULL);
  }
}

static void offer_units(pl_offering* w) {
  // those of mechanics first, in the multiples that are usual
  static const char* const usual[] = {"kg",  "m",   "s",     "N",      "m/s", "m/s^2",
                                      "N/m", "N m", "rad/s", "kg m^2", "deg", "mm",
                                      "cm",  "km",  "ms",    "kN",     "MPa"};
  for (size_t i = 0; i < sizeof usual / sizeof *usual; i++)
    offer(w, PL_OFFER_UNIT, usual[i], -1, NULL);
  for (int i = 0; pl_unit_name(i); i++) offer(w, PL_OFFER_UNIT, pl_unit_name(i), -1, NULL);
}

// Behind an error in the line the grammar is lost: what has a name can still be meant.
static void offer_anything(pl_offering* w) {
  offer_values(w);
  offer_labels(w, true, true);
}

static void offer_in_grammar(pl_offering* w) {
  if (w->place->at_statement) offer_statements(w);
  else if (!w->place->fits) offer_anything(w);
  else {
    offer_words(w);
    if (expects(w, TOK_NAME)) offer_names(w);
  }
}

pl_offers pl_outline_offer(pl_arena* a, const pl_outline* o, size_t at) {
  const pl_source* s = o->files.at[0]->source;
  if (at > s->size) at = s->size;
  uint32_t begin = word_begin(s, at);
  pl_offers out = {.span = {s, begin, (uint32_t)at}, .fits = true};
  pl_inside where = inside(s, at);
  pl_offering w = {.arena = a, .o = o, .source = s, .at = at, .out = &out};
  if (where == PL_INSIDE_UNIT) offer_units(&w);
  if (where != PL_INSIDE_NOTHING) return out;
  pl_diagnostics* unheard = PL_NEW(a, pl_diagnostics);
  unheard->arena = a;
  pl_job* job = PL_NEW(a, pl_job);
  *job = (pl_job){.arena = a, .diagnostics = unheard};
  pl_parse* p = PL_NEW(a, pl_parse);
  pl_parse_place place;
  pl_parse_cut(p, job, pl_names_make(a), pl_source_make(a, s->name, s->text, begin), &place);
  w.p = p;
  w.place = &place;
  out.fits = place.fits;
  // a name touches the word: a prime, a number without a blank
  offer_in_grammar(&w);
  return out;
}
