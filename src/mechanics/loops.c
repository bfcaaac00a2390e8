// loops: closed linkages. One or two constraints determine one or two coordinates in several ways,
// the assemblies: a four-bar
// linkage, an offset slider-crank, two circles. The coordinates keep their names; velocities follow
// by implicit differentiation,
//   dg/du u' = -(dg/dq q' + dg/dt),
// linear and short, the same in all assemblies. Functions of generalized coordinates are then
// functions of the names too, and d/dq_i follows them (pl_by_coordinate). Which assembly it is, a
// `branch` or the start tells; else all are answered.
// See theory (5.1) to (5.4).
#include <math.h>
#include <string.h>

#include "mechanics/loops_impl.h"
#include "verify/verify.h"

// --------------------------------------------------------------------------------------- questions
bool pl_in_loop(const pl_analysis* d, int bond) {
  for (int k = 0; k < d->loops.n; k++) {
    const pl_loop* l = &d->loops.at[k];
    for (int j = 0; j < l->n; j++) {
      if (l->bond[j] == bond) return true;
    }
  }
  return false;
}

static int place_in(const pl_loop* l, int coordinate) {
  for (int j = 0; j < l->n; j++) {
    if (l->coordinate[j] == coordinate) return j;
  }
  return -1;
}

int pl_follower(const pl_analysis* d, int coordinate) {
  for (int k = 0; k < d->loops.n; k++) {
    if (place_in(&d->loops.at[k], coordinate) >= 0) return k;
  }
  return -1;
}

bool pl_has_followers(const pl_analysis* d, pl_expr e) {
  for (int k = 0; k < d->loops.n && !pl_is_poison(e); k++) {
    const pl_loop* l = &d->loops.at[k];
    for (int j = 0; j < l->n; j++) {
      if (pl_has_symbol(d->pool, e, d->q.at[l->coordinate[j]].q)) return true;
    }
    for (int j = 0; j < l->slopes.n; j++) {
      if (pl_has_symbol(d->pool, e, l->slopes.at[j].name)) return true;
    }
  }
  return false;
}

int pl_assemblies(const pl_analysis* d) {
  int n = 1;
  for (int k = 0; k < d->loops.n; k++) n *= d->loops.at[k].n_ways;
  return n;
}

// The way of loop k in an assembly: digits, the last loop fastest.
static int way_of(const pl_analysis* d, int assembly, int k) {
  for (int j = d->loops.n - 1; j > k; j--) assembly /= d->loops.at[j].n_ways;
  return assembly % d->loops.at[k].n_ways;
}

int pl_loop_definitions(pl_analysis* d, int assembly, pl_definition* out) {
  int n = 0;
  for (int k = 0; k < d->loops.n; k++) {
    const pl_loop* l = &d->loops.at[k];
    for (int j = 0; j < l->names.n; j++, n++) {
      if (out) out[n] = l->names.at[j];
    }
    for (int j = 0; j < l->n; j++, n++) {
      if (out)
        out[n] = (pl_definition){d->q.at[l->coordinate[j]].q, l->value[way_of(d, assembly, k)][j]};
    }
    for (int j = 0; j < l->slopes.n; j++, n++) {
      if (out) out[n] = (pl_definition){l->slopes.at[j].name, l->slopes.at[j].value};
    }
    for (int j = 0; j < l->bends.n; j++, n++) {
      if (out) out[n] = l->bends.at[j];
    }
    for (int j = 0; j < l->n; j++, n++) {
      if (out) out[n] = (pl_definition){d->q.at[l->coordinate[j]].v, l->rate[j]};
    }
    for (int j = 0; j < l->slopes.n; j++, n++) {
      if (out) out[n] = (pl_definition){l->slopes.at[j].dot, l->slopes.at[j].rate};
    }
  }
  return n;
}

pl_expr pl_on_assembly(pl_analysis* d, pl_expr e, int assembly) {
  for (int k = d->loops.n - 1; k >= 0; k--) {
    const pl_loop* l = &d->loops.at[k];
    for (int j = l->n - 1; j >= 0; j--)
      e = pl_subst1(d->pool, e, d->q.at[l->coordinate[j]].q, l->value[way_of(d, assembly, k)][j]);
    for (int j = l->names.n - 1; j >= 0; j--)
      e = pl_subst1(d->pool, e, l->names.at[j].symbol, l->names.at[j].value);
  }
  return e;
}

