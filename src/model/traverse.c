// Every expression of a model, one after the other: used to take the units out, to write families
// out, and to see which names are used where. A new field of pl_model that holds expressions is
// added here, and then all of these know it.
#include "model_impl.h"

typedef struct slot_walk {
  pl_slot_visit* visit;
  void* user;
} slot_walk;

static void one(const slot_walk* w, pl_expr* e, pl_slot_kind kind, const pl_block* block,
                pl_span span) {
  pl_slot slot = {e, kind, block, span};
  w->visit(w->user, &slot);
}

static void point(const slot_walk* w, pl_point* p, const pl_block* block, pl_span span) {
  for (int i = 0; i < p->n && i < 3; i++)
    one(w, &p->at[i], PL_SLOT_POINT, block, p->span.source ? p->span : span);
}

static void label(const slot_walk* w, pl_name* name, const pl_block* block, pl_span span) {
  one(w, &name->index, PL_SLOT_LABEL_INDEX, block, span);
}

static void condition(const slot_walk* w, pl_condition* c, pl_slot_kind kind) {
  one(w, &c->left, kind, NULL, c->span);
  one(w, &c->right, kind, NULL, c->span);
}

static void declarations(const slot_walk* w, pl_model* m) {
  for (int i = 0; i < m->params.n; i++)
    one(w, &m->params.at[i].value, PL_SLOT_PARAM, NULL, m->params.at[i].span);
  for (int i = 0; i < m->coords.n; i++) {
    one(w, &m->coords.at[i].lo, PL_SLOT_BOUND, NULL, m->coords.at[i].span);
    one(w, &m->coords.at[i].hi, PL_SLOT_BOUND, NULL, m->coords.at[i].span);
  }
  for (int i = 0; i < m->lets.n; i++)
    one(w, &m->lets.at[i].value, PL_SLOT_LET, NULL, m->lets.at[i].span);
  for (int i = 0; i < m->blocks.n; i++) {
    pl_block* b = m->blocks.at[i];
    one(w, &b->lo, PL_SLOT_BOUND, b->outer, b->span);
    one(w, &b->hi, PL_SLOT_BOUND, b->outer, b->span);
    one(w, &b->step, PL_SLOT_BOUND, b->outer, b->span);
  }
  for (int i = 0; i < m->assumptions.n; i++) {
    pl_assumption* a = &m->assumptions.at[i];
    condition(w, &a->condition, PL_SLOT_ASSUMPTION);
    one(w, &a->subject, PL_SLOT_ASSUMPTION, NULL, a->span);
    one(w, &a->lo, PL_SLOT_ASSUMPTION, NULL, a->span);
    one(w, &a->hi, PL_SLOT_ASSUMPTION, NULL, a->span);
  }
}

static void physics(const slot_walk* w, pl_model* m) {
  for (int i = 0; i < m->masses.n; i++) {
    pl_mass* x = &m->masses.at[i];
    label(w, &x->name, x->block, x->span);
    one(w, &x->mass, PL_SLOT_MASS, x->block, x->span);
    point(w, &x->point, x->block, x->span);
  }
  for (int i = 0; i < m->bodies.n; i++) {
    pl_body* x = &m->bodies.at[i];
    label(w, &x->name, x->block, x->span);
    one(w, &x->mass, PL_SLOT_MASS, x->block, x->span);
    one(w, &x->inertia, PL_SLOT_MASS, x->block, x->span);
    one(w, &x->angle, PL_SLOT_POINT, x->block, x->span);
    point(w, &x->centre, x->block, x->span);
  }
  for (int i = 0; i < m->spatials.n; i++) {
    pl_spatial* x = &m->spatials.at[i];
    label(w, &x->name, x->block, x->span);
    one(w, &x->mass, PL_SLOT_MASS, x->block, x->span);
    for (int k = 0; k < 6; k++) one(w, &x->inertia[k], PL_SLOT_MASS, x->block, x->inertia_span);
    for (int k = 0; k < 9; k++) one(w, &x->axes[k], PL_SLOT_POINT, x->block, x->span);
    for (int k = 0; k < 9; k++) one(w, &x->turn[k], PL_SLOT_POINT, x->block, x->span);
    for (int k = 0; k < 3; k++) one(w, &x->spin[k], PL_SLOT_LOAD, x->block, x->span);
    point(w, &x->centre, x->block, x->span);
  }
  for (int i = 0; i < m->points.n; i++) {
    pl_place_def* x = &m->points.at[i];
    label(w, &x->name, x->block, x->span);
    point(w, &x->point, x->block, x->span);
  }
  for (int i = 0; i < m->gravities.n; i++)
    one(w, &m->gravities.at[i].g, PL_SLOT_GRAVITY, NULL, m->gravities.at[i].span);
  for (int i = 0; i < m->loads.n; i++) {
    pl_load* x = &m->loads.at[i];
    label(w, &x->name, x->block, x->span);
    one(w, &x->value, PL_SLOT_LOAD, x->block, x->span);
    one(w, &x->rest, PL_SLOT_LOAD, x->block, x->span);
    for (int k = 0; k < 3; k++) one(w, &x->vector[k], PL_SLOT_LOAD, x->block, x->span);
    for (int k = 0; k < 3; k++) one(w, &x->spin[k], PL_SLOT_LOAD, x->block, x->span);
    point(w, &x->a, x->block, x->span);
    point(w, &x->b, x->block, x->span);
  }
}

