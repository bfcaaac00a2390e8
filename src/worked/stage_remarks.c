// stage_remarks: which contacts are open, what sticks and slips, and where a stretch of the motion
// ends.
#include <string.h>

#include "worked/sets_impl.h"

static const pl_form* zero_form(pl_analysis* d) {
  return pl_form_leaf(d->arena, pl_int(d->pool, 0));
}

bool pl_would_pull(const pl_analysis* d, const pl_open* o) {
  int row = pl_stage_row(d->stage, pl_stage_label(o->source));
  return row >= 0 && d->stage->pulls[row];
}

// y > 0
const pl_form* pl_form_apart(pl_analysis* d, const pl_constraint* c) {
  return pl_frel(d, pl_fe(d, c->left), c->relation == PL_GE ? ">" : "<", pl_fe(d, c->right));
}

static const pl_form* form_met(pl_analysis* d, const pl_constraint* c) {
  return pl_feq(d, pl_fe(d, c->left), pl_fe(d, c->right));
}

const char* pl_stage_seconds(pl_analysis* d, double t, pl_language lang) {
  const char* number = pl_notation_number(d->arena, t, 6, (pl_notation){PL_MATH_LINE, lang});
  return pl_format(d->arena, "t = %s%s", number, d->model->uses_units ? " s" : "");
}

const pl_form* pl_moment_form(pl_analysis* d, double t) {
  return pl_form_words(d->arena, pl_stage_seconds(d, t, PL_ENGLISH),
                       pl_stage_seconds(d, t, PL_GERMAN));
}

static const pl_constraint* constraint_named(const pl_analysis* d, const char* label) {
  return label ? pl_model_constraint(d->whole, label) : NULL;
}

static const pl_event* event_named(const pl_analysis* d, const char* label) {
  for (int k = 0; label && k < d->whole->events.n; k++) {
    const pl_name* name = &d->whole->events.at[k].name;
    if (strcmp(name->text, label) == 0 || (name->ascii && strcmp(name->ascii, label) == 0))
      return &d->whole->events.at[k];
  }
  return NULL;
}

static const pl_stage_rub* rub_on(const pl_stage* s, const char* label) {
  for (int k = 0; label && k < s->n_rubs; k++) {
    if (strcmp(s->rubs[k].on, label) == 0) return &s->rubs[k];
  }
  return NULL;
}

static pl_expr size_of_multiplier(pl_analysis* d, const pl_stage_rub* rub, const pl_constraint* c) {
  pl_expr lambda = pl_sym(d->pool, c->lambda);
  return rub->press * (d->model->lambda_minus ? -1 : 1) > 0 ? lambda : pl_neg(d->pool, lambda);
}

// |friction_floor| = μ λ
static const pl_form* limit_form(pl_analysis* d, const pl_stage_rub* rub, const pl_constraint* c) {
  pl_symbol F = pl_symbol_find(d->pool, pl_format(d->arena, "friction_%s", rub->on));
  pl_expr most = pl_mul(d->pool, rub->limit, size_of_multiplier(d, rub, c));
  return pl_feq(d, pl_fe(d, pl_call(d->pool, PL_ABS, pl_sym(d->pool, F))), pl_fe(d, most));
}

// The force that sticking takes, as far as it is solved.
static void show_sticking_force(pl_analysis* d, const pl_stage_rub* rub) {
  for (int k = 0; k < d->g.n; k++) {
    const pl_bond* l = &d->g.at[k];
    if (!l->source->sticking || strcmp(l->source->name.text, rub->name) != 0 || !l->lambda_known)
      continue;
    const pl_form* form = pl_f(d, l->lambda_value, PL_S_QUOTIENT);
    bool known;
    pl_step_value(d, pl_show_numbered(d, pl_feq(d, pl_fs(d, l->lambda), form)), l->lambda_value,
                  pl_dimension_of_expr(d, l->lambda_value, &known));
    pl_claim_that(d, PL_CLAIM_MOTION, pl_form_value(d->pool, form), pl_sym(d->pool, l->lambda));
    pl_answer(d, pl_symbol_get(d->pool, l->lambda)->ascii, l->lambda_value, form)->of = rub->on;
  }
}

