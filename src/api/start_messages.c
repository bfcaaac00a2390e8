// A start that does not fit the constraints, as messages with a place and a fix: E041 and E043.
#include <math.h>
#include <string.h>

#include "api/api_impl.h"

// Where the start value of a coordinate stands; no place when it was not given.
static pl_span init_span(const pleuel_model* m, int coordinate, bool velocity) {
  const pl_model* model = m->model;
  const pl_pool* p = model->pool;
  pl_expr atom = m->recording->flat.at[coordinate];
  for (int i = 0; i < model->inits.n; i++) {
    pl_expr target = model->inits.at[i].target;
    if (pl_kind_of(p, target) != PL_SYMBOL) continue;
    const pl_symbol_info* info = pl_symbol_get(p, pl_symbol_of(p, target));
    bool is_velocity = info->role == PL_R_VELOCITY;
    pl_symbol base = is_velocity ? info->base : pl_symbol_of(p, target);
    if (pl_kind_of(p, atom) == PL_SYMBOL && base.id == pl_symbol_of(p, atom).id && is_velocity == velocity) {
      return model->inits.at[i].span;
    }
  }
  return (pl_span){0};
}

// The constraint of the model that a row belongs to; NULL for map equations.
static const pl_constraint* constraint_of_link(const pleuel_model* m, int link) {
  const char* name = m->recording->setup.links[link].name;
  return link < m->recording->n_declared ? pl_model_constraint(m->model, name) : NULL;
}

static void report_violated(pleuel_model* m) {
  const pl_start_report* r = &m->start;
  const pl_setup* s = &m->recording->setup;
  const pl_link* link = &s->links[r->link];
  const pl_constraint* c = constraint_of_link(m, r->link);
  pl_span span = r->move_coordinate >= 0 ? init_span(m, r->move_coordinate, r->move_velocity) : (pl_span){0};
  if (!span.source && c) span = c->span;
  const char* en = r->link_velocity ? "the start velocity violates %s" : "the start violates %s";
  const char* de = r->link_velocity ? "die Startgeschwindigkeit verletzt %s" : "der Start verletzt %s";
  pl_diagnostic* d = pl_report(&m->diagnostics, PL_E041, span, pl_format(m->arena, en, link->name), pl_format(m->arena, de, link->name));
  if (r->move_coordinate < 0) return;
  const pl_coordinate* q = &s->coordinates[r->move_coordinate];
  const char* name = r->move_velocity ? q->v_name : q->name;
  const char* unit = r->move_velocity ? q->v_unit : q->unit;
  const char* blank = unit && *unit ? " " : "";
  if (!unit) unit = "";
  pl_report_fix(d, pl_format(m->arena, "%s = %.6g%s%s would fit. Change it, or remove it from init and let it follow", name, r->move_to, blank, unit),
                pl_format(m->arena, "%s = %.6g%s%s würde passen. Ändern, oder aus init entfernen und folgen lassen", name, r->move_to, blank, unit), NULL);
}

// A condition that tells two candidates apart: the coordinate against one of the same letter that lies between (x2 < x1), or
// against a number.
static void report_several(pleuel_model* m) {
  const pl_start_report* r = &m->start;
  const pl_setup* s = &m->recording->setup;
  const double *a = r->candidates, *b = r->candidates + s->n_q;
  int differs = 0;
  for (int i = 1; i < s->n_q; i++) {
    bool own = !s->coordinates[i].has_q;
    if (own && fabs(a[i] - b[i]) > fabs(a[differs] - b[differs]) * (1 + 1e-9)) differs = i;
  }
  double lo = fmin(a[differs], b[differs]), hi = fmax(a[differs], b[differs]);
  const char* between = NULL;
  for (int i = 0; i < s->n_q && !between; i++) {
    bool same_letter = s->coordinates[i].name[0] == s->coordinates[differs].name[0];
    if (i != differs && same_letter && a[i] == b[i] && lo < a[i] && a[i] < hi) between = s->coordinates[i].name;
  }
  if (!between) between = lo < 0 && hi > 0 ? "0" : pl_format(m->arena, "%.4g", 0.5 * (lo + hi));
  const char* name = s->coordinates[differs].name;
  pl_span where = m->model->inits.n > 0 ? m->model->inits.at[0].span : (pl_span){0};
  pl_diagnostic* d = pl_report(&m->diagnostics, PL_E043, where,
    pl_format(m->arena, "%d solutions of the constraints fit the start; choose one", r->n_candidates),
    pl_format(m->arena, "%d Lösungen der Zwangsbedingungen passen zum Start; eine ist zu wählen", r->n_candidates));
  pl_report_fix(d, pl_format(m->arena, "add  branch %s < %s   or   branch %s > %s", name, between, name, between),
                pl_format(m->arena, "branch %s < %s   oder   branch %s > %s   hinzufügen", name, between, name, between), NULL);
}

void pl_start_report_trouble(pleuel_model* m) {
  if (m->start_reported) return;
  m->start_reported = true;
  for (int i = 0; i < m->diagnostics.list.n; i++) {      // the derivation may have said it already
    if (m->diagnostics.list.at[i].code == PL_E041 || m->diagnostics.list.at[i].code == PL_E043) return;
  }
  if (m->start.trouble == PL_START_VIOLATED && m->start.link >= 0) report_violated(m);
  if (m->start.trouble == PL_START_SEVERAL && m->start.n_candidates > 1) report_several(m);
  pl_diagnostics_sort(&m->diagnostics);
}
