// Parse errors: what is wrong at a token, in words. The mistakes that people make are recognised
// before the general answer, which lists what would have been right.
#include "lang/lang_impl.h"

#include <string.h>

#include "grammar.h"

// -------------------------------------------------------------------------------------- complaints
static pl_diagnostic* complain(pl_job* job, pl_code code, pl_span span, const char* en,
                               const char* de, va_list ap) {
  va_list again;
  va_copy(again, ap);
  const char* english = pl_vformat(job->arena, en, ap);
  const char* german = pl_vformat(job->arena, de, again);
  va_end(again);
  return pl_report(job->diagnostics, code, span, english, german);
}

pl_diagnostic* pl_complain(pl_job* job, pl_code code, pl_span span, const char* en, const char* de,
                           ...) {
  va_list ap;
  va_start(ap, de);
  pl_diagnostic* m = complain(job, code, span, en, de, ap);
  va_end(ap);
  return m;
}

void pl_suggest(pl_job* job, pl_diagnostic* m, const char* replacement, const char* en,
                const char* de, ...) {
  va_list ap, again;
  va_start(ap, de);
  va_copy(again, ap);
  const char* english = pl_vformat(job->arena, en, ap);
  pl_report_fix(m, english, pl_vformat(job->arena, de, again), replacement);
  va_end(again);
  va_end(ap);
}

void pl_because(pl_job* job, pl_diagnostic* m, const char* en, const char* de, ...) {
  va_list ap, again;
  va_start(ap, de);
  va_copy(again, ap);
  const char* english = pl_vformat(job->arena, en, ap);
  pl_report_reason(m, english, pl_vformat(job->arena, de, again));
  va_end(again);
  va_end(ap);
}

const char* pl_source_text(pl_arena* a, pl_span s) {
  pl_text out = pl_text_make(a);
  if (s.source == NULL) return "";
  bool blank = false, comment = false;
  for (uint32_t i = s.begin; i < s.end && i < s.source->size; i++) {
    char c = s.source->text[i];
    if (c == '#') comment = true;
    if (c == '\n') comment = false;
    if (comment || c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == 0) {
      blank = true;
      continue;
    }
    if (blank && out.n) pl_text_add(&out, " ");
    blank = false;
    pl_text_add_n(&out, &c, 1);
  }
  return pl_text_string(&out);
}

// -------------------------------------------------------------------------------- words for tokens
typedef struct named {
  int token;
  const char* word;
} named;
static const named plain[] = {
    {TOK_TEXT, PL_KEY("a text in quotation marks")},
    {TOK_UNIT, PL_KEY("a unit in [ ]")},
    {TOK_EOL, PL_KEY("the end of the line")},
    {TOK_ARROW, "->"},
    {TOK_RANGE, ".."},
    {TOK_MUCH, ">>"},
    {'=', "="},
    {':', PL_KEY("a colon")},
    {',', PL_KEY("a comma")},
    {'(', "("},
    {')', ")"},
    {'[', "["},
    {']', "]"},
    {'{', "{"},
    {'}', "}"},
    {TOK_WORD_MASS, "mass"},
    {TOK_WORD_INERTIA, "inertia"},
    {TOK_WORD_ANGLE, "angle"},
    {TOK_WORD_AXES, "axes"},
    {TOK_WORD_STATIC, "static"},
    {TOK_WORD_SURFACE, "surface"},
    {TOK_WORD_INTEGER, "integer"},
    {TOK_WORD_STOP, "stop"},
    {TOK_WORD_RECORD, "record"},
    {TOK_WORD_RELEASE, "release"},
    {TOK_WORD_ATTACH, "attach"},
    {TOK_REDUNDANT, "redundant ok"},
};

