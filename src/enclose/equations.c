// The equations of a step in balls: matrix, right sides order by order, series of the motion.
//
// At order k, with M, G, W, h, dg/dt of the tape (solve.h),
//
//     M_0 a_k - (G^T + W)_0 λ_k = -h_k - sum_{j=1..k} M_j a_{k-j} + sum_{j=1..k} (G^T + W)_j
//     λ_{k-j}
//     G_0 a_k = -(k+1) (sum_{j=1..k+1} G_j v_{k+1-j} + (dg/dt)_{k+1})
//
// the second being order k+1 of d/dt g = 0, in which v_{k+1} = a_k/(k+1). Each is an identity of
// the true motion, and the ball of the inverse contains the inverses of all matrices in the balls,
// so that coefficient k contains the true one.
// See theory (10.3).
#include "enclose/enclose_impl.h"

#include <math.h>

#include "linalg/linalg.h"

// ------------------------------------------------------------------------------------------ values
static void load(pl_system* s, pl_ball_jet* j, int k, bool places) {
  const pl_tape* t = j->tape;
  const int* node = places ? t->q_node : t->v_node;
  arb_srcptr from = places ? s->q : s->v;
  for (int i = 0; i < t->n_q; i++)
    if (node[i] >= 0)
      arb_set(j->coef + (slong)node[i] * j->cap + k, from + (slong)j->q[i] * s->cap + k);
}

static void load_time(pl_ball_jet* j, arb_srcptr t) {
  for (int i = j->tape->level_end[PL_LEVEL_CONST]; i < j->tape->level_end[PL_LEVEL_POSITION]; i++) {
    if (j->tape->nodes[i].op != PL_OP_TIME) continue;
    arb_ptr c = j->coef + (slong)i * j->cap;
    arb_set(c, t);
    if (j->cap > 1) arb_one(c + 1);
    for (int k = 2; k < j->cap; k++) arb_zero(c + k);
  }
}

void pl_system_values(pl_system* s, arb_srcptr t, uint8_t wanted) {
  for (int i = 0; i < s->n_jets; i++) {
    pl_ball_jet* j = &s->jet[i];
    load(s, j, 0, true);
    load(s, j, 0, false);
    load_time(j, t);
    pl_jet_coefficients(j, PL_LEVEL_POSITION, 0, s->prec, wanted);
    pl_jet_coefficients(j, PL_LEVEL_VELOCITY, 0, s->prec, wanted);
  }
}

// -------------------------------------------------------------------------------------------- rows
// Forces may depend on multipliers in use only: one that is left out has no value of its own.
static bool forces_are_determined(const pl_system* s) {
  for (int i = 0; i < s->n_jets; i++) {
    const pl_ball_jet* j = &s->jet[i];
    for (int e = 0; e < j->pattern->n_W; e++) {
      int c = j->c[j->pattern->W[e].col];
      if (s->active[c] && s->row_of[c] < 0) return false;
    }
  }
  return true;
}

// Rows of G in doubles: which are independent. What is chosen is proved to be regular by the
// inverse; that the others follow is known by algebra, so a choice that misses one is noticed by
// their number.
int pl_system_choose_rows(pl_system* s) {
  pl_arena* arena = s->arena;
  pl_mark mark = pl_arena_mark(arena);
  size_t n_q = (size_t)s->n_q;
  double* G = PL_ARRAY(arena, double, (size_t)s->n_c* n_q + 1);
  double* work = PL_ARRAY(arena, double, s->n_c + 1);
  int* priority = PL_ARRAY(arena, int, s->n_c + 1);
  bool* taken = PL_ARRAY(arena, bool, s->n_c + 1);
  for (int i = 0; i < s->n_jets; i++) {
    const pl_ball_jet* j = &s->jet[i];
    for (int e = 0; e < j->pattern->n_G; e++) {
      const pl_pattern_entry* g = &j->pattern->G[e];
      size_t c = (size_t)j->c[g->row];
      if (s->active[c])
        G[c * n_q + (size_t)j->q[g->col]] += pl_ball_double(pl_root_series(j, g->root));
    }
  }
  for (int c = 0; c < s->n_c; c++) priority[c] = s->setup->constraints[c].priority;
  double smallest;
  pl_independent_rows(G, priority, taken, work, s->n_c, s->n_q, 1e-9, &smallest);
  s->n_rows = 0;
  for (int c = 0; c < s->n_c; c++) {
    s->row_of[c] = s->active[c] && taken[c] ? s->n_rows : -1;
    if (s->row_of[c] >= 0) s->constraint_of[s->n_rows++] = c;
  }
  pl_arena_rewind(arena, mark);
  return forces_are_determined(s) ? s->n_rows : -1;
}

