// Dimension inference on models built by calls: what is found, what is told, and what is left
// alone.
#include <stdlib.h>

#include "model/model_test_kit.h"

// ----------------------------------------------------------------------------- the founding models
static const char atwood_text[] =
    "system \"Atwood machine\"\n"
    "param m1 = 3 [kg], m2 = 2 [kg], g = 9.81 [m/s^2]\n"
    "param L = 4 [m], R = 0.1 [m]\n"
    "let   l = L - π R\n"
    "coord x1, y1, x2, y2\n"
    "axes  x down, y right\n"
    "mass    m1 at (x1, y1)\n"
    "mass    m2 at (x2, y2)\n"
    "gravity g along x\n"
    "constraint g1: x1 + x2 = l\n"
    "constraint g2: y1 = -R\n"
    "constraint g3: y2 = R\n"
    "init x1 = 1 [m], x1' = 0\n";

typedef struct atwood {
  kit* k;
  pl_expr m1, m2, g, L, R, l, x1, y1, x2, y2;
  pl_symbol lambda;
} atwood;

static atwood atwood_names(kit* k) {
  atwood a = {.k = k};
  a.m1 = param(k, "m1", "3", "kg", "param m1");
  a.m2 = param(k, "m2", "2", "kg", "param m1");
  a.g = param(k, "g", "9.81", "m/s^2", "param m1");
  a.L = param(k, "L", "4", "m", "param L");
  a.R = param(k, "R", "0.1", "m", "param L");
  pl_expr pi_r = pl_mul(k->m->pool, pl_pi(k->m->pool), a.R);
  a.l = let_stay(k, "l", pl_sub(k->m->pool, a.L, pi_r), "let   l = L - π R");
  a.x1 = coord(k, "x1", NULL, "coord x1");
  a.y1 = coord(k, "y1", NULL, "coord x1");
  a.x2 = coord(k, "x2", NULL, "coord x1");
  a.y2 = coord(k, "y2", NULL, "coord x1");
  return a;
}

static atwood atwood_fill(kit* k, bool wrong) {
  atwood a = atwood_names(k);
  mass(k, "m1", a.m1, point2(a.x1, a.y1), "mass    m1");
  mass(k, "m2", a.m2, point2(a.x2, a.y2), "mass    m2");
  gravity(k, a.g, 0, 1, "gravity g along x");
  const char* place = wrong ? "constraint g1: x1 + x2 = g" : "constraint g1: x1 + x2 = l";
  a.lambda = constraint(k, named("g1"), pl_add(k->m->pool, a.x1, a.x2), PL_EQ, wrong ? a.g : a.l,
                        NULL, place);
  constraint(k, named("g2"), a.y1, PL_EQ, pl_neg(k->m->pool, a.R), NULL, "constraint g2: y1 = -R");
  constraint(k, named("g3"), a.y2, PL_EQ, a.R, NULL, "constraint g3: y2 = R");
  init(k, a.x1, num(k, "1", "m"), "init x1 = 1 [m]");
  init(k, dot(k, a.x1), num(k, "0", NULL), "x1' = 0");
  return a;
}

static atwood atwood_make(const char* text, bool wrong) {
  return atwood_fill(kit_make(text), wrong);
}

PL_TEST(atwood_gives_every_name_its_unit) {
  atwood a = atwood_make(atwood_text, false);
  check_is_clean(a.k);
  assert_int_equal(a.k->diagnostics.list.n, 0);
  has_unit(a.k, a.x1, "m");
  has_unit(a.k, a.y2, "m");
  has_unit(a.k, a.l, "m");
  has_unit(a.k, dot(a.k, a.x1), "m/s");
  has_unit(a.k, dot(a.k, dot(a.k, a.x2)), "m/s^2");
  has_unit(a.k, pl_sym(a.k->m->pool, a.lambda), "N");
  has_unit(a.k, pl_mul(a.k->m->pool, a.m1, pl_square(a.k->m->pool, dot(a.k, a.x1))), "J");
  kit_free(a.k);
}

