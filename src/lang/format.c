// Formatter: the canonical layout of a model text. It works on the tokens, so comments and blank
// lines stay and nothing changes its meaning: where a blank means a product it stays a blank, a
// bracket that touches its name goes on touching.
#include "lang/lang_impl.h"

#include <string.h>

#include "grammar.h"

typedef struct line {
  const char* code;
  const char* comment;  // with its mark, or NULL
  bool blank;
} line;

typedef struct formatter {
  pl_arena* arena;
  const pl_parse* p;
  pl_spelling spelling;
  PL_VEC(line) lines;
  pl_text code;  // of the line being built
  const char* comment;
  int depth;        // of blocks
  int last;         // kind written last, 0 at the start of a statement
  bool last_unary;  // it was a sign
  bool in_statement, continued;
  bool words;  // the statement is made of words with hyphens, lambda-minus: no blank comes in
  int dots_to_write;  // primes that wait for the end of an index
  int brackets;
} formatter;

// ------------------------------------------------------------------------------------------- lines
static void flush(formatter* f) {
  if (f->code.n == 0 && f->comment == NULL) return;
  pl_push(f->arena, f->lines, (line){pl_text_string(&f->code), f->comment, false});
  f->code = pl_text_make(f->arena);
  f->comment = NULL;
}

static void blank_line(formatter* f) {
  if (f->lines.n && !f->lines.at[f->lines.n - 1].blank)
    pl_push(f->arena, f->lines, (line){"", NULL, true});
}

static void indent(formatter* f) {
  if (f->code.n == 0) pl_text_pad(&f->code, 4 * (f->depth + (f->continued ? 1 : 0)));
}

// --------------------------------------------------------------------------------------- spellings
static const char* source_of(const formatter* f, const pl_token* t) {
  return pl_copy_n(f->arena, f->p->source->text + t->begin, t->end - t->begin);
}

static bool is_ascii(const char* s) {
  for (; *s; s++) {
    if ((unsigned char)*s & 0x80) return false;
  }
  return true;
}

static const char* ascii_unit(formatter* f, const char* unit) {
  static const struct {
    const char *from, *to;
  } words[] = {
      {"²", "^2"},   {"³", "^3"},  {"⁴", "^4"},  {"⁻¹", "^-1"}, {"⁻²", "^-2"},
      {"⁻³", "^-3"}, {"·", "*"},   {"⋅", "*"},   {"°", "deg"},  {"µ", "u"},
      {"μ", "u"},    {"Ω", "Ohm"}, {"Ω", "Ohm"},
  };
  pl_text out = pl_text_make(f->arena);
  for (const char* s = unit; *s;) {
    size_t n = 0;
    for (size_t i = 0; i < sizeof words / sizeof words[0] && !n; i++) {
      n = strlen(words[i].from);
      if (strncmp(s, words[i].from, n) == 0) pl_text_add(&out, words[i].to);
      else n = 0;
    }
    if (n == 0) pl_text_add_n(&out, s, n = 1);
    s += n;
  }
  return pl_text_string(&out);
}

static const char* trimmed(formatter* f, const char* s) {
  while (*s == ' ' || *s == '\t') s++;
  size_t n = strlen(s);
  while (n && (s[n - 1] == ' ' || s[n - 1] == '\t')) n--;
  return pl_copy_n(f->arena, s, n);
}

static const char* primes(int n) { return n == 2 ? "''" : n == 1 ? "'" : ""; }

static const char* name_text(formatter* f, const pl_token* t, int next) {
  const char* source = source_of(f, t);
  if (f->spelling == PL_SPELL_KEEP) return source;
  bool root = strcmp(source, "√") == 0;
  // underscores stay: x_0 may be a start value
  bool plain = is_ascii(source) || t->number == 0;  // no dots over its letters
  const char* name = f->spelling == PL_SPELL_ASCII ? (is_ascii(source) ? source : t->key)
                     : root                        ? source
                     : plain                       ? pl_spell_unicode(f->arena, source)
                                                   : t->shown;
  if (t->number == 0) return name;
  if (next == '[') {
    f->dots_to_write = t->number;
    return name;
  }
  return pl_format(f->arena, "%s%s", name, primes(t->number));
}

static const char* sign_text(formatter* f, const pl_token* t) {
  static const struct {
    int kind;
    const char* ascii;
  } signs[] = {
      {'*', "*"},
      {'-', "-"},
      {TOK_GE, ">="},
      {TOK_LE, "<="},
      {TOK_NE, "!="},
      {TOK_ARROW, "->"},
      {TOK_MUCH, ">>"},
      {TOK_INFINITY, "inf"},
      {TOK_DEGREE, " [deg]"},
  };
  if (f->spelling != PL_SPELL_ASCII) return source_of(f, t);
  for (size_t i = 0; i < sizeof signs / sizeof signs[0]; i++) {
    if (signs[i].kind == t->kind) return signs[i].ascii;
  }
  return source_of(f, t);
}

