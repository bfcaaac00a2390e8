// linearise: the equations around a position of rest or a steady motion,  M u'' + C u' + K u = 0,  their stability and frequencies.
#include <math.h>
#include <string.h>

#include "derive/equilibria_impl.h"

// ---------------------------------------------------------------------------------------------- equations at rest
pl_expr pl_at_rest(pl_analysis* d, pl_expr e) {
  pl_replace r[2 * pl_max_gen];
  for (int k = 0; k < d->gen.n; k++) {
    const pl_variable* c = &d->q.at[d->gen.at[k]];
    r[2 * k] = (pl_replace){c->v, pl_int(d->pool, 0)};
    r[2 * k + 1] = (pl_replace){c->a, pl_int(d->pool, 0)};
  }
  e = pl_subst(d->pool, e, d->steady.at, d->steady.n);
  return pl_alg_normal(d->tower, pl_subst(d->pool, e, r, 2 * d->gen.n));
}

pl_expr pl_insert_rest(pl_analysis* d, pl_expr e, const pl_rest* r) {
  pl_replace s[pl_max_gen];
  int n = 0;
  for (int k = 0; k < d->gen.n; k++) {
    if (!pl_is_poison(r->q[k])) s[n++] = (pl_replace){d->q.at[d->gen.at[k]].q, r->q[k]};
  }
  return pl_subst(d->pool, e, s, n);
}

// ---------------------------------------------------------------------------------------------- stability
//   M u'' + C u' + K u = 0,  C split by symmetry into damping and gyroscopic terms.
bool pl_vanishes(pl_analysis* d, pl_expr e) { return pl_alg_is_zero(d->tower, e) == PL_YES; }

static void velocity_terms(pl_analysis* d, const pl_rest* r, pl_linearised* out) {
  int n = out->n;
  for (int i = 0; i < n; i++) {
    pl_expr f = pl_second_kind(d, d->gen.at[i]);
    for (int j = 0; j < n; j++) {
      pl_expr slope = pl_diff(d->pool, f, d->q.at[d->gen.at[j]].v);
      out->C[i * n + j] = pl_alg_normal(d->tower, pl_insert_rest(d, pl_at_rest(d, slope), r));
    }
  }
  for (int i = 0; i < n; i++) {
    for (int j = 0; j <= i; j++) {
      out->damped |= !pl_vanishes(d, pl_add(d->pool, out->C[i * n + j], out->C[j * n + i]));
      out->gyroscopic |= !pl_vanishes(d, pl_sub(d->pool, out->C[i * n + j], out->C[j * n + i]));
    }
  }
}

void pl_linearise(pl_analysis* d, const pl_expr* f, const pl_rest* r, pl_linearised* out) {
  *out = (pl_linearised){.n = d->gen.n};
  velocity_terms(d, r, out);
  for (int i = 0; i < out->n; i++) {
    pl_expr momentum = pl_diff(d->pool, d->Lg, d->q.at[d->gen.at[i]].v);
    for (int j = 0; j < out->n; j++) {
      pl_expr M = pl_diff(d->pool, momentum, d->q.at[d->gen.at[j]].v);
      out->M[i * out->n + j] = pl_alg_normal(d->tower, pl_insert_rest(d, pl_at_rest(d, M), r));
      out->K[i * out->n + j] = pl_alg_normal(d->tower, pl_insert_rest(d, pl_diff(d->pool, f[i], d->q.at[d->gen.at[j]].q), r));
    }
  }
}

// Signs of the leading minors of K: all positive is stable; some negative is unstable.  Free coordinates, which no force
// depends on, drift at will and are left out.
const char* pl_stability(pl_analysis* d, const pl_linearised* l, const pl_rest* r, pl_expr* stable_if) {
  bool all = true;
  *stable_if = pl_poison();
  int held[pl_max_gen], n = 0;
  for (int k = 0; k < l->n; k++) {
    if (!pl_is_poison(r->q[k])) held[n++] = k;
  }
  for (int m = 1; m <= n; m++) {
    pl_expr A[pl_max_gen * pl_max_gen];
    for (int i = 0; i < m; i++) {
      for (int j = 0; j < m; j++) A[i * m + j] = l->K[held[i] * l->n + held[j]];
    }
    pl_expr minor = pl_alg_normal(d->tower, pl_alg_det(d->tower, m, A, 20000));
    int sign = 0;
    pl_answer3 known = pl_alg_sign(d->tower, minor, false, &sign);
    if (known != PL_YES) {
      *stable_if = minor;
      all = false;
    } else if (sign < 0) {
      return l->gyroscopic ? NULL : "unstable";   // gyroscopic terms may hold what forces do not
    } else if (sign == 0) {
      return "marginal";
    }
  }
  if (n == 0) return "marginal";
  return all ? "stable" : NULL;
}

pl_symbol pl_omega_squared(pl_analysis* d) {
  bool taken = pl_symbol_find(d->pool, "omega").id != 0;   // the model has an ω of its own
  pl_symbol_info info = {.name = taken ? "Ω²" : "ω²", .ascii = "omega_squared", .role = PL_R_LOCAL, .class = PL_C_OTHER,
                         .dimension = pl_dimension_of(0, 0, -2), .dimension_known = true};
  return pl_symbol_make(d->pool, &info);
}

// det(K - ω² M); with gyroscopic terms det(K + s C + s² M), which is even in s, at s² = -ω².  Damping is left out: what is
// given then are the frequencies of the undamped system, and that is said.
static pl_expr characteristic(pl_analysis* d, const pl_linearised* l, pl_symbol w2) {
  pl_pool* p = d->pool;
  int n = l->n;
  pl_symbol_info info = {.name = "s", .ascii = "characteristic_s", .role = PL_R_LOCAL, .class = PL_C_OTHER};
  pl_symbol s = pl_symbol_make(p, &info);
  pl_expr A[pl_max_gen * pl_max_gen], c[2 * pl_max_gen + 1];
  for (int k = 0; k < n * n; k++) A[k] = pl_sub(p, l->K[k], pl_mul(p, pl_sym(p, w2), l->M[k]));
  if (!l->gyroscopic) return pl_alg_det(d->tower, n, A, 20000);
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < n; j++) {
      pl_expr turn = pl_mul(p, pl_ratio(p, 1, 2), pl_sub(p, l->C[i * n + j], l->C[j * n + i]));
      A[i * n + j] = pl_add(p, A[i * n + j], pl_mul(p, pl_sym(p, s), turn));
    }
  }
  int degree = pl_alg_coefficients(d->tower, pl_alg_det(d->tower, n, A, 20000), s, c, 2 * pl_max_gen);
  pl_expr sum = degree < 0 ? pl_poison() : pl_int(p, 0);
  for (int k = 0; k <= degree; k += 2) {
    sum = pl_add(p, sum, pl_mul(p, c[k], pl_pow_int(p, pl_neg(p, pl_sym(p, w2)), k / 2)));
  }
  return sum;
}

int pl_small_oscillations(pl_analysis* d, const pl_linearised* l, pl_root* root, int max) {
  pl_symbol w2 = pl_omega_squared(d);
  bool complete;
  return pl_alg_roots(d->tower, characteristic(d, l, w2), w2, root, max, &complete);
}

