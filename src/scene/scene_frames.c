// Times of the frames and the numbers at each of them. Between two rows of the result positions
// follow the cubic through positions and velocities at both ends (Hermite); at rows and events they
// are the row itself.
#include "scene/scene_impl.h"

#include <math.h>
#include <string.h>

enum { FRAMES = 240, MOST_EVENT_FRAMES = 64 };

// ------------------------------------------------------------------------------------------- times
static double first_time(const pl_result* r) { return r->rows.at[0][0]; }
static double last_time(const pl_result* r) { return r->rows.at[r->rows.n - 1][0]; }

// Even times; the one nearest to an event becomes that of the event.
static void choose_times(pl_stage* s) {
  const pl_result* r = s->result;
  int n = s->options->frames > 1 ? s->options->frames : s->options->frames == 1 ? 1 : FRAMES;
  double t_0 = first_time(r), T = last_time(r) - t_0;
  if (T == 0 || r->rows.n < 2) n = 1;
  s->n_frames = n;
  s->t = PL_ARRAY(s->arena, double, n);
  bool* taken = PL_ARRAY(s->arena, bool, n);
  for (int i = 0; i < n; i++) s->t[i] = n > 1 ? t_0 + T * i / (n - 1) : t_0;
  if (n < 3) return;
  taken[0] = taken[n - 1] = true;
  for (int i = 0; i < r->events.n && i < MOST_EVENT_FRAMES; i++) {
    int k = (int)lround((r->events.at[i].t - t_0) / T * (n - 1));
    if (k < 0 || k >= n || taken[k]) continue;
    s->t[k] = r->events.at[i].t;
    taken[k] = true;
  }
}

// ----------------------------------------------------------------------------------------- numbers
// The last row that does not lie behind t (in the direction of the run).
static int row_before(const pl_result* r, double t) {
  double sign = last_time(r) >= first_time(r) ? 1 : -1;
  int lo = 0, hi = r->rows.n - 1;
  while (lo < hi) {
    int mid = (lo + hi + 1) / 2;
    if (sign * (r->rows.at[mid][0] - t) <= 0) lo = mid;
    else hi = mid - 1;
  }
  return lo;
}

// ORDER STATE: t, q, v, λ, as the columns of a result begin.
static void fill_frame(pl_stage* s, int frame) {
  const pl_result* r = s->result;
  double* x = s->state + (size_t)frame * (size_t)s->n_state;
  double t = s->t[frame];
  int i = row_before(r, t);
  const double* a = r->rows.at[i];
  memcpy(x, a, (size_t)s->n_state * sizeof *x);
  x[0] = t;
  if (i + 1 >= r->rows.n || a[0] == t) return;
  const double* b = r->rows.at[i + 1];
  double h = b[0] - a[0], u = (t - a[0]) / h;
  if (h == 0) return;
  int n = s->n_q;
  for (int k = 0; k < n; k++) {
    double qa = a[1 + k], qb = b[1 + k], va = a[1 + n + k] * h, vb = b[1 + n + k] * h;
    double c = 3 * (qb - qa) - 2 * va - vb, d = 2 * (qa - qb) + va + vb;
    x[1 + k] = qa + u * (va + u * (c + u * d));
    x[1 + n + k] = (va + u * (2 * c + 3 * u * d)) / h;
  }
  for (int k = 1 + 2 * n; k < s->n_state; k++) x[k] = isnan(b[k]) ? a[k] : a[k] + u * (b[k] - a[k]);
}

pleuel_status pl_stage_frames(pl_stage* s) {
  s->n_lambda = 0;
  for (int i = 0; i < s->bonds.n; i++) s->bonds.at[i].link = s->n_lambda++;
  s->n_state = 1 + 2 * s->n_q + s->n_lambda;
  bool usable = s->result && s->result->rows.n > 0 && s->result->n_columns >= s->n_state;
  if (!usable) {
    s->result = NULL;
    s->n_frames = 1;
    s->t = PL_ARRAY(s->arena, double, 1);
    s->state = PL_ARRAY(s->arena, double, s->n_state);
    for (int k = 1 + 2 * s->n_q; k < s->n_state; k++) s->state[k] = (double)NAN;
    pl_stage_sketch(s);
    return PLEUEL_OK;
  }
  choose_times(s);
  s->state = PL_ARRAY(s->arena, double, (size_t)s->n_frames*(size_t)s->n_state);
  for (int f = 0; f < s->n_frames; f++) {
    if (pl_interrupted(s->job)) return PLEUEL_INTERRUPTED;
    fill_frame(s, f);
  }
  return PLEUEL_OK;
}

void pl_stage_set(pl_stage* s, int frame) {
  const double* x = s->state + (size_t)frame * (size_t)s->n_state;
  s->value[pl_time(s->pool).id] = x[0];
  for (int k = 0; k < s->n_q; k++) {
    s->value[s->q[k].id] = x[1 + k];
    s->value[s->v[k].id] = x[1 + s->n_q + k];
  }
  for (int i = 0; i < s->bonds.n; i++) {
    pl_symbol lambda = s->bonds.at[i].c->lambda;
    if (lambda.id && (int)lambda.id < s->n_value)
      s->value[lambda.id] = x[1 + 2 * s->n_q + s->bonds.at[i].link];
  }
}

double pl_stage_eval(const pl_stage* s, pl_expr e) {
  pl_kind kind = pl_kind_of(s->pool, e);
  if (kind == PL_SYMBOL) return s->value[pl_symbol_of(s->pool, e).id];
  if (kind == PL_NUMBER) return pl_number_double(s->pool, e);
  return pl_eval(s->pool, e, s->value);
}

void pl_stage_spot(const pl_stage* s, const pl_spot* spot, double x[3]) {
  for (int j = 0; j < 3; j++) {
    x[j] = spot->fixed ? spot->at[j] : pl_is_poison(spot->e[j]) ? 0 : pl_stage_eval(s, spot->e[j]);
  }
  if (s->model->n_axes < 2) x[1] = spot->side;
  if (spot->fixed || pl_is_poison(spot->angle)) return;
  double a = spot->sense * pl_stage_eval(s, spot->angle);
  x[0] += spot->p[0] * cos(a) - spot->p[1] * sin(a);
  x[1] += spot->p[0] * sin(a) + spot->p[1] * cos(a);
}
