// From the jets of the batches to the linear system: values of the matrix, constraint values.
// Right-hand sides: taylor_order.c.
#include "solve/solve_impl.h"

#include <math.h>

#define LANES(b) for (int l = 0; l < (b)->n; l++)

static int node_of(const pl_batch* b, int root) { return b->pattern->tape->roots[root]; }
static bool is_constant(const pl_batch* b, int node) {
  return node < b->pattern->tape->level_end[PL_LEVEL_CONST];
}
static const double* coefficient(const pl_batch* b, int node, int k) {
  return pl_jet_at(b->jet, node, k);
}

// ------------------------------------------------------------------------------------------ matrix
static void add_mass(pl_run* run, const pl_batch* b) {
  double* K = run->kkt.value;
  for (int e = 0; e < b->pattern->n_mass; e++) {
    const pl_pattern_entry* m = &b->pattern->mass[e];
    const double* x = coefficient(b, node_of(b, m->root), 0);
    LANES(b) {
      K[b->at_mass[e * b->lanes + l]] += x[l];
      if (m->row != m->col) K[b->at_mass_t[e * b->lanes + l]] += x[l];
    }
  }
}

static void add_gradients(pl_run* run, const pl_batch* b, bool slips) {
  double* K = run->kkt.value;
  for (int e = 0; e < b->pattern->n_G; e++) {
    const pl_pattern_entry* g = &b->pattern->G[e];
    const double* x = coefficient(b, node_of(b, g->root), 0);
    LANES(b) {
      int c = b->c[g->row * b->lanes + l];
      // the row of a constraint; the column of its force, and of friction that slips
      if (run->taken[c]) K[b->at_G[e * b->lanes + l]] += x[l];
      if (run->taken[c] || (slips && run->slips[c])) K[b->at_Gt[e * b->lanes + l]] += x[l];
    }
  }
}

static void add_force_directions(pl_run* run, const pl_batch* b) {
  for (int e = 0; e < b->pattern->n_W; e++) {
    const pl_pattern_entry* w = &b->pattern->W[e];
    const double* x = coefficient(b, node_of(b, w->root), 0);
    LANES(b)
    if (run->taken[b->c[w->col * b->lanes + l]]) run->kkt.value[b->at_W[e * b->lanes + l]] += x[l];
  }
}

void pl_assemble_matrix(pl_run* run, bool with_W) {
  pl_kkt* k = &run->kkt;
  bool slips = run->n_slipping > 0 && (with_W || run->impulsive);
  for (int i = 0; i < k->n_values; i++) k->value[i] = 0;
  for (int i = 0; i < run->motion.n; i++) {
    add_mass(run, &run->motion.at[i]);
    add_gradients(run, &run->motion.at[i], slips);
    if (with_W) add_force_directions(run, &run->motion.at[i]);
  }
  run->rests = false;
  for (int i = 0; i < run->n_q; i++)
    if (run->has_equation[i] == 0) {
      k->value[k->diagonal[i]] = 1;
      run->rests = true;
    }  // nothing determines it: it rests
  for (int c = 0; c < run->n_c; c++)
    if (!run->taken[c]) {
      k->value[k->diagonal[run->n_q + c]] = 1;
      run->rests = true;
    }
  if (slips) pl_friction_matrix(run);
}

void pl_assemble_rows(pl_run* run) {
  int m = 0;
  for (int c = 0; c < run->n_c; c++) {
    run->row_of[c] = -1;
    if (!run->active[c]) continue;
    run->priority[m] = run->setup->constraints[c].priority;
    run->row_of[c] = m++;
  }
  for (size_t i = 0; i < (size_t)m * (size_t)run->n_q; i++) run->rows[i] = 0;
  for (int i = 0; i < run->motion.n; i++) {
    const pl_batch* b = &run->motion.at[i];
    for (int e = 0; e < b->pattern->n_G; e++) {
      const pl_pattern_entry* g = &b->pattern->G[e];
      const double* x = coefficient(b, node_of(b, g->root), 0);
      LANES(b) {
        int row = run->row_of[b->c[g->row * b->lanes + l]];
        if (row >= 0)
          run->rows[(size_t)row * (size_t)run->n_q + (size_t)b->q[g->col * b->lanes + l]] += x[l];
      }
    }
  }
}

void pl_assemble_row_sizes(pl_run* run) { pl_taylor_order_here()->row_sizes(run); }

