// What a user can get wrong: each mistake is told with its own code, and its right neighbour is
// not.
#include "model/model_test_kit.h"

// A particle in the plane; the tests add one wrong statement.
typedef struct plane {
  kit* k;
  pl_pool* p;
  pl_expr m, x, y, g;
} plane;

static plane plane_make(const char* text) {
  plane a = {.k = kit_make(text)};
  a.p = a.k->m->pool;
  a.m = param(a.k, "m", "2", NULL, "param m");
  a.g = param(a.k, "g", "9.81", NULL, "param g");
  a.x = coord(a.k, "x", NULL, "coord x");
  a.y = coord(a.k, "y", NULL, "coord x");
  mass(a.k, "A", a.m, point2(a.x, a.y), "mass A");
  gravity(a.k, a.g, 1, -1, "gravity");
  return a;
}

static pl_expr number(plane* a, const char* text) { return num(a->k, text, NULL); }

static void tells(plane* a, pl_code code) {
  const pl_diagnostic* d = check_tells(a->k, code);
  assert_true(strlen(printed(a->k, d)) > 10);
  kit_free(a->k);
}

PL_TEST(a_plain_particle_is_fine) {
  plane a = plane_make(NULL);
  check_is_clean(a.k);
  assert_int_equal(a.k->diagnostics.list.n, 0);
  assert_int_equal(a.k->m->n_axes, 2);
  assert_string_equal(a.k->m->axes[0].name, "x");
  assert_string_equal(a.k->m->axes[1].direction, "up");
  kit_free(a.k);
}

// ------------------------------------------------------------------------------------------- names
PL_TEST(two_thetas_are_refused) {
  plane a = plane_make(NULL);
  pl_symbol s = name_symbol(a.k, "θ", "theta", PL_R_COORD, NULL),
            t = name_symbol(a.k, "ϑ2", "theta2", PL_R_COORD, NULL);
  pl_push(a.k->arena, a.k->m->coords, (pl_coord){.symbol = s});
  pl_push(a.k->arena, a.k->m->coords, (pl_coord){.symbol = t});
  tells(&a, PL_E059);
}

PL_TEST(a_label_used_twice_is_found) {
  plane a = plane_make(NULL);
  mass(a.k, "A", a.m, point2(a.x, a.y), NULL);
  tells(&a, PL_E034);
}

PL_TEST(a_mass_and_a_constraint_may_share_a_label) {
  plane a = plane_make(NULL);
  constraint(a.k, named("A"), a.x, PL_EQ, number(&a, "1"), NULL, NULL);
  check_is_clean(a.k);
  kit_free(a.k);
}

// -------------------------------------------------------------------------------------- components
PL_TEST(a_point_with_too_many_components_is_found) {
  plane a = plane_make(NULL);
  a.k->m->n_axes = 2;
  a.k->m->axes[0] = (pl_axis){"x", "x", "right", true};
  a.k->m->axes[1] = (pl_axis){"y", "y", "up", true};
  mass(a.k, "B", a.m, point3(a.x, a.y, a.x), NULL);
  tells(&a, PL_E035);
}

PL_TEST(points_of_different_length_are_found_without_axes) {
  plane a = plane_make(NULL);
  mass(a.k, "B", a.m, (pl_point){.n = 1, .at = {a.x}}, NULL);
  tells(&a, PL_E035);
}

PL_TEST(a_force_needs_a_component_for_each_axis) {
  plane a = plane_make(NULL);
  pl_push(a.k->arena, a.k->m->loads,
          (pl_load){.kind = PL_L_FORCE,
                    .name = named("F"),
                    .vector = {number(&a, "1")},
                    .a = point2(a.x, a.y)});
  tells(&a, PL_E035);
}

PL_TEST(gravity_along_an_unknown_axis_is_found) {
  plane a = plane_make(NULL);
  a.k->m->gravities.at[0].axis = -1;
  tells(&a, PL_E029);
}

PL_TEST(a_body_lives_in_a_plane) {
  plane a = plane_make(NULL);
  a.k->m->masses.n = 0;
  pl_push(a.k->arena, a.k->m->bodies,
          (pl_body){.name = named("B"),
                    .mass = a.m,
                    .inertia = a.m,
                    .angle = a.x,
                    .centre = point3(a.x, a.y, a.x)});
  tells(&a, PL_E035);
}

// ------------------------------------------------------------------------------- kinds of quantity
PL_TEST(a_mass_that_depends_on_time_is_refused) {
  plane a = plane_make(NULL);
  mass(a.k, "B", pl_mul(a.p, a.m, pl_sym(a.p, pl_time(a.p))), point2(a.x, a.y), NULL);
  tells(&a, PL_E056);
}

