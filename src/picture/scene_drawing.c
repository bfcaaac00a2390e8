// A frame of a scene as strokes: what lies behind first, arrows and labels last. Labels look for a
// place that is free.
#include <math.h>
#include <string.h>

#include "picture/picture_impl.h"

static const double pad = 26, text_size = 13;
enum { MOST_DISCS = 24 };  // more masses are drawn as dots

// -------------------------------------------------------------------------------- metres to pixels
pl_fit pl_fit_make(const pl_scene* scene, pl_frame_rect r) {
  double w = scene->box[2] - scene->box[0], h = scene->box[3] - scene->box[1];
  double size = fmax(fmax(w, h), 1e-12);
  w = fmax(w, 1e-3 * size);
  h = fmax(h, 1e-3 * size);
  pl_fit f = {.scale = fmin((r.w - 2 * pad) / w, (r.h - 2 * pad) / h)};
  f.x0 = r.x + r.w / 2 - f.scale * ((double)scene->box[0] + (double)scene->box[2]) / 2;
  f.y0 = r.y + r.h / 2 + f.scale * ((double)scene->box[1] + (double)scene->box[3]) / 2;
  f.rect = r;
  int masses = 0;
  for (int i = 0; i < scene->n_shapes; i++) masses += scene->shapes[i].kind == PL_SHAPE_MASS;
  f.crowd = masses > MOST_DISCS;
  return f;
}

double pl_scene_aspect(const pl_scene* scene) {
  double w = scene->box[2] - scene->box[0], h = scene->box[3] - scene->box[1];
  if (!(w > 0) && !(h > 0)) return 0.75;
  return fmax(0.55, fmin(1.25, h / fmax(w, 1e-12)));
}

static const float* points_at(const pl_shape* p, int frame) {
  return p->xy + (p->moves ? (size_t)frame * (size_t)p->n * 2 : 0);
}

static float* pixels(pl_drawing* d, const pl_fit* f, const float* xy, int n) {
  float* out = PL_ARRAY(d->arena, float, 2 * (size_t)n + 2);
  for (int i = 0; i < n; i++) {
    out[2 * i] = (float)(f->x0 + f->scale * (double)xy[2 * i]);
    out[2 * i + 1] = (float)(f->y0 - f->scale * (double)xy[2 * i + 1]);
  }
  return out;
}

// ------------------------------------------------------------------------------------------ labels
static void take(pl_drawing* d, double x0, double y0, double x1, double y1) {
  float* xy = PL_ARRAY(d->arena, float, 4);
  xy[0] = (float)x0;
  xy[1] = (float)y0;
  xy[2] = (float)x1;
  xy[3] = (float)y1;
  pl_push(d->arena, d->taken, (pl_stroke){.n = 2, .xy = xy});
}

static void take_line(pl_drawing* d, const float* xy, int n) {
  for (int i = 0; i + 1 < n; i++) {
    double dx = (double)(xy[2 * i + 2] - xy[2 * i]), dy = (double)(xy[2 * i + 3] - xy[2 * i + 1]);
    int pieces = (int)(hypot(dx, dy) / 8) + 1;
    for (int k = 0; isfinite(dx + dy) && k <= pieces && pieces < 400; k++) {
      double x = (double)xy[2 * i] + dx * k / pieces, y = (double)xy[2 * i + 1] + dy * k / pieces;
      take(d, x - 1.5, y - 1.5, x + 1.5, y + 1.5);
    }
  }
}

static double overlap(const pl_drawing* d, double x0, double y0, double x1, double y1) {
  double sum = 0;
  for (int i = 0; i < d->taken.n; i++) {
    const float* t = d->taken.at[i].xy;
    double w = fmin(x1, (double)t[2]) - fmax(x0, (double)t[0]),
           h = fmin(y1, (double)t[3]) - fmax(y0, (double)t[1]);
    if (w > 0 && h > 0) sum += w * h;
  }
  return sum;
}

