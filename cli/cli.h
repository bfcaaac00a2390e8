// cli: the program. One file a verb; a verb is a row in a table (verbs.c) with its flags, which
// serve the parser, the help and the shell completions alike. Sees the library through pleuel.h
// only.
//
// stdout carries the answer, everything else goes to stderr.
#ifndef PL_CLI_H
#define PL_CLI_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "pleuel.h"

// -------------------------------------------------------------------------------------- exit codes
enum {
  EXIT_DONE = 0,
  EXIT_EXPECT = 1,
  EXIT_USAGE = 2,
  EXIT_MODEL = 3,
  EXIT_CONTRADICTION = 4,
  EXIT_NO_FORM = 5,
  EXIT_NUMERICAL = 6,
  EXIT_FILE = 7,
  EXIT_INTERRUPTED = 130
};
int cli_exit_code(pleuel_status s);

// ----------------------------------------------------------------------------------------- options
enum { CLI_MAX_FILES = 256, CLI_MAX_SETTINGS = 64 };

// Every flag of every verb has a member here; a verb's table says which of them it takes.
typedef struct cli_options {
  const char *only, *steps, *lang, *math, *output, *until, *tol, *dt, *method, *engine, *precision,
      *sensitivities, *certify, *checkpoint, *after, *color, *from, *to, *data, *macros, *size,
      *style, *show, *fps;
  bool json, terse, strict, force, resume, events, verbose, check, unicode, ascii, timing,
      no_simulation, no_font, no_animation, list, help, standalone, no_figure, no_forces, forces;
  const char* files[CLI_MAX_FILES];
  int n_files;
  pleuel_setting settings[CLI_MAX_SETTINGS];
  int n_settings;
} cli_options;

typedef enum cli_flag_kind {
  CLI_SWITCH,
  CLI_TEXT,
  CLI_CHOICE,
  CLI_SETTING,
  CLI_OPTIONAL /* --name or --name=VALUE; "" without */
} cli_flag_kind;
typedef struct cli_flag {
  const char* name;  // "only"
  char letter;       // 'o', or 0
  cli_flag_kind kind;
  size_t offset;         // of the member in cli_options
  const char* argument;  // "LETTERS"; for a CHOICE the words, separated by |
  const char* help;
} cli_flag;

typedef struct cli_verb {
  const char* name;
  const char* arguments;  // "FILE..."
  const char* summary;
  const cli_flag* flags;  // ended by a row without name
  int (*run)(pleuel* ctx, const cli_options* o);
  const char* notes;  // further lines of its help, or NULL
} cli_verb;

extern const cli_verb cli_verbs[];  // ended by a row without name
const cli_verb* cli_verb_find(const char* name);
// A verb that a later version will have: what it is for, or NULL.
const char* cli_later_verb(const char* name);

#define CLI_AT(member) offsetof(cli_options, member)
#define CLI_FLAG_HELP \
  { "help", 'h', CLI_SWITCH, CLI_AT(help), NULL, "this page" }
#define CLI_FLAG_COLOR                                          \
  {                                                             \
    "color", 0, CLI_CHOICE, CLI_AT(color), "auto|always|never", \
        "colours; auto: on a terminal only"                     \
  }
#define CLI_FLAG_LANG \
  { "lang", 0, CLI_CHOICE, CLI_AT(lang), "en|de", "language of what is printed" }
#define CLI_FLAG_JSON \
  { "json", 0, CLI_SWITCH, CLI_AT(json), NULL, "one JSON document on stdout, also for errors" }
#define CLI_FLAG_SET \
  { "set", 0, CLI_SETTING, 0, "NAME=VALUE", "another value for a parameter: m2=2.5, 'm2=500[g]'" }
#define CLI_FLAG_END \
  { NULL, 0, CLI_SWITCH, 0, NULL, NULL }

// cli_parse reads argv[0..argc) as flags and files of a verb. EXIT_DONE, or EXIT_USAGE after a
// message.
int cli_parse(const cli_verb* v, cli_options* o, int argc, char** argv);
// The nearest of n words, NULL when none is near.
const char* cli_nearest(const char* word, const char* const* words, int n);

// cli_error writes a message to stderr, in the language of --lang or of the environment, and
// returns the code.
int cli_error(int code, const char* fmt, ...) __attribute__((format(printf, 2, 3)));
void cli_set_language(const char* lang);  // NULL: that of the environment

// -------------------------------------------------------------------------------------------- help
void cli_print_overview(FILE* to);
void cli_print_help(FILE* to, const cli_verb* v);

