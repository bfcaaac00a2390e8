// pleuel export FILE --to TARGET: the formulas of the worked solution for another program.
#include "cli.h"

const cli_flag flags_export[] = {
    {"to", 0, CLI_CHOICE, CLI_AT(to), "sympy|mathematica|maxima|julia|python|json",
     "for which program"},
    {"only", 0, CLI_TEXT, CLI_AT(only), "LETTERS", "only these requests: b,c"},
    CLI_FLAG_SET,
    {"output", 'o', CLI_TEXT, CLI_AT(output), "FILE", "write there; otherwise, and with -, stdout"},
    {"force", 'f', CLI_SWITCH, CLI_AT(force), NULL, "replace a file that is there"},
    {"strict", 0, CLI_SWITCH, CLI_AT(strict), NULL,
     "a closed form that was not found is an error (exit 5)"},
    CLI_FLAG_LANG,
    CLI_FLAG_COLOR,
    CLI_FLAG_HELP,
    CLI_FLAG_END,
};

int verb_export(pleuel* ctx, const cli_options* o) {
  if (o->n_files != 1)
    return cli_error(EXIT_USAGE, "export takes one file:  pleuel export FILE --to sympy");
  if (!o->to)
    return cli_error(EXIT_USAGE,
                     "for which program?  --to sympy, mathematica, maxima, julia, python or json");
  int code = EXIT_DONE;
  pleuel_model* m = cli_load(ctx, o, o->files[0], &code);
  if (!m) return code;

  PLEUEL_OPTIONS(pleuel_solve_options, how);
  how.only = o->only;
  const char* text = NULL;
  pleuel_status s = pleuel_export(m, &text, o->to, &how);
  return cli_finish_text(ctx, m, o, s, text);
}
