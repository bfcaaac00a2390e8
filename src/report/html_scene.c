// The picture of the model in the page: the frame that tells most, drawn here, so that it is there
// without a script and on paper; and what moves, as numbers for the script.
//
// Points are given to the script in pixels of the picture, as 16-bit integers in units of 1/32
// pixel: half the size of floats, and finer than anybody sees.
#include "html_impl.h"

#include <math.h>
#include <string.h>

enum {
  PL_HTML_WIDE = 520,
  PL_HTML_LOWEST = 240,
  PL_HTML_HIGHEST = 440,  // the picture, pixels
  PL_HTML_EDGE = 34,      // around it, for labels
  PL_HTML_FOOT = 26,      // below it, for the scale
  PL_HTML_STEPS = 32      // of a pixel
};

// pixels per metre; place of the origin
typedef struct pl_frame_of {
  double scale, x0, y0;
  int height;
  bool scaled;
} pl_frame_of;

static bool finite_box(const pl_scene* s) {
  for (int i = 0; i < 4; i++)
    if (!isfinite(s->box[i])) return false;
  return true;
}

static bool shows_kind(const pl_scene* s, pl_shape_kind kind) {
  for (int i = 0; i < s->n_shapes; i++)
    if (s->shapes[i].kind == kind && s->shapes[i].shown) return true;
  return false;
}

static bool has_kind(const pl_scene* s, pl_shape_kind kind) {
  for (int i = 0; i < s->n_shapes; i++)
    if (s->shapes[i].kind == kind) return true;
  return false;
}

// Fits the box into the width; a tall one is fitted into the height.
static pl_frame_of fit(const pl_scene* s) {
  double w = (double)(s->box[2] - s->box[0]), h = (double)(s->box[3] - s->box[1]);
  double room_w = PL_HTML_WIDE - 2 * PL_HTML_EDGE, room_h = PL_HTML_HIGHEST - 2 * PL_HTML_EDGE;
  bool scaled = has_kind(s, PL_SHAPE_FORCE) || has_kind(s, PL_SHAPE_VELOCITY);
  pl_frame_of f = {.scaled = scaled};
  f.scale = fmin(w > 0 ? room_w / w : (double)INFINITY, h > 0 ? room_h / h : (double)INFINITY);
  if (!isfinite(f.scale)) f.scale = 100;
  f.height = (int)ceil(h * f.scale) + 2 * PL_HTML_EDGE;
  if (f.height < PL_HTML_LOWEST) f.height = PL_HTML_LOWEST;
  f.x0 = PL_HTML_WIDE / 2.0 - f.scale * ((double)s->box[0] + (double)s->box[2]) / 2;
  f.y0 = f.height / 2.0 + f.scale * ((double)s->box[1] + (double)s->box[3]) / 2;
  if (scaled) f.height += PL_HTML_FOOT;
  return f;
}

static double px(const pl_frame_of* f, float x) { return f->x0 + f->scale * (double)x; }
static double py(const pl_frame_of* f, float y) { return f->y0 - f->scale * (double)y; }

// The frame shown first: shortly before the first event, when everything still acts; else a little
// after the start.
static int opening(const pl_scene* s) {
  if (s->n_frames < 2) return 0;
  double t0 = s->t[0], t1 = s->t[s->n_frames - 1], t = t0 + 0.12 * (t1 - t0);
  for (int i = s->n_marks - 1; i >= 0; i--)
    if (s->marks[i].t > t0 + 0.02 * (t1 - t0)) t = t0 + 0.8 * (s->marks[i].t - t0);
  int best = 0;
  for (int i = 1; i < s->n_frames; i++)
    if (fabs(s->t[i] - t) < fabs(s->t[best] - t)) best = i;
  return best;
}

static const float* points(const pl_html* h, const pl_shape* p) {
  return p->xy + (p->moves ? (size_t)opening(h->in->scene) * (size_t)p->n * 2 : 0);
}

static bool is_there(const float* xy, int n) {
  for (int i = 0; i < 2 * n; i++)
    if (!isfinite(xy[i])) return false;
  return n > 0;
}

