/* pleuel: constrained classical mechanics, from a model text to a worked solution and the motion.
 *
 * This header is the whole public interface. It reads from top to bottom as a course: one call that
 * does it all, then the steps, then the options. docs/api.md shows it at work. Strings are UTF-8.
 * Numbers are SI.
 *
 *     pleuel* ctx = pleuel_open(NULL);
 *     pleuel_model* model;
 *     const char* text;
 *     if (pleuel_load_file(ctx, &model, "ski.pleuel", NULL) == PLEUEL_OK
 *         && pleuel_solve_text(model, &text, NULL) == PLEUEL_OK) puts(text);
 *     else puts(pleuel_message(ctx));
 *     pleuel_close(ctx);
 *
 * Who owns what. Objects are freed by the function of their section. A text or an array that is
 * handed out belongs to the object that was asked, and lives until the next call with that object,
 * or until it is freed. Where the comment says "kept", it lives as long as the object. Texts of a
 * context (pleuel_explain and so on) are kept. Repeated work takes no more memory than work done
 * once.
 *
 * Threads. A context and its models belong to one thread at a time; several contexts may live in
 * several threads. A system may be shared: all threads may open runs of it. A run and a result
 * belong to one thread at a time. pleuel_interrupt and pleuel_run_interrupt may be called from any
 * thread and from signal handlers. The library prints nothing and never ends the process.
 *
 * Functions of the caller (callbacks) are called in the thread of the call that they were given to,
 * before it returns. They must return: not by longjmp, not by an exception of C++. They must not
 * use the object that is at work, but may interrupt it; other objects may be used. A result other
 * than 0 stops the call with PLEUEL_INTERRUPTED.
 *
 * Memory. An allocator serves models, systems, runs and results, and must stand calls from every
 * thread that uses one of them; `take` aligns as malloc does. Allocator and memory limit do not
 * cover what GMP, FLINT, KLU, LLVM and cairo take for themselves; the limit counts for each
 * object. */
#ifndef PLEUEL_H
#define PLEUEL_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#define PLEUEL_VERSION       "0.1.0"
#define PLEUEL_VERSION_MAJOR 0
#define PLEUEL_VERSION_MINOR 1
#define PLEUEL_VERSION_PATCH 0

/* --------------------------------------------------------------------------------------- status */

/* pleuel_status tells how a call ended. PLEUEL_OK is 0. The sentence with numbers is in
 * pleuel_message. */
typedef enum pleuel_status {
  PLEUEL_OK = 0,
  PLEUEL_EXPECT_FAILED,  /* done, but an `expect` of the model or a check of our own is false */
  PLEUEL_USAGE,          /* a call with arguments that make no sense */
  PLEUEL_MODEL_ERROR,    /* the text has errors: see the diagnostics */
  PLEUEL_CONTRADICTION,  /* constraints or start values contradict each other */
  PLEUEL_NO_CLOSED_FORM, /* a closed form was asked for and not found */
  PLEUEL_NUMERICAL,      /* the computation cannot go on: residual, step size, iteration */
  PLEUEL_SINGULAR,       /* the constraints lose rank: singular position */
  PLEUEL_FILE,           /* a file could not be read or written */
  PLEUEL_INTERRUPTED,    /* stopped from outside; what was done is kept */
  PLEUEL_NO_MEMORY,      /* memory, or the limit set for it, ran out */
  PLEUEL_UNSUPPORTED     /* understood, but this version cannot compute it */
} pleuel_status;

/* pleuel_status_name returns the identifier of a status as text, "PLEUEL_OK". Static, never
 * NULL. */
const char* pleuel_status_name(pleuel_status status);

/* pleuel_version returns the version of the library that is running, "0.1.0".  Static. */
const char* pleuel_version(void);

/* -------------------------------------------------------------------------------------- context */

/* pleuel is a context: where memory comes from, the last status and its sentence, the wish to
 * stop. */
typedef struct pleuel pleuel;

/* pleuel_allocator replaces malloc and free. size in bytes; `take` returns NULL when there is no
 * more. */
typedef struct pleuel_allocator {
  void* (*take)(void* user, size_t size);
  void (*give)(void* user, void* block);
  void* user;
} pleuel_allocator;

/* pleuel_open makes a context. alloc may be NULL. NULL when memory is short. Close with
 * pleuel_close, which frees the models made from it too. */
pleuel* pleuel_open(const pleuel_allocator* alloc);
void pleuel_close(pleuel* ctx);

/* pleuel_thread_end gives back what the calling thread keeps for exact numbers. Call it in threads
 * that you end, when their contexts are closed; a program with one thread need not. */
void pleuel_thread_end(void);

/* pleuel_message returns the sentence of the last failure, "" if none. Owned by ctx, valid until
 * the next call. */
const char* pleuel_message(const pleuel* ctx);

/* pleuel_set_language chooses the language of messages and of solutions whose file names none: "en"
 * or "de". */
pleuel_status pleuel_set_language(pleuel* ctx, const char* lang);

/* pleuel_set_memory_limit lets calls end with PLEUEL_NO_MEMORY when a model takes more than so many
 * bytes; 0: no limit. */
void pleuel_set_memory_limit(pleuel* ctx, size_t bytes);

/* pleuel_interrupt asks the call that runs in this context to stop; it ends with PLEUEL_INTERRUPTED
 * and keeps what is done. May be called from a signal handler and from other threads. Holds until
 * pleuel_interrupt_clear. */
void pleuel_interrupt(pleuel* ctx);
void pleuel_interrupt_clear(pleuel* ctx);

/* ----------------------------------------------------------------------------------- structures */

/* Structures that carry options, and those that come back, grow with later versions, at their ends.
 * Their first member is the size that the caller was compiled with. PLEUEL_OPTIONS declares one,
 * sets the size, and every other member to 0, which is its default:
 *     PLEUEL_OPTIONS(pleuel_solve_options, how);
 *     how.lang = "de";
 * Where options are taken, NULL stands for the defaults. A size of 0 is PLEUEL_USAGE, so that
 * forgotten sizes are noticed. Of a structure that comes back, `size` bytes are filled. */
#ifdef __cplusplus
#  define PLEUEL_OPTIONS(type, name) \
    type name = {};                  \
    name.size = sizeof name
#else
#  define PLEUEL_OPTIONS(type, name) \
    type name = {0};                 \
    name.size = sizeof name
#endif

