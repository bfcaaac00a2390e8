// answer_solve: multipliers, accelerations and closed motions on request, with the way to them.
#include <math.h>
#include <string.h>

#include "worked/worked_impl.h"

static int link_of_lambda(const pl_analysis* d, pl_symbol s) {
  for (int k = 0; k < d->g.n; k++) {
    if (d->g.at[k].lambda.id == s.id) return k;
  }
  return -1;
}

// ------------------------------------------------------------------------------------- multipliers
static pl_expr zero_accelerations(pl_analysis* d, pl_expr e) {
  pl_replace* zero = PL_ARRAY(d->arena, pl_replace, d->q.n);
  for (int j = 0; j < d->q.n; j++) zero[j] = (pl_replace){d->q.at[j].a, pl_int(d->pool, 0)};
  return pl_subst(d->pool, e, zero, d->q.n);
}

// Row i solved for its own acceleration when no other one occurs in it: x'' = (F + sum lambda
// dg)/m.
static pl_expr own_acceleration(pl_analysis* d, int i) {
  pl_expr e = pl_on_contact(d, d->euler[i]);
  pl_expr own = pl_diff(d->pool, e, d->q.at[i].a);
  for (int j = 0; j < d->q.n; j++) {
    if (j != i && !pl_is_zero_node(d->pool, pl_diff(d->pool, e, d->q.at[j].a))) return pl_poison();
  }
  pl_expr push = pl_neg(d->pool, zero_accelerations(d, e));
  for (int k = 0; k < d->g.n; k++) {
    const pl_bond* l = &d->g.at[k];
    if ((l->implied && !l->shared) || l->fixes >= 0) continue;
    push = pl_add(d->pool, push,
                  pl_mul(d->pool, pl_sym(d->pool, l->lambda), pl_on_contact(d, l->push[i])));
  }
  return pl_div(d->pool, push, own);
}

// Puts the equations of motion into a differentiated constraint; false when they are coupled.
static bool insert_rows(pl_analysis* d, pl_expr e, pl_expr* out) {
  pl_replace* r = PL_ARRAY(d->arena, pl_replace, d->q.n);
  int n = 0;
  for (int i = 0; i < d->q.n; i++) {
    if (!pl_has_symbol(d->pool, e, d->q.at[i].a)) continue;
    pl_expr a = own_acceleration(d, i);
    if (pl_is_poison(a)) return false;
    r[n++] = (pl_replace){d->q.at[i].a, a};
  }
  *out = pl_subst(d->pool, e, r, n);
  return n > 0;
}

// "(1)", "(1) and (2)", "(1), (2) and (4)"
static const pl_form* refs_form(pl_analysis* d, const int* number, int n) {
  pl_text words[2] = {pl_text_make(d->arena), pl_text_make(d->arena)};
  const char* const last[2] = {PL_BOTH(" and ")};
  for (int i = 0; i < n; i++) {
    for (int lang = 0; lang < 2; lang++) {
      pl_text_addf(&words[lang], "%s(%d)", i == 0 ? "" : i == n - 1 ? last[lang] : ", ", number[i]);
    }
  }
  return pl_form_words(d->arena, pl_text_string(&words[0]), pl_text_string(&words[1]));
}

// Collects e as sum over the multipliers: "2 g + λ (1/m1 + 1/m2)".
static const pl_form* by_multipliers(pl_analysis* d, pl_expr e) {
  const pl_form** term = PL_ARRAY(d->arena, const pl_form*, d->g.n + 1);
  int n = 0;
  pl_replace* zero = PL_ARRAY(d->arena, pl_replace, d->g.n);
  for (int k = 0; k < d->g.n; k++) zero[k] = (pl_replace){d->g.at[k].lambda, pl_int(d->pool, 0)};
  pl_expr rest = pl_alg_normal(d->tower, pl_subst(d->pool, e, zero, d->g.n));
  if (!pl_is_zero_node(d->pool, rest)) term[n++] = pl_f(d, rest, PL_S_PLAIN);
  for (int k = 0; k < d->g.n; k++) {
    pl_expr c = pl_diff(d->pool, e, d->g.at[k].lambda);
    if (pl_is_zero_node(d->pool, c)) continue;
    pl_expr normal = pl_alg_normal(d->tower, c);
    bool shorter = pl_op_count(d->pool, normal) < pl_op_count(d->pool, c);
    const pl_form* factor[2] = {pl_fs(d, d->g.at[k].lambda),
                                shorter ? pl_f(d, normal, PL_S_QUOTIENT) : pl_fe(d, c)};
    term[n++] = pl_form_product(d->arena, factor, 2);
  }
  return n == 1 ? term[0] : pl_form_sum(d->arena, term, n);
}

