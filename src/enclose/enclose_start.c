// The exact start: given values as written, the rest from the constraints.
//
// Positions: Newton's method from the simulation's start, then Krawczyk's test [Krawczyk1969]: with
// m the approximation, X a box around it and C near G^-1, K = m - C g(m) + (I - C G(X)) (X - m)
// inside of X proves that g has exactly one zero in X and that it lies in K. Velocities: one linear
// system in balls, the least kinetic energy where they are free.
//
// More may be given than the constraints leave free. Then some of the given values are solved for
// as well. If the one solution in X and the given value are both in X, and the model as written is
// free of contradiction, they are equal; a given value outside of X, or of K, contradicts the
// constraints, and is reported as moved. What neither is given nor determined is taken from the
// simulation's start, as an exact number, and reported too.
// See theory (18.5).
#include "enclose/enclose_impl.h"

#include <math.h>

static const double dependent = 1e-9;  // of a row: what counts as nothing
static const double near = 1e-6;       // of the start of the simulation

typedef struct starter {
  pl_system* s;
  pl_certified* out;
  arb_srcptr t;
  bool* unknown;         // solved for                          (n_q)
  bool* given;           //                                     (n_q)
  arb_ptr value;         // of what is given                    (n_q)
  int n_unknown, *list;  //                                     (n_q)
  int n_rows, *row;      // constraints used                    (n_c)
  int* place;            // of a constraint in row, -1          (n_c)
  PL_VEC(int) pinned, moved;
} starter;

// ------------------------------------------------------------------------------------------- which
// Columns that the rows (A, n_rows x n) determine, those preferred first. Elimination with full
// pivoting.
static int pick(double* A, int n_rows, int n, const bool* preferred, bool* picked) {
  int done = 0;
  for (int pass = 0; pass < 2; pass++) {
    while (done < n_rows) {
      int at_row = -1, at_col = -1;
      double most = dependent;
      for (int r = done; r < n_rows; r++)
        for (int c = 0; c < n; c++)
          if (preferred[c] == (pass == 0) && !picked[c] && fabs(A[r * n + c]) > most) {
            most = fabs(A[r * n + c]);
            at_row = r;
            at_col = c;
          }
      if (at_row < 0) break;
      for (int c = 0; c < n; c++) {
        double x = A[done * n + c];
        A[done * n + c] = A[at_row * n + c];
        A[at_row * n + c] = x;
      }
      for (int r = done + 1; r < n_rows; r++) {
        double f = A[r * n + at_col] / A[done * n + at_col];
        for (int c = 0; c < n; c++) A[r * n + c] -= f * A[done * n + c];
      }
      picked[at_col] = true;
      done++;
    }
  }
  return done;
}

// Rows in use, gradients of length 1.
static double* gradients(starter* z) {
  pl_system* s = z->s;
  double* A = PL_ARRAY(s->arena, double, (size_t)z->n_rows*(size_t)s->n_q + 1);
  for (int i = 0; i < s->n_jets; i++) {
    const pl_ball_jet* j = &s->jet[i];
    for (int e = 0; e < j->pattern->n_G; e++) {
      const pl_pattern_entry* g = &j->pattern->G[e];
      int r = z->place[j->c[g->row]];
      if (r >= 0) A[r * s->n_q + j->q[g->col]] += pl_ball_double(pl_root_series(j, g->root));
    }
  }
  for (int r = 0; r < z->n_rows; r++) {
    double most = 0;
    for (int c = 0; c < s->n_q; c++) most = fmax(most, fabs(A[r * s->n_q + c]));
    for (int c = 0; c < s->n_q && most > 0; c++) A[r * s->n_q + c] /= most;
  }
  return A;
}

static void take_rows(starter* z, bool positions) {
  pl_system* s = z->s;
  pl_system_choose_rows(s);
  z->n_rows = 0;
  for (int c = 0; c < s->n_c; c++) {
    bool used = s->row_of[c] >= 0 && !(positions && s->setup->constraints[c].velocity);
    z->place[c] = used ? z->n_rows : -1;
    if (used) z->row[z->n_rows++] = c;
  }
}