PL_TEST(a_mass_that_depends_on_the_motion_is_refused) {
  plane a = plane_make(NULL);
  mass(a.k, "B", a.x, point2(a.x, a.y), NULL);
  tells(&a, PL_E056);
}

PL_TEST(a_mass_of_zero_is_refused) {
  plane a = plane_make(NULL);
  a.k->m->params.at[0].value = pl_int(a.p, 0);
  tells(&a, PL_E036);
}

PL_TEST(a_negative_stiffness_is_refused) {
  plane a = plane_make(NULL);
  pl_push(a.k->arena, a.k->m->loads,
          (pl_load){.kind = PL_L_SPRING,
                    .name = named("s"),
                    .value = number(&a, "-1"),
                    .rest = number(&a, "0"),
                    .a = point2(a.x, a.y),
                    .b = point2(pl_int(a.p, 0), pl_int(a.p, 0))});
  tells(&a, PL_E036);
}

PL_TEST(a_spring_between_a_point_and_itself_is_found) {
  plane a = plane_make(NULL);
  pl_push(a.k->arena, a.k->m->loads,
          (pl_load){.kind = PL_L_SPRING,
                    .name = named("s"),
                    .value = number(&a, "1"),
                    .rest = number(&a, "0"),
                    .a = point2(a.x, a.y),
                    .b = point2(a.x, a.y)});
  tells(&a, PL_E064);
}

PL_TEST(a_potential_cannot_contain_an_acceleration) {
  plane a = plane_make(NULL);
  load(a.k, PL_L_POTENTIAL, dot(a.k, dot(a.k, a.x)), NULL);
  tells(&a, PL_E057);
}

PL_TEST(a_potential_may_contain_a_velocity) {
  plane a = plane_make(NULL);
  load(a.k, PL_L_POTENTIAL, pl_mul(a.p, a.x, dot(a.k, a.y)), NULL);
  check_is_clean(a.k);
  kit_free(a.k);
}

PL_TEST(a_potential_cannot_contain_a_multiplier) {
  plane a = plane_make(NULL);
  pl_symbol lambda = constraint(a.k, named("c"), a.x, PL_EQ, number(&a, "1"), NULL, NULL);
  load(a.k, PL_L_POTENTIAL, pl_mul(a.p, a.x, pl_sym(a.p, lambda)), NULL);
  tells(&a, PL_E057);
}

PL_TEST(a_lagrangian_beside_masses_is_refused) {
  plane a = plane_make(NULL);
  load(a.k, PL_L_LAGRANGIAN, pl_square(a.p, dot(a.k, a.x)), NULL);
  tells(&a, PL_E054);
}

PL_TEST(gravity_cannot_depend_on_the_motion) {
  plane a = plane_make(NULL);
  a.k->m->gravities.at[0].g = pl_mul(a.p, a.g, a.x);
  tells(&a, PL_E057);
}

PL_TEST(a_division_by_zero_is_told) {
  plane a = plane_make(NULL);
  load(a.k, PL_L_POTENTIAL, pl_div(a.p, a.x, pl_int(a.p, 0)), NULL);
  tells(&a, PL_E040);
}

// ------------------------------------------------------------------------------------- constraints
PL_TEST(a_constraint_without_coordinate_is_refused) {
  plane a = plane_make(NULL);
  constraint(a.k, named("c"), a.m, PL_EQ, a.g, NULL, NULL);
  tells(&a, PL_E051);
}

// Wrong in kind and in unit: the kind is told, the unit would be an echo.
PL_TEST(one_statement_is_not_blamed_twice) {
  kit* k = kit_make("constraint c: m = l\n");
  pl_expr m = param(k, "m", "1", "kg", NULL), l = param(k, "l", "1", "m", NULL),
          x = coord(k, "x", NULL, NULL);
  mass(k, "A", m, (pl_point){.n = 1, .at = {x}}, NULL);
  constraint(k, named("c"), m, PL_EQ, l, NULL, "constraint c: m = l");
  check_tells(k, PL_E051);
  kit_free(k);
}

PL_TEST(a_constraint_that_is_always_true_is_noted) {
  plane a = plane_make(NULL);
  constraint(a.k, named("c"), a.x, PL_EQ, a.x, NULL, NULL);
  tells(&a, PL_N053);
}

PL_TEST(a_constraint_with_an_acceleration_is_refused) {
  plane a = plane_make(NULL);
  constraint(a.k, named("c"), dot(a.k, dot(a.k, a.x)), PL_EQ, a.g, NULL, NULL);
  tells(&a, PL_E057);
}

