// Residues modulo PL_MOD_P and rotations over them; for the files of expr only.
#ifndef PL_EXPR_MODULAR_H
#define PL_EXPR_MODULAR_H

#include "expr/expr.h"

// All take and give residues below PL_MOD_P. ok is set to false when there is no value; it is never
// set to true.
uint64_t pl_mod_sub(uint64_t a, uint64_t b);
uint64_t pl_mod_pow(uint64_t a, uint64_t n);
uint64_t pl_mod_half(uint64_t a);
uint64_t pl_mod_sqrt(uint64_t a, bool* ok);  // the root that is a square itself
int pl_mod_sign(uint64_t a);                 // 1 for squares, -1 for the others, 0 for 0
uint64_t pl_mod_pow_ratio(uint64_t a, int64_t num, int64_t den, bool* ok);  // a^(num/den), den > 0

// cos and sin of an angle.
typedef struct pl_rotation {
  uint64_t c, s;
} pl_rotation;
pl_rotation pl_rotation_none(void);
pl_rotation pl_rotation_mul(pl_rotation a, pl_rotation b);
pl_rotation pl_rotation_pow(pl_rotation a, uint64_t n);
pl_rotation pl_rotation_from_tangent(uint64_t t);  // t = tan(x/2)
// num/den times the angle
pl_rotation pl_rotation_ratio(pl_rotation a, int64_t num, int64_t den, bool* ok);
// num/den times π
pl_rotation pl_rotation_of_pi(int64_t num, int64_t den, bool* ok);

#endif
