// What is drawn beside the system itself: axes, angles, trails, and arrows of forces and
// velocities.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene_impl.h"

enum { ARC = 17, MOST_TRAILS = 6, MOST_ARROWS = 40 };

// -------------------------------------------------------------------------------------------- axes
static void add_axes(pl_stage* s) {
  int n = s->model->n_axes;
  double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY}, home[3] = {0, 0, 0};
  for (int i = 0; i < 8; i++) {
    double x[3], xy[2];
    for (int j = 0; j < 3; j++) x[j] = i >> j & 1 ? s->hi[j] : s->lo[j];
    pl_view_project(&s->view, x, xy);
    for (int k = 0; k < 2; k++) {
      lo[k] = fmin(lo[k], xy[k]);
      hi[k] = fmax(hi[k], xy[k]);
    }
  }
  double length = 0.22 * s->size;
  // far from the origin the axes stand beside the motion
  for (int j = 0; j < 3; j++) {
    double span = s->hi[j] - s->lo[j];
    if (s->lo[j] > 0.9 * s->size + 0.5 * span) home[j] = s->lo[j] - 0.1 * s->size;
    if (s->hi[j] < -0.9 * s->size - 0.5 * span) home[j] = s->hi[j] + 0.1 * s->size;
  }
  if (n < 2) home[1] = s->lo[1] - 0.3 * s->size;
  for (int j = 0; j < n; j++) {
    if (hypot(s->view.e[j][0], s->view.e[j][1]) < 1e-9) continue;
    double tip[3] = {home[0], home[1], home[2]};
    tip[j] += length;
    pl_part* p = pl_stage_add(s, PL_SHAPE_AXIS, s->model->axes[j].name, "");
    p->spot[0] = pl_spot_fixed(home);
    p->spot[1] = pl_spot_fixed(tip);
  }
}

// ------------------------------------------------------------------------------------------ angles
typedef struct pl_arc {
  pl_spot spot, pivot;
  int q;
  double radius;
} pl_arc;

static void place_arc(pl_stage* s, const pl_part* part, double* xyz) {
  const pl_arc* a = part->data;
  double* q = &s->value[s->q[a->q].id];
  double full = *q, turned = remainder(full, 2 * M_PI);
  for (int i = 0; i < part->n; i++) {
    double x[3], c[3], d = 0;
    *q = turned * i / (part->n - 1);
    pl_stage_spot(s, &a->spot, x);
    pl_stage_spot(s, &a->pivot, c);
    for (int j = 0; j < 3; j++) d += (x[j] - c[j]) * (x[j] - c[j]);
    d = sqrt(d);
    for (int j = 0; j < 3; j++)
      xyz[3 * i + j] = d > 0 ? c[j] + (x[j] - c[j]) / d * a->radius : (double)NAN;
  }
  *q = full;
}

// The place of a thing with the maps of `choose` inserted.
static pl_spot resolved(pl_stage* s, const pl_thing* t) {
  pl_spot spot = t->spot;
  for (int round = 0; round < 3; round++) {
    for (int i = 0; i < s->model->choose.n_maps; i++) {
      for (int j = 0; j < 3; j++) {
        if (!pl_is_poison(spot.e[j]))
          spot.e[j] = pl_subst_expr(s->pool, spot.e[j], s->model->choose.maps[i].old,
                                    s->model->choose.maps[i].map);
      }
    }
  }
  return spot;
}

static pl_spot half_turn(pl_stage* s, const pl_spot* spot, int q) {
  pl_spot pivot = *spot;
  pl_expr opposite = pl_add(s->pool, pl_sym(s->pool, s->q[q]), pl_pi(s->pool));
  for (int j = 0; j < 3; j++) {
    if (pl_is_poison(spot->e[j])) continue;
    pl_expr sum = pl_add(s->pool, spot->e[j], pl_subst1(s->pool, spot->e[j], s->q[q], opposite));
    pivot.e[j] = pl_mul(s->pool, pl_ratio(s->pool, 1, 2), pl_expand(s->pool, sum, 200));
  }
  return pivot;
}

