// redundant: the forces of constraints that depend on each other.  With gradients
//   ∇g_k = sum_a c_ka ∇g_a      (k implied, a independent)
// only the total sum of λ ∇g follows from the motion: λ_a = λ_a0 - sum_k c_ka λ_k with every λ_k
// free. Determined are the combinations λ_a + sum_k c_ka λ_k; among all values the smallest sum of
// squares is offered: (1 + C C^T) λ_k = C λ_0.
// See theory (4.2) to (4.4).
#include "mechanics/mechanics.h"

enum { max_free = 12 };

const pl_dependence* pl_dependence_of(const pl_analysis* d, int link) {
  for (int r = 0; r < d->dependences.n; r++) {
    if (d->dependences.at[r].implied == link) return &d->dependences.at[r];
  }
  return NULL;
}

void pl_depend(pl_analysis* d, int implied, int m, const int* row, const pl_expr* c, int place) {
  pl_dependence r = {.implied = implied, .c = PL_ARRAY(d->arena, pl_expr, d->g.n)};
  for (int k = 0; k < d->g.n; k++) r.c[k] = pl_int(d->pool, 0);
  bool any = false;
  for (int a = 0; a < m; a++) {
    if (a == place || pl_is_poison(c[a])) continue;
    r.c[row[a]] = pl_alg_normal(d->tower, c[a]);
    any |= !pl_is_zero_node(d->pool, r.c[row[a]]);
  }
  if (any) pl_push(d->arena, d->dependences, r);
}

// From here on a multiplier that is not determined contains the free ones.
void pl_share_forces(pl_analysis* d) {
  for (int r = 0; d->solved && r < d->dependences.n; r++) {
    const pl_dependence* p = &d->dependences.at[r];
    pl_bond* free = &d->g.at[p->implied];
    free->shared = free->lambda_known = true;
    free->lambda_value = pl_sym(d->pool, free->lambda);
    for (int a = 0; a < d->g.n; a++) {
      pl_bond* l = &d->g.at[a];
      if (pl_is_zero_node(d->pool, p->c[a]) || l->implied) continue;
      l->shared = true;
      if (!l->lambda_known) continue;
      pl_expr part = pl_mul(d->pool, p->c[a], free->lambda_value);
      l->lambda_value = pl_alg_normal(d->tower, pl_sub(d->pool, l->lambda_value, part));
    }
  }
}

void pl_inherit_dependences(pl_analysis* a, const pl_analysis* from) {
  for (int r = 0; r < from->dependences.n; r++) {
    pl_dependence p = {.implied = from->dependences.at[r].implied,
                       .c = PL_ARRAY(a->arena, pl_expr, a->g.n),
                       .there = from->dependences.at[r].there};
    for (int k = 0; k < a->g.n; k++)
      p.c[k] = pl_alg_normal(a->tower, pl_on_maps(a, from->dependences.at[r].c[k]));
    pl_push(a->arena, a->dependences, p);
  }
  pl_share_forces(a);
}

bool pl_not_determined(pl_analysis* d, pl_expr e) {
  for (int r = 0; r < d->dependences.n; r++) {
    if (d->g.at[d->dependences.at[r].implied].shared
        && pl_has_symbol(d->pool, e, d->g.at[d->dependences.at[r].implied].lambda))
      return true;
  }
  return false;
}

// The constraints that share a force with link, itself among them: in[k] true.
void pl_group_sharing(const pl_analysis* d, int link, bool* in) {
  for (int k = 0; k < d->g.n; k++) in[k] = false;
  in[link] = true;
  for (bool grown = true; grown;) {
    grown = false;
    for (int r = 0; r < d->dependences.n; r++) {
      const pl_dependence* p = &d->dependences.at[r];
      bool touched = in[p->implied];
      for (int a = 0; a < d->g.n; a++) touched |= in[a] && !pl_is_zero_node(d->pool, p->c[a]);
      for (int a = 0; touched && a < d->g.n; a++) {
        bool part = a == p->implied || !pl_is_zero_node(d->pool, p->c[a]);
        if (!part || in[a]) continue;
        in[a] = grown = true;
      }
    }
  }
}

