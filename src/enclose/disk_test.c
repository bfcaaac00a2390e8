// Laws of disks and series on random input: an operation in disks contains its values at complex
// points of the disks, and slopes and Taylor coefficients contain derivatives found in another way.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "enclose/enclose_impl.h"

#if __has_include(<flint/acb.h>)
#  include <flint/acb.h>
#else
#  include <acb.h>
#endif

enum { ROUNDS = 400, BITS = 128 };

typedef struct random_disk {
  pl_disk* d;
  double centre, radius;
} random_disk;

static random_disk* disks_make(int n) {
  random_disk* x = calloc((size_t)n, sizeof *x);
  for (int i = 0; i < n; i++) x[i].d = pl_disks_make(1);
  return x;
}

static void disks_free(random_disk* x, int n) {
  for (int i = 0; i < n; i++) pl_disks_free(x[i].d, 1);
  free(x);
}

static void draw(random_disk* x, pl_random* r) {
  x->centre = pl_random_between(r, -3, 3);
  x->radius = pl_random_unit(r) < 0.2 ? 0 : pow(10, pl_random_between(r, -6, 0.3));
  arb_set_d(&x->d->c, x->centre);
  mag_set_d(&x->d->r, x->radius);
}

// A point of the disk, often on its rim.
static void point(acb_t z, const random_disk* x, pl_random* r) {
  double part = pl_random_unit(r) < 0.5 ? 0.999999999 : pl_random_unit(r),
         turn = pl_random_between(r, -M_PI, M_PI);
  acb_set_d_d(z, x->centre + part * x->radius * cos(turn), part * x->radius * sin(turn));
}

static void exact_op(acb_t w, pl_op op, acb_t a, acb_t b) {
  acb_t t;
  acb_init(t);
  switch (op) {
    case PL_OP_ADD: acb_add(w, a, b, BITS); break;
    case PL_OP_SUB: acb_sub(w, a, b, BITS); break;
    case PL_OP_NEG: acb_neg(w, a); break;
    case PL_OP_MUL: acb_mul(w, a, b, BITS); break;
    case PL_OP_SQR: acb_sqr(w, a, BITS); break;
    case PL_OP_DIV: acb_div(w, a, b, BITS); break;
    case PL_OP_SQRT: acb_sqrt(w, a, BITS); break;
    case PL_OP_POW: acb_pow(w, a, b, BITS); break;
    case PL_OP_EXP: acb_exp(w, a, BITS); break;
    case PL_OP_LN: acb_log(w, a, BITS); break;
    case PL_OP_SIN: acb_sin(w, a, BITS); break;
    case PL_OP_COS: acb_cos(w, a, BITS); break;
    case PL_OP_SINH: acb_sinh(w, a, BITS); break;
    case PL_OP_COSH: acb_cosh(w, a, BITS); break;
    case PL_OP_TAN: acb_tan(w, a, BITS); break;
    case PL_OP_TANH: acb_tanh(w, a, BITS); break;
    case PL_OP_ASIN: acb_asin(w, a, BITS); break;
    case PL_OP_ACOS: acb_acos(w, a, BITS); break;
    case PL_OP_ATAN: acb_atan(w, a, BITS); break;
    case PL_OP_ASINH: acb_asinh(w, a, BITS); break;
    default:  // atan2(a, b) with a above: π/2 - atan(b/a)
      acb_div(t, b, a, BITS);
      acb_atan(w, t, BITS);
      acb_const_pi(t, BITS);
      acb_mul_2exp_si(t, t, -1);
      acb_sub(w, t, w, BITS);
      break;
  }
  acb_clear(t);
}

// |w - c| <= r for some number of the ball c, as far as `BITS` can tell.
static bool holds(const pl_disk* d, acb_t w) {
  acb_t gap;
  arb_t size;
  mag_t least;
  acb_init(gap);
  arb_init(size);
  mag_init(least);
  acb_sub_arb(gap, w, &d->c, BITS);
  acb_abs(size, gap, BITS);
  arb_get_mag_lower(least, size);
  bool yes = mag_cmp(least, &d->r) <= 0;
  acb_clear(gap);
  arb_clear(size);
  mag_clear(least);
  return yes;
}

static const pl_op ops[] = {PL_OP_ADD,  PL_OP_SUB,   PL_OP_NEG,  PL_OP_MUL,  PL_OP_SQR,  PL_OP_DIV,
                            PL_OP_SQRT, PL_OP_POW,   PL_OP_EXP,  PL_OP_LN,   PL_OP_SIN,  PL_OP_COS,
                            PL_OP_SINH, PL_OP_COSH,  PL_OP_TAN,  PL_OP_TANH, PL_OP_ASIN, PL_OP_ACOS,
                            PL_OP_ATAN, PL_OP_ATAN2, PL_OP_ASINH};
