// Room for the series of a tape, and the things that happen once: constants, time.
#include "program/jet.h"

static int count_series(const pl_tape* tape, int from, int to, bool high) {
  int n = 0;
  for (int i = from; i < to; i++)
    n += pl_op_series[tape->nodes[i].op] && (!high || tape->nodes[i].high);
  return n;
}

// Series nodes of a level, those that the motion needs above order 0 first.
static void list_series(pl_jet* j, pl_arena* a, int level) {
  const pl_tape* tape = j->tape;
  int from = level == 0 ? 0 : tape->level_end[level - 1], to = tape->level_end[level], n = 0;
  int* list = PL_ARRAY(a, int, count_series(tape, from, to, false) + 1);
  for (int pass = 0; pass < 2; pass++) {
    for (int i = from; i < to; i++)
      if (pl_op_series[tape->nodes[i].op] && tape->nodes[i].high == (pass == 0)) list[n++] = i;
    if (pass == 0) j->n_series_high[level] = n;
  }
  j->series[level] = list;
  j->n_series[level] = n;
}

// The interpreter for this processor.  All builds give the same bits.
pl_kernel pl_jet_interpret_plain, pl_jet_interpret_avx2, pl_jet_interpret_avx512;

static void interpret(pl_jet* j, pl_tape_level level, int k, bool all) {
#ifdef PL_KERNELS_BY_PROCESSOR
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl")
      && __builtin_cpu_supports("avx512dq"))
    pl_jet_interpret_avx512(j, level, k, all);
  else if (__builtin_cpu_supports("fma") && __builtin_cpu_supports("avx2"))
    pl_jet_interpret_avx2(j, level, k, all);
  else
#endif
    pl_jet_interpret_plain(j, level, k, all);
}

// Constants whose higher coefficients, zero, are read by the sum of a series.
static bool* find_summed(pl_arena* a, const pl_tape* tape) {
  bool* summed = PL_ARRAY(a, bool, tape->n_nodes + 1);
  for (int i = 0; i < tape->n_nodes; i++) {
    const pl_tape_node* n = &tape->nodes[i];
    int operand[] = {n->a, n->b, n->c};
    for (int o = 0; pl_op_series[n->op] && o < 3; o++)
      if (operand[o] >= 0 && i >= tape->level_end[PL_LEVEL_CONST]) summed[operand[o]] = true;
  }
  return summed;
}

// Orders that a node has room for.  Inputs are filled in to all orders, whoever reads them.
static int room(const pl_tape* tape, int node, int orders, bool lean, bool summed) {
  const pl_tape_node* n = &tape->nodes[node];
  if (node < tape->level_end[PL_LEVEL_CONST]) return summed ? orders : 1;
  return lean && !n->high && pl_op_reads[n->op] > 0 && orders > 2 ? 2 : orders;
}

static pl_jet* make(pl_arena* a, const pl_tape* tape, int lanes, int orders, bool lean) {
  pl_jet* j = PL_NEW(a, pl_jet);
  bool* summed = find_summed(a, tape);
  size_t rows = 0;
  j->tape = tape;
  j->lanes = lanes;
  j->orders = orders;
  j->at = PL_ARRAY(a, size_t, tape->n_nodes + 1);
  for (int i = 0; i < tape->n_nodes; i++) {
    j->at[i] = rows;
    rows += (size_t)room(tape, i, orders, lean, summed[i]);
  }
  j->c = PL_ARRAY(a, double, (size_t)lanes* rows + 1);
  j->kernel = interpret;
  for (int level = 0; level < PL_N_LEVELS; level++) list_series(j, a, level);
  return j;
}

pl_jet* pl_jet_make(pl_arena* a, const pl_tape* tape, int lanes, int orders) {
  return make(a, tape, lanes, orders, false);
}
pl_jet* pl_jet_make_lean(pl_arena* a, const pl_tape* tape, int lanes, int orders) {
  return make(a, tape, lanes, orders, true);
}

static void fill(double* x, double value, int lanes) {
  for (int l = 0; l < lanes; l++) x[l] = value;
}

void pl_jet_constants(pl_jet* j, const double* index) {
  const pl_tape* tape = j->tape;
  for (int i = 0; i < tape->level_end[PL_LEVEL_CONST]; i++) {
    const pl_tape_node* node = &tape->nodes[i];
    double* x = pl_jet_at(j, i, 0);
    if (node->op == PL_OP_CONST) fill(x, node->value, j->lanes);
    else if (node->op == PL_OP_PARAM) fill(x, tape->param_value[node->slot], j->lanes);
    else if (node->op == PL_OP_INDEX)
      for (int l = 0; l < j->lanes; l++) x[l] = index[node->slot * j->lanes + l];
  }
  j->kernel(j, PL_LEVEL_CONST, 0, true);
}

void pl_jet_time(pl_jet* j, double t) {
  const pl_tape* tape = j->tape;
  for (int i = tape->level_end[PL_LEVEL_CONST]; i < tape->level_end[PL_LEVEL_POSITION]; i++) {
    if (tape->nodes[i].op != PL_OP_TIME) continue;
    fill(pl_jet_at(j, i, 0), t, j->lanes);
    for (int k = 1; k < j->orders; k++) fill(pl_jet_at(j, i, k), k == 1 ? 1 : 0, j->lanes);
  }
}
