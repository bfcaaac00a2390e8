// The series of the motion at a point, order by order, and the step that it allows.
//
// Index-3 Taylor series: with q_{k+1} = v_k / (k+1), nodes of q and t are known to order k+1, nodes
// of v to order k, and one solve with the factor of the point gives a_k and λ_k; then v_{k+1} = a_k
// / (k+1). Order and step after [JorbaZou2005], with separate norms for positions and
// velocities, which have different units.
// See theory (10.4), (10.5), (10.6).
#include "solve/stepper/taylor/extended_impl.h"

#include <float.h>
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

static void solve_order(pl_run* run, int k) {
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

// Order 0 at a point whose programs may be there already, into the series at work.
static bool enter_at(pl_run* run, double t, const double* q, const double* v) {
  int n = run->n_q;
  memcpy(run->Q, q, (size_t)n * sizeof *q);
  memcpy(run->V, v, (size_t)n * sizeof *v);
  if (run->extended) return run->at_point && pl_extended_enter(run);
  if (run->at_point && pl_step_program_enter(run)) return true;
  run->at_point = false;
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
  solve_order(run, 0);
  run->ready = isfinite(pl_norm(run->A, n)) && isfinite(pl_norm(run->L, run->n_c));
  return run->ready;
}

bool pl_point_enter(pl_run* run) {
  run->t_series = run->t;
  if (run->arrived) {
    run->arrived = false;
    return run->ready;
  }
  return enter_at(run, run->t, run->q, run->v);
}

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

bool pl_point_arrive(pl_run* run, double h, double* off, double* size) {
  if (run->extended) return pl_extended_arrive(run, off, size);
  if (run->at_point && run->end_by_program) {
    pl_step_program_arrive(run, off, size);
    return isfinite(*off) && isfinite(*size);
  }
  if (run->end_by_program) pl_step_program_end_a(run, run->end_a);
  pl_series_swap(run);
  run->arrived = enter_at(run, run->t + run->t_low + h, run->trial_q, run->trial_v);
  pl_series_swap(run);
  for (int i = 0; i < run->n_q; i++) run->end_a[i] -= run->A_last[i];
  *off = pl_norm(run->end_a, run->n_q);
  *size = pl_norm(run->A_last, run->n_q);
  return run->arrived;
}

void pl_point_general(pl_run* run) {
  if (!run->at_point) return;
  run->at_point = run->factored = false;
  pl_point_evaluate(run, run->t, run->q, run->v);
  pl_active_set_choose(run);
  pl_point_factor(run, true);
}

void pl_series_expand(pl_run* run) {
  if (run->extended) {
    pl_extended_expand(run);
    return;
  }
  if (!run->at_point || !pl_step_program_is_compiled(run)) run->stats.steps_interpreted++;
  if (run->at_point) pl_step_program_expand(run);
  else
    for (int k = 1; k < run->order; k++) solve_order(run, k);
  // one more coefficient of q comes for nothing
  const double* v = run->V + (size_t)run->order * (size_t)run->n_q;
  double* q = run->Q + (size_t)(run->order + 1) * (size_t)run->n_q;
  for (int i = 0; i < run->n_q; i++) q[i] = v[i] / (run->order + 1);
}

// -------------------------------------------------------------------------------------------- step
// Binary logarithm to four digits, which is plenty for a step: exponent, and a cubic for the
// mantissa. Several at once, which takes little longer than one.
static void rough_log2(const double* x, double* log, int n) {
  for (int i = 0; i < n; i++) {
    uint64_t bits;
    memcpy(&bits, &x[i], sizeof bits);
    int exponent = (int)(bits >> 52) - 1023;
    bits = (bits & 0xfffffffffffffu) | 0x3ff0000000000000u;
    double m;
    memcpy(&m, &bits, sizeof m);
    double y = (m - 1) / (m + 1), z = y * y;  // ln m = 2 artanh y
    log[i] = exponent + 2.8853900817779268 * y * (1 + z * (1 / 3.0 + z * (0.2 + z * (1 / 7.0))));
  }
  for (int i = 0; i < n; i++)
    if (!(x[i] >= DBL_MIN) || x[i] > DBL_MAX)
      log[i] = x[i] > DBL_MAX ? (double)INFINITY : x[i] >= 0 ? -2000 : (double)NAN;
}

void pl_block_rows(int last, int row[PL_BLOCK_ROWS]) {
  for (int i = 0; i < 4; i++) row[i] = i;
  row[4] = last - 1;
  row[5] = last;
}

static void norms_of(const double* X, int n, int last, double* norm) {
  int row[PL_BLOCK_ROWS];
  pl_block_rows(last, row);
  for (int i = 0; i < PL_BLOCK_ROWS; i++) norm[i] = pl_norm(X + (size_t)row[i] * (size_t)n, n);
}

// Radius of a block from its last two coefficients: (|x| / |x_k|)^(1/k), as a logarithm. The size
// |x| is that of the block at the point, or what an early coefficient and the radius say when it is
// near zero there.
static double block_radius(const double* norm, int last) {
  double log[PL_BLOCK_ROWS], least = (double)INFINITY;
  rough_log2(norm, log, PL_BLOCK_ROWS);
  double size = log[0], before = log[4], top = log[5];
  if (isnan(top) || isnan(before)) return -(double)INFINITY;
  // beyond a double: lower orders tell
  if (isinf(top) || isinf(before)) return (double)INFINITY;
  if (top > -2000)
    for (int k = 1; k <= 3 && k < last; k++)
      size = pl_larger(size, log[k] + k * (log[k] - top) / (last - k));
  else if (size <= -2000) size = 0;
  if (before > -2000) least = (size - before) / (last - 1);
  if (top > -2000) least = pl_smaller(least, (size - top) / last);
  return least;
}

// A step twice as long as the one before is looked at closely: coefficients that are rounding make
// it three to seven times as long. What many orders say counts where it is clearly less: ordinary
// steps stay as they are.
static const double grown = 2, clearly = 1.3;

// Radius of a block from the norms of many orders, where the last two may be none or rounding:
// motions that start at rest or in a symmetric position have coefficients of every second or fourth
// order only, and others have wider gaps. The least of what orders of the upper half say, each as
// if it was the last; infinite where all of these are zero, as those of a fall are.
static double many_orders_radius(const double* X, int n, int last) {
  enum { EARLY = 3 };
  double least = (double)INFINITY, first[EARLY + 1];
  int top = 0;
  for (int k = last; k > last / 2 || (top == 0 && k > EARLY && k > last / 4); k--) {
    double norm = pl_norm(X + (size_t)k * (size_t)n, n), log;
    rough_log2(&norm, &log, 1);
    if (isnan(log)) return -(double)INFINITY;
    if (log <= -2000 || isinf(log)) continue;
    if (top == 0) {
      top = k;
      for (int j = 0; j <= EARLY; j++) {
        double early = pl_norm(X + (size_t)j * (size_t)n, n), of_early;
        rough_log2(&early, &of_early, 1);
        first[j] = of_early + j * (of_early - log) / (k - j);
        if (of_early <= -2000) first[j] = -(double)INFINITY;
        if (j > 0) first[0] = pl_larger(first[0], first[j]);
      }
      if (!isfinite(first[0])) first[0] = 0;
    }
    least = pl_smaller(least, (first[0] - log) / k);
  }
  return least;
}

double pl_series_step(pl_run* run) {
  int p = run->order;
  double of_q[PL_BLOCK_ROWS], of_v[PL_BLOCK_ROWS];
  const double *q = of_q, *v = of_v;
  if (run->extended) {
    pl_extended_norms(run, &q, &v);
  } else if (run->at_point) {
    pl_step_program_norms(run, &q, &v);
  } else {
    norms_of(run->Q, run->n_q, p + 1, of_q);
    norms_of(run->V, run->n_q, p, of_v);
  }
  // e^shrink of the radius makes p - 1 factors of tol together; the rest is their safety factor,
  // eq. (3-8) there
  double shrink = 1.4426950408889634 * (0.7 / (p - 1) - run->shrink);
  double radius = pl_smaller(block_radius(q, p + 1), block_radius(v, p)), h = exp2(radius - shrink);
  if (!(h <= grown * run->h_series) || isinf(run->h_series)) {
    double all = exp2(pl_smaller(many_orders_radius(run->Q, run->n_q, p + 1),
                                 many_orders_radius(run->V, run->n_q, p))
                      - shrink);
    if (!(h <= clearly * all)) h = all;
  }
  return run->extended ? pl_extended_vary(run, h) : h;
}

// -------------------------------------------------------------------------------------- evaluation
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
