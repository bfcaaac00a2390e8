// Parts that several of the others add to the picture.
#include <math.h>

#include "scene/scene_impl.h"

pl_part* pl_stage_add(pl_stage* s, pl_shape_kind kind, const char* label, const char* of) {
  pl_part p = {.kind = kind, .label = label ? label : "", .of = of ? of : "", .n = 2};
  pl_push(s->arena, s->parts, p);
  return &s->parts.at[s->parts.n - 1];
}

void pl_add_rod(pl_stage* s, pl_shape_kind kind, const pl_bond* b, const pl_spot* from,
                const pl_spot* to) {
  pl_part* p = pl_stage_add(s, kind, "", b ? b->c->name.text : "");
  p->spot[0] = *from;
  p->spot[1] = *to;
  p->moves = true;
}

void pl_add_pivot(pl_stage* s, const double x[3]) {
  for (int i = 0; i < s->parts.n; i++) {
    const pl_part* p = &s->parts.at[i];
    if (p->kind != PL_SHAPE_POINT || !p->spot[0].fixed) continue;
    if (hypot(hypot(p->spot[0].at[0] - x[0], p->spot[0].at[1] - x[1]), p->spot[0].at[2] - x[2])
        < 1e-9 * fmax(s->size, 1))
      return;
  }
  for (int i = 0; i < s->things.n; i++) {
    double at[3];
    pl_stage_spot(s, &s->things.at[i].spot, at);
    if (s->things.at[i].deps.n == 0
        && hypot(hypot(at[0] - x[0], at[1] - x[1]), at[2] - x[2]) < 1e-9 * fmax(s->size, 1))
      return;
  }
  pl_part* p = pl_stage_add(s, PL_SHAPE_POINT, "", "");
  p->n = 1;
  p->spot[0] = pl_spot_fixed(x);
}
