// propose: generalized coordinates for a model that chooses none.
//
// The constraints tell them. A sum of squares, (x - a)^2/A + (y - b)^2/B = 1, gives its angle, a
// sphere two angles; where there is
// none, a coordinate that is there already leads and the constraints are solved for the others.
// Each proposal is a `choose` in a
// copy of the model: it is tried as if the text had said it, and the first one that solves all
// constraints is taken. What is derived
// with it is a second analysis beside the one in the coordinates of the model; both share pool and
// solution.
#include <math.h>
#include <string.h>

#include "mechanics/propose.h"

enum { most_angles = PL_MAX_PROPOSED, most_trials = 12 };

// One sum of squares: half axes and centres along its coordinates, and the angles that take their
// place.
typedef struct pl_round {
  int n, bond;
  int coordinate[3];
  pl_expr centre[3], axis[3];
} pl_round;

typedef struct pl_proposal_trial {
  pl_round round[most_angles];
  int n_rounds;
  // of the new angles: these lead, the others follow by a constraint; n_leaders 0: all lead
  int leader, n_leaders;
  int chosen[most_angles];  // coordinates that are there already
  int n_chosen;
} pl_proposal_trial;

// --------------------------------------------------------------------------------- sums of squares
// e = square q^2 + slope q + rest, the first two without q; false if it is not of this shape.
static bool square_in(pl_analysis* d, pl_expr e, pl_symbol q, pl_expr* c) {
  if (pl_alg_coefficients(d->tower, e, q, c, 2) != 2 || pl_has_coordinates(d, c[2])) return false;
  return true;
}

// e is a sum of squares in these coordinates; what is left of it is minus the square of the radius
// times a coefficient.
static bool round_in(pl_analysis* d, pl_expr e, const int* coordinate, int n, pl_round* out) {
  pl_pool* p = d->pool;
  pl_expr square[3], c[3];
  *out = (pl_round){.n = n};
  for (int k = 0; k < n; k++) {
    if (!square_in(d, e, d->q.at[coordinate[k]].q, c)) return false;
    for (int j = k + 1; j < n; j++) {
      if (pl_has_symbol(p, c[1], d->q.at[coordinate[j]].q)) return false;
    }
    out->coordinate[k] = coordinate[k];
    out->centre[k] = pl_alg_normal(d->tower,
                                   pl_neg(p, pl_div(p, c[1], pl_mul(p, pl_int(p, 2), c[2]))));
    square[k] = c[2];
    e = pl_alg_normal(d->tower, pl_sub(p, c[0], pl_mul(p, c[2], pl_square(p, out->centre[k]))));
  }
  for (int k = 0; k < n; k++) {
    pl_expr outer, rest;
    int sign = 0;
    pl_take_squares_out(d, pl_alg_normal(d->tower, pl_neg(p, pl_div(p, e, square[k]))), &outer,
                        &rest);
    if (pl_has_coordinates(d, rest) || pl_is_zero_node(p, rest)) return false;
    if (pl_alg_sign(d->tower, rest, true, &sign) == PL_YES && sign < 0) return false;
    out->axis[k] = pl_alg_normal(d->tower, pl_mul(p, outer, pl_sqrt(p, rest)));
  }
  return true;
}

// Both are components of the position of one mass.
static bool of_one_particle(pl_analysis* d, int i, int j) {
  for (int k = 0; k < d->particle.n; k++) {
    const pl_particle* m = &d->particle.at[k];
    bool has_i = false, has_j = false;
    for (int c = 0; c < m->n; c++) {
      has_i |= pl_has_symbol(d->pool, m->at[c], d->q.at[i].q);
      has_j |= pl_has_symbol(d->pool, m->at[c], d->q.at[j].q);
    }
    if (has_i && has_j) return true;
  }
  return false;
}

