// A drawing that runs by itself: each frame is a group that a CSS animation shows for its moment.
// Whoever asked for reduced motion, or has no animation, sees the one frame that tells most.
#include <math.h>

#include "picture/picture_impl.h"

void pl_svg_animate(pl_text* out, const pl_drawing* d, pl_theme theme, int n_frames, double seconds,
                    int best) {
  pl_text_addf(out,
               "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %g %g\" width=\"%g\" "
               "height=\"%g\" role=\"img\" aria-label=\"",
               d->width, d->height, d->width, d->height);
  pl_svg_escape(out, d->title);
  pl_text_add(out, "\">\n<title>");
  pl_svg_escape(out, d->title);
  pl_text_add(out, "</title>\n<style>\n");
  pl_svg_sheet(out, d, theme);
  pl_text_addf(out, "g.f{visibility:hidden;animation:pl-show %.6gs step-end infinite}\n", seconds);
  pl_text_addf(
      out,
      "@keyframes "
      "pl-show{0%%{visibility:visible}%.6g%%{visibility:hidden}100%%{visibility:hidden}}\n",
      100.0 / n_frames);
  pl_text_add(
      out,
      "@media "
      "(prefers-reduced-motion:reduce){g.f{animation:none}g.b{visibility:visible}}\n</style>\n");
  pl_text_addf(out, "<rect width=\"%g\" height=\"%g\" fill=\"#%06x\"/>\n", d->width, d->height,
               pl_ink_colour(PL_INK_PAPER, theme));
  int frame = -1;
  for (int i = 0; i < d->strokes.n; i++) {
    const pl_stroke* s = &d->strokes.at[i];
    int its = s->to == 0 ? -1 : s->from;
    if (its != frame && frame >= 0) pl_text_add(out, "</g>\n");
    if (its != frame && its >= 0) {
      pl_text_addf(out, "<g class=\"f%s\" style=\"animation-delay:%.5gs\">\n",
                   its == best ? " b" : "", seconds * its / n_frames - seconds);
    }
    frame = its;
    pl_svg_stroke(out, s);
  }
  if (frame >= 0) pl_text_add(out, "</g>\n");
  pl_text_add(out, "</svg>\n");
}
