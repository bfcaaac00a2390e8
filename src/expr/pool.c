// The pool: nodes by hash-consing, argument lists, scratch memory, walks. A node is found or made;
// equal construction gives the equal handle. Everything is reserved before anything is changed, so
// an arena that unwinds in the middle leaves the pool as it was.
#include "expr/expr_impl.h"

#include <assert.h>
#include <string.h>

const char* const pl_function_name[PL_N_FUNCTIONS] = {
#define PL_FUNCTION(name, text, ...) text,
#include "expr/functions.def"
};

const char* const pl_function_tex[PL_N_FUNCTIONS] = {
#define PL_FUNCTION(name, text, n, tex, ...) tex,
#include "expr/functions.def"
};

const int pl_function_arity[PL_N_FUNCTIONS] = {
#define PL_FUNCTION(name, text, n, ...) n,
#include "expr/functions.def"
};

// ----------------------------------------------------------------------------------------- scratch
struct pl_scratch {
  // blocks of 2^k bytes that were given back, linked through their first word
  void* list[PL_SCRATCH_CLASSES];
};

static int size_class(size_t bytes) {
  int k = 8;
  while (((size_t)1 << k) < bytes) k++;
  return k;
}

void* pl_scratch_take(const pl_pool* p, size_t bytes) {
  if (bytes > (size_t)1 << (PL_SCRATCH_CLASSES - 2)) pl_unwind(p->arena, PLEUEL_NO_MEMORY);
  int k = size_class(bytes);
  void* at = p->scratch->list[k];
  if (at == NULL) return pl_alloc(p->arena, (size_t)1 << k);
  memcpy(&p->scratch->list[k], at, sizeof(void*));
  return at;
}

void pl_scratch_give(const pl_pool* p, void* at, size_t bytes) {
  if (at == NULL) return;
  int k = size_class(bytes);
  memcpy(at, &p->scratch->list[k], sizeof(void*));
  p->scratch->list[k] = at;
}

void* pl_temp_grow(const pl_pool* p, void* at, int n, int* cap, size_t size) {
  if (*cap > (1 << 29)) pl_unwind(p->arena, PLEUEL_NO_MEMORY);
  size_t old_bytes = (size_t)*cap * size;
  int k = size_class(old_bytes ? old_bytes * 2 : 16 * size);
  void* to = pl_scratch_take(p, (size_t)1 << k);
  if (n > 0) memcpy(to, at, (size_t)n * size);
  pl_scratch_give(p, at, old_bytes);
  *cap = (int)(((size_t)1 << k) / size);
  // pl_temp_free finds the class again from cap * size
  assert(size_class((size_t)*cap * size) == k);
  return to;
}

// ------------------------------------------------------------------------------------ making nodes
static uint64_t hash_node(pl_kind kind, int function, int dots, uint32_t symbol,
                          const pl_expr* args, int n) {
  uint64_t h = pl_hash_mix((uint64_t)kind | (uint64_t)function << 8 | (uint64_t)dots << 16, symbol);
  for (int i = 0; i < n; i++) h = pl_hash_mix(h, args[i].id);
  return h;
}

static bool same_node(const pl_node* x, pl_kind kind, int function, int dots, uint32_t symbol,
                      const pl_expr* args, int n) {
  return x->kind == kind && x->function == function && x->dots == dots && x->symbol == symbol
         && x->n == (uint32_t)n
         && (n == 0 || memcmp(x->u.args, args, (size_t)n * sizeof *args) == 0);
}

static uint32_t free_slot(const pl_pool* p, const uint32_t* table, uint32_t cap, uint64_t hash) {
  uint32_t i = (uint32_t)hash & (cap - 1);
  while (table[i] != 0) i = (i + 1) & (cap - 1);
  return i;
}

static void widen_table(pl_pool* p) {
  if (p->table_cap > UINT32_MAX / 2) pl_unwind(p->arena, PLEUEL_NO_MEMORY);
  uint32_t cap = p->table_cap ? p->table_cap * 2 : 1024;
  uint32_t* table = PL_ARRAY(p->arena, uint32_t, cap);
  for (uint32_t id = 1; id < p->n_nodes; id++) {
    table[free_slot(p, table, cap, pl_node_at(p, (pl_expr){id})->hash)] = id;
  }
  p->table = table;
  p->table_cap = cap;
}

