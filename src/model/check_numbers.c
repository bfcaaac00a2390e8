// What the given numbers already tell: parameters in circles, masses that are not positive,
// assumptions that fail.
#include "model_impl.h"

#include <math.h>

// ----------------------------------------------------------------------------------------- circles
static pl_expr value_given(const pl_model* m, pl_symbol s) {
  const pl_param* p = pl_model_param(m, s);
  if (p) return p->value;
  for (int i = 0; i < m->lets.n; i++) {
    if (m->lets.at[i].symbol.id == s.id && !m->lets.at[i].inserted && !m->lets.at[i].n_args)
      return m->lets.at[i].value;
  }
  return pl_poison();
}

// The names that the value of p needs, and so on: does p come back?
static bool leads_to(const pl_model* m, pl_arena* a, pl_expr from, pl_symbol wanted,
                     pl_map* visited) {
  if (pl_is_poison(from)) return false;
  int n = pl_symbols_in(m->pool, from, NULL, 0);
  pl_symbol* s = PL_ARRAY(a, pl_symbol, n + 1);
  pl_symbols_in(m->pool, from, s, n);
  for (int i = 0; i < n; i++) {
    if (s[i].id == wanted.id) return true;
    if (pl_map_get(visited, s[i].id)) continue;
    pl_map_set(visited, s[i].id, 1);
    if (leads_to(m, a, value_given(m, s[i]), wanted, visited)) return true;
  }
  return false;
}

static void check_circles(pl_job* job, pl_model* m, const double* value) {
  for (int i = 0; i < m->params.n; i++) {
    const pl_param* p = &m->params.at[i];
    if (pl_is_poison(p->value) || !isnan(value[p->symbol.id])) continue;
    if (!leads_to(m, job->arena, p->value, p->symbol, pl_map_make(job->arena))) continue;
    const char* name = pl_symbol_get(m->pool, p->symbol)->name;
    pl_diagnostic* d = pl_tell(job, PL_E049, p->span,
                               PL_BOTH_FORMAT(job->arena, "%s is defined through itself", name));
    pl_report_fix(d, PL_BOTH_FORMAT(job->arena, "give %s a number", name), NULL);
    return;  // the others of the circle are the same mistake
  }
}

// -------------------------------------------------------------------------------- signs of numbers
typedef struct sign_check {
  pl_model* m;
  pl_expr e;
  bool zero_allowed;
  double bad;
} sign_check;

static bool is_positive(void* user, pl_index_values* v) {
  sign_check* c = user;
  double x = pl_eval(c->m->pool, c->e, v->value);
  if (isnan(x) || x > 0 || (x == 0 && c->zero_allowed)) return true;
  c->bad = x;
  return false;
}

static void check_positive(pl_job* job, pl_index_values* v, pl_expr e, const pl_block* b,
                           bool zero_allowed, pl_span span, const char* en, const char* de,
                           const char* fix_en, const char* fix_de) {
  pl_model* m = (pl_model*)(uintptr_t)v->model;
  if (pl_is_poison(e)) return;
  sign_check c = {m, e, zero_allowed, 0};
  if (!pl_has_role(m->pool, e, PL_R_INDEX)) b = NULL;  // the same for every member
  long budget = 100000;                                // a family of masses is looked at up to here
  bool ok = b ? pl_block_walk(b, v, is_positive, &c, &budget, NULL) != PL_WALK_STOPPED
              : is_positive(&c, v);
  for (const pl_block* x = b; x; x = x->outer) v->value[x->index.id] = PL_NAN;
  if (ok) return;
  pl_diagnostic* d = pl_tell(job, PL_E036, span,
                             PL_F(job, "%s is %.6g, it has to be positive", en, c.bad),
                             PL_F(job, pl_german("%s is %.6g, it has to be positive"), de, c.bad));
  if (!pl_is_number(m->pool, e)) {
    const char* text = pl_expr_words(job->arena, m->pool, e);
    pl_report_reason(d, PL_F(job, "%s = %.6g", text, c.bad), PL_F(job, "%s = %.6g", text, c.bad));
  }
  pl_report_fix(d, fix_en, fix_de, NULL);
}

