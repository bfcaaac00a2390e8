// What has a place: masses, bodies, points, and the origin for rods and ropes that end there.
#include <math.h>
#include <string.h>

#include "scene/scene_impl.h"

pl_spot pl_spot_fixed(const double x[3]) {
  pl_spot p = {.fixed = true, .sense = 1, .angle = pl_poison()};
  memcpy(p.at, x, sizeof p.at);
  p.side = x[1];
  return p;
}

pl_spot pl_spot_of(const pl_stage* s, const pl_point* point) {
  pl_spot p = {.sense = 1, .angle = pl_poison()};
  for (int j = 0; j < 3; j++) p.e[j] = j < point->n ? point->at[j] : pl_poison();
  (void)s;
  return p;
}

bool pl_list_has(const int* list, int n, int x) {
  for (int i = 0; i < n; i++) {
    if (list[i] == x) return true;
  }
  return false;
}

// Coordinates that occur in e, added to those there are.
void pl_collect_coords(pl_stage* s, pl_expr e, int** deps, int* n, bool* timed) {
  if (pl_is_poison(e)) return;
  int count = pl_symbols_in(s->pool, e, NULL, 0);
  pl_symbol* symbols = PL_ARRAY(s->arena, pl_symbol, count + 1);
  pl_symbols_in(s->pool, e, symbols, count);
  int* all = PL_ARRAY(s->arena, int, *n + count + 1);
  if (*n) memcpy(all, *deps, (size_t)*n * sizeof(int));
  for (int i = 0; i < count; i++) {
    const pl_symbol_info* info = pl_symbol_get(s->pool, symbols[i]);
    if (info->role == PL_R_TIME) *timed = true;
    uint64_t k = pl_map_get(s->q_at, symbols[i].id);
    if (!k && info->base.id) k = pl_map_get(s->q_at, info->base.id);
    bool known = !k;
    for (int j = 0; j < *n && !known; j++) known = all[j] == (int)k - 1;
    if (!known) all[(*n)++] = (int)k - 1;
  }
  *deps = all;
}

static void find_deps(pl_stage* s, pl_thing* t) {
  int* deps = NULL;
  int n = 0;
  for (int j = 0; j < 3; j++) pl_collect_coords(s, t->spot.e[j], &deps, &n, &t->timed);
  t->deps.at = deps;
  t->deps.n = t->deps.cap = n;
}

static pl_thing* add(pl_stage* s, pl_thing_kind kind, const char* label, const char* name,
                     const pl_point* point) {
  pl_thing t = {.kind = kind,
                .label = label,
                .name = name,
                .spot = pl_spot_of(s, point),
                .mass = pl_poison(),
                .sense = 1};
  find_deps(s, &t);
  pl_push(s->arena, s->things, t);
  return &s->things.at[s->things.n - 1];
}

static const char* mass_label(const pl_stage* s, const pl_mass* m) {
  if (!m->name.generated) return m->name.text;
  if (pl_kind_of(s->pool, m->mass) == PL_SYMBOL)
    return pl_symbol_get(s->pool, pl_symbol_of(s->pool, m->mass))->name;
  return "";
}

void pl_stage_things(pl_stage* s) {
  const pl_model* m = s->model;
  for (int i = 0; i < m->masses.n; i++) {
    pl_thing* t = add(s, PL_THING_MASS, mass_label(s, &m->masses.at[i]), m->masses.at[i].name.text,
                      &m->masses.at[i].point);
    t->mass = m->masses.at[i].mass;
  }
  for (int i = 0; i < m->bodies.n; i++) {
    const pl_body* b = &m->bodies.at[i];
    pl_thing* t = add(s, PL_THING_BODY, b->name.text, b->name.text, &b->centre);
    t->mass = b->mass;
    t->body = b;
  }
  for (int i = 0; i < m->points.n; i++) {
    add(s, PL_THING_POINT, m->points.at[i].name.text, m->points.at[i].name.text,
        &m->points.at[i].point);
  }
}

// ------------------------------------------------------------------------------------------- space
void pl_stage_space(pl_stage* s) {
  for (int j = 0; j < 3; j++) {
    s->lo[j] = INFINITY;
    s->hi[j] = -INFINITY;
  }
  int stride = s->things.n > 100 ? 8 : 1;
  for (int f = 0; f < s->n_frames;
       f += (f + stride >= s->n_frames && f + 1 < s->n_frames) ? s->n_frames - 1 - f : stride) {
    pl_stage_set(s, f);
    for (int i = 0; i < s->things.n; i++) {
      double x[3];
      pl_stage_spot(s, &s->things.at[i].spot, x);
      double reach = s->things.at[i].reach;
      for (int j = 0; j < 3; j++) {
        if (!isfinite(x[j])) continue;
        s->lo[j] = fmin(s->lo[j], x[j] - (j < 2 ? reach : 0));
        s->hi[j] = fmax(s->hi[j], x[j] + (j < 2 ? reach : 0));
      }
    }
  }
  double size = 0;
  for (int j = 0; j < 3; j++) {
    if (!(s->hi[j] >= s->lo[j])) s->lo[j] = s->hi[j] = 0;
    size = fmax(size, s->hi[j] - s->lo[j]);
  }
  // what hardly moves is seen among the lengths that are given
  double least = 0, length = pl_stage_length(s);
  for (int j = 0; j < 3; j++) least = fmax(least, fmax(fabs(s->lo[j]), fabs(s->hi[j])));
  if (!(least > 0) || least > 3 * length) least = length;
  s->size = fmax(size, 0.8 * least);
}
