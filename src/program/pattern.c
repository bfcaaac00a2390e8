// From the Lagrange function, the forces and the constraints of a pattern to M, h, G, W, dg/dt on
// one tape.
#include "program/tape.h"

typedef struct builder {
  pl_job* job;
  pl_pool* pool;
  const pl_pattern_source* source;
  const pl_expr* v;  // velocity atoms  (n_q)
  PL_VEC(pl_expr) roots;
  PL_VEC(bool) high;
  PL_VEC(pl_pattern_entry) mass, h, G, W, gt, g, outputs;
} builder;

static pl_expr diff_atom(pl_pool* p, pl_expr e, pl_expr atom) {
  return pl_kind_of(p, atom) == PL_SYMBOL ? pl_diff(p, e, pl_symbol_of(p, atom))
                                          : pl_diff_at(p, e, atom);
}

static int add_root(builder* b, pl_expr e, bool high) {
  pl_push(b->job->arena, b->roots, e);
  pl_push(b->job->arena, b->high, high);
  return b->roots.n - 1;
}

#define ADD_ENTRY(b, list, row_, col_, e, high)                                   \
  do {                                                                            \
    pl_expr entry_ = (e);                                                         \
    if (!pl_is_zero_node((b)->pool, entry_))                                      \
      pl_push((b)->job->arena, (b)->list,                                         \
              (pl_pattern_entry){(row_), (col_), add_root((b), entry_, (high))}); \
  } while (0)

// ---------------------------------------------------------------------------------------- dynamics
// h_i = d/dt (dL/dv_i) without the accelerations - dL/dq_i - Q_i at λ = 0.
static pl_expr rest_of_lagrange(builder* b, pl_expr momentum, int i, pl_expr force) {
  pl_pool* p = b->pool;
  const pl_tape_slots* s = &b->source->slots;
  pl_expr L = b->source->lagrangian;
  pl_expr h = pl_diff(p, momentum, pl_time(p));
  for (int j = 0; j < s->n_q; j++)
    h = pl_add(p, h, pl_mul(p, diff_atom(p, momentum, s->q[j]), b->v[j]));
  if (L.id) h = pl_sub(p, h, diff_atom(p, L, s->q[i]));
  return pl_sub(p, h, force);
}

// Splits a force into the part without multipliers and its derivatives by them.
static pl_expr split_force(builder* b, int i) {
  pl_pool* p = b->pool;
  const pl_tape_slots* s = &b->source->slots;
  pl_expr Q = b->source->force ? b->source->force[i] : pl_poison();
  if (!Q.id) return pl_int(p, 0);
  for (int c = 0; c < s->n_c && s->lambda; c++)
    if (s->lambda[c].id) ADD_ENTRY(b, W, i, c, diff_atom(p, Q, s->lambda[c]), true);
  for (int c = 0; c < s->n_c && s->lambda; c++)
    if (s->lambda[c].id) Q = pl_subst_expr(p, Q, s->lambda[c], pl_int(p, 0));
  return Q;
}

static void add_dynamics(builder* b) {
  pl_pool* p = b->pool;
  const pl_tape_slots* s = &b->source->slots;
  for (int i = 0; i < s->n_q; i++) {
    pl_expr momentum = b->source->lagrangian.id ? diff_atom(p, b->source->lagrangian, b->v[i])
                                                : pl_int(p, 0);
    for (int j = i; j < s->n_q; j++)
      ADD_ENTRY(b, mass, i, j, diff_atom(p, momentum, b->v[j]), true);
    ADD_ENTRY(b, h, i, 0, rest_of_lagrange(b, momentum, i, split_force(b, i)), true);
  }
}

// ------------------------------------------------------------------------------------- constraints
// The size of an expression's terms: what a relative residual is relative to. Poison when e is not
// a sum.
static pl_expr size_of_terms(pl_pool* p, pl_expr e) {
  if (pl_kind_of(p, e) != PL_ADD) return pl_poison();
  pl_expr size = pl_int(p, 0);
  for (int i = 0; i < pl_n_args(p, e); i++)
    size = pl_add(p, size, pl_call(p, PL_ABS, pl_arg(p, e, i)));
  return size;
}

static void add_holonomic(builder* b, int c) {
  pl_pool* p = b->pool;
  const pl_tape_slots* s = &b->source->slots;
  pl_expr g = b->source->constraint[c], size = size_of_terms(p, g);
  for (int j = 0; j < s->n_q; j++) ADD_ENTRY(b, G, c, j, diff_atom(p, g, s->q[j]), true);
  ADD_ENTRY(b, gt, c, 0, pl_diff(p, g, pl_time(p)), true);
  int root = add_root(b, g, false);
  pl_push(b->job->arena, b->g,
          (pl_pattern_entry){c, size.id ? add_root(b, size, false) : -1, root});
}

