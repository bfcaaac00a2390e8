// What a constraint presses together.
//
// A contact transmits one force Z per unit of λ, to a mass against something fixed or between two
// of them, and possibly a moment M on a body. Virtual work says what they are: for every coordinate
// q
//
//     Z . d(P_A - P_B)/dq + M_A dφ_A/dq + M_B dφ_B/dq = dg/dq.
//
// Each mass alone and then each pair is tried: the system has more equations than unknowns, so the
// right partners are those for which it has a solution. Zero is decided at random points in
// numbers.
//
// Z and M give the line along which the force acts on a body, not the point on it. That point is
// the one for which the constraint is the distance of a point fixed in the body from a plane (then
// the arm turns with the body), or, when the constraint does not contain the angle, at the distance
// that the constraint keeps (a disc on a plane). Other surfaces need the place given.
#include "assembly/contact_geometry.h"

#include <math.h>
#include <string.h>

typedef struct pl_partner {
  pl_name name;
  pl_point at;
  pl_expr angle;           // of a body, else poison
  const pl_spatial* body;  // in space, else NULL
} pl_partner;

typedef PL_VEC(pl_partner) pl_partners;
typedef struct pl_geometry {
  pl_recorder* r;
  pl_pool* pool;
  const pl_constraint* c;
  pl_record_group* atoms;  // coordinates that the constraint or a partner depends on
  pl_record_group* rows;   // those of them whose virtual work is looked at
  pl_partners partners;
} pl_geometry;

// ------------------------------------------------------------------------ numbers at random points
// The same point for the same seed, whatever the expression is.
static double number_at(pl_geometry* g, pl_expr e, uint64_t seed) {
  pl_pool* p = g->pool;
  if (pl_is_poison(e)) return (double)NAN;
  for (int i = 0; i < g->atoms->atoms.n; i++) {
    pl_random random = {seed * 1000 + (uint64_t)i};
    pl_random_bits(&random);
    long k = 100 + (long)(pl_random_bits(&random) % 1800);
    pl_expr atom = g->atoms->atoms.at[i];
    if (g->c->has_velocity) e = pl_subst_expr(p, e, pl_dt(p, atom), pl_ratio(p, 2 * k + 1, 1013));
    e = pl_subst_expr(p, e, atom, pl_ratio(p, k, 1009));
  }
  double* value = g->r->value;
  double t = value[pl_time(p).id];
  value[pl_time(p).id] = 0.37 + 0.11 * (double)seed;
  for (int d = 0; d < 8; d++) {
    const pl_block* b = g->c->block;
    for (int k = 0; k < d && b; k++) b = b->outer;
    if (b) value[b->index.id] = 3 + (double)d;
  }
  double x = pl_eval(p, e, value);
  for (const pl_block* b = g->c->block; b; b = b->outer) value[b->index.id] = (double)NAN;
  value[pl_time(p).id] = t;
  return x;
}

enum { SEEDS = 12, ENOUGH = 3 };

// Zero relative to size wherever it has a value, at several points at least.
static bool vanishes(pl_geometry* g, pl_expr e, double size) {
  int seen = 0;
  for (uint64_t seed = 1; seed <= SEEDS && seen < ENOUGH; seed++) {
    double x = number_at(g, e, seed);
    if (isnan(x)) continue;
    if (fabs(x) > 1e-9 * fmax(size, 1e-300)) return false;
    seen++;
  }
  return seen >= ENOUGH;
}

static bool is_constant_here(pl_geometry* g, pl_expr e) {
  double first = (double)NAN;
  int seen = 0;
  for (uint64_t seed = 1; seed <= SEEDS && seen < ENOUGH; seed++) {
    double x = number_at(g, e, seed);
    if (isnan(x)) continue;
    if (seen++ == 0) first = x;
    if (fabs(x - first) > 1e-9 * (1 + fabs(first))) return false;
  }
  return seen >= ENOUGH;
}

static pl_expr by_atom(pl_pool* p, pl_expr e, pl_expr atom) {
  return pl_kind_of(p, atom) == PL_SYMBOL ? pl_diff(p, e, pl_symbol_of(p, atom))
                                          : pl_diff_at(p, e, atom);
}

