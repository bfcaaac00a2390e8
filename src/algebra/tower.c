// The tower itself: making and freeing it, running a service so that neither FLINT nor a hopeless
// case can take the program along, starting over with a larger context, and the list of generators
// with their order of writing.
//
// FLINT reports trouble by calling an abort function that must not return. Ours jumps to the
// innermost service of this thread; what FLINT held at that moment is lost (a leak, not a crash). A
// body that gives up of its own will takes the same jump, and then nothing is lost, because all
// polynomials stand on the tower's stack.
#include "algebra/tower.h"

#include <stdlib.h>
#include <string.h>

enum { PL_J_GIVE_UP = 1, PL_J_RESTART = 2, PL_J_FLINT = 3 };
enum { PL_CHUNK = 256, PL_MAX_RESTARTS = 60, PL_FIRST_CAPACITY = 16, PL_BIG_POLY = 4096 };

struct pl_entry {
  jmp_buf at;
  pl_entry* outer;      // of the same tower
  pl_entry* outer_any;  // of the same thread
  pl_tower* tower;
  pl_tower_mark mark;
  int depth;
  bool facts_busy, silent;
};

// The innermost service of this thread: FLINT's abort hook has no argument, so it has to be found
// without one.
static _Thread_local pl_entry* innermost;

static FLINT_NORETURN void on_flint_abort(void);
static void on_flint_abort(void) {
  if (innermost) longjmp(innermost->at, PL_J_FLINT);
  abort();
}

// ---------------------------------------------------------------------------------------- services
static void enter(pl_tower* t, pl_entry* e) {
  e->outer = t->entry;
  e->outer_any = innermost;
  e->tower = t;
  e->mark = pl_tower_mark_now(t);
  e->depth = t->depth;
  e->facts_busy = t->facts_busy;
  e->silent = t->silent;
  t->entry = e;
  innermost = e;
}

// What FLINT was working on when it aborted may be half made: forget it rather than free it.
static void forget_since(pl_tower* t, pl_tower_mark m) {
  for (int i = m.polys; i < t->polys_used; i++)
    fmpz_mpoly_init(&t->poly_chunks.at[i / PL_CHUNK][i % PL_CHUNK], &t->ctx);
  for (int i = m.ints; i < t->ints_used; i++)
    fmpz_init(&t->int_chunks.at[i / PL_CHUNK][i % PL_CHUNK]);
}

static void leave(pl_tower* t, pl_entry* e, int why) {
  if (why == PL_J_FLINT) {
    forget_since(t, e->mark);
    t->flint_factors_context = NULL;
    t->has_flint_integer_factors = false;
  }
  pl_tower_rewind(t, e->mark);
  t->depth = e->depth;
  t->facts_busy = e->facts_busy;
  t->radicand = NULL;
  t->silent = e->silent;
  t->entry = e->outer;
  innermost = e->outer_any;
}

static bool run_once(pl_tower* t, void (*body)(pl_tower*, void*), void* data, int* why_out) {
  pl_entry e;
  enter(t, &e);
  int why = setjmp(e.at);
  if (why == 0) body(t, data);
  leave(t, &e, why);
  *why_out = why;
  return why == 0;
}

static void empty_tower(pl_tower* t, int capacity);

// Bases as coarse as they were before anything was asked.
static void untangle(pl_tower* t) {
  for (int i = 0; i < t->angles.n; i++) t->angles.at[i] = pl_lattice_of(t, t->angles.at[i].atom);
  for (int i = 0; i < t->exponents.n; i++)
    t->exponents.at[i] = pl_lattice_of(t, t->exponents.at[i].atom);
  t->tangled = false;
  t->began_empty = true;
  t->wanted_empty = false;
  empty_tower(t, t->capacity);
}

static bool run_outermost(pl_tower* t, void (*body)(pl_tower*, void*), void* data) {
  t->began_empty = false;
  if (t->tangled) untangle(t);
  for (int tries = 0; tries < PL_MAX_RESTARTS; tries++) {
    int why = 0;
    if (run_once(t, body, data, &why)) return true;
    if (why != PL_J_RESTART) return false;
    if (t->wanted_empty) untangle(t);
    else empty_tower(t, t->capacity);
  }
  return false;
}

