// Small families written out: every instance becomes a statement of its own, elements become scalar
// coordinates. The derivation uses this below a limit; above it a family stays a pattern.
#include "model_impl.h"

#include <math.h>
#include <string.h>

typedef struct expansion {
  pl_job* job;
  pl_arena* arena;
  pl_model* from;
  pl_model* to;
  pl_index_values values;  // indices of the instance at work are set in here
  pl_map* element;         // (family, index) -> scalar symbol id
  pl_map* constant;        // for pl_is_constant_known
  pl_map* memo;            // expression id -> rewritten id, for the instance at work
  bool too_long;           // a sum has too many terms, or the families too many members
  bool keep_elements;      // x[3] stays an element of its family
  long budget;             // statements that may still be written
} expansion;

// written out, more would be read by nobody
enum { MAX_SUM_TERMS = 100000, MAX_STATEMENTS = 200000 };

// ---------------------------------------------------------------------------------------- elements
// x[3] -> x3 (ascii x_3), λ_c[3] -> λ_c3 (ascii lambda_c_3)
static pl_symbol element_symbol(expansion* x, pl_symbol family, long k) {
  uint64_t key = pl_hash_mix(family.id, (uint64_t)k) | 1;
  uint64_t known = pl_map_get(x->element, key);
  if (known) return (pl_symbol){(uint32_t)known};
  pl_symbol_info info = *pl_symbol_get(x->from->pool, family);
  const char* minus = k < 0 ? "m" : "";
  long size = k < 0 ? -k : k;
  info.name = pl_format(x->arena, k < 0 ? "%s(-%ld)" : "%s%ld", info.name, size);
  const char* stem = info.ascii;
  info.ascii = pl_format(x->arena, "%s_%s%ld", stem, minus, size);
  while (pl_symbol_find(x->from->pool, info.ascii).id)
    info.ascii = pl_format(x->arena, "%s_", info.ascii);
  if (info.role == PL_R_ARRAY) {
    info.role = PL_R_COORD;
    info.class = PL_C_COORD;
  }
  info.base = info.up = (pl_symbol){0};
  pl_symbol s = pl_symbol_make(x->from->pool, &info);
  pl_map_set(x->element, key, s.id);
  return s;
}

static pl_expr rewrite(expansion* x, pl_expr e);

static pl_expr rewrite_element(expansion* x, pl_expr e) {
  pl_pool* p = x->from->pool;
  long k;
  pl_expr index = pl_arg(p, e, 0);
  if (!pl_index_eval(&x->values, index, &k))
    return pl_at(p, pl_symbol_of(p, e), pl_dots_of(p, e), rewrite(x, index));
  if (x->keep_elements) return pl_at(p, pl_symbol_of(p, e), pl_dots_of(p, e), pl_int(p, k));
  pl_symbol s = element_symbol(x, pl_symbol_of(p, e), k);
  for (int i = 0; i < pl_dots_of(p, e); i++) s = pl_symbol_dot(p, s);
  return pl_sym(p, s);
}

static pl_expr rewrite_sum(expansion* x, pl_expr e) {
  pl_pool* p = x->from->pool;
  int n = pl_n_args(p, e);
  pl_expr body = pl_arg(p, e, n - 1);
  pl_symbol index = pl_symbol_of(p, e);
  long lo, hi;
  if (!pl_index_eval(&x->values, pl_arg(p, e, n - 3), &lo)
      || !pl_index_eval(&x->values, pl_arg(p, e, n - 2), &hi))
    return e;
  if (hi - lo >= MAX_SUM_TERMS) {
    x->too_long = true;
    return pl_poison();
  }
  double before = x->values.value[index.id];
  pl_map* memo = x->memo;
  pl_expr total = pl_int(p, 0);
  for (long k = lo; k <= hi; k++) {
    x->values.value[index.id] = (double)k;
    x->memo = pl_map_make(x->arena);
    total = pl_add(p, total, rewrite(x, body));
  }
  x->values.value[index.id] = before;
  x->memo = memo;
  return total;
}

