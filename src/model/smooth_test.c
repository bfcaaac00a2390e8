// Laws of rewriting expressions of Euler angles by quaternions.
//   What is written by the entries of the turn and the angular velocity is found to be smooth,
//   however it was multiplied out, and keeps its value.
//   What is not smooth at every attitude is refused, also as a part of a sum.
#include "model/smooth.h"

#include <math.h>
#include <string.h>

#include "base/base_test_kit.h"

static const uint64_t first_seed = 4711;
enum { N_ROUNDS = 60 };

typedef struct world {
  pl_arena* arena;
  pl_pool* p;
  pl_expr angle[3], q[4], turn[9], spin[2][3], given[2];
  pl_triple triple;
} world;

static pl_expr named(pl_pool* p, const char* name, pl_role role) {
  pl_symbol_info info = {.name = name,
                         .ascii = name,
                         .role = role,
                         .class = role == PL_R_COORD ? PL_C_COORD : PL_C_OTHER};
  return pl_sym(p, pl_symbol_make(p, &info));
}

static void euler_turn(world* w) {
  pl_pool* p = w->p;
  pl_expr c[3], s[3];
  for (int i = 0; i < 3; i++) {
    c[i] = pl_call(p, PL_COS, w->angle[i]);
    s[i] = pl_call(p, PL_SIN, w->angle[i]);
  }
  pl_expr z[2][9] = {{c[0], pl_neg(p, s[0]), pl_int(p, 0), s[0], c[0], pl_int(p, 0), pl_int(p, 0),
                      pl_int(p, 0), pl_int(p, 1)},
                     {c[2], pl_neg(p, s[2]), pl_int(p, 0), s[2], c[2], pl_int(p, 0), pl_int(p, 0),
                      pl_int(p, 0), pl_int(p, 1)}};
  pl_expr x[9] = {pl_int(p, 1),    pl_int(p, 0), pl_int(p, 0), pl_int(p, 0), c[1],
                  pl_neg(p, s[1]), pl_int(p, 0), s[1],         c[1]};
  for (int i = 0; i < 9; i++) {
    pl_expr sum = pl_int(p, 0);
    for (int j = 0; j < 3; j++)
      for (int k = 0; k < 3; k++)
        sum = pl_add(
            p, sum,
            pl_mul_n(p, (pl_expr[]){z[0][3 * (i / 3) + j], x[3 * j + k], z[1][3 * k + i % 3]}, 3));
    w->turn[i] = pl_expand(p, sum, 100);
  }
}

// ω in space from the matrix itself: R' R^T; along the body: R^T R'.
static void euler_spin(world* w) {
  pl_pool* p = w->p;
  static const int of[3][2] = {{2, 1}, {0, 2}, {1, 0}};
  for (int i = 0; i < 3; i++) {
    w->spin[0][i] = w->spin[1][i] = pl_int(p, 0);
    for (int k = 0; k < 3; k++) {
      w->spin[1][i] = pl_add(
          p, w->spin[1][i],
          pl_mul(p, pl_dt(p, w->turn[3 * of[i][0] + k]), w->turn[3 * of[i][1] + k]));
      w->spin[0][i] = pl_add(
          p, w->spin[0][i],
          pl_mul(p, w->turn[3 * k + of[i][0]], pl_dt(p, w->turn[3 * k + of[i][1]])));
    }
  }
}

static world world_make(void) {
  static const char *const angles[] = {"phi", "theta", "psi"}, *const parts[] = {"q0", "q1", "q2",
                                                                                 "q3"};
  world w = {.arena = pl_arena_make(NULL)};
  w.p = pl_pool_make(w.arena);
  pl_time(w.p);
  for (int i = 0; i < 3; i++) w.angle[i] = named(w.p, angles[i], PL_R_COORD);
  for (int i = 0; i < 4; i++) w.q[i] = named(w.p, parts[i], PL_R_COORD);
  w.given[0] = named(w.p, "m", PL_R_PARAM);
  w.given[1] = named(w.p, "l", PL_R_PARAM);
  w.triple = pl_triple_make(w.p, w.angle, w.q);
  euler_turn(&w);
  euler_spin(&w);
  return w;
}

static int pick(pl_random* r, int n) { return (int)(pl_random_bits(r) % (uint64_t)n); }

// A polynomial of entries and angular velocities, multiplied out so that nothing of its origin is
// left.
static pl_expr random_smooth(world* w, pl_random* r) {
  pl_pool* p = w->p;
  pl_expr sum = pl_int(p, pick(r, 3));
  for (int n = 1 + pick(r, 3); n > 0; n--) {
    pl_expr product = pl_mul(p, pl_int(p, 1 + pick(r, 4)), w->given[pick(r, 2)]);
    for (int k = 1 + pick(r, 2); k > 0; k--) product = pl_mul(p, product, w->turn[pick(r, 9)]);
    if (pick(r, 2)) product = pl_mul(p, product, w->spin[pick(r, 2)][pick(r, 3)]);
    sum = pl_add(p, sum, pl_expand(p, product, 1000));
  }
  return sum;
}

static void set(const world* w, double* value, pl_expr e, double x) {
  value[pl_symbol_of(w->p, e).id] = x;
}