// dg/dq, of a constraint on velocities dg/dq'.
static pl_expr slope_of(pl_geometry* g, pl_expr atom) {
  return by_atom(g->pool, g->c->g, g->c->has_velocity ? pl_dt(g->pool, atom) : atom);
}

// ---------------------------------------------------------------------------------------- partners
static const pl_spatial* body_in_space(const pl_model* m, pl_name name, const pl_block* block) {
  for (int i = 0; i < m->spatials.n; i++)
    if (m->spatials.at[i].name.text == name.text && m->spatials.at[i].block == block)
      return &m->spatials.at[i];
  return NULL;
}

static void add_partner(pl_geometry* g, pl_name name, const pl_point* at, pl_expr angle,
                        const pl_block* block) {
  if (block && block != g->c->block) return;
  pl_push(g->r->arena, g->partners,
          (pl_partner){name, *at, angle, body_in_space(g->r->model, name, block)});
  for (int j = 0; j < at->n; j++) pl_group_atoms(g->r, g->atoms, at->at[j]);
  if (!pl_is_poison(angle)) pl_group_atoms(g->r, g->atoms, angle);
}

static bool depends_on(pl_geometry* g, const pl_partner* a, pl_expr atom) {
  bool any = !pl_is_poison(a->angle) && !pl_is_zero_node(g->pool, by_atom(g->pool, a->angle, atom));
  for (int j = 0; j < a->at.n; j++)
    any |= !pl_is_zero_node(g->pool, by_atom(g->pool, a->at.at[j], atom));
  return any;
}

// Whether the constraint moves it at all.
static bool is_concerned(pl_geometry* g, const pl_partner* a) {
  for (int i = 0; i < g->atoms->atoms.n; i++)
    if (!pl_is_zero_node(g->pool, slope_of(g, g->atoms->atoms.at[i]))
        && depends_on(g, a, g->atoms->atoms.at[i]))
      return true;
  return false;
}

// ------------------------------------------------------------------------------- the linear system
enum { MOST = 5 };  // 3 components and 2 moments
typedef struct pl_unknowns {
  int n, n_components;
  int component[3];        // of the force: those in which the partners move
  int moment_a, moment_b;  // columns, -1: none
  pl_expr value[MOST];
} pl_unknowns;

static pl_expr column(pl_geometry* g, const pl_unknowns* u, const pl_partner* a,
                      const pl_partner* b, int col, pl_expr atom) {
  pl_pool* p = g->pool;
  if (col == u->moment_a) return by_atom(p, a->angle, atom);
  if (col == u->moment_b) return by_atom(p, b->angle, atom);
  int j = u->component[col];
  pl_expr own = by_atom(p, a->at.at[j], atom);
  return b ? pl_sub(p, own, by_atom(p, b->at.at[j], atom)) : own;
}

static bool moves_along(pl_geometry* g, const pl_partner* a, const pl_partner* b, int j) {
  for (int i = 0; i < g->atoms->atoms.n; i++) {
    pl_expr atom = g->atoms->atoms.at[i], own = by_atom(g->pool, a->at.at[j], atom);
    if (!pl_is_zero_node(g->pool,
                         b ? pl_sub(g->pool, own, by_atom(g->pool, b->at.at[j], atom)) : own))
      return true;
  }
  return false;
}

static void name_unknowns(pl_geometry* g, const pl_partner* a, const pl_partner* b,
                          pl_unknowns* u) {
  *u = (pl_unknowns){.moment_a = -1, .moment_b = -1};
  for (int j = 0; j < a->at.n; j++)
    if (moves_along(g, a, b, j)) u->component[u->n++] = j;
  u->n_components = u->n;
  if (!pl_is_poison(a->angle)) u->moment_a = u->n++;
  if (b && !pl_is_poison(b->angle)) u->moment_b = u->n++;
}

// Rows that determine the unknowns, by elimination in numbers with the largest pivots; false: they
// do not.
static bool pick_rows(double* A, int rows, int n, int* row) {
  bool* used = NULL;
  bool small[256] = {false};
  if (rows > 256) return false;
  used = small;
  for (int k = 0; k < n; k++) {
    int best = -1;
    for (int i = 0; i < rows; i++)
      if (!used[i] && (best < 0 || fabs(A[i * n + k]) > fabs(A[best * n + k]))) best = i;
    if (best < 0 || !(fabs(A[best * n + k]) > 1e-9)) return false;
    used[best] = true;
    row[k] = best;
    for (int i = 0; i < rows; i++) {
      if (used[i]) continue;
      double f = A[i * n + k] / A[best * n + k];
      for (int j = k; j < n; j++) A[i * n + j] -= f * A[best * n + j];
    }
  }
  return true;
}

