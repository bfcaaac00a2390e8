// answer_lagrange2: the Lagrange function in generalized coordinates, the equations of the second
// kind, the Hamilton function.
#include <string.h>

#include "mechanics/structured.h"
#include "worked/worked_impl.h"

static const pl_form* zero_form(pl_analysis* d) {
  return pl_form_leaf(d->arena, pl_int(d->pool, 0));
}

static const pl_form* names_of_generalized(pl_analysis* d) {
  const pl_form** f = PL_ARRAY(d->arena, const pl_form*, d->gen.n + 1);
  for (int k = 0; k < d->gen.n; k++) f[k] = pl_fs(d, d->q.at[d->gen.at[k]].q);
  return pl_flist(d, f, d->gen.n);
}

static bool without_reduction(pl_analysis* d) {
  if (d->reduced) return false;
  pl_say(
      d,
      PL_BOTH(
          "The constraints were not solved for generalized coordinates. Name them and their map, "
          "for example: "
          "choose φ with x = l cos φ, y = l sin φ."),
      0);
  d->page->section->not_found = true;
  return true;
}

// ----------------------------------------------------------------------------------------- the map
// Text after a map equation: which constraint it solves, by which branch.
static void say_what_it_solves(pl_analysis* d, pl_step* step, int i) {
  int k = d->q.at[i].solved_by;
  if (k < 0) return;
  const char* label = d->g.at[k].source->name.text;
  for (int b = 0; b < d->model->branches.n && d->q.at[i].by_branch; b++) {
    const pl_condition* c = &d->model->branches.at[b];
    if (!pl_has_symbol(d->pool, c->left, d->q.at[i].q)
        && !pl_has_symbol(d->pool, c->right, d->q.at[i].q))
      continue;
    static const char* const op[] = {"=", ">=", "<=", ">", "<", "≠"};
    const char* branch = pl_format(d->arena, "%s %s %s", pl_expr_text(d->arena, d->pool, c->left),
                                   op[c->relation], pl_expr_text(d->arena, d->pool, c->right));
    pl_step_after(step, PL_BOTH_FORMAT(d->arena, "solves %s, branch %s", label, branch));
    return;
  }
  if (d->q.at[i].by_branch) {  // the other solutions belong to other positions
    pl_step_after(step, PL_BOTH_FORMAT(d->arena, "solves %s, on the side of the start", label));
    return;
  }
  pl_step_after(step, PL_BOTH_FORMAT(d->arena, "solves %s", label));
}

// Constraints that the map of `choose` satisfies identically.
static void say_satisfied(pl_analysis* d) {
  const pl_form** f = PL_ARRAY(d->arena, const pl_form*, d->g.n + 1);
  int n = 0;
  for (int k = 0; k < d->g.n; k++) {
    const pl_bond* l = &d->g.at[k];
    bool by_coordinate = l->fixes >= 0 || l->implied || pl_in_loop(d, k);
    for (int i = 0; i < d->q.n; i++) by_coordinate |= d->q.at[i].solved_by == k;
    if (by_coordinate) continue;
    f[n++] = pl_fn(d, l->source->name.text);
    pl_claim_free(d, PL_CLAIM_MAP, pl_on_maps(d, l->g), pl_int(d->pool, 0));
  }
  if (n == 0) return;
  pl_say(d,
         PL_BOTH(n == 1 ? "With this map {1} holds identically."
                        : "With this map {1} hold identically."),
         1, pl_flist(d, f, n));
}

static void show_maps(pl_analysis* d) {
  bool chosen = false;
  for (int i = 0; i < d->q.n; i++) {
    const pl_variable* c = &d->q.at[i];
    if (c->fixed_by >= 0 || pl_is_poison(c->map) || pl_follower(d, i) >= 0 || c->follows) continue;
    const pl_form* form = pl_f(d, c->map, PL_S_SOLUTION);
    pl_step* step = pl_show(d, pl_feq(d, pl_fs(d, c->q), form));
    say_what_it_solves(d, step, i);
    chosen |= c->solved_by == -1;
    if (c->solved_by >= 0) {
      pl_expr g = pl_subst1(d->pool, pl_on_contact(d, d->g.at[c->solved_by].g), c->q,
                            pl_form_value(d->pool, form));
      pl_claim_free(d, PL_CLAIM_MAP, pl_on_maps(d, g), pl_int(d->pool, 0));
    }
    pl_value* v = pl_answer(d, pl_symbol_get(d->pool, c->q)->ascii, c->map, form);
    v->lhs = pl_sym(d->pool, c->q);
    v->lhs_form = pl_fs(d, c->q);
  }
  if (chosen) say_satisfied(d);
}

