// structured: multipliers and accelerations that are too long to be written out. What is shown
// instead is the linear system
// that determines them, with a name for each entry, and its solution over the names.
//
// Multipliers: M a = F + G^T λ in the constraints twice differentiated, Γ a + γ = 0, gives (Γ M^-1
// G^T) λ = -γ - Γ M^-1 F. Where M falls into blocks of at most three rows this is written out; else
// accelerations and multipliers stay together. Along a chain of rods the matrix is tridiagonal.
// Entries come from raw differentiation, what is shown of them from the tower; each is claimed, and
// so are the rows of the system and its solution.
// See theory (3.4), (3.5).
#include <math.h>

#include "mechanics/structured.h"

enum { most_unknowns = 200, largest_block = 3, most_levels = 4 };
// operations of an entry; beyond it accelerations and multipliers stay together
static const long longest_entry = 80;
static const long entry_terms = 400;  // cap of the inverse of a block

// -------------------------------------------------------------------------- rows of the first kind
typedef struct pl_first_kind {
  int n, m;  // coordinates, bonds
  int *coordinate, *bond;
  pl_expr *M, *F;             // (n x n), (n)
  pl_expr *push, *G, *gamma;  // gradient (m x n), d g''/d a (m x n), rest of g'' (m)
} pl_first_kind;

static pl_expr without(pl_analysis* d, pl_expr e) {  // accelerations
  pl_replace* zero = PL_ARRAY(d->arena, pl_replace, d->q.n + 1);
  for (int j = 0; j < d->q.n; j++) zero[j] = (pl_replace){d->q.at[j].a, pl_int(d->pool, 0)};
  return pl_subst(d->pool, e, zero, d->q.n);
}

static pl_expr placed(pl_analysis* d, pl_expr e) { return pl_on_maps(d, pl_on_contact(d, e)); }

// An entry that vanishes becomes the number 0.
static pl_expr tidy(pl_analysis* d, pl_expr e) {
  if (pl_is_zero_node(d->pool, e) || pl_is_number(d->pool, e)) return e;
  return pl_alg_is_zero(d->tower, e) == PL_YES ? pl_int(d->pool, 0) : e;
}

static bool collect_first_kind(pl_analysis* d, pl_first_kind* k) {
  *k = (pl_first_kind){.coordinate = PL_ARRAY(d->arena, int, d->q.n + 1),
                       .bond = PL_ARRAY(d->arena, int, d->g.n + 1)};
  if (d->hidden.n > 0 || pl_loaded_by_name(d) >= 0) return false;
  for (int i = 0; i < d->q.n; i++) {
    if (d->q.at[i].carries && d->q.at[i].fixed_by < 0) k->coordinate[k->n++] = i;
  }
  for (int j = 0; j < d->g.n; j++) {
    if (d->g.at[j].shared) return false;  // not determined
    if (d->g.at[j].fixes < 0 && !d->g.at[j].implied) k->bond[k->m++] = j;
  }
  int n = k->n, m = k->m;
  if (n == 0 || n + m > most_unknowns) return false;
  k->M = PL_ARRAY(d->arena, pl_expr, n * n);
  k->F = PL_ARRAY(d->arena, pl_expr, n);
  k->push = PL_ARRAY(d->arena, pl_expr, n * m + 1);
  k->G = PL_ARRAY(d->arena, pl_expr, n * m + 1);
  k->gamma = PL_ARRAY(d->arena, pl_expr, m + 1);
  for (int i = 0; i < n; i++) {
    pl_expr e = pl_on_contact(d, d->euler[k->coordinate[i]]);
    for (int j = 0; j < n; j++)
      k->M[i * n + j] = tidy(d, placed(d, pl_diff(d->pool, e, d->q.at[k->coordinate[j]].a)));
    k->F[i] = placed(d, pl_neg(d->pool, without(d, e)));
  }
  for (int b = 0; b < m; b++) {
    pl_expr gdd = pl_on_contact(d, pl_bond_acceleration(d, k->bond[b]));
    for (int i = 0; i < n; i++) {
      k->G[b * n + i] = tidy(d, placed(d, pl_diff(d->pool, gdd, d->q.at[k->coordinate[i]].a)));
      k->push[b * n + i] = tidy(d, placed(d, d->g.at[k->bond[b]].push[k->coordinate[i]]));
    }
    k->gamma[b] = placed(d, without(d, gdd));
  }
  return true;
}

