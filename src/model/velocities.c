// Constraints with velocities: linear or not, integrable or not.
//
// A constraint linear in the velocities is a Pfaffian form ω = Σ a_j dq_j + b dt. It can be
// integrated, after a factor if need be, exactly when ω ∧ dω = 0: for every three variables
//     a_i (∂_j a_k - ∂_k a_j) + a_j (∂_k a_i - ∂_i a_k) + a_k (∂_i a_j - ∂_j a_i) = 0
// [Frobenius1877]
// with time as one of the variables. Zeros are recognised by form, else at random points modulo a
// large prime.
// See theory (1.5).
#include "model_impl.h"

enum {
  MAX_VARIABLES = 24
};  // triples grow with the third power; longer forms are not tested and count as nonholonomic

// -------------------------------------------------------------------------------------------- zero
enum { N_ZERO_TRIALS = 12 };  // points that are tried until one can be evaluated

static bool vanishes(pl_job* job, const pl_model* m, pl_expr e) {
  if (pl_is_poison(e)) return false;
  if (pl_is_number(m->pool, e)) return pl_is_zero_node(m->pool, e);
  for (uint64_t trial = 1; trial <= N_ZERO_TRIALS; trial++) {
    bool ok = true;
    pl_mod_point* at = pl_mod_point_make(job->arena, m->pool, trial * 7919);
    uint64_t x = pl_eval_mod(at, e, &ok);
    if (ok) return x == 0;
  }
  return false;
}

// --------------------------------------------------------------------------------- velocities in g
typedef struct pfaffian {
  pl_expr v[MAX_VARIABLES];  // velocities that occur                       (n)
  // their coordinates, time, then coordinates that stand in coefficients only
  pl_expr q[MAX_VARIABLES];
  pl_expr a[MAX_VARIABLES];  // coefficients; that of time is b, the last ones are 0
  int n, n_variables;
} pfaffian;

static void collect(const pl_model* m, pl_expr e, pl_map* visited, pfaffian* w) {
  if (pl_map_get(visited, e.id)) return;
  pl_map_set(visited, e.id, 1);
  pl_kind kind = pl_kind_of(m->pool, e);
  bool symbol = kind == PL_SYMBOL
                && pl_symbol_get(m->pool, pl_symbol_of(m->pool, e))->role == PL_R_VELOCITY;
  bool element = kind == PL_AT && pl_dots_of(m->pool, e) == 1;
  if (symbol || element) {
    if (w->n < MAX_VARIABLES) {
      w->v[w->n] = e;
      w->q[w->n] = element
                       ? pl_at(m->pool, pl_symbol_of(m->pool, e), 0, pl_arg(m->pool, e, 0))
                       : pl_sym(m->pool, pl_symbol_get(m->pool, pl_symbol_of(m->pool, e))->base);
    }
    w->n++;
    return;
  }
  for (int i = 0; i < pl_n_args(m->pool, e); i++) collect(m, pl_arg(m->pool, e, i), visited, w);
}

static pl_expr derivative(const pl_model* m, pl_expr e, pl_expr by) {
  if (pl_kind_of(m->pool, by) == PL_AT) return pl_diff_at(m->pool, e, by);
  return pl_diff(m->pool, e, pl_symbol_of(m->pool, by));
}

// Fills the coefficients; false when a second derivative by velocities does not vanish.
static bool read_coefficients(pl_job* job, const pl_model* m, pl_expr g, pfaffian* w) {
  pl_pool* p = m->pool;
  pl_expr rest = g;
  for (int j = 0; j < w->n; j++) {
    w->a[j] = derivative(m, g, w->v[j]);
    for (int k = 0; k < w->n; k++) {
      if (!vanishes(job, m, derivative(m, w->a[j], w->v[k]))) return false;
    }
    rest = pl_subst_expr(p, rest, w->v[j], pl_int(p, 0));
    // a coefficient that only looks as if it held velocities: (x' + 1)² - x'²
    for (int k = 0; k < w->n; k++) w->a[j] = pl_subst_expr(p, w->a[j], w->v[k], pl_int(p, 0));
  }
  w->a[w->n] = rest;
  w->q[w->n] = pl_sym(p, pl_time(p));
  w->n_variables = w->n + 1;
  return true;
}

// Coordinates in the coefficients whose velocity does not occur; false: too many.
static bool add_silent_coordinates(const pl_model* m, pfaffian* w) {
  for (int i = 0; i < m->coords.n; i++) {
    pl_symbol q = m->coords.at[i].symbol;
    bool own = false, there = false;
    for (int j = 0; j < w->n; j++) own |= pl_symbol_of(m->pool, w->q[j]).id == q.id;
    for (int j = 0; j <= w->n && !own; j++) there |= pl_has_symbol(m->pool, w->a[j], q);
    if (!there) continue;
    if (w->n_variables == MAX_VARIABLES) return false;
    w->q[w->n_variables] = pl_sym(m->pool, q);
    w->a[w->n_variables++] = pl_int(m->pool, 0);
  }
  return true;
}

static bool frobenius(pl_job* job, const pl_model* m, const pfaffian* w) {
  pl_pool* p = m->pool;
  int n = w->n_variables;
  pl_expr(*curl)[MAX_VARIABLES] = pl_alloc(job->arena,
                                           sizeof(pl_expr[MAX_VARIABLES][MAX_VARIABLES]));
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < n; j++)
      curl[i][j] = pl_sub(p, derivative(m, w->a[j], w->q[i]), derivative(m, w->a[i], w->q[j]));
  }
  for (int i = 0; i < n; i++) {
    for (int j = i + 1; j < n; j++) {
      for (int k = j + 1; k < n; k++) {
        pl_expr sum = pl_add(
            p, pl_mul(p, w->a[i], curl[j][k]),
            pl_add(p, pl_mul(p, w->a[j], curl[k][i]), pl_mul(p, w->a[k], curl[i][j])));
        if (!vanishes(job, m, sum)) return false;
      }
    }
  }
  return true;
}

// With constant coefficients the integral is Σ a_j q_j + b t.
static const char* integral_text(pl_job* job, const pl_model* m, const pfaffian* w) {
  pl_expr sum = pl_int(m->pool, 0);
  for (int j = 0; j <= w->n; j++) {
    if (pl_has_coordinate(m->pool, w->a[j], job->arena)
        || pl_has_symbol(m->pool, w->a[j], pl_time(m->pool)))
      return NULL;
    sum = pl_add(m->pool, sum, pl_mul(m->pool, w->a[j], w->q[j]));
  }
  return pl_expr_words(job->arena, m->pool, sum);
}

pl_velocity_kind pl_velocity_kind_of(pl_job* job, const pl_model* m, pl_expr g,
                                     const char** integral) {
  *integral = NULL;
  int dots = pl_max_dots(m->pool, g, job->arena);
  if (dots != 1) return dots == 0 ? PL_NO_VELOCITY : PL_ACCELERATION;
  pfaffian* w = PL_NEW(job->arena, pfaffian);
  collect(m, g, pl_map_make(job->arena), w);
  if (w->n >= MAX_VARIABLES) return PL_NONHOLONOMIC;
  if (!read_coefficients(job, m, g, w)) return PL_NOT_LINEAR;
  *integral = integral_text(job, m, w);
  if (*integral) return PL_INTEGRABLE;
  return add_silent_coordinates(m, w) && frobenius(job, m, w) ? PL_INTEGRABLE : PL_NONHOLONOMIC;
}