PL_TEST(units_leave_the_model_after_the_check) {
  atwood a = atwood_make(atwood_text, false);
  check_is_clean(a.k);
  assert_true(pl_same(pl_model_param(a.k->m, pl_symbol_of(a.k->m->pool, a.g))->value,
                      pl_ratio(a.k->m->pool, 981, 100)));
  assert_true(pl_is_one_node(a.k->m->pool, a.k->m->inits.at[0].value));
  kit_free(a.k);
}

PL_TEST(atwood_classes_and_signs) {
  atwood a = atwood_make(atwood_text, false);
  check_is_clean(a.k);
  pl_pool* p = a.k->m->pool;
  assert_int_equal(pl_symbol_get(p, pl_symbol_of(p, a.m1))->class, PL_C_MASS);
  assert_int_equal(pl_symbol_get(p, pl_symbol_of(p, a.g))->class, PL_C_GRAVITY);
  assert_int_equal(pl_symbol_get(p, pl_symbol_of(p, a.L))->class, PL_C_LENGTH);
  assert_int_equal(pl_symbol_get(p, pl_symbol_of(p, a.m1))->sign, PL_SIGN_POSITIVE);
  assert_int_equal(pl_symbol_get(p, pl_symbol_of(p, a.R))->sign, PL_SIGN_POSITIVE);
  // its number is
  assert_int_equal(pl_symbol_get(p, pl_symbol_of(p, a.l))->sign, PL_SIGN_POSITIVE);
  assert_int_equal(pl_symbol_get(p, pl_symbol_of(p, a.l))->class, PL_C_LENGTH);
  kit_free(a.k);
}

static char* replaced(kit* k, const char* text, const char* from, const char* to) {
  const char* found = strstr(text, from);
  assert_non_null(found);
  return pl_format(k->arena, "%.*s%s%s", (int)(found - text), text, to, found + strlen(from));
}

// The message of the design page: both sides, where each comes from, and the name that fits.
PL_TEST(a_length_cannot_equal_an_acceleration) {
  kit* scratch = kit_make(NULL);
  atwood a = atwood_make(replaced(scratch, atwood_text, "x1 + x2 = l", "x1 + x2 = g"), true);
  const pl_diagnostic* d = check_tells(a.k, PL_E021);
  assert_string_equal(d->sentence[0], "a length cannot equal an acceleration");
  assert_string_equal(d->replacement, "l");
  const char* text = printed(a.k, d);
  assert_non_null(strstr(text, "m/s²  (line 2)"));
  assert_non_null(strstr(text, "(x1 from line 13: init x1 = 1 [m])"));
  assert_non_null(strstr(text, "did you mean l (line 4, m)"));
  assert_non_null(strstr(text, "^^^^^^^   ^"));
  assert_int_equal(pl_span_place(d->span).line, 10);
  assert_int_equal(d->span.end - d->span.begin, 1);
  kit_free(a.k);
  kit_free(scratch);
}

