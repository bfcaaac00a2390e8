// Coefficients of contacts: within their range, and on constraints that they can belong to.
#include "model_impl.h"

#include <math.h>
#include <string.h>

static const pl_constraint* meant(const pl_model* m, const char* label, bool restitution,
                                  int index) {
  for (int i = 0; i < m->constraints.n; i++) {
    const pl_constraint* c = &m->constraints.at[i];
    if (restitution ? pl_model_restitution(m, c) == &m->restitutions.at[index]
                    : pl_model_friction(m, c) == &m->frictions.at[index])
      return c;
  }
  return pl_model_constraint(m, label);
}

// One coefficient against its range; most NaN: no upper limit.
static void check_range(pl_job* job, const pl_model* m, const double* value, pl_expr e, double most,
                        pl_span span, const char* en, const char* de) {
  double x = pl_is_poison(e) ? (double)NAN : pl_eval(m->pool, e, value);
  if (isnan(x) || (x >= 0 && !(x > most))) return;
  pl_diagnostic* d =
      isnan(most)
          ? pl_tell(job, PL_E065, span, PL_F(job, "%s is %.6g, it cannot be negative", en, x),
                    PL_F(job, pl_german("%s is %.6g, it cannot be negative"), de, x))
          : pl_tell(job, PL_E065, span, PL_F(job, "%s is %.6g, it lies between 0 and 1", en, x),
                    PL_F(job, pl_german("%s is %.6g, it lies between 0 and 1"), de, x));
  if (!isnan(most))
    pl_report_fix(d, PL_BOTH("0 is an impact without rebound, 1 one without loss"), NULL);
}

static void check_restitution(pl_job* job, const pl_model* m, int i, const double* value) {
  const pl_restitution* r = &m->restitutions.at[i];
  const pl_constraint* c = meant(m, r->label, true, i);
  check_range(job, m, value, r->value, 1, r->span, PL_BOTH("the coefficient of restitution"));
  if (!c) return;
  if (pl_has_coordinate(m->pool, r->value, job->arena)
      || pl_has_role(m->pool, r->value, PL_R_TIME)) {
    pl_tell(job, PL_E057, r->span, PL_BOTH("a coefficient of restitution is constant"));
    return;
  }
  if (c->relation != PL_EQ) return;
  pl_diagnostic* d = pl_tell(
      job, PL_E066, r->span,
      PL_BOTH_FORMAT(job->arena, "nothing bounces off %s: it holds both ways", r->label));
  pl_report_fix(d, PL_BOTH("one-sided constraints are written with >= or <="), NULL);
}

static void check_friction(pl_job* job, const pl_model* m, int i, const double* value) {
  const pl_friction* f = &m->frictions.at[i];
  const pl_constraint* c = meant(m, f->label, false, i);
  check_range(job, m, value, f->kinetic, NAN, f->span, PL_BOTH("the coefficient of friction"));
  check_range(job, m, value, f->sticking, NAN, f->span,
              PL_BOTH("the coefficient of static friction"));
  double kinetic = pl_eval(m->pool, f->kinetic, value);
  double sticking = pl_is_poison(f->sticking) ? (double)NAN : pl_eval(m->pool, f->sticking, value);
  if (sticking >= 0 && kinetic > sticking) {
    pl_diagnostic* d = pl_tell(
        job, PL_E065, f->span,
        PL_BOTH_FORMAT(job->arena, "static friction (%.6g) is less than kinetic friction (%.6g)",
                       sticking, kinetic));
    pl_report_fix(d, PL_BOTH("the kinetic coefficient comes first: friction 0.3, static 0.4 on c"),
                  NULL);
  }
  if (!c) return;
  if (c->has_velocity) {
    pl_diagnostic* d = pl_tell(
        job, PL_E066, f->span,
        PL_BOTH_FORMAT(job->arena, "%s restricts velocities: it presses no surfaces together",
                       f->label));
    pl_report_fix(d, PL_BOTH("friction belongs to a constraint on positions"), NULL);
  }
}

static void check_twice(pl_job* job, const char* label, pl_span span, const char* what) {
  pl_tell(job, PL_E028, span, PL_BOTH_FORMAT(job->arena, "%s on %s is given twice", what, label));
}

// An event that attaches something one-sided makes an impact: without restitution it is inelastic,
// and that is said.
static void check_attached(pl_job* job, const pl_model* m, const pl_event* e) {
  for (int k = 0; k < e->actions.n; k++) {
    const pl_action* a = &e->actions.at[k];
    const pl_constraint* c = a->kind == PL_DO_ATTACH && a->label ? pl_model_constraint(m, a->label)
                                                                 : NULL;
    if (!c || c->relation == PL_EQ || pl_model_restitution(m, c)) continue;
    pl_diagnostic* d = pl_tell(
        job, PL_N068, a->span.source ? a->span : e->span,
        PL_BOTH_FORMAT(job->arena,
                       "%s has no restitution: an impact when it is attached is inelastic",
                       a->label));
    pl_report_fix(d, PL_F(job, "restitution 0 on %s", a->label),
                  PL_F(job, "restitution 0 on %s", a->label), NULL);
  }
}

void pl_check_contacts(pl_job* job, pl_model* m) {
  double* value = pl_model_values(m, job->arena);
  for (int i = 0; i < m->restitutions.n; i++) {
    check_restitution(job, m, i, value);
    for (int k = 0; k < i; k++)
      if (strcmp(m->restitutions.at[k].label, m->restitutions.at[i].label) == 0)
        check_twice(job, m->restitutions.at[i].label, m->restitutions.at[i].span, "restitution");
  }
  for (int i = 0; i < m->frictions.n; i++) {
    check_friction(job, m, i, value);
    for (int k = 0; k < i; k++)
      if (strcmp(m->frictions.at[k].label, m->frictions.at[i].label) == 0)
        check_twice(job, m->frictions.at[i].label, m->frictions.at[i].span, "friction");
  }
  for (int i = 0; i < m->events.n; i++) check_attached(job, m, &m->events.at[i]);
}
