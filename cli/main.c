// The program: find the verb, read its flags, let it work.
#include "cli.h"

#include <string.h>
#include <unistd.h>

// A first argument that is no verb is a file when it looks like one or exists.
static bool is_file_argument(const char* word) {
  if (strcmp(word, "-") == 0) return true;
  const char* dot = strrchr(word, '.');
  if (strchr(word, '/') || (dot && strcmp(dot, ".pleuel") == 0)) return true;
  return access(word, F_OK) == 0;
}

static int unknown_verb(const char* word) {
  const char* later = cli_later_verb(word);
  if (later) {
    return cli_error(EXIT_USAGE, "this version cannot do `%s` (%s) yet. See  pleuel help", word,
                     later);
  }
  const char* words[32];
  int n = 0;
  for (const cli_verb* v = cli_verbs; v->name; v++) words[n++] = v->name;
  const char* near = cli_nearest(word, words, n);
  if (near)
    return cli_error(EXIT_USAGE, "`%s` is neither a verb nor a file. Did you mean  pleuel %s ?",
                     word, near);
  return cli_error(EXIT_USAGE, "`%s` is neither a verb nor a file. See  pleuel help", word);
}

static int run_verb(const cli_verb* v, int argc, char** argv) {
  static cli_options o;
  int code = cli_parse(v, &o, argc, argv);
  if (code != EXIT_DONE) return code;
  if (o.help) {
    cli_print_help(stdout, v);
    return EXIT_DONE;
  }

  pleuel* ctx = pleuel_open(NULL);
  if (!ctx) return cli_error(EXIT_NUMERICAL, "memory is short");
  cli_set_language(o.lang);
  pleuel_set_language(ctx, o.lang ? o.lang : cli_environment_language());
  cli_watch_interrupt(ctx);
  code = v->run(ctx, &o);
  pleuel_close(ctx);

  // a full disk or a closed pipe must not look like success
  if (fflush(stdout) != 0 || ferror(stdout))
    return code ? code : cli_error(EXIT_FILE, "stdout could not be written");
  return code;
}

int main(int argc, char** argv) {
  if (argc < 2) {
    cli_print_overview(stdout);
    return EXIT_DONE;
  }
  const char* word = argv[1];
  if (strcmp(word, "--version") == 0 || strcmp(word, "-V") == 0 || strcmp(word, "version") == 0) {
    printf("pleuel %s\n", pleuel_version());
    return EXIT_DONE;
  }
  if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) {
    cli_print_overview(stdout);
    return EXIT_DONE;
  }
  const cli_verb* v = cli_verb_find(word);
  if (v) return run_verb(v, argc - 2, argv + 2);
  if (word[0] == '-' && word[1] != '\0')
    return run_verb(cli_verb_find("solve"), argc - 1, argv + 1);
  if (is_file_argument(word)) return run_verb(cli_verb_find("solve"), argc - 1, argv + 1);
  return unknown_verb(word);
}
