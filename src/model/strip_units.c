// Numbers with units stay where formulas are made of them; where a number is read they become one.
#include "model_impl.h"

static bool reads_number(pl_slot_kind k) {
  return k == PL_SLOT_PARAM || k == PL_SLOT_BOUND || k == PL_SLOT_LABEL_INDEX
         || k == PL_SLOT_ASSUMPTION || k == PL_SLOT_INIT || k == PL_SLOT_EVENT
         || k == PL_SLOT_SIMULATE;
}

// Those that stay are given quantities like any parameter with a number.
static void keep_measures(pl_model* m, pl_expr e, pl_span span) {
  int n = pl_symbols_in(m->pool, e, NULL, 0);
  pl_arena* a = pl_pool_arena(m->pool);
  pl_symbol* s = PL_ARRAY(a, pl_symbol, n + 1);
  pl_symbols_in(m->pool, e, s, n);
  for (int i = 0; i < n; i++) {
    const pl_symbol_info* info = pl_symbol_get(m->pool, s[i]);
    if (pl_is_poison(info->number) || pl_model_param(m, s[i])) continue;
    pl_push(a, m->params,
            (pl_param){.symbol = s[i],
                       .value = info->number,
                       .has_unit = true,
                       .literal = true,
                       .span = span});
  }
}

static void strip_slot(void* user, const pl_slot* slot) {
  pl_model* m = user;
  if (pl_is_poison(*slot->at) || !pl_unit_occurs(m->pool, *slot->at)) return;
  if (reads_number(slot->kind)) *slot->at = pl_unit_to_si(m->pool, *slot->at);
  else {
    *slot->at = pl_unit_drop(m->pool, *slot->at);
    keep_measures(m, *slot->at, slot->span);
  }
}

void pl_strip_units(pl_model* m) { pl_model_each_slot(m, strip_slot, m); }
