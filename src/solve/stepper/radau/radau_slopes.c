// The implicit method: derivatives of F and C at a point (radau_impl.h).
//
// The directions of a model outside of families run side by side in the lanes of one jet:
// derivatives are the coefficients of order 1 of series that begin in such a direction at fixed
// time.
#include <math.h>
#include <string.h>

#include "solve/stepper/radau/radau_impl.h"

enum { WIDE = 8 };

static int node_of(const pl_batch* b, const pl_pattern_entry* e) {
  return b->pattern->tape->roots[e->root];
}
static bool is_constant(const pl_batch* b, int node) {
  return node < b->pattern->tape->level_end[PL_LEVEL_CONST];
}

static void set_lanes(pl_jet* jet, int node, int k, double x) {
  for (int l = 0; l < jet->lanes && node >= 0; l++) pl_jet_at(jet, node, k)[l] = x;
}

#define VALUE(e)     pl_jet_at(w->jet, node_of(b, e), 0)[lane]
#define SLOPE(e)     (is_constant(b, node_of(b, e)) ? 0 : pl_jet_at(w->jet, node_of(b, e), 1)[lane])
#define Q_OF(slot)   q[(slot)*b->lanes]
#define C_OF(slot)   c[(slot)*b->lanes]
#define AT(row, col) pl_radau_place(&r->shape, row, col)

// Where derivatives are taken, and where they go.
typedef struct point {
  const pl_run* run;
  pl_radau* r;
  pl_radau_slopes* J;
  const double *v, *a, *lambda;
} point;

// Values at the point: M, G, G^T + W, coefficients.
static void add_values(const point* at, const pl_radau_lanes* w, int lane) {
  const pl_run* run = at->run;
  pl_radau* r = at->r;
  const pl_batch* b = w->batch;
  const pl_pattern* p = b->pattern;
  const int *q = b->q + lane, *c = b->c + lane, *out = b->out + lane;
  double *P0 = at->J->P0, *P1 = at->J->P1;
  for (const pl_pattern_entry* e = p->mass; e < p->mass + p->n_mass; e++) {
    P0[AT(Q_OF(e->row), Q_OF(e->col))] += VALUE(e);
    if (e->row != e->col) P0[AT(Q_OF(e->col), Q_OF(e->row))] += VALUE(e);
  }
  for (const pl_pattern_entry* e = p->G; e < p->G + p->n_G; e++) {
    int i = C_OF(e->row), j = Q_OF(e->col);
    if (run->dae.taken[i]) P1[AT(r->n_q + i, j)] += VALUE(e);
    if (pl_radau_has_force(run, i)) P1[AT(j, r->n_q + i)] -= VALUE(e);
  }
  for (const pl_pattern_entry* e = p->W; e < p->W + p->n_W; e++)
    if (run->dae.taken[C_OF(e->col)]) P1[AT(Q_OF(e->row), r->n_q + C_OF(e->col))] -= VALUE(e);
  for (const pl_pattern_entry* e = p->outputs; e < p->outputs + p->n_out && run->dae.n_slipping > 0;
       e++)
    r->part[out[e->row * b->lanes]] += VALUE(e);
}

// Slip: m - κ λ by m and λ.
static void add_slip(const point* at) {
  const pl_run* run = at->run;
  pl_radau* r = at->r;
  for (int k = 0; k < run->setup->n_frictions; k++) {
    const pl_friction_setup* friction = &run->setup->frictions[k];
    for (int i = 0; i < friction->n_rows && run->dae.friction[k].state == PL_FRICTION_SLIP; i++) {
      int row = r->n_q + friction->row[i];
      at->J->P1[AT(row, row)] += 1;
      at->J->P1[AT(row, r->n_q + friction->constraint)] -= pl_friction_kappa(&run->dae, k, i,
                                                                             r->part);
    }
  }
}

// The same by what the coefficient with this index depends on.
static void add_slip_slope(const point* at, double* P, int coefficient, double slope, int col) {
  pl_radau* r = at->r;
  int k = r->friction_of[coefficient];
  const pl_friction_setup* friction = &at->run->setup->frictions[k];
  if (at->run->dae.friction[k].state != PL_FRICTION_SLIP || slope == 0) return;
  for (int i = 0; i < friction->n_rows; i++)
    P[AT(r->n_q + friction->row[i], col)] -=
        slope * pl_friction_kappa_by(&at->run->dae, k, i, coefficient)
        * at->lambda[friction->constraint];
}

