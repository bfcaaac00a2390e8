// Consistent starts: what is given is held, the rest follows, and what cannot be is said.
#include "solve/setup_test.h"

#define P b->pool
static pl_expr sq(t_bench* b, pl_expr x) { return pl_square(P, x); }
static pl_expr mul(t_bench* b, pl_expr x, pl_expr y) { return pl_mul(P, x, y); }
static pl_expr half(t_bench* b, pl_expr x) { return pl_mul(P, pl_ratio(P, 1, 2), x); }

// Crank pin (x1, z1) on a circle of radius 1, slider x2 at distance 3; angle φ by map equations.
static t_bench* crank(void) {
  t_bench* b = t_open();
  pl_expr x1 = t_coord(b, "x1"), z1 = t_coord(b, "z1"), x2 = t_coord(b, "x2"),
          phi = t_coord(b, "phi");
  t_constraint(b, "g4", pl_sub(P, pl_add(P, sq(b, x1), sq(b, z1)), pl_int(P, 1)));
  t_constraint(b, "g5", pl_sub(P, pl_add(P, sq(b, z1), sq(b, pl_sub(P, x2, x1))), pl_int(P, 9)));
  int k = t_constraint(b, "map x1", pl_sub(P, x1, pl_call(P, PL_COS, phi)));
  b->constraint[k].priority = 1;
  k = t_constraint(b, "map z1", pl_sub(P, z1, pl_call(P, PL_SIN, phi)));
  b->constraint[k].priority = 1;
  return b;
}

static pl_expr crank_energy(t_bench* b) {
  return half(b, pl_add_n(P, (pl_expr[]){sq(b, b->v[0]), sq(b, b->v[1]), sq(b, b->v[2])}, 3));
}

static void left_of(t_bench* b) {
  b->branch[0] = pl_sub(P, b->q[0], b->q[2]);
  b->branch_setup[0] = (pl_branch_setup){"x2 < x1", 0, 1};
  b->n_branch = 1;
}

static pleuel_status make_and_start(t_bench* b, pl_expr L) {
  assert_int_equal(t_make(b, L, 1, 0), PLEUEL_OK);
  pleuel_status how = pl_run_start(b->run);
  printf("# %s: %s\n", pleuel_status_name(how), b->job.message);
  return how;
}

static void an_angle_and_its_speed_determine_a_crank(void** state) {
  (void)state;
  t_bench* b = crank();
  left_of(b);
  t_start(b, 3, 0.5, 2);
  assert_int_equal(make_and_start(b, crank_energy(b)), PLEUEL_OK);
  const double *q = pl_run_q(b->run), *v = pl_run_v(b->run);
  double x2 = cos(0.5) - sqrt(9 - sin(0.5) * sin(0.5));
  assert_true(fabs(q[0] - cos(0.5)) < 1e-15 && fabs(q[1] - sin(0.5)) < 1e-15
              && fabs(q[2] - x2) < 4e-15 && q[3] == 0.5);
  double x2v = -sin(0.5) * 2 * (1 - cos(0.5) / sqrt(9 - sin(0.5) * sin(0.5)));
  assert_true(fabs(v[0] + 2 * sin(0.5)) < 1e-14 && fabs(v[2] - x2v) < 1e-14
              && fabs(v[3] - 2) < 1e-15);
  const pl_start_report* r = pl_run_start_report(b->run);
  assert_true(r->n_candidates == 1 && r->n_free == 0 && r->n_moves == 6);
  t_close(b);
}

static void two_assemblies_are_listed_and_the_nearer_one_is_taken(void** state) {
  (void)state;
  t_bench* b = crank();
  t_start(b, 3, 0.5, 2);
  assert_int_equal(make_and_start(b, crank_energy(b)), PLEUEL_OK);
  const pl_start_report* r = pl_run_start_report(b->run);
  assert_int_equal(r->n_candidates, 2);
  double middle = 0.5 * (r->candidates[2] + r->candidates[6]);
  assert_true(fabs(middle - cos(0.5)) < 1e-12);
  assert_true(fabs(pl_run_q(b->run)[2] - r->candidates[4 * r->taken + 2]) < 1e-12);
  assert_true(fabs(pl_run_q(b->run)[2]) < fabs(r->candidates[4 * (1 - r->taken) + 2]));
  t_close(b);
}

static void of_two_mirror_images_none_is_taken(void** state) {
  (void)state;
  t_bench* b = crank();
  t_start(b, 3, 1.57079632679489662, 2);
  assert_int_equal(make_and_start(b, crank_energy(b)), PLEUEL_CONTRADICTION);
  const pl_start_report* r = pl_run_start_report(b->run);
  assert_int_equal(r->trouble, PL_START_SEVERAL);
  assert_int_equal(r->n_candidates, 2);
  assert_true(strstr(b->job.message, "2 solutions") != NULL);
  t_close(b);
}

