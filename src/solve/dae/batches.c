// Instances of patterns, side by side in lanes. A batch carries the series of its own slots, so
// that the terminal products (M a, G^T λ, G v) run lane by lane without looking at global arrays.
#include "solve/dae/dae.h"

// Copies indices of instances first .. first+n-1 into lanes; unused lanes repeat the last one.
static int* spread(pl_arena* a, const int* index, int slots, int first, int n, int lanes) {
  int* to = PL_ARRAY(a, int, (size_t)slots*(size_t)lanes + 1);
  for (int s = 0; s < slots; s++)
    for (int l = 0; l < lanes; l++)
      to[s * lanes + l] = index[(size_t)(first + (l < n ? l : n - 1)) * (size_t)slots + (size_t)s];
  return to;
}

static void set_constants(pl_arena* a, pl_batch* b, int first) {
  const pl_pattern* p = b->pattern;
  double* index = PL_ARRAY(a, double, (size_t)p->n_index*(size_t)b->lanes + 1);
  for (int s = 0; s < p->n_index; s++)
    for (int l = 0; l < b->lanes; l++)
      index[s * b->lanes + l] =
          p->index[(size_t)(first + (l < b->n ? l : b->n - 1)) * (size_t)p->n_index + (size_t)s];
  pl_jet_constants(b->jet, index);
}

// The first index of each slot whose indices follow each other from lane to lane, -1 for the
// others.
static int* find_runs(pl_arena* a, const int* index, int slots, int n, int lanes) {
  int* run = PL_ARRAY(a, int, slots + 1);
  for (int s = 0; s < slots; s++) {
    run[s] = n > 1 ? index[s * lanes] : -1;
    for (int l = 1; l < n && run[s] >= 0; l++)
      if (index[s * lanes + l] != run[s] + l) run[s] = -1;
  }
  return run;
}

// --------------------------------------------------------------------------------------- rows of G
// The node that a node is a multiple of; the factors of the lanes are multiplied with.
static int multiple_of(const pl_batch* b, int node, double* factor) {
  const pl_tape_node* nodes = b->pattern->tape->nodes;
  for (;;) {
    const pl_tape_node* n = &nodes[node];
    if (n->op != PL_OP_NEG && n->op != PL_OP_SCALE && n->op != PL_OP_RSCALE) return node;
    const double* by = n->op == PL_OP_NEG ? NULL : pl_jet_at(b->jet, n->b, 0);
    for (int l = 0; l < b->lanes; l++) {
      if (n->op == PL_OP_NEG) factor[l] = -factor[l];
      else factor[l] = n->op == PL_OP_SCALE ? factor[l] * by[l] : factor[l] / by[l];
    }
    node = n->a;
  }
}

static void find_bundles(pl_arena* a, pl_batch* b) {
  const pl_pattern* p = b->pattern;
  int* node = PL_ARRAY(a, int, p->n_G + 1);
  double* factor = PL_ARRAY(a, double, (size_t)p->n_G*(size_t)b->lanes + 1);
  b->bundles = PL_ARRAY(a, pl_bundle, p->n_G + 1);
  b->bundle_q = PL_ARRAY(a, int, p->n_G + 1);
  b->bundle_factor = PL_ARRAY(a, double, (size_t)p->n_G*(size_t)b->lanes + 1);
  for (int e = 0; e < p->n_G; e++) {
    double* f = factor + (size_t)e * (size_t)b->lanes;
    for (int l = 0; l < b->lanes; l++) f[l] = 1;
    node[e] = multiple_of(b, p->tape->roots[p->G[e].root], f);
  }
  int n = 0;
  bool* done = PL_ARRAY(a, bool, p->n_G + 1);
  for (int e = 0; e < p->n_G; e++) {
    if (done[e] || node[e] < p->tape->level_end[PL_LEVEL_CONST]) continue;
    pl_bundle* t = &b->bundles[b->n_bundles++];
    *t = (pl_bundle){.node = node[e], .c = p->G[e].row, .first = n};
    for (int d = e; d < p->n_G; d++) {
      if (done[d] || node[d] != node[e] || p->G[d].row != t->c) continue;
      done[d] = true;
      for (int l = 0; l < b->lanes; l++)
        b->bundle_factor[(size_t)n * (size_t)b->lanes + (size_t)l] =
            factor[(size_t)d * (size_t)b->lanes + (size_t)l];
      b->bundle_q[n++] = p->G[d].col;
    }
    t->n = n - t->first;
  }
  b->bundle_v = PL_ARRAY(a, double, (size_t)b->n_bundles*(size_t)b->orders*(size_t)b->lanes + 1);
}

