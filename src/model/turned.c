// A model whose bodies have Euler angles, as one in which they have unit quaternions: the form that
// is integrated, because it has no singular attitude. The coordinates of the angles φ, ϑ, ψ give
// their places to q1, q2, q3, q0 comes behind all; where the motion itself speaks of an angle in a
// way that is not smooth at every attitude (a spring on φ, a torque about it, ϑ held at 30°), its
// body keeps its angles.
#include <string.h>

#include "model_impl.h"
#include "smooth.h"

// A body that may be turned: its angles by symbol, coordinates or families of them.
typedef struct turned_body {
  int spatial;
  pl_symbol angle[3], q[4];  // q[0]: the one that is new
  bool family, dropped;
} turned_body;

typedef struct turning {
  pl_job* job;
  pl_arena* arena;
  pl_model* from;
  pl_model* to;
  PL_VEC(turned_body) bodies;
  PL_VEC(pl_triple) triples;  // of the expression at work: which angles it speaks of
  PL_VEC(int) owner;          // body of each
  bool again;                 // a body was dropped
  const char** why;
} turning;

// ------------------------------------------------------------------------------------ which bodies
static const pl_coord* coordinate(const pl_model* m, pl_symbol s) {
  for (int i = 0; i < m->coords.n; i++)
    if (m->coords.at[i].symbol.id == s.id) return &m->coords.at[i];
  return NULL;
}

static bool used_before(const turning* t, pl_symbol s) {
  for (int i = 0; i < t->bodies.n; i++)
    for (int k = 0; k < 3; k++)
      if (t->bodies.at[i].angle[k].id == s.id) return true;
  return false;
}

static bool same_bounds(const pl_coord* a, const pl_coord* b) {
  return pl_same(a->lo, b->lo) && pl_same(a->hi, b->hi);
}

// Three coordinates of its own: plain ones, or elements of three like families at one index.
static bool find_angles(const turning* t, const pl_spatial* b, turned_body* out) {
  const pl_pool* p = t->from->pool;
  const pl_coord* of[3];
  *out = (turned_body){0};
  if (b->form != PL_AXES_EULER) return false;
  for (int k = 0; k < 3; k++) {
    pl_kind kind = pl_kind_of(p, b->axes[k]);
    if ((kind != PL_SYMBOL && kind != PL_AT) || (kind == PL_AT && pl_dots_of(p, b->axes[k]) != 0))
      return false;
    out->angle[k] = pl_symbol_of(p, b->axes[k]);
    out->family = kind == PL_AT;
    of[k] = coordinate(t->from, out->angle[k]);
    if (of[k] == NULL || used_before(t, out->angle[k]) || pl_kind_of(p, b->axes[0]) != kind)
      return false;
    if (out->family
        && (!same_bounds(of[0], of[k])
            || !pl_same(pl_arg(p, b->axes[0], 0), pl_arg(p, b->axes[k], 0))))
      return false;
    for (int j = 0; j < k; j++)
      if (out->angle[j].id == out->angle[k].id) return false;
  }
  return true;
}

static pl_symbol component(const turning* t, const pl_spatial* b, bool family, int k) {
  pl_symbol_info info = {
      .name = pl_format(t->arena, "%s.q%d", b->name.text, k),
      .ascii = pl_format(t->arena, "%s.q%d", b->name.ascii ? b->name.ascii : b->name.text, k),
      .role = family ? PL_R_ARRAY : PL_R_COORD,
      .class = PL_C_COORD,
      .dimension = pl_dimension_one(),
      .dimension_known = true};
  return pl_symbol_make(t->from->pool, &info);
}

static void find_bodies(turning* t) {
  for (int i = 0; i < t->from->spatials.n; i++) {
    const pl_spatial* b = &t->from->spatials.at[i];
    turned_body body;
    if (!find_angles(t, b, &body)) continue;
    body.spatial = i;
    for (int k = 0; k < 4; k++) body.q[k] = component(t, b, body.family, k);
    pl_push(t->arena, t->bodies, body);
  }
}

static pl_expr at_index(const turning* t, pl_symbol s, bool family, pl_expr index) {
  return family ? pl_at(t->from->pool, s, 0, index) : pl_sym(t->from->pool, s);
}

static pl_triple triple_of(const turning* t, const turned_body* b, pl_expr index) {
  pl_expr angle[3], q[4];
  for (int k = 0; k < 3; k++) angle[k] = at_index(t, b->angle[k], b->family, index);
  for (int k = 0; k < 4; k++) q[k] = at_index(t, b->q[k], b->family, index);
  return pl_triple_make(t->from->pool, angle, q);
}

// ------------------------------------------------------------------------------------- expressions
// The body that a symbol gives an angle of, -1 none.
static int body_of(const turning* t, pl_symbol s, bool family) {
  for (int i = 0; i < t->bodies.n; i++)
    for (int k = 0; k < 3; k++)
      if (t->bodies.at[i].angle[k].id == s.id && t->bodies.at[i].family == family) return i;
  return -1;
}

