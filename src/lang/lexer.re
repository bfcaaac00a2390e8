// Lexer: UTF-8 text into tokens with byte spans.  re2c builds the automaton; the text ends with NUL, so no refilling.
// What does not belong is reported here, once, with what was probably meant; where that is clear the token goes on as if
// it had been written, so that one wrong character costs one message.
#include "lang/lang_impl.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "grammar.h"

typedef struct lexer {
  pl_job* job;
  pl_names* names;
  const pl_source* source;
  pl_tokens* out;
  const char *start, *end;   // of the text
  const char* token;         // start of the token being read
  uint32_t last_end;         // end of the token before
  bool line_start;
  bool said_encoding;        // a file in another encoding is one mistake
  int n_semicolons, semicolon;   // how many, and the message about the first: a habit costs one message
  uint32_t wrong_before;     // character complained about last on this line, so that |x| costs one message
} lexer;

static uint32_t offset(const lexer* x, const char* s) { return (uint32_t)(s - x->start); }

static pl_span span_to(const lexer* x, const char* cursor) {
  return (pl_span){x->source, offset(x, x->token), offset(x, cursor)};
}

static pl_token* emit(lexer* x, int kind, const char* cursor) {
  pl_token t = {.kind = kind, .begin = offset(x, x->token), .end = offset(x, cursor)};
  t.tight = !x->line_start && t.begin == x->last_end;
  t.first = x->line_start && kind > 0 && kind != TOK_EOL;
  if (kind > 0 || kind == PL_TOKEN_WRONG) x->line_start = kind == TOK_EOL || (x->line_start && kind == PL_TOKEN_WRONG);
  x->last_end = t.end;
  pl_push(x->job->arena, x->out->list, t);
  return &x->out->list.at[x->out->list.n - 1];
}

static const pl_token* previous(const lexer* x) {
  return x->out->list.n ? &x->out->list.at[x->out->list.n - 1] : NULL;
}

static bool previous_is_operand(const lexer* x, bool tight) {
  const pl_token* t = previous(x);
  if (t == NULL || (tight && t->end != offset(x, x->token))) return false;
  return t->kind == TOK_NAME || t->kind == TOK_PRIMES || t->kind == ')' || t->kind == ']';
}

// ---------------------------------------------------------------------------------------------- encoding
static void complain_encoding(lexer* x, const char* at, const char* end) {
  if (x->said_encoding) return;
  x->said_encoding = true;
  pl_span span = {x->source, offset(x, at), offset(x, end)};
  if (*at == 0) {
    pl_diagnostic* m = pl_complain(x->job, PL_E009, span, PL_BOTH("a NUL byte in the text"));
    pl_suggest(x->job, m, "", PL_BOTH("remove it"));
    return;
  }
  pl_diagnostic* m = pl_complain(x->job, PL_E009, span, PL_BOTH("byte 0x%02X is not UTF-8"), (unsigned char)*at);
  pl_suggest(x->job, m, NULL, PL_BOTH("save the file as UTF-8"));
}

// Comments, texts and units are taken as they are, as long as they are text.
static void check_encoding(lexer* x, const char* s, const char* end) {
  for (uint32_t c; s < end;) {
    int n = *s ? pl_utf8_decode(s, end, &c) : 0;
    if (n == 0) complain_encoding(x, s, s + 1);
    s += n ? n : 1;
  }
}

// ---------------------------------------------------------------------------------------------- single tokens
static const char* piece(lexer* x, const char* from, const char* to) {
  return pl_copy_n(x->job->arena, from, (size_t)(to - from));
}

// Numbers are exact, so 1e999999999 would be a number of a billion digits.
enum { MAX_DIGITS = 400, MAX_EXPONENT = 400 };
static void lex_number(lexer* x, const char* cursor) {
  const char* e = x->token;
  while (e < cursor && *e != 'e' && *e != 'E') e++;
  long exponent = e < cursor ? strtol(e + 1, NULL, 10) : 0;
  pl_token* t = emit(x, TOK_NUMBER, cursor);
  t->text = piece(x, x->token, cursor);
  if (e - x->token <= MAX_DIGITS && labs(exponent) <= MAX_EXPONENT) return;
  t->text = "1";
  t->kind = PL_TOKEN_WRONG;
  pl_diagnostic* m = pl_complain(x->job, PL_E007, span_to(x, cursor),
    PL_BOTH("this number has more than %d digits"), MAX_DIGITS);
  pl_because(x->job, m, PL_BOTH("numbers are kept exactly"));
  emit(x, TOK_NUMBER, cursor)->text = "1";
}

