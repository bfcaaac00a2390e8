// Symmetric systems of mechanics, [M G^T; G 0] and the like, by L D L^T without pivoting in an
// order found once.
//
// Coordinates whose mass couples to no other are eliminated first, all at once: what is left is G
// M^-1 G^T, the core. Its graph is cut into 8, 16 or 32 parts that touch only through a few
// separators (partition.c). All parts are eliminated side by side, one in each lane, over the union
// of their structures; the separators come last, as a system of their own. On a chain of rods that
// is a tridiagonal solve that runs in eight lanes; ladders, trees and nets have broader parts.
// Where that costs more than one lane in an order of least degree, that is taken. The pivots are
// judged by what is left of them after the subtractions; without pivoting that is right for masses
// above zero, and where it is not, the caller goes on with a general factorisation.
#include "linalg/symmetric_impl.h"

#include <math.h>

enum { MOST_NEIGHBOURS = 24, FEW = 64, MOST_SLOTS = 1000 };

typedef struct pl_symmetric_builder {
  pl_arena* a;
  pl_symmetric* s;
  const int *start, *row;
  const unsigned char* kind;
  int *core_of, *early_of;  // number among these, -1
  pl_graph graph;           // of the core
  int *part, *separator, n_separators, *order, *first;
  int *step, *lane;     // of a node of the core; a separator: number in its front, lane -1
  int* slot_separator;  // of slot b in lane l at b lanes + l                -1 none
} pl_symmetric_builder;

// ---------------------------------------------------------------------------------- early and core
static bool is_early(const pl_symmetric_builder* b, int i) {
  int n = b->start[i + 1] - b->start[i];
  if (b->kind[i] != PL_UNKNOWN_MASS || n > MOST_NEIGHBOURS + 1) return false;
  for (int e = b->start[i]; e < b->start[i + 1]; e++)
    if (b->row[e] != i && b->kind[b->row[e]] != PL_UNKNOWN_CONSTRAINT) return false;
  return true;
}

static int run_of(const int* index, int n) {
  for (int i = 1; i < n; i++)
    if (index[i] != index[0] + i) return -1;
  return n > 0 ? index[0] : -1;
}

static void divide(pl_symmetric_builder* b) {
  pl_symmetric* s = b->s;
  b->core_of = PL_ARRAY(b->a, int, s->n + 1);
  b->early_of = PL_ARRAY(b->a, int, s->n + 1);
  s->early = PL_ARRAY(b->a, int, s->n + 1);
  s->core = PL_ARRAY(b->a, int, s->n + 1);
  for (int i = 0; i < s->n; i++) {
    b->core_of[i] = b->early_of[i] = -1;
    if (is_early(b, i)) {
      b->early_of[i] = s->n_early;
      s->early[s->n_early++] = i;
    } else {
      b->core_of[i] = s->n_core;
      s->core[s->n_core++] = i;
    }
  }
  s->early_run = run_of(s->early, s->n_early);
  s->core_run = run_of(s->core, s->n_core);
}

// ------------------------------------------------------------------------------- graph of the core
// Calls what(user, i, j) for every pair of the core that is coupled, by the matrix or through an
// early one; often more than once.
typedef void pl_pair_use(void* user, int i, int j);

static void each_pair(const pl_symmetric_builder* b, pl_pair_use* what, void* user) {
  const pl_symmetric* s = b->s;
  for (int c = 0; c < s->n_core; c++)
    for (int e = b->start[s->core[c]]; e < b->start[s->core[c] + 1]; e++) {
      int other = b->core_of[b->row[e]];
      if (other > c) what(user, c, other);
    }
  for (int k = 0; k < s->n_early; k++) {
    int i = s->early[k];
    for (int e = b->start[i]; e < b->start[i + 1]; e++)
      for (int f = b->start[i]; f < e; f++)
        if (b->row[e] != i && b->row[f] != i)
          what(user, b->core_of[b->row[f]], b->core_of[b->row[e]]);
  }
}

typedef struct pl_edges {
  int *count, *to;
} pl_edges;
static void count_edge(void* user, int i, int j) {
  pl_edges* g = user;
  g->count[i]++;
  g->count[j]++;
}
static void add_edge(void* user, int i, int j) {
  pl_edges* g = user;
  g->to[g->count[i]++] = j;
  g->to[g->count[j]++] = i;
}