// φ = -4 θ: a whole turn of φ is another place of θ, so it must not be taken out.
static void a_turn_that_a_constraint_counts_is_kept(void** state) {
  (void)state;
  t_bench* b = t_open();
  pl_expr theta = t_coord(b, "theta"), phi = t_coord(b, "phi");
  t_constraint(b, "roll", pl_add(P, phi, pl_mul(P, pl_int(P, 4), theta)));
  t_start(b, 0, 1.57079632679489662, 0);
  assert_int_equal(make_and_start(b, half(b, pl_add(P, sq(b, b->v[0]), sq(b, b->v[1])))),
                   PLEUEL_OK);
  assert_true(pl_run_q(b->run)[0] == 1.57079632679489662);
  assert_true(fabs(pl_run_q(b->run)[1] + 6.28318530717958648) < 1e-14);
  t_close(b);
}

static void a_pin_position_determines_the_angle_up_to_turns(void** state) {
  (void)state;
  t_bench* b = crank();
  left_of(b);
  b->coordinate[0].has_q = b->coordinate[1].has_q = true;
  b->coordinate[0].q = -0.6;
  b->coordinate[1].q = 0.8;
  assert_int_equal(make_and_start(b, crank_energy(b)), PLEUEL_OK);
  assert_true(fabs(pl_run_q(b->run)[3] - acos(-0.6)) < 1e-14);
  // free velocities are zero
  for (int i = 0; i < 4; i++) assert_true(pl_run_v(b->run)[i] == 0);
  t_close(b);
}

static void no_assembly_fits_an_impossible_branch(void** state) {
  (void)state;
  t_bench* b = crank();
  t_start(b, 3, 0.5, 0);
  b->branch[0] = pl_sub(P, b->q[2], pl_int(P, 10));
  b->branch_setup[0] = (pl_branch_setup){"x2 > 10", 0, 1};
  b->n_branch = 1;
  assert_int_equal(make_and_start(b, crank_energy(b)), PLEUEL_CONTRADICTION);
  assert_int_equal(pl_run_start_report(b->run)->trouble, PL_START_NONE);
  t_close(b);
}

static t_bench* pendulum(void) {
  t_bench* b = t_open();
  pl_expr x = t_coord(b, "x"), y = t_coord(b, "y");
  t_constraint(b, "rod", pl_sub(P, pl_add(P, sq(b, x), sq(b, y)), pl_int(P, 25)));
  return b;
}

static pl_expr plain_energy(t_bench* b) {
  return half(b, pl_add(P, sq(b, b->v[0]), sq(b, b->v[1])));
}

static void a_violated_constraint_is_named_with_what_would_mend_it(void** state) {
  (void)state;
  t_bench* b = pendulum();
  t_start(b, 0, 3, 0);
  t_start(b, 1, 4.2, 0);
  assert_int_equal(make_and_start(b, plain_energy(b)), PLEUEL_CONTRADICTION);
  const pl_start_report* r = pl_run_start_report(b->run);
  assert_int_equal(r->trouble, PL_START_VIOLATED);
  assert_int_equal(r->constraint, 0);
  assert_int_equal(r->move_coordinate, 1);
  assert_true(fabs(r->move_to - 4) < 1e-9 && !r->move_velocity);
  assert_true(strstr(b->job.message, "rod") && strstr(b->job.message, "y = 4"));
  t_close(b);
}

static void a_violated_velocity_is_named(void** state) {
  (void)state;
  t_bench* b = pendulum();
  t_start(b, 0, 3, 1);
  t_start(b, 1, 4, 1);
  assert_int_equal(make_and_start(b, plain_energy(b)), PLEUEL_CONTRADICTION);
  const pl_start_report* r = pl_run_start_report(b->run);
  assert_true(r->trouble == PL_START_VIOLATED && r->constraint_velocity && r->constraint == 0
              && r->move_velocity);
  // 3 x' + 4 y' = 0
  double expect = r->move_coordinate == 0 ? -4.0 / 3 : -0.75;
  assert_true(fabs(r->move_to - expect) < 1e-12);
  t_close(b);
}

// x + t y = 0 at t = 0: its terms are rounding, its derivative x' + y is not.
static void a_velocity_is_violated_though_the_terms_of_the_constraint_vanish(void** state) {
  (void)state;
  t_bench* b = t_open();
  pl_expr x = t_coord(b, "x"), y = t_coord(b, "y");
  t_constraint(b, "tie", pl_add(P, x, mul(b, pl_sym(P, pl_time(P)), y)));
  t_start(b, 0, 1e-19, -0.3);
  t_start(b, 1, 0.5, 0);
  pl_expr L = half(b, pl_add(P, sq(b, b->v[0]), sq(b, b->v[1])));
  assert_int_equal(make_and_start(b, L), PLEUEL_CONTRADICTION);
  const pl_start_report* r = pl_run_start_report(b->run);
  assert_true(r->trouble == PL_START_VIOLATED && r->constraint_velocity && r->constraint == 0);
  t_close(b);
}

