// sets: which constraints the equations contain. Contacts open and close, constraints are released
// and attached; each set that holds for a while has equations of its own, and an analysis of its
// own derives them. What holds when was found by the simulation (pl_stage); without numbers the
// signs at the start decide where they are provable, and the rest is taken as closed.
//
// Needs a model whose families are written out. The analyses share pool, solution and equation
// numbers.
#include <math.h>
#include <string.h>

#include "derive/derive_impl.h"

enum { MOST_LATER_STAGES = 5 };

// -------------------------------------------------------------------------------------- what holds
static int row_of(const pl_stage* s, const char* name) {
  for (int i = 0; s && i < s->n; i++) {
    if (strcmp(s->name[i], name) == 0) return i;
  }
  return -1;
}

static const char* label_of(const pl_constraint* c) {
  return c->name.ascii ? c->name.ascii : c->name.text;
}

static const char* map_name(pl_analysis* d, const pl_model* m, int k) {
  return pl_format(d->arena, "choose %s", pl_expr_text(d->arena, d->pool, m->choose.maps[k].old));
}

static pl_expr at_start(pl_analysis* d, const pl_model* m, pl_expr e) {
  for (int k = 0; k < m->inits.n; k++) {
    const pl_init* init = &m->inits.at[k];
    if (init->guess || pl_kind_of(d->pool, init->target) != PL_SYMBOL) continue;
    e = pl_subst1(d->pool, e, pl_symbol_of(d->pool, init->target), init->value);
  }
  return e;
}

// The sign of g of a contact at the start, or of its derivative where g is zero there: 1 open. Only
// what is proven.
static bool is_open_by_signs(pl_analysis* d, const pl_model* m, pl_tower* t,
                             const pl_constraint* c) {
  if (c->relation == PL_EQ || c->has_velocity) return false;
  int side = c->relation == PL_GE ? 1 : -1, sign = 0;
  pl_expr g = at_start(d, m, c->g);
  if (pl_has_coordinates(d, g)) return false;
  if (pl_alg_is_zero(t, g) == PL_YES) {
    g = at_start(d, m, pl_dt(d->pool, c->g));
    if (pl_has_coordinates(d, g)) return false;
  }
  return pl_alg_sign(t, g, false, &sign) == PL_YES && side * sign > 0;
}

static void leave_out(pl_analysis* d, const pl_constraint* c, bool released) {
  pl_push(
      d->arena, d->open,
      (pl_open){.source = c, .contact = c->relation != PL_EQ, .released = released, .off = c->off});
}

// Where signs decided, what they assumed is told.
static void use_signs(pl_analysis* d) {
  for (int k = 0; k < d->open.n && !d->stage; k++) {
    const pl_open* o = &d->open.at[k];
    pl_expr g = at_start(d, d->whole, o->source->g);
    if (o->contact && !o->off)
      pl_tower_use(d->tower,
                   (pl_fact){o->source->relation == PL_GE ? g : pl_neg(d->pool, g), true});
  }
}

static bool is_left_out(const pl_analysis* d, const char* label) {
  for (int k = 0; k < d->open.n; k++) {
    const pl_name* name = &d->open.at[k].source->name;
    if (strcmp(name->text, label) == 0 || (name->ascii && strcmp(name->ascii, label) == 0))
      return true;
  }
  return false;
}

bool pl_knows_friction(const pl_analysis* d) {
  return d->model->frictions.n == 0 || (d->stage && d->stage->rubs_known);
}

const pl_stage_rub* pl_slipping_on(const pl_analysis* d, const pl_constraint* c) {
  for (int k = 0; d->stage && k < d->stage->n_rubs; k++) {
    const pl_stage_rub* rub = &d->stage->rubs[k];
    if (rub->slips && strcmp(rub->on, label_of(c)) == 0) return rub;
  }
  return NULL;
}

// Surfaces that stick are a constraint between velocities; its multiplier is the friction along the
// tangent.
static void add_sticking(pl_analysis* d, pl_model* m) {
  for (int k = 0; d->stage && k < d->stage->n_rubs; k++) {
    const pl_stage_rub* rub = &d->stage->rubs[k];
    if (!rub->sticks) continue;
    const char* name = pl_format(d->arena, "friction_%s", rub->on);
    pl_symbol s = pl_symbol_find(d->pool, name);
    if (!s.id)
      s = pl_symbol_make(
          d->pool, &(pl_symbol_info){
                       .name = name, .ascii = name, .role = PL_R_MULTIPLIER, .class = PL_C_OTHER});
    const pl_constraint* on = pl_model_constraint(d->whole, rub->on);
    pl_constraint c = {.name = {.text = rub->name, .ascii = rub->name, .index = pl_poison()},
                       .left = rub->slip,
                       .right = pl_int(d->pool, 0),
                       .g = rub->slip,
                       .relation = PL_EQ,
                       .lambda = s,
                       .redundant_ok = true,
                       .has_velocity = true,
                       .sticking = true,
                       .span = on ? on->span : (pl_span){0}};
    pl_push(d->arena, m->constraints, c);
  }
}

