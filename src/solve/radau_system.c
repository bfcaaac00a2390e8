// The linear systems of the implicit method: residuals at the stages, slopes along directions, factors.
//
//   F(q, v, a, λ) = M(q) a + h(q, v, t) - (G^T + W) λ,      C(q, v) = G v + dg/dt
//
// The stages of a model outside of families run side by side in the lanes of one jet; so do the directions of its
// derivatives, which are the coefficients of order 1 of series that begin in such a direction at fixed time.  With
// Q_i = q + h (c_i v + sum_j a_ij z_j), V_i = v + z_i and A_i = sum_j (A^-1)_ij z_j / h, the simplified Newton matrix
//
//   A^-1/h ⊗ M + I ⊗ D + h A ⊗ K     -I ⊗ (G^T + W)
//   I ⊗ G + h A ⊗ S                   0
//
// splits along the eigenvectors of A^-1 into one real and some complex systems of the size of M and G together.
#include <math.h>
#include <string.h>

#include "solve/radau_impl.h"

enum { WIDE = 8 };

// ---------------------------------------------------------------------------------------------- room
static void reserve_wide(pl_run* run, pl_radau* r) {
  pl_arena* a = run->job->arena;
  r->wide = PL_ARRAY(a, pl_radau_wide, run->motion.n + 1);
  for (int i = 0; i < run->motion.n; i++) {
    const pl_batch* b = &run->motion.at[i];
    r->wide[i] = (pl_radau_wide){b, b->jet};
    if (b->lanes > 1) continue;
    const pl_pattern* p = b->pattern;
    double* index = PL_ARRAY(a, double, (size_t)p->n_index* WIDE + 1);
    r->wide[i].jet = pl_jet_make(a, p->tape, WIDE, 2);
    // the indices of a single instance, the same in all lanes
    for (int k = 0; k < p->tape->level_end[PL_LEVEL_CONST]; k++) {
      const pl_tape_node* node = &p->tape->nodes[k];
      if (node->op != PL_OP_INDEX) continue;
      for (int l = 0; l < WIDE; l++) index[node->slot * WIDE + l] = pl_jet_at(b->jet, k, 0)[0];
    }
    pl_jet_constants(r->wide[i].jet, index);
  }
}

static void reserve_slopes(pl_arena* a, pl_radau_slopes* J, size_t q, size_t c) {
  double** square[] = {&J->M, &J->D, &J->K};
  double** mixed[] = {&J->G, &J->S, &J->B};
  for (size_t i = 0; i < 3; i++) *square[i] = PL_ARRAY(a, double, q* q + 1);
  for (size_t i = 0; i < 3; i++) *mixed[i] = PL_ARRAY(a, double, q* c + 1);
}

static void reserve_coupled(pl_arena* a, pl_radau* r) {
  size_t n = (size_t)r->n * (size_t)r->method.s;
  if (n > PL_RADAU_COUPLED_UP_TO) return;
  for (int i = 0; i < r->method.s; i++) reserve_slopes(a, &r->at[i], (size_t)r->n_q, (size_t)r->n_c);
  r->coupled = PL_ARRAY(a, double, n* n + 1);
  r->coupled_scale = PL_ARRAY(a, double, n + 1);
  r->coupled_rhs = PL_ARRAY(a, double, n + 1);
  r->coupled_work = PL_ARRAY(a, double, n + 1);
  r->coupled_pivot = PL_ARRAY(a, int, n + 1);
}

