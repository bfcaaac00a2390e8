// The step program of the series: one order after the other.
//
// Products of series are summed eight at a time. Each operand of a sum lies in a stream, a row of
// eight numbers for each order; a coefficient is written to all the streams that hold it as soon as
// it is known. The products of the equations themselves (M a, G^T λ, G v) are put so that all
// products of one row share a lane and are added there.
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "solve/stepper/taylor/step_program_make_impl.h"

// ----------------------------------------------------------------------------------------- streams
// The last two are no series: row k holds 1/k, and what its rounding left, where index is 1, else 1
// and 0.
typedef enum pl_lane_kind {
  EMPTY,
  NODE,
  WEIGHTED_NODE,
  MINUS_A,
  LAMBDA,
  V,
  SCALE,
  REST
} pl_lane_kind;
typedef struct pl_lane {
  pl_lane_kind kind;
  int index;
} pl_lane;
typedef struct pl_stream {
  pl_lane lane[8];
  int at;
} pl_stream;
typedef struct pl_streams {
  PL_VEC(pl_stream) list;
} pl_streams;

static void write_to(pl_maker* k, pl_lane lane, int place) {
  switch (lane.kind) {
    case EMPTY: break;
    case NODE: pl_push(k->a, k->plain[lane.index], place); break;
    case WEIGHTED_NODE: pl_push(k->a, k->weighted[lane.index], place); break;
    case MINUS_A: pl_push(k->a, k->from_a[lane.index], place); break;
    case LAMBDA: pl_push(k->a, k->from_lambda[lane.index], place); break;
    case V: pl_push(k->a, k->from_v[lane.index], place); break;
    case SCALE:
    case REST:
      pl_push(k->a, k->scales, (pl_scale_lane){place, lane.index != 0, lane.kind == REST});
      break;
  }
}

// The place of a stream with these lanes; one that is there already serves too.
static int stream_of(pl_maker* k, pl_streams* streams, const pl_lane* lanes) {
  for (int i = 0; i < streams->list.n; i++) {
    bool same = true;
    for (int l = 0; l < 8; l++)
      same &= streams->list.at[i].lane[l].kind == lanes[l].kind
              && streams->list.at[i].lane[l].index == lanes[l].index;
    if (same) return streams->list.at[i].at;
  }
  pl_stream s = {.at = pl_maker_take(k, 8 * (k->o->orders + 1))};
  memcpy(s.lane, lanes, sizeof s.lane);
  for (int l = 0; l < 8; l++) write_to(k, lanes[l], s.at + l);
  pl_push(k->a, streams->list, s);
  return s.at;
}

// ------------------------------------------------------------------------------------------ groups
// A group of eight sums: pairs of streams, where the sums go.
// scale, rest: streams, -1 none
typedef struct pl_step_group {
  int to, first, n, scale, rest, lanes;
} pl_step_group;
typedef struct pl_groups {
  PL_VEC(pl_step_group) list;
  PL_VEC(pl_prog_pair) pairs;
} pl_groups;

struct pl_maker_groups {
  pl_groups place, speed;
};

static bool is_constant(const pl_maker* k, int instance, int node) {
  return node < k->instance[instance].tape->level_end[PL_LEVEL_CONST];
}

typedef PL_VEC(pl_maker_sum) pl_sum_list;

static void list_sums(pl_maker* k, pl_tape_level level, pl_sum_list* out) {
  for (int i = 0; i < k->n_nodes; i++) {
    const pl_maker_instance* in = &k->instance[k->owner[i]];
    pl_recurrence_sum s[3];
    if (!k->high[i] || pl_maker_node(k, i)->level != level) continue;
    int n = pl_recurrence_sums(in->tape, i - in->base, s);
    for (int j = 0; j < n; j++)
      if (!is_constant(k, k->owner[i], s[j].a) && !is_constant(k, k->owner[i], s[j].b))
        pl_push(k->a, *out,
                (pl_maker_sum){i,
                               j,
                               -1,
                               {pl_maker_same(k, k->owner[i], s[j].a),
                                pl_maker_same(k, k->owner[i], s[j].b), s[j].weighted}});
  }
}