static void constraints(const slot_walk* w, pl_model* m) {
  for (int i = 0; i < m->constraints.n; i++) {
    pl_constraint* c = &m->constraints.at[i];
    label(w, &c->name, c->block, c->span);
    one(w, &c->left, PL_SLOT_CONSTRAINT, c->block, c->span);
    one(w, &c->right, PL_SLOT_CONSTRAINT, c->block, c->span);
    one(w, &c->g, PL_SLOT_CONSTRAINT, c->block, c->span);
  }
  for (int i = 0; i < m->restitutions.n; i++) {
    pl_restitution* x = &m->restitutions.at[i];
    one(w, &x->value, PL_SLOT_LOAD, x->block, x->span);
  }
  for (int i = 0; i < m->frictions.n; i++) {
    pl_friction* x = &m->frictions.at[i];
    one(w, &x->kinetic, PL_SLOT_LOAD, x->block, x->span);
    one(w, &x->sticking, PL_SLOT_LOAD, x->block, x->span);
    point(w, &x->surface, x->block, x->span);
    point(w, &x->at, x->block, x->span);
  }
  for (int i = 0; i < m->choose.n_maps; i++) {
    one(w, &m->choose.maps[i].old, PL_SLOT_CHOOSE, NULL, m->choose.maps[i].span);
    one(w, &m->choose.maps[i].map, PL_SLOT_CHOOSE, NULL, m->choose.maps[i].span);
  }
  for (int i = 0; i < m->branches.n; i++) condition(w, &m->branches.at[i], PL_SLOT_BRANCH);
}

static void start_and_events(const slot_walk* w, pl_model* m) {
  for (int i = 0; i < m->inits.n; i++) {
    pl_init* x = &m->inits.at[i];
    one(w, &x->time, PL_SLOT_INIT, x->block, x->span);
    one(w, &x->target, PL_SLOT_INIT, x->block, x->span);
    one(w, &x->value, PL_SLOT_INIT, x->block, x->span);
  }
  for (int i = 0; i < m->events.n; i++) {
    pl_event* e = &m->events.at[i];
    one(w, &e->name.index, PL_SLOT_LABEL_INDEX, NULL, e->span);
    one(w, &e->value, PL_SLOT_EVENT, NULL, e->span);
    for (int k = 0; k < e->actions.n; k++) {
      one(w, &e->actions.at[k].target, PL_SLOT_EVENT, NULL, e->actions.at[k].span);
      one(w, &e->actions.at[k].value, PL_SLOT_EVENT, NULL, e->actions.at[k].span);
    }
  }
}

static void requests(const slot_walk* w, pl_model* m) {
  for (int i = 0; i < m->asks.n; i++) {
    pl_ask* a = &m->asks.at[i];
    one(w, &a->value, PL_SLOT_ASK, NULL, a->span);
    for (int k = 0; k < a->where.n; k++) condition(w, &a->where.at[k], PL_SLOT_ASK);
    for (int k = 0; k < a->motion.n_from; k++) condition(w, &a->motion.from[k], PL_SLOT_ASK);
    one(w, &a->to, PL_SLOT_ASK, NULL, a->span);
    one(w, &a->substitution_left, PL_SLOT_ASK, NULL, a->span);
    one(w, &a->substitution_right, PL_SLOT_ASK, NULL, a->span);
  }
  for (int i = 0; i < m->outputs.n; i++)
    one(w, &m->outputs.at[i].value, PL_SLOT_OUTPUT, NULL, m->outputs.at[i].span);
  for (int i = 0; i < m->draws.n; i++) {
    point(w, &m->draws.at[i].a, NULL, m->draws.at[i].span);
    point(w, &m->draws.at[i].b, NULL, m->draws.at[i].span);
  }
  for (int i = 0; i < m->plots.n; i++) {
    pl_plot* p = &m->plots.at[i];
    for (int k = 0; k < p->y.n; k++) one(w, &p->y.at[k], PL_SLOT_PLOT, NULL, p->span);
    one(w, &p->x, PL_SLOT_PLOT, NULL, p->span);
  }
  pl_simulate* s = &m->simulate;
  one(w, &s->from, PL_SLOT_SIMULATE, NULL, s->span);
  one(w, &s->to, PL_SLOT_SIMULATE, NULL, s->span);
  one(w, &s->step, PL_SLOT_SIMULATE, NULL, s->span);
  one(w, &s->tol, PL_SLOT_SIMULATE, NULL, s->span);
}

