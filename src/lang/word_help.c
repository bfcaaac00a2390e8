// One line about each word of the language.
#include "lang/outline.h"

#include <string.h>

enum { LIST_STATEMENT, LIST_REQUEST };

static const struct help_row {
  int list;
  pl_word_help help;
} rows[] = {
#define PL_HELP(list, word, form, en, de) {LIST_##list, {word, form, {en, de}}},
#include "lang/word_help.def"
};

static const pl_word_help functions[] = {
#define PL_HELP_FUNCTION(word, form, en, de) {word, form, {en, de}},
#include "lang/word_help.def"
};

static const pl_word_help* find(int list, const char* word) {
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    if (rows[i].list == list && strcmp(rows[i].help.word, word) == 0) return &rows[i].help;
  }
  return NULL;
}

const pl_word_help* pl_help_statement(const char* word) { return find(LIST_STATEMENT, word); }
const pl_word_help* pl_help_request(const char* word) { return find(LIST_REQUEST, word); }

const pl_word_help* pl_help_function(const char* word) {
  for (size_t i = 0; i < sizeof functions / sizeof *functions; i++) {
    if (strcmp(functions[i].word, word) == 0) return &functions[i];
  }
  return NULL;
}
