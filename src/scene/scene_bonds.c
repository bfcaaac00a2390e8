// What constraints look like. A constraint is looked at by its numbers, not by how it is written:
// it is a rod when its gradient is everywhere parallel to that of a distance, a sphere or plane
// when the places that it allows lie on one, and else a curve that is traced. So r = R in polar
// coordinates and x² + y² = R² give the same picture.
#include <math.h>
#include <string.h>

#include "scene/scene_impl.h"

enum { SAMPLES = 3, FIT_SAMPLES = 16 };
// of numerical gradients: central differences leave some 1e-9
static const double parallel_tol = 1e-5;

// --------------------------------------------------------------------------------------- gradients
static double derivative(pl_stage* s, double (*f)(pl_stage*, const void*), const void* what,
                         int k) {
  double* x = &s->value[s->q[k].id];
  double old = *x, h = 1e-5 * (s->angle[k] ? 1 : s->size > 0 ? s->size : 1);
  *x = old + h;
  double d = f(s, what);
  *x = old - h;
  d = (d - f(s, what)) / (2 * h);
  *x = old;
  return d;
}

static double value_of(pl_stage* s, const void* what) {
  return pl_stage_eval(s, *(const pl_expr*)what);
}

// ------------------------------------------------------------------------------------------- bonds
static bool within(const pl_stage* s, const pl_bond* b, const pl_thing* t) {
  for (int i = 0; i < b->deps.n; i++) {
    if (!pl_list_has(t->deps.at, t->deps.n, b->deps.at[i]) && !s->settled[b->deps.at[i]])
      return false;
  }
  return b->deps.n > 0;
}

static void read_bonds(pl_stage* s) {
  for (int i = 0; i < s->bonds.n; i++) {
    pl_bond* b = &s->bonds.at[i];
    int *deps = NULL, n = 0;
    pl_collect_coords(s, b->c->g, &deps, &n, &b->timed);
    b->deps.at = deps;
    b->deps.n = b->deps.cap = n;
    b->hint = b->c->name.generated ? PL_HINT_NONE : pl_hint_of(b->c->name.text);
    bool holds = n == 1 && !b->timed && !b->velocity && b->c->relation == PL_EQ && !b->c->off;
    if (holds) b->settles = deps[0];
    if (holds) s->settled[deps[0]] = true;
  }
}

// Is g a function of the distance of two spots alone, in the coordinates that may move?
static bool keeps_distance(pl_stage* s, const pl_bond* b, const pl_spot* p, const pl_spot* q) {
  const pl_spot* pair[2] = {p, q};
  double* kept = PL_ARRAY(s->arena, double, s->n_q + 1);
  pl_coords_keep(s, kept);
  int *deps = NULL, n = 0;
  bool timed = false, same = true;
  for (int j = 0; j < 3; j++) {
    if (!p->fixed) pl_collect_coords(s, p->e[j], &deps, &n, &timed);
    if (!q->fixed) pl_collect_coords(s, q->e[j], &deps, &n, &timed);
  }
  for (int i = 0; i < b->deps.n; i++) {
    if (!pl_list_has(deps, n, b->deps.at[i])) same = s->settled[b->deps.at[i]] && same;
  }
  int good = 0;
  for (int try = 0; same && try < 4 * SAMPLES && good < SAMPLES; try++) {
    pl_coords_shuffle(s, deps, n);
    double gg = 0, dd = 0, gd = 0;
    for (int i = 0; i < n; i++) {
      if (s->settled[deps[i]]) continue;
      double g = derivative(s, value_of, &b->c->g, deps[i]),
             d = derivative(s, pl_squared_distance, pair, deps[i]);
      gg += g * g;
      dd += d * d;
      gd += g * d;
    }
    if (!isfinite(gg + dd) || !(gg > 0) || !(dd > 0)) {
      same = isfinite(gg + dd) && (gg > 0) == (dd > 0);
      continue;
    }
    same = fabs(gd) > (1 - parallel_tol * parallel_tol * 100) * sqrt(gg * dd);
    good++;
  }
  pl_coords_back(s, kept);
  return same && good == SAMPLES;
}