// de/ds times ds/dq_i, or ds/dt at rest of q for i < 0.
static pl_expr through(pl_analysis* d, pl_expr e, pl_symbol s, pl_expr rate, int i) {
  pl_expr slope = pl_diff(d->pool, e, s);
  if (pl_is_zero_node(d->pool, slope)) return slope;
  if (i >= 0) return pl_mul(d->pool, slope, pl_diff(d->pool, rate, d->q.at[i].v));
  for (int k = 0; k < d->q.n; k++)
    rate = pl_subst1(d->pool, rate, d->q.at[k].v, pl_int(d->pool, 0));
  return pl_mul(d->pool, slope, rate);
}

pl_expr pl_by_coordinate(pl_analysis* d, pl_expr e, int i) {
  pl_expr sum = pl_diff(d->pool, e, i >= 0 ? d->q.at[i].q : pl_time(d->pool));
  for (int k = 0; k < d->loops.n; k++) {
    const pl_loop* l = &d->loops.at[k];
    for (int j = 0; j < l->n; j++)
      sum = pl_add(d->pool, sum, through(d, e, d->q.at[l->coordinate[j]].q, l->rate[j], i));
    for (int j = 0; j < l->slopes.n; j++)
      sum = pl_add(d->pool, sum, through(d, e, l->slopes.at[j].name, l->slopes.at[j].rate, i));
  }
  return sum;
}

pl_answer3 pl_holds_on_loops(pl_analysis* d, pl_expr left, pl_expr right) {
  int n_used = 0, n = d->facts.n, n_definitions = pl_loop_definitions(d, 0, NULL);
  const pl_fact* used = pl_tower_used(d->tower, &n_used);
  pl_fact* fact = PL_ARRAY(d->arena, pl_fact, n + n_used + 1);
  for (int k = 0; k < n; k++) fact[k] = d->facts.at[k];
  for (int k = 0; k < n_used; k++) {
    if (!pl_has_role(d->pool, used[k].difference, PL_R_VELOCITY)) fact[n++] = used[k];
  }
  pl_definition* definition = PL_ARRAY(d->arena, pl_definition, n_definitions + 1);
  pl_answer3 all = PL_YES;
  for (int a = 0; a < pl_assemblies(d) && all != PL_NO; a++) {
    pl_loop_definitions(d, a, definition);
    pl_domain setup = {
        .facts = fact, .n_facts = n, .definitions = definition, .n_definitions = n_definitions};
    pl_answer3 equal = pl_verify(pl_verifier_make(d->job, d->pool, &setup), left, right).equal;
    if (equal != PL_YES) all = equal;
  }
  return all;
}

// ------------------------------------------------------------------------ numbers at sample points
static const int n_samples = 48;
static const double widest = 3.0;  // generalized coordinates are drawn from -3 .. 3

typedef struct pl_sample {
  double* x;
  pl_random random;
} pl_sample;  // by symbol id

static void number_parameters(pl_analysis* d, pl_sample* s) {
  pl_number(d, pl_int(d->pool, 0));  // numbers are up to date
  int n = pl_symbol_count(d->pool) + 1;
  s->x = PL_ARRAY(d->arena, double, n);
  for (int k = 1; k < n; k++) s->x[k] = k < d->n_value + 1 ? d->value[k] : (double)NAN;
  s->x[0] = (double)NAN;
}

static void draw(pl_analysis* d, pl_sample* s) {
  int n = pl_symbol_count(d->pool) + 1;
  for (int k = 1; k < n; k++) {
    pl_symbol x = {(uint32_t)k};
    pl_role role = pl_symbol_get(d->pool, x)->role;
    if (role == PL_R_COORD || role == PL_R_TIME)
      s->x[k] = pl_random_between(&s->random, -widest, widest);
    else if (role == PL_R_PARAM && isnan(d->value[k]))
      s->x[k] = pl_random_between(&s->random, 0.3, widest);
  }
}

// Values of the loops up to the one that is being solved; false where they are not real.
static bool follow(pl_analysis* d, pl_sample* s, const pl_loop* last, int way) {
  for (int k = 0; k <= d->loops.n; k++) {
    const pl_loop* l = k < d->loops.n ? &d->loops.at[k] : last;
    int w = k < d->loops.n ? 0 : way;
    for (int j = 0; j < l->names.n; j++)
      s->x[l->names.at[j].symbol.id] = pl_eval(d->pool, l->names.at[j].value, s->x);
    for (int j = 0; j < l->n; j++) {
      double x = pl_eval(d->pool, l->value[w][j], s->x);
      if (!isfinite(x)) return false;
      s->x[d->q.at[l->coordinate[j]].q.id] = x;
    }
  }
  return true;
}

