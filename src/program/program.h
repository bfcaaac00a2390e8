// program: straight-line programs. The computation of a step is recorded once as a list of simple
// instructions on one block of memory; the interpreter here runs it, or a compiled version (jit)
// when the work ahead pays for compiling. Both give the same bits: every instruction rounds once,
// sums have one order, and elementary functions are those of the C library on both sides.
//
// A register holds one number, or eight (lanes side by side). All that is kept between codes lies
// in memory.
//
// Sums. A block of convolutions computes, for each of its sums and over its pairs of streams (A,
// B), with K = k + shift,
//
//     s = sum over pairs of sum_{j=1..K-1} A_j B_{K-j},
//
// row j of a stream being `width` numbers at stream + j width. Products are added to parts, which
// do not wait for each other: two of a sum with one pair, else four. A_j B_{K-j} of pair p goes to
// part 2p, A_{K-j} B_j with j < K/2 to part 2p + 1, counted modulo their number, from the middle
// outwards, so that the newest rows come last: K even: the pairs' A_{K/2} B_{K/2}; then for j =
// (K-1)/2 down to 1, for each pair, A_j B_{K-j} and A_{K-j} B_j. Every addition is a fused
// multiply-add, beginning with 0; at the end s = t_0 + t_1, or (t_0 + t_1) + (t_2 + t_3). A
// weighted sum takes j A_j for A_j, the product rounded. A scaled sum is multiplied with row K of a
// stream and corrected with row K of another: fma(s, rest_K, s scale_K).
#ifndef PL_PROGRAM_H
#define PL_PROGRAM_H

#include "program/jet.h"

// ---------------------------------------------------------------------------------------- programs
typedef enum pl_prog_op {
#define PL_PROG(name, reads, meaning) PL_PROG_##name,
#include "program/prog.def"
#undef PL_PROG
  PL_N_PROG_OPS
} pl_prog_op;
extern const char* const pl_prog_op_name[PL_N_PROG_OPS];

// Functions of the C library.
typedef enum pl_prog_function {
#define PL_LIBRARY(name, n) PL_FN_##name,
#include "program/library.def"
  PL_N_PROG_FUNCTIONS
} pl_prog_function;

typedef struct pl_prog_line {
  uint8_t op, fn;
  int d, a, b, c, e;  // registers: result, operands
  int at, by;         // memory, or number of a block or product
  double value;
} pl_prog_line;

typedef struct pl_prog_pair {
  int a, b;
} pl_prog_pair;  // streams, row 0
typedef struct pl_prog_sum {
  int to, first, n;  // pairs first .. first + n - 1
  bool weighted;
  // the first so many hold something; 0: all.  What vector registers compute for nothing
  int lanes;
  int scale, rest;  // streams; -1: not scaled
} pl_prog_sum;
enum { PL_PROG_PARTS = 4 };
static inline int pl_prog_parts(const pl_prog_sum* s) { return s->n == 1 ? 2 : PL_PROG_PARTS; }
// sums first .. first + n - 1
typedef struct pl_prog_block {
  int width, shift, first, n;
} pl_prog_block;
// y = A x: rows in blocks of 8, column j of A at A + 8 j blocks. The last `late` entries of x are
// waited for and come last: over the others sums in four parts, j mod 4, s = (s0+s1)+(s2+s3); to s
// and, when there are several late ones, to a second part these are added in turn.
typedef struct pl_prog_product {
  int to, matrix, vector, n, late, blocks;
} pl_prog_product;

typedef struct pl_prog {
  pl_arena* arena;
  const char* name;  // of the function that a compiler makes of it
  int width;         // numbers in a register: 1 or 8
  int n_registers;
  int spill;  // place in memory of register 0; all registers have one
  PL_VEC(pl_prog_line) lines;
  PL_VEC(pl_prog_pair) pairs;
  PL_VEC(pl_prog_sum) sums;
  PL_VEC(pl_prog_block) blocks;
  PL_VEC(pl_prog_product) products;
  // orders above 0: compiled code is written out for the orders k = first_order .. orders - 1 and
  // runs exactly those. Then streams are written with stride 8 only, and memory below spill only.
  int orders, first_order;
} pl_prog;

// A compiled code, or the interpreter's stand-in: runs orders from <= k < to.
typedef void pl_prog_run(double* memory, int from, int to);

