// What happens at every order of a series the general way: coefficients into lanes, right-hand
// sides, the coefficients that follow. This file is compiled for several kinds of processors
// (meson.build); sums have one order, so that all give the same bits.
//
// Order k of the equations of motion and of the constraint on velocity level, with q_{k+1} = v_k /
// (k+1) known:
//
//   M_0 a_k - (G_0^T + W_0) λ_k = -h_k - sum_{j>=1} M_j a_{k-j} + sum_{j>=1} (G_j^T + W_j) λ_{k-j}
//   G_0 a_k                     = -(k+1) [ sum_{j>=1} G_j v_{k+1-j} + (dg/dt)_{k+1} ]
//
// Entries of a row of G that are multiples of one node u, as u, -u of a rod, share their sums: u
// with the sum of multiples of velocities, u with λ.
// See theory (10.3).
#include <math.h>

#include "solve/dae/dae.h"

#ifndef PL_TAYLOR_ORDER
#  define PL_TAYLOR_ORDER pl_taylor_order_plain
#endif
extern const pl_taylor_order PL_TAYLOR_ORDER;

#ifdef __clang__
#  define APART _Pragma("clang loop vectorize(assume_safety)")
#else
#  define APART _Pragma("GCC ivdep")
#endif
#define INLINE  static inline __attribute__((always_inline))
#define EACH(n) APART for (int l = 0; l < (n); l++)

static const double* coefficient(const pl_batch* b, int node, int k) {
  return pl_jet_at(b->jet, node, k);
}
static int node_of(const pl_batch* b, int root) { return b->pattern->tape->roots[root]; }
static bool is_constant(const pl_batch* b, int node) {
  return node < b->pattern->tape->level_end[PL_LEVEL_CONST];
}

static double* series_at(const pl_batch* b, double* series, int slot, int k) {
  return series + ((size_t)slot * (size_t)b->orders + (size_t)k) * (size_t)b->lanes;
}

static double* v_of_slot(const pl_batch* b, int slot, int k) {
  return b->all_v ? series_at(b, b->v, slot, k) : b->v + (size_t)slot * (size_t)b->lanes;
}

// ----------------------------------------------------------------------------------------- loading
static void gather(double* restrict to, const double* restrict from, const int* restrict index,
                   int run, int n, int lanes) {
  if (run < 0) {
    EACH(lanes) to[l] = from[index[l]];
    return;
  }
  EACH(n) to[l] = from[run + l];
  for (int l = n; l < lanes; l++) to[l] = from[run + n - 1];
}

// Adds, or begins with, multiples of velocities.
INLINE void add_multiple(double* restrict to, const double* restrict f, const double* restrict v,
                         const int* restrict index, int run, const pl_batch* b, bool begins) {
  int direct = run < 0 ? 0 : b->n;  // the lanes behind repeat the last instance
  if (begins) {
    EACH(direct) to[l] = f[l] * v[run + l];
    for (int l = direct; l < b->lanes; l++) to[l] = f[l] * v[index[l]];
  } else {
    EACH(direct) to[l] += f[l] * v[run + l];
    for (int l = direct; l < b->lanes; l++) to[l] += f[l] * v[index[l]];
  }
}

// Coefficient k of the sums of multiples of velocities.
static void load_bundles(const pl_batch* b, const double* v, int k) {
  for (int t = 0; t < b->n_bundles; t++) {
    const pl_bundle* bundle = &b->bundles[t];
    double* to = series_at(b, b->bundle_v, t, k);
    for (int e = bundle->first; e < bundle->first + bundle->n; e++) {
      int slot = b->bundle_q[e];
      add_multiple(to, b->bundle_factor + (size_t)e * (size_t)b->lanes, v, b->q + slot * b->lanes,
                   b->q_run[slot], b, e == bundle->first);
    }
  }
}

