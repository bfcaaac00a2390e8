// The plots of the motion: drawn here once, so that they are there on paper and without a script,
// and as numbers for the script, which draws them anew when somebody zooms.
#include "html_impl.h"

#include <math.h>
#include <string.h>

enum {
  PL_HTML_PLOT_W = 500,
  PL_HTML_PLOT_H = 190,
  PL_HTML_LEFT = 58,
  PL_HTML_RIGHT = 14,
  PL_HTML_TOP = 10,
  PL_HTML_BOTTOM = 30,
  PL_HTML_DRAWN = 90,      // points of a curve on paper
  PL_HTML_KEPT = 1600,     // rows up to which all are kept
  PL_HTML_EXTREMES = 2400  // points kept for the extremes of all curves together
};

// -------------------------------------------------------------------------------------------- rows

static void keep(int* kept, int row) { kept[row] = 1; }

// Of many rows those at even distances, around events, and the extremes of each curve in between.
pl_html_rows pl_html_thin(pl_html* h) {
  const pl_result* r = h->in->result;
  int n = r->rows.n, curves = 1;
  int* kept = PL_ARRAY(h->arena, int, n + 1);
  for (int p = 0; p < h->in->n_plots; p++) curves += h->in->plots[p].n_curves;
  int buckets = n <= PL_HTML_KEPT                       ? n
                : PL_HTML_EXTREMES / (2 * curves) < 100 ? 100
                                                        : PL_HTML_EXTREMES / (2 * curves);
  for (int b = 0; b < buckets; b++) {
    int from = (int)((long)b * n / buckets), to = (int)((long)(b + 1) * n / buckets);
    if (from < to) keep(kept, from);
    for (int p = 0; buckets < n && p < h->in->n_plots; p++) {
      for (int c = 0; c < h->in->plots[p].n_curves; c++) {
        int column = h->in->plots[p].curves[c].column, lo = from, hi = from;
        for (int i = from; i < to; i++) {
          if (r->rows.at[i][column] < r->rows.at[lo][column]) lo = i;
          if (r->rows.at[i][column] > r->rows.at[hi][column]) hi = i;
        }
        if (from < to) {
          keep(kept, lo);
          keep(kept, hi);
        }
      }
    }
  }
  for (int i = 0; i < n; i++) {
    if (r->kinds.at[i] == PL_ROW_BEFORE || r->kinds.at[i] == PL_ROW_AFTER) keep(kept, i);
  }
  keep(kept, 0);
  keep(kept, n - 1);
  int* at = PL_ARRAY(h->arena, int, n + 1);
  int m = 0;
  for (int i = 0; i < n; i++)
    if (kept[i]) at[m++] = i;
  return (pl_html_rows){m, at};
}

// -------------------------------------------------------------------------------------------- axes
typedef struct pl_html_range {
  double lo, hi;
} pl_html_range;

static pl_html_range range_of(const pl_html* h, const pl_html_rows* rows, const int* column, int n,
                              double room) {
  pl_html_range g = {INFINITY, -INFINITY};
  for (int i = 0; i < rows->n; i++) {
    for (int k = 0; k < n; k++) {
      double x = h->in->result->rows.at[rows->at[i]][column[k]];
      if (!isfinite(x)) continue;
      g.lo = fmin(g.lo, x);
      g.hi = fmax(g.hi, x);
    }
  }
  if (!(g.lo <= g.hi)) return (pl_html_range){0, 1};
  double size = fmax(fabs(g.lo), fabs(g.hi)), span = g.hi - g.lo;
  if (span < 1e-9 * size || !(size > 0)) {  // a constant lies in the middle
    double around = size > 0 ? 0.5 * size : 1;
    return (pl_html_range){g.lo - around, g.hi + around};
  }
  if (room > 0 && g.lo > 0 && g.lo < 0.35 * g.hi) {
    g.lo = 0;
    span = g.hi;
  }
  if (room > 0 && g.hi < 0 && g.hi > 0.35 * g.lo) {
    g.hi = 0;
    span = -g.lo;
  }
  return (pl_html_range){g.lo - (fabs(g.lo) > 0 ? room * span : room * span / 2),
                         g.hi + (fabs(g.hi) > 0 ? room * span : room * span / 2)};
}

static double tick_step(double span, int n) {
  double w = span / n, p = pow(10, floor(log10(w)));
  static const double m[] = {1, 2, 5, 10};
  for (int i = 0; i < 4; i++)
    if (m[i] * p >= w * (1 - 1e-9)) return m[i] * p;
  return 10 * p;
}

static const char* tick_text(const pl_html* h, double v, double step) {
  if (fabs(v) < 1e-9 * step) return "0";
  return pl_html_number(h, v, 6);
}

