// Stages of a motion, from its trace.
#include "api/stages.h"

#include <math.h>
#include <string.h>

#include "witness/trace.h"

enum { MOST_COORDINATES = 80, MOST_SAMPLES = 4000, MOST_STAGES = 8 };

// --------------------------------------------------------------------------------- whether to look
// Sets can change: there are contacts, or constraints that are off or that an event releases.
static bool has_sets(const pl_model* m) {
  if (m->frictions.n > 0) return true;
  for (int k = 0; k < m->constraints.n; k++) {
    if (m->constraints.at[k].relation != PL_EQ || m->constraints.at[k].off) return true;
  }
  for (int k = 0; k < m->events.n; k++) {
    for (int i = 0; i < m->events.at[k].actions.n; i++) {
      pl_action_kind kind = m->events.at[k].actions.at[i].kind;
      if (kind == PL_DO_RELEASE || kind == PL_DO_ATTACH) return true;
    }
  }
  return false;
}

static bool has_numbers(const pl_model* m) {
  for (int i = 0; i < m->params.n; i++) {
    if (pl_is_poison(m->params.at[i].value)) return false;
  }
  return true;
}

static bool has_start(const pl_model* m) {
  for (int i = 0; i < m->inits.n; i++) {
    if (!m->inits.at[i].guess) return true;
  }
  return m->simulate.given;
}

static bool can_look(pleuel_model* m) {
  return has_sets(m->model) && has_numbers(m->model)
         && pl_model_flat_coords(m->model, m->arena).n <= MOST_COORDINATES;
}

// ----------------------------------------------------------------------------- from phase to stage
// How each friction goes on.
static void list_frictions(pl_arena* a, const pl_trace* t, const pl_trace_phase* p, pl_stage* out) {
  const pl_setup* s = &t->recording->setup;
  pl_stage_rub* friction = PL_ARRAY(a, pl_stage_rub, s->n_frictions + 1);
  out->rubs = friction;
  out->n_rubs = s->n_frictions;
  out->rubs_known = true;
  for (int i = 0; i < s->n_frictions; i++) {
    const pl_friction_law* law = &t->recording->laws[i];
    const pl_friction_report* now = &p->frictions[i];
    friction[i] = (pl_stage_rub){.on = s->frictions[i].name,
                                 .name = s->constraints[s->frictions[i].row[0]].name,
                                 .slip = law->slip,
                                 .limit = law->limit,
                                 .scale = law->scale,
                                 .sticks = now->mode == PL_FRICTION_STICKS,
                                 .slips = now->mode == PL_FRICTION_SLIPS,
                                 .way = now->way,
                                 .press = now->press};
    out->rubs_known &= !pl_is_poison(law->slip);
  }
  if (!out->rubs_known) out->n_rubs = 0;
}

static pl_stage* stage_of(pl_arena* a, const pl_trace* t, int phase) {
  const pl_setup* s = &t->recording->setup;
  const pl_trace_phase* p = &t->phases.at[phase];
  const char** name = PL_ARRAY(a, const char*, s->n_c + 1);
  bool* rope = PL_ARRAY(a, bool, s->n_c + 1);
  for (int c = 0; c < s->n_c; c++) {
    name[c] = s->constraints[c].name;
    rope[c] = s->constraints[c].rope;
  }
  int n_q = t->recording->flat.n;
  const char **q_name = PL_ARRAY(a, const char*, n_q + 1),
             **q_unit = PL_ARRAY(a, const char*, n_q + 1);
  for (int i = 0; i < n_q; i++) {
    q_name[i] = s->coordinates[i].name;
    q_unit[i] = s->coordinates[i].unit ? s->coordinates[i].unit : "";
  }
  pl_stage* out = PL_NEW(a, pl_stage);
  *out = (pl_stage){.n = s->n_c,
                    .name = name,
                    .holds = p->active,
                    .released = p->released,
                    .rope = rope,
                    .from = p->t_begin,
                    .to = p->t_end,
                    .n_q = n_q,
                    .q_name = q_name,
                    .q_unit = q_unit,
                    .q = t->samples.at[p->first].q};
  list_frictions(a, t, p, out);
  out->v = t->samples.at[p->first].v;
  out->pulls = phase == 0 ? t->pulls : PL_ARRAY(a, bool, s->n_c + 1);
  return out;
}

static bool same_set(const pl_stage* a, const pl_stage* b) {
  for (int i = 0; i < a->n_rubs; i++) {
    const pl_stage_rub *x = &a->rubs[i], *y = &b->rubs[i];
    if (x->sticks != y->sticks || x->slips != y->slips
        || (x->slips && x->way * x->press != y->way * y->press))
      return false;
  }
  return memcmp(a->holds, b->holds, (size_t)a->n * sizeof(bool)) == 0
         && memcmp(a->released, b->released, (size_t)a->n * sizeof(bool)) == 0;
}

