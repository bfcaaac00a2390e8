// Taylor coefficients in balls through a tape: the recurrences of program/jet_interpret.c, whose
// proof is that of power series (each is an identity between the coefficients of analytic
// functions), so that in ball arithmetic coefficient k of each node contains that of every motion
// that begins in the balls of order 0.
//
// Recurrences with weights (k c_k = sum j a_j w_{k-j}) read the weighted series j x_j, kept beside
// the nodes that need it.
// See theory (10.2).
#include "enclose/enclose_impl.h"

typedef struct place {
  pl_ball_jet* jet;
  int i, k;
  slong prec;
  const pl_tape_node* node;
  arb_ptr c, a, b, w;  // series of the node, of its operands
  arb_ptr weighted;    // j a_j or j c_j
} place;

static arb_ptr series_of(const pl_ball_jet* j, int node) {
  return node < 0 ? NULL : j->coef + (slong)node * j->cap;
}

// out = start - sum or + sum of x_from y_{k - from} for from .. to.
static void convolve(arb_t out, arb_srcptr start, bool subtract, arb_srcptr x, arb_srcptr y,
                     int from, int to, int k, slong prec) {
  arb_dot(out, start, subtract, x + from, 1, y + (k - from), -1, to - from + 1, prec);
}

static void square(place* p) {
  int k = p->k;
  convolve(p->c + k, NULL, 0, p->a, p->a, 0, (k - 1) / 2, k, p->prec);
  arb_mul_2exp_si(p->c + k, p->c + k, 1);
  if (k % 2 == 0) arb_addmul(p->c + k, p->a + k / 2, p->a + k / 2, p->prec);
}

static void quotient(place* p) {
  convolve(p->c + p->k, p->a + p->k, 1, p->b, p->c, 1, p->k, p->k, p->prec);
  arb_div(p->c + p->k, p->c + p->k, p->b, p->prec);
}

static void root(place* p) {
  arb_ptr c = p->c + p->k;
  convolve(c, p->a + p->k, 1, p->c, p->c, 1, p->k - 1, p->k, p->prec);
  arb_mul_2exp_si(c, c, -1);
  arb_div(c, c, p->c, p->prec);
}

// sum of j a_j x_{k-j}, j = 1 .. k, over k, a being the operand.
static void flow(place* p, arb_srcptr x) {
  arb_mul_si(p->weighted + p->k, p->a + p->k, p->k, p->prec);
  convolve(p->c + p->k, NULL, 0, p->weighted, x, 1, p->k, p->k, p->prec);
  arb_div_si(p->c + p->k, p->c + p->k, p->k, p->prec);
}

// c' x = sign a': c_k = (sign a_k - sum_{1..k-1} j c_j x_{k-j} / k)/x_0.
static void inverse_flow(place* p, arb_srcptr x, int sign) {
  arb_ptr c = p->c + p->k;
  convolve(c, NULL, 0, p->weighted, x, 1, p->k - 1, p->k, p->prec);
  arb_div_si(c, c, p->k, p->prec);
  if (sign > 0) arb_sub(c, p->a + p->k, c, p->prec);
  else {
    arb_add(c, p->a + p->k, c, p->prec);
    arb_neg(c, c);
  }
  arb_div(c, c, x, p->prec);
  arb_mul_si(p->weighted + p->k, c, p->k, p->prec);
}

// a c' = r a' c
static void power(place* p) {
  arb_t sum, t, weight;
  arb_init(sum);
  arb_init(t);
  arb_init(weight);
  for (int j = 1; j < p->k; j++) {
    arb_mul_si(weight, p->b, j, p->prec);
    arb_sub_si(weight, weight, p->k - j, p->prec);
    arb_mul(t, p->a + j, p->c + (p->k - j), p->prec);
    arb_addmul(sum, weight, t, p->prec);
  }
  arb_div_si(sum, sum, p->k, p->prec);
  arb_mul(t, p->b, p->a + p->k, p->prec);
  arb_addmul(sum, t, p->c, p->prec);
  arb_div(p->c + p->k, sum, p->a, p->prec);
  arb_clear(sum);
  arb_clear(t);
  arb_clear(weight);
}

// w c' = a' b - b' a
static void angle(place* p) {
  arb_t sum, t;
  arb_init(sum);
  arb_init(t);
  int k = p->k;
  for (int j = 1; j < k; j++) {
    arb_mul(t, p->a + j, p->b + (k - j), p->prec);
    arb_submul(t, p->b + j, p->a + (k - j), p->prec);
    arb_submul(t, p->c + j, p->w + (k - j), p->prec);
    arb_addmul_si(sum, t, j, p->prec);
  }
  arb_div_si(sum, sum, k, p->prec);
  arb_addmul(sum, p->a + k, p->b, p->prec);
  arb_submul(sum, p->b + k, p->a, p->prec);
  arb_div(p->c + k, sum, p->w, p->prec);
  arb_clear(sum);
  arb_clear(t);
}

