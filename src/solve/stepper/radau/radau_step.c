// Steps of the implicit method: Radau IIA with 3, 5 or 7 stages, order 5, 9 or 13, for stiff
// motions.
//
//   q' = v,     M(q,t) v' + h(q,v,t) = (G^T + W) λ,     G v + dg/dt = 0        (index 2)
//
// The constraints are imposed on velocity level at every stage; positions and velocities are then
// brought back onto g = 0 and G v + dg/dt = 0 with the matrix of the Newton iteration, so that
// stiff springs come along undeformed, and a projection in the mass metric removes what rounding
// leaves. Accelerations and multipliers at the end of a step are those of the point reached. Newton
// iteration, error estimate and control of the step after [HairerWanner1996, IV.8] and
// [HairerWanner1999]. The estimate has order s, the step order 2 s - 1: they compare it with
// tol^((s+1)/(2s)), which a smooth motion allows. Stiff parts lose order, so here the exponent is
// halfway between that and 1. Between the ends of a step the collocation polynomial serves, as
// coefficients of a series: rows, events and the rest of a run read it like one of Taylor's. Where
// it is less exact than the tolerance, steps end on the times of output; events are iterated on the
// end of a step.
// See theory (11.1), (11.2).
#include "solve/stepper/radau/radau_impl.h"

#include <float.h>
#include <math.h>
#include <string.h>

static const double safety = 0.9;
// of the largest coordinate: what smaller ones are measured by at least
static const double floor_part = 1e-3;
static const double newton_part = 0.02;  // of the tolerance: what the iteration may leave
static const double least_tol = 1e-13;   // below this rounding decides
static const double usual_tol = 1e-10;   // where none is asked for

double pl_radau_tol(double asked) { return asked > 0 ? fmax(asked, least_tol) : usual_tol; }

void pl_radau_changed(pl_run* run, bool shaken) {
  pl_radau* r = run->radau;
  r->has_last = r->rejected = false;
  r->error_last = 0;
  // a stiff part that was set going needs short steps at first
  if (shaken) r->h = 0;
}

// ------------------------------------------------------------------------------------------ stages
static double* stage(double* x, int i, int n) { return pl_radau_stage(x, i, n); }

static void set_stages(const pl_run* run, pl_radau* r, double h) {
  const pl_radau_method* m = &r->method;
  int n = r->n_q, s = m->s;
  for (int i = 0; i < s; i++) {
    double *Q = stage(r->Q, i, n), *V = stage(r->V, i, n), *A = stage(r->A, i, n);
    r->t[i] = run->dae.t + (run->dae.t_low + m->c[i] * h);
    for (int e = 0; e < n; e++) {
      double way = 0, turn = 0;
      for (int j = 0; j < s; j++) {
        double z = r->Z[(size_t)j * (size_t)n + (size_t)e];
        way += m->A[i][j] * z;
        turn += m->inverse[i][j] * z;
      }
      Q[e] = run->dae.q[e] + h * (m->c[i] * run->dae.v[e] + way);
      V[e] = run->dae.v[e] + stage(r->Z, i, n)[e];
      A[e] = turn / h;
    }
  }
}

// The last polynomial continued, if the motion went on smoothly; else the velocity and multipliers
// of the point.
static void predict(pl_run* run, pl_radau* r, double h) {
  const pl_radau_method* m = &r->method;
  int n = r->n_q, degree = m->s;
  for (int i = 0; i < m->s; i++) {
    double *Z = stage(r->Z, i, n), *L = stage(r->L, i, r->n_c);
    if (!r->has_last) {
      memset(Z, 0, (size_t)n * sizeof *Z);
      memcpy(L, run->dae.L, (size_t)r->n_c * sizeof *L);
      continue;
    }
    double dt = run->dae.t + m->c[i] * h - run->control.t_last;
    pl_horner(run->dae.V_last, n, degree, dt, Z);
    pl_horner(run->dae.L_last, r->n_c, degree, dt, L);
    for (int e = 0; e < n; e++) Z[e] -= run->dae.v[e];
    for (int c = 0; c < r->n_c; c++)
      if (!pl_radau_has_force(run, c)) L[c] = 0;
  }
}

