// Shapes of a scene: their points are those of the model.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "lang/lang.h"
#include "scene/scene.h"

typedef struct bench {
  pl_arena* arena;
  pl_diagnostics diagnostics;
  pl_job job;
  const pl_scene* scene;
} bench;

// The scene of a model at its start values.
static bench* open_scene(const char* text) {
  pl_arena* a = pl_arena_make(NULL);
  bench* b = PL_NEW(a, bench);
  b->arena = a;
  b->diagnostics.arena = a;
  b->job = (pl_job){.arena = a, .diagnostics = &b->diagnostics};
  pl_model* m = NULL;
  pl_scene* scene = NULL;
  pl_scene_options how = {.forces = true, .velocities = true};
  pl_source* source = pl_source_make(a, "test.pleuel", text, strlen(text));
  assert_int_equal(pl_lang_parse(&b->job, source, NULL, NULL, 0, &m), PLEUEL_OK);
  assert_int_equal(pl_model_check(&b->job, m), PLEUEL_OK);
  assert_int_equal(pl_scene_make(&b->job, m, NULL, &how, &scene), PLEUEL_OK);
  b->scene = scene;
  return b;
}

static void close_scene(bench* b) { pl_arena_free(b->arena); }

// The only shape of a kind that belongs to something ("" for all); NULL.
static const pl_shape* shape_of(const bench* b, pl_shape_kind kind, const char* of) {
  const pl_shape* found = NULL;
  for (int i = 0; i < b->scene->n_shapes; i++) {
    const pl_shape* s = &b->scene->shapes[i];
    if (s->kind != kind || (*of && strcmp(s->of, of) != 0)) continue;
    assert_null(found);
    found = s;
  }
  return found;
}

static void is_at(const pl_shape* s, int point, double x, double y) {
  assert_non_null(s);
  assert_true(point < s->n);
  assert_float_equal(s->xy[2 * point], x, 1e-6);
  assert_float_equal(s->xy[2 * point + 1], y, 1e-6);
}

#define PENDULUM                                                                   \
  "param m = 1 [kg], l = 2 [m], g = 9.81 [m/s^2]\ncoord phi\naxes x right, y up\n" \
  "mass A: m at (l sin phi, -l cos phi)\ngravity g along -y\ninit phi = 30°, phi' = 0\n"

static void a_mass_is_where_its_coordinates_are(void** state) {
  (void)state;
  bench* b = open_scene(PENDULUM);
  is_at(shape_of(b, PL_SHAPE_MASS, "A"), 0, 1, -sqrt(3));
  assert_int_equal(b->scene->n_frames, 1);
  close_scene(b);
}

static void the_axes_of_the_model_are_turned_upright(void** state) {
  (void)state;
  bench* b = open_scene(
      "param m = 1\ncoord x, z\naxes x right, z down\nmass A: m at (x, z)\ninit x = 3, z = 2\n");
  is_at(shape_of(b, PL_SHAPE_MASS, "A"), 0, 3, -2);
  close_scene(b);
}

static void a_rod_joins_what_its_constraint_joins(void** state) {
  (void)state;
  bench* b = open_scene(
      "param m = 1, l = 5\ncoord x, y\naxes X right, Y up\nmass A: m at (x, y)\n"
      "constraint g1: x^2 + y^2 = l^2\ninit x = 3, y = -4\n");
  const pl_shape* rod = shape_of(b, PL_SHAPE_ROD, "g1");
  assert_non_null(rod);
  double dx = (double)rod->xy[2] - (double)rod->xy[0], dy = (double)rod->xy[3] - (double)rod->xy[1];
  assert_float_equal(hypot(dx, dy), 5, 1e-6);
  is_at(shape_of(b, PL_SHAPE_MASS, "A"), 0, 3, -4);
  close_scene(b);
}

static void a_spring_ends_at_its_points(void** state) {
  (void)state;
  bench* b = open_scene(
      "param m = 1, k = 2\ncoord x, y\naxes X right, Y up\nmass A: m at (x, y)\n"
      "point O at (-1, 2)\nspring k between O and A\ninit x = 3, y = 1\n");
  const pl_shape* spring = shape_of(b, PL_SHAPE_SPRING, "");
  is_at(spring, 0, -1, 2);
  is_at(spring, 1, 3, 1);
  close_scene(b);
}

static void everything_lies_in_the_box(void** state) {
  (void)state;
  bench* b = open_scene(PENDULUM);
  const float* box = b->scene->box;
  assert_true(box[0] < box[2] && box[1] < box[3]);
  for (int i = 0; i < b->scene->n_shapes; i++) {
    const pl_shape* s = &b->scene->shapes[i];
    bool thing = s->kind == PL_SHAPE_MASS || s->kind == PL_SHAPE_ROD || s->kind == PL_SHAPE_POINT;
    for (int k = 0; thing && k < s->n; k++) {
      assert_true(s->xy[2 * k] >= box[0] - 1e-6F && s->xy[2 * k] <= box[2] + 1e-6F);
      assert_true(s->xy[2 * k + 1] >= box[1] - 1e-6F && s->xy[2 * k + 1] <= box[3] + 1e-6F);
    }
  }
  close_scene(b);
}

static void drawing_commands_add_and_hide(void** state) {
  (void)state;
  bench* b = open_scene(PENDULUM "draw spring between (2, 1) and A\ndraw hide axes\n");
  const pl_shape* spring = shape_of(b, PL_SHAPE_SPRING, "");
  is_at(spring, 0, 2, 1);
  is_at(spring, 1, 1, -sqrt(3));
  for (int i = 0; i < b->scene->n_shapes; i++) {
    if (b->scene->shapes[i].kind == PL_SHAPE_AXIS) assert_false(b->scene->shapes[i].shown);
  }
  close_scene(b);
  b = open_scene(PENDULUM);
  assert_null(shape_of(b, PL_SHAPE_SPRING, ""));
  bool axes = false;
  for (int i = 0; i < b->scene->n_shapes; i++) {
    axes |= b->scene->shapes[i].kind == PL_SHAPE_AXIS && b->scene->shapes[i].shown;
  }
  assert_true(axes);
  close_scene(b);
}

static void names_are_kept_as_they_are(void** state) {
  (void)state;
  bench* b = open_scene(
      "system \"<script>alert(1)</script> & co\"\nparam m = 1\ncoord x\naxes X right\n"
      "mass A: m at (x)\ninit x = 1\n");
  assert_non_null(strstr(b->scene->description[0], "<script>alert(1)</script> & co"));
  close_scene(b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_mass_is_where_its_coordinates_are),
      cmocka_unit_test(the_axes_of_the_model_are_turned_upright),
      cmocka_unit_test(a_rod_joins_what_its_constraint_joins),
      cmocka_unit_test(a_spring_ends_at_its_points),
      cmocka_unit_test(everything_lies_in_the_box),
      cmocka_unit_test(drawing_commands_add_and_hide),
      cmocka_unit_test(names_are_kept_as_they_are),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
