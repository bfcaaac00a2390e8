// picture, inside: metres to pixels, axes.
#ifndef PL_PICTURE_IMPL_H
#define PL_PICTURE_IMPL_H

#include "picture/picture.h"

// px/m, place of the origin
typedef struct pl_fit {
  double scale, x0, y0;
  pl_frame_rect rect;
  bool crowd;
} pl_fit;
pl_fit pl_fit_make(const pl_scene* scene, pl_frame_rect r);
double pl_mass_radius(const pl_shape* p);  // px

// ---- plot_axis.c
typedef struct pl_axis_scale {
  double lo, hi, step, first;  // ticks at (first + i) step
  int n, decimals, power;      // ticks are shown divided by 10^power
} pl_axis_scale;
// tight: the range of the data itself
pl_axis_scale pl_axis_make(double lo, double hi, double wanted, bool tight);
double pl_axis_tick(const pl_axis_scale* a, int i);
const char* pl_axis_text(pl_arena* arena, const pl_axis_scale* a, double x, pl_language lang);
const char* pl_axis_title(pl_arena* arena, const char* name, const char* unit, int power);

// ---- svg.c
void pl_svg_sheet(pl_text* out, const pl_drawing* d, pl_theme theme);
void pl_svg_stroke(pl_text* out, const pl_stroke* s);

#endif