static void choose_constraints(pl_analysis* d, const pl_model* whole, pl_model* m) {
  pl_tower* t = d->stage ? NULL : pl_setup_tower(d);
  m->constraints.n = m->constraints.cap = 0;
  m->constraints.at = NULL;
  for (int k = 0; k < whole->constraints.n; k++) {
    const pl_constraint* c = &whole->constraints.at[k];
    int row = row_of(d->stage, label_of(c));
    bool holds = row >= 0 ? d->stage->holds[row]
                          : !c->off && !(t && is_open_by_signs(d, whole, t, c));
    if (row < 0 && c->while_label && is_left_out(d, c->while_label)) holds = false;
    if (!holds) {
      leave_out(d, c, row >= 0 ? d->stage->released[row] : c->off);
      continue;
    }
    pl_constraint kept = *c;
    kept.off = false;
    pl_push(d->arena, m->constraints, kept);
  }
  if (t) pl_tower_free(t);
}

static bool is_named_by(const pl_analysis* d, const pl_choose* c, pl_symbol s) {
  for (int k = 0; k < c->n_maps; k++) {
    if (pl_has_symbol(d->pool, c->maps[k].map, s)) return true;
  }
  return false;
}

// Maps go with the constraints that they take for granted, and with them the names that only they
// explain.
static void choose_maps(pl_analysis* d, const pl_model* whole, pl_model* m) {
  pl_choose* c = &m->choose;
  c->maps = PL_ARRAY(d->arena, struct pl_map_equation, whole->choose.n_maps + 1);
  c->n_maps = 0;
  for (int k = 0; k < whole->choose.n_maps; k++) {
    int row = row_of(d->stage, map_name(d, whole, k));
    if (row < 0 || d->stage->holds[row]) c->maps[c->n_maps++] = whole->choose.maps[k];
  }
  c->coords.at = NULL;
  c->coords.n = c->coords.cap = 0;
  for (int k = 0; k < whole->choose.coords.n; k++) {
    pl_symbol s = whole->choose.coords.at[k];
    if (is_named_by(d, &whole->choose, s) && !is_named_by(d, c, s))
      pl_push(d->arena, d->unnamed, s);
    else pl_push(d->arena, c->coords, s);
  }
}

void pl_choose_set(pl_analysis* d, pl_model* whole, const pl_stage* stage) {
  d->whole = whole;
  d->stage = stage;
  d->model = PL_NEW(d->arena, pl_model);
  *d->model = *whole;
  choose_constraints(d, whole, d->model);
  add_sticking(d, d->model);
  choose_maps(d, whole, d->model);
}

// -------------------------------------------------------------------------- sets that were derived
static bool same_set(const pl_analysis* d, const pl_stage* s) {
  const pl_model* m = d->whole;
  for (int k = 0; k < m->constraints.n; k++) {
    const char* label = label_of(&m->constraints.at[k]);
    int row = row_of(s, label);
    if (row >= 0 && s->holds[row] == is_left_out(d, label)) return false;
  }
  int n = d->stage ? d->stage->n_rubs : 0;
  if (n != s->n_rubs) return n == 0 && s->n_rubs == 0;
  for (int k = 0; k < n; k++) {
    const pl_stage_rub *a = &d->stage->rubs[k], *b = &s->rubs[k];
    if (a->sticks != b->sticks || a->slips != b->slips) return false;
    if (a->slips && a->way * a->press != b->way * b->press) return false;
  }
  return true;
}

// One that is there; NULL.
static pl_analysis* find_analysis(pl_analysis* first, const pl_stage* s) {
  for (int k = 0; k < first->sets.n; k++) {
    pl_analysis* d = first->sets.at[k];
    if (same_set(d, s) && pl_same_sides(d, s)) return d;
  }
  return NULL;
}

// The analysis of a stage: one that is there, or a new one.  NULL when it could not be derived.
static pl_analysis* analysis_in(pl_analysis* first, const pl_stage* s) {
  pl_analysis* d = find_analysis(first, s);
  if (d) {
    d->stage = s;
    return d;
  }
  d = pl_analysis_make(first, s);
  if (d) pl_push(first->arena, first->sets, d);
  return d;
}

// The set of constraints that an analysis was derived for, as a stage of its own.
static pl_stage* stage_like(pl_analysis* d) {
  pl_stage* s = PL_NEW(d->arena, pl_stage);
  if (d->stage) {
    *s = *d->stage;
    return s;
  }
  int n = d->whole->constraints.n;
  const char** name = PL_ARRAY(d->arena, const char*, n + 1);
  bool *holds = PL_ARRAY(d->arena, bool, n + 1), *no = PL_ARRAY(d->arena, bool, n + 1);
  for (int k = 0; k < n; k++) {
    name[k] = label_of(&d->whole->constraints.at[k]);
    holds[k] = !is_left_out(d, name[k]);
  }
  *s = (pl_stage){.n = n, .name = name, .holds = holds, .released = no, .pulls = no, .rope = no};
  return s;
}

