// step_details: the details behind the lines of a derivation, shown on demand (`--steps full`).
// Each is a few lines in front of the one that
// they explain, marked as detail; their formulas are claims like all others.
//
//   first kind     d'Alembert: momenta, forces and gradients of one coordinate
//   constraints    the first time derivative, before the second
//   multipliers    what multiplies λ, and what is left
//   frames         the unit vectors, and the acceleration along the axes
//   second kind    momentum, its time derivative, and the slope of L
//   conserved      dE/dt as a sum of Lagrange's equations; Noether for a cyclic coordinate
//   integration    the attempt e^{st}, the position of rest, the Laplace transform
//   oscillations   the linearised equations
//   series         Taylor coefficients
#include <ctype.h>
#include <string.h>

#include "worked/worked_impl.h"

// operators of a formula up to which a detail is worth its line
static const long longest_detail = 90;

static const char* name_of(pl_analysis* d, pl_symbol s) { return pl_symbol_get(d->pool, s)->name; }

// The velocity as it is displayed; its symbol bears the bare name of the coordinate.
static const char* velocity_name(pl_analysis* d, const pl_variable* c) {
  return pl_format(d->arena, "%s'", name_of(d, c->q));
}

static const pl_form* zero_form(pl_analysis* d) {
  return pl_form_leaf(d->arena, pl_int(d->pool, 0));
}

// A sentence with L and E as the solution calls them: the letters of the textbook unless the model
// declares them.
static const char* lettered(pl_analysis* d, const char* s) {
  pl_text t = pl_text_make(d->arena);
  for (const char* at = s; *at; at++) {
    bool stands_alone = (at == s || !isalpha((unsigned char)at[-1]))
                        && !isalpha((unsigned char)at[1]) && !((unsigned char)at[1] & 0x80);
    if (*at == 'L' && stands_alone) pl_text_add(&t, pl_letter(d, "L"));
    else if (strncmp(at, "dE/dt", 5) == 0) {
      pl_text_addf(&t, "d%s/dt", pl_letter(d, "E"));
      at += 4;
    } else pl_text_add_n(&t, at, 1);
  }
  return pl_text_string(&t);
}

static void say(pl_analysis* d, const char* en, const char* de) {
  pl_say(d, lettered(d, en), lettered(d, de), 0)->detail = true;
}

// name = e, certified against the reference; nothing where it would be too long to help.
static pl_step* show(pl_analysis* d, const char* name, pl_expr e, pl_expr reference,
                     bool on_motion) {
  if (pl_is_poison(e) || pl_op_count(d->pool, e) > longest_detail) return NULL;
  const pl_form* form = pl_fe(d, e);
  pl_step* step = pl_show(d, pl_feq(d, pl_fn(d, name), form));
  step->detail = true;
  if (on_motion) {
    pl_claim_that(d, PL_CLAIM_OTHER, pl_form_value(d->pool, form), reference);
  } else {
    pl_claim_free(d, PL_CLAIM_OTHER, pl_form_value(d->pool, form), reference);
  }
  return step;
}

// The shorter of e and its normal form.
static pl_expr tidy(pl_analysis* d, pl_expr e) {
  if (pl_op_count(d->pool, e) > 4 * longest_detail) return e;
  pl_expr normal = pl_alg_normal(d->tower, e);
  return pl_is_poison(normal) || pl_op_count(d->pool, normal) > pl_op_count(d->pool, e) ? e
                                                                                        : normal;
}

static void show_tidy(pl_analysis* d, const char* name, pl_expr e) {
  show(d, name, tidy(d, e), e, false);
}

static bool told(pl_analysis* d, const char* what) {
  uint64_t key = pl_hash_bytes(what, strlen(what), 0);
  bool before = pl_map_get(d->page->told, key) != 0;
  pl_map_set(d->page->told, key, 1);
  return before;
}

