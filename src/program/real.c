// Which wider types this build has.
#include "program/program.h"

#ifdef PL_HAS_LONG
extern const pl_real pl_real_of_long;
#endif
#ifdef PL_QUAD
extern const pl_real pl_real_of_quad;
#endif

#if defined(PL_QUAD) && PL_QUAD != 3
extern const pl_real pl_real_of_pair_plain;
extern const pl_real pl_real_of_pair_fused;
#endif

const pl_real* pl_real_pair(void) {
#if defined(PL_QUAD) && PL_QUAD != 3
#  ifdef PL_FUSED
  if (__builtin_cpu_supports("fma") && __builtin_cpu_supports("avx2"))
    return &pl_real_of_pair_fused;
#  endif
  return &pl_real_of_pair_plain;
#else
  return NULL;
#endif
}

const pl_real* pl_real_long(void) {
#ifdef PL_HAS_LONG
  return &pl_real_of_long;
#else
  return NULL;
#endif
}

const pl_real* pl_real_quad(void) {
#ifdef PL_QUAD
  return &pl_real_of_quad;
#else
  return NULL;
#endif
}