// The axis along which a coordinate moves a mass; behind all axes where it moves none.
static int axis_along(pl_analysis* d, int i) {
  for (int c = 0; c < 3; c++) {
    for (int k = 0; k < d->particle.n; k++) {
      const pl_particle* m = &d->particle.at[k];
      if (c < m->n && pl_has_symbol(d->pool, m->at[c], d->q.at[i].q)) return c;
    }
  }
  return 3;
}

// In the order of the axes, whatever the order of declaration.
static void sort_by_axis(pl_analysis* d, int* coordinate, int n) {
  for (int k = 1; k < n; k++) {
    for (int j = k; j > 0 && axis_along(d, coordinate[j - 1]) > axis_along(d, coordinate[j]); j--) {
      int other = coordinate[j];
      coordinate[j] = coordinate[j - 1];
      coordinate[j - 1] = other;
    }
  }
}

// The coordinates of e that no sum of squares before it has taken.
static int free_in(pl_analysis* d, pl_expr e, const bool* taken, int* out, int max) {
  int n = 0;
  for (int i = 0; i < d->q.n; i++) {
    const pl_variable* c = &d->q.at[i];
    if (!c->carries || c->fixed_by >= 0 || taken[i] || !pl_has_symbol(d->pool, e, c->q)) continue;
    if (n < max) out[n] = i;
    n++;
  }
  sort_by_axis(d, out, n < max ? n : max);
  return n;
}

// Of several pairs that make a circle the one that belongs to one mass, else the last.
static bool round_among(pl_analysis* d, pl_expr e, const int* open, int n, pl_round* out) {
  bool found = false, whole = false;
  for (int a = 0; a < n; a++) {
    for (int b = a + 1; b < n; b++) {
      pl_round r;
      bool one = of_one_particle(d, open[a], open[b]);
      if ((whole && !one) || !round_in(d, e, (int[]){open[a], open[b]}, 2, &r)) continue;
      found = true;
      whole = one;
      *out = r;
    }
  }
  return found;
}

static bool round_of_factor(pl_analysis* d, pl_expr e, const bool* taken, int freedoms,
                            pl_round* out) {
  enum { most_open = 8 };
  int open[most_open];
  int n = free_in(d, e, taken, open, most_open);
  if (n < 2 || n > most_open) return false;
  if (n == 3 && freedoms >= 2 && round_in(d, e, open, 3, out)) return true;
  return round_among(d, e, open, n, out);
}

// (x^2 + y^2)^2 = l^4 has one factor that is a circle, and one that never vanishes.
static bool round_of(pl_analysis* d, int bond, const bool* taken, int freedoms, pl_round* out) {
  enum { most_factors = 8 };
  pl_factor f[most_factors];
  pl_expr unit, e = pl_alg_normal(d->tower, pl_on_contact(d, d->g.at[bond].place));
  int n = pl_alg_factors(d->tower, e, f, most_factors, &unit), found = 0;
  for (int k = 0; k < n; k++) {
    if (f[k].power > 0 && pl_has_coordinates(d, f[k].base))
      found += round_of_factor(d, f[k].base, taken, freedoms, out);
  }
  out->bond = bond;
  return found == 1;
}

// ------------------------------------------------------------------------------- what can be tried
static bool at_work(const pl_bond* l) { return l->fixes < 0 && !l->implied; }

// A body in space whose axes are coordinates keeps them.
static bool has_axes(const pl_analysis* d) {
  for (int k = 0; k < d->g.n; k++) {
    if (d->g.at[k].source->body) return true;
  }
  return false;
}

static int freedoms(const pl_analysis* d) {
  int n = 0;
  for (int i = 0; i < d->q.n; i++) n += d->q.at[i].carries && d->q.at[i].fixed_by < 0;
  for (int k = 0; k < d->g.n; k++) n -= at_work(&d->g.at[k]);
  return n;
}

