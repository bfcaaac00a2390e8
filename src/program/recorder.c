// Writing expressions down as a straight-line program: common subexpressions shared, constants kept
// apart, series operations given the partner node that their recurrence reads.
//
// Sums become chains in the order of the expression, products are split into constants, numerator
// and denominator. Nodes are emitted in topological order and sorted by level at the end (ORDER
// LEVELS).
#include "program/tape.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum {
  MAX_NODES = 1 << 24,  // keys of the table of subexpressions hold two node numbers
  MAX_DEPTH = 4000,     // nesting of an expression; beyond it the C stack would be at risk
  MAX_SUM = 1000000,    // terms of a sum over an index
  MAX_POWER = 64        // integer powers up to this become multiplications
};

typedef struct recorder {
  pl_job* job;
  pl_arena* arena;
  pl_pool* pool;
  const pl_tape_slots* slots;
  PL_VEC(pl_tape_node) nodes;
  PL_VEC(pl_symbol) params;
  // what a number is exactly, poison where its double is; empty behind the last such number
  PL_VEC(pl_expr) constants;
  pl_map *by_expr, *by_op, *by_value, *atoms, *by_param;
  int depth;
  pleuel_status status;  // of the first failure
} recorder;

static int record(recorder* r, pl_expr e);

static int give_up(recorder* r, pleuel_status s, const char* fmt, const char* what) {
  if (r->status == PLEUEL_OK) r->status = pl_fail(r->job, s, fmt, what);
  return 0;  // any node will do: nobody looks at it
}

// ---------------------------------------------------------------------------------------- emitting
// After a failure there may be no node at all.
static pl_tape_level level_of(const recorder* r, int node) {
  return node < 0 || node >= r->nodes.n ? PL_LEVEL_CONST : (pl_tape_level)r->nodes.at[node].level;
}

static int append(recorder* r, pl_tape_node node) {
  if (r->nodes.n >= MAX_NODES - 2)
    return give_up(r, PLEUEL_UNSUPPORTED, "the program has too many operations%s", "");
  pl_push(r->arena, r->nodes, node);
  return r->nodes.n - 1;
}

static int number(recorder* r, double x) {
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  uint64_t key = bits + 1;  // 0.0 is not "absent"
  uint64_t known = pl_map_get(r->by_value, key);
  if (known) return (int)(known - 1);
  int node = append(
      r, (pl_tape_node){
             .op = PL_OP_CONST, .level = PL_LEVEL_CONST, .a = -1, .b = -1, .c = -1, .value = x});
  pl_map_set(r->by_value, key, (uint64_t)node + 1);
  return node;
}

// A number that a double need not hold: 1/3, π. x: in parts. Numbers that round to the same double
// stay apart.
static int exact_number(recorder* r, pl_expr e, const double x[3]) {
  if (floor(x[0]) == x[0] && fabs(x[0]) < 0x1p53 && pl_is_int(r->pool, e, NULL))
    return number(r, x[0]);
  uint64_t key = UINT64_C(1) << 62 | e.id;
  uint64_t known = pl_map_get(r->by_op, key);
  if (known) return (int)(known - 1);
  int node = append(r, (pl_tape_node){.op = PL_OP_CONST,
                                      .level = PL_LEVEL_CONST,
                                      .a = -1,
                                      .b = -1,
                                      .c = -1,
                                      .value = x[0],
                                      .rest = {x[1], x[2]}});
  while (r->constants.n < node) pl_push(r->arena, r->constants, pl_poison());
  if (r->constants.n == node) pl_push(r->arena, r->constants, e);
  pl_map_set(r->by_op, key, (uint64_t)node + 1);
  return node;
}

static int rational(recorder* r, pl_expr e) {
  double x[3];
  pl_number_doubles(r->pool, e, x);
  return exact_number(r, e, x);
}

static int pi(recorder* r, pl_expr e) {
  return exact_number(r, e,
                      (const double[3]){3.14159265358979323846, 1.2246467991473531772e-16,
                                        -2.9947698097183396659e-33});
}

