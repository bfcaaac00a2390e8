// answer_where: a quantity where conditions hold, `θ where λ = 0 from θ = 0 at rest`.
//
// A given quantity that a condition names, `m3 = m1 + m2`, is inserted everywhere. One condition on
// the motion is met on it: along
// the coordinate that its integrals leave (line.c), else along time where the motion is known in
// closed form, else in numbers
// (where_met.c, where_follow.c). Two and more conditions, or a motion of which nothing is known,
// are equations for the state: each is
// solved for a quantity that it contains, and all solutions count.
#include <math.h>
#include <string.h>

#include "mechanics/equilibria.h"
#include "where_impl.h"

enum { max_conditions = 8, max_solutions = 8 };

typedef struct pl_where {
  const pl_ask* ask;
  int n;                             // equations left
  pl_expr equation[max_conditions];  // each vanishes
  int n_pins;
  pl_replace pin[max_conditions];  // name = value
  int n_given;
  pl_replace given[max_conditions];  // given quantity = value
  pl_expr asked;
  bool on_line;  // on the motion `line`
  bool several;  // conditions besides those for given quantities
  pl_line line;
} pl_where;

// ----------------------------------------------------------------------------------- what is given
static bool is_state(pl_analysis* d, pl_symbol s) {
  int i = pl_variable_index(d, s);
  return i >= 0 && d->q.at[i].a.id != s.id && d->q.at[i].fixed_by < 0
         && pl_is_poison(d->q.at[i].map);
}

// θ = α, or α = θ: a coordinate or velocity that is free, with a value.
static bool pin_of(pl_analysis* d, const pl_condition* c, pl_replace* out) {
  for (int side = 0; side < 2; side++) {
    pl_expr name = side ? c->right : c->left, value = side ? c->left : c->right;
    if (pl_kind_of(d->pool, name) != PL_SYMBOL || !is_state(d, pl_symbol_of(d->pool, name)))
      continue;
    if (pl_has_coordinates(d, value) || pl_has_role(d->pool, value, PL_R_MULTIPLIER)) continue;
    *out = (pl_replace){pl_symbol_of(d->pool, name), value};
    return true;
  }
  return false;
}

static bool is_given(pl_analysis* d, pl_expr e) {
  bool motion = pl_has_coordinates(d, e) || pl_has_role(d->pool, e, PL_R_MULTIPLIER)
                || pl_has_role(d->pool, e, PL_R_LOCAL);
  return !motion && !pl_has_symbol(d->pool, e, pl_time(d->pool));
}

// A number that stands in a formula with its unit.
static bool is_literal(const pl_analysis* d, pl_symbol s) {
  const pl_param* p = pl_model_param(d->model, s);
  return p && p->literal;
}

// m3 = m1 + m2: the name on the left, else the one on the right; not what is asked for, which is
// solved for.
static bool given_of(pl_analysis* d, const pl_ask* ask, const pl_condition* c, pl_replace* out) {
  if (!is_given(d, c->left) || !is_given(d, c->right)) return false;
  for (int side = 0; side < 2; side++) {
    pl_expr name = side ? c->right : c->left, value = side ? c->left : c->right;
    if (pl_kind_of(d->pool, name) != PL_SYMBOL) continue;
    pl_symbol s = pl_symbol_of(d->pool, name);
    if (pl_symbol_get(d->pool, s)->role != PL_R_PARAM || is_literal(d, s)
        || pl_has_symbol(d->pool, value, s))
      continue;
    if (pl_same(ask->value, name)) return false;
    *out = (pl_replace){s, value};
    return true;
  }
  return false;
}

// Abbreviations that contain the name are written out first.
static pl_expr with_given(pl_analysis* d, const pl_where* p, pl_expr e) {
  for (int k = 0; k < p->n_given; k++) {
    for (int j = d->model->lets.n - 1; j >= 0; j--) {
      const pl_let* l = &d->model->lets.at[j];
      if (l->inserted || l->n_args > 0 || !pl_has_symbol(d->pool, l->value, p->given[k].from))
        continue;
      e = pl_subst1(d->pool, e, l->symbol, l->value);
    }
    e = pl_subst1(d->pool, e, p->given[k].from, p->given[k].to);
  }
  return e;
}

static pl_expr on_motion(pl_analysis* d, const pl_where* p, pl_expr e) {
  return with_given(d, p, pl_on_motion(d, pl_with_results(d, e)));
}

static void insert_into_line(pl_analysis* d, const pl_where* p, pl_line* l) {
  if (p->n_given == 0) return;
  l->v2 = pl_alg_normal(d->tower, with_given(d, p, l->v2));
  l->q0 = with_given(d, p, l->q0);
  l->v0 = with_given(d, p, l->v0);
  for (int k = 0; k < l->n; k++) l->velocity[k].to = with_given(d, p, l->velocity[k].to);
}

