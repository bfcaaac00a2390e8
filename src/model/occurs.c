// What occurs in an expression: velocities, accelerations, coordinates, only constants.
#include "model_impl.h"

// pl_is_constant for a pass that asks at every node: remembers the answers.
bool pl_is_constant_known(const pl_pool* p, pl_map* known, pl_expr e) {
  switch (pl_kind_of(p, e)) {
    case PL_NUMBER:
    case PL_PI:
    case PL_INFINITY:
    case PL_POISON: return true;
    case PL_SYMBOL:
    case PL_AT:
    case PL_SUM:
    case PL_UNKNOWN_FUNCTION: return false;
    default: break;
  }
  uint64_t answer = pl_map_get(known, e.id);
  if (answer) return answer == 2;
  bool constant = true;
  for (int i = 0; i < pl_n_args(p, e) && constant; i++)
    constant = pl_is_constant_known(p, known, pl_arg(p, e, i));
  pl_map_set(known, e.id, constant ? 2 : 1);
  return constant;
}

static int max_dots(const pl_pool* p, pl_expr e, pl_map* visited) {
  if (pl_is_poison(e) || pl_map_get(visited, e.id)) return 0;
  pl_map_set(visited, e.id, 1);
  pl_kind kind = pl_kind_of(p, e);
  int most = 0;
  if (kind == PL_AT) most = pl_dots_of(p, e);
  if (kind == PL_SYMBOL) {
    const pl_symbol_info* info = pl_symbol_get(p, pl_symbol_of(p, e));
    bool moves = info->role == PL_R_VELOCITY || info->role == PL_R_ACCELERATION;
    most = moves ? info->dots : 0;
  }
  for (int i = 0; i < pl_n_args(p, e); i++) {
    int k = max_dots(p, pl_arg(p, e, i), visited);
    if (k > most) most = k;
  }
  return most;
}

// 1 when velocities occur, 2 when accelerations do; elements of families count.
int pl_max_dots(const pl_pool* p, pl_expr e, pl_arena* scratch) {
  if (pl_is_poison(e) || pl_is_constant(p, e)) return 0;
  return max_dots(p, e, pl_map_make(scratch));
}

static bool moves(const pl_pool* p, pl_expr e, pl_map* visited) {
  if (pl_is_poison(e) || pl_map_get(visited, e.id)) return false;
  pl_map_set(visited, e.id, 1);
  pl_kind kind = pl_kind_of(p, e);
  if (kind == PL_AT) return true;
  if (kind == PL_SYMBOL) {
    pl_role r = pl_symbol_get(p, pl_symbol_of(p, e))->role;
    return r == PL_R_COORD || r == PL_R_VELOCITY || r == PL_R_ACCELERATION;
  }
  for (int i = 0; i < pl_n_args(p, e); i++) {
    if (moves(p, pl_arg(p, e, i), visited)) return true;
  }
  return false;
}

bool pl_has_coordinate(const pl_pool* p, pl_expr e, pl_arena* scratch) {
  return !pl_is_poison(e) && !pl_is_constant(p, e) && moves(p, e, pl_map_make(scratch));
}