PL_TEST(crank_squares_and_angles_fit) {
  kit* k = kit_make(NULL);
  pl_pool* p = k->m->pool;
  pl_expr m1 = param(k, "m1", "1", "kg", NULL), r = param(k, "r", "0.1", "m", NULL),
          l = param(k, "l", "0.3", "m", NULL);
  pl_expr x1 = coord(k, "x1", NULL, NULL), z1 = coord(k, "z1", NULL, NULL),
          x2 = coord(k, "x2", NULL, NULL), phi = coord(k, "phi", NULL, NULL);
  mass(k, "m1", m1, point2(x1, z1), NULL);
  mass(k, "m2", m1, point2(x2, pl_int(p, 0)), NULL);
  constraint(k, named("g4"), pl_add(p, pl_square(p, x1), pl_square(p, z1)), PL_EQ, pl_square(p, r),
             NULL, NULL);
  pl_symbol g5 = constraint(k, named("g5"),
                            pl_add(p, pl_square(p, z1), pl_square(p, pl_sub(p, x2, x1))), PL_EQ,
                            pl_square(p, l), NULL, NULL);
  struct pl_map_equation maps[2] = {{x1, pl_mul(p, r, pl_call(p, PL_COS, phi)), {0}},
                                    {z1, pl_mul(p, r, pl_call(p, PL_SIN, phi)), {0}}};
  k->m->choose.maps = maps;
  k->m->choose.n_maps = 2;
  pl_push(k->arena, k->m->choose.coords, pl_symbol_of(p, phi));
  init(k, phi, num(k, "90", "deg"), NULL);
  init(k, dot(k, phi), num(k, "0.1", "rad/s"), NULL);
  check_is_clean(k);
  has_unit(k, x2, "m");
  has_unit(k, phi, "1");
  has_unit(k, dot(k, phi), "1/s");
  has_unit(k, pl_sym(p, g5), "N/m");  // a constraint in m²: the multiplier is not a force
  kit_free(k);
}

PL_TEST(ski_one_sided_contact_in_polar_coordinates) {
  kit* k = kit_make(NULL);
  pl_pool* p = k->m->pool;
  pl_expr m = param(k, "m", "75", "kg", NULL), R = param(k, "R", "20", "m", NULL),
          g = param(k, "g", "9.81", "m/s^2", NULL);
  pl_expr r = coord(k, "r", NULL, NULL), theta = coord(k, "theta", NULL, NULL);
  mass(k, NULL, m,
       point2(pl_mul(p, r, pl_call(p, PL_SIN, theta)), pl_mul(p, r, pl_call(p, PL_COS, theta))),
       NULL);
  gravity(k, g, 1, -1, NULL);
  pl_symbol lambda = constraint(k, named("h"), r, PL_GE, R, NULL, NULL);
  init(k, theta, num(k, "1", "deg"), NULL);
  check_is_clean(k);
  has_unit(k, r, "m");
  has_unit(k, theta, "1");
  has_unit(k, pl_sym(p, lambda), "N");
  kit_free(k);
}

// A mistake inside an abbreviation is told there, once, wherever it is used.
PL_TEST(an_abbreviation_is_checked_where_it_stands) {
  kit* k = kit_make("let d = l + m\npotential\n");
  pl_pool* p = k->m->pool;
  pl_expr m = param(k, "m", "1", "kg", NULL), l = param(k, "l", "1", "m", NULL),
          x = coord(k, "x", "m", NULL);
  pl_expr d = let_be(k, "d", pl_add(p, l, m), "let d = l + m");
  mass(k, "A", m, (pl_point){.n = 1, .at = {x}}, NULL);
  load(k, PL_L_POTENTIAL, pl_mul(p, num(k, "1", "N"), d), "potential");
  constraint(k, named("c"), x, PL_EQ, d, NULL, NULL);
  const pl_diagnostic* told_once = check_tells(k, PL_E021);
  assert_int_equal(pl_span_place(told_once->span).line, 1);
  kit_free(k);
}

// ----------------------------------------------------------------------------------- without units
PL_TEST(without_units_nothing_is_checked) {
  kit* k = kit_make(NULL);
  pl_pool* p = k->m->pool;
  pl_expr L = param(k, "L", "1", NULL, NULL), M = param(k, "M", "10", NULL, NULL);
  pl_expr x = coord(k, "x", NULL, NULL), y = coord(k, "y", NULL, NULL);
  mass(k, "A", M, point2(x, y), NULL);
  // would not fit with units
  constraint(k, named("c"), pl_add(p, x, pl_square(p, y)), PL_EQ, L, NULL, NULL);
  gravity(k, num(k, "1", NULL), 1, -1, NULL);
  check_is_clean(k);
  assert_false(k->m->uses_units);
  assert_int_equal(k->diagnostics.list.n, 0);
  pl_dimension d;
  assert_false(pl_model_dimension(k->m, x, &d));
  kit_free(k);
}

