// answer_equilibria: positions of rest, when they exist, whether they are stable, and the small
// oscillations about them.
//   f_i(q) = 0 with f the equations of the second kind at rest; K = df/dq, M = d2T/dv2; det(K - ω²
//   M) = 0.
// See theory, section 7.
#include <math.h>
#include <string.h>

#include "worked/equilibria_impl.h"

// ----------------------------------------------------------------------------------------- display
// No equation contains a coordinate: every position is one of rest.
static const pl_form* all_free(pl_analysis* d) {
  pl_text words[2] = {pl_text_make(d->arena), pl_text_make(d->arena)};
  for (int k = 0; k < d->gen.n; k++) {
    const char* name = pl_symbol_get(d->pool, d->q.at[d->gen.at[k]].q)->name;
    pl_text_addf(&words[0], "%s%s", k ? ", " : "any ", name);
    pl_text_addf(&words[1], "%s%s", k ? ", " : pl_german("any "), name);
  }
  return pl_form_words(d->arena, pl_text_string(&words[0]), pl_text_string(&words[1]));
}

static const pl_form* in_degrees(pl_analysis* d, double x) {
  pl_notation how = {.math = PL_MATH_LINE, .lang = d->job->lang};
  return pl_fn(d, pl_format(d->arena, "%s°", pl_notation_number(d->arena, x * 180 / M_PI, 6, how)));
}

static const pl_form* value_form(pl_analysis* d, int i, pl_expr value) {
  const pl_form* form = pl_f(d, value, PL_S_PLAIN);
  double x = pl_number(d, value);
  return pl_is_angle(d, i) && !isnan(x) && x != 0 ? pl_feq(d, form, in_degrees(d, x)) : form;
}

static const pl_form* with_unit(pl_analysis* d, const char* number, const char* unit) {
  if (!*unit || strcmp(unit, "1") == 0) return pl_fn(d, number);
  const pl_form* part[2] = {pl_fn(d, number), pl_form_words(d->arena, unit, unit)};
  return pl_form_product(d->arena, part, 2);
}

// A place found in numbers: θ ≈ 2.5957 = 148.723°, or what is exact about it.
static const pl_form* number_form(pl_analysis* d, int i, pl_expr value) {
  double x = pl_number(d, value);
  if (isnan(x)) return pl_feq(d, pl_fs(d, d->q.at[i].q), value_form(d, i, value));
  pl_notation how = {.math = PL_MATH_LINE, .lang = d->job->lang};
  bool known;
  pl_dimension dim = pl_dimension_of_expr(d, pl_sym(d->pool, d->q.at[i].q), &known);
  const char *number = pl_notation_number(d->arena, x, 6, how),
             *unit = known ? pl_dimension_unit(d->arena, dim, false) : "";
  const pl_form* about = with_unit(d, number, unit);
  if (pl_is_angle(d, i) && x != 0) about = pl_feq(d, about, in_degrees(d, x));
  return pl_frel(d, pl_fs(d, d->q.at[i].q), "≈", about);
}

const pl_form* pl_rest_form(pl_analysis* d, const pl_rest* r) {
  const pl_form* f[pl_max_gen];
  int n = 0;
  for (int k = 0; k < d->gen.n; k++) {
    int i = d->gen.at[k];
    if (pl_is_poison(r->q[k])) continue;
    f[n++] = r->numeric && !r->exact[k]
                 ? number_form(d, i, r->q[k])
                 : pl_feq(d, pl_fs(d, d->q.at[i].q), value_form(d, i, r->q[k]));
  }
  if (n == 0) return all_free(d);
  return n == 1 ? f[0] : pl_flist(d, f, n);
}

// The verdicts of the linearisation: a key each.
static const char* german_stability(const char* s) {
  static const char* const verdicts[] = {PL_KEY("stable"), PL_KEY("unstable"),
                                         PL_KEY("indifferent")};
  for (size_t i = 0; i < sizeof verdicts / sizeof *verdicts; i++) {
    if (strcmp(s, verdicts[i]) == 0) return pl_german(verdicts[i]);
  }
  return pl_german(verdicts[2]);
}

// ω² of a place that is known in numbers only.
const pl_form* pl_square_form(pl_analysis* d, pl_expr w2, bool numeric) {
  if (!numeric) return pl_feq(d, pl_fs(d, pl_omega_squared(d)), pl_f(d, w2, PL_S_QUOTIENT));
  pl_notation how = {.math = PL_MATH_LINE, .lang = d->job->lang};
  const char* number = pl_notation_number(d->arena, pl_number(d, w2), 6, how);
  return pl_frel(d, pl_fs(d, pl_omega_squared(d)), "≈", with_unit(d, number, "1/s²"));
}

