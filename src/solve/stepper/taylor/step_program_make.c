// Writing the step program: which nodes are needed, where they lie, the point and the
// projection.
#include "solve/stepper/taylor/step_program_make_impl.h"

int pl_maker_take(pl_maker* k, int n) {
  int at = k->o->size;
  k->o->size += (n + 7) / 8 * 8;
  return at;
}

// ------------------------------------------------------------------------------------------ limits
bool pl_step_program_fits(const pl_run* run) {
  long nodes = 0;
  if (run->n_q + run->n_c > PL_STEP_UNKNOWNS || run->dae.has_W || run->dae.mass_of_velocity
      || run->setup->n_frictions > 0)
    return false;
  for (int i = 0; i < run->dae.motion.n; i++) {
    const pl_batch* b = &run->dae.motion.at[i];
    nodes += (long)b->n * b->pattern->tape->n_nodes;
  }
  return nodes <= PL_STEP_NODES;
}

// -------------------------------------------------------------------------------- unknowns, memory
static bool has_mass(const pl_maker* k, int i) {
  for (int e = 0; e < k->M.n; e++)
    if (k->M.at[e].row == i && k->M.at[e].col == i) return true;
  return false;
}

static void number_unknowns(pl_maker* k) {
  pl_step_program* o = k->o;
  o->of_coordinate = PL_ARRAY(k->a, int, o->n_q + 1);
  o->of_constraint = PL_ARRAY(k->a, int, o->n_c + 1);
  o->index = PL_ARRAY(k->a, int, o->n_q + o->n_c + 1);
  for (int i = 0; i < o->n_q; i++) {
    o->of_coordinate[i] = -1;
    if (has_mass(k, i)) {
      o->index[o->n] = i;
      o->of_coordinate[i] = o->n++;
    }
  }
  o->n_mass = o->n;
  for (int i = 0; i < o->n_q; i++)  // what nothing determines rests and is no unknown
    if (o->of_coordinate[i] < 0 && k->run->dae.has_equation[i] != 0) {
      o->index[o->n] = i;
      o->of_coordinate[i] = o->n++;
    }
}

static void number_constraints(pl_maker* k) {
  pl_step_program* o = k->o;
  for (int c = 0; c < o->n_c; c++) {
    o->of_constraint[c] = -1;
    if (o->taken[c]) {
      o->index[o->n] = c;
      o->of_constraint[c] = o->n++;
      o->n_taken++;
    }
  }
}

static void mark_entry(pl_maker* k, int i, int j) {
  if (i < 0 || j < 0) return;
  k->entry[i * k->o->n + j] = k->entry[j * k->o->n + i] = true;
}

static void find_structure(pl_maker* k) {
  pl_step_program* o = k->o;
  k->entry = PL_ARRAY(k->a, bool, (size_t)o->n*(size_t)o->n + 1);
  for (int e = 0; e < k->M.n; e++)
    mark_entry(k, o->of_coordinate[k->M.at[e].row], o->of_coordinate[k->M.at[e].col]);
  for (int e = 0; e < k->G.n; e++)
    mark_entry(k, o->of_constraint[k->G.at[e].row], o->of_coordinate[k->G.at[e].col]);
}

static void lay_out(pl_maker* k) {
  pl_step_program* o = k->o;
  int n_q = o->n_q, n_c = o->n_c, rows = o->orders;
  o->time = pl_maker_take(k, rows + 2);
  o->ratio = pl_maker_take(k, rows + 2);
  o->rest = pl_maker_take(k, rows + 2);
  o->Q = pl_maker_take(k, rows * n_q);
  o->V = pl_maker_take(k, rows * n_q);
  o->A = pl_maker_take(k, rows * n_q);
  o->L = pl_maker_take(k, rows * n_c);
  o->energy = pl_maker_take(k, 3);
  o->norms = pl_maker_take(k, 2 * PL_BLOCK_ROWS);
  o->length = pl_maker_take(k, 1);
  o->end_q = pl_maker_take(k, n_q);
  o->end_v = pl_maker_take(k, n_q);
  o->end_a = pl_maker_take(k, n_q);
  o->off = pl_maker_take(k, 2);
  int* of_q[] = {&o->q_floor, &o->v_floor, &o->h, &o->move};
  int* of_c[] = {&o->g, &o->g_size, &o->argument, &o->r, &o->r_size};
  for (size_t i = 0; i < sizeof of_q / sizeof *of_q; i++) *of_q[i] = pl_maker_take(k, n_q);
  for (size_t i = 0; i < sizeof of_c / sizeof *of_c; i++) *of_c[i] = pl_maker_take(k, n_c);
  int blocks = (o->n + 7) / 8;
  o->vector = pl_maker_take(k, o->n);
  o->pivot = pl_maker_take(k, o->n);
  o->pivot_size = pl_maker_take(k, o->n);
  o->size_most = PL_ARRAY(k->a, double, o->n + 1);
  if (o->n <= o->inverse_up_to) {
    o->result = pl_maker_take(k, 8 * blocks);
    o->matrix = pl_maker_take(k, o->n * 8 * blocks);
    o->identity = pl_maker_take(k, o->n * 8 * blocks);
  }
  int at = o->size;
  for (int i = 0; i < k->n_nodes; i++) {
    if (k->needed[i] || k->for_energy[i]) k->cell[i] = at++;
    if (k->high[i]
        && pl_recurrence_has_inverse(k->instance[k->owner[i]].tape,
                                     i - k->instance[k->owner[i]].base))
      k->inverse[i] = at++;
  }
  k->elimination = pl_step_elimination_make(k->a, k->entry, o->n, o->n_mass, o->n - o->n_taken,
                                            &at);
  pl_maker_take(k, at - o->size);
}