// false: too many edges.
static bool make_graph(pl_symmetric_builder* b) {
  int n = b->s->n_core;
  pl_edges g = {PL_ARRAY(b->a, int, n + 2), NULL};
  int* start = PL_ARRAY(b->a, int, n + 2);
  each_pair(b, count_edge, &g);
  long edges = 0;
  for (int i = 0; i < n; i++) {
    long before = edges;
    edges += g.count[i];
    if (edges > 64L * n + 1000000 || edges > INT32_MAX / 2) return false;
    g.count[i] = start[i] = (int)before;
  }
  g.to = PL_ARRAY(b->a, int, edges + 1);
  each_pair(b, add_edge, &g);
  // once each
  int kept = 0, *seen = PL_ARRAY(b->a, int, n + 1);
  for (int i = 0; i < n; i++) {
    int from = start[i];
    start[i] = kept;
    for (int e = from; e < g.count[i]; e++)
      if (seen[g.to[e]] != i + 1) {
        seen[g.to[e]] = i + 1;
        g.to[kept++] = g.to[e];
      }
  }
  start[n] = kept;
  b->graph = (pl_graph){n, start, g.to};
  return true;
}

// ------------------------------------------------------------------------------------------ places
// One lane: coordinates with mass, constraints, the rest, each kind in an order of least degree.
static bool order_in_one_lane(pl_symmetric_builder* b) {
  pl_symmetric* s = b->s;
  static const unsigned char kinds[] = {PL_UNKNOWN_MASS, PL_UNKNOWN_CONSTRAINT, PL_UNKNOWN_OTHER};
  int n = 0, *order = PL_ARRAY(b->a, int, s->n_core + 1);
  if (!pl_graph_least_degree(&b->graph, order)) return false;
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < s->n_core; i++)
      if (b->kind[s->core[order[i]]] == kinds[k]) {
        b->step[order[i]] = n++;
        b->lane[order[i]] = 0;
      }
  b->n_separators = 0;
  return true;
}

static int longest_part(const pl_symmetric_builder* b, int lanes) {
  int m = 0;
  for (int p = 0; p < lanes; p++)
    if (b->first[p + 1] - b->first[p] > m) m = b->first[p + 1] - b->first[p];
  return m;
}

static int order_in_lanes(pl_symmetric_builder* b, int lanes) {
  b->n_separators = pl_graph_cut(b->a, &b->graph, lanes, b->part, b->separator, b->order, b->first);
  int m = longest_part(b, lanes);
  for (int p = 0; p < lanes; p++)
    for (int i = b->first[p]; i < b->first[p + 1]; i++) {
      b->lane[b->order[i]] = p;
      b->step[b->order[i]] = m - (b->first[p + 1] - i);  // all end together
    }
  for (int j = 0; j < b->n_separators; j++) {
    b->lane[b->separator[j]] = -1;
    b->step[b->separator[j]] = j;
  }
  return m;
}

// The separators that a part touches get slots. What is filled in of a slot begins at the first
// step that touches it: lanes share slots that begin close to each other.
typedef struct pl_symmetric_touch {
  int separator, step;
} pl_symmetric_touch;
typedef PL_VEC(pl_symmetric_touch) pl_touches;

static void list_touches(pl_symmetric_builder* b, pl_touches* touch) {
  for (int i = 0; i < b->graph.n; i++) {
    if (b->lane[i] >= 0) continue;
    for (int e = b->graph.start[i]; e < b->graph.start[i + 1]; e++) {
      int node = b->graph.to[e], p = b->lane[node];
      if (p < 0) continue;
      pl_touches* t = &touch[p];
      if (t->n > 0 && t->at[t->n - 1].separator == b->step[i]) {
        if (b->step[node] < t->at[t->n - 1].step) t->at[t->n - 1].step = b->step[node];
      } else pl_push(b->a, *t, (pl_symmetric_touch){b->step[i], b->step[node]});
    }
  }
}