// Another sum that reads the same series A; -1 none.
static int same_reader(const pl_sum_list* sums, const bool* done, int first) {
  const pl_recurrence_sum* x = &sums->at[first].reads;
  for (int i = first + 1; i < sums->n; i++)
    if (!done[i] && sums->at[i].reads.a == x->a && sums->at[i].reads.weighted == x->weighted)
      return i;
  return -1;
}

// Eight pairs of sums, each pair reading the same series A; fewer: none are left.
static int find_doubles(pl_maker* k, const pl_sum_list* sums, const bool* done, int pair[2][8]) {
  bool* seen = PL_ARRAY(k->a, bool, sums->n + 1);
  int n = 0;
  memcpy(seen, done, (size_t)sums->n * sizeof *seen);
  for (int i = 0; i < sums->n && n < 8; i++) {
    int other = seen[i] ? -1 : same_reader(sums, seen, i);
    if (other < 0) continue;
    pair[0][n] = i;
    pair[1][n++] = other;
    seen[i] = seen[other] = true;
  }
  return n;
}

// Sums that read the same series stand in the same lanes of two groups, which then share a stream,
// as far as these are full; then come the other weighted ones and the rest.
static pl_sum_list in_order(pl_maker* k, const pl_sum_list* sums) {
  pl_sum_list out = {0};
  bool* done = PL_ARRAY(k->a, bool, sums->n + 1);
  int pair[2][8];
  while (find_doubles(k, sums, done, pair) == 8)
    for (int i = 0; i < 16; i++) {
      pl_push(k->a, out, sums->at[pair[i / 8][i % 8]]);
      done[pair[i / 8][i % 8]] = true;
    }
  for (int weighted = 1; weighted >= 0; weighted--)
    for (int i = 0; i < sums->n; i++)
      if (!done[i] && sums->at[i].reads.weighted == weighted) pl_push(k->a, out, sums->at[i]);
  return out;
}

// What the sums of a group are multiplied with: weighted ones with 1/k.
static void scale_group(pl_maker* k, pl_streams* streams, const pl_maker_sum* sums, int n,
                        pl_step_group* g) {
  pl_lane scale[8], rest[8];
  bool any = false;
  for (int l = 0; l < 8; l++) {
    int weighted = l < n && sums[l].reads.weighted;
    any |= weighted;
    scale[l] = (pl_lane){SCALE, weighted};
    rest[l] = (pl_lane){REST, weighted};
  }
  if (!any) return;
  g->scale = stream_of(k, streams, scale);
  g->rest = stream_of(k, streams, rest);
}

static void group_sums(pl_maker* k, pl_streams* streams, const pl_sum_list* unordered,
                       pl_groups* groups) {
  pl_sum_list ordered = in_order(k, unordered), *sums = &ordered;
  for (int first = 0; first < sums->n; first += 8) {
    pl_lane a[8] = {{EMPTY, 0}}, b[8] = {{EMPTY, 0}};
    int to = pl_maker_take(k, 8);
    for (int l = 0; l < 8 && first + l < sums->n; l++) {
      const pl_maker_sum* s = &sums->at[first + l];
      a[l] = (pl_lane){s->reads.weighted ? WEIGHTED_NODE : NODE, s->reads.a};
      b[l] = (pl_lane){NODE, s->reads.b};
      k->sum_cell[s->node].i[s->i] = to + l;
    }
    int at_a = stream_of(k, streams, a), at_b = stream_of(k, streams, b);
    pl_step_group g = {to, groups->pairs.n, 1, -1, -1, sums->n - first < 8 ? sums->n - first : 8};
    scale_group(k, streams, sums->at + first, sums->n - first < 8 ? sums->n - first : 8, &g);
    pl_push(k->a, groups->list, g);
    pl_push(k->a, groups->pairs, (pl_prog_pair){at_a, at_b});
  }
}

