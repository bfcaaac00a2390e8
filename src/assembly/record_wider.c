// record for numbers wider than doubles: parameters are written down as what they are defined by,
// start values and times as they stand in the text, so that nothing is rounded on the way.
#include <math.h>
#include <string.h>

#include "assembly/assembly_impl.h"

void pl_wider_begin(pl_recorder* r) {
  if (!r->exact) return;
  r->n_definitions = pl_symbol_count(r->pool) + 1;
  r->definition = pl_model_definitions(r->model, r->arena);
  r->start_q = PL_ARRAY(r->arena, pl_expr, r->out->flat.n + 1);
  r->start_v = PL_ARRAY(r->arena, pl_expr, r->out->flat.n + 1);
}

// Symbols may have been made since.
const pl_expr* pl_wider_definitions(pl_recorder* r) {
  int n = pl_symbol_count(r->pool) + 1;
  if (!r->exact) return NULL;
  if (n <= r->n_definitions) return r->definition;
  pl_expr* more = PL_ARRAY(r->arena, pl_expr, n);
  memcpy(more, r->definition, (size_t)r->n_definitions * sizeof *more);
  r->definition = more;
  r->n_definitions = n;
  return more;
}

pl_expr pl_wider_element(const pl_recorder* r, int at) {
  return r->exact ? r->start_q[at] : pl_poison();
}

void pl_wider_start(pl_recorder* r, const pl_start_value* s, pl_expr value) {
  if (!r->exact || s->guess) return;
  // indices have values only as long as their block is at work
  int n = pl_symbols_in(r->pool, value, NULL, 0);
  pl_symbol* symbol = PL_ARRAY(r->arena, pl_symbol, n + 1);
  pl_symbols_in(r->pool, value, symbol, n);
  pl_wider_definitions(r);
  for (int i = 0; i < n; i++) {
    double x = (int)symbol[i].id < r->n_value ? r->value[symbol[i].id] : (double)NAN;
    bool is_index = pl_symbol_get(r->pool, symbol[i])->role == PL_R_INDEX
                    && pl_is_poison(r->definition[symbol[i].id]);
    if (is_index && x == nearbyint(x))
      value = pl_subst1(r->pool, value, symbol[i], pl_int(r->pool, lround(x)));
  }
  (s->velocity ? r->start_v : r->start_q)[s->at] = value;
  pl_expr atom = r->out->flat.at[s->at];
  if (pl_kind_of(r->pool, atom) != PL_SYMBOL) return;
  pl_symbol name = pl_symbol_of(r->pool, atom);
  if (s->velocity) name = pl_symbol_dot(r->pool, name);
  pl_wider_definitions(r);
  r->definition[name.id] = value;
}

// --------------------------------------------------------------------------- the tape of constants
typedef struct roots {
  PL_VEC(pl_expr) list;
} roots;

static int add(pl_recorder* r, roots* all, pl_expr e) {
  if (pl_is_poison(e) || !isfinite(pl_record_number(r, e))) return -1;
  pl_push(r->arena, all->list, e);
  return all->list.n - 1;
}

pleuel_status pl_wider_setup(pl_recorder* r) {
  if (!r->exact) return PLEUEL_OK;
  const pl_simulate* s = &r->model->simulate;
  int n = r->out->flat.n, *q = PL_ARRAY(r->arena, int, n + 1), *v = PL_ARRAY(r->arena, int, n + 1);
  pl_exact_setup* out = PL_NEW(r->arena, pl_exact_setup);
  roots all = {0};
  out->t_0 = s->given ? add(r, &all, s->from) : -1;
  out->t_end = s->given ? add(r, &all, s->to) : -1;
  out->dt = s->given ? add(r, &all, s->step) : -1;
  for (int i = 0; i < n; i++) {
    q[i] = add(r, &all, r->start_q[i]);
    v[i] = add(r, &all, r->start_v[i]);
  }
  out->q = q;
  out->v = v;
  pl_tape_slots slots = {.value_of_symbol = r->value, .definition = pl_wider_definitions(r)};
  pl_tape* tape;
  PL_TRY(pl_tape_record(r->job, r->pool, &slots, all.list.at, NULL, all.list.n, &tape));
  out->tape = tape;
  r->out->setup.exact = out;
  return PLEUEL_OK;
}