static void sort_touches(pl_touches* t) {
  for (int i = 1; i < t->n; i++) {
    pl_symmetric_touch x = t->at[i];
    int j = i;
    for (; j > 0 && t->at[j - 1].step > x.step; j--) t->at[j] = t->at[j - 1];
    t->at[j] = x;
  }
}

// Returns the number of slots; more than MOST_SLOTS are not given.
static int give_slots(pl_symmetric_builder* b, int lanes) {
  pl_touches* touch = PL_ARRAY(b->a, pl_touches, lanes + 1);
  int most = 0, widest = 0;
  if (b->n_separators > 0) list_touches(b, touch);
  for (int p = 0; p < lanes; p++)
    if (touch[p].n > most) {
      most = touch[p].n;
      widest = p;
    }
  if (most > MOST_SLOTS) return most;
  for (int p = 0; p < lanes; p++) sort_touches(&touch[p]);
  b->slot_separator = PL_ARRAY(b->a, int, most* lanes + 1);
  for (int i = 0; i < most * lanes; i++) b->slot_separator[i] = -1;
  for (int p = 0; p < lanes; p++)
    for (int i = 0; i < touch[p].n; i++) {
      int best = -1;
      // from the back, so that equal distances leave the early slots
      for (int s = most - 1; s >= 0; s--) {
        int far = touch[widest].at[s].step - touch[p].at[i].step,
            near = best < 0 ? 0 : touch[widest].at[best].step - touch[p].at[i].step;
        if (b->slot_separator[s * lanes + p] < 0
            && (best < 0 || (far < 0 ? -far : far) < (near < 0 ? -near : near)))
          best = s;
      }
      b->slot_separator[best * lanes + p] = touch[p].at[i].separator;
    }
  return most;
}

static int slot_of(const pl_symmetric_builder* b, const pl_symmetric_front* f, int lane,
                   int separator) {
  for (int s = 0; s < f->nb; s++)
    if (b->slot_separator[s * f->lanes + lane] == separator) return s;
  return -1;
}

// --------------------------------------------------------------------------------------- structure
typedef struct pl_symmetric_structure {
  pl_symmetric_builder* b;
  pl_symmetric_front* f;
  pl_int_list *main, *border;
} pl_symmetric_structure;

static void add_pair(void* user, int i, int j) {
  pl_symmetric_structure* t = user;
  pl_symmetric_builder* b = t->b;
  if (b->lane[i] < 0) {
    int x = i;
    i = j;
    j = x;
  }
  int si = b->step[i], sj = b->step[j];
  if (b->lane[i] < 0) pl_push(b->a, t->border[si < sj ? si : sj].v, si < sj ? sj : si);
  else if (b->lane[j] < 0) pl_push(b->a, t->main[si].v, t->f->m + slot_of(b, t->f, b->lane[i], sj));
  else pl_push(b->a, t->main[si < sj ? si : sj].v, si < sj ? sj : si);
}

// Each part couples all the separators that it touches.
static void couple_separators(pl_symmetric_structure* t) {
  const pl_symmetric_builder* b = t->b;
  for (int p = 0; p < t->f->lanes; p++)
    for (int s = 0; s < t->f->nb; s++)
      for (int r = 0; r < s; r++) {
        int i = b->slot_separator[s * t->f->lanes + p], j = b->slot_separator[r * t->f->lanes + p];
        if (i >= 0 && j >= 0) pl_push(b->a, t->border[i < j ? i : j].v, i < j ? j : i);
      }
}

static bool structure(pl_symmetric_builder* b, int lanes, pl_symmetric_front* f,
                      pl_symmetric_front* border) {
  int m = b->s->n_core;
  if (lanes > 1) m = order_in_lanes(b, lanes);
  else if (!order_in_one_lane(b)) return false;
  *f = (pl_symmetric_front){.lanes = lanes, .m = m, .nb = give_slots(b, lanes)};
  if (f->nb > MOST_SLOTS) return false;
  pl_symmetric_structure t = {b, f, PL_ARRAY(b->a, pl_int_list, m + 1),
                              PL_ARRAY(b->a, pl_int_list, b->n_separators + 1)};
  each_pair(b, add_pair, &t);
  couple_separators(&t);
  return pl_symmetric_front_make(b->a, f, lanes, m, f->nb, t.main)
         && pl_symmetric_front_make(b->a, border, 1, b->n_separators, 0, t.border);
}