// ----------------------------------------------------------------------- what tells the ways apart
// The sign of det dg/du: positive factors are dropped, and those of parameters too.
static void find_side(pl_analysis* d, pl_loop* l, const pl_expr* e) {
  pl_pool* p = d->pool;
  pl_symbol u = d->q.at[l->coordinate[0]].q, v = l->n == 2 ? d->q.at[l->coordinate[1]].q : u;
  pl_expr J = pl_diff(p, e[0], u), unit;
  if (l->n == 2)
    J = pl_sub(p, pl_mul(p, J, pl_diff(p, e[1], v)),
               pl_mul(p, pl_diff(p, e[0], v), pl_diff(p, e[1], u)));
  pl_factor f[16];
  int n = pl_alg_factors(d->tower, J, f, 16, &unit), sign;
  l->side = pl_int(p, 1);
  for (int k = 0; k < n; k++) {
    bool even = f[k].power % 2 == 0, moves = pl_has_coordinates(d, f[k].base);
    if (even || !moves || pl_alg_sign(d->tower, f[k].base, false, &sign) == PL_YES) continue;
    l->side = pl_mul(p, l->side, f[k].base);
  }
  pl_sample s = {.random = {77}};
  number_parameters(d, &s);
  int seen[pl_max_ways][2] = {{0}};
  for (int i = 0; i < n_samples; i++) {
    draw(d, &s);
    for (int w = 0; w < l->n_ways; w++) {
      double x = follow(d, &s, l, w) ? pl_eval(p, l->side, s.x) : (double)NAN;
      if (fabs(x) > 1e-9) seen[w][x > 0]++;
    }
  }
  for (int w = 0; w < l->n_ways; w++)
    l->sign[w] = seen[w][0] && seen[w][1] ? 0 : seen[w][1] ? 1 : seen[w][0] ? -1 : 0;
}

static bool wants_positive(const pl_condition* c) {
  return c->relation == PL_GT || c->relation == PL_GE;
}

// How often the branch conditions on the unknowns hold for a way: at all sample points, at some, at
// none.
typedef struct pl_tally {
  int met, missed;
} pl_tally;

static bool speaks_of(pl_analysis* d, pl_expr e, const pl_loop* l) {
  for (int j = 0; j < l->n; j++) {
    if (pl_has_symbol(d->pool, e, d->q.at[l->coordinate[j]].q)) return true;
  }
  return false;
}

static pl_tally tally(pl_analysis* d, pl_sample* s, const pl_loop* l, int way) {
  pl_tally t = {0};
  if (!follow(d, s, l, way)) return t;
  for (int k = 0; k < d->model->branches.n; k++) {
    const pl_condition* c = &d->model->branches.at[k];
    pl_expr e = pl_mapped(d, pl_sub(d->pool, c->left, c->right));
    if (!speaks_of(d, e, l)) continue;
    double x = pl_eval(d->pool, e, s->x);
    if (isnan(x)) continue;
    if ((x > 0) == wants_positive(c)) t.met++;
    else t.missed++;
  }
  return t;
}

static void keep_ways(pl_loop* l, const bool* keep) {
  int n = 0;
  for (int w = 0; w < l->n_ways; w++) {
    if (!keep[w]) continue;
    l->value[n][0] = l->value[w][0];
    l->value[n][1] = l->value[w][1];
    l->sign[n++] = l->sign[w];
  }
  if (n == 0 || n == l->n_ways) return;
  l->n_ways = n;
  l->picked = true;
}

// A branch condition that one way meets wherever it is real, and another one does not.
static void pick_by_branch(pl_analysis* d, pl_loop* l) {
  pl_sample s = {.random = {4711}};
  number_parameters(d, &s);
  bool keep[pl_max_ways] = {0};
  int missed[pl_max_ways] = {0}, met[pl_max_ways] = {0};
  for (int i = 0; i < n_samples; i++) {
    draw(d, &s);
    for (int w = 0; w < l->n_ways; w++) {
      pl_tally t = tally(d, &s, l, w);
      met[w] += t.met;
      missed[w] += t.missed;
    }
  }
  for (int w = 0; w < l->n_ways; w++) keep[w] = met[w] > 0 && missed[w] == 0;
  keep_ways(l, keep);
}

