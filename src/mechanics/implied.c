// implied: which constraints the others imply, whether they contradict each other, and how many
// degrees of freedom they leave.
#include <string.h>

#include "mechanics/mechanics.h"

// Those that depend on others only where all hold.
static void depend_where_they_hold(pl_analysis* d, const int* row, int m, const int* column,
                                   int n) {
  int *kept = PL_ARRAY(d->arena, int, m), n_kept = 0;
  for (int a = 0; a < m; a++) {
    if (!d->g.at[row[a]].implied) kept[n_kept++] = row[a];
  }
  for (int a = 0; a < m; a++) {
    if (d->g.at[row[a]].implied) pl_depend_on_manifold(d, row[a], kept, n_kept, column, n);
  }
}

// Constraints that the others imply, by the rank of dg/dq at a generic point, or at points where
// the constraints hold.
void pl_find_implied(pl_analysis* d) {
  int n = 0, m = 0;
  int* column = PL_ARRAY(d->arena, int, d->q.n + 1);
  int* row = PL_ARRAY(d->arena, int, d->g.n + 1);
  for (int i = 0; i < d->q.n; i++) {
    if (d->q.at[i].carries && d->q.at[i].fixed_by < 0) column[n++] = i;
  }
  for (int k = 0; k < d->g.n; k++) {
    if (d->g.at[k].fixes < 0 && !d->g.at[k].implied) row[m++] = k;
  }
  if (m == 0) return;
  if (n == 0) {  // nothing is left to move: what holds, holds already
    for (int a = 0; a < m; a++) d->g.at[row[a]].implied = true;
    return;
  }
  pl_expr* A = PL_ARRAY(d->arena, pl_expr, m * n);
  for (int a = 0; a < m; a++) {
    for (int b = 0; b < n; b++) A[a * n + b] = pl_on_maps(d, d->g.at[row[a]].gradient[column[b]]);
  }
  int *independent = PL_ARRAY(d->arena, int, m), *there = PL_ARRAY(d->arena, int, m);
  int rank = pl_alg_rank(d->tower, m, n, A, independent);
  int where_they_hold = d->reduced ? -1 : pl_rank_on_manifold(d, row, m, column, n, there);
  bool smaller = where_they_hold >= 0 && where_they_hold < rank;
  if (smaller) {
    rank = where_they_hold;
    memcpy(independent, there, (size_t)rank * sizeof *independent);
  }
  for (int a = 0; a < m; a++) {
    bool kept = false;
    for (int r = 0; r < rank; r++) kept |= independent[r] == a;
    d->g.at[row[a]].implied = !kept;
  }
  if (smaller) depend_where_they_hold(d, row, m, column, n);
}

void pl_count_freedom(pl_analysis* d) {
  pl_dof* f = &d->dof;
  int velocity = 0, contacts = 0;
  for (int i = 0; i < d->q.n; i++) f->coordinates += d->q.at[i].carries;
  for (int k = 0; k < d->g.n; k++) {
    if (d->g.at[k].source->sticking) continue;  // friction is a force
    f->constraints++;
    if (d->g.at[k].implied) continue;
    if (d->g.at[k].velocity) {
      velocity++;
    } else {
      f->rank++;
      contacts += d->g.at[k].contact || d->g.at[k].source->while_label;
    }
  }
  for (int k = 0; k < d->open.n; k++) f->open += d->open.at[k].contact && !d->open.at[k].released;
  f->dof = f->coordinates - f->rank - d->hidden.n;
  f->velocity_dof = f->dof - velocity;
  f->free = f->dof + contacts;
}

// ----------------------------------------------------------------------------- on whom they depend
// ∇g_k as a combination of the gradients of the independent constraints: coefficients c of the
// bonds in `row`, k at `place`.
static pl_answer3 dependency(pl_analysis* d, int k, int* row, pl_expr* c, int* m, int* place) {
  int n = d->q.n;
  pl_expr* A = PL_ARRAY(d->arena, pl_expr, d->g.n * n);
  *m = 0;
  for (int a = 0; a < d->g.n; a++) {
    if (a != k && d->g.at[a].implied) continue;
    if (a == k) *place = *m;
    for (int i = 0; i < n; i++) A[*m * n + i] = pl_on_maps(d, d->g.at[a].gradient[i]);
    row[(*m)++] = a;
  }
  return pl_alg_dependency(d->tower, *m, n, A, *place, c);
}

