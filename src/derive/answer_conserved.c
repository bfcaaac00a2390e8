// answer_conserved: energy, Jacobi's integral, momenta of cyclic coordinates, each with its reason.
#include "derive/derive_impl.h"

static void add_reason(pl_value* v, const char* en, const char* de, int conserved) {
  v->conserved = conserved;
  v->because[0] = en;
  v->because[1] = de;
}

// T and V written one after the other.
static const pl_form* energy_sum(pl_analysis* d, pl_expr integral) {
  pl_expr T = d->reduced ? d->Tg : pl_on_contact(d, d->T), V = d->reduced ? d->Vg : pl_on_contact(d, d->V);
  if (pl_alg_equal(d->tower, pl_add(d->pool, T, V), integral) != PL_YES) return pl_f(d, integral, PL_S_ENERGY);
  const pl_form* part[2] = {pl_f(d, T, PL_S_ENERGY), pl_potential_form(d, pl_on_maps(d, d->V), V)};
  return pl_joined_sum(d, part, 2);
}

// dE/dt vanishes on the motion; while the constraints are not solved, up to the power of the constraint forces, sum λ dg/dt.
static void claim_constant(pl_analysis* d, const pl_form* form) {
  pl_expr power = pl_int(d->pool, 0);
  for (int k = 0; !d->reduced && k < d->g.n; k++) {
    if (d->g.at[k].implied || d->g.at[k].fixes >= 0) continue;
    pl_expr rate = d->g.at[k].velocity ? d->g.at[k].g : pl_dt(d->pool, d->g.at[k].g);
    power = pl_add(d->pool, power, pl_mul(d->pool, pl_sym(d->pool, d->g.at[k].lambda), rate));
  }
  pl_claim_that(d, PL_CLAIM_MOTION, pl_dt(d->pool, pl_form_value(d->pool, form)), power);
}

static void jacobi(pl_analysis* d) {
  pl_expr integral = pl_energy_integral(d);
  const pl_form* form = pl_f(d, integral, PL_S_ENERGY);
  pl_why_energy(d, integral);
  pl_step_refs(pl_show(d, pl_feq(d, pl_fn(d, "H"), form)), 1, d->number_lagrangian);
  pl_say(d, "Jacobi's integral is conserved: in these coordinates the Lagrange function does not contain t.",
         "Das Jacobi-Integral ist erhalten: in diesen Koordinaten enthält die Lagrange-Funktion t nicht.", 0);
  add_reason(pl_answer(d, "H", integral, form), "the Lagrange function does not contain t", "die Lagrange-Funktion enthält t nicht", 1);
  claim_constant(d, form);
}

static void energy(pl_analysis* d) {
  bool scleronomic = pl_scleronomic(d), conserved = pl_energy_conserved(d);
  pl_expr integral = pl_energy_integral(d);
  const char *en, *de;
  if (d->dissipative) {
    en = "a force without potential acts";
    de = "es wirkt eine Kraft ohne Potential";
  } else if (scleronomic && conserved) {
    en = "all forces have a potential, and no constraint contains t";
    de = "alle Kräfte haben ein Potential, und keine Zwangsbedingung enthält t";
  } else if (scleronomic) {
    en = "a constraint that is not homogeneous in the velocities does work";
    de = "eine in den Geschwindigkeiten nicht homogene Zwangsbedingung leistet Arbeit";
  } else {
    en = "a constraint or force contains t, so the constraint does work";
    de = "eine Zwangsbedingung oder Kraft enthält t, der Zwang leistet also Arbeit";
  }
  if (conserved && scleronomic) {
    const pl_form* form = energy_sum(d, integral);
    pl_why_energy(d, integral);
    pl_step_refs(pl_show(d, pl_feq(d, pl_fn(d, "E"), form)), 1, d->number_lagrangian);
    const pl_form* V = pl_potential_form(d, pl_on_maps(d, d->V), d->reduced ? d->Vg : pl_on_contact(d, d->V));
    if (pl_is_zero_node(d->pool, d->V)) {
      pl_say(d, "conserved: the Lagrange function does not contain t, and neither does any constraint.",
             "erhalten: weder die Lagrange-Funktion noch eine Zwangsbedingung enthält t.", 0);
    } else {
      pl_say(d, "conserved: all forces have the potential {1}, and no constraint contains t.",
             "erhalten: alle Kräfte haben das Potential {1}, und keine Zwangsbedingung enthält t.", 1, pl_feq(d, pl_fn(d, "V"), V));
    }
    add_reason(pl_answer(d, "E", integral, form), en, de, 1);
    claim_constant(d, form);
    return;
  }
  pl_say(d, pl_format(d->arena, "The energy is not conserved: %s.", en), pl_format(d->arena, "Die Energie ist nicht erhalten: %s.", de), 0);
  add_reason(pl_answer(d, "E", pl_poison(), NULL), en, de, 0);
  if (conserved) jacobi(d);
}