// ------------------------------------------------------------------------------------- blocks of M
static int block_of(const pl_analysis* d, const pl_first_kind* k, int first, bool* seen,
                    int* member) {
  int count = 0;
  member[count++] = first;
  seen[first] = true;
  for (int at = 0; at < count; at++) {
    for (int j = 0; j < k->n; j++) {
      bool linked = !pl_is_zero_node(d->pool, k->M[member[at] * k->n + j])
                    || !pl_is_zero_node(d->pool, k->M[j * k->n + member[at]]);
      if (seen[j] || !linked) continue;
      seen[j] = true;
      member[count++] = j;
    }
  }
  return count;
}

static bool invert_block(pl_analysis* d, const pl_first_kind* k, const int* member, int count,
                         pl_expr* W) {
  if (count > largest_block) return false;
  pl_expr A[largest_block * largest_block], b[largest_block], x[largest_block];
  for (int i = 0; i < count; i++) {
    for (int j = 0; j < count; j++) A[i * count + j] = k->M[member[i] * k->n + member[j]];
  }
  for (int j = 0; j < count; j++) {
    for (int i = 0; i < count; i++) b[i] = pl_int(d->pool, i == j);
    if (count == 1) {
      if (pl_is_zero_node(d->pool, A[0])) return false;
      x[0] = pl_pow_int(d->pool, A[0], -1);
    } else if (pl_alg_solve(d->tower, count, A, b, x, entry_terms) != PL_YES) {
      return false;
    }
    for (int i = 0; i < count; i++) W[member[i] * k->n + member[j]] = x[i];
  }
  return true;
}

static bool invert_mass(pl_analysis* d, const pl_first_kind* k, pl_expr* W) {
  bool* seen = PL_ARRAY(d->arena, bool, k->n);
  int* member = PL_ARRAY(d->arena, int, k->n);
  for (int i = 0; i < k->n * k->n; i++) W[i] = pl_int(d->pool, 0);
  for (int i = 0; i < k->n; i++) {
    if (seen[i]) continue;
    int count = block_of(d, k, i, seen, member);
    if (!invert_block(d, k, member, count, W)) return false;
  }
  return true;
}

// ------------------------------------------------------------------------------------- the systems
static pl_structure* make(pl_analysis* d, pl_structure_kind kind, int n) {
  pl_structure* s = PL_NEW(d->arena, pl_structure);
  *s = (pl_structure){.kind = kind, .n = n};
  s->u = PL_ARRAY(d->arena, pl_symbol, n);
  s->bond = PL_ARRAY(d->arena, int, n);
  s->S = PL_ARRAY(d->arena, pl_expr, n * n);
  s->R = PL_ARRAY(d->arena, pl_expr, n);
  for (int i = 0; i < n; i++) s->bond[i] = -1;
  return s;
}

static pl_structure* multipliers(pl_analysis* d, const pl_first_kind* k) {
  int n = k->n, m = k->m;
  pl_expr* W = PL_ARRAY(d->arena, pl_expr, n * n);
  if (m == 0 || !invert_mass(d, k, W)) return NULL;
  pl_structure* s = make(d, PL_ST_MULTIPLIERS, m);
  pl_expr* GW = PL_ARRAY(d->arena, pl_expr, m * n);
  for (int b = 0; b < m; b++) {
    for (int j = 0; j < n; j++) {
      GW[b * n + j] = pl_int(d->pool, 0);
      for (int i = 0; i < n; i++) {
        pl_expr product = pl_mul(d->pool, k->G[b * n + i], W[i * n + j]);
        GW[b * n + j] = pl_add(d->pool, GW[b * n + j], product);
      }
    }
  }
  for (int b = 0; b < m; b++) {
    s->u[b] = d->g.at[k->bond[b]].lambda;
    s->bond[b] = k->bond[b];
    pl_expr right = k->gamma[b];
    for (int j = 0; j < n; j++)
      right = pl_add(d->pool, right, pl_mul(d->pool, GW[b * n + j], k->F[j]));
    s->R[b] = tidy(d, pl_neg(d->pool, right));
    for (int c = 0; c < m; c++) {
      pl_expr sum = pl_int(d->pool, 0);
      for (int j = 0; j < n; j++)
        sum = pl_add(d->pool, sum, pl_mul(d->pool, GW[b * n + j], k->push[c * n + j]));
      s->S[b * m + c] = tidy(d, sum);
    }
  }
  return s;
}