static void add_angles(pl_stage* s) {
  for (int k = 0; k < s->n_q && s->n_q <= 24; k++) {
    if (!s->angle[k] || s->settled[k]) continue;
    for (int i = 0; i < s->things.n; i++) {
      pl_spot spot = resolved(s, &s->things.at[i]);
      bool has = false;
      for (int j = 0; j < 3; j++)
        has |= !pl_is_poison(spot.e[j]) && pl_has_symbol(s->pool, spot.e[j], s->q[k]);
      if (!has || s->things.at[i].kind == PL_THING_BODY) continue;
      pl_spot pivot = half_turn(s, &spot, k);
      bool still = true;
      for (int j = 0; j < 3; j++)
        still &= pl_is_poison(pivot.e[j]) || !pl_has_symbol(s->pool, pivot.e[j], s->q[k]);
      double x[3], c[3];
      pl_stage_spot(s, &spot, x);
      pl_stage_spot(s, &pivot, c);
      double d = hypot(hypot(x[0] - c[0], x[1] - c[1]), x[2] - c[2]);
      if (!still || !(d > 1e-9 * s->size)) continue;
      pl_arc* arc = PL_NEW(s->arena, pl_arc);
      *arc = (pl_arc){spot, pivot, k, fmin(0.16 * s->size, 0.5 * d)};
      pl_part* p = pl_stage_add(s, PL_SHAPE_ANGLE, pl_symbol_get(s->pool, s->q[k])->name,
                                pl_symbol_get(s->pool, s->q[k])->name);
      p->n = ARC;
      p->moves = true;
      p->place = place_arc;
      p->data = arc;
      break;
    }
  }
}

// ------------------------------------------------------------------------------------------ trails
static void add_trails(pl_stage* s) {
  int n = 0;
  if (s->n_frames < 2) return;
  for (int i = s->things.n - 1; i >= 0 && n < MOST_TRAILS; i--) {
    const pl_thing* t = &s->things.at[i];
    if (t->deps.n == 0 || t->kind == PL_THING_POINT) continue;
    if (s->things.n > 12 && n > 0) return;
    pl_part* p = pl_stage_add(s, PL_SHAPE_TRAIL, "", t->name);
    p->spot[0] = t->spot;
    p->n = s->n_frames;
    n++;
  }
}

// ------------------------------------------------------------------------------------------ arrows
typedef enum pl_arrow_kind {
  PL_ARROW_WEIGHT,
  PL_ARROW_BOND,
  PL_ARROW_ROD,
  PL_ARROW_LOAD,
  PL_ARROW_VELOCITY
} pl_arrow_kind;
typedef struct pl_arrow {
  pl_arrow_kind kind;
  int thing, n;
  pl_spot spot;
  pl_spot other;  // rod: its other end
  const pl_constraint* c;
  bool minus;    // λ is shown with the other sign
  pl_expr e[3];  // weight, load, velocity: components
  int q[8];
  pl_expr slope[8], J[3][8];  // dg/dq, d place/dq; rod: of the place seen from the other end
  double* per_metre;
} pl_arrow;

// The force of a constraint on a thing: the shortest F with F . dX/dq = λ dg/dq for the coordinates
// of the thing.
static bool bond_force(pl_stage* s, const pl_arrow* a, double F[3]) {
  double A[8 * 3], b[8], lambda = pl_stage_eval(s, pl_sym(s->pool, a->c->lambda));
  if (a->minus) lambda = -lambda;
  for (int k = 0; k < a->n; k++) {
    b[k] = lambda * pl_stage_eval(s, a->slope[k]);
    for (int j = 0; j < 3; j++) A[3 * k + j] = pl_stage_eval(s, a->J[j][k]);
    if (!isfinite(b[k])) return false;
  }
  return pl_least(A, b, a->n, 3, F);
}

// The direction of a rod, from its other end to this one.
static bool along_rod(pl_stage* s, const pl_arrow* a, double e[3]) {
  double here[3], there[3], length = 0;
  pl_stage_spot(s, &a->spot, here);
  pl_stage_spot(s, &a->other, there);
  for (int j = 0; j < 3; j++) {
    e[j] = here[j] - there[j];
    length += e[j] * e[j];
  }
  for (int j = 0; j < 3; j++) e[j] /= sqrt(length);
  return isfinite(e[0] + e[1] + e[2]);
}