// Cycles of a solve, about: entries are read twice; each step waits for the one before.
static double price(const pl_symmetric_front* f) {
  double vectors = f->lanes / 8.0;
  return f->lanes == 1 ? 5.0 * f->n + 20.0 * f->m
                       : 3.0 * vectors * f->n + (12 + 6 * vectors) * f->m;
}

// Above so many cycles for an unknown too much fills in, as where one coordinate stands in hundreds
// of constraints: a factorisation that eliminates the constraints first is cheaper.
static const double too_dear = 40;

static bool choose(pl_symmetric_builder* b) {
  pl_symmetric* s = b->s;
  pl_symmetric_front f, g;
  bool only_constraints = true;
  for (int i = 0; i < s->n_core; i++)
    only_constraints &= b->kind[s->core[i]] == PL_UNKNOWN_CONSTRAINT;
  int lanes = s->n_core < FEW || !only_constraints ? 1
              : s->n_core < 400                    ? 8
              : s->n_core < 2000                   ? 16
                                                   : 32;
  double most = too_dear * s->n,
         cost = structure(b, lanes, &f, &g) ? price(&f) + price(&g) : (double)INFINITY;
  s->main = f;
  s->border = g;
  // a part as simple as a chain's needs no comparison
  if (lanes == 1 || cost < 3.5 * s->n_core + 400) return cost < most;
  if (structure(b, 1, &f, &g) && price(&f) < cost) {
    s->main = f;
    s->border = g;
    return price(&f) < most;
  }
  return cost < most && structure(b, lanes, &s->main, &s->border);
}

// ------------------------------------------------------------------------------------------ memory
static size_t units(const pl_symmetric_front* f) {
  return (size_t)f->m + (size_t)f->n + (size_t)f->nb * ((size_t)f->nb + 1) / 2;
}

static bool reserve(pl_symmetric_builder* b) {
  pl_symmetric* s = b->s;
  pl_symmetric_front *f = &s->main, *g = &s->border;
  size_t lanes = (size_t)f->lanes, of_main = units(f) * lanes;
  s->n_memory = of_main + units(g);
  if (s->n_memory > INT32_MAX) return false;
  s->memory = PL_ARRAY(b->a, double, s->n_memory + 1);
  s->solution = PL_ARRAY(b->a, double, ((size_t)f->m + (size_t)f->nb) * lanes + (size_t)g->m + 1);
  f->w = s->memory;
  g->w = s->memory + of_main;
  f->y = s->solution;
  g->y = s->solution + ((size_t)f->m + (size_t)f->nb) * lanes;
  f->inverse = PL_ARRAY(b->a, double, (size_t)f->m* lanes + 1);
  f->d = PL_ARRAY(b->a, double, (size_t)f->m* lanes + 1);
  g->inverse = PL_ARRAY(b->a, double, (size_t)g->m + 1);
  g->d = PL_ARRAY(b->a, double, (size_t)g->m + 1);
  size_t early = (size_t)s->n_early + 16, core = (size_t)s->n_core + 16;
  s->early_inverse = PL_ARRAY(b->a, double, early);
  s->early_from = PL_ARRAY(b->a, int, early);
  s->z = PL_ARRAY(b->a, double, early);
  s->x = PL_ARRAY(b->a, double, core);
  s->of_core = PL_ARRAY(b->a, int, core);
  return true;
}

// The number in memory for two unknowns of the core.
static int target(const pl_symmetric_builder* b, int i, int j) {
  const pl_symmetric* s = b->s;
  const pl_symmetric_front *f = &s->main, *g = &s->border;
  if (b->lane[i] < 0) {
    int x = i;
    i = j;
    j = x;
  }
  if (b->lane[i] < 0)
    return (int)(g->w - s->memory) + pl_symmetric_front_find(g, b->step[i], b->step[j]);
  int row = b->lane[j] < 0 ? f->m + slot_of(b, f, b->lane[i], b->step[j]) : b->step[j];
  return pl_symmetric_front_find(f, b->step[i], row) * f->lanes + b->lane[i];
}

