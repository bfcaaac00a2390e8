// Models without masses, bodies or points: what has no place gets one. Two points whose distance a
// constraint keeps in squares; coordinates named like axes with equal inertia are a point; an angle
// is an arm; any other length a point on a line, and quadratic potentials are springs between them.
#include <math.h>
#include <string.h>

#include "scene/scene_impl.h"

enum { MOST_POINTS = 12 };

static pl_thing* add_thing(pl_stage* s, pl_thing_kind kind, const char* label, const pl_expr* e,
                           int n) {
  pl_thing t = {.kind = kind, .label = label, .name = label, .mass = pl_poison(), .sense = 1};
  pl_point at = {.n = n, .at = {e[0], n > 1 ? e[1] : pl_poison(), n > 2 ? e[2] : pl_poison()}};
  t.spot = pl_spot_of(s, &at);
  int *deps = NULL, count = 0;
  for (int j = 0; j < n; j++) pl_collect_coords(s, e[j], &deps, &count, &t.timed);
  t.deps.at = deps;
  t.deps.n = t.deps.cap = count;
  pl_push(s->arena, s->things, t);
  return &s->things.at[s->things.n - 1];
}

// The model with other axes; the one that was handed in stays as it is.
static void set_axes(pl_stage* s, int n, const char* const* names, const char* const* directions) {
  pl_model* m = PL_NEW(s->arena, pl_model);
  *m = *s->model;
  m->n_axes = n;
  for (int j = 0; j < 3; j++)
    m->axes[j] = (pl_axis){j < n ? names[j] : "", j < n ? names[j] : "", directions[j],
                           directions[j] != NULL};
  s->model = m;
}

// -------------------------------------------------------------------------- constraints in squares
// The root of a term that is a square: (x - a)² or R² sin²A.  Poison for others.
static pl_expr root_of(pl_stage* s, pl_expr e) {
  pl_pool* p = s->pool;
  long k;
  if (pl_kind_of(p, e) == PL_POW && pl_is_int(p, pl_arg(p, e, 1), &k) && k == 2)
    return pl_arg(p, e, 0);
  if (pl_kind_of(p, e) != PL_MUL) return pl_poison();
  pl_expr product = pl_int(p, 1);
  for (int i = 0; i < pl_n_args(p, e); i++) {
    pl_expr r = root_of(s, pl_arg(p, e, i));
    if (pl_is_poison(r)) return pl_poison();
    product = pl_mul(p, product, r);
  }
  return product;
}

static bool has_coordinate(pl_stage* s, pl_expr e) {
  return pl_has_role(s->pool, e, PL_R_COORD) || pl_has_role(s->pool, e, PL_R_TIME);
}

// Parts of a difference: those with the first of its coordinates, and the rest with the other sign.
static void split(pl_stage* s, pl_expr e, pl_symbol first, pl_expr* own, pl_expr* other) {
  pl_pool* p = s->pool;
  int n = pl_kind_of(p, e) == PL_ADD ? pl_n_args(p, e) : 1;
  *own = *other = pl_int(p, 0);
  for (int i = 0; i < n; i++) {
    pl_expr term = pl_kind_of(p, e) == PL_ADD ? pl_arg(p, e, i) : e;
    if (pl_has_symbol(p, term, first)) *own = pl_add(p, *own, term);
    else *other = pl_sub(p, *other, term);
  }
}

static bool negative(const pl_stage* s, pl_expr e) {
  const pl_pool* p = s->pool;
  return pl_kind_of(p, e) == PL_MUL && pl_n_args(p, e) > 0 && pl_is_number(p, pl_arg(p, e, 0))
         && pl_number_sign(p, pl_arg(p, e, 0)) < 0;
}

static bool same_spot(const pl_spot* a, const pl_expr* e) {
  return pl_same(a->e[0], e[0]) && pl_same(a->e[1], e[1]);
}

static void add_once(pl_stage* s, const pl_expr* e) {
  for (int i = 0; i < s->things.n; i++) {
    if (same_spot(&s->things.at[i].spot, e)) return;
  }
  if (s->things.n < MOST_POINTS && (has_coordinate(s, e[0]) || has_coordinate(s, e[1])))
    add_thing(s, PL_THING_MASS, "", e, 2);
}

