// The linear system of a point: structure, factor, solve. Dense LU with pivoting for small systems;
// above, L D L^T in lanes while its pivots are sound, and KLU where they are not or the matrix is
// not symmetric.
//
// The dense matrix is balanced symmetrically by powers of two before it is factored [Ruiz2001], so
// that the pivots measure how singular it is, whatever the units. See theory (9.5).
#include "solve/dae/dae.h"

#include <math.h>

// --------------------------------------------------------------------------------------- structure
typedef struct pl_stream_places {
  int* row;
  int* next;
  int* head;
  int n;
} pl_stream_places;  // linked lists, one a column

// A mark for the structure is only added here; unique and sorted later.
static void mark(pl_stream_places* p, int row, int col) {
  p->row[p->n] = row;
  p->next[p->n] = p->head[col];
  p->head[col] = p->n++;
}

static void mark_batch(pl_stream_places* p, const pl_dae* dae, const pl_batch* b) {
  const pl_pattern* t = b->pattern;
  for (int l = 0; l < b->n; l++) {
    for (int e = 0; e < t->n_mass; e++) {
      int i = b->q[t->mass[e].row * b->lanes + l], j = b->q[t->mass[e].col * b->lanes + l];
      mark(p, i, j);
      mark(p, j, i);
    }
    for (int e = 0; e < t->n_G; e++) {
      int c = dae->n_q + b->c[t->G[e].row * b->lanes + l], j = b->q[t->G[e].col * b->lanes + l];
      mark(p, c, j);
      mark(p, j, c);
    }
    for (int e = 0; e < t->n_W; e++)
      mark(p, b->q[t->W[e].row * b->lanes + l], dae->n_q + b->c[t->W[e].col * b->lanes + l]);
  }
}

static int count_marks(const pl_dae* dae) {
  long n = dae->kkt.n + 3L * dae->setup->n_frictions;
  for (int i = 0; i < dae->motion.n; i++) {
    const pl_pattern* t = dae->motion.at[i].pattern;
    n += (long)dae->motion.at[i].n * (2L * t->n_mass + 2L * t->n_G + t->n_W);
  }
  return n > INT32_MAX - 8 ? -1 : (int)n;
}

// Insertion from the back: the lists come almost sorted.
static int insert_sorted(int* list, int n, int row) {
  int i = n;
  while (i > 0 && list[i - 1] > row) i--;
  if (i > 0 && list[i - 1] == row) return n;
  for (int k = n; k > i; k--) list[k] = list[k - 1];
  list[i] = row;
  return n + 1;
}

// unknowns up to which the pivoting factorisation is prepared beforehand
enum { ANALYSED_AT_ONCE = 20000 };

static pleuel_status sparse_structure(pl_dae* dae) {
  pl_arena* a = dae->job->arena;
  pl_kkt* k = &dae->kkt;
  int most = count_marks(dae);
  if (most < 0)
    return pl_fail(dae->job, PLEUEL_NO_MEMORY, "the linear system has too many entries");
  pl_stream_places p = {PL_ARRAY(a, int, most + 1), PL_ARRAY(a, int, most + 1),
                        PL_ARRAY(a, int, k->n + 1), 0};
  for (int j = 0; j < k->n; j++) p.head[j] = -1;
  for (int j = 0; j < k->n; j++) mark(&p, j, j);
  for (int i = 0; i < dae->motion.n; i++) mark_batch(&p, dae, &dae->motion.at[i]);
  for (int r = 0; r < dae->setup->n_frictions; r++) {
    const pl_friction_setup* friction = &dae->setup->frictions[r];
    for (int i = 0; i < friction->n_rows; i++)
      mark(&p, dae->n_q + friction->row[i], dae->n_q + friction->constraint);
  }
  k->start = PL_ARRAY(a, int, k->n + 1);
  k->row = PL_ARRAY(a, int, most + 1);
  for (int j = 0; j < k->n; j++) {
    int n = 0;
    for (int e = p.head[j]; e >= 0; e = p.next[e])
      n = insert_sorted(k->row + k->start[j], n, p.row[e]);
    k->start[j + 1] = k->start[j] + n;
  }
  k->n_values = k->start[k->n];
  return PLEUEL_OK;
}

