// Formulas that are false are seen by the motion: each kind of answer is made false and held
// against it.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "api/api_impl.h"
#include "witness/witness.h"

typedef struct bench {
  pleuel* ctx;
  pleuel_model* m;
  pl_solution* s;
} bench;

static bench solved(const char* text) {
  bench b = {.ctx = pleuel_open(NULL)};
  const char* answer = NULL;
  assert_int_equal(pleuel_load_text(b.ctx, &b.m, text, strlen(text), NULL), PLEUEL_OK);
  pleuel_solve_text(b.m, &answer, NULL);
  b.s = b.m->solution;
  assert_non_null(b.s);
  return b;
}

static void done(bench* b) { pleuel_close(b->ctx); }

static const pl_check* last_check(const bench* b) { return &b->s->checks.at[b->s->checks.n - 1]; }

static pl_value* value_named(const bench* b, const char* name, pl_section** of) {
  for (int i = 0; i < b->s->sections.n; i++) {
    for (int k = 0; k < b->s->sections.at[i].values.n; k++) {
      *of = &b->s->sections.at[i];
      if (strcmp((*of)->values.at[k].name, name) == 0) return &(*of)->values.at[k];
    }
  }
  fail_msg("there is no value %s", name);
  return NULL;
}

// Multiplies a formula by a factor close to one and asks the motion again.
static void is_seen(const char* text, const char* name) {
  bench b = solved(text);
  assert_string_equal(last_check(&b)->name[0], "formulas against the motion");
  assert_true(last_check(&b)->passed);
  assert_true(last_check(&b)->formulas > 0 && last_check(&b)->starts >= 1);
  pl_section* section = NULL;
  pl_value* v = value_named(&b, name, &section);
  pl_pool* p = b.s->model->pool;
  v->expr = pl_mul(p, v->expr,
                   pl_add(p, pl_ratio(p, 1001, 1000),
                          pl_mul(p, pl_ratio(p, 1, 1000), pl_square(p, pl_sym(p, pl_time(p))))));
  if (pl_is_zero_node(p, v->expr)) v->expr = pl_ratio(p, 1, 100);
  b.s->checks.n = 0;
  pl_witness_hold(&b.m->job, b.s, NULL, 0);
  assert_false(last_check(&b)->passed);
  assert_string_equal(last_check(&b)->failed_on, name);
  assert_true(section->withdrawn && v->withdrawn);
  assert_true(pl_is_poison(v->expr) && v->form == NULL && isnan(v->number));
  assert_true(section->steps.n == 2 && section->steps.at[0].words[0] != NULL
              && section->steps.at[0].words[1] != NULL);
  done(&b);
}

#define PENDULUM                                                               \
  "param m = 1 [kg], l = 1/2 [m], g = 9.81 [m/s^2]\ncoord r, φ\n"             \
  "axes x right, y up\nmass m at (r sin φ, -r cos φ)\n"                      \
  "gravity g along -y\nconstraint rod: r = l\ninit φ = 40°, φ' = 1 [1/s]\n" \
  "simulate 0..1 [s]\n"

static void a_false_acceleration(void** state) {
  (void)state;
  is_seen(PENDULUM "ask solve φ''\n", "phi_ddot");
  is_seen(PENDULUM "ask lagrange2\n", "phi_ddot");
}

static void a_false_multiplier(void** state) {
  (void)state;
  is_seen(PENDULUM "ask solve λ_rod\n", "lambda_rod");
  is_seen(PENDULUM "ask force of rod\n", "lambda_rod");
}

// Of the force in a section, with the multiplier beside it as it was.
static void a_false_component_is_seen(const char* text, int which) {
  bench b = solved(text);
  assert_true(last_check(&b)->passed);
  pl_section* section = NULL;
  pl_value* v = value_named(&b, "Z", &section);
  assert_true(which < v->n_components);
  pl_pool* p = b.s->model->pool;
  pl_component* c = &v->components[which];
  c->expr = pl_mul(p, pl_ratio(p, 1001, 1000), c->expr);
  pl_witness_hold(&b.m->job, b.s, NULL, 0);
  assert_false(last_check(&b)->passed);
  assert_string_equal(last_check(&b)->failed_on, "force(rod)");
  assert_true(section->withdrawn);
  done(&b);
}

