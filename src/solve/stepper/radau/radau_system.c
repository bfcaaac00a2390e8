// The implicit method: room, and the residuals at the stages.
//
//   F(q, v, a, λ) = M(q) a + h(q, v, t) - (G^T + W) λ,      C(q, v) = G v + dg/dt
//
// and, where surfaces slip, C = m - κ(q, v) λ for the multiplier m of a slip and λ of what presses
// (friction.c). The stages of a model outside of families run side by side in the lanes of one jet;
// with Q_i = q + h (c_i v + sum_j a_ij z_j), V_i = v + z_i and A_i = sum_j (A^-1)_ij z_j / h.
#include <math.h>
#include <string.h>

#include "solve/stepper/radau/radau_impl.h"

enum { WIDE = 8 };

// -------------------------------------------------------------------------------------------- room
static void reserve_extended(pl_run* run, pl_radau* r) {
  pl_arena* a = run->job->arena;
  r->lanes = PL_ARRAY(a, pl_radau_lanes, run->dae.motion.n + 1);
  for (int i = 0; i < run->dae.motion.n; i++) {
    const pl_batch* b = &run->dae.motion.at[i];
    r->lanes[i] = (pl_radau_lanes){b, b->jet};
    if (b->lanes > 1) continue;
    const pl_pattern* p = b->pattern;
    double* index = PL_ARRAY(a, double, (size_t)p->n_index* WIDE + 1);
    r->lanes[i].jet = pl_jet_make(a, p->tape, WIDE, 2);
    // the indices of a single instance, the same in all lanes
    for (int k = 0; k < p->tape->level_end[PL_LEVEL_CONST]; k++) {
      const pl_tape_node* node = &p->tape->nodes[k];
      if (node->op != PL_OP_INDEX) continue;
      for (int l = 0; l < WIDE; l++) index[node->slot * WIDE + l] = pl_jet_at(b->jet, k, 0)[0];
    }
    pl_jet_constants(r->lanes[i].jet, index);
  }
}

static void reserve_slopes(pl_arena* a, pl_radau_slopes* J, int n_values) {
  double** of[] = {&J->P0, &J->P1, &J->P2};
  for (size_t i = 0; i < 3; i++) *of[i] = PL_ARRAY(a, double, n_values + 1);
}

static void reserve_coupled(pl_arena* a, pl_radau* r) {
  size_t n = (size_t)r->n * (size_t)r->method.s;
  if (n > PL_RADAU_COUPLED_UP_TO || r->shape.start) return;
  for (int i = 0; i < r->method.s; i++) reserve_slopes(a, &r->at[i], r->shape.n_values);
  r->coupled = PL_ARRAY(a, double, n* n + 1);
  r->coupled_scale = PL_ARRAY(a, double, n + 1);
  r->coupled_rhs = PL_ARRAY(a, double, n + 1);
  r->coupled_work = PL_ARRAY(a, double, n + 1);
  r->coupled_pivot = PL_ARRAY(a, int, n + 1);
}

// Dense factors, or the analysis of the sparse ones.
static bool reserve_factors(pl_arena* a, pl_radau* r) {
  size_t n = (size_t)r->n, values = (size_t)r->shape.n_values;
  r->real = PL_ARRAY(a, double, values + 1);
  r->work = PL_ARRAY(a, double, n + 1);
  r->real_scale = PL_ARRAY(a, double, n + 1);
  for (int k = 0; k < r->method.n_pairs; k++) {
    r->pair[k] = PL_ARRAY(a, double, 2 * values + 1);
    r->pair_scale[k] = PL_ARRAY(a, double, n + 1);
  }
  for (int k = 0; k <= r->method.n_pairs; k++) {
    r->w[k] = PL_ARRAY(a, double, 2 * n + 1);
    r->pivot[k] = PL_ARRAY(a, int, n + 1);
  }
  if (r->shape.start == NULL) return true;
  r->sparse = pl_sparse_make(a, r->n, r->shape.start, r->shape.row);
  bool analysed = r->sparse != NULL;
  for (int k = 0; k < r->method.n_pairs; k++) {
    r->sparse_pair[k] = pl_zsparse_make(a, r->n, r->shape.start, r->shape.row);
    analysed &= r->sparse_pair[k] != NULL;
  }
  return analysed;
}

static void reserve_watches(pl_run* run, pl_radau* r) {
  pl_arena* a = run->job->arena;
  size_t c = (size_t)run->n_c;
  double** of_c[] = {&r->first_g, &r->last_g, &r->last_size, &r->end_l, &r->save_l};
  for (size_t i = 0; i < 5; i++) *of_c[i] = PL_ARRAY(a, double, c + 1);
  r->end_a = PL_ARRAY(a, double, r->n_q + 1);
  r->save_a = PL_ARRAY(a, double, r->n_q + 1);
  r->bent = PL_ARRAY(a, double, (size_t)run->event->n_switches*(PL_RADAU_MOST + 1) + 1);
  r->watched = PL_ARRAY(a, double, (size_t)run->event->n_watch*(PL_RADAU_MOST + 1) + 1);
}