// ------------------------------------------------------------------------------ between two things
// A circle that goes with a thing: the surface of one that another slides on.
static void place_circle(pl_stage* s, const pl_part* part, double* xyz) {
  double c[3];
  const double* radius = part->data;
  pl_stage_spot(s, &part->spot[0], c);
  for (int i = 0; i < part->n; i++) {
    double a = 2 * M_PI * i / (part->n - 1);
    xyz[3 * i] = c[0] + *radius * cos(a);
    xyz[3 * i + 1] = c[1] + *radius * sin(a);
    xyz[3 * i + 2] = c[2];
  }
}

static bool inside_allowed(const pl_constraint* c, bool rises) {
  return (c->relation == PL_GE || c->relation == PL_GT) != rises;
}

// Does g rise with the distance?
static bool rises_with_distance(pl_stage* s, const pl_bond* b, const pl_spot* p, const pl_spot* q) {
  const pl_spot* pair[2] = {p, q};
  double gd = 0;
  for (int i = 0; i < b->deps.n; i++)
    gd += derivative(s, value_of, &b->c->g, b->deps.at[i])
          * derivative(s, pl_squared_distance, pair, b->deps.at[i]);
  return gd > 0;
}

static void draw_distance(pl_stage* s, pl_bond* b, const pl_spot* from, const pl_spot* to) {
  const pl_spot* pair[2] = {from, to};
  if (b->c->relation == PL_EQ) {
    pl_add_rod(s, b->hint == PL_HINT_ROPE ? PL_SHAPE_ROPE : PL_SHAPE_ROD, b, from, to);
  } else if (inside_allowed(b->c, rises_with_distance(s, b, from, to))) {
    pl_add_rod(s, b->hint == PL_HINT_ROD ? PL_SHAPE_ROD : PL_SHAPE_ROPE, b, from, to);
  } else {
    double* radius = PL_NEW(s->arena, double);
    *radius = sqrt(pl_squared_distance(s, pair));
    pl_part* p = pl_stage_add(s, PL_SHAPE_GROUND, "", b->c->name.text);
    p->spot[0] = *from;
    p->n = 73;
    p->moves = true;
    p->place = place_circle;
    p->data = radius;
    p->side = 1;
  }
}

static void keep_ends(pl_bond* b, int one, int other) {
  b->pair = true;
  b->end[0] = one;
  b->end[1] = other;
}

static bool draw_pair(pl_stage* s, pl_bond* b) {
  int near[8], n = 0;
  for (int i = 0; i < s->things.n && n < 8; i++) {
    const pl_thing* t = &s->things.at[i];
    bool touched = false;
    for (int k = 0; k < t->deps.n && !touched; k++)
      touched = !s->settled[t->deps.at[k]] && pl_list_has(b->deps.at, b->deps.n, t->deps.at[k]);
    if (touched) near[n++] = i;
  }
  for (int i = 0; i < n; i++) {
    for (int j = i + 1; j < n; j++) {
      pl_thing *a = &s->things.at[near[i]], *c = &s->things.at[near[j]];
      if (!keeps_distance(s, b, &a->spot, &c->spot)) continue;
      draw_distance(s, b, &a->spot, &c->spot);
      keep_ends(b, near[i], near[j]);
      a->linked = c->linked = true;
      return true;
    }
  }
  for (int i = 0; i < n; i++) {  // points that rest, or go by a law of time
    for (int j = 0; j < s->things.n; j++) {
      pl_thing *a = &s->things.at[near[i]], *c = &s->things.at[j];
      if (c->kind != PL_THING_POINT || c->deps.n > 0 || !keeps_distance(s, b, &c->spot, &a->spot))
        continue;
      draw_distance(s, b, &c->spot, &a->spot);
      keep_ends(b, near[i], j);
      a->linked = true;
      return true;
    }
  }
  return false;
}

