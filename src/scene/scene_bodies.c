// Outlines of planar bodies.  What is known is mass and inertia: m l²/12 is a rod of length l, m r²/2 a disc of radius r.
#include <math.h>
#include <string.h>

#include "scene/scene_impl.h"

typedef struct pl_outline { int thing; double half, thick, radius; } pl_outline;

static void place_body(pl_stage* s, const pl_part* part, double* xyz) {
  const pl_outline* o = part->data;
  const pl_thing* t = &s->things.at[o->thing];
  double c[3];
  pl_stage_spot(s, &t->spot, c);
  double a = t->sense * pl_stage_eval(s, t->body->angle);
  for (int i = 0; i < part->n; i++) {
    double u, v;
    if (o->radius > 0) {
      double b = 2 * M_PI * i / (part->n - 1);
      u = o->radius * cos(b), v = o->radius * sin(b);
    } else {
      static const double corner[5][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
      u = o->half * corner[i][0], v = o->thick * corner[i][1];
    }
    xyz[3 * i] = c[0] + u * cos(a) - v * sin(a);
    xyz[3 * i + 1] = c[1] + u * sin(a) + v * cos(a);
    xyz[3 * i + 2] = c[2];
  }
}

static void place_spoke(pl_stage* s, const pl_part* part, double* xyz) {
  const pl_outline* o = part->data;
  const pl_thing* t = &s->things.at[o->thing];
  pl_stage_spot(s, &t->spot, xyz);
  double a = t->sense * pl_stage_eval(s, t->body->angle);
  xyz[3] = xyz[0] + o->radius * cos(a);
  xyz[4] = xyz[1] + o->radius * sin(a);
  xyz[5] = xyz[2];
}

// The length in the inertia and what it is multiplied by: I = k m L².
static double length_in(pl_stage* s, const pl_body* b, double* k) {
  pl_symbol found[16];
  int n = pl_symbols_in(s->pool, b->inertia, found, 16);
  double I = pl_stage_eval(s, b->inertia), m = pl_stage_eval(s, b->mass);
  for (int i = 0; i < n && i < 16; i++) {
    const pl_symbol_info* info = pl_symbol_get(s->pool, found[i]);
    if (info->role != PL_R_PARAM || pl_has_symbol(s->pool, b->mass, found[i])) continue;
    if (info->dimension_known && s->model->uses_units && !pl_dimension_equal(info->dimension, pl_dimension_of(1, 0, 0))) continue;
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

void pl_stage_bodies(pl_stage* s) {
  for (int i = 0; i < s->things.n; i++) {
    pl_thing* t = &s->things.at[i];
    if (t->kind != PL_THING_BODY) continue;
    double k = 0, L = length_in(s, t->body, &k);
    double gyration = sqrt(fabs(pl_stage_eval(s, t->body->inertia) / pl_stage_eval(s, t->body->mass)));
    pl_outline* o = PL_NEW(s->arena, pl_outline);
    o->thing = i;
    if (L > 0 && near(k, 1.0 / 12)) o->half = L / 2;
    else if (L > 0 && near(k, 1.0 / 3)) o->half = L;
    else if (L > 0) o->radius = L;
    else o->half = sqrt(3) * (isfinite(gyration) ? gyration : 0.5);
    o->thick = L > 0 ? 0.02 * L : 0.25 * o->half;
    t->radius = o->radius;
    pl_part* p = pl_stage_add(s, PL_SHAPE_BODY, t->label, t->name);
    p->n = o->radius > 0 ? 49 : 5;
    p->moves = true;
    p->place = place_body;
    p->data = o;
    if (o->radius > 0) {
      pl_part* spoke = pl_stage_add(s, PL_SHAPE_ROD, "", t->name);
      spoke->moves = true;
      spoke->place = place_spoke;
      spoke->data = o;
    }
  }
}
