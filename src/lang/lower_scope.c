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
// x1_dot, x1_ddot, x1_0, x1_dot_0: the ASCII spellings of derivatives and start values.
bool pl_scope_alias(pl_lower* l, const pl_ast* name, pl_entity** e, int* dots, bool* start) {
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

bool pl_scope_result(const char* key, pl_result_kind* kind) {
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
  return pl_scope_result(key, &kind);
}

// `output F = ...` gives a quantity a name, which can be plotted and asked like the quantity
// itself.
pl_expr pl_scope_output(const pl_lower* l, const char* key) {
  for (int i = 0; i < l->m->outputs.n; i++) {
    if (strcmp(l->m->outputs.at[i].name, key) == 0) return l->m->outputs.at[i].value;
  }
  return pl_poison();
}

// λ alone is the multiplier that `with λ` named, or the only one; λ_label that of a constraint.
pl_rule* pl_scope_multiplier(pl_lower* l, const char* key) {
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

bool pl_scope_momentum(pl_lower* l, const char* key, pl_entity** coordinate) {
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
  if (pl_word_function(name->key) || pl_scope_alias(l, name, &e, &dots, &start)
      || pl_scope_multiplier(l, name->key))
    return true;
  if (l->results && !pl_is_poison(pl_scope_output(l, name->key))) return true;
  return (l->results && pl_scope_result(name->key, &kind)) || pl_scope_momentum(l, name->key, &e);
}
