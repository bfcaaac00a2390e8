// solution_page: what was written about an analysis.
#include "mechanics/propose.h"
#include "worked/worked_impl.h"

// for each quantity, unless the caller says otherwise; counted in work, see pl_present
static const double presentation_s = 0.02;

void pl_page_open(pl_analysis* d, const pl_derive_options* options, pl_solution* solution) {
  d->page = PL_NEW(d->arena, pl_solution_page);
  *d->page = (pl_solution_page){.options = options,
                                .solution = solution,
                                .told = pl_map_make(d->arena),
                                .began_ms = pl_cpu_ms()};
  d->effort_s = options->seconds > 0 ? options->seconds : presentation_s;
}

void pl_page_prepare(pl_analysis* d) {
  d->page->lambda_number = PL_ARRAY(d->arena, int, d->g.n + 1);
  d->page->loop_told = PL_ARRAY(d->arena, bool, d->loops.n + 1);
}

// Of an analysis that was proposed for d: special cases were told there.
static pl_analysis* with_page(pl_analysis* d, pl_analysis* a) {
  if (!a || a->page) return a;
  pl_page_open(a, d->page->options, d->page->solution);
  pl_page_prepare(a);
  a->page->began_ms = d->page->began_ms;
  a->page->cases_told = true;
  a->page->first = d->page->first;
  return a;
}

pl_analysis* pl_page_propose(pl_analysis* d) { return with_page(d, pl_propose(d)); }

pl_analysis* pl_page_propose_for_rest(pl_analysis* d) {
  return with_page(d, pl_propose_for_rest(d));
}

pl_analysis* pl_page_analysis(pl_job* job, pl_model* whole, const pl_derive_options* options,
                              pl_solution* solution, const pl_stage* stage) {
  pl_analysis* d = pl_analysis_open(job, whole, stage, &solution->towers);
  pl_page_open(d, options, solution);
  return d;
}
