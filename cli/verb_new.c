// pleuel new NAME: a commented model to start from.
#include "cli.h"

#include <string.h>

const cli_flag flags_new[] = {
    {"from", 0, CLI_TEXT, CLI_AT(from), "EXAMPLE", "start from a built-in example instead"},
    {"force", 'f', CLI_SWITCH, CLI_AT(force), NULL, "replace a file that is there"},
    CLI_FLAG_HELP,
    CLI_FLAG_END,
};

static const char* example(const char* name) {
  const char* at = NULL;
  const char* text;
  for (size_t i = 0; (text = pleuel_example(i, &at)) != NULL; i++) {
    if (strcmp(at, name) == 0) return text;
  }
  return NULL;
}

int verb_new(pleuel* ctx, const cli_options* o) {
  if (o->n_files != 1) return cli_error(EXIT_USAGE, "new takes one name:  pleuel new pendulum");
  const char* name = o->files[0];
  char path[1024], title[1024];
  const char* dot = strrchr(name, '.');
  bool has_suffix = dot && strcmp(dot, ".pleuel") == 0;
  int n = snprintf(path, sizeof path, "%s%s", name, has_suffix ? "" : ".pleuel");
  if (n < 0 || (size_t)n >= sizeof path) return cli_error(EXIT_USAGE, "the name is too long");
  const char* slash = strrchr(path, '/');
  snprintf(title, sizeof title, "%s", slash ? slash + 1 : path);
  *strrchr(title, '.') = '\0';
  if (!*title) return cli_error(EXIT_USAGE, "the model needs a name:  pleuel new pendulum");

  const char* text = o->from ? example(o->from) : pleuel_template(ctx, title);
  if (!text)
    return cli_error(EXIT_USAGE, "there is no example `%s`. See  pleuel examples",
                     o->from ? o->from : title);
  cli_file f;
  int code = cli_file_open(&f, path, o->force);
  if (code != EXIT_DONE) return code;
  fputs(text, f.to);
  code = cli_file_close(&f);
  if (code == EXIT_DONE) printf("%s is written. Next:  pleuel %s\n", path, path);
  return code;
}