// ---------------------------------------------------------------------------------- a single thing
typedef struct pl_shape_fit {
  bool sphere, plane;
  double centre[3], radius, normal[3];
} pl_shape_fit;

// Moves the coordinates of the bond until it holds.
static bool onto(pl_stage* s, const pl_bond* b) {
  for (int round = 0; round < 40; round++) {
    double g = pl_stage_eval(s, b->c->g), slope[8], sum = 0, scale = s->size > 0 ? s->size : 1;
    int n = b->deps.n < 8 ? b->deps.n : 8;
    if (!isfinite(g)) return false;
    for (int i = 0; i < n; i++) {
      slope[i] = derivative(s, value_of, &b->c->g, b->deps.at[i]);
      sum += slope[i] * slope[i];
    }
    if (!(sum > 0)) return false;
    double most = 0;
    for (int i = 0; i < n; i++) {
      double dx = -g * slope[i] / sum;
      s->value[s->q[b->deps.at[i]].id] += dx;
      most = fmax(most, fabs(dx) / (s->angle[b->deps.at[i]] ? 1 : scale));
    }
    if (most < 1e-13) return true;
  }
  return false;
}

// Do the places that the bond allows lie on a sphere (circle) or in a plane?
static pl_shape_fit fit_places(pl_stage* s, const pl_bond* b, const pl_thing* t) {
  pl_shape_fit fit = {0};
  double x[FIT_SAMPLES][3], lo[3], hi[3], A[FIT_SAMPLES * 5], null[8][8],
      scale = s->size > 0 ? s->size : 1;
  double* kept = PL_ARRAY(s->arena, double, s->n_q + 1);
  pl_coords_keep(s, kept);
  int n = 0;
  for (int try = 0; try < 4 * FIT_SAMPLES && n < FIT_SAMPLES; try++) {
    pl_coords_shuffle(s, t->deps.at, t->deps.n);
    if (b->settles >= 0) s->value[s->q[b->settles].id] = kept[b->settles];
    if (!onto(s, b)) continue;
    pl_stage_spot(s, &t->spot, x[n]);
    if (isfinite(x[n][0] + x[n][1] + x[n][2])) n++;
  }
  pl_coords_back(s, kept);
  if (n < FIT_SAMPLES) return fit;
  int axis[3], dims = 0;
  for (int j = 0; j < 3; j++) {
    lo[j] = hi[j] = x[0][j];
    for (int i = 1; i < n; i++) {
      lo[j] = fmin(lo[j], x[i][j]);
      hi[j] = fmax(hi[j], x[i][j]);
    }
    if (hi[j] - lo[j] > 1e-7 * scale) axis[dims++] = j;
    fit.centre[j] = lo[j];
  }
  if (dims < 2) {  // a line: what is constant is the plane
    fit.plane = dims == 1;
    return fit;
  }
  int m = dims + 2;
  for (int i = 0; i < n; i++) {
    A[i * m] = 0;
    for (int j = 0; j < dims; j++) {
      double u = x[i][axis[j]] / scale;
      A[i * m] += u * u;
      A[i * m + 1 + j] = u;
    }
    A[i * m + dims + 1] = 1;
  }
  if (pl_null_space(A, n, m, null) != 1) return fit;
  const double* c = null[0];
  if (fabs(c[0]) < 1e-6) {
    fit.plane = true;
    return fit;
  }
  double rr = -c[dims + 1] / c[0];
  for (int j = 0; j < dims; j++) {
    double u = -c[1 + j] / (2 * c[0]);
    fit.centre[axis[j]] = u * scale;
    rr += u * u;
  }
  fit.radius = sqrt(rr) * scale;
  fit.sphere = rr > 0 && isfinite(fit.radius) && fit.radius < 1e6 * scale;
  for (int j = 0; j < 3; j++)
    if (fabs(fit.centre[j]) < 1e-9 * scale) fit.centre[j] = 0;
  return fit;
}

// ------------------------------------------------------------------------------------------ curves
typedef struct pl_curve {
  pl_track* track;
  double shift;
  double normal[6];
} pl_curve;

