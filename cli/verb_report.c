// pleuel report FILE: everything in one HTML page.
#include "cli.h"

#include <string.h>

const cli_flag flags_report[] = {
    {"output", 'o', CLI_TEXT, CLI_AT(output), "FILE.html",
     "where the page goes; - is stdout; default: FILE.html here"},
    {"force", 'f', CLI_SWITCH, CLI_AT(force), NULL, "replace a file that is there"},
    {"only", 0, CLI_TEXT, CLI_AT(only), "LETTERS", "only these requests: b,c"},
    {"no-font", 0, CLI_SWITCH, CLI_AT(no_font), NULL, "use the reader's own math font: 40 kB less"},
    {"no-animation", 0, CLI_SWITCH, CLI_AT(no_animation), NULL, "plots only"},
    {"data", 0, CLI_CHOICE, CLI_AT(data), "none|thin|full",
     "rows to save from the page; thin: what the plots show"},
    CLI_FLAG_SET,
    {"strict", 0, CLI_SWITCH, CLI_AT(strict), NULL,
     "a closed form that was not found is an error (exit 5)"},
    CLI_FLAG_LANG,
    CLI_FLAG_COLOR,
    CLI_FLAG_HELP,
    CLI_FLAG_END,
};

static const char* last_part(const char* path) {
  const char* slash = strrchr(path, '/');
  return slash ? slash + 1 : path;
}

// ski.pleuel -> ski.html, in the directory where the program runs.
static const char* default_output(const char* file, char* out, size_t size) {
  const char* name = strcmp(file, "-") == 0 ? "report" : last_part(file);
  const char* dot = strrchr(name, '.');
  int n = dot && dot > name ? (int)(dot - name) : (int)strlen(name);
  snprintf(out, size, "%.*s.html", n, name);
  return out;
}

static void add_word(char* line, size_t size, const char* word) {
  size_t n = strlen(line);
  bool quote = strpbrk(word, " '\"[]^*$()") != NULL;
  if (n < size) snprintf(line + n, size - n, quote ? " '%s'" : " %s", word);
}

// The command for the last lines of the page, without directories: they tell about a machine, not
// about the work.
static const char* command_line(const cli_options* o, const char* path, char* line, size_t size) {
  snprintf(line, size, "pleuel report");
  add_word(line, size, last_part(o->files[0]));
  if (o->only) {
    add_word(line, size, "--only");
    add_word(line, size, o->only);
  }
  if (o->lang) {
    add_word(line, size, "--lang");
    add_word(line, size, o->lang);
  }
  if (o->no_font) add_word(line, size, "--no-font");
  if (o->no_animation) add_word(line, size, "--no-animation");
  if (o->data) {
    add_word(line, size, "--data");
    add_word(line, size, o->data);
  }
  for (int i = 0; i < o->n_settings; i++) {
    char setting[512];
    snprintf(setting, sizeof setting, "%s=%s", o->settings[i].name, o->settings[i].value);
    add_word(line, size, "--set");
    add_word(line, size, setting);
  }
  add_word(line, size, "-o");
  add_word(line, size, last_part(path));
  return line;
}

static pleuel_report_data data_of(const cli_options* o) {
  if (o->data && strcmp(o->data, "none") == 0) return PLEUEL_DATA_NONE;
  return o->data && strcmp(o->data, "full") == 0 ? PLEUEL_DATA_FULL : PLEUEL_DATA_THIN;
}

int verb_report(pleuel* ctx, const cli_options* o) {
  if (o->n_files != 1)
    return cli_error(EXIT_USAGE, "report takes one file:  pleuel report FILE -o FILE.html");
  char name[512], line[2048];
  const char* path = o->output ? o->output : default_output(o->files[0], name, sizeof name);
  bool to_stdout = strcmp(path, "-") == 0;

  // a file that would be in the way is noticed before the work, not after it
  cli_file file = {0};
  int code = to_stdout ? EXIT_DONE : cli_file_open(&file, path, o->force);
  if (code != EXIT_DONE) return code;
  pleuel_model* m = cli_load(ctx, o, o->files[0], &code);
  if (!m) {
    if (!to_stdout) cli_file_drop(&file);
    return code;
  }

  PLEUEL_OPTIONS(pleuel_report_options, how);
  how.only = o->only;
  how.lang = o->lang;
  how.no_font = o->no_font;
  how.no_animation = o->no_animation;
  how.data = data_of(o);
  how.command = command_line(o, path, line, sizeof line);
  const char* html = NULL;
  pleuel_status s = pleuel_report(m, &html, &how);
  char why[512];
  snprintf(why, sizeof why, "%s", pleuel_message(ctx));
  int written = EXIT_DONE;
  if (html) fputs(html, to_stdout ? stdout : file.to);
  if (html && !to_stdout) written = cli_file_close(&file);
  if (!html && !to_stdout) cli_file_drop(&file);
  cli_print_diagnostics(m, o, stderr, 1u << PLEUEL_ERROR | 1u << PLEUEL_WARNING);
  if (s != PLEUEL_OK && *why && pleuel_diagnostic_count(m, PLEUEL_ERROR) == 0)
    cli_error(0, "%s", why);
  pleuel_model_free(m);
  if (written != EXIT_DONE) return written;
  return s == PLEUEL_NO_CLOSED_FORM && !o->strict ? EXIT_DONE : cli_exit_code(s);
}