// --------------------------------------------------------------------------------------- the start
static double start_of(pl_analysis* d, pl_symbol q) {
  for (int k = 0; k < d->model->inits.n; k++) {
    const pl_init* init = &d->model->inits.at[k];
    if (pl_same(init->target, pl_sym(d->pool, q))) return pl_eval(d->pool, init->value, d->value);
  }
  return (double)NAN;
}

// Distance of a way from the start that is given, angles modulo 2π; NaN when nothing is given.
static double distance(pl_analysis* d, const pl_sample* s, const pl_loop* l, const bool* angle) {
  double sum = 0;
  int n = 0;
  for (int j = 0; j < l->n; j++) {
    pl_symbol q = d->q.at[l->coordinate[j]].q;
    double x0 = start_of(d, q);
    if (isnan(x0)) continue;
    double apart = s->x[q.id] - x0;
    if (angle[j]) apart = remainder(apart, 2 * M_PI);
    sum += apart * apart;
    n++;
  }
  return n ? sqrt(sum) : (double)NAN;
}

static const double clearly = 0.5;  // the nearest way is at most half as far as the next

// The branch conditions at the start, then the way nearest to what `init` says.
static void pick_by_start(pl_analysis* d, pl_loop* l, const bool* angle) {
  pl_sample s = {0};
  number_parameters(d, &s);
  for (int i = 0; i < d->q.n; i++) s.x[d->q.at[i].q.id] = start_of(d, d->q.at[i].q);
  s.x[pl_time(d->pool).id] = 0;
  bool keep[pl_max_ways] = {0};
  double far[pl_max_ways], least = INFINITY;
  for (int w = 0; w < l->n_ways; w++) {
    pl_tally t = tally(d, &s, l, w);
    bool real = follow(d, &s, l, w);
    keep[w] = real && t.met > 0 && t.missed == 0;
    far[w] = real ? distance(d, &s, l, angle) : (double)NAN;
    if (far[w] < least) least = far[w];
  }
  keep_ways(l, keep);
  if (l->picked || !isfinite(least)) return;
  for (int w = 0; w < l->n_ways; w++) keep[w] = far[w] * clearly <= least;
  keep_ways(l, keep);
}

// -------------------------------------------------------------------------------------- velocities
static bool find_rates(pl_analysis* d, pl_loop* l) {
  pl_expr A[4], b[2], x[2];
  pl_replace zero[2];
  for (int j = 0; j < l->n; j++)
    zero[j] = (pl_replace){d->q.at[l->coordinate[j]].v, pl_int(d->pool, 0)};
  for (int r = 0; r < l->n; r++) {
    pl_expr rate = pl_mapped(d, pl_dt(d->pool, d->g.at[l->bond[r]].place));
    for (int j = 0; j < l->n; j++)
      A[r * l->n + j] = pl_alg_normal(d->tower, pl_diff(d->pool, rate, zero[j].from));
    b[r] = pl_neg(d->pool, pl_subst(d->pool, rate, zero, l->n));
  }
  if (pl_alg_solve(d->tower, l->n, A, b, x, 2000) != PL_YES) return false;
  for (int j = 0; j < l->n; j++) l->rate[j] = l->written_out[j] = x[j];
  return true;
}

enum { most_leaders = 8 };
static const long longest_inline = 3;  // operations of a coefficient that needs no name

// Coordinates whose velocities stand in e.
static int leaders_in(pl_analysis* d, pl_expr e, int* out) {
  int n = 0;
  for (int i = 0; i < d->q.n && n < most_leaders; i++) {
    if (pl_has_symbol(d->pool, e, d->q.at[i].v)) out[n++] = i;
  }
  return n;
}

static pl_symbol coefficient_name(pl_analysis* d, const char* letter, pl_symbol of, const int* by,
                                  int n_by, bool moves, pl_expr value) {
  const pl_symbol_info* q = pl_symbol_get(d->pool, of);
  const char *name = pl_format(d->arena, "%s_%s", letter, q->name),
             *ascii = pl_format(d->arena, "%s_%s", letter, q->ascii);
  for (int k = 0; k < n_by; k++) {
    const pl_symbol_info* b = pl_symbol_get(d->pool, d->q.at[by[k]].q);
    name = pl_format(d->arena, "%s,%s", name, b->name);
    ascii = pl_format(d->arena, "%s_%s", ascii, b->ascii);
  }
  while (pl_symbol_find(d->pool, ascii).id) {
    name = pl_format(d->arena, "%s%s", letter, name);
    ascii = pl_format(d->arena, "%s%s", letter, ascii);
  }
  pl_symbol_info info = {
      .name = name, .ascii = ascii, .role = moves ? PL_R_COORD : PL_R_LOCAL, .class = PL_C_OTHER};
  info.dimension = pl_dimension_of_expr(d, value, &info.dimension_known);
  return pl_symbol_make(d->pool, &info);
}

