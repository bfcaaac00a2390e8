// All zeros of a function of one symbol in a range, proven: by ball arithmetic on smaller and
// smaller boxes.
//   f has no zero where its ball does not contain 0;
//   f has one zero where the ball of f' does not contain 0 and f changes its sign, none where it
//   does not.
// A box in which neither is decided at the smallest width is left open: a multiple zero, or nearly
// one. [Tucker2011, sec. 5.1]
#include "algebra/arb_eval.h"

#include <math.h>

enum {
  PL_MAX_SEARCH_NODES = 2000,
  PL_MAX_BOXES = 20000,
  PL_SEARCH_BITS = 128,
  PL_SEARCH_STACK = 4096,
  PL_HALVINGS = 90
};
// of the width: a zero at a round number is then no end of a box
static const double split_at = 0.4687;
static const double narrowest = 1e-11;  // width of a box left open, relative to its place or to 1

// f and f' with their nodes, arguments first.
typedef struct pl_zero_search {
  pl_pool* pool;
  pl_arena* arena;
  pl_symbol x;
  pl_map* slot_of;  // expression id -> slot + 1
  PL_VEC(pl_expr) node;
  arb_ptr value;  //                     (n_nodes)
  arb_t at;
  int f, slope;  // slots
  int boxes;
} pl_zero_search;

typedef struct pl_search_box {
  double lo, hi;
} pl_search_box;

static int slot_of(const pl_zero_search* s, pl_expr e) {
  return (int)pl_map_get(s->slot_of, e.id) - 1;
}

static bool add_node(pl_zero_search* s, pl_expr e, int depth) {
  if (slot_of(s, e) >= 0) return true;
  if (depth > PL_MAX_DEPTH || s->node.n >= PL_MAX_SEARCH_NODES) return false;
  bool other = pl_kind_of(s->pool, e) == PL_SYMBOL && pl_symbol_of(s->pool, e).id != s->x.id;
  if (pl_is_poison(e) || other) return false;
  for (int i = 0; i < pl_n_args(s->pool, e); i++) {
    if (!add_node(s, pl_arg(s->pool, e, i), depth + 1)) return false;
  }
  pl_push(s->arena, s->node, e);
  pl_map_set(s->slot_of, e.id, (uint64_t)s->node.n);
  return true;
}

// The argument of a square root or a logarithm is negative throughout: f is not real there.
static bool outside_domain(const pl_zero_search* s, pl_expr e, const arb_srcptr* args) {
  pl_kind kind = pl_kind_of(s->pool, e);
  if (kind == PL_CALL) return pl_function_of(s->pool, e) == PL_LN && arb_is_negative(args[0]);
  long num = 0, den = 1;
  bool root = kind == PL_POW && pl_is_ratio(s->pool, pl_arg(s->pool, e, 1), &num, &den)
              && den % 2 == 0;
  return root && arb_is_negative(args[0]);
}

// Values of all nodes on s->at; false where the function is not real.
static bool evaluate(pl_zero_search* s) {
  enum { most = 64 };
  arb_srcptr few[most];
  s->boxes++;
  for (int k = 0; k < s->node.n; k++) {
    pl_expr e = s->node.at[k];
    int n = pl_n_args(s->pool, e);
    const arb_srcptr* args = few;
    arb_srcptr* list = n <= most ? few : PL_ARRAY(s->arena, arb_srcptr, n);
    for (int i = 0; i < n; i++) list[i] = &s->value[slot_of(s, pl_arg(s->pool, e, i))];
    args = list;
    if (pl_kind_of(s->pool, e) == PL_SYMBOL) {
      arb_set(&s->value[k], s->at);
      continue;
    }
    if (n > 0 && outside_domain(s, e, args)) return false;
    pl_arb_node(&s->value[k], s->pool, e, args, s->arena, PL_SEARCH_BITS);
  }
  return true;
}

static bool on_box(pl_zero_search* s, double lo, double hi) {
  arf_t a, b;
  arf_init(a);
  arf_init(b);
  arf_set_d(a, lo);
  arf_set_d(b, hi);
  arb_set_interval_arf(s->at, a, b, PL_SEARCH_BITS);
  arf_clear(a);
  arf_clear(b);
  return evaluate(s);
}

static int sign_of(arb_srcptr v) { return arb_is_positive(v) ? 1 : arb_is_negative(v) ? -1 : 0; }

