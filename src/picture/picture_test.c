// Drawings: where strokes lie, what a frame of a scene becomes, and that no text of a model leaves
// its element.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "picture/picture.h"

static const pl_frame_rect whole = {0, 0, 400, 300};

static const char* svg_of(pl_arena* a, const pl_drawing* d) {
  pl_text out = pl_text_make(a);
  pl_svg_write(&out, d, &(pl_svg_style){.theme = PL_LIGHT});
  return pl_text_string(&out);
}

static int count(const char* text, const char* part) {
  int n = 0;
  for (const char* at = strstr(text, part); at; at = strstr(at + 1, part)) n++;
  return n;
}

static void hostile_text_stays_text(void** state) {
  (void)state;
  pl_arena* a = pl_arena_make(NULL);
  pl_drawing* d = pl_drawing_make(a, 100, 100);
  d->title = "</title><script>alert(1)</script>";
  pl_draw_text(d, PL_INK_TEXT, 12, PL_ANCHOR_START, 1, 2,
               "</text><script src=\"x\">&amp;\x01\xff</script>");
  const char* svg = svg_of(a, d);
  assert_null(strstr(svg, "<script"));
  assert_null(strstr(svg, "\x01"));
  assert_null(strstr(svg, "\xff"));
  assert_non_null(strstr(svg, "&lt;script"));
  assert_non_null(strstr(svg, "&amp;amp;"));
  assert_int_equal(count(svg, "</text>"), 1);
  assert_int_equal(count(svg, "</title>"), 1);
  pl_arena_free(a);
}

static void every_special_character_is_escaped(void** state) {
  (void)state;
  pl_arena* a = pl_arena_make(NULL);
  pl_text out = pl_text_make(a);
  pl_svg_escape(&out, "a<b>&\"φ₁");
  assert_string_equal(pl_text_string(&out), "a&lt;b&gt;&amp;&quot;φ₁");
  pl_arena_free(a);
}

static void strokes_keep_their_points(void** state) {
  (void)state;
  pl_arena* a = pl_arena_make(NULL);
  pl_drawing* d = pl_drawing_make(a, 100, 100);
  pl_stroke* s = pl_draw_segment(d, PL_INK_TEXT, 2, 10, 20, 30, 40);
  assert_int_equal(s->n, 2);
  assert_float_equal(s->xy[0], 10, 0);
  assert_float_equal(s->xy[3], 40, 0);
  assert_int_equal(d->strokes.n, 1);
  pl_stroke* disc = pl_draw_disc(d, PL_INK_NONE, PL_INK_TEXT, 50, 60, 7);
  assert_float_equal(disc->size, 7, 0);
  assert_int_equal(disc->kind, PL_STROKE_DISC);
  pl_arena_free(a);
}

static void a_point_without_a_place_is_not_written(void** state) {
  (void)state;
  pl_arena* a = pl_arena_make(NULL);
  pl_drawing* d = pl_drawing_make(a, 100, 100);
  pl_draw_disc(d, PL_INK_NONE, PL_INK_TEXT, (double)NAN, 60, 7);
  const float xy[] = {1, 2, NAN, NAN, 5, 6, 7, 8};
  pl_draw_line(d, PL_INK_TEXT, 1, 4, xy);
  const char* svg = svg_of(a, d);
  assert_null(strstr(svg, "nan"));
  assert_null(strstr(svg, "<circle"));
  pl_arena_free(a);
}

