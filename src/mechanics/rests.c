// rests: positions of rest of the generalized coordinates, f_i(q) = 0 with f the equations of the
// second kind at rest.
// Equation after equation is solved for the one coordinate that is left in it; where no closed form
// exists, the known places (0, π/2, π)
// are tried, and with numbers for what is given all zeros of an equation in one coordinate are
// found by ball arithmetic.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mechanics/equilibria.h"
#include "mechanics/sides.h"

enum { max_tries = 60 };

static pl_symbol name_of(const pl_analysis* d, int place) { return d->q.at[d->gen.at[place]].q; }

// Generalized coordinate that is the only unknown one in e: its place, -1 none, -2 several.
static int only_unknown(const pl_analysis* d, pl_expr e, const pl_rest* r) {
  int found = -1;
  for (int k = 0; k < d->gen.n; k++) {
    if (!pl_is_poison(r->q[k]) || !pl_has_symbol(d->pool, e, name_of(d, k))) continue;
    if (found >= 0) return -2;
    found = k;
  }
  return found;
}

// -------------------------------------------------------------------------------- linear equations
// Of linear equations A q = b (rows x n) the independent rows and columns; the other coordinates
// stay free, a line or plane of
// positions.  False when the rows that are left over contradict, or a coefficient is not decided.
static bool solve_square(pl_analysis* d, int rows, int n, const pl_expr* A, const pl_expr* b,
                         const int* unknown, pl_rest* r) {
  int row[pl_max_gen], column[pl_max_gen];
  pl_expr transposed[pl_max_gen * pl_max_gen], S[pl_max_gen * pl_max_gen], c[pl_max_gen],
      x[pl_max_gen];
  int rank = pl_alg_rank(d->tower, rows, n, A, row);
  for (int k = 0; k < rank; k++) {
    for (int j = 0; j < n; j++) transposed[j * rank + k] = A[row[k] * n + j];
  }
  if (rank == 0 || pl_alg_rank(d->tower, n, rank, transposed, column) != rank) return false;
  for (int k = 0; k < rank; k++) {
    c[k] = b[row[k]];
    for (int j = 0; j < n; j++) {
      bool solved = false;
      for (int i = 0; i < rank; i++) solved |= column[i] == j;
      pl_expr free = pl_mul(d->pool, A[row[k] * n + j], pl_sym(d->pool, name_of(d, unknown[j])));
      if (!solved) c[k] = pl_sub(d->pool, c[k], free);
    }
    for (int i = 0; i < rank; i++) S[k * rank + i] = A[row[k] * n + column[i]];
  }
  if (pl_alg_solve(d->tower, rank, S, c, x, 20000) != PL_YES) return false;
  for (int i = 0; i < rank; i++) r->q[unknown[column[i]]] = pl_alg_normal(d->tower, x[i]);
  return true;
}

static bool at_rest_everywhere(pl_analysis* d, const pl_expr* f, const pl_rest* r) {
  for (int k = 0; k < d->gen.n; k++) {
    if (r->open && k == r->open_row) continue;
    if (!pl_vanishes(d, pl_insert_rest(d, f[k], r))) return false;
  }
  return true;
}

// Equations linear in the coordinates that are left: one position, or a line of them.
static bool solve_linear(pl_analysis* d, const pl_expr* f, pl_rest* r) {
  int unknown[pl_max_gen], n = 0, rows = 0;
  pl_expr A[pl_max_gen * pl_max_gen], b[pl_max_gen];
  for (int k = 0; k < d->gen.n; k++) {
    if (pl_is_poison(r->q[k])) unknown[n++] = k;
  }
  pl_replace zero[pl_max_gen];
  for (int j = 0; j < n; j++) zero[j] = (pl_replace){name_of(d, unknown[j]), pl_int(d->pool, 0)};
  for (int k = 0; k < d->gen.n; k++) {
    pl_expr e = pl_alg_normal(d->tower, pl_insert_rest(d, f[k], r));
    if (pl_is_zero_node(d->pool, e) || (r->open && k == r->open_row)) continue;
    for (int j = 0; j < n; j++) {
      A[rows * n + j] = pl_alg_normal(d->tower, pl_diff(d->pool, e, name_of(d, unknown[j])));
      if (pl_has_coordinates(d, A[rows * n + j])) return false;
    }
    b[rows++] = pl_neg(d->pool, pl_subst(d->pool, e, zero, n));
  }
  return n > 0 && solve_square(d, rows, n, A, b, unknown, r);
}

