// export: the formulas of a solution in the language of another program.
#ifndef PL_EXPORT_H
#define PL_EXPORT_H

#include "report/report.h"

// The formulas of a solution in the language of another program.
typedef enum pl_export_target {  // ORDER EXPORTS
  PL_EXPORT_SYMPY,
  PL_EXPORT_MATHEMATICA,
  PL_EXPORT_MAXIMA,
  PL_EXPORT_JULIA,
  PL_EXPORT_PYTHON,
  PL_EXPORT_JSON
} pl_export_target;
// "sympy"; false: there is none of this name
bool pl_export_target_find(const char* word, pl_export_target* target);

typedef struct pl_export_input {
  pl_export_target target;
  const char* file;  // as named on the command line
  const pl_solution* solution;
  const char* only;  // letters; NULL: all
} pl_export_input;
void pl_export(pl_text* out, const pl_export_input* in);

#endif