// ∇g_k as a combination of the others, where one was found.
static void find_dependence(pl_analysis* d, int k) {
  int m = 0, place = -1;
  int* row = PL_ARRAY(d->arena, int, d->g.n);
  pl_expr* c = PL_ARRAY(d->arena, pl_expr, d->g.n);
  if (dependency(d, k, row, c, &m, &place) != PL_YES) return;
  pl_depend(d, k, m, row, c, place);
  pl_implication* out = &d->implied_by[k];
  out->by = PL_ARRAY(d->arena, int, m);
  for (int a = 0; a < m; a++) {
    if (a != place && !pl_is_poison(c[a]) && !pl_is_zero_node(d->pool, c[a]))
      out->by[out->n++] = row[a];
  }
}

void pl_find_dependences(pl_analysis* d) {
  d->implied_by = PL_ARRAY(d->arena, pl_implication, d->g.n + 1);
  for (int k = 0; k < d->g.n; k++) {
    d->implied_by[k] = (pl_implication){.n = 0};
    if (d->g.at[k].implied) find_dependence(d, k);
  }
}

// ---------------------------------------------------------------------------------- contradictions
pleuel_status pl_contradiction(pl_analysis* d, const pl_bond* l, pl_expr rest) {
  d->contradicting = (int)(l - d->g.at);
  d->contradiction = rest;
  return PLEUEL_CONTRADICTION;
}

// Every root of one constraint inserted into another leaves something: they have no position in
// common.
static bool no_common_root(pl_analysis* d, pl_expr given, pl_expr e) {
  for (int i = 0; i < d->q.n; i++) {
    if (!pl_has_symbol(d->pool, given, d->q.at[i].q)) continue;
    pl_root root[8];
    bool complete = false, all = true;
    int n = pl_alg_roots(d->tower, given, d->q.at[i].q, root, 8, &complete);
    for (int r = 0; r < n; r++)
      all &= pl_zero_for_numbers(d, pl_subst1(d->pool, e, d->q.at[i].q, root[r].value)) == PL_NO;
    if (n > 0 && complete) return all;
  }
  return false;
}

// A constraint whose gradient depends on those of the others holds where they hold, or nowhere.
// With ∇g = sum c_a ∇g_a and
// constant c_a the difference g - sum c_a g_a is a constant.
static pleuel_status no_contradiction(pl_analysis* d, int k) {
  const pl_bond* l = &d->g.at[k];
  if (d->reduced) {
    pl_expr left = pl_on_maps(d, l->g);
    if (pl_has_followers(d, left) && pl_holds_on_loops(d, left, pl_int(d->pool, 0)) != PL_NO)
      return PLEUEL_OK;
    return pl_zero_for_numbers(d, left) == PL_NO
               ? pl_contradiction(d, l, pl_alg_normal(d->tower, left))
               : PLEUEL_OK;
  }
  int m = 0, place = -1, others = 0, other = -1;
  int* row = PL_ARRAY(d->arena, int, d->g.n);
  pl_expr* c = PL_ARRAY(d->arena, pl_expr, d->g.n);
  if (dependency(d, k, row, c, &m, &place) != PL_YES) return PLEUEL_OK;
  bool constant = true;
  pl_expr rest = l->g;
  for (int a = 0; a < m; a++) {
    if (a == place || pl_is_poison(c[a]) || pl_is_zero_node(d->pool, c[a])) continue;
    constant &= !pl_has_coordinates(d, c[a]) && !d->g.at[row[a]].velocity;
    rest = pl_sub(d->pool, rest, pl_mul(d->pool, c[a], d->g.at[row[a]].g));
    other = row[a];
    others++;
  }
  if (others == 0) return PLEUEL_OK;
  if (constant) {
    rest = pl_alg_normal(d->tower, pl_on_fixed(d, rest));
    bool left = !pl_has_coordinates(d, rest) && pl_zero_for_numbers(d, rest) == PL_NO;
    return left ? pl_contradiction(d, l, rest) : PLEUEL_OK;
  }
  pl_expr e = pl_on_fixed(d, l->g);
  return others == 1 && no_common_root(d, pl_on_fixed(d, d->g.at[other].g), e)
             ? pl_contradiction(d, l, e)
             : PLEUEL_OK;
}

pleuel_status pl_find_contradictions(pl_analysis* d) {
  for (int k = 0; k < d->g.n; k++) {
    const pl_bond* l = &d->g.at[k];
    if (l->implied && !l->velocity && !l->contact) PL_TRY(no_contradiction(d, k));
  }
  return PLEUEL_OK;
}