// The same constraints with other signs: those that change come first.
static pl_stage* turned(pl_analysis* d, const pl_fact* side, int n, const bool* through) {
  pl_stage* s = stage_like(d);
  pl_fact* out = PL_ARRAY(d->arena, pl_fact, n + 1);
  int turns = 0, stays = 0;
  for (int k = 0; k < n; k++) turns += through[k];
  s->sides = out;
  s->n_sides = n;
  s->n_crossed = turns;
  for (int k = 0; k < n; k++) {
    pl_expr e = side[k].difference;
    if (through[k]) out[--turns] = (pl_fact){pl_neg(d->pool, e), false};
    else out[s->n_crossed + stays++] = (pl_fact){e, false};
  }
  return s;
}

pl_analysis* pl_analysis_beyond(pl_analysis* d, const pl_fact* side, int n, const bool* through) {
  pl_stage* s = turned(d, side, n, through);
  s->end = PL_END_UNKNOWN;
  s->n_q = 0;  // no motion is meant
  return analysis_in(d->first, s);
}

pl_analysis* pl_analysis_of(pl_analysis* first, const pl_ask* ask) {
  const pl_derive_options* o = first->options;
  const pl_stage* own = o->n_stages > 0 ? &o->stages[0] : NULL;
  if (ask->motion.given && o->stage_from) {
    const pl_stage* s = o->stage_from(o->user, &ask->motion);
    if (s) return analysis_in(first, s);
  }
  first->stage = own;
  return first;
}

pl_analysis* pl_without_sticking(pl_analysis* first) {
  bool sticks = false;
  for (int k = 0; first->stage && k < first->stage->n_rubs; k++)
    sticks |= first->stage->rubs[k].sticks;
  if (!sticks || first->sets.n == 0) return first;
  pl_stage* s = PL_NEW(first->arena, pl_stage);
  *s = *first->stage;
  s->n_rubs = 0;
  pl_analysis* d = analysis_in(first, s);
  return d ? d : first;
}

// ------------------------------------------------------------------------------------ what is open
pl_expr pl_open_removed(pl_analysis* d, pl_expr e) {
  for (int k = 0; k < d->open.n; k++) {
    pl_symbol lambda = d->open.at[k].source->lambda;
    if (lambda.id && pl_has_symbol(d->pool, e, lambda))
      e = pl_subst1(d->pool, e, lambda, pl_int(d->pool, 0));
  }
  return e;
}

static bool asks_lambda(const pl_analysis* d, pl_expr e, const pl_open* o) {
  return !pl_is_poison(e) && o->source->lambda.id && pl_same(e, pl_sym(d->pool, o->source->lambda));
}

// A request for the force of an open constraint, or for the place where that vanishes.
static bool is_about(const pl_analysis* d, const pl_ask* ask, const pl_open* o) {
  const pl_name* name = &o->source->name;
  if (ask->kind == PL_ASK_EXPECT) return false;  // decided with λ = 0
  if (ask->kind == PL_ASK_FORCE_OF && ask->label)
    return strcmp(name->text, ask->label) == 0
           || (name->ascii && strcmp(name->ascii, ask->label) == 0);
  if (asks_lambda(d, ask->value, o)) return true;
  for (int k = 0; k < ask->where.n; k++) {
    if (asks_lambda(d, ask->where.at[k].left, o) || asks_lambda(d, ask->where.at[k].right, o))
      return true;
  }
  return false;
}

static bool would_pull(const pl_analysis* d, const pl_open* o) {
  int row = row_of(d->stage, label_of(o->source));
  return row >= 0 && d->stage->pulls[row];
}

static const pl_form* zero_form(pl_analysis* d) {
  return pl_form_leaf(d->arena, pl_int(d->pool, 0));
}

// y > 0
static const pl_form* apart_form(pl_analysis* d, const pl_constraint* c) {
  return pl_frel(d, pl_fe(d, c->left), c->relation == PL_GE ? ">" : "<", pl_fe(d, c->right));
}

static const pl_form* met_form(pl_analysis* d, const pl_constraint* c) {
  return pl_feq(d, pl_fe(d, c->left), pl_fe(d, c->right));
}

static void say_open(pl_analysis* d, const pl_open* o) {
  const pl_form *label = pl_fn(d, o->source->name.text),
                *none = pl_feq(d, pl_fs(d, o->source->lambda), zero_form(d));
  if (would_pull(d, o)) {
    pl_say(d, "At this start the force of {1} would have to pull: it lets go at once, and {2}.",
           "Bei diesem Start müsste die Kraft von {1} ziehen: die Bedingung löst sich sofort, und "
           "{2}.",
           2, label, none);
  } else if (o->contact && !o->released) {
    pl_say(d, "{1} is open here, {2}: it exerts no force, {3}.",
           "{1} ist hier offen, {2}: es wirkt keine Kraft, {3}.", 3, label,
           apart_form(d, o->source), none);
  } else {
    pl_say(d, "{1} does not hold here: it exerts no force, {2}.",
           "{1} gilt hier nicht: es wirkt keine Kraft, {2}.", 2, label, none);
  }
}

