// The recurrences of the tape's operations (program/jet_interpret.c has the formulas) as code.
// Products and additions that follow each other are fused, coefficients that are zero left out.
// Where the caller keeps reciprocals they are multiplied with, otherwise there are divisions.
#include "program/program.h"

static const pl_tape_node* at(const pl_recurrence* l, int node) { return &l->tape->nodes[node]; }
static int start(const pl_recurrence* l, int node) { return l->start(l->user, node); }
static int now(const pl_recurrence* l, int node) { return node < 0 ? -1 : l->now(l->user, node); }

// -------------------------------------------------------------------------------- zero is left out
static int add(const pl_recurrence* l, int a, int b) {
  return a < 0 ? b : b < 0 ? a : pl_prog_op2(l->code, PL_PROG_ADD, a, b);
}
static int neg(const pl_recurrence* l, int a) {
  return a < 0 ? -1 : pl_prog_op1(l->code, PL_PROG_NEG, a);
}
static int sub(const pl_recurrence* l, int a, int b) {
  return b < 0 ? a : a < 0 ? neg(l, b) : pl_prog_op2(l->code, PL_PROG_SUB, a, b);
}
static int mul(const pl_recurrence* l, int a, int b) {
  return a < 0 || b < 0 ? -1 : pl_prog_op2(l->code, PL_PROG_MUL, a, b);
}
static int fma_(const pl_recurrence* l, int a, int b, int c) {
  return a < 0 || b < 0 ? c : c < 0 ? mul(l, a, b) : pl_prog_op3(l->code, PL_PROG_FMA, a, b, c);
}
static int fnma(const pl_recurrence* l, int a, int b, int c) {
  return a < 0 || b < 0 ? c
         : c < 0        ? neg(l, mul(l, a, b))
                        : pl_prog_op3(l->code, PL_PROG_FNMA, a, b, c);
}
static int or_zero(const pl_recurrence* l, int a) { return a < 0 ? pl_prog_number(l->code, 0) : a; }

// ------------------------------------------------------------------------------------ convolutions
int pl_recurrence_sums(const pl_tape* tape, int node, pl_recurrence_sum out[3]) {
  const pl_tape_node* n = &tape->nodes[node];
  int self = node;
  switch ((pl_op)n->op) {
    case PL_OP_MUL: out[0] = (pl_recurrence_sum){n->a, n->b, false}; return 1;
    case PL_OP_SQR: out[0] = (pl_recurrence_sum){n->a, n->a, false}; return 1;
    case PL_OP_DIV: out[0] = (pl_recurrence_sum){n->b, self, false}; return 1;
    case PL_OP_SQRT: out[0] = (pl_recurrence_sum){self, self, false}; return 1;
    case PL_OP_POW:
      out[0] = (pl_recurrence_sum){n->a, self, true};
      out[1] = (pl_recurrence_sum){n->a, self, false};
      return 2;
    case PL_OP_ATAN2:
      out[0] = (pl_recurrence_sum){n->a, n->b, true};
      out[1] = (pl_recurrence_sum){n->b, n->a, true};
      out[2] = (pl_recurrence_sum){self, n->c, true};
      return 3;
    default:
      if (!pl_op_recurrence[n->op]) return 0;
      out[0] = (pl_recurrence_sum){pl_op_weighted(n, self), pl_op_partner(n, self), true};
      return 1;
  }
}

// ----------------------------------------------------------------------------------------- order 0
static int sign_of(const pl_recurrence* l, int a) {
  pl_prog* c = l->code;
  int below = pl_prog_op3(c, PL_PROG_IF_LESS, a, pl_prog_number(c, -1), a);
  return pl_prog_op3(c, PL_PROG_IF_MORE, a, pl_prog_number(c, 1), below);
}

