// The motion of bodies with Euler angles as it is integrated: with unit quaternions in the places
// of their angles (model/turned.c). Coordinates, columns and events are those of the model as
// declared.
// See theory (8.2).
#include <math.h>
#include <string.h>

#include "assembly/assembly_impl.h"

// Angles that observers still speak of stand behind all coordinates.
static void place_angles(pl_recorder* r, const pl_turned* t) {
  pl_attitude_setup* turns = PL_ARRAY(r->arena, pl_attitude_setup, t->places.n);
  for (int i = 0; i < t->places.n; i++) {
    const pl_turned_place* p = &t->places.at[i];
    memcpy(turns[i].angle, p->at, sizeof p->at);
    turns[i].scalar = p->scalar;
    for (int k = 0; k < 3; k++)
      pl_map_set(r->flat_at, p->angle[k].id, (uint64_t)(r->out->flat.n + 3 * i + k) + 1);
  }
  r->out->setup.attitudes = turns;
  r->out->setup.n_attitudes = t->places.n;
}

// Names and units as declared; what is new has no column.
static void name_as_declared(const pl_recorder* r, const pl_recording* declared) {
  pl_coordinate* q = PL_ARRAY(r->arena, pl_coordinate, r->out->flat.n + 1);
  for (int i = 0; i < r->out->flat.n; i++) {
    q[i] = r->out->setup.coordinates[i];
    q[i].hidden = i >= declared->flat.n;
    if (q[i].hidden) continue;
    const pl_coordinate* as = &declared->setup.coordinates[i];
    q[i].name = as->name;
    q[i].unit = as->unit;
    q[i].v_name = as->v_name;
    q[i].v_unit = as->v_unit;
  }
  r->out->setup.coordinates = q;
  pl_constraint_setup* constraint = PL_ARRAY(r->arena, pl_constraint_setup, r->n_constraints + 1);
  memcpy(constraint, r->out->setup.constraints, (size_t)r->n_constraints * sizeof *constraint);
  for (int i = 0; i < r->model->constraints.n; i++) {
    const pl_constraint* c = &r->model->constraints.at[i];
    int last = i + 1 < r->model->constraints.n ? r->first_constraint[i + 1] : r->out->n_declared;
    for (int k = r->first_constraint[i]; c->body && !c->lambda.id && k < last; k++)
      constraint[k].column = NULL;
  }
  r->out->setup.constraints = constraint;
}

// φ = ..., or φ' = ... of nothing else that moves.
static bool holds(const pl_recorder* r, const pl_constraint* c, pl_symbol angle) {
  pl_symbol rate = pl_symbol_dot(r->pool, angle);
  if (!c->has_velocity) return pl_has_symbol(r->pool, c->g, angle);
  return pl_has_symbol(r->pool, c->g, rate)
         && !pl_has_role(r->pool, pl_subst1(r->pool, c->g, rate, pl_int(r->pool, 0)),
                         PL_R_VELOCITY);
}

// A constraint that holds the precession or the spin makes their sum and difference known
// everywhere.
static bool is_held(const pl_recorder* r, const pl_spatial* b) {
  for (int i = 0; i < r->model->constraints.n; i++) {
    const pl_constraint* c = &r->model->constraints.at[i];
    if (c->relation != PL_EQ || c->off || c->while_label) continue;
    for (int k = 0; k < 3; k += 2)
      if (holds(r, c, pl_symbol_of(r->pool, b->axes[k]))) return true;
  }
  return false;
}

static bool is_angle(const pl_recorder* r, pl_expr e) {
  pl_kind kind = pl_kind_of(r->pool, e);
  return kind == PL_SYMBOL || kind == PL_AT;
}

void pl_record_poles(pl_recorder* r) {
  PL_VEC(int) poles = {0};
  for (int i = 0; i < r->model->spatials.n; i++) {
    const pl_spatial* b = &r->model->spatials.at[i];
    bool free = b->form == PL_AXES_EULER;
    for (int k = 0; k < 3; k++) free = free && is_angle(r, b->axes[k]);
    for (int k = 0; free && !is_held(r, b) && k < r->out->flat.n; k++)
      if (pl_symbol_of(r->pool, r->out->flat.at[k]).id == pl_symbol_of(r->pool, b->axes[1]).id)
        pl_push(r->arena, poles, k);
  }
  r->out->setup.poles = poles.at;
  r->out->setup.n_poles = poles.n;
}

pleuel_status pl_record_turned(const pl_recorder* as) {
  pl_turned t;
  bool turned = pl_model_turned(as->job, as->model, &t);
  as->out->angles_kept = t.why;
  if (!turned) return PLEUEL_OK;
  pl_recorder r = {.job = as->job,
                   .arena = as->arena,
                   .model = t.model,
                   .pool = as->pool,
                   .out = PL_NEW(as->arena, pl_recording)};
  pl_record_begin(&r);
  place_angles(&r, &t);
  if (as->start_settled) memcpy(r.value, as->value, (size_t)as->n_value * sizeof *r.value);
  r.start_settled = as->start_settled;
  PL_TRY(pl_record_model(&r));
  name_as_declared(&r, as->out);
  as->out->turned = r.out;
  return PLEUEL_OK;
}
