// picture, inside: metres to pixels.
#ifndef PL_PICTURE_IMPL_H
#define PL_PICTURE_IMPL_H

#include "picture/picture.h"

typedef struct pl_fit { double scale, x0, y0; pl_frame_rect rect; } pl_fit;   // px/m, place of the origin
pl_fit pl_fit_make(const pl_scene* scene, pl_frame_rect r);
double pl_mass_radius(const pl_shape* p);     // px

#endif
