// From a run to its proof: what the model says exactly, the times, and how far the run is from the
// enclosure.
//
// Whatever changes the equations on the way (contacts, friction, events) is refused by name.
// Constraints that follow from the map equations of `choose` are recognised by algebra: inserted,
// the maps make them identities.
#include <math.h>
#include <string.h>

#include "api/certified_impl.h"
#include "algebra/algebra.h"

enum { MOST_TIMES = 4000 };
static const double width_wanted = 1e-18;

// ---------------------------------------------------------------------------------------- refusals
// Contacts that let go, events that record, stop, or release a two-sided constraint.
static bool is_followed(const pl_setup* s, const pl_event_action* d) {
  return d->kind == PL_ACTION_RECORD || d->kind == PL_ACTION_STOP
         || (d->kind == PL_ACTION_RELEASE && s->constraints[d->target].side == 0);
}

static bool changes_mode(const pl_setup* s) {
  for (int c = 0; c < s->n_c; c++)
    if (s->constraints[c].side != 0) return true;
  return s->n_events > 0;
}

static pl_certify_refusal refusal_of(const pleuel_model* m, const char** name) {
  const pl_setup* s = &m->recording->setup;
  if (m->recording->n_directions > 0) return PL_REFUSED_SENSITIVITIES;
  if (s->n_attitudes > 0) return PL_REFUSED_TURN;
  if (s->n_frictions > 0) {
    *name = s->frictions[0].name;
    return PL_REFUSED_FRICTION;
  }
  for (int i = 0; i < s->n_events; i++) {
    for (int k = 0; k < s->events[i].n_actions; k++) {
      if (is_followed(s, &s->events[i].actions[k])) continue;
      *name = s->events[i].name;
      return PL_REFUSED_EVENT;
    }
  }
  return PL_CERTIFY_TRIED;
}

// ---------------------------------------------------------------------------------- before the run
void pl_certify_begin(pleuel_model* m, const pleuel_sim_options* o, const pl_run* run) {
  if (!o->certify) return;
  const pl_setup* s = &m->recording->setup;
  pl_certificate_of_run* c = PL_NEW(m->motion, pl_certificate_of_run);
  c->n_q = s->n_q;
  c->n_c = s->n_c;
  c->proof = (pl_certified){
      .end = PL_CERTIFY_TOO_LARGE, .t_reached = (double)NAN, .width = (double)NAN};
  c->refusal = refusal_of(m, &c->refused_name);
  c->q_run = PL_ARRAY(m->motion, double, s->n_q + 1);
  c->v_run = PL_ARRAY(m->motion, double, s->n_q + 1);
  c->active = PL_ARRAY(m->motion, bool, s->n_c + 1);
  c->implied = PL_ARRAY(m->motion, bool, s->n_c + 1);
  memcpy(c->q_run, pl_run_q(run), (size_t)s->n_q * sizeof(double));
  memcpy(c->v_run, pl_run_v(run), (size_t)s->n_q * sizeof(double));
  for (int i = 0; i < s->n_c; i++) c->active[i] = pl_run_is_active(run, i);
  m->certified = c;
}

// -------------------------------------------------------------------------- what follows from maps
// e with the maps of `choose`, and their derivatives, in the places of the old coordinates; maps
// may name each other.
static pl_expr with_maps(const pleuel_model* m, pl_expr e) {
  pl_pool* p = m->model->pool;
  for (int round = 0; round <= m->model->choose.n_maps; round++) {
    pl_expr before = e;
    for (int k = 0; k < m->model->choose.n_maps; k++) {
      pl_expr old = m->model->choose.maps[k].old, map = m->model->choose.maps[k].map;
      e = pl_subst_expr(p, pl_subst_expr(p, e, pl_dt(p, old), pl_dt(p, map)), old, map);
    }
    if (pl_same(e, before)) break;
  }
  return e;
}