/* Where a call stands: for a line of progress. */
typedef enum pleuel_stage {
  PLEUEL_STAGE_CHECK = 0, /* names, units, families */
  PLEUEL_STAGE_DERIVE,    /* equations and their solution */
  PLEUEL_STAGE_WITNESS,   /* what was derived is held against the motion */
  PLEUEL_STAGE_RECORD,    /* programs of the motion */
  PLEUEL_STAGE_RUN,       /* the motion */
  PLEUEL_STAGE_CERTIFY    /* its proof */
} pleuel_stage;

typedef struct pleuel_progress {
  size_t size;
  pleuel_stage stage;
  int done, of;             /* DERIVE: requests that are answered, of so many */
  double t, t_begin, t_end; /* RUN, CERTIFY: s */
  double step;              /* s, the last one */
  double energy_drift;      /* relative; NaN when energy is not conserved */
  long steps;
} pleuel_progress;

/* pleuel_set_progress has `progress` called during long calls: when a stage begins, and then about
 * ten times a second.  A result other than 0 stops the call. */
void pleuel_set_progress(pleuel* ctx, int (*progress)(void* user, const pleuel_progress* where),
                         void* user);

/* pleuel_set_poll has `poll` called about ten times a second during long calls, for languages that
 * look for signals themselves (Python: PyErr_CheckSignals).  Other than 0 stops the call. */
void pleuel_set_poll(pleuel* ctx, int (*poll)(void* user), void* user);

/* pleuel_write_function takes n bytes of what is written, in order. Other than 0: they cannot be
 * taken, and the call ends with PLEUEL_FILE.
 *     int to_file(void* file, const void* bytes, size_t n) {
 *       return fwrite(bytes, 1, n, file) != n;
 *     } */
typedef int pleuel_write_function(void* user, const void* bytes, size_t n);

/* pleuel_set_folders chooses where compiled steps are kept between programs ("": nowhere; NULL: by
 * PLEUEL_CACHE, else the folder for caches of the user), and where the compiler plug-in lies (NULL:
 * beside the library).  The plug-in is opened once in a process, by the first that needs it. */
pleuel_status pleuel_set_folders(pleuel* ctx, const char* cache, const char* plugin);

/* --------------------------------------------------------------------------------------- models */

/* pleuel_model is a text that was read, and what has been found out about it so far. */
typedef struct pleuel_model pleuel_model;

/* pleuel_setting replaces the value of a parameter before anything else is done: "m2", "500[g]";
 * "N", "50". */
typedef struct pleuel_setting {
  const char* name;
  const char* value;
} pleuel_setting;

typedef struct pleuel_load_options {
  size_t size;
  const char* name;               /* file name for messages; default: the path, or "<text>" */
  const pleuel_setting* settings; /* (n_settings) */
  size_t n_settings;
  /* read returns the text of a file that the model includes, NULL when it cannot be had; path as
   * written, from the name of the file that includes it. The text is copied before the next call.
   * Without it texts may include nothing and files may include what lies beside them. */
  const char* (*read)(void* user, const char* path, const char* from);
  void* read_user;
  /* 1: of a text with errors, statements that have none count: check, picture and motion go on with
   * them, and their status speaks of them. For editors */
  int tolerant;
} pleuel_load_options;

/* pleuel_load_text reads a model from memory, pleuel_load_file from a file. *model is set even when
 * the text has errors (PLEUEL_MODEL_ERROR), so that its diagnostics can be read; it is NULL when
 * there was no text (PLEUEL_FILE, PLEUEL_NO_MEMORY). */
pleuel_status pleuel_load_text(pleuel* ctx, pleuel_model** model, const char* text, size_t size,
                               const pleuel_load_options* options);
pleuel_status pleuel_load_file(pleuel* ctx, pleuel_model** model, const char* path,
                               const pleuel_load_options* options);
void pleuel_model_free(pleuel_model* model);

/* pleuel_failure_json returns the JSON document (docs/json.md) of a file that gave no model at all:
 * status and the sentence of pleuel_message. NULL when memory ran out. */
const char* pleuel_failure_json(pleuel* ctx, const char* file, pleuel_status status);

/* ------------------------------------------------------------------------------------- messages */

typedef enum pleuel_severity {
  PLEUEL_ERROR = 0,
  PLEUEL_WARNING = 1,
  PLEUEL_NOTE = 2
} pleuel_severity;

/* pleuel_diagnostic_count returns how many messages there are of this severity, in the order of
 * their places. */
size_t pleuel_diagnostic_count(const pleuel_model* model, pleuel_severity severity);

typedef struct pleuel_text_options {
  size_t size;
  const char* lang; /* "en", "de"; default: that of the context */
  int colour;       /* 1: ANSI colours */
  int terse;        /* 1: one line a message, file:line:col: CODE: sentence */
} pleuel_text_options;

/* pleuel_diagnostics_text returns all messages of these severities as text, "" if there are none.
 * severities is a sum of 1 << severity. Never NULL unless memory ran out. */
const char* pleuel_diagnostics_text(pleuel_model* model, unsigned severities,
                                    const pleuel_text_options* options);

/* ---------------------------------------------------------------------------------------- check */

/* pleuel_check looks at names, units, families, counts freedoms and ranks, and looks for a
 * consistent start; it solves nothing. *summary, if not NULL, is a line or two in words. */
pleuel_status pleuel_check(pleuel_model* model, const char** summary,
                           const pleuel_text_options* options);
/* pleuel_check_json returns the same as a JSON document (docs/json.md); also when the model has
 * errors. */
pleuel_status pleuel_check_json(pleuel_model* model, const char** json,
                                const pleuel_text_options* options);

/* ---------------------------------------------------------------------------------------- solve */

typedef enum pleuel_math { PLEUEL_MATH_LINE = 0, PLEUEL_MATH_2D, PLEUEL_MATH_ASCII } pleuel_math;

typedef struct pleuel_solve_options {
  size_t size;
  const char* only; /* letters of the requests, "b,c"; NULL: all */
  const char* lang; /* "en", "de"; default: that of the file, then that of the context */
  int full;         /* 1: every step, 0: the steps one would write down */
  pleuel_math math;
  int width;         /* cells of a line; 0: lines are not wrapped */
  int colour;        /* 1: ANSI colours */
  int no_simulation; /* 1: leave out the motion that `simulate` asks for */
  int timing;        /* 1: the JSON document tells how long each stage took */
  double seconds;    /* time for finding a shorter form of each quantity; 0: the default */
} pleuel_solve_options;

/* pleuel_solve_text works the model out and returns the worked solution. Each formula shown was
 * checked against the model first; PLEUEL_EXPECT_FAILED: a check or an `expect` failed, the text
 * says which. */
