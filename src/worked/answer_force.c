// answer_force: the force of a constraint on each mass, Z = λ ∇g, along the axes or along the frame
// of the mass, and along a given motion with the velocity eliminated by the energy.
// See theory (3.1), (3.2).
#include <math.h>
#include <string.h>

#include "worked/worked_impl.h"

static int find_link(const pl_analysis* d, const char* label) {
  for (int k = 0; k < d->g.n; k++) {
    const pl_name* name = &d->g.at[k].source->name;
    if (label && (strcmp(name->text, label) == 0 || strcmp(name->ascii, label) == 0)) return k;
  }
  return -1;
}

static int find_particle(const pl_analysis* d, const char* label) {
  for (int k = 0; k < d->particle.n; k++) {
    const pl_particle* m = &d->particle.at[k];
    if (label && (strcmp(m->label, label) == 0 || strcmp(m->ascii, label) == 0)) return k;
  }
  return -1;
}

// A product that ends in a fraction reads wrongly in front of a unit vector.
static const pl_form* bracketed(pl_analysis* d, const pl_form* f) {
  bool fraction = f->kind == PL_F_QUOTIENT && pl_form_ops(f->args[1]) == 0;
  for (int k = 0; f->kind == PL_F_PRODUCT && k < f->n; k++)
    fraction |= f->args[k]->kind == PL_F_QUOTIENT;
  return fraction ? pl_form_make(d->arena, PL_F_GROUP, 1, &f) : f;
}

static const pl_form* vector_of(pl_analysis* d, const pl_force* f, const pl_expr* component,
                                pl_style style) {
  const pl_form* part[3];
  for (int j = 0; j < f->n; j++) part[j] = bracketed(d, pl_f(d, component[j], style));
  return pl_form_vector(d->arena, part, f->along, f->n);
}

// ------------------------------------------------------------------------------------ λ on the way
// What λ is worth for this request: on the motion, with the velocity eliminated when a motion is
// named.
typedef struct pl_lambda_value {
  pl_expr value;
  int number;
  bool eliminated;
  pl_expr holds_while;
} pl_lambda_value;

static const pl_form* at_start(pl_analysis* d, const pl_variable* c, pl_expr q0, pl_expr v0) {
  const pl_form* f[2] = {pl_feq(d, pl_fs(d, c->q), pl_fe(d, q0)),
                         pl_feq(d, pl_fs(d, c->v), pl_fe(d, v0))};
  return pl_flist(d, f, 2);
}

// The energy equation and q'^2 from it; returns the number of the latter.
static int show_elimination(pl_analysis* d, pl_expr v2, pl_expr q0, pl_expr v0) {
  const pl_variable* c = &d->q.at[d->gen.at[0]];
  pl_expr E = pl_conserved_energy(d);
  pl_replace start[2] = {{c->q, q0}, {c->v, v0}};
  pl_expr E0 = pl_alg_normal(d->tower, pl_subst(d->pool, E, start, 2));
  pl_say(d, PL_BOTH("The energy is conserved; from {1}:"), 1, at_start(d, c, q0, v0));
  pl_show(d, pl_feq(d, pl_f(d, E, PL_S_ENERGY), pl_f(d, E0, PL_S_ENERGY)));
  const pl_form* square = pl_form_power(d->arena, pl_fs(d, c->v),
                                        pl_form_leaf(d->arena, pl_int(d->pool, 2)));
  const pl_form* form = pl_f(d, v2, PL_S_QUOTIENT);
  pl_step* step = pl_show_numbered(d, pl_feq(d, square, form));
  pl_expr back = pl_subst1(d->pool, pl_sub(d->pool, E, E0), c->v,
                           pl_sqrt(d->pool, pl_form_value(d->pool, form)));
  pl_claim_free(d, PL_CLAIM_INSERTED, back, pl_int(d->pool, 0));
  pl_value* v = pl_answer(d, pl_format(d->arena, "%s^2", pl_symbol_get(d->pool, c->v)->ascii), v2,
                          form);
  v->lhs = pl_square(d->pool, pl_sym(d->pool, c->v));
  return step->number;
}

