// Bodies in space whose axes are given by Euler angles: `axes euler(φ, ϑ, ψ)`, precession, nutation and spin.
//
//   columns of turn = Rz(φ) Rx(ϑ) Rz(ψ) are the body axes in space
//   ω = (φ' sin ϑ sin ψ + ϑ' cos ψ,  φ' sin ϑ cos ψ - ϑ' sin ψ,  φ' cos ϑ + ψ')  along the body axes
//
// A body is then a mass at its centre and a kinetic energy 1/2 sum J_i ω_i² about its principal axes.
#include <string.h>

#include "lower_impl.h"

static const pl_ast* angles_of(const pl_ast* axes) {
  if (axes == NULL || axes->kind == PL_AST_SUM) axes = axes ? (axes->kids.n == 1 ? axes->kids.at[0] : NULL) : NULL;
  if (axes == NULL || axes->kind != PL_AST_PRODUCT || axes->kids.n != 2) return NULL;
  const pl_ast *name = axes->kids.at[0], *group = axes->kids.at[1];
  bool euler = name->kind == PL_AST_NAME && name->number == 0 && strcmp(name->key, "euler") == 0;
  return euler && group->kind == PL_AST_GROUP && group->kids.n == 3 ? group : NULL;
}

bool pl_attitude_is_euler(const pl_ast* axes) { return angles_of(axes) != NULL; }

static bool read_angles(pl_lower* l, const pl_ast* axes, pl_expr angle[3]) {
  const pl_ast* group = angles_of(axes);
  bool fine = group != NULL;
  for (int i = 0; fine && i < 3; i++) {
    angle[i] = pl_lower_scalar(l, group->kids.at[i]);
    fine = !pl_is_poison(angle[i]);
  }
  return fine;
}

// turn[3 i + j]: component i in space of body axis j.
bool pl_attitude_turn(pl_lower* l, const pl_ast* axes, pl_expr turn[9]) {
  pl_pool* p = l->pool;
  pl_expr a[3], c[3], s[3];
  if (!read_angles(l, axes, a)) return false;
  for (int i = 0; i < 3; i++) c[i] = pl_call(p, PL_COS, a[i]), s[i] = pl_call(p, PL_SIN, a[i]);
#define MUL3(x, y, z) pl_mul(p, x, pl_mul(p, y, z))
  turn[0] = pl_sub(p, pl_mul(p, c[0], c[2]), MUL3(s[0], c[1], s[2]));
  turn[1] = pl_neg(p, pl_add(p, pl_mul(p, c[0], s[2]), MUL3(s[0], c[1], c[2])));
  turn[2] = pl_mul(p, s[0], s[1]);
  turn[3] = pl_add(p, pl_mul(p, s[0], c[2]), MUL3(c[0], c[1], s[2]));
  turn[4] = pl_sub(p, MUL3(c[0], c[1], c[2]), pl_mul(p, s[0], s[2]));
  turn[5] = pl_neg(p, pl_mul(p, c[0], s[1]));
  turn[6] = pl_mul(p, s[1], s[2]);
  turn[7] = pl_mul(p, s[1], c[2]);
  turn[8] = c[1];
#undef MUL3
  return true;
}

static void find_spin(pl_pool* p, const pl_expr a[3], pl_expr w[3]) {
  pl_expr s1 = pl_call(p, PL_SIN, a[1]), c1 = pl_call(p, PL_COS, a[1]);
  pl_expr s2 = pl_call(p, PL_SIN, a[2]), c2 = pl_call(p, PL_COS, a[2]);
  pl_expr across = pl_mul(p, pl_dt(p, a[0]), s1), nod = pl_dt(p, a[1]);
  w[0] = pl_add(p, pl_mul(p, across, s2), pl_mul(p, nod, c2));
  w[1] = pl_sub(p, pl_mul(p, across, c2), pl_mul(p, nod, s2));
  w[2] = pl_add(p, pl_mul(p, pl_dt(p, a[0]), c1), pl_dt(p, a[2]));
}

// 1/2 sum J_i ω_i²; equal moments are written together, so that the spin of a symmetric top stays cyclic in plain sight.
bool pl_attitude_energy(pl_lower* l, const pl_ast* axes, const pl_expr J[3], pl_expr* out) {
  pl_pool* p = l->pool;
  pl_expr a[3], w[3], sum;
  if (!read_angles(l, axes, a)) return false;
  find_spin(p, a, w);
  if (pl_same(J[0], J[1])) {
    pl_expr across = pl_mul(p, pl_dt(p, a[0]), pl_call(p, PL_SIN, a[1]));
    sum = pl_mul(p, J[0], pl_add(p, pl_square(p, across), pl_square(p, pl_dt(p, a[1]))));
  } else {
    sum = pl_add(p, pl_mul(p, J[0], pl_square(p, w[0])), pl_mul(p, J[1], pl_square(p, w[1])));
  }
  *out = pl_mul(p, pl_ratio(p, 1, 2), pl_add(p, sum, pl_mul(p, J[2], pl_square(p, w[2]))));
  return true;
}
