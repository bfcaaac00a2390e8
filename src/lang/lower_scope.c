// Scope: what names mean, and what was probably meant when they mean nothing.
#include "lang/lower_impl.h"

#include <stdlib.h>
#include <string.h>

#include "grammar.h"

// -------------------------------------------------------------------------------------- complaints
pl_diagnostic* pl_lower_complain(pl_lower* l, pl_code code, pl_span span, const char* en,
                                 const char* de, ...) {
  if (pl_code_severity(code) == PL_ERROR) l->wrong++;
  if (l->mute) return PL_NEW(l->arena, pl_diagnostic);
  va_list ap, again;
  va_start(ap, de);
  va_copy(again, ap);
  const char* english = pl_vformat(l->arena, en, ap);
  pl_diagnostic* m = pl_report(l->job->diagnostics, code, span, english,
                               pl_vformat(l->arena, de, again));
  va_end(again);
  va_end(ap);
  return m;
}

void pl_lower_pending(pl_lower* l, pl_code code, const char* what, pl_span span, const char* en,
                      const char* de) {
  pl_diagnostic* m = pl_lower_complain(l, code, span, en, de);
  if (code == PL_E091) {
    pl_suggest(l->job, m, NULL, PL_BOTH("remove the line to solve the rest"));
  }
  pl_push(l->arena, l->m->pending, (pl_pending){what, span});
}

// ---------------------------------------------------------------------------------------- entities
static uint64_t key_of(const char* key) { return (uint64_t)(uintptr_t)key; }

pl_entity* pl_scope_find(const pl_lower* l, const char* key) {
  uint64_t i = pl_map_get(l->by_key, key_of(key));
  return i ? l->entities.at[i - 1] : NULL;
}

void pl_scope_add(pl_lower* l, pl_entity* e) {
  pl_push(l->arena, l->entities, e);
  pl_map_set(l->by_key, key_of(e->key), (uint64_t)l->entities.n);
}

const pl_local* pl_scope_local(const pl_lower* l, const char* key) {
  for (int i = l->locals.n - 1; i >= 0; i--) {
    if (l->locals.at[i].key == key) return &l->locals.at[i];
  }
  return NULL;
}

bool pl_scope_lost(const pl_lower* l, const char* key) {
  for (int i = 0; i < l->lost.n; i++) {
    if (l->lost.at[i] == key) return true;
  }
  return false;
}

pl_symbol pl_scope_symbol(pl_lower* l, const pl_ast* name, pl_role role) {
  // a coordinate's or a result's derived name may have taken the spelling already
  const char* ascii = name->key;
  for (int k = 2; pl_symbol_find(l->pool, ascii).id; k++)
    ascii = pl_format(l->arena, "%s_%d", name->key, k);
  pl_symbol_info info = {.name = name->shown,
                         .ascii = ascii,
                         .role = role,
                         .class = PL_C_OTHER,
                         .dimension = pl_dimension_one()};
  if (role == PL_R_COORD) info.class = PL_C_COORD;
  if (role == PL_R_ARRAY) info.class = PL_C_COORD;
  if (role == PL_R_MULTIPLIER) info.class = PL_C_MULTIPLIER;
  return pl_symbol_make(l->pool, &info);
}

static const char* what_it_is(pl_entity_kind k, bool german) {
  switch (k) {
    case PL_ENTITY_PARAM: return german ? pl_german("a parameter") : "a parameter";
    case PL_ENTITY_INPUT: return german ? pl_german("an input") : "an input";
    case PL_ENTITY_COORD: return german ? pl_german("a coordinate") : "a coordinate";
    case PL_ENTITY_FAMILY: return german ? pl_german("a family") : "a family";
    case PL_ENTITY_LET: return german ? pl_german("an abbreviation") : "an abbreviation";
    case PL_ENTITY_FUNCTION: return german ? pl_german("a function") : "a function";
    case PL_ENTITY_INDEX: return german ? pl_german("an index") : "an index";
    case PL_ENTITY_SMALL: return german ? pl_german("a small quantity") : "a small quantity";
  }
  return "?";
}

static bool refuse_reserved(pl_lower* l, const pl_ast* name) {
  bool time = strcmp(name->key, "t") == 0;
  if (!time && !pl_word_function(name->key) && !pl_word_reserved(name->key)) return false;
  pl_diagnostic* m = pl_lower_complain(l, PL_E013, pl_ast_span(name),
                                       PL_BOTH(time ? "t is the time" : "%s is a reserved word"),
                                       name->key);
  pl_suggest(l->job, m, NULL, PL_BOTH("choose another name, such as %s1"), name->key);
  return true;
}

