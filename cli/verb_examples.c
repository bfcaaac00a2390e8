// pleuel examples [NAME...]: the built-in models.
#include "cli.h"

#include <string.h>

const cli_flag flags_examples[] = {
    {"output", 'o', CLI_TEXT, CLI_AT(output), "FILE", "copy one there instead of printing it"},
    {"force", 'f', CLI_SWITCH, CLI_AT(force), NULL, "replace a file that is there"},
    CLI_FLAG_HELP,
    CLI_FLAG_END,
};

// The title between the quotes of the `system` line, or "".
static void title_of(const char* text, char* title, size_t size) {
  title[0] = '\0';
  const char* at = strstr(text, "system \"");
  if (!at) return;
  at += strlen("system \"");
  snprintf(title, size, "%.*s", (int)strcspn(at, "\"\n"), at);
}

static const char* find(const char* name) {
  const char* at = NULL;
  const char* text;
  const char* names[128];
  int n = 0;
  for (size_t i = 0; (text = pleuel_example(i, &at)) != NULL; i++) {
    if (strcmp(at, name) == 0) return text;
    if (n < 128) names[n++] = at;
  }
  const char* near = cli_nearest(name, names, n);
  if (near) cli_error(0, "there is no example `%s`. Did you mean %s ?", name, near);
  else cli_error(0, "there is no example `%s`. See  pleuel examples", name);
  return NULL;
}

int verb_examples(pleuel* ctx, const cli_options* o) {
  (void)ctx;
  const char* name = NULL;
  const char* text;
  if (o->n_files == 0) {
    if (o->output) return cli_error(EXIT_USAGE, "which example? See  pleuel examples");
    for (size_t i = 0; (text = pleuel_example(i, &name)) != NULL; i++) {
      char title[128];
      title_of(text, title, sizeof title);
      printf("%-18s %s\n", name, title);
    }
    return EXIT_DONE;
  }
  if (o->output && o->n_files > 1)
    return cli_error(EXIT_USAGE, "-o takes one example, but there are several");
  for (int i = 0; i < o->n_files; i++) {
    text = find(o->files[i]);
    if (!text) return EXIT_USAGE;
    if (!o->output || strcmp(o->output, "-") == 0) {
      fputs(text, stdout);
      continue;
    }
    cli_file f;
    int code = cli_file_open(&f, o->output, o->force);
    if (code != EXIT_DONE) return code;
    fputs(text, f.to);
    code = cli_file_close(&f);
    if (code != EXIT_DONE) return code;
  }
  return EXIT_DONE;
}
