// Which wider types this build has.
#include "jit/jit.h"

#ifdef PL_HAS_LONG
extern const pl_real pl_real_of_long;
#endif
#ifdef PL_QUAD
extern const pl_real pl_real_of_quad;
#endif

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
