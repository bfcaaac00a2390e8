// Active set: the constraints in force, a maximal independent subset of them, and the multipliers
// which that determines.
//
// Rows are compared after scaling each column with the largest entry it has had in the run: a fixed
// yardstick, so that a column that fades away (a singular position) is seen to fade.
#include "solve/dae/dae.h"

#include <math.h>

// of a row of length 1: what is left of a row that says nothing new
static const double dependent_below = 1e-9;

static bool too_many_to_examine(const pl_dae* dae) { return dae->n_active > PL_RANK_UP_TO; }

// -------------------------------------------------------------------------------------- active set
static bool touches(const pl_dae* dae, const pl_batch* b, const pl_pattern_entry* e, int l) {
  return dae->active[b->c[e->row * b->lanes + l]];
}

// A coordinate without mass, force and active constraint rests; an equation 1 a = 0 stands for it.
static void find_orphans(pl_dae* dae) {
  for (int i = 0; i < dae->n_q; i++) dae->has_equation[i] = 0;
  for (int i = 0; i < dae->motion.n; i++) {
    const pl_batch* b = &dae->motion.at[i];
    const pl_pattern* p = b->pattern;
    for (int l = 0; l < b->n; l++) {
      for (int e = 0; e < p->n_mass; e++)
        dae->has_equation[b->q[p->mass[e].row * b->lanes + l]] = 1;
      for (int e = 0; e < p->n_mass; e++)
        dae->has_equation[b->q[p->mass[e].col * b->lanes + l]] = 1;
      for (int e = 0; e < p->n_h; e++) dae->has_equation[b->q[p->h[e].row * b->lanes + l]] = 1;
      for (int e = 0; e < p->n_G; e++)
        if (touches(dae, b, &p->G[e], l)) dae->has_equation[b->q[p->G[e].col * b->lanes + l]] = 1;
    }
  }
  for (int i = 0; i < dae->n_q; i++)
    if (dae->has_equation[i] == 0) dae->v[i] = 0;
}

// What a row goes with is there: its contact, and what a map takes for granted.
static bool stands(const pl_dae* dae, const pl_constraint_setup* l) {
  if (l->contact >= 0 && (!dae->on[l->contact] || dae->rebounds[l->contact])) return false;
  for (int i = 0; i < l->n_needs; i++)
    if (!dae->on[l->needs[i]] || dae->rebounds[l->needs[i]]) return false;
  return true;
}

void pl_active_set_update(pl_dae* dae) {
  const pl_constraint_setup* constraint = dae->setup->constraints;
  dae->n_active = 0;
  for (int c = 0; c < dae->n_c; c++) {
    dae->active[c] = dae->on[c] && !constraint[c].slip && stands(dae, &constraint[c]);
    dae->n_active += dae->active[c];
  }
  pl_friction_activate(dae);
  find_orphans(dae);
  dae->by_pivots = too_many_to_examine(dae)
                   || (double)dae->n_active * dae->n_active * dae->n_q > PL_RANK_WORK;
  dae->rank_mode = -1;  // a new mode: rank and yardstick start anew
  dae->best = 0;
  dae->smallest_before = 0;
}

// ------------------------------------------------------------------------------------ independence
static void scale_columns(pl_dae* dae, int m) {
  int n = dae->n_q;
  for (int r = 0; r < m; r++) {
    double* row = dae->rows + (size_t)r * (size_t)n;
    double most = 0;
    for (int j = 0; j < n; j++) most = fabs(row[j]) > most ? fabs(row[j]) : most;
    for (int j = 0; j < n && most > 0; j++)
      if (fabs(row[j]) > most * dae->column[j]) dae->column[j] = fabs(row[j]) / most;
  }
  for (int r = 0; r < m; r++)
    for (int j = 0; j < n; j++)
      if (dae->column[j] > 0) dae->rows[(size_t)r * (size_t)n + (size_t)j] /= dae->column[j];
}

static double row_length(const double* row, int n) {
  double most = 0, sum = 0;
  for (int j = 0; j < n; j++) most = fabs(row[j]) > most ? fabs(row[j]) : most;
  for (int j = 0; j < n && most > 0; j++) sum += (row[j] / most) * (row[j] / most);
  return most * sqrt(sum);
}

// Each row against the longest that it has been: a gradient may vanish all by itself.
static void measure_rows(pl_dae* dae) {
  for (int c = 0; c < dae->n_c; c++) {
    if (dae->row_of[c] < 0) continue;
    double length = row_length(dae->rows + (size_t)dae->row_of[c] * (size_t)dae->n_q, dae->n_q);
    dae->row_long[c] = fmax(dae->row_long[c], length);
    dae->row_part[c] = dae->row_long[c] > 0 ? length / dae->row_long[c] : 1;
  }
}

static double faintest_taken(const pl_dae* dae) {
  double least = 1;
  for (int c = 0; c < dae->n_c; c++)
    if (dae->taken[c]) least = fmin(least, dae->row_part[c]);
  return least;
}