// Slots of v are kept where something reads them: at order 0, in sums with slip, and by the sums of
// multiples.
static void load(pl_batches* bs, pl_series_kind what, const double* x, int k) {
  for (int i = 0; i < bs->n; i++) {
    const pl_batch* b = &bs->at[i];
    const pl_pattern* p = b->pattern;
    const int *index = what == PL_IS_LAMBDA ? b->c : b->q,
              *run = what == PL_IS_LAMBDA ? b->c_run : b->q_run;
    const int* node = what == PL_IS_Q   ? p->tape->q_node
                      : what == PL_IS_V ? p->tape->v_node
                      : what == PL_IS_A ? p->tape->a_node
                                        : p->tape->lambda_node;
    double* series = what == PL_IS_V        ? b->v
                     : what == PL_IS_A      ? b->a
                     : what == PL_IS_LAMBDA ? b->lambda
                                            : NULL;
    const bool* needs = what == PL_IS_V ? b->needs_v : what == PL_IS_A ? b->needs_a : NULL;
    int slots = what == PL_IS_LAMBDA ? p->n_c : p->n_q;
    for (int s = 0; s < slots; s++) {
      const int* at = index + s * b->lanes;
      if (series && (needs == NULL || needs[s]) && (what != PL_IS_V || k == 0 || b->all_v))
        gather(what == PL_IS_V ? v_of_slot(b, s, k) : series_at(b, series, s, k), x, at, run[s],
               b->n, b->lanes);
      if (node[s] >= 0) gather(pl_jet_at(b->jet, node[s], k), x, at, run[s], b->n, b->lanes);
    }
    if (what == PL_IS_V) load_bundles(b, x, k);
  }
}

// --------------------------------------------------------------------------------------- spreading
// Adds factor times x to the places of a slot.
INLINE void spread(double* restrict to, const double* restrict x, double factor, const int* index,
                   int run, int n) {
  if (run >= 0) EACH(n) to[run + l] += factor * x[l];
  else
    for (int l = 0; l < n; l++) to[index[l]] += factor * x[l];
}

static void spread_q(const pl_batch* b, double* rhs, const double* x, double factor, int slot) {
  spread(rhs, x, factor, b->q + slot * b->lanes, b->q_run[slot], b->n);
}

static void spread_c(const pl_dae* dae, const pl_batch* b, double* rhs, const double* x,
                     double factor, int slot) {
  spread(rhs + dae->n_q, x, factor, b->c + slot * b->lanes, b->c_run[slot], b->n);
}

// -------------------------------------------------------------------------------------------- sums
typedef double pl_eight __attribute__((vector_size(64), aligned(8), may_alias));
#define AT(x, row) (*(const pl_eight*)((x) + (size_t)(row) * (size_t)lanes))

// s = sum_{j=1..k} x_j y_{k-j}
static void tail(double* s, const double* x, const double* y, int k, int lanes) {
  if (lanes == 1) {
    s[0] = 0;
    for (int j = 1; j <= k; j++) s[0] += x[j] * y[k - j];
    return;
  }
  for (int first = 0; first < lanes; first += 8) {
    pl_eight sum = {0};
    for (int j = 1; j <= k; j++) sum += AT(x + first, j) * AT(y + first, k - j);
    *(pl_eight*)(s + first) = sum;
  }
}

// with_v = sum_{j=1..k+1} u_j v_{k+1-j},  with_lambda = sum_{j=1..k} u_j λ_{k-j}
static void bundle_sums(double* with_v, double* with_lambda, const double* u, const double* v,
                        const double* lambda, int k, int lanes) {
  if (lanes == 1) {
    double sum = 0, other = 0;
    for (int j = 1; j <= k; j++) {
      sum += u[j] * v[k + 1 - j];
      other += u[j] * lambda[k - j];
    }
    *with_v = sum + u[k + 1] * v[0];
    *with_lambda = other;
    return;
  }
  for (int first = 0; first < lanes; first += 8) {
    const double *a = u + first, *b = v + first, *c = lambda + first;
    pl_eight sum = {0}, other = {0};
    for (int j = 1; j <= k; j++) {
      pl_eight x = AT(a, j);
      sum += x * AT(b, k + 1 - j);
      other += x * AT(c, k - j);
    }
    *(pl_eight*)(with_v + first) = sum + AT(a, k + 1) * AT(b, 0);
    *(pl_eight*)(with_lambda + first) = other;
  }
}

// --------------------------------------------------------------------------------- right-hand side
static void subtract_h(pl_dae* dae, const pl_batch* b, int k, double* rhs) {
  for (int e = 0; e < b->pattern->n_h; e++) {
    const pl_pattern_entry* h = &b->pattern->h[e];
    int node = node_of(b, h->root);
    if (k > 0 && is_constant(b, node)) continue;
    const double* x = coefficient(b, node, k);
    spread_q(b, rhs, x, -1, h->row);
    for (int l = 0; l < b->n && k == 0; l++)
      if (fabs(x[l]) > dae->force_size) dae->force_size = fabs(x[l]);
  }
}

