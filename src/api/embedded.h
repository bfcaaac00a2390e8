// Texts that are built into the library: the pages on messages, the examples, the model to start
// from. Made by tools/embed.py; each table is in order of names and ends with a row of NULLs.
#ifndef PL_EMBEDDED_H
#define PL_EMBEDDED_H

typedef struct pl_embedded {
  const char *name, *text;
} pl_embedded;
extern const pl_embedded pl_pages[];      // docs/diagnostics
extern const pl_embedded pl_examples[];   // examples
extern const pl_embedded pl_templates[];  // share/template

#endif