// ------------------------------------------------------------------------------------------ shapes
static const char* const class_of[] = {
    [PL_SHAPE_MASS] = "mass",         [PL_SHAPE_POINT] = "point", [PL_SHAPE_BODY] = "body",
    [PL_SHAPE_ROD] = "rod",           [PL_SHAPE_ROPE] = "rope",   [PL_SHAPE_SPRING] = "spring",
    [PL_SHAPE_DAMPER] = "damper",     [PL_SHAPE_CURVE] = "curve", [PL_SHAPE_GROUND] = "ground",
    [PL_SHAPE_AXIS] = "axis",         [PL_SHAPE_ANGLE] = "angle", [PL_SHAPE_FORCE] = "force",
    [PL_SHAPE_VELOCITY] = "velocity", [PL_SHAPE_TRAIL] = "trail"};

static void add_line(pl_text* d, const pl_frame_of* f, const float* xy, int n) {
  bool open = false;
  for (int i = 0; i < n; i++) {
    bool there = isfinite(xy[2 * i]) && isfinite(xy[2 * i + 1]);
    if (there)
      pl_text_addf(d, "%s%.1f %.1f", open ? "L" : "M", px(f, xy[2 * i]), py(f, xy[2 * i + 1]));
    open = there;
  }
}

// A coil between two points: straight ends, eight turns.                     ORDER COIL (report.js)
static void add_coil(pl_text* d, double x, double y, double x2, double y2) {
  double l = hypot(x2 - x, y2 - y), ux = l > 0 ? (x2 - x) / l : 1, uy = l > 0 ? (y2 - y) / l : 0;
  double end = fmin(12, l / 5), step = (l - 2 * end) / 16;
  pl_text_addf(d, "M%.1f %.1fL%.1f %.1f", x, y, x + ux * end, y + uy * end);
  for (int i = 1; i < 16; i += 2) {
    double side = i % 4 == 1 ? 7 : -7, a = end + i * step;
    pl_text_addf(d, "L%.1f %.1f", x + ux * a - uy * side, y + uy * a + ux * side);
  }
  pl_text_addf(d, "L%.1f %.1fL%.1f %.1f", x2 - ux * end, y2 - uy * end, x2, y2);
}

// Piston and cylinder.                                                     ORDER DAMPER (report.js)
static void add_damper(pl_text* d, double x, double y, double x2, double y2) {
  double l = hypot(x2 - x, y2 - y), ux = l > 0 ? (x2 - x) / l : 1, uy = l > 0 ? (y2 - y) / l : 0;
  double m = l / 2, a = fmin(10, l / 4);
  pl_text_addf(d, "M%.1f %.1fL%.1f %.1f", x, y, x + ux * m, y + uy * m);
  pl_text_addf(d, "M%.1f %.1fL%.1f %.1f", x + ux * m - uy * 6, y + uy * m + ux * 6,
               x + ux * m + uy * 6, y + uy * m - ux * 6);
  pl_text_addf(d, "M%.1f %.1fL%.1f %.1fL%.1f %.1fL%.1f %.1f", x + ux * (m - a) - uy * 9,
               y + uy * (m - a) + ux * 9, x + ux * (m + a) - uy * 9, y + uy * (m + a) + ux * 9,
               x + ux * (m + a) + uy * 9, y + uy * (m + a) - ux * 9, x + ux * (m - a) + uy * 9,
               y + uy * (m - a) - ux * 9);
  pl_text_addf(d, "M%.1f %.1fL%.1f %.1f", x + ux * (m + a), y + uy * (m + a), x2, y2);
}

// An arrow with its head; too short ones are left out.                      ORDER ARROW (report.js)
static void add_arrow(pl_text* d, double x, double y, double x2, double y2) {
  double l = hypot(x2 - x, y2 - y);
  if (l < 3) return;
  double ux = (x2 - x) / l, uy = (y2 - y) / l, a = fmin(9, l * 0.6), b = a * 0.45;
  pl_text_addf(d, "M%.1f %.1fL%.1f %.1fM%.1f %.1fL%.1f %.1fL%.1f %.1fZ", x, y, x2 - ux * a,
               y2 - uy * a, x2, y2, x2 - ux * a - uy * b, y2 - uy * a + ux * b,
               x2 - ux * a + uy * b, y2 - uy * a - ux * b);
}

