// solve_motion: accelerations and multipliers from the Lagrange equations of the first kind and the
// constraints, by exact linear algebra. With generalized coordinates the accelerations of the map
// are inserted and the unknowns are q'' of the generalized coordinates and the multipliers; without
// them, all accelerations and the twice-differentiated constraints. The multiplier of a dropped
// constraint is what is left of the equation of its coordinate (theorem T101).
// See theory (3.5).
#include "mechanics/mechanics.h"

// Largest number of terms in a minor before the solver gives up and the structured form is shown
// instead.
static const long max_terms = 3000;

pl_expr pl_bond_acceleration(pl_analysis* d, int k) {
  const pl_bond* l = &d->g.at[k];
  pl_expr once = pl_dt(d->pool, l->g);
  return l->velocity ? once : pl_dt(d->pool, once);
}

pl_expr pl_along_map(pl_analysis* d, pl_symbol chosen) {
  const pl_choose* choose = &d->model->choose;
  pl_expr sum = pl_int(d->pool, 0);
  for (int k = 0; k < choose->n_maps; k++) {
    pl_expr gap = pl_sub(d->pool, choose->maps[k].old, choose->maps[k].map);
    sum = pl_add(d->pool, sum, pl_mul(d->pool, pl_diff(d->pool, choose->maps[k].map, chosen), gap));
  }
  return sum;
}

int pl_loaded_by_name(const pl_analysis* d) {
  for (int i = 0; i < d->q.n; i++) {
    const pl_variable* c = &d->q.at[i];
    if (c->chosen && !c->carries && !pl_is_zero_node(d->pool, d->euler[i])) return i;
  }
  return -1;
}

typedef struct pl_linear_rows {
  int n_unknowns, n_rows;
  pl_symbol* unknown;  //                       (n_unknowns)
  pl_expr* row;        // expressions that vanish  (n_rows)
} pl_linear_rows;

static bool at_work(const pl_bond* l) { return l->fixes < 0 && !l->implied; }

// What acts on a coordinate that only stands in `choose`, a torque on φ or its inertia, reaches the
// masses through the map x = X(φ),
// as a force along the map: A = dX/dφ (x - X) is a constraint whose multiplier takes up the
// equation of φ,
//   E_x + ∇A (J^T J)^-1 E_φ = sum λ ∇g,  J = dX/dφ.
// A part across the map does no work; it belongs to the constraints.
static pl_expr through_map(pl_analysis* d, int i) {
  pl_expr sum = pl_int(d->pool, 0);
  for (int k = 0; k < d->chosen_forces.n; k++) {
    const pl_chosen_force* f = &d->chosen_forces.at[k];
    pl_expr slope = pl_diff(d->pool, pl_along_map(d, d->q.at[f->coordinate].q), d->q.at[i].q);
    sum = pl_add(d->pool, sum, pl_mul(d->pool, slope, f->along));
  }
  return sum;
}

// The loads of chosen coordinates, (J^T J)^-1 E_φ; false when the map does not determine them.
static bool find_chosen_forces(pl_analysis* d) {
  int n = 0, *at = PL_ARRAY(d->arena, int, d->q.n + 1);
  if (!d->reduced || pl_loaded_by_name(d) < 0) return true;
  for (int i = 0; i < d->q.n; i++) {
    if (d->q.at[i].chosen && !d->q.at[i].carries) at[n++] = i;
  }
  pl_expr *A = PL_ARRAY(d->arena, pl_expr, n * n), *b = PL_ARRAY(d->arena, pl_expr, n),
          *x = PL_ARRAY(d->arena, pl_expr, n);
  for (int r = 0; r < n; r++) {
    b[r] = pl_on_maps(d, d->euler[at[r]]);
    for (int c = 0; c < n; c++)
      A[r * n + c] = pl_neg(
          d->pool,
          pl_on_maps(d, pl_diff(d->pool, pl_along_map(d, d->q.at[at[c]].q), d->q.at[at[r]].q)));
  }
  if (pl_alg_solve(d->tower, n, A, b, x, max_terms) != PL_YES) return false;
  for (int k = 0; k < n; k++) pl_push(d->arena, d->chosen_forces, (pl_chosen_force){at[k], x[k]});
  return true;
}