static void show_velocities(pl_analysis* d) {
  for (int i = 0; i < d->q.n; i++) {
    const pl_variable* c = &d->q.at[i];
    if (c->fixed_by >= 0 || pl_is_poison(c->map) || pl_follower(d, i) >= 0 || c->follows) continue;
    pl_expr v = pl_dt(d->pool, c->map);
    const pl_form* form = pl_f(d, v, PL_S_PLAIN);
    pl_show(d, pl_feq(d, pl_fs(d, c->v), form));
    pl_claim_that(d, PL_CLAIM_ENERGY, pl_form_value(d->pool, form), v);
    pl_value* value = pl_answer(d, pl_symbol_get(d->pool, c->v)->ascii, v, form);
    value->lhs = pl_sym(d->pool, c->v);
    value->lhs_form = pl_fs(d, c->v);
  }
}

static void show_energy(pl_analysis* d, const char* name, pl_expr e, pl_expr raw) {
  const pl_form* form = strcmp(name, "V") == 0 ? pl_potential_form(d, pl_on_maps(d, raw), e)
                                               : pl_f(d, e, PL_S_ENERGY);
  pl_show(d, pl_feq(d, pl_fl(d, name), form));
  pl_claim_that(d, PL_CLAIM_ENERGY, pl_form_value(d->pool, form), raw);
  pl_answer(d, name, e, form);
}

// A Lagrange function of the text has no T and V of its own.
static bool given(const pl_analysis* d) {
  for (int k = 0; k < d->model->loads.n; k++) {
    if (d->model->loads.at[k].kind == PL_L_LAGRANGIAN) return true;
  }
  return false;
}

static void show_lagrangian(pl_analysis* d) {
  pl_expr L = pl_alg_normal(d->tower, d->Lg);
  const pl_form* form = pl_f(d, L, PL_S_ENERGY);
  const pl_form* both[2] = {pl_fl(d, "T"), pl_form_neg(d->arena, pl_fl(d, "V"))};
  const pl_form* right = given(d) ? form : pl_feq(d, pl_form_sum(d->arena, both, 2), form);
  d->page->number_lagrangian = pl_show_numbered(d, pl_feq(d, pl_fl(d, "L"), right))->number;
  pl_claim_that(d, PL_CLAIM_ENERGY, pl_form_value(d->pool, form), d->L);
  pl_answer(d, "L", L, form);
}

void pl_answer_lagrangian(pl_analysis* d, const pl_ask* ask) {
  bool mapped = d->maps.n > 0 && d->reduced;
  const pl_form* names = names_of_generalized(d);
  pl_section_open(d, ask, PL_BOTH("Lagrange function"));
  if (!d->reduced) {
    pl_expr T = pl_on_contact(d, d->T), V = pl_on_contact(d, d->V);
    show_energy(d, "T", T, d->T);
    show_energy(d, "V", V, d->V);
    pl_expr L = pl_on_contact(d, d->L);
    pl_show_numbered(d, pl_feq(d, pl_fl(d, "L"), pl_f(d, L, PL_S_ENERGY)));
    pl_answer(d, "L", L, pl_f(d, L, PL_S_ENERGY));
    return;
  }
  if (d->gen.n == 0) {
    pl_say(d, PL_BOTH("Nothing is left to choose: the constraints prescribe the whole motion."), 0);
  } else {
    pl_say(
        d,
        PL_BOTH(d->gen.n == 1 ? "Generalized coordinate: {1}." : "Generalized coordinates: {1}."),
        1, names);
  }
  if (mapped) {
    show_maps(d);
    pl_tell_singular(d);
    show_velocities(d);
  }
  if (!given(d)) {
    show_energy(d, "T", d->Tg, d->T);
    show_energy(d, "V", d->Vg, d->V);
  }
  show_lagrangian(d);
}