pl_entity* pl_scope_declare(pl_lower* l, pl_entity_kind kind, const pl_ast* name,
                            pl_symbol symbol) {
  bool refused = refuse_reserved(l, name);
  pl_entity* old = pl_scope_find(l, name->key);
  if (!refused && name->number > 0) {
    pl_diagnostic* m = pl_lower_complain(l, PL_E013, pl_ast_span(name),
                                         PL_BOTH("a derivative cannot be declared"));
    pl_suggest(l->job, m, name->shown, PL_BOTH("declare %s; its derivatives follow"), name->shown);
  } else if (!refused && old) {
    pl_diagnostic* m = pl_lower_complain(l, PL_E012, pl_ast_span(name),
                                         PL_BOTH("%1$s is declared twice%2$.0s"), name->shown, "");
    if (!l->mute) {
      pl_place at = pl_span_place(old->span);
      pl_report_label(l->job->diagnostics, m, old->span,
                      pl_format(l->arena,
                                l->job->lang == PL_GERMAN ? pl_german("first here (line %d)")
                                                          : "first here (line %d)",
                                at.line));
    }
    pl_because(l->job, m, PL_BOTH("already %1$s%2$.0s"), what_it_is(old->kind, false),
               what_it_is(old->kind, true));
    pl_suggest(l->job, m, NULL, PL_BOTH("remove one of them, or choose another name"));
    refused = true;
  }
  pl_entity* e = PL_NEW(l->arena, pl_entity);
  *e = (pl_entity){.kind = kind,
                   .key = name->key,
                   .shown = name->shown,
                   .symbol = symbol,
                   .span = pl_ast_span(name),
                   .broken = l->mute > 0};
  if (old == NULL) pl_scope_add(l, e);
  return e;
}

pl_symbol pl_scope_dotted(pl_lower* l, pl_symbol s, int dots) {
  for (; dots > 0; dots--) s = pl_symbol_dot(l->pool, s);
  return s;
}

pl_rule* pl_scope_rule(pl_lower* l, const char* key) {
  for (int i = 0; i < l->rules.n; i++) {
    if (l->rules.at[i].key == key) return &l->rules.at[i];
  }
  return NULL;
}

// ----------------------------------------------------------------------------------- abbreviations
// Made of given quantities only?  Then it stays a name.
static bool only_given(pl_lower* l, pl_expr e) {
  e = pl_unit_to_si(l->pool, e);
  int n = pl_symbols_in(l->pool, e, NULL, 0);
  pl_symbol* s = PL_ARRAY(l->arena, pl_symbol, n + 1);
  pl_symbols_in(l->pool, e, s, n);
  for (int i = 0; i < n; i++) {
    if (pl_symbol_get(l->pool, s[i])->role != PL_R_PARAM) return false;
  }
  return !pl_has_role(l->pool, e, PL_R_ARRAY) && !pl_has_role(l->pool, e, PL_R_COORD);
}

static void circle(pl_lower* l, pl_entity* e) {
  pl_diagnostic* m = pl_lower_complain(l, PL_E018, e->span, PL_BOTH("%s leads back to itself"),
                                       e->shown);
  pl_suggest(l->job, m, NULL, PL_BOTH("write its right side without %s"), e->shown);
  e->broken = true;
}

