// Certificates: is what is shown the same as what was derived? Decided without the tower, by
// evaluation at sample points: 20 modulo p = 2^61 - 9265983825153 and 50 in ball arithmetic, 256
// bits and more when that does not decide.
//
// The points, the values of definitions and unknowns there and all nodes evaluated so far are kept,
// so that many formulas over the same quantities cost little more than one. Modulo p the sign of a
// root is a free choice: an identity that holds there holds on all branches. One that fails there
// but holds at all 50 points depends on a sign; the points decide.
#include "algebra/tower.h"
#include "verify/verify.h"

#include <math.h>
#include <string.h>

enum {
  PL_VERIFY_MOD = 20,
  PL_VERIFY_MOD_TRIES = 60,
  PL_VERIFY_ARB = 50,
  PL_VERIFY_FEWEST = 10,
  PL_VERIFY_BITS = 256,
  PL_VERIFY_MORE_BITS = 1024
};
static const double fine_enough =
    1e-30;  // a difference that contains 0 proves nothing when its radius is larger than this

struct pl_verifier {
  pl_job* job;
  pl_pool* pool;
  pl_arena* arena;
  pl_domain setup;
  pl_points* points;
  pl_points* fine;  // at more bits, made when needed
  // where logarithms, roots and inverse functions have values; made when the others meet that too
  // rarely
  pl_points* inside;
  PL_VEC(pl_fact) within;  // the conditions for it, after the facts of the setup
  pl_map* visited;         // nodes whose conditions are among them
  pl_mod_point* mod[PL_VERIFY_MOD];
  int n_mod;
};

// --------------------------------------------------------------------------------- points modulo p
static uint64_t minus_mod(uint64_t a) { return a ? PL_MOD_P - a : 0; }

// Gauss-Jordan on M (n x (n + 1)).
static bool solve_mod(uint64_t* M, int n) {
  for (int k = 0; k < n; k++) {
    int p = k;
    while (p < n && M[p * (n + 1) + k] == 0) p++;
    if (p == n) return false;
    for (int j = 0; j <= n && p != k; j++) {
      uint64_t swap = M[k * (n + 1) + j];
      M[k * (n + 1) + j] = M[p * (n + 1) + j];
      M[p * (n + 1) + j] = swap;
    }
    uint64_t inverse = pl_mod_inv(M[k * (n + 1) + k]);
    for (int j = k; j <= n; j++) M[k * (n + 1) + j] = pl_mod_mul(M[k * (n + 1) + j], inverse);
    for (int i = 0; i < n; i++) {
      uint64_t f = M[i * (n + 1) + k];
      if (i == k || f == 0) continue;
      for (int j = k; j <= n; j++) {
        M[i * (n + 1) + j] = pl_mod_add(M[i * (n + 1) + j],
                                        minus_mod(pl_mod_mul(f, M[k * (n + 1) + j])));
      }
    }
  }
  return true;
}

static bool set_unknowns(pl_verifier* c, pl_mod_point* m) {
  int n = c->setup.n_unknowns;
  if (n == 0) return true;
  uint64_t* M = PL_ARRAY(c->arena, uint64_t, n * (n + 1));
  bool ok = true;
  for (int i = 0; i < n && ok; i++) {
    for (int j = 0; j < n && ok; j++)
      M[i * (n + 1) + j] = pl_eval_mod(m, c->setup.A[i * n + j], &ok);
    if (ok) M[i * (n + 1) + n] = pl_eval_mod(m, c->setup.b[i], &ok);
  }
  if (!ok || !solve_mod(M, n)) return false;
  for (int i = 0; i < n; i++) pl_mod_point_set(m, c->setup.unknowns[i], M[i * (n + 1) + n]);
  return true;
}

static bool set_definitions(pl_verifier* c, pl_mod_point* m) {
  for (int i = 0; i < c->setup.n_definitions; i++) {
    bool ok = true;
    uint64_t v = pl_eval_mod(m, c->setup.definitions[i].value, &ok);
    if (!ok) return false;
    pl_mod_point_set(m, c->setup.definitions[i].symbol, v);
  }
  return true;
}

static void make_mod_points(pl_verifier* c) {
  for (uint64_t seed = 1; seed <= PL_VERIFY_MOD_TRIES && c->n_mod < PL_VERIFY_MOD; seed++) {
    pl_mod_point* m = pl_mod_point_make(c->arena, c->pool, seed);
    if (set_definitions(c, m) && set_unknowns(c, m)) c->mod[c->n_mod++] = m;
  }
}