static void reserve_coefficients(pl_run* run, pl_radau* r) {
  pl_arena* a = run->job->arena;
  const pl_setup* s = run->setup;
  r->n_C = s->n_coefficients;
  r->coefficient = PL_ARRAY(a, double, (size_t)r->n_C* PL_RADAU_MOST + 1);
  r->friction_of = PL_ARRAY(a, int, r->n_C + 1);
  r->part = PL_ARRAY(a, double, r->n_C + 1);
  for (int i = 0; i < s->n_frictions; i++) {
    const pl_friction_setup* friction = &s->frictions[i];
    r->friction_of[friction->limit] = r->friction_of[friction->scale] = i;
    for (int k = 0; k < 3 && friction->n_rows == 3; k++) r->friction_of[friction->along[k]] = i;
    for (int k = 0; k < 6 && friction->n_rows == 3; k++) r->friction_of[friction->metric[k]] = i;
  }
}

static bool reserve(pl_run* run, pl_radau* r) {
  pl_arena* a = run->job->arena;
  size_t q = (size_t)run->n_q, c = (size_t)run->n_c, n = q + c, stages = PL_RADAU_MOST;
  r->n_q = run->n_q;
  r->n_c = run->n_c;
  r->n = (int)n;
  pl_radau_shape_make(run, r);
  reserve_extended(run, r);
  reserve_slopes(a, &r->here, r->shape.n_values);
  reserve_coupled(a, r);
  reserve_watches(run, r);
  reserve_coefficients(run, r);
  double** of_stages[] = {&r->Z, &r->Q, &r->V, &r->A};
  double** of_q[] = {&r->error_q, &r->error_v, &r->sc_q, &r->sc_v};
  for (size_t i = 0; i < 4; i++) *of_stages[i] = PL_ARRAY(a, double, q* stages + 1);
  for (size_t i = 0; i < 4; i++) *of_q[i] = PL_ARRAY(a, double, q + 1);
  r->L = PL_ARRAY(a, double, c* stages + 1);
  r->t = PL_ARRAY(a, double, stages);
  r->F = PL_ARRAY(a, double, n* stages + 1);
  r->rhs = PL_ARRAY(a, double, n + 1);
  return reserve_factors(a, r);
}

bool pl_radau_ready(pl_run* run) {
  pl_radau* r = run->radau;
  if (r->ready) return r->fits;
  r->fits = reserve(run, r);
  pl_radau_method_make(&r->method, r->method.s);
  r->ready = true;
  return r->fits;
}

void pl_radau_free(pl_radau* r) {
  if (r == NULL) return;
  pl_sparse_free(r->sparse);
  for (int k = 0; k < PL_RADAU_PAIRS; k++) pl_zsparse_free(r->sparse_pair[k]);
}

// -------------------------------------------------------------------------------- reading the jets
static int node_of(const pl_batch* b, const pl_pattern_entry* e) {
  return b->pattern->tape->roots[e->root];
}

void pl_radau_sweep(pl_jet* jet, int k) {
  jet->kernel(jet, PL_LEVEL_POSITION, k, k == 0);
  jet->kernel(jet, PL_LEVEL_VELOCITY, k, k == 0);
}

// --------------------------------------------------------------------------------------- residuals
// Adds what the instance in a lane contributes to the residual F (n_q), C (n_c) and the
// coefficients of stage i.
static void add_residual(const pl_run* run, pl_radau* r, const pl_radau_lanes* w, int lane,
                         int instance, int i) {
  const double *v = pl_radau_stage(r->V, i, r->n_q), *a = pl_radau_stage(r->A, i, r->n_q),
               *lambda = pl_radau_stage(r->L, i, r->n_c);
  double *F = pl_radau_stage(r->F, i, r->n), *C = F + r->n_q,
         *coefficient = pl_radau_stage(r->coefficient, i, r->n_C);
  const pl_batch* b = w->batch;
  const pl_pattern* p = b->pattern;
  const int *q = b->q + instance, *c = b->c + instance;
#define VALUE(e)   pl_jet_at(w->jet, node_of(b, e), 0)[lane]
#define Q_OF(slot) q[(slot)*b->lanes]
#define C_OF(slot) c[(slot)*b->lanes]
  for (const pl_pattern_entry* e = p->mass; e < p->mass + p->n_mass; e++) {
    double x = VALUE(e);
    F[Q_OF(e->row)] += x * a[Q_OF(e->col)];
    if (e->row != e->col) F[Q_OF(e->col)] += x * a[Q_OF(e->row)];
  }
  for (const pl_pattern_entry* e = p->h; e < p->h + p->n_h; e++) F[Q_OF(e->row)] += VALUE(e);
  for (const pl_pattern_entry* e = p->G; e < p->G + p->n_G; e++) {
    int row = C_OF(e->row);
    if (!pl_radau_has_force(run, row)) continue;
    double x = VALUE(e);
    F[Q_OF(e->col)] -= x * lambda[row];
    if (run->dae.taken[row]) C[row] += x * v[Q_OF(e->col)];
  }
  for (const pl_pattern_entry* e = p->W; e < p->W + p->n_W; e++)
    if (run->dae.taken[C_OF(e->col)]) F[Q_OF(e->row)] -= VALUE(e) * lambda[C_OF(e->col)];
  for (const pl_pattern_entry* e = p->gt; e < p->gt + p->n_gt; e++)
    if (run->dae.taken[C_OF(e->row)]) C[C_OF(e->row)] += VALUE(e);
  if (run->dae.n_slipping == 0) return;
  const int* out = b->out + instance;
  for (const pl_pattern_entry* e = p->outputs; e < p->outputs + p->n_out; e++)
    coefficient[out[e->row * b->lanes]] += VALUE(e);
}