pl_radau* pl_radau_reserve(pl_run* run, int s) {
  pl_arena* a = run->job->arena;
  pl_radau* r = PL_NEW(a, pl_radau);
  size_t q = (size_t)run->n_q, c = (size_t)run->n_c, n = q + c, stages = PL_RADAU_MOST;
  r->method.s = s;
  r->method.n_pairs = s / 2;
  r->n_q = run->n_q;
  r->n_c = run->n_c;
  r->n = (int)n;
  reserve_wide(run, r);
  reserve_slopes(a, &r->here, q, c);
  reserve_coupled(a, r);
  double** of_stages[] = {&r->Z, &r->Q, &r->V, &r->A};
  double** of_q[] = {&r->error_q, &r->error_v, &r->sc_q, &r->sc_v};
  for (size_t i = 0; i < 4; i++) *of_stages[i] = PL_ARRAY(a, double, q* stages + 1);
  for (size_t i = 0; i < 4; i++) *of_q[i] = PL_ARRAY(a, double, q + 1);
  r->L = PL_ARRAY(a, double, c* stages + 1);
  r->t = PL_ARRAY(a, double, stages);
  r->F = PL_ARRAY(a, double, n* stages + 1);
  r->rhs = PL_ARRAY(a, double, n + 1);
  r->work = PL_ARRAY(a, double, n + 1);
  r->real = PL_ARRAY(a, double, n* n + 1);
  r->real_scale = PL_ARRAY(a, double, n + 1);
  for (int k = 0; k < r->method.n_pairs; k++) {
    r->pair[k] = PL_ARRAY(a, double, 2 * n * n + 1);
    r->pair_scale[k] = PL_ARRAY(a, double, n + 1);
  }
  for (int k = 0; k <= r->method.n_pairs; k++) {
    r->pivot[k] = PL_ARRAY(a, int, n + 1);
    r->w[k] = PL_ARRAY(a, double, 2 * n + 1);
  }
  return r;
}

void pl_radau_ready(pl_radau* r) {
  if (r->ready) return;
  pl_radau_method_make(&r->method, r->method.s);
  r->ready = true;
}

// ---------------------------------------------------------------------------------------------- reading the jets
static int node_of(const pl_batch* b, const pl_pattern_entry* e) { return b->pattern->tape->roots[e->root]; }
static bool is_constant(const pl_batch* b, int node) { return node < b->pattern->tape->level_end[PL_LEVEL_CONST]; }

static void set_lanes(pl_jet* jet, int node, int k, double x) {
  for (int l = 0; l < jet->lanes && node >= 0; l++) pl_jet_at(jet, node, k)[l] = x;
}

static void sweep(pl_jet* jet, int k) {
  jet->kernel(jet, PL_LEVEL_PLACE, k, k == 0);
  jet->kernel(jet, PL_LEVEL_SPEED, k, k == 0);
}

// ---------------------------------------------------------------------------------------------- residuals
// Adds what the instance in a lane contributes to the residual F (n_q), C (n_c) of one stage.
static void add_residual(const pl_run* run, const pl_radau_wide* w, int lane, int instance, const double* v,
                         const double* a, const double* lambda, double* F, double* C) {
  const pl_batch* b = w->batch;
  const pl_pattern* p = b->pattern;
  const int *q = b->q + instance, *c = b->c + instance;
#define VALUE(e) pl_jet_at(w->jet, node_of(b, e), 0)[lane]
#define Q_OF(slot) q[(slot)*b->lanes]
#define C_OF(slot) c[(slot)*b->lanes]
  for (const pl_pattern_entry* e = p->mass; e < p->mass + p->n_mass; e++) {
    double x = VALUE(e);
    F[Q_OF(e->row)] += x * a[Q_OF(e->col)];
    if (e->row != e->col) F[Q_OF(e->col)] += x * a[Q_OF(e->row)];
  }
  for (const pl_pattern_entry* e = p->h; e < p->h + p->n_h; e++) F[Q_OF(e->row)] += VALUE(e);
  for (const pl_pattern_entry* e = p->G; e < p->G + p->n_G; e++) {
    if (!run->taken[C_OF(e->row)]) continue;
    double x = VALUE(e);
    F[Q_OF(e->col)] -= x * lambda[C_OF(e->row)];
    C[C_OF(e->row)] += x * v[Q_OF(e->col)];
  }
  for (const pl_pattern_entry* e = p->W; e < p->W + p->n_W; e++)
    if (run->taken[C_OF(e->col)]) F[Q_OF(e->row)] -= VALUE(e) * lambda[C_OF(e->col)];
  for (const pl_pattern_entry* e = p->gt; e < p->gt + p->n_gt; e++)
    if (run->taken[C_OF(e->row)]) C[C_OF(e->row)] += VALUE(e);
}

static double* stage(double* x, int i, int n) { return x + (size_t)i * (size_t)n; }

