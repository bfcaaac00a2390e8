// What the model says about its picture: `draw` adds lines, shows and hides; `animate` names the
// arrows and trails to begin with.
#include <string.h>

#include "scene/scene_impl.h"

static bool is_weight(const pl_part* p) {
  return p->kind == PL_SHAPE_FORCE && strcmp(p->of, "weight") == 0;
}

static bool is_of_kind(const pl_part* p, const char* what) {
  if (strcmp(what, "axes") == 0) return p->kind == PL_SHAPE_AXIS;
  if (strcmp(what, "angles") == 0) return p->kind == PL_SHAPE_ANGLE;
  if (strcmp(what, "trail") == 0) return p->kind == PL_SHAPE_TRAIL;
  if (strcmp(what, "velocity") == 0) return p->kind == PL_SHAPE_VELOCITY;
  if (strcmp(what, "weight") == 0) return is_weight(p);
  if (strncmp(what, "force", 5) == 0) return p->kind == PL_SHAPE_FORCE && !is_weight(p);
  return !*what;
}

static bool is_meant(const pl_drawn* d, const pl_part* p) {
  return is_of_kind(p, d->what) && (!d->of || strcmp(d->of, p->of) == 0);
}

// Arrows and trails are those that `animate` names, when it names any.
static void follow_animate(pl_stage* s) {
  bool names = false;
  for (int k = 0; k < s->model->draws.n; k++)
    names |= s->model->draws.at[k].kind == PL_DRAW_ANIMATE
             && strcmp(s->model->draws.at[k].what, "count") != 0;
  for (int i = 0; names && i < s->parts.n; i++) {
    pl_part* p = &s->parts.at[i];
    if (p->kind != PL_SHAPE_FORCE && p->kind != PL_SHAPE_TRAIL && p->kind != PL_SHAPE_VELOCITY)
      continue;
    p->hidden = true;
    for (int k = 0; k < s->model->draws.n; k++) {
      const pl_drawn* d = &s->model->draws.at[k];
      if (d->kind == PL_DRAW_ANIMATE && is_meant(d, p)) p->hidden = false;
    }
  }
}

static void add_line(pl_stage* s, const pl_drawn* d) {
  static const struct {
    const char* word;
    pl_shape_kind kind;
  } kinds[] = {{"line", PL_SHAPE_CURVE},
               {"rod", PL_SHAPE_ROD},
               {"rope", PL_SHAPE_ROPE},
               {"spring", PL_SHAPE_SPRING},
               {"damper", PL_SHAPE_DAMPER}};
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
    if (strcmp(kinds[i].word, d->what) != 0) continue;
    pl_spot a = pl_spot_of(s, &d->a), b = pl_spot_of(s, &d->b);
    pl_add_rod(s, kinds[i].kind, NULL, &a, &b);
  }
}

void pl_stage_draws(pl_stage* s) {
  follow_animate(s);
  for (int k = 0; k < s->model->draws.n; k++) {
    const pl_drawn* d = &s->model->draws.at[k];
    if (d->kind == PL_DRAW_LINE) add_line(s, d);
    if (d->kind != PL_DRAW_SHOW && d->kind != PL_DRAW_HIDE) continue;
    for (int i = 0; i < s->parts.n; i++) {
      if (is_meant(d, &s->parts.at[i])) s->parts.at[i].hidden = d->kind == PL_DRAW_HIDE;
    }
  }
}