static void place_core(pl_symmetric_builder* b) {
  pl_symmetric* s = b->s;
  const pl_symmetric_front *f = &s->main, *g = &s->border;
  int lanes = f->lanes;
  for (int i = 0; i < s->n_core; i++)
    s->of_core[i] = b->lane[i] < 0 ? (int)(g->y - s->solution) + b->step[i]
                                   : b->step[i] * lanes + b->lane[i];
  bool* used = PL_ARRAY(b->a, bool, f->m* lanes + 1);
  for (int i = 0; i < s->n_core; i++)
    if (b->lane[i] >= 0) used[s->of_core[i]] = true;
  s->ones = PL_ARRAY(b->a, int, f->m* lanes + 1);
  for (int i = 0; i < f->m * lanes; i++)
    if (!used[i]) s->ones[s->n_ones++] = i;
  s->slot_border = b->slot_separator;
  s->n_products = f->nb * (f->nb + 1) / 2 * lanes;
  s->to_border = PL_ARRAY(b->a, int, s->n_products + 1);
  for (int r = 0, n = 0; r < f->nb; r++)
    for (int c = 0; c <= r; c++)
      for (int l = 0; l < lanes; l++, n++) {
        int i = b->slot_separator[r * lanes + l], j = b->slot_separator[c * lanes + l];
        s->to_border[n] = i < 0 || j < 0 ? -1 : pl_symmetric_front_find(g, i, j);
      }
}

static void place_direct(pl_symmetric_builder* b) {
  pl_symmetric* s = b->s;
  int most = 0;
  for (int c = 0; c < s->n_core; c++) most += b->start[s->core[c] + 1] - b->start[s->core[c]];
  s->direct_from = PL_ARRAY(b->a, int, most + 1);
  s->direct_to = PL_ARRAY(b->a, int, most + 1);
  for (int c = 0; c < s->n_core; c++)
    for (int e = b->start[s->core[c]]; e < b->start[s->core[c] + 1]; e++) {
      int other = b->core_of[b->row[e]];
      if (other < c) continue;
      s->direct_from[s->n_direct] = e;
      s->direct_to[s->n_direct++] = target(b, c, other);
    }
}

static void place_early(pl_symmetric_builder* b) {
  pl_symmetric* s = b->s;
  PL_VEC(int) from = {0}, to = {0};
  s->schur_start = PL_ARRAY(b->a, int, s->n_early + 2);
  for (int k = 0; k < s->n_early; k++) {
    int i = s->early[k];
    for (int e = b->start[i]; e < b->start[i + 1]; e++) {
      if (b->row[e] == i) {
        s->early_from[k] = e;
        continue;
      }
      pl_push(b->a, from, e);
      int last = b->core_of[b->row[e]];
      for (int f = s->schur_start[k]; f < from.n; f++)
        pl_push(b->a, to, target(b, b->core_of[b->row[from.at[f]]], last));
    }
    s->schur_start[k + 1] = from.n;
  }
  s->schur_from = from.at;
  s->schur_to = to.at;
}

// ---------------------------------------------------------------------------------- rows in groups
typedef struct pl_row_entry {
  int lane, index, from;
  bool placed;
} pl_row_entry;
typedef struct pl_row_maker {
  pl_arena* a;
  PL_VEC(int) base, index, from;
  PL_VEC(pl_row_entry) group;
} pl_row_maker;

static int new_entry(pl_row_maker* k, int base) {
  pl_push(k->a, k->base, base);
  for (int l = 0; l < 8; l++) {
    pl_push(k->a, k->index, 0);
    pl_push(k->a, k->from, -1);
  }
  return 8 * (k->base.n - 1);
}