// --------------------------------------------------------------------------- rows of the equations
typedef struct pl_lanes {
  pl_lane a, b;
} pl_lanes;
typedef PL_VEC(pl_lanes) pl_row_list;

static bool varies(const pl_maker* k, int node) {
  return !is_constant(k, k->owner[node], node - k->instance[k->owner[node]].base);
}

static void add_product(pl_maker* k, pl_row_list* rows, int u, int node, pl_lane_kind kind,
                        int index) {
  if (u >= 0) pl_push(k->a, rows[u], (pl_lanes){{NODE, node}, {kind, index}});
}

static void list_rows(pl_maker* k, pl_row_list* rows) {
  const pl_step_program* o = k->o;
  for (int e = 0; e < k->M.n; e++) {
    const pl_step_term* t = &k->M.at[e];
    if (!varies(k, t->node)) continue;
    add_product(k, rows, o->of_coordinate[t->row], t->node, MINUS_A, t->col);
    if (t->row != t->col) add_product(k, rows, o->of_coordinate[t->col], t->node, MINUS_A, t->row);
  }
  for (int e = 0; e < k->G.n; e++) {
    const pl_step_term* t = &k->G.at[e];
    if (!varies(k, t->node) || o->of_constraint[t->row] < 0) continue;
    add_product(k, rows, o->of_coordinate[t->col], t->node, LAMBDA, t->row);
    add_product(k, rows, o->of_constraint[t->row], t->node, V, t->col);
  }
}

// Products first .. of a row, which share a lane: at most `most` of them.
typedef struct pl_share {
  int unknown, first, n;
} pl_share;
typedef PL_VEC(pl_share) pl_shares;

static int compare_shares(const void* x, const void* y) {
  const pl_share *a = x, *b = y;
  if (a->n != b->n) return b->n - a->n;
  return a->unknown != b->unknown ? a->unknown - b->unknown : a->first - b->first;
}

// All rows in shares of nearly the same size, longest first.
static pl_shares share_rows(pl_maker* k, const pl_row_list* rows, int most) {
  pl_shares out = {0};
  for (int u = 0; u < k->o->n; u++) {
    int lanes = (rows[u].n + most - 1) / most;
    for (int i = 0; i < lanes; i++) {
      int first = rows[u].n * i / lanes, end = rows[u].n * (i + 1) / lanes;
      pl_push(k->a, out, (pl_share){u, first, end - first});
    }
  }
  if (out.n > 0) qsort(out.at, (size_t)out.n, sizeof *out.at, compare_shares);
  return out;
}

// Pairs of streams that shares take: each group of eight as many as its longest has products.
static int pairs_of(const pl_shares* s) {
  int n = 0;
  for (int i = 0; i < s->n; i += 8) n += s->at[i].n;
  return n;
}

// The division into shares that takes the fewest pairs.
static pl_shares best_shares(pl_maker* k, const pl_row_list* rows) {
  enum { LONGEST = 16 };
  pl_shares best = share_rows(k, rows, INT_MAX / 2);
  for (int most = LONGEST; most >= 1; most--) {
    pl_shares s = share_rows(k, rows, most);
    if (pairs_of(&s) < pairs_of(&best)) best = s;
  }
  return best;
}