// The asked quantity is given, and only the start of the motion contains it: v0.
static bool asks_for_the_start(pl_analysis* d, const pl_where* p) {
  if (pl_kind_of(d->pool, p->asked) != PL_SYMBOL) return false;
  pl_symbol s = pl_symbol_of(d->pool, p->asked);
  for (int k = 0; k < p->n; k++) {
    if (pl_has_symbol(d->pool, p->equation[k], s)) return false;
  }
  return pl_has_symbol(d->pool, p->line.v2, s) || pl_has_symbol(d->pool, p->line.q0, s)
         || pl_has_symbol(d->pool, p->line.v0, s);
}

static bool collect(pl_analysis* d, const pl_ask* ask, pl_where* p) {
  if (ask->where.n > max_conditions) return false;
  p->ask = ask;
  bool is_inserted[max_conditions] = {false};
  for (int k = 0; k < ask->where.n; k++) {
    is_inserted[k] = given_of(d, ask, &ask->where.at[k], &p->given[p->n_given]);
    p->n_given += is_inserted[k];
  }
  int n = ask->where.n - p->n_given;
  p->several = n > 1;
  for (int k = 0; k < ask->where.n; k++) {
    const pl_condition* c = &ask->where.at[k];
    if (is_inserted[k]) continue;
    pl_replace pin;
    bool pinned = n > 1 && pin_of(d, c, &pin);  // a single one is met on the motion
    // twice: an equation
    for (int j = 0; j < p->n_pins && pinned; j++) pinned = p->pin[j].from.id != pin.from.id;
    if (pinned) {
      p->pin[p->n_pins] = (pl_replace){pin.from, with_given(d, p, pin.to)};
      p->n_pins++;
    } else {
      p->equation[p->n++] = on_motion(d, p, pl_sub(d->pool, c->left, c->right));
    }
  }
  p->asked = on_motion(d, p, ask->value);
  pl_number(d, p->asked);  // numbers of all names
  bool line = pl_line_of(d, &ask->motion, &p->line);
  p->on_line = line && (ask->motion.given || n == 1);
  if (line) insert_into_line(d, p, &p->line);
  if (line && !p->on_line && n > 1) p->on_line = asks_for_the_start(d, p);
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

// ----------------------------------------------------------------------------------- which unknown
// What an equation is solved for: what is asked, if it is a name; a velocity or coordinate that
// what is asked contains; any other.
static int rank_of(pl_analysis* d, const pl_where* p, pl_symbol s) {
  const pl_symbol_info* info = pl_symbol_get(d->pool, s);
  if (pl_same(p->asked, pl_sym(d->pool, s))) return 6;
  int needed = pl_has_symbol(d->pool, p->asked, s) ? 2 : 0;
  if (info->role == PL_R_VELOCITY) return 3 + needed;
  if (info->role == PL_R_COORD) return 2 + needed;
  // one on the motion: its number stands
  if (info->role == PL_R_PARAM) return needed && (p->several || isnan(d->value[s.id])) ? 1 : -1;
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
    if (rank <= best || is_literal(d, in[k])) continue;
    best = rank;
    *out = in[k];
  }
  return best > 0;
}

// ----------------------------------------------------------------------------------------- display
static bool is_an_angle(pl_analysis* d, pl_expr e) {
  if (pl_kind_of(d->pool, e) != PL_CALL) return false;
  pl_function f = pl_function_of(d->pool, e);
  return f == PL_ACOS || f == PL_ASIN || f == PL_ATAN || f == PL_ATAN2;
}

// The coordinate itself was asked for, and it is an angle.
static bool names_an_angle(pl_analysis* d, pl_expr name) {
  if (pl_kind_of(d->pool, name) != PL_SYMBOL) return false;
  int i = pl_variable_index(d, pl_symbol_of(d->pool, name));
  return i >= 0 && d->q.at[i].q.id == pl_symbol_of(d->pool, name).id && pl_is_angle(d, i);
}

bool pl_is_circular(pl_analysis* d, pl_expr name, pl_expr value) {
  if (pl_is_poison(value) || pl_is_constant(d->pool, name)) return false;
  if (pl_same(name, value)) return true;
  return pl_kind_of(d->pool, name) == PL_SYMBOL
         && pl_has_symbol(d->pool, value, pl_symbol_of(d->pool, name));
}

static void say_circular(pl_analysis* d, pl_expr name) {
  pl_say(
      d,
      PL_BOTH(
          "This cannot be answered: the conditions and the motion that is known give no equation "
          "from which {1} follows."),
      1, pl_fe(d, name));
  d->page->section->not_found = true;
}

