// The system of a certified motion: one jet for each instance of each pattern, unknowns, and their
// memory.
//
// Balls are FLINT's, so they are freed by pl_system_free; everything else stands in the arena.
#include "enclose/enclose_impl.h"

#include <math.h>
#include <string.h>

// -------------------------------------------------------------------------------------------- jets
void pl_jet_want(pl_ball_jet* j, int* stack, int root, uint8_t who) {
  int n = 0;
  stack[n++] = j->tape->roots[root];
  while (n > 0) {
    int i = stack[--n];
    if (j->wanted[i] & who) continue;
    j->wanted[i] |= who;
    const pl_tape_node* node = &j->tape->nodes[i];
    const int operand[3] = {node->a, node->b, node->c};
    for (int k = 0; k < 3; k++)
      if (operand[k] >= 0 && !(j->wanted[operand[k]] & who)) stack[n++] = operand[k];
  }
}

static void mark_entries(pl_ball_jet* j, int* stack, const pl_pattern_entry* e, int n,
                         uint8_t who) {
  for (int i = 0; i < n; i++) pl_jet_want(j, stack, e[i].root, who);
}

static void mark_wanted(pl_system* s, pl_ball_jet* j) {
  const pl_pattern* p = j->pattern;
  j->wanted = PL_ARRAY(s->arena, uint8_t, j->tape->n_nodes + 1);
  int* stack = PL_ARRAY(s->arena, int, 3 * (size_t)j->tape->n_nodes + 4);
  uint8_t both = PL_FOR_MOTION | PL_FOR_START;
  for (uint8_t who = PL_FOR_MOTION; who <= both; who++) {
    if (who == both) continue;
    mark_entries(j, stack, p->mass, p->n_mass, who);
    mark_entries(j, stack, p->G, p->n_G, who);
    mark_entries(j, stack, p->gt, p->n_gt, who);
  }
  mark_entries(j, stack, p->h, p->n_h, PL_FOR_MOTION);
  mark_entries(j, stack, p->W, p->n_W, PL_FOR_MOTION);
  mark_entries(j, stack, p->g, p->n_g, PL_FOR_START);
}

// Nodes whose recurrence has weights.
static bool has_weights(int op) {
  return pl_op_recurrence[op] != PL_RECURRENCE_NONE && pl_op_recurrence[op] != PL_RECURRENCE_ANGLE;
}

static void make_jet(pl_system* s, pl_ball_jet* j, const pl_pattern* p, int instance) {
  *j = (pl_ball_jet){.pattern = p, .tape = p->tape};
  size_t i = (size_t)instance;
  j->q = p->n_q ? p->q + i * (size_t)p->n_q : NULL;
  j->c = p->n_c ? p->c + i * (size_t)p->n_c : NULL;
  j->index = p->n_index ? p->index + i * (size_t)p->n_index : NULL;
  mark_wanted(s, j);
  j->disk = pl_disks_make(j->tape->n_nodes);
  j->slope = pl_disks_make(j->tape->n_nodes);
}

static void place_weights(pl_system* s, pl_ball_jet* j) {
  j->aux_at = PL_ARRAY(s->arena, int, j->tape->n_nodes + 1);
  for (int i = 0; i < j->tape->n_nodes; i++)
    j->aux_at[i] = j->wanted[i] && has_weights(j->tape->nodes[i].op) ? j->n_aux++ : -1;
}

static int count_instances(const pl_pattern* p, int n) {
  int all = 0;
  for (int i = 0; i < n; i++) all += p[i].n;
  return all;
}

static void make_jets_of(pl_system* s, const pl_pattern* p, int n, bool watches) {
  for (int i = 0; i < n; i++) {
    for (int k = 0; k < p[i].n; k++) {
      pl_ball_jet* j = &s->jet[s->n_jets++];
      make_jet(s, j, &p[i], k);
      if (watches && p[i].n_outputs > 0) j->out = p[i].out + (size_t)k * (size_t)p[i].n_outputs;
    }
  }
}

// What events watch is a program like the others, without equations.
static void make_jets(pl_system* s) {
  const pl_setup* setup = s->setup;
  int n = count_instances(setup->patterns, setup->n_patterns)
          + count_instances(setup->watch, setup->n_watch_patterns);
  s->jet = PL_ARRAY(s->arena, pl_ball_jet, n + 1);
  make_jets_of(s, setup->patterns, setup->n_patterns, false);
  make_jets_of(s, setup->watch, setup->n_watch_patterns, true);
}

