// Slips: what people type who know another language, or the blackboard, and what they mean. Needs
// the token at which the grammar stopped; answers with the line as it should be.
#include "lang/lang_impl.h"

#include <string.h>

#include "grammar.h"

// ------------------------------------------------------------------------ words of other languages
typedef struct slip_word {
  const char *typed, *meant;
} slip_word;

// clang-format off
static const slip_word statement_words[] = {
  {"zwang", "constraint"}, {"zwangsbedingung", "constraint"}, {"bedingung", "constraint"},
  {"nebenbedingung", "constraint"}, {"bindung", "constraint"}, {"masse", "mass"},
  {"kraft", "force"}, {"feder", "spring"}, {"daempfer", "damper"}, {"koerper", "body"},
  {"punkt", "point"}, {"stab", "rod"}, {"stange", "rod"}, {"koordinate", "coord"},
  {"koordinaten", "coord"}, {"variable", "coord"}, {"var", "coord"}, {"coordinate", "coord"},
  {"coordinates", "coord"}, {"konstante", "param"}, {"const", "param"}, {"constant", "param"},
  {"parameter", "param"}, {"gegeben", "param"}, {"given", "param"}, {"anfang", "init"},
  {"start", "init"}, {"initial", "init"}, {"frage", "ask"}, {"gesucht", "ask"}, {"berechne", "ask"},
  {"find", "ask"}, {"solve", "ask"}, {"show", "ask"}, {"ereignis", "event"},
  {"reibung", "friction"}, {"schwerkraft", "gravity"}, {"gewicht", "gravity"}, {"moment", "torque"},
  {"drehmoment", "torque"}, {"simuliere", "simulate"}, {"zeichne", "plot"}, {"achsen", "axes"},
  {"titel", "system"}, {"title", "system"}, {"import", "include"}, {"joint", "constraint"},
  {"define", "let"}, {"sei", "let"}, {"annahme", "assume"}, {"stoss", "restitution"},
  {"widerstand", "drag"},
};

static const slip_word request_words[] = {
  {"eom", "lagrange2"}, {"motion", "lagrange2"}, {"bewegungsgleichung", "lagrange2"},
  {"bewegungsgleichungen", "lagrange2"}, {"lagrange", "lagrange2"}, {"DOF", "dof"},
  {"freedom", "dof"}, {"freedoms", "dof"}, {"freiheitsgrade", "dof"}, {"period", "modes"},
  {"periode", "modes"}, {"schwingungsdauer", "modes"}, {"frequency", "modes"},
  {"frequencies", "modes"}, {"frequenz", "modes"}, {"eigenfrequency", "modes"},
  {"eigenfrequenz", "modes"}, {"eigenmodes", "modes"}, {"omega0", "modes"},
  {"equilibrium", "equilibria"}, {"gleichgewicht", "equilibria"}, {"ruhelage", "equilibria"},
  {"integrals", "conserved"}, {"momentum", "conserved"}, {"erhaltung", "conserved"},
  {"erhaltungsgroessen", "conserved"}, {"hamilton", "hamiltonian"}, {"E_kin", "T"}, {"Ekin", "T"},
  {"W_kin", "T"}, {"T_kin", "T"}, {"E_pot", "V"}, {"Epot", "V"}, {"W_pot", "V"}, {"V_pot", "V"},
  {"E_ges", "E"}, {"E_tot", "E"}, {"Eges", "E"}, {"Etot", "E"}, {"energie", "E"},
  {"L_Lag", "lagrangian"}, {"H_Ham", "H"}, {"newton2", "newton"},
  {"zwangsbedingungen", "constraints"},
};

// Words before `of LABEL`.
static const slip_word force_words[] = {
  {"tension", "force of"}, {"reaction", "force of"}, {"zwangskraft", "force of"},
  {"seilkraft", "force of"}, {"stabkraft", "force of"}, {"kraft", "force of"},
  {"multiplier", "force of"},
};
// clang-format on

static bool same_word(const char* a, const char* b) {
  for (; *a && *b; a++, b++) {
    char x = *a >= 'A' && *a <= 'Z' ? (char)(*a + 32) : *a,
         y = *b >= 'A' && *b <= 'Z' ? (char)(*b + 32) : *b;
    if (x != y) return false;
  }
  return *a == *b;
}

static const char* meant_by(const slip_word* list, size_t n, const char* typed) {
  for (size_t i = 0; i < n; i++)
    if (same_word(list[i].typed, typed)) return list[i].meant;
  return NULL;
}
#define MEANT(list, typed) meant_by(list, sizeof(list) / sizeof(list)[0], typed)

const char* pl_slip_statement(const char* typed) { return MEANT(statement_words, typed); }
const char* pl_slip_request(const char* typed) { return MEANT(request_words, typed); }

// --------------------------------------------------------------------------------------- the place
static const pl_token* token(const pl_parse* p, int i) {
  return &p->tokens->list.at[i < 0 ? 0 : i < p->tokens->list.n ? i : p->tokens->list.n - 1];
}

static bool is(const pl_token* t, const char* word) {
  return t->kind == TOK_NAME && t->number == 0 && strcmp(t->key, word) == 0;
}

static int end_of_line(const pl_parse* p, int i) {
  while (token(p, i)->kind != TOK_EOL && token(p, i)->kind != 0
         && token(p, i)->kind > PL_TOKEN_COMMENT)
    i++;
  return i;
}

// The source from token i up to, not including, token k.
static const char* text(const pl_parse* p, int i, int k) {
  if (k <= i) return "";
  return pl_source_text(p->arena, (pl_span){p->source, token(p, i)->begin, token(p, k - 1)->end});
}