// What errors are measured by: the largest that a component has been, with a floor for those that
// hardly move.
static void set_scales(const pl_run* run, pl_radau* r, double h) {
  int n = r->n_q;
  const double *Q = stage(r->Q, r->method.s - 1, n), *V = stage(r->V, r->method.s - 1, n);
  double q_most = fmax(run->dae.q_size, pl_norm(Q, n)),
         v_most = fmax(run->dae.v_size, pl_norm(V, n));
  if (q_most == 0) q_most = fabs(h) * v_most;
  for (int i = 0; i < n; i++) {
    r->sc_q[i] = fmax(fmax(run->dae.q_most[i], fabs(Q[i])), floor_part * q_most);
    r->sc_v[i] = fmax(fmax(run->dae.v_most[i], fabs(V[i])), floor_part * v_most);
    if (!(r->sc_q[i] > 0)) r->sc_q[i] = 1;
    if (!(r->sc_v[i] > 0)) r->sc_v[i] = r->sc_q[i];
  }
  // rounding of the positions moves velocities by ε γ q / h through a stiff force
  r->rounding = 4 * DBL_EPSILON * r->method.gamma[0][0] / fabs(h) * q_most;
}

static double scaled(const double* x, const double* scale, double least, int n) {
  double most = 0;
  for (int i = 0; i < n; i++) {
    double y = fabs(x[i]) / fmax(scale[i], least);
    if (!(y <= most)) most = y;
  }
  return most;
}

// The size of the corrections that stand in F.
static double size_of_correction(const pl_radau* r, double h, double goal) {
  double most = 0;
  for (int i = 0; i < r->method.s; i++) {
    const double* d = r->F + (size_t)i * (size_t)r->n;
    for (int e = 0; e < r->n_q; e++) {
      double y = fabs(d[e])
                 * fmax(1 / fmax(r->sc_v[e], 0.05 * r->rounding / goal), fabs(h) / r->sc_q[e]);
      if (!(y <= most)) most = y;
    }
  }
  return most;
}

static int most_rounds(const pl_radau* r) { return 7 + 2 * (r->method.s - 3); }

// Whether a coupled iteration needs the slopes at the stages where it is now.
static bool slopes_are_stale(const pl_radau* r, int round) {
  return round == 1 || (r->theta > 0.05 && round <= 6);
}

// Newton iteration: split, with the slopes at the start of the step for all stages; or coupled,
// with those at the stages. Returns the rounds taken, 0 when it does not converge fast enough.
static int iterate(pl_run* run, pl_radau* r, double h) {
  double goal = fmax(newton_part * r->tol, 20 * DBL_EPSILON), before = 0;
  int most = most_rounds(r);
  predict(run, r, h);
  set_stages(run, r, h);
  set_scales(run, r, h);
  for (int round = 1; round <= most; round++) {
    if (r->couples && slopes_are_stale(r, round) && !pl_radau_couple(run, r, h)) return 0;
    pl_radau_residual(run, r);
    (r->couples ? pl_radau_correct_coupled : pl_radau_correct)(r, run);
    set_stages(run, r, h);
    set_scales(run, r, h);
    double size = size_of_correction(r, h, goal);
    if (!isfinite(size)) return 0;
    if (round > 1) {
      r->theta = size / before;
      if (r->theta >= 0.99 && size <= 100 * goal && round > 2) return round;
      if (r->theta >= (r->couples && round < 4 ? 2 : 0.99)) return 0;
      // what is still to come, and where that leaves the last round
      if (r->theta < 0.99 && r->theta / (1 - r->theta) * size <= goal) return round;
      if (!r->couples && pow(r->theta, most - round) / (1 - r->theta) * size > 10 * goal) return 0;
    } else if (size <= 0.1 * goal) {
      return round;
    }
    before = size;
  }
  return 0;
}

