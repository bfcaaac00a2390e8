// outline: what an editor asks of a text.  The names that it declares and where they are used, its
// tokens, and what may stand at a place.  Made from the syntax alone, so a text with errors has an
// outline of all that can be read.
#ifndef PL_OUTLINE_H
#define PL_OUTLINE_H

#include "lang/lang.h"

// ORDER NAME KINDS: pleuel_kind in pleuel.h
typedef enum pl_named_kind {
  PL_NAMED_TIME,  // not declared
  PL_NAMED_COORDINATE,
  PL_NAMED_VELOCITY,  // not declared: made from coordinates by whoever lists names
  PL_NAMED_MULTIPLIER,
  PL_NAMED_OUTPUT,
  PL_NAMED_PARAMETER,
  PL_NAMED_INPUT,
  PL_NAMED_CONSTRAINT,
  PL_NAMED_MASS,
  PL_NAMED_BODY,
  PL_NAMED_POINT,
  PL_NAMED_FORCE,  // labels of forces, springs, dampers, potentials and so on
  PL_NAMED_EVENT,
  PL_NAMED_ABBREVIATION,
  PL_NAMED_FUNCTION,
  PL_NAMED_INDEX,  // of `for` and `sum`, and arguments of functions
  PL_NAMED_AXIS,
  PL_NAMED_REQUEST,  // the letter of an `ask`
  PL_N_NAMED
} pl_named_kind;

typedef struct pl_named {
  pl_named_kind kind;
  const char *key, *shown;  // ASCII and displayed spelling, interned
  pl_span span;             // the name where it is declared
  pl_span definition;       // with its value: "m = 75 [kg]", or the statement
  pl_span scope;            // of an index or argument: where it holds; source NULL: everywhere
  const char* unit;         // as written where it is declared; NULL
  const char* comment;      // at the end of its line; NULL
  bool family;
  bool unlabelled;    // the name of the mass stands for the mass itself: `force F on m1`
  const char* label;  // of a multiplier: key of its constraint
} pl_named;

// A place where a name stands.  span covers the letters of the name itself: `x` in x_dot, `rod` in
// λ_rod.
typedef struct pl_use {
  pl_span span;
  int named;  // in outline->named
  bool defines;
  bool dotted;  // the spelling carries dots over its letters, ẋ
  int dots;     // those, and primes behind
} pl_use;

// A start value as written.
typedef struct pl_written_start {
  int named;
  int dots;        // 0 position, 1 velocity
  bool indexed;    // x[3] = ...
  bool in_block;   // inside `for`
  bool guess, at;  // `guess`; `init at`
  pl_span value;
  pl_span relation, statement;
} pl_written_start;

// A request as written, in the order of the text.
typedef struct pl_written_item {
  const char* letter;  // NULL
  const char* text;    // blanks collapsed, as in pl_ask.text
  pl_span span;
} pl_written_item;

// What a token is, for colours.  ORDER TOKEN KINDS: pleuel_token_kind in pleuel.h
typedef enum pl_token_class {
  PL_CLASS_STATEMENT,  // keyword that begins a statement
  PL_CLASS_REQUEST,    // keyword of a request
  PL_CLASS_WORD,       // other keywords
  PL_CLASS_NAME,       // a name; `named` tells which
  PL_CLASS_CALL,       // a function of the language
  PL_CLASS_NUMBER,
  PL_CLASS_UNIT,
  PL_CLASS_TEXT,
  PL_CLASS_COMMENT,
  PL_CLASS_PRINTED,  // #: printed with the solution
  PL_CLASS_SIGN,     // operators, brackets, commas
  PL_CLASS_WRONG
} pl_token_class;
typedef struct pl_classed {
  pl_span span;
  pl_token_class class;
  int use;    // of a name: in outline->uses; -1 unknown
  int token;  // of a keyword: its number in the grammar
} pl_classed;

struct pl_parse;
typedef struct pl_outline {
  pl_arena* arena;
  pl_names* interned;
  PL_VEC(pl_named) named;  // in the order of the text
  PL_VEC(pl_use) uses;     // by file and place
  PL_VEC(pl_written_start) starts;
  PL_VEC(pl_written_item) items;
  PL_VEC(struct pl_parse*) files;  // the text itself first, then what it includes
  PL_VEC(pl_classed) classed;      // of the text itself
} pl_outline;

// pl_outline_make reads a text with what it includes.  Nothing is reported.
pl_outline* pl_outline_make(pl_arena* a, const pl_source* source, const pl_include_reader* reader);

// pl_outline_use_at finds the use at a byte of a source; -1.  A place just behind a name belongs
// to it.
int pl_outline_use_at(const pl_outline* o, const pl_source* source, size_t at);
// pl_outline_find finds a declared name by any of its spellings (θ1, theta1, theta_1); -1.
int pl_outline_find(const pl_outline* o, const char* spelling);
// The keyword at a byte of the text itself: its help, NULL where there is none.  span: of the
// keyword.
const char* pl_outline_help_at(const pl_outline* o, size_t at, pl_language lang, pl_span* span);
// pl_outline_same tells whether two spellings are one name.
bool pl_spelled_same(pl_arena* a, const char* s, const char* t);
// The ASCII spelling of a name, theta1 for θ₁; NULL when it is none.
const char* pl_spelled_key(pl_arena* a, const char* spelling);
// An ASCII name as it is shown, θ1 for theta1.
const char* pl_spell_shown(pl_arena* a, const char* ascii);
// pl_name_is_free tells whether a spelling can be a new name in the text; if not, *why is the
// reason by language.
bool pl_outline_name_is_free(const pl_outline* o, const char* spelling, const char* why[2]);

// ---------------------------------------------------------------------------------------- help
// One line about a word of the language, and how it is written; NULL for what is none.
typedef struct pl_word_help {
  const char* word;
  const char* form;      // param NAME = VALUE [UNIT], ...
  const char* words[2];  // by language
} pl_word_help;
const pl_word_help* pl_help_statement(const char* word);
const pl_word_help* pl_help_request(const char* word);
const pl_word_help* pl_help_function(const char* word);

// ---------------------------------------------------------------------------------- completion
typedef enum pl_offer_kind {
  PL_OFFER_STATEMENT,
  PL_OFFER_REQUEST,
  PL_OFFER_WORD,
  PL_OFFER_NAME,
  PL_OFFER_FUNCTION,
  PL_OFFER_UNIT
} pl_offer_kind;
typedef struct pl_offer {
  pl_offer_kind kind;
  const char* text;      // what is written in place of the span
  int named;             // of a name; -1
  const char* form;      // how it goes on, NULL
  const char* words[2];  // what it is; NULL
} pl_offer;
typedef struct pl_offers {
  pl_span span;  // the piece of a word at the place, empty where none stands
  PL_VEC(pl_offer) list;
  bool fits;  // the text of the statement up to the place has no error
} pl_offers;
// pl_outline_offer lists what may stand at a byte of the text itself, whatever stands behind it.
pl_offers pl_outline_offer(pl_arena* a, const pl_outline* o, size_t at);

#endif