// --------------------------------------------------------------------------------------- registers
static int start_of(void* user, int node) {
  pl_maker* k = user;
  return pl_maker_start(k, pl_maker_same(k, k->instance_now, node));
}

static int now_of(void* user, int node) {
  pl_maker* k = user;
  int global = pl_maker_same(k, k->instance_now, node);
  if (node < k->instance[k->instance_now].tape->level_end[PL_LEVEL_CONST]) return -1;
  if (!k->velocity_phase) return k->position_now[global];
  if (k->now[global] < 0 && k->keep[global] >= 0)
    k->now[global] = pl_prog_load(k->code, k->keep_at + k->keep[global], k->n_keep);
  return k->now[global];
}

static int sum_of(void* user, int node, int i) {
  pl_maker* k = user;
  int cell = k->sum_cell[pl_maker_same(k, k->instance_now, node)].i[i];
  return k->with_sums && cell >= 0 ? pl_prog_load(k->code, cell, 0) : -1;
}

static int inverse_of(void* user, int node) {
  pl_maker* k = user;
  return pl_prog_load(k->code, k->inverse[pl_maker_same(k, k->instance_now, node)], 0);
}

int pl_maker_start(pl_maker* k, int node) {
  const pl_tape_node* n = pl_maker_node(k, node);
  if (k->start[node] < 0)
    k->start[node] = n->op == PL_OP_CONST && !k->real ? pl_prog_number(k->code, n->value)
                                                      : pl_prog_load(k->code, k->cell[node], 0);
  return k->start[node];
}

void pl_maker_begin(pl_maker* k, pl_step_part part, const char* name, int width) {
  k->code = k->o->code[part] = pl_prog_make(k->a, name, width);
  k->lower = (pl_recurrence){.code = k->code,
                             .user = k,
                             .start = start_of,
                             .now = now_of,
                             .sum = sum_of,
                             .inverse = inverse_of,
                             .means = true};
  for (int i = 0; i < k->n_nodes; i++) k->start[i] = k->now[i] = k->position_now[i] = -1;
  k->with_sums = k->velocity_phase = false;
}

void pl_maker_end(pl_maker* k) {
  k->code->spill = k->o->size;
  pl_maker_take(k, k->code->n_registers * k->code->width);
}

// Order 0 of a node and its reciprocal, into memory.
static int pl_maker_value(pl_maker* k, int node) {
  pl_maker_instance* i = &k->instance[k->owner[node]];
  k->instance_now = k->owner[node];
  k->lower.tape = i->tape;
  int x = pl_recurrence_value(&k->lower, node - i->base);
  if (x >= 0) {
    k->start[node] = x;
    pl_prog_store(k->code, x, k->cell[node], 0);
  }
  return x;
}

// --------------------------------------------------------------------------------------- the point
// Sum of the nodes of one row; -1 without any.
#define SUM_OF_ROW(list, r)                                             \
  int row_ = -1;                                                        \
  for (int e_ = 0; e_ < k->list.n; e_++) {                              \
    if (k->list.at[e_].row != (r)) continue;                            \
    int x_ = pl_maker_start(k, k->list.at[e_].node);                    \
    row_ = row_ < 0 ? x_ : pl_prog_op2(k->code, PL_PROG_ADD, row_, x_); \
  }

static int or_zero(pl_maker* k, int x) { return x < 0 ? pl_prog_number(k->code, 0) : x; }

