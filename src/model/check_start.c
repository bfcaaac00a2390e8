// The start: values given twice, in a circle or from nothing, the span of the simulation, and
// constraints that the given start values already violate. What follows from the constraints by
// solving them is left to the derivation.
#include "model_impl.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// ------------------------------------------------------------------------------------- given twice
static const char* target_text(pl_job* job, const pl_model* m, pl_expr target, long index) {
  static const char* const primes[] = {"", "'", "''"};
  const pl_symbol_info* info = pl_symbol_get(m->pool, pl_symbol_of(m->pool, target));
  if (pl_kind_of(m->pool, target) == PL_AT)
    return PL_F(job, "%s[%ld]%s", info->name, index, primes[pl_dots_of(m->pool, target) % 3]);
  return PL_F(job, "%s%s", info->name, primes[info->dots % 3]);
}

static void check_twice(pl_job* job, pl_model* m) {
  pl_index_sets given = pl_index_sets_make(m, job->arena);
  for (int i = 0; i < m->inits.n; i++) {
    const pl_init* x = &m->inits.at[i];
    if (x->guess || pl_is_poison(x->target)) continue;
    pl_kind kind = pl_kind_of(m->pool, x->target);
    if (kind != PL_SYMBOL && kind != PL_AT) continue;
    bool element = kind == PL_AT;
    uint64_t key = pl_hash_mix(x->time.id + 1, pl_symbol_of(m->pool, x->target).id);
    if (element) key = pl_hash_mix(key, 5 + (uint64_t)pl_dots_of(m->pool, x->target));
    long index;
    pl_expr at = element ? pl_arg(m->pool, x->target, 0) : pl_poison();
    int first = pl_index_sets_add(&given, key, at, x->block, i, &index);
    if (first < 0) continue;
    const char* text = target_text(job, m, x->target, index);
    pl_diagnostic* d = pl_tell(
        job, PL_E044, x->span,
        PL_BOTH_FORMAT(job->arena, "the start value of %s is given twice", text));
    pl_span other = m->inits.at[first].span;
    if (other.source && other.begin != x->span.begin)
      pl_report_label(job->diagnostics, d, other,
                      job->lang == PL_GERMAN ? pl_german("first here") : "first here");
    pl_report_fix(d, PL_BOTH("keep one of the values"), NULL);
  }
}

// --------------------------------------------------------------------------- what a value may hold
static void check_init_value(pl_job* job, pl_model* m, const pl_init* x) {
  if (pl_is_poison(x->value)) {
    if (job->diagnostics->n_errors) return;
    pl_diagnostic* d = pl_tell(job, PL_E040, x->span, PL_BOTH("this start value has no value"));
    pl_report_reason(d, PL_BOTH("a division by zero?"));
    return;
  }
  bool force = pl_has_role(m->pool, x->value, PL_R_MULTIPLIER);
  if (!force && pl_max_dots(m->pool, x->value, job->arena) < 2) return;
  pl_diagnostic* d = pl_tell(job, PL_E046, x->span,
                             PL_BOTH(force ? "a start value cannot contain a multiplier"
                                           : "a start value cannot contain an acceleration"));
  pl_report_reason(d, PL_BOTH("these follow from the start"));
  pl_report_fix(d, PL_BOTH("use given quantities and other start values"), NULL);
}

static void check_target(pl_job* job, pl_model* m, const pl_init* x) {
  if (pl_is_poison(x->target)) return;
  pl_kind kind = pl_kind_of(m->pool, x->target);
  int dots = pl_max_dots(m->pool, x->target, job->arena);
  bool good = (kind == PL_SYMBOL || kind == PL_AT)
              && pl_has_coordinate(m->pool, x->target, job->arena) && dots < 2;
  if (good) return;
  pl_diagnostic* d = pl_tell(job, PL_E030, x->span,
                             PL_BOTH("only coordinates and velocities have start values"));
  pl_report_fix(d, "init x = 1, x' = 0", "init x = 1, x' = 0", NULL);
}

// Start values may use others, in any order, but not in a circle.
static int init_of(const pl_model* m, pl_symbol s) {
  for (int i = 0; i < m->inits.n; i++) {
    const pl_init* x = &m->inits.at[i];
    if (!x->guess && !pl_is_poison(x->target) && pl_kind_of(m->pool, x->target) == PL_SYMBOL
        && pl_symbol_of(m->pool, x->target).id == s.id)
      return i;
  }
  return -1;
}

