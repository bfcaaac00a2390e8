// Stages of a motion, from its trace.
#include "api/stages.h"

#include <math.h>
#include <string.h>

#include "api/trace.h"

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
static void list_rubs(pl_arena* a, const pl_trace* t, const pl_trace_phase* p, pl_stage* out) {
  const pl_setup* s = &t->recording->setup;
  pl_stage_rub* rub = PL_ARRAY(a, pl_stage_rub, s->n_rubs + 1);
  out->rubs = rub;
  out->n_rubs = s->n_rubs;
  out->rubs_known = true;
  for (int i = 0; i < s->n_rubs; i++) {
    const pl_friction_law* law = &t->recording->laws[i];
    const pl_rub_report* now = &p->rubs[i];
    rub[i] = (pl_stage_rub){.on = s->rubs[i].name,
                            .name = s->links[s->rubs[i].row[0]].name,
                            .slip = law->slip,
                            .limit = law->limit,
                            .scale = law->scale,
                            .sticks = now->mode == PL_RUB_STICKS,
                            .slips = now->mode == PL_RUB_SLIPS,
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
    name[c] = s->links[c].name;
    rope[c] = s->links[c].rope;
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
  list_rubs(a, t, p, out);
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
    if (!known) out->stages[out->n++] = *s;
  }
}

pl_staging* pl_staging_make(pleuel_model* m, bool along) {
  pl_staging* out = PL_NEW(m->arena, pl_staging);
  out->m = m;
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
