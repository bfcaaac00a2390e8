// Drawings, plots and animations of a model: the motion as it is looked at (views.c), the scene
// made from it, and the file that was asked for.
#include <math.h>
#include <string.h>

#include "api/api_impl.h"
#include "picture/picture.h"

typedef struct pl_showing {
  pl_views views;
  pl_scene* scene;
  int n_panels;
  pl_plot_panel* panels;
} pl_showing;

// -------------------------------------------------------------------------------- motion and scene
// Runs with another end, or with one where the file has none.
static pleuel_status run_until(pleuel_model* m, pl_language lang, bool has_until, double until,
                               pl_views* views) {
  pl_simulate before = m->model->simulate;
  if (has_until) {
    char text[32];
    pl_double_text(text, fabs(until));
    pl_expr end = pl_number_from_text(m->model->pool, text, strlen(text));
    m->model->simulate.to = until < 0 ? pl_neg(m->model->pool, end) : end;
    if (!before.given) m->model->simulate.from = pl_int(m->model->pool, 0);
    m->model->simulate.given = true;
    m->model->simulate.step = pl_poison();
    m->model->simulate.count = 0;
    m->is_recorded = false;
  }
  bool even = m->model->simulate.given && pl_is_poison(m->model->simulate.step)
              && m->model->simulate.count == 0;
  int n = pl_model_flat_coords(m->model, m->work).n;
  if (even) m->model->simulate.count = n < 40 ? 2880 : n < 400 ? 960 : 240;
  m->is_recorded = false;
  pleuel_status s = pl_views_make(m, lang, views);
  if (has_until || even) {
    m->model->simulate = before;
    m->is_recorded = false;
  }
  return s;
}

// Motion and scene. A model without `simulate` is drawn at its start; a motion that ends early as
// far as it goes.
static pleuel_status look(pleuel_model* m, pl_language lang, bool has_until, double until,
                          int frames, pl_showing* out) {
  PL_TRY(pl_pipeline_check(m));
  if (has_until && !isfinite(until))
    return pl_fail(&m->job, PLEUEL_USAGE, "the end of the run is no number");
  pleuel_status s = run_until(m, lang, has_until, until, &out->views);
  bool asked = has_until || m->model->simulate.given;
  if (s == PLEUEL_INTERRUPTED || s == PLEUEL_NO_MEMORY || (asked && !out->views.result)) return s;
  pl_scene_options how = {.frames = frames, .forces = true, .velocities = true};
  pleuel_status drawn = pl_scene_make(&m->job, m->model, out->views.result, &how, &out->scene);
  return drawn != PLEUEL_OK ? drawn : s;
}

pl_scene* pl_picture_scene(pleuel_model* m, pl_language lang) {
  enum { FRAMES = 240 };
  pl_showing show = {0};
  char sentence[sizeof m->job.message];
  memcpy(sentence, m->job.message, sizeof sentence);
  look(m, lang, false, 0, FRAMES, &show);
  memcpy(m->job.message, sentence, sizeof sentence);
  return show.scene;
}

// ------------------------------------------------------------------------------------------ panels
static const double* column_of(pl_arena* a, const pl_result* r, int column) {
  double* x = PL_ARRAY(a, double, r->rows.n + 1);
  for (int i = 0; i < r->rows.n; i++) x[i] = r->rows.at[i][column];
  return x;
}

static const char* event_label(pl_arena* a, const pl_result_event* e, pl_language lang) {
  const char* label = e->label ? e->label : "";
  switch (e->kind) {
    case PL_EV_RELEASE:
      return pl_format(a, lang == PL_GERMAN ? pl_german("%s lets go") : "%s lets go", label);
    case PL_EV_IMPACT:
      return pl_format(a, lang == PL_GERMAN ? pl_german("impact on %s") : "impact on %s", label);
    case PL_EV_CONTACT:
      return pl_format(a, lang == PL_GERMAN ? pl_german("contact with %s") : "contact with %s",
                       label);
    default: return label;
  }
}

enum { MOST_MARKS = 12 };