// The outermost service also stops an allocation failure on its way out, to leave the thread in
// order.
bool pl_tower_run(pl_tower* t, void (*body)(pl_tower* t, void* data), void* data) {
  int why = 0;
  if (t->entry) return run_once(t, body, data, &why);
  // one budget for each service; when all of them together have used theirs, only small ones are
  // done
  t->work_left = t->work_done > PL_WORK_OF_ALL ? PL_WORK_OF_SMALL : PL_WORK_OF_SERVICE;
  pl_entry* const before = innermost;
  pl_tower_mark const mark = pl_tower_mark_now(t);
  volatile bool done = false;
  pl_guard guard;
  pl_guard_begin(t->arena, &guard);
  if (setjmp(guard.at) == 0) {
    done = run_outermost(t, body, data);
    pl_guard_end(t->arena, &guard);
    return done;
  }
  innermost = before;
  t->entry = NULL;
  t->depth = 0;
  t->facts_busy = false;
  pl_tower_rewind(t, mark);
  pl_guard_end(t->arena, &guard);
  pl_unwind(t->arena, guard.status);
}

bool pl_algebra_guarded(void (*body)(void* data), void* data) {
  pl_entry e = {.outer_any = innermost};
  innermost = &e;
  flint_set_abort(on_flint_abort);
  volatile bool done = false;
  if (setjmp(e.at) == 0) {
    body(data);
    done = true;
  }
  innermost = e.outer_any;
  return done;
}

_Noreturn void pl_tower_give_up(pl_tower* t) { longjmp(t->entry->at, PL_J_GIVE_UP); }

_Noreturn void pl_tower_restart(pl_tower* t) {
  pl_entry* e = t->entry;
  while (e->outer) e = e->outer;
  longjmp(e->at, PL_J_RESTART);
}

void pl_tower_start_empty(pl_tower* t) {
  t->tangled = true;
  if (t->began_empty) return;
  t->wanted_empty = true;
  pl_tower_restart(t);
}

void pl_tower_charge(pl_tower* t, long work) {
  t->work_left -= work;
  t->work_done += work;
  if (t->work_left < 0) pl_tower_give_up(t);
}

void pl_tower_check(pl_tower* t) {
  if (pl_interrupted(t->job)) pl_tower_give_up(t);
}

// ---------------------------------------------------------------------------- what FLINT must free
pl_tower_mark pl_tower_mark_now(const pl_tower* t) {
  return (pl_tower_mark){t->polys_used, t->ints_used};
}

void pl_tower_rewind(pl_tower* t, pl_tower_mark m) {
  for (int i = m.polys; i < t->polys_used; i++) {
    pl_poly* f = &t->poly_chunks.at[i / PL_CHUNK][i % PL_CHUNK];
    if (f->length < PL_BIG_POLY) {
      fmpz_mpoly_zero(f, &t->ctx);
    } else {
      fmpz_mpoly_clear(f, &t->ctx);
      fmpz_mpoly_init(f, &t->ctx);
    }
  }
  for (int i = m.ints; i < t->ints_used; i++)
    fmpz_zero(&t->int_chunks.at[i / PL_CHUNK][i % PL_CHUNK]);
  t->polys_used = m.polys;
  t->ints_used = m.ints;
}

pl_poly* pl_poly_new(pl_tower* t) {
  if (t->polys_used == t->poly_chunks.n * PL_CHUNK) {
    pl_poly* chunk = PL_ARRAY(t->arena, pl_poly, PL_CHUNK);  // first, since it may unwind
    pl_push(t->arena, t->poly_chunks, chunk);
  }
  pl_poly* f = &t->poly_chunks.at[t->polys_used / PL_CHUNK][t->polys_used % PL_CHUNK];
  if (t->polys_used++ == t->polys_made) {
    fmpz_mpoly_init(f, &t->ctx);
    t->polys_made++;
  }
  return f;
}