// Several freedoms: the momenta that stay give the other velocities.
static int show_line(pl_analysis* d, const pl_line* l) {
  const pl_variable* c = &d->q.at[l->i];
  const pl_form* square = pl_form_power(d->arena, pl_fs(d, c->v),
                                        pl_form_leaf(d->arena, pl_int(d->pool, 2)));
  if (l->drag) {
    pl_say(
        d,
        PL_BOTH("{1} contains {2} only as its square, which follows from d({3})/d{4} = 2 {1}, an "
                "equation linear in {3}:"),
        4, pl_fs(d, c->a), pl_fs(d, c->v), square, pl_fs(d, c->q));
  } else {
    pl_say(
        d,
        PL_BOTH("The energy and the momenta of cyclic coordinates are conserved; from this start:"),
        0);
    for (int k = 0; k < l->n; k++) {
      pl_show(d, pl_feq(d, pl_f(d, l->momentum[k], PL_S_ENERGY),
                        pl_f(d, l->momentum0[k], PL_S_ENERGY)));
    }
  }
  return pl_show_numbered(d, pl_feq(d, square, pl_f(d, l->v2, PL_S_QUOTIENT)))->number;
}

static void show_differentiated(pl_analysis* d, int k) {
  const pl_bond* l = &d->g.at[k];
  const char* g = l->source->name.text;
  if (l->fixes >= 0) {
    const pl_variable* c = &d->q.at[l->fixes];
    const pl_form* f[2] = {
        pl_feq(d, pl_fn(d, pl_format(d->arena, "%s'", g)),
               pl_feq(d, pl_fs(d, c->v), pl_fe(d, pl_dt(d->pool, c->fixed)))),
        pl_feq(d, pl_fn(d, pl_format(d->arena, "%s''", g)),
               pl_feq(d, pl_fs(d, c->a), pl_fe(d, pl_dt(d->pool, pl_dt(d->pool, c->fixed)))))};
    pl_show(d, pl_flist(d, f, 2));
    int row = d->page->number_lagrange1 > 0 ? d->page->number_lagrange1 : 0;
    if (row) pl_say(d, PL_BOTH("inserted into the equation of {1}:"), 1, pl_fs(d, c->q));
  }
}

// above it a multiplier is shown by its row, components in λ; values keep the closed form
static const long closed_ops = 60;

static pl_step* show_lambda_for(pl_analysis* d, int k, bool moves) {
  pl_bond* l = &d->g.at[k];
  const pl_form* form = pl_f(d, l->lambda_value, moves ? PL_S_EQUATION : PL_S_QUOTIENT);
  int i = -1;
  if (pl_form_ops(form) > closed_ops) {
    pl_expr row = pl_multiplier_by_row(d, k, &i);
    if (!pl_is_poison(row)) form = pl_f(d, row, PL_S_QUOTIENT);
  }
  form = pl_positive_first(d, form);
  if (i >= 0) pl_say(d, PL_BOTH("From the equation of {1}:"), 1, pl_fs(d, d->q.at[i].q));
  pl_step* step = pl_show_numbered(d, pl_feq(d, pl_fs(d, l->lambda), form));
  pl_claim_that(d, PL_CLAIM_MOTION, pl_form_value(d->pool, form), pl_sym(d->pool, l->lambda));
  pl_claim_that(d, PL_CLAIM_MOTION, l->lambda_value, pl_sym(d->pool, l->lambda));
  return step;
}

