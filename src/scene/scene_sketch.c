// A start to draw when nothing was simulated: the given start values, and where none is given
// values that show the system as one would sketch it (angles neither 0 nor a right angle, lengths
// of the size of the given ones), moved onto the constraints by Gauss-Newton steps of smallest
// change.
#include "scene/scene_impl.h"

#include <math.h>
#include <string.h>

enum { MOST_UNKNOWNS = 400, ITERATIONS = 60, TRIES = 40 };

static bool is_length(const pl_stage* s, pl_symbol x) {
  const pl_symbol_info* i = pl_symbol_get(s->pool, x);
  return i->dimension_known && pl_dimension_equal(i->dimension, pl_dimension_of(1, 0, 0));
}

// The geometric mean of the given lengths, 1 if there are none.
double pl_stage_length(const pl_stage* s) {
  double sum = 0;
  int n = 0;
  for (int i = 0; i < s->model->params.n; i++) {
    pl_symbol p = s->model->params.at[i].symbol;
    double x = fabs(s->value[p.id]);
    if (!is_length(s, p) || !(x > 0)) continue;
    sum += log(x);
    n++;
  }
  return n ? exp(sum / n) : 1;
}

// Numbers for parameters that have none: the picture shows the kind of system, not its size.
static void invent_parameters(pl_stage* s) {
  static const double some[] = {1, 0.8, 0.6, 0.7, 0.9};
  for (int i = 0, k = 0; i < s->model->params.n; i++) {
    pl_symbol p = s->model->params.at[i].symbol;
    if (isnan(s->value[p.id])) s->value[p.id] = some[k++ % 5];
  }
  for (int round = 0; round < 4; round++) {
    for (int i = 0; i < s->model->lets.n; i++) {
      const pl_let* l = &s->model->lets.at[i];
      if (l->n_args == 0 && !l->inserted && isnan(s->value[l->symbol.id]))
        s->value[l->symbol.id] = pl_eval(s->pool, l->value, s->value);
    }
  }
}

static void guess(pl_stage* s, int try, double length, const bool* held) {
  static const double angles[] = {0.6, 0.35, 0.95, 0.75};
  static const double lengths[] = {0.8, 0.65, 1.0, 0.5, 0.9, 0.7};
  for (int k = 0; k < s->n_q; k++) {
    if (held[k]) continue;
    double noise = try ? pl_random_between(&s->random, -1.5, 1.5) : 0;
    s->value[s->q[k].id] = s->angle[k] ? angles[k % 4] + noise : length * (lengths[k % 6] + noise);
    s->value[s->v[k].id] = 0;
  }
}

// Start values of the file, in rounds because one may need another.
static void take_inits(pl_stage* s, bool* held) {
  for (int round = 0; round < 4; round++) {
    for (int i = 0; i < s->model->inits.n; i++) {
      const pl_init* init = &s->model->inits.at[i];
      if (pl_kind_of(s->pool, init->target) != PL_SYMBOL) continue;
      pl_symbol x = pl_symbol_of(s->pool, init->target);
      double value = pl_eval(s->pool, init->value, s->value);
      if (!isfinite(value)) continue;
      s->value[x.id] = value;
      uint64_t k = pl_map_get(s->q_at, x.id);
      if (k) held[k - 1] = true;
    }
  }
}

typedef struct pl_conditions {
  int n, m;  // unknowns, equations
  int* q;    // unknown coordinates
  PL_VEC(pl_expr) g;
  double *J, *r, *x;
} pl_conditions;

static void gather(pl_stage* s, pl_conditions* c, const bool* held) {
  c->q = PL_ARRAY(s->arena, int, s->n_q + 1);
  for (int k = 0; k < s->n_q; k++) {
    if (!held || !held[k]) c->q[c->n++] = k;
  }
  for (int i = 0; i < s->bonds.n; i++) {
    if (!s->bonds.at[i].velocity && !s->bonds.at[i].c->off)
      pl_push(s->arena, c->g, s->bonds.at[i].c->g);
  }
  for (int i = 0; i < s->model->choose.n_maps; i++) {
    pl_push(s->arena, c->g,
            pl_sub(s->pool, s->model->choose.maps[i].old, s->model->choose.maps[i].map));
  }
  c->m = c->g.n;
}