pleuel_status pleuel_solve_text(pleuel_model* model, const char** text,
                                const pleuel_solve_options* options);

/* pleuel_solve_json returns the same as a JSON document, schema version 1 (docs/json.md); also when
 * it fails. */
pleuel_status pleuel_solve_json(pleuel_model* model, const char** json,
                                const pleuel_solve_options* options);

/* pleuel_export returns the formulas of the worked solution in the language of another program:
 * target is "sympy", "mathematica", "maxima", "julia", "python" or "json". Of the options `only`
 * and `seconds` count. *text is set with PLEUEL_EXPECT_FAILED and PLEUEL_NO_CLOSED_FORM too, for
 * what there is. */
pleuel_status pleuel_export(pleuel_model* model, const char** text, const char* target,
                            const pleuel_solve_options* options);

typedef struct pleuel_tex_options {
  size_t size;
  const char* only; /* letters of the requests; NULL: all */
  const char* lang; /* "en", "de"; default: that of the file, then that of the context */
  int full;         /* 1: every step */
  int standalone;   /* 1: a document of its own, 0: a fragment that needs amsmath */
  /* 1: \dot, \vec themselves, 0: macros \pldot, \plvec that may be redefined */
  int plain;
  int no_figure;     /* 1: without the picture of the system */
  int no_simulation; /* 1: leave out the motion that `simulate` asks for */
  double seconds;    /* time for finding a shorter form of each quantity; 0: the default */
} pleuel_tex_options;

/* pleuel_tex returns the worked solution in LaTeX, numbered and labelled; the figure needs TikZ and
 * is left out where it is not loaded. Status as pleuel_solve_text. */
pleuel_status pleuel_tex(pleuel_model* model, const char** text, const pleuel_tex_options* options);

typedef enum pleuel_report_data {
  PLEUEL_DATA_THIN = 0,
  PLEUEL_DATA_NONE,
  PLEUEL_DATA_FULL
} pleuel_report_data;

typedef struct pleuel_report_options {
  size_t size;
  const char* only; /* letters of the requests; NULL: all */
  const char* lang; /* "en", "de"; default: that of the file, then that of the context */
  int no_font;      /* 1: formulas in the fonts of the reader's machine, 40 kB less */
  int no_animation; /* 1: plots only */
  /* what can be saved from the page: what the plots show, nothing, or every row */
  pleuel_report_data data;
  const char* command; /* told in the last lines; NULL: not told */
  double seconds;      /* time for finding a shorter form of each quantity; 0: the default */
} pleuel_report_options;

/* pleuel_report returns one HTML page that needs nothing beside it: result, motion, derivation,
 * checks, model. What stands in a model is shown as text, whatever it contains. Status as
 * pleuel_solve_text; *html is set whenever there is a solution. */
pleuel_status pleuel_report(pleuel_model* model, const char** html,
                            const pleuel_report_options* options);

/* ------------------------------------------------------------------------------------- simulate */

typedef enum pleuel_method {
  PLEUEL_METHOD_AUTO = 0, /* series, implicit where that is far cheaper */
  PLEUEL_METHOD_TAYLOR,   /* series */
  PLEUEL_METHOD_RADAU     /* implicit, for stiff motions */
} pleuel_method;

typedef enum pleuel_engine {
  PLEUEL_ENGINE_AUTO = 0, /* compiled when the work ahead pays for it */
  PLEUEL_ENGINE_INTERPRETER,
  PLEUEL_ENGINE_COMPILED
} pleuel_engine; /* how steps are computed: the same results, bit for bit */

typedef enum pleuel_precision {
  PLEUEL_PRECISION_DOUBLE = 0,
  PLEUEL_PRECISION_LONG, /* 64 binary digits, rounded once a step, for long runs */
  PLEUEL_PRECISION_QUAD  /* 113 binary digits */
} pleuel_precision;      /* CSV has all their digits */

typedef struct pleuel_sim_options {
  size_t size;
  int has_until, has_tol, has_dt; /* 1: the member below is given, else the file decides */
  double until;                   /* end, s */
  double tol;                     /* relative local error of a step */
  double dt;                      /* distance of output times, s; not given: every step */
  /* columns is called once, then row for each output time, then nothing more. A result other than 0
   * stops the run with PLEUEL_INTERRUPTED. mode names the contacts: "contact(h)", "free", "" when
   * nothing is one-sided. */
  int (*columns)(void* user, size_t n, const char* const* names, const char* const* units);
  int (*row)(void* user, size_t n, const double* values, const char* mode);
  void* user;
  pleuel_method method;
  pleuel_engine engine;
  pleuel_precision precision;
  int no_rows; /* 1: a pleuel_result keeps the first and the last row only */
  /* "m2,x0": columns d(x)/d(m2), d(x)/d(x0) and so on, the derivatives of coordinates, velocities
   * and multipliers by parameters and start values */
  const char* sensitivities;
  pleuel_write_function* csv; /* rows as CSV, beside the others */
  void* csv_user;
  /* The rest counts in pleuel_simulate only. csv_file names a file that the rows are written to. A
   * run that is interrupted can go on bit for bit: `state` names the file that it keeps its state
   * in, written now and then and when it is interrupted. With resume = 1 the run goes on from
   * there: same model, same options, same program; else PLEUEL_USAGE and a sentence that names what
   * differs, or PLEUEL_FILE. csv_file must then hold the rows of before; those behind the state are
   * cut off. `row` is called for what follows the state: of the rows before, the first rows_kept of
   * the summary count. The file of the state stays when the run is complete. */
  const char* csv_file;
  const char* state;
  /* s by the clock from state to state; 0: 10; below 0: only when interrupted */
  double state_every;
  int resume;
  /* told when the run was interrupted and its state kept; NULL: the file is told */
  const char* resume_command;
  /* 1: prove intervals for the true motion, at the end or at the times of dt; they are told by
   * pleuel_simulation_text and _json */
  int certify;
  /* largest half width wanted, relative to the largest coordinate or velocity; 0: 1e-18 */
  double certify_width;
  /* with the numbers above: the same as text, "0.1", "500[ms]", so that they are exact in wider
   * numbers too; or NULL */
  const char *until_as_written, *dt_as_written;
} pleuel_sim_options;