static void say_independent(pl_analysis* d, pl_expr value) {
  if (pl_is_zero_node(d->pool, value)) return;  // nothing depends on nothing
  if (!pl_is_constant(d->pool, value) || pl_is_zero_node(d->pool, value) || d->model->params.n == 0)
    return;
  const pl_form** f = PL_ARRAY(d->arena, const pl_form*, d->model->params.n);
  int n = 0;
  for (int k = 0; k < d->model->params.n; k++)
    if (!d->model->params.at[k].literal) f[n++] = pl_fs(d, d->model->params.at[k].symbol);
  if (n) pl_say(d, PL_BOTH("independent of {1}"), 1, pl_flist(d, f, n));
}

// e >= 0 without factors that are positive anyway.
static pl_expr without_positive_factors(pl_analysis* d, pl_expr e) {
  enum { most_factors = 16 };
  pl_factor f[most_factors];
  pl_expr unit = pl_poison(), rest = pl_int(d->pool, 1);
  int n = pl_alg_factors(d->tower, e, f, most_factors, &unit), sign = 0;
  if (n < 0 || n > most_factors || pl_is_poison(unit)
      || pl_alg_sign(d->tower, unit, false, &sign) != PL_YES || sign == 0)
    return e;
  for (int k = 0; k < n; k++) {
    int own = 0;
    if (f[k].power % 2 == 0) continue;
    if (pl_alg_sign(d->tower, f[k].base, false, &own) == PL_YES && own != 0) sign *= own;
    else rest = pl_mul(d->pool, rest, f[k].base);
  }
  return sign < 0 ? pl_neg(d->pool, rest) : rest;
}

// "cos θ ≥ 0", "f ≤ 0"
static const pl_form* condition_form(pl_analysis* d, pl_expr condition) {
  const pl_form *f = pl_f(d, condition, PL_S_PLAIN),
                *zero = pl_form_leaf(d->arena, pl_int(d->pool, 0));
  return f->kind == PL_F_NEG ? pl_frel(d, f->args[0], "≤", zero) : pl_frel(d, f, "≥", zero);
}

void pl_show_met(pl_analysis* d, pl_expr name, pl_expr value, pl_expr condition) {
  if (pl_is_circular(d, name, value)) {
    say_circular(d, name);
    return;
  }
  const pl_form* form = pl_f(d, value, PL_S_PLAIN);
  bool inverse = is_an_angle(d, value), angle = inverse || names_an_angle(d, name);
  if (inverse) {
    const pl_form* inside = pl_fe(d, name);
    const pl_form* turned = pl_form_call(
        d->arena, pl_function_of(d->pool, value) == PL_ASIN ? PL_SIN : PL_COS, &inside, 1);
    pl_function f = pl_function_of(d->pool, value);
    if (f == PL_ACOS || f == PL_ASIN)
      pl_show_numbered(d, pl_feq(d, turned, pl_f(d, pl_arg(d->pool, value, 0), PL_S_QUOTIENT)));
  }
  pl_step* step = pl_show(d, pl_feq(d, pl_fe(d, name), form));
  double x = pl_number(d, value);
  pl_value* v = pl_answer(d, pl_expr_text(d->arena, d->pool, name), value, form);
  if (!pl_is_poison(condition)) {
    condition = without_positive_factors(d, condition);
    v->exists_if = pl_format(d->arena, "%s >= 0", pl_expr_text(d->arena, d->pool, condition));
    pl_say(d, PL_BOTH("if {1}"), 1, condition_form(d, condition));
  }
  say_independent(d, value);
  if (isnan(x)) return;
  if (!angle) {
    bool known;
    pl_dimension dim = pl_dimension_of_expr(d, name, &known);
    if (known) v->unit = pl_dimension_unit(d->arena, dim, true);
    if (known) v->display = pl_display(d, x, dim, false);
    step->has_value = !pl_is_number(d->pool, value);
    step->value = x;
    step->unit = known ? pl_dimension_unit(d->arena, dim, false) : "";
    return;
  }
  step->has_value = !pl_is_zero_node(d->pool, value);
  step->value = x * 180 / M_PI;
  step->unit = "°";
  v->unit = "rad";
  v->display = pl_display(d, x, pl_dimension_one(), true);
}

static pl_step* show_number(pl_analysis* d, pl_expr name, double x) {
  pl_notation how = {.math = PL_MATH_LINE, .lang = d->job->lang};
  bool known, angle = names_an_angle(d, name);
  pl_dimension dim = pl_dimension_of_expr(d, name, &known);
  const char* unit = known ? pl_dimension_unit(d->arena, dim, false) : "";
  bool plain = angle || !*unit || *unit == '1';
  const char* text = pl_format(d->arena, "%s%s%s",
                               pl_notation_number(d->arena, angle ? x * 180 / M_PI : x, 10, how),
                               angle   ? "°"
                               : plain ? ""
                                       : " ",
                               plain ? "" : unit);
  pl_step* step = pl_show(d, pl_feq(d, pl_fe(d, name), pl_fn(d, text)));
  pl_value* v = pl_answer(d, pl_expr_text(d->arena, d->pool, name), pl_poison(), NULL);
  v->number = x;
  if (known) v->unit = angle ? "rad" : pl_dimension_unit(d->arena, dim, true);
  if (angle) v->display = pl_display(d, x, pl_dimension_one(), true);
  return step;
}

