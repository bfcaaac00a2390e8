// Ropes over pulleys: a sum of lengths that is kept. Each length is a coordinate along which one
// thing moves at unit speed, measured from where the rope leaves the pulley. In models with one
// axis a coordinate that counts -2 is a pulley that hangs itself, one that counts 2 hangs in a loop
// of the rope.
#include <math.h>
#include <string.h>

#include "scene/scene_impl.h"

enum { ARC = 13, MOST_ROPES = 16 };

// ------------------------------------------------------------------------------ what is recognised
// parts of the rope that carry it: 1 or 2
typedef struct pl_rope_end {
  int thing, q;
  int parts;
} pl_rope_end;
typedef struct pl_rope {
  const char* of;
  pl_rope_end end[2];
  int pulley;  // thing that carries the pulley, PL_NO_THING: it is fixed
  bool parallel;
  double along[3];    // the way the ends hang
  pl_spot anchor[2];  // where the rope leaves the pulley
  double wheel;       // radius of the wheel in a loop
} pl_rope;

// d place / d q at the present values.
static void speed(pl_stage* s, const pl_thing* t, int q, double d[3]) {
  for (int j = 0; j < 3; j++)
    d[j] = pl_is_poison(t->spot.e[j]) ? 0
                                      : pl_stage_eval(s, pl_diff(s->pool, t->spot.e[j], s->q[q]));
}

static int mover(pl_stage* s, int q) {
  for (int i = 0; i < s->things.n; i++) {
    const pl_thing* t = &s->things.at[i];
    for (int k = 0; k < t->deps.n; k++) {
      double d[3];
      if (t->deps.at[k] != q) continue;
      speed(s, t, q, d);
      if (fabs(hypot(hypot(d[0], d[1]), d[2]) - 1) < 1e-9) return i;
    }
  }
  if (s->model->n_axes != 1) return PL_NO_THING;
  // a coordinate without mass: the axle of a pulley
  pl_point at = {.n = 1, .at = {pl_sym(s->pool, s->q[q]), pl_poison(), pl_poison()}};
  pl_thing t = {.kind = PL_THING_POINT,
                .label = pl_symbol_get(s->pool, s->q[q])->name,
                .name = "",
                .mass = pl_poison(),
                .sense = 1};
  t.spot = pl_spot_of(s, &at);
  int* own = PL_ARRAY(s->arena, int, 1);
  *own = q;
  t.deps.at = own;
  t.deps.n = t.deps.cap = 1;
  pl_push(s->arena, s->things, t);
  return s->things.n - 1;
}

// ------------------------------------------------------------------------------------------ points
static void half_circle(const pl_rope* r, const double A[3], const double B[3], double sign,
                        double* xyz, int n) {
  double radius = 0, c[3], w[3];
  for (int j = 0; j < 3; j++) {
    c[j] = (A[j] + B[j]) / 2;
    w[j] = (A[j] - B[j]) / 2;
    radius += w[j] * w[j];
  }
  radius = sqrt(radius);
  for (int i = 0; i < n; i++) {
    double angle = M_PI * i / (n - 1);
    for (int j = 0; j < 3; j++) {
      xyz[3 * i + j] = r->parallel
                           ? c[j] + w[j] * cos(angle) - sign * r->along[j] * radius * sin(angle)
                       : i < n / 2 ? A[j]
                                   : B[j];
    }
  }
}

static void ends(pl_stage* s, const pl_rope* r, double x[2][3], double a[2][3]) {
  for (int k = 0; k < 2; k++) {
    pl_stage_spot(s, &s->things.at[r->end[k].thing].spot, x[k]);
    pl_stage_spot(s, &r->anchor[k], a[k]);
  }
}

