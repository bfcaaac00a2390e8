// Sensitivities of what switches a motion: watched quantities and their derivatives, coefficients
// of restitution.
//
// The motion and its derivatives are integrated between the moments at which contacts and events
// change them; what happens there is decided by a run of the motion alone, which goes ahead
// (solve/lead run.c). So the constraints of the setup with derivatives are plain ones that are
// switched from outside, and its watched quantities are only evaluated: their values e, then de/dt
// at fixed coordinates, then for each direction sum e_q δ + e_v δ' + e_a δ'' + e_λ dλ + e_p.
#include "assembly/assembly_impl.h"

// ----------------------------------------------------------------------------------- what switches
static bool actions_switch(const pl_event* e) {
  for (int k = 0; k < e->actions.n; k++)
    if (e->actions.at[k].kind != PL_DO_STOP && e->actions.at[k].kind != PL_DO_RECORD) return true;
  return false;
}

static bool is_switched(const pl_recorder* r) {
  const pl_model* m = r->model;
  for (int i = 0; i < m->constraints.n; i++) {
    const pl_constraint* c = &m->constraints.at[i];
    if (c->relation != PL_EQ || c->off || c->while_label) return true;
  }
  for (int i = 0; i < m->events.n; i++)
    if (actions_switch(&m->events.at[i])) return true;
  return false;
}

// ------------------------------------------------------------------------------ watched quantities
// What an event depends on: coordinates and multipliers with the places of the motion.
typedef struct watched {
  const pl_expr* e;
  int n;
  const pl_expr *atoms, *lambda;
  const int* constraints;
  int n_q, n_c;
} watched;

static pl_expr vary_watched(pl_recorder* r, const watched* w, pl_expr e, const pl_direction* d) {
  pl_pool* p = r->pool;
  pl_expr sum = pl_variation_by_parameter(r, e, d);
  for (int i = 0; i < w->n_q; i++) {
    pl_expr of = w->atoms[i], delta = pl_variation_delta(r, of);
    for (int dots = 0; dots < 3; dots++) {
      sum = pl_add(p, sum, pl_mul(p, pl_variation_by_atom(p, e, of), delta));
      of = pl_dt(p, of);
      delta = pl_dt(p, delta);
    }
  }
  for (int i = 0; i < w->n_c; i++)
    sum = pl_add(
        p, sum,
        pl_mul(p, pl_variation_by_atom(p, e, w->lambda[i]), pl_variation_delta(r, w->lambda[i])));
  return sum;
}

// A pattern of the outputs from `first` on, in the coordinates of the motion and its variation
// number `block`.
static pleuel_status record_block(pl_recorder* r, const watched* w, const pl_expr* output,
                                  int first, int block, pl_pattern* out) {
  int n_q = w->n_q, n_c = w->n_c, all = r->out->flat.n, rows = r->n_constraints;
  pl_expr *atoms = PL_ARRAY(r->arena, pl_expr, 2 * n_q + 1),
          *lambda = PL_ARRAY(r->arena, pl_expr, 2 * n_c + 1);
  int *q = PL_ARRAY(r->arena, int, 2 * n_q + 1), *c = PL_ARRAY(r->arena, int, 2 * n_c + 1),
      *where = PL_ARRAY(r->arena, int, w->n + 1);
  for (int i = 0; i < n_q; i++) {
    int at = pl_record_global(r, w->atoms[i]);
    if (at < 0)
      return pl_fail(r->job, PLEUEL_USAGE, "there is no coordinate %s",
                     pl_expr_text(r->arena, r->pool, w->atoms[i]));
    atoms[i] = w->atoms[i];
    atoms[n_q + i] = pl_variation_delta(r, w->atoms[i]);
    q[i] = at + 2 * block * all;
    q[n_q + i] = at + (2 * block + 1) * all;
  }
  for (int i = 0; i < n_c; i++) {
    lambda[i] = w->lambda[i];
    lambda[n_c + i] = pl_variation_delta(r, w->lambda[i]);
    c[i] = w->constraints[i] + 2 * block * rows;
    c[n_c + i] = w->constraints[i] + (2 * block + 1) * rows;
  }
  for (int i = 0; i < w->n; i++) where[i] = first + i;
  pl_pattern_source s = {.slots = {.n_q = 2 * n_q,
                                   .q = atoms,
                                   .n_c = 2 * n_c,
                                   .lambda = lambda,
                                   .value_of_symbol = r->value},
                         .n_outputs = w->n,
                         .output = output,
                         .n = 1,
                         .q = q,
                         .c = c,
                         .out = where};
  return pl_pattern_record(r->job, r->pool, &s, out);
}