// E_i - sum over the working constraints of lambda dg/dq_i.
static pl_expr equation_of(pl_analysis* d, int i) {
  pl_expr e = pl_add(d->pool, d->euler[i], through_map(d, i));
  for (int k = 0; k < d->g.n; k++) {
    if (!at_work(&d->g.at[k])) continue;
    pl_expr push = pl_mul(d->pool, pl_sym(d->pool, d->g.at[k].lambda), d->g.at[k].push[i]);
    e = pl_sub(d->pool, e, push);
  }
  return pl_on_maps(d, e);
}

static void add_unknown(pl_linear_rows* s, pl_symbol u) { s->unknown[s->n_unknowns++] = u; }

static pl_linear_rows collect(pl_analysis* d) {
  pl_linear_rows s = {.unknown = PL_ARRAY(d->arena, pl_symbol, d->q.n + d->g.n),
                      .row = PL_ARRAY(d->arena, pl_expr, d->q.n + d->g.n)};
  for (int i = 0; i < d->q.n; i++) {
    const pl_variable* c = &d->q.at[i];
    if (c->fixed_by >= 0) continue;
    bool generalized = pl_is_poison(c->map) && (c->carries || (d->reduced && c->chosen));
    if (generalized) add_unknown(&s, c->a);
    if (c->solved_by != -3 && (c->carries || (d->reduced && c->chosen))) {
      pl_expr row = equation_of(d, i);
      bool passed_on = c->chosen && !c->carries && d->chosen_forces.n > 0;
      if (c->carries || !(passed_on || pl_is_zero_node(d->pool, row))) s.row[s.n_rows++] = row;
    }
  }
  for (int k = 0; k < d->g.n; k++) {
    if (!at_work(&d->g.at[k])) continue;
    add_unknown(&s, d->g.at[k].lambda);
    if (!d->reduced || d->g.at[k].velocity)
      s.row[s.n_rows++] = pl_on_maps(d, pl_bond_acceleration(d, k));
  }
  return s;
}

// Splits rows linear in the unknowns into matrix and right-hand side.
static bool split(pl_analysis* d, const pl_linear_rows* s, pl_expr* A, pl_expr* b) {
  pl_replace* zero = PL_ARRAY(d->arena, pl_replace, s->n_unknowns);
  for (int j = 0; j < s->n_unknowns; j++) zero[j] = (pl_replace){s->unknown[j], pl_int(d->pool, 0)};
  for (int i = 0; i < s->n_rows; i++) {
    for (int j = 0; j < s->n_unknowns; j++) {
      pl_expr a = pl_diff(d->pool, s->row[i], s->unknown[j]);
      if (pl_is_poison(a)) return false;
      A[i * s->n_unknowns + j] = a;
    }
    b[i] = pl_neg(d->pool, pl_subst(d->pool, s->row[i], zero, s->n_unknowns));
  }
  return true;
}

// What vanishes only when names that stand for other quantities are seen through, (g - a) sin φ
// with a := g, is 0.
static pl_expr or_zero(pl_analysis* d, pl_expr e) {
  return pl_alg_is_zero(d->tower, e) == PL_YES ? pl_int(d->pool, 0) : e;
}

static void keep_solution(pl_analysis* d, const pl_linear_rows* s, const pl_expr* x) {
  for (int j = 0; j < s->n_unknowns; j++) {
    int i = pl_variable_index(d, s->unknown[j]);
    pl_expr value = d->model->lets.n > 0 ? or_zero(d, x[j]) : x[j];
    if (i >= 0) d->acceleration[i] = value;
    for (int k = 0; k < d->g.n; k++) {
      if (d->g.at[k].lambda.id != s->unknown[j].id) continue;
      d->g.at[k].lambda_value = value;
      d->g.at[k].lambda_known = true;
    }
  }
}

// Accelerations of mapped coordinates follow from the map.
static void dependent_accelerations(pl_analysis* d) {
  for (int i = 0; i < d->q.n; i++) {
    const pl_variable* c = &d->q.at[i];
    if (c->fixed_by >= 0) {
      d->acceleration[i] = pl_dt(d->pool, pl_dt(d->pool, c->fixed));
    } else if (!pl_is_poison(c->map)) {
      d->acceleration[i] = pl_alg_normal(d->tower, pl_on_motion(d, pl_sym(d->pool, c->a)));
    }
  }
}

