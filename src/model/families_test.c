// Families: instances, ranges, writing out.
#include "model/model_test_kit.h"

// The chain of the design page with N members.
typedef struct chain {
  kit* k;
  pl_expr N, m, d, i;
  pl_symbol x, y;
  pl_block *all, *rest;
} chain;

static pl_expr element(chain* c, pl_symbol s, pl_expr index) {
  return pl_at(c->k->m->pool, s, 0, index);
}

static const char chain_text[] =
    "param N = 5, m = 0.001 [kg], d = 0.01 [m], g = 9.81 [m/s^2]\n"
    "coord x[1..N], y[1..N]\n"
    "for i in 1..N {\n"
    "    mass P[i]: m at (x[i], y[i])\n"
    "}\n"
    "constraint c[1]: x[1]^2 + y[1]^2 = d^2\n"
    "for i in 2..N {\n"
    "    constraint c[i]: (x[i] - x[i-1])^2 + (y[i] - y[i-1])^2 = d^2\n"
    "}\n"
    "init x[i] = i d\n";

static pl_expr link_length(chain* c, pl_expr i, pl_expr j) {
  pl_pool* p = c->k->m->pool;
  return pl_add(p, pl_square(p, pl_sub(p, element(c, c->x, i), element(c, c->x, j))),
                pl_square(p, pl_sub(p, element(c, c->y, i), element(c, c->y, j))));
}

static chain chain_make(const char* size, long first) {
  chain c = {.k = kit_make(chain_text)};
  kit* k = c.k;
  pl_pool* p = k->m->pool;
  c.N = param(k, "N", size, NULL, "param N");
  c.m = param(k, "m", "0.001", "kg", "param N");
  c.d = param(k, "d", "0.01", "m", "param N");
  pl_expr g = param(k, "g", "9.81", "m/s^2", "param N");
  pl_expr one = pl_int(p, 1);
  c.x = family(k, "x", one, c.N, NULL, "coord x");
  c.y = family(k, "y", one, c.N, NULL, "coord x");
  c.all = loop(k, "i", one, c.N, NULL, "for i in 1..N");
  c.rest = loop(k, "i", pl_int(p, first), c.N, NULL, "for i in 2..N");
  c.i = pl_sym(p, c.all->index);
  pl_push(k->arena, k->m->masses,
          (pl_mass){.name = indexed("P", c.i),
                    .mass = c.m,
                    .point = point2(element(&c, c.x, c.i), element(&c, c.y, c.i)),
                    .block = c.all,
                    .span = at(k, "mass P")});
  constraint(k, indexed("c", one),
             pl_add(p, pl_square(p, element(&c, c.x, one)), pl_square(p, element(&c, c.y, one))),
             PL_EQ, pl_square(p, c.d), NULL, "constraint c[1]");
  constraint(k, indexed("c", first == 2 ? c.i : pl_add(p, c.i, pl_int(p, 100))),
             link_length(&c, c.i, pl_sub(p, c.i, one)), PL_EQ, pl_square(p, c.d), c.rest,
             "constraint c[i]: (x[i] - x[i-1])^2");
  gravity(k, g, 1, -1, NULL);
  pl_push(k->arena, k->m->inits,
          (pl_init){.target = element(&c, c.x, c.i),
                    .value = pl_mul(p, c.i, c.d),
                    .block = c.all,
                    .span = at(k, "init x")});
  return c;
}

PL_TEST(a_chain_is_checked_as_a_pattern) {
  chain c = chain_make("1000000", 2);
  check_is_clean(c.k);
  assert_int_equal(c.k->diagnostics.list.n, 0);
  pl_dimension d;
  assert_true(pl_model_dimension(c.k->m, element(&c, c.x, c.i), &d));
  assert_true(pl_dimension_equal(d, pl_dimension_of(1, 0, 0)));
  assert_true(pl_model_dimension(c.k->m, pl_at(c.k->m->pool, c.x, 1, c.i), &d));
  assert_true(pl_dimension_equal(d, pl_dimension_of(1, 0, -1)));
  kit_free(c.k);
}

// x[0] and y[0] in one statement are one mistake.
PL_TEST(an_element_before_the_first_is_found) {
  chain c = chain_make("5", 1);
  const pl_diagnostic* d = check_tells(c.k, PL_E037);
  // x or y, whichever is met first
  assert_string_equal(d->sentence[0] + 1, "[0] does not exist, at i = 1");
  assert_string_equal(d->reason[0] + 1, " runs from 1 to 5");
  assert_string_equal(d->fix[0], "for i in 2..N");
  kit_free(c.k);
}

