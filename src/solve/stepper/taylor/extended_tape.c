// Tapes in extended numbers: constants of a tape, and sheets, which hold all nodes of some patterns
// at one point.
#include "solve/stepper/taylor/extended_impl.h"

// ------------------------------------------------------------------------------------ one instance
typedef struct writer {
  pl_prog* code;
  int base;    // memory of node 0
  int* known;  // register of a node, -1: in memory
} writer;

static int start_of(void* user, int node) {
  writer* w = user;
  if (w->known[node] < 0) w->known[node] = pl_prog_load(w->code, w->base + node, 0);
  return w->known[node];
}

static void keep(writer* w, int node, int x) {
  w->known[node] = x;
  pl_prog_store(w->code, x, w->base + node, 0);
}

// Nodes of levels CONST that are computed, first .. end - 1.
static void write_nodes(writer* w, const pl_tape* tape, int first, int end) {
  pl_recurrence lower = {.code = w->code, .tape = tape, .user = w, .start = start_of};
  for (int i = first; i < end; i++) {
    int x = pl_recurrence_value(&lower, i);
    if (x >= 0) keep(w, i, x);
  }
}

static void no_registers(int* known, int n) {
  for (int i = 0; i < n; i++) known[i] = -1;
}

// --------------------------------------------------------------------------------------- constants
// Inputs of level CONST: numbers in parts, the others as given.
static void fill_inputs(const pl_real* real, void* m, const pl_tape* tape, const pl_batch* b,
                        int lane) {
  for (int i = 0; i < tape->level_end[PL_LEVEL_CONST]; i++) {
    const pl_tape_node* n = &tape->nodes[i];
    if (n->op == PL_OP_CONST) real->set(m, i, (pl_parts){{n->value, n->rest[0], n->rest[1]}});
    else if (n->op == PL_OP_PARAM) real->set(m, i, (pl_parts){{tape->param_value[n->slot]}});
    else if (n->op == PL_OP_INDEX)
      real->set(m, i, (pl_parts){{b ? pl_jet_at(b->jet, i, 0)[lane] : 0}});
  }
}

static void constants(pl_arena* a, const pl_real* real, const pl_tape* tape, const pl_batch* b,
                      int lane, pl_parts* out) {
  int n = tape->level_end[PL_LEVEL_CONST];
  pl_prog* code = pl_prog_make(a, "constants", 1);
  writer w = {code, 0, PL_ARRAY(a, int, n + 1)};
  no_registers(w.known, n);
  write_nodes(&w, tape, 0, n);
  code->spill = n;
  char* m = PL_ARRAY(a, char, ((size_t)n + (size_t)code->n_registers + 1) * real->size);
  fill_inputs(real, m, tape, b, lane);
  real->interpret(code, m, 0, 1);
  for (int i = 0; i < n; i++) out[i] = real->get(m, i);
}

void pl_extended_constants(pl_arena* a, const pl_real* real, const pl_batch* b, int lane,
                           pl_parts* out) {
  constants(a, real, b->pattern->tape, b, lane, out);
}

void pl_extended_roots(pl_arena* a, const pl_real* real, const pl_tape* tape, pl_parts* out) {
  pl_parts* node = PL_ARRAY(a, pl_parts, tape->n_nodes + 1);
  constants(a, real, tape, NULL, 0, node);
  for (int i = 0; i < tape->n_roots; i++) out[i] = node[tape->roots[i]];
}

// ------------------------------------------------------------------------------------------ sheets
static int input_place(const pl_sheet* s, const pl_batch* b, const pl_tape_node* n, int lane) {
  int slot = n->slot * b->lanes + lane;
  switch ((pl_op)n->op) {
    case PL_OP_TIME: return s->time;
    case PL_OP_Q: return s->Q + b->q[slot];
    case PL_OP_V: return s->V + b->q[slot];
    case PL_OP_A: return s->A + b->q[slot];
    case PL_OP_LAMBDA: return s->L + b->c[slot];
    default: return -1;
  }
}

static void write_instance(pl_sheet* s, writer* w, const pl_batch* b, int lane, int* sum) {
  const pl_tape* tape = b->pattern->tape;
  int first = tape->level_end[PL_LEVEL_CONST];
  no_registers(w->known, tape->n_nodes);
  for (int i = first; i < tape->n_nodes; i++) {
    int from = input_place(s, b, &tape->nodes[i], lane);
    if (from >= 0) keep(w, i, pl_prog_load(w->code, from, 0));
  }
  write_nodes(w, tape, first, tape->n_nodes);
  for (int e = 0; e < b->pattern->n_out; e++) {
    const pl_pattern_entry* o = &b->pattern->outputs[e];
    int x = start_of(w, tape->roots[o->root]), *to = &sum[b->out[o->row * b->lanes + lane]];
    *to = *to < 0 ? x : pl_prog_op2(w->code, PL_PROG_ADD, *to, x);
  }
}

static void write_constants(pl_sheet* s, pl_arena* a, const pl_batch* b, int lane, int base) {
  int n = b->pattern->tape->level_end[PL_LEVEL_CONST];
  pl_parts* x = PL_ARRAY(a, pl_parts, n + 1);
  pl_extended_constants(a, s->real, b, lane, x);
  for (int i = 0; i < n; i++) s->real->set(s->m, base + i, x[i]);
}

static int lay_out(pl_sheet* s, const pl_run* run, int n_out) {
  int at = 0, n_q = run->n_q;
  s->time = at++;
  s->Q = at;
  at += n_q;
  s->V = at;
  at += n_q;
  s->A = at;
  at += n_q;
  s->L = at;
  at += run->n_c;
  s->out = at;
  at += n_out;
  return at;
}

pl_sheet* pl_sheet_make(pl_run* run, const pl_real* real, const pl_batches* batches, int n_out) {
  pl_arena* a = run->job->arena;
  pl_sheet* s = PL_NEW(a, pl_sheet);
  s->real = real;
  s->code = pl_prog_make(a, "sheet", 1);
  int first = lay_out(s, run, n_out), at = first, most = 0, *sum = PL_ARRAY(a, int, n_out + 1);
  for (int i = 0; i < batches->n; i++)
    if (batches->at[i].pattern->tape->n_nodes > most) most = batches->at[i].pattern->tape->n_nodes;
  writer w = {s->code, 0, PL_ARRAY(a, int, most + 1)};
  no_registers(sum, n_out);
  for (int i = 0; i < batches->n; i++)
    for (int l = 0; l < batches->at[i].n; l++) {
      w.base = at;
      write_instance(s, &w, &batches->at[i], l, sum);
      at += batches->at[i].pattern->tape->n_nodes;
    }
  for (int i = 0; i < n_out; i++)
    pl_prog_store(s->code, sum[i] < 0 ? pl_prog_number(s->code, 0) : sum[i], s->out + i, 0);
  s->code->spill = at;
  s->m = PL_ARRAY(a, char, ((size_t)at + (size_t)s->code->n_registers + 1) * real->size);
  at = first;
  for (int i = 0; i < batches->n; i++)
    for (int l = 0; l < batches->at[i].n; l++) {
      write_constants(s, a, &batches->at[i], l, at);
      at += batches->at[i].pattern->tape->n_nodes;
    }
  return s;
}

void pl_sheet_run(pl_sheet* s) { s->real->interpret(s->code, s->m, 0, 1); }
