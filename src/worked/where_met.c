// where_met: which of the places where a condition holds does the motion meet first, and which way
// does it go there? The roots in
// closed form are compared with the course of the motion in numbers, which knows nothing of them.
// Where numbers are missing, many
// are drawn: an answer that is the same for all of them is given, else all that occur.
#include <math.h>
#include <string.h>

#include "mechanics/equilibria.h"
#include "where_impl.h"

enum { most_symbols = 96, n_draws = 24, most_tries = 600, most_ways = 8, most_rates = 4 };
// relative difference of two numbers that mean the same place
static const double agrees = 1e-8, agrees_touching = 1e-5;
// likewise of the values asked for there
static const double same_value = 1e-6;
static const double draw_low = 0.3, draw_high = 3;  // sizes of the numbers that are drawn

// What is looked for, with abbreviations inserted whose numbers are not known: only to be
// evaluated.
typedef struct numeric {
  pl_search p;
  pl_line line;
} numeric;

// ----------------------------------------------------------------------------------------- numbers
static bool is_open_let(const pl_analysis* d, const pl_let* l) {
  return !l->inserted && l->n_args == 0 && l->symbol.id && isnan(d->value[l->symbol.id]);
}

static pl_expr without_open_lets(pl_analysis* d, pl_expr e) {
  for (int k = d->model->lets.n - 1; k >= 0; k--) {
    const pl_let* l = &d->model->lets.at[k];
    if (is_open_let(d, l)) e = pl_subst1(d->pool, e, l->symbol, l->value);
  }
  return e;
}

static void make_numeric(pl_analysis* d, const pl_search* p, numeric* out) {
  pl_number(d, p->condition);  // the table of numbers covers every name
  out->p = *p;
  out->p.condition = without_open_lets(d, p->condition);
  out->p.asked = without_open_lets(d, p->asked);
  for (int k = 0; k < p->n_roots; k++)
    out->p.root[k].value = without_open_lets(d, p->root[k].value);
  for (int k = 0; k < p->n_contacts; k++) out->p.push[k] = without_open_lets(d, p->push[k]);
  if (!p->line) return;
  out->line = *p->line;
  out->line.v2 = without_open_lets(d, p->line->v2);
  out->line.q0 = without_open_lets(d, p->line->q0);
  out->line.v0 = without_open_lets(d, p->line->v0);
  out->p.line = &out->line;
}

static pl_symbol speed_of(const pl_analysis* d, const pl_search* p) {
  return p->line ? d->q.at[p->line->i].v : (pl_symbol){0};
}

static int add_unknown(pl_analysis* d, const pl_search* p, pl_expr e, pl_symbol* out, int n) {
  pl_symbol in[most_symbols];
  int m = pl_symbols_in(d->pool, e, in, most_symbols);
  for (int i = 0; i < m && i < most_symbols; i++) {
    bool known = in[i].id == p->s.id || in[i].id == speed_of(d, p).id || !isnan(d->value[in[i].id]);
    for (int j = 0; j < n && !known; j++) known = out[j].id == in[i].id;
    if (!known && n < most_symbols) out[n++] = in[i];
  }
  return n;
}

static int unknown_names(pl_analysis* d, const numeric* x, pl_symbol* out) {
  const pl_search* p = &x->p;
  int n = add_unknown(d, p, p->condition, out, 0);
  n = add_unknown(d, p, p->asked, out, n);
  if (p->place) n = add_unknown(d, p, p->root[0].value, out, n);
  if (!p->line) return n;
  n = add_unknown(d, p, p->line->v2, out, n);
  n = add_unknown(d, p, p->line->q0, out, n);
  return add_unknown(d, p, p->line->v0, out, n);
}

static double draw(pl_analysis* d, pl_symbol s, pl_random* r) {
  double size = draw_low * pow(draw_high / draw_low, pl_random_unit(r));
  bool negative = pl_random_bits(r) & 1;
  switch (pl_symbol_get(d->pool, s)->sign) {
    case PL_SIGN_POSITIVE:
    case PL_SIGN_NONNEGATIVE: return size;
    case PL_SIGN_NEGATIVE:
    case PL_SIGN_NONPOSITIVE: return -size;
    default: return negative ? -size : size;
  }
}