void pl_show_met_number(pl_analysis* d, pl_expr name, double x) { show_number(d, name, x); }

static void show_condition(pl_analysis* d, const pl_ask* ask, pl_expr e) {
  const pl_form** f = PL_ARRAY(d->arena, const pl_form*, ask->where.n + 1);
  for (int k = 0; k < ask->where.n; k++)
    f[k] = pl_feq(d, pl_fe(d, ask->where.at[k].left), pl_fe(d, ask->where.at[k].right));
  pl_say(d, PL_BOTH(ask->where.n == 1 ? "Condition {1}:" : "Conditions {1}:"), 1,
         pl_flist(d, f, ask->where.n));
  pl_show(d, pl_feq(d, pl_f(d, e, PL_S_QUOTIENT), pl_form_leaf(d->arena, pl_int(d->pool, 0))));
}

// ----------------------------------------------------------------------------------- on the motion
// One-sided constraints have to stay as they are all the way: a closed one pushes, an open one is
// not met.
static void add_contacts(pl_analysis* d, const pl_where* p, pl_search* s) {
  for (int k = 0; k < d->g.n && s->n_contacts < pl_max_contacts_met; k++) {
    const pl_bond* l = &d->g.at[k];
    if (!l->contact || l->velocity || !l->lambda_known) continue;
    pl_expr push = with_given(d, p, pl_on_maps(d, l->lambda_value));
    if ((l->source->relation == PL_LE) != d->model->lambda_minus) push = pl_neg(d->pool, push);
    s->contact[s->n_contacts] = l->source->name.text;
    s->push[s->n_contacts++] = push;
  }
  for (int k = 0; k < d->open.n && s->n_contacts < pl_max_contacts_met; k++) {
    const pl_open* o = &d->open.at[k];
    if (!o->contact || o->released || o->off || o->source->has_velocity) continue;
    pl_expr away = with_given(d, p, pl_on_maps(d, o->source->g));
    s->open[s->n_contacts] = true;
    s->contact[s->n_contacts] = o->source->name.text;
    s->push[s->n_contacts++] = o->source->relation == PL_LE ? pl_neg(d->pool, away) : away;
  }
}

// Signs that were taken for granted have to stay too.
static void add_sides(pl_analysis* d, const pl_where* p, pl_search* s) {
  const pl_fact* side;
  int n = pl_taken_sides(d, &side);
  for (int k = 0; k < n && s->n_contacts < pl_max_contacts_met; k++) {
    s->side[s->n_contacts] = pl_fact_form(d, &side[k]);
    s->push[s->n_contacts++] = with_given(d, p, pl_on_maps(d, side[k].difference));
  }
}

static void add_root(pl_search* s, pl_root r) {
  for (int k = 0; k < s->n_roots; k++) {
    if (pl_same(s->root[k].value, r.value)) return;
  }
  if (s->n_roots < pl_max_roots_met) s->root[s->n_roots++] = r;
}

static void add_roots(pl_analysis* d, pl_search* s, pl_expr e) {
  if (!pl_has_symbol(d->pool, e, s->s)) return;
  pl_root root[pl_max_roots_met];
  bool complete = false;
  int n = pl_alg_roots(d->tower, e, s->s, root, pl_max_roots_met, &complete);
  s->complete &= complete;
  for (int k = 0; k < n; k++) add_root(s, root[k]);
}

// A(q) + B(q) q' = 0 with q'^2 = w(q): the roots of A² - w B² count for both signs of q'.
static void roots_on_line(pl_analysis* d, pl_search* s) {
  pl_symbol v = d->q.at[s->line->i].v;
  pl_expr c[9], part[2] = {pl_int(d->pool, 0), pl_int(d->pool, 0)};
  s->complete = true;
  int n = pl_alg_coefficients(d->tower, s->condition, v, c, 8);
  if (n < 0) {
    add_roots(d, s, pl_along_line(d, s->line, s->condition));
    s->complete = false;
    return;
  }
  for (int k = 0; k <= n; k++)
    part[k % 2] = pl_add(d->pool, part[k % 2],
                         pl_mul(d->pool, c[k], pl_pow_int(d->pool, s->line->v2, k / 2)));
  pl_expr A = pl_alg_normal(d->tower, part[0]), B = pl_alg_normal(d->tower, part[1]);
  if (pl_is_zero_node(d->pool, B)) {
    add_roots(d, s, A);
  } else if (pl_is_zero_node(d->pool, A)) {
    add_roots(d, s, s->line->v2);
    add_roots(d, s, B);
  } else {
    add_roots(d, s,
              pl_alg_normal(d->tower, pl_sub(d->pool, pl_square(d->pool, A),
                                             pl_mul(d->pool, s->line->v2, pl_square(d->pool, B)))));
  }
}