// x' = 2 y' + 3: the integral is named.
PL_TEST(a_constraint_that_can_be_integrated_is_told_so) {
  plane a = plane_make(NULL);
  pl_expr right = pl_add(a.p, pl_mul(a.p, pl_int(a.p, 2), dot(a.k, a.y)), pl_int(a.p, 3));
  constraint(a.k, named("c"), dot(a.k, a.x), PL_EQ, right, NULL, NULL);
  const pl_diagnostic* d = check_tells(a.k, PL_N092);
  assert_non_null(strstr(d->sentence[0], "can be integrated"));
  assert_non_null(strstr(d->fix[0], "2 y"));
  assert_non_null(strstr(d->fix[0], "3 t"));
  assert_true(a.k->m->constraints.at[0].has_velocity);
  kit_free(a.k);
}

// y x' = 2 x y' has the integrating factor 1/(x y).
PL_TEST(an_integrating_factor_is_seen) {
  plane a = plane_make(NULL);
  pl_expr right = pl_mul_n(a.p, (pl_expr[]){pl_int(a.p, 2), a.x, dot(a.k, a.y)}, 3);
  constraint(a.k, named("c"), pl_mul(a.p, a.y, dot(a.k, a.x)), PL_EQ, right, NULL, NULL);
  const pl_diagnostic* d = check_tells(a.k, PL_N092);
  assert_non_null(strstr(d->sentence[0], "can be integrated"));
  kit_free(a.k);
}

// The knife edge x' sin φ = y' cos φ: φ has no velocity in it, and yet it is a variable.
PL_TEST(the_knife_edge_is_nonholonomic) {
  plane a = plane_make(NULL);
  pl_expr phi = coord(a.k, "phi", NULL, NULL);
  load(a.k, PL_L_KINETIC, pl_square(a.p, dot(a.k, phi)), NULL);
  constraint(a.k, named("c"), pl_mul(a.p, dot(a.k, a.x), pl_call(a.p, PL_SIN, phi)), PL_EQ,
             pl_mul(a.p, dot(a.k, a.y), pl_call(a.p, PL_COS, phi)), NULL, NULL);
  const pl_diagnostic* d = check_tells(a.k, PL_N092);
  assert_non_null(strstr(d->sentence[0], "nonholonomic"));
  kit_free(a.k);
}

// x' = t y' is not integrable: time is a variable like the others.
PL_TEST(time_in_a_coefficient_counts) {
  plane a = plane_make(NULL);
  pl_expr t = pl_sym(a.p, pl_time(a.p));
  constraint(a.k, named("c"), dot(a.k, a.x), PL_EQ, pl_mul(a.p, t, dot(a.k, a.y)), NULL, NULL);
  const pl_diagnostic* d = check_tells(a.k, PL_N092);
  assert_non_null(strstr(d->sentence[0], "nonholonomic"));
  kit_free(a.k);
}

PL_TEST(a_one_sided_constraint_of_velocities_is_refused) {
  plane a = plane_make(NULL);
  constraint(a.k, named("c"), dot(a.k, a.x), PL_GE, number(&a, "1"), NULL, NULL);
  pl_model_check(&a.k->job, a.k->m);
  assert_int_equal(told(a.k, PL_E057, NULL), 1);
  kit_free(a.k);
}

PL_TEST(a_constraint_not_linear_in_velocities_is_refused) {
  plane a = plane_make(NULL);
  pl_expr v2 = pl_add(a.p, pl_square(a.p, dot(a.k, a.x)), pl_square(a.p, dot(a.k, a.y)));
  constraint(a.k, named("c"), v2, PL_EQ, a.g, NULL, NULL);
  tells(&a, PL_E039);
}

// (x' + 1)² - x'² is linear although it does not look so.
PL_TEST(hidden_linearity_is_seen) {
  plane a = plane_make(NULL);
  pl_expr v = dot(a.k, a.x);
  constraint(a.k, named("c"), pl_square(a.p, pl_add(a.p, v, pl_int(a.p, 1))), PL_EQ,
             pl_square(a.p, v), NULL, NULL);
  tells(&a, PL_N092);
}

PL_TEST(while_needs_a_contact) {
  plane a = plane_make(NULL);
  constraint(a.k, named("floor"), a.y, PL_EQ, number(&a, "0"), NULL, NULL);
  constraint(a.k, named("roll"), a.x, PL_EQ, number(&a, "0"), NULL, NULL);
  a.k->m->constraints.at[1].while_label = "floor";
  tells(&a, PL_E063);
}

// ----------------------------------------------------------------------------------------- numbers
PL_TEST(parameters_in_a_circle_are_found) {
  plane a = plane_make(NULL);
  pl_expr b = param(a.k, "b", NULL, NULL, NULL);
  a.k->m->params.at[0].value = b;
  a.k->m->params.at[2].value = pl_mul(a.p, pl_int(a.p, 2), a.m);
  tells(&a, PL_E049);
}

