// sets: the analyses of the sets of constraints that hold along a motion. They share pool, solution
// and equation numbers.
#include "worked/sets_impl.h"

// The analysis of a stage, derived as far as the motion; NULL: it failed.
static pl_analysis* analysis_make(const pl_analysis* like, const pl_stage* stage) {
  pl_job* job = like->job;
  pl_analysis* d = pl_page_analysis(job, like->whole, like->page->options, like->page->solution,
                                    stage);
  d->page->first = like->page->first;
  int messages = job->diagnostics->list.n, errors = job->diagnostics->n_errors;
  if (pl_derive_motion(d, d->page->solution->cpu_ms) == PLEUEL_OK) {
    pl_page_prepare(d);
    return d;
  }
  job->diagnostics->list.n = messages;  // a set that does not fit is no fault of the model
  job->diagnostics->n_errors = errors;
  job->status = PLEUEL_OK;
  job->message[0] = '\0';
  return NULL;
}

// One that is there; NULL.
pl_analysis* pl_analysis_find(pl_analysis* first, const pl_stage* s) {
  for (int k = 0; k < first->page->sets.n; k++) {
    pl_analysis* d = first->page->sets.at[k];
    if (pl_is_same_set(d, s) && pl_same_sides(d, s)) return d;
  }
  return NULL;
}

// The analysis of a stage: one that is there, or a new one.  NULL when it could not be derived.
pl_analysis* pl_analysis_in(pl_analysis* first, const pl_stage* s) {
  pl_analysis* d = pl_analysis_find(first, s);
  if (d) {
    d->stage = s;
    return d;
  }
  d = analysis_make(first, s);
  if (d) pl_push(first->arena, first->page->sets, d);
  return d;
}

pl_analysis* pl_analysis_beyond(pl_analysis* d, const pl_fact* side, int n, const bool* through) {
  pl_stage* s = pl_stage_turned(d, side, n, through);
  s->end = PL_END_UNKNOWN;
  s->n_q = 0;  // no motion is meant
  return pl_analysis_in(d->page->first, s);
}

pl_analysis* pl_analysis_of(pl_analysis* first, const pl_ask* ask) {
  const pl_derive_options* o = first->page->options;
  const pl_stage* own = o->n_stages > 0 ? &o->stages[0] : NULL;
  if (ask->motion.given && o->stage_from) {
    const pl_stage* s = o->stage_from(o->user, &ask->motion);
    if (s) return pl_analysis_in(first, s);
  }
  first->stage = own;
  return first;
}

pl_analysis* pl_without_sticking(pl_analysis* first) {
  bool sticks = false;
  for (int k = 0; first->stage && k < first->stage->n_rubs; k++)
    sticks |= first->stage->rubs[k].sticks;
  if (!sticks || first->page->sets.n == 0) return first;
  pl_stage* s = PL_NEW(first->arena, pl_stage);
  *s = *first->stage;
  s->n_rubs = 0;
  pl_analysis* d = pl_analysis_in(first, s);
  return d ? d : first;
}