// ---- prog_make.c: writing.  All return the register of the result.
pl_prog* pl_prog_make(pl_arena* a, const char* name, int width);
int pl_prog_load(pl_prog* c, int at, int by);
int pl_prog_spread(pl_prog* c, int at, int by);
void pl_prog_store(pl_prog* c, int a, int at, int by);
int pl_prog_number(pl_prog* c, double x);
int pl_prog_order(pl_prog* c, int add);
int pl_prog_op1(pl_prog* c, pl_prog_op op, int a);
int pl_prog_op2(pl_prog* c, pl_prog_op op, int a, int b);
int pl_prog_op3(pl_prog* c, pl_prog_op op, int x, int y, int z);
int pl_prog_if_le(pl_prog* c, int a, int b, int yes, int no);
int pl_prog_call1(pl_prog* c, pl_prog_function f, int a);
int pl_prog_call2(pl_prog* c, pl_prog_function f, int a, int b);
// A block is opened, given sums, each with its pairs, and then stands in the code.
void pl_prog_block_begin(pl_prog* c, int width, int shift);
void pl_prog_sum_begin(pl_prog* c, int to, bool weighted);
void pl_prog_sum_pair(pl_prog* c, int a, int b);
void pl_prog_sum_lanes(pl_prog* c, int lanes);  // of the sum at work
void pl_prog_sum_scale(pl_prog* c, int scale, int rest);
void pl_prog_product_add(pl_prog* c, int to, int matrix, int vector, int n, int late, int blocks);
uint64_t pl_prog_hash(const pl_prog* c, uint64_t seed);

// ---- prog_run.c: the interpreter
void pl_prog_interpret(const pl_prog* c, double* memory, int from, int to);

// ---- real.c, real_type.c, real_pair.c: programs on numbers wider than a double, interpreted.
// `memory` then holds numbers of that type, as many as there would be doubles; a multiply-add
// rounds twice. a number as a sum, each part the rounding of what is left
typedef struct pl_parts {
  double part[3];
} pl_parts;
enum { PL_REAL_TEXT = 64 };
typedef struct pl_real {
  const char* name;
  size_t size;
  int bits;
  double epsilon;  // distance from 1 to the next number
  void (*interpret)(const pl_prog* c, void* memory, int from, int to);
  void (*read)(const void* memory, int at, int n, double* out);  // rounded
  void (*write)(void* memory, int at, int n, const double* x);
  pl_parts (*get)(const void* memory, int at);
  void (*set)(void* memory, int at, pl_parts x);
  void (*move)(void* memory, int to, int from, int n);
  void (*add)(void* memory, int to, int from, int n);        // memory[to + i] += memory[from + i]
  void (*round_to_long)(void* memory, int at, int n);        // to the digits that a long double has
  void (*ratios)(void* memory, int ratio, int rest, int n);  // 1/i, and what rounding left of it
  // as short as reads back; its length
  int (*text)(char out[PL_REAL_TEXT], const void* memory, int at, bool negative);
} pl_real;
// NULL where the processor or the compiler has no such type.
const pl_real* pl_real_long(void);  // 80 bits, 64 of them digits
const pl_real* pl_real_quad(void);  // 128 bits, 113 of them digits
// two doubles, 106 bits, or some more where there is a gap between them
const pl_real* pl_real_pair(void);

// ---- recurrences.c: the recurrences of the tape's operations as code
// What a node's convolutions read: A and B as nodes (itself included), A weighted by j.
typedef struct pl_recurrence_sum {
  int a, b;
  bool weighted;
} pl_recurrence_sum;
int pl_recurrence_sums(const pl_tape* tape, int node, pl_recurrence_sum out[3]);
// Registers that the lowering of a node at order k needs, given by the caller; -1 for a coefficient
// that is zero.
typedef struct pl_recurrence {
  pl_prog* code;
  const pl_tape* tape;
  void* user;
  int (*start)(void* user, int node);       // order 0
  int (*now)(void* user, int node);         // order k; -1: zero
  int (*sum)(void* user, int node, int i);  // convolution i of the node; -1: zero
  bool means;                               // weighted sums come divided by k
  int (*inverse)(void* user, int node);     // what pl_recurrence_inverse computed at order 0
} pl_recurrence;
int pl_recurrence_value(const pl_recurrence* l, int node);  // order 0; -1: an input, which is there
// The reciprocal that the coefficients of a node are multiplied with, at order 0; -1: none.
int pl_recurrence_inverse(const pl_recurrence* l, int node);
bool pl_recurrence_has_inverse(const pl_tape* tape, int node);
int pl_recurrence_coefficient(const pl_recurrence* l, int node);  // order k >= 1; -1: zero

#endif
