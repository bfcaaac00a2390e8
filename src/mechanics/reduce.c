// reduce: generalized coordinates. `choose` names them and gives the map; what is left of the
// constraints is solved for the
// remaining coordinates, a branch picked by `branch`, by assumptions or by the start. Without
// `choose` only constraints linear in
// a coordinate with constant coefficient are solved: they have one branch and lose nothing.
#include <math.h>

#include "mechanics/mechanics.h"

enum { max_roots = 8 };

bool pl_open_coordinate(const pl_variable* c) {
  return (c->carries || c->follows) && c->fixed_by < 0 && !c->chosen && pl_is_poison(c->map);
}

static void set_map(pl_analysis* d, int i, pl_expr map, int solved_by) {
  pl_variable* c = &d->q.at[i];
  c->map = map;
  c->solved_by = solved_by;
  pl_expr v = pl_dt(d->pool, map);
  // over the velocity coefficients
  if (d->loops.n > 0) v = pl_subst(d->pool, v, d->maps.at, d->maps.n);
  pl_expr a = pl_dt(d->pool, v);
  if (d->loops.n > 0) a = pl_subst(d->pool, a, d->maps.at, d->maps.n);
  pl_replace fresh[3] = {{c->q, map}, {c->v, v}, {c->a, a}};
  for (int k = 0; k < d->maps.n; k++)
    d->maps.at[k].to = pl_subst(d->pool, d->maps.at[k].to, fresh, 3);
  for (int j = 0; j < d->q.n; j++) {
    if (!pl_is_poison(d->q.at[j].map)) d->q.at[j].map = pl_subst(d->pool, d->q.at[j].map, fresh, 3);
  }
  for (int k = 0; k < 3; k++) pl_push(d->arena, d->maps, fresh[k]);
}

pl_expr pl_mapped(pl_analysis* d, pl_expr e) {
  return pl_subst(d->pool, pl_on_contact(d, e), d->maps.at, d->maps.n);
}

// ------------------------------------------------------------------------------------------- roots
// A root that contains coordinates; poison if there is none.
static pl_expr root_in(pl_analysis* d, pl_expr e) {
  if (pl_is_sqrt(d->pool, e) && pl_has_coordinates(d, e)) return e;
  for (int k = 0; k < pl_n_args(d->pool, e); k++) {
    pl_expr found = root_in(d, pl_arg(d->pool, e, k));
    if (!pl_is_poison(found)) return found;
  }
  return pl_poison();
}

// sqrt(P) = r with a given r > 0 says P = r^2.
static pl_expr without_root(pl_analysis* d, pl_expr e) {
  int sign = 0;
  pl_expr root = root_in(d, e), c[2];
  if (pl_is_poison(root) || pl_alg_coefficients_atom(d->tower, e, root, c, 1) != 1) return e;
  if (pl_has_coordinates(d, c[0]) || pl_has_coordinates(d, c[1])) return e;
  pl_expr length = pl_alg_normal(d->tower, pl_neg(d->pool, pl_div(d->pool, c[0], c[1])));
  if (pl_alg_sign(d->tower, length, false, &sign) != PL_YES || sign < 0) return e;
  return pl_alg_normal(d->tower,
                       pl_sub(d->pool, pl_arg(d->pool, root, 0), pl_square(d->pool, length)));
}

static void find_places(pl_analysis* d) {
  for (int k = 0; k < d->g.n; k++)
    d->g.at[k].place = d->g.at[k].velocity ? d->g.at[k].g : without_root(d, d->g.at[k].g);
}

// -------------------------------------------------------------------------------------------- maps
static bool solve_linear(pl_analysis* d, pl_expr e, int i, pl_expr* out);