// Rows of the constraints carry the sign that makes the whole symmetric.
static pl_structure* both(pl_analysis* d, const pl_first_kind* k) {
  int n = k->n, m = k->m, all = n + m;
  pl_structure* s = make(d, PL_ST_BOTH, all);
  for (int i = 0; i < all * all; i++) s->S[i] = pl_int(d->pool, 0);
  for (int i = 0; i < n; i++) {
    s->u[i] = d->q.at[k->coordinate[i]].a;
    s->R[i] = tidy(d, k->F[i]);
    for (int j = 0; j < n; j++) s->S[i * all + j] = k->M[i * n + j];
    for (int b = 0; b < m; b++) s->S[i * all + n + b] = pl_neg(d->pool, k->push[b * n + i]);
  }
  bool minus = d->model->lambda_minus;
  for (int b = 0; b < m; b++) {
    s->u[n + b] = d->g.at[k->bond[b]].lambda;
    s->bond[n + b] = k->bond[b];
    s->R[n + b] = tidy(d, minus ? pl_neg(d->pool, k->gamma[b]) : k->gamma[b]);
    for (int i = 0; i < n; i++)
      s->S[(n + b) * all + i] = minus ? k->G[b * n + i] : pl_neg(d->pool, k->G[b * n + i]);
  }
  return s;
}

static pl_structure* accelerations(pl_analysis* d) {
  int n = d->gen.n;
  if (!d->reduced || n == 0 || n > most_unknowns || pl_nonholonomic(d) || d->hidden.n > 0)
    return NULL;
  pl_structure* s = make(d, PL_ST_ACCELERATIONS, n);
  for (int i = 0; i < n; i++) {
    pl_expr e = pl_second_kind(d, d->gen.at[i]);
    s->u[i] = d->q.at[d->gen.at[i]].a;
    for (int j = 0; j < n; j++)
      s->S[i * n + j] = tidy(d, pl_diff(d->pool, e, d->q.at[d->gen.at[j]].a));
    s->R[i] = tidy(d, pl_neg(d->pool, without(d, e)));
  }
  return s;
}

// ----------------------------------------------------------------------------- order along a chain
static int neighbours(const pl_analysis* d, const pl_structure* s, int k, int* out) {
  int n = 0;
  for (int j = 0; j < s->n; j++) {
    if (j != k && !pl_is_zero_node(d->pool, s->S[k * s->n + j])) out[n++] = j;
  }
  return n;
}

// Rows so that neighbours follow each other; false when some row has three neighbours or they close
// a ring.
static bool walk(pl_analysis* d, const pl_structure* s, int* order) {
  bool* seen = PL_ARRAY(d->arena, bool, s->n);
  int* near = PL_ARRAY(d->arena, int, s->n);
  int count = 0;
  for (int k = 0; k < s->n; k++) {
    if (neighbours(d, s, k, near) > 2) return false;
  }
  for (int first = 0; first < s->n; first++) {
    if (seen[first] || neighbours(d, s, first, near) > 1) continue;
    for (int at = first; at >= 0;) {
      seen[at] = true;
      order[count++] = at;
      int degree = neighbours(d, s, at, near), next = -1;
      for (int j = 0; j < degree; j++) next = seen[near[j]] ? next : near[j];
      at = next;
    }
  }
  return count == s->n;
}

static void reorder(pl_analysis* d, pl_structure* s, const int* order) {
  pl_structure* old = PL_NEW(d->arena, pl_structure);
  *old = *s;
  s->u = PL_ARRAY(d->arena, pl_symbol, s->n);
  s->bond = PL_ARRAY(d->arena, int, s->n);
  s->S = PL_ARRAY(d->arena, pl_expr, s->n * s->n);
  s->R = PL_ARRAY(d->arena, pl_expr, s->n);
  for (int i = 0; i < s->n; i++) {
    s->u[i] = old->u[order[i]];
    s->bond[i] = old->bond[order[i]];
    s->R[i] = old->R[order[i]];
    for (int j = 0; j < s->n; j++) s->S[i * s->n + j] = old->S[order[i] * s->n + order[j]];
  }
}

