// Disks in the complex plane with real centres, and what the operations of a tape do to them.
//
// A disk {z: |z - x| <= r for some x of the ball c}. For f analytic on the disk around x with the
// bound |f(x + z) - f(x)| <= F(|z|), F increasing, the image lies in the disk around f(x) of radius
// F(r). The bounds:
//
//   product     |a||z_b| + |b||z_a| + |z_a||z_b|
//   quotient    a/b + z: z = (z_a - (a/b) z_b)/(b + z_b), so |z| <= (r_a + |a/b| r_b)/(|b| - r_b)
//   sqrt        the moduli of its coefficients are those of 1 - sqrt(1 - x):
//               r/(sqrt(a) + sqrt(a - r))
//   a^p         |(1+w)^p - 1| <= exp(|p| |ln(1+w)|) - 1 <= (1 - |w|)^-|p| - 1, w = z/a
//   exp, ln     e^a (e^r - 1); -ln(1 - r/a)
//   sin, cos    |f(a)| (cosh r - 1) + |f'(a)| sinh r, from the addition theorem;
//               sinh and cosh likewise
//   asin, atan the integral of the derivative along the segment, the derivative bounded on the disk
//
// abs, sign, min, max and if are analytic where their condition is decided on the whole disk; then
// they are one of their branches. The centre is a ball because the numbers that a motion begins
// with are balls.
// See theory (18.3).
#include "enclose/enclose_impl.h"

// ---------------------------------------------------------------------------------- memory, bounds
pl_disk* pl_disks_make(slong n) {
  pl_disk* d = flint_malloc(sizeof(pl_disk) * (size_t)(n > 0 ? n : 1));
  for (slong i = 0; i < n; i++) {
    arb_init(&d[i].c);
    mag_init(&d[i].r);
  }
  return d;
}

void pl_disks_free(pl_disk* d, slong n) {
  for (slong i = 0; d && i < n; i++) {
    arb_clear(&d[i].c);
    mag_clear(&d[i].r);
  }
  flint_free(d);
}

void pl_disk_set_ball(pl_disk* d, arb_srcptr c) {
  arb_set_round(&d->c, c, PL_DISK_BITS);
  mag_zero(&d->r);
}

void pl_disk_bound(mag_t out, const pl_disk* d) {
  arb_get_mag(out, &d->c);
  mag_add(out, out, &d->r);
}

// A lower bound of |z|, 0 when the disk may contain it.
static void least(mag_t out, const pl_disk* d) {
  arb_get_mag_lower(out, &d->c);
  mag_sub_lower(out, out, &d->r);
}

static bool away_from_zero(const pl_disk* d) {
  mag_t m;
  mag_init(m);
  least(m, d);
  bool yes = !mag_is_zero(m);
  mag_clear(m);
  return yes;
}

static bool right_of_zero(const pl_disk* d) { return arb_is_positive(&d->c) && away_from_zero(d); }
static bool left_of_zero(const pl_disk* d) { return arb_is_negative(&d->c) && away_from_zero(d); }

static void set(pl_disk* z, const pl_disk* x) {
  arb_set(&z->c, &x->c);
  mag_set(&z->r, &x->r);
}

// -------------------------------------------------------------------------------------- arithmetic
void pl_disk_add(pl_disk* z, const pl_disk* x, const pl_disk* y) {
  arb_add(&z->c, &x->c, &y->c, PL_DISK_BITS);
  mag_add(&z->r, &x->r, &y->r);
}

void pl_disk_sub(pl_disk* z, const pl_disk* x, const pl_disk* y) {
  arb_sub(&z->c, &x->c, &y->c, PL_DISK_BITS);
  mag_add(&z->r, &x->r, &y->r);
}

void pl_disk_mul(pl_disk* z, const pl_disk* x, const pl_disk* y) {
  mag_t a, b;
  mag_init(a);
  mag_init(b);
  arb_get_mag(a, &x->c);
  mag_mul(a, a, &y->r);
  arb_get_mag(b, &y->c);
  mag_addmul(a, b, &x->r);
  mag_addmul(a, &x->r, &y->r);
  arb_mul(&z->c, &x->c, &y->c, PL_DISK_BITS);
  mag_swap(&z->r, a);
  mag_clear(a);
  mag_clear(b);
}