// Room for one more node and its n arguments, so that adding it cannot fail.
static void reserve_node(pl_pool* p) {
  if (p->n_nodes == UINT32_MAX) pl_unwind(p->arena, PLEUEL_NO_MEMORY);
  if ((p->n_nodes >> PL_CHUNK_BITS) == (uint32_t)p->chunks.n) {
    pl_node* chunk = PL_ARRAY(p->arena, pl_node, PL_CHUNK);
    pl_push(p->arena, p->chunks, chunk);
  }
  if ((uint64_t)p->n_nodes * 2 >= p->table_cap) widen_table(p);
}

static pl_expr* reserve_args(pl_pool* p, const pl_expr* args, int n) {
  if ((uint32_t)n > p->arg_left) {
    uint32_t room = n > 512 ? (uint32_t)n : 4096;
    p->arg_room = PL_ARRAY(p->arena, pl_expr, room);
    p->arg_left = room;
  }
  pl_expr* to = p->arg_room;
  memcpy(to, args, (size_t)n * sizeof *args);
  p->arg_room += n;
  p->arg_left -= (uint32_t)n;
  return to;
}

static pl_expr add_node(pl_pool* p, pl_node node) {
  uint32_t id = p->n_nodes++;
  p->chunks.at[id >> PL_CHUNK_BITS][id & (PL_CHUNK - 1)] = node;
  if (id != 0) p->table[free_slot(p, p->table, p->table_cap, node.hash)] = id;
  return (pl_expr){id};
}

static uint32_t height_over(const pl_pool* p, const pl_expr* args, int n) {
  uint32_t height = 0;
  for (int i = 0; i < n; i++) {
    uint32_t h = pl_node_at(p, args[i])->height + 1;
    if (h > height) height = h;
  }
  return height;
}

pl_expr pl_node_make(pl_pool* p, pl_kind kind, int function, int dots, uint32_t symbol,
                     const pl_expr* args, int n) {
  uint64_t hash = hash_node(kind, function, dots, symbol, args, n);
  for (uint32_t i = (uint32_t)hash & (p->table_cap - 1); p->table[i] != 0;
       i = (i + 1) & (p->table_cap - 1)) {
    const pl_node* x = pl_node_at(p, (pl_expr){p->table[i]});
    if (x->hash == hash && same_node(x, kind, function, dots, symbol, args, n))
      return (pl_expr){p->table[i]};
  }
  reserve_node(p);
  pl_node node = {.hash = hash,
                  .kind = (uint8_t)kind,
                  .function = (uint8_t)function,
                  .dots = (uint8_t)dots,
                  .n = (uint32_t)n,
                  .symbol = symbol,
                  .height = height_over(p, args, n)};
  if (n > 0) node.u.args = reserve_args(p, args, n);
  return add_node(p, node);
}

static bool same_number(const pl_number* x, const pl_number* y) {
  if (x->limbs == NULL || y->limbs == NULL)
    return x->limbs == y->limbs && x->num == y->num && x->den == y->den;
  if (x->n_num != y->n_num || x->n_den != y->n_den) return false;
  size_t n = (size_t)(x->n_num < 0 ? -x->n_num : x->n_num) + (size_t)x->n_den;
  return memcmp(x->limbs, y->limbs, n * sizeof *x->limbs) == 0;
}

pl_expr pl_number_make(pl_pool* p, const pl_number* x) {
  size_t n = x->limbs ? (size_t)(x->n_num < 0 ? -x->n_num : x->n_num) + (size_t)x->n_den : 0;
  uint64_t hash = pl_hash_mix(pl_hash_mix(PL_NUMBER, (uint64_t)x->num), (uint64_t)x->den);
  if (n > 0) hash = pl_hash_bytes(x->limbs, n * sizeof *x->limbs, (uint64_t)x->n_num);
  for (uint32_t i = (uint32_t)hash & (p->table_cap - 1); p->table[i] != 0;
       i = (i + 1) & (p->table_cap - 1)) {
    const pl_node* y = pl_node_at(p, (pl_expr){p->table[i]});
    if (y->hash == hash && y->kind == PL_NUMBER && same_number(y->u.number, x))
      return (pl_expr){p->table[i]};
  }
  reserve_node(p);
  pl_number* kept = PL_NEW(p->arena, pl_number);
  *kept = *x;
  if (n > 0) {
    mp_limb_t* limbs = PL_ARRAY(p->arena, mp_limb_t, n);
    memcpy(limbs, x->limbs, n * sizeof *limbs);
    kept->limbs = limbs;
  }
  return add_node(p, (pl_node){.hash = hash, .kind = PL_NUMBER, .u.number = kept});
}