// The branch that holds at order 0; the disks of the step prove that it holds all along.
static void branch(place* p) {
  arb_ptr c = p->c + p->k;
  switch (p->node->op) {
    case PL_OP_SIGN: arb_zero(c); break;
    case PL_OP_ABS:
      if (arb_is_negative(p->a)) arb_neg(c, p->a + p->k);
      else arb_set(c, p->a + p->k);
      break;
    case PL_OP_MIN: arb_set(c, arb_le(p->a, p->b) ? p->a + p->k : p->b + p->k); break;
    case PL_OP_MAX: arb_set(c, arb_ge(p->a, p->b) ? p->a + p->k : p->b + p->k); break;
    default: arb_set(c, arb_is_positive(p->a) ? p->b + p->k : p->w + p->k); break;
  }
}

// Elementary functions of one argument: the equations of program/recurrences.def.
static void function_coefficient(place* p) {
  arb_ptr c = p->c + p->k;
  arb_srcptr w = series_of(p->jet, pl_op_partner(p->node, p->i));
  switch ((pl_recurrence_kind)pl_op_recurrence[p->node->op]) {
    case PL_RECURRENCE_FLOW: flow(p, w); break;
    case PL_RECURRENCE_FLOW_MINUS:
      flow(p, w);
      arb_neg(c, c);
      break;
    case PL_RECURRENCE_FLOW_ONE_PLUS:
      flow(p, w);
      arb_add(c, c, p->a + p->k, p->prec);
      break;
    case PL_RECURRENCE_FLOW_ONE_MINUS:
      flow(p, w);
      arb_sub(c, p->a + p->k, c, p->prec);
      break;
    case PL_RECURRENCE_INVERSE: inverse_flow(p, w, 1); break;
    case PL_RECURRENCE_INVERSE_MINUS: inverse_flow(p, w, -1); break;
    case PL_RECURRENCE_ANGLE: angle(p); break;
    case PL_RECURRENCE_NONE:  // inputs are there
    case PL_N_RECURRENCES: break;
  }
}

static void coefficient(place* p) {
  arb_ptr c = p->c + p->k;
  switch (p->node->op) {
    case PL_OP_ADD: arb_add(c, p->a + p->k, p->b + p->k, p->prec); break;
    case PL_OP_SUB: arb_sub(c, p->a + p->k, p->b + p->k, p->prec); break;
    case PL_OP_NEG: arb_neg(c, p->a + p->k); break;
    case PL_OP_SCALE: arb_mul(c, p->a + p->k, p->b, p->prec); break;
    case PL_OP_RSCALE: arb_div(c, p->a + p->k, p->b, p->prec); break;
    case PL_OP_MUL: convolve(c, NULL, 0, p->a, p->b, 0, p->k, p->k, p->prec); break;
    case PL_OP_SQR: square(p); break;
    case PL_OP_DIV: quotient(p); break;
    case PL_OP_SQRT: root(p); break;
    case PL_OP_POW: power(p); break;
    case PL_OP_ABS:
    case PL_OP_SIGN:
    case PL_OP_MIN:
    case PL_OP_MAX:
    case PL_OP_IF: branch(p); break;
    default: function_coefficient(p); break;
  }
}

static void value(place* p) {
  if (p->node->op < PL_OP_ADD) return;
  pl_ball_op(p->c, p->node->op, p->a, p->b, p->w, p->prec);
}

void pl_jet_coefficients(pl_ball_jet* j, pl_tape_level level, int k, slong prec, uint8_t wanted) {
  int from = level == PL_LEVEL_CONST ? 0 : j->tape->level_end[level - 1],
      to = j->tape->level_end[level];
  for (int i = from; i < to; i++) {
    if (!(j->wanted[i] & wanted)) continue;
    const pl_tape_node* node = &j->tape->nodes[i];
    arb_ptr weighted = j->aux_at[i] >= 0 ? j->aux + (slong)j->aux_at[i] * j->cap : NULL;
    place p = {j,
               i,
               k,
               prec,
               node,
               series_of(j, i),
               series_of(j, node->a),
               series_of(j, node->b),
               series_of(j, node->c),
               weighted};
    if (k == 0) value(&p);
    else coefficient(&p);
  }
}
