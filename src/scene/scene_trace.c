// The curve that constraints leave to a thing: q(σ) with g(q) = 0, followed in steps of even length
// in space by the method of Runge and Kutta (order 4) along the null vector of dg/dq, with Newton
// corrections back to g = 0.
#include <math.h>
#include <string.h>

#include "scene/scene_impl.h"

enum { MOST_STEPS = 1200 };

pl_track* pl_track_make(pl_stage* s, int thing, const pl_expr* eq, int n_eq, const int* q,
                        int n_q) {
  if (n_q > 8 || n_eq > 8 || n_q < 1) return NULL;
  pl_track* t = PL_NEW(s->arena, pl_track);
  const pl_spot* spot = &s->things.at[thing].spot;
  t->thing = thing;
  t->n_eq = n_eq;
  t->n_q = n_q;
  t->fixed_axis = -1;
  for (int k = 0; k < n_q; k++) {
    t->q[k] = q[k];
    for (int i = 0; i < n_eq; i++) t->G[i][k] = pl_diff(s->pool, eq[i], s->q[q[k]]);
    for (int j = 0; j < 3; j++) {
      t->J[j][k] = pl_is_poison(spot->e[j]) ? pl_int(s->pool, 0)
                                            : pl_diff(s->pool, spot->e[j], s->q[q[k]]);
    }
  }
  for (int i = 0; i < n_eq; i++) t->eq[i] = eq[i];
  for (int j = 0; j < 3; j++) {
    double middle = (s->hi[j] + s->lo[j]) / 2,
           half = fmax(0.62 * (s->hi[j] - s->lo[j]), (s->n_frames > 1 ? 0.3 : 0.6) * s->size);
    t->box_lo[j] = middle - half;
    t->box_hi[j] = middle + half;
    // the origin belongs to it
    if (t->box_lo[j] > 0 && t->box_lo[j] < s->size) t->box_lo[j] = -0.1 * s->size;
    if (t->box_hi[j] < 0 && t->box_hi[j] > -s->size) t->box_hi[j] = 0.1 * s->size;
  }
  t->n = 121;
  return t;
}

// Rows: the equations, then the slice.
static int rows(const pl_stage* s, const pl_track* t, double* A, double* r) {
  int m = t->n_eq + (t->fixed_axis >= 0);
  for (int i = 0; i < t->n_eq; i++) {
    for (int k = 0; k < t->n_q; k++) A[i * t->n_q + k] = pl_stage_eval(s, t->G[i][k]);
    if (r) r[i] = -pl_stage_eval(s, t->eq[i]);
  }
  if (t->fixed_axis >= 0) {
    int i = t->n_eq, j = t->fixed_axis;
    for (int k = 0; k < t->n_q; k++) A[i * t->n_q + k] = pl_stage_eval(s, t->J[j][k]);
    if (r) r[i] = t->fixed_at - pl_stage_eval(s, s->things.at[t->thing].spot.e[j]);
  }
  return m;
}

static void get(const pl_stage* s, const pl_track* t, double* q) {
  for (int k = 0; k < t->n_q; k++) q[k] = s->value[s->q[t->q[k]].id];
}
static void put(pl_stage* s, const pl_track* t, const double* q) {
  for (int k = 0; k < t->n_q; k++) s->value[s->q[t->q[k]].id] = q[k];
}

static bool correct(pl_stage* s, const pl_track* t) {
  double A[9 * 8], r[9], dq[8], q[8];
  for (int round = 0; round < 12; round++) {
    int m = rows(s, t, A, r);
    double size = 0, scale = 0;
    for (int i = 0; i < m; i++) {
      if (!isfinite(r[i])) return false;
      size = fmax(size, fabs(r[i]));
      for (int k = 0; k < t->n_q; k++) scale = fmax(scale, fabs(A[i * t->n_q + k]));
    }
    if (size <= 1e-11 * fmax(scale, 1e-12) * fmax(s->size, 1e-12)) return true;
    if (!pl_least(A, r, m, t->n_q, dq)) return false;
    get(s, t, q);
    for (int k = 0; k < t->n_q; k++) q[k] += dq[k];
    put(s, t, q);
    if (round == 11) return size < 1e-6 * fmax(scale, 1e-12) * s->size;
  }
  return true;
}