static bool divide(pl_disk* z, const pl_disk* x, const pl_disk* y) {
  mag_t low, r;
  mag_init(low);
  mag_init(r);
  least(low, y);
  bool ok = !mag_is_zero(low);
  if (ok) {
    arb_t w;
    arb_init(w);
    arb_div(w, &x->c, &y->c, PL_DISK_BITS);
    arb_get_mag(r, w);
    mag_mul(r, r, &y->r);
    mag_add(r, r, &x->r);
    mag_div(&z->r, r, low);
    arb_swap(&z->c, w);
    arb_clear(w);
  }
  mag_clear(low);
  mag_clear(r);
  return ok;
}

// --------------------------------------------------------------------------------------- functions
static bool square_root(pl_disk* z, const pl_disk* x) {
  if (!right_of_zero(x)) return false;
  mag_t far, near;
  mag_init(far);
  mag_init(near);
  arb_get_mag_lower(far, &x->c);
  least(near, x);
  mag_sqrt_lower(far, far);
  mag_sqrt_lower(near, near);
  mag_add_lower(near, near, far);
  mag_div(near, &x->r, near);
  arb_sqrt(&z->c, &x->c, PL_DISK_BITS);
  mag_swap(&z->r, near);
  mag_clear(far);
  mag_clear(near);
  return true;
}

// out >= -ln(1 - r/|c|) = ln(1 + r/(|c| - r)).
static void log_radius(mag_t out, const pl_disk* x) {
  mag_t low;
  mag_init(low);
  least(low, x);
  mag_div(out, &x->r, low);
  mag_log1p(out, out);
  mag_clear(low);
}

// Real exponents need a base on the right of zero, whole ones a base away from it.
static bool power(pl_disk* z, const pl_disk* x, arb_srcptr p) {
  if (!right_of_zero(x) && !(arb_is_int(p) && away_from_zero(x))) return false;
  mag_t r, m;
  mag_init(r);
  mag_init(m);
  log_radius(r, x);
  arb_get_mag(m, p);
  mag_mul(r, r, m);
  mag_expm1(r, r);
  arb_pow(&z->c, &x->c, p, PL_DISK_BITS);
  arb_get_mag(m, &z->c);
  mag_mul(&z->r, r, m);
  mag_clear(r);
  mag_clear(m);
  return arb_is_finite(&z->c);
}

static bool exponential(pl_disk* z, const pl_disk* x, const pl_disk* y) {
  mag_t r, m;
  mag_init(r);
  mag_init(m);
  mag_expm1(r, &x->r);
  arb_exp(&z->c, &x->c, PL_DISK_BITS);
  arb_get_mag(m, &z->c);
  mag_mul(&z->r, r, m);
  mag_clear(r);
  mag_clear(m);
  return true;
}

static bool logarithm(pl_disk* z, const pl_disk* x, const pl_disk* y) {
  if (!right_of_zero(x)) return false;
  mag_t r;
  mag_init(r);
  log_radius(r, x);
  arb_log(&z->c, &x->c, PL_DISK_BITS);
  mag_swap(&z->r, r);
  mag_clear(r);
  return true;
}

// |f| (cosh r - 1) + |g| sinh r, cosh r - 1 = 2 sinh²(r/2).
static void wave_radius(mag_t out, arb_srcptr f, arb_srcptr g, const mag_t r) {
  mag_t s, m;
  mag_init(s);
  mag_init(m);
  mag_mul_2exp_si(s, r, -1);
  mag_sinh(s, s);
  mag_mul(s, s, s);
  mag_mul_2exp_si(s, s, 1);
  arb_get_mag(m, f);
  mag_mul(s, s, m);
  arb_get_mag(m, g);
  mag_sinh(out, r);
  mag_mul(out, out, m);
  mag_add(out, out, s);
  mag_clear(s);
  mag_clear(m);
}

// sin and cos, or sinh and cosh, of x.
static void waves(pl_disk* sine, pl_disk* cosine, const pl_disk* x, bool hyperbolic) {
  arb_t s, c;
  mag_t r;
  arb_init(s);
  arb_init(c);
  mag_init_set(r, &x->r);
  if (hyperbolic) arb_sinh_cosh(s, c, &x->c, PL_DISK_BITS);
  else arb_sin_cos(s, c, &x->c, PL_DISK_BITS);
  if (sine) {
    wave_radius(&sine->r, s, c, r);
    arb_set(&sine->c, s);
  }
  if (cosine) {
    wave_radius(&cosine->r, c, s, r);
    arb_set(&cosine->c, c);
  }
  arb_clear(s);
  arb_clear(c);
  mag_clear(r);
}

static bool sine(pl_disk* z, const pl_disk* x, const pl_disk* y) {
  waves(z, NULL, x, false);
  return true;
}

