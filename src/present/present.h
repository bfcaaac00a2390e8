// present: the most readable form of an expression of a tower.
#ifndef PL_PRESENT_H
#define PL_PRESENT_H

#include "algebra/algebra.h"

// How each kind of quantity is written (rules K1 to K6 of symbolic.md).
typedef enum pl_style {
  PL_S_PLAIN,  // shortest form found
  // T, V, L, E, H: a sum, 1/2 distributed, one term per velocity (momentum) monomial: K1
  PL_S_ENERGY,
  // an equation of motion: common factor divided out, order q'', q'^2, forces: K2
  PL_S_EQUATION,
  // q'', λ: one fraction, leading mass term below positive, ratios of equal dimension: K3, K4
  PL_S_QUOTIENT,
  PL_S_SOLUTION  // a function of time: sum by powers of t or by functions of t
} pl_style;
// pl_present looks for the most readable form, an anytime search: the first form comes at once,
// deeper ones until `seconds` are used up (0: first form only). Deterministic for a given depth;
// the budget is counted in work, not in time, so that the same input gives the same bytes on every
// machine. Never fails: at worst the plain form of e. Result is certified mod p against e before it
// is returned.
const pl_form* pl_present(pl_tower* t, pl_expr e, pl_style style, double seconds);

#endif