// Short strokes on the side where the material is.
static const char* hatching(pl_html* h, const pl_frame_of* f, const pl_shape* p, const float* xy) {
  pl_text d = pl_text_make(h->arena);
  double next = 5, walked = 0, side = p->side < 0 ? -1 : 1;
  for (int i = 1; i < p->n; i++) {
    if (!is_there(xy + 2 * (i - 1), 2)) continue;
    double x = px(f, xy[2 * i - 2]), y = py(f, xy[2 * i - 1]), dx = px(f, xy[2 * i]) - x,
           dy = py(f, xy[2 * i + 1]) - y, l = hypot(dx, dy);
    while (l > 0 && next <= walked + l) {
      // to the left of the line, y downwards
      double u = (next - walked) / l, nx = side * dy / l, ny = -side * dx / l;
      double ax = x + u * dx, ay = y + u * dy;
      pl_text_addf(&d, "M%.1f %.1fl%.1f %.1f", ax, ay, 7 * nx - 4 * dx / l, 7 * ny - 4 * dy / l);
      next += 9;
    }
    walked += l;
  }
  return pl_text_string(&d);
}

static const char* outline(pl_html* h, const pl_frame_of* f, const pl_shape* p, const float* xy,
                           int best) {
  pl_text d = pl_text_make(h->arena);
  bool two = p->n == 2 && is_there(xy, 2);
  double x = two ? px(f, xy[0]) : 0, y = two ? py(f, xy[1]) : 0, x2 = two ? px(f, xy[2]) : 0,
         y2 = two ? py(f, xy[3]) : 0;
  switch (p->kind) {
    case PL_SHAPE_SPRING:
      if (two) add_coil(&d, x, y, x2, y2);
      break;
    case PL_SHAPE_DAMPER:
      if (two) add_damper(&d, x, y, x2, y2);
      break;
    case PL_SHAPE_AXIS:
    case PL_SHAPE_FORCE:
    case PL_SHAPE_VELOCITY:
      if (two) add_arrow(&d, x, y, x2, y2);
      break;
    case PL_SHAPE_BODY:
      add_line(&d, f, xy, p->n);
      if (d.n) pl_text_add(&d, "Z");
      break;
    case PL_SHAPE_TRAIL: add_line(&d, f, xy, best < p->n ? best + 1 : p->n); break;
    default: add_line(&d, f, xy, p->n);
  }
  return pl_text_string(&d);
}

// Trails do not move, they grow.
static bool lives(const pl_shape* p) { return p->moves || p->kind == PL_SHAPE_TRAIL; }

static void put_shape(pl_html* h, const pl_scene* s, const pl_frame_of* f, int i) {
  const pl_shape* p = &s->shapes[i];
  const float* xy = points(h, p);
  bool dot = p->kind == PL_SHAPE_MASS || p->kind == PL_SHAPE_POINT;
  const char* weight = p->kind == PL_SHAPE_FORCE && strcmp(p->of, "weight") == 0 ? " weight" : "";
  pl_html_rawf(h, "<g class=\"%s%s\"", class_of[p->kind], weight);
  if (lives(p)) pl_html_rawf(h, " data-i=\"%d\"", i);
  if (!p->shown) pl_html_raw(h, " data-off=\"1\" style=\"display:none\"");
  pl_html_raw(h, ">");
  if (dot && is_there(xy, 1)) {
    pl_html_rawf(h, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%s\"/>", px(f, xy[0]), py(f, xy[1]),
                 p->kind == PL_SHAPE_MASS ? "7" : "3.5");
  } else if (dot) {
    pl_html_rawf(h, "<circle r=\"%s\"/>", p->kind == PL_SHAPE_MASS ? "7" : "3.5");
  } else {
    pl_html_rawf(h, "<path d=\"%s\"/>", outline(h, f, p, xy, opening(s)));
    if (p->kind == PL_SHAPE_GROUND)
      pl_html_rawf(h, "<path class=\"hatch\" d=\"%s\"/>", hatching(h, f, p, xy));
  }
  pl_html_raw(h, "</g>\n");
}

// ------------------------------------------------------------------------------------------ labels
typedef struct pl_html_box {
  double x, y, w, h;
} pl_html_box;
typedef PL_VEC(pl_html_box) pl_html_boxes;

static bool overlap(const pl_html_box* a, const pl_html_box* b) {
  return a->x < b->x + b->w && b->x < a->x + a->w && a->y < b->y + b->h && b->y < a->y + a->h;
}

// How bad a place is: on another label, on a mass, on a line.
static double cost(const pl_html_boxes* taken, const pl_html_boxes* lines, const pl_html_box* b) {
  double sum = 0;
  for (int i = 0; i < taken->n; i++)
    if (overlap(&taken->at[i], b)) sum += 20;
  for (int i = 0; i < lines->n; i++)
    if (overlap(&lines->at[i], b)) sum += 1;
  return sum;
}