typedef struct pleuel_summary {
  size_t size;
  pleuel_status status;
  double t_end; /* s, reached; NaN: it did not start */
  long steps, rejected;
  double residual_g;    /* largest |g|, relative to the size of its terms */
  double residual_gdot; /* largest |dg/dt|, likewise */
  double energy_drift;  /* largest, relative; NaN when energy is not conserved */
  size_t n_events, n_columns;
  size_t n_rows;        /* that were computed */
  size_t n_rows_stored; /* that the result holds */
  size_t rows_kept;     /* of all rows, those that the state in the file stands behind */
} pleuel_summary;

/* pleuel_simulate computes the motion. summary may be NULL. A run that cannot go on ends with
 * PLEUEL_NUMERICAL or PLEUEL_SINGULAR and the place in pleuel_message; the rows up to there have
 * been handed over. */
pleuel_status pleuel_simulate(pleuel_model* model, pleuel_summary* summary,
                              const pleuel_sim_options* options);

/* pleuel_simulation_text and _json tell about the last run: events with their states, residuals,
 * drift. */
const char* pleuel_simulation_text(pleuel_model* model, const pleuel_text_options* options);
const char* pleuel_simulation_json(pleuel_model* model);

/* pleuel_simulation_engine tells how the steps of the last run were computed: interpreted, or
 * compiled from some step on, and why not. It may differ from run to run, unlike the motion. */
const char* pleuel_simulation_engine(pleuel_model* model, const pleuel_text_options* options);

/* -------------------------------------------------------------------------------------- results */

/* pleuel_result is a motion that was computed: rows, events, how exact it is. */
typedef struct pleuel_result pleuel_result;
void pleuel_result_free(pleuel_result* result);

pleuel_status pleuel_result_summary(const pleuel_result* result, pleuel_summary* summary);

/* What a name is. ORDER NAME KINDS */
typedef enum pleuel_kind {
  PLEUEL_KIND_TIME = 0,
  PLEUEL_KIND_COORDINATE,
  PLEUEL_KIND_VELOCITY,
  PLEUEL_KIND_MULTIPLIER,
  PLEUEL_KIND_OUTPUT, /* energies, `output` lines, sensitivities */
  PLEUEL_KIND_PARAMETER,
  PLEUEL_KIND_INPUT,
  PLEUEL_KIND_CONSTRAINT,
  PLEUEL_KIND_MASS,
  PLEUEL_KIND_BODY,
  PLEUEL_KIND_POINT,
  PLEUEL_KIND_FORCE, /* labels of forces, springs, dampers, potentials and so on */
  PLEUEL_KIND_EVENT,
  PLEUEL_KIND_ABBREVIATION,
  PLEUEL_KIND_FUNCTION,
  PLEUEL_KIND_INDEX, /* of `for` and `sum`, arguments of functions */
  PLEUEL_KIND_AXIS,
  PLEUEL_KIND_REQUEST /* the letter of an `ask` */
} pleuel_kind;

/* A column.  Value of row k: at[k * stride], NaN where none is determined.  Nothing is copied: the
 * array belongs to the result and is kept. */
typedef struct pleuel_column {
  size_t size;
  pleuel_kind kind;
  const char* name;  /* as in CSV, ASCII: "theta"; kept */
  const char* shown; /* as in formulas: "ϑ"; kept */
  const char* unit;  /* "m/s"; "" without; kept */
  const double* at;  /* NULL where the column has no rows */
  size_t stride, n;  /* in doubles; rows */
} pleuel_column;

/* pleuel_result_column describes column i; pleuel_result_find gives the number of a name, in either
 * spelling, -1 if there is none. */
pleuel_status pleuel_result_column(const pleuel_result* result, size_t i, pleuel_column* column);
long pleuel_result_find(const pleuel_result* result, const char* name);
/* pleuel_result_mode names the contacts of a row.  Kept. */
const char* pleuel_result_mode(const pleuel_result* result, size_t row);

typedef enum pleuel_event_kind {
  PLEUEL_EVENT_NAMED = 0, /* `event label` */
  PLEUEL_EVENT_RELEASE,   /* a contact ended */
  PLEUEL_EVENT_IMPACT,    /* a contact was made with a velocity jump */
  PLEUEL_EVENT_CONTACT,   /* a contact was made without one */
  PLEUEL_EVENT_SINGULAR,  /* the constraints lose rank here */
  PLEUEL_EVENT_STOP,      /* `event label -> stop` */
  PLEUEL_EVENT_SLACK,     /* a rope went slack */
  PLEUEL_EVENT_TAUT,      /* a rope went taut */
  PLEUEL_EVENT_STICK,     /* surfaces that slipped stick */
  PLEUEL_EVENT_SLIP       /* surfaces that stuck slip, or slip the other way */
} pleuel_event_kind;

typedef struct pleuel_event {
  size_t size;
  pleuel_event_kind kind;
  const char* label;            /* of the event or constraint; "" without */
  double t;                     /* s */
  const double *before, *after; /* rows; NULL when they were not kept */
  const char* mode;             /* contacts after it */
  double impulse;               /* of an impact, along the gradient of the constraint */
  int jump;                     /* 1: velocities jumped */
  long bounces;                 /* of a contact after endlessly many: those that were followed */
} pleuel_event;
/* pleuel_result_event gives event i, in order of time; its arrays and texts are kept. */
pleuel_status pleuel_result_event(const pleuel_result* result, size_t i, pleuel_event* event);

/* ------------------------------------------------------------------------------- system and run */

/* A system is what the motion of a model needs: equations as programs, names, numbers. It does not
 * change, so threads share it. A run is one motion of it, with memory and numbers of its own: it is
 * opened, given other numbers, started, and stepped. Opening a run derives nothing:
 *
 *     pleuel_system* system;
 *     pleuel_run* run;
 *     pleuel_system_make(model, &system, NULL);
 *     pleuel_run_open(system, &run, NULL);
 *     for (double l = 0.5; l < 2; l += 0.1) {
 *       double x;
 *       if (pleuel_run_set(run, "l", l) == PLEUEL_OK && pleuel_run_start(run) == PLEUEL_OK
 *           && pleuel_run_advance(run, 10, 0) == PLEUEL_OK) pleuel_run_get(run, "x", &x);
 *       else puts(pleuel_run_message(run));
 *     }
 *     pleuel_run_close(run);
 *     pleuel_system_free(system); */
typedef struct pleuel_system pleuel_system;
typedef struct pleuel_run pleuel_run;

/* pleuel_system_make makes the system of a model with its settings. It lives on when the model is
 * freed. Of the options, precision and sensitivities count here; the others are the defaults of its
 * runs. Each owner keeps it once and frees it once; the last one frees its memory. */
