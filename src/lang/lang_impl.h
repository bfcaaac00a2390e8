// What the rooms of lang share: tokens, the parser's state, complaints in two languages.
#ifndef PL_LANG_IMPL_H
#define PL_LANG_IMPL_H

#include "lang/lang.h"
#include "lang/syntax.h"

// ------------------------------------------------------------------------------------------ tokens
// Kinds above 0 are those of the grammar; these never reach it.
enum {
  PL_TOKEN_COMMENT = -2,
  PL_TOKEN_PRINTED = -3 /* #: */,
  PL_TOKEN_WRONG = -4 /* complained about by the lexer */
};

typedef struct pl_token {
  int kind;
  uint32_t begin, end;
  bool tight;                     // nothing between it and the token before
  bool first;                     // first of its line
  const char* text;               // numbers, strings, units, comments: without their marks
  const char *key, *shown, *raw;  // names, see pl_ast
  int number;                     // dots of a name, count of primes, value of a superscript
} pl_token;

typedef struct pl_tokens {
  PL_VEC(pl_token) list;  // the last one is the end of the file, kind 0
  const pl_source* source;
} pl_tokens;

// pl_lex cuts a text into tokens.  What does not belong is reported and left out.
void pl_lex(pl_job* job, pl_names* names, const pl_source* source, pl_tokens* out);

// ------------------------------------------------------------------------------------------- names
typedef struct pl_spelled {
  const char *key, *shown, *raw;
  int dots;              // dots over letters: ẋ is x with 1
  bool theta, vartheta;  // which of the two spellings of theta occurs
} pl_spelled;
// pl_spell reads the spelling of a name. false: a code point in it has no place in a name; *bad is
// its offset.
bool pl_spell(pl_arena* a, pl_names* names, const char* s, size_t n, pl_spelled* out, size_t* bad);
// An ASCII name with Greek letters for their words: θ1 for theta1.
const char* pl_spell_unicode(pl_arena* a, const char* name);

// What a code point was probably meant to be: ASCII replacement and what it is called, or NULL.
const char* pl_look_alike(uint32_t code_point, const char** what);

// ------------------------------------------------------------------------------------------- words
int pl_word_statement(const char* s);  // token of a statement keyword, 0 if it is none
int pl_word_item(const char* s);
int pl_word_reserved(const char* s);   // small words only
bool pl_word_function(const char* s);  // sin, norm, sum, ...
const char* pl_word_of_statement(int token);
const char* pl_word_of_item(int token);
// the i-th word that begins a request, NULL after the last
const char* pl_word_of_request(int i);
const char* pl_word_near_statement(const char* s);  // the nearest statement keyword, or NULL

// -------------------------------------------------------------------------------------- complaints
// pl_complain reports in both languages; both formats take the same arguments in the same order.
pl_diagnostic* pl_complain(pl_job* job, pl_code code, pl_span span, const char* en, const char* de,
                           ...);
// pl_suggest adds the fix; replacement may be NULL.
void pl_suggest(pl_job* job, pl_diagnostic* m, const char* replacement, const char* en,
                const char* de, ...);
void pl_because(pl_job* job, pl_diagnostic* m, const char* en, const char* de, ...);
const char* pl_source_text(pl_arena* a, pl_span s);  // the source under a span, blanks collapsed

// ------------------------------------------------------------------------------------------- slips
struct pl_parse;
// what was typed is a known slip, and has been told with its fix
bool pl_slip(struct pl_parse* p);
// the statement that a word of another language means, or NULL
const char* pl_slip_statement(const char* typed);
const char* pl_slip_request(const char* typed);  // the request or result, likewise

// ------------------------------------------------------------------------------------------ parser
enum { PL_MAX_DEPTH = 200, PL_MAX_BLOCKS = 16 };  // of brackets and of `for` inside each other

// A statement as tokens: those from first up to end.
typedef struct pl_parsed_statement {
  int first, end;
  int keyword;  // 0: none
  bool broken;  // an error was reported inside
} pl_parsed_statement;

// What the parser was about to read at the end of a text that is cut off.
typedef struct pl_parse_place {
  bool at_statement;     // a statement may begin
  bool fits;             // no error in the statement so far
  bool in_block;         // inside `for`
  int statement;         // its keyword, 0 before it
  int last;              // kind of the token before
  int item;              // request being read
  int depth, bracket;    // open brackets; token of the innermost, -1
  PL_VEC(int) expected;  // kinds of tokens that fit
} pl_parse_place;

typedef struct pl_parse {
  pl_job* job;
  pl_arena* arena;
  const pl_source* source;
  const pl_tokens* tokens;
  int* kinds;                // what each token was pushed as; 0: not pushed          (tokens)
  int at;                    // the token being pushed
  int statement_first;       // first token of the statement
  bool said;                 // something was reported about this statement
  int lost_braces;           // { swallowed by a broken statement
  pl_ast* root;              // PL_AST_FILE, or the expression
  PL_VEC(const char*) lost;  // names that broken declarations would have declared
  PL_VEC(pl_parsed_statement) statements;
  pl_parse_place* place;  // the text is cut off: what could follow goes here; NULL
} pl_parse;

// pl_parse_text reads a whole source into a tree; pl_parse_expression a single expression.
void pl_parse_text(pl_parse* p, pl_job* job, pl_names* names, const pl_source* source);
pl_ast* pl_parse_expression(pl_parse* p, pl_job* job, pl_names* names, const pl_source* source);
// pl_parse_cut reads a text that ends at a cursor, and tells what could follow there.
void pl_parse_cut(pl_parse* p, pl_job* job, pl_names* names, const pl_source* source,
                  pl_parse_place* out);

// For the grammar: nodes.
typedef struct pl_bytes {
  uint32_t begin, end;
} pl_bytes;
pl_ast* pl_ast_zero(pl_parse* p, pl_bytes at);
pl_ast* pl_ast_make(pl_parse* p, pl_ast_kind kind, pl_bytes at);
pl_ast* pl_ast_of_token(pl_parse* p, int kind, const pl_token* t);
// n children, NULL allowed
pl_ast* pl_ast_with(pl_parse* p, pl_ast_kind kind, pl_bytes at, int n, ...);
pl_ast* pl_ast_append(pl_parse* p, pl_ast* list, char op, pl_ast* kid, pl_bytes at);
pl_ast* pl_ast_statement(pl_parse* p, int token, pl_bytes at, int n, ...);
pl_ast* pl_ast_item(pl_parse* p, int token, pl_bytes at, int n, ...);
pl_ast* pl_ast_option(pl_parse* p, const char* word, pl_bytes at, pl_ast* value, pl_ast* second);

// Says what is wrong at the token p->at, with what would have been right there.
void pl_parse_complain(pl_parse* p, const int* expected, int n_expected);

#endif
