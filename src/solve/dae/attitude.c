// Bodies in space that are declared in Euler angles and integrated as unit quaternions: the angles
// of rows.
//
// With z_1 = q_0 + i q_3 and z_2 = q_1 + i q_2
//
//   z_1 = cos(ϑ/2) e^(i (φ + ψ)/2),   z_2 = sin(ϑ/2) e^(i (φ - ψ)/2)
//
// so φ + ψ is an argument of z_1, φ - ψ one of z_2, and the singular attitudes are z_2 = 0 (ϑ = 0)
// and z_1 = 0 (ϑ = 180°). A rotation has the angles (φ, ϑ, ψ), (φ + 180°, -ϑ, ψ + 180°) and what
// whole turns make of them; of these the motion is followed continuously along its series. Through
// a zero of z_2 or z_1 it goes on with φ and ψ continuous while ϑ changes its sign or passes 180°.
// Where it stays in a zero, the argument that is lost goes on at the last rate that it had.
// See theory (8.2).
#include <complex.h>
#include <math.h>
#include <string.h>

#include "solve/dae/dae.h"

static const double lost = 1e-12;  // |z| below which its argument is rounding

typedef double complex pl_complex;

// The two numbers of a body with two derivatives.
typedef struct pl_halves {
  pl_complex z[2], v[2], a[2];
} pl_halves;

// CMPLX of the standard is not there with every compiler.
static pl_complex number(double re, double im) { return __builtin_complex(re, im); }

static pl_complex unit(double angle) { return number(cos(angle), sin(angle)); }

static pl_halves halves_of(const pl_attitude_setup* t, const double* q, const double* v,
                           const double* a) {
  const int s = t->scalar, *n = t->angle;
  pl_halves h = {.z = {number(q[s], q[n[2]]), number(q[n[0]], q[n[1]])},
                 .v = {number(v[s], v[n[2]]), number(v[n[0]], v[n[1]])}};
  if (a) {
    h.a[0] = number(a[s], a[n[2]]);
    h.a[1] = number(a[n[0]], a[n[1]]);
  }
  return h;
}

// ---------------------------------------------------------------------- from angles to quaternions
static void to_quaternion(const pl_attitude_setup* t, const double* angle, const double* rate,
                          double* q, double* v) {
  double half = angle[1] / 2, c = cos(half), s = sin(half), nod = rate[1] / 2;
  pl_complex e_1 = unit((angle[0] + angle[2]) / 2), e_2 = unit((angle[0] - angle[2]) / 2);
  pl_complex z_1 = c * e_1, z_2 = s * e_2;
  pl_complex v_1 = number(-s * nod, c * (rate[0] + rate[2]) / 2) * e_1,
             v_2 = number(c * nod, s * (rate[0] - rate[2]) / 2) * e_2;
  q[t->scalar] = creal(z_1);
  q[t->angle[2]] = cimag(z_1);
  q[t->angle[0]] = creal(z_2);
  q[t->angle[1]] = cimag(z_2);
  v[t->scalar] = creal(v_1);
  v[t->angle[2]] = cimag(v_1);
  v[t->angle[0]] = creal(v_2);
  v[t->angle[1]] = cimag(v_2);
}

// ---------------------------------------------------------------------- from quaternions to angles
// The unit number along z; along its derivative where z vanishes; as it was where that does too.
static pl_complex direction(pl_complex z, pl_complex v, double otherwise) {
  if (cabs(z) > lost) return z / cabs(z);
  if (cabs(v) > lost) return v / cabs(v);
  return unit(otherwise);
}

static double nearest_turn(double x, double reference) {
  return x + 2 * M_PI * nearbyint((reference - x) / (2 * M_PI));
}

static double distance(const double* x, const double* y) {
  return fabs(x[0] - y[0]) + fabs(x[1] - y[1]) + fabs(x[2] - y[2]);
}

// The angles of a rotation next to the reference.
static void nearest_angles(double sum, double nod, double difference, const double* reference,
                           double* out) {
  double plain[3] = {sum + difference, nod, sum - difference},
         other[3] = {plain[0] + M_PI, -nod, plain[2] + M_PI};
  for (int i = 0; i < 3; i++) {
    plain[i] = nearest_turn(plain[i], reference[i]);
    other[i] = nearest_turn(other[i], reference[i]);
  }
  memcpy(out, distance(plain, reference) <= distance(other, reference) ? plain : other,
         sizeof plain);
}

// Argument e of z = r e, r real: its rate and acceleration. Where r vanishes the rate is the limit
// along the motion, and the acceleration is not known.
static void rates_of_argument(pl_complex e, double r, pl_complex v, pl_complex a, double otherwise,
                              double* rate, double* second) {
  double r_dot = creal(conj(e) * v);
  bool here = fabs(r) > lost, passing = fabs(r_dot) > lost;
  *rate = here ? cimag(conj(e) * v) / r : passing ? cimag(conj(e) * a) / (2 * r_dot) : otherwise;
  *second = here ? (cimag(conj(e) * a) - 2 * r_dot * *rate) / r : passing ? (double)NAN : 0;
}

