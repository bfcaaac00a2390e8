// The motion at a point: nodes, factor and the orders of the series there, by the patterns.
//
// Index-3 Taylor series: with q_{k+1} = v_k / (k+1), nodes of q and t are known to order k+1, nodes
// of v to order k, and one solve with the factor of the point gives a_k and λ_k; then v_{k+1} = a_k
// / (k+1). See theory (10.3).
#include "solve/dae/dae.h"

#include <math.h>
#include <string.h>

// numbers: up to here choosing the code for the processor takes longer than it spares
enum { FEW = 32 };

double pl_norm(const double* x, int n) {
  double most = 0;
  if (n > FEW) return pl_taylor_order_here()->norm(x, n);
  for (int i = 0; i < n; i++) most = pl_size_with(most, x[i]);
  return most;
}

void pl_sizes_note(pl_dae* dae, const double* q, const double* v) {
  if (dae->n_q > FEW) {
    dae->q_size = pl_larger(dae->q_size, pl_taylor_order_here()->note(dae->q_most, q, dae->n_q));
    dae->v_size = pl_larger(dae->v_size, pl_taylor_order_here()->note(dae->v_most, v, dae->n_q));
    return;
  }
  for (int i = 0; i < dae->n_q; i++) {
    dae->q_most[i] = pl_larger(dae->q_most[i], fabs(q[i]));
    dae->v_most[i] = pl_larger(dae->v_most[i], fabs(v[i]));
    dae->q_size = pl_larger(dae->q_size, dae->q_most[i]);
    dae->v_size = pl_larger(dae->v_size, dae->v_most[i]);
  }
}

void pl_sizes_keep(pl_dae* dae) {
  memcpy(dae->q_kept, dae->q_most, (size_t)dae->n_q * sizeof(double));
  memcpy(dae->v_kept, dae->v_most, (size_t)dae->n_q * sizeof(double));
}

void pl_sizes_forget(pl_dae* dae) {
  memcpy(dae->q_most, dae->q_kept, (size_t)dae->n_q * sizeof(double));
  memcpy(dae->v_most, dae->v_kept, (size_t)dae->n_q * sizeof(double));
  dae->q_size = pl_norm(dae->q_most, dae->n_q);
  dae->v_size = pl_norm(dae->v_most, dae->n_q);
}

// --------------------------------------------------------------------------------------- the point
void pl_point_evaluate(pl_dae* dae, double t, const double* q, const double* v) {
  pl_batches* m = &dae->motion;
  dae->t_nodes = t;
  pl_batches_time(m, t);
  pl_batches_load_q(m, q, 0);
  pl_batches_load_v(m, v, 0);
  pl_batches_sweep(m, PL_LEVEL_POSITION, 0, true);
  pl_batches_sweep(m, PL_LEVEL_VELOCITY, 0, true);
}

// What must be left of a pivot to go on without pivoting: of what was left of it in better places,
// and at all.
static const double sound = 0.02, least_trusted = 1e-7;

bool pl_point_factor(pl_dae* dae, bool with_W) {
  if (dae->setup->n_frictions > 0) pl_friction_coefficients(dae, 0);
  pl_assemble_matrix(dae, with_W);
  dae->kkt.trusted = pl_larger(least_trusted, dae->by_pivots ? sound * dae->best * dae->best : 0);
  bool regular = pl_kkt_factor(&dae->kkt);
  if (dae->by_pivots) {
    // pivots of the whole system fade with the square of those of the rows
    dae->smallest = sqrt(dae->kkt.ratio);
    dae->best = pl_larger(dae->best, dae->smallest);
  }
  return regular;
}

void pl_point_order(pl_dae* dae, int k) {
  pl_batches* m = &dae->motion;
  int n = dae->n_q;
  double* q_next = dae->Q + (size_t)(k + 1) * (size_t)n;
  // from order 1 on it came with v
  if (k == 0) pl_taylor_order_here()->over(q_next, dae->V, 1, n);
  pl_batches_load_q(m, q_next, k + 1);
  // all: where a landing is watched, g itself is needed to all orders
  bool all = dae->watch_landings;
  pl_batches_sweep(m, PL_LEVEL_POSITION, k + 1, all);
  if (k > 0) pl_batches_sweep(m, PL_LEVEL_VELOCITY, k, false);
  if (k > 0 && dae->setup->n_frictions > 0) pl_friction_coefficients(dae, k);
  pl_assemble_rhs(dae, k, dae->rhs);
  pl_kkt_solve(&dae->kkt, dae->rhs);
  pl_taylor_order_here()->take(dae, k);
  pl_batches_load_a(m, dae->A + (size_t)k * (size_t)n, k);
  pl_batches_load_lambda(m, dae->L + (size_t)k * (size_t)dae->n_c, k);
  pl_batches_load_v(m, dae->V + (size_t)(k + 1) * (size_t)n, k + 1);
}

bool pl_point_enter_at(pl_dae* dae, double t, const double* q, const double* v) {
  int n = dae->n_q;
  memcpy(dae->Q, q, (size_t)n * sizeof *q);
  memcpy(dae->V, v, (size_t)n * sizeof *v);
  if (dae->factored) {
    // the projection left nodes of q and t and the factor; only v has changed since
    pl_batches_load_v(&dae->motion, v, 0);
    pl_batches_sweep(&dae->motion, PL_LEVEL_VELOCITY, 0, true);
  } else {
    pl_point_evaluate(dae, t, q, v);
    pl_active_set_choose(dae);
    if (!pl_point_factor(dae, true)) return false;
  }
  dae->factored = false;
  pl_point_order(dae, 0);
  dae->ready = isfinite(pl_norm(dae->A, n)) && isfinite(pl_norm(dae->L, dae->n_c));
  return dae->ready;
}

bool pl_point_enter(pl_dae* dae) {
  dae->at_point = false;
  dae->t_series = dae->t;
  return pl_point_enter_at(dae, dae->t, dae->q, dae->v);
}

// -------------------------------------------------------------------------------------- the series
static void swap(double** a, double** b) {
  double* x = *a;
  *a = *b;
  *b = x;
}

void pl_series_swap(pl_dae* dae) {
  swap(&dae->Q, &dae->Q_last);
  swap(&dae->V, &dae->V_last);
  swap(&dae->A, &dae->A_last);
  swap(&dae->L, &dae->L_last);
}

void pl_horner(const double* X, int n, int last, double dt, double* x) {
  pl_taylor_order_here()->horner(X, n, last, dt, x);
}

void pl_series_at(const pl_dae* dae, double dt, double* q, double* v) {
  pl_horner(dae->Q, dae->n_q, dae->use + 1, dt, q);
  pl_horner(dae->V, dae->n_q, dae->use, dt, v);
}

void pl_series_lambda_at(const pl_dae* dae, double dt, double* a, double* lambda) {
  pl_horner(dae->A, dae->n_q, dae->use - 1, dt, a);
  pl_horner(dae->L, dae->n_c, dae->use - 1, dt, lambda);
}