static void add_triple(turning* t, int body, pl_expr index) {
  pl_triple triple = triple_of(t, &t->bodies.at[body], index);
  for (int i = 0; i < t->triples.n; i++)
    if (pl_same(t->triples.at[i].angle[0], triple.angle[0])) return;
  pl_push(t->arena, t->triples, triple);
  pl_push(t->arena, t->owner, body);
}

static void find_triples(turning* t, pl_map* seen, pl_expr e) {
  const pl_pool* p = t->from->pool;
  if (pl_is_poison(e) || pl_map_get(seen, e.id)) return;
  pl_map_set(seen, e.id, 1);
  pl_kind kind = pl_kind_of(p, e);
  if (kind == PL_SYMBOL) {
    pl_symbol s = pl_symbol_of(p, e);
    const pl_symbol_info* info = pl_symbol_get(p, s);
    while (info->role == PL_R_VELOCITY || info->role == PL_R_ACCELERATION) {
      s = info->base;
      info = pl_symbol_get(p, s);
    }
    int body = body_of(t, s, false);
    if (body >= 0) add_triple(t, body, pl_poison());
  }
  if (kind == PL_AT) {
    int body = body_of(t, pl_symbol_of(p, e), true);
    if (body >= 0) add_triple(t, body, pl_arg(p, e, 0));
  }
  for (int i = 0; i < pl_n_args(p, e); i++) find_triples(t, seen, pl_arg(p, e, i));
}

static void drop(turning* t, int body, pl_expr e) {
  turned_body* b = &t->bodies.at[body];
  if (b->dropped) return;
  b->dropped = t->again = true;
  if (*t->why == NULL) *t->why = pl_expr_text(t->arena, t->from->pool, e);
}

static pl_expr turn_expression(turning* t, pl_expr e, bool required) {
  t->triples.n = t->owner.n = 0;
  find_triples(t, pl_map_make(t->arena), e);
  for (int i = 0; i < t->triples.n; i++) {
    if (t->bodies.at[t->owner.at[i]].dropped) continue;
    pl_expr better = pl_smooth(t->arena, t->from->pool, &t->triples.at[i], e);
    if (!pl_is_poison(better)) e = better;
    else if (required) drop(t, t->owner.at[i], e);
  }
  return e;
}

static void turn_slot(void* user, const pl_slot* slot) {
  turning* t = user;
  pl_slot_kind k = slot->kind;
  bool required = k == PL_SLOT_POINT || k == PL_SLOT_MASS || k == PL_SLOT_GRAVITY
                  || k == PL_SLOT_LOAD || k == PL_SLOT_CONSTRAINT || k == PL_SLOT_CHOOSE
                  || k == PL_SLOT_EVENT;
  if (!pl_is_poison(*slot->at) && (required || k == PL_SLOT_OUTPUT))
    *slot->at = turn_expression(t, *slot->at, required);
}

// ---------------------------------------------------------------------------------------- the copy
#define PL_COPY_LIST(t, field)                                     \
  do {                                                             \
    (t)->to->field.cap = (t)->to->field.n = 0;                     \
    (t)->to->field.at = NULL;                                      \
    for (int i = 0; i < (t)->from->field.n; i++)                   \
      pl_push((t)->arena, (t)->to->field, (t)->from->field.at[i]); \
  } while (0)

static void copy_lists(turning* t) {
  PL_COPY_LIST(t, coords);
  PL_COPY_LIST(t, masses);
  PL_COPY_LIST(t, bodies);
  PL_COPY_LIST(t, spatials);
  PL_COPY_LIST(t, points);
  PL_COPY_LIST(t, gravities);
  PL_COPY_LIST(t, loads);
  PL_COPY_LIST(t, constraints);
  PL_COPY_LIST(t, restitutions);
  PL_COPY_LIST(t, frictions);
  PL_COPY_LIST(t, events);
  PL_COPY_LIST(t, outputs);
  for (int i = 0; i < t->to->events.n; i++) {
    pl_event* e = &t->to->events.at[i];
    PL_VEC(pl_action) actions = {0};
    for (int k = 0; k < e->actions.n; k++) pl_push(t->arena, actions, e->actions.at[k]);
    e->actions.at = actions.at;
  }
  pl_choose* c = &t->to->choose;
  c->maps = PL_ARRAY(t->arena, struct pl_map_equation, c->n_maps + 1);
  if (c->n_maps) memcpy(c->maps, t->from->choose.maps, (size_t)c->n_maps * sizeof *c->maps);
  // the start is found in the angles
  t->to->inits.n = t->to->branches.n = 0;
  t->to->asks.n = t->to->plots.n = t->to->draws.n = 0;
}

