// picture: drawings of scenes and plots, and the files they are written to.
//
// A drawing is a list of strokes (lines, discs, texts) in pixels, y down, each with an ink; a theme
// gives inks their colours. Scenes and plots become drawings; drawings become SVG, or PNG, PDF and
// the frames of animations through cairo where it is there.
#ifndef PL_PICTURE_H
#define PL_PICTURE_H

#include "scene/scene.h"

// ---------------------------------------------------------------------------------------- drawings
typedef enum pl_ink {
#define PL_INK(id, name, light, dark, print) PL_INK_##id,
#include "inks.def"
#undef PL_INK
  PL_N_INKS
} pl_ink;

typedef enum pl_theme { PL_LIGHT, PL_DARK, PL_PRINT } pl_theme;
extern const char* const pl_ink_name[PL_N_INKS];
unsigned pl_ink_colour(pl_ink ink, pl_theme theme);  // 0xRRGGBB
enum { PL_N_SERIES = 7, PL_N_DASHES = 5 };
// lengths, ended by 0; the first is a full line
extern const float pl_dash[PL_N_DASHES][6];

typedef enum pl_stroke_kind { PL_STROKE_LINE, PL_STROKE_DISC, PL_STROKE_TEXT } pl_stroke_kind;
typedef enum pl_anchor { PL_ANCHOR_START, PL_ANCHOR_MIDDLE, PL_ANCHOR_END } pl_anchor;
typedef struct pl_stroke {
  pl_stroke_kind kind;
  pl_ink line, fill;  // PL_INK_NONE: not drawn; the ink of a text is `fill`
  float width;        // of the line
  int dash;
  float faint;  // 0 opaque .. 1 not there
  bool closed;
  int n;            // points; a NaN lifts the pen
  const float* xy;  // (n x 2)
  float size;       // radius of a disc, height of a text
  const char* text;
  pl_anchor anchor;
  bool turned;   // text from below to above
  int from, to;  // frames of an animation in which it is there; 0, 0: in all
} pl_stroke;

typedef struct pl_drawing {
  pl_arena* arena;
  double width, height;  // px
  PL_VEC(pl_stroke) strokes;
  PL_VEC(pl_stroke) taken;  // places of texts and things, for labels that keep clear of them
  bool steady;              // labels keep their distance instead of looking for a free place
  const char* title;        // description for those who cannot see it, "" if none
} pl_drawing;

pl_drawing* pl_drawing_make(pl_arena* a, double width, double height);
pl_stroke* pl_draw_line(pl_drawing* d, pl_ink ink, double width, int n, const float* xy);
pl_stroke* pl_draw_segment(pl_drawing* d, pl_ink ink, double width, double x0, double y0, double x1,
                           double y1);
pl_stroke* pl_draw_disc(pl_drawing* d, pl_ink line, pl_ink fill, double x, double y, double radius);
pl_stroke* pl_draw_text(pl_drawing* d, pl_ink ink, double size, pl_anchor anchor, double x,
                        double y, const char* text);
pl_stroke* pl_draw_box(pl_drawing* d, pl_ink line, pl_ink fill, double x, double y, double w,
                       double h);
void pl_draw_arrow(pl_drawing* d, pl_ink ink, double width, double x0, double y0, double x1,
                   double y1);
double pl_text_width(const char* text, double size);          // estimate for a sans-serif face
const char* pl_picture_label(pl_arena* a, const char* name);  // m1 as m₁, x_dot kept

// ------------------------------------------------------------------------------------------ scenes
typedef struct pl_frame_rect {
  double x, y, w, h;
} pl_frame_rect;
typedef struct pl_scene_style {
  pl_language lang;
  bool forces, velocities, trails, labels;
  bool steady;  // of an animation: labels keep their distance, trails follow what moves
} pl_scene_style;

// pl_draw_scene draws one frame of a scene into a part of the drawing.
void pl_draw_scene(pl_drawing* d, const pl_scene* scene, int frame, pl_frame_rect where,
                   const pl_scene_style* style);
// What rests, and what moves at one frame: for animations.
void pl_draw_scene_still(pl_drawing* d, const pl_scene* scene, pl_frame_rect where,
                         const pl_scene_style* style);
void pl_draw_scene_moving(pl_drawing* d, const pl_scene* scene, int frame, pl_frame_rect where,
                          const pl_scene_style* style);
double pl_scene_aspect(const pl_scene* scene);  // height over width that suits it

// ------------------------------------------------------------------------------------------- plots
typedef struct pl_curve_data {
  const char *name, *unit;
  int n;
  const double *x, *y;
} pl_curve_data;
typedef struct pl_plot_mark {
  double x;
  const char* label;
} pl_plot_mark;
typedef struct pl_plot_panel {
  const char* title;  // NULL: none
  const char *x_name, *x_unit;
  int n_curves;
  const pl_curve_data* curves;
  int n_marks;
  const pl_plot_mark* marks;  // events, where the abscissa is the time
} pl_plot_panel;
void pl_draw_plot(pl_drawing* d, const pl_plot_panel* p, pl_frame_rect where, pl_language lang);

// ------------------------------------------------------------------------------------------- files
typedef struct pl_svg_style {
  pl_theme theme;
  // classes instead of colours, no style sheet: the page gives colours to .pl-NAME
  bool inside_html;
} pl_svg_style;
void pl_svg_write(pl_text* out, const pl_drawing* d, const pl_svg_style* style);
// The strokes alone, without the svg element around them.
void pl_svg_strokes(pl_text* out, const pl_drawing* d, const pl_svg_style* style);
void pl_svg_escape(pl_text* out, const char* text);
// An animation: strokes with from < to are there in those frames, in rising order of `from`, after
// those that rest.
void pl_svg_animate(pl_text* out, const pl_drawing* d, pl_theme theme, int n_frames, double seconds,
                    int best);

// Through cairo.  false: this build has none, or it failed.  Bytes in the arena of the drawing.
bool pl_raster_there(void);
bool pl_raster_file(const pl_drawing* d, pl_theme theme, bool pdf, const char** bytes, size_t* n);
// 0x..RRGGBB, width x height
bool pl_raster_pixels(const pl_drawing* d, pl_theme theme, int frame, uint32_t* pixels);

// GIF: count the colours of all frames, then make, then hand over each frame in turn.
typedef struct pl_gif pl_gif;
enum { PL_GIF_BINS = 1 << 15 };
// count (PL_GIF_BINS)
void pl_gif_count(uint32_t* count, const uint32_t* pixels, size_t n);
// delay in 1/100 s
pl_gif* pl_gif_make(pl_arena* a, int width, int height, int delay, const uint32_t* count);
void pl_gif_frame(pl_gif* g, const uint32_t* pixels);
const char* pl_gif_end(pl_gif* g, size_t* n);

#endif