void pl_model_each_slot(pl_model* m, pl_slot_visit* visit, void* user) {
  slot_walk w = {visit, user};
  declarations(&w, m);
  physics(&w, m);
  constraints(&w, m);
  start_and_events(&w, m);
  requests(&w, m);
}

// --------------------------------------------------------------------------------------- units out
// Numbers with units stay where formulas are made of them; where a number is read they become one.
static bool reads_number(pl_slot_kind k) {
  return k == PL_SLOT_PARAM || k == PL_SLOT_BOUND || k == PL_SLOT_LABEL_INDEX
         || k == PL_SLOT_ASSUMPTION || k == PL_SLOT_INIT || k == PL_SLOT_EVENT
         || k == PL_SLOT_SIMULATE;
}

// Those that stay are given quantities like any parameter with a number.
static void keep_measures(pl_model* m, pl_expr e, pl_span span) {
  int n = pl_symbols_in(m->pool, e, NULL, 0);
  pl_arena* a = pl_pool_arena(m->pool);
  pl_symbol* s = PL_ARRAY(a, pl_symbol, n + 1);
  pl_symbols_in(m->pool, e, s, n);
  for (int i = 0; i < n; i++) {
    const pl_symbol_info* info = pl_symbol_get(m->pool, s[i]);
    if (pl_is_poison(info->number) || pl_model_param(m, s[i])) continue;
    pl_push(a, m->params,
            (pl_param){.symbol = s[i],
                       .value = info->number,
                       .has_unit = true,
                       .literal = true,
                       .span = span});
  }
}

static void strip_slot(void* user, const pl_slot* slot) {
  pl_model* m = user;
  if (pl_is_poison(*slot->at) || !pl_unit_occurs(m->pool, *slot->at)) return;
  if (reads_number(slot->kind)) *slot->at = pl_unit_to_si(m->pool, *slot->at);
  else {
    *slot->at = pl_unit_drop(m->pool, *slot->at);
    keep_measures(m, *slot->at, slot->span);
  }
}

void pl_strip_units(pl_model* m) { pl_model_each_slot(m, strip_slot, m); }

// ------------------------------------------------------------------------------------- what occurs
// pl_is_constant for a pass that asks at every node: remembers the answers.
bool pl_is_constant_known(const pl_pool* p, pl_map* known, pl_expr e) {
  switch (pl_kind_of(p, e)) {
    case PL_NUMBER:
    case PL_PI:
    case PL_INFINITY:
    case PL_POISON: return true;
    case PL_SYMBOL:
    case PL_AT:
    case PL_SUM:
    case PL_UNKNOWN_FUNCTION: return false;
    default: break;
  }
  uint64_t answer = pl_map_get(known, e.id);
  if (answer) return answer == 2;
  bool constant = true;
  for (int i = 0; i < pl_n_args(p, e) && constant; i++)
    constant = pl_is_constant_known(p, known, pl_arg(p, e, i));
  pl_map_set(known, e.id, constant ? 2 : 1);
  return constant;
}

static int max_dots(const pl_pool* p, pl_expr e, pl_map* visited) {
  if (pl_is_poison(e) || pl_map_get(visited, e.id)) return 0;
  pl_map_set(visited, e.id, 1);
  pl_kind kind = pl_kind_of(p, e);
  int most = 0;
  if (kind == PL_AT) most = pl_dots_of(p, e);
  if (kind == PL_SYMBOL) {
    const pl_symbol_info* info = pl_symbol_get(p, pl_symbol_of(p, e));
    bool moves = info->role == PL_R_VELOCITY || info->role == PL_R_ACCELERATION;
    most = moves ? info->dots : 0;
  }
  for (int i = 0; i < pl_n_args(p, e); i++) {
    int k = max_dots(p, pl_arg(p, e, i), visited);
    if (k > most) most = k;
  }
  return most;
}

// 1 when velocities occur, 2 when accelerations do; elements of families count.
int pl_max_dots(const pl_pool* p, pl_expr e, pl_arena* scratch) {
  if (pl_is_poison(e) || pl_is_constant(p, e)) return 0;
  return max_dots(p, e, pl_map_make(scratch));
}

static bool moves(const pl_pool* p, pl_expr e, pl_map* visited) {
  if (pl_is_poison(e) || pl_map_get(visited, e.id)) return false;
  pl_map_set(visited, e.id, 1);
  pl_kind kind = pl_kind_of(p, e);
  if (kind == PL_AT) return true;
  if (kind == PL_SYMBOL) {
    pl_role r = pl_symbol_get(p, pl_symbol_of(p, e))->role;
    return r == PL_R_COORD || r == PL_R_VELOCITY || r == PL_R_ACCELERATION;
  }
  for (int i = 0; i < pl_n_args(p, e); i++) {
    if (moves(p, pl_arg(p, e, i), visited)) return true;
  }
  return false;
}

bool pl_has_coordinate(const pl_pool* p, pl_expr e, pl_arena* scratch) {
  return !pl_is_poison(e) && !pl_is_constant(p, e) && moves(p, e, pl_map_make(scratch));
}