static int input(recorder* r, pl_op op, pl_tape_level level, int slot) {
  uint64_t key = (uint64_t)(op + 1) << 56 | (uint64_t)(slot + 1);
  uint64_t known = pl_map_get(r->by_op, key);
  if (known) return (int)(known - 1);
  int node = append(
      r, (pl_tape_node){
             .op = (uint8_t)op, .level = (uint8_t)level, .a = -1, .b = -1, .c = -1, .slot = slot});
  pl_map_set(r->by_op, key, (uint64_t)node + 1);
  return node;
}

static bool commutes(pl_op op) {
  return op == PL_OP_ADD || op == PL_OP_MUL || op == PL_OP_MIN || op == PL_OP_MAX;
}

static int emit(recorder* r, pl_op op, int a, int b) {
  if (commutes(op) && a > b) {
    int x = a;
    a = b;
    b = x;
  }
  uint64_t key = (uint64_t)(op + 1) << 56 | (uint64_t)(a + 1) << 28 | (uint64_t)(b + 1);
  uint64_t known = pl_map_get(r->by_op, key);
  if (known) return (int)(known - 1);
  pl_tape_level level = level_of(r, a) > level_of(r, b) ? level_of(r, a) : level_of(r, b);
  int node = append(
      r, (pl_tape_node){.op = (uint8_t)op, .level = (uint8_t)level, .a = a, .b = b, .c = -1});
  pl_map_set(r->by_op, key, (uint64_t)node + 1);
  return node;
}

static bool is_constant(const recorder* r, int node) { return level_of(r, node) == PL_LEVEL_CONST; }

// Products and quotients with a constant are linear: no convolution.
static int times(recorder* r, int a, int b) {
  if (is_constant(r, a) && is_constant(r, b)) return emit(r, PL_OP_MUL, a, b);
  if (is_constant(r, b)) return emit(r, PL_OP_SCALE, a, b);
  if (is_constant(r, a)) return emit(r, PL_OP_SCALE, b, a);
  if (a == b) return emit(r, PL_OP_SQR, a, -1);
  return emit(r, PL_OP_MUL, a, b);
}

static int over(recorder* r, int a, int b) {
  if (is_constant(r, b) && !is_constant(r, a)) return emit(r, PL_OP_RSCALE, a, b);
  return emit(r, PL_OP_DIV, a, b);
}

// A pair of functions, each the partner of the other.
static int pair(recorder* r, pl_op op, pl_op other, int a) {
  int x = emit(r, op, a, -1), y = emit(r, other, a, -1);
  r->nodes.at[x].c = y;
  r->nodes.at[y].c = x;
  return x;
}

static int with_partner(recorder* r, pl_op op, int a, int b, int partner) {
  int x = emit(r, op, a, b);
  r->nodes.at[x].c = partner;
  return x;
}

static int with_own_square(recorder* r, pl_op op, int a) {
  int x = emit(r, op, a, -1), square = times(r, x, x);  // may move the list of nodes
  r->nodes.at[x].c = square;
  return x;
}

// ------------------------------------------------------------------------------------------ powers
static int power_int(recorder* r, int base, long n) {  // n >= 1
  int result = -1;
  while (n > 0) {
    if (n & 1) result = result < 0 ? base : times(r, result, base);
    n >>= 1;
    if (n > 0) base = times(r, base, base);
  }
  return result;
}

// base^(num/den) for num/den > 0.
static int power_ratio(recorder* r, int base, long num, long den) {
  if (den == 1 && num <= MAX_POWER) return power_int(r, base, num);
  if (den == 2 && num == 1) return emit(r, PL_OP_SQRT, base, -1);
  return emit(r, PL_OP_POW, base, rational(r, pl_ratio(r->pool, num, den)));
}