// x = s with x fixed by a constraint: the map fixes the chosen coordinate.
static void map_of_fixed(pl_analysis* d, pl_expr old, pl_expr map) {
  int i = pl_kind_of(d->pool, old) == PL_SYMBOL ? pl_variable_index(d, pl_symbol_of(d->pool, old))
                                                : -1;
  if (i < 0 || d->q.at[i].fixed_by < 0) return;
  pl_expr e = pl_mapped(d, pl_sub(d->pool, map, d->q.at[i].fixed));
  for (int j = 0; j < d->q.n; j++) {
    pl_variable* c = &d->q.at[j];
    pl_expr value;
    if (!c->chosen || c->carries || !pl_is_poison(c->map) || !pl_has_symbol(d->pool, e, c->q)
        || !solve_linear(d, e, j, &value))
      continue;
    set_map(d, j, value, d->q.at[i].fixed_by);
    return;
  }
}

// The map of `choose`: old coordinates first to last, each with the ones before it inserted.
static void chosen_maps(pl_analysis* d) {
  const pl_choose* choose = &d->model->choose;
  for (int k = 0; k < choose->n_maps; k++) {
    if (pl_kind_of(d->pool, choose->maps[k].old) != PL_SYMBOL) continue;
    int i = pl_variable_index(d, pl_symbol_of(d->pool, choose->maps[k].old));
    if (i >= 0 && d->q.at[i].fixed_by < 0) set_map(d, i, pl_mapped(d, choose->maps[k].map), -1);
  }
  for (int k = 0; k < choose->n_maps; k++)
    map_of_fixed(d, choose->maps[k].old, choose->maps[k].map);
}

// Does a candidate for coordinate i satisfy the branch conditions? PL_UNKNOWN: nothing speaks for
// or against it.
static pl_answer3 on_branch(pl_analysis* d, int i, pl_expr candidate) {
  pl_answer3 verdict = PL_UNKNOWN;
  for (int k = 0; k < d->model->branches.n; k++) {
    const pl_condition* c = &d->model->branches.at[k];
    pl_expr e = pl_mapped(d, pl_sub(d->pool, c->left, c->right));
    if (!pl_has_symbol(d->pool, e, d->q.at[i].q)) continue;
    e = pl_subst1(d->pool, e, d->q.at[i].q, candidate);
    bool want_positive = c->relation == PL_GT || c->relation == PL_GE;
    int sign = 0;
    if (pl_alg_sign(d->tower, e, true, &sign) != PL_YES || sign == 0) continue;
    if ((sign > 0) != want_positive) return PL_NO;
    verdict = PL_YES;
  }
  return verdict;
}

// Compares a candidate with the start value that `init` gives for coordinate i.
static pl_answer3 fits_start(pl_analysis* d, int i, pl_expr candidate) {
  pl_replace start[65];
  int n = 0;
  start[n++] = (pl_replace){pl_time(d->pool), pl_int(d->pool, 0)};
  for (int j = 0; j < d->q.n && n < 65; j++) {
    start[n++] = (pl_replace){d->q.at[j].q,
                              pl_sym(d->pool, pl_symbol_start(d->pool, d->q.at[j].q))};
  }
  double given = pl_number(d, pl_sym(d->pool, pl_symbol_start(d->pool, d->q.at[i].q)));
  double found = pl_number(d, pl_subst(d->pool, candidate, start, n));
  if (isnan(given) || isnan(found)) return PL_UNKNOWN;
  return fabs(given - found) <= 1e-6 * (fabs(given) + fabs(found)) ? PL_YES : PL_NO;
}

// One of several solutions of a constraint: the one that a branch or the start confirms, or the
// only one not refuted.
static int pick_root(pl_analysis* d, int i, const pl_root* root, int n) {
  int left = -1, n_left = 0;
  for (int k = 0; k < n; k++) {
    pl_answer3 verdict = on_branch(d, i, root[k].value);
    if (verdict == PL_UNKNOWN) verdict = fits_start(d, i, root[k].value);
    if (verdict == PL_YES) return k;
    if (verdict == PL_NO) continue;
    left = k;
    n_left++;
  }
  return n_left == 1 ? left : -1;
}

