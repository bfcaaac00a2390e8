// The system as a TikZ picture: the frame of the scene that tells most, in millimetres.
#include "tex_impl.h"

#include <math.h>

// Size of the picture, and of what has a size of its own.  mm
static const double wide = 90, high = 62, mass = 1.5, pivot = 0.8, tick = 1.6, coil = 1.6;
enum { PL_TEX_COILS = 8, PL_TEX_POINTS = 120, PL_TEX_LABELS = 40 };

// where a label stands: its middle  mm
typedef struct pl_patch {
  double x, y, half_width;
} pl_patch;

typedef struct pl_canvas {
  pl_tex_page* g;
  const pl_scene* scene;
  double scale, x0, y0;  // mm a metre, and the metre that lies at the origin
  int n_labels;
  pl_patch labels[PL_TEX_LABELS];
} pl_canvas;

typedef struct pl_spot {
  double x, y;
  bool there;
} pl_spot;  // mm

static pl_spot spot(const pl_canvas* c, const pl_shape* s, int i) {
  const float* xy = s->xy
                    + 2 * ((s->moves ? (size_t)c->scene->best * (size_t)s->n : 0) + (size_t)i);
  double x = (double)xy[0], y = (double)xy[1];
  return (pl_spot){(x - c->x0) * c->scale, (y - c->y0) * c->scale, isfinite(x) && isfinite(y)};
}

static const char* at(const pl_canvas* c, pl_spot p) {
  return pl_format(c->g->arena, "(%.2f,%.2f)", p.x, p.y);
}

// A path through the points that are there, at most PL_TEX_POINTS of them.
static void path(const pl_canvas* c, const pl_shape* s, const char* how, const char* end) {
  int step = s->n > PL_TEX_POINTS ? (s->n + PL_TEX_POINTS - 1) / PL_TEX_POINTS : 1;
  bool open = false;
  for (int i = 0; i < s->n; i = i == s->n - 1 ? s->n : i + step < s->n ? i + step : s->n - 1) {
    pl_spot p = spot(c, s, i);
    if (!p.there && open) pl_text_add(c->g->out, ";\n");
    if (p.there && !open) pl_text_addf(c->g->out, "  \\draw[%s] %s", how, at(c, p));
    if (p.there && open) pl_text_addf(c->g->out, " -- %s", at(c, p));
    open = p.there;
  }
  if (open) pl_text_addf(c->g->out, "%s;\n", end);
}

// Places around a point, the best first.
static const struct {
  const char* anchor;
  double x, y;
} places[] = {
    {"above right", 1, 1}, {"right", 1, 0},        {"below right", 1, -1}, {"above left", -1, 1},
    {"left", -1, 0},       {"below left", -1, -1}, {"above", 0, 1},        {"below", 0, -1},
};
static const double label_gap = 2.6, line_height = 4.2, letter_width = 1.6;  // mm

static bool is_free(const pl_canvas* c, pl_patch p) {
  for (int i = 0; i < c->n_labels; i++) {
    const pl_patch* q = &c->labels[i];
    if (fabs(p.x - q->x) < p.half_width + q->half_width && fabs(p.y - q->y) < line_height)
      return false;
  }
  return true;
}

// A label beside a point where no other stands; left out when there is no room at all.
static void label(pl_canvas* c, const pl_shape* s, pl_spot p) {
  if (!s->label || !*s->label || !p.there || c->n_labels == PL_TEX_LABELS) return;
  const pl_form* name = pl_form_name(c->g->arena, s->label, pl_poison());
  double half = letter_width * (pl_tex_width(c->g, name) + 0.5) / 2;
  for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
    pl_patch here = {p.x + places[k].x * (label_gap + half), p.y + places[k].y * label_gap, half};
    if (!is_free(c, here)) continue;
    c->labels[c->n_labels++] = here;
    pl_text_addf(c->g->out, "  \\node[%s] at %s {$%s$};\n", places[k].anchor, at(c, p),
                 pl_tex_math(c->g, name));
    return;
  }
}

