// From text to model: what each kind of statement leaves in the model, and what may be written how.
#include "lang_testing.h"

static const char* text_of(bench* b, pl_expr e) { return pl_expr_text(b->arena, b->m->pool, e); }

static bench* good(const char* text) {
  bench* b = bench_text(text);
  if (b->status != PLEUEL_OK) print_message("%s\n%s\n", text, bench_said(b));
  assert_int_equal(b->status, PLEUEL_OK);
  return b;
}

static void said(const char* text, const char* want) {
  bench* b = bench_text(text);
  if (strcmp(bench_said(b), want) != 0) print_message("%s\n", text);
  assert_string_equal(bench_said(b), want);
  bench_free(b);
}

// The same expression as this text in the names of the model?
static void is(bench* b, pl_expr e, const char* text) {
  pl_expr want;
  assert_int_equal(pl_lang_expression(&b->job, b->m, text, &want), PLEUEL_OK);
  if (!pl_same(e, want)) print_message("%s, expected %s\n", text_of(b, e), text);
  assert_true(pl_same(e, want));
}

#define PENDULUM                                                                                 \
  "param m = 1 [kg], l = 2 [m], g = 9.81 [m/s^2]\ncoord x, y\naxes x right, y up\nmass A: m at " \
  "(x, y)\n"                                                                                     \
  "gravity g along -y\nconstraint rod: x^2 + y^2 = l^2\n"

static void lines_may_come_in_any_order(void** state) {
  (void)state;
  bench* b = good(
      "constraint rod: x^2 + y^2 = k^2\nlet k = 2 h, h = l/2\nmass A: m at (x, y)\nspring 1 "
      "between A and B\npoint B "
      "at (k, 0)\n"
      "coord x, y\nparam m = 1, l = 2\n");
  assert_int_equal(b->m->constraints.n, 1);
  is(b, b->m->constraints.at[0].g, "x^2 + y^2 - k^2");
  assert_int_equal(b->m->lets.n, 2);
  assert_false(b->m->lets.at[0].inserted);
  // what is needed first
  assert_string_equal(pl_symbol_get(b->m->pool, b->m->lets.at[0].symbol)->name, "h");
  bench_free(b);
}

static void abbreviations_of_what_moves_are_inserted(void** state) {
  (void)state;
  bench* b = good(
      "param a = 1\ncoord x, y\nmass 1 at (x, y)\nlet s = x + a, f(u) = u s, v = dt(s)\npotential "
      "f(2) + v^2\n");
  is(b, b->m->loads.at[0].value, "2*(a + x) + x'^2");
  bench_free(b);
}

static void numbers_carry_units_and_angles(void** state) {
  (void)state;
  bench* b = good(
      "param a = 250 [mm], w = 1/2 [rpm], p = 30°, q = 2 π [rad/s], k [N/m]\ncoord x [m], h[m]\n");
  double* v = pl_model_values(b->m, b->arena);
  assert_true(v[b->m->params.at[0].symbol.id] == 0.25);
  assert_true(v[b->m->params.at[1].symbol.id] > 0.05235
              && v[b->m->params.at[1].symbol.id] < 0.05236);
  assert_true(v[b->m->params.at[2].symbol.id] > 0.5235 && v[b->m->params.at[2].symbol.id] < 0.5236);
  assert_string_equal(b->m->params.at[0].unit_text, "mm");
  assert_true(b->m->params.at[4].has_unit);
  assert_true(pl_is_poison(b->m->params.at[4].value));
  assert_true(pl_symbol_get(b->m->pool, b->m->coords.at[0].symbol)->dimension_known);
  assert_true(b->m->coords.at[1].has_unit);
  bench_free(b);
}

static void families_stay_patterns(void** state) {
  (void)state;
  bench* b = good(
      "param N = 5, d = 1\ncoord x[0..N], y[0..N]\nfor i in 1..N {\n  mass P[i]: 1 at (x[i], "
      "y[i])\n"
      "  for j in 0..i-1 step 2 {\n    constraint c[i]: x[i] = x[j]\n  }\n  spring 2 between P[i] "
      "and P[i-1]\n}\nmass "
      "P[0]: 3 at (x[0], 1)\n");
  assert_int_equal(b->m->masses.n, 2);
  assert_int_equal(b->m->blocks.n, 2);
  assert_ptr_equal(b->m->masses.at[0].block, b->m->blocks.at[0]);
  assert_null(b->m->masses.at[1].block);
  assert_ptr_equal(b->m->blocks.at[1]->outer, b->m->blocks.at[0]);
  is(b, b->m->blocks.at[1]->hi, "i - 1");
  is(b, b->m->loads.at[0].b.at[0], "x[i-1]");
  is(b, b->m->loads.at[0].a.at[1], "y[i]");
  bench_free(b);
}