static void make_marks(pleuel_model* m, pl_language lang, const pl_result* r, pl_plot_panel* p) {
  pl_plot_mark* mark = PL_ARRAY(m->work, pl_plot_mark, MOST_MARKS);
  for (int i = 0; i < r->events.n && p->n_marks < MOST_MARKS; i++) {
    mark[p->n_marks++] = (pl_plot_mark){r->events.at[i].t,
                                        event_label(m->work, &r->events.at[i], lang)};
  }
  p->marks = mark;
}

static void make_panels(pleuel_model* m, pl_language lang, pl_showing* show) {
  const pl_views* v = &show->views;
  show->panels = PL_ARRAY(m->work, pl_plot_panel, v->plots.n + 1);
  for (int i = 0; v->result && i < v->plots.n; i++) {
    const pl_html_plot* from = &v->plots.at[i];
    if (from->title && m->model->plots.n > 0) continue;  // what the model asks for is enough
    pl_plot_panel* p = &show->panels[show->n_panels++];
    pl_curve_data* curve = PL_ARRAY(m->work, pl_curve_data, from->n_curves + 1);
    const double* x = column_of(m->work, v->result, from->x_column);
    for (int k = 0; k < from->n_curves; k++) {
      const pl_html_curve* c = &from->curves[k];
      curve[k] = (pl_curve_data){c->name, c->unit, v->result->rows.n, x,
                                 column_of(m->work, v->result, c->column)};
    }
    *p = (pl_plot_panel){.title = from->title,
                         .x_name = from->x_name ? from->x_name : "t",
                         .n_curves = from->n_curves,
                         .curves = curve};
    p->x_unit = from->x_name ? from->x_unit : m->model->uses_units ? "s" : "";
    if (!from->x_name) make_marks(m, lang, v->result, p);
  }
}

// ---------------------------------------------------------------------------------------- the page
static const double cell_width = 440, cell_height = 320, head = 34;

enum { MOST_BESIDE = 3 };  // plots that stand beside a drawing as high as all of them

static int count_rows(int n_panels, bool drawing) {
  if (drawing && n_panels > 0 && n_panels <= MOST_BESIDE) return n_panels;
  return n_panels + drawing > 1 ? (n_panels + drawing + 1) / 2 : 1;
}

static void draw_panels(pl_drawing* d, pleuel_model* m, pl_language lang, const pl_showing* show,
                        bool drawing, const pl_scene_style* style) {
  int n = show->n_panels + drawing, columns = n > 1 ? 2 : 1,
      rows = count_rows(show->n_panels, drawing);
  bool beside = drawing && n > 1 && show->n_panels <= MOST_BESIDE;
  double top = m->model->title ? head : 0, w = d->width / columns, h = (d->height - top) / rows;
  if (m->model->title) pl_draw_text(d, PL_INK_TEXT, 16, PL_ANCHOR_START, 16, 24, m->model->title);
  for (int i = 0; i < n; i++) {
    pl_frame_rect r = {w * (i % columns), top + h * (i / columns), w, h};
    if (beside) r = (pl_frame_rect){i ? w : 0, i ? top + h * (i - 1) : top, w, i ? h : h * rows};
    if (drawing && i == 0) pl_draw_scene(d, show->scene, show->scene->best, r, style);
    else pl_draw_plot(d, &show->panels[i - drawing], r, lang);
  }
}

static pleuel_status need_cairo(pleuel_model* m) {
  if (pl_raster_there()) return PLEUEL_OK;
  return pl_fail(&m->job, PLEUEL_UNSUPPORTED,
                 "this build has no cairo: it writes SVG, but no PNG, PDF, GIF and MP4");
}