static void place_curve(pl_stage* s, const pl_part* part, double* xyz) {
  const pl_curve* c = part->data;
  bool closed;
  pl_track_follow(s, c->track, xyz, &closed);
}

// Constraints of this thing alone; one of them may come first.
static int own_equations(pl_stage* s, const pl_thing* t, const pl_bond* first, pl_expr* eq,
                         bool* timed) {
  int n = 0;
  if (first) {
    eq[n++] = first->c->g;
    *timed |= first->timed;
  }
  for (int i = 0; i < s->bonds.n && n < 8; i++) {
    const pl_bond* b = &s->bonds.at[i];
    if (b == first || b->velocity || b->c->off || b->c->relation != PL_EQ) continue;
    bool own = b->deps.n > 0;
    for (int k = 0; k < b->deps.n; k++)
      own = own && pl_list_has(t->deps.at, t->deps.n, b->deps.at[k]);
    if (own) {
      eq[n++] = b->c->g;
      *timed |= b->timed;
    }
  }
  return n;
}

// Shrinks the curve by the radius of a round body, towards the side away from where it may be.
static void shift_curve(double* xyz, int n, const double normal[3], double by) {
  double sign = 0;
  for (int pass = 0; pass < 2; pass++) {
    double before[3] = {0, 0, 0};
    for (int i = 0; i < n; i++) {
      const double *a = pass && i > 0 ? before : xyz + 3 * (i > 0 ? i - 1 : i),
                   *b = xyz + 3 * (i + 1 < n ? i + 1 : i);
      double dx = b[0] - a[0], dy = b[1] - a[1], d = hypot(dx, dy);
      if (!(d > 0)) continue;
      double nx = -dy / d, ny = dx / d;
      if (!pass && i == n / 2) sign = nx * normal[0] + ny * normal[1] > 0 ? 1 : -1;
      if (pass) {
        memcpy(before, xyz + 3 * i, sizeof before);
        xyz[3 * i] += sign * by * nx;
        xyz[3 * i + 1] += sign * by * ny;
      }
    }
  }
}

static void place_shifted(pl_stage* s, const pl_part* part, double* xyz) {
  const pl_curve* c = part->data;
  place_curve(s, part, xyz);
  shift_curve(xyz, part->n, c->normal, c->shift);
}

// Does this component of the place change without the coordinates of the bond?
static bool along_free(const pl_stage* s, const pl_bond* b, const pl_thing* t, int axis) {
  for (int k = 0; k < b->deps.n; k++) {
    if (pl_has_symbol(s->pool, t->spot.e[axis], s->q[b->deps.at[k]])) return false;
  }
  return true;
}