// ---------------------------------------------------------------------------------------- branches
static void search(pl_analysis* d, const pl_expr* f, pl_rest r, pl_rests* out);

// MIN(a, b) >= 0 is a >= 0 and b >= 0.  False where it can never hold.
static bool add_condition(pl_analysis* d, pl_rest* r, pl_expr e) {
  if (pl_is_poison(e)) return true;
  if (pl_kind_of(d->pool, e) == PL_CALL && pl_function_of(d->pool, e) == PL_MIN) {
    return add_condition(d, r, pl_arg(d->pool, e, 0)) && add_condition(d, r, pl_arg(d->pool, e, 1));
  }
  int sign = 0;
  if (pl_alg_sign_proven(d->tower, e, false, &sign) == PL_YES && sign < 0) return false;
  if (pl_alg_sign_proven(d->tower, e, true, &sign) == PL_YES && sign >= 0) return true;
  for (int k = 0; k < r->n_conditions; k++) {
    if (pl_alg_equal(d->tower, r->condition[k], e) == PL_YES) return true;
  }
  if (r->n_conditions < pl_max_conditions) r->condition[r->n_conditions++] = e;
  return true;
}

// Symmetric places that no solver needs to find.  A length has only 0.
static int known_places(pl_analysis* d, int place, pl_expr* at) {
  pl_pool* p = d->pool;
  const pl_symbol_info* s = pl_symbol_get(p, name_of(d, place));
  bool plain = !s->dimension_known || pl_dimension_equal(s->dimension, pl_dimension_one());
  int n = 0;
  at[n++] = pl_int(p, 0);
  if (!plain) return n;
  pl_expr half = pl_mul(p, pl_ratio(p, 1, 2), pl_pi(p));
  at[n++] = pl_pi(p);
  at[n++] = half;
  at[n++] = pl_neg(p, half);
  return n;
}

static bool is_among(pl_analysis* d, const pl_root* root, int n, pl_expr value) {
  for (int k = 0; k < n; k++) {
    if (pl_alg_equal(d->tower, root[k].value, value) == PL_YES) return true;
  }
  return false;
}

// Every x in e stands in a sine or cosine of a linear argument: places repeat with whole periods.
static bool repeats(pl_analysis* d, pl_expr e, pl_symbol x) {
  pl_pool* p = d->pool;
  if (!pl_has_symbol(p, e, x)) return true;
  pl_kind kind = pl_kind_of(p, e);
  if (kind == PL_SYMBOL || kind == PL_IF || kind == PL_SUM) return false;
  bool wave = kind == PL_CALL && (pl_function_of(p, e) == PL_SIN || pl_function_of(p, e) == PL_COS);
  if (wave && !pl_has_coordinates(d, pl_diff(p, pl_arg(p, e, 0), x))) return true;
  for (int k = 0; k < pl_n_args(p, e); k++) {
    if (!repeats(d, pl_arg(p, e, k), x)) return false;
  }
  return true;
}

static bool has_wave(pl_pool* p, pl_expr e, pl_symbol x) {
  bool wave = pl_kind_of(p, e) == PL_CALL
              && (pl_function_of(p, e) == PL_SIN || pl_function_of(p, e) == PL_COS);
  if (wave && pl_has_symbol(p, e, x)) return true;
  for (int k = 0; k < pl_n_args(p, e); k++) {
    if (has_wave(p, pl_arg(p, e, k), x)) return true;
  }
  return false;
}

static bool places_repeat(pl_analysis* d, pl_symbol x) {
  for (int k = 0; k < d->particle.n; k++) {
    const pl_particle* m = &d->particle.at[k];
    for (int c = 0; c < m->n; c++) {
      if (!repeats(d, pl_on_maps(d, m->at[c]), x)) return false;
    }
  }
  return true;
}

bool pl_rests_recur(pl_analysis* d, const pl_expr* f, int place) {
  bool wave = false;
  for (int k = 0; k < d->gen.n; k++) {
    wave |= has_wave(d->pool, f[k], name_of(d, place));
    if (!repeats(d, f[k], name_of(d, place))) return false;
  }
  return wave && !places_repeat(d, name_of(d, place));
}