static bool cosine(pl_disk* z, const pl_disk* x, const pl_disk* y) {
  waves(NULL, z, x, false);
  return true;
}

static bool hyperbolic_sine(pl_disk* z, const pl_disk* x, const pl_disk* y) {
  waves(z, NULL, x, true);
  return true;
}

static bool hyperbolic_cosine(pl_disk* z, const pl_disk* x, const pl_disk* y) {
  waves(NULL, z, x, true);
  return true;
}

static bool quotient_of_waves(pl_disk* z, const pl_disk* x, bool hyperbolic) {
  pl_disk* d = pl_disks_make(2);
  waves(&d[0], &d[1], x, hyperbolic);
  bool ok = divide(z, &d[0], &d[1]);
  pl_disks_free(d, 2);
  return ok;
}

static bool tangent(pl_disk* z, const pl_disk* x, const pl_disk* y) {
  return quotient_of_waves(z, x, false);
}

static bool hyperbolic_tangent(pl_disk* z, const pl_disk* x, const pl_disk* y) {
  return quotient_of_waves(z, x, true);
}

// |asin'| = |1 - w²|^(-1/2) <= (1 - |w|²)^(-1/2).
static bool arc(pl_disk* z, const pl_disk* x, bool cosine) {
  mag_t r, one;
  mag_init(r);
  mag_init(one);
  mag_one(one);
  pl_disk_bound(r, x);
  mag_mul(r, r, r);
  mag_sub_lower(r, one, r);
  bool ok = !mag_is_zero(r);
  if (ok) {
    mag_sqrt_lower(r, r);
    mag_div(r, &x->r, r);
    if (cosine) arb_acos(&z->c, &x->c, PL_DISK_BITS);
    else arb_asin(&z->c, &x->c, PL_DISK_BITS);
    mag_swap(&z->r, r);
  }
  mag_clear(r);
  mag_clear(one);
  return ok;
}

static bool arc_sine(pl_disk* z, const pl_disk* x, const pl_disk* y) { return arc(z, x, false); }
static bool arc_cosine(pl_disk* z, const pl_disk* x, const pl_disk* y) { return arc(z, x, true); }

// |atan'| = 1/(|w - i| |w + i|), and |c ± i| = sqrt(1 + c²) >= max(1, |c|).
static bool arc_tangent(pl_disk* z, const pl_disk* x, const pl_disk* y) {
  mag_t far, r, one;
  mag_init(far);
  mag_init(r);
  mag_init(one);
  mag_one(one);
  arb_get_mag_lower(far, &x->c);
  mag_mul_lower(far, far, far);
  mag_add_lower(far, far, one);
  mag_sqrt_lower(far, far);
  mag_sub_lower(far, far, &x->r);
  bool ok = !mag_is_zero(far);
  if (ok) {
    mag_mul_lower(far, far, far);
    mag_div(r, &x->r, far);
    arb_atan(&z->c, &x->c, PL_DISK_BITS);
    mag_swap(&z->r, r);
  }
  mag_clear(far);
  mag_clear(r);
  mag_clear(one);
  return ok;
}

// d atan2(y, x) = (x dy - y dx)/(x² + y²), bounded along the segment. The cut y = 0, x < 0 must not
// be met.
static bool angle_of(pl_disk* z, const pl_disk* y, const pl_disk* x) {
  if (!right_of_zero(x) && !right_of_zero(y) && !left_of_zero(y)) return false;
  pl_disk* d = pl_disks_make(2);
  mag_t up, low;
  mag_init(up);
  mag_init(low);
  pl_disk_mul(&d[0], x, x);
  pl_disk_mul(&d[1], y, y);
  pl_disk_add(&d[0], &d[0], &d[1]);
  least(low, &d[0]);
  bool ok = !mag_is_zero(low);
  if (ok) {
    pl_disk_bound(up, x);
    mag_mul(up, up, &y->r);
    mag_t other;
    mag_init(other);
    pl_disk_bound(other, y);
    mag_addmul(up, other, &x->r);
    mag_clear(other);
    arb_atan2(&z->c, &y->c, &x->c, PL_DISK_BITS);
    mag_div(&z->r, up, low);
  }
  mag_clear(up);
  mag_clear(low);
  pl_disks_free(d, 2);
  return ok;
}

// ---------------------------------------------------------------------------------------- branches
// 1 or -1 when every point of x lies on that side of zero, 2 when x is the number 0, else 0.
static int side(const pl_disk* x) {
  if (right_of_zero(x)) return 1;
  if (left_of_zero(x)) return -1;
  return arb_is_zero(&x->c) && mag_is_zero(&x->r) ? 2 : 0;
}