// λ_a with all free multipliers at 0.
static pl_expr without_free(pl_analysis* d, int a) {
  pl_expr e = d->g.at[a].lambda_value;
  for (int r = 0; r < d->dependences.n; r++) {
    e = pl_subst1(d->pool, e, d->g.at[d->dependences.at[r].implied].lambda, pl_int(d->pool, 0));
  }
  return pl_alg_normal(d->tower, e);
}

void pl_determined_sum(pl_analysis* d, int a, pl_expr* out, pl_expr* value) {
  pl_expr sum = pl_sym(d->pool, d->g.at[a].lambda);
  for (int r = 0; r < d->dependences.n; r++) {
    const pl_dependence* p = &d->dependences.at[r];
    sum = pl_add(d->pool, sum,
                 pl_mul(d->pool, p->c[a], pl_sym(d->pool, d->g.at[p->implied].lambda)));
  }
  *out = sum;
  *value = without_free(d, a);
}

// A sum that follows from the gradients at every place can be certified at any; else the motion is
// its witness alone.
bool pl_dependences_hold_everywhere(const pl_analysis* d) {
  for (int r = 0; r < d->dependences.n; r++) {
    if (d->dependences.at[r].there) return false;
  }
  return true;
}

// The free multipliers of the group with the smallest sum of squares; false when they are too many
// or not solvable.
static bool smallest_free(pl_analysis* d, const bool* in, pl_replace* out, int* n_out) {
  int n = 0, implied[max_free];
  const pl_dependence* p[max_free];
  for (int k = 0; k < d->g.n; k++) {
    const pl_dependence* own = in[k] ? pl_dependence_of(d, k) : NULL;
    if (!own) continue;
    if (n == max_free) return false;
    implied[n] = k;
    p[n++] = own;
  }
  if (n == 0) return false;
  pl_expr A[max_free * max_free] = {{0}}, b[max_free] = {{0}}, x[max_free];
  for (int i = 0; i < n; i++) {
    b[i] = pl_int(d->pool, 0);
    for (int a = 0; a < d->g.n; a++) {
      if (pl_is_zero_node(d->pool, p[i]->c[a])) continue;
      if (!d->g.at[a].lambda_known) return false;
      b[i] = pl_add(d->pool, b[i], pl_mul(d->pool, p[i]->c[a], without_free(d, a)));
    }
    for (int j = 0; j < n; j++) {
      A[i * n + j] = pl_int(d->pool, i == j);
      for (int a = 0; a < d->g.n; a++)
        A[i * n + j] = pl_add(d->pool, A[i * n + j], pl_mul(d->pool, p[i]->c[a], p[j]->c[a]));
    }
  }
  if (pl_alg_solve(d->tower, n, A, b, x, 20000) != PL_YES) return false;
  for (int i = 0; i < n; i++) out[i] = (pl_replace){d->g.at[implied[i]].lambda, x[i]};
  *n_out = n;
  return true;
}

bool pl_smallest_multipliers(pl_analysis* d, const bool* in, pl_expr* lambda) {
  pl_replace r[max_free];
  int n = 0;
  for (int k = 0; k < d->g.n; k++) {
    // contacts push: the choice might let one of them pull
    if (in[k] && d->g.at[k].contact) return false;
  }
  if (!smallest_free(d, in, r, &n)) return false;
  for (int a = 0; a < d->g.n; a++) {
    bool known = in[a] && d->g.at[a].lambda_known;
    lambda[a] = known ? pl_alg_normal(d->tower, pl_subst(d->pool, d->g.at[a].lambda_value, r, n))
                      : pl_poison();
  }
  return true;
}