static pl_diagnostic* at_token(pl_parse* p, const char* en, const char* de) {
  const pl_token* t = token(p, p->at);
  const char* s = pl_source_text(p->arena, (pl_span){p->source, t->begin, t->end});
  return pl_complain(p->job, PL_E001, (pl_span){p->source, t->begin, t->end}, en, de, s);
}

// -------------------------------------------------------------------------------------- statements
// rod m between A and B
static bool rod_without_mass(pl_parse* p) {
  int first = p->statement_first;
  const pl_token* t = token(p, p->at);
  if (p->kinds[first] != TOK_ROD || !is(t, "between") || is(token(p, first + 1), "mass"))
    return false;
  int mass = token(p, p->at - 1)->kind == ':' ? p->at : first + 1;
  pl_diagnostic* m = at_token(p, PL_BOTH("the mass of a rod has its word"));
  pl_suggest(p->job, m, NULL, PL_BOTH("write  rod mass %1$s %2$s"), text(p, mass, p->at),
             text(p, p->at, end_of_line(p, p->at)));
  return true;
}

// event stop when x = 0;  event when x = 0 -> stop;  event e: when x = 0
static bool event_without_shape(pl_parse* p) {
  int first = p->statement_first, end = end_of_line(p, first);
  if (p->kinds[first] != TOK_EVENT) return false;
  int when = first + 1, arrow = end, colon = end;
  while (when < end && !is(token(p, when), "when")) when++;
  for (int i = first; i < end; i++) {
    if (token(p, i)->kind == TOK_ARROW) arrow = i;
    if (token(p, i)->kind == ':' && colon == end) colon = i;
  }
  if (when == end || (colon < when && arrow < end)) return false;
  const char* action = arrow < end ? text(p, arrow + 1, end) : "stop";
  bool named = token(p, first + 1)->kind == TOK_NAME && when > first + 1;
  const char* name = named ? token(p, first + 1)->shown : "e";
  pl_diagnostic* m = at_token(p, PL_BOTH("an event has a name, a condition and an action"));
  pl_suggest(p->job, m, NULL, PL_BOTH("write  event %s: when %s -> %s"), name,
             text(p, when + 1, arrow), action);
  return true;
}

// simulate 0 to 10 [s]
static bool range_in_words(pl_parse* p) {
  const pl_token* t = token(p, p->at);
  if (p->kinds[p->statement_first] != TOK_SIMULATE || p->at == p->statement_first + 1) return false;
  if (!is(t, "to") && !is(t, "bis") && !is(t, "until")) return false;
  int end = end_of_line(p, p->at);
  pl_diagnostic* m = at_token(p, PL_BOTH("%s does not join two times"));
  pl_suggest(p->job, m, "..", PL_BOTH("write  simulate %s..%s"),
             text(p, p->statement_first + 1, p->at), text(p, p->at + 1, end));
  return true;
}

// ---------------------------------------------------------------------------------------- requests
static int start_of_item(const pl_parse* p) {
  int i = p->at;
  while (i > p->statement_first + 1 && token(p, i - 1)->kind != ',' && token(p, i - 1)->kind != ':')
    i--;
  return i;
}

// x when y = 0, x at y = 0, x if y = 0, force of rod at y = 0
static bool place_of_request(pl_parse* p) {
  const pl_token* t = token(p, p->at);
  if (p->kinds[p->statement_first] != TOK_ASK) return false;
  if (!is(t, "when") && !is(t, "at") && !is(t, "if") && !is(t, "wenn") && !is(t, "bei")
      && !is(t, "where"))
    return false;
  int from = start_of_item(p), end = end_of_line(p, p->at);
  const char* what = text(p, from, p->at);
  bool force = is(token(p, from), "force");
  if (is(t, "where") && !force) return false;
  // it has an `at` of its own
  if (!force && token(p, from)->kind == TOK_NAME && pl_word_item(token(p, from)->key)) return false;
  pl_diagnostic* m = at_token(p, PL_BOTH("%s does not name a place of the motion"));
  if (force) what = pl_format(p->arena, "normal(%s)", text(p, from + 2, p->at));
  pl_suggest(p->job, m, force ? NULL : "where", PL_BOTH("write  %s where %s"), what,
             text(p, p->at + 1, end));
  return true;
}

// tension of rod, equations of motion, degrees of freedom
static bool request_in_words(pl_parse* p) {
  const pl_token *t = token(p, p->at), *before = token(p, p->at - 1);
  if (p->kinds[p->statement_first] != TOK_ASK || !is(t, "of") || before->kind != TOK_NAME)
    return false;
  const pl_token* next = token(p, p->at + 1);
  const char* force = MEANT(force_words, before->key);
  const char* meant = next->kind == TOK_NAME ? pl_slip_request(next->key) : NULL;
  if (!meant || force) meant = pl_slip_request(before->key);
  if (force) meant = pl_format(p->arena, "%s %s", force, text(p, p->at + 1, end_of_line(p, p->at)));
  if (!meant) return false;
  pl_span span = {p->source, before->begin, next->end};
  pl_diagnostic* m = pl_complain(p->job, PL_E001, span, PL_BOTH("%s is no request"),
                                 pl_source_text(p->arena, span));
  pl_suggest(p->job, m, meant, PL_BOTH("did you mean  %s ?"), meant);
  return true;
}

bool pl_slip(pl_parse* p) {
  if (p->statement_first < 0) return false;
  return rod_without_mass(p) || event_without_shape(p) || range_in_words(p) || place_of_request(p)
         || request_in_words(p);
}