static bool draw_curve(pl_stage* s, pl_bond* b, int thing, bool centred, const double* centre,
                       double radius) {
  pl_thing* t = &s->things.at[thing];
  pl_expr eq[8];
  bool timed = t->timed;
  int n_eq = own_equations(s, t, b, eq, &timed);
  int free[8], n_free = 0;
  for (int k = 0; k < t->deps.n && n_free < 8; k++) {
    if (b || !t->linked) free[n_free++] = t->deps.at[k];
  }
  pl_track* track = pl_track_make(s, thing, eq, n_eq, free, n_free);
  if (!track) return false;
  int freedom = pl_track_freedom(s, track);
  if (freedom == 2 && s->model->n_axes == 3) {
    for (int j = 0; j < 3; j++) {
      if (s->hi[j] - s->lo[j] > 1e-6 * s->size || pl_is_poison(t->spot.e[j]) || !b
          || !along_free(s, b, t, j))
        continue;
      double x[3];
      pl_stage_spot(s, &t->spot, x);
      track->fixed_axis = j;
      track->fixed_at = x[j];
    }
    freedom = pl_track_freedom(s, track);
  }
  if (freedom == 2 && s->model->n_axes == 3 && !s->view.plane && b && !timed)
    return pl_stage_surface(s, track, b->c->name.text);
  if (freedom != 1) return false;
  bool one_sided = b && b->c->relation != PL_EQ;
  track->whole = !one_sided;
  for (int j = 0; centred && j < 3; j++) {
    double reach = one_sided ? 0 : 1.05 * radius;
    track->box_lo[j] = fmin(track->box_lo[j], centre[j] - reach);
    track->box_hi[j] = fmax(track->box_hi[j], centre[j] + reach);
  }
  double* trial = PL_ARRAY(s->arena, double, 3 * track->n);
  bool closed = false;
  if (pl_track_follow(s, track, trial, &closed) == 0) return false;
  double normal[3] = {0, 0, 0}, at[3];
  pl_stage_spot(s, &t->spot, at);
  bool known = b && pl_track_normal(s, track, normal);
  if (known && one_sided) {
    double sign = b->c->relation == PL_GE || b->c->relation == PL_GT ? -1 : 1;
    for (int j = 0; j < 3; j++) normal[j] *= sign;
  }
  double towards = 0;
  for (int j = 0; j < 3; j++) towards += normal[j] * s->down[j];
  bool heavy = s->down[0] != 0 || s->down[1] != 0 || s->down[2] != 0;
  if (!one_sided && towards < 0)
    for (int j = 0; j < 3; j++) normal[j] = -normal[j];
  bool ground = one_sided || (b && b->hint == PL_HINT_GROUND)
                || (heavy && known && !closed && b->hint != PL_HINT_TRACK && fabs(towards) > 0.1);
  pl_part* p = pl_stage_add(s, ground ? PL_SHAPE_GROUND : PL_SHAPE_CURVE, "",
                            b ? b->c->name.text : "");
  pl_curve* curve = PL_NEW(s->arena, pl_curve);
  *curve = (pl_curve){track, t->radius, {normal[0], normal[1], normal[2], at[0], at[1], at[2]}};
  p->n = track->n;
  p->moves = timed;
  p->place = t->radius > 0 && known ? place_shifted : place_curve;
  p->data = curve;
  if (ground) p->normal = curve->normal;
  return true;
}

static void draw_single(pl_stage* s, pl_bond* b, int thing) {
  pl_thing* t = &s->things.at[thing];
  pl_shape_fit fit = {0};
  if (!b->timed && !t->timed) fit = fit_places(s, b, t);
  if (fit.sphere) {
    pl_spot centre = pl_spot_fixed(fit.centre);
    pl_hint hint = b->hint;
    bool both = false;
    if (b->c->relation == PL_EQ) {
      if (hint == PL_HINT_NONE) {
        both = !pl_radius_is_length(s, b, fit.radius);
        hint = PL_HINT_ROD;
      }
      if (hint == PL_HINT_ROD || hint == PL_HINT_ROPE) {
        pl_add_rod(s, hint == PL_HINT_ROPE ? PL_SHAPE_ROPE : PL_SHAPE_ROD, b, &centre, &t->spot);
        pl_add_pivot(s, fit.centre);
        t->linked = true;
        if (!both) return;
      }
    } else if (inside_allowed(b->c, rises_with_distance(s, b, &centre, &t->spot))
               && hint != PL_HINT_TRACK && hint != PL_HINT_GROUND
               && (hint != PL_HINT_NONE || pl_radius_is_length(s, b, fit.radius))) {
      pl_add_rod(s, PL_SHAPE_ROPE, b, &centre, &t->spot);
      pl_add_pivot(s, fit.centre);
      t->linked = true;
      return;
    }
  }
  if (t->curved) return;  // its constraints were taken together
  if (draw_curve(s, b, thing, fit.sphere, fit.centre, fit.radius)) t->linked = t->curved = true;
}

// The thing whose own constraint it is: the one with the fewest other coordinates.
static int owner(const pl_stage* s, const pl_bond* b) {
  int best = PL_NO_THING;
  for (int i = 0; i < s->things.n; i++) {
    const pl_thing* t = &s->things.at[i];
    if (t->deps.n == 0 || !within(s, b, t)) continue;
    bool touches = false;
    for (int k = 0; k < b->deps.n; k++)
      touches |= pl_list_has(t->deps.at, t->deps.n, b->deps.at[k]);
    if (touches && (best < 0 || t->deps.n < s->things.at[best].deps.n)) best = i;
  }
  return best;
}