// Short strokes on the side where the material is.
static void hatch(const pl_canvas* c, const pl_shape* s) {
  double since = 3;  // mm along the curve
  for (int i = 0; i + 1 < s->n; i++) {
    pl_spot a = spot(c, s, i), b = spot(c, s, i + 1);
    double length = hypot(b.x - a.x, b.y - a.y);
    if (!a.there || !b.there || length < 1e-9) continue;
    double ux = (b.x - a.x) / length, uy = (b.y - a.y) / length;
    for (double along = 3 - since; along < length; along += 3) {
      double x = a.x + along * ux, y = a.y + along * uy;
      double nx = s->side >= 0 ? -uy : uy, ny = s->side >= 0 ? ux : -ux;
      pl_text_addf(c->g->out, "  \\draw[very thin] (%.2f,%.2f) -- (%.2f,%.2f);\n", x, y,
                   x + tick * (nx - ux), y + tick * (ny - uy));
    }
    since = fmod(since + length, 3);
  }
}

static void spring(const pl_canvas* c, const pl_shape* s) {
  pl_spot a = spot(c, s, 0), b = spot(c, s, 1);
  double length = hypot(b.x - a.x, b.y - a.y);
  if (!a.there || !b.there || length < 1e-9) return;
  double ux = (b.x - a.x) / length, uy = (b.y - a.y) / length;
  pl_text_addf(c->g->out, "  \\draw %s", at(c, a));
  for (int i = 0; i <= 2 * PL_TEX_COILS; i++) {
    double along = length * (0.12 + 0.76 * i / (2.0 * PL_TEX_COILS));
    double off = i == 0 || i == 2 * PL_TEX_COILS ? 0 : i % 2 ? coil : -coil;
    pl_text_addf(c->g->out, " -- (%.2f,%.2f)", a.x + along * ux - off * uy,
                 a.y + along * uy + off * ux);
  }
  pl_text_addf(c->g->out, " -- %s;\n", at(c, b));
}

static void damper(const pl_canvas* c, const pl_shape* s) {
  pl_spot a = spot(c, s, 0), b = spot(c, s, 1);
  double length = hypot(b.x - a.x, b.y - a.y);
  if (!a.there || !b.there || length < 1e-9) return;
  double ux = (b.x - a.x) / length, uy = (b.y - a.y) / length;
#define AT(f, off) a.x + (f)*length *ux - (off)*uy, a.y + (f)*length *uy + (off)*ux
  pl_text_addf(
      c->g->out,
      "  \\draw %s -- (%.2f,%.2f) (%.2f,%.2f) -- (%.2f,%.2f) -- (%.2f,%.2f) -- (%.2f,%.2f)",
      at(c, a), AT(0.4, 0), AT(0.65, coil), AT(0.4, coil), AT(0.4, -coil), AT(0.65, -coil));
  pl_text_addf(c->g->out, " (%.2f,%.2f) -- (%.2f,%.2f) (%.2f,%.2f) -- %s;\n", AT(0.55, 0.8 * coil),
               AT(0.55, -0.8 * coil), AT(0.55, 0), at(c, b));
#undef AT
}

static void arrow(pl_canvas* c, const pl_shape* s, const char* how) {
  pl_spot a = spot(c, s, 0), b = spot(c, s, 1);
  if (!a.there || !b.there || hypot(b.x - a.x, b.y - a.y) < 0.5) return;
  path(c, s, how, "");
  label(c, s, b);
}

// The path so far; one that fills the picture tells nothing.
static void trail(const pl_canvas* c, const pl_shape* s) {
  pl_shape part = *s;
  part.n = s->n < c->scene->best + 1 ? s->n : c->scene->best + 1;
  double length = 0;
  for (int i = 0; i + 1 < part.n; i++) {
    pl_spot a = spot(c, s, i), b = spot(c, s, i + 1);
    if (a.there && b.there) length += hypot(b.x - a.x, b.y - a.y);
  }
  if (length < 3 * (wide + high)) path(c, &part, "densely dotted,black!60", "");
}