// A solver gives one period. Where the system as a whole does not repeat, the places in other
// periods are others.
static bool stops_at_one_turn(pl_analysis* d, const pl_expr* f, pl_expr e, int j) {
  if (!has_wave(d->pool, e, name_of(d, j))) return false;
  for (int k = 0; k < d->gen.n; k++) {
    if (!repeats(d, f[k], name_of(d, j))) return true;
  }
  return false;
}

// One coordinate of a branch solved from e, and the search goes on from each root. What has no
// closed form stays open.
static void branch(pl_analysis* d, const pl_expr* f, const pl_rest* r, pl_expr e, int j, int row,
                   pl_rests* out) {
  enum { most = 12 };
  pl_root root[most + 4];
  bool complete = false;
  int n = pl_alg_roots(d->tower, e, name_of(d, j), root, most, &complete), places = 0;
  bool turns = complete && stops_at_one_turn(d, f, e, j);
  complete &= !turns;
  pl_expr place[4];
  if (!complete) places = known_places(d, j, place);
  for (int k = 0; k < places; k++) {
    bool fits = pl_vanishes(d, pl_subst1(d->pool, e, name_of(d, j), place[k]));
    if (fits && !is_among(d, root, n, place[k])) root[n++] = (pl_root){place[k], pl_poison()};
  }
  for (int i = 0; i < n; i++) {
    pl_rest next = *r;
    next.q[j] = root[i].value;
    bool moves = pl_has_symbol(d->pool, root[i].value, pl_time(d->pool));
    if (!moves && add_condition(d, &next, root[i].condition)) search(d, f, next, out);
  }
  if (complete) return;
  pl_rest next = *r;
  if (r->open || row < 0 || pl_has_symbol(d->pool, e, pl_time(d->pool))) {
    out->complete = false;
    out->more_turns |= turns;
    return;
  }
  next.q[j] = pl_sym(d->pool, name_of(d, j));
  next.open = j + 1;
  next.open_row = row;
  next.turns = turns;
  search(d, f, next, out);
}

// An equation in several coordinates that falls into factors: each factor in a single one is a
// branch.
static bool branch_factors(pl_analysis* d, const pl_expr* f, const pl_rest* r, pl_expr e,
                           pl_rests* out) {
  pl_factor factor[12];
  pl_expr unit;
  int n = pl_alg_factors(d->tower, e, factor, 12, &unit), single = 0;
  for (int k = 0; k < n; k++) {
    if (factor[k].power > 0 && only_unknown(d, factor[k].base, r) >= 0) single++;
  }
  if (n < 2 || single == 0) return false;
  for (int k = 0; k < n; k++) {
    if (factor[k].power < 0) continue;
    int j = only_unknown(d, factor[k].base, r);
    if (j >= 0) branch(d, f, r, factor[k].base, j, -1, out);
    if (j == -2) out->complete = false;
  }
  return true;
}

// No equation stands alone: the known places of each coordinate are tried, and what follows from
// them.
static void try_places(pl_analysis* d, const pl_expr* f, const pl_rest* r, pl_rests* out) {
  out->complete = false;
  for (int k = 0; k < d->gen.n; k++) {
    pl_expr place[4];
    int n = pl_is_poison(r->q[k]) ? known_places(d, k, place) : 0;
    for (int i = 0; i < n && out->tries < max_tries; i++) {
      out->tries++;
      pl_rest next = *r;
      next.q[k] = place[i];
      search(d, f, next, out);
    }
  }
}

// Where the mass matrix is singular the coordinates fail (r = 0 of polar ones): no position of
// rest.
static bool regular(pl_analysis* d, const pl_rest* r) {
  pl_expr M[pl_max_gen * pl_max_gen];
  int n = d->gen.n;
  for (int i = 0; i < n; i++) {
    pl_expr momentum = pl_diff(d->pool, d->Lg, d->q.at[d->gen.at[i]].v);
    for (int j = 0; j < n; j++)
      M[i * n + j] = pl_insert_rest(
          d, pl_at_rest(d, pl_diff(d->pool, momentum, d->q.at[d->gen.at[j]].v)), r);
  }
  pl_replace at[pl_max_gen];
  int n_at = 0;
  for (int k = 0; k < n; k++) {
    if (!pl_is_poison(r->q[k])) at[n_at++] = (pl_replace){d->q.at[d->gen.at[k]].q, r->q[k]};
  }
  return !pl_map_fails_at(d, at, n_at) && !pl_vanishes(d, pl_alg_det(d->tower, n, M, 20000));
}