PL_TEST(parameters_through_others_have_values) {
  plane a = plane_make(NULL);
  pl_expr b = param(a.k, "b", NULL, NULL, NULL);
  a.k->m->params.at[0].value = pl_mul(a.p, pl_int(a.p, 2), b);  // before b
  a.k->m->params.at[2].value = pl_int(a.p, 21);
  const double* v = pl_model_values(a.k->m, a.k->arena);
  assert_true(fabs(v[pl_symbol_of(a.p, a.m).id] - 42) < 1e-12);
  kit_free(a.k);
}

PL_TEST(an_assumption_against_the_numbers_is_found) {
  plane a = plane_make(NULL);
  pl_push(a.k->arena, a.k->m->assumptions,
          (pl_assumption){.kind = PL_A_RELATION, .condition = {a.g, a.m, PL_LT, {0}}});
  tells(&a, PL_E060);
}

PL_TEST(an_integer_that_is_none_is_found) {
  plane a = plane_make(NULL);
  pl_push(a.k->arena, a.k->m->assumptions, (pl_assumption){.kind = PL_A_INTEGER, .subject = a.g});
  tells(&a, PL_E060);
}

PL_TEST(signs_follow_numbers_and_assumptions) {
  plane a = plane_make(NULL);
  pl_expr b = param(a.k, "b", "-3", NULL, NULL), c = param(a.k, "c", NULL, NULL, NULL),
          d = param(a.k, "d", NULL, NULL, NULL), e = param(a.k, "e", "0", NULL, NULL);
  pl_push(a.k->arena, a.k->m->assumptions,
          (pl_assumption){.kind = PL_A_RELATION, .condition = {d, pl_int(a.p, 0), PL_LT, {0}}});
  load(a.k, PL_L_POTENTIAL, pl_mul(a.p, a.x, pl_add_n(a.p, (pl_expr[]){b, c, d, e}, 4)), NULL);
  check_is_clean(a.k);
  assert_int_equal(pl_symbol_get(a.p, pl_symbol_of(a.p, a.m))->sign, PL_SIGN_POSITIVE);
  assert_int_equal(pl_symbol_get(a.p, pl_symbol_of(a.p, b))->sign, PL_SIGN_ANY);
  assert_int_equal(pl_symbol_get(a.p, pl_symbol_of(a.p, c))->sign, PL_SIGN_POSITIVE);
  assert_int_equal(pl_symbol_get(a.p, pl_symbol_of(a.p, d))->sign, PL_SIGN_NEGATIVE);
  assert_int_equal(pl_symbol_get(a.p, pl_symbol_of(a.p, e))->sign, PL_SIGN_ANY);
  kit_free(a.k);
}

// ------------------------------------------------------------------------------------------- start
PL_TEST(a_start_value_given_twice_is_found) {
  plane a = plane_make("init x = 1\ninit x = 2\n");
  init(a.k, a.x, number(&a, "1"), "init x = 1");
  init(a.k, a.x, number(&a, "2"), "init x = 2");
  const pl_diagnostic* d = check_tells(a.k, PL_E044);
  assert_int_equal(pl_span_place(d->span).line, 2);
  kit_free(a.k);
}

PL_TEST(position_and_velocity_are_two_start_values) {
  plane a = plane_make(NULL);
  init(a.k, a.x, number(&a, "1"), NULL);
  init(a.k, dot(a.k, a.x), number(&a, "1"), NULL);
  check_is_clean(a.k);
  kit_free(a.k);
}

PL_TEST(start_values_in_a_circle_are_found) {
  plane a = plane_make(NULL);
  init(a.k, a.x, a.y, NULL);
  init(a.k, a.y, pl_mul(a.p, pl_int(a.p, 2), a.x), NULL);
  tells(&a, PL_E045);
}

PL_TEST(a_start_value_with_a_multiplier_is_refused) {
  plane a = plane_make(NULL);
  pl_symbol lambda = constraint(a.k, named("c"), a.x, PL_EQ, number(&a, "1"), NULL, NULL);
  init(a.k, a.y, pl_sym(a.p, lambda), NULL);
  tells(&a, PL_E046);
}

PL_TEST(a_parameter_has_no_start_value) {
  plane a = plane_make(NULL);
  init(a.k, a.m, number(&a, "1"), NULL);
  tells(&a, PL_E030);
}

PL_TEST(a_start_against_a_constraint_is_found) {
  plane a = plane_make(NULL);
  constraint(a.k, named("c"), pl_add(a.p, pl_square(a.p, a.x), pl_square(a.p, a.y)), PL_EQ,
             number(&a, "1"), NULL, NULL);
  init(a.k, a.x, number(&a, "1"), NULL);
  init(a.k, a.y, number(&a, "0.5"), NULL);
  tells(&a, PL_E041);
}