// The equations of motion that have an acceleration of e; all of them where rows and coordinates do
// not pair.
static const pl_form* refs_of_accelerations(pl_analysis* d, pl_expr e) {
  int rows = 0, n = 0, *number = PL_ARRAY(d->arena, int, d->q.n + 1);
  for (int j = 0; j < d->q.n; j++) {
    if (!d->q.at[j].carries || d->q.at[j].fixed_by >= 0) continue;
    int row = rows++;
    if (row < d->page->lagrange1_numbers.n && pl_has_symbol(d->pool, e, d->q.at[j].a))
      number[n++] = d->page->lagrange1_numbers.at[row];
  }
  if (n == 0 || rows != d->page->lagrange1_numbers.n)
    return refs_form(d, d->page->lagrange1_numbers.at, d->page->lagrange1_numbers.n);
  return n == 1 ? pl_fref(d, number[0]) : refs_form(d, number, n);
}

static void show_twice_differentiated(pl_analysis* d, int k) {
  const pl_bond* l = &d->g.at[k];
  const pl_form* zero = pl_form_leaf(d->arena, pl_int(d->pool, 0));
  pl_expr gdd = pl_on_fixed(d, pl_bond_acceleration(d, k));
  pl_say(d, PL_BOTH(l->velocity ? "The time derivative of {1}:" : "Two time derivatives of {1}:"),
         1, pl_fn(d, l->source->name.text));
  pl_why_differentiated(d, k);
  if (l->contact && l->fixes >= 0) {
    const pl_variable* c = &d->q.at[l->fixes];
    const pl_form* both[2] = {
        pl_feq(d, pl_fs(d, c->v), pl_fe(d, pl_dt(d->pool, c->fixed))),
        pl_feq(d, pl_fs(d, c->a), pl_fe(d, pl_dt(d->pool, pl_dt(d->pool, c->fixed))))};
    d->page->number_gdd = pl_show_numbered(d, pl_flist(d, both, 2))->number;
    return;
  }
  d->page->number_gdd =
      pl_show_numbered(d, pl_feq(d, pl_f(d, pl_alg_normal(d->tower, gdd), PL_S_EQUATION), zero))
          ->number;
  pl_claim_that(d, PL_CLAIM_MOTION, gdd, pl_int(d->pool, 0));
  pl_expr inserted;
  if (d->page->lagrange1_numbers.n == 0 || !insert_rows(d, pl_on_contact(d, gdd), &inserted))
    return;
  if (pl_op_count(d->pool, inserted) > 60) return;
  pl_say(d, PL_BOTH("{1} inserted into {2}:"), 2, refs_of_accelerations(d, gdd),
         pl_fref(d, d->page->number_gdd));
  pl_show(d, pl_feq(d, by_multipliers(d, inserted), zero));
  pl_claim_that(d, PL_CLAIM_MOTION, inserted, pl_int(d->pool, 0));
  pl_why_multiplier(d, k, inserted);
}

// A line that follows from the equations of motion and one more: as many as a step can name.
static void refer_to_equations(pl_analysis* d, pl_step* step, int more) {
  for (int k = 0; k < d->page->lagrange1_numbers.n; k++)
    pl_step_refs(step, 1, d->page->lagrange1_numbers.at[k]);
  pl_step_refs(step, 1, more);
}

// operations up to which a multiplier is written out in the text
static const long longest_lambda = 150;
static const long longest_beside = 40;  // likewise, when another one has been shown over names
// of the normal form, up to which a shorter one is looked for
static const long longest_searched = 1500;

