// answer_where: a quantity where conditions hold, `θ where λ = 0 from θ = 0 at rest`.
//
// Conditions of the form name = value are inserted.  One condition that is left is met on the motion: velocities are eliminated by
// its integrals (line.c), and of several solutions the one that the motion meets first is meant.  Two and more conditions, or a system
// without such integrals, are equations for the state: each is solved for a quantity that it contains, and all solutions count.
#include <math.h>

#include "derive/derive_impl.h"

enum { max_conditions = 8, max_solutions = 8 };

typedef struct pl_where {
  int n;                             // equations left
  pl_expr equation[max_conditions];  // each vanishes
  int n_pins;
  pl_replace pin[max_conditions];    // name = value
  pl_expr asked;
  bool on_line;                      // on the motion `line`
  pl_line line;
} pl_where;

// ---------------------------------------------------------------------------------------------- what is given
static bool is_state(pl_analysis* d, pl_symbol s) {
  int i = pl_variable_index(d, s);
  return i >= 0 && d->q.at[i].a.id != s.id && d->q.at[i].fixed_by < 0 && pl_is_poison(d->q.at[i].map);
}

// θ = α, or α = θ: a coordinate or velocity that is free, with a value.
static bool pin_of(pl_analysis* d, const pl_condition* c, pl_replace* out) {
  for (int side = 0; side < 2; side++) {
    pl_expr name = side ? c->right : c->left, value = side ? c->left : c->right;
    if (pl_kind_of(d->pool, name) != PL_SYMBOL || !is_state(d, pl_symbol_of(d->pool, name))) continue;
    if (pl_has_coordinates(d, value) || pl_has_role(d->pool, value, PL_R_MULTIPLIER)) continue;
    *out = (pl_replace){pl_symbol_of(d->pool, name), value};
    return true;
  }
  return false;
}

static pl_expr on_motion(pl_analysis* d, pl_expr e) { return pl_on_motion(d, pl_with_results(d, e)); }

static bool collect(pl_analysis* d, const pl_ask* ask, pl_where* p) {
  if (ask->where.n > max_conditions) return false;
  for (int k = 0; k < ask->where.n; k++) {
    const pl_condition* c = &ask->where.at[k];
    pl_replace pin;
    bool pinned = pin_of(d, c, &pin);
    for (int j = 0; j < p->n_pins && pinned; j++) pinned = p->pin[j].from.id != pin.from.id;   // twice: an equation
    if (pinned) {
      p->pin[p->n_pins] = pin;
      p->n_pins++;
    } else {
      p->equation[p->n++] = on_motion(d, pl_sub(d->pool, c->left, c->right));
    }
  }
  p->asked = on_motion(d, ask->value);
  bool named = ask->motion.given;
  p->on_line = (named || ask->where.n == 1) && pl_line_of(d, &ask->motion, &p->line);
  return true;
}

// Velocities of the motion first, the given values then.
static pl_expr at_place(pl_analysis* d, const pl_where* p, pl_expr e) {
  pl_replace pins[max_conditions];
  int n = 0;
  for (int k = 0; k < p->n_pins; k++) {
    bool velocity = pl_symbol_get(d->pool, p->pin[k].from)->role == PL_R_VELOCITY;
    if (p->on_line && velocity) e = pl_subst1(d->pool, e, p->pin[k].from, p->pin[k].to);
    else pins[n++] = p->pin[k];
  }
  if (p->on_line && pl_has_role(d->pool, e, PL_R_VELOCITY)) e = pl_along_line(d, &p->line, e);
  return pl_alg_normal(d->tower, pl_subst(d->pool, e, pins, n));
}

// A velocity of the motion that is given too is one more equation, v^2(q) = value^2.
static void pins_of_the_motion(pl_analysis* d, pl_where* p) {
  for (int k = 0; k < p->n_pins && p->on_line; k++) {
    if (p->pin[k].from.id != d->q.at[p->line.i].v.id || p->n == max_conditions) continue;
    p->equation[p->n++] = pl_sub(d->pool, p->line.v2, pl_square(d->pool, p->pin[k].to));
  }
}

// ---------------------------------------------------------------------------------------------- which unknown
// What an equation is solved for: what is asked, if it is a name; a velocity or coordinate that what is asked contains; any other.
static int rank_of(pl_analysis* d, const pl_where* p, pl_symbol s) {
  const pl_symbol_info* info = pl_symbol_get(d->pool, s);
  if (pl_same(p->asked, pl_sym(d->pool, s))) return 6;
  int needed = pl_has_symbol(d->pool, p->asked, s) ? 2 : 0;
  if (info->role == PL_R_VELOCITY) return 3 + needed;
  if (info->role == PL_R_COORD) return 2 + needed;
  if (info->role == PL_R_PARAM) return needed ? 1 : -1;
  return s.id == pl_time(d->pool).id ? 1 : -1;
}

