// where_follow: the motion followed in numbers up to the first place where a condition holds, for
// systems whose integrals do not
// suffice: several freedoms, drag. Explicit steps of order 5 with an error estimate
// [DormandPrince1980]; the place is found by
// bisection of the last step.
#include <math.h>
#include <string.h>

#include "where_impl.h"

enum { most = 24, most_steps = 40000, stages = 7 };  // coordinates; of one search; of a step
static const double driven_steps = 5000;             // of a motion that a drive prescribes
static const double most_work = 4e8;                 // operations of one search: some seconds
static const double tolerance = 1e-12;  // of a step, relative to the largest value so far
static const double safety = 0.9, grows = 4, shrinks = 0.2;

typedef struct flow {
  pl_analysis* d;
  double* value;  // numbers by symbol id
  int n;          // coordinates
  int coordinate[most];
  pl_expr f;          // whose zero is looked for
  int direction;      // +1 rising, -1 falling, 0 both
  int n_definitions;  // coordinates, velocities and names of closed loops, in one assembly
  pl_definition* definition;
} flow;

static void put(const flow* w, double t, const double* y) {
  w->value[pl_time(w->d->pool).id] = t;
  for (int k = 0; k < w->n; k++) {
    const pl_variable* c = &w->d->q.at[w->coordinate[k]];
    w->value[c->q.id] = y[k];
    w->value[c->v.id] = y[w->n + k];
  }
  for (int k = 0; k < w->n_definitions; k++) {
    w->value[w->definition[k].symbol.id] = pl_eval(w->d->pool, w->definition[k].value, w->value);
  }
}

static void slope(const flow* w, double t, const double* y, double* out) {
  put(w, t, y);
  for (int k = 0; k < w->n; k++) {
    out[k] = y[w->n + k];
    out[w->n + k] = pl_eval(w->d->pool, w->d->acceleration[w->coordinate[k]], w->value);
  }
}

static double watched(const flow* w, double t, const double* y) {
  put(w, t, y);
  return pl_eval(w->d->pool, w->f, w->value);
}

// One step of length h; returns its estimated error relative to `size`.
static double step(const flow* w, double t, const double* y, double h, const double* size,
                   double* out) {
  // clang-format off
  static const double c[stages] = {0, 1.0/5, 3.0/10, 4.0/5, 8.0/9, 1, 1};
  static const double a[stages][stages] = {
    {0}, {1.0/5}, {3.0/40, 9.0/40}, {44.0/45, -56.0/15, 32.0/9},
    {19372.0/6561, -25360.0/2187, 64448.0/6561, -212.0/729},
    {9017.0/3168, -355.0/33, 46732.0/5247, 49.0/176, -5103.0/18656},
    {35.0/384, 0, 500.0/1113, 125.0/192, -2187.0/6784, 11.0/84}};
  static const double e[stages] = {
    71.0/57600, 0, -71.0/16695, 71.0/1920, -17253.0/339200, 22.0/525, -1.0/40};
  // clang-format on
  double k[stages][2 * most], z[2 * most];
  int n = 2 * w->n;
  for (int s = 0; s < stages; s++) {
    for (int i = 0; i < n; i++) {
      z[i] = y[i];
      for (int j = 0; j < s; j++) z[i] += h * a[s][j] * k[j][i];
    }
    slope(w, t + c[s] * h, z, k[s]);
  }
  memcpy(out, z, (size_t)n * sizeof *z);
  double worst = 0;
  for (int i = 0; i < n; i++) {
    double error = 0;
    for (int s = 0; s < stages; s++) error += h * e[s] * k[s][i];
    if (!(fabs(error) <= worst * size[i])) worst = fabs(error) / size[i];
  }
  return worst;
}

static bool starts(const flow* w, const pl_motion* motion, double* y) {
  for (int k = 0; k < w->n; k++) {
    const pl_variable* c = &w->d->q.at[w->coordinate[k]];
    pl_expr q0, v0;
    pl_motion_start(w->d, motion, c, &q0, &v0);
    y[k] = pl_number(w->d, q0);
    y[w->n + k] = pl_number(w->d, v0);
    if (isnan(y[k]) || isnan(y[w->n + k])) return false;
  }
  return true;
}