// ------------------------------------------------------------------------------------------ matrix
static void add_at(arb_mat_t A, int row, int col, arb_srcptr x, int sign, slong prec) {
  arb_ptr to = arb_mat_entry(A, row, col);
  if (sign > 0) arb_add(to, to, x, prec);
  else arb_sub(to, to, x, prec);
}

static void add_matrix(pl_system* s, const pl_ball_jet* j, arb_mat_t A) {
  const pl_pattern* p = j->pattern;
  for (int e = 0; e < p->n_mass; e++) {
    int r = j->q[p->mass[e].row], c = j->q[p->mass[e].col];
    arb_srcptr x = pl_root_series(j, p->mass[e].root);
    add_at(A, r, c, x, 1, s->prec);
    if (p->mass[e].row != p->mass[e].col) add_at(A, c, r, x, 1, s->prec);
  }
  for (int e = 0; e < p->n_G; e++) {
    int row = s->row_of[j->c[p->G[e].row]], col = j->q[p->G[e].col];
    if (row < 0) continue;
    arb_srcptr x = pl_root_series(j, p->G[e].root);
    add_at(A, s->n_q + row, col, x, 1, s->prec);
    add_at(A, col, s->n_q + row, x, -1, s->prec);
  }
  for (int e = 0; e < p->n_W; e++) {
    int col = s->row_of[j->c[p->W[e].col]];
    if (col >= 0)
      add_at(A, j->q[p->W[e].row], s->n_q + col, pl_root_series(j, p->W[e].root), -1, s->prec);
  }
}

static bool invert_matrix(pl_system* s) {
  int n = s->n_q + s->n_rows;
  if (s->has_inverse) arb_mat_clear(s->inverse);
  arb_mat_init(s->inverse, n, n);
  s->has_inverse = true;
  arb_mat_t A;
  arb_mat_init(A, n, n);
  for (int i = 0; i < s->n_jets; i++) add_matrix(s, &s->jet[i], A);
  bool ok = arb_mat_inv(s->inverse, A, s->prec) && arb_mat_is_finite(s->inverse);
  arb_mat_clear(A);
  return ok;
}

// ------------------------------------------------------------------------------------- right sides
// to -= or += sum_{j=from..to} x_j y_{n-j}
static void convolve(arb_ptr to, bool subtract, arb_srcptr x, arb_srcptr y, int from, int end,
                     int n, slong prec) {
  if (end < from) return;
  arb_dot(to, to, subtract, x + from, 1, y + (n - from), -1, end - from + 1, prec);
}

static void add_forces(pl_system* s, const pl_ball_jet* j, int k, slong prec) {
  const pl_pattern* p = j->pattern;
  for (int e = 0; e < p->n_h; e++) {
    arb_ptr to = s->rhs + j->q[p->h[e].row];
    arb_sub(to, to, pl_root_series(j, p->h[e].root) + k, prec);
  }
  for (int e = 0; e < p->n_mass; e++) {
    int r = j->q[p->mass[e].row], c = j->q[p->mass[e].col];
    arb_srcptr m = pl_root_series(j, p->mass[e].root);
    convolve(s->rhs + r, 1, m, s->a + (slong)c * s->cap, 1, k, k, prec);
    if (p->mass[e].row != p->mass[e].col)
      convolve(s->rhs + c, 1, m, s->a + (slong)r * s->cap, 1, k, k, prec);
  }
  for (int e = 0; e < p->n_G; e++) {
    int c = j->c[p->G[e].row];
    if (s->row_of[c] >= 0)
      convolve(s->rhs + j->q[p->G[e].col], 0, pl_root_series(j, p->G[e].root),
               s->l + (slong)c * s->cap, 1, k, k, prec);
  }
  for (int e = 0; e < p->n_W; e++) {
    int c = j->c[p->W[e].col];
    if (s->row_of[c] >= 0)
      convolve(s->rhs + j->q[p->W[e].row], 0, pl_root_series(j, p->W[e].root),
               s->l + (slong)c * s->cap, 1, k, k, prec);
  }
}