static void subtract_mass_tail(const pl_batch* b, int k, double* rhs) {
  double s[PL_JET_LANES];
  for (int e = 0; e < b->pattern->n_mass; e++) {
    const pl_pattern_entry* m = &b->pattern->mass[e];
    int node = node_of(b, m->root);
    if (is_constant(b, node)) continue;
    const double* x = coefficient(b, node, 0);
    tail(s, x, series_at(b, b->a, m->col, 0), k, b->lanes);
    spread_q(b, rhs, s, -1, m->row);
    if (m->row == m->col) continue;
    tail(s, x, series_at(b, b->a, m->row, 0), k, b->lanes);
    spread_q(b, rhs, s, -1, m->col);
  }
}

// λ is zero where a constraint is not used.
static void add_bundles(const pl_dae* dae, const pl_batch* b, int k, double* rhs) {
  double with_v[PL_JET_LANES], with_lambda[PL_JET_LANES], s[PL_JET_LANES];
  int lanes = b->lanes;
  for (int t = 0; t < b->n_bundles; t++) {
    const pl_bundle* bundle = &b->bundles[t];
    bundle_sums(with_v, with_lambda, coefficient(b, bundle->node, 0),
                series_at(b, b->bundle_v, t, 0), series_at(b, b->lambda, bundle->c, 0), k, lanes);
    spread_c(dae, b, rhs, with_v, -(k + 1), bundle->c);
    for (int e = bundle->first; k > 0 && e < bundle->first + bundle->n; e++) {
      const double* f = b->bundle_factor + (size_t)e * (size_t)lanes;
      EACH(lanes) s[l] = f[l] * with_lambda[l];
      spread_q(b, rhs, s, 1, b->bundle_q[e]);
    }
  }
}

static void add_force_tail(const pl_dae* dae, const pl_batch* b, int k, double* rhs) {
  double s[PL_JET_LANES];
  for (int e = 0; e < b->pattern->n_W; e++) {
    const pl_pattern_entry* w = &b->pattern->W[e];
    int node = node_of(b, w->root);
    if (is_constant(b, node)) continue;
    tail(s, coefficient(b, node, 0), series_at(b, b->lambda, w->col, 0), k, b->lanes);
    for (int l = 0; l < b->n; l++)
      if (dae->taken[b->c[w->col * b->lanes + l]]) rhs[b->q[w->row * b->lanes + l]] += s[l];
  }
}

static void subtract_time(const pl_dae* dae, const pl_batch* b, int k, double* rhs) {
  for (int e = 0; e < b->pattern->n_gt; e++) {
    const pl_pattern_entry* g = &b->pattern->gt[e];
    int node = node_of(b, g->root);
    if (!is_constant(b, node)) spread_c(dae, b, rhs, coefficient(b, node, k + 1), -(k + 1), g->row);
  }
}

static void rhs_of(pl_dae* dae, int k, double* rhs) {
  for (int i = 0; i < dae->n_q + dae->n_c; i++) rhs[i] = 0;
  for (int i = 0; i < dae->motion.n; i++) {
    const pl_batch* b = &dae->motion.at[i];
    subtract_h(dae, b, k, rhs);
    if (k > 0) subtract_mass_tail(b, k, rhs);
    add_bundles(dae, b, k, rhs);
    if (k > 0) add_force_tail(dae, b, k, rhs);
    subtract_time(dae, b, k, rhs);
  }
  if (!dae->rests) return;
  for (int i = 0; i < dae->n_q; i++)
    if (dae->has_equation[i] == 0) rhs[i] = 0;
  for (int c = 0; c < dae->n_c; c++)
    if (!dae->taken[c]) rhs[dae->n_q + c] = 0;
}

// ------------------------------------------------------------------------------------ coefficients
// x / k is x times the rounded 1 / k and the rest of it.
typedef struct pl_ratio_of {
  double ratio, rest;
} pl_ratio_of;
INLINE pl_ratio_of one_over(int k) {
  double ratio = 1.0 / k;
  return (pl_ratio_of){ratio, __builtin_fma(-ratio, k, 1) * ratio};
}
#define TIMES(x, r) __builtin_fma((x), (r).ratio, (x) * (r).rest)

