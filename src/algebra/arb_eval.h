// One node of an expression in ball arithmetic: out from the balls of its arguments. Used by the
// straight-line program of the sample points. What has no value (poison, sums over an open index,
// outside the domain) becomes an indeterminate ball.
#ifndef PL_ARB_EVAL_H
#define PL_ARB_EVAL_H

#include "algebra/tower.h"

void pl_arb_node(arb_t out, const pl_pool* p, pl_expr e, const arb_srcptr* args, pl_arena* scratch,
                 long precision);

#endif