static void points_on_bodies_turn_with_them(void** state) {
  (void)state;
  bench* b = good(
      "param m = 1, J = 2\ncoord x, y, α\nbody k: mass m, inertia J at (x, y) angle α\npoint P on "
      "k at (3, 0)\ntorque "
      "2 on k\nforce (1, 0) on P\n");
  is(b, b->m->points.at[0].point.at[1], "y + 3 sin α");
  assert_string_equal(pl_symbol_get(b->m->pool, b->m->loads.at[0].coordinate)->ascii, "alpha");
  bench_free(b);
}

// T of a uniform rod between moving ends is M/6 (vA² + vA·vB + vB²).
static void rods_have_the_kinetic_energy_of_a_rod(void** state) {
  (void)state;
  bench* b = good("param M = 6\ncoord a, b\naxes x right\nrod mass M between (a) and (b)\n");
  pl_pool* p = b->m->pool;
  assert_int_equal(b->m->masses.n, 3);
  pl_expr T = pl_int(p, 0);
  for (int i = 0; i < 3; i++) {
    pl_expr v = pl_dt(p, b->m->masses.at[i].point.at[0]);
    T = pl_add(p, T, pl_div(p, pl_mul(p, b->m->masses.at[i].mass, pl_square(p, v)), pl_int(p, 2)));
  }
  pl_expr want;
  assert_int_equal(pl_lang_expression(&b->job, b->m, "M/6*(a'^2 + a' b' + b'^2)", &want),
                   PLEUEL_OK);
  pl_expr difference = pl_expand(p, pl_sub(p, T, want), 1000);
  assert_true(pl_is_zero_node(p, difference));
  bench_free(b);
}

static void constraints_and_multipliers(void** state) {
  (void)state;
  bench* b = good(
      "coord x, y\nmass 1 at (x, y)\nconstraint a: x = y  with μ, redundant ok\nconstraint y >= "
      "0\nconstraint c: x' = "
      "0 while a, off\n"
      "constraint d: x <= 1\nplot μ, λ_2, λ_c, lambda_d vs t\n");
  assert_int_equal(b->m->constraints.n, 4);
  const pl_constraint* c = b->m->constraints.at;
  assert_string_equal(c[0].multiplier, "μ");
  assert_string_equal(pl_symbol_get(b->m->pool, c[0].lambda)->ascii, "lambda_a");
  assert_true(c[0].redundant_ok);
  assert_string_equal(c[1].name.text, "2");
  assert_int_equal(c[1].relation, PL_GE);
  assert_true(c[1].name.generated);
  assert_true(c[2].has_velocity);
  assert_string_equal(c[2].while_label, "a");
  assert_true(c[2].off);
  assert_int_equal(c[3].relation, PL_LE);
  assert_int_equal(b->m->plots.at[0].y.n, 4);
  bench_free(b);
}