// Elimination in the order of the rows picked, whose pivots are known not to vanish.
static void eliminate(pl_pool* p, pl_expr* A, pl_expr* b, int n) {
  for (int k = 0; k < n; k++) {
    for (int i = k + 1; i < n; i++) {
      if (pl_is_zero_node(p, A[i * n + k])) continue;
      pl_expr f = pl_div(p, A[i * n + k], A[k * n + k]);
      for (int j = k; j < n; j++)
        A[i * n + j] = j == k ? pl_int(p, 0) : pl_sub(p, A[i * n + j], pl_mul(p, f, A[k * n + j]));
      b[i] = pl_sub(p, b[i], pl_mul(p, f, b[k]));
    }
  }
  for (int k = n - 1; k >= 0; k--) {
    for (int j = k + 1; j < n; j++) b[k] = pl_sub(p, b[k], pl_mul(p, A[k * n + j], b[j]));
    b[k] = pl_div(p, b[k], A[k * n + k]);
  }
}

static bool numbers_of_rows(pl_geometry* g, const pl_unknowns* u, const pl_partner* a,
                            const pl_partner* b, double* A) {
  for (uint64_t seed = 1; seed <= SEEDS; seed++) {
    bool good = true;
    for (int i = 0; i < g->rows->atoms.n && good; i++)
      for (int k = 0; k < u->n && good; k++) {
        A[i * u->n + k] = number_at(g, column(g, u, a, b, k, g->rows->atoms.at[i]), seed);
        good = !isnan(A[i * u->n + k]);
      }
    if (good) return true;
  }
  return false;
}

// Rows that are the same at all positions make the better pivots: they vanish nowhere.
static void prefer_constant_rows(pl_geometry* g, const pl_unknowns* u, const pl_partner* a,
                                 const pl_partner* b, double* A) {
  static const double less = 1e-3;
  for (int i = 0; i < g->rows->atoms.n; i++) {
    bool constant = true;
    for (int k = 0; k < u->n && constant; k++)
      constant = is_constant_here(g, column(g, u, a, b, k, g->rows->atoms.at[i]));
    for (int k = 0; k < u->n && !constant; k++) A[i * u->n + k] *= less;
  }
}

// Whether these partners explain the constraint; the forces are then in u.
static bool explains(pl_geometry* g, const pl_partner* a, const pl_partner* b, pl_unknowns* u) {
  pl_pool* p = g->pool;
  int rows = g->rows->atoms.n, row[MOST];
  name_unknowns(g, a, b, u);
  if (u->n == 0 || u->n > MOST || u->n > rows) return false;
  double* numbers = PL_ARRAY(g->r->arena, double, (size_t)rows*(size_t)u->n + 1);
  if (!numbers_of_rows(g, u, a, b, numbers)) return false;
  prefer_constant_rows(g, u, a, b, numbers);
  if (!pick_rows(numbers, rows, u->n, row)) return false;
  pl_expr A[MOST * MOST];
  for (int i = 0; i < u->n; i++) {
    pl_expr atom = g->rows->atoms.at[row[i]];
    for (int k = 0; k < u->n; k++) A[i * u->n + k] = column(g, u, a, b, k, atom);
    u->value[i] = slope_of(g, atom);
  }
  eliminate(p, A, u->value, u->n);
  bool any = false;
  for (int k = 0; k < u->n_components; k++) any |= !vanishes(g, u->value[k], 1);
  for (int i = 0; i < rows && any; i++) {
    pl_expr atom = g->rows->atoms.at[i], rest = slope_of(g, atom);
    for (int k = 0; k < u->n; k++)
      rest = pl_sub(p, rest, pl_mul(p, u->value[k], column(g, u, a, b, k, atom)));
    any = vanishes(g, rest, 1);
  }
  return any;
}