static const char* german_force(pl_analysis* d, const pl_open* o) {
  return pl_format(d->arena, "Zwangskraft von %s", o->source->name.text);
}

// A name that only a map explains, whose constraint does not hold.
static bool speaks_of_unnamed(pl_analysis* d, const pl_ask* ask, pl_symbol* which) {
  for (int k = 0; k < d->unnamed.n; k++) {
    pl_symbol q = d->unnamed.at[k], v = pl_symbol_dot(d->pool, q),
              name[3] = {q, v, pl_symbol_dot(d->pool, v)};
    for (int j = 0; j < 3; j++) {
      bool here = !pl_is_poison(ask->value) && pl_has_symbol(d->pool, ask->value, name[j]);
      for (int c = 0; c < ask->where.n; c++) {
        here |= pl_has_symbol(d->pool, ask->where.at[c].left, name[j])
                || pl_has_symbol(d->pool, ask->where.at[c].right, name[j]);
      }
      if (!here) continue;
      *which = q;
      return true;
    }
  }
  return false;
}

bool pl_answer_open(pl_analysis* d, const pl_ask* ask) {
  for (int k = 0; k < d->open.n; k++) {
    const pl_open* o = &d->open.at[k];
    if (!is_about(d, ask, o)) continue;
    bool force = ask->kind == PL_ASK_FORCE_OF;
    bool told = d->open_told;
    d->open_told = true;  // said here in other words
    pl_section_open(d, ask,
                    force ? pl_format(d->arena, "Force of %s", o->source->name.text) : ask->text,
                    force ? german_force(d, o) : ask->text);
    d->open_told = told;
    say_open(d, o);
    if (ask->where.n > 0 || !o->source->lambda.id) return true;
    pl_answer(d, pl_symbol_get(d->pool, o->source->lambda)->ascii, pl_int(d->pool, 0), zero_form(d))
        ->of = o->source->name.text;
    return true;
  }
  pl_symbol s;
  if (!speaks_of_unnamed(d, ask, &s)) return false;
  pl_section_open(d, ask, ask->text, ask->text);
  pl_say(d, "{1} names the place only while the constraints of its map hold, and here they do not.",
         "{1} benennt den Ort nur, solange die Zwangsbedingungen der Abbildung gelten, und hier "
         "gelten sie nicht.",
         1, pl_fs(d, s));
  d->section->not_found = true;
  return true;
}

const pl_ask* pl_without_open(pl_analysis* d, const pl_ask* ask) {
  if (d->open.n == 0) return ask;
  pl_ask* out = PL_NEW(d->arena, pl_ask);
  *out = *ask;
  out->value = pl_open_removed(d, ask->value);
  out->where.at = PL_ARRAY(d->arena, pl_condition, ask->where.n + 1);
  for (int k = 0; k < ask->where.n; k++) {
    out->where.at[k] = ask->where.at[k];
    out->where.at[k].left = pl_open_removed(d, ask->where.at[k].left);
    out->where.at[k].right = pl_open_removed(d, ask->where.at[k].right);
  }
  return out;
}

// ----------------------------------------------------------------------------------------- telling
static const char* seconds(pl_analysis* d, double t, pl_language lang) {
  const char* number = pl_notation_number(d->arena, t, 6, (pl_notation){PL_MATH_LINE, lang});
  return pl_format(d->arena, "t = %s%s", number, d->model->uses_units ? " s" : "");
}