static bool returns_to(const pl_model* m, pl_arena* a, int from, int wanted, char* visited) {
  pl_expr value = m->inits.at[from].value;
  if (pl_is_poison(value)) return false;
  int n = pl_symbols_in(m->pool, value, NULL, 0);
  pl_symbol* s = PL_ARRAY(a, pl_symbol, n + 1);
  pl_symbols_in(m->pool, value, s, n);
  for (int i = 0; i < n; i++) {
    int next = init_of(m, s[i]);
    if (next < 0) continue;
    if (next == wanted) return true;
    if (visited[next]) continue;
    visited[next] = 1;
    if (returns_to(m, a, next, wanted, visited)) return true;
  }
  return false;
}

static void check_init_circles(pl_job* job, pl_model* m) {
  for (int i = 0; i < m->inits.n; i++) {
    if (m->inits.at[i].guess || m->inits.at[i].block) continue;
    if (pl_is_poison(m->inits.at[i].value)
        || !pl_has_coordinate(m->pool, m->inits.at[i].value, job->arena))
      continue;
    if (!returns_to(m, job->arena, i, i, PL_ARRAY(job->arena, char, m->inits.n + 1))) continue;
    pl_diagnostic* d = pl_tell(job, PL_E045, m->inits.at[i].span,
                               PL_BOTH("these start values lead back to each other"));
    pl_report_fix(d, PL_BOTH("give one of them as a number"), NULL);
    return;
  }
}

// ---------------------------------------------------------------------------------------- simulate
static void check_span_of_simulation(pl_job* job, pl_model* m, const double* value) {
  const pl_simulate* s = &m->simulate;
  if (!s->given) return;
  double from = pl_is_poison(s->from) ? 0 : pl_eval(m->pool, s->from, value);
  double to = pl_is_poison(s->to) ? PL_NAN : pl_eval(m->pool, s->to, value);
  double step = pl_is_poison(s->step) ? 1 : pl_eval(m->pool, s->step, value);
  double tol = pl_is_poison(s->tol) ? 1e-9 : pl_eval(m->pool, s->tol, value);
  if (to <= from) {
    pl_diagnostic* d = pl_tell(
        job, PL_E047, s->span,
        PL_BOTH_FORMAT(job->arena, "the simulation ends at %.6g s, not after its start at %.6g s",
                       to, from));
    pl_report_fix(d, "simulate 0..10 [s]", "simulate 0..10 [s]", NULL);
  }
  if (step <= 0) {
    pl_diagnostic* d = pl_tell(job, PL_E047, s->span,
                               PL_BOTH("the step of the output has to be positive"));
    pl_report_fix(d, "simulate 0..10 step 0.01 [s]", "simulate 0..10 step 0.01 [s]", NULL);
  }
  if (tol <= 0 || tol >= 1) {
    pl_diagnostic* d = pl_tell(job, PL_E047, s->span,
                               PL_BOTH("the tolerance has to lie between 0 and 1"));
    pl_report_fix(d, "tol 1e-9", "tol 1e-9", NULL);
  }
}

typedef struct number_check {
  pl_model* m;
  pl_arena* arena;
  char* needed;  // by symbol id
} number_check;

static void see_symbols(void* user, const pl_slot* slot) {
  number_check* c = user;
  if (pl_is_poison(*slot->at)) return;
  switch (slot->kind) {
    case PL_SLOT_LET:
    case PL_SLOT_ASSUMPTION:
    case PL_SLOT_ASK:
    case PL_SLOT_PARAM: return;
    default: break;
  }
  int n = pl_symbols_in(c->m->pool, *slot->at, NULL, 0);
  pl_symbol* s = PL_ARRAY(c->arena, pl_symbol, n + 1);
  pl_symbols_in(c->m->pool, *slot->at, s, n);
  for (int i = 0; i < n; i++) {
    if (c->needed[s[i].id] == 0) c->needed[s[i].id] = 1;
  }
}

// What the value of a needed name needs; true when something new was looked at.
static bool need_value(number_check* c, pl_symbol s, pl_expr value) {
  if (!s.id || c->needed[s.id] != 1 || pl_is_poison(value)) return false;
  pl_slot slot = {&value, PL_SLOT_MASS, NULL, {0}};
  see_symbols(c, &slot);
  c->needed[s.id] = 2;
  return true;
}