static bool unknown_of(pl_analysis* d, const pl_where* p, pl_expr e, pl_symbol* out) {
  if (p->on_line && pl_has_symbol(d->pool, e, d->q.at[p->line.i].q)) {
    *out = d->q.at[p->line.i].q;
    return true;
  }
  enum { max_symbols = 64 };
  pl_symbol in[max_symbols];
  int n = pl_symbols_in(d->pool, e, in, max_symbols), best = 0;
  for (int k = 0; k < n && k < max_symbols; k++) {
    int rank = rank_of(d, p, in[k]);
    if (rank <= best) continue;
    best = rank;
    *out = in[k];
  }
  return best > 0;
}

// ---------------------------------------------------------------------------------------------- the first one met
// Of several solutions the nearest to the start on the side the motion goes to; -1 when no number tells.
static int first_met(pl_analysis* d, const pl_line* l, const pl_root* root, int n) {
  double start = pl_number(d, l->q0), nearest = (double)INFINITY;
  int best = -1;
  if (isnan(start)) start = 0;
  for (int k = 0; k < n; k++) {
    double step = (pl_number(d, root[k].value) - start) * l->direction;
    if (isnan(step) || step <= 0 || step >= nearest) continue;
    best = k;
    nearest = step;
  }
  return best >= 0 ? best : n > 0 ? 0 : -1;
}

// e as a number where s has the value x and all else its given number.
static double number_at(pl_analysis* d, pl_expr e, pl_symbol s, double x) {
  pl_number(d, e);   // the table of numbers covers every name of e
  double kept = d->value[s.id];
  d->value[s.id] = x;
  double y = pl_eval(d->pool, e, d->value);
  d->value[s.id] = kept;
  return y;
}

// Where no closed form was found: the first change of sign on the way, by steps that grow from a thousandth of the scale, then by
// bisection.  NaN when there is none, or when some quantity has no number.
static double first_crossing(pl_analysis* d, pl_expr e, pl_symbol s, double start, int direction) {
  static const double growth = 1.01, first = 1e-4, farthest = 1e3;   // of the way, in the unit of the coordinate
  double scale = start != 0 ? fabs(start) : 1, a = start, fa = (double)NAN;
  if (scale > 1) scale = 1;
  for (double step = first * scale; step < farthest; step *= growth) {
    double b = start + direction * step, fb = number_at(d, e, s, b);
    if (isnan(fa) || isnan(fb) || (fa > 0) == (fb > 0)) {
      a = b;
      fa = fb;
      continue;
    }
    for (int k = 0; k < 200 && fb != 0; k++) {
      double m = 0.5 * (a + b), fm = number_at(d, e, s, m);
      if (m == a || m == b) break;
      if ((fm > 0) == (fa > 0)) a = m;
      else b = m;
    }
    return b;
  }
  return (double)NAN;
}

// ---------------------------------------------------------------------------------------------- display
static bool is_an_angle(pl_analysis* d, pl_expr e) {
  if (pl_kind_of(d->pool, e) != PL_CALL) return false;
  pl_function f = pl_function_of(d->pool, e);
  return f == PL_ACOS || f == PL_ASIN || f == PL_ATAN || f == PL_ATAN2;
}

static void show_root(pl_analysis* d, pl_expr name, pl_expr value, pl_expr condition) {
  const pl_form* form = pl_f(d, value, PL_S_PLAIN);
  bool angle = is_an_angle(d, value);
  if (angle) {
    const pl_form* inside = pl_fe(d, name);
    const pl_form* inverse = pl_form_call(d->arena, pl_function_of(d->pool, value) == PL_ASIN ? PL_SIN : PL_COS, &inside, 1);
    pl_function f = pl_function_of(d->pool, value);
    if (f == PL_ACOS || f == PL_ASIN) pl_show_numbered(d, pl_feq(d, inverse, pl_f(d, pl_arg(d->pool, value, 0), PL_S_QUOTIENT)));
  }
  pl_step* step = pl_show(d, pl_feq(d, pl_fe(d, name), form));
  double x = pl_number(d, value);
  pl_value* v = pl_answer(d, pl_expr_text(d->arena, d->pool, name), value, form);
  if (!pl_is_poison(condition)) v->exists_if = pl_format(d->arena, "%s >= 0", pl_expr_text(d->arena, d->pool, condition));
  if (isnan(x)) return;
  if (!angle) {
    bool known;
    pl_dimension dim = pl_dimension_of_expr(d, name, &known);
    if (known) v->unit = pl_dimension_unit(d->arena, dim, true);
    step->has_value = !pl_is_number(d->pool, value);
    step->value = x;
    step->unit = known ? pl_dimension_unit(d->arena, dim, false) : "";
    return;
  }
  step->has_value = true;
  step->value = x * 180 / M_PI;
  step->unit = "°";
  v->unit = "rad";
  v->display = pl_display(d, x, pl_dimension_one(), true);
}

