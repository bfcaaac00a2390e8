// pleuel sim FILE: the motion as data.
#include "cli.h"

#include <math.h>
#include <string.h>

const cli_flag flags_sim[] = {
    {"output", 'o', CLI_TEXT, CLI_AT(output), "FILE.csv", "where the rows go; - is stdout"},
    {"force", 'f', CLI_SWITCH, CLI_AT(force), NULL, "replace a file that is there"},
    {"until", 0, CLI_TEXT, CLI_AT(until), "TIME", "end of the run: 5, '500[ms]'"},
    {"dt", 0, CLI_TEXT, CLI_AT(dt), "TIME", "distance of the rows; without it a row for each step"},
    {"tol", 0, CLI_TEXT, CLI_AT(tol), "NUMBER", "relative local error of a step"},
    {"method", 0, CLI_TEXT, CLI_AT(method), "NAME",
     "taylor, radau (implicit) or auto: radau where stiff"},
    {"engine", 0, CLI_TEXT, CLI_AT(engine), "NAME", "auto, interpreter, compiled: same result"},
    {"precision", 0, CLI_TEXT, CLI_AT(precision), "NAME",
     "double, long (80 bits, long runs), quad (128 bits)"},
    {"verbose", 'v', CLI_SWITCH, CLI_AT(verbose), NULL, "tell too how the steps were computed"},
    {"sensitivities", 0, CLI_TEXT, CLI_AT(sensitivities), "NAMES",
     "derivatives by these too: m2,x0"},
    {"certify", 0, CLI_OPTIONAL, CLI_AT(certify), "[=WIDTH]",
     "prove intervals for the true motion, this narrow (1e-18)"},
    CLI_FLAG_SET,
    {"resume", 0, CLI_SWITCH, CLI_AT(resume), NULL, "go on with a run that was interrupted"},
    {"checkpoint", 0, CLI_TEXT, CLI_AT(checkpoint), "SECONDS",
     "how often the state of a run is kept: 10"},
    {"events", 0, CLI_SWITCH, CLI_AT(events), NULL, "tell events only, not the accuracy"},
    CLI_FLAG_JSON,
    CLI_FLAG_LANG,
    CLI_FLAG_COLOR,
    CLI_FLAG_HELP,
    CLI_FLAG_END,
};

// ORDER METHODS, ENGINES, PRECISIONS: as in pleuel.h
static bool is_word(const char* word, const char* const words[3], int* out) {
  if (!word) return true;
  for (int i = 0; i < 3; i++) {
    if (strcmp(word, words[i]) != 0) continue;
    *out = i;
    return true;
  }
  return false;
}

static int words(const cli_options* o, int chosen[3]) {
  static const char* const methods[] = {"auto", "taylor", "radau"};
  static const char* const engines[] = {"auto", "interpreter", "compiled"};
  static const char* const precisions[] = {"double", "long", "quad"};
  if (!is_word(o->method, methods, &chosen[0]))
    return cli_error(EXIT_USAGE, "there is no method %s: taylor, radau or auto", o->method);
  if (!is_word(o->engine, engines, &chosen[1]))
    return cli_error(EXIT_USAGE, "there is no engine %s: auto, interpreter or compiled", o->engine);
  if (!is_word(o->precision, precisions, &chosen[2]))
    return cli_error(EXIT_USAGE, "there is no precision %s: double, long or quad", o->precision);
  return EXIT_DONE;
}

// A time or number given as text.
static int quantity(pleuel* ctx, const char* flag, const char* text, int* has, double* value) {
  if (!text) return EXIT_DONE;
  if (pleuel_quantity(ctx, value, text) != PLEUEL_OK) {
    return cli_error(EXIT_USAGE, "--%s %s: %s", flag, text, pleuel_message(ctx));
  }
  *has = 1;
  return EXIT_DONE;
}

// Seconds between states that are kept; 0: only when the run is interrupted.
static int interval(pleuel* ctx, const char* text, double* seconds) {
  if (pleuel_quantity(ctx, seconds, text) != PLEUEL_OK || !(*seconds >= 0) || isinf(*seconds))
    return cli_error(EXIT_USAGE, "--checkpoint takes seconds, not `%s`", text);
  if (*seconds == 0) *seconds = -1;
  return EXIT_DONE;
}

