// Help: the overview of twelve lines, and a page for each verb made from its table.
#include "cli.h"

#include <string.h>

void cli_print_overview(FILE* to) {
  fputs(
      "pleuel - constrained mechanics: from masses and constraints to worked solutions\n"
      "\n"
      "  pleuel FILE                    worked solution            (same as: pleuel solve FILE)\n"
      "  pleuel sim FILE -o out.csv     simulate, write the motion\n"
      "  pleuel report FILE             everything in one HTML page\n"
      "\n"
      "  more: check plot animate tex export fmt new examples explain units dump completion\n"
      "\n"
      "  Start with:  pleuel new pendulum          a commented model to change\n"
      "               pleuel pendulum.pleuel       its worked solution\n"
      "               pleuel examples atwood | pleuel -\n"
      "  Help:        pleuel VERB -h, man pleuel, man 5 pleuel\n",
      to);
}

void cli_print_help(FILE* to, const cli_verb* v) {
  fprintf(to, "pleuel %s %s\n  %s\n\n", v->name, v->arguments, v->summary);
  for (const cli_flag* f = v->flags; f->name; f++) {
    char left[64];
    char letter[8] = "    ";
    if (f->letter) snprintf(letter, sizeof letter, "-%c, ", f->letter);
    snprintf(left, sizeof left, "%s--%s%s%s", letter, f->name,
             f->argument && f->kind != CLI_OPTIONAL ? " " : "", f->argument ? f->argument : "");
    fprintf(to, "  %-32s %s\n", left, f->help);
  }
  if (v->notes) {
    fputs("\n", to);
    for (const char* line = v->notes; *line;) {
      size_t n = strcspn(line, "\n");
      fprintf(to, "  %.*s\n", (int)n, line);
      line += n + (line[n] == '\n');
    }
  }
}

const cli_flag flags_help[] = {CLI_FLAG_HELP, CLI_FLAG_END};

int verb_help(pleuel* ctx, const cli_options* o) {
  (void)ctx;
  if (o->n_files == 0) {
    cli_print_overview(stdout);
    return EXIT_DONE;
  }
  const cli_verb* v = cli_verb_find(o->files[0]);
  if (!v && cli_later_verb(o->files[0]))
    return cli_error(EXIT_USAGE, "this version has no `%s` yet", o->files[0]);
  if (!v) return cli_error(EXIT_USAGE, "there is no verb `%s`", o->files[0]);
  cli_print_help(stdout, v);
  return EXIT_DONE;
}
