// Flags and files of a verb, from its table, by getopt_long; with a suggestion for what was
// mistyped.
#include "cli.h"

#include <getopt.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_FLAGS = 32, FIRST_LONG = 256 };

// What --lang said; before that the environment speaks.
static const char* spoken;

void cli_set_language(const char* lang) { spoken = lang; }

static const char* in_language(const char* sentence) {
  static const char* const list[][2] = {
#define PL_SENTENCE(english, german) {english, german},
#include "../src/messages/cli.def"
#undef PL_SENTENCE
  };
  bool german = strcmp(spoken ? spoken : cli_environment_language(), "de") == 0;
  for (size_t i = 0; german && i < sizeof list / sizeof *list; i++) {
    if (strcmp(list[i][0], sentence) == 0) return list[i][1];
  }
  return sentence;
}

int cli_error(int code, const char* fmt, ...) {
  va_list ap;
  va_start(ap, fmt);
  fputs("pleuel: ", stderr);
  vfprintf(stderr, in_language(fmt), ap);
  fputc('\n', stderr);
  va_end(ap);
  return code;
}

// Edit distance with transpositions [Damerau1964], for words of ordinary length.
static int distance(const char* a, const char* b) {
  int n = (int)strlen(a), m = (int)strlen(b);
  int d[32][32];
  if (n > 30 || m > 30) return 99;
  for (int i = 0; i <= n; i++) d[i][0] = i;
  for (int j = 0; j <= m; j++) d[0][j] = j;
  for (int i = 1; i <= n; i++) {
    for (int j = 1; j <= m; j++) {
      int best = d[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
      if (d[i - 1][j] + 1 < best) best = d[i - 1][j] + 1;
      if (d[i][j - 1] + 1 < best) best = d[i][j - 1] + 1;
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]
          && d[i - 2][j - 2] + 1 < best)
        best = d[i - 2][j - 2] + 1;
      d[i][j] = best;
    }
  }
  return d[n][m];
}

const char* cli_nearest(const char* word, const char* const* words, int n) {
  const char* near = NULL;
  int best = (int)strlen(word) <= 3 ? 2 : 3;  // beyond this it would be guessing
  for (int i = 0; i < n; i++) {
    int d = distance(word, words[i]);
    if (d < best) {
      best = d;
      near = words[i];
    }
  }
  return near;
}

// Is value one of the words "a|b|c"?
static bool is_choice(const char* words, const char* value) {
  size_t n = strlen(value);
  for (const char* w = words; *w;) {
    size_t len = strcspn(w, "|");
    if (len == n && strncmp(w, value, n) == 0) return true;
    w += len + (w[len] == '|');
  }
  return false;
}

// NAME=VALUE; the text of the argument is cut in two where it stands.
static int add_setting(cli_options* o, char* text) {
  char* equals = strchr(text, '=');
  if (!equals || equals == text || !equals[1])
    return cli_error(EXIT_USAGE, "--set takes NAME=VALUE, not `%s`", text);
  if (o->n_settings == CLI_MAX_SETTINGS)
    return cli_error(EXIT_USAGE, "more than %d --set", CLI_MAX_SETTINGS);
  *equals = '\0';
  char* end = equals;
  while (end > text && end[-1] == ' ') *--end = '\0';
  o->settings[o->n_settings++] = (pleuel_setting){text, equals + 1};
  return EXIT_DONE;
}

static int apply(cli_options* o, const cli_flag* f, char* value) {
  char* base = (char*)o;
  switch (f->kind) {
    case CLI_SWITCH: *(bool*)(base + f->offset) = true; return EXIT_DONE;
    case CLI_SETTING: return add_setting(o, value);
    case CLI_CHOICE:
      if (!is_choice(f->argument, value)) {
        return cli_error(EXIT_USAGE, "--%s takes %s, not `%s`", f->name, f->argument, value);
      }
      break;
    case CLI_TEXT:
      if (!*value) return cli_error(EXIT_USAGE, "--%s needs %s", f->name, f->argument);
      break;
    case CLI_OPTIONAL:
      *(const char**)(void*)(base + f->offset) = value ? value : "";
      return EXIT_DONE;
  }
  *(const char**)(void*)(base + f->offset) = value;
  return EXIT_DONE;
}

static int unknown_flag(const cli_verb* v, const char* word) {
  const char* names[MAX_FLAGS];
  int n = 0;
  for (const cli_flag* f = v->flags; f->name; f++) names[n++] = f->name;
  char bare[64];
  snprintf(bare, sizeof bare, "%s", word + strspn(word, "-"));
  bare[strcspn(bare, "=")] = '\0';
  const char* near = cli_nearest(bare, names, n);
  if (near)
    return cli_error(EXIT_USAGE, "%s has no flag `%s`. Did you mean --%s ?", v->name, word, near);
  return cli_error(EXIT_USAGE, "%s has no flag `%s`. See  pleuel %s -h", v->name, word, v->name);
}

int cli_parse(const cli_verb* v, cli_options* o, int argc, char** argv) {
  struct option longs[MAX_FLAGS + 1] = {0};
  char shorts[2 * MAX_FLAGS + 2] = ":";
  int n = 0;
  for (const cli_flag* f = v->flags; f->name; f++, n++) {
    bool takes = f->kind != CLI_SWITCH && f->kind != CLI_OPTIONAL;
    int has = takes ? required_argument : f->kind == CLI_OPTIONAL ? optional_argument : no_argument;
    longs[n] = (struct option){f->name, has, NULL, FIRST_LONG + n};
    if (f->letter) {
      size_t at = strlen(shorts);
      shorts[at++] = f->letter;
      if (takes) shorts[at++] = ':';
      shorts[at] = '\0';
    }
  }

  // getopt wants a program name in front
  argv--;
  argc++;
  optind = 1;
  opterr = 0;
  for (;;) {
    int before = optind;
    int c = getopt_long(argc, argv, shorts, longs, NULL);
    if (c == -1) break;
    const char* word = argv[optind > before ? optind - 1 : before];
    if (c == ':')
      return cli_error(EXIT_USAGE, "`%s` needs a value. See  pleuel %s -h", word, v->name);
    if (c == '?') {
      char letter[3] = {'-', (char)optopt, '\0'};
      return unknown_flag(v, optopt > 0 && optopt < FIRST_LONG ? letter : word);
    }
    const cli_flag* f = v->flags;
    if (c >= FIRST_LONG) f += c - FIRST_LONG;
    else
      while (f->letter != c) f++;
    int code = apply(o, f, optarg);
    if (code != EXIT_DONE) return code;
  }
  for (; optind < argc; optind++) {
    if (o->n_files == CLI_MAX_FILES)
      return cli_error(EXIT_USAGE, "more than %d files", CLI_MAX_FILES);
    o->files[o->n_files++] = argv[optind];
  }
  return EXIT_DONE;
}