// Places the label near (x, y) where the least is covered: right above, right, left above, ...
static void label_near(pl_drawing* d, const pl_fit* f, pl_ink ink, const char* name, double x,
                       double y, double gap) {
  if (!*name || !isfinite(x + y)) return;
  const char* text = pl_picture_label(d->arena, name);
  if (d->steady) {
    pl_draw_text(d, ink, text_size, PL_ANCHOR_START, x + gap, y - 0.5 * gap, text);
    return;
  }
  double w = pl_text_width(text, text_size), h = text_size, best = INFINITY, bx = x, by = y;
  static const double way[12][2] = {{1, -1}, {1, 0}, {-1, -1}, {-1, 0},  {1, 1}, {-1, 1},
                                    {0, -1}, {0, 1}, {2, -1},  {-2, -1}, {2, 1}, {-2, 1}};
  for (int k = 0; k < 36; k++) {
    double reach = gap * (1 + k / 12 * 0.9), wx = way[k % 12][0], wy = way[k % 12][1];
    double cx = x
                + (wx > 0   ? reach
                   : wx < 0 ? -reach - w
                            : -w / 2)
                + (fabs(wx) > 1 ? (wx > 0 ? 8 : -8) : 0);
    double cy = wy == 0 ? y - h / 2 : wy < 0 ? y - reach * 0.7 - h : y + reach * 0.7;
    double cost = overlap(d, cx - 1, cy - 1, cx + w + 1, cy + h + 1) + 3 * k;
    if (cx < f->rect.x + 2 || cx + w > f->rect.x + f->rect.w - 2 || cy < f->rect.y + 2
        || cy + h > f->rect.y + f->rect.h - 2)
      cost += 1e4;
    if (cost < best) {
      best = cost;
      bx = cx;
      by = cy;
    }
  }
  pl_draw_text(d, ink, text_size, PL_ANCHOR_START, bx, by + 0.82 * h, text);
  take(d, bx - 2, by - 2, bx + w + 2, by + h + 2);
}

// ----------------------------------------------------------------------------------- single shapes
static void draw_coil(pl_drawing* d, const float* p, bool damper) {
  double dx = (double)(p[2] - p[0]), dy = (double)(p[3] - p[1]), length = hypot(dx, dy);
  if (!(length > 0)) return;
  double ux = dx / length, uy = dy / length;
  if (damper) {
    double a = 0.4 * length, b = 0.65 * length, w = 6;
    pl_draw_segment(d, PL_INK_SPRING, 1.5, (double)p[0], (double)p[1], (double)p[0] + a * ux,
                    (double)p[1] + a * uy);
    pl_draw_segment(d, PL_INK_SPRING, 1.5, (double)p[0] + 0.52 * length * ux,
                    (double)p[1] + 0.52 * length * uy, (double)p[2], (double)p[3]);
    float cup[8];
    double at[4][2] = {{b, w}, {a, w}, {a, -w}, {b, -w}};
    for (int i = 0; i < 4; i++) {
      cup[2 * i] = (float)((double)p[0] + at[i][0] * ux - at[i][1] * uy);
      cup[2 * i + 1] = (float)((double)p[1] + at[i][0] * uy + at[i][1] * ux);
    }
    pl_draw_line(d, PL_INK_SPRING, 1.5, 4, cup);
    pl_draw_segment(d, PL_INK_SPRING, 2.5, (double)p[0] + 0.52 * length * ux - (w - 1) * uy,
                    (double)p[1] + 0.52 * length * uy + (w - 1) * ux,
                    (double)p[0] + 0.52 * length * ux + (w - 1) * uy,
                    (double)p[1] + 0.52 * length * uy - (w - 1) * ux);
    return;
  }
  enum { TURNS = 9 };
  float xy[2 * (2 * TURNS + 4)];
  int n = 0;
  double lead = fmin(10, 0.15 * length), wide = fmin(6, 0.3 * length);
  xy[n++] = p[0];
  xy[n++] = p[1];
  for (int i = 0; i <= 2 * TURNS; i++) {
    double s = lead + (length - 2 * lead) * i / (2 * TURNS), w = i == 0 || i == 2 * TURNS ? 0
                                                                 : i % 2                  ? wide
                                                                                          : -wide;
    xy[n++] = (float)((double)p[0] + s * ux - w * uy);
    xy[n++] = (float)((double)p[1] + s * uy + w * ux);
  }
  xy[n++] = p[2];
  xy[n++] = p[3];
  pl_draw_line(d, PL_INK_SPRING, 1.5, n / 2, xy);
}

