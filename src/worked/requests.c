// requests: each request is answered by the file of its kind, in the set of constraints and the
// coordinates that it is about.
#include "mechanics/propose.h"
#include "worked/worked_impl.h"

// What friction leaves as it is.  Everything else would be right without friction only.
static bool survives_friction(pl_analysis* d, const pl_ask* ask) {
  switch (ask->kind) {
    case PL_ASK_DOF:
    case PL_ASK_CONSTRAINTS:
    case PL_ASK_LAGRANGIAN: return true;
    case PL_ASK_LAGRANGE1:
    case PL_ASK_NEWTON:
    case PL_ASK_CONSERVED:
    case PL_ASK_SOLVE: return pl_knows_friction(d);
    case PL_ASK_VALUE: return pl_knows_friction(d) && ask->where.n == 0 && !ask->motion.given;
    default: return false;
  }
}

static bool rubs(const pl_analysis* d) {
  for (int k = 0; k < d->g.n; k++) {
    if (d->g.at[k].rub || d->g.at[k].source->sticking) return true;
  }
  return false;
}

// What slips takes energy, and more is not claimed.
static void answer_conserved_with_friction(pl_analysis* d, const pl_ask* ask) {
  pl_section_open(d, ask, PL_BOTH("Conserved"));
  pl_say(d, PL_BOTH("The energy is not conserved: where surfaces slip, friction does work."), 0);
  pl_value* v = pl_answer(d, "E", pl_poison(), NULL);
  v->conserved = 0;
  v->because[0] = "friction does work";
  v->because[1] = pl_german("friction does work");
}

static void leave_to_simulation(pl_analysis* d, const pl_ask* ask) {
  if (!d->page->section || d->page->section->item != ask->text)
    pl_section_open(d, ask, ask->text, ask->text);
  pl_say(d,
         PL_BOTH("Friction acts here, with a force that jumps between sticking and slipping: no "
                 "formula is "
                 "given. The simulation computes the motion."),
         0);
  d->page->section->not_found = true;
}

// What asks for roots or series in the generalized coordinates, on which the coordinates of loops
// hang without being written out.
static bool needs_explicit_maps(const pl_ask* ask) {
  return ask->kind == PL_ASK_EQUILIBRIA || ask->kind == PL_ASK_MODES
         || ask->kind == PL_ASK_THRESHOLD || ask->kind == PL_ASK_LIMIT || ask->kind == PL_ASK_SERIES
         || (ask->kind == PL_ASK_VALUE && ask->where.n > 0);
}

// The equations of the second kind at rest, over the names of the loops.
static void show_rest(pl_analysis* d) {
  pl_tell_loops(d);
  pl_say(d, PL_BOTH("At rest the constraints hold and"), 0);
  for (int k = 0; k < d->gen.n; k++) {
    pl_expr e = pl_second_kind(d, d->gen.at[k]);
    for (int j = 0; j < d->gen.n; j++) {
      const pl_variable* c = &d->q.at[d->gen.at[j]];
      e = pl_subst1(d->pool, pl_subst1(d->pool, e, c->a, pl_int(d->pool, 0)), c->v,
                    pl_int(d->pool, 0));
    }
    pl_show_numbered(d, pl_feq(d, pl_f(d, pl_alg_normal(d->tower, e), PL_S_EQUATION),
                               pl_form_leaf(d->arena, pl_int(d->pool, 0))));
  }
}

static void leave_implicit(pl_analysis* d, const pl_ask* ask) {
  pl_section_open(d, ask, ask->text, ask->text);
  pl_say(
      d,
      PL_BOTH("The coordinates of closed loops follow from the generalized ones through roots; no "
              "closed form was found for this."),
      0);
  d->page->section->not_found = true;
  if (ask->kind == PL_ASK_EQUILIBRIA) show_rest(d);
}

