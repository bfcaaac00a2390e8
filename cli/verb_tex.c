// pleuel tex FILE: the worked solution in LaTeX.
#include "cli.h"

#include <string.h>

const cli_flag flags_tex[] = {
    {"standalone", 0, CLI_SWITCH, CLI_AT(standalone), NULL,
     "a whole document; otherwise a fragment that needs amsmath"},
    {"only", 0, CLI_TEXT, CLI_AT(only), "LETTERS", "only these requests: b,c"},
    {"steps", 0, CLI_CHOICE, CLI_AT(steps), "brief|full", "how much is written down"},
    {"macros", 0, CLI_CHOICE, CLI_AT(macros), "own|plain",
     "dots and arrows by macros that may be redefined, or as they are"},
    {"no-figure", 0, CLI_SWITCH, CLI_AT(no_figure), NULL, "without the picture of the system"},
    {"no-simulation", 0, CLI_SWITCH, CLI_AT(no_simulation), NULL,
     "leave out the motion that the file asks for"},
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

int verb_tex(pleuel* ctx, const cli_options* o) {
  if (o->n_files != 1)
    return cli_error(EXIT_USAGE, "tex takes one file:  pleuel tex FILE -o out.tex");
  int code = EXIT_DONE;
  pleuel_model* m = cli_load(ctx, o, o->files[0], &code);
  if (!m) return code;

  PLEUEL_OPTIONS(pleuel_tex_options, how);
  how.only = o->only;
  how.lang = o->lang;
  how.full = o->steps && strcmp(o->steps, "full") == 0;
  how.standalone = o->standalone;
  how.plain = o->macros && strcmp(o->macros, "plain") == 0;
  how.no_figure = o->no_figure;
  how.no_simulation = o->no_simulation;
  const char* text = NULL;
  pleuel_status s = pleuel_tex(m, &text, &how);
  return cli_finish_text(ctx, m, o, s, text);
}
