// Looks a sentence up in the table that tools/embed_messages.py makes from the lists.
#include "messages/messages.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "messages/messages_table.h"

static int compare(const void* sentence, const void* row) {
  return strcmp(sentence, ((const pl_message*)row)->english);
}

const char* pl_german(const char* english) {
  if (english == NULL) return NULL;
  const pl_message* m = bsearch(english, pl_messages, pl_n_messages, sizeof *pl_messages, compare);
  return m ? m->german : english;
}