// All stages of a single instance in one sweep.
static void residual_by_stages(const pl_run* run, pl_radau* r, const pl_radau_wide* w) {
  const pl_tape* tape = w->jet->tape;
  const pl_batch* b = w->batch;
  int s = r->method.s;
  for (int slot = 0; slot < b->pattern->n_q; slot++) {
    for (int l = 0; l < WIDE; l++) {
      int i = l < s ? l : s - 1;
      if (tape->q_node[slot] >= 0) pl_jet_at(w->jet, tape->q_node[slot], 0)[l] = stage(r->Q, i, r->n_q)[b->q[slot]];
      if (tape->v_node[slot] >= 0) pl_jet_at(w->jet, tape->v_node[slot], 0)[l] = stage(r->V, i, r->n_q)[b->q[slot]];
    }
  }
  for (int k = tape->level_end[PL_LEVEL_CONST]; k < tape->level_end[PL_LEVEL_PLACE]; k++)
    for (int l = 0; l < WIDE && tape->nodes[k].op == PL_OP_TIME; l++)
      pl_jet_at(w->jet, k, 0)[l] = r->t[l < s ? l : s - 1];
  sweep(w->jet, 0);
  for (int i = 0; i < s; i++)
    add_residual(run, w, i, 0, stage(r->V, i, r->n_q), stage(r->A, i, r->n_q), stage(r->L, i, r->n_c),
                 stage(r->F, i, r->n), stage(r->F, i, r->n) + r->n_q);
}

static void load_instances(const pl_radau_wide* w, double t, const double* q, const double* v) {
  const pl_tape* tape = w->jet->tape;
  const pl_batch* b = w->batch;
  pl_jet_time(w->jet, t);
  for (int slot = 0; slot < b->pattern->n_q; slot++) {
    for (int l = 0; l < w->jet->lanes; l++) {
      int i = b->q[slot * b->lanes + (b->lanes > 1 ? l : 0)];
      if (tape->q_node[slot] >= 0) pl_jet_at(w->jet, tape->q_node[slot], 0)[l] = q[i];
      if (tape->v_node[slot] >= 0) pl_jet_at(w->jet, tape->v_node[slot], 0)[l] = v[i];
    }
  }
  sweep(w->jet, 0);
}

static void residual_by_instances(const pl_run* run, pl_radau* r, const pl_radau_wide* w) {
  for (int i = 0; i < r->method.s; i++) {
    load_instances(w, r->t[i], stage(r->Q, i, r->n_q), stage(r->V, i, r->n_q));
    for (int l = 0; l < w->batch->n; l++)
      add_residual(run, w, l, l, stage(r->V, i, r->n_q), stage(r->A, i, r->n_q), stage(r->L, i, r->n_c),
                   stage(r->F, i, r->n), stage(r->F, i, r->n) + r->n_q);
  }
}

void pl_radau_residual(pl_run* run, pl_radau* r) {
  memset(r->F, 0, (size_t)r->n * (size_t)r->method.s * sizeof *r->F);
  for (int i = 0; i < run->motion.n; i++) {
    const pl_radau_wide* w = &r->wide[i];
    if (w->batch->lanes > 1) residual_by_instances(run, r, w);
    else residual_by_stages(run, r, w);
  }
  for (int i = 0; i < r->method.s; i++)
    for (int k = 0; k < run->n_q; k++)
      if (run->place_n[k] == 0) stage(r->F, i, r->n)[k] = 0;
}

// ---------------------------------------------------------------------------------------------- Jacobian
// Values at the point: M, G, G^T + W.
static void add_values(const pl_run* run, pl_radau_slopes* J, const pl_radau_wide* w, int lane, int instance) {
  const pl_batch* b = w->batch;
  const pl_pattern* p = b->pattern;
  const int *q = b->q + instance, *c = b->c + instance;
  size_t n_q = (size_t)run->n_q, n_c = (size_t)run->n_c;
  for (const pl_pattern_entry* e = p->mass; e < p->mass + p->n_mass; e++) {
    size_t i = (size_t)Q_OF(e->row), j = (size_t)Q_OF(e->col);
    J->M[i + j * n_q] += VALUE(e);
    if (e->row != e->col) J->M[j + i * n_q] += VALUE(e);
  }
  for (const pl_pattern_entry* e = p->G; e < p->G + p->n_G; e++) {
    size_t i = (size_t)C_OF(e->row), j = (size_t)Q_OF(e->col);
    if (!run->taken[i]) continue;
    J->G[i + j * n_c] += VALUE(e);
    J->B[j + i * n_q] += VALUE(e);
  }
  for (const pl_pattern_entry* e = p->W; e < p->W + p->n_W; e++)
    if (run->taken[C_OF(e->col)]) J->B[(size_t)Q_OF(e->row) + (size_t)C_OF(e->col) * n_q] += VALUE(e);
}