// Unknown: the columns that the rows determine; velocities: everything that is not given, too.
static bool choose_unknowns(starter* z, bool positions) {
  pl_system* s = z->s;
  bool* preferred = PL_ARRAY(s->arena, bool, s->n_q + 1);
  for (int i = 0; i < s->n_q; i++) {
    preferred[i] = !z->given[i];
    z->unknown[i] = false;
  }
  take_rows(z, positions);
  if (pick(gradients(z), z->n_rows, s->n_q, preferred, z->unknown) < z->n_rows) return false;
  z->n_unknown = 0;
  for (int i = 0; i < s->n_q; i++) {
    if (!positions && !z->given[i]) z->unknown[i] = true;
    if (positions && !z->given[i] && !z->unknown[i]) pl_push(s->arena, z->pinned, i);
    if (z->unknown[i]) z->list[z->n_unknown++] = i;
  }
  return true;
}

// --------------------------------------------------------------------------------------- positions
static arb_ptr q_of(starter* z, int i) { return z->s->q + (slong)i * z->s->cap; }
static arb_ptr v_of(starter* z, int i) { return z->s->v + (slong)i * z->s->cap; }

// g of the rows (n_rows x 1) and its derivatives by the unknowns (n_rows x n_unknown).
static void constraints(starter* z, arb_mat_t g, arb_mat_t G) {
  pl_system* s = z->s;
  pl_system_values(s, z->t, PL_FOR_START);
  arb_mat_zero(g);
  arb_mat_zero(G);
  for (int i = 0; i < s->n_jets; i++) {
    const pl_ball_jet* j = &s->jet[i];
    for (int e = 0; e < j->pattern->n_g; e++) {
      int r = z->place[j->c[j->pattern->g[e].row]];
      if (r >= 0)
        arb_add(arb_mat_entry(g, r, 0), arb_mat_entry(g, r, 0),
                pl_root_series(j, j->pattern->g[e].root), s->prec);
    }
    for (int e = 0; e < j->pattern->n_G; e++) {
      const pl_pattern_entry* d = &j->pattern->G[e];
      int r = z->place[j->c[d->row]];
      for (int k = 0; k < z->n_unknown && r >= 0; k++)
        if (z->list[k] == j->q[d->col])
          arb_add(arb_mat_entry(G, r, k), arb_mat_entry(G, r, k), pl_root_series(j, d->root),
                  s->prec);
    }
  }
}

static void to_middle(arb_ptr x) { mag_zero(arb_radref(x)); }

// Newton's method: the middle of the unknowns moves to the zero.
static bool newton(starter* z, arb_mat_t g, arb_mat_t G, arb_mat_t step) {
  int rounds = 4 + (int)ceil(log2((double)z->s->prec / 16));
  for (int round = 0; round < rounds; round++) {
    constraints(z, g, G);
    if (!arb_mat_solve(step, G, g, z->s->prec)) return false;
    for (int k = 0; k < z->n_unknown; k++) {
      arb_ptr x = q_of(z, z->list[k]);
      arb_sub(x, x, arb_mat_entry(step, k, 0), z->s->prec);
      to_middle(x);
    }
  }
  return true;
}

// Half width of X: half the digits.
static void box_radius(mag_t out, arb_srcptr m, slong prec) {
  arb_get_mag(out, m);
  mag_add_ui_2exp_si(out, out, 1, -30);
  mag_mul_2exp_si(out, out, -prec / 2);
}

