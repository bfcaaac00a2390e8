// motion_remarks: sentences about a motion that integrals reduce to one coordinate.
#include "worked/worked_impl.h"

pl_expr pl_say_way(pl_analysis* d, const pl_line* l, pl_expr e) {
  pl_symbol v = d->q.at[l->i].v;
  if (!pl_line_has_way(d, l, e)) return pl_poison();
  pl_say(d, "This holds while {1}.", "Das gilt, solange {1}.", 1,
         pl_frel(d, pl_fs(d, v), l->direction > 0 ? ">" : "<",
                 pl_form_leaf(d->arena, pl_int(d->pool, 0))));
  return pl_mul(d->pool, pl_int(d->pool, l->direction), pl_sym(d->pool, v));
}

void pl_say_from_unused(pl_analysis* d) {
  const char *en = "more coordinates are free than integrals are known",
             *de = "es sind mehr Koordinaten frei, als Integrale bekannt sind";
  if (pl_dissipates(d)) {
    en = "a force without potential acts";
    de = "es wirkt eine Kraft ohne Potential";
  } else if (!pl_scleronomic(d)) {
    en = "a force or a constraint contains t";
    de = "eine Kraft oder eine Zwangsbedingung enthält t";
  } else if (pl_nonholonomic(d)) {
    en = "a constraint contains velocities";
    de = "eine Zwangsbedingung enthält Geschwindigkeiten";
  }
  pl_say(d,
         pl_format(d->arena,
                   "The velocities from this start are not known in closed form: %s. The formula "
                   "holds for every start.",
                   en),
         pl_format(d->arena,
                   "Die Geschwindigkeiten ab diesem Start sind nicht geschlossen bekannt: %s. Die "
                   "Formel gilt für jeden Start.",
                   de),
         0);
  d->page->section->not_found = true;
}