// ------------------------------------------------------------------------------------------- error
// Solves (γ/h M - J) error = f + sum e_i z_i / h. The estimate is not filtered a second time, as is
// usual for steps that begin off the slow motion: that would hide a stiff oscillation which nothing
// damps.
static double estimate(const pl_run* run, pl_radau* r, double h) {
  const pl_radau_method* m = &r->method;
  int n = r->n_q;
  double gamma = m->gamma[0][0] / h, *rho = r->error_q, *b = r->rhs;
  for (int e = 0; e < n; e++) {
    rho[e] = run->dae.v[e];
    r->error_v[e] = run->dae.A[e];
    for (int i = 0; i < m->s; i++) {
      double way = m->c[i] * run->dae.v[e];  // (Q_i - q) / h, without its rounding
      for (int j = 0; j < m->s; j++) way += m->A[i][j] * stage(r->Z, j, n)[e];
      rho[e] += m->error[i] * way;
      r->error_v[e] += m->error[i] * stage(r->Z, i, n)[e] / h;
    }
  }
  memset(b, 0, (size_t)r->n * sizeof *b);
  pl_radau_multiply(&r->shape, b, 1, r->here.P0, r->error_v, n);
  pl_radau_multiply(&r->shape, b, -1 / gamma, r->here.P2, rho, n);
  for (int e = 0; e < n; e++)
    if (run->dae.has_equation[e] == 0) b[e] = 0;
  for (int c = 0; c < r->n_c; c++)
    if (!pl_radau_has_force(run, c)) b[n + c] = 0;
  pl_radau_solve_real(r, b);
  for (int e = 0; e < n; e++) {
    r->error_v[e] = b[e];
    r->error_q[e] = (b[e] + rho[e]) / gamma;
  }
  double least = 2 * r->rounding / r->tol_stage;
  return fmax(scaled(r->error_q, r->sc_q, 0, n), scaled(r->error_v, r->sc_v, least, n))
         / r->tol_stage;
}

// ------------------------------------------------------------------------------------- one attempt
typedef struct pl_radau_try {
  bool fine;
  double error;  // in units of the tolerance of the estimate
  double next;   // length of the next step, or of the next attempt
} pl_radau_try;

static pl_radau_try give_up(pl_radau* r, double h, double part) {
  r->has_factor = false;
  return (pl_radau_try){false, (double)INFINITY, part * fabs(h)};
}

// Wanted length after a step with this error, and its limits.
static double next_length(const pl_radau* r, double h, double error) {
  int s = r->method.s, most = most_rounds(r);
  double factor = fmin(safety, safety * (1 + 2 * most) / (r->newton + 2 * most));
  double quotient = pow(fmax(error, 1e-10), 1.0 / (s + 1)) / factor;
  if (error < 1 && r->error_last > 0 && !r->rejected) {
    double predicted = fabs(r->h_last / h) * pow(error * error / r->error_last, 1.0 / (s + 1))
                       / safety;
    quotient = fmax(quotient, predicted);
  }
  return fabs(h) / fmin(fmax(quotient, 1.0 / 8), 5);
}

static void slopes_at_start(pl_run* run, pl_radau* r) {
  pl_radau_slopes_at(run, r, &r->here, run->dae.t + run->dae.t_low, run->dae.q, run->dae.v,
                     run->dae.A, run->dae.L);
  r->has_jacobian = true;
  r->has_factor = false;
}

// Where the split iteration fails the coupled one takes over for a while: a stiff direction turns
// within the step.
static int iterate_either_way(pl_run* run, pl_radau* r, double h) {
  if (r->couples && r->coupled && r->stay-- <= 0) r->couples = false;
  int rounds = iterate(run, r, h);
  if (rounds > 0) {
    if (!r->couples) r->stay_next = 16;
    return rounds;
  }
  if (r->couples || r->coupled == NULL) return 0;
  r->couples = true;
  r->stay = r->stay_next;
  r->stay_next = r->stay_next < 1000 ? 2 * r->stay_next : r->stay_next;
  return iterate(run, r, h);
}

static pl_radau_try attempt(pl_run* run, pl_radau* r, double h) {
  if (!r->has_jacobian) slopes_at_start(run, r);
  if (!pl_radau_factor(r, run, h)) return give_up(r, h, 0.5);
  r->newton = iterate_either_way(run, r, h);
  if (r->newton == 0) {
    r->has_last = r->has_last && !r->rejected;
    return give_up(r, h, 0.5);
  }
  double error = estimate(run, r, h);
  if (!isfinite(error)) return give_up(r, h, 0.5);
  return (pl_radau_try){error < 1, error, next_length(r, h, error)};
}