static void group_rows(pl_maker* k, pl_streams* streams, const pl_row_list* rows,
                       pl_groups* groups) {
  pl_shares shares = best_shares(k, rows);
  for (int first = 0; first < shares.n; first += 8) {
    const pl_share* s = shares.at + first;
    int used = shares.n - first < 8 ? shares.n - first : 8, to = pl_maker_take(k, 8);
    for (int l = 0; l < used; l++) pl_push(k->a, k->row_sums[s[l].unknown], to + l);
    pl_push(k->a, groups->list, (pl_step_group){to, groups->pairs.n, s->n, -1, -1, used});
    for (int p = 0; p < s->n; p++) {
      pl_lane a[8] = {{EMPTY, 0}}, b[8] = {{EMPTY, 0}};
      for (int l = 0; l < used; l++) {
        const pl_lanes* product = &rows[s[l].unknown].at[s[l].first + p];
        if (p < s[l].n) {
          a[l] = product->a;
          b[l] = product->b;
        }
      }
      int at_a = stream_of(k, streams, a), at_b = stream_of(k, streams, b);
      pl_push(k->a, groups->pairs, (pl_prog_pair){at_a, at_b});
    }
  }
}

// ------------------------------------------------------------------------------------ what is kept
static void keep(pl_maker* k, int instance, int node) {
  if (node < 0 || is_constant(k, instance, node)) return;
  int global = pl_maker_same(k, instance, node);
  if (pl_maker_node(k, global)->level == PL_LEVEL_POSITION && k->keep[global] < 0)
    k->keep[global] = k->n_keep++;
}

static void list_kept(pl_maker* k) {
  for (int i = 0; i < k->n_nodes; i++) {
    const pl_tape_node* n = pl_maker_node(k, i);
    if (!k->high[i] || n->level != PL_LEVEL_VELOCITY) continue;
    keep(k, k->owner[i], n->a);
    keep(k, k->owner[i], n->b);
    if (n->op == PL_OP_IF) keep(k, k->owner[i], n->c);
  }
  for (int e = 0; e < k->h.n; e++) {
    int node = k->h.at[e].node;
    keep(k, k->owner[node], node - k->instance[k->owner[node]].base);
  }
  k->keep_at = pl_maker_take(k, (k->n_keep + 1) * (k->o->orders + 1));
}

void pl_maker_streams(pl_maker* k) {
  pl_step_program* o = k->o;
  pl_streams streams = {0};
  pl_sum_list place = {0}, speed = {0};
  k->from_a = PL_ARRAY(k->a, pl_stream_places, o->n_q + 1);
  k->from_v = PL_ARRAY(k->a, pl_stream_places, o->n_q + 1);
  k->from_lambda = PL_ARRAY(k->a, pl_stream_places, o->n_c + 1);
  k->row_sums = PL_ARRAY(k->a, pl_stream_places, o->n + 1);
  k->groups = PL_NEW(k->a, pl_maker_groups);
  pl_row_list* rows = PL_ARRAY(k->a, pl_row_list, o->n + 1);
  list_sums(k, PL_LEVEL_POSITION, &place);
  list_sums(k, PL_LEVEL_VELOCITY, &speed);
  list_rows(k, rows);
  group_sums(k, &streams, &place, &k->groups->place);
  group_rows(k, &streams, rows, &k->groups->place);
  group_sums(k, &streams, &speed, &k->groups->speed);
  list_kept(k);
}

static void add_block(pl_maker* k, const pl_groups* groups, int shift) {
  if (groups->list.n == 0 || !k->with_sums) return;
  pl_prog_block_begin(k->code, 8, shift);
  for (int i = 0; i < groups->list.n; i++) {
    const pl_step_group* g = &groups->list.at[i];
    pl_prog_sum_begin(k->code, g->to, false);
    pl_prog_sum_scale(k->code, g->scale, g->rest);
    pl_prog_sum_lanes(k->code, g->lanes);
    for (int p = g->first; p < g->first + g->n; p++)
      pl_prog_sum_pair(k->code, groups->pairs.at[p].a, groups->pairs.at[p].b);
  }
}

// ---------------------------------------------------------------------------------------- an order
// x / (k + 1)
static int over_next(pl_maker* k, int x) {
  int main = pl_prog_op2(k->code, PL_PROG_MUL, x, pl_prog_load(k->code, k->o->ratio + 1, 1));
  return pl_prog_op3(k->code, PL_PROG_FMA, x, pl_prog_load(k->code, k->o->rest + 1, 1), main);
}