// Sums of squares one after the other, from one constraint on, as many as there are freedoms.
static void collect_rounds(pl_analysis* d, int first, int n_freedoms, pl_proposal_trial* out) {
  bool* taken = PL_ARRAY(d->arena, bool, d->q.n + 1);
  bool* used = PL_ARRAY(d->arena, bool, d->g.n + 1);
  int n_angles = 0;
  for (bool found = true; found;) {
    found = false;
    for (int k = 0; k < d->g.n && !found; k++) {
      int bond = (first + k) % d->g.n;
      pl_round* r = &out->round[out->n_rounds];
      if (used[bond] || !at_work(&d->g.at[bond]) || n_angles >= n_freedoms
          || out->n_rounds == most_angles)
        continue;
      if (!round_of(d, bond, taken, n_freedoms - n_angles, r)) continue;
      found = used[bond] = true;
      for (int j = 0; j < r->n; j++) taken[r->coordinate[j]] = true;
      n_angles += r->n - 1;
      out->n_rounds++;
    }
  }
}

// Angles before lengths, what has a start before what has none, in the order of declaration.
static int preference(pl_analysis* d, int i) {
  int rank = 0;
  for (int k = 0; k < d->g.n; k++) {
    if (pl_is_turned(d, d->g.at[k].g, d->q.at[i].q)) rank |= 2;
  }
  for (int k = 0; k < d->model->inits.n; k++) {
    const pl_init* init = &d->model->inits.at[k];
    bool own = pl_same(init->target, pl_sym(d->pool, d->q.at[i].q))
               || pl_same(init->target, pl_sym(d->pool, d->q.at[i].v));
    if (own && !init->guess) rank |= 1;
  }
  return rank;
}

static int by_preference(pl_analysis* d, int* out, bool angles) {
  int n = 0;
  for (int rank = 3; rank >= (angles ? 2 : 0); rank--) {
    for (int i = 0; i < d->q.n; i++) {
      if (d->q.at[i].carries && d->q.at[i].fixed_by < 0 && preference(d, i) == rank) out[n++] = i;
    }
  }
  return n;
}

// ------------------------------------------------------------------------------------------- names
// The letters of angles, in the order in which they are given; polar angles have their own.
static const char* const letter[][2] = {{"φ", "phi"},   {"ψ", "psi"},  {"χ", "chi"},
                                        {"α", "alpha"}, {"β", "beta"}, {"γ", "gamma"}};
static const char* const polar[][2] = {{"ϑ", "theta"}, {"α", "alpha"}, {"β", "beta"},
                                       {"γ", "gamma"}, {"δ", "delta"}, {"η", "eta"}};
// from `several` circles on: φ1, φ2, φ3
enum { n_letters = sizeof letter / sizeof *letter, several = 3 };

static pl_symbol make_angle(pl_analysis* d, const char* name, const char* ascii) {
  pl_symbol_info info = {.name = name,
                         .ascii = ascii,
                         .role = PL_R_COORD,
                         .class = PL_C_COORD,
                         .dimension = pl_dimension_one(),
                         .dimension_known = d->model->uses_units};
  return pl_symbol_make(d->pool, &info);
}

// Names are made once for all trials; one that the model uses is passed over.
static pl_symbol angle_name(pl_analysis* d, pl_proposal* p, bool is_polar, bool numbered) {
  pl_angle_names* kept = is_polar ? &p->polar : numbered ? &p->numbered : &p->plain;
  if (kept->next < kept->n) return kept->at[kept->next++];
  pl_symbol made = {0};
  for (int k = kept->n; k < most_angles && numbered && !is_polar && !made.id; k++) {
    const char* ascii = pl_format(d->arena, "phi%d", k + 1);
    if (!pl_symbol_find(d->pool, ascii).id)
      made = make_angle(d, pl_format(d->arena, "φ%d", k + 1), ascii);
  }
  const char* const(*list)[2] = is_polar ? polar : letter;
  for (int k = 0; k < n_letters && !made.id; k++) {
    if (!pl_symbol_find(d->pool, list[k][1]).id) made = make_angle(d, list[k][0], list[k][1]);
  }
  if (made.id) kept->at[kept->n++] = made;
  kept->next = kept->n;
  return made;
}

