// Dragging points of systems, through pleuel.h only.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "pleuel.h"

#define PL_TEST(name) static void name(void** state)

static pleuel* ctx;

static int set_up(void** state) {
  (void)state;
  ctx = pleuel_open(NULL);
  return ctx ? 0 : -1;
}

static int tear_down(void** state) {
  (void)state;
  pleuel_close(ctx);
  return 0;
}

static pleuel_model* load(const char* text) {
  pleuel_model* m = NULL;
  if (pleuel_load_text(ctx, &m, text, strlen(text), NULL) != PLEUEL_OK) {
    fail_msg("%s", pleuel_diagnostics_text(m, 7, NULL));
  }
  return m;
}

static double coordinate(const pleuel_drag* d, const char* name, bool velocity) {
  const char* const* names;
  const double *q, *v;
  size_t n;
  pleuel_drag_state(d, &names, &q, &v, &n);
  for (size_t i = 0; i < n; i++) {
    if (strcmp(names[i], name) == 0) return velocity ? v[i] : q[i];
  }
  fail_msg("there is no %s", name);
  return 0;
}

// The text with the edits of a drag.
static const char* edited(pleuel_model* m, pleuel_drag* d) {
  const pleuel_edit* edits;
  size_t n;
  if (pleuel_drag_edits(d, &edits, &n) != PLEUEL_OK) fail_msg("%s", pleuel_message(ctx));
  const char* text;
  assert_int_equal(pleuel_edited(m, edits, n, &text), PLEUEL_OK);
  return text;
}

#define HEAD \
  "param m = 1 [kg], l = 2 [m], g = 9.81 [m/s^2]\naxes x right, y up\ngravity g along -y\n"

static const char bob[] = HEAD
    "coord x, y\n"
    "mass B: m at (x, y)\n"
    "constraint rod: x^2 + y^2 = l^2\n"
    "init x = 120 [cm]   # to the right\n"
    "guess y = -1 [m]\n"
    "simulate 0..1 [s]\n";

PL_TEST(a_pendulum_is_dragged_along_its_circle) {
  pleuel_model* m = load(bob);
  pleuel_drag* d;
  assert_int_equal(pleuel_drag_open(m, "B", &d), PLEUEL_OK);
  size_t n;
  assert_true(fabs(pleuel_drag_place(d, &n)[1] + 1.6) < 1e-12);
  assert_int_equal(n, 2);
  assert_int_equal(pleuel_drag_to(d, (const double[]){-1, -5}, 2), PLEUEL_OK);
  double x = coordinate(d, "x", false), y = coordinate(d, "y", false), far = sqrt(26);
  assert_true(fabs(x * x + y * y - 4) < 1e-12);
  assert_true(fabs(x + 2 / far) < 1e-6 && fabs(y + 10 / far) < 1e-6);
  const char* text = edited(m, d);
  assert_non_null(strstr(text, "init x = -39.2232 [cm]   # to the right\n"));
  pleuel_drag_free(d);
  pleuel_model_free(m);
}

PL_TEST(the_assembly_is_kept) {
  // the knee of a two-bar chain stays on its side
  pleuel_model* m = load(HEAD
                         "coord x, y, u\nmass A: m at (x, y)\nmass B: m at (u, 0)\n"
                         "constraint a: x^2 + y^2 = l^2\nconstraint b: (u - x)^2 + y^2 = l^2\n"
                         "init u = 3 [m]\nguess y = 1 [m]\nsimulate 0..1 [s]\n");
  pleuel_drag* d;
  assert_int_equal(pleuel_drag_open(m, "B", &d), PLEUEL_OK);
  for (double u = 3; u > 0.5; u -= 0.5) {
    assert_int_equal(pleuel_drag_to(d, (const double[]){u, 0}, 2), PLEUEL_OK);
    assert_true(fabs(coordinate(d, "u", false) - u) < 1e-9);
    assert_true(coordinate(d, "y", false) > 0);
  }
  // beyond its reach it stays stretched, and comes back
  assert_int_equal(pleuel_drag_to(d, (const double[]){9, 0}, 2), PLEUEL_OK);
  assert_true(fabs(coordinate(d, "u", false) - 4) < 1e-3);
  pleuel_drag_free(d);
  pleuel_model_free(m);
}

