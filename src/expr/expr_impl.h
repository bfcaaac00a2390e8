// What the rooms of expr share: nodes, the pool, numbers, temporary arrays, walks over the DAG.
#ifndef PL_EXPR_IMPL_H
#define PL_EXPR_IMPL_H

#include <assert.h>
#include <gmp.h>

#include "expr/expr.h"

// ----------------------------------------------------------------------------------------- numbers
// An exact rational in lowest terms, den > 0. Small ones stand in num and den; larger ones (limbs
// not NULL) as limbs of the numerator, then of the denominator.
typedef struct pl_number {
  int64_t num, den;
  const mp_limb_t* limbs;
  int32_t n_num;  // limbs of the numerator, negative for a negative number
  int32_t n_den;
} pl_number;

// ------------------------------------------------------------------------------------------- nodes
typedef struct pl_node {
  uint64_t hash;
  uint8_t kind;      // pl_kind
  uint8_t function;  // pl_function of a PL_CALL
  uint8_t dots;      // of a PL_AT
  uint32_t n;        // arguments
  uint32_t symbol;   // of PL_SYMBOL, PL_AT, PL_SUM
  uint32_t height;   // 0 without arguments, else one more than the highest of them
  union {
    const pl_expr* args;      // (n), every id lower than the node's own
    const pl_number* number;  // of a PL_NUMBER
  } u;
} pl_node;

enum { PL_CHUNK_BITS = 10, PL_CHUNK = 1 << PL_CHUNK_BITS, PL_SCRATCH_CLASSES = 48 };

struct pl_pool {
  pl_arena* arena;
  PL_VEC(pl_node*) chunks;  // nodes never move                     (PL_CHUNK each)
  uint32_t n_nodes;         // ids run 1 .. n_nodes-1
  uint32_t* table;          // ids by hash, open addressing         (table_cap)
  uint32_t table_cap;
  pl_expr* arg_room;  // where argument lists are copied to
  uint32_t arg_left;
  PL_VEC(pl_symbol_info*) symbols;  // [id - 1]
  uint32_t* symbol_table;           // ids by hash of ascii                 (symbol_cap)
  uint32_t symbol_cap;
  struct pl_scratch* scratch;
  pl_expr zero, one, minus_one, two, half, pi;
  pl_symbol time;
};

static inline const pl_node* pl_node_at(const pl_pool* p, pl_expr e) {
  return &p->chunks.at[e.id >> PL_CHUNK_BITS][e.id & (PL_CHUNK - 1)];
}

// The one way to a node.  args are copied when the node is new.
pl_expr pl_node_make(pl_pool* p, pl_kind kind, int function, int dots, uint32_t symbol,
                     const pl_expr* args, int n);
pl_expr pl_number_make(pl_pool* p, const pl_number* x);

// -------------------------------------------------------------------------------- temporary arrays
// Memory that a pass takes and gives back; the pool keeps it for the next pass. (An arena rewind
// would take the new nodes with it.)
void* pl_scratch_take(const pl_pool* p, size_t bytes);
void pl_scratch_give(const pl_pool* p, void* at, size_t bytes);

// PL_TEMP(pl_expr) v = {0};  pl_temp_push(p, v, e);  pl_temp_free(p, v);
#define PL_TEMP(T) PL_VEC(T)
void* pl_temp_grow(const pl_pool* p, void* at, int n, int* cap, size_t size);
#define pl_temp_push(p, v, ...)                                                                \
  do {                                                                                         \
    if ((v).n == (v).cap) (v).at = pl_temp_grow((p), (v).at, (v).n, &(v).cap, sizeof *(v).at); \
    (v).at[(v).n++] = __VA_ARGS__;                                                             \
  } while (0)
#define pl_temp_free(p, v) pl_scratch_give((p), (v).at, (size_t)(v).cap * sizeof *(v).at)
typedef PL_TEMP(pl_expr) pl_exprs;

