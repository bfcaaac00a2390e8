// What is at hand while the step program are written (step_program_make.c,
// step_program_order.c).
#ifndef PL_STEP_PROGRAM_MAKE_IMPL_H
#define PL_STEP_PROGRAM_MAKE_IMPL_H

#include "solve/stepper/taylor/step_program_impl.h"

// One instance of a pattern: nodes base .. base + n_nodes - 1 of the whole.
typedef struct pl_maker_instance {
  const pl_batch* batch;
  const pl_tape* tape;
  int lane, base;
  bool observes;  // of an observer: only its energies count
} pl_maker_instance;

// A term: entry (row, col) of a matrix or a vector is the sum of nodes.
typedef struct pl_step_term {
  int row, col, node;
} pl_step_term;

typedef PL_VEC(int) pl_stream_places;  // of streams, row 0

// A product that is summed over the orders: one lane of a group of eight.
typedef struct pl_maker_sum {
  int node, i, cell;
  pl_recurrence_sum reads;
} pl_maker_sum;

// A lane of a stream of constants: 1 in all rows, or 1/k in row k; or what rounding left of these.
typedef struct pl_scale_lane {
  int at;
  bool of_order, rest;
} pl_scale_lane;

typedef struct pl_maker_groups pl_maker_groups;

typedef struct pl_maker {
  pl_run* run;
  pl_step_program* o;
  pl_arena* a;  // of the run: programs and memory
  pl_maker_instance* instance;
  int n_instances;
  int n_nodes;
  const pl_real* real;  // the step program are for numbers of this type; NULL: doubles
  pl_parts* constant;   // of each node of level CONST, then
  int* owner;           // instance of each node
  int* same;            // the first node that is the same quantity: that one stands for all
  bool *needed, *high;  // at order 0; above
  bool* for_energy;     // at order 0, for the energies
  int *cell, *inverse;  // places in memory of order 0 and of the reciprocal; -1
  int* keep;            // place in a row of what later orders of speed nodes read; -1
  int n_keep, keep_at;
  struct pl_sum_cells {
    int i[3];
  } * sum_cell;                        // place of convolution i of a node; -1
  pl_stream_places *plain, *weighted;  // streams that a node is written to
  PL_VEC(pl_step_term) M, G, gt, g, g_terms, h, energy;
  // streams of -a_k (row k+1), λ_k (row k+1), v_k (row k)
  pl_stream_places *from_a, *from_lambda, *from_v;
  pl_stream_places* row_sums;  // places of the sums of a row's products: by unknown
  PL_VEC(pl_scale_lane) scales;
  pl_maker_groups* groups;  // of eight sums
  bool* entry;              // structure of the system
  pl_step_elimination* elimination;
  // the code at work
  pl_prog* code;
  pl_recurrence lower;
  int instance_now;
  // registers of order 0, order at work, order k+1 of nodes of q and t
  int *start, *now, *position_now;
  bool with_sums, velocity_phase;
} pl_maker;

static inline const pl_tape_node* pl_maker_node(const pl_maker* k, int node) {
  const pl_maker_instance* i = &k->instance[k->owner[node]];
  return &i->tape->nodes[node - i->base];
}

// The node that stands for node i of an instance.
static inline int pl_maker_same(const pl_maker* k, int instance, int node) {
  return k->same[k->instance[instance].base + node];
}

int pl_maker_take(pl_maker* k, int n);  // n numbers of memory, aligned to 8
void pl_maker_begin(pl_maker* k, pl_step_part part, const char* name, int width);
void pl_maker_end(pl_maker* k);
int pl_maker_start(pl_maker* k, int node);  // register of order 0
// order 0 of the nodes of a level
void pl_maker_level(pl_maker* k, pl_tape_level level, const bool* set);
// ---- step_program_nodes.c
void pl_maker_instances(pl_maker* k);  // instances, which nodes are the same
void pl_maker_terms(pl_maker* k);      // entries, which nodes are needed
// ---- step_program_order.c
// convolutions: groups, streams, places of sums
void pl_maker_streams(pl_maker* k);
void pl_maker_start_code(pl_maker* k);
void pl_maker_order_code(pl_maker* k);

#endif