static void lex_name(lexer* x, const char* cursor) {
  pl_spelled s;
  size_t bad;
  if (!pl_spell(x->job->arena, x->names, x->token, (size_t)(cursor - x->token), &s, &bad)) {
    const char* at = x->token + bad;
    uint32_t c = 0;
    int n = pl_utf8_decode(at, x->end, &c);
    pl_span span = {x->source, offset(x, at), offset(x, at) + (uint32_t)(n ? n : 1)};
    const char* what;
    const char* meant = pl_look_alike(c, &what);
    pl_diagnostic* m = pl_complain(x->job, PL_E002, span, PL_BOTH("U+%04X has no place in a name"), c);
    if (meant) pl_suggest(x->job, m, meant, PL_BOTH("write %s"), meant);
    emit(x, PL_TOKEN_WRONG, cursor);
    s = (pl_spelled){.key = pl_intern(x->names, "?"), .shown = "?", .raw = "?"};
  }
  if (s.dots > 2) {
    pl_complain(x->job, PL_E001, span_to(x, cursor), PL_BOTH("only first and second derivatives can be written"));
    emit(x, PL_TOKEN_WRONG, cursor);
    s.dots = 2;
  }
  bool is_pi = strcmp(s.key, "pi") == 0;
  pl_token* t = emit(x, is_pi ? TOK_PI : TOK_NAME, cursor);
  t->key = s.key, t->shown = s.shown, t->raw = s.raw, t->number = s.dots;
}

static void lex_primes(lexer* x, const char* cursor) {
  int n = 0;
  for (const char* s = x->token; s < cursor;) {
    uint32_t c;
    int used = pl_utf8_decode(s, cursor, &c);
    s += used;
    n += c == 0x2033 ? 2 : 1;
  }
  const pl_token* before = previous(x);
  bool fits = before && before->end == offset(x, x->token) && (previous_is_operand(x, true) || before->kind == TOK_SUPER);
  if (!fits) {
    pl_complain(x->job, PL_E002, span_to(x, cursor), PL_BOTH("a prime must follow a name directly"));
    emit(x, PL_TOKEN_WRONG, cursor);
    return;
  }
  if (n > 2) {
    pl_diagnostic* m = pl_complain(x->job, PL_E001, span_to(x, cursor), PL_BOTH("only first and second derivatives can be written"));
    pl_suggest(x->job, m, NULL, PL_BOTH("write dt(x'')"));
    emit(x, PL_TOKEN_WRONG, cursor);
    n = 2;
  }
  emit(x, TOK_PRIMES, cursor)->number = n;
}

static void lex_superscript(lexer* x, const char* cursor) {
  long value = 0;
  bool minus = false;
  for (const char* s = x->token; s < cursor;) {
    uint32_t c;
    s += pl_utf8_decode(s, cursor, &c);
    if (c == 0x207b) { minus = true; continue; }
    int digit = c == 0xb9 ? 1 : c == 0xb2 ? 2 : c == 0xb3 ? 3 : (int)(c - 0x2070);
    if (value < 100000) value = 10 * value + digit;
  }
  emit(x, TOK_SUPER, cursor)->number = (int)(minus ? -value : value);
}

