// Rank and dependencies of rows. The rank is taken of the normal forms modulo a prime at random
// points: fast, and right at a generic point. Where there are no values modulo the prime, in ball
// arithmetic at sample points. A dependency is solved for exactly and verified in every column.
#include "algebra/tower.h"

#include <string.h>

enum { PL_RANK_POINTS = 3, PL_RANK_TRIES = 60, PL_MAX_RANK = 512 };

// ---------------------------------------------------------------------------------------- modulo p
static bool residues(pl_tower* t, int m, int n, const pl_expr* A, uint64_t seed, uint64_t* out) {
  pl_mod_point* point = pl_mod_point_make(t->arena, t->pool, seed);
  for (int i = 0; i < m * n; i++) {
    bool ok = true;
    out[i] = pl_eval_mod(point, A[i], &ok);
    if (!ok) return false;
  }
  return true;
}

static uint64_t minus_mod(uint64_t a) { return a ? PL_MOD_P - a : 0; }

// Greedy from the first row on: a row is taken when it is independent of those taken before. R (m x
// n) is destroyed.
static int independent_rows(uint64_t* R, int m, int n, int* rows) {
  int rank = 0;
  int pivot[PL_MAX_RANK];
  for (int i = 0; i < m && rank < n && rank < PL_MAX_RANK; i++) {
    uint64_t* r = R + (size_t)i * (size_t)n;
    for (int k = 0; k < rank; k++) {
      uint64_t f = r[pivot[k]];
      if (!f) continue;
      const uint64_t* base = R + (size_t)rows[k] * (size_t)n;
      for (int j = 0; j < n; j++) r[j] = pl_mod_add(r[j], minus_mod(pl_mod_mul(f, base[j])));
    }
    int p = 0;
    while (p < n && r[p] == 0) p++;
    if (p == n) continue;
    uint64_t inverse = pl_mod_inv(r[p]);
    for (int j = 0; j < n; j++) r[j] = pl_mod_mul(r[j], inverse);
    pivot[rank] = p;
    rows[rank++] = i;
  }
  return rank;
}

// ---------------------------------------------------------------------------------------- in balls
// a -= factor * b on rows of n balls.
static void subtract_row(arb_ptr a, arb_srcptr b, arb_srcptr factor, int n, long bits) {
  for (int j = 0; j < n; j++) arb_submul(&a[j], factor, &b[j], bits);
}

// The first entry that is not zero, or n. A ball that contains zero at this precision is taken for
// zero.
static int first_entry(arb_srcptr a, int n) {
  int p = 0;
  while (p < n && arb_contains_zero(&a[p])) p++;
  return p;
}

// As independent_rows.
static int independent_ball_rows(arb_ptr R, int m, int n, int* rows, long bits) {
  int rank = 0, pivot[PL_MAX_RANK];
  arb_t factor;
  arb_init(factor);
  for (int i = 0; i < m && rank < n && rank < PL_MAX_RANK; i++) {
    arb_ptr r = R + (ptrdiff_t)i * n;
    for (int k = 0; k < rank; k++) {
      arb_ptr base = R + (ptrdiff_t)rows[k] * n;
      if (arb_contains_zero(&r[pivot[k]])) continue;
      arb_div(factor, &r[pivot[k]], &base[pivot[k]], bits);
      subtract_row(r, base, factor, n, bits);
      arb_zero(&r[pivot[k]]);
    }
    int p = first_entry(r, n);
    if (p == n) continue;
    pivot[rank] = p;
    rows[rank++] = i;
  }
  arb_clear(factor);
  return rank;
}

typedef struct pl_rank_job {
  int m, n;
  const pl_expr* A;
  int rank, *rows;
} pl_rank_job;

static void ball_rank_body(pl_tower* t, void* data) {
  pl_rank_job* j = data;
  pl_points* points = pl_tower_points(t);
  int* here = PL_ARRAY(t->arena, int, j->m);
  arb_ptr R = _arb_vec_init((slong)j->m * j->n);
  for (int i = 0, used = 0; i < pl_points_count(points) && used < PL_RANK_POINTS; i++) {
    bool ok = true;
    for (int k = 0; k < j->m * j->n && ok; k++) {
      arb_srcptr v;
      ok = pl_points_value(points, i, j->A[k], &v);
      if (ok) arb_set(&R[k], v);
    }
    if (!ok) continue;
    used++;
    int rank = independent_ball_rows(R, j->m, j->n, here, PL_POINT_BITS);
    if (rank <= j->rank) continue;
    j->rank = rank;
    memcpy(j->rows, here, (size_t)rank * sizeof *here);
  }
  _arb_vec_clear(R, (slong)j->m * j->n);
}

