// tape: equations as straight-line programs, one per pattern.
//
// A pattern is a set of local expressions over local slots: coordinates, their velocities and
// accelerations, multipliers, t, parameters. Its instances say which global coordinate and
// constraint stands in each slot, so a family of a million rods is one pattern of one rod, and an
// ordinary model is one pattern with one instance (or a few). Contributions of all patterns and
// instances to M, h and the outputs add up; each constraint row belongs to exactly one instance of
// one pattern.
//
// Given the Lagrange function L, further generalised forces Q and the constraints g of a pattern,
// pl_pattern_record differentiates and writes down what the motion needs,
//
//     M(q,t) a + h(q,v,t) = G(q,t)^T λ,     g(q,t) = 0,     G = dg/dq,
//
//     M_ij = d²L/dv_i dv_j,   h_i = sum_j d²L/dv_i dq_j v_j + d²L/dv_i dt - dL/dq_i - Q_i.
//
// Forces may depend linearly on multipliers (friction, a normal force that drives something): then
// the matrix that multiplies λ is W = G^T + dQ/dλ. All memory in the job's arena; immutable once
// made.
#ifndef PL_TAPE_H
#define PL_TAPE_H

#include "expr/expr.h"

// ----------------------------------------------------------------------------------------- program
typedef enum pl_op {
#define PL_OP(name, reads, kind, meaning) PL_OP_##name,
#include "program/tape.def"
  PL_N_OPS
} pl_op;
extern const char* const pl_op_name[PL_N_OPS];
extern const int pl_op_reads[PL_N_OPS];
extern const bool pl_op_series[PL_N_OPS];  // has a convolution: two-phase form

// How the coefficients of an elementary function follow from those of its argument.
typedef enum pl_recurrence_kind {  //                                            ORDER RECURRENCES
  PL_RECURRENCE_NONE,              // not an elementary function with a series
#define PL_RECURRENCE(name, x, coefficient, equation) PL_RECURRENCE_##name,
#include "program/recurrences.def"
  PL_RECURRENCE_ANGLE,  // atan2, of two arguments
  PL_N_RECURRENCES
} pl_recurrence_kind;
extern const uint8_t pl_op_recurrence[PL_N_OPS];
// Which operand is the partner w that the recurrence reads.
typedef enum pl_operand { PL_OPERAND_PARTNER, PL_OPERAND_SELF, PL_OPERAND_ARGUMENT } pl_operand;
extern const uint8_t pl_op_reads_as_w[PL_N_OPS];
extern const pl_op pl_op_of_function[PL_N_FUNCTIONS];

// What a node depends on decides when its coefficient k can be computed.               ORDER LEVELS
typedef enum pl_tape_level {
  PL_LEVEL_CONST,     // numbers, parameters: once a run
  PL_LEVEL_POSITION,  // q, t: order k+1 before accelerations of order k are solved for (class A0)
  PL_LEVEL_VELOCITY,  // q, v, t: order k (class A1)
  PL_LEVEL_FORCE,     // with λ or accelerations: after the solve; outputs and events only
  PL_N_LEVELS
} pl_tape_level;

typedef struct pl_tape_node {
  uint8_t op, level;
  bool high;  // needed at orders above 0 by the motion (M, h, G, W, dg/dt)
  // operands; c is the partner w of a series operation, or the third operand of IF; -1 none
  int a, b, c;
  int slot;        // of an input
  double value;    // of CONST
  double rest[2];  // of CONST: what rounding to a double left, as two more doubles
} pl_tape_node;

// The nodes whose coefficients enter the sum S of a recurrence: x with weights j, the partner w.
// self: the node itself.
int pl_op_weighted(const pl_tape_node* node, int self);
int pl_op_partner(const pl_tape_node* node, int self);

// Nodes are sorted by level and topologically within one; partners may come later (only lower
// orders are read).
typedef struct pl_tape {
  const pl_tape_node* nodes;  // (n_nodes)
  int n_nodes;
  int level_end[PL_N_LEVELS];  // nodes of level L are [level_end[L-1], level_end[L])
  const int* roots;            // node of each root  (n_roots)
  int n_roots;
  int n_q, n_c, n_param, n_index;  // slots
  // input node of each slot, -1 if the program does not read it
  const int *q_node, *v_node, *a_node, *lambda_node;
  const double* param_value;      // (n_param)
  const pl_symbol* param_symbol;  // (n_param)
  // of a CONST node: what it is exactly; poison where `value` is exact  (n_nodes)
  const pl_expr* constant;
} pl_tape;