static bool follows(pl_analysis* d, flow* w, int assembly) {
  bool still = d->gen.n == 0 && pl_scleronomic(d);  // a drive alone moves the others
  if (!d->solved || !d->reduced || still || d->gen.n > most || pl_nonholonomic(d)) return false;
  for (int k = 0; k < d->gen.n; k++) {
    w->coordinate[w->n++] = d->gen.at[k];
    if (pl_is_poison(d->acceleration[d->gen.at[k]])) return false;
  }
  w->n_definitions = pl_loop_definitions(d, assembly, NULL);
  w->definition = PL_ARRAY(d->arena, pl_definition, w->n_definitions + 1);
  pl_loop_definitions(d, assembly, w->definition);
  return true;
}

// Steps that most_work allows.
static int steps_of(const flow* w) {
  double work = (double)pl_op_count(w->d->pool, w->f);
  for (int k = 0; k < w->n; k++)
    work += (double)pl_op_count(w->d->pool, w->d->acceleration[w->coordinate[k]]);
  for (int k = 0; k < w->n_definitions; k++)
    work += (double)pl_op_count(w->d->pool, w->definition[k].value);
  double steps = most_work / (stages * (work + 1));
  return steps < most_steps ? (int)steps : most_steps;
}

// The time and state of the first zero of w->f; the start does not count.
static pl_followed_how first_zero(const flow* w, double end, double* time, double* y) {
  double size[2 * most], next[2 * most], t = 0, h = 1e-3, before = watched(w, 0, y);
  int n = 2 * w->n, steps = steps_of(w);
  bool leaves = fabs(before) == 0;
  // without coordinates there is no error that holds the step back
  double longest = n == 0 ? end / driven_steps : end;
  for (int i = 0; i < n; i++) size[i] = fabs(y[i]) > 1e-3 ? fabs(y[i]) : 1e-3;
  for (int k = 0; k < steps && t < end; k++) {
    if (k % 256 == 255 && pl_interrupted(w->d->job)) return PL_FOLLOWED_NOT;
    h = fmin(h, longest);
    if (t + h > end) h = end - t;
    double error = step(w, t, y, h, size, next) / tolerance;
    if (!(error <= 1)) {
      h *= isfinite(error) && error < 1e10 ? fmax(shrinks, safety * pow(error, -0.2)) : shrinks;
      if (h < 1e-12 * (1 + t)) return PL_FOLLOWED_NOT;
      *time = t;
      continue;
    }
    double after = watched(w, t + h, next);
    bool this_way = w->direction == 0 || (after > before) == (w->direction > 0);
    if (!leaves && isfinite(after) && (before > 0) != (after > 0) && this_way) {
      double low = 0, high = h;
      for (int i = 0; i < 100; i++) {
        double m = 0.5 * (low + high);
        if (m == low || m == high) break;
        step(w, t, y, m, size, next);
        if ((watched(w, t + m, next) > 0) == (before > 0)) low = m;
        else high = m;
      }
      step(w, t, y, high, size, next);
      memcpy(y, next, (size_t)n * sizeof *y);
      *time = t + high;
      return PL_FOLLOWED_MET;
    }
    t += h;
    *time = t;
    leaves = false;
    before = after;
    memcpy(y, next, (size_t)n * sizeof *y);
    for (int i = 0; i < n; i++) size[i] = fmax(size[i], fabs(y[i]));
    h *= error > 0 ? fmin(grows, safety * pow(error, -0.2)) : grows;
  }
  return PL_FOLLOWED_PAST;
}

static double end_of(pl_analysis* d) {
  static const double long_time = 1e3;  // s, where the model says nothing
  if (!d->model->simulate.given) return long_time;
  double end = pl_number(d, d->model->simulate.to);
  return end > 0 ? end : long_time;
}

static const pl_form* time_form(pl_analysis* d, double t) {
  pl_notation how = {.math = PL_MATH_LINE, .lang = d->job->lang};
  return pl_feq(d, pl_fs(d, pl_time(d->pool)),
                pl_fn(d, pl_format(d->arena, "%s s", pl_notation_number(d->arena, t, 6, how))));
}

// A contact that would have to pull on the way there.
static void look_at_contacts(flow* w, const pl_search* p, const pl_motion* motion, double until,
                             pl_followed* out) {
  for (int k = 0; k < p->n_contacts; k++) {
    double y[2 * most];
    starts(w, motion, y);
    w->f = p->push[k];
    out->lost_at = 0;
    bool at_once = watched(w, 0, y) < 0;
    if (!at_once && first_zero(w, until * (1 - 1e-9), &out->lost_at, y) != PL_FOLLOWED_MET)
      continue;
    out->lost = k;
    return;
  }
}