void pl_tell_place(pl_analysis* d, const pl_rest* r, pl_value* v) {
  if (d->steady.n > 0) return;
  v->place = PL_ARRAY(d->arena, pl_component, d->gen.n + 1);
  for (int k = 0; k < d->gen.n; k++) {
    if (pl_is_poison(r->q[k])) continue;
    const char* name = pl_symbol_get(d->pool, d->q.at[d->gen.at[k]].q)->ascii;
    v->place[v->n_place++] = (pl_component){name, r->q[k], NULL, pl_number(d, r->q[k])};
  }
}

static void show_oscillations(pl_analysis* d, const pl_linearised* l, const pl_rest* rest,
                              const char* at) {
  bool numeric = rest->numeric;
  pl_root root[8];
  bool complete;
  int n = pl_small_oscillations(d, l, root, 8, &complete);
  if (n > 0 && !l->gyroscopic && !numeric) pl_why_oscillations(d, l->M, l->K, l->n);
  for (int k = 0; k < n; k++) {
    double x = pl_number(d, root[k].value);
    if (numeric && isnan(x)) continue;
    const pl_form* form = numeric ? NULL : pl_f(d, root[k].value, PL_S_QUOTIENT);
    pl_step* s = pl_show_numbered(d, pl_square_form(d, root[k].value, numeric));
    for (int r = 0; r < d->page->lagrange2_numbers.n; r++)
      pl_step_refs(s, 1, d->page->lagrange2_numbers.at[r]);
    bool zero = pl_vanishes(d, root[k].value);
    pl_step_after(s, PL_BOTH(zero ? "zero mode: it drifts" : "small oscillations"));
    if (x > 0) {
      s->has_value = true;
      s->value = sqrt(x);
      s->unit = "1/s";
      s->value_name = strncmp(pl_symbol_get(d->pool, pl_omega_squared(d))->name, "Ω", 2) == 0 ? "Ω"
                                                                                              : "ω";
    }
    pl_value* v = pl_answer(d, "omega^2", root[k].value, form);
    v->of = pl_format(d->arena, "mode %d", k + 1);
    v->at = at;
    pl_tell_place(d, rest, v);
  }
}

static void say_pulls(pl_analysis* d, const pl_bond* l, const pl_rest* r) {
  pl_say(d, PL_BOTH("{1} is none: {2} is one-sided and would have to act the other way."), 2,
         pl_rest_form(d, r), pl_fn(d, l->source->name.text));
}

static void say_singular(pl_analysis* d, const pl_rests* found) {
  const pl_rest* r = &found->singular;
  if (found->n_singular == 0 || !pl_rest_exists_at_numbers(d, r)) return;
  const char* text;
  const pl_form* real = pl_conditions_form(d, r->condition, r->n_conditions, false, &text);
  pl_say(
      d,
      PL_BOTH(real ? "At positions like {1} (if {2}) the generalized forces vanish too, but these "
                     "coordinates fail there (the mass matrix or a constraint is singular); other "
                     "coordinates decide."
                   : "At positions like {1} the generalized forces vanish too, but these "
                     "coordinates fail "
                     "there (the mass matrix or a constraint is singular); other "
                     "coordinates decide."),
      real ? 2 : 1, pl_rest_form(d, r), real);
}

void pl_say_velocity_terms(pl_analysis* d, const pl_linearised* l) {
  if (l->damped) {
    pl_say(d, PL_BOTH("The motion is damped; ω² is that of the system without damping."), 0);
  }
}

// ------------------------------------------------------------------------------------ one position
static void say_doubt(pl_analysis* d, pl_doubt doubt) {
  static const char* const words[] = {
      [PL_DOUBT_GYROSCOPIC] = PL_KEY(
          "No minimum of the potential is proven here; the gyroscopic terms "
          "decide with the signs of ω²."),
      [PL_DOUBT_CIRCULATORY] = PL_KEY(
          "Forces without potential depend on the position: the potential "
          "does not decide on stability, the ω² do."),
      [PL_DOUBT_DRIVEN] = PL_KEY(
          "The forces around it change with time: a potential does not decide on stability."),
      [PL_DOUBT_DAMPING] = PL_KEY(
          "A force along the velocity may feed energy in: the potential alone "
          "does not decide on stability."),
      [PL_DOUBT_INERTIA] = PL_KEY(
          "The kinetic energy is not positive here: the potential does not decide on stability."),
      [PL_DOUBT_DEGENERATE] = PL_KEY("The linear terms of the force do not decide on stability."),
  };
  if (doubt != PL_DOUBT_NONE) pl_say(d, PL_BOTH(words[doubt]), 0);
}