static int order(const pl_disk* x, const pl_disk* y) {
  pl_disk* d = pl_disks_make(1);
  pl_disk_sub(d, x, y);
  int s = side(d);
  pl_disks_free(d, 1);
  return s;
}

static bool branch(pl_disk* z, pl_op op, const pl_disk* a, const pl_disk* b, const pl_disk* c) {
  int s = op == PL_OP_MIN || op == PL_OP_MAX ? order(a, b) : side(a);
  if (s == 0) return false;
  switch (op) {
    case PL_OP_SIGN:
      arb_set_si(&z->c, s == 2 ? 0 : s);
      mag_zero(&z->r);
      return true;
    case PL_OP_ABS:
      set(z, a);
      if (s < 0) arb_neg(&z->c, &z->c);
      return true;
    case PL_OP_MIN: set(z, s == 1 ? b : a); return true;
    case PL_OP_MAX: set(z, s == -1 ? b : a); return true;
    default: set(z, s == 1 ? b : c); return true;
  }
}

// ------------------------------------------------------------------------------------- derivatives
// out = (x u + sign y v)/w; y NULL: without the second product, w NULL: without the quotient.
static bool combine(pl_disk* out, const pl_disk* x, const pl_disk* u, int sign, const pl_disk* y,
                    const pl_disk* v, const pl_disk* w) {
  pl_disk* d = pl_disks_make(2);
  pl_disk_mul(&d[0], x, u);
  if (y) {
    pl_disk_mul(&d[1], y, v);
    if (sign > 0) pl_disk_add(&d[0], &d[0], &d[1]);
    else pl_disk_sub(&d[0], &d[0], &d[1]);
  }
  bool ok = w ? divide(out, &d[0], w) : (set(out, &d[0]), true);
  pl_disks_free(d, 2);
  return ok;
}

// (1 + sign p) da
static void tangent_slope(pl_disk* dw, const pl_disk* p, const pl_disk* da, int sign) {
  pl_disk* d = pl_disks_make(1);
  set(d, p);
  if (sign < 0) arb_neg(&d->c, &d->c);
  arb_add_si(&d->c, &d->c, 1, PL_DISK_BITS);
  pl_disk_mul(dw, d, da);
  pl_disks_free(d, 1);
}

static bool quotient_slope(pl_disk* dw, const pl_disk* w, const pl_disk* b, const pl_disk* da,
                           const pl_disk* db) {
  pl_disk* d = pl_disks_make(1);
  pl_disk_mul(d, w, db);
  pl_disk_sub(d, da, d);
  bool ok = divide(dw, d, b);
  pl_disks_free(d, 1);
  return ok;
}

static void negate(pl_disk* d) { arb_neg(&d->c, &d->c); }

// Elementary functions of one argument: the equations of program/recurrences.def.  value is f(a), p
// the node of its partner.
static bool function_slope(pl_disk* dw, pl_op op, const pl_disk* value, const pl_disk* a,
                           const pl_disk* p, const pl_disk* da) {
  pl_operand which = pl_op_reads_as_w[op];
  const pl_disk* w = which == PL_OPERAND_SELF ? value : which == PL_OPERAND_ARGUMENT ? a : p;
  switch ((pl_recurrence_kind)pl_op_recurrence[op]) {
    case PL_RECURRENCE_FLOW: pl_disk_mul(dw, w, da); return true;
    case PL_RECURRENCE_FLOW_MINUS:
      pl_disk_mul(dw, w, da);
      negate(dw);
      return true;
    case PL_RECURRENCE_FLOW_ONE_PLUS: tangent_slope(dw, w, da, 1); return true;
    case PL_RECURRENCE_FLOW_ONE_MINUS: tangent_slope(dw, w, da, -1); return true;
    case PL_RECURRENCE_INVERSE: return divide(dw, da, w);
    case PL_RECURRENCE_INVERSE_MINUS:
      if (!divide(dw, da, w)) return false;
      negate(dw);
      return true;
    default: return false;
  }
}

