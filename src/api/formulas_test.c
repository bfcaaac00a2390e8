// Formulas as values and steps as they become ready, through pleuel.h only.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "pleuel.h"

#define PL_TEST(name) static void name(void** state)

static const char pendulum[] =
    "system \"Pendulum\"\n"
    "param m = 2 [kg], l = 50 [cm], g = 10 [m/s^2]\n"
    "coord φ\n"
    "axes x right, y up\n"
    "mass m at (l sin φ, -l cos φ)\n"
    "gravity g along -y\n"
    "ask a: solve φ''\n"
    "ask b: conserved\n";

static pleuel* ctx;
static pleuel_model* m;

static int set_up(void** state) {
  (void)state;
  ctx = pleuel_open(NULL);
  return pleuel_load_text(ctx, &m, pendulum, sizeof pendulum - 1, NULL) == PLEUEL_OK ? 0 : -1;
}

static int tear_down(void** state) {
  (void)state;
  pleuel_close(ctx);
  return 0;
}

static const pleuel_formula* acceleration(void) {
  size_t n = 0;
  assert_int_equal(pleuel_formulas(m, NULL, &n), PLEUEL_OK);
  assert_true(n >= 2);
  const pleuel_formula* f = pleuel_formula_find(m, "phi_ddot");
  assert_non_null(f);
  return f;
}

PL_TEST(a_formula_tells_what_it_answers_and_where_it_was_asked) {
  PLEUEL_OPTIONS(pleuel_formula_info, info);
  const pleuel_formula* f = acceleration();
  assert_int_equal(pleuel_formula_about(f, &info), PLEUEL_OK);
  assert_string_equal(info.letter, "a");
  assert_string_equal(info.item, "solve φ''");
  assert_string_equal(info.name, "phi_ddot");
  assert_string_equal(info.unit, "1/s^2");
  assert_true(isnan(info.number));
  assert_true(info.certified && !info.withdrawn);
  assert_int_equal(info.span.line, 7);
  assert_int_equal(info.span.end - info.span.begin, strlen("solve φ''"));
  bool phi = false;
  for (size_t i = 0; i < info.n_free; i++) phi |= strcmp(info.free[i], "phi") == 0;
  assert_true(phi && info.n_free == 3);
  assert_ptr_equal(pleuel_formula_find(m, "φ''"), f);
  assert_ptr_equal(pleuel_formula_find(m, "a"), f);
  assert_null(pleuel_formula_find(m, "nothing"));
}

PL_TEST(a_formula_is_written_in_every_notation) {
  const pleuel_formula* f = acceleration();
  assert_string_equal(pleuel_formula_text(f, PLEUEL_NOTATION_LINE), "-g sin(φ)/l");
  assert_string_equal(pleuel_formula_text(f, PLEUEL_NOTATION_EXPR), "-g*sin(phi)/l");
  assert_non_null(strstr(pleuel_formula_text(f, PLEUEL_NOTATION_LATEX), "\\sin"));
  assert_non_null(strstr(pleuel_formula_text(f, PLEUEL_NOTATION_MATHML), "<math"));
  assert_non_null(strchr(pleuel_formula_text(f, PLEUEL_NOTATION_2D), '\n'));
  const char* once = pleuel_formula_text(f, PLEUEL_NOTATION_LINE);
  assert_ptr_equal(pleuel_formula_text(f, PLEUEL_NOTATION_LINE), once);
}

static double tree_value(const pleuel_node* t, size_t i, double phi, double g, double l) {
  const pleuel_node* n = &t[i];
  double a = n->n > 0 ? tree_value(t, n->child[0], phi, g, l) : 0;
  double b = n->n > 1 ? tree_value(t, n->child[1], phi, g, l) : 0;
  double all = n->kind == PLEUEL_NODE_MULTIPLY ? 1 : 0;
  switch (n->kind) {
    case PLEUEL_NODE_NUMBER: return n->value;
    case PLEUEL_NODE_NAME:
      return strcmp(n->text, "phi") == 0 ? phi : strcmp(n->text, "g") == 0 ? g : l;
    case PLEUEL_NODE_POWER: return pow(a, b);
    case PLEUEL_NODE_CALL: return strcmp(n->text, "sin") == 0 ? sin(a) : cos(a);
    default: break;
  }
  for (size_t k = 0; k < n->n; k++) {
    double x = tree_value(t, n->child[k], phi, g, l);
    all = n->kind == PLEUEL_NODE_MULTIPLY ? all * x : all + x;
  }
  return all;
}

PL_TEST(a_formula_has_a_tree_that_can_be_walked) {
  size_t n;
  const pleuel_node* t = pleuel_formula_tree(acceleration(), &n);
  assert_non_null(t);
  for (size_t i = 0; i < n; i++) {
    for (size_t k = 0; k < t[i].n; k++) assert_true(t[i].child[k] > 0 && t[i].child[k] < n);
  }
  assert_true(fabs(tree_value(t, 0, 0.3, 7, 3) + 7 * sin(0.3) / 3) < 1e-14);
}

