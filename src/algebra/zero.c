// Is it zero? Algebra answers yes (its zero is sound); no is answered only when ball arithmetic
// separates the value from zero at a sample point, or when nothing but independent symbols is
// involved. Otherwise: unknown, never a guess.
#include "algebra/tower.h"

enum { PL_ZERO_POINTS = 12, PL_ZERO_MORE_BITS = 1000 };

typedef struct pl_zero_job {
  pl_expr e;
  bool zero, only_symbols;
} pl_zero_job;

static void zero_body(pl_tower* t, void* data) {
  pl_zero_job* j = data;
  pl_frac f = pl_convert(t, j->e);
  bool only_symbols = true;
  for (int g = 0; g < t->gens.n; g++) {
    if (t->gens.at[g].kind != PL_G_SYMBOL && pl_poly_degree(t, f.num, g) > 0) only_symbols = false;
  }
  j->zero = pl_frac_is_zero(t, f);
  j->only_symbols = only_symbols;
}

static bool separated(pl_points* s, pl_expr e) {
  for (int i = 0; i < PL_ZERO_POINTS && i < pl_points_count(s); i++) {
    arb_srcptr v;
    if (pl_points_value(s, i, e, &v) && !arb_contains_zero(v)) return true;
  }
  return false;
}

static void points_body(pl_tower* t, void* data) {
  pl_zero_job* j = data;
  j->zero = !separated(pl_tower_points(t), j->e);
  if (!j->zero) return;
  pl_domain s = {.facts = t->facts.at, .n_facts = t->facts.n};
  if (!t->fine_points)
    t->fine_points = pl_points_make(t->job, t->pool, &s, PL_ZERO_POINTS, PL_ZERO_MORE_BITS, 1);
  j->zero = !separated(t->fine_points, j->e);
}

pl_answer3 pl_alg_is_zero(pl_tower* t, pl_expr e) {
  e = pl_tower_see(t, e);
  if (pl_is_poison(e)) return PL_UNKNOWN;
  if (pl_is_number(t->pool, e)) return pl_is_zero_node(t->pool, e) ? PL_YES : PL_NO;
  pl_zero_job j = {.e = e};
  if (pl_tower_run(t, zero_body, &j)) {
    if (j.zero) return PL_YES;
    if (j.only_symbols) return PL_NO;
  }
  if (pl_tower_run(t, points_body, &j) && !j.zero) return PL_NO;
  return PL_UNKNOWN;
}

pl_answer3 pl_alg_equal(pl_tower* t, pl_expr a, pl_expr b) {
  if (pl_is_poison(a) || pl_is_poison(b)) return PL_UNKNOWN;
  if (pl_same(a, b)) return PL_YES;
  return pl_alg_is_zero(t, pl_sub(t->pool, a, b));
}
