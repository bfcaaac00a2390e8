// What is watched of frictions: how far a force is from its limit, slip velocities that come to
// rest.
#include "solve/event/event.h"

#include <math.h>
#include <string.h>

void pl_watch_friction_make(pl_run* run) {
  pl_arena* a = run->job->arena;
  size_t n = (size_t)run->setup->n_frictions, orders = (size_t)run->order + 2;
  run->event->friction_before = PL_ARRAY(a, pl_friction_state, n + 1);
  run->event->friction_fixed = PL_ARRAY(a, unsigned, n + 1);
  run->event->S_series = PL_ARRAY(a, double, n > 0 ? (size_t)run->n_c * orders + 1 : 1);
  run->event->poly_2 = PL_ARRAY(a, double, 3 * orders + 1);
}

// In space a slip that ends at the end of this step has no direction there: it keeps the one it
// had.
void pl_watch_friction_directions(pl_run* run) {
  for (int i = 0; i < run->event->n_watch; i++) {
    if (!run->event->hit[i] || run->event->watch[i].kind != PL_WATCH_STICK) continue;
    int r = run->event->watch[i].index;
    pl_friction_state* now = &run->dae.friction[r];
    now->given = run->setup->frictions[r].n_rows == 3
                 && pl_friction_speed(&run->dae, r, run->event->S_series, now->d) > 0;
  }
}

// c += f a b for series of n coefficients with their strides.
static void add_product(double* c, double f, const double* a, size_t at_a, const double* b,
                        size_t at_b, int n) {
  for (int k = 0; k < n; k++) {
    double sum = 0;
    for (int j = 0; j <= k; j++) sum += a[(size_t)j * at_a] * b[(size_t)(k - j) * at_b];
    c[k] += f * sum;
  }
}

static void clear(double* c, int n) { memset(c, 0, (size_t)n * sizeof *c); }

// limit² λ² - |F|²
static void force_left(const pl_run* run, const pl_friction_setup* friction, double* c, int n) {
  double *u = run->event->poly_2, *w = u + run->order + 2;
  size_t n_c = (size_t)run->n_c, n_C = (size_t)run->setup->n_coefficients;
  clear(u, n);
  add_product(u, 1, run->dae.C_series + friction->limit, n_C, run->dae.L + friction->constraint,
              n_c, n);
  clear(c, n);
  add_product(c, 1, u, 1, u, 1, n);
  if (friction->n_rows == 1) {
    add_product(c, -1, run->dae.L + friction->row[0], n_c, run->dae.L + friction->row[0], n_c, n);
    return;
  }
  static const int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
  for (int p = 0; p < 6; p++) {
    clear(w, n);
    add_product(w, 1, run->dae.L + friction->row[pair[p][0]], n_c,
                run->dae.L + friction->row[pair[p][1]], n_c, n);
    add_product(c, p < 3 ? -1 : -2, run->dae.C_series + friction->metric[p], n_C, w, 1, n);
  }
}

int pl_watch_friction(const pl_run* run, int r, pl_watch_kind kind, double* c, int n) {
  const pl_friction_setup* friction = &run->setup->frictions[r];
  const pl_friction_state* now = &run->dae.friction[r];
  size_t n_c = (size_t)run->n_c;
  if (kind == PL_WATCH_SLIP) {
    force_left(run, friction, c, n - 1);
    return n - 1;
  }
  if (kind == PL_WATCH_PRESS) {
    for (int k = 0; k < n - 1; k++)
      c[k] = now->press * run->dae.L[(size_t)k * n_c + (size_t)friction->constraint];
    return n - 1;
  }
  if (friction->n_rows == 1) {
    for (int k = 0; k < n; k++)
      c[k] = now->way * run->event->S_series[(size_t)k * n_c + (size_t)friction->row[0]];
    return n;
  }
  clear(c, n);
  for (int i = 0; i < 3; i++)
    add_product(c, 1, run->event->S_series + friction->row[i], n_c,
                run->event->S_series + friction->row[i], n_c, n);
  c[0] -= now->small * now->small;
  return n;
}