int pl_recurrence_value(const pl_recurrence* l, int node) {
  const pl_tape_node* n = at(l, node);
  pl_prog* c = l->code;
  int a = n->a >= 0 ? start(l, n->a) : -1, b = n->b >= 0 ? start(l, n->b) : -1;
  switch ((pl_op)n->op) {
    case PL_OP_ADD: return pl_prog_op2(c, PL_PROG_ADD, a, b);
    case PL_OP_SUB: return pl_prog_op2(c, PL_PROG_SUB, a, b);
    case PL_OP_NEG: return pl_prog_op1(c, PL_PROG_NEG, a);
    case PL_OP_SCALE:
    case PL_OP_MUL: return pl_prog_op2(c, PL_PROG_MUL, a, b);
    case PL_OP_RSCALE:
    case PL_OP_DIV: return pl_prog_op2(c, PL_PROG_DIV, a, b);
    case PL_OP_ABS: return pl_prog_op1(c, PL_PROG_ABS, a);
    case PL_OP_SIGN: return sign_of(l, a);
    case PL_OP_MIN: return pl_prog_if_le(c, a, b, a, b);
    case PL_OP_MAX: return pl_prog_if_le(c, b, a, a, b);
    case PL_OP_IF: return pl_prog_op3(c, PL_PROG_IF_MORE, a, b, start(l, n->c));
    case PL_OP_SQR: return pl_prog_op2(c, PL_PROG_MUL, a, a);
    case PL_OP_SQRT: return pl_prog_op1(c, PL_PROG_SQRT, a);
    case PL_OP_POW: return pl_prog_call2(c, PL_FN_pow, a, b);
#define CALL_1(fn) pl_prog_call1(c, fn, a)
#define CALL_2(fn) pl_prog_call2(c, fn, a, b)
#define PL_FUNCTION(name, text, n, tex, form, value, derivative, library, ...) \
  case PL_OP_##name:                                                           \
    return CALL_##n(PL_FN_##library);
#define PL_PIECEWISE(...)
#include "expr/functions.def"
    default: return -1;
  }
}

// ------------------------------------------------------------------------------------- reciprocals
// Which number a node's coefficients are divided by: the operand b, a, w, or itself doubled; -1
// none.
static int divisor(const pl_tape* tape, int node) {
  const pl_tape_node* n = &tape->nodes[node];
  switch ((pl_op)n->op) {
    case PL_OP_RSCALE:
    case PL_OP_DIV: return n->b;
    case PL_OP_SQRT: return node;
    case PL_OP_POW: return n->a;
    case PL_OP_ATAN2: return n->c;
    default: break;
  }
  // the equation of an elementary function is divided by w when c' stands in the sum
  bool divides = pl_op_recurrence[n->op] && pl_op_weighted(n, node) == node;
  return divides ? pl_op_partner(n, node) : -1;
}

bool pl_recurrence_has_inverse(const pl_tape* tape, int node) { return divisor(tape, node) >= 0; }

static int twice_root(const pl_recurrence* l, int node) {
  return pl_prog_op2(l->code, PL_PROG_MUL, pl_prog_number(l->code, 2), start(l, node));
}

// A power of zero has no series: it goes on as if it stayed zero, and what that is off by shortens
// the step.
static int unless_zero(const pl_recurrence* l, int node, int x) {
  pl_op op = (pl_op)at(l, node)->op;
  if (op != PL_OP_SQRT && op != PL_OP_POW) return x;
  int size = pl_prog_op1(l->code, PL_PROG_ABS, start(l, divisor(l->tape, node)));
  return pl_prog_op3(l->code, PL_PROG_IF_MORE, size, x, pl_prog_number(l->code, 0));
}

int pl_recurrence_inverse(const pl_recurrence* l, int node) {
  int of = divisor(l->tape, node);
  if (of < 0) return -1;
  int x = at(l, node)->op == PL_OP_SQRT ? twice_root(l, node) : start(l, of);
  return unless_zero(l, node, pl_prog_op2(l->code, PL_PROG_DIV, pl_prog_number(l->code, 1), x));
}

static int over(const pl_recurrence* l, int x, int node) {
  if (x < 0) return -1;
  if (l->inverse) return pl_prog_op2(l->code, PL_PROG_MUL, x, l->inverse(l->user, node));
  int by = at(l, node)->op == PL_OP_SQRT ? twice_root(l, node) : start(l, divisor(l->tape, node));
  return unless_zero(l, node, pl_prog_op2(l->code, PL_PROG_DIV, x, by));
}

// ----------------------------------------------------------------------------------------- order k
// x / k
static int over_order(const pl_recurrence* l, int x) {
  return x < 0 ? -1 : pl_prog_op2(l->code, PL_PROG_DIV, x, pl_prog_order(l->code, 0));
}

static int sum(const pl_recurrence* l, int node, int i) { return l->sum(l->user, node, i); }
static int mean(const pl_recurrence* l, int node) {
  return l->means ? sum(l, node, 0) : over_order(l, sum(l, node, 0));
}