// All stages of a single instance in one sweep.
static void residual_by_stages(const pl_run* run, pl_radau* r, const pl_radau_lanes* w) {
  const pl_tape* tape = w->jet->tape;
  const pl_batch* b = w->batch;
  int s = r->method.s;
  for (int slot = 0; slot < b->pattern->n_q; slot++) {
    for (int l = 0; l < WIDE; l++) {
      int i = l < s ? l : s - 1;
      if (tape->q_node[slot] >= 0)
        pl_jet_at(w->jet, tape->q_node[slot], 0)[l] = pl_radau_stage(r->Q, i, r->n_q)[b->q[slot]];
      if (tape->v_node[slot] >= 0)
        pl_jet_at(w->jet, tape->v_node[slot], 0)[l] = pl_radau_stage(r->V, i, r->n_q)[b->q[slot]];
    }
  }
  for (int k = tape->level_end[PL_LEVEL_CONST]; k < tape->level_end[PL_LEVEL_POSITION]; k++)
    for (int l = 0; l < WIDE && tape->nodes[k].op == PL_OP_TIME; l++)
      pl_jet_at(w->jet, k, 0)[l] = r->t[l < s ? l : s - 1];
  pl_radau_sweep(w->jet, 0);
  for (int i = 0; i < s; i++) add_residual(run, r, w, i, 0, i);
}

void pl_radau_load_instances(const pl_radau_lanes* w, double t, const double* q, const double* v) {
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
  pl_radau_sweep(w->jet, 0);
}

static void residual_by_instances(const pl_run* run, pl_radau* r, const pl_radau_lanes* w) {
  for (int i = 0; i < r->method.s; i++) {
    pl_radau_load_instances(w, r->t[i], pl_radau_stage(r->Q, i, r->n_q),
                            pl_radau_stage(r->V, i, r->n_q));
    for (int l = 0; l < w->batch->n; l++) add_residual(run, r, w, l, l, i);
  }
}

// m - κ λ in the rows of slip.
static void pl_radau_slip_rows(const pl_run* run, const double* coefficient, const double* lambda,
                               double* C) {
  for (int k = 0; k < run->setup->n_frictions; k++) {
    const pl_friction_setup* friction = &run->setup->frictions[k];
    for (int i = 0; i < friction->n_rows && run->dae.friction[k].state == PL_FRICTION_SLIP; i++)
      C[friction->row[i]] = lambda[friction->row[i]]
                            - pl_friction_kappa(&run->dae, k, i, coefficient)
                                  * lambda[friction->constraint];
  }
}

void pl_radau_residual(pl_run* run, pl_radau* r) {
  memset(r->F, 0, (size_t)r->n * (size_t)r->method.s * sizeof *r->F);
  memset(r->coefficient, 0, (size_t)r->n_C * (size_t)r->method.s * sizeof(double));
  for (int i = 0; i < run->dae.motion.n; i++) {
    const pl_radau_lanes* w = &r->lanes[i];
    if (w->batch->lanes > 1) residual_by_instances(run, r, w);
    else residual_by_stages(run, r, w);
  }
  for (int i = 0; i < r->method.s; i++) {
    double* F = pl_radau_stage(r->F, i, r->n);
    for (int k = 0; k < run->n_q; k++)
      if (run->dae.has_equation[k] == 0) F[k] = 0;
    if (run->dae.n_slipping > 0)
      pl_radau_slip_rows(run, pl_radau_stage(r->coefficient, i, r->n_C),
                         pl_radau_stage(r->L, i, r->n_c), F + r->n_q);
  }
}