static pl_expr rewrite_args(expansion* x, pl_expr e) {
  pl_pool* p = x->from->pool;
  int n = pl_n_args(p, e);
  pl_expr* args = PL_ARRAY(x->arena, pl_expr, n + 1);
  bool same = true;
  for (int i = 0; i < n; i++) {
    args[i] = rewrite(x, pl_arg(p, e, i));
    same &= pl_same(args[i], pl_arg(p, e, i));
  }
  if (same) return e;
  switch (pl_kind_of(p, e)) {
    case PL_ADD: return pl_add_n(p, args, n);
    case PL_MUL: return pl_mul_n(p, args, n);
    case PL_POW: return pl_pow(p, args[0], args[1]);
    case PL_CALL:
      return n == 2 ? pl_call2(p, pl_function_of(p, e), args[0], args[1])
                    : pl_call(p, pl_function_of(p, e), args[0]);
    case PL_IF: return pl_if(p, args[0], args[1], args[2]);
    default: return e;
  }
}

static bool is_index_at_work(const expansion* x, pl_symbol s) {
  return pl_symbol_get(x->from->pool, s)->role == PL_R_INDEX && !isnan(x->values.value[s.id]);
}

static pl_expr rewrite(expansion* x, pl_expr e) {
  pl_pool* p = x->from->pool;
  if (pl_is_poison(e) || pl_is_constant_known(p, x->constant, e)) return e;
  uint64_t known = pl_map_get(x->memo, e.id);
  if (known) return (pl_expr){(uint32_t)known};
  pl_expr out = e;
  switch (pl_kind_of(p, e)) {
    case PL_SYMBOL:
      if (is_index_at_work(x, pl_symbol_of(p, e)))
        out = pl_int(p, (long)x->values.value[pl_symbol_of(p, e).id]);
      break;
    case PL_AT: out = rewrite_element(x, e); break;
    case PL_SUM: out = rewrite_sum(x, e); break;
    default: out = rewrite_args(x, e); break;
  }
  pl_map_set(x->memo, e.id, out.id);
  return out;
}

static void rewrite_slot(void* user, const pl_slot* slot) { *slot->at = rewrite(user, *slot->at); }

// --------------------------------------------------------------------------------------- instances
// c[i] at i = 3 becomes the label c[3].
static void write_label(expansion* x, pl_name* name) {
  long k;
  if (!name->text || pl_is_poison(name->index) || !pl_index_eval(&x->values, name->index, &k))
    return;
  name->text = pl_format(x->arena, "%s[%ld]", name->text, k);
  name->ascii = pl_format(x->arena, "%s[%ld]", name->ascii ? name->ascii : name->text, k);
  name->index = pl_poison();
}

// One item of a family at the indices set: a model with this item alone is rewritten.
#define PL_EXPAND_ITEM(x, field, item)           \
  do {                                           \
    pl_model one = {.pool = (x)->from->pool};    \
    one.field.at = &(item);                      \
    one.field.n = 1;                             \
    (x)->memo = pl_map_make((x)->arena);         \
    (item).block = NULL;                         \
    pl_model_each_slot(&one, rewrite_slot, (x)); \
    pl_push((x)->arena, (x)->to->field, (item)); \
  } while (0)

typedef struct one_item {
  expansion* x;
  int i;       // in its list
  long count;  // instances so far
} one_item;

static bool expand_mass(void* user, pl_index_values* v) {
  one_item* o = user;
  pl_mass item = o->x->from->masses.at[o->i];
  write_label(o->x, &item.name);
  PL_EXPAND_ITEM(o->x, masses, item);
  return true;
}

static bool expand_body(void* user, pl_index_values* v) {
  one_item* o = user;
  pl_body item = o->x->from->bodies.at[o->i];
  write_label(o->x, &item.name);
  PL_EXPAND_ITEM(o->x, bodies, item);
  return true;
}