// Where derivatives are taken, and where they go.
typedef struct point {
  pl_radau_slopes* J;
  const double *v, *a, *lambda;
} point;

// Derivatives along global coordinate `col` (of position, or of velocity): coefficient 1 in a lane.
static void add_derivatives(const pl_run* run, const point* at, const pl_radau_wide* w, int lane, int instance, int col,
                            bool of_speed) {
  const pl_batch* b = w->batch;
  const pl_pattern* p = b->pattern;
  const int *q = b->q + instance, *c = b->c + instance;
  const double *v = at->v, *a = at->a, *lambda = at->lambda;
  double* F = (of_speed ? at->J->D : at->J->K) + (size_t)col * (size_t)run->n_q;
  double* C = at->J->S + (size_t)col * (size_t)run->n_c;
#define SLOPE(e) (is_constant(b, node_of(b, e)) ? 0 : pl_jet_at(w->jet, node_of(b, e), 1)[lane])
  for (const pl_pattern_entry* e = p->mass; e < p->mass + p->n_mass; e++) {
    double x = SLOPE(e);
    F[Q_OF(e->row)] += x * a[Q_OF(e->col)];
    if (e->row != e->col) F[Q_OF(e->col)] += x * a[Q_OF(e->row)];
  }
  for (const pl_pattern_entry* e = p->h; e < p->h + p->n_h; e++) F[Q_OF(e->row)] += SLOPE(e);
  for (const pl_pattern_entry* e = p->W; e < p->W + p->n_W; e++)
    if (run->taken[C_OF(e->col)]) F[Q_OF(e->row)] -= SLOPE(e) * lambda[C_OF(e->col)];
  if (of_speed) return;
  for (const pl_pattern_entry* e = p->G; e < p->G + p->n_G; e++) {
    if (!run->taken[C_OF(e->row)]) continue;
    double x = SLOPE(e);
    F[Q_OF(e->col)] -= x * lambda[C_OF(e->row)];
    C[C_OF(e->row)] += x * v[Q_OF(e->col)];
  }
  for (const pl_pattern_entry* e = p->gt; e < p->gt + p->n_gt; e++)
    if (run->taken[C_OF(e->row)]) C[C_OF(e->row)] += SLOPE(e);
}

// Series that stand still: order 1 of everything zero, time too.
static void stand_still(pl_jet* jet) {
  const pl_tape* tape = jet->tape;
  for (int s = 0; s < tape->n_q; s++) {
    set_lanes(jet, tape->q_node[s], 1, 0);
    set_lanes(jet, tape->v_node[s], 1, 0);
  }
  for (int k = tape->level_end[PL_LEVEL_CONST]; k < tape->level_end[PL_LEVEL_PLACE]; k++)
    if (tape->nodes[k].op == PL_OP_TIME) set_lanes(jet, k, 1, 0);
}

// Direction d of a pattern: slot d of the positions, or slot d - n_q of the velocities.
static int direction_node(const pl_tape* tape, int n_q, int d) {
  return d < n_q ? tape->q_node[d] : tape->v_node[d - n_q];
}

static void slopes_by_directions(const pl_run* run, const point* at, const pl_radau_wide* w) {
  const pl_batch* b = w->batch;
  int n_q = b->pattern->n_q;
  stand_still(w->jet);
  for (int first = 0; first < 2 * n_q; first += WIDE) {
    int n = 2 * n_q - first < WIDE ? 2 * n_q - first : WIDE;
    for (int l = 0; l < n; l++) {
      int node = direction_node(w->jet->tape, n_q, first + l);
      if (node >= 0) pl_jet_at(w->jet, node, 1)[l] = 1;
    }
    sweep(w->jet, 1);
    for (int l = 0; l < n; l++) {
      int d = first + l, node = direction_node(w->jet->tape, n_q, d);
      if (node < 0) continue;
      add_derivatives(run, at, w, l, 0, b->q[d % n_q], d >= n_q);
      pl_jet_at(w->jet, node, 1)[l] = 0;
    }
  }
}