// A simulation computes with numbers: every parameter that it meets needs one.
static void check_numbers_given(pl_job* job, pl_model* m) {
  if (!m->simulate.given) return;
  number_check c = {m, job->arena, PL_ARRAY(job->arena, char, pl_symbol_count(m->pool) + 1)};
  pl_model_each_slot(m, see_symbols, &c);
  // values of needed parameters and abbreviations need theirs
  for (bool more = true; more;) {
    more = false;
    for (int i = 0; i < m->params.n; i++)
      more |= need_value(&c, m->params.at[i].symbol, m->params.at[i].value);
    for (int i = 0; i < m->lets.n; i++)
      more |= need_value(&c, m->lets.at[i].symbol, m->lets.at[i].value);
  }
  for (int i = 0; i < m->params.n; i++) {
    const pl_param* p = &m->params.at[i];
    if (!c.needed[p->symbol.id] || !pl_is_poison(p->value) || p->input) continue;
    const pl_symbol_info* info = pl_symbol_get(m->pool, p->symbol);
    pl_diagnostic* d = pl_tell(
        job, PL_E048, p->span,
        PL_BOTH_FORMAT(job->arena, "%s has no number, but simulate computes with it", info->name));
    const char* unit = info->dimension_known ? pl_unit_of_symbol(job->arena, m->pool, p->symbol,
                                                                 info->dimension, true)
                                             : "1";
    bool pure = unit[0] == '1' && unit[1] == 0;
    const char* fix = pure ? PL_F(job, "param %s = 1", info->name)
                           : PL_F(job, "param %s = 1 [%s]", info->name, unit);
    pl_report_fix(d, fix, fix, NULL);
  }
}

// --------------------------------------------------------------------------- violated at the start
// Start values by symbol id, as far as they follow by insertion alone.
static double* start_values(pl_job* job, pl_model* m) {
  double* value = pl_model_values(m, job->arena);
  double t = m->simulate.given && !pl_is_poison(m->simulate.from)
                 ? pl_eval(m->pool, m->simulate.from, value)
                 : 0;
  value[pl_time(m->pool).id] = t;
  for (int pass = 0; pass <= m->inits.n + m->choose.n_maps; pass++) {
    bool more = false;
    for (int i = 0; i < m->inits.n; i++) {
      const pl_init* x = &m->inits.at[i];
      if (x->guess || x->block || !pl_is_poison(x->time) || pl_is_poison(x->target)
          || pl_is_poison(x->value))
        continue;
      if (pl_kind_of(m->pool, x->target) != PL_SYMBOL) continue;
      uint32_t id = pl_symbol_of(m->pool, x->target).id;
      if (!isnan(value[id])) continue;
      value[id] = pl_eval(m->pool, x->value, value);
      more |= !isnan(value[id]);
    }
    for (int i = 0; i < m->choose.n_maps; i++) {
      pl_expr old = m->choose.maps[i].old;
      if (pl_is_poison(old) || pl_kind_of(m->pool, old) != PL_SYMBOL
          || pl_is_poison(m->choose.maps[i].map))
        continue;
      uint32_t id = pl_symbol_of(m->pool, old).id;
      if (!isnan(value[id])) continue;
      value[id] = pl_eval(m->pool, m->choose.maps[i].map, value);
      more |= !isnan(value[id]);
    }
    if (!more) break;
  }
  return value;
}

// Sum of the absolute terms of g: the size that a residual is measured against.
static double size_of_terms(const pl_pool* p, pl_expr g, const double* value) {
  if (pl_kind_of(p, g) != PL_ADD) return fabs(pl_eval(p, g, value));
  double size = 0;
  for (int i = 0; i < pl_n_args(p, g); i++) size += fabs(pl_eval(p, pl_arg(p, g, i), value));
  return size;
}

static const double start_tolerance =
    1e-9;  // of the terms; what is smaller is projected away (language.md, Start values)

// ---------------------------------------------------------------------------------- what would fit
enum { MAX_ROOTS = 8, MAX_NEWTON_STEPS = 60 };

// Newton from x; false when it does not settle on a simple root of g.
static bool newton(const pl_model* m, pl_expr g, pl_expr slope, double* value, uint32_t id,
                   double* x) {
  for (int i = 0; i < MAX_NEWTON_STEPS; i++) {
    value[id] = *x;
    double f = pl_eval(m->pool, g, value), d = pl_eval(m->pool, slope, value);
    if (!isfinite(f) || !isfinite(d) || d == 0) return false;
    double step = f / d;
    *x -= step;
    if (fabs(step) <= 1e-14 * fabs(*x) + 1e-300) {
      value[id] = *x;
      return fabs(pl_eval(m->pool, g, value))
             <= 1e-3 * start_tolerance * size_of_terms(m->pool, g, value);
    }
  }
  return false;
}

static bool branch_allows(const pl_model* m, const double* value) {
  for (int i = 0; i < m->branches.n; i++) {
    const pl_condition* c = &m->branches.at[i];
    if (pl_is_poison(c->left) || pl_is_poison(c->right)) continue;
    double d = pl_eval(m->pool, c->left, value) - pl_eval(m->pool, c->right, value);
    if ((d < 0 && (c->relation == PL_GT || c->relation == PL_GE))
        || (d > 0 && (c->relation == PL_LT || c->relation == PL_LE)))
      return false;
  }
  return true;
}