static void write(pl_maker* k, int x, const pl_stream_places* to, int row) {
  for (int i = 0; i < to->n; i++) pl_prog_store(k->code, x, to->at[i] + 8 * row, 8);
}

// A coefficient is known: into its streams and, for nodes of q and t, the row that is kept. row 1:
// order k + 1.
static void publish(pl_maker* k, int node, int x, int row) {
  if (x < 0) return;
  write(k, x, &k->plain[node], row);
  if (k->weighted[node].n > 0)
    write(k, pl_prog_op2(k->code, PL_PROG_MUL, pl_prog_order(k->code, row), x), &k->weighted[node],
          row);
  if (row == 1 && k->keep[node] >= 0)
    pl_prog_store(k->code, x, k->keep_at + k->n_keep + k->keep[node], k->n_keep);
}

static int coefficient(pl_maker* k, int node) {
  k->instance_now = k->owner[node];
  k->lower.tape = k->instance[k->instance_now].tape;
  return pl_recurrence_coefficient(&k->lower, node - k->instance[k->instance_now].base);
}

static int global_coordinate(const pl_maker* k, int node) {
  const pl_batch* b = k->instance[k->owner[node]].batch;
  return b->q[pl_maker_node(k, node)->slot * b->lanes + k->instance[k->owner[node]].lane];
}

static void next_positions(pl_maker* k, int* q) {
  pl_step_program* o = k->o;
  for (int i = 0; i < o->n_q; i++) {
    q[i] = over_next(k, pl_prog_load(k->code, o->V + i, o->n_q));
    pl_prog_store(k->code, q[i], o->Q + o->n_q + i, o->n_q);
  }
}

static void position_nodes(pl_maker* k) {
  int* q = PL_ARRAY(k->a, int, k->o->n_q + 1);
  next_positions(k, q);
  add_block(k, &k->groups->place, 1);
  for (int i = 0; i < k->n_nodes; i++) {
    const pl_tape_node* n = pl_maker_node(k, i);
    if (!k->high[i] || n->level != PL_LEVEL_POSITION) continue;
    if (n->op == PL_OP_TIME) k->position_now[i] = pl_prog_load(k->code, k->o->time + 1, 1);
    else if (n->op == PL_OP_Q) k->position_now[i] = q[global_coordinate(k, i)];
    else k->position_now[i] = coefficient(k, i);
    publish(k, i, k->position_now[i], 1);
  }
}

static void velocity_nodes(pl_maker* k) {
  k->velocity_phase = true;
  add_block(k, &k->groups->speed, 0);
  for (int i = 0; i < k->n_nodes; i++) {
    const pl_tape_node* n = pl_maker_node(k, i);
    if (!k->high[i] || n->level != PL_LEVEL_VELOCITY) continue;
    if (n->op == PL_OP_V)
      k->now[i] = pl_prog_load(k->code, k->o->V + global_coordinate(k, i), k->o->n_q);
    else k->now[i] = coefficient(k, i);
    publish(k, i, k->now[i], 0);
  }
}

// ----------------------------------------------------------------------------------- the equations
static int plus(pl_maker* k, int a, int b) {
  return a < 0 ? b : b < 0 ? a : pl_prog_op2(k->code, PL_PROG_ADD, a, b);
}

static int sum_at(pl_maker* k, int u) {
  int s = -1;
  for (int i = 0; k->with_sums && i < k->row_sums[u].n; i++)
    s = plus(k, s, pl_prog_load(k->code, k->row_sums[u].at[i], 0));
  return s;
}