static void say_independent(pl_analysis* d, pl_expr value) {
  if (!pl_is_constant(d->pool, value) || d->model->params.n == 0) return;
  const pl_form** f = PL_ARRAY(d->arena, const pl_form*, d->model->params.n);
  int n = 0;
  for (int k = 0; k < d->model->params.n; k++)
    if (!d->model->params.at[k].literal) f[n++] = pl_fs(d, d->model->params.at[k].symbol);
  if (n) pl_say(d, "independent of {1}", "unabhängig von {1}", 1, pl_flist(d, f, n));
}

static void show_condition(pl_analysis* d, const pl_ask* ask, pl_expr e) {
  const pl_form** f = PL_ARRAY(d->arena, const pl_form*, ask->where.n + 1);
  for (int k = 0; k < ask->where.n; k++) f[k] = pl_feq(d, pl_fe(d, ask->where.at[k].left), pl_fe(d, ask->where.at[k].right));
  pl_say(d, ask->where.n == 1 ? "Condition {1}:" : "Conditions {1}:", ask->where.n == 1 ? "Bedingung {1}:" : "Bedingungen {1}:", 1,
         pl_flist(d, f, ask->where.n));
  pl_show(d, pl_feq(d, pl_f(d, e, PL_S_QUOTIENT), pl_form_leaf(d->arena, pl_int(d->pool, 0))));
}

// ---------------------------------------------------------------------------------------------- on the motion
static void numerical(pl_analysis* d, const pl_ask* ask, const pl_where* p, pl_expr e, pl_symbol s, bool complete) {
  bool time = s.id == pl_time(d->pool).id;
  double start = time ? 0 : pl_number(d, p->line.q0), x = (double)NAN;
  if (!isnan(start)) x = first_crossing(d, e, s, start, time ? 1 : p->line.direction);
  if (isnan(x)) {
    pl_say(d, complete ? "This never happens on the motion." : "No solution in closed form was found.",
           complete ? "Das tritt auf der Bewegung nicht ein." : "Eine geschlossene Lösung wurde nicht gefunden.", 0);
    d->section->not_found = !complete;
    return;
  }
  pl_say(d, "No solution in closed form was found; for the given numbers:",
         "Eine geschlossene Lösung wurde nicht gefunden; mit den gegebenen Zahlen:", 0);
  pl_expr asked = at_place(d, p, p->asked);
  double y = number_at(d, asked, s, x);
  pl_notation how = {.math = PL_MATH_LINE, .lang = d->job->lang};
  bool known;
  pl_dimension dim = pl_dimension_of_expr(d, ask->value, &known);
  const char* unit = known ? pl_dimension_unit(d->arena, dim, false) : "";
  const char* text = pl_format(d->arena, "%s%s%s", pl_notation_number(d->arena, y, 10, how), *unit && *unit != '1' ? " " : "", *unit != '1' ? unit : "");
  pl_show(d, pl_feq(d, pl_fe(d, ask->value), pl_fn(d, text)));
  pl_value* v = pl_answer(d, pl_expr_text(d->arena, d->pool, ask->value), pl_poison(), NULL);
  v->number = y;
  if (known) v->unit = pl_dimension_unit(d->arena, dim, true);
  d->section->not_found = true;
}

static void on_the_way(pl_analysis* d, const pl_ask* ask, const pl_where* p, pl_expr e, pl_symbol s) {
  pl_root root[max_solutions];
  bool complete = false;
  int n = pl_alg_roots(d->tower, e, s, root, max_solutions, &complete);
  int k = p->on_line ? first_met(d, &p->line, root, n) : -1;
  if (k < 0) {
    numerical(d, ask, p, e, s, complete);
    return;
  }
  pl_claim_free(d, PL_CLAIM_INSERTED, pl_subst1(d->pool, e, s, root[k].value), pl_int(d->pool, 0));
  pl_expr value = pl_alg_normal(d->tower, pl_subst1(d->pool, at_place(d, p, p->asked), s, root[k].value));
  show_root(d, ask->value, value, pl_poison());
  say_independent(d, value);
}

