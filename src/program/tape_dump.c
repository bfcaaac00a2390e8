// A tape as text, for `pleuel dump --after=record` and for golden files.
#include "program/tape.h"

static void dump_input(pl_text* out, const pl_pool* pool, const pl_tape* tape,
                       const pl_tape_node* node) {
  switch (node->op) {
    case PL_OP_CONST: pl_text_addf(out, " %.17g", node->value); break;
    case PL_OP_PARAM: {
      const pl_symbol_info* info = pl_symbol_get(pool, tape->param_symbol[node->slot]);
      pl_text_addf(out, " %s = %.17g", info->ascii, tape->param_value[node->slot]);
      break;
    }
    case PL_OP_TIME: break;
    default: pl_text_addf(out, " [%d]", node->slot);
  }
}

static void dump_node(pl_text* out, const pl_pool* pool, const pl_tape* tape, int i) {
  const pl_tape_node* node = &tape->nodes[i];
  pl_text_addf(out, "  r%d = %s", i, pl_op_name[node->op]);
  if (pl_op_reads[node->op] == 0) dump_input(out, pool, tape, node);
  if (node->a >= 0) pl_text_addf(out, " r%d", node->a);
  if (node->b >= 0) pl_text_addf(out, " r%d", node->b);
  if (node->c >= 0) pl_text_addf(out, " | r%d", node->c);
  pl_text_add(out, node->high ? "\n" : "    order 0 only\n");
}

void pl_tape_dump(pl_text* out, const pl_pool* pool, const pl_tape* tape) {
  static const char* const title[PL_N_LEVELS] = {"constants", "of q, t", "of q, v, t",
                                                 "of accelerations or multipliers"};
  for (int level = 0, i = 0; level < PL_N_LEVELS; level++) {
    if (i < tape->level_end[level]) pl_text_addf(out, "%s\n", title[level]);
    for (; i < tape->level_end[level]; i++) dump_node(out, pool, tape, i);
  }
  pl_text_add(out, "roots");
  for (int i = 0; i < tape->n_roots; i++) pl_text_addf(out, " r%d", tape->roots[i]);
  pl_text_add(out, "\n");
}