static pl_lambda_value lambda_for(pl_analysis* d, int k, const pl_motion* motion, bool show) {
  pl_bond* l = &d->g.at[k];
  pl_lambda_value out = {.value = l->lambda_value};
  bool moves = d->gen.n == 1 && pl_has_symbol(d->pool, l->lambda_value, d->q.at[d->gen.at[0]].v);
  if (show && (!d->page->lambda_number[k] || moves)) {
    show_differentiated(d, k);
    pl_step* step = show_lambda_for(d, k, moves);
    for (int r = 0; r < d->page->lagrange1_numbers.n; r++)
      pl_step_refs(step, 1, d->page->lagrange1_numbers.at[r]);
    bool known;
    pl_step_value(d, step, l->lambda_value, pl_dimension_of_expr(d, l->lambda_value, &known));
    d->page->lambda_number[k] = out.number = step->number;
  }
  if (!motion->given || !pl_has_role(d->pool, l->lambda_value, PL_R_VELOCITY)) return out;
  pl_line line;
  if (!pl_line_from(d, motion, &line)) {
    if (show) pl_say_from_unused(d);
    return out;
  }
  if (show) {
    bool alone = d->gen.n == 1 && !line.drag;
    int number = alone ? show_elimination(d, line.v2, line.q0, line.v0) : show_line(d, &line);
    if (out.number)
      pl_say(d, PL_BOTH("{1} inserted into {2}:"), 2, pl_fref(d, number), pl_fref(d, out.number));
  }
  out.value = pl_along_line(d, &line, l->lambda_value);
  out.eliminated = true;
  if (show) out.holds_while = pl_say_way(d, &line, l->lambda_value);
  pl_expr root = pl_mul(d->pool, pl_int(d->pool, line.direction), pl_sqrt(d->pool, line.v2));
  pl_expr inserted = pl_subst(d->pool, l->lambda_value, line.velocity, line.n);
  pl_claim_free(d, PL_CLAIM_INSERTED, out.value,
                pl_subst1(d->pool, inserted, d->q.at[line.i].v, root));
  return out;
}

// ---------------------------------------------------------------------------------------- one mass
static void answer_components(pl_analysis* d, const char* of, const char* on, const pl_force* f,
                              const pl_expr* value) {
  pl_value v = {.name = "Z",
                .of = of,
                .on = on,
                .number = (double)NAN,
                .conserved = -1,
                .passed = -1,
                .order = -1};
  v.n_components = f->n;
  v.components = PL_ARRAY(d->arena, pl_component, f->n);
  bool known = true;
  for (int j = 0; j < f->n; j++) {
    const pl_form* form = pl_f(d, value[j], PL_S_QUOTIENT);
    v.components[j] = (pl_component){f->along[j], pl_as_shown(d, value[j], form), form,
                                     pl_number(d, value[j])};
    pl_dimension dim = pl_dimension_of_expr(d, value[j], &known);
    if (known) v.unit = pl_dimension_unit(d->arena, dim, true);
  }
  pl_structure_where(d, &v);
  pl_push(d->arena, d->page->section->values, v);
}

// A multiplier that is too long to be written out stays a name; the system that determines it is
// shown.
static const long longest_written = 4000;  // operations of its normal form

static bool lambda_over_names(pl_analysis* d, int k, pl_lambda_value* out) {
  const pl_bond* l = &d->g.at[k];
  if (l->lambda_known && pl_op_count(d->pool, l->lambda_value) <= longest_written) return false;
  if (!pl_show_structured(d, l->lambda, l->lambda_known ? l->lambda_value : pl_poison()))
    return false;
  *out = (pl_lambda_value){.value = pl_sym(d->pool, l->lambda),
                           .number = d->page->solution->n_equations};
  return true;
}

// On which mass, and how much of the force this is.
static void say_on(pl_analysis* d, pl_step* step, const char* label, const pl_force* f,
                   bool only_one) {
  const char* en = pl_format(d->arena, "on %s", label);
  const char* de = pl_format(d->arena, pl_german("on %s"), label);
  if (f->reaction_to >= 0) {
    const char* other = d->particle.at[f->reaction_to].label;
    en = pl_format(d->arena, "on %s, the reaction to the force on %s", label, other);
    de = pl_format(d->arena, pl_german("on %s, the reaction to the force on %s"), label, other);
  } else if (!f->whole) {
    en = pl_format(d->arena, "on %s, in the directions in which it can move", label);
    de = pl_format(d->arena, pl_german("on %s, in the directions in which it can move"), label);
  } else if (only_one) {
    return;
  }
  pl_step_after(step, en, de);
}

