// linearise: the equations around a position of rest or a steady motion, M u'' + C u' + K u = 0,
// their stability and frequencies.
// See theory (7.1), (7.2).
#include <math.h>
#include <string.h>

#include "mechanics/equilibria.h"

// ------------------------------------------------------------------------------- equations at rest
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

// --------------------------------------------------------------------------------------- stability
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
      out->K[i * out->n + j] = pl_alg_normal(
          d->tower, pl_insert_rest(d, pl_diff(d->pool, f[i], d->q.at[d->gen.at[j]].q), r));
    }
  }
  for (int i = 0; i < out->n; i++) {
    for (int j = 0; j < i; j++)
      out->circulatory |= !pl_vanishes(
          d, pl_sub(d->pool, out->K[i * out->n + j], out->K[j * out->n + i]));
  }
}

// --------------------------------------------------------------------------------- signs of minors
// The minor of A (n x n) with the rows and columns in `set`.
static pl_expr minor_of(pl_analysis* d, const pl_expr* A, int n, unsigned set) {
  pl_expr B[pl_max_gen * pl_max_gen];
  int row[pl_max_gen], m = 0;
  for (int i = 0; i < n; i++) {
    if (set >> i & 1) row[m++] = i;
  }
  for (int i = 0; i < m; i++) {
    for (int j = 0; j < m; j++) B[i * m + j] = A[row[i] * n + row[j]];
  }
  return pl_alg_normal(d->tower, pl_alg_det(d->tower, m, B, 20000));
}

// Proven, or that of the exact numbers that are given: *by_numbers.  0: it vanishes.  False: open.
static bool sign_of(pl_analysis* d, pl_expr e, int* sign, bool* by_numbers) {
  *by_numbers = false;
  if (pl_alg_sign_proven(d->tower, e, false, sign) == PL_YES) return true;
  double x = pl_number(d, e);
  *by_numbers = true;
  *sign = x > 0 ? 1 : x < 0 ? -1 : 0;
  return !isnan(x);
}

// All principal minors are >= 0.  PL_UNKNOWN: some has no sign.
static pl_answer3 semidefinite(pl_analysis* d, const pl_expr* A, int n) {
  pl_answer3 answer = PL_YES;
  for (unsigned set = 1; set < 1u << n; set++) {
    int sign = 0;
    bool by_numbers;
    if (!sign_of(d, minor_of(d, A, n, set), &sign, &by_numbers)) answer = PL_UNKNOWN;
    else if (sign < 0) return PL_NO;
  }
  return answer;
}

static pl_answer3 definite(pl_analysis* d, const pl_expr* A, int n) {
  pl_answer3 answer = PL_YES;
  for (int m = 1; m <= n; m++) {
    int sign = 0;
    bool by_numbers;
    if (!sign_of(d, minor_of(d, A, n, (1u << m) - 1), &sign, &by_numbers)) answer = PL_UNKNOWN;
    else if (sign <= 0) return PL_NO;
  }
  return answer;
}

// A kinetic energy of masses is positive; one that was written down need not be.
static bool of_masses(const pl_analysis* d) {
  for (int k = 0; k < d->model->loads.n; k++) {
    pl_load_kind kind = d->model->loads.at[k].kind;
    if (kind == PL_L_KINETIC || kind == PL_L_LAGRANGIAN) return false;
  }
  return true;
}

// ---------------------------------------------------------------------------------- one coordinate
// Where the slope of the force vanishes, its first derivative that does not decides: V = c u^n is a
// minimum for even n and c > 0.
static const char* by_higher_derivatives(pl_analysis* d, const pl_expr* f, const pl_rest* r,
                                         bool numbers) {
  enum { highest = 8 };
  pl_symbol q = d->q.at[d->gen.at[0]].q;
  pl_expr e = f[0];
  for (int order = 1; order <= highest; order++) {
    e = pl_alg_normal(d->tower, pl_diff(d->pool, e, q));
    pl_expr here = pl_insert_rest(d, e, r);
    int sign = 0;
    if (pl_vanishes(d, here) || (numbers && pl_number(d, here) == 0)) continue;
    bool by_numbers = false;
    if (!sign_of(d, here, &sign, &by_numbers) || (by_numbers && !numbers)) return NULL;
    return order % 2 == 1 && sign > 0 ? "stable" : "unstable";
  }
  return NULL;
}

// ------------------------------------------------------------------------------------- the verdict
// What speaks against judging by the potential.
static pl_doubt doubt_of(pl_analysis* d, const pl_linearised* l) {
  int n = l->n;
  pl_expr D[pl_max_gen * pl_max_gen];
  for (int k = 0; k < n * n; k++) {
    if (pl_has_symbol(d->pool, l->K[k], pl_time(d->pool))
        || pl_has_symbol(d->pool, l->M[k], pl_time(d->pool)))
      return PL_DOUBT_DRIVEN;
  }
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < n; j++) D[i * n + j] = pl_add(d->pool, l->C[i * n + j], l->C[j * n + i]);
  }
  if (!of_masses(d) && definite(d, l->M, n) == PL_NO) return PL_DOUBT_INERTIA;
  if (l->circulatory) return PL_DOUBT_CIRCULATORY;
  if (l->damped && semidefinite(d, D, n) != PL_YES) return PL_DOUBT_DAMPING;
  return PL_DOUBT_NONE;
}

// One damped coordinate that is pushed on: C < 0.
static bool is_blown_up(pl_analysis* d, const pl_linearised* l) {
  int sign = 0;
  bool by_numbers;
  return l->n == 1 && l->damped && sign_of(d, l->C[0], &sign, &by_numbers) && sign < 0;
}