pleuel_status pleuel_system_make(pleuel_model* model, pleuel_system** system,
                                 const pleuel_sim_options* options);
pleuel_system* pleuel_system_keep(pleuel_system* system);
void pleuel_system_free(pleuel_system* system);

/* pleuel_system_count tells how many quantities of a kind there are, pleuel_system_quantity
 * describes one: `at` is NULL, but for parameters and inputs, whose number in the text it points
 * to. */
size_t pleuel_system_count(const pleuel_system* system, pleuel_kind kind);
pleuel_status pleuel_system_quantity(const pleuel_system* system, pleuel_kind kind, size_t i,
                                     pleuel_column* quantity);

/* pleuel_run_open opens a run; *run is NULL only when memory ran out.  options NULL: those of the
 * system.  The sentence of a failure of any function below is in pleuel_run_message. */
pleuel_status pleuel_run_open(pleuel_system* system, pleuel_run** run,
                              const pleuel_sim_options* options);
void pleuel_run_close(pleuel_run* run);
const char* pleuel_run_message(const pleuel_run* run);
void pleuel_run_interrupt(pleuel_run* run);
void pleuel_run_interrupt_clear(pleuel_run* run);

/* pleuel_run_set gives a parameter, an input, or a start value (coordinate, velocity: "x1",
 * "x1_dot") another number. What depends on it follows: other parameters, start values. A parameter
 * or a start value counts from the next pleuel_run_start on, an input at once. PLEUEL_USAGE for
 * unknown names and for what a system has fixed: sizes of families, and the sign of what was
 * positive when it was made. PLEUEL_UNSUPPORTED in wider numbers, with sensitivities, and where
 * `events` speak of start values such as E(0): load the model with other settings then. */
pleuel_status pleuel_run_set(pleuel_run* run, const char* name, double si);
/* pleuel_run_get reads a number: a parameter, an input, or any column at the present time. */
pleuel_status pleuel_run_get(pleuel_run* run, const char* name, double* si);
/* pleuel_run_reset takes all numbers back to those of the text. */
void pleuel_run_reset(pleuel_run* run);

/* pleuel_run_input has the inputs given by a function: it fills u (one for each input, in their
 * order) at time t.  It is asked every dt seconds from the start on, and the inputs are held in
 * between, as a digital controller does.  NULL: held as they are set. */
pleuel_status pleuel_run_input(pleuel_run* run,
                               int (*input)(void* user, pleuel_run* run, double t, double* u),
                               void* user, double dt);

/* pleuel_run_start finds the consistent start.  It may be called again at any time. */
pleuel_status pleuel_run_start(pleuel_run* run);

/* pleuel_run_advance steps to time t exactly; with to_event = 1 it stops behind the next event, if
 * one comes earlier. The motion does not go beyond the end of the options, or of the file, if there
 * is one. pleuel_run_step takes one step, as long as it may be. pleuel_run_done: the end is
 * reached. */
pleuel_status pleuel_run_advance(pleuel_run* run, double t, int to_event);
pleuel_status pleuel_run_step(pleuel_run* run);
int pleuel_run_done(const pleuel_run* run);
double pleuel_run_time(const pleuel_run* run);

/* pleuel_run_event gives the event that happened last; PLEUEL_USAGE when none has happened since
 * the start. Its arrays and texts live until the run moves. */
pleuel_status pleuel_run_event(pleuel_run* run, pleuel_event* event);

/* pleuel_run_state copies the state.  Each array may be NULL.
 *   q       positions                      (count of PLEUEL_KIND_COORDINATE)
 *   v       velocities                     (same)
 *   a       accelerations                  (same)
 *   lambda  multipliers, NaN where not determined   (count of PLEUEL_KIND_MULTIPLIER)
 * pleuel_run_dense gives them at a time within the last step. */
pleuel_status pleuel_run_state(pleuel_run* run, double* q, double* v, double* a, double* lambda);
pleuel_status pleuel_run_dense(pleuel_run* run, double t, double* q, double* v, double* a,
                               double* lambda);
/* pleuel_run_set_state goes on from another state, which meets the constraints to 1e-9 of their
 * terms. */
pleuel_status pleuel_run_set_state(pleuel_run* run, double t, const double* q, const double* v);

/* pleuel_run_sample steps to the last of n times, which follow each other, and fills a row for
 * each: all columns, at block[i * stride]. stride in doubles, at least the number of columns. */
pleuel_status pleuel_run_sample(pleuel_run* run, const double* t, size_t n, double* block,
                                size_t stride);

/* pleuel_run_rhs gives accelerations and multipliers at any state, by the constraints in force
 * there; the motion of the run is not touched. a, lambda may be NULL. */
pleuel_status pleuel_run_rhs(pleuel_run* run, double t, const double* q, const double* v, double* a,
                             double* lambda);

/* pleuel_run_linearise gives the derivatives of the accelerations about the present state, all by
 * column: by positions, velocities and inputs. Differences of sixth order, good to about ten
 * digits.
 *   a_q (n_q x n_q)   a_v (n_q x n_q)   a_u (n_q x n_u)    each may be NULL */
pleuel_status pleuel_run_linearise(pleuel_run* run, double* a_q, double* a_v, double* a_u);

/* pleuel_run_save writes the state of the run into bytes, *n of them; bytes NULL: only *n. A run of
 * the same system, with the same numbers and options, goes on from them bit for bit after
 * pleuel_run_restore; PLEUEL_FILE for bytes that are none of this run. */
pleuel_status pleuel_run_save(pleuel_run* run, void* bytes, size_t* n);
pleuel_status pleuel_run_restore(pleuel_run* run, const void* bytes, size_t n);

/* pleuel_run_complete computes the whole motion, from its start to its end, as pleuel_simulate
 * does: the same rows, bit for bit. */
pleuel_status pleuel_run_complete(pleuel_run* run, pleuel_result** result);

/* ------------------------------------------------------------------------------------- pictures */

typedef enum pleuel_picture { PLEUEL_SVG = 0, PLEUEL_PNG, PLEUEL_PDF, PLEUEL_GIF } pleuel_picture;
typedef enum pleuel_style { PLEUEL_LIGHT = 0, PLEUEL_DARK, PLEUEL_FOR_PRINT } pleuel_style;
typedef enum pleuel_panels {
  PLEUEL_PANELS_ALL = 0,
  PLEUEL_PANELS_PLOTS,
  PLEUEL_PANELS_DRAWING
} pleuel_panels;