// ------------------------------------------------------------------------- where the formulas hold
static bool negative_there(pl_analysis* d, pl_expr e, const pl_rest* r) {
  static const double rounding = 1e-9;
  e = pl_alg_normal(d->tower, pl_insert_rest(d, e, r));
  int sign = 0;
  return (pl_alg_sign_proven(d->tower, e, false, &sign) == PL_YES && sign < 0)
         || pl_number(d, e) < -rounding;
}

static bool is_direction(const pl_analysis* d, const pl_fact* side) {
  for (int k = 0; k < d->directions.n; k++) {
    if (pl_same(d->directions.at[k].difference, side->difference)) return true;
  }
  return false;
}

// On the side that the formulas were derived for.  out->side: the sides that were taken.
static bool on_the_side(pl_analysis* d, const pl_rest* r, pl_rests* out) {
  const pl_fact* side;
  int n = pl_taken_sides(d, &side);
  bool inside = true;
  out->n_sides = 0;
  for (int k = 0; k < n; k++) {
    if (!pl_side_is_of_place(d, &side[k]) || is_direction(d, &side[k])) continue;
    inside &= !negative_there(d, pl_on_maps(d, side[k].difference), r);
    out->side[out->n_sides++] = side[k];
  }
  return inside;
}

// The roots of the maps, √(l² - r² sin²φ), are real.
static bool maps_are_real(pl_analysis* d, pl_expr e, pl_rest* r, pl_rests* out) {
  if (pl_n_args(d->pool, e) == 0) return true;
  if (pl_is_sqrt(d->pool, e) && pl_has_coordinates(d, e)) {
    pl_expr inside = pl_arg(d->pool, e, 0);
    int sign = 0;
    out->map_ends |= pl_alg_sign_proven(d->tower, inside, false, &sign) != PL_YES;
    if (negative_there(d, inside, r)
        || !add_condition(d, r, pl_alg_normal(d->tower, pl_insert_rest(d, inside, r))))
      return false;
  }
  for (int k = 0; k < pl_n_args(d->pool, e); k++) {
    if (!maps_are_real(d, pl_arg(d->pool, e, k), r, out)) return false;
  }
  return true;
}

static bool formulas_hold(pl_analysis* d, pl_rest* r, pl_rests* out) {
  bool fine = on_the_side(d, r, out);
  for (int i = 0; i < d->q.n; i++) {
    if (!pl_is_poison(d->q.at[i].map) && !maps_are_real(d, d->q.at[i].map, r, out)) fine = false;
  }
  return fine;
}

// Proposed angles may name one place twice, (α, ψ) and (-α, ψ + π).
static bool same_in_the_model(pl_analysis* d, const pl_rest* a, const pl_rest* b) {
  for (int i = 0; i < d->q.n; i++) {
    const pl_variable* c = &d->q.at[i];
    if (c->follows || !c->carries || c->fixed_by >= 0) continue;
    pl_expr place = pl_is_poison(c->map) ? pl_sym(d->pool, c->q) : c->map;
    if (pl_alg_equal(d->tower, pl_insert_rest(d, place, a), pl_insert_rest(d, place, b)) != PL_YES)
      return false;
  }
  return true;
}

static bool same_place(pl_analysis* d, const pl_rest* a, const pl_rest* b) {
  if (d->is_proposal && same_in_the_model(d, a, b)) return true;
  for (int k = 0; k < d->gen.n; k++) {
    if (pl_is_poison(a->q[k]) != pl_is_poison(b->q[k])) return false;
    if (!pl_is_poison(a->q[k]) && pl_alg_equal(d->tower, a->q[k], b->q[k]) != PL_YES) return false;
  }
  return true;
}

static void keep(pl_analysis* d, pl_rest* r, pl_rests* out) {
  if (!formulas_hold(d, r, out)) return;
  if (r->open) {
    if (out->n_open < 4) out->open[out->n_open++] = *r;
    else out->complete = false;
    return;
  }
  for (int k = 0; k < out->n; k++) {
    if (same_place(d, &out->at[k], r)) return;
  }
  if (!regular(d, r)) {
    out->n_singular++;
    out->singular = *r;
  } else if (out->n < pl_max_found) {
    out->at[out->n++] = *r;
  } else {
    out->complete = false;
  }
}

