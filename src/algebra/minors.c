// Linear systems by Cramer's rule with memoised minors in the quotient ring: no division until the
// end, so the relations s^2 = 1 - c^2 may be used at every product. Rows are cleared of
// denominators and contents first, sparse rows are expanded first; every minor of the lower rows is
// computed once. One cancellation at the end. Bareiss needs exact division, which the quotient ring
// does not have; elimination in the field collects spurious factors.
//
// Denominators of the right-hand side alone stay out of the determinant, where they would be
// multiplied out: they become one common denominator beside it.
#include "algebra/tower.h"

#include <stdlib.h>
#include <string.h>

enum { PL_MAX_ORDER = 40, PL_MAX_MINORS = 60000 };

typedef struct pl_minors {
  pl_tower* t;
  int n, columns;     // n rows, n or n + 1 columns
  const pl_poly** M;  // (n x columns), rows in order of expansion
  pl_map* of_mask;    // set of columns -> index in memo + 1
  PL_VEC(const pl_poly*) memo;
  long max_terms;
  long work;       // products of terms formed so far, over all minors
  int sign;        // of the permutation of rows
  pl_frac scale;   // det of the given rows = scale * det M
  pl_frac* right;  // right-hand sides of the rows of M  (n), where there is a last column for them
  pl_frac below;   // that column of M is below * right
} pl_minors;

// ------------------------------------------------------------------------------ preparing the rows
static pl_frac denominator(pl_tower* t, pl_frac f) {
  return pl_frac_inv(t, pl_frac_over(t, pl_poly_int(t, 1), f));
}

// Times what it lacks, it is a multiple of the denominator of f.
static pl_frac common_multiple(pl_tower* t, pl_frac common, pl_frac f) {
  return pl_frac_mul(t, common, denominator(t, pl_frac_mul(t, f, common)));
}

static const pl_poly* cleared(pl_tower* t, pl_frac f, pl_frac common) {
  pl_frac whole = pl_frac_mul(t, f, common);
  if (whole.n || !fmpz_is_one(whole.unit)) pl_tower_give_up(t);
  return whole.num;
}

static void clear_row(pl_minors* m, const pl_frac* row, int i) {
  pl_tower* t = m->t;
  const pl_poly** out = m->M + i * m->columns;
  pl_frac common = pl_frac_int(t, 1);
  for (int j = 0; j < m->n; j++) common = common_multiple(t, common, row[j]);
  const pl_poly* content = pl_poly_int(t, 0);
  for (int j = 0; j < m->n; j++) {
    out[j] = cleared(t, row[j], common);
    content = pl_poly_gcd(t, content, out[j]);
  }
  if (pl_poly_is_zero(t, content)) content = pl_poly_int(t, 1);
  for (int j = 0; j < m->n; j++) {
    if (!pl_poly_is_zero(t, out[j]) && !pl_poly_divides(t, &out[j], out[j], content))
      pl_tower_give_up(t);
  }
  pl_frac scale = pl_frac_div(t, pl_frac_poly(t, content), common);
  m->scale = pl_frac_mul(t, m->scale, scale);
  if (m->columns > m->n) m->right[i] = pl_frac_div(t, row[m->n], scale);
}

static void clear_right(pl_minors* m) {
  pl_tower* t = m->t;
  m->below = pl_frac_int(t, 1);
  for (int i = 0; i < m->n; i++) m->below = common_multiple(t, m->below, m->right[i]);
  for (int i = 0; i < m->n; i++) m->M[i * m->columns + m->n] = cleared(t, m->right[i], m->below);
}

typedef struct pl_row_order {
  int row, filled;
} pl_row_order;

static int compare_rows(const void* a, const void* b) {
  const pl_row_order *x = a, *y = b;
  if (x->filled != y->filled) return x->filled < y->filled ? -1 : 1;
  return x->row - y->row;
}

