// claims: every displayed formula against raw differentiation of the model, at points modulo a
// prime and in ball arithmetic, never
// against the tower that produced it.
#ifndef PL_CLAIMS_H
#define PL_CLAIMS_H

#include "expr/expr.h"

struct pl_analysis;

// A formula that was displayed and must hold: shown == reference at every point of the motion's
// domain.
typedef enum pl_claim_kind {
  PL_CLAIM_MOTION,
  PL_CLAIM_ONE_TWO,
  PL_CLAIM_MAP,
  PL_CLAIM_ENERGY,
  PL_CLAIM_INSERTED,
  PL_CLAIM_OTHER,
  PL_N_CLAIMS
} pl_claim_kind;

typedef struct pl_claim {
  pl_claim_kind kind;
  pl_expr shown, reference;
  bool own_domain;  // compare for free symbols, not on the motion
} pl_claim;

typedef PL_VEC(pl_claim) pl_claims;

typedef struct pl_check {
  const char* name[2];  // "Lagrange I against II"
  bool passed;
  double worst;           // largest relative difference, 0 for exact checks
  int points;             // points tried
  int formulas;           // formulas compared
  int starts;             // motions that they were compared with; 0 where there are none
  const char* failed_on;  // text of the first formula that failed, or NULL
} pl_check;

typedef PL_VEC(pl_check) pl_checks;

// pl_claims_check compares both sides of each claim about this analysis, in value and in dimension.
// Results of one kind are
// one check, whatever analysis they are about.
// name: of each kind and, last, of the dimensions; by language.
void pl_claims_check(struct pl_analysis* d, const pl_claims* claims, const char* const name[][2],
                     pl_checks* out);

#endif
