// The workspace of the equations, from the dimensions of their setup.  After this nothing is
// reserved.
#include "solve/dae/dae.h"

static void reserve_point(pl_dae* dae) {
  pl_arena* a = dae->job->arena;
  size_t q = (size_t)dae->n_q, c = (size_t)dae->n_c;
  double** of_q[] = {&dae->q,      &dae->v,      &dae->column, &dae->q_most,
                     &dae->v_most, &dae->q_kept, &dae->v_kept};
  double** of_c[] = {&dae->g,        &dae->g_size,   &dae->r,        &dae->r_size,   &dae->row_most,
                     &dae->argument, &dae->row_long, &dae->row_part, &dae->rank_work};
  bool** flags[] = {&dae->on,      &dae->detached,  &dae->active,     &dae->taken,
                    &dae->unique,  &dae->row_taken, &dae->slips,      &dae->near_by,
                    &dae->several, &dae->rebounds,  &dae->taken_kept, &dae->ever_several};
  for (size_t i = 0; i < sizeof of_q / sizeof *of_q; i++) *of_q[i] = PL_ARRAY(a, double, q + 1);
  for (size_t i = 0; i < sizeof of_c / sizeof *of_c; i++) *of_c[i] = PL_ARRAY(a, double, c + 1);
  for (size_t i = 0; i < sizeof flags / sizeof *flags; i++) *flags[i] = PL_ARRAY(a, bool, c + 1);
  dae->at_friction = PL_ARRAY(a, int, c + 1);
  dae->rhs = PL_ARRAY(a, double, q + c + 1);
  dae->has_equation = PL_ARRAY(a, int, q + 1);
}

static void reserve_series(pl_dae* dae) {
  pl_arena* a = dae->job->arena;
  size_t q = (size_t)dae->n_q, c = (size_t)dae->n_c, orders = (size_t)dae->order + 2;
  double** of_q[] = {&dae->Q, &dae->V, &dae->A, &dae->Q_last, &dae->V_last, &dae->A_last};
  double** of_c[] = {&dae->L, &dae->L_last};
  for (size_t i = 0; i < sizeof of_q / sizeof *of_q; i++)
    *of_q[i] = PL_ARRAY(a, double, q* orders + 1);
  for (size_t i = 0; i < sizeof of_c / sizeof *of_c; i++)
    *of_c[i] = PL_ARRAY(a, double, c* orders + 1);
}

static void reserve_ranks(pl_dae* dae) {
  pl_arena* a = dae->job->arena;
  size_t q = (size_t)dae->n_q, c = (size_t)dae->n_c;
  dae->priority = PL_ARRAY(a, int, c + 1);
  dae->row_of = PL_ARRAY(a, int, c + 1);
  if (c > PL_RANK_UP_TO) return;
  dae->rows = PL_ARRAY(a, double, q* c + 1);
  dae->dep = PL_ARRAY(a, double, q* c + 1);
  dae->dep_tau = PL_ARRAY(a, double, c + 1);
  dae->dep_norm = PL_ARRAY(a, double, 2 * c + q + 1);
  dae->dep_jpvt = PL_ARRAY(a, int, 2 * c + 1);
}

static pleuel_status reserve_batches(pl_dae* dae) {
  const pl_setup* s = dae->setup;
  dae->motion.lean = s->n_frictions == 0;
  for (int c = 0; c < s->n_c; c++) dae->motion.lean &= s->constraints[c].side == 0;
  return pl_batches_make(dae->job, &dae->motion, s->patterns, s->n_patterns, dae->order + 2, s->n_q,
                         s->n_c, INT32_MAX);
}

static pleuel_status check_rows(pl_dae* dae) {
  int* owner = PL_ARRAY(dae->job->arena, int, dae->n_c + 1);
  for (int i = 0; i < dae->motion.n; i++) {
    const pl_batch* b = &dae->motion.at[i];
    const pl_pattern* p = b->pattern;
    dae->has_W |= p->n_W > 0;
    for (int e = 0; e < p->n_mass; e++)
      dae->mass_of_velocity |= p->tape->roots[p->mass[e].root]
                               >= p->tape->level_end[PL_LEVEL_POSITION];
    for (int e = 0; e < p->n_g; e++)
      for (int l = 0; l < b->n; l++)
        if (owner[b->c[p->g[e].row * b->lanes + l]]++)
          return pl_fail(dae->job, PLEUEL_USAGE, "constraint %s stands in two places",
                         dae->setup->constraints[b->c[p->g[e].row * b->lanes + l]].name);
  }
  return PLEUEL_OK;
}

static void first_mode(pl_dae* dae) {
  for (int c = 0; c < dae->n_c; c++) {
    dae->detached[c] = dae->setup->constraints[c].off || dae->setup->constraints[c].slip;
    dae->on[c] = !dae->detached[c];
  }
}

pleuel_status pl_dae_make(pl_dae* dae, pl_job* job, const pl_setup* setup, int order) {
  dae->job = job;
  dae->setup = setup;
  dae->n_q = setup->n_q;
  dae->n_c = setup->n_c;
  dae->order = dae->use = order;
  reserve_point(dae);
  reserve_series(dae);
  reserve_ranks(dae);
  pl_attitude_make(dae);
  PL_TRY(reserve_batches(dae));
  PL_TRY(check_rows(dae));
  PL_TRY(pl_kkt_make(dae));
  pl_friction_make(dae);
  first_mode(dae);
  return PLEUEL_OK;
}