// The length of a step that would hold here, at most h and above least; nothing of the run changes
// but its jets.
bool pl_radau_probe(pl_run* run, double h, double least, double* reach) {
  pl_radau* r = run->radau;
  if (!pl_radau_ready(run)) return false;
  r->has_jacobian = r->has_last = r->rejected = false;
  r->steps_in_row = 0;
  while (fabs(h) > 2 * least) {
    pl_radau_try a = attempt(run, r, h);
    *reach = fmin(fabs(a.next), fabs(h));
    if (a.fine) return true;
    r->rejected = true;
    h = copysign(fmin(a.next, 0.5 * fabs(h)), h);
  }
  return false;
}

// ----------------------------------------------------------------------------------- back onto the
// constraints
static double relative(const pl_run* run, const double* g, const double* size, bool positions) {
  double most = 0;
  for (int c = 0; c < run->n_c; c++) {
    if (!run->dae.taken[c] || g[c] == 0 || (positions && run->setup->constraints[c].velocity))
      continue;
    double x = fabs(g[c]) / size[c];
    if (!(x <= most)) most = x;
  }
  return most;
}

// The velocity that removes a residual, with the matrix of the iteration.
static void solve_back(const pl_run* run, pl_radau* r, const double* residual, double factor,
                       bool positions) {
  memset(r->rhs, 0, (size_t)r->n_q * sizeof(double));
  for (int c = 0; c < r->n_c; c++) {
    bool counts = run->dae.taken[c] && !(positions && run->setup->constraints[c].velocity);
    r->rhs[r->n_q + c] = counts ? -factor * residual[c] : 0;
  }
  pl_radau_solve_real(r, r->rhs);
}

static bool bring_back(pl_run* run, pl_radau* r, double h) {
  enum { MOST = 6 };
  double t = run->dae.t + run->dae.t_low + h, gamma = r->method.gamma[0][0] / h,
         before = (double)INFINITY;
  if (run->dae.n_active == 0) return true;
  for (int round = 0; round < MOST; round++) {
    pl_point_evaluate(&run->dae, t, run->control.trial_q, run->control.trial_v);
    pl_assemble_g(&run->dae, 0, run->dae.g, run->dae.g_size);
    double g = relative(run, run->dae.g, run->dae.g_size, true);
    if (!isfinite(g)) return false;
    if (g <= 4 * DBL_EPSILON || g >= 0.5 * before) break;
    before = g;
    solve_back(run, r, run->dae.g, gamma, true);
    for (int e = 0; e < r->n_q; e++) run->control.trial_q[e] += r->rhs[e] / gamma;
  }
  for (int round = 0; round < 2; round++) {
    pl_batches_load_v(&run->dae.motion, run->control.trial_v, 0);
    pl_assemble_gdot(&run->dae, run->dae.r, run->dae.r_size);
    solve_back(run, r, run->dae.r, 1, false);
    for (int e = 0; e < r->n_q; e++) run->control.trial_v[e] += r->rhs[e];
  }
  return isfinite(pl_norm(run->control.trial_q, r->n_q))
         && isfinite(pl_norm(run->control.trial_v, r->n_q));
}

// -------------------------------------------------------------------------------------- polynomial
// Coefficients of powers of time from the value at the start and those at the stages; zero above
// the degree.
static void fill_series(const pl_run* run, const pl_radau* r, double h, double* X,
                        const double* first, const double* values, int n) {
  int s = r->method.s;
  for (int e = 0; e < n; e++) {
    double power = 1;
    for (int k = 0; k <= s; k++, power *= h) {
      double sum = r->method.power_all[k][0] * first[e];
      for (int i = 0; i < s; i++)
        sum += r->method.power_all[k][i + 1] * values[(size_t)i * (size_t)n + (size_t)e];
      X[(size_t)k * (size_t)n + (size_t)e] = k == 0 ? first[e] : sum / power;
    }
  }
  memset(X + (size_t)(s + 1) * (size_t)n, 0,
         (size_t)(run->order + 1 - s) * (size_t)n * sizeof(double));
}

// A and L hold those of the point in order 0.
void pl_radau_series(pl_run* run, pl_radau* r, double h) {
  fill_series(run, r, h, run->dae.Q, run->dae.q, r->Q, r->n_q);
  fill_series(run, r, h, run->dae.V, run->dae.v, r->V, r->n_q);
  fill_series(run, r, h, run->dae.A, run->dae.A, r->A, r->n_q);
  fill_series(run, r, h, run->dae.L, run->dae.L, r->L, r->n_c);
  run->dae.t_series = run->dae.t;
  run->dae.use = run->order;
}