// The force f along a rod at this end, for λ = 1: f times the change of its length is dg/dq for
// every coordinate. A guide takes part of the force, so that the place of the mass alone does not
// tell the whole.
static bool rod_force(pl_stage* s, const pl_arrow* a, double F[3]) {
  double e[3], stretch_slope = 0, stretch_stretch = 0;
  if (!along_rod(s, a, e)) return false;
  for (int k = 0; k < a->n; k++) {
    double stretch = 0;
    for (int j = 0; j < 3; j++) stretch += e[j] * pl_stage_eval(s, a->J[j][k]);
    stretch_slope += stretch * pl_stage_eval(s, a->slope[k]);
    stretch_stretch += stretch * stretch;
  }
  for (int j = 0; j < 3; j++) F[j] = stretch_slope / stretch_stretch * e[j];
  return isfinite(F[0] + F[1] + F[2]);
}

static bool loaded_rod_force(pl_stage* s, const pl_arrow* a, double F[3]) {
  double lambda = pl_stage_eval(s, pl_sym(s->pool, a->c->lambda));
  if (a->minus) lambda = -lambda;
  if (!rod_force(s, a, F)) return false;
  for (int j = 0; j < 3; j++) F[j] *= lambda;
  return isfinite(F[0] + F[1] + F[2]);
}

static bool vector_of(pl_stage* s, const pl_arrow* a, double F[3]) {
  if (a->kind == PL_ARROW_BOND) return bond_force(s, a, F);
  if (a->kind == PL_ARROW_ROD) return loaded_rod_force(s, a, F);
  for (int j = 0; j < 3; j++) F[j] = pl_is_poison(a->e[j]) ? 0 : pl_stage_eval(s, a->e[j]);
  return isfinite(F[0] + F[1] + F[2]);
}

static void place_arrow(pl_stage* s, const pl_part* part, double* xyz) {
  const pl_arrow* a = part->data;
  double F[3], x[3];
  pl_stage_spot(s, &a->spot, x);
  bool there = vector_of(s, a, F) && *a->per_metre > 0;
  double size = sqrt(F[0] * F[0] + F[1] * F[1] + F[2] * F[2]);
  there = there && size > 1e-9 * *a->per_metre * s->size;
  for (int j = 0; j < 3; j++) {
    xyz[j] = there ? x[j] : (double)NAN;
    xyz[3 + j] = there ? x[j] + F[j] / *a->per_metre : (double)NAN;
  }
}

static pl_arrow* add_arrow(pl_stage* s, pl_arrow_kind kind, int thing, const char* label,
                           const char* of) {
  pl_arrow* a = PL_NEW(s->arena, pl_arrow);
  a->kind = kind;
  a->thing = thing;
  if (thing >= 0) a->spot = s->things.at[thing].spot;
  for (int j = 0; j < 3; j++) a->e[j] = pl_poison();
  pl_part* p = pl_stage_add(s, kind == PL_ARROW_VELOCITY ? PL_SHAPE_VELOCITY : PL_SHAPE_FORCE,
                            label, of);
  p->moves = true;
  p->place = place_arrow;
  p->data = a;
  p->hidden = kind == PL_ARROW_VELOCITY;
  return a;
}

static void add_weights(pl_stage* s) {
  for (int g = 0; g < s->model->gravities.n; g++) {
    const pl_gravity* field = &s->model->gravities.at[g];
    for (int i = 0; i < s->things.n; i++) {
      const pl_thing* t = &s->things.at[i];
      if (pl_is_poison(t->mass)) continue;
      const char* label =
          pl_kind_of(s->pool, t->mass) == PL_SYMBOL && pl_kind_of(s->pool, field->g) == PL_SYMBOL
              ? pl_format(s->arena, "%s %s",
                          pl_symbol_get(s->pool, pl_symbol_of(s->pool, t->mass))->name,
                          pl_symbol_get(s->pool, pl_symbol_of(s->pool, field->g))->name)
              : "G";
      pl_arrow* a = add_arrow(s, PL_ARROW_WEIGHT, i, label, "weight");
      a->e[field->axis] = pl_mul_n(s->pool,
                                   (pl_expr[]){pl_int(s->pool, field->sign), t->mass, field->g}, 3);
    }
  }
}