static bool expand_spatial(void* user, pl_index_values* v) {
  one_item* o = user;
  pl_spatial item = o->x->from->spatials.at[o->i];
  write_label(o->x, &item.name);
  PL_EXPAND_ITEM(o->x, spatials, item);
  return true;
}

static bool expand_place(void* user, pl_index_values* v) {
  one_item* o = user;
  pl_place_def item = o->x->from->points.at[o->i];
  write_label(o->x, &item.name);
  PL_EXPAND_ITEM(o->x, points, item);
  return true;
}

static bool expand_load(void* user, pl_index_values* v) {
  one_item* o = user;
  pl_load item = o->x->from->loads.at[o->i];
  write_label(o->x, &item.name);
  PL_EXPAND_ITEM(o->x, loads, item);
  return true;
}

static bool expand_constraint(void* user, pl_index_values* v) {
  one_item* o = user;
  pl_constraint item = o->x->from->constraints.at[o->i];
  long k = ++o->count;
  if (!pl_is_poison(item.name.index)) pl_index_eval(v, item.name.index, &k);
  else if (item.name.text)
    item.name.text = item.name.ascii = pl_format(o->x->arena, "%s[%ld]", item.name.text, k);
  write_label(o->x, &item.name);
  if (item.lambda.id && !o->x->keep_elements) item.lambda = element_symbol(o->x, item.lambda, k);
  PL_EXPAND_ITEM(o->x, constraints, item);
  return true;
}

static bool expand_init(void* user, pl_index_values* v) {
  one_item* o = user;
  pl_init item = o->x->from->inits.at[o->i];
  PL_EXPAND_ITEM(o->x, inits, item);
  return true;
}

// Every instance of item i of a list, or the item itself when it stands in no family.
static pl_walk_result expand_each(expansion* x, int i, const pl_block* b,
                                  pl_instance_visit* visit) {
  one_item o = {x, i, 0};
  pl_walk_result r = pl_block_walk(b, &x->values, visit, &o, &x->budget, NULL);
  x->too_long |= r == PL_WALK_TOO_MANY;
  for (const pl_block* k = b; k; k = k->outer) x->values.value[k->index.id] = PL_NAN;
  return r;
}

// A constraint outside a family may still carry an index: constraint c[1].
static void take_constraint(expansion* x, int i) {
  pl_constraint item = x->from->constraints.at[i];
  long k;
  if (!pl_is_poison(item.name.index) && pl_index_eval(&x->values, item.name.index, &k)) {
    if (item.lambda.id) item.lambda = element_symbol(x, item.lambda, k);
    write_label(x, &item.name);
  }
  PL_EXPAND_ITEM(x, constraints, item);
}

#define PL_EXPAND_LIST(x, field, visit)                                              \
  for (int i = 0; i < (x)->from->field.n && ok; i++) {                               \
    ok = expand_each((x), i, (x)->from->field.at[i].block, (visit)) == PL_WALK_DONE; \
  }

static bool expand_statements(expansion* x) {
  bool ok = true;
  PL_EXPAND_LIST(x, masses, expand_mass);
  PL_EXPAND_LIST(x, bodies, expand_body);
  PL_EXPAND_LIST(x, spatials, expand_spatial);
  PL_EXPAND_LIST(x, points, expand_place);
  PL_EXPAND_LIST(x, loads, expand_load);
  PL_EXPAND_LIST(x, inits, expand_init);
  for (int i = 0; i < x->from->constraints.n && ok; i++) {
    const pl_block* b = x->from->constraints.at[i].block;
    if (b) ok = expand_each(x, i, b, expand_constraint) == PL_WALK_DONE;
    else take_constraint(x, i);
  }
  return ok;
}

