// report: a solution as something to read. The worked solution as text for a terminal, and the JSON
// document.
//
// Both are functions of their input alone: same solution, same style, same bytes.
#ifndef PL_REPORT_H
#define PL_REPORT_H

#include "worked/worked.h"
#include "scene/scene.h"
#include "result/result.h"

// --------------------------------------------------------------------------- worked solution, text
typedef struct pl_worked_style {
  pl_math math;  // PL_MATH_LINE, PL_MATH_2D or PL_MATH_ASCII (then the whole text is ASCII)
  pl_language lang;
  bool colour;  // ANSI: results bold, labels dim, notes yellow
  bool full;    // --steps full: the detail steps too
  // cells; formulas and sentences are wrapped to it.  0: nothing is wrapped (output is piped)
  int width;
  const char* only;  // letters, comma separated: "b,c"; NULL: all
  // text about the simulated motion, whole lines, put before the checks; NULL: none
  const char* motion;
} pl_worked_style;

// The look of a terminal of 78 cells, in line notation, without colour.
pl_worked_style pl_worked_style_default(pl_language lang);

// pl_worked_text writes the worked solution: title, lettered sections, checks, assumptions. Ends
// with a newline. `notes` are messages that belong at the end of the text; NULL: none (they are
// printed elsewhere, on stderr). Of them only notes are written, not errors, and none that a step
// of the solution has told already.
void pl_worked_text(pl_text* out, const pl_solution* s, const pl_diagnostics* notes,
                    const pl_worked_style* style);

// -------------------------------------------------------------------------------------------- JSON
// The document of `solve --json` and `check --json`, schema version 1 (docs/json.md). What is not
// there is left out of the input (NULL) and becomes an empty list, so that errors have the shape of
// answers.
typedef struct pl_json_input {
  const char* file;                   // as named on the command line
  const pl_model* model;              // NULL: the text could not be read
  const pl_solution* solution;        // NULL: nothing was solved
  const pl_diagnostics* diagnostics;  // all messages; may be NULL
  pleuel_status status;
  const char* message;     // sentence that belongs to status; NULL or "" if none
  pl_language lang;        // of the words in steps and notes
  const char* only;        // letters; NULL: all
  const char* simulation;  // a JSON object for the key "simulation"; NULL: no such key
  // 0: "timing_ms" is an empty object, so that same input gives same bytes
  int n_timing;
  const char* const* timing_name;  // (n_timing)
  const double* timing_ms;         // (n_timing)
} pl_json_input;

// pl_worked_step writes one step: words, formula and words behind it, in a line or in LaTeX.
const char* pl_worked_step(pl_arena* a, pl_pool* pool, const pl_step* s, pl_language lang,
                           pl_math math);

// pl_worked_json writes the document and a final newline. a: memory for scratch; the pool of the
// model is used for printing.
void pl_worked_json(pl_text* out, const pl_json_input* in);

// Is the letter of a section in the list "b,c"?  NULL: all are.
bool pl_worked_wanted(const char* only, const char* letter);

// "ok", "model_error", ...: the value of the key "status".
const char* pl_status_word(pleuel_status s);

// -------------------------------------------------------------------------------------------- HTML
// One page that holds everything: result, motion, derivation, checks, model. It loads nothing, runs
// nothing that stands in a model, and its derivation needs no script.
typedef enum pl_html_amount {
  PL_HTML_DATA_THIN,
  PL_HTML_DATA_NONE,
  PL_HTML_DATA_FULL
} pl_html_amount;

// A curve to plot: a column of the result, or its name and unit when the result has no such column.
typedef struct pl_html_curve {
  const char* name;
  const char* unit;
  int column;
} pl_html_curve;
typedef struct pl_html_plot {
  const char* title;   // NULL: made from the curves
  const char* x_name;  // NULL: over time
  const char* x_unit;
  int x_column;
  int n_curves;
  const pl_html_curve* curves;  // (n_curves)
} pl_html_plot;

typedef struct pl_html_input {
  const pl_solution* solution;
  const pl_diagnostics* notes;  // messages that belong under the derivation; NULL: none
  pl_language lang;
  const char* only;  // letters; NULL: all
  bool no_font, no_animation;
  pl_html_amount data;
  const char* command;  // as it was typed, for the last lines; NULL: not told
  // words of the model language that begin a statement, ended by NULL
  const char* const* words;
  const char* const* small_words;  // and those inside one
  // the motion; result NULL: none
  const pl_result* result;       // with its rows
  const struct pl_scene* scene;  // NULL: no picture
  // columns of the result that a file of `sim` has; those behind it serve plots
  int n_columns;
  int n_plots;
  const pl_html_plot* plots;
  // quantities that were to be plotted and have no numbers; NULL
  const char* unplotted;
  bool energy_conserved;
  double tol;               // tolerance of the run
  const char* run_message;  // why there is no motion, or why it ends early; NULL
  const char* events;       // what happened, line by line: see pl_motion_text; NULL
} pl_html_input;
void pl_html_report(pl_text* out, const pl_html_input* in);

// ------------------------------------------------------------------------------------------- LaTeX
typedef struct pl_tex_style {
  pl_language lang;
  // a document of its own; otherwise a fragment that needs amsmath
  bool standalone;
  // the accents of LaTeX themselves instead of macros that can be redefined
  bool plain;
  bool full;              // the detail steps too
  const char* only;       // letters; NULL: all
  const char* name;       // of the file, for the first line and for labels
  const char* motion;     // text about the simulated motion, whole lines; NULL: none
  const pl_scene* scene;  // drawn with TikZ; NULL: no figure
} pl_tex_style;

// pl_tex writes the worked solution in LaTeX.  notes as in pl_worked_text.
void pl_tex(pl_text* out, const pl_solution* s, const pl_diagnostics* notes,
            const pl_tex_style* style);

#endif