static pl_expr on_cyclic(pl_analysis* d, const pl_where* p, pl_expr e) {
  return pl_subst(d->pool, e, p->line.velocity, p->line.n);
}

// Only the coordinate that is left and its velocity occur.
static bool is_on_line(pl_analysis* d, const pl_where* p, pl_expr e) {
  for (int k = 0; k < d->q.n; k++) {
    const pl_variable* c = &d->q.at[k];
    if (k != p->line.i && (pl_has_symbol(d->pool, e, c->q) || pl_has_symbol(d->pool, e, c->v)))
      return false;
  }
  return !pl_has_symbol(d->pool, e, pl_time(d->pool));
}

// q = value
static bool place_of(pl_analysis* d, pl_expr e, pl_symbol q, pl_expr* value) {
  pl_expr c[2];
  if (pl_alg_coefficients(d->tower, e, q, c, 1) != 1 || pl_has_coordinates(d, c[0])
      || pl_has_coordinates(d, c[1]))
    return false;
  *value = pl_alg_normal(d->tower, pl_neg(d->pool, pl_div(d->pool, c[0], c[1])));
  return true;
}

static bool search_on_line(pl_analysis* d, const pl_where* p) {
  if (!p->on_line) return false;
  pl_search s = {.line = &p->line, .s = d->q.at[p->line.i].q, .name = p->ask->value};
  s.condition = pl_alg_normal(d->tower, on_cyclic(d, p, p->equation[0]));
  s.asked = on_cyclic(d, p, p->asked);
  if (!is_on_line(d, p, s.condition) || !is_on_line(d, p, s.asked)) return false;
  if (!pl_has_symbol(d->pool, s.condition, s.s)
      && !pl_has_symbol(d->pool, s.condition, d->q.at[p->line.i].v))
    return false;
  add_contacts(d, p, &s);
  add_sides(d, p, &s);
  for (int k = 0; k < s.n_contacts; k++) {
    s.push[k] = on_cyclic(d, p, s.push[k]);
    if (!is_on_line(d, p, s.push[k])) return false;
  }
  pl_expr place;
  if (place_of(d, s.condition, s.s, &place)) {
    s.place = s.complete = true;
    s.root[s.n_roots++] = (pl_root){place, pl_poison()};
  } else {
    pl_expr e = pl_along_line(d, &p->line, s.condition);
    show_condition(d, p->ask, e);
    roots_on_line(d, &s);
  }
  pl_search_motion(d, &s);
  return true;
}

// -------------------------------------------------------------------------------------- along time
// Coordinates and velocities in e as functions of time, from the start of the motion. false: some
// has no closed form.
static bool on_time(pl_analysis* d, const pl_where* p, pl_expr* e) {
  pl_replace *r = PL_ARRAY(d->arena, pl_replace, 2 * d->q.n + 1),
             *start = PL_ARRAY(d->arena, pl_replace, 2 * d->q.n + 1);
  int n = 0, n_start = 0;
  for (int k = 0; k < d->gen.n; k++) {
    const pl_variable* c = &d->q.at[d->gen.at[k]];
    pl_expr q0, v0;
    pl_motion_start(d, &p->ask->motion, c, &q0, &v0);
    start[n_start++] = (pl_replace){pl_symbol_start(d->pool, c->q), q0};
    start[n_start++] = (pl_replace){pl_symbol_start(d->pool, c->v), v0};
    if (!pl_has_symbol(d->pool, *e, c->q) && !pl_has_symbol(d->pool, *e, c->v)) continue;
    pl_expr x = pl_closed_motion(d, d->gen.at[k], NULL);
    if (pl_is_poison(x)) return false;
    r[n++] = (pl_replace){c->q, x};
    r[n++] = (pl_replace){c->v, pl_diff(d->pool, x, pl_time(d->pool))};
  }
  *e = pl_subst(d->pool, pl_subst(d->pool, *e, r, n), start, n_start);
  *e = pl_alg_normal(d->tower, with_given(d, p, *e));
  return !pl_has_coordinates(d, *e);
}

// operations of a condition over t that are worth reading
static const long longest_in_time = 150;

