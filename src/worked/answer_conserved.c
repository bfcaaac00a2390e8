// answer_conserved: energy, Jacobi's integral, momenta of cyclic coordinates, each with its reason.
// See theory (6.1), (6.2).
#include "worked/worked_impl.h"

static void add_reason(pl_value* v, const char* en, const char* de, int conserved) {
  v->conserved = conserved;
  v->because[0] = en;
  v->because[1] = de;
}

// T and V written one after the other.
static const pl_form* energy_sum(pl_analysis* d, pl_expr integral) {
  pl_expr T = d->reduced ? d->Tg : pl_on_contact(d, d->T),
          V = d->reduced ? d->Vg : pl_on_contact(d, d->V);
  if (pl_alg_equal(d->tower, pl_add(d->pool, T, V), integral) != PL_YES)
    return pl_f(d, integral, PL_S_ENERGY);
  const pl_form* part[2] = {pl_f(d, T, PL_S_ENERGY), pl_potential_form(d, pl_on_maps(d, d->V), V)};
  return pl_joined_sum(d, part, 2);
}

// dE/dt vanishes on the motion; while the constraints are not solved, up to the power of the
// constraint forces, sum λ dg/dt.
static void claim_constant(pl_analysis* d, const pl_form* form) {
  pl_expr power = pl_int(d->pool, 0);
  for (int k = 0; !d->reduced && k < d->g.n; k++) {
    if ((d->g.at[k].implied && !d->g.at[k].shared) || d->g.at[k].fixes >= 0) continue;
    pl_expr rate = d->g.at[k].velocity ? d->g.at[k].g : pl_dt(d->pool, d->g.at[k].g);
    power = pl_add(d->pool, power, pl_mul(d->pool, pl_sym(d->pool, d->g.at[k].lambda), rate));
  }
  pl_claim_that(d, PL_CLAIM_MOTION, pl_dt(d->pool, pl_form_value(d->pool, form)), power);
}

typedef struct pl_words {
  const char *en, *de;
} pl_words;

static bool contains_time(pl_analysis* d) {
  for (int k = 0; k < d->g.n; k++) {
    if (!d->g.at[k].implied && pl_has_symbol(d->pool, d->g.at[k].g, pl_time(d->pool))) return true;
  }
  return false;
}

// Why T + V is not conserved.
static pl_words loss(pl_analysis* d) {
  if (pl_dissipates(d)) return (pl_words){PL_BOTH("a force without potential acts")};
  if (pl_scleronomic(d)) {
    return (pl_words){PL_BOTH("a constraint that is not homogeneous in the velocities does work")};
  }
  if (contains_time(d)) {
    return (pl_words){PL_BOTH("a constraint contains t, so its force does work")};
  }
  return (pl_words){PL_BOTH("the Lagrange function contains t")};
}

static void energy_is_conserved(pl_analysis* d, pl_expr integral) {
  const pl_form* form = energy_sum(d, integral);
  if (!d->dissipative) pl_why_energy(d, integral);
  pl_step_refs(pl_show(d, pl_feq(d, pl_fl(d, "E"), form)), 1, d->page->number_lagrangian);
  const pl_form* V = pl_potential_form(d, pl_on_maps(d, d->V),
                                       d->reduced ? d->Vg : pl_on_contact(d, d->V));
  if (d->dissipative) {
    pl_say(
        d,
        PL_BOTH(
            "conserved: the forces without potential do no work, and neither the Lagrange function "
            "nor a constraint contains t."),
        0);
  } else if (pl_is_zero_node(d->pool, d->V)) {
    pl_say(d,
           PL_BOTH("conserved: the Lagrange function does not contain t, and neither does any "
                   "constraint."),
           0);
  } else {
    pl_say(d,
           PL_BOTH("conserved: all forces have the potential {1}, and no constraint contains t."),
           1, pl_feq(d, pl_fl(d, "V"), V));
  }
  add_reason(
      pl_answer(d, "E", integral, form),
      PL_BOTH(d->dissipative ? "the forces without potential do no work, and nothing contains t"
                             : "all forces have a potential, and no constraint contains t"),
      1);
  claim_constant(d, form);
}