// A constraint linear in coordinate i with constant coefficient.
static bool solve_linear(pl_analysis* d, pl_expr e, int i, pl_expr* out) {
  pl_expr c[2];
  if (pl_alg_coefficients(d->tower, e, d->q.at[i].q, c, 1) != 1) return false;
  if (pl_has_coordinates(d, c[1]) || pl_has_symbol(d->pool, c[1], pl_time(d->pool))) return false;
  *out = pl_alg_normal(d->tower, pl_neg(d->pool, pl_div(d->pool, c[0], c[1])));
  return true;
}

// The arguments of sines and cosines in e that do not contain q.
enum { max_angles = 8 };
static int other_angles(pl_analysis* d, pl_expr e, pl_symbol q, pl_expr* out, int n) {
  if (pl_kind_of(d->pool, e) == PL_CALL && !pl_has_symbol(d->pool, e, q)) {
    pl_function f = pl_function_of(d->pool, e);
    bool turned = (f == PL_SIN || f == PL_COS) && n < max_angles;
    if (turned) out[n++] = pl_arg(d->pool, e, 0);
  }
  for (int k = 0; k < pl_n_args(d->pool, e); k++)
    n = other_angles(d, pl_arg(d->pool, e, k), q, out, n);
  return n;
}

// A proposed angle that is another angle, sin(φ - Ω t) = 0: φ = Ω t goes round, where atan(tan(Ω
// t)) jumps at every half turn.
static bool solve_turning(pl_analysis* d, pl_expr e, int i, pl_expr* out) {
  pl_expr angle[max_angles];
  int n = d->q.at[i].follows ? other_angles(d, e, d->q.at[i].q, angle, 0) : 0;
  for (int k = 0; k < 2 * n; k++) {
    *out = k % 2 ? pl_add(d->pool, angle[k / 2], pl_pi(d->pool)) : angle[k / 2];
    if (pl_alg_is_zero(d->tower, pl_subst1(d->pool, e, d->q.at[i].q, *out)) != PL_YES) continue;
    if (on_branch(d, i, *out) != PL_NO && fits_start(d, i, *out) != PL_NO) return true;
  }
  return false;
}

// atan(y/x) is one of two angles: the other one is half a turn away.
static bool is_half(pl_analysis* d, pl_expr root) {
  return pl_kind_of(d->pool, root) == PL_CALL && pl_function_of(d->pool, root) == PL_ATAN;
}

static bool solve_roots(pl_analysis* d, pl_expr e, int i, pl_expr* out) {
  d->q.at[i].by_branch = false;
  if (solve_turning(d, e, i, out)) return true;
  pl_root root[max_roots];
  bool complete = false;
  int n = pl_alg_roots(d->tower, e, d->q.at[i].q, root, max_roots, &complete);
  if (n == 1 && is_half(d, root[0].value)) return false;
  int k = n == 1 && complete ? 0 : pick_root(d, i, root, n);
  if (k < 0) return false;
  d->q.at[i].by_branch = n > 1;
  *out = root[k].value;
  return true;
}

// A coordinate that `init` speaks of is meant to stay.
static bool has_start(const pl_analysis* d, const pl_variable* c) {
  for (int k = 0; k < d->model->inits.n; k++) {
    pl_expr target = d->model->inits.at[k].target;
    if (pl_same(target, pl_sym(d->pool, c->q)) || pl_same(target, pl_sym(d->pool, c->v)))
      return true;
  }
  return false;
}

static bool solve_link_for(pl_analysis* d, int k, bool roots, bool started) {
  pl_expr e = pl_mapped(d, d->g.at[k].place);
  for (int i = d->q.n - 1; i >= 0; i--) {
    if (!pl_open_coordinate(&d->q.at[i]) || !pl_has_symbol(d->pool, e, d->q.at[i].q)) continue;
    if (has_start(d, &d->q.at[i]) != started) continue;
    pl_expr value;
    if (roots ? solve_roots(d, e, i, &value) : solve_linear(d, e, i, &value)) {
      d->q.at[i].solved_slope = pl_diff(d->pool, e, d->q.at[i].q);
      set_map(d, i, value, k);
      return true;
    }
  }
  return false;
}