static bool facts_hold(pl_analysis* d, const double* value) {
  for (int k = 0; k < d->facts.n; k++) {
    if (pl_has_coordinates(d, d->facts.at[k].difference)) continue;
    double x = pl_eval(d->pool, without_open_lets(d, d->facts.at[k].difference), value);
    if (x < 0 || (x == 0 && d->facts.at[k].strict)) return false;
  }
  return true;
}

// -------------------------------------------------------------- the outcome for one set of numbers
typedef enum pl_outcome_kind { FAILS, NEVER, MET } pl_outcome_kind;
typedef struct outcome {
  pl_outcome_kind kind;
  int root;         // -1: none of the closed ones
  int rate, turns;  // so many periods 2π/rate[.] beyond it
  pl_meeting at;
  int lost;  // a contact that lets go before, -1
  double lost_at;
  bool at_once;  // at the start already
} outcome;

typedef struct rates {
  int n;
  pl_expr k[most_rates];
} rates;

// The k of every sin(k s), cos(k s).
static void collect_rates(pl_analysis* d, pl_expr e, pl_symbol s, rates* out) {
  pl_pool* p = d->pool;
  if (!pl_has_symbol(p, e, s)) return;
  if (pl_kind_of(p, e) == PL_CALL
      && (pl_function_of(p, e) == PL_SIN || pl_function_of(p, e) == PL_COS)) {
    pl_expr k = pl_diff(p, pl_arg(p, e, 0), s);
    bool known = pl_has_symbol(p, k, s) || out->n == most_rates;
    for (int i = 0; i < out->n; i++) known |= pl_same(out->k[i], k);
    if (!known) out->k[out->n++] = k;
  }
  for (int i = 0; i < pl_n_args(p, e); i++) collect_rates(d, pl_arg(p, e, i), s, out);
}

static void match(pl_analysis* d, const numeric* x, const rates* r, double* value,
                  const pl_course* c, outcome* out) {
  double scale = fabs(out->at.at) + fabs(out->at.at - c->start) + c->first,
         near = (out->at.touches ? agrees_touching : agrees) * scale;
  out->root = -1;
  for (int k = 0; k < x->p.n_roots; k++) {
    double apart = out->at.at - pl_eval(d->pool, x->p.root[k].value, value);
    if (fabs(apart) <= near) {
      near = fabs(apart);
      out->root = k;
      out->turns = 0;
    }
    for (int i = 0; i < r->n && out->root < 0; i++) {
      double period = 2 * M_PI / pl_eval(d->pool, r->k[i], value), m = nearbyint(apart / period);
      if (m == 0 || !(fabs(apart - m * period) <= near)) continue;
      out->root = k;
      out->rate = i;
      out->turns = (int)m;
    }
  }
}

// The first place where a contact that has to push would have to pull.
static void look_at_contacts(const numeric* x, const pl_course* c, outcome* out) {
  for (int k = 0; k < x->p.n_contacts; k++) {
    pl_expr f = x->p.push[k];
    int sign = c->n_legs > 0 ? c->leg[0].sign : 0;
    double first = pl_course_value(c, f, c->start, c->speed > 0 ? sign : 0);
    double next = pl_course_value(c, f, c->start + sign * 16 * c->first, sign);
    if (first < 0 && next < 0) {
      out->lost = k;
      out->at_once = true;
      return;
    }
    pl_meeting m;
    if (!pl_course_meets(c, f, &m) || m.touches) continue;
    pl_meeting later = out->at;
    later.at -= c->leg[later.leg].sign * agrees * (fabs(later.at) + fabs(later.at - c->start));
    if (out->kind == MET && !pl_meets_before(&m, &later, c)) continue;
    out->lost = k;
    out->lost_at = m.at;
    return;
  }
}

