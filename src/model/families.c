// Families: the instances of `for` blocks, and whether every element that a pattern speaks of
// exists.
//
// Bounds may use parameters with numbers and outer indices. A pattern with N instances is not
// written out: an index that is linear in the innermost loop takes its extreme values at the two
// ends, so only these are looked at.
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

// ---------------------------------------------------------------------------------------- messages
typedef struct range_check {
  pl_job* job;
  pl_model* m;
  pl_index_values v;
  pl_map* seen;  // (element, block) already looked at
  long budget;
  // the element at work
  pl_expr element;
  const pl_coord* coord;
  const pl_block* block;
  pl_span span;
  long lo, hi;  // what the coordinate has
  long bad;     // the index that does not exist
  // the last statement with a message: its other elements are the same mistake
  pl_span told;
  bool no_integer, too_many;
} range_check;

static const char* expr_words(range_check* c, pl_expr e) {
  return pl_expr_words(c->job->arena, c->m->pool, e);
}

// What keeps a bound from being a whole number: the first parameter without number, if there is
// one.
static const char* unknown_in(range_check* c, pl_expr e) {
  int n = pl_is_poison(e) ? 0 : pl_symbols_in(c->m->pool, e, NULL, 0);
  pl_symbol* s = PL_ARRAY(c->job->arena, pl_symbol, n + 1);
  if (n) pl_symbols_in(c->m->pool, e, s, n);
  for (int i = 0; i < n; i++) {
    if (isnan(c->v.value[s[i].id])) return pl_symbol_get(c->m->pool, s[i])->name;
  }
  return NULL;
}

static void tell_bad_bound(range_check* c, pl_expr e, pl_span span) {
  if (pl_map_get(c->seen, e.id + 1)) return;  // one wrong number, one message
  pl_map_set(c->seen, e.id + 1, 1);
  const char* unknown = unknown_in(c, e);
  const char* text = pl_is_poison(e) ? "?" : expr_words(c, e);
  pl_diagnostic* d;
  if (unknown) {
    d = pl_tell(
        c->job, PL_E038, span,
        PL_BOTH_FORMAT(c->job->arena, "%s has no number, so the size of the family is not known",
                       unknown));
    const char* write = PL_F(c->job, "param %s = 10", unknown);
    pl_report_fix(d, write, write, NULL);
    return;
  }
  d = pl_tell(c->job, PL_E038, span,
              PL_BOTH_FORMAT(c->job->arena, "the bound %s is no whole number", text));
  pl_report_fix(d, PL_BOTH("bounds of a family are whole numbers"), NULL);
}

// Coordinates and loops of one size are one mistake.
static void tell_too_many(range_check* c, pl_span span) {
  pl_job* job = c->job;
  if (c->too_many) return;
  c->too_many = true;
  pl_diagnostic* d = pl_tell(
      job, PL_E026, span,
      PL_BOTH_FORMAT(job->arena, "this family has more than %d members", (int)PL_MAX_INSTANCES));
  pl_report_fix(d, PL_BOTH("make the bounds smaller"), NULL);
}

static void tell_walk(range_check* c, pl_walk_result r, const pl_block* b) {
  if (r == PL_WALK_TOO_MANY) tell_too_many(c, b->span);
  if (r == PL_WALK_ZERO_STEP) {
    pl_diagnostic* d = pl_tell(c->job, PL_E038, b->span, PL_BOTH("a step of 0 never ends"));
    pl_report_fix(d, "step 1", "step 1", NULL);
  }
  if (r != PL_WALK_BAD_BOUND) return;
  long n;
  pl_expr bad = !pl_index_eval(&c->v, b->lo, &n)   ? b->lo
                : !pl_index_eval(&c->v, b->hi, &n) ? b->hi
                                                   : b->step;
  tell_bad_bound(c, bad, b->span);
}

// ", at i = 1": the instance that went wrong.
static const char* instance_text(range_check* c, const char* joint) {
  if (!c->block) return "";
  pl_text t = pl_text_make(c->job->arena);
  for (const pl_block* b = c->block; b; b = b->outer) {
    pl_text_addf(&t, "%s%s = %ld", t.n ? ", " : joint, pl_symbol_get(c->m->pool, b->index)->name,
                 (long)c->v.value[b->index.id]);
  }
  return pl_text_string(&t);
}