static void a_false_component_of_a_force(void** state) {
  (void)state;
  static const char cartesian[] =
      "param m = 1 [kg], l = 1/2 [m], g = 9.81 [m/s^2]\ncoord x, y\naxes x right, y up\n"
      "mass m at (x, y)\ngravity g along -y\nconstraint rod: x^2 + y^2 = l^2\n"
      "init x = 0.3 [m], y = -0.4 [m], x' = 1 [m/s]\nsimulate 0..1 [s]\nask force of rod\n";
  a_false_component_is_seen(PENDULUM "ask force of rod\n", 0);
  a_false_component_is_seen(PENDULUM "ask force on m\n", 0);
  a_false_component_is_seen(PENDULUM "ask force of rod from φ = 60° at rest\n", 0);
  a_false_component_is_seen(cartesian, 0);
  a_false_component_is_seen(cartesian, 1);
}

// A value that no single motion tells, in per mille of what it was.
static void a_false_value_is_seen(const char* text, const char* name, int per_mille) {
  bench b = solved(text);
  assert_true(last_check(&b)->passed);
  pl_section* section = NULL;
  pl_value* v = value_named(&b, name, &section);
  v->expr = pl_mul(b.s->model->pool, pl_ratio(b.s->model->pool, per_mille, 1000), v->expr);
  pl_witness_hold(&b.m->job, b.s, NULL, 0);
  assert_false(last_check(&b)->passed);
  assert_string_equal(last_check(&b)->failed_on, name);
  assert_true(section->withdrawn);
  done(&b);
}

#define TWO_MASSES                                                                     \
  "param m1 = 2 [kg], m2 = 1 [kg], g = 9.81 [m/s^2]\ncoord x, y\naxes x right, y up\n" \
  "mass A: m1 at (x, 0)\nmass B: m2 at (0, y)\ngravity g along -y\n"                   \
  "constraint string: x + y = 1\ninit x = 0.5, x' = 0\nsimulate 0..1 [s]\n"

static void a_false_limit(void** state) {
  (void)state;
  a_false_value_is_seen(TWO_MASSES "ask limit m1 -> 0 of x''\n", "x_ddot", 1001);
  a_false_value_is_seen(TWO_MASSES "ask limit m2 -> ∞ of x''\n", "x_ddot", 1001);
  a_false_value_is_seen(TWO_MASSES "ask limit m1 = m2 of λ_string\n", "lambda_string", 1001);
  a_false_value_is_seen(TWO_MASSES "ask limit m1 >> m2 of x''\n", "x_ddot", 1001);
  a_false_value_is_seen(TWO_MASSES "ask series m2 -> 0 of x''\n", "x_ddot", 1001);
  a_false_value_is_seen(TWO_MASSES "ask series m1 = m2 + δm, δm -> 0 of x''\n", "x_ddot", 1001);
}

static void a_false_frequency(void** state) {
  (void)state;
  static const char turning[] =
      "param m = 1 [kg], k = 3 [N/m], b = 0.7 [kg/s]\ncoord x, y\naxes x right, y up\n"
      "mass m at (x, y)\npotential 1/2 k x^2 + k y^2 + b x y'\ninit x = 0.1, y = 0\n"
      "simulate 0..1 [s]\nask modes at (x = 0, y = 0)\n";
  a_false_value_is_seen(PENDULUM "ask modes\n", "omega^2", 1001);
  a_false_value_is_seen(PENDULUM "ask equilibria\n", "omega^2", 1001);
  a_false_value_is_seen(turning, "omega^2", 1001);
  // damping is left out, what turns is not
  a_false_value_is_seen(
      "coord u, v\nlagrangian u'^2/2 - u^2 + v'^2 - v^2/2 + u v'/3\n"
      "rayleigh u'^2/5\ninit u = 0.5, v = 0.1\nsimulate 0..1\nask modes\n",
      "omega^2", 1001);
}