// --------------------------------------------------------------------------- the copy of the model
static pl_expr call(pl_analysis* d, pl_function f, pl_symbol q) {
  return pl_call(d->pool, f, pl_sym(d->pool, q));
}

static void add_map(pl_analysis* d, pl_model* m, const pl_round* r, int k, pl_expr direction) {
  pl_expr map = pl_add(d->pool, r->centre[k], pl_mul(d->pool, r->axis[k], direction));
  m->choose.maps[m->choose.n_maps].old = pl_sym(d->pool, d->q.at[r->coordinate[k]].q);
  m->choose.maps[m->choose.n_maps++].map = map;
}

static pl_expr along_axis(pl_analysis* d, const pl_round* r, int k) {
  return pl_div(d->pool,
                pl_sub(d->pool, pl_sym(d->pool, d->q.at[r->coordinate[k]].q), r->centre[k]),
                r->axis[k]);
}

// The angle of the pair a, b of coordinates: its inverse is known where the radius is.
static pl_expr turn(pl_analysis* d, const pl_round* r, int a, int b) {
  bool circle = pl_alg_equal(d->tower, r->axis[a], r->axis[b]) == PL_YES
                && !pl_has_coordinates(d, r->axis[a]);
  pl_expr x = along_axis(d, r, a), y = along_axis(d, r, b);
  if (circle) x = pl_alg_normal(d->tower, pl_mul(d->pool, x, r->axis[a]));
  if (circle) y = pl_alg_normal(d->tower, pl_mul(d->pool, y, r->axis[b]));
  return pl_call2(d->pool, PL_ATAN2, y, x);
}

// What `init` says of s, as formulas speak of it: 0, a formula of given quantities, or the name
// s(0); poison if it says nothing.
static pl_expr said_of(pl_analysis* d, pl_symbol s) {
  for (int k = 0; k < d->model->inits.n; k++) {
    const pl_init* init = &d->model->inits.at[k];
    if (init->guess || !pl_same(init->target, pl_sym(d->pool, s))) continue;
    bool formula = pl_is_zero_node(d->pool, init->value) || !pl_is_constant(d->pool, init->value);
    return formula ? init->value : pl_sym(d->pool, pl_symbol_start(d->pool, s));
  }
  return pl_poison();
}

// e at the start, when all of it is given there.
static pl_expr said_at_start(pl_analysis* d, pl_expr e) {
  for (int i = 0; i < d->q.n && !pl_is_poison(e); i++) {
    const pl_variable* c = &d->q.at[i];
    if (pl_has_symbol(d->pool, e, c->v)) e = pl_subst1(d->pool, e, c->v, said_of(d, c->v));
    if (pl_has_symbol(d->pool, e, c->q)) e = pl_subst1(d->pool, e, c->q, said_of(d, c->q));
  }
  return pl_is_poison(e) || pl_has_coordinates(d, e) ? pl_poison() : pl_alg_normal(d->tower, e);
}

static void start_angle(pl_analysis* d, pl_model* m, pl_symbol q, pl_expr inverse) {
  pl_expr place = said_at_start(d, inverse), velocity = said_at_start(d, pl_dt(d->pool, inverse));
  if (pl_is_poison(place)) return;
  pl_push(d->arena, m->inits,
          (pl_init){.time = pl_poison(), .target = pl_sym(d->pool, q), .value = place});
  if (pl_is_poison(velocity)) return;
  pl_push(d->arena, m->inits,
          (pl_init){.time = pl_poison(),
                    .target = pl_sym(d->pool, pl_symbol_dot(d->pool, q)),
                    .value = velocity});
}

// at_start: its value over the coordinates of the model, where this tells the start; poison: it
// does not.
static bool add_angle(pl_analysis* d, pl_proposal* p, pl_model* m, pl_symbol q, pl_expr inverse,
                      pl_expr at_start) {
  if (!q.id) return false;
  start_angle(d, m, q, at_start);
  pl_push(d->arena, m->coords, (pl_coord){.symbol = q, .lo = pl_poison(), .hi = pl_poison()});
  pl_push(d->arena, p->tried, (pl_definition){q, inverse});
  return true;
}