static void check_signs(pl_job* job, pl_model* m, pl_index_values* v) {
  for (int i = 0; i < m->masses.n; i++) {
    check_positive(job, v, m->masses.at[i].mass, m->masses.at[i].block, false, m->masses.at[i].span,
                   PL_BOTH("this mass"),
                   PL_BOTH("a point without mass is written: point A at (x, y)"));
  }
  for (int i = 0; i < m->bodies.n; i++) {
    const pl_body* b = &m->bodies.at[i];
    check_positive(job, v, b->mass, b->block, false, b->span, PL_BOTH("this mass"),
                   PL_BOTH("give a positive number"));
    check_positive(job, v, b->inertia, b->block, false, b->span, PL_BOTH("this moment of inertia"),
                   PL_BOTH("a point mass is written: mass m at (x, y)"));
  }
  for (int i = 0; i < m->loads.n; i++) {
    const pl_load* x = &m->loads.at[i];
    if (x->kind == PL_L_SPRING) {
      check_positive(
          job, v, x->value, x->block, true, x->span, PL_BOTH("this stiffness"),
          PL_BOTH("a negative stiffness is written as a potential: potential -1/2 k x^2"));
      check_positive(job, v, x->rest, x->block, true, x->span, PL_BOTH("this rest length"),
                     "rest 0", "rest 0");
    }
    if (x->kind == PL_L_DAMPER || x->kind == PL_L_DRAG) {
      check_positive(job, v, x->value, x->block, true, x->span, PL_BOTH("this damping coefficient"),
                     PL_BOTH("a force along the motion is written with force"));
    }
  }
}

// ------------------------------------------------------------------------------------- assumptions
static bool relation_fails(double left, pl_relation r, double right) {
  if (isnan(left) || isnan(right)) return false;
  double tolerance = 1e-12 * (fabs(left) + fabs(right));  // rounding of the last digits
  switch (r) {
    case PL_EQ: return fabs(left - right) > tolerance;
    case PL_NE: return left == right;
    case PL_GE: return left < right - tolerance;
    case PL_LE: return left > right + tolerance;
    case PL_GT: return !(left > right);
    case PL_LT: return !(left < right);
  }
  return false;
}

static void tell_assumption(pl_job* job, pl_model* m, const pl_assumption* a, pl_expr e,
                            const double* value) {
  pl_diagnostic* d = pl_tell(job, PL_E060, a->span,
                             PL_BOTH("the given numbers contradict this assumption"));
  int n = pl_symbols_in(m->pool, e, NULL, 0);
  pl_symbol* s = PL_ARRAY(job->arena, pl_symbol, n + 1);
  pl_symbols_in(m->pool, e, s, n);
  pl_text numbers = pl_text_make(job->arena);
  for (int i = 0; i < n; i++) {
    const pl_param* p = pl_model_param(m, s[i]);
    const char* text = PL_F(job, "%s = %.6g", pl_symbol_get(m->pool, s[i])->name, value[s[i].id]);
    if (p && p->span.source) pl_report_label(job->diagnostics, d, p->span, text);
    pl_text_addf(&numbers, "%s%s", i ? ", " : "", text);
  }
  pl_report_reason(d, pl_text_string(&numbers), pl_text_string(&numbers));
  pl_report_fix(d, PL_BOTH("change the numbers or the assumption"), NULL);
}

static void check_assumptions(pl_job* job, pl_model* m, const double* value) {
  for (int i = 0; i < m->assumptions.n; i++) {
    const pl_assumption* a = &m->assumptions.at[i];
    if (a->kind == PL_A_RELATION) {
      if (pl_is_poison(a->condition.left) || pl_is_poison(a->condition.right)) continue;
      double l = pl_eval(m->pool, a->condition.left, value),
             r = pl_eval(m->pool, a->condition.right, value);
      if (!relation_fails(l, a->condition.relation, r)) continue;
      tell_assumption(job, m, a, pl_sub(m->pool, a->condition.left, a->condition.right), value);
      continue;
    }
    if (pl_is_poison(a->subject)) continue;
    double x = pl_eval(m->pool, a->subject, value);
    bool whole = a->kind != PL_A_INTEGER || isnan(x) || x == floor(x);
    double lo = pl_is_poison(a->lo) ? -PL_INF : pl_eval(m->pool, a->lo, value);
    double hi = pl_is_poison(a->hi) ? PL_INF : pl_eval(m->pool, a->hi, value);
    if (whole && !(x < lo) && !(x > hi)) continue;
    tell_assumption(job, m, a, a->subject, value);
  }
}

void pl_check_numbers(pl_job* job, pl_model* m) {
  pl_index_values v = pl_index_values_make(m, job->arena);
  check_circles(job, m, v.value);
  check_signs(job, m, &v);
  check_assumptions(job, m, v.value);
}