static void place_rope(pl_stage* s, const pl_part* part, double* xyz) {
  const pl_rope* r = part->data;
  double x[2][3], a[2][3];
  ends(s, r, x, a);
  bool loop = r->end[1].parts == 2;
  if (loop) a[1][1] -= r->wheel;
  memcpy(xyz, x[0], sizeof x[0]);
  half_circle(r, a[0], a[1], 1, xyz + 3, ARC);
  if (!loop) {
    memcpy(xyz + 3 * (ARC + 1), x[1], sizeof x[1]);
    return;
  }
  double from[3] = {x[1][0], x[1][1] - r->wheel, x[1][2]},
         to[3] = {x[1][0], x[1][1] + r->wheel, x[1][2]};
  half_circle(r, from, to, -1, xyz + 3 * (ARC + 1), ARC);
  double last[3] = {a[1][0], x[1][1] + r->wheel, x[1][2]};
  memcpy(xyz + 3 * (2 * ARC + 1), last, sizeof last);
}

static void place_pulley(pl_stage* s, const pl_part* part, double* xyz) {
  const pl_rope* r = part->data;
  double x[2][3], a[2][3];
  ends(s, r, x, a);
  if (r->end[1].parts == 2) a[1][1] -= r->wheel;
  int n = (part->n + 1) / 2;
  half_circle(r, a[0], a[1], 1, xyz, n);
  half_circle(r, a[1], a[0], -1, xyz + 3 * (n - 1), part->n - n + 1);
}

static void place_wheel(pl_stage* s, const pl_part* part, double* xyz) {
  const pl_rope* r = part->data;
  double x[3];
  pl_stage_spot(s, &s->things.at[r->end[1].thing].spot, x);
  for (int i = 0; i < part->n; i++) {
    double angle = 2 * M_PI * i / (part->n - 1);
    xyz[3 * i] = x[0] + r->wheel * sin(angle);
    xyz[3 * i + 1] = x[1] + r->wheel * cos(angle);
    xyz[3 * i + 2] = x[2];
  }
}

// ------------------------------------------------------------------------------------- recognising
// Slopes of a bond that is linear in at most three lengths; how many, 0 if it is not.
static int lengths_of(pl_stage* s, const pl_bond* b, int q[3], double c[3]) {
  int n = 0;
  double least = INFINITY;
  for (int i = 0; i < b->deps.n; i++) {
    pl_expr d = pl_diff(s->pool, b->c->g, s->q[b->deps.at[i]]);
    if (pl_has_role(s->pool, d, PL_R_COORD) || pl_has_role(s->pool, d, PL_R_TIME) || n == 3
        || s->angle[b->deps.at[i]])
      return 0;
    c[n] = pl_stage_eval(s, d);
    least = fmin(least, fabs(c[n]));
    q[n++] = b->deps.at[i];
  }
  int positive = 0;
  for (int i = 0; i < n; i++) {
    c[i] /= least;
    positive += c[i] > 0;
  }
  for (int i = 0; 2 * positive < n && i < n; i++) c[i] = -c[i];
  return n;
}

static bool is(double a, double b) { return fabs(a - b) < 1e-9; }

static bool read_rope(pl_stage* s, const pl_bond* b, pl_rope* r) {
  int q[3];
  double c[3];
  int n = lengths_of(s, b, q, c), pulley_q = -1, n_ends = 0;
  *r = (pl_rope){.of = b->c->name.text, .pulley = PL_NO_THING};
  for (int i = 0; i < n; i++) {
    if (is(c[i], -2) && n == 3 && pulley_q < 0) pulley_q = q[i];
    else if ((is(c[i], 1) || (is(c[i], 2) && s->model->n_axes == 1)) && n_ends < 2)
      r->end[n_ends++] = (pl_rope_end){PL_NO_THING, q[i], is(c[i], 2) ? 2 : 1};
    else return false;
  }
  if (n_ends != 2 || (n == 3 && pulley_q < 0) || (pulley_q >= 0 && s->model->n_axes != 1))
    return false;
  if (r->end[0].parts == 2 && r->end[1].parts == 2) return false;
  if (r->end[0].parts == 2) {
    pl_rope_end swap = r->end[0];
    r->end[0] = r->end[1];
    r->end[1] = swap;
  }
  for (int k = 0; k < 2; k++) {
    r->end[k].thing = mover(s, r->end[k].q);
    if (r->end[k].thing < 0) return false;
  }
  if (r->end[0].thing == r->end[1].thing) return false;
  if (pulley_q >= 0) r->pulley = mover(s, pulley_q);
  double u[2][3];
  for (int k = 0; k < 2; k++) speed(s, &s->things.at[r->end[k].thing], r->end[k].q, u[k]);
  r->parallel = u[0][0] * u[1][0] + u[0][1] * u[1][1] + u[0][2] * u[1][2] > 0.999;
  memcpy(r->along, u[0], sizeof r->along);
  return true;
}