static void a_false_threshold(void** state) {
  (void)state;
  a_false_value_is_seen(
      "param m = 1 [kg], l = 1 [m], g = 9.81 [m/s^2], k = 20 [N m]\ncoord φ\n"
      "axes x right, y up\nmass m at (l sin φ, l cos φ)\ngravity g along -y\n"
      "potential 1/2 k φ^2\ninit φ = 0.1\nsimulate 0..1 [s]\n"
      "ask threshold k of stable at φ = 0\n",
      "k", 1100);
}

static void a_false_constant_of_the_motion(void** state) {
  (void)state;
  is_seen(PENDULUM "ask conserved\n", "E");
}

static void a_false_closed_motion(void** state) {
  (void)state;
  is_seen(
      "param a = 2 [m/s^2], k = 3 [1/s^2]\ncoord x, y\nlagrangian x'^2/2 + a x + y'^2/2 - k y^2/2\n"
      "init x = 1 [m], x' = 0, y = 1 [m], y' = 0\nsimulate 0..1 [s]\nask solve x(t), solve y(t)\n",
      "y");
}

static void a_false_value_on_a_named_motion(void** state) {
  (void)state;
  is_seen(PENDULUM "ask λ_rod from φ = 60° at rest\n", "lambda_rod");
  // where the motion never leaves: of starts beside it
  is_seen(PENDULUM "ask λ_rod from φ = 180° at rest\n", "lambda_rod");
}

static void a_false_result_of_the_whole_system(void** state) {
  (void)state;
  is_seen(PENDULUM "ask T\n", "T");
  is_seen(PENDULUM "ask norm(force(rod))\n", "norm(force(rod))");
}

static void an_equation_that_the_motion_does_not_satisfy(void** state) {
  (void)state;
  bench b = solved(PENDULUM "ask lagrange1\n");
  pl_section* section = &b.s->sections.at[0];
  pl_step* step = NULL;
  for (int i = 0; i < section->steps.n && !step; i++) {
    if (section->steps.at[i].number == 1) step = &section->steps.at[i];
  }
  assert_non_null(step);
  pl_pool* p = b.s->model->pool;
  const pl_form* zero = pl_form_leaf(b.m->arena, pl_int(p, 0));
  step->formula = pl_form_relation(b.m->arena, step->formula->args[0], "=", zero);
  b.s->checks.n = 0;
  pl_witness_hold(&b.m->job, b.s, NULL, 0);
  assert_string_equal(last_check(&b)->failed_on, "(1)");
  done(&b);
}

static void the_failed_check_is_the_status(void** state) {
  (void)state;
  bench b = solved(PENDULUM "ask solve φ''\n");
  pl_section* section = NULL;
  value_named(&b, "phi_ddot", &section)->expr = pl_int(b.s->model->pool, 0);
  b.s->checks.n = 0;
  pl_witness_hold(&b.m->job, b.s, NULL, 0);
  const char* answer = NULL;
  assert_int_equal(pleuel_solve_json(b.m, &answer, NULL), PLEUEL_EXPECT_FAILED);
  assert_non_null(strstr(answer, "\"withdrawn\": true"));
  assert_non_null(strstr(answer, "\"expr\": null"));
  assert_int_equal(pleuel_solve_text(b.m, &answer, NULL), PLEUEL_EXPECT_FAILED);
  assert_non_null(strstr(answer, "the formula gives 0, the motion -"));
  PLEUEL_OPTIONS(pleuel_solve_options, how);
  how.lang = "de";
  assert_int_equal(pleuel_solve_text(b.m, &answer, &how), PLEUEL_EXPECT_FAILED);
  assert_non_null(strstr(answer, "die Formel gibt 0, die Bewegung -"));
  done(&b);
}

static void a_motion_that_cannot_be_had_is_told(void** state) {
  (void)state;
  bench b = solved(
      "param m, k1, k2\ncoord x, y\nlagrangian m x'^2/2 - k1 y^2/2 - k2 (x - y)^2/2\nask "
      "lagrange2\n");
  assert_true(strncmp(last_check(&b)->name[0], "formulas not held against the motion: ", 38) == 0);
  assert_true(last_check(&b)->passed && last_check(&b)->starts == 0);
  done(&b);
}