// Multipliers of the dropped constraints, last fixed first: lambda = (E_i - sum of the others) /
// (dg/dq_i).
static void dropped_multipliers(pl_analysis* d) {
  for (int round = 0; round < d->g.n; round++) {
    for (int k = d->g.n - 1; k >= 0; k--) {
      pl_bond* l = &d->g.at[k];
      if (l->fixes < 0 || l->lambda_known) continue;
      int i = l->fixes;
      pl_expr rest = d->euler[i];
      bool ready = true;
      for (int c = 0; c < d->g.n; c++) {
        const pl_bond* other = &d->g.at[c];
        if (c == k || other->implied || pl_is_zero_node(d->pool, other->push[i])) continue;
        ready &= other->lambda_known;
        if (ready)
          rest = pl_sub(d->pool, rest, pl_mul(d->pool, other->lambda_value, other->push[i]));
      }
      if (!ready) continue;
      l->lambda_value = pl_alg_normal(d->tower, pl_on_motion(d, pl_div(d->pool, rest, l->push[i])));
      l->lambda_known = !pl_is_poison(l->lambda_value);
    }
  }
}

// ---------------------------------------------------------------------- one row for one multiplier
// With q and q' of the map, but the accelerations left as names.
static pl_expr on_positions(pl_analysis* d, pl_expr e) {
  pl_replace* r = PL_ARRAY(d->arena, pl_replace, d->maps.n + 1);
  int n = 0;
  for (int k = 0; d->reduced && k < d->maps.n; k++) {
    if (pl_symbol_get(d->pool, d->maps.at[k].from)->role != PL_R_ACCELERATION)
      r[n++] = d->maps.at[k];
  }
  return pl_subst(d->pool, pl_on_contact(d, e), r, n);
}

static pl_expr row_of(pl_analysis* d, int k, int i, int* n_others) {
  pl_expr e = pl_add(d->pool, d->euler[i], through_map(d, i));
  *n_others = 0;
  for (int c = 0; c < d->g.n; c++) {
    const pl_bond* other = &d->g.at[c];
    if (c == k || (other->implied && !other->shared)
        || pl_is_zero_node(d->pool, pl_on_fixed(d, other->push[i])))
      continue;
    e = pl_sub(d->pool, e, pl_mul(d->pool, pl_sym(d->pool, other->lambda), other->push[i]));
    (*n_others)++;
  }
  return pl_alg_normal(d->tower, on_positions(d, pl_div(d->pool, e, d->g.at[k].push[i])));
}

// A row is divided by its coefficient of the multiplier: at a dead centre r sin φ = 0 it says
// nothing.
static bool can_vanish(pl_analysis* d, pl_expr coefficient) {
  pl_expr e = pl_on_maps(d, coefficient);
  return d->reduced && d->loops.n == 0 && pl_has_coordinates(d, e) && !pl_keeps_sign(d, e);
}

pl_expr pl_multiplier_by_row(pl_analysis* d, int k, int* coordinate) {
  const pl_bond* l = &d->g.at[k];
  pl_expr best = pl_poison();
  long best_cost = 0;
  for (int i = 0; i < d->q.n; i++) {
    bool own = l->fixes < 0 ? d->q.at[i].fixed_by < 0 : i == l->fixes;
    if (!d->q.at[i].carries || !own || pl_is_zero_node(d->pool, pl_on_fixed(d, l->push[i])))
      continue;
    int n_others;
    pl_expr e = row_of(d, k, i, &n_others);
    long cost = pl_is_poison(e) ? 0
                                : 1000L * n_others + pl_op_count(d->pool, e)
                                      + (can_vanish(d, l->gradient[i]) ? 500 : 0);
    if (pl_is_poison(e) || (!pl_is_poison(best) && cost >= best_cost)) continue;
    best = e;
    best_cost = cost;
    *coordinate = i;
  }
  return best;
}