// ------------------------------------------------------------------------------- beside each other
// Models with one axis: what hangs on a pulley stands to both sides of it.
typedef struct pl_layout {
  pl_rope* rope;
  int n;
  double* slot;
  double next;
  int depth;
} pl_layout;

static double slot_of(pl_stage* s, pl_layout* l, int thing) {
  if (!isnan(l->slot[thing])) return l->slot[thing];
  for (int i = 0; i < l->n && l->depth < MOST_ROPES; i++) {
    if (l->rope[i].pulley != thing) continue;
    l->depth++;
    double a = slot_of(s, l, l->rope[i].end[0].thing), b = slot_of(s, l, l->rope[i].end[1].thing);
    return l->slot[thing] = (a + b) / 2;
  }
  return l->slot[thing] = l->next++;
}

static void lay_out(pl_stage* s, pl_rope* rope, int n) {
  pl_layout l = {.rope = rope, .n = n, .slot = PL_ARRAY(s->arena, double, s->things.n)};
  for (int i = 0; i < s->things.n; i++) l.slot[i] = (double)NAN;
  for (int i = 0; i < n; i++) {
    for (int k = 0; k < 2 && rope[i].pulley < 0; k++) slot_of(s, &l, rope[i].end[k].thing);
  }
  for (int i = 0; i < n; i++)
    for (int k = 0; k < 2; k++) slot_of(s, &l, rope[i].end[k].thing);
  double step = 0.34 * s->size;
  for (int i = 0; i < s->things.n; i++) {
    if (!isnan(l.slot[i])) s->things.at[i].spot.side = (l.slot[i] - (l.next - 1) / 2) * step;
  }
  for (int i = 0; i < n; i++) rope[i].wheel = 0.25 * step;
}

static void add_rope(pl_stage* s, pl_rope* r) {
  for (int k = 0; k < 2; k++) {
    pl_thing* t = &s->things.at[r->end[k].thing];
    t->linked = t->roped = true;
    r->anchor[k] = r->pulley >= 0 ? s->things.at[r->pulley].spot : t->spot;
    r->anchor[k].side = t->spot.side;
    for (int j = 0; j < 3 && r->pulley < 0; j++) {
      if (!pl_is_poison(t->spot.e[j]))
        r->anchor[k].e[j] = pl_subst1(s->pool, t->spot.e[j], s->q[r->end[k].q], pl_int(s->pool, 0));
    }
  }
  bool loop = r->end[1].parts == 2;
  for (int k = 0; k < 2; k++) {
    if (k == 0 ? !r->parallel : !loop) continue;
    pl_part* wheel = pl_stage_add(s, PL_SHAPE_BODY, "", r->of);
    wheel->n = 49;
    wheel->place = k == 0 ? place_pulley : place_wheel;
    wheel->moves = r->pulley >= 0 || k == 1;
    wheel->data = r;
  }
  pl_part* p = pl_stage_add(s, PL_SHAPE_ROPE, "", r->of);
  p->n = loop ? 2 * ARC + 2 : ARC + 2;
  p->moves = true;
  p->place = place_rope;
  p->data = r;
}

void pl_stage_ropes(pl_stage* s) {
  pl_rope* rope = PL_ARRAY(s->arena, pl_rope, MOST_ROPES);
  int n = 0;
  for (int i = 0; i < s->bonds.n && n < MOST_ROPES; i++) {
    pl_bond* b = &s->bonds.at[i];
    if (b->velocity || b->deps.n < 2 || b->deps.n > 3 || !read_rope(s, b, &rope[n])) continue;
    b->drawn = true;
    n++;
  }
  if (s->model->n_axes == 1 && n > 0) lay_out(s, rope, n);
  for (int i = 0; i < n; i++) add_rope(s, &rope[i]);
}