PL_TEST(a_formula_is_evaluated_at_a_state) {
  const pleuel_formula* f = acceleration();
  double x, numbers[2] = {0.5, 20};
  static const char* const names[] = {"φ", "g"};
  assert_int_equal(pleuel_formula_value(f, names, numbers, 2, &x), PLEUEL_OK);
  assert_true(fabs(x + 20 * sin(0.5) / 0.5) < 1e-13);
  assert_int_equal(pleuel_formula_value(f, names, numbers, 1, &x), PLEUEL_OK);
  assert_true(fabs(x + 10 * sin(0.5) / 0.5) < 1e-13);
  assert_int_equal(pleuel_formula_value(f, NULL, NULL, 0, &x), PLEUEL_USAGE);
  assert_string_equal(pleuel_message(ctx), "phi has no value");
  static const char* const unknown[] = {"nobody"};
  assert_int_equal(pleuel_formula_value(f, unknown, numbers, 1, &x), PLEUEL_USAGE);
  assert_string_equal(pleuel_message(ctx), "there is no name nobody in the formulas");
}

PL_TEST(a_derivative_is_a_formula_again) {
  const pleuel_formula *d = NULL, *again = NULL, *twice = NULL;
  assert_int_equal(pleuel_formula_derivative(acceleration(), "φ", &d), PLEUEL_OK);
  assert_string_equal(pleuel_formula_text(d, PLEUEL_NOTATION_LINE), "-g cos(φ)/l");
  assert_int_equal(pleuel_formula_derivative(acceleration(), "phi", &again), PLEUEL_OK);
  assert_ptr_equal(again, d);
  assert_int_equal(pleuel_formula_derivative(d, "l", &twice), PLEUEL_OK);
  double x, phi = 0.2;
  assert_int_equal(pleuel_formula_value(twice, (const char* const[]){"φ"}, &phi, 1, &x), PLEUEL_OK);
  assert_true(fabs(x - 10 * cos(0.2) / 0.25) < 1e-12);
  assert_int_equal(pleuel_formula_derivative(d, "nobody", &twice), PLEUEL_USAGE);
}

// ---------------------------------------------------------------------------------------- steps
typedef struct heard {
  size_t sections, steps, verdicts, passed, stop_after;
  bool in_order, placed;
  size_t last;
} heard;

static int hear(void* user, const pleuel_step* s) {
  heard* h = user;
  if (s->kind == PLEUEL_STEP_SECTION) {
    h->sections++;
    h->in_order &= h->verdicts == 0;
  } else if (s->kind == PLEUEL_STEP_VERDICT) {
    h->verdicts++;
    h->passed += (size_t)s->passed;
  } else {
    h->steps++;
    h->in_order &= s->section + 1 == h->sections && s->text && s->tex;
  }
  h->placed &= s->span.file && s->letter && (s->span.line == 7 || s->span.line == 8);
  return h->stop_after && h->sections >= h->stop_after;
}

PL_TEST(steps_come_section_by_section_then_verdicts) {
  heard h = {.in_order = true, .placed = true};
  assert_int_equal(pleuel_steps(m, NULL, hear, &h), PLEUEL_OK);
  assert_true(h.sections >= 2 && h.steps > h.sections && h.in_order && h.placed);
  assert_int_equal(h.verdicts, h.sections);
  assert_int_equal(h.passed, h.verdicts);
}

PL_TEST(a_step_can_stop_the_solution) {
  pleuel_model* other;
  assert_int_equal(pleuel_load_text(ctx, &other, pendulum, sizeof pendulum - 1, NULL), PLEUEL_OK);
  heard h = {.in_order = true, .placed = true, .stop_after = 1};
  assert_int_equal(pleuel_steps(other, NULL, hear, &h), PLEUEL_INTERRUPTED);
  assert_int_equal(h.sections, 1);
  assert_int_equal(h.verdicts, 0);
  // afterwards it can be worked out as if nothing had been
  h = (heard){.in_order = true, .placed = true};
  assert_int_equal(pleuel_steps(other, NULL, hear, &h), PLEUEL_OK);
  assert_true(h.verdicts >= 2);
  pleuel_model_free(other);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_formula_tells_what_it_answers_and_where_it_was_asked),
      cmocka_unit_test(a_formula_is_written_in_every_notation),
      cmocka_unit_test(a_formula_has_a_tree_that_can_be_walked),
      cmocka_unit_test(a_formula_is_evaluated_at_a_state),
      cmocka_unit_test(a_derivative_is_a_formula_again),
      cmocka_unit_test(steps_come_section_by_section_then_verdicts),
      cmocka_unit_test(a_step_can_stop_the_solution),
  };
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
