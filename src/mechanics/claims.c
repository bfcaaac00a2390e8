// claims: what was displayed is held against the model itself. Accelerations and multipliers are
// found numerically at random
// points of the domain, from d'Alembert's principle with raw derivatives of the position map,
//   sum_k m_k J_k^T (J_k a + a0_k) = Q + G^T lambda,   d^2 g/dt^2 = 0,
// so neither the Lagrange function's expansion nor the tower takes part.
// See theory (19.3).
#include "mechanics/claims.h"

#include <string.h>

#include "mechanics/mechanics.h"
#include "mechanics/structured.h"
#include "verify/verify.h"

// -------------------------------------------------------------------------------------- d'Alembert
// Row i:  sum_k m_k dX_k/dq_i . X_k''  +  J dα/dq_i α''  -  Q_i.
static pl_expr inertia_row(pl_analysis* d, int i) {
  pl_pool* p = d->pool;
  pl_expr sum = pl_int(p, 0);
  for (int k = 0; k < d->particle.n; k++) {
    const pl_particle* m = &d->particle.at[k];
    for (int c = 0; c < m->n; c++) {
      pl_expr push = pl_dt(p, pl_dt(p, m->at[c]));
      sum = pl_add(p, sum,
                   pl_mul_n(p, (pl_expr[]){m->mass, pl_diff(p, m->at[c], d->q.at[i].q), push}, 3));
    }
    if (pl_is_poison(m->angle)) continue;
    pl_expr turn = pl_dt(p, pl_dt(p, m->angle));
    sum = pl_add(p, sum,
                 pl_mul_n(p, (pl_expr[]){m->inertia, pl_diff(p, m->angle, d->q.at[i].q), turn}, 3));
  }
  return sum;
}

// What the masses do not account for: potentials, extra kinetic terms, a given Lagrange function,
// forces.
static pl_expr force_row(pl_analysis* d, int i) {
  pl_pool* p = d->pool;
  pl_expr T = pl_int(p, 0);
  for (int k = 0; k < d->particle.n; k++) {
    const pl_particle* m = &d->particle.at[k];
    for (int c = 0; c < m->n; c++) {
      T = pl_add(
          p, T,
          pl_mul_n(p, (pl_expr[]){pl_ratio(p, 1, 2), m->mass, pl_square(p, pl_dt(p, m->at[c]))},
                   3));
    }
    if (!pl_is_poison(m->angle)) {
      T = pl_add(
          p, T,
          pl_mul_n(p, (pl_expr[]){pl_ratio(p, 1, 2), m->inertia, pl_square(p, pl_dt(p, m->angle))},
                   3));
    }
  }
  pl_expr rest = pl_sub(p, d->L, T);
  pl_expr euler = pl_sub(p, pl_dt(p, pl_diff(p, rest, d->q.at[i].v)),
                         pl_diff(p, rest, d->q.at[i].q));
  return pl_sub(p, euler, d->force[i]);
}

typedef struct pl_system_of_motion {
  int n, n_definitions;
  pl_symbol* unknown;
  pl_expr *row, *A, *b;
  pl_definition* definition;
} pl_system_of_motion;

static void define(pl_system_of_motion* s, pl_symbol symbol, pl_expr value) {
  s->definition[s->n_definitions++] = (pl_definition){symbol, value};
}

// The special case that the given numbers are: c = √(m1 m2).
static void define_cases(pl_analysis* d, pl_system_of_motion* s) {
  for (int k = 0; k < d->cases.n; k++) define(s, d->cases.at[k].from, d->cases.at[k].to);
}

// Coordinates and velocities that follow from others: fixed, closed contacts, mapped.
static void definitions(pl_analysis* d, pl_system_of_motion* s, int assembly) {
  int n_loops = pl_loop_definitions(d, assembly, NULL);
  int n_given = d->cases.n + d->model->lets.n;
  s->definition = PL_ARRAY(d->arena, pl_definition,
                           2 * d->q.n + n_given + n_loops + pl_structure_definitions(d, NULL, 0));
  define_cases(d, s);
  for (int k = 0; k < d->model->lets.n; k++) {
    const pl_let* l = &d->model->lets.at[k];
    if (l->n_args == 0 && !l->inserted) define(s, l->symbol, l->value);
  }
  s->n_definitions += pl_loop_definitions(d, assembly, s->definition + s->n_definitions);
  for (int i = 0; i < d->q.n; i++) {
    const pl_variable* c = &d->q.at[i];
    pl_expr value = c->fixed_by >= 0 ? c->fixed : d->reduced ? c->map : pl_poison();
    if (pl_is_poison(value) || pl_follower(d, i) >= 0) continue;
    define(s, c->q, value);
    define(s, c->v, pl_dt(d->pool, value));
  }
  // named intermediates
  s->n_definitions += pl_structure_definitions(d, s->definition + s->n_definitions,
                                               pl_structure_definitions(d, NULL, 0));
}