static bool solve_link(pl_analysis* d, int k, bool roots) {
  const pl_bond* l = &d->g.at[k];
  if (l->fixes >= 0 || l->implied || l->velocity) return false;
  return solve_link_for(d, k, roots, false) || solve_link_for(d, k, roots, true);
}

// 0: the map satisfies the constraint identically; 1: something is left; -1: not decided.
static int left_over(pl_analysis* d, const pl_bond* l) {
  pl_expr g = pl_mapped(d, l->place);
  pl_answer3 zero = pl_alg_is_zero(d->tower, g);
  if (zero != PL_YES && pl_has_followers(d, g)) zero = pl_holds_on_loops(d, g, pl_int(d->pool, 0));
  return zero == PL_YES ? 0 : zero == PL_NO ? 1 : -1;
}

// Alone; with another one for two coordinates; or in several ways.
static bool solve_somehow(pl_analysis* d, int k, bool roots_allowed) {
  if (solve_link(d, k, false)) return true;
  return roots_allowed
         && (pl_solve_loop(d, k, true) || solve_link(d, k, true) || pl_solve_loop(d, k, false));
}

// Passes over the constraints, as long as one more is solved.
static bool solve_links(pl_analysis* d) {
  bool kinematic = d->particle.n == 0 && d->model->loads.n == 0;
  bool roots_allowed = d->model->choose.coords.n > 0 || d->is_proposal || kinematic, all = false;
  bool* done = PL_ARRAY(d->arena, bool, d->g.n + 1);
  for (bool progress = true; progress && !all;) {
    progress = false;
    all = true;
    for (int k = 0; k < d->g.n; k++) {
      pl_bond* l = &d->g.at[k];
      if (done[k] || l->fixes >= 0 || l->implied || pl_in_loop(d, k)) continue;
      if (l->velocity) return false;
      done[k] = left_over(d, l) == 0 || solve_somehow(d, k, roots_allowed);
      progress |= done[k];
      all &= done[k];
    }
  }
  return all;
}

// What is neither fixed nor mapped is generalized.
void pl_collect_generalized(pl_analysis* d) {
  for (int i = 0; i < d->q.n; i++) {
    pl_variable* c = &d->q.at[i];
    if (c->fixed_by < 0 && pl_is_poison(c->map) && (c->carries || c->chosen))
      pl_push(d->arena, d->gen, i);
  }
}

// Coordinate i follows from its own equation and is no freedom of its own.
static void hide_coordinate(pl_analysis* d, int i, pl_expr value) {
  set_map(d, i, value, -3);
  pl_push(d->arena, d->hidden, i);
  d->gen.n = 0;
  pl_collect_generalized(d);
  d->Lg = pl_on_maps(d, d->L);
}

// A generalized coordinate whose equation of the second kind contains neither accelerations nor
// velocities: a hidden constraint.
// Where it is linear in the coordinate, the coordinate is solved for and is no freedom of its own.
static bool find_hidden(pl_analysis* d) {
  for (int k = 0; k < d->gen.n; k++) {
    int i = d->gen.at[k];
    pl_expr e = pl_alg_normal(d->tower, pl_second_kind(d, i)), value;
    bool moving = pl_has_role(d->pool, e, PL_R_ACCELERATION)
                  || pl_has_role(d->pool, e, PL_R_VELOCITY);
    if (moving || !pl_has_symbol(d->pool, e, d->q.at[i].q) || !solve_linear(d, e, i, &value))
      continue;
    hide_coordinate(d, i, value);
    return true;
  }
  return false;
}

// ------------------------------------------------------------ hidden behind a singular mass matrix
enum { max_hidden = 8 };

static void mass_matrix(pl_analysis* d, pl_expr* M) {
  int n = d->gen.n;
  for (int a = 0; a < n; a++) {
    pl_expr momentum = pl_diff(d->pool, d->Lg, d->q.at[d->gen.at[a]].v);
    for (int b = 0; b < n; b++)
      M[a * n + b] = pl_alg_normal(d->tower, pl_diff(d->pool, momentum, d->q.at[d->gen.at[b]].v));
  }
}