static void random_values(const world* w, pl_random* r, double* value) {
  double a[3], v[3];
  for (int i = 0; i < 3; i++) {
    a[i] = pl_random_between(r, -3, 3);
    v[i] = pl_random_between(r, -3, 3);
    set(w, value, w->angle[i], a[i]);
    set(w, value, pl_dt(w->p, w->angle[i]), v[i]);
  }
  double c = cos(a[1] / 2), s = sin(a[1] / 2), sum = (a[0] + a[2]) / 2, diff = (a[0] - a[2]) / 2;
  double q[4] = {c * cos(sum), s * cos(diff), s * sin(diff), c * sin(sum)}, nod = v[1] / 2,
         turn = (v[0] + v[2]) / 2, other = (v[0] - v[2]) / 2;
  double u[4] = {
      -s * nod * cos(sum) - c * turn * sin(sum), c * nod * cos(diff) - s * other * sin(diff),
      c * nod * sin(diff) + s * other * cos(diff), -s * nod * sin(sum) + c * turn * cos(sum)};
  for (int i = 0; i < 4; i++) {
    set(w, value, w->q[i], q[i]);
    set(w, value, pl_dt(w->p, w->q[i]), u[i]);
  }
  for (int i = 0; i < 2; i++) set(w, value, w->given[i], pl_random_between(r, 0.5, 2));
}

static void check_same(world* w, uint64_t seed, pl_expr e, pl_expr smooth) {
  pl_random r = {seed * 31};
  double* value = PL_ARRAY(w->arena, double, pl_symbol_count(w->p) + 1);
  for (int i = 0; i < 5; i++) {
    random_values(w, &r, value);
    double x = pl_eval(w->p, e, value), y = pl_eval(w->p, smooth, value);
    bool same = fabs(x - y) <= 1e-10 * (1 + fabs(x));
    if (!same)
      print_message("seed %llu: %.17g, wanted %.17g\n  %s\n  %s\n", (unsigned long long)seed, y, x,
                    pl_expr_text(w->arena, w->p, e), pl_expr_text(w->arena, w->p, smooth));
    assert_true(same);
  }
}

PL_TEST(what_is_smooth_is_found_and_keeps_its_value) {
  for (uint64_t seed = first_seed; seed < first_seed + N_ROUNDS; seed++) {
    world w = world_make();
    pl_random r = {seed};
    pl_expr e = random_smooth(&w, &r), smooth = pl_smooth(w.arena, w.p, &w.triple, e);
    if (pl_is_poison(smooth))
      print_message("seed %llu: %s\n", (unsigned long long)seed, pl_expr_text(w.arena, w.p, e));
    assert_false(pl_is_poison(smooth));
    assert_false(pl_triple_in(w.p, w.arena, &w.triple, smooth));
    check_same(&w, seed, e, smooth);
    pl_arena_free(w.arena);
  }
}

// Single expressions that have no value, or no slope, at ϑ = 0 or 180°.
static pl_expr rough(world* w, int i) {
  pl_pool* p = w->p;
  pl_expr s1 = pl_call(p, PL_SIN, w->angle[1]), s0 = pl_call(p, PL_SIN, w->angle[0]),
          c1 = pl_call(p, PL_COS, w->angle[1]);
  switch (i) {
    case 0: return w->angle[0];
    case 1: return w->angle[1];
    case 2: return s1;
    case 3: return s0;
    case 4: return pl_dt(p, w->angle[0]);
    case 5: return pl_mul(p, pl_dt(p, w->angle[0]), s1);
    case 6: return pl_mul(p, pl_square(p, s0), pl_square(p, c1));
    case 7: return pl_dt(p, w->angle[1]);
    case 8: return pl_square(p, w->angle[1]);
    case 9: return pl_div(p, s0, s1);
    case 10: return pl_add(p, pl_dt(p, w->angle[0]), pl_dt(p, w->angle[2]));
    case 11: return pl_mul(p, s1, pl_call(p, PL_SIN, pl_mul(p, pl_int(p, 2), w->angle[0])));
    default: return pl_dt(p, pl_dt(p, w->angle[0]));
  }
}

PL_TEST(what_is_not_smooth_is_refused) {
  for (int i = 0; i <= 12; i++) {
    world w = world_make();
    pl_random r = {first_seed + (uint64_t)i};
    pl_expr e = rough(&w, i);
    assert_true(pl_is_poison(pl_smooth(w.arena, w.p, &w.triple, e)));
    assert_true(
        pl_is_poison(pl_smooth(w.arena, w.p, &w.triple, pl_add(w.p, e, random_smooth(&w, &r)))));
    pl_arena_free(w.arena);
  }
}

PL_TEST(a_length_of_smooth_parts_stays_a_root) {
  world w = world_make();
  pl_expr e = pl_sqrt(w.p, pl_add(w.p, pl_int(w.p, 3), w.turn[2]));
  pl_expr smooth = pl_smooth(w.arena, w.p, &w.triple, e);
  assert_true(pl_is_sqrt(w.p, smooth));
  check_same(&w, first_seed, e, smooth);
  pl_arena_free(w.arena);
}

PL_TEST(whole_multiples_of_angles_are_read) {
  world w = world_make();
  pl_pool* p = w.p;
  // sin² ϑ sin 2φ = 2 R13 (-R23) with a phase
  pl_expr twice = pl_call(p, PL_SIN, pl_add(p, pl_mul(p, pl_int(p, 2), w.angle[0]), w.given[0]));
  pl_expr e = pl_mul(p, pl_square(p, pl_call(p, PL_SIN, w.angle[1])), twice);
  pl_expr smooth = pl_smooth(w.arena, p, &w.triple, e);
  assert_false(pl_is_poison(smooth));
  check_same(&w, first_seed, e, smooth);
  pl_arena_free(w.arena);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_is_smooth_is_found_and_keeps_its_value),
      cmocka_unit_test(what_is_not_smooth_is_refused),
      cmocka_unit_test(a_length_of_smooth_parts_stays_a_root),
      cmocka_unit_test(whole_multiples_of_angles_are_read),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