typedef struct pl_html_axes {
  pl_html_range x, y;
} pl_html_axes;
static double to_x(const pl_html_axes* a, double x) {
  return PL_HTML_LEFT
         + (x - a->x.lo) / (a->x.hi - a->x.lo) * (PL_HTML_PLOT_W - PL_HTML_LEFT - PL_HTML_RIGHT);
}
static double to_y(const pl_html_axes* a, double y) {
  return PL_HTML_PLOT_H - PL_HTML_BOTTOM
         - (y - a->y.lo) / (a->y.hi - a->y.lo) * (PL_HTML_PLOT_H - PL_HTML_TOP - PL_HTML_BOTTOM);
}

static const char* with_unit(const pl_html* h, const char* name, const char* unit) {
  bool bare = !unit || !*unit || strcmp(unit, "1") == 0;
  return bare ? name : pl_format(h->arena, "%s in %s", name, unit);
}

static void put_axes(pl_html* h, const pl_html_axes* a, const char* x_label) {
  double step = tick_step(a->y.hi - a->y.lo, 4);
  for (double v = ceil(a->y.lo / step - 1e-9) * step; v <= a->y.hi + 1e-9 * step; v += step) {
    bool zero = fabs(v) < 1e-9 * step;
    pl_html_rawf(h,
                 "<line class=\"%s\" x1=\"%d\" x2=\"%d\" y1=\"%.1f\" y2=\"%.1f\"/><text "
                 "class=\"e\" x=\"%d\" y=\"%.1f\">%s</text>\n",
                 zero ? "ax" : "gr", PL_HTML_LEFT, PL_HTML_PLOT_W - PL_HTML_RIGHT, to_y(a, v),
                 to_y(a, v), PL_HTML_LEFT - 7, to_y(a, v) + 4, tick_text(h, v, step));
  }
  double label = 7.0 * pl_utf8_width(x_label) + 8, y = PL_HTML_PLOT_H - PL_HTML_BOTTOM;
  step = tick_step(a->x.hi - a->x.lo, 5);
  for (double v = ceil(a->x.lo / step - 1e-9) * step; v <= a->x.hi + 1e-9 * step; v += step) {
    pl_html_rawf(h, "<line class=\"ax\" x1=\"%.1f\" x2=\"%.1f\" y1=\"%.0f\" y2=\"%.0f\"/>",
                 to_x(a, v), to_x(a, v), y, y + 4);
    if (to_x(a, v) + 18 > PL_HTML_PLOT_W - PL_HTML_RIGHT - label) continue;
    pl_html_rawf(h, "<text class=\"m\" x=\"%.1f\" y=\"%.0f\">%s</text>\n", to_x(a, v), y + 17,
                 tick_text(h, v, step));
  }
  pl_html_rawf(h, "<text class=\"e\" x=\"%d\" y=\"%.0f\">", PL_HTML_PLOT_W - PL_HTML_RIGHT, y + 17);
  pl_html_text(h, x_label);
  pl_html_raw(h, "</text>\n");
}

// ------------------------------------------------------------------------------------------ curves
static const char* const ink[] = {"z", "w", "v", "c4", "c5"};

static void put_curve(pl_html* h, const pl_html_axes* a, const pl_html_plot* p, int k,
                      const pl_html_rows* rows) {
  const pl_result* r = h->in->result;
  int step = rows->n / PL_HTML_DRAWN + 1;
  bool open = false;
  pl_html_rawf(h, "<path class=\"cv k%d\" style=\"stroke:var(--%s)\" d=\"", k % 5, ink[k % 5]);
  for (int i = 0; i < rows->n; i++) {
    int row = rows->at[i];
    bool corner = r->kinds.at[row] == PL_ROW_BEFORE || r->kinds.at[row] == PL_ROW_AFTER
                  || i == rows->n - 1;
    if (i % step != 0 && !corner) continue;
    double x = r->rows.at[row][p->x_column], y = r->rows.at[row][p->curves[k].column];
    bool there = isfinite(x) && isfinite(y);
    if (there) pl_html_rawf(h, "%s%.1f %.1f", open ? "L" : "M", to_x(a, x), to_y(a, y));
    open = there;
  }
  pl_html_raw(h, "\"/>\n");
}

