// loops, inside: an unknown, and the equations solved for it.
#ifndef PL_LOOPS_IMPL_H
#define PL_LOOPS_IMPL_H

#include "mechanics/mechanics.h"

typedef struct pl_unknown {
  int i;
  pl_symbol q;
  bool angle;
} pl_unknown;

// false: occurs in another way
bool pl_unknown_of(pl_analysis* d, int i, const pl_expr* e, int n, pl_unknown* out);
// Ways of l from one equation for u, or from two for u and v (v is eliminated first). False when
// the shape is none of these.
bool pl_ways_of_one(pl_analysis* d, pl_loop* l, pl_expr e, const pl_unknown* u);
bool pl_ways_of_two(pl_analysis* d, pl_loop* l, const pl_expr* e, const pl_unknown* u,
                    const pl_unknown* v);

#endif