// Gauss-Newton with a bounded step; numerical derivatives, since only the picture depends on them.
static bool settle(pl_stage* s, const pl_conditions* c, double length) {
  double best = INFINITY;
  for (int round = 0; round < ITERATIONS; round++) {
    double size = 0;
    for (int i = 0; i < c->m; i++) {
      c->r[i] = -pl_stage_eval(s, c->g.at[i]);
      if (!isfinite(c->r[i])) return false;
      size = fmax(size, fabs(c->r[i]));
    }
    if (size < 1e-10 * fmax(length, 1e-3)) return true;
    best = fmin(best, size);
    for (int k = 0; k < c->n; k++) {
      double* x = &s->value[s->q[c->q[k]].id];
      double h = 1e-6 * (s->angle[c->q[k]] ? 1 : length), old = *x;
      *x = old + h;
      for (int i = 0; i < c->m; i++) c->J[i * c->n + k] = pl_stage_eval(s, c->g.at[i]);
      *x = old - h;
      for (int i = 0; i < c->m; i++)
        c->J[i * c->n + k] = (c->J[i * c->n + k] - pl_stage_eval(s, c->g.at[i])) / (2 * h);
      *x = old;
    }
    if (!pl_least(c->J, c->r, c->m, c->n, c->x)) return false;
    for (int k = 0; k < c->n; k++) {
      double most = s->angle[c->q[k]] ? 0.5 : 0.7 * length + 0.1 * fabs(s->value[s->q[c->q[k]].id]);
      s->value[s->q[c->q[k]].id] += fmax(-most, fmin(most, c->x[k]));
    }
  }
  return best < 1e-6 * fmax(length, 1e-3);
}

static bool fits_branches(const pl_stage* s) {
  for (int i = 0; i < s->model->branches.n; i++) {
    const pl_condition* b = &s->model->branches.at[i];
    double d = pl_stage_eval(s, pl_sub(s->pool, b->left, b->right));
    if ((b->relation == PL_GT || b->relation == PL_GE) && d < 0) return false;
    if ((b->relation == PL_LT || b->relation == PL_LE) && d > 0) return false;
  }
  return true;
}

// A drive (A = ω t) is at zero in the beginning, where a crank shows little: a moment later it
// stands at 0.65.
static double moment(pl_stage* s) {
  for (int i = 0; i < s->bonds.n; i++) {
    const pl_constraint* c = s->bonds.at[i].c;
    pl_symbol found[8];
    int n = pl_symbols_in(s->pool, c->g, found, 8), angles = 0;
    for (int k = 0; k < n && k < 8; k++) {
      uint64_t q = pl_map_get(s->q_at, found[k].id);
      angles += q == 0            ? pl_symbol_get(s->pool, found[k])->role == PL_R_VELOCITY ? 2 : 0
                : s->angle[q - 1] ? 1
                                  : 2;
    }
    if (angles != 1 || n > 8) continue;
    double rate = fabs(pl_stage_eval(s, pl_diff(s->pool, c->g, pl_time(s->pool))));
    if (rate > 0 && isfinite(rate)) return 0.65 / rate;
  }
  return 0;
}

void pl_stage_sketch(pl_stage* s) {
  invent_parameters(s);
  double length = pl_stage_length(s);
  double t = pl_is_poison(s->model->simulate.from)
                 ? 0
                 : pl_eval(s->pool, s->model->simulate.from, s->value);
  s->value[pl_time(s->pool).id] = 0;
  s->t[0] = isfinite(t) && s->model->simulate.given ? t : s->model->inits.n > 0 ? 0 : moment(s);
  s->value[pl_time(s->pool).id] = s->t[0];
  bool* held = PL_ARRAY(s->arena, bool, s->n_q + 1);
  for (int try = 0; try < TRIES; try++) {
    bool hold = try % 4 != 3;  // given values that do not fit are let go in the end
    memset(held, 0, (size_t)s->n_q * sizeof *held);
    guess(s, try, length, held);
    take_inits(s, held);
    if (s->n_q > MOST_UNKNOWNS) break;
    pl_conditions c = {0};
    gather(s, &c, hold ? held : NULL);
    c.J = PL_ARRAY(s->arena, double, (size_t)c.m*(size_t)c.n + 1);
    c.r = PL_ARRAY(s->arena, double, c.m + 1);
    c.x = PL_ARRAY(s->arena, double, c.n + 1);
    if (settle(s, &c, length) && (fits_branches(s) || try > TRIES - 5)) break;
  }
  double* x = s->state;
  x[0] = s->t[0];
  for (int k = 0; k < s->n_q; k++) {
    x[1 + k] = s->value[s->q[k].id];
    x[1 + s->n_q + k] = s->value[s->v[k].id];
  }
}