// u' = sum K q' + rest, with a name for each K that is not short.
static void name_slopes(pl_analysis* d, pl_loop* l) {
  for (int j = 0; j < l->n; j++) {
    int by[most_leaders], n = leaders_in(d, l->written_out[j], by);
    pl_expr rest = l->written_out[j], sum = pl_int(d->pool, 0);
    for (int k = 0; k < n; k++) {
      pl_symbol v = d->q.at[by[k]].v;
      pl_expr K = pl_alg_normal(d->tower, pl_diff(d->pool, l->written_out[j], v));
      rest = pl_subst1(d->pool, rest, v, pl_int(d->pool, 0));
      if (pl_op_count(d->pool, K) > longest_inline) {
        pl_slope s = {.of = d->q.at[l->coordinate[j]].q, .value = K, .rate = pl_int(d->pool, 0)};
        s.name = coefficient_name(d, "K", d->q.at[l->coordinate[j]].q, by + k, n > 1, true, K);
        s.dot = pl_symbol_dot(d->pool, s.name);
        pl_push(d->arena, l->slopes, s);
        K = pl_sym(d->pool, s.name);
      }
      sum = pl_add(d->pool, sum, pl_mul(d->pool, K, pl_sym(d->pool, v)));
    }
    l->rate[j] = pl_add(d->pool, sum, pl_alg_normal(d->tower, rest));
  }
}

// K' = sum L q' + rest: how the coefficients change along the motion.
static void name_bends(pl_analysis* d, pl_loop* l) {
  int by[most_leaders], n = 0;
  for (int j = 0; j < l->n && n == 0; j++) n = leaders_in(d, l->written_out[j], by);
  for (int j = 0; j < l->slopes.n; j++) {
    pl_slope* s = &l->slopes.at[j];
    pl_expr rate = pl_alg_normal(d->tower, pl_by_coordinate(d, s->value, -1));
    for (int k = 0; k < n; k++) {
      pl_expr L = pl_alg_normal(d->tower, pl_by_coordinate(d, s->value, by[k]));
      if (pl_op_count(d->pool, L) > longest_inline) {
        pl_symbol name = coefficient_name(d, "L", s->of, by + k, n > 1, false, L);
        pl_push(d->arena, l->bends, (pl_definition){name, L});
        L = pl_sym(d->pool, name);
      }
      rate = pl_add(d->pool, rate, pl_mul(d->pool, L, pl_sym(d->pool, d->q.at[by[k]].v)));
    }
    s->rate = rate;
  }
}

// Maps of the velocities and accelerations; the coordinates stay.
static void keep_names(pl_analysis* d, const pl_loop* l) {
  int n = 0;
  pl_replace* fresh = PL_ARRAY(d->arena, pl_replace, 2 * l->n + l->slopes.n);
  for (int j = 0; j < l->n; j++) fresh[n++] = (pl_replace){d->q.at[l->coordinate[j]].v, l->rate[j]};
  for (int j = 0; j < l->slopes.n; j++)
    fresh[n++] = (pl_replace){l->slopes.at[j].dot, l->slopes.at[j].rate};
  int n_first = n;
  for (int j = 0; j < l->n; j++) {
    pl_expr a = pl_subst(d->pool,
                         pl_subst(d->pool, pl_dt(d->pool, l->rate[j]), d->maps.at, d->maps.n),
                         fresh, n_first);
    fresh[n++] = (pl_replace){d->q.at[l->coordinate[j]].a, a};
  }
  for (int k = 0; k < d->maps.n; k++)
    d->maps.at[k].to = pl_subst(d->pool, d->maps.at[k].to, fresh, n);
  for (int k = 0; k < n; k++) pl_push(d->arena, d->maps, fresh[k]);
  for (int j = 0; j < l->n; j++) {
    pl_variable* c = &d->q.at[l->coordinate[j]];
    c->map = pl_sym(d->pool, c->q);
    c->solved_by = l->bond[j];
  }
}