pleuel_status pl_picture_plot(pleuel_model* m, pl_language lang, const pleuel_plot_options* o,
                              const char** bytes, size_t* size) {
  pl_showing show = {0};
  pleuel_status s = look(m, lang, o->has_until, o->until, 720, &show);
  if (!show.scene) return s;
  make_panels(m, lang, &show);
  if (s == PLEUEL_OK && o->panels != PLEUEL_PANELS_DRAWING && show.views.missing) {
    pl_fail(&m->job, PLEUEL_OK, "no number along the motion, and so no curve: %s",
            show.views.missing);
  }
  bool drawing = o->panels != PLEUEL_PANELS_PLOTS && show.scene->n_shapes > 0;
  if (o->panels == PLEUEL_PANELS_DRAWING) show.n_panels = 0;
  int n = show.n_panels + drawing, columns = n > 1 ? 2 : 1;
  if (n == 0)
    return pl_fail(&m->job, PLEUEL_UNSUPPORTED,
                   "there is nothing to draw: no motion (`simulate`, or --until) and nothing that "
                   "has a place");
  double top = m->model->title ? head : 0;
  double width = o->width > 0 ? o->width : n == 1 ? 560 : columns * cell_width;
  double height = o->height > 0 ? o->height
                  : n == 1      ? 420 + top
                           : (n == 2 ? 1.25 : 1) * cell_height * count_rows(show.n_panels, drawing)
                                 + top;
  pl_drawing* d = pl_drawing_make(m->work, width, height);
  d->title = show.scene->description[lang];
  pl_scene_style style = {.lang = lang, .forces = !o->no_forces, .trails = true, .labels = true};
  draw_panels(d, m, lang, &show, drawing, &style);
  if (o->format == PLEUEL_SVG) {
    pl_text out = pl_text_make(m->work);
    pl_svg_style svg = {.theme = (pl_theme)o->style};
    pl_svg_write(&out, d, &svg);
    *bytes = pl_text_string(&out);
    *size = out.n;
  } else {
    PL_TRY(need_cairo(m));
    if (!pl_raster_file(d, (pl_theme)o->style, o->format == PLEUEL_PDF, bytes, size))
      return pl_fail(&m->job, PLEUEL_NO_MEMORY, "the picture could not be drawn");
  }
  return s;
}

// -------------------------------------------------------------------------------------- animations
static const double shortest = 3, longest = 12;  // s, of an animation that nobody gave a length
enum { MOST_FRAMES = 600, FRAMES_PER_S = 15 };

typedef struct pl_film {
  int n;
  double seconds, fps;
} pl_film;

// As long as the motion itself, unless that would be over at once or for ever.
static pl_film film_of(const pl_scene* scene, const pleuel_animate_options* o) {
  double span = fabs(scene->t[scene->n_frames - 1] - scene->t[0]);
  pl_film f = {.seconds = o->seconds > 0 ? o->seconds : fmax(shortest, fmin(longest, span)),
               .fps = o->fps > 0 ? o->fps : FRAMES_PER_S};
  double n = floor(f.seconds * f.fps + 0.5);
  f.n = (int)fmax(2, fmin(fmin(MOST_FRAMES, scene->n_frames), n));
  return f;
}

// The frame of the scene for a frame of the film.
static int scene_frame(const pl_scene* scene, const pl_film* f, int i) {
  return (int)((long)i * (scene->n_frames - 1) / (f->n - 1));
}

static void draw_time(pl_drawing* d, pleuel_model* m, pl_language lang, double t) {
  char* text = pl_format(m->work, "t = %.2f%s", t, m->model->uses_units ? " s" : "");
  for (char* c = text; lang == PL_GERMAN && *c; c++)
    if (*c == '.') *c = ',';
  pl_draw_text(d, PL_INK_MUTED, 13, PL_ANCHOR_END, d->width - 14, d->height - 12, text);
}

static pl_drawing* draw_film(pleuel_model* m, pl_language lang, const pl_showing* show,
                             const pl_film* f, const pleuel_animate_options* o, int* best) {
  const pl_scene* scene = show->scene;
  double width = o->width > 0 ? o->width : 480, height = o->height > 0 ? o->height : 440,
         top = m->model->title ? head : 0;
  pl_drawing* d = pl_drawing_make(m->work, width, height);
  pl_frame_rect r = {0, top, width, height - top - 16};
  pl_scene_style style = {
      .lang = lang, .forces = o->forces, .trails = true, .labels = true, .steady = true};
  d->title = scene->description[lang];
  if (m->model->title) pl_draw_text(d, PL_INK_TEXT, 16, PL_ANCHOR_START, 16, 24, m->model->title);
  pl_draw_scene_still(d, scene, r, &style);
  *best = 0;
  for (int i = 0; i < f->n; i++) {
    int from = d->strokes.n, frame = scene_frame(scene, f, i);
    pl_draw_scene_moving(d, scene, frame, r, &style);
    draw_time(d, m, lang, scene->t[frame]);
    for (int k = from; k < d->strokes.n; k++) {
      d->strokes.at[k].from = i;
      d->strokes.at[k].to = i + 1;
    }
    if (frame <= scene->best) *best = i;
  }
  return d;
}