// Short strokes into the material, every ten pixels.
static void draw_hatches(pl_drawing* d, const float* p, int n, int side) {
  double gone = 5;
  PL_VEC(float) xy = {0};
  for (int i = 0; i + 1 < n; i++) {
    double dx = (double)(p[2 * i + 2] - p[2 * i]), dy = (double)(p[2 * i + 3] - p[2 * i + 1]),
           l = hypot(dx, dy);
    if (!(l > 0) || !isfinite(l)) continue;
    for (; gone < l && xy.n < 6000; gone += 9) {
      double x = (double)p[2 * i] + dx * gone / l, y = (double)p[2 * i + 1] + dy * gone / l;
      // left of the line, y down: (dy, -dx)
      double nx = side * dy / l, ny = -side * dx / l, tx = dx / l, ty = dy / l;
      float piece[6] = {
          (float)x,   (float)y,  (float)(x + 7 * nx - 5 * tx), (float)(y + 7 * ny - 5 * ty),
          (float)NAN, (float)NAN};
      for (int k = 0; k < 6; k++) pl_push(d->arena, xy, piece[k]);
    }
    gone -= l;
  }
  if (xy.n > 0) pl_draw_line(d, PL_INK_GROUND, 1, xy.n / 2, xy.at);
}

// A path that is long is shown near the present moment only.
static void draw_trail(pl_drawing* d, const pl_fit* f, const float* xy, int n, int frame) {
  double most = 4 * (f->rect.w + f->rect.h), length = 0;
  int from = 0, to = n;
  for (int i = 1; i < n; i++)
    length += hypot((double)(xy[2 * i] - xy[2 * i - 2]), (double)(xy[2 * i + 1] - xy[2 * i - 1]));
  if (length > most) {
    length = 0;
    for (to = frame > 0 ? frame + 1 : 1; to < n && length < (frame > 0 ? 0 : most); to++) {
      length += hypot((double)(xy[2 * to] - xy[2 * to - 2]),
                      (double)(xy[2 * to + 1] - xy[2 * to - 1]));
    }
    length = 0;
    for (from = to - 1; from > 0 && length < most; from--) {
      length += hypot((double)(xy[2 * from] - xy[2 * from - 2]),
                      (double)(xy[2 * from + 1] - xy[2 * from - 1]));
    }
  }
  pl_draw_line(d, PL_INK_TRAIL, 1.5, to - from, xy + 2 * from);
}

// An arrow that would leave the panel ends at its border, dashed and without a tip.
static void draw_vector(pl_drawing* d, const pl_fit* f, pl_ink ink, double width, const float* xy) {
  double x0 = (double)xy[0], y0 = (double)xy[1], dx = (double)xy[2] - x0, dy = (double)xy[3] - y0,
         u = 1;
  double x_end = dx > 0 ? f->rect.x + f->rect.w - 3 : f->rect.x + 3,
         y_end = dy > 0 ? f->rect.y + f->rect.h - 3 : f->rect.y + 3;
  if (dx != 0) u = fmin(u, (x_end - x0) / dx);
  if (dy != 0) u = fmin(u, (y_end - y0) / dy);
  if (u >= 1) pl_draw_arrow(d, ink, width, x0, y0, x0 + dx, y0 + dy);
  else if (u > 0) pl_draw_segment(d, ink, width, x0, y0, x0 + u * dx, y0 + u * dy)->dash = 1;
}