// The motion is unique: solved in closed form, or by a system with named entries whose pivots do
// not vanish.
static bool is_determined(const pl_analysis* d) {
  return d->solved || d->of_multipliers || d->of_accelerations;
}

static bool contains_motion(pl_analysis* d, pl_expr e) {
  return pl_has_role(d->pool, e, PL_R_VELOCITY) || pl_has_role(d->pool, e, PL_R_ACCELERATION);
}

// The facts of the model, and the signs that were assumed on the way (r >= 0 of a distance, cos α
// >= 0): formulas hold there.
static void domain(pl_analysis* d, pl_domain* setup) {
  int n_used = 0, n = d->facts.n;
  const pl_fact* used = pl_tower_used(d->tower, &n_used);
  pl_fact* fact = PL_ARRAY(d->arena, pl_fact, n + n_used + 1);
  for (int k = 0; k < n; k++) fact[k] = d->facts.at[k];
  for (int k = 0; k < n_used; k++) {
    if (!contains_motion(d, used[k].difference)) fact[n++] = used[k];
  }
  setup->facts = fact;
  setup->n_facts = n;
}

static bool takes_part(const pl_analysis* d, const pl_variable* c) {
  return c->carries || (c->chosen && d->reduced && (pl_is_poison(c->map) || c->solved_by == -3));
}

// Rows of the map that determine the chosen coordinates: which coordinates they are of, in `of`.
static int independent_maps(pl_analysis* d, int* of) {
  int m = 0, n = 0;
  int* mapped = PL_ARRAY(d->arena, int, d->q.n);
  int* chosen = PL_ARRAY(d->arena, int, d->q.n);
  for (int i = 0; d->reduced && i < d->q.n; i++) {
    const pl_variable* c = &d->q.at[i];
    if (!pl_is_poison(c->map) && c->solved_by == -1) mapped[m++] = i;
    if (c->chosen && !c->carries) chosen[n++] = i;
  }
  if (m == 0 || n == 0) return 0;
  pl_expr* J = PL_ARRAY(d->arena, pl_expr, m * n);
  for (int a = 0; a < m; a++) {
    for (int b = 0; b < n; b++)
      J[a * n + b] = pl_diff(d->pool, d->q.at[mapped[a]].map, d->q.at[chosen[b]].q);
  }
  int* independent = PL_ARRAY(d->arena, int, m);
  int rank = pl_alg_rank(d->tower, m, n, J, independent);
  for (int k = 0; k < rank; k++) of[k] = mapped[independent[k]];
  return rank;
}

// A force on a chosen coordinate reaches the masses through the map: it pushes along dX/dφ, with a
// multiplier for each chosen
// coordinate.  Adds them as unknowns, after the coordinates' rows.
typedef struct pl_coupling {
  int n, n_chosen;
  int* of;  // coordinates whose map it is
  int* chosen;
  pl_symbol* multiplier;  // NULL: nothing acts on chosen coordinates, none are needed
} pl_coupling;

static pl_coupling couple(pl_analysis* d) {
  pl_coupling c = {.of = PL_ARRAY(d->arena, int, d->q.n + 1)};
  c.n = independent_maps(d, c.of);
  if (pl_loaded_by_name(d) < 0) return c;
  c.multiplier = PL_ARRAY(d->arena, pl_symbol, d->q.n + 1);
  c.chosen = PL_ARRAY(d->arena, int, d->q.n + 1);
  for (int i = 0; i < d->q.n; i++) {
    if (d->q.at[i].chosen && !d->q.at[i].carries) c.chosen[c.n_chosen++] = i;
  }
  for (int k = 0; k < c.n_chosen; k++) {
    const char* name = pl_format(d->arena, "map_%d", k);
    c.multiplier[k] = pl_symbol_make(
        d->pool,
        &(pl_symbol_info){.name = name, .ascii = name, .role = PL_R_LOCAL, .class = PL_C_OTHER});
  }
  return c;
}

