// answer_value: a quantity on the motion, or where something holds; and `expect`, the check of somebody's own answer.
#include <math.h>
#include <string.h>

#include "derive/derive_impl.h"

const char* pl_text_of(pl_analysis* d, pl_expr e) {
  pl_notation how = {.math = PL_MATH_LINE, .lang = d->job->lang};
  return pl_notation_print(d->arena, d->pool, pl_f(d, e, PL_S_PLAIN), how);
}

// ---------------------------------------------------------------------------------------------- where
// The condition as a function of the generalized coordinate alone, velocities eliminated by the energy.
static pl_expr along(pl_analysis* d, const pl_motion* motion, pl_expr e, bool* eliminated) {
  e = pl_alg_normal(d->tower, pl_on_motion(d, pl_with_results(d, e)));
  *eliminated = false;
  if (d->gen.n != 1 || !pl_has_symbol(d->pool, e, d->q.at[d->gen.at[0]].v)) return e;
  pl_expr v2, q0, v0;
  if (!pl_velocity_squared(d, motion, &v2, &q0, &v0)) return e;
  *eliminated = true;
  return pl_without_velocity(d, e, v2);
}

// Of several solutions the one that the motion meets first: nearest to the start on the side the motion goes to; without a
// direction (rest in an equilibrium) the nearest positive step.
static int first_met(pl_analysis* d, const pl_motion* motion, const pl_root* root, int n) {
  pl_expr v2, q0, v0;
  double start = 0, direction = 1;
  if (pl_velocity_squared(d, motion, &v2, &q0, &v0)) {
    int i = d->gen.at[0];
    double at = pl_number(d, q0), v = pl_number(d, v0);
    pl_replace here[2] = {{d->q.at[i].q, q0}, {d->q.at[i].v, v0}};
    double a = pl_number(d, pl_subst(d->pool, d->acceleration[i], here, 2));
    if (!isnan(at)) start = at;
    if (!isnan(v) && v != 0) {
      direction = v;
    } else if (!isnan(a) && a != 0) {
      direction = a;
    }
  }
  int best = -1;
  double nearest = (double)INFINITY;
  for (int k = 0; k < n; k++) {
    double x = pl_number(d, root[k].value);
    double step = (x - start) * (direction > 0 ? 1 : -1);
    if (isnan(x) || step <= 0 || step >= nearest) continue;
    best = k;
    nearest = step;
  }
  return best >= 0 ? best : n > 0 ? 0 : -1;
}

static bool is_an_angle(pl_analysis* d, pl_expr e) {
  if (pl_kind_of(d->pool, e) != PL_CALL) return false;
  pl_function f = pl_function_of(d->pool, e);
  return f == PL_ACOS || f == PL_ASIN || f == PL_ATAN || f == PL_ATAN2;
}

static void show_root(pl_analysis* d, pl_expr name, pl_expr value) {
  const pl_form* form = pl_f(d, value, PL_S_PLAIN);
  if (is_an_angle(d, value)) {
    const pl_form* angle = pl_fe(d, name);
    const pl_form* inverse = pl_form_call(d->arena, pl_function_of(d->pool, value) == PL_ASIN ? PL_SIN : PL_COS, &angle, 1);
    pl_function f = pl_function_of(d->pool, value);
    if (f == PL_ACOS || f == PL_ASIN) pl_show_numbered(d, pl_feq(d, inverse, pl_f(d, pl_arg(d->pool, value, 0), PL_S_QUOTIENT)));
  }
  pl_step* step = pl_show(d, pl_feq(d, pl_fe(d, name), form));
  double x = pl_number(d, value);
  pl_value* v = pl_answer(d, pl_expr_text(d->arena, d->pool, name), value, form);
  if (isnan(x)) return;
  step->has_value = !pl_is_number(d->pool, value);
  step->value = is_an_angle(d, value) ? x * 180 / M_PI : x;
  step->unit = is_an_angle(d, value) ? "°" : "";
  if (is_an_angle(d, value)) {
    v->unit = "rad";
    v->display = pl_display(d, x, pl_dimension_one(), true);
  }
}

static void say_independent(pl_analysis* d, pl_expr value) {
  if (!pl_is_constant(d->pool, value) || d->model->params.n == 0) return;
  const pl_form** f = PL_ARRAY(d->arena, const pl_form*, d->model->params.n);
  for (int k = 0; k < d->model->params.n; k++) f[k] = pl_fs(d, d->model->params.at[k].symbol);
  pl_say(d, "independent of {1}", "unabhängig von {1}", 1, pl_flist(d, f, d->model->params.n));
}