static void say_existence(pl_analysis* d, const pl_rest* r, pl_value* v) {
  const pl_form* form = pl_conditions_form(d, r->condition, r->n_conditions, false, &v->exists_if);
  if (!form) {
    v->exists_if = NULL;
    return;
  }
  if (pl_rest_exists_at_numbers(d, r)) pl_say(d, PL_BOTH("exists if {1}"), 1, form);
  else pl_say(d, PL_BOTH("exists if {1}, not for the given numbers"), 1, form);
}

static void say_stability(pl_analysis* d, const pl_verdict* judged, pl_value* v) {
  if (judged->doubt != PL_DOUBT_NONE) {
    say_doubt(d, judged->doubt);
    return;
  }
  if (judged->word || judged->n == 0) return;
  const pl_form* form = pl_conditions_form(d, judged->condition, judged->n, true, &v->stable_if);
  if (form) pl_say(d, PL_BOTH("stable if {1}"), 1, form);
  else v->stable_if = NULL;
}

static void mark_stability(pl_analysis* d, pl_step* step, const pl_verdict* judged,
                           const pl_rest* r) {
  if (judged->word) pl_step_after(step, judged->word, german_stability(judged->word));
  if (judged->word || !judged->at_numbers) return;
  if (r->numeric) pl_step_after(step, judged->at_numbers, german_stability(judged->at_numbers));
  else
    pl_step_after(step, pl_format(d->arena, "%s for the given numbers", judged->at_numbers),
                  pl_format(d->arena, pl_german("%s for the given numbers"),
                            german_stability(judged->at_numbers)));
}

// Proposed coordinates are not those of the model: the place in these. Returns how many; also where
// the formulas stand in forms.
static int in_the_model(pl_analysis* d, const pl_rest* r, pl_component* out, const pl_form** form) {
  int n = 0;
  for (int i = 0; d->is_proposal && !r->numeric && i < d->q.n; i++) {
    const pl_variable* c = &d->q.at[i];
    if (c->solved_by != -1 || pl_is_poison(c->map) || c->follows) continue;
    pl_expr place = pl_alg_normal(d->tower, pl_insert_rest(d, c->map, r));
    const pl_form* shown = pl_f(d, place, PL_S_PLAIN);
    form[n] = pl_feq(d, pl_fs(d, c->q), shown);
    out[n++] = (pl_component){pl_symbol_get(d->pool, c->q)->ascii, place, shown,
                              pl_number(d, place)};
  }
  return n;
}

static void name_components(pl_analysis* d, const pl_rest* r, pl_value* v) {
  v->components = PL_ARRAY(d->arena, pl_component, d->gen.n + d->q.n);
  v->free_names = NULL;
  const char** free_names = PL_ARRAY(d->arena, const char*, d->gen.n);
  for (int k = 0; k < d->gen.n; k++) {
    const char* name = pl_symbol_get(d->pool, d->q.at[d->gen.at[k]].q)->ascii;
    if (pl_is_poison(r->q[k])) {
      free_names[v->n_free++] = name;
      continue;
    }
    v->components[v->n_components++] = (pl_component){name, r->q[k], pl_f(d, r->q[k], PL_S_PLAIN),
                                                      pl_number(d, r->q[k])};
  }
  v->free_names = free_names;
  const pl_form** form = PL_ARRAY(d->arena, const pl_form*, d->q.n + 1);
  int n = in_the_model(d, r, v->components + v->n_components, form);
  v->n_components += n;
  if (n > 0) pl_show(d, n == 1 ? form[0] : pl_flist(d, form, n));
}

// Where the position is there it is unstable: the condition of stability is the opposite of one of
// existence.
static void judge_by_existence(pl_analysis* d, const pl_rest* r, pl_verdict* judged) {
  if (judged->word || judged->doubt != PL_DOUBT_NONE) return;
  for (int k = 0; k < judged->n; k++) {
    for (int j = 0; j < r->n_conditions; j++) {
      if (!pl_conditions_exclude(d, r->condition[j], judged->condition[k])) continue;
      judged->word = "unstable";
      return;
    }
  }
}

