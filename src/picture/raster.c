// Drawings through cairo: PNG, PDF, and pixels for animations. cairo is asked for memory of its
// own, which is given back before anything of ours can unwind: bytes are collected by malloc and
// copied into the arena last.
#include "picture/picture_impl.h"

#ifdef PL_HAVE_CAIRO
#  include <cairo-pdf.h>
#  include <cairo.h>
#  include <math.h>
#  include <stdlib.h>
#  include <string.h>

bool pl_raster_there(void) { return true; }

static void set_ink(cairo_t* c, pl_ink ink, pl_theme theme, float faint) {
  unsigned rgb = pl_ink_colour(ink, theme);
  cairo_set_source_rgba(c, (rgb >> 16 & 255) / 255.0, (rgb >> 8 & 255) / 255.0, (rgb & 255) / 255.0,
                        1 - (double)faint);
}

static void draw_text(cairo_t* c, const pl_stroke* s, pl_theme theme) {
  cairo_text_extents_t e;
  cairo_select_font_face(c, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(c, (double)s->size);
  cairo_text_extents(c, s->text, &e);
  double shift = s->anchor == PL_ANCHOR_START    ? 0
                 : s->anchor == PL_ANCHOR_MIDDLE ? -e.x_advance / 2
                                                 : -e.x_advance;
  cairo_save(c);
  cairo_translate(c, (double)s->xy[0], (double)s->xy[1]);
  if (s->turned) cairo_rotate(c, -M_PI / 2);
  cairo_move_to(c, shift, 0);
  set_ink(c, s->fill, theme, s->faint);
  cairo_show_text(c, s->text);
  cairo_restore(c);
}

static void draw_line(cairo_t* c, const pl_stroke* s) {
  bool down = false;
  for (int i = 0; i < s->n; i++) {
    double x = (double)s->xy[2 * i], y = (double)s->xy[2 * i + 1];
    bool there = isfinite(x) && isfinite(y);
    if (there && down) cairo_line_to(c, x, y);
    else if (there) cairo_move_to(c, x, y);
    down = there;
  }
  if (s->closed) cairo_close_path(c);
}

static void draw_stroke(cairo_t* c, const pl_stroke* s, pl_theme theme) {
  if (s->kind == PL_STROKE_TEXT) {
    draw_text(c, s, theme);
    return;
  }
  cairo_new_path(c);
  if (s->kind == PL_STROKE_DISC) {
    if (!isfinite(s->xy[0]) || !isfinite(s->xy[1])) return;
    cairo_arc(c, (double)s->xy[0], (double)s->xy[1], (double)s->size, 0, 2 * M_PI);
  } else {
    draw_line(c, s);
  }
  if (s->fill != PL_INK_NONE) {
    set_ink(c, s->fill, theme, s->faint);
    cairo_fill_preserve(c);
  }
  if (s->line == PL_INK_NONE) return;
  double dash[6];
  int n = 0;
  for (; s->dash > 0 && pl_dash[s->dash][n] > 0; n++) dash[n] = (double)pl_dash[s->dash][n];
  cairo_set_dash(c, dash, n, 0);
  cairo_set_line_width(c, (double)s->width);
  set_ink(c, s->line, theme, s->faint);
  cairo_stroke(c);
}

static void draw_all(cairo_t* c, const pl_drawing* d, pl_theme theme, int frame) {
  cairo_set_line_cap(c, CAIRO_LINE_CAP_ROUND);
  cairo_set_line_join(c, CAIRO_LINE_JOIN_ROUND);
  set_ink(c, PL_INK_PAPER, theme, 0);
  cairo_paint(c);
  for (int i = 0; i < d->strokes.n; i++) {
    const pl_stroke* s = &d->strokes.at[i];
    if (s->to == 0 || (s->from <= frame && frame < s->to)) draw_stroke(c, s, theme);
  }
}

// Bytes as cairo hands them out.
typedef struct pl_collecting {
  char* at;
  size_t n, cap;
} pl_collecting;

static cairo_status_t collect(void* user, const unsigned char* bytes, unsigned n) {
  pl_collecting* c = user;
  if (c->n + n > c->cap) {
    size_t cap = c->cap ? c->cap * 2 : 1 << 16;
    while (cap < c->n + n) cap *= 2;
    char* more = realloc(c->at, cap);
    if (!more) return CAIRO_STATUS_NO_MEMORY;
    c->at = more;
    c->cap = cap;
  }
  memcpy(c->at + c->n, bytes, n);
  c->n += n;
  return CAIRO_STATUS_SUCCESS;
}

// Copies into the arena; what malloc gave is freed even when the arena has no room.
static bool hand_over(pl_arena* a, pl_collecting* c, const char** bytes, size_t* n) {
  volatile bool fine = false;
  pl_guard guard;
  PL_GUARD(a, guard) {
    *bytes = pl_copy_n(a, c->at ? c->at : "", c->n);
    *n = c->n;
    fine = true;
  }
  pl_guard_end(a, &guard);
  free(c->at);
  return fine;
}

bool pl_raster_file(const pl_drawing* d, pl_theme theme, bool pdf, const char** bytes, size_t* n) {
  pl_collecting all = {0};
  cairo_surface_t* surface =
      pdf ? cairo_pdf_surface_create_for_stream(collect, &all, d->width, d->height)
          : cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)d->width, (int)d->height);
  // the same bytes for the same input: no date in the file
  if (pdf)
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
  cairo_t* c = cairo_create(surface);
  draw_all(c, d, theme, 0);
  cairo_status_t status = cairo_status(c);
  cairo_destroy(c);
  if (pdf) {
    cairo_surface_finish(surface);
    if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(surface);
  } else if (status == CAIRO_STATUS_SUCCESS) {
    status = cairo_surface_write_to_png_stream(surface, collect, &all);
  }
  cairo_surface_destroy(surface);
  if (status != CAIRO_STATUS_SUCCESS) {
    free(all.at);
    return false;
  }
  return hand_over(d->arena, &all, bytes, n);
}

bool pl_raster_pixels(const pl_drawing* d, pl_theme theme, int frame, uint32_t* pixels) {
  int w = (int)d->width, h = (int)d->height;
  cairo_surface_t* surface = cairo_image_surface_create_for_data((unsigned char*)pixels,
                                                                 CAIRO_FORMAT_RGB24, w, h, 4 * w);
  cairo_t* c = cairo_create(surface);
  draw_all(c, d, theme, frame);
  bool fine = cairo_status(c) == CAIRO_STATUS_SUCCESS;
  cairo_destroy(c);
  cairo_surface_flush(surface);
  cairo_surface_destroy(surface);
  return fine;
}

#else

bool pl_raster_there(void) { return false; }
bool pl_raster_file(const pl_drawing* d, pl_theme theme, bool pdf, const char** bytes, size_t* n) {
  return false;
}
bool pl_raster_pixels(const pl_drawing* d, pl_theme theme, int frame, uint32_t* pixels) {
  return false;
}

#endif