static void find_implied(pleuel_model* m, pl_certificate_of_run* c) {
  const pl_model* model = m->model;
  if (model->choose.n_maps == 0) return;
  pl_tower* t = pl_tower_make(&m->job, model->pool, NULL, 0);
  for (int i = 0, constraint = 0; i < model->constraints.n; i++) {
    const pl_constraint* g = &model->constraints.at[i];
    pl_instances in = {.n = 1};
    if (g->block && pl_model_instances(&m->job, model, g->block, &in) != PLEUEL_OK) break;
    if (!g->block && c->active[constraint])
      c->implied[constraint] = pl_alg_is_zero(t, with_maps(m, g->g)) == PL_YES;
    constraint += in.n;
  }
  pl_tower_free(t);
}

// ----------------------------------------------------------------------------------- exact numbers
static pl_expr decimal(const pleuel_model* m, double x) {
  char text[32];
  pl_double_text(text, fabs(x));
  pl_expr e = pl_number_from_text(m->model->pool, text, strlen(text));
  return x < 0 ? pl_neg(m->model->pool, e) : e;
}

static pl_expr start_of(const pleuel_model* m, const pl_exact_start* s) {
  pl_pool* p = m->model->pool;
  pl_expr e = s->value;
  for (int d = 0; s->instances && !pl_is_poison(e) && d < s->instances->depth; d++)
    e = pl_subst1(p, e, s->instances->symbol[d],
                  pl_int(p, s->instances->index[s->instance * s->instances->depth + d]));
  return e;
}

// Times: those of the grid, or the end alone.  The end of the grid is the end of the run.
static pl_expr* times_of(const pleuel_model* m, const pleuel_sim_options* o, pl_expr t_0, int* n,
                         pl_certify_refusal* why) {
  pl_pool* p = m->model->pool;
  const pl_recording* r = m->recording;
  pl_expr end = o->has_until ? decimal(m, o->until) : m->model->simulate.to;
  double t_end = o->has_until ? o->until : r->t_end, span = t_end - r->t_0;
  double dt = o->has_dt ? o->dt : r->dt;
  long count = o->has_dt ? 0 : r->count, rows = count > 0 ? count
                                                : dt > 0  ? lround(ceil(fabs(span) / dt - 1e-9))
                                                          : 1;
  if (rows > MOST_TIMES) {
    *why = PL_REFUSED_ROWS;
    return NULL;
  }
  if (rows < 1) rows = 1;
  pl_expr step = count > 0 ? pl_mul(p, pl_sub(p, end, t_0), pl_ratio(p, 1, count))
                 : dt > 0  ? (o->has_dt ? decimal(m, dt) : m->model->simulate.step)
                           : end;
  if (span < 0 && count == 0) step = pl_neg(p, step);
  pl_expr* t = PL_ARRAY(m->motion, pl_expr, rows + 1);
  for (long i = 1; i < rows; i++) t[i - 1] = pl_add(p, t_0, pl_mul(p, pl_int(p, i), step));
  t[rows - 1] = end;
  *n = (int)rows;
  return t;
}

// ------------------------------------------------------------------------ comparison with the rows
// The last row at this time.
static const double* row_at(const pl_result* r, double t, double span) {
  for (int i = r->rows.n - 1; i >= 0; i--)
    if (fabs(r->rows.at[i][0] - t) <= 1e-9 * fmax(fabs(span), fabs(t)) * 1e-3) return r->rows.at[i];
  return NULL;
}

static void fill_value(const pleuel_model* m, const pl_certified* proof, int time,
                       pl_certify_kind kind, int i, double x, pl_certified_value* out) {
  *out = (pl_certified_value){.error = (double)NAN, .least = (double)NAN, .radius = (double)NAN};
  out->text = pl_certified_ball(proof, m->motion, time, kind, i, &out->radius);
  if (!out->text) return;
  out->error = pl_certified_error(proof, time, kind, i, x);
  out->least = pl_certified_error_least(proof, time, kind, i, x);
}