static bool search_in_time(pl_analysis* d, const pl_where* p) {
  pl_search s = {.s = pl_time(d->pool),
                 .name = p->ask->value,
                 .condition = p->equation[0],
                 .asked = p->asked,
                 .complete = true};
  if (!d->reduced || !on_time(d, p, &s.condition) || !on_time(d, p, &s.asked)) return false;
  if (!pl_has_symbol(d->pool, s.condition, s.s)
      || pl_op_count(d->pool, s.condition) > longest_in_time)
    return false;
  add_contacts(d, p, &s);
  add_sides(d, p, &s);
  for (int k = 0; k < s.n_contacts; k++) {
    if (!on_time(d, p, &s.push[k])) return false;
  }
  show_condition(d, p->ask, s.condition);
  add_roots(d, &s, s.condition);
  pl_search_motion(d, &s);
  return true;
}

static pl_search plain_search(pl_analysis* d, const pl_where* p) {
  pl_search s = {
      .s = pl_time(d->pool), .name = p->ask->value, .condition = p->equation[0], .asked = p->asked};
  add_contacts(d, p, &s);
  add_sides(d, p, &s);
  return s;
}

// ------------------------------------------------------------------------------------ of the state
typedef struct pl_found {
  pl_expr value[max_solutions], condition[max_solutions];
  int n;
  bool complete;
} pl_found;

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

// Equation after equation, each solved for one quantity and inserted into the others; solutions
// multiply.
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
  if (!unknown_of(d, p, e, &s)) return;  // a contradiction, or nothing to solve for
  pl_root root[max_solutions];
  bool complete = false;
  int n = pl_alg_roots(d->tower, e, s, root, max_solutions, &complete);
  out->complete &= complete;
  for (int r = 0; r < n; r++) {
    if (excluded(d, s, root[r].value)) continue;
    pl_claim_free(d, PL_CLAIM_INSERTED, pl_subst1(d->pool, e, s, root[r].value),
                  pl_int(d->pool, 0));
    pl_where next = *p;
    for (int j = 0; j < p->n; j++)
      next.equation[j] = pl_subst1(d->pool, p->equation[j], s, root[r].value);
    next.asked = pl_subst1(d->pool, p->asked, s, root[r].value);
    solve_rest(d, &next, k + 1, pl_is_poison(root[r].condition) ? condition : root[r].condition,
               out);
  }
}

static pl_found solutions(pl_analysis* d, const pl_where* p) {
  pl_found found = {.complete = true};
  solve_rest(d, p, 0, pl_poison(), &found);
  return found;
}

// -------------------------------------------------------------------- signs that are only supposed
// A given quantity without number counts as positive. For one that is no mass, length, stiffness or
// gravity, and of which the model
// assumes nothing, this is a guess.
static bool is_guessed(pl_analysis* d, const pl_where* p, const pl_param* given) {
  const pl_symbol_info* info = pl_symbol_get(d->pool, given->symbol);
  if (given->literal || !pl_is_poison(given->value) || info->sign != PL_SIGN_POSITIVE
      || info->class != PL_C_OTHER)
    return false;
  if (pl_same(p->asked, pl_sym(d->pool, given->symbol))) return false;
  for (int k = 0; k < d->model->assumptions.n; k++) {
    const pl_assumption* a = &d->model->assumptions.at[k];
    pl_expr e = a->kind == PL_A_RELATION ? pl_sub(d->pool, a->condition.left, a->condition.right)
                                         : a->subject;
    if (!pl_is_poison(e) && pl_has_symbol(d->pool, e, given->symbol)) return false;
  }
  for (int k = 0; k < d->model->loads.n; k++) {
    const pl_load* l = &d->model->loads.at[k];
    if (l->kind == PL_L_SPRING && pl_has_symbol(d->pool, l->value, given->symbol)) return false;
  }
  return true;
}

// Names that look the same and may have either sign, for all guessed ones.
static int free_names(pl_analysis* d, const pl_where* p, pl_replace* to, pl_replace* back) {
  int n = 0;
  for (int k = 0; k < d->model->params.n; k++) {
    const pl_param* given = &d->model->params.at[k];
    if (!is_guessed(d, p, given)) continue;
    pl_symbol_info info = *pl_symbol_get(d->pool, given->symbol);
    info.ascii = pl_format(d->arena, "%s_free", info.ascii);
    info.sign = PL_SIGN_ANY;
    pl_symbol s = pl_symbol_make(d->pool, &info);
    to[n] = (pl_replace){given->symbol, pl_sym(d->pool, s)};
    back[n++] = (pl_replace){s, pl_sym(d->pool, given->symbol)};
  }
  return n;
}