// ------------------------------------------------------------------------------- a step that holds
static bool met(const pl_projection* p, double tol) {
  double move = fmax(1e4 * tol, 1e-11), left = fmax(10 * tol, 1e-12);
  return p->ok && p->move_q <= move && p->move_v <= move && p->g_after <= left
         && p->r_after <= left;
}

static pleuel_status too_small(pl_run* run, double h) {
  if (run->dae.best > 0 && run->event->smallest_here < 1e-2 * run->dae.best)
    return pl_run_singular(run);
  return pl_fail(run->job, PLEUEL_NUMERICAL,
                 "no step is short enough at t = %.9g s (%.3g s tried): the motion leaves the "
                 "domain of a function, "
                 "or a force or the constraints jump there",
                 run->dae.t, h);
}

// Shorter and shorter until a step of that length holds; its end is in trial_q, trial_v.
pleuel_status pl_radau_hold(pl_run* run, pl_radau* r, double* h, double* error, double* next,
                            pl_projection* p) {
  for (;;) {
    pl_radau_try a = attempt(run, r, *h);
    if (a.fine) {
      memcpy(run->control.trial_q, stage(r->Q, r->method.s - 1, r->n_q),
             (size_t)r->n_q * sizeof(double));
      memcpy(run->control.trial_v, stage(r->V, r->method.s - 1, r->n_q),
             (size_t)r->n_q * sizeof(double));
      bool back = bring_back(run, r, *h);
      *p = pl_project(&run->dae, run->dae.t + run->dae.t_low + *h, run->control.trial_q,
                      run->control.trial_v);
      if (back && met(p, r->tol)) {
        *error = a.error;
        *next = a.next;
        return PLEUEL_OK;
      }
      pl_sizes_forget(&run->dae);
      a = give_up(r, *h, 0.5);
    }
    r->rejected = true;
    run->stats.rejections++;
    *h = copysign(a.next, *h);
    if (!(fabs(*h) > run->control.h_least)) return too_small(run, *h);
  }
}

// ----------------------------------------------------------------------------------------- lengths
// How far the next time of output is; infinite without a grid.
static double to_grid(const pl_run* run) {
  if (run->control.grid_dt == 0) return (double)INFINITY;
  double slack = 1e-9 * fabs(run->control.grid_dt);
  for (long n = run->control.grid_n;; n++) {
    double t = run->control.grid_times ? pl_grid_time(run, n)
                                       : run->options.t_0 + (double)n * run->control.grid_dt;
    double way = (t - run->dae.t - run->dae.t_low) * copysign(1, run->control.grid_dt);
    if (way > slack) return way;
  }
}

static double choose_length(pl_run* run, pl_radau* r) {
  double h = r->h, left = fabs(pl_run_left(run)), grid = to_grid(run);
  h = fmin(h, run->options.h_max > 0 ? run->options.h_max : run->control.row_gap);
  if (grid < h) h = fmax(grid, fmin(h, r->h_dense));
  if (h >= left) h = left;
  else if (h > 0.5 * left) h = 0.5 * left;
  // a length close to that of the last factors is taken over from them
  if (r->has_factor && h > fabs(r->h_factored) && h < 1.2 * fabs(r->h_factored) && h != grid
      && h != left)
    h = fabs(r->h_factored);
  return copysign(h, pl_run_left(run));
}

// The first step: a fraction of the radius of the series at the point.
static void first_length(pl_run* run, pl_radau* r) {
  run->dae.use = run->order;
  pl_taylor_expand(run);
  r->h = pl_taylor_length(run);
  if (!(r->h > 0)) r->h = 0;
  if (!isfinite(r->h)) r->h = fabs(pl_run_left(run));
  r->h = fmax(r->h, 100 * run->control.h_least);
  r->steps_in_row = 0;
}

static void see_whether_smooth(pl_run* run, pl_radau* r) {
  if (!r->has_last) return;
  double dt = run->dae.t - run->control.t_last, off = 0;
  pl_horner(run->dae.V_last, r->n_q, r->method.s, dt, run->control.row_v);
  for (int e = 0; e < r->n_q; e++) off = fmax(off, fabs(run->control.row_v[e] - run->dae.v[e]));
  r->has_last = dt != 0 && off <= 1e-3 * run->dae.v_size;
}