// K = m - C g(m) + (I - C G(X)) (X - m); the unknowns become K when it lies inside of X.  box: X.
static bool krawczyk(starter* z, arb_mat_t g, arb_mat_t G, arb_mat_t C, arb_ptr box) {
  pl_system* s = z->s;
  int n = z->n_unknown;
  constraints(z, g, G);
  if (!arb_mat_inv(C, G, s->prec)) return false;
  for (int i = 0; i < n; i++)
    for (int k = 0; k < n; k++) to_middle(arb_mat_entry(C, i, k));
  arb_mat_t step, spread, width;
  arb_mat_init(step, n, 1);
  arb_mat_init(spread, n, n);
  arb_mat_init(width, n, 1);
  arb_mat_mul(step, C, g, s->prec);
  for (int k = 0; k < n; k++) {
    mag_t r;
    mag_init(r);
    arb_ptr x = q_of(z, z->list[k]);
    box_radius(r, x, s->prec);
    arb_sub(arb_mat_entry(step, k, 0), x, arb_mat_entry(step, k, 0), s->prec);
    arb_add_error_mag(x, r);
    arb_add_error_mag(arb_mat_entry(width, k, 0), r);
    arb_set(box + k, x);
    mag_clear(r);
  }
  constraints(z, g, G);
  arb_mat_mul(spread, C, G, s->prec);
  for (int k = 0; k < n; k++)
    arb_sub_si(arb_mat_entry(spread, k, k), arb_mat_entry(spread, k, k), 1, s->prec);
  arb_mat_neg(spread, spread);
  arb_mat_mul(width, spread, width, s->prec);
  bool inside = true;
  for (int k = 0; k < n; k++) {
    arb_ptr x = q_of(z, z->list[k]);
    arb_add(x, arb_mat_entry(step, k, 0), arb_mat_entry(width, k, 0), s->prec);
    inside = inside && arb_is_finite(x) && arb_contains_interior(box + k, x);
  }
  arb_mat_clear(step);
  arb_mat_clear(spread);
  arb_mat_clear(width);
  return inside;
}

static bool solve_positions(starter* z, arb_ptr box) {
  if (z->n_unknown == 0) return true;
  arb_mat_t g, G, C, step;
  arb_mat_init(g, z->n_rows, 1);
  arb_mat_init(G, z->n_rows, z->n_unknown);
  arb_mat_init(C, z->n_unknown, z->n_unknown);
  arb_mat_init(step, z->n_unknown, 1);
  bool ok = newton(z, g, G, step) && krawczyk(z, g, G, C, box);
  arb_mat_clear(g);
  arb_mat_clear(G);
  arb_mat_clear(C);
  arb_mat_clear(step);
  return ok;
}

// -------------------------------------------------------------------------------------- velocities
// [M G^T; G 0] of the unknowns and the right side [M v_guess - M v; -dg/dt - G v] of what is given.
static void energy_rows(starter* z, const pl_ball_jet* j, const int* at, bool plain, arb_mat_t A,
                        arb_mat_t b) {
  pl_system* s = z->s;
  const pl_pattern* p = j->pattern;
  arb_t guess;
  arb_init(guess);
  for (int e = 0; e < p->n_mass && !plain; e++) {
    arb_srcptr m = pl_root_series(j, p->mass[e].root);
    for (int twice = 0; twice < (p->mass[e].row == p->mass[e].col ? 1 : 2); twice++) {
      int r = j->q[twice ? p->mass[e].col : p->mass[e].row],
          c = j->q[twice ? p->mass[e].row : p->mass[e].col];
      if (at[r] < 0) continue;
      const pl_coordinate* q = &s->setup->coordinates[c];
      arb_set_d(guess, q->has_v_guess ? q->v_guess : 0);
      arb_addmul(arb_mat_entry(b, at[r], 0), m, guess, s->prec);
      if (at[c] >= 0)
        arb_add(arb_mat_entry(A, at[r], at[c]), arb_mat_entry(A, at[r], at[c]), m, s->prec);
      else arb_submul(arb_mat_entry(b, at[r], 0), m, v_of(z, c), s->prec);
    }
  }
  arb_clear(guess);
}

