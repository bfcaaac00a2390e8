// sets: which constraints the equations contain. Contacts open and close, constraints are released
// and attached; each set that holds for a while has equations of its own, and an analysis of its
// own derives them. What holds when was found by the simulation (pl_stage); without numbers the
// signs at the start decide where they are provable, and the rest is taken as closed.
//
// Needs a model whose families are written out. The analyses share pool, solution and equation
// numbers.
#include <math.h>
#include <string.h>

#include "worked/sets_impl.h"

// -------------------------------------------------------------------------------------- what holds
int pl_row_of(const pl_stage* s, const char* name) {
  for (int i = 0; s && i < s->n; i++) {
    if (strcmp(s->name[i], name) == 0) return i;
  }
  return -1;
}

const char* pl_label_of(const pl_constraint* c) {
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
    if (rub->slips && strcmp(rub->on, pl_label_of(c)) == 0) return rub;
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
    int row = pl_row_of(d->stage, pl_label_of(c));
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
    int row = pl_row_of(d->stage, map_name(d, whole, k));
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
    const char* label = pl_label_of(&m->constraints.at[k]);
    int row = pl_row_of(s, label);
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
pl_analysis* pl_analysis_find(pl_analysis* first, const pl_stage* s) {
  for (int k = 0; k < first->sets.n; k++) {
    pl_analysis* d = first->sets.at[k];
    if (same_set(d, s) && pl_same_sides(d, s)) return d;
  }
  return NULL;
}

// The analysis of a stage: one that is there, or a new one.  NULL when it could not be derived.
pl_analysis* pl_analysis_in(pl_analysis* first, const pl_stage* s) {
  pl_analysis* d = pl_analysis_find(first, s);
  if (d) {
    d->stage = s;
    return d;
  }
  d = pl_analysis_make(first, s);
  if (d) pl_push(first->arena, first->sets, d);
  return d;
}

// The set of constraints that an analysis was derived for, as a stage of its own.
pl_stage* pl_stage_like(pl_analysis* d) {
  pl_stage* s = PL_NEW(d->arena, pl_stage);
  if (d->stage) {
    *s = *d->stage;
    return s;
  }
  int n = d->whole->constraints.n;
  const char** name = PL_ARRAY(d->arena, const char*, n + 1);
  bool *holds = PL_ARRAY(d->arena, bool, n + 1), *no = PL_ARRAY(d->arena, bool, n + 1);
  for (int k = 0; k < n; k++) {
    name[k] = pl_label_of(&d->whole->constraints.at[k]);
    holds[k] = !is_left_out(d, name[k]);
  }
  *s = (pl_stage){.n = n, .name = name, .holds = holds, .released = no, .pulls = no, .rope = no};
  return s;
}

// The same constraints with other signs: those that change come first.
pl_stage* pl_stage_turned(pl_analysis* d, const pl_fact* side, int n, const bool* through) {
  pl_stage* s = pl_stage_like(d);
  pl_fact* out = PL_ARRAY(d->arena, pl_fact, n + 1);
  int turns = 0, stays = 0;
  for (int k = 0; k < n; k++) turns += through[k];
  s->sides = out;
  s->n_sides = n;
  s->n_crossed = turns;
  for (int k = 0; k < n; k++) {
    pl_expr e = side[k].difference;
    if (through[k]) out[--turns] = (pl_fact){pl_neg(d->pool, e), side[k].strict};
    else out[s->n_crossed + stays++] = side[k];
  }
  return s;
}

pl_analysis* pl_analysis_beyond(pl_analysis* d, const pl_fact* side, int n, const bool* through) {
  pl_stage* s = pl_stage_turned(d, side, n, through);
  s->end = PL_END_UNKNOWN;
  s->n_q = 0;  // no motion is meant
  return pl_analysis_in(d->first, s);
}

pl_analysis* pl_analysis_of(pl_analysis* first, const pl_ask* ask) {
  const pl_derive_options* o = first->options;
  const pl_stage* own = o->n_stages > 0 ? &o->stages[0] : NULL;
  if (ask->motion.given && o->stage_from) {
    const pl_stage* s = o->stage_from(o->user, &ask->motion);
    if (s) return pl_analysis_in(first, s);
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
  pl_analysis* d = pl_analysis_in(first, s);
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
bool pl_asks_about_open(const pl_analysis* d, const pl_ask* ask, const pl_open* o) {
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
  int row = pl_row_of(d->stage, pl_label_of(o->source));
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
bool pl_speaks_of_unnamed(pl_analysis* d, const pl_ask* ask, pl_symbol* which) {
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
    if (!pl_asks_about_open(d, ask, o)) continue;
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
  if (!pl_speaks_of_unnamed(d, ask, &s)) return false;
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
const char* pl_seconds(pl_analysis* d, double t, pl_language lang) {
  const char* number = pl_notation_number(d->arena, t, 6, (pl_notation){PL_MATH_LINE, lang});
  return pl_format(d->arena, "t = %s%s", number, d->model->uses_units ? " s" : "");
}

const pl_form* pl_moment_form(pl_analysis* d, double t) {
  return pl_form_words(d->arena, pl_seconds(d, t, PL_ENGLISH), pl_seconds(d, t, PL_GERMAN));
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
const pl_form* pl_end_form(pl_analysis* d, const pl_stage* s) {
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
void pl_say_end(pl_analysis* d, const pl_stage* s) {
  pl_leaving l;
  pl_expr crossed;
  const pl_form* end = pl_end_form(d, s);
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
  pl_tell_friction(d);
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
  if (d->stage) pl_say_end(d, d->stage);
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
  pl_analysis* d = s ? pl_analysis_in(first, s) : NULL;
  if (!d || !d->reduced) return;
  pl_section* own = &first->solution->sections.at[first->solution->sections.n - 1];
  own->title[0] = "Equilibria as the start has the contacts";
  own->title[1] = "Gleichgewichtslagen mit den Kontakten des Starts";
  pl_answer_one(d, ask);
  d->section->beside = true;
  d->section->title[0] = "Equilibria with all contacts closed";
  d->section->title[1] = "Gleichgewichtslagen mit allen Kontakten geschlossen";
}
