// Generalized coordinates, closed loops, proposed coordinates: maps satisfy the constraints,
// velocities are what differences of the maps give.
#include "mechanics_test_kit.h"
#include "propose.h"

#define CIRCLE                                                                          \
  "param m = 1, l = 2, g = 9.81\ncoord x, y\naxes X right, Y up\nmass A: m at (x, y)\n" \
  "gravity g along -Y\nconstraint rod: x^2 + y^2 = l^2\n"

static void a_chosen_map_solves_its_constraint(void** state) {
  (void)state;
  kit* k = kit_open(CIRCLE "choose phi with x = l sin phi, y = -l cos phi\n");
  pl_analysis* d = k->d;
  assert_true(d->reduced);
  assert_int_equal(d->gen.n, 1);
  kit_is(k, pl_on_maps(d, d->g.at[0].g), "0");
  kit_is(k, d->Lg, "m l^2 phi'^2/2 + m g l cos phi");
  kit_is(k, d->acceleration[kit_coordinate(k, "phi")], "-g sin(phi)/l");
  kit_is(k, pl_second_kind(d, d->gen.at[0]), "m l^2 phi'' + m g l sin phi");
  kit_free(k);
}

static void a_coordinate_leads_and_the_start_picks_the_root(void** state) {
  (void)state;
  kit* k = kit_open(CIRCLE "choose x\ninit x = 1, y = -sqrt(3)\n");
  pl_analysis* d = k->d;
  const pl_variable* y = &d->q.at[kit_coordinate(k, "y")];
  assert_true(d->reduced && y->by_branch);
  kit_is(k, y->map, "-sqrt(l^2 - x^2)");
  double* at = kit_point(k, 5);
  at[kit_name(k, "l").id] = 2;
  pl_expr v = pl_on_maps(d, pl_sym(d->pool, y->v));
  double rate = kit_slope(k, y->map, kit_name(k, "x"), at)
                * at[d->q.at[kit_coordinate(k, "x")].v.id];
  kit_close(kit_value(k, v, at), rate, 1e-9);
  kit_free(k);
}

static void constants_of_coordinates_are_dropped(void** state) {
  (void)state;
  kit* k = kit_open(
      "param m = 1, h = 2\ncoord x, z\naxes X, Z up\nmass A: m at (x, z)\nconstraint f: z = h\n");
  int z = kit_coordinate(k, "z");
  assert_int_equal(k->d->q.at[z].fixed_by, 0);
  kit_is(k, k->d->q.at[z].fixed, "h");
  kit_is(k, pl_on_fixed(k->d, kit_expr(k, "x + z")), "x + h");
  kit_free(k);
}

static void a_contradiction_is_reported_with_what_is_left(void** state) {
  (void)state;
  kit* k = kit_open(
      "param m = 1, h = 2\ncoord x\naxes X\nmass A: m at (x)\nconstraint a: x = h\n"
      "constraint b: x = h + 1\n");
  assert_int_equal(k->status, PLEUEL_CONTRADICTION);
  assert_int_equal(k->d->contradicting, 1);
  kit_is(k, k->d->contradiction, "-1");
  assert_int_equal(k->diagnostics.list.n, 0);  // mechanics writes no sentence
  kit_free(k);
}

// A four-bar linkage: crank a, coupler b, rocker c, ground d.
#define FOUR_BAR                                                                            \
  "param m = 1, a = 1, b = 3, c = 2.5, d = 3\ncoord alpha, beta, psi\naxes X right, Y up\n" \
  "mass A: m at (a cos alpha, a sin alpha)\n"                                               \
  "constraint u: a cos alpha + b cos beta = d + c cos psi\n"                                \
  "constraint v: a sin alpha + b sin beta = c sin psi\nchoose alpha\n"

static void both_assemblies_of_a_four_bar_close(void** state) {
  (void)state;
  kit* k = kit_open(FOUR_BAR);
  pl_analysis* d = k->d;
  assert_true(d->reduced);
  assert_int_equal(d->loops.n, 1);
  assert_int_equal(pl_assemblies(d), 2);
  double* at = kit_point(k, 7);
  const char* given[] = {"a", "b", "c", "d"};
  const double size[] = {1, 3, 2.5, 3};
  for (int i = 0; i < 4; i++) at[kit_name(k, given[i]).id] = size[i];
  at[kit_name(k, "alpha").id] = 0.8;
  double angle[2];
  for (int way = 0; way < 2; way++) {
    for (int c = 0; c < 2; c++) {
      kit_close(kit_value(k, pl_on_assembly(d, d->g.at[c].g, way), at), 0, 1e-12);
    }
    angle[way] = kit_value(k, pl_on_assembly(d, kit_expr(k, "psi"), way), at);
  }
  assert_true(fabs(angle[0] - angle[1]) > 0.1);
  kit_free(k);
}

static void velocities_of_a_loop_are_slopes_of_its_positions(void** state) {
  (void)state;
  kit* k = kit_open(FOUR_BAR);
  pl_analysis* d = k->d;
  double* at = kit_point(k, 7);
  const char* given[] = {"a", "b", "c", "d"};
  const double size[] = {1, 3, 2.5, 3};
  for (int i = 0; i < 4; i++) at[kit_name(k, given[i]).id] = size[i];
  at[kit_name(k, "alpha").id] = 0.8;
  pl_symbol alpha = kit_name(k, "alpha");
  double turn = at[pl_symbol_dot(d->pool, alpha).id];
  const pl_loop* l = &d->loops.at[0];
  for (int way = 0; way < 2; way++) {
    for (int j = 0; j < l->n; j++) {
      pl_expr q = pl_sym(d->pool, d->q.at[l->coordinate[j]].q);
      double want = kit_slope(k, pl_on_assembly(d, q, way), alpha, at) * turn;
      kit_close(kit_value(k, pl_on_assembly(d, l->written_out[j], way), at), want, 1e-8);
    }
  }
  kit_free(k);
}

static void a_circle_proposes_its_angle(void** state) {
  (void)state;
  kit* k = kit_open(CIRCLE);
  pl_analysis* a = pl_propose(k->d);
  assert_non_null(a);
  assert_true(a != k->d && a->reduced && a->is_proposal);
  assert_int_equal(a->gen.n, 1);
  assert_int_equal(pl_alg_is_zero(a->tower, pl_on_maps(a, a->g.at[0].g)), PL_YES);
  assert_ptr_equal(pl_propose(k->d), a);
  kit_free(k);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_chosen_map_solves_its_constraint),
      cmocka_unit_test(a_coordinate_leads_and_the_start_picks_the_root),
      cmocka_unit_test(constants_of_coordinates_are_dropped),
      cmocka_unit_test(a_contradiction_is_reported_with_what_is_left),
      cmocka_unit_test(both_assemblies_of_a_four_bar_close),
      cmocka_unit_test(velocities_of_a_loop_are_slopes_of_its_positions),
      cmocka_unit_test(a_circle_proposes_its_angle),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