typedef struct pleuel_plot_options {
  size_t size;
  const char* lang;      /* "en", "de"; default: that of the file, then that of the context */
  pleuel_picture format; /* SVG, PNG or PDF; the last two need a build with cairo */
  pleuel_style style;
  pleuel_panels panels; /* the drawing of the system and the plots, or one of them */
  int width, height;    /* pixels (PDF: points); 0: what suits the panels */
  int no_forces;        /* 1: no force arrows in the drawing */
  int has_until;        /* 1: the member below is given, else the file decides */
  double until;         /* end of the motion, s */
} pleuel_plot_options;

/* pleuel_plot draws the system and its motion: each `plot` line of the model is a panel, without
 * such lines coordinates, multipliers and energies are. *bytes is the file, *n its size; owned by
 * the model. Status PLEUEL_UNSUPPORTED for a format that this build cannot write; a motion that
 * ends early is drawn as far as it goes. */
pleuel_status pleuel_plot(pleuel_model* model, const char** bytes, size_t* n,
                          const pleuel_plot_options* options);

typedef struct pleuel_animate_options {
  size_t size;
  const char* lang;      /* "en", "de"; default: that of the file, then that of the context */
  pleuel_picture format; /* SVG, which runs by itself, or GIF, which needs a build with cairo */
  pleuel_style style;
  int width, height; /* pixels; 0: 480 x 440 */
  int forces;        /* 1: with force arrows */
  double fps;        /* frames per second; 0: 15 */
  double seconds;    /* how long it lasts; 0: as the motion, but between 3 s and 12 s */
  int has_until;     /* 1: the member below is given, else the file decides */
  double until;      /* end of the motion, s */
  /* frame, if given, is handed each frame instead: 0x00RRGGBB, row by row from the top; for the
   * makers of films. A result other than 0 stops with PLEUEL_INTERRUPTED. Needs a build with
   * cairo. */
  int (*frame)(void* user, const unsigned* pixels, int width, int height);
  void* user;
} pleuel_animate_options;

/* pleuel_animate shows the motion as a film. *bytes is the file, *n its size, owned by the model;
 * both stay NULL and 0 when `frame` is given. Status as pleuel_plot; PLEUEL_USAGE when nothing says
 * how long the motion lasts. */
pleuel_status pleuel_animate(pleuel_model* model, const char** bytes, size_t* n,
                             const pleuel_animate_options* options);

/* --------------------------------------------------------------------------- messages as fields */

/* For editors. A place in a text: bytes from its beginning, half open, and the same in UTF-16
 * units, as editors and the language server protocol count; lines and columns from 1, columns in
 * characters (code points) and in UTF-16 units. This structure never grows. */
typedef struct pleuel_span {
  const char* file; /* as in messages; NULL: no place, the rest is 0 */
  size_t begin, end;
  size_t begin16, end16;
  size_t line, column, column16;
  size_t end_line, end_column, end_column16;
} pleuel_span;

/* An edit replaces what stands in a span; an empty span inserts.  It never grows. */
typedef struct pleuel_edit {
  pleuel_span span;
  const char* text;
} pleuel_edit;

/* A second place that a message speaks of: "first here".  It never grows. */
typedef struct pleuel_label {
  pleuel_span span;
  const char* text;
} pleuel_label;

typedef struct pleuel_diagnostic {
  size_t size;
  const char* code; /* "E011": pleuel_explain has a page about it */
  pleuel_severity severity;
  pleuel_span span;
  const char* sentence;
  const char* reason; /* NULL */
  const char* hint;   /* what to do, in words; NULL */
  size_t n_labels;
  const pleuel_label* labels;
  size_t n_edits;           /* of the fix: all of them together take the cause away; 0: none, */
  const pleuel_edit* edits; /* only the hint */
} pleuel_diagnostic;

/* pleuel_diagnostic_get fills in message i, counted over all severities in the order of their
 * places, in the language of the model. PLEUEL_USAGE behind the last. What it points to is kept
 * until other messages come, by a check, a solution or a run. */
pleuel_status pleuel_diagnostic_get(pleuel_model* model, size_t i, pleuel_diagnostic* diagnostic);

/* pleuel_edited returns the text of the model with edits made in it; those of other files are left
 * out.  PLEUEL_USAGE when edits overlap. */
pleuel_status pleuel_edited(pleuel_model* model, const pleuel_edit* edits, size_t n,
                            const char** text);

/* ------------------------------------------------------------------------------ names in a text */

/* What follows works on texts with errors too: statements that can be read are, and what a broken
 * line declares is known by name.  Places are bytes of the text itself, not of what it includes. */

typedef struct pleuel_name {
  size_t size;
  pleuel_kind kind;
  const char* ascii;   /* "theta1", "theta1_dot", "lambda_rod": as in CSV and JSON */
  const char* shown;   /* "θ1", "θ1'", "λ_rod" */
  const char* unit;    /* SI, "m/s^2"; "rad" for angles; "1" for numbers; NULL: not known */
  const char* meaning; /* the comment at the end of its line; NULL */
  const char* of;      /* VELOCITY: its coordinate; MULTIPLIER: its constraint; else NULL */
  int family;          /* 1: it has members, x[1] ... */
  int has_value;
  double value;           /* SI: of a parameter; of a coordinate or velocity where it starts */
  pleuel_span span;       /* the name where it is declared */
  pleuel_span definition; /* with its value, "m = 75 [kg]", or the statement */
} pleuel_name;

/* pleuel_name_count and pleuel_name_get list all that has a name, in the order of the text.
 * Kept. */
size_t pleuel_name_count(pleuel_model* model);
pleuel_status pleuel_name_get(pleuel_model* model, size_t i, pleuel_name* name);

/* pleuel_name_find finds a name by any of its spellings: θ1, theta1, theta_1, θ1', theta1_dot,
 * λ_rod. PLEUEL_USAGE when nothing is called so. */
pleuel_status pleuel_name_find(pleuel_model* model, const char* spelling, pleuel_name* name);

/* A place where a name stands; the span covers its own letters: x of x_dot, rod of λ_rod. It never
 * grows. */
typedef struct pleuel_use {
  pleuel_span span;
  int defines; /* 1: here it is declared */
} pleuel_use;

/* pleuel_uses lists all places of the name that stands at a byte; n = 0 where none does. */
pleuel_status pleuel_uses(pleuel_model* model, size_t at, const pleuel_use** uses, size_t* n);

/* pleuel_rename gives the edits that call the name at a byte otherwise, everywhere, included files
 * too.  PLEUEL_USAGE and a sentence when the new name is none, or is taken. */