static void slopes_by_instances(const pl_run* run, const point* at, const pl_radau_wide* w) {
  const pl_batch* b = w->batch;
  int n_q = b->pattern->n_q;
  stand_still(w->jet);
  for (int d = 0; d < 2 * n_q; d++) {
    int node = direction_node(w->jet->tape, n_q, d);
    if (node < 0) continue;
    set_lanes(w->jet, node, 1, 1);
    sweep(w->jet, 1);
    for (int l = 0; l < b->n; l++) add_derivatives(run, at, w, l, l, b->q[(d % n_q) * b->lanes + l], d >= n_q);
    set_lanes(w->jet, node, 1, 0);
  }
}

void pl_radau_slopes_at(pl_run* run, pl_radau* r, pl_radau_slopes* J, double t, const double* q, const double* v,
                        const double* a, const double* lambda) {
  size_t n_q = (size_t)r->n_q, n_c = (size_t)r->n_c;
  double* square[] = {J->M, J->D, J->K};
  double* mixed[] = {J->G, J->S, J->B};
  for (size_t i = 0; i < 3; i++) memset(square[i], 0, n_q * n_q * sizeof(double));
  for (size_t i = 0; i < 3; i++) memset(mixed[i], 0, n_q * n_c * sizeof(double));
  const point at = {J, v, a, lambda};
  for (int i = 0; i < run->motion.n; i++) {
    const pl_radau_wide* w = &r->wide[i];
    load_instances(w, t, q, v);
    for (int l = 0; l < w->batch->n; l++) add_values(run, J, w, l, l);
    if (w->batch->lanes > 1) slopes_by_instances(run, &at, w);
    else slopes_by_directions(run, &at, w);
  }
}

// ---------------------------------------------------------------------------------------------- factors
// Rows of what is not used hold 1 on the diagonal.
static bool rests(const pl_run* run, int i) { return i < run->n_q ? run->place_n[i] == 0 : !run->taken[i - run->n_q]; }

// N = [γ M + D + K/γ, -B; G + S/γ, 0] for γ = re + i im: entry (row, col), re and im.
static void entry(const pl_radau* r, int row, int col, const double* g, const double* g_inverse, double* z) {
  int n_q = r->n_q;
  const pl_radau_slopes* J = &r->here;
  z[0] = z[1] = 0;
  if (row < n_q && col < n_q) {
    size_t at = (size_t)row + (size_t)col * (size_t)n_q;
    z[0] = g[0] * J->M[at] + J->D[at] + g_inverse[0] * J->K[at];
    z[1] = g[1] * J->M[at] + g_inverse[1] * J->K[at];
  } else if (row < n_q) {
    z[0] = -J->B[(size_t)row + (size_t)(col - n_q) * (size_t)n_q];
  } else if (col < n_q) {
    size_t at = (size_t)(row - n_q) + (size_t)col * (size_t)r->n_c;
    z[0] = J->G[at] + g_inverse[0] * J->S[at];
    z[1] = g_inverse[1] * J->S[at];
  }
}

static void fill(const pl_radau* r, const pl_run* run, int k, double h, double* N) {
  double g[2] = {r->method.gamma[k][0] / h, r->method.gamma[k][1] / h}, norm = g[0] * g[0] + g[1] * g[1];
  double g_inverse[2] = {g[0] / norm, -g[1] / norm}, z[2];
  size_t parts = k > 0 ? 2 : 1;
  for (int col = 0; col < r->n; col++) {
    for (int row = 0; row < r->n; row++) {
      entry(r, row, col, g, g_inverse, z);
      if (rests(run, row) || rests(run, col)) z[0] = row == col, z[1] = 0;
      size_t at = ((size_t)row + (size_t)col * (size_t)r->n) * parts;
      for (size_t p = 0; p < parts; p++) N[at + p] = z[p];
    }
  }
}

bool pl_radau_factor(pl_radau* r, const pl_run* run, double h) {
  if (r->has_factor && r->h_factored == h) return true;
  r->has_factor = false;
  fill(r, run, 0, h, r->real);
  if (!(pl_lu_factor(r->real, r->pivot[0], r->real_scale, r->n) > 0)) return false;
  for (int k = 0; k < r->method.n_pairs; k++) {
    fill(r, run, k + 1, h, r->pair[k]);
    if (!(pl_zlu_factor(r->pair[k], r->pivot[k + 1], r->pair_scale[k], r->n) > 0)) return false;
  }
  r->h_factored = h;
  return r->has_factor = true;
}

void pl_radau_solve_real(pl_radau* r, double* b) { pl_lu_solve(r->real, r->pivot[0], r->real_scale, b, r->work, r->n); }