PL_TEST(a_point_that_is_held_is_refused_with_a_sentence) {
  pleuel_model* m = load(HEAD
                         "coord x, y\nmass B: m at (x, y)\npoint O at (0, 0)\nconstraint a: x = 1\n"
                         "constraint b: y = 0\nsimulate 0..1 [s]\n");
  pleuel_drag* d;
  assert_int_equal(pleuel_drag_open(m, "B", &d), PLEUEL_UNSUPPORTED);
  assert_null(d);
  assert_string_equal(pleuel_message(ctx),
                      "B cannot be dragged: the constraints hold it where it is");
  assert_int_equal(pleuel_drag_open(m, "O", &d), PLEUEL_UNSUPPORTED);
  assert_int_equal(pleuel_drag_open(m, "Q", &d), PLEUEL_USAGE);
  assert_string_equal(pleuel_message(ctx), "there is no mass, body or point Q");
  pleuel_model_free(m);
}

PL_TEST(a_contact_that_is_closed_stays_and_a_wall_is_not_run_through) {
  pleuel_model* m = load(
      HEAD
      "coord x, y\nmass B: m at (x, y)\nconstraint floor: y >= 0\nconstraint wall: x <= 3\n"
      "init x = 1 [m], y = 0 [m]\nsimulate 0..1 [s]\n");
  pleuel_drag* d;
  assert_int_equal(pleuel_drag_open(m, "B", &d), PLEUEL_OK);
  assert_int_equal(pleuel_drag_to(d, (const double[]){2, -1}, 2), PLEUEL_OK);
  assert_true(fabs(coordinate(d, "x", false) - 2) < 1e-9
              && fabs(coordinate(d, "y", false)) < 1e-12);
  assert_int_equal(pleuel_drag_to(d, (const double[]){5, 0}, 2), PLEUEL_OK);
  assert_true(coordinate(d, "x", false) <= 3 + 1e-12 && coordinate(d, "x", false) > 2.5);
  pleuel_drag_free(d);
  pleuel_model_free(m);
}

PL_TEST(a_point_is_thrown_along_its_constraint) {
  pleuel_model* m = load(HEAD
                         "coord φ\nmass B: m at (l sin φ, -l cos φ)\ninit φ = 30°, φ' = 0.5 "
                         "[rad/s]\nsimulate 0..1 [s]\n");
  pleuel_drag* d;
  assert_int_equal(pleuel_drag_open(m, "B", &d), PLEUEL_OK);
  double along[2] = {4 * cos(0.5235987755982988), 4 * sin(0.5235987755982988)};
  assert_int_equal(pleuel_drag_throw(d, along, 2), PLEUEL_OK);
  assert_true(fabs(coordinate(d, "phi", true) - 2) < 1e-9);
  assert_int_equal(pleuel_drag_to(d, (const double[]){2, 0}, 2), PLEUEL_OK);
  assert_true(fabs(coordinate(d, "phi", false) - 1.5707963267948966) < 1e-6);
  const char* text = edited(m, d);
  assert_non_null(strstr(text, "init φ = 90°, φ' = 2 [rad/s]\n"));
  pleuel_drag_free(d);
  pleuel_model_free(m);
}

PL_TEST(what_the_text_does_not_say_gets_a_line) {
  pleuel_model* m = load(
      HEAD
      "coord θ1, θ2\npoint K at (l sin θ1, -l cos θ1)\nmass A: m at (l sin θ1, -l cos θ1)\n"
      "mass B: m at (l sin θ1 + l sin θ2, -l cos θ1 - l cos θ2)\ninit θ1 = 0.1 [rad]\nsimulate "
      "0..1 "
      "[s]\n");
  pleuel_drag* d;
  assert_int_equal(pleuel_drag_open(m, "B", &d), PLEUEL_OK);
  assert_int_equal(pleuel_drag_to(d, (const double[]){2, -2.5}, 2), PLEUEL_OK);
  size_t n;
  const double* at = pleuel_drag_place(d, &n);
  assert_true(fabs(at[0] - 2) < 1e-9 && fabs(at[1] + 2.5) < 1e-9);
  const char* text = edited(m, d);
  assert_non_null(strstr(text, "\ninit θ2 = "));
  pleuel_drag_free(d);
  pleuel_model_free(m);
}

PL_TEST(arguments_that_make_no_sense_are_refused) {
  pleuel_model* m = load(bob);
  pleuel_drag* d;
  assert_int_equal(pleuel_drag_open(m, "B", &d), PLEUEL_OK);
  assert_int_equal(pleuel_drag_to(d, (const double[]){1, 2, 3}, 3), PLEUEL_USAGE);
  assert_int_equal(pleuel_drag_to(d, (const double[]){1, NAN}, 2), PLEUEL_USAGE);
  assert_int_equal(pleuel_drag_to(NULL, NULL, 0), PLEUEL_USAGE);
  pleuel_drag_free(d);
  pleuel_drag_free(NULL);
  pleuel_model_free(m);
}