// Entries whose indices grow with the lane are read at once where there are enough of them, the
// others one by one.
static void close_group(pl_row_maker* k) {
  enum { ENOUGH = 3 };
  for (int i = 0; i < k->group.n; i++) {
    int key = k->group.at[i].index - k->group.at[i].lane, count = 0;
    if (k->group.at[i].placed || key < 0) continue;
    for (int j = i; j < k->group.n; j++)
      count += !k->group.at[j].placed && k->group.at[j].index - k->group.at[j].lane == key;
    if (count < ENOUGH) continue;
    int at = new_entry(k, key);
    for (int j = i; j < k->group.n; j++) {
      pl_row_entry* e = &k->group.at[j];
      if (e->placed || e->index - e->lane != key || k->from.at[at + e->lane] >= 0) continue;
      k->from.at[at + e->lane] = e->from;
      e->placed = true;
    }
  }
  int room[8];  // of each lane: the next entry of single ones
  int first = k->base.n;
  for (int l = 0; l < 8; l++) room[l] = first;
  for (int i = 0; i < k->group.n; i++) {
    const pl_row_entry* e = &k->group.at[i];
    if (e->placed) continue;
    if (room[e->lane] == k->base.n) new_entry(k, -1);
    k->index.at[8 * room[e->lane] + e->lane] = e->index;
    k->from.at[8 * room[e->lane]++ + e->lane] = e->from;
  }
  k->group.n = 0;
}

static void make_rows(pl_symmetric_builder* b, pl_symmetric_rows* r, const int* rows, int n,
                      const int* other_of) {
  pl_row_maker k = {.a = b->a};
  r->n_groups = (n + 7) / 8;
  r->first = PL_ARRAY(b->a, int, r->n_groups + 1);
  for (int g = 0; g < r->n_groups; g++) {
    for (int l = 0; l < 8 && 8 * g + l < n; l++)
      for (int e = b->start[rows[8 * g + l]]; e < b->start[rows[8 * g + l] + 1]; e++)
        if (other_of[b->row[e]] >= 0)
          pl_push(b->a, k.group, (pl_row_entry){l, other_of[b->row[e]], e, false});
    close_group(&k);
    r->first[g + 1] = k.base.n;
  }
  r->base = k.base.at;
  r->index = k.index.at;
  r->from = k.from.at;
  r->value = PL_ARRAY(b->a, double, 8 * (size_t)k.base.n + 1);
}

// ------------------------------------------------------------------------------------------ making
static bool is_symmetric(int n, const int* start, const int* row) {
  for (int j = 0; j < n; j++)
    for (int e = start[j]; e < start[j + 1]; e++) {
      int lo = start[row[e]], hi = start[row[e] + 1];
      while (lo < hi) {
        int mid = (lo + hi) / 2;
        if (row[mid] < j) lo = mid + 1;
        else hi = mid;
      }
      if (lo == start[row[e] + 1] || row[lo] != j) return false;
    }
  return true;
}

pl_symmetric* pl_symmetric_make(pl_arena* a, int n, const int* start, const int* row,
                                const unsigned char* kind) {
  if (!is_symmetric(n, start, row)) return NULL;
  pl_symmetric* s = PL_NEW(a, pl_symmetric);
  pl_symmetric_builder b = {.a = a, .s = s, .start = start, .row = row, .kind = kind};
  s->n = n;
  divide(&b);
  if (!make_graph(&b)) return NULL;
  int** of_nodes[] = {&b.part, &b.separator, &b.order, &b.step, &b.lane};
  for (size_t i = 0; i < sizeof of_nodes / sizeof *of_nodes; i++)
    *of_nodes[i] = PL_ARRAY(a, int, s->n_core + 1);
  b.first = PL_ARRAY(a, int, PL_SYMMETRIC_LANES + 1);
  if (!choose(&b) || !reserve(&b)) return NULL;
  place_core(&b);
  place_direct(&b);
  place_early(&b);
  make_rows(&b, &s->by_core, s->core, s->n_core, b.early_of);
  make_rows(&b, &s->by_early, s->early, s->n_early, b.core_of);
  return s;
}

// ----------------------------------------------------------------------------------------- numbers
static const pl_symmetric_kernels* kernels(void) {
#ifdef PL_KERNELS_BY_PROCESSOR
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl")
      && __builtin_cpu_supports("avx512dq"))
    return &pl_symmetric_avx512;
  if (__builtin_cpu_supports("fma") && __builtin_cpu_supports("avx2")) return &pl_symmetric_avx2;
#endif
  return &pl_symmetric_plain;
}

double pl_symmetric_factor(pl_symmetric* s, const double* value) {
  return kernels()->factor(s, value);
}
void pl_symmetric_solve(pl_symmetric* s, double* b) { kernels()->solve(s, b); }