PL_TEST(classes_follow_from_use_without_units) {
  kit* k = kit_make(NULL);
  pl_pool* p = k->m->pool;
  pl_expr M = param(k, "M", "1", NULL, NULL), L = param(k, "L", "1", NULL, NULL),
          G = param(k, "G", "1", NULL, NULL), w = param(k, "w", "2", NULL, NULL);
  pl_expr x = coord(k, "x", NULL, NULL);
  mass(k, "A", M, (pl_point){.n = 1, .at = {x}}, NULL);
  gravity(k, G, 0, 1, NULL);
  constraint(k, named("c"), x, PL_EQ,
             pl_mul(p, L, pl_call(p, PL_SIN, pl_mul(p, w, pl_sym(p, pl_time(p))))), NULL, NULL);
  check_is_clean(k);
  assert_int_equal(pl_symbol_get(p, pl_symbol_of(p, M))->class, PL_C_MASS);
  assert_int_equal(pl_symbol_get(p, pl_symbol_of(p, G))->class, PL_C_GRAVITY);
  assert_int_equal(pl_symbol_get(p, pl_symbol_of(p, L))->class, PL_C_LENGTH);
  assert_int_equal(pl_symbol_get(p, pl_symbol_of(p, w))->class, PL_C_OTHER);
  kit_free(k);
}

static const char* unit_written(kit* k, pl_expr e) {
  pl_symbol s = pl_symbol_of(k->m->pool, e);
  pl_dimension x = pl_symbol_get(k->m->pool, s)->dimension;
  return pl_unit_of_symbol(k->arena, k->m->pool, s, x, true);
}

PL_TEST(torques_are_no_energies) {
  kit* k = kit_make(NULL);
  pl_pool* p = k->m->pool;
  pl_expr q = coord(k, "q", NULL, NULL), J = param(k, "J", "1", "kg m^2", NULL);
  pl_expr said = param(k, "said", "1", "N m/rad", NULL), depth = param(k, "depth", "1", "J", NULL);
  pl_expr found = param(k, "found", "1", NULL, NULL), well = param(k, "well", "1", NULL, NULL);
  load(k, PL_L_KINETIC, pl_mul(p, J, pl_square(p, dot(k, q))), NULL);
  load(k, PL_L_POTENTIAL, pl_mul(p, said, pl_square(p, q)), NULL);
  load(k, PL_L_POTENTIAL, pl_mul(p, found, pl_square(p, q)), NULL);
  load(k, PL_L_POTENTIAL, pl_mul(p, depth, pl_square(p, q)), NULL);
  load(k, PL_L_POTENTIAL, pl_mul(p, well, pl_call(p, PL_COS, q)), NULL);
  check_is_clean(k);
  assert_string_equal(unit_written(k, said), "N m");
  assert_string_equal(unit_written(k, found), "N m");
  assert_string_equal(unit_written(k, depth), "J");
  assert_string_equal(unit_written(k, well), "J");
  kit_free(k);
}

PL_TEST(an_angle_alone_does_not_switch_the_checks_on) {
  kit* k = kit_make(NULL);
  pl_expr x = coord(k, "x", NULL, NULL), phi = coord(k, "phi", NULL, NULL);
  mass(k, "A", num(k, "1", NULL), point2(x, pl_call(k->m->pool, PL_SIN, phi)), NULL);
  init(k, phi, num(k, "30", "deg"), NULL);
  check_is_clean(k);
  assert_false(k->m->uses_units);
  kit_free(k);
}

// --------------------------------------------------------------------------------------- conflicts
// One mass on a line with unit metre; the tests add one wrong statement.
static kit* particle(const char* text, pl_expr* m, pl_expr* x) {
  kit* k = kit_make(text);
  *m = param(k, "m", "2", "kg", "param m");
  *x = coord(k, "x", "m", "coord x");
  mass(k, "A", *m, (pl_point){.n = 1, .at = {*x}}, "mass");
  return k;
}