// Small boxes along what is drawn as a line.
static void add_line_boxes(pl_html* h, const pl_frame_of* f, const pl_shape* p, const float* xy,
                           pl_html_boxes* lines) {
  if (p->kind == PL_SHAPE_MASS || p->kind == PL_SHAPE_POINT || p->kind == PL_SHAPE_TRAIL
      || !p->shown)
    return;
  for (int i = 1; i < p->n; i++) {
    if (!is_there(xy + 2 * (i - 1), 2)) continue;
    double x = px(f, xy[2 * i - 2]), y = py(f, xy[2 * i - 1]), dx = px(f, xy[2 * i]) - x,
           dy = py(f, xy[2 * i + 1]) - y;
    int n = (int)(hypot(dx, dy) / 9) + 1;
    for (int k = 0; k <= n; k++)
      pl_push(h->arena, *lines, (pl_html_box){x + dx * k / n - 2, y + dy * k / n - 2, 4, 4});
  }
}

// Where a label is anchored: beyond the tip of arrows and axes, beside everything else.
static bool anchor(const pl_frame_of* f, const pl_shape* p, const float* xy, double* x, double* y,
                   double* ux, double* uy) {
  bool arrow = p->kind == PL_SHAPE_AXIS || p->kind == PL_SHAPE_FORCE
               || p->kind == PL_SHAPE_VELOCITY;
  int k = arrow && p->n >= 2 ? 1 : p->n / 2;
  if (p->n < 1 || !is_there(xy + 2 * k, 1)) return false;
  *x = px(f, xy[2 * k]);
  *y = py(f, xy[2 * k + 1]);
  *ux = *uy = 0;
  if (!arrow || !is_there(xy, 1)) return true;
  double dx = *x - px(f, xy[0]), dy = *y - py(f, xy[1]), l = hypot(dx, dy);
  if (l < 9 && p->kind != PL_SHAPE_AXIS) return false;
  *ux = l > 0 ? dx / l : 0;
  *uy = l > 0 ? dy / l : 0;
  return true;
}

// Eight places around a point, or those beyond a tip, nearest first.       ORDER PLACES (report.js)
static pl_html_box place(const pl_html_boxes* taken, const pl_html_boxes* lines,
                         const pl_frame_of* f, double x, double y, double ux, double uy, double w) {
  static const double dir[8][2] = {{0.9, -0.7}, {0.9, 0.8}, {-0.9, -0.7}, {-0.9, 0.8},
                                   {0, -1},     {0, 1},     {1, 0},       {-1, 0}};
  pl_html_box best = {0};
  double least = INFINITY;
  for (int i = 0; i < 16; i++) {
    double far = i < 8 ? 1 : 1.9;
    bool tip = i == 0 && (ux != 0 || uy != 0);
    double dx = tip ? ux : dir[i % 8][0] * far, dy = tip ? uy : dir[i % 8][1] * far;
    pl_html_box b = {x + dx * (w / 2 + 11) - w / 2, y + dy * 17 - 8, w, 16};
    if (b.x < 2) b.x = 2;
    if (b.x + w > PL_HTML_WIDE - 2) b.x = PL_HTML_WIDE - 2 - w;
    if (b.y < 2) b.y = 2;
    if (b.y + 16 > f->height - 2) b.y = f->height - 18;
    double c = cost(taken, lines, &b) + 0.4 * i;
    if (c < least) {
      best = b;
      least = c;
    }
  }
  return best;
}

static void put_labels(pl_html* h, const pl_scene* s, const pl_frame_of* f) {
  pl_html_boxes taken = {0}, lines = {0};
  for (int i = 0; i < s->n_shapes; i++) {
    add_line_boxes(h, f, &s->shapes[i], points(h, &s->shapes[i]), &lines);
    if (s->shapes[i].kind != PL_SHAPE_MASS) continue;
    const float* xy = points(h, &s->shapes[i]);
    if (is_there(xy, 1))
      pl_push(h->arena, taken, (pl_html_box){px(f, xy[0]) - 8, py(f, xy[1]) - 8, 16, 16});
  }
  for (int i = 0; i < s->n_shapes; i++) {
    const pl_shape* p = &s->shapes[i];
    if (!p->label || !*p->label) continue;
    double x, y, ux, uy, w = 8.2 * pl_utf8_width(p->label) + 2;
    bool there = anchor(f, p, points(h, p), &x, &y, &ux, &uy);
    pl_html_box b = there ? place(&taken, &lines, f, x, y, ux, uy, w) : (pl_html_box){0};
    if (there && p->shown) pl_push(h->arena, taken, b);
    pl_html_rawf(h, "<text class=\"%s%s\" data-l=\"%d\" x=\"%.1f\" y=\"%.1f\"%s>",
                 class_of[p->kind],
                 p->kind == PL_SHAPE_FORCE && strcmp(p->of, "weight") == 0 ? " weight" : "", i, b.x,
                 b.y + 13, there && p->shown ? "" : " style=\"display:none\"");
    pl_html_text(h, p->label);
    pl_html_raw(h, "</text>\n");
  }
}

