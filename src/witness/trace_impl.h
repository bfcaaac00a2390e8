// trace, inside: models with other numbers and other starts.
#ifndef PL_TRACE_IMPL_H
#define PL_TRACE_IMPL_H

#include <string.h>

#include "witness/trace.h"

#define PL_TRACE_MARK "met by the witness"  // label of the event

// trace_model.c
pl_model* pl_trace_marked(pl_job* job, const pl_model* m, pl_expr meet);
pl_model* pl_trace_random_start(pl_job* job, pl_model* m, const pl_trace* beside, uint64_t seed);
pl_model* pl_trace_open_start(pl_job* job, pl_model* m);
pl_model* pl_trace_closed(pl_job* job, pl_model* m);  // without `init`: contacts hold
pl_model* pl_trace_named_start(pl_job* job, pl_model* m, const pl_motion* from, double push);

#endif