void pl_scope_finish_let(pl_lower* l, pl_entity* e) {
  if (e->state == 2) return;
  if (e->state == 1) {
    if (!e->broken) circle(l, e);
    return;
  }
  enum { MAX_DEPTH = 300 };
  if (l->call_depth > MAX_DEPTH) {
    pl_lower_complain(l, PL_E006, e->span, PL_BOTH("abbreviations are nested too deeply"));
    e->broken = true;
    e->state = 2;
    return;
  }
  // its right side is read where it stands: no locals, no block
  e->state = 1;
  l->call_depth++;
  pl_block* block = l->block;
  int n_locals = l->locals.n;
  bool results = l->results, infinity = l->infinity;
  pl_local* locals = l->locals.at;
  l->block = NULL;
  l->locals.n = 0;
  l->locals.at = NULL;
  l->locals.cap = 0;
  l->results = true;
  l->infinity = false;
  l->mute += e->broken;
  int wrong = l->wrong;
  pl_quantity q = pl_lower_quantity(l, e->override ? e->override : pl_ast_kid(e->definition, 2));
  l->mute -= e->broken;
  l->locals.at = locals;
  l->locals.n = n_locals;
  l->locals.cap = n_locals;
  l->block = block;
  l->results = results;
  l->infinity = infinity;
  l->call_depth--;
  e->state = 2;
  if (l->wrong > wrong || pl_quantity_is_bad(&q)) e->broken = true;
  e->n = q.n;
  memcpy(e->at, q.at, sizeof e->at);
  e->value = q.at[0];
  e->inserted = e->broken || q.n > 0 || !only_given(l, e->value);
  const pl_ast* name = pl_ast_kid(e->definition, 0);
  e->symbol = pl_scope_symbol(l, name, e->inserted ? PL_R_LOCAL : PL_R_PARAM);
  pl_push(l->arena, l->m->lets,
          (pl_let){.symbol = e->symbol,
                   .inserted = e->inserted,
                   .value = e->value,
                   .span = pl_ast_span(e->definition)});
  if (!e->inserted) e->value = pl_sym(l->pool, e->symbol);
}

// ------------------------------------------------------------------------------------ did you mean
static const char* const result_words[] = {
    "T", "V", "L", "E", "H", "lagrangian", "kinetic", "potential", "energy", "hamiltonian"};
enum { N_RESULT_WORDS = sizeof result_words / sizeof result_words[0] };

// Where two names differ in one digit, the nearer digit is the better guess.
static int digit_gap(const char* a, const char* b) {
  size_t n = strlen(a);
  if (n == 0 || n != strlen(b)) return 50;
  for (size_t i = 0; i < n; i++) {
    if (a[i] != b[i]) return abs(a[i] - b[i]) < 10 ? abs(a[i] - b[i]) : 50;
  }
  return 0;
}

typedef struct guess {
  const char *key, *shown;
  int distance, gap;
} guess;

static void try_guess(guess* best, const char* wanted, const char* key, const char* shown) {
  int cap = strlen(wanted) <= 3 ? 1 : strlen(wanted) < 9 ? 2 : 3;
  int d = pl_edit_distance(wanted, key, cap);
  // L for l
  bool case_only = strlen(wanted) == 1 && strlen(key) == 1 && ((wanted[0] ^ key[0]) & ~0x20) == 0;
  if (case_only) d = 0;
  if (d > cap || (d >= (int)strlen(wanted) && strlen(wanted) < 2)) return;
  int gap = digit_gap(wanted, key);
  if (best->key && (d > best->distance || (d == best->distance && gap >= best->gap))) return;
  *best = (guess){key, shown, d, gap};
}

static const char* all_coordinates(pl_lower* l, int most) {
  pl_text out = pl_text_make(l->arena);
  int n = 0;
  for (int i = 0; i < l->entities.n && n <= most; i++) {
    const pl_entity* e = l->entities.at[i];
    if (e->kind != PL_ENTITY_COORD && e->kind != PL_ENTITY_FAMILY) continue;
    if (n++) pl_text_add(&out, " ");
    pl_text_add(&out, e->shown);
  }
  return n > 0 && n <= most ? pl_text_string(&out) : NULL;
}

static bool told_before(pl_lower* l, const char* key) {
  for (int i = 0; i < l->missed.n; i++) {
    if (strcmp(l->missed.at[i], key) == 0) return true;
  }
  if (!l->mute) pl_push(l->arena, l->missed, key);
  return false;
}