static const char* token_text(formatter* f, const pl_token* t, int next) {
  switch (t->kind) {
    case TOK_NAME: return name_text(f, t, next);
    case TOK_PI:
      return f->spelling == PL_SPELL_ASCII     ? "pi"
             : f->spelling == PL_SPELL_UNICODE ? "π"
                                               : source_of(f, t);
    case TOK_PRIMES: return f->spelling == PL_SPELL_KEEP ? source_of(f, t) : primes(t->number);
    case TOK_SUPER:
      return f->spelling == PL_SPELL_ASCII ? pl_format(f->arena, "^%d", t->number)
                                           : source_of(f, t);
    case TOK_UNIT: {
      const char* unit = trimmed(f, t->text);
      return pl_format(f->arena, "[%s]",
                       f->spelling == PL_SPELL_ASCII ? ascii_unit(f, unit) : unit);
    }
    default: return sign_text(f, t);
  }
}

// ------------------------------------------------------------------------------------------ blanks
static bool is_operand_end(int kind) {
  return kind == TOK_NAME || kind == TOK_NUMBER || kind == TOK_PI || kind == TOK_INFINITY
         || kind == TOK_PRIMES || kind == TOK_SUPER || kind == TOK_UNIT || kind == TOK_DEGREE
         || kind == ')' || kind == ']' || kind == TOK_TEXT;
}

static bool is_relation(int kind) {
  return kind == '=' || kind == '<' || kind == '>' || kind == TOK_GE || kind == TOK_LE
         || kind == TOK_NE || kind == TOK_ARROW || kind == TOK_MUCH;
}

static bool is_keyword(int kind) { return kind >= TOK_PLEUEL; }

// Is there a blank between what was written last and this token?
static bool blank_before(const formatter* f, int kind, const pl_token* t, bool word_pair) {
  int last = f->last;
  if (last == 0) return false;
  switch (kind) {
    case ')':
    case ']':
    case ',':
    case TOK_SEPARATOR:
    case ':':
    case TOK_DEGREE:
    case TOK_PRIMES:
    case TOK_SUPER:
    case TOK_RANGE:
    case '^':
    case '/':
    case '*': return false;
    case TOK_UNIT:
    case '{': return true;
    default: break;
  }
  if (last == ',' || last == TOK_SEPARATOR || last == ':') return true;
  if (f->words && last != TOK_CONVENTION) return !t->tight;
  if (last == '(' || last == '[' || last == TOK_RANGE || last == '^' || last == '/' || last == '*')
    return false;
  if (kind == '[' || f->last_unary) return false;
  // x[i-1]
  if (f->brackets && (kind == '+' || kind == '-' || last == '+' || last == '-')) return false;
  if (is_relation(kind) || is_relation(last) || kind == '+' || kind == '-' || last == '+'
      || last == '-')
    return true;
  if (is_keyword(kind) || is_keyword(last)) return true;
  return word_pair || !t->tight;
}