// φ, ϑ, ψ give their places to q1, q2, q3.
static void copy_coordinates(turning* t) {
  for (int i = 0; i < t->bodies.n; i++) {
    turned_body* b = &t->bodies.at[i];
    if (b->dropped) continue;
    pl_coord scalar = {0};
    for (int k = 0; k < t->to->coords.n; k++) {
      pl_coord* c = &t->to->coords.at[k];
      for (int j = 0; j < 3; j++) {
        if (c->symbol.id != b->angle[j].id) continue;
        c->symbol = b->q[1 + j];
        scalar = *c;
        break;
      }
    }
    scalar.symbol = b->q[0];
    pl_push(t->arena, t->to->coords, scalar);
  }
}

static void copy_spatial(turning* t, const turned_body* b) {
  pl_pool* p = t->from->pool;
  const pl_spatial* old = &t->from->spatials.at[b->spatial];
  pl_spatial* s = &t->to->spatials.at[b->spatial];
  pl_expr index = b->family ? pl_arg(p, old->axes[0], 0) : pl_poison(), unit = pl_int(p, 0);
  s->form = PL_AXES_QUATERNION;
  for (int k = 0; k < 9; k++)
    s->axes[k] = k < 4 ? at_index(t, b->q[k], b->family, index) : pl_poison();
  for (int k = 0; k < 4; k++) unit = pl_add(p, unit, pl_square(p, s->axes[k]));
  pl_triple triple = triple_of(t, b, index);
  memcpy(s->spin, triple.spin[1], sizeof s->spin);
  const char* name = pl_format(t->arena, "%s.unit", old->name.text);
  pl_constraint c = {.name = {.text = name, .ascii = name, .index = old->name.index},
                     .left = unit,
                     .right = pl_int(p, 1),
                     .relation = PL_EQ,
                     .block = old->block,
                     .span = old->span,
                     .body = old->name.text,
                     .axes = PL_AXES_QUATERNION};
  c.g = pl_sub(p, c.left, c.right);
  pl_push(t->arena, t->to->constraints, c);
}

// A torque about an angle of its own is not smooth.
static void drop_by_torques(turning* t) {
  for (int i = 0; i < t->from->loads.n; i++) {
    pl_symbol s = t->from->loads.at[i].coordinate;
    int body = s.id ? body_of(t, s, false) : -1;
    if (body >= 0) drop(t, body, pl_sym(t->from->pool, s));
  }
}

// Where the angles went: places among the coordinates one by one.
static bool find_places(turning* t, pl_turned* out) {
  const pl_pool* p = t->from->pool;
  pl_flat_coords flat = pl_model_flat_coords(t->to, t->arena),
                 old = pl_model_flat_coords(t->from, t->arena);
  pl_map* at = pl_map_make(t->arena);
  for (int i = 0; i < flat.n; i++) pl_map_set(at, flat.at[i].id, (uint64_t)i + 1);
  for (int i = 0; i < t->bodies.n; i++) {
    const turned_body* b = &t->bodies.at[i];
    for (int k = 0; !b->dropped && k < old.n; k++) {
      if (pl_symbol_of(p, old.at[k]).id != b->angle[0].id) continue;
      pl_triple triple = triple_of(t, b, b->family ? pl_arg(p, old.at[k], 0) : pl_poison());
      pl_turned_place place = {.scalar = (int)pl_map_get(at, triple.q[0].id) - 1};
      for (int j = 0; j < 3; j++) {
        place.angle[j] = triple.angle[j];
        place.at[j] = (int)pl_map_get(at, triple.q[1 + j].id) - 1;
        if (place.at[j] < 0) return false;
      }
      if (place.scalar < 0) return false;
      pl_push(t->arena, out->places, place);
    }
  }
  return true;
}

// Copies and rewrites; false when a body had to be dropped: then all begins anew.
static bool attempt(turning* t) {
  *t->to = *t->from;
  t->again = false;
  copy_lists(t);
  drop_by_torques(t);
  copy_coordinates(t);
  for (int i = 0; i < t->bodies.n; i++) {
    // their own data are not written in angles any more
    pl_spatial* s = &t->to->spatials.at[t->bodies.at[i].spatial];
    if (t->bodies.at[i].dropped) continue;
    for (int k = 0; k < 9; k++) s->axes[k] = s->turn[k] = pl_poison();
    for (int k = 0; k < 3; k++) s->spin[k] = pl_poison();
  }
  pl_model_each_slot(t->to, turn_slot, t);
  if (t->again) return false;
  for (int i = 0; i < t->bodies.n; i++)
    if (!t->bodies.at[i].dropped) copy_spatial(t, &t->bodies.at[i]);
  return true;
}

static int count_turned(const turning* t) {
  int n = 0;
  for (int i = 0; i < t->bodies.n; i++) n += !t->bodies.at[i].dropped;
  return n;
}

bool pl_model_turned(pl_job* job, pl_model* m, pl_turned* out) {
  *out = (pl_turned){0};
  turning t = {.job = job,
               .arena = job->arena,
               .from = m,
               .to = PL_NEW(job->arena, pl_model),
               .why = &out->why};
  find_bodies(&t);
  while (count_turned(&t) > 0 && !attempt(&t)) continue;
  if (count_turned(&t) == 0) return false;
  out->model = t.to;
  return find_places(&t, out) && out->places.n > 0;
}