pl_diagnostic* pl_scope_unknown(pl_lower* l, const pl_ast* name) {
  if (pl_scope_lost(l, name->key) || strcmp(name->key, "?") == 0 || told_before(l, name->key)) {
    l->wrong++;
    return PL_NEW(l->arena, pl_diagnostic);
  }
  pl_diagnostic* m = pl_lower_complain(l, PL_E011, pl_ast_span(name), PL_BOTH("%s is not declared"),
                                       name->shown);
  guess best = {0};
  // a file full of unknown names needs no guess for each
  bool look = l->n_guesses++ < PL_MAX_GUESSES && !l->mute;
  for (int i = 0; look && i < l->entities.n; i++)
    try_guess(&best, name->key, l->entities.at[i]->key, l->entities.at[i]->shown);
  for (int i = 0; i < l->locals.n; i++)
    try_guess(&best, name->key, l->locals.at[i].key, l->locals.at[i].key);
  for (int i = 0; look && i < l->lost.n; i++)
    try_guess(&best, name->key, l->lost.at[i], l->lost.at[i]);
  for (int i = 0; l->results && i < N_RESULT_WORDS; i++)
    try_guess(&best, name->key, result_words[i], result_words[i]);
  if (strlen(name->key) > 2) {
    for (int i = 0; i < PL_N_FUNCTIONS; i++)
      try_guess(&best, name->key, pl_function_name[i], pl_function_name[i]);
    for (int i = 0; l->results && pl_word_of_request(i); i++)
      try_guess(&best, name->key, pl_word_of_request(i), pl_word_of_request(i));
  }
  const char* coordinates = all_coordinates(l, 8);
  const char* meant = l->results ? pl_slip_request(name->key) : NULL;
  if (meant) pl_suggest(l->job, m, meant, PL_BOTH("did you mean %s?"), meant);
  else if (l->choosing) pl_suggest(l->job, m, NULL, PL_BOTH("declare it:  coord %s"), name->shown);
  else if (best.key == NULL && coordinates == NULL)
    pl_suggest(l->job, m, NULL, PL_BOTH("declare it:  param %s = ..."), name->shown);
  else if (best.key == NULL)
    pl_suggest(l->job, m, NULL, PL_BOTH("declare it:  param %s = ...        (coordinates: %s)"),
               name->shown, coordinates);
  else if (coordinates == NULL)
    pl_suggest(l->job, m, best.shown, PL_BOTH("did you mean %s?"), best.shown);
  else
    pl_suggest(l->job, m, best.shown, PL_BOTH("did you mean %s?        (coordinates: %s)"),
               best.shown, coordinates);
  return m;
}

void pl_scope_unknown_label(pl_lower* l, const pl_ast* label, const char* en, const char* de,
                            const char* const* known, int n) {
  if (pl_scope_lost(l, label->key)) {
    l->wrong++;
    return;
  }
  pl_diagnostic* m = pl_lower_complain(l, PL_E019, pl_ast_span(label),
                                       PL_BOTH("%1$s %3$s is not declared%2$.0s"), en, de,
                                       label->shown);
  guess best = {0};
  pl_text all = pl_text_make(l->arena);
  if (l->n_guesses++ >= PL_MAX_GUESSES) n = 0;
  for (int i = 0; i < n; i++) {
    try_guess(&best, label->key, known[i], known[i]);
    pl_text_addf(&all, "%s%s", i ? " " : "", known[i]);
  }
  if (best.key) pl_suggest(l->job, m, best.shown, PL_BOTH("did you mean %s?"), best.shown);
  else if (n && n <= 10)
    pl_suggest(l->job, m, NULL, PL_BOTH("there are: %s"), pl_text_string(&all));
  else pl_suggest(l->job, m, NULL, PL_BOTH("give the label in its own line first"));
}

// ------------------------------------------------------------------------------------------- names
static pl_quantity name_of_entity(pl_lower* l, pl_entity* e, const pl_ast* name,
                                  const pl_ast* index, int dots, const pl_ast* place);

// x1_dot, x1_ddot, x1_0, x1_dot_0: the ASCII spellings of derivatives and start values.
static bool find_alias(pl_lower* l, const pl_ast* name, pl_entity** e, int* dots, bool* start) {
  char stem[128];
  size_t n = strlen(name->raw);
  if (n >= sizeof stem) return false;
  memcpy(stem, name->raw, n + 1);
  *start = false;
  *dots = 0;
  if (n > 2 && strcmp(stem + n - 2, "_0") == 0) {
    *start = true;
    stem[n -= 2] = 0;
  }
  if (n > 5 && strcmp(stem + n - 5, "_ddot") == 0) {
    *dots = 2;
    stem[n -= 5] = 0;
  } else if (n > 4 && strcmp(stem + n - 4, "_dot") == 0) {
    *dots = 1;
    stem[n -= 4] = 0;
  }
  if (!*start && *dots == 0) return false;
  pl_spelled s;
  size_t bad;
  if (!pl_spell(l->arena, l->names, stem, n, &s, &bad)) return false;
  *e = pl_scope_find(l, s.key);
  return *e && ((*e)->kind == PL_ENTITY_COORD || (*e)->kind == PL_ENTITY_FAMILY);
}

