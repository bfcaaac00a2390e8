// verify: is a formula that is shown equal to its reference?  Decided by values at sample points,
// without the tower that produced the formula.
#ifndef PL_VERIFY_H
#define PL_VERIFY_H

#include "algebra/algebra.h"

typedef struct pl_verifier pl_verifier;
pl_verifier* pl_verifier_make(pl_job* job, pl_pool* p, const pl_domain* s);
typedef struct pl_verification {
  // PL_YES: all points agree; PL_NO: a point separates; PL_UNKNOWN: no usable points
  pl_answer3 equal;
  int points_mod, points_arb;
  // largest relative difference seen, an upper bound from Arb (log2 precision below)
  double worst;
} pl_verification;
// pl_verify compares shown and reference at 20 points mod p and 50 points in Arb (256 bit, more
// when needed), without the tower.
pl_verification pl_verify(pl_verifier* c, pl_expr shown, pl_expr reference);
// A certifier lives in the arena of the pool; there is nothing to free.

#endif
