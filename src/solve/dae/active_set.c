// Which constraints are in force, which of them are independent, and which multipliers that
// determines.
//
// Rows are compared after scaling each column with the largest entry it has had in the run: a fixed
// yardstick, so that a column that fades away (a singular position) is seen to fade.
#include "solve/solve_impl.h"

#include <math.h>

// of a row of length 1: what is left of a row that says nothing new
static const double dependent_below = 1e-9;

static bool too_many_to_examine(const pl_run* run) { return run->n_active > PL_RANK_UP_TO; }

// -------------------------------------------------------------------------------------- active set
static bool touches(const pl_run* run, const pl_batch* b, const pl_pattern_entry* e, int l) {
  return run->active[b->c[e->row * b->lanes + l]];
}

// A coordinate without mass, force and active constraint rests; an equation 1 a = 0 stands for it.
static void find_orphans(pl_run* run) {
  for (int i = 0; i < run->n_q; i++) run->has_equation[i] = 0;
  for (int i = 0; i < run->motion.n; i++) {
    const pl_batch* b = &run->motion.at[i];
    const pl_pattern* p = b->pattern;
    for (int l = 0; l < b->n; l++) {
      for (int e = 0; e < p->n_mass; e++)
        run->has_equation[b->q[p->mass[e].row * b->lanes + l]] = 1;
      for (int e = 0; e < p->n_mass; e++)
        run->has_equation[b->q[p->mass[e].col * b->lanes + l]] = 1;
      for (int e = 0; e < p->n_h; e++) run->has_equation[b->q[p->h[e].row * b->lanes + l]] = 1;
      for (int e = 0; e < p->n_G; e++)
        if (touches(run, b, &p->G[e], l)) run->has_equation[b->q[p->G[e].col * b->lanes + l]] = 1;
    }
  }
  for (int i = 0; i < run->n_q; i++)
    if (run->has_equation[i] == 0) run->v[i] = 0;
}

// What a row goes with is there: its contact, and what a map takes for granted.
static bool stands(const pl_run* run, const pl_constraint_setup* l) {
  if (l->contact >= 0 && (!run->on[l->contact] || run->rebounds[l->contact])) return false;
  for (int i = 0; i < l->n_needs; i++)
    if (!run->on[l->needs[i]] || run->rebounds[l->needs[i]]) return false;
  return true;
}

void pl_active_set_update(pl_run* run) {
  const pl_constraint_setup* constraint = run->setup->constraints;
  run->n_active = 0;
  for (int c = 0; c < run->n_c; c++) {
    run->active[c] = run->on[c] && !constraint[c].slip && stands(run, &constraint[c]);
    run->n_active += run->active[c];
  }
  pl_friction_activate(run);
  find_orphans(run);
  run->by_pivots = too_many_to_examine(run)
                   || (double)run->n_active * run->n_active * run->n_q > PL_RANK_WORK;
  run->rank_mode = -1;  // a new mode: rank and yardstick start anew
  run->best = 0;
  run->smallest_before = 0;
}

// ------------------------------------------------------------------------------------ independence
static void scale_columns(pl_run* run, int m) {
  int n = run->n_q;
  for (int r = 0; r < m; r++) {
    double* row = run->rows + (size_t)r * (size_t)n;
    double most = 0;
    for (int j = 0; j < n; j++) most = fabs(row[j]) > most ? fabs(row[j]) : most;
    for (int j = 0; j < n && most > 0; j++)
      if (fabs(row[j]) > most * run->column[j]) run->column[j] = fabs(row[j]) / most;
  }
  for (int r = 0; r < m; r++)
    for (int j = 0; j < n; j++)
      if (run->column[j] > 0) run->rows[(size_t)r * (size_t)n + (size_t)j] /= run->column[j];
}

static double row_length(const double* row, int n) {
  double most = 0, sum = 0;
  for (int j = 0; j < n; j++) most = fabs(row[j]) > most ? fabs(row[j]) : most;
  for (int j = 0; j < n && most > 0; j++) sum += (row[j] / most) * (row[j] / most);
  return most * sqrt(sum);
}

// Each row against the longest that it has been: a gradient may vanish all by itself.
static void measure_rows(pl_run* run) {
  for (int c = 0; c < run->n_c; c++) {
    if (run->row_of[c] < 0) continue;
    double length = row_length(run->rows + (size_t)run->row_of[c] * (size_t)run->n_q, run->n_q);
    run->row_long[c] = fmax(run->row_long[c], length);
    run->row_part[c] = run->row_long[c] > 0 ? length / run->row_long[c] : 1;
  }
}

static double faintest_taken(const pl_run* run) {
  double least = 1;
  for (int c = 0; c < run->n_c; c++)
    if (run->taken[c]) least = fmin(least, run->row_part[c]);
  return least;
}