// -------------------------------------------------------------------------------------- first kind
void pl_why_first_kind(pl_analysis* d, int i) {
  const pl_variable* c = &d->q.at[i];
  if (!told(d, "why dalembert")) {
    say(d,
        PL_BOTH(
            "Why: d'Alembert. In a displacement δx that the constraints allow, applied forces and "
            "inertia do no work together: "
            "Σ (d/dt ∂L/∂x' - ∂L/∂x - Q) δx = 0 for all δx with Σ ∂g/∂x δx = 0. With a factor λ "
            "for "
            "each constraint every coordinate may be "
            "varied by itself: d/dt ∂L/∂x' - ∂L/∂x - Q = Σ λ ∂g/∂x."));
  }
  const char *x = name_of(d, c->q), *v = velocity_name(d, c);
  pl_expr p = pl_diff(d->pool, d->L, c->v), slope = pl_diff(d->pool, d->L, c->q);
  show_tidy(d, pl_format(d->arena, "∂%s/∂%s", pl_letter(d, "L"), v), p);
  show_tidy(d, pl_format(d->arena, "d/dt ∂%s/∂%s", pl_letter(d, "L"), v), pl_dt(d->pool, p));
  show_tidy(d, pl_format(d->arena, "∂%s/∂%s", pl_letter(d, "L"), x), slope);
  if (!pl_is_zero_node(d->pool, d->force[i]))
    show_tidy(d, pl_format(d->arena, "Q_%s", x), d->force[i]);
  for (int k = 0; k < d->g.n; k++) {
    const pl_bond* l = &d->g.at[k];
    if (l->implied || pl_is_zero_node(d->pool, l->push[i])) continue;
    const char* sign = d->model->lambda_minus ? "-" : "";
    show_tidy(d, pl_format(d->arena, "%s∂%s/∂%s", sign, l->source->name.text, l->velocity ? v : x),
              l->push[i]);
  }
}

// --------------------------------------------------------------------- constraints and multipliers
void pl_why_differentiated(pl_analysis* d, int k) {
  const pl_bond* l = &d->g.at[k];
  if (l->velocity) return;
  pl_expr once = pl_on_fixed(d, pl_dt(d->pool, l->g));
  pl_expr shown = tidy(d, once);
  if (pl_op_count(d->pool, shown) > longest_detail) return;
  say(d, PL_BOTH("Why: the constraint holds at all times, so its time derivative vanishes too; by "
                 "the chain "
                 "rule"));
  const pl_form* form = pl_fe(d, shown);
  pl_show(d, pl_feq(d, pl_fn(d, pl_format(d->arena, "d%s/dt", l->source->name.text)),
                    pl_feq(d, form, zero_form(d))))
      ->detail = true;
  pl_claim_free(d, PL_CLAIM_OTHER, pl_form_value(d->pool, form), once);
}

// inserted: the differentiated constraint with the accelerations inserted, linear in the
// multipliers.
void pl_why_multiplier(pl_analysis* d, int k, pl_expr inserted) {
  const pl_bond* l = &d->g.at[k];
  int others = 0;
  pl_replace* zero = PL_ARRAY(d->arena, pl_replace, d->g.n);
  for (int j = 0; j < d->g.n; j++) {
    zero[j] = (pl_replace){d->g.at[j].lambda, pl_int(d->pool, 0)};
    others += j != k && pl_has_symbol(d->pool, inserted, d->g.at[j].lambda);
  }
  if (others > 0) {
    pl_say(
        d,
        PL_BOTH("Why: each constraint gives an equation like this one, linear in the multipliers; "
                "together they determine {1}."),
        1, pl_fs(d, l->lambda))
        ->detail = true;
    return;
  }
  pl_expr factor = tidy(d, pl_diff(d->pool, inserted, l->lambda)),
          rest = tidy(d, pl_subst(d->pool, inserted, zero, d->g.n));
  pl_expr quotient = pl_div(d->pool, pl_neg(d->pool, rest), factor);
  if (pl_op_count(d->pool, quotient) > longest_detail) return;
  pl_say(d,
         PL_BOTH("Why: linear in {1}. What is free of it goes to the right, then both sides are "
                 "divided by "
                 "{2}:"),
         2, pl_fs(d, l->lambda), pl_fe(d, factor))
      ->detail = true;
  show(d, name_of(d, l->lambda), quotient, pl_sym(d->pool, l->lambda), true);
}

// ------------------------------------------------------------------------------------------ frames
static const pl_form* along_axes(pl_analysis* d, const pl_particle* k, const pl_expr* component) {
  const pl_form** part = PL_ARRAY(d->arena, const pl_form*, k->n);
  const char** unit = PL_ARRAY(d->arena, const char*, k->n);
  int n = 0;
  for (int c = 0; c < k->n; c++) {
    if (pl_is_zero_node(d->pool, component[c])) continue;
    part[n] = pl_fe(d, component[c]);
    unit[n++] = pl_format(d->arena, "e_%s", d->model->axes[c].name);
  }
  return n == 0 ? zero_form(d) : pl_form_vector(d->arena, part, unit, n);
}