// ------------------------------------------------------------------------------------------ a step
// Rows between the ends need a polynomial as exact as the tolerance.
static bool rows_are_exact(const pl_run* run, const pl_radau* r, double h, double error) {
  return !(to_grid(run) < (1 - 1e-9) * fabs(h)) || error * r->tol_stage <= r->tol;
}

// A shorter step, its values and its polynomial.
static pleuel_status hold_again(pl_run* run, pl_radau* r, double* h, pl_projection* p) {
  pl_sizes_forget(&run->dae);
  PL_TRY(pl_radau_hold(run, r, h, &r->error, &r->next, p));
  pl_radau_watch(run, r, *h);
  pl_radau_series(run, r, *h);
  return PLEUEL_OK;
}

// The longest step up to h that holds and is exact enough between its ends.
static pleuel_status hold_for_rows(pl_run* run, pl_radau* r, double* h, pl_projection* p) {
  for (;;) {
    PL_TRY(pl_radau_hold(run, r, h, &r->error, &r->next, p));
    r->h_dense = fabs(*h) * 0.8
                 * pow(r->tol / fmax(r->error * r->tol_stage, 1e-6 * r->tol),
                       1.0 / (r->method.s + 1));
    if (rows_are_exact(run, r, *h, r->error)) return PLEUEL_OK;
    pl_sizes_forget(&run->dae);
    *h = copysign(fmax(to_grid(run), fmin(r->h_dense, 0.9 * fabs(*h))), *h);
  }
}

static pleuel_status prepare(pl_run* run, pl_radau* r) {
  pl_stepper_taylor.to_patterns(run);
  if (!pl_radau_ready(run))
    return pl_fail(run->job, PLEUEL_NO_MEMORY,
                   "the systems of the implicit method do not fit into memory");
  if (isnan(run->stats.t_implicit)) run->stats.t_implicit = run->dae.t;
  run->stats.order_implicit = 2 * r->method.s - 1;
  if (r->h == 0) first_length(run, r);
  r->has_jacobian = false;
  see_whether_smooth(run, r);
  return PLEUEL_OK;
}

pleuel_status pl_radau_expand(pl_run* run, pl_stepper_step* s) {
  pl_radau* r = run->radau;
  PL_TRY(prepare(run, r));
  s->h = choose_length(run, r);
  r->chosen = fabs(s->h);
  PL_TRY(hold_for_rows(run, r, &s->h, &s->projection));
  r->full = s->h;
  pl_radau_watch(run, r, s->h);
  pl_radau_series(run, r, s->h);
  PL_TRY(pl_radau_stop_at_switches(run, r, &s->h, &s->projection));
  while (run->setup->n_events > 0 && !pl_watch_is_followed(run, s->h)) {
    // an event that is faster than the motion
    s->h *= 0.5;
    if (!(fabs(s->h) > run->control.h_least)) return too_small(run, s->h);
    PL_TRY(hold_again(run, r, &s->h, &s->projection));
  }
  return PLEUEL_OK;
}

// What the next step begins with.
static void note_step(pl_run* run, pl_radau* r, const pl_stepper_step* s) {
  double next = r->next;
  r->h_last = s->h;
  r->error_last = fmax(r->error, 1e-2);
  r->newton_last = r->newton;
  // after a rejection no longer one; a step cut short for a time of output says nothing against a
  // longer one
  if (r->rejected) next = fmin(next, fabs(r->full));
  bool cut = !r->rejected && r->chosen < 0.99 * r->h && r->chosen == fabs(r->full);
  r->h = cut ? fmax(next, fmin(r->h, 8 * r->chosen)) : next;
  r->rejected = false;
  r->has_last = true;
  r->steps_in_row++;
  run->stats.steps_implicit++;
  if (run->options.method == PL_METHOD_AUTO && !cut && s->root < 0) pl_stiff_review(run, s->h);
}

pleuel_status pl_radau_state_at(pl_run* run, pl_stepper_step* s) {
  pl_radau* r = run->radau;
  s->found = true;
  if (s->root > 0) {
    pl_sizes_forget(&run->dae);
    PL_TRY(pl_radau_land(run, r, &s->h, &s->root, &s->projection));
    if (s->root == 0) return PLEUEL_OK;
  }
  note_step(run, r, s);
  s->wanted = s->h;
  return PLEUEL_OK;
}