// -------------------------------------------------------------------------------------------- pool
pl_pool* pl_pool_make(pl_arena* a) {
  pl_pool* p = PL_NEW(a, pl_pool);
  p->arena = a;
  p->scratch = PL_NEW(a, struct pl_scratch);
  widen_table(p);
  p->symbol_cap = 64;
  p->symbol_table = PL_ARRAY(a, uint32_t, p->symbol_cap);

  // node 0 is poison, and not in the table
  reserve_node(p);
  add_node(p, (pl_node){.kind = PL_POISON});
  p->zero = pl_number_make(p, &(pl_number){.num = 0, .den = 1});
  p->one = pl_number_make(p, &(pl_number){.num = 1, .den = 1});
  p->minus_one = pl_number_make(p, &(pl_number){.num = -1, .den = 1});
  p->two = pl_number_make(p, &(pl_number){.num = 2, .den = 1});
  p->half = pl_number_make(p, &(pl_number){.num = 1, .den = 2});
  p->pi = pl_node_make(p, PL_PI, 0, 0, 0, NULL, 0);
  return p;
}

pl_arena* pl_pool_arena(const pl_pool* p) { return p->arena; }

// Nodes never move and arrays that grow leave the old ones as they were, so the old pointers hold.
const pl_pool* pl_pool_view(pl_arena* a, const pl_pool* p) {
  pl_pool* view = PL_NEW(a, pl_pool);
  *view = *p;
  view->arena = a;
  view->scratch = PL_NEW(a, struct pl_scratch);
  view->arg_left = 0;
  return view;
}

// ------------------------------------------------------------------------------------------- walks
static uint32_t walk_slot(const pl_walk* w, const uint32_t* table, uint32_t cap, pl_expr e) {
  uint32_t i = (e.id * 0x9e3779b1u) & (cap - 1);
  while (table[i] != 0 && w->nodes.at[table[i] - 1].id != e.id) i = (i + 1) & (cap - 1);
  return i;
}

static void walk_widen(pl_walk* w) {
  uint32_t cap = w->cap ? w->cap * 4 : 64;
  uint32_t* table = pl_scratch_take(w->p, cap * sizeof *table);
  memset(table, 0, cap * sizeof *table);
  for (int i = 0; i < w->nodes.n; i++)
    table[walk_slot(w, table, cap, w->nodes.at[i])] = (uint32_t)i + 1;
  pl_scratch_give(w->p, w->table, w->cap * sizeof *table);
  w->table = table;
  w->cap = cap;
}

static bool walk_met(const pl_walk* w, pl_expr e) {
  return w->table[walk_slot(w, w->table, w->cap, e)] != 0;
}

static void walk_add(pl_walk* w, pl_expr e) {
  if ((uint32_t)w->nodes.n * 2 >= w->cap) walk_widen(w);
  pl_temp_push(w->p, w->nodes, e);
  // the slot is looked for as if e were not there yet
  uint32_t i = (e.id * 0x9e3779b1u) & (w->cap - 1);
  while (w->table[i] != 0) i = (i + 1) & (w->cap - 1);
  w->table[i] = (uint32_t)w->nodes.n;
}

typedef struct visit {
  pl_expr e;
  uint32_t next;  // argument to look at next
} visit;

void pl_walk_begin(pl_walk* w, const pl_pool* p, const pl_expr* roots, int n_roots) {
  *w = (pl_walk){.p = p};
  walk_widen(w);
  PL_TEMP(visit) stack = {0};
  for (int i = 0; i < n_roots; i++) {
    if (walk_met(w, roots[i])) continue;
    pl_temp_push(p, stack, (visit){roots[i], 0});
    while (stack.n > 0) {
      visit* top = &stack.at[stack.n - 1];
      const pl_node* x = pl_node_at(p, top->e);
      while (top->next < x->n && walk_met(w, x->u.args[top->next])) top->next++;
      if (top->next < x->n) {
        pl_expr arg = x->u.args[top->next++];
        pl_temp_push(p, stack, (visit){arg, 0});
        continue;
      }
      walk_add(w, top->e);
      stack.n--;
    }
  }
  pl_temp_free(p, stack);
}

int pl_walk_position(const pl_walk* w, pl_expr e) {
  return (int)w->table[walk_slot(w, w->table, w->cap, e)] - 1;
}

void pl_walk_end(pl_walk* w) {
  pl_temp_free(w->p, w->nodes);
  pl_scratch_give(w->p, w->table, w->cap * sizeof *w->table);
  *w = (pl_walk){0};
}