// ORDER COLUMNS: as result.c.
static void fill_time(const pleuel_model* m, const pl_certified* proof, int time, const double* row,
                      pl_certified_value* out) {
  const pl_setup* s = &m->recording->setup;
  int column = 1;
  for (pl_certify_kind kind = PL_CERTIFY_Q; kind <= PL_CERTIFY_V; kind++) {
    for (int i = 0; i < s->n_q; i++) {
      bool shown = !s->coordinates[i].hidden;
      double x = shown && row ? row[column] : (double)NAN;
      column += shown;
      fill_value(m, proof, time, kind, i, x, out++);
    }
  }
  for (int i = 0; i < s->n_c; i++, out++) {
    bool shown = s->constraints[i].column != NULL;
    double x = shown && row ? row[column] : (double)NAN;
    column += shown;
    if (!shown) {
      *out = (pl_certified_value){0};
      continue;
    }
    fill_value(m, proof, time, PL_CERTIFY_LAMBDA, i, s->constraints[i].minus ? -x : x, out);
    if (out->text && s->constraints[i].minus)
      out->text = *out->text == '-' ? out->text + 1 : pl_format(m->motion, "-%s", out->text);
  }
}

static void fill_rows(pleuel_model* m, pl_certificate_of_run* c, const pl_certified* proof,
                      const pl_expr* times) {
  size_t width = (size_t)(2 * c->n_q + c->n_c);
  const pl_result* r = m->result;
  const double* value = pl_model_values(m->model, m->motion);
  double span = pl_eval(m->model->pool, times[c->n_times - 1], value) - m->recording->t_0;
  c->time = PL_ARRAY(m->motion, double, c->n_times + 1);
  c->value = PL_ARRAY(m->motion, pl_certified_value, width * (size_t)proof->n_done + 1);
  for (int i = 0; i < proof->n_done; i++) {
    bool stop = proof->stopped && i == proof->n_done - 1;
    c->time[i] = stop ? r->rows.at[r->rows.n - 1][0] : pl_eval(m->model->pool, times[i], value);
    fill_time(m, proof, i, stop ? r->rows.at[r->rows.n - 1] : row_at(r, c->time[i], span),
              c->value + width * (size_t)i);
  }
}

// The event of the run that a proved one is compared with: the nearest of this name and kind.
static bool is_same(const pl_setup* s, const pl_happening* h, const pl_result_event* e) {
  static const pl_event_kind of_contact[] = {PL_EV_RELEASE, PL_EV_SLACK},
                             of_impact[] = {PL_EV_IMPACT, PL_EV_CONTACT, PL_EV_TAUT},
                             of_event[] = {PL_EV_EVENT, PL_EV_STOP};
  bool named = h->kind == PL_HAPPENED_EVENT || h->kind == PL_HAPPENED_STOP;
  const pl_event_kind* kinds = named                            ? of_event
                               : h->kind == PL_HAPPENED_RELEASE ? of_contact
                                                                : of_impact;
  int n = h->kind == PL_HAPPENED_IMPACT ? 3 : 2;
  bool kind = false;
  for (int i = 0; i < n; i++) kind |= e->kind == kinds[i];
  const char* name = named ? s->events[h->index].name : s->constraints[h->index].name;
  return kind && e->label && strcmp(e->label, name) == 0;
}

static void fill_happenings(pleuel_model* m, pl_certificate_of_run* c, const pl_certified* proof) {
  const pl_setup* s = &m->recording->setup;
  c->happened = PL_ARRAY(m->motion, pl_certified_value, proof->n_happened + 1);
  c->state = PL_ARRAY(m->motion, pl_certified_value,
                      (size_t)proof->n_happened * 2 * (size_t)c->n_q + 1);
  for (int i = 0; i < proof->n_happened; i++) {
    pl_certified_value* v = &c->happened[i];
    *v = (pl_certified_value){.error = (double)NAN, .least = (double)NAN};
    v->text = pl_certified_time(proof, m->motion, i, &v->radius);
    for (int k = 0; k < 2 * c->n_q; k++) {
      pl_certified_value* x = &c->state[(size_t)i * 2 * (size_t)c->n_q + (size_t)k];
      *x = (pl_certified_value){.error = (double)NAN, .least = (double)NAN};
      x->text = pl_certified_state(proof, m->motion, i, k < c->n_q ? PL_CERTIFY_Q : PL_CERTIFY_V,
                                   k % c->n_q, &x->radius);
    }
    for (int k = 0; k < m->result->events.n; k++) {
      if (!is_same(s, &proof->happened[i], &m->result->events.at[k])) continue;
      double off = pl_certified_time_error(proof, i, m->result->events.at[k].t);
      if (!(off >= v->error)) v->error = off;
    }
  }
}

