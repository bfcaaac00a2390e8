// Drawings, plots and animations of a model: the motion as it is looked at (views.c), the scene made from it, and the
// file that was asked for.
#include <math.h>
#include <string.h>

#include "api/api_impl.h"
#include "picture/picture.h"

typedef struct pl_showing {
  pl_views views;
  pl_scene* scene;
} pl_showing;

// Motion and scene.  A model that cannot be simulated is drawn at its start.
static pleuel_status look(pleuel_model* m, pl_language lang, int frames, pl_showing* out) {
  PL_TRY(pl_pipeline_check(m));
  pleuel_status s = pl_views_make(m, lang, &out->views);
  if (s == PLEUEL_INTERRUPTED || s == PLEUEL_NO_MEMORY) return s;
  pl_scene_options how = {.frames = frames, .forces = true, .velocities = true};
  return pl_scene_make(&m->job, m->model, out->views.result, &how, &out->scene);
}

pleuel_status pl_picture_plot(pleuel_model* m, pl_language lang, const pleuel_plot_options* o, const char** bytes, size_t* size) {
  pl_showing show = {0};
  PL_TRY(look(m, lang, 0, &show));
  double width = o->width > 0 ? o->width : 480, height = o->height > 0 ? o->height : 400;
  pl_drawing* d = pl_drawing_make(m->arena, width, height);
  d->title = show.scene->description[lang];
  pl_scene_style style = {.lang = lang, .forces = true, .trails = true, .labels = true};
  pl_draw_scene(d, show.scene, show.scene->best, (pl_frame_rect){0, 0, width, height}, &style);
  pl_text out = pl_text_make(m->arena);
  pl_svg_style svg = {0};
  pl_svg_write(&out, d, &svg);
  *bytes = pl_text_string(&out);
  *size = out.n;
  return PLEUEL_OK;
}
