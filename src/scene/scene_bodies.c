// Outlines of planar bodies. What is known is mass and inertia: m l²/12 is a rod of length l, m
// r²/2 a disc of radius r. A constraint of a body whose gradient has a fixed direction in space
// touches the body in one of its points, which is found from dg/dα; which way the angle turns is
// chosen so that different constraints touch different points.
#include <math.h>
#include <string.h>

#include "scene/scene_impl.h"

enum { SAMPLES = 4, MOST_TOUCHES = 8, MOST_NAMED = 24 };
typedef struct pl_body_outline {
  int thing;
  double half, thick, radius;
} pl_body_outline;
// p for each sense
typedef struct pl_touch {
  int bond;
  bool found;
  double n[2], p[2][2];
  bool fits[2];
} pl_touch;
typedef struct pl_floor {
  int thing;
  double p[2], normal[6];
  bool wide;
  double reach;
} pl_floor;

// ----------------------------------------------------------------------------------------- placing
static void place_body(pl_stage* s, const pl_part* part, double* xyz) {
  const pl_body_outline* o = part->data;
  const pl_thing* t = &s->things.at[o->thing];
  double c[3];
  pl_stage_spot(s, &t->spot, c);
  double a = t->sense * pl_stage_eval(s, t->body->angle);
  for (int i = 0; i < part->n; i++) {
    double u, v;
    if (o->radius > 0) {
      double b = 2 * M_PI * i / (part->n - 1);
      u = o->radius * cos(b);
      v = o->radius * sin(b);
    } else {
      static const double corner[5][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
      u = o->half * corner[i][0];
      v = o->thick * corner[i][1];
    }
    xyz[3 * i] = c[0] + u * cos(a) - v * sin(a);
    xyz[3 * i + 1] = c[1] + u * sin(a) + v * cos(a);
    xyz[3 * i + 2] = c[2];
  }
}

static void place_spoke(pl_stage* s, const pl_part* part, double* xyz) {
  const pl_body_outline* o = part->data;
  const pl_thing* t = &s->things.at[o->thing];
  pl_stage_spot(s, &t->spot, xyz);
  double a = t->sense * pl_stage_eval(s, t->body->angle);
  xyz[3] = xyz[0] + o->radius * cos(a);
  xyz[4] = xyz[1] + o->radius * sin(a);
  xyz[5] = xyz[2];
}

// The plane that a point of the body touches, as wide as the picture, or a support below it.
static void place_floor(pl_stage* s, const pl_part* part, double* xyz) {
  const pl_floor* f = part->data;
  double x[3], along[2] = {-f->normal[1], f->normal[0]}, from = -0.12 * s->size,
               to = 0.12 * s->size;
  memcpy(x, f->normal + 3, sizeof x);
  if (f->wide) {
    from = INFINITY;
    to = -INFINITY;
    for (int i = 0; i < 4; i++) {
      double u = ((i & 1 ? s->hi[0] + f->reach : s->lo[0] - f->reach) - x[0]) * along[0]
                 + ((i & 2 ? s->hi[1] + f->reach : s->lo[1] - f->reach) - x[1]) * along[1];
      from = fmin(from, u);
      to = fmax(to, u);
    }
  }
  for (int k = 0; k < 2; k++) {
    xyz[3 * k] = x[0] + along[0] * (k ? to : from);
    xyz[3 * k + 1] = x[1] + along[1] * (k ? to : from);
    xyz[3 * k + 2] = x[2];
  }
}

// ----------------------------------------------------------------------------------------- inertia
// The length in the inertia and what it is multiplied by: I = k m L².
static double length_in(pl_stage* s, const pl_body* b, double* k) {
  pl_symbol found[16];
  int n = pl_symbols_in(s->pool, b->inertia, found, 16);
  double I = pl_stage_eval(s, b->inertia), m = pl_stage_eval(s, b->mass);
  for (int i = 0; i < n && i < 16; i++) {
    const pl_symbol_info* info = pl_symbol_get(s->pool, found[i]);
    if (info->role != PL_R_PARAM || pl_has_symbol(s->pool, b->mass, found[i])) continue;
    if (info->dimension_known && s->model->uses_units
        && !pl_dimension_equal(info->dimension, pl_dimension_of(1, 0, 0)))
      continue;
    double L = s->value[found[i].id];
    // it must be squared: doubling it makes four of it
    s->value[found[i].id] = 2 * L;
    double four = pl_stage_eval(s, b->inertia);
    s->value[found[i].id] = L;
    if (!(fabs(four - 4 * I) < 1e-9 * fabs(I)) || !(L > 0)) continue;
    *k = I / (m * L * L);
    return L;
  }
  return 0;
}

static bool near(double a, double b) { return fabs(a - b) < 1e-6 * b; }

// --------------------------------------------------------------------------------- touching points
static double slope(pl_stage* s, pl_expr g, pl_expr x) {
  return pl_kind_of(s->pool, x) == PL_SYMBOL
             ? pl_stage_eval(s, pl_diff(s->pool, g, pl_symbol_of(s->pool, x)))
             : (double)NAN;
}

// dg/dα = n . dX/dα for X = C + R(σα) p: two unknowns, a row for each sample.
static pl_touch find_touch(pl_stage* s, const pl_thing* t, int bond) {
  pl_touch touch = {.bond = bond};
  const pl_bond* b = &s->bonds.at[bond];
  pl_expr g = b->c->g, alpha = t->body->angle;
  if (pl_kind_of(s->pool, alpha) != PL_SYMBOL || b->velocity || b->c->off) return touch;
  bool own = b->deps.n > 0;
  for (int i = 0; i < b->deps.n; i++) {
    bool in = s->q[b->deps.at[i]].id == pl_symbol_of(s->pool, alpha).id;
    for (int k = 0; k < t->deps.n; k++) in |= t->deps.at[k] == b->deps.at[i];
    own &= in;
  }
  if (!own) return touch;
  double *a = &s->value[pl_symbol_of(s->pool, alpha).id], old = *a, A[2][SAMPLES * 2], r[SAMPLES],
         angle[SAMPLES];
  bool steady = true;
  for (int i = 0; i < SAMPLES; i++) {
    *a = i == 0 ? old : pl_random_between(&s->random, -1.4, 1.4);
    angle[i] = *a;
    double n[2] = {slope(s, g, t->spot.e[0]), slope(s, g, t->spot.e[1])};
    if (i == 0) memcpy(touch.n, n, sizeof n);
    steady &= fabs(n[0] - touch.n[0]) + fabs(n[1] - touch.n[1]) < 1e-9 * (fabs(n[0]) + fabs(n[1]));
    r[i] = slope(s, g, alpha);
  }
  *a = old;
  if (!steady || !isfinite(touch.n[0] + touch.n[1])) return touch;
  for (int sense = 0; sense < 2; sense++) {
    double sg = sense ? -1 : 1, worst = 0, scale = 1e-12;
    for (int i = 0; i < SAMPLES; i++) {
      double c = cos(sg * angle[i]), si = sin(sg * angle[i]);
      A[sense][2 * i] = sg * (-touch.n[0] * si + touch.n[1] * c);
      A[sense][2 * i + 1] = sg * (-touch.n[0] * c - touch.n[1] * si);
    }
    if (!pl_least(A[sense], r, SAMPLES, 2, touch.p[sense])) continue;
    for (int i = 0; i < SAMPLES; i++) {
      worst = fmax(worst, fabs(A[sense][2 * i] * touch.p[sense][0]
                               + A[sense][2 * i + 1] * touch.p[sense][1] - r[i]));
      scale = fmax(scale, fabs(r[i]));
    }
    touch.fits[sense] = worst < 1e-6 * scale;
    double along = sg * (-touch.n[0] * sin(sg * old) + touch.n[1] * cos(sg * old));
    bool constant = true;
    for (int i = 1; i < SAMPLES; i++) constant &= fabs(r[i] - r[0]) < 1e-9 * scale;
    bool upright = fabs(touch.n[0] * s->down[0] + touch.n[1] * s->down[1])
                   > 0.99 * hypot(touch.n[0], touch.n[1]);
    // for small angles: y - a θ
    if (!touch.fits[sense] && constant && upright && fabs(along) > 0.1) {
      touch.p[sense][0] = r[0] / along;
      touch.p[sense][1] = 0;
      touch.fits[sense] = true;
    }
  }
  touch.found = touch.fits[0] || touch.fits[1];
  return touch;
}

static int distinct(const pl_touch* touch, int n, int sense) {
  int count = 0;
  for (int i = 0; i < n; i++) {
    bool fresh = touch[i].fits[sense];
    for (int k = 0; k < i; k++) {
      fresh &= hypot(touch[i].p[sense][0] - touch[k].p[sense][0],
                     touch[i].p[sense][1] - touch[k].p[sense][1])
               > 1e-6;
    }
    count += fresh;
  }
  return count;
}

static void add_floor(pl_stage* s, int thing, const pl_touch* touch, int sense, double reach) {
  pl_thing* t = &s->things.at[thing];
  pl_bond* b = &s->bonds.at[touch->bond];
  pl_floor* f = PL_NEW(s->arena, pl_floor);
  f->thing = thing;
  f->wide = b->c->relation != PL_EQ;
  f->reach = reach;
  double size = hypot(touch->n[0], touch->n[1]),
         sign = b->c->relation == PL_GE || b->c->relation == PL_GT ? -1 : 1, x[3];
  double a = (sense ? -1 : 1) * pl_stage_eval(s, t->body->angle);
  if (!f->wide && touch->n[0] * s->down[0] + touch->n[1] * s->down[1] < 0) sign = -1;
  for (int j = 0; j < 2; j++) f->normal[j] = sign * touch->n[j] / size;
  pl_stage_spot(s, &t->spot, x);
  f->normal[3] = x[0] + touch->p[sense][0] * cos(a) - touch->p[sense][1] * sin(a);
  f->normal[4] = x[1] + touch->p[sense][0] * sin(a) + touch->p[sense][1] * cos(a);
  f->normal[5] = x[2];
  pl_part* p = pl_stage_add(s, PL_SHAPE_GROUND, "", b->c->name.text);
  p->place = place_floor;
  p->data = f;
  p->normal = f->normal;
  b->touches = true;
  b->touched = thing;
  memcpy(b->touch_normal, touch->n, sizeof b->touch_normal);
  memcpy(b->touch_place, touch->p[sense], sizeof b->touch_place);
}

// ---------------------------------------------------------------------------------------- outlines
static void add_outline(pl_stage* s, int i, const pl_body_outline* o) {
  pl_thing* t = &s->things.at[i];
  pl_part* p = pl_stage_add(s, PL_SHAPE_BODY, s->things.n > MOST_NAMED ? "" : t->label, t->name);
  p->n = o->radius > 0 ? 49 : 5;
  p->moves = true;
  p->place = place_body;
  p->data = o;
  p->mass = pl_stage_eval(s, t->mass);
  if (o->radius > 0) {
    pl_part* spoke = pl_stage_add(s, PL_SHAPE_ROD, "", t->name);
    spoke->moves = true;
    spoke->place = place_spoke;
    spoke->data = o;
  }
}

static void find_outline(pl_stage* s, int i) {
  pl_thing* t = &s->things.at[i];
  double k = 0, L = length_in(s, t->body, &k);
  double gyration =
      sqrt(fabs(pl_stage_eval(s, t->body->inertia) / pl_stage_eval(s, t->body->mass)));
  pl_body_outline* o = PL_NEW(s->arena, pl_body_outline);
  o->thing = i;
  if (L > 0 && near(k, 1.0 / 12)) o->half = L / 2;
  else if (L > 0 && near(k, 1.0 / 3)) o->half = L;
  else if (L > 0) o->radius = L;
  else o->half = sqrt(3) * (isfinite(gyration) && gyration > 0 ? gyration : 0.5);
  o->thick = L > 0 ? 0.02 * L : 0.25 * o->half;
  t->radius = o->radius;
  t->sense = 1;
  pl_touch touch[MOST_TOUCHES] = {0};
  int n = 0;
  for (int b = 0; b < s->bonds.n && n < MOST_TOUCHES && !(o->radius > 0); b++) {
    touch[n] = find_touch(s, t, b);
    if (touch[n].found) n++;
  }
  int sense = distinct(touch, n, 1) > distinct(touch, n, 0);
  t->sense = sense ? -1 : 1;
  double widest = 0;
  for (int b = 0; b < n; b++)
    if (touch[b].fits[sense])
      widest = fmax(widest, hypot(touch[b].p[sense][0], touch[b].p[sense][1]));
  if (L == 0 && widest > 0) {
    o->half = 1.1 * widest;
    o->thick = 0.06 * o->half;
  }
  for (int b = 0; b < n; b++)
    if (touch[b].fits[sense]) add_floor(s, i, &touch[b], sense, 0.5 * o->half);
  t->reach = fmax(o->half, o->radius);
  add_outline(s, i, o);
}

void pl_stage_bodies(pl_stage* s) {
  for (int i = 0; i < s->things.n; i++) {
    if (s->things.at[i].kind == PL_THING_BODY) find_outline(s, i);
  }
}