// --------------------------------------------------------------------------------------------- all
// Numbers for the one who looks, as of a run.
static void watch(void* user, double t, double t_end, double h, long steps) {
  pleuel_progress* where = user;
  where->t = t;
  where->t_end = t_end;
  where->step = h;
  where->steps = steps;
}

static pleuel_status prove(pleuel_model* m, const pleuel_sim_options* o, pl_certificate_of_run* c) {
  const pl_recording* r = m->recording;
  pl_pool* p = m->model->pool;
  pl_certify_problem problem = {.pool = p,
                                .setup = &r->setup,
                                .coordinates = r->flat.at,
                                .q_run = c->q_run,
                                .v_run = c->v_run,
                                .active = c->active,
                                .implied = c->implied};
  problem.width = o->certify_width > 0 ? o->certify_width : width_wanted;
  problem.t_0 = m->model->simulate.given && !pl_is_poison(m->model->simulate.from)
                    ? m->model->simulate.from
                    : pl_int(p, 0);
  problem.times = times_of(m, o, problem.t_0, &problem.n_times, &c->refusal);
  if (c->refusal != PL_CERTIFY_TRIED) return PLEUEL_OK;
  if ((o->has_until ? o->until : r->t_end) < r->t_0 && changes_mode(&r->setup)) {
    c->refusal = PL_REFUSED_BACKWARD;
    return PLEUEL_OK;
  }
  c->n_times = problem.n_times;
  find_implied(m, c);
  pl_expr *q = PL_ARRAY(m->motion, pl_expr, c->n_q + 1),
          *v = PL_ARRAY(m->motion, pl_expr, c->n_q + 1);
  for (int i = 0; i < c->n_q; i++) {
    q[i] = start_of(m, &r->exact_q[i]);
    v[i] = start_of(m, &r->exact_v[i]);
  }
  problem.q_start = q;
  problem.v_start = v;
  problem.exact = pl_model_definitions(m->model, m->motion);
  problem.n_symbols = pl_symbol_count(p) + 1;
  pl_api_stage(m->ctx, PLEUEL_STAGE_CERTIFY);
  m->ctx->where.t_begin = r->t_0;
  problem.progress = watch;
  problem.progress_user = &m->ctx->where;
  PL_TRY(pl_certify_motion(&m->job, &problem, &c->proof));
  fill_rows(m, c, &c->proof, problem.times);
  fill_happenings(m, c, &c->proof);
  pl_certified_free(&c->proof);
  return PLEUEL_OK;
}

pleuel_status pl_certify_end_of_run(pleuel_model* m, const pleuel_sim_options* o) {
  pl_certificate_of_run* c = m->certified;
  if (!o->certify || !c) return PLEUEL_OK;
  if (c->refusal == PL_CERTIFY_TRIED && m->run != PLEUEL_OK) c->refusal = PL_REFUSED_RUN;
  if (c->refusal == PL_CERTIFY_TRIED) PL_TRY(prove(m, o, c));
  if (c->refusal == PL_REFUSED_RUN) return m->run;
  if (c->refusal != PL_CERTIFY_TRIED)
    return pl_fail(&m->job, PLEUEL_UNSUPPORTED, "the motion cannot be certified");
  if (c->proof.end == PL_CERTIFY_INTERRUPTED)
    return pl_fail(&m->job, PLEUEL_INTERRUPTED, "the certification was interrupted");
  if (c->proof.end != PL_CERTIFIED)
    return pl_fail(&m->job, PLEUEL_NUMERICAL, "the motion is not certified as asked for");
  return PLEUEL_OK;
}