PL_TEST(a_mass_statement_wants_a_mass) {
  kit* k = kit_make(NULL);
  pl_expr l = param(k, "l", "2", "m", NULL), x = coord(k, "x", NULL, NULL);
  mass(k, "A", l, (pl_point){.n = 1, .at = {x}}, NULL);
  const pl_diagnostic* d = check_tells(k, PL_E033);
  assert_non_null(strstr(d->sentence[0], "l is a length"));
  kit_free(k);
}

PL_TEST(a_point_wants_lengths) {
  kit* k = kit_make(NULL);
  pl_expr m = param(k, "m", "2", "kg", NULL), t0 = param(k, "t0", "1", "s", NULL),
          x = coord(k, "x", NULL, NULL);
  mass(k, "A", m, point2(x, t0), NULL);
  check_tells(k, PL_E033);
  kit_free(k);
}

PL_TEST(a_sine_wants_a_pure_number) {
  pl_expr m, x;
  kit* k = particle(NULL, &m, &x);
  constraint(k, named("c"), x, PL_EQ,
             pl_mul(k->m->pool, num(k, "1", "m"), pl_call(k->m->pool, PL_SIN, x)), NULL, NULL);
  const pl_diagnostic* d = check_tells(k, PL_E031);
  assert_non_null(strstr(d->sentence[0], "sin() takes a pure number, but x is a length"));
  kit_free(k);
}

PL_TEST(a_number_that_may_have_a_unit_is_suspected) {
  pl_expr m, x;
  kit* k = particle(NULL, &m, &x);
  pl_expr t = pl_sym(k->m->pool, pl_time(k->m->pool));
  pl_expr wave = pl_call(k->m->pool, PL_SIN, pl_mul(k->m->pool, pl_int(k->m->pool, 3), t));
  constraint(k, named("c"), x, PL_EQ, pl_mul(k->m->pool, num(k, "1", "m"), wave), NULL, NULL);
  const pl_diagnostic* d = check_tells(k, PL_E031);
  assert_non_null(strstr(d->fix[0], "3 [1/s]"));
  kit_free(k);
}

PL_TEST(an_exponent_is_a_pure_number) {
  pl_expr m, x;
  kit* k = particle(NULL, &m, &x);
  load(k, PL_L_POTENTIAL,
       pl_mul(k->m->pool, num(k, "1", "J"), pl_pow(k->m->pool, pl_int(k->m->pool, 2), x)), NULL);
  check_tells(k, PL_E032);
  kit_free(k);
}

PL_TEST(terms_of_a_sum_have_one_unit) {
  pl_expr m, x;
  kit* k = particle("coord x [m]\npotential x + m\n", &m, &x);
  load(k, PL_L_POTENTIAL, pl_mul(k->m->pool, num(k, "1", "N"), pl_add(k->m->pool, x, m)),
       "potential x + m");
  const pl_diagnostic* d = check_tells(k, PL_E021);
  assert_non_null(strstr(d->sentence[0], "cannot be added"));
  kit_free(k);
}

PL_TEST(gravity_is_an_acceleration) {
  pl_expr m, x;
  kit* k = particle(NULL, &m, &x);
  gravity(k, param(k, "g", "9.81", "m/s", NULL), 0, -1, NULL);
  check_tells(k, PL_E033);
  kit_free(k);
}

PL_TEST(a_start_value_in_the_wrong_unit) {
  pl_expr m, x;
  kit* k = particle("coord x [m]\ninit x = 1 [s]\n", &m, &x);
  init(k, x, num(k, "1", "s"), "init x = 1 [s]");
  const pl_diagnostic* d = check_tells(k, PL_E021);
  assert_int_equal(pl_span_place(d->span).line, 2);
  assert_non_null(strstr(d->fix[0], "x is in m"));
  kit_free(k);
}

