// answer_modes: normal modes about positions of rest and about steady motions.
#include <math.h>
#include <string.h>

#include "worked/equilibria_impl.h"

// The amplitudes of a mode: cofactors of a row of K - ω² M that do not all vanish, the first
// non-zero one scaled to 1.
static bool amplitudes(pl_analysis* d, const pl_linearised* l, pl_expr w2, pl_expr* u) {
  int n = l->n;
  for (int row = 0; row < n; row++) {
    int first = -1;
    for (int j = 0; j < n; j++) {
      pl_expr A[pl_max_gen * pl_max_gen];
      int m = 0;
      for (int a = 0; a < n; a++) {
        for (int b = 0; b < n; b++) {
          if (a != row && b != j)
            A[m++] = pl_sub(d->pool, l->K[a * n + b], pl_mul(d->pool, w2, l->M[a * n + b]));
        }
      }
      pl_expr minor = n == 1 ? pl_int(d->pool, 1)
                             : pl_alg_normal(d->tower, pl_alg_det(d->tower, n - 1, A, 20000));
      u[j] = (row + j) % 2 ? pl_neg(d->pool, minor) : minor;
      if (first < 0 && pl_alg_is_zero(d->tower, minor) == PL_NO) first = j;
    }
    if (first < 0) continue;
    pl_expr scale = u[first];
    for (int j = 0; j < n; j++) u[j] = pl_alg_normal(d->tower, pl_div(d->pool, u[j], scale));
    return true;
  }
  return false;
}

// The number beside ω²: the frequency, or the rate at which a deviation grows.
static void number_of_mode(pl_analysis* d, pl_step* step, pl_expr w2) {
  double x = pl_number(d, w2);
  if (isnan(x) || x == 0) return;
  step->has_value = true;
  step->value = sqrt(fabs(x));
  step->unit = "1/s";
  step->value_name = x < 0 ? "σ"
                     : strncmp(pl_symbol_get(d->pool, pl_omega_squared(d))->name, "Ω", 2) == 0
                         ? "Ω"
                         : "ω";
}

// ω² < 0 is no oscillation.
static void say_growth(pl_analysis* d, const pl_linearised* l, pl_expr w2, const pl_rest* r) {
  int sign = 0;
  const pl_form* form = NULL;
  const char* text;
  if (pl_vanishes(d, w2)) return;
  double x = pl_number(d, w2);
  bool negative = pl_alg_sign_proven(d->tower, w2, false, &sign) == PL_YES ? sign < 0 : x < 0;
  if (negative && l->gyroscopic) {
    pl_say(d, PL_BOTH("unstable: the deviation grows"), 0);
  } else if (negative) {
    pl_say(d, PL_BOTH("unstable: no oscillation, the deviation grows as e^(σ t) with {1}"), 1,
           pl_feq(d, pl_fn(d, "σ²"),
                  pl_f(d, pl_alg_normal(d->tower, pl_neg(d->pool, w2)), PL_S_QUOTIENT)));
  } else if (sign == 0 && isnan(x) && pl_condition_form(d, w2, true, &form, &text) == PL_UNKNOWN) {
    bool always = r->n_conditions == 0;
    pl_say(d,
           PL_BOTH(always ? "an oscillation if {1}, else the deviation grows"
                          : "an oscillation if {1}"),
           1, form);
  }
}

