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