// (x - R cos A)² + (R sin A)² = L²: the points (x, 0) and (R cos A, R sin A).
static bool read_squares(pl_stage* s, const pl_constraint* c) {
  pl_pool* p = s->pool;
  pl_expr g = c->g, component[2];
  int n = 0;
  if (pl_kind_of(p, g) != PL_ADD) return false;
  for (int i = 0; i < pl_n_args(p, g); i++) {
    pl_expr term = pl_arg(p, g, i), root = root_of(s, term);
    if (!has_coordinate(s, term)) continue;
    if (pl_is_poison(root) || n == 2) return false;
    component[n++] = root;
  }
  if (n != 2) return false;
  pl_symbol found[16];
  pl_symbol first = {0};
  // the coordinate that stands alone belongs to the first point
  for (int k = 0; k < 2; k++) {
    int m = pl_symbols_in(p, component[k], found, 16);
    for (int i = 0; i < m && i < 16; i++) {
      uint64_t q = pl_map_get(s->q_at, found[i].id);
      if (q && (!first.id || (s->angle[pl_map_get(s->q_at, first.id) - 1] && !s->angle[q - 1])))
        first = found[i];
    }
  }
  pl_expr a[2], b[2];
  bool swap = !pl_has_symbol(p, component[0], first) && pl_has_symbol(p, component[1], first);
  for (int k = 0; k < 2; k++) {
    pl_expr e = component[swap ? 1 - k : k];
    split(s, e, first, &a[k], &b[k]);
    bool lone = pl_is_zero_node(p, a[k]) || pl_is_zero_node(p, b[k]);  // its sign is free
    if (lone && negative(s, a[k])) a[k] = pl_neg(p, a[k]);
    if (lone && negative(s, b[k])) b[k] = pl_neg(p, b[k]);
    if (negative(s, a[k]) && negative(s, b[k])) {
      a[k] = pl_neg(p, a[k]);
      b[k] = pl_neg(p, b[k]);
    }
  }
  add_once(s, b);
  add_once(s, a);
  return true;
}

// ---------------------------------------------------------------------------------------- energies
static pl_expr inertia(pl_stage* s, pl_expr L, int k);

static pl_expr lagrangian_of(pl_stage* s) {
  pl_expr L = pl_int(s->pool, 0);
  for (int i = 0; i < s->model->loads.n; i++) {
    const pl_load* l = &s->model->loads.at[i];
    if (l->kind == PL_L_LAGRANGIAN || l->kind == PL_L_KINETIC) L = pl_add(s->pool, L, l->value);
    if (l->kind == PL_L_POTENTIAL) L = pl_sub(s->pool, L, l->value);
  }
  return L;
}

// A coordinate of unknown dimension whose inertia is one of turning is an angle.
static void find_turning(pl_stage* s, pl_expr L) {
  for (int k = 0; k < s->n_q; k++) {
    pl_dimension d;
    bool unknown = !pl_symbol_get(s->pool, s->q[k])->dimension_known;
    if (!unknown || !s->model->uses_units || !pl_model_dimension(s->model, inertia(s, L, k), &d))
      continue;
    if (pl_dimension_equal(d, pl_dimension_of(2, 1, 0))) s->angle[k] = true;
  }
}

static pl_expr inertia(pl_stage* s, pl_expr L, int k) {
  return pl_diff(s->pool, pl_diff(s->pool, L, s->v[k]), s->v[k]);
}

// x, y (z) with the same constant inertia.
static bool read_point(pl_stage* s, pl_expr L) {
  static const char* const names[3] = {"x", "y", "z"};
  pl_expr e[3], first = pl_poison();
  int n = 0;
  for (int j = 0; j < 3; j++) {
    for (int k = 0; k < s->n_q; k++) {
      if (strcmp(pl_symbol_get(s->pool, s->q[k])->name, names[j]) != 0 || j != n) continue;
      pl_expr I = inertia(s, L, k);
      if (pl_is_zero_node(s->pool, I) || (n > 0 && !pl_same(I, first))) continue;
      first = I;
      e[n++] = pl_sym(s->pool, s->q[k]);
    }
  }
  if (n < 2) return false;
  static const char* const none[3] = {NULL, NULL, NULL};
  set_axes(s, n, names, none);
  add_thing(s, PL_THING_MASS, "", e, n);
  return true;
}

// Springs of the quadratic part of the potential: -d²L/dq_i dq_j between two, what is left to a
// wall.
static void add_springs(pl_stage* s, pl_expr L, const int* q, const int* thing, int n,
                        const pl_spot* wall) {
  for (int i = 0; i < n; i++) {
    double rest = -pl_stage_eval(s, pl_diff(s->pool, pl_diff(s->pool, L, s->q[q[i]]), s->q[q[i]]));
    for (int j = 0; j < n; j++) {
      if (j == i) continue;
      double k = pl_stage_eval(s, pl_diff(s->pool, pl_diff(s->pool, L, s->q[q[i]]), s->q[q[j]]));
      if (!isfinite(k) || !(k > 0)) continue;
      rest -= k;
      if (j < i) continue;
      pl_part* p = pl_stage_add(s, PL_SHAPE_SPRING, "", "");
      p->spot[0] = s->things.at[thing[i]].spot;
      p->spot[1] = s->things.at[thing[j]].spot;
      p->moves = true;
    }
    if (!wall || !(rest > 1e-9)) continue;
    pl_part* p = pl_stage_add(s, PL_SHAPE_SPRING, "", "");
    p->spot[0] = *wall;
    p->spot[1] = s->things.at[thing[i]].spot;
    p->moves = true;
  }
}

