// pleuel fmt FILE...: canonical layout, in place.
#include "cli.h"

#include <stdlib.h>
#include <string.h>

const cli_flag flags_fmt[] = {
    {"check", 0, CLI_SWITCH, CLI_AT(check), NULL,
     "change nothing, name the files that would change (exit 1)"},
    {"unicode", 0, CLI_SWITCH, CLI_AT(unicode), NULL, "write θ, λ, ²"},
    {"ascii", 0, CLI_SWITCH, CLI_AT(ascii), NULL, "write theta, lambda, ^2"},
    {"output", 'o', CLI_TEXT, CLI_AT(output), "FILE", "write there instead; - is stdout"},
    {"force", 'f', CLI_SWITCH, CLI_AT(force), NULL, "with -o: replace a file that is there"},
    CLI_FLAG_LANG,
    CLI_FLAG_COLOR,
    CLI_FLAG_HELP,
    CLI_FLAG_END,
};

// Does the file hold exactly this text?
static bool holds(const char* path, const char* text) {
  FILE* f = fopen(path, "rb");
  if (!f) return false;
  bool same = true;
  for (const char* c = text; same && *c; c++) same = fgetc(f) == (unsigned char)*c;
  same = same && fgetc(f) == EOF;
  fclose(f);
  return same;
}

static int write_text(const char* path, const char* text, bool replace) {
  cli_file f;
  int code = cli_file_open(&f, path, replace);
  if (code != EXIT_DONE) return code;
  fputs(text, f.to);
  return cli_file_close(&f);
}

static int format_file(pleuel* ctx, const cli_options* o, const char* file) {
  int code = EXIT_DONE;
  pleuel_model* m = cli_load(ctx, o, file, &code);
  if (!m) return code;

  pleuel_spelling spelling = o->unicode ? PLEUEL_SPELL_UNICODE
                             : o->ascii ? PLEUEL_SPELL_ASCII
                                        : PLEUEL_SPELL_KEEP;
  const char* text = NULL;
  pleuel_status s = pleuel_format(m, &text, spelling);
  code = cli_exit_code(s);
  if (s != PLEUEL_OK) {
    cli_print_diagnostics(m, o, stderr, 1u << PLEUEL_ERROR);
    if (pleuel_diagnostic_count(m, PLEUEL_ERROR) == 0) cli_error(code, "%s", pleuel_message(ctx));
  } else if (strcmp(file, "-") == 0 || (o->output && strcmp(o->output, "-") == 0)) {
    fputs(text, stdout);
  } else if (o->output) {
    code = write_text(o->output, text, o->force);
  } else if (!holds(file, text)) {
    if (o->check) {
      puts(file);
      code = EXIT_EXPECT;
    } else {
      code = write_text(file, text, true);
    }
  }
  pleuel_model_free(m);
  return code;
}

int verb_fmt(pleuel* ctx, const cli_options* o) {
  if (o->unicode && o->ascii) return cli_error(EXIT_USAGE, "--unicode or --ascii, not both");
  if (o->output && o->n_files > 1)
    return cli_error(EXIT_USAGE, "-o names one file, but there are several");
  if (o->n_files == 0) return cli_error(EXIT_USAGE, "which file? - is stdin");
  int worst = EXIT_DONE;
  for (int i = 0; i < o->n_files; i++) {
    int code = format_file(ctx, o, o->files[i]);
    if (code > worst) worst = code;
  }
  return worst;
}