static long count_nodes_of(const pl_pattern* p, int n) {
  long all = 0;
  for (int i = 0; i < n; i++) all += (long)p[i].n * p[i].tape->n_nodes;
  return all;
}

static long count_nodes(const pl_setup* s) {
  return count_nodes_of(s->patterns, s->n_patterns) + count_nodes_of(s->watch, s->n_watch_patterns);
}

// --------------------------------------------------------------------------------------- the whole
static void make_names(pl_system* s) {
  pl_pool* pool = s->p->pool;
  s->exact = (pl_exact){.p = s->p, .arena = s->arena, .place = pl_map_make(s->arena)};
  for (int i = 0; i < s->n_q; i++) {
    pl_expr v = pl_dt(pool, s->p->coordinates[i]);
    pl_map_set(s->exact.place, s->p->coordinates[i].id, (uint64_t)i + 1);
    pl_map_set(s->exact.place, v.id, (uint64_t)(s->n_q + i) + 1);
  }
}

static void make_work(pl_system* s) {
  s->held = PL_ARRAY(s->arena, bool, s->n_c + 1);
  s->active = PL_ARRAY(s->arena, bool, s->n_c + 1);
  s->row_of = PL_ARRAY(s->arena, int, s->n_c + 1);
  s->constraint_of = PL_ARRAY(s->arena, int, s->n_c + 1);
  s->rhs = _arb_vec_init(s->n + 1);
  s->q_disk = pl_disks_make(s->n_q);
  s->v_disk = pl_disks_make(s->n_q);
  s->a_disk = pl_disks_make(s->n_q);
  s->l_disk = pl_disks_make(s->n_c);
  s->matrix = pl_disks_make((slong)s->n * s->n);
  s->right = pl_disks_make(s->n);
  s->scratch = pl_disks_make(2);
  s->slack = _mag_vec_init((slong)s->n * s->n + 1);
  s->spread = _mag_vec_init(4 * (slong)s->n + 1);
}

// Every constraint that is in force and does not follow from the others must be in use.
void pl_system_hold(pl_system* s) {
  const pl_constraint_setup* constraints = s->setup->constraints;
  s->n_wanted = 0;
  for (int c = 0; c < s->n_c; c++) {
    s->active[c] = s->held[c] && (constraints[c].contact < 0 || s->held[constraints[c].contact]);
    for (int i = 0; i < constraints[c].n_needs; i++)
      s->active[c] = s->active[c] && s->held[constraints[c].needs[i]];
    s->n_wanted += s->active[c] && !s->p->implied[c];
  }
}

pl_certify_end pl_system_make(pl_system* s, pl_job* job, const pl_certify_problem* p) {
  *s = (pl_system){.job = job, .arena = job->arena, .p = p, .setup = p->setup};
  s->n_q = p->setup->n_q;
  s->n_c = p->setup->n_c;
  s->n = s->n_q + s->n_c;
  s->n_nodes = count_nodes(p->setup);
  if (s->n > PL_CERTIFY_UNKNOWNS || s->n_nodes > PL_CERTIFY_NODES) return PL_CERTIFY_TOO_LARGE;
  make_names(s);
  make_work(s);
  make_jets(s);
  pl_certify_end end = pl_monitors_mark(s, &s->exact.missing);
  for (int i = 0; i < s->n_jets; i++) place_weights(s, &s->jet[i]);
  return end;
}

static void free_balls(pl_system* s) {
  if (s->cap == 0) return;
  for (int i = 0; i < s->n_jets; i++) {
    pl_ball_jet* j = &s->jet[i];
    _arb_vec_clear(j->coef, (slong)j->tape->n_nodes * j->cap);
    _arb_vec_clear(j->aux, (slong)j->n_aux * j->cap);
  }
  arb_ptr series[] = {s->q, s->v, s->a, s->l};
  for (int i = 0; i < 4; i++) _arb_vec_clear(series[i], (slong)(i < 3 ? s->n_q : s->n_c) * s->cap);
  s->cap = 0;
}