static void constraint_rows(starter* z, const pl_ball_jet* j, const int* at, arb_mat_t A,
                            arb_mat_t b) {
  pl_system* s = z->s;
  const pl_pattern* p = j->pattern;
  for (int e = 0; e < p->n_G; e++) {
    int c = j->q[p->G[e].col], r = z->place[j->c[p->G[e].row]];
    if (r < 0) continue;
    r += z->n_unknown;
    arb_srcptr x = pl_root_series(j, p->G[e].root);
    if (at[c] < 0) {
      arb_submul(arb_mat_entry(b, r, 0), x, v_of(z, c), s->prec);
      continue;
    }
    arb_add(arb_mat_entry(A, r, at[c]), arb_mat_entry(A, r, at[c]), x, s->prec);
    arb_add(arb_mat_entry(A, at[c], r), arb_mat_entry(A, at[c], r), x, s->prec);
  }
  for (int e = 0; e < p->n_gt; e++) {
    int r = z->place[j->c[p->gt[e].row]];
    if (r < 0) continue;
    arb_ptr to = arb_mat_entry(b, z->n_unknown + r, 0);
    arb_sub(to, to, pl_root_series(j, p->gt[e].root), s->prec);
  }
}

// plain: the identity takes the place of M.
static void identity_rows(starter* z, arb_mat_t A, arb_mat_t b) {
  for (int k = 0; k < z->n_unknown; k++) {
    const pl_coordinate* q = &z->s->setup->coordinates[z->list[k]];
    arb_one(arb_mat_entry(A, k, k));
    arb_set_d(arb_mat_entry(b, k, 0), q->has_v_guess ? q->v_guess : 0);
  }
}

static bool solve_velocities_with(starter* z, bool plain) {
  pl_system* s = z->s;
  int n = z->n_unknown + z->n_rows;
  int* at = PL_ARRAY(s->arena, int, s->n_q + 1);
  for (int i = 0; i < s->n_q; i++) at[i] = -1;
  for (int k = 0; k < z->n_unknown; k++) at[z->list[k]] = k;
  arb_mat_t A, b, x;
  arb_mat_init(A, n, n);
  arb_mat_init(b, n, 1);
  arb_mat_init(x, n, 1);
  if (plain) identity_rows(z, A, b);
  for (int i = 0; i < s->n_jets; i++) {
    energy_rows(z, &s->jet[i], at, plain, A, b);
    constraint_rows(z, &s->jet[i], at, A, b);
  }
  bool ok = arb_mat_solve(x, A, b, s->prec) && arb_mat_is_finite(x);
  for (int k = 0; k < z->n_unknown && ok; k++) arb_set(v_of(z, z->list[k]), arb_mat_entry(x, k, 0));
  arb_mat_clear(A);
  arb_mat_clear(b);
  arb_mat_clear(x);
  return ok;
}

static bool solve_velocities(starter* z) {
  return z->n_unknown == 0 || solve_velocities_with(z, false) || solve_velocities_with(z, true);
}

// -------------------------------------------------------------------------------------- comparison
// An upper bound of |x - y|.
static double apart(arb_srcptr x, arb_srcptr y) {
  arb_t d;
  mag_t m;
  arb_init(d);
  mag_init(m);
  arb_sub(d, x, y, 64);
  arb_get_mag(m, d);
  double upper = mag_get_d(m);
  arb_clear(d);
  mag_clear(m);
  return upper;
}

static double size_of(const double* x, int n) {
  double most = 0;
  for (int i = 0; i < n; i++) most = fmax(most, fabs(x[i]));
  return most > 0 ? most : 1;
}

static bool near_run(starter* z, const double* run, arb_ptr (*of)(starter*, int)) {
  arb_t x;
  arb_init(x);
  bool yes = true;
  double size = size_of(run, z->s->n_q);
  for (int i = 0; i < z->s->n_q; i++) {
    arb_set_d(x, run[i]);
    yes = yes && apart(of(z, i), x) <= near * size;
  }
  arb_clear(x);
  return yes;
}

