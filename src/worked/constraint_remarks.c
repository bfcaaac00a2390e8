// constraint_remarks: the list of constraints, those that say nothing new, and those that
// contradict.
#include "worked/worked_impl.h"

static const char* relation_text(pl_analysis* d, const pl_constraint* c) {
  const char* op = c->relation == PL_GE ? ">=" : c->relation == PL_LE ? "<=" : "=";
  return pl_format(d->arena, "%s %s %s", pl_expr_text(d->arena, d->pool, c->left), op,
                   pl_expr_text(d->arena, d->pool, c->right));
}

static void note_implied(pl_analysis* d, const pl_bond* l, const pl_constraint_info* info) {
  if (l->source->redundant_ok) return;
  pl_text by = pl_text_make(d->arena);
  for (int k = 0; k < info->n_implied_by; k++)
    pl_text_addf(&by, "%s%s", k ? ", " : "", info->implied_by[k]);
  const char* others = info->n_implied_by > 0 ? pl_text_string(&by) : NULL;
  const char* label = l->source->name.text;
  pl_diagnostic* m = pl_report(d->job->diagnostics, PL_N052, l->source->span,
                               PL_BOTH_FORMAT(d->arena, "constraint %s says nothing new", label));
  pl_report_reason(
      m, pl_format(d->arena, "implied by %s", others ? others : "the others"),
      pl_format(d->arena, pl_german("implied by %s"), others ? others : pl_german("the others")));
  pl_report_fix(
      m,
      PL_BOTH("fine for the motion, but the forces of these constraints are not unique; add \", "
              "redundant ok\" to keep it"),
      NULL);
}

static void describe_open(pl_analysis* d) {
  for (int k = 0; k < d->open.n; k++) {
    const pl_open* o = &d->open.at[k];
    if (o->off) continue;
    pl_constraint_info info = {.source = o->source,
                               .label = o->source->name.text,
                               .text = relation_text(d, o->source),
                               .open = true,
                               .nonholonomic = o->source->has_velocity,
                               .one_sided = o->contact,
                               .rheonomic = pl_has_symbol(d->pool, o->source->g, pl_time(d->pool))};
    pl_push(d->arena, d->page->solution->constraints, info);
  }
}

static void name_implying(pl_analysis* d, int k, pl_constraint_info* info) {
  const pl_implication* by = &d->implied_by[k];
  info->implied_by = PL_ARRAY(d->arena, const char*, by->n + 1);
  for (int a = 0; a < by->n; a++)
    info->implied_by[info->n_implied_by++] = d->g.at[by->by[a]].source->name.text;
}

void pl_describe_constraints(pl_analysis* d) {
  for (int k = 0; k < d->g.n; k++) {
    const pl_bond* l = &d->g.at[k];
    pl_constraint_info info = {.source = l->source,
                               .label = l->source->name.text,
                               .text = relation_text(d, l->source),
                               .nonholonomic = l->velocity,
                               .one_sided = l->contact,
                               .rheonomic = pl_has_symbol(d->pool, l->g, pl_time(d->pool)),
                               .dropped = l->fixes >= 0 && !l->contact,
                               .implied = l->implied};
    if (l->implied) {
      name_implying(d, k, &info);
      note_implied(d, l, &info);
    }
    if (!l->source->sticking) pl_push(d->arena, d->page->solution->constraints, info);
  }
  describe_open(d);
}

pleuel_status pl_report_contradiction(pl_analysis* d) {
  const pl_bond* l = &d->g.at[d->contradicting];
  const char* text = pl_notation_print(d->arena, d->pool,
                                       pl_form_of(d->arena, d->pool, d->contradiction),
                                       (pl_notation){PL_MATH_LINE, d->job->lang});
  pl_diagnostic* m = pl_report(
      d->job->diagnostics, PL_E042, l->source->span,
      PL_BOTH_FORMAT(d->arena, "constraint %s contradicts the others: it leaves %s = 0",
                     l->source->name.text, text));
  pl_report_fix(m, PL_BOTH("take one of the contradicting constraints out"), NULL);
  return pl_fail(d->job, PLEUEL_CONTRADICTION,
                 "constraint %s contradicts the others: it leaves %s = 0", l->source->name.ascii,
                 text);
}