static void show_mode(pl_analysis* d, const pl_linearised* l, const pl_rest* r, pl_expr w2,
                      int number, const char* at) {
  const pl_form* form = pl_f(d, w2, PL_S_QUOTIENT);
  pl_step* step = pl_show_numbered(d, pl_square_form(d, w2, r->numeric));
  number_of_mode(d, step, w2);
  for (int k = 0; k < d->page->lagrange2_numbers.n; k++)
    pl_step_refs(step, 1, d->page->lagrange2_numbers.at[k]);
  pl_step_after(step, pl_format(d->arena, "mode %d", number),
                pl_format(d->arena, "Mode %d", number));
  pl_value v = {.name = "omega^2",
                .of = pl_format(d->arena, "mode %d", number),
                .at = at,
                .form = form,
                .expr = w2,
                .number = pl_number(d, w2),
                .unit = "1/s^2",
                .conserved = -1,
                .passed = -1,
                .order = -1};
  pl_tell_place(d, r, &v);
  pl_expr u[pl_max_gen];
  if (!l->gyroscopic && !r->numeric && amplitudes(d, l, w2, u)) {
    const pl_form* ratio[pl_max_gen];
    v.components = PL_ARRAY(d->arena, pl_component, l->n);
    for (int j = 0; j < l->n; j++) {
      const pl_symbol_info* q = pl_symbol_get(d->pool, d->q.at[d->gen.at[j]].q);
      ratio[j] = pl_f(d, u[j], PL_S_QUOTIENT);
      v.components[v.n_components++] = (pl_component){q->ascii, u[j], ratio[j], pl_number(d, u[j])};
    }
    if (l->n > 1) {
      const pl_form* names[pl_max_gen];
      for (int j = 0; j < l->n; j++) names[j] = pl_fs(d, d->q.at[d->gen.at[j]].q);
      pl_say(d, PL_BOTH("amplitudes {1} as {2}"), 2, pl_flist(d, names, l->n),
             pl_flist(d, ratio, l->n));
    }
  }
  pl_push(d->arena, d->page->section->values, v);
  if (!r->numeric) say_growth(d, l, w2, r);
}

// One damped coordinate, M u'' + C u' + K u = 0: u = e^(-γ t) cos(ω_d t) with γ = C/2M, ω_d² = K/M
// - γ²; the sign of ω_d² decides
// between oscillation and creeping.
static void show_damped(pl_analysis* d, const pl_linearised* l, const char* at) {
  if (!l->damped || l->n != 1) return;
  pl_pool* p = d->pool;
  pl_expr gamma = pl_alg_normal(d->tower, pl_div(p, l->C[0], pl_mul(p, pl_int(p, 2), l->M[0])));
  pl_expr square = pl_alg_normal(d->tower,
                                 pl_sub(p, pl_div(p, l->K[0], l->M[0]), pl_square(p, gamma)));
  int sign = pl_sign_at_numbers(d, square);
  const pl_form* form = pl_f(d, gamma, PL_S_QUOTIENT);
  pl_step_after(pl_show_numbered(d, pl_feq(d, pl_fn(d, "γ"), form)), PL_BOTH("decay"));
  pl_answer(d, "gamma", gamma, form)->at = at;
  if (sign < 0) {
    pl_say(d, PL_BOTH("Overdamped: no oscillation."), 0);
    return;
  }
  if (sign == 0 && (pl_vanishes_at_numbers(d, square) || pl_vanishes(d, square))) {
    pl_say(d, PL_BOTH("Critically damped: no oscillation."), 0);
    return;
  }
  pl_expr root = pl_alg_normal(d->tower, pl_sqrt(p, square));
  form = pl_f(d, root, PL_S_QUOTIENT);
  pl_step* step = pl_show_numbered(d, pl_feq(d, pl_fn(d, "ω_d"), form));
  pl_step_after(step, PL_BOTH("damped oscillation"));
  pl_answer(d, "omega_d", root, form)->at = at;
  const char* text;
  if (sign == 0 && pl_condition_form(d, square, true, &form, &text) == PL_UNKNOWN) {
    pl_say(d, PL_BOTH("an oscillation if {1}"), 1, form);
  }
}

// Amplitudes that divide by zero for the given numbers, as where two frequencies coincide: these
// numbers are a special case then.
static bool specialise(pl_analysis* d, pl_linearised* l) {
  pl_root root[pl_max_gen];
  pl_expr u[pl_max_gen], base;
  bool complete;
  int n = l->gyroscopic || l->n == 1 ? 0 : pl_small_oscillations(d, l, root, pl_max_gen, &complete),
      before = d->special.n;
  for (int k = 0; k < n; k++) {
    bool found = amplitudes(d, l, root[k].value, u);
    for (int j = 0; found && j < l->n; j++) {
      if (pl_pole_at_numbers(d, u[j], &base)) pl_find_special(d, base);
    }
  }
  if (d->special.n == before) return false;
  for (int k = 0; k < l->n * l->n; k++) {
    l->M[k] = pl_on_special(d, l->M[k]);
    l->C[k] = pl_on_special(d, l->C[k]);
    l->K[k] = pl_on_special(d, l->K[k]);
  }
  return true;
}

