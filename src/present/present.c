// pl_present: the most readable form of an expression, an anytime search with a budget of work.
//
// The search runs at depth 0, 1, 2, 3 (how many sums inside sums are collected) and keeps the
// cheapest form; deeper runs start while work is left. Work is counted in steps, not in seconds, so
// that the same input gives the same form on every machine. What is returned has the value of the
// input modulo a large prime at several points; where only the sign of a root can be at fault (√A
// √B = √(A B) holds for positive A, B), balls at points of the domain decide.
#include "present/present_impl.h"

#include <math.h>

enum {
  MAX_SEARCH_DEPTH = 3,
  POINTS = 4,
  MAX_BAD_POINTS = 24,
  DOMAIN_POINTS = 12,
  SMALL_TERMS = 150,
  LARGE_TERMS = 3000
};

// Steps of work in a second: a step is a small part of factoring a polynomial of a few terms, 5 to
// 20 µs.
static const double work_per_second = 100000;

// What the first form may cost in any case, a few milliseconds: small formulas are searched to the
// end with that.
static const long work_of_first_form = 600;

typedef struct present_job {
  pl_expr e;
  pl_style style;
  long limit;
  const pl_form* out;
} present_job;

static void search_forms(pl_tower* t, void* data) {
  present_job* j = data;
  j->out = NULL;
  pl_frac f = pl_convert(t, j->e);
  if (f.num->length > LARGE_TERMS) return;
  int deepest = f.num->length > SMALL_TERMS ? 1 : MAX_SEARCH_DEPTH;
  pl_present_search s = {.t = t, .a = t->arena, .p = t->pool, .style = j->style};
  s.found_at = pl_map_make(s.a);
  s.wave_at = pl_map_make(s.a);
  long best = 0;
  for (int depth = 0; depth <= deepest; depth++) {
    // the plainest form is never cut short
    s.limit = depth == 0 ? 1000000 : j->limit;
    if (depth > 0 && s.work >= s.limit) break;
    long cost;
    const pl_form* form = pl_present_styled(&s, f, depth, &cost);
    if (j->out && cost >= best) continue;
    j->out = form;
    best = cost;
  }
}

// ------------------------------------------------------------------------------------------ checks
static bool has_root(const pl_form* f) {
  if (f->kind == PL_F_ROOT) return true;
  for (int i = 0; i < f->n; i++)
    if (has_root(f->args[i])) return true;
  return false;
}

// Points are kept: formulas of one derivation share most of their nodes.
static pl_mod_point* mod_point(pl_tower* t, int i) {
  while (t->mod_points.n <= i) {
    pl_mod_point* m = pl_mod_point_make(t->arena, t->pool, (uint64_t)(t->mod_points.n + 1) * 7919u);
    pl_push(t->arena, t->mod_points, m);
  }
  return t->mod_points.at[i];
}

static pl_answer3 agrees_mod_p(pl_tower* t, pl_expr a, pl_expr b) {
  int good = 0;
  for (int i = 0; i < MAX_BAD_POINTS && good < POINTS; i++) {
    pl_mod_point* m = mod_point(t, i);
    bool ok_a = true, ok_b = true;
    uint64_t x = pl_eval_mod(m, a, &ok_a), y = pl_eval_mod(m, b, &ok_b);
    if (!ok_a || !ok_b) continue;
    if (x != y) return PL_NO;
    good++;
  }
  return good ? PL_YES : PL_UNKNOWN;
}

// Values at points of the domain, in balls.
static bool agrees_in_domain(pl_tower* t, pl_expr a, pl_expr b) {
  pl_points* points = pl_tower_points(t);
  int good = 0;
  bool same = true;
  for (int i = 0; same && good < DOMAIN_POINTS && i < pl_points_count(points); i++) {
    double x = pl_points_double(points, i, a), y = pl_points_double(points, i, b);
    if (!isfinite(x) || !isfinite(y)) continue;
    same = fabs(x - y) <= 1e-9 * (fabs(x) + fabs(y)) + 1e-300;
    good++;
  }
  return same && good >= 3;
}

static bool is_right(pl_tower* t, const pl_form* f, pl_expr e) {
  pl_expr value = pl_form_value(t->pool, f);
  if (pl_is_poison(value)) return false;
  if (pl_same(value, e)) return true;
  pl_answer3 answer = agrees_mod_p(t, value, e);
  if (answer == PL_YES) return true;
  return (answer == PL_UNKNOWN || has_root(f)) && agrees_in_domain(t, value, e);
}

const pl_form* pl_present(pl_tower* t, pl_expr e, pl_style style, double seconds) {
  pl_pool* p = t->pool;
  present_job j = {.e = e, .style = style, .limit = work_of_first_form};
  if (seconds > 0) j.limit += (long)(seconds * work_per_second);
  if (pl_is_poison(e) || pl_is_number(p, e)) return pl_form_of(t->arena, p, e);
  // a search that gave up at some depth has left the form of the depth before
  pl_tower_run(t, search_forms, &j);
  if (j.out && is_right(t, j.out, e)) return j.out;
  return pl_form_of(t->arena, p, e);
}