// The other values kept, x = ± √0.75 would fit; the branch leaves one of them.
PL_TEST(a_start_that_would_fit_is_named) {
  plane a = plane_make(NULL);
  constraint(a.k, named("c"), pl_add(a.p, pl_square(a.p, a.x), pl_square(a.p, a.y)), PL_EQ,
             number(&a, "1"), NULL, NULL);
  pl_push(a.k->arena, a.k->m->branches, (pl_condition){a.x, pl_int(a.p, 0), PL_LT, {0}});
  init(a.k, a.y, number(&a, "0.5"), NULL);
  init(a.k, a.x, number(&a, "2"), NULL);
  const pl_diagnostic* d = check_tells(a.k, PL_E041);
  assert_string_equal(
      d->fix[0], "x = -0.866025404 would fit. Change it, or remove it from init and let it follow");
  kit_free(a.k);
}

// x = √0.75 would fit c, but then d is violated: no single value helps.
PL_TEST(a_value_that_another_constraint_refuses_is_not_proposed) {
  plane a = plane_make(NULL);
  constraint(a.k, named("c"), pl_add(a.p, pl_square(a.p, a.x), pl_square(a.p, a.y)), PL_EQ,
             number(&a, "1"), NULL, NULL);
  constraint(a.k, named("d"), pl_add(a.p, a.x, a.y), PL_EQ, number(&a, "1"), NULL, NULL);
  init(a.k, a.y, number(&a, "0.5"), NULL);
  init(a.k, a.x, number(&a, "0.5"), NULL);
  const pl_diagnostic* d = check_tells(a.k, PL_E041);
  assert_null(strstr(d->fix[0], "would fit"));
  kit_free(a.k);
}

// y enters as cos y: of all turns one is named.
PL_TEST(an_angle_that_would_fit_is_named_without_whole_turns) {
  plane a = plane_make(NULL);
  pl_expr cosine = pl_call(a.p, PL_COS, a.y);
  constraint(a.k, named("c"), pl_add(a.p, a.x, cosine), PL_EQ, number(&a, "1"), NULL, NULL);
  init(a.k, a.x, number(&a, "0.5"), NULL);
  init(a.k, a.y, number(&a, "9"), NULL);
  const pl_diagnostic* d = check_tells(a.k, PL_E041);
  assert_non_null(strstr(d->fix[0], "y = "));
  assert_non_null(strstr(d->fix[0], "1.04719755"));
  assert_null(strstr(d->fix[0], "5.2"));
  assert_null(strstr(d->fix[0], "7.33"));
  kit_free(a.k);
}

PL_TEST(a_start_on_the_wrong_side_is_found) {
  plane a = plane_make(NULL);
  constraint(a.k, named("h"), a.y, PL_GE, number(&a, "1"), NULL, NULL);
  init(a.k, a.y, number(&a, "0.5"), NULL);
  tells(&a, PL_E041);
}

PL_TEST(a_start_on_the_right_side_is_fine) {
  plane a = plane_make(NULL);
  constraint(a.k, named("h"), a.y, PL_GE, number(&a, "1"), NULL, NULL);
  constraint(a.k, named("c"), pl_add(a.p, pl_square(a.p, a.x), pl_square(a.p, a.y)), PL_EQ,
             number(&a, "25"), NULL, NULL);
  init(a.k, a.y, number(&a, "4"), NULL);
  init(a.k, a.x, number(&a, "3"), NULL);
  check_is_clean(a.k);
  kit_free(a.k);
}

PL_TEST(a_start_through_other_values_is_followed) {
  plane a = plane_make(NULL);
  constraint(a.k, named("c"), a.y, PL_EQ, pl_mul(a.p, pl_int(a.p, 2), a.x), NULL, NULL);
  init(a.k, a.y, pl_mul(a.p, pl_int(a.p, 2), a.x), NULL);
  init(a.k, a.x, number(&a, "3"), NULL);
  check_is_clean(a.k);
  kit_free(a.k);
}

PL_TEST(a_simulation_that_ends_before_it_starts_is_found) {
  plane a = plane_make(NULL);
  a.k->m->simulate = (pl_simulate){.given = true, .from = pl_int(a.p, 3), .to = pl_int(a.p, 2)};
  tells(&a, PL_E047);
}

PL_TEST(a_simulation_needs_numbers) {
  plane a = plane_make(NULL);
  a.k->m->simulate = (pl_simulate){.given = true, .from = pl_int(a.p, 0), .to = pl_int(a.p, 2)};
  a.k->m->params.at[0].value = pl_poison();
  const pl_diagnostic* d = check_tells(a.k, PL_E048);
  assert_non_null(strstr(d->sentence[0], "m has no number"));
  kit_free(a.k);
}

PL_TEST(without_a_simulation_letters_are_enough) {
  plane a = plane_make(NULL);
  a.k->m->params.at[0].value = pl_poison();
  check_is_clean(a.k);
  kit_free(a.k);
}