static bool short_enough(pl_analysis* d, const pl_expr* e, int n) {
  long sum = 0;
  for (int c = 0; c < n; c++) sum += pl_op_count(d->pool, e[c]);
  return sum <= 2 * longest_detail;
}

static void show_vector(pl_analysis* d, const char* name, const pl_particle* k,
                        const pl_expr* component) {
  if (short_enough(d, component, k->n))
    pl_show(d, pl_feq(d, pl_fn(d, name), along_axes(d, k, component)))->detail = true;
}

void pl_why_frame(pl_analysis* d, const pl_particle* k, const pl_frame* f) {
  say(d, PL_BOTH("Why: the unit vectors point along the curves on which one coordinate changes, "
                 "e_i = ∂X/∂q_i "
                 "/ |∂X/∂q_i|; they turn with the "
                 "motion, which gives the terms with products of velocities:"));
  pl_expr component[3];
  show_vector(d, "X", k, k->at);
  for (int j = 0; j < f->n; j++) {
    for (int c = 0; c < k->n; c++) {
      pl_expr slope = pl_div(d->pool, pl_diff(d->pool, k->at[c], d->q.at[f->coordinate[j]].q),
                             f->scale[j]);
      component[c] = tidy(d, slope);
      pl_claim_free(d, PL_CLAIM_OTHER, component[c], slope);
    }
    show_vector(d, pl_unit_vector(d, f->coordinate[j]), k, component);
  }
  for (int c = 0; c < k->n; c++) component[c] = tidy(d, pl_dt(d->pool, pl_dt(d->pool, k->at[c])));
  for (int c = 0; c < k->n; c++)
    pl_claim_that(d, PL_CLAIM_OTHER, component[c], pl_dt(d->pool, pl_dt(d->pool, k->at[c])));
  show_vector(d, "X''", k, component);
  say(d,
      PL_BOTH("The components of X'' along the unit vectors are its scalar products with them:"));
}

// ------------------------------------------------------------------------------------- second kind
void pl_why_second_kind(pl_analysis* d, int i) {
  const pl_variable* c = &d->q.at[i];
  const char *x = name_of(d, c->q), *v = velocity_name(d, c);
  pl_expr p = pl_diff(d->pool, d->Lg, c->v), slope = pl_by_coordinate(d, d->Lg, i),
          rate = pl_on_maps(d, pl_dt(d->pool, p));
  pl_expr rest = tidy(d, pl_sub(d->pool, pl_sub(d->pool, rate, slope), pl_second_kind(d, i)));
  if (pl_op_count(d->pool, tidy(d, p)) > longest_detail) return;
  say(d, PL_BOTH("Why: momentum, its time derivative, and the slope of L:"));
  show_tidy(d, pl_format(d->arena, "∂%s/∂%s", pl_letter(d, "L"), v), p);
  show_tidy(d, pl_format(d->arena, "d/dt ∂%s/∂%s", pl_letter(d, "L"), v), rate);
  show_tidy(d, pl_format(d->arena, "∂%s/∂%s", pl_letter(d, "L"), x), slope);
  if (!pl_is_zero_node(d->pool, rest)) show_tidy(d, pl_format(d->arena, "Q_%s", x), rest);
  pl_say(
      d,
      PL_BOTH(pl_is_zero_node(d->pool, rest)
                  ? "Their difference vanishes; common factors are left out:"
                  : "The derivative less the slope and {1} vanishes; common factors are left out:"),
      1, pl_fn(d, pl_format(d->arena, "Q_%s", x)))
      ->detail = true;
}

// --------------------------------------------------------------------------------------- conserved
// dE/dt = sum q' (d/dt dL/dq' - dL/dq) - dL/dt, an identity; the brackets are Lagrange's equations.
void pl_why_energy(pl_analysis* d, pl_expr E) {
  if (!d->reduced || pl_nonholonomic(d)) return;
  pl_expr sum = pl_int(d->pool, 0);
  for (int k = 0; k < d->gen.n; k++) {
    int i = d->gen.at[k];
    sum = pl_add(d->pool, sum,
                 pl_mul(d->pool, pl_sym(d->pool, d->q.at[i].v), tidy(d, pl_second_kind(d, i))));
  }
  if (pl_op_count(d->pool, sum) > longest_detail) return;
  say(d, PL_BOTH("Why: dE/dt = Σ q' (d/dt ∂L/∂q' - ∂L/∂q) - ∂L/∂t, and ∂L/∂t = 0. The brackets are "
                 "Lagrange's "
                 "equations, which vanish on the motion:"));
  show(d, pl_format(d->arena, "d%s/dt", pl_letter(d, "E")), sum, pl_on_maps(d, pl_dt(d->pool, E)),
       false);
}