static int force(pl_maker* k, int i, bool first) {
  int h = -1;
  for (int e = 0; e < k->h.n; e++) {
    int node = k->h.at[e].node;
    if (k->h.at[e].row != i) continue;
    k->instance_now = k->owner[node];
    k->lower.tape = k->instance[k->instance_now].tape;
    h = plus(k, h,
             first ? pl_maker_start(k, node)
                   : k->lower.now(k, node - k->instance[k->instance_now].base));
  }
  if (first) pl_prog_store(k->code, h < 0 ? pl_prog_number(k->code, 0) : h, k->o->h + i, 0);
  return h;
}

// The unknowns of order k are v_{k+1} = a_k / (k + 1) and λ_k / (k + 1), so that the rows of
// constraints, which are waited for, need no factor. Without constraints they are a_k.
static bool in_velocities(const pl_maker* k, bool first) { return !first && k->o->n_taken > 0; }

static int right_of_coordinate(pl_maker* k, int u, bool first) {
  int s = sum_at(k, u), h = force(k, k->o->index[u], first);
  if (h >= 0)
    s = s < 0 ? pl_prog_op1(k->code, PL_PROG_NEG, h) : pl_prog_op2(k->code, PL_PROG_SUB, s, h);
  return s >= 0 && in_velocities(k, first) ? over_next(k, s) : s;
}

// Order k + 1 of G v + dg/dt without the unknowns, over k + 1. The newest coefficients of G come in
// two chains, which are waited for least.
static int left_of_constraint(pl_maker* k, int u) {
  int c = k->o->index[u], s[2] = {sum_at(k, u), -1}, n = 0;
  for (int e = 0; e < k->gt.n; e++)
    if (k->gt.at[e].row == c) s[0] = plus(k, s[0], k->position_now[k->gt.at[e].node]);
  for (int e = 0; e < k->G.n; e++) {
    int x = k->position_now[k->G.at[e].node], *to = &s[n % 2];
    if (k->G.at[e].row != c || x < 0) continue;
    int v = pl_prog_load(k->code, k->o->V + k->G.at[e].col, 0);
    *to = *to < 0 ? pl_prog_op2(k->code, PL_PROG_MUL, x, v)
                  : pl_prog_op3(k->code, PL_PROG_FMA, x, v, *to);
    n++;
  }
  return plus(k, s[0], s[1]);
}

// Unknowns from right sides, of constraints left sides; of these come λ_k / (k + 1).
static void solve(pl_maker* k, int* x, bool first) {
  pl_step_program* o = k->o;
  int n = o->n, n_coordinates = n - o->n_taken;
  if (first || n > o->inverse_up_to) {
    for (int u = n_coordinates; u < n; u++)
      x[u] = x[u] < 0 ? -1 : pl_prog_op1(k->code, PL_PROG_NEG, x[u]);
    pl_step_elimination_solve(k->elimination, k->code, x);
    for (int u = n_coordinates; u < n; u++)
      x[u] = x[u] < 0 ? -1 : pl_prog_op1(k->code, PL_PROG_NEG, x[u]);
    return;
  }
  for (int u = 0; u < n; u++)
    pl_prog_store(k->code, x[u] < 0 ? pl_prog_number(k->code, 0) : x[u], o->vector + u, 0);
  pl_prog_product_add(k->code, o->result, o->matrix, o->vector, n, o->n_taken, (n + 7) / 8);
  for (int u = 0; u < n; u++) x[u] = pl_prog_load(k->code, o->result + u, 0);
}

static int times_next(pl_maker* k, int x, bool first) {
  return in_velocities(k, first) ? pl_prog_op2(k->code, PL_PROG_MUL, pl_prog_order(k->code, 1), x)
                                 : x;
}