// Given values that were solved for and do not agree. box: the neighbourhood in which the solution
// is the only one; NULL: everywhere.
static void note_moved(starter* z, const double* run, arb_srcptr box, arb_ptr (*of)(starter*, int),
                       int offset) {
  double size = size_of(run, z->s->n_q);
  for (int k = 0; k < z->n_unknown; k++) {
    int i = z->list[k];
    if (!z->given[i]) continue;
    bool agrees = arb_overlaps(of(z, i), z->value + i)
                  && (!box || arb_contains(box + k, z->value + i));
    if (agrees) continue;
    pl_push(z->s->arena, z->moved, i + offset);
    z->out->moved = fmax(z->out->moved, apart(of(z, i), z->value + i) / size);
  }
}

// --------------------------------------------------------------------------------------------- all
// Given values, and what the simulation begins with for the rest.
static bool take_given(starter* z, const pl_expr* exact, const double* run,
                       arb_ptr (*of)(starter*, int)) {
  for (int i = 0; i < z->s->n_q; i++) {
    z->given[i] = !pl_is_poison(exact[i]);
    if (!z->given[i]) {
      arb_set_d(of(z, i), run[i]);
      continue;
    }
    if (!pl_exact_ball(&z->s->exact, z->value + i, exact[i])) return false;
    arb_set(of(z, i), z->value + i);
  }
  return true;
}

static pl_certify_end positions(starter* z) {
  pl_system* s = z->s;
  if (!take_given(z, s->p->q_start, s->p->q_run, q_of)) return PL_CERTIFY_NO_EXACT;
  for (int i = 0; i < s->n_q; i++) arb_zero(v_of(z, i));
  pl_system_values(s, z->t, PL_FOR_START);
  if (!choose_unknowns(z, true)) return PL_CERTIFY_START;
  // Newton begins where the simulation does
  for (int k = 0; k < z->n_unknown; k++) arb_set_d(q_of(z, z->list[k]), s->p->q_run[z->list[k]]);
  arb_ptr box = _arb_vec_init(z->n_unknown + 1);
  bool ok = solve_positions(z, box);
  if (ok) note_moved(z, s->p->q_run, box, q_of, 0);
  _arb_vec_clear(box, z->n_unknown + 1);
  if (!ok) return PL_CERTIFY_START;
  return near_run(z, s->p->q_run, q_of) ? PL_CERTIFIED : PL_CERTIFY_ELSEWHERE;
}

static pl_certify_end velocities(starter* z) {
  pl_system* s = z->s;
  if (!take_given(z, s->p->v_start, s->p->v_run, v_of)) return PL_CERTIFY_NO_EXACT;
  pl_system_values(s, z->t, PL_FOR_START);
  if (!choose_unknowns(z, false)) return PL_CERTIFY_START;
  if (pl_system_choose_rows(s) != s->n_wanted) return PL_CERTIFY_REDUNDANT;
  if (!solve_velocities(z)) return PL_CERTIFY_START;
  note_moved(z, s->p->v_run, NULL, v_of, s->n_q);
  return near_run(z, s->p->v_run, v_of) ? PL_CERTIFIED : PL_CERTIFY_ELSEWHERE;
}

pl_certify_end pl_enclose_start(pl_system* s, pl_certified* out, arb_srcptr t) {
  starter z = {.s = s, .out = out, .t = t};
  z.unknown = PL_ARRAY(s->arena, bool, s->n_q + 1);
  z.given = PL_ARRAY(s->arena, bool, s->n_q + 1);
  z.list = PL_ARRAY(s->arena, int, s->n_q + 1);
  z.row = PL_ARRAY(s->arena, int, s->n_c + 1);
  z.place = PL_ARRAY(s->arena, int, s->n_c + 1);
  z.value = _arb_vec_init(s->n_q + 1);
  out->moved = 0;
  pl_certify_end end = positions(&z);
  if (end == PL_CERTIFIED) end = velocities(&z);
  _arb_vec_clear(z.value, s->n_q + 1);
  out->n_pinned = z.pinned.n;
  out->pinned = z.pinned.at;
  out->n_moved = z.moved.n;
  out->moved_q = z.moved.at;
  return end;
}