static void show_on(pl_analysis* d, int k, int particle, const pl_force* f,
                    const pl_lambda_value* lambda, bool only_one) {
  pl_expr with_name[3], value[3];
  long ops = 0;
  for (int j = 0; j < f->n; j++) {
    with_name[j] = pl_mul(d->pool, pl_sym(d->pool, d->g.at[k].lambda), f->factor[j]);
    value[j] = pl_alg_normal(d->tower, pl_mul(d->pool, lambda->value, pl_on_maps(d, f->factor[j])));
    ops += pl_form_ops(pl_f(d, value[j], PL_S_QUOTIENT));
  }
  const char* label = d->particle.at[particle].label;
  const pl_form* Z = pl_fn(d, only_one ? pl_letter(d, "Z") : pl_format(d->arena, "Z_%s", label));
  const pl_form* named = vector_of(d, f, with_name, PL_S_PLAIN);
  bool stays = pl_same(lambda->value, pl_sym(d->pool, d->g.at[k].lambda));
  const pl_form* closed = !stays && ops <= closed_ops ? vector_of(d, f, value, PL_S_QUOTIENT)
                                                      : NULL;
  pl_step* step = pl_show_numbered(d, pl_feq(d, Z, closed ? pl_feq(d, named, closed) : named));
  pl_step_refs(step, 1, lambda->number > 0 ? lambda->number : d->page->lambda_number[k]);
  say_on(d, step, label, f, only_one);
  if (f->n == 1) {
    bool known;
    pl_step_value(d, step, value[0], pl_dimension_of_expr(d, value[0], &known));
  }
  for (int j = 0; j < f->n && !lambda->eliminated; j++)
    pl_claim_that(d, PL_CLAIM_MOTION, value[j], with_name[j]);
  answer_components(d, d->g.at[k].source->name.text, label, f, value);
}

// ----------------------------------------------------------------------------------------- remarks
// Compared with the motion without constraint forces: a constant factor below one is worth a
// sentence.
static void compare_with_free_fall(pl_analysis* d, int i) {
  pl_expr M = pl_diff(d->pool, d->euler[i], d->q.at[i].a);
  pl_replace* zero = PL_ARRAY(d->arena, pl_replace, d->q.n);
  for (int j = 0; j < d->q.n; j++) zero[j] = (pl_replace){d->q.at[j].a, pl_int(d->pool, 0)};
  pl_expr free_fall = pl_neg(d->pool,
                             pl_div(d->pool, pl_subst(d->pool, d->euler[i], zero, d->q.n), M));
  free_fall = pl_alg_normal(d->tower, pl_on_maps(d, free_fall));
  if (pl_is_poison(d->acceleration[i]) || pl_is_zero_node(d->pool, free_fall)
      || pl_has_coordinates(d, free_fall))
    return;
  pl_expr ratio = pl_alg_normal(d->tower, pl_div(d->pool, d->acceleration[i], free_fall));
  if (pl_is_poison(ratio) || pl_has_coordinates(d, ratio) || pl_is_number(d->pool, ratio)) return;
  const pl_form* form = pl_f(d, ratio, PL_S_QUOTIENT);
  if (pl_form_ops(form) > 12) return;
  // slowed only where the factor is known to lie between 0 and 1: it may be negative
  const pl_form* fall = pl_f(d, free_fall, PL_S_QUOTIENT);
  double x = pl_number(d, ratio);
  if (x > 0 && x < 1) {
    pl_say(d, PL_BOTH("Slowed free fall: the acceleration is {2} times {1}."), 2, fall, form);
  } else {
    pl_say(d, PL_BOTH("Compared with free fall, {1}, the acceleration is {2} times as large."), 2,
           pl_feq(d, pl_fs(d, d->q.at[i].a), fall), form);
  }
  pl_claim_that(d, PL_CLAIM_MOTION, pl_mul(d->pool, pl_form_value(d->pool, form), free_fall),
                pl_sym(d->pool, d->q.at[i].a));
}