// Whether the pivots of the whole system say that no active row depends on others: a large system
// is factored in no time.
static bool pivots_of_all_rows_are_sound(pl_run* run) {
  static const double sound = 1e-8;  // part of a pivot; as the square of the part of a row
  if (!run->by_pivots || run->kkt.symmetric == NULL) return false;
  for (int c = 0; c < run->n_c; c++) run->taken[c] = run->active[c];
  pl_assemble_matrix(run, false);
  return pl_symmetric_factor(run->kkt.symmetric, run->kkt.value) > sound;
}

static void examine(pl_run* run) {
  pl_assemble_rows(run);
  scale_columns(run, run->n_active);
  measure_rows(run);
  run->rank = pl_independent_rows(run->rows, run->priority, run->row_taken, run->rank_work,
                                  run->n_active, run->n_q, dependent_below, &run->smallest);
  for (int c = 0; c < run->n_c; c++)
    run->taken[c] = run->row_of[c] >= 0 && run->row_taken[run->row_of[c]];
  run->smallest *= faintest_taken(run);
}

void pl_active_set_choose(pl_run* run) {
  if (run->by_pivots && run->rank_mode >= 0) return;  // chosen when the mode began
  if (too_many_to_examine(run)) {
    for (int c = 0; c < run->n_c; c++) run->taken[c] = run->active[c];
    run->rank = run->n_active;
    return;
  }
  if (pivots_of_all_rows_are_sound(run)) {
    run->rank = run->n_active;
    return;
  }
  examine(run);
  // where later steps look at pivots of the whole system, those are the yardstick, not this measure
  // of rows
  if (!run->by_pivots && run->smallest > run->best) run->best = run->smallest;
}

bool pl_active_set_pivot(pl_run* run, double* smallest) {
  if (too_many_to_examine(run)) return false;
  int rank = run->rank;
  double here = run->smallest;
  for (int c = 0; c < run->n_c; c++) run->taken_kept[c] = run->taken[c];
  examine(run);
  *smallest = run->rank < rank ? 0 : run->smallest;
  run->rank = rank;
  run->smallest = here;
  for (int c = 0; c < run->n_c; c++) run->taken[c] = run->taken_kept[c];
  return true;
}

// -------------------------------------------------------------------------------------- uniqueness
// The declared rows that a left-out declared row is a combination of: least squares on the
// transposed taken rows. Equations that only define coordinates (priority above 0) carry no force
// of their own and do not count.
static void mark_partners(pl_run* run, const int* taken_row, int n_taken, int left_out) {
  int n = run->n_q;
  double* b = run->dep_norm + 2 * (size_t)run->n_c;
  const double* row = run->rows + (size_t)left_out * (size_t)n;
  double length = 0;
  for (int j = 0; j < n; j++) b[j] = row[j];
  for (int j = 0; j < n; j++) length = fmax(length, fabs(row[j]));
  pl_qr_least_squares(run->dep, run->dep_tau, b, n, n_taken);
  for (int i = 0; i < n_taken; i++) {
    int r = taken_row[run->dep_jpvt[i]];
    if (fabs(b[i]) <= 1e-7 * length) continue;
    for (int c = 0; c < run->n_c; c++)
      if (run->row_of[c] == r) run->unique[c] = false;
  }
}

static void mark_dependent(pl_run* run) {
  if (run->rank == run->n_active || too_many_to_examine(run)) return;
  // the rows again, unreduced and not scaled by columns
  pl_assemble_rows(run);
  int n = run->n_q, n_taken = 0, *taken_row = run->dep_jpvt + run->n_c;
  for (int c = 0; c < run->n_c; c++)
    if (run->taken[c] && run->setup->constraints[c].priority == 0)
      taken_row[n_taken++] = run->row_of[c];
  for (int i = 0; i < n_taken; i++)
    for (int j = 0; j < n; j++)
      run->dep[(size_t)i * (size_t)n + (size_t)j] =
          run->rows[(size_t)taken_row[i] * (size_t)n + (size_t)j];
  pl_qr_factor(run->dep, run->dep_jpvt, run->dep_tau, run->dep_norm, n, n_taken, 0);
  for (int c = 0; c < run->n_c; c++) {
    if (!run->active[c] || run->taken[c]) continue;
    run->unique[c] = false;
    if (run->setup->constraints[c].priority == 0)
      mark_partners(run, taken_row, n_taken, run->row_of[c]);
  }
}

void pl_active_set_unique(pl_run* run) {
  for (int c = 0; c < run->n_c; c++) run->unique[c] = !run->several[c];
  mark_dependent(run);
  pl_indeterminate_note(run);
}
