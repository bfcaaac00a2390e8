// Whether a body can have the inertia that is given for one in space: J = ∫ (r² - r r^T) dm, so
// that E = (trace J)/2
// - J = ∫ r r^T dm has no negative eigenvalue; for principal moments that is J1 <= J2 + J3 and so
// on.
#include "model_impl.h"

#include <math.h>

// Eigenvalues of a symmetric matrix (xx xy xz yy yz zz), ascending, by Jacobi's rotations
// [GolubVanLoan2013, 8.5].
static void eigenvalues(const double a[6], double out[3]) {
  enum { SWEEPS = 60 };
  double m[3][3] = {{a[0], a[1], a[2]}, {a[1], a[3], a[4]}, {a[2], a[4], a[5]}};
  for (int n = 0; n < SWEEPS; n++) {
    int i = n % 3 == 2 ? 1 : 0, j = n % 3 == 0 ? 1 : 2, k = 3 - i - j;
    if (m[i][j] == 0) continue;
    double theta = (m[j][j] - m[i][i]) / (2 * m[i][j]);
    double t = copysign(1, theta) / (fabs(theta) + hypot(theta, 1)), c = 1 / hypot(t, 1), s = t * c;
    double ik = m[i][k], jk = m[j][k], move = t * m[i][j];
    m[i][i] -= move;
    m[j][j] += move;
    m[i][j] = m[j][i] = 0;
    m[i][k] = m[k][i] = c * ik - s * jk;
    m[j][k] = m[k][j] = s * ik + c * jk;
  }
  for (int i = 0; i < 3; i++) {
    double x = m[i][i];
    int k = i;
    for (; k > 0 && out[k - 1] > x; k--) out[k] = out[k - 1];
    out[k] = x;
  }
}

typedef struct inertia_check {
  const pl_spatial* body;
  double moment[3];  // principal moments that do not fit
} inertia_check;

static bool is_possible(void* user, pl_index_values* v) {
  inertia_check* c = user;
  double J[6], size = 0;
  for (int k = 0; k < 6; k++) {
    J[k] = pl_eval(v->model->pool, c->body->inertia[k], v->value);
    if (!isfinite(J[k])) return true;
    size = fmax(size, fabs(J[k]));
  }
  double rounding = 1e-12 * size;
  eigenvalues(J, c->moment);
  const double* J_1 = c->moment;
  return J_1[0] >= -rounding && J_1[2] <= J_1[0] + J_1[1] + 3 * rounding && J_1[2] > 0;
}

static void tell(pl_job* job, const inertia_check* c) {
  const double* J = c->moment;
  bool negative = J[0] < 0 || !(J[2] > 0);
  pl_diagnostic* d = pl_tell(
      job, PL_E067, c->body->inertia_span,
      negative ? PL_F(
          job, "moments of inertia are positive: along its principal axes this is %.6g, %.6g, %.6g",
          J[0], J[1], J[2])
               : PL_F(job,
                      "no body has this inertia: its largest principal moment, %.6g, exceeds the "
                      "sum of the others, %.6g",
                      J[2], J[0] + J[1]),
      negative ? PL_F(
          job,
          pl_german(
              "moments of inertia are positive: along its principal axes this is %.6g, %.6g, %.6g"),
          J[0], J[1], J[2])
               : PL_F(
                   job,
                   pl_german(
                       "no body has this inertia: its largest principal moment, %.6g, exceeds the "
                       "sum of the others, %.6g"),
                   J[2], J[0] + J[1]));
  pl_report_reason(d, PL_BOTH("J1 = ∫ (y² + z²) dm and so on, so that J1 <= J2 + J3"));
  pl_report_fix(
      d,
      PL_BOTH(negative ? "correct the number; products of inertia have the sign Jxy = -∫ x y dm"
                       : "correct the number"),
      NULL);
}

void pl_check_inertia(pl_job* job, pl_model* m) {
  pl_index_values v = pl_index_values_make(m, job->arena);
  long budget = 100000;  // a family of bodies is looked at up to here
  for (int i = 0; i < m->spatials.n; i++) {
    inertia_check c = {.body = &m->spatials.at[i]};
    const pl_block* b = c.body->block;
    bool ok = b ? pl_block_walk(b, &v, is_possible, &c, &budget, NULL) != PL_WALK_STOPPED
                : is_possible(&c, &v);
    for (; b; b = b->outer) v.value[b->index.id] = PL_NAN;
    if (!ok) tell(job, &c);
  }
}
