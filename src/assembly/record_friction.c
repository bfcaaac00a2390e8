// record, friction: rows of slip and coefficients of each constraint with friction.
//
// In the plane the slip velocity is one row, along the tangent t = (n_y, -n_x); in space it is the
// three components of its part in the tangent plane. The rows follow the map equations in the
// numbering of the links, instance by instance.
#include "assembly/contact_geometry.h"

static pl_expr unit_normal(pl_pool* p, const pl_contact_touch* t, int j) {
  return pl_div(p, t->force[j], t->size);
}

static void in_the_plane(pl_recorder* r, const pl_contact_touch* t, pl_friction_source* s) {
  pl_pool* p = r->pool;
  s->n_rows = 1;
  s->slip[0] = pl_sub(p, pl_mul(p, unit_normal(p, t, 1), t->slip[0]),
                      pl_mul(p, unit_normal(p, t, 0), t->slip[1]));
}

static void in_space(pl_recorder* r, const pl_contact_touch* t, pl_friction_source* s) {
  static const int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
  pl_pool* p = r->pool;
  pl_expr n[3], square = pl_int(p, 0), along = pl_int(p, 0);
  s->n_rows = 3;
  for (int j = 0; j < 3; j++) n[j] = unit_normal(p, t, j);
  for (int j = 0; j < 3; j++) along = pl_add(p, along, pl_mul(p, n[j], t->slip[j]));
  for (int j = 0; j < 3; j++) s->slip[j] = pl_sub(p, t->slip[j], pl_mul(p, n[j], along));
  for (int j = 0; j < 3; j++) square = pl_add(p, square, pl_square(p, s->slip[j]));
  for (int j = 0; j < 3; j++)
    s->along[j] = pl_div(p, pl_mul(p, s->scale, s->slip[j]), pl_sqrt(p, square));
  for (int k = 0; k < 6; k++) {
    pl_expr both = pl_mul(p, n[pair[k][0]], n[pair[k][1]]);
    s->metric[k] = k < 3 ? pl_sub(p, pl_int(p, 1), both) : pl_neg(p, both);
  }
}

static void tell_place(pl_recorder* r, const pl_friction* f, const pl_contact_touch* t) {
  const char* x = pl_expr_text(r->arena, r->pool, t->place[0]);
  const char* y = pl_expr_text(r->arena, r->pool, t->place[1]);
  pl_diagnostic* d = pl_report(
      r->job->diagnostics, PL_N069, f->span,
      PL_BOTH_FORMAT(r->arena, "friction on %s acts at (%s, %s)", f->label, x, y));
  pl_report_fix(d, PL_BOTH("another place is written: friction ..., at (x, y) on ..."), NULL);
}

static pleuel_status add_source(pl_recorder* r, pl_record_group* g, int i, const pl_friction* f) {
  pl_pool* p = r->pool;
  const pl_constraint* c = &r->model->constraints.at[i];
  pl_contact_touch t;
  if (!pl_contact_geometry(r, c, f, &t)) return PLEUEL_MODEL_ERROR;
  if (t.n < 2) {
    pl_report(r->job->diagnostics, PL_E066, f->span,
              PL_BOTH_FORMAT(r->arena, "there is no direction along which anything slides on %s",
                             f->label));
    return PLEUEL_MODEL_ERROR;
  }
  pl_friction_source* s = PL_NEW(r->arena, pl_friction_source);
  *s = (pl_friction_source){.constraint = i,
                            .group = g,
                            .first_row = r->n_constraints,
                            .first_coefficient = r->out->setup.n_coefficients};
  s->scale = pl_mul(p, f->kinetic, t.size);
  s->limit = pl_is_poison(f->sticking) ? s->scale : pl_mul(p, f->sticking, t.size);
  if (t.n == 2) in_the_plane(r, &t, s);
  else in_space(r, &t, s);
  s->n_coefficients = s->n_rows == 1 ? 2 : 11;
  for (int k = 0; k < s->n_rows; k++) {
    s->slip[k] = pl_record_plain(r, s->slip[k]);
    pl_group_atoms(r, g, s->slip[k]);
  }
  pl_group_atoms(r, g, s->scale);
  pl_group_atoms(r, g, s->limit);
  r->n_constraints += s->n_rows * g->instances.n;
  r->out->setup.n_coefficients += s->n_coefficients * g->instances.n;
  r->dissipative = true;
  if (t.placed) tell_place(r, f, &t);
  pl_push(r->arena, r->frictions, s);
  pl_push(r->arena, g->frictions, r->frictions.n - 1);
  return PLEUEL_OK;
}

pleuel_status pl_group_friction(pl_recorder* r, pl_record_group* g) {
  for (int k = 0; k < g->constraints.n; k++) {
    int i = g->constraints.at[k];
    const pl_friction* f = pl_model_friction(r->model, &r->model->constraints.at[i]);
    if (f) PL_TRY(add_source(r, g, i, f));
  }
  return PLEUEL_OK;
}