// -------------------------------------------------------------------------------- where it touches
static pl_expr dot(pl_pool* p, const pl_expr* a, const pl_expr* b, int n) {
  pl_expr sum = pl_int(p, 0);
  for (int j = 0; j < n; j++) sum = pl_add(p, sum, pl_mul(p, a[j], b[j]));
  return sum;
}

static bool complain(pl_geometry* g, pl_span span, const char* en, const char* de,
                     const char* fix_en, const char* fix_de) {
  const char* label = g->c->name.text;
  pl_diagnostic* d = pl_report(g->r->job->diagnostics, PL_E066, span,
                               pl_format(g->r->arena, en, label),
                               pl_format(g->r->arena, de, label));
  if (fix_en)
    pl_report_fix(d, pl_format(g->r->arena, fix_en, label), pl_format(g->r->arena, fix_de, label),
                  NULL);
  return false;
}

static bool no_place(pl_geometry* g, const pl_friction* f) {
  return complain(g, f->span,
                  PL_BOTH("the constraint %s does not say where on the body the friction acts"),
                  PL_BOTH("say where: friction ..., at (x, y) on %s"));
}

// The arm of a point fixed in the body, in the sense in which its angle turns it: r = r_t t + r_n n
// with M = r x Z.
static bool fixed_arm(pl_geometry* g, const pl_partner* a, pl_expr moment,
                      const pl_contact_touch* out, int sense, pl_expr* arm) {
  pl_pool* p = g->pool;
  pl_expr n[2], along = pl_div(p, moment, out->size);
  for (int j = 0; j < 2; j++) n[j] = pl_div(p, out->force[j], out->size);
  bool plain = pl_kind_of(p, a->angle) == PL_SYMBOL || pl_kind_of(p, a->angle) == PL_AT;
  if (!plain || !is_constant_here(g, n[0]) || !is_constant_here(g, n[1]) || vanishes(g, moment, 1))
    return false;
  pl_expr t[2] = {n[1], pl_neg(p, n[0])}, down = pl_neg(p, by_atom(p, along, a->angle));
  along = pl_mul(p, pl_int(p, sense), along);
  for (int j = 0; j < 2; j++) arm[j] = pl_add(p, pl_mul(p, along, t[j]), pl_mul(p, down, n[j]));
  return true;
}

// The arm of the force on body a.
static bool find_arm(pl_geometry* g, const pl_friction* f, const pl_partner* a, bool alone,
                     pl_expr moment, const pl_contact_touch* out, pl_expr* arm) {
  pl_pool* p = g->pool;
  if (f->at.n == 2) {
    for (int j = 0; j < 2; j++) arm[j] = pl_sub(p, f->at.at[j], a->at.at[j]);
    return true;
  }
  if (fixed_arm(g, a, moment, out, out->sense, arm)) return true;
  if (!vanishes(g, moment, 1)) return no_place(g, f);
  // the constraint keeps a distance from a plane
  pl_expr n[2];
  for (int j = 0; j < 2; j++) n[j] = pl_div(p, out->force[j], out->size);
  pl_expr down = pl_sub(p, pl_div(p, g->c->g, out->size), dot(p, n, a->at.at, 2)), at_zero = down;
  // it does not depend on the coordinates, so any of their values will do
  for (int i = 0; i < g->atoms->atoms.n; i++)
    at_zero = pl_subst_expr(p, at_zero, g->atoms->atoms.at[i], pl_int(p, 0));
  if (!isnan(number_at(g, at_zero, 1))
      && fabs(number_at(g, at_zero, 1) - number_at(g, down, 1)) < 1e-9)
    down = at_zero;
  if (!alone || !is_constant_here(g, n[0]) || !is_constant_here(g, n[1])
      || !is_constant_here(g, down))
    return no_place(g, f);
  for (int j = 0; j < 2; j++) arm[j] = pl_mul(p, down, n[j]);
  return true;
}