static bool add_circle(pl_analysis* d, pl_proposal* p, pl_model* m, const pl_round* r,
                       bool numbered) {
  pl_symbol q = angle_name(d, p, false, numbered);
  pl_expr angle = turn(d, r, 0, 1);
  if (!add_angle(d, p, m, q, angle, angle)) return false;
  add_map(d, m, r, 0, call(d, PL_COS, q));
  add_map(d, m, r, 1, call(d, PL_SIN, q));
  return true;
}

// The axis of the sphere is the coordinate in which there is a potential, so that the other angle
// is cyclic; else the last one. Or
// across it: the first one without.
static int axis_of(pl_analysis* d, const pl_round* r, bool across) {
  int found = 2;
  for (int k = 2; k >= 0; k--) {
    bool pushed = !pl_is_zero_node(d->pool, pl_diff(d->pool, d->V, d->q.at[r->coordinate[k]].q));
    if (pushed != across) found = k;
  }
  return found;
}

// The polar angle counts from the axis towards the azimuth, ϑ = atan2(u cos φ + v sin φ, w): where
// the azimuth is given by a
// constraint, both signs occur.
static bool add_sphere(pl_analysis* d, pl_proposal* p, pl_model* m, const pl_round* r,
                       bool numbered, bool given) {
  pl_pool* pool = d->pool;
  int axis = axis_of(d, r, p->across), a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
  pl_symbol theta = angle_name(d, p, true, false), phi = angle_name(d, p, false, numbered);
  if (!theta.id || !phi.id) return false;
  pl_expr w = along_axis(d, r, axis), azimuth = turn(d, r, a, b);
  pl_expr u = pl_mul(pool, along_axis(d, r, a), call(d, PL_COS, phi)),
          v = pl_mul(pool, along_axis(d, r, b), call(d, PL_SIN, phi));
  add_angle(d, p, m, theta, pl_call2(pool, PL_ATAN2, pl_add(pool, u, v), w),
            given ? pl_poison() : pl_call(pool, PL_ACOS, w));
  add_angle(d, p, m, phi, azimuth, given ? pl_poison() : azimuth);
  add_map(d, m, r, a, pl_mul(pool, call(d, PL_SIN, theta), call(d, PL_COS, phi)));
  add_map(d, m, r, b, pl_mul(pool, call(d, PL_SIN, theta), call(d, PL_SIN, phi)));
  add_map(d, m, r, axis, call(d, PL_COS, theta));
  return true;
}

// The lists that grow are copied.
static pl_model* copy_of(pl_analysis* d) {
  pl_model* m = PL_NEW(d->arena, pl_model);
  *m = *d->model;
  m->coords.at = NULL;
  m->coords.n = m->coords.cap = 0;
  for (int k = 0; k < d->model->coords.n; k++) pl_push(d->arena, m->coords, d->model->coords.at[k]);
  m->inits.at = NULL;
  m->inits.n = m->inits.cap = 0;
  for (int k = 0; k < d->model->inits.n; k++) pl_push(d->arena, m->inits, d->model->inits.at[k]);
  m->choose = (pl_choose){.maps = PL_ARRAY(d->arena, struct pl_map_equation, 3 * most_angles)};
  return m;
}