PL_TEST(an_element_after_the_last_is_found) {
  chain c = chain_make("5", 2);
  pl_pool* p = c.k->m->pool;
  pl_push(c.k->arena, c.k->m->loads,
          (pl_load){.kind = PL_L_POTENTIAL,
                    .value = pl_mul(p, num(c.k, "1", "N"),
                                    element(&c, c.x, pl_add(p, c.i, pl_int(p, 1)))),
                    .block = c.all});
  const pl_diagnostic* d = check_tells(c.k, PL_E037);
  assert_string_equal(d->sentence[0], "x[6] does not exist, at i = 5");
  assert_string_equal(d->fix[0], "for i in 1..N - 1");
  kit_free(c.k);
}

PL_TEST(an_index_outside_a_family_is_found) {
  chain c = chain_make("5", 2);
  init(c.k, element(&c, c.y, pl_int(c.k->m->pool, 9)), num(c.k, "0", NULL), NULL);
  const pl_diagnostic* d = check_tells(c.k, PL_E037);
  assert_string_equal(d->sentence[0], "y[9] does not exist");
  kit_free(c.k);
}

PL_TEST(an_index_that_is_no_whole_number_is_found) {
  chain c = chain_make("5", 2);
  pl_pool* p = c.k->m->pool;
  init(c.k, element(&c, c.y, pl_ratio(p, 3, 2)), num(c.k, "0", NULL), NULL);
  check_tells(c.k, PL_E038);
  kit_free(c.k);
}

PL_TEST(half_an_index_is_found_between_the_ends) {
  chain c = chain_make("5", 2);
  pl_pool* p = c.k->m->pool;
  // whole at i = 1, 3, 5 only
  pl_expr half = pl_div(p, pl_add(p, c.i, pl_int(p, 1)), pl_int(p, 2));
  pl_push(c.k->arena, c.k->m->inits,
          (pl_init){.target = pl_at(p, c.y, 0, half), .value = pl_int(p, 0), .block = c.all});
  const pl_diagnostic* d = check_tells(c.k, PL_E038);
  assert_non_null(strstr(d->sentence[0], "i = 2"));
  kit_free(c.k);
}

PL_TEST(a_size_without_number_is_told) {
  chain c = chain_make(NULL, 2);
  pl_model_check(&c.k->job, c.k->m);
  const pl_diagnostic* d = NULL;
  assert_true(told(c.k, PL_E038, &d) >= 1);
  assert_non_null(strstr(d->sentence[0], "N has no number"));
  kit_free(c.k);
}

PL_TEST(a_fractional_size_is_told) {
  chain c = chain_make("2.5", 2);
  pl_model_check(&c.k->job, c.k->m);
  assert_true(told(c.k, PL_E038, NULL) >= 1);
  kit_free(c.k);
}

PL_TEST(a_family_beyond_memory_is_refused) {
  chain c = chain_make("1e12", 2);
  pl_model_check(&c.k->job, c.k->m);
  assert_true(told(c.k, PL_E026, NULL) >= 1);
  kit_free(c.k);
}

PL_TEST(an_empty_range_is_fine) {
  chain c = chain_make("1", 2);
  check_is_clean(c.k);
  pl_instances out;
  assert_int_equal(pl_model_instances(&c.k->job, c.k->m, c.rest, &out), PLEUEL_OK);
  assert_int_equal(out.n, 0);
  kit_free(c.k);
}

PL_TEST(nested_loops_use_the_outer_index) {
  kit* k = kit_make(NULL);
  pl_pool* p = k->m->pool;
  pl_block* outer = loop(k, "i", pl_int(p, 0), pl_int(p, 3), NULL, NULL);
  pl_block* inner = loop(k, "j", pl_int(p, 1), pl_sym(p, outer->index), outer, NULL);
  pl_instances out;
  assert_int_equal(pl_model_instances(&k->job, k->m, inner, &out), PLEUEL_OK);
  assert_int_equal(out.n, 6);
  assert_int_equal(out.depth, 2);
  const long expected[] = {1, 1, 2, 1, 2, 2, 3, 1, 3, 2, 3, 3};
  for (int i = 0; i < 12; i++) assert_int_equal(out.index[i], expected[i]);
  kit_free(k);
}

PL_TEST(a_step_counts_by_itself) {
  kit* k = kit_make(NULL);
  pl_pool* p = k->m->pool;
  pl_block* b = loop(k, "i", pl_int(p, 10), pl_int(p, 1), NULL, NULL);
  b->step = pl_int(p, -4);
  pl_instances out;
  assert_int_equal(pl_model_instances(&k->job, k->m, b, &out), PLEUEL_OK);
  assert_int_equal(out.n, 3);
  assert_int_equal(out.index[2], 2);
  b->step = pl_int(p, 0);
  assert_int_equal(pl_model_instances(&k->job, k->m, b, &out), PLEUEL_MODEL_ERROR);
  kit_free(k);
}