static bool result_kind(const char* key, pl_result_kind* kind) {
  static const pl_result_kind kinds[] = {PL_RES_T, PL_RES_V, PL_RES_L, PL_RES_E, PL_RES_H,
                                         PL_RES_L, PL_RES_T, PL_RES_V, PL_RES_E, PL_RES_H};
  for (int i = 0; i < N_RESULT_WORDS; i++) {
    if (strcmp(result_words[i], key) != 0) continue;
    *kind = kinds[i];
    return true;
  }
  return false;
}

bool pl_scope_is_result(const char* key) {
  pl_result_kind kind;
  return result_kind(key, &kind);
}

// `output F = ...` gives a quantity a name, which can be plotted and asked like the quantity
// itself.
static pl_expr value_of_output(const pl_lower* l, const char* key) {
  for (int i = 0; i < l->m->outputs.n; i++) {
    if (strcmp(l->m->outputs.at[i].name, key) == 0) return l->m->outputs.at[i].value;
  }
  return pl_poison();
}

// λ alone is the multiplier that `with λ` named, or the only one; λ_label that of a constraint.
static pl_rule* find_multiplier(pl_lower* l, const char* key) {
  for (int i = 0; i < l->rules.n; i++) {
    if (l->rules.at[i].with == key) return &l->rules.at[i];
  }
  if (strcmp(key, "lambda") == 0) return l->rules.n == 1 ? &l->rules.at[0] : NULL;
  if (strncmp(key, "lambda", 6) != 0) return NULL;
  const char* label = key + 6;
  if (*label == '_') label++;
  for (int i = 0; i < l->rules.n; i++) {
    if (strcmp(l->rules.at[i].key, label) == 0) return &l->rules.at[i];
  }
  return NULL;
}

bool pl_scope_is_multiplier(pl_lower* l, const char* key) {
  return find_multiplier(l, key) != NULL;
}

static bool is_momentum(pl_lower* l, const char* key, pl_entity** coordinate) {
  if (strncmp(key, "p_", 2) != 0) return false;
  *coordinate = pl_scope_find(l, pl_intern(l->names, key + 2));
  return *coordinate && (*coordinate)->kind == PL_ENTITY_COORD;
}

bool pl_scope_known(pl_lower* l, const pl_ast* name) {
  pl_entity* e;
  int dots;
  bool start;
  pl_result_kind kind;
  if (pl_scope_local(l, name->key) || pl_scope_find(l, name->key) || strcmp(name->key, "t") == 0)
    return true;
  if (pl_word_function(name->key) || find_alias(l, name, &e, &dots, &start)
      || find_multiplier(l, name->key))
    return true;
  if (l->results && !pl_is_poison(value_of_output(l, name->key))) return true;
  return (l->results && result_kind(name->key, &kind)) || is_momentum(l, name->key, &e);
}

static pl_expr lower_index(pl_lower* l, const pl_ast* index) {
  if (index->kind == PL_AST_RANGE) {
    pl_lower_complain(l, PL_E025, pl_ast_span(index),
                      PL_BOTH("one index is needed here, not a range"));
    return pl_poison();
  }
  return pl_lower_scalar(l, index);
}

// An index where none belongs.  "g[m/s^2]" is a unit that lacks its blank.
static pl_quantity no_family(pl_lower* l, const pl_ast* name, const pl_ast* place,
                             const pl_ast* index) {
  pl_unit unit;
  size_t bad_at, bad_n;
  const char* near;
  const char* text = pl_source_text(l->arena, pl_ast_span(index));
  const pl_ast* one = pl_ast_single(index);
  bool is_index = !index || index->kind == PL_AST_SUM
                  || (one
                      && (one->kind == PL_AST_NUMBER
                          || (one->kind == PL_AST_NAME && pl_scope_local(l, one->key))));
  if (!is_index && pl_unit_parse(l->pool, text, strlen(text), &unit, &bad_at, &bad_n, &near)) {
    pl_diagnostic* m = pl_lower_complain(l, PL_E023, pl_ast_span(place),
                                         PL_BOTH("a unit belongs to a number or a declaration"));
    pl_suggest(l->job, m, name->shown, PL_BOTH("remove [%s]"), text);
    return pl_quantity_bad();
  }
  pl_diagnostic* m = pl_lower_complain(l, PL_E025, pl_ast_span(place),
                                       PL_BOTH("%s is not a family, so it takes no index"),
                                       name->shown);
  pl_suggest(l->job, m, NULL, PL_BOTH("declare  coord %s[1..N]"), name->shown);
  return pl_quantity_bad();
}

