// Surfaces of a single constraint in space, as a net: lines of equal height and lines through the
// place of the thing.
#include <math.h>
#include <string.h>

#include "scene/scene_impl.h"

enum { LEVELS = 4, MERIDIANS = 2 };

static void place_line(pl_stage* s, const pl_part* part, double* xyz) {
  bool closed;
  pl_track_follow(s, part->data, xyz, &closed);
}

// The curve of the surface where component `axis` has this value, looked for from the present
// values.
static void add_line(pl_stage* s, const pl_track* surface, int axis, double at, const char* of) {
  pl_track* t = PL_NEW(s->arena, pl_track);
  *t = *surface;
  t->fixed_axis = axis;
  t->fixed_at = at;
  t->whole = true;
  double* trial = PL_ARRAY(s->arena, double, 3 * t->n);
  bool closed;
  if (pl_track_follow(s, t, trial, &closed) == 0) return;
  pl_part* p = pl_stage_add(s, PL_SHAPE_CURVE, "", of);
  p->n = t->n;
  p->place = place_line;
  p->data = t;
}

bool pl_stage_surface(pl_stage* s, const pl_track* surface, const char* of) {
  int up = -1, before = s->parts.n;
  const pl_spot* spot = &s->things.at[surface->thing].spot;
  for (int j = 0; j < 3; j++)
    if (fabs(s->down[j]) > 0.9) up = j;
  if (up < 0) up = 2;
  double x[3];
  pl_stage_spot(s, spot, x);
  if (!isfinite(x[0] + x[1] + x[2])) return false;
  pl_track wide = *surface;  // round the origin, so that lines of equal height close
  for (int j = 0; j < 3; j++) {
    double half = 0.2 * s->size;
    for (int k = 0; k < 3; k++) half = fmax(half, fmax(fabs(s->lo[k]), fabs(s->hi[k])));
    wide.box_lo[j] = -1.3 * half;
    wide.box_hi[j] = 1.3 * half;
  }
  surface = &wide;
  double lo = fmin(s->lo[up], x[up] - 0.5 * s->size), hi = fmax(s->hi[up], x[up] + 0.25 * s->size);
  for (int i = 0; i <= LEVELS; i++) add_line(s, surface, up, lo + (hi - lo) * i / LEVELS, of);
  add_line(s, surface, up, x[up], of);
  for (int j = 0, k = 0; j < 3 && k < MERIDIANS; j++) {
    if (j == up) continue;
    add_line(s, surface, j, (s->lo[j] + s->hi[j]) / 2 * (s->n_frames > 1), of);
    k++;
  }
  return s->parts.n > before;
}