// Solves equation after equation, each for the one coordinate that is left in it; branches
// multiply.
static void search(pl_analysis* d, const pl_expr* f, pl_rest r, pl_rests* out) {
  bool done = true;
  pl_expr several = pl_poison();
  for (int k = 0; k < d->gen.n; k++) {
    if (r.open && k == r.open_row) continue;
    pl_expr e = pl_alg_normal(d->tower, pl_insert_rest(d, f[k], &r));
    pl_answer3 zero = pl_alg_is_zero(d->tower, e);
    if (zero == PL_YES) continue;
    int j = only_unknown(d, e, &r);
    if (j == -1) {  // contradiction on this branch, unless the given numbers make it hold
      pl_find_special(d, e);
      if (zero != PL_NO || r.open) out->complete = false;
      return;
    }
    done = false;
    if (j < 0) {
      several = e;
      continue;
    }
    branch(d, f, &r, e, j, k, out);
    return;
  }
  pl_rest linear = r;
  if (!done && solve_linear(d, f, &linear)) {
    if (!at_rest_everywhere(d, f, &linear)) return;  // contradiction on this branch
    r = linear;
  } else if (!done) {
    if (pl_is_poison(several) || !branch_factors(d, f, &r, several, out)) try_places(d, f, &r, out);
    return;
  }
  keep(d, &r, out);
}

// -------------------------------------------------------------------------------------- in numbers
static long gcd_of(long a, long b) { return b == 0 ? labs(a) : gcd_of(b, a % b); }

// e depends on x through sines and cosines of rational multiples only: *num/den becomes the largest
// common measure of these.
static bool is_periodic(pl_analysis* d, pl_expr e, pl_symbol x, long* num, long* den) {
  pl_pool* p = d->pool;
  if (!pl_has_symbol(p, e, x)) return true;
  pl_kind kind = pl_kind_of(p, e);
  if (kind == PL_SYMBOL || kind == PL_IF || kind == PL_SUM) return false;
  if (kind == PL_CALL && (pl_function_of(p, e) == PL_SIN || pl_function_of(p, e) == PL_COS)) {
    long a = 0, b = 1;
    if (!pl_is_ratio(p, pl_diff(p, pl_arg(p, e, 0), x), &a, &b) || labs(a) > 10000 || b > 10000)
      return false;
    *num = gcd_of(*num * b, a * *den);
    *den = *den * b;
    long common = gcd_of(*num, *den);
    *num /= common;
    *den /= common;
    return *den < 100000;
  }
  for (int k = 0; k < pl_n_args(p, e); k++) {
    if (!is_periodic(d, pl_arg(p, e, k), x, num, den)) return false;
  }
  return true;
}

typedef struct pl_number_search {
  pl_zero zero[pl_max_found];
  int n;
  bool complete;
  double range;
} pl_number_search;

// All zeros of one period, where the system repeats with it, or with |x| up to a range as large as
// the boxes allow.
static void search_numbers(pl_analysis* d, pl_expr e, pl_symbol x, bool turns,
                           pl_number_search* out) {
  static const double range[] = {1e9, 1e6, 1e4, 1e3, 100, 10};
  // the ends are no place where somebody would look for a zero
  static const double shift = 0.0613;
  long num = 0, den = 1;
  if (!turns && is_periodic(d, e, x, &num, &den) && num > 0) {
    double period = 2 * M_PI * (double)den / (double)num;
    double from = -period / 2 + shift * period;
    out->n = pl_alg_zeros(d->tower, e, x, from, from + period, out->zero, pl_max_found,
                          &out->complete);
    out->range = 0;
    for (int k = 0; k < out->n; k++) {
      if (out->zero[k].value > period / 2) out->zero[k].value -= period;
    }
    return;
  }
  for (int k = 0; k < (int)(sizeof range / sizeof *range); k++) {
    out->range = range[k];
    out->n = pl_alg_zeros(d->tower, e, x, -range[k] * (1 + shift), range[k] * (1 + 2 * shift),
                          out->zero, pl_max_found, &out->complete);
    if (out->complete) return;
  }
}

// Whether a zero in numbers is one of the closed positions.
static bool is_closed(pl_analysis* d, const pl_rests* out, int place, double x, bool periodic) {
  for (int k = 0; k < out->n; k++) {
    double known = pl_number(d, out->at[k].q[place]);
    double off = fabs(known - x), near = 1e-9 * fmax(1, fabs(x));
    bool turned = periodic && fabs(off - 2 * M_PI * round(off / (2 * M_PI))) < near;
    if (!out->at[k].numeric && (off < near || turned)) return true;
  }
  return false;
}