static void answer_with(pl_analysis* d, const pl_ask* ask) {
  if (d->model->frictions.n > 0 && !survives_friction(d, ask)) {
    leave_to_simulation(d, ask);
    return;
  }
  if (d->loops.n > 0 && needs_explicit_maps(ask)) {
    if (ask->kind == PL_ASK_VALUE && pl_where_in_loops(d, ask)) return;
    leave_implicit(d, ask);
    return;
  }
  switch (ask->kind) {
    case PL_ASK_DOF: pl_answer_dof(d, ask); break;
    case PL_ASK_CONSTRAINTS: pl_answer_constraints(d, ask); break;
    case PL_ASK_LAGRANGE1:
    case PL_ASK_NEWTON: pl_answer_lagrange1(d, ask); break;
    case PL_ASK_LAGRANGE2: pl_answer_lagrange2(d, ask); break;
    case PL_ASK_LAGRANGIAN: pl_answer_lagrangian(d, ask); break;
    case PL_ASK_HAMILTONIAN: pl_answer_hamiltonian(d, ask); break;
    case PL_ASK_SOLVE: pl_answer_solve(d, ask); break;
    case PL_ASK_VALUE: pl_answer_value(d, ask); break;
    case PL_ASK_FORCE_OF:
    case PL_ASK_FORCE_ON: pl_answer_force(d, ask); break;
    case PL_ASK_CONSERVED:
      if (rubs(d)) answer_conserved_with_friction(d, ask);
      else pl_answer_conserved(d, ask);
      break;
    case PL_ASK_EQUILIBRIA: pl_answer_equilibria(d, ask); break;
    case PL_ASK_MODES: pl_answer_modes(d, ask); break;
    case PL_ASK_LIMIT: pl_answer_limit(d, ask); break;
    case PL_ASK_SERIES: pl_answer_series(d, ask); break;
    case PL_ASK_EXPECT: pl_answer_expect(d, ask); break;
    case PL_ASK_THRESHOLD: pl_answer_threshold(d, ask); break;
    case PL_ASK_MAX:
    case PL_ASK_MIN:
    case PL_ASK_AVERAGE:
    case PL_ASK_STABILITY: pl_answer_pending(d, ask); break;
  }
}

// The motion that is meant, and the place of a position of rest, in generalized coordinates.
static pl_ask in_its_coordinates(pl_analysis* d, const pl_ask* ask) {
  pl_ask own = *ask;
  pl_condition* found;
  int n = pl_in_generalized(d, ask->motion.from, ask->motion.n_from, &found);
  if (n >= 0) {
    own.motion.from = found;
    own.motion.n_from = n;
  }
  bool place = ask->kind == PL_ASK_MODES || ask->kind == PL_ASK_EQUILIBRIA
               || ask->kind == PL_ASK_THRESHOLD;
  n = place ? pl_in_generalized(d, ask->where.at, ask->where.n, &found) : -1;
  if (n >= 0) {
    own.where.at = found;
    own.where.n = own.where.cap = n;
  }
  return own;
}

void pl_answer_one(pl_analysis* d, const pl_ask* ask) {
  if (ask->kind == PL_ASK_LAGRANGIAN) d = pl_without_sticking(d);
  int n = d->page->solution->sections.n;
  // another analysis may have written it
  d->page->section = n > 0 ? &d->page->solution->sections.at[n - 1] : NULL;
  if (pl_answer_open(d, ask)) return;
  ask = pl_without_open(d, ask);
  pl_analysis* base = d;
  pl_analysis* a = pl_serving(d, ask);
  pl_ask own = in_its_coordinates(a, ask);
  if (own.motion.given && (base = pl_analysis_around(d, a, &own.motion)) != d) {
    a = pl_serving(base, ask);
    own = in_its_coordinates(a, ask);
  }
  a->page->base = base;
  a->page->section = d->page->section;
  a->page->open_told = d->page->open_told;
  a->stage = base->stage;
  answer_with(a, &own);
  d->page->section = a->page->section;
  d->page->open_told = a->page->open_told;
}