pleuel_status pleuel_rename(pleuel_model* model, size_t at, const char* name,
                            const pleuel_edit** edits, size_t* n);

/* pleuel_hover says in a few lines (Markdown) what stands at a byte: of a name its kind, unit,
 * value, meaning and definition; of a word of the language how it is used; of a unit what it is.
 * *text is NULL where there is nothing to say.  span may be NULL. */
pleuel_status pleuel_hover(pleuel_model* model, size_t at, const char** text, pleuel_span* span);

typedef enum pleuel_offer_kind {
  PLEUEL_OFFER_STATEMENT = 0, /* a word that begins a statement */
  PLEUEL_OFFER_REQUEST,       /* of `ask` */
  PLEUEL_OFFER_WORD,          /* at, on, with, ... */
  PLEUEL_OFFER_NAME,
  PLEUEL_OFFER_FUNCTION,
  PLEUEL_OFFER_UNIT
} pleuel_offer_kind;

typedef struct pleuel_offer {
  pleuel_offer_kind kind;
  pleuel_kind name_kind; /* of a name */
  const char* text;      /* what to write */
  const char* form;      /* how it is used, "gravity EXPR along [-]AXIS"; NULL */
  const char* meaning;   /* in words; NULL */
} pleuel_offer;          /* It never grows. */

/* pleuel_complete lists what may stand at a byte, whatever stands behind it. *span is the piece of
 * a word that is there already and would be replaced; offers are not narrowed to it. */
pleuel_status pleuel_complete(pleuel_model* model, size_t at, pleuel_span* span,
                              const pleuel_offer** offers, size_t* n);

typedef enum pleuel_token_kind {                             /* ORDER TOKEN KINDS */
                                 PLEUEL_TOKEN_STATEMENT = 0, /* a word that begins a statement */
                                 PLEUEL_TOKEN_REQUEST,       /* of `ask` */
                                 PLEUEL_TOKEN_WORD,          /* other words of the language */
                                 PLEUEL_TOKEN_NAME,
                                 PLEUEL_TOKEN_FUNCTION,
                                 PLEUEL_TOKEN_NUMBER,
                                 PLEUEL_TOKEN_UNIT,
                                 PLEUEL_TOKEN_TEXT,
                                 PLEUEL_TOKEN_COMMENT,
                                 PLEUEL_TOKEN_PRINTED, /* #: comments, printed with the solution */
                                 PLEUEL_TOKEN_SIGN,
                                 PLEUEL_TOKEN_WRONG /* what does not belong there */
} pleuel_token_kind;

typedef struct pleuel_token {
  pleuel_token_kind kind;
  int name_kind; /* of a name that is declared: pleuel_kind; else -1 */
  int defines;   /* 1: it is declared here */
  pleuel_span span;
} pleuel_token; /* It never grows. */

/* pleuel_tokens cuts the text into tokens as the program reads it, for colours.  Kept. */
pleuel_status pleuel_tokens(pleuel_model* model, const pleuel_token** tokens, size_t* n);

/* ------------------------------------------------------------------------------------- formulas */

/* pleuel_formula is a formula of the worked solution as a value. Formulas belong to the model; they
 * and what they hand out are kept until the model is solved again with other options, or freed. */
typedef struct pleuel_formula pleuel_formula;

/* pleuel_formulas works the model out (options as for the solution: only, seconds) and counts its
 * formulas: one for each value of docs/json.md, one for each component of a vector. */
pleuel_status pleuel_formulas(pleuel_model* model, const pleuel_solve_options* options, size_t* n);

/* pleuel_formula_get returns formula i; NULL behind the last. pleuel_formula_find returns that of a
 * name, "x1_ddot", "λ_rod", or the first of a request, "b"; NULL when there is none. */
const pleuel_formula* pleuel_formula_get(pleuel_model* model, size_t i);
const pleuel_formula* pleuel_formula_find(pleuel_model* model, const char* name);

typedef struct pleuel_formula_info {
  size_t size;
  const char* letter;  /* of the request; NULL without one */
  const char* item;    /* the request as written: "solve λ" */
  const char* name;    /* what it is: "x1_ddot", "lambda_rod", "E"; NULL for derivatives */
  const char *of, *on; /* constraint, mass, mode; NULL */
  const char* along;   /* of a component: "e_r"; NULL */
  const char* branch;  /* the condition that picks it among several; NULL */
  const char* unit;    /* SI; NULL: not known */
  /* at the numbers of the model; NaN: it depends on the state, or on names without a number */
  double number;
  int certified;     /* 1: it was checked against the model */
  int withdrawn;     /* 1: the simulated motion contradicts it; it has no text and no value */
  size_t n_assuming; /* conditions under which it holds: "r < l" */
  const char* const* assuming;
  size_t n_free;           /* names in it, abbreviations by what they stand for */
  const char* const* free; /* as in `expr` of docs/json.md, each once */
  pleuel_span span;        /* the request in the text; file NULL: a standard request */
} pleuel_formula_info;
pleuel_status pleuel_formula_about(const pleuel_formula* formula, pleuel_formula_info* info);

typedef enum pleuel_notation {
  PLEUEL_NOTATION_LINE = 0, /* as displayed, in one line */
  PLEUEL_NOTATION_2D,       /* fractions over several lines */
  PLEUEL_NOTATION_ASCII,    /* the model language, blank products */
  PLEUEL_NOTATION_LATEX,
  PLEUEL_NOTATION_MATHML, /* a <math> element */
  PLEUEL_NOTATION_EXPR    /* for programs: every product a *, SI numbers (docs/json.md) */
} pleuel_notation;

/* pleuel_formula_text writes a formula; NULL when it was withdrawn, or memory ran out. */
const char* pleuel_formula_text(const pleuel_formula* formula, pleuel_notation notation);

/* A formula as a tree.  Node 0 is the root, children come behind their parents. */
typedef enum pleuel_node_kind {
  PLEUEL_NODE_NUMBER = 0, /* value; exact as text, "-3/4" */
  PLEUEL_NODE_PI,
  PLEUEL_NODE_INFINITY,
  PLEUEL_NODE_NAME, /* text: "theta1_dot" */
  PLEUEL_NODE_ADD,  /* any number of children */
  PLEUEL_NODE_MULTIPLY,
  PLEUEL_NODE_POWER, /* base, exponent */
  PLEUEL_NODE_CALL,  /* text: "sin" */
  PLEUEL_NODE_IF,    /* a, b, c: b where a > 0, else c */
  PLEUEL_NODE_SUM,   /* text: the index; from, to, summand */
  PLEUEL_NODE_MEMBER /* text: the family; its index */
} pleuel_node_kind;