// λ with the state eliminated, displayed with its number.
// Where the closed form is too long to read: one equation of motion, solved for it.
static void show_row(pl_analysis* d, int k) {
  int i;
  pl_expr row = pl_multiplier_by_row(d, k, &i);
  if (pl_is_poison(row)) return;
  const pl_form* form = pl_positive_first(d, pl_f(d, row, PL_S_QUOTIENT));
  if (pl_form_ops(form) > longest_lambda) return;
  pl_say(d, PL_BOTH("From the equation of {1}:"), 1, pl_fs(d, d->q.at[i].q));
  d->page->lambda_number[k] = d->page->number_lambda =
      pl_show_numbered(d, pl_feq(d, pl_fs(d, d->g.at[k].lambda), form))->number;
  pl_claim_that(d, PL_CLAIM_MOTION, pl_form_value(d->pool, form),
                pl_sym(d->pool, d->g.at[k].lambda));
}

static void show_lambda(pl_analysis* d, int k) {
  pl_bond* l = &d->g.at[k];
  bool solved = l->lambda_known,
       long_at_sight = solved && pl_op_count(d->pool, l->lambda_value) > longest_searched;
  if ((!solved || long_at_sight)
      && pl_show_structured(d, l->lambda, solved ? l->lambda_value : pl_poison())) {
    d->page->section->values.at[d->page->section->values.n - 1].of = l->source->name.text;
    return;
  }
  if (!solved) {
    pl_say(d, PL_BOTH("{1} is not determined by the equations in closed form."), 1,
           pl_fs(d, l->lambda));
    d->page->section->not_found = true;
    return;
  }
  const pl_form* form = pl_positive_first(
      d, pl_f(d, l->lambda_value, l->contact ? PL_S_EQUATION : PL_S_QUOTIENT));
  bool beside = pl_structure_is_told(d) && l->fixes < 0;  // the names are there
  if (pl_form_ops(form) > (beside ? longest_beside : longest_lambda)
      && pl_show_structured(d, l->lambda, l->lambda_value)) {
    d->page->section->values.at[d->page->section->values.n - 1].of = l->source->name.text;
    return;
  }
  if (pl_form_ops(form) > longest_lambda) {
    show_row(d, k);
    pl_say(
        d,
        PL_BOTH_FORMAT(d->arena,
                       "The linear equations for the multipliers and accelerations are solved; {1} "
                       "takes %ld operations to write "
                       "and stands in the JSON answer.",
                       pl_form_ops(form)),
        1, pl_fs(d, l->lambda));
  } else {
    pl_step* step = pl_show_numbered(d, pl_feq(d, pl_fs(d, l->lambda), form));
    d->page->lambda_number[k] = d->page->number_lambda = step->number;
    refer_to_equations(d, step, d->page->number_gdd);
    bool known;
    pl_step_value(d, step, l->lambda_value, pl_dimension_of_expr(d, l->lambda_value, &known));
    pl_say_pole_at_start(d, pl_fs(d, l->lambda), l->lambda_value);
  }
  pl_claim_that(d, PL_CLAIM_MOTION, pl_form_value(d->pool, form), pl_sym(d->pool, l->lambda));
  pl_value* v = pl_answer(d, pl_symbol_get(d->pool, l->lambda)->ascii, l->lambda_value, form);
  v->of = l->source->name.text;
}

static void solve_lambda(pl_analysis* d, int k) {
  if (pl_say_shared(d, k)) return;
  if (pl_structure_is_told(d) && d->g.at[k].fixes < 0) {
    show_lambda(d, k);
    return;
  }
  if (d->g.at[k].fixes < 0 || d->g.at[k].contact) {
    show_twice_differentiated(d, k);
  } else {
    pl_say(
        d,
        PL_BOTH("{1} was dropped; its multiplier is what the equation of its coordinate leaves:"),
        1, pl_fn(d, d->g.at[k].source->name.text));
  }
  show_lambda(d, k);
}

// ----------------------------------------------------------------------------------- accelerations
static void show_acceleration(pl_analysis* d, int i) {
  const pl_form* form = pl_f(d, d->acceleration[i], PL_S_QUOTIENT);
  pl_step* step = pl_show_numbered(d, pl_feq(d, pl_fs(d, d->q.at[i].a), form));
  d->page->number_acceleration = step->number;
  refer_to_equations(d, step, d->page->number_lambda);
  bool known;
  pl_step_value(d, step, d->acceleration[i], pl_dimension_of_expr(d, d->acceleration[i], &known));
  pl_say_pole_at_start(d, pl_fs(d, d->q.at[i].a), d->acceleration[i]);
  pl_claim_that(d, PL_CLAIM_MOTION, pl_form_value(d->pool, form), pl_sym(d->pool, d->q.at[i].a));
}