// ---------------------------------------------------------------------------------------- terminal
bool cli_colour(const cli_options* o, FILE* stream);
int cli_width(FILE* stream);                 // cells, 0 when it is no terminal
const char* cli_environment_language(void);  // PLEUEL_LANG, else the locale: "en" or "de"
// the first Ctrl-C stops the call, the second the program
void cli_watch_interrupt(pleuel* ctx);
bool cli_was_interrupted(void);
void cli_remove_on_abort(const char* path);   // removed by the second Ctrl-C; NULL: nothing
void cli_keep_on_abort(const char* witness);  // but not when this file is there
// one line on stderr, on a terminal, after half a second
int cli_write(void* file, const void* bytes, size_t n);  // pleuel_write_function
int cli_progress(void* user, const pleuel_progress* where);
void cli_progress_clear(void);

// ------------------------------------------------------------------------------------------- files
// cli_load reads FILE or `-`. On failure the message has been printed (unless --json) and *code is
// the exit code. *m may be set even then: its diagnostics belong into a JSON document.
pleuel_model* cli_load(pleuel* ctx, const cli_options* o, const char* file, int* code);
const char* cli_display_name(const char* file);  // "<stdin>" for -
void cli_print_diagnostics(pleuel_model* m, const cli_options* o, FILE* to, unsigned severities);
// The end of a verb that answers with one text: writes it to -o or stdout, tells the messages,
// frees the model.
int cli_finish_text(pleuel* ctx, pleuel_model* m, const cli_options* o, pleuel_status s,
                    const char* text);
int cli_finish_bytes(pleuel* ctx, pleuel_model* m, const cli_options* o, pleuel_status s,
                     const char* bytes, size_t n);
// Runs a verb's work for each file, with a header line when there are several, and returns the
// worst code. Several JSON documents become one: {"pleuel": 1, "documents": [...]}.
int cli_each_file(pleuel* ctx, const cli_options* o,
                  int (*work)(pleuel*, const cli_options*, const char* file));

// A file that appears under its name only when it is complete: written beside it, then renamed.
typedef struct cli_file {
  FILE* to;
  const char* path;
  char temporary[4096];
} cli_file;
// EXIT_DONE, EXIT_FILE, EXIT_USAGE
int cli_file_open(cli_file* f, const char* path, bool replace);
int cli_file_close(cli_file* f);
void cli_file_drop(cli_file* f);

// ---- the files of sim (sim_files.c): rows, and the state that an interrupted run goes on from
typedef struct cli_rows {
  cli_file file;
  char state[4096];  // name of the state; "": rows go to a device, nothing is kept
  bool renamed;      // rows that were under their own name stand in FILE.part now
} cli_rows;
int cli_rows_open(cli_rows* r, const cli_options* o);
int cli_rows_close(cli_rows* r, pleuel_status s, bool started);
// the command line that goes on
void cli_resume_command(char* out, size_t size, const cli_options* o);

// ---- shared by plot and animate (verb_plot.c)
// "800x600"; EXIT_DONE or EXIT_USAGE
int cli_read_size(const char* text, int* width, int* height);
bool cli_ends_with(const char* name, const char* end);
int cli_style(const char* name);  // PLEUEL_LIGHT, ...

// ------------------------------------------------------------------------------------------- verbs
int verb_solve(pleuel* ctx, const cli_options* o);
int verb_check(pleuel* ctx, const cli_options* o);
int verb_sim(pleuel* ctx, const cli_options* o);
int verb_fmt(pleuel* ctx, const cli_options* o);
int verb_new(pleuel* ctx, const cli_options* o);
int verb_examples(pleuel* ctx, const cli_options* o);
int verb_explain(pleuel* ctx, const cli_options* o);
int verb_units(pleuel* ctx, const cli_options* o);
int verb_export(pleuel* ctx, const cli_options* o);
int verb_tex(pleuel* ctx, const cli_options* o);
int verb_report(pleuel* ctx, const cli_options* o);
int verb_plot(pleuel* ctx, const cli_options* o);
int verb_animate(pleuel* ctx, const cli_options* o);
int verb_dump(pleuel* ctx, const cli_options* o);
int verb_completion(pleuel* ctx, const cli_options* o);
int verb_help(pleuel* ctx, const cli_options* o);
extern const cli_flag flags_solve[], flags_check[], flags_sim[], flags_fmt[], flags_new[],
    flags_examples[], flags_explain[], flags_units[], flags_export[], flags_tex[], flags_report[],
    flags_plot[], flags_animate[], flags_dump[], flags_completion[], flags_help[];

#endif