// A unit is one token: what stands between its brackets has a grammar of its own.
static const char* lex_unit(lexer* x, const char* cursor) {
  const char* close = cursor;
  while (close < x->end && *close != ']' && *close != '\n' && *close != '#' && *close != '[') close++;
  if (close >= x->end || *close != ']') {
    while (close > cursor && (close[-1] == ' ' || close[-1] == '\r' || close[-1] == '\t')) close--;
    pl_diagnostic* m = pl_complain(x->job, PL_E008, span_to(x, cursor), PL_BOTH("this bracket is not closed"));
    const char* comma = memchr(cursor, ',', (size_t)(close - cursor));
    if (comma) close = comma;
    pl_suggest(x->job, m, NULL, PL_BOTH("write [%s]"), piece(x, cursor, close));
    emit(x, PL_TOKEN_WRONG, cursor);
    emit(x, TOK_UNIT, close)->text = piece(x, cursor, close);
    return close;
  }
  check_encoding(x, cursor, close);
  emit(x, TOK_UNIT, close + 1)->text = piece(x, cursor, close);
  return close + 1;
}

// ---------------------------------------------------------------------------------------------- quotation marks, wrong characters
static const char* lex_quote(lexer* x, const char* cursor) {
  if (previous_is_operand(x, true)) {
    pl_span span = span_to(x, cursor);
    pl_diagnostic* m = pl_complain(x->job, PL_E005, span, PL_BOTH("a quotation mark after a name"));
    pl_suggest(x->job, m, "''", PL_BOTH("did you mean '' (two primes)?"));
    emit(x, PL_TOKEN_WRONG, cursor);
    emit(x, TOK_PRIMES, cursor)->number = 2;
    return cursor;
  }
  const char* close = cursor;
  while (close < x->end && *close != '"' && *close != '\n' && *close != '\r') close++;
  check_encoding(x, cursor, close);
  if (close < x->end && *close == '"') {
    emit(x, TOK_TEXT, close + 1)->text = piece(x, cursor, close);
    return close + 1;
  }
  pl_diagnostic* m = pl_complain(x->job, PL_E008, span_to(x, cursor), PL_BOTH("this quotation mark is not closed"));
  pl_suggest(x->job, m, NULL, PL_BOTH("add \" at the end of the text"));
  emit(x, PL_TOKEN_WRONG, cursor);
  emit(x, TOK_TEXT, close)->text = piece(x, cursor, close);
  return close;
}

// A spelling of another language: say so, go on with ours.
static void lex_instead(lexer* x, const char* cursor, int kind, const char* ours) {
  const char* theirs = piece(x, x->token, cursor);
  pl_diagnostic* m = pl_complain(x->job, PL_E001, span_to(x, cursor), PL_BOTH("%s is not a sign of this language"), theirs);
  pl_suggest(x->job, m, ours, PL_BOTH("write %s"), ours);
  emit(x, PL_TOKEN_WRONG, cursor);
  emit(x, kind, cursor);
}

static int kind_of_sign(const char* meant) {
  static const struct { const char* sign; int kind; } signs[] = {
    {"-", '-'}, {"/", '/'}, {"*", '*'}, {"..", TOK_RANGE}, {"°", TOK_DEGREE}, {"'", TOK_PRIMES}, {"(", '('}, {")", ')'},
    {",", ','}, {"+", '+'}, {"=", '='}, {":", ':'}, {">", '>'}, {"<", '<'},
  };
  for (size_t i = 0; i < sizeof signs / sizeof signs[0]; i++) {
    if (strcmp(signs[i].sign, meant) == 0) return signs[i].kind;
  }
  return 0;
}

