// The table of sentences, in the order of strcmp of the English ones.
#ifndef PL_MESSAGES_TABLE_H
#define PL_MESSAGES_TABLE_H

#include <stddef.h>

typedef struct pl_message {
  const char *english, *german;
} pl_message;
extern const pl_message pl_messages[];
extern const size_t pl_n_messages;

#endif