static outcome follow(pl_analysis* d, const numeric* x, const rates* r, double* value, int side,
                      pl_course* c) {
  outcome out = {.kind = FAILS, .root = -1, .lost = -1};
  const pl_search* p = &x->p;
  if (p->line) {
    double q0 = pl_eval(d->pool, p->line->q0, value), v0 = pl_eval(d->pool, p->line->v0, value);
    if (!pl_course_make(d, value, p->s, p->line->v2, q0, v0, side, c)) return out;
  } else {
    pl_course_of_time(d, value, p->condition, c);
  }
  double place = p->place ? pl_eval(d->pool, p->root[0].value, value) : 0;
  if (isnan(place)) return out;
  bool met = p->place && p->line ? pl_course_reaches(c, place, &out.at)
                                 : pl_course_meets(c, p->condition, &out.at);
  out.kind = met ? MET : NEVER;
  if (met && p->place) out.root = 0;
  else if (met) match(d, x, r, value, c, &out);
  look_at_contacts(x, c, &out);
  return out;
}

// ------------------------------------------------------------------------------------------ values
static pl_expr place_of(pl_analysis* d, const pl_search* p, const rates* r, const outcome* o) {
  pl_expr e = p->root[o->root].value;
  if (o->turns == 0) return e;
  pl_expr period = pl_div(d->pool, pl_mul(d->pool, pl_int(d->pool, 2), pl_pi(d->pool)),
                          r->k[o->rate]);
  return pl_add(d->pool, e, pl_mul(d->pool, pl_int(d->pool, o->turns), period));
}

// e at the place, the velocity with its sign there.
static pl_expr at_place(pl_analysis* d, const pl_search* p, pl_expr e, pl_expr place, int sign) {
  if (p->line && sign == 0) e = pl_subst1(d->pool, e, speed_of(d, p), pl_int(d->pool, 0));
  if (p->line && sign != 0) {
    pl_line way = *p->line;
    way.direction = sign;
    e = pl_along_line(d, &way, e);
  }
  return pl_alg_normal(d->tower, pl_subst1(d->pool, e, p->s, place));
}

// --------------------------------------------------------------------------------------- sentences
// "x = -2.1482 m"
static const pl_form* place_form(pl_analysis* d, const pl_search* p, double at) {
  bool known;
  pl_dimension dim = pl_dimension_of_expr(d, pl_sym(d->pool, p->s), &known);
  pl_notation how = {.math = PL_MATH_LINE, .lang = d->job->lang};
  bool angle = p->line && pl_is_angle(d, p->line->i);
  const char* unit = angle || !known ? "" : pl_dimension_unit(d->arena, dim, false);
  const char* number = pl_notation_number(d->arena, angle ? at * 180 / M_PI : at, 6, how);
  bool plain = !*unit || strcmp(unit, "1") == 0;
  const char* text = angle   ? pl_format(d->arena, "%s°", number)
                     : plain ? number
                             : pl_format(d->arena, "%s %s", number, unit);
  return pl_feq(d, pl_fs(d, p->s), pl_fn(d, text));
}

static void say_turns(pl_analysis* d, const pl_search* p, const pl_course* c) {
  const pl_form* first = place_form(d, p, c->leg[0].to);
  if (c->n_legs > 2) {
    pl_say(d, PL_BOTH("It turns round at {1} and at {2}."), 2, first,
           place_form(d, p, c->leg[1].to));
  } else {
    pl_say(d, PL_BOTH("It turns round at {1} and does not come back."), 1, first);
  }
}

// All roots are known, and none lies on the way that was not looked at.
static bool no_root_beyond(pl_analysis* d, const pl_search* p, const pl_course* c) {
  const pl_leg* last = &c->leg[c->n_legs - 1];
  if (!p->complete) return false;
  for (int k = 0; k < p->n_roots; k++) {
    double x = pl_number(d, p->root[k].value);
    if (c->rate > 0 || (x - last->to) * last->sign > 0) return false;
  }
  return true;
}

