// places: what is said of the coordinates of a model, in its generalized coordinates.
//
// A start `from x = 0 and z = R at rest` names coordinates that are functions of φ: x = R cos φ, z
// = R sin φ. Each equation
// X(φ) = value is solved for one φ; of its roots those count that the other values and the branches
// allow, and of these the nearest to
// the start of `init`.  Velocities follow from X' = dX/dφ φ' + ..., which is linear.
#include <math.h>
#include <string.h>

#include "mechanics/mechanics.h"

enum { max_given = 32, max_roots = 8 };
// of two numbers that ought to be equal, relative to their size
static const double near_enough = 1e-6;

typedef struct pl_places {
  int n;
  pl_symbol name[max_given];
  pl_expr value[max_given];
  bool at_zero;  // at t = 0
} pl_places;

static int place_of(const pl_places* p, pl_symbol s) {
  for (int k = 0; k < p->n; k++) {
    if (p->name[k].id == s.id) return k;
  }
  return -1;
}

static void put(pl_places* p, pl_symbol s, pl_expr value) {
  if (p->n == max_given || place_of(p, s) >= 0) return;
  p->name[p->n] = s;
  p->value[p->n++] = value;
}

// name = value, the name a coordinate or a velocity.
static bool place_in(pl_analysis* d, const pl_condition* c, pl_symbol* name, pl_expr* value) {
  for (int side = 0; side < 2; side++) {
    pl_expr left = side ? c->right : c->left, right = side ? c->left : c->right;
    if (pl_kind_of(d->pool, left) != PL_SYMBOL || pl_has_coordinates(d, right)) continue;
    *name = pl_symbol_of(d->pool, left);
    *value = right;
    int i = pl_variable_index(d, *name);
    if (i >= 0 && d->q.at[i].a.id != name->id) return true;
  }
  return false;
}

static pl_expr with_places(pl_analysis* d, const pl_places* p, pl_expr e) {
  for (int k = 0; k < p->n; k++) e = pl_subst1(d->pool, e, p->name[k], p->value[k]);
  return p->at_zero ? pl_subst1(d->pool, e, pl_time(d->pool), pl_int(d->pool, 0)) : e;
}

// Coordinates of the model that are functions of generalized ones alone.
static bool is_mapped(pl_analysis* d, int i) {
  const pl_variable* c = &d->q.at[i];
  return c->fixed_by < 0 && !pl_is_poison(c->map) && pl_follower(d, i) < 0
         && !pl_has_followers(d, c->map);
}

// The generalized coordinate that is left in e when the known ones are in; -1: none or several.
static int only_unknown(pl_analysis* d, pl_expr e) {
  int found = -1;
  for (int k = 0; k < d->gen.n; k++) {
    if (!pl_has_symbol(d->pool, e, d->q.at[d->gen.at[k]].q)) continue;
    if (found >= 0) return -1;
    found = d->gen.at[k];
  }
  return found;
}

// -------------------------------------------------------------------------------- of several roots
static pl_answer3 vanishes(pl_analysis* d, pl_expr e) {
  double x = pl_number(d, e);
  if (isnan(x)) return pl_has_coordinates(d, e) ? PL_UNKNOWN : pl_alg_is_zero(d->tower, e);
  return fabs(x) <= near_enough * (1 + fabs(x)) ? PL_YES : PL_NO;
}

// Does φ = value agree with everything else that is said?
static bool agrees(pl_analysis* d, const pl_places* given, const pl_places* known, int gen,
                   pl_expr value) {
  pl_places all = *known;
  put(&all, d->q.at[gen].q, value);
  for (int i = 0; i < d->q.n; i++) {
    int k = place_of(given, d->q.at[i].q);
    if (k < 0 || !is_mapped(d, i)) continue;
    if (vanishes(d, pl_sub(d->pool, with_places(d, &all, d->q.at[i].map), given->value[k]))
        == PL_NO)
      return false;
  }
  for (int k = 0; k < d->model->branches.n; k++) {
    const pl_condition* c = &d->model->branches.at[k];
    double x = pl_number(d,
                         with_places(d, &all, pl_on_maps(d, pl_sub(d->pool, c->left, c->right))));
    bool positive = c->relation == PL_GT || c->relation == PL_GE;
    if (!isnan(x) && fabs(x) > near_enough && (x > 0) != positive) return false;
  }
  return true;
}

// The nearest to the start of `init`, modulo 2π where angles are meant; without one there must not
// be several.
static int nearest(pl_analysis* d, int gen, const pl_expr* value, int n) {
  double start = pl_number(d, pl_sym(d->pool, pl_symbol_start(d->pool, d->q.at[gen].q))),
         least = (double)INFINITY;
  int best = n == 1 ? 0 : -1;
  for (int k = 0; k < n && !isnan(start); k++) {
    double apart = fabs(pl_number(d, value[k]) - start);
    if (isnan(apart) || apart >= least) continue;
    least = apart;
    best = k;
  }
  return best;
}

static bool solve_place(pl_analysis* d, const pl_places* given, pl_places* known, int i,
                        pl_expr wanted) {
  pl_expr e = with_places(d, known, pl_sub(d->pool, d->q.at[i].map, wanted)), fits[max_roots];
  int gen = only_unknown(d, e), n = 0;
  if (gen < 0 || place_of(known, d->q.at[gen].q) >= 0) return false;
  pl_root root[max_roots];
  bool complete;
  int n_roots = pl_alg_roots(d->tower, e, d->q.at[gen].q, root, max_roots, &complete);
  for (int r = 0; r < n_roots; r++) {
    if (agrees(d, given, known, gen, root[r].value)) fits[n++] = root[r].value;
  }
  int best = nearest(d, gen, fits, n);
  if (best < 0) return false;
  put(known, d->q.at[gen].q, fits[best]);
  return true;
}