// Which series of slots something reads: v for G v, a for M a where M changes.
static void find_needs(pl_arena* a, pl_batch* b) {
  const pl_pattern* p = b->pattern;
  b->needs_v = PL_ARRAY(a, bool, p->n_q + 1);
  b->needs_a = PL_ARRAY(a, bool, p->n_q + 1);
  for (int e = 0; e < p->n_G; e++) b->needs_v[p->G[e].col] = true;
  for (int e = 0; e < p->n_mass; e++)
    if (p->tape->roots[p->mass[e].root] >= p->tape->level_end[PL_LEVEL_CONST])
      b->needs_a[p->mass[e].row] = b->needs_a[p->mass[e].col] = true;
}

static double* series_of(pl_arena* a, const pl_batch* b, int slots, bool all) {
  return PL_ARRAY(a, double, (size_t)slots*(size_t)(all ? b->orders : 1) * (size_t)b->lanes + 1);
}

static void make_batch(pl_arena* a, pl_batch* b, const pl_pattern* p, int first, int n, int lanes,
                       int orders, bool lean) {
  *b = (pl_batch){.pattern = p, .lanes = lanes, .n = n, .orders = orders, .all_v = !lean};
  b->jet = (lean ? pl_jet_make_lean : pl_jet_make)(a, p->tape, lanes, orders);
  b->q = spread(a, p->q, p->n_q, first, n, lanes);
  b->c = spread(a, p->c, p->n_c, first, n, lanes);
  b->out = spread(a, p->out, p->n_outputs, first, n, lanes);
  b->q_run = find_runs(a, b->q, p->n_q, n, lanes);
  b->c_run = find_runs(a, b->c, p->n_c, n, lanes);
  set_constants(a, b, first);
  find_needs(a, b);
  find_bundles(a, b);
  bool any_a = false;
  for (int s = 0; s < p->n_q; s++) any_a |= b->needs_a[s];
  b->v = series_of(a, b, p->n_q, b->all_v);
  b->a = series_of(a, b, p->n_q, any_a);
  b->lambda = series_of(a, b, p->n_c, true);
}

static bool in_range(const int* index, size_t n, int limit) {
  for (size_t i = 0; i < n; i++)
    if (index == NULL || index[i] < 0 || index[i] >= limit) return false;
  return true;
}

static pleuel_status check(pl_job* job, const pl_pattern* p, int n_q, int n_c, int n_out) {
  if (p->n < 0 || p->tape == NULL)
    return pl_fail(job, PLEUEL_USAGE, "a pattern has no instances or no program");
  size_t n = (size_t)p->n;
  if (!in_range(p->q, n * (size_t)p->n_q, n_q))
    return pl_fail(job, PLEUEL_USAGE, "a pattern names a coordinate that does not exist");
  if (!in_range(p->c, n * (size_t)p->n_c, n_c))
    return pl_fail(job, PLEUEL_USAGE, "a pattern names a constraint that does not exist");
  if (!in_range(p->out, n * (size_t)p->n_outputs, n_out))
    return pl_fail(job, PLEUEL_USAGE, "a pattern names an output that does not exist");
  if (p->n_index > 0 && p->n > 0 && p->index == NULL)
    return pl_fail(job, PLEUEL_USAGE, "a pattern lacks the values of its indices");
  return PLEUEL_OK;
}