// The velocity of slip with the contacts of the set closed.
static const pl_form* slip_form(pl_analysis* d, const pl_stage_rub* rub) {
  pl_expr slip = pl_alg_normal(d->tower, pl_on_contact(d, rub->slip));
  return pl_f(d, pl_is_poison(slip) ? rub->slip : slip, PL_S_PLAIN);
}

// Friction of the set: what sticks, and what slips with which force.
void pl_tell_friction(pl_analysis* d) {
  for (int k = 0; d->stage && k < d->stage->n_rubs; k++) {
    const pl_stage_rub* rub = &d->stage->rubs[k];
    const pl_constraint* c = constraint_named(d, rub->on);
    if (!c || (!rub->sticks && !rub->slips)) continue;
    const pl_form* slip = pl_frel(d, slip_form(d, rub),
                                  rub->sticks    ? "="
                                  : rub->way > 0 ? ">"
                                                 : "<",
                                  zero_form(d));
    if (rub->sticks) {
      pl_say(d, PL_BOTH("Friction on {1} sticks, {2}, as long as {3}."), 3, pl_fn(d, c->name.text),
             slip, pl_frel(d, limit_form(d, rub, c)->args[0], "≤", limit_form(d, rub, c)->args[1]));
      show_sticking_force(d, rub);
    } else {
      pl_expr force = pl_mul(d->pool, rub->scale, size_of_multiplier(d, rub, c));
      pl_say(d, PL_BOTH("Friction on {1} slips, {2}, with the force {3} against the slip."), 3,
             pl_fn(d, c->name.text), slip, pl_fe(d, force));
    }
  }
}

// e = 0 with its negative terms on the right: t = 1/2, and not t - 1/2 = 0.
static const pl_form* equation_form(pl_analysis* d, pl_expr e) {
  pl_pool* p = d->pool;
  pl_expr right = pl_int(p, 0), left = right;
  int n = pl_kind_of(p, e) == PL_ADD ? pl_n_args(p, e) : 0;
  for (int k = 0; k < n; k++) {
    pl_expr term = pl_arg(p, e, k), opposite = pl_neg(p, term);
    bool negative = pl_op_count(p, opposite) < pl_op_count(p, term)
                    || (pl_is_number(p, term) && pl_number_sign(p, term) < 0);
    if (negative) right = pl_add(p, right, opposite);
    else left = pl_add(p, left, term);
  }
  bool split = n > 0 && !pl_is_zero_node(p, left);
  return pl_feq(d, pl_fe(d, split ? left : e), split ? pl_fe(d, right) : zero_form(d));
}

const pl_form* pl_border_form(pl_analysis* d, pl_expr e) {
  pl_expr opposite = pl_neg(d->pool, e);
  bool shorter = pl_op_count(d->pool, opposite) < pl_op_count(d->pool, e);
  return equation_form(d, shorter ? opposite : e);
}

// The equation that ends a stage: y = 0, λ = 0, or the condition of an event. NULL when there is
// none to show.
const pl_form* pl_form_end(pl_analysis* d, const pl_stage* s) {
  if (s->end == PL_END_SIDE) return pl_border_form(d, s->crossed);
  const pl_constraint* c = constraint_named(d, s->ended_by);
  if (s->end == PL_END_CLOSES && c) return form_met(d, c);
  const pl_stage_rub* rub = rub_on(s, s->ended_by);
  if (s->end == PL_END_STICKS && rub) return pl_feq(d, slip_form(d, rub), zero_form(d));
  if (s->end == PL_END_SLIPS && rub && rub->sticks && c) return limit_form(d, rub, c);
  if (s->end == PL_END_SLIPS && rub) return pl_feq(d, slip_form(d, rub), zero_form(d));
  if (s->end == PL_END_OPENS && c) return pl_feq(d, pl_fs(d, c->lambda), zero_form(d));
  const pl_event* e = s->end == PL_END_EVENT ? event_named(d, s->ended_by) : NULL;
  return e ? equation_form(d, e->value) : NULL;
}