// --------------------------------------------------------------------------------- entries by name
// p of p or p^2; 0
static pl_symbol symbol_of_level(pl_analysis* d, pl_expr c) {
  if (pl_kind_of(d->pool, c) == PL_SYMBOL) return pl_symbol_of(d->pool, c);
  long two;
  bool square = pl_kind_of(d->pool, c) == PL_POW && pl_is_int(d->pool, pl_arg(d->pool, c, 1), &two)
                && two == 2;
  bool plain = square && pl_kind_of(d->pool, pl_arg(d->pool, c, 0)) == PL_SYMBOL;
  return plain ? pl_symbol_of(d->pool, pl_arg(d->pool, c, 0)) : (pl_symbol){0};
}

// P of a constraint P = c with c = p or p^2 of a parameter p: where the constraint holds P may be
// written c. There may be
// several, one for each such term; false when `which` is beyond the last.
static bool level_of(pl_analysis* d, const pl_bond* l, int which, pl_expr* P, pl_expr* c) {
  if (l->fixes >= 0 || l->implied || l->velocity || d->reduced) return false;
  pl_expr g = pl_alg_normal(d->tower, pl_on_contact(d, l->g));
  int n = pl_kind_of(d->pool, g) == PL_ADD ? pl_n_args(d->pool, g) : 0;
  for (int k = 0; k < n; k++) {
    pl_expr term = pl_arg(d->pool, g, k), opposite = pl_neg(d->pool, term);
    bool plus = symbol_of_level(d, term).id != 0, minus = symbol_of_level(d, opposite).id != 0;
    if ((!plus && !minus) || pl_has_coordinates(d, term) || which-- > 0) continue;
    pl_expr rest = pl_sub(d->pool, g, term);
    *P = minus ? rest : pl_neg(d->pool, rest);
    *c = minus ? opposite : term;
    return !pl_has_symbol(d->pool, rest, symbol_of_level(d, *c));
  }
  return false;
}

bool pl_structure_level(pl_analysis* d, int level, pl_replace* out) {
  pl_expr P, c;
  if (level < 0 || !level_of(d, &d->g.at[level / most_levels], level % most_levels, &P, &c))
    return false;
  bool square = pl_kind_of(d->pool, c) == PL_POW;
  *out = (pl_replace){symbol_of_level(d, c), square ? pl_sqrt(d->pool, P) : P};
  return true;
}

// Factors P of an entry written as c, of one constraint.
static pl_expr on_level(pl_analysis* d, pl_expr e, int* bond) {  // bond and its term, -1
  pl_factor f[16];
  pl_expr unit, P, c;
  *bond = -1;
  if (d->reduced || pl_is_number(d->pool, e)) return e;
  int n = pl_alg_factors(d->tower, e, f, 16, &unit);
  for (int b = 0; b < d->g.n * most_levels && n < 16 && *bond < 0; b++) {
    if (!level_of(d, &d->g.at[b / most_levels], b % most_levels, &P, &c)) continue;
    for (int k = 0; k < n; k++) {
      if (!pl_has_coordinates(d, f[k].base)) continue;
      if (pl_alg_is_zero(d->tower, pl_sub(d->pool, f[k].base, P)) != PL_YES) continue;
      f[k].base = c;
      *bond = b;
    }
  }
  if (*bond < 0) return e;
  pl_expr product = unit;
  for (int k = 0; k < n; k++)
    product = pl_mul(d->pool, product, pl_pow_int(d->pool, f[k].base, f[k].power));
  return pl_alg_normal(d->tower, product);
}

static bool is_taken(pl_analysis* d, const char* letter, int n) {
  for (int j = 1; j <= n; j++) {
    if (pl_symbol_find(d->pool, pl_format(d->arena, "%s_%d", letter, j)).id) return true;
    // how the model's A_1 is spelled
    if (pl_symbol_find(d->pool, pl_format(d->arena, "%s%d", letter, j)).id) return true;
    if (pl_symbol_find(d->pool, pl_format(d->arena, "%s_%d%d", letter, j, j)).id) return true;
  }
  return pl_symbol_find(d->pool, letter).id != 0;
}

// The letter, or the next one of its list that the model does not use.
static const char* free_letter(pl_analysis* d, const char* const* list, int n) {
  for (int k = 0; list[k]; k++) {
    if (!is_taken(d, list[k], n)) return list[k];
  }
  const char* letter = pl_format(d->arena, "%s%s", list[0], list[0]);
  while (is_taken(d, letter, n)) letter = pl_format(d->arena, "%s%s", letter, list[0]);
  return letter;
}