// ------------------------------------------------------------------------------------------ making
static void* copy_array(pl_arena* a, const void* from, size_t n, size_t size) {
  if (n == 0) return NULL;
  void* to = pl_alloc_array(a, n, size);
  memcpy(to, from, n * size);
  return to;
}

pl_verifier* pl_verifier_make(pl_job* job, pl_pool* p, const pl_domain* s) {
  pl_arena* a = pl_pool_arena(p);
  pl_verifier* c = PL_NEW(a, pl_verifier);
  c->job = job;
  c->pool = p;
  c->arena = a;
  size_t n = (size_t)s->n_unknowns;
  c->setup = *s;
  c->setup.facts = copy_array(a, s->facts, (size_t)s->n_facts, sizeof *s->facts);
  c->setup.definitions = copy_array(a, s->definitions, (size_t)s->n_definitions,
                                    sizeof *s->definitions);
  c->setup.unknowns = copy_array(a, s->unknowns, n, sizeof *s->unknowns);
  c->setup.A = copy_array(a, s->A, n * n, sizeof *s->A);
  c->setup.b = copy_array(a, s->b, n, sizeof *s->b);
  c->points = pl_points_make(job, p, &c->setup, PL_VERIFY_ARB, PL_VERIFY_BITS, 2);
  make_mod_points(c);
  return c;
}

// --------------------------------------------------------------------------------------- comparing
typedef struct pl_mod_count {
  int equal, different;
} pl_mod_count;

static pl_mod_count compare_mod(pl_verifier* c, pl_expr shown, pl_expr reference) {
  pl_mod_count count = {0};
  for (int i = 0; i < c->n_mod; i++) {
    bool ok1 = true, ok2 = true;
    uint64_t a = pl_eval_mod(c->mod[i], shown, &ok1);
    uint64_t b = pl_eval_mod(c->mod[i], reference, &ok2);
    if (!ok1 || !ok2) continue;
    if (a == b) count.equal++;
    else count.different++;
  }
  return count;
}

// Relative difference at one point: bound in *relative. PL_UNKNOWN when the point or the precision
// does not do.
static pl_answer3 compare_at(pl_points* s, int i, pl_expr shown, pl_expr reference, long bits,
                             double* relative) {
  arb_srcptr a, b;
  if (!pl_points_value(s, i, shown, &a) || !pl_points_value(s, i, reference, &b)) return PL_UNKNOWN;
  arb_t difference, size;
  arb_init(difference);
  arb_init(size);
  arb_sub(difference, a, b, bits);
  arb_abs(size, b);
  arb_abs(difference, difference);
  if (!arb_contains_zero(size)) arb_div(difference, difference, size, bits);
  mag_t bound;
  mag_init(bound);
  arb_get_mag(bound, difference);
  *relative = mag_get_d(bound);
  pl_answer3 answer = PL_YES;
  if (!arb_is_finite(difference)) answer = PL_UNKNOWN;
  else if (!arb_contains_zero(difference)) answer = PL_NO;
  else if (*relative > fine_enough) answer = PL_UNKNOWN;
  mag_clear(bound);
  arb_clear(difference);
  arb_clear(size);
  return answer;
}

static pl_points* fine_points(pl_verifier* c) {
  if (!c->fine)
    c->fine = pl_points_make(c->job, c->pool, &c->setup, PL_VERIFY_ARB, PL_VERIFY_MORE_BITS, 2);
  return c->fine;
}

static bool point_is_usable(pl_points* s, int i, pl_expr shown, pl_expr reference) {
  arb_srcptr v;
  return pl_points_value(s, i, shown, &v) && pl_points_value(s, i, reference, &v);
}

// ---------------------------------------------------------------------------- domains of functions
static void must_hold(pl_verifier* c, pl_expr difference, bool strict) {
  if (pl_is_constant(c->pool, difference) || pl_has_role(c->pool, difference, PL_R_ACCELERATION)
      || pl_has_role(c->pool, difference, PL_R_MULTIPLIER)) {
    return;
  }
  pl_push(c->arena, c->within, (pl_fact){difference, strict});
}

