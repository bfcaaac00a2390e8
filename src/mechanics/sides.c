// sides: signs that the formulas took for granted. |x - a| = x - a holds on one side of x = a only,
// and so does everything that was derived with it: the motion may come to the other side, and
// places of rest may lie there.
//
// Needs an analysis whose tower has worked.
#include "mechanics/sides.h"

#include <math.h>
#include <string.h>

#include "mechanics/propose.h"

static bool is_of_state(const pl_analysis* d, const pl_fact* f) {
  bool moves = pl_has_role(d->pool, f->difference, PL_R_COORD)
               || pl_has_role(d->pool, f->difference, PL_R_VELOCITY);
  return moves && !pl_has_role(d->pool, f->difference, PL_R_ACCELERATION)
         && !pl_has_role(d->pool, f->difference, PL_R_MULTIPLIER);
}

static bool is_contact(const pl_analysis* d, const pl_fact* f) {
  for (int k = 0; k < d->whole->constraints.n; k++) {
    const pl_constraint* c = &d->whole->constraints.at[k];
    bool same = pl_same(f->difference, c->g) || pl_same(f->difference, pl_neg(d->pool, c->g));
    if (c->relation != PL_EQ && same) return true;
  }
  return false;
}

static bool is_given(const pl_analysis* d, const pl_fact* f) {
  for (int k = 0; k < d->facts.n; k++) {
    if (pl_same(d->facts.at[k].difference, f->difference)) return true;
  }
  return false;
}

// Some state has the other sign: the determinant of the masses, say, has none.
static bool has_other_side(pl_analysis* d, pl_expr e) {
  enum { draws = 300 };
  int n = pl_symbol_count(d->pool) + 1;
  double* value = PL_ARRAY(d->arena, double, n);
  pl_random r = {1};
  for (int k = 0; k < draws; k++) {
    for (int i = 1; i < n; i++) {
      pl_symbol s = {(uint32_t)i};
      bool given = pl_symbol_get(d->pool, s)->role == PL_R_PARAM;
      double number = given ? pl_number(d, pl_sym(d->pool, s)) : (double)NAN;
      double unit = pl_random_unit(&r);
      value[i] = !isnan(number) ? number : given ? 0.3 + 2.7 * unit : 6.4 * unit - 3.2;
    }
    if (pl_eval(d->pool, e, value) < 0) return true;
  }
  return false;
}

static bool is_listed(const pl_analysis* d, const pl_fact* f) {
  for (int k = 0; k < d->sides.n; k++) {
    if (pl_same(d->sides.at[k].difference, f->difference)) return true;
  }
  return false;
}

static void list_side(pl_analysis* d, const pl_fact* f) {
  if (is_listed(d, f) || d->sides.n == pl_max_sides || !is_of_state(d, f)) return;
  if (has_other_side(d, pl_on_maps(d, f->difference))) pl_push(d->arena, d->sides, *f);
}

int pl_taken_sides(pl_analysis* d, const pl_fact** out) {
  int n = 0;
  const pl_fact* used = pl_tower_used(d->tower, &n);
  for (int k = 0; d->n_looked_at == 0 && d->stage && k < d->stage->n_sides; k++)
    list_side(d, &d->stage->sides[k]);
  for (int k = d->n_looked_at; k < n; k++) {
    pl_fact f = used[k];
    if (!is_contact(d, &f) && !is_given(d, &f)) list_side(d, &f);
  }
  d->n_looked_at = n;
  *out = d->sides.at;
  return d->sides.n;
}

bool pl_side_is_of_place(const pl_analysis* d, const pl_fact* f) {
  return !pl_has_role(d->pool, f->difference, PL_R_VELOCITY);
}

// Only names that the simulation knows: an angle that was proposed is none.
static bool is_known_outside(const pl_analysis* d, pl_expr e) {
  for (int i = 0; i < d->q.n; i++) {
    const pl_variable* c = &d->q.at[i];
    bool speaks = pl_has_symbol(d->pool, e, c->q) || pl_has_symbol(d->pool, e, c->v);
    bool known = false;
    for (int k = 0; k < d->whole->coords.n; k++)
      known |= d->whole->coords.at[k].symbol.id == c->q.id;
    if (speaks && !known) return false;
  }
  return true;
}

static int add_known(pl_analysis* d, pl_fact* out, int n) {
  const pl_fact* side;
  int m = pl_taken_sides(d, &side);
  for (int k = 0; k < m; k++) {
    bool there = false;
    for (int i = 0; i < n; i++) there |= pl_same(out[i].difference, side[k].difference);
    if (!there && is_known_outside(d, side[k].difference)) out[n++] = side[k];
  }
  return n;
}

int pl_known_sides(pl_analysis* d, pl_fact* out) {
  int n = add_known(d, out, 0);
  pl_analysis* proposed = d->proposal ? pl_propose(d) : NULL;
  return proposed && proposed != d ? add_known(proposed, out, n) : n;
}

// Where a stage begins, none of these is negative.
static bool begins_on(pl_analysis* d, const pl_fact* side, int n, const pl_stage* s) {
  if (n == 0) return true;
  pl_number(d, side[0].difference);  // the table of numbers covers every name
  int most = d->n_value;
  double* value = PL_ARRAY(d->arena, double, most + 1);
  memcpy(value, d->value, (size_t)(most + 1) * sizeof *value);
  for (int i = 0; i < s->n_q; i++) {
    pl_symbol q = pl_symbol_find(d->pool, s->q_name[i]);
    if (!q.id || (int)q.id > most) continue;
    value[q.id] = s->q[i];
    pl_symbol v = pl_symbol_dot(d->pool, q);
    if (s->v && (int)v.id <= most) value[v.id] = s->v[i];
  }
  for (int k = 0; k < n; k++) {
    if (pl_eval(d->pool, side[k].difference, value) < -1e-9) return false;
  }
  return true;
}

bool pl_same_sides(pl_analysis* d, const pl_stage* s) {
  pl_fact side[2 * pl_max_sides];
  if (s->n_sides == 0 && d->stage && d->stage->n_sides > 0) return false;
  int n = pl_known_sides(d, side);
  if (s->n_sides == 0) return begins_on(d, side, n, s);
  for (int k = 0; k < s->n_sides; k++) {
    bool there = false;
    for (int i = 0; i < n; i++) there |= pl_same(side[i].difference, s->sides[k].difference);
    if (!there) return false;
  }
  return true;
}