// |dg/dq| |q| added to the sum of the terms: pl_assemble_g.
static void size_of_constraint(pl_maker* k, int c) {
  pl_prog* code = k->code;
  pl_step_program* o = k->o;
  SUM_OF_ROW(g_terms, c);
  int terms = or_zero(k, row_), size = terms;
  for (int e = 0; e < k->G.n; e++) {
    if (k->G.at[e].row != c) continue;
    int x = pl_prog_op1(code, PL_PROG_ABS, pl_maker_start(k, k->G.at[e].node));
    size = pl_prog_op3(code, PL_PROG_FMA, x, pl_prog_load(code, o->q_floor + k->G.at[e].col, 0),
                       size);
  }
  pl_prog_store(code, size, o->g_size + c, 0);
  int ratio = pl_prog_op2(code, PL_PROG_DIV, size, terms);
  pl_prog_store(code, pl_prog_op3(code, PL_PROG_IF_MORE, terms, ratio, pl_prog_number(code, 1)),
                o->argument + c, 0);
}

static void constraint_values(pl_maker* k) {
  for (int c = 0; c < k->o->n_c; c++) {
    SUM_OF_ROW(g, c);
    pl_prog_store(k->code, or_zero(k, row_), k->o->g + c, 0);
    size_of_constraint(k, c);
  }
}

static void add_to(pl_maker* k, int* entry, int i, int j, int x) {
  if (i < 0 || j < 0) return;
  int* at = &entry[i * k->o->n + j];
  *at = *at < 0 ? x : pl_prog_op2(k->code, PL_PROG_ADD, *at, x);
  entry[j * k->o->n + i] = *at;
}

static void factor(pl_maker* k) {
  pl_step_program* o = k->o;
  int n = o->n;
  int* entry = PL_ARRAY(k->a, int, (size_t)n*(size_t)n + 1);
  int *pivot = PL_ARRAY(k->a, int, n + 1), *size = PL_ARRAY(k->a, int, n + 1);
  for (int i = 0; i < n * n; i++) entry[i] = -1;
  for (int e = 0; e < k->M.n; e++)
    add_to(k, entry, o->of_coordinate[k->M.at[e].row], o->of_coordinate[k->M.at[e].col],
           pl_maker_start(k, k->M.at[e].node));
  for (int e = 0; e < k->G.n; e++)
    add_to(k, entry, o->of_constraint[k->G.at[e].row], o->of_coordinate[k->G.at[e].col],
           pl_maker_start(k, k->G.at[e].node));
  pl_step_elimination_factor(k->elimination, k->code, entry, pivot, size);
  for (int u = o->n_mass; u < n; u++) {
    pl_prog_store(k->code, pivot[u], o->pivot + u, 0);
    pl_prog_store(k->code, or_zero(k, size[u]), o->pivot_size + u, 0);
  }
}

// Nodes of q and t, inputs first.
static void write_inputs(pl_maker* k, pl_op op, pl_tape_level level, const bool* set) {
  for (int i = 0; i < k->n_nodes; i++) {
    const pl_tape_node* n = pl_maker_node(k, i);
    if (!set[i] || n->op != op || n->level != level) continue;
    const pl_batch* b = k->instance[k->owner[i]].batch;
    int from = op == PL_OP_TIME ? k->o->time
                                : (op == PL_OP_Q ? k->o->Q : k->o->V)
                                      + b->q[n->slot * b->lanes + k->instance[k->owner[i]].lane];
    k->start[i] = pl_prog_load(k->code, from, 0);
    pl_prog_store(k->code, k->start[i], k->cell[i], 0);
  }
}

void pl_maker_level(pl_maker* k, pl_tape_level level, const bool* set) {
  write_inputs(k, PL_OP_TIME, level, set);
  write_inputs(k, PL_OP_Q, level, set);
  write_inputs(k, PL_OP_V, level, set);
  for (int i = 0; i < k->n_nodes; i++)
    if (set[i] && pl_maker_node(k, i)->level == level) pl_maker_value(k, i);
}

static void position_code(pl_maker* k) {
  pl_maker_begin(k, PL_PART_POSITION, "place", 1);
  pl_maker_level(k, PL_LEVEL_POSITION, k->needed);
  constraint_values(k);
  factor(k);
  pl_maker_end(k);
}

