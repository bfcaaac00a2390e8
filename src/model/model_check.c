// The check of a model: everything that can be told without a derivation, all of it at once.
#include "model_impl.h"

#include <string.h>

pl_diagnostic* pl_tell(pl_job* job, pl_code code, pl_span span, const char* en, const char* de) {
  return pl_report(job->diagnostics, code, span, en, de);
}

// Without `axes`: as many as the points have components, x right, y up, z out.
static void default_axes(pl_model* m) {
  if (m->n_axes > 0) return;
  static const pl_axis usual[3] = {{"x", "x", "right", false}, {"y", "y", "up", false}, {"z", "z", "out", false}};
  int n = 0;
  for (int i = 0; i < m->masses.n; i++) n = m->masses.at[i].point.n > n ? m->masses.at[i].point.n : n;
  for (int i = 0; i < m->bodies.n; i++) n = m->bodies.at[i].centre.n > n ? m->bodies.at[i].centre.n : n;
  for (int i = 0; i < m->points.n; i++) n = m->points.at[i].point.n > n ? m->points.at[i].point.n : n;
  for (int i = 0; i < m->gravities.n; i++) n = m->gravities.at[i].axis + 1 > n ? m->gravities.at[i].axis + 1 : n;
  if (n > 3) n = 3;
  memcpy(m->axes, usual, (size_t)n * sizeof *usual);
  m->n_axes = n;
}

pleuel_status pl_model_check(pl_job* job, pl_model* m) {
  default_axes(m);
  bool sized = pl_check_sizes(job, m);
  if (sized) pl_check_names(job, m);
  pl_check_dimensions(job, m);
  pl_strip_units(m);
  pl_classify_symbols(m);
  pl_check_structure(job, m);
  if (sized) pl_check_families(job, m);
  pl_check_numbers(job, m);
  if (sized) pl_check_start(job, m);
  pl_check_requests(job, m);
  pl_check_use(job, m);
  m->checked = true;
  pl_diagnostics_sort(job->diagnostics);
  return job->diagnostics->n_errors ? PLEUEL_MODEL_ERROR : PLEUEL_OK;
}
