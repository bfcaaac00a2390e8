// Whether families have a size, and whether every element that a pattern speaks of exists.
//
// A pattern with N instances is not written out: an index that is linear in the innermost loop
// takes its extreme values at the two ends, so only these are looked at.
#include "model_impl.h"

#include <math.h>

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
    bool ends = is_linear(c, pl_arg(c->m->pool, element, 0), b);
    pl_walk_result r = ends ? pl_block_walk_ends(b, &c->v, inside, c, &c->budget)
                            : pl_block_walk(b, &c->v, inside, c, &c->budget, NULL);
    ok = r != PL_WALK_STOPPED;
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