// ------------------------------------------------------------------------------------- corrections
static void correction_code(pl_maker* k, pl_step_part part, const char* name, int residual) {
  pl_step_program* o = k->o;
  pl_maker_begin(k, part, name, 1);
  int* x = PL_ARRAY(k->a, int, o->n + 1);
  for (int u = 0; u < o->n; u++) x[u] = -1;
  for (int c = 0; c < o->n_c; c++)
    if (o->of_constraint[c] >= 0 && !(residual == o->g && k->run->setup->constraints[c].velocity))
      x[o->of_constraint[c]] = pl_prog_op1(k->code, PL_PROG_NEG,
                                           pl_prog_load(k->code, residual + c, 0));
  pl_step_elimination_solve(k->elimination, k->code, x);
  for (int i = 0; i < o->n_q; i++)
    if (o->of_coordinate[i] >= 0 && x[o->of_coordinate[i]] >= 0)
      pl_prog_store(k->code, x[o->of_coordinate[i]], o->move + i, 0);
  pl_maker_end(k);
}

static void velocity_code(pl_maker* k) {
  pl_step_program* o = k->o;
  pl_maker_begin(k, PL_PART_VELOCITY, "speed", 1);
  for (int c = 0; c < o->n_c; c++) {
    SUM_OF_ROW(gt, c);
    int r = or_zero(k, row_), size = pl_prog_op1(k->code, PL_PROG_ABS, r);
    for (int e = 0; e < k->G.n; e++) {
      if (k->G.at[e].row != c) continue;
      int x = pl_maker_start(k, k->G.at[e].node);
      r = pl_prog_op3(k->code, PL_PROG_FMA, x, pl_prog_load(k->code, o->V + k->G.at[e].col, 0), r);
      int floor = pl_prog_load(k->code, o->v_floor + k->G.at[e].col, 0);
      size = pl_prog_op3(k->code, PL_PROG_FMA, pl_prog_op1(k->code, PL_PROG_ABS, x), floor, size);
    }
    int argument = pl_prog_load(k->code, o->argument + c, 0), one = pl_prog_number(k->code, 1);
    argument = pl_prog_if_le(k->code, one, argument, argument, one);
    pl_prog_store(k->code, r, o->r + c, 0);
    pl_prog_store(k->code, pl_prog_op2(k->code, PL_PROG_MUL, size, argument), o->r_size + c, 0);
  }
  pl_maker_end(k);
}

// Eight columns at a time; the inverse is symmetric, so its rows are its columns. What belongs to
// constraints is given and taken with the other sign: the identity holds -1 there.
static void inverse_code(pl_maker* k) {
  pl_step_program* o = k->o;
  int blocks = (o->n + 7) / 8, stride = 8 * blocks;
  if (o->n > o->inverse_up_to) return;
  pl_maker_begin(k, PL_PART_INVERSE, "inverse", 8);
  int* x = PL_ARRAY(k->a, int, o->n + 1);
  for (int b = 0; b < blocks; b++) {
    for (int u = 0; u < o->n; u++)
      x[u] = u / 8 == b ? pl_prog_load(k->code, o->identity + u * stride + 8 * b, 0) : -1;
    pl_step_elimination_solve(k->elimination, k->code, x);
    for (int u = 0; u < o->n; u++)
      if (x[u] >= 0) {
        int entry = u < o->n - o->n_taken ? x[u] : pl_prog_op1(k->code, PL_PROG_NEG, x[u]);
        pl_prog_store(k->code, entry, o->matrix + u * stride + 8 * b, 0);
      }
  }
  pl_maker_end(k);
}

static int norm_of_row(pl_maker* k, int row) {
  int most = -1;
  for (int i = 0; i < k->o->n_q; i++) {
    int x = pl_prog_op1(k->code, PL_PROG_ABS, pl_prog_load(k->code, row + i, 0));
    most = most < 0 ? x : pl_prog_if_le(k->code, x, most, most, x);
  }
  return most;
}

static void norms_code(pl_maker* k) {
  pl_step_program* o = k->o;
  int row[PL_BLOCK_ROWS], of[] = {o->Q, o->V};
  pl_maker_begin(k, PL_PART_NORMS, "norms", 1);
  for (int b = 0; b < 2; b++) {
    pl_block_rows(k->run->order + (b == 0), row);
    for (int i = 0; i < PL_BLOCK_ROWS; i++)
      pl_prog_store(k->code, norm_of_row(k, of[b] + row[i] * o->n_q),
                    o->norms + b * PL_BLOCK_ROWS + i, 0);
  }
  pl_maker_end(k);
}

static void advance_code(pl_maker* k) {
  pl_step_program* o = k->o;
  pl_maker_begin(k, PL_PART_ADVANCE, "advance", 1);
  int h = pl_prog_load(k->code, o->length, 0), order = k->run->order;
  int of[] = {o->Q, o->V, o->A}, to[] = {o->end_q, o->end_v, o->end_a};
  for (int b = 0; b < 3; b++)
    for (int i = 0; i < o->n_q; i++) {
      int last = order + 1 - b, x = pl_prog_load(k->code, of[b] + last * o->n_q + i, 0);
      for (int row = last - 1; row >= 0; row--)
        x = pl_prog_op3(k->code, PL_PROG_FMA, x, h,
                        pl_prog_load(k->code, of[b] + row * o->n_q + i, 0));
      pl_prog_store(k->code, x, to[b] + i, 0);
    }
  pl_maker_end(k);
}