static void requests_of_every_kind(void** state) {
  (void)state;
  bench* b = good(
      PENDULUM
      "ask a: dof, constraints, lagrange1 in (x, y), lagrange2, lagrangian, hamiltonian, newton\n"
      "ask b: solve λ, solve x(t), solve x'', E, force(rod), x where λ = 0 and y' = 0 from x = 0 "
      "and y = l at rest\n"
      "ask c: force of rod from x = 0 at rest, force on A in (x, y), conserved, equilibria, "
      "equilibria of rod for x' = "
      "2\n"
      "ask d: modes, modes at x = 0, modes at (x = 0, y = -l) holding x, y\n"
      "ask limit m -> 0 of b, limit l = m of x'', limit l >> m of λ, limit g -> ∞ of x\n"
      "ask series m = l + δm, δm -> 0 order 3 of x'', series m -> 0 of d\n"
      "ask threshold m of rod, threshold m of stable, threshold m of x = 2, max x, min y from x = "
      "0 at rest, max(x, "
      "y)\n"
      "ask average over t, stability of x = 0 over 2 [s], expect x'' = -g where y = 0, expect x = "
      "δm\n"
      "ask simulate 0..2 [s] tol 1e-9, plot x, y vs t, dof, animate weight, force of rod, "
      "conserved\n");
  static const pl_ask_kind kinds[] = {
      PL_ASK_DOF,        PL_ASK_CONSTRAINTS, PL_ASK_LAGRANGE1, PL_ASK_LAGRANGE2,
      PL_ASK_LAGRANGIAN, PL_ASK_HAMILTONIAN, PL_ASK_NEWTON,    PL_ASK_SOLVE,
      PL_ASK_SOLVE,      PL_ASK_SOLVE,       PL_ASK_VALUE,     PL_ASK_VALUE,
      PL_ASK_VALUE,      PL_ASK_FORCE_OF,    PL_ASK_FORCE_ON,  PL_ASK_CONSERVED,
      PL_ASK_EQUILIBRIA, PL_ASK_EQUILIBRIA,  PL_ASK_MODES,     PL_ASK_MODES,
      PL_ASK_MODES,      PL_ASK_LIMIT,       PL_ASK_LIMIT,     PL_ASK_LIMIT,
      PL_ASK_LIMIT,      PL_ASK_SERIES,      PL_ASK_SERIES,    PL_ASK_THRESHOLD,
      PL_ASK_THRESHOLD,  PL_ASK_THRESHOLD,   PL_ASK_MAX,       PL_ASK_MIN,
      PL_ASK_VALUE,      PL_ASK_AVERAGE,     PL_ASK_STABILITY, PL_ASK_EXPECT,
      PL_ASK_EXPECT,     PL_ASK_DOF,         PL_ASK_CONSERVED};
  int n = sizeof kinds / sizeof kinds[0];
  assert_int_equal(b->m->asks.n, n);
  const pl_ask* a = b->m->asks.at;
  for (int i = 0; i < n; i++) assert_int_equal(a[i].kind, kinds[i]);
  assert_string_equal(a[2].text, "lagrange1 in (x, y)");
  assert_int_equal(a[2].frame.n, 2);
  assert_true(a[8].of_time);
  assert_int_equal(a[12].where.n, 2);
  assert_int_equal(a[12].motion.n_from, 2);
  assert_true(a[12].motion.at_rest);
  assert_string_equal(a[13].label, "rod");
  assert_string_equal(a[21].of_letter, "b");
  assert_int_equal(a[22].limit, PL_LIMIT_EQUAL);
  assert_int_equal(a[23].limit, PL_LIMIT_MUCH_GREATER);
  assert_int_equal(pl_kind_of(b->m->pool, a[24].to), PL_INFINITY);
  assert_int_equal(a[25].order, 3);
  assert_string_equal(pl_symbol_get(b->m->pool, a[25].variable)->ascii, "delta_m");
  assert_int_equal(pl_symbol_get(b->m->pool, a[25].variable)->role, PL_R_SMALL);
  assert_string_equal(a[26].of_letter, "d");
  assert_string_equal(text_of(b, a[32].value), "max(x, y)");
  assert_true(b->m->simulate.given);
  assert_int_equal(b->m->plots.n, 1);
  bench_free(b);
}

static void a_declared_name_hides_a_result(void** state) {
  (void)state;
  bench* b = good(
      "param L = 4, E = 2\ncoord x\nmass 1 at (x)\npotential L x\nplot L, T, lagrangian, E vs t\n");
  const pl_plot* plot = &b->m->plots.at[0];
  assert_string_equal(text_of(b, plot->y.at[0]), "L");
  assert_null(pl_model_result_name(b->m, pl_symbol_of(b->m->pool, plot->y.at[0])));
  assert_non_null(pl_model_result_name(b->m, pl_symbol_of(b->m->pool, plot->y.at[1])));
  assert_int_equal(pl_model_result_name(b->m, pl_symbol_of(b->m->pool, plot->y.at[2]))->kind,
                   PL_RES_L);
  assert_null(pl_model_result_name(b->m, pl_symbol_of(b->m->pool, plot->y.at[3])));
  bench_free(b);
}

static void words_are_keywords_by_place_only(void** state) {
  (void)state;
  bench* b = good(
      "param force = 1, mass = 2, dof = 3, limit = 4, angle = 5, stop = 6, integer = 7\ncoord "
      "x\nmass mass at (x)\n"
      "potential force x + dof limit\nask force, dof\nevent e: when x = stop -> stop\n");
  assert_int_equal(b->m->asks.at[0].kind, PL_ASK_VALUE);
  assert_int_equal(b->m->asks.at[1].kind, PL_ASK_DOF);
  assert_int_equal(b->m->events.at[0].actions.at[0].kind, PL_DO_STOP);
  bench_free(b);
}

