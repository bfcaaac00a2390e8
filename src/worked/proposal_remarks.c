// proposal_remarks: what is said about proposed coordinates, and their definitions in the values
// that use them.
#include "mechanics/propose.h"
#include "worked/worked_impl.h"

// "x = l cos φ, y = l sin φ": the maps of all that the new angles give, or of what is solved for a
// leading coordinate.
static const pl_form* maps_form(pl_analysis* a, int* n) {
  const pl_form** f = PL_ARRAY(a->arena, const pl_form*, a->q.n + 1);
  *n = 0;
  for (int i = 0; i < a->q.n; i++) {
    const pl_variable* c = &a->q.at[i];
    bool angle = c->solved_by == -1 && a->proposal->angles.n > 0;
    if (!pl_is_poison(c->map) && angle)
      f[(*n)++] = pl_feq(a, pl_fs(a, c->q), pl_f(a, c->map, PL_S_SOLUTION));
  }
  return pl_flist(a, f, *n);
}

void pl_tell_proposal(pl_analysis* a) {
  if (!a->is_proposal || a->page->proposal_told) return;
  a->page->proposal_told = true;
  const pl_choose* choose = &a->model->choose;
  if (choose->coords.n == 0) return;
  const pl_form** name = PL_ARRAY(a->arena, const pl_form*, choose->coords.n);
  for (int k = 0; k < choose->coords.n; k++) name[k] = pl_fs(a, choose->coords.at[k]);
  const pl_form* names = pl_flist(a, name, choose->coords.n);
  int n;
  const pl_form* maps = maps_form(a, &n);
  bool one = choose->coords.n == 1;
  if (n > 0) {
    pl_say(a,
           PL_BOTH(one ? "{1} is proposed as generalized coordinate: {2}."
                       : "{1} are proposed as generalized coordinates: {2}."),
           2, names, maps);
  } else {
    pl_say(a,
           PL_BOTH(one ? "{1} is proposed as generalized coordinate."
                       : "{1} are proposed as generalized coordinates."),
           1, names);
  }
}

// ------------------------------------------------------------------------------------------ values
static bool speaks_of(pl_analysis* a, const pl_value* v, pl_symbol s) {
  bool has = !pl_is_poison(v->expr) && pl_has_symbol(a->pool, v->expr, s);
  has |= !pl_is_poison(v->got) && pl_has_symbol(a->pool, v->got, s);
  for (int c = 0; c < v->n_components; c++) has |= pl_has_symbol(a->pool, v->components[c].expr, s);
  for (int c = 0; c < v->n_where; c++) has |= pl_has_symbol(a->pool, v->where_expr[c], s);
  return has;
}

// Puts the definition in front of the other names of a value.
static void define_in(pl_analysis* a, pl_value* v, pl_symbol s, pl_expr value) {
  if (!speaks_of(a, v, s)) return;
  const char** name = PL_ARRAY(a->arena, const char*, v->n_where + 1);
  pl_expr* expr = PL_ARRAY(a->arena, pl_expr, v->n_where + 1);
  name[0] = pl_symbol_get(a->pool, s)->ascii;
  expr[0] = value;
  for (int k = 0; k < v->n_where; k++) {
    name[k + 1] = v->where_name[k];
    expr[k + 1] = v->where_expr[k];
  }
  v->where_name = name;
  v->where_expr = expr;
  v->n_where++;
}

// Angles that the model does not know, over its own coordinates.
static void define_angles(pl_analysis* d, const pl_proposal* p, pl_value* v) {
  for (int j = 0; j < p->angles.n; j++) {
    pl_symbol q = p->angles.at[j].symbol;
    pl_expr value = pl_proposed_value(p->analysis, &p->angles.at[j]);
    define_in(p->analysis, v, pl_symbol_dot(d->pool, q), pl_dt(d->pool, value));
    define_in(p->analysis, v, q, value);
  }
}

void pl_define_proposed(pl_analysis* d) {
  const pl_proposal* both[2] = {d->proposal, d->proposal_for_rest};
  for (int b = 0; b < 2; b++) {
    if (!both[b] || !both[b]->analysis) continue;
    for (int k = 0; k < d->page->solution->sections.n; k++) {
      pl_section* s = &d->page->solution->sections.at[k];
      for (int i = 0; i < s->values.n; i++) define_angles(d, both[b], &s->values.at[i]);
    }
  }
}