static void show_modes(pl_analysis* d, const pl_expr* f, const pl_rest* r, int number) {
  pl_linearised l;
  pl_linearise(d, f, r, &l);
  bool special = false;
  while (!r->numeric && specialise(d, &l)) special = true;
  if (special) pl_say_special(d);
  const char* at = pl_format(d->arena, "equilibrium %d", number);
  pl_say(d, PL_BOTH("At {1}:"), 1, pl_rest_form(d, r));
  pl_say_velocity_terms(d, &l);
  pl_root root[pl_max_gen];
  bool complete;
  int n = pl_small_oscillations(d, &l, root, pl_max_gen, &complete);
  if (n > 0 && !l.gyroscopic) pl_why_oscillations(d, l.M, l.K, l.n);
  for (int k = 0; k < n; k++) show_mode(d, &l, r, root[k].value, k + 1, at);
  show_damped(d, &l, at);
  if (n < l.n && complete && !l.gyroscopic && !l.circulatory) {
    pl_say(d, PL_BOTH("A frequency is repeated: all combinations of its modes are modes."), 0);
  } else if (n < l.n) {
    pl_say(d, PL_BOTH("Not every root of the characteristic equation was found in closed form."),
           0);
    d->page->section->not_found = n == 0;
  }
}

// ---------------------------------------------------------------------------------- steady motions
// The rate of the held coordinate at which the position stays: the roots of the equations at rest
// in its velocity.
static bool steady_rate(pl_analysis* d, const pl_rest* r, int held) {
  pl_symbol v = d->q.at[held].v;
  for (int k = 0; k < d->gen.n; k++) {
    pl_expr e = pl_insert_rest(d, pl_second_kind(d, d->gen.at[k]), r);
    pl_replace stay[2 * pl_max_gen];
    int n = 0;
    for (int j = 0; j < d->gen.n; j++) {
      const pl_variable* c = &d->q.at[d->gen.at[j]];
      if (d->gen.at[j] != held) stay[n++] = (pl_replace){c->v, pl_int(d->pool, 0)};
      stay[n++] = (pl_replace){c->a, pl_int(d->pool, 0)};
    }
    e = pl_alg_normal(d->tower, pl_subst(d->pool, e, stay, n));
    if (pl_vanishes(d, e)) continue;
    pl_root root[4];
    bool complete = false;
    int m = pl_has_symbol(d->pool, e, v) ? pl_alg_roots(d->tower, e, v, root, 4, &complete) : 0,
        best = 0, sign = 0;
    if (m == 0) return false;
    for (int j = 0; j < m; j++) {
      if (pl_alg_sign(d->tower, root[j].value, false, &sign) == PL_YES && sign > 0) best = j;
    }
    pl_push(d->arena, d->steady, (pl_replace){v, root[best].value});
    return true;
  }
  return false;
}

static bool position_of(pl_analysis* d, const pl_ask* ask, int held, pl_rest* r) {
  *r = (pl_rest){0};
  for (int k = 0; k < d->gen.n; k++) {
    if (d->gen.at[k] == held) continue;
    for (int c = 0; c < ask->where.n; c++) {
      if (pl_same(ask->where.at[c].left, pl_sym(d->pool, d->q.at[d->gen.at[k]].q)))
        r->q[k] = ask->where.at[c].right;
    }
    if (pl_is_poison(r->q[k])) return false;
  }
  return true;
}

