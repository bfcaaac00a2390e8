// The nodes of a motion: all instances of all patterns as one program, in which what is computed
// twice is computed once.
#include <string.h>

#include "solve/stepper/taylor/step_program_make_impl.h"
#include "solve/stepper/taylor/extended_impl.h"

// --------------------------------------------------------------------------------------- instances
static int count_instances(const pl_batches* b) {
  int n = 0;
  for (int i = 0; i < b->n; i++) n += b->at[i].n;
  return n;
}

static void list_instances(pl_maker* k, const pl_batches* batches, bool observe) {
  for (int i = 0; i < batches->n; i++) {
    const pl_batch* b = &batches->at[i];
    for (int l = 0; l < b->n; l++) {
      k->instance[k->n_instances++] = (pl_maker_instance){b, b->pattern->tape, l, k->n_nodes,
                                                          observe};
      k->n_nodes += b->pattern->tape->n_nodes;
    }
  }
}

static bool has_energy(const pl_run* run) {
  return run->setup->kinetic >= 0 && run->setup->potential >= 0;
}

static void reserve_nodes(pl_maker* k) {
  size_t n = (size_t)k->n_nodes + 1;
  k->owner = PL_ARRAY(k->a, int, n);
  k->needed = PL_ARRAY(k->a, bool, n);
  k->high = PL_ARRAY(k->a, bool, n);
  k->for_energy = PL_ARRAY(k->a, bool, n);
  int** ints[] = {&k->same, &k->cell, &k->inverse, &k->keep, &k->start, &k->now, &k->position_now};
  for (size_t i = 0; i < sizeof ints / sizeof *ints; i++) {
    *ints[i] = PL_ARRAY(k->a, int, n);
    for (size_t j = 0; j < n; j++) (*ints[i])[j] = -1;
  }
  k->sum_cell = PL_ARRAY(k->a, struct pl_sum_cells, n);
  for (size_t j = 0; j < n; j++) k->sum_cell[j] = (struct pl_sum_cells){{-1, -1, -1}};
  k->plain = PL_ARRAY(k->a, pl_stream_places, n);
  k->weighted = PL_ARRAY(k->a, pl_stream_places, n);
  for (int i = 0; i < k->n_instances; i++)
    for (int j = 0; j < k->instance[i].tape->n_nodes; j++) k->owner[k->instance[i].base + j] = i;
}

// ------------------------------------------------------------------------------------- equal nodes
// What makes two nodes the same quantity: operation, operands, and for an input which one. Numbers
// are compared by value.
typedef struct pl_node_key {
  uint64_t op, a, b, c, value;
} pl_node_key;

static pl_node_key key_of(const pl_maker* k, int node) {
  const pl_maker_instance* i = &k->instance[k->owner[node]];
  const pl_tape_node* n = pl_maker_node(k, node);
  pl_node_key key = {.op = n->op};
  if (n->level == PL_LEVEL_CONST && k->real) {
    const double* part = k->constant[node].part;
    key.op = PL_OP_CONST;
    memcpy(&key.value, &part[0], sizeof key.value);
    memcpy(&key.a, &part[1], sizeof key.a);
    memcpy(&key.b, &part[2], sizeof key.b);
    return key;
  }
  if (n->level == PL_LEVEL_CONST) {
    key.op = PL_OP_CONST;
    memcpy(&key.value, &pl_jet_at(i->batch->jet, node - i->base, 0)[i->lane], sizeof key.value);
    return key;
  }
  int slot = n->slot * i->batch->lanes + i->lane;
  if (n->op == PL_OP_Q || n->op == PL_OP_V || n->op == PL_OP_A)
    key.value = (uint64_t)i->batch->q[slot];
  if (n->op == PL_OP_LAMBDA) key.value = (uint64_t)i->batch->c[slot];
  if (n->a >= 0) key.a = (uint64_t)k->same[i->base + n->a] + 1;
  if (n->b >= 0) key.b = (uint64_t)k->same[i->base + n->b] + 1;
  if (n->op == PL_OP_IF) key.c = (uint64_t)k->same[i->base + n->c] + 1;
  return key;
}

static void find_same(pl_maker* k) {
  pl_map* seen = pl_map_make(k->a);
  for (int i = 0; i < k->n_nodes; i++) {
    pl_node_key key = key_of(k, i);
    uint64_t hash = pl_hash_bytes(&key, sizeof key, 1) | 1, first = pl_map_get(seen, hash);
    k->same[i] = i;
    if (first == 0) {
      pl_map_set(seen, hash, (uint64_t)i + 1);
      continue;
    }
    pl_node_key other = key_of(k, (int)first - 1);
    if (memcmp(&key, &other, sizeof key) == 0) k->same[i] = (int)first - 1;
  }
}