// ------------------------------------------------------------------------------------- second kind
// The constant factor that all terms of an equation share: masses, lengths, numbers.
static pl_expr common_factor(pl_analysis* d, pl_expr e) {
  pl_factor f[24];
  pl_expr unit = pl_int(d->pool, 1), common = pl_int(d->pool, 1);
  int n = pl_alg_factors(d->tower, e, f, 24, &unit);
  for (int k = 0; k < n; k++) {
    if (pl_has_coordinates(d, f[k].base) || pl_has_symbol(d->pool, f[k].base, pl_time(d->pool)))
      continue;
    common = pl_mul(d->pool, common, pl_pow_int(d->pool, f[k].base, f[k].power));
  }
  if (pl_is_number(d->pool, unit) && pl_number_sign(d->pool, unit) < 0)
    unit = pl_neg(d->pool, unit);
  return n > 0 ? pl_mul(d->pool, unit, common) : common;
}

static const long long_mass = 14;  // operators in M(q) above which it gets a name

// One degree of freedom with a long M(q):  M q'' + 1/2 M' q'^2 + V' = 0.
static bool show_with_named_mass(pl_analysis* d, int i) {
  const pl_variable* c = &d->q.at[i];
  pl_expr M = pl_alg_normal(d->tower, pl_diff(d->pool, pl_diff(d->pool, d->Tg, c->v), c->v));
  pl_expr momentum = pl_diff(d->pool, d->Tg, c->v);
  bool natural = pl_alg_equal(d->tower, momentum, pl_mul(d->pool, M, pl_sym(d->pool, c->v)))
                 == PL_YES;
  const pl_form* form = pl_f(d, M, PL_S_ENERGY);
  if (!pl_has_symbol(d->pool, M, c->q) || pl_form_ops(form) < long_mass || d->dissipative
      || !natural || d->loops.n > 0)
    return false;
  const pl_form* mass = pl_fn(
      d, pl_format(d->arena, "%s(%s)", pl_letter(d, "M"), pl_symbol_get(d->pool, c->q)->name));
  const pl_form* M_name = pl_fl(d, "M");
  pl_say(d, PL_BOTH("With {1}"), 1, pl_feq(d, mass, form));
  pl_claim_that(d, PL_CLAIM_ENERGY, pl_form_value(d->pool, form), M);
  const pl_form* q2 = pl_form_power(d->arena, pl_fs(d, c->v),
                                    pl_form_leaf(d->arena, pl_int(d->pool, 2)));
  pl_form* slope = pl_form_make(d->arena, PL_F_DERIVATIVE, 1, &M_name);
  slope->expr = pl_sym(d->pool, c->q);
  const pl_form* first[2] = {M_name, pl_fs(d, c->a)};
  const pl_form* second[3] = {pl_fe(d, pl_ratio(d->pool, 1, 2)), slope, q2};
  pl_expr dV = pl_alg_normal(d->tower, pl_diff(d->pool, d->Vg, c->q));
  const pl_form* force = pl_f(d, dV, PL_S_EQUATION);
  int n_force = pl_is_zero_node(d->pool, dV) ? 0 : force->kind == PL_F_SUM ? force->n : 1;
  const pl_form** terms = PL_ARRAY(d->arena, const pl_form*, 2 + n_force);
  terms[0] = pl_form_product(d->arena, first, 2);
  terms[1] = pl_form_product(d->arena, second, 3);
  for (int k = 0; k < n_force; k++) terms[2 + k] = force->kind == PL_F_SUM ? force->args[k] : force;
  pl_why_second_kind(d, i);
  pl_step* step = pl_show_numbered(
      d, pl_feq(d, pl_form_sum(d->arena, terms, 2 + n_force), zero_form(d)));
  pl_step_refs(step, 1, d->page->number_lagrangian);
  pl_push(d->arena, d->page->lagrange2_numbers, step->number);
  return true;
}

static pl_expr with_zero(pl_analysis* d, pl_expr e, bool velocities) {
  pl_replace* zero = PL_ARRAY(d->arena, pl_replace, d->gen.n + 1);
  for (int k = 0; k < d->gen.n; k++) {
    const pl_variable* c = &d->q.at[d->gen.at[k]];
    zero[k] = (pl_replace){velocities ? c->v : c->a, pl_int(d->pool, 0)};
  }
  return pl_alg_normal(d->tower, pl_subst(d->pool, e, zero, d->gen.n));
}