// ------------------------------------------------------------------------ choose, events, requests
static void choose(plane* a, pl_expr q, struct pl_map_equation* maps, int n) {
  pl_push(a->k->arena, a->k->m->choose.coords, pl_symbol_of(a->p, q));
  a->k->m->choose.maps = maps;
  a->k->m->choose.n_maps = n;
}

PL_TEST(a_map_that_leads_back_is_found) {
  plane a = plane_make(NULL);
  pl_expr q = coord(a.k, "q", NULL, NULL);
  struct pl_map_equation maps[] = {{a.x, a.y, {0}}, {a.y, pl_mul(a.p, q, a.x), {0}}};
  choose(&a, q, maps, 2);
  tells(&a, PL_E058);
}

PL_TEST(a_map_of_a_parameter_is_found) {
  plane a = plane_make(NULL);
  pl_expr q = coord(a.k, "q", NULL, NULL);
  struct pl_map_equation maps[] = {{a.m, q, {0}}};
  choose(&a, q, maps, 1);
  tells(&a, PL_E058);
}

PL_TEST(two_maps_of_one_coordinate_are_found) {
  plane a = plane_make(NULL);
  pl_expr q = coord(a.k, "q", NULL, NULL);
  struct pl_map_equation maps[] = {{a.x, q, {0}}, {a.x, pl_square(a.p, q), {0}}};
  choose(&a, q, maps, 2);
  tells(&a, PL_E058);
}

PL_TEST(a_chosen_coordinate_without_map_is_found) {
  plane a = plane_make(NULL);
  pl_expr q = coord(a.k, "q", NULL, NULL);
  struct pl_map_equation maps[] = {{a.x, a.y, {0}}};
  choose(&a, q, maps, 1);
  tells(&a, PL_E058);
}

PL_TEST(a_map_through_another_old_coordinate_is_fine) {
  plane a = plane_make(NULL);
  pl_expr q = coord(a.k, "q", NULL, NULL);
  struct pl_map_equation maps[] = {{a.x, pl_call(a.p, PL_SIN, q), {0}},
                                   {a.y, pl_add(a.p, a.x, q), {0}}};
  choose(&a, q, maps, 2);
  check_is_clean(a.k);
  kit_free(a.k);
}

static void event(plane* a, pl_expr value, pl_action action) {
  pl_event e = {.name = named("e"), .value = value};
  pl_push(a->k->arena, e.actions, action);
  pl_push(a->k->arena, a->k->m->events, e);
}

PL_TEST(an_event_that_never_changes_is_found) {
  plane a = plane_make(NULL);
  event(&a, a.m, (pl_action){.kind = PL_DO_STOP});
  tells(&a, PL_E062);
}

PL_TEST(an_event_on_energy_or_time_is_fine) {
  plane a = plane_make(NULL);
  event(&a, pl_sub(a.p, pl_sym(a.p, pl_model_result_symbol(a.k->m, PL_RES_E, NULL)), a.m),
        (pl_action){.kind = PL_DO_STOP});
  event(&a, pl_sub(a.p, pl_sym(a.p, pl_time(a.p)), a.m), (pl_action){.kind = PL_DO_STOP});
  a.k->m->events.at[1].name = named("f");
  check_is_clean(a.k);
  kit_free(a.k);
}

PL_TEST(an_acceleration_cannot_be_set) {
  plane a = plane_make(NULL);
  event(&a, a.x,
        (pl_action){.kind = PL_DO_SET, .target = dot(a.k, dot(a.k, a.x)), .value = pl_int(a.p, 0)});
  tells(&a, PL_E063);
}

PL_TEST(what_always_holds_cannot_be_attached) {
  plane a = plane_make(NULL);
  constraint(a.k, named("rope"), a.x, PL_EQ, a.y, NULL, NULL);
  event(&a, a.x, (pl_action){.kind = PL_DO_ATTACH, .label = "rope"});
  tells(&a, PL_E063);
}

PL_TEST(a_parameter_cannot_be_solved_for) {
  plane a = plane_make(NULL);
  pl_push(a.k->arena, a.k->m->asks, (pl_ask){.kind = PL_ASK_SOLVE, .value = a.m});
  tells(&a, PL_E057);
}

PL_TEST(a_frame_is_made_of_coordinates) {
  plane a = plane_make(NULL);
  pl_ask ask = {.kind = PL_ASK_LAGRANGE1};
  pl_push(a.k->arena, ask.frame, pl_symbol_of(a.p, a.m));
  pl_push(a.k->arena, a.k->m->asks, ask);
  tells(&a, PL_E057);
}

// ------------------------------------------------------------------------------------------- notes
PL_TEST(an_unused_coordinate_is_noted) {
  plane a = plane_make("coord x, y, w\n");
  coord(a.k, "w", NULL, "coord x, y, w");
  const pl_diagnostic* d = check_tells(a.k, PL_N062);
  assert_int_equal(pl_span_place(d->span).column, 13);
  kit_free(a.k);
}