static void settings_replace_values_before_anything_else(void** state) {
  (void)state;
  const char* text =
      "param N = 3, m = 2 [kg], d = 300 [mm], α = 10 [deg]\nlet w = 2 m\ncoord x[1..N], y\nmass m "
      "at (y)\ninit y = 1\n";
  const pl_setting set[] = {{"N", "5"},  {"m", "500[g]"}, {"d", "200"},    {"y", "7"},
                            {"y'", "3"}, {"w", "3 m"},    {"alpha", "20°"}};
  bench* b = bench_with(text, strlen(text), set, 7);
  assert_string_equal(bench_said(b), "");
  double* v = pl_model_values(b->m, b->arena);
  assert_true(v[b->m->params.at[0].symbol.id] == 5);
  assert_true(v[b->m->params.at[1].symbol.id] == 0.5);
  assert_true(v[b->m->params.at[2].symbol.id] == 0.2);
  assert_true(v[b->m->params.at[3].symbol.id] > 0.349 && v[b->m->params.at[3].symbol.id] < 0.35);
  assert_int_equal(pl_model_flat_coords(b->m, b->arena).n, 6);
  assert_int_equal(b->m->inits.n, 2);
  assert_string_equal(text_of(b, b->m->inits.at[0].value), "7");
  assert_string_equal(text_of(b, b->m->lets.at[0].value), "3*m");
  bench_free(b);
  const pl_setting wrong[] = {{"q", "5"}};
  b = bench_with(text, strlen(text), wrong, 1);
  assert_string_equal(bench_said(b), "E011 1:1");
  bench_free(b);
}

typedef struct shelf {
  const char* path;
  const char* text;
} shelf;
static const pl_source* from_shelf(void* user, pl_arena* a, const char* path,
                                   const pl_source* from) {
  (void)from;
  for (const shelf* s = user; s->path; s++) {
    if (strcmp(s->path, path) == 0) return pl_source_make(a, s->path, s->text, strlen(s->text));
  }
  return NULL;
}

static void included_files_count_as_part_of_the_text(void** state) {
  (void)state;
  shelf files[] = {{"a", "param m = 1\ninclude \"b\"\n"},
                   {"b", "coord x\n"},
                   {"loop", "include \"loop\"\n"},
                   {NULL, NULL}};
  pl_include_reader reader = {from_shelf, files};
  bench* b = bench_make();
  const char* text = "include \"a\"\nmass m at (x)\n";
  assert_int_equal(pl_lang_parse(&b->job, pl_source_make(b->arena, "t", text, strlen(text)),
                                 &reader, NULL, 0, &b->m),
                   PLEUEL_OK);
  assert_int_equal(b->m->coords.n, 1);
  text = "include \"loop\"\n";
  assert_int_equal(pl_lang_parse(&b->job, pl_source_make(b->arena, "t", text, strlen(text)),
                                 &reader, NULL, 0, &b->m),
                   PLEUEL_MODEL_ERROR);
  assert_string_equal(bench_said(b), "E010 1:9");
  bench_free(b);
}

static void line_ends_of_other_systems(void** state) {
  (void)state;
  bench* b =
      good("\xef\xbb\xbfparam m = 1\r\ncoord\tx\xc2\xa0,\r\n  y\r\nmass m at (x,\r\n y)\r\n");
  assert_int_equal(b->m->coords.n, 2);
  bench_free(b);
}

static void lines_go_on_after_operators_and_in_brackets(void** state) {
  (void)state;
  bench* b = good("param a = 1 +  # first\n  # between\n\n  2, b = (3\n  + 4\n)\n");
  assert_string_equal(text_of(b, b->m->params.at[0].value), "3");
  assert_string_equal(text_of(b, b->m->params.at[1].value), "7");
  bench_free(b);
}

static void one_mistake_one_message(void** state) {
  (void)state;
  said("param m = \ncoord x\nmass m at (x)\n", "E001 1:10");
  said("coord x,\nmass m at (x)\nparam m = 1\n", "E001 1:8");
  said("for i 1..3 {\n  mass P[i]: 1 at (i)\n}\nparam a = (1\nparam b = 2\n",
       "E001 1:7, E008 4:11");
  said("let a = b, b = c, c = a\nplot a + b + c vs t\n", "E018 1:5");
  said("let a = q\nplot a + a vs t\nplot a vs t\n", "E011 1:9");
  said("parm m = 1\nmass m at (0)\n", "E004 1:1");
  said("constraint g x = 1\ncoord x\nplot λ_g vs t\n", "E001 1:12");
}