static void scale_gravity(pl_stage* s, double by) {
  for (int i = 0; i < s->model->params.n; i++) {
    const pl_symbol_info* info = pl_symbol_get(s->pool, s->model->params.at[i].symbol);
    if (info->dimension_known && pl_dimension_equal(info->dimension, pl_dimension_of(1, 0, -2)))
      s->value[s->model->params.at[i].symbol.id] *= by;
  }
}

// Angles alone: arms beside each other, hanging where the potential is least at zero.
static void read_arms(pl_stage* s, pl_expr L) {
  static const char* const names[3] = {"x", "y", ""};
  static const char* const ways[3] = {"right", "up", NULL};
  pl_pool* p = s->pool;
  int q[MOST_POINTS], thing[MOST_POINTS], n = 0;
  double length = pl_stage_length(s);
  char text[32];
  snprintf(text, sizeof text, "%.6g", length);
  pl_expr l = pl_number_from_text(p, text, strlen(text));
  set_axes(s, 2, names, ways);
  for (int k = 0; k < s->n_q && n < MOST_POINTS; k++) {
    if (!s->angle[k]) continue;
    double old = s->value[s->q[k].id];
    s->value[s->q[k].id] = 0;
    scale_gravity(s, 1e9);  // what turns must not hide where gravity pulls
    // V = -L has a maximum there
    bool up = pl_stage_eval(s, pl_diff(p, pl_diff(p, L, s->q[k]), s->q[k])) > 0;
    scale_gravity(s, 1e-9);
    s->value[s->q[k].id] = old;
    pl_expr theta = pl_sym(p, s->q[k]),
            x0 = pl_mul_n(p, (pl_expr[]){pl_int(p, n), pl_ratio(p, 3, 2), l}, 3);
    pl_expr e[2] = {pl_add(p, x0, pl_mul(p, l, pl_call(p, PL_SIN, theta))),
                    pl_mul(p, l, pl_call(p, PL_COS, theta))};
    if (!up) e[1] = pl_neg(p, e[1]);
    q[n] = k;
    thing[n++] = s->things.n;
    add_thing(s, PL_THING_MASS, "", e, 2);
  }
  add_springs(s, L, q, thing, n, NULL);
}

// Lengths that are no place: points on a line.
static void read_line(pl_stage* s, pl_expr L) {
  int q[MOST_POINTS], thing[MOST_POINTS], n = 0;
  static const double zero[3] = {0, 0, 0};
  for (int k = 0; k < s->n_q && n < MOST_POINTS; k++) {
    if (s->angle[k]) continue;
    pl_expr e = pl_sym(s->pool, s->q[k]);
    bool heavy = !pl_is_zero_node(s->pool, inertia(s, L, k));
    q[n] = k;
    thing[n++] = s->things.n;
    add_thing(s, heavy ? PL_THING_MASS : PL_THING_POINT, pl_symbol_get(s->pool, s->q[k])->name, &e,
              1);
  }
  const char* names[3] = {n == 1 ? s->things.at[0].label : "", "", ""};
  static const char* const ways[3] = {"right", NULL, NULL};
  set_axes(s, 1, names, ways);
  pl_spot wall = pl_spot_fixed(zero);
  int before = s->parts.n;
  add_springs(s, L, q, thing, n, &wall);
  if (s->parts.n > before) {
    pl_part* p = pl_stage_add(s, PL_SHAPE_POINT, "", "");
    p->n = 1;
    p->spot[0] = wall;
  }
}

void pl_stage_schematic(pl_stage* s) {
  static const char* const names[3] = {"x", "y", ""};
  static const char* const ways[3] = {"right", "up", NULL};
  bool read = false;
  for (int i = 0; i < s->model->constraints.n; i++) {
    if (!s->model->constraints.at[i].has_velocity)
      read |= read_squares(s, &s->model->constraints.at[i]);
  }
  if (read) {
    set_axes(s, 2, names, ways);
    return;
  }
  pl_expr L = lagrangian_of(s);
  find_turning(s, L);
  if (read_point(s, L)) return;
  bool lengths = false, angles = false;
  for (int k = 0; k < s->n_q; k++) *(s->angle[k] ? &angles : &lengths) = true;
  if (lengths) read_line(s, L);
  else if (angles) read_arms(s, L);
}