static void prepare(pl_minors* m, const pl_frac* entries) {
  pl_tower* t = m->t;
  pl_row_order* order = PL_ARRAY(t->arena, pl_row_order, m->n);
  for (int i = 0; i < m->n; i++) {
    order[i].row = i;
    for (int j = 0; j < m->columns; j++)
      order[i].filled += !pl_frac_is_zero(t, entries[i * m->columns + j]);
  }
  qsort(order, (size_t)m->n, sizeof *order, compare_rows);
  m->sign = 1;
  for (int i = 0; i < m->n; i++) {
    for (int k = i + 1; k < m->n; k++) {
      if (order[k].row < order[i].row) m->sign = -m->sign;
    }
  }
  m->M = PL_ARRAY(t->arena, const pl_poly*, m->n * m->columns);
  m->scale = pl_frac_int(t, 1);
  m->right = PL_ARRAY(t->arena, pl_frac, m->n);
  for (int i = 0; i < m->n; i++) clear_row(m, entries + order[i].row * m->columns, i);
  if (m->columns > m->n) clear_right(m);
}

// ------------------------------------------------------------------------------------------ minors
static const pl_poly* known_minor(const pl_minors* m, uint64_t mask) {
  uint64_t k = pl_map_get(m->of_mask, mask);
  return k ? m->memo.at[k - 1] : NULL;
}

// Determinant of the last rows, from `row` on, in the columns of mask. Many minors below the cap
// may together still take minutes: so much work is allowed for each term of the cap.
static const long work_per_term = 100;

static const pl_poly* minor_of(pl_minors* m, int row, uint64_t mask) {
  pl_tower* t = m->t;
  if (row == m->n) return pl_poly_int(t, 1);
  const pl_poly* known = known_minor(m, mask);
  if (known) return known;
  if (m->memo.n > PL_MAX_MINORS) pl_tower_give_up(t);
  pl_tower_check(t);
  const pl_poly* below[PL_MAX_ORDER + 1] = {NULL};
  for (int j = 0; j < m->columns; j++) {
    bool needed = (mask >> j & 1) && !pl_poly_is_zero(t, m->M[row * m->columns + j]);
    if (needed) below[j] = minor_of(m, row + 1, mask & ~(UINT64_C(1) << j));
  }
  pl_poly* sum = pl_poly_new(t);
  pl_tower_mark mark = pl_tower_mark_now(t);
  bool minus = false;
  for (int j = 0; j < m->columns; j++) {
    if (!(mask >> j & 1)) continue;
    if (below[j] && !pl_poly_is_zero(t, below[j])) {
      m->work += m->M[row * m->columns + j]->length * below[j]->length;
      if (m->max_terms > 0 && m->work > work_per_term * m->max_terms) pl_tower_give_up(t);
      const pl_poly* term = pl_poly_mul(t, m->M[row * m->columns + j], below[j]);
      fmpz_mpoly_set(sum, minus ? pl_poly_sub(t, sum, term) : pl_poly_add(t, sum, term), &t->ctx);
    }
    minus = !minus;
  }
  pl_tower_rewind(t, mark);
  if (m->max_terms > 0 && sum->length > m->max_terms) pl_tower_give_up(t);
  pl_push(t->arena, m->memo, sum);
  pl_map_set(m->of_mask, mask, (uint64_t)m->memo.n);
  return sum;
}

static pl_minors minors_begin(pl_tower* t, int n, int columns, const pl_frac* entries,
                              long max_terms) {
  pl_minors m = {
      .t = t, .n = n, .columns = columns, .max_terms = max_terms, .of_mask = pl_map_make(t->arena)};
  prepare(&m, entries);
  return m;
}

// A determinant that is not zero algebraically may still be zero when roots or formal functions
// depend on each other.
static pl_answer3 vanishes(pl_tower* t, const pl_poly* D) {
  if (pl_poly_is_zero(t, D)) return PL_YES;
  for (int g = 0; g < t->gens.n; g++) {
    pl_gen_kind k = t->gens.at[g].kind;
    bool risky = k == PL_G_ROOT || k == PL_G_ABS || k == PL_G_FORMAL;
    if (risky && pl_poly_degree(t, D, g) > 0) return pl_alg_is_zero(t, pl_poly_expr(t, D));
  }
  return PL_NO;
}