static const pl_form* times(pl_analysis* d, const pl_form* c, pl_symbol a) {
  bool negative = c->kind == PL_F_NEG;
  if (negative) c = c->args[0];
  const pl_form* factor[2] = {c, pl_fs(d, a)};
  bool one = c->kind == PL_F_EXPR && pl_is_one_node(d->pool, c->expr);
  const pl_form* product = one ? factor[1] : pl_form_product(d->arena, factor, 2);
  return negative ? pl_form_neg(d->arena, product) : product;
}

// Rule K2: terms in q'', then in q', then forces, each group presented by itself.
static const pl_form* by_order(pl_analysis* d, pl_expr e) {
  const pl_form** part = PL_ARRAY(d->arena, const pl_form*, d->gen.n + 2);
  int n = 0;
  for (int k = 0; k < d->gen.n; k++) {
    pl_symbol a = d->q.at[d->gen.at[k]].a;
    pl_expr c = pl_alg_normal(d->tower, pl_diff(d->pool, e, a));
    if (!pl_is_zero_node(d->pool, c)) part[n++] = times(d, pl_f(d, c, PL_S_QUOTIENT), a);
  }
  pl_expr rest = with_zero(d, e, false), force = with_zero(d, rest, true);
  // dry friction, |v|/v, has no value at v = 0
  if (pl_is_poison(force)) force = pl_int(d->pool, 0);
  pl_expr moving = pl_alg_normal(d->tower, pl_sub(d->pool, rest, force));
  if (!pl_is_zero_node(d->pool, moving))
    part[n++] = pl_positive_first(d, pl_f(d, moving, PL_S_EQUATION));
  if (!pl_is_zero_node(d->pool, force))
    part[n++] = pl_positive_first(d, pl_f(d, force, PL_S_EQUATION));
  return pl_joined_sum(d, part, n);
}

// Without inertia the equation of the second kind is the principle of virtual work: minus the work
// of all forces along a shift of q_i,
//   dV/dq_i - sum Q_j dq_j/dq_i,
// with the shifts from the constraints' maps.
static pl_expr virtual_work(pl_analysis* d, int i) {
  pl_expr sum = pl_int(d->pool, 0);
  for (int j = 0; j < d->q.n; j++) {
    const pl_variable* c = &d->q.at[j];
    pl_expr shift = j == i                 ? pl_int(d->pool, 1)
                    : pl_is_poison(c->map) ? pl_int(d->pool, 0)
                                           : pl_by_coordinate(d, c->map, i);
    if (pl_is_zero_node(d->pool, shift)) continue;
    pl_expr push = pl_sub(d->pool, pl_diff(d->pool, d->V, c->q), d->force[j]);
    sum = pl_add(d->pool, sum, pl_mul(d->pool, shift, pl_on_maps(d, push)));
  }
  return sum;
}

static void show_second_kind(pl_analysis* d, int i) {
  pl_expr raw = pl_second_kind(d, i);
  pl_expr e = pl_alg_normal(d->tower, raw);
  pl_expr factor = common_factor(d, e);
  pl_expr shown = pl_alg_normal(d->tower, pl_div(d->pool, e, factor));
  const pl_form* form = by_order(d, shown);
  pl_why_second_kind(d, i);
  pl_step* step = pl_show_numbered(d, pl_feq(d, form, zero_form(d)));
  pl_step_refs(step, 1, d->page->number_lagrangian);
  pl_push(d->arena, d->page->lagrange2_numbers, step->number);
  bool moves = pl_has_role(d->pool, e, PL_R_ACCELERATION) || pl_has_role(d->pool, e, PL_R_VELOCITY);
  if (moves) {
    pl_claim_that(d, PL_CLAIM_ONE_TWO, pl_form_value(d->pool, form), pl_int(d->pool, 0));
  } else {  // a condition on the place: it holds where there is balance, not everywhere
    pl_claim_that(d, PL_CLAIM_OTHER, pl_mul(d->pool, factor, pl_form_value(d->pool, form)),
                  virtual_work(d, i));
  }
}