// ------------------------------------------------------------------------------------ coefficients
// ORDER RUB: limit, scale; in space along[3], metric[6].
pl_expr pl_record_friction_coefficient(const pl_friction_source* s, int k) {
  if (k < 2) return k == 0 ? s->limit : s->scale;
  return k < 5 ? s->along[k - 2] : s->metric[k - 5];
}

// ------------------------------------------------------------------------------------------- links
static void name_row(pl_recorder* r, const pl_friction_source* s, int k,
                     const pl_constraint_setup* of, int constraint, pl_constraint_setup* out) {
  *out = (pl_constraint_setup){.name = pl_format(r->arena, "friction %s", of->name),
                               .velocity = true,
                               .slip = true,
                               .priority = 2,
                               .off = true,
                               .contact = of->side != 0 ? constraint : of->contact};
  if (s->n_rows == 1) {
    out->column = pl_format(r->arena, "friction_%s", of->name);
    out->unit = r->model->uses_units ? "N" : "";
  }
  (void)k;
}

void pl_record_frictions(pl_recorder* r, pl_constraint_setup* constraint) {
  int n = 0, at = 0;
  for (int i = 0; i < r->frictions.n; i++) n += r->frictions.at[i]->group->instances.n;
  pl_friction_setup* friction = PL_ARRAY(r->arena, pl_friction_setup, n + 1);
  pl_friction_law* law = PL_ARRAY(r->arena, pl_friction_law, n + 1);
  for (int i = 0; i < r->frictions.n; i++) {
    const pl_friction_source* s = r->frictions.at[i];
    for (int k = 0; k < s->group->instances.n; k++) {
      int first = s->first_coefficient + k * s->n_coefficients;
      bool plain = s->n_rows == 1 && !s->group->block;
      law[at] = plain ? (pl_friction_law){s->slip[0], s->limit, s->scale}
                      : (pl_friction_law){pl_poison(), pl_poison(), pl_poison()};
      pl_friction_setup* out = &friction[at++];
      *out = (pl_friction_setup){.constraint = r->first_constraint[s->constraint] + k,
                                 .n_rows = s->n_rows,
                                 .limit = first,
                                 .scale = first + 1};
      out->name = constraint[out->constraint].name;
      for (int j = 0; j < s->n_rows; j++) {
        out->row[j] = s->first_row + k * s->n_rows + j;
        name_row(r, s, j, &constraint[out->constraint], out->constraint, &constraint[out->row[j]]);
      }
      for (int j = 0; j < 3 && s->n_rows == 3; j++) out->along[j] = first + 2 + j;
      for (int j = 0; j < 6 && s->n_rows == 3; j++) out->metric[j] = first + 5 + j;
    }
  }
  r->out->laws = law;
  r->out->setup.frictions = friction;
  r->out->setup.n_frictions = n;
}

// -------------------------------------------------------------------------------- columns in space
// Multipliers of the rows have names before anything has a value, so that the tables of values have
// room for them.
void pl_record_friction_symbols(pl_recorder* r) {
  for (int i = 0; i < r->model->constraints.n && r->model->n_axes == 3; i++) {
    const pl_constraint* c = &r->model->constraints.at[i];
    if (!pl_model_friction(r->model, c)) continue;
    for (int k = 0; k < 3; k++) {
      const char* name = pl_format(r->arena, "rub_%s_%d",
                                   c->name.ascii ? c->name.ascii : c->name.text, k);
      if (!pl_symbol_find(r->pool, name).id)
        pl_symbol_make(
            r->pool,
            &(pl_symbol_info){
                .name = name, .ascii = name, .role = PL_R_MULTIPLIER, .class = PL_C_OTHER});
    }
  }
}

static pl_symbol symbol_of_row(pl_recorder* r, const pl_friction_source* s, int k) {
  const pl_constraint* c = &r->model->constraints.at[s->constraint];
  return pl_symbol_find(
      r->pool, pl_format(r->arena, "rub_%s_%d", c->name.ascii ? c->name.ascii : c->name.text, k));
}

// Row of a multiplier of slip, -1: it is none.
int pl_record_friction_row(pl_recorder* r, pl_symbol lambda) {
  for (int i = 0; i < r->frictions.n; i++)
    for (int k = 0; k < r->frictions.at[i]->n_rows; k++)
      if (symbol_of_row(r, r->frictions.at[i], k).id == lambda.id)
        return r->frictions.at[i]->first_row + k;
  return -1;
}

// Component j of the friction force: the multipliers in the tangent plane.
pl_expr pl_record_friction_force(pl_recorder* r, const pl_friction_source* s, int j) {
  static const int entry[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  pl_expr sum = pl_int(r->pool, 0);
  for (int k = 0; k < 3; k++)
    sum = pl_add(r->pool, sum,
                 pl_mul(r->pool, s->metric[entry[j][k]], pl_sym(r->pool, symbol_of_row(r, s, k))));
  return sum;
}