static pl_expr number_of(pl_analysis* d, double x) {
  const char* text = pl_format(d->arena, "%.17g", fabs(x));
  pl_expr e = pl_number_from_text(d->pool, text, strlen(text));
  return x < 0 ? pl_neg(d->pool, e) : e;
}

// The positions of a branch that was left open: zeros of its equation in numbers.
static void open_branch(pl_analysis* d, const pl_expr* f, const pl_rest* r, pl_rests* out) {
  int place = r->open - 1;
  pl_symbol x = name_of(d, place);
  pl_expr top, bottom, e = pl_with_given_numbers(d, pl_insert_rest(d, f[r->open_row], r));
  pl_alg_fraction(d->tower, e, &top, &bottom);
  pl_number_search found = {.n = 0};
  search_numbers(d, top, x, r->turns, &found);
  out->complete &= found.complete;
  out->by_numbers |= found.complete;
  if (found.complete) {
    out->searched = found.range;
    out->searched_place = place;
  }
  for (int k = 0; k < found.n; k++) {
    if (is_closed(d, out, place, found.zero[k].value, found.range == 0)) continue;
    if (!found.zero[k].proven) {
      out->complete = false;
      continue;
    }
    pl_rest next = *r;
    next.open = 0;
    next.numeric = true;
    pl_expr value = number_of(d, found.zero[k].value);
    for (int j = 0; j < d->gen.n; j++) {
      next.exact[j] = !pl_has_symbol(d->pool, next.q[j], x);
      next.q[j] = pl_subst1(d->pool, next.q[j], x, value);
    }
    for (int c = 0; c < next.n_conditions; c++)
      next.condition[c] = pl_subst1(d->pool, next.condition[c], x, value);
    if (!formulas_hold(d, &next, out) || !pl_rest_exists_at_numbers(d, &next)) continue;
    if (out->n < pl_max_found) out->at[out->n++] = next;
    else out->complete = false;
  }
}

// ------------------------------------------------------------------------------------- the service
// A quantity that is given through others, ω = √(2 g k), is a special case: positions of rest are
// sought with it inserted.
static pl_expr with_relations(pl_analysis* d, pl_expr e) {
  for (int k = 0; k < d->model->params.n; k++) {
    const pl_param* given = &d->model->params.at[k];
    if (pl_is_poison(given->value) || pl_is_constant(d->pool, given->value)) continue;
    e = pl_subst1(d->pool, e, given->symbol, given->value);
  }
  return pl_alg_normal(d->tower, e);
}

void pl_at_rest_equations(pl_analysis* d, pl_expr* f) {
  for (int k = 0; k < d->gen.n; k++)
    f[k] = with_relations(d, pl_at_rest(d, pl_second_kind(d, d->gen.at[k])));
}

// Positions that divide by zero for the given numbers: these are a special case.
static void find_poles(pl_analysis* d, const pl_rests* found) {
  pl_expr base;
  for (int k = 0; k < found->n; k++) {
    for (int j = 0; j < d->gen.n; j++) {
      if (pl_pole_at_numbers(d, found->at[k].q[j], &base)) pl_find_special(d, base);
    }
  }
}

// A solver gives one period of an angle; |φ| does not repeat, and which period is on the side hangs
// on it.
static bool side_turns(pl_analysis* d, const pl_expr* f, int place, const pl_rests* found) {
  bool wave = false;
  for (int k = 0; k < d->gen.n; k++) wave |= has_wave(d->pool, f[k], name_of(d, place));
  for (int k = 0; wave && k < found->n_sides; k++) {
    if (!repeats(d, pl_on_maps(d, found->side[k].difference), name_of(d, place))) return true;
  }
  return false;
}

pl_rests* pl_find_rests(pl_analysis* d, pl_expr* f) {
  pl_rests* found;
  int before, first = d->special.n;
  do {
    before = d->special.n;
    found = PL_NEW(d->arena, pl_rests);
    found->complete = true;
    for (int k = 0; k < d->gen.n; k++) f[k] = pl_on_special(d, f[k]);
    search(d, f, (pl_rest){0}, found);
    find_poles(d, found);
  } while (d->special.n > before);
  found->special_case = d->special.n > first;
  for (int k = 0; k < found->n_open; k++) open_branch(d, f, &found->open[k], found);
  formulas_hold(d, &(pl_rest){0}, found);  // sides and ends, when nothing was found
  for (int k = 0; k < d->gen.n; k++) found->more_turns |= side_turns(d, f, k, found);
  found->complete &= !found->map_ends && !found->more_turns;
  found->complete_here = found->complete;
  found->complete &= found->n_sides == 0;
  return found;
}