// ------------------------------------------------------------------------------------------- scale
// 1, 2 or 5 times a power of ten, at most x.
static double round_down(double x) {
  double p = pow(10, floor(log10(x))), m = x / p;
  return (m >= 5 ? 5 : m >= 2 ? 2 : 1) * p;
}

static double put_scale(pl_html* h, const pl_frame_of* f, double x, const char* class,
                        double unit_per_metre, const char* unit, bool on) {
  double value = round_down(80 / f->scale * unit_per_metre),
         length = value / unit_per_metre * f->scale, y = f->height - 12;
  const char* off = on ? "" : " style=\"display:none\"";
  pl_text d = pl_text_make(h->arena);
  add_arrow(&d, x, y, x + length, y);
  const char* words = pl_html_quantity(h, value, unit, 3);
  pl_html_rawf(h,
               "<g class=\"%s scale\"%s><path d=\"%s\"/></g><text class=\"%s scale\"%s x=\"%.1f\" "
               "y=\"%.1f\">",
               class, off, pl_text_string(&d), class, off, x + length + 8, y + 5);
  pl_html_text(h, words);
  pl_html_raw(h, "</text>\n");
  return x + length + 30 + 8.2 * pl_utf8_width(words);
}

static void put_scales(pl_html* h, const pl_scene* s, const pl_frame_of* f) {
  bool units = h->model->uses_units;
  double x = 12;
  if (s->newton_per_metre > 0 && has_kind(s, PL_SHAPE_FORCE))
    x = put_scale(h, f, x, "force", s->newton_per_metre, units ? "N" : "",
                  shows_kind(s, PL_SHAPE_FORCE));
  if (s->speed_per_metre > 0 && has_kind(s, PL_SHAPE_VELOCITY))
    put_scale(h, f, x, "velocity", s->speed_per_metre, units ? "m/s" : "",
              shows_kind(s, PL_SHAPE_VELOCITY));
}

void pl_html_picture(pl_html* h) {
  const pl_scene* s = h->in->scene;
  pl_frame_of f = fit(s);
  pl_html_rawf(h, "<svg id=\"anim\" viewBox=\"0 0 %d %d\" role=\"img\" aria-label=\"", PL_HTML_WIDE,
               f.height);
  pl_html_attribute(h, pl_html_words(h, s->description));
  pl_html_raw(h, "\">\n");
  // first what lies behind
  static const pl_shape_kind order[] = {
      PL_SHAPE_GROUND, PL_SHAPE_CURVE,    PL_SHAPE_AXIS,  PL_SHAPE_ANGLE,  PL_SHAPE_TRAIL,
      PL_SHAPE_BODY,   PL_SHAPE_ROPE,     PL_SHAPE_ROD,   PL_SHAPE_SPRING, PL_SHAPE_DAMPER,
      PL_SHAPE_POINT,  PL_SHAPE_VELOCITY, PL_SHAPE_FORCE, PL_SHAPE_MASS};
  for (size_t k = 0; k < sizeof order / sizeof *order; k++) {
    for (int i = 0; i < s->n_shapes; i++)
      if (s->shapes[i].kind == order[k]) put_shape(h, s, &f, i);
  }
  put_labels(h, s, &f);
  put_scales(h, s, &f);
  pl_html_raw(h, "</svg>\n");
}

bool pl_html_has_picture(const pl_html* h) {
  const pl_scene* s = h->in->scene;
  return s && !h->in->no_animation && s->n_shapes > 0 && s->n_frames > 0 && finite_box(s);
}

bool pl_html_scene_has(const pl_html* h, pl_shape_kind kind) {
  return has_kind(h->in->scene, kind);
}

// ----------------------------------------------------------------------------------------- numbers
// Points that go the same way are sent once: the end of a rod, the mass there and the tails of its
// arrows share one track. Of an arc three points are enough.
typedef struct pl_html_track {
  const unsigned char* bytes;
  bool still;
} pl_html_track;
typedef struct pl_html_tracks {
  PL_VEC(pl_html_track) list;
  pl_map* by_hash;  // hash -> place + 1
  size_t size;      // of one track, bytes
  int n_moving;
} pl_html_tracks;