// What ends the stage in favour of the next phase: a contact that opens or closes by itself, or an
// event.
static void note_end(pl_stage* s, const pl_trace* t, int next) {
  const pl_trace_phase* p = &t->phases.at[next];
  s->to = p->t_begin;
  s->ended_by = p->begun_label;
  if (!p->begun_label) return;
  switch (p->begun_by) {
    case PL_EV_EVENT: s->end = PL_END_EVENT; break;
    case PL_EV_RELEASE:
    case PL_EV_SLACK: s->end = PL_END_OPENS; break;
    case PL_EV_IMPACT:
    case PL_EV_CONTACT:
    case PL_EV_TAUT: s->end = PL_END_CLOSES; break;
    case PL_EV_STICK: s->end = PL_END_STICKS; break;
    case PL_EV_SLIP: s->end = PL_END_SLIPS; break;
    default: break;
  }
}

static void note_last(pl_stage* s, const pl_trace* t) {
  s->to = t->t_end;
  if (t->whole) s->end = t->stopped_by ? PL_END_EVENT : PL_END_OF_RUN;
  s->ended_by = t->stopped_by;
}

static void list_stages(pl_staging* out, pl_arena* a, const pl_trace* t) {
  out->stages = PL_ARRAY(a, pl_stage, MOST_STAGES);
  for (int k = 0; k < t->phases.n && out->n < MOST_STAGES; k++) {
    pl_stage* s = stage_of(a, t, k);
    int last = k;
    while (last + 1 < t->phases.n && t->phases.at[last + 1].same_set) last++;
    if (last + 1 < t->phases.n) note_end(s, t, last + 1);
    else note_last(s, t);
    k = last;
    bool known = s->to <= s->from && t->phases.n > 1 && k > 0;  // touched, not held
    for (int i = 0; i < out->n; i++) known |= same_set(&out->stages[i], s);
    s->later = out->n > 0;
    if (!known) out->stages[out->n++] = *s;
  }
}

pl_staging* pl_staging_make(pleuel_model* m, bool along) {
  pl_staging* out = PL_NEW(m->arena, pl_staging);
  out->m = m;
  out->along = along && m->model->simulate.given;
  if (!can_look(m) || !has_start(m->model)) return out;
  along = along && m->model->simulate.given;
  pl_trace_options how = {
      .as_run = true, .most_samples = along ? MOST_SAMPLES : 1, .span = along ? 0 : 1};
  const pl_trace* t = pl_trace_make(&m->job, m->model, &how);
  if (t->started) list_stages(out, m->arena, t);
  if (!along && out->n > 0) {
    out->n = 1;
    out->stages[0].end = PL_END_UNKNOWN;
  }
  return out;
}

// --------------------------------------------------------------------------- starts that are named
const pl_stage* pl_staging_from(void* staging, const pl_motion* from) {
  pl_staging* s = staging;
  pleuel_model* m = s->m;
  if (!can_look(m)) return NULL;
  pl_trace_options how = {.from = from, .most_samples = 1, .span = 1};
  pl_trace* t = pl_trace_make(&m->job, m->model, &how);
  if (!t->started) {  // what `init` says of the rest may not fit
    pl_model bare = *m->model;
    bare.inits.n = 0;
    t = pl_trace_make(&m->job, &bare, &how);
  }
  return t->started ? stage_of(m->arena, t, 0) : NULL;
}

// ------------------------------------------------------------------------- changes of sign
// A motion with the places where some expressions are zero.
typedef struct pl_watched {
  int n;
  const pl_expr* e;
  const pl_trace* t;
  struct pl_watched* next;
} pl_watched;

static bool same_up_to_sign(pl_pool* p, pl_expr a, pl_expr b) {
  return pl_same(a, b) || pl_same(pl_neg(p, a), b);
}

static const pl_trace* watched(pl_staging* s, const pl_expr* e, int n) {
  pleuel_model* m = s->m;
  for (const pl_watched* w = s->watched; w; w = w->next) {
    bool same = w->n == n;
    for (int k = 0; same && k < n; k++) same = same_up_to_sign(m->model->pool, w->e[k], e[k]);
    if (same) return w->t;
  }
  pl_trace_options how = {
      .as_run = true, .most_samples = MOST_SAMPLES, .n_watched = n, .watched = e};
  pl_watched* w = PL_NEW(m->arena, pl_watched);
  *w = (pl_watched){n, e, pl_trace_make(&m->job, m->model, &how), s->watched};
  s->watched = w;
  return w->t;
}