// ------------------------------------------------------------------------------------------- solve
typedef struct pl_solve_job {
  int n;
  const pl_expr *A, *b;
  pl_expr* x;
  long max_terms;
  pl_answer3 answer;
} pl_solve_job;

static void solve_body(pl_tower* t, void* data) {
  pl_solve_job* j = data;
  int n = j->n;
  pl_frac* entries = PL_ARRAY(t->arena, pl_frac, n * (n + 1));
  for (int i = 0; i < n; i++) {
    for (int k = 0; k < n; k++) entries[i * (n + 1) + k] = pl_convert(t, j->A[i * n + k]);
    entries[i * (n + 1) + n] = pl_convert(t, j->b[i]);
  }
  pl_minors m = minors_begin(t, n, n + 1, entries, j->max_terms);
  uint64_t all = (UINT64_C(1) << (n + 1)) - 1;
  const pl_poly* D = minor_of(&m, 0, all & ~(UINT64_C(1) << n));
  pl_answer3 zero = vanishes(t, D);
  j->answer = zero == PL_YES ? PL_NO : PL_UNKNOWN;
  if (zero != PL_NO) return;
  for (int k = 0; k < n; k++) {
    const pl_poly* N = minor_of(&m, 0, all & ~(UINT64_C(1) << k));
    // the right-hand side moves from the last column to column k
    if ((n - 1 - k) % 2) N = pl_poly_neg(t, N);
    pl_frac x = pl_frac_div(t, pl_frac_make(t, N, D), m.below);
    j->x[k] = pl_frac_expr(t, x);
    pl_convert_known(t, j->x[k], x);
  }
  j->answer = PL_YES;
}

static bool any_poison(const pl_expr* e, int n) {
  for (int i = 0; i < n; i++) {
    if (pl_is_poison(e[i])) return true;
  }
  return false;
}

pl_answer3 pl_alg_solve(pl_tower* t, int n, const pl_expr* A, const pl_expr* b, pl_expr* x,
                        long max_terms) {
  if (n == 0) return PL_YES;
  if (n < 0 || n > PL_MAX_ORDER || any_poison(A, n * n) || any_poison(b, n)) return PL_UNKNOWN;
  if (t->names.n > 0 && pl_alg_rank(t, n, n, A, NULL) < n) return PL_NO;
  pl_expr* out = PL_ARRAY(t->arena, pl_expr, n);
  pl_solve_job j = {.n = n, .A = A, .b = b, .x = out, .max_terms = max_terms, .answer = PL_UNKNOWN};
  if (!pl_tower_run(t, solve_body, &j)) return PL_UNKNOWN;
  if (j.answer == PL_YES) memcpy(x, out, (size_t)n * sizeof *x);
  return j.answer;
}

// ------------------------------------------------------------------------------------- determinant
typedef struct pl_det_job {
  int n;
  const pl_expr* A;
  long max_terms;
  pl_expr det;
} pl_det_job;

static void det_body(pl_tower* t, void* data) {
  pl_det_job* j = data;
  int n = j->n;
  pl_frac* entries = PL_ARRAY(t->arena, pl_frac, n * n);
  for (int i = 0; i < n * n; i++) entries[i] = pl_convert(t, j->A[i]);
  pl_minors m = minors_begin(t, n, n, entries, j->max_terms);
  const pl_poly* D = minor_of(&m, 0, (UINT64_C(1) << n) - 1);
  pl_frac det = pl_frac_mul(t, pl_frac_poly(t, D), m.scale);
  j->det = pl_frac_expr(t, m.sign < 0 ? pl_frac_neg(t, det) : det);
}

pl_expr pl_alg_det(pl_tower* t, int n, const pl_expr* A, long max_terms) {
  if (n == 0) return pl_int(t->pool, 1);
  if (n < 0 || n > PL_MAX_ORDER || any_poison(A, n * n)) return pl_poison();
  pl_det_job j = {.n = n, .A = A, .max_terms = max_terms, .det = pl_poison()};
  return pl_tower_run(t, det_body, &j) ? j.det : pl_poison();
}
