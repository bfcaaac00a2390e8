// Instances of patterns, side by side in lanes.  A batch carries the series of its own slots, so that the terminal
// products (M a, G^T λ, G v) run lane by lane without looking at global arrays.
#include "solve/solve_impl.h"

// Copies indices of instances first .. first+n-1 into lanes; unused lanes repeat the last one.
static int* spread(pl_arena* a, const int* index, int slots, int first, int n, int lanes) {
  int* to = PL_ARRAY(a, int, (size_t)slots * (size_t)lanes + 1);
  for (int s = 0; s < slots; s++)
    for (int l = 0; l < lanes; l++)
      to[s * lanes + l] = index[(size_t)(first + (l < n ? l : n - 1)) * (size_t)slots + (size_t)s];
  return to;
}

static void set_constants(pl_arena* a, pl_batch* b, int first) {
  const pl_pattern* p = b->pattern;
  double* index = PL_ARRAY(a, double, (size_t)p->n_index * (size_t)b->lanes + 1);
  for (int s = 0; s < p->n_index; s++)
    for (int l = 0; l < b->lanes; l++)
      index[s * b->lanes + l] = p->index[(size_t)(first + (l < b->n ? l : b->n - 1)) * (size_t)p->n_index + (size_t)s];
  pl_jet_constants(b->jet, index);
}

static void make_batch(pl_arena* a, pl_batch* b, const pl_pattern* p, int first, int n, int lanes, int orders) {
  size_t series = (size_t)orders * (size_t)lanes;
  *b = (pl_batch){.pattern = p, .lanes = lanes, .n = n, .orders = orders};
  b->jet = pl_jet_make(a, p->tape, lanes, orders);
  b->q = spread(a, p->q, p->n_q, first, n, lanes);
  b->c = spread(a, p->c, p->n_c, first, n, lanes);
  b->out = spread(a, p->out, p->n_outputs, first, n, lanes);
  b->v = PL_ARRAY(a, double, series * (size_t)p->n_q + 1);
  b->a = PL_ARRAY(a, double, series * (size_t)p->n_q + 1);
  b->lambda = PL_ARRAY(a, double, series * (size_t)p->n_c + 1);
  set_constants(a, b, first);
}

static bool in_range(const int* index, size_t n, int limit) {
  for (size_t i = 0; i < n; i++)
    if (index == NULL || index[i] < 0 || index[i] >= limit) return false;
  return true;
}

static pleuel_status check(pl_job* job, const pl_pattern* p, int n_q, int n_c, int n_out) {
  if (p->n < 0 || p->tape == NULL) return pl_fail(job, PLEUEL_USAGE, "a pattern has no instances or no program");
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

static int lanes_for(int n) { return n > 1 ? PL_FAMILY_LANES : 1; }
static int batches_for(int n) { return (n + lanes_for(n) - 1) / lanes_for(n); }

pleuel_status pl_batches_make(pl_job* job, pl_batches* b, const pl_pattern* patterns, int n, int orders, int n_q,
                              int n_c, int n_out) {
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
      make_batch(job->arena, &b->at[b->n++], &patterns[i], first, left < lanes ? left : lanes, lanes, orders);
    }
  }
  return PLEUEL_OK;
}

// ---------------------------------------------------------------------------------------------- loading
void pl_batches_time(pl_batches* b, double t) {
  for (int i = 0; i < b->n; i++) pl_jet_time(b->at[i].jet, t);
}

static void gather(double* to, const double* from, const int* index, int lanes) {
  for (int l = 0; l < lanes; l++) to[l] = from[index[l]];
}

static void into_jet(const pl_batch* b, int node, int k, const double* x, const int* index) {
  if (node >= 0) gather(pl_jet_at(b->jet, node, k), x, index, b->lanes);
}

void pl_batches_load_q(pl_batches* bs, const double* q, int k) {
  for (int i = 0; i < bs->n; i++) {
    const pl_batch* b = &bs->at[i];
    for (int s = 0; s < b->pattern->n_q; s++) into_jet(b, b->pattern->tape->q_node[s], k, q, b->q + s * b->lanes);
  }
}

void pl_batches_load_v(pl_batches* bs, const double* v, int k) {
  for (int i = 0; i < bs->n; i++) {
    const pl_batch* b = &bs->at[i];
    for (int s = 0; s < b->pattern->n_q; s++) {
      gather(b->v + ((size_t)s * (size_t)b->orders + (size_t)k) * (size_t)b->lanes, v, b->q + s * b->lanes, b->lanes);
      into_jet(b, b->pattern->tape->v_node[s], k, v, b->q + s * b->lanes);
    }
  }
}

void pl_batches_load_a(pl_batches* bs, const double* a, int k) {
  for (int i = 0; i < bs->n; i++) {
    const pl_batch* b = &bs->at[i];
    for (int s = 0; s < b->pattern->n_q; s++) {
      gather(b->a + ((size_t)s * (size_t)b->orders + (size_t)k) * (size_t)b->lanes, a, b->q + s * b->lanes, b->lanes);
      into_jet(b, b->pattern->tape->a_node[s], k, a, b->q + s * b->lanes);
    }
  }
}

void pl_batches_load_lambda(pl_batches* bs, const double* lambda, int k) {
  for (int i = 0; i < bs->n; i++) {
    const pl_batch* b = &bs->at[i];
    for (int s = 0; s < b->pattern->n_c; s++) {
      gather(b->lambda + ((size_t)s * (size_t)b->orders + (size_t)k) * (size_t)b->lanes, lambda, b->c + s * b->lanes,
             b->lanes);
      into_jet(b, b->pattern->tape->lambda_node[s], k, lambda, b->c + s * b->lanes);
    }
  }
}

// ---------------------------------------------------------------------------------------------- computing
void pl_batches_sweep(pl_batches* bs, pl_level level, int k, bool all) {
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
      for (int l = 0; l < b->n; l++) out[b->out[o->row * b->lanes + l]] += root_value(b, o->root, k, l);
    }
  }
}
