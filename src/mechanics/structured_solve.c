// structured_solve: S u = R with named entries, solved over the names.
//
// Small systems: u_k = N_k/D by minors over the names, D = det S with a name of its own.
// Tridiagonal ones grow like Fibonacci numbers. Larger ones: S = C^T D^-1 C row by row, without
// pivoting but along an order in which no pivot vanishes at a random point modulo p (matrices M and
// G M^-1 G^T are definite, so the given order does; a system of both begins with M):
//   D_k = S_kk - sum_i C_ik^2/D_i,   C_kj = S_kj - sum_i C_ik C_ij/D_i,
//   Y_k = R_k - sum_i C_ik Y_i/D_i   (i before k)
//   u_k = (Y_k - sum_j C_kj u_j)/D_k   (j after k)
// For a tridiagonal S this is O(n) lines.   [GolubVanLoan2013, sections 4.1, 4.3]
#include "mechanics/structured.h"

enum { most_closed = 7, closed_terms = 400, tries = 8 };
static const long longest_closed = 45;  // operations of one unknown over the names

static pl_expr named(pl_analysis* d, pl_symbol s) {
  return s.id ? pl_sym(d->pool, s) : pl_int(d->pool, 0);
}

// ------------------------------------------------------------------------------- without recursion
// Whether the denominator of an unknown is the determinant itself: where the system falls apart it
// is a part of it.
static bool needs_determinant(pl_analysis* d, pl_expr x, pl_expr det) {
  pl_expr num, den;
  pl_alg_fraction(d->tower, x, &num, &den);
  return !pl_is_zero_node(d->pool, num)
         && pl_is_number(d->pool, pl_alg_normal(d->tower, pl_div(d->pool, det, den)));
}

static bool solve_closed(pl_analysis* d, pl_structure* s) {
  int n = s->n;
  if (n > most_closed) return false;
  pl_expr *A = PL_ARRAY(d->arena, pl_expr, n * n), *b = PL_ARRAY(d->arena, pl_expr, n),
          *x = PL_ARRAY(d->arena, pl_expr, n);
  for (int k = 0; k < n * n; k++) A[k] = named(d, s->S_name[k]);
  for (int k = 0; k < n; k++) b[k] = named(d, s->R_name[k]);
  if (pl_alg_solve(d->tower, n, A, b, x, closed_terms) != PL_YES) return false;
  pl_expr det = pl_alg_det(d->tower, n, A, closed_terms);
  if (pl_is_poison(det)) return false;
  const pl_form** form = PL_ARRAY(d->arena, const pl_form*, n);
  pl_naming D = {.level = -1, .form = pl_structure_form(d, det, PL_S_PLAIN)};
  if (pl_form_ops(D.form) > longest_closed) return false;
  D.value = D.exact = pl_form_value(d->pool, D.form);
  D.name = pl_structure_name(d, s, s->letter[3], -1, -1, D.value);
  const pl_form* denominator = pl_form_leaf(d->arena, pl_sym(d->pool, D.name));
  bool whole = false;  // some unknown needs all of the determinant, which then has a name
  for (int k = 0; k < n; k++) {
    bool over_det = n > 1 && needs_determinant(d, x[k], det);
    const pl_form* numerator =
        over_det
            ? pl_structure_form(d, pl_alg_normal(d->tower, pl_mul(d->pool, x[k], det)), PL_S_PLAIN)
            : pl_structure_form(d, x[k], PL_S_QUOTIENT);
    if (pl_form_ops(numerator) > longest_closed) return false;
    form[k] = over_det ? pl_form_quotient(d->arena, numerator, denominator) : numerator;
    whole |= over_det;
  }
  if (whole) {
    pl_push(d->arena, s->lines, D);
    s->n_pivots = 1;
  }
  for (int k = 0; k < n; k++) {
    pl_expr value = pl_form_value(d->pool, form[k]);
    s->solution[k] = value;
    pl_push(
        d->arena, s->lines,
        (pl_naming){.name = s->u[k], .value = value, .exact = value, .form = form[k], .level = -1});
  }
  return true;
}

// -------------------------------------------------------------------------------------- row by row
typedef struct pl_elimination {
  pl_analysis* d;
  pl_structure* s;
  // what is left of S and R, over names (n x n), (n)
  pl_expr *W, *y;
  // S at a random point modulo p, eliminated alongside (n x n)
  uint64_t* at_point;
  bool* done;
} pl_elimination;

static uint64_t minus_mod(uint64_t a) { return a ? PL_MOD_P - a : 0; }

static bool draw(pl_elimination* e, uint64_t seed) {
  pl_mod_point* m = pl_mod_point_make(e->d->arena, e->d->pool, seed);
  bool ok = true;
  for (int k = 0; k < e->s->n * e->s->n && ok; k++)
    e->at_point[k] = pl_eval_mod(m, e->s->S[k], &ok);
  return ok;
}

static int entries_left(const pl_elimination* e, int k) {
  int count = 0;
  for (int j = 0; j < e->s->n; j++)
    count += !e->done[j] && !pl_is_zero_node(e->d->pool, e->W[k * e->s->n + j]);
  return count;
}