// ---------------------------------------------------------------------------------------------- one correction
// Adds the correction in F to the increments of v and to λ, stage by stage.
static void apply(pl_radau* r) {
  for (int i = 0; i < r->method.s; i++) {
    const double* d = stage(r->F, i, r->n);
    for (int e = 0; e < r->n_q; e++) stage(r->Z, i, r->n_q)[e] += d[e];
    for (int e = 0; e < r->n_c; e++) stage(r->L, i, r->n_c)[e] += d[r->n_q + e];
  }
}

// w = X^-1 (-F), component k: re (and im) of each entry
static void transform(const pl_radau* r, const pl_run* run, int k) {
  int parts = k > 0 ? 2 : 1;
  double* w = r->w[k];
  for (int e = 0; e < r->n; e++) {
    for (int p = 0; p < parts; p++) {
      double sum = 0;
      for (int i = 0; i < r->method.s; i++) sum -= r->method.Y[k][i][p] * r->F[(size_t)i * (size_t)r->n + (size_t)e];
      w[e * parts + p] = rests(run, e) ? 0 : sum;
    }
  }
}

void pl_radau_correct(pl_radau* r, const pl_run* run) {
  for (int k = 0; k <= r->method.n_pairs; k++) {
    transform(r, run, k);
    if (k == 0) pl_radau_solve_real(r, r->w[0]);
    else pl_zlu_solve(r->pair[k - 1], r->pivot[k], r->pair_scale[k - 1], r->w[k], r->n);
  }
  // F becomes the correction
  for (int i = 0; i < r->method.s; i++) {
    double* d = stage(r->F, i, r->n);
    for (int e = 0; e < r->n; e++) {
      d[e] = r->method.X[0][i][0] * r->w[0][e];
      for (int k = 1; k <= r->method.n_pairs; k++)
        d[e] += 2 * (r->method.X[k][i][0] * r->w[k][2 * e] - r->method.X[k][i][1] * r->w[k][2 * e + 1]);
    }
  }
  apply(r);
}

// ---------------------------------------------------------------------------------------------- all stages coupled
// Block (i, j) of the matrix of all stages with slopes of their own.
static void fill_block(const pl_radau* r, const pl_run* run, int i, int j, double h) {
  const pl_radau_slopes* J = &r->at[i];
  double turn = r->method.inverse[i][j] / h, way = r->method.A[i][j] * h, same = i == j;
  size_t n = (size_t)r->n, n_q = (size_t)r->n_q, n_c = (size_t)r->n_c, rows = n * (size_t)r->method.s;
  for (size_t col = 0; col < n; col++) {
    double* to = r->coupled + ((size_t)j * n + col) * rows + (size_t)i * n;
    for (size_t row = 0; row < n; row++) {
      double x = 0;
      if (rests(run, (int)row) || rests(run, (int)col)) x = i == j && row == col;
      else if (row < n_q && col < n_q)
        x = turn * J->M[row + col * n_q] + same * J->D[row + col * n_q] + way * J->K[row + col * n_q];
      else if (row < n_q) x = -same * J->B[row + (col - n_q) * n_q];
      else if (col < n_q) x = same * J->G[row - n_q + col * n_c] + way * J->S[row - n_q + col * n_c];
      to[row] = x;
    }
  }
}

bool pl_radau_couple(pl_run* run, pl_radau* r, double h) {
  int s = r->method.s;
  for (int i = 0; i < s; i++)
    pl_radau_slopes_at(run, r, &r->at[i], r->t[i], stage(r->Q, i, r->n_q), stage(r->V, i, r->n_q),
                       stage(r->A, i, r->n_q), stage(r->L, i, r->n_c));
  for (int i = 0; i < s; i++)
    for (int j = 0; j < s; j++) fill_block(r, run, i, j, h);
  return pl_lu_factor(r->coupled, r->coupled_pivot, r->coupled_scale, s * r->n) > 0;
}

void pl_radau_correct_coupled(pl_radau* r, const pl_run* run) {
  int s = r->method.s;
  for (int i = 0; i < s; i++)
    for (int e = 0; e < r->n; e++) stage(r->F, i, r->n)[e] *= rests(run, e) ? 0 : -1;
  pl_lu_solve(r->coupled, r->coupled_pivot, r->coupled_scale, r->F, r->coupled_work, s * r->n);
  apply(r);
}