static void choose_letters(pl_analysis* d, pl_structure* s) {
  static const char* const of_multipliers[6][4] = {{"A", "S", NULL}, {"B", "Q", NULL},
                                                   {"R", "W", NULL}, {"D", "P", NULL},
                                                   {"C", "U", NULL}, {"Y", "X", NULL}};
  static const char* const of_both[6][4] = {{"K", "A", NULL}, {"K", "A", NULL}, {"R", "W", NULL},
                                            {"D", "P", NULL}, {"C", "U", NULL}, {"Y", "X", NULL}};
  static const char* const of_accelerations[6][4] = {{"M", "J", NULL}, {"M", "J", NULL},
                                                     {"h", "H", NULL}, {"N", "P", NULL},
                                                     {"U", "V", NULL}, {"Z", "X", NULL}};
  for (int k = 0; k < 6; k++) {
    const char* const* list = s->kind == PL_ST_ACCELERATIONS ? of_accelerations[k]
                              : s->kind == PL_ST_BOTH        ? of_both[k]
                                                             : of_multipliers[k];
    bool again = k == 1 && (s->kind != PL_ST_MULTIPLIERS || !s->chain);
    s->letter[k] = again ? s->letter[0] : free_letter(d, list, s->n);
  }
}

pl_symbol pl_structure_name(pl_analysis* d, const pl_structure* s, const char* letter, int j, int k,
                            pl_expr of) {
  int n = s->n;
  const char* text = j < 0   ? letter
                     : k < 0 ? pl_format(d->arena, "%s_%d", letter, j + 1)
                             : pl_format(d->arena, n < 10 ? "%s_%d%d" : "%s_%d_%d", letter, j + 1,
                                         k + 1);
  // right sides stand behind the coefficients and are collected for
  bool right = k < 0 && (letter == s->letter[2] || letter == s->letter[5]);
  pl_symbol_info info = {
      .name = text, .ascii = text, .role = PL_R_LOCAL, .class = right ? PL_C_COORD : PL_C_OTHER};
  info.dimension = pl_dimension_of_expr(d, of, &info.dimension_known);
  return pl_symbol_make(d->pool, &info);
}

const pl_form* pl_structure_form(pl_analysis* d, pl_expr e, pl_style style) {
  return pl_form_positive_first(d->arena, pl_present(d->tower, e, style, d->effort_s));
}

static bool add_entry(pl_analysis* d, pl_structure* s, pl_expr raw, const char* letter, int j,
                      int k, pl_symbol* out) {
  if (pl_is_zero_node(d->pool, raw)) return true;
  int bond;
  pl_expr normal = pl_alg_normal(d->tower, raw), level = on_level(d, normal, &bond);
  const pl_form* form = pl_structure_form(d, level, PL_S_QUOTIENT);
  pl_naming line = {.raw = raw, .value = pl_form_value(d->pool, form), .form = form, .level = bond};
  line.exact = bond < 0 ? line.value : normal;
  line.name = *out = pl_structure_name(d, s, letter, j, k, line.value);
  pl_push(d->arena, s->lines, line);
  return s->kind != PL_ST_MULTIPLIERS || pl_form_ops(form) <= longest_entry;
}

static bool name_entries(pl_analysis* d, pl_structure* s) {
  int n = s->n;
  bool short_enough = true;
  s->S_name = PL_ARRAY(d->arena, pl_symbol, n * n);
  s->R_name = PL_ARRAY(d->arena, pl_symbol, n);
  for (int k = 0; k < n; k++) {
    short_enough &= add_entry(d, s, s->S[k * n + k], s->letter[0], k, s->chain ? -1 : k,
                              &s->S_name[k * n + k]);
  }
  for (int j = 0; j < n; j++) {
    for (int k = j + 1; k < n; k++) {
      short_enough &= add_entry(d, s, s->S[j * n + k], s->letter[1], j, s->chain ? -1 : k,
                                &s->S_name[j * n + k]);
      s->S_name[k * n + j] = s->S_name[j * n + k];
    }
  }
  for (int k = 0; k < n; k++)
    short_enough &= add_entry(d, s, s->R[k], s->letter[2], k, -1, &s->R_name[k]);
  s->n_entries = s->lines.n;
  return short_enough;
}