static void a_false_place(void** state) {
  (void)state;
  // after a turn; where a contact ends; where the motion leaves rest only when pushed; λ at a place
  is_seen(
      "param m = 1 [kg], k = 20 [N/m], g = 9.81 [m/s^2]\ncoord x\naxes x down\nmass m at "
      "(x)\ngravity g along x\npotential k x^2/2\n"
      "init x = 0, x' = -2 [m/s]\nsimulate 0..3 [s]\nask x' where x = 0.1 [m]\n",
      "x_dot");
  is_seen(PENDULUM "ask φ' where φ = 10° from φ = 60° at rest\n", "phi_dot");
  is_seen(PENDULUM "ask λ where φ = 10° from φ = 60° at rest\n", "lambda_rod");
  is_seen(
      "param m = 75 [kg], R = 20 [m], g = 9.81 [m/s^2]\ncoord r, ϑ\naxes x right, z up\nmass m at "
      "(r sin ϑ, r cos ϑ)\ngravity g along -z\n"
      "constraint h: r >= R with λ\ninit ϑ = 1°, ϑ' = 0\nsimulate 0..10 [s]\nask ϑ where λ = 0 "
      "from ϑ = 0 at rest\n",
      "theta");
}

static void an_expectation_that_was_found_right(void** state) {
  (void)state;
  bench b = solved(PENDULUM "ask expect φ'' = -(g/l) sin φ\nask expect φ'' = 0\n");
  pl_value* v = &b.s->sections.at[1].values.at[0];
  assert_int_equal(v->passed, 0);
  v->passed = 1;
  b.s->checks.n = 0;
  pl_witness_hold(&b.m->job, b.s, NULL, 0);
  assert_string_equal(last_check(&b)->failed_on, "expect");
  assert_false(b.s->sections.at[0].withdrawn);
  assert_true(b.s->sections.at[1].withdrawn);
  done(&b);
}

#define SWING PENDULUM "ask dof, equilibria\n"

static void is_refused(bench* b, const char* of, const char* words) {
  b->s->checks.n = 0;
  pl_witness_hold(&b->m->job, b->s, NULL, 0);
  assert_false(last_check(b)->passed);
  assert_string_equal(last_check(b)->failed_on, of);
  const char* answer = NULL;
  assert_int_equal(pleuel_solve_text(b->m, &answer, NULL), PLEUEL_EXPECT_FAILED);
  if (!strstr(answer, words)) fail_msg("%s\nis not in\n%s", words, answer);
  done(b);
}

static void degrees_of_freedom_that_the_rank_does_not_leave(void** state) {
  (void)state;
  bench b = solved(SWING);
  assert_true(last_check(&b)->passed);
  b.s->dof.dof = b.s->dof.velocity_dof = 2;
  is_refused(&b, "dof", "leaves 1 degrees of freedom");
}

static void a_position_of_rest_where_nothing_rests(void** state) {
  (void)state;
  bench b = solved(SWING);
  pl_section* section = NULL;
  value_named(&b, "equilibrium 1", &section)->components[0].expr = pl_ratio(b.s->model->pool, 1,
                                                                            10);
  is_refused(&b, "equilibrium 1", "equilibrium 1 is no position of rest");
}

static void a_list_with_one_left_out(void** state) {
  (void)state;
  bench b = solved(SWING);
  pl_section* section = NULL;
  pl_value* v = value_named(&b, "equilibrium 2", &section);
  assert_true(section->complete);
  v->name = "another";
  is_refused(&b, "equilibria", "not complete");
}

static void there_is_none_where_there_is_one(void** state) {
  (void)state;
  bench b = solved(PENDULUM "ask equilibria\n");
  b.s->sections.at[0].values.n = 0;
  is_refused(&b, "equilibria", "not complete");
}

static void stable_for_unstable(void** state) {
  (void)state;
  bench b = solved(SWING);
  pl_section* section = NULL;
  pl_value* v = value_named(&b, "equilibrium 1", &section);
  v->stability = strcmp(v->stability, "stable") == 0 ? "unstable" : "stable";
  is_refused(&b, "equilibrium 1", "by its eigenvalues");
}