// The arm on a body in space: to the place given; without one, along the normal at the distance
// that the constraint keeps from a plane (a ball on a floor).
static bool find_arm_in_space(pl_geometry* g, const pl_friction* f, const pl_partner* a, bool alone,
                              const pl_contact_touch* out, pl_expr* arm) {
  pl_pool* p = g->pool;
  pl_expr n[3];
  bool plane = alone;
  for (int j = 0; j < 3; j++) {
    arm[j] = f->at.n == 3 ? pl_sub(p, f->at.at[j], a->at.at[j]) : pl_int(p, 0);
    n[j] = pl_div(p, out->force[j], out->size);
    plane = plane && is_constant_here(g, n[j]);
  }
  if (f->at.n == 3) return true;
  pl_expr down = pl_sub(p, pl_div(p, g->c->g, out->size), dot(p, n, a->at.at, 3));
  if (!plane || !is_constant_here(g, down)) return no_place(g, f);
  for (int j = 0; j < 3; j++) arm[j] = pl_mul(p, down, n[j]);
  return true;
}

// v + ω × r
static void velocity_in_space(pl_geometry* g, const pl_partner* a, const pl_expr* arm, pl_expr* v) {
  pl_pool* p = g->pool;
  const pl_expr* w = a->body->spin;
  for (int j = 0; j < 3; j++) {
    int k = (j + 1) % 3, l = (j + 2) % 3;
    pl_expr turned = pl_sub(p, pl_mul(p, w[k], arm[l]), pl_mul(p, w[l], arm[k]));
    v[j] = pl_add(p, pl_dt(p, a->at.at[j]), turned);
  }
}

// Velocity of the point of a body that is at the arm: of its centre, turned.
static void velocity_at(pl_geometry* g, const pl_friction* f, const pl_partner* a,
                        const pl_expr* arm, int sense, pl_expr* v) {
  pl_pool* p = g->pool;
  for (int j = 0; j < a->at.n; j++) v[j] = pl_dt(p, a->at.at[j]);
  if (pl_is_poison(a->angle)) return;
  // a place that turns with the body is a point of it
  bool fixed = false;
  for (int j = 0; j < f->at.n; j++)
    for (int i = 0; i < g->atoms->atoms.n; i++)
      fixed |= !pl_is_zero_node(p, by_atom(p, a->angle, g->atoms->atoms.at[i]))
               && !pl_is_zero_node(p, by_atom(p, f->at.at[j], g->atoms->atoms.at[i]));
  for (int j = 0; j < f->at.n && fixed; j++) v[j] = pl_dt(p, f->at.at[j]);
  if (fixed) return;
  pl_expr turn = pl_mul(p, pl_int(p, sense), pl_dt(p, a->angle));
  v[0] = pl_sub(p, v[0], pl_mul(p, turn, arm[1]));
  v[1] = pl_add(p, v[1], pl_mul(p, turn, arm[0]));
}

static bool slide(pl_geometry* g, const pl_friction* f, const pl_partner* a, const pl_partner* b,
                  const pl_unknowns* u, pl_contact_touch* out) {
  pl_pool* p = g->pool;
  pl_expr arm_a[3], arm_b[3], v[3], w[3];
  bool body_a = u->moment_a >= 0, body_b = u->moment_b >= 0;
  if (a->body && !find_arm_in_space(g, f, a, b == NULL, out, arm_a)) return false;
  if (b && b->body && !find_arm_in_space(g, f, b, false, out, arm_b)) return false;
  if (body_a && !find_arm(g, f, a, b == NULL, u->value[u->moment_a], out, arm_a)) return false;
  // a partner that is a point is touched where it is
  for (int j = 0; j < out->n; j++)
    out->place[j] = body_a                        ? pl_add(p, a->at.at[j], arm_a[j])
                    : f->at.n == out->n && body_b ? f->at.at[j]
                                                  : a->at.at[j];
  out->placed = (body_a || body_b) && f->at.n == 0;
  if (body_b)
    for (int j = 0; j < 2; j++) arm_b[j] = pl_sub(p, out->place[j], b->at.at[j]);
  if (a->body) velocity_in_space(g, a, arm_a, v);
  else velocity_at(g, f, a, arm_a, out->sense, v);
  if (b && b->body) velocity_in_space(g, b, arm_b, w);
  else if (b) velocity_at(g, f, b, arm_b, 1, w);
  for (int j = 0; j < out->n; j++) {
    out->slip[j] = b ? pl_sub(p, v[j], w[j]) : v[j];
    if (f->surface.n == out->n) out->slip[j] = pl_sub(p, out->slip[j], f->surface.at[j]);
  }
  return true;
}