// Derivatives along global coordinate `col` (of position, or of velocity): coefficient 1 in a lane.
static void add_derivatives(const point* at, const pl_radau_lanes* w, int lane, int instance,
                            int col, bool of_speed) {
  const pl_run* run = at->run;
  pl_radau* r = at->r;
  const pl_batch* b = w->batch;
  const pl_pattern* p = b->pattern;
  const int *q = b->q + instance, *c = b->c + instance, *out = b->out + instance;
  const double *v = at->v, *a = at->a, *lambda = at->lambda;
  double* P = of_speed ? at->J->P1 : at->J->P2;
  for (const pl_pattern_entry* e = p->mass; e < p->mass + p->n_mass; e++) {
    double x = SLOPE(e);
    if (x == 0) continue;
    P[AT(Q_OF(e->row), col)] += x * a[Q_OF(e->col)];
    if (e->row != e->col) P[AT(Q_OF(e->col), col)] += x * a[Q_OF(e->row)];
  }
  for (const pl_pattern_entry* e = p->h; e < p->h + p->n_h; e++) {
    double x = SLOPE(e);
    if (x != 0) P[AT(Q_OF(e->row), col)] += x;
  }
  for (const pl_pattern_entry* e = p->W; e < p->W + p->n_W; e++) {
    double x = SLOPE(e);
    if (x != 0 && run->dae.taken[C_OF(e->col)])
      P[AT(Q_OF(e->row), col)] -= x * lambda[C_OF(e->col)];
  }
  for (const pl_pattern_entry* e = p->outputs; e < p->outputs + p->n_out && run->dae.n_slipping > 0;
       e++)
    add_slip_slope(at, P, out[e->row * b->lanes], SLOPE(e), col);
  if (of_speed) return;
  for (const pl_pattern_entry* e = p->G; e < p->G + p->n_G; e++) {
    int row = C_OF(e->row);
    double x = SLOPE(e);
    if (x == 0 || !pl_radau_has_force(run, row)) continue;
    P[AT(Q_OF(e->col), col)] -= x * lambda[row];
    if (run->dae.taken[row]) P[AT(r->n_q + row, col)] += x * v[Q_OF(e->col)];
  }
  for (const pl_pattern_entry* e = p->gt; e < p->gt + p->n_gt; e++) {
    double x = SLOPE(e);
    if (x != 0 && run->dae.taken[C_OF(e->row)]) P[AT(r->n_q + C_OF(e->row), col)] += x;
  }
}

// Series that stand still: order 1 of everything zero, time too.
static void stand_still(pl_jet* jet) {
  const pl_tape* tape = jet->tape;
  for (int s = 0; s < tape->n_q; s++) {
    set_lanes(jet, tape->q_node[s], 1, 0);
    set_lanes(jet, tape->v_node[s], 1, 0);
  }
  for (int k = tape->level_end[PL_LEVEL_CONST]; k < tape->level_end[PL_LEVEL_POSITION]; k++)
    if (tape->nodes[k].op == PL_OP_TIME) set_lanes(jet, k, 1, 0);
}

// Direction d of a pattern: slot d of the positions, or slot d - n_q of the velocities.
static int direction_node(const pl_tape* tape, int n_q, int d) {
  return d < n_q ? tape->q_node[d] : tape->v_node[d - n_q];
}

static void slopes_by_directions(const point* at, const pl_radau_lanes* w) {
  const pl_batch* b = w->batch;
  int n_q = b->pattern->n_q;
  stand_still(w->jet);
  for (int first = 0; first < 2 * n_q; first += WIDE) {
    int n = 2 * n_q - first < WIDE ? 2 * n_q - first : WIDE;
    for (int l = 0; l < n; l++) {
      int node = direction_node(w->jet->tape, n_q, first + l);
      if (node >= 0) pl_jet_at(w->jet, node, 1)[l] = 1;
    }
    pl_radau_sweep(w->jet, 1);
    for (int l = 0; l < n; l++) {
      int d = first + l, node = direction_node(w->jet->tape, n_q, d);
      if (node < 0) continue;
      add_derivatives(at, w, l, 0, b->q[d % n_q], d >= n_q);
      pl_jet_at(w->jet, node, 1)[l] = 0;
    }
  }
}

static void slopes_by_instances(const point* at, const pl_radau_lanes* w) {
  const pl_batch* b = w->batch;
  int n_q = b->pattern->n_q;
  stand_still(w->jet);
  for (int d = 0; d < 2 * n_q; d++) {
    int node = direction_node(w->jet->tape, n_q, d);
    if (node < 0) continue;
    set_lanes(w->jet, node, 1, 1);
    pl_radau_sweep(w->jet, 1);
    for (int l = 0; l < b->n; l++)
      add_derivatives(at, w, l, l, b->q[(d % n_q) * b->lanes + l], d >= n_q);
    set_lanes(w->jet, node, 1, 0);
  }
}

void pl_radau_slopes_at(pl_run* run, pl_radau* r, pl_radau_slopes* J, double t, const double* q,
                        const double* v, const double* a, const double* lambda) {
  double* all[] = {J->P0, J->P1, J->P2};
  for (size_t i = 0; i < 3; i++) memset(all[i], 0, (size_t)r->shape.n_values * sizeof(double));
  memset(r->part, 0, (size_t)r->n_C * sizeof(double));
  const point at = {run, r, J, v, a, lambda};
  for (int i = 0; i < run->dae.motion.n; i++) {
    const pl_radau_lanes* w = &r->lanes[i];
    pl_radau_load_instances(w, t, q, v);
    for (int l = 0; l < w->batch->n; l++) add_values(&at, w, l);
    if (w->batch->lanes > 1) slopes_by_instances(&at, w);
    else slopes_by_directions(&at, w);
  }
  if (run->dae.n_slipping > 0) add_slip(&at);
}