// A bound that would keep the index inside, for the plain shift x[i-1] or x[i+1] in one loop.
static void suggest_bound(range_check* c, pl_diagnostic* d) {
  const pl_block* b = c->block;
  long shift, lo, hi;
  pl_expr index = pl_arg(c->m->pool, c->element, 0);
  const char* i = b ? pl_symbol_get(c->m->pool, b->index)->name : "";
  pl_expr difference = b ? pl_sub(c->m->pool, index, pl_sym(c->m->pool, b->index)) : pl_poison();
  if (b && pl_is_int(c->m->pool, difference, &shift) && pl_index_eval(&c->v, b->lo, &lo)
      && pl_index_eval(&c->v, b->hi, &hi)) {
    const char* low = c->bad < c->lo ? PL_F(c->job, "%ld", c->lo - shift) : expr_words(c, b->lo);
    const char* high = c->bad > c->hi ? expr_words(c, pl_sub(c->m->pool, c->coord->hi, difference))
                                      : expr_words(c, b->hi);
    const char* fix = PL_F(c->job, "for %s in %s..%s", i, low, high);
    pl_report_fix(d, fix, fix, NULL);
    return;
  }
  const char* name = pl_symbol_get(c->m->pool, c->coord->symbol)->name;
  pl_report_fix(d, PL_F(c->job, "stay inside %s[%ld] ... %s[%ld]", name, c->lo, name, c->hi),
                PL_F(c->job, "innerhalb %s[%ld] ... %s[%ld] bleiben", name, c->lo, name, c->hi),
                NULL);
}

static void tell_out_of_range(range_check* c) {
  if (c->span.source && c->told.source == c->span.source && c->told.begin == c->span.begin) return;
  c->told = c->span;
  const char* name = pl_symbol_get(c->m->pool, c->coord->symbol)->name;
  pl_span at = c->span, found;
  if (pl_span_find_name(c->span, pl_symbol_get(c->m->pool, c->coord->symbol)->ascii, &found))
    at = found;
  pl_expr index = pl_arg(c->m->pool, c->element, 0);
  pl_diagnostic* d;
  if (c->no_integer) {
    const char* text = expr_words(c, index);
    d = pl_tell(c->job, PL_E038, at,
                PL_F(c->job, "the index %s is no whole number%s", text, instance_text(c, " at ")),
                PL_F(c->job, pl_german("the index %s is no whole number%s"), text,
                     instance_text(c, pl_german(" at "))));
    const char* unknown = unknown_in(c, index);
    if (unknown) pl_report_reason(d, PL_BOTH_FORMAT(c->job->arena, "%s has no number", unknown));
    pl_report_fix(
        d,
        PL_BOTH("an index is built from whole numbers, loop indices and parameters with a number"),
        NULL);
    return;
  }
  d = pl_tell(c->job, PL_E037, at,
              PL_F(c->job, "%s[%ld] does not exist%s", name, c->bad, instance_text(c, ", at ")),
              PL_F(c->job, pl_german("%s[%ld] does not exist%s"), name, c->bad,
                   instance_text(c, pl_german(", at "))));
  pl_report_reason(d, PL_BOTH_FORMAT(c->job->arena, "%s runs from %ld to %ld", name, c->lo, c->hi));
  if (c->coord->span.source) {
    pl_report_label(c->job->diagnostics, d, c->coord->span,
                    PL_F(c->job, "%s[%ld..%ld]", name, c->lo, c->hi));
  }
  suggest_bound(c, d);
}

// ---------------------------------------------------------------------------------------- elements
static const pl_coord* family_of(const pl_model* m, pl_symbol s) {
  for (int i = 0; i < m->coords.n; i++) {
    if (m->coords.at[i].symbol.id == s.id && !pl_is_poison(m->coords.at[i].lo))
      return &m->coords.at[i];
  }
  return NULL;
}

static bool inside(void* user, pl_index_values* v) {
  range_check* c = user;
  long k;
  c->no_integer = !pl_index_eval(v, pl_arg(c->m->pool, c->element, 0), &k);
  c->bad = c->no_integer ? 0 : k;
  return !c->no_integer && k >= c->lo && k <= c->hi;
}

// Linear in the innermost index with a whole coefficient: the ends tell all.
static bool is_linear(range_check* c, pl_expr index, const pl_block* b) {
  pl_expr slope = pl_diff(c->m->pool, index, b->index);
  long k;
  return !pl_is_poison(slope) && !pl_has_symbol(c->m->pool, slope, b->index)
         && pl_index_eval(&c->v, slope, &k);
}

