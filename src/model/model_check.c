// The check of a model: everything that can be told without a derivation, all of it at once.
#include "model_impl.h"

#include <string.h>

// Without `axes`: as many as the points have components, x right, y up, z out.
static void default_axes(pl_model* m) {
  if (m->n_axes > 0) return;
  static const pl_axis usual[3] = {
      {"x", "x", "right", false}, {"y", "y", "up", false}, {"z", "z", "out", false}};
  int n = 0;
  for (int i = 0; i < m->masses.n; i++)
    n = m->masses.at[i].point.n > n ? m->masses.at[i].point.n : n;
  for (int i = 0; i < m->bodies.n; i++)
    n = m->bodies.at[i].centre.n > n ? m->bodies.at[i].centre.n : n;
  for (int i = 0; i < m->points.n; i++)
    n = m->points.at[i].point.n > n ? m->points.at[i].point.n : n;
  for (int i = 0; i < m->gravities.n; i++)
    n = m->gravities.at[i].axis + 1 > n ? m->gravities.at[i].axis + 1 : n;
  if (n > 3) n = 3;
  memcpy(m->axes, usual, (size_t)n * sizeof *usual);
  m->n_axes = n;
}

// ------------------------------------------------------------------------------------------ echoes
// A statement of the wrong kind often has the wrong unit too; then the unit is not told.
static bool is_about_units(pl_code c) {
  return c == PL_E021 || c == PL_E031 || c == PL_E032 || c == PL_E033;
}
static bool is_about_kind(pl_code c) {
  return c == PL_E051 || c == PL_E056 || c == PL_E057 || c == PL_E039;
}

static bool is_echo(const pl_diagnostics* all, const pl_diagnostic* d) {
  if (!is_about_units(d->code) || !d->span.source) return false;
  for (int i = 0; i < all->list.n; i++) {
    const pl_diagnostic* other = &all->list.at[i];
    if (!is_about_kind(other->code) || other->span.source != d->span.source) continue;
    if (other->span.begin <= d->span.begin && d->span.end <= other->span.end) return true;
  }
  return false;
}

static void drop_echoes(pl_diagnostics* all) {
  int kept = 0;
  char* echo = PL_ARRAY(all->arena, char, all->list.n + 1);
  for (int i = 0; i < all->list.n; i++) echo[i] = is_echo(all, &all->list.at[i]);
  for (int i = 0; i < all->list.n; i++) {
    if (echo[i]) all->n_errors--;
    else all->list.at[kept++] = all->list.at[i];
  }
  all->list.n = kept;
}

// --------------------------------------------------------------------------------------- the check
pleuel_status pl_model_check(pl_job* job, pl_model* m) {
  default_axes(m);
  bool sized = pl_check_sizes(job, m);
  if (sized) pl_check_names(job, m);
  pl_check_dimensions(job, m);
  pl_dress_bare_numbers(m);
  pl_strip_units(m);
  pl_classify_symbols(m);
  pl_check_structure(job, m);
  if (sized) pl_check_families(job, m);
  pl_check_numbers(job, m);
  pl_check_inertia(job, m);
  pl_check_contacts(job, m);
  if (sized) pl_check_start(job, m);
  pl_check_requests(job, m);
  pl_check_use(job, m);
  pl_check_reading(job, m);
  m->checked = true;
  drop_echoes(job->diagnostics);
  pl_diagnostics_sort(job->diagnostics);
  return job->diagnostics->n_errors ? PLEUEL_MODEL_ERROR : PLEUEL_OK;
}