static void take_solution(pl_maker* k, const int* x, bool first) {
  pl_step_program* o = k->o;
  pl_prog* code = k->code;
  for (int i = 0; i < o->n_q; i++) {
    int u = o->of_coordinate[i];
    if (u < 0 || x[u] < 0) continue;
    int v = in_velocities(k, first) || first ? x[u] : over_next(k, x[u]);
    pl_prog_store(code, v, o->V + o->n_q + i, o->n_q);
    write(k, v, &k->from_v[i], 1);
  }
  for (int c = 0; c < o->n_c; c++) {
    int u = o->of_constraint[c];
    if (u < 0 || x[u] < 0) continue;
    int lambda = times_next(k, x[u], first);
    write(k, lambda, &k->from_lambda[c], 1);
    pl_prog_store(code, lambda, o->L + c, o->n_c);
  }
  for (int i = 0; i < o->n_q; i++) {
    int u = o->of_coordinate[i];
    if (u < 0 || x[u] < 0) continue;
    int a = times_next(k, x[u], first);
    pl_prog_store(code, a, o->A + i, o->n_q);
    if (k->from_a[i].n > 0) write(k, pl_prog_op1(code, PL_PROG_NEG, a), &k->from_a[i], 1);
  }
}

static void equations(pl_maker* k, bool first) {
  int n = k->o->n, *x = PL_ARRAY(k->a, int, n + 1);
  k->velocity_phase = true;
  for (int u = 0; u < n; u++)
    x[u] = u < n - k->o->n_taken ? right_of_coordinate(k, u, first) : left_of_constraint(k, u);
  solve(k, x, first);
  take_solution(k, x, first);
}

// -------------------------------------------------------------------------------- the two programs
static void inverses(pl_maker* k, pl_tape_level level) {
  for (int i = 0; i < k->n_nodes; i++) {
    if (k->inverse[i] < 0 || pl_maker_node(k, i)->level != level) continue;
    pl_maker_instance* in = &k->instance[k->owner[i]];
    k->instance_now = k->owner[i];
    k->lower.tape = in->tape;
    pl_prog_store(k->code, pl_recurrence_inverse(&k->lower, i - in->base), k->inverse[i], 0);
  }
}

static int larger(pl_maker* k, int most, int x) {
  x = pl_prog_op1(k->code, PL_PROG_ABS, x);
  return most < 0 ? x : pl_prog_if_le(k->code, x, most, most, x);
}

// At the end of a step: how large accelerations are, and by how much those of the series are off.
static void compare_accelerations(pl_maker* k) {
  int off = -1, most = -1;
  for (int i = 0; i < k->o->n_q; i++) {
    int a = pl_prog_load(k->code, k->o->A + i, 0), end = pl_prog_load(k->code, k->o->end_a + i, 0);
    off = larger(k, off, pl_prog_op2(k->code, PL_PROG_SUB, end, a));
    most = larger(k, most, a);
  }
  if (off < 0) return;
  pl_prog_store(k->code, off, k->o->off, 0);
  pl_prog_store(k->code, most, k->o->off + 1, 0);
}

void pl_maker_start_code(pl_maker* k) {
  pl_maker_begin(k, PL_PART_START, "start", 1);
  inverses(k, PL_LEVEL_POSITION);
  position_nodes(k);
  pl_maker_level(k, PL_LEVEL_VELOCITY, k->needed);
  inverses(k, PL_LEVEL_VELOCITY);
  equations(k, true);
  compare_accelerations(k);
  pl_maker_end(k);
}

// Small programs are written out for every order.
static bool is_small(const pl_maker* k) {
  long operations = 0;
  for (int order = 1; order < k->run->order; order++)
    operations += k->code->lines.n + 2L * k->code->pairs.n * order;
  return operations <= PL_STEP_WRITTEN_OUT;
}

void pl_maker_order_code(pl_maker* k) {
  pl_maker_begin(k, PL_PART_ORDER, "order", 1);
  k->with_sums = true;
  position_nodes(k);
  velocity_nodes(k);
  equations(k, false);
  pl_maker_end(k);
  if (!is_small(k)) return;
  k->code->first_order = 1;
  k->code->orders = k->run->order;
}