static void damped_and_coupled_positions_of_rest_pass(void** state) {
  (void)state;
  static const char* const right[] = {
      // with Cartesian coordinates, with a drive, with damping, two freedoms, friction-free contact
      "param m = 1 [kg], l = 1 [m], g = 9.81 [m/s^2]\ncoord x, y\naxes x right, y up\nmass m at "
      "(x, y)\ngravity g along -y\n"
      "constraint rod: x^2 + y^2 = l^2\ninit x = 0.6 [m], y = -0.8 [m], x' = 0\nask dof, "
      "equilibria\n",
      "param m = 1 [kg], R = 1 [m], g = 9.81 [m/s^2], w = 5 [1/s]\ncoord θ, φ\naxes x right, y "
      "out, z up\n"
      "mass m at (R sin θ cos φ, R sin θ sin φ, -R cos θ)\ngravity g along -z\nconstraint drive: φ "
      "= w t\ninit θ = 0.3, θ' = 0\n"
      "ask dof, equilibria\n",
      "param m = 1 [kg], k = 4 [N/m], c = 1 [N s/m], g = 9.81 [m/s^2]\ncoord y\naxes y up\nmass m "
      "at (y)\ngravity g along -y\n"
      "potential k y^2/2\nrayleigh c y'^2/2\ninit y = 0, y' = 0\nask dof, equilibria\n",
      "param m = 1 [kg], l = 1 [m], g = 9.81 [m/s^2]\ncoord a, b\naxes x right, y up\nmass m at (l "
      "sin a, -l cos a)\n"
      "mass m at (l sin a + l sin b, -l cos a - l cos b)\ngravity g along -y\ninit a = 0.1, b = "
      "0.2, a' = 0, b' = 0\nask dof, equilibria\n",
  };
  for (size_t i = 0; i < sizeof right / sizeof *right; i++) {
    bench b = solved(right[i]);
    if (!last_check(&b)->passed) fail_msg("%s: %s", right[i], last_check(&b)->failed_on);
    if (last_check(&b)->formulas < (i == 0 ? 1 : 2)) fail_msg("%s", right[i]);
    done(&b);
  }
}