static int place(const pl_kkt* k, int row, int col) {
  if (k->dense) return row + col * k->n;
  int lo = k->start[col], hi = k->start[col + 1] - 1;
  while (lo < hi) {
    int mid = (lo + hi) / 2;
    if (k->row[mid] < row) lo = mid + 1;
    else hi = mid;
  }
  return lo;
}

static void place_batch(pl_dae* dae, pl_batch* b) {
  pl_arena* a = dae->job->arena;
  const pl_pattern* t = b->pattern;
  b->at_mass = PL_ARRAY(a, int, t->n_mass * b->lanes + 1);
  b->at_mass_t = PL_ARRAY(a, int, t->n_mass * b->lanes + 1);
  b->at_G = PL_ARRAY(a, int, t->n_G * b->lanes + 1);
  b->at_Gt = PL_ARRAY(a, int, t->n_G * b->lanes + 1);
  b->at_W = PL_ARRAY(a, int, t->n_W * b->lanes + 1);
  for (int l = 0; l < b->n; l++) {
    for (int e = 0; e < t->n_mass; e++) {
      int i = b->q[t->mass[e].row * b->lanes + l], j = b->q[t->mass[e].col * b->lanes + l];
      b->at_mass[e * b->lanes + l] = place(&dae->kkt, i, j);
      b->at_mass_t[e * b->lanes + l] = place(&dae->kkt, j, i);
    }
    for (int e = 0; e < t->n_G; e++) {
      int c = dae->n_q + b->c[t->G[e].row * b->lanes + l], j = b->q[t->G[e].col * b->lanes + l];
      b->at_G[e * b->lanes + l] = place(&dae->kkt, c, j);
      b->at_Gt[e * b->lanes + l] = place(&dae->kkt, j, c);
    }
    for (int e = 0; e < t->n_W; e++)
      b->at_W[e * b->lanes + l] = place(&dae->kkt, b->q[t->W[e].row * b->lanes + l],
                                        dae->n_q + b->c[t->W[e].col * b->lanes + l]);
  }
}

// Which unknowns are coordinates with a mass of their own, which constraints.
static unsigned char* kinds(const pl_dae* dae) {
  unsigned char* kind = PL_ARRAY(dae->job->arena, unsigned char, dae->kkt.n + 1);
  for (int i = 0; i < dae->kkt.n; i++)
    kind[i] = i < dae->n_q ? PL_UNKNOWN_OTHER : PL_UNKNOWN_CONSTRAINT;
  for (int i = 0; i < dae->motion.n; i++) {
    const pl_batch* b = &dae->motion.at[i];
    for (int e = 0; e < b->pattern->n_mass; e++)
      for (int l = 0; l < b->n && b->pattern->mass[e].row == b->pattern->mass[e].col; l++)
        kind[b->q[b->pattern->mass[e].row * b->lanes + l]] = PL_UNKNOWN_MASS;
  }
  return kind;
}

pleuel_status pl_kkt_make(pl_dae* dae) {
  pl_arena* a = dae->job->arena;
  pl_kkt* k = &dae->kkt;
  k->n = dae->n_q + dae->n_c;
  k->arena = a;
  k->dense = k->n <= PL_DENSE_UP_TO;
  if (k->dense) k->n_values = k->n * k->n;
  else PL_TRY(sparse_structure(dae));
  k->value = PL_ARRAY(a, double, k->n_values + 1);
  k->work = PL_ARRAY(a, double, k->n + 1);
  k->diagonal = PL_ARRAY(a, int, k->n + 1);
  for (int i = 0; i < k->n; i++) k->diagonal[i] = place(k, i, i);
  for (int i = 0; i < dae->motion.n; i++) place_batch(dae, &dae->motion.at[i]);
  for (int r = 0; r < dae->setup->n_frictions; r++) {
    const pl_friction_setup* friction = &dae->setup->frictions[r];
    for (int i = 0; i < friction->n_rows; i++)
      dae->at_friction[friction->row[i]] = place(k, dae->n_q + friction->row[i],
                                                 dae->n_q + friction->constraint);
  }
  if (k->dense) {
    k->lu = PL_ARRAY(a, double, k->n_values + 1);
    k->scale = PL_ARRAY(a, double, k->n + 1);
    k->balance = PL_ARRAY(a, double, k->n + 1);
    k->pivot = PL_ARRAY(a, int, k->n + 1);
    return PLEUEL_OK;
  }
  if (!dae->has_W && dae->setup->n_frictions == 0)
    k->symmetric = pl_symmetric_make(a, k->n, k->start, k->row, kinds(dae));
  // in the largest systems only where it is needed, because it takes as much memory as all the rest
  if (k->symmetric == NULL || k->n <= ANALYSED_AT_ONCE)
    k->sparse = pl_sparse_make(a, k->n, k->start, k->row);
  if (k->sparse == NULL && (k->symmetric == NULL || k->n <= ANALYSED_AT_ONCE))
    return pl_fail(dae->job, PLEUEL_SINGULAR,
                   "the equations of motion do not determine every acceleration");
  return PLEUEL_OK;
}