// Energies at a point where all else is computed.
static void energy_code(pl_maker* k) {
  if (k->energy.n == 0) return;
  for (int i = 0; i < k->n_nodes; i++) {
    // not at every point known
    if (k->for_energy[i] && pl_maker_node(k, i)->level == PL_LEVEL_FORCE) return;
    k->for_energy[i] &= !k->needed[i];
  }
  pl_maker_begin(k, PL_PART_ENERGY, "energy", 1);
  pl_maker_level(k, PL_LEVEL_POSITION, k->for_energy);
  pl_maker_level(k, PL_LEVEL_VELOCITY, k->for_energy);
  for (int i = 0; i < (k->run->setup->energy > 0 ? 3 : 2); i++) {
    SUM_OF_ROW(energy, i);
    pl_prog_store(k->code, or_zero(k, row_), k->o->energy + i, 0);
  }
  pl_maker_end(k);
}

// --------------------------------------------------------------------------------------- all of it
static void fill_memory(pl_maker* k) {
  pl_step_program* o = k->o;
  o->m = PL_ARRAY(k->a, double, o->size);
  for (int i = 1; i < o->orders + 2; i++) {
    o->m[o->ratio + i] = 1.0 / i;
    o->m[o->rest + i] = __builtin_fma(-(double)i, o->m[o->ratio + i], 1.0) / i;
  }
  for (int i = 0; i < k->scales.n; i++) {
    const pl_scale_lane* s = &k->scales.at[i];
    for (int row = 1; row <= o->orders; row++) {
      double one = s->rest ? 0 : 1;
      o->m[s->at + 8 * row] = s->of_order ? o->m[(s->rest ? o->rest : o->ratio) + row] : one;
      if (k->real)
        pl_push(k->a, o->scales,
                (pl_scale_cell){s->at + 8 * row,
                                s->of_order ? (s->rest ? o->rest : o->ratio) + row : -1, one});
    }
  }
  o->m[o->time + 1] = 1;
  int stride = (o->n + 7) / 8 * 8;
  if (o->n <= o->inverse_up_to)
    for (int u = 0; u < o->n; u++)
      o->m[o->identity + u * stride + u] = u < o->n - o->n_taken ? 1 : -1;
  for (int i = 0; i < k->n_nodes; i++) {
    pl_maker_instance* in = &k->instance[k->owner[i]];
    if (k->cell[i] < 0 || i - in->base >= in->tape->level_end[PL_LEVEL_CONST]) continue;
    o->m[k->cell[i]] = pl_jet_at(in->batch->jet, i - in->base, 0)[in->lane];
    if (k->real) pl_push(k->a, o->constants, (pl_constant_cell){k->cell[i], k->constant[i]});
  }
}

pl_step_program* pl_step_program_make(pl_run* run) { return pl_step_program_make_for(run, NULL); }

pl_step_program* pl_step_program_make_for(pl_run* run, const pl_real* real) {
  pl_maker maker = {.run = run,
                    .a = run->job->arena,
                    .real = real,
                    .o = PL_NEW(run->job->arena, pl_step_program)},
           *k = &maker;
  pl_step_program* o = k->o;
  o->inverse_up_to = real ? 0 : PL_STEP_INVERSE;
  o->n_q = run->n_q;
  o->n_c = run->n_c;
  o->orders = run->order + 3;
  o->taken = PL_ARRAY(k->a, bool, run->n_c + 1);
  for (int c = 0; c < run->n_c; c++) o->taken[c] = run->dae.taken[c];
  if (!pl_step_program_fits(run)) return o;
  pl_maker_instances(k);
  pl_maker_terms(k);
  number_unknowns(k);
  number_constraints(k);
  find_structure(k);
  lay_out(k);
  if (k->elimination == NULL) return o;
  position_code(k);
  correction_code(k, PL_PART_CORRECT_Q, "correct_q", o->g);
  velocity_code(k);
  correction_code(k, PL_PART_CORRECT_V, "correct_v", o->r);
  inverse_code(k);
  pl_maker_streams(k);
  pl_maker_start_code(k);
  pl_maker_order_code(k);
  norms_code(k);
  advance_code(k);
  energy_code(k);
  fill_memory(k);
  o->usable = true;
  return o;
}