// ----------------------------------------------------------------------------------- finding loops
static bool started(const pl_analysis* d, int i) {
  for (int k = 0; k < d->model->inits.n; k++) {
    pl_expr target = d->model->inits.at[k].target;
    if (!d->model->inits.at[k].guess && pl_same(target, pl_sym(d->pool, d->q.at[i].q))) return true;
  }
  return false;
}

static int open_in(const pl_analysis* d, pl_expr e, int* out, int max, bool with_start) {
  int n = 0;
  for (int i = 0; i < d->q.n; i++) {
    if (!pl_open_coordinate(&d->q.at[i]) || !pl_has_symbol(d->pool, e, d->q.at[i].q)
        || (!with_start && started(d, i)))
      continue;
    if (n < max) out[n] = i;
    n++;
  }
  return n;
}

// The unknowns of a constraint: two at most. Without `choose`, a coordinate with a start is not one
// when others are left.
static int unknowns_in(pl_analysis* d, pl_expr e, int* out) {
  int n = open_in(d, e, out, 2, true);
  if (n > 2 && d->model->choose.coords.n == 0) n = open_in(d, e, out, 2, false);
  return n;
}

static bool add_loop(pl_analysis* d, pl_loop* l, const pl_expr* e, const pl_unknown* unknown) {
  bool angle[2] = {0};
  for (int j = 0; j < l->n; j++) {
    l->coordinate[j] = unknown[j].i;
    angle[j] = unknown[j].angle;
  }
  int sign;
  bool never = !pl_is_poison(l->real) && pl_alg_sign(d->tower, l->real, false, &sign) == PL_YES
               && sign < 0;
  if (never || pl_assemblies(d) * l->n_ways > pl_max_assemblies || !find_rates(d, l)) return false;
  if (!pl_is_poison(l->real)) pl_tower_use(d->tower, (pl_fact){l->real, false});
  find_side(d, l, e);
  if (l->n_ways > 1) pick_by_branch(d, l);
  if (l->n_ways > 1) pick_by_start(d, l, angle);
  name_slopes(d, l);
  pl_push(d->arena, d->loops, *l);
  l = &d->loops.at[d->loops.n - 1];
  name_bends(d, l);
  keep_names(d, l);
  return true;
}

static pl_loop empty_loop(int n, int bond, int other) {
  return (pl_loop){.n = n,
                   .bond = {bond, other},
                   .real = pl_poison(),
                   .eliminated = pl_poison(),
                   .side = pl_poison()};
}

static bool solve_alone(pl_analysis* d, int bond, pl_expr e, int i) {
  pl_unknown u;
  if (!pl_unknown_of(d, i, &e, 1, &u)) return false;
  pl_loop l = empty_loop(1, bond, -1);
  return pl_ways_of_one(d, &l, e, &u) && add_loop(d, &l, &e, &u);
}

static bool solve_pair(pl_analysis* d, int bond, int other, const pl_expr* e, const int* open) {
  pl_unknown u[2];
  for (int j = 0; j < 2; j++) {
    if (!pl_unknown_of(d, open[j], e, 2, &u[j])) return false;
  }
  for (int last = 0; last < 2; last++) {  // the first coordinate is eliminated, if it can be
    pl_loop l = empty_loop(2, bond, other);
    pl_unknown order[2] = {u[1 - last], u[last]};
    if (pl_ways_of_two(d, &l, e, &order[0], &order[1]) && add_loop(d, &l, e, order)) return true;
  }
  return false;
}

static bool is_at_work(const pl_analysis* d, int k) {
  const pl_bond* l = &d->g.at[k];
  return l->fixes < 0 && !l->implied && !l->velocity && !pl_in_loop(d, k);
}

bool pl_solve_loop(pl_analysis* d, int bond, bool pair) {
  int open[2], other_open[2];
  pl_expr e[2] = {pl_mapped(d, d->g.at[bond].place), pl_poison()};
  int n = unknowns_in(d, e[0], open);
  if (n == 1 && !pair) return solve_alone(d, bond, e[0], open[0]);
  for (int k = 0; n == 2 && pair && k < d->g.n; k++) {
    if (k == bond || !is_at_work(d, k)) continue;
    e[1] = pl_mapped(d, d->g.at[k].place);
    int m = unknowns_in(d, e[1], other_open);
    bool same = m == 2 && open[0] == other_open[0] && open[1] == other_open[1];
    if (same && solve_pair(d, bond, k, e, open)) return true;
  }
  return false;
}

// ------------------------------------------------------------------------------------------ claims