PL_TEST(an_unused_parameter_is_noted) {
  plane a = plane_make(NULL);
  param(a.k, "b", "1", NULL, NULL);
  tells(&a, PL_N063);
}

PL_TEST(a_parameter_used_in_a_plot_is_used) {
  plane a = plane_make(NULL);
  pl_expr b = param(a.k, "b", "1", NULL, NULL);
  pl_plot plot = {.x = a.x};
  pl_push(a.k->arena, plot.y, pl_mul(a.p, a.y, b));
  pl_push(a.k->arena, a.k->m->plots, plot);
  check_is_clean(a.k);
  assert_int_equal(a.k->diagnostics.list.n, 0);
  kit_free(a.k);
}

PL_TEST(a_mass_that_stands_still_is_noted) {
  plane a = plane_make(NULL);
  mass(a.k, "B", a.m, point2(pl_int(a.p, 0), pl_int(a.p, 1)), NULL);
  tells(&a, PL_N065);
}

PL_TEST(gravity_without_mass_is_noted) {
  plane a = plane_make(NULL);
  a.k->m->masses.n = 0;
  load(a.k, PL_L_KINETIC,
       pl_mul(a.p, a.m, pl_add(a.p, pl_square(a.p, dot(a.k, a.x)), pl_square(a.p, dot(a.k, a.y)))),
       NULL);
  tells(&a, PL_N064);
}

PL_TEST(gravity_twice_is_noted) {
  plane a = plane_make(NULL);
  gravity(a.k, a.g, 0, 1, NULL);
  tells(&a, PL_N066);
}

PL_TEST(a_coordinate_without_mass_is_noted) {
  plane a = plane_make(NULL);
  pl_expr s = coord(a.k, "s", NULL, NULL);
  constraint(a.k, named("c"), a.x, PL_EQ, s, NULL, NULL);
  tells(&a, PL_N067);
}

PL_TEST(a_model_without_coordinates_is_refused) {
  kit* k = kit_make(NULL);
  mass(k, "A", num(k, "1", NULL), point2(num(k, "1", NULL), num(k, "1", NULL)), NULL);
  check_tells(k, PL_E053);
  kit_free(k);
}

PL_TEST(an_empty_model_is_refused) {
  kit* k = kit_make(NULL);
  check_tells(k, PL_E053);
  kit_free(k);
}

PL_TEST(a_file_without_masses_is_legal) {
  kit* k = kit_make(NULL);
  pl_expr x = coord(k, "x", NULL, NULL), phi = coord(k, "phi", NULL, NULL);
  constraint(k, named("c"), x, PL_EQ, pl_call(k->m->pool, PL_COS, phi), NULL, NULL);
  constraint(k, named("d"), phi, PL_EQ, pl_sym(k->m->pool, pl_time(k->m->pool)), NULL, NULL);
  check_is_clean(k);
  assert_int_equal(k->diagnostics.list.n, 0);
  kit_free(k);
}