static void add_constraints(pl_system* s, const pl_ball_jet* j, int k, slong prec) {
  const pl_pattern* p = j->pattern;
  for (int e = 0; e < p->n_G; e++) {
    int row = s->row_of[j->c[p->G[e].row]];
    if (row < 0) continue;
    convolve(s->rhs + s->n_q + row, 1, pl_root_series(j, p->G[e].root),
             s->v + (slong)j->q[p->G[e].col] * s->cap, 1, k + 1, k + 1, prec);
  }
  for (int e = 0; e < p->n_gt; e++) {
    int row = s->row_of[j->c[p->gt[e].row]];
    if (row >= 0)
      arb_sub(s->rhs + s->n_q + row, s->rhs + s->n_q + row,
              pl_root_series(j, p->gt[e].root) + k + 1, prec);
  }
}

// a_k and λ_k.
static void solve(pl_system* s, int k, slong prec) {
  int n = s->n_q + s->n_rows;
  for (int i = 0; i < n; i++) arb_zero(s->rhs + i);
  for (int i = 0; i < s->n_jets; i++) {
    add_forces(s, &s->jet[i], k, prec);
    add_constraints(s, &s->jet[i], k, prec);
  }
  for (int i = s->n_q; i < n; i++) arb_mul_si(s->rhs + i, s->rhs + i, k + 1, prec);
  for (int i = 0; i < n; i++) {
    arb_ptr to = i < s->n_q ? s->a + (slong)i * s->cap + k
                            : s->l + (slong)s->constraint_of[i - s->n_q] * s->cap + k;
    arb_dot(to, NULL, 0, arb_mat_entry(s->inverse, i, 0), 1, s->rhs, 1, n, prec);
  }
}

// ------------------------------------------------------------------------------------------ series
enum { LEAST_BITS = 40 };

// Coefficient k enters with the k-th power of a step, so it needs fewer bits, and so does what it
// enters into.
static slong bits_at(const pl_system* s, int k, double bits_per_order) {
  slong prec = s->prec + 10 - (slong)floor(k * bits_per_order);
  return prec < LEAST_BITS ? LEAST_BITS : prec > s->prec ? s->prec : prec;
}

static void places(pl_system* s, int k, slong prec) {
  for (int i = 0; i < s->n_q; i++)
    arb_div_si(s->q + (slong)i * s->cap + k, s->v + (slong)i * s->cap + k - 1, k, prec);
  for (int i = 0; i < s->n_jets; i++) {
    load(s, &s->jet[i], k, true);
    pl_jet_coefficients(&s->jet[i], PL_LEVEL_POSITION, k, prec, PL_FOR_MOTION);
  }
}

static void speeds(pl_system* s, int k, slong prec) {
  for (int i = 0; i < s->n_q; i++)
    arb_div_si(s->v + (slong)i * s->cap + k, s->a + (slong)i * s->cap + k - 1, k, prec);
  for (int i = 0; i < s->n_jets; i++) {
    load(s, &s->jet[i], k, false);
    pl_jet_coefficients(&s->jet[i], PL_LEVEL_VELOCITY, k, prec, PL_FOR_MOTION);
  }
}

void pl_system_series(pl_system* s, int p, double bits_per_order) {
  for (int c = 0; c < s->n_c; c++)
    if (s->row_of[c] < 0)
      for (int k = 0; k < p; k++) arb_zero(s->l + (slong)c * s->cap + k);
  for (int k = 0; k < p; k++) {
    slong prec = bits_at(s, k, bits_per_order);
    if (k > 0) speeds(s, k, prec);
    places(s, k + 1, prec);
    solve(s, k, prec);
  }
  slong prec = bits_at(s, p, bits_per_order);
  for (int i = 0; i < s->n_q; i++)
    arb_div_si(s->v + (slong)i * s->cap + p, s->a + (slong)i * s->cap + p - 1, p, prec);
}

bool pl_system_point(pl_system* s, arb_srcptr t) {
  pl_system_values(s, t, PL_FOR_MOTION);
  if (pl_system_choose_rows(s) != s->n_wanted || !invert_matrix(s)) return false;
  pl_system_series(s, 1, 0);
  for (int i = 0; i < s->n_q; i++)
    if (!arb_is_finite(s->a + (slong)i * s->cap)) return false;
  return true;
}