static void bounds_hold_against_size(void** state) {
  (void)state;
  pl_text t = pl_text_make(bench_make()->arena);
  for (int i = 0; i < 100000; i++) pl_text_add(&t, "(");
  said(pl_format(t.arena, "param a = %s\n", pl_text_string(&t)), "E006 1:211");
  t.n = 0;
  for (int i = 0; i < 100000; i++) pl_text_add(&t, "-");
  bench* b = bench_text(pl_format(t.arena, "param a = 1*%s1\n", pl_text_string(&t)));
  assert_int_equal(b->diagnostics.n_errors, 1);
  bench_free(b);
  t.n = 0;
  for (int i = 0; i < 1000; i++) pl_text_add(&t, "for i in 1..2 {\n");
  b = bench_text(pl_text_string(&t));
  assert_true(b->diagnostics.n_errors >= 1);
  bench_free(b);
  t.n = 0;
  pl_text_add(&t, "let a0 = 1\n");
  for (int i = 1; i < 3000; i++) pl_text_addf(&t, "let a%d = sin a%d + a%d\n", i, i - 1, i - 1);
  b = bench_text(pl_text_string(&t));
  bench_free(b);
  pl_arena_free(t.arena);
}

// An allocator that has no more after so many calls.
static void* take_some(void* user, size_t size) {
  long* left = user;
  return (*left)-- > 0 ? malloc(size) : NULL;
}
static void give_back(void* user, void* block) {
  (void)user;
  free(block);
}

static void memory_may_run_out_anywhere(void** state) {
  (void)state;
  pl_text text = pl_text_make(bench_make()->arena);
  pl_text_add(&text, PENDULUM);
  for (int i = 0; i < 3000; i++)
    pl_text_addf(&text, "let a%d = sin(x + %d) + y^%d, wrong %d\n", i, i, i % 7 + 2, i);
  const char* s = pl_text_string(&text);
  int unwound = 0;
  bool done = false;
  for (long n = 1; !done && n < 200; n++) {
    long left = n;
    pleuel_allocator alloc = {take_some, give_back, &left};
    pl_arena* a = pl_arena_make(&alloc);
    if (a == NULL) continue;
    pl_guard guard;
    PL_GUARD(a, guard) {
      pl_diagnostics* d = PL_NEW(a, pl_diagnostics);
      d->arena = a;
      pl_job* job = PL_NEW(a, pl_job);
      *job = (pl_job){.arena = a, .diagnostics = d};
      pl_model* m;
      pl_lang_parse(job, pl_source_make(a, "t", s, strlen(s)), NULL, NULL, 0, &m);
      done = true;
    }
    else {
      assert_int_equal(guard.status, PLEUEL_NO_MEMORY);
      unwound++;
    }
    pl_guard_end(a, &guard);
    pl_arena_free(a);
  }
  assert_true(done);
  assert_true(unwound > 0);
  pl_arena_free(text.arena);
}

static void examples_are_read_without_a_word(void** state) {
  (void)state;
  static const char* const names[] = {"atwood", "crank", "ski", "chain", "ladder", "caraxis"};
  for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
    char path[1000];
    snprintf(path, sizeof path, "%s/%s.pleuel", PL_EXAMPLES, names[i]);
    size_t n = 0;
    char* text = read_file(path, &n);
    assert_non_null(text);
    bench* b = bench_with(text, n, NULL, 0);
    assert_string_equal(bench_said(b), "");
    assert_int_equal(pl_model_check(&b->job, b->m), PLEUEL_OK);
    bench_free(b);
    free(text);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lines_may_come_in_any_order),
      cmocka_unit_test(abbreviations_of_what_moves_are_inserted),
      cmocka_unit_test(numbers_carry_units_and_angles),
      cmocka_unit_test(families_stay_patterns),
      cmocka_unit_test(points_on_bodies_turn_with_them),
      cmocka_unit_test(rods_have_the_kinetic_energy_of_a_rod),
      cmocka_unit_test(constraints_and_multipliers),
      cmocka_unit_test(requests_of_every_kind),
      cmocka_unit_test(a_declared_name_hides_a_result),
      cmocka_unit_test(words_are_keywords_by_place_only),
      cmocka_unit_test(settings_replace_values_before_anything_else),
      cmocka_unit_test(included_files_count_as_part_of_the_text),
      cmocka_unit_test(line_ends_of_other_systems),
      cmocka_unit_test(lines_go_on_after_operators_and_in_brackets),
      cmocka_unit_test(one_mistake_one_message),
      cmocka_unit_test(bounds_hold_against_size),
      cmocka_unit_test(memory_may_run_out_anywhere),
      cmocka_unit_test(examples_are_read_without_a_word),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