// Nothing was found: without the guesses, and with the condition that then picks the sign. false:
// nothing either.
static bool with_free_signs(pl_analysis* d, const pl_where* p) {
  pl_replace* to = PL_ARRAY(d->arena, pl_replace, d->model->params.n + 1);
  pl_replace* back = PL_ARRAY(d->arena, pl_replace, d->model->params.n + 1);
  int n = free_names(d, p, to, back), shown = 0;
  pl_where q = *p;
  for (int k = 0; k < p->n; k++) q.equation[k] = pl_subst(d->pool, p->equation[k], to, n);
  q.asked = pl_subst(d->pool, p->asked, to, n);
  pl_found found = {0};
  if (n > 0) found = solutions(d, &q);
  for (int k = 0; k < found.n; k++) {
    pl_expr condition = found.condition[k];
    if (pl_is_poison(condition) || pl_is_circular(d, p->ask->value, found.value[k])) continue;
    condition = without_positive_factors(d, condition);
    const pl_form* form = pl_f(d, found.value[k], PL_S_PLAIN);
    pl_show(d, pl_feq(d, pl_fe(d, p->ask->value), form));
    pl_say(d, PL_BOTH("if {1}"), 1, condition_form(d, condition));
    pl_expr value = pl_subst(d->pool, found.value[k], back, n);
    pl_value* v = pl_answer(d, pl_expr_text(d->arena, d->pool, p->ask->value), value, NULL);
    v->exists_if = pl_format(
        d->arena, "%s >= 0",
        pl_expr_text(d->arena, d->pool, pl_subst(d->pool, condition, back, n)));
    v->form = form;
    shown++;
  }
  return shown > 0;
}

// All that is solved for has a number, and the solution has none: a root of a negative number, acos
// beyond 1.
static bool is_unreal(pl_analysis* d, pl_expr value) {
  enum { max_symbols = 64 };
  pl_symbol in[max_symbols];
  if (!isnan(pl_number(d, value))) return false;
  int n = pl_symbols_in(d->pool, value, in, max_symbols);
  for (int k = 0; k < n && k < max_symbols; k++) {
    if (isnan(d->value[in[k].id])) return false;
  }
  return n <= max_symbols;
}

static void of_the_state(pl_analysis* d, const pl_ask* ask, const pl_where* p) {
  pl_found found = solutions(d, p);
  int unreal = 0;
  for (int k = 0; k < found.n; k++) {
    if (pl_say_unsolved(d, ask->value, found.value[k])) return;
    if (is_unreal(d, found.value[k])) {
      unreal++;
      continue;
    }
    pl_expr condition = found.condition[k];
    int sign;
    if (!pl_is_poison(condition) && pl_alg_sign(d->tower, condition, true, &sign) == PL_YES)
      condition = pl_poison();
    pl_show_met(d, ask->value, found.value[k], condition);
  }
  if (found.n > unreal || with_free_signs(d, p)) return;
  pl_say(d,
         PL_BOTH(found.complete ? "No state satisfies this."
                                : "No solution in closed form was found."),
         0);
  d->page->section->not_found = !found.complete;
}

// ------------------------------------------------------------------------------------- the section
// The equation gives what is asked whatever the motion was before.
static bool holds_on_every_motion(pl_analysis* d, const pl_where* p) {
  pl_found found = solutions(d, p);
  if (found.n != 1 || !found.complete || pl_has_symbol(d->pool, found.value[0], pl_time(d->pool)))
    return false;
  return !pl_has_coordinates(d, found.value[0])
         && !pl_is_circular(d, p->ask->value, found.value[0]);
}

// One condition on the motion.  false: it is an equation for the state.
static bool on_the_way(pl_analysis* d, const pl_where* p) {
  if (!pl_has_coordinates(d, p->equation[0])
      && !pl_has_symbol(d->pool, p->equation[0], pl_time(d->pool)))
    return false;
  pl_search s = plain_search(d, p);
  if (pl_say_event_before(d, &p->ask->motion, &s) || search_on_line(d, p)) return true;
  pl_followed f;
  bool every = holds_on_every_motion(d, p);
  if (!every && search_in_time(d, p)) return true;
  pl_follow_motion(d, &p->ask->motion, 0, &s, &f);
  if (f.how == PL_FOLLOWED_NOT || (every && f.how == PL_FOLLOWED_MET && f.lost < 0)) return false;
  pl_say_followed(d, &s, &f);
  return true;
}

static void say_motion_unknown(pl_analysis* d) {
  pl_say(
      d,
      PL_BOTH(
          "The motion from this start is not known in closed form, and it could not be followed in "
          "numbers."),
      0);
  d->page->section->not_found = true;
}