// operators of a normal form up to which a shorter form is looked for
static const long longest_searched = 1500;
// operators up to which an acceleration is written in closed form
static const long longest_answer = 150;
// the same, when another one is shown over named intermediates
static const long longest_beside = 60;

// Too long to be written out when there are several.
static bool is_long(pl_analysis* d, int i, long longest) {
  pl_expr a = d->solved ? d->acceleration[i] : pl_poison();
  if (pl_is_poison(a)) return true;
  if (d->gen.n == 1) return false;
  return pl_op_count(d->pool, a) > longest_searched
         || pl_form_ops(pl_f(d, a, PL_S_QUOTIENT)) > longest;
}

// A solved acceleration: in closed form, or over named intermediates.
static void show_solved(pl_analysis* d, int i, long longest) {
  pl_expr a = d->solved ? d->acceleration[i] : pl_poison();
  pl_symbol name = d->q.at[i].a;
  if (is_long(d, i, longest) && pl_show_structured(d, name, a)) return;
  if (pl_is_poison(a)) return;
  const pl_form* form = pl_f(d, a, PL_S_QUOTIENT);
  pl_claim_that(d, PL_CLAIM_ONE_TWO, pl_form_value(d->pool, form), pl_sym(d->pool, name));
  bool told = d->gen.n == 1 && pl_form_ops(form) > longest_beside;  // its equation tells it better
  pl_step* step = told ? NULL : pl_show_numbered(d, pl_feq(d, pl_fs(d, name), form));
  for (int k = 0; k < d->page->lagrange2_numbers.n && step; k++)
    pl_step_refs(step, 1, d->page->lagrange2_numbers.at[k]);
  pl_answer(d, pl_symbol_get(d->pool, name)->ascii, a, form);
}

static void show_all_solved(pl_analysis* d) {
  bool structured = false;
  for (int k = 0; k < d->gen.n; k++) structured |= is_long(d, d->gen.at[k], longest_answer);
  for (int k = 0; k < d->gen.n; k++)
    show_solved(d, d->gen.at[k], structured ? longest_beside : longest_answer);
}

// With the energy the motion of one degree of freedom is an integral: t = ∫ dq sqrt(M / (2 (E -
// V))).
static void show_quadrature(pl_analysis* d, int i) {
  const pl_variable* c = &d->q.at[i];
  pl_expr E = pl_conserved_energy(d);
  if (pl_is_poison(E) || pl_is_poison(d->acceleration[i])) return;
  pl_expr M = pl_diff(d->pool, pl_diff(d->pool, d->Tg, c->v), c->v);
  if (!pl_has_coordinates(d, d->acceleration[i]) || !pl_has_symbol(d->pool, M, c->q)) return;
  const pl_form* V = pl_f(d, d->Vg, PL_S_ENERGY);
  const pl_form* difference[2] = {pl_fl(d, "E"), pl_form_neg(d->arena, V)};
  const pl_form* twice[2] = {pl_form_leaf(d->arena, pl_int(d->pool, 2)),
                             pl_form_sum(d->arena, difference, 2)};
  const pl_form* root = pl_form_root(
      d->arena, pl_form_quotient(d->arena, pl_fl(d, "M"), pl_form_product(d->arena, twice, 2)));
  pl_form* integral = pl_form_make(d->arena, PL_F_INTEGRAL, 1, &root);
  integral->expr = pl_sym(d->pool, c->q);
  pl_say(
      d,
      PL_BOTH(
          "The energy is conserved, so the motion is one integral; no elementary closed form was "
          "found:"),
      0);
  const pl_form* either[1] = {integral};  // a motion to either side
  pl_show(d, pl_feq(d, pl_fn(d, "t"), pl_form_make(d->arena, PL_F_PLUSMINUS, 1, either)));
}

