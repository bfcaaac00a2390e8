// Sample points of a domain, and the values of expressions there as balls.
//
// A symbol's value is drawn from its name and the number of the point, so that it does not depend
// on what was asked before. Values are multiples of 2^-30, exact as doubles and as balls. When a
// fact fails at a point, one of the symbols in it is drawn anew, until all facts hold (in the
// manner of WalkSAT: a random symbol of the first violated fact).
//
// All points share one straight-line program: the distinct nodes of all expressions asked so far,
// arguments first. Each point keeps the balls it has computed, so that a formula that shares nodes
// with earlier ones costs only its new ones. Kept balls are frozen: read-only copies whose
// mantissas stand in the arena, so that there is nothing to free.
#include "algebra/arb_eval.h"

#include <math.h>
#include <string.h>

enum { PL_MAX_REDRAWS = 400, PL_MAX_NODES = 400000, PL_CHUNK_SLOTS = 64, PL_LIMBS = 4096 };
// sizes that are neither tiny nor huge: no cancellation by scale
static const double draw_low = 0.3, draw_high = 3.0;
static const double grid = 1073741824.0;  // 2^30
static const double rounding = 1e-14;     // of the terms of a fact

typedef struct pl_sample_point {
  double* value;  // by symbol id, NaN where not drawn yet      (n_values)
  int n_values;
  uint32_t* draws;  // how often the symbol was drawn              (n_values)
  bool usable;
  PL_VEC(arb_ptr) chunks;  // frozen balls by slot
  int n_done;              // slots computed
  // frozen solution of the linear system        (n_unknowns), NULL until needed
  arb_ptr unknown;
  bool solved;
} pl_sample_point;

struct pl_points {
  pl_job* job;
  pl_pool* pool;
  pl_arena* arena;
  pl_domain setup;
  long precision;
  uint64_t seed;
  int n;
  pl_sample_point* at;
  pl_map* slot_of;  // expression id -> slot + 1
  PL_VEC(pl_expr) program;
  pl_map* definition_of;  // symbol id -> definition + 1
  pl_map* unknown_of;     // symbol id -> unknown + 1
  mp_limb_t* limbs;       // room for frozen mantissas
  size_t n_limbs;         // free ones
};

// ----------------------------------------------------------------------------------------- drawing
static double on_grid(double x) { return nearbyint(x * grid) / grid; }

static double draw(const pl_points* s, int point, pl_symbol x, uint32_t attempt) {
  const pl_symbol_info* info = pl_symbol_get(s->pool, x);
  uint64_t h = pl_hash_bytes(info->ascii, strlen(info->ascii), s->seed);
  pl_random r = {pl_hash_mix(pl_hash_mix(h, (uint64_t)point + 1), attempt)};
  // equally likely on a logarithmic scale
  double size = draw_low * pow(draw_high / draw_low, pl_random_unit(&r));
  bool negative = pl_random_bits(&r) & 1;
  if (info->role == PL_R_INDEX) return 1 + (double)(pl_random_bits(&r) % 5);
  switch (info->sign) {
    case PL_SIGN_POSITIVE:
    case PL_SIGN_NONNEGATIVE: return on_grid(size);
    case PL_SIGN_NEGATIVE:
    case PL_SIGN_NONPOSITIVE: return -on_grid(size);
    default: return negative ? -on_grid(size) : on_grid(size);
  }
}

static bool is_free(const pl_points* s, pl_symbol x) {
  return !pl_map_get(s->definition_of, x.id) && !pl_map_get(s->unknown_of, x.id);
}

// Gives every symbol of the pool a place, and every free one a value.
static void fill(pl_points* s, int point) {
  pl_sample_point* q = &s->at[point];
  int n = pl_symbol_count(s->pool) + 1;
  if (n <= q->n_values) return;
  double* value = PL_ARRAY(s->arena, double, n + n / 2);
  uint32_t* draws = PL_ARRAY(s->arena, uint32_t, n + n / 2);
  if (q->n_values) memcpy(value, q->value, (size_t)q->n_values * sizeof *value);
  if (q->n_values) memcpy(draws, q->draws, (size_t)q->n_values * sizeof *draws);
  int from = q->n_values ? q->n_values : 1;
  value[0] = (double)NAN;
  for (int i = from; i < n + n / 2; i++) value[i] = (double)NAN;
  for (int i = from; i < n; i++) {
    pl_symbol x = {(uint32_t)i};
    if (is_free(s, x)) value[i] = draw(s, point, x, 0);
  }
  q->value = value;
  q->draws = draws;
  q->n_values = n;
}