// ------------------------------------------------------------------------------------ closed loops
// The numbers of an assembly where all generalized coordinates that matter are given; NaN where
// something has none.
static double in_assembly(pl_analysis* d, const pl_where* p, int assembly) {
  int n = pl_loop_definitions(d, assembly, NULL);
  pl_definition* definition = PL_ARRAY(d->arena, pl_definition, n + 1);
  pl_loop_definitions(d, assembly, definition);
  pl_number(d, p->asked);  // the table of numbers covers every name
  size_t size = (size_t)(pl_symbol_count(d->pool) + 1);
  double* value = memcpy(PL_ARRAY(d->arena, double, size), d->value, size * sizeof *value);
  for (int k = 0; k < p->n_pins; k++) value[p->pin[k].from.id] = pl_number(d, p->pin[k].to);
  for (int k = 0; k < n; k++)
    value[definition[k].symbol.id] = pl_eval(d->pool, definition[k].value, value);
  return pl_eval(d->pool, p->asked, value);
}

static void show_in_assembly(pl_analysis* d, const pl_where* p, int assembly, double x) {
  pl_step* step = show_number(d, p->ask->value, x);
  const char* branch = pl_branch_text(d, assembly, PL_MATH_LINE);
  if (!branch) return;
  pl_step_after(step, PL_BOTH_FORMAT(d->arena, "for %s", branch));
  d->page->section->values.at[d->page->section->values.n - 1].branch = pl_branch_text(
      d, assembly, PL_MATH_ASCII);
}

// On the motion, in each assembly.
static bool loops_followed(pl_analysis* d, const pl_where* p) {
  pl_search s = plain_search(d, p);
  bool any = false;
  for (int a = 0; a < pl_assemblies(d); a++) {
    pl_followed f;
    pl_follow_motion(d, &p->ask->motion, a, &s, &f);
    if (f.how == PL_FOLLOWED_NOT) continue;
    any = true;
    const char* branch = pl_branch_text(d, a, PL_MATH_LINE);
    if (f.how == PL_FOLLOWED_MET && f.lost < 0) {
      show_in_assembly(d, p, a, f.asked);
      continue;
    }
    if (branch) pl_say(d, PL_BOTH("For {1}:"), 1, pl_fn(d, branch));
    pl_say_followed(d, &s, &f);
  }
  return any;
}

bool pl_where_in_loops(pl_analysis* d, const pl_ask* ask) {
  pl_where p = {0};
  if (!collect(d, ask, &p) || pl_has_role(d->pool, p.asked, PL_R_ACCELERATION)
      || pl_has_role(d->pool, p.asked, PL_R_MULTIPLIER))
    return false;
  bool one = p.n == 1 && p.n_pins == 0;
  if (one) {
    for (int k = 0; k < ask->where.n; k++)
      p.n_pins += pin_of(d, &ask->where.at[k], &p.pin[p.n_pins]);
  }
  bool pinned = p.n_pins > 0 && (p.n == 0 || one);
  double* x = PL_ARRAY(d->arena, double, pl_assemblies(d) + 1);
  for (int a = 0; a < pl_assemblies(d); a++) {
    x[a] = pinned ? in_assembly(d, &p, a) : (double)NAN;
    pinned = !isnan(x[a]);
  }
  // the place alone decides
  bool unmoved = pinned && !pl_has_role(d->pool, p.asked, PL_R_VELOCITY);
  if (!pinned && !one) return false;
  pl_section_open(d, ask, ask->text, ask->text);
  pl_say(d, PL_BOTH("For the given numbers:"), 0);
  if (unmoved || (pinned && !one)) {
    for (int a = 0; a < pl_assemblies(d); a++) show_in_assembly(d, &p, a, x[a]);
    return true;
  }
  if (loops_followed(d, &p)) return true;
  say_motion_unknown(d);
  return true;
}

static void drop_what_vanishes(pl_analysis* d, pl_where* p) {
  int n = 0;
  for (int k = 0; k < p->n; k++) {
    if (pl_alg_is_zero(d->tower, p->equation[k]) != PL_YES) p->equation[n++] = p->equation[k];
  }
  p->n = n;
}

void pl_answer_where(pl_analysis* d, const pl_ask* ask) {
  pl_where p = {0};
  if (!collect(d, ask, &p)) {
    pl_answer_pending(d, ask);
    return;
  }
  for (int k = 0; k < p.n; k++) {
    if (pl_say_unsolved(d, ask->value, pl_alg_normal(d->tower, p.equation[k]))) return;
  }
  if (pl_say_unsolved(d, ask->value, pl_alg_normal(d->tower, p.asked))) return;
  if (p.n == 1 && p.n_pins == 0 && on_the_way(d, &p)) return;
  if (p.n == 1 && p.n_pins == 0 && ask->motion.given && !p.on_line
      && !holds_on_every_motion(d, &p)) {
    say_motion_unknown(d);
    return;
  }
  pins_of_the_motion(d, &p);
  for (int k = 0; k < p.n; k++) p.equation[k] = at_place(d, &p, p.equation[k]);
  drop_what_vanishes(d, &p);
  if (p.n > 0) show_condition(d, ask, p.equation[0]);
  p.asked = at_place(d, &p, p.asked);
  of_the_state(d, ask, &p);
}
