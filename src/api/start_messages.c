// A start that does not fit the constraints, or fits in several ways, as messages with a place and
// a fix: E041, E043, N073.
#include <math.h>
#include <stdlib.h>
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
    if (pl_kind_of(p, atom) == PL_SYMBOL && base.id == pl_symbol_of(p, atom).id
        && is_velocity == velocity) {
      return model->inits.at[i].span;
    }
  }
  return (pl_span){0};
}

// The constraint of the model that a row belongs to; NULL for map equations.
static const pl_constraint* constraint_of_constraint(const pleuel_model* m, int constraint) {
  const char* name = m->recording->setup.constraints[constraint].name;
  return constraint < m->recording->n_declared ? pl_model_constraint(m->model, name) : NULL;
}

// With as many digits as it takes to be accepted when it is typed.
static const char* typed(pl_arena* a, double x) {
  static const double exact_enough = 1e-12;
  char text[40] = "";
  for (int digits = 6; digits <= 17; digits++) {
    snprintf(text, sizeof text, "%.*g", digits, x);
    if (fabs(strtod(text, NULL) - x) <= exact_enough * fabs(x)) break;
  }
  return pl_copy(a, text);
}

static void report_violated(pleuel_model* m) {
  const pl_start_report* r = &m->start;
  const pl_setup* s = &m->recording->setup;
  const pl_constraint_setup* constraint = &s->constraints[r->constraint];
  const pl_constraint* c = constraint_of_constraint(m, r->constraint);
  pl_span span = r->move_coordinate >= 0 ? init_span(m, r->move_coordinate, r->move_velocity)
                                         : (pl_span){0};
  if (!span.source && c) span = c->span;
  const char* words = r->constraint_velocity ? PL_KEY("the start velocity violates %s")
                                             : PL_KEY("the start violates %s");
  pl_diagnostic* d = pl_report(&m->diagnostics, PL_E041, span,
                               PL_BOTH_FORMAT(m->arena, words, constraint->name));
  if (r->move_coordinate < 0) return;
  const pl_coordinate* q = &s->coordinates[r->move_coordinate];
  const char* name = r->move_velocity ? q->v_name : q->name;
  const char* unit = r->move_velocity ? q->v_unit : q->unit;
  const char* blank = unit && *unit ? " " : "";
  if (!unit) unit = "";
  const char* number = typed(m->arena, r->move_to);
  pl_report_fix(
      d,
      PL_BOTH_FORMAT(m->arena,
                     "%s = %s%s%s would fit. Change it, or remove it from init and let it follow",
                     name, number, blank, unit),
      NULL);
}

// ------------------------------------------------------------------------------- several solutions
static const char* shown_coordinate(const pleuel_model* m, int i) {
  pl_expr atom = m->recording->flat.at[i];
  if (pl_kind_of(m->model->pool, atom) != PL_SYMBOL) return m->recording->setup.coordinates[i].name;
  return pl_symbol_get(m->model->pool, pl_symbol_of(m->model->pool, atom))->name;
}

static bool is_angle(const pl_setup* s, int i) {
  return s->coordinates[i].unit && strcmp(s->coordinates[i].unit, "rad") == 0;
}

// The coordinate that was not given and in which two solutions differ most.
static int differing(const pl_setup* s, const double* a, const double* b) {
  int most = -1;
  double largest = 0;
  for (int i = 0; i < s->n_q; i++) {
    double d = fabs(a[i] - b[i]);
    if (s->coordinates[i].has_q || d <= largest * (1 + 1e-9)) continue;
    most = i;
    largest = d;
  }
  return most;
}

// Where the sine or cosine of an angle has another sign: "sin γ"; NULL if neither has.
static const char* sign_of_angle(pleuel_model* m, int i, double a, double b) {
  static const double clear = 1e-3;
  const char* name = shown_coordinate(m, i);
  if (sin(a) * sin(b) < 0 && fabs(sin(a)) > clear && fabs(sin(b)) > clear)
    return pl_format(m->arena, "sin %s", name);
  if (cos(a) * cos(b) < 0 && fabs(cos(a)) > clear && fabs(cos(b)) > clear)
    return pl_format(m->arena, "cos %s", name);
  return NULL;
}