static void check_element(range_check* c, pl_expr element, const pl_block* b) {
  c->coord = family_of(c->m, pl_symbol_of(c->m->pool, element));
  if (!c->coord) return;
  uint64_t key = pl_hash_mix(element.id, (uint64_t)(uintptr_t)b) | 1;
  if (pl_map_get(c->seen, key)) return;
  pl_map_set(c->seen, key, 1);
  if (!pl_index_eval(&c->v, c->coord->lo, &c->lo) || !pl_index_eval(&c->v, c->coord->hi, &c->hi))
    return;  // told elsewhere
  c->element = element;
  c->block = b;
  bool ok;
  if (b) {
    ok = walk_blocks(b, &c->v, inside, c, &c->budget,
                     is_linear(c, pl_arg(c->m->pool, element, 0), b), NULL)
         != PL_WALK_STOPPED;
  } else {
    ok = inside(c, &c->v);
  }
  if (!ok) tell_out_of_range(c);
  for (const pl_block* x = b; x; x = x->outer) c->v.value[x->index.id] = PL_NAN;
}

// Looks for elements in an expression.  A sum over an index is one more loop inside the block.
static void check_expression(range_check* c, pl_expr e, const pl_block* b, pl_map* visited) {
  if (pl_is_poison(e) || pl_map_get(visited, e.id)) return;
  pl_map_set(visited, e.id, 1);
  pl_kind kind = pl_kind_of(c->m->pool, e);
  if (kind == PL_AT) check_element(c, e, b);
  if (kind == PL_SUM) {
    pl_block* sum = PL_NEW(c->job->arena, pl_block);
    int n = pl_n_args(c->m->pool, e);
    *sum = (pl_block){(pl_block*)(uintptr_t)b,
                      pl_symbol_of(c->m->pool, e),
                      pl_arg(c->m->pool, e, n - 3),
                      pl_arg(c->m->pool, e, n - 2),
                      pl_poison(),
                      c->span};
    check_expression(c, pl_arg(c->m->pool, e, n - 1), sum, pl_map_make(c->job->arena));
    return;
  }
  for (int i = 0; i < pl_n_args(c->m->pool, e); i++)
    check_expression(c, pl_arg(c->m->pool, e, i), b, visited);
}

static void check_slot(void* user, const pl_slot* slot) {
  range_check* c = user;
  if (pl_is_poison(*slot->at) || slot->kind == PL_SLOT_BOUND || slot->kind == PL_SLOT_LET) return;
  if (slot->kind == PL_SLOT_LABEL_INDEX || !pl_has_role(c->m->pool, *slot->at, PL_R_ARRAY)) return;
  c->span = slot->span;
  check_expression(c, *slot->at, slot->block, pl_map_make(c->job->arena));
}

// ------------------------------------------------------------------------------------------ bounds
static void check_blocks(range_check* c) {
  for (int i = 0; i < c->m->blocks.n; i++) {
    const pl_block* b = c->m->blocks.at[i];
    const pl_block* culprit = b;
    long budget = PL_MAX_INSTANCES;
    pl_walk_result r = pl_block_walk(b, &c->v, NULL, NULL, &budget, &culprit);
    // an outer block tells its own mistakes
    if (culprit == b || r == PL_WALK_TOO_MANY) tell_walk(c, r, b);
    for (const pl_block* x = b; x; x = x->outer) c->v.value[x->index.id] = PL_NAN;
  }
}

static void check_coordinate_bounds(range_check* c) {
  for (int i = 0; i < c->m->coords.n; i++) {
    const pl_coord* q = &c->m->coords.at[i];
    long lo, hi;
    if (pl_is_poison(q->lo)) continue;
    if (!pl_index_eval(&c->v, q->lo, &lo)) tell_bad_bound(c, q->lo, q->span);
    else if (!pl_index_eval(&c->v, q->hi, &hi)) tell_bad_bound(c, q->hi, q->span);
    else if (hi - lo >= PL_MAX_INSTANCES) tell_too_many(c, q->span);
  }
}

static range_check range_check_make(pl_job* job, pl_model* m) {
  return (range_check){.job = job,
                       .m = m,
                       .v = pl_index_values_make(m, job->arena),
                       .seen = pl_map_make(job->arena),
                       .budget = PL_MAX_INSTANCES};
}

// Sizes first: everything else relies on them.
bool pl_check_sizes(pl_job* job, pl_model* m) {
  range_check c = range_check_make(job, m);
  int before = job->diagnostics->n_errors;
  check_coordinate_bounds(&c);
  check_blocks(&c);
  return job->diagnostics->n_errors == before;
}

void pl_check_families(pl_job* job, pl_model* m) {
  range_check c = range_check_make(job, m);
  pl_model_each_slot(m, check_slot, &c);
}
