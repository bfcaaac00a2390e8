// contact_sets: which constraints the equations contain. Contacts open and close, constraints are
// released and attached; each set
// that holds for a while has equations of its own, and an analysis of its own derives them. What
// holds when was found by the
// simulation (pl_stage); without numbers the signs at the start decide where they are provable, and
// the rest is taken as closed.
//
// Needs a model whose families are written out.
#include <string.h>

#include "mechanics/mechanics.h"

int pl_stage_row(const pl_stage* s, const char* name) {
  for (int i = 0; s && i < s->n; i++) {
    if (strcmp(s->name[i], name) == 0) return i;
  }
  return -1;
}

const char* pl_stage_label(const pl_constraint* c) {
  return c->name.ascii ? c->name.ascii : c->name.text;
}

static const char* map_name(pl_analysis* d, const pl_model* m, int k) {
  return pl_format(d->arena, "choose %s", pl_expr_text(d->arena, d->pool, m->choose.maps[k].old));
}

static pl_expr at_start(pl_analysis* d, const pl_model* m, pl_expr e) {
  for (int k = 0; k < m->inits.n; k++) {
    const pl_init* init = &m->inits.at[k];
    if (init->guess || pl_kind_of(d->pool, init->target) != PL_SYMBOL) continue;
    e = pl_subst1(d->pool, e, pl_symbol_of(d->pool, init->target), init->value);
  }
  return e;
}

// The sign of g of a contact at the start, or of its derivative where g is zero there: 1 open. Only
// what is proven.
static bool is_open_by_signs(pl_analysis* d, const pl_model* m, pl_tower* t,
                             const pl_constraint* c) {
  if (c->relation == PL_EQ || c->has_velocity) return false;
  int side = c->relation == PL_GE ? 1 : -1, sign = 0;
  pl_expr g = at_start(d, m, c->g);
  if (pl_has_coordinates(d, g)) return false;
  if (pl_alg_is_zero(t, g) == PL_YES) {
    g = at_start(d, m, pl_dt(d->pool, c->g));
    if (pl_has_coordinates(d, g)) return false;
  }
  return pl_alg_sign(t, g, false, &sign) == PL_YES && side * sign > 0;
}

static void leave_out(pl_analysis* d, const pl_constraint* c, bool released) {
  pl_push(
      d->arena, d->open,
      (pl_open){.source = c, .contact = c->relation != PL_EQ, .released = released, .off = c->off});
}

// Where signs decided, what they assumed is on record.
void pl_use_signs_of_open(pl_analysis* d) {
  for (int k = 0; k < d->open.n && !d->stage; k++) {
    const pl_open* o = &d->open.at[k];
    pl_expr g = at_start(d, d->whole, o->source->g);
    if (o->contact && !o->off)
      pl_tower_use(d->tower,
                   (pl_fact){o->source->relation == PL_GE ? g : pl_neg(d->pool, g), true});
  }
}

static bool is_left_out(const pl_analysis* d, const char* label) {
  for (int k = 0; k < d->open.n; k++) {
    const pl_name* name = &d->open.at[k].source->name;
    if (strcmp(name->text, label) == 0 || (name->ascii && strcmp(name->ascii, label) == 0))
      return true;
  }
  return false;
}

bool pl_knows_friction(const pl_analysis* d) {
  return d->model->frictions.n == 0 || (d->stage && d->stage->rubs_known);
}

const pl_stage_rub* pl_slipping_on(const pl_analysis* d, const pl_constraint* c) {
  for (int k = 0; d->stage && k < d->stage->n_rubs; k++) {
    const pl_stage_rub* rub = &d->stage->rubs[k];
    if (rub->slips && strcmp(rub->on, pl_stage_label(c)) == 0) return rub;
  }
  return NULL;
}

// Surfaces that stick are a constraint between velocities; its multiplier is the friction along the
// tangent.
static void add_sticking(pl_analysis* d, pl_model* m) {
  for (int k = 0; d->stage && k < d->stage->n_rubs; k++) {
    const pl_stage_rub* rub = &d->stage->rubs[k];
    if (!rub->sticks) continue;
    const char* name = pl_format(d->arena, "friction_%s", rub->on);
    pl_symbol s = pl_symbol_find(d->pool, name);
    if (!s.id)
      s = pl_symbol_make(
          d->pool, &(pl_symbol_info){
                       .name = name, .ascii = name, .role = PL_R_MULTIPLIER, .class = PL_C_OTHER});
    const pl_constraint* on = pl_model_constraint(d->whole, rub->on);
    pl_constraint c = {.name = {.text = rub->name, .ascii = rub->name, .index = pl_poison()},
                       .left = rub->slip,
                       .right = pl_int(d->pool, 0),
                       .g = rub->slip,
                       .relation = PL_EQ,
                       .lambda = s,
                       .redundant_ok = true,
                       .has_velocity = true,
                       .sticking = true,
                       .span = on ? on->span : (pl_span){0}};
    pl_push(d->arena, m->constraints, c);
  }
}