const pl_form* pl_moment_form(pl_analysis* d, double t) {
  return pl_form_words(d->arena, seconds(d, t, PL_ENGLISH), seconds(d, t, PL_GERMAN));
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
static void tell_friction(pl_analysis* d) {
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
      pl_say(d, "Friction on {1} sticks, {2}, as long as {3}.",
             "Die Reibung auf {1} haftet, {2}, solange {3}.", 3, pl_fn(d, c->name.text), slip,
             pl_frel(d, limit_form(d, rub, c)->args[0], "≤", limit_form(d, rub, c)->args[1]));
      show_sticking_force(d, rub);
    } else {
      pl_expr force = pl_mul(d->pool, rub->scale, size_of_multiplier(d, rub, c));
      pl_say(d, "Friction on {1} slips, {2}, with the force {3} against the slip.",
             "Die Reibung auf {1} gleitet, {2}, mit der Kraft {3} gegen das Gleiten.", 3,
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
static const pl_form* end_form(pl_analysis* d, const pl_stage* s) {
  if (s->end == PL_END_SIDE) return pl_border_form(d, s->crossed);
  const pl_constraint* c = constraint_named(d, s->ended_by);
  if (s->end == PL_END_CLOSES && c) return met_form(d, c);
  const pl_stage_rub* rub = rub_on(s, s->ended_by);
  if (s->end == PL_END_STICKS && rub) return pl_feq(d, slip_form(d, rub), zero_form(d));
  if (s->end == PL_END_SLIPS && rub && rub->sticks && c) return limit_form(d, rub, c);
  if (s->end == PL_END_SLIPS && rub) return pl_feq(d, slip_form(d, rub), zero_form(d));
  if (s->end == PL_END_OPENS && c) return pl_feq(d, pl_fs(d, c->lambda), zero_form(d));
  const pl_event* e = s->end == PL_END_EVENT ? event_named(d, s->ended_by) : NULL;
  return e ? equation_form(d, e->value) : NULL;
}

// Before the constraints change, the motion may come to the other side of a sign.
static void say_end(pl_analysis* d, const pl_stage* s) {
  pl_leaving l;
  pl_expr crossed;
  const pl_form* end = end_form(d, s);
  if (s->end != PL_END_SIDE && pl_leaves_first(d, s, &l, &crossed)) {
    pl_say(d, "This holds until {1}, at {2}.", "Das gilt bis {1}, bei {2}.", 2,
           pl_border_form(d, crossed), pl_moment_form(d, l.t));
    return;
  }
  if (end) {
    pl_say(d, "This holds until {1}, at {2}.", "Das gilt bis {1}, bei {2}.", 2, end,
           pl_moment_form(d, s->to));
  } else if (s->end == PL_END_OF_RUN) {
    pl_say(d, "This holds to the end of the simulation, {1}.",
           "Das gilt bis zum Ende der Simulation, {1}.", 1, pl_moment_form(d, s->to));
  }
}

// What is apart at the start: from the model's point of view those that were not switched off.
static int list_open(pl_analysis* d, const pl_form** label, const pl_form** apart, bool pulling) {
  int n = 0;
  for (int k = 0; k < d->open.n; k++) {
    const pl_open* o = &d->open.at[k];
    if (!o->contact || o->released || would_pull(d, o) != pulling) continue;
    label[n] = pl_fn(d, o->source->name.text);
    apart[n++] = apart_form(d, o->source);
  }
  return n;
}

void pl_tell_open(pl_analysis* d) {
  if (d->open_told || (d->open.n == 0 && d->model->frictions.n == 0)) return;
  d->open_told = true;
  tell_friction(d);
  use_signs(d);
  const pl_form **label = PL_ARRAY(d->arena, const pl_form*, d->open.n + 1),
                **apart = PL_ARRAY(d->arena, const pl_form*, d->open.n + 1);
  int n = list_open(d, label, apart, true);
  if (n > 0) {
    pl_say(d,
           n == 1 ? "At the start the force of {1} would have to pull: it lets go at once."
                  : "At the start the forces of {1} would have to pull: they let go at once.",
           n == 1
               ? "Beim Start müsste die Kraft von {1} ziehen: die Bedingung löst sich sofort."
               : "Beim Start müssten die Kräfte von {1} ziehen: die Bedingungen lösen sich sofort.",
           1, pl_flist(d, label, n));
  }
  n = list_open(d, label, apart, false);
  if (n > 0) {
    pl_say(d,
           n == 1 ? "{1} is open at the start, {2}, and not in the equations."
                  : "{1} are open at the start, {2}, and not in the equations.",
           n == 1 ? "{1} ist beim Start offen, {2}, und steht nicht in den Gleichungen."
                  : "{1} sind beim Start offen, {2}, und stehen nicht in den Gleichungen.",
           2, pl_flist(d, label, n), pl_flist(d, apart, n));
  }
  if (d->stage) say_end(d, d->stage);
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
        pl_format(d->arena, "%s is taken as closed: no start with numbers decides", label),
        pl_format(d->arena, "%s gilt als geschlossen: kein Start mit Zahlen entscheidet", label));
    const char* closed = pl_notation_print(
        d->arena, d->pool, met_form(d, l->source),
        (pl_notation){.math = PL_MATH_LINE, .lang = d->job->lang});
    pl_report_reason(m,
                     pl_format(d->arena, "the formulas hold while %s and %s %s 0", closed, lambda,
                               push ? "≥" : "≤"),
                     pl_format(d->arena, "die Formeln gelten, solange %s und %s %s 0", closed,
                               lambda, push ? "≥" : "≤"));
  }
}

// ------------------------------------------------------------------------ with all contacts closed
// A body at rest may lie on what is open at the start: the set with every contact closed. NULL when
// none is open.
static pl_stage* all_closed(pl_analysis* d) {
  bool any = false;
  for (int k = 0; k < d->open.n; k++) any |= d->open.at[k].contact && !d->open.at[k].released;
  if (!any || !d->stage) return NULL;
  pl_stage* s = PL_NEW(d->arena, pl_stage);
  *s = *d->stage;
  bool *holds = PL_ARRAY(d->arena, bool, s->n + 1), *none = PL_ARRAY(d->arena, bool, s->n + 1);
  for (int i = 0; i < s->n; i++) holds[i] = !s->released[i];
  s->holds = holds;
  s->pulls = none;
  s->end = PL_END_UNKNOWN;
  return s;
}

void pl_answer_closed(pl_analysis* first, const pl_ask* ask) {
  if (ask->kind != PL_ASK_EQUILIBRIA) return;
  const pl_stage* s = all_closed(first);
  pl_analysis* d = s ? analysis_in(first, s) : NULL;
  if (!d || !d->reduced) return;
  pl_section* own = &first->solution->sections.at[first->solution->sections.n - 1];
  own->title[0] = "Equilibria as the start has the contacts";
  own->title[1] = "Gleichgewichtslagen mit den Kontakten des Starts";
  pl_answer_one(d, ask);
  d->section->beside = true;
  d->section->title[0] = "Equilibria with all contacts closed";
  d->section->title[1] = "Gleichgewichtslagen mit allen Kontakten geschlossen";
}

// ---------------------------------------------------------------------------------- the later sets
// What hangs on the set, and is asked about the motion of `init`.
static bool is_repeated(const pl_analysis* d, const pl_ask* ask) {
  bool told = d->stage->n_sides > 0 && ask->kind == PL_ASK_EQUILIBRIA;  // for all sides already
  if (told) return false;
  switch (ask->kind) {
    case PL_ASK_LAGRANGE1:
    case PL_ASK_LAGRANGE2:
    case PL_ASK_NEWTON:
    case PL_ASK_SOLVE:
    case PL_ASK_FORCE_OF:
    case PL_ASK_FORCE_ON:
    case PL_ASK_CONSERVED:
    case PL_ASK_EQUILIBRIA: return true;
    case PL_ASK_VALUE: return ask->where.n == 0 && !ask->motion.given;
    default: return false;
  }
}

static bool contains_time(pl_analysis* d) {
  bool any = !pl_scleronomic(d);
  for (int i = 0; i < d->q.n; i++) any |= pl_has_symbol(d->pool, d->force[i], pl_time(d->pool));
  return any;
}

static bool is_motion(const pl_ask* ask) { return ask->kind == PL_ASK_SOLVE && ask->of_time; }

// What speaks of t or of the start means those of the whole motion: a stretch in the middle has
// another clock.
static bool fits_clock(pl_analysis* d, const pl_ask* ask) {
  if (is_motion(ask)) return !contains_time(d);
  return pl_is_poison(ask->value) || !pl_has_role(d->pool, ask->value, PL_R_START);
}

// Answers a request for the set; what is not found there is left out.
static bool repeat(pl_analysis* d, const pl_ask* ask) {
  pl_ask again = *ask;
  again.letter = NULL;
  again.motion = (pl_motion){0};
  pl_symbol unnamed;
  if (speaks_of_unnamed(d, &again, &unnamed)) return false;
  for (int k = 0; k < d->open.n; k++) {
    if (is_about(d, &again, &d->open.at[k])) return false;
  }
  int sections = d->solution->sections.n, equations = d->solution->n_equations,
      claims = d->claims.n;
  pl_answer_one(d, &again);
  bool found = true;
  for (int k = sections; k < d->solution->sections.n; k++)
    found &= !d->solution->sections.at[k].not_found;
  if (found) return true;
  d->solution->sections.n = sections;
  d->solution->n_equations = equations;
  d->claims.n = claims;
  return false;
}

// What has become of a constraint, in one word.
typedef enum pl_state_word {
  PL_WORD_CONTACT,
  PL_WORD_ROPE,
  PL_WORD_DEED,
  PL_N_WORDS
} pl_state_word;
static const char* const state_word[PL_N_WORDS][2][2] = {
    // holds, does not; in two languages
    [PL_WORD_CONTACT] = {{"closed", "geschlossen"}, {"open", "offen"}},
    [PL_WORD_ROPE] = {{"taut", "straff"}, {"slack", "schlaff"}},
    [PL_WORD_DEED] = {{"attached", "befestigt"}, {"released", "gelöst"}},
};

static pl_state_word word_for(const pl_analysis* d, const pl_constraint* c) {
  int row = row_of(d->stage, label_of(c));
  if (c->relation == PL_EQ || d->stage->released[row]) return PL_WORD_DEED;
  return d->stage->rope[row] ? PL_WORD_ROPE : PL_WORD_CONTACT;
}

static int list_changes(pl_analysis* d, const pl_stage* before, bool holds, pl_state_word word,
                        const char** out) {
  int n = 0;
  for (int k = 0; k < d->whole->constraints.n; k++) {
    const pl_constraint* c = &d->whole->constraints.at[k];
    int now = row_of(d->stage, label_of(c)), then = row_of(before, label_of(c));
    if (now < 0 || then < 0 || d->stage->holds[now] != holds || before->holds[then] == holds
        || c->while_label)
      continue;
    if (word_for(d, c) != word) continue;
    out[n++] = c->name.text;
  }
  return n;
}

static void add_names(pl_text* t, const char* const* name, int n, const char* what, bool* any) {
  if (n == 0) return;
  if (*any) pl_text_add(t, ", ");
  for (int k = 0; k < n; k++) pl_text_addf(t, "%s%s", k ? ", " : "", name[k]);
  pl_text_addf(t, " %s", what);
  *any = true;
}

// "From t = 6.54427 s: h open"
static const char* stage_title(pl_analysis* d, pl_language lang) {
  const char** name = PL_ARRAY(d->arena, const char*, d->whole->constraints.n + 1);
  bool de = lang == PL_GERMAN;
  pl_text t = pl_text_make(d->arena);
  pl_text_addf(&t, de ? "Ab %s: " : "From %s: ", seconds(d, d->stage->from, lang));
  const pl_stage* first = &d->solution->stages.at[0];
  bool any = false;
  for (int holds = 1; holds >= 0; holds--) {
    for (int word = 0; word < PL_N_WORDS; word++) {
      int n = list_changes(d, first, holds, (pl_state_word)word, name);
      add_names(&t, name, n, state_word[word][!holds][de], &any);
    }
  }
  for (int k = 0; k < d->stage->n_crossed; k++) {
    const pl_form* side = pl_fact_form(d, &d->stage->sides[k]);
    const char* text = pl_notation_print(d->arena, d->pool, side,
                                         (pl_notation){PL_MATH_LINE, lang});
    pl_text_addf(&t, "%s%s", any ? ", " : "", text);
    any = true;
  }
  for (int k = 0; k < d->stage->n_rubs; k++) {
    const pl_stage_rub *now = &d->stage->rubs[k],
                       *then = k < first->n_rubs ? &first->rubs[k] : NULL;
    bool same = then && now->sticks == then->sticks && now->slips == then->slips
                && (!now->slips || now->way == then->way);
    if (same || (!now->sticks && !now->slips)) continue;
    add_names(&t, &now->on, 1,
              now->sticks ? (de ? "haftet" : "sticks") : (de ? "gleitet" : "slips"), &any);
  }
  return pl_text_string(&t);
}

// x = 20 m, ϑ = 48.2°
static const char* place_text(pl_analysis* d, const pl_stage* s, pl_language lang) {
  enum { most = 8 };
  pl_text t = pl_text_make(d->arena);
  double size = 0;
  for (int i = 0; i < s->n_q; i++) size = fmax(size, fabs(s->q[i]));
  for (int i = 0; i < s->n_q && i < most; i++) {
    bool angle = strcmp(s->q_unit[i], "rad") == 0;
    double x = fabs(s->q[i]) < 1e-14 * size ? 0 : angle ? s->q[i] * (180 / M_PI) : s->q[i];
    const char* number = pl_notation_number(d->arena, x, 6, (pl_notation){PL_MATH_LINE, lang});
    pl_symbol symbol = pl_symbol_find(d->pool, s->q_name[i]);
    const char* name = symbol.id ? pl_symbol_get(d->pool, symbol)->name : s->q_name[i];
    pl_text_addf(&t, "%s%s = %s%s%s", i ? ", " : "", name, number,
                 angle           ? "°"
                 : *s->q_unit[i] ? " "
                                 : "",
                 angle ? "" : s->q_unit[i]);
  }
  return pl_text_string(&t);
}

static void say_begin(pl_analysis* d, const pl_stage* before) {
  const pl_stage* s = d->stage;
  const pl_form* place = pl_form_words(d->arena, place_text(d, s, PL_ENGLISH),
                                       place_text(d, s, PL_GERMAN));
  const pl_form* end = before->to == s->from ? end_form(d, before) : NULL;
  if (end) {
    pl_say(d, "It begins where {1}: at {2}, {3}.", "Es beginnt, wo {1}: bei {2}, {3}.", 3, end,
           pl_moment_form(d, s->from), place);
  } else {
    pl_say(d, "It begins at {1}, {2}.", "Es beginnt bei {1}, {2}.", 2, pl_moment_form(d, s->from),
           place);
  }
  int n = d->dof.dof;
  pl_say(d, n == 1 ? "1 degree of freedom." : pl_format(d->arena, "%d degrees of freedom.", n),
         n == 1 ? "1 Freiheitsgrad." : pl_format(d->arena, "%d Freiheitsgrade.", n), 0);
  for (int k = 0; k < d->whole->asks.n; k++) {
    if (!is_motion(&d->whole->asks.at[k]) || contains_time(d)) continue;
    pl_say(d,
           "In the motions that follow {1} counts from here, and the start values are those of "
           "this moment.",
           "In den folgenden Bewegungen zählt {1} von hier, und die Startwerte sind die dieses "
           "Augenblicks.",
           1, pl_fs(d, pl_time(d->pool)));
    return;
  }
}

static void mark(pl_analysis* d, int from, int stage) {
  for (int k = from; k < d->solution->sections.n; k++) d->solution->sections.at[k].stage = stage;
}

// The section of a stage behind the requests.
static void answer_stage(pl_analysis* d, const pl_stage* s, const pl_stage* before, int k) {
  d->later = d->has_section = true;
  int from = d->solution->sections.n;
  pl_ask head = {.kind = PL_ASK_DOF, .text = pl_format(d->arena, "stage %d", k + 1)};
  pl_section_open(d, &head, stage_title(d, PL_ENGLISH), stage_title(d, PL_GERMAN));
  say_begin(d, before);
  say_end(d, s);
  pl_answer(d, "dof", pl_int(d->pool, d->dof.dof), NULL);
  d->open_told = true;
  tell_friction(d);
  bool any = false;
  for (int i = 0; i < d->whole->asks.n; i++) {
    const pl_ask* ask = &d->whole->asks.at[i];
    if (is_repeated(d, ask) && fits_clock(d, ask)) any |= repeat(d, ask);
  }
  pl_ask plain = {.kind = PL_ASK_LAGRANGE1, .text = "lagrange1"};
  if (!any) repeat(d, &plain);
  mark(d, from, k);
  for (int i = from; s->n_sides > 0 && i < d->solution->sections.n; i++)
    pl_assume_sides(d, &d->solution->sections.at[i], 0);
  d->later = false;
}

// ------------------------------------------------------------------------------------ other sides
// Where a stage ends: where the motion changes sides, or as its constraints end.
static void find_end(pl_analysis* d, pl_stage* s) {
  pl_leaving l;
  pl_expr crossed;
  if (!pl_leaves_first(d, s, &l, &crossed)) return;
  s->end = PL_END_SIDE;
  s->to = l.t;
  s->crossed = crossed;
}

// The stretch that begins where the motion leaves the sides of d.
static pl_stage* next_side(pl_analysis* d, const pl_stage* now, const pl_fact* side, int n,
                           const pl_leaving* l) {
  const pl_stage* own = d->stage;
  d->stage = now;
  pl_stage* s = turned(d, side, n, l->through);
  d->stage = own;
  s->from = l->t;
  s->n_q = l->n_q;
  s->q_name = l->q_name;
  s->q_unit = l->q_unit;
  s->q = l->q;
  s->v = l->v;
  return s;
}

// Follows the motion of one set of constraints from side to side; each that is new has a section.
static void follow_sides(pl_analysis* first, pl_analysis* d, const pl_stage* set) {
  enum { MOST_CHANGES = 40 };
  pl_solution* solution = first->solution;
  pl_stage now = *set;
  for (int i = 0; i < MOST_CHANGES && solution->stages.n <= MOST_LATER_STAGES; i++) {
    pl_fact side[2 * pl_max_sides];
    pl_leaving l;
    int n = pl_known_sides(d, side);
    if (!pl_leave(d, side, n, now.from, pl_end_of_stage(&now), &l) || !l.leaves) return;
    pl_stage before = now, *next = next_side(d, &now, side, n, &l);
    before.end = PL_END_SIDE;
    before.to = l.t;
    before.crossed = next->sides[0].difference;
    pl_analysis* other = find_analysis(first, next);
    now = *next;
    if (other && other->has_section) {
      d = other;
      continue;
    }
    if (!(other = analysis_in(first, next))) return;
    find_end(other, next);
    pl_push(first->arena, solution->stages, *next);
    answer_stage(other, next, &before, solution->stages.n - 1);
    d = other;
  }
}

void pl_answer_stages(pl_analysis* first) {
  const pl_derive_options* o = first->options;
  pl_solution* solution = first->solution;
  for (int k = 0; k < o->n_stages; k++) pl_push(first->arena, solution->stages, o->stages[k]);
  if (o->n_stages == 0) pl_push(first->arena, solution->stages, *stage_like(first));
  if (o->only || !pl_knows_friction(first)) return;
  for (int k = 1; k < o->n_stages && k <= MOST_LATER_STAGES; k++) {
    if (pl_interrupted(first->job)) return;
    pl_analysis* d = analysis_in(first, &o->stages[k]);
    if (d) answer_stage(d, &o->stages[k], &o->stages[k - 1], k);
  }
  int n = solution->stages.n;
  for (int k = 0; k < n && !pl_interrupted(first->job); k++) {
    pl_stage set = solution->stages.at[k];
    pl_analysis* d = o->n_stages == 0 ? first : find_analysis(first, &o->stages[k]);
    if (d) follow_sides(first, d, &set);
  }
}