// ---------------------------------------------------------------------------------------- law
#define PLAIN "param m = 1, l = 2, g = 9.81\naxes x right, y up\ngravity g along -y\n"

static const char* const examples[][2] = {
    {"Pendulum", PLAIN "coord x, y\nmass B: m at (x, y)\nconstraint r: x^2 + y^2 = l^2\ninit x = "
                       "1\nguess y = -1\nsimulate 0..1\n"},
    {"Angle", PLAIN "coord φ\nmass B: m at (l sin φ, -l cos φ)\ninit φ = 1\nsimulate 0..1\n"},
    {"Double", PLAIN "coord a, b\nmass A: m at (l sin a, -l cos a)\nmass B: m at (l sin a + l sin "
                     "b, -l cos a - l cos b)\n"
                     "init a = 0.5, b = 1\nsimulate 0..1\n"},
    {"Crank",
     PLAIN "coord x, y, u\nmass A: m at (x, y)\nmass B: m at (u, 0)\nconstraint a: x^2 + y^2 = 1\n"
           "constraint b: (u - x)^2 + y^2 = 4\ninit x = 0.2\nguess y = 1, u = 2\nsimulate 0..1\n"},
    {"Four bar", PLAIN
     "coord x, y, u, w\nmass A: m at (x, y)\nmass B: m at (u, w)\nconstraint a: x^2 + y^2 = 1\n"
     "constraint b: (u - x)^2 + (w - y)^2 = 9\nconstraint c: (u - 3)^2 + w^2 = 4\ninit x = 0.3\n"
     "guess y = 1, u = 3, w = 2\nsimulate 0..1\n"},
    {"Atwood", PLAIN "coord a, c\nmass B: m at (0, -a)\nmass C: 2 m at (1, -c)\nconstraint rope: a "
                     "+ c = l\ninit a = 1\nsimulate 0..1\n"},
    {"Wedge", PLAIN "coord s, u\nmass W: m at (u, 0)\nmass B: m at (u + s cos(0.5), -s "
                    "sin(0.5))\ninit s = 1, u = 0\nsimulate 0..1\n"},
    {"Bead",
     PLAIN "coord x, y\nmass B: m at (x, y)\nconstraint c: y = x^2\ninit x = 0.5\nsimulate 0..1\n"},
    {"Body", PLAIN
     "coord x, y, φ\nbody K: mass m, inertia 1 at (x, y) angle φ\npoint B on K at (0.5, 0)\npoint "
     "P on K at (-1, 0)\n"
     "constraint h: x(P) = 0\nconstraint v: y(P) = 0\ninit φ = 0.3\nguess x = 1\nsimulate 0..1\n"},
    {"Polar", PLAIN "coord r, φ\nmass B: m at polar(r, φ)\ninit r = 2, φ = 0.4\nsimulate 0..1\n"},
};

static uint64_t random_state = 20261122;
static double random_unit(void) {
  random_state = random_state * 6364136223846793005u + 1442695040888963407u;
  return (double)(random_state >> 11) / 9007199254740992.0;
}

static void copy_state(const pleuel_drag* d, double* out, size_t* n) {
  const double* q;
  pleuel_drag_state(d, NULL, &q, NULL, n);
  memcpy(out, q, *n * sizeof *out);
}

// The constraints of the models above, by name.
static double worst_residual(const char* name, const pleuel_drag* d) {
#define Q(n) coordinate(d, n, false)
  if (strcmp(name, "Pendulum") == 0) return fabs(Q("x") * Q("x") + Q("y") * Q("y") - 4);
  if (strcmp(name, "Crank") == 0) {
    double a = Q("x") * Q("x") + Q("y") * Q("y") - 1,
           b = pow(Q("u") - Q("x"), 2) + pow(Q("y"), 2) - 4;
    return fmax(fabs(a), fabs(b));
  }
  if (strcmp(name, "Four bar") == 0) {
    double a = Q("x") * Q("x") + Q("y") * Q("y") - 1;
    double b = pow(Q("u") - Q("x"), 2) + pow(Q("w") - Q("y"), 2) - 9,
           c = pow(Q("u") - 3, 2) + pow(Q("w"), 2) - 4;
    return fmax(fabs(a), fmax(fabs(b), fabs(c)));
  }
  if (strcmp(name, "Atwood") == 0) return fabs(Q("a") + Q("c") - 2);
  if (strcmp(name, "Bead") == 0) return fabs(Q("y") - Q("x") * Q("x"));
  if (strcmp(name, "Body") == 0)
    return fmax(fabs(Q("x") - cos(Q("phi"))), fabs(Q("y") - sin(Q("phi"))));
#undef Q
  return 0;
}