static void put_pixel(unsigned char* to, double pixel, bool there) {
  double steps = fmin(fmax(floor(pixel * PL_HTML_STEPS + 0.5), -32767), 32767);
  uint16_t bits = (uint16_t)(int16_t)(there ? steps : -32768);
  to[0] = (unsigned char)(bits & 255);
  to[1] = (unsigned char)(bits >> 8);
}

static int add_track(pl_html* h, pl_html_tracks* all, const pl_html_track* t) {
  uint64_t key = pl_hash_bytes(t->bytes, all->size, 7) | 1;
  int at = (int)pl_map_get(all->by_hash, key) - 1;
  if (at >= 0 && memcmp(all->list.at[at].bytes, t->bytes, all->size) == 0) return at;
  pl_push(h->arena, all->list, *t);
  pl_map_set(all->by_hash, key, (uint64_t)all->list.n);
  all->n_moving += !t->still;
  return all->list.n - 1;
}

// The track of one point of a shape.  stride: floats between two frames.
static int track_of(pl_html* h, pl_html_tracks* all, const pl_frame_of* f, const float* xy,
                    size_t stride) {
  size_t n = all->size / 4;
  unsigned char* bytes = PL_ARRAY(h->arena, unsigned char, all->size + 1);
  bool still = true;
  for (size_t i = 0; i < n; i++) {
    const float* p = xy + i * stride;
    bool there = isfinite(p[0]) && isfinite(p[1]);
    put_pixel(bytes + 4 * i, there ? px(f, p[0]) : 0, there);
    put_pixel(bytes + 4 * i + 2, there ? py(f, p[1]) : 0, there);
    still = still && memcmp(bytes, bytes + 4 * i, 4) == 0;
  }
  return add_track(h, all, &(pl_html_track){bytes, still});
}

enum { PL_HTML_MOVING_POINTS = 33 };  // of a curve that moves as a whole

// Which points of a shape are sent.
static int chosen_points(const pl_shape* p, int* at) {
  if (p->kind == PL_SHAPE_TRAIL) {
    at[0] = 0;
    return 1;
  }
  bool arc = p->kind == PL_SHAPE_ANGLE && p->n > 3;
  int n = arc ? 3 : p->n > PL_HTML_MOVING_POINTS ? PL_HTML_MOVING_POINTS : p->n;
  for (int i = 0; i < n; i++) at[i] = n > 1 ? (int)((long)i * (p->n - 1) / (n - 1)) : 0;
  return n;
}

static void put_track(pl_html* h, const pl_html_track* t, size_t size, bool first) {
  pl_html_raw(h, first ? "\"" : ",\n\"");
  pl_base64_add(h->out, t->bytes, t->still ? 4 : size);
  pl_html_raw(h, "\"");
}

void pl_html_scene_data(pl_html* h) {
  const pl_scene* s = h->in->scene;
  pl_frame_of f = fit(s);
  pl_html_tracks all = {.by_hash = pl_map_make(h->arena), .size = 4 * (size_t)s->n_frames};
  pl_html_rawf(h, "{\"w\":%d,\"h\":%d,\"best\":%d,\"t\":\"", PL_HTML_WIDE, f.height, opening(s));
  pl_html_raw(h, pl_html_floats(h, s->t, s->n_frames));
  pl_html_raw(h, "\",\"shapes\":[");
  bool first = true;
  for (int i = 0; i < s->n_shapes; i++) {
    const pl_shape* p = &s->shapes[i];
    if (!lives(p)) continue;
    int at[PL_HTML_MOVING_POINTS], n = chosen_points(p, at);
    pl_html_rawf(h, "%s{\"i\":%d,\"k\":\"%s\",\"p\":[", first ? "" : ",", i, class_of[p->kind]);
    for (int k = 0; k < n; k++) {
      size_t stride = p->kind == PL_SHAPE_TRAIL ? 2 : 2 * (size_t)p->n;
      pl_html_rawf(h, "%s%d", k ? "," : "", track_of(h, &all, &f, p->xy + 2 * at[k], stride));
    }
    pl_html_raw(h, "]}");
    first = false;
  }
  pl_html_raw(h, "],\n\"tracks\":[");
  for (int i = 0; i < all.list.n; i++) put_track(h, &all.list.at[i], all.size, i == 0);
  pl_html_raw(h, "]}");
}