// -------------------------------------------------------------------------------------------- dump
PL_TEST(a_dump_shows_every_statement) {
  plane a = plane_make(NULL);
  constraint(a.k, named("rod"), pl_add(a.p, pl_square(a.p, a.x), pl_square(a.p, a.y)), PL_EQ,
             number(&a, "25"), NULL, NULL);
  init(a.k, a.x, number(&a, "3"), NULL);
  event(&a, a.y, (pl_action){.kind = PL_DO_STOP});
  check_is_clean(a.k);
  pl_text t = pl_text_make(a.k->arena);
  pl_model_dump(&t, a.k->m);
  const char* text = pl_text_string(&t);
  assert_non_null(strstr(text, "param m = 2  mass  > 0\n"));
  assert_non_null(strstr(text, "axes x right, y up\n"));
  assert_non_null(strstr(text, "mass A: m at (x, y)\n"));
  assert_non_null(strstr(text, "gravity g along -y\n"));
  assert_non_null(strstr(text, "constraint rod: x^2 + y^2 = 25"));
  assert_non_null(strstr(text, "init x = 3\n"));
  assert_non_null(strstr(text, "event e: when y = 0 -> stop\n"));
  kit_free(a.k);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_plain_particle_is_fine),
      cmocka_unit_test(two_thetas_are_refused),
      cmocka_unit_test(a_label_used_twice_is_found),
      cmocka_unit_test(a_mass_and_a_constraint_may_share_a_label),
      cmocka_unit_test(a_point_with_too_many_components_is_found),
      cmocka_unit_test(points_of_different_length_are_found_without_axes),
      cmocka_unit_test(a_force_needs_a_component_for_each_axis),
      cmocka_unit_test(gravity_along_an_unknown_axis_is_found),
      cmocka_unit_test(a_body_lives_in_a_plane),
      cmocka_unit_test(a_mass_that_depends_on_time_is_refused),
      cmocka_unit_test(a_mass_that_depends_on_the_motion_is_refused),
      cmocka_unit_test(a_mass_of_zero_is_refused),
      cmocka_unit_test(a_negative_stiffness_is_refused),
      cmocka_unit_test(a_spring_between_a_point_and_itself_is_found),
      cmocka_unit_test(a_potential_cannot_contain_an_acceleration),
      cmocka_unit_test(a_potential_may_contain_a_velocity),
      cmocka_unit_test(a_potential_cannot_contain_a_multiplier),
      cmocka_unit_test(a_lagrangian_beside_masses_is_refused),
      cmocka_unit_test(gravity_cannot_depend_on_the_motion),
      cmocka_unit_test(a_division_by_zero_is_told),
      cmocka_unit_test(a_constraint_without_coordinate_is_refused),
      cmocka_unit_test(one_statement_is_not_blamed_twice),
      cmocka_unit_test(a_constraint_that_is_always_true_is_noted),
      cmocka_unit_test(a_constraint_with_an_acceleration_is_refused),
      cmocka_unit_test(a_constraint_that_can_be_integrated_is_told_so),
      cmocka_unit_test(an_integrating_factor_is_seen),
      cmocka_unit_test(the_knife_edge_is_nonholonomic),
      cmocka_unit_test(time_in_a_coefficient_counts),
      cmocka_unit_test(a_one_sided_constraint_of_velocities_is_refused),
      cmocka_unit_test(a_constraint_not_linear_in_velocities_is_refused),
      cmocka_unit_test(hidden_linearity_is_seen),
      cmocka_unit_test(while_needs_a_contact),
      cmocka_unit_test(parameters_in_a_circle_are_found),
      cmocka_unit_test(parameters_through_others_have_values),
      cmocka_unit_test(an_assumption_against_the_numbers_is_found),
      cmocka_unit_test(an_integer_that_is_none_is_found),
      cmocka_unit_test(signs_follow_numbers_and_assumptions),
      cmocka_unit_test(a_start_value_given_twice_is_found),
      cmocka_unit_test(position_and_velocity_are_two_start_values),
      cmocka_unit_test(start_values_in_a_circle_are_found),
      cmocka_unit_test(a_start_value_with_a_multiplier_is_refused),
      cmocka_unit_test(a_parameter_has_no_start_value),
      cmocka_unit_test(a_start_against_a_constraint_is_found),
      cmocka_unit_test(a_start_that_would_fit_is_named),
      cmocka_unit_test(a_value_that_another_constraint_refuses_is_not_proposed),
      cmocka_unit_test(an_angle_that_would_fit_is_named_without_whole_turns),
      cmocka_unit_test(a_start_on_the_wrong_side_is_found),
      cmocka_unit_test(a_start_on_the_right_side_is_fine),
      cmocka_unit_test(a_start_through_other_values_is_followed),
      cmocka_unit_test(a_simulation_that_ends_before_it_starts_is_found),
      cmocka_unit_test(a_simulation_needs_numbers),
      cmocka_unit_test(without_a_simulation_letters_are_enough),
      cmocka_unit_test(a_map_that_leads_back_is_found),
      cmocka_unit_test(a_map_of_a_parameter_is_found),
      cmocka_unit_test(two_maps_of_one_coordinate_are_found),
      cmocka_unit_test(a_chosen_coordinate_without_map_is_found),
      cmocka_unit_test(a_map_through_another_old_coordinate_is_fine),
      cmocka_unit_test(an_event_that_never_changes_is_found),
      cmocka_unit_test(an_event_on_energy_or_time_is_fine),
      cmocka_unit_test(an_acceleration_cannot_be_set),
      cmocka_unit_test(what_always_holds_cannot_be_attached),
      cmocka_unit_test(a_parameter_cannot_be_solved_for),
      cmocka_unit_test(a_frame_is_made_of_coordinates),
      cmocka_unit_test(an_unused_coordinate_is_noted),
      cmocka_unit_test(an_unused_parameter_is_noted),
      cmocka_unit_test(a_parameter_used_in_a_plot_is_used),
      cmocka_unit_test(a_mass_that_stands_still_is_noted),
      cmocka_unit_test(gravity_without_mass_is_noted),
      cmocka_unit_test(gravity_twice_is_noted),
      cmocka_unit_test(a_coordinate_without_mass_is_noted),
      cmocka_unit_test(a_model_without_coordinates_is_refused),
      cmocka_unit_test(an_empty_model_is_refused),
      cmocka_unit_test(a_file_without_masses_is_legal),
      cmocka_unit_test(a_dump_shows_every_statement),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