// A place on the border of two sides: stability would need the forces of both.
static void show_border_rest(pl_analysis* d, const pl_rest* r, int number) {
  pl_show(d, pl_rest_form(d, r));
  pl_value v = {.name = pl_format(d->arena, "equilibrium %d", number),
                .number = (double)NAN,
                .conserved = -1,
                .passed = -1,
                .order = -1};
  name_components(d, r, &v);
  pl_push(d->arena, d->page->section->values, v);
  pl_say(d, PL_BOTH("Here a force has a kink: stability was not looked at."), 0);
}

static void show_rest(pl_analysis* d, const pl_expr* f, const pl_rest* r, int number) {
  pl_linearised l;
  pl_verdict judged;
  pl_linearise(d, f, r, &l);
  pl_stability(d, f, &l, r, &judged);
  judge_by_existence(d, r, &judged);
  bool exists = pl_rest_exists_at_numbers(d, r);
  pl_step* step = pl_show(d, pl_rest_form(d, r));
  if (exists) mark_stability(d, step, &judged, r);
  pl_value v = {.name = pl_format(d->arena, "equilibrium %d", number),
                .number = (double)NAN,
                .conserved = -1,
                .passed = -1,
                .order = -1,
                .stability = exists ? judged.at_numbers : judged.word};
  name_components(d, r, &v);
  say_existence(d, r, &v);
  if (!r->numeric) say_stability(d, &judged, &v);
  pl_push(d->arena, d->page->section->values, v);
  const char* here = v.stability;
  bool oscillates = exists && (!here || strcmp(here, "stable") == 0)
                    && judged.doubt != PL_DOUBT_DRIVEN;
  if (oscillates) pl_say_velocity_terms(d, &l);
  if (oscillates) show_oscillations(d, &l, r, v.name);
  for (int k = 0; k < d->gen.n && !r->numeric && exists; k++)
    pl_claim_free(d, PL_CLAIM_INSERTED, pl_insert_rest(d, f[k], r), pl_int(d->pool, 0));
}

// sign u as s and |u| as s u, for every u that contains velocities.
static pl_expr with_sign(pl_analysis* d, pl_expr whole, pl_expr e, pl_expr s) {
  pl_pool* p = d->pool;
  for (int k = 0; k < pl_n_args(p, e); k++) whole = with_sign(d, whole, pl_arg(p, e, k), s);
  if (pl_kind_of(p, e) != PL_CALL || !pl_has_role(p, e, PL_R_VELOCITY)) return whole;
  pl_expr u = pl_arg(p, e, 0);
  if (pl_function_of(p, e) == PL_SIGN) return pl_subst_expr(p, whole, e, s);
  return pl_function_of(p, e) == PL_ABS ? pl_subst_expr(p, whole, e, pl_mul(p, s, u)) : whole;
}

// A force jumps where a velocity changes its sign: it holds the system at rest in whole regions.
static bool rubs_at_rest(pl_analysis* d) {
  pl_pool* p = d->pool;
  for (int k = 0; k < d->gen.n; k++) {
    pl_expr e = pl_second_kind(d, d->gen.at[k]);
    pl_expr plus = with_sign(d, e, e, pl_int(p, 1)), minus = with_sign(d, e, e, pl_int(p, -1));
    if (pl_same(plus, minus)) continue;
    pl_expr jump = pl_alg_normal(d->tower, pl_sub(p, plus, minus));
    if (!pl_is_zero_node(p, pl_alg_normal(d->tower, pl_at_rest(d, jump)))) return true;
  }
  return false;
}

// Positions of rest are sought in a few generalized coordinates.
bool pl_rests_out_of_reach(pl_analysis* d) {
  if (d->reduced && rubs_at_rest(d)) {
    pl_say(d,
           PL_BOTH("A force jumps where a velocity changes its sign, as dry friction does: it can "
                   "hold the "
                   "system at rest in whole regions, which are not looked for."),
           0);
    d->page->section->not_found = true;
    return true;
  }
  if (d->reduced && d->gen.n == 0) {
    pl_say(d, PL_BOTH("No coordinate is free: the constraints give the position."), 0);
    return true;
  }
  if (d->reduced && d->gen.n <= pl_max_gen) return false;
  if (!d->reduced) {
    pl_say(
        d,
        PL_BOTH(
            "They are sought in generalized coordinates, and the constraints were not solved for "
            "such. Name them: choose φ with ..."),
        0);
  } else {
    pl_say(d,
           PL_BOTH_FORMAT(
               d->arena, "They are sought for up to %d generalized coordinates; here there are %d.",
               pl_max_gen, d->gen.n),
           0);
  }
  d->page->section->not_found = true;
  return true;
}

