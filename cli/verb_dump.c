// pleuel dump FILE: the value at an arrow of the pipeline.
#include "cli.h"

const cli_flag flags_dump[] = {
    {"after", 0, CLI_CHOICE, CLI_AT(after), "check|derive|record", "which arrow"},
    CLI_FLAG_SET,
    CLI_FLAG_LANG,
    CLI_FLAG_HELP,
    CLI_FLAG_END,
};

static int dump_file(pleuel* ctx, const cli_options* o, const char* file) {
  int code = EXIT_DONE;
  pleuel_model* m = cli_load(ctx, o, file, &code);
  if (!m) return code;
  const char* text = NULL;
  pleuel_status s = pleuel_dump(m, &text, o->after ? o->after : "check");
  if (text) fputs(text, stdout);
  cli_print_diagnostics(m, o, stderr, 1u << PLEUEL_ERROR);
  if (s != PLEUEL_OK && pleuel_diagnostic_count(m, PLEUEL_ERROR) == 0)
    cli_error(0, "%s", pleuel_message(ctx));
  pleuel_model_free(m);
  return cli_exit_code(s);
}

int verb_dump(pleuel* ctx, const cli_options* o) { return cli_each_file(ctx, o, dump_file); }