// --------------------------------------------------------------------------------- without a drive
static bool has_time(pl_analysis* d, const pl_expr* e, int n) {
  for (int k = 0; k < n; k++) {
    if (pl_has_symbol(d->pool, e[k], pl_time(d->pool))) return true;
  }
  return false;
}

// Forces that depend on time alone: f = f0(q) + h(t).  The terms of h.
static bool split_drive(pl_analysis* d, pl_expr* f, pl_expr* drive) {
  pl_pool* p = d->pool;
  pl_replace zero[pl_max_gen];
  for (int k = 0; k < d->gen.n; k++) zero[k] = (pl_replace){name_of(d, k), pl_int(p, 0)};
  for (int k = 0; k < d->gen.n; k++) {
    pl_expr change = pl_alg_normal(d->tower, pl_diff(p, f[k], pl_time(p)));
    drive[k] = pl_int(p, 0);
    if (pl_is_zero_node(p, change)) continue;
    if (pl_has_coordinates(d, change)) return false;
    pl_expr e = pl_expand(p, pl_alg_normal(d->tower, pl_subst(p, f[k], zero, d->gen.n)), 64);
    int n = pl_kind_of(p, e) == PL_ADD ? pl_n_args(p, e) : 1;
    for (int i = 0; i < n; i++) {
      pl_expr term = pl_kind_of(p, e) == PL_ADD ? pl_arg(p, e, i) : e;
      if (pl_has_symbol(p, term, pl_time(p))) drive[k] = pl_add(p, drive[k], term);
    }
  }
  for (int k = 0; k < d->gen.n; k++) f[k] = pl_alg_normal(d->tower, pl_sub(p, f[k], drive[k]));
  return !has_time(d, f, d->gen.n);
}

// The name stands beside t in a function: cos(Ω t + α). Zero for it stops the clock and not the
// drive.
static bool in_phase(pl_pool* p, pl_expr e, pl_symbol name) {
  bool with_time = pl_kind_of(p, e) == PL_CALL && pl_has_symbol(p, e, pl_time(p));
  if (with_time && pl_has_symbol(p, e, name)) return true;
  for (int k = 0; k < pl_n_args(p, e); k++) {
    if (in_phase(p, pl_arg(p, e, k), name)) return true;
  }
  return false;
}

// An amplitude: a given quantity without which nothing contains t, and the masses stay.
static bool is_amplitude(pl_analysis* d, const pl_expr* f, pl_symbol name) {
  pl_expr without[pl_max_gen];
  bool all_zero = true;
  for (int k = 0; k < d->gen.n; k++) {
    if (in_phase(d->pool, f[k], name)) return false;
    without[k] = pl_alg_normal(d->tower, pl_subst1(d->pool, f[k], name, pl_int(d->pool, 0)));
    if (pl_is_poison(without[k])) return false;
    all_zero &= pl_is_zero_node(d->pool, without[k]);
  }
  if (all_zero || has_time(d, without, d->gen.n)) return false;
  pl_push(d->arena, d->steady, (pl_replace){name, pl_int(d->pool, 0)});
  bool stays = regular(d, &(pl_rest){0});
  d->steady.n--;
  return stays;
}

bool pl_without_drive(pl_analysis* d, pl_expr* f, pl_drive* out) {
  pl_expr drive[pl_max_gen];
  *out = (pl_drive){.n = 0};
  if (!has_time(d, f, d->gen.n)) return true;
  if (split_drive(d, f, drive)) {
    for (int k = 0; k < d->gen.n; k++) {
      if (!pl_is_zero_node(d->pool, drive[k])) out->force[out->n++] = pl_neg(d->pool, drive[k]);
    }
    return true;
  }
  for (int i = 0; i < d->model->params.n; i++) {
    pl_symbol name = d->model->params.at[i].symbol;
    if (!is_amplitude(d, f, name)) continue;
    pl_push(d->arena, d->steady, (pl_replace){name, pl_int(d->pool, 0)});
    for (int k = 0; k < d->gen.n; k++)
      f[k] = pl_alg_normal(d->tower, pl_subst1(d->pool, f[k], name, pl_int(d->pool, 0)));
    out->amplitude = name;
    return true;
  }
  return false;
}

