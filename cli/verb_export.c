// pleuel export FILE --to TARGET: the formulas of the worked solution for another program.
#include "cli.h"

#include <string.h>

const cli_flag flags_export[] = {
  {"to", 0, CLI_CHOICE, CLI_AT(to), "sympy|mathematica|maxima|julia|json", "for which program"},
  {"only", 0, CLI_TEXT, CLI_AT(only), "LETTERS", "only these requests: b,c"},
  CLI_FLAG_SET,
  {"output", 'o', CLI_TEXT, CLI_AT(output), "FILE", "write there; otherwise, and with -, stdout"},
  {"force", 'f', CLI_SWITCH, CLI_AT(force), NULL, "replace a file that is there"},
  {"strict", 0, CLI_SWITCH, CLI_AT(strict), NULL, "a closed form that was not found is an error (exit 5)"},
  CLI_FLAG_LANG,
  CLI_FLAG_COLOR,
  CLI_FLAG_HELP,
  CLI_FLAG_END,
};

static int write_out(const cli_options* o, const char* text) {
  if (!o->output || strcmp(o->output, "-") == 0) {
    fputs(text, stdout);
    return EXIT_DONE;
  }
  cli_file f;
  int code = cli_file_open(&f, o->output, o->force);
  if (code != EXIT_DONE) return code;
  fputs(text, f.to);
  return cli_file_close(&f);
}

int verb_export(pleuel* ctx, const cli_options* o) {
  if (o->n_files != 1) return cli_error(EXIT_USAGE, "export takes one file:  pleuel export FILE --to sympy");
  if (!o->to) return cli_error(EXIT_USAGE, "for which program?  --to sympy, mathematica, maxima, julia or json");
  int code = EXIT_DONE;
  pleuel_model* m = cli_load(ctx, o, o->files[0], &code);
  if (!m) return code;

  PLEUEL_OPTIONS(pleuel_solve_options, how);
  how.only = o->only;
  const char* text = NULL;
  pleuel_status s = pleuel_export(m, &text, o->to, &how);
  char why[512];
  snprintf(why, sizeof why, "%s", pleuel_message(ctx));
  int written = text ? write_out(o, text) : EXIT_DONE;
  cli_print_diagnostics(m, o, stderr, 1u << PLEUEL_ERROR | 1u << PLEUEL_WARNING);
  if (s != PLEUEL_OK && *why && pleuel_diagnostic_count(m, PLEUEL_ERROR) == 0) cli_error(0, "%s", why);
  pleuel_model_free(m);
  if (written != EXIT_DONE) return written;
  if (s == PLEUEL_NO_CLOSED_FORM && !o->strict) return EXIT_DONE;
  return cli_exit_code(s);
}