enum { N_OPS = sizeof ops / sizeof *ops };

// The disk of a partner, 1 + a² or its root.
static bool partner(pl_disk* w, const pl_disk* a, bool root) {
  pl_disk* one = pl_disks_make(1);
  arb_one(&one->c);
  bool ok = pl_disk_op(w, PL_OP_SQR, a, NULL, NULL) && pl_disk_op(w, PL_OP_ADD, one, w, NULL)
            && (!root || pl_disk_op(w, PL_OP_SQRT, w, NULL, NULL));
  pl_disks_free(one, 1);
  return ok;
}

static void an_operation_contains_its_values_at_complex_points(void** state) {
  (void)state;
  random_disk* x = disks_make(4);
  acb_t a, b, w;
  acb_init(a);
  acb_init(b);
  acb_init(w);
  int proved[N_OPS] = {0};
  for (uint64_t seed = 1; seed <= ROUNDS; seed++) {
    for (int k = 0; k < N_OPS; k++) {
      pl_random r = {seed * 100 + (uint64_t)k};
      draw(&x[0], &r);
      draw(&x[1], &r);
      if (ops[k] == PL_OP_POW) {  // exponents are numbers
        mag_zero(&x[1].d->r);
        x[1].radius = 0;
      }
      if (ops[k] == PL_OP_ATAN2 && x[0].centre < x[0].radius) continue;
      bool by_slope = ops[k] == PL_OP_ASINH;
      if (by_slope && !partner(x[3].d, x[0].d, true)) continue;
      if (!pl_disk_op(x[2].d, ops[k], x[0].d, x[1].d, by_slope ? x[3].d : NULL)) continue;
      proved[k]++;
      for (int i = 0; i < 4; i++) {
        point(a, &x[0], &r);
        point(b, &x[1], &r);
        exact_op(w, ops[k], a, b);
        if (!holds(x[2].d, w))
          fail_msg("%s: seed %lu, disks (%g, %g), (%g, %g)", pl_op_name[ops[k]],
                   (unsigned long)seed, x[0].centre, x[0].radius, x[1].centre, x[1].radius);
      }
    }
  }
  // the law says nothing of what was refused
  for (int k = 0; k < N_OPS; k++) assert_true(proved[k] > ROUNDS / 20);
  acb_clear(a);
  acb_clear(b);
  acb_clear(w);
  disks_free(x, 4);
}

static void a_bound_by_the_derivative_contains_the_values(void** state) {
  (void)state;
  random_disk* x = disks_make(3);
  acb_t a, w;
  acb_init(a);
  acb_init(w);
  int proved = 0;
  for (uint64_t seed = 1; seed <= ROUNDS; seed++) {
    pl_random r = {seed};
    draw(&x[0], &r);
    if (!partner(x[1].d, x[0].d, false)) continue;
    if (!pl_disk_by_slope(x[2].d, PL_OP_ATAN, x[0].d, x[1].d)) continue;
    proved++;
    for (int i = 0; i < 4; i++) {
      point(a, &x[0], &r);
      exact_op(w, PL_OP_ATAN, a, a);
      assert_true(holds(x[2].d, w));
    }
  }
  assert_true(proved > ROUNDS / 20);
  acb_clear(a);
  acb_clear(w);
  disks_free(x, 3);
}

// A disk that is too small is seen: the law above can fail.
static void a_disk_that_is_too_small_is_seen(void** state) {
  (void)state;
  random_disk* x = disks_make(2);
  acb_t w;
  acb_init(w);
  arb_set_d(&x[0].d->c, 1);
  mag_set_d(&x[0].d->r, 0.5);
  assert_true(pl_disk_op(x[1].d, PL_OP_EXP, x[0].d, NULL, NULL));
  acb_set_d(w, exp(1.5) * (1 - 1e-9));
  assert_true(holds(x[1].d, w));
  mag_set_d(&x[1].d->r, (exp(1.5) - exp(1)) * 0.999);
  assert_false(holds(x[1].d, w));
  acb_clear(w);
  disks_free(x, 2);
}

static void what_is_not_analytic_is_refused(void** state) {
  (void)state;
  random_disk* x = disks_make(2);
  static const pl_op touching_zero[] = {PL_OP_SQRT, PL_OP_LN, PL_OP_ABS, PL_OP_SIGN};
  arb_set_d(&x[0].d->c, 1);
  mag_set_d(&x[0].d->r, 1.0000001);
  for (int i = 0; i < 4; i++)
    assert_false(pl_disk_op(x[1].d, touching_zero[i], x[0].d, NULL, NULL));
  assert_false(pl_disk_op(x[1].d, PL_OP_DIV, x[0].d, x[0].d, NULL));
  assert_false(pl_disk_op(x[1].d, PL_OP_ASIN, x[0].d, NULL, NULL));
  mag_set_d(&x[0].d->r, 0.99);
  for (int i = 0; i < 4; i++) assert_true(pl_disk_op(x[1].d, touching_zero[i], x[0].d, NULL, NULL));
  disks_free(x, 2);
}