static int sign_at(pl_zero_search* s, double x) {
  return on_box(s, x, x) ? sign_of(&s->value[s->f]) : 0;
}

// The zero between two places of opposite sign, to the digits of a double.
static double halved(pl_zero_search* s, double lo, double hi, int at_lo) {
  for (int k = 0; k < PL_HALVINGS; k++) {
    double mid = lo + 0.5 * (hi - lo);
    if (mid <= lo || mid >= hi) break;
    int here = sign_at(s, mid);
    if (here == 0) return mid;
    if (here == at_lo) lo = mid;
    else hi = mid;
  }
  return fabs(lo) < fabs(hi) ? lo : hi;
}

typedef enum pl_box_verdict { PL_BOX_EMPTY, PL_BOX_ONE, PL_BOX_OPEN } pl_box_verdict;

static pl_box_verdict judge(pl_zero_search* s, pl_search_box b, double* zero) {
  if (!on_box(s, b.lo, b.hi) || sign_of(&s->value[s->f])) return PL_BOX_EMPTY;
  int slope = arb_is_finite(&s->value[s->slope]) ? sign_of(&s->value[s->slope]) : 0;
  if (!slope) return PL_BOX_OPEN;
  int lo = sign_at(s, b.lo), hi = sign_at(s, b.hi);
  if (lo == 0 || hi == 0) return PL_BOX_OPEN;
  if (lo == hi) return PL_BOX_EMPTY;
  *zero = halved(s, b.lo, b.hi, lo);
  return PL_BOX_ONE;
}

typedef struct pl_zeros_job {
  pl_zero_search s;
  pl_search_box range;
  pl_zero* out;
  int n, max;
  bool complete;
} pl_zeros_job;

// Open boxes that touch belong to one place.
static void add_zero(pl_zeros_job* j, double at, bool proven) {
  for (int k = 0; k < j->n && !proven; k++) {
    bool near = fabs(j->out[k].value - at) <= 100 * narrowest * fmax(1, fabs(at));
    if (near) return;
  }
  if (j->n == j->max) j->complete = false;
  else j->out[j->n++] = (pl_zero){at, proven};
}

static void search_body(pl_tower* t, void* data) {
  (void)t;
  pl_zeros_job* j = data;
  pl_zero_search* s = &j->s;
  s->value = _arb_vec_init(s->node.n);
  arb_init(s->at);
  pl_search_box* stack = PL_ARRAY(s->arena, pl_search_box, PL_SEARCH_STACK);
  int n = 0;
  stack[n++] = j->range;
  while (n > 0 && j->complete) {
    pl_search_box b = stack[--n];
    double zero = 0, mid = b.lo + split_at * (b.hi - b.lo);
    pl_box_verdict verdict = judge(s, b, &zero);
    if (verdict == PL_BOX_EMPTY) continue;
    if (verdict == PL_BOX_ONE) {
      add_zero(j, zero, true);
    } else if (b.hi - b.lo < narrowest * fmax(1, fabs(mid))) {
      add_zero(j, mid, false);
    } else if (n + 2 > PL_SEARCH_STACK || s->boxes > PL_MAX_BOXES) {
      j->complete = false;
    } else {
      stack[n++] = (pl_search_box){mid, b.hi};  // the lower half is looked at first
      stack[n++] = (pl_search_box){b.lo, mid};
    }
  }
  _arb_vec_clear(s->value, s->node.n);
  arb_clear(s->at);
}

int pl_alg_zeros(pl_tower* t, pl_expr e, pl_symbol x, double lo, double hi, pl_zero* out, int max,
                 bool* complete) {
  pl_expr slope = pl_diff(t->pool, e, x);
  pl_zeros_job j = {
      .s = {.pool = t->pool, .arena = t->arena, .x = x, .slot_of = pl_map_make(t->arena)},
      .range = {lo, hi},
      .out = out,
      .max = max,
      .complete = true};
  *complete = false;
  if (!add_node(&j.s, e, 0) || !add_node(&j.s, slope, 0)) return 0;
  j.s.f = slot_of(&j.s, e);
  j.s.slope = slot_of(&j.s, slope);
  if (!pl_tower_run(t, search_body, &j)) return 0;
  *complete = j.complete;
  return j.n;
}