static bool slope(pl_disk* dw, pl_op op, const pl_disk* w, const pl_disk* a, const pl_disk* b,
                  const pl_disk* p, const pl_disk* da, const pl_disk* db, const pl_disk* dp) {
  switch (op) {
    case PL_OP_ADD: pl_disk_add(dw, da, db); return true;
    case PL_OP_SUB: pl_disk_sub(dw, da, db); return true;
    case PL_OP_NEG:
      set(dw, da);
      negate(dw);
      return true;
    case PL_OP_SCALE:
    case PL_OP_MUL: return combine(dw, a, db, 1, b, da, NULL);
    case PL_OP_SQR: return combine(dw, a, da, 1, a, da, NULL);
    case PL_OP_RSCALE:
    case PL_OP_DIV: return quotient_slope(dw, w, b, da, db);
    case PL_OP_SQRT:
      if (!divide(dw, da, w)) return false;
      arb_mul_2exp_si(&dw->c, &dw->c, -1);
      mag_mul_2exp_si(&dw->r, &dw->r, -1);
      return true;
    case PL_OP_POW:
      return combine(dw, w, da, 1, NULL, NULL, a) && combine(dw, dw, b, 1, NULL, NULL, NULL);
    case PL_OP_ATAN2: return combine(dw, da, b, -1, db, a, p);
    case PL_OP_ABS:
      set(dw, da);
      if (arb_is_negative(&a->c)) negate(dw);
      return true;
    case PL_OP_SIGN:
      arb_zero(&dw->c);
      mag_zero(&dw->r);
      return true;
    case PL_OP_MIN: set(dw, order(a, b) == 1 ? db : da); return true;
    case PL_OP_MAX: set(dw, order(a, b) == -1 ? db : da); return true;
    case PL_OP_IF: set(dw, side(a) == 1 ? db : dp); return true;
    default: return function_slope(dw, op, w, a, p, da);
  }
}

void pl_disk_derivative(pl_disk* dw, pl_op op, const pl_disk* w, const pl_disk* a, const pl_disk* b,
                        const pl_disk* p, const pl_disk* da, const pl_disk* db, const pl_disk* dp) {
  if (!slope(dw, op, w, a, b, p, da, db, dp)) mag_inf(&dw->r);
}

// ------------------------------------------------------------------------------- by the derivative
// A function whose partner w was computed before it: |f(z) - f(x)| <= |z - x| sup |f'|, the
// supremum
// over the disk, which is convex.
bool pl_disk_by_slope(pl_disk* z, pl_op op, const pl_disk* x, const pl_disk* w) {
  if (pl_op_reads_as_w[op] != PL_OPERAND_PARTNER || w == NULL) return false;
  pl_disk* d = pl_disks_make(2);
  mag_t r;
  mag_init(r);
  arb_one(&d[1].c);
  bool ok = function_slope(&d[0], op, NULL, x, w, &d[1]);
  if (ok) {
    pl_disk_bound(r, &d[0]);
    mag_mul(r, r, &x->r);
    pl_ball_op(&z->c, op, &x->c, &x->c, &x->c, PL_DISK_BITS);
    mag_swap(&z->r, r);
  }
  mag_clear(r);
  pl_disks_free(d, 2);
  return ok;
}

// ----------------------------------------------------------------------------------- one operation
static bool apply(pl_disk* d, pl_op op, const pl_disk* a, const pl_disk* b, const pl_disk* c) {
  switch (op) {
    case PL_OP_ADD: pl_disk_add(d, a, b); return true;
    case PL_OP_SUB: pl_disk_sub(d, a, b); return true;
    case PL_OP_NEG:
      set(d, a);
      arb_neg(&d->c, &d->c);
      return true;
    case PL_OP_SCALE:
    case PL_OP_MUL: pl_disk_mul(d, a, b); return true;
    case PL_OP_SQR: pl_disk_mul(d, a, a); return true;
    case PL_OP_RSCALE:
    case PL_OP_DIV: return divide(d, a, b);
    case PL_OP_SQRT: return square_root(d, a);
    case PL_OP_POW: return mag_is_zero(&b->r) && power(d, a, &b->c);
#define by_slope(d, a, b) pl_disk_by_slope(d, op, a, c)
// clang-format off
#define PL_FUNCTION(name, text, n, tex, form, value, derivative, library, recurrence, w, disk) \
  case PL_OP_##name: return disk(d, a, b);
#define PL_PIECEWISE(...)
#include "expr/functions.def"
      // clang-format on
    case PL_OP_ABS:
    case PL_OP_SIGN:
    case PL_OP_MIN:
    case PL_OP_MAX:
    case PL_OP_IF: return branch(d, op, a, b, c);
    default: return false;
  }
}

bool pl_disk_op(pl_disk* d, pl_op op, const pl_disk* a, const pl_disk* b, const pl_disk* c) {
  return apply(d, op, a, b, c) && arb_is_finite(&d->c) && !mag_is_inf(&d->r);
}