// A mass at the left end of a rod, drawn into a rectangle: left in the picture is left in the
// model, up is up, and both axes have one scale.
static void a_scene_keeps_its_directions_and_its_scale(void** state) {
  (void)state;
  pl_arena* a = pl_arena_make(NULL);
  const float mass[] = {-1, 0}, other[] = {1, 1}, rod[] = {-1, 0, 1, 1};
  const pl_shape shapes[] = {
      {.kind = PL_SHAPE_ROD, .label = "", .of = "", .n = 2, .xy = rod, .shown = true},
      {.kind = PL_SHAPE_MASS, .label = "A", .of = "A", .n = 1, .xy = mass, .shown = true},
      {.kind = PL_SHAPE_MASS, .label = "B", .of = "B", .n = 1, .xy = other, .shown = true},
  };
  const double t = 0;
  const pl_scene scene = {.n_shapes = 3,
                          .shapes = shapes,
                          .n_frames = 1,
                          .t = &t,
                          .box = {-1.5F, -0.5F, 1.5F, 1.5F},
                          .description = {"", ""}};
  pl_drawing* d = pl_drawing_make(a, 400, 300);
  pl_draw_scene(d, &scene, 0, whole, &(pl_scene_style){.labels = true});
  const pl_stroke *disc[2] = {NULL, NULL}, *line = NULL;
  int n = 0;
  for (int k = 0; k < d->strokes.n; k++) {
    const pl_stroke* s = &d->strokes.at[k];
    if (s->kind == PL_STROKE_DISC && n < 2) disc[n++] = s;
    if (s->kind == PL_STROKE_LINE && s->n == 2 && !line) line = s;
  }
  assert_int_equal(n, 2);
  float dx = disc[1]->xy[0] - disc[0]->xy[0], dy = disc[1]->xy[1] - disc[0]->xy[1];
  assert_true(dx > 0 && dy < 0);
  assert_float_equal(dx, -2 * dy, 1e-3);
  for (int k = 0; k < 2; k++) {
    assert_true(disc[k]->xy[0] > 0 && disc[k]->xy[0] < 400);
    assert_true(disc[k]->xy[1] > 0 && disc[k]->xy[1] < 300);
  }
  assert_non_null(line);
  pl_arena_free(a);
}

static void what_is_hidden_is_not_drawn(void** state) {
  (void)state;
  pl_arena* a = pl_arena_make(NULL);
  const float mass[] = {0, 0};
  pl_shape shape = {.kind = PL_SHAPE_MASS, .label = "", .of = "A", .n = 1, .xy = mass};
  const double t = 0;
  const pl_scene scene = {.n_shapes = 1,
                          .shapes = &shape,
                          .n_frames = 1,
                          .t = &t,
                          .box = {-1, -1, 1, 1},
                          .description = {"", ""}};
  pl_drawing* d = pl_drawing_make(a, 400, 300);
  pl_draw_scene(d, &scene, 0, whole, &(pl_scene_style){.labels = true});
  int hidden = d->strokes.n;
  shape.shown = true;
  pl_draw_scene(d, &scene, 0, whole, &(pl_scene_style){.labels = true});
  assert_int_equal(hidden, 0);
  assert_true(d->strokes.n > 0);
  pl_arena_free(a);
}

static void a_plot_stays_in_its_rectangle(void** state) {
  (void)state;
  pl_arena* a = pl_arena_make(NULL);
  const double x[] = {0, 1, 2, 3}, y[] = {-1e9, 4, (double)NAN, 1e9};
  const pl_curve_data curve = {.name = "x", .unit = "m", .n = 4, .x = x, .y = y};
  const pl_plot_panel panel = {.x_name = "t", .x_unit = "s", .n_curves = 1, .curves = &curve};
  pl_drawing* d = pl_drawing_make(a, 400, 300);
  pl_draw_plot(d, &panel, whole, PL_ENGLISH);
  int lines = 0;
  for (int k = 0; k < d->strokes.n; k++) {
    const pl_stroke* s = &d->strokes.at[k];
    for (int i = 0; s->kind == PL_STROKE_LINE && i < s->n; i++) {
      if (isnan(s->xy[2 * i])) continue;
      assert_true(s->xy[2 * i] > -1 && s->xy[2 * i] < 401);
      assert_true(s->xy[2 * i + 1] > -1 && s->xy[2 * i + 1] < 301);
    }
    lines += s->kind == PL_STROKE_LINE;
  }
  assert_true(lines > 0);
  pl_arena_free(a);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(hostile_text_stays_text),
      cmocka_unit_test(every_special_character_is_escaped),
      cmocka_unit_test(strokes_keep_their_points),
      cmocka_unit_test(a_point_without_a_place_is_not_written),
      cmocka_unit_test(a_scene_keeps_its_directions_and_its_scale),
      cmocka_unit_test(what_is_hidden_is_not_drawn),
      cmocka_unit_test(a_plot_stays_in_its_rectangle),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