// Angles, rates and accelerations at h, next to where they were followed to; dt after that.
static void to_angles(const pl_attitude_state* now, const pl_halves* h, double dt, double* angle,
                      double* rate, double* second) {
  double lost_sum = (now->angle[0] + now->angle[2]) / 2 + dt * now->rate[0];
  double lost_difference = (now->angle[0] - now->angle[2]) / 2 + dt * now->rate[1];
  double sum = carg(direction(h->z[0], h->v[0], lost_sum)),
         difference = carg(direction(h->z[1], h->v[1], lost_difference));
  nearest_angles(sum, 2 * atan2(cabs(h->z[1]), cabs(h->z[0])), difference, now->angle, angle);
  if (rate == NULL) return;

  // z = r e with r real: cos(ϑ/2) and sin(ϑ/2), or both with the other sign
  pl_complex e[2] = {unit((angle[0] + angle[2]) / 2), unit((angle[0] - angle[2]) / 2)};
  double r[2] = {creal(conj(e[0]) * h->z[0]), creal(conj(e[1]) * h->z[1])}, u[2], w[2], of[2],
         of_2[2];
  for (int i = 0; i < 2; i++) {
    rates_of_argument(e[i], r[i], h->v[i], h->a[i], now->rate[i], &of[i], &of_2[i]);
    u[i] = creal(conj(e[i]) * h->v[i]);
    w[i] = creal(conj(e[i]) * h->a[i]) + r[i] * of[i] * of[i];
  }
  rate[0] = of[0] + of[1];
  rate[1] = 2 * (r[0] * u[1] - r[1] * u[0]);
  rate[2] = of[0] - of[1];
  second[0] = of_2[0] + of_2[1];
  second[1] = 2 * (r[0] * w[1] - r[1] * w[0]);
  second[2] = of_2[0] - of_2[1];
}

// ------------------------------------------------------------------------------------ along a step
static double at_series(const double* X, int n, int i, int last, double dt) {
  double x = 0;
  for (int k = last; k >= 0; k--) x = x * dt + X[(size_t)k * (size_t)n + (size_t)i];
  return x;
}

static pl_halves halves_at(const pl_dae* dae, const pl_attitude_setup* s, double t) {
  double x[2][4], dt = t - dae->t_series;
  const int of[4] = {s->scalar, s->angle[0], s->angle[1], s->angle[2]};
  for (int i = 0; i < 4; i++) {
    x[0][i] = at_series(dae->Q, dae->n_q, of[i], dae->use + 1, dt);
    x[1][i] = at_series(dae->V, dae->n_q, of[i], dae->use, dt);
  }
  return (pl_halves){.z = {number(x[0][0], x[0][3]), number(x[0][1], x[0][2])},
                     .v = {number(x[1][0], x[1][3]), number(x[1][1], x[1][2])}};
}

// Whether the argument of z cannot turn much between two points dt apart.
static bool is_close(pl_complex z_a, pl_complex v_a, pl_complex z_b, pl_complex v_b, double dt) {
  double a = cabs(z_a), b = cabs(z_b), most = fmax(a, b);
  bool straight = cabs(z_a + dt * v_a - z_b) <= 0.2 * most
                  && cabs(z_b - dt * v_b - z_a) <= 0.2 * most;
  if (most <= lost) return true;
  if (a <= lost || b <= lost) return straight;  // along a ray that begins or ends at zero
  return straight && cabs(z_b - z_a) <= 0.5 * most;
}

static void follow_to(pl_attitude_state* now, const pl_halves* h, double t) {
  double angle[3];
  to_angles(now, h, t - now->t, angle, NULL, NULL);
  for (int i = 0; i < 2; i++) {
    // rates of the arguments where they are well known
    if (cabs(h->z[i]) > lost)
      now->rate[i] = cimag(conj(h->z[i]) * h->v[i]) / (cabs(h->z[i]) * cabs(h->z[i]));
  }
  memcpy(now->angle, angle, sizeof angle);
  now->t = t;
}

static void follow(const pl_dae* dae, const pl_attitude_setup* s, pl_attitude_state* now,
                   double t_to) {
  enum { DEEPEST = 60 };
  double waiting[DEEPEST + 2];  // ends of the pieces before t_to
  int n = 0;
  pl_halves a = halves_at(dae, s, now->t);
  waiting[n++] = t_to;
  while (n > 0) {
    double t = waiting[n - 1], dt = t - now->t, middle = now->t + 0.5 * dt;
    pl_halves b = halves_at(dae, s, t);
    bool close = is_close(a.z[0], a.v[0], b.z[0], b.v[0], dt)
                 && is_close(a.z[1], a.v[1], b.z[1], b.v[1], dt);
    if (!close && n <= DEEPEST && middle != now->t && middle != t) {
      waiting[n++] = middle;
      continue;
    }
    follow_to(now, &b, t);
    a = b;
    n--;
  }
}