static int power(recorder* r, pl_expr base, pl_expr exponent) {
  long num, den;
  int b = record(r, base);
  if (pl_is_ratio(r->pool, exponent, &num, &den) && num > -100000 && num < 100000 && den < 100000) {
    if (num == 0) return number(r, 1);
    if (num > 0) return power_ratio(r, b, num, den);
    return over(r, number(r, 1), power_ratio(r, b, -num, den));
  }
  int e = record(r, exponent);
  if (is_constant(r, e)) return emit(r, PL_OP_POW, b, e);
  // a^b = exp(b ln a)
  return emit(r, PL_OP_EXP, times(r, e, emit(r, PL_OP_LN, b, -1)), -1);
}

// ---------------------------------------------------------------------------------- products, sums
typedef struct product {
  int constant, above, below, constant_below;
} product;  // -1: empty

static void gather(recorder* r, int* into, int node) {
  *into = *into < 0 ? node : times(r, *into, node);
}

static void gather_factor(recorder* r, product* p, pl_expr f) {
  long num, den;
  if (pl_kind_of(r->pool, f) == PL_POW && pl_is_ratio(r->pool, pl_arg(r->pool, f, 1), &num, &den)
      && num < 0 && num > -100000 && den < 100000) {
    int node = power_ratio(r, record(r, pl_arg(r->pool, f, 0)), -num, den);
    gather(r, is_constant(r, node) ? &p->constant_below : &p->below, node);
    return;
  }
  int node = record(r, f);
  gather(r, is_constant(r, node) ? &p->constant : &p->above, node);
}

// The product of a node's factors; with its number made positive when *negative tells the caller to
// subtract.
static int product_of(recorder* r, pl_expr e, bool* negative) {
  product p = {-1, -1, -1, -1};
  *negative = false;
  for (int i = 0; i < pl_n_args(r->pool, e); i++) {
    pl_expr f = pl_arg(r->pool, e, i);
    if (pl_is_number(r->pool, f) && pl_number_sign(r->pool, f) < 0) {
      *negative = true;
      f = pl_neg(r->pool, f);
      if (pl_is_one_node(r->pool, f)) continue;
    }
    gather_factor(r, &p, f);
  }
  int constant = p.constant;
  if (p.constant_below >= 0)
    constant = over(r, constant < 0 ? number(r, 1) : constant, p.constant_below);
  int x = p.above;
  if (p.below >= 0) {
    // a constant above a quotient takes the place of the 1
    if (x < 0 && constant >= 0) return over(r, constant, p.below);
    x = over(r, x < 0 ? number(r, 1) : x, p.below);
  }
  if (x < 0) return constant < 0 ? number(r, 1) : constant;
  return constant < 0 ? x : times(r, x, constant);
}

static int record_product(recorder* r, pl_expr e) {
  bool negative;
  int x = product_of(r, e, &negative);
  return negative ? emit(r, PL_OP_NEG, x, -1) : x;
}

static int record_term(recorder* r, pl_expr term, bool* negative) {
  *negative = false;
  if (pl_kind_of(r->pool, term) == PL_MUL) return product_of(r, term, negative);
  if (pl_is_number(r->pool, term) && pl_number_sign(r->pool, term) < 0) {
    *negative = true;
    return record(r, pl_neg(r->pool, term));
  }
  return record(r, term);
}

static int chain(recorder* r, int sum, int x, bool negative) {
  if (sum >= 0) return emit(r, negative ? PL_OP_SUB : PL_OP_ADD, sum, x);
  return negative ? emit(r, PL_OP_NEG, x, -1) : x;
}

// Constants are added up first; they enter once.
static int record_sum(recorder* r, pl_expr e) {
  int sum = -1;
  for (int pass = 0; pass < 2; pass++) {
    for (int i = 0; i < pl_n_args(r->pool, e); i++) {
      bool negative;
      int x = record_term(r, pl_arg(r->pool, e, i), &negative);
      if (is_constant(r, x) == (pass == 0)) sum = chain(r, sum, x, negative);
    }
  }
  return sum < 0 ? number(r, 0) : sum;
}