static int unsupported_output(const char* path) {
  const char* dot = strrchr(path, '.');
  if (!dot || strcmp(path, "-") == 0) return EXIT_DONE;
  if (strcmp(dot, ".h5") == 0 || strcmp(dot, ".npz") == 0) {
    return cli_error(EXIT_USAGE, "this version writes CSV, not %s: choose a name that ends in .csv",
                     dot);
  }
  return EXIT_DONE;
}

// A run that did not start has nothing to tell but why.
static void tell(pleuel* ctx, const cli_options* o, pleuel_model* m, pleuel_status s, bool started,
                 bool stdout_taken) {
  if (o->json) {
    const char* json = pleuel_simulation_json(m);
    if (json) fputs(json, stdout);
    return;
  }
  FILE* to = stdout_taken ? stderr : stdout;
  PLEUEL_OPTIONS(pleuel_text_options, how);
  how.colour = cli_colour(o, to);
  how.lang = o->lang;
  how.terse = o->events;
  cli_print_diagnostics(m, o, stderr, 7u);
  const char* text = started ? pleuel_simulation_text(m, &how) : NULL;
  if (text) fputs(text, to);
  const char* engine = started && o->verbose ? pleuel_simulation_engine(m, &how) : NULL;
  if (engine) fputs(engine, to);
  fflush(to);
  bool said = started || pleuel_diagnostic_count(m, PLEUEL_ERROR) > 0;
  if (s != PLEUEL_OK && !said && *pleuel_message(ctx)) cli_error(0, "%s", pleuel_message(ctx));
}

int verb_sim(pleuel* ctx, const cli_options* o) {
  if (o->n_files != 1) return cli_error(EXIT_USAGE, "sim takes one file; - is stdin");
  bool to_stdout = o->output && strcmp(o->output, "-") == 0;
  if (to_stdout && o->json) return cli_error(EXIT_USAGE, "rows and JSON cannot both go to stdout");

  PLEUEL_OPTIONS(pleuel_sim_options, how);
  int code = quantity(ctx, "until", o->until, &how.has_until, &how.until);
  if (!code) code = quantity(ctx, "dt", o->dt, &how.has_dt, &how.dt);
  if (!code) code = quantity(ctx, "tol", o->tol, &how.has_tol, &how.tol);
  int chosen[3] = {0};
  if (!code) code = words(o, chosen);
  int has_width = 0;
  how.certify = o->certify != NULL;
  if (!code && how.certify && *o->certify)
    code = quantity(ctx, "certify", o->certify, &has_width, &how.certify_width);
  if (!code && o->output) code = unsupported_output(o->output);
  if (!code && o->resume && (!o->output || to_stdout))
    code = cli_error(EXIT_USAGE, "--resume needs rows in a file: -o FILE.csv");
  if (!code && o->checkpoint) code = interval(ctx, o->checkpoint, &how.state_every);
  if (code) return code;

  pleuel_model* m = cli_load(ctx, o, o->files[0], &code);
  if (!m) return code;

  // a file that would be in the way is noticed before the work, not after it
  static cli_rows rows;
  static char command[4096];
  bool to_file = o->output && !to_stdout;
  code = to_file ? cli_rows_open(&rows, o) : EXIT_DONE;
  if (code == EXIT_DONE) {
    FILE* device = to_stdout ? stdout : to_file && !rows.state[0] ? rows.file.to : NULL;
    if (to_file && !device) how.csv_file = rows.file.temporary;
    if (device) {
      how.csv = cli_write;
      how.csv_user = device;
    }
    if (rows.state[0] && !o->certify) {  // what is certified runs in one go
      cli_resume_command(command, sizeof command, o);
      how.state = rows.state;
      how.resume = o->resume;
      how.resume_command = command;
    }
    pleuel_set_progress(ctx, cli_progress, NULL);
    how.method = (pleuel_method)chosen[0];
    how.engine = (pleuel_engine)chosen[1];
    how.precision = (pleuel_precision)chosen[2];
    how.until_as_written = o->until;
    how.dt_as_written = o->dt;
    how.sensitivities = o->sensitivities;
    PLEUEL_OPTIONS(pleuel_summary, summary);
    pleuel_status s = pleuel_simulate(m, &summary, &how);
    pleuel_set_progress(ctx, NULL, NULL);
    cli_progress_clear();
    code = cli_exit_code(s);
    bool started = !isnan(summary.t_end);
    int closed = to_file ? cli_rows_close(&rows, s, started) : EXIT_DONE;
    if (closed) code = closed;
    tell(ctx, o, m, s, started, to_stdout);
  }
  pleuel_model_free(m);
  return code;
}