static void find_constants(pl_maker* k) {
  k->constant = PL_ARRAY(k->a, pl_parts, k->n_nodes + 1);
  for (int i = 0; i < k->n_instances; i++)
    pl_extended_constants(k->a, k->real, k->instance[i].batch, k->instance[i].lane,
                          k->constant + k->instance[i].base);
}

void pl_maker_instances(pl_maker* k) {
  k->instance = PL_ARRAY(
      k->a, pl_maker_instance,
      count_instances(&k->run->dae.motion) + count_instances(&k->run->observers) + 1);
  list_instances(k, &k->run->dae.motion, false);
  if (has_energy(k->run)) list_instances(k, &k->run->observers, true);
  reserve_nodes(k);
  if (k->real) find_constants(k);
  find_same(k);
}

// ----------------------------------------------------------------------------------------- entries
static int root(const pl_maker* k, const pl_maker_instance* i, int r) {
  return k->same[i->base + i->tape->roots[r]];
}

#define TERM(list, ...) pl_push(k->a, k->list, (pl_step_term){__VA_ARGS__})

static void list_terms_of(pl_maker* k, const pl_maker_instance* i) {
  const pl_batch* b = i->batch;
  const pl_pattern* p = b->pattern;
  int l = i->lane, lanes = b->lanes;
#define COORDINATE(slot) b->q[(slot)*lanes + l]
#define CONSTRAINT(slot) b->c[(slot)*lanes + l]
  for (int e = 0; e < p->n_mass; e++)
    TERM(M, COORDINATE(p->mass[e].row), COORDINATE(p->mass[e].col), root(k, i, p->mass[e].root));
  for (int e = 0; e < p->n_G; e++)
    TERM(G, CONSTRAINT(p->G[e].row), COORDINATE(p->G[e].col), root(k, i, p->G[e].root));
  for (int e = 0; e < p->n_gt; e++)
    TERM(gt, CONSTRAINT(p->gt[e].row), 0, root(k, i, p->gt[e].root));
  for (int e = 0; e < p->n_h; e++) TERM(h, COORDINATE(p->h[e].row), 0, root(k, i, p->h[e].root));
  for (int e = 0; e < p->n_g; e++) {
    TERM(g, CONSTRAINT(p->g[e].row), 0, root(k, i, p->g[e].root));
    if (p->g[e].col >= 0) TERM(g_terms, CONSTRAINT(p->g[e].row), 0, root(k, i, p->g[e].col));
  }
}

static void need(pl_maker* k, bool* set, int node) {
  PL_VEC(int) stack = {0};
  pl_push(k->a, stack, node);
  while (stack.n > 0) {
    int i = stack.at[--stack.n], base = k->instance[k->owner[i]].base;
    const int* same = k->same + base;
    if (set[i]) continue;
    set[i] = true;
    const pl_tape_node* n = pl_maker_node(k, i);
    if (n->a >= 0) pl_push(k->a, stack, same[n->a]);
    if (n->b >= 0) pl_push(k->a, stack, same[n->b]);
    if (n->c >= 0) pl_push(k->a, stack, same[n->c]);
  }
}

#define NEED(set, list) \
  for (int e = 0; e < k->list.n; e++) need(k, k->set, k->list.at[e].node)

static void list_energies(pl_maker* k, const pl_maker_instance* i) {
  const pl_batch* b = i->batch;
  for (int e = 0; e < b->pattern->n_out; e++) {
    const pl_pattern_entry* o = &b->pattern->outputs[e];
    int column = b->out[o->row * b->lanes + i->lane];
    if (column == k->run->setup->kinetic) TERM(energy, 0, 0, root(k, i, o->root));
    if (column == k->run->setup->potential) TERM(energy, 1, 0, root(k, i, o->root));
    if (column == k->run->setup->energy && column > 0) TERM(energy, 2, 0, root(k, i, o->root));
  }
}

static void find_needed(pl_maker* k) {
  NEED(needed, M);
  NEED(needed, G);
  NEED(needed, gt);
  NEED(needed, h);
  NEED(needed, g);
  NEED(needed, g_terms);
  NEED(high, M);
  NEED(high, G);
  NEED(high, gt);
  NEED(high, h);
  NEED(for_energy, energy);
}

void pl_maker_terms(pl_maker* k) {
  for (int i = 0; i < k->n_instances; i++) {
    if (k->instance[i].observes) list_energies(k, &k->instance[i]);
    else list_terms_of(k, &k->instance[i]);
  }
  find_needed(k);
}