// |Z|, which is 1 where it is that for all angles.
static pl_expr length_of(pl_geometry* g, const pl_contact_touch* t) {
  pl_expr size = pl_sqrt(g->pool, dot(g->pool, t->force, t->force, t->n));
  bool unit = vanishes(g, pl_sub(g->pool, size, pl_int(g->pool, 1)), 1e-3);
  return unit ? pl_int(g->pool, 1) : size;
}

// The force of a constraint on a body alone; false: it is not that.
static bool force_on(pl_geometry* g, const pl_partner* a, pl_unknowns* u, pl_contact_touch* out) {
  pl_pool* p = g->pool;
  if (!explains(g, a, NULL, u)) return false;
  out->n = a->at.n;
  for (int j = 0; j < 3; j++) out->force[j] = pl_int(p, 0);
  for (int k = 0; k < u->n_components; k++) out->force[u->component[k]] = u->value[k];
  out->size = length_of(g, out);
  return true;
}

static bool same_arm(pl_geometry* g, const pl_expr* a, const pl_expr* b) {
  return vanishes(g, pl_sub(g->pool, a[0], b[0]), 1) && vanishes(g, pl_sub(g->pool, a[1], b[1]), 1);
}

// Which way the angle of a body turns it. Counter-clockwise, unless other contacts of the body say
// otherwise: two planes touch it at two points, so where the arms would coincide the angle turns
// the other way (the angle of a ladder to the floor).
static int sense_of(pl_geometry* g, const pl_partner* a, const pl_expr* arm) {
  const pl_model* m = g->r->model;
  const pl_constraint* c = g->c;
  int sense = 1;
  for (int i = 0; i < m->constraints.n && sense > 0; i++) {
    const pl_constraint* other = &m->constraints.at[i];
    if (other == c || other->block != c->block || other->has_velocity || other->relation == PL_EQ)
      continue;
    pl_unknowns u;
    pl_contact_touch t = {0};
    pl_expr there[3];
    g->c = other;
    bool fits = force_on(g, a, &u, &t) && u.moment_a >= 0
                && fixed_arm(g, a, u.value[u.moment_a], &t, 1, there);
    g->c = c;
    if (fits && same_arm(g, arm, there)) sense = -1;
  }
  return sense;
}

static bool take(pl_geometry* g, const pl_friction* f, const pl_partner* a, const pl_partner* b,
                 pl_contact_touch* out) {
  pl_unknowns u;
  pl_pool* p = g->pool;
  if (b && a->at.n != b->at.n) return false;
  if (!explains(g, a, b, &u)) return false;
  out->n = a->at.n;
  out->sense = 1;
  for (int j = 0; j < 3; j++) out->force[j] = pl_int(p, 0);
  for (int k = 0; k < u.n_components; k++) out->force[u.component[k]] = u.value[k];
  out->size = length_of(g, out);
  pl_expr arm[3];
  if (u.moment_a >= 0 && !b && f->at.n == 0 && fixed_arm(g, a, u.value[u.moment_a], out, 1, arm))
    out->sense = sense_of(g, a, arm);
  return slide(g, f, a, b, &u, out);
}

// --------------------------------------------------------------------------------------------- all
static pl_geometry* geometry_make(pl_recorder* r, const pl_constraint* c) {
  pl_geometry* g = PL_NEW(r->arena, pl_geometry);
  *g = (pl_geometry){.r = r, .pool = r->pool, .c = c, .atoms = PL_NEW(r->arena, pl_record_group)};
  g->rows = g->atoms;
  g->atoms->atom_at = pl_map_make(r->arena);
  g->atoms->seen = pl_map_make(r->arena);
  bool time = r->explicit_time;
  pl_group_atoms(r, g->atoms, c->g);
  const pl_model* m = r->model;
  for (int i = 0; i < m->masses.n; i++)
    add_partner(g, m->masses.at[i].name, &m->masses.at[i].point, pl_poison(),
                m->masses.at[i].block);
  for (int i = 0; i < m->bodies.n; i++)
    add_partner(g, m->bodies.at[i].name, &m->bodies.at[i].centre, m->bodies.at[i].angle,
                m->bodies.at[i].block);
  r->explicit_time = time;
  return g;
}