static void draw_shape(pl_drawing* d, const pl_fit* f, const pl_shape* p, int frame,
                       const pl_scene_style* style) {
  float* xy = pixels(d, f, points_at(p, frame), p->n);
  switch (p->kind) {
    case PL_SHAPE_MASS:
      if (!isfinite(xy[0])) return;
      pl_draw_disc(d, f->crowd ? PL_INK_NONE : PL_INK_PAPER, PL_INK_MASS, (double)xy[0],
                   (double)xy[1], f->crowd ? 2.2 : pl_mass_radius(p));
      take(d, (double)xy[0] - 7, (double)xy[1] - 7, (double)xy[0] + 7, (double)xy[1] + 7);
      break;
    case PL_SHAPE_POINT:
      if (!isfinite(xy[0])) return;
      pl_draw_disc(d, PL_INK_POINT, PL_INK_PAPER, (double)xy[0], (double)xy[1], 3.5);
      take(d, (double)xy[0] - 4, (double)xy[1] - 4, (double)xy[0] + 4, (double)xy[1] + 4);
      break;
    case PL_SHAPE_BODY: {
      pl_stroke* s = pl_draw_line(d, PL_INK_ROD, 1.5, p->n, xy);
      s->fill = PL_INK_BODY;
      s->closed = true;
      s->faint = 0.12f;
      take_line(d, xy, p->n);
      break;
    }
    case PL_SHAPE_ROD:
      pl_draw_line(d, PL_INK_ROD, 3, 2, xy);
      take_line(d, xy, 2);
      break;
    case PL_SHAPE_ROPE:
      pl_draw_line(d, PL_INK_ROPE, 1.6, p->n, xy);
      take_line(d, xy, p->n);
      break;
    case PL_SHAPE_SPRING:
      draw_coil(d, xy, false);
      take_line(d, xy, 2);
      break;
    case PL_SHAPE_DAMPER:
      draw_coil(d, xy, true);
      take_line(d, xy, 2);
      break;
    case PL_SHAPE_CURVE:
      pl_draw_line(d, PL_INK_GUIDE, 1.5, p->n, xy)->dash = p->side ? 2 : 0;
      take_line(d, xy, p->n);
      break;
    case PL_SHAPE_GROUND:
      draw_hatches(d, xy, p->n, p->side ? p->side : 1);
      pl_draw_line(d, PL_INK_GROUND, 2, p->n, xy);
      take_line(d, xy, p->n);
      break;
    case PL_SHAPE_AXIS:
      pl_draw_arrow(d, PL_INK_AXIS, 1, (double)xy[0], (double)xy[1], (double)xy[2], (double)xy[3]);
      take_line(d, xy, 2);
      break;
    case PL_SHAPE_ANGLE:
      pl_draw_line(d, PL_INK_ANGLE, 1.3, p->n, xy);
      take_line(d, xy, p->n);
      break;
    case PL_SHAPE_FORCE:
      if (!style->forces || !isfinite(xy[0])) return;
      draw_vector(d, f, strcmp(p->of, "weight") == 0 ? PL_INK_WEIGHT : PL_INK_FORCE, 2.2, xy);
      take_line(d, xy, 2);
      break;
    case PL_SHAPE_VELOCITY:
      if (!style->velocities || !isfinite(xy[0])) return;
      draw_vector(d, f, PL_INK_VELOCITY, 1.8, xy);
      take_line(d, xy, 2);
      break;
    case PL_SHAPE_TRAIL:
      if (style->trails) draw_trail(d, f, xy, p->n, frame);
      break;
  }
}

double pl_mass_radius(const pl_shape* p) {
  return p->weight > 0 ? 4 + 4 * cbrt((double)p->weight) : 6.5;
}