// Names stand left of their mark, or right of it, where there is room; else the mark stands alone.
static void put_marks(pl_html* h, const pl_html_axes* a) {
  const pl_result* r = h->in->result;
  double free_from = PL_HTML_LEFT, end = PL_HTML_PLOT_W - PL_HTML_RIGHT;
  for (int i = 0; i < r->events.n && i < 40; i++) {
    const char* words = pl_html_event(h, &r->events.at[i]);
    double x = to_x(a, r->events.at[i].t), w = 6.6 * pl_utf8_width(words) + 8;
    double next = i + 1 < r->events.n ? to_x(a, r->events.at[i + 1].t) : end;
    pl_html_rawf(h, "<line class=\"ev\" x1=\"%.1f\" x2=\"%.1f\" y1=\"%d\" y2=\"%d\"/>", x, x,
                 PL_HTML_TOP - 6, PL_HTML_PLOT_H - PL_HTML_BOTTOM);
    bool left = x - w >= free_from, right = !left && x + w <= next;
    free_from = right ? x + w : x;
    if (!left && !right) continue;
    pl_html_rawf(h, "<text class=\"%s evt\" x=\"%.1f\" y=\"%d\">", left ? "e" : "",
                 left ? x - 4 : x + 4, PL_HTML_TOP + 5);
    pl_html_text(h, words);
    pl_html_raw(h, "</text>\n");
  }
}

// ------------------------------------------------------------------------------------------- plots
static const char* plot_title(pl_html* h, const pl_html_plot* p) {
  if (p->title) return with_unit(h, p->title, p->curves[0].unit);
  pl_text t = pl_text_make(h->arena);
  for (int i = 0; i < p->n_curves; i++) pl_text_addf(&t, "%s%s", i ? ", " : "", p->curves[i].name);
  return with_unit(h, pl_text_string(&t), p->curves[0].unit);
}

// What a listener hears of a plot: between which values each curve lies.
static void put_description(pl_html* h, const pl_html_plot* p, const pl_html_rows* rows,
                            const char* x_name) {
  const char* words = x_name ? pl_html_say(h, PL_BOTH("%s over %s: "))
                             : pl_html_say(h, PL_BOTH("%s over time: "));
  pl_html_attribute(h, pl_format(h->arena, words, plot_title(h, p), x_name));
  for (int k = 0; k < p->n_curves; k++) {
    pl_html_range g = range_of(h, rows, &p->curves[k].column, 1, 0);
    const char* between = pl_format(h->arena, pl_html_say(h, PL_BOTH("%s%s between %s and %s")),
                                    k ? "; " : "", p->curves[k].name, pl_html_number(h, g.lo, 4),
                                    pl_html_number(h, g.hi, 4));
    pl_html_attribute(h, between);
  }
}

static void put_plot(pl_html* h, int i, const pl_html_rows* rows) {
  const pl_html_plot* p = &h->in->plots[i];
  int column[16], n = p->n_curves < 16 ? p->n_curves : 16;
  for (int k = 0; k < n; k++) column[k] = p->curves[k].column;
  bool over_time = !p->x_name;
  const char* x_label = over_time ? (h->model->uses_units ? "t in s" : "t")
                                  : with_unit(h, p->x_name, p->x_unit);
  pl_html_axes a = {.x = range_of(h, rows, &p->x_column, 1, over_time ? 0 : 0.04),
                    .y = range_of(h, rows, column, n, 0.06)};
  pl_html_raw(h, "<div class=\"plot\"><div class=\"ph\"><b>");
  pl_html_text(h, plot_title(h, p));
  pl_html_raw(h, "</b><span class=\"rd\">");
  for (int k = 0; k < n; k++) {
    pl_html_rawf(h, "<span style=\"color:var(--%s)\">", ink[k % 5]);
    pl_html_rawf(h,
                 "<svg class=\"key\" viewBox=\"0 0 18 8\" aria-hidden=\"true\"><path class=\"cv "
                 "k%d\" style=\"stroke:var(--%s)\" d=\"M0 4H18\"/></svg>",
                 k % 5, ink[k % 5]);
    pl_html_text(h, p->curves[k].name);
    pl_html_raw(h, "<output></output></span> ");
  }
  pl_html_rawf(h,
               "</span></div>\n<svg data-p=\"%d\" viewBox=\"0 0 %d %d\" role=\"img\" aria-label=\"",
               i, PL_HTML_PLOT_W, PL_HTML_PLOT_H);
  put_description(h, p, rows, p->x_name);
  pl_html_raw(h, "\">\n");
  put_axes(h, &a, x_label);
  if (over_time) put_marks(h, &a);
  for (int k = 0; k < n; k++) put_curve(h, &a, p, k, rows);
  pl_html_raw(h, "</svg></div>\n");
}

void pl_html_plots(pl_html* h, const pl_html_rows* rows) {
  for (int i = 0; i < h->in->n_plots; i++) put_plot(h, i, rows);
}

