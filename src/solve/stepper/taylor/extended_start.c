// The start of a run on extended numbers. The start that was found in doubles says which solution
// it is; given values are taken as they were written, and the others move until the constraints
// hold in extended numbers too: residuals in extended numbers, corrections in doubles, each of
// which gains some fifteen digits.
#include <math.h>
#include <string.h>

#include "solve/stepper/taylor/extended_impl.h"

enum { MAX_ROUNDS = 12 };

static void set_times(pl_run* run, double t, const pl_parts* exact) {
  pl_extended* w = run->extended;
  const pl_run_options* o = &run->options;
  const pl_exact_setup* e = run->setup->exact;
  pl_parts from = {{o->t_0}}, to = {{o->t_end}}, step = {{run->control.grid_dt}};
  if (exact && e->t_0 >= 0) from = exact[e->t_0];
  if (o->t_end_exact) to = (pl_parts){{o->t_end_exact[0], o->t_end_exact[1], o->t_end_exact[2]}};
  else if (exact && e->t_end >= 0 && exact[e->t_end].part[0] == o->t_end) to = exact[e->t_end];
  if (o->dt_exact) step = (pl_parts){{o->dt_exact[0], o->dt_exact[1], o->dt_exact[2]}};
  else if (exact && e->dt >= 0 && exact[e->dt].part[0] == o->dt) step = exact[e->dt];
  if (o->dt_exact == NULL && step.part[0] * run->control.grid_dt < 0)
    for (int i = 0; i < 3; i++) step.part[i] = -step.part[i];
  w->fine->set(w->m, w->from, from);
  w->fine->set(w->m, w->to, to);
  w->fine->set(w->m, w->o->time, t == o->t_0 ? from : (pl_parts){{t}});
  double share = o->count > 0 ? (double)o->count : 1;
  w->fine->write(w->m, w->share, 1, &share);
  w->way = step;
  if (o->count == 0) return;
  w->fine->move(w->m, w->t_0, w->from, 1);
  w->fine->interpret(w->left, w->m, 0, 1);
  w->way = w->fine->get(w->m, w->o->length);
}

// Given values exactly; what the start in doubles found for the others.
static void set_state(pl_run* run, const pl_parts* exact) {
  pl_extended* w = run->extended;
  const pl_exact_setup* e = run->setup->exact;
  for (int i = 0; i < run->n_q; i++) {
    const pl_coordinate* c = &run->setup->coordinates[i];
    pl_parts q = {{run->dae.q[i]}}, v = {{run->dae.v[i]}};
    if (w->held && c->has_q) q = exact && e->q[i] >= 0 ? exact[e->q[i]] : (pl_parts){{c->q}};
    if (w->held && c->has_v) v = exact && e->v[i] >= 0 ? exact[e->v[i]] : (pl_parts){{c->v}};
    w->fine->set(w->m, w->o->Q + i, q);
    w->fine->set(w->m, w->o->V + i, v);
  }
}

// Minimum-norm correction of the free components; there may be none.
static bool move_free(pl_run* run, bool positions, const bool* held, double* basis,
                      double* change) {
  pl_extended* w = run->extended;
  pl_step_program* o = w->o;
  double before = (double)INFINITY, *g = positions ? run->dae.g : run->dae.r,
         *size = positions ? run->dae.g_size : run->dae.r_size;
  for (int round = 0; round < MAX_ROUNDS; round++) {
    w->fine->interpret(o->code[PL_PART_POSITION], w->m, 0, 1);
    w->fine->interpret(o->code[PL_PART_VELOCITY], w->m, 0, 1);
    w->fine->read(w->m, positions ? o->g : o->r, run->n_c, g);
    w->fine->read(w->m, positions ? o->g_size : o->r_size, run->n_c, size);
    double most = 0;
    for (int c = 0; c < run->n_c; c++)
      if (run->dae.taken[c] && !(positions && run->setup->constraints[c].velocity))
        most = fmax(most, fabs(g[c]) / size[c]);
    if (!(most > w->fine->epsilon) || !(most < 0.5 * before)) return true;
    before = most;
    if (!pl_least_change(&run->dae, held, g, size, positions, basis, change)) return false;
    w->fine->write(w->m, w->scratch, run->n_q, change);
    w->fine->add(w->m, positions ? o->Q : o->V, w->scratch, run->n_q);
  }
  return true;
}

static void set_sizes(pl_run* run) {
  pl_extended* w = run->extended;
  for (int i = 0; i < run->n_q; i++) {
    double q = fmax(run->dae.q_most[i], 1e-6 * run->dae.q_size),
           v = fmax(run->dae.v_most[i], 1e-6 * run->dae.v_size);
    w->fine->write(w->m, w->o->q_floor + i, 1, &q);
    w->fine->write(w->m, w->o->v_floor + i, 1, &v);
  }
}

static void refine(pl_run* run) {
  pl_arena* a = run->job->arena;
  size_t n = (size_t)run->n_q;
  bool *q = PL_ARRAY(a, bool, n + 1), *v = PL_ARRAY(a, bool, n + 1);
  double *basis = PL_ARRAY(a, double, n*(size_t)(run->n_c + 1) + 1),
         *change = PL_ARRAY(a, double, n + 1);
  for (size_t i = 0; run->extended->held && i < n; i++) {
    q[i] = run->setup->coordinates[i].has_q;
    v[i] = run->setup->coordinates[i].has_v;
  }
  pl_point_evaluate(&run->dae, run->dae.t, run->dae.q, run->dae.v);
  pl_assemble_rows(&run->dae);
  set_sizes(run);
  move_free(run, true, q, basis, change);
  move_free(run, false, v, basis, change);
}

static pleuel_status lost(pl_run* run) {
  return pl_fail(run->job, PLEUEL_NUMERICAL,
                 "precision %s: the start could not be refined to its digits; use double",
                 pl_extended_name(run));
}

pleuel_status pl_extended_begin(pl_run* run, double t) {
  pl_parts* exact = NULL;
  bool held = run->control.start_given;
  const pl_exact_setup* e = run->setup->exact;
  PL_TRY(pl_extended_make(run));
  pl_extended* w = run->extended;
  w->held = held;
  if (e) {
    exact = PL_ARRAY(run->job->arena, pl_parts, e->tape->n_roots + 1);
    pl_extended_roots(run->job->arena, w->fine, e->tape, exact);
  }
  set_times(run, t, exact);
  set_state(run, exact);
  refine(run);
  // the end of a step of length 0: projected and rounded like any other
  pl_projection p;
  const double none = 0;
  w->fine->move(w->m, w->t_0, w->o->time, 1);
  w->fine->move(w->m, w->o->end_q, w->o->Q, run->n_q);
  w->fine->move(w->m, w->o->end_v, w->o->V, run->n_q);
  w->fine->write(w->m, w->o->length, 1, &none);
  memcpy(run->control.trial_q, run->dae.q, (size_t)run->n_q * sizeof(double));
  memcpy(run->control.trial_v, run->dae.v, (size_t)run->n_q * sizeof(double));
  if (!pl_extended_project(run, &p) || p.g_after > 1e3 * w->floor || p.r_after > 1e3 * w->floor)
    return lost(run);
  memcpy(run->dae.q, run->control.trial_q, (size_t)run->n_q * sizeof(double));
  memcpy(run->dae.v, run->control.trial_v, (size_t)run->n_q * sizeof(double));
  pl_sizes_keep(&run->dae);
  return pl_extended_enter(run) ? PLEUEL_OK : lost(run);
}