// What rounding of the start values themselves can do to g: sum of |dg/dq| |q|. cos 90° is not
// exactly 0.
static double size_of_start(const pl_model* m, pl_expr g, const double* value) {
  double sum = 0;
  for (int i = 0; i < m->inits.n; i++) {
    const pl_init* x = &m->inits.at[i];
    if (x->guess || pl_is_poison(x->target) || pl_kind_of(m->pool, x->target) != PL_SYMBOL)
      continue;
    pl_symbol q = pl_symbol_of(m->pool, x->target);
    double slope = pl_eval(m->pool, pl_diff(m->pool, g, q), value);
    if (!isnan(slope) && !isnan(value[q.id])) sum += fabs(slope * value[q.id]);
  }
  return sum;
}

// Whether the values violate c; false where some of them are not known.
static bool violates(const pl_model* m, const pl_constraint* c, const double* value) {
  if (c->off || c->block || pl_is_poison(c->g) || c->while_label) return false;
  double g = pl_eval(m->pool, c->g, value);
  double size = size_of_terms(m->pool, c->g, value) + size_of_start(m, c->g, value);
  if (isnan(g) || isnan(size)) return false;
  if (c->relation == PL_GE) return g < -start_tolerance * size;
  if (c->relation == PL_LE) return g > start_tolerance * size;
  return fabs(g) > start_tolerance * size;
}

// Whether all constraints that speak of q are met, as far as their values are known.
static bool fits(const pl_model* m, pl_symbol q, const double* value) {
  for (int i = 0; i < m->constraints.n; i++) {
    const pl_constraint* c = &m->constraints.at[i];
    if (!pl_is_poison(c->g) && pl_has_symbol(m->pool, c->g, q) && violates(m, c, value))
      return false;
  }
  return true;
}

// The same place a turn further: no constraint tells x from x + 2 π.
static bool is_an_angle(const pl_model* m, pl_symbol q, double* value) {
  static const double turn = 6.28318530717958647692;
  double x = value[q.id];
  bool same = true;
  for (int i = 0; i < m->constraints.n && same; i++) {
    pl_expr g = m->constraints.at[i].g;
    if (pl_is_poison(g) || !pl_has_symbol(m->pool, g, q)) continue;
    double here = pl_eval(m->pool, g, value), size = size_of_terms(m->pool, g, value);
    value[q.id] = x + turn;
    double there = pl_eval(m->pool, g, value);
    value[q.id] = x;
    same = isnan(here) || fabs(there - here) <= 1e-12 * (size + fabs(there));
  }
  return same;
}

// Values of one coordinate, all others as given, that satisfy g = 0, the branches and all
// constraints that speak of it. Starts: around the given value.
static int fitting_values(const pl_model* m, pl_expr g, pl_symbol q, double* value,
                          double roots[MAX_ROOTS]) {
  double given = value[q.id];
  pl_expr slope = pl_diff(m->pool, g, q);
  if (pl_is_poison(slope) || isnan(given)) return 0;
  static const double factor[] = {1, -1, 0.5, -0.5, 2, -2},
                      shift[] = {0, 1, -1, 0.1, -0.1, 10, -10};
  static const double turn = 6.28318530717958647692;
  bool angle = is_an_angle(m, q, value);
  int n = 0;
  for (int i = 0; i < 13 && n < MAX_ROOTS; i++) {
    double x = i < 6 ? given * factor[i] : given + shift[i - 6];
    if (!newton(m, g, slope, value, q.id, &x) || !branch_allows(m, value) || !fits(m, q, value))
      continue;
    if (angle) x -= turn * nearbyint(x / turn);
    bool known = false;
    for (int k = 0; k < n; k++) known |= fabs(roots[k] - x) <= 1e-9 * (fabs(x) + fabs(roots[k]));
    if (!known) roots[n++] = x;
  }
  value[q.id] = given;
  return n;
}

// The value with as many digits as the check of the start needs, so that whoever types it is not
// refused.
static const char* typed_value(pl_job* job, const pl_model* m, pl_symbol q, double x, bool degrees,
                               double* value) {
  static const double degree = 0.017453292519943295769;
  double given = value[q.id];
  char text[40] = "";
  for (int digits = 6; digits <= 17; digits++) {
    snprintf(text, sizeof text, "%.*g", digits, degrees ? x / degree : x);
    value[q.id] = strtod(text, NULL) * (degrees ? degree : 1);
    if (fits(m, q, value)) break;
  }
  value[q.id] = given;
  return PL_F(job, "%s%s", text, degrees ? "°" : "");
}

