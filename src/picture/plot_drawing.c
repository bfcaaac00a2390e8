// A panel: axes with round ticks, curves thinned to what pixels can show, a legend above the data,
// marks of events.
#include <math.h>
#include <string.h>

#include "picture/picture_impl.h"

static const double text_size = 12, row = 17;

typedef struct pl_panel {
  pl_drawing* d;
  const pl_plot_panel* p;
  pl_language lang;
  pl_axis_scale x, y;
  double left, right, top, bottom;  // of the area of the data, px
} pl_panel;

static double px(const pl_panel* a, double x) {
  return a->left + (x - a->x.lo) / (a->x.hi - a->x.lo) * (a->right - a->left);
}
static double py(const pl_panel* a, double y) {
  return a->bottom - (y - a->y.lo) / (a->y.hi - a->y.lo) * (a->bottom - a->top);
}

// ------------------------------------------------------------------------------------------ ranges
static void widen(double* lo, double* hi, const double* v, int n) {
  for (int i = 0; i < n; i++) {
    if (!isfinite(v[i])) continue;
    *lo = fmin(*lo, v[i]);
    *hi = fmax(*hi, v[i]);
  }
}

static bool over_time(const pl_plot_panel* p) {
  for (int c = 0; c < p->n_curves; c++) {
    for (int i = 1; i < p->curves[c].n; i++)
      if (p->curves[c].x[i] < p->curves[c].x[i - 1]) return false;
  }
  return true;
}

// ------------------------------------------------------------------------------------------ curves
typedef PL_VEC(float) pl_floats;

static void point(pl_panel* a, pl_floats* out, double x, double y) {
  pl_push(a->d->arena, *out, (float)(isfinite(y) ? px(a, x) : (double)NAN));
  pl_push(a->d->arena, *out, (float)(isfinite(x) ? py(a, y) : (double)NAN));
}

// One pixel column of a curve over rising x: where it enters, its least and largest value, where it
// leaves.
static void column(pl_panel* a, pl_floats* out, const pl_curve_data* c, int from, int to) {
  int least = from, most = from;
  for (int i = from; i < to; i++) {
    if (c->y[i] < c->y[least]) least = i;
    if (c->y[i] > c->y[most]) most = i;
  }
  int order[4] = {from, least < most ? least : most, least < most ? most : least, to - 1},
      last = -1;
  for (int k = 0; k < 4; k++) {
    if (order[k] != last) point(a, out, c->x[order[k]], c->y[order[k]]);
    last = order[k];
  }
}

static void thin_rising(pl_panel* a, pl_floats* out, const pl_curve_data* c) {
  for (int i = 0; i < c->n;) {
    if (!isfinite(c->x[i] + c->y[i])) {
      point(a, out, (double)NAN, (double)NAN);
      i++;
      continue;
    }
    int end = i + 1;
    double pixel = floor(px(a, c->x[i]));
    while (end < c->n && isfinite(c->x[end] + c->y[end]) && floor(px(a, c->x[end])) == pixel) end++;
    column(a, out, c, i, end);
    i = end;
  }
}

// Anything else: points nearer than a third of a pixel to the last one are left out.
static void thin_path(pl_panel* a, pl_floats* out, const pl_curve_data* c) {
  double x0 = INFINITY, y0 = INFINITY;
  for (int i = 0; i < c->n; i++) {
    double x = px(a, c->x[i]), y = py(a, c->y[i]);
    if (isfinite(x + y) && isfinite(x0) && fabs(x - x0) < 0.33 && fabs(y - y0) < 0.33
        && i + 1 < c->n)
      continue;
    point(a, out, c->x[i], c->y[i]);
    x0 = x;
    y0 = y;
  }
}

static void draw_curves(pl_panel* a, bool rising) {
  for (int k = 0; k < a->p->n_curves; k++) {
    const pl_curve_data* c = &a->p->curves[k];
    pl_floats out = {0};
    if (rising) thin_rising(a, &out, c);
    else thin_path(a, &out, c);
    if (out.n == 0) continue;
    pl_stroke* s = pl_draw_line(a->d, (pl_ink)(PL_INK_SERIES_0 + k % PL_N_SERIES), 1.8, out.n / 2,
                                out.at);
    s->dash = k % PL_N_DASHES;
    if (!rising && isfinite(out.at[0]))
      pl_draw_disc(a->d, PL_INK_NONE, (pl_ink)(PL_INK_SERIES_0 + k % PL_N_SERIES),
                   (double)out.at[0], (double)out.at[1], 3);
  }
}