// An expression of the state and its derivative along the motion, at a sample.
typedef struct pl_rate {
  double value, rate;
} pl_rate;

static pl_rate rate_of(pl_staging* s, const pl_trace* t, const pl_trace_sample* at, pl_expr e) {
  pl_pool* p = s->m->model->pool;
  pl_expr slope = pl_dt(p, e);
  int n = pl_symbol_count(p) + 1;
  double* value = PL_ARRAY(s->m->arena, double, n);
  for (int i = 0; i < n; i++) value[i] = i < t->n_value ? t->value[i] : (double)NAN;
  value[pl_time(p).id] = at->t;
  for (int i = 0; i < t->recording->flat.n; i++) {
    if (pl_kind_of(p, t->recording->flat.at[i]) != PL_SYMBOL) continue;
    pl_symbol q = pl_symbol_of(p, t->recording->flat.at[i]), v = pl_symbol_dot(p, q);
    value[q.id] = at->q[i];
    value[v.id] = at->v[i];
    value[pl_symbol_dot(p, v).id] = at->a[i];
  }
  return (pl_rate){pl_eval(p, e, value), pl_eval(p, slope, value)};
}

// What an expression is at most along a motion.
static double size_of(pl_staging* s, const pl_trace* t, pl_expr e) {
  double most = 0;
  for (int i = 0; i < t->samples.n; i++)
    most = fmax(most, fabs(rate_of(s, t, &t->samples.at[i], e).value));
  return most;
}

// How well an event is found.
static bool is_zero(const pl_rate* r, double size) { return fabs(r->value) <= 1e-9 * size; }

static void list_state(pl_arena* a, const pl_trace* t, const pl_trace_sample* at, pl_leaving* out) {
  const pl_setup* s = &t->recording->setup;
  int n = t->recording->flat.n;
  const char **name = PL_ARRAY(a, const char*, n + 1), **unit = PL_ARRAY(a, const char*, n + 1);
  for (int i = 0; i < n; i++) {
    name[i] = s->coordinates[i].name;
    unit[i] = s->coordinates[i].unit ? s->coordinates[i].unit : "";
  }
  out->n_q = n;
  out->q_name = name;
  out->q_unit = unit;
  out->q = at->q;
  out->v = at->v;
}

// Where e has a sign again behind a sample, it is negative.  Where friction holds fast, e stays
// zero.
static bool goes_below(pl_staging* s, const pl_trace* t, const pl_trace_sample* at, pl_expr e,
                       double size) {
  for (int i = 0; i < t->samples.n; i++) {
    if (t->samples.at[i].t <= at->t) continue;
    pl_rate r = rate_of(s, t, &t->samples.at[i], e);
    if (!is_zero(&r, size)) return r.value < 0;
  }
  return false;
}

// Which expressions the motion leaves at a sample: zero, and on their way below.
static bool leaves_at(pl_staging* s, const pl_trace* t, const pl_trace_sample* at,
                      const pl_expr* side, int n, pl_leaving* out) {
  out->leaves = false;
  for (int k = 0; k < n; k++) {
    pl_rate r = rate_of(s, t, at, side[k]);
    double size = size_of(s, t, side[k]);
    out->through[k] = is_zero(&r, size) && r.rate < 0 && goes_below(s, t, at, side[k], size);
    out->leaves |= out->through[k];
  }
  if (!out->leaves) return false;
  out->t = at->t;
  list_state(s->m->arena, t, at, out);
  return true;
}

bool pl_staging_leaves(void* staging, const pl_expr* side, int n, double from, double to,
                       pl_leaving* out) {
  pl_staging* s = staging;
  pleuel_model* m = s->m;
  if (!s->along || !has_numbers(m->model)) return false;
  if (pl_model_flat_coords(m->model, m->arena).n > MOST_COORDINATES) return false;
  const pl_trace* t = watched(s, side, n);
  if (!t->started) return false;
  *out = (pl_leaving){.through = PL_ARRAY(m->arena, bool, n + 1)};
  for (int i = 0; i < t->marks.n; i++) {
    const pl_trace_sample* at = &t->marks.at[i];
    bool begins = from > 0 && at->t <= from * (1 + 1e-9);  // it is there where it has just arrived
    if (begins || at->t > to * (1 - 1e-9)) continue;
    if (leaves_at(s, t, at, side, n, out)) return true;
  }
  out->t = fmin(to, t->t_end);
  return true;
}