// `modes at (θ = α) holding φ`: oscillations about the motion with constant θ and φ', the momentum
// of φ being conserved.
static void modes_of_steady(pl_analysis* d, const pl_ask* ask) {
  int held = pl_variable_index(d, ask->frame.at[0]);
  bool cyclic = held >= 0
                && pl_alg_is_zero(d->tower, pl_diff(d->pool, d->Lg, d->q.at[held].q)) == PL_YES;
  pl_rest r;
  if (ask->frame.n != 1 || !cyclic || !position_of(d, ask, held, &r) || !steady_rate(d, &r, held)) {
    pl_say(d,
           PL_BOTH(
               "A steady motion needs one cyclic coordinate after `holding`, values for all others "
               "after `at`, and a rate that keeps them."),
           0);
    d->page->section->not_found = true;
    return;
  }
  pl_expr rate = d->steady.at[0].to, f[pl_max_gen];
  const pl_form* squared = pl_form_power(d->arena, pl_fs(d, d->q.at[held].v),
                                         pl_form_leaf(d->arena, pl_int(d->pool, 2)));
  pl_expr rate2 = pl_alg_normal(d->tower, pl_square(d->pool, rate));
  const pl_form* form = pl_f(d, rate2, PL_S_QUOTIENT);
  pl_say(d, PL_BOTH("At {1} the motion is steady for"), 1, pl_rest_form(d, &r));
  pl_show_numbered(d, pl_feq(d, squared, form));
  pl_value* v = pl_answer(
      d, pl_format(d->arena, "%s^2", pl_symbol_get(d->pool, d->q.at[held].v)->ascii), rate2, form);
  v->at = "steady motion";
  for (int k = 0; k < d->gen.n; k++) f[k] = pl_at_rest(d, pl_second_kind(d, d->gen.at[k]));
  pl_linearised l;
  pl_linearise(d, f, &r, &l);
  l.gyroscopic = true;  // the held coordinate is coupled by its velocity
  pl_root root[pl_max_gen];
  bool complete;
  int n = pl_small_oscillations(d, &l, root, pl_max_gen, &complete), shown = 0;
  for (int k = 0; k < n; k++) {
    if (!pl_vanishes(d, root[k].value))
      show_mode(d, &l, &r, root[k].value, ++shown, "steady motion");
  }
  if (shown == 0) {
    pl_say(d, PL_BOTH("The characteristic equation was not solved in closed form."), 0);
    d->page->section->not_found = true;
  }
  d->steady.n = 0;
}

static void modes_at_rest(pl_analysis* d, const pl_ask* ask, pl_expr* f) {
  pl_rest named;
  pl_answer3 is_rest = pl_names_a_place(d, ask) ? pl_named_rest(d, ask, f, &named) : PL_UNKNOWN;
  if (is_rest == PL_NO) {
    pl_say_no_rest_named(d, ask, f);
    return;
  }
  if (is_rest == PL_YES) {
    show_modes(d, f, &named, 1);
    return;
  }
  pl_rests* found = pl_find_rests(d, f);
  if (found->special_case) pl_say_special(d);
  int shown = 0, number = 0;
  for (int k = 0; k < found->n; k++) {
    if (pl_rest_pulls(d, &found->at[k]) || pl_rest_on_border(d, found, &found->at[k])) continue;
    number++;
    if (!pl_rest_is_named(d, ask, &found->at[k]) || !pl_rest_exists_at_numbers(d, &found->at[k]))
      continue;
    show_modes(d, f, &found->at[k], number);
    shown++;
  }
  if (shown == 0 && found->complete) {
    pl_say(d, PL_BOTH("There is no position of rest to oscillate about."), 0);
  }
  if (!found->complete) pl_say_rests_missing(d, f, found);
  d->page->section->not_found = shown == 0;
}

static bool without_drive(pl_analysis* d, pl_expr* f) {
  pl_drive drive;
  if (!pl_without_drive(d, f, &drive)) return false;
  const pl_form* term[pl_max_gen];
  for (int k = 0; k < drive.n; k++) term[k] = pl_f(d, drive.force[k], PL_S_PLAIN);
  if (drive.n > 0)
    pl_say(d, PL_BOTH("Without the drive: {1} is set to 0."), 1, pl_flist(d, term, drive.n));
  if (drive.amplitude.id) {
    const pl_form* none = pl_feq(d, pl_fs(d, drive.amplitude),
                                 pl_form_leaf(d->arena, pl_int(d->pool, 0)));
    pl_say(d, PL_BOTH("Without the drive: {1}."), 1, none);
  }
  return true;
}

void pl_answer_modes(pl_analysis* d, const pl_ask* ask) {
  pl_section_open(d, ask, PL_BOTH("Modes"));
  pl_expr f[pl_max_gen];
  if (pl_rests_out_of_reach(d)) return;
  if (ask->frame.n > 0) {
    modes_of_steady(d, ask);
    return;
  }
  pl_at_rest_equations(d, f);
  if (pl_say_bends(d, f)) return;
  if (without_drive(d, f)) {
    modes_at_rest(d, ask, f);
  } else {
    pl_say(
        d,
        PL_BOTH(
            "The equations contain t in a way that is no drive to be left out: there are no modes "
            "of constant frequency."),
        0);
    d->page->section->not_found = true;
  }
  d->steady.n = 0;
}