// Batches of one size, as few as can be.
static int lanes_for(int n) {
  int groups = (n + PL_FAMILY_LANES - 1) / PL_FAMILY_LANES,
      batches = (groups + PL_FAMILY_GROUPS - 1) / PL_FAMILY_GROUPS;
  return n > 1 ? PL_FAMILY_LANES * ((groups + batches - 1) / batches) : 1;
}
static int batches_for(int n) { return (n + lanes_for(n) - 1) / lanes_for(n); }

pleuel_status pl_batches_make(pl_job* job, pl_batches* b, const pl_pattern* patterns, int n,
                              int orders, int n_q, int n_c, int n_out) {
  int count = 0;
  for (int i = 0; i < n; i++) {
    PL_TRY(check(job, &patterns[i], n_q, n_c, n_out));
    count += batches_for(patterns[i].n);
  }
  b->at = PL_ARRAY(job->arena, pl_batch, count + 1);
  b->n = 0;
  for (int i = 0; i < n; i++) {
    int lanes = lanes_for(patterns[i].n);
    for (int first = 0; first < patterns[i].n; first += lanes) {
      int left = patterns[i].n - first;
      make_batch(job->arena, &b->at[b->n++], &patterns[i], first, left < lanes ? left : lanes,
                 lanes, orders, b->lean);
    }
  }
  return PLEUEL_OK;
}

// ----------------------------------------------------------------------------------------- loading
void pl_batches_time(pl_batches* b, double t) {
  for (int i = 0; i < b->n; i++) pl_jet_time(b->at[i].jet, t);
}

// The build for this processor.
extern const pl_taylor_order pl_taylor_order_plain, pl_taylor_order_avx2, pl_taylor_order_avx512;

const pl_taylor_order* pl_taylor_order_here(void) {
#ifdef PL_KERNELS_BY_PROCESSOR
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl")
      && __builtin_cpu_supports("avx512dq"))
    return &pl_taylor_order_avx512;
  if (__builtin_cpu_supports("fma") && __builtin_cpu_supports("avx2")) return &pl_taylor_order_avx2;
#endif
  return &pl_taylor_order_plain;
}

void pl_batches_load_q(pl_batches* b, const double* q, int k) {
  pl_taylor_order_here()->load(b, PL_IS_Q, q, k);
}
void pl_batches_load_v(pl_batches* b, const double* v, int k) {
  pl_taylor_order_here()->load(b, PL_IS_V, v, k);
}
void pl_batches_load_a(pl_batches* b, const double* a, int k) {
  pl_taylor_order_here()->load(b, PL_IS_A, a, k);
}
void pl_batches_load_lambda(pl_batches* b, const double* lambda, int k) {
  pl_taylor_order_here()->load(b, PL_IS_LAMBDA, lambda, k);
}

// --------------------------------------------------------------------------------------- computing
void pl_batches_sweep(pl_batches* bs, pl_tape_level level, int k, bool all) {
  for (int i = 0; i < bs->n; i++) bs->at[i].jet->kernel(bs->at[i].jet, level, k, all);
}

// Coefficient k of a root in a lane.  Constants have order 0 only.
static double root_value(const pl_batch* b, int root, int k, int lane) {
  const pl_tape* tape = b->pattern->tape;
  int node = tape->roots[root];
  if (k > 0 && node < tape->level_end[PL_LEVEL_CONST]) return 0;
  return pl_jet_at(b->jet, node, k)[lane];
}

void pl_batches_outputs(const pl_batches* bs, double* out, int n_out, int k) {
  for (int i = 0; i < n_out; i++) out[i] = 0;
  for (int i = 0; i < bs->n; i++) {
    const pl_batch* b = &bs->at[i];
    for (int e = 0; e < b->pattern->n_out; e++) {
      const pl_pattern_entry* o = &b->pattern->outputs[e];
      for (int l = 0; l < b->n; l++)
        out[b->out[o->row * b->lanes + l]] += root_value(b, o->root, k, l);
    }
  }
}