// a^r:  ((r + 1) S_1 / k - S_2 + r a_k c_0) / a_0,  S_1 = sum j a_j c_{k-j},  S_2 = sum a_j c_{k-j}
static int power(const pl_recurrence* l, int node) {
  const pl_tape_node* n = at(l, node);
  pl_prog* c = l->code;
  int r = start(l, n->b), more = pl_prog_op2(c, PL_PROG_ADD, r, pl_prog_number(c, 1));
  int known = mul(l, more, mean(l, node));
  known = sub(l, known, sum(l, node, 1));
  return over(l, fma_(l, now(l, n->a), pl_prog_op2(c, PL_PROG_MUL, r, start(l, node)), known),
              node);
}

// a_k b_0 - b_k a_0 + (S_1 - S_2 - S_3)/k over w_0
static int angle(const pl_recurrence* l, int node) {
  const pl_tape_node* n = at(l, node);
  int known = sub(l, sub(l, sum(l, node, 0), sum(l, node, 1)), sum(l, node, 2));
  if (!l->means) known = over_order(l, known);
  int x = fma_(l, now(l, n->a), start(l, n->b), known);
  return over(l, fnma(l, now(l, n->b), start(l, n->a), x), node);
}

static int linear(const pl_recurrence* l, int node) {
  const pl_tape_node* n = at(l, node);
  pl_prog* c = l->code;
  int a = now(l, n->a), b = now(l, n->b);
  switch ((pl_op)n->op) {
    case PL_OP_ADD: return add(l, a, b);
    case PL_OP_SUB: return sub(l, a, b);
    case PL_OP_NEG: return neg(l, a);
    case PL_OP_SCALE: return mul(l, a, start(l, n->b));
    case PL_OP_RSCALE: return over(l, a, node);
    case PL_OP_ABS:
      return a < 0 ? -1 : pl_prog_op3(c, PL_PROG_IF_LESS, start(l, n->a), neg(l, a), a);
    case PL_OP_MIN:
      if (a < 0 && b < 0) return -1;
      return pl_prog_if_le(c, start(l, n->a), start(l, n->b), or_zero(l, a), or_zero(l, b));
    case PL_OP_MAX:
      if (a < 0 && b < 0) return -1;
      return pl_prog_if_le(c, start(l, n->b), start(l, n->a), or_zero(l, a), or_zero(l, b));
    case PL_OP_IF: {
      int other = now(l, n->c);
      if (b < 0 && other < 0) return -1;
      return pl_prog_op3(c, PL_PROG_IF_MORE, start(l, n->a), or_zero(l, b), or_zero(l, other));
    }
    default: return -1;
  }
}

// Elementary functions of one argument; the formulas stand in recurrences.def.
static int function_coefficient(const pl_recurrence* l, int node) {
  const pl_tape_node* n = at(l, node);
  pl_prog* c = l->code;
  int a = now(l, n->a), w = pl_op_partner(n, node);
#define S           mean(l, node)
#define A           a
#define W           start(l, w)
#define ONE         pl_prog_number(c, 1)
#define NEG(x)      neg(l, x)
#define ADD(x, y)   pl_prog_op2(c, PL_PROG_ADD, x, y)
#define SUB(x, y)   sub(l, x, y)
#define MUL(x, y)   mul(l, x, y)
#define MA(x, y, s) fma_(l, x, y, s)
#define OVER_W(x)   over(l, x, node)
  switch ((pl_recurrence_kind)pl_op_recurrence[n->op]) {
// clang-format off
#define PL_RECURRENCE(name, x, coefficient, equation) \
  case PL_RECURRENCE_##name: return coefficient;
#include "program/recurrences.def"
      // clang-format on
    default: return -1;
  }
}

int pl_recurrence_coefficient(const pl_recurrence* l, int node) {
  const pl_tape_node* n = at(l, node);
  pl_prog* c = l->code;
  if (!pl_op_series[n->op]) return linear(l, node);
  int a = now(l, n->a), b = now(l, n->b);
  switch ((pl_op)n->op) {
    case PL_OP_MUL: return fma_(l, start(l, n->a), b, fma_(l, a, start(l, n->b), sum(l, node, 0)));
    case PL_OP_SQR: {
      int x = start(l, n->a);
      return fma_(l, pl_prog_op2(c, PL_PROG_ADD, x, x), a, sum(l, node, 0));
    }
    case PL_OP_DIV: return over(l, fnma(l, b, start(l, node), sub(l, a, sum(l, node, 0))), node);
    case PL_OP_SQRT: return over(l, sub(l, a, sum(l, node, 0)), node);
    case PL_OP_POW: return power(l, node);
    case PL_OP_ATAN2: return angle(l, node);
    default: return function_coefficient(l, node);
  }
}
