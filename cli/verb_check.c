// pleuel check FILE...: everything that can be said without solving.
#include "cli.h"

const cli_flag flags_check[] = {
    CLI_FLAG_JSON,
    {"terse", 0, CLI_SWITCH, CLI_AT(terse), NULL,
     "one line a message: file:line:col: CODE: sentence"},
    {"strict", 0, CLI_SWITCH, CLI_AT(strict), NULL, "notes and warnings count as errors"},
    CLI_FLAG_SET,
    CLI_FLAG_LANG,
    CLI_FLAG_COLOR,
    CLI_FLAG_HELP,
    CLI_FLAG_END,
};

static int check_file(pleuel* ctx, const cli_options* o, const char* file) {
  int code = EXIT_DONE;
  pleuel_model* m = cli_load(ctx, o, file, &code);
  if (!m) return code;

  PLEUEL_OPTIONS(pleuel_text_options, how);
  how.lang = o->lang;
  how.colour = cli_colour(o, stdout);
  const char* answer = NULL;
  pleuel_status s = o->json ? pleuel_check_json(m, &answer, &how) : pleuel_check(m, &answer, &how);
  if (o->json) {
    if (answer) fputs(answer, stdout);
  } else {
    cli_print_diagnostics(m, o, stdout, 7u);
    if (answer && !o->terse) fputs(answer, stdout);
    bool said = pleuel_diagnostic_count(m, PLEUEL_ERROR) > 0;
    if (s != PLEUEL_OK && !said && *pleuel_message(ctx))
      cli_error(0, "%s: %s", cli_display_name(file), pleuel_message(ctx));
  }
  size_t remarks = pleuel_diagnostic_count(m, PLEUEL_WARNING)
                   + pleuel_diagnostic_count(m, PLEUEL_NOTE);
  pleuel_model_free(m);
  if (s == PLEUEL_OK && o->strict && remarks > 0) return EXIT_MODEL;
  return cli_exit_code(s);
}

int verb_check(pleuel* ctx, const cli_options* o) { return cli_each_file(ctx, o, check_file); }