static const char* lex_wrong(lexer* x, const char* cursor, uint32_t c) {
  if (c == x->wrong_before) {
    emit(x, PL_TOKEN_WRONG, cursor);
    return cursor;
  }
  x->wrong_before = c;
  const char* what;
  const char* meant = pl_look_alike(c, &what);
  const char* shown = piece(x, x->token, cursor);
  pl_span span = span_to(x, cursor);
  pl_diagnostic* m;
  if (c < 0x20 || c == 0x7f) {
    m = pl_complain(x->job, PL_E002, span, PL_BOTH("control character U+%04X"), c);
  } else if (meant && *meant && strcmp(what, "a Cyrillic letter") != 0) {
    m = pl_complain(x->job, PL_E002, span, PL_BOTH("%1$s is %2$s%3$.0s"), shown, what, pl_german(what));
  } else if (meant) {
    m = pl_complain(x->job, PL_E002, span, PL_BOTH("U+%1$04X is %2$s%3$.0s"), c, what, pl_german(what));
  } else if (c == ';' && x->n_semicolons > 0) {
    x->n_semicolons++;
    emit(x, PL_TOKEN_WRONG, cursor);
    return cursor;
  } else if (c == ';') {
    m = pl_complain(x->job, PL_E002, span, PL_BOTH("; does not belong here"));
    pl_because(x->job, m, PL_BOTH("one statement per line"));
    pl_suggest(x->job, m, "", PL_BOTH("remove it, or start a new line"));
    x->n_semicolons = 1;
    x->semicolon = x->job->diagnostics->list.n - 1;
  } else if (c == '.') {
    m = pl_complain(x->job, PL_E002, span, PL_BOTH("a dot that belongs to no number"));
    pl_suggest(x->job, m, NULL, PL_BOTH("write 1.0 or 0.5 in full"));
  } else if (c == '|') {
    m = pl_complain(x->job, PL_E002, span, PL_BOTH("| does not belong here"));
    pl_suggest(x->job, m, NULL, PL_BOTH("write abs(x) for the absolute value"));
  } else {
    m = pl_complain(x->job, PL_E002, span, PL_BOTH("%s does not belong here"), shown);
  }
  if (meant && *meant) pl_suggest(x->job, m, meant, PL_BOTH("write %s"), meant);
  if (meant && !*meant) pl_suggest(x->job, m, "", PL_BOTH("remove it"));
  emit(x, PL_TOKEN_WRONG, cursor);
  int kind = meant ? kind_of_sign(meant) : 0;
  if (kind) emit(x, kind, cursor)->number = 1;
  return cursor;
}

static const char* lex_invalid(lexer* x, const char* cursor) {
  // one message for a run of bytes
  uint32_t c;
  while (cursor < x->end && (unsigned char)*cursor >= 0x80 && pl_utf8_decode(cursor, x->end, &c) == 0) cursor++;
  complain_encoding(x, x->token, cursor);
  emit(x, PL_TOKEN_WRONG, cursor);
  return cursor;
}

static const char* line_end(const lexer* x, const char* s) {
  while (s < x->end && *s != '\n') s++;
  return s;
}

// \dot{x}: the braces belong to the command.  Returns where to go on.
static const char* lex_dotted(lexer* x, const char* cursor, int dots) {
  const char *begin = *cursor == '{' ? cursor + 1 : cursor, *stop = begin;
  while (*stop == ' ') begin = ++stop;
  if (*stop == '\\') begin = ++stop;           // \dot{\theta}
  while (stop < x->end && (isalnum((unsigned char)*stop) || *stop == '_' || (unsigned char)*stop >= 0x80)) stop++;
  if (stop == begin) return NULL;
  const char* close = *cursor == '{' ? memchr(stop, '}', (size_t)(line_end(x, stop) - stop)) : stop;
  const char* name = piece(x, begin, stop);
  const char* ours = pl_format(x->job->arena, "%s%s", name, dots == 2 ? "''" : "'");
  pl_diagnostic* m = pl_complain(x->job, PL_E002, span_to(x, cursor), PL_BOTH("\\%s is a TeX command"), dots == 2 ? "ddot" : "dot");
  pl_suggest(x->job, m, ours, PL_BOTH("write %s"), ours);
  emit(x, PL_TOKEN_WRONG, cursor);
  x->token = begin;
  lex_name(x, stop);
  x->out->list.at[x->out->list.n - 1].number = dots;
  return close && *cursor == '{' ? close + 1 : stop;
}

static void lex_command(lexer* x, const char* cursor) {
  const char* name = piece(x, x->token + 1, cursor);
  pl_diagnostic* m = pl_complain(x->job, PL_E002, span_to(x, cursor), PL_BOTH("\\%s is a TeX command"), name);
  pl_suggest(x->job, m, name, PL_BOTH("write %s"), name);
  emit(x, PL_TOKEN_WRONG, cursor);
  x->token++;
  lex_name(x, cursor);
}

static const char* lex_comment(lexer* x, const char* cursor, bool printed) {
  const char* stop = line_end(x, cursor);
  const char* last = stop;
  while (last > cursor && (last[-1] == '\r' || last[-1] == ' ' || last[-1] == '\t')) last--;
  check_encoding(x, x->token, last);
  emit(x, printed ? PL_TOKEN_PRINTED : PL_TOKEN_COMMENT, last)->text = piece(x, cursor, last);
  return stop;
}