// ------------------------------------------------------------------------------------- other nodes
static int record_call(recorder* r, pl_expr e) {
  int a = record(r, pl_arg(r->pool, e, 0));
  int b = pl_n_args(r->pool, e) > 1 ? record(r, pl_arg(r->pool, e, 1)) : -1;
  pl_op op = pl_op_of_function[pl_function_of(r->pool, e)];
  switch (op) {
#define SELF         emit(r, op, a, b)
#define ARGUMENT     emit(r, op, a, b)
#define PAIR(other)  pair(r, op, PL_OP_##other, a)
#define SELF_SQUARED with_own_square(r, op, a)
#define NODE(w)      with_partner(r, op, a, b, w)
#define A            a
#define B            b
#define ONE          number(r, 1)
#define SQR(x)       times(r, x, x)
#define ADD(x, y)    emit(r, PL_OP_ADD, x, y)
#define SUB(x, y)    emit(r, PL_OP_SUB, x, y)
#define SQRT(x)      emit(r, PL_OP_SQRT, x, -1)
// clang-format off
#define PL_FUNCTION(name, text, n, tex, form, value, derivative, library, recurrence, w, ...) \
  case PL_OP_##name: return w;
#define PL_PIECEWISE(name, ...) \
  case PL_OP_##name: return emit(r, op, a, b);
#include "expr/functions.def"
    // clang-format on
    default: break;
  }
  return give_up(r, PLEUEL_UNSUPPORTED, "no numbers for the function %s",
                 pl_function_name[pl_function_of(r->pool, e)]);
}

static int record_if(recorder* r, pl_expr e) {
  int a = record(r, pl_arg(r->pool, e, 0)), b = record(r, pl_arg(r->pool, e, 1)),
      c = record(r, pl_arg(r->pool, e, 2));
  pl_tape_level level = level_of(r, a);
  if (level_of(r, b) > level) level = level_of(r, b);
  if (level_of(r, c) > level) level = level_of(r, c);
  return append(r, (pl_tape_node){.op = PL_OP_IF, .level = (uint8_t)level, .a = a, .b = b, .c = c});
}

// A sum over an index with bounds that are numbers is written out.
static int record_index_sum(recorder* r, pl_expr e) {
  double lo = pl_eval(r->pool, pl_arg(r->pool, e, 1), r->slots->value_of_symbol);
  double hi = pl_eval(r->pool, pl_arg(r->pool, e, 2), r->slots->value_of_symbol);
  pl_symbol index = pl_symbol_of(r->pool, e);
  if (!(lo == floor(lo) && hi == floor(hi) && hi - lo < MAX_SUM && fabs(lo) < 1e9
        && fabs(hi) < 1e9))
    return give_up(r, PLEUEL_UNSUPPORTED, "the bounds of a sum are not whole numbers%s", "");
  int sum = number(r, 0);
  for (long i = (long)lo; i <= (long)hi && r->status == PLEUEL_OK; i++) {
    int x = record(r, pl_subst1(r->pool, pl_arg(r->pool, e, 3), index, pl_int(r->pool, i)));
    sum = i == (long)lo ? x : emit(r, PL_OP_ADD, sum, x);
  }
  return sum;
}

static int parameter(recorder* r, pl_expr e) {
  pl_symbol s = pl_symbol_of(r->pool, e);
  for (int i = 0; i < r->slots->n_index; i++)
    if (r->slots->index[i].id == s.id) return input(r, PL_OP_INDEX, PL_LEVEL_CONST, i);
  if (s.id == pl_time(r->pool).id) return input(r, PL_OP_TIME, PL_LEVEL_POSITION, 0);
  const double* values = r->slots->value_of_symbol;
  if (values == NULL || isnan(values[s.id]))
    return give_up(r, PLEUEL_USAGE, "%s has no value", pl_symbol_get(r->pool, s)->name);
  const pl_expr* definition = r->slots->definition;
  if (definition && !pl_is_poison(definition[s.id])) return record(r, definition[s.id]);
  uint64_t known = pl_map_get(r->by_param, s.id);
  if (!known) {
    pl_push(r->arena, r->params, s);
    known = (uint64_t)r->params.n;
    pl_map_set(r->by_param, s.id, known);
  }
  return input(r, PL_OP_PARAM, PL_LEVEL_CONST, (int)known - 1);
}

