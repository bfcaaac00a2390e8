// Substitution, all at once: what was put in is not looked at again. One pass over the DAG,
// arguments first.
#include "expr/expr_impl.h"

typedef struct plan {
  const pl_replace* replace;  // (n)
  int n;
  pl_expr from, to;  // or one node; poison if none
} plan;

static pl_expr substitute(pl_pool* p, pl_expr e, const plan* s);

static const pl_replace* find(const plan* s, pl_symbol x) {
  for (int i = 0; i < s->n; i++) {
    if (s->replace[i].from.id == x.id) return &s->replace[i];
  }
  return NULL;
}

// A sum binds its index: inside it the index is not replaced, and nothing may be put in that speaks
// of another index of the same name; that would be caught by the sum, so it is poison.
static pl_expr substitute_in_pattern(pl_pool* p, pl_expr e, const plan* s, pl_expr lo, pl_expr hi) {
  pl_symbol index = pl_symbol_of(p, e);
  pl_expr body = pl_arg(p, e, 3);
  PL_TEMP(pl_replace) inside = {0};
  bool caught = s->from.id != 0 && pl_has_symbol(p, s->to, index);
  for (int i = 0; i < s->n; i++) {
    if (s->replace[i].from.id == index.id) continue;
    pl_temp_push(p, inside, s->replace[i]);
    if (pl_has_symbol(p, s->replace[i].to, index) && pl_has_symbol(p, body, s->replace[i].from))
      caught = true;
  }
  plan narrower = {inside.at, inside.n, s->from, s->to};
  pl_expr result = caught ? pl_poison()
                          : pl_sum_over(p, index, lo, hi, substitute(p, body, &narrower));
  pl_temp_free(p, inside);
  return result;
}

static pl_expr substitute_node(pl_pool* p, pl_expr e, const pl_expr* args, const plan* s) {
  if (e.id != 0 && e.id == s->from.id) return s->to;
  pl_kind kind = pl_kind_of(p, e);
  if (kind == PL_SYMBOL) {
    const pl_replace* r = find(s, pl_symbol_of(p, e));
    return r ? r->to : e;
  }
  if (kind == PL_SUM) return substitute_in_pattern(p, e, s, args[1], args[2]);
  return pl_rebuild(p, e, args);
}

static pl_expr substitute(pl_pool* p, pl_expr e, const plan* s) {
  if (pl_n_args(p, e) == 0) return substitute_node(p, e, NULL, s);
  pl_walk w;
  pl_walk_begin(&w, p, &e, 1);
  pl_expr* to = pl_scratch_take(p, (size_t)w.nodes.n * sizeof *to);
  pl_exprs args = {0};
  for (int i = 0; i < w.nodes.n; i++) {
    pl_expr x = w.nodes.at[i];
    args.n = 0;
    for (int k = 0, n = pl_n_args(p, x); k < n; k++) {
      pl_temp_push(p, args, to[pl_walk_position(&w, pl_arg(p, x, k))]);
    }
    to[i] = substitute_node(p, x, args.at, s);
  }
  pl_expr result = to[w.nodes.n - 1];
  pl_temp_free(p, args);
  pl_scratch_give(p, to, (size_t)w.nodes.n * sizeof *to);
  pl_walk_end(&w);
  return result;
}

pl_expr pl_subst(pl_pool* p, pl_expr e, const pl_replace* r, int n) {
  return substitute(p, e, &(plan){.replace = r, .n = n});
}

pl_expr pl_subst1(pl_pool* p, pl_expr e, pl_symbol from, pl_expr to) {
  return pl_subst(p, e, &(pl_replace){from, to}, 1);
}

pl_expr pl_subst_expr(pl_pool* p, pl_expr e, pl_expr from, pl_expr to) {
  if (from.id == 0) return e;
  return substitute(p, e, &(plan){.from = from, .to = to});
}

// ------------------------------------------------------------------------------ numbers with units
bool pl_is_measure(const pl_pool* p, pl_expr e) {
  return pl_kind_of(p, e) == PL_SYMBOL
         && !pl_is_poison(pl_symbol_get(p, pl_symbol_of(p, e))->number);
}

pl_expr pl_without_measures(pl_pool* p, pl_expr e) {
  if (pl_is_poison(e)) return e;
  int n = pl_symbols_in(p, e, NULL, 0), n_measures = 0;
  pl_symbol* s = PL_ARRAY(p->arena, pl_symbol, n + 1);
  pl_replace* r = PL_ARRAY(p->arena, pl_replace, n + 1);
  pl_symbols_in(p, e, s, n);
  for (int i = 0; i < n; i++) {
    pl_expr number = pl_symbol_get(p, s[i])->number;
    if (!pl_is_poison(number)) r[n_measures++] = (pl_replace){s[i], number};
  }
  return n_measures ? pl_subst(p, e, r, n_measures) : e;
}