// Before the constraints change, the motion may come to the other side of a sign.
void pl_say_stage_end(pl_analysis* d, const pl_stage* s) {
  pl_leaving l;
  pl_expr crossed;
  const pl_form* end = pl_form_end(d, s);
  if (s->end != PL_END_SIDE && pl_leaves_first(d, s, &l, &crossed)) {
    pl_say(d, PL_BOTH("This holds until {1}, at {2}."), 2, pl_border_form(d, crossed),
           pl_moment_form(d, l.t));
    return;
  }
  if (end) {
    pl_say(d, PL_BOTH("This holds until {1}, at {2}."), 2, end, pl_moment_form(d, s->to));
  } else if (s->end == PL_END_OF_RUN) {
    pl_say(d, PL_BOTH("This holds to the end of the simulation, {1}."), 1,
           pl_moment_form(d, s->to));
  }
}

// What is apart at the start: from the model's point of view those that were not switched off.
static int list_open(pl_analysis* d, const pl_form** label, const pl_form** apart, bool pulling) {
  int n = 0;
  for (int k = 0; k < d->open.n; k++) {
    const pl_open* o = &d->open.at[k];
    if (!o->contact || o->released || pl_would_pull(d, o) != pulling) continue;
    label[n] = pl_fn(d, o->source->name.text);
    apart[n++] = pl_form_apart(d, o->source);
  }
  return n;
}

void pl_tell_open(pl_analysis* d) {
  if (d->page->open_told || (d->open.n == 0 && d->model->frictions.n == 0)) return;
  d->page->open_told = true;
  pl_tell_friction(d);
  pl_use_signs_of_open(d);
  const pl_form **label = PL_ARRAY(d->arena, const pl_form*, d->open.n + 1),
                **apart = PL_ARRAY(d->arena, const pl_form*, d->open.n + 1);
  int n = list_open(d, label, apart, true);
  if (n > 0) {
    pl_say(
        d,
        PL_BOTH(n == 1 ? "At the start the force of {1} would have to pull: it lets go at once."
                       : "At the start the forces of {1} would have to pull: they let go at once."),
        1, pl_flist(d, label, n));
  }
  n = list_open(d, label, apart, false);
  if (n > 0) {
    pl_say(d,
           PL_BOTH(n == 1 ? "{1} is open at the start, {2}, and not in the equations."
                          : "{1} are open at the start, {2}, and not in the equations."),
           2, pl_flist(d, label, n), pl_flist(d, apart, n));
  }
  if (d->stage) pl_say_stage_end(d, d->stage);
}

void pl_note_undecided(pl_analysis* d) {
  if (d->stage) return;
  for (int k = 0; k < d->g.n; k++) {
    const pl_bond* l = &d->g.at[k];
    if (!l->contact) continue;
    const char *label = l->source->name.text, *lambda = pl_symbol_get(d->pool, l->lambda)->name;
    bool push = (l->source->relation == PL_GE) != d->model->lambda_minus;
    pl_diagnostic* m = pl_report(
        d->job->diagnostics, PL_N075, l->source->span,
        PL_BOTH_FORMAT(d->arena, "%s is taken as closed: no start with numbers decides", label));
    const char* closed = pl_notation_print(
        d->arena, d->pool, form_met(d, l->source),
        (pl_notation){.math = PL_MATH_LINE, .lang = d->job->lang});
    pl_report_reason(m, PL_BOTH_FORMAT(d->arena, "the formulas hold while %s and %s %s 0", closed,
                                       lambda, push ? "≥" : "≤"));
  }
}