// A condition on which two solutions differ, `left` against `right`: an angle by a sign, a
// coordinate against one of the same letter that lies between (x2 < x1), or against a number.
// Returns whether left > right at a.
static bool condition_between(pleuel_model* m, const double* a, const double* b, const char** left,
                              const char** right) {
  const pl_setup* s = &m->recording->setup;
  for (int i = 0; i < s->n_q; i++) {
    if (s->coordinates[i].has_q || !is_angle(s, i)) continue;
    *left = sign_of_angle(m, i, a[i], b[i]);
    *right = "0";
    if (*left) return (*left)[0] == 's' ? sin(a[i]) > 0 : cos(a[i]) > 0;
  }
  int k = differing(s, a, b);
  if (k < 0) k = 0;
  double lo = fmin(a[k], b[k]), hi = fmax(a[k], b[k]);
  *left = shown_coordinate(m, k);
  *right = NULL;
  for (int i = 0; i < s->n_q && !*right; i++) {
    bool same_letter = s->coordinates[i].name[0] == s->coordinates[k].name[0];
    if (i != k && same_letter && a[i] == b[i] && lo < a[i] && a[i] < hi)
      *right = shown_coordinate(m, i);
  }
  if (!*right) *right = lo < 0 && hi > 0 ? "0" : pl_format(m->arena, "%.4g", 0.5 * (lo + hi));
  return a[k] > b[k];
}

static pl_span place_of_start(const pleuel_model* m) {
  return m->model->inits.n > 0 ? m->model->inits.at[0].span : (pl_span){0};
}

static void report_several(pleuel_model* m) {
  const pl_start_report* r = &m->start;
  const char *left, *right;
  condition_between(m, r->candidates, r->candidates + m->recording->setup.n_q, &left, &right);
  pl_diagnostic* d = pl_report(
      &m->diagnostics, PL_E043, place_of_start(m),
      PL_BOTH_FORMAT(m->arena, "%d solutions of the constraints fit the start; choose one",
                     r->n_candidates));
  pl_report_fix(d,
                PL_BOTH_FORMAT(m->arena, "add  branch %s < %s   or   branch %s > %s", left, right,
                               left, right),
                NULL);
}

// The solution nearest to the given numbers was taken: which one it is, and how to have another.
static void report_taken(pleuel_model* m) {
  const pl_start_report* r = &m->start;
  const pl_setup* s = &m->recording->setup;
  const double* taken = r->candidates + (size_t)r->taken * (size_t)s->n_q;
  const double* other = r->candidates + (size_t)(r->taken == 0 ? 1 : 0) * (size_t)s->n_q;
  pl_text values = pl_text_make(m->arena);
  int shown = 0;
  for (int i = 0; i < s->n_q && shown < 6; i++) {
    const char* unit = s->coordinates[i].unit ? s->coordinates[i].unit : "";
    if (s->coordinates[i].has_q) continue;
    pl_text_addf(&values, "%s%s = %.6g%s%s", shown++ ? ", " : "", shown_coordinate(m, i), taken[i],
                 *unit ? " " : "", unit);
  }
  const char *left, *right;
  bool greater = condition_between(m, taken, other, &left, &right);
  const char* at = pl_text_string(&values);
  pl_diagnostic* d = pl_report(
      &m->diagnostics, PL_N073, place_of_start(m),
      PL_BOTH_FORMAT(m->arena,
                     "%d solutions of the constraints fit the start; the nearest one is taken: %s",
                     r->n_candidates, at));
  const char* own = pl_format(m->arena, "branch %s %s %s", left, greater ? ">" : "<", right);
  const char* opposite = pl_format(m->arena, "branch %s %s %s", left, greater ? "<" : ">", right);
  pl_report_fix(d, PL_BOTH_FORMAT(m->arena, "%s  keeps it, %s  takes another one", own, opposite),
                NULL);
}

void pl_start_report_choice(pleuel_model* m) {
  if (m->start_reported || m->start.n_candidates < 2
      || pl_diagnostics_have(&m->diagnostics, PL_N073))
    return;
  report_taken(m);
  pl_diagnostics_sort(&m->diagnostics);
}

void pl_start_report_trouble(pleuel_model* m) {
  if (m->start_reported) return;
  m->start_reported = true;
  // the derivation may have said it already
  if (pl_diagnostics_have(&m->diagnostics, PL_E041)
      || pl_diagnostics_have(&m->diagnostics, PL_E043))
    return;
  if (m->start.trouble == PL_START_VIOLATED && m->start.constraint >= 0) report_violated(m);
  if (m->start.trouble == PL_START_SEVERAL && m->start.n_candidates > 1) report_several(m);
  pl_diagnostics_sort(&m->diagnostics);
}
