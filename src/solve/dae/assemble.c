// From the jets of the batches to the linear system: values of the matrix, constraint values.
// Right-hand sides: taylor_order.c.
#include "solve/dae/dae.h"

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
static void add_mass(pl_dae* dae, const pl_batch* b) {
  double* K = dae->kkt.value;
  for (int e = 0; e < b->pattern->n_mass; e++) {
    const pl_pattern_entry* m = &b->pattern->mass[e];
    const double* x = coefficient(b, node_of(b, m->root), 0);
    LANES(b) {
      K[b->at_mass[e * b->lanes + l]] += x[l];
      if (m->row != m->col) K[b->at_mass_t[e * b->lanes + l]] += x[l];
    }
  }
}

static void add_gradients(pl_dae* dae, const pl_batch* b, bool slips) {
  double* K = dae->kkt.value;
  for (int e = 0; e < b->pattern->n_G; e++) {
    const pl_pattern_entry* g = &b->pattern->G[e];
    const double* x = coefficient(b, node_of(b, g->root), 0);
    LANES(b) {
      int c = b->c[g->row * b->lanes + l];
      // the row of a constraint; the column of its force, and of friction that slips
      if (dae->taken[c]) K[b->at_G[e * b->lanes + l]] += x[l];
      if (dae->taken[c] || (slips && dae->slips[c])) K[b->at_Gt[e * b->lanes + l]] += x[l];
    }
  }
}

static void add_force_directions(pl_dae* dae, const pl_batch* b) {
  for (int e = 0; e < b->pattern->n_W; e++) {
    const pl_pattern_entry* w = &b->pattern->W[e];
    const double* x = coefficient(b, node_of(b, w->root), 0);
    LANES(b)
    if (dae->taken[b->c[w->col * b->lanes + l]]) dae->kkt.value[b->at_W[e * b->lanes + l]] += x[l];
  }
}

void pl_assemble_matrix(pl_dae* dae, bool with_W) {
  pl_kkt* k = &dae->kkt;
  bool slips = dae->n_slipping > 0 && (with_W || dae->impulsive);
  for (int i = 0; i < k->n_values; i++) k->value[i] = 0;
  for (int i = 0; i < dae->motion.n; i++) {
    add_mass(dae, &dae->motion.at[i]);
    add_gradients(dae, &dae->motion.at[i], slips);
    if (with_W) add_force_directions(dae, &dae->motion.at[i]);
  }
  dae->rests = false;
  for (int i = 0; i < dae->n_q; i++)
    if (dae->has_equation[i] == 0) {
      k->value[k->diagonal[i]] = 1;
      dae->rests = true;
    }  // nothing determines it: it rests
  for (int c = 0; c < dae->n_c; c++)
    if (!dae->taken[c]) {
      k->value[k->diagonal[dae->n_q + c]] = 1;
      dae->rests = true;
    }
  if (slips) pl_friction_matrix(dae);
}

void pl_assemble_rows(pl_dae* dae) {
  int m = 0;
  for (int c = 0; c < dae->n_c; c++) {
    dae->row_of[c] = -1;
    if (!dae->active[c]) continue;
    dae->priority[m] = dae->setup->constraints[c].priority;
    dae->row_of[c] = m++;
  }
  for (size_t i = 0; i < (size_t)m * (size_t)dae->n_q; i++) dae->rows[i] = 0;
  for (int i = 0; i < dae->motion.n; i++) {
    const pl_batch* b = &dae->motion.at[i];
    for (int e = 0; e < b->pattern->n_G; e++) {
      const pl_pattern_entry* g = &b->pattern->G[e];
      const double* x = coefficient(b, node_of(b, g->root), 0);
      LANES(b) {
        int row = dae->row_of[b->c[g->row * b->lanes + l]];
        if (row >= 0)
          dae->rows[(size_t)row * (size_t)dae->n_q + (size_t)b->q[g->col * b->lanes + l]] += x[l];
      }
    }
  }
}

void pl_assemble_row_sizes(pl_dae* dae) { pl_taylor_order_here()->row_sizes(dae); }

// ------------------------------------------------------------------------------------- constraints
static void clear(double* x, int n) {
  for (int i = 0; i < n; i++) x[i] = 0;
}

void pl_assemble_g(pl_dae* dae, int k, double* g, double* size) {
  pl_taylor_order_here()->g(dae, k, g, size);
}
void pl_assemble_gdot(pl_dae* dae, double* r, double* size) {
  pl_taylor_order_here()->gdot(dae, r, size);
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

void pl_assemble_rhs(pl_dae* dae, int k, double* rhs) {
  pl_taylor_order_here()->rhs(dae, k, rhs);
  if (dae->n_slipping > 0) pl_friction_rhs(dae, k, rhs);
}

void pl_assemble_slip(pl_dae* dae, int k, double* speed) {
  double s[PL_JET_LANES];
  clear(speed, dae->n_c);
  for (int i = 0; i < dae->motion.n; i++) {
    const pl_batch* b = &dae->motion.at[i];
    for (int e = 0; e < b->pattern->n_G; e++) {
      const pl_pattern_entry* g = &b->pattern->G[e];
      int node = node_of(b, g->root);
      if (!dae->setup->constraints[b->c[g->row * b->lanes]].slip) continue;
      const double *x = coefficient(b, node, 0), *v = v_of_slot(b, g->col);
      if (is_constant(b, node)) LANES(b) s[l] = 0;
      else tail(s, x, v, k, b->lanes);
      LANES(b) speed[b->c[g->row * b->lanes + l]] += s[l] + x[l] * v[k * b->lanes + l];
    }
    for (int e = 0; e < b->pattern->n_gt; e++) {
      const pl_pattern_entry* g = &b->pattern->gt[e];
      int node = node_of(b, g->root);
      if (!dae->setup->constraints[b->c[g->row * b->lanes]].slip || (k > 0 && is_constant(b, node)))
        continue;
      const double* x = coefficient(b, node, k);
      LANES(b) speed[b->c[g->row * b->lanes + l]] += x[l];
    }
  }
}

// What the largest force met would do to a coordinate: forces that cancel leave the rounding of
// that.
double pl_free_size(const pl_dae* dae, int i) {
  double mass = dae->kkt.value[dae->kkt.diagonal[i]];
  return mass > 0 && dae->has_equation[i] != 0 ? dae->force_size / mass : 0;
}

void pl_assemble_second(pl_dae* dae, const double* a, double* second, double* size) {
  clear(second, dae->n_c);
  clear(size, dae->n_c);
  for (int i = 0; i < dae->motion.n; i++) {
    const pl_batch* b = &dae->motion.at[i];
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
                   + fabs(x[l]) * pl_free_size(dae, b->q[g->col * b->lanes + l]);
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
