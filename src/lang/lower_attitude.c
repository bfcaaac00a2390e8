// The attitude of a body in space: which way its axes are given, and what follows from that: the
// turn, the angular velocity, the energy of turning, what holds between the numbers that give it.
//
//   axes euler(φ, ϑ, ψ)               turn = Rz(φ) Rx(ϑ) Rz(ψ): precession, nutation, spin
//   axes quaternion(q0, q1, q2, q3)   turn = that of q0 + i q1 + j q2 + k q3, |q| = 1
//   axes e1, e2, e3                   its columns, orthonormal [GarciaDeJalonBayo1994, 2.3]
//
// Columns of the turn are the body axes in space.
#include <string.h>

#include "lower_impl.h"

// ---------------------------------------------------------------------------------------- the turn
static pl_expr mul3(pl_pool* p, pl_expr a, pl_expr b, pl_expr c) {
  return pl_mul(p, a, pl_mul(p, b, c));
}

static void turn_by_euler(pl_pool* p, const pl_expr a[3], pl_expr turn[9]) {
  pl_expr c[3], s[3];
  for (int i = 0; i < 3; i++) {
    c[i] = pl_call(p, PL_COS, a[i]);
    s[i] = pl_call(p, PL_SIN, a[i]);
  }
  turn[0] = pl_sub(p, pl_mul(p, c[0], c[2]), mul3(p, s[0], c[1], s[2]));
  turn[1] = pl_neg(p, pl_add(p, pl_mul(p, c[0], s[2]), mul3(p, s[0], c[1], c[2])));
  turn[2] = pl_mul(p, s[0], s[1]);
  turn[3] = pl_add(p, pl_mul(p, s[0], c[2]), mul3(p, c[0], c[1], s[2]));
  turn[4] = pl_sub(p, mul3(p, c[0], c[1], c[2]), pl_mul(p, s[0], s[2]));
  turn[5] = pl_neg(p, pl_mul(p, c[0], s[1]));
  turn[6] = pl_mul(p, s[1], s[2]);
  turn[7] = pl_mul(p, s[1], c[2]);
  turn[8] = c[1];
}

// Diagonal q0² + 2 qi² - |q|² without the use of |q| = 1, others 2 (qi qj ∓ q0 qk).
static void turn_by_quaternion(pl_pool* p, const pl_expr q[4], pl_expr turn[9]) {
  pl_expr two = pl_int(p, 2);
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    pl_expr along = pl_add(p, pl_square(p, q[0]), pl_square(p, q[1 + i]));
    pl_expr across = pl_add(p, pl_square(p, q[1 + j]), pl_square(p, q[1 + k]));
    pl_expr both = pl_mul(p, q[1 + i], q[1 + j]), twist = pl_mul(p, q[0], q[1 + k]);
    turn[4 * i] = pl_sub(p, along, across);
    turn[3 * i + j] = pl_mul(p, two, pl_sub(p, both, twist));
    turn[3 * j + i] = pl_mul(p, two, pl_add(p, both, twist));
  }
}

void pl_attitude_turn(pl_pool* p, pl_attitude* a) {
  if (a->form == PL_AXES_EULER) turn_by_euler(p, a->at, a->turn);
  if (a->form == PL_AXES_QUATERNION) turn_by_quaternion(p, a->at, a->turn);
  for (int i = 0; a->form == PL_AXES_VECTORS && i < 9; i++) a->turn[3 * (i % 3) + i / 3] = a->at[i];
}

// -------------------------------------------------------------------------------- angular velocity
static pl_expr cross(pl_pool* p, const pl_expr a[3], const pl_expr b[3], int i) {
  int j = (i + 1) % 3, k = (i + 2) % 3;
  return pl_sub(p, pl_mul(p, a[j], b[k]), pl_mul(p, a[k], b[j]));
}

