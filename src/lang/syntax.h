// Syntax: what the parser hands to the lowering. A tree of nodes of one shape: a kind, a span,
// children in an order that the list of kinds states. Nothing is resolved here: what a name means,
// where a blank product ends and what a bracket after a name is, are decided when the declarations
// are known.
#ifndef PL_SYNTAX_H
#define PL_SYNTAX_H

#include "base/base.h"

// Children in brackets may be NULL.
typedef enum pl_ast_kind {
  // leaves
  PL_AST_NUMBER,  // text as written
  PL_AST_NAME,    // name: key, shown, raw, dots
  PL_AST_PI,
  PL_AST_INFINITY,
  PL_AST_TEXT,    // text without the quotation marks
  PL_AST_WORD,    // a keyword, text
  PL_AST_BROKEN,  // something that was already complained about
  // expressions
  PL_AST_INDEXED,  // name, index (an expression or a PL_AST_RANGE)
  PL_AST_GROUP,    // elements in round brackets
  // factors; ops[i] joins factor i to what is before: 0 first, ' ' blank, '*', '/'
  PL_AST_PRODUCT,
  PL_AST_SUM,       // terms; ops[i] is '+' or '-'
  PL_AST_NEG,       // -x after an operator
  PL_AST_POWER,     // base, exponent
  PL_AST_PRIME,     // x'  number: how many
  PL_AST_UNIT,      // x [unit]  text: the unit; child may be NULL in declarations
  PL_AST_DEGREE,    // x°
  PL_AST_RELATION,  // expressions; ops[i], i >= 1: '=' 'g' (>=) 'l' (<=) '>' '<' '!'
  PL_AST_IN,        // expression, range
  PL_AST_INTEGER,   // expression
  PL_AST_RANGE,     // from, to, [step], [count]
  // pieces of statements
  PL_AST_LIST,        // any
  PL_AST_LABEL,       // name, [index]
  PL_AST_DEFINITION,  // name or indexed, [arguments group], [value], [unit]
  PL_AST_AXIS,        // name, [direction]
  PL_AST_DIRECTION,   // name; number -1 for "-x"
  // text says which: "rest" "static" "surface" "with" "while" "redundant" "off"; [value]
  PL_AST_OPTION,
  // text says which: "stop" "record" "release" "attach" "set"; [label or target], [value]
  PL_AST_ACTION,
  PL_AST_MOTION,  // list of relations; number 1: at rest
  PL_AST_ITEM,    // a request: token says which (a PL_W_...); children as below
  // statements: token says which keyword; children as the grammar lists them
  PL_AST_STATEMENT,
  PL_AST_FILE  // statements
} pl_ast_kind;

typedef struct pl_ast pl_ast;
struct pl_ast {
  pl_ast_kind kind;
  uint32_t begin, end;  // bytes in source
  const pl_source* source;
  int token;  // statements and items: the grammar's token number of the keyword
  int number;
  int depth;    // 1 + that of the deepest child
  bool tight;   // nothing between it and the token before
  bool broken;  // statements: an error was reported inside, so only the names count
  const char* text;
  const char* key;    // names: the ASCII spelling, interned: theta, m1, lambda_g1
  const char* shown;  // names: as displayed: θ, m1, λ_g1
  const char* raw;    // names: ASCII without dropping underscores: m_1, x_dot_0
  PL_VEC(pl_ast*) kids;
  PL_VEC(char) ops;
};

static inline pl_span pl_ast_span(const pl_ast* n) {
  return n ? (pl_span){n->source, n->begin, n->end} : (pl_span){0};
}
static inline pl_ast* pl_ast_kid(const pl_ast* n, int i) {
  return i < n->kids.n ? n->kids.at[i] : NULL;
}

#endif