// ---------------------------------------------------------------------------------------------- of the state
typedef struct pl_found { pl_expr value[max_solutions], condition[max_solutions]; int n; bool complete; } pl_found;

static void keep(pl_analysis* d, pl_found* f, pl_expr value, pl_expr condition) {
  value = pl_alg_normal(d->tower, value);
  for (int k = 0; k < f->n; k++) {
    if (pl_alg_equal(d->tower, f->value[k], value) == PL_YES) return;
  }
  if (f->n == max_solutions) return;
  f->condition[f->n] = condition;
  f->value[f->n++] = value;
}

// A given quantity that is positive, a stiffness, has no solution 0 or below.
static bool excluded(pl_analysis* d, pl_symbol s, pl_expr value) {
  int own = 0, sign = 0;
  if (pl_symbol_get(d->pool, s)->role != PL_R_PARAM) return false;
  if (pl_alg_sign(d->tower, pl_sym(d->pool, s), false, &own) != PL_YES || own <= 0) return false;
  return pl_alg_sign(d->tower, value, true, &sign) == PL_YES && sign <= 0;
}

// Equation after equation, each solved for one quantity and inserted into the others; solutions multiply.
static void solve_rest(pl_analysis* d, const pl_where* p, int k, pl_expr condition, pl_found* out) {
  if (k == p->n) {
    keep(d, out, p->asked, condition);
    return;
  }
  pl_expr e = pl_alg_normal(d->tower, p->equation[k]);
  pl_symbol s;
  if (pl_alg_is_zero(d->tower, e) == PL_YES) {
    solve_rest(d, p, k + 1, condition, out);
    return;
  }
  if (!unknown_of(d, p, e, &s)) return;   // a contradiction, or nothing to solve for
  pl_root root[max_solutions];
  bool complete = false;
  int n = pl_alg_roots(d->tower, e, s, root, max_solutions, &complete);
  out->complete &= complete;
  for (int r = 0; r < n; r++) {
    if (excluded(d, s, root[r].value)) continue;
    pl_claim_free(d, PL_CLAIM_INSERTED, pl_subst1(d->pool, e, s, root[r].value), pl_int(d->pool, 0));
    pl_where next = *p;
    for (int j = 0; j < p->n; j++) next.equation[j] = pl_subst1(d->pool, p->equation[j], s, root[r].value);
    next.asked = pl_subst1(d->pool, p->asked, s, root[r].value);
    solve_rest(d, &next, k + 1, pl_is_poison(root[r].condition) ? condition : root[r].condition, out);
  }
}

static void of_the_state(pl_analysis* d, const pl_ask* ask, const pl_where* p) {
  pl_found found = {.complete = true};
  solve_rest(d, p, 0, pl_poison(), &found);
  for (int k = 0; k < found.n; k++) {
    if (pl_say_unsolved(d, ask->value, found.value[k])) return;
    pl_expr condition = found.condition[k];
    int sign;
    if (!pl_is_poison(condition) && pl_alg_sign(d->tower, condition, true, &sign) == PL_YES) condition = pl_poison();
    show_root(d, ask->value, found.value[k], condition);
    say_independent(d, found.value[k]);
  }
  if (found.n > 0) return;
  pl_say(d, found.complete ? "No state satisfies this." : "No solution in closed form was found.",
         found.complete ? "Kein Zustand erfüllt das." : "Eine geschlossene Lösung wurde nicht gefunden.", 0);
  d->section->not_found = !found.complete;
}

// ---------------------------------------------------------------------------------------------- the section
void pl_answer_where(pl_analysis* d, const pl_ask* ask) {
  pl_where p = {0};
  if (!collect(d, ask, &p)) {
    pl_answer_pending(d, ask);
    return;
  }
  pins_of_the_motion(d, &p);
  for (int k = 0; k < p.n; k++) {
    p.equation[k] = at_place(d, &p, p.equation[k]);
    if (pl_say_unsolved(d, ask->value, p.equation[k])) return;
  }
  if (p.n > 0) show_condition(d, ask, p.equation[0]);
  pl_symbol s;
  bool motion = p.n == 1 && unknown_of(d, &p, p.equation[0], &s) &&
                ((p.on_line && s.id == d->q.at[p.line.i].q.id) || s.id == pl_time(d->pool).id);
  if (motion) {
    on_the_way(d, ask, &p, p.equation[0], s);
    return;
  }
  p.asked = at_place(d, &p, p.asked);
  of_the_state(d, ask, &p);
}