pleuel_status pl_variation_watch(pl_recorder* r, const pl_record_group* g, const pl_expr* e, int n,
                                 const pl_expr* lambda, const int* constraints, int n_c) {
  pl_variation* v = r->variation;
  watched w = {e, n, g->atoms.at, lambda, constraints, g->atoms.n, n_c};
  if (n == 0 || !is_switched(r)) return PLEUEL_OK;
  pl_expr* output = PL_ARRAY(r->arena, pl_expr, n + 1);
  v->watch = PL_ARRAY(r->arena, pl_pattern, v->n + 1);
  for (int i = 0; i < n; i++) {
    if (pl_has_role(r->pool, e[i], PL_R_START) || pl_has_role(r->pool, e[i], PL_R_CONSTANT))
      return pl_fail(r->job, PLEUEL_UNSUPPORTED,
                     "sensitivities are not carried through events that speak of start values: %s",
                     pl_expr_text(r->arena, r->pool, e[i]));
    output[i] = pl_diff(r->pool, e[i], pl_time(r->pool));
  }
  PL_TRY(record_block(r, &w, output, n, 0, &v->watch[0]));
  for (int k = 0; k < v->n; k++) {
    output = PL_ARRAY(r->arena, pl_expr, n + 1);
    for (int i = 0; i < n; i++) output[i] = vary_watched(r, &w, e[i], &v->direction[k]);
    PL_TRY(pl_record_check(r, output, n));
    PL_TRY(record_block(r, &w, output, (2 + k) * n, k, &v->watch[k + 1]));
  }
  v->n_watch = v->n + 1;
  return PLEUEL_OK;
}

// --------------------------------------------------------------------------------------- the setup
// Derivatives of the coefficients of restitution.
static const double* restitution_slopes(pl_recorder* r) {
  const pl_model* m = r->model;
  const pl_variation* v = r->variation;
  double* slope = PL_ARRAY(r->arena, double, (size_t)v->n*(size_t)r->n_constraints + 1);
  for (int i = 0; i < m->constraints.n; i++) {
    const pl_restitution* bounce = pl_model_restitution(m, &m->constraints.at[i]);
    int next = i + 1 < m->constraints.n ? r->first_constraint[i + 1] : r->out->n_declared;
    for (int k = 0; bounce && k < v->n; k++)
      for (int c = r->first_constraint[i]; c < next; c++)
        slope[k * r->n_constraints + c] = pl_record_number(
            r, pl_variation_by_parameter(r, bounce->value, &v->direction[k]));
  }
  return slope;
}

void pl_variation_switch(pl_recorder* r) {
  pl_setup* s = &r->out->setup;
  const pl_variation* v = r->variation;
  if (!is_switched(r)) return;
  pl_varied* varied = PL_NEW(r->arena, pl_varied);
  *varied = (pl_varied){.n_directions = v->n,
                        .n_q = r->out->flat.n,
                        .n_c = r->n_constraints,
                        .n_watched = s->n_watched,
                        .restitution_slope = restitution_slopes(r)};
  s->varied = varied;
  pl_constraint_setup* constraint = PL_ARRAY(r->arena, pl_constraint_setup, s->n_c + 1);
  for (int c = 0; c < s->n_c; c++) {
    constraint[c] = s->constraints[c];
    constraint[c].side = 0;
    constraint[c].contact = -1;
    constraint[c].n_needs = 0;
    constraint[c].off = constraint[c].rope = false;
    constraint[c].restitution = 0;
  }
  s->constraints = constraint;
  pl_pattern* watch = PL_ARRAY(r->arena, pl_pattern, s->n_watch_patterns + v->n_watch + 1);
  int n = 0;
  for (int i = 0; i < s->n_watch_patterns; i++) watch[n++] = s->watch[i];
  for (int i = 0; i < v->n_watch; i++) watch[n++] = v->watch[i];
  s->watch = watch;
  s->n_watch_patterns = n;
  s->n_watched *= 2 + v->n;
  s->n_events = 0;
}