// ------------------------------------------------------------------------------------------- walks
// All nodes below some roots, each once, arguments before what uses them. Passes run over at[0..n)
// and keep their results in arrays beside it, so depth costs no stack.
typedef struct pl_walk {
  const pl_pool* p;
  pl_exprs nodes;
  uint32_t* table;  // position + 1, by hash of the id
  uint32_t cap;
} pl_walk;
void pl_walk_begin(pl_walk* w, const pl_pool* p, const pl_expr* roots, int n_roots);
int pl_walk_position(const pl_walk* w, pl_expr e);  // of a node that was met
void pl_walk_end(pl_walk* w);

// The expression e with other arguments: canonical again.
pl_expr pl_rebuild(pl_pool* p, pl_expr e, const pl_expr* args);

// ------------------------------------------------------------------------------------------- order
// A total order on expressions that depends on structure and names only: <0, 0 (same handle), >0.
int pl_compare(const pl_pool* p, pl_expr a, pl_expr b);
int pl_compare_factors(const pl_pool* p, const pl_expr* a, int n_a, const pl_expr* b, int n_b);
int pl_natural_compare(const char* a, const char* b);  // m2 before m10
// Stable sort; less tells whether a comes strictly before b.
typedef bool (*pl_less)(const void* a, const void* b, const void* user);
void pl_sort(const pl_pool* p, void* at, int n, size_t size, pl_less less, const void* user);

// A term as coefficient times factors: 3 x^2 y is 3, {x^2, y}. one holds the factor when there is
// only one.
typedef struct pl_term {
  pl_expr coefficient, one, whole;
  const pl_expr* factors;
  int n;
} pl_term;
pl_term pl_term_of(const pl_pool* p, pl_expr e);
static inline const pl_expr* pl_term_factors(const pl_term* t) {
  return t->factors ? t->factors : &t->one;
}
// Base and exponent of a factor; the exponent of what is no power is 1.
static inline pl_expr pl_base_of(const pl_pool* p, pl_expr e) {
  return pl_kind_of(p, e) == PL_POW ? pl_arg(p, e, 0) : e;
}
static inline pl_expr pl_exponent_of(const pl_pool* p, pl_expr e) {
  return pl_kind_of(p, e) == PL_POW ? pl_arg(p, e, 1) : p->one;
}

// --------------------------------------------------------------------------- arithmetic of numbers
// All take PL_NUMBER nodes or poison. Poison when a result is too large (PL_NUMBER_LIMBS); callers
// keep it symbolic if they can.
enum { PL_NUMBER_LIMBS = 1 << 14, PL_POWER_BITS = 1 << 16 };
static inline const pl_number* pl_number_of(const pl_pool* p, pl_expr e) {
  assert(pl_node_at(p, e)->kind == PL_NUMBER);
  return pl_node_at(p, e)->u.number;
}
pl_expr pl_number_add(pl_pool* p, pl_expr a, pl_expr b);
pl_expr pl_number_mul(pl_pool* p, pl_expr a, pl_expr b);
pl_expr pl_number_inv(pl_pool* p, pl_expr a);          // poison for 0
pl_expr pl_number_pow(pl_pool* p, pl_expr a, long n);  // poison when larger than PL_POWER_BITS
int pl_number_compare(const pl_pool* p, pl_expr a, pl_expr b);
bool pl_number_is_integer(const pl_pool* p, pl_expr a);
pl_expr pl_number_floor(pl_pool* p, pl_expr a);
pl_expr pl_number_num(pl_pool* p, pl_expr a);
pl_expr pl_number_den(pl_pool* p, pl_expr a);
// a = outside^q * inside for an integer a > 0, inside as free of q-th powers as trial division
// finds.
void pl_number_split_root(pl_pool* p, pl_expr a, int q, pl_expr* outside, pl_expr* inside);
// ok = false: denominator is 0
uint64_t pl_number_mod(const pl_pool* p, pl_expr a, uint64_t modulus, bool* ok);

#endif
