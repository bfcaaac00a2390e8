// Coordinates that only a map of `choose` determines, at the moment when the map holds again: a
// rope that goes taut, a rod that is attached. While the map did not hold they rested somewhere;
// now they are found from the old coordinates, which stay.
//
// Newton's method on the squares of the map equations, in those coordinates alone, from several
// places: angles have two.
#include <math.h>

#include "solve/dae/dae.h"

enum { MOST_COORDINATES = 8, MOST_ROWS = 24, ROUNDS = 60, PLACES = 8 };

static const double met = 1e-9;  // of the terms of a map equation
// between places that are tried, an eighth of a turn for angles
static const double turn = 0.78539816339744830962;

typedef struct pl_map_work {
  int n, m;  // coordinates, map equations
  int coordinate[MOST_COORDINATES], row[MOST_ROWS];
  double J[MOST_ROWS * MOST_COORDINATES], N[MOST_COORDINATES * MOST_COORDINATES],
      x[MOST_COORDINATES];
} pl_map_work;

// What the map takes for granted is there or arrives now, and it did not hold before.
static bool begins(const pl_dae* dae, int c) {
  const pl_constraint_setup* l = &dae->setup->constraints[c];
  if (l->n_needs == 0 || dae->active[c]) return false;
  for (int i = 0; i < l->n_needs; i++)
    if (!dae->on[l->needs[i]] && !dae->near_by[l->needs[i]]) return false;
  return true;
}

static int index_in(const int* list, int n, int x) {
  for (int i = 0; i < n; i++)
    if (list[i] == x) return i;
  return -1;
}

// Derivatives of the map equations; takes coordinates that nothing holds as it meets them.
static bool slopes(const pl_dae* dae, pl_map_work* w, bool collect) {
  for (int i = 0; i < MOST_ROWS * MOST_COORDINATES; i++) w->J[i] = 0;
  for (int i = 0; i < dae->motion.n; i++) {
    const pl_batch* b = &dae->motion.at[i];
    for (const pl_pattern_entry* e = b->pattern->G; e < b->pattern->G + b->pattern->n_G; e++)
      for (int l = 0; l < b->n; l++) {
        int r = index_in(w->row, w->m, b->c[e->row * b->lanes + l]),
            q = b->q[e->col * b->lanes + l];
        if (r < 0 || dae->has_equation[q] != 0) continue;
        int k = index_in(w->coordinate, w->n, q);
        if (k < 0 && collect && w->n == MOST_COORDINATES) return false;
        if (k < 0 && collect) w->coordinate[k = w->n++] = q;
        if (k >= 0)
          w->J[r * MOST_COORDINATES + k] += pl_jet_at(b->jet, b->pattern->tape->roots[e->root],
                                                      0)[l];
      }
  }
  return w->n > 0;
}

// Solves N x = right side in place, by elimination with pivots; false where N is singular.
static bool eliminate(pl_map_work* w) {
  int n = w->n;
  for (int k = 0; k < n; k++) {
    int best = k;
    for (int i = k + 1; i < n; i++)
      if (fabs(w->N[i * n + k]) > fabs(w->N[best * n + k])) best = i;
    if (w->N[best * n + k] == 0) return false;
    for (int j = 0; j < n; j++) {
      double swap = w->N[k * n + j];
      w->N[k * n + j] = w->N[best * n + j];
      w->N[best * n + j] = swap;
    }
    double right = w->x[k];
    w->x[k] = w->x[best];
    w->x[best] = right;
    for (int i = 0; i < n; i++) {
      double factor = i == k ? 0 : w->N[i * n + k] / w->N[k * n + k];
      for (int j = k; j < n && factor != 0; j++) w->N[i * n + j] -= factor * w->N[k * n + j];
      w->x[i] -= factor * w->x[k];
    }
  }
  for (int k = 0; k < n; k++) w->x[k] /= w->N[k * n + k];
  return true;
}

static double residual(pl_dae* dae, const pl_map_work* w) {
  double most = 0;
  pl_point_evaluate(dae, dae->t, dae->q, dae->v);
  pl_assemble_g(dae, 0, dae->g, dae->g_size);
  for (int r = 0; r < w->m; r++)
    most = fmax(most, fabs(dae->g[w->row[r]]) / fmax(dae->g_size[w->row[r]], 1e-300));
  return most;
}

static bool correct(pl_dae* dae, pl_map_work* w) {
  int n = w->n;
  slopes(dae, w, false);
  for (int i = 0; i < n; i++) {
    w->x[i] = 0;
    for (int r = 0; r < w->m; r++) w->x[i] -= w->J[r * MOST_COORDINATES + i] * dae->g[w->row[r]];
    for (int j = 0; j < n; j++) {
      w->N[i * n + j] = 0;
      for (int r = 0; r < w->m; r++)
        w->N[i * n + j] += w->J[r * MOST_COORDINATES + i] * w->J[r * MOST_COORDINATES + j];
    }
  }
  if (!eliminate(w)) return false;
  for (int i = 0; i < n; i++) dae->q[w->coordinate[i]] += w->x[i];
  return true;
}

static bool found_from_here(pl_dae* dae, pl_map_work* w) {
  double left = residual(dae, w);
  for (int round = 0; round < ROUNDS && left > 1e-15; round++) {
    double before = left;
    if (!correct(dae, w)) break;
    left = residual(dae, w);
    if (!(left < before) && before <= met) break;
  }
  return left <= met;
}

void pl_maps_follow(pl_dae* dae) {
  pl_map_work w = {0};
  for (int c = 0; c < dae->n_c; c++) {
    if (!begins(dae, c)) continue;
    if (w.m == MOST_ROWS) return;
    w.row[w.m++] = c;
  }
  if (w.m == 0) return;
  pl_point_evaluate(dae, dae->t, dae->q, dae->v);
  if (!slopes(dae, &w, true)) return;
  double home[MOST_COORDINATES];
  for (int i = 0; i < w.n; i++) home[i] = dae->q[w.coordinate[i]];
  for (int place = 0; place < PLACES; place++) {
    for (int i = 0; i < w.n; i++) dae->q[w.coordinate[i]] = home[i] + place * turn;
    if (found_from_here(dae, &w)) return;
  }
  for (int i = 0; i < w.n; i++) dae->q[w.coordinate[i]] = home[i];
}