// Definitions in order; returns the first that has no value, or -1.
static int define(pl_points* s, pl_sample_point* q) {
  int bad = -1;
  for (int i = 0; i < s->setup.n_definitions; i++) {
    const pl_definition* d = &s->setup.definitions[i];
    double v = pl_eval(s->pool, d->value, q->value);
    q->value[d->symbol.id] = v;
    if (isnan(v) && bad < 0) bad = i;
  }
  return bad;
}

// A closed contact is zero by definition, but for rounding.
static bool is_met(const pl_points* s, const pl_sample_point* q, const pl_fact* f) {
  double v = pl_eval(s->pool, f->difference, q->value);
  if (f->strict) return v > 0;
  return v >= 0 || v >= -rounding * pl_eval_terms(s->pool, f->difference, q->value);
}

static int first_violated(const pl_points* s, const pl_sample_point* q) {
  for (int i = 0; i < s->setup.n_facts; i++) {
    if (!is_met(s, q, &s->setup.facts[i])) return i;
  }
  return -1;
}

// Free symbols that e depends on, through definitions too.
static int free_symbols(pl_points* s, pl_expr e, pl_symbol* out, int max) {
  int n = pl_symbols_in(s->pool, e, out, max);
  if (n > max) n = max;
  for (int i = 0; i < n;) {
    if (is_free(s, out[i])) {
      i++;
      continue;
    }
    uint64_t d = pl_map_get(s->definition_of, out[i].id);
    out[i] = out[--n];
    if (!d) continue;
    pl_symbol more[64];
    int m = free_symbols(s, s->setup.definitions[d - 1].value, more, 64);
    for (int k = 0; k < m; k++) {
      bool there = false;
      for (int j = 0; j < n; j++) there |= out[j].id == more[k].id;
      if (!there && n < max) out[n++] = more[k];
    }
  }
  return n;
}

static bool redraw_one_of(pl_points* s, int point, pl_expr e, pl_random* r) {
  pl_symbol x[64];
  int n = free_symbols(s, e, x, 64);
  if (n == 0) return false;
  pl_sample_point* q = &s->at[point];
  pl_symbol chosen = x[pl_random_bits(r) % (uint64_t)n];
  q->value[chosen.id] = draw(s, point, chosen, ++q->draws[chosen.id]);
  return true;
}

static void draw_point(pl_points* s, int point) {
  fill(s, point);
  pl_sample_point* q = &s->at[point];
  pl_random r = {pl_hash_mix(s->seed, 77 + (uint64_t)point)};
  for (int k = 0; k < PL_MAX_REDRAWS; k++) {
    int undefined = define(s, q);
    int violated = undefined < 0 ? first_violated(s, q) : -1;
    if (undefined < 0 && violated < 0) {
      q->usable = true;
      return;
    }
    pl_expr e = undefined >= 0 ? s->setup.definitions[undefined].value
                               : s->setup.facts[violated].difference;
    if (!redraw_one_of(s, point, e, &r)) return;
  }
}

pl_points* pl_points_make(pl_job* job, pl_pool* p, const pl_domain* setup, int n_points,
                          long precision, uint64_t seed) {
  pl_arena* a = pl_pool_arena(p);
  pl_points* s = PL_NEW(a, pl_points);
  *s = (pl_points){.job = job,
                   .pool = p,
                   .arena = a,
                   .setup = *setup,
                   .precision = precision,
                   .seed = seed,
                   .n = n_points};
  s->slot_of = pl_map_make(a);
  s->definition_of = pl_map_make(a);
  s->unknown_of = pl_map_make(a);
  for (int i = 0; i < setup->n_definitions; i++) {
    pl_map_set(s->definition_of, setup->definitions[i].symbol.id, (uint64_t)i + 1);
  }
  for (int i = 0; i < setup->n_unknowns; i++)
    pl_map_set(s->unknown_of, setup->unknowns[i].id, (uint64_t)i + 1);
  s->at = PL_ARRAY(a, pl_sample_point, n_points);
  for (int i = 0; i < n_points; i++) draw_point(s, i);
  return s;
}

int pl_points_count(const pl_points* s) { return s->n; }

// ------------------------------------------------------------------------------------- the program
static arb_ptr ball(const pl_sample_point* q, int slot) {
  return &q->chunks.at[slot / PL_CHUNK_SLOTS][slot % PL_CHUNK_SLOTS];
}

// Room for one more mantissa, so that freezing allocates nothing while a ball of Arb's own is
// alive.
static void reserve_limbs(pl_points* s, size_t n) {
  size_t needed = n * ((size_t)s->precision / FLINT_BITS + 2);
  if (s->n_limbs >= needed) return;
  s->n_limbs = needed > PL_LIMBS ? needed : PL_LIMBS;
  s->limbs = PL_ARRAY(s->arena, mp_limb_t, s->n_limbs);
}

