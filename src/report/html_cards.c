// Result in brief: freedoms, the shortest of the asked results, and whether the checks passed.
#include "html_impl.h"

#include <math.h>
#include <string.h>

enum { PL_HTML_CARD_ROOM = 27, PL_HTML_MOST_CARDS = 3 };

static void open_card(pl_html* h, const char* class) {
  pl_html_rawf(h, "<div class=\"card%s\"><h3>", class);
}

// ---------------------------------------------------------------------------------------- freedoms
static int count_one_sided(const pl_solution* s) {
  int n = 0;
  for (int i = 0; i < s->constraints.n; i++)
    n += s->constraints.at[i].one_sided && !s->constraints.at[i].open;
  return n;
}

static void put_freedom(pl_html* h) {
  const pl_dof* d = &h->s->dof;
  int one_sided = count_one_sided(h->s), implied = d->constraints - d->rank;
  open_card(h, "");
  pl_html_rawf(h, "%s</h3><p class=\"big\">%d</p><p>",
               pl_html_say(h, PL_BOTH("Degrees of freedom")), d->dof);
  pl_html_rawf(h,
               d->coordinates == 1 ? pl_html_say(h, PL_BOTH("%d coordinate"))
                                   : pl_html_say(h, PL_BOTH("%d coordinates")),
               d->coordinates);
  pl_html_raw(h, ", ");
  pl_html_rawf(h,
               d->constraints == 1 ? pl_html_say(h, PL_BOTH("%d constraint"))
                                   : pl_html_say(h, PL_BOTH("%d constraints")),
               d->constraints);
  if (one_sided > 0 && one_sided == d->constraints)
    pl_html_raw(h, pl_html_say(h, PL_BOTH(", one-sided")));
  else if (one_sided > 0) pl_html_rawf(h, pl_html_say(h, PL_BOTH(", %d one-sided")), one_sided);
  if (d->open > 0) pl_html_rawf(h, pl_html_say(h, PL_BOTH(", %d open")), d->open);
  if (d->velocity_dof != d->dof)
    pl_html_rawf(h, pl_html_say(h, PL_BOTH("; %d for velocities")), d->velocity_dof);
  else if (implied > 0)
    pl_html_rawf(h, pl_html_say(h, PL_BOTH(", %d follow from the others")), implied);
  pl_html_raw(h, "</p></div>\n");
}

// ----------------------------------------------------------------------------------------- results
static bool starts(const char* s, const char* with) {
  return s && strncmp(s, with, strlen(with)) == 0;
}

// Equations of motion are the way, not the result.
static bool is_way(const char* item) {
  static const char* const way[] = {"dof",        "constraints", "lagrange",  "newton",
                                    "lagrangian", "hamiltonian", "conserved", NULL};
  for (int i = 0; way[i]; i++)
    if (starts(item, way[i])) return true;
  return false;
}

// A chain Z = λ e_r = m g (...) e_r as its two ends.
static const pl_form* short_form(pl_html* h, const pl_form* f) {
  if (f->kind != PL_F_RELATION) return f;
  const pl_form *left = f, *right = f->args[1];
  while (left->kind == PL_F_RELATION) left = left->args[0];
  while (right->kind == PL_F_RELATION) right = right->args[1];
  return pl_form_relation(h->arena, left, f->text, right);
}

typedef struct pl_card {
  int section;
  const pl_step* step;
  const pl_form* form;
  bool number;
} pl_card;

// What a section comes to: its first equation with a number, else the last one that is numbered. A
// formula too wide for a card leaves its number there.
static bool find_card(pl_html* h, int i, pl_card* out) {
  const pl_section* c = &h->s->sections.at[i];
  bool found = false;
  for (int k = 0; k < c->steps.n; k++) {
    const pl_step* s = &c->steps.at[k];
    bool number = s->has_value && isfinite(s->value);
    if (s->kind != PL_STEP_EQUATION || !s->formula || s->formula->kind != PL_F_RELATION
        || (s->number == 0 && !number))
      continue;
    const pl_form* f = short_form(h, s->formula);
    bool fits = pl_html_cells(h, f) <= PL_HTML_CARD_ROOM;
    if (found && out->number) continue;
    *out = (pl_card){i, s, fits ? f : NULL, number};
    // a step on the way is no substitute for a result that does not fit
    found = fits || number;
  }
  return found;
}

