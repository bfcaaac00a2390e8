// Families: the instances of `for` blocks, the coordinates one by one, sets of members.
//
// Bounds may use parameters with numbers and outer indices. A pattern with N instances is not
// written out.
#include "model_impl.h"

#include <math.h>
#include <stdlib.h>

enum { MAX_BLOCK_DEPTH = 16 };

// ---------------------------------------------------------------------------------------- integers
pl_index_values pl_index_values_make(const pl_model* m, pl_arena* a) {
  return (pl_index_values){m, pl_model_values(m, a)};
}

static const double largest_index = 4e15;  // doubles count exactly up to 2^53

bool pl_index_eval(const pl_index_values* v, pl_expr e, long* out) {
  if (pl_is_poison(e)) return false;
  if (pl_is_int(v->model->pool, e, out))
    return *out<(long)largest_index&& * out> - (long)largest_index;
  double x = pl_eval(v->model->pool, e, v->value);
  if (!(fabs(x) < largest_index) || x != floor(x)) return false;
  *out = (long)x;
  return true;
}

// ----------------------------------------------------------------------------------------- walking
typedef struct block_walk {
  const pl_block* chain[MAX_BLOCK_DEPTH];  // outer first
  int depth;
  pl_index_values* v;
  pl_instance_visit* visit;
  void* user;
  long* budget;
  bool ends_only;  // of the innermost loop
  const pl_block* culprit;
} block_walk;

static pl_walk_result walk_level(block_walk* w, int level) {
  if (level == w->depth) {
    if (--*w->budget < 0) return PL_WALK_TOO_MANY;
    return w->visit(w->user, w->v) ? PL_WALK_DONE : PL_WALK_STOPPED;
  }
  const pl_block* b = w->chain[level];
  long lo, hi, step = 1;
  w->culprit = b;
  if (!pl_index_eval(w->v, b->lo, &lo) || !pl_index_eval(w->v, b->hi, &hi))
    return PL_WALK_BAD_BOUND;
  if (!pl_is_poison(b->step) && !pl_index_eval(w->v, b->step, &step)) return PL_WALK_BAD_BOUND;
  if (step == 0) return PL_WALK_ZERO_STEP;
  long last = step > 0 ? (hi < lo ? -1 : (hi - lo) / step) : (hi > lo ? -1 : (lo - hi) / -step);
  if (!w->visit && level == w->depth - 1) {  // only counted
    *w->budget = last < *w->budget ? *w->budget - last - 1 : -1;
    return *w->budget < 0 ? PL_WALK_TOO_MANY : PL_WALK_DONE;
  }
  bool jump = w->ends_only && level == w->depth - 1 && last > 1;
  for (long k = 0; k <= last; k += jump ? last : 1) {
    w->v->value[b->index.id] = (double)(lo + k * step);
    pl_walk_result r = walk_level(w, level + 1);
    if (r != PL_WALK_DONE) return r;
  }
  w->v->value[b->index.id] = PL_NAN;
  return PL_WALK_DONE;
}

static pl_walk_result walk_blocks(const pl_block* b, pl_index_values* v, pl_instance_visit* visit,
                                  void* user, long* budget, bool ends_only,
                                  const pl_block** culprit) {
  block_walk w = {.v = v, .visit = visit, .user = user, .budget = budget, .ends_only = ends_only};
  for (const pl_block* x = b; x; x = x->outer) {
    if (w.depth == MAX_BLOCK_DEPTH) return PL_WALK_TOO_MANY;
    w.depth++;
  }
  int level = w.depth;
  for (const pl_block* x = b; x; x = x->outer) w.chain[--level] = x;
  pl_walk_result r = walk_level(&w, 0);
  if (culprit) *culprit = w.culprit ? w.culprit : b;
  return r;
}

pl_walk_result pl_block_walk(const pl_block* b, pl_index_values* v, pl_instance_visit* visit,
                             void* user, long* budget, const pl_block** culprit) {
  return walk_blocks(b, v, visit, user, budget, false, culprit);
}

pl_walk_result pl_block_walk_ends(const pl_block* b, pl_index_values* v, pl_instance_visit* visit,
                                  void* user, long* budget) {
  return walk_blocks(b, v, visit, user, budget, true, NULL);
}

// --------------------------------------------------------------------------------------- instances
typedef struct collector {
  pl_arena* arena;
  const pl_instances* shape;
  PL_VEC(long) index;
} collector;

static bool collect(void* user, pl_index_values* v) {
  collector* c = user;
  for (int k = 0; k < c->shape->depth; k++)
    pl_push(c->arena, c->index, (long)v->value[c->shape->symbol[k].id]);
  return true;
}

pleuel_status pl_model_instances(pl_job* job, const pl_model* m, const pl_block* b,
                                 pl_instances* out) {
  *out = (pl_instances){0};
  for (const pl_block* x = b; x; x = x->outer) out->depth++;
  out->symbol = PL_ARRAY(job->arena, pl_symbol, out->depth + 1);
  int level = out->depth;
  for (const pl_block* x = b; x; x = x->outer) out->symbol[--level] = x->index;
  pl_index_values v = pl_index_values_make(m, job->arena);
  collector c = {.arena = job->arena, .shape = out};
  long budget = PL_MAX_INSTANCES;
  pl_walk_result r = pl_block_walk(b, &v, collect, &c, &budget, NULL);
  if (r == PL_WALK_TOO_MANY)
    return pl_fail(job, PLEUEL_MODEL_ERROR, "a family has more than %d members",
                   (int)PL_MAX_INSTANCES);
  if (r != PL_WALK_DONE)
    return pl_fail(job, PLEUEL_MODEL_ERROR, "the bounds of a family are not whole numbers");
  out->index = c.index.at;
  out->n = out->depth ? c.index.n / out->depth : 1;
  return PLEUEL_OK;
}