// Signs of the principal minors of K over the coordinates that forces hold; free ones drift at will
// and are left out.
// All leading ones positive: stable. Some principal one negative: unstable, unless gyroscopic terms
// hold what forces do not.
static void judge_minors(pl_analysis* d, const pl_linearised* l, unsigned held, pl_verdict* out) {
  unsigned leading = 0;
  bool zero = false;
  out->at_numbers = "stable";
  for (unsigned set = 1; set < 1u << l->n; set++) {
    if (set & ~held) continue;
    bool is_leading = true;
    for (int i = 0, gap = 0; i < l->n; i++) {
      if (!(held >> i & 1)) continue;
      if (!(set >> i & 1)) gap = 1;
      else if (gap) is_leading = false;
    }
    int sign = 0;
    bool by_numbers;
    pl_expr minor = minor_of(d, l->K, l->n, set);
    bool known = sign_of(d, minor, &sign, &by_numbers);
    int weak = 0;  // -√(...): negative wherever it does not vanish
    bool never = pl_alg_sign_proven(d->tower, minor, true, &weak) == PL_YES && weak < 0;
    if (never && !(known && sign == 0)) {
      sign = -1;
      known = true;
      by_numbers = false;
    }
    if (known && sign < 0 && !by_numbers) {
      *out = (pl_verdict){.word = l->gyroscopic ? NULL : "unstable",
                          .doubt = l->gyroscopic ? PL_DOUBT_GYROSCOPIC : PL_DOUBT_NONE};
      return;
    }
    if (known && sign < 0) out->at_numbers = l->gyroscopic ? NULL : "unstable";
    if (!is_leading) continue;
    leading++;
    if (known && sign == 0 && !by_numbers) zero = true;
    if (!known || sign == 0)
      out->at_numbers = out->at_numbers && strcmp(out->at_numbers, "unstable") == 0
                            ? out->at_numbers
                            : NULL;
    if (!known || by_numbers) out->condition[out->n++] = minor;
  }
  if (zero) *out = (pl_verdict){.doubt = PL_DOUBT_DEGENERATE};
  else if (out->n == 0) out->word = "stable";
  if (out->n > 0 && l->gyroscopic && (!out->at_numbers || strcmp(out->at_numbers, "stable") != 0))
    out->doubt = PL_DOUBT_GYROSCOPIC;
}

void pl_stability(pl_analysis* d, const pl_expr* f, const pl_linearised* l, const pl_rest* r,
                  pl_verdict* out) {
  *out = (pl_verdict){.word = NULL};
  unsigned held = 0;
  for (int k = 0; k < l->n; k++) held |= pl_is_poison(r->q[k]) ? 0 : 1u << k;
  out->doubt = doubt_of(d, l);
  if (is_blown_up(d, l)) *out = (pl_verdict){.word = "unstable", .at_numbers = "unstable"};
  else if (!out->doubt && held == 0)
    *out = (pl_verdict){.word = "marginal", .at_numbers = "marginal"};
  if (out->word || out->doubt) return;
  judge_minors(d, l, held, out);
  bool simple = l->n == 1 && !pl_nonholonomic(d);
  if (simple && out->doubt == PL_DOUBT_DEGENERATE) {
    out->word = by_higher_derivatives(d, f, r, false);
    if (out->word) out->doubt = PL_DOUBT_NONE;
  } else if (simple && out->n > 0 && pl_number(d, out->condition[0]) == 0) {
    out->at_numbers = by_higher_derivatives(d, f, r, true);
  }
  if (out->word) out->at_numbers = out->word;
}

pl_symbol pl_omega_squared(pl_analysis* d) {
  bool taken = pl_symbol_find(d->pool, "omega").id != 0;  // the model has an ω of its own
  pl_symbol_info info = {.name = taken ? "Ω²" : "ω²",
                         .ascii = "omega_squared",
                         .role = PL_R_LOCAL,
                         .class = PL_C_OTHER,
                         .dimension = pl_dimension_of(0, 0, -2),
                         .dimension_known = true};
  return pl_symbol_make(d->pool, &info);
}

// det(K - ω² M); with gyroscopic terms det(K + s C + s² M), which is even in s, at s² = -ω².
// Damping is left out: what is
// given then are the frequencies of the undamped system, and that is said.
static pl_expr characteristic(pl_analysis* d, const pl_linearised* l, pl_symbol w2) {
  pl_pool* p = d->pool;
  int n = l->n;
  pl_symbol_info info = {
      .name = "s", .ascii = "characteristic_s", .role = PL_R_LOCAL, .class = PL_C_OTHER};
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
  int degree = pl_alg_coefficients(d->tower, pl_alg_det(d->tower, n, A, 20000), s, c,
                                   2 * pl_max_gen);
  pl_expr sum = degree < 0 ? pl_poison() : pl_int(p, 0);
  for (int k = 0; k <= degree; k += 2) {
    sum = pl_add(p, sum, pl_mul(p, c[k], pl_pow_int(p, pl_neg(p, pl_sym(p, w2)), k / 2)));
  }
  return sum;
}

int pl_small_oscillations(pl_analysis* d, const pl_linearised* l, pl_root* root, int max,
                          bool* complete) {
  pl_symbol w2 = pl_omega_squared(d);
  return pl_alg_roots(d->tower, characteristic(d, l, w2), w2, root, max, complete);
}
