// Questions about an expression.
#include "expr/expr_impl.h"

pl_kind pl_kind_of(const pl_pool* p, pl_expr e) { return (pl_kind)pl_node_at(p, e)->kind; }
int pl_n_args(const pl_pool* p, pl_expr e) { return (int)pl_node_at(p, e)->n; }

pl_expr pl_arg(const pl_pool* p, pl_expr e, int i) {
  const pl_node* x = pl_node_at(p, e);
  return i >= 0 && (uint32_t)i < x->n ? x->u.args[i] : pl_poison();
}

pl_function pl_function_of(const pl_pool* p, pl_expr e) {
  return (pl_function)pl_node_at(p, e)->function;
}
pl_symbol pl_symbol_of(const pl_pool* p, pl_expr e) {
  return (pl_symbol){pl_node_at(p, e)->symbol};
}
int pl_dots_of(const pl_pool* p, pl_expr e) { return pl_node_at(p, e)->dots; }
bool pl_same(pl_expr a, pl_expr b) { return a.id == b.id; }
bool pl_is_poison(pl_expr e) { return e.id == 0; }
bool pl_is_number(const pl_pool* p, pl_expr e) { return pl_node_at(p, e)->kind == PL_NUMBER; }
bool pl_is_zero_node(const pl_pool* p, pl_expr e) { return e.id == p->zero.id; }
bool pl_is_one_node(const pl_pool* p, pl_expr e) { return e.id == p->one.id; }

bool pl_is_ratio(const pl_pool* p, pl_expr e, long* num, long* den) {
  if (!pl_is_number(p, e)) return false;
  const pl_number* x = pl_number_of(p, e);
  if (x->limbs != NULL) return false;
  if (num != NULL) *num = x->num;
  if (den != NULL) *den = x->den;
  return true;
}

bool pl_is_int(const pl_pool* p, pl_expr e, long* value) {
  long num, den;
  if (!pl_is_ratio(p, e, &num, &den) || den != 1) return false;
  if (value != NULL) *value = num;
  return true;
}

bool pl_is_sqrt(const pl_pool* p, pl_expr e) {
  return pl_kind_of(p, e) == PL_POW && pl_arg(p, e, 1).id == p->half.id;
}

// ------------------------------------------------------------------------------------- what occurs
typedef bool (*node_test)(const pl_pool* p, pl_expr e, uint32_t what);

static bool any_node(const pl_pool* p, pl_expr e, node_test test, uint32_t what) {
  if (pl_n_args(p, e) == 0) return test(p, e, what);
  pl_walk w;
  pl_walk_begin(&w, p, &e, 1);
  bool found = false;
  for (int i = 0; i < w.nodes.n && !found; i++) found = test(p, w.nodes.at[i], what);
  pl_walk_end(&w);
  return found;
}

static bool names_symbol(const pl_pool* p, pl_expr e, uint32_t what) {
  pl_kind k = pl_kind_of(p, e);
  return (k == PL_SYMBOL || k == PL_AT) && pl_node_at(p, e)->symbol == what;
}

// An element of a family counts as a coordinate or one of its derivatives.
static bool names_role(const pl_pool* p, pl_expr e, uint32_t what) {
  pl_kind k = pl_kind_of(p, e);
  if (k != PL_SYMBOL && k != PL_AT) return false;
  pl_role role = pl_symbol_get(p, pl_symbol_of(p, e))->role;
  if (role == (pl_role)what) return true;
  if (k != PL_AT || role != PL_R_ARRAY) return false;
  int dots = pl_dots_of(p, e);
  pl_role element = dots == 0 ? PL_R_COORD : dots == 1 ? PL_R_VELOCITY : PL_R_ACCELERATION;
  return element == (pl_role)what;
}

static bool is_name(const pl_pool* p, pl_expr e, uint32_t what) {
  pl_kind k = pl_kind_of(p, e);
  return k == PL_SYMBOL || k == PL_AT;
}

bool pl_has_symbol(const pl_pool* p, pl_expr e, pl_symbol s) {
  return any_node(p, e, names_symbol, s.id);
}
bool pl_has_role(const pl_pool* p, pl_expr e, pl_role r) { return any_node(p, e, names_role, r); }
bool pl_is_constant(const pl_pool* p, pl_expr e) { return !any_node(p, e, is_name, 0); }

static bool id_less(const void* a, const void* b, const void* user) {
  return ((const pl_symbol*)a)->id < ((const pl_symbol*)b)->id;
}

int pl_symbols_in(const pl_pool* p, pl_expr e, pl_symbol* out, int max) {
  PL_TEMP(pl_symbol) found = {0};
  pl_walk w;
  pl_walk_begin(&w, p, &e, 1);
  for (int i = 0; i < w.nodes.n; i++) {
    if (is_name(p, w.nodes.at[i], 0)) pl_temp_push(p, found, pl_symbol_of(p, w.nodes.at[i]));
  }
  pl_walk_end(&w);
  pl_sort(p, found.at, found.n, sizeof *found.at, id_less, NULL);
  int n = 0;
  for (int i = 0; i < found.n; i++) {
    if (i > 0 && found.at[i].id == found.at[i - 1].id) continue;
    if (out != NULL && n < max) out[n] = found.at[i];
    n++;
  }
  pl_temp_free(p, found);
  return n;
}