// ------------------------------------------------------------------------------- series and slopes
typedef struct bench {
  pl_arena* arena;
  pl_pool* pool;
  pl_job job;
  pl_diagnostics diagnostics;
  pl_expr x;
  pl_tape* tape;
  pl_pattern pattern;
  pl_ball_jet jet;
} bench;

static bench* bench_open(void) {
  pl_arena* arena = pl_arena_make(NULL);
  bench* b = PL_NEW(arena, bench);
  b->arena = arena;
  b->pool = pl_pool_make(arena);
  b->diagnostics.arena = arena;
  b->job = (pl_job){.arena = arena, .diagnostics = &b->diagnostics};
  pl_symbol_info info = {
      .name = "x", .ascii = "x", .role = PL_R_COORD, .dimension = pl_dimension_one()};
  b->x = pl_sym(b->pool, pl_symbol_make(b->pool, &info));
  return b;
}

static bool record(bench* b, pl_expr e) {
  static double value[64];
  pl_tape_slots slots = {.n_q = 1, .q = &b->x, .value_of_symbol = value};
  return pl_tape_record(&b->job, b->pool, &slots, &e, NULL, 1, &b->tape) == PLEUEL_OK;
}

// The functions of the language one inside of the other, arguments kept in their domains.
static pl_expr random_expression(bench* b, pl_random* r, int depth) {
  pl_pool* p = b->pool;
  if (depth == 0) return b->x;
  pl_expr a = random_expression(b, r, depth - 1);
  pl_expr small = pl_div(p, a, pl_add(p, pl_int(p, 2), pl_square(p, a)));  // |small| < 0.36
  switch (pl_random_bits(r) % 16) {
    case 0: return pl_call(p, PL_SIN, a);
    case 1: return pl_call(p, PL_COS, a);
    case 2: return pl_call(p, PL_TAN, small);
    case 3: return pl_call(p, PL_ASIN, small);
    case 4: return pl_call(p, PL_ACOS, small);
    case 5: return pl_call(p, PL_ATAN, a);
    case 6: return pl_call2(p, PL_ATAN2, a, pl_add(p, pl_int(p, 1), pl_square(p, small)));
    case 7: return pl_call(p, PL_SINH, small);
    case 8: return pl_call(p, PL_COSH, small);
    case 9: return pl_call(p, PL_TANH, a);
    case 10: return pl_call(p, PL_EXP, small);
    case 11: return pl_call(p, PL_LN, pl_add(p, pl_int(p, 2), pl_square(p, a)));
    case 12: return pl_sqrt(p, pl_add(p, pl_int(p, 1), pl_square(p, a)));
    case 13: return pl_pow(p, pl_add(p, pl_int(p, 1), small), pl_ratio(p, 7, 3));
    case 14: return pl_mul(p, a, pl_add(p, a, pl_ratio(p, 1, 3)));
    default: return pl_div(p, pl_int(p, 1), pl_add(p, pl_int(p, 2), a));
  }
}

static void jet_open(bench* b, int cap) {
  b->pattern = (pl_pattern){.tape = b->tape, .n_q = 1};
  pl_ball_jet* j = &b->jet;
  *j = (pl_ball_jet){.pattern = &b->pattern, .tape = b->tape, .cap = cap};
  int n = b->tape->n_nodes;
  j->coef = _arb_vec_init((slong)n * cap);
  j->aux = _arb_vec_init((slong)n * cap);
  j->aux_at = PL_ARRAY(b->arena, int, n);
  j->wanted = PL_ARRAY(b->arena, uint8_t, n);
  j->disk = pl_disks_make(n);
  j->slope = pl_disks_make(n);
  for (int i = 0; i < n; i++) {
    j->aux_at[i] = i;
    j->wanted[i] = PL_FOR_MOTION;
    if (b->tape->nodes[i].op != PL_OP_CONST) continue;
    long num, den;
    if (pl_is_poison(b->tape->constant[i])) {
      arb_set_d(j->coef + (slong)i * cap, b->tape->nodes[i].value);
    } else if (pl_is_ratio(b->pool, b->tape->constant[i], &num, &den)) {
      arb_set_si(j->coef + (slong)i * cap, num);
      arb_div_si(j->coef + (slong)i * cap, j->coef + (slong)i * cap, den, 256);
    }
  }
}