// ------------------------------------------------------------------------------------- coordinates
pl_flat_coords pl_model_flat_coords(const pl_model* m, pl_arena* a) {
  PL_VEC(pl_expr) all = {0};
  pl_index_values v = pl_index_values_make(m, a);
  for (int i = 0; i < m->coords.n; i++) {
    const pl_coord* c = &m->coords.at[i];
    if (pl_is_poison(c->lo)) {
      pl_push(a, all, pl_sym(m->pool, c->symbol));
      continue;
    }
    long lo, hi;
    if (!pl_index_eval(&v, c->lo, &lo) || !pl_index_eval(&v, c->hi, &hi)) continue;
    if (hi >= lo && hi - lo >= PL_MAX_INSTANCES) continue;
    for (long k = lo; k <= hi; k++)
      pl_push(a, all, pl_at(m->pool, c->symbol, 0, pl_int(m->pool, k)));
  }
  return (pl_flat_coords){all.at, all.n};
}
// --------------------------------------------------------------------------------- sets of indices
// Which member of a family was given where. `for i in 1..N` with index i or i + k is kept as one
// run of numbers, so a million members cost as much as one; other patterns are walked. members of a
// pattern that is no run; beyond it only the runs are compared
enum { MAX_WALKED = 200000 };

struct pl_index_run {
  uint64_t key;
  long lo, hi;
  int owner;
};

pl_index_sets pl_index_sets_make(const pl_model* m, pl_arena* a) {
  return (pl_index_sets){
      .arena = a, .values = pl_index_values_make(m, a), .walked = pl_map_make(a)};
}

static uint64_t walked_key(uint64_t key, long k) { return pl_hash_mix(key, (uint64_t)k) | 1; }

// Is the index in one loop i, i + k or -i + k with a step that leaves no gaps?
static bool is_run(const pl_index_sets* s, pl_expr index, const pl_block* b) {
  long slope, step = 1;
  if (!b || b->outer) return false;
  const pl_model* m = s->values.model;
  pl_expr d = pl_diff(m->pool, index, b->index);
  if (pl_is_poison(d) || pl_has_symbol(m->pool, d, b->index)
      || !pl_index_eval(&s->values, d, &slope))
    return false;
  if (!pl_is_poison(b->step) && !pl_index_eval(&s->values, b->step, &step)) return false;
  return labs(slope) == 1 && labs(step) == 1;
}

typedef struct set_walk {
  pl_index_sets* sets;
  uint64_t key;
  pl_expr index;
  int owner;
  bool record;  // false: only the hull of a run
  long lo, hi, n;
  int clash;  // owner of the first that is met again, -1
  long clash_index;
} set_walk;

static int find_member(const pl_index_sets* s, uint64_t key, long k) {
  uint64_t known = pl_map_get(s->walked, walked_key(key, k));
  if (known) return (int)known - 1;
  for (int i = 0; i < s->runs.n; i++) {
    const struct pl_index_run* r = &s->runs.at[i];
    if (r->key == key && k >= r->lo && k <= r->hi) return r->owner;
  }
  return -1;
}

static bool one_member(void* user, pl_index_values* v) {
  set_walk* w = user;
  long k = 0;
  if (!pl_is_poison(w->index) && !pl_index_eval(v, w->index, &k)) return false;
  if (w->n == 0 || k < w->lo) w->lo = k;
  if (w->n == 0 || k > w->hi) w->hi = k;
  w->n++;
  if (!w->record) return true;
  int first = find_member(w->sets, w->key, k);
  if (first >= 0) {
    w->clash = first;
    w->clash_index = k;
    return false;
  }
  pl_map_set(w->sets->walked, walked_key(w->key, k), (uint64_t)w->owner + 1);
  return true;
}

static void add_run(set_walk* w) {
  pl_index_sets* s = w->sets;
  for (int i = 0; i < s->runs.n && w->clash < 0; i++) {
    const struct pl_index_run* r = &s->runs.at[i];
    if (r->key != w->key || r->hi < w->lo || r->lo > w->hi) continue;
    w->clash = r->owner;
    w->clash_index = r->lo > w->lo ? r->lo : w->lo;
  }
  for (long k = w->lo;
       k <= w->hi && w->hi - w->lo < MAX_WALKED && pl_map_count(s->walked) && w->clash < 0; k++) {
    uint64_t known = pl_map_get(s->walked, walked_key(w->key, k));
    if (known) {
      w->clash = (int)known - 1;
      w->clash_index = k;
    }
  }
  if (w->clash < 0)
    pl_push(s->arena, s->runs, (struct pl_index_run){w->key, w->lo, w->hi, w->owner});
}

int pl_index_sets_add(pl_index_sets* s, uint64_t key, pl_expr index, const pl_block* b, int owner,
                      long* clash_index) {
  set_walk w = {.sets = s, .key = key, .index = index, .owner = owner, .clash = -1, .record = true};
  if (!b) {
    w.record = false;
    if (one_member(&w, &s->values)) add_run(&w);
  } else if (!pl_is_poison(index) && is_run(s, index, b)) {
    w.record = false;
    long budget = 4;
    walk_blocks(b, &s->values, one_member, &w, &budget, true, NULL);
    if (w.n) add_run(&w);
  } else {
    long budget = MAX_WALKED;
    walk_blocks(b, &s->values, one_member, &w, &budget, false, NULL);
  }
  for (const pl_block* x = b; x; x = x->outer) s->values.value[x->index.id] = PL_NAN;
  *clash_index = w.clash_index;
  return w.clash;
}
