// From the space of the model to the picture. Axes go where the model says (x down, z out); a
// motion that does not leave a plane is seen at a right angle, anything else from the right and
// above.
#include <math.h>
#include <string.h>

#include "scene/scene_impl.h"

typedef enum pl_way { PL_WAY_RIGHT, PL_WAY_UP, PL_WAY_OUT } pl_way;

static bool way_of(const char* direction, pl_way* way, double* sign) {
  static const struct {
    const char* name;
    pl_way way;
    double sign;
  } known[] = {{"right", PL_WAY_RIGHT, 1},
               {"left", PL_WAY_RIGHT, -1},
               {"up", PL_WAY_UP, 1},
               {"down", PL_WAY_UP, -1},
               {"out", PL_WAY_OUT, 1}};
  for (size_t i = 0; direction && i < sizeof known / sizeof known[0]; i++) {
    if (strcmp(direction, known[i].name) != 0) continue;
    *way = known[i].way;
    *sign = known[i].sign;
    return true;
  }
  return false;
}

// A way for each axis: said, or what is left, the axis of gravity upright first.
static void choose_ways(const pl_stage* s, pl_way way[3], double sign[3]) {
  bool has[3] = {0}, used[3] = {0};
  int n = s->model->n_axes;
  for (int j = 0; j < n; j++) {
    has[j] = s->model->axes[j].declared && way_of(s->model->axes[j].direction, &way[j], &sign[j])
             && !used[way[j]];
    if (has[j]) used[way[j]] = true;
  }
  for (int j = 0; j < n && !used[PL_WAY_UP]; j++) {  // the axis that gravity uses
    if (has[j] || !(fabs(s->down[j]) > 0.9)) continue;
    has[j] = used[PL_WAY_UP] = true;
    way[j] = PL_WAY_UP;
    sign[j] = s->down[j] < 0 ? 1 : -1;
  }
  // what is left: three axes are x out, y right, z up; two are x right, y up
  static const pl_way three[3] = {PL_WAY_OUT, PL_WAY_RIGHT, PL_WAY_UP},
                      fewer[3] = {PL_WAY_RIGHT, PL_WAY_UP, PL_WAY_OUT};
  const pl_way* order = n == 3 && !used[PL_WAY_RIGHT] && !used[PL_WAY_OUT] && !has[0] && !has[1]
                            ? three
                            : fewer;
  for (int j = 0; j < n; j++) {
    for (int k = 0; k < 3 && !has[j]; k++) {
      pl_way w = order[(k + (order == three ? j : 0)) % 3];
      if (used[w]) continue;
      has[j] = used[w] = true;
      way[j] = w;
      sign[j] = 1;
    }
  }
}

// Seen at one moment only: may things move along this axis, and does anything depend on it?
static bool may_vary(const pl_stage* s, int axis) {
  for (int i = 0; i < s->things.n; i++) {
    pl_expr e = s->things.at[i].spot.e[axis];
    if (pl_is_poison(e)
        || !(pl_has_role(s->pool, e, PL_R_COORD) || pl_has_role(s->pool, e, PL_R_TIME)))
      continue;
    if (pl_kind_of(s->pool, e) != PL_SYMBOL) return true;
    pl_symbol x = pl_symbol_of(s->pool, e);
    bool used = false;
    for (int k = 0; k < s->bonds.n; k++) used |= pl_has_symbol(s->pool, s->bonds.at[k].c->g, x);
    uint64_t q = pl_map_get(s->q_at, x.id);
    if (used && !(q && s->settled[q - 1])) return true;
    bool free = s->bonds.n == 0 || s->things.n > 1;
    if (!used && free && q && !s->settled[q - 1]) return true;
  }
  return false;
}

// The axis along which nothing moves nor differs, if any: it can be left out.
static int flat_axis(const pl_stage* s, const pl_way way[3]) {
  double most = 0;
  for (int j = 0; j < 3; j++) most = fmax(most, s->hi[j] - s->lo[j]);
  int flat = -1;
  for (int j = 0; j < 3; j++) {
    if (s->hi[j] - s->lo[j] > 1e-6 * most || (s->n_frames < 2 && may_vary(s, j))) continue;
    if (flat < 0 || way[j] == PL_WAY_OUT || (way[flat] == PL_WAY_UP && way[j] == PL_WAY_RIGHT))
      flat = j;
  }
  return flat;
}

void pl_stage_view(pl_stage* s) {
  int n = s->model->n_axes;
  pl_way way[3] = {PL_WAY_RIGHT, PL_WAY_UP, PL_WAY_OUT};
  double sign[3] = {1, 1, 1};
  choose_ways(s, way, sign);
  memset(&s->view, 0, sizeof s->view);
  s->view.n_axes = n;
  // one axis; the second component is the place across it, to the right or up
  if (n <= 1) {
    bool upright = n == 1 && way[0] == PL_WAY_UP;
    s->view.e[0][upright] = sign[0];
    s->view.e[1][!upright] = 1;
    s->view.plane = true;
    return;
  }
  int flat = n == 3 ? flat_axis(s, way) : 2;
  s->view.plane = flat >= 0;
  if (s->view.plane) {
    // the two that remain: upright stays upright, the other one lies to the right
    for (int j = 0; j < n; j++) {
      if (j == flat) continue;
      int other = 3 - j - flat;
      bool up = way[j] == PL_WAY_UP
                || (n == 3 && other != flat && way[other] != PL_WAY_UP && way[j] == PL_WAY_OUT);
      if (up) s->view.e[j][1] = way[j] == PL_WAY_UP ? sign[j] : -sign[j];
      else s->view.e[j][0] = sign[j];
    }
    return;
  }
  // orthographic, seen from 30° to the right and 22° above
  static const double turn = 0.5236, height = 0.384;
  const double right[2] = {cos(turn), -sin(height) * sin(turn)},
               out[2] = {-sin(turn), -sin(height) * cos(turn)};
  const double up[2] = {0, cos(height)};
  for (int j = 0; j < n; j++) {
    const double* e = way[j] == PL_WAY_RIGHT ? right : way[j] == PL_WAY_UP ? up : out;
    for (int k = 0; k < 2; k++) s->view.e[j][k] = sign[j] * e[k];
  }
}

void pl_view_project(const pl_view* v, const double x[3], double xy[2]) {
  int n = v->n_axes < 2 ? 2 : v->n_axes;
  xy[0] = xy[1] = 0;
  for (int j = 0; j < n; j++) {
    xy[0] += x[j] * v->e[j][0];
    xy[1] += x[j] * v->e[j][1];
  }
}