static void over(double* restrict to, const double* restrict from, int by, int n) {
  pl_ratio_of r = one_over(by);
  EACH(n) to[l] = TIMES(from[l], r);
}

// a_k from the solution; with it v_{k+1} and q_{k+2}.
static void take(pl_dae* dae, int k) {
  int n = dae->n_q;
  double* restrict a = dae->A + (size_t)k * (size_t)n, * restrict v = dae->V
                                                                      + (size_t)(k + 1) * (size_t)n;
  double* restrict q = dae->Q + (size_t)(k + 2) * (size_t)n, * restrict lambda =
                                                                 dae->L
                                                                 + (size_t)k * (size_t)dae->n_c;
  const double* restrict x = dae->rhs, * restrict y = dae->rhs + n;
  pl_ratio_of r = one_over(k + 1), s = one_over(k + 2);
  EACH(n) {
    a[l] = x[l];
    v[l] = TIMES(x[l], r);
    q[l] = TIMES(v[l], s);
  }
  if (dae->rests) {
    for (int c = 0; c < dae->n_c; c++) lambda[c] = dae->taken[c] || dae->slips[c] ? -y[c] : 0;
  } else {
    EACH(dae->n_c) lambda[l] = -y[l];
  }
}

static void horner(const double* X, int n, int last, double dt, double* restrict x) {
  enum { STRIP = 64 };
  for (int from = 0; from < n; from += STRIP) {
    int count = n - from < STRIP ? n - from : STRIP;
    double* restrict to = x + from;
    const double* top = X + (size_t)last * (size_t)n + (size_t)from;
    EACH(count) to[l] = top[l];
    for (int k = last - 1; k >= 0; k--) {
      const double* restrict row = X + (size_t)k * (size_t)n + (size_t)from;
      EACH(count) to[l] = to[l] * dt + row[l];
    }
  }
}

static double norm(const double* x, int n) {
  double most[8] = {0}, wrong[8] = {0};
  int whole = n / 8 * 8;
  for (int i = 0; i < whole; i += 8) {
    const double* y = x + i;
    EACH(8) {
      double size = fabs(y[l]);
      most[l] = size > most[l] ? size : most[l];
      wrong[l] += 0 * y[l];  // not a number once y is none, or infinite
    }
  }
  for (int i = whole; i < n; i++) {
    most[0] = fabs(x[i]) > most[0] ? fabs(x[i]) : most[0];
    wrong[0] += 0 * x[i];
  }
  double all = most[0], none = wrong[0];
  for (int l = 1; l < 8; l++) {
    all = most[l] > all ? most[l] : all;
    none += wrong[l];
  }
  if (none == 0) return all;
  for (int i = 0; i < n; i++)
    if (isnan(x[i])) return x[i];
  return all;
}

// A size that is no number is not noted.
static double note(double* restrict most, const double* restrict x, int n) {
  double largest[8] = {0}, all = 0;
  int whole = n / 8 * 8;
  for (int i = 0; i < whole; i += 8) EACH(8) {
      double size = fabs(x[i + l]);
      most[i + l] = size > most[i + l] ? size : most[i + l];
      largest[l] = most[i + l] > largest[l] ? most[i + l] : largest[l];
    }
  for (int i = whole; i < n; i++) {
    most[i] = fabs(x[i]) > most[i] ? fabs(x[i]) : most[i];
    largest[0] = most[i] > largest[0] ? most[i] : largest[0];
  }
  for (int l = 0; l < 8; l++) all = largest[l] > all ? largest[l] : all;
  return all;
}

// ------------------------------------------------------------------------------------- constraints
INLINE double larger(double a, double b) { return a > b ? a : b; }

static void clear(double* x, int n) {
  for (int i = 0; i < n; i++) x[i] = 0;
}

// The sizes of the terms G_ce x_e, with |x| the largest that it has been and a floor where it never
// moved.
static void add_sizes(const pl_batch* b, const double* restrict most, double floor,
                      double* restrict size) {
  for (int e = 0; e < b->pattern->n_G; e++) {
    const pl_pattern_entry* g = &b->pattern->G[e];
    const double* restrict x = coefficient(b, node_of(b, g->root), 0);
    const int *c = b->c + g->row * b->lanes, *q = b->q + g->col * b->lanes;
    int c_run = b->c_run[g->row], q_run = b->q_run[g->col];
    if (c_run >= 0 && q_run >= 0)
      EACH(b->n) size[c_run + l] += fabs(x[l]) * larger(most[q_run + l], floor);
    else
      for (int l = 0; l < b->n; l++) size[c[l]] += fabs(x[l]) * larger(most[q[l]], floor);
  }
}