//   ω = (φ' sin ϑ sin ψ + ϑ' cos ψ, φ' sin ϑ cos ψ - ϑ' sin ψ, φ' cos ϑ + ψ')  along the body axes
//   ω = (ψ' sin ϑ sin φ + ϑ' cos φ, -ψ' sin ϑ cos φ + ϑ' sin φ, ψ' cos ϑ + φ') in space
static void spin_by_euler(pl_pool* p, const pl_expr a[3], bool in_space, pl_expr w[3]) {
  int about = in_space ? 0 : 2;  // the angle that turns the components
  pl_expr c = pl_call(p, PL_COS, a[about]), s = pl_call(p, PL_SIN, a[about]), nod = pl_dt(p, a[1]);
  pl_expr other = pl_dt(p, a[2 - about]), across = pl_mul(p, other, pl_call(p, PL_SIN, a[1]));
  w[0] = pl_add(p, pl_mul(p, across, s), pl_mul(p, nod, c));
  pl_expr second = pl_sub(p, pl_mul(p, across, c), pl_mul(p, nod, s));
  w[1] = in_space ? pl_neg(p, second) : second;
  w[2] = pl_add(p, pl_mul(p, other, pl_call(p, PL_COS, a[1])), pl_dt(p, a[about]));
}

// ω = 2 (q0 q' - q0' q -+ q × q'): minus along the body axes, plus in space; q here without q0.
static void spin_by_quaternion(pl_pool* p, const pl_expr q[4], bool in_space, pl_expr w[3]) {
  pl_expr v[4];
  for (int i = 0; i < 4; i++) v[i] = pl_dt(p, q[i]);
  for (int i = 0; i < 3; i++) {
    pl_expr straight = pl_sub(p, pl_mul(p, q[0], v[1 + i]), pl_mul(p, v[0], q[1 + i]));
    pl_expr bent = cross(p, q + 1, v + 1, i);
    w[i] = pl_mul(p, pl_int(p, 2),
                  in_space ? pl_add(p, straight, bent) : pl_sub(p, straight, bent));
  }
}

// ω = 1/2 sum e_j × e_j' in space.
static void spin_by_vectors(pl_pool* p, const pl_expr e[9], pl_expr w[3]) {
  for (int i = 0; i < 3; i++) {
    w[i] = pl_int(p, 0);
    for (int j = 0; j < 3; j++) {
      pl_expr v[3] = {pl_dt(p, e[3 * j]), pl_dt(p, e[3 * j + 1]), pl_dt(p, e[3 * j + 2])};
      w[i] = pl_add(p, w[i], cross(p, e + 3 * j, v, i));
    }
    w[i] = pl_mul(p, pl_ratio(p, 1, 2), w[i]);
  }
}

// The angular velocity in the components of space.
void pl_attitude_spin(pl_pool* p, const pl_attitude* a, pl_expr w[3]) {
  if (a->form == PL_AXES_EULER) spin_by_euler(p, a->at, true, w);
  if (a->form == PL_AXES_QUATERNION) spin_by_quaternion(p, a->at, true, w);
  if (a->form == PL_AXES_VECTORS) spin_by_vectors(p, a->at, w);
}

// ------------------------------------------------------------------------------------------ energy
enum { XX, XY, XZ, YY, YZ, ZZ };
static const int at_of[3][3] = {{XX, XY, XZ}, {XY, YY, YZ}, {XZ, YZ, ZZ}};

// sum J_ij w_i w_j; equal moments of the first two axes are written together.
static pl_expr quadratic(pl_pool* p, const pl_expr J[6], const pl_expr w[3]) {
  pl_expr sum = pl_int(p, 0);
  bool round = pl_same(J[XX], J[YY]);
  if (round) sum = pl_mul(p, J[XX], pl_add(p, pl_square(p, w[0]), pl_square(p, w[1])));
  for (int i = round ? 2 : 0; i < 3; i++)
    sum = pl_add(p, sum, pl_mul(p, J[at_of[i][i]], pl_square(p, w[i])));
  for (int i = 0; i < 3; i++)
    for (int j = i + 1; j < 3; j++)
      sum = pl_add(p, sum,
                   pl_mul(p, pl_mul(p, pl_int(p, 2), J[at_of[i][j]]), pl_mul(p, w[i], w[j])));
  return sum;
}

