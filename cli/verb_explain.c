// pleuel explain CODE: a page on a message.
#include "cli.h"

#include <ctype.h>
#include <string.h>

const cli_flag flags_explain[] = {CLI_FLAG_LANG, CLI_FLAG_HELP, CLI_FLAG_END};

int verb_explain(pleuel* ctx, const cli_options* o) {
  if (o->n_files == 0) {
    const char* list = pleuel_codes(ctx);
    if (list) fputs(list, stdout);
    return EXIT_DONE;
  }
  for (int i = 0; i < o->n_files; i++) {
    char code[16] = "";
    for (size_t k = 0; k + 1 < sizeof code && o->files[i][k]; k++)
      code[k] = (char)toupper((unsigned char)o->files[i][k]);
    const char* page = pleuel_explain(ctx, code);
    if (!page) {
      return cli_error(EXIT_USAGE,
                       "there is no page on `%s`. `pleuel explain` lists what there is.",
                       o->files[i]);
    }
    if (i > 0) putchar('\n');
    fputs(page, stdout);
  }
  return EXIT_DONE;
}
