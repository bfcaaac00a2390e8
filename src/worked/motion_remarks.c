// motion_remarks: sentences about a motion that integrals reduce to one coordinate.
#include "worked/worked_impl.h"

pl_expr pl_say_way(pl_analysis* d, const pl_line* l, pl_expr e) {
  pl_symbol v = d->q.at[l->i].v;
  if (!pl_line_has_way(d, l, e)) return pl_poison();
  pl_say(d, PL_BOTH("This holds while {1}."), 1,
         pl_frel(d, pl_fs(d, v), l->direction > 0 ? ">" : "<",
                 pl_form_leaf(d->arena, pl_int(d->pool, 0))));
  return pl_mul(d->pool, pl_int(d->pool, l->direction), pl_sym(d->pool, v));
}

void pl_say_from_unused(pl_analysis* d) {
  const char* why = PL_KEY("more coordinates are free than integrals are known");
  if (pl_dissipates(d)) {
    why = PL_KEY("a force without potential acts");
  } else if (!pl_scleronomic(d)) {
    why = PL_KEY("a force or a constraint contains t");
  } else if (pl_nonholonomic(d)) {
    why = PL_KEY("a constraint contains velocities");
  }
  pl_say(
      d,
      pl_format(d->arena,
                "The velocities from this start are not known in closed form: %s. The formula "
                "holds for every start.",
                why),
      pl_format(
          d->arena,
          pl_german("The velocities from this start are not known in closed form: %s. The formula "
                    "holds for every start."),
          pl_german(why)),
      0);
  d->page->section->not_found = true;
}
