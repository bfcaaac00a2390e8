// What the tables say of each operation of a tape (ORDER OPS).
#include "program/tape.h"

const char* const pl_op_name[PL_N_OPS] = {
#define PL_OP(name, reads, kind, meaning) #name,
#include "program/tape.def"
};

const int pl_op_reads[PL_N_OPS] = {
#define PL_OP(name, reads, kind, meaning) reads,
#include "program/tape.def"
};

enum { INPUT, LINEAR, SERIES };
const bool pl_op_series[PL_N_OPS] = {
#define PL_OP(name, reads, kind, meaning) kind == SERIES,
#include "program/tape.def"
};

const uint8_t pl_op_recurrence[PL_N_OPS] = {
#define PL_FUNCTION(name, text, n, tex, form, value, derivative, library, recurrence, ...) \
  [PL_OP_##name] = PL_RECURRENCE_##recurrence,
#define PL_PIECEWISE(...)
#include "expr/functions.def"
};

const pl_op pl_op_of_function[PL_N_FUNCTIONS] = {
#define PL_FUNCTION(name, ...) [PL_##name] = PL_OP_##name,
#include "expr/functions.def"
};

// ---------------------------------------------------------------------------------------- operands
static const uint8_t weighted_of[PL_N_RECURRENCES] = {
#define PL_RECURRENCE(name, x, coefficient, equation) [PL_RECURRENCE_##name] = PL_OPERAND_##x,
#include "program/recurrences.def"
};

const uint8_t pl_op_reads_as_w[PL_N_OPS] = {
#define SELF         PL_OPERAND_SELF
#define ARGUMENT     PL_OPERAND_ARGUMENT
#define PAIR(other)  PL_OPERAND_PARTNER
#define SELF_SQUARED PL_OPERAND_PARTNER
#define NODE(w)      PL_OPERAND_PARTNER
#define PL_FUNCTION(name, text, n, tex, form, value, derivative, library, recurrence, w, ...) \
  [PL_OP_##name] = w,
#define PL_PIECEWISE(...)
#include "expr/functions.def"
};

static int node_of(pl_operand which, const pl_tape_node* node, int self) {
  return which == PL_OPERAND_SELF ? self : which == PL_OPERAND_ARGUMENT ? node->a : node->c;
}

int pl_op_weighted(const pl_tape_node* node, int self) {
  return node_of(weighted_of[pl_op_recurrence[node->op]], node, self);
}

int pl_op_partner(const pl_tape_node* node, int self) {
  return node_of(pl_op_reads_as_w[node->op], node, self);
}