void pl_attitude_follow(pl_dae* dae, double t_to) {
  for (int i = 0; i < dae->setup->n_attitudes; i++) {
    if (t_to != dae->attitude[i].t) follow(dae, &dae->setup->attitudes[i], &dae->attitude[i], t_to);
  }
}

// ---------------------------------------------------------------------------------- what rows show
static void fill(const pl_dae* dae, double t, const double* q, const double* v, const double* a,
                 double* q_out, double* v_out, double* a_out, bool behind) {
  size_t n = (size_t)dae->n_q;
  memcpy(q_out, q, n * sizeof(double));
  memcpy(v_out, v, n * sizeof(double));
  memcpy(a_out, a, n * sizeof(double));
  for (int i = 0; i < dae->setup->n_attitudes; i++) {
    const pl_attitude_setup* s = &dae->setup->attitudes[i];
    double angle[3], rate[3], second[3];
    pl_halves h = halves_of(s, q, v, a);
    to_angles(&dae->attitude[i], &h, t - dae->attitude[i].t, angle, rate, second);
    for (int k = 0; k < 3; k++) {
      size_t at = behind ? n + 3 * (size_t)i + (size_t)k : (size_t)s->angle[k];
      q_out[at] = angle[k];
      v_out[at] = rate[k];
      a_out[at] = second[k];
    }
  }
}

void pl_attitude_seen(pl_dae* dae, double t, const double** q, const double** v, const double** a) {
  if (dae->setup->n_attitudes == 0) return;
  fill(dae, t, *q, *v, *a, dae->seen[0], dae->seen[1], dae->seen[2], true);
  *q = dae->seen[0];
  *v = dae->seen[1];
  *a = dae->seen[2];
}

void pl_attitude_show(pl_dae* dae, pl_row* row) {
  if (dae->setup->n_attitudes == 0) return;
  double** out = row->kind == PL_ROW_BEFORE ? dae->shown_before : dae->shown;
  fill(dae, row->t, row->q, row->v, row->a, out[0], out[1], out[2], false);
  row->q = out[0];
  row->v = out[1];
  row->a = out[2];
}

// ---------------------------------------------------------------------- what stays in Euler angles
// At ϑ = 0 or 180° they do not tell precession and spin apart. A step that gets to the other side
// has divided by what is zero on its way, and its end may be anything.
pleuel_status pl_attitude_poles(pl_dae* dae, double h, const double* q_end, double* t_pole) {
  static const double close = 1e-9;
  for (int i = 0; i < dae->setup->n_poles; i++) {
    int at = dae->setup->poles[i];
    double from = dae->q[at] / M_PI, to = q_end[at] / M_PI;
    if (floor(from) == floor(to) && fabs(to - nearbyint(to)) > close) continue;
    double pole = to > from ? ceil(from) : floor(from),
           share = floor(from) == floor(to) ? 1 : (pole - from) / (to - from);
    *t_pole = dae->t + share * h;
    return pl_fail(dae->job, PLEUEL_SINGULAR,
                   "%s comes to a multiple of 180° near t = %.6g s, where Euler angles do not tell "
                   "precession and spin apart, "
                   "and they themselves are needed here",
                   dae->setup->coordinates[at].name, *t_pole);
  }
  return PLEUEL_OK;
}

// ------------------------------------------------------------------------------------------- start
void pl_attitude_make(pl_dae* dae) {
  pl_arena* a = dae->job->arena;
  size_t n = (size_t)dae->n_q + 3 * (size_t)dae->setup->n_attitudes + 1;
  if (dae->setup->n_attitudes == 0) return;
  dae->attitude = PL_ARRAY(a, pl_attitude_state, dae->setup->n_attitudes);
  for (int i = 0; i < 3; i++) {
    dae->seen[i] = PL_ARRAY(a, double, n);
    dae->shown[i] = PL_ARRAY(a, double, n);
    dae->shown_before[i] = PL_ARRAY(a, double, n);
  }
}

void pl_attitude_start(pl_dae* dae, double t, const double* q, const double* v, double* q_run,
                       double* v_run) {
  memcpy(q_run, q, (size_t)dae->n_q * sizeof(double));
  memcpy(v_run, v, (size_t)dae->n_q * sizeof(double));
  for (int i = 0; i < dae->setup->n_attitudes; i++) {
    const pl_attitude_setup* s = &dae->setup->attitudes[i];
    double angle[3], rate[3];
    for (int k = 0; k < 3; k++) {
      angle[k] = q[s->angle[k]];
      rate[k] = v[s->angle[k]];
    }
    to_quaternion(s, angle, rate, q_run, v_run);
    dae->attitude[i] = (pl_attitude_state){
        t, {angle[0], angle[1], angle[2]}, {(rate[0] + rate[2]) / 2, (rate[0] - rate[2]) / 2}};
  }
}
