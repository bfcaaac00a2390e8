// pleuel plot FILE -o FILE.svg|png|pdf: the drawing of the system and its plots.
#include "cli.h"

#include <stdlib.h>
#include <string.h>

const cli_flag flags_plot[] = {
    {"output", 'o', CLI_TEXT, CLI_AT(output), "FILE",
     "file.svg, file.png or file.pdf; - for SVG on stdout"},
    {"force", 'f', CLI_SWITCH, CLI_AT(force), NULL, "replace a file that is there"},
    {"size", 0, CLI_TEXT, CLI_AT(size), "WxH", "pixels, or points in PDF: 800x600"},
    {"style", 0, CLI_CHOICE, CLI_AT(style), "light|dark|print",
     "colours; print: dark lines on white, told apart by their dashes"},
    {"show", 0, CLI_CHOICE, CLI_AT(show), "all|plots|drawing",
     "the drawing of the system and the plots, or one of them"},
    {"no-forces", 0, CLI_SWITCH, CLI_AT(no_forces), NULL, "no force arrows in the drawing"},
    {"until", 0, CLI_TEXT, CLI_AT(until), "TIME", "end of the motion: 10, '500[ms]'"},
    CLI_FLAG_SET,
    CLI_FLAG_LANG,
    CLI_FLAG_COLOR,
    CLI_FLAG_HELP,
    CLI_FLAG_END,
};

// "800x600", "800×600"
int cli_read_size(const char* text, int* width, int* height) {
  if (!text) return EXIT_DONE;
  char* end;
  long w = strtol(text, &end, 10);
  size_t times = *end == 'x' ? 1 : strncmp(end, "×", strlen("×")) == 0 ? strlen("×") : 0;
  long h = times ? strtol(end + times, &end, 10) : 0;
  if (!times || *end || w < 64 || h < 64 || w > 8192 || h > 8192) {
    return cli_error(EXIT_USAGE, "a size is WIDTHxHEIGHT, each from 64 to 8192: --size 800x600");
  }
  *width = (int)w;
  *height = (int)h;
  return EXIT_DONE;
}

bool cli_ends_with(const char* name, const char* end) {
  size_t n = strlen(name), k = strlen(end);
  return n > k && strcmp(name + n - k, end) == 0;
}

int cli_style(const char* name) {
  return !name || !strcmp(name, "light") ? PLEUEL_LIGHT
         : !strcmp(name, "dark")         ? PLEUEL_DARK
                                         : PLEUEL_FOR_PRINT;
}

static int read_format(const char* name, pleuel_picture* format) {
  if (!name) return cli_error(EXIT_USAGE, "where to?  pleuel plot FILE -o picture.svg");
  if (strcmp(name, "-") == 0 || cli_ends_with(name, ".svg")) *format = PLEUEL_SVG;
  else if (cli_ends_with(name, ".png")) *format = PLEUEL_PNG;
  else if (cli_ends_with(name, ".pdf")) *format = PLEUEL_PDF;
  else return cli_error(EXIT_USAGE, "%s: a plot is written as .svg, .png or .pdf", name);
  return EXIT_DONE;
}

int verb_plot(pleuel* ctx, const cli_options* o) {
  if (o->n_files != 1)
    return cli_error(EXIT_USAGE, "plot takes one file:  pleuel plot FILE -o picture.svg");
  PLEUEL_OPTIONS(pleuel_plot_options, how);
  int code = read_format(o->output, &how.format);
  if (code == EXIT_DONE) code = cli_read_size(o->size, &how.width, &how.height);
  if (code != EXIT_DONE) return code;
  how.lang = o->lang;
  how.style = cli_style(o->style);
  how.panels = !o->show || !strcmp(o->show, "all") ? PLEUEL_PANELS_ALL
               : !strcmp(o->show, "plots")         ? PLEUEL_PANELS_PLOTS
                                                   : PLEUEL_PANELS_DRAWING;
  how.no_forces = o->no_forces;
  if (o->until) {
    how.has_until = 1;
    if (pleuel_quantity(ctx, &how.until, o->until) != PLEUEL_OK)
      return cli_error(EXIT_USAGE, "--until: %s", pleuel_message(ctx));
  }
  pleuel_model* m = cli_load(ctx, o, o->files[0], &code);
  if (!m) return code;
  const char* bytes = NULL;
  size_t n = 0;
  pleuel_status s = pleuel_plot(m, &bytes, &n, &how);
  if (s == PLEUEL_OK && *pleuel_message(ctx)) cli_error(0, "%s", pleuel_message(ctx));
  return cli_finish_bytes(ctx, m, o, s, bytes, n);
}