static void rounding_in_given_values_is_projected_and_told(void** state) {
  (void)state;
  t_bench* b = pendulum();
  t_start(b, 0, 3.0000000001, 0);
  t_start(b, 1, 4, 0);
  assert_int_equal(make_and_start(b, plain_energy(b)), PLEUEL_OK);
  const pl_start_report* r = pl_run_start_report(b->run);
  assert_true(r->n_moves > 0 && r->moves[0].given && r->largest_move > 1e-12
              && r->largest_move < 1e-10);
  const double* q = pl_run_q(b->run);
  assert_true(fabs(q[0] * q[0] + q[1] * q[1] - 25) < 1e-14);
  t_close(b);
}

static void what_nothing_determines_is_listed(void** state) {
  (void)state;
  t_bench* b = pendulum();
  b->coordinate[0].has_guess = b->coordinate[1].has_guess = true;
  b->coordinate[0].guess = 3;
  b->coordinate[1].guess = 4.1;
  assert_int_equal(make_and_start(b, plain_energy(b)), PLEUEL_OK);
  assert_int_equal(pl_run_start_report(b->run)->n_free, 2);
  const double* q = pl_run_q(b->run);
  assert_true(fabs(q[0] - 3) < 0.1 && fabs(q[0] * q[0] + q[1] * q[1] - 25) < 1e-13);
  t_close(b);
}

static void a_body_without_height_sits_on_its_table(void** state) {
  (void)state;
  t_bench* b = t_open();
  pl_expr x = t_coord(b, "x"), y = t_coord(b, "y");
  int c = t_constraint(b, "table", pl_sub(P, y, pl_int(P, 2)));
  b->constraint[c].side = 1;
  t_start(b, 0, 1, 3);
  (void)x;
  assert_int_equal(make_and_start(b, pl_sub(P, plain_energy(b), mul(b, pl_int(P, 10), y))),
                   PLEUEL_OK);
  const pl_start_report* r = pl_run_start_report(b->run);
  assert_true(r->n_sitting == 1 && r->sitting[0] == c && pl_run_is_active(b->run, c));
  assert_true(pl_run_q(b->run)[1] == 2 && fabs(pl_run_lambda(b->run)[c] - 10) < 1e-14);
  t_close(b);
}

static void a_body_below_its_table_is_a_contradiction(void** state) {
  (void)state;
  t_bench* b = t_open();
  pl_expr x = t_coord(b, "x"), y = t_coord(b, "y");
  int c = t_constraint(b, "table", y);
  b->constraint[c].side = 1;
  (void)x;
  t_start(b, 0, 1, 0);
  t_start(b, 1, -0.5, 0);
  assert_int_equal(make_and_start(b, plain_energy(b)), PLEUEL_CONTRADICTION);
  assert_true(pl_run_start_report(b->run)->trouble == PL_START_VIOLATED
              && pl_run_start_report(b->run)->constraint == c);
  t_close(b);
}

static void a_folded_crank_with_equal_lengths_is_a_singular_start(void** state) {
  (void)state;
  t_bench* b = t_open();
  pl_expr x1 = t_coord(b, "x1"), z1 = t_coord(b, "z1"), x2 = t_coord(b, "x2");
  t_constraint(b, "g4", pl_sub(P, pl_add(P, sq(b, x1), sq(b, z1)), pl_int(P, 1)));
  t_constraint(b, "g5", pl_sub(P, pl_add(P, sq(b, z1), sq(b, pl_sub(P, x2, x1))), pl_int(P, 1)));
  t_start(b, 0, 0, 1);
  t_start(b, 1, 1, 0);
  t_start(b, 2, 0, 2);
  assert_int_equal(make_and_start(b, crank_energy(b)), PLEUEL_SINGULAR);
  assert_int_equal(pl_run_start_report(b->run)->trouble, PL_START_SINGULAR);
  t_close(b);
}

static void values_that_are_no_numbers_are_refused(void** state) {
  (void)state;
  t_bench* b = pendulum();
  t_start(b, 0, (double)NAN, 0);
  assert_int_equal(make_and_start(b, plain_energy(b)), PLEUEL_USAGE);
  t_close(b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(an_angle_and_its_speed_determine_a_crank),
      cmocka_unit_test(two_assemblies_are_listed_and_the_nearer_one_is_taken),
      cmocka_unit_test(of_two_mirror_images_none_is_taken),
      cmocka_unit_test(a_turn_that_a_constraint_counts_is_kept),
      cmocka_unit_test(a_pin_position_determines_the_angle_up_to_turns),
      cmocka_unit_test(no_assembly_fits_an_impossible_branch),
      cmocka_unit_test(a_violated_constraint_is_named_with_what_would_mend_it),
      cmocka_unit_test(a_violated_velocity_is_named),
      cmocka_unit_test(a_velocity_is_violated_though_the_terms_of_the_constraint_vanish),
      cmocka_unit_test(rounding_in_given_values_is_projected_and_told),
      cmocka_unit_test(what_nothing_determines_is_listed),
      cmocka_unit_test(a_body_without_height_sits_on_its_table),
      cmocka_unit_test(a_body_below_its_table_is_a_contradiction),
      cmocka_unit_test(a_folded_crank_with_equal_lengths_is_a_singular_start),
      cmocka_unit_test(values_that_are_no_numbers_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