// The coordinates of `for` take part again.
static void end_of_steady(pl_analysis* d) {
  if (d->steady.n == 0) return;
  d->steady.n = d->gen.n = 0;
  pl_collect_generalized(d);
}

// `for φ' = Ω`: the coordinate is driven at a steady rate and is no freedom then. It must not occur
// itself.
static bool turns_steadily(pl_analysis* d, const pl_ask* ask) {
  for (int k = 0; k < ask->where.n; k++) {
    const pl_condition* c = &ask->where.at[k];
    pl_symbol v = pl_kind_of(d->pool, c->left) == PL_SYMBOL ? pl_symbol_of(d->pool, c->left)
                                                            : (pl_symbol){0};
    int i = pl_variable_index(d, v), place = -1;
    for (int j = 0; j < d->gen.n; j++) {
      if (d->gen.at[j] == i && d->q.at[i].v.id == v.id) place = j;
    }
    bool steady = place >= 0 && !pl_has_coordinates(d, c->right)
                  && !pl_has_symbol(d->pool, c->right, pl_time(d->pool));
    if (!steady || pl_alg_is_zero(d->tower, pl_diff(d->pool, d->Lg, d->q.at[i].q)) != PL_YES) {
      pl_say(
          d,
          PL_BOTH(
              "After `for` the velocity of a cyclic coordinate is given a constant value, as in φ' "
              "= Ω."),
          0);
      end_of_steady(d);
      d->page->section->not_found = true;
      return false;
    }
    pl_push(d->arena, d->steady, (pl_replace){v, c->right});
    for (int j = place + 1; j < d->gen.n; j++) d->gen.at[j - 1] = d->gen.at[j];
    d->gen.n--;
  }
  return true;
}

static void say_turns(pl_analysis* d) {
  pl_say(
      d,
      PL_BOTH(
          "There are others: of an angle one period is listed, and the system as a whole does not "
          "repeat with it."),
      0);
}

// Whether the list is all there is, and how that is known.
void pl_say_rests_missing(pl_analysis* d, const pl_expr* f, const pl_rests* found) {
  for (int k = 0; k < d->gen.n && found->n > 0; k++) {
    if (!pl_rests_recur(d, f, k)) continue;
    pl_say(
        d,
        PL_BOTH(
            "The forces repeat with whole periods of {1}, the places do not: beside each of these "
            "there are others, whole periods further."),
        1, pl_fs(d, d->q.at[d->gen.at[k]].q));
  }
  const pl_form* zero = pl_form_leaf(d->arena, pl_int(d->pool, 0));
  if (found->complete && found->by_numbers && found->searched > 0) {
    const pl_form* inside = pl_fs(d, d->q.at[d->gen.at[found->searched_place]].q);
    pl_expr digits = pl_int(d->pool, lround(log10(found->searched)));
    const pl_form* range = pl_form_leaf(d->arena, pl_int(d->pool, 10));
    if (found->searched > 10)
      range = pl_form_power(d->arena, range, pl_form_leaf(d->arena, digits));
    const pl_form* q = pl_form_call(d->arena, PL_ABS, &inside, 1);
    bool alone = d->gen.n == 1;
    pl_say(
        d,
        PL_BOTH(
            alone ? "With {1}, in SI units, there are no others: interval arithmetic proves it for "
                    "the given numbers."
                  : "With {1}, in SI units, and up to whole periods of other angles there are no "
                    "others: interval arithmetic proves it for the given numbers."),
        1, pl_frel(d, q, "≤", range));
  } else if (found->complete && found->by_numbers) {
    pl_say(
        d,
        PL_BOTH(
            "Up to whole periods there are no others: interval arithmetic proves it for the given "
            "numbers."),
        0);
  }
  if (found->complete) return;
  bool side = found->n_sides > 0;
  if (side)
    pl_say(d, PL_BOTH("Only places with {1} were looked at."), 1,
           pl_facts_form(d, found->side, found->n_sides));
  if (found->map_ends) {
    pl_say(d,
           PL_BOTH("Where a root of the map vanishes these coordinates end, and beyond it the "
                   "mechanism is "
                   "assembled in another way: there may be others."),
           0);
  }
  bool told = found->more_turns || side || found->map_ends;
  if (found->more_turns) say_turns(d);
  for (int k = 0; k < found->n_open; k++) {
    const pl_rest* r = &found->open[k];
    if (r->turns) {
      if (!told) say_turns(d);
      told = true;
      continue;
    }
    pl_expr e = pl_alg_normal(
        d->tower, pl_insert_rest(d, pl_at_rest(d, pl_second_kind(d, d->gen.at[r->open_row])), r));
    pl_say(d,
           PL_BOTH(found->n > 0 ? "There may be others: {1} is not solved in closed form."
                                : "{1} is not solved in closed form."),
           1, pl_feq(d, pl_f(d, e, PL_S_EQUATION), zero));
  }
  if (found->n_open > 0 || told) return;
  pl_say(d,
         PL_BOTH(found->n > 0 ? "There may be others: not every equation was solved in closed form."
                              : "None was found in closed form."),
         0);
}