// A symmetric top in Euler angles is written without ψ, so that its spin stays cyclic in plain
// sight.
static pl_expr energy_of_round_top(pl_pool* p, const pl_expr a[3], const pl_expr J[6]) {
  pl_expr w[3], across = pl_mul(p, pl_dt(p, a[0]), pl_call(p, PL_SIN, a[1]));
  spin_by_euler(p, a, false, w);
  pl_expr first = pl_mul(p, J[XX], pl_add(p, pl_square(p, across), pl_square(p, pl_dt(p, a[1]))));
  return pl_add(p, first, pl_mul(p, J[ZZ], pl_square(p, w[2])));
}

// sum E_ij e_i'·e_j' with E = (trace J)/2 - J: the vectors have constant masses.
static pl_expr energy_of_vectors(pl_pool* p, const pl_expr e[9], const pl_expr J[6]) {
  pl_expr sum = pl_int(p, 0),
          half = pl_mul(p, pl_ratio(p, 1, 2), pl_add(p, J[XX], pl_add(p, J[YY], J[ZZ])));
  for (int i = 0; i < 3; i++) {
    for (int j = i; j < 3; j++) {
      pl_expr dot = pl_int(p, 0);
      for (int k = 0; k < 3; k++)
        dot = pl_add(p, dot, pl_mul(p, pl_dt(p, e[3 * i + k]), pl_dt(p, e[3 * j + k])));
      pl_expr weight = i == j ? pl_sub(p, half, J[at_of[i][i]])
                              : pl_mul(p, pl_int(p, -2), J[at_of[i][j]]);
      sum = pl_add(p, sum, pl_mul(p, weight, dot));
    }
  }
  return sum;
}

// 1/2 ω·J ω with J = xx, xy, xz, yy, yz, zz along the body axes.
pl_expr pl_attitude_energy(pl_pool* p, const pl_attitude* a, const pl_expr J[6]) {
  bool skew = !pl_is_zero_node(p, J[XY]) || !pl_is_zero_node(p, J[XZ])
              || !pl_is_zero_node(p, J[YZ]);
  pl_expr w[3], sum = pl_poison();
  if (a->form == PL_AXES_VECTORS) sum = energy_of_vectors(p, a->at, J);
  else if (a->form == PL_AXES_EULER && !skew && pl_same(J[XX], J[YY]))
    sum = energy_of_round_top(p, a->at, J);
  else {
    if (a->form == PL_AXES_EULER) spin_by_euler(p, a->at, false, w);
    else spin_by_quaternion(p, a->at, false, w);
    sum = quadratic(p, J, w);
  }
  return pl_mul(p, pl_ratio(p, 1, 2), sum);
}

// ------------------------------------------------------------------------- what holds between them
// Condition k of the attitude as left = right; its name within the body.  false: there are no more.
bool pl_attitude_condition(pl_pool* p, const pl_attitude* a, int k, pl_expr* left, pl_expr* right,
                           const char** name) {
  static const char* const pair[6] = {"11", "22", "33", "12", "13", "23"};
  *left = pl_int(p, 0);
  if (a->form == PL_AXES_QUATERNION && k == 0) {
    for (int i = 0; i < 4; i++) *left = pl_add(p, *left, pl_square(p, a->at[i]));
    *right = pl_int(p, 1);
    *name = "unit";
    return true;
  }
  if (a->form != PL_AXES_VECTORS || k >= 6) return false;
  int i = pair[k][0] - '1', j = pair[k][1] - '1';
  for (int n = 0; n < 3; n++)
    *left = pl_add(p, *left, pl_mul(p, a->at[3 * i + n], a->at[3 * j + n]));
  *right = pl_int(p, i == j);
  *name = pair[k];
  return true;
}