PL_TEST(a_unit_that_contradicts_its_value) {
  kit* k = kit_make(NULL);
  pl_expr m, x;
  k = (kit_free(k), particle(NULL, &m, &x));
  pl_expr l = param(k, "l", NULL, "m", NULL);
  k->m->params.at[k->m->params.n - 1].value = m;
  constraint(k, named("c"), x, PL_EQ, l, NULL, NULL);
  check_tells(k, PL_E021);
  kit_free(k);
}

PL_TEST(a_simulation_runs_over_time) {
  pl_expr m, x;
  kit* k = particle(NULL, &m, &x);
  k->m->simulate = (pl_simulate){
      .given = true, .from = pl_int(k->m->pool, 0), .to = num(k, "2", "m")};
  check_tells(k, PL_E033);
  kit_free(k);
}

PL_TEST(one_mistake_is_told_once) {
  pl_expr m, x;
  kit* k = particle(NULL, &m, &x);
  pl_expr y = coord(k, "y", NULL, NULL);
  constraint(k, named("a"), y, PL_EQ, m, NULL, NULL);  // y becomes a mass by mistake
  constraint(k, named("b"), y, PL_EQ, x, NULL, NULL);
  constraint(k, named("c"), pl_add(k->m->pool, y, x), PL_EQ, num(k, "1", "m"), NULL, NULL);
  pl_model_check(&k->job, k->m);
  assert_int_equal(told(k, PL_E021, NULL), 1);
  kit_free(k);
}

PL_TEST(two_mistakes_are_told_both) {
  pl_expr m, x;
  kit* k = particle(NULL, &m, &x);
  constraint(k, named("a"), x, PL_EQ, m, NULL, NULL);
  pl_expr y = coord(k, "y", "m", NULL);
  constraint(k, named("b"), y, PL_EQ, num(k, "1", "s"), NULL, NULL);
  pl_model_check(&k->job, k->m);
  assert_int_equal(told(k, PL_E021, NULL), 2);
  kit_free(k);
}

// --------------------------------------------------------------------------------------- inference
PL_TEST(squares_and_roots_are_solved) {
  pl_expr m, x;
  kit* k = particle(NULL, &m, &x);
  pl_pool* p = k->m->pool;
  pl_expr a = param(k, "a", NULL, NULL, NULL), b = param(k, "b", NULL, NULL, NULL);
  pl_expr y = coord(k, "y", "s", NULL), z = coord(k, "z", NULL, NULL);
  constraint(k, named("c"), pl_square(p, x), PL_EQ, pl_mul(p, a, pl_square(p, y)), NULL, NULL);
  constraint(k, named("d"), z, PL_EQ, pl_sqrt(p, pl_mul(p, b, x)), NULL, NULL);
  constraint(k, named("e"), z, PL_EQ, pl_mul(p, x, x), NULL, NULL);
  check_is_clean(k);
  has_unit(k, a, "m^2/s^2");
  has_unit(k, z, "m^2");
  has_unit(k, b, "m^3");
  kit_free(k);
}

PL_TEST(a_parameter_of_a_potential_gets_its_unit) {
  pl_expr m, x;
  kit* k = particle(NULL, &m, &x);
  pl_expr c = param(k, "c", NULL, NULL, NULL);
  load(k, PL_L_POTENTIAL, pl_mul(k->m->pool, c, pl_pow_int(k->m->pool, x, 4)), NULL);
  check_is_clean(k);
  has_unit(k, c, "kg/(m^2 s^2)");
  kit_free(k);
}

PL_TEST(bare_numbers_take_the_fitting_unit_with_a_note) {
  pl_expr m, x;
  kit* k = particle(NULL, &m, &x);
  pl_expr l = param(k, "l", "3", NULL, NULL);
  constraint(k, named("c"), pl_add(k->m->pool, x, l), PL_EQ, num(k, "5", NULL), NULL, NULL);
  const pl_diagnostic* d = check_tells(k, PL_N021);
  assert_non_null(strstr(d->sentence[0], "l = 3 m"));
  assert_non_null(strstr(d->sentence[0], "5 m"));
  has_unit(k, l, "m");
  kit_free(k);
}