// What the map exerts on coordinate i: a force along dX/dφ on the mapped ones, its reaction on the
// chosen ones.
static pl_expr coupling_push(pl_analysis* d, const pl_coupling* c, int i) {
  pl_expr sum = pl_int(d->pool, 0);
  for (int k = 0; c->multiplier && k < c->n_chosen; k++) {
    pl_expr slope = pl_diff(d->pool, pl_along_map(d, d->q.at[c->chosen[k]].q), d->q.at[i].q);
    sum = pl_add(d->pool, sum, pl_mul(d->pool, pl_sym(d->pool, c->multiplier[k]), slope));
  }
  return sum;
}

// Unknowns: accelerations of all coordinates and all multipliers. Rows: d'Alembert for what carries
// something, constraints
// twice differentiated, maps twice differentiated for what only stands in `choose`.
static void rows(pl_analysis* d, pl_system_of_motion* s) {
  int cap = 3 * d->q.n + d->g.n, n_rows = 0;
  pl_coupling coupling = couple(d);
  s->unknown = PL_ARRAY(d->arena, pl_symbol, cap);
  s->row = PL_ARRAY(d->arena, pl_expr, cap);
  for (int i = 0; i < d->q.n; i++) {
    const pl_variable* c = &d->q.at[i];
    if (!takes_part(d, c)) continue;
    s->unknown[s->n++] = c->a;
    if (c->chosen && !c->carries && !coupling.multiplier) continue;
    if (c->solved_by == -3) {  // a hidden constraint gives it
      s->row[n_rows++] = pl_sub(d->pool, pl_sym(d->pool, c->a),
                                pl_dt(d->pool, pl_dt(d->pool, c->map)));
      continue;
    }
    pl_expr row = pl_add(d->pool, inertia_row(d, i), force_row(d, i));
    for (int k = 0; k < d->g.n; k++) {
      // a shared force is free: any value will do
      if (d->g.at[k].implied && !d->g.at[k].shared) continue;
      pl_expr push = pl_mul(d->pool, pl_sym(d->pool, d->g.at[k].lambda), d->g.at[k].push[i]);
      row = pl_sub(d->pool, row, push);
    }
    s->row[n_rows++] = pl_sub(d->pool, row, coupling_push(d, &coupling, i));
  }
  for (int k = 0; coupling.multiplier && k < coupling.n_chosen; k++)
    s->unknown[s->n++] = coupling.multiplier[k];
  for (int k = 0; k < d->g.n; k++) {
    if (d->g.at[k].implied) continue;
    s->unknown[s->n++] = d->g.at[k].lambda;
    s->row[n_rows++] = pl_bond_acceleration(d, k);
  }
  for (int k = 0; k < coupling.n; k++) {
    const pl_variable* c = &d->q.at[coupling.of[k]];
    pl_expr a = pl_dt(d->pool, pl_dt(d->pool, c->map));
    // angles that are no coordinates of the model
    if (pl_has_followers(d, c->map)) a = pl_subst(d->pool, a, d->maps.at, d->maps.n);
    s->row[n_rows++] = pl_sub(d->pool, pl_sym(d->pool, c->a), a);
  }
  if (n_rows != s->n) s->n = 0;
}

static void split_rows(pl_analysis* d, pl_system_of_motion* s) {
  pl_replace* zero = PL_ARRAY(d->arena, pl_replace, s->n);
  for (int j = 0; j < s->n; j++) zero[j] = (pl_replace){s->unknown[j], pl_int(d->pool, 0)};
  s->A = PL_ARRAY(d->arena, pl_expr, s->n * s->n);
  s->b = PL_ARRAY(d->arena, pl_expr, s->n);
  for (int i = 0; i < s->n; i++) {
    for (int j = 0; j < s->n; j++) s->A[i * s->n + j] = pl_diff(d->pool, s->row[i], s->unknown[j]);
    s->b[i] = pl_neg(d->pool, pl_subst(d->pool, s->row[i], zero, s->n));
  }
}

static pl_verifier* on_the_motion(pl_analysis* d, int assembly) {
  pl_system_of_motion s = {0};
  definitions(d, &s, assembly);
  rows(d, &s);
  if (!is_determined(d)) s.n = 0;
  split_rows(d, &s);
  pl_domain setup = {.definitions = s.definition,
                     .n_definitions = s.n_definitions,
                     .n_unknowns = s.n,
                     .unknowns = s.unknown,
                     .A = s.A,
                     .b = s.b};
  domain(d, &setup);
  return pl_verifier_make(d->job, d->pool, &setup);
}

static pl_verifier* on_free_points(pl_analysis* d) {
  pl_system_of_motion s = {0};
  s.definition = PL_ARRAY(d->arena, pl_definition, d->cases.n + d->model->lets.n);
  define_cases(d, &s);
  for (int k = 0; k < d->model->lets.n; k++) {
    const pl_let* l = &d->model->lets.at[k];
    if (l->n_args == 0 && !l->inserted) define(&s, l->symbol, l->value);
  }
  pl_domain setup = {.definitions = s.definition, .n_definitions = s.n_definitions};
  domain(d, &setup);
  return pl_verifier_make(d->job, d->pool, &setup);
}