static int record_new(recorder* r, pl_expr e) {
  switch (pl_kind_of(r->pool, e)) {
    case PL_POISON: return give_up(r, PLEUEL_NUMERICAL, "an expression has no value%s", "");
    case PL_NUMBER: return rational(r, e);
    case PL_PI: return pi(r, e);
    case PL_SYMBOL: return parameter(r, e);
    case PL_AT:
      return give_up(r, PLEUEL_USAGE, "%s has no place here", pl_expr_text(r->arena, r->pool, e));
    case PL_ADD: return record_sum(r, e);
    case PL_MUL: return record_product(r, e);
    case PL_POW: return power(r, pl_arg(r->pool, e, 0), pl_arg(r->pool, e, 1));
    case PL_CALL: return record_call(r, e);
    case PL_IF: return record_if(r, e);
    case PL_SUM: return record_index_sum(r, e);
    case PL_INFINITY:
    case PL_UNKNOWN_FUNCTION: break;
  }
  return give_up(r, PLEUEL_UNSUPPORTED, "%s has no number", pl_expr_text(r->arena, r->pool, e));
}

static int record_atom(recorder* r, uint64_t atom) {
  static const pl_tape_level level[] = {[PL_OP_Q] = PL_LEVEL_POSITION,
                                        [PL_OP_V] = PL_LEVEL_VELOCITY,
                                        [PL_OP_A] = PL_LEVEL_FORCE,
                                        [PL_OP_LAMBDA] = PL_LEVEL_FORCE};
  pl_op op = (pl_op)(atom >> 32);
  return input(r, op, level[op], (int)(atom & 0xffffffffu));
}

static int record(recorder* r, pl_expr e) {
  if (r->status != PLEUEL_OK) return 0;
  uint64_t known = pl_map_get(r->by_expr, e.id);
  if (known && e.id) return (int)(known - 1);
  uint64_t atom = e.id ? pl_map_get(r->atoms, e.id) : 0;
  if (r->depth >= MAX_DEPTH)
    return give_up(r, PLEUEL_UNSUPPORTED, "an expression is nested too deeply%s", "");
  r->depth++;
  int node = atom ? record_atom(r, atom) : record_new(r, e);
  r->depth--;
  if (e.id && r->status == PLEUEL_OK) pl_map_set(r->by_expr, e.id, (uint64_t)node + 1);
  return node;
}

// --------------------------------------------------------------------------------------- the whole
static void bind(recorder* r, pl_expr atom, pl_op op, int slot) {
  if (atom.id) pl_map_set(r->atoms, atom.id, (uint64_t)op << 32 | (uint64_t)slot);
}

static void bind_slots(recorder* r) {
  for (int i = 0; i < r->slots->n_q; i++) {
    pl_expr v = pl_dt(r->pool, r->slots->q[i]);
    bind(r, r->slots->q[i], PL_OP_Q, i);
    bind(r, v, PL_OP_V, i);
    bind(r, pl_dt(r->pool, v), PL_OP_A, i);
  }
  for (int i = 0; i < r->slots->n_c && r->slots->lambda; i++)
    bind(r, r->slots->lambda[i], PL_OP_LAMBDA, i);
}

// Marks what the motion needs above order 0: the roots that say so, their operands and partners.
static void mark_high(recorder* r, int* stack, int root) {
  int n = 0;
  stack[n++] = root;
  while (n > 0) {
    pl_tape_node* node = &r->nodes.at[stack[--n]];
    if (node->high) continue;
    node->high = true;
    const int operand[3] = {node->a, node->b, node->c};
    for (int i = 0; i < 3; i++)
      if (operand[i] >= 0 && !r->nodes.at[operand[i]].high) stack[n++] = operand[i];
  }
}

static int moved(const int* to, int node) { return node < 0 ? -1 : to[node]; }