PL_TEST(a_label_of_a_family_used_twice_is_found) {
  chain c = chain_make("5", 2);
  // c[1] again at i = 2
  c.k->m->constraints.at[1].name.index = pl_sub(c.k->m->pool, c.i, pl_int(c.k->m->pool, 1));
  const pl_diagnostic* d = check_tells(c.k, PL_E034);
  assert_non_null(strstr(d->sentence[0], "c[1]"));
  kit_free(c.k);
}

PL_TEST(a_label_without_index_in_a_loop_is_found) {
  chain c = chain_make("5", 2);
  c.k->m->masses.at[0].name.index = pl_poison();
  check_tells(c.k, PL_E034);
  kit_free(c.k);
}

PL_TEST(coordinates_come_one_by_one) {
  chain c = chain_make("3", 2);
  pl_flat_coords q = pl_model_flat_coords(c.k->m, c.k->arena);
  assert_int_equal(q.n, 6);
  assert_true(pl_same(q.at[0], element(&c, c.x, pl_int(c.k->m->pool, 1))));
  assert_true(pl_same(q.at[5], element(&c, c.y, pl_int(c.k->m->pool, 3))));
  kit_free(c.k);
}

PL_TEST(members_are_found_by_label) {
  chain c = chain_make("5", 2);
  assert_ptr_equal(pl_model_constraint(c.k->m, "c[1]"), &c.k->m->constraints.at[0]);
  assert_ptr_equal(pl_model_constraint(c.k->m, "c[3]"), &c.k->m->constraints.at[1]);
  assert_ptr_equal(pl_model_mass(c.k->m, "P[2]"), &c.k->m->masses.at[0]);
  assert_null(pl_model_constraint(c.k->m, "d[3]"));
  kit_free(c.k);
}

PL_TEST(a_small_chain_is_written_out) {
  chain c = chain_make("3", 2);
  check_is_clean(c.k);
  pl_model* flat = NULL;
  assert_int_equal(pl_model_expand(&c.k->job, c.k->m, 20, &flat), PLEUEL_OK);
  pl_pool* p = flat->pool;
  assert_int_equal(flat->coords.n, 6);
  assert_int_equal(flat->blocks.n, 0);
  assert_int_equal(flat->masses.n, 3);
  assert_int_equal(flat->constraints.n, 3);
  assert_int_equal(flat->inits.n, 3);
  pl_symbol x2 = pl_symbol_find(p, "x_2");
  assert_true(x2.id != 0);
  assert_string_equal(pl_symbol_get(p, x2)->name, "x2");
  assert_int_equal(pl_symbol_get(p, x2)->role, PL_R_COORD);
  assert_true(pl_symbol_get(p, x2)->dimension_known);
  assert_string_equal(flat->masses.at[1].name.text, "P[2]");
  assert_true(pl_same(flat->masses.at[1].point.at[0], pl_sym(p, x2)));
  assert_string_equal(pl_expr_text(c.k->arena, p, flat->inits.at[2].value), "3*d");
  for (int i = 0; i < flat->constraints.n; i++) {
    assert_false(pl_has_role(p, flat->constraints.at[i].g, PL_R_ARRAY));
    assert_false(pl_has_role(p, flat->constraints.at[i].g, PL_R_INDEX));
    for (int j = 0; j < i; j++)
      assert_int_not_equal(flat->constraints.at[i].lambda.id, flat->constraints.at[j].lambda.id);
  }
  assert_non_null(pl_model_constraint(flat, "c[2]"));
  // the pattern itself is untouched
  assert_int_equal(c.k->m->masses.n, 1);
  assert_true(pl_has_role(p, c.k->m->constraints.at[1].g, PL_R_ARRAY));
  assert_int_equal(c.k->diagnostics.n_errors, 0);
  kit_free(c.k);
}

PL_TEST(a_large_family_is_not_written_out) {
  chain c = chain_make("1000", 2);
  check_is_clean(c.k);
  pl_model* flat = NULL;
  assert_int_equal(pl_model_expand(&c.k->job, c.k->m, 50, &flat), PLEUEL_UNSUPPORTED);
  assert_null(flat);
  kit_free(c.k);
}