static void add_nonholonomic(builder* b, int c) {
  pl_pool* p = b->pool;
  const pl_tape_slots* s = &b->source->slots;
  pl_expr f = b->source->constraint[c];
  for (int j = 0; j < s->n_q; j++) ADD_ENTRY(b, G, c, j, diff_atom(p, f, b->v[j]), true);
  for (int j = 0; j < s->n_q; j++) f = pl_subst_expr(p, f, b->v[j], pl_int(p, 0));
  ADD_ENTRY(b, gt, c, 0, f, true);
}

static void add_constraints(builder* b) {
  for (int c = 0; c < b->source->slots.n_c && b->source->constraint; c++) {
    if (!b->source->constraint[c].id) continue;
    if (b->source->velocity && b->source->velocity[c]) add_nonholonomic(b, c);
    else add_holonomic(b, c);
  }
}

static void add_outputs(builder* b) {
  for (int i = 0; i < b->source->n_outputs; i++)
    pl_push(b->job->arena, b->outputs,
            (pl_pattern_entry){i, 0, add_root(b, b->source->output[i], true)});
}

// ------------------------------------------------------------------------------------------ checks
// Entries must be known when the order they are needed at is computed.
static bool levels_allow(const pl_tape* tape, const pl_pattern_entry* e, int n,
                         pl_tape_level highest) {
  for (int i = 0; i < n; i++)
    if (tape->nodes[tape->roots[e[i].root]].level > highest) return false;
  return true;
}

static pleuel_status check_levels(pl_job* job, const pl_pattern* out) {
  if (!levels_allow(out->tape, out->mass, out->n_mass, PL_LEVEL_VELOCITY))
    return pl_fail(job, PLEUEL_UNSUPPORTED,
                   "the kinetic energy contains accelerations or multipliers");
  if (!levels_allow(out->tape, out->h, out->n_h, PL_LEVEL_VELOCITY))
    return pl_fail(job, PLEUEL_UNSUPPORTED,
                   "a force contains accelerations, or multipliers of another pattern");
  if (!levels_allow(out->tape, out->W, out->n_W, PL_LEVEL_VELOCITY))
    return pl_fail(job, PLEUEL_UNSUPPORTED, "a force is not linear in a multiplier");
  if (!levels_allow(out->tape, out->G, out->n_G, PL_LEVEL_POSITION)
      || !levels_allow(out->tape, out->gt, out->n_gt, PL_LEVEL_POSITION))
    return pl_fail(job, PLEUEL_UNSUPPORTED, "a constraint is not linear in the velocities");
  if (!levels_allow(out->tape, out->g, out->n_g, PL_LEVEL_POSITION))
    return pl_fail(job, PLEUEL_UNSUPPORTED,
                   "a constraint contains velocities but is not declared so");
  return PLEUEL_OK;
}

static void fill(const builder* b, pl_pattern* out) {
  const pl_pattern_source* s = b->source;
#define LIST(name) out->n_##name = b->name.n, out->name = b->name.at
  LIST(mass);
  LIST(h);
  LIST(G);
  LIST(W);
  LIST(gt);
  LIST(g);
#undef LIST
  out->n_out = b->outputs.n;
  out->outputs = b->outputs.at;
  out->n_q = s->slots.n_q;
  out->n_c = s->slots.n_c;
  out->n_index = s->slots.n_index;
  out->n_outputs = s->n_outputs;
  out->n = s->n;
  out->q = s->q;
  out->c = s->c;
  out->out = s->out;
  out->index = s->index;
}

pleuel_status pl_pattern_record(pl_job* job, pl_pool* pool, const pl_pattern_source* source,
                                pl_pattern* out) {
  builder b = {.job = job, .pool = pool, .source = source};
  pl_expr* v = PL_ARRAY(job->arena, pl_expr, source->slots.n_q + 1);
  for (int i = 0; i < source->slots.n_q; i++) v[i] = pl_dt(pool, source->slots.q[i]);
  b.v = v;
  *out = (pl_pattern){0};
  add_dynamics(&b);
  add_constraints(&b);
  add_outputs(&b);
  pl_tape* tape;
  PL_TRY(pl_tape_record(job, pool, &source->slots, b.roots.at, b.high.at, b.roots.n, &tape));
  out->tape = tape;
  fill(&b, out);
  return check_levels(job, out);
}