static const char* title_of(const pl_html* h, const pl_section* c) {
  const char* title = pl_html_words(h, c->title);
  if (*title || !c->item) return title;
  return starts(c->item, "solve ") ? c->item + strlen("solve ") : c->item;
}

static void put_result(pl_html* h, const pl_card* card) {
  const pl_step* s = card->step;
  const char* after = pl_html_words(h, s->after);
  const char* value = card->number ? pl_html_quantity(h, s->value, s->unit, 6) : "";
  const char* name = s->value_name ? pl_format(h->arena, "%s = ", s->value_name) : "= ";
  open_card(h, "");
  pl_html_rawf(h, "<a href=\"#%s\">", pl_html_part(h, card->section));
  pl_html_text(h, title_of(h, &h->s->sections.at[card->section]));
  pl_html_raw(h, "</a></h3><p class=\"big\">");
  if (card->form) pl_html_inline(h, card->form);
  else pl_html_text(h, s->value_name ? pl_format(h->arena, "%s%s", name, value) : value);
  pl_html_raw(h, "</p><p>");
  if (card->form && card->number)
    pl_html_text(h, pl_format(h->arena, "%s%s%s", name, value, *after ? ", " : ""));
  pl_html_sentence(h, after, s->n_inserts, s->inserts);
  if (!card->form && s->number > 0)
    pl_html_sentence(h, pl_format(h->arena, "%s(%d)", *after ? ", " : "", s->number), 0, NULL);
  pl_html_raw(h, "</p></div>\n");
}

static const char* line_of(pl_html* h, const pl_form* f) {
  return f ? pl_notation_print(h->arena, h->pool, f, (pl_notation){PL_MATH_LINE, h->lang}) : "";
}

static void put_results(pl_html* h) {
  int shown = 0;
  const char* last[PL_HTML_MOST_CARDS];
  for (int i = 0; i < h->s->sections.n && shown < PL_HTML_MOST_CARDS; i++) {
    const pl_section* c = &h->s->sections.at[i];
    pl_card card = {0};
    if (!pl_worked_wanted(h->in->only, c->letter) || is_way(c->item) || !find_card(h, i, &card))
      continue;
    const char* line = line_of(h, card.form);
    bool again = false;
    for (int k = 0; k < shown; k++) again |= *line && strcmp(last[k], line) == 0;
    if (again) continue;
    put_result(h, &card);
    last[shown++] = line;
  }
}

// ------------------------------------------------------------------------------------------ checks
static void put_checks(pl_html* h) {
  int n = h->s->checks.n, passed = 0, formulas = 0;
  for (int i = 0; i < n; i++) {
    passed += h->s->checks.at[i].passed;
    formulas += h->s->checks.at[i].formulas;
  }
  bool all = passed == n && !h->s->expect_failed;
  open_card(h, all ? " ok" : " bad");
  pl_html_rawf(h, "%s</h3><p class=\"big\">", pl_html_say(h, PL_BOTH("Checks")));
  pl_html_rawf(h, pl_html_say(h, PL_BOTH("%d of %d passed")), passed, n);
  pl_html_raw(h, "</p><p>");
  if (h->s->expect_failed)
    pl_html_raw(h, pl_html_say(h, PL_BOTH("but an <code>expect</code> of the model is false")));
  else pl_html_rawf(h, pl_html_say(h, PL_BOTH("%d formulas compared with the model")), formulas);
  pl_html_raw(h, "</p></div>\n");
}

void pl_html_cards(pl_html* h) {
  pl_html_rawf(h, "<section id=\"result\"><h2 class=\"vh\">%s</h2><div class=\"cards\">\n",
               pl_html_say(h, PL_BOTH("Result in brief")));
  put_freedom(h);
  put_results(h);
  put_checks(h);
  pl_html_raw(h, "</div></section>\n");
}
