// Drawings, plots and animations of a model: the motion as it is looked at (views.c), the scene made from it, and the
// file that was asked for.
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

// ---------------------------------------------------------------------------------------------- motion and scene
// Runs with another end, or with one where the file has none.
static pleuel_status run_until(pleuel_model* m, pl_language lang, bool has_until, double until, pl_views* views) {
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
  bool even = m->model->simulate.given && pl_is_poison(m->model->simulate.step) && m->model->simulate.count == 0;
  int n = pl_model_flat_coords(m->model, m->arena).n;
  if (even) m->model->simulate.count = n < 40 ? 2880 : n < 400 ? 960 : 240;
  m->is_recorded = false;
  pleuel_status s = pl_views_make(m, lang, views);
  if (has_until || even) {
    m->model->simulate = before;
    m->is_recorded = false;
  }
  return s;
}

// Motion and scene.  A model without `simulate` is drawn at its start; a motion that ends early as far as it goes.
static pleuel_status look(pleuel_model* m, pl_language lang, bool has_until, double until, int frames, pl_showing* out) {
  PL_TRY(pl_pipeline_check(m));
  if (has_until && !isfinite(until)) return pl_fail(&m->job, PLEUEL_USAGE, "the end of the run is no number");
  pleuel_status s = run_until(m, lang, has_until, until, &out->views);
  bool asked = has_until || m->model->simulate.given;
  if (s == PLEUEL_INTERRUPTED || s == PLEUEL_NO_MEMORY || (asked && !out->views.result)) return s;
  pl_scene_options how = {.frames = frames, .forces = true, .velocities = true};
  pleuel_status drawn = pl_scene_make(&m->job, m->model, out->views.result, &how, &out->scene);
  return drawn != PLEUEL_OK ? drawn : s;
}

pl_scene* pl_picture_scene(pleuel_model* m, pl_language lang) {
  enum { FRAMES = 60 };
  pl_showing show = {0};
  char sentence[sizeof m->job.message];
  memcpy(sentence, m->job.message, sizeof sentence);
  look(m, lang, false, 0, FRAMES, &show);
  memcpy(m->job.message, sentence, sizeof sentence);
  return show.scene;
}

// ---------------------------------------------------------------------------------------------- panels
static const double* column_of(pl_arena* a, const pl_result* r, int column) {
  double* x = PL_ARRAY(a, double, r->rows.n + 1);
  for (int i = 0; i < r->rows.n; i++) x[i] = r->rows.at[i][column];
  return x;
}

static const char* event_label(pl_arena* a, const pl_result_event* e, pl_language lang) {
  const char* label = e->label ? e->label : "";
  switch (e->kind) {
    case PL_EV_RELEASE: return pl_format(a, lang == PL_GERMAN ? "%s löst sich" : "%s lets go", label);
    case PL_EV_IMPACT: return pl_format(a, lang == PL_GERMAN ? "Stoß auf %s" : "impact on %s", label);
    case PL_EV_CONTACT: return pl_format(a, lang == PL_GERMAN ? "Kontakt mit %s" : "contact with %s", label);
    default: return label;
  }
}

enum { MOST_MARKS = 12 };

static void make_marks(pleuel_model* m, pl_language lang, const pl_result* r, pl_plot_panel* p) {
  pl_plot_mark* mark = PL_ARRAY(m->arena, pl_plot_mark, MOST_MARKS);
  for (int i = 0; i < r->events.n && p->n_marks < MOST_MARKS; i++) {
    mark[p->n_marks++] = (pl_plot_mark){r->events.at[i].t, event_label(m->arena, &r->events.at[i], lang)};
  }
  p->marks = mark;
}

static void make_panels(pleuel_model* m, pl_language lang, pl_showing* show) {
  const pl_views* v = &show->views;
  show->panels = PL_ARRAY(m->arena, pl_plot_panel, v->plots.n + 1);
  for (int i = 0; v->result && i < v->plots.n; i++) {
    const pl_html_plot* from = &v->plots.at[i];
    if (from->title && m->model->plots.n > 0) continue;         // what the model asks for is enough
    pl_plot_panel* p = &show->panels[show->n_panels++];
    pl_curve_data* curve = PL_ARRAY(m->arena, pl_curve_data, from->n_curves + 1);
    const double* x = column_of(m->arena, v->result, from->x_column);
    for (int k = 0; k < from->n_curves; k++) {
      const pl_html_curve* c = &from->curves[k];
      curve[k] = (pl_curve_data){c->name, c->unit, v->result->rows.n, x, column_of(m->arena, v->result, c->column)};
    }
    *p = (pl_plot_panel){.title = from->title, .x_name = from->x_name ? from->x_name : "t", .n_curves = from->n_curves, .curves = curve};
    p->x_unit = from->x_name ? from->x_unit : m->model->uses_units ? "s" : "";
    if (!from->x_name) make_marks(m, lang, v->result, p);
  }
}

// ---------------------------------------------------------------------------------------------- the page
static const double cell_width = 440, cell_height = 320, head = 34;

static void draw_panels(pl_drawing* d, pleuel_model* m, pl_language lang, const pl_showing* show, bool drawing, const pl_scene_style* style) {
  int n = show->n_panels + drawing, columns = n > 1 ? 2 : 1, rows = (n + columns - 1) / columns;
  double top = m->model->title ? head : 0, w = d->width / columns, h = (d->height - top) / rows;
  if (m->model->title) pl_draw_text(d, PL_INK_TEXT, 16, PL_ANCHOR_START, 16, 24, m->model->title);
  for (int i = 0; i < n; i++) {
    pl_frame_rect r = {w * (i % columns), top + h * (i / columns), w, h};
    if (drawing && i == 0) pl_draw_scene(d, show->scene, show->scene->best, r, style);
    else pl_draw_plot(d, &show->panels[i - drawing], r, lang);
  }
}

pleuel_status pl_picture_plot(pleuel_model* m, pl_language lang, const pleuel_plot_options* o, const char** bytes, size_t* size) {
  pl_showing show = {0};
  pleuel_status s = look(m, lang, o->has_until, o->until, 720, &show);
  if (!show.scene) return s;
  make_panels(m, lang, &show);
  bool drawing = o->panels != PLEUEL_PANELS_PLOTS && show.scene->n_shapes > 0;
  if (o->panels == PLEUEL_PANELS_DRAWING) show.n_panels = 0;
  int n = show.n_panels + drawing, columns = n > 1 ? 2 : 1;
  if (n == 0) return pl_fail(&m->job, PLEUEL_UNSUPPORTED, "there is nothing to draw: no motion (`simulate`, or --until) and nothing that has a place");
  double top = m->model->title ? head : 0;
  double width = o->width > 0 ? o->width : n == 1 ? 560 : columns * cell_width;
  double height = o->height > 0 ? o->height : n == 1 ? 420 + top : cell_height * ((n + 1) / 2) + top;
  pl_drawing* d = pl_drawing_make(m->arena, width, height);
  d->title = show.scene->description[lang];
  pl_scene_style style = {.lang = lang, .forces = !o->no_forces, .trails = true, .labels = true};
  draw_panels(d, m, lang, &show, drawing, &style);
  pl_text out = pl_text_make(m->arena);
  pl_svg_style svg = {.theme = (pl_theme)o->style};
  pl_svg_write(&out, d, &svg);
  *bytes = pl_text_string(&out);
  *size = out.n;
  return s;
}