int pl_track_freedom(pl_stage* s, const pl_track* t) {
  double A[9 * 8], null[8][8];
  int m = rows(s, t, A, NULL);
  return pl_null_space(A, m, t->n_q, null);
}

// dq/dσ with |dX/dσ| = 1, going on in the direction of `before`. false: no single direction, or the
// place stays.
static bool slope(pl_stage* s, const pl_track* t, const double* before, double* dq, double dx[3]) {
  double A[9 * 8], null[8][8];
  int m = rows(s, t, A, NULL);
  for (int i = 0; i < m * t->n_q; i++)
    if (!isfinite(A[i])) return false;
  if (pl_null_space(A, m, t->n_q, null) != 1) return false;
  double speed = 0, along = 0;
  for (int j = 0; j < 3; j++) {
    dx[j] = 0;
    for (int k = 0; k < t->n_q; k++) dx[j] += pl_stage_eval(s, t->J[j][k]) * null[0][k];
    speed += dx[j] * dx[j];
  }
  speed = sqrt(speed);
  if (!(speed > 1e-9) || !isfinite(speed)) return false;
  for (int k = 0; k < t->n_q; k++) along += before ? null[0][k] * before[k] : null[0][k];
  double f = (before && along < 0 ? -1 : 1) / speed;
  for (int k = 0; k < t->n_q; k++) dq[k] = null[0][k] * f;
  for (int j = 0; j < 3; j++) dx[j] *= f;
  return true;
}

static void place(const pl_stage* s, const pl_track* t, double x[3]) {
  pl_stage_spot(s, &s->things.at[t->thing].spot, x);
}

// One step of length h from q; before: dq/dσ there.
static bool step(pl_stage* s, const pl_track* t, double* q, double* before, double h) {
  double k1[8], k[8], sum[8], q0[8], dx[3];
  memcpy(q0, q, sizeof(double) * (size_t)t->n_q);
  put(s, t, q0);
  if (!slope(s, t, before, k1, dx)) return false;
  memcpy(sum, k1, sizeof sum);
  memcpy(k, k1, sizeof k);
  static const double at[3] = {0.5, 0.5, 1}, weight[3] = {2, 2, 1};
  for (int stage = 0; stage < 3; stage++) {
    for (int i = 0; i < t->n_q; i++) q[i] = q0[i] + at[stage] * h * k[i];
    put(s, t, q);
    double next[8];
    if (!slope(s, t, k1, next, dx)) return false;
    memcpy(k, next, sizeof k);
    for (int i = 0; i < t->n_q; i++) sum[i] += weight[stage] * k[i];
  }
  for (int i = 0; i < t->n_q; i++) q[i] = q0[i] + h / 6 * sum[i];
  put(s, t, q);
  if (!correct(s, t)) return false;
  get(s, t, q);
  memcpy(before, k1, sizeof(double) * (size_t)t->n_q);
  return true;
}

static bool outside(const pl_track* t, const double x[3], double slack) {
  for (int j = 0; j < 3; j++) {
    double d = slack * (t->box_hi[j] - t->box_lo[j]);
    if (x[j] < t->box_lo[j] - d || x[j] > t->box_hi[j] + d) return true;
  }
  return false;
}

typedef PL_VEC(double) pl_doubles;

// Follows one way until the curve closes or leaves the neighbourhood; far: how far beyond the box
// it may go.
static bool follow(pl_stage* s, const pl_track* t, const double* q0, double h, double far,
                   pl_doubles* out) {
  double q[8], before[8], x[3], x0[3], dx[3];
  memcpy(q, q0, sizeof(double) * (size_t)t->n_q);
  put(s, t, q);
  if (!slope(s, t, NULL, before, dx)) return false;
  if (h < 0)
    for (int k = 0; k < t->n_q; k++) before[k] = -before[k];
  place(s, t, x0);
  double last[3] = {x0[0], x0[1], x0[2]};
  for (int i = 0; i < MOST_STEPS; i++) {
    if (!step(s, t, q, before, fabs(h))) return false;
    place(s, t, x);
    double gone = 0, home = 0;
    for (int j = 0; j < 3; j++) {
      if (!isfinite(x[j])) return false;
      gone += (x[j] - last[j]) * (x[j] - last[j]);
      home += (x[j] - x0[j]) * (x[j] - x0[j]);
    }
    if (gone > 9 * h * h) return false;
    if (outside(t, x, far)) return false;
    memcpy(last, x, sizeof last);
    if (i > 3 && home < 0.9 * h * h) return true;
    for (int j = 0; j < 3; j++) pl_push(s->arena, *out, x[j]);
  }
  return false;
}