static void jet_close(bench* b) {
  pl_ball_jet* j = &b->jet;
  _arb_vec_clear(j->coef, (slong)b->tape->n_nodes * j->cap);
  _arb_vec_clear(j->aux, (slong)b->tape->n_nodes * j->cap);
  pl_disks_free(j->disk, b->tape->n_nodes);
  pl_disks_free(j->slope, b->tape->n_nodes);
}

// Series of the root along x(t) = x_0 + t.
static void run_series(bench* b, double x_0, slong prec) {
  pl_ball_jet* j = &b->jet;
  arb_ptr q = j->coef + (slong)b->tape->q_node[0] * j->cap;
  _arb_vec_zero(q, j->cap);
  arb_set_d(q, x_0);
  arb_one(q + 1);
  pl_jet_coefficients(j, PL_LEVEL_CONST, 0, prec, PL_FOR_MOTION);
  for (int k = 0; k < j->cap; k++)
    pl_jet_coefficients(j, PL_LEVEL_POSITION, k, prec, PL_FOR_MOTION);
}

// The polynomial of order 30 at t = 1/64 against the value there.
static void series_continue_their_functions(void** state) {
  (void)state;
  int met = 0;
  for (uint64_t seed = 1; seed <= 120; seed++) {
    bench* b = bench_open();
    pl_random r = {seed};
    pl_expr e = random_expression(b, &r, 1 + (int)(seed % 3));
    double x_0 = pl_random_between(&r, 0.1, 0.9);
    assert_true(record(b, e));
    if (b->tape->q_node[0] >= 0 && b->tape->nodes[b->tape->roots[0]].level == PL_LEVEL_POSITION) {
      jet_open(b, 31);
      arb_t sum, exact;
      arb_init(sum);
      arb_init(exact);
      run_series(b, x_0 + 1.0 / 64, 256);
      arb_set(exact, pl_root_series(&b->jet, 0));
      run_series(b, x_0, 256);
      for (int k = 30; k >= 0; k--) {
        arb_mul_2exp_si(sum, sum, -6);
        arb_add(sum, sum, pl_root_series(&b->jet, 0) + k, 256);
      }
      arb_sub(sum, sum, exact, 256);
      double off = fabs(pl_ball_double(sum)), size = fabs(pl_ball_double(exact)) + 1;
      if (!(off < 1e-30 * size))
        fail_msg("seed %lu: %s at %g: off by %g", (unsigned long)seed,
                 pl_expr_text(b->arena, b->pool, e), x_0, off);
      met++;
      arb_clear(sum);
      arb_clear(exact);
      jet_close(b);
    }
    pl_arena_free(b->arena);
  }
  assert_true(met > 100);
}

// The slope of a disk without radius is coefficient 1.
static void slopes_are_first_coefficients(void** state) {
  (void)state;
  for (uint64_t seed = 1; seed <= 120; seed++) {
    bench* b = bench_open();
    pl_random r = {seed + 7000};
    pl_expr e = random_expression(b, &r, 1 + (int)(seed % 3));
    double x_0 = pl_random_between(&r, 0.1, 0.9);
    assert_true(record(b, e));
    jet_open(b, 2);
    pl_ball_jet* j = &b->jet;
    run_series(b, x_0, 128);
    for (int i = 0; i < b->tape->n_nodes; i++)
      pl_disk_set_ball(&j->disk[i], j->coef + (slong)i * j->cap);
    arb_one(&j->slope[b->tape->q_node[0]].c);
    const pl_tape_node* nodes = b->tape->nodes;
    for (int i = b->tape->level_end[PL_LEVEL_CONST]; i < b->tape->n_nodes; i++) {
      const pl_tape_node* n = &nodes[i];
      if (n->op < PL_OP_ADD) continue;
#define AT(array, k) ((k) < 0 ? NULL : &j->array[k])
      pl_disk_derivative(&j->slope[i], n->op, &j->disk[i], AT(disk, n->a), AT(disk, n->b),
                         AT(disk, n->c), AT(slope, n->a), AT(slope, n->b), AT(slope, n->c));
#undef AT
    }
    int root = b->tape->roots[0];
    double slope = pl_ball_double(&j->slope[root].c),
           first = pl_ball_double(j->coef + (slong)root * j->cap + 1);
    if (!(fabs(slope - first) <= 1e-14 * (1 + fabs(first))))
      fail_msg("seed %lu: %s: %g, %g", (unsigned long)seed, pl_expr_text(b->arena, b->pool, e),
               slope, first);
    jet_close(b);
    pl_arena_free(b->arena);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(an_operation_contains_its_values_at_complex_points),
      cmocka_unit_test(a_bound_by_the_derivative_contains_the_values),
      cmocka_unit_test(a_disk_that_is_too_small_is_seen),
      cmocka_unit_test(what_is_not_analytic_is_refused),
      cmocka_unit_test(series_continue_their_functions),
      cmocka_unit_test(slopes_are_first_coefficients),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