// A combination w of the equations without accelerations: w M = 0, with constant w. The row `of`
// has w = 1.
static bool null_combination(pl_analysis* d, const pl_expr* M, int of, pl_expr* w) {
  int n = d->gen.n;
  if (pl_alg_dependency(d->tower, n, n, M, of, w) != PL_YES) return false;
  for (int k = 0; k < n; k++) {
    if (k == of) continue;
    w[k] = pl_alg_normal(d->tower, pl_neg(d->pool, w[k]));
    if (pl_has_coordinates(d, w[k]) || pl_has_symbol(d->pool, w[k], pl_time(d->pool))) return false;
  }
  w[of] = pl_int(d->pool, 1);
  return true;
}

// e without accelerations and velocities whose coefficients vanish, maybe only once names are seen
// through.
static pl_expr without_idle(pl_analysis* d, pl_expr e) {
  for (int k = 0; k < d->gen.n; k++) {
    const pl_variable* c = &d->q.at[d->gen.at[k]];
    pl_symbol moving[2] = {c->a, c->v};
    for (int j = 0; j < 2; j++) {
      if (pl_alg_is_zero(d->tower, pl_diff(d->pool, e, moving[j])) == PL_YES)
        e = pl_subst1(d->pool, e, moving[j], pl_int(d->pool, 0));
    }
  }
  return pl_alg_normal(d->tower, e);
}

// What the combination leaves is a constraint between places, and moving along w leaves it: then
// the coordinate follows from it.
static bool solve_combination(pl_analysis* d, const pl_expr* w) {
  pl_pool* p = d->pool;
  pl_expr left = pl_int(p, 0), across = pl_int(p, 0), value;
  for (int k = 0; k < d->gen.n; k++)
    left = pl_add(p, left, pl_mul(p, w[k], pl_second_kind(d, d->gen.at[k])));
  left = without_idle(d, pl_alg_normal(d->tower, left));
  if (pl_has_role(p, left, PL_R_ACCELERATION) || pl_has_role(p, left, PL_R_VELOCITY)) return false;
  for (int k = 0; k < d->gen.n; k++)
    across = pl_add(p, across, pl_mul(p, w[k], pl_diff(p, left, d->q.at[d->gen.at[k]].q)));
  if (pl_alg_is_zero(d->tower, across) != PL_NO) return false;
  for (int k = d->gen.n - 1; k >= 0; k--) {
    int i = d->gen.at[k];
    if (pl_is_zero_node(p, w[k]) || !pl_has_symbol(p, left, d->q.at[i].q)
        || !solve_linear(d, left, i, &value))
      continue;
    d->q.at[i].by_combination = true;
    hide_coordinate(d, i, value);
    return true;
  }
  return false;
}

// The mass matrix is singular by its values: m (x' + y')²/2 moves x + y alone, and the forces along
// x - y are a constraint.
static bool find_hidden_combination(pl_analysis* d) {
  int n = d->gen.n;
  pl_expr M[max_hidden * max_hidden], w[max_hidden];
  if (n == 0 || n > max_hidden) return false;
  mass_matrix(d, M);
  int rank = pl_alg_rank(d->tower, n, n, M, NULL);
  for (int of = n - 1; of >= 0 && rank < n; of--) {
    if (null_combination(d, M, of, w) && solve_combination(d, w)) return true;
  }
  d->mass_is_singular = rank < n;
  return false;
}

pleuel_status pl_reduce(pl_analysis* d) {
  find_places(d);
  chosen_maps(d);
  d->reduced = solve_links(d);
  if (!d->reduced) {
    for (int i = 0; i < d->q.n; i++) d->q.at[i].map = pl_poison();
    d->maps.n = d->loops.n = 0;
    return PLEUEL_OK;
  }
  pl_collect_generalized(d);
  d->Lg = pl_on_maps(d, d->L);
  while (d->loops.n == 0 && (find_hidden(d) || find_hidden_combination(d))) {}
  d->Tg = pl_alg_normal(d->tower, pl_on_maps(d, d->T));
  d->Vg = pl_alg_normal(d->tower, pl_on_maps(d, d->V));
  return PLEUEL_OK;
}
