// Ropes over pulleys: a sum of lengths that is kept.  Each length is a coordinate along which one thing moves at unit
// speed, measured from where the rope leaves the pulley.
#include <math.h>
#include <string.h>

#include "scene/scene_impl.h"

enum { ARC = 13 };
typedef struct pl_strand { int thing; pl_spot anchor; } pl_strand;
typedef struct pl_rope { pl_strand end[2]; bool parallel; double along[3]; } pl_rope;

// d place / d q at the present values.
static void speed(pl_stage* s, const pl_thing* t, int q, double d[3]) {
  for (int j = 0; j < 3; j++) d[j] = pl_is_poison(t->spot.e[j]) ? 0 : pl_stage_eval(s, pl_diff(s->pool, t->spot.e[j], s->q[q]));
}

static int mover(pl_stage* s, int q) {
  for (int i = 0; i < s->things.n; i++) {
    const pl_thing* t = &s->things.at[i];
    for (int k = 0; k < t->deps.n; k++) {
      double d[3];
      if (t->deps.at[k] != q || t->kind == PL_THING_POINT) continue;
      speed(s, t, q, d);
      if (fabs(hypot(hypot(d[0], d[1]), d[2]) - 1) < 1e-9) return i;
    }
  }
  return PL_NO_THING;
}

static void place_rope(pl_stage* s, const pl_part* part, double* xyz) {
  const pl_rope* r = part->data;
  double a[3], b[3], A[3], B[3];
  pl_stage_spot(s, &s->things.at[r->end[0].thing].spot, a);
  pl_stage_spot(s, &s->things.at[r->end[1].thing].spot, b);
  pl_stage_spot(s, &r->end[0].anchor, A);
  pl_stage_spot(s, &r->end[1].anchor, B);
  memcpy(xyz, a, sizeof a);
  memcpy(xyz + 3 * (part->n - 1), b, sizeof b);
  double radius = 0, c[3], w[3];
  for (int j = 0; j < 3; j++) {
    c[j] = (A[j] + B[j]) / 2;
    w[j] = (A[j] - B[j]) / 2;
    radius += w[j] * w[j];
  }
  radius = sqrt(radius);
  for (int i = 0; i < ARC; i++) {
    double angle = M_PI * i / (ARC - 1);
    for (int j = 0; j < 3; j++) {
      double round = r->parallel ? c[j] + w[j] * cos(angle) - r->along[j] * radius * sin(angle) : i < ARC / 2 ? A[j] : B[j];
      xyz[3 * (i + 1) + j] = round;
    }
  }
}

static void place_pulley(pl_stage* s, const pl_part* part, double* xyz) {
  const pl_rope* r = part->data;
  double A[3], B[3], radius = 0, c[3], w[3];
  pl_stage_spot(s, &r->end[0].anchor, A);
  pl_stage_spot(s, &r->end[1].anchor, B);
  for (int j = 0; j < 3; j++) {
    c[j] = (A[j] + B[j]) / 2;
    w[j] = (A[j] - B[j]) / 2;
    radius += w[j] * w[j];
  }
  radius = sqrt(radius);
  for (int i = 0; i < part->n; i++) {
    double angle = 2 * M_PI * i / (part->n - 1);
    for (int j = 0; j < 3; j++) xyz[3 * i + j] = c[j] + w[j] * cos(angle) - r->along[j] * radius * sin(angle);
  }
}

static pl_spot at_zero(pl_stage* s, const pl_thing* t, int q) {
  pl_spot a = t->spot;
  for (int j = 0; j < 3; j++) {
    if (!pl_is_poison(a.e[j])) a.e[j] = pl_subst1(s->pool, a.e[j], s->q[q], pl_int(s->pool, 0));
  }
  return a;
}

bool pl_stage_rope(pl_stage* s, pl_bond* b) {
  int q[2], n = 0;
  double slope[2];
  for (int i = 0; i < b->deps.n; i++) {
    pl_expr d = pl_diff(s->pool, b->c->g, s->q[b->deps.at[i]]);
    if (pl_has_role(s->pool, d, PL_R_COORD) || pl_has_role(s->pool, d, PL_R_TIME) || n == 2) return false;
    slope[n] = pl_stage_eval(s, d);
    q[n++] = b->deps.at[i];
  }
  if (n != 2 || !(fabs(slope[0] - slope[1]) < 1e-9 * fabs(slope[0])) || s->angle[q[0]] || s->angle[q[1]]) return false;
  pl_rope* r = PL_NEW(s->arena, pl_rope);
  double u[2][3];
  for (int k = 0; k < 2; k++) {
    r->end[k].thing = mover(s, q[k]);
    if (r->end[k].thing < 0) return false;
    speed(s, &s->things.at[r->end[k].thing], q[k], u[k]);
  }
  if (r->end[0].thing == r->end[1].thing) return false;
  double cosine = u[0][0] * u[1][0] + u[0][1] * u[1][1] + u[0][2] * u[1][2];
  r->parallel = cosine > 0.999;
  memcpy(r->along, u[0], sizeof r->along);
  if (s->model->n_axes < 2) {           // beside each other
    double wide = 0.18 * fmax(s->size, 1e-9);
    s->things.at[r->end[0].thing].spot.side = -wide;
    s->things.at[r->end[1].thing].spot.side = wide;
  }
  for (int k = 0; k < 2; k++) {
    pl_thing* t = &s->things.at[r->end[k].thing];
    r->end[k].anchor = at_zero(s, t, q[k]);
    t->linked = t->roped = true;
  }
  if (r->parallel) {
    pl_part* wheel = pl_stage_add(s, PL_SHAPE_BODY, "", b->c->name.text);
    wheel->n = 49;
    wheel->place = place_pulley;
    wheel->data = r;
  }
  pl_part* p = pl_stage_add(s, PL_SHAPE_ROPE, "", b->c->name.text);
  p->n = ARC + 2;
  p->moves = true;
  p->place = place_rope;
  p->data = r;
  return true;
}