static void say_never(pl_analysis* d, const pl_search* p, const pl_course* c) {
  const pl_leg* last = c->n_legs > 0 ? &c->leg[c->n_legs - 1] : NULL;
  bool searched = !last || last->end != PL_END_OPEN || p->place || no_root_beyond(d, p, c);
  if (!searched && !(p->line && pl_course_repeats(c, p->condition))) {
    pl_say(d, PL_BOTH("As far as {1} this does not happen on the motion."), 1,
           place_form(d, p, last->to));
    d->page->section->not_found = true;
    return;
  }
  pl_say(d, PL_BOTH("This never happens on the motion."), 0);
  if (c->stays) {
    pl_say(d, PL_BOTH("It stays at rest at {1}."), 1, place_form(d, p, c->start));
  } else if (c->n_legs > 1) {
    say_turns(d, p, c);
  }
  if (last && last->end == PL_END_REST) {
    pl_say(d, PL_BOTH("It approaches {1} without reaching it."), 1, place_form(d, p, last->to));
  }
  if (last && last->end == PL_END_EDGE) {
    pl_say(d, PL_BOTH("It cannot go on beyond {1}."), 1, place_form(d, p, last->to));
  }
}

void pl_say_met_before(pl_analysis* d, const char* contact, const pl_form* where) {
  pl_say(d, PL_BOTH("{1} is met before, at {2}; beyond it the formulas do not hold."), 2,
         pl_fn(d, contact), where);
}

void pl_say_left_before(pl_analysis* d, const pl_form* side, const pl_form* where) {
  pl_say(
      d,
      PL_BOTH(
          "The motion leaves {1} before, at {2}: beyond it the formulas of this side do not hold."),
      2, side, where);
}

static bool say_lost(pl_analysis* d, const pl_search* p, const outcome* o) {
  if (o->lost < 0) return false;
  if (p->side[o->lost] && o->at_once) {
    pl_say(d, PL_BOTH("The motion does not start where the formulas hold, {1}."), 1,
           p->side[o->lost]);
    return true;
  }
  if (p->side[o->lost]) {
    pl_say_left_before(d, p->side[o->lost], place_form(d, p, o->lost_at));
    return true;
  }
  const pl_form* contact = pl_fn(d, p->contact[o->lost]);
  if (p->open[o->lost]) {
    pl_say_met_before(d, p->contact[o->lost], place_form(d, p, o->lost_at));
  } else if (o->at_once) {
    pl_say(d,
           PL_BOTH("At this start {1} would have to pull: it lets go at once, and the formulas do "
                   "not hold."),
           1, contact);
  } else {
    pl_say(d, PL_BOTH("{1} lets go before, at {2}; beyond it the formulas do not hold."), 2,
           contact, place_form(d, p, o->lost_at));
  }
  return true;
}

// The same for numbers that are not given.
static void say_lost_anywhere(pl_analysis* d, const pl_search* p, int k) {
  const pl_form* what = p->side[k] ? p->side[k] : pl_fn(d, p->contact[k]);
  if (p->side[k]) {
    pl_say(
        d,
        PL_BOTH("The motion leaves {1} before: beyond it the formulas of this side do not hold."),
        1, what);
  } else if (p->open[k]) {
    pl_say(d, PL_BOTH("{1} is met before: beyond it the formulas do not hold."), 1, what);
  } else {
    pl_say(d, PL_BOTH("{1} lets go before: beyond it the formulas do not hold."), 1, what);
  }
}

// ------------------------------------------------------------------------------ all that was found
typedef struct ways {
  int n;
  outcome at[most_ways];
  int never, lost, tried;
  int lost_first;  // what was lost in the first of these
} ways;

static void add_way(ways* w, const outcome* o) {
  w->tried += o->kind != FAILS;
  if (o->kind != FAILS && o->lost >= 0 && w->lost++ == 0) w->lost_first = o->lost;
  w->never += o->kind == NEVER && o->lost < 0;
  if (o->kind != MET || o->lost >= 0) return;
  for (int k = 0; k < w->n; k++) {
    const outcome* a = &w->at[k];
    if (a->root == o->root && a->turns == o->turns && a->rate == o->rate
        && a->at.sign == o->at.sign)
      return;
  }
  if (w->n < most_ways) w->at[w->n++] = *o;
}