static bool word_end(const pl_text* code) {
  if (code->n == 0) return false;
  char c = code->at[code->n - 1];
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

// Two words that would grow together when spelled out: πR is pi R.
static bool grows_together(const formatter* f, int kind, const char* text) {
  bool word = (text[0] >= 'a' && text[0] <= 'z') || (text[0] >= 'A' && text[0] <= 'Z')
              || (text[0] >= '0' && text[0] <= '9');
  if (!word || !word_end(&f->code)) return false;
  return f->last != TOK_NUMBER || kind == TOK_NUMBER;
}

// -------------------------------------------------------------------------------------- statements
static int next_kind(const formatter* f, int i) {
  for (i++; i < f->p->tokens->list.n; i++) {
    if (f->p->tokens->list.at[i].kind > 0) return f->p->tokens->list.at[i].kind;
  }
  return 0;
}

static void write_token(formatter* f, int i) {
  const pl_token* t = &f->p->tokens->list.at[i];
  int kind = f->p->kinds[i] ? f->p->kinds[i] : t->kind;
  const char* text = token_text(f, t, next_kind(f, i));
  bool at_start = f->code.n == 0;
  if (!f->in_statement) f->words = kind == TOK_CONVENTION;
  indent(f);
  if (!at_start && blank_before(f, kind, t, grows_together(f, kind, text)) && text[0] != ' ')
    pl_text_add(&f->code, " ");
  pl_text_add(&f->code, text);
  if (kind == '[') f->brackets++;
  if (kind == ']' && f->brackets) f->brackets--;
  if (kind == ']' && f->dots_to_write && f->brackets == 0) {
    pl_text_add(&f->code, primes(f->dots_to_write));
    f->dots_to_write = 0;
  }
  f->last_unary = (kind == '-' || kind == '+') && !is_operand_end(f->last);
  f->last = kind;
  f->in_statement = true;
}

static void write_comment(formatter* f, const pl_token* t) {
  const char* mark = t->kind == PL_TOKEN_PRINTED ? "#:" : "#";
  const char* text = t->text;
  bool spaced = text[0] == 0 || text[0] == ' ' || text[0] == '\t' || text[0] == '#'
                || text[0] == '!' || text[0] == '-' || text[0] == '=';
  const char* comment = pl_format(f->arena, "%s%s%s", mark, spaced ? "" : " ", text);
  if (f->code.n) {
    f->comment = comment;
    return;
  }
  indent(f);
  pl_text_add(&f->code, comment);
  flush(f);
}

static void end_of_line(formatter* f, int i, int* newlines) {
  bool goes_on = f->in_statement && f->p->kinds[i] != TOK_EOL && f->last != '{' && f->last != '}';
  bool empty = f->code.n == 0 && f->comment == NULL;
  if (empty) ++*newlines;
  else *newlines = 1;
  flush(f);
  if (*newlines > 1 && !goes_on) blank_line(f);
  f->continued = goes_on;
  if (!goes_on) {
    f->in_statement = false;
    f->last = 0;
    f->last_unary = false;
  }
}

static void open_block(formatter* f, int i, int* newlines) {
  write_token(f, i);
  // a comment behind the brace belongs to its line
  int k = i + 1;
  const pl_tokens* all = f->p->tokens;
  if (all->list.at[k].kind == PL_TOKEN_COMMENT || all->list.at[k].kind == PL_TOKEN_PRINTED) {
    f->depth++;
    f->last = '{';
    return;
  }
  flush(f);
  f->depth++;
  f->last = 0;
  f->in_statement = f->continued = false;
  *newlines = 0;
}

static void close_block(formatter* f, int i) {
  flush(f);
  f->continued = false;
  // no blank line before a closing brace
  if (f->lines.n && f->lines.at[f->lines.n - 1].blank) f->lines.n--;
  if (f->depth) f->depth--;
  f->last = 0;
  write_token(f, i);
  int next = f->p->tokens->list.at[i + 1].kind;
  if (next > 0 && next != TOK_EOL) {
    flush(f);
    f->last = 0;
    f->in_statement = false;
  }
}

static void format_tokens(formatter* f) {
  const pl_tokens* tokens = f->p->tokens;
  int newlines = 1;
  for (int i = 0; i < tokens->list.n - 1; i++) {
    const pl_token* t = &tokens->list.at[i];
    if (t->kind == PL_TOKEN_COMMENT || t->kind == PL_TOKEN_PRINTED) write_comment(f, t);
    else if (t->kind == TOK_EOL) end_of_line(f, i, &newlines);
    else if (t->kind == '{') open_block(f, i, &newlines);
    else if (t->kind == '}') close_block(f, i);
    else write_token(f, i);
    if (t->kind != TOK_EOL && t->kind != '{') newlines = 0;
  }
  flush(f);
}

// ----------------------------------------------------------------------------- comments in columns
static const char* lay_out(formatter* f) {
  pl_text out = pl_text_make(f->arena);
  int n = f->lines.n;
  while (n && f->lines.at[n - 1].blank) n--;
  int width = 0, until = -1;
  for (int i = 0; i < n; i++) {
    const line* l = &f->lines.at[i];
    if (l->comment && i > until) {
      // neighbours with comments share a column
      width = 0;
      for (until = i; until < n && f->lines.at[until].comment; until++) {
        int w = pl_utf8_width(f->lines.at[until].code);
        if (w > width) width = w;
      }
      until--;
    }
    pl_text_add(&out, l->code);
    if (l->comment) {
      pl_text_pad(&out, width - pl_utf8_width(l->code) + 2);
      pl_text_add(&out, l->comment);
    }
    pl_text_add(&out, "\n");
  }
  return pl_text_string(&out);
}

pleuel_status pl_lang_format(pl_job* job, const pl_source* source, pl_spelling spelling,
                             const char** out) {
  *out = NULL;
  int before = job->diagnostics->n_errors;
  pl_parse* p = PL_NEW(job->arena, pl_parse);
  pl_parse_text(p, job, pl_names_make(job->arena), source);
  if (job->diagnostics->n_errors > before) return PLEUEL_MODEL_ERROR;
  formatter* f = PL_NEW(job->arena, formatter);
  *f = (formatter){
      .arena = job->arena, .p = p, .spelling = spelling, .code = pl_text_make(job->arena)};
  format_tokens(f);
  *out = lay_out(f);
  return PLEUEL_OK;
}