// What is left of the equations at a named place.
void pl_say_no_rest_named(pl_analysis* d, const pl_ask* ask, const pl_expr* f) {
  pl_rest r;
  pl_named_rest(d, ask, f, &r);
  for (int k = 0; k < d->gen.n; k++) {
    pl_expr left = pl_alg_normal(d->tower, pl_insert_rest(d, f[k], &r));
    if (pl_is_zero_node(d->pool, left)) continue;
    pl_say(d,
           PL_BOTH(
               "{1} is no position of rest: the equation of {2} there leaves {3}, which is not 0."),
           3, pl_rest_form(d, &r), pl_fs(d, d->q.at[d->gen.at[k]].q), pl_f(d, left, PL_S_PLAIN));
    break;
  }
  d->page->section->not_found = true;
}

static void say_none(pl_analysis* d, const pl_expr* f) {
  bool moves = false;
  for (int k = 0; k < d->gen.n; k++) moves |= pl_has_symbol(d->pool, f[k], pl_time(d->pool));
  pl_say(
      d,
      PL_BOTH(moves ? "There is none: the equations contain t, and no position fits at all times."
                    : "There is none."),
      0);
}

// What was shown so far, with the analysis whose coordinates it is in.
typedef struct pl_shown_rest {
  pl_analysis* in;
  pl_rest rest;
} pl_shown_rest;
typedef struct pl_shown {
  PL_VEC(pl_shown_rest) at;
  PL_VEC(pl_shown_rest) border;  // where a sign that was taken is zero: on hold
  int n;                         // numbered
  bool renamed;                  // some place is named twice, and shown once
} pl_shown;

static pl_expr component_at(const pl_shown_rest* s, int particle, int component) {
  pl_expr place = pl_on_maps(s->in, s->in->particle.at[particle].at[component]);
  return pl_insert_rest(s->in, place, &s->rest);
}

static bool same_points_turned(const pl_shown_rest* a, const pl_shown_rest* b, int turned) {
  pl_analysis* d = a->in;
  pl_symbol name = turned < 0 ? (pl_symbol){0} : d->q.at[d->gen.at[turned]].q;
  pl_expr half = turned < 0 ? pl_poison() : pl_add(d->pool, pl_sym(d->pool, name), pl_pi(d->pool));
  for (int k = 0; k < d->particle.n; k++) {
    for (int c = 0; c < d->particle.at[k].n; c++) {
      pl_expr one = component_at(a, k, c), other = component_at(b, k, c);
      if (turned >= 0) one = pl_subst1(d->pool, one, name, half);
      double off = pl_number(d, pl_sub(d->pool, one, other));
      bool near = fabs(off) < 1e-9 * (1 + fabs(pl_number(d, one)));
      if (!near && pl_alg_equal(d->tower, one, other) != PL_YES) return false;
    }
  }
  return d->particle.n > 0;
}

// All masses are at the same points: (r, φ) and (-r, φ + π) of polar coordinates name one place.
static bool same_points(const pl_shown_rest* a, const pl_shown_rest* b) {
  bool same = same_points_turned(a, b, -1);
  for (int k = 0; !same && k < a->in->gen.n; k++) {
    same = pl_is_poison(a->rest.q[k]) && same_points_turned(a, b, k);
  }
  return same;
}