// The next row: the given order while its pivots do not vanish; where accelerations and multipliers
// stand together, the row
// with the fewest entries.
static int choose_pivot(const pl_elimination* e) {
  int best = -1, fewest = 0;
  for (int k = 0; k < e->s->n; k++) {
    if (e->done[k] || e->at_point[k * e->s->n + k] == 0) continue;
    if (e->s->kind != PL_ST_BOTH) return k;
    int count = entries_left(e, k);
    if (best >= 0 && count >= fewest) continue;
    best = k;
    fewest = count;
  }
  return best;
}

static const pl_form* plain_form(pl_analysis* d, pl_expr e) {
  return pl_form_positive_first(d->arena, pl_form_of(d->arena, d->pool, e));
}

static pl_expr give_name(pl_elimination* e, const char* letter, int j, int k, pl_expr value,
                         bool always) {
  if (pl_is_zero_node(e->d->pool, value)) return value;
  if (!always && pl_kind_of(e->d->pool, value) == PL_SYMBOL) return value;
  pl_naming line = {.value = value, .exact = value, .form = plain_form(e->d, value), .level = -1};
  line.name = pl_structure_name(e->d, e->s, letter, j, k, value);
  pl_push(e->d->arena, e->s->lines, line);
  return pl_sym(e->d->pool, line.name);
}

static void eliminate(pl_elimination* e, int k, int step) {
  pl_pool* p = e->d->pool;
  int n = e->s->n;
  bool uniform = e->s->kind != PL_ST_BOTH;
  bool chain = e->s->chain;
  e->done[k] = true;
  e->s->pivot_order[step] = k;
  pl_expr* row = e->W + k * n;
  row[k] = give_name(e, e->s->letter[3], k, -1, row[k], uniform);
  for (int j = 0; j < n; j++) {
    if (!e->done[j]) row[j] = give_name(e, e->s->letter[4], k, j, row[j], uniform && !chain);
  }
  e->y[k] = give_name(e, e->s->letter[5], k, -1, e->y[k], uniform);
  uint64_t inverse = pl_mod_inv(e->at_point[k * n + k]);
  for (int i = 0; i < n; i++) {
    if (e->done[i] || pl_is_zero_node(p, row[i])) continue;
    pl_expr factor = pl_neg(p, pl_div(p, row[i], row[k]));
    for (int j = 0; j < n; j++) {
      if (e->done[j] || pl_is_zero_node(p, row[j])) continue;
      e->W[i * n + j] = pl_add(p, e->W[i * n + j], pl_mul(p, factor, row[j]));
      uint64_t push = pl_mod_mul(pl_mod_mul(e->at_point[k * n + i], e->at_point[k * n + j]),
                                 inverse);
      e->at_point[i * n + j] = pl_mod_add(e->at_point[i * n + j], minus_mod(push));
    }
    if (!pl_is_zero_node(p, e->y[k])) e->y[i] = pl_add(p, e->y[i], pl_mul(p, factor, e->y[k]));
  }
}

static void substitute_back(pl_elimination* e) {
  pl_pool* p = e->d->pool;
  pl_structure* s = e->s;
  e->s->n_pivots = s->lines.n - s->n_entries;
  for (int step = s->n - 1; step >= 0; step--) {
    int k = s->pivot_order[step];
    pl_expr sum = e->y[k];
    for (int later = step + 1; later < s->n; later++) {
      int j = s->pivot_order[later];
      pl_expr c = e->W[k * s->n + j];
      if (!pl_is_zero_node(p, c)) sum = pl_sub(p, sum, pl_mul(p, c, pl_sym(p, s->u[j])));
    }
    pl_expr value = pl_div(p, sum, e->W[k * s->n + k]);
    s->solution[k] = value;
    const pl_form* form = pl_is_zero_node(p, sum)
                              ? plain_form(e->d, sum)
                              : pl_form_quotient(e->d->arena, plain_form(e->d, sum),
                                                 pl_form_of(e->d->arena, p, e->W[k * s->n + k]));
    pl_push(
        e->d->arena, s->lines,
        (pl_naming){.name = s->u[k], .value = value, .exact = value, .form = form, .level = -1});
  }
}

static bool solve_rows(pl_analysis* d, pl_structure* s) {
  int n = s->n;
  pl_elimination e = {.d = d,
                      .s = s,
                      .W = PL_ARRAY(d->arena, pl_expr, n * n),
                      .y = PL_ARRAY(d->arena, pl_expr, n),
                      .at_point = PL_ARRAY(d->arena, uint64_t, n * n),
                      .done = PL_ARRAY(d->arena, bool, n)};
  bool drawn = false;
  for (uint64_t seed = 1; seed <= tries && !drawn; seed++) drawn = draw(&e, seed * 104729u);
  if (!drawn) return false;
  for (int k = 0; k < n * n; k++) e.W[k] = named(d, s->S_name[k]);
  for (int k = 0; k < n; k++) e.y[k] = named(d, s->R_name[k]);
  s->natural = true;
  for (int step = 0; step < n; step++) {
    int k = choose_pivot(&e);
    if (k < 0) return false;
    s->natural &= k == step;
    eliminate(&e, k, step);
  }
  substitute_back(&e);
  return true;
}

bool pl_structure_solve(pl_analysis* d, pl_structure* s) {
  s->solution = PL_ARRAY(d->arena, pl_expr, s->n);
  s->pivot_order = PL_ARRAY(d->arena, int, s->n);
  s->closed = solve_closed(d, s);
  return s->closed || solve_rows(d, s);
}