static void values_of_g(const pl_batch* b, int k, double* g, double* size) {
  double s[PL_JET_LANES];
  for (int e = 0; e < b->pattern->n_g; e++) {
    const pl_pattern_entry* p = &b->pattern->g[e];
    int node = node_of(b, p->root);
    if (k == 0 || !is_constant(b, node))
      spread(g, coefficient(b, node, k), 1, b->c + p->row * b->lanes, b->c_run[p->row], b->n);
    if (size == NULL || p->col < 0) continue;
    const double* x = coefficient(b, node_of(b, p->col), 0);
    EACH(b->lanes) s[l] = x[l];
    spread(size, s, 1, b->c + p->row * b->lanes, b->c_run[p->row], b->n);
  }
}

// Sizes hold what rounding of the coordinates themselves does to g too, |dg/dq| |q|, which the
// terms need not show (r cos φ after many turns).
static void g_of(pl_dae* dae, int k, double* g, double* size) {
  static const double part = 1e-6;  // of the largest coordinate of all
  clear(g, dae->n_c);
  if (size) clear(size, dae->n_c);
  for (int i = 0; i < dae->motion.n; i++) values_of_g(&dae->motion.at[i], k, g, size);
  if (size == NULL) return;
  for (int c = 0; c < dae->n_c; c++) dae->argument[c] = size[c];
  for (int i = 0; i < dae->motion.n; i++)
    add_sizes(&dae->motion.at[i], dae->q_most, part * dae->q_size, size);
  for (int c = 0; c < dae->n_c; c++)
    dae->argument[c] = dae->argument[c] > 0 ? size[c] / dae->argument[c] : 1;
}

static void gdot_of(pl_dae* dae, double* r, double* size) {
  double s[PL_JET_LANES];
  clear(r, dae->n_c);
  clear(size, dae->n_c);
  for (int i = 0; i < dae->motion.n; i++) {
    const pl_batch* b = &dae->motion.at[i];
    for (int e = 0; e < b->pattern->n_G; e++) {
      const pl_pattern_entry* g = &b->pattern->G[e];
      const double *x = coefficient(b, node_of(b, g->root), 0), *v = v_of_slot(b, g->col, 0);
      EACH(b->lanes) s[l] = x[l] * v[l];
      spread(r, s, 1, b->c + g->row * b->lanes, b->c_run[g->row], b->n);
    }
    add_sizes(b, dae->v_most, 1e-6 * dae->v_size, size);
    for (int e = 0; e < b->pattern->n_gt; e++) {
      const pl_pattern_entry* g = &b->pattern->gt[e];
      const double* x = coefficient(b, node_of(b, g->root), 0);
      spread(r, x, 1, b->c + g->row * b->lanes, b->c_run[g->row], b->n);
      EACH(b->lanes) s[l] = fabs(x[l]);
      spread(size, s, 1, b->c + g->row * b->lanes, b->c_run[g->row], b->n);
    }
  }
  // the gradient feels the rounding of coordinates as much as g itself does
  for (int c = 0; c < dae->n_c; c++) size[c] *= larger(dae->argument[c], 1);
}

static void row_sizes(pl_dae* dae) {
  clear(dae->row_most, dae->n_c);
  for (int i = 0; i < dae->motion.n; i++) {
    const pl_batch* b = &dae->motion.at[i];
    for (int e = 0; e < b->pattern->n_G; e++) {
      const pl_pattern_entry* g = &b->pattern->G[e];
      const double* restrict x = coefficient(b, node_of(b, g->root), 0);
      const int* c = b->c + g->row * b->lanes;
      int c_run = b->c_run[g->row];
      double* restrict most = dae->row_most;
      if (c_run >= 0) EACH(b->n) most[c_run + l] = larger(fabs(x[l]), most[c_run + l]);
      else
        for (int l = 0; l < b->n; l++) most[c[l]] = larger(fabs(x[l]), most[c[l]]);
    }
  }
}

const pl_taylor_order PL_TAYLOR_ORDER = {load, rhs_of, take, over,    horner,
                                         norm, note,   g_of, gdot_of, row_sizes};