// ------------------------------------------------------------------------ positions that are named
bool pl_names_a_place(pl_analysis* d, const pl_ask* ask) {
  for (int c = 0; c < ask->where.n; c++) {
    for (int k = 0; k < d->gen.n; k++) {
      if (pl_same(ask->where.at[c].left, pl_sym(d->pool, name_of(d, k)))) return true;
    }
  }
  return false;
}

pl_answer3 pl_named_rest(pl_analysis* d, const pl_ask* ask, const pl_expr* f, pl_rest* out) {
  *out = (pl_rest){0};
  for (int k = 0; k < d->gen.n; k++) {
    for (int c = 0; c < ask->where.n; c++) {
      if (pl_same(ask->where.at[c].left, pl_sym(d->pool, name_of(d, k))))
        out->q[k] = ask->where.at[c].right;
    }
  }
  pl_answer3 answer = PL_YES;
  for (int k = 0; k < d->gen.n; k++) {
    pl_expr left = pl_alg_normal(d->tower, pl_insert_rest(d, f[k], out));
    if (only_unknown(d, left, out) != -1) return PL_UNKNOWN;
    pl_answer3 zero = pl_alg_is_zero(d->tower, left);
    // for these numbers
    if (zero == PL_NO && pl_vanishes(d, pl_with_given_numbers(d, left))) zero = PL_YES;
    if (zero == PL_NO) return PL_NO;
    if (zero == PL_UNKNOWN) answer = PL_UNKNOWN;
  }
  return answer;
}

bool pl_rest_is_named(pl_analysis* d, const pl_ask* ask, const pl_rest* r) {
  for (int k = 0; k < d->gen.n; k++) {
    for (int c = 0; c < ask->where.n; c++) {
      if (!pl_same(ask->where.at[c].left, pl_sym(d->pool, name_of(d, k)))) continue;
      if (pl_is_poison(r->q[k])
          || pl_alg_equal(d->tower, r->q[k], ask->where.at[c].right) != PL_YES)
        return false;
    }
  }
  return true;
}

// ------------------------------------------------------------------------------ what a position is
bool pl_rest_exists_at_numbers(pl_analysis* d, const pl_rest* r) {
  // a condition met with equality, 1 - cos²(0) >= 0, may be missed by that
  static const double rounding = 1e-12;
  for (int k = 0; k < r->n_conditions; k++) {
    if (pl_number(d, r->condition[k]) < -rounding) return false;
  }
  return true;
}

// A one-sided constraint that would have to pull: the position is none of rest.
const pl_bond* pl_rest_pulls(pl_analysis* d, const pl_rest* r) {
  for (int k = 0; k < d->g.n; k++) {
    const pl_bond* l = &d->g.at[k];
    if (!l->contact || !l->lambda_known || l->implied) continue;
    pl_expr lambda = pl_insert_rest(d, pl_at_rest(d, l->lambda_value), r);
    bool push_is_positive = (l->source->relation == PL_GE) != d->model->lambda_minus;
    // at a place in numbers the sign is one of numbers, and assumes nothing
    double push = r->numeric ? pl_number(d, lambda) : (double)NAN;
    int sign = isnan(push) ? pl_sign_at_numbers(d, pl_alg_normal(d->tower, lambda))
                           : (push > 0) - (push < 0);
    if (sign != 0 && (sign > 0) != push_is_positive) return l;
  }
  return NULL;
}

bool pl_is_angle(pl_analysis* d, int i) {
  const pl_symbol_info* s = pl_symbol_get(d->pool, d->q.at[i].q);
  bool plain = !s->dimension_known || pl_dimension_equal(s->dimension, pl_dimension_one());
  if (!plain || !places_repeat(d, d->q.at[i].q)) return false;
  pl_expr c = pl_call(d->pool, PL_COS, pl_sym(d->pool, d->q.at[i].q)),
          s2 = pl_call(d->pool, PL_SIN, pl_sym(d->pool, d->q.at[i].q));
  pl_expr mark = pl_int(d->pool, 7);
  pl_expr probe = pl_add(d->pool, d->Tg, d->Vg);
  for (int k = 0; k < d->g.n; k++) probe = pl_add(d->pool, probe, d->g.at[k].g);
  return !pl_same(pl_subst_expr(d->pool, probe, c, mark), probe)
         || !pl_same(pl_subst_expr(d->pool, probe, s2, mark), probe);
}