// Coordinates that move a thing: its place and, of a body, its angle.
static void coordinates_of(pl_stage* s, const pl_thing* t, int** deps, int* n) {
  bool timed = false;
  *deps = t->deps.at;
  *n = t->deps.n;
  if (t->body) pl_collect_coords(s, t->body->angle, deps, n, &timed);
}

// A coordinate that several masses share leaves open on which of them a force acts.
static bool own_coordinates(const pl_stage* s, int thing, const pl_bond* b) {
  const pl_thing* t = &s->things.at[thing];
  bool any = false;
  for (int k = 0; k < t->deps.n; k++) {
    bool in = false;
    for (int i = 0; i < b->deps.n; i++) in |= b->deps.at[i] == t->deps.at[k];
    if (!in) continue;
    any = true;
    for (int i = 0; i < s->things.n; i++) {
      const pl_thing* o = &s->things.at[i];
      bool other = i != thing && !pl_is_poison(o->mass);
      for (int l = 0; other && l < o->deps.n; l++)
        if (o->deps.at[l] == t->deps.at[k]) return false;
    }
  }
  return any;
}

// Whether the coordinates of the arrow move its place through the whole space, or along a straight
// guide.
static bool spans_space(pl_stage* s, const pl_arrow* a) {
  static const double clear = 1e-9;
  double N[3][3] = {{0}}, size = 0;
  bool straight = true;
  for (int i = 0; i < 3; i++) {
    for (int k = 0; k < a->n; k++) {
      double x = pl_stage_eval(s, a->J[i][k]);
      for (int j = 0; j < 3; j++) N[i][j] += x * pl_stage_eval(s, a->J[j][k]);
      int* deps = NULL;
      int n = 0;
      bool timed = false;
      pl_collect_coords(s, a->J[i][k], &deps, &n, &timed);
      straight = straight && n == 0;
    }
    size += N[i][i];
  }
  if (straight) return true;
  for (int j = s->model->n_axes; j < 3; j++) N[j][j] = size;
  double det = N[0][0] * (N[1][1] * N[2][2] - N[1][2] * N[2][1])
               - N[0][1] * (N[1][0] * N[2][2] - N[1][2] * N[2][0])
               + N[0][2] * (N[1][0] * N[2][1] - N[1][1] * N[2][0]);
  return det > clear * size * size * size;
}

// Virtual work: the force at this place explains the constraint for every coordinate that moves the
// thing, so that there is no torque beside it. Otherwise the arrow would stand at a wrong place.
static bool explains(pl_stage* s, const pl_arrow* a) {
  static const double clear = 1e-7;
  double A[8 * 3], b[8], F[3], off = 0, size = 0;
  for (int k = 0; k < a->n; k++) {
    b[k] = pl_stage_eval(s, a->slope[k]);
    for (int j = 0; j < 3; j++) A[3 * k + j] = pl_stage_eval(s, a->J[j][k]);
  }
  if (!pl_least(A, b, a->n, 3, F)) return false;
  for (int k = 0; k < a->n; k++) {
    double work = 0;
    for (int j = 0; j < 3; j++) work += A[3 * k + j] * F[j];
    off += (work - b[k]) * (work - b[k]);
    size += b[k] * b[k];
  }
  return size > 0 && off <= clear * clear * size && spans_space(s, a);
}

// The force of a bond at the place of `at`, for the coordinates that move the thing `on`; false: it
// does not act there.
static bool bond_arrow(pl_stage* s, const pl_bond* b, const pl_thing* on, const pl_spot* at,
                       pl_arrow* out) {
  int *deps, n;
  coordinates_of(s, on, &deps, &n);
  if (n > 8) return false;
  *out = (pl_arrow){
      .kind = PL_ARROW_BOND, .spot = *at, .c = b->c, .minus = s->model->lambda_minus, .n = n};
  for (int l = 0; l < n; l++) {
    out->q[l] = deps[l];
    out->slope[l] = pl_diff(s->pool, b->c->g, b->velocity ? s->v[deps[l]] : s->q[deps[l]]);
    for (int j = 0; j < 3; j++) {
      bool fixed = pl_is_poison(at->e[j]);
      out->J[j][l] = fixed ? pl_int(s->pool, 0) : pl_diff(s->pool, at->e[j], s->q[deps[l]]);
    }
  }
  return explains(s, out);
}

