// serving: in which coordinates a request is answered, those of the model or generalized ones.
#include "mechanics/propose.h"
#include "worked/worked_impl.h"

static bool of_forces(pl_analysis* d, pl_expr e) {
  return pl_has_role(d->pool, e, PL_R_ACCELERATION) || pl_has_role(d->pool, e, PL_R_MULTIPLIER)
         || pl_has_role(d->pool, e, PL_R_LOCAL);
}

// What is answered in generalized coordinates. Multipliers, accelerations and forces stay in the
// coordinates of the model, where
// these have a closed form and no motion is named.
static bool in_generalized(pl_analysis* d, const pl_ask* ask) {
  switch (ask->kind) {
    case PL_ASK_LIMIT:
    case PL_ASK_SERIES: return false;
    case PL_ASK_SOLVE: return !d->solved || ask->of_time || !of_forces(d, ask->value);
    case PL_ASK_VALUE:
      return !d->solved || ask->where.n > 0 || ask->motion.given || !of_forces(d, ask->value);
    case PL_ASK_FORCE_OF:
    case PL_ASK_FORCE_ON: return !d->solved || ask->motion.given;
    default: return true;
  }
}

// No freedom is left: all is a function of t.
static bool is_driven(const pl_analysis* d) { return d->dof.dof == 0; }

// The analysis that answers: in the coordinates of the model, or with what is proposed.
pl_analysis* pl_serving(pl_analysis* d, const pl_ask* ask) {
  bool first_kind = ask->kind == PL_ASK_DOF || ask->kind == PL_ASK_CONSTRAINTS
                    || ask->kind == PL_ASK_LAGRANGE1 || ask->kind == PL_ASK_NEWTON
                    || ask->kind == PL_ASK_CONSERVED;
  if (d->reduced || first_kind || !(in_generalized(d, ask) || is_driven(d))) return d;
  bool rest = ask->kind == PL_ASK_EQUILIBRIA || ask->kind == PL_ASK_MODES
              || ask->kind == PL_ASK_THRESHOLD;
  pl_analysis* a = rest ? pl_page_propose_for_rest(d) : pl_page_propose(d);
  return a ? a : d;
}