void pl_why_cyclic(pl_analysis* d, int i) {
  const pl_variable* c = &d->q.at[i];
  pl_say(
      d,
      lettered(d,
               "Why: {1} may be shifted, {1} → {1} + ε, without a change of L; to each such "
               "symmetry belongs a conserved quantity (Noether). Here "
               "Lagrange's equation of {1} is the time derivative of the momentum alone, since"),
      lettered(
          d, pl_german(
                 "Why: {1} may be shifted, {1} → {1} + ε, without a change of L; to each such "
                 "symmetry belongs a conserved quantity (Noether). Here "
                 "Lagrange's equation of {1} is the time derivative of the momentum alone, since")),
      1, pl_fs(d, c->q))
      ->detail = true;
  show(d, pl_format(d->arena, "∂%s/∂%s", pl_letter(d, "L"), name_of(d, c->q)), pl_int(d->pool, 0),
       pl_by_coordinate(d, d->Lg, i), false);
}

// ------------------------------------------------------------------------------------- integration
void pl_why_uniform(pl_analysis* d, int i, pl_expr x) {
  const pl_variable* c = &d->q.at[i];
  say(d, PL_BOTH("Why: the acceleration is constant. Integrated once:"));
  pl_expr v = pl_diff(d->pool, x, pl_time(d->pool));
  show(d, pl_format(d->arena, "%s(t)", velocity_name(d, c)), tidy(d, v), v, false);
}

// x'' = A + B x + C x'.
void pl_why_linear(pl_analysis* d, int i, pl_expr A, pl_expr B, pl_expr C) {
  pl_pool* p = d->pool;
  pl_symbol_info info = {.name = "s",
                         .ascii = "exponent_s",
                         .role = PL_R_LOCAL,
                         .class = PL_C_OTHER,
                         .dimension = pl_dimension_of(0, 0, -1),
                         .dimension_known = true};
  pl_expr s = pl_sym(p, pl_symbol_make(p, &info)), x = pl_sym(p, d->q.at[i].q);
  pl_expr characteristic = pl_sub(p, pl_square(p, s), pl_add(p, pl_mul(p, C, s), B));
  if (pl_op_count(p, characteristic) > longest_detail) return;
  if (!pl_is_zero_node(p, B) && !pl_is_zero_node(p, A)) {
    pl_expr rest = tidy(d, pl_neg(p, pl_div(p, A, B)));
    pl_say(d, PL_BOTH("Why: measured from the position of rest {1} the equation is homogeneous."),
           1, pl_feq(d, pl_fe(d, x), pl_fe(d, rest)))
        ->detail = true;
    pl_claim_free(d, PL_CLAIM_OTHER, pl_add(p, A, pl_mul(p, B, rest)), pl_int(p, 0));
  }
  pl_say(
      d,
      PL_BOTH("Why: the attempt e^(s t) solves it when {1}; two solutions, fitted to position and "
              "velocity at t = 0:"),
      1, pl_feq(d, pl_fe(d, characteristic), zero_form(d)))
      ->detail = true;
}

// The Laplace transform of one coordinate and its poles.
static const pl_form* pole_form(pl_analysis* d, const pl_laplace_pole* p) {
  const pl_form* s = pl_fs(d, p->s);
  switch (p->kind) {
    case PL_POLE_REAL: return pl_feq(d, s, pl_f(d, p->value, PL_S_QUOTIENT));
    case PL_POLE_SQUARE:
      return pl_feq(d, pl_form_power(d->arena, s, pl_form_leaf(d->arena, pl_int(d->pool, 2))),
                    pl_f(d, p->value, PL_S_QUOTIENT));
    case PL_POLE_QUADRATIC: break;
  }
  return pl_feq(d, pl_f(d, p->value, PL_S_PLAIN), zero_form(d));
}