static pl_model* chosen_model(pl_analysis* d, pl_proposal* p, const pl_proposal_trial* t) {
  pl_model* m = copy_of(d);
  int n_circles = 0;
  for (int k = 0; k < t->n_rounds; k++) n_circles += t->round[k].n == 2;
  p->tried.n = p->plain.next = p->numbered.next = p->polar.next = 0;
  for (int k = 0; k < t->n_rounds; k++) {
    const pl_round* r = &t->round[k];
    bool numbered = n_circles >= several;
    if (!(r->n == 3 ? add_sphere(d, p, m, r, numbered, t->n_leaders > 0)
                    : add_circle(d, p, m, r, numbered)))
      return NULL;
  }
  for (int k = 0; k < p->tried.n; k++) {
    bool leads = t->n_leaders == 0 || (k >= t->leader && k < t->leader + t->n_leaders);
    if (leads) pl_push(d->arena, m->choose.coords, p->tried.at[k].symbol);
  }
  for (int k = 0; k < t->n_chosen; k++)
    pl_push(d->arena, m->choose.coords, d->q.at[t->chosen[k]].q);
  return m;
}

// ---------------------------------------------------------------------------------- how good it is
static const int n_samples = 60;

// The maps have a value wherever the generalized coordinates are, as the crank goes round; a rod
// between them only swings.
static bool covers_all(pl_analysis* a) {
  double* x = PL_ARRAY(a->arena, double, pl_symbol_count(a->pool) + 1);
  pl_random r = {2718};
  for (int s = 0; s < n_samples; s++) {
    pl_draw_place(a, &r, x);
    for (int i = 0; i < a->q.n; i++) {
      const pl_variable* c = &a->q.at[i];
      if (!pl_is_poison(c->map) && pl_follower(a, i) < 0 && !pl_has_followers(a, c->map)
          && isnan(pl_eval(a->pool, c->map, x)))
        return false;
    }
  }
  for (int k = 0; k < a->loops.n; k++) {
    if (!pl_is_poison(a->loops.at[k].real)) return false;
  }
  return true;
}

// ------------------------------------------------------------------------------------------ trying
static void keep(pl_analysis* d, pl_proposal* p, pl_analysis* a, int flaws) {
  p->analysis = a;
  p->flaws = flaws;
  p->angles.at = NULL;
  p->angles.n = p->angles.cap = 0;
  for (int k = 0; k < p->tried.n; k++) pl_push(d->arena, p->angles, p->tried.at[k]);
}

// The equations of the copy. True when all constraints are solved without a flaw: for every place,
// and in one way. Else the best
// trial so far is kept.
static bool solves(pl_analysis* d, pl_proposal* p, const pl_proposal_trial* t, int n_freedoms) {
  if (++p->n_trials > most_trials) return false;
  pl_model* m = chosen_model(d, p, t);
  if (!m) return false;
  pl_analysis* a = PL_NEW(d->arena, pl_analysis);
  *a = (pl_analysis){.job = d->job,
                     .arena = d->arena,
                     .pool = d->pool,
                     .model = m,
                     .towers = d->towers,
                     .effort_s = d->effort_s,
                     .proposal = p,
                     .is_proposal = true};
  a->whole = d->whole;
  a->stage = d->stage;
  a->open = d->open;
  a->unnamed = d->unnamed;
  a->cases = d->cases;
  pl_setup_facts(a);
  if (pl_form_equations(a) != PLEUEL_OK || !a->reduced) return false;
  if (a->gen.n + a->hidden.n != n_freedoms) return false;
  int flaws = (covers_all(a) ? 0 : 2) + (a->loops.n > 0 ? 1 : 0);
  if (!p->analysis || flaws < p->flaws) {
    keep(d, p, a, flaws);
    p->on_sphere = false;
    for (int k = 0; k < t->n_rounds; k++) p->on_sphere |= t->n_leaders == 0 && t->round[k].n == 3;
  }
  return flaws == 0;
}

// More sums of squares than freedoms: some of the angles lead, the others follow by the constraints
// that are left.
static bool try_followers(pl_analysis* d, pl_proposal* p, int n_freedoms) {
  pl_proposal_trial t = {.n_rounds = 0};
  collect_rounds(d, 0, most_angles, &t);
  int n_angles = 0;
  for (int k = 0; k < t.n_rounds; k++) n_angles += t.round[k].n - 1;
  t.n_leaders = n_freedoms;
  for (t.leader = 0; n_freedoms > 0 && t.leader + n_freedoms <= n_angles && n_angles > n_freedoms;
       t.leader++) {
    if (solves(d, p, &t, n_freedoms)) return true;
  }
  return false;
}