// ---------------------------------------------------------------------------------------- the rest
static void expand_coordinates(expansion* x) {
  for (int i = 0; i < x->from->coords.n; i++) {
    const pl_coord* c = &x->from->coords.at[i];
    long lo, hi;
    if (pl_is_poison(c->lo)) {
      pl_push(x->arena, x->to->coords, *c);
      continue;
    }
    if (!pl_index_eval(&x->values, c->lo, &lo) || !pl_index_eval(&x->values, c->hi, &hi)) continue;
    for (long k = lo; k <= hi; k++) {
      pl_coord one = {element_symbol(x, c->symbol, k), pl_poison(), pl_poison(), c->has_unit,
                      c->span};
      pl_symbol_dot(x->from->pool, pl_symbol_dot(x->from->pool, one.symbol));
      pl_push(x->arena, x->to->coords, one);
    }
  }
}

static void* copied(pl_arena* a, const void* at, int n, size_t size) {
  void* out = pl_alloc_array(a, (size_t)n + 1, size);
  if (n) memcpy(out, at, (size_t)n * size);
  return out;
}
#define PL_COPY_VEC(a, v) ((v).at = copied((a), (v).at, (v).n, sizeof *(v).at), (v).cap = (v).n)

// Lists that each_slot writes into get their own memory.
static void own_lists(pl_arena* a, pl_model* m) {
  PL_COPY_VEC(a, m->params);
  PL_COPY_VEC(a, m->lets);
  PL_COPY_VEC(a, m->assumptions);
  PL_COPY_VEC(a, m->gravities);
  PL_COPY_VEC(a, m->branches);
  PL_COPY_VEC(a, m->events);
  for (int i = 0; i < m->events.n; i++) PL_COPY_VEC(a, m->events.at[i].actions);
  PL_COPY_VEC(a, m->asks);
  for (int i = 0; i < m->asks.n; i++) {
    PL_COPY_VEC(a, m->asks.at[i].where);
    pl_motion* motion = &m->asks.at[i].motion;
    motion->from = copied(a, motion->from, motion->n_from, sizeof *motion->from);
  }
  PL_COPY_VEC(a, m->outputs);
  PL_COPY_VEC(a, m->result_names);
  PL_COPY_VEC(a, m->plots);
  PL_COPY_VEC(a, m->draws);
  for (int i = 0; i < m->plots.n; i++) PL_COPY_VEC(a, m->plots.at[i].y);
  m->choose.maps = copied(a, m->choose.maps, m->choose.n_maps, sizeof *m->choose.maps);
}

#define PL_EMPTY_VEC(v) ((v).at = NULL, (v).n = (v).cap = 0)

static long count_coordinates(const expansion* x) {
  long n = 0;
  for (int i = 0; i < x->from->coords.n; i++) {
    const pl_coord* c = &x->from->coords.at[i];
    long lo, hi;
    if (pl_is_poison(c->lo)) n++;
    else if (pl_index_eval(&x->values, c->lo, &lo) && pl_index_eval(&x->values, c->hi, &hi)
             && hi >= lo)
      n += hi - lo + 1;
  }
  return n;
}

pleuel_status pl_model_expand(pl_job* job, const pl_model* m, int max_coords, pl_model** out) {
  pl_arena* a = pl_pool_arena(m->pool);
  pl_model* to = PL_NEW(a, pl_model);
  *to = *m;
  expansion x = {.job = job,
                 .arena = a,
                 .from = (pl_model*)(uintptr_t)m,
                 .to = to,
                 .element = pl_map_make(a),
                 .constant = pl_map_make(a),
                 .memo = pl_map_make(a),
                 .budget = MAX_STATEMENTS};
  x.values = pl_index_values_make(m, a);
  *out = NULL;
  long n = count_coordinates(&x);
  if (n > max_coords)
    return pl_fail(job, PLEUEL_UNSUPPORTED, "%ld coordinates are too many to write out (limit %d)",
                   n, max_coords);

  own_lists(a, to);
  PL_EMPTY_VEC(to->coords);
  PL_EMPTY_VEC(to->masses);
  PL_EMPTY_VEC(to->bodies);
  PL_EMPTY_VEC(to->points);
  PL_EMPTY_VEC(to->loads);
  PL_EMPTY_VEC(to->constraints);
  PL_EMPTY_VEC(to->inits);
  PL_EMPTY_VEC(to->blocks);
  // statements outside families first: their lists are rewritten in place
  pl_model_each_slot(to, rewrite_slot, &x);
  expand_coordinates(&x);
  bool ok = expand_statements(&x);
  if (x.too_long)
    return pl_fail(job, PLEUEL_UNSUPPORTED,
                   "a family or sum has too many members to be written out");
  if (!ok) return pl_fail(job, PLEUEL_MODEL_ERROR, "the bounds of a family are not whole numbers");
  *out = to;
  return PLEUEL_OK;
}