// ------------------------------------------------------------------------------------- constraints
static void clear(double* x, int n) {
  for (int i = 0; i < n; i++) x[i] = 0;
}

void pl_assemble_g(pl_run* run, int k, double* g, double* size) {
  pl_taylor_order_here()->g(run, k, g, size);
}
void pl_assemble_gdot(pl_run* run, double* r, double* size) {
  pl_taylor_order_here()->gdot(run, r, size);
}

// --------------------------------------------------------------------------------- right-hand side
// s = sum_{j=1..k} x_j y_{k-j} in every lane; x from the jet, y a series of a slot.
static void tail(double* s, const double* x, const double* y, int k, int lanes) {
  for (int l = 0; l < lanes; l++) s[l] = 0;
  for (int j = 1; j <= k; j++)
    for (int l = 0; l < lanes; l++) s[l] += x[j * lanes + l] * y[(k - j) * lanes + l];
}

static const double* v_of_slot(const pl_batch* b, int slot) {
  return b->v + (size_t)slot * (size_t)(b->all_v ? b->orders : 1) * (size_t)b->lanes;
}

void pl_assemble_rhs(pl_run* run, int k, double* rhs) {
  pl_taylor_order_here()->rhs(run, k, rhs);
  if (run->n_slipping > 0) pl_friction_rhs(run, k, rhs);
}

void pl_assemble_slip(pl_run* run, int k, double* speed) {
  double s[PL_JET_LANES];
  clear(speed, run->n_c);
  for (int i = 0; i < run->motion.n; i++) {
    const pl_batch* b = &run->motion.at[i];
    for (int e = 0; e < b->pattern->n_G; e++) {
      const pl_pattern_entry* g = &b->pattern->G[e];
      int node = node_of(b, g->root);
      if (!run->setup->constraints[b->c[g->row * b->lanes]].slip) continue;
      const double *x = coefficient(b, node, 0), *v = v_of_slot(b, g->col);
      if (is_constant(b, node)) LANES(b) s[l] = 0;
      else tail(s, x, v, k, b->lanes);
      LANES(b) speed[b->c[g->row * b->lanes + l]] += s[l] + x[l] * v[k * b->lanes + l];
    }
    for (int e = 0; e < b->pattern->n_gt; e++) {
      const pl_pattern_entry* g = &b->pattern->gt[e];
      int node = node_of(b, g->root);
      if (!run->setup->constraints[b->c[g->row * b->lanes]].slip || (k > 0 && is_constant(b, node)))
        continue;
      const double* x = coefficient(b, node, k);
      LANES(b) speed[b->c[g->row * b->lanes + l]] += x[l];
    }
  }
}

// What the largest force met would do to a coordinate: forces that cancel leave the rounding of
// that.
double pl_free_size(const pl_run* run, int i) {
  double mass = run->kkt.value[run->kkt.diagonal[i]];
  return mass > 0 && run->has_equation[i] != 0 ? run->force_size / mass : 0;
}

void pl_assemble_second(pl_run* run, const double* a, double* second, double* size) {
  clear(second, run->n_c);
  clear(size, run->n_c);
  for (int i = 0; i < run->motion.n; i++) {
    const pl_batch* b = &run->motion.at[i];
    for (int e = 0; e < b->pattern->n_G; e++) {
      const pl_pattern_entry* g = &b->pattern->G[e];
      int node = node_of(b, g->root);
      const double *x = coefficient(b, node, 0), *v = v_of_slot(b, g->col);
      const double* slope = is_constant(b, node) ? NULL : coefficient(b, node, 1);
      LANES(b) {
        int c = b->c[g->row * b->lanes + l];
        double forced = x[l] * a[b->q[g->col * b->lanes + l]],
               turning = slope ? slope[l] * v[l] : 0;
        second[c] += forced + turning;
        size[c] += fabs(forced) + fabs(turning)
                   + fabs(x[l]) * pl_free_size(run, b->q[g->col * b->lanes + l]);
      }
    }
    for (int e = 0; e < b->pattern->n_gt; e++) {
      const pl_pattern_entry* g = &b->pattern->gt[e];
      int node = node_of(b, g->root);
      if (is_constant(b, node)) continue;
      const double* x = coefficient(b, node, 1);
      LANES(b) {
        int c = b->c[g->row * b->lanes + l];
        second[c] += x[l];
        size[c] += fabs(x[l]);
      }
    }
  }
}
