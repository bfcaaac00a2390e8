// notes: what a careful reader would be told besides: a start in an equilibrium, forces that depend
// on how a constraint is written.
#include <math.h>
#include <string.h>

#include "worked/worked_impl.h"

static const pl_init* init_of(const pl_analysis* d, pl_symbol s) {
  for (int k = 0; k < d->model->inits.n; k++) {
    const pl_init* init = &d->model->inits.at[k];
    if (!init->guess && pl_same(init->target, pl_sym(d->pool, s))) return init;
  }
  return NULL;
}

static void note_escape(pl_analysis* d, pl_span span);

// Given quantities whose number is 0, such as a start angle that stands as a name.
static pl_expr without_zeros(pl_analysis* d, pl_expr e) {
  for (int k = 0; k < d->model->params.n; k++) {
    const pl_param* given = &d->model->params.at[k];
    if (!pl_is_poison(given->value) && pl_is_zero_node(d->pool, given->value))
      e = pl_subst1(d->pool, e, given->symbol, given->value);
  }
  return e;
}

// N061: every generalized coordinate is given, at rest, and no acceleration follows.
void pl_note_equilibrium_start(pl_analysis* d) {
  if (!d->reduced || !d->solved || d->gen.n == 0 || d->gen.n > 16) return;
  pl_replace start[32];
  pl_span span = {0};
  for (int k = 0; k < d->gen.n; k++) {
    const pl_variable* c = &d->q.at[d->gen.at[k]];
    const pl_init *q = init_of(d, c->q), *v = init_of(d, c->v);
    if (!q || (v && !pl_is_zero_node(d->pool, v->value))) return;
    start[2 * k] = (pl_replace){c->q, q->value};
    start[2 * k + 1] = (pl_replace){c->v, pl_int(d->pool, 0)};
    span = pl_span_join(span.source ? span : q->span, q->span);
  }
  for (int k = 0; k < d->gen.n; k++) {
    pl_expr a = pl_subst(d->pool, d->acceleration[d->gen.at[k]], start, 2 * d->gen.n);
    if (pl_is_poison(a) || pl_alg_is_zero(d->tower, without_zeros(d, a)) != PL_YES) return;
  }
  const char* name = pl_symbol_get(d->pool, d->q.at[d->gen.at[0]].q)->name;
  pl_diagnostic* m = pl_report(
      d->job->diagnostics, PL_N061, span,
      PL_BOTH("the start is an equilibrium: the simulation will stay there for ever"));
  pl_report_fix(
      m,
      PL_BOTH_FORMAT(d->arena,
                     "closed forms are the limit %s(0) → this value; for the simulation start "
                     "beside it, e.g. init %s = 1°",
                     name, name),
      NULL);
  note_escape(d, span);
}

// N070: at rest where the force has an unbounded slope.
static void note_escape(pl_analysis* d, pl_span span) {
  if (!pl_escapes(d)) return;
  const char* name = pl_symbol_get(d->pool, d->q.at[d->gen.at[0]].q)->name;
  pl_symbol wait;
  pl_expr x = pl_escape_motion(d, &wait);
  const char* way = pl_is_poison(x) ? NULL
                                    : pl_format(d->arena, "%s(t) = %s", name, pl_text_of(d, x));
  pl_diagnostic* m = pl_report(
      d->job->diagnostics, PL_N070, span,
      pl_format(d->arena,
                "the motion from this start is not unique: the force is not Lipschitz there, its "
                "slope grows without bound"),
      pl_format(
          d->arena,
          pl_german(
              "the motion from this start is not unique: the force is not Lipschitz there, its "
              "slope grows without bound")));
  if (!way) return;
  const char* wait_name = pl_symbol_get(d->pool, wait)->name;
  pl_report_reason(
      m,
      PL_BOTH_FORMAT(d->arena, "besides rest, %s from t = %s on is a motion too, for every %s ≥ 0",
                     way, wait_name, wait_name));
}

// ------------------------------------------------------------------------------------- attribution
// Component c of particle m if it is a plain coordinate, else -1.
static int coordinate_at(const pl_analysis* d, int m, int c) {
  const pl_particle* k = &d->particle.at[m];
  if (c >= k->n || pl_kind_of(d->pool, k->at[c]) != PL_SYMBOL) return -1;
  return pl_variable_index(d, pl_symbol_of(d->pool, k->at[c]));
}

static bool uses(const pl_analysis* d, int link, int i) {
  return i >= 0 && !pl_is_zero_node(d->pool, d->g.at[link].gradient[i]);
}

// N055: g uses the coordinate of one mass along an axis, joins another mass, but leaves out that
// mass's coordinate along the
// same axis, which another constraint holds at 0.
static bool left_out(pl_analysis* d, int link, int* present, int* missing, int* mass) {
  for (int m = 0; m < d->particle.n; m++) {
    bool joins = false;
    for (int c = 0; c < d->particle.at[m].n; c++) joins |= uses(d, link, coordinate_at(d, m, c));
    for (int c = 0; joins && c < d->particle.at[m].n; c++) {
      int own = coordinate_at(d, m, c);
      if (own < 0 || uses(d, link, own) || d->q.at[own].fixed_by < 0
          || !pl_is_zero_node(d->pool, d->q.at[own].fixed))
        continue;
      for (int k = 0; k < d->particle.n; k++) {
        int other = k == m ? -1 : coordinate_at(d, k, c);
        if (!uses(d, link, other)) continue;
        *present = other;
        *missing = own;
        *mass = m;
        return true;
      }
    }
  }
  return false;
}

void pl_note_attribution(pl_analysis* d, int link) {
  int present, missing, mass;
  if (!left_out(d, link, &present, &missing, &mass)) return;
  const pl_bond *l = &d->g.at[link], *guide = &d->g.at[d->q.at[missing].fixed_by];
  const pl_symbol_info *z1 = pl_symbol_get(d->pool, d->q.at[present].q),
                       *z2 = pl_symbol_get(d->pool, d->q.at[missing].q);
  pl_expr difference = pl_sub(d->pool, pl_sym(d->pool, d->q.at[present].q),
                              pl_sym(d->pool, d->q.at[missing].q));
  pl_expr full = pl_subst1(d->pool, l->source->left, d->q.at[present].q, difference);
  pl_notation how = {.math = PL_MATH_ASCII, .lang = d->job->lang};
  const char* text = pl_format(
      d->arena, "%s = %s", pl_notation_print(d->arena, d->pool, pl_fe(d, full), how),
      pl_notation_print(d->arena, d->pool, pl_fe(d, l->source->right), how));
  const char* g = l->source->name.text;
  const char* label = d->particle.at[mass].label;
  const char* carried = guide->lambda_known ? pl_text_of(d, guide->lambda_value) : "?";
  pl_diagnostic* note = pl_report(
      d->job->diagnostics, PL_N055, l->source->span,
      PL_BOTH_FORMAT(
          d->arena,
          "%s contains %s but not %s, which %s holds at 0: the force of %s on %s has no part "
          "along %s, and %s carries %s alone",
          g, z1->name, z2->name, guide->source->name.text, g, label, z2->name,
          guide->source->name.text, carried));
  pl_report_fix(note, PL_BOTH_FORMAT(d->arena, "write %s for the full force", text), text);
  pl_report_fix_span(note, l->source->relation_span);
}