// What must hold for the place and the velocity there to be real; poison if nothing is left to say.
static pl_expr condition_of(pl_analysis* d, const pl_search* p, const outcome* o, pl_expr place) {
  pl_expr e = p->root[o->root].condition;
  int sign;
  if (pl_is_poison(e) && p->line && o->at.sign != 0)
    e = pl_alg_normal(d->tower, pl_subst1(d->pool, p->line->v2, p->s, place));
  if (!pl_is_poison(e) && pl_alg_sign(d->tower, e, true, &sign) != PL_YES) return e;
  if (!p->line || o->at.leg > 0 || o->at.sign == 0) return pl_poison();
  // ahead of the start
  e = pl_mul(d->pool, pl_int(d->pool, o->at.sign), pl_sub(d->pool, place, p->line->q0));
  return pl_alg_sign(d->tower, e, true, &sign) == PL_YES ? pl_poison() : pl_alg_normal(d->tower, e);
}

// conditional: for some numbers it does not happen.
static void show_way(pl_analysis* d, const pl_search* p, const rates* r, const outcome* o,
                     bool conditional) {
  pl_expr place = place_of(d, p, r, o);
  if (!p->place)
    pl_claim_free(d, PL_CLAIM_INSERTED, at_place(d, p, p->condition, place, o->at.sign),
                  pl_int(d->pool, 0));
  pl_expr value = at_place(d, p, p->asked, place, o->at.sign);
  pl_expr condition = conditional ? condition_of(d, p, o, place) : pl_poison();
  pl_show_met(d, p->name, value, condition);
  if (conditional && pl_is_poison(condition)) {
    pl_say(d, PL_BOTH("This does not happen for all values of the given quantities."), 0);
  }
}

// The closed form against the course: the number of what is asked there.
static bool value_agrees(pl_analysis* d, const numeric* x, const rates* r, const outcome* o,
                         const pl_course* c, double* y) {
  *y = pl_course_value(c, x->p.asked, o->at.at, o->at.sign);
  if (o->root < 0) return false;
  double closed = pl_number(d,
                            at_place(d, &x->p, x->p.asked, place_of(d, &x->p, r, o), o->at.sign));
  return fabs(closed - *y) <= same_value * (fabs(closed) + fabs(*y)) + 1e-12;
}

// ------------------------------------------------------------------- with the numbers of the model
// Where `init` starts beside an equilibrium that `from` names, the motion leaves to that side.
static int named_side(pl_analysis* d, const pl_search* p) {
  if (!p->line) return 0;
  pl_motion init = {0};
  pl_expr q, v;
  pl_motion_start(d, &init, &d->q.at[p->line->i], &q, &v);
  double x = pl_number(d, pl_sub(d->pool, q, p->line->q0));
  return x > 0 ? 1 : x < 0 ? -1 : 0;
}

static void show_given(pl_analysis* d, const pl_search* p, const numeric* x, const rates* r,
                       const outcome* o, const pl_course* c) {
  if (say_lost(d, p, o)) return;
  if (o->kind == NEVER) {
    say_never(d, p, c);
    return;
  }
  if (o->at.leg > 0)
    pl_say(d, PL_BOTH("Before that the motion turns round at {1}."), 1,
           place_form(d, p, c->leg[0].to));
  double y;
  if (value_agrees(d, x, r, o, c, &y)) {
    show_way(d, p, r, o, false);
    return;
  }
  if (!isfinite(y)) {
    pl_say(d, PL_BOTH("No solution in closed form was found."), 0);
    d->page->section->not_found = true;
    return;
  }
  pl_say(d, PL_BOTH("No solution in closed form was found; for the given numbers:"), 0);
  pl_show_met_number(d, p->name, y);
  d->page->section->not_found = true;
}

static bool same_answer(const numeric* x, const outcome* a, const pl_course* on_a, const outcome* b,
                        const pl_course* on_b) {
  double y = pl_course_value(on_a, x->p.asked, a->at.at, a->at.sign),
         z = pl_course_value(on_b, x->p.asked, b->at.at, b->at.sign);
  return fabs(y - z) <= same_value * (fabs(y) + fabs(z)) + 1e-12;
}

