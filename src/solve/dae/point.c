// The motion at a point: nodes, factor and the orders of the series there, by the patterns.
//
// Index-3 Taylor series: with q_{k+1} = v_k / (k+1), nodes of q and t are known to order k+1, nodes
// of v to order k, and one solve with the factor of the point gives a_k and λ_k; then v_{k+1} = a_k
// / (k+1). See theory (10.4).
#include "solve/solve_impl.h"

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

void pl_sizes_note(pl_run* run, const double* q, const double* v) {
  if (run->n_q > FEW) {
    run->q_size = pl_larger(run->q_size, pl_taylor_order_here()->note(run->q_most, q, run->n_q));
    run->v_size = pl_larger(run->v_size, pl_taylor_order_here()->note(run->v_most, v, run->n_q));
    return;
  }
  for (int i = 0; i < run->n_q; i++) {
    run->q_most[i] = pl_larger(run->q_most[i], fabs(q[i]));
    run->v_most[i] = pl_larger(run->v_most[i], fabs(v[i]));
    run->q_size = pl_larger(run->q_size, run->q_most[i]);
    run->v_size = pl_larger(run->v_size, run->v_most[i]);
  }
}

void pl_sizes_keep(pl_run* run) {
  memcpy(run->q_kept, run->q_most, (size_t)run->n_q * sizeof(double));
  memcpy(run->v_kept, run->v_most, (size_t)run->n_q * sizeof(double));
}

void pl_sizes_forget(pl_run* run) {
  memcpy(run->q_most, run->q_kept, (size_t)run->n_q * sizeof(double));
  memcpy(run->v_most, run->v_kept, (size_t)run->n_q * sizeof(double));
  run->q_size = pl_norm(run->q_most, run->n_q);
  run->v_size = pl_norm(run->v_most, run->n_q);
}

// --------------------------------------------------------------------------------------- the point
void pl_point_evaluate(pl_run* run, double t, const double* q, const double* v) {
  pl_batches* m = &run->motion;
  run->t_nodes = t;
  pl_batches_time(m, t);
  pl_batches_load_q(m, q, 0);
  pl_batches_load_v(m, v, 0);
  pl_batches_sweep(m, PL_LEVEL_POSITION, 0, true);
  pl_batches_sweep(m, PL_LEVEL_VELOCITY, 0, true);
}

// What must be left of a pivot to go on without pivoting: of what was left of it in better places,
// and at all.
static const double sound = 0.02, least_trusted = 1e-7;

bool pl_point_factor(pl_run* run, bool with_W) {
  if (run->setup->n_frictions > 0) pl_friction_coefficients(run, 0);
  pl_assemble_matrix(run, with_W);
  run->kkt.trusted = pl_larger(least_trusted, run->by_pivots ? sound * run->best * run->best : 0);
  bool regular = pl_kkt_factor(&run->kkt);
  if (run->by_pivots) {
    // pivots of the whole system fade with the square of those of the rows
    run->smallest = sqrt(run->kkt.ratio);
    run->best = pl_larger(run->best, run->smallest);
  }
  return regular;
}

void pl_point_order(pl_run* run, int k) {
  pl_batches* m = &run->motion;
  int n = run->n_q;
  double* q_next = run->Q + (size_t)(k + 1) * (size_t)n;
  // from order 1 on it came with v
  if (k == 0) pl_taylor_order_here()->over(q_next, run->V, 1, n);
  pl_batches_load_q(m, q_next, k + 1);
  // all: where a landing is watched, g itself is needed to all orders
  bool all = run->watch_landings;
  pl_batches_sweep(m, PL_LEVEL_POSITION, k + 1, all);
  if (k > 0) pl_batches_sweep(m, PL_LEVEL_VELOCITY, k, false);
  if (k > 0 && run->setup->n_frictions > 0) pl_friction_coefficients(run, k);
  pl_assemble_rhs(run, k, run->rhs);
  pl_kkt_solve(&run->kkt, run->rhs);
  pl_taylor_order_here()->take(run, k);
  pl_batches_load_a(m, run->A + (size_t)k * (size_t)n, k);
  pl_batches_load_lambda(m, run->L + (size_t)k * (size_t)run->n_c, k);
  pl_batches_load_v(m, run->V + (size_t)(k + 1) * (size_t)n, k + 1);
}

bool pl_point_enter_at(pl_run* run, double t, const double* q, const double* v) {
  int n = run->n_q;
  memcpy(run->Q, q, (size_t)n * sizeof *q);
  memcpy(run->V, v, (size_t)n * sizeof *v);
  if (run->factored) {
    // the projection left nodes of q and t and the factor; only v has changed since
    pl_batches_load_v(&run->motion, v, 0);
    pl_batches_sweep(&run->motion, PL_LEVEL_VELOCITY, 0, true);
  } else {
    pl_point_evaluate(run, t, q, v);
    pl_active_set_choose(run);
    if (!pl_point_factor(run, true)) return false;
  }
  run->factored = false;
  pl_point_order(run, 0);
  run->ready = isfinite(pl_norm(run->A, n)) && isfinite(pl_norm(run->L, run->n_c));
  return run->ready;
}

bool pl_point_enter(pl_run* run) {
  run->at_point = false;
  run->t_series = run->t;
  return pl_point_enter_at(run, run->t, run->q, run->v);
}

double pl_run_left(const pl_run* run) {
  if (run->stop.early) return (run->stop.t - run->t) + (run->stop.t_low - run->t_low);
  return run->options.t_end - run->t - run->t_low;
}

// -------------------------------------------------------------------------------------- the series
static void swap(double** a, double** b) {
  double* x = *a;
  *a = *b;
  *b = x;
}

void pl_series_swap(pl_run* run) {
  swap(&run->Q, &run->Q_last);
  swap(&run->V, &run->V_last);
  swap(&run->A, &run->A_last);
  swap(&run->L, &run->L_last);
}

void pl_horner(const double* X, int n, int last, double dt, double* x) {
  pl_taylor_order_here()->horner(X, n, last, dt, x);
}

void pl_series_at(const pl_run* run, double dt, double* q, double* v) {
  pl_horner(run->Q, run->n_q, run->use + 1, dt, q);
  pl_horner(run->V, run->n_q, run->use, dt, v);
}

void pl_series_lambda_at(const pl_run* run, double dt, double* a, double* lambda) {
  pl_horner(run->A, run->n_q, run->use - 1, dt, a);
  pl_horner(run->L, run->n_c, run->use - 1, dt, lambda);
}