static bool try_rounds(pl_analysis* d, pl_proposal* p, int n_freedoms) {
  int before = -1;
  for (int first = 0; first < d->g.n; first++) {
    pl_proposal_trial t = {.n_rounds = 0};
    collect_rounds(d, first, n_freedoms, &t);
    if (t.n_rounds == 0 || t.round[0].bond == before) continue;
    before = t.round[0].bond;
    if (solves(d, p, &t, n_freedoms)) return true;
  }
  return false;
}

// Coordinates that are there lead, as many as there are freedoms: angles alone, or any.
static bool try_coordinates(pl_analysis* d, pl_proposal* p, int n_freedoms, bool angles) {
  int* order = PL_ARRAY(d->arena, int, d->q.n + 1);
  int n = by_preference(d, order, angles);
  if (n_freedoms > most_angles) return false;
  for (int first = 0; first + n_freedoms <= n; first++) {
    pl_proposal_trial t = {.n_chosen = n_freedoms};
    for (int k = 0; k < n_freedoms; k++) t.chosen[k] = order[first + k];
    if (solves(d, p, &t, n_freedoms)) return true;
    if (n_freedoms == 0) return false;
  }
  return false;
}

bool pl_follows_by_constraint(const pl_analysis* a, pl_symbol q) {
  if (!a->is_proposal) return false;
  for (int k = 0; k < a->model->choose.coords.n; k++) {
    if (a->model->choose.coords.at[k].id == q.id) return false;
  }
  for (int k = 0; k < a->proposal->tried.n; k++) {
    if (a->proposal->tried.at[k].symbol.id == q.id) return true;
  }
  return false;
}

static pl_analysis* find_proposal(pl_analysis* d, pl_proposal* p) {
  if (d->reduced || d->model->choose.coords.n > 0 || d->g.n == 0 || pl_nonholonomic(d)
      || has_axes(d))
    return NULL;
  int n = freedoms(d);
  if (n < 0 || d->model->frictions.n > 0) return NULL;
  bool found = try_coordinates(d, p, n, true) || try_rounds(d, p, n) || try_followers(d, p, n);
  if (!found) try_coordinates(d, p, n, false);
  pl_analysis* a = p->analysis;
  if (!a) return NULL;
  if (pl_solve_motion(a) != PLEUEL_OK) return p->analysis = NULL;
  pl_inherit_dependences(a, d);
  return a;
}

pl_analysis* pl_propose(pl_analysis* d) {
  if (d->is_proposal) return d;
  if (d->proposal) return d->proposal->analysis;
  d->proposal = PL_NEW(d->arena, pl_proposal);
  return find_proposal(d, d->proposal);
}

// The angles of a sphere fail on its axis, which the first proposal lays along the force: where
// things rest, the axis lies across it.
pl_analysis* pl_propose_for_rest(pl_analysis* d) {
  pl_analysis* a = pl_propose(d);
  if (!a || !d->proposal || !d->proposal->on_sphere) return a;
  if (d->proposal_for_rest)
    return d->proposal_for_rest->analysis ? d->proposal_for_rest->analysis : a;
  d->proposal_for_rest = PL_NEW(d->arena, pl_proposal);
  d->proposal_for_rest->across = true;
  pl_analysis* b = find_proposal(d, d->proposal_for_rest);
  return b ? b : a;
}

// An angle that a constraint gives has the value of that constraint.
pl_expr pl_proposed_value(pl_analysis* a, const pl_definition* angle) {
  int i = pl_variable_index(a, angle->symbol);
  bool given = a->q.at[i].follows && !pl_is_poison(a->q.at[i].map) && pl_follower(a, i) < 0;
  return given ? a->q.at[i].map : angle->value;
}