fmpz* pl_int_new(pl_tower* t) {
  if (t->ints_used == t->int_chunks.n * PL_CHUNK) {
    fmpz* chunk = PL_ARRAY(t->arena, fmpz, PL_CHUNK);
    pl_push(t->arena, t->int_chunks, chunk);
  }
  int i = t->ints_used++;
  return &t->int_chunks.at[i / PL_CHUNK][i % PL_CHUNK];  // zeroed memory is the integer 0
}

const pl_poly* pl_poly_keep(pl_tower* t, const pl_poly* f) {
  pl_poly* copy = PL_NEW(t->arena, pl_poly);
  fmpz_mpoly_init(copy, &t->ctx);
  pl_push(t->arena, t->kept_polys, copy);
  fmpz_mpoly_set(copy, f, &t->ctx);
  return copy;
}

const fmpz* pl_int_keep(pl_tower* t, const fmpz* c) {
  fmpz* copy = PL_NEW(t->arena, fmpz);
  pl_push(t->arena, t->kept_ints, copy);
  fmpz_set(copy, c);
  return copy;
}

static void clear_polys(pl_tower* t) {
  for (int i = 0; i < t->polys_made; i++)
    fmpz_mpoly_clear(&t->poly_chunks.at[i / PL_CHUNK][i % PL_CHUNK], &t->ctx);
  for (int i = 0; i < t->kept_polys.n; i++) fmpz_mpoly_clear(t->kept_polys.at[i], &t->ctx);
  for (int i = 0; i < t->kept_ints.n; i++) fmpz_clear(t->kept_ints.at[i]);
  t->polys_made = t->polys_used = 0;
  t->kept_polys.n = t->kept_ints.n = 0;
}

// Forgets generators and everything made of them; angle bases and exponents stay.
static void empty_tower(pl_tower* t, int capacity) {
  clear_polys(t);
  fmpz_mpoly_ctx_clear(&t->ctx);
  fmpz_mpoly_ctx_init(&t->ctx, capacity, ORD_LEX);
  t->capacity = capacity;
  t->gens.n = t->n_ranked = t->fractions.n = t->bases.n = t->factorings.n = 0;
  t->gen_of = pl_map_make(t->arena);
  t->converted = pl_map_make(t->arena);
  t->base_of = pl_map_make(t->arena);
  t->factored_of = pl_map_make(t->arena);
  for (int i = 0; i < t->angles.n; i++) t->angles.at[i].gen = -1;
  for (int i = 0; i < t->exponents.n; i++) t->exponents.at[i].gen = -1;
}

// ------------------------------------------------------------------------------ making and freeing
pl_tower* pl_tower_make(pl_job* job, pl_pool* p, const pl_fact* facts, int n_facts) {
  flint_set_abort(on_flint_abort);
  pl_arena* a = pl_pool_arena(p);
  pl_tower* t = PL_NEW(a, pl_tower);
  t->job = job;
  t->pool = p;
  t->arena = a;
  for (int i = 0; i < n_facts; i++) {
    if (!pl_is_poison(facts[i].difference)) pl_push(a, t->facts, facts[i]);
  }
  t->angle_of = pl_map_make(a);
  t->exponent_of = pl_map_make(a);
  fmpz_mpoly_ctx_init(&t->ctx, 1, ORD_LEX);
  empty_tower(t, PL_FIRST_CAPACITY);
  return t;
}

void pl_algebra_thread_end(void) { flint_cleanup(); }

void pl_tower_free(pl_tower* t) {
  if (!t) return;
  pl_factor_free(t);
  clear_polys(t);
  for (int i = 0; i < t->int_chunks.n * PL_CHUNK; i++)
    fmpz_clear(&t->int_chunks.at[i / PL_CHUNK][i % PL_CHUNK]);
  t->int_chunks.n = 0;
  for (int i = 0; i <= PL_MAX_GENERATORS; i++) {
    if (t->small[i]) fmpz_mpoly_ctx_clear(t->small[i]);
    t->small[i] = NULL;
  }
  fmpz_mpoly_ctx_clear(&t->ctx);
}