// Is the generalized force along coordinate i zero, so that a cyclic momentum is conserved?
bool pl_pushed(pl_analysis* d, int i) {
  for (int j = 0; j < d->q.n; j++) {
    if (pl_is_zero_node(d->pool, d->force[j])) continue;
    const pl_variable* c = &d->q.at[j];
    if (j == i || (!pl_is_poison(c->map) && !pl_is_zero_node(d->pool, pl_by_coordinate(d, c->map, i)))) return true;
  }
  return false;
}

static void cyclic(pl_analysis* d, int i) {
  const pl_variable* c = &d->q.at[i];
  if (pl_alg_is_zero(d->tower, pl_by_coordinate(d, d->Lg, i)) != PL_YES) return;
  pl_expr p = pl_alg_normal(d->tower, pl_diff(d->pool, d->Lg, c->v));
  const char* name = pl_format(d->arena, "p_%s", pl_symbol_get(d->pool, c->q)->ascii);
  const pl_form* form = pl_f(d, p, PL_S_ENERGY);
  bool conserved = !pl_pushed(d, i);
  if (conserved) pl_why_cyclic(d, i);
  pl_step* step = pl_show(d, pl_feq(d, pl_fn(d, pl_format(d->arena, "p_%s", pl_symbol_get(d->pool, c->q)->name)), form));
  pl_step_refs(step, 1, d->number_lagrangian);
  pl_say(d, conserved ? "conserved: {1} is cyclic, it does not occur in the Lagrange function."
                      : "{1} is cyclic, but a force without potential acts along it: not conserved.",
         conserved ? "erhalten: {1} ist zyklisch, kommt also in der Lagrange-Funktion nicht vor."
                   : "{1} ist zyklisch, aber längs ihrer wirkt eine Kraft ohne Potential: nicht erhalten.",
         1, pl_fs(d, c->q));
  add_reason(pl_answer(d, name, p, form), "cyclic coordinate", "zyklische Koordinate", conserved);
  if (conserved) pl_claim_that(d, PL_CLAIM_MOTION, pl_dt(d->pool, pl_form_value(d->pool, form)), pl_int(d->pool, 0));
}

// A momentum that the section has already, in the coordinates of the model.
static bool is_found(pl_analysis* a, int i) {
  pl_expr p = pl_diff(a->pool, a->Lg, a->q.at[i].v);
  for (int k = 0; k < a->section->values.n; k++) {
    const pl_value* v = &a->section->values.at[k];
    if (v->conserved == 1 && pl_alg_equal(a->tower, pl_on_maps(a, v->expr), p) == PL_YES) return true;
  }
  return false;
}

// What only generalized coordinates show: Jacobi's integral, and momenta beside those of the whole system.
static void in_proposed(pl_analysis* d) {
  pl_analysis* a = d->reduced ? NULL : pl_propose(d);
  if (!a || a->loops.n > 0) return;
  a->section = d->section;
  if (!pl_energy_conserved(d) && pl_energy_conserved(a) && !pl_scleronomic(a)) {
    pl_tell_proposal(a);
    jacobi(a);
  }
  for (int k = 0; k < a->gen.n; k++) {
    int i = a->gen.at[k];
    if (pl_alg_is_zero(a->tower, pl_by_coordinate(a, a->Lg, i)) != PL_YES || is_found(a, i)) continue;
    pl_tell_proposal(a);
    cyclic(a, i);
  }
}

void pl_answer_conserved(pl_analysis* d, const pl_ask* ask) {
  pl_section_open(d, ask, "Conserved", "Erhaltungsgrößen");
  energy(d);
  for (int k = 0; d->reduced && k < d->gen.n && !pl_nonholonomic(d); k++) cyclic(d, d->gen.at[k]);
  pl_conserved_momenta(d);
  in_proposed(d);
}