// The point that a label goes to.
static void draw_label(pl_drawing* d, const pl_fit* f, const pl_shape* p, int frame,
                       const pl_scene_style* style) {
  const float* xy = pixels(d, f, points_at(p, frame), p->n);
  switch (p->kind) {
    case PL_SHAPE_MASS:
      label_near(d, f, PL_INK_MASS, p->label, (double)xy[0], (double)xy[1], pl_mass_radius(p) + 3);
      break;
    case PL_SHAPE_POINT:
      label_near(d, f, PL_INK_MUTED, p->label, (double)xy[0], (double)xy[1], 7);
      break;
    case PL_SHAPE_AXIS:
      label_near(d, f, PL_INK_AXIS, p->label, (double)xy[2], (double)xy[3], 5);
      break;
    case PL_SHAPE_ANGLE:
      label_near(d, f, PL_INK_ANGLE, p->label, (double)xy[2 * (p->n / 2)],
                 (double)xy[2 * (p->n / 2) + 1], 5);
      break;
    case PL_SHAPE_SPRING:
    case PL_SHAPE_DAMPER:
      label_near(d, f, PL_INK_SPRING, p->label, (double)(xy[0] + xy[2]) / 2,
                 (double)(xy[1] + xy[3]) / 2, 10);
      break;
    case PL_SHAPE_FORCE:
      if (style->forces)
        label_near(d, f, strcmp(p->of, "weight") == 0 ? PL_INK_WEIGHT : PL_INK_FORCE, p->label,
                   (double)xy[2], (double)xy[3], 6);
      break;
    case PL_SHAPE_VELOCITY:
      if (style->velocities)
        label_near(d, f, PL_INK_VELOCITY, p->label, (double)xy[2], (double)xy[3], 6);
      break;
    case PL_SHAPE_BODY: {
      double x = 0, y = 0;
      for (int i = 0; i < p->n; i++) {
        x += (double)xy[2 * i] / p->n;
        y += (double)xy[2 * i + 1] / p->n;
      }
      label_near(d, f, PL_INK_MASS, p->label, x, y, 9);
      break;
    }
    default: break;
  }
}

// ------------------------------------------------------------------------------------------ layers
static int layer(const pl_shape* p) {
  // ORDER KINDS: as in pl_shape_kind
  static const int of[] = {6, 5, 3, 4, 4, 4, 4, 1, 1, 2, 5, 7, 7, 2};
  return of[p->kind];
}

enum { PL_STILL = 1, PL_MOVING = 2, TAIL = 40 };

// The last part of a path, up to the present frame.
static void draw_tail(pl_drawing* d, const pl_fit* f, const pl_shape* p, int frame) {
  int from = frame > TAIL ? frame - TAIL : 0;
  if (frame > from)
    pl_draw_line(d, PL_INK_TRAIL, 1.5, frame + 1 - from,
                 pixels(d, f, p->xy + 2 * from, frame + 1 - from));
}

static void draw(pl_drawing* d, const pl_scene* scene, int frame, pl_frame_rect where,
                 const pl_scene_style* style, int which) {
  pl_fit f = pl_fit_make(scene, where);
  d->steady = style->steady && which == PL_MOVING;
  for (int i = 0; d->steady && style->trails && i < scene->n_shapes; i++) {
    if (scene->shapes[i].kind == PL_SHAPE_TRAIL) draw_tail(d, &f, &scene->shapes[i], frame);
  }
  for (int l = 1; l <= 7; l++) {
    for (int i = 0; i < scene->n_shapes; i++) {
      const pl_shape* p = &scene->shapes[i];
      bool wanted = which & (p->moves ? PL_MOVING : PL_STILL);
      if (p->kind == PL_SHAPE_TRAIL && style->steady) continue;
      if (layer(p) == l && wanted && (p->shown || p->kind == PL_SHAPE_VELOCITY))
        draw_shape(d, &f, p, frame, style);
    }
  }
  // labels of what has its place fixed first
  for (int pass = 0; style->labels && pass < 2; pass++) {
    for (int i = 0; i < scene->n_shapes; i++) {
      const pl_shape* p = &scene->shapes[i];
      bool wanted = which & (p->moves ? PL_MOVING : PL_STILL);
      if (p->moves == (pass == 1) && wanted && (p->shown || p->kind == PL_SHAPE_VELOCITY))
        draw_label(d, &f, p, frame, style);
    }
  }
}

void pl_draw_scene(pl_drawing* d, const pl_scene* scene, int frame, pl_frame_rect where,
                   const pl_scene_style* style) {
  draw(d, scene, frame, where, style, PL_STILL | PL_MOVING);
}
void pl_draw_scene_still(pl_drawing* d, const pl_scene* scene, pl_frame_rect where,
                         const pl_scene_style* style) {
  draw(d, scene, 0, where, style, PL_STILL);
}
void pl_draw_scene_moving(pl_drawing* d, const pl_scene* scene, int frame, pl_frame_rect where,
                          const pl_scene_style* style) {
  draw(d, scene, frame, where, style, PL_MOVING);
}