void pl_why_linear_motion(pl_analysis* d, int i) {
  pl_laplace_poles poles = {.n = 0};
  pl_expr transform;
  pl_linear_motion(d, i, &poles, &transform);
  if (pl_is_poison(transform)) return;
  const pl_form* pole[PL_MAX_POLES];
  for (int k = 0; k < poles.n; k++) pole[k] = pole_form(d, &poles.at[k]);
  const char* x = name_of(d, d->q.at[i].q);
  say(d, PL_BOTH("Why: the Laplace transform turns the equations with their start into linear ones "
                 "for the "
                 "transforms; solved,"));
  if (pl_op_count(d->pool, transform) <= 2 * longest_detail) {
    pl_show(d,
            pl_feq(d, pl_fn(d, pl_format(d->arena, "%s(s)", x)), pl_f(d, transform, PL_S_QUOTIENT)))
        ->detail = true;
  }
  if (poles.n > 0) {
    pl_say(
        d,
        PL_BOTH(
            "Its denominator vanishes at {1}. Partial fractions: 1/(s² + ω²) is the transform of "
            "sin(ω t)/ω, s/(s² + ω²) that of cos(ω t), "
            "1/s² that of t."),
        1, pl_flist(d, pole, poles.n))
        ->detail = true;
  }
}

// ------------------------------------------------------------------------------------ oscillations
void pl_why_oscillations(pl_analysis* d, const pl_expr* M, const pl_expr* K, int n) {
  say(d, PL_BOTH("Why: with q = q0 + δ the equations to first order in δ are M δ'' + K δ = 0, M "
                 "and K at the "
                 "position of rest:"));
  for (int r = 0; r < n; r++) {
    const pl_form** term = PL_ARRAY(d->arena, const pl_form*, 2 * n + 1);
    int m = 0;
    for (int part = 0; part < 2; part++) {
      for (int c = 0; c < n; c++) {
        pl_expr e = tidy(d, part ? K[r * n + c] : M[r * n + c]);
        if (pl_is_zero_node(d->pool, e)) continue;
        const char* x = name_of(d, d->q.at[d->gen.at[c]].q);
        const char* delta = n == 1 ? (part ? "δ" : "δ''")
                                   : pl_format(d->arena, part ? "δ%s" : "δ%s''", x);
        const pl_form* factor[2] = {pl_f(d, e, PL_S_QUOTIENT), pl_fn(d, delta)};
        bool negative = factor[0]->kind == PL_F_NEG;
        if (negative) factor[0] = factor[0]->args[0];
        const pl_form* product = pl_is_one_node(d->pool, e) ? factor[1]
                                                            : pl_form_product(d->arena, factor, 2);
        term[m++] = negative ? pl_form_neg(d->arena, product) : product;
      }
    }
    if (m == 0) continue;
    pl_show(d, pl_feq(d, m == 1 ? term[0] : pl_form_sum(d->arena, term, m), zero_form(d)))->detail =
        true;
  }
  say(d, PL_BOTH("δ = u cos(ω t) solves them when det(K - ω² M) = 0:"));
}

// ------------------------------------------------------------------------------------------ series
// f = sum c_k x^(lead + k), x = variable - to: c_k = h^(k)(to)/k! of h = x^-lead f.
void pl_why_series(pl_analysis* d, pl_expr f, pl_symbol variable, pl_expr to, int lead,
                   const pl_expr* c, int n) {
  pl_expr x = pl_sub(d->pool, pl_sym(d->pool, variable), to);
  pl_expr h = lead == 0
                  ? f
                  : pl_alg_normal(d->tower, pl_mul(d->pool, f, pl_pow_int(d->pool, x, -lead)));
  if (pl_is_poison(h) || pl_op_count(d->pool, h) > longest_detail) return;
  const char* v = name_of(d, variable);
  if (lead == 0) {
    say(d,
        PL_BOTH(
            "Why: Taylor's formula, the coefficients are derivatives at the point of expansion:"));
  } else {
    pl_say(
        d,
        PL_BOTH_FORMAT(
            d->arena, "Why: the first power is {1}^%d; with it taken out, Taylor's formula:", lead),
        1, pl_fe(d, x))
        ->detail = true;
  }
  show(d, pl_format(d->arena, "f(%s)", v), h, h, false);
  pl_expr derivative = h, factor = pl_int(d->pool, 1);
  for (int k = 0; k < n && k < 3; k++) {
    static const char* const prime[] = {"", "'", "''"};
    const char* at = pl_expr_text(d->arena, d->pool, to);
    pl_expr value = pl_mul(d->pool, c[k], factor),
            there = pl_subst1(d->pool, derivative, variable, to);
    if (pl_is_poison(there)) return;  // 0/0 before it is reduced
    show(d, pl_format(d->arena, "f%s(%s)", prime[k], at), value, there, false);
    derivative = pl_diff(d->pool, derivative, variable);
    factor = pl_mul(d->pool, factor, pl_int(d->pool, k + 1));
  }
}