static bool begin(pl_analysis* d, const pl_search* p, int assembly, flow* w) {
  *w = (flow){.d = d, .f = p->condition};
  pl_number(d, pl_add(d->pool, p->condition, p->asked));  // the table of numbers covers every name
  w->value = PL_ARRAY(d->arena, double, pl_symbol_count(d->pool) + 1);
  memcpy(w->value, d->value, (size_t)(pl_symbol_count(d->pool) + 1) * sizeof *w->value);
  return follows(d, w, assembly);
}

void pl_follow_motion(pl_analysis* d, const pl_motion* motion, int assembly, const pl_search* p,
                      pl_followed* out) {
  flow w;
  double y[2 * most];
  *out = (pl_followed){.how = PL_FOLLOWED_NOT, .lost = -1};
  if (!begin(d, p, assembly, &w) || !starts(&w, motion, y)) return;
  if (isnan(watched(&w, 0, y)) || isnan(pl_eval(d->pool, p->asked, w.value))) return;
  out->how = first_zero(&w, end_of(d), &out->time, y);
  if (out->how == PL_FOLLOWED_NOT) return;
  put(&w, out->time, y);
  if (out->how == PL_FOLLOWED_MET) out->asked = pl_eval(d->pool, p->asked, w.value);
  look_at_contacts(&w, p, motion, out->time, out);
}

void pl_say_followed(pl_analysis* d, const pl_search* p, const pl_followed* f) {
  if (f->lost >= 0 && p->side[f->lost]) {
    pl_say_left_before(d, p->side[f->lost], time_form(d, f->lost_at));
    return;
  }
  if (f->lost >= 0 && p->open[f->lost]) {
    pl_say_met_before(d, p->contact[f->lost], time_form(d, f->lost_at));
    return;
  }
  if (f->lost >= 0) {
    pl_say(d, PL_BOTH("{1} lets go before, at {2}; beyond it the formulas do not hold."), 2,
           pl_fn(d, p->contact[f->lost]), time_form(d, f->lost_at));
    return;
  }
  d->page->section->not_found = true;
  if (f->how == PL_FOLLOWED_PAST) {
    pl_say(d, PL_BOTH("As far as {1} this does not happen on the motion."), 1,
           time_form(d, f->time));
    return;
  }
  pl_say(d, PL_BOTH("No solution in closed form was found; for the given numbers:"), 0);
  pl_show_met_number(d, p->name, f->asked);
}

// ------------------------------------------------------------------------------------------ events
static bool changes_the_motion(const pl_event* e) {
  for (int k = 0; k < e->actions.n; k++) {
    if (e->actions.at[k].kind != PL_DO_STOP && e->actions.at[k].kind != PL_DO_RECORD) return true;
  }
  return false;
}

// The first event that changes the motion, up to the time `until`; NULL.
static const pl_event* first_event(pl_analysis* d, flow* w, const pl_motion* motion, double until,
                                   double* time) {
  const pl_event* first = NULL;
  for (int k = 0; k < d->whole->events.n; k++) {
    const pl_event* e = &d->whole->events.at[k];
    double y[2 * most], t = 0;
    if (!changes_the_motion(e) || !starts(w, motion, y)) continue;
    w->f = pl_on_motion(d, pl_with_results(d, e->value));
    w->direction = e->direction;
    if (isnan(watched(w, 0, y)) || first_zero(w, until * (1 - 1e-9), &t, y) != PL_FOLLOWED_MET)
      continue;
    first = e;
    until = *time = t;
  }
  return first;
}

bool pl_say_event_before(pl_analysis* d, const pl_motion* motion, const pl_search* p) {
  bool any = false;
  for (int k = 0; d->whole && k < d->whole->events.n; k++)
    any |= changes_the_motion(&d->whole->events.at[k]);
  // the time of a later set counts from its beginning
  if (!any || (d->stage && d->stage->from > 0)) return false;
  pl_followed f;
  flow w;
  double time = 0;
  pl_follow_motion(d, motion, 0, p, &f);
  double y[2 * most];
  if (f.how == PL_FOLLOWED_NOT || !begin(d, p, 0, &w) || !starts(&w, motion, y)) return false;
  if (watched(&w, 0, y) == 0) return false;  // at the start already
  const pl_event* e = first_event(d, &w, motion, f.time, &time);
  if (!e) return false;
  pl_say(d, PL_BOTH("{1} comes before, at {2}; beyond it the formulas do not hold."), 2,
         pl_fn(d, e->name.text ? e->name.text : "event"), time_form(d, time));
  return true;
}