static void shape(pl_canvas* c, const pl_shape* s) {
  switch (s->kind) {
    case PL_SHAPE_MASS:
      if (spot(c, s, 0).there)
        pl_text_addf(c->g->out, "  \\fill %s circle (%.2f);\n", at(c, spot(c, s, 0)), mass);
      label(c, s, spot(c, s, 0));
      break;
    case PL_SHAPE_POINT:
      if (spot(c, s, 0).there)
        pl_text_addf(c->g->out, "  \\draw[fill=white] %s circle (%.2f);\n", at(c, spot(c, s, 0)),
                     pivot);
      label(c, s, spot(c, s, 0));
      break;
    case PL_SHAPE_BODY: path(c, s, "thick,fill=black!10", " -- cycle"); break;
    case PL_SHAPE_ROD: path(c, s, "very thick", ""); break;
    case PL_SHAPE_ROPE: path(c, s, "thin", ""); break;
    case PL_SHAPE_SPRING: spring(c, s); break;
    case PL_SHAPE_DAMPER: damper(c, s); break;
    case PL_SHAPE_CURVE: path(c, s, "thick,black!55", ""); break;
    case PL_SHAPE_GROUND:
      path(c, s, "thick", "");
      hatch(c, s);
      break;
    case PL_SHAPE_AXIS: arrow(c, s, "->,black!60"); break;
    case PL_SHAPE_ANGLE:
      path(c, s, "thin", "");
      label(c, s, spot(c, s, s->n / 2));
      break;
    case PL_SHAPE_FORCE: arrow(c, s, "->,thick,orange!80!black"); break;
    case PL_SHAPE_VELOCITY: arrow(c, s, "->,thick,blue!70!black"); break;
    case PL_SHAPE_TRAIL: trail(c, s); break;
  }
}

// Behind first, in front last.
static const pl_shape_kind order[] = {
    PL_SHAPE_AXIS,   PL_SHAPE_CURVE,  PL_SHAPE_GROUND,   PL_SHAPE_TRAIL, PL_SHAPE_ROPE,
    PL_SHAPE_SPRING, PL_SHAPE_DAMPER, PL_SHAPE_BODY,     PL_SHAPE_ROD,   PL_SHAPE_ANGLE,
    PL_SHAPE_POINT,  PL_SHAPE_MASS,   PL_SHAPE_VELOCITY, PL_SHAPE_FORCE,
};

void pl_tex_figure(pl_tex_page* g, const pl_scene* scene) {
  double x0 = (double)scene->box[0], y0 = (double)scene->box[1];
  double width = (double)scene->box[2] - x0, height = (double)scene->box[3] - y0;
  if (scene->n_shapes == 0 || !(width > 0 || height > 0)) return;
  double scale = fmin(width > 0 ? wide / width : HUGE_VAL, height > 0 ? high / height : HUGE_VAL);
  pl_canvas c = {.g = g, .scene = scene, .scale = scale, .x0 = x0, .y0 = y0};
  pl_text_add(g->out,
              "\\ifcsname "
              "tikzpicture\\endcsname\n\\begin{center}\n\\begin{tikzpicture}[x=1mm,y=1mm,>=latex,"
              "font=\\small]\n");
  for (size_t k = 0; k < sizeof order / sizeof *order; k++) {
    for (int i = 0; i < scene->n_shapes; i++) {
      const pl_shape* s = &scene->shapes[i];
      if (s->kind == order[k] && s->shown && s->n > 0) shape(&c, s);
    }
  }
  pl_text_add(g->out, "\\end{tikzpicture}\n\\end{center}\n\\fi\n");
}
