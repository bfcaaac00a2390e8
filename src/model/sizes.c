// Names whose numbers decide how large the system is: another number for one of them is another
// system, whose equations are written down anew.
#include "model_impl.h"

typedef struct size_names {
  const pl_model* m;
  pl_arena* arena;
  bool* is_size;  // by symbol id
} size_names;

static void mark(size_names* s, pl_expr e) {
  if (pl_is_poison(e)) return;
  int n = pl_symbols_in(s->m->pool, e, NULL, 0);
  pl_symbol* symbol = PL_ARRAY(s->arena, pl_symbol, n + 1);
  pl_symbols_in(s->m->pool, e, symbol, n);
  for (int i = 0; i < n; i++) s->is_size[symbol[i].id] = true;
}

// Bounds of sums and indices of elements inside an expression.
static void mark_inside(size_names* s, pl_map* seen, pl_expr e) {
  const pl_pool* p = s->m->pool;
  if (pl_is_poison(e) || pl_map_get(seen, e.id)) return;
  pl_map_set(seen, e.id, 1);
  pl_kind kind = pl_kind_of(p, e);
  if (kind == PL_SUM) {
    mark(s, pl_arg(p, e, 1));
    mark(s, pl_arg(p, e, 2));
  }
  if (kind == PL_AT) mark(s, pl_arg(p, e, 0));
  for (int i = 0; i < pl_n_args(p, e); i++) mark_inside(s, seen, pl_arg(p, e, i));
}

static void look(void* user, const pl_slot* slot) {
  size_names* s = user;
  if (slot->kind == PL_SLOT_BOUND || slot->kind == PL_SLOT_LABEL_INDEX) mark(s, *slot->at);
  mark_inside(s, pl_map_make(s->arena), *slot->at);
}

bool* pl_model_sizes(pl_model* m, pl_arena* a) {
  int n = pl_symbol_count(m->pool) + 1;
  size_names s = {m, a, PL_ARRAY(a, bool, n)};
  pl_model_each_slot(m, look, &s);
  // what they are defined by, however long the chain
  const pl_expr* given = pl_model_definitions(m, a);
  bool* done = PL_ARRAY(a, bool, n);
  for (bool more = true; more;) {
    more = false;
    for (int i = 1; i < n; i++) {
      if (!s.is_size[i] || done[i]) continue;
      done[i] = more = true;
      mark(&s, given[i]);
    }
  }
  return s.is_size;
}