bool pl_rest_on_border(pl_analysis* d, const pl_rests* found, const pl_rest* r) {
  for (int k = 0; k < found->n_sides; k++) {
    pl_expr e = pl_insert_rest(d, pl_on_maps(d, found->side[k].difference), r);
    if (pl_vanishes(d, e) || fabs(pl_number(d, e)) < 1e-12) return true;
  }
  return false;
}

static void show_found(pl_analysis* d, const pl_expr* f, const pl_rests* found, pl_shown* shown) {
  for (int k = 0; k < found->n; k++) {
    const pl_bond* against = pl_rest_pulls(d, &found->at[k]);
    if (!against && pl_rest_on_border(d, found, &found->at[k])) {
      pl_push(d->arena, shown->border, ((pl_shown_rest){d, found->at[k]}));
      continue;
    }
    if (against) say_pulls(d, against, &found->at[k]);
    else show_rest(d, f, &found->at[k], ++shown->n);
    pl_push(d->arena, shown->at, ((pl_shown_rest){d, found->at[k]}));
  }
}

static void leave_known(pl_analysis* d, pl_rests* found, pl_shown* shown) {
  int n = 0;
  for (int k = 0; k < found->n; k++) {
    pl_shown_rest here = {d, found->at[k]};
    bool known = false;
    for (int j = 0; j < shown->at.n; j++) known |= same_points(&here, &shown->at.at[j]);
    if (!known) found->at[n++] = found->at[k];
  }
  shown->renamed |= n < found->n;
  found->n = n;
}

static void add_kink(pl_analysis* d, pl_expr u, bool strict, pl_rests* out) {
  if (!pl_has_role(d->pool, u, PL_R_COORD) || out->n_sides == pl_max_sides) return;
  for (int k = 0; k < out->n_sides; k++) {
    pl_expr known = out->side[k].difference;
    if (pl_is_number(d->pool, pl_alg_normal(d->tower, pl_div(d->pool, u, known)))) return;
  }
  out->side[out->n_sides++] = (pl_fact){u, strict};
}

// |u|, sign u and if(u > 0, ...) in the equations, where no sign was taken: u.
static void add_kinks(pl_analysis* d, pl_expr e, pl_rests* out) {
  pl_pool* p = d->pool;
  bool call = pl_kind_of(p, e) == PL_CALL, branch = pl_kind_of(p, e) == PL_IF;
  bool size = call && (pl_function_of(p, e) == PL_ABS || pl_function_of(p, e) == PL_SIGN);
  for (int k = 0; k < pl_n_args(p, e); k++) add_kinks(d, pl_arg(p, e, k), out);
  if (size || branch) add_kink(d, pl_arg(p, e, 0), branch, out);
}

// The sides that split the search, where the equations themselves do not know their sign.
static bool finds_kinks(pl_analysis* d, const pl_expr* f, pl_rests* out) {
  *out = (pl_rests){.complete = true, .complete_here = true};
  for (int k = 0; k < d->gen.n; k++) add_kinks(d, pl_alg_normal(d->tower, f[k]), out);
  return out->n_sides > 0;
}

bool pl_say_bends(pl_analysis* d, const pl_expr* f) {
  pl_rests left;
  if (!finds_kinks(d, f, &left)) return false;
  const pl_form** at = PL_ARRAY(d->arena, const pl_form*, left.n_sides + 1);
  for (int k = 0; k < left.n_sides; k++) at[k] = pl_border_form(d, left.side[k].difference);
  pl_say(d, PL_BOTH("The forces have a kink at {1}; `equilibria` looks at the sides one by one."),
         1, pl_flist(d, at, left.n_sides));
  d->page->section->not_found = true;
  return true;
}

// Branches within branches: some are left where the signs of the outer ones are known.
static bool bends(pl_analysis* d, const pl_expr* f) {
  pl_rests left;
  return finds_kinks(d, f, &left);
}

// The same search where some signs are the opposite ones.  false: there it was not finished.
static bool answer_beyond(pl_analysis* d, const pl_ask* ask, const pl_rests* own,
                          const bool* through, pl_shown* shown) {
  pl_analysis* base = pl_analysis_beyond(d->page->base, own->side, own->n_sides, through);
  pl_analysis* a = base ? pl_serving(base, ask) : NULL;
  if (!a || !a->reduced || a->gen.n == 0 || a->gen.n > pl_max_gen || a->loops.n > 0) return false;
  pl_expr f[pl_max_gen];
  a->page->section = d->page->section;
  pl_at_rest_equations(a, f);
  if (bends(a, f)) return false;
  pl_rests* found = pl_find_rests(a, f);
  if (found->special_case) pl_say_special(a);
  leave_known(a, found, shown);
  int inside = 0;
  for (int k = 0; k < found->n; k++) inside += !pl_rest_on_border(a, found, &found->at[k]);
  if (inside > 0) {
    pl_say(a, PL_BOTH("With {1}:"), 1, pl_facts_form(a, found->side, found->n_sides));
    int from = a->page->section->values.n;
    show_found(a, f, found, shown);
    pl_assume_sides(a, a->page->section, from);
  } else {
    show_found(a, f, found, shown);
  }
  say_singular(a, found);
  return found->complete_here && found->n_singular == 0;
}