static pl_quantity no_derivative(pl_lower* l, const pl_ast* place, const char* shown) {
  pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(place),
                                       PL_BOTH("%s does not move, so it has no derivative"), shown);
  pl_suggest(l->job, m, NULL, PL_BOTH("declare  coord %s  if it moves"), shown);
  return pl_quantity_bad();
}

static pl_quantity name_of_entity(pl_lower* l, pl_entity* e, const pl_ast* name,
                                  const pl_ast* index, int dots, const pl_ast* place) {
  if (e->broken && e->kind != PL_ENTITY_COORD && e->kind != PL_ENTITY_PARAM
      && e->kind != PL_ENTITY_FAMILY) {
    l->wrong++;
    return pl_quantity_bad();
  }
  if (e->kind == PL_ENTITY_FAMILY) {
    if (index == NULL) {
      pl_diagnostic* m = pl_lower_complain(l, PL_E025, pl_ast_span(place),
                                           PL_BOTH("%s is a family, so it needs an index"),
                                           e->shown);
      pl_suggest(l->job, m, pl_format(l->arena, "%s[1]", e->shown),
                 PL_BOTH("write %s[1] or, inside for, %s[i]"), e->shown, e->shown);
      return pl_quantity_bad();
    }
    pl_expr i = lower_index(l, index);
    return pl_is_poison(i) ? pl_quantity_bad() : pl_quantity_of(pl_at(l->pool, e->symbol, dots, i));
  }
  if (index) return no_family(l, name, place, index);
  switch (e->kind) {
    case PL_ENTITY_COORD:
      return pl_quantity_of(pl_sym(l->pool, pl_scope_dotted(l, e->symbol, dots)));
    case PL_ENTITY_LET: {
      pl_scope_finish_let(l, e);
      if (e->broken) {
        l->wrong++;
        return pl_quantity_bad();
      }
      if (dots && !e->inserted) return no_derivative(l, place, e->shown);
      pl_quantity q = {.n = e->n};
      memcpy(q.at, e->at, sizeof q.at);
      if (e->n == 0) q.at[0] = e->value;
      for (; dots > 0; dots--) {
        for (int k = 0; k < (q.n ? q.n : 1); k++) q.at[k] = pl_dt(l->pool, q.at[k]);
      }
      return q;
    }
    case PL_ENTITY_FUNCTION: {
      pl_diagnostic* m = pl_lower_complain(l, PL_E015, pl_ast_span(place),
                                           PL_BOTH("%s needs an argument"), e->shown);
      pl_suggest(l->job, m, NULL, PL_BOTH("write %s(...)"), e->shown);
      return pl_quantity_bad();
    }
    default:
      if (dots) return no_derivative(l, place, e->shown);
      return pl_quantity_of(pl_sym(l->pool, e->symbol));
  }
}

static pl_quantity name_of_multiplier(pl_lower* l, const pl_rule* r, const pl_ast* index, int dots,
                                      const pl_ast* place) {
  if (dots) {
    pl_lower_complain(l, PL_E017, pl_ast_span(place),
                      PL_BOTH("multipliers have no derivative here"));
    return pl_quantity_bad();
  }
  if (r->family && index == NULL) {
    pl_diagnostic* m = pl_lower_complain(
        l, PL_E025, pl_ast_span(place),
        PL_BOTH("%s is a family of constraints, so its multiplier needs an index"), r->shown);
    pl_suggest(l->job, m, pl_format(l->arena, "λ_%s[1]", r->shown), PL_BOTH("write λ_%s[1]"),
               r->shown);
    return pl_quantity_bad();
  }
  if (!r->family && index) {
    pl_lower_complain(l, PL_E025, pl_ast_span(place),
                      PL_BOTH("%s is not a family, so it takes no index"), r->shown);
    return pl_quantity_bad();
  }
  if (index == NULL) return pl_quantity_of(pl_sym(l->pool, r->lambda));
  pl_expr i = lower_index(l, index);
  return pl_is_poison(i) ? pl_quantity_bad() : pl_quantity_of(pl_at(l->pool, r->lambda, 0, i));
}

