// Rods: between the two points whose distance a constraint keeps, and where places such as (X + l
// sin θ, -l cos θ) keep their distance to what they turn about by themselves.
#include <math.h>
#include <string.h>

#include "scene/scene_impl.h"

enum { SAMPLES = 3, MOST_PAIRS = 60 };

// Is the distance of two spots the same wherever the coordinates are?
static bool is_rigid(pl_stage* s, const pl_spot* p, const pl_spot* q, const int* deps, int n) {
  const pl_spot* pair[2] = {p, q};
  double* kept = PL_ARRAY(s->arena, double, s->n_q + 1);
  pl_coords_keep(s, kept);
  double first = pl_squared_distance(s, pair);
  bool rigid = isfinite(first) && first > 1e-16;
  for (int try = 0; rigid && try < 2 * SAMPLES; try++) {
    for (int i = 0; i < n; i++)
      s->value[s->q[deps[i]].id] += pl_random_between(&s->random, -1, 1)
                                    * (s->angle[deps[i]] || !(s->size > 0) ? 1 : s->size);
    rigid = fabs(pl_squared_distance(s, pair) - first) < 1e-9 * first;
  }
  pl_coords_back(s, kept);
  return rigid;
}

static bool shares(const pl_thing* a, const pl_thing* b) {
  for (int i = 0; i < a->deps.n; i++) {
    if (pl_list_has(b->deps.at, b->deps.n, a->deps.at[i])) return true;
  }
  return false;
}

// Half the sum of the places for an angle and for the opposite one: what the place turns about.
static pl_spot pivot_of(pl_stage* s, const pl_thing* t, int angle) {
  pl_spot pivot = t->spot;
  pl_expr opposite = pl_add(s->pool, pl_sym(s->pool, s->q[angle]), pl_pi(s->pool));
  for (int j = 0; j < 3; j++) {
    if (pl_is_poison(t->spot.e[j])) continue;
    pl_expr sum = pl_add(s->pool, t->spot.e[j],
                         pl_subst1(s->pool, t->spot.e[j], s->q[angle], opposite));
    pivot.e[j] = pl_mul(s->pool, pl_ratio(s->pool, 1, 2), pl_expand(s->pool, sum, 200));
  }
  return pivot;
}

static bool same_place(pl_stage* s, const pl_spot* a, const pl_spot* b, const pl_thing* t) {
  const pl_spot* pair[2] = {a, b};
  double* kept = PL_ARRAY(s->arena, double, s->n_q + 1);
  pl_coords_keep(s, kept);
  bool same = true;
  for (int try = 0; same && try < SAMPLES; try++) {
    pl_coords_shuffle(s, t->deps.at, t->deps.n);
    same = pl_squared_distance(s, pair) < 1e-16 * fmax(1, s->size * s->size);
  }
  pl_coords_back(s, kept);
  return same;
}

// Places such as (X + l sin θ, -l cos θ) keep a distance by themselves: a rod, drawn from what they
// turn about.
static void rod_of_angle(pl_stage* s, int i) {
  pl_thing* t = &s->things.at[i];
  pl_spot chosen = {0};
  int candidates = 0;
  bool matched = false;
  for (int k = 0; k < t->deps.n && !matched; k++) {
    if (!s->angle[t->deps.at[k]]) continue;
    pl_spot pivot = pivot_of(s, t, t->deps.at[k]);
    if (!is_rigid(s, &pivot, &t->spot, t->deps.at, t->deps.n)) continue;
    candidates++;
    if (candidates == 1) chosen = pivot;
    for (int j = 0; j < s->things.n && !matched; j++) {
      matched = j != i && same_place(s, &pivot, &s->things.at[j].spot, t);
    }
    if (matched) chosen = pivot;
  }
  if (candidates == 0 || (candidates > 1 && !matched)) return;
  pl_add_rod(s, PL_SHAPE_ROD, NULL, &chosen, &t->spot);
  t->linked = true;
  if (matched) return;
  double x[3];
  pl_stage_spot(s, &chosen, x);
  int *deps = NULL, n = 0;
  bool timed = false;
  for (int j = 0; j < 3; j++) pl_collect_coords(s, chosen.e[j], &deps, &n, &timed);
  if (n == 0 && !timed) {
    pl_add_pivot(s, x);
  } else {
    pl_part* p = pl_stage_add(s, PL_SHAPE_POINT, "", "");
    p->n = 1;
    p->moves = true;
    p->spot[0] = chosen;
  }
}

void pl_stage_rods(pl_stage* s) {
  static const double zero[3] = {0, 0, 0};
  pl_spot origin = pl_spot_fixed(zero);
  for (int i = 0; i < s->things.n && s->things.n <= MOST_PAIRS; i++) {
    pl_thing* t = &s->things.at[i];
    if (t->kind == PL_THING_POINT || t->deps.n == 0) continue;
    bool found = false;
    for (int j = 0; j < s->things.n && !found; j++) {
      pl_thing* o = &s->things.at[j];
      if (j == i || (j > i && o->kind != PL_THING_POINT) || !(shares(t, o) || o->deps.n == 0))
        continue;
      int* all = PL_ARRAY(s->arena, int, t->deps.n + o->deps.n + 1);
      memcpy(all, t->deps.at, (size_t)t->deps.n * sizeof(int));
      memcpy(all + t->deps.n, o->deps.at, (size_t)o->deps.n * sizeof(int));
      if (!is_rigid(s, &t->spot, &o->spot, all, t->deps.n + o->deps.n)) continue;
      pl_add_rod(s, PL_SHAPE_ROD, NULL, &o->spot, &t->spot);
      t->linked = found = true;
    }
    if (!found && !t->timed && is_rigid(s, &t->spot, &origin, t->deps.at, t->deps.n)) {
      pl_add_rod(s, PL_SHAPE_ROD, NULL, &origin, &t->spot);
      pl_add_pivot(s, zero);
      t->linked = found = true;
    }
    if (!found && !t->timed) rod_of_angle(s, i);
  }
}