static bool no_acceleration(pl_analysis* d, int i) {
  if (d->solved && i >= 0 && !pl_is_poison(d->acceleration[i])) return false;
  pl_say(d, PL_BOTH("No closed form was found for it."), 0);
  d->page->section->not_found = true;
  return true;
}

// Too long to be written out: over named intermediates.
static bool long_acceleration(pl_analysis* d, int i) {
  pl_expr a = d->acceleration[i];
  bool known = d->solved && !pl_is_poison(a);
  if (known && pl_op_count(d->pool, a) <= longest_searched
      && pl_form_ops(pl_f(d, a, PL_S_QUOTIENT)) <= longest_lambda)
    return false;
  return pl_show_structured(d, d->q.at[i].a, known ? a : pl_poison());
}

// The multipliers that have been shown and stand in the equation of coordinate i.
static void say_inserted(pl_analysis* d, int i) {
  int row = 0, n = 0, *number = PL_ARRAY(d->arena, int, d->g.n + 1);
  for (int j = 0; j < i; j++) row += d->q.at[j].carries && d->q.at[j].fixed_by < 0;
  for (int k = 0; k < d->g.n; k++) {
    bool stands = !pl_is_zero_node(d->pool, pl_on_fixed(d, d->g.at[k].gradient[i]));
    if (stands && d->page->lambda_number[k] > 0) number[n++] = d->page->lambda_number[k];
  }
  if (n == 0 || row >= d->page->lagrange1_numbers.n) return;
  pl_say(d, PL_BOTH("{1} inserted into {2}:"), 2,
         n == 1 ? pl_fref(d, number[0]) : refs_form(d, number, n),
         pl_fref(d, d->page->lagrange1_numbers.at[row]));
}

// ---------------------------------------------------------------------------------- closed motions
// The general solution keeps x(0) and x'(0) as names, whatever `init` says.
static pl_expr start_of(pl_analysis* d, pl_symbol s) {
  return pl_sym(d->pool, pl_symbol_start(d->pool, s));
}

// The solution inserted into the equation, together with those of the coordinates it hangs on, and
// its start:
// x(t)'' - x''(x, x') = 0, x(0) = x0.
static void claim_motion(pl_analysis* d, int i, pl_expr x) {
  pl_symbol t = pl_time(d->pool);
  pl_expr v = pl_diff(d->pool, x, t), a = pl_diff(d->pool, v, t),
          rest = pl_on_special(d, d->acceleration[i]);
  pl_replace* r = PL_ARRAY(d->arena, pl_replace, 2 * d->q.n);
  int n = 0;
  for (int j = 0; j < d->q.n; j++) {
    const pl_variable* c = &d->q.at[j];
    if (j != i && !pl_has_symbol(d->pool, rest, c->q) && !pl_has_symbol(d->pool, rest, c->v))
      continue;
    pl_expr other = j == i ? x : pl_linear_motion(d, j, NULL, NULL);
    r[n++] = (pl_replace){c->q, other};
    r[n++] = (pl_replace){c->v, pl_diff(d->pool, other, t)};
  }
  pl_claim_free(d, PL_CLAIM_INSERTED, a, pl_subst(d->pool, rest, r, n));
  pl_expr zero = pl_int(d->pool, 0);
  pl_claim_free(d, PL_CLAIM_INSERTED, pl_subst1(d->pool, x, t, zero), start_of(d, d->q.at[i].q));
  pl_claim_free(d, PL_CLAIM_INSERTED, pl_subst1(d->pool, v, t, zero), start_of(d, d->q.at[i].v));
}

static const pl_form* of_time(pl_analysis* d, int i) {
  return pl_fn(d, pl_format(d->arena, "%s(t)", pl_symbol_get(d->pool, d->q.at[i].q)->name));
}