// Whether the pivots of the whole system say that no active row depends on others: a large system
// is factored in no time.
static bool pivots_of_all_rows_are_sound(pl_dae* dae) {
  static const double sound = 1e-8;  // part of a pivot; as the square of the part of a row
  if (!dae->by_pivots || dae->kkt.symmetric == NULL) return false;
  for (int c = 0; c < dae->n_c; c++) dae->taken[c] = dae->active[c];
  pl_assemble_matrix(dae, false);
  return pl_symmetric_factor(dae->kkt.symmetric, dae->kkt.value) > sound;
}

static void examine(pl_dae* dae) {
  pl_assemble_rows(dae);
  scale_columns(dae, dae->n_active);
  measure_rows(dae);
  dae->rank = pl_independent_rows(dae->rows, dae->priority, dae->row_taken, dae->rank_work,
                                  dae->n_active, dae->n_q, dependent_below, &dae->smallest);
  for (int c = 0; c < dae->n_c; c++)
    dae->taken[c] = dae->row_of[c] >= 0 && dae->row_taken[dae->row_of[c]];
  dae->smallest *= faintest_taken(dae);
}

void pl_active_set_choose(pl_dae* dae) {
  if (dae->by_pivots && dae->rank_mode >= 0) return;  // chosen when the mode began
  if (too_many_to_examine(dae)) {
    for (int c = 0; c < dae->n_c; c++) dae->taken[c] = dae->active[c];
    dae->rank = dae->n_active;
    return;
  }
  if (pivots_of_all_rows_are_sound(dae)) {
    dae->rank = dae->n_active;
    return;
  }
  examine(dae);
  // where later steps look at pivots of the whole system, those are the yardstick, not this measure
  // of rows
  if (!dae->by_pivots && dae->smallest > dae->best) dae->best = dae->smallest;
}

bool pl_active_set_pivot(pl_dae* dae, double* smallest) {
  if (too_many_to_examine(dae)) return false;
  int rank = dae->rank;
  double here = dae->smallest;
  for (int c = 0; c < dae->n_c; c++) dae->taken_kept[c] = dae->taken[c];
  examine(dae);
  *smallest = dae->rank < rank ? 0 : dae->smallest;
  dae->rank = rank;
  dae->smallest = here;
  for (int c = 0; c < dae->n_c; c++) dae->taken[c] = dae->taken_kept[c];
  return true;
}

// -------------------------------------------------------------------------------------- uniqueness
// The declared rows that a left-out declared row is a combination of: least squares on the
// transposed taken rows. Equations that only define coordinates (priority above 0) carry no force
// of their own and do not count.
static void mark_partners(pl_dae* dae, const int* taken_row, int n_taken, int left_out) {
  int n = dae->n_q;
  double* b = dae->dep_norm + 2 * (size_t)dae->n_c;
  const double* row = dae->rows + (size_t)left_out * (size_t)n;
  double length = 0;
  for (int j = 0; j < n; j++) b[j] = row[j];
  for (int j = 0; j < n; j++) length = fmax(length, fabs(row[j]));
  pl_qr_least_squares(dae->dep, dae->dep_tau, b, n, n_taken);
  for (int i = 0; i < n_taken; i++) {
    int r = taken_row[dae->dep_jpvt[i]];
    if (fabs(b[i]) <= 1e-7 * length) continue;
    for (int c = 0; c < dae->n_c; c++)
      if (dae->row_of[c] == r) dae->unique[c] = false;
  }
}

static void mark_dependent(pl_dae* dae) {
  if (dae->rank == dae->n_active || too_many_to_examine(dae)) return;
  // the rows again, unreduced and not scaled by columns
  pl_assemble_rows(dae);
  int n = dae->n_q, n_taken = 0, *taken_row = dae->dep_jpvt + dae->n_c;
  for (int c = 0; c < dae->n_c; c++)
    if (dae->taken[c] && dae->setup->constraints[c].priority == 0)
      taken_row[n_taken++] = dae->row_of[c];
  for (int i = 0; i < n_taken; i++)
    for (int j = 0; j < n; j++)
      dae->dep[(size_t)i * (size_t)n + (size_t)j] =
          dae->rows[(size_t)taken_row[i] * (size_t)n + (size_t)j];
  pl_qr_factor(dae->dep, dae->dep_jpvt, dae->dep_tau, dae->dep_norm, n, n_taken, 0);
  for (int c = 0; c < dae->n_c; c++) {
    if (!dae->active[c] || dae->taken[c]) continue;
    dae->unique[c] = false;
    if (dae->setup->constraints[c].priority == 0)
      mark_partners(dae, taken_row, n_taken, dae->row_of[c]);
  }
}

void pl_active_set_note(pl_dae* dae) {
  for (int c = 0; c < dae->n_c; c++)
    dae->ever_several[c] |= !dae->unique[c] && dae->setup->constraints[c].column != NULL;
}

void pl_active_set_unique(pl_dae* dae) {
  for (int c = 0; c < dae->n_c; c++) dae->unique[c] = !dae->several[c];
  mark_dependent(dae);
  pl_active_set_note(dae);
}