// -------------------------------------------------------------------------------------- the system
static bool solve_system(pl_analysis* d, pl_linear_rows* s, pl_expr* x) {
  pl_expr* A = PL_ARRAY(d->arena, pl_expr, s->n_rows * s->n_unknowns + 1);
  pl_expr* b = PL_ARRAY(d->arena, pl_expr, s->n_rows + 1);
  if (s->n_rows != s->n_unknowns || !split(d, s, A, b)) return false;
  return s->n_unknowns == 0 || pl_alg_solve(d->tower, s->n_unknowns, A, b, x, max_terms) == PL_YES;
}

// Where the first-kind system is too large, or the map does not tell how a load of a chosen
// coordinate reaches the masses: the equations
// of the second kind give the accelerations; multipliers of non-trivial constraints then stay open.
static pl_linear_rows collect_second_kind(pl_analysis* d) {
  pl_linear_rows s = {.unknown = PL_ARRAY(d->arena, pl_symbol, d->gen.n + 1),
                      .row = PL_ARRAY(d->arena, pl_expr, d->gen.n + 1)};
  for (int k = 0; k < d->gen.n; k++) {
    add_unknown(&s, d->q.at[d->gen.at[k]].a);
    s.row[s.n_rows++] = pl_second_kind(d, d->gen.at[k]);
  }
  return s;
}

// A longer one is the determinant of a definite matrix, G M^-1 G^T or M: its sign says nothing that
// a reader would assume.
static const long longest_denominator = 60;

// Of a normal form, which is a product with its denominator in negative powers.
static pl_expr denominator(pl_analysis* d, pl_expr e) {
  pl_pool* p = d->pool;
  if (pl_kind_of(p, e) != PL_MUL && pl_kind_of(p, e) != PL_POW) return pl_int(p, 1);
  pl_expr den = pl_int(p, 1);
  int n = pl_kind_of(p, e) == PL_MUL ? pl_n_args(p, e) : 1;
  for (int k = 0; k < n; k++) {
    pl_expr factor = pl_kind_of(p, e) == PL_MUL ? pl_arg(p, e, k) : e;
    if (pl_kind_of(p, factor) != PL_POW) continue;
    pl_expr exponent = pl_arg(p, factor, 1);
    if (pl_is_number(p, exponent) && pl_number_sign(p, exponent) < 0) den = pl_div(p, den, factor);
  }
  return den;
}

// What is divided by must not vanish: proving its sign puts the assumptions on record ("used: m1 >
// 0, m2 > 0"). Where coordinates are
// in it, it is the determinant of a definite matrix, and nothing is assumed.
static void record_denominators(pl_analysis* d) {
  for (int k = 0; k < d->g.n; k++) {
    int sign;
    if (!d->g.at[k].lambda_known) continue;
    pl_expr den = denominator(d, d->g.at[k].lambda_value);
    bool given = !pl_is_poison(den) && !pl_is_number(d->pool, den) && !pl_has_coordinates(d, den);
    if (given && pl_op_count(d->pool, den) <= longest_denominator)
      pl_alg_sign(d->tower, den, false, &sign);
  }
}

// Friction that slips hangs on the multipliers, which the equations of the second kind do not know.
static bool slips(const pl_analysis* d) {
  for (int k = 0; k < d->g.n; k++) {
    if (d->g.at[k].rub) return true;
  }
  return false;
}

pleuel_status pl_solve_motion(pl_analysis* d) {
  d->acceleration = PL_ARRAY(d->arena, pl_expr, d->q.n);
  pl_expr* x = PL_ARRAY(d->arena, pl_expr, d->q.n + d->g.n + 1);
  bool passed_on = find_chosen_forces(d);
  pl_linear_rows s = collect(d);
  d->solved = passed_on && solve_system(d, &s, x);
  if (!d->solved && d->reduced && !slips(d)) {
    s = collect_second_kind(d);
    d->solved = solve_system(d, &s, x);
  }
  if (!d->solved) return PLEUEL_OK;  // said by the sections that need it
  keep_solution(d, &s, x);
  // shorter over the coefficients than by elimination of the multipliers
  if (d->loops.n > 0 && d->gen.n > 0 && !slips(d)) {
    s = collect_second_kind(d);
    if (solve_system(d, &s, x)) keep_solution(d, &s, x);
  }
  dependent_accelerations(d);
  dropped_multipliers(d);
  record_denominators(d);
  return PLEUEL_OK;
}