// A body in space whose attitude the constraint depends on: where it touches wanders over its
// surface.
static bool attitude_matters(const pl_geometry* g) {
  pl_pool* p = g->pool;
  for (int i = 0; i < g->r->model->spatials.n; i++) {
    const pl_spatial* b = &g->r->model->spatials.at[i];
    for (int k = 0; k < g->atoms->atoms.n; k++) {
      pl_expr atom = g->atoms->atoms.at[k];
      bool turns = false;
      for (int j = 0; j < 3; j++)
        turns |= !pl_is_zero_node(p, by_atom(p, b->spin[j], pl_dt(p, atom)));
      if (turns && !pl_is_zero_node(p, by_atom(p, g->c->g, atom))) return true;
    }
  }
  return false;
}

bool pl_contact_geometry(pl_recorder* r, const pl_constraint* c, const pl_friction* f,
                         pl_contact_touch* out) {
  pl_geometry* g = geometry_make(r, c);
  int errors = r->job->diagnostics->n_errors;
  *out = (pl_contact_touch){0};
  for (int i = 0; i < g->partners.n; i++) {
    if (!is_concerned(g, &g->partners.at[i])) continue;
    if (take(g, f, &g->partners.at[i], NULL, out)) return true;
    if (r->job->diagnostics->n_errors > errors) return false;
  }
  for (int i = 0; i < g->partners.n; i++) {
    for (int k = 0; k < g->partners.n; k++) {
      if (k == i || !is_concerned(g, &g->partners.at[i])) continue;
      if (k < i && is_concerned(g, &g->partners.at[k])) continue;
      if (take(g, f, &g->partners.at[i], &g->partners.at[k], out)) return true;
      if (r->job->diagnostics->n_errors > errors) return false;
    }
  }
  if (attitude_matters(g))
    return complain(
        g, f->span,
        PL_BOTH("%s depends on the attitude of a body in space: friction on it is computed for "
                "balls, whose contacts do not"),
        NULL, NULL);
  return complain(
      g, f->span,
      PL_BOTH("%s presses no two things together: it is no contact of a mass or body with a "
              "surface or with another one"),
      NULL, NULL);
}

// --------------------------------------------------------------------------------- size of a force
// Virtual work gives the components of Z along which a partner can move. Those are all of Z where
// its coordinates span the space; a crank pin at (r cos φ, r sin φ) tells nothing about the part
// along the crank.
static bool spans(const pl_unknowns* u, const pl_partner* a) { return u->n_components == a->at.n; }

static bool is_the_same_everywhere(pl_geometry* g, const pl_unknowns* u, const pl_partner* a) {
  bool same = true;
  for (int i = 0; i < g->atoms->atoms.n; i++) {
    pl_expr atom = g->atoms->atoms.at[i];
    same = same && is_constant_here(g, slope_of(g, atom));
    for (int k = 0; k < u->n; k++)
      same = same && is_constant_here(g, column(g, u, a, NULL, k, atom));
  }
  return same;
}

static pl_expr size_of(pl_geometry* g, const pl_unknowns* u) {
  pl_contact_touch t = {.n = u->n_components};
  for (int k = 0; k < t.n; k++) t.force[k] = u->value[k];
  return length_of(g, &t);
}

// Against something fixed. Where the coordinates do not span the space the guide is left out of the
// model; a linear constraint along a straight guide is a drive along it, all others might pull
// across.
static pl_expr size_alone(pl_geometry* g, const pl_partner* a) {
  pl_unknowns u;
  if (!explains(g, a, NULL, &u)) return pl_poison();
  if (!spans(&u, a) && !is_the_same_everywhere(g, &u, a)) return pl_poison();
  return size_of(g, &u);
}

// The force between two points acts along the line that joins them.
static bool is_central(pl_geometry* g, const pl_partner* a, const pl_partner* b,
                       const pl_unknowns* u) {
  pl_pool* p = g->pool;
  pl_expr Z[3] = {pl_int(p, 0), pl_int(p, 0), pl_int(p, 0)}, way[3] = {Z[0], Z[0], Z[0]};
  for (int k = 0; k < u->n_components; k++) Z[u->component[k]] = u->value[k];
  for (int j = 0; j < a->at.n; j++) way[j] = pl_sub(p, a->at.at[j], b->at.at[j]);
  for (int j = 0; j < 3; j++) {
    int k = (j + 1) % 3, l = (j + 2) % 3;
    if (!vanishes(g, pl_sub(p, pl_mul(p, Z[k], way[l]), pl_mul(p, Z[l], way[k])), 1)) return false;
  }
  return true;
}