// ------------------------------------------------------------------------------------- the service
int pl_alg_rank(pl_tower* t, int m, int n, const pl_expr* A, int* rows) {
  if (m <= 0 || n <= 0) return 0;
  pl_expr* normal = PL_ARRAY(t->arena, pl_expr, m * n);
  uint64_t* R = PL_ARRAY(t->arena, uint64_t, m * n);
  int* here = PL_ARRAY(t->arena, int, m);
  for (int i = 0; i < m * n; i++) normal[i] = pl_alg_normal(t, pl_tower_see(t, A[i]));
  int best = -1;
  for (int k = 0, used = 0; k < PL_RANK_TRIES && used < PL_RANK_POINTS; k++) {
    if (!residues(t, m, n, normal, 1000 + (uint64_t)k, R)) continue;
    used++;
    int rank = independent_rows(R, m, n, here);
    if (rank <= best) continue;
    best = rank;
    if (rows) memcpy(rows, here, (size_t)rank * sizeof *rows);
  }
  if (best >= 0) return best;
  // no value modulo p: roots that do not exist there, such as sqrt(3)
  pl_rank_job j = {.m = m, .n = n, .A = normal, .rank = -1, .rows = here};
  if (!pl_tower_run(t, ball_rank_body, &j) || j.rank < 0) return 0;
  if (rows) memcpy(rows, here, (size_t)j.rank * sizeof *rows);
  return j.rank;
}

// ------------------------------------------------------------------------------------ dependencies
// Checks sum_i c_i A_ij = A_kj in every column.
static pl_answer3 verify_dependency(pl_tower* t, int m, int n, const pl_expr* A, int k,
                                    const pl_expr* c) {
  pl_answer3 answer = PL_YES;
  for (int j = 0; j < n; j++) {
    pl_expr sum = pl_neg(t->pool, A[k * n + j]);
    for (int i = 0; i < m; i++) {
      if (i != k) sum = pl_add(t->pool, sum, pl_mul(t->pool, c[i], A[i * n + j]));
    }
    pl_answer3 zero = pl_alg_is_zero(t, sum);
    if (zero == PL_NO) return PL_NO;
    if (zero == PL_UNKNOWN) answer = PL_UNKNOWN;
  }
  return answer;
}

pl_answer3 pl_alg_dependency(pl_tower* t, int m, int n, const pl_expr* A, int k, pl_expr* c) {
  if (m <= 0 || n <= 0 || k < 0 || k >= m) return PL_UNKNOWN;
  for (int i = 0; i < m; i++) c[i] = pl_int(t->pool, 0);
  // the other rows, then a set of columns in which those that are independent stay so
  pl_expr* others = PL_ARRAY(t->arena, pl_expr, m * n);
  pl_expr* transposed = PL_ARRAY(t->arena, pl_expr, m * n);
  int* row_of = PL_ARRAY(t->arena, int, m);
  int* rows = PL_ARRAY(t->arena, int, m);
  int* columns = PL_ARRAY(t->arena, int, n);
  int n_others = 0;
  for (int i = 0; i < m; i++) {
    if (i == k) continue;
    memcpy(others + n_others * n, A + i * n, (size_t)n * sizeof *A);
    row_of[n_others++] = i;
  }
  int r = n_others ? pl_alg_rank(t, n_others, n, others, rows) : 0;
  for (int i = 0; i < r; i++) {
    for (int j = 0; j < n; j++) transposed[j * r + i] = others[rows[i] * n + j];
  }
  if (r > 0 && pl_alg_rank(t, n, r, transposed, columns) != r) return PL_UNKNOWN;
  pl_expr* S = PL_ARRAY(t->arena, pl_expr, r * r + 1);
  pl_expr* b = PL_ARRAY(t->arena, pl_expr, r + 1);
  pl_expr* x = PL_ARRAY(t->arena, pl_expr, r + 1);
  for (int j = 0; j < r; j++) {
    for (int i = 0; i < r; i++) S[j * r + i] = transposed[columns[j] * r + i];
    b[j] = A[k * n + columns[j]];
  }
  if (r > 0 && pl_alg_solve(t, r, S, b, x, PL_MAX_TERMS) != PL_YES) return PL_UNKNOWN;
  for (int i = 0; i < r; i++) c[row_of[rows[i]]] = x[i];
  return verify_dependency(t, m, n, A, k, c);
}