// ----------------------------------------------------------------------------------------- numbers
const char* pl_html_floats(pl_html* h, const double* x, int n) {
  unsigned char* bytes = PL_ARRAY(h->arena, unsigned char, 4 * (size_t)n + 1);
  for (int i = 0; i < n; i++) {
    float f = (float)x[i];
    uint32_t bits;
    memcpy(&bits, &f, sizeof bits);
    for (int k = 0; k < 4; k++) bytes[4 * i + k] = (unsigned char)(bits >> 8 * k);
  }
  pl_text t = pl_text_make(h->arena);
  pl_base64_add(&t, bytes, 4 * (size_t)n);
  return pl_text_string(&t);
}

static void put_column(pl_html* h, int column, const pl_html_rows* rows, bool first) {
  double* x = PL_ARRAY(h->arena, double, rows->n + 1);
  for (int i = 0; i < rows->n; i++) x[i] = h->in->result->rows.at[rows->at[i]][column];
  pl_html_rawf(h, "%s\"%d\":\"%s\"", first ? "" : ",\n", column, pl_html_floats(h, x, rows->n));
}

// The name of a column as `sim` writes it, or as the plot line names it.
static const char* head_of(pl_html* h, int column) {
  const pl_result_column* c = &h->in->result->columns[column];
  const char *name = c->name, *unit = c->unit;
  for (int p = 0; column >= h->in->n_columns && p < h->in->n_plots; p++) {
    const pl_html_plot* plot = &h->in->plots[p];
    if (plot->x_name && plot->x_column == column) {
      name = plot->x_name;
      unit = plot->x_unit;
    }
    for (int k = 0; k < plot->n_curves; k++)
      if (plot->curves[k].column == column) {
        name = plot->curves[k].name;
        unit = plot->curves[k].unit;
      }
  }
  return unit && *unit ? pl_format(h->arena, "%s [%s]", name, unit) : name;
}

static int* used_columns(pl_html* h) {
  int* used = PL_ARRAY(h->arena, int, h->in->result->n_columns + 1);
  used[0] = 1;
  for (int p = 0; p < h->in->n_plots; p++) {
    used[h->in->plots[p].x_column] = 1;
    for (int k = 0; k < h->in->plots[p].n_curves; k++) used[h->in->plots[p].curves[k].column] = 1;
  }
  return used;
}

static void put_columns(pl_html* h, const char* key, const int* used, const pl_html_rows* rows) {
  bool first = true;
  pl_html_rawf(h, "\"%s\":{\"n\":%d,\"head\":{", key, rows->n);
  for (int c = 0; c < h->in->result->n_columns; c++) {
    if (!used[c]) continue;
    pl_html_rawf(h, "%s\"%d\":", first ? "" : ",", c);
    pl_html_json_string(h, head_of(h, c));
    first = false;
  }
  pl_html_raw(h, "},\"x\":{");
  first = true;
  for (int c = 0; c < h->in->result->n_columns; c++) {
    if (!used[c]) continue;
    put_column(h, c, rows, first);
    first = false;
  }
  pl_html_raw(h, "}}");
}

static void put_plot_list(pl_html* h) {
  pl_html_raw(h, ",\"plots\":[");
  for (int i = 0; i < h->in->n_plots; i++) {
    const pl_html_plot* p = &h->in->plots[i];
    pl_html_rawf(h, "%s{\"x\":%d,\"xl\":", i ? "," : "", p->x_column);
    pl_html_json_string(h, p->x_name              ? with_unit(h, p->x_name, p->x_unit)
                           : h->model->uses_units ? "t in s"
                                                  : "t");
    pl_html_raw(h, ",\"y\":[");
    for (int k = 0; k < p->n_curves; k++)
      pl_html_rawf(h, "%s%d", k ? "," : "", p->curves[k].column);
    pl_html_raw(h, "]}");
  }
  pl_html_raw(h, "]");
}

// All rows and all columns of `sim` are added when they were asked for.
void pl_html_plot_data(pl_html* h, const pl_html_rows* rows) {
  put_columns(h, "thin", used_columns(h), rows);
  if (h->in->data == PL_HTML_DATA_FULL) {
    int *all = PL_ARRAY(h->arena, int, h->in->result->n_columns + 1),
        *at = PL_ARRAY(h->arena, int, h->in->result->rows.n + 1);
    for (int c = 0; c < h->in->n_columns; c++) all[c] = 1;
    for (int i = 0; i < h->in->result->rows.n; i++) at[i] = i;
    pl_html_rows whole = {h->in->result->rows.n, at};
    pl_html_raw(h, ",\n");
    put_columns(h, "full", all, &whole);
  }
  put_plot_list(h);
}