static pl_expr size_between(pl_geometry* g, const pl_partner* a, const pl_partner* b) {
  pl_unknowns u;
  if (a->at.n != b->at.n || !explains(g, a, b, &u)) return pl_poison();
  bool points = u.moment_a < 0 && u.moment_b < 0 && !a->body && !b->body;
  if (points ? !is_central(g, a, b, &u) : !spans(&u, a)) return pl_poison();
  return size_of(g, &u);
}

// A rope over a fixed pulley: a force on each mass, all of one size. Each mass has coordinates of
// its own, which span its space.
static pl_expr size_on_each(pl_geometry* g) {
  pl_expr size = pl_poison();
  for (int m = 0; m < g->partners.n; m++) {
    const pl_partner* a = &g->partners.at[m];
    if (!is_concerned(g, a)) continue;
    if (!pl_is_poison(a->angle) || a->body) return pl_poison();
    pl_geometry own = *g;
    own.rows = PL_NEW(g->r->arena, pl_record_group);
    for (int i = 0; i < g->atoms->atoms.n; i++) {
      pl_expr atom = g->atoms->atoms.at[i];
      if (!depends_on(g, a, atom)) continue;
      pl_push(g->r->arena, own.rows->atoms, atom);
      for (int k = 0; k < g->partners.n; k++)
        if (k != m && depends_on(g, &g->partners.at[k], atom)) return pl_poison();
    }
    pl_unknowns u;
    if (!explains(&own, a, NULL, &u) || !spans(&u, a)) return pl_poison();
    pl_expr here = size_of(g, &u);
    if (!pl_is_poison(size) && !vanishes(g, pl_sub(g->pool, here, size), 1)) return pl_poison();
    size = here;
  }
  return size;
}

// A member of a family that the constraint touches, with its index put in.
static void add_member(pl_geometry* g, const pl_mass* m, const pl_instances* in, int k) {
  pl_point at = m->point;
  bool touched = false;
  for (int j = 0; j < at.n; j++) {
    for (int d = 0; d < in->depth; d++) {
      pl_expr index = pl_int(g->pool, in->index[k * in->depth + d]);
      at.at[j] = pl_subst1(g->pool, at.at[j], in->symbol[d], index);
    }
    for (int i = 0; i < g->atoms->atoms.n; i++)
      touched |= !pl_is_zero_node(g->pool, by_atom(g->pool, at.at[j], g->atoms->atoms.at[i]));
  }
  if (touched) add_partner(g, m->name, &at, pl_poison(), NULL);
}

static void add_members(pl_geometry* g) {
  const pl_model* m = g->r->model;
  bool time = g->r->explicit_time;
  for (int i = 0; i < m->masses.n; i++) {
    const pl_mass* mass = &m->masses.at[i];
    pl_instances in;
    if (!mass->block || pl_model_instances(g->r->job, m, mass->block, &in) != PLEUEL_OK) continue;
    for (int k = 0; k < in.n; k++) add_member(g, mass, &in, k);
  }
  g->r->explicit_time = time;
}

pl_expr pl_force_length(pl_recorder* r, const pl_constraint* c) {
  pl_geometry* g = geometry_make(r, c);
  add_members(g);
  pl_expr size = pl_poison();
  for (int i = 0; i < g->partners.n && pl_is_poison(size); i++)
    if (is_concerned(g, &g->partners.at[i])) size = size_alone(g, &g->partners.at[i]);
  for (int i = 0; i < g->partners.n; i++)
    for (int k = 0; k < i && pl_is_poison(size); k++)
      if (is_concerned(g, &g->partners.at[i]) && is_concerned(g, &g->partners.at[k]))
        size = size_between(g, &g->partners.at[i], &g->partners.at[k]);
  return pl_is_poison(size) ? size_on_each(g) : size;
}