static pl_quantity name_of_momentum(pl_lower* l, const pl_ast* name, const pl_entity* coordinate) {
  pl_symbol_info info = {.name = pl_format(l->arena, "p_%s", coordinate->shown),
                         .ascii = name->key,
                         .role = PL_R_MOMENTUM,
                         .class = PL_C_OTHER,
                         .dimension = pl_dimension_one(),
                         .base = coordinate->symbol};
  return pl_quantity_of(pl_sym(l->pool, pl_symbol_make(l->pool, &info)));
}

static pl_quantity several_multipliers(pl_lower* l, const pl_ast* name) {
  pl_text all = pl_text_make(l->arena);
  for (int i = 0; i < l->rules.n && i < 6; i++)
    pl_text_addf(&all, "%sλ_%s", i ? ", " : "", l->rules.at[i].shown);
  pl_diagnostic* m = pl_lower_complain(
      l, PL_E011, pl_ast_span(name),
      PL_BOTH(l->rules.n ? "there are several multipliers"
                         : "λ is not declared: there is no constraint"));
  if (l->rules.n)
    pl_suggest(l->job, m, NULL, PL_BOTH("write %1$s, or name one in its constraint: with λ"),
               pl_text_string(&all));
  return pl_quantity_bad();
}

pl_quantity pl_lower_name(pl_lower* l, const pl_ast* name, const pl_ast* index, int dots,
                          const pl_ast* place) {
  dots += name->number;
  if (dots > 2) {
    pl_lower_complain(l, PL_E017, pl_ast_span(place),
                      PL_BOTH("only first and second derivatives can be written"));
    return pl_quantity_bad();
  }
  const pl_local* local = pl_scope_local(l, name->key);
  if (local) {
    if (index) return no_family(l, name, place, index);
    pl_quantity q = {.n = local->n};
    memcpy(q.at, local->at, sizeof q.at);
    if (local->n == 0) q.at[0] = local->symbol.id ? pl_sym(l->pool, local->symbol) : local->value;
    for (int d = 0; d < dots; d++) {
      for (int k = 0; k < (q.n ? q.n : 1); k++) q.at[k] = pl_dt(l->pool, q.at[k]);
    }
    return q;
  }
  pl_entity* e = pl_scope_find(l, name->key);
  if (e) return name_of_entity(l, e, name, index, dots, place);
  int more;
  bool start;
  if (find_alias(l, name, &e, &more, &start)) {
    if (!start) return name_of_entity(l, e, name, index, dots + more, place);
    if (e->kind == PL_ENTITY_COORD && dots == 0 && more <= 1) {
      return pl_quantity_of(
          pl_sym(l->pool, pl_symbol_start(l->pool, pl_scope_dotted(l, e->symbol, more))));
    }
  }
  if (strcmp(name->key, "t") == 0 && !index)
    return dots ? no_derivative(l, place, "t") : pl_quantity_of(pl_sym(l->pool, pl_time(l->pool)));
  pl_rule* rule = find_multiplier(l, name->key);
  if (rule) return name_of_multiplier(l, rule, index, dots, place);
  pl_result_kind kind;
  pl_expr output = l->results && !index ? value_of_output(l, name->key) : pl_poison();
  for (int d = 0; d < dots && !pl_is_poison(output); d++) output = pl_dt(l->pool, output);
  if (!pl_is_poison(output)) return pl_quantity_of(output);
  if (l->results && !index && dots == 0 && result_kind(name->key, &kind)) {
    return pl_quantity_of(pl_sym(l->pool, pl_model_result_symbol(l->m, kind, NULL)));
  }
  if (!index && dots == 0 && is_momentum(l, name->key, &e)) return name_of_momentum(l, name, e);
  if (strcmp(name->key, "lambda") == 0 && !pl_scope_lost(l, name->key))
    return several_multipliers(l, name);
  if (l->infinity && (strcmp(name->key, "inf") == 0 || strcmp(name->key, "infinity") == 0))
    return pl_quantity_of(pl_infinity(l->pool));
  if (!l->results && result_kind(name->key, &kind) && !pl_scope_lost(l, name->key)) {
    pl_diagnostic* m = pl_scope_unknown(l, name);
    pl_because(l->job, m, PL_BOTH("as a result it can stand in ask, plot and event only"));
    return pl_quantity_bad();
  }
  pl_scope_unknown(l, name);
  return pl_quantity_bad();
}