static pl_expr slope_of_place(pl_stage* s, const pl_spot* spot, int axis, int q) {
  bool still = spot->fixed || pl_is_poison(spot->e[axis]);
  return still ? pl_int(s->pool, 0) : pl_diff(s->pool, spot->e[axis], s->q[q]);
}

// The force along the rod works on this end as the constraint does, for all its coordinates. Not
// where g holds a component of its place at a number that has a constraint of its own: that one
// shows the rest.
static bool rod_explains(pl_stage* s, const pl_bond* b, const pl_thing* on, const pl_arrow* a) {
  static const double clear = 1e-7;
  double F[3], off = 0, size = 0;
  if (!rod_force(s, a, F)) return false;
  for (int k = 0; k < on->deps.n; k++) {
    double slope = pl_stage_eval(s, pl_diff(s->pool, b->c->g, s->q[on->deps.at[k]]));
    double work = 0;
    for (int j = 0; j < 3; j++)
      work += F[j] * pl_stage_eval(s, slope_of_place(s, &on->spot, j, on->deps.at[k]));
    off += (work - slope) * (work - slope);
    size += slope * slope;
  }
  double whole = F[0] * F[0] + F[1] * F[1] + F[2] * F[2];
  return whole > 0 && off <= clear * clear * (size + whole);
}

// A rod between two things pulls or pushes along itself.
static bool rod_arrow(pl_stage* s, const pl_bond* b, int thing, pl_arrow* out) {
  bool is_end = b->pair && (b->end[0] == thing || b->end[1] == thing);
  if (!is_end || b->deps.n > 8) return false;
  const pl_thing* on = &s->things.at[thing];
  const pl_thing* far = &s->things.at[b->end[0] == thing ? b->end[1] : b->end[0]];
  *out = (pl_arrow){.kind = PL_ARROW_ROD,
                    .spot = on->spot,
                    .other = far->spot,
                    .c = b->c,
                    .minus = s->model->lambda_minus,
                    .n = b->deps.n};
  for (int k = 0; k < out->n; k++) {
    int q = b->deps.at[k];
    out->slope[k] = pl_diff(s->pool, b->c->g, s->q[q]);
    for (int j = 0; j < 3; j++)
      out->J[j][k] = pl_sub(s->pool, slope_of_place(s, &on->spot, j, q),
                            slope_of_place(s, &far->spot, j, q));
  }
  return rod_explains(s, b, on, out);
}

static void keep_bond_arrow(pl_stage* s, int thing, const pl_arrow* found) {
  const pl_constraint* c = found->c;
  pl_arrow* a = add_arrow(s, PL_ARROW_BOND, thing, c->multiplier ? c->multiplier : c->name.text,
                          c->name.text);
  double* per_metre = a->per_metre;
  *a = *found;
  a->thing = thing;
  a->per_metre = per_metre;
}

// The force of a plane on the point of a body that touches it.
static void add_touch_force(pl_stage* s, const pl_bond* b) {
  const pl_thing* t = &s->things.at[b->touched];
  const char* label = b->c->multiplier ? b->c->multiplier : b->c->name.text;
  pl_arrow* a = add_arrow(s, PL_ARROW_LOAD, b->touched, label, b->c->name.text);
  a->spot.angle = t->body->angle;
  a->spot.sense = t->sense;
  a->minus = s->model->lambda_minus;
  pl_expr lambda = pl_sym(s->pool, b->c->lambda);
  for (int j = 0; j < 2; j++) {
    a->spot.p[j] = b->touch_place[j];
    double factor = a->minus ? -b->touch_normal[j] : b->touch_normal[j];
    char number[32];
    int n = snprintf(number, sizeof number, "%.17g", factor);
    a->e[j] = pl_mul(s->pool, lambda, pl_number_from_text(s->pool, number, (size_t)n));
  }
}

