// Words: which of them are keywords, and where; and which one was probably meant.
#include "lang/lang_impl.h"

#include <string.h>

#include "expr/expr.h"
#include "grammar.h"

typedef struct word {
  int token;
  const char* text;
} word;
static const word statements[] = {
#define PL_STATEMENT(token, text) {TOK_##token, text},
#include "lang/keywords.def"
};
static const word items[] = {
#define PL_ITEM(token, text) {TOK_##token, text},
#include "lang/keywords.def"
};
static const word reserved[] = {
#define PL_RESERVED(token, text) {TOK_##token, text},
#include "lang/keywords.def"
};
#define LENGTH(list) ((int)(sizeof(list) / sizeof(list)[0]))

static int find(const word* list, int n, const char* s) {
  for (int i = 0; i < n; i++) {
    if (strcmp(list[i].text, s) == 0) return list[i].token;
  }
  return 0;
}

static const char* text_of(const word* list, int n, int token) {
  for (int i = 0; i < n; i++) {
    if (list[i].token == token) return list[i].text;
  }
  return NULL;
}

int pl_word_statement(const char* s) { return find(statements, LENGTH(statements), s); }
int pl_word_item(const char* s) { return find(items, LENGTH(items), s); }
int pl_word_reserved(const char* s) { return find(reserved, LENGTH(reserved), s); }
const char* pl_word_of_statement(int token) {
  return text_of(statements, LENGTH(statements), token);
}
const char* pl_word_of_item(int token) { return text_of(items, LENGTH(items), token); }

const char* pl_word_of_request(int i) { return i < LENGTH(items) ? items[i].text : NULL; }

bool pl_word_function(const char* s) {
  static const char* const more[] = {"sqrt", "log",   "norm",   "dot",   "cross",
                                     "diff", "dt",    "sum",    "if",    "pos",
                                     "vel",  "polar", "normal", "euler", "quaternion"};
  for (int i = 0; i < PL_N_FUNCTIONS; i++) {
    if (strcmp(pl_function_name[i], s) == 0) return true;
  }
  for (int i = 0; i < LENGTH(more); i++) {
    if (strcmp(more[i], s) == 0) return true;
  }
  return false;
}

const char* pl_word_near_statement(const char* s) {
  const char* best = NULL;
  int at_most = strlen(s) < 4 ? 1 : 2;
  for (int i = 0; i < LENGTH(statements); i++) {
    int d = pl_edit_distance(s, statements[i].text, at_most);
    if (d > at_most) continue;
    best = statements[i].text;
    at_most = d - 1;
  }
  return best;
}
