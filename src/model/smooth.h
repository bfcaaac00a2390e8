// Expressions of Euler angles by the quaternion of the same attitude.
#ifndef PL_SMOOTH_H
#define PL_SMOOTH_H

#include "model/model.h"

// The Euler angles of a body, and what they become.
typedef struct pl_triple {
  pl_expr angle[3];            // φ, ϑ, ψ: coordinates, or elements of families
  pl_expr rate[3], second[3];  // their derivatives
  pl_expr q[4];                // coordinates
  pl_expr cosine;              // cos ϑ
  pl_expr spin[2][3];          // ω by q and q': along the body axes, in space
} pl_triple;

pl_triple pl_triple_make(pl_pool* p, const pl_expr angle[3], const pl_expr q[4]);
// e speaks of the angles or their rates
bool pl_triple_in(const pl_pool* p, pl_arena* scratch, const pl_triple* t, pl_expr e);

// pl_smooth gives e by the quaternion, equal to it where |q| = 1; poison when e is not smooth at
// every attitude, or too large to tell.
pl_expr pl_smooth(pl_arena* scratch, pl_pool* p, const pl_triple* t, pl_expr e);

#endif