void pl_kkt_keep(pl_kkt* k, pl_keeper* keeper) {
  bool made = k->sparse != NULL;
  if (k->dense) return;
  pl_keep_bool(keeper, &made);
  if (made && k->sparse == NULL) k->sparse = pl_sparse_make(k->arena, k->n, k->start, k->row);
  if (made && k->sparse == NULL) pl_keep_fail(keeper);
  else if (made) pl_sparse_keep(k->sparse, keeper);
}

void pl_kkt_free(pl_kkt* k) { pl_sparse_free(k->sparse); }

// ------------------------------------------------------------------------------------------ factor
static double power_of_two(double x) {  // near 1/sqrt x
  int e;
  if (!(x > 0) || !isfinite(x)) return 1;
  frexp(x, &e);
  return ldexp(1.0, -e / 2);
}

static void balance(pl_kkt* k) {
  int n = k->n;
  for (int i = 0; i < n; i++) k->balance[i] = 1;
  for (int i = 0; i < n * n; i++) k->lu[i] = k->value[i];
  for (int round = 0; round < 3; round++) {
    for (int i = 0; i < n; i++) k->work[i] = 0;
    for (int j = 0; j < n; j++)
      for (int i = 0; i < n; i++) k->work[i] = fmax(k->work[i], fabs(k->lu[i + j * n]));
    for (int i = 0; i < n; i++) k->work[i] = power_of_two(k->work[i]);
    for (int i = 0; i < n; i++) k->balance[i] *= k->work[i];
    for (int j = 0; j < n; j++)
      for (int i = 0; i < n; i++) k->lu[i + j * n] *= k->work[i] * k->work[j];
  }
}

// Below this ratio of pivots nothing is left of the digits of a double.
static const double least_ratio = 1e-15;

// With pivoting. What it says about the pivots counts where the other factorisation could say
// nothing.
static double factor_with_pivoting(pl_kkt* k, double part) {
  if (k->sparse == NULL) k->sparse = pl_sparse_make(k->arena, k->n, k->start, k->row);
  k->pivoted = true;
  if (k->sparse == NULL || !pl_sparse_factor(k->sparse, k->value)) return 0;
  return part > 0 ? part : pl_sparse_rcond(k->sparse);
}

bool pl_kkt_factor(pl_kkt* k) {
  if (k->dense) {
    balance(k);
    k->ratio = pl_lu_factor(k->lu, k->pivot, k->scale, k->n);
    return k->ratio > least_ratio;
  }
  k->pivoted = false;
  k->ratio = k->symmetric ? pl_symmetric_factor(k->symmetric, k->value) : 0;
  if (!(k->ratio > k->trusted)) k->ratio = factor_with_pivoting(k, k->ratio);
  return k->ratio > least_ratio;
}

void pl_kkt_solve(pl_kkt* k, double* b) {
  if (!k->dense) {
    if (k->pivoted) pl_sparse_solve(k->sparse, b);
    else pl_symmetric_solve(k->symmetric, b);
    return;
  }
  for (int i = 0; i < k->n; i++) b[i] *= k->balance[i];
  pl_lu_solve(k->lu, k->pivot, k->scale, b, k->work, k->n);
  for (int i = 0; i < k->n; i++) b[i] *= k->balance[i];
}
