// The implicit method: which entries of its systems can be other than zero.
//
// Small systems are dense. For large ones each node of a program is asked which coordinates it
// depends on; a row that it stands in then has entries in those columns. The lists of all
// instances, sorted by column and row, are the structure.
#include <stdlib.h>
#include <string.h>

#include "solve/stepper/radau/radau_impl.h"

// ----------------------------------------------------------------------------------- sets of slots
typedef struct slots {
  uint64_t* bit;
  size_t words;
} slots;  // one set of coordinates after the other

static slots make_slots(pl_arena* a, int n, int n_q) {
  size_t words = ((size_t)n_q + 63) / 64;
  return (slots){PL_ARRAY(a, uint64_t, (size_t)n * words + 1), words};
}

static void put(slots* s, int set, int slot) {
  s->bit[(size_t)set * s->words + (size_t)slot / 64] |= 1ull << (slot % 64);
}
static void join(slots* to, int set, const slots* from, int other) {
  for (size_t w = 0; w < to->words; w++)
    to->bit[(size_t)set * to->words + w] |= from->bit[(size_t)other * from->words + w];
}

// Coordinates that each node depends on, itself or through its velocity.
static slots dependence(pl_arena* a, const pl_tape* tape) {
  slots s = make_slots(a, tape->n_nodes, tape->n_q);
  for (int q = 0; q < tape->n_q; q++) {
    if (tape->q_node[q] >= 0) put(&s, tape->q_node[q], q);
    if (tape->v_node[q] >= 0) put(&s, tape->v_node[q], q);
  }
  for (int i = tape->level_end[PL_LEVEL_CONST]; i < tape->level_end[PL_LEVEL_VELOCITY]; i++) {
    const pl_tape_node* node = &tape->nodes[i];
    if (pl_op_reads[node->op] > 0) join(&s, i, &s, node->a);
    if (pl_op_reads[node->op] > 1) join(&s, i, &s, node->b);
    if (pl_op_reads[node->op] > 2) join(&s, i, &s, node->c);
  }
  return s;
}

// ------------------------------------------------------------------------------------- one pattern
// Columns of each row of a pattern: coordinate rows first, then constraints.
static slots rows_of(pl_arena* a, const pl_batch* b, const pl_run* run) {
  const pl_pattern* p = b->pattern;
  slots node = dependence(a, p->tape), row = make_slots(a, p->n_q + p->n_c, p->n_q);
#define NODE(e) p->tape->roots[(e)->root]
  for (const pl_pattern_entry* e = p->mass; e < p->mass + p->n_mass; e++) {
    put(&row, e->row, e->col);
    put(&row, e->col, e->row);
    join(&row, e->row, &node, NODE(e));
    join(&row, e->col, &node, NODE(e));
  }
  for (const pl_pattern_entry* e = p->h; e < p->h + p->n_h; e++) join(&row, e->row, &node, NODE(e));
  for (const pl_pattern_entry* e = p->W; e < p->W + p->n_W; e++) join(&row, e->row, &node, NODE(e));
  for (const pl_pattern_entry* e = p->G; e < p->G + p->n_G; e++) {
    put(&row, p->n_q + e->row, e->col);
    join(&row, e->col, &node, NODE(e));
    join(&row, p->n_q + e->row, &node, NODE(e));
  }
  for (const pl_pattern_entry* e = p->gt; e < p->gt + p->n_gt; e++)
    join(&row, p->n_q + e->row, &node, NODE(e));
  // slip follows from the coefficients of its friction, whichever they are
  for (const pl_pattern_entry* e = p->outputs; e < p->outputs + p->n_out; e++)
    for (int c = 0; c < p->n_c; c++)
      if (run->setup->constraints[b->c[c * b->lanes]].slip) join(&row, p->n_q + c, &node, NODE(e));
#undef NODE
  return row;
}