// The name x1(t) where it stands inside a formula.
static pl_symbol function_of_time(pl_analysis* d, int i) {
  pl_symbol_info info = *pl_symbol_get(d->pool, d->q.at[i].q);
  info.name = pl_format(d->arena, "%s(t)", info.name);
  info.ascii = pl_format(d->arena, "%s(t)", info.ascii);
  info.role = PL_R_LOCAL;
  info.base = info.up = (pl_symbol){0};
  return pl_symbol_make(d->pool, &info);
}

// Coordinates that hang on i alone by the map: x2(t) = l - x1(t).
static void show_followers(pl_analysis* d, int i) {
  for (int j = 0; j < d->q.n; j++) {
    const pl_variable* c = &d->q.at[j];
    if (j == i || c->fixed_by >= 0 || pl_is_poison(c->map)
        || !pl_has_symbol(d->pool, c->map, d->q.at[i].q))
      continue;
    pl_expr shown = pl_subst1(d->pool, c->map, d->q.at[i].q,
                              pl_sym(d->pool, function_of_time(d, i)));
    pl_show(d, pl_feq(d, of_time(d, j), pl_f(d, shown, PL_S_SOLUTION)));
  }
}

static void why_integrated(pl_analysis* d, int i, pl_expr x) {
  pl_linear_equation l;
  if (!pl_linear_equation_of(d, i, &l)) {
    pl_why_linear_motion(d, i);
  } else if (pl_is_zero_node(d->pool, l.B) && pl_is_zero_node(d->pool, l.C)) {
    pl_why_uniform(d, i, x);
  } else {
    pl_why_linear(d, i, l.A, l.B, l.C);
  }
}

static bool fades_or_grows(pl_analysis* d, pl_expr e) {
  if (pl_kind_of(d->pool, e) == PL_CALL && pl_function_of(d->pool, e) == PL_EXP) return true;
  for (int k = 0; k < pl_n_args(d->pool, e); k++)
    if (fades_or_grows(d, pl_arg(d->pool, e, k))) return true;
  return false;
}

static int add_terms(const pl_form* f, const pl_form** term, int n, int max) {
  if (f->kind != PL_F_SUM) {
    if (n < max) term[n] = f;
    return n + 1;
  }
  for (int k = 0; k < f->n; k++) n = add_terms(f->args[k], term, n, max);
  return n;
}

// With exponentials a motion is clearer as a sum over its poles (what is driven, what fades), else
// where that is shorter.
static const pl_form* form_of_motion(pl_analysis* d, pl_expr x, const pl_laplace_poles* poles) {
  enum { most = 48 };
  const pl_form *whole = pl_f(d, x, PL_S_SOLUTION), *term[most];
  int n = 0, parts = 0;
  for (int k = 0; k < poles->n; k++) {
    if (pl_is_zero_node(d->pool, poles->at[k].part)) continue;
    n = add_terms(pl_f(d, poles->at[k].part, PL_S_SOLUTION), term, n, most);
    parts++;
  }
  if (parts < 2 || n > most) return whole;
  const pl_form* sum = pl_form_sum(d->arena, term, n);
  return fades_or_grows(d, x) || pl_form_ops(sum) < pl_form_ops(whole) ? sum : whole;
}

// At rest where the force is not Lipschitz: rest, or a motion that leaves after any time.
static bool solve_escape(pl_analysis* d, int i) {
  pl_symbol wait;
  pl_expr x = d->gen.n == 1 && d->gen.at[0] == i ? pl_escape_motion(d, &wait) : pl_poison();
  if (pl_is_poison(x)) return false;
  const pl_form* form = pl_f(d, x, PL_S_PLAIN);
  const pl_form* zero = pl_form_leaf(d->arena, pl_int(d->pool, 0));
  pl_say(d, PL_BOTH("The motion is not unique: rest is one, and for every {1} so is, from {2} on,"),
         2, pl_frel(d, pl_fs(d, wait), "≥", zero),
         pl_feq(d, pl_fs(d, pl_time(d->pool)), pl_fs(d, wait)));
  pl_show_numbered(d, pl_feq(d, of_time(d, i), form));
  pl_symbol t = pl_time(d->pool);
  pl_expr rest = pl_subst1(d->pool, d->acceleration[i], d->q.at[i].q, x);
  pl_claim_free(d, PL_CLAIM_INSERTED,
                pl_square(d->pool, pl_diff(d->pool, pl_diff(d->pool, x, t), t)),
                pl_square(d->pool, rest));
  pl_value* v = pl_answer(d, pl_symbol_get(d->pool, d->q.at[i].q)->ascii, x, form);
  const char** name = PL_ARRAY(d->arena, const char*, 1);
  name[0] = pl_symbol_get(d->pool, wait)->ascii;
  v->n_free = 1;
  v->free_names = name;
  v->branch = pl_format(d->arena, "t >= %s", name[0]);
  return true;
}