// What the names in an expression stand for.
typedef struct pl_tape_slots {
  int n_q;
  // coordinate atoms: symbols, or elements such as x[i-1] with i an index symbol
  const pl_expr* q;
  // velocities and accelerations are their pl_dt
  int n_c;
  // multiplier atom of each local constraint; poison where it has none. NULL: none
  const pl_expr* lambda;
  int n_index;
  const pl_symbol* index;  // index symbols, whose values come with each instance
  // every other symbol is a parameter: its value by symbol id, as in pl_eval
  const double* value_of_symbol;
  // by symbol id: what is written down instead of a parameter, so that nothing of it is
  const pl_expr* definition;
  // lost to rounding; poison: nothing. NULL: parameters are
  // parameters
} pl_tape_slots;

// pl_tape_record writes n roots as one program with common subexpressions shared. high[i] tells
// whether root i is needed at orders above 0 (NULL: all). Status PLEUEL_USAGE when a symbol has
// neither slot nor value, PLEUEL_UNSUPPORTED for nodes without a value (∞, unknown functions),
// PLEUEL_NUMERICAL for poison.
pleuel_status pl_tape_record(pl_job* job, pl_pool* pool, const pl_tape_slots* slots,
                             const pl_expr* roots, const bool* high, int n, pl_tape** out);

void pl_tape_dump(pl_text* out, const pl_pool* pool, const pl_tape* tape);

// ----------------------------------------------------------------------------------------- pattern
// What the caller says of a pattern.  Poison or NULL or 0 where absent.
typedef struct pl_pattern_source {
  pl_tape_slots slots;
  pl_expr lagrangian;  // L(q, v, t), quadratic in v
  // further generalised force Q_i(q, v, t, λ) on slot i, affine in λ (n_q); poison: none
  const pl_expr* force;
  // local constraint, n_c of them: g(q, t), or f(q, v, t) affine in v when velocity[c]
  const pl_expr* constraint;
  // nonholonomic: holds on velocity level only               (n_c), NULL: none
  const bool* velocity;
  int n_outputs;
  // output expressions: of q, v, a, λ, t                       (n_outputs)
  const pl_expr* output;
  // Instances: which global index each slot has.  -1 is not allowed.
  int n;         // how many
  const int* q;  // global coordinate of slot s of instance i: q[i * n_q + s]
  const int* c;  // global constraint: c[i * n_c + s]
  // global output: out[i * n_outputs + s]; contributions to one output add up
  const int* out;
  const double* index;  // values of the index symbols: index[i * n_index + s]
} pl_pattern_source;

// local row, local column, root on the tape
typedef struct pl_pattern_entry {
  int row, col, root;
} pl_pattern_entry;

typedef struct pl_pattern {
  const pl_tape* tape;
  // M, upper triangle: row <= col (coordinate slots)
  int n_mass;
  const pl_pattern_entry* mass;
  int n_h;
  const pl_pattern_entry* h;  // h of slot row; col unused
  // dg/dq: row constraint slot, col coordinate slot; or df/dv
  int n_G;
  const pl_pattern_entry* G;
  // dQ/dλ: row coordinate slot, col constraint slot; usually none
  int n_W;
  const pl_pattern_entry* W;
  // dg/dt of constraint slot row; f at v = 0 if nonholonomic
  int n_gt;
  const pl_pattern_entry* gt;
  // g of constraint slot row; col is the root of the sum of |terms|
  int n_g;
  const pl_pattern_entry* g;
  int n_out;
  const pl_pattern_entry* outputs;  // output slot row
  int n_q, n_c, n_index, n_outputs;
  int n;                   // instances
  const int *q, *c, *out;  // as in the source
  const double* index;
} pl_pattern;

// pl_pattern_record differentiates and records. The index arrays of the source are kept by pointer.
// Status as pl_tape_record; PLEUEL_UNSUPPORTED when L is not quadratic in the velocities, a force
// not affine in λ or a nonholonomic constraint not affine in v.
pleuel_status pl_pattern_record(pl_job* job, pl_pool* pool, const pl_pattern_source* source,
                                pl_pattern* out);

#endif