// What stands in the text: "ψ = 20°" is answered in degrees.
static bool in_degrees(const pl_init* x) {
  if (!x->span.source) return false;
  const char* text = x->span.source->text;
  for (size_t i = x->span.begin; i + 1 < x->span.end; i++) {
    if (memcmp(text + i, "°", 2) == 0) return true;
  }
  return false;
}

static const char* value_text(pl_job* job, const pl_model* m, const pl_init* x, const double* roots,
                              int n, double* value) {
  pl_symbol q = pl_symbol_of(m->pool, x->target);
  const pl_symbol_info* info = pl_symbol_get(m->pool, q);
  pl_dimension d;
  const char* unit = "";
  bool pure = !pl_model_dimension(m, pl_sym(m->pool, q), &d)
              || pl_dimension_equal(d, pl_dimension_one());
  if (!pure) unit = PL_F(job, " %s", pl_dimension_unit(job->arena, d, false));
  const char* or = job->lang == PL_GERMAN ? pl_german(" or ") : " or ";
  pl_text t = pl_text_make(job->arena);
  pl_text_addf(&t, "%s%s = ", info->name, info->dots ? "'" : "");
  for (int i = 0; i < n; i++) {
    const char* number = typed_value(job, m, q, roots[i], pure && in_degrees(x), value);
    pl_text_addf(&t, "%s%s%s", i == 0 ? "" : or, number, unit);
  }
  return pl_text_string(&t);
}

// The start value to blame: the last one that the constraint speaks of and that has a value that
// would fit.
static const pl_init* blame(pl_job* job, const pl_model* m, pl_expr g, double* value,
                            const char** fit) {
  const pl_init* last = NULL;
  *fit = NULL;
  for (int i = m->inits.n - 1; i >= 0; i--) {
    const pl_init* x = &m->inits.at[i];
    if (x->guess || pl_is_poison(x->target) || pl_kind_of(m->pool, x->target) != PL_SYMBOL)
      continue;
    pl_symbol q = pl_symbol_of(m->pool, x->target);
    if (!pl_has_symbol(m->pool, g, q)) continue;
    if (!last) last = x;
    double roots[MAX_ROOTS];
    int n = fitting_values(m, g, q, value, roots);
    if (n == 0 || n > 4) continue;
    *fit = value_text(job, m, x, roots, n, value);
    return x;
  }
  return last;
}

static void tell_violated(pl_job* job, pl_model* m, const pl_constraint* c, double* value) {
  const char* name = c->name.text ? c->name.text : "?";
  const char* fit;
  const pl_init* x = blame(job, m, c->g, value, &fit);
  pl_diagnostic* d = pl_tell(job, PL_E041, x && x->span.source ? x->span : c->span,
                             PL_BOTH_FORMAT(job->arena, "the start violates %s", name));
  double left = pl_eval(m->pool, c->left, value), right = pl_eval(m->pool, c->right, value);
  static const char* const signs[] = {"=", ">=", "<=", ">", "<", "!="};
  const char* claim = PL_F(job, "%.6g %s %.6g", left, signs[c->relation], right);
  if (x && x->span.source && c->span.source)
    pl_report_label(
        job->diagnostics, d, c->span,
        PL_F(job, job->lang == PL_GERMAN ? pl_german("this would be %s") : "this would be %s",
             claim));
  else pl_report_reason(d, PL_BOTH_FORMAT(job->arena, "this would be %s", claim));
  if (fit) {
    pl_report_fix(
        d,
        PL_BOTH_FORMAT(job->arena,
                       "%s would fit. Change it, or remove it from init and let it follow", fit),
        NULL);
  } else {
    pl_report_fix(
        d, PL_BOTH("leave one of the start values out, and it follows from the constraints"), NULL);
  }
}

void pl_check_start(pl_job* job, pl_model* m) {
  for (int i = 0; i < m->inits.n; i++) {
    check_target(job, m, &m->inits.at[i]);
    check_init_value(job, m, &m->inits.at[i]);
  }
  if (job->diagnostics->n_errors == 0) check_twice(job, m);
  check_init_circles(job, m);
  check_span_of_simulation(job, m, pl_model_values(m, job->arena));
  check_numbers_given(job, m);
  if (job->diagnostics->n_errors) return;
  double* value = start_values(job, m);
  for (int i = 0; i < m->constraints.n; i++) {
    if (violates(m, &m->constraints.at[i], value))
      tell_violated(job, m, &m->constraints.at[i], value);
  }
}
