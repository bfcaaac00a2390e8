// Writing a code: instructions are appended, registers counted, numbers that stand in it already
// used again.
#include <string.h>

#include "program/program.h"

const char* const pl_prog_op_name[PL_N_PROG_OPS] = {
#define PL_PROG(name, reads, meaning) #name,
#include "program/prog.def"
#undef PL_PROG
};

pl_prog* pl_prog_make(pl_arena* a, const char* name, int width) {
  pl_prog* c = PL_NEW(a, pl_prog);
  c->arena = a;
  c->name = name;
  c->width = width;
  return c;
}

static int append(pl_prog* c, pl_prog_line line) {
  bool gives = line.op != PL_PROG_STORE && line.op != PL_PROG_SUMS && line.op != PL_PROG_PRODUCT;
  line.d = gives ? c->n_registers++ : -1;
  pl_push(c->arena, c->lines, line);
  return line.d;
}

static pl_prog_line plain(pl_prog_op op) {
  return (pl_prog_line){.op = (uint8_t)op, .a = -1, .b = -1, .c = -1, .e = -1};
}

// ------------------------------------------------------------------------------------------ memory
static int access(pl_prog* c, pl_prog_op op, int a, int at, int by) {
  pl_prog_line line = plain(op);
  line.a = a;
  line.at = at;
  line.by = by;
  return append(c, line);
}

int pl_prog_load(pl_prog* c, int at, int by) { return access(c, PL_PROG_LOAD, -1, at, by); }
int pl_prog_spread(pl_prog* c, int at, int by) { return access(c, PL_PROG_SPREAD, -1, at, by); }
void pl_prog_store(pl_prog* c, int a, int at, int by) { access(c, PL_PROG_STORE, a, at, by); }
int pl_prog_order(pl_prog* c, int add) { return access(c, PL_PROG_ORDER, -1, add, 0); }

int pl_prog_number(pl_prog* c, double x) {
  for (int i = c->lines.n - 1; i >= 0 && i > c->lines.n - 64; i--)
    if (c->lines.at[i].op == PL_PROG_NUMBER && memcmp(&c->lines.at[i].value, &x, sizeof x) == 0)
      return c->lines.at[i].d;
  pl_prog_line line = plain(PL_PROG_NUMBER);
  line.value = x;
  return append(c, line);
}

// -------------------------------------------------------------------------------------- arithmetic
static int operate(pl_prog* c, pl_prog_op op, int a, int b, int third, int fourth) {
  pl_prog_line line = plain(op);
  line.a = a;
  line.b = b;
  line.c = third;
  line.e = fourth;
  return append(c, line);
}

int pl_prog_op1(pl_prog* c, pl_prog_op op, int a) { return operate(c, op, a, -1, -1, -1); }
int pl_prog_op2(pl_prog* c, pl_prog_op op, int a, int b) { return operate(c, op, a, b, -1, -1); }
int pl_prog_op3(pl_prog* c, pl_prog_op op, int x, int y, int z) {
  return operate(c, op, x, y, z, -1);
}
int pl_prog_if_le(pl_prog* c, int a, int b, int yes, int no) {
  return operate(c, PL_PROG_IF_LE, a, b, yes, no);
}

int pl_prog_call1(pl_prog* c, pl_prog_function f, int a) {
  int d = operate(c, PL_PROG_CALL1, a, -1, -1, -1);
  c->lines.at[c->lines.n - 1].fn = (uint8_t)f;
  return d;
}

int pl_prog_call2(pl_prog* c, pl_prog_function f, int a, int b) {
  int d = operate(c, PL_PROG_CALL2, a, b, -1, -1);
  c->lines.at[c->lines.n - 1].fn = (uint8_t)f;
  return d;
}

// ---------------------------------------------------------------------------------- sums, products
void pl_prog_block_begin(pl_prog* c, int width, int shift) {
  pl_push(c->arena, c->blocks, (pl_prog_block){width, shift, c->sums.n, 0});
  access(c, PL_PROG_SUMS, -1, c->blocks.n - 1, 0);
}

void pl_prog_sum_begin(pl_prog* c, int to, bool weighted) {
  pl_push(
      c->arena, c->sums,
      (pl_prog_sum){.to = to, .first = c->pairs.n, .weighted = weighted, .scale = -1, .rest = -1});
  c->blocks.at[c->blocks.n - 1].n++;
}

void pl_prog_sum_lanes(pl_prog* c, int lanes) { c->sums.at[c->sums.n - 1].lanes = lanes; }

void pl_prog_sum_pair(pl_prog* c, int a, int b) {
  pl_push(c->arena, c->pairs, (pl_prog_pair){a, b});
  c->sums.at[c->sums.n - 1].n++;
}

void pl_prog_sum_scale(pl_prog* c, int scale, int rest) {
  c->sums.at[c->sums.n - 1].scale = scale;
  c->sums.at[c->sums.n - 1].rest = rest;
}

void pl_prog_product_add(pl_prog* c, int to, int matrix, int vector, int n, int late, int blocks) {
  pl_push(c->arena, c->products, (pl_prog_product){to, matrix, vector, n, late, blocks});
  access(c, PL_PROG_PRODUCT, -1, c->products.n - 1, 0);
}

// ----------------------------------------------------------------------------------------- content
#define HASH_LIST(list)                                                              \
  h = pl_hash_mix(pl_hash_bytes((list).at, (size_t)(list).n * sizeof *(list).at, h), \
                  (uint64_t)(list).n)

static uint64_t hash_line(const pl_prog_line* l, uint64_t h) {
  uint64_t value;
  memcpy(&value, &l->value, sizeof value);
  int parts[] = {l->op, l->fn, l->d, l->a, l->b, l->c, l->e, l->at, l->by};
  return pl_hash_mix(pl_hash_bytes(parts, sizeof parts, h), value);
}

uint64_t pl_prog_hash(const pl_prog* c, uint64_t seed) {
  int head[] = {c->width, c->n_registers, c->spill, c->orders, c->first_order, c->lines.n};
  uint64_t h = pl_hash_bytes(head, sizeof head, pl_hash_bytes(c->name, strlen(c->name), seed));
  for (int i = 0; i < c->lines.n; i++) h = hash_line(&c->lines.at[i], h);
  HASH_LIST(c->pairs);
  HASH_LIST(c->blocks);
  HASH_LIST(c->products);
  for (int i = 0; i < c->sums.n; i++) {
    const pl_prog_sum* s = &c->sums.at[i];
    int parts[] = {s->to, s->first, s->n, s->weighted, s->scale, s->rest};
    h = pl_hash_bytes(parts, sizeof parts, h);
  }
  return h;
}
