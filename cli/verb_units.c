// pleuel units UNIT: what a unit is.
#include "cli.h"

const cli_flag flags_units[] = {CLI_FLAG_LANG, CLI_FLAG_HELP, CLI_FLAG_END};

int verb_units(pleuel* ctx, const cli_options* o) {
  if (o->n_files == 0) return cli_error(EXIT_USAGE, "which unit?  pleuel units m/s");
  for (int i = 0; i < o->n_files; i++) {
    const char* text = NULL;
    pleuel_status s = pleuel_units(ctx, &text, o->files[i]);
    if (s != PLEUEL_OK) return cli_error(cli_exit_code(s), "%s", pleuel_message(ctx));
    fputs(text, stdout);
  }
  return EXIT_DONE;
}