// What must hold for e to have a real value, from the functions in it.
static void collect_domain(pl_verifier* c, pl_expr e, int depth) {
  pl_kind k = pl_kind_of(c->pool, e);
  if (depth > PL_MAX_DEPTH || pl_map_get(c->visited, e.id)) return;
  pl_map_set(c->visited, e.id, 1);
  if (k == PL_SUM || k == PL_AT || k == PL_UNKNOWN_FUNCTION) return;
  for (int i = 0; i < pl_n_args(c->pool, e); i++)
    collect_domain(c, pl_arg(c->pool, e, i), depth + 1);
  if (k == PL_POW) {
    long num = 0, den = 1;
    bool whole = pl_is_ratio(c->pool, pl_arg(c->pool, e, 1), &num, &den) && den == 1;
    if (!whole) must_hold(c, pl_arg(c->pool, e, 0), true);
  }
  if (k != PL_CALL) return;
  pl_function f = pl_function_of(c->pool, e);
  pl_expr a = pl_arg(c->pool, e, 0), one = pl_int(c->pool, 1);
  if (f == PL_LN) must_hold(c, a, true);
  if (f != PL_ASIN && f != PL_ACOS) return;
  must_hold(c, pl_sub(c->pool, one, a), false);
  must_hold(c, pl_add(c->pool, one, a), false);
}

static void add_domain(pl_verifier* c, pl_expr shown, pl_expr reference) {
  if (!c->visited) {
    c->visited = pl_map_make(c->arena);
    for (int i = 0; i < c->setup.n_facts; i++) pl_push(c->arena, c->within, c->setup.facts[i]);
    for (int i = 0; i < c->setup.n_definitions; i++)
      collect_domain(c, c->setup.definitions[i].value, 0);
  }
  int before = c->within.n;
  collect_domain(c, shown, 0);
  collect_domain(c, reference, 0);
  if (c->inside && c->within.n == before) return;
  pl_domain s = c->setup;
  s.facts = c->within.at;
  s.n_facts = c->within.n;
  c->inside = pl_points_make(c->job, c->pool, &s, PL_VERIFY_ARB, PL_VERIFY_MORE_BITS, 3);
}

// ---------------------------------------------------------------------------------------- verdicts
// One point more; false when it shows a difference.
static bool count_point(pl_verification* r, pl_answer3 here, double relative) {
  if (here == PL_UNKNOWN) return true;
  r->points_arb++;
  r->worst = fmax(r->worst, relative);
  return here != PL_NO;
}

// At the points of the certifier. Finite but too wide: more bits; not finite: outside the domain,
// the next point.
static bool equal_anywhere(pl_verifier* c, pl_verification* r, pl_expr shown, pl_expr reference) {
  for (int i = 0; i < PL_VERIFY_ARB; i++) {
    double relative = 0;
    pl_answer3 here = compare_at(c->points, i, shown, reference, PL_VERIFY_BITS, &relative);
    if (here == PL_UNKNOWN && point_is_usable(c->points, i, shown, reference)) {
      here = compare_at(fine_points(c), i, shown, reference, PL_VERIFY_MORE_BITS, &relative);
    }
    if (!count_point(r, here, relative)) return false;
  }
  return true;
}

// At points that are drawn for the functions of these two.
static bool equal_inside(pl_verifier* c, pl_verification* r, pl_expr shown, pl_expr reference) {
  add_domain(c, shown, reference);
  for (int i = 0; i < PL_VERIFY_ARB; i++) {
    double relative = 0;
    pl_answer3 here = compare_at(c->inside, i, shown, reference, PL_VERIFY_MORE_BITS, &relative);
    if (!count_point(r, here, relative)) return false;
  }
  return true;
}

pl_verification pl_verify(pl_verifier* c, pl_expr shown, pl_expr reference) {
  pl_verification r = {.equal = PL_UNKNOWN};
  if (pl_is_poison(shown) || pl_is_poison(reference)) return r;
  pl_mod_count mod = compare_mod(c, shown, reference);
  r.points_mod = mod.equal;
  bool equal = equal_anywhere(c, &r, shown, reference);
  if (equal && r.points_arb < PL_VERIFY_FEWEST) equal = equal_inside(c, &r, shown, reference);
  if (!equal) {
    r.equal = PL_NO;
  } else if (r.points_arb >= PL_VERIFY_FEWEST) {
    r.equal = PL_YES;
  }
  return r;
}
