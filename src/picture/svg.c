// SVG: classes for the inks, one style sheet, coordinates with a tenth of a pixel.
#include <math.h>
#include <string.h>

#include "picture/picture_impl.h"

// Text of a model as text: markup characters escaped, control characters and broken UTF-8 left out.
void pl_svg_escape(pl_text* out, const char* text) {
  const char* end = text + strlen(text);
  while (text < end) {
    uint32_t c;
    int n = pl_utf8_decode(text, end, &c);
    if (n == 0) {
      pl_text_add(out, "\xEF\xBF\xBD");
      text++;
      continue;
    }
    bool allowed = c == '\t' || c == '\n' || (c >= 0x20 && c < 0xd800) || (c > 0xdfff && c < 0xfffe)
                   || c >= 0x10000;
    if (c == '&') pl_text_add(out, "&amp;");
    else if (c == '<') pl_text_add(out, "&lt;");
    else if (c == '>') pl_text_add(out, "&gt;");
    else if (c == '"') pl_text_add(out, "&quot;");
    else if (allowed && !(c >= 0x7f && c < 0xa0)) pl_text_add_n(out, text, (size_t)n);
    else pl_text_add(out, "\xEF\xBF\xBD");
    text += n;
  }
}

// A number with a tenth, without trailing zero.
static void add_number(pl_text* out, double x) {
  long tenths = lround(fmax(-1e7, fmin(1e7, x)) * 10);
  if (tenths < 0) pl_text_add(out, "-");
  long size = tenths < 0 ? -tenths : tenths;
  if (size % 10) pl_text_addf(out, "%ld.%ld", size / 10, size % 10);
  else pl_text_addf(out, "%ld", size / 10);
}

static void add_path(pl_text* out, const pl_stroke* s) {
  bool down = false;
  for (int i = 0; i < s->n; i++) {
    float x = s->xy[2 * i], y = s->xy[2 * i + 1];
    if (!isfinite(x) || !isfinite(y)) {
      down = false;
      continue;
    }
    pl_text_add(out, down ? " " : "M");
    add_number(out, x);
    pl_text_add(out, ",");
    add_number(out, y);
    down = true;
  }
  if (s->closed) pl_text_add(out, "Z");
}

static void add_looks(pl_text* out, const pl_stroke* s) {
  pl_text_addf(out, " class=\"pl-%s", s->line == PL_INK_NONE ? "n" : pl_ink_name[s->line]);
  if (s->fill != PL_INK_NONE) pl_text_addf(out, " plf-%s", pl_ink_name[s->fill]);
  pl_text_add(out, "\"");
  if (s->line != PL_INK_NONE && s->width != 1.5f) {
    pl_text_add(out, " stroke-width=\"");
    add_number(out, s->width);
    pl_text_add(out, "\"");
  }
  if (s->dash > 0) {
    pl_text_add(out, " stroke-dasharray=\"");
    for (int i = 0; pl_dash[s->dash][i] > 0; i++)
      pl_text_addf(out, "%s%g", i ? " " : "", (double)pl_dash[s->dash][i]);
    pl_text_add(out, "\"");
  }
  if (s->faint > 0) pl_text_addf(out, " opacity=\"%.2g\"", 1 - (double)s->faint);
}

void pl_svg_stroke(pl_text* out, const pl_stroke* s) {
  if (s->kind == PL_STROKE_TEXT) {
    static const char* const anchor[] = {"", " text-anchor=\"middle\"", " text-anchor=\"end\""};
    pl_text_addf(out, "<text class=\"plf-%s\"", pl_ink_name[s->fill]);
    if (s->turned) {
      pl_text_add(out, " transform=\"translate(");
      add_number(out, s->xy[0]);
      pl_text_add(out, ",");
      add_number(out, s->xy[1]);
      pl_text_add(out, ") rotate(-90)\"");
    } else {
      pl_text_add(out, " x=\"");
      add_number(out, s->xy[0]);
      pl_text_add(out, "\" y=\"");
      add_number(out, s->xy[1]);
      pl_text_add(out, "\"");
    }
    pl_text_addf(out, "%s font-size=\"", anchor[s->anchor]);
    add_number(out, s->size);
    pl_text_add(out, "\">");
    pl_svg_escape(out, s->text);
    pl_text_add(out, "</text>\n");
  } else if (s->kind == PL_STROKE_DISC) {
    if (!isfinite(s->xy[0]) || !isfinite(s->xy[1])) return;
    pl_text_add(out, "<circle");
    add_looks(out, s);
    pl_text_add(out, " cx=\"");
    add_number(out, s->xy[0]);
    pl_text_add(out, "\" cy=\"");
    add_number(out, s->xy[1]);
    pl_text_add(out, "\" r=\"");
    add_number(out, s->size);
    pl_text_add(out, "\"/>\n");
  } else {
    pl_text_add(out, "<path");
    add_looks(out, s);
    pl_text_add(out, " d=\"");
    add_path(out, s);
    pl_text_add(out, "\"/>\n");
  }
}

void pl_svg_strokes(pl_text* out, const pl_drawing* d, const pl_svg_style* style) {
  for (int i = 0; i < d->strokes.n; i++) pl_svg_stroke(out, &d->strokes.at[i]);
}

void pl_svg_sheet(pl_text* out, const pl_drawing* d, pl_theme theme) {
  bool line[PL_N_INKS] = {0}, fill[PL_N_INKS] = {0};
  for (int i = 0; i < d->strokes.n; i++)
    line[d->strokes.at[i].line] = fill[d->strokes.at[i].fill] = true;
  pl_text_add(out,
              "path,circle{fill:none;stroke-width:1.5;stroke-linecap:round;stroke-linejoin:round}"
              "\ntext{font-family:'DejaVu Sans',Helvetica,Arial,sans-serif}\n.pl-n{stroke:none}\n");
  for (int i = 1; i < PL_N_INKS; i++) {
    if (line[i])
      pl_text_addf(out, ".pl-%s{stroke:#%06x}\n", pl_ink_name[i], pl_ink_colour((pl_ink)i, theme));
    if (fill[i])
      pl_text_addf(out, ".plf-%s{fill:#%06x}\n", pl_ink_name[i], pl_ink_colour((pl_ink)i, theme));
  }
}

void pl_svg_write(pl_text* out, const pl_drawing* d, const pl_svg_style* style) {
  pl_text_addf(out, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %g %g\"", d->width,
               d->height);
  if (!style->inside_html) pl_text_addf(out, " width=\"%g\" height=\"%g\"", d->width, d->height);
  pl_text_add(out, " role=\"img\" aria-label=\"");
  pl_svg_escape(out, d->title);
  pl_text_add(out, "\">\n");
  if (!style->inside_html) {
    pl_text_add(out, "<title>");
    pl_svg_escape(out, d->title);
    pl_text_add(out, "</title>\n<style>\n");
    pl_svg_sheet(out, d, style->theme);
    pl_text_addf(out, "</style>\n<rect width=\"%g\" height=\"%g\" fill=\"#%06x\"/>\n", d->width,
                 d->height, pl_ink_colour(PL_INK_PAPER, style->theme));
  }
  pl_svg_strokes(out, d, style);
  pl_text_add(out, "</svg>\n");
}