// ---------------------------------------------------------------------------------------------- the automaton
// Returns where to go on.
static const char* lex_one(lexer* x, const char* YYCURSOR) {
  const char* YYMARKER;
  x->token = YYCURSOR;
  /*!re2c
    re2c:define:YYCTYPE = "unsigned char";
    re2c:flags:utf-8 = 1;
    re2c:yych:conversion = 1;
    re2c:yyfill:enable = 0;
    re2c:indent:string = "  ";

    digit  = [0-9];
    greek  = [\u0391-\u03a1\u03a3-\u03a9\u03b1-\u03bf\u03c1-\u03c9\u03d1\u03d5\u03f0\u03f1\u03f5\u00b5\u2126\u2206];
    letter = [a-zA-Z\u00c0-\u00d6\u00d8-\u00f6\u00f8-\u024f\u1e00-\u1eff\u2113] | greek;
    mark   = [\u0300-\u036f];
    sub    = [\u2080-\u2089];
    cyril  = [\u0400-\u04ff];
    name   = letter (letter | digit | mark | sub | cyril | "_")*;
    power  = [\u00b9\u00b2\u00b3\u2070\u2074-\u2079];
    blank  = [ \t\u00a0\u2000-\u200a\u202f\u205f\u3000];

    blank+            { return YYCURSOR; }
    "\r"* "\n"        { emit(x, TOK_EOL, YYCURSOR); x->wrong_before = 0; return YYCURSOR; }
    "\r"              { return YYCURSOR; }
    "\x00"            {
                        if (YYCURSOR > x->end) return NULL;
                        complain_encoding(x, x->token, YYCURSOR);
                        emit(x, PL_TOKEN_WRONG, YYCURSOR);
                        return YYCURSOR;
                      }
    "#:"              { return lex_comment(x, YYCURSOR, true); }
    "#"               { return lex_comment(x, YYCURSOR, false); }
    "//"              {
                        const char* stop = line_end(x, YYCURSOR);
                        check_encoding(x, YYCURSOR, stop);
                        pl_diagnostic* m = pl_complain(x->job, PL_E002, span_to(x, YYCURSOR), "// does not start a comment", "// beginnt keinen Kommentar");
                        pl_suggest(x->job, m, "#", "write #", "schreibe #");
                        emit(x, PL_TOKEN_WRONG, stop);
                        return stop;
                      }
    digit+ ("." digit+)? ([eE] [+-]? digit+)?   { lex_number(x, YYCURSOR); return YYCURSOR; }
    name              { lex_name(x, YYCURSOR); return YYCURSOR; }
    "\u03c0"          { emit(x, TOK_PI, YYCURSOR); return YYCURSOR; }
    "\u221e"          { emit(x, TOK_INFINITY, YYCURSOR); return YYCURSOR; }
    "\u221a"          {
                        pl_token* t = emit(x, TOK_NAME, YYCURSOR);
                        t->key = t->raw = t->shown = pl_intern(x->names, "sqrt");
                        return YYCURSOR;
                      }
    ['\u2032\u2033]+  { lex_primes(x, YYCURSOR); return YYCURSOR; }
    "\u207b"? power+  { lex_superscript(x, YYCURSOR); return YYCURSOR; }
    "\u00b0"          { emit(x, TOK_DEGREE, YYCURSOR); return YYCURSOR; }
    "\""              { return lex_quote(x, YYCURSOR); }
    "["               {
                        const pl_token* t = previous(x);
                        bool touches = t && t->end == offset(x, x->token);
                        if (touches && t->kind == TOK_PRIMES) {
                          pl_diagnostic* m = pl_complain(x->job, PL_E025, span_to(x, YYCURSOR), "the prime comes after the index", "der Strich kommt hinter den Index");
                          pl_suggest(x->job, m, NULL, "write x[i]'", "schreibe x[i]'");
                          emit(x, PL_TOKEN_WRONG, YYCURSOR);
                        } else if (!touches || t->kind != TOK_NAME) {
                          return lex_unit(x, YYCURSOR);
                        }
                        emit(x, '[', YYCURSOR);
                        return YYCURSOR;
                      }
    [()\]{},:+/^=<>-] { emit(x, *x->token, YYCURSOR); return YYCURSOR; }
    "\u2212"          { emit(x, '-', YYCURSOR); return YYCURSOR; }
    [*\u00b7\u00d7\u22c5]   { emit(x, '*', YYCURSOR); return YYCURSOR; }
    ">=" | "\u2265"   { emit(x, TOK_GE, YYCURSOR); return YYCURSOR; }
    "<=" | "\u2264"   { emit(x, TOK_LE, YYCURSOR); return YYCURSOR; }
    "!=" | "\u2260"   { emit(x, TOK_NE, YYCURSOR); return YYCURSOR; }
    "->" | "\u2192"   { emit(x, TOK_ARROW, YYCURSOR); return YYCURSOR; }
    ">>" | "\u226b"   { emit(x, TOK_MUCH, YYCURSOR); return YYCURSOR; }
    ".."              { emit(x, TOK_RANGE, YYCURSOR); return YYCURSOR; }
    "..."             { lex_instead(x, YYCURSOR, TOK_RANGE, ".."); return YYCURSOR; }
    "==" | ":="       { lex_instead(x, YYCURSOR, '=', "="); return YYCURSOR; }
    "=>"              { lex_instead(x, YYCURSOR, TOK_GE, ">="); return YYCURSOR; }
    "=<"              { lex_instead(x, YYCURSOR, TOK_LE, "<="); return YYCURSOR; }
    "<>"              { lex_instead(x, YYCURSOR, TOK_NE, "!="); return YYCURSOR; }
    "**"              { lex_instead(x, YYCURSOR, '^', "^"); return YYCURSOR; }
    "\ufffd"          {
                        pl_diagnostic* m = pl_complain(x->job, PL_E009, span_to(x, YYCURSOR), "a character was lost when the file was converted",
                                                       "ein Zeichen ging beim Umwandeln der Datei verloren");
                        pl_suggest(x->job, m, NULL, "type it again", "neu eingeben");
                        emit(x, PL_TOKEN_WRONG, YYCURSOR);
                        return YYCURSOR;
                      }
    "\\" "d"{1,2} "ot"   {
                        const char* next = lex_dotted(x, YYCURSOR, (int)(YYCURSOR - x->token) - 3);
                        if (next) return next;
                        lex_command(x, YYCURSOR);
                        return YYCURSOR;
                      }
    "\\" [a-zA-Z]+    { lex_command(x, YYCURSOR); return YYCURSOR; }
    [^]               {
                        uint32_t c = 0;
                        pl_utf8_decode(x->token, x->end, &c);
                        return lex_wrong(x, YYCURSOR, c);
                      }
    *                 { return lex_invalid(x, YYCURSOR); }
  */
}

static void count_semicolons(lexer* x) {
  if (x->n_semicolons < 2) return;
  pl_diagnostic* m = &x->job->diagnostics->list.at[x->semicolon];
  int more = x->n_semicolons - 1;
  m->sentence[PL_ENGLISH] = pl_format(x->job->arena, "; does not belong here, and %d more do not", more);
  m->sentence[PL_GERMAN] = pl_format(x->job->arena, pl_german("; does not belong here, and %d more do not"), more);
}

void pl_lex(pl_job* job, pl_names* names, const pl_source* source, pl_tokens* out) {
  lexer x = {.job = job, .names = names, .source = source, .out = out, .start = source->text,
             .end = source->text + source->size, .line_start = true};
  out->source = source;
  const char* at = x.start;
  if (source->size >= 3 && memcmp(at, "\xef\xbb\xbf", 3) == 0) at += 3;  // byte order mark
  while (at && at <= x.end) at = lex_one(&x, at);
  x.token = x.end;
  if (out->list.n && out->list.at[out->list.n - 1].kind != TOK_EOL) emit(&x, TOK_EOL, x.end);
  emit(&x, 0, x.end);
  count_semicolons(&x);
}
