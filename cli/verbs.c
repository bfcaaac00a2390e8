// The table of verbs, and the words that later versions will understand.
#include "cli.h"

#include <string.h>

const cli_verb cli_verbs[] = {
    {"solve", "FILE...", "worked solution as text", flags_solve, verb_solve,
     "FILE may be - for stdin. `pleuel FILE` is the same as `pleuel solve FILE`."},
    {"check", "FILE...", "names, units, degrees of freedom, rank, start; nothing is solved",
     flags_check, verb_check, "The messages are the answer here, so they go to stdout."},
    {"sim", "FILE", "simulate, write the motion", flags_sim, verb_sim,
     "Without -o only events and accuracy are told. Ctrl-C keeps what is there; --resume goes on."},
    {"report", "FILE", "everything in one HTML page: result, motion, derivation, checks",
     flags_report, verb_report,
     "The page needs nothing beside it and loads nothing. Its derivation needs no script."},
    {"plot", "FILE", "the drawing of the system and plots of its motion", flags_plot, verb_plot,
     "Each `plot` line of the model is a panel. A model without `simulate` is drawn at its start."},
    {"animate", "FILE", "the motion as a film: SVG that runs by itself, GIF, MP4", flags_animate,
     verb_animate,
     "MP4 is made by the program ffmpeg. What is shown lasts as long as the motion, but between 3 "
     "s and 12 s."},
    {"fmt", "FILE...", "canonical layout, in place; - formats stdin to stdout", flags_fmt, verb_fmt,
     NULL},
    {"new", "NAME", "write a commented model NAME.pleuel to start from", flags_new, verb_new, NULL},
    {"examples", "[NAME...]", "list the built-in examples, or print one", flags_examples,
     verb_examples, "`pleuel examples atwood | pleuel -` solves one."},
    {"explain", "CODE", "what a message means and how to mend it", flags_explain, verb_explain,
     "Without a code: the list of all messages."},
    {"units", "UNIT", "dimension and SI factor of a unit", flags_units, verb_units, NULL},
    {"export", "FILE", "the formulas for SymPy, Mathematica, Maxima or Julia, or as JSON",
     flags_export, verb_export,
     "Each formula has a key: letter, name, and of, on, at, along what. C is not among the targets "
     "of this version."},
    {"tex", "FILE", "worked solution in LaTeX", flags_tex, verb_tex,
     "A fragment needs amsmath; its figure appears where TikZ is loaded.  --standalone is for "
     "pdflatex and lualatex."},
    {"dump", "FILE", "what the program thinks, at an arrow of its pipeline", flags_dump, verb_dump,
     NULL},
    {"completion", "SHELL", "completions for bash, zsh or fish", flags_completion, verb_completion,
     "For this session:  source <(pleuel completion bash)"},
    {"help", "[VERB]", "this overview, or the page of a verb", flags_help, verb_help, NULL},
    {NULL, NULL, NULL, NULL, NULL, NULL},
};

const cli_verb* cli_verb_find(const char* name) {
  for (const cli_verb* v = cli_verbs; v->name; v++) {
    if (strcmp(v->name, name) == 0) return v;
  }
  return NULL;
}

const char* cli_later_verb(const char* name) {
  static const char* const later[][2] = {
      {"sweep", "parameter grids"},
      {"studio", "the workbench in the browser"},
      {"lsp", "the editor server"},
  };
  for (size_t i = 0; i < sizeof later / sizeof *later; i++) {
    if (strcmp(later[i][0], name) == 0) return later[i][1];
  }
  return NULL;
}