PL_TEST(zero_needs_no_unit) {
  pl_expr m, x;
  kit* k = particle(NULL, &m, &x);
  init(k, x, num(k, "0", NULL), NULL);
  init(k, dot(k, x), num(k, "0", NULL), NULL);
  check_is_clean(k);
  assert_int_equal(k->diagnostics.list.n, 0);
  kit_free(k);
}

PL_TEST(a_spring_and_a_damper_have_units) {
  pl_expr m, x;
  kit* k = particle(NULL, &m, &x);
  pl_expr c = param(k, "c", NULL, NULL, NULL), s = param(k, "s", NULL, NULL, NULL),
          l0 = param(k, "l0", NULL, NULL, NULL);
  pl_point a = {.n = 1, .at = {x}}, b = {.n = 1, .at = {pl_int(k->m->pool, 0)}};
  pl_push(k->arena, k->m->loads,
          (pl_load){.kind = PL_L_SPRING, .value = s, .rest = l0, .a = a, .b = b});
  pl_push(k->arena, k->m->loads, (pl_load){.kind = PL_L_DAMPER, .value = c, .a = a, .b = b});
  check_is_clean(k);
  has_unit(k, s, "N/m");
  has_unit(k, c, "kg/s");
  has_unit(k, l0, "m");
  assert_int_equal(pl_symbol_get(k->m->pool, pl_symbol_of(k->m->pool, s))->sign, PL_SIGN_POSITIVE);
  kit_free(k);
}

PL_TEST(a_lagrangian_per_mass_is_fine) {
  kit* k = kit_make(NULL);
  pl_pool* p = k->m->pool;
  pl_expr x = coord(k, "x", "m", NULL), w = param(k, "w", NULL, NULL, NULL);
  pl_expr L = pl_sub(p, pl_square(p, dot(k, x)), pl_mul(p, pl_square(p, w), pl_square(p, x)));
  load(k, PL_L_LAGRANGIAN, L, NULL);
  check_is_clean(k);
  has_unit(k, w, "1/s");
  kit_free(k);
}

PL_TEST(a_multiplier_of_a_velocity_constraint) {
  pl_expr m, x;
  kit* k = particle(NULL, &m, &x);
  pl_expr v = param(k, "v", "1", "m/s", NULL);
  pl_symbol lambda = constraint(k, named("c"), dot(k, x), PL_EQ, v, NULL, NULL);
  check_tells(k, PL_N092);
  has_unit(k, pl_sym(k->m->pool, lambda), "N");
  kit_free(k);
}

PL_TEST(result_names_have_units) {
  pl_expr m, x;
  kit* k = particle(NULL, &m, &x);
  pl_symbol E = pl_model_result_symbol(k->m, PL_RES_E, NULL),
            F = pl_model_result_symbol(k->m, PL_RES_FORCE_NORM, "c");
  assert_int_equal(E.id, pl_model_result_symbol(k->m, PL_RES_E, NULL).id);
  assert_int_not_equal(F.id, pl_model_result_symbol(k->m, PL_RES_FORCE_NORM, "d").id);
  check_is_clean(k);
  has_unit(k, pl_sym(k->m->pool, E), "J");
  has_unit(k, pl_sym(k->m->pool, F), "N");
  assert_int_equal(pl_model_result_name(k->m, F)->kind, PL_RES_FORCE_NORM);
  assert_string_equal(pl_model_result_name(k->m, F)->label, "c");
  kit_free(k);
}