// ---------------------------------------------------------------------------------------- verdicts
static void fail_check(pl_analysis* d, pl_check* check, const pl_claim* c) {
  check->passed = false;
  if (!check->failed_on) check->failed_on = pl_expr_text(d->arena, d->pool, c->shown);
}

// Without a unique motion (singular mass matrix) accelerations and multipliers cannot be drawn.
static bool needs_motion(const pl_analysis* d, const pl_claim* c) {
  // equations of first order have no free velocities
  if (c->kind == PL_CLAIM_MOTION || c->kind == PL_CLAIM_ONE_TWO) return true;
  return pl_has_role(d->pool, c->shown, PL_R_ACCELERATION)
         || pl_has_role(d->pool, c->reference, PL_R_ACCELERATION)
         || pl_has_role(d->pool, c->shown, PL_R_MULTIPLIER)
         || pl_has_role(d->pool, c->reference, PL_R_MULTIPLIER);
}

static void check_at(pl_analysis* d, pl_check* check, const pl_claim* c, pl_verifier* where) {
  pl_verification got = pl_verify(where, c->shown, c->reference);
  check->points += got.points_mod + got.points_arb;
  if (got.worst > check->worst) check->worst = got.worst;
  if (got.equal != PL_YES) fail_check(d, check, c);
}

// Checks of one kind are one line, in whatever coordinates the formulas were.
static void add_check(pl_analysis* d, pl_checks* out, pl_check check) {
  if (check.formulas == 0) return;
  for (int k = 0; k < out->n; k++) {
    pl_check* before = &out->at[k];
    if (strcmp(before->name[0], check.name[0]) != 0) continue;
    before->passed &= check.passed;
    before->points += check.points;
    before->formulas += check.formulas;
    if (check.worst > before->worst) before->worst = check.worst;
    if (!before->failed_on) before->failed_on = check.failed_on;
    return;
  }
  pl_push(d->arena, *out, check);
}

// motion: one for each assembly.
static void check_kind(pl_analysis* d, const pl_claims* claims, const char* const name[2],
                       pl_checks* out, pl_claim_kind kind, pl_verifier** motion, int n_motions,
                       pl_verifier* free_points) {
  pl_check check = {.name = {name[0], name[1]}, .passed = true};
  for (int i = 0; i < claims->n; i++) {
    const pl_claim* c = &claims->at[i];
    if (c->kind != kind || pl_is_poison(c->shown) || pl_is_poison(c->reference)) continue;
    if (!is_determined(d) && !c->own_domain && needs_motion(d, c)) continue;
    check.formulas++;
    if (c->own_domain) check_at(d, &check, c, free_points);
    for (int a = 0; a < n_motions && !c->own_domain; a++) check_at(d, &check, c, motion[a]);
  }
  add_check(d, out, check);
}

// Both sides of each claim have the same dimension, where all names have one.
static void check_units(pl_analysis* d, const pl_claims* claims, const char* const name[2],
                        pl_checks* out) {
  pl_check check = {.name = {name[0], name[1]}, .passed = true};
  for (int i = 0; i < claims->n; i++) {
    const pl_claim* c = &claims->at[i];
    if (pl_is_poison(c->shown) || pl_is_poison(c->reference) || pl_is_constant(d->pool, c->shown)
        || pl_is_constant(d->pool, c->reference)) {
      continue;
    }
    bool known1, known2;
    pl_dimension a = pl_dimension_of_expr(d, c->shown, &known1),
                 b = pl_dimension_of_expr(d, c->reference, &known2);
    if (!known1 || !known2) continue;
    check.formulas++;
    if (!pl_dimension_equal(a, b)) fail_check(d, &check, c);
  }
  add_check(d, out, check);
}

void pl_claims_check(pl_analysis* d, const pl_claims* claims, const char* const name[][2],
                     pl_checks* out) {
  check_units(d, claims, name[PL_N_CLAIMS], out);
  pl_verifier *motion[pl_max_assemblies], *free_points = on_free_points(d);
  int n = pl_assemblies(d);
  for (int a = 0; a < n; a++) motion[a] = on_the_motion(d, a);
  for (int kind = 0; kind < PL_N_CLAIMS; kind++)
    check_kind(d, claims, name[kind], out, kind, motion, n, free_points);
}
