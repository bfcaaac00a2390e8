// stages: which constraints hold at the start and along the motion, for the derivation. Found by a
// trace, which reads the model as the simulation does; the derivation decides nothing of this
// itself.
#ifndef PL_STAGES_H
#define PL_STAGES_H

#include "api/api_impl.h"

typedef struct pl_staging {
  pleuel_model* m;
  int n;                       // 0: numbers are missing, or there is no start
  pl_stage* stages;            // of the motion of `init`, each set once
  bool along;                  // as far as `simulate` says
  struct pl_watched* watched;  // motions that were looked at for changes of sign, the last first
} pl_staging;

// pl_staging_make looks at the motion of `init`. along: as far as `simulate` says, else at the
// start only.
pl_staging* pl_staging_make(pleuel_model* m, bool along);

// The set at the start that a motion names; NULL: nothing is known of it. Fits
// pl_derive_options.stage_from.
const pl_stage* pl_staging_from(void* staging, const pl_motion* from);

// Where the motion of `init` leaves the side on which expressions are positive.  Fits
// pl_derive_options.leaves.
bool pl_staging_leaves(void* staging, const pl_expr* side, int n, double from, double to,
                       pl_leaving* out);

#endif