void pl_answer_lagrange2(pl_analysis* d, const pl_ask* ask) {
  pl_section_open(d, ask,
                  PL_BOTH(d->gen.n == 1 ? "Lagrange equation of the second kind"
                                        : "Lagrange equations of the second kind"));
  if (without_reduction(d)) return;
  pl_tell_singular(d);
  bool named = d->gen.n == 1 && show_with_named_mass(d, d->gen.at[0]);
  for (int k = 0; k < d->gen.n && !named; k++) show_second_kind(d, d->gen.at[k]);
  show_all_solved(d);
  if (d->gen.n == 0) {
    pl_say(d, PL_BOTH("Nothing is left to choose: the constraints prescribe the whole motion."), 0);
  } else if (!d->solved && !pl_has_role(d->pool, d->Lg, PL_R_VELOCITY)) {
    pl_say(
        d,
        PL_BOTH("No mass moves: this is the condition of balance, the principle of virtual work."),
        0);
  } else if (!d->solved && !pl_structure_of_accelerations(d)) {
    pl_say(d,
           PL_BOTH("The accelerations are not determined by these equations: the mass matrix is "
                   "singular."),
           0);
    d->page->section->not_found = true;
  }
  if (named) show_quadrature(d, d->gen.at[0]);
}

// ------------------------------------------------------------------------------- Hamilton function
static pl_symbol momentum_symbol(pl_analysis* d, int i) {
  const pl_symbol_info* q = pl_symbol_get(d->pool, d->q.at[i].q);
  pl_symbol_info info = {.name = pl_format(d->arena, "p_%s", q->name),
                         .ascii = pl_format(d->arena, "p_%s", q->ascii),
                         .role = PL_R_MOMENTUM,
                         .class = PL_C_VELOCITY};
  info.dimension = pl_dimension_of_expr(d, pl_diff(d->pool, d->Lg, d->q.at[i].v),
                                        &info.dimension_known);
  return pl_symbol_make(d->pool, &info);
}

enum { most_momenta = 4 };  // up to which H(q, p) is written out in full

void pl_answer_hamiltonian(pl_analysis* d, const pl_ask* ask) {
  pl_section_open(d, ask, PL_BOTH("Hamilton function"));
  if (without_reduction(d)) return;
  int n = d->gen.n;
  pl_expr* A = PL_ARRAY(d->arena, pl_expr, n * n + 1);
  pl_expr *b = PL_ARRAY(d->arena, pl_expr, n + 1), *v = PL_ARRAY(d->arena, pl_expr, n + 1);
  pl_replace* rest = PL_ARRAY(d->arena, pl_replace, n + 1);
  for (int k = 0; k < n; k++) rest[k] = (pl_replace){d->q.at[d->gen.at[k]].v, pl_int(d->pool, 0)};
  for (int k = 0; k < n; k++) {
    pl_expr p = pl_diff(d->pool, d->Lg, d->q.at[d->gen.at[k]].v);
    pl_symbol name = momentum_symbol(d, d->gen.at[k]);
    pl_show(d, pl_feq(d, pl_fs(d, name), pl_f(d, pl_alg_normal(d->tower, p), PL_S_ENERGY)));
    for (int j = 0; j < n; j++) A[k * n + j] = pl_diff(d->pool, p, d->q.at[d->gen.at[j]].v);
    b[k] = pl_sub(d->pool, pl_sym(d->pool, name), pl_subst(d->pool, p, rest, n));
  }
  pl_answer3 solved = n == 0             ? PL_NO
                      : n > most_momenta ? PL_UNKNOWN
                                         : pl_alg_solve(d->tower, n, A, b, v, 50000);
  if (solved != PL_YES) {
    bool singular = solved == PL_NO;
    pl_say(d,
           PL_BOTH(singular ? "The momenta cannot be solved for the velocities: the Lagrange "
                              "function is singular."
                            : "H(q, p) takes the inverse of the mass matrix, which is too long to "
                              "be written out "
                              "here; the momenta are given."),
           0);
    d->page->section->not_found = true;
    return;
  }
  pl_expr H = pl_neg(d->pool, d->Lg);
  for (int k = 0; k < n; k++) {
    H = pl_add(d->pool, H,
               pl_mul(d->pool, pl_sym(d->pool, momentum_symbol(d, d->gen.at[k])),
                      pl_sym(d->pool, d->q.at[d->gen.at[k]].v)));
    rest[k].to = v[k];
  }
  H = pl_alg_normal(d->tower, pl_subst(d->pool, H, rest, n));
  const pl_form* form = pl_f(d, H, PL_S_ENERGY);
  pl_step_refs(pl_show_numbered(d, pl_feq(d, pl_fl(d, "H"), form)), 1, d->page->number_lagrangian);
  pl_answer(d, "H", H, form);
}
