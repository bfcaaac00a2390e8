// pleuel solve FILE...: the worked solution.
#include "cli.h"

#include <string.h>

const cli_flag flags_solve[] = {
    {"only", 0, CLI_TEXT, CLI_AT(only), "LETTERS", "only these requests: b,c"},
    {"steps", 0, CLI_CHOICE, CLI_AT(steps), "brief|full", "how much is written down"},
    CLI_FLAG_LANG,
    {"math", 0, CLI_CHOICE, CLI_AT(math), "line|2d|ascii",
     "formulas on a line, stacked, or in plain ASCII"},
    CLI_FLAG_JSON,
    CLI_FLAG_SET,
    {"strict", 0, CLI_SWITCH, CLI_AT(strict), NULL,
     "a closed form that was not found is an error (exit 5)"},
    {"no-simulation", 0, CLI_SWITCH, CLI_AT(no_simulation), NULL,
     "leave out the motion that the file asks for"},
    {"timing", 0, CLI_SWITCH, CLI_AT(timing), NULL, "with --json: how long each stage took"},
    CLI_FLAG_COLOR,
    CLI_FLAG_HELP,
    CLI_FLAG_END,
};

static pleuel_math math_of(const cli_options* o) {
  if (o->math && strcmp(o->math, "2d") == 0) return PLEUEL_MATH_2D;
  if (o->math && strcmp(o->math, "ascii") == 0) return PLEUEL_MATH_ASCII;
  return PLEUEL_MATH_LINE;
}

static int solve_file(pleuel* ctx, const cli_options* o, const char* file) {
  int code = EXIT_DONE;
  pleuel_model* m = cli_load(ctx, o, file, &code);
  if (!m) return code;

  PLEUEL_OPTIONS(pleuel_solve_options, how);
  how.only = o->only;
  how.lang = o->lang;
  how.full = o->steps && strcmp(o->steps, "full") == 0;
  how.math = math_of(o);
  how.width = cli_width(stdout);
  how.colour = cli_colour(o, stdout);
  how.no_simulation = o->no_simulation;
  how.timing = o->timing;

  const char* answer = NULL;
  pleuel_status s = o->json ? pleuel_solve_json(m, &answer, &how)
                            : pleuel_solve_text(m, &answer, &how);
  if (answer) fputs(answer, stdout);
  if (!o->json) {
    fflush(stdout);
    cli_print_diagnostics(m, o, stderr, 1u << PLEUEL_ERROR | 1u << PLEUEL_WARNING);
    bool said = pleuel_diagnostic_count(m, PLEUEL_ERROR) > 0;
    if (s != PLEUEL_OK && !said && *pleuel_message(ctx)) cli_error(0, "%s", pleuel_message(ctx));
  }
  pleuel_model_free(m);
  if (s == PLEUEL_NO_CLOSED_FORM && !o->strict) return EXIT_DONE;
  return cli_exit_code(s);
}

int verb_solve(pleuel* ctx, const cli_options* o) { return cli_each_file(ctx, o, solve_file); }