// A random drag keeps the constraints, ends as near as a drag in many small moves, which is what a
// hand does, and no step of it jumps to another assembly.
PL_TEST(random_drags_keep_constraints_and_assembly) {
  for (size_t k = 0; k < sizeof examples / sizeof *examples; k++) {
    pleuel_model* m = load(examples[k][1]);
    for (int trial = 0; trial < 10; trial++) {
      pleuel_drag *d, *slow;
      assert_int_equal(pleuel_drag_open(m, "B", &d), PLEUEL_OK);
      assert_int_equal(pleuel_drag_open(m, "B", &slow), PLEUEL_OK);
      size_t n, c;
      double from[3], to[3], q[8], other[8];
      memcpy(from, pleuel_drag_place(d, &n), sizeof from);
      for (size_t i = 0; i < n; i++) to[i] = from[i] + 1.2 * (random_unit() - 0.5);
      assert_int_equal(pleuel_drag_to(d, to, n), PLEUEL_OK);
      double worst = worst_residual(examples[k][0], d);
      if (!(worst < 1e-12)) fail_msg("%s: residual %g", examples[k][0], worst);
      for (int i = 1; i <= 60; i++) {
        double part[3];
        for (size_t j = 0; j < n; j++) part[j] = from[j] + (to[j] - from[j]) * i / 60;
        assert_int_equal(pleuel_drag_to(slow, part, n), PLEUEL_OK);
      }
      const double *a = pleuel_drag_place(d, &n), *b = pleuel_drag_place(slow, &n);
      copy_state(d, q, &c);
      copy_state(slow, other, &c);
      double apart = 0, before = 0, after = 0;
      for (size_t i = 0; i < n; i++) {
        apart = fmax(apart, fabs(a[i] - b[i]));
        before += pow(from[i] - to[i], 2);
        after += pow(a[i] - to[i], 2);
      }
      if (after > before * (1 + 1e-9)) fail_msg("%s: farther than before", examples[k][0]);
      if (apart > 2e-3)
        fail_msg("%s: %g apart from the same way in small moves", examples[k][0], apart);
      for (size_t i = 0; i < c; i++) {
        if (fabs(q[i] - other[i]) > 0.1)
          fail_msg("%s: another assembly: %g and %g", examples[k][0], q[i], other[i]);
      }
      pleuel_drag_free(d);
      pleuel_drag_free(slow);
    }
    pleuel_model_free(m);
  }
}

// The edited text starts where the drag ended.
PL_TEST(the_edits_of_random_drags_write_their_start) {
  for (size_t k = 0; k < sizeof examples / sizeof *examples; k++) {
    pleuel_model* m = load(examples[k][1]);
    pleuel_drag *d, *then;
    assert_int_equal(pleuel_drag_open(m, "B", &d), PLEUEL_OK);
    size_t n, c;
    double to[3], q[8], started[8];
    memcpy(to, pleuel_drag_place(d, &n), sizeof to);
    for (size_t i = 0; i < n; i++) to[i] += 0.6 * (random_unit() - 0.5);
    assert_int_equal(pleuel_drag_to(d, to, n), PLEUEL_OK);
    copy_state(d, q, &c);
    char text[2048];
    snprintf(text, sizeof text, "%s", edited(m, d));
    pleuel_model* written = load(text);
    assert_int_equal(pleuel_drag_open(written, "B", &then), PLEUEL_OK);
    copy_state(then, started, &c);
    for (size_t i = 0; i < c; i++) {
      if (fabs(q[i] - started[i]) > 1e-4)
        fail_msg("%s: starts at %g, not at %g\n%s", examples[k][0], started[i], q[i], text);
    }
    pleuel_drag_free(d);
    pleuel_drag_free(then);
    pleuel_model_free(written);
    pleuel_model_free(m);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_pendulum_is_dragged_along_its_circle),
      cmocka_unit_test(the_assembly_is_kept),
      cmocka_unit_test(a_point_that_is_held_is_refused_with_a_sentence),
      cmocka_unit_test(a_contact_that_is_closed_stays_and_a_wall_is_not_run_through),
      cmocka_unit_test(a_point_is_thrown_along_its_constraint),
      cmocka_unit_test(what_the_text_does_not_say_gets_a_line),
      cmocka_unit_test(arguments_that_make_no_sense_are_refused),
      cmocka_unit_test(random_drags_keep_constraints_and_assembly),
      cmocka_unit_test(the_edits_of_random_drags_write_their_start),
  };
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