static const char* word_for(int token, bool german) {
  for (size_t i = 0; i < sizeof plain / sizeof plain[0]; i++) {
    if (plain[i].token == token)
      return pl_in_language(german ? PL_GERMAN : PL_ENGLISH, plain[i].word);
  }
#define PL_RESERVED(t, text) \
  if (token == TOK_##t) return text;
#include "lang/keywords.def"
  return pl_word_of_item(token);
}

static bool has(const int* expected, int n, int token) {
  for (int i = 0; i < n; i++) {
    if (expected[i] == token) return true;
  }
  return false;
}

// "an expression", "=", "at": what could have stood here, at most six words.
static const char* list_expected(pl_arena* a, const int* expected, int n, bool german) {
  pl_text out = pl_text_make(a);
  const char* words[64];
  int n_words = 0;
  bool expression = has(expected, n, TOK_NUMBER) && has(expected, n, TOK_NAME)
                    && !has(expected, n, '/');
  bool operators = has(expected, n, '/');
  if (expression) words[n_words++] = german ? pl_german("an expression") : "an expression";
  else if (has(expected, n, TOK_NAME) && !operators)
    words[n_words++] = german ? pl_german("a name") : "a name";
  else if (has(expected, n, TOK_NUMBER) && !operators)
    words[n_words++] = german ? pl_german("a number") : "a number";
  for (int i = 0; i < n && n_words < 60; i++) {
    int t = expected[i];
    bool part_of_expression = (expression || operators)
                              && (t == '(' || t == '-' || t == '+' || t == '[' || t == TOK_UNIT
                                  || t == TOK_EOL);
    bool is_operator = operators && (t == ',' || t == ')' || t == ':');
    if (part_of_expression || (is_operator && n_words > 3)) continue;
    const char* w = word_for(t, german);
    if (w == NULL || pl_word_item(w)) continue;
    words[n_words++] = w;
  }
  if (n_words == 0 && operators)
    words[n_words++] = german ? pl_german("an operator") : "an operator";
  if (n_words == 0 && has(expected, n, TOK_EOL)) words[n_words++] = word_for(TOK_EOL, german);
  if (n_words == 0 || n_words > 8) return NULL;
  for (int i = 0; i < n_words; i++) {
    if (i > 0) pl_text_add(&out, i + 1 < n_words ? ", " : german ? pl_german(" or ") : " or ");
    pl_text_add(&out, words[i]);
  }
  return pl_text_string(&out);
}

// ------------------------------------------------------------------------------- frequent mistakes
static const pl_token* token_near(const pl_parse* p, int i, int by) {
  int k = i;
  for (int left = by < 0 ? -by : by; left > 0;) {
    k += by < 0 ? -1 : 1;
    if (k < 0) return &p->tokens->list.at[0];
    if (k >= p->tokens->list.n) return &p->tokens->list.at[p->tokens->list.n - 1];
    if (p->tokens->list.at[k].kind > PL_TOKEN_COMMENT) left--;
  }
  return &p->tokens->list.at[k];
}

// 0,5 for 0.5: outside brackets no list of numbers can stand, so a comma between two digits is a
// decimal comma.
static int find_decimal_comma(const pl_parse* p) {
  int depth = 0;
  for (int i = p->statement_first < 0 ? 0 : p->statement_first;
       i <= p->at && i + 1 < p->tokens->list.n; i++) {
    const pl_token* t = &p->tokens->list.at[i];
    depth += t->kind == '(' || t->kind == '[' ? 1 : t->kind == ')' || t->kind == ']' ? -1 : 0;
    if (t->kind != ',' || depth != 0 || i == 0 || !t->tight || !t[1].tight) continue;
    if (t[-1].kind == TOK_NUMBER && t[1].kind == TOK_NUMBER) return i;
  }
  return 0;
}

static bool decimal_comma(pl_parse* p) {
  int i = find_decimal_comma(p);
  if (i == 0) return false;
  const pl_token *whole = &p->tokens->list.at[i - 1], *part = &p->tokens->list.at[i + 1];
  const char* fixed = pl_format(p->arena, "%s.%s", whole->text, part->text);
  const pl_token* after = &p->tokens->list.at[i + 2 < p->tokens->list.n ? i + 2 : i + 1];
  pl_diagnostic* m = pl_complain(p->job, PL_E003, (pl_span){p->source, whole->begin, part->end},
                                 PL_BOTH("decimal comma"));
  const char* degree = after->kind == TOK_DEGREE ? "°" : "";
  // 1,000 may be a thousand
  if (strlen(part->text) == 3 && strlen(whole->text) <= 3 && whole->text[0] != '0') {
    pl_suggest(p->job, m, NULL, PL_BOTH("write %1$s%3$s, or %2$s%3$s if a thousand is meant"),
               fixed, pl_format(p->arena, "%s%s", whole->text, part->text), degree);
    return true;
  }
  pl_suggest(p->job, m, fixed, PL_BOTH("write %s%s        (Dezimalpunkt statt Komma)"), fixed,
             degree);
  return true;
}

static bool reserved_name(pl_parse* p, const int* expected, int n) {
  const pl_token* t = &p->tokens->list.at[p->at];
  if (t->kind != TOK_NAME || t->number || !pl_word_reserved(t->key) || !has(expected, n, TOK_NAME))
    return false;
  const pl_token* next = token_near(p, p->at, 1);
  if (has(expected, n, '/') && next->kind == TOK_NAME) return false;
  pl_diagnostic* m = pl_complain(p->job, PL_E013, (pl_span){p->source, t->begin, t->end},
                                 PL_BOTH("%s is a reserved word"), t->key);
  pl_suggest(p->job, m, NULL, PL_BOTH("choose another name, such as %s1"), t->key);
  return true;
}

static bool line_ends_early(pl_parse* p, const int* expected, int n) {
  const pl_token* t = &p->tokens->list.at[p->at];
  if (t->kind != TOK_EOL && t->kind != 0 && t->kind != '{' && t->kind != '}') return false;
  const pl_token* before = token_near(p, p->at, -1);
  pl_span span = {p->source, before->begin, before->end};
  pl_diagnostic* m;
  if (before->kind == ',') {
    m = pl_complain(p->job, PL_E001, span, PL_BOTH("something is missing after the comma"));
    pl_suggest(p->job, m, "", PL_BOTH("remove the comma"));
    return true;
  }
  span.begin = span.end;
  if (before->kind == TOK_NAME && strcmp(before->key, "for") == 0) span.begin = before->begin;
  m = pl_complain(p->job, PL_E001, span, PL_BOTH("the line ends too early"));
  const char* en = list_expected(p->arena, expected, n, false);
  if (en)
    pl_because(p->job, m, "expected: %1$s%2$.0s", "erwartet: %1$.0s%2$s", en,
               list_expected(p->arena, expected, n, true));
  if (en && pl_word_reserved(en)) pl_suggest(p->job, m, NULL, PL_BOTH("add  %s ..."), en);
  return true;
}

static bool missing_equals(pl_parse* p, const int* expected, int n) {
  const pl_token* t = &p->tokens->list.at[p->at];
  bool value = t->kind == TOK_NUMBER || t->kind == TOK_NAME || t->kind == TOK_PI || t->kind == '-';
  if (!value || !has(expected, n, '=') || has(expected, n, '/')) return false;
  const pl_token* before = token_near(p, p->at, -1);
  const char* left = pl_source_text(p->arena, (pl_span){p->source, before->begin, before->end});
  const char* right = pl_source_text(p->arena, (pl_span){p->source, t->begin, t->end});
  pl_diagnostic* m = pl_complain(p->job, PL_E001, (pl_span){p->source, before->begin, t->end},
                                 PL_BOTH("an = is missing after %s"), left);
  if (t->kind == TOK_NAME && !has(expected, n, TOK_NAME)) {
    pl_suggest(p->job, m, NULL, PL_BOTH("write %1$s = %2$s ...  or, for two names,  %1$s, %2$s"),
               left, right);
  } else {
    pl_suggest(p->job, m, pl_format(p->arena, "%s = %s", left, right), PL_BOTH("write %s = %s"),
               left, right);
  }
  return true;
}

static bool missing_comma(pl_parse* p, const int* expected, int n) {
  const pl_token *t = &p->tokens->list.at[p->at], *before = token_near(p, p->at, -1);
  if (t->kind != TOK_NAME || before->kind != TOK_NAME || !has(expected, n, ',')
      || has(expected, n, '/'))
    return false;
  const char* left = pl_source_text(p->arena, (pl_span){p->source, before->begin, before->end});
  const char* right = pl_source_text(p->arena, (pl_span){p->source, t->begin, t->end});
  pl_diagnostic* m = pl_complain(p->job, PL_E001, (pl_span){p->source, before->begin, t->end},
                                 PL_BOTH("a comma is missing between %s and %s"), left, right);
  pl_suggest(p->job, m, pl_format(p->arena, "%s, %s", left, right), PL_BOTH("write %s, %s"), left,
             right);
  return true;
}

void pl_parse_complain(pl_parse* p, const int* expected, int n) {
  if (p->said) return;
  p->said = true;
  if (decimal_comma(p) || pl_slip(p) || reserved_name(p, expected, n)
      || line_ends_early(p, expected, n) || missing_comma(p, expected, n))
    return;
  if (missing_equals(p, expected, n)) return;
  const pl_token* t = &p->tokens->list.at[p->at];
  pl_span span = {p->source, t->begin, t->end};
  const char* text = pl_source_text(p->arena, span);
  pl_diagnostic* m = pl_complain(p->job, PL_E001, span, PL_BOTH("%s does not fit here"), text);
  const char* en = list_expected(p->arena, expected, n, false);
  if (en)
    pl_because(p->job, m, "expected: %1$s%2$.0s", "erwartet: %1$.0s%2$s", en,
               list_expected(p->arena, expected, n, true));
}