// n points at even distances along a poly-line of m points.
static void resample(const double* from, int m, double* to, int n) {
  double total = 0, gone = 0;
  for (int i = 1; i < m; i++)
    total += sqrt(pow(from[3 * i] - from[3 * i - 3], 2) + pow(from[3 * i + 1] - from[3 * i - 2], 2)
                  + pow(from[3 * i + 2] - from[3 * i - 1], 2));
  int i = 0;
  double piece = 0;
  for (int k = 0; k < n; k++) {
    double want = n > 1 ? total * k / (n - 1) : 0;
    for (; i + 1 < m; i++) {
      piece = sqrt(pow(from[3 * i + 3] - from[3 * i], 2) + pow(from[3 * i + 4] - from[3 * i + 1], 2)
                   + pow(from[3 * i + 5] - from[3 * i + 2], 2));
      if (gone + piece >= want || i + 2 == m) break;
      gone += piece;
    }
    double u = piece > 0 && i + 1 < m ? fmin(1, fmax(0, (want - gone) / piece)) : 0;
    for (int j = 0; j < 3; j++)
      to[3 * k + j] = from[3 * i + j]
                      + (i + 1 < m ? u * (from[3 * i + 3 + j] - from[3 * i + j]) : 0);
  }
}

int pl_track_follow(pl_stage* s, const pl_track* t, double* xyz, bool* closed) {
  double kept[8], q0[8], x[3];
  pl_doubles ahead = {0}, behind = {0};
  *closed = false;
  for (int i = 0; i < 3 * t->n; i++) xyz[i] = (double)NAN;
  get(s, t, kept);
  bool fine = correct(s, t);
  get(s, t, q0);
  place(s, t, x);
  int n = 0;
  if (fine && isfinite(x[0] + x[1] + x[2])) {
    double h = s->size / 70, far = t->whole ? 1.5 : 0;
    *closed = follow(s, t, q0, h, far, &ahead);
    if (!*closed && far > 0) {  // an open curve ends with the neighbourhood
      ahead.n = 0;
      follow(s, t, q0, h, 0, &ahead);
    }
    if (!*closed) follow(s, t, q0, -h, 0, &behind);
    if (*closed && !t->whole) *closed = false;
    int m = ahead.n / 3 + behind.n / 3 + 1 + *closed;
    double* all = PL_ARRAY(s->arena, double, 3 * m);
    for (int i = 0; i < behind.n / 3; i++)
      memcpy(all + 3 * i, behind.at + behind.n - 3 * (i + 1), 3 * sizeof(double));
    memcpy(all + behind.n, x, 3 * sizeof(double));
    if (ahead.n) memcpy(all + behind.n + 3, ahead.at, (size_t)ahead.n * sizeof(double));
    if (*closed) memcpy(all + 3 * (m - 1), x, 3 * sizeof(double));
    if (m > 1) {
      resample(all, m, xyz, t->n);
      n = t->n;
    }
  }
  put(s, t, kept);
  return n;
}

bool pl_track_normal(pl_stage* s, const pl_track* t, double n[3]) {
  // the direction in space in which eq[0] rises fastest: smallest dq with G dq = e_0, moved to
  // space
  double A[9 * 8], r[9] = {1}, dq[8], kept[8];
  get(s, t, kept);
  bool fine = correct(s, t);
  int m = rows(s, t, A, NULL);
  fine = fine && pl_least(A, r, m, t->n_q, dq);
  for (int j = 0; j < 3; j++) {
    n[j] = 0;
    for (int k = 0; fine && k < t->n_q; k++) n[j] += pl_stage_eval(s, t->J[j][k]) * dq[k];
  }
  put(s, t, kept);
  double norm = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  for (int j = 0; norm > 0 && j < 3; j++) n[j] /= norm;
  return fine && norm > 0 && isfinite(norm);
}