// A relation of several things that is no distance: the curve that it leaves to one of them while
// the others stay.
static void draw_relative(pl_stage* s, pl_bond* b) {
  int best = PL_NO_THING, most = 1;
  for (int i = 0; i < s->things.n; i++) {
    int own = 0;
    for (int k = 0; k < b->deps.n; k++)
      own += pl_list_has(s->things.at[i].deps.at, s->things.at[i].deps.n, b->deps.at[k]);
    if (own > most) {
      best = i;
      most = own;
    }
  }
  if (best < 0) return;
  int before = s->parts.n;
  if (draw_curve(s, b, best, false, NULL, 0)) {
    for (int i = before; i < s->parts.n; i++) s->parts.at[i].moves = true;
  }
}

// Is the thing held by a constraint of its own that is more than a fixed coordinate?
static bool own_rod(pl_stage* s, int thing) {
  for (int i = 0; i < s->bonds.n; i++) {
    const pl_bond* b = &s->bonds.at[i];
    if (b->settles < 0 && !b->velocity && !b->timed && owner(s, b) == thing) return true;
  }
  return false;
}

// Does the coordinate that it holds lie along gravity?
static bool holds_up(pl_stage* s, const pl_bond* b) {
  int thing = owner(s, b);
  if (thing < 0) return false;
  double along = 0;
  for (int j = 0; j < 3; j++) {
    pl_expr e = s->things.at[thing].spot.e[j];
    if (!pl_is_poison(e) && pl_has_symbol(s->pool, e, s->q[b->settles])) along += fabs(s->down[j]);
  }
  return along > 0;
}

// Which constraints shape the picture most: curves and radii; then what holds a thing up, what
// holds it anywhere; drives last.
static int turn_of(pl_stage* s, const pl_bond* b) {
  if (b->deps.n == 1 && (b->timed || s->angle[b->deps.at[0]])) return 3;
  if (b->settles < 0) return 0;
  int thing = owner(s, b);
  for (int j = 0; thing >= 0 && j < 3; j++) {
    pl_expr e = s->things.at[thing].spot.e[j];
    if (!pl_is_poison(e) && pl_has_symbol(s->pool, e, s->q[b->settles])
        && pl_kind_of(s->pool, e) != PL_SYMBOL)
      return 0;
  }
  return holds_up(s, b) ? 1 : 2;
}

// --------------------------------------------------------------------------------------------- all
void pl_stage_bonds(pl_stage* s) {
  read_bonds(s);
  pl_stage_bodies(s);
  pl_stage_space(s);
  if (!(s->size > 0)) s->size = 1;
  pl_stage_set(s, 0);
  pl_stage_ropes(s);
  for (int i = 0; i < s->bonds.n; i++) {
    pl_bond* b = &s->bonds.at[i];
    if (!b->velocity && !b->drawn && !b->touches && b->deps.n > 1) b->drawn = draw_pair(s, b);
  }
  pl_stage_space(s);
  pl_stage_set(s, 0);
  if (!(s->size > 0)) s->size = 1;
  pl_stage_view(s);
  pl_stage_rods(s);
  // curves first, then what is only held at a coordinate: across gravity first, so that it is seen
  // as the ground
  for (int round = 0; round < 4; round++) {
    for (int i = 0; i < s->bonds.n; i++) {
      pl_bond* b = &s->bonds.at[i];
      int turn = turn_of(s, b);
      if (b->drawn || b->velocity || b->touches || turn != round) continue;
      int thing = owner(s, b);
      if (thing < 0) {
        draw_relative(s, b);
        b->drawn = true;
        continue;
      }
      if (b->settles >= 0 && round >= 1
          && (s->things.at[thing].curved || s->things.at[thing].roped || own_rod(s, thing)))
        continue;
      draw_single(s, b, thing);
      b->drawn = true;
    }
  }
}