// At the mass or centre, or at a point of the body: a joint at its end.
static void add_bond_forces(pl_stage* s) {
  for (int i = 0; i < s->bonds.n; i++) {
    const pl_bond* b = &s->bonds.at[i];
    if (!b->c->lambda.id) continue;
    if (b->touches) {
      add_touch_force(s, b);
      continue;
    }
    for (int k = 0; k < s->things.n; k++) {
      const pl_thing* t = &s->things.at[k];
      pl_arrow a;
      if (pl_is_poison(t->mass) || !own_coordinates(s, k, b)) continue;
      bool found = rod_arrow(s, b, k, &a) || bond_arrow(s, b, t, &t->spot, &a);
      for (int p = 0; p < s->things.n && !found; p++) {
        const pl_thing* point = &s->things.at[p];
        if (t->body && point->kind == PL_THING_POINT) found = bond_arrow(s, b, t, &point->spot, &a);
      }
      if (found) keep_bond_arrow(s, k, &a);
    }
  }
}

static void add_load_forces(pl_stage* s) {
  for (int i = 0; i < s->model->loads.n; i++) {
    const pl_load* l = &s->model->loads.at[i];
    if (l->kind != PL_L_FORCE) continue;
    pl_arrow* a = add_arrow(s, PL_ARROW_LOAD, PL_NO_THING, l->name.generated ? "F" : l->name.text,
                            l->name.text);
    a->spot = pl_spot_of(s, &l->a);
    for (int j = 0; j < 3; j++) a->e[j] = l->vector[j];
  }
}

static void add_velocities(pl_stage* s) {
  for (int i = 0; i < s->things.n; i++) {
    const pl_thing* t = &s->things.at[i];
    if (t->deps.n == 0 || t->kind == PL_THING_POINT) continue;
    pl_arrow* a = add_arrow(s, PL_ARROW_VELOCITY, i, "v", t->name);
    for (int j = 0; j < 3; j++)
      a->e[j] = pl_is_poison(t->spot.e[j]) ? pl_poison() : pl_dt(s->pool, t->spot.e[j]);
  }
}

static int by_size(const void* a, const void* b) {
  double x = *(const double*)a, y = *(const double*)b;
  return x < y ? -1 : x > y;
}

// A quarter of the picture for what is nearly the largest, with a round number for the scale.
static double scale_of(pl_stage* s, pl_shape_kind kind) {
  PL_VEC(double) sizes = {0};
  int stride = s->n_frames > 60 ? s->n_frames / 60 : 1;
  for (int f = 0; f < s->n_frames; f += stride) {
    pl_stage_set(s, f);
    for (int i = 0; i < s->parts.n; i++) {
      const pl_part* p = &s->parts.at[i];
      double F[3];
      if (p->kind != kind || !vector_of(s, p->data, F)) continue;
      double size = sqrt(F[0] * F[0] + F[1] * F[1] + F[2] * F[2]);
      if (isfinite(size) && size > 0) pl_push(s->arena, sizes, size);
    }
  }
  if (sizes.n == 0) return 0;
  qsort(sizes.at, (size_t)sizes.n, sizeof(double), by_size);
  double wanted = sizes.at[(int)(0.97 * (sizes.n - 1))] / (0.28 * s->size);
  double power = pow(10, floor(log10(wanted))), digit = wanted / power;
  return power * (digit <= 1 ? 1 : digit <= 2 ? 2 : digit <= 5 ? 5 : 10);
}

static double* add_kind(pl_stage* s, pl_shape_kind kind) {
  double* per_metre = PL_NEW(s->arena, double);
  *per_metre = scale_of(s, kind);
  for (int i = 0; i < s->parts.n; i++) {
    if (s->parts.at[i].kind != kind) continue;
    pl_arrow* a = (pl_arrow*)(uintptr_t)s->parts.at[i].data;
    a->per_metre = per_metre;
  }
  return per_metre;
}

void pl_stage_arrows(pl_stage* s) {
  add_axes(s);
  pl_stage_set(s, 0);
  add_angles(s);
  add_trails(s);
  if (s->options->forces && s->things.n <= MOST_ARROWS) {
    add_weights(s);
    add_bond_forces(s);
    add_load_forces(s);
    s->newton_per_metre = *add_kind(s, PL_SHAPE_FORCE);
  }
  if (s->options->velocities && s->things.n <= MOST_ARROWS) {
    add_velocities(s);
    s->speed_per_metre = *add_kind(s, PL_SHAPE_VELOCITY);
  }
}