static void say_equilibrium_start(pl_analysis* d, const pl_motion* motion, int k) {
  pl_expr v2, q0, v0;
  if (!motion->given || !pl_velocity_squared(d, motion, &v2, &q0, &v0)) return;
  if (pl_starts_in_equilibrium(d, q0, v0) != PL_YES) return;
  const pl_variable* c = &d->q.at[d->gen.at[0]];
  pl_motion init = {0};
  pl_expr from_init = pl_poison();
  if (pl_velocity_squared(d, &init, &v2, &q0, &v0))
    from_init = pl_without_velocity(d, d->g.at[k].lambda_value, v2);
  const pl_form* there = pl_feq(d, pl_fs(d, c->q), pl_fe(d, motion->from[0].right));
  pl_step* s = pl_say(
      d,
      PL_BOTH("{1} at rest is an equilibrium: the exact motion never leaves it. The result "
              "is the limit of starts close to it."),
      1, there);
  s->kind = PL_STEP_NOTE;
  if (pl_is_poison(from_init)) return;
  const pl_form* value = pl_feq(d, pl_fs(d, d->g.at[k].lambda), pl_f(d, from_init, PL_S_QUOTIENT));
  s = pl_say(d, PL_BOTH("From a start as in init: {1}."), 1, value);
  s->kind = PL_STEP_NOTE;
}

// ---------------------------------------------------------------------------------------- sections
static void not_attributable(pl_analysis* d, int k) {
  pl_say(
      d,
      PL_BOTH(
          "{1} acts on coordinates that several masses share; its generalized force is λ times:"),
      1, pl_fn(d, d->g.at[k].source->name.text));
  for (int i = 0; i < d->q.n; i++) {
    pl_expr g = pl_alg_normal(d->tower, pl_on_fixed(d, d->g.at[k].gradient[i]));
    if (pl_is_zero_node(d->pool, g)) continue;
    pl_step* s = pl_show(d, pl_f(d, g, PL_S_PLAIN));
    const char* name = pl_symbol_get(d->pool, d->q.at[i].q)->name;
    pl_step_after(s, PL_BOTH_FORMAT(d->arena, "along %s", name));
  }
}

static void answer_lambda(pl_analysis* d, int k, const pl_lambda_value* lambda) {
  pl_value* v = pl_answer(d, pl_symbol_get(d->pool, d->g.at[k].lambda)->ascii, lambda->value,
                          pl_f(d, lambda->value, PL_S_QUOTIENT));
  v->of = d->g.at[k].source->name.text;
  v->holds_while = lambda->holds_while;
}

static void force_of(pl_analysis* d, const pl_ask* ask, int k) {
  const char* label = d->g.at[k].source->name.text;
  pl_section_open(d, ask, PL_BOTH_FORMAT(d->arena, "Force of %s", label));
  if (pl_say_shared(d, k)) return;
  pl_lambda_value lambda;
  bool stays = lambda_over_names(d, k, &lambda);
  if (!stays && !d->g.at[k].lambda_known) {
    pl_say(d, PL_BOTH("The multiplier of {1} is not determined in closed form."), 1,
           pl_fn(d, label));
    d->page->section->not_found = true;
    return;
  }
  if (!stays) lambda = lambda_for(d, k, &ask->motion, true);
  int first;
  pl_force* f = PL_ARRAY(d->arena, pl_force, d->particle.n + 1);
  int n = pl_forces_of(d, k, f, &first);
  for (int m = 0; m < d->particle.n; m++) {
    if (f[m].n > 0) show_on(d, k, m, &f[m], &lambda, d->particle.n == 1);
  }
  if (n == 0) not_attributable(d, k);
  if (!stays) answer_lambda(d, k, &lambda);
  if (first >= 0 && d->reduced && d->gen.n == 1) compare_with_free_fall(d, d->gen.at[0]);
  say_equilibrium_start(d, &ask->motion, k);
  pl_note_attribution(d, k);
}