// --------------------------------------------------------------------------------- around the data
static void draw_grid(pl_panel* a) {
  for (int i = 0; i < a->x.n; i++) {
    double t = pl_axis_tick(&a->x, i), at = px(a, t);
    pl_draw_segment(a->d, t == 0 ? PL_INK_FRAME : PL_INK_GRID, 1, at, a->top, at, a->bottom);
    pl_draw_text(a->d, PL_INK_MUTED, text_size - 1, PL_ANCHOR_MIDDLE, at, a->bottom + 15,
                 pl_axis_text(a->d->arena, &a->x, t, a->lang));
  }
  for (int i = 0; i < a->y.n; i++) {
    double t = pl_axis_tick(&a->y, i), at = py(a, t);
    pl_draw_segment(a->d, t == 0 ? PL_INK_FRAME : PL_INK_GRID, 1, a->left, at, a->right, at);
    pl_draw_text(a->d, PL_INK_MUTED, text_size - 1, PL_ANCHOR_END, a->left - 6, at + 4,
                 pl_axis_text(a->d->arena, &a->y, t, a->lang));
  }
  pl_draw_box(a->d, PL_INK_FRAME, PL_INK_NONE, a->left, a->top, a->right - a->left,
              a->bottom - a->top);
}

static void draw_marks(pl_panel* a, double y) {
  double free_from = a->left - 20;
  for (int i = 0; i < a->p->n_marks; i++) {
    const pl_plot_mark* m = &a->p->marks[i];
    if (!(m->x >= a->x.lo && m->x <= a->x.hi)) continue;
    double at = px(a, m->x), w = pl_text_width(m->label, text_size - 1),
           from = fmax(a->left, fmin(at - w / 2, a->right - w));
    pl_draw_segment(a->d, PL_INK_MARK, 1, at, a->top, at, a->bottom)->dash = 4;
    // the line stays, its name would cover another
    if (from < free_from) continue;
    pl_draw_text(a->d, PL_INK_MARK, text_size - 1, PL_ANCHOR_START, from, y, m->label);
    free_from = from + w + 8;
  }
}

// A row of samples and names; the width that it takes when y is NaN.
static double legend(pl_panel* a, double y) {
  double x = a->left;
  for (int k = 0; k < a->p->n_curves; k++) {
    double w = pl_text_width(a->p->curves[k].name, text_size);
    if (!isnan(y)) {
      pl_stroke* s = pl_draw_segment(a->d, (pl_ink)(PL_INK_SERIES_0 + k % PL_N_SERIES), 2.2, x,
                                     y - 4, x + 24, y - 4);
      s->dash = k % PL_N_DASHES;
      pl_draw_text(a->d, PL_INK_TEXT, text_size, PL_ANCHOR_START, x + 29, y, a->p->curves[k].name);
    }
    x += 29 + w + 16;
  }
  return x - a->left;
}

static const char* y_title(const pl_panel* a) {
  const pl_curve_data* c = a->p->curves;
  pl_text t = pl_text_make(a->d->arena);
  for (int k = 0; k < a->p->n_curves; k++) pl_text_addf(&t, "%s%s", k ? ", " : "", c[k].name);
  const char* names = pl_text_string(&t);
  if (pl_text_width(names, text_size) > 0.9 * (a->bottom - a->top)) names = "";
  return pl_axis_title(a->d->arena, names, c[0].unit, a->y.power);
}

void pl_draw_plot(pl_drawing* d, const pl_plot_panel* p, pl_frame_rect r, pl_language lang) {
  if (p->n_curves == 0) return;
  pl_panel a = {.d = d, .p = p, .lang = lang};
  double x_lo = INFINITY, x_hi = -INFINITY, y_lo = INFINITY, y_hi = -INFINITY;
  for (int k = 0; k < p->n_curves; k++) {
    widen(&x_lo, &x_hi, p->curves[k].x, p->curves[k].n);
    widen(&y_lo, &y_hi, p->curves[k].y, p->curves[k].n);
  }
  bool rising = over_time(p), named = p->n_curves > 1;
  a.y = pl_axis_make(y_lo, y_hi, (r.h - 90) / 42, false);
  double widest = 0;
  for (int i = 0; i < a.y.n; i++)
    widest = fmax(widest, pl_text_width(pl_axis_text(d->arena, &a.y, pl_axis_tick(&a.y, i), lang),
                                        text_size - 1));
  a.left = r.x + 30 + widest;
  a.right = r.x + r.w - 16;
  a.x = pl_axis_make(x_lo, x_hi, (a.right - a.left) / 70, rising);
  // rows above the data: title, names, events
  double y = r.y + 8;
  if (p->title)
    pl_draw_text(d, PL_INK_TEXT, text_size + 1, PL_ANCHOR_START, a.left, y += row, p->title);
  if (named) legend(&a, y += row);
  double marks_at = p->n_marks > 0 ? (y += row) : y;
  a.top = y + 7;
  a.bottom = r.y + r.h - 40;
  if (a.bottom - a.top < 20 || a.right - a.left < 20) return;
  draw_grid(&a);
  draw_marks(&a, marks_at);
  draw_curves(&a, rising);
  pl_draw_text(d, PL_INK_TEXT, text_size, PL_ANCHOR_MIDDLE, (a.left + a.right) / 2, a.bottom + 33,
               pl_axis_title(d->arena, p->x_name, p->x_unit, a.x.power));
  pl_draw_text(d, PL_INK_TEXT, text_size, PL_ANCHOR_MIDDLE, r.x + 15, (a.top + a.bottom) / 2,
               y_title(&a))
      ->turned = true;
}