// to becomes a read-only copy of from. Huge exponents, which have memory of their own, count as no
// value.
static void freeze(pl_points* s, arb_ptr to, arb_srcptr from) {
  const arf_struct* mid = arb_midref(from);
  bool large = COEFF_IS_MPZ(*ARF_EXPREF(mid)) || COEFF_IS_MPZ(MAG_EXP(arb_radref(from)));
  if (large || !arb_is_finite(from) || (ARF_HAS_PTR(mid) && (size_t)ARF_SIZE(mid) > s->n_limbs)) {
    arb_indeterminate(to);
    return;
  }
  *to = *from;
  if (!ARF_HAS_PTR(mid)) return;
  size_t n = (size_t)ARF_SIZE(mid);
  memcpy(s->limbs, ARF_PTR_D(mid), n * sizeof *s->limbs);
  ARF_PTR_D(arb_midref(to)) = s->limbs;
  s->limbs += n;
  s->n_limbs -= n;
}

static int slot_of(const pl_points* s, pl_expr e) { return (int)pl_map_get(s->slot_of, e.id) - 1; }

static bool add_to_program(pl_points* s, pl_expr e, int depth);

// What a symbol stands on: its definition, or the linear system.
static bool add_symbol(pl_points* s, pl_symbol x, int depth) {
  uint64_t d = pl_map_get(s->definition_of, x.id);
  if (d) return add_to_program(s, s->setup.definitions[d - 1].value, depth + 1);
  if (!pl_map_get(s->unknown_of, x.id)) return true;
  int n = s->setup.n_unknowns;
  for (int i = 0; i < n * n; i++) {
    if (!add_to_program(s, s->setup.A[i], depth + 1)) return false;
  }
  for (int i = 0; i < n; i++) {
    if (!add_to_program(s, s->setup.b[i], depth + 1)) return false;
  }
  return true;
}

static bool add_to_program(pl_points* s, pl_expr e, int depth) {
  if (slot_of(s, e) >= 0) return true;
  if (depth > PL_MAX_DEPTH || s->program.n >= PL_MAX_NODES) return false;
  pl_kind k = pl_kind_of(s->pool, e);
  if (k == PL_SYMBOL && !add_symbol(s, pl_symbol_of(s->pool, e), depth)) return false;
  if (k != PL_SUM && k != PL_AT && k != PL_UNKNOWN_FUNCTION) {
    for (int i = 0; i < pl_n_args(s->pool, e); i++) {
      if (!add_to_program(s, pl_arg(s->pool, e, i), depth + 1)) return false;
    }
  }
  pl_push(s->arena, s->program, e);
  pl_map_set(s->slot_of, e.id, (uint64_t)s->program.n);
  return true;
}

// ---------------------------------------------------------------------------------------- unknowns
// Gauss elimination with the largest pivot, in balls; on the n x (n+1) matrix M.
static bool solve_balls(arb_ptr M, int n, long precision) {
  arb_t factor;
  arb_init(factor);
  bool ok = true;
  for (int k = 0; k < n && ok; k++) {
    int best = -1;
    for (int i = k; i < n; i++) {
      if (arb_contains_zero(&M[i * (n + 1) + k])) continue;
      if (best < 0
          || arf_cmpabs(arb_midref(&M[i * (n + 1) + k]), arb_midref(&M[best * (n + 1) + k])) > 0)
        best = i;
    }
    ok = best >= 0;
    if (!ok) break;
    for (int j = 0; j <= n && best != k; j++) arb_swap(&M[k * (n + 1) + j], &M[best * (n + 1) + j]);
    for (int i = 0; i < n; i++) {
      if (i == k || arb_is_zero(&M[i * (n + 1) + k])) continue;
      arb_div(factor, &M[i * (n + 1) + k], &M[k * (n + 1) + k], precision);
      for (int j = k; j <= n; j++)
        arb_submul(&M[i * (n + 1) + j], factor, &M[k * (n + 1) + j], precision);
    }
  }
  for (int i = 0; i < n && ok; i++) {
    arb_div(&M[i * (n + 1) + n], &M[i * (n + 1) + n], &M[i * (n + 1) + i], precision);
    ok = arb_is_finite(&M[i * (n + 1) + n]);
  }
  arb_clear(factor);
  return ok;
}