void pl_system_free(pl_system* s) {
  if (!s->rhs) return;
  free_balls(s);
  for (int i = 0; i < s->n_jets; i++) {
    pl_disks_free(s->jet[i].disk, s->jet[i].tape->n_nodes);
    pl_disks_free(s->jet[i].slope, s->jet[i].tape->n_nodes);
  }
  pl_disk* one[] = {s->q_disk, s->v_disk, s->a_disk, s->l_disk, s->right, s->scratch, s->matrix};
  const slong n[] = {s->n_q, s->n_q, s->n_q, s->n_c, s->n, 2, (slong)s->n * s->n};
  for (int i = 0; i < 7; i++) pl_disks_free(one[i], n[i]);
  _arb_vec_clear(s->rhs, s->n + 1);
  _mag_vec_clear(s->slack, (slong)s->n * s->n + 1);
  _mag_vec_clear(s->spread, 4 * (slong)s->n + 1);
  if (s->has_inverse) arb_mat_clear(s->inverse);
  pl_monitors_free(s);
  pl_exact_free(&s->exact);
}

// The state (order 0 of q and v) is kept.
void pl_system_reserve(pl_system* s, int cap) {
  if (cap <= s->cap) return;
  arb_ptr state = _arb_vec_init(2 * s->n_q);
  for (int i = 0; i < s->n_q && s->cap; i++) {
    arb_swap(state + i, s->q + (slong)i * s->cap);
    arb_swap(state + s->n_q + i, s->v + (slong)i * s->cap);
  }
  free_balls(s);
  s->cap = cap;
  arb_ptr* series[] = {&s->q, &s->v, &s->a, &s->l};
  for (int i = 0; i < 4; i++) *series[i] = _arb_vec_init((slong)(i < 3 ? s->n_q : s->n_c) * cap);
  for (int i = 0; i < s->n_jets; i++) {
    pl_ball_jet* j = &s->jet[i];
    j->cap = cap;
    j->coef = _arb_vec_init((slong)j->tape->n_nodes * cap);
    j->aux = _arb_vec_init((slong)j->n_aux * cap);
  }
  for (int i = 0; i < s->n_q; i++) {
    arb_swap(s->q + (slong)i * cap, state + i);
    arb_swap(s->v + (slong)i * cap, state + s->n_q + i);
  }
  _arb_vec_clear(state, 2 * s->n_q);
  if (s->prec) pl_system_precision(s, s->prec);
}

arb_srcptr pl_root_series(const pl_ball_jet* j, int root) {
  return j->coef + (slong)j->tape->roots[root] * j->cap;
}

// --------------------------------------------------------------------------------------- constants
static bool constant(pl_system* s, pl_ball_jet* j, int i) {
  const pl_tape_node* node = &j->tape->nodes[i];
  arb_ptr c = j->coef + (slong)i * j->cap;
  switch (node->op) {
    case PL_OP_CONST:
      if (!pl_is_poison(j->tape->constant[i]))
        return pl_exact_ball(&s->exact, c, j->tape->constant[i]);
      arb_set_d(c, node->value);
      return true;
    case PL_OP_INDEX: arb_set_d(c, j->index[node->slot]); return true;
    case PL_OP_PARAM:
      return pl_exact_ball(&s->exact, c, pl_sym(s->p->pool, j->tape->param_symbol[node->slot]));
    default: return true;
  }
}

static bool constants(pl_system* s, pl_ball_jet* j) {
  for (int i = 0; i < j->tape->level_end[PL_LEVEL_CONST]; i++)
    if (j->wanted[i] && !constant(s, j, i)) return false;
  uint8_t all = PL_FOR_MOTION | PL_FOR_START;
  pl_jet_coefficients(j, PL_LEVEL_CONST, 0, s->prec, all);
  for (int i = 0; i < j->tape->level_end[PL_LEVEL_CONST]; i++) {
    pl_disk_set_ball(&j->disk[i], j->coef + (slong)i * j->cap);
    arb_zero(&j->slope[i].c);
    mag_zero(&j->slope[i].r);
  }
  return true;
}

bool pl_system_precision(pl_system* s, slong prec) {
  s->prec = prec;
  pl_exact_begin(&s->exact, prec);
  for (int i = 0; i < s->n_jets; i++)
    if (!constants(s, &s->jet[i])) return false;
  return true;
}
