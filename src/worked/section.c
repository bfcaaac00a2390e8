// section: opens a section, with what has to be told before its first formula; and the section of a
// request that is not computed.
#include <string.h>

#include "worked/worked_impl.h"

static bool same_letter(const char* a, const char* b) {
  return a && b ? strcmp(a, b) == 0 : a == b;
}

pl_section* pl_section_open(pl_analysis* d, const pl_ask* ask, const char* en, const char* de) {
  pl_ask* kept = PL_NEW(d->arena, pl_ask);
  *kept = *ask;
  pl_section s = {.letter = ask->letter,
                  .item = ask->text,
                  .title = {en, de},
                  .by = d,
                  .tower = d->tower,
                  .model = d->model,
                  .ask = kept};
  if (d->page->solution->sections.n > 0) {
    const pl_section* last = &d->page->solution->sections.at[d->page->solution->sections.n - 1];
    bool same_title = !en || (last->title[0] && strcmp(last->title[0], en) == 0);
    s.continues = s.letter && same_letter(last->letter, s.letter) && same_title;
  }
  pl_push(d->arena, d->page->solution->sections, s);
  d->page->section = &d->page->solution->sections.at[d->page->solution->sections.n - 1];
  if (ask->kind != PL_ASK_DOF && ask->kind != PL_ASK_CONSTRAINTS) pl_tell_open(d);
  pl_tell_proposal(d);
  d->special.n = 0;
  pl_tell_cases(d);
  if (pl_speaks_of_loops(ask)) pl_tell_loops(d);
  return d->page->section;
}

void pl_answer_pending(pl_analysis* d, const pl_ask* ask) {
  if (!d->page->section || d->page->section->item != ask->text)
    pl_section_open(d, ask, ask->text, ask->text);
  pl_say(d, PL_BOTH("This version does not compute this request."), 0);
  pl_report(d->job->diagnostics, PL_N091, ask->span,
            PL_BOTH_FORMAT(d->arena, "\"%s\" is understood, but this version does not compute it",
                           ask->text));
  d->page->section->not_found = true;
}