// x_i(t) of the generalized coordinate or of one whose equation stands alone; poison if none was
// found.
static pl_expr solve_own_motion(pl_analysis* d, int i) {
  if (no_acceleration(d, i)) return pl_poison();
  const pl_variable* c = &d->q.at[i];
  say_inserted(d, i);
  show_acceleration(d, i);
  pl_laplace_poles poles = {.n = 0};
  pl_expr x = pl_closed_motion(d, i, &poles);
  if (pl_is_poison(x) && solve_escape(d, i)) return x;
  if (pl_is_poison(x)) {
    pl_say(d, PL_BOTH("No elementary closed form of the motion was found."), 0);
    d->page->section->not_found = true;
    return x;
  }
  bool uniform_motion = !pl_has_coordinates(d, d->acceleration[i]);
  bool alone = d->gen.n == 1;
  pl_say(d,
         PL_BOTH(
             uniform_motion ? "Integrated twice:"
             : !alone
                 ? "Linear equations with constant coefficients; their solution through the start:"
                 : "A linear equation with constant coefficients; its solution through the start:"),
         0);
  pl_say_special(d);
  why_integrated(d, i, x);
  const pl_form* form = form_of_motion(d, x, &poles);
  pl_step_refs(pl_show_numbered(d, pl_feq(d, of_time(d, i), form)), 1,
               d->page->number_acceleration);
  claim_motion(d, i, pl_form_value(d->pool, form));
  pl_answer(d, pl_symbol_get(d->pool, c->q)->ascii, x, form);
  show_followers(d, i);
  pl_say_while(d, d->page->section->values.n - 1);
  return x;
}

// A coordinate that hangs on the generalized one: first that one's motion, then the map.
static void solve_by_map(pl_analysis* d, int i) {
  int leader = d->gen.at[0];
  pl_expr x = solve_own_motion(d, leader);
  if (pl_is_poison(x)) return;
  x = pl_alg_normal(d->tower, pl_subst1(d->pool, d->q.at[i].map, d->q.at[leader].q, x));
  const pl_form* form = pl_f(d, x, PL_S_SOLUTION);
  pl_show_numbered(d, pl_feq(d, of_time(d, i), form));
  pl_answer(d, pl_symbol_get(d->pool, d->q.at[i].q)->ascii, x, form);
  pl_assume_sides(d, d->page->section, d->page->section->values.n - 1);
}

// A coordinate that a constraint fixes: its value.
static void show_fixed(pl_analysis* d, int i) {
  const pl_variable* c = &d->q.at[i];
  const pl_form* form = pl_f(d, c->fixed, PL_S_SOLUTION);
  pl_say(d, PL_BOTH("{1} gives"), 1, pl_fn(d, d->g.at[c->fixed_by].source->name.text));
  pl_show_numbered(d, pl_feq(d, of_time(d, i), form));
  pl_claim_that(d, PL_CLAIM_MAP, pl_form_value(d->pool, form), pl_sym(d->pool, c->q));
  pl_answer(d, pl_symbol_get(d->pool, c->q)->ascii, c->fixed, form);
}

// A coordinate that the constraints make a function of time: nothing is left to integrate.
static bool prescribed_motion(pl_analysis* d, int i) {
  const pl_variable* c = &d->q.at[i];
  pl_expr x = d->reduced && pl_follower(d, i) < 0 ? c->map : pl_poison();
  if (pl_is_poison(x) || pl_has_coordinates(d, x)) return false;
  pl_say(d, PL_BOTH("The constraints prescribe it:"), 0);
  const pl_form* form = pl_f(d, x, PL_S_SOLUTION);
  pl_show_numbered(d, pl_feq(d, of_time(d, i), form));
  pl_claim_that(d, PL_CLAIM_MAP, pl_form_value(d->pool, form), pl_sym(d->pool, c->q));
  pl_answer(d, pl_symbol_get(d->pool, c->q)->ascii, x, form);
  return true;
}