static void solve_unknowns(pl_points* s, pl_sample_point* q) {
  int n = s->setup.n_unknowns;
  q->unknown = PL_ARRAY(s->arena, arb_struct, n);
  reserve_limbs(s, (size_t)n);
  arb_ptr M = _arb_vec_init((slong)n * (n + 1));
  bool ok = true;
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < n; j++)
      arb_set(&M[i * (n + 1) + j], ball(q, slot_of(s, s->setup.A[i * n + j])));
    arb_set(&M[i * (n + 1) + n], ball(q, slot_of(s, s->setup.b[i])));
  }
  for (int i = 0; i < n * (n + 1); i++) ok = ok && arb_is_finite(&M[i]);
  q->solved = ok && solve_balls(M, n, s->precision);
  for (int i = 0; i < n && q->solved; i++) freeze(s, &q->unknown[i], &M[i * (n + 1) + n]);
  _arb_vec_clear(M, (slong)n * (n + 1));
}

// ----------------------------------------------------------------------------- running the program
static void prepare_symbol(pl_points* s, pl_sample_point* q, pl_symbol x) {
  if (!q->unknown && pl_map_get(s->unknown_of, x.id)) solve_unknowns(s, q);
}

static void symbol_ball(pl_points* s, pl_sample_point* q, arb_ptr out, pl_symbol x) {
  uint64_t d = pl_map_get(s->definition_of, x.id);
  if (d) {
    arb_set(out, ball(q, slot_of(s, s->setup.definitions[d - 1].value)));
    return;
  }
  uint64_t u = pl_map_get(s->unknown_of, x.id);
  if (!u) {
    arb_set_d(out, q->value[x.id]);
    return;
  }
  if (q->solved) {
    arb_set(out, &q->unknown[u - 1]);
  } else {
    arb_indeterminate(out);
  }
}

// Elements of families are free, drawn by their text.
static double element_value(pl_points* s, int point, pl_expr e) {
  const char* text = pl_expr_text(s->arena, s->pool, e);
  pl_random r = {pl_hash_mix(pl_hash_bytes(text, strlen(text), s->seed), (uint64_t)point + 1)};
  return on_grid(pl_random_between(&r, -draw_high, draw_high));
}

static void run_slot(pl_points* s, int point, int slot) {
  pl_sample_point* q = &s->at[point];
  pl_expr e = s->program.at[slot];
  pl_kind k = pl_kind_of(s->pool, e);
  int n = k == PL_SUM || k == PL_AT || k == PL_UNKNOWN_FUNCTION ? 0 : pl_n_args(s->pool, e);
  arb_srcptr few[16];
  arb_srcptr* args = n <= 16 ? few : PL_ARRAY(s->arena, arb_srcptr, n);
  for (int i = 0; i < n; i++) args[i] = ball(q, slot_of(s, pl_arg(s->pool, e, i)));
  if (k == PL_SYMBOL) prepare_symbol(s, q, pl_symbol_of(s->pool, e));
  double element = k == PL_AT ? element_value(s, point, e) : 0;
  reserve_limbs(s, 1);
  arb_t out;
  arb_init(out);
  if (k == PL_SYMBOL) {
    symbol_ball(s, q, out, pl_symbol_of(s->pool, e));
  } else if (k == PL_AT) {
    arb_set_d(out, element);
  } else if (k == PL_SUM || k == PL_UNKNOWN_FUNCTION) {
    arb_indeterminate(out);
  } else {
    pl_arb_node(out, s->pool, e, args, s->arena, s->precision);
  }
  freeze(s, ball(q, slot), out);
  arb_clear(out);
}

static void run_to(pl_points* s, int point, int slot) {
  pl_sample_point* q = &s->at[point];
  fill(s, point);
  for (; q->n_done <= slot; q->n_done++) {
    if (q->n_done == q->chunks.n * PL_CHUNK_SLOTS) {
      // zeroed memory is the ball 0
      arb_ptr chunk = PL_ARRAY(s->arena, arb_struct, PL_CHUNK_SLOTS);
      pl_push(s->arena, q->chunks, chunk);
    }
    run_slot(s, point, q->n_done);
  }
}

bool pl_points_value(pl_points* s, int point, pl_expr e, arb_srcptr* value) {
  if (point >= s->n || !s->at[point].usable || !add_to_program(s, e, 0)) return false;
  int slot = slot_of(s, e);
  run_to(s, point, slot);
  *value = ball(&s->at[point], slot);
  return arb_is_finite(*value);
}

double pl_points_double(pl_points* s, int point, pl_expr e) {
  arb_srcptr v;
  if (!pl_points_value(s, point, e, &v)) return (double)NAN;
  if (arb_rel_accuracy_bits(v) < 20 && !arb_is_zero(v)) return 0;  // nothing but rounding
  return arf_get_d(arb_midref(v), ARF_RND_NEAR);
}

pl_points* pl_tower_points(pl_tower* t) {
  pl_domain s = {.facts = t->facts.at, .n_facts = t->facts.n};
  if (!t->points) t->points = pl_points_make(t->job, t->pool, &s, PL_POINT_COUNT, PL_POINT_BITS, 1);
  return t->points;
}