// ------------------------------------------------------------------------------------- all of them
// Entries column by column: with row NULL they are counted into start[col + 1], else written at
// start[col]++.
typedef struct list {
  int *start, *row;
} list;

static void note(list* l, int row, int col) {
  if (l->row == NULL) l->start[col + 1]++;
  else l->row[l->start[col]++] = row;
}

static void note_columns(list* l, const pl_batch* b, const slots* of, int set, int row, int lane) {
  for (size_t w = 0; w < of->words; w++) {
    for (uint64_t bits = of->bit[(size_t)set * of->words + w]; bits; bits &= bits - 1) {
      int slot = (int)w * 64 + __builtin_ctzll(bits);
      note(l, row, b->q[slot * b->lanes + lane]);
    }
  }
}

static void note_batch(list* l, const pl_run* run, const pl_batch* b, const slots* of) {
  const pl_pattern* p = b->pattern;
  for (int lane = 0; lane < b->n; lane++) {
    const int *q = b->q + lane, *c = b->c + lane;
    for (int i = 0; i < p->n_q; i++) note_columns(l, b, of, i, q[i * b->lanes], lane);
    for (int i = 0; i < p->n_c; i++)
      note_columns(l, b, of, p->n_q + i, run->n_q + c[i * b->lanes], lane);
    for (const pl_pattern_entry* e = p->G; e < p->G + p->n_G; e++)
      note(l, q[e->col * b->lanes], run->n_q + c[e->row * b->lanes]);
    for (const pl_pattern_entry* e = p->W; e < p->W + p->n_W; e++)
      note(l, q[e->row * b->lanes], run->n_q + c[e->col * b->lanes]);
  }
}

static void note_all(list* l, const pl_run* run, const slots* of) {
  for (int i = 0; i < run->n_q + run->n_c; i++) note(l, i, i);
  for (int i = 0; i < run->dae.motion.n; i++) note_batch(l, run, &run->dae.motion.at[i], &of[i]);
  for (int k = 0; k < run->setup->n_frictions; k++) {
    const pl_friction_setup* friction = &run->setup->frictions[k];
    for (int i = 0; i < friction->n_rows; i++)
      note(l, run->n_q + friction->row[i], run->n_q + friction->constraint);
  }
}

static int by_number(const void* a, const void* b) { return *(const int*)a - *(const int*)b; }

// Sorts each column and drops what stands there twice; start[col] is the end of column col.
static void tidy(list* l, int n) {
  int to = 0, from = 0;
  for (int col = 0; col < n; col++) {
    int end = l->start[col], first = to;
    qsort(l->row + from, (size_t)(end - from), sizeof(int), by_number);
    for (int k = from; k < end; k++)
      if (to == first || l->row[to - 1] != l->row[k]) l->row[to++] = l->row[k];
    l->start[col] = first;
    from = end;
  }
  l->start[n] = to;
}

void pl_radau_shape_make(pl_run* run, pl_radau* r) {
  pl_arena* a = run->job->arena;
  int n = r->n;
  r->shape = (pl_radau_shape){.n = n, .n_values = n * n};
  if (n <= PL_RADAU_DENSE_UP_TO) return;
  slots* of = PL_ARRAY(a, slots, run->dae.motion.n + 1);
  for (int i = 0; i < run->dae.motion.n; i++) {
    // the batches of one pattern follow each other
    bool same = i > 0 && run->dae.motion.at[i].pattern == run->dae.motion.at[i - 1].pattern;
    of[i] = same ? of[i - 1] : rows_of(a, &run->dae.motion.at[i], run);
  }
  list l = {PL_ARRAY(a, int, n + 1), NULL};
  note_all(&l, run, of);
  for (int col = 0; col < n; col++) l.start[col + 1] += l.start[col];
  l.row = PL_ARRAY(a, int, l.start[n] + 1);
  note_all(&l, run, of);
  tidy(&l, n);
  r->shape = (pl_radau_shape){n, l.start[n], l.start, l.row};
}