static void value_where(pl_analysis* d, const pl_ask* ask) {
  const pl_condition* c = &ask->where.at[0];
  bool eliminated;
  pl_expr e = along(d, &ask->motion, pl_sub(d->pool, c->left, c->right), &eliminated);
  int i = d->gen.n == 1 ? d->gen.at[0] : -1;
  if (i < 0 || pl_has_symbol(d->pool, e, d->q.at[i].v)) {
    pl_say(d, "The condition could not be reduced to one coordinate.", "Die Bedingung war nicht auf eine Koordinate zurückzuführen.", 0);
    d->section->not_found = true;
    return;
  }
  pl_root root[8];
  bool complete;
  int n = pl_alg_roots(d->tower, e, d->q.at[i].q, root, 8, &complete);
  int k = first_met(d, &ask->motion, root, n);
  const pl_form* zero = pl_form_leaf(d->arena, pl_int(d->pool, 0));
  pl_say(d, "Condition {1}:", "Bedingung {1}:", 1, pl_feq(d, pl_fe(d, c->left), pl_fe(d, c->right)));
  pl_show(d, pl_feq(d, pl_f(d, e, PL_S_QUOTIENT), zero));
  if (k < 0) {
    pl_say(d, complete ? "This never happens on the motion." : "No solution in closed form was found.",
           complete ? "Das tritt auf der Bewegung nicht ein." : "Eine geschlossene Lösung wurde nicht gefunden.", 0);
    d->section->not_found = !complete;
    return;
  }
  pl_claim_free(d, PL_CLAIM_INSERTED, pl_subst1(d->pool, e, d->q.at[i].q, root[k].value), pl_int(d->pool, 0));
  pl_expr asked = along(d, &ask->motion, ask->value, &eliminated);
  pl_expr value = pl_alg_normal(d->tower, pl_subst1(d->pool, asked, d->q.at[i].q, root[k].value));
  show_root(d, ask->value, value);
  say_independent(d, value);
}

static bool unsolved(pl_analysis* d, pl_expr e) {
  return pl_has_role(d->pool, e, PL_R_ACCELERATION) || pl_has_role(d->pool, e, PL_R_MULTIPLIER);
}

bool pl_say_unsolved(pl_analysis* d, pl_expr asked, pl_expr e) {
  if (!unsolved(d, e)) return false;
  pl_say(d, "{1} hangs on accelerations or multipliers for which no closed form was found.",
         "{1} hängt an Beschleunigungen oder Multiplikatoren, für die keine geschlossene Form gefunden wurde.", 1, pl_fe(d, asked));
  d->section->not_found = true;
  return true;
}

// Nothing was found for the quantity: it is what it was, or hangs on accelerations and multipliers that are not solved.
static bool stays_open(pl_analysis* d, pl_expr asked, pl_expr e) {
  if (pl_say_unsolved(d, asked, e)) return true;
  if (pl_same(asked, e) && pl_kind_of(d->pool, e) == PL_SYMBOL && pl_has_coordinates(d, e)) {
    pl_say(d, "{1} belongs to the state; the constraints give no closed form for it. Its motion: \"solve {1}(t)\" for a coordinate.",
           "{1} gehört zum Zustand; die Zwangsbedingungen geben keine geschlossene Form. Die Bewegung einer Koordinate: „solve {1}(t)“.", 1,
           pl_fe(d, asked));
  } else {
    return false;
  }
  d->section->not_found = true;
  return true;
}

static void plain_value(pl_analysis* d, const pl_ask* ask) {
  bool eliminated = false;
  pl_expr e = ask->motion.given ? along(d, &ask->motion, ask->value, &eliminated)
                                : pl_alg_normal(d->tower, pl_on_motion(d, pl_with_results(d, ask->value)));
  if (pl_is_poison(e)) {
    pl_answer_pending(d, ask);
    return;
  }
  if (stays_open(d, ask->value, e)) return;
  const pl_form* form = pl_f(d, e, PL_S_QUOTIENT);
  pl_step* step = pl_show_numbered(d, pl_feq(d, pl_fe(d, ask->value), form));
  bool known;
  pl_step_value(d, step, e, pl_dimension_of_expr(d, e, &known));
  if (!eliminated) pl_claim_that(d, PL_CLAIM_OTHER, pl_form_value(d->pool, form), pl_with_results(d, ask->value));
  pl_answer(d, pl_expr_text(d->arena, d->pool, ask->value), e, form);
}