typedef struct pleuel_node {
  pleuel_node_kind kind;
  const char* text;    /* NULL */
  double value;        /* of a number, π; else NaN */
  size_t n;            /* children */
  const size_t* child; /* (n) numbers of nodes */
} pleuel_node;         /* It never grows. */

/* pleuel_formula_tree returns the nodes, equal parts once; *n of them. NULL when it was
 * withdrawn. */
const pleuel_node* pleuel_formula_tree(const pleuel_formula* formula, size_t* n);

/* pleuel_formula_value evaluates a formula: names[i] has the value values[i] in SI, whatever its
 * spelling; other parameters have the numbers of the model. PLEUEL_USAGE and a sentence when a name
 * is unknown, or one in the formula has no value. */
pleuel_status pleuel_formula_value(const pleuel_formula* formula, const char* const* names,
                                   const double* values, size_t n, double* value);

/* pleuel_formula_derivative returns the derivative by a name, as a formula of the same model. */
pleuel_status pleuel_formula_derivative(const pleuel_formula* formula, const char* name,
                                        const pleuel_formula** derivative);

/* ---------------------------------------------------------------------- steps as they are ready */

typedef enum pleuel_step_kind {
  PLEUEL_STEP_SECTION = 0, /* a request is answered: its steps follow */
  PLEUEL_STEP_TEXT,
  PLEUEL_STEP_EQUATION,
  PLEUEL_STEP_ROW, /* of a table */
  PLEUEL_STEP_HEADING,
  PLEUEL_STEP_NOTE,
  PLEUEL_STEP_VERDICT /* at the end, for each section: checked, or withdrawn */
} pleuel_step_kind;

/* A step of the worked solution.  While it is at work nothing was checked yet: what a step says
 * counts when the verdict of its section has come.  Texts live until the function returns. */
typedef struct pleuel_step {
  size_t size;
  pleuel_step_kind kind;
  size_t section;     /* number of the section, from 0 */
  const char* letter; /* of the request; NULL */
  const char* item;   /* the request as written */
  const char* text;   /* formulas in one line */
  const char* tex;    /* NULL where there is nothing to show */
  int number;         /* of a numbered equation; 0 */
  int detail;         /* 1: shown among all steps only */
  int passed;         /* VERDICT: 1 checked, 0 withdrawn */
  pleuel_span span;   /* the request in the text; file NULL: a standard request */
} pleuel_step;

/* pleuel_steps works the model out and hands over each section as it becomes ready, then the
 * verdicts.  A result other than 0 stops with PLEUEL_INTERRUPTED.  Of the options `lang`, `only`,
 * `seconds` count.  The status is that of the solution. */
pleuel_status pleuel_steps(pleuel_model* model, const pleuel_solve_options* options,
                           int (*step)(void* user, const pleuel_step* step), void* user);

/* ----------------------------------------------------------------------------------------- drag */

/* pleuel_drag moves a point of the system to another place: new start values that satisfy the
 * constraints, found by following the point on its way, so that the assembly stays; of all the ways
 * to get there the one that moves the masses least. Contacts that are closed stay closed, others do
 * not open into their walls. */
typedef struct pleuel_drag pleuel_drag;

/* pleuel_drag_open takes hold of a point: the label of a mass, body or point. PLEUEL_USAGE when
 * there is none of this name, PLEUEL_UNSUPPORTED and a sentence when it cannot move. */
pleuel_status pleuel_drag_open(pleuel_model* model, const char* point, pleuel_drag** drag);
void pleuel_drag_free(pleuel_drag* drag);

/* pleuel_drag_place returns the place of the point now, along the axes; n of them. */
const double* pleuel_drag_place(const pleuel_drag* drag, size_t* n);

/* pleuel_drag_to moves the point as near to a place as the constraints let it; n numbers along the
 * axes, in m.  pleuel_drag_throw gives it a velocity instead, in m/s. */
pleuel_status pleuel_drag_to(pleuel_drag* drag, const double* place, size_t n);
pleuel_status pleuel_drag_throw(pleuel_drag* drag, const double* velocity, size_t n);

/* pleuel_drag_state returns coordinates and velocities now: names as in `sim`, *n of each. */
pleuel_status pleuel_drag_state(const pleuel_drag* drag, const char* const** names,
                                const double** q, const double** v, size_t* n);

/* pleuel_drag_edits gives the edits of the text that write the new start: numbers of `init` in the
 * unit they were written in, and lines for what else has to be said. The edited text starts there:
 * it is read and tried first. PLEUEL_UNSUPPORTED and a sentence when the text cannot say it. */
pleuel_status pleuel_drag_edits(pleuel_drag* drag, const pleuel_edit** edits, size_t* n);

/* ----------------------------------------------------------------------------------------- more */

typedef enum pleuel_spelling {
  PLEUEL_SPELL_KEEP = 0,
  PLEUEL_SPELL_UNICODE,
  PLEUEL_SPELL_ASCII
} pleuel_spelling;

/* pleuel_format returns the text of the model in canonical layout; it changes no meaning. */
pleuel_status pleuel_format(pleuel_model* model, const char** text, pleuel_spelling spelling);

/* pleuel_dump prints the value at an arrow of the pipeline as text: after "check", "derive" or
 * "record". */
pleuel_status pleuel_dump(pleuel_model* model, const char** text, const char* after);

/* pleuel_explain returns the page of the manual about a message, "E021"; NULL when there is none.
 * Markdown. */
const char* pleuel_explain(pleuel* ctx, const char* code);

/* pleuel_codes lists the messages there are, one a line: code and title. */
const char* pleuel_codes(pleuel* ctx);

/* pleuel_units explains a unit, "m/s": dimension, factor to SI; PLEUEL_USAGE and near names for
 * what is none. */
pleuel_status pleuel_units(pleuel* ctx, const char** text, const char* unit);

/* pleuel_quantity reads a number with an optional unit, "0.5", "500[ms]", into SI; PLEUEL_USAGE
 * when it is none. */
pleuel_status pleuel_quantity(pleuel* ctx, double* value, const char* text);

/* pleuel_template returns a commented model to start from, titled with this name. */
const char* pleuel_template(pleuel* ctx, const char* name);

/* pleuel_example returns name and text of the i-th built-in example, NULL behind the last one.
 * Static. */
const char* pleuel_example(size_t i, const char** name);

#ifdef __cplusplus
}
#endif
#endif
