// Strokes are appended; nothing is looked at again until a writer goes through them.
#include "picture/picture.h"

#include <math.h>
#include <string.h>

const char* const pl_ink_name[PL_N_INKS] = {
#define PL_INK(id, name, light, dark, print) name,
#include "inks.def"
#undef PL_INK
};

static const unsigned colours[PL_N_INKS][3] = {
#define PL_INK(id, name, light, dark, print) {light, dark, print},
#include "inks.def"
#undef PL_INK
};

unsigned pl_ink_colour(pl_ink ink, pl_theme theme) { return colours[ink][theme]; }

const float pl_dash[PL_N_DASHES][6] = {{0}, {7, 4, 0}, {2, 3, 0}, {9, 3, 2, 3, 0}, {3, 4, 0}};

pl_drawing* pl_drawing_make(pl_arena* a, double width, double height) {
  pl_drawing* d = PL_NEW(a, pl_drawing);
  d->arena = a;
  d->width = width;
  d->height = height;
  d->title = "";
  return d;
}

static pl_stroke* push(pl_drawing* d, pl_stroke s) {
  pl_push(d->arena, d->strokes, s);
  return &d->strokes.at[d->strokes.n - 1];
}

static const float* copied(pl_drawing* d, const float* xy, int n) {
  float* own = PL_ARRAY(d->arena, float, 2 * (size_t)n + 1);
  memcpy(own, xy, 2 * (size_t)n * sizeof *own);
  return own;
}

pl_stroke* pl_draw_line(pl_drawing* d, pl_ink ink, double width, int n, const float* xy) {
  return push(d, (pl_stroke){.kind = PL_STROKE_LINE,
                             .line = ink,
                             .width = (float)width,
                             .n = n,
                             .xy = copied(d, xy, n)});
}

pl_stroke* pl_draw_segment(pl_drawing* d, pl_ink ink, double width, double x0, double y0, double x1,
                           double y1) {
  return pl_draw_line(d, ink, width, 2, (float[]){(float)x0, (float)y0, (float)x1, (float)y1});
}

pl_stroke* pl_draw_disc(pl_drawing* d, pl_ink line, pl_ink fill, double x, double y,
                        double radius) {
  return push(d, (pl_stroke){.kind = PL_STROKE_DISC,
                             .line = line,
                             .fill = fill,
                             .width = 1.5f,
                             .n = 1,
                             .size = (float)radius,
                             .xy = copied(d, (float[]){(float)x, (float)y}, 1)});
}

pl_stroke* pl_draw_text(pl_drawing* d, pl_ink ink, double size, pl_anchor anchor, double x,
                        double y, const char* text) {
  return push(d, (pl_stroke){.kind = PL_STROKE_TEXT,
                             .fill = ink,
                             .size = (float)size,
                             .anchor = anchor,
                             .n = 1,
                             .text = text,
                             .xy = copied(d, (float[]){(float)x, (float)y}, 1)});
}

pl_stroke* pl_draw_box(pl_drawing* d, pl_ink line, pl_ink fill, double x, double y, double w,
                       double h) {
  float xy[8] = {(float)x,       (float)y,       (float)(x + w), (float)y,
                 (float)(x + w), (float)(y + h), (float)x,       (float)(y + h)};
  pl_stroke* s = pl_draw_line(d, line, 1, 4, xy);
  s->closed = true;
  s->fill = fill;
  return s;
}

void pl_draw_arrow(pl_drawing* d, pl_ink ink, double width, double x0, double y0, double x1,
                   double y1) {
  double length = hypot(x1 - x0, y1 - y0);
  if (!(length > 0.5)) return;
  double ux = (x1 - x0) / length, uy = (y1 - y0) / length,
         head = fmin(4 + 2.4 * width, 0.7 * length), half = 0.42 * head;
  double bx = x1 - head * ux, by = y1 - head * uy;
  pl_draw_segment(d, ink, width, x0, y0, bx + 0.3 * head * ux, by + 0.3 * head * uy);
  float tip[6] = {(float)x1,
                  (float)y1,
                  (float)(bx - half * uy),
                  (float)(by + half * ux),
                  (float)(bx + half * uy),
                  (float)(by - half * ux)};
  pl_stroke* s = pl_draw_line(d, PL_INK_NONE, 0, 3, tip);
  s->closed = true;
  s->fill = ink;
}

// Cells times a mean width: 0.56 of the height suits DejaVu Sans and Helvetica for names and
// numbers.
double pl_text_width(const char* text, double size) {
  double w = 0;
  for (const char* c = text; *c; c++) {
    if (((unsigned char)*c & 0xc0) == 0x80) continue;
    w += strchr("il.,;:|'!ftj()[] I", *c) ? 0.36 : strchr("mwMW", *c) ? 0.9 : 0.6;
  }
  return w * size;
}

// Digits at the end of a name of letters are an index: m1 is m₁, x_2 is x₂.
static const char* with_index(pl_arena* a, const char* name) {
  static const char* const low[10] = {"₀", "₁", "₂", "₃", "₄", "₅", "₆", "₇", "₈", "₉"};
  size_t n = strlen(name), stem = n;
  while (stem > 0 && name[stem - 1] >= '0' && name[stem - 1] <= '9') stem--;
  if (stem == 0 || stem == n || n - stem > 3) return name;
  size_t letters = stem - (name[stem - 1] == '_');
  if (letters == 0) return name;
  pl_text t = pl_text_make(a);
  pl_text_add_n(&t, name, letters);
  for (size_t i = stem; i < n; i++) pl_text_add(&t, low[name[i] - '0']);
  return pl_text_string(&t);
}

const char* pl_picture_label(pl_arena* a, const char* name) {
  const char* blank = strchr(name, ' ');
  if (!blank) return with_index(a, name);
  return pl_format(a, "%s %s", with_index(a, pl_copy_n(a, name, (size_t)(blank - name))),
                   pl_picture_label(a, blank + 1));
}