// ------------------------------------------------------------------- sums that grow with the index
// sum(j in 1..i, ...) in a family over i: its instances differ in length, so that they are no
// instances of one pattern.
static bool grows(const pl_pool* p, pl_expr e) {
  if (pl_is_poison(e)) return false;
  int n = pl_n_args(p, e);
  if (pl_kind_of(p, e) == PL_SUM) {
    bool by_index = pl_has_role(p, pl_arg(p, e, n - 3), PL_R_INDEX)
                    || pl_has_role(p, pl_arg(p, e, n - 2), PL_R_INDEX);
    if (by_index) return true;
  }
  for (int i = 0; i < n; i++) {
    if (grows(p, pl_arg(p, e, i))) return true;
  }
  return false;
}

typedef struct growth {
  const pl_pool* pool;
  bool found;
} growth;

static void look_for_growth(void* user, const pl_slot* slot) {
  growth* g = user;
  g->found |= grows(g->pool, *slot->at);
}

// Whether one item of a list contains such a sum.
#define PL_ITEM_GROWS(x, field, item, answer)      \
  do {                                             \
    pl_model one = {.pool = (x)->from->pool};      \
    growth g = {(x)->from->pool, false};           \
    one.field.at = &(item);                        \
    one.field.n = 1;                               \
    pl_model_each_slot(&one, look_for_growth, &g); \
    (answer) = g.found;                            \
  } while (0)

// A list with the families written out whose items contain such sums, the others as they are.
#define PL_EXPAND_GROWING(x, field, visit)                                   \
  for (int i = 0; i < (x)->from->field.n && ok; i++) {                       \
    bool grown = false;                                                      \
    pl_block* block = (x)->from->field.at[i].block;                          \
    if (block) PL_ITEM_GROWS((x), field, (x)->from->field.at[i], grown);     \
    if (!grown) pl_push((x)->arena, (x)->to->field, (x)->from->field.at[i]); \
    else ok = expand_each((x), i, block, (visit)) == PL_WALK_DONE;           \
  }

pleuel_status pl_model_write_sums(pl_job* job, pl_model* m, pl_model** out) {
  pl_arena* a = pl_pool_arena(m->pool);
  pl_model* to = PL_NEW(a, pl_model);
  *to = *m;
  expansion x = {.job = job,
                 .arena = a,
                 .from = m,
                 .to = to,
                 .element = pl_map_make(a),
                 .constant = pl_map_make(a),
                 .memo = pl_map_make(a),
                 .budget = MAX_STATEMENTS,
                 .keep_elements = true};
  x.values = pl_index_values_make(m, a);
  PL_EMPTY_VEC(to->masses);
  PL_EMPTY_VEC(to->bodies);
  PL_EMPTY_VEC(to->points);
  PL_EMPTY_VEC(to->loads);
  PL_EMPTY_VEC(to->constraints);
  bool ok = true;
  PL_EXPAND_GROWING(&x, masses, expand_mass);
  PL_EXPAND_GROWING(&x, bodies, expand_body);
  PL_EXPAND_GROWING(&x, points, expand_place);
  PL_EXPAND_GROWING(&x, loads, expand_load);
  PL_EXPAND_GROWING(&x, constraints, expand_constraint);
  if (x.too_long)
    return pl_fail(job, PLEUEL_UNSUPPORTED,
                   "a family or sum has too many members to be written out");
  if (!ok) return pl_fail(job, PLEUEL_MODEL_ERROR, "the bounds of a family are not whole numbers");
  *out = to;
  return PLEUEL_OK;
}
