// assumptions: the signs that formulas rest on, as a list.
#include <string.h>

#include "worked/worked_impl.h"

// "m1 > 0", "r < l": a difference a - b is written as b < a.
static const char* fact_text(pl_analysis* d, const pl_fact* f) {
  pl_notation how = {.math = PL_MATH_LINE, .lang = d->job->lang};
  return pl_notation_print(d->arena, d->pool, pl_fact_form(d, f), how);
}

// A one-sided constraint of the model is no assumption of ours.
static bool is_contact(pl_analysis* d, const pl_fact* f) {
  for (int k = 0; k < d->open.n; k++) {
    const pl_constraint* c = d->open.at[k].source;
    bool same = pl_same(f->difference, c->g) || pl_same(f->difference, pl_neg(d->pool, c->g));
    if (d->open.at[k].contact && !f->strict && same) return true;
  }
  for (int k = 0; k < d->g.n; k++) {
    const pl_bond* l = &d->g.at[k];
    bool same = pl_same(f->difference, l->g) || pl_same(f->difference, pl_neg(d->pool, l->g));
    if (l->contact && !f->strict && same) return true;
  }
  return false;
}

// Signs of single names first, in the order of their declaration; then relations between several.
static uint64_t fact_order(const pl_analysis* d, const pl_fact* f) {
  pl_symbol first = {0};
  int n = pl_symbols_in(d->pool, f->difference, &first, 1);
  return ((uint64_t)n << 32) + first.id;
}

static bool is_listed(pl_analysis* d, const pl_fact* f, const pl_fact** sorted, int n) {
  // 2 kg > 0
  bool numbers = pl_is_constant(d->pool, pl_without_measures(d->pool, f->difference));
  bool listed = numbers || is_contact(d, f);
  for (int k = 0; k < n; k++)
    listed |= sorted[k]->strict == f->strict && pl_same(sorted[k]->difference, f->difference);
  return listed;
}

// What a section is about stands in its title: a side of |x| that the motion comes to later.
static bool stands_in_title(const pl_analysis* of, const pl_fact* f) {
  for (int k = 0; of->stage && k < of->stage->n_sides; k++) {
    if (pl_same(of->stage->sides[k].difference, f->difference)) return true;
  }
  return false;
}

// An assumption about the place belongs to the stretch of the motion that is spoken of.
static const char* told_fact(pl_analysis* d, const pl_analysis* of, const pl_fact* f) {
  const char* text = fact_text(d, f);
  bool later = of->stage && of->stage->from > 0 && pl_has_coordinates(d, f->difference);
  if (!later) return text;
  const char* when = pl_notation_print(d->arena, d->pool, pl_moment_form(d, of->stage->from),
                                       (pl_notation){.math = PL_MATH_LINE, .lang = d->job->lang});
  return pl_format(d->arena, d->job->lang == PL_GERMAN ? pl_german("%s (from %s)") : "%s (from %s)",
                   text, when);
}

void pl_list_assumptions(pl_analysis* d, pl_analysis** of, int n_of) {
  int most = 0, n = 0, n_used;
  for (int k = 0; k < n_of; k++) {
    pl_tower_used(of[k]->tower, &n_used);
    most += n_used;
  }
  const pl_fact** sorted = PL_ARRAY(d->arena, const pl_fact*, most + 1);
  const pl_analysis** by = PL_ARRAY(d->arena, const pl_analysis*, most + 1);
  for (int k = 0; k < n_of; k++) {
    const pl_fact* used = pl_tower_used(of[k]->tower, &n_used);
    // by insertion: few, and equal ones keep their order
    for (const pl_fact* f = used; f < used + n_used; f++) {
      if (is_listed(d, f, sorted, n) || stands_in_title(of[k], f)) continue;
      int at = n++;
      for (; at > 0 && fact_order(d, sorted[at - 1]) > fact_order(d, f); at--) {
        sorted[at] = sorted[at - 1];
        by[at] = by[at - 1];
      }
      sorted[at] = f;
      by[at] = of[k];
    }
  }
  pl_solution* solution = d->page->solution;
  for (int k = 0; k < n; k++) {
    const char* text = told_fact(d, by[k], sorted[k]);
    bool told = false;  // the same relation in another form
    for (int i = 0; i < solution->used.n; i++) told |= strcmp(solution->used.at[i], text) == 0;
    if (!told) pl_push(d->arena, solution->used, text);
  }
}