static void choose_constraints(pl_analysis* d, const pl_model* whole, pl_model* m) {
  pl_tower* t = d->stage ? NULL : pl_setup_tower(d);
  m->constraints.n = m->constraints.cap = 0;
  m->constraints.at = NULL;
  for (int k = 0; k < whole->constraints.n; k++) {
    const pl_constraint* c = &whole->constraints.at[k];
    int row = pl_stage_row(d->stage, pl_stage_label(c));
    bool holds = row >= 0 ? d->stage->holds[row]
                          : !c->off && !(t && is_open_by_signs(d, whole, t, c));
    if (row < 0 && c->while_label && is_left_out(d, c->while_label)) holds = false;
    if (!holds) {
      leave_out(d, c, row >= 0 ? d->stage->released[row] : c->off);
      continue;
    }
    pl_constraint kept = *c;
    kept.off = false;
    pl_push(d->arena, m->constraints, kept);
  }
  if (t) pl_tower_free(t);
}

static bool is_named_by(const pl_analysis* d, const pl_choose* c, pl_symbol s) {
  for (int k = 0; k < c->n_maps; k++) {
    if (pl_has_symbol(d->pool, c->maps[k].map, s)) return true;
  }
  return false;
}

// Maps go with the constraints that they take for granted, and with them the names that only they
// explain.
static void choose_maps(pl_analysis* d, const pl_model* whole, pl_model* m) {
  pl_choose* c = &m->choose;
  c->maps = PL_ARRAY(d->arena, struct pl_map_equation, whole->choose.n_maps + 1);
  c->n_maps = 0;
  for (int k = 0; k < whole->choose.n_maps; k++) {
    int row = pl_stage_row(d->stage, map_name(d, whole, k));
    if (row < 0 || d->stage->holds[row]) c->maps[c->n_maps++] = whole->choose.maps[k];
  }
  c->coords.at = NULL;
  c->coords.n = c->coords.cap = 0;
  for (int k = 0; k < whole->choose.coords.n; k++) {
    pl_symbol s = whole->choose.coords.at[k];
    if (is_named_by(d, &whole->choose, s) && !is_named_by(d, c, s))
      pl_push(d->arena, d->unnamed, s);
    else pl_push(d->arena, c->coords, s);
  }
}

void pl_choose_set(pl_analysis* d, pl_model* whole, const pl_stage* stage) {
  d->whole = whole;
  d->stage = stage;
  d->model = PL_NEW(d->arena, pl_model);
  *d->model = *whole;
  choose_constraints(d, whole, d->model);
  add_sticking(d, d->model);
  choose_maps(d, whole, d->model);
}

// -------------------------------------------------------------------------------------- other sets
bool pl_is_same_set(const pl_analysis* d, const pl_stage* s) {
  const pl_model* m = d->whole;
  for (int k = 0; k < m->constraints.n; k++) {
    const char* label = pl_stage_label(&m->constraints.at[k]);
    int row = pl_stage_row(s, label);
    if (row >= 0 && s->holds[row] == is_left_out(d, label)) return false;
  }
  int n = d->stage ? d->stage->n_rubs : 0;
  if (n != s->n_rubs) return n == 0 && s->n_rubs == 0;
  for (int k = 0; k < n; k++) {
    const pl_stage_rub *a = &d->stage->rubs[k], *b = &s->rubs[k];
    if (a->sticks != b->sticks || a->slips != b->slips) return false;
    if (a->slips && a->way * a->press != b->way * b->press) return false;
  }
  return true;
}

// The set of constraints that an analysis was derived for, as a stage of its own.
pl_stage* pl_stage_like(pl_analysis* d) {
  pl_stage* s = PL_NEW(d->arena, pl_stage);
  if (d->stage) {
    *s = *d->stage;
    return s;
  }
  int n = d->whole->constraints.n;
  const char** name = PL_ARRAY(d->arena, const char*, n + 1);
  bool *holds = PL_ARRAY(d->arena, bool, n + 1), *no = PL_ARRAY(d->arena, bool, n + 1);
  for (int k = 0; k < n; k++) {
    name[k] = pl_stage_label(&d->whole->constraints.at[k]);
    holds[k] = !is_left_out(d, name[k]);
  }
  *s = (pl_stage){.n = n, .name = name, .holds = holds, .released = no, .pulls = no, .rope = no};
  return s;
}

// The same constraints with other signs: those that change come first.
pl_stage* pl_stage_turned(pl_analysis* d, const pl_fact* side, int n, const bool* through) {
  pl_stage* s = pl_stage_like(d);
  pl_fact* out = PL_ARRAY(d->arena, pl_fact, n + 1);
  int turns = 0, stays = 0;
  for (int k = 0; k < n; k++) turns += through[k];
  s->sides = out;
  s->n_sides = n;
  s->n_crossed = turns;
  for (int k = 0; k < n; k++) {
    pl_expr e = side[k].difference;
    if (through[k]) out[--turns] = (pl_fact){pl_neg(d->pool, e), side[k].strict};
    else out[s->n_crossed + stays++] = side[k];
  }
  return s;
}

// A body at rest may lie on what is open at the start: the set with every contact closed. NULL when
// none is open.
pl_stage* pl_stage_all_closed(pl_analysis* d) {
  bool any = false;
  for (int k = 0; k < d->open.n; k++) any |= d->open.at[k].contact && !d->open.at[k].released;
  if (!any || !d->stage) return NULL;
  pl_stage* s = PL_NEW(d->arena, pl_stage);
  *s = *d->stage;
  bool *holds = PL_ARRAY(d->arena, bool, s->n + 1), *none = PL_ARRAY(d->arena, bool, s->n + 1);
  for (int i = 0; i < s->n; i++) holds[i] = !s->released[i];
  s->holds = holds;
  s->pulls = none;
  s->end = PL_END_UNKNOWN;
  return s;
}