// Pixels of each frame to the one who asked for them.
static pleuel_status hand_frames(pleuel_model* m, const pl_drawing* d, const pl_film* f,
                                 const pleuel_animate_options* o) {
  int w = (int)d->width, h = (int)d->height;
  uint32_t* pixels = PL_ARRAY(m->work, uint32_t, (size_t)w * (size_t)h);
  for (int i = 0; i < f->n; i++) {
    if (pl_interrupted(&m->job)) return PLEUEL_INTERRUPTED;
    if (!pl_raster_pixels(d, (pl_theme)o->style, i, pixels))
      return pl_fail(&m->job, PLEUEL_NO_MEMORY, "the picture could not be drawn");
    if (o->frame(o->user, pixels, w, h) != 0) return PLEUEL_INTERRUPTED;
  }
  return PLEUEL_OK;
}

static pleuel_status write_gif(pleuel_model* m, const pl_drawing* d, const pl_film* f,
                               const pleuel_animate_options* o, const char** bytes, size_t* size) {
  int w = (int)d->width, h = (int)d->height;
  uint32_t* pixels = PL_ARRAY(m->work, uint32_t, (size_t)w * (size_t)h);
  uint32_t* count = PL_ARRAY(m->work, uint32_t, PL_GIF_BINS);
  int stride = f->n > 8 ? f->n / 8 : 1;
  for (int i = 0; i < f->n; i += stride) {
    if (!pl_raster_pixels(d, (pl_theme)o->style, i, pixels))
      return pl_fail(&m->job, PLEUEL_NO_MEMORY, "the picture could not be drawn");
    pl_gif_count(count, pixels, (size_t)w * (size_t)h);
  }
  pl_gif* gif = pl_gif_make(m->work, w, h, (int)fmax(2, lround(100 * f->seconds / f->n)), count);
  for (int i = 0; i < f->n; i++) {
    if (pl_interrupted(&m->job)) return PLEUEL_INTERRUPTED;
    if (!pl_raster_pixels(d, (pl_theme)o->style, i, pixels))
      return pl_fail(&m->job, PLEUEL_NO_MEMORY, "the picture could not be drawn");
    pl_gif_frame(gif, pixels);
  }
  *bytes = pl_gif_end(gif, size);
  return PLEUEL_OK;
}

pleuel_status pl_picture_animate(pleuel_model* m, pl_language lang, const pleuel_animate_options* o,
                                 const char** bytes, size_t* size) {
  if (o->frame || o->format == PLEUEL_GIF) PL_TRY(need_cairo(m));
  PL_TRY(pl_pipeline_check(m));
  if (!o->has_until && !m->model->simulate.given) {
    return pl_fail(
        &m->job, PLEUEL_USAGE,
        "how long? The file has no `simulate` line; give --until, for example --until 10");
  }
  pl_showing show = {0};
  double seconds = o->seconds > 0 ? o->seconds : longest, fps = o->fps > 0 ? o->fps : FRAMES_PER_S;
  pleuel_status s = look(m, lang, o->has_until, o->until,
                         (int)fmin(MOST_FRAMES, fmax(2, seconds * fps)), &show);
  if (!show.scene) return s;
  if (show.scene->n_shapes == 0)
    return pl_fail(&m->job, PLEUEL_UNSUPPORTED,
                   "there is nothing to animate: nothing that has a place");
  if (show.scene->n_frames < 2)
    return s != PLEUEL_OK ? s
                          : pl_fail(&m->job, PLEUEL_USAGE,
                                    "there is nothing to animate: the motion ends where it begins");
  pl_film film = film_of(show.scene, o);
  int best;
  pl_drawing* d = draw_film(m, lang, &show, &film, o, &best);
  if (o->frame) PL_TRY(hand_frames(m, d, &film, o));
  else if (o->format == PLEUEL_GIF) PL_TRY(write_gif(m, d, &film, o, bytes, size));
  else {
    pl_text out = pl_text_make(m->work);
    pl_svg_animate(&out, d, (pl_theme)o->style, film.n, film.seconds, best);
    *bytes = pl_text_string(&out);
    *size = out.n;
  }
  return s;
}