// false: the numbers lead to no motion.
static bool with_given_numbers(pl_analysis* d, const pl_search* p, const numeric* x,
                               const rates* r) {
  int side = named_side(d, p), n = pl_symbol_count(d->pool) + 1;
  // the course writes into it
  double* value = memcpy(PL_ARRAY(d->arena, double, n), d->value, (size_t)n * sizeof(double));
  pl_course c, other;
  outcome o = follow(d, x, r, value, side, &c);
  if (o.kind == FAILS) return false;
  if (!c.either) {
    show_given(d, p, x, r, &o, &c);
    return true;
  }
  outcome right = follow(d, x, r, value, 1, &c), left = follow(d, x, r, value, -1, &other);
  bool same = right.kind == left.kind && right.lost == left.lost;
  bool one = left.kind == NEVER || (same && right.kind == NEVER)
             || (same && same_answer(x, &right, &c, &left, &other));
  if (!one && right.kind == MET && left.kind == MET) {
    pl_say(d, PL_BOTH("The motion may leave the equilibrium to either side:"), 0);
  }
  if (right.kind == MET || one) show_given(d, p, x, r, &right, &c);
  if (!one) show_given(d, p, x, r, &left, &other);
  return true;
}

// --------------------------------------------------------------------- with numbers that are drawn
static void follow_drawn(pl_analysis* d, const numeric* x, const rates* r, const pl_symbol* open,
                         int n_open, ways* w) {
  int n = pl_symbol_count(d->pool) + 1, side = named_side(d, &x->p);
  double* value = PL_ARRAY(d->arena, double, n + 1);
  pl_random random = {20};
  for (int k = 0; k < most_tries && w->tried < n_draws; k++) {
    memcpy(value, d->value, (size_t)n * sizeof *value);
    for (int i = 0; i < n_open; i++) value[open[i].id] = draw(d, open[i], &random);
    if (!facts_hold(d, value)) continue;
    pl_course c;
    outcome o = follow(d, x, r, value, side, &c);
    if (c.either) o = follow(d, x, r, value, 1, &c);
    add_way(w, &o);
    if (!c.either) continue;
    o = follow(d, x, r, value, -1, &c);
    add_way(w, &o);
  }
}

static bool any_closed(const ways* w) {
  for (int k = 0; k < w->n; k++) {
    if (w->at[k].root >= 0) return true;
  }
  return false;
}

static void show_drawn(pl_analysis* d, const pl_search* p, const rates* r, const ways* w) {
  if (w->n == 0 && w->lost > 0) {
    say_lost_anywhere(d, p, w->lost_first);
    return;
  }
  if (w->n == 0 && p->complete && p->n_roots == 0) {
    pl_say(d, PL_BOTH("This never happens on the motion."), 0);
    return;
  }
  if (!any_closed(w)) {
    pl_say(
        d,
        PL_BOTH(w->n ? "No solution in closed form was found."
                     : "For none of the numbers that were tried does this happen on the motion."),
        0);
    d->page->section->not_found = true;
    return;
  }
  if (w->n > 1) {
    pl_say(d, PL_BOTH("What is met first hangs on the given quantities:"), 0);
  }
  for (int k = 0; k < w->n; k++) {
    if (w->at[k].root >= 0) show_way(d, p, r, &w->at[k], w->never > 0 || w->lost > 0 || w->n > 1);
  }
}

// All roots, with both signs of the velocity where it matters: nothing tells which comes first.
static void show_all(pl_analysis* d, const pl_search* p, const rates* r) {
  ways w = {.never = 1, .tried = 1};
  for (int k = 0; k < p->n_roots; k++) {
    for (int sign = 1; sign >= -1; sign -= 2) {
      outcome o = {.kind = MET, .root = k, .lost = -1, .at = {.sign = sign}};
      if (sign > 0 || (p->line && pl_has_symbol(d->pool, p->asked, speed_of(d, p))))
        add_way(&w, &o);
    }
  }
  show_drawn(d, p, r, &w);
}

void pl_search_motion(pl_analysis* d, const pl_search* p) {
  numeric x;
  make_numeric(d, p, &x);
  rates r = {0};
  collect_rates(d, p->condition, p->s, &r);
  if (p->line) collect_rates(d, p->line->v2, p->s, &r);
  pl_symbol open[most_symbols];
  int n = unknown_names(d, &x, open);
  if (n == 0 && with_given_numbers(d, p, &x, &r)) return;
  ways w = {0};
  if (n > 0) follow_drawn(d, &x, &r, open, n, &w);
  if (w.tried > 0) show_drawn(d, p, &r, &w);
  else show_all(d, p, &r);
}