// What vanishes exactly, and what holds on one side only, is no disagreement.
static void nothing_is_seen_where_nothing_is(void** state) {
  (void)state;
  static const char* const right[] = {
      "param m = 1 [kg], l = 1 [m], g = 9.81 [m/s^2]\nlet a = g\ncoord φ\naxes x right, z up\nmass "
      "m at (l sin φ, -l cos φ - 1/2 a t^2)\n"
      "gravity g along -z\nask solve φ''\n",
      "param l = 1.01, g = 9.81\ncoord x, y, φ\naxes x right, y up\nmass A: 1.15 at (x, "
      "y)\nconstraint rod: sqrt(x^2 + y^2) <= l\n"
      "choose φ with x = l sin φ, y = -l cos φ\ninit φ = 119°, φ' = 0\ngravity g along -y\nask "
      "dof\nsimulate 0..1\n",
      "coord u, v\nlagrangian 1/2*1.59*u'^2 - 1/4*1.27*u^4 + 1/2*1.78*v'^2 - 1/2*1.89*v^2 + "
      "0.26*u'*v'\nask equilibria\n",
      "param m = 0.86\ncoord θ\nkinetic m/2 θ'^2\npotential 2.25/2 θ^2 + 1.64 θ\ninit θ = -1.2, θ' "
      "= 2.85\nask θ' where θ' = 0, T where θ' = 0\n"
      "simulate 0..40\n",
      "coord x, y\naxes x right, y up\nmass A: 2.37 at (x, y)\nconstraint floor: y >= "
      "0\nconstraint wall: x >= 0\nforce (-0.59, -4.73) on A\n"
      "init x = 0, y = 0, x' = 0, y' = 0\nask T, V, solve x''\nsimulate 0..1\n",
      "param m = 1, R = 2, g = 9.81\ncoord r, θ\naxes x right, y up\nmass A: m at (r sin θ, r cos "
      "θ)\ngravity g along -y\nconstraint dome: r >= R\n"
      "init r = 1.2*R, θ = 7.79°, r' = 0, θ' = 0.02\nask equilibria, solve θ''\nsimulate 0..1\n",
      // a place of rest a tenth of a millimetre beside that where the spring has no length
      "param m1 = 2.15, m2 = 2.97, g = 9.81, d = 0.54\ncoord x1, x2\naxes x down\nmass A1: m1 at "
      "(x1)\nmass A2: m2 at (x2)\n"
      "gravity g along x\nspring 14.9, rest d between A1 and (-0.42)\nconstraint rope: x1 + x2 = "
      "1.14\n"
      "init x1 = 0.77, x2 = 0.37, x1' = 0, x2' = 0\nask equilibria, solve x1''\nsimulate 0..1\n",
      // energies of a Lagrange function, by degree in the velocities
      "coord u, v\nlagrangian 0.41*u'^2*cos(v)^2 + 0.3*v'^2 - 0.59*u^2 + 0.2*u*v' - 0.7*v^2 + "
      "0.81*sin(t)*u\n"
      "init u = -0.8, u' = -0.26, v = 0.3, v' = 0.5\nask T, V, 2*T - V\nsimulate 0..2\n",
      "coord u\nlagrangian 0.41*u'^2 - 0.59*u^2\ninit u = -0.8, u' = -0.26\nask T where u = -0.73, "
      "V where u = -0.73\nsimulate 0..2\n",
      "param m1, m2, r, l, g\ncoord φ, x2\naxes x right, z up\nmass A: m1 at (r cos φ, r sin "
      "φ)\nmass B: m2 at (x2, 0)\ngravity g along -z\n"
      "constraint rod: (x2 - r cos φ)^2 + (r sin φ)^2 = l^2\nbranch x2 > r cos φ\nask lagrangian, "
      "lagrange2\n",
  };
  for (size_t i = 0; i < sizeof right / sizeof *right; i++) {
    bench b = solved(right[i]);
    if (!last_check(&b)->passed || last_check(&b)->formulas < 1) fail_msg("%s", right[i]);
    done(&b);
  }
}

static void parameters_without_numbers_are_no_obstacle(void** state) {
  (void)state;
  is_seen(
      "param m, l, g\ncoord r, φ\naxes x right, y up\nmass m at (r sin φ, -r cos φ)\ngravity g "
      "along -y\n"
      "constraint rod: r = l\nask solve φ''\n",
      "phi_ddot");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_false_acceleration),
      cmocka_unit_test(a_false_multiplier),
      cmocka_unit_test(a_false_component_of_a_force),
      cmocka_unit_test(a_false_limit),
      cmocka_unit_test(a_false_frequency),
      cmocka_unit_test(a_false_threshold),
      cmocka_unit_test(a_false_constant_of_the_motion),
      cmocka_unit_test(a_false_closed_motion),
      cmocka_unit_test(a_false_value_on_a_named_motion),
      cmocka_unit_test(a_false_result_of_the_whole_system),
      cmocka_unit_test(an_equation_that_the_motion_does_not_satisfy),
      cmocka_unit_test(the_failed_check_is_the_status),
      cmocka_unit_test(a_motion_that_cannot_be_had_is_told),
      cmocka_unit_test(parameters_without_numbers_are_no_obstacle),
      cmocka_unit_test(a_false_place),
      cmocka_unit_test(an_expectation_that_was_found_right),
      cmocka_unit_test(nothing_is_seen_where_nothing_is),
      cmocka_unit_test(degrees_of_freedom_that_the_rank_does_not_leave),
      cmocka_unit_test(a_position_of_rest_where_nothing_rests),
      cmocka_unit_test(a_list_with_one_left_out),
      cmocka_unit_test(there_is_none_where_there_is_one),
      cmocka_unit_test(stable_for_unstable),
      cmocka_unit_test(damped_and_coupled_positions_of_rest_pass),
  };
  return cmocka_run_group_tests_name("witness", tests, NULL, NULL);
}