// What rests on the border of two sides rests by the formulas of both.
static void show_border(pl_analysis* d, pl_shown* shown) {
  for (int k = 0; k < shown->border.n; k++) {
    pl_shown_rest* r = &shown->border.at[k];
    bool first = true, both = false;
    for (int j = 0; j < shown->border.n; j++) {
      bool same = j != k && same_points(r, &shown->border.at[j]);
      first &= !(same && j < k);
      both |= same && shown->border.at[j].in != r->in;
    }
    if (!first || !both) continue;
    r->in->page->section = d->page->section;
    show_border_rest(r->in, &r->rest, ++shown->n);
  }
}

// Where |u| has its kink the force may jump: such places are none of these, and they are named.
static void say_kinks(pl_analysis* d, const pl_rests* own, const pl_shown* shown) {
  const pl_form** at = PL_ARRAY(d->arena, const pl_form*, own->n_sides + 1);
  for (int k = 0; k < own->n_sides; k++) at[k] = pl_border_form(d, own->side[k].difference);
  pl_say(
      d,
      PL_BOTH(shown->border.n > 0 ? "Not looked at: other places with {1}, where a force may jump."
                                  : "Not looked at: places with {1}, where a force may jump."),
      1, pl_flist(d, at, own->n_sides));
}

static void say_more(pl_analysis* d) {
  pl_say(d, PL_BOTH("There may be others: not every equation was solved in closed form."), 0);
}

// On all sides of what was taken for granted, or on all but the own one.  false: some could not be
// searched.
static bool answer_all_sides(pl_analysis* d, const pl_ask* ask, const pl_rests* own, bool own_too,
                             pl_shown* shown) {
  enum { MOST = 3 };
  if (own->n_sides > MOST || ask->where.n > 0 || !d->page->base || !d->page->base->page->first)
    return false;
  bool all = own->complete_here && own->n_singular == 0, through[MOST];
  for (int mask = own_too ? 0 : 1; mask < 1 << own->n_sides; mask++) {
    for (int k = 0; k < own->n_sides; k++) through[k] = mask >> k & 1;
    all &= answer_beyond(d, ask, own, through, shown);
  }
  return all;
}

void pl_answer_equilibria(pl_analysis* d, const pl_ask* ask) {
  pl_section_open(d, ask, PL_BOTH("Equilibria"));
  pl_expr f[pl_max_gen];
  if (pl_rests_out_of_reach(d)) return;
  if (ask->where.n > 0 && !turns_steadily(d, ask)) return;
  pl_at_rest_equations(d, f);
  pl_shown shown = {.n = 0};
  pl_rests split, *found = &split;
  bool kinks = finds_kinks(d, f, &split);
  if (!kinks) {
    found = pl_find_rests(d, f);
    if (found->special_case) pl_say_special(d);
    show_found(d, f, found, &shown);
    say_singular(d, found);
  }
  bool sides = found->n_sides > 0;
  d->page->section->all_sides = sides && answer_all_sides(d, ask, found, kinks, &shown);
  bool all = (found->complete && !kinks) || d->page->section->all_sides;
  if (found->n_sides == 1) show_border(d, &shown);
  if (shown.n == 0 && all && found->n_singular == 0) say_none(d, f);
  if (d->page->section->all_sides) say_kinks(d, found, &shown);
  else if (!kinks) pl_say_rests_missing(d, f, found);
  else if (!all) say_more(d);
  bool recur = false;  // one period is listed, and that is said
  for (int k = 0; k < d->gen.n; k++) recur |= pl_rests_recur(d, f, k);
  d->page->section->all_sides &= !shown.renamed;  // its numbers are those of one side
  d->page->section->complete = all && found->n_singular == 0 && !recur;
  if (!all) d->page->section->not_found = shown.at.n == 0;
  end_of_steady(d);
}