PL_TEST(huge_exponents_are_left_alone) {
  pl_expr m, x;
  kit* k = particle(NULL, &m, &x);
  pl_expr c = param(k, "c", NULL, NULL, NULL);
  pl_expr e = x;
  for (int i = 0; i < 12; i++) e = pl_pow_int(k->m->pool, e, 97);
  load(k, PL_L_POTENTIAL, pl_mul(k->m->pool, c, e), NULL);
  pl_model_check(&k->job, k->m);
  pl_dimension d;
  assert_false(pl_model_dimension(k->m, c, &d));
  kit_free(k);
}

// ------------------------------------------------------------------------------------------ memory
// The n-th allocation fails, for every n: the check unwinds to the guard and nothing is lost.
typedef struct short_memory {
  long left, blocks;
} short_memory;

static void* take(void* user, size_t size) {
  short_memory* s = user;
  if (s->left-- <= 0) return NULL;
  s->blocks++;
  return malloc(size);
}

static void give(void* user, void* block) {
  short_memory* s = user;
  if (block) s->blocks--;
  free(block);
}

PL_TEST(short_memory_ends_cleanly) {
  volatile bool complete = false;
  for (volatile long n = 0; !complete && n < 1000; n++) {
    short_memory s = {n, 0};
    pleuel_allocator alloc = {take, give, &s};
    pl_arena* arena = pl_arena_make(&alloc);
    if (!arena) continue;
    pl_guard guard;
    PL_GUARD(arena, guard) {
      kit* k = kit_in(arena, atwood_text);
      atwood_fill(k, true);
      assert_int_equal(pl_model_check(&k->job, k->m), PLEUEL_MODEL_ERROR);
      complete = true;
    }
    else {
      assert_int_equal(guard.status, PLEUEL_NO_MEMORY);
    }
    pl_guard_end(arena, &guard);
    pl_arena_free(arena);
    assert_int_equal(s.blocks, 0);
  }
  assert_true(complete);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(atwood_gives_every_name_its_unit),
      cmocka_unit_test(units_leave_the_model_after_the_check),
      cmocka_unit_test(atwood_classes_and_signs),
      cmocka_unit_test(a_length_cannot_equal_an_acceleration),
      cmocka_unit_test(crank_squares_and_angles_fit),
      cmocka_unit_test(ski_one_sided_contact_in_polar_coordinates),
      cmocka_unit_test(an_abbreviation_is_checked_where_it_stands),
      cmocka_unit_test(without_units_nothing_is_checked),
      cmocka_unit_test(classes_follow_from_use_without_units),
      cmocka_unit_test(torques_are_no_energies),
      cmocka_unit_test(an_angle_alone_does_not_switch_the_checks_on),
      cmocka_unit_test(a_mass_statement_wants_a_mass),
      cmocka_unit_test(a_point_wants_lengths),
      cmocka_unit_test(a_sine_wants_a_pure_number),
      cmocka_unit_test(a_number_that_may_have_a_unit_is_suspected),
      cmocka_unit_test(an_exponent_is_a_pure_number),
      cmocka_unit_test(terms_of_a_sum_have_one_unit),
      cmocka_unit_test(gravity_is_an_acceleration),
      cmocka_unit_test(a_start_value_in_the_wrong_unit),
      cmocka_unit_test(a_unit_that_contradicts_its_value),
      cmocka_unit_test(a_simulation_runs_over_time),
      cmocka_unit_test(one_mistake_is_told_once),
      cmocka_unit_test(two_mistakes_are_told_both),
      cmocka_unit_test(squares_and_roots_are_solved),
      cmocka_unit_test(a_parameter_of_a_potential_gets_its_unit),
      cmocka_unit_test(bare_numbers_take_the_fitting_unit_with_a_note),
      cmocka_unit_test(zero_needs_no_unit),
      cmocka_unit_test(a_spring_and_a_damper_have_units),
      cmocka_unit_test(a_lagrangian_per_mass_is_fine),
      cmocka_unit_test(a_multiplier_of_a_velocity_constraint),
      cmocka_unit_test(result_names_have_units),
      cmocka_unit_test(huge_exponents_are_left_alone),
      cmocka_unit_test(short_memory_ends_cleanly),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