static bool is_symmetric(pl_analysis* d, const pl_structure* s) {
  for (int j = 0; j < s->n; j++) {
    for (int k = 0; k < j; k++) {
      pl_expr a = s->S[j * s->n + k], b = s->S[k * s->n + j];
      if (!pl_same(a, b) && pl_alg_equal(d->tower, a, b) != PL_YES) return false;
    }
  }
  return true;
}

// ---------------------------------------------------------------------------------- is it regular?
// Nested functions may hide from the algebra that rows depend on each other. Elimination with
// complete pivoting; the least
// pivot as a part of the largest.
static double least_pivot(double* A, int n) {
  double largest = 0, pivot = 0;
  for (int step = 0; step < n; step++) {
    int row = step, column = step;
    for (int i = step; i < n; i++)
      for (int j = step; j < n; j++)
        if (fabs(A[i * n + j]) > fabs(A[row * n + column])) {
          row = i;
          column = j;
        }
    pivot = fabs(A[row * n + column]);
    if (step == 0) largest = pivot;
    if (!(pivot > 0)) return pivot;
    for (int j = 0; j < n; j++) {
      double x = A[row * n + j];
      A[row * n + j] = A[step * n + j];
      A[step * n + j] = x;
    }
    for (int i = 0; i < n; i++) {
      double x = A[i * n + column];
      A[i * n + column] = A[i * n + step];
      A[i * n + step] = x;
    }
    for (int i = step + 1; i < n; i++) {
      double part = A[i * n + step] / A[step * n + step];
      for (int j = step; j < n; j++) A[i * n + j] -= part * A[step * n + j];
    }
  }
  return pivot / largest;
}

// Singular at random points of numbers, each time.
static bool is_singular(pl_analysis* d, const pl_structure* s) {
  enum { points = 4 };
  static const double rounding = 1e-11;
  int n = s->n, symbols = pl_symbol_count(d->pool);
  double *A = PL_ARRAY(d->arena, double, n*n), *value = PL_ARRAY(d->arena, double, symbols + 1);
  pl_random r = {20260};
  for (int k = 0; k < points; k++) {
    for (int i = 0; i <= symbols; i++) value[i] = 0.4 + pl_random_unit(&r);
    for (int i = 0; i < n * n; i++) A[i] = pl_eval(d->pool, s->S[i], value);
    double least = least_pivot(A, n);
    if (!(least <= rounding)) return false;  // regular, or without a number here
  }
  return true;
}

static pl_structure* finish(pl_analysis* d, pl_structure* s) {
  if (!s || !is_symmetric(d, s) || is_singular(d, s)) return NULL;
  int* order = PL_ARRAY(d->arena, int, s->n);
  s->chain = s->kind == PL_ST_MULTIPLIERS && walk(d, s, order);
  if (s->chain) reorder(d, s, order);
  choose_letters(d, s);
  return name_entries(d, s) && pl_structure_solve(d, s) ? s : NULL;
}

// -------------------------------------------------------------------------------- for the sections
pl_structure* pl_structure_of_multipliers(pl_analysis* d) {
  if (d->multipliers_tried) return d->of_multipliers;
  d->multipliers_tried = true;
  pl_first_kind k;
  if (!collect_first_kind(d, &k)) return NULL;
  d->of_multipliers = finish(d, multipliers(d, &k));
  if (!d->of_multipliers && !d->reduced) d->of_multipliers = finish(d, both(d, &k));
  return d->of_multipliers;
}

pl_structure* pl_structure_of_accelerations(pl_analysis* d) {
  if (d->accelerations_tried) return d->of_accelerations;
  d->accelerations_tried = true;
  d->of_accelerations = finish(d, accelerations(d));
  return d->of_accelerations;
}

int pl_structure_definitions(pl_analysis* d, pl_definition* out, int max) {
  const pl_structure* both[2] = {d->of_multipliers, d->of_accelerations};
  int n = 0;
  for (int c = 0; c < 2; c++) {
    for (int k = 0; both[c] && k < both[c]->n_entries + both[c]->n_pivots; k++) {
      if (n < max) out[n] = (pl_definition){both[c]->lines.at[k].name, both[c]->lines.at[k].exact};
      n++;
    }
  }
  return n;
}