PL_TEST(a_sum_over_a_family_is_checked_and_written_out) {
  chain c = chain_make("3", 2);
  pl_pool* p = c.k->m->pool;
  pl_symbol j = name_symbol(c.k, "j", "j", PL_R_INDEX, NULL);
  pl_expr sum = pl_sum_over(p, j, pl_int(p, 1), c.N, pl_square(p, element(&c, c.x, pl_sym(p, j))));
  load(c.k, PL_L_POTENTIAL, pl_mul(p, num(c.k, "2", "N/m"), sum), NULL);
  check_is_clean(c.k);
  pl_model* flat = NULL;
  assert_int_equal(pl_model_expand(&c.k->job, c.k->m, 20, &flat), PLEUEL_OK);
  pl_symbol x3 = pl_symbol_find(p, "x_3");
  assert_true(pl_has_symbol(p, flat->loads.at[0].value, x3));
  assert_false(pl_has_role(p, flat->loads.at[0].value, PL_R_INDEX));
  kit_free(c.k);
}

PL_TEST(a_sum_beyond_the_family_is_found) {
  chain c = chain_make("3", 2);
  pl_pool* p = c.k->m->pool;
  pl_symbol j = name_symbol(c.k, "j", "j", PL_R_INDEX, NULL);
  pl_expr sum = pl_sum_over(p, j, pl_int(p, 0), c.N, pl_square(p, element(&c, c.x, pl_sym(p, j))));
  load(c.k, PL_L_POTENTIAL, pl_mul(p, num(c.k, "2", "N/m"), sum), NULL);
  const pl_diagnostic* d = check_tells(c.k, PL_E037);
  assert_non_null(strstr(d->sentence[0], "x[0] does not exist, at j = 0"));
  kit_free(c.k);
}

PL_TEST(a_negative_index_is_a_legal_name) {
  kit* k = kit_make(NULL);
  pl_pool* p = k->m->pool;
  pl_symbol x = family(k, "x", pl_int(p, -1), pl_int(p, 1), NULL, NULL);
  pl_block* b = loop(k, "i", pl_int(p, -1), pl_int(p, 1), NULL, NULL);
  pl_push(k->arena, k->m->masses,
          (pl_mass){.name = indexed("P", pl_sym(p, b->index)),
                    .mass = pl_int(p, 1),
                    .point = {.n = 1, .at = {pl_at(p, x, 0, pl_sym(p, b->index))}},
                    .block = b});
  check_is_clean(k);
  pl_model* flat = NULL;
  assert_int_equal(pl_model_expand(&k->job, k->m, 20, &flat), PLEUEL_OK);
  assert_true(pl_symbol_find(p, "x_m1").id != 0);
  assert_true(pl_symbol_find(p, "x_0").id != 0);
  kit_free(k);
}

PL_TEST(setting_the_size_resizes) {
  chain c = chain_make("5", 2);
  check_is_clean(c.k);
  assert_int_equal(pl_model_set(&c.k->job, c.k->m, "N", pl_int(c.k->m->pool, 8)), PLEUEL_OK);
  assert_int_equal(pl_model_flat_coords(c.k->m, c.k->arena).n, 16);
  assert_int_equal(pl_model_set(&c.k->job, c.k->m, "m", num(c.k, "2", "g")), PLEUEL_OK);
  assert_true(pl_same(c.k->m->params.at[1].value, pl_ratio(c.k->m->pool, 1, 500)));
  assert_int_equal(pl_model_set(&c.k->job, c.k->m, "m", num(c.k, "2", "m")), PLEUEL_USAGE);
  assert_int_equal(pl_model_set(&c.k->job, c.k->m, "q", num(c.k, "2", NULL)), PLEUEL_USAGE);
  kit_free(c.k);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_chain_is_checked_as_a_pattern),
      cmocka_unit_test(an_element_before_the_first_is_found),
      cmocka_unit_test(an_element_after_the_last_is_found),
      cmocka_unit_test(an_index_outside_a_family_is_found),
      cmocka_unit_test(an_index_that_is_no_whole_number_is_found),
      cmocka_unit_test(half_an_index_is_found_between_the_ends),
      cmocka_unit_test(a_size_without_number_is_told),
      cmocka_unit_test(a_fractional_size_is_told),
      cmocka_unit_test(a_family_beyond_memory_is_refused),
      cmocka_unit_test(an_empty_range_is_fine),
      cmocka_unit_test(nested_loops_use_the_outer_index),
      cmocka_unit_test(a_step_counts_by_itself),
      cmocka_unit_test(a_label_of_a_family_used_twice_is_found),
      cmocka_unit_test(a_label_without_index_in_a_loop_is_found),
      cmocka_unit_test(coordinates_come_one_by_one),
      cmocka_unit_test(members_are_found_by_label),
      cmocka_unit_test(a_small_chain_is_written_out),
      cmocka_unit_test(a_large_family_is_not_written_out),
      cmocka_unit_test(a_sum_over_a_family_is_checked_and_written_out),
      cmocka_unit_test(a_sum_beyond_the_family_is_found),
      cmocka_unit_test(a_negative_index_is_a_legal_name),
      cmocka_unit_test(setting_the_size_resizes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