static void solve_motion(pl_analysis* d, int i) {
  const pl_variable* c = &d->q.at[i];
  if (c->fixed_by >= 0) {
    show_fixed(d, i);
    return;
  }
  if (prescribed_motion(d, i)) return;
  bool hangs = !pl_is_poison(c->map) && c->solved_by != -2 && d->reduced && d->gen.n == 1
               && d->gen.at[0] != i;
  bool alone = d->solved && !pl_is_poison(d->acceleration[i])
               && !pl_has_coordinates(d, d->acceleration[i]);
  if (hangs && !alone) solve_by_map(d, i);
  else solve_own_motion(d, i);
}

// λ as a function of time: the closed motions inserted into it.
static void multiplier_of_time(pl_analysis* d, int k) {
  const pl_bond* l = &d->g.at[k];
  pl_expr e = l->lambda_known ? l->lambda_value : pl_poison();
  pl_symbol t = pl_time(d->pool);
  pl_replace* r = PL_ARRAY(d->arena, pl_replace, 2 * d->q.n);
  int n = 0;
  for (int j = 0; j < d->q.n && !pl_is_poison(e); j++) {
    const pl_variable* c = &d->q.at[j];
    if (!pl_has_symbol(d->pool, e, c->q) && !pl_has_symbol(d->pool, e, c->v)) continue;
    pl_expr x = pl_closed_motion(d, j, NULL);
    if (pl_is_poison(x)) e = x;
    r[n++] = (pl_replace){c->q, x};
    r[n++] = (pl_replace){c->v, pl_diff(d->pool, x, t)};
  }
  if (pl_is_poison(e)) {
    pl_say(d, PL_BOTH("No elementary closed form of the motion was found."), 0);
    d->page->section->not_found = true;
    return;
  }
  e = pl_alg_normal(d->tower, pl_subst(d->pool, pl_on_special(d, e), r, n));
  pl_say_special(d);
  const pl_symbol_info* s = pl_symbol_get(d->pool, l->lambda);
  const pl_form* form = pl_f(d, e, PL_S_SOLUTION);
  pl_show_numbered(d, pl_feq(d, pl_fn(d, pl_format(d->arena, "%s(t)", s->name)), form));
  pl_answer(d, s->ascii, e, form)->of = l->source->name.text;
  pl_say_while(d, d->page->section->values.n - 1);
}

// ------------------------------------------------------------------------------------- the section
void pl_answer_solve(pl_analysis* d, const pl_ask* ask) {
  bool goes_on = ask->letter && d->page->solution->sections.n > 0 && d->page->section->letter
                 && strcmp(d->page->section->letter, ask->letter) == 0;
  pl_symbol s = pl_kind_of(d->pool, ask->value) == PL_SYMBOL ? pl_symbol_of(d->pool, ask->value)
                                                             : (pl_symbol){0};
  int k = link_of_lambda(d, s), i = pl_variable_index(d, s);
  if (k >= 0 && ask->of_time) {
    pl_section_open(d, ask, PL_BOTH("Multiplier"));
    multiplier_of_time(d, k);
  } else if (k >= 0) {
    pl_section_open(d, ask, goes_on ? NULL : "Multiplier",
                    goes_on ? NULL : pl_german("Multiplier"));
    solve_lambda(d, k);
  } else if (i >= 0 && ask->of_time) {
    pl_section_open(d, ask, PL_BOTH("Motion"));
    solve_motion(d, i);
  } else if (i >= 0 && d->q.at[i].a.id == s.id) {
    pl_section_open(d, ask, PL_BOTH("Acceleration"));
    if (long_acceleration(d, i)) return;
    if (no_acceleration(d, i)) return;
    say_inserted(d, i);
    show_acceleration(d, i);
    pl_answer(d, pl_symbol_get(d->pool, s)->ascii, d->acceleration[i],
              pl_f(d, d->acceleration[i], PL_S_QUOTIENT));
  } else if (i >= 0) {
    pl_section_open(d, ask, PL_BOTH("Motion"));
    solve_motion(d, i);
  } else {
    pl_answer_pending(d, ask);
  }
}