// Constraints that depend on each other: on a mass their forces together may be determined where
// each alone is not.
static int together_on(pl_analysis* d, int m) {
  pl_force sum = {0};
  pl_expr value[3];
  const pl_form** name = PL_ARRAY(d->arena, const pl_form*, d->g.n + 1);
  int n = 0;
  for (int k = 0; k < d->g.n; k++) {
    pl_force f;
    if (!d->g.at[k].shared || !d->g.at[k].lambda_known || !pl_force_on(d, k, m, &f) || f.n == 0)
      continue;
    name[n++] = pl_fn(d, d->g.at[k].source->name.text);
    for (int j = 0; j < f.n; j++) {
      int at = 0;
      while (at < sum.n && strcmp(sum.along[at], f.along[j]) != 0) at++;
      if (at == 3) return 0;  // along the frames of different coordinates
      if (at == sum.n) {
        sum.along[sum.n++] = f.along[j];
        value[at] = pl_int(d->pool, 0);
      }
      value[at] = pl_add(d->pool, value[at],
                         pl_mul(d->pool, d->g.at[k].lambda_value, pl_on_maps(d, f.factor[j])));
    }
  }
  if (n == 0) return 0;
  for (int j = 0; j < sum.n; j++) {
    value[j] = pl_alg_normal(d->tower, value[j]);
    if (!pl_not_determined(d, value[j])) continue;
    pl_say(d, PL_BOTH("The forces of {1} on it are not determined."), 1, pl_flist(d, name, n));
    return n;
  }
  pl_say(d, PL_BOTH("{1} together (each alone is not determined):"), 1, pl_flist(d, name, n));
  pl_show_numbered(d, pl_feq(d, pl_fl(d, "Z"), vector_of(d, &sum, value, PL_S_QUOTIENT)));
  answer_components(d, NULL, d->particle.at[m].label, &sum, value);
  return n;
}

static void force_on_mass(pl_analysis* d, const pl_ask* ask, int m) {
  const char* label = d->particle.at[m].label;
  pl_section_open(d, ask, PL_BOTH_FORMAT(d->arena, "Constraint forces on %s", label));
  int shown = 0;
  for (int k = 0; k < d->g.n; k++) {
    pl_force f;
    if (d->g.at[k].implied || d->g.at[k].shared || !pl_force_on(d, k, m, &f) || f.n == 0) continue;
    shown++;
    pl_lambda_value lambda;
    bool stays = lambda_over_names(d, k, &lambda);
    if (!stays && !d->g.at[k].lambda_known) {
      pl_say(d, PL_BOTH("The multiplier of {1} is not determined in closed form."), 1,
             pl_fn(d, d->g.at[k].source->name.text));
      d->page->section->not_found = true;
      continue;
    }
    if (!stays) lambda = lambda_for(d, k, &ask->motion, false);
    pl_say(d, "{1}:", "{1}:", 1, pl_fn(d, d->g.at[k].source->name.text));
    show_on(d, k, m, &f, &lambda, true);
  }
  shown += together_on(d, m);
  if (shown == 0) {
    pl_say(d,
           PL_BOTH("No constraint of the model acts on {1} alone; what holds it follows from its "
                   "coordinates."),
           1, pl_fn(d, label));
  }
}

void pl_answer_force(pl_analysis* d, const pl_ask* ask) {
  int k = find_link(d, ask->label), m = find_particle(d, ask->label);
  if (ask->kind == PL_ASK_FORCE_OF && k >= 0) {
    force_of(d, ask, k);
  } else if (m >= 0) {
    force_on_mass(d, ask, m);
  } else {
    pl_answer_pending(d, ask);
  }
}