// H = sum v ∂L/∂v - L, or what is left of it when ∂L/∂t is a total time derivative.
static void jacobi(pl_analysis* d, pl_expr integral) {
  bool pure = pl_alg_is_zero(d->tower, pl_sub(d->pool, integral, pl_energy_integral(d))) == PL_YES;
  const pl_form* form = pl_f(d, integral, PL_S_ENERGY);
  if (pure) pl_why_energy(d, integral);
  pl_step_refs(pl_show(d, pl_feq(d, pl_fl(d, pure ? "H" : "J"), form)), 1,
               d->page->number_lagrangian);
  pl_say(
      d,
      PL_BOTH(
          pure ? "Jacobi's integral is conserved: in these coordinates the Lagrange function does "
                 "not contain t."
               : "Jacobi's integral is conserved: the Lagrange function contains t only in a total "
                 "time derivative."),
      0);
  add_reason(pl_answer(d, pure ? "H" : "J", integral, form),
             PL_BOTH(pure ? "the Lagrange function does not contain t"
                          : "the Lagrange function contains t only in a total time derivative"),
             1);
  claim_constant(d, form);
}

static void energy(pl_analysis* d) {
  pl_expr integral = pl_jacobi_integral(d);
  if (!pl_is_poison(integral) && pl_scleronomic(d)) {
    energy_is_conserved(d, integral);
    return;
  }
  pl_words why = loss(d);
  pl_say(d, pl_format(d->arena, "The energy is not conserved: %s.", why.en),
         pl_format(d->arena, pl_german("The energy is not conserved: %s."), why.de), 0);
  add_reason(pl_answer(d, "E", pl_poison(), NULL), why.en, why.de, 0);
  if (!pl_is_poison(integral)) jacobi(d, integral);
}

static void cyclic(pl_analysis* d, int i) {
  const pl_variable* c = &d->q.at[i];
  if (pl_alg_is_zero(d->tower, pl_by_coordinate(d, d->Lg, i)) != PL_YES) return;
  pl_expr p = pl_alg_normal(d->tower, pl_diff(d->pool, d->Lg, c->v));
  const char* name = pl_format(d->arena, "p_%s", pl_symbol_get(d->pool, c->q)->ascii);
  const pl_form* form = pl_f(d, p, PL_S_ENERGY);
  bool conserved = !pl_pushed(d, i);
  if (conserved) pl_why_cyclic(d, i);
  pl_step* step = pl_show(
      d,
      pl_feq(d, pl_fn(d, pl_format(d->arena, "p_%s", pl_symbol_get(d->pool, c->q)->name)), form));
  pl_step_refs(step, 1, d->page->number_lagrangian);
  pl_say(
      d,
      PL_BOTH(conserved
                  ? "conserved: {1} is cyclic, it does not occur in the Lagrange function."
                  : "{1} is cyclic, but a force without potential acts along it: not conserved."),
      1, pl_fs(d, c->q));
  add_reason(pl_answer(d, name, p, form), PL_BOTH("cyclic coordinate"), conserved);
  if (conserved)
    pl_claim_that(d, PL_CLAIM_MOTION, pl_dt(d->pool, pl_form_value(d->pool, form)),
                  pl_int(d->pool, 0));
}

// A momentum that the section has already, in the coordinates of the model.
static bool is_found(pl_analysis* a, int i) {
  pl_expr p = pl_diff(a->pool, a->Lg, a->q.at[i].v);
  for (int k = 0; k < a->page->section->values.n; k++) {
    const pl_value* v = &a->page->section->values.at[k];
    if (v->conserved == 1 && pl_alg_equal(a->tower, pl_on_maps(a, v->expr), p) == PL_YES)
      return true;
  }
  return false;
}

// What only generalized coordinates show: Jacobi's integral, and momenta beside those of the whole
// system.
static void in_proposed(pl_analysis* d) {
  pl_analysis* a = d->reduced ? NULL : pl_page_propose(d);
  if (!a || a->loops.n > 0) return;
  a->page->section = d->page->section;
  if (!pl_energy_conserved(d) && pl_energy_conserved(a) && !pl_scleronomic(a)) {
    pl_tell_proposal(a);
    jacobi(a, pl_jacobi_integral(a));
  }
  for (int k = 0; k < a->gen.n; k++) {
    int i = a->gen.at[k];
    if (pl_alg_is_zero(a->tower, pl_by_coordinate(a, a->Lg, i)) != PL_YES || is_found(a, i))
      continue;
    pl_tell_proposal(a);
    cyclic(a, i);
  }
}

void pl_answer_conserved(pl_analysis* d, const pl_ask* ask) {
  pl_section_open(d, ask, PL_BOTH("Conserved"));
  energy(d);
  for (int k = 0; d->reduced && k < d->gen.n && !pl_nonholonomic(d); k++) cyclic(d, d->gen.at[k]);
  pl_answer_momenta(d);
  in_proposed(d);
}