// The request as a German title: the words between its formulas, "ϑ bei λ = 0 mit Start ϑ = 0 in Ruhe".
static const char* german_title(pl_analysis* d, const char* request) {
  static const char* const word[][2] = {{" where ", " bei "}, {" from ", " mit Start "}, {" and ", " und "}, {" at rest", " in Ruhe"}};
  pl_text out = pl_text_make(d->arena);
  while (*request) {
    size_t n = 0;
    for (size_t k = 0; k < sizeof word / sizeof *word && n == 0; k++) {
      if (strncmp(request, word[k][0], strlen(word[k][0])) != 0) continue;
      pl_text_add(&out, word[k][1]);
      n = strlen(word[k][0]) - (word[k][0][strlen(word[k][0]) - 1] == ' ');   // the blank may begin the next word
      if (n < strlen(word[k][0])) out.at[--out.n] = '\0';
    }
    if (n == 0) pl_text_add_n(&out, request, n = 1);
    request += n;
  }
  return pl_text_string(&out);
}

void pl_answer_value(pl_analysis* d, const pl_ask* ask) {
  pl_section_open(d, ask, ask->text, german_title(d, ask->text));
  if (ask->where.n > 0) {
    value_where(d, ask);
  } else {
    plain_value(d, ask);
  }
}

// ---------------------------------------------------------------------------------------------- expect
enum { max_inserted = 3 };   // constraints that are solved and inserted for an `expect` without generalized coordinates

// Is e zero wherever the constraints from k on hold?  Each is solved for one coordinate, all its roots are inserted, and their
// derivatives for its velocity.
static pl_answer3 zero_on_constraints(pl_analysis* d, pl_expr e, int k, int depth) {
  pl_answer3 zero = pl_alg_is_zero(d->tower, e);
  while (k < d->g.n && (d->g.at[k].implied || d->g.at[k].velocity || d->g.at[k].fixes >= 0)) k++;
  if (zero == PL_YES || k == d->g.n) return zero;
  if (depth == max_inserted) return PL_UNKNOWN;
  pl_expr g = pl_on_contact(d, d->g.at[k].g);
  for (int i = d->q.n - 1; i >= 0; i--) {
    const pl_variable* c = &d->q.at[i];
    if (!pl_has_symbol(d->pool, g, c->q)) continue;
    pl_root root[8];
    bool complete = false;
    int n = pl_alg_roots(d->tower, g, c->q, root, 8, &complete);
    if (n == 0 || !complete) continue;
    pl_answer3 all = PL_YES;
    for (int r = 0; r < n && all != PL_NO; r++) {
      pl_replace inserted[2] = {{c->q, root[r].value}, {c->v, pl_dt(d->pool, root[r].value)}};
      pl_answer3 one = zero_on_constraints(d, pl_subst(d->pool, e, inserted, 2), k + 1, depth + 1);
      if (one != PL_YES) all = one;
    }
    return all;
  }
  return PL_UNKNOWN;
}

void pl_answer_expect(pl_analysis* d, const pl_ask* ask) {
  pl_section_open(d, ask, "Expected", "Erwartet");
  const pl_condition* c = &ask->where.at[0];
  pl_expr left = pl_on_motion(d, pl_with_results(d, c->left)), right = pl_on_motion(d, pl_with_results(d, c->right));
  for (int k = 1; k < ask->where.n; k++) {
    left = pl_subst_expr(d->pool, left, ask->where.at[k].left, ask->where.at[k].right);
    right = pl_subst_expr(d->pool, right, ask->where.at[k].left, ask->where.at[k].right);
  }
  pl_answer3 equal = pl_alg_equal(d->tower, left, right);
  if (equal != PL_YES && !d->reduced) equal = zero_on_constraints(d, pl_sub(d->pool, left, right), 0, 0);
  if (equal == PL_NO && (unsolved(d, left) || unsolved(d, right))) equal = PL_UNKNOWN;
  const pl_form* claim = pl_feq(d, pl_fe(d, c->left), pl_fe(d, c->right));
  left = pl_alg_normal(d->tower, left);
  pl_value* v = pl_answer(d, "expect", equal == PL_YES ? right : left, NULL);
  v->passed = equal == PL_YES;
  if (equal == PL_YES) {
    pl_say(d, "{1}: yes", "{1}: ja", 1, claim);
    return;
  }
  v->got = left;
  const pl_form* got = pl_feq(d, pl_fe(d, c->left), pl_f(d, left, PL_S_QUOTIENT));
  pl_say(d, equal == PL_NO ? "{1}: no, {2}" : "{1}: not decided; {2}", equal == PL_NO ? "{1}: nein, {2}" : "{1}: nicht entschieden; {2}", 2,
         claim, got);
  d->solution->expect_failed = true;
}