// Stable sort by level.
static void sort_by_level(recorder* r, pl_tape* tape, pl_tape_node* sorted, int* to) {
  int n = 0;
  for (int level = 0; level < PL_N_LEVELS; level++) {
    for (int i = 0; i < r->nodes.n; i++)
      if (r->nodes.at[i].level == level) to[i] = n++;
    tape->level_end[level] = n;
  }
  for (int i = 0; i < r->nodes.n; i++) {
    pl_tape_node node = r->nodes.at[i];
    node.a = moved(to, node.a);
    node.b = moved(to, node.b);
    node.c = moved(to, node.c);
    sorted[to[i]] = node;
  }
}

static int* input_nodes(recorder* r, const pl_tape* tape, pl_op op, int n) {
  int* node = PL_ARRAY(r->arena, int, n + 1);
  for (int i = 0; i < n; i++) node[i] = -1;
  for (int i = 0; i < tape->n_nodes; i++)
    if (tape->nodes[i].op == op) node[tape->nodes[i].slot] = i;
  return node;
}

static void finish_params(recorder* r, pl_tape* tape) {
  double* value = PL_ARRAY(r->arena, double, r->params.n + 1);
  for (int i = 0; i < r->params.n; i++) value[i] = r->slots->value_of_symbol[r->params.at[i].id];
  tape->n_param = r->params.n;
  tape->param_value = value;
  tape->param_symbol = r->params.at;
}

static void finish_constants(recorder* r, pl_tape* tape, const int* to) {
  pl_expr* constant = PL_ARRAY(r->arena, pl_expr, tape->n_nodes + 1);
  for (int i = 0; i < r->constants.n; i++) constant[to[i]] = r->constants.at[i];
  tape->constant = constant;
}

static pl_tape* finish(recorder* r, const int* root, const bool* high, int n) {
  pl_tape* tape = PL_NEW(r->arena, pl_tape);
  int n_nodes = r->nodes.n;
  int* stack = PL_ARRAY(r->arena, int, 3 * (size_t)n_nodes + 4);
  int* to = PL_ARRAY(r->arena, int, n_nodes + 1);
  int* roots = PL_ARRAY(r->arena, int, n + 1);
  pl_tape_node* sorted = PL_ARRAY(r->arena, pl_tape_node, n_nodes + 1);
  for (int i = 0; i < n; i++)
    if (high == NULL || high[i]) mark_high(r, stack, root[i]);
  sort_by_level(r, tape, sorted, to);
  for (int i = 0; i < n_nodes; i++)
    assert(!pl_op_recurrence[sorted[i].op] || pl_op_partner(&sorted[i], i) >= 0);
  for (int i = 0; i < n; i++) roots[i] = to[root[i]];
  tape->nodes = sorted;
  tape->n_nodes = n_nodes;
  tape->roots = roots;
  tape->n_roots = n;
  tape->n_q = r->slots->n_q;
  tape->n_c = r->slots->n_c;
  tape->n_index = r->slots->n_index;
  tape->q_node = input_nodes(r, tape, PL_OP_Q, tape->n_q);
  tape->v_node = input_nodes(r, tape, PL_OP_V, tape->n_q);
  tape->a_node = input_nodes(r, tape, PL_OP_A, tape->n_q);
  tape->lambda_node = input_nodes(r, tape, PL_OP_LAMBDA, tape->n_c);
  finish_params(r, tape);
  finish_constants(r, tape, to);
  return tape;
}

pleuel_status pl_tape_record(pl_job* job, pl_pool* pool, const pl_tape_slots* slots,
                             const pl_expr* roots, const bool* high, int n, pl_tape** out) {
  recorder r = {.job = job, .arena = job->arena, .pool = pool, .slots = slots};
  r.by_expr = pl_map_make(r.arena);
  r.by_op = pl_map_make(r.arena);
  r.by_value = pl_map_make(r.arena);
  r.by_param = pl_map_make(r.arena);
  r.atoms = pl_map_make(r.arena);
  bind_slots(&r);
  int* node = PL_ARRAY(r.arena, int, n + 1);
  for (int i = 0; i < n; i++) {
    node[i] = record(&r, roots[i]);
    if (r.status != PLEUEL_OK) return r.status;
  }
  *out = finish(&r, node, high, n);
  return PLEUEL_OK;
}