// ------------------------------------------------------------------------------------- assumptions
void pl_tower_probe(pl_tower* t, const double* value_of_symbol) {
  t->n_probe = value_of_symbol ? pl_symbol_count(t->pool) : 0;
  if (!value_of_symbol) {
    t->probe = NULL;
    return;
  }
  double* copy = PL_ARRAY(t->arena, double, t->n_probe + 1);
  memcpy(copy, value_of_symbol, (size_t)(t->n_probe + 1) * sizeof *copy);
  t->probe = copy;
}

void pl_tower_define(pl_tower* t, const pl_replace* names, int n) {
  for (int i = 0; i < n; i++) {
    if (!pl_is_poison(names[i].to)) pl_push(t->arena, t->names, names[i]);
  }
}

pl_expr pl_tower_see(const pl_tower* t, pl_expr e) {
  for (int i = t->names.n - 1; i >= 0; i--)
    e = pl_subst1(t->pool, e, t->names.at[i].from, t->names.at[i].to);
  return e;
}

const pl_fact* pl_tower_used(const pl_tower* t, int* n) {
  *n = t->used.n;
  return t->used.at;
}

void pl_tower_use(pl_tower* t, pl_fact fact) {
  if (pl_is_poison(fact.difference)) return;
  for (int i = 0; i < t->used.n; i++) {
    if (!pl_same(t->used.at[i].difference, fact.difference)) continue;
    t->used.at[i].strict |= fact.strict;
    return;
  }
  pl_push(t->arena, t->used, fact);
}

// -------------------------------------------------------------------------------------- generators
int pl_tower_find(const pl_tower* t, pl_expr e) { return (int)pl_map_get(t->gen_of, e.id) - 1; }

int pl_tower_generator(pl_tower* t, const pl_gen* g) {
  if (pl_is_poison(g->expr)) pl_tower_give_up(t);  // the root of a negative number
  if (t->gens.n == t->capacity) {
    if (t->capacity + 8 > PL_MAX_GENERATORS) pl_tower_give_up(t);
    // the polynomials that exist belong to the old context, so everything starts again in a larger
    // one
    t->capacity += 8;
    pl_tower_restart(t);
  }
  pl_push(t->arena, t->gens, *g);
  pl_map_set(t->gen_of, g->expr.id, (uint64_t)t->gens.n);
  return t->gens.n - 1;
}

bool pl_gen_contains(const pl_tower* t, int gen, pl_symbol x) {
  return pl_has_symbol(t->pool, t->gens.at[gen].expr, x);
}

// Order of writing, K5: by class, then symbols by their own order, then by text.
static int compare_generators(pl_tower* t, int a, int b) {
  const pl_gen *x = &t->gens.at[a], *y = &t->gens.at[b];
  if (x->class != y->class) return x->class < y->class ? -1 : 1;
  if (x->symbol.id && y->symbol.id) {
    int c = pl_symbol_compare(t->pool, x->symbol, y->symbol);
    if (c) return c;
  }
  if (x->kind != y->kind) return x->kind < y->kind ? -1 : 1;
  return strcmp(pl_expr_text(t->arena, t->pool, x->expr), pl_expr_text(t->arena, t->pool, y->expr));
}

void pl_tower_order(pl_tower* t) {
  // insertion: generators come one by one, and the order of the old ones does not change
  for (int g = t->n_ranked; g < t->gens.n; g++) {
    int k = g;
    for (; k > 0 && compare_generators(t, g, t->by_rank[k - 1]) < 0; k--)
      t->by_rank[k] = t->by_rank[k - 1];
    t->by_rank[k] = g;
  }
  t->n_ranked = t->gens.n;
  for (int k = 0; k < t->gens.n; k++) t->rank[t->by_rank[k]] = k;
}