// -------------------------------------------------------------------------------------- velocities
static int only_velocity(pl_analysis* d, pl_expr e) {
  int found = -1;
  for (int k = 0; k < d->gen.n; k++) {
    if (!pl_has_symbol(d->pool, e, d->q.at[d->gen.at[k]].v)) continue;
    if (found >= 0) return -1;
    found = d->gen.at[k];
  }
  return found;
}

// Where nothing is said of a coordinate it is where `init` has it.
static pl_expr at_start(pl_analysis* d, const pl_places* known, pl_expr e) {
  e = with_places(d, known, e);
  for (int k = 0; k < d->gen.n; k++) {
    const pl_variable* c = &d->q.at[d->gen.at[k]];
    if (pl_has_symbol(d->pool, e, c->q)) e = pl_subst1(d->pool, e, c->q, pl_start_value(d, c->q));
  }
  return e;
}

static bool solve_velocity(pl_analysis* d, pl_places* known, int i, pl_expr wanted) {
  pl_expr e = at_start(d, known, pl_sub(d->pool, pl_dt(d->pool, d->q.at[i].map), wanted)), c[2];
  int gen = only_velocity(d, e);
  if (gen < 0 || place_of(known, d->q.at[gen].v) >= 0) return false;
  if (pl_alg_coefficients(d->tower, e, d->q.at[gen].v, c, 1) != 1 || vanishes(d, c[1]) == PL_YES)
    return false;
  put(known, d->q.at[gen].v, pl_alg_normal(d->tower, pl_neg(d->pool, pl_div(d->pool, c[0], c[1]))));
  return true;
}

// --------------------------------------------------------------------------------------- the whole
// From what is given to generalized coordinates, as far as it determines them.
static void solve_places(pl_analysis* d, const pl_places* given, pl_places* known) {
  for (int k = 0; k < given->n; k++) {
    int i = pl_variable_index(d, given->name[k]);
    if (i >= 0 && pl_is_poison(d->q.at[i].map) && d->q.at[i].fixed_by < 0)
      put(known, given->name[k], given->value[k]);
  }
  for (bool more = true; more;) {
    more = false;
    for (int k = 0; k < given->n; k++) {
      int i = pl_variable_index(d, given->name[k]);
      if (i >= 0 && d->q.at[i].q.id == given->name[k].id && is_mapped(d, i))
        more |= solve_place(d, given, known, i, given->value[k]);
    }
  }
  for (bool more = true; more;) {
    more = false;
    for (int k = 0; k < given->n; k++) {
      int i = pl_variable_index(d, given->name[k]);
      if (i >= 0 && d->q.at[i].v.id == given->name[k].id && is_mapped(d, i))
        more |= solve_velocity(d, known, i, given->value[k]);
    }
  }
}

static bool speaks_of_mapped(pl_analysis* d, const pl_places* p) {
  for (int k = 0; k < p->n; k++) {
    int i = pl_variable_index(d, p->name[k]);
    if (i >= 0 && is_mapped(d, i)) return true;
  }
  return false;
}

int pl_in_generalized(pl_analysis* d, const pl_condition* c, int n, pl_condition** out) {
  pl_places given = {.at_zero = true}, known = {.at_zero = true};
  pl_condition* all = PL_ARRAY(d->arena, pl_condition, n + max_given);
  int n_all = 0;
  for (int k = 0; k < n; k++) {
    pl_symbol name;
    pl_expr value;
    if (place_in(d, &c[k], &name, &value)) put(&given, name, value);
    else all[n_all++] = c[k];
  }
  if (!d->reduced || !speaks_of_mapped(d, &given)) return -1;
  solve_places(d, &given, &known);
  for (int k = 0; k < known.n; k++) {
    all[n_all++] = (pl_condition){.left = pl_sym(d->pool, known.name[k]),
                                  .right = known.value[k],
                                  .relation = PL_EQ,
                                  .span = c[0].span};
  }
  *out = all;
  return n_all;
}

// The start of `init` in generalized coordinates, where it is given in others: it joins the start
// values of the model.
void pl_start_in_generalized(pl_analysis* d) {
  pl_places given = {.at_zero = true}, known = {.at_zero = true};
  for (int k = 0; k < d->model->inits.n; k++) {
    const pl_init* init = &d->model->inits.at[k];
    pl_condition c = {.left = init->target, .right = init->value, .relation = PL_EQ};
    pl_symbol name;
    pl_expr value;
    if (init->guess || !place_in(d, &c, &name, &value)) continue;
    // formulas speak of x(0), not of 0.3
    bool number = pl_is_constant(d->pool, value) && !pl_is_zero_node(d->pool, value);
    put(&given, name, number ? pl_sym(d->pool, pl_symbol_start(d->pool, name)) : value);
  }
  if (!d->reduced || !speaks_of_mapped(d, &given)) return;
  solve_places(d, &given, &known);
  pl_model* m = PL_NEW(d->arena, pl_model);
  *m = *d->model;
  m->inits.at = NULL;
  m->inits.n = m->inits.cap = 0;
  for (int k = 0; k < d->model->inits.n; k++) pl_push(d->arena, m->inits, d->model->inits.at[k]);
  for (int k = 0; k < known.n; k++) {
    if (place_of(&given, known.name[k]) >= 0) continue;
    pl_init init = {
        .time = pl_poison(), .target = pl_sym(d->pool, known.name[k]), .value = known.value[k]};
    pl_push(d->arena, m->inits, init);
  }
  d->model = m;
  d->n_value = -1;  // numbers are found anew
}
